//! Hierarchy: triangles → a tree of boxes, and the walk of a ray through it, near boxes first.
//!
//! The crate `bvh` builds the tree by the surface area heuristic. The walk is ours: the crate's box test counts a ray in
//! the plane of a face as a miss, which an exact nadir view meets, and its iterators know no farthest distance.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::{BHShape, BoundingHierarchy};
use bvh::bvh::{Bvh, BvhNode};
use nalgebra::Point3;
use smallvec::SmallVec;

use super::ray::{Ray, Triangle};

/// Most triangles of a leaf.
const LEAF: usize = 4;

type Corners = [[f64; 3]; 2];

/// The same in half the memory, never smaller: a node fits a cache line.
type Outer = [[f32; 3]; 2];

/// Nothing is inside it.
const NOWHERE: Corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

/// Two children: box, first node or triangle, number of triangles (0 for a node).
#[derive(Clone, Copy, Debug)]
struct Node {
    corners: [Outer; 2],
    first: [u32; 2],
    count: [u32; 2],
}

pub struct Hierarchy {
    nodes: Vec<Node>,
    /// In the order of the leaves.
    pub triangles: Vec<Triangle>,
    /// Least and greatest corner.
    pub bounds: Corners,
}

/// A triangle's box while the tree is built.
struct Shape {
    corners: Corners,
    node: usize,
}

impl Bounded<f64, 3> for Shape {
    fn aabb(&self) -> Aabb<f64, 3> {
        Aabb::with_bounds(Point3::from(self.corners[0]), Point3::from(self.corners[1]))
    }
}

impl BHShape<f64, 3> for Shape {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

fn joined(a: &Corners, b: &Corners) -> Corners {
    [std::array::from_fn(|k| a[0][k].min(b[0][k])), std::array::from_fn(|k| a[1][k].max(b[1][k]))]
}

/// Rounded outwards.
fn outer(corners: &Corners) -> Outer {
    let least = |c: f64| if f64::from(c as f32) > c { (c as f32).next_down() } else { c as f32 };
    let greatest = |c: f64| if f64::from(c as f32) < c { (c as f32).next_up() } else { c as f32 };
    [corners[0].map(least), corners[1].map(greatest)]
}

fn corners_of(triangle: &Triangle) -> Corners {
    triangle.iter().fold(NOWHERE, |all, &corner| joined(&all, &[corner, corner]))
}

impl Hierarchy {
    /// The tree, and for each of its triangles the place where it stood in the list. Coordinates must be finite.
    pub fn new(triangles: &[Triangle]) -> (Hierarchy, Vec<u32>) {
        let mut shapes: Vec<Shape> = triangles.iter().map(|t| Shape { corners: corners_of(t), node: 0 }).collect();
        let bounds = shapes.iter().fold(NOWHERE, |all, shape| joined(&all, &shape.corners));
        let built = Bvh::build_par(&mut shapes);
        let mut packing = Packing { tree: &built.nodes, nodes: Vec::new(), order: Vec::new() };
        if !triangles.is_empty() {
            packing.pack(bounds);
        }
        let ordered = packing.order.iter().map(|&i| triangles[i as usize]).collect();
        (Hierarchy { nodes: packing.nodes, triangles: ordered, bounds }, packing.order)
    }

    /// Greatest distance along an axis between a point and the triangles.
    pub fn extent(&self, from: [f64; 3]) -> f64 {
        let along = |k: usize| (from[k] - self.bounds[0][k]).abs().max((from[k] - self.bounds[1][k]).abs());
        along(0).max(along(1)).max(along(2))
    }

