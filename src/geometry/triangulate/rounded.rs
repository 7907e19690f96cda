//! Outlines that cross themselves by a rounding. In: such a ring. Out: triangles whose areas add up to its area.
//!
//! Roof faces around an apex have chains of corners a few grid steps apart, and ridges may end beside a valley; rounding
//! positions can fold such a face by as much. Any n - 2 triangles between the corners of a ring have its signed area; the
//! ones whose absolute areas add up to the least fold over least (dynamic program of Gilbert 1979 and Klincsek 1980).

use glam::DVec2;

use crate::geometry::polygon::signed_area;

/// Greatest area folded over, as a share of the square of the ring's extent: what rounding to the grid and welding do.
const FOLD: f64 = 1e-6;

/// n - 2 triangles; `None` if the ring repeats a point, has hardly any area, or is folded by more than [`FOLD`].
pub(super) fn cut(ring: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let n = ring.len();
    let (low, high) = ring.iter().fold((ring[0], ring[0]), |(low, high), &p| (low.min(p), high.max(p)));
    let limit = FOLD * (high - low).max_element().powi(2);
    let repeats = (0..n).any(|i| ring[..i].contains(&ring[i]));
    let whole = signed_area(ring);
    if repeats || whole <= limit {
        return None;
    }
    let area = |i: usize, k: usize, j: usize| ((ring[k] - ring[i]).perp_dot(ring[j] - ring[i]) / 2.0).abs();
    // Of the chain from i to j: the least sum of absolute areas, and the corner of the triangle on its chord.
    let mut least = vec![(0.0, 0); n * n];
    for length in 2..n {
        for i in 0..n - length {
            let j = i + length;
            let sum = |k: usize| (least[i * n + k].0 + least[k * n + j].0 + area(i, k, j), k);
            least[i * n + j] = (i + 1..j).map(sum).min_by(|p, q| p.0.total_cmp(&q.0)).expect("a corner between");
        }
    }
    if least[n - 1].0 > whole + limit {
        return None;
    }
    let mut triangles = Vec::with_capacity(n - 2);
    let mut chains = vec![(0, n - 1)];
    while let Some((i, j)) = chains.pop() {
        if j > i + 1 {
            let k = least[i * n + j].1;
            triangles.push([i as u32, k as u32, j as u32]);
            chains.extend([(i, k), (k, j)]);
        }
    }
    Some(triangles)
}
