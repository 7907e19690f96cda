//! In: a program. Out: the order in which its attributes must be evaluated.

use crate::cga::codes;
use crate::cga::program::{Arg, AttributeId, Expr, ExprKind, Program};
use crate::diagnostics::{Diagnostic, Diagnostics};

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    New,
    Open,
    Done,
}

/// An attribute or a function, by index.
#[derive(Clone, Copy)]
enum Node {
    Attribute(usize),
    Function(usize),
}

struct Search<'p> {
    program: &'p Program,
    attributes: Vec<Mark>,
    functions: Vec<Mark>,
    order: Vec<AttributeId>,
}

/// Sorts the attributes so that each stands behind those its default reads, directly or through functions;
/// a ring of attributes is an error. Functions may call each other in a ring.
pub fn initial_order(program: &Program, diagnostics: &mut Diagnostics) -> Vec<AttributeId> {
    let mut search = Search {
        program,
        attributes: vec![Mark::New; program.attributes.len()],
        functions: vec![Mark::New; program.functions.len()],
        order: Vec::new(),
    };
    for attribute in 0..program.attributes.len() {
        search.visit(attribute, diagnostics);
    }
    search.order
}

impl Search<'_> {
    /// Depth first with a stack of its own, because chains of attributes can be long.
    fn visit(&mut self, attribute: usize, diagnostics: &mut Diagnostics) {
        if self.attributes[attribute] != Mark::New {
            return;
        }
        let mut stack = vec![(Node::Attribute(attribute), self.open(Node::Attribute(attribute)))];
        while let Some((node, pending)) = stack.last_mut() {
            let node = *node;
            let Some(next) = pending.pop() else {
                self.close(node);
                stack.pop();
                continue;
            };
            match next {
                Node::Attribute(a) if self.attributes[a] == Mark::Open => {
                    let entry = &self.program.attributes[a];
                    let message = format!("the value of `{}` depends on itself", entry.name);
                    diagnostics.push(Diagnostic::error(codes::ATTRIBUTE_CYCLE, entry.span, message));
                }
                Node::Attribute(a) if self.attributes[a] == Mark::New => {
                    let pending = self.open(next);
                    stack.push((next, pending));
                }
                Node::Function(f) if self.functions[f] == Mark::New => {
                    let pending = self.open(next);
                    stack.push((next, pending));
                }
                Node::Attribute(_) | Node::Function(_) => {}
            }
        }
        // A function met again on the way to another attribute must be searched again: it may be part of a ring.
        self.functions.iter_mut().for_each(|mark| *mark = Mark::New);
    }

    fn open(&mut self, node: Node) -> Vec<Node> {
        let mut out = Vec::new();
        match node {
            Node::Attribute(a) => {
                self.attributes[a] = Mark::Open;
                let entry = &self.program.attributes[a];
                entry.locals.iter().chain([&entry.default]).for_each(|e| reads(e, &mut out));
            }
            Node::Function(f) => {
                self.functions[f] = Mark::Open;
                let entry = &self.program.functions[f];
                entry.locals.iter().chain([&entry.body]).for_each(|e| reads(e, &mut out));
            }
        }
        out.reverse();
        out
    }

    fn close(&mut self, node: Node) {
        match node {
            Node::Attribute(a) => {
                self.attributes[a] = Mark::Done;
                self.order.push(AttributeId(a as u32));
            }
            Node::Function(f) => self.functions[f] = Mark::Done,
        }
    }
}

/// The attributes and functions an expression reads, in the order of the text.
fn reads(expr: &Expr, out: &mut Vec<Node>) {
    let mut all = |exprs: &[&Expr]| exprs.iter().for_each(|e| reads(e, out));
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Bool(_) | ExprKind::String(_) | ExprKind::Slot(_) => {}
        ExprKind::BuiltinAttribute(_) | ExprKind::Selector(_) => {}
        ExprKind::Attribute(id) => out.push(Node::Attribute(id.0 as usize)),
        ExprKind::Call { function, args } => {
            out.push(Node::Function(function.0 as usize));
            args.iter().for_each(|e| reads(e, out));
        }
        ExprKind::Builtin { args, .. } => {
            for arg in args {
                match arg {
                    Arg::Value(_, e) | Arg::ComputedWord(e) => reads(e, out),
                    Arg::Word(..) => {}
                }
            }
        }
        ExprKind::Array(rows) => rows.iter().flatten().for_each(|e| reads(e, out)),
        ExprKind::Range { from, step, to } => {
            all(&[from, to]);
            step.iter().for_each(|e| reads(e, out));
        }
        ExprKind::Unary(_, a) => reads(a, out),
        ExprKind::Binary(_, a, b) => all(&[a, b]),
        ExprKind::Index { array, row, column } => {
            all(&[array, row]);
            column.iter().for_each(|e| reads(e, out));
        }
        ExprKind::Case { branches, otherwise } | ExprKind::Stochastic { branches, otherwise, .. } => {
            branches.iter().for_each(|(a, b)| [a, b].into_iter().for_each(|e| reads(e, out)));
            reads(otherwise, out);
        }
        ExprKind::Comp { selectors, .. } => {
            selectors.iter().for_each(|s| [&s.test, &s.value].into_iter().for_each(|e| reads(e, out)));
        }
    }
}
