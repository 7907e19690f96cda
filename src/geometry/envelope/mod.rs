//! Bodies under sloping planes. In: a polygon, and for every edge the height of its wall and the slope above it. Out: the
//! closed body up to a greatest height, in a local frame where the polygon lies at height 0: plan (x, y) becomes
//! (x, height, -y).
//!
//! Over a strictly convex polygon the body is the prism behind all slopes ([`convex`]). Over any other it goes up with
//! its outline: that is a wavefront whose edges begin to move where their walls end, at the cotangent of their slope. Between
//! two such heights it is a weighted straight skeleton (numerics section 5); the faces one edge sweeps in all of them
//! are joined. An edge that the others have passed before its wall ends does not come back.

mod convex;

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use super::polygon::{Polygon, ring_contains, signed_area};
use super::skeleton::{Skeleton, SkeletonError, wavefront};
use super::transform::flip_loop;
use super::{Face, Mesh};

/// What stands over one edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Height of the upright wall, metres.
    pub base: f64,
    /// Slope of the plane above it, degrees from level; 90 and more: the wall goes on.
    pub angle: f64,
}

/// What a face of the body is; edges count over the outer ring, then the holes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    Bottom,
    Side {
        edge: usize,
        /// The plane above the wall.
        slope: bool,
    },
    /// An upright face between two edges on one line that recede at different speeds.
    Step,
    Top,
}

/// `parts[i]` tells what `mesh.faces[i]` is: bottom, sides by edge, steps, top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Envelope {
    pub mesh: Mesh,
    pub parts: Vec<Part>,
}

/// Why there is no body.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EnvelopeError {
    #[error("a height of {0} leaves no room")]
    NoRoom(f64),
    #[error(transparent)]
    Skeleton(#[from] SkeletonError),
}

/// Heights this near are one, as a share of the greatest; so are corners of an outline, as a share of its extent.
const SAME: f64 = 1e-7;

/// The body under `limits` (one per edge; missing: upright) up to `height`. Angles of 0 and less end it at their base.
///
/// # Errors
/// No height, or an outline that has no skeleton.
pub fn envelope(polygon: &Polygon, limits: &[Limit], height: f64) -> Result<Envelope, EnvelopeError> {
    let flat = limits.iter().filter(|l| l.angle <= 0.0).map(|l| l.base);
    let height = flat.fold(height, f64::min);
    if !(height.is_finite() && height > 0.0) {
        return Err(EnvelopeError::NoRoom(height));
    }
    if convex::is_strictly_convex(polygon) {
        return convex::over(polygon, limits, height).ok_or(EnvelopeError::NoRoom(height));
    }
    let same = SAME * height;
    let mut breaks: Vec<f64> = limits.iter().filter(|l| l.angle < 90.0).map(|l| l.base).collect();
    breaks.extend([0.0, height]);
    breaks.retain(|&z| (0.0..=height).contains(&z));
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|b, a| *b - *a < same);
    if let Some(last) = breaks.last_mut() {
        *last = height;
    }
    let mut outlines = vec![outline_of(polygon)];
    let mut body = Body::default();
    body.bottom(polygon);
    for step in breaks.windows(2) {
        let (from, to) = (step[0], step[1]);
        let speed = |edge: usize| match limits.get(edge) {
            Some(l) if l.angle < 90.0 && l.base < from + same => libm::tan((90.0 - l.angle).to_radians()),
            _ => 0.0,
        };
        let mut next = Vec::new();
        for outline in outlines {
            if outline.iter().flat_map(|ring| &ring.edges).all(|&edge| speed(edge) == 0.0) {
                body.upright(&outline, from, to);
                next.push(outline);
            } else {
                next.extend(body.rise(&outline, speed, from, to)?);
            }
        }
        outlines = next;
    }
    outlines.iter().for_each(|outline| body.top(outline, height));
    Ok(body.finish())
}

/// A loop of the outline at some height, with the edge of the polygon that each of its edges comes from.
#[derive(Clone)]
struct Ring {
    points: Vec<DVec2>,
    edges: Vec<usize>,
}

fn outline_of(polygon: &Polygon) -> Vec<Ring> {
    let mut edges = 0;
    let ring = |points: &Vec<DVec2>| {
        edges += points.len();
        Ring { points: points.clone(), edges: (edges - points.len()..edges).collect() }
    };
    polygon.rings().map(ring).collect()
}

/// Faces so far, as loops of vertices.
#[derive(Default)]
struct Body {
    positions: Vec<DVec3>,
    known: BTreeMap<[u64; 3], u32>,
    parts: BTreeMap<Part, Vec<Vec<u32>>>,
}

