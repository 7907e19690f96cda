//! Built-in attributes. In: an [`Attr`] and a shape. Out: its value read or written (reference 5).

use std::path::Path;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::appearance::Appearance;
use super::derivation::Derivation;
use super::placement::{Frame, euler, rotation};
use super::seed::Seed;
use super::shape::Shape;
use super::value::Value;
use crate::cga::builtins::{Attr, MapPart, MaterialAttr};
use crate::cga::program::Axis;

fn number(axis: Axis) -> usize {
    match axis {
        Axis::X => 0,
        Axis::Y => 1,
        Axis::Z => 2,
    }
}

pub fn read(run: &Derivation, attr: Attr, shape: &Shape) -> Value {
    Value::Float(match attr {
        Attr::ScopeTranslation(axis) => shape.translation()[number(axis)],
        Attr::ScopeRotation(axis) => shape.rotation()[number(axis)],
        Attr::ScopeSize(axis) => shape.scope.size[number(axis)],
        Attr::ScopeElevation => shape.scope.frame.origin.y,
        Attr::PivotPosition(axis) => shape.pivot.relative_to(&run.object).origin[number(axis)],
        Attr::PivotOrientation(axis) => euler(&shape.pivot.relative_to(&run.object).axes)[number(axis)],
        Attr::InitialShapeName => return Value::String(run.start.name.clone()),
        Attr::InitialShapeStartRule => {
            return run.start_rule.map_or_else(|| Value::text(""), |name| Value::String(name.clone()));
        }
        Attr::InitialShapeOrigin(axis) => run.object.origin[number(axis)],
        Attr::InitialShapeOrientation(axis) => euler(&run.object.axes)[number(axis)],
        Attr::Seedian => shape.state.seedian.unwrap_or((shape.seed.bits() >> 33) as f64),
        Attr::SplitIndex => f64::from(shape.split_index),
        Attr::SplitTotal => f64::from(shape.split_total),
        Attr::CompSel => {
            return Value::String(shape.comp.as_ref().map_or_else(|| "".into(), |comp| comp.selector.clone()));
        }
        Attr::CompIndex => f64::from(shape.comp_index),
        Attr::CompTotal => shape.comp.as_ref().map_or(0.0, |comp| comp.total),
        Attr::TrimHorizontal => return Value::Bool(shape.state.trim_horizontal),
        Attr::TrimVertical => return Value::Bool(shape.state.trim_vertical),
        Attr::Material(attr) => return read_material(run, attr, shape),
    })
}

/// What the shape set, else what its geometry has, else the default (reference 3.9). Textures read as workspace paths.
fn read_material(run: &Derivation, attr: MaterialAttr, shape: &Shape) -> Value {
    let (own, below) = (&shape.state.appearance, shape.form.first_material());
    let value = match (attr, below) {
        // Channels may come from both layers.
        (MaterialAttr::ColorRgb, Some(below)) => own.over(below).get(attr),
        (_, below) => own.get(attr).or_else(|| below?.get(attr)),
    };
    match (attr, value.unwrap_or_else(|| Appearance::default_value(attr))) {
        (MaterialAttr::Map(_, MapPart::Path), Value::String(path)) => {
            let folder = run.program.files().first().map_or(Path::new(""), |file| &file.folder);
            Value::String(run.assets.shown(folder, &path))
        }
        (_, value) => value,
    }
}

/// Writes an attribute; geometry follows the scope (reference 5.1). Attributes that cannot be written stay.
pub fn write(run: &Derivation, attr: Attr, value: Value, shape: &mut Shape) {
    let changed = |old: DVec3, axis: Axis| {
        let mut new = old;
        new[number(axis)] = value.to_float();
        new
    };
    match attr {
        Attr::ScopeTranslation(axis) => {
            shape.scope.frame.origin = shape.pivot.world_from_local(changed(shape.translation(), axis));
        }
        Attr::ScopeRotation(axis) => {
            shape.scope.frame.axes = shape.pivot.axes * rotation(changed(shape.rotation(), axis));
        }
        Attr::ScopeSize(axis) => shape.scope.size = changed(shape.scope.size, axis),
        Attr::PivotPosition(axis) => {
            let old = shape.pivot.relative_to(&run.object);
            shape.pivot.origin = run.object.world_from_local(changed(old.origin, axis));
        }
        Attr::PivotOrientation(axis) => {
            let old = shape.pivot.relative_to(&run.object);
            let axes: DMat3 = rotation(changed(euler(&old.axes), axis));
            shape.pivot = Frame { origin: old.origin, axes }.placed_in(&run.object);
        }
        Attr::Seedian => {
            let wanted = value.to_float();
            shape.state_mut().seedian = Some(wanted);
            shape.seed = Seed::root(wanted.to_bits());
        }
        Attr::TrimHorizontal => shape.state_mut().trim_horizontal = value.to_bool(),
        Attr::TrimVertical => shape.state_mut().trim_vertical = value.to_bool(),
        Attr::Material(attr) => Arc::make_mut(&mut shape.state_mut().appearance).set(attr, value),
        _ => {}
    }
}
