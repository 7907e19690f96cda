//! Rectilinear plans, whose events come in ties. In: random numbers. Out: rings on a lattice of half metres.

use std::collections::BTreeMap;

use glam::DVec2;
use mansard::geometry::Ring;

use crate::random::Random;

fn ring(corners: &[(f64, f64)]) -> Ring {
    corners.iter().map(|&c| c.into()).collect()
}

fn length(r: &mut Random) -> f64 {
    r.count(4, 24) as f64 / 2.0
}

/// L, T, U, H or plus; wings often of equal width.
pub fn letter(r: &mut Random) -> Ring {
    let (a, b, c, d) = (length(r), length(r), length(r), length(r));
    let e = if r.chance(0.4) { a } else { length(r) };
    match r.count(0, 4) {
        0 => ring(&[(0.0, 0.0), (a + b, 0.0), (a + b, c), (a, c), (a, c + d), (0.0, c + d)]),
        1 => ring(&[
            (0.0, d),
            (0.0, c + d),
            (a + b + e, c + d),
            (a + b + e, d),
            (a + b, d),
            (a + b, 0.0),
            (a, 0.0),
            (a, d),
        ])
        .into_iter()
        .rev()
        .collect(),
        2 => ring(&[
            (0.0, 0.0),
            (a + b + e, 0.0),
            (a + b + e, c + d),
            (a + b, c + d),
            (a + b, c),
            (a, c),
            (a, c + d),
            (0.0, c + d),
        ]),
        3 => {
            let (w, h) = (a + b + e, 2.0 * d + c);
            ring(&[
                (0.0, 0.0),
                (a, 0.0),
                (a, d),
                (a + b, d),
                (a + b, 0.0),
                (w, 0.0),
                (w, h),
                (a + b, h),
                (a + b, d + c),
                (a, d + c),
                (a, h),
                (0.0, h),
            ])
        }
        _ => ring(&[
            (a, 0.0),
            (a + b, 0.0),
            (a + b, c),
            (a + b + e, c),
            (a + b + e, c + b),
            (a + b, c + b),
            (a + b, c + b + d),
            (a, c + b + d),
            (a, c + b),
            (0.0, c + b),
            (0.0, c),
            (a, c),
        ]),
    }
}

/// Columns of different or alternating heights on one base.
pub fn histogram(r: &mut Random) -> Ring {
    let columns = r.count(2, 20);
    let comb = r.chance(0.4);
    let (low, high, width) = (length(r), 12.0 + length(r), length(r) / 4.0);
    let mut x = 0.0;
    let mut top = vec![];
    for k in 0..columns {
        let h = if comb { [high, low][k % 2] } else { r.count(2, 12) as f64 };
        let w = if comb { width } else { length(r) / 2.0 };
        top.extend([(x, h), (x + w, h)]);
        x += w;
    }
    let mut all = vec![(x, 0.0)];
    top.dedup();
    all.extend(top.into_iter().rev());
    all.push((0.0, 0.0));
    let mut ring = ring(&all);
    ring.dedup();
    ring
}

/// An outline with courtyards of equal or random size on a grid.
pub fn courtyards(r: &mut Random) -> Vec<Ring> {
    let (columns, rows, equal) = (r.count(1, 5), r.count(1, 4), r.chance(0.5));
    let cell = 8.0;
    let (w, h) = (cell * columns as f64, cell * rows as f64);
    let mut rings = vec![ring(&[(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)])];
    for k in 0..columns * rows {
        let (x, y) = ((k % columns) as f64 * cell, (k / columns) as f64 * cell);
        let margin = |r: &mut Random| if equal { 2.0 } else { r.count(1, 7) as f64 / 2.0 };
        let (left, right, low, high) = (margin(r), margin(r), margin(r), margin(r));
        let (x0, x1, y0, y1) = (x + left, x + cell - right, y + low, y + cell - high);
        rings.push(ring(&[(x0, y0), (x0, y1), (x1, y1), (x1, y0)]));
    }
    rings
}

/// Connected cells, with all corners kept or not, holes and cells that touch in corners.
pub fn polyomino(r: &mut Random) -> Vec<Ring> {
    let (size, wanted) = (r.count(3, 7), r.count(4, 30));
    let mut cells = vec![vec![false; size]; size];
    let mut grown = vec![(size / 2, size / 2)];
    cells[size / 2][size / 2] = true;
    for _ in 0..wanted {
        let (x, y) = grown[r.count(0, grown.len() as u64 - 1)];
        let (dx, dy) = [(1, 0), (-1, 0), (0, 1), (0, -1)][r.count(0, 3)];
        let (Some(x), Some(y)) = (x.checked_add_signed(dx), y.checked_add_signed(dy)) else { continue };
        if x < size && y < size && !cells[x][y] {
            cells[x][y] = true;
            grown.push((x, y));
        }
    }
    let straight_corners = r.chance(0.3);
    outlines(&cells, straight_corners)
}

type Cell = (i32, i32);

/// The rings around the filled cells: the outline first, then the holes.
fn outlines(cells: &[Vec<bool>], straight_corners: bool) -> Vec<Ring> {
    let filled = |(x, y): Cell| {
        x >= 0 && y >= 0 && cells.get(x as usize).and_then(|c| c.get(y as usize)).copied().unwrap_or_default()
    };
    let mut sides: BTreeMap<Cell, Vec<Cell>> = BTreeMap::new();
    for x in 0..cells.len() as i32 {
        for y in (0..cells.len() as i32).filter(|&y| filled((x, y))) {
            for (beyond, from, to) in [
                ((x, y - 1), (x, y), (x + 1, y)),
                ((x + 1, y), (x + 1, y), (x + 1, y + 1)),
                ((x, y + 1), (x + 1, y + 1), (x, y + 1)),
                ((x - 1, y), (x, y + 1), (x, y)),
            ] {
                if !filled(beyond) {
                    sides.entry(from).or_default().push(to);
                }
            }
        }
    }
    let mut rings = Vec::new();
    while let Some((&start, _)) = sides.iter().find(|(_, ends)| !ends.is_empty()) {
        let mut corners = vec![start];
        let mut at = start;
        let mut heading = (0, 0);
        while let Some(ends) = sides.get_mut(&at).filter(|ends| !ends.is_empty()) {
            // Where two cells touch in a corner, stay with the own cell: turn left.
            let left = |&to: &Cell| heading.0 * (to.1 - at.1) - heading.1 * (to.0 - at.0);
            let pick = (0..ends.len()).max_by_key(|&k| left(&ends[k])).expect("not empty");
            let to = ends.swap_remove(pick);
            heading = (to.0 - at.0, to.1 - at.1);
            at = to;
            corners.push(at);
        }
        corners.pop();
        rings.push(corners);
    }
    let area = |c: &Vec<Cell>| -> i32 {
        (0..c.len()).map(|k| c[k].0 * c[(k + 1) % c.len()].1 - c[k].1 * c[(k + 1) % c.len()].0).sum()
    };
    rings.sort_by_key(|c| std::cmp::Reverse(area(c)));
    rings.iter().map(|c| to_ring(c, straight_corners)).collect()
}

fn to_ring(corners: &[Cell], straight_corners: bool) -> Ring {
    let n = corners.len();
    let turns = |k: usize| {
        let (p, c, q) = (corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]);
        (c.0 - p.0) * (q.1 - c.1) != (c.1 - p.1) * (q.0 - c.0)
    };
    let point = |k: usize| DVec2::new(f64::from(corners[k].0), f64::from(corners[k].1)) * 3.0;
    (0..n).filter(|&k| straight_corners || turns(k)).map(point).collect()
}
