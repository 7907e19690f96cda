//! The usual footprint: a convex outline of four edges. In: a polygon. Out: what the event loop gives, to the bit, or
//! nothing where the outline is not that simple.
//!
//! The planes of two opposite edges end in points, those of the other two meet in the ridge between them. Which two is
//! decided by the edge that vanishes first, exactly; ties, where all four planes meet in a point, are left to the loop.

use std::array::from_fn;
use std::cmp::Ordering;

use super::faces::{STEPS_PER_TAU, WELD_STEPS, near};
use super::line::{Line, Moment, Place, determinant, time_numerator};
use super::wavefront::GridNode;
use super::{Node, Skeleton, SkeletonFace};
use crate::geometry::grid::Grid;
use crate::geometry::polygon::Polygon;

/// `None` unless the outline has four edges that all turn left on the grid, no two of its nodes are close enough to
/// be welded and its ridge has a length.
pub(super) fn skeleton(polygon: &Polygon) -> Option<Skeleton> {
    if polygon.outer.len() != 4 || !polygon.holes.is_empty() || !polygon.outer.iter().all(|p| p.is_finite()) {
        return None;
    }
    let (min, max) = polygon.bounds()?;
    let grid = Grid::over(min, max)?;
    let points: [[i64; 2]; 4] = from_fn(|i| grid.snap(polygon.outer[i]));
    let lines = convex_lines(&points)?;
    let first = first_to_vanish(&lines)?;
    let over = |e: usize| Place::of(&lines[(e + 3) % 4], &lines[e], &lines[(e + 1) % 4]);
    let ends = [over(first)?, over(first + 2)?].map(|p| GridNode { x: p.x, y: p.y, tau: p.moment.tau });
    let corner = |i: usize| GridNode { x: points[i % 4][0] as f64, y: points[i % 4][1] as f64, tau: 0.0 };
    let arcs = (0..4).map(|i| (corner(first + i), ends[i / 2])).chain([(ends[0], ends[1])]);
    if arcs.into_iter().any(|(p, q)| near(&p, &q, WELD_STEPS)) {
        return None;
    }
    let mut nodes = Vec::with_capacity(6);
    nodes.extend(polygon.outer.iter().map(|&position| Node { position, time: 0.0 }));
    let metres_per_tau = STEPS_PER_TAU * grid.step;
    nodes.extend(ends.map(|n| Node { position: grid.plan(n.x, n.y), time: n.tau * metres_per_tau }));
    let face = |edge: usize| {
        let eave = [edge as u32, (edge as u32 + 1) % 4];
        let boundary = match (edge + 4 - first) % 4 {
            0 => [&eave[..], &[4]].concat(),
            1 => [&eave[..], &[5, 4]].concat(),
            2 => [&eave[..], &[5]].concat(),
            _ => [&eave[..], &[4, 5]].concat(),
        };
        SkeletonFace { edge, boundary, holes: Vec::new() }
    };
    Some(Skeleton { nodes, faces: (0..4).map(face).collect(), ..Skeleton::default() })
}

/// The lines of the edges, if all have a length and every corner is convex.
fn convex_lines(points: &[[i64; 2]; 4]) -> Option<[Line; 4]> {
    let direction = |i: usize| from_fn(|axis| points[(i + 1) % 4][axis] - points[i][axis]);
    let directions: [[i64; 2]; 4] = from_fn(direction);
    let turns_left = |i: usize| {
        let ([ax, ay], [bx, by]) = (directions[i], directions[(i + 1) % 4]);
        ax * by - ay * bx > 0
    };
    if !(0..4).all(turns_left) {
        return None;
    }
    Some(from_fn(|i| Line::new(points[i], directions[i][0], directions[i][1], 1.0)))
}

