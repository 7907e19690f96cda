//! Finite: which part of a view's demand has a number that is not finite. In: a demand. Out: its name, for an error.

use super::demand::{Camera, Projection, Sun, ViewDemand};
use super::effects::{Ambient, Bands, Clouds, GroundState, Haze, Look, Sensor};

/// The first part that no renderer can draw; `None` for sound demands.
pub fn not_finite(view: &ViewDemand) -> Option<&'static str> {
    if !camera(&view.camera) {
        return Some("the camera");
    }
    if !view.sun.as_ref().is_none_or(sun) {
        return Some("the sun");
    }
    view.outputs.iter().find_map(|output| look(&output.look))
}

fn all(numbers: &[f64]) -> bool {
    numbers.iter().all(|n| n.is_finite())
}

fn camera(camera: &Camera) -> bool {
    let (Projection::Perspective { tan_x: x, tan_y: y } | Projection::Orthographic { half_x: x, half_y: y }) =
        camera.projection;
    let axes = [camera.position, camera.right, camera.up, camera.forward];
    axes.iter().all(|axis| axis.is_finite()) && all(&[x, y, camera.near])
}

fn sun(sun: &Sun) -> bool {
    sun.direction.is_finite() && sun.disc_deg.is_finite() && all(&sun.irradiance)
}

fn look(look: &Look) -> Option<&'static str> {
    let ambient = match look.ambient {
        Ambient::Off => true,
        Ambient::Constant(radiance) => all(&radiance),
        Ambient::Sky { zenith, ground, .. } => all(&zenith) && all(&ground),
    };
    let haze = |h: &Haze| all(&h.extinction) && all(&h.airlight) && all(&[h.scale_height, h.base]);
    let clouds = |c: &Clouds| all(&[c.cover, c.height, c.size, c.depth]) && all(&c.color);
    let ground = |g: &GroundState| {
        all(&[g.strength, g.reach]) && g.around.iter().all(|(centre, radius)| centre.is_finite() && radius.is_finite())
    };
    let sensor = |s: &Sensor| {
        let light = match s.bands {
            Bands::Rgb => true,
            Bands::Nir(n) | Bands::Panchromatic(n) | Bands::FalseColor(n) => {
                all(&[n.sun, n.zenith, n.ground, n.extinction, n.airlight])
            }
        };
        light && all(&[s.psf, s.exposure, s.read_noise, s.full_well])
    };
    let parts = [
        ("the ambient light", ambient),
        ("the haze", look.haze.as_ref().is_none_or(haze)),
        ("the clouds", look.clouds.as_ref().is_none_or(clouds)),
        ("the state of the ground", look.ground.as_ref().is_none_or(ground)),
        ("the sensor", look.sensor.as_ref().is_none_or(sensor)),
    ];
    parts.iter().find(|(_, sound)| !sound).map(|(name, _)| *name)
}
