//! The door for footprints. In: any list of rings. Out: clean polygons, a verdict, and what was done.
//!
//! The rings are rounded to the kernel's grid (exact integer coordinates) and every decision is taken there
//! (numerics section 4). A footprint that is already valid keeps its first edge, its order, its straight vertices and,
//! on the import lattice, its coordinates bit for bit. Other coordinates move by at most half a grid step.

use glam::DVec2;
use i_overlay::core::overlay_rule::OverlayRule;

use super::boolean::engine::{self, GridPoint, GridRing, GridShape, Keepsakes};
use super::grid::{GRID_LIMIT, Grid};
use super::polygon::signed_area;
use super::polygon_checks::is_strictly_valid;
use super::transform::flip_loop;
use super::{Polygon, Ring};

/// Tolerances with one owner each (numerics section 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Consecutive points closer than this are joined, metres; 0 joins only those that are equal on the grid.
    pub weld: f64,
    /// Parts and holes smaller than this are dropped, square metres.
    pub min_area: f64,
}

impl Default for Options {
    fn default() -> Self {
        Options { weld: 1e-3, min_area: 0.01 }
    }
}

/// Whether a footprint can be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Used as it came, but for directions and rounding to the grid.
    Ok,
    /// Used after the changes listed in the notes.
    Repaired,
    /// Not usable.
    Rejected(Rejection),
}

/// Why a footprint is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Rejection {
    #[error("the outline has fewer than three different points")]
    TooFewPoints,
    #[error("a coordinate is not a finite number")]
    NotFinite,
    #[error("the outline is larger than 1e9 metres")]
    TooLarge,
    #[error("the outline encloses no area")]
    NoArea,
    #[error("all parts are smaller than the least area")]
    BelowLeastArea,
    #[error("the holes leave nothing of the outline")]
    HolesCoverOutline,
    #[error("the polygon engine failed on this outline")]
    EngineFailed,
}

/// One thing that was done; counts are of points or rings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Note {
    /// Points equal to, or within the weld distance of, the point before.
    DoubledPointsRemoved(usize),
    /// The outline was clockwise.
    OutlineReversed,
    /// Holes that were counter-clockwise.
    HolesReversed(usize),
    /// Rings crossed or touched themselves or each other, or holes were misplaced: filled anew.
    CrossingsResolved,
    /// More than one part is left.
    SplitIntoParts(usize),
    /// Parts below the least area.
    SmallPartsDropped(usize),
    /// Holes with fewer than three different points.
    EmptyHolesDropped(usize),
}

impl Note {
    /// Maps have rings of either direction: turning one is no repair.
    pub fn is_repair(&self) -> bool {
        !matches!(self, Note::OutlineReversed | Note::HolesReversed(_))
    }
}

/// The result: polygons are ready for the skeleton, booleans and CGA.
#[derive(Clone, Debug, PartialEq)]
pub struct Repaired {
    pub verdict: Verdict,
    pub polygons: Vec<Polygon>,
    pub notes: Vec<Note>,
    /// Outline less holes as they came, by signed areas, square metres (NaN if a coordinate is not finite).
    pub area_before: f64,
    pub area_after: f64,
}

/// Cleans a footprint: `rings[0]` is the outline, the others are holes, of either direction; a repeated last point is
/// a doubled point. Each ring is filled by the non-zero rule on its own, the filled holes are united and taken from
/// the filled outline (numerics 4.5). Nothing panics and nothing but plain coordinates comes out.
pub fn repair(rings: &[Ring], options: &Options) -> Repaired {
    let area = |r: &Ring| signed_area(r).abs();
    let area_before = rings.first().map_or(0.0, area) - rings.iter().skip(1).map(area).sum::<f64>();
    let mut notes = Vec::new();
    let (verdict, polygons) = match clean(rings, options, &mut notes) {
        Ok(polygons) if !notes.iter().any(Note::is_repair) => (Verdict::Ok, polygons),
        Ok(polygons) => (Verdict::Repaired, polygons),
        Err(why) => (Verdict::Rejected(why), Vec::new()),
    };
    let area_after = polygons.iter().map(Polygon::area).sum();
    Repaired { verdict, polygons, notes, area_before, area_after }
}

/// Widest outline, and farthest hole corner from it, metres.
const GREATEST_EXTENT: f64 = 1e9;

