//! Expressions. In: a checked [`Expr`] and its [`Env`]. Out: its [`Value`].
//!
//! Types were checked where inference succeeded; where it did not, a wrong type is converted as by `float`, `bool` or
//! `str` and warned about once per place.

use std::sync::Arc;

use smallvec::SmallVec;

use super::arithmetic;
use super::choice;
use super::derivation::Derivation;
use super::environment::{Env, Facet, RoofEdge};
use super::limits::{Outcome, Stop};
use super::operations::{comp, setback_uv};
use super::shape::Shape;
use super::value::Value;
use super::{array, attribute, functions, streets};
use crate::cga::builtins::Word;
use crate::cga::program::{Arg, BinaryOperator, Expr, ExprKind, Prefix, Type};
use crate::source::Span;

/// An argument after evaluation.
#[derive(Clone, Debug)]
pub enum Evaluated {
    Value(Prefix, Value),
    Word(Word),
}

/// Arguments of one call, in place up to the usual number.
pub type EvaluatedArgs = SmallVec<[Evaluated; 6]>;

impl<'p> Derivation<'p> {
    /// Evaluates an expression; only a met limit stops it.
    #[inline]
    pub fn eval(&mut self, expr: &'p Expr, env: &Env) -> Outcome<Value> {
        if let Some(value) = simple(expr, env) {
            return Ok(value);
        }
        self.enter_expression(expr.span)?;
        let value = self.eval_nested(expr, env);
        self.leave_expression();
        value
    }

    fn eval_nested(&mut self, expr: &'p Expr, env: &Env) -> Outcome<Value> {
        match &expr.kind {
            ExprKind::Number(x) => Ok(Value::Float(*x)),
            ExprKind::Bool(b) => Ok(Value::Bool(*b)),
            ExprKind::String(s) => Ok(Value::String(s.clone())),
            ExprKind::Slot(slot) => Ok(env.slots.get(*slot as usize).cloned().unwrap_or(Value::Float(0.0))),
            ExprKind::Attribute(id) => Ok(env.shape.state.attributes[id.0 as usize].clone()),
            ExprKind::BuiltinAttribute(attr) => Ok(attribute::read(self, *attr, env.shape)),
            ExprKind::Array(rows) => array::construct(self, rows, expr.span, env),
            ExprKind::Range { from, step, to } => array::range(self, from, step.as_deref(), to, env),
            ExprKind::Call { function, args } => self.call_function(*function, args, env),
            ExprKind::Builtin { function, args, site } => {
                let args = self.eval_args(args, env)?;
                functions::call(self, *function, &args, *site, expr.span, env)
            }
            ExprKind::Unary(operator, operand) => {
                let value = self.eval(operand, env)?;
                Ok(arithmetic::unary(self, *operator, value, expr.span))
            }
            ExprKind::Binary(operator, left, right) => self.eval_binary(*operator, left, right, expr.span, env),
            ExprKind::Case { branches, otherwise } => {
                for (condition, value) in branches {
                    if self.eval_bool(condition, env)? {
                        return self.eval(value, env);
                    }
                }
                self.eval(otherwise, env)
            }
            ExprKind::Stochastic { branches, otherwise, site } => match choice::choose(self, branches, *site, env)? {
                Some(value) => self.eval(value, env),
                None => self.eval(otherwise, env),
            },
            ExprKind::Index { array, row, column } => array::index(self, array, row, column.as_deref(), env),
            ExprKind::Comp { component, keep_axes, selectors } => {
                comp::values(self, *component, *keep_axes, selectors, expr, env)
            }
            ExprKind::Selector(word) => Ok(Value::Bool(self.matches(*word, env))),
        }
    }

    fn eval_binary(
        &mut self,
        operator: BinaryOperator,
        left: &'p Expr,
        right: &'p Expr,
        span: Span,
        env: &Env,
    ) -> Outcome<Value> {
        match operator {
            BinaryOperator::And => Ok(Value::Bool(self.eval_bool(left, env)? && self.eval_bool(right, env)?)),
            BinaryOperator::Or => Ok(Value::Bool(self.eval_bool(left, env)? || self.eval_bool(right, env)?)),
            _ => {
                let (a, b) = (self.eval(left, env)?, self.eval(right, env)?);
                arithmetic::binary(self, operator, a, b, span)
            }
        }
    }

    /// Evaluates a user function on the current shape.
    fn call_function(&mut self, id: crate::cga::program::FunctionId, args: &'p [Expr], env: &Env) -> Outcome<Value> {
        let function = self.program.function(id);
        self.used.function(id);
        let mut slots = Vec::with_capacity(args.len() + function.locals.len());
        for arg in args {
            slots.push(self.eval(arg, env)?);
        }
        let base = env.call(&[]);
        for local in &function.locals {
            let value = self.eval(local, &base.with_slots(&slots))?;
            slots.push(value);
        }
        self.eval(&function.body, &base.with_slots(&slots))
    }

