//! In: the properties of a camera. Out: a [`CameraSpec`] whose lens is determined, neither more nor less.
//!
//! One equation ties a perspective camera, at the target and across the line of sight:
//! `width · gsd = 2 · altitude · tan(fov / 2)`. Two of gsd, fov and altitude with the size give the third; all three
//! give the size; all four must agree. What is missing has a default.

use super::{Checker, get};
use crate::source::Span;
use crate::spec::ast::{Expr, ExprKind, Property};
use crate::spec::draw::Distribution;
use crate::spec::render_spec::{CameraSpec, Lens};
use crate::spec::units::Dimension;

/// Pixels; used where no size is given and none follows.
const DEFAULT_SIZE: (u32, u32) = (1024, 1024);
/// Metres.
const DEFAULT_GSD: f64 = 0.6;
/// Degrees.
const DEFAULT_FOV: f64 = 30.0;
/// Pixels per side.
const GREATEST_SIZE: u64 = 32_768;
/// Degrees; farther from the vertical the horizon comes into the image.
const GREATEST_OFF_NADIR: f64 = 80.0;
/// Relative difference up to which size, gsd, fov and altitude agree: room for values written with three digits.
const AGREEMENT: f64 = 0.005;

const ANY_ANGLE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

impl Checker<'_> {
    pub fn camera(&mut self, properties: &[Property], name: &str, span: Span) -> Option<CameraSpec> {
        let orthographic = match get(properties, "projection") {
            Some(property) => self.one(property).and_then(|value| {
                let word = self.word(value, &["perspective", "orthographic"], &["true_ortho"])?;
                Some(word == "orthographic")
            }),
            None => Some(false),
        };
        let size = match get(properties, "size") {
            Some(property) => self.one(property).and_then(|value| self.image_size(value)).map(Some),
            None => Some(None),
        };
        let gsd = self.length_above_zero(properties, "gsd");
        let altitude = self.length_above_zero(properties, "altitude");
        let fov = self.bounded(properties, "fov", Dimension::Angle, (0.001, 170.0));
        let tilt = self.bounded(properties, "off_nadir", Dimension::Angle, (0.0, GREATEST_OFF_NADIR));
        let azimuth = self.bounded(properties, "azimuth", Dimension::Angle, ANY_ANGLE);
        let heading = self.bounded(properties, "heading", Dimension::Angle, ANY_ANGLE);
        let (gsd, fov, altitude) = (gsd.ok()?, fov.ok()?, altitude.ok()?);
        let (lens, (width, height)) = match orthographic? {
            true => self.orthographic(properties, gsd, size?)?,
            false => self.perspective(properties, Given { gsd, fov, altitude }, size?, span)?,
        };
        let or_zero = |angle: Option<Distribution>| angle.unwrap_or(Distribution::Fixed(0.0));
        Some(CameraSpec {
            name: name.to_owned(),
            span,
            width,
            height,
            lens,
            off_nadir: or_zero(tilt.ok()?),
            azimuth: or_zero(azimuth.ok()?),
            heading: or_zero(heading.ok()?),
        })
    }

    fn length_above_zero(&mut self, properties: &[Property], key: &str) -> Result<Option<Distribution>, ()> {
        let Some(property) = get(properties, key) else { return Ok(None) };
        let value = self.one(property).ok_or(())?;
        let distribution = self.distribution(value, Dimension::Length).ok_or(())?;
        if distribution.bounds().0 <= 0.0 {
            self.error("spec::out-of-range", value.span, format!("`{key}` is more than 0m, `{value}` can be less"));
            return Err(());
        }
        Ok(Some(distribution))
    }

    fn image_size(&mut self, value: &Expr) -> Option<(u32, u32)> {
        let ExprKind::By(width, height) = &value.kind else {
            self.wrong(value, "an image size such as `1024 x 1024`");
            return None;
        };
        let width = self.whole(width, Dimension::Pixels, 1, GREATEST_SIZE);
        let height = self.whole(height, Dimension::Pixels, 1, GREATEST_SIZE);
        width.zip(height).map(|(width, height)| (width as u32, height as u32))
    }

    fn orthographic(
        &mut self,
        properties: &[Property],
        gsd: Option<Distribution>,
        size: Option<(u32, u32)>,
    ) -> Option<(Lens, (u32, u32))> {
        for key in ["fov", "altitude"] {
            if let Some(property) = get(properties, key) {
                let message = format!("an orthographic camera has no `{key}`: its rays are parallel");
                self.error("spec::over-determined", property.span, message);
                return None;
            }
        }
        let gsd = gsd.unwrap_or(Distribution::Fixed(DEFAULT_GSD));
        Some((Lens::Orthographic { gsd }, size.unwrap_or(DEFAULT_SIZE)))
    }

    fn perspective(
        &mut self,
        properties: &[Property],
        given: Given,
        size: Option<(u32, u32)>,
        span: Span,
    ) -> Option<(Lens, (u32, u32))> {
        let usual = size.unwrap_or(DEFAULT_SIZE);
        let default_fov = Distribution::Fixed(DEFAULT_FOV);
        let lens = match (given.gsd, given.fov, given.altitude) {
            (Some(gsd), Some(fov), Some(altitude)) => {
                let at = get(properties, "altitude").map_or(span, |property| property.span);
                let numbers = gsd.fixed().zip(fov.fixed()).zip(altitude.fixed());
                let Some(((g, f), a)) = numbers else {
                    let message = "`gsd`, `fov` and `altitude` cannot all be given where one of them is drawn";
                    let help = "leave one out, it follows from the others; `altitude auto` drops an inherited one";
                    self.error_with_help("spec::over-determined", at, message, help);
                    return None;
                };
                let size = self.agreeing_size((g, f, a), size, at)?;
                return Some((Lens::GsdFov { gsd, fov }, size));
            }
            (Some(gsd), None, Some(altitude)) => Lens::GsdAltitude { gsd, altitude },
            (None, fov, Some(altitude)) => Lens::FovAltitude { fov: fov.unwrap_or(default_fov), altitude },
            (gsd, fov, None) => {
                Lens::GsdFov { gsd: gsd.unwrap_or(Distribution::Fixed(DEFAULT_GSD)), fov: fov.unwrap_or(default_fov) }
            }
        };
        Some((lens, usual))
    }

    /// The size that gsd, fov and altitude ask for, or the given one if it agrees.
    fn agreeing_size(
        &mut self,
        (gsd, fov, altitude): (f64, f64, f64),
        size: Option<(u32, u32)>,
        at: Span,
    ) -> Option<(u32, u32)> {
        let half_tangent = libm::tan(fov.to_radians() / 2.0);
        let wanted = 2.0 * altitude * half_tangent / gsd;
        match size {
            None if (1.0..=GREATEST_SIZE as f64).contains(&wanted.round()) => {
                let side = wanted.round() as u32;
                Some((side, side))
            }
            None => {
                let message = format!(
                    "gsd {gsd}m, fov {fov}deg and altitude {altitude}m make an image {} pixels wide; \
                     1 to {GREATEST_SIZE} are possible",
                    rounded(wanted)
                );
                self.error("spec::out-of-range", at, message);
                None
            }
            Some(size) => {
                let width = f64::from(size.0);
                if (wanted - width).abs() <= AGREEMENT * width {
                    return Some(size);
                }
                let message = format!(
                    "size, gsd, fov and altitude contradict each other: {} pixels of {gsd}m under {fov}deg need an \
                     altitude of {}m, but it is {altitude}m",
                    size.0,
                    rounded(width * gsd / (2.0 * half_tangent)),
                );
                let help = format!(
                    "leave one out, or take gsd {}m, or fov {}deg",
                    rounded(2.0 * altitude * half_tangent / width),
                    rounded(2.0 * libm::atan(width * gsd / (2.0 * altitude)).to_degrees()),
                );
                self.error_with_help("spec::camera-contradiction", at, message, help);
                None
            }
        }
    }
}

/// What the recipe says of a perspective lens.
struct Given {
    gsd: Option<Distribution>,
    fov: Option<Distribution>,
    altitude: Option<Distribution>,
}

/// Five significant digits are enough to correct a recipe by.
fn rounded(value: f64) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let scale = libm::pow(10.0, 4.0 - libm::floor(libm::log10(value.abs())));
    (value * scale).round() / scale
}