impl Body {
    fn vertex(&mut self, p: DVec2, height: f64) -> u32 {
        // Adding 0 makes -0 and 0 one.
        let position = DVec3::new(p.x, height, -p.y) + DVec3::ZERO;
        let positions = &mut self.positions;
        *self.known.entry(position.to_array().map(f64::to_bits)).or_insert_with(|| {
            positions.push(position);
            positions.len() as u32 - 1
        })
    }

    /// Loops of a face: plan points with heights, counter-clockwise seen from outside.
    fn add(&mut self, part: Part, loops: Vec<Vec<(DVec2, f64)>>) {
        for points in loops {
            let mut ring: Vec<u32> = points.into_iter().map(|(p, z)| self.vertex(p, z)).collect();
            ring.dedup();
            while ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            if ring.len() >= 3 {
                self.parts.entry(part).or_default().push(ring);
            }
        }
    }

    fn bottom(&mut self, polygon: &Polygon) {
        let turned = |ring: &Vec<DVec2>| {
            let mut ring: Vec<(DVec2, f64)> = ring.iter().map(|&p| (p, 0.0)).collect();
            flip_loop(&mut ring);
            ring
        };
        self.add(Part::Bottom, polygon.rings().map(turned).collect());
    }

    fn top(&mut self, outline: &[Ring], height: f64) {
        self.add(Part::Top, outline.iter().map(|ring| ring.points.iter().map(|&p| (p, height)).collect()).collect());
    }

    fn upright(&mut self, outline: &[Ring], from: f64, to: f64) {
        for ring in outline {
            for (i, &edge) in ring.edges.iter().enumerate() {
                let (p, q) = (ring.points[i], ring.points[(i + 1) % ring.points.len()]);
                self.add(Part::Side { edge, slope: false }, vec![vec![(p, from), (q, from), (q, to), (p, to)]]);
            }
        }
    }

    /// Lets an outline recede from one height to the next; the outlines that are left there.
    fn rise(
        &mut self,
        outline: &[Ring],
        speed: impl Fn(usize) -> f64,
        from: f64,
        to: f64,
    ) -> Result<Vec<Vec<Ring>>, SkeletonError> {
        let sources: Vec<usize> = outline.iter().flat_map(|ring| ring.edges.iter().copied()).collect();
        let mut rings = outline.iter().map(|ring| ring.points.clone());
        let polygon = Polygon { outer: rings.next().unwrap_or_default(), holes: rings.collect() };
        let weights: Vec<f64> = sources.iter().map(|&edge| speed(edge)).collect();
        let skeleton = wavefront(&polygon, Some(&weights), to - from)?;
        let at_top: BTreeSet<u32> = skeleton.tops.iter().flatten().copied().collect();
        let height = |n: u32| if at_top.contains(&n) { to } else { from + skeleton.nodes[n as usize].time };
        let lifted = |ring: &Vec<u32>| -> Vec<(DVec2, f64)> {
            ring.iter().map(|&n| (skeleton.nodes[n as usize].position, height(n))).collect()
        };
        let mut source_of: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        for face in &skeleton.faces {
            let edge = sources[face.edge];
            let loops = || std::iter::once(&face.boundary).chain(&face.holes);
            self.add(Part::Side { edge, slope: weights[face.edge] > 0.0 }, loops().map(lifted).collect());
            for ring in loops() {
                source_of.extend((0..ring.len()).map(|i| ((ring[i], ring[(i + 1) % ring.len()]), edge)));
            }
        }
        for ring in &skeleton.extras {
            self.add(Part::Step, vec![lifted(ring)]);
        }
        let mut found = Vec::new();
        for top in &skeleton.tops {
            found.extend(self.outline(&skeleton, top, &source_of, to)?);
        }
        Ok(nested(found))
    }

    /// A loop that is left at a height, with its sources; one too thin to go on is closed there.
    fn outline(
        &mut self,
        skeleton: &Skeleton,
        top: &[u32],
        source_of: &BTreeMap<(u32, u32), usize>,
        height: f64,
    ) -> Result<Option<Ring>, SkeletonError> {
        let mut ring = Ring { points: Vec::new(), edges: Vec::new() };
        for (i, &n) in top.iter().enumerate() {
            let next = top[(i + 1) % top.len()];
            let at = |n: u32| skeleton.nodes[n as usize].position;
            if at(n) != at(next) {
                // The face of the edge runs it the other way.
                ring.edges.push(*source_of.get(&(next, n)).ok_or(SkeletonError::Unresolved)?);
                ring.points.push(at(n));
            }
        }
        let extent = ring.points.iter().fold(0.0, |m, p| f64::max(m, p.distance(ring.points[0])));
        if ring.points.len() < 3 || signed_area(&ring.points).abs() <= (SAME * extent).powi(2) {
            self.add(Part::Top, vec![ring.points.iter().map(|&p| (p, height)).collect()]);
            return Ok(None);
        }
        Ok(Some(ring))
    }

