//! Junctions: a mesh → the same surface whose faces meet corner to corner. In: triangles of one object, with corners of some
//! on the edges of others (rules cut one wall and not the next). Out: triangles that share those corners.
//!
//! Rasterisers round corners, so beside a corner on a longer edge (a T-junction) samples between the two faces belong to
//! neither, and what lies behind shines through.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use crate::scene::{Group, Presence, Scene, SceneClass, SceneObject, SharedMesh, TriMesh};

/// Metres within which a corner lies on an edge: much less than is seen, much more than rounding.
const ON_EDGE: f64 = 1e-5;

/// Corners on an edge between two places, from the lesser place on: share of the edge's length and place.
type Splits = BTreeMap<(u32, u32), Vec<(f64, u32)>>;

/// What became of the meshes of the scene before.
#[derive(Default)]
pub struct Conformed {
    known: BTreeMap<(u32, Presence, u16), Known>,
}

struct Known {
    mesh: SharedMesh,
    /// `None` where the mesh itself will do.
    conforming: Option<Arc<TriMesh>>,
}

impl Conformed {
    /// [`conforming`] of every building, in the order of the objects; `None` where the mesh itself will do. Meshes that
    /// the scene before had are not looked at again.
    pub fn meshes(&mut self, scene: &Scene) -> Vec<Option<Arc<TriMesh>>> {
        let known = &self.known;
        let one = |object: &SceneObject| {
            // The layers of the ground are one mesh without junctions.
            if object.class != SceneClass::Building {
                return None;
            }
            match known.get(&(object.instance, object.presence, object.change)) {
                Some(known) if known.mesh.is(&object.mesh) => known.conforming.clone(),
                _ => match conforming(&object.mesh) {
                    Cow::Borrowed(_) => None,
                    Cow::Owned(mesh) => Some(Arc::new(mesh)),
                },
            }
        };
        let meshes: Vec<_> = scene.objects.par_iter().map(one).collect();
        let buildings = scene.objects.iter().zip(&meshes).filter(|(object, _)| object.class == SceneClass::Building);
        let known = buildings.map(|(object, conforming)| {
            let known = Known { mesh: object.mesh.clone(), conforming: conforming.clone() };
            ((object.instance, object.presence, object.change), known)
        });
        self.known = known.collect();
        meshes
    }
}

/// The mesh itself if there is nothing to do. Vertices are added behind the others; texture coordinates other than set 0
/// are left out then.
pub fn conforming(mesh: &TriMesh) -> Cow<'_, TriMesh> {
    let (numbers, places) = places(&mesh.positions);
    let open = open_edges(&mesh.triangles, &numbers);
    let splits = splits(&places, &open);
    if splits.is_empty() {
        return Cow::Borrowed(mesh);
    }
    let mut cutter = Cutter { numbers: &numbers, places: &places, splits: &splits, out: without_triangles(mesh) };
    for group in &mesh.groups {
        let first = cutter.out.triangles.len() as u32;
        mesh.triangles[group.first as usize..][..group.count as usize].iter().for_each(|&t| cutter.triangle(t));
        let count = cutter.out.triangles.len() as u32 - first;
        cutter.out.groups.push(Group { material: group.material, first, count });
    }
    Cow::Owned(cutter.out)
}

fn without_triangles(mesh: &TriMesh) -> TriMesh {
    let (positions, normals, uvs) = (mesh.positions.clone(), mesh.normals.clone(), mesh.uvs.clone());
    TriMesh { positions, normals, uvs, ..TriMesh::default() }
}

/// The number of each vertex's place, and the places: vertices at one place have one number.
fn places(positions: &[DVec3]) -> (Vec<u32>, Vec<DVec3>) {
    let key = |i: u32| (positions[i as usize] + 0.0).to_array().map(f64::to_bits);
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_unstable_by_key(|&i| (key(i), i));
    let (mut numbers, mut places) = (vec![0; positions.len()], Vec::new());
    for (n, &i) in order.iter().enumerate() {
        if n == 0 || key(order[n - 1]) != key(i) {
            places.push(positions[i as usize]);
        }
        numbers[i as usize] = places.len() as u32 - 1;
    }
    (numbers, places)
}

