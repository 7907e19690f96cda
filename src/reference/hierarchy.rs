//! Hierarchy: triangles → a tree of boxes, and the walk of a ray through it, near boxes first.
//!
//! The crate `bvh` builds the tree by the surface area heuristic. The walk is ours: the crate's box test counts a ray in
//! the plane of a face as a miss, which an exact nadir view meets, and its iterators know no farthest distance.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::{BHShape, BoundingHierarchy};
use bvh::bvh::{Bvh, BvhNode};
use nalgebra::Point3;
use smallvec::SmallVec;

use super::ray::{Boxes, Ray, Triangle};

/// Most triangles of a leaf.
const LEAF: usize = 4;

type Corners = [[f64; 3]; 2];

/// Children of a node.
const WIDE: usize = 4;

/// Nothing is inside it.
const NOWHERE: Corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

/// Four children, side by side: box (never smaller, in half the memory), first node or triangle, number of triangles (0
/// for a node). Children that are not there have boxes that nothing is in.
#[derive(Clone, Copy, Debug)]
struct Node {
    boxes: Boxes,
    first: [u32; WIDE],
    count: [u32; WIDE],
}

const EMPTY: Node =
    Node { boxes: [[[f32::INFINITY; WIDE]; 3], [[f32::NEG_INFINITY; WIDE]; 3]], first: [0; WIDE], count: [0; WIDE] };

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

impl Node {
    /// Sets a child; its box is rounded outwards.
    fn set(&mut self, child: usize, corners: &Corners, (first, count): (u32, u32)) {
        let least = |c: f64| if f64::from(c as f32) > c { (c as f32).next_down() } else { c as f32 };
        let greatest = |c: f64| if f64::from(c as f32) < c { (c as f32).next_up() } else { c as f32 };
        let [low, high] = &mut self.boxes;
        low.iter_mut().zip(corners[0]).for_each(|(axis, c)| axis[child] = least(c));
        high.iter_mut().zip(corners[1]).for_each(|(axis, c)| axis[child] = greatest(c));
        (self.first[child], self.count[child]) = (first, count);
    }
}

/// Half the surface of a box.
fn area(corners: &Corners) -> f64 {
    let [x, y, z] = std::array::from_fn(|k| corners[1][k] - corners[0][k]);
    x * y + y * z + z * x
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
            let enters = ray.enters(&node.boxes, near, far);
            let bottom = waiting.len();
            for (child, enter) in enters.into_iter().enumerate() {
                if enter < f64::INFINITY {
                    waiting.push((enter, node.first[child], node.count[child]));
                    // The nearest on top.
                    let mut at = waiting.len() - 1;
                    while at > bottom && waiting[at - 1].0 < enter {
                        waiting.swap(at - 1, at);
                        at -= 1;
                    }
                }
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
        self.nodes.push(EMPTY);
        if sizes[0] <= LEAF {
            let leaf = self.leaf(0);
            self.nodes[0].set(0, &bounds, leaf);
            return;
        }
        // Places in the crate's tree and in ours.
        let mut waiting = vec![(0, 0)];
        while let Some((theirs, ours)) = waiting.pop() {
            let mut node = EMPTY;
            for (i, (index, corners)) in self.children(theirs, &sizes).into_iter().enumerate() {
                let child = if sizes[index] <= LEAF {
                    self.leaf(index)
                } else {
                    let first = self.nodes.len();
                    self.nodes.push(EMPTY);
                    waiting.push((index, first));
                    (first as u32, 0)
                };
                node.set(i, &corners, child);
            }
            self.nodes[ours] = node;
        }
    }

    /// Up to four subtrees that make up an inner node: the largest is opened until there are enough.
    fn children(&self, root: usize, sizes: &[usize]) -> SmallVec<[(usize, Corners); WIDE]> {
        let two = |at: usize| {
            let BvhNode::Node { child_l_index, child_l_aabb, child_r_index, child_r_aabb, .. } = &self.tree[at] else {
                unreachable!("a subtree of more than one triangle begins with an inner node")
            };
            [(*child_l_index, child_l_aabb), (*child_r_index, child_r_aabb)]
                .map(|(index, aabb)| (index, [aabb.min.coords.into(), aabb.max.coords.into()]))
        };
        let mut children: SmallVec<[(usize, Corners); WIDE]> = SmallVec::from_iter(two(root));
        while children.len() < WIDE {
            let inner = (0..children.len()).filter(|&i| sizes[children[i].0] > LEAF);
            let Some(largest) = inner.max_by(|&a, &b| area(&children[a].1).total_cmp(&area(&children[b].1))) else {
                break;
            };
            let [left, right] = two(children[largest].0);
            children[largest] = left;
            children.push(right);
        }
        children
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
