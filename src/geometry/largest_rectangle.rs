//! The largest upright rectangle in a polygon. In: a plan polygon, turned so that the wanted sides are level and
//! upright. Out: the rectangle of greatest area that lies inside.
//!
//! 1. Vertical lines through all corners cut the polygon into trapezoids.
//! 2. A rectangle has its left side in one trapezoid, its right side in another (or the same), and passes through a
//!    chain of neighbours between them; all chains are tried that can still beat the best found.
//! 3. In one chain the height is the least of linear functions of the places x0, x1 of the two sides, so the area is
//!    log-concave: its greatest value over x1 is found in closed form, over x0 by golden section. What is left of the
//!    error is rounding, about 1e-10 of the area.

use glam::DVec2;

use super::{Polygon, Ring};

/// An upright rectangle by its corners.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rectangle {
    pub low: DVec2,
    pub high: DVec2,
}

impl Rectangle {
    pub fn area(&self) -> f64 {
        let size = self.high - self.low;
        size.x * size.y
    }
}

/// Corners within this share of the extent have the same x.
const SAME_LINE: f64 = 1e-11;
/// Areas within this share are equal.
const EQUAL: f64 = 1e-9;
/// Narrows a slab to 3e-11 of its width.
const ROUNDS: usize = 50;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The largest rectangle with level and upright sides; of equally large ones the one whose centre is nearest to `middle`.
/// `None` if the polygon holds none.
pub fn largest_upright(polygon: &Polygon, middle: DVec2) -> Option<Rectangle> {
    // About the first corner, so that far origins cost no digits.
    let origin = *polygon.outer.first()?;
    let local = |ring: &Ring| ring.iter().map(|&p| p - origin).collect();
    let polygon = Polygon { outer: local(&polygon.outer), holes: polygon.holes.iter().map(local).collect() };
    let slabs = slabs(&polygon);
    let mut search = Search { slabs: &slabs, middle: middle - origin, best: None };
    for (i, slab) in slabs.iter().enumerate() {
        for trapezoid in &slab.trapezoids {
            search.extend(i, trapezoid, i, trapezoid, f64::NEG_INFINITY, f64::INFINITY);
        }
    }
    search.best.map(|r| Rectangle { low: r.low + origin, high: r.high + origin })
}

/// Everything between two neighbouring vertical lines.
struct Slab {
    left: f64,
    right: f64,
    trapezoids: Vec<Trapezoid>,
}

/// Floor and ceiling at the left and the right end of a slab.
#[derive(Clone, Copy)]
struct Trapezoid {
    floor: [f64; 2],
    ceiling: [f64; 2],
}

fn slabs(polygon: &Polygon) -> Vec<Slab> {
    let Some((low, high)) = polygon.bounds() else { return Vec::new() };
    let tolerance = SAME_LINE * (high - low).max_element();
    let mut lines: Vec<f64> = polygon.rings().flatten().map(|p| p.x).collect();
    lines.sort_by(f64::total_cmp);
    lines.dedup_by(|b, a| *b - *a <= tolerance);
    let line_of = |x: f64| lines.partition_point(|&line| line <= x).saturating_sub(1);
    let mut crossing: Vec<Vec<[f64; 2]>> = vec![Vec::new(); lines.len().saturating_sub(1)];
    for ring in polygon.rings() {
        for i in 0..ring.len() {
            let (p, q) = (ring[i], ring[(i + 1) % ring.len()]);
            let (p, q) = if p.x <= q.x { (p, q) } else { (q, p) };
            let (from, to) = (line_of(p.x), line_of(q.x));
            let (x0, x1) = (lines[from], lines[to]);
            let at = |k: usize| match k {
                k if k == from => p.y,
                k if k == to => q.y,
                k => p.y + (q.y - p.y) * ((lines[k] - x0) / (x1 - x0)),
            };
            (from..to).for_each(|k| crossing[k].push([at(k), at(k + 1)]));
        }
    }
    let slab = |(k, mut edges): (usize, Vec<[f64; 2]>)| {
        edges.sort_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])));
        let trapezoids = edges.chunks_exact(2).map(|pair| Trapezoid { floor: pair[0], ceiling: pair[1] }).collect();
        Slab { left: lines[k], right: lines[k + 1], trapezoids }
    };
    crossing.into_iter().enumerate().map(slab).collect()
}

