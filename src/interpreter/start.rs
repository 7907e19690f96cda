//! The first shape. In: the host's [`StartShape`](super::StartShape). Out: the object frame, the evaluated
//! attributes, and the task the derivation begins with (reference 2.6, 3.3).

use std::rc::Rc;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use smallvec::SmallVec;

use super::derivation::{Derivation, Symbol, Task};
use super::environment::Env;
use super::form::Form;
use super::limits::{Outcome, Stop};
use super::outline::{self, Outline};
use super::placement::{Frame, perpendicular};
use super::shape::{Scope, Shape, State};
use super::streets::Streets;
use super::tree::Scalar;
use super::value::Value;
use crate::cga::program::{Attribute, Constant, RuleId};
use crate::geometry::Mesh;
use crate::source::{SourceId, Span};

/// Sets up the run; `None` where there is nothing to derive.
pub fn prepare<'p>(run: &mut Derivation<'p>) -> Outcome<Option<Task<'p>>> {
    let Some(rule) = start_rule(run) else { return Err(Stop) };
    run.start_rule = Some(&run.program.rule(rule).name);
    let span = run.program.rule(rule).span;
    if !run.start.mesh.positions.iter().all(|p| p.is_finite()) {
        run.error("cga::start-shape", span, "the start shape has a coordinate that is not a finite number".into());
        return Err(Stop);
    }
    run.count_shapes(1, span)?;
    run.count_vertices(run.start.mesh.positions.len(), span)?;
    let mesh = without_doubled_vertices(run, span);
    run.object = object_frame(&mesh);
    run.outline = outline::of_host(&run.start.host, &run.start.mesh, &mesh);
    let street_widths = &run.start.host.street_widths;
    if !street_widths.is_empty() {
        run.streets = Streets::new(Outline::new(&run.start.mesh, &mesh), street_widths);
    }
    let mut shape = Box::new(initial_shape(mesh, run));
    run.initial = Some(shape.clone());
    evaluate_attributes(run, &mut shape)?;
    run.leaves.set_attributes(exported(run, &shape));
    let step = run.steps.root(&run.program.rule(rule).name);
    Ok(Some(Task { shape, symbol: Symbol::Rule(rule), args: Vec::new(), step }))
}

fn start_rule(run: &mut Derivation) -> Option<RuleId> {
    let program = run.program;
    let wanted = run.start.start_rule.clone();
    let found = program.start(wanted.as_deref());
    if found.is_none() {
        let source = program.files().first().map_or(SourceId(0), |f| f.source);
        let message = match &wanted {
            Some(name) => format!("there is no rule `{name}` without parameters to start with"),
            None => "there is no rule without parameters to start with".into(),
        };
        run.error("cga::no-start-rule", Span::new(source, 0, 0), message);
    }
    found
}

/// Drops vertices that repeat their predecessor in a loop, with a warning, keeping the first edge.
fn without_doubled_vertices(run: &mut Derivation, span: Span) -> Mesh {
    let mut mesh = run.start.mesh.clone();
    let positions = &mesh.positions;
    let mut dropped = 0;
    for face in &mut mesh.faces {
        if !face.uvs.is_empty() {
            continue;
        }
        for ring in std::iter::once(&mut face.outer).chain(&mut face.holes) {
            let before = ring.len();
            ring.dedup_by(|b, a| positions[*a as usize] == positions[*b as usize]);
            while ring.len() > 1 && positions[ring[0] as usize] == positions[ring[ring.len() - 1] as usize] {
                ring.pop();
            }
            dropped += before - ring.len();
        }
        face.holes.retain(|hole| hole.len() >= 3);
    }
    mesh.faces.retain(|face| face.outer.len() >= 3);
    if dropped > 0 {
        run.warn("cga::doubled-vertex", span, || format!("{dropped} doubled vertices of the start shape were removed"));
    }
    mesh
}

/// x along the first edge, y along the first face's normal, origin at its first vertex.
fn object_frame(mesh: &Mesh) -> Frame {
    let Some(face) = mesh.faces.first() else {
        return Frame { origin: mesh.positions.first().copied().unwrap_or_default(), axes: DMat3::IDENTITY };
    };
    let (a, b) = (mesh.positions[face.outer[0] as usize], mesh.positions[face.outer[1] as usize]);
    let y = mesh.normal(face);
    let y = if y == DVec3::ZERO { DVec3::Y } else { y };
    let x = perpendicular(y, b - a, DVec3::X);
    Frame::new(a, x, y, x.cross(y))
}

