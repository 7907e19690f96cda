//! The built-in functions of reference 6, grouped as there.
//!
//! In: evaluated arguments and the surroundings. Out: a value.

mod array;
mod color;
mod context;
mod convert;
mod edge;
mod file_order;
mod files;
mod geometry;
mod list;
mod math;
mod place;
mod split_string;
mod tags;
mod text;

use std::sync::Arc;

use super::derivation::Derivation;
use super::environment::Env;
use super::expression::Evaluated;
use super::limits::Outcome;
use super::value::Value;
use crate::cga::builtins::{Function, Word};
use crate::cga::program::DrawSite;
use crate::source::Span;

/// Arguments by position.
pub struct Input<'a> {
    list: &'a [Evaluated],
    pub span: Span,
}

impl<'a> Input<'a> {
    pub fn len(&self) -> usize {
        self.list.len()
    }

    pub fn value(&self, i: usize) -> Option<&'a Value> {
        match self.list.get(i)? {
            Evaluated::Value(_, value) => Some(value),
            Evaluated::Word(_) => None,
        }
    }

    pub fn word(&self, i: usize) -> Option<Word> {
        match self.list.get(i)? {
            Evaluated::Word(word) => Some(*word),
            Evaluated::Value(..) => None,
        }
    }

    pub fn float(&self, i: usize) -> f64 {
        self.value(i).map_or(0.0, Value::to_float)
    }

    pub fn text(&self, i: usize) -> Arc<str> {
        self.value(i).map_or_else(|| "".into(), Value::to_text)
    }

    /// A texture set number, 0 if absent; `None`, with a warning, for others than 0 to 9.
    pub fn uv_set(&self, run: &mut Derivation, i: usize) -> Option<u8> {
        let x = self.float(i);
        if x.fract() == 0.0 && (0.0..10.0).contains(&x) {
            return Some(x as u8);
        }
        run.warn("cga::uv-set", self.span, || "texture coordinate sets are numbered 0 to 9".into());
        None
    }
}

/// Calls a built-in function.
pub fn call(
    run: &mut Derivation,
    function: Function,
    args: &[Evaluated],
    site: Option<DrawSite>,
    span: Span,
    env: &Env,
) -> Outcome<Value> {
    use Function as F;
    let input = Input { list: args, span };
    Ok(match function {
        F::Rand => math::rand(run, &input, env.draw(site)),
        F::P => Value::Bool(env.draw(site) < input.float(0)),
        F::Bool => Value::Bool(input.any(0).to_bool()),
        F::Float => Value::Float(input.any(0).to_float()),
        F::Str => Value::String(input.text(0)),
        F::Print => {
            let value = input.any(0);
            run.print(&value.to_text(), span)?;
            value
        }
        F::ListRandom => list::random(&input, env.draw(site)),
        F::SplitString => split_string::split(run, &input)?,
        F::Replace => text::replace(run, &input)?,
        F::SetElems => array::set_elems(run, &input)?,
        F::GetGeoCoord => place::geo_coordinate(run, &input, env.shape),
        F::GetTreeKey => place::tree_key(run),
        F::Convert => convert::convert(run, &input, env.shape),
        other => {
            if let Some(value) = math::call(other, &input) {
                return Ok(value);
            }
            if let Some(value) = files::call(run, other, &input, site, env)? {
                return Ok(value);
            }
            let value = geometry::call(run, other, &input, env.shape)
                .or_else(|| tags::call(other, &input, env))
                .or_else(|| context::call(run, other, &input, env.shape))
                .or_else(|| edge::call(run, other, &input, env.shape))
                .or_else(|| color::call(other, &input))
                .or_else(|| array::call(other, &input))
                .or_else(|| text::call(other, &input))
                .or_else(|| list::call(other, &input));
            value.expect("every function belongs to one of these families")
        }
    })
}

impl Input<'_> {
    /// The value at `i`, whatever its type; 0 if there is none.
    fn any(&self, i: usize) -> Value {
        self.value(i).cloned().unwrap_or(Value::Float(0.0))
    }
}