    /// Shows `visit` every triangle whose box the ray meets between `near` and `far`; it answers with how far the ray
    /// still goes.
    #[inline]
    pub fn walk(&self, ray: &Ray, near: f64, mut far: f64, mut visit: impl FnMut(usize, &Triangle, f64) -> f64) {
        let mut waiting: SmallVec<[(f64, u32, u32); 64]> = SmallVec::new();
        if !self.nodes.is_empty() {
            waiting.push((near, 0, 0));
        }
        while let Some((enter, first, count)) = waiting.pop() {
            if enter > far {
                continue;
            }
            for at in first as usize..(first + count) as usize {
                far = visit(at, &self.triangles[at], far);
            }
            if count > 0 {
                continue;
            }
            let node = &self.nodes[first as usize];
            let enters = [0, 1].map(|i| ray.enters(&node.corners[i], near, far));
            let child = |i: usize, enter: f64| (enter, node.first[i], node.count[i]);
            match enters {
                [Some(a), Some(b)] if a <= b => waiting.extend([child(1, b), child(0, a)]),
                [Some(a), Some(b)] => waiting.extend([child(0, a), child(1, b)]),
                [Some(a), None] => waiting.push(child(0, a)),
                [None, Some(b)] => waiting.push(child(1, b)),
                [None, None] => {}
            }
        }
    }
}

/// Makes our nodes from the crate's, with several triangles to a leaf.
struct Packing<'a> {
    tree: &'a [BvhNode<f64, 3>],
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Packing<'_> {
    fn pack(&mut self, bounds: Corners) {
        let sizes = self.sizes();
        let empty = Node { corners: [outer(&NOWHERE); 2], first: [0; 2], count: [0; 2] };
        self.nodes.push(empty);
        if sizes[0] <= LEAF {
            let (first, count) = self.leaf(0);
            self.nodes[0] = Node { corners: [outer(&bounds), outer(&NOWHERE)], first: [first, 0], count: [count, 0] };
            return;
        }
        // Places in the crate's tree and in ours.
        let mut waiting = vec![(0, 0)];
        while let Some((theirs, ours)) = waiting.pop() {
            let BvhNode::Node { child_l_index, child_l_aabb, child_r_index, child_r_aabb, .. } = self.tree[theirs]
            else {
                unreachable!("a subtree of more than one triangle begins with an inner node")
            };
            let children = [(child_l_index, child_l_aabb), (child_r_index, child_r_aabb)];
            let mut node = empty;
            for (i, (index, aabb)) in children.into_iter().enumerate() {
                node.corners[i] = outer(&[aabb.min.coords.into(), aabb.max.coords.into()]);
                if sizes[index] <= LEAF {
                    (node.first[i], node.count[i]) = self.leaf(index);
                } else {
                    node.first[i] = self.nodes.len() as u32;
                    self.nodes.push(empty);
                    waiting.push((index, node.first[i] as usize));
                }
            }
            self.nodes[ours] = node;
        }
    }

    /// Number of triangles below each node.
    fn sizes(&self) -> Vec<usize> {
        let mut sizes = vec![0; self.tree.len()];
        let mut waiting = vec![(0, false)];
        while let Some((at, children_known)) = waiting.pop() {
            match self.tree[at] {
                BvhNode::Leaf { .. } => sizes[at] = 1,
                BvhNode::Node { child_l_index, child_r_index, .. } if children_known => {
                    sizes[at] = sizes[child_l_index] + sizes[child_r_index];
                }
                BvhNode::Node { child_l_index, child_r_index, .. } => {
                    waiting.extend([(at, true), (child_l_index, false), (child_r_index, false)]);
                }
            }
        }
        sizes
    }

    /// Appends the triangles below a node; first and number.
    fn leaf(&mut self, root: usize) -> (u32, u32) {
        let first = self.order.len();
        let mut waiting = vec![root];
        while let Some(at) = waiting.pop() {
            match self.tree[at] {
                BvhNode::Leaf { shape_index, .. } => self.order.push(shape_index as u32),
                BvhNode::Node { child_l_index, child_r_index, .. } => waiting.extend([child_r_index, child_l_index]),
            }
        }
        (first as u32, (self.order.len() - first) as u32)
    }
}
