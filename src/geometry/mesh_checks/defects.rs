//! All defects of a mesh by name. In: a mesh. Out: how often each defect occurs, and where it is first met.

use super::*;

/// A defect, in the order in which they are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Defect {
    MissingVertex,
    NonFiniteVertex,
    OpenEdge,
    EdgeUsedMoreThanTwice,
    FlippedFace,
    DegenerateFace,
    DegenerateTriangle,
    NonPlanarFace,
    SelfIntersection,
    NegativeVolume,
    VolumeAgainstAnalytic,
}

impl Defect {
    pub const ALL: [Defect; 11] = [
        Defect::MissingVertex,
        Defect::NonFiniteVertex,
        Defect::OpenEdge,
        Defect::EdgeUsedMoreThanTwice,
        Defect::FlippedFace,
        Defect::DegenerateFace,
        Defect::DegenerateTriangle,
        Defect::NonPlanarFace,
        Defect::SelfIntersection,
        Defect::NegativeVolume,
        Defect::VolumeAgainstAnalytic,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Defect::MissingVertex => "missing vertex",
            Defect::NonFiniteVertex => "vertex that is not finite",
            Defect::OpenEdge => "open edge",
            Defect::EdgeUsedMoreThanTwice => "edge used more than twice",
            Defect::FlippedFace => "flipped face",
            Defect::DegenerateFace => "degenerate face",
            Defect::DegenerateTriangle => "degenerate triangle",
            Defect::NonPlanarFace => "non-planar face",
            Defect::SelfIntersection => "self-intersection",
            Defect::NegativeVolume => "negative volume",
            Defect::VolumeAgainstAnalytic => "volume against analytic",
        }
    }
}

/// Rounding of positions and planes, as a share of a mesh's extent.
pub const ROUNDING: f64 = 1e-7;

/// Number of findings by defect, only those that were found. `ignored` defects are not looked for. Where a vertex is
/// missing or not finite nothing else can be said.
pub fn defects(mesh: &Mesh, ignored: &[Defect]) -> Vec<(Defect, usize)> {
    let unusable = [(Defect::MissingVertex, missing_vertices(mesh).len())];
    if unusable[0].1 > 0 {
        return unusable.to_vec();
    }
    let unusable = [(Defect::NonFiniteVertex, non_finite_vertices(mesh).len())];
    if unusable[0].1 > 0 {
        return unusable.to_vec();
    }
    let Some((low, high)) = mesh.bounds() else { return Vec::new() };
    let tolerance = ROUNDING * (high - low).max_element();
    let count = |defect: Defect| match defect {
        Defect::MissingVertex | Defect::NonFiniteVertex => 0,
        Defect::OpenEdge => open_edges(mesh).len(),
        Defect::EdgeUsedMoreThanTwice => edges_used_more_than_twice(mesh).len(),
        Defect::FlippedFace => edges_run_twice_the_same_way(mesh).len(),
        Defect::DegenerateFace => faces_without_area(mesh).len() + doubled_corners(mesh).len(),
        Defect::DegenerateTriangle => degenerate_triangles(mesh).len() + faces_not_triangulated(mesh).len(),
        Defect::NonPlanarFace => non_planar_faces(mesh, tolerance).len(),
        Defect::SelfIntersection => self_intersections(mesh, tolerance).len(),
        Defect::NegativeVolume => usize::from(volume(mesh) < -tolerance * surface_area(mesh)),
        Defect::VolumeAgainstAnalytic => {
            usize::from((volume(mesh) - volume_by_planes(mesh)).abs() > tolerance * surface_area(mesh))
        }
    };
    let wanted = Defect::ALL.into_iter().filter(|d| !ignored.contains(d));
    wanted.map(|d| (d, count(d))).filter(|(_, n)| *n > 0).collect()
}
