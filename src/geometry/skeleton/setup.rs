//! From a polygon to the initial wavefront.
//!
//! In: rings in metres and weights per edge. Out: integer lines, the circular lists of wavefront vertices, and which
//! edges lie on one line with their neighbour (`../shared/numerics.md` §5.4; collinear vertices of §4 step 6).

use glam::DVec2;

use super::SkeletonError;
use super::events::FIRST_STEP;
use super::faces::{STEPS_PER_TAU, Union};
use super::line::Line;
use super::wavefront::Wavefront;
use crate::geometry::grid::Grid;
use crate::geometry::polygon::{Polygon, signed_area};

/// Choices of those who run the wavefront for something else than the plain skeleton.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Options {
    /// At a reflex corner between an edge that moves and one that stands still, end the strip square to the moving edge.
    pub square_ends: bool,
    /// Cut off reflex corners that would reach farther than this many distances.
    pub mitre_limit: Option<f64>,
}

/// One edge of the input that has a length on the grid.
#[derive(Clone, Copy)]
pub(super) struct Side {
    edge: u32,
    start: u32,
    point: [i64; 2],
    direction: [i64; 2],
    weight: f64,
}

/// What turns the wavefront back into metres.
pub(super) struct Setup {
    pub grid: Grid,
    /// Real time of a unit of τ, metres.
    pub metres_per_tau: f64,
}

/// Build the initial wavefront. `sides` is working memory.
pub(super) fn set_up(
    wavefront: &mut Wavefront,
    sides: &mut Vec<Side>,
    polygon: &Polygon,
    weights: Option<&[f64]>,
    options: &Options,
) -> Result<Setup, SkeletonError> {
    let count = polygon.rings().map(Vec::len).sum();
    let fastest = check_weights(weights, count)?;
    if polygon.rings().any(|ring| ring.iter().any(|p| !p.is_finite())) {
        return Err(SkeletonError::NotFinite);
    }
    if polygon.outer.len() < 3 {
        return Err(SkeletonError::TooFewPoints);
    }
    let (min, max) = polygon.bounds().ok_or(SkeletonError::TooFewPoints)?;
    if min == max {
        return Err(SkeletonError::TooFewPoints);
    }
    // Beyond the outline's box a hole would leave the grid.
    if polygon.holes.iter().flatten().any(|p| p.cmplt(min).any() || p.cmpgt(max).any()) {
        return Err(SkeletonError::NotSimple);
    }
    let grid = Grid::over(min, max).ok_or(SkeletonError::NotFinite)?;
    wavefront.clear();
    sides.clear();
    // With all weights 0 nothing moves; any unit of time will do. Bevels move faster than their edges.
    let unit = if fastest > 0.0 { fastest * options.mitre_limit.unwrap_or(1.0) } else { 1.0 };
    let weight = |edge: usize| weights.map_or(1.0, |w| w[edge]) / unit;
    let mut first = 0;
    for (number, ring) in polygon.rings().enumerate() {
        check_direction(ring, number == 0)?;
        add_lines(wavefront, sides, &grid, ring, first, weight)?;
        first += ring.len();
    }
    // Auxiliary lines come after those of all edges.
    let mut sides = &sides[..];
    let mut end = 0;
    for ring in polygon.rings() {
        end += ring.len();
        let (here, rest) = sides.split_at(sides.partition_point(|s| (s.edge as usize) < end));
        add_ring(wavefront, here, options)?;
        sides = rest;
    }
    Ok(Setup { grid, metres_per_tau: STEPS_PER_TAU * grid.step / unit })
}

/// The greatest weight.
fn check_weights(weights: Option<&[f64]>, edges: usize) -> Result<f64, SkeletonError> {
    let Some(weights) = weights else { return Ok(1.0) };
    if weights.len() != edges {
        return Err(SkeletonError::WeightCount { given: weights.len(), edges });
    }
    match weights.iter().position(|w| !(w.is_finite() && *w >= 0.0)) {
        Some(edge) => Err(SkeletonError::Weight { edge, weight: weights[edge] }),
        None => Ok(weights.iter().fold(0.0, |m, &w| f64::max(m, w))),
    }
}

fn check_direction(ring: &[DVec2], outer: bool) -> Result<(), SkeletonError> {
    let area = signed_area(ring);
    if area != 0.0 && (area > 0.0) != outer {
        return Err(SkeletonError::NotSimple);
    }
    Ok(())
}

