//! Roofs whose planes bend: mansard, gambrel, dome, round. In: polygon and a profile, height over distance from the eaves.
//! Out: the faces of the hip or gable roof, cut at the breaks of the profile.

use std::collections::BTreeMap;

use super::gable::gabled;
use super::plan::{PlanFace, PlanRoof};
use super::{Roof, RoofError, RoofPart, Slope};
use crate::geometry::polygon::Polygon;
use crate::geometry::skeleton::skeleton;

/// Height over distance from the eaves: straight pieces between (distance, height) points that start with (0, 0), metres;
/// level beyond the last point.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    points: Vec<(f64, f64)>,
}

impl Profile {
    /// Steep up to `break_distance`, flatter beyond, as far as `reach`.
    ///
    /// # Errors
    /// Angles outside 0 to 90 degrees, a distance that is negative or not finite.
    pub fn two_slopes(lower: f64, upper: f64, break_distance: f64, reach: f64) -> Result<Profile, RoofError> {
        if !(break_distance.is_finite() && break_distance >= 0.0) {
            return Err(RoofError::Overhang(break_distance));
        }
        let (steep, flat) = (Slope::Angle(lower).tangent(1.0)?, Slope::Angle(upper).tangent(1.0)?);
        let first = break_distance.min(reach);
        let mut points = vec![(0.0, 0.0)];
        if first > 0.0 {
            points.push((first, steep * first));
        }
        if reach > first {
            points.push((reach, steep * first + flat * (reach - first)));
        }
        Ok(Profile { points })
    }

    /// A quarter of an ellipse, from the eaves to `height` at distance `reach`, in straight pieces.
    ///
    /// # Errors
    /// A height that is negative or not finite.
    pub fn ellipse(height: f64, reach: f64, pieces: u32) -> Result<Profile, RoofError> {
        if !(height.is_finite() && height >= 0.0) {
            return Err(RoofError::Height(height));
        }
        let pieces = pieces.max(1);
        let point = |k: u32| {
            let angle = std::f64::consts::FRAC_PI_2 * f64::from(k) / f64::from(pieces);
            match k {
                0 => (0.0, 0.0),
                k if k == pieces => (reach, height),
                _ => (reach * (1.0 - libm::cos(angle)), height * libm::sin(angle)),
            }
        };
        Ok(Profile { points: (0..=pieces).map(point).collect() })
    }

    /// Two straight pieces over a reach and a height of 1, that meet at (share of the reach, share of the height).
    pub(super) fn bent(at: (f64, f64)) -> Profile {
        Profile { points: vec![(0.0, 0.0), at, (1.0, 1.0)] }
    }

    /// A quarter of a circle over a reach and a height of 1.
    pub(super) fn quarter_circle(pieces: u32) -> Profile {
        Profile::ellipse(1.0, 1.0, pieces).expect("a height of 1 is in its domain")
    }

    /// Stretched along both axes.
    fn stretched(&self, reach: f64, height: f64) -> Profile {
        Profile { points: self.points.iter().map(|&(d, h)| (d * reach, h * height)).collect() }
    }

    fn height(&self, distance: f64) -> f64 {
        for w in self.points.windows(2) {
            let ((d0, h0), (d1, h1)) = (w[0], w[1]);
            if distance <= d1 {
                return h0 + (h1 - h0) * (distance - d0) / (d1 - d0);
            }
        }
        self.points.last().map_or(0.0, |p| p.1)
    }
}

/// OSM `roof:shape=mansard`: hip planes of `lower` degrees up to `break_distance` from the eaves, then of `upper` degrees.
///
/// # Errors
/// Angles or distance outside their domain; those of the skeleton.
pub fn mansard(polygon: &Polygon, lower: f64, upper: f64, break_distance: f64) -> Result<Roof, RoofError> {
    let plan = PlanRoof::of_skeleton(skeleton(polygon, None)?);
    let profile = Profile::two_slopes(lower, upper, break_distance, plan.highest())?;
    Ok(bend(plan, &profile).into_roof(polygon))
}

