//! One footprint through repair, skeleton, hip roof and mesh checks. In: rings. Out: what became of it and every defect.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use glam::DVec2;
use mansard::geometry::mesh_checks as mesh;
use mansard::geometry::polygon::signed_area;
use mansard::geometry::polygon_checks as checks;
use mansard::geometry::repair::{Options, Verdict, repair};
use mansard::geometry::roof::{Facing, Roof, RoofError, RoofShape, Slope, SoundRoof, hip, sound};
use mansard::geometry::skeleton::{Skeleton, SkeletonFace, skeleton};
use mansard::geometry::{Polygon, Ring};

use crate::double_area::{Double, twice_signed_area};

/// Lengths are held to this share of the extent: eight steps of the grid (welding), magnified by angles between planes.
const LENGTH: f64 = 2e-7;

/// What lengths are held to: [`LENGTH`], and some steps of the numbers that far from the origin. Metres.
fn rounding(p: &Polygon) -> f64 {
    let farthest = p.outer.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    LENGTH * extent(p) + 8.0 * f64::EPSILON * farthest
}

/// What became of one footprint.
pub struct Judgement {
    pub verdict: Verdict,
    /// Parts whose gabled roof fails its checks, so that a simpler one stands in.
    pub fell_back: usize,
    /// Names of defects in what came out, with a word of detail.
    pub defects: Vec<String>,
    /// Greatest relative error of the sum of face areas.
    pub area_error: f64,
    /// Of repair, skeleton and roof, without the checks.
    pub time: Duration,
}

pub fn judge(rings: &[Ring], options: &Options) -> Judgement {
    let start = Instant::now();
    let repaired = repair(rings, options);
    let made: Vec<_> =
        repaired.polygons.iter().map(|p| (p, skeleton(p, None), hip(p, Slope::Angle(45.0), 0.0, false))).collect();
    let time = start.elapsed();
    let mut result = Judgement { verdict: repaired.verdict, fell_back: 0, defects: Vec::new(), area_error: 0.0, time };
    for (polygon, skeleton, roof) in &made {
        result.defects.extend(of_polygon(polygon));
        match (skeleton, roof) {
            (Ok(skeleton), Ok(roof)) => {
                result.area_error = result.area_error.max(area_error(polygon, skeleton));
                result.defects.extend(of_skeleton(polygon, skeleton));
                result.defects.extend(of_roof(polygon, skeleton, roof));
            }
            (Err(why), _) => result.defects.push(format!("no skeleton: {why}")),
            (_, Err(why)) => result.defects.push(format!("no roof: {why}")),
        }
        match sound_gable(polygon) {
            Ok(roof) => result.fell_back += usize::from(!roof.steps.is_empty()),
            Err(why) => result.defects.push(format!("no gabled roof: {why}")),
        }
    }
    result
}

/// A gabled roof, or what stands in for it.
fn sound_gable(polygon: &Polygon) -> Result<SoundRoof, RoofError> {
    let slope = Slope::Angle(45.0);
    sound(polygon, slope, &[], ("gabled", RoofShape::Gabled.build(polygon, slope, Facing::Natural)))
}

