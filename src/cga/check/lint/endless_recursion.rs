//! Rules and functions that call themselves in every case. Decided where no condition, no chance and no piece that may
//! be missing stands between a call and the next; everything else is left to the limits of the run.

use std::collections::BTreeSet;

use super::super::graph::{components, is_ring};
use super::constant;
use super::own_name;
use crate::cga::builtins::Word;
use crate::cga::codes;
use crate::cga::program::{
    Arg, BinaryOperator, Component, Expr, ExprKind, Item, Prefix, Program, SplitBlock, SplitItem, Successor,
};
use crate::diagnostics::{Diagnostic, Diagnostics};

/// Numbers of rules or functions.
type Called = BTreeSet<usize>;

pub fn check(program: &Program, diagnostics: &mut Diagnostics) {
    let rules: Vec<Vec<usize>> =
        program.rules.iter().map(|r| always(&r.successor, program).into_iter().collect()).collect();
    for ring in components(&rules).into_iter().filter(|ring| is_ring(ring, &rules)) {
        let first = &program.rules[ring[0]];
        let names = ring.iter().map(|id| own_name(&program.rules[*id].name));
        let message = format!("{} in every case, without end", describe(names));
        let warning = Diagnostic::warning(codes::ENDLESS_RECURSION, first.span, message);
        diagnostics.push(warning.help("put a condition in front of the call: `case scope.sy > 1 : … else : …`"));
    }
    let evaluates = |f: &crate::cga::program::Function| {
        let mut out: Called = f.locals.iter().flat_map(evaluated).collect();
        out.extend(evaluated(&f.body));
        out.into_iter().collect()
    };
    let functions: Vec<Vec<usize>> = program.functions.iter().map(evaluates).collect();
    for ring in components(&functions).into_iter().filter(|ring| is_ring(ring, &functions)) {
        let first = &program.functions[ring[0]];
        let names = ring.iter().map(|id| own_name(&program.functions[*id].name));
        let message = format!("{} in every case, without end", describe(names));
        let error = Diagnostic::error(codes::ENDLESS_RECURSION, first.span, message);
        diagnostics.push(error.help("one branch of a `case` must give a value without the call"));
    }
}

fn describe<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<String> = names.take(5).map(|n| format!("`{n}`")).collect();
    match &names[..] {
        [one] => format!("{one} calls itself"),
        all => format!("{} call each other", all.join(", ")),
    }
}

/// The rules that a successor calls whatever happens.
fn always(successor: &Successor, program: &Program) -> Called {
    match successor {
        Successor::Sequence(sequence) => sequence.items.iter().flat_map(|item| of_item(item, program)).collect(),
        Successor::Case { branches, otherwise } | Successor::Stochastic { branches, otherwise, .. } => {
            let mut out = always(otherwise, program);
            for (_, body) in branches {
                if out.is_empty() {
                    break;
                }
                let other = always(body, program);
                out.retain(|id| other.contains(id));
            }
            out
        }
    }
}

fn of_item(item: &Item, program: &Program) -> Called {
    match item {
        Item::Call { rule, .. } | Item::Instantiate { rule, .. } => BTreeSet::from([rule.0 as usize]),
        Item::Group(body) | Item::Inline { body, .. } => always(body, program),
        Item::Boolean { left, right, .. } => {
            let mut out = always(left, program);
            out.extend(always(right, program));
            out
        }
        Item::Split { block, .. } => whole_piece(block, program).map_or_else(BTreeSet::new, |b| always(b, program)),
        // A face has itself as its only face.
        Item::Comp { component: Component::Faces, selectors, .. } => match selectors.first() {
            Some(first) if first.test.kind == ExprKind::Selector(Word::All) => always(&first.body, program),
            _ => BTreeSet::new(),
        },
        _ => BTreeSet::new(),
    }
}

/// A piece that every split makes, and that is never smaller than this split could take: the first with an absolute
/// size, or one that takes everything.
fn whole_piece<'p>(block: &'p SplitBlock, program: &Program) -> Option<&'p Successor> {
    let SplitItem::Piece { prefix, size, body } = block.items.first()? else { return None };
    let size = constant::number(size, program)?;
    let whole = match prefix {
        Prefix::Absolute => size > 0.0,
        Prefix::Relative => size >= 1.0,
        Prefix::Floating => size > 0.0 && block.items.len() == 1,
    };
    whole.then_some(body)
}

/// The functions that an expression calls whatever happens.
fn evaluated(expr: &Expr) -> Called {
    let all = |parts: &mut dyn Iterator<Item = &Expr>| parts.flat_map(evaluated).collect::<Called>();
    match &expr.kind {
        ExprKind::Call { function, args } => {
            let mut out = all(&mut args.iter());
            out.insert(function.0 as usize);
            out
        }
        ExprKind::Builtin { args, .. } => all(&mut args.iter().filter_map(|arg| match arg {
            Arg::Value(_, e) | Arg::ComputedWord(e) => Some(e),
            Arg::Word(..) => None,
        })),
        ExprKind::Array(rows) => all(&mut rows.iter().flatten()),
        ExprKind::Range { from, step, to } => all(&mut [&**from, &**to].into_iter().chain(step.as_deref())),
        ExprKind::Unary(_, inner) => evaluated(inner),
        ExprKind::Binary(BinaryOperator::And | BinaryOperator::Or, left, _) => evaluated(left),
        ExprKind::Binary(_, left, right) => all(&mut [&**left, &**right].into_iter()),
        ExprKind::Index { array, row, column } => all(&mut [&**array, &**row].into_iter().chain(column.as_deref())),
        ExprKind::Case { branches, otherwise } => {
            let mut out = of_branches(branches, otherwise);
            out.extend(branches.first().map_or_else(BTreeSet::new, |(test, _)| evaluated(test)));
            out
        }
        ExprKind::Stochastic { branches, otherwise, .. } => of_branches(branches, otherwise),
        _ => BTreeSet::new(),
    }
}

fn of_branches(branches: &[(Expr, Expr)], otherwise: &Expr) -> Called {
    let mut out = evaluated(otherwise);
    for (_, value) in branches {
        let other = evaluated(value);
        out.retain(|id| other.contains(id));
    }
    out
}
