//! The roofs of OpenStreetMap by name (`roof:shape`, <https://wiki.openstreetmap.org/wiki/Key:roof:shape>). In: a name,
//! a polygon, a slope, which way it looks. Out: a [`Roof`] by the file that makes it.

use glam::DVec2;

use super::gable::{gable, gabled, half_hipped_over};
use super::hip::hip;
use super::onion::onion;
use super::plan::{Edges, PlanRoof};
use super::profile::{Profile, over};
use super::pyramid::pyramid;
use super::ridge::ridge;
use super::saltbox::saltbox;
use super::shed::{shed, skillion};
use super::{Roof, RoofError, RoofWarning, Slope};
use crate::geometry::grid::Grid;
use crate::geometry::polygon::Polygon;
use crate::geometry::rectangle::least_around;
use crate::geometry::skeleton::{SkeletonError, skeleton};

/// A value of `roof:shape`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoofShape {
    Flat,
    Gabled,
    Hipped,
    HalfHipped,
    Pyramidal,
    Skillion,
    Gambrel,
    Mansard,
    Dome,
    Onion,
    Round,
    Saltbox,
}

/// Which way a roof with a direction looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Facing {
    /// As the outline suggests.
    Natural,
    /// OSM `roof:direction`: the (larger) plane falls this way (plan vector); ridges run across it.
    Downhill(DVec2),
    /// OSM `roof:orientation=along`: ridges along the longer side.
    Along,
    /// OSM `roof:orientation=across`.
    Across,
}

/// Names by shape; the first is the one of the map's documentation, the others are seen in maps and mean the same.
const NAMES: &[(RoofShape, &[&str])] = &[
    (RoofShape::Flat, &["flat", "none", "terrace"]),
    (RoofShape::Gabled, &["gabled", "gable", "pitched", "saddle"]),
    (RoofShape::Hipped, &["hipped", "hip"]),
    (RoofShape::HalfHipped, &["half-hipped", "half-hip", "jerkinhead", "clipped-gable"]),
    (RoofShape::Pyramidal, &["pyramidal", "pyramid", "cone", "conical", "spire", "tented"]),
    (RoofShape::Skillion, &["skillion", "lean-to", "shed", "monopitch", "mono-pitched", "pent"]),
    (RoofShape::Gambrel, &["gambrel"]),
    (RoofShape::Mansard, &["mansard"]),
    (RoofShape::Dome, &["dome", "domed", "cupola"]),
    (RoofShape::Onion, &["onion", "onion-dome", "bulb"]),
    (RoofShape::Round, &["round", "barrel", "vaulted"]),
    (RoofShape::Saltbox, &["saltbox", "catslide"]),
];

/// Where the planes of gambrel and mansard bend: share of the way to the ridge, and of the height.
const BEND: (f64, f64) = (0.3, 0.7);
/// Share of a pediment that stays upright under a half hip.
const UPRIGHT: f64 = 0.5;
/// Usual bands of planes from the eaves to the top of domes and barrels.
pub const CURVE_BANDS: u32 = 8;

impl RoofShape {
    pub const ALL: [RoofShape; 12] = {
        use RoofShape as R;
        [
            R::Flat,
            R::Gabled,
            R::Hipped,
            R::HalfHipped,
            R::Pyramidal,
            R::Skillion,
            R::Gambrel,
            R::Mansard,
            R::Dome,
            R::Onion,
            R::Round,
            R::Saltbox,
        ]
    };

