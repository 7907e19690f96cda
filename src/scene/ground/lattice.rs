//! In: plan points in metres. Out: points of an integer lattice, on which every decision is exact.

use glam::DVec2;

/// Lattice steps per metre: points closer than about a millimetre become one.
const STEPS_PER_M: f64 = 1024.0;
/// Coordinates beyond this have no lattice point, metres.
pub const MAX_COORDINATE_M: f64 = 1_000_000.0;

/// A lattice point; every lattice point is exact in f64 metres.
pub type Node = [i64; 2];

/// A straight piece between two nodes, the lesser node first.
pub type Segment = [Node; 2];

/// The nearest lattice point. The caller keeps coordinates within [`MAX_COORDINATE_M`].
pub fn snap(plan: DVec2) -> Node {
    let scaled = (plan * STEPS_PER_M + 0.5).floor();
    [scaled.x as i64, scaled.y as i64]
}

/// The plan point of a node, metres.
pub fn metres([x, y]: Node) -> DVec2 {
    DVec2::new(x as f64, y as f64) / STEPS_PER_M
}

/// The segment between two nodes; `None` if they are one.
pub fn segment(a: Node, b: Node) -> Option<Segment> {
    match a.cmp(&b) {
        std::cmp::Ordering::Less => Some([a, b]),
        std::cmp::Ordering::Greater => Some([b, a]),
        std::cmp::Ordering::Equal => None,
    }
}

/// Twice the signed area of the triangle `a b c`: positive if it turns left.
pub fn cross(a: Node, b: Node, c: Node) -> i128 {
    let d = |p: Node, i: usize| i128::from(p[i] - a[i]);
    d(b, 0) * d(c, 1) - d(b, 1) * d(c, 0)
}

/// Dot product of `b - a` and `c - a`.
pub fn dot(a: Node, b: Node, c: Node) -> i128 {
    let d = |p: Node, i: usize| i128::from(p[i] - a[i]);
    d(b, 0) * d(c, 0) + d(b, 1) * d(c, 1)
}

/// Whether a node lies less than half a step beside the inside of a segment, but on neither end. Further out, the two
/// diagonals of a lattice square would split each other for ever.
pub fn lies_on(node: Node, [a, b]: Segment) -> bool {
    if node == a || node == b {
        return false;
    }
    let off = cross(a, b, node).abs();
    let reach = i128::from((b[0] - a[0]).abs() + (b[1] - a[1]).abs());
    let length2 = dot(a, b, b);
    // The first test keeps the square far below 2^127.
    off <= reach && 4 * off * off < length2 && (1..length2).contains(&dot(a, b, node))
}

/// The node nearest to the point where two segments cross inside both; `None` if they do not.
pub fn crossing([a, b]: Segment, [c, d]: Segment) -> Option<Node> {
    let (c_side, d_side) = (cross(a, b, c), cross(a, b, d));
    let (a_side, b_side) = (cross(c, d, a), cross(c, d, b));
    if c_side.signum() * d_side.signum() >= 0 || a_side.signum() * b_side.signum() >= 0 {
        return None;
    }
    let (part, whole) = (a_side.abs(), a_side.abs() + b_side.abs());
    let along = |i: usize| a[i] + rounded(part, whole, b[i] - a[i]);
    Some([along(0), along(1)])
}

/// `part / whole * length`, rounded.
fn rounded(part: i128, whole: i128, length: i64) -> i64 {
    // part <= whole < 2^64 and |length| < 2^32 on the lattice.
    let doubled = 2 * part * i128::from(length) + whole;
    i64::try_from(doubled.div_euclid(2 * whole)).expect("lies between the ends")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_exact_metres() {
        for p in [DVec2::new(-1000.25, 2.5), DVec2::new(999_999.123, -999_999.9)] {
            let node = snap(p);
            assert_eq!(snap(metres(node)), node);
            assert!((metres(node) - p).abs().max_element() <= 0.5 / STEPS_PER_M);
        }
    }

    #[test]
    fn crossings_are_rounded_and_touches_are_none() {
        assert_eq!(crossing([[0, 0], [10, 10]], [[0, 9], [9, 0]]), Some([5, 5]));
        assert_eq!(crossing([[0, 0], [10, 0]], [[5, 0], [5, 7]]), None);
        let far = 1_024_000_000;
        assert_eq!(crossing([[-far, -far], [far, far]], [[-far, far], [far, -far]]), Some([0, 0]));
        assert_eq!(crossing([[-far, -far], [far, far]], [[0, 1], [1, 0]]), Some([1, 1]));
    }

    #[test]
    fn near_nodes_lie_on_a_segment() {
        let s = [[0, 0], [1000, 1]];
        assert!(
            lies_on([499, 0], s) && lies_on([501, 1], s) && !lies_on([499, 1], s) && !lies_on([1, 0], [[0, 0], [1, 1]])
        );
        assert!(!lies_on([0, 0], s) && !lies_on([1001, 1], s) && !lies_on([-1, 0], s));
    }
}