    pub fn eval_args(&mut self, args: &'p [Arg], env: &Env) -> Outcome<EvaluatedArgs> {
        let mut list = EvaluatedArgs::new();
        self.eval_args_into(args, env, &mut list)?;
        Ok(list)
    }

    /// As [`Derivation::eval_args`], at the end of a list.
    pub fn eval_args_into(&mut self, args: &'p [Arg], env: &Env, list: &mut EvaluatedArgs) -> Outcome<()> {
        for arg in args {
            list.push(match arg {
                Arg::Value(prefix, expr) => Evaluated::Value(*prefix, self.eval(expr, env)?),
                Arg::Word(word, _) => Evaluated::Word(*word),
                Arg::ComputedWord(expr) => Evaluated::Word(self.eval_word(expr, env)?),
            });
        }
        Ok(())
    }

    fn eval_word(&mut self, expr: &'p Expr, env: &Env) -> Outcome<Word> {
        let text = self.eval(expr, env)?.to_text();
        let Some(word) = Word::from_text(&text) else {
            self.error("cga::unknown-selector", expr.span, format!("`{text}` is no selector"));
            return Err(Stop);
        };
        Ok(word)
    }

    pub fn eval_bool(&mut self, expr: &'p Expr, env: &Env) -> Outcome<bool> {
        match self.eval(expr, env)? {
            Value::Bool(b) => Ok(b),
            other => {
                self.warn_type(expr.span, Type::Bool, &other);
                Ok(other.to_bool())
            }
        }
    }

    pub fn eval_float(&mut self, expr: &'p Expr, env: &Env) -> Outcome<f64> {
        match self.eval(expr, env)? {
            Value::Float(x) => Ok(x),
            other => {
                self.warn_type(expr.span, Type::Float, &other);
                Ok(other.to_float())
            }
        }
    }

    /// As [`Derivation::eval_float`]; NaN and infinity become 0 with a warning (reference 2.11).
    pub fn eval_finite(&mut self, expr: &'p Expr, env: &Env) -> Outcome<f64> {
        let x = self.eval_float(expr, env)?;
        Ok(self.finite(x, expr.span))
    }

    fn warn_type(&mut self, span: Span, wanted: Type, got: &Value) {
        self.warn("cga::wrong-type", span, || format!("a {} was needed, got `{}`", type_name(wanted), got.to_text()));
    }

    /// Whether the current component, or the current shape's faces, match a selector word.
    fn matches(&mut self, word: Word, env: &Env) -> bool {
        match (env.component, env.outer) {
            (Some(facets), Some(outer)) => facets.iter().any(|f| facet_matches(self, word, f, outer)),
            _ => false,
        }
    }
}

/// Whether a component of `outer` matches a selector word (reference 3.5, 3.6).
pub fn facet_matches(run: &Derivation, word: Word, facet: &Facet, outer: &Shape) -> bool {
    match word {
        Word::All => true,
        Word::Border => facet.is_border,
        Word::Inside => !facet.is_border,
        Word::Eave => facet.roof_edge == Some(RoofEdge::Eave),
        Word::Hip => facet.roof_edge == Some(RoofEdge::Hip),
        Word::Valley => facet.roof_edge == Some(RoofEdge::Valley),
        Word::Ridge => facet.roof_edge == Some(RoofEdge::Ridge),
        Word::UvLeft | Word::UvRight | Word::UvBottom | Word::UvTop => uv_agrees(word, facet),
        Word::UvUMin | Word::UvUMax | Word::UvVMin | Word::UvVMax => uv_agrees(word, facet),
        other => streets::facet_agrees(run, other, facet, outer).unwrap_or(false),
    }
}

fn uv_agrees(word: Word, facet: &Facet) -> bool {
    facet.uv_side.as_ref().and_then(|side| setback_uv::agrees(word, side)).unwrap_or(false)
}

/// Leaves of the expression tree, evaluated without bookkeeping.
#[inline]
fn simple(expr: &Expr, env: &Env) -> Option<Value> {
    Some(match &expr.kind {
        ExprKind::Number(x) => Value::Float(*x),
        ExprKind::Bool(b) => Value::Bool(*b),
        ExprKind::String(s) => Value::String(Arc::clone(s)),
        ExprKind::Slot(slot) => env.slots.get(*slot as usize)?.clone(),
        ExprKind::Attribute(id) => env.shape.state.attributes.get(id.0 as usize)?.clone(),
        _ => return None,
    })
}

fn type_name(kind: Type) -> &'static str {
    match kind {
        Type::Float => "float",
        Type::Bool => "bool",
        Type::String => "string",
        Type::Floats => "float[]",
        Type::Bools => "bool[]",
        Type::Strings => "string[]",
    }
}
