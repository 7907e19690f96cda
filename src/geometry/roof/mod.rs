//! Roof meshes over a plan polygon. In: a repaired [`Polygon`] and slope, overhang, edge. Out: a closed [`Roof`] in a
//! local frame where the polygon lies at height 0: plan (x, y) becomes (x, height, -y).

mod gable;
mod hip;
mod onion;
mod osm;
mod overhang;
mod plan;
mod profile;
mod pyramid;
mod ridge;
mod saltbox;
mod shed;
mod sound;

#[cfg(test)]
mod tests;

pub use self::gable::{gable, half_hipped};
pub use self::hip::hip;
pub use self::onion::onion;
pub use self::osm::{CURVE_BANDS, Facing, RoofShape};
pub use self::profile::{Profile, dome, gambrel, mansard, round};
pub use self::pyramid::pyramid;
pub use self::ridge::ridge;
pub use self::saltbox::saltbox;
pub use self::shed::{shed, skillion};
pub use self::sound::{FellBack, SoundRoof, sound};

use self::plan::{PlanFace, PlanRoof};
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
    Top {
        edge: Option<usize>,
    },
    /// A vertical face over an edge: pediment or wall.
    Side {
        edge: usize,
    },
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
    #[error("the roof angle of {0} degrees is outside its domain (0 to below 90; a shed may also fall, above -90)")]
    Angle(f64),
    #[error("roof height {0} is not a finite number of at least 0")]
    Height(f64),
    #[error("overhang {0} is not a finite number of at least 0")]
    Overhang(f64),
    #[error("{0} is not a direction")]
    Direction(glam::DVec2),
    #[error("the fraction {0} is not between 0 and 1")]
    Fraction(f64),
    #[error("not every edge of the outline can be seen from its middle")]
    HiddenEdge,
    #[error(transparent)]
    Skeleton(#[from] SkeletonError),
}

impl Slope {
    /// The tangent of the slope, given the height of the roof at slope 1.
    fn tangent(self, unit_height: f64) -> Result<f64, RoofError> {
        match self {
            Slope::Angle(degrees) if (0.0..90.0).contains(&degrees) => Ok(libm::tan(degrees.to_radians())),
            Slope::Angle(degrees) => Err(RoofError::Angle(degrees)),
            Slope::Height(height) if height.is_finite() && height >= 0.0 => {
                Ok(if unit_height > 0.0 { height / unit_height } else { 0.0 })
            }
            Slope::Height(height) => Err(RoofError::Height(height)),
        }
    }
}

/// The polygon itself, facing up: the one roof that is no closed body.
pub fn flat(polygon: &Polygon) -> Roof {
    let mut plan = PlanRoof::of_vertices(polygon);
    let mut first = 0;
    let mut rings = polygon.rings().map(|ring| {
        let ids: Vec<u32> = (first..first + ring.len() as u32).collect();
        first += ring.len() as u32;
        ids
    });
    let ring = rings.next().unwrap_or_default();
    plan.faces.push(PlanFace { part: RoofPart::Top { edge: None }, ring, holes: rings.collect() });
    plan.into_sheet()
}

/// A length that must be finite and not negative.
fn check_overhang(overhang: f64) -> Result<f64, RoofError> {
    if overhang.is_finite() && overhang >= 0.0 { Ok(overhang) } else { Err(RoofError::Overhang(overhang)) }
}