fn initial_shape(mesh: Mesh, run: &Derivation) -> Shape {
    let flat = Scope { frame: run.object, size: DVec3::ZERO };
    let scope = Scope::around(&mesh.positions, run.object.axes).unwrap_or(flat);
    let state = State {
        appearance: Arc::default(),
        projections: SmallVec::new(),
        attributes: Arc::new(vec![Value::Float(0.0); run.program.attributes().len()]),
        seedian: None,
        trim_horizontal: false,
        trim_vertical: true,
    };
    Shape {
        form: Arc::new(Form::from_mesh(mesh)),
        binding: scope,
        scope,
        pivot: run.object,
        state: Rc::new(state),
        comp: None,
        comp_index: -1,
        split_index: -1,
        split_total: 0,
        seed: run.start.seed,
        trail: None,
        trim_source: None,
        provenance: None,
    }
}

/// Every attribute and constant once, on the initial shape; each has a seed of its own (reference 2.6).
fn evaluate_attributes(run: &mut Derivation, shape: &mut Shape) -> Outcome<()> {
    let program = run.program;
    let seed = shape.seed;
    for &id in program.initial_order() {
        let attribute = program.attribute(id);
        let value = match host_value(run, attribute) {
            Some(value) => value,
            None if attribute.is_map => {
                shape.seed = seed.named(&attribute.name);
                street_widths(run, attribute, shape)?
            }
            None => {
                shape.seed = seed.named(&attribute.name);
                default_value(run, attribute, shape)?
            }
        };
        Arc::make_mut(&mut shape.state_mut().attributes)[id.0 as usize] = value;
    }
    shape.seed = seed;
    Ok(())
}

/// `attr streetWidth(edge) = ...`: the host's width of every edge, else the default for every edge, which then decides
/// where streets are.
fn street_widths<'p>(run: &mut Derivation<'p>, attribute: &'p Attribute, shape: &Shape) -> Outcome<Value> {
    let given = &run.start.host.street_widths;
    if !given.is_empty() {
        return Ok(Value::floats(given.clone()));
    }
    let outline = Outline::new(&run.start.mesh, &shape.form.mesh);
    let mut widths = Vec::new();
    for edge in 0..run.start.mesh.faces.iter().map(|f| f.edges().count()).sum() {
        let mut slots = vec![Value::Float(edge as f64)];
        for (i, local) in attribute.locals.iter().enumerate() {
            let value = run.eval(local, &Env::new(shape, &slots, i as u64 + 1))?;
            slots.push(value);
        }
        widths.push(run.eval_finite(&attribute.default, &Env::new(shape, &slots, 0))?);
    }
    run.streets = run.streets.take().or_else(|| Streets::new(outline, &widths));
    Ok(Value::floats(widths))
}

pub fn default_value<'p>(run: &mut Derivation<'p>, attribute: &'p Attribute, shape: &Shape) -> Outcome<Value> {
    let mut slots = Vec::with_capacity(attribute.locals.len());
    for (i, local) in attribute.locals.iter().enumerate() {
        let value = run.eval(local, &Env::new(shape, &slots, i as u64 + 1))?;
        slots.push(value);
    }
    run.eval(&attribute.default, &Env::new(shape, &slots, 0))
}

/// The host's value, converted to the attribute's type and kept to its range.
pub fn host_value(run: &mut Derivation, attribute: &Attribute) -> Option<Value> {
    if attribute.is_const || attribute.is_map {
        return None;
    }
    let start = run.start;
    let (_, scalar) = start.attributes.iter().find(|(name, _)| *name == attribute.name)?;
    let given = Value::from(scalar);
    let mut value = attribute.kind.map_or(given.clone(), |kind| given.converted(kind));
    if let (Value::Float(x), Some(range)) = (&mut value, &attribute.annotations.range)
        && range.restricted
    {
        *x = x.max(range.min.unwrap_or(*x)).min(range.max.unwrap_or(*x));
    }
    let choices = attribute.annotations.choices.as_ref().filter(|c| c.restricted);
    let allowed = choices.is_none_or(|choices| choices.values.iter().any(|choice| constant(choice) == value));
    if !allowed {
        run.warn("cga::value-not-allowed", attribute.span, || {
            format!("`{}` is no allowed value of `{}`, its default is used", value.to_text(), attribute.name)
        });
        return None;
    }
    Some(value)
}

fn constant(constant: &Constant) -> Value {
    match constant {
        Constant::Float(x) => Value::Float(*x),
        Constant::Bool(b) => Value::Bool(*b),
        Constant::String(s) => Value::String(s.clone()),
    }
}

/// Attribute values as the host sees them: without hidden ones and constants, sorted by name. A later `set` does not
/// show (compatibility notes, "Random, attributes, reports").
fn exported(run: &Derivation, shape: &Shape) -> Arc<[(Arc<str>, Scalar)]> {
    let attributes = run.program.attributes().iter().zip(shape.state.attributes.iter());
    let shown = attributes.filter(|(a, _)| !a.is_const && !a.is_map && !a.annotations.hidden);
    let mut list: Vec<_> = shown.map(|(a, value)| (a.name.clone(), value.to_scalar())).collect();
    list.sort_by(|a, b| a.0.cmp(&b.0));
    list.into()
}
