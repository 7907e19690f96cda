//! `convert` (reference 6.9): positions and orientations between scope, pivot, object and world.

use glam::DVec3;

use super::super::derivation::Derivation;
use super::super::placement::{Frame, euler, rotation};
use super::super::shape::Shape;
use super::super::value::Value;
use super::Input;
use crate::cga::builtins::Word;

/// `convert(axis, from, to, kind, x, y, z)` or `convert(from, to, kind, [x, y, z])`.
pub fn convert(run: &Derivation, input: &Input, shape: &Shape) -> Value {
    let scalar = input.len() == 7;
    let first = usize::from(scalar);
    let system = |word: Option<Word>| match word {
        Some(Word::Scope) => shape.scope.frame,
        Some(Word::Pivot) => shape.pivot,
        Some(Word::Object) => run.object,
        _ => Frame::WORLD,
    };
    let (from, to) = (system(input.word(first)), system(input.word(first + 1)));
    let v = if scalar {
        DVec3::new(input.float(4), input.float(5), input.float(6))
    } else {
        let list = input.value(3).map(|v| v.to_floats());
        let at = |i: usize| list.as_ref().and_then(|a| a.items.get(i)).copied().unwrap_or(0.0);
        DVec3::new(at(0), at(1), at(2))
    };
    let out = match input.word(first + 2) {
        Some(Word::Orient) => euler(&(to.axes.transpose() * from.axes * rotation(v))),
        _ => to.local_from_world(from.world_from_local(v)),
    };
    match input.word(0).filter(|_| scalar) {
        Some(Word::X) => Value::Float(out.x),
        Some(Word::Y) => Value::Float(out.y),
        Some(_) => Value::Float(out.z),
        None => Value::floats(out.to_array().to_vec()),
    }
}
