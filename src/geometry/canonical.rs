//! One order of edges for one outline. In: a clean polygon. Out: the same polygon, its rings started where their shape
//! says, so that nothing depends on where a mapper began to draw or which way he went.

use glam::DVec2;

use super::polygon::{Polygon, Ring};

/// Walls count as as long within this share of the longest one: 1 mm on 10 m, whatever the unit.
const AS_LONG: f64 = 1e-4;
/// Sine of the turn between edges that are one wall: 1 degree.
const STRAIGHT: f64 = 0.017_452_406_437_283_51;

/// Every ring begins with its longest wall (edges in a line count together); of walls as long, with the one whose next wall is
/// longest, and so on, so that a turned outline begins with the same wall. Where all walls are alike (a rectangle's) it
/// is the one that begins farthest south, then west. Holes come in the order of their first points, south before north. Returns for every edge,
/// outer ring first, the number it had.
pub fn canonical_order(polygon: &mut Polygon) -> Vec<usize> {
    let mut first = 0;
    let mut turned = |ring: &mut Ring| {
        let (start, n) = (first_corner(ring), ring.len());
        ring.rotate_left(start);
        let numbers: Vec<usize> = (0..n).map(|i| first + (start + i) % n).collect();
        first += n;
        numbers
    };
    let mut numbers = turned(&mut polygon.outer);
    let mut holes: Vec<(Ring, Vec<usize>)> = Vec::with_capacity(polygon.holes.len());
    for mut hole in std::mem::take(&mut polygon.holes) {
        let own = turned(&mut hole);
        holes.push((hole, own));
    }
    holes.sort_by(|a, b| match (a.0.first(), b.0.first()) {
        (Some(&p), Some(&q)) => south_west(p, q),
        (p, q) => p.is_some().cmp(&q.is_some()),
    });
    for (hole, own) in holes {
        polygon.holes.push(hole);
        numbers.extend(own);
    }
    numbers
}

fn south_west(p: DVec2, q: DVec2) -> std::cmp::Ordering {
    p.y.total_cmp(&q.y).then(p.x.total_cmp(&q.x))
}

/// The corner at which the longest wall begins.
fn first_corner(ring: &[DVec2]) -> usize {
    let n = ring.len();
    let edge = |i: usize| ring[(i + 1) % n] - ring[i % n];
    let bends = |i: usize| {
        let (before, after) = (edge(i + n - 1).normalize_or_zero(), edge(i).normalize_or_zero());
        before.perp_dot(after).abs() > STRAIGHT || before.dot(after) < 0.0
    };
    let corners: Vec<usize> = (0..n).filter(|&i| bends(i)).collect();
    let m = corners.len();
    let length = |k: usize| ring[corners[k]].distance(ring[corners[(k + 1) % m]]);
    let walls: Vec<f64> = (0..m).map(length).collect();
    let as_long = AS_LONG * walls.iter().fold(0.0, |a, &b| f64::max(a, b));
    let mut left: Vec<usize> = (0..m).collect();
    for next in 0..m {
        let wall = |k: usize| walls[(k + next) % m];
        let longest = left.iter().map(|&k| wall(k)).fold(0.0, f64::max);
        left.retain(|&k| wall(k) >= longest - as_long);
        if left.len() < 2 {
            break;
        }
    }
    let starts = left.into_iter().map(|k| corners[k]);
    starts.min_by(|&i, &j| south_west(ring[i], ring[j])).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ring(points: &[(f64, f64)]) -> Ring {
        points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    #[test]
    fn the_longest_wall_comes_first_though_a_neighbour_broke_it() {
        // The wall of 10 m in the north has a vertex in its middle; no single edge of it is the longest.
        let mut polygon = Polygon {
            outer: ring(&[(0.0, 0.0), (9.0, 1.0), (10.0, 6.0), (5.0, 6.0), (0.0, 6.0)]),
            holes: vec![
                ring(&[(4.0, 3.0), (4.0, 4.0), (5.0, 4.0), (5.0, 3.0)]),
                ring(&[(2.0, 2.0), (2.0, 3.0), (3.0, 2.0)]),
            ],
        };
        assert_eq!(canonical_order(&mut polygon), [2, 3, 4, 0, 1, 10, 11, 9, 5, 6, 7, 8]);
        assert_eq!(polygon.outer[0], DVec2::new(10.0, 6.0));
    }

    #[test]
    fn of_walls_as_long_the_next_ones_decide() {
        // An L with two walls of 10 m: after the western one comes another of 10 m, whichever way the L is turned.
        let l = ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (5.0, 5.0), (5.0, 10.0), (0.0, 10.0)]);
        for (turns, scale) in [(0, 1.0), (1, 1.0), (2, 1e-3), (3, 1e3)] {
            let turned = l.iter().map(|&p| (0..turns).fold(p, |p, _| p.perp()) * scale).collect();
            let mut polygon = Polygon { outer: turned, holes: Vec::new() };
            assert_eq!(canonical_order(&mut polygon)[0], 5, "{turns} {scale}");
        }
    }

    proptest! {
        #[test]
        fn the_start_of_a_ring_changes_nothing(
            angles in prop::collection::btree_set(0_u32..3600, 3..12),
            radii in prop::collection::vec(1_u32..500, 12),
            start in 0_usize..12,
        ) {
            let outer: Ring = angles.iter().zip(&radii).map(|(&a, &r)| {
                let (sin, cos) = libm::sincos(f64::from(a) * std::f64::consts::TAU / 3600.0);
                DVec2::new(cos, sin) * f64::from(r)
            }).collect();
            let mut plain = Polygon { outer: outer.clone(), holes: Vec::new() };
            let mut turned = Polygon { outer, holes: Vec::new() };
            let start = start % turned.outer.len();
            turned.outer.rotate_left(start);
            let n = turned.outer.len();
            let (a, b) = (canonical_order(&mut plain), canonical_order(&mut turned));
            prop_assert_eq!(&plain, &turned);
            prop_assert_eq!(a, b.into_iter().map(|i| (i + start) % n).collect::<Vec<_>>());
        }
    }
}
