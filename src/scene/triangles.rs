//! Faces to triangles. In: faces of leaves with their materials. Out: a [`TriMesh`] with one vertex per face corner and
//! one group per material.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2};

use crate::geometry::triangulate::triangulate_face;
use crate::geometry::{Face, Mesh};
use crate::interpreter::material::Material;
use crate::scene::{Group, TriMesh};

/// Triangles of one feature, gathered per material in the order the materials were met.
#[derive(Default)]
pub struct Builder {
    runs: Vec<(Arc<Material>, TriMesh)>,
}

impl Builder {
    /// Adds one face of a mesh; `lift` is added to every corner.
    pub fn face(&mut self, mesh: &Mesh, face: &Face, material: &Arc<Material>, lift: DVec3) {
        let normal = mesh.newell(face).normalize_or_zero().as_vec3();
        let triangles = triangulate_face(mesh, face);
        if triangles.is_empty() || normal == glam::Vec3::ZERO {
            return;
        }
        // Layers without any texture coordinates are ignored (reference 3.10).
        let bare = face.uvs.is_empty() && (material.colormap.is_some() || !material.maps.is_empty());
        let plain = bare.then(|| Arc::new(Material { colormap: None, maps: Vec::new(), ..(**material).clone() }));
        let material = plain.as_ref().unwrap_or(material);
        let uvs = face.uv(0);
        let corner_normal = |corner: usize| face.normals.get(corner).map_or(normal, |n| n.as_vec3());
        let run = self.run(material);
        let first = run.positions.len() as u32;
        // Triangles index the face's corners: the outer loop, then the holes.
        for (corner, index) in face.loops().flatten().enumerate() {
            run.positions.push(mesh.positions[*index as usize] + lift);
            run.normals.push(corner_normal(corner));
            run.uvs.push(uvs.map_or(Vec2::ZERO, |uvs| uvs[corner].as_vec2()));
        }
        let sets = material.maps.iter().map(|map| map.layer as u8);
        add_uv_sets(run, sets.filter_map(|set| Some((set, face.uv(set)?))));
        run.triangles.extend(triangles.iter().map(|t| t.map(|corner| first + corner)));
    }

    /// The triangles gathered for a material so far.
    pub fn run(&mut self, material: &Arc<Material>) -> &mut TriMesh {
        let known = self.runs.iter().position(|(m, _)| Arc::ptr_eq(m, material) || m == material);
        let at = known.unwrap_or_else(|| {
            self.runs.push((material.clone(), TriMesh::default()));
            self.runs.len() - 1
        });
        &mut self.runs[at].1
    }

    /// One mesh; the groups' materials are numbers into the list beside it.
    pub fn finish(self) -> (TriMesh, Vec<Arc<Material>>) {
        let mut mesh = TriMesh::default();
        let mut materials = Vec::new();
        for (material, run) in self.runs {
            if run.triangles.is_empty() {
                continue;
            }
            let (offset, first) = (mesh.positions.len() as u32, mesh.triangles.len() as u32);
            mesh.groups.push(Group { material: materials.len() as u32, first, count: run.triangles.len() as u32 });
            mesh.join_uv_sets(&run);
            mesh.positions.extend(run.positions);
            mesh.normals.extend(run.normals);
            mesh.uvs.extend(run.uvs);
            mesh.triangles.extend(run.triangles.iter().map(|t| t.map(|i| offset + i)));
            materials.push(material);
        }
        (mesh, materials)
    }
}

/// Adds the sets of a face whose corners were just added; those it lacks have the coordinates of set 0.
fn add_uv_sets<'f>(run: &mut TriMesh, sets: impl Iterator<Item = (u8, &'f [DVec2])>) {
    let count = run.uvs.len();
    for (set, uvs) in sets {
        if run.uv_sets.iter().all(|(known, _)| *known != set) {
            run.uv_sets.push((set, run.uvs[..count - uvs.len()].to_vec()));
            run.uv_sets.sort_by_key(|(set, _)| *set);
        }
        let own = run.uv_sets.iter_mut().find(|(known, _)| *known == set).map(|(_, own)| own);
        own.expect("it is there now").extend(uvs.iter().map(|uv| uv.as_vec2()));
    }
    for (_, own) in &mut run.uv_sets {
        let from = own.len();
        own.extend_from_slice(&run.uvs[from..]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_with_a_hole_becomes_triangles_of_its_area() {
        let square = |s: f64| [(-s, -s), (s, -s), (s, s), (-s, s)].map(|(x, z)| DVec3::new(x, 0.0, z));
        let mesh = Mesh { positions: square(2.0).into_iter().chain(square(1.0)).collect(), faces: Vec::new() };
        let face = Face::with_holes([3, 2, 1, 0], [[4, 5, 6, 7]]);
        let mut builder = Builder::default();
        let material = Arc::new(Material::default());
        builder.face(&mesh, &face, &material, DVec3::new(0.0, 5.0, 0.0));
        let (mesh, materials) = builder.finish();
        let area: f64 = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                (b - a).cross(c - a).y / 2.0
            })
            .sum();
        assert!((area - 12.0).abs() < 1e-12, "{area}");
        assert!(mesh.positions.iter().all(|p| p.y == 5.0));
        assert_eq!((materials.len(), mesh.groups.len()), (1, 1));
    }

    #[test]
    fn corners_have_their_own_normals_or_the_face_s() {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, -1.0)];
        let mesh = Mesh { positions, faces: Vec::new() };
        let own = vec![DVec3::new(0.6, 0.8, 0.0), DVec3::Y, DVec3::new(0.0, 0.8, 0.6)];
        let mut builder = Builder::default();
        let material = Arc::new(Material::default());
        let flat = Face::new([0, 1, 2].as_slice());
        builder.face(&mesh, &flat, &material, DVec3::ZERO);
        builder.face(&mesh, &Face { normals: own.clone(), ..flat }, &material, DVec3::ZERO);
        let (mesh, _) = builder.finish();
        let expected: Vec<glam::Vec3> = [DVec3::Y; 3].into_iter().chain(own).map(|n| n.as_vec3()).collect();
        assert_eq!(mesh.normals, expected);
    }
}
