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
use crate::geometry::mesh_checks::Defect;
use crate::geometry::roof::{self, FellBack, Roof, RoofError, RoofWarning, Slope, SoundRoof};
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
    let wanted = Wanted { name: "the hip roof", slope, by_design: by_design(overhang, even), sides: Sides::Plain };
    build(run, args, shape, wanted, |polygon, _| roof::hip(polygon, slope, overhang, even).map(Some));
}

pub fn gable(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (slope, next) = slope(run, args);
    let overhang_x = args.float_or(run, next, 0.0);
    let overhang_y = args.float_or(run, next + 1, 0.0);
    let even = args.bool(next + 2);
    let index = args.float(run, next + 3).map(|x| x as i64);
    let by_design = by_design(overhang_x.max(overhang_y), even);
    let wanted = Wanted { name: "the gable roof", slope, by_design, sides: Sides::Plain };
    build(run, args, shape, wanted, |polygon, _| {
        roof::gable(polygon, slope, overhang_x, overhang_y, even, index).map(Some)
    });
}

pub fn pyramid(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (slope, _) = slope(run, args);
    // Over concave outlines its faces overlap, with a warning (compatibility notes).
    let wanted = Wanted { name: "the pyramid", slope, by_design: &[Defect::SelfIntersection], sides: Sides::Plain };
    build(run, args, shape, wanted, |polygon, _| roof::pyramid(polygon, slope).map(Some));
}

pub fn shed(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (slope, next) = slope(run, args);
    let index = args.float_or(run, next, 0.0) as i64;
    let wanted = Wanted { name: "the shed roof", slope, by_design: &[], sides: Sides::OuterAndInner };
    build(run, args, shape, wanted, |polygon, _| roof::shed(polygon, slope, index).map(Some));
}

pub fn ridge(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (slope, _) = slope(run, args);
    let along = shape.scope.frame.axes.x_axis;
    let wanted = Wanted { name: "the ridge roof", slope, by_design: &[], sides: Sides::OuterAndInner };
    build(run, args, shape, wanted, |polygon, frame| {
        let plan = DVec2::new(along.dot(frame.u), along.dot(frame.v));
        roof::ridge(polygon, slope, plan.try_normalize().unwrap_or(DVec2::X)).map(Some)
    });
}

/// Planes continue beyond the walls as sheets, so roofs with overhangs have open edges; levelled ridges bend planes.
fn by_design(overhang: f64, even: bool) -> &'static [Defect] {
    use Defect as D;
    match (overhang > 0.0, even) {
        (false, false) => &[],
        (false, true) => &[D::NonPlanarFace, D::SelfIntersection, D::DegenerateTriangle, D::VolumeAgainstAnalytic],
        (true, false) => &[D::OpenEdge, D::SelfIntersection, D::NegativeVolume],
        (true, true) => &[
            D::OpenEdge,
            D::SelfIntersection,
            D::NegativeVolume,
            D::NonPlanarFace,
            D::DegenerateTriangle,
            D::VolumeAgainstAnalytic,
        ],
    }
}

/// What is asked for, for checks and messages.
pub(super) struct Wanted {
    pub name: &'static str,
    pub slope: Slope,
    /// Defects that belong to the roof.
    pub by_design: &'static [Defect],
    pub sides: Sides,
}

/// Roofs every face. Where the roof has a defect a simpler one stands in, with a warning; `None` is a flat roof: the
/// face itself. If what is asked for cannot be, the shape stays, with a warning.
pub(super) fn build(
    run: &mut Derivation,
    args: &Args,
    shape: &mut Shape,
    wanted: Wanted,
    roofed: impl Fn(&Polygon, &PlaneFrame) -> Result<Option<Roof>, RoofError>,
) {
    shape.bake();
    let source = &shape.form.mesh;
    let Some(up) = source.faces.first().map(|face| source.normal(face)).filter(|n| *n != DVec3::ZERO) else { return };
    let mut mesh = Mesh::default();
    let (mut sources, mut parts) = (Vec::new(), Vec::new());
    for (number, face) in source.faces.iter().enumerate() {
        let Some(frame) = PlaneFrame::of_face(source, face) else { continue };
        let polygon = frame.face_to_plan(source, face);
        let first = (wanted.name, roofed(&polygon, &frame));
        match roof::sound(&polygon, wanted.slope, wanted.by_design, first) {
            Ok(SoundRoof { roof, steps }) => {
                fell_back(run, args, &steps);
                let roof = roof.unwrap_or_else(|| roof::flat(&polygon));
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
    auto_tags::roof(run.program, &shape.form, &mut form, wanted.sides, &parts);
    replace_upright(shape, form, up, false);
}

/// All steps in one message: `the onion has self-intersection (3), so a hip roof stands in`.
fn fell_back(run: &mut Derivation, args: &Args, steps: &[FellBack]) {
    let Some(last) = steps.last() else { return };
    run.warn("cga::roof-fallback", args.span, || {
        let why: Vec<String> = steps.iter().map(|s| format!("{} failed: {}", s.from, s.why)).collect();
        format!("{} stands in; {}", last.to, why.join("; "))
    });
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
