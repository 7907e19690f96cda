//! `envelope` (reference 4.8). In: a direction, the greatest height, and base height and slope angle per side of the
//! street or per face edge. Out: a closed body over every face that nothing may stick out of, in an upright scope.
//!
//! With `world.up` heights count from the lowest corner of the face, and a face that is not level cuts the body off below.

use glam::DVec3;

use super::super::derivation::Derivation;
use super::super::expression::facet_matches;
use super::super::shape::Shape;
use super::super::value::Value;
use super::args::Args;
use super::auto_tags;
use super::comp::Wanted;
use super::components::Components;
use super::extrude::replace_upright;
use crate::cga::builtins::Word;
use crate::cga::program::Component;
use crate::geometry::cut::{self, Origin};
use crate::geometry::envelope::{Limit, Part, envelope};
use crate::geometry::transform::flip_loop;
use crate::geometry::{Face, Mesh, PlaneFrame};

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    shape.bake();
    let source = shape.form.clone();
    let Some(up) = source.mesh.faces.first().map(|f| source.mesh.normal(f)).filter(|n| *n != DVec3::ZERO) else {
        run.warn("cga::no-face", args.span, || "there is no face to put an envelope over".into());
        return;
    };
    let word = args.word(0);
    let height = args.float_or(run, usize::from(word.is_some()), 0.0);
    if height <= 0.0 {
        run.warn("cga::envelope", args.span, || format!("an envelope of height {height} has no room"));
        return;
    }
    let limits = limits(run, args, shape);
    let upright = word == Some(Word::WorldUp);
    let (mut mesh, mut sources, mut parts, mut stands_on) = (Mesh::default(), Vec::new(), Vec::new(), Vec::new());
    let mut first_edge = 0;
    for (number, face) in source.mesh.faces.iter().enumerate() {
        let edges = face.edges().count();
        let own = &limits[first_edge..first_edge + edges];
        first_edge += edges;
        match over_face(&source.mesh, number, own, height, upright) {
            Ok((body, found)) => {
                append(&mut mesh, &body);
                sources.resize(mesh.faces.len(), Some(number as u32));
                parts.extend(found.iter().map(|part| name(*part, face.outer.len())));
                stands_on.extend(found.iter().map(|part| match part {
                    Part::Side { edge, .. } => Some((number, *edge)),
                    _ => None,
                }));
            }
            Err(error) => {
                run.warn("cga::envelope", args.span, || format!("no envelope here: {error}"));
                return;
            }
        }
    }
    let mut form = source.derived(mesh, sources.into_iter());
    auto_tags::borders(&source, &mut form, &stands_on);
    if run.program.observes_tags() {
        form.auto_tag_faces("envelope", parts.into_iter().map(Some));
    }
    replace_upright(shape, form, if upright { DVec3::Y } else { up }, false);
}

/// Wall and slope per face edge. Edges of no class, and those beyond the end of an array, are upright.
fn limits(run: &mut Derivation, args: &Args, shape: &Shape) -> Vec<Limit> {
    let first = usize::from(args.word(0).is_some()) + 1;
    let components = Components::of(shape, Component::FaceEdges, false, Wanted::BORDERS);
    let mut out = Vec::with_capacity(components.len());
    let sides: &[Word] = match args.len() - first {
        8 => &[Word::StreetFront, Word::StreetBack, Word::StreetRight, Word::StreetLeft],
        6 => &[Word::StreetFront, Word::StreetBack, Word::StreetSide],
        4 => &[Word::StreetFront, Word::StreetBack],
        _ => &[Word::StreetFront],
    };
    let lists = (args.value(first), args.value(first + 1));
    for edge in 0..components.len() {
        let (base, angle) = match lists {
            (Some(Value::Floats(bases)), Some(Value::Floats(angles))) => {
                (bases.items.get(edge).copied(), angles.items.get(edge).copied())
            }
            _ => {
                let facet = &components.facets(edge)[0];
                let class = sides.iter().position(|&word| facet_matches(run, word, facet, shape));
                let value = |i: usize| args.value(i).map(Value::to_float);
                class.map_or((None, None), |k| (value(first + 2 * k), value(first + 2 * k + 1)))
            }
        };
        let base = run.finite(base.unwrap_or(0.0), args.span).max(0.0);
        let angle = run.finite(angle.unwrap_or(90.0), args.span);
        if !(0.0..=90.0).contains(&angle) {
            run.warn("cga::envelope", args.span, || {
                format!("the slope {angle} is not between 0 and 90: {} is used", angle.clamp(0.0, 90.0))
            });
        }
        out.push(Limit { base, angle: angle.clamp(0.0, 90.0) });
    }
    out
}

