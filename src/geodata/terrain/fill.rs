//! In: a grid of heights with voids. Out: the same grid without them.
//!
//! A void becomes a membrane hung from its border (Laplace's equation): smooth, without new hills or pits, and
//! continuous with the heights around it.

/// Neighbours of a cell in a fixed order.
const NEIGHBOURS: [(isize, isize); 4] = [(0, -1), (-1, 0), (1, 0), (0, 1)];
/// Sweeps over the void cells stop when no height moves by more than this, metres.
const SETTLED_M: f32 = 0.005;
const MAX_SWEEPS: usize = 400;
/// Over-relaxation factor: any value in (0, 2) converges, this one fast for voids of 10 to 100 cells.
const RELAXATION: f32 = 1.85;

/// Fills the voids (NaN) of a grid from their borders; gives the number filled. A grid without any height stays void.
pub(super) fn fill_voids(heights: &mut [f32], width: usize) -> usize {
    let order = peel(heights, width);
    for _ in 0..MAX_SWEEPS {
        let mut moved = 0.0_f32;
        for &cell in &order {
            let mean = mean_of_neighbours(heights, width, cell).expect("filled cells touch heights");
            let step = RELAXATION * (mean - heights[cell]);
            heights[cell] += step;
            moved = moved.max(step.abs());
        }
        if moved < SETTLED_M {
            break;
        }
    }
    order.len()
}

/// First guess, from the border inwards, layer by layer; gives the void cells in that order.
fn peel(heights: &mut [f32], width: usize) -> Vec<usize> {
    let mut order = Vec::new();
    let mut layer: Vec<usize> = (0..heights.len())
        .filter(|&c| heights[c].is_nan() && mean_of_neighbours(heights, width, c).is_some())
        .collect();
    while !layer.is_empty() {
        let values: Vec<f32> =
            layer.iter().map(|&c| mean_of_neighbours(heights, width, c).expect("chosen for its neighbours")).collect();
        for (&cell, value) in layer.iter().zip(values) {
            heights[cell] = value;
        }
        let mut next: Vec<usize> =
            layer.iter().flat_map(|&c| neighbours(heights.len(), width, c)).filter(|&c| heights[c].is_nan()).collect();
        next.sort_unstable();
        next.dedup();
        order.append(&mut layer);
        layer = next;
    }
    order
}

fn neighbours(cells: usize, width: usize, cell: usize) -> impl Iterator<Item = usize> {
    let (column, row) = ((cell % width) as isize, (cell / width) as isize);
    let (columns, rows) = (width as isize, (cells / width) as isize);
    NEIGHBOURS
        .into_iter()
        .map(move |(dx, dy)| (column + dx, row + dy))
        .filter(move |&(x, y)| (0..columns).contains(&x) && (0..rows).contains(&y))
        .map(move |(x, y)| (y * columns + x) as usize)
}

fn mean_of_neighbours(heights: &[f32], width: usize, cell: usize) -> Option<f32> {
    let (mut sum, mut count) = (0.0, 0.0_f32);
    for neighbour in neighbours(heights.len(), width, cell).filter(|&n| !heights[n].is_nan()) {
        sum += heights[neighbour];
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hole_in_a_plane_becomes_the_plane() {
        let (width, height) = (30, 20);
        let plane = |c: usize| 100.0 + 3.0 * (c % width) as f32 - 2.0 * (c / width) as f32;
        let mut heights: Vec<f32> = (0..width * height).map(plane).collect();
        let hole = |c: usize| (8..22).contains(&(c % width)) && (4..15).contains(&(c / width));
        for c in (0..heights.len()).filter(|&c| hole(c)) {
            heights[c] = f32::NAN;
        }
        assert_eq!(fill_voids(&mut heights, width), 14 * 11);
        for (c, h) in heights.iter().enumerate() {
            assert!((h - plane(c)).abs() < 0.05, "cell {c}: {h} is not {}", plane(c));
        }
    }

    #[test]
    fn heights_stay_between_those_of_the_border() {
        let mut heights = vec![f32::NAN; 400];
        (heights[0], heights[399]) = (-5.0, 7.0);
        assert_eq!(fill_voids(&mut heights, 20), 398);
        assert!(heights.iter().all(|h| (-5.01..=7.01).contains(h)));
    }

    #[test]
    fn nothing_to_fill_from() {
        let mut heights = vec![f32::NAN; 12];
        assert_eq!(fill_voids(&mut heights, 4), 0);
        assert!(heights.iter().all(|h| h.is_nan()));
        assert_eq!(fill_voids(&mut [], 4), 0);
    }
}
