//! Viewpoint: where the window's camera stands, and how hands move it. In: drags, scrolls and keys as numbers. Out: a
//! [`Camera`] of any size. A recipe's camera is kept to the bit until something moves it.

use glam::{DQuat, DVec3};

use crate::plan::demand::{Camera, Projection};

/// Degrees between the line of sight and the vertical that orbiting does not go beyond: the ground stays below.
const MOST_ORBIT_DEG: f64 = 88.0;
/// The same for looking about, which may go above the horizon.
const MOST_LOOK_DEG: f64 = 160.0;
/// Metres; the target is never nearer.
const LEAST_DISTANCE_M: f64 = 0.5;
/// Metres; the near plane is never nearer.
const LEAST_NEAR_M: f64 = 0.1;
/// Pixels of dragging after which a tilted horizon is level.
const LEVEL_PX: f64 = 300.0;
/// Cosine between line of sight and vertical below which dragging moves along the image plane, not the ground.
const GRAZING: f64 = 0.2;
/// Around a scene that is framed, of its size.
const ROOM: f64 = 1.04;
/// Half of the field of view, degrees, of a camera that the window made itself.
const OWN_HALF_FOV_DEG: f64 = 20.0;

/// Least and greatest corner of what there is to see, world metres.
pub type Bounds = (DVec3, DVec3);

/// A point in the picture: pixels from its left upper corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    pub x: f64,
    pub y: f64,
}

/// Where the camera stands and what it turns about. `right`, `up`, `forward` as in [`Camera`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    pub target: DVec3,
    pub distance: f64,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Half extents that must be seen, in whatever shape of picture.
    lens: Projection,
    /// The camera that it was made of, while nothing has moved it.
    given: Option<Camera>,
}

impl Viewpoint {
    /// Exactly this camera, turning about the point of its axis at the height of `centre`.
    pub fn of(camera: &Camera, centre: DVec3) -> Viewpoint {
        let along = (centre - camera.position).dot(camera.forward).max(LEAST_DISTANCE_M);
        Viewpoint {
            target: camera.position + camera.forward * along,
            distance: along,
            right: camera.right,
            up: camera.up,
            forward: camera.forward,
            lens: camera.projection,
            given: Some(*camera),
        }
    }

    /// All of the scene from the south and above.
    pub fn overview(bounds: Bounds) -> Viewpoint {
        let tan = libm::tan(OWN_HALF_FOV_DEG.to_radians());
        let (right, up, forward) = crate::plan::view::frame(55.0, 180.0, 0.0);
        let lens = Projection::Perspective { tan_x: tan, tan_y: tan };
        Viewpoint { target: DVec3::ZERO, distance: 1.0, right, up, forward, lens, given: None }.framing(bounds)
    }

    /// Whether it is a recipe's camera to the bit.
    pub fn given(&self) -> Option<&Camera> {
        self.given.as_ref()
    }

    /// The same direction, at such a distance that every corner of the scene's box is seen, with a little room.
    pub fn framing(&self, (low, high): Bounds) -> Viewpoint {
        let middle = (low + high) / 2.0;
        let corner = |bits: u8| {
            let pick = |bit: u8, low: f64, high: f64| if bits & bit == 0 { low } else { high };
            DVec3::new(pick(1, low.x, high.x), pick(2, low.y, high.y), pick(4, low.z, high.z)) - middle
        };
        let offsets =
            (0..8).map(corner).map(|at| (at.dot(self.right).abs(), at.dot(self.up).abs(), at.dot(self.forward)));
        let (lens, distance) = match self.lens {
            Projection::Perspective { tan_x, tan_y } => {
                let needed = |(x, y, ahead): (f64, f64, f64)| (ROOM * x / tan_x).max(ROOM * y / tan_y) - ahead;
                (self.lens, offsets.map(needed).fold(1.0, f64::max))
            }
            Projection::Orthographic { half_x, half_y } => {
                let needed = |(x, y, _): (f64, f64, f64)| ROOM * (x / half_x).max(y / half_y);
                let factor = offsets.map(needed).fold(1.0 / half_x.max(half_y), f64::max);
                let lens = Projection::Orthographic { half_x: half_x * factor, half_y: half_y * factor };
                (lens, (high - low).length().max(1.0))
            }
        };
        Viewpoint { target: middle, distance, lens, given: None, ..*self }
    }

    /// Where the camera is.
    pub fn position(&self) -> DVec3 {
        self.target - self.forward * self.distance
    }

    /// A camera for a picture of at most this size. A recipe's camera keeps the shape of its image and fits into it; any
    /// other fills it.
    pub fn camera(&self, (width, height): (u32, u32), bounds: Bounds) -> Camera {
        if let Some(given) = &self.given {
            let (width, height) = fitted((given.width, given.height), (width, height));
            return Camera { width, height, ..*given };
        }
        let aspect = f64::from(width) / f64::from(height);
        let (position, projection) = match self.lens {
            Projection::Perspective { tan_x, tan_y } => {
                let (tan_x, tan_y) = widened(tan_x, tan_y, aspect);
                (self.position(), Projection::Perspective { tan_x, tan_y })
            }
            Projection::Orthographic { half_x, half_y } => {
                let (half_x, half_y) = widened(half_x, half_y, aspect);
                // Parallel rays: the camera stands outside the scene, wherever the target is.
                let reach = (bounds.1 - self.target).abs().max((bounds.0 - self.target).abs()).length();
                (self.target - self.forward * (reach + 1.0), Projection::Orthographic { half_x, half_y })
            }
        };
        let near = near(position, self.forward, bounds);
        Camera { position, right: self.right, up: self.up, forward: self.forward, projection, width, height, near }
    }

