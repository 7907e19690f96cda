//! In: the scene's area, its terrain, and polygons that cover the ground. Out: one [`GroundMesh`] without cracks.
//!
//! The borders of all polygons and the terrain's own posts become vertices of one constrained Delaunay triangulation,
//! so layers never lie over each other: each triangle belongs to the uppermost polygon at its place. There is nothing
//! to fight over in the depth buffer, and no T-junction.
//!
//! Steps: (1) cut polygon borders to the area and bend them with the terrain, (2) take all borders apart at their
//! crossings, (3) triangulate, (4) level the water, (5) add posts until the tolerance is met, (6) give each triangle
//! its layer.

mod arrangement;
mod border;
mod cover;
mod lattice;
mod refine;
#[cfg(test)]
mod tests;
mod triangulation;

use glam::{DVec2, DVec3, Vec3};

use crate::geodata::terrain::Terrain;
use crate::geometry::Polygon;
use cover::Cover;
use triangulation::{Triangulation, Vertex};

/// How a layer lies on the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Surface {
    /// Follows the terrain.
    #[default]
    Drape,
    /// Each polygon is level at the least height along its shore: lakes and pools, not rivers.
    Level,
}

/// Polygons of one kind on the ground.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroundLayer {
    /// In the plan, metres (x east, y north). They may overlap each other and reach beyond the area.
    pub polygons: Vec<Polygon>,
    /// Where layers overlap the greatest is seen; of equal ones the first in the list.
    pub priority: i32,
    /// Handed through to the triangles.
    pub payload: u32,
    pub surface: Surface,
}

/// The ground as triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroundMesh {
    /// World positions (x east, y up, z south), metres; no two are equal in the plan.
    pub positions: Vec<DVec3>,
    /// Counter-clockwise seen from above, with the payload of the uppermost layer (`None`: bare ground); grouped by
    /// payload, bare ground first.
    pub triangles: Vec<([u32; 3], Option<u32>)>,
    /// Greatest vertical distance to the terrain: at every post inside the area and along all borders where the
    /// terrain can bend, metres. Level water is not counted.
    pub worst_error_m: f64,
    /// Triangles left out because the terrain has no height at a corner.
    pub without_height: usize,
}

/// Why there is no ground mesh.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GroundError {
    #[error("the ground's area is empty")]
    EmptyArea,
    #[error("a ground polygon has a coordinate that is not within 1,000 km of the scene's centre")]
    Coordinate,
    #[error("the vertical tolerance of the ground must be greater than zero, not {0} m")]
    Tolerance(f64),
    #[error("the borders on the ground cannot be taken apart")]
    Unresolved,
}

/// Builds the ground of an area. `tolerance_m` is the greatest vertical distance to the terrain that is aimed at; it is
/// met where the terrain's posts suffice for it ([`GroundMesh::worst_error_m`] is measured).
pub fn build_ground(
    area: &Polygon,
    terrain: &Terrain,
    tolerance_m: f64,
    layers: &[GroundLayer],
) -> Result<GroundMesh, GroundError> {
    if tolerance_m.is_nan() || tolerance_m <= 0.0 {
        return Err(GroundError::Tolerance(tolerance_m));
    }
    let (lo, hi) =
        area.bounds().filter(|(lo, hi)| (*hi - *lo).cmpgt(DVec2::ZERO).all()).ok_or(GroundError::EmptyArea)?;

    // Borders, bent with the terrain. A border that is split later can be off twice as far.
    let mut borders = border::Borders::new(lo, hi, terrain, tolerance_m / 2.0);
    borders.add_polygon(area)?;
    for layer in layers {
        layer.polygons.iter().try_for_each(|p| borders.add_polygon(p))?;
    }
    let (segments, border_error) = borders.finish();
    let segments = arrangement::arrange(segments).ok_or(GroundError::Unresolved)?;

    // Triangles, and the layer of each.
    let mut triangulation = triangulation::triangulate(&segments, terrain)?;
    let cover = Cover::new(area, layers);
    let level = cover::level_water(&mut triangulation, &cover, terrain);
    let posts = posts(terrain, lo, hi, &cover, &level);
    let post_error = refine::refine(&mut triangulation, &posts, tolerance_m)?;

    let owners = cover::owners(&triangulation, &cover);
    let mut mesh = collect(&triangulation, &owners, &cover);
    mesh.worst_error_m = border_error.max(post_error);
    Ok(mesh)
}

/// The terrain's posts inside the area but not on level water, on the lattice.
fn posts(terrain: &Terrain, lo: DVec2, hi: DVec2, cover: &Cover, level: &[bool]) -> Vec<Vertex> {
    let any_level = level.contains(&true);
    let snapped = terrain.posts(lo, hi).into_iter().map(|p| lattice::metres(lattice::snap(p)));
    let wanted = snapped.filter(|&p| match cover.owner_or_bare(p, any_level) {
        cover::Owner::Outside => false,
        cover::Owner::Bare => true,
        cover::Owner::Layer(polygon) => !level[polygon],
    });
    wanted.filter_map(|p| terrain.height(p).map(|h| Vertex::new(p, h))).collect()
}

/// Keeps the triangles of the area that have heights, and their vertices, numbered in order of first use.
fn collect(triangulation: &Triangulation, owners: &[cover::Owner], cover: &Cover) -> GroundMesh {
    let mut mesh = GroundMesh::default();
    let mut triangles: Vec<([usize; 3], Option<u32>)> = Vec::new();
    for (corners, owner) in triangulation::faces(triangulation).zip(owners) {
        let payload = match *owner {
            cover::Owner::Outside => continue,
            cover::Owner::Bare => None,
            cover::Owner::Layer(polygon) => Some(cover.payload(polygon)),
        };
        if corners.iter().any(|&c| triangulation::vertex(triangulation, c).height.is_nan()) {
            mesh.without_height += 1;
            continue;
        }
        triangles.push((corners, payload));
    }
    triangles.sort_by_key(|&(_, payload)| payload);
    let mut number = vec![u32::MAX; triangulation::vertex_count(triangulation)];
    for (corners, payload) in triangles {
        let corners = corners.map(|c| {
            if number[c] == u32::MAX {
                number[c] = mesh.positions.len() as u32;
                let v = triangulation::vertex(triangulation, c);
                mesh.positions.push(DVec3::new(v.plan().x, v.height, -v.plan().y));
            }
            number[c]
        });
        mesh.triangles.push((corners, payload));
    }
    mesh
}

impl GroundMesh {
    /// Smooth unit normals, one per position: the mean of the triangles around it, weighted by area.
    pub fn normals(&self) -> Vec<Vec3> {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for (corners, _) in &self.triangles {
            let [a, b, c] = corners.map(|i| self.positions[i as usize]);
            let normal = (b - a).cross(c - a);
            corners.iter().for_each(|&i| sums[i as usize] += normal);
        }
        sums.into_iter().map(|n| n.normalize_or(DVec3::Y).as_vec3()).collect()
    }
}