/// 0 or 1: the lesser of the two opposite edges that end in points; `None` on a tie.
fn first_to_vanish(lines: &[Line; 4]) -> Option<usize> {
    let vanishes = |e: usize| {
        let (p, e, q) = (&lines[(e + 3) % 4], &lines[e], &lines[(e + 1) % 4]);
        let d = determinant(p, e, q);
        (d > 0).then(|| Moment::new(time_numerator(p, e, q), d))
    };
    let earlier = |e: usize| [vanishes(e), vanishes(e + 2)].into_iter().flatten().min_by(Moment::compare);
    match (earlier(0), earlier(1)) {
        (Some(even), Some(odd)) => match even.compare(&odd) {
            Ordering::Less => Some(0),
            Ordering::Greater => Some(1),
            Ordering::Equal => None,
        },
        (even, odd) => even.map(|_| 0).or(odd.map(|_| 1)),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::super::{Options, run};
    use super::*;

    fn polygon(corners: [(f64, f64); 4]) -> Polygon {
        Polygon { outer: corners.iter().map(|&(x, y)| DVec2::new(x, y)).collect(), holes: Vec::new() }
    }

    /// Whether the direct way took it; what it gives is what the event loop gives.
    fn agrees(polygon: &Polygon) -> bool {
        let direct = skeleton(polygon);
        if let Some(direct) = &direct {
            assert_eq!(Ok(direct), run(polygon, None, None, &Options::default()).as_ref(), "{polygon:?}");
        }
        direct.is_some()
    }

    fn placed(corners: [(f64, f64); 4], first: usize, angle: f64, (x, y): (f64, f64)) -> Polygon {
        let turn = DVec2::from_angle(angle);
        let at = |i: usize| turn.rotate(DVec2::from(corners[(i + first) % 4])) + DVec2::new(x, y);
        Polygon { outer: (0..4).map(at).collect(), holes: Vec::new() }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]

        #[test]
        fn gives_what_the_event_loop_gives_on_quads(
            corners in prop::array::uniform4((-10.0f64..10.0, -10.0f64..10.0)),
        ) {
            let Polygon { outer, .. } = polygon(corners);
            let centre = outer.iter().sum::<DVec2>() / 4.0;
            let mut sorted = outer;
            sorted.sort_by(|p, q| (p - centre).to_angle().total_cmp(&(q - centre).to_angle()));
            agrees(&Polygon { outer: sorted, holes: Vec::new() });
        }

        #[test]
        fn gives_what_the_event_loop_gives_on_rectangles_and_trapezia(
            (w, d) in (0.5f64..60.0, 0.5f64..60.0),
            (inset, other) in (0.0f64..0.45, 0.0f64..0.45),
            kind in 0..4,
            first in 0usize..4,
            angle in prop::option::of(0.0f64..7.0),
            place in (-1e5f64..1e5, -1e5f64..1e5),
        ) {
            let corners = match kind {
                0 => [(0.0, 0.0), (w, 0.0), (w, d), (0.0, d)],
                1 => [(0.0, 0.0), (w, 0.0), (w - inset * w, d), (other * w, d)],
                2 => [(0.0, 0.0), (w, 0.0), (w + inset * w, d), (inset * w, d)],
                _ => [(0.0, 0.0), (w, 0.0), (w + inset * w, d), (-other * w, d)],
            };
            let taken = agrees(&placed(corners, first, angle.unwrap_or(0.0), place));
            prop_assert!(taken || kind > 0 || (w - d).abs() < 1e-4, "a rectangle was left to the loop");
        }
    }

    #[test]
    fn leaves_other_outlines_to_the_event_loop() {
        for corners in [
            [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)],
            [(0.0, 0.0), (8.0, 0.0), (4.0, 1.0), (4.0, 8.0)],
            [(0.0, 0.0), (8.0, 0.0), (12.0, 0.0), (4.0, 8.0)],
            [(0.0, 0.0), (0.0, 8.0), (8.0, 8.0), (8.0, 0.0)],
            [(0.0, 0.0), (8.0, 0.0), (8.0, 0.0), (4.0, 8.0)],
            [(0.0, 0.0), (8.0, f64::NAN), (8.0, 8.0), (0.0, 4.0)],
        ] {
            assert!(!agrees(&polygon(corners)), "{corners:?}");
        }
        assert!(agrees(&polygon([(0.0, 0.0), (12.0, 0.0), (12.0, 9.0), (0.0, 9.0)])));
        assert!(agrees(&polygon([(0.0, 0.0), (1e-3, 0.0), (1e-3, 9e3), (0.0, 9e3)])));
    }
}