/// The steps of numerics section 4, numbered as there.
fn clean(rings: &[Ring], options: &Options, notes: &mut Vec<Note>) -> Result<Vec<Polygon>, Rejection> {
    // 1. Refuse what cannot be a footprint.
    let grid = grid_over(rings)?;

    // 2. Round to the grid. 3. Remove doubled points, then holes that are no rings any more.
    let mut on_grid: Vec<GridRing> = Vec::with_capacity(rings.len());
    let mut doubled = 0;
    for ring in rings {
        let mut welded = ring.clone();
        doubled += remove_doubled(&mut welded, |p, q| p.distance_squared(q) < options.weld * options.weld);
        let (mut snapped, clipped) = snap(&welded, &grid)?;
        let equal = remove_doubled(&mut snapped, |p, q| p == q);
        // The corners of the box that a hole is clipped to are nobody's points.
        doubled += if clipped { 0 } else { equal };
        on_grid.push(snapped);
    }
    note(notes, doubled, Note::DoubledPointsRemoved);
    if !has_three_points(&on_grid[0]) {
        return Err(Rejection::TooFewPoints);
    }
    let (outline, holes) = on_grid.split_first().expect("the outline was just read");
    let mut holes = holes.to_vec();
    holes.retain(has_three_points);
    note(notes, on_grid.len() - 1 - holes.len(), Note::EmptyHolesDropped);

    // Directions: the first edge stays first.
    let mut outline = outline.clone();
    if fix_direction(&mut outline, true) {
        notes.push(Note::OutlineReversed);
    }
    let reversed = holes.iter_mut().filter_map(|h| fix_direction(h, false).then_some(())).count();
    note(notes, reversed, Note::HolesReversed);

    // 4. Fast path: already simple, disjoint and nested. 5. Slow path: fill, unite, subtract.
    let plain = to_plan(&[vec![outline.clone()], holes.clone()].concat(), &grid);
    let has_needle = std::iter::once(&outline).chain(&holes).any(|r| engine::needle(r).is_some());
    let polygons = if is_strictly_valid(&plain) && !has_needle {
        vec![plain]
    } else {
        notes.push(Note::CrossingsResolved);
        let shapes = refill(&outline, &holes)?;
        shapes.iter().map(|s| to_plan(s, &grid)).collect()
    };

    // 6. Straight points stay here as facade breaks; the skeleton drops and remembers them itself.
    // 7. Drop what nobody can see.
    drop_small_parts(polygons, options.min_area, notes)
}

fn note(notes: &mut Vec<Note>, count: usize, note: fn(usize) -> Note) {
    if count > 0 {
        notes.push(note(count));
    }
}

fn grid_over(rings: &[Ring]) -> Result<Grid, Rejection> {
    let Some(outline) = rings.first() else { return Err(Rejection::TooFewPoints) };
    if rings.iter().flatten().any(|p| !p.is_finite()) {
        return Err(Rejection::NotFinite);
    }
    let Some(&first) = outline.first() else { return Err(Rejection::TooFewPoints) };
    let (lo, hi) = outline.iter().fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    if (hi - lo).max_element() > GREATEST_EXTENT {
        return Err(Rejection::TooLarge);
    }
    let far = |p: &DVec2| (*p - first).abs().max_element() > GREATEST_EXTENT;
    if rings.iter().skip(1).flatten().any(far) {
        return Err(Rejection::TooLarge);
    }
    Grid::over(lo, hi).ok_or(Rejection::TooFewPoints)
}

/// Rounds a ring to the grid, clipped first to a box that holds the outline and fits the engine; whether it was clipped.
fn snap(ring: &Ring, grid: &Grid) -> Result<(GridRing, bool), Rejection> {
    let limit = GRID_LIMIT as f64 * 1.5;
    let steps: Ring = ring.iter().map(|&p| (p - grid.origin) / grid.step).collect();
    if steps.iter().any(|p| !p.is_finite()) {
        return Err(Rejection::TooLarge);
    }
    let inside = steps.iter().all(|p| p.abs().max_element() <= limit);
    let clipped = if inside { steps } else { clip_to_box(steps, limit) };
    Ok((clipped.iter().map(|p| p.round()).map(|p| [p.x as i64, p.y as i64]).collect(), !inside))
}

