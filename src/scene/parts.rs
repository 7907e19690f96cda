//! What one derived feature contributes. In: its leaves and how it meets the ground. Out: solid triangles in their final
//! place, and flat faces that the ground mesh takes over.
//!
//! A *flat face* lies in the plane of the start shape and looks up. On features that are draped (streets, land cover,
//! anything whose rules leave flat faces, such as ash on a burnt footprint) flat faces become classes of the ground.

use std::sync::Arc;

use glam::{DMat2, DVec2, DVec3};

use super::ground::Surface;
use super::model::TriMesh;
use super::triangles::Builder;
use crate::geometry::{Face, Mesh, Polygon};
use crate::interpreter::material::Material;
use crate::interpreter::tree::Leaf;

/// How a feature meets the ground.
#[derive(Clone, Debug, PartialEq)]
pub enum Stand {
    /// Level on `base`; walls of solid bodies that touch it go `skirt` metres further down.
    Level { skirt: f64 },
    /// Flat faces join the ground mesh with this priority (higher covers lower); the rest is lifted by `lift` metres.
    Draped { priority: i32, surface: Surface, lift: f64 },
    /// A bridge: rises evenly from `heights[0]` at `from` to `heights[1]` at `to` (metres above `base`).
    Deck { from: DVec2, to: DVec2, heights: [f64; 2] },
}

/// Texture coordinates as an affine function of the plan position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanUv {
    matrix: DMat2,
    offset: DVec2,
}

/// One class of ground triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatFace {
    /// Plan: x east, y north.
    pub polygon: Polygon,
    pub material: Arc<Material>,
    pub uv: PlanUv,
    pub priority: i32,
    pub surface: Surface,
}

/// The contribution of one feature in one state.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    pub solid: TriMesh,
    /// Materials that the groups of `solid` number.
    pub materials: Vec<Arc<Material>>,
    pub flat: Vec<FlatFace>,
}

/// Vertical distance from the start plane within which a face is flat, metres.
const FLAT_WITHIN: f64 = 1e-6;

impl PlanUv {
    /// Coordinates per metre east and north: one tile covers `side` metres.
    pub fn tiles(side: f64) -> Self {
        PlanUv { matrix: DMat2::from_diagonal(DVec2::splat(1.0 / side)), offset: DVec2::ZERO }
    }

    pub fn at(&self, plan: DVec2) -> DVec2 {
        self.matrix * plan + self.offset
    }

    /// The function that takes these values at the corners of a face; `None` if the corners lie on one line.
    fn through(corners: &[DVec2], uvs: &[DVec2]) -> Option<Self> {
        let (origin, first) = (*corners.first()?, *uvs.first()?);
        let far = |i: &usize| (corners[*i] - origin).length_squared();
        let a = (1..corners.len()).max_by(|i, j| far(i).total_cmp(&far(j)))?;
        let wide = |i: &usize| (corners[a] - origin).perp_dot(corners[*i] - origin).abs();
        let b = (1..corners.len()).max_by(|i, j| wide(i).total_cmp(&wide(j)))?;
        let plan = DMat2::from_cols(corners[a] - origin, corners[b] - origin);
        if plan.determinant().abs() < 1e-12 {
            return None;
        }
        let matrix = DMat2::from_cols(uvs[a] - first, uvs[b] - first) * plan.inverse();
        Some(PlanUv { matrix, offset: first - matrix * origin })
    }
}

/// Sorts the leaves of one feature in one state into solid and flat parts. `base` is the world height of the plane
/// that the start shape lay in; `outline` is the start shape's polygon.
pub fn parts(leaves: &[Leaf], base: f64, stand: &Stand, outline: &Polygon) -> Parts {
    let mut solid = Builder::default();
    let mut flat = Vec::new();
    for leaf in leaves {
        for face in &leaf.mesh.faces {
            match stand {
                Stand::Draped { priority, surface, .. } if is_flat(&leaf.mesh, face, base) => {
                    flat.push(flat_face(&leaf.mesh, face, &leaf.material, (*priority, *surface)));
                }
                Stand::Draped { lift, .. } => {
                    solid.face(&leaf.mesh, face, &leaf.material, DVec3::new(0.0, *lift, 0.0));
                }
                Stand::Level { .. } | Stand::Deck { .. } => {
                    solid.face(&leaf.mesh, face, &leaf.material, DVec3::ZERO);
                }
            }
        }
    }
    let lowest = leaves.iter().flat_map(|l| &l.mesh.positions).map(|p| p.y).fold(f64::INFINITY, f64::min);
    if let Stand::Level { skirt } = stand
        && *skirt > 0.0
        && lowest <= base + FLAT_WITHIN
    {
        foundation(&mut solid, outline, base, *skirt);
    }
    let (mut solid, materials) = solid.finish();
    if let Stand::Deck { from, to, heights } = stand {
        raise(&mut solid, *from, *to, *heights);
    }
    Parts { solid, materials, flat }
}

/// Whether any leaf has a flat face: the feature is then draped even where its class stands level.
pub fn has_flat_face(leaves: &[Leaf], base: f64) -> bool {
    leaves.iter().any(|leaf| leaf.mesh.faces.iter().any(|face| is_flat(&leaf.mesh, face, base)))
}

fn is_flat(mesh: &Mesh, face: &Face, base: f64) -> bool {
    let level = face.loops().flatten().all(|&i| (mesh.positions[i as usize].y - base).abs() <= FLAT_WITHIN);
    level && mesh.newell(face).y > 0.0
}

