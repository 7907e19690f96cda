//! Branches that are never taken: after a condition that always holds, under one that never does or that was asked
//! before, percentages of nothing, and what follows `all` in a component split. The `else` that the grammar demands
//! after percentages of 100 together is no mistake.

use std::collections::BTreeSet;

use super::super::load::LoadedFile;
use super::super::walk::{expressions, expressions_of, items};
use super::constant;
use crate::cga::builtins::{Function as Builtin, Word};
use crate::cga::codes;
use crate::cga::program::{Expr, ExprKind, Item, Program, Selector, Successor};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::Span;

struct Search<'s> {
    program: &'s Program,
    files: &'s [LoadedFile],
    /// Functions that draw random numbers or print, directly or through others: asking twice is not in vain.
    changing: Vec<bool>,
    diagnostics: &'s mut Diagnostics,
}

pub fn check(program: &Program, files: &[LoadedFile], diagnostics: &mut Diagnostics) {
    let mut search = Search { program, files, changing: changing_functions(program), diagnostics };
    for rule in &program.rules {
        rule.locals.iter().for_each(|e| search.of_expression(e));
        search.of_successor(&rule.successor);
    }
    for function in &program.functions {
        function.locals.iter().chain([&function.body]).for_each(|e| search.of_expression(e));
    }
    for attribute in &program.attributes {
        attribute.locals.iter().chain([&attribute.default]).for_each(|e| search.of_expression(e));
    }
}

/// A fixed point: a function changes something if one that it calls does.
fn changing_functions(program: &Program) -> Vec<bool> {
    let mut changing: Vec<bool> = program.functions.iter().map(|f| f.draws > 0).collect();
    let mut callers: Vec<Vec<usize>> = vec![Vec::new(); changing.len()];
    for (id, function) in program.functions.iter().enumerate() {
        for part in function.locals.iter().chain([&function.body]) {
            expressions(part, &mut |e| match &e.kind {
                ExprKind::Call { function, .. } => callers[function.0 as usize].push(id),
                ExprKind::Builtin { function: Builtin::Print, .. } => changing[id] = true,
                _ => {}
            });
        }
    }
    let mut waiting: Vec<usize> = (0..changing.len()).filter(|id| changing[*id]).collect();
    while let Some(id) = waiting.pop() {
        for caller in &callers[id] {
            if !std::mem::replace(&mut changing[*caller], true) {
                waiting.push(*caller);
            }
        }
    }
    changing
}

impl Search<'_> {
    fn warn(&mut self, span: Span, message: &str) {
        self.diagnostics.push(Diagnostic::warning(codes::UNREACHABLE, span, message));
    }

    fn of_successor(&mut self, successor: &Successor) {
        self.of_branches(successor);
        let mut found: Vec<&Item> = Vec::new();
        items(successor, &mut |item| found.push(item));
        for item in found {
            super::super::walk::bodies(item).into_iter().for_each(|body| self.of_branches(body));
            expressions_of(item).into_iter().for_each(|e| self.of_expression(e));
            if let Item::Comp { selectors, .. } | Item::Modify { selectors, .. } = item {
                let tests: Vec<&Expr> = selectors.iter().map(|s: &Selector| &s.test).collect();
                self.of_selectors(&tests);
            }
        }
    }

    /// The chain a successor is, and the chains directly in its branches.
    fn of_branches(&mut self, successor: &Successor) {
        let (branches, otherwise) = match successor {
            Successor::Sequence(_) => return,
            Successor::Case { branches, otherwise } => {
                self.of_tests(&branches.iter().map(|(test, _)| test).collect::<Vec<_>>());
                (branches, otherwise)
            }
            Successor::Stochastic { branches, otherwise, .. } => {
                self.of_weights(&branches.iter().map(|(weight, _)| weight).collect::<Vec<_>>());
                (branches, otherwise)
            }
        };
        branches.iter().for_each(|(test, _)| self.of_expression(test));
        branches.iter().map(|(_, body)| body).chain([&**otherwise]).for_each(|body| self.of_branches(body));
    }

    fn of_expression(&mut self, expr: &Expr) {
        let mut chains: Vec<&Expr> = Vec::new();
        expressions(expr, &mut |e| {
            if matches!(e.kind, ExprKind::Case { .. } | ExprKind::Stochastic { .. } | ExprKind::Comp { .. }) {
                chains.push(e);
            }
        });
        for chain in chains {
            match &chain.kind {
                ExprKind::Case { branches, .. } => {
                    self.of_tests(&branches.iter().map(|(test, _)| test).collect::<Vec<_>>());
                }
                ExprKind::Stochastic { branches, .. } => {
                    self.of_weights(&branches.iter().map(|(weight, _)| weight).collect::<Vec<_>>());
                }
                ExprKind::Comp { selectors, .. } => {
                    self.of_selectors(&selectors.iter().map(|s| &s.test).collect::<Vec<_>>());
                }
                _ => {}
            }
        }
    }

    fn of_tests(&mut self, tests: &[&Expr]) {
        let mut asked: BTreeSet<String> = BTreeSet::new();
        for test in tests {
            match constant::condition(test) {
                Some(true) => return self.warn(test.span, "this always holds: the branches behind it are never taken"),
                Some(false) => self.warn(test.span, "this never holds: its branch is never taken"),
                None if self.is_steady(test) && !asked.insert(self.written(test.span)) => {
                    self.warn(test.span, "this was asked before: its branch is never taken");
                }
                None => {}
            }
        }
    }

    fn of_weights(&mut self, weights: &[&Expr]) {
        let mut used = 0.0;
        for weight in weights {
            let known = constant::number(weight, self.program);
            if known.is_some_and(|w| w <= 0.0) {
                self.warn(weight.span, "a branch of no percent is never taken");
            } else if used >= 100.0 {
                self.warn(weight.span, "the branches before it are 100 percent: it is never taken");
            }
            used += known.unwrap_or(0.0).max(0.0);
        }
    }

    fn of_selectors(&mut self, tests: &[&Expr]) {
        let mut asked: BTreeSet<String> = BTreeSet::new();
        let mut all = false;
        for test in tests {
            if all {
                self.warn(test.span, "`all` has taken what was left: nothing is selected here");
            } else if self.is_steady(test) && !asked.insert(self.written(test.span)) {
                self.warn(test.span, "this selector stands before: nothing is left for it");
            }
            all |= test.kind == ExprKind::Selector(Word::All);
        }
    }

    /// Whether a second evaluation gives the same and does nothing.
    fn is_steady(&self, expr: &Expr) -> bool {
        let mut steady = true;
        expressions(expr, &mut |e| match &e.kind {
            ExprKind::Call { function, .. } => steady &= !self.changing[function.0 as usize],
            ExprKind::Builtin { function, .. } => steady &= !function.draws() && *function != Builtin::Print,
            ExprKind::Stochastic { .. } => steady = false,
            _ => {}
        });
        steady
    }

    /// The text of a place without white space.
    fn written(&self, span: Span) -> String {
        let file = self.files.iter().find(|f| f.ast.source == span.source).expect("spans lie in loaded files");
        file.text[span.start as usize..span.end as usize].split_whitespace().collect()
    }
}