    /// One face per connected piece of every part.
    fn finish(self) -> Envelope {
        let mut out = Envelope { mesh: Mesh { positions: self.positions, faces: Vec::new() }, parts: Vec::new() };
        for (part, rings) in self.parts {
            // All pieces of an edge lie in one plane, steps wherever two edges part.
            let planes = if part == Part::Step { by_direction(&out.mesh.positions, rings) } else { vec![rings] };
            for rings in planes {
                for face in merged(&out.mesh.positions, &rings) {
                    out.mesh.faces.push(face);
                    out.parts.push(part);
                }
            }
        }
        out
    }
}

/// Counter-clockwise loops with the clockwise ones inside them.
fn nested(rings: Vec<Ring>) -> Vec<Vec<Ring>> {
    let (outer, holes): (Vec<Ring>, Vec<Ring>) = rings.into_iter().partition(|r| signed_area(&r.points) > 0.0);
    let mut out: Vec<Vec<Ring>> = outer.into_iter().map(|ring| vec![ring]).collect();
    for hole in holes {
        let inside = hole.points[0].midpoint(hole.points[1]);
        let around = out.iter_mut().filter(|o| ring_contains(&o[0].points, inside));
        if let Some(home) = around.min_by(|a, b| signed_area(&a[0].points).total_cmp(&signed_area(&b[0].points))) {
            home.push(hole);
        }
    }
    out
}

/// Twice the area of a ring, along its normal.
fn twice_area(positions: &[DVec3], ring: &[u32]) -> DVec3 {
    let o = positions[ring[0] as usize];
    ring.windows(2).map(|w| (positions[w[0] as usize] - o).cross(positions[w[1] as usize] - o)).sum()
}

/// Rings that look the same way, in order of their first.
fn by_direction(positions: &[DVec3], rings: Vec<Vec<u32>>) -> Vec<Vec<Vec<u32>>> {
    let mut groups: Vec<(DVec3, Vec<Vec<u32>>)> = Vec::new();
    for ring in rings {
        let normal = twice_area(positions, &ring).normalize_or_zero();
        match groups.iter_mut().find(|(own, _)| own.distance(normal) < SAME) {
            Some((_, group)) => group.push(ring),
            None => groups.push((normal, vec![ring])),
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

/// Joins rings in one plane along the edges they run both ways. Each face starts with the first edge that is left.
fn merged(positions: &[DVec3], rings: &[Vec<u32>]) -> Vec<Face> {
    let edges_of = |ring: &Vec<u32>| -> Vec<(u32, u32)> {
        (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])).collect()
    };
    let mut left: Vec<(u32, u32)> = Vec::new();
    for edge in rings.iter().flat_map(edges_of) {
        match left.iter().position(|&(a, b)| (b, a) == edge) {
            Some(place) => {
                left.remove(place);
            }
            None => left.push(edge),
        }
    }
    let area = |ring: &[u32]| twice_area(positions, ring);
    let normal = rings.iter().map(|ring| area(ring)).sum::<DVec3>();
    let (mut outer, mut holes) = (Vec::new(), Vec::new());
    while let Some(ring) = trace(positions, &mut left, normal) {
        if ring.len() < 3 {
            continue;
        }
        if area(&ring).dot(normal) >= 0.0 { outer.push(ring) } else { holes.push(ring) }
    }
    let plan = |ring: &[u32]| -> Vec<DVec2> {
        ring.iter().map(|&v| positions[v as usize]).map(|p| DVec2::new(p.x, -p.z)).collect()
    };
    let mut faces: Vec<Face> = outer.iter().map(|ring| Face::new(ring.clone())).collect();
    for hole in holes {
        let middle = plan(&hole)[0].midpoint(plan(&hole)[1]);
        let home = outer.iter().position(|ring| outer.len() == 1 || ring_contains(&plan(ring), middle)).unwrap_or(0);
        if let Some(face) = faces.get_mut(home) {
            face.holes.push(hole.into());
        }
    }
    faces
}

/// Takes one loop off the list; where several edges go on, the sharpest right turn.
fn trace(positions: &[DVec3], left: &mut Vec<(u32, u32)>, normal: DVec3) -> Option<Vec<u32>> {
    if left.is_empty() {
        return None;
    }
    let (start, mut at) = left.remove(0);
    let (mut ring, mut before) = (vec![start], start);
    while at != start {
        let along = positions[at as usize] - positions[before as usize];
        let turn = |next: u32| {
            let d = positions[next as usize] - positions[at as usize];
            libm::atan2(along.cross(d).dot(normal), along.dot(d) * normal.length())
        };
        let open = (0..left.len()).filter(|&i| left[i].0 == at);
        let Some(place) = open.min_by(|&i, &j| turn(left[i].1).total_cmp(&turn(left[j].1))) else { break };
        ring.push(at);
        before = at;
        at = left.remove(place).1;
    }
    Some(ring)
}

#[cfg(test)]
mod tests;