fn flat_face(mesh: &Mesh, face: &Face, material: &Arc<Material>, (priority, surface): (i32, Surface)) -> FlatFace {
    let plan = |i: &u32| {
        let p = mesh.positions[*i as usize];
        DVec2::new(p.x, -p.z)
    };
    let ring = |r: &[u32]| r.iter().map(plan).collect::<Vec<_>>();
    let polygon = Polygon { outer: ring(&face.outer), holes: face.holes.iter().map(|h| ring(h)).collect() };
    let corners: Vec<DVec2> = polygon.rings().flatten().copied().collect();
    let uv = face.uv(0).and_then(|uvs| PlanUv::through(&corners, uvs)).unwrap_or(PlanUv::tiles(1.0));
    FlatFace { polygon, material: material.clone(), uv, priority, surface }
}

/// Walls from the base downwards along the outline, so that no gap shows where the ground falls.
fn foundation(solid: &mut Builder, outline: &Polygon, base: f64, depth: f64) {
    let material = Arc::new(Material { name: "foundation".into(), color: [0.55, 0.53, 0.49], ..Material::default() });
    for ring in outline.rings() {
        for (i, &a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            let at = |p: DVec2, h: f64| DVec3::new(p.x, h, -p.y);
            let positions = vec![at(a, base - depth), at(b, base - depth), at(b, base), at(a, base)];
            let mesh = Mesh { positions, faces: Vec::new() };
            solid.face(&mesh, &Face::new(vec![0, 1, 2, 3]), &material, DVec3::ZERO);
        }
    }
}

fn raise(mesh: &mut TriMesh, from: DVec2, to: DVec2, heights: [f64; 2]) {
    let along = to - from;
    let length_squared = along.length_squared().max(f64::MIN_POSITIVE);
    for p in &mut mesh.positions {
        let t = ((DVec2::new(p.x, -p.z) - from).dot(along) / length_squared).clamp(0.0, 1.0);
        p.y += heights[0] + (heights[1] - heights[0]) * t;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaf(points: &[[f64; 3]], uvs: Vec<DVec2>) -> Leaf {
        let outer: Vec<u32> = (0..points.len() as u32).collect();
        let uvs = if uvs.is_empty() { None } else { Some((0, uvs.into())) }.into_iter().collect();
        let face = Face { uvs, ..Face::new(outer) };
        Leaf {
            rule: "A".into(),
            path: Vec::new().into(),
            attributes: Vec::new().into(),
            material: Arc::default(),
            mesh: Mesh { positions: points.iter().map(|p| DVec3::from_array(*p)).collect(), faces: vec![face] },
        }
    }

    #[test]
    fn flat_faces_of_draped_features_go_to_the_ground_with_their_texture() {
        let square = [[0.0, 2.0, 0.0], [4.0, 2.0, 0.0], [4.0, 2.0, -4.0], [0.0, 2.0, -4.0]];
        let uvs = square.map(|p| DVec2::new(p[0] / 8.0 + 3.0, -p[2] / 4.0)).to_vec();
        let leaves = [leaf(&square, uvs), leaf(&square.map(|p| [p[0], 3.0, p[2]]), Vec::new())];
        assert!(has_flat_face(&leaves, 2.0) && !has_flat_face(&leaves[1..], 2.0));
        let parts = parts(
            &leaves,
            2.0,
            &Stand::Draped { priority: 5, surface: Surface::Drape, lift: 0.5 },
            &Polygon::default(),
        );
        assert_eq!(parts.flat.len(), 1);
        assert_eq!(parts.flat[0].polygon.outer[2], DVec2::new(4.0, 4.0));
        assert!((parts.flat[0].uv.at(DVec2::new(2.0, 1.0)) - DVec2::new(3.25, 0.25)).length() < 1e-12);
        assert!(parts.solid.positions.iter().all(|p| p.y == 3.5));
    }

    #[test]
    fn a_level_feature_gets_a_foundation_that_looks_outwards() {
        let wall = [[0.0, 2.0, 0.0], [4.0, 2.0, 0.0], [4.0, 5.0, 0.0], [0.0, 5.0, 0.0]];
        let outline = Polygon {
            outer: [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from).to_vec(),
            holes: vec![],
        };
        let parts = parts(&[leaf(&wall, Vec::new())], 2.0, &Stand::Level { skirt: 1.5 }, &outline);
        assert_eq!(parts.solid.triangles.len(), 2 + 8);
        let foundation = parts.solid.groups.iter().find(|g| g.count == 8).expect("four walls");
        for t in &parts.solid.triangles[foundation.first as usize..] {
            let p = parts.solid.positions[t[0] as usize];
            let n = parts.solid.normals[t[0] as usize].as_dvec3();
            assert!(n.dot(p - DVec3::new(2.0, 2.0, -2.0)) > 0.0, "looks inwards");
            assert!(p.y >= 0.5);
        }
    }

    #[test]
    fn a_deck_rises_evenly() {
        let deck = [[0.0, 1.0, 1.0], [10.0, 1.0, 1.0], [10.0, 1.0, -1.0], [0.0, 1.0, -1.0]];
        let stand = Stand::Deck { from: DVec2::ZERO, to: DVec2::new(10.0, 0.0), heights: [1.0, 3.0] };
        let parts = parts(&[leaf(&deck, Vec::new())], 1.0, &stand, &Polygon::default());
        for p in &parts.solid.positions {
            assert!((p.y - (2.0 + 0.2 * p.x)).abs() < 1e-12);
        }
    }
}