/// Edges that only one triangle has.
fn open_edges(triangles: &[[u32; 3]], numbers: &[u32]) -> Vec<(u32, u32)> {
    let edge = |t: &[u32; 3], i: usize| {
        let (a, b) = (numbers[t[i] as usize], numbers[t[(i + 1) % 3] as usize]);
        (a.min(b), a.max(b))
    };
    let mut edges: Vec<_> = triangles.iter().flat_map(|t| [edge(t, 0), edge(t, 1), edge(t, 2)]).collect();
    edges.sort_unstable();
    let single = edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1 && same[0].0 != same[0].1);
    single.map(|same| same[0]).collect()
}

/// The ends of open edges that lie on other open edges.
fn splits(places: &[DVec3], open: &[(u32, u32)]) -> Splits {
    let mut ends: Vec<u32> = open.iter().flat_map(|&(a, b)| [a, b]).collect();
    ends.sort_unstable();
    ends.dedup();
    let along = |place: u32, axis: usize| places[place as usize][axis];
    let sorted: [Vec<u32>; 3] = std::array::from_fn(|axis| {
        let mut sorted = ends.clone();
        sorted.sort_by(|&a, &b| along(a, axis).total_cmp(&along(b, axis)));
        sorted
    });
    let mut splits = Splits::new();
    for &(a, b) in open {
        let (from, way) = (places[a as usize], places[b as usize] - places[a as usize]);
        let axis = (0..3).max_by(|&i, &j| way[i].abs().total_cmp(&way[j].abs())).expect("three axes");
        let (low, high) = (along(a, axis).min(along(b, axis)), along(a, axis).max(along(b, axis)));
        let first = sorted[axis].partition_point(|&p| along(p, axis) <= low);
        let between = sorted[axis][first..].iter().take_while(|&&p| along(p, axis) < high);
        let length = way.length();
        let on_edge = between.filter_map(|&p| {
            let offset = places[p as usize] - from;
            let share = offset.dot(way) / (length * length);
            let inside = (ON_EDGE..length - ON_EDGE).contains(&(share * length));
            (inside && (offset - way * share).length() <= ON_EDGE).then_some((share, p))
        });
        let mut on_edge: Vec<(f64, u32)> = on_edge.collect();
        if !on_edge.is_empty() {
            on_edge.sort_by(|a, b| a.0.total_cmp(&b.0));
            splits.insert((a, b), on_edge);
        }
    }
    splits
}

struct Cutter<'a> {
    numbers: &'a [u32],
    places: &'a [DVec3],
    splits: &'a Splits,
    out: TriMesh,
}