    /// Turns about the target: `across` and `down` are degrees of a drag to the right and downwards, `pixels` how long it
    /// was. A tilted horizon is levelled on the way; up never becomes down.
    pub fn orbit(&mut self, across: f64, down: f64, pixels: f64) {
        self.turn(across, down, MOST_ORBIT_DEG);
        self.level(pixels / LEVEL_PX);
        self.given = None;
    }

    /// Turns about the camera.
    pub fn look(&mut self, across: f64, down: f64, pixels: f64) {
        let position = self.position();
        self.turn(across, down, MOST_LOOK_DEG);
        self.level(pixels / LEVEL_PX);
        self.target = position + self.forward * self.distance;
        self.given = None;
    }

    fn turn(&mut self, across: f64, down: f64, most: f64) {
        self.rotate(DQuat::from_axis_angle(DVec3::Y, -across.to_radians()));
        // The angle between nadir and the line of sight in the upright plane of the image.
        let pitch = libm::atan2(self.up.y, -self.forward.y).to_degrees();
        let wanted = (pitch - down).clamp(pitch.min(0.0), pitch.max(most));
        self.rotate(DQuat::from_axis_angle(self.right, (wanted - pitch).to_radians()));
    }

    fn level(&mut self, share: f64) {
        // Looking down there is no horizon.
        if self.up.y <= 0.2 {
            return;
        }
        let roll = libm::atan2(self.right.y, self.up.y);
        self.rotate(DQuat::from_axis_angle(self.forward, roll * share.clamp(0.0, 1.0)));
    }

    fn rotate(&mut self, turn: DQuat) {
        self.forward = (turn * self.forward).normalize();
        let up = turn * self.up;
        self.up = (up - self.forward * up.dot(self.forward)).normalize();
        self.right = self.forward.cross(self.up);
    }

    /// Moves everything by `factor` nearer to `anchor` (or away, above 1): the anchor keeps its place in the picture.
    pub fn zoom(&mut self, factor: f64, anchor: DVec3) {
        match &mut self.lens {
            Projection::Perspective { .. } => {
                let factor = factor.max(LEAST_DISTANCE_M / self.distance);
                self.target = anchor + (self.target - anchor) * factor;
                self.distance *= factor;
            }
            Projection::Orthographic { half_x, half_y } => {
                self.target = anchor + (self.target - anchor) * factor;
                (*half_x, *half_y) = (*half_x * factor, *half_y * factor);
            }
        }
        self.given = None;
    }

    /// Moves so that `anchor` comes under `cursor` of a picture that `camera` (of this viewpoint) takes.
    pub fn pan(&mut self, anchor: DVec3, cursor: Pixel, camera: &Camera) {
        let (origin, direction) = ray(camera, cursor);
        let normal = if self.forward.y < -GRAZING { DVec3::Y } else { self.forward };
        let hit = meet(origin, direction, anchor, normal).or_else(|| meet(origin, direction, anchor, self.forward));
        if let Some(hit) = hit {
            self.target += anchor - hit;
            self.given = None;
        }
    }

    /// Flies: metres to the right, up (of the world) and ahead.
    pub fn fly(&mut self, right: f64, up: f64, ahead: f64) {
        self.target += self.right * right + DVec3::Y * up + self.forward * ahead;
        self.given = None;
    }

    /// Metres that a second of flying covers: more from farther away.
    pub fn speed(&self) -> f64 {
        (0.6 * self.distance).clamp(5.0, 2000.0)
    }
}

/// The greatest size of the shape `of` within `within`.
fn fitted(of: (u32, u32), within: (u32, u32)) -> (u32, u32) {
    let scale = (f64::from(within.0) / f64::from(of.0)).min(f64::from(within.1) / f64::from(of.1));
    let side = |pixels: u32| ((f64::from(pixels) * scale).round() as u32).max(1);
    (side(of.0).min(within.0.max(1)), side(of.1).min(within.1.max(1)))
}

/// Half extents of shape `aspect` that hold these.
fn widened(x: f64, y: f64, aspect: f64) -> (f64, f64) {
    if aspect > x / y { (y * aspect, y) } else { (x, x / aspect) }
}

/// A little nearer than the nearest corner of what there is to see, as planned cameras have it.
fn near(position: DVec3, forward: DVec3, (low, high): Bounds) -> f64 {
    let corner = DVec3::select(forward.cmpge(DVec3::ZERO), low, high);
    (0.99 * (corner - position).dot(forward)).max(LEAST_NEAR_M)
}

/// Where a ray meets the plane through `point`, if before it.
fn meet(origin: DVec3, direction: DVec3, point: DVec3, normal: DVec3) -> Option<DVec3> {
    let along = (point - origin).dot(normal) / direction.dot(normal);
    (along.is_finite() && along > 0.0).then(|| origin + direction * along)
}

/// The ray through a point of the picture; the direction's length along the camera's axis is 1.
pub fn ray(camera: &Camera, at: Pixel) -> (DVec3, DVec3) {
    let x = 2.0 * at.x / f64::from(camera.width) - 1.0;
    let y = 1.0 - 2.0 * at.y / f64::from(camera.height);
    match camera.projection {
        Projection::Perspective { tan_x, tan_y } => {
            (camera.position, camera.forward + camera.right * (x * tan_x) + camera.up * (y * tan_y))
        }
        Projection::Orthographic { half_x, half_y } => {
            (camera.position + camera.right * (x * half_x) + camera.up * (y * half_y), camera.forward)
        }
    }
}

/// The point under `at` that is this far along the camera's axis.
pub fn point_at(camera: &Camera, at: Pixel, depth: f64) -> DVec3 {
    let (origin, direction) = ray(camera, at);
    origin + direction * depth
}

#[cfg(test)]
mod tests;
