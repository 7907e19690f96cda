//! Light: what a ray found, sun, sky and air → the linear radiance that reaches the camera, in the image's channels.
//!
//! Surfaces are diffuse and light bounces once. Visibility is exact: a ray per look at the sun or the sky.

use glam::{DVec2, DVec3};

use super::air::Air;
use super::color::{Light, Rgb};
use super::sampling::{self, Dimension, Strata};
use super::surface::Point;
use super::tracer::Tracer;
use crate::plan::demand::{Ambient, BACKGROUND, OutputDemand, Shadows, Sun, ViewDemand};
use crate::plan::effects::{Bands, GroundState, with_red_as_infrared};

/// What lights one image.
pub struct Lighting<'a> {
    /// `None` where no sun is above the horizon.
    sun: Option<(Sun, Light)>,
    shadows: Shadows,
    sky: Sky,
    air: Air<'a>,
    ground: Option<&'a GroundState>,
    bands: Bands,
    /// Where nothing is met.
    background: Rgb,
    /// Objects that are there, for what they show and for what they hide.
    pub shown: &'a [bool],
}

/// The ambient light in all bands.
struct Sky {
    zenith: Light,
    ground: Light,
    occluded: bool,
}

impl<'a> Lighting<'a> {
    pub fn new(view: &ViewDemand, output: &'a OutputDemand) -> Lighting<'a> {
        let look = &output.look;
        let bands = look.sensor.map_or(Bands::Rgb, |sensor| sensor.bands);
        let infrared = bands.near_infrared();
        let sun = view.sun.filter(|sun| sun.direction.y > 0.0).map(|sun| {
            let [r, g, b] = sun.irradiance;
            (sun, [r, g, b, infrared.map_or(0.0, |light| light.sun)])
        });
        Lighting {
            sun,
            shadows: look.shadows,
            sky: sky(look.ambient, bands),
            air: Air::new(look),
            ground: look.ground.as_ref(),
            bands,
            background: bands.of(with_red_as_infrared(BACKGROUND)),
            shown: &output.selection.objects,
        }
    }

    /// Which random points its samples need.
    pub fn needs(&self) -> [bool; 2] {
        [self.sun.is_some() && self.shadows == Shadows::Soft, self.sky.occluded]
    }

    /// Channels of the image for one sample: a point that a ray from `eye` met, if any. The expectation is the integral
    /// over the sun's disc and the sky.
    pub fn seen(&self, tracer: &Tracer, eye: DVec3, point: Option<&Point>, strata: &Strata, sample: u32) -> Rgb {
        let Some(point) = point else { return self.background };
        let place = tracer.in_world(point.position);
        let sky = self.sky(tracer, point, strata, sample);
        let sun = self.sunlight(tracer, point, place, strata, sample);
        let covered = self.covered(point, place);
        let (albedo, mirrored) = covered.map_or((point.albedo, 0.0), |(ground, share)| {
            let albedo = point.albedo.map(|bare| bare + share * (ground.kind.albedo(bare) - bare));
            let cosine = point.normal.dot((eye - place).normalize()).abs();
            (albedo, share * ground.kind.mirrored(cosine))
        });
        let radiance = std::array::from_fn(|k| albedo[k] * (sky[k] + sun[k]) + mirrored * self.sky.zenith[k]);
        self.bands.of(self.air.arriving(radiance, place, eye))
    }

    /// What lies on the ground at a point, and the share that it covers.
    fn covered(&self, point: &Point, place: DVec3) -> Option<(&GroundState, f64)> {
        let ground = self.ground.filter(|_| point.normal.y > 0.5)?;
        Some((ground, ground.coverage(DVec2::new(place.x, -place.z))))
    }

    /// Irradiance from the sun over π, 0 in shadow.
    fn sunlight(&self, tracer: &Tracer, point: &Point, place: DVec3, strata: &Strata, sample: u32) -> Light {
        let Some((sun, irradiance)) = &self.sun else { return [0.0; 4] };
        let towards = match self.shadows {
            Shadows::Soft if sun.disc_deg > 0.0 => {
                sampling::in_cone(sun.direction, sun.disc_deg, strata.point(sample, Dimension::Sun))
            }
            _ => sun.direction,
        };
        let cosine = point.normal.dot(towards);
        if cosine <= 0.0 || self.shadows != Shadows::Off && !tracer.sees(point, towards, self.shown) {
            return [0.0; 4];
        }
        let share = cosine * self.air.lets_through(place, towards);
        irradiance.map(|irradiance| irradiance * share)
    }

    /// Irradiance over π from the sky and the ground. A sky of radiance `zenith` over a ground of radiance `ground`
    /// gives the weighted mean that goes with the normal's height, exactly; what hides a part of the sky is black.
    fn sky(&self, tracer: &Tracer, point: &Point, strata: &Strata, sample: u32) -> Light {
        let Sky { zenith, ground, occluded } = self.sky;
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
            [0.0; 4]
        }
    }
}

fn sky(ambient: Ambient, bands: Bands) -> Sky {
    let (zenith, ground, occluded) = match ambient {
        Ambient::Off => return Sky { zenith: [0.0; 4], ground: [0.0; 4], occluded: false },
        Ambient::Constant(radiance) => (radiance, radiance, false),
        Ambient::Sky { zenith, ground, occluded } => (zenith, ground, occluded),
    };
    let [mut zenith, mut ground] = [zenith, ground].map(with_red_as_infrared);
    if let Some(light) = bands.near_infrared() {
        (zenith[3], ground[3]) = (light.zenith, light.ground);
    }
    Sky { zenith, ground, occluded }
}
