//! Mansard's `roofShape`: the roofs of OpenStreetMap by name. In: a name, a slope, which way it looks. Out: the roof
//! over every face.

use glam::{DVec2, DVec3};

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::args::Args;
use super::auto_tags::Sides;
use super::roof::{Wanted, build};
use crate::cga::builtins::Word;
use crate::diagnostics::suggest;
use crate::geometry::PlaneFrame;
use crate::geometry::roof::{Facing, RoofShape, Slope};

/// `(name, byAngle | byHeight, value [, direction | along | across])`.
pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let kind = shape_named(run, args);
    let value = args.float_or(run, 2, 0.0);
    let slope = if args.word(1) == Some(Word::ByHeight) { Slope::Height(value) } else { Slope::Angle(value) };
    let direction = args.float(run, 3);
    let facing = |frame: &PlaneFrame| match (args.word(3), direction) {
        (Some(Word::Along), _) => Facing::Along,
        (Some(_), _) => Facing::Across,
        (None, Some(degrees)) => Facing::Downhill(in_plan(frame, degrees)),
        (None, None) => Facing::Natural,
    };
    let wanted = Wanted { name: title(kind), slope, by_design: &[], sides: Sides::OuterAndInner };
    let bands = run.limits.curve_bands;
    build(run, args, shape, wanted, |polygon, frame| kind.banded(polygon, slope, facing(frame), bands));
}

/// The shape of this name; a flat one, with a warning, for a name that is not known.
fn shape_named(run: &mut Derivation, args: &Args) -> RoofShape {
    let name = args.value(0).map(|v| v.to_text()).unwrap_or_default();
    RoofShape::from_name(&name).unwrap_or_else(|| {
        run.warn("cga::roof-shape", args.span, || {
            let meant = suggest(&name, RoofShape::names()).map(|m| format!(", did you mean \"{m}\"?"));
            format!("no roof shape has the name \"{name}\"{}; the roof is flat", meant.unwrap_or_default())
        });
        RoofShape::Flat
    })
}

/// Degrees clockwise from north (world -z) as a direction in the plane of a face.
fn in_plan(frame: &PlaneFrame, degrees: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(degrees.rem_euclid(360.0).to_radians());
    let world = DVec3::new(sin, 0.0, -cos);
    DVec2::new(world.dot(frame.u), world.dot(frame.v))
}

/// How messages call it.
fn title(kind: RoofShape) -> &'static str {
    match kind {
        RoofShape::Flat => "the flat roof",
        RoofShape::Gabled => "the gabled roof",
        RoofShape::Hipped => "the hipped roof",
        RoofShape::HalfHipped => "the half-hipped roof",
        RoofShape::Pyramidal => "the pyramidal roof",
        RoofShape::Skillion => "the skillion roof",
        RoofShape::Gambrel => "the gambrel roof",
        RoofShape::Mansard => "the mansard roof",
        RoofShape::Dome => "the dome",
        RoofShape::Onion => "the onion",
        RoofShape::Round => "the round roof",
        RoofShape::Saltbox => "the saltbox roof",
    }
}
