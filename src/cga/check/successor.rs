//! In: successors of the tree. Out: resolved successors; decides where an anonymous leaf ends a sequence.

use super::lower::Body;
use crate::cga::ast;
use crate::cga::program::{Expr, Item, Sequence, Successor};

impl Body<'_, '_> {
    /// `leaf` is false directly inside `[ ]`, where no anonymous leaf is made.
    pub fn successor(&mut self, successor: &ast::Successor, leaf: bool) -> Successor {
        match successor {
            ast::Successor::Sequence(items) => {
                let items: Vec<Item> = items.iter().map(|item| self.item(item)).collect();
                let implicit_leaf = leaf && !items.iter().any(makes_shapes);
                Successor::Sequence(Sequence { items, implicit_leaf })
            }
            ast::Successor::Case { branches, otherwise } => {
                let branches = branches.iter().map(|(test, body)| {
                    let test = self.condition(test);
                    (test, self.successor(body, leaf))
                });
                let branches: Vec<(Expr, Successor)> = branches.collect();
                Successor::Case { branches, otherwise: Box::new(self.successor(otherwise, leaf)) }
            }
            ast::Successor::Stochastic { branches, otherwise } => {
                let site = self.draw();
                if let Some((first, last)) = branches.first().zip(branches.last()) {
                    self.weights(branches.iter().map(|(weight, _)| weight), first.0.span.to(last.0.span));
                }
                let branches = branches.iter().map(|(weight, body)| {
                    let weight = self.number(weight);
                    (weight, self.successor(body, leaf))
                });
                let branches: Vec<(Expr, Successor)> = branches.collect();
                Successor::Stochastic { branches, otherwise: Box::new(self.successor(otherwise, leaf)), site }
            }
        }
    }
}

/// Whether an item creates or discards a shape (reference 2.1).
fn makes_shapes(item: &Item) -> bool {
    match item {
        Item::Call { .. }
        | Item::Instantiate { .. }
        | Item::Leaf { .. }
        | Item::Discard
        | Item::Split { .. }
        | Item::Comp { .. } => true,
        Item::Regions { .. } | Item::Scatter { .. } | Item::PerimeterSplit { .. } => true,
        Item::Group(body) => group_makes_shapes(body),
        Item::Operation { .. }
        | Item::Set { .. }
        | Item::Modify { .. }
        | Item::Inline { .. }
        | Item::Boolean { .. } => false,
    }
}

fn group_makes_shapes(body: &Successor) -> bool {
    match body {
        Successor::Sequence(sequence) => sequence.items.iter().any(makes_shapes),
        Successor::Case { branches, otherwise } | Successor::Stochastic { branches, otherwise, .. } => {
            branches.iter().any(|(_, body)| group_makes_shapes(body)) || group_makes_shapes(otherwise)
        }
    }
}
