//! The least rectangle around points. In: plan points. Out: the direction of its longer side.

use glam::DVec2;

/// Areas and sides within this share are equal.
const EQUAL: f64 = 1e-9;

/// Direction (length 1) of the longer side of the rectangle of least area around the points; of equals the
/// longest (all those on a triangle's sides are equal), of a square's sides the one nearest to +-x. One side lies on the convex hull (Freeman, Shapira 1975). `None` if all
/// points are one.
pub fn least_around(points: &[DVec2]) -> Option<DVec2> {
    let hull = convex_hull(points);
    // (area, length, direction)
    let mut best: Option<(f64, f64, DVec2)> = None;
    for i in 0..hull.len() {
        let Some(d) = (hull[(i + 1) % hull.len()] - hull[i]).try_normalize() else { continue };
        let (long, wide) = (extent(&hull, d), extent(&hull, d.perp()));
        let longer = if wide > long * (1.0 + EQUAL) || (wide >= long * (1.0 - EQUAL) && d.y.abs() > d.x.abs()) {
            d.perp()
        } else {
            d
        };
        let (area, length) = (long * wide, long.max(wide));
        let better = best.is_none_or(|(least, longest, direction)| {
            let equal = |a: f64, b: f64| (a - b).abs() <= EQUAL * b;
            match (equal(area, least), equal(length, longest)) {
                (true, true) => longer.x.abs() > direction.x.abs() + EQUAL,
                (true, false) => length > longest,
                (false, _) => area < least,
            }
        });
        if better {
            best = Some((area, length, longer));
        }
    }
    best.map(|(_, _, direction)| direction)
}

fn extent(points: &[DVec2], d: DVec2) -> f64 {
    let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
        let x = p.dot(d);
        (low.min(x), high.max(x))
    });
    high - low
}

/// Counter-clockwise, without straight corners (Andrew 1979); two points for points on a line.
fn convex_hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut sorted: Vec<DVec2> = points.iter().copied().filter(|p| p.is_finite()).collect();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return if sorted.len() == 2 { sorted } else { Vec::new() };
    }
    let half = |order: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in order {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut sorted.iter().copied());
    hull.extend(half(&mut sorted.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(points: &[(f64, f64)], angle: f64) -> Vec<DVec2> {
        let (sin, cos) = libm::sincos(angle);
        points.iter().map(|&(x, y)| DVec2::new(x * cos - y * sin, x * sin + y * cos)).collect()
    }

    #[test]
    fn a_turned_l_has_the_direction_of_its_longer_side() {
        let l = [(0.0, 0.0), (9.0, 0.0), (9.0, 2.0), (3.0, 2.0), (3.0, 5.0), (0.0, 5.0)];
        for angle in [0.0, 0.3, 1.1, -0.7] {
            let found = least_around(&turned(&l, angle)).expect("an extent");
            assert!(found.perp_dot(turned(&[(1.0, 0.0)], angle)[0]).abs() < 1e-12, "{angle}: {found}");
        }
    }

    #[test]
    fn a_triangle_lies_along_its_longest_side() {
        let triangle = [(48.0, 0.0), (12.0, 0.0), (12.0, -12.0)];
        for angle in [0.0, 0.3, 1.1, 2.5] {
            let found = least_around(&turned(&triangle, angle)).expect("an extent");
            assert!(found.perp_dot(turned(&[(36.0, 12.0)], angle)[0]).abs() < 1e-9, "{angle}: {found}");
        }
    }

    #[test]
    fn squares_lines_and_points() {
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        assert_eq!(least_around(&turned(&square, 0.0)), Some(DVec2::X));
        let line = least_around(&[DVec2::ZERO, DVec2::new(3.0, 4.0), DVec2::new(6.0, 8.0)]).expect("an extent");
        assert!(line.perp_dot(DVec2::new(3.0, 4.0)).abs() < 1e-12);
        assert_eq!(least_around(&[DVec2::ONE, DVec2::ONE]), None);
    }
}
