//! Constructs that mean something else today than when the file was written, by its `version` (reference 9). A file
//! without a version is not judged. Random numbers, which differ from every release, are told by the compatibility
//! report, not here.

use crate::cga::ast::{Ast, DeclarationKind, DefinitionKind, Expr, ExprKind, Item, ItemKind};
use crate::cga::ast_walk::{self, Visitor};
use crate::cga::codes;
use crate::cga::program::{Prefix, UnaryOperator};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::Span;

/// `2010.1` as (2010, 1).
pub type Release = (u32, u32);

/// What a release changed.
struct Change {
    since: Release,
    message: &'static str,
}

static SCALE: Change =
    Change { since: (2010, 1), message: "before 2010.1 a negative size moved the scope; now it mirrors the shape" };
static PIVOT: Change =
    Change { since: (2010, 2), message: "before 2010.2 this changed the pivot; now the pivot stays" };
static LAZY: Change = Change {
    since: (2013, 1),
    message: "before 2013.1 attributes were evaluated where they are used; now once, on the initial shape",
};
static BORDER: Change = Change {
    since: (2023, 0),
    message: "before 2023.0 the faces of a border were not connected; now neighbours share their edges",
};
static ROTATION: Change =
    Change { since: (2024, 0), message: "before 2024.0 a texture turned about its middle; now about its corner" };

/// Reads `"2014.1"`; a version without a dot is a whole year.
pub fn release(version: &str) -> Option<Release> {
    let (year, minor) = version.trim().split_once('.').unwrap_or((version.trim(), "0"));
    Some((year.parse().ok()?, minor.parse().ok()?))
}

/// One warning per change, where it first matters.
pub fn check(ast: &Ast, diagnostics: &mut Diagnostics) {
    let Some(written) = ast.version.as_ref().and_then(|v| release(&v.text)) else { return };
    let mut uses = Uses::default();
    ast_walk::file(ast, &mut uses);
    for declaration in &ast.declarations {
        if let DeclarationKind::Definition(d) = &declaration.kind
            && d.kind == DefinitionKind::Attr
        {
            let mut reads = Reads::default();
            ast_walk::expression(&d.value, &mut reads);
            reads.0.into_iter().for_each(|span| uses.found(&LAZY, span));
        }
    }
    for (change, span) in uses.0.into_iter().filter(|(change, _)| written < change.since) {
        diagnostics.push(Diagnostic::warning(codes::CHANGED_MEANING, span, change.message));
    }
}

#[derive(Default)]
struct Uses(Vec<(&'static Change, Span)>);

impl Uses {
    fn found(&mut self, change: &'static Change, span: Span) {
        if !self.0.iter().any(|(known, _)| std::ptr::eq(*known, change)) {
            self.0.push((change, span));
        }
    }
}

impl<'a> Visitor<'a> for Uses {
    fn item(&mut self, item: &'a Item) {
        let ItemKind::Plain { name, args, .. } = &item.kind else { return };
        let args = args.as_deref().unwrap_or_default();
        match &*name.text {
            "s" => {
                let negative = args.iter().find(|a| a.prefix != Prefix::Floating && is_negative(&a.value));
                negative.into_iter().for_each(|arg| self.found(&SCALE, arg.span));
            }
            "extrude" | "roofGable" | "roofHip" | "roofPyramid" | "roofShed" => self.found(&PIVOT, name.span),
            "offset" => self.found(&BORDER, name.span),
            "set" if args.first().is_some_and(|a| turns_texture(&a.value)) => self.found(&ROTATION, name.span),
            _ => {}
        }
    }
}

/// Properties of the shape that an attribute's default reads.
#[derive(Default)]
struct Reads(Vec<Span>);

impl<'a> Visitor<'a> for Reads {
    fn expression(&mut self, expression: &'a Expr) {
        if let ExprKind::Call { name, .. } = &expression.kind
            && ["geometry.", "scope.", "split.", "comp."].iter().any(|p| name.text.starts_with(p))
        {
            self.0.push(name.span);
        }
    }
}

fn is_negative(expr: &Expr) -> bool {
    matches!(&expr.kind, ExprKind::Unary(UnaryOperator::Minus, inner) if matches!(inner.kind, ExprKind::Number(_)))
}

fn turns_texture(expr: &Expr) -> bool {
    matches!(&expr.kind, ExprKind::Call { name, .. } if name.text.starts_with("material.") && name.text.ends_with(".rw"))
}
