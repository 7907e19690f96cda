//! OSM `roof:shape=saltbox`: two planes of one slope, the long one coming down to the walls. In: polygon, slope, ridge.
//! Out: the planes, walls up to them, the bottom.

use glam::DVec2;

use super::ridge::crested;
use super::{Roof, RoofError, Slope};
use crate::geometry::polygon::Polygon;

/// The ridge stands over this share of the extent across it, counted from the low side.
const RIDGE: f64 = 2.0 / 3.0;

/// A gable roof whose ridge is off the middle; the long plane falls in direction `downhill` (plan vector) and the wall
/// on the other side is half as high as the roof.
///
/// # Errors
/// Slope outside its domain; a direction without length.
pub fn saltbox(polygon: &Polygon, slope: Slope, downhill: DVec2) -> Result<Roof, RoofError> {
    let uphill = -downhill.try_normalize().ok_or(RoofError::Direction(downhill))?;
    crested(polygon, slope, uphill, RIDGE)
}