/// Clips a ring to the box of half width `limit` about 0 (Sutherland and Hodgman 1974); winding numbers inside stay.
fn clip_to_box(mut ring: Ring, limit: f64) -> Ring {
    for (axis, sign) in [(DVec2::X, 1.0), (DVec2::X, -1.0), (DVec2::Y, 1.0), (DVec2::Y, -1.0)] {
        let room = |p: DVec2| limit - p.dot(axis) * sign;
        let mut out = Ring::with_capacity(ring.len() + 4);
        for i in 0..ring.len() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            if room(a) >= 0.0 {
                out.push(a);
            }
            if (room(a) >= 0.0) != (room(b) >= 0.0) {
                // Exactly on this side of the box; the other coordinate may still lie beyond it.
                let cut = a + (b - a) * (room(a) / (room(a) - room(b)));
                out.push(cut * (DVec2::ONE - axis) + axis * (sign * limit));
            }
        }
        ring = out;
    }
    ring
}

/// Removes points close to the last one kept, and from the end those close to the first; returns how many.
fn remove_doubled<T: Copy>(ring: &mut Vec<T>, close: impl Fn(T, T) -> bool) -> usize {
    let before = ring.len();
    ring.dedup_by(|next, kept| close(*next, *kept));
    while ring.len() > 1 && close(ring[ring.len() - 1], ring[0]) {
        ring.pop();
    }
    before - ring.len()
}

fn has_three_points(ring: &GridRing) -> bool {
    let Some(&a) = ring.first() else { return false };
    let Some(&b) = ring.iter().find(|&&p| p != a) else { return false };
    ring.iter().any(|&p| p != a && p != b)
}

/// Turns a ring that runs the wrong way; whether it did.
fn fix_direction(ring: &mut GridRing, counter_clockwise: bool) -> bool {
    let o = ring[0];
    let twice = |w: &[GridPoint]| {
        let (u, v) = ([w[0][0] - o[0], w[0][1] - o[1]], [w[1][0] - o[0], w[1][1] - o[1]]);
        i128::from(u[0] * v[1] - u[1] * v[0])
    };
    let area: i128 = ring.windows(2).map(twice).sum();
    let wrong = if counter_clockwise { area < 0 } else { area > 0 };
    if wrong {
        flip_loop(ring);
    }
    wrong
}

/// Fills every ring alone, unites the holes, subtracts them. Parts come in the order of the outline's corners, and
/// start at the first of them they have.
fn refill(outline: &GridRing, holes: &[GridRing]) -> Result<Vec<GridShape>, Rejection> {
    let fill = |subject: &[GridRing], clip: &[GridRing], rule| {
        engine::overlay(subject, clip, rule).map_err(|_| Rejection::EngineFailed)
    };
    let filled = fill(std::slice::from_ref(outline), &[], OverlayRule::Subject)?;
    if filled.iter().all(|s| engine::is_rounding_dust(&s[0])) {
        return Err(Rejection::NoArea);
    }
    let mut filled_holes = Vec::new();
    for hole in holes {
        filled_holes.extend(fill(std::slice::from_ref(hole), &[], OverlayRule::Subject)?.concat());
    }
    let mut shapes = fill(&filled.concat(), &filled_holes, OverlayRule::Difference)?;
    let mut keepsakes = Keepsakes::default();
    [outline].into_iter().chain(holes).for_each(|r| keepsakes.add(r));
    keepsakes.tidy(&mut shapes);
    if shapes.is_empty() {
        return Err(Rejection::HolesCoverOutline);
    }
    Ok(shapes)
}

fn to_plan(shape: &[GridRing], grid: &Grid) -> Polygon {
    let mut rings = shape.iter().map(|r| r.iter().map(|p| grid.plan(p[0] as f64, p[1] as f64)).collect());
    Polygon { outer: rings.next().unwrap_or_default(), holes: rings.collect() }
}

fn drop_small_parts(polygons: Vec<Polygon>, min_area: f64, notes: &mut Vec<Note>) -> Result<Vec<Polygon>, Rejection> {
    let parts = polygons.len();
    let kept: Vec<Polygon> = polygons.into_iter().filter(|p| p.area() >= min_area && p.area() > 0.0).collect();
    if kept.is_empty() {
        return Err(Rejection::BelowLeastArea);
    }
    note(notes, parts - kept.len(), Note::SmallPartsDropped);
    if kept.len() > 1 {
        notes.push(Note::SplitIntoParts(kept.len()));
    }
    Ok(kept)
}

#[cfg(test)]
mod tests;
