//! In: selector blocks, of operations and of the comp function. Out: resolved selectors.

use super::builtin_call::Builtin;
use super::lower::Body;
use super::types::{array_of, type_name};
use crate::cga::ast::{self, Argument};
use crate::cga::builtins::{Operation, Word};
use crate::cga::codes;
use crate::cga::program::{Arg, Component, Expr, ExprKind, ExprSelector, Selector, Type};
use crate::source::Span;

impl Body<'_, '_> {
    pub fn selectors(&mut self, selectors: &[ast::Selector<ast::Successor>]) -> Vec<Selector> {
        selectors
            .iter()
            .map(|selector| {
                let test = self.selector_test(selector);
                let text = self.written(selector.test.span);
                let body = self.plain(|b| b.successor(&selector.body, true));
                Selector { test, operator: selector.operator, text, body }
            })
            .collect()
    }

    fn selector_test<T>(&mut self, selector: &ast::Selector<T>) -> Expr {
        let before = std::mem::replace(&mut self.in_selector, true);
        let test = self.expression(&selector.test);
        self.in_selector = before;
        if let Some(found) = test.value.filter(|k| !matches!(k, Type::Float | Type::Bool)) {
            let message = format!("a selector is a word, an index or a condition, not {}", type_name(found));
            self.error(codes::TYPE_MISMATCH, test.span, message);
        }
        test
    }

    /// `comp(f) { top : 1 | all : 2 }` as a value.
    pub fn comp_function(&mut self, args: &[Argument], selectors: &[ast::Selector<ast::Expr>], span: Span) -> Expr {
        let (component, keep_axes) = self.component(Operation::Comp, args, span);
        let mut out = Vec::new();
        for selector in selectors {
            let test = self.selector_test(selector);
            let text = self.written(selector.test.span);
            let value = self.plain(|b| b.expression(&selector.body));
            out.push(ExprSelector { test, operator: selector.operator, text, value });
        }
        let value = self.common(out.iter().map(|s| &s.value)).map(array_of);
        Expr { kind: ExprKind::Comp { component, keep_axes, selectors: out }, value, span }
    }

    /// The arguments of `comp` and `modify`: what is taken apart, and whether the axes are kept.
    pub fn component(&mut self, operation: Operation, args: &[Argument], span: Span) -> (Component, bool) {
        let (args, _) = self.overload(Builtin::Operation(operation), args, span);
        let word = |i: usize| match args.get(i) {
            Some(Arg::Word(word, _)) => Some(*word),
            _ => None,
        };
        let component = match word(0) {
            Some(Word::E) => Component::Edges,
            Some(Word::Fe) => Component::FaceEdges,
            Some(Word::V) => Component::Vertices,
            Some(Word::Fv) => Component::FaceVertices,
            Some(Word::G) => Component::Groups,
            Some(Word::M) => Component::Materials,
            Some(Word::H) => Component::Holes,
            _ => Component::Faces,
        };
        self.no_computed_words(&args);
        let keep_axes = word(1) == Some(Word::NoAlign);
        (component, keep_axes)
    }

    /// `sel(...)` cannot choose the form of a block.
    pub fn no_computed_words(&mut self, args: &[Arg]) {
        for arg in args {
            if let Arg::ComputedWord(text) = arg {
                self.error(codes::UNKNOWN_KEYWORD, text.span, "this keyword must be written out");
            }
        }
    }
}
