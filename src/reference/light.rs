//! Light: a point that a ray found, sun and sky → the linear radiance that reaches the camera.
//!
//! Surfaces are diffuse and light bounces once. Visibility is exact: a ray per look at the sun or the sky.

use glam::DVec3;

use super::color::Rgb;
use super::sampling::{self, Dimension, Strata};
use super::surface::Point;
use super::tracer::Tracer;
use crate::plan::demand::{Ambient, Shadows, Sun};

/// What lights one image.
#[derive(Clone, Copy, Debug)]
pub struct Lighting<'a> {
    /// `None` where no sun is above the horizon.
    pub sun: Option<Sun>,
    pub shadows: Shadows,
    pub ambient: Ambient,
    /// Objects that are there, for what they show and for what they hide.
    pub shown: &'a [bool],
}

impl Lighting<'_> {
    /// Radiance of a point for one sample: its expectation is the integral over the sun's disc and the sky.
    pub fn radiance(&self, tracer: &Tracer, point: &Point, strata: &Strata, sample: u32) -> Rgb {
        let sky = self.sky(tracer, point, strata, sample);
        let sun = self.sun.map_or([0.0; 3], |sun| {
            let share = self.sunlight(tracer, &sun, point, strata, sample);
            sun.irradiance.map(|irradiance| irradiance * share)
        });
        std::array::from_fn(|k| point.albedo[k] * (sky[k] + sun[k]))
    }

    /// Cosine of the sun's light, 0 in shadow.
    fn sunlight(&self, tracer: &Tracer, sun: &Sun, point: &Point, strata: &Strata, sample: u32) -> f64 {
        let towards = match self.shadows {
            Shadows::Soft if sun.disc_deg > 0.0 => {
                sampling::in_cone(sun.direction, sun.disc_deg, strata.point(sample, Dimension::Sun))
            }
            _ => sun.direction,
        };
        let cosine = point.normal.dot(towards).max(0.0);
        if cosine == 0.0 || self.shadows == Shadows::Off || tracer.sees(point, towards, self.shown) {
            cosine
        } else {
            0.0
        }
    }

    /// Irradiance over π from the sky and the ground. A sky of radiance `zenith` over a ground of radiance `ground`
    /// gives the weighted mean that goes with the normal's height, exactly; what hides a part of the sky is black.
    fn sky(&self, tracer: &Tracer, point: &Point, strata: &Strata, sample: u32) -> Rgb {
        let (zenith, ground, occluded) = match self.ambient {
            Ambient::Off => return [0.0; 3],
            Ambient::Constant(radiance) => (radiance, radiance, false),
            Ambient::Sky { zenith, ground, occluded } => (zenith, ground, occluded),
        };
        if !occluded {
            let up = 0.5 + 0.5 * point.normal.dot(DVec3::Y);
            return std::array::from_fn(|k| zenith[k] * up + ground[k] * (1.0 - up));
        }
        let towards = sampling::in_hemisphere(point.normal, strata.point(sample, Dimension::Sky));
        if towards.y <= 0.0 {
            ground
        } else if tracer.sees(point, towards, self.shown) {
            zenith
        } else {
            [0.0; 3]
        }
    }
}