/// Names the checks that found something.
fn named(found: impl IntoIterator<Item = (&'static str, usize)>) -> impl Iterator<Item = String> {
    found.into_iter().filter(|(_, count)| *count > 0).map(|(name, count)| format!("{name} ({count})"))
}

fn of_polygon(p: &Polygon) -> impl Iterator<Item = String> {
    named([
        ("non-finite points", checks::non_finite_points(p).len()),
        ("rings too short", checks::rings_too_short(p).len()),
        ("doubled points", checks::doubled_points(p).len()),
        ("crossing edges", checks::crossing_edges(p).len()),
        ("reversed rings", checks::reversed_rings(p).len()),
        ("holes outside", checks::holes_outside(p).len()),
        ("nested holes", checks::nested_holes(p).len()),
    ])
}

fn extent(p: &Polygon) -> f64 {
    p.bounds().map_or(0.0, |(low, high)| (high - low).max_element())
}

fn points(s: &Skeleton, ring: &[u32], origin: DVec2) -> Vec<DVec2> {
    ring.iter().map(|&n| s.nodes[n as usize].position - origin).collect()
}

fn area_error(p: &Polygon, s: &Skeleton) -> f64 {
    let face = |f: &SkeletonFace| twice_signed_area(&points(s, &f.boundary, DVec2::ZERO));
    let whole = p.rings().map(|r| twice_signed_area(r)).fold(Double::default(), Double::plus);
    let missing = s.faces.iter().map(face).fold(whole.negated(), Double::plus);
    (missing.to_f64() / whole.to_f64()).abs()
}

/// Faces are simple, counter-clockwise, in their planes, and run every inner edge once each way
/// and every edge of the polygon once: together that makes them a partition.
fn of_skeleton(p: &Polygon, s: &Skeleton) -> Vec<String> {
    let mut found = Vec::new();
    let (size, origin, rounding) = (extent(p), p.outer[0], rounding(p));
    let edges: Vec<(DVec2, DVec2)> =
        p.rings().flat_map(|r| (0..r.len()).map(|i| (r[i], r[(i + 1) % r.len()]))).collect();
    if !s.tops.is_empty() || !s.extras.is_empty() || s.faces.iter().any(|f| !f.holes.is_empty()) {
        found.push("left-overs".into());
    }
    let mut runs: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    let (mut reversed, mut off_plane, mut crossing, mut misplaced) = (0, 0, 0, 0);
    for face in &s.faces {
        let ring = &face.boundary;
        let plan = points(s, ring, origin);
        let (start, end) = edges[face.edge];
        misplaced += usize::from(plan[0] != start - origin || plan[1] != end - origin);
        reversed += usize::from(signed_area(&plan) < -1e-9 * size * size);
        crossing += usize::from(crosses_itself(&plan, rounding));
        let normal = (end - start).normalize().perp();
        let off = |&n: &u32| {
            let node = s.nodes[n as usize];
            (normal.dot(node.position - start) - node.time).abs() > rounding || node.time < 0.0
        };
        off_plane += ring.iter().filter(|n| off(n)).count();
        (0..ring.len()).for_each(|k| *runs.entry((ring[k], ring[(k + 1) % ring.len()])).or_default() += 1);
    }
    let inner = |n: u32| n as usize >= edges.len();
    let open =
        runs.iter().filter(|&(&(a, b), &count)| count != 1 || ((inner(a) || inner(b)) && !runs.contains_key(&(b, a))));
    found.extend(named([
        ("faces that do not start with their edge", misplaced),
        ("clockwise faces", reversed),
        ("faces that cross themselves", crossing),
        ("nodes off their plane", off_plane),
        ("borders of one face only", open.count()),
    ]));
    found
}

/// Whether two edges cross deeper than `tolerance`.
fn crosses_itself(ring: &[DVec2], tolerance: f64) -> bool {
    let n = ring.len();
    let edge = |i: usize| (ring[i], ring[(i + 1) % n]);
    (0..n).any(|i| (i + 2..n).any(|j| (i, j) != (0, n - 1) && cross(edge(i), edge(j), tolerance)))
}

fn cross((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2), tolerance: f64) -> bool {
    let apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
    let sides = |(a, b): (DVec2, DVec2), p: DVec2, q: DVec2| {
        let along = (b - a).normalize_or_zero();
        let (p, q) = (along.perp_dot(p - a), along.perp_dot(q - a));
        (p > tolerance && q < -tolerance) || (p < -tolerance && q > tolerance)
    };
    !apart && sides((a, b), c, d) && sides((c, d), a, b)
}

fn of_roof(p: &Polygon, s: &Skeleton, roof: &Roof) -> Vec<String> {
    let m = &roof.mesh;
    let touches = !checks::touching_edges(p).is_empty();
    let mut found: Vec<String> = named([
        ("missing vertices", mesh::missing_vertices(m).len()),
        ("non-finite vertices", mesh::non_finite_vertices(m).len()),
        ("open edges", mesh::open_edges(m).len()),
        ("edges run twice the same way", mesh::edges_run_twice_the_same_way(m).len()),
        ("edges used more than twice", mesh::edges_used_more_than_twice(m).len()),
        ("faces without area", mesh::faces_without_area(m).len()),
        ("doubled corners", mesh::doubled_corners(m).len()),
        ("non-planar faces", mesh::non_planar_faces(m, rounding(p)).len()),
        // Where rings touch, the floor has fewer triangles than corners tell.
        ("faces not triangulated", if touches { 0 } else { mesh::faces_not_triangulated(m).len() }),
    ])
    .collect();
    let want = volume_under(p, s);
    let got = mesh::volume(m);
    // Heights are that far off over the whole plan, or a share of them.
    if (got - want).abs() > 1e-7 * want + rounding(p) * p.area() {
        found.push(format!("volume {got}, under the skeleton {want}"));
    }
    found
}

/// Volume under the faces at slope 1, by fans.
fn volume_under(p: &Polygon, s: &Skeleton) -> f64 {
    let origin = p.outer[0];
    let fan = |ring: &[u32]| {
        let corner = |k: usize| (s.nodes[ring[k] as usize].position - origin, s.nodes[ring[k] as usize].time);
        let (o, h) = corner(0);
        let piece = |k: usize| {
            let ((a, ha), (b, hb)) = (corner(k), corner(k + 1));
            (a - o).perp_dot(b - o) / 2.0 * (h + ha + hb) / 3.0
        };
        (1..ring.len() - 1).map(piece).sum::<f64>()
    };
    mesh::pairwise_sum(&s.faces.iter().map(|f| fan(&f.boundary)).collect::<Vec<f64>>())
}