    /// As the map's documentation writes it.
    pub fn name(self) -> &'static str {
        NAMES.iter().find(|(shape, _)| *shape == self).map_or("", |(_, names)| names[0])
    }

    /// By any of its names; case does not matter, and `_`, `-` and a space are one.
    pub fn from_name(name: &str) -> Option<RoofShape> {
        let plain = name.trim().to_lowercase().replace(['_', ' '], "-");
        NAMES.iter().find(|(_, names)| names.contains(&&*plain)).map(|(shape, _)| *shape)
    }

    /// All names that are understood.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMES.iter().flat_map(|(_, names)| *names).copied()
    }

    /// The roof of this shape; `None` for a flat one and without a slope. On bent roofs an angle is that of the straight line from the eaves
    /// to the ridge. Facing matters to shapes with a ridge or one plane.
    ///
    /// # Errors
    /// Slope or direction outside their domain; an outline that the shape cannot stand on.
    pub fn build(self, polygon: &Polygon, slope: Slope, facing: Facing) -> Result<Option<Roof>, RoofError> {
        self.banded(polygon, slope, facing, CURVE_BANDS)
    }

    /// As [`RoofShape::build`] with this many bands of planes from the eaves to the top of what is round.
    pub fn banded(
        self,
        polygon: &Polygon,
        slope: Slope,
        facing: Facing,
        bands: u32,
    ) -> Result<Option<Roof>, RoofError> {
        if self == RoofShape::Flat || slope.tangent(1.0)? == 0.0 {
            return Ok(None);
        }
        if polygon.outer.len() < 3 {
            return Err(SkeletonError::TooFewPoints.into());
        }
        if polygon.bounds().and_then(|(low, high)| Grid::over(low, high)).is_none() {
            return Err(SkeletonError::NotFinite.into());
        }
        let bend = || Profile::bent(BEND);
        let barrel = || Profile::quarter_circle(bands);
        let hips = || Ok::<_, RoofError>(PlanRoof::of_skeleton(skeleton(polygon, None)?));
        let roof = match self {
            RoofShape::Flat => return Ok(None),
            RoofShape::Gabled => match ridge_direction(polygon, facing)? {
                Some(along) if !takes_index(polygon) => ridge(polygon, slope, along)?,
                along => gable(polygon, slope, 0.0, 0.0, false, along.and_then(|a| end_over(polygon, a)))?,
            },
            RoofShape::Hipped => hip(polygon, slope, 0.0, false)?,
            RoofShape::HalfHipped => half_hipped_over(turned(polygon, facing)?, polygon, slope, UPRIGHT)?,
            // Where the apex does not see an edge, the face over it would hang over the outside.
            RoofShape::Pyramidal => Some(pyramid(polygon, slope)?)
                .filter(|roof| !roof.warnings.contains(&RoofWarning::Overlapping))
                .ok_or(RoofError::HiddenEdge)?,
            RoofShape::Skillion => match facing {
                Facing::Downhill(downhill) => skillion(polygon, slope, downhill)?,
                _ => shed(polygon, slope, 0)?,
            },
            RoofShape::Gambrel => over(turned(polygon, facing)?, slope, &bend())?.into_roof(polygon),
            RoofShape::Mansard => over(hips()?, slope, &bend())?.into_roof(polygon),
            RoofShape::Dome => over(hips()?, slope, &barrel())?.into_roof(polygon),
            RoofShape::Onion => onion(polygon, slope)?,
            RoofShape::Round => over(turned(polygon, facing)?, slope, &barrel())?.into_roof(polygon),
            RoofShape::Saltbox => saltbox(polygon, slope, long_side(polygon, facing)?)?,
        };
        Ok(Some(roof))
    }
}

/// The direction of the ridge that is asked for, made parallel to the edge nearest to it, so that small errors of a map
/// do not turn a roof against its walls.
fn ridge_direction(polygon: &Polygon, facing: Facing) -> Result<Option<DVec2>, RoofError> {
    let longer = || least_around(&polygon.outer).unwrap_or(DVec2::X);
    let wanted = match facing {
        Facing::Natural => return Ok(None),
        Facing::Downhill(downhill) => downhill.try_normalize().ok_or(RoofError::Direction(downhill))?.perp(),
        Facing::Along => longer(),
        Facing::Across => longer().perp(),
    };
    let edges = Edges::of(polygon);
    let directions = (0..polygon.outer.len()).flat_map(|e| [edges.normal(e), edges.normal(e).perp()]);
    let nearest = directions.max_by(|p, q| p.dot(wanted).abs().total_cmp(&q.dot(wanted).abs()));
    Ok(Some(nearest.filter(|d| *d != DVec2::ZERO).unwrap_or(wanted)))
}

/// Whether pediments can be put over chosen edges.
fn takes_index(polygon: &Polygon) -> bool {
    polygon.holes.is_empty() && super::gable::is_convex(polygon)
}

/// The index (as [`gable`] takes it) of the edge that a ridge in this direction ends over; `None` without edges.
fn end_over(polygon: &Polygon, along: DVec2) -> Option<i64> {
    let edges = Edges::of(polygon);
    let count = polygon.outer.len();
    let facing = |e: &usize| edges.normal(*e).dot(along).abs();
    let end = (0..count).rev().max_by(|p, q| facing(p).total_cmp(&facing(q)))?;
    // On a triangle the index is that of the vertex opposite.
    Some(if count == 3 { (end + 2) % 3 } else { end } as i64)
}

/// The gable roof of slope 1 with its ridge turned, where the outline allows.
fn turned(polygon: &Polygon, facing: Facing) -> Result<PlanRoof, RoofError> {
    let Some(along) = ridge_direction(polygon, facing)? else { return gabled(polygon) };
    match end_over(polygon, along).filter(|_| takes_index(polygon)) {
        Some(index) => super::gable::gabled_over(polygon, index),
        None => {
            let mut plan = gabled(polygon)?;
            plan.warnings.push(RoofWarning::IndexIgnored);
            Ok(plan)
        }
    }
}

/// Where the long plane of a saltbox falls to: across the ridge, on the side of the first edge if nothing else is
/// asked.
fn long_side(polygon: &Polygon, facing: Facing) -> Result<DVec2, RoofError> {
    let facing = if facing == Facing::Natural { Facing::Along } else { facing };
    let Some(along) = ridge_direction(polygon, facing)? else { return Ok(DVec2::NEG_Y) };
    let across = along.perp();
    let first = Edges::of(polygon).normal(0);
    let wanted = match facing {
        Facing::Downhill(downhill) => downhill,
        // Where the first edge runs across the ridge: the way it runs, so that turned outlines agree.
        _ if across.dot(first).abs() < 1e-6 => -first.perp(),
        _ => -first,
    };
    Ok(if across.dot(wanted) < 0.0 { -across } else { across })
}
