//! A tree of boxes for quick looks at many things at once. In: a box per thing. Out: the things near a box, on a line,
//! or nearest to a point.
//!
//! Built by halving at the median of the widest axis of the centres; ties go by number, so equal input gives equal trees.

use glam::DVec3;

use super::{Face, Mesh};

/// An axis-aligned box, metres; `lo <= hi` on every axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub lo: DVec3,
    pub hi: DVec3,
}

impl Bounds {
    /// The box around points; `None` without points.
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Bounds> {
        let mut points = points.into_iter();
        let first = points.next()?;
        let start = Bounds { lo: first, hi: first };
        Some(points.fold(start, |b, p| Bounds { lo: b.lo.min(p), hi: b.hi.max(p) }))
    }

    pub fn of_face(mesh: &Mesh, face: &Face) -> Option<Bounds> {
        Bounds::around(face.outer.iter().map(|&v| mesh.positions[v as usize]))
    }

    pub fn joined(&self, other: &Bounds) -> Bounds {
        Bounds { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Larger by `margin` on all sides.
    pub fn grown(&self, margin: f64) -> Bounds {
        Bounds { lo: self.lo - DVec3::splat(margin), hi: self.hi + DVec3::splat(margin) }
    }

    /// Whether the boxes share a point.
    pub fn touches(&self, other: &Bounds) -> bool {
        self.lo.cmple(other.hi).all() && other.lo.cmple(self.hi).all()
    }

    pub fn corners(&self) -> [DVec3; 8] {
        let at = |axis: usize, high: bool| if high { self.hi[axis] } else { self.lo[axis] };
        std::array::from_fn(|i| DVec3::new(at(0, i & 1 > 0), at(1, i & 2 > 0), at(2, i & 4 > 0)))
    }

    /// Distance from a point, 0 inside.
    pub fn distance(&self, p: DVec3) -> f64 {
        (self.lo - p).max(p - self.hi).max(DVec3::ZERO).length()
    }

    /// Whether the half line from `origin` along `direction` meets the box.
    pub fn meets_ray(&self, origin: DVec3, direction: DVec3) -> bool {
        let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            let (o, d) = (origin[axis], direction[axis]);
            if d == 0.0 {
                if o < self.lo[axis] || o > self.hi[axis] {
                    return false;
                }
                continue;
            }
            let (t0, t1) = ((self.lo[axis] - o) / d, (self.hi[axis] - o) / d);
            enter = enter.max(t0.min(t1));
            leave = leave.min(t0.max(t1));
        }
        enter <= leave
    }
}

#[derive(Clone, Debug)]
struct Node {
    bounds: Bounds,
    /// Range in `items`; inner nodes have the halves at `left` and `left + 1`.
    first: u32,
    last: u32,
    left: u32,
}

/// The tree; things are known by their place in the list it was made from.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    nodes: Vec<Node>,
    items: Vec<u32>,
    boxes: Vec<Bounds>,
}

/// Things per leaf of the tree.
const LEAF: usize = 4;

impl BoxTree {
    pub fn new(boxes: Vec<Bounds>) -> BoxTree {
        let mut tree = BoxTree { nodes: Vec::new(), items: (0..boxes.len() as u32).collect(), boxes };
        if let Some(root) = tree.node(0, tree.items.len()) {
            tree.nodes.push(root);
            let mut next = 0;
            while next < tree.nodes.len() {
                tree.halve(next);
                next += 1;
            }
        }
        tree
    }

    /// One box per face of a mesh, grown by `margin`; faces without corners lie nowhere.
    pub fn of_faces(mesh: &Mesh, margin: f64) -> BoxTree {
        let nowhere = Bounds { lo: DVec3::INFINITY, hi: DVec3::NEG_INFINITY };
        let bounds = |f: &Face| Bounds::of_face(mesh, f).map_or(nowhere, |b| b.grown(margin));
        BoxTree::new(mesh.faces.iter().map(bounds).collect())
    }

    fn node(&self, first: usize, last: usize) -> Option<Node> {
        let boxes = self.items[first..last].iter().map(|&i| self.boxes[i as usize]);
        let bounds = boxes.reduce(|a, b| a.joined(&b))?;
        Some(Node { bounds, first: first as u32, last: last as u32, left: 0 })
    }