/// The body over one face in the world, and what each of its faces is; edges count as the face runs them.
fn over_face(
    mesh: &Mesh,
    number: usize,
    limits: &[Limit],
    height: f64,
    upright: bool,
) -> Result<(Mesh, Vec<Part>), String> {
    let face = &mesh.faces[number];
    let frame = PlaneFrame::of_face(mesh, face).ok_or("the face has no area")?;
    let outer = face.outer.len();
    let mut limits = limits.to_vec();
    // Courtyards have upright walls.
    limits[outer..].fill(Limit { base: 0.0, angle: 90.0 });
    let heights = face.corners().map(|v| mesh.positions[v as usize].y);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
    let level = high - low <= 1e-9 * (1.0 + high.abs());
    if !upright || (level && frame.normal.y > 0.0) {
        let found = envelope(&frame.face_to_plan(mesh, face), &limits, height).map_err(|e| e.to_string())?;
        let lift = |p: &DVec3| frame.to_space(glam::DVec2::new(p.x, -p.z), p.y);
        let positions = found.mesh.positions.iter().map(lift).collect();
        return Ok((Mesh { positions, faces: found.mesh.faces }, found.parts));
    }
    if frame.normal.y.abs() < 1e-6 {
        return Err("an upright face has nothing above it".into());
    }
    let ground = PlaneFrame { origin: DVec3::new(0.0, low, 0.0), ..PlaneFrame::PLAN };
    let mut plan = ground.face_to_plan(mesh, face);
    let downwards = frame.normal.y < 0.0;
    if downwards {
        // Seen from above the face runs the other way: edge i of n becomes edge n - i.
        let mut first = 0;
        for ring in std::iter::once(&mut plan.outer).chain(&mut plan.holes) {
            flip_loop(ring);
            let own = &mut limits[first..first + ring.len()];
            own[1..].reverse();
            first += ring.len();
        }
    }
    let found = envelope(&plan, &limits, height).map_err(|e| e.to_string())?;
    let positions = found.mesh.positions.iter().map(|p| *p + DVec3::Y * low).collect();
    let whole = Mesh { positions, faces: found.mesh.faces };
    let floor = frame.plane();
    let floor = if floor.normal.y < 0.0 { floor.flipped() } else { floor };
    let above = cut::cut(&whole, &floor).front;
    if above.is_empty() {
        return Err("the face lies above the whole envelope".into());
    }
    let parts = above.origins.iter().map(|origin| match (origin, downwards) {
        (Origin::Cap, _) => Part::Bottom,
        (Origin::Face(i), false) => found.parts[*i as usize],
        (Origin::Face(i), true) => turned(found.parts[*i as usize], face),
    });
    let parts = parts.collect();
    Ok((above.mesh, parts))
}

/// A part over a ring that was turned round, with its edge as the face runs it.
fn turned(part: Part, face: &Face) -> Part {
    let Part::Side { edge, slope } = part else { return part };
    let mut first = 0;
    for ring in face.loops() {
        if edge < first + ring.len() {
            return Part::Side { edge: first + (first + ring.len() - edge) % ring.len(), slope };
        }
        first += ring.len();
    }
    part
}

fn name(part: Part, outer: usize) -> &'static str {
    match part {
        Part::Bottom => "envelope.bottom",
        Part::Side { edge, .. } if edge >= outer => "envelope.side.inner",
        Part::Side { slope: true, .. } | Part::Step => "envelope.side.slope",
        Part::Side { slope: false, .. } => "envelope.side.base",
        Part::Top => "envelope.top",
    }
}

fn append(mesh: &mut Mesh, body: &Mesh) {
    let start = mesh.positions.len() as u32;
    mesh.positions.extend(&body.positions);
    for face in &body.faces {
        let mut face = face.clone();
        face.loops_mut().flatten().for_each(|v| *v += start);
        mesh.faces.push(face);
    }
}
