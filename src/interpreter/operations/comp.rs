//! `comp` and the comp function (reference 4.1, 6.7). In: a selector block. Out: components as shapes in their own
//! frames, or one value per component.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::Arc;

use smallvec::smallvec;

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::expression::facet_matches;
use super::super::limits::Outcome;
use super::super::shape::{CompSplit, Shape};
use super::super::value::Value;
use super::Pieces;
use super::components::{Components, Group};
use crate::cga::builtins::Word;
use crate::cga::program::{Component, Expr, ExprKind, ExprSelector, Selector, SelectorOperator, Type};
use crate::source::Span;

/// What selectors of the operation and of the function have in common.
pub struct Test<'p> {
    pub test: &'p Expr,
    pub text: &'p Arc<str>,
}

/// Takes the current shape apart: selector by selector, each component to the first that wants it.
pub fn pieces<'p>(
    run: &mut Derivation<'p>,
    component: Component,
    keep_axes: bool,
    selectors: &'p [Selector],
    span: Span,
    env: &Env,
) -> Outcome<Pieces<'p>> {
    Ok(take_apart(run, component, keep_axes, selectors, span, env)?.pieces)
}

/// A shape taken apart.
struct Apart<'s, 'p> {
    parent: Cow<'s, Shape>,
    components: Components,
    /// The number of the selector that took each component.
    owners: Vec<Option<usize>>,
    pieces: Pieces<'p>,
}

/// As [`pieces`], with the faces that lie in none of them.
pub fn pieces_and_rest<'p>(
    run: &mut Derivation<'p>,
    component: Component,
    keep_axes: bool,
    selectors: &'p [Selector],
    span: Span,
    env: &Env,
) -> Outcome<(Pieces<'p>, Vec<usize>)> {
    let Apart { parent, components, owners, pieces } = take_apart(run, component, keep_axes, selectors, span, env)?;
    let taken = |i: &usize| owners[*i].is_some();
    let taken: BTreeSet<usize> = (0..owners.len()).filter(taken).flat_map(|i| components.face_numbers(i)).collect();
    let rest = (0..parent.form.mesh.faces.len()).filter(|f| !taken.contains(f)).collect();
    Ok((pieces, rest))
}

fn take_apart<'s, 'p>(
    run: &mut Derivation<'p>,
    component: Component,
    keep_axes: bool,
    selectors: &'p [Selector],
    span: Span,
    env: &Env<'s>,
) -> Outcome<Apart<'s, 'p>> {
    let parent = env.shape.baked();
    let tests: Vec<Test> = selectors.iter().map(|s| Test { test: &s.test, text: &s.text }).collect();
    let components = Components::of(&parent, component, keep_axes, Wanted::by(&tests));
    let owners = assign(run, &components, &parent, &tests, env)?;
    let trims = if run.program.needs().trims { components.trim_parent(&parent) } else { None };
    let mut pieces: Pieces<'p> = Vec::with_capacity(components.len());
    for (number, selector) in selectors.iter().enumerate() {
        let members: Vec<usize> = (0..owners.len()).filter(|&i| owners[i] == Some(number)).collect();
        let groups = grouped(&components, &parent, members, selector.operator);
        run.count_shapes(groups.len(), span)?;
        let split = CompSplit::shared(&selector.text, groups.len());
        for (index, group) in groups.iter().enumerate() {
            let mut shape = components.shape(&parent, group);
            if let Some(trims) = trims.as_ref().filter(|_| selector.operator == SelectorOperator::Each) {
                components.add_trim_planes(trims, group[0], &mut shape);
            }
            (shape.comp, shape.comp_index) = (split.clone(), index as i32);
            pieces.push((shape, &selector.body));
        }
    }
    Ok(Apart { parent, components, owners, pieces })
}

fn grouped(components: &Components, parent: &Shape, members: Vec<usize>, operator: SelectorOperator) -> Vec<Group> {
    match operator {
        SelectorOperator::Each => members.into_iter().map(|m| smallvec![m]).collect(),
        SelectorOperator::All if members.is_empty() => Vec::new(),
        SelectorOperator::All => vec![members.into()],
        SelectorOperator::Connected => components.connected(parent, &members),
    }
}

/// The number of the first selector that takes each component.
pub fn assign<'p>(
    run: &mut Derivation<'p>,
    components: &Components,
    parent: &Shape,
    tests: &[Test<'p>],
    env: &Env,
) -> Outcome<Vec<Option<usize>>> {
    let mut owners = vec![None; components.len()];
    for (number, selector) in tests.iter().enumerate() {
        match &selector.test.kind {
            ExprKind::Number(index) => {
                if let Some(owner) = by_index(*index, components.len()).and_then(|i| owners.get_mut(i)) {
                    *owner = owner.or(Some(number));
                }
            }
            ExprKind::Selector(word) => {
                for (i, owner) in owners.iter_mut().enumerate() {
                    let facets = components.facets(i);
                    if owner.is_none() && facets.iter().any(|f| facet_matches(run, *word, f, parent)) {
                        *owner = Some(number);
                    }
                }
            }
            _ => {
                for (i, owner) in owners.iter_mut().enumerate() {
                    if owner.is_none() && holds(run, components, parent, selector, i, env)? {
                        *owner = Some(number);
                    }
                }
            }
        }
    }
    Ok(owners)
}