struct Search<'a> {
    slabs: &'a [Slab],
    middle: DVec2,
    best: Option<Rectangle>,
}

impl Search<'_> {
    /// Tries rectangles from trapezoid `first` of slab `i` to `last` of slab `j`, then those that reach farther.
    /// `floor` and `ceiling` bound them so far.
    fn extend(&mut self, i: usize, first: &Trapezoid, j: usize, last: &Trapezoid, floor: f64, ceiling: f64) {
        let slabs = self.slabs;
        self.consider(&Chain { left: &slabs[i], first, right: &slabs[j], last, floor, ceiling });
        let Some(next) = slabs.get(j + 1) else { return };
        let (mut floor, mut ceiling) = (floor.max(last.floor[1]), ceiling.min(last.ceiling[1]));
        if j > i {
            (floor, ceiling) = (floor.max(last.floor[0]), ceiling.min(last.ceiling[0]));
        }
        let widest = slabs[slabs.len() - 1].right - slabs[i].left;
        for trapezoid in &next.trapezoids {
            let (low, high) = (floor.max(trapezoid.floor[0]), ceiling.min(trapezoid.ceiling[0]));
            if high > low && self.may_help(widest * (high - low)) {
                self.extend(i, first, j + 1, trapezoid, low, high);
            }
        }
    }

    fn may_help(&self, area: f64) -> bool {
        self.best.is_none_or(|best| area >= best.area() * (1.0 - EQUAL))
    }

    fn consider(&mut self, chain: &Chain) {
        if !self.may_help(chain.most()) {
            return;
        }
        let found = chain.best();
        let area = found.area();
        let off = |r: &Rectangle| (r.low + r.high).distance(self.middle * 2.0);
        let better = self.best.is_none_or(|best| {
            let equal = (area - best.area()).abs() <= EQUAL * best.area();
            if equal { off(&found) < off(&best) } else { area > best.area() }
        });
        if better && found.low.cmplt(found.high).all() {
            self.best = Some(found);
        }
    }
}

/// The rectangles from one trapezoid to another.
struct Chain<'a> {
    left: &'a Slab,
    first: &'a Trapezoid,
    right: &'a Slab,
    last: &'a Trapezoid,
    floor: f64,
    ceiling: f64,
}

/// y = at0 + slope (x - x0).
#[derive(Clone, Copy)]
struct Line {
    constant: f64,
    slope: f64,
}

impl Line {
    fn through(slab: &Slab, [y0, y1]: [f64; 2]) -> Line {
        let slope = (y1 - y0) / (slab.right - slab.left);
        Line { constant: y0 - slope * slab.left, slope }
    }

    fn at(&self, x: f64) -> f64 {
        self.constant + self.slope * x
    }

    fn minus(&self, other: &Line) -> Line {
        Line { constant: self.constant - other.constant, slope: self.slope - other.slope }
    }
}

