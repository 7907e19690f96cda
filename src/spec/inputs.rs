//! In: `input` declarations and the command line's `--set name=value`. Out: blocks without `$name`.
//!
//! A value of the command line becomes a text of its own in the source map, so that messages can point into it.

use super::ast::{CallArgument, Expr, ExprKind, InputDecl, Property};
use super::parse::parse_values;
use super::read::Recipe;
use super::render_spec::Origin;
use crate::diagnostics::{Diagnostic, Diagnostics, suggest};
use crate::source::{SourceMap, Span};

/// What becomes of inputs that have neither a value nor a default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unbound {
    Error,
    /// `$name` stays in the blocks; the checker takes it for any value.
    Allowed,
}

/// Kinds of input: one path, several paths with commas between them, one text, values as the recipe writes them.
const KINDS: [&str; 4] = ["file", "files", "text", "value"];

/// The values of one input; empty where it is unbound.
struct Binding {
    name: String,
    values: Vec<Expr>,
}

/// Puts values in the place of `$name` everywhere.
pub(super) fn bind(
    recipe: &mut Recipe,
    arguments: &[(String, String)],
    unbound: Unbound,
    sources: &mut SourceMap,
    diagnostics: &mut Diagnostics,
) {
    let mut bindings: Vec<Binding> = Vec::new();
    for input in &recipe.inputs {
        if bindings.iter().any(|binding| binding.name == input.name.text) {
            let message = format!("there are two inputs `{}`", input.name.text);
            diagnostics.push(Diagnostic::error("spec::repeated-name", input.name.span, message));
            continue;
        }
        check_declaration(input, diagnostics);
        let given = arguments.iter().rev().find(|(name, _)| *name == input.name.text);
        let mut readable = true;
        let values = match given {
            Some((name, value)) => {
                let file = sources.add(format!("--set {name}"), value.as_str());
                recipe.folders.add(file.id, Origin::CommandLine);
                let (values, found) = match input.kind.text.as_str() {
                    "file" | "text" => (vec![raw(&file, 0, value.len())], Diagnostics::default()),
                    "files" => (paths(&file), Diagnostics::default()),
                    _ => parse_values(&file),
                };
                readable = !found.has_errors();
                diagnostics.extend(found);
                values
            }
            None => input.default.clone(),
        };
        if values.is_empty() && readable && unbound == Unbound::Error {
            let message = format!("the input `{}` needs a value", input.name.text);
            let help = format!("give it on the command line: `--set {}=…`", input.name.text);
            diagnostics.push(Diagnostic::error("spec::missing-input", input.name.span, message).help(help));
        }
        bindings.push(Binding { name: input.name.text.clone(), values });
    }
    for (name, value) in arguments {
        if !bindings.iter().any(|binding| binding.name == *name) {
            let file = sources.add(format!("--set {name}"), value.as_str());
            let whole = Span::new(file.id, 0, value.len());
            diagnostics.push(unknown(name, whole, &bindings));
        }
    }
    let mut expander = Expander { bindings: &bindings, diagnostics };
    for property in recipe.blocks.iter_mut().flat_map(|block| &mut block.properties) {
        expander.property(property);
    }
}

fn check_declaration(input: &InputDecl, diagnostics: &mut Diagnostics) {
    let kind = input.kind.text.as_str();
    if !KINDS.contains(&kind) {
        let message = format!("there is no kind of input `{kind}`");
        let help = "the kinds are `file`, `files`, `text` and `value`";
        diagnostics.push(Diagnostic::error("spec::unknown-input-kind", input.kind.span, message).help(help));
    }
    for value in &input.default {
        if kind != "value" && KINDS.contains(&kind) && !matches!(value.kind, ExprKind::Text(_)) {
            let message = format!("the default of a `{kind}` input is written in quotes");
            diagnostics.push(Diagnostic::error("spec::wrong-value", value.span, message));
        }
        if matches!(value.kind, ExprKind::Argument(_)) {
            let message = "the default of an input cannot be another input";
            diagnostics.push(Diagnostic::error("spec::wrong-value", value.span, message));
        }
    }
}

