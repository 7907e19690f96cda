//! The roof operations (reference 4.9; compatibility notes, "Roofs"). In: slope and overhangs. Out: a closed roof over
//! every face, built perpendicular to it, in an upright scope.

use glam::{DVec2, DVec3};

use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::shape::Shape;
use super::args::Args;
use super::auto_tags::{self, Sides};
use super::extrude::replace_upright;
use crate::cga::builtins::Word;
use crate::geometry::roof::{self, Roof, RoofError, RoofWarning, Slope};
use crate::geometry::{Mesh, PlaneFrame, Polygon};

/// `(angle, ...)`, `(byAngle | byHeight, value, ...)`: the slope and the position of the next argument.
fn slope(run: &mut Derivation, args: &Args) -> (Slope, usize) {
    match args.word(0) {
        Some(Word::ByHeight) => (Slope::Height(args.float_or(run, 1, 0.0)), 2),
        Some(_) => (Slope::Angle(args.float_or(run, 1, 0.0)), 2),
        None => (Slope::Angle(args.float_or(run, 0, 0.0)), 1),
    }
}

pub fn hip(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (slope, next) = slope(run, args);
    let overhang = args.float_or(run, next, 0.0);
    let even = args.bool(next + 1);
    build(run, args, shape, Sides::Plain, |polygon, _| roof::hip(polygon, slope, overhang, even));
}

pub fn gable(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (slope, next) = slope(run, args);
    let overhang_x = args.float_or(run, next, 0.0);
    let overhang_y = args.float_or(run, next + 1, 0.0);
    let even = args.bool(next + 2);
    let index = args.float(run, next + 3).map(|x| x as i64);
    build(run, args, shape, Sides::Plain, |polygon, _| {
        roof::gable(polygon, slope, overhang_x, overhang_y, even, index)
    });
}

pub fn pyramid(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (slope, _) = slope(run, args);
    build(run, args, shape, Sides::Plain, |polygon, _| roof::pyramid(polygon, slope));
}

pub fn shed(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (slope, next) = slope(run, args);
    let index = args.float_or(run, next, 0.0) as i64;
    build(run, args, shape, Sides::OuterAndInner, |polygon, _| roof::shed(polygon, slope, index));
}

pub fn ridge(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (slope, _) = slope(run, args);
    let along = shape.scope.frame.axes.x_axis;
    build(run, args, shape, Sides::OuterAndInner, |polygon, frame| {
        let plan = DVec2::new(along.dot(frame.u), along.dot(frame.v));
        roof::ridge(polygon, slope, plan.try_normalize().unwrap_or(DVec2::X))
    });
}

/// Roofs every face; a face that cannot be roofed keeps its shape with a warning.
fn build(
    run: &mut Derivation,
    args: &Args,
    shape: &mut Shape,
    sides: Sides,
    roofed: impl Fn(&Polygon, &PlaneFrame) -> Result<Roof, RoofError>,
) {
    shape.bake();
    let source = &shape.form.mesh;
    let Some(up) = source.faces.first().map(|face| source.normal(face)).filter(|n| *n != DVec3::ZERO) else { return };
    let mut mesh = Mesh::default();
    let (mut sources, mut parts) = (Vec::new(), Vec::new());
    for (number, face) in source.faces.iter().enumerate() {
        let Some(frame) = PlaneFrame::of_face(source, face) else { continue };
        match roofed(&frame.face_to_plan(source, face), &frame) {
            Ok(roof) => {
                warn(run, args, &roof.warnings);
                append(&mut mesh, roof.mesh, &frame);
                sources.resize(mesh.faces.len(), Some(number as u32));
                parts.extend(roof.parts.iter().map(|part| (number, *part)));
            }
            Err(error) => {
                run.warn("cga::roof", args.span, || format!("no roof here: {error}"));
                return;
            }
        }
    }
    let mut form: Form = shape.form.derived(mesh, sources.into_iter());
    auto_tags::roof(run.program, &shape.form, &mut form, sides, &parts);
    replace_upright(shape, form, up, false);
}

/// Adds a roof given over its polygon: plan (x, y) at height h is local (x, h, -y).
fn append(mesh: &mut Mesh, roof: Mesh, frame: &PlaneFrame) {
    let start = mesh.positions.len() as u32;
    mesh.positions.extend(roof.positions.iter().map(|p| frame.to_space(DVec2::new(p.x, -p.z), p.y)));
    mesh.faces.reserve(roof.faces.len());
    for mut face in roof.faces {
        face.outer.iter_mut().chain(face.holes.iter_mut().flatten()).for_each(|v| *v += start);
        mesh.faces.push(face);
    }
}

fn warn(run: &mut Derivation, args: &Args, warnings: &[RoofWarning]) {
    for warning in warnings {
        let (code, text) = match warning {
            RoofWarning::IndexIgnored => {
                ("cga::roof-index", "the ridge direction can be chosen on convex faces without holes only")
            }
            RoofWarning::Overlapping => ("cga::roof-overlap", "the faces of this pyramid overlap"),
            RoofWarning::HolesDropped => ("cga::roof-holes", "a pyramid covers the holes"),
        };
        run.warn(code, args.span, || text.into());
    }
}