impl Cutter<'_> {
    /// Adds a triangle, cut at the corners on its edges.
    fn triangle(&mut self, corners: [u32; 3]) {
        let on_edges = [0, 1, 2].map(|i| self.on_edge(corners[i], corners[(i + 1) % 3]));
        self.cut(corners, on_edges);
    }

    /// New vertices on an edge, in order.
    fn on_edge(&mut self, from: u32, to: u32) -> Vec<u32> {
        let (a, b) = (self.numbers[from as usize], self.numbers[to as usize]);
        let Some(splits) = self.splits.get(&(a.min(b), a.max(b))) else { return Vec::new() };
        let (low, high) = if a < b { (from, to) } else { (to, from) };
        let mut vertices: Vec<u32> =
            splits.iter().map(|&(share, place)| self.vertex(low, high, share, place)).collect();
        if a > b {
            vertices.reverse();
        }
        vertices
    }

    fn vertex(&mut self, low: u32, high: u32, share: f64, place: u32) -> u32 {
        let (low, high, out) = (low as usize, high as usize, &mut self.out);
        out.positions.push(self.places[place as usize]);
        out.normals.push(out.normals[low].lerp(out.normals[high], share as f32));
        if let (Some(&a), Some(&b)) = (out.uvs.get(low), out.uvs.get(high)) {
            out.uvs.push(a.lerp(b, share as f32));
        }
        out.positions.len() as u32 - 1
    }

    /// Cuts off the part before the first vertex on an edge until there is none.
    fn cut(&mut self, mut corners: [u32; 3], mut on_edges: [Vec<u32>; 3]) {
        while let Some(edge) = (0..3).find(|&i| !on_edges[i].is_empty()) {
            corners.rotate_left(edge);
            on_edges.rotate_left(edge);
            let [a, b, c] = corners;
            let p = on_edges[0].remove(0);
            let before = std::mem::take(&mut on_edges[2]);
            self.cut([a, p, c], [Vec::new(), Vec::new(), before]);
            corners = [p, b, c];
        }
        self.out.triangles.push(corners);
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;

    fn mesh(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> TriMesh {
        TriMesh {
            positions: corners.iter().map(|&c| c.into()).collect(),
            normals: vec![Vec3::Z; corners.len()],
            uvs: corners.iter().map(|c| Vec2::new(c[0] as f32, c[1] as f32)).collect(),
            uv_sets: Vec::new(),
            triangles: triangles.to_vec(),
            groups: vec![Group { material: 4, first: 0, count: triangles.len() as u32 }],
        }
    }

    fn area(mesh: &TriMesh) -> f64 {
        let corner = |i: u32| mesh.positions[i as usize];
        mesh.triangles.iter().map(|&[a, b, c]| (corner(b) - corner(a)).cross(corner(c) - corner(a)).z / 2.0).sum()
    }

    #[test]
    fn corners_on_all_three_edges_are_taken_up() {
        // A triangle with strips along its sides that have more corners.
        let corners =
            [[0., 0., 0.], [4., 0., 0.], [0., 4., 0.], [1., 0., 0.], [3., 0., 0.], [0., 2., 0.], [2., 2., 0.]];
        let outside = [[2., -1., 0.], [-1., 2., 0.], [5., 5., 0.]];
        let all: Vec<[f64; 3]> = corners.into_iter().chain(outside).collect();
        let strips = [[0, 7, 3], [3, 7, 4], [4, 7, 1], [5, 8, 0], [2, 8, 5], [1, 9, 6], [6, 9, 2]];
        let triangles: Vec<[u32; 3]> = std::iter::once([0, 1, 2]).chain(strips).collect();
        let before = mesh(&all, &triangles);
        let after = conforming(&before);
        assert_eq!(after.triangles.len(), 1 + 4 + strips.len());
        assert_eq!(after.groups, [Group { material: 4, first: 0, count: 12 }]);
        assert!((area(&after) - area(&before)).abs() < 1e-12);
        for (p, uv) in after.positions.iter().zip(&after.uvs) {
            assert!((p.x - f64::from(uv.x)).abs() < 1e-6 && (p.y - f64::from(uv.y)).abs() < 1e-6);
        }
        // Only the outer border is left open.
        let (numbers, places) = places(&after.positions);
        let open = open_edges(&after.triangles, &numbers);
        assert!(splits(&places, &open).is_empty());
        assert_eq!(open.len(), 2 * 3);
    }

    #[test]
    fn a_mesh_without_junctions_is_not_copied() {
        let square = mesh(&[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]], &[[0, 1, 2], [0, 2, 3]]);
        assert!(matches!(conforming(&square), Cow::Borrowed(_)));
        assert!(matches!(conforming(&TriMesh::default()), Cow::Borrowed(_)));
    }

    #[test]
    fn a_corner_beside_an_edge_is_left_alone() {
        let corners = [[0., 0., 0.], [2., 0., 0.], [1., 1., 0.], [1., -1e-3, 0.], [0., -1., 0.], [2., -1., 0.]];
        let apart = mesh(&corners, &[[0, 1, 2], [3, 4, 5]]);
        assert!(matches!(conforming(&apart), Cow::Borrowed(_)));
    }
}