    fn halve(&mut self, at: usize) {
        let (first, last) = (self.nodes[at].first as usize, self.nodes[at].last as usize);
        if last - first <= LEAF {
            return;
        }
        let center = |i: &u32| self.boxes[*i as usize].lo + self.boxes[*i as usize].hi;
        let around = Bounds::around(self.items[first..last].iter().map(center));
        let extent = around.map_or(DVec3::ZERO, |b| b.hi - b.lo);
        let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b]).then(b.cmp(&a))).unwrap_or(0);
        let boxes = &self.boxes;
        let key = |i: u32| boxes[i as usize].lo[axis] + boxes[i as usize].hi[axis];
        self.items[first..last].sort_unstable_by(|&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        let middle = first + (last - first) / 2;
        let halves = [self.node(first, middle), self.node(middle, last)];
        self.nodes[at].left = self.nodes.len() as u32;
        self.nodes.extend(halves.into_iter().flatten());
    }

    /// Calls `found` for every thing whose box, and all boxes above it, pass the test.
    pub fn visit(&self, passes: impl Fn(&Bounds) -> bool, mut found: impl FnMut(usize)) {
        let mut stack = vec![0usize];
        while let Some(node) = stack.pop().and_then(|i| self.nodes.get(i)) {
            if !passes(&node.bounds) {
                continue;
            }
            if node.left > 0 {
                stack.extend([node.left as usize + 1, node.left as usize]);
                continue;
            }
            let items = &self.items[node.first as usize..node.last as usize];
            items.iter().filter(|&&i| passes(&self.boxes[i as usize])).for_each(|&i| found(i as usize));
        }
    }

    /// The things whose boxes touch this one, in rising order.
    pub fn touching(&self, bounds: &Bounds) -> Vec<usize> {
        let mut out = Vec::new();
        self.visit(|b| b.touches(bounds), |i| out.push(i));
        out.sort_unstable();
        out
    }

    /// The things whose boxes the half line meets, in rising order.
    pub fn on_ray(&self, origin: DVec3, direction: DVec3) -> Vec<usize> {
        let mut out = Vec::new();
        self.visit(|b| b.meets_ray(origin, direction), |i| out.push(i));
        out.sort_unstable();
        out
    }

    /// The thing nearest to a point by `distance` (never less than the distance to its box), with that distance; the
    /// first of equals.
    pub fn nearest(&self, p: DVec3, mut distance: impl FnMut(usize) -> f64) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        let mut stack = vec![0usize];
        while let Some(node) = stack.pop().and_then(|i| self.nodes.get(i)) {
            if best.is_some_and(|(_, d)| node.bounds.distance(p) > d) {
                continue;
            }
            if node.left > 0 {
                let (a, b) = (node.left as usize, node.left as usize + 1);
                let nearer_first = self.nodes[a].bounds.distance(p) <= self.nodes[b].bounds.distance(p);
                stack.extend(if nearer_first { [b, a] } else { [a, b] });
                continue;
            }
            for &i in &self.items[node.first as usize..node.last as usize] {
                let candidate = (i as usize, distance(i as usize));
                if best.is_none_or(|b| (candidate.1, candidate.0) < (b.1, b.0)) {
                    best = Some(candidate);
                }
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<Bounds>> {
        let one = (prop::array::uniform3(-9.0..9.0f64), prop::array::uniform3(0.0..3.0f64));
        let bounds =
            |(lo, size): ([f64; 3], [f64; 3])| Bounds { lo: lo.into(), hi: DVec3::from(lo) + DVec3::from(size) };
        prop::collection::vec(one.prop_map(bounds), 0..60)
    }

    proptest! {
        #[test]
        fn answers_are_those_of_looking_at_every_box(
            boxes in boxes(), p in prop::array::uniform3(-12.0..12.0f64), d in prop::array::uniform3(-1.0..1.0f64)
        ) {
            let (p, d) = (DVec3::from(p), DVec3::from(d));
            let tree = BoxTree::new(boxes.clone());
            let wanted = Bounds { lo: p, hi: p + DVec3::splat(4.0) };
            let every = |test: &dyn Fn(&Bounds) -> bool| -> Vec<usize> {
                (0..boxes.len()).filter(|&i| test(&boxes[i])).collect()
            };
            prop_assert_eq!(tree.touching(&wanted), every(&|b| b.touches(&wanted)));
            prop_assert_eq!(tree.on_ray(p, d), every(&|b| b.meets_ray(p, d)));
            let by_distance = |a: &usize, b: &usize| boxes[*a].distance(p).total_cmp(&boxes[*b].distance(p)).then(a.cmp(b));
            let nearest = (0..boxes.len()).min_by(by_distance).map(|i| (i, boxes[i].distance(p)));
            prop_assert_eq!(tree.nearest(p, |i| boxes[i].distance(p)), nearest);
        }
    }
}
