//! Roof meshes over a plan polygon. In: a repaired [`Polygon`] and slope, overhang, edge. Out: a closed [`Roof`] in a
//! local frame where the polygon lies at height 0: plan (x, y) becomes (x, height, -y).

use crate::geometry::mesh::Mesh;
use crate::geometry::polygon::Polygon;
use crate::geometry::skeleton::SkeletonError;

/// How steep: CGA `byAngle` (degrees) or `byHeight` (metres from the polygon to the highest point, overhang not counted).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slope {
    Angle(f64),
    Height(f64),
}

/// What a face of a roof is; CGA tags `roof.bottom`, `roof.top`, `roof.side`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoofPart {
    Bottom,
    /// A roof plane over an edge (index over the outer ring, then holes), or a plane over the whole polygon.
    Top { edge: Option<usize> },
    /// A vertical face over an edge: pediment or wall.
    Side { edge: usize },
}

/// A closed roof: `parts[i]` tells what `mesh.faces[i]` is. The bottom comes first (the polygon, facing down), then the
/// faces in edge order, each starting with its eave.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Roof {
    pub mesh: Mesh,
    pub parts: Vec<RoofPart>,
    pub warnings: Vec<RoofWarning>,
}

/// A result that the caller should hear about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoofWarning {
    /// The ridge direction of a gable roof can be chosen on convex outlines without holes only.
    IndexIgnored,
    /// The apex of a pyramid does not see all edges: its faces overlap in plan.
    Overlapping,
    /// The holes were covered.
    HolesDropped,
}

/// Why there is no roof.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RoofError {
    #[error("roof angle {0} is outside 0 <= angle < 90 degrees")]
    Angle(f64),
    #[error("roof height {0} is not a finite number of at least 0")]
    Height(f64),
    #[error("overhang {0} is not a finite number of at least 0")]
    Overhang(f64),
    #[error(transparent)]
    Skeleton(#[from] SkeletonError),
}

/// CGA `roofHip`. `overhang` is measured on the roof plane; `even` levels the ridges at their mean height.
pub fn hip(polygon: &Polygon, slope: Slope, overhang: f64, even: bool) -> Result<Roof, RoofError> {
    todo!()
}

/// CGA `roofGable`: `overhang_x` at the eaves, `overhang_y` at the gables; `index` is the edge that becomes a gable.
pub fn gable(
    polygon: &Polygon,
    slope: Slope,
    overhang_x: f64,
    overhang_y: f64,
    even: bool,
    index: Option<i64>,
) -> Result<Roof, RoofError> {
    todo!()
}

/// CGA `roofPyramid`: apex over the mean of the vertices.
pub fn pyramid(polygon: &Polygon, slope: Slope) -> Result<Roof, RoofError> {
    todo!()
}

/// CGA `roofShed`: one plane through edge `index` (wraps around; negative counts from the end).
pub fn shed(polygon: &Polygon, slope: Slope, index: i64) -> Result<Roof, RoofError> {
    todo!()
}

/// CGA `roofRidge`: one level ridge in direction `along` (plan), vertical sides.
pub fn ridge(polygon: &Polygon, slope: Slope, along: glam::DVec2) -> Result<Roof, RoofError> {
    todo!()
}