impl Chain<'_> {
    /// No rectangle of the chain is larger.
    fn most(&self) -> f64 {
        let top = self.ceiling.min(self.first.ceiling[0].max(self.first.ceiling[1]));
        let top = top.min(self.last.ceiling[0].max(self.last.ceiling[1]));
        let bottom = self.floor.max(self.first.floor[0].min(self.first.floor[1]));
        let bottom = bottom.max(self.last.floor[0].min(self.last.floor[1]));
        (self.right.right - self.left.left) * (top - bottom)
    }

    /// The largest rectangle by golden section over the place of its left side.
    fn best(&self) -> Rectangle {
        let (mut a, mut b) = (self.left.left, self.left.right);
        let mut best = [a, b].map(|x| self.from(x)).into_iter().max_by(|p, q| p.0.total_cmp(&q.0)).expect("two ends");
        let (mut c, mut d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
        let (mut at_c, mut at_d) = (self.from(c), self.from(d));
        for _ in 0..ROUNDS {
            let more = if at_c.0 >= at_d.0 { at_c } else { at_d };
            if more.0 > best.0 {
                best = more;
            }
            if at_c.0 >= at_d.0 {
                (b, d, at_d) = (d, c, at_c);
                c = b - GOLDEN * (b - a);
                at_c = self.from(c);
            } else {
                (a, c, at_c) = (c, d, at_d);
                d = a + GOLDEN * (b - a);
                at_d = self.from(d);
            }
        }
        best.1
    }

    /// The largest rectangle whose left side is at x0, with its area; where there is none, how much height is missing.
    fn from(&self, x0: f64) -> (f64, Rectangle) {
        let first = |ends: [f64; 2]| Line::through(self.left, ends).at(x0);
        let ceiling = Line { constant: self.ceiling.min(first(self.first.ceiling)), slope: 0.0 };
        let floor = Line { constant: self.floor.max(first(self.first.floor)), slope: 0.0 };
        let (over, under) = (Line::through(self.right, self.last.ceiling), Line::through(self.right, self.last.floor));
        let heights = [ceiling.minus(&floor), over.minus(&floor), ceiling.minus(&under), over.minus(&under)];
        let (from, to) = (self.right.left.max(x0), self.right.right);
        let mut best = (f64::NEG_INFINITY, from);
        let mut consider = |x: f64| {
            let x = x.clamp(from, to);
            let height = heights.iter().map(|h| h.at(x)).fold(f64::INFINITY, f64::min);
            let value = if height > 0.0 { height * (x - x0) } else { height };
            if value > best.0 {
                best = (value, x);
            }
        };
        consider(from);
        consider(to);
        for (i, h) in heights.iter().enumerate() {
            if h.slope != 0.0 {
                consider((x0 - h.constant / h.slope) / 2.0);
            }
            for other in &heights[i + 1..] {
                let between = h.minus(other);
                if between.slope != 0.0 {
                    consider(-between.constant / between.slope);
                }
            }
        }
        let (value, x1) = best;
        let low = DVec2::new(x0, floor.constant.max(under.at(x1)));
        let high = DVec2::new(x1, ceiling.constant.min(over.at(x1)));
        (value, Rectangle { low, high })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polygon(points: &[(f64, f64)]) -> Polygon {
        Polygon { outer: points.iter().map(|&(x, y)| DVec2::new(x, y)).collect(), holes: Vec::new() }
    }

    fn area(points: &[(f64, f64)]) -> f64 {
        largest_upright(&polygon(points), DVec2::ZERO).expect("there is room").area()
    }

    #[track_caller]
    fn near(got: f64, expected: f64) {
        assert!((got - expected).abs() < 1e-9 * expected, "{got}, not {expected}");
    }

    #[test]
    fn known_shapes() {
        near(area(&[(0.0, 0.0), (7.0, 0.0), (7.0, 3.0), (0.0, 3.0)]), 21.0);
        near(area(&[(0.0, 0.0), (8.0, 0.0), (0.0, 6.0)]), 12.0);
        near(area(&[(0.0, 0.0), (50.0, 0.0), (50.0, 22.0), (24.0, 22.0), (24.0, 46.0), (0.0, 46.0)]), 24.0 * 46.0);
        // The square on its corner: half of it.
        near(area(&[(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)]), 1.0);
        // A trapezoid: the whole upper base down.
        near(area(&[(0.0, 0.0), (10.0, 0.0), (9.0, 4.0), (1.0, 4.0)]), 32.0);
    }

    #[test]
    fn holes_are_kept_free() {
        let mut ring = polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)]);
        let hole = [(6.0, 3.0), (6.0, 5.0), (7.0, 5.0), (7.0, 3.0)];
        ring.holes.push(hole.iter().map(|&(x, y)| DVec2::new(x, y)).collect());
        let found = largest_upright(&ring, DVec2::new(5.0, 4.0)).expect("there is room");
        assert_eq!(found, Rectangle { low: DVec2::ZERO, high: DVec2::new(6.0, 8.0) });
    }

    #[test]
    fn of_equals_the_one_in_the_middle() {
        let plus = [
            (0.0, 3.0),
            (3.0, 3.0),
            (3.0, 0.0),
            (6.0, 0.0),
            (6.0, 3.0),
            (9.0, 3.0),
            (9.0, 6.0),
            (6.0, 6.0),
            (6.0, 9.0),
            (3.0, 9.0),
            (3.0, 6.0),
            (0.0, 6.0),
        ];
        near(area(&plus), 27.0);
        let thin: Vec<(f64, f64)> = vec![(0.0, 0.0), (1.0, 0.0), (1.0, 1e-14), (0.0, 1e-14)];
        assert!(largest_upright(&polygon(&thin), DVec2::ZERO).is_none_or(|r| r.area() < 1e-13));
        assert_eq!(largest_upright(&Polygon::default(), DVec2::ZERO), None);
    }

    /// Corners of the polygon strictly inside a rectangle, or its middle outside: it does not fit.
    fn fits(polygon: &Polygon, r: &Rectangle, slack: f64) -> bool {
        let edges = polygon.rings().flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])));
        let crosses = |(p, q): (DVec2, DVec2)| {
            // Clips the edge to the rectangle less the slack (Liang, Barsky 1984).
            let (low, high) = (r.low + slack, r.high - slack);
            let d = q - p;
            let (mut from, mut to) = (0.0f64, 1.0f64);
            for axis in 0..2 {
                if d[axis] == 0.0 {
                    if p[axis] <= low[axis] || p[axis] >= high[axis] {
                        return false;
                    }
                    continue;
                }
                let (a, b) = ((low[axis] - p[axis]) / d[axis], (high[axis] - p[axis]) / d[axis]);
                from = from.max(a.min(b));
                to = to.min(a.max(b));
            }
            from < to
        };
        polygon.contains((r.low + r.high) / 2.0) && !edges.into_iter().any(crosses)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn fits_and_no_other_is_larger(radii in prop::collection::vec(1.0..9.0f64, 3..12), tries in prop::collection::vec((-9.0..9.0f64, -9.0..9.0f64, -9.0..9.0f64, -9.0..9.0f64), 400)) {
            let n = radii.len() as f64;
            let corner = |(i, r): (usize, &f64)| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / n);
                DVec2::new(r * cos, r * sin)
            };
            let star = Polygon { outer: radii.iter().enumerate().map(corner).collect(), holes: Vec::new() };
            let found = largest_upright(&star, DVec2::ZERO).expect("a star holds a rectangle");
            prop_assert!(fits(&star, &found, 1e-8), "{found:?}");
            for (a, b, c, d) in tries {
                let other = Rectangle { low: DVec2::new(a.min(b), c.min(d)), high: DVec2::new(a.max(b), c.max(d)) };
                prop_assert!(other.area() <= found.area() * (1.0 + 1e-9) || !fits(&star, &other, 0.0), "{other:?}");
            }
            // Nor can a side be moved out.
            for (i, by) in [(0, -1e-5), (1, -1e-5), (2, 1e-5), (3, 1e-5)] {
                let mut wider = found;
                match i { 0 => wider.low.x += by, 1 => wider.low.y += by, 2 => wider.high.x += by, _ => wider.high.y += by }
                prop_assert!(!fits(&star, &wider, 1e-12), "{found:?} {i}");
            }
        }
    }
}