fn by_index(index: f64, count: usize) -> Option<usize> {
    (index >= 0.0 && index < count as f64 && index.fract() == 0.0).then_some(index as usize)
}

/// Evaluates a test with the component as current shape; a float asks for an index.
fn holds<'p>(
    run: &mut Derivation<'p>,
    components: &Components,
    parent: &Shape,
    selector: &Test<'p>,
    i: usize,
    env: &Env,
) -> Outcome<bool> {
    let mut shape = components.shape(parent, &[i]);
    (shape.comp, shape.comp_index) = (CompSplit::shared(selector.text, components.len()), i as i32);
    shape.seed = parent.seed.part(COMPONENT + i as u64);
    let value = run.eval(selector.test, &env.on_component(&shape, parent, components.facets(i)))?;
    Ok(match value {
        Value::Float(index) => by_index(index, components.len()) == Some(i),
        other => other.to_bool(),
    })
}

/// Kind of seed of a component that is only looked at.
pub const COMPONENT: u64 = 4 << 40;

/// What has to be found out about components for the selectors to choose among them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// Eaves, hips, valleys and ridges.
    pub roof_edges: bool,
    /// Which components lie at the border.
    pub borders: bool,
}

impl Wanted {
    pub const BORDERS: Wanted = Wanted { roof_edges: false, borders: true };

    fn by(tests: &[Test]) -> Wanted {
        let none = Wanted { roof_edges: false, borders: false };
        tests.iter().fold(none, |wanted, t| wanted.with(t.test))
    }

    fn with(self, expr: &Expr) -> Wanted {
        match &expr.kind {
            ExprKind::Selector(Word::Eave | Word::Hip | Word::Valley | Word::Ridge) => {
                Wanted { roof_edges: true, ..self }
            }
            ExprKind::Selector(Word::Border | Word::Inside) => Wanted { borders: true, ..self },
            ExprKind::Selector(_) | ExprKind::Number(_) => self,
            ExprKind::Unary(_, inner) => self.with(inner),
            ExprKind::Binary(_, a, b) => self.with(a).with(b),
            // Any other expression may ask about the component it is evaluated on.
            _ => Wanted { borders: true, ..self },
        }
    }
}

/// The comp function: one entry per component in index order; with `=` the value of a group goes to all its members;
/// unselected components give 0, false or "".
pub fn values<'p>(
    run: &mut Derivation<'p>,
    component: Component,
    keep_axes: bool,
    selectors: &'p [ExprSelector],
    expr: &'p Expr,
    env: &Env,
) -> Outcome<Value> {
    let parent = env.shape.baked();
    let tests: Vec<Test> = selectors.iter().map(|s| Test { test: &s.test, text: &s.text }).collect();
    let components = Components::of(&parent, component, keep_axes, Wanted::by(&tests));
    let owners = assign(run, &components, &parent, &tests, env)?;
    let mut values: Vec<Option<Value>> = vec![None; components.len()];
    for (number, selector) in selectors.iter().enumerate() {
        let members: Vec<usize> = (0..owners.len()).filter(|&i| owners[i] == Some(number)).collect();
        let groups = grouped(&components, &parent, members, selector.operator);
        let split = CompSplit::shared(&selector.text, groups.len());
        for (index, group) in groups.iter().enumerate() {
            let mut shape = components.shape(&parent, group);
            (shape.comp, shape.comp_index) = (split.clone(), index as i32);
            shape.seed = parent.seed.part(COMPONENT + group[0] as u64);
            let facets = components.facets(group[0]);
            let value = run.eval(&selector.value, &env.on_component(&shape, &parent, facets))?;
            group.iter().for_each(|&i| values[i] = Some(value.clone()));
        }
    }
    Ok(collected(&values, expr.value))
}

fn collected(values: &[Option<Value>], known: Option<Type>) -> Value {
    let first = values.iter().flatten().map(Value::kind).next();
    match first.or(known) {
        Some(Type::Bool | Type::Bools) => {
            Value::bools(values.iter().map(|v| v.as_ref().is_some_and(Value::to_bool)).collect())
        }
        Some(Type::String | Type::Strings) => {
            Value::strings(values.iter().map(|v| v.as_ref().map_or_else(|| "".into(), Value::to_text)).collect())
        }
        _ => Value::floats(values.iter().map(|v| v.as_ref().map_or(0.0, Value::to_float)).collect()),
    }
}