fn raw(file: &crate::source::SourceFile, start: usize, end: usize) -> Expr {
    Expr { kind: ExprKind::Text(file.text[start..end].to_owned()), span: Span::new(file.id, start, end) }
}

/// The paths between commas, without spaces around them.
fn paths(file: &crate::source::SourceFile) -> Vec<Expr> {
    let mut found = Vec::new();
    let mut start = 0;
    for piece in file.text.split(',') {
        let lead = piece.len() - piece.trim_start().len();
        if !piece.trim().is_empty() {
            found.push(raw(file, start + lead, start + lead + piece.trim().len()));
        }
        start += piece.len() + 1;
    }
    found
}

fn unknown(name: &str, span: Span, bindings: &[Binding]) -> Diagnostic {
    let diagnostic = Diagnostic::error("spec::unknown-input", span, format!("the recipe has no input `{name}`"));
    match suggest(name, bindings.iter().map(|binding| binding.name.as_str())) {
        Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
        None => diagnostic.help(format!("declare it with `input {name} : value`")),
    }
}

struct Expander<'a> {
    bindings: &'a [Binding],
    diagnostics: &'a mut Diagnostics,
}

impl Expander<'_> {
    fn property(&mut self, property: &mut Property) {
        self.list(&mut property.values);
        for clause in &mut property.clauses {
            self.list(&mut clause.values);
        }
        for assignment in property.body.iter_mut().flatten() {
            self.single(&mut assignment.value);
        }
    }

    /// An input among several values may stand for several.
    fn list(&mut self, values: &mut Vec<Expr>) {
        let mut out = Vec::with_capacity(values.len());
        for mut value in values.drain(..) {
            if matches!(value.kind, ExprKind::Argument(_)) {
                match self.values_of(&value) {
                    Some(bound) => out.extend(bound),
                    None => out.push(value),
                }
            } else {
                self.inside(&mut value);
                out.push(value);
            }
        }
        *values = out;
    }

    fn single(&mut self, value: &mut Expr) {
        if !matches!(value.kind, ExprKind::Argument(_)) {
            return self.inside(value);
        }
        let Some(mut bound) = self.values_of(value) else { return };
        if bound.len() == 1 {
            *value = bound.remove(0);
        } else {
            let message = format!("`{value}` stands for {} values where one is due", bound.len());
            self.diagnostics.push(Diagnostic::error("spec::wrong-value", value.span, message));
        }
    }

    fn inside(&mut self, value: &mut Expr) {
        match &mut value.kind {
            ExprKind::Call { arguments, .. } => self.arguments(arguments),
            ExprKind::List(values) | ExprKind::Group(values) => self.list(values),
            ExprKind::Or(values) | ExprKind::And(values) => values.iter_mut().for_each(|value| self.single(value)),
            ExprKind::By(a, b) | ExprKind::Times(a, b) => {
                self.single(a);
                self.single(b);
            }
            ExprKind::Not(value) => self.single(value),
            ExprKind::Quantity { .. }
            | ExprKind::Text(_)
            | ExprKind::Date(_)
            | ExprKind::Clock(_)
            | ExprKind::Word(_)
            | ExprKind::Argument(_)
            | ExprKind::Object { .. }
            | ExprKind::Filter { .. } => {}
        }
    }

    fn arguments(&mut self, arguments: &mut [CallArgument]) {
        for argument in arguments {
            self.single(&mut argument.value);
        }
    }

    /// The values of `$name`; `None` where it is unknown (reported) or unbound.
    fn values_of(&mut self, value: &Expr) -> Option<Vec<Expr>> {
        let ExprKind::Argument(name) = &value.kind else { return None };
        let Some(binding) = self.bindings.iter().find(|binding| binding.name == *name) else {
            self.diagnostics.push(unknown(name, value.span, self.bindings));
            return None;
        };
        (!binding.values.is_empty()).then(|| binding.values.clone())
    }
}