/// Enter the ring's vertices as nodes and its lines; list the edges that have a length.
fn add_lines(
    wavefront: &mut Wavefront,
    sides: &mut Vec<Side>,
    grid: &Grid,
    ring: &[DVec2],
    first: usize,
    weight: impl Fn(usize) -> f64,
) -> Result<(), SkeletonError> {
    let before = sides.len();
    let Some(&start) = ring.first() else { return Err(SkeletonError::TooFewPoints) };
    let start = grid.snap(start);
    let mut point = start;
    for i in 0..ring.len() {
        let end = ring.get(i + 1).map_or(start, |&p| grid.snap(p));
        let edge = first + i;
        wavefront.add_input_node(point);
        let direction = [end[0] - point[0], end[1] - point[1]];
        let weight = weight(edge);
        if direction == [0, 0] {
            // A face of its own for an edge without length: its line is never used.
            wavefront.add_line(Line::new(point, 1, 0, weight));
        } else {
            wavefront.add_line(Line::new(point, direction[0], direction[1], weight));
            sides.push(Side { edge: edge as u32, start: edge as u32, point, direction, weight });
        }
        point = end;
    }
    if sides.len() - before < 3 {
        return Err(SkeletonError::TooFewPoints);
    }
    Ok(())
}

/// Enter one loop of wavefront vertices and the eaves of its faces.
fn add_ring(wavefront: &mut Wavefront, sides: &[Side], options: &Options) -> Result<(), SkeletonError> {
    let begin = wavefront.vertices.len();
    for k in 0..sides.len() {
        let (before, here) = (&sides[(k + sides.len() - 1) % sides.len()], &sides[k]);
        wavefront.eaves.push((before.edge, before.start, here.start));
        add_corner(wavefront, before, here, options)?;
    }
    let end = wavefront.vertices.len();
    if end - begin < 3 {
        return Err(SkeletonError::NotSimple);
    }
    for v in begin..end {
        let next = if v + 1 == end { begin } else { v + 1 };
        wavefront.vertices[v].next = next as u32;
        wavefront.vertices[next].prev = v as u32;
    }
    Ok(())
}

/// Enter the wavefront vertices between two edges: one as a rule, none on one line, two where an auxiliary line is needed.
fn add_corner(wf: &mut Wavefront, before: &Side, here: &Side, options: &Options) -> Result<(), SkeletonError> {
    let (l, r) = (wf.lines[before.edge as usize], wf.lines[here.edge as usize]);
    let cross = l.cross(&r);
    if cross == 0 && !l.same_direction(&r) {
        return Err(SkeletonError::NotSimple);
    }
    if l == r {
        wf.faces.unite(Union { left: before.edge, right: here.edge, node: here.start });
        return Ok(());
    }
    match auxiliary_line(before, here, cross, options) {
        Some(line) => {
            let between = wf.add_line(line);
            // They leave the corner together; it is no event that they are there together.
            for (l, r) in [(before.edge, between), (between, here.edge)] {
                let v = wf.add_vertex(l, r, here.start);
                wf.vertices[v as usize].born = FIRST_STEP;
            }
        }
        None => {
            wf.add_vertex(before.edge, here.edge, here.start);
        }
    }
    Ok(())
}

/// The line to put between two edges, if they need one.
fn auxiliary_line(before: &Side, here: &Side, cross: i64, options: &Options) -> Option<Line> {
    let (p, [bx, by], [hx, hy]) = (here.point, before.direction, here.direction);
    // Collinear edges of different speed part along a step square to them.
    if cross == 0 {
        let inwards = if here.weight > before.weight { 1 } else { -1 };
        return Some(Line::new(p, -hy * inwards, hx * inwards, 0.0));
    }
    if cross > 0 {
        return None;
    }
    if options.square_ends && (before.weight == 0.0) != (here.weight == 0.0) {
        // Square to the edge that moves: from it back to the outline, or from the outline in to it.
        let (direction, standing) = if here.weight == 0.0 { ([by, -bx], here) } else { ([-hy, hx], before) };
        let line = Line::new(p, direction[0], direction[1], 0.0);
        // At a right angle the unmoved edge is that line already.
        let [sx, sy] = standing.direction;
        return (line != Line::new(p, sx, sy, 0.0)).then_some(line);
    }
    let limit = options.mitre_limit?;
    let (u, v) = (unit(before.direction), unit(here.direction));
    let bisector = u + v;
    // 1 / cos(half the turn) is how much farther than its edges the corner moves.
    let half = bisector.length() / 2.0;
    if half * limit >= 1.0 {
        return None;
    }
    let tangent = if half > 1e-9 { bisector.normalize() } else { DVec2::new(u.y, -u.x) };
    let [dx, dy] = (tangent * f64::from(1 << 28)).to_array().map(|c| c.round() as i64);
    Some(Line::new(p, dx, dy, (limit * before.weight.max(here.weight)).min(1.0)))
}

fn unit(direction: [i64; 2]) -> DVec2 {
    DVec2::new(direction[0] as f64, direction[1] as f64).normalize()
}
