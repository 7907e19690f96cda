//! Air: haze and clouds on straight paths. In: light that leaves one place. Out: light that arrives at another, by closed
//! forms of the definitions in [`crate::plan::effects`]. Places are in the world, metres.

use glam::{DVec2, DVec3};

use super::color::Light;
use crate::plan::effects::{Clouds, Haze, Look, with_red_as_infrared};

/// What lies between surfaces, camera and sun in one image.
pub struct Air<'a> {
    haze: Option<HazeOfBands>,
    clouds: Option<&'a Clouds>,
}

struct HazeOfBands {
    extinction: Light,
    airlight: Light,
    scale_height: f64,
    base: f64,
}

impl<'a> Air<'a> {
    pub fn new(look: &'a Look) -> Air<'a> {
        let infrared = look.sensor.and_then(|sensor| sensor.bands.near_infrared());
        let haze = look.haze.map(|Haze { extinction, scale_height, base, airlight }| {
            let [mut extinction, mut airlight] = [extinction, airlight].map(with_red_as_infrared);
            if let Some(light) = infrared {
                (extinction[3], airlight[3]) = (light.extinction, light.airlight);
            }
            HazeOfBands { extinction, airlight, scale_height, base }
        });
        Air { haze, clouds: look.clouds.as_ref() }
    }

    /// Radiance at the eye of a surface that sends `radiance` towards it: haze over the whole path, then clouds.
    pub fn arriving(&self, radiance: Light, from: DVec3, eye: DVec3) -> Light {
        let mut light = radiance;
        if let Some(haze) = &self.haze {
            let length = dense_length(from, eye, haze.base, haze.scale_height);
            for k in 0..4 {
                let kept = libm::exp(-haze.extinction[k] * length);
                light[k] = light[k] * kept + haze.airlight[k] * (1.0 - kept);
            }
        }
        if let Some(clouds) = self.clouds.filter(|clouds| eye.y > clouds.height) {
            let kept = through(clouds, from, (eye - from).normalize());
            let color = with_red_as_infrared(clouds.color);
            light = std::array::from_fn(|k| light[k] * kept + color[k] * (1.0 - kept));
        }
        light
    }

    /// Share of what comes from a direction of unit length that the clouds let through to a point.
    pub fn lets_through(&self, point: DVec3, towards: DVec3) -> f64 {
        self.clouds.map_or(1.0, |clouds| through(clouds, point, towards))
    }
}

/// Share that the layer leaves of the light between a point and what is far in a direction.
fn through(clouds: &Clouds, point: DVec3, towards: DVec3) -> f64 {
    if point.y >= clouds.height || towards.y <= 0.0 {
        return 1.0;
    }
    let at = point + towards * ((clouds.height - point.y) / towards.y);
    libm::exp(-clouds.optical_depth(DVec2::new(at.x, -at.z)) / towards.y)
}

/// Metres of air as dense as at the height `base` that weigh as much as the path: the integral of
/// `exp(-(y - base) / scale_height)` along it.
pub fn dense_length(from: DVec3, to: DVec3, base: f64, scale_height: f64) -> f64 {
    let rise = (to.y - from.y) / scale_height;
    // (1 - exp(-x)) / x, which is 1 at 0.
    let mean = if rise.abs() < 1e-9 { 1.0 - 0.5 * rise } else { -libm::expm1(-rise) / rise };
    libm::exp(-(from.y - base) / scale_height) * mean * (to - from).length()
}
