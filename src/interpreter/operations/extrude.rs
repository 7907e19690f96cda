//! `extrude` (reference 4.8; compatibility notes). In: a direction and a distance. Out: prisms in an upright scope.

use glam::{DMat3, DVec3};

use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::limits::Outcome;
use super::super::placement::perpendicular;
use super::super::shape::Shape;
use super::super::topology::vertex_normals;
use super::args::Args;
use super::auto_tags;
use crate::cga::builtins::Word;
use crate::geometry::extrude::{Direction, LEAST_DISTANCE, extrude};
use crate::geometry::{Face, Mesh};

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) -> Outcome<()> {
    let word = args.word(0);
    let distance = args.float_or(run, usize::from(word.is_some()), 0.0);
    shape.bake();
    let scope = shape.scope.frame.axes;
    let direction = match word {
        None | Some(Word::FaceNormal) => Direction::FaceNormal,
        Some(Word::VertexNormal) => Direction::VertexNormal,
        Some(Word::WorldUpFlatTop) => Direction::AlongToFlatTop(DVec3::Y),
        Some(Word::X) => Direction::Along(scope.x_axis),
        Some(Word::Y) => Direction::Along(scope.y_axis),
        Some(Word::Z) => Direction::Along(scope.z_axis),
        Some(Word::WorldX) => Direction::Along(DVec3::X),
        Some(Word::WorldZ) => Direction::Along(DVec3::Z),
        Some(_) => Direction::Along(DVec3::Y),
    };
    if shape.form.mesh.faces.is_empty() {
        extrude_edges(shape, direction, distance);
        return Ok(());
    }
    let up = up(&shape.form.mesh, direction);
    let corners: usize = shape.form.mesh.faces.iter().map(|face| face.corners().count()).sum();
    run.allow_vertices(2 * corners, args.span)?;
    let Some(extruded) = extrude(&shape.form.mesh, direction, distance) else { return Ok(()) };
    let mut form = shape.form.derived(extruded.mesh, extruded.origins.iter().map(|origin| Some(origin.face)));
    auto_tags::extrusion(run.program, &shape.form, &mut form, &extruded.origins);
    let backwards = distance < 0.0 && !matches!(direction, Direction::AlongToFlatTop(_));
    replace_upright(shape, form, up, backwards);
    Ok(())
}

/// The upright axis of the new scope: the direction of the first face or vertex (reference 4.0.3).
fn up(mesh: &Mesh, direction: Direction) -> DVec3 {
    let normal = mesh.faces.first().map_or(DVec3::Y, |face| mesh.normal(face));
    match direction {
        Direction::FaceNormal => normal,
        Direction::VertexNormal => {
            let first = mesh.faces.first().and_then(|f| f.outer.first());
            first.map_or(normal, |&v| vertex_normals(mesh)[v as usize])
        }
        Direction::Along(v) | Direction::AlongToFlatTop(v) => v,
    }
}

/// New geometry in a scope with y along `up` and x as near to the old x as can be. `backwards`: the body lies below
/// its base, so the height is negative and the origin stays on the base (reference 4.0.5).
pub fn replace_upright(shape: &mut Shape, form: Form, up: DVec3, backwards: bool) {
    let old = shape.scope.frame.axes;
    let x = perpendicular(up, old.x_axis, old.z_axis);
    shape.replace_along(form, DMat3::from_cols(x, up, x.cross(up)));
    if backwards {
        shape.scope.frame.origin += shape.scope.frame.axes.y_axis * shape.scope.size.y;
        shape.scope.size.y = -shape.scope.size.y;
        shape.binding = shape.scope;
    }
}

/// Edges become quads that start with the edge; `comp(e)` edges go along the face normals, `comp(fe)` edges outwards.
fn extrude_edges(shape: &mut Shape, direction: Direction, distance: f64) {
    let form = &shape.form;
    if form.edges.is_empty() || distance.abs() <= LEAST_DISTANCE {
        return;
    }
    let mut mesh = Mesh::default();
    let mut first_up = DVec3::Y;
    for (i, &[a, b]) in form.edges.iter().enumerate() {
        let along = match direction {
            Direction::Along(v) | Direction::AlongToFlatTop(v) => v,
            _ => form.normals.get(i).copied().unwrap_or(DVec3::Y),
        };
        if i == 0 {
            first_up = along;
        }
        let (p, q) = (form.mesh.positions[a as usize], form.mesh.positions[b as usize]);
        let start = mesh.positions.len() as u32;
        mesh.positions.extend([p, q, q + along * distance, p + along * distance]);
        mesh.faces.push(Face::new(vec![start, start + 1, start + 2, start + 3]));
    }
    let mut walls = Form::from_mesh(mesh);
    auto_tags::walls(form, &mut walls);
    replace_upright(shape, walls, first_up, distance < 0.0);
}