/// OSM `roof:shape=gambrel`: as [`mansard`], over gables.
///
/// # Errors
/// Angles or distance outside their domain; those of the skeleton.
pub fn gambrel(polygon: &Polygon, lower: f64, upper: f64, break_distance: f64) -> Result<Roof, RoofError> {
    let plan = gabled(polygon)?;
    let profile = Profile::two_slopes(lower, upper, break_distance, plan.highest())?;
    Ok(bend(plan, &profile).into_roof(polygon))
}

/// OSM `roof:shape=dome`: an elliptic profile over the hips; `pieces` bands.
///
/// # Errors
/// A height outside its domain; those of the skeleton.
pub fn dome(polygon: &Polygon, height: f64, pieces: u32) -> Result<Roof, RoofError> {
    let plan = PlanRoof::of_skeleton(skeleton(polygon, None)?);
    let profile = Profile::ellipse(height, plan.highest(), pieces)?;
    Ok(bend(plan, &profile).into_roof(polygon))
}

/// OSM `roof:shape=round`: an elliptic profile between gables; `pieces` bands on each side.
///
/// # Errors
/// A height outside its domain; those of the skeleton.
pub fn round(polygon: &Polygon, height: f64, pieces: u32) -> Result<Roof, RoofError> {
    let plan = gabled(polygon)?;
    let profile = Profile::ellipse(height, plan.highest(), pieces)?;
    Ok(bend(plan, &profile).into_roof(polygon))
}

/// A roof of slope 1 bent by a profile over a reach and a height of 1; an angle is that from the eaves to the top.
pub(super) fn over(plan: PlanRoof, slope: Slope, profile: &Profile) -> Result<PlanRoof, RoofError> {
    let reach = plan.highest();
    let height = slope.tangent(reach)? * reach;
    Ok(bend(plan, &profile.stretched(reach, height)))
}

/// Cut a roof of slope 1 at the breaks of the profile and put its nodes on the profile's heights.
fn bend(mut plan: PlanRoof, profile: &Profile) -> PlanRoof {
    let reach = plan.highest();
    for &(distance, _) in &profile.points {
        if distance > 0.0 && distance < reach {
            cut_at(&mut plan, distance);
        }
    }
    plan.nodes.iter_mut().for_each(|n| n.height = profile.height(n.height));
    plan
}

/// Cut all roof planes at a height; pediments get the new corners but stay whole.
fn cut_at(plan: &mut PlanRoof, level: f64) {
    let mut crossings: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let faces = std::mem::take(&mut plan.faces);
    for face in faces {
        let mut below = Vec::new();
        let mut above: Vec<Vec<u32>> = Vec::new();
        let mut run: Vec<u32> = Vec::new();
        let mut whole = Vec::new();
        let ring = &face.ring;
        for k in 0..ring.len() {
            let (p, q) = (ring[k], ring[(k + 1) % ring.len()]);
            let (hp, hq) = (plan.node(p).height, plan.node(q).height);
            whole.push(p);
            if hp <= level {
                below.push(p)
            } else {
                run.push(p)
            }
            if (hp <= level) == (hq <= level) {
                continue;
            }
            let (low, high) = if hp <= level { (p, q) } else { (q, p) };
            let c = *crossings.entry((low, high)).or_insert_with(|| crossing(plan, low, high, level));
            if c != low {
                whole.push(c);
                below.push(c);
            }
            run.push(c);
            if hq <= level {
                above.push(std::mem::take(&mut run));
            }
        }
        let PlanFace { part, holes, .. } = face;
        if matches!(part, RoofPart::Side { .. }) || above.is_empty() {
            plan.faces.push(PlanFace { part, ring: whole, holes });
            continue;
        }
        plan.faces.push(PlanFace { part, ring: below, holes });
        for mut ring in above {
            // From the crossing upwards, over, and back down: the last piece is the lower edge.
            ring.rotate_right(1);
            plan.faces.push(PlanFace { part, ring, holes: Vec::new() });
        }
    }
    plan.faces.retain(|f| f.ring.len() >= 3);
}

/// The node at a height between two others; the lower one if it lies there.
fn crossing(plan: &mut PlanRoof, low: u32, high: u32, level: f64) -> u32 {
    let (p, q) = (*plan.node(low), *plan.node(high));
    if p.height == level {
        return low;
    }
    let u = (level - p.height) / (q.height - p.height);
    plan.add_node(p.position.lerp(q.position, u), level)
}
