//! In: a program. Out: the order in which its attributes must be evaluated.

use super::graph::{components, is_ring};
use super::walk::expressions;
use crate::cga::codes;
use crate::cga::program::{AttributeId, Expr, ExprKind, Program};
use crate::diagnostics::{Diagnostic, Diagnostics};

/// Sorts the attributes so that each stands behind those its default reads, directly or through functions;
/// a ring of attributes is an error. Functions may call each other in a ring.
pub fn initial_order(program: &Program, diagnostics: &mut Diagnostics) -> Vec<AttributeId> {
    let attributes = program.attributes.len();
    let read = |exprs: &mut dyn Iterator<Item = &Expr>| {
        let mut out = Vec::new();
        for expr in exprs {
            expressions(expr, &mut |e| match &e.kind {
                ExprKind::Attribute(id) => out.push(id.0 as usize),
                ExprKind::Call { function, .. } => out.push(attributes + function.0 as usize),
                _ => {}
            });
        }
        out
    };
    let of_attributes = program.attributes.iter().map(|a| read(&mut a.locals.iter().chain([&a.default])));
    let of_functions = program.functions.iter().map(|f| read(&mut f.locals.iter().chain([&f.body])));
    let edges: Vec<Vec<usize>> = of_attributes.chain(of_functions).collect();
    let mut order = Vec::with_capacity(attributes);
    for component in components(&edges) {
        let first = component.iter().find(|node| **node < attributes);
        if let Some(&first) = first.filter(|_| is_ring(&component, &edges)) {
            let entry = &program.attributes[first];
            let message = format!("the value of `{}` depends on itself", entry.name);
            diagnostics.push(Diagnostic::error(codes::ATTRIBUTE_CYCLE, entry.span, message));
        }
        order.extend(component.iter().filter(|node| **node < attributes).map(|node| AttributeId(*node as u32)));
    }
    order
}
