//! Where a scope or pivot stands. In: points, axes and Euler angles in degrees. Out: [`Frame`]s and their conversions.
//!
//! Euler convention of CGA: angles about x, y, z give `R = Rz · Ry · Rx` for column vectors (rotate about the fixed
//! x axis first).

use glam::{DMat3, DVec3};

/// A right-handed orthonormal frame; the columns of `axes` are its x, y and z directions in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    pub origin: DVec3,
    pub axes: DMat3,
}

impl Frame {
    /// The host's scene: x east, y up, z south.
    pub const WORLD: Frame = Frame { origin: DVec3::ZERO, axes: DMat3::IDENTITY };

    pub fn new(origin: DVec3, x: DVec3, y: DVec3, z: DVec3) -> Self {
        Frame { origin, axes: DMat3::from_cols(x, y, z) }
    }

    pub fn world_from_local(&self, p: DVec3) -> DVec3 {
        self.origin + self.axes * p
    }

    pub fn local_from_world(&self, p: DVec3) -> DVec3 {
        self.axes.transpose() * (p - self.origin)
    }

    pub fn local_direction(&self, d: DVec3) -> DVec3 {
        self.axes.transpose() * d
    }

    /// This frame as `parent` sees it: translation and rotation in the parent's axes.
    pub fn relative_to(&self, parent: &Frame) -> Frame {
        Frame { origin: parent.local_from_world(self.origin), axes: parent.axes.transpose() * self.axes }
    }

    /// The world frame of `self`, given in the axes of `parent`.
    pub fn placed_in(&self, parent: &Frame) -> Frame {
        Frame { origin: parent.world_from_local(self.origin), axes: parent.axes * self.axes }
    }
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
pub fn sin_cos_degrees(angle: f64) -> (f64, f64) {
    let turn = angle.rem_euclid(360.0);
    match turn {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => libm::sincos(turn.to_radians()),
    }
}

/// The rotation of Euler angles in degrees.
pub fn rotation(angles: DVec3) -> DMat3 {
    let ((sa, ca), (sb, cb), (sg, cg)) =
        (sin_cos_degrees(angles.x), sin_cos_degrees(angles.y), sin_cos_degrees(angles.z));
    DMat3::from_cols(
        DVec3::new(cb * cg, cb * sg, -sb),
        DVec3::new(sa * sb * cg - ca * sg, ca * cg + sa * sb * sg, sa * cb),
        DVec3::new(sa * sg + ca * sb * cg, ca * sb * sg - sa * cg, ca * cb),
    )
}

/// Euler angles in degrees of a rotation; at gimbal lock everything goes into the angle about x.
pub fn euler(m: &DMat3) -> DVec3 {
    let sb = (-m.x_axis.z).clamp(-1.0, 1.0);
    let angles = if sb.abs() > 1.0 - 1e-12 {
        // cos b = 0: only a - g (or a + g) is determined; g = 0.
        let a = libm::atan2(m.y_axis.x * sb.signum(), m.y_axis.y);
        DVec3::new(a, sb.signum() * std::f64::consts::FRAC_PI_2, 0.0)
    } else {
        DVec3::new(libm::atan2(m.y_axis.z, m.z_axis.z), libm::asin(sb), libm::atan2(m.x_axis.y, m.x_axis.x))
    };
    DVec3::new(angles.x.to_degrees(), angles.y.to_degrees(), angles.z.to_degrees())
}

/// A unit vector across `y`, as near to `wish` as can be; falls back to `second`, then to any.
pub fn perpendicular(y: DVec3, wish: DVec3, second: DVec3) -> DVec3 {
    for candidate in [wish, second, DVec3::X, DVec3::Z] {
        let across = candidate - y * candidate.dot(y);
        if across.length_squared() > 1e-12 {
            return across.normalize();
        }
    }
    DVec3::X
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quarter_turns_are_exact_and_follow_the_reference() {
        let r = rotation(DVec3::new(0.0, 90.0, 0.0));
        assert_eq!(r * DVec3::X, DVec3::NEG_Z);
        assert_eq!(rotation(DVec3::new(-90.0, 0.0, 0.0)) * DVec3::Y, DVec3::NEG_Z);
        assert_eq!(euler(&r), DVec3::new(0.0, 90.0, 0.0));
    }

    proptest! {
        #[test]
        fn euler_angles_give_their_rotation_back(a in -180.0..180.0f64, b in -90.0..90.0f64, g in -180.0..180.0f64) {
            let r = rotation(DVec3::new(a, b, g));
            let again = rotation(euler(&r));
            for i in 0..3 {
                prop_assert!((r.col(i) - again.col(i)).length() < 1e-7, "{r} {again}");
            }
        }
    }
}
