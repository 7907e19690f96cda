//! In: where the recipe puts the sun and the seed of a view. Out: the sun as the renderer needs it, and the light of its
//! sky.

use glam::DVec3;

use super::clear_sky::Daylight;
use super::demand::Sun;
use super::effects::with_red_as_infrared;
use super::view::Drawer;
use crate::spec::effects::{DEFAULT_INTENSITY, SunColour};
use crate::spec::render_spec::{SunPosition, SunSpec};

/// Linear RGB irradiance of a clear sky on a surface that faces up, where the sun's colour is given.
const SKY_ZENITH: [f64; 3] = [0.24, 0.3, 0.38];
/// Linear RGB irradiance of sunlit ground on a surface that faces down, where the sun's colour is given.
const SKY_GROUND: [f64; 3] = [0.12, 0.11, 0.1];

/// The light of one acquisition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    pub sun: Sun,
    /// Irradiance of a surface that faces the sun, red, green, blue, near infrared.
    pub beam: [f64; 4],
    /// Radiance of the sky, as the irradiance that it gives.
    pub sky: [f64; 4],
    /// The same of the ground.
    pub ground: [f64; 4],
}

/// Makes the draws `sun.…` of a view and records them with the elevation and azimuth that follow.
pub(super) fn light(spec: &SunSpec, drawer: &mut Drawer) -> Light {
    let direction = match &spec.position {
        SunPosition::Angles { elevation, azimuth } => {
            from_angles(drawer.draw("sun.elevation", elevation), drawer.draw("sun.azimuth", azimuth))
        }
        SunPosition::Arc { declination, tilt, turn } => {
            let declination = drawer.draw("sun.declination", declination);
            let (tilt, turn) = (drawer.draw("sun.tilt", tilt), drawer.draw("sun.turn", turn));
            let direction = from_arc(declination, tilt, turn);
            let (elevation, azimuth) = to_angles(direction);
            drawer.record("sun.elevation", elevation);
            drawer.record("sun.azimuth", azimuth);
            direction
        }
    };
    let disc_deg = drawer.draw("sun.disc", &spec.disc);
    let intensity = drawer.draw("sun.intensity", &spec.intensity);
    let (beam, sky, ground) = match &spec.colour {
        SunColour::Fixed(colour) => (
            with_red_as_infrared(colour.map(|channel| channel * intensity)),
            with_red_as_infrared(SKY_ZENITH),
            with_red_as_infrared(SKY_GROUND),
        ),
        SunColour::ClearSky { turbidity } => {
            let (elevation, _) = to_angles(direction);
            let day = Daylight::clear_sky(elevation, drawer.draw("sun.turbidity", turbidity));
            let scaled = |light: [f64; 4]| light.map(|band| band * intensity / DEFAULT_INTENSITY);
            (scaled(day.sun), scaled(day.sky), scaled(day.ground(elevation)))
        }
    };
    let [r, g, b, _] = beam;
    Light { sun: Sun { direction, disc_deg, irradiance: [r, g, b] }, beam, sky, ground }
}

/// Unit vector in world axes from degrees above the horizon and degrees clockwise from north.
pub fn from_angles(elevation: f64, azimuth: f64) -> DVec3 {
    let (up, flat) = libm::sincos(elevation.to_radians());
    let (east, north) = libm::sincos(azimuth.to_radians());
    DVec3::new(flat * east, up, -flat * north).normalize()
}

/// Unit vector on the seed paper's arc (Kolos et al. 2019): the half circle from the eastern horizon (0°) over the
/// zenith (90°) to the western one (180°), tilted to the south by `tilt`, then turned clockwise by `turn`; degrees.
pub fn from_arc(declination: f64, tilt: f64, turn: f64) -> DVec3 {
    let (high, east) = libm::sincos(declination.to_radians());
    let (south, up) = libm::sincos(tilt.to_radians());
    let (south, up) = (high * south, high * up);
    let (sin, cos) = libm::sincos(turn.to_radians());
    DVec3::new(east * cos - south * sin, up, east * sin + south * cos).normalize()
}

/// Degrees above the horizon and clockwise from north, 0..360, of a unit vector.
pub fn to_angles(direction: DVec3) -> (f64, f64) {
    let azimuth = libm::atan2(direction.x, -direction.z).to_degrees();
    let azimuth = if azimuth < 0.0 { azimuth + 360.0 } else { azimuth };
    (libm::asin(direction.y.clamp(-1.0, 1.0)).to_degrees(), azimuth)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: DVec3, b: DVec3) {
        assert!((a - b).length() < 1e-12, "{a} {b}");
    }

    #[test]
    fn angles_are_clockwise_from_north() {
        near(from_angles(0.0, 90.0), DVec3::X);
        near(from_angles(0.0, 0.0), -DVec3::Z);
        near(from_angles(90.0, 123.0), DVec3::Y);
        for (elevation, azimuth) in [(30.0, 10.0), (60.0, 200.0), (5.0, 359.0)] {
            let (e, a) = to_angles(from_angles(elevation, azimuth));
            assert!((e - elevation).abs() < 1e-9 && (a - azimuth).abs() < 1e-9, "{e} {a}");
        }
    }

    #[test]
    fn the_arc_goes_from_east_over_the_top_to_west_and_tilts_to_the_south() {
        near(from_arc(0.0, 20.0, 0.0), DVec3::X);
        near(from_arc(90.0, 0.0, 0.0), DVec3::Y);
        near(from_arc(180.0, 20.0, 0.0), -DVec3::X);
        near(from_arc(90.0, 30.0, 0.0), from_angles(60.0, 180.0));
        // The eastern end of an arc turned by 90° lies in the south.
        near(from_arc(0.0, 0.0, 90.0), DVec3::Z);
        near(from_arc(30.0, 0.0, 0.0), from_angles(30.0, 90.0));
        near(from_arc(140.0, 0.0, 0.0), from_angles(40.0, 270.0));
    }
}
