//! In: the tables of names. Out: the program, every body resolved.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::annotation_rules;
use super::instance::{Default, Tables, Value};
use super::lint;
use super::names::Meaning;
use super::order;
use super::types::Types;
use crate::cga::ast::{self, Text};
use crate::cga::codes;
use crate::cga::program::{self, AttributeId, Parameter, Program, RuleFile, RuleId, Type};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::Span;

/// Most rounds of type inference before mistakes are reported. Each round carries types one call further; most files
/// are settled after two.
const ROUNDS: usize = 6;

/// Resolves one body: the names in scope and what is learnt about them.
pub struct Body<'c, 'a> {
    pub tables: &'c Tables<'a>,
    pub types: &'c Types,
    /// Instance in which names are looked up.
    pub scope: usize,
    /// The attribute whose default this is.
    pub attribute: Option<AttributeId>,
    /// Name and type of each slot: parameters, then locals.
    pub slots: Vec<(Arc<str>, Option<Type>)>,
    /// Where they are declared.
    pub slot_spans: Vec<Span>,
    pub parameters: usize,
    pub draws: u32,
    /// Names are selectors first.
    pub in_selector: bool,
    /// Only types matter in this round: searches for the name that was meant are left out.
    pub quiet: bool,
    pub diagnostics: Diagnostics,
}

/// Makes the program. Where the text is `broken` already, only mistakes are looked for.
pub fn lower(mut tables: Tables<'_>, diagnostics: &mut Diagnostics, broken: bool) -> Option<Program> {
    let mut types = unknown_types(&tables);
    for _ in 0..ROUNDS {
        let found = infer(&bodies(&tables, &types, None));
        let settled = found == types;
        types = found;
        if settled {
            break;
        }
    }
    clashes(&mut tables, &types);
    diagnostics.extend(std::mem::take(&mut tables.diagnostics));
    annotation_rules::check_types(&tables, &types, diagnostics);
    let mut program = bodies(&tables, &types, Some(diagnostics));
    program.initial_order = order::initial_order(&program, diagnostics);
    program.import_attributes = import_attributes(&tables, &program.initial_order);
    if !broken && !diagnostics.has_errors() {
        lint::lint(&program, &tables, diagnostics);
    }
    (!broken && !diagnostics.has_errors()).then_some(program)
}

/// The attributes of each instance and of what it imports, in the order of evaluation.
fn import_attributes(tables: &Tables<'_>, order: &[AttributeId]) -> Vec<Vec<AttributeId>> {
    let mut below: Vec<BTreeSet<usize>> = Vec::new();
    // An import's instance is made after the importing one.
    for (id, instance) in tables.instances.iter().enumerate().rev() {
        let mut all = BTreeSet::from([id]);
        for child in instance.children.values() {
            all.extend(&below[tables.instances.len() - 1 - child]);
        }
        below.push(all);
    }
    below.reverse();
    let called: BTreeSet<usize> = tables.called_dynamically.clone();
    let list = |id: usize| {
        let inside = |a: &&AttributeId| below[id].contains(&tables.attributes[a.0 as usize].scope);
        order.iter().filter(inside).copied().collect()
    };
    (0..tables.instances.len()).map(|id| if called.contains(&id) { list(id) } else { Vec::new() }).collect()
}

fn unknown_types(tables: &Tables<'_>) -> Types {
    let arity = |d: &ast::Definition| d.parameters.as_ref().map_or(0, Vec::len);
    Types {
        rules: tables.rules.iter().map(|r| vec![None; r.parameters.len()]).collect(),
        functions: tables.functions.iter().map(|f| (vec![None; arity(f.definition)], None)).collect(),
        attributes: vec![None; tables.attributes.len()],
    }
}

/// The types a round has found.
fn infer(program: &Program) -> Types {
    let kinds = |parameters: &[Parameter]| parameters.iter().map(|p| p.kind).collect();
    Types {
        rules: program.rules.iter().map(|r| kinds(&r.parameters)).collect(),
        functions: program.functions.iter().map(|f| (kinds(&f.parameters), f.body.value)).collect(),
        attributes: program.attributes.iter().map(|a| a.kind).collect(),
    }
}

/// Definitions with as many parameters as another and no different types.
fn clashes(tables: &mut Tables<'_>, types: &Types) {
    let mut found: Vec<(Span, Arc<str>)> = Vec::new();
    for instance in &tables.instances {
        for (name, rules) in &instance.rules {
            let rules = rules.iter().map(|id| (&types.rules[id.0 as usize][..], tables.rules[id.0 as usize].span));
            found.extend(repeated(rules).into_iter().map(|span| (span, name.clone())));
        }
        for (name, values) in &instance.values {
            let functions = values.iter().filter_map(|value| match value {
                Value::Function(id) => Some(id.0 as usize),
                Value::Attribute(_) => None,
            });
            let functions = functions.map(|id| (&types.functions[id].0[..], tables.functions[id].definition.name.span));
            found.extend(repeated(functions).into_iter().map(|span| (span, name.clone())));
        }
    }
    for (span, name) in found {
        tables.duplicate(span, &name);
    }
}

/// The places of overloads that no types tell from an earlier one; those without parameters are compared elsewhere.
fn repeated<'t>(overloads: impl Iterator<Item = (&'t [Option<Type>], Span)>) -> Vec<Span> {
    let mut seen: BTreeSet<&[Option<Type>]> = BTreeSet::new();
    let mut out = Vec::new();
    for (types, span) in overloads.filter(|(types, _)| !types.is_empty()) {
        let alike = |other: &&&[Option<Type>]| {
            other.len() == types.len() && other.iter().zip(types).all(|(a, b)| a.zip(*b).is_none_or(|(a, b)| a == b))
        };
        if seen.contains(types) || seen.iter().find(alike).is_some() {
            out.push(span);
        }
        seen.insert(types);
    }
    out
}

/// Where mistakes go; nowhere in the rounds that only look for types.
type Reported<'d> = Option<&'d mut Diagnostics>;

/// One round over all bodies.
fn bodies(tables: &Tables<'_>, types: &Types, mut diagnostics: Option<&mut Diagnostics>) -> Program {
    let rules: Vec<program::Rule> =
        (0..tables.rules.len()).map(|id| rule(tables, types, id, &mut diagnostics)).collect();
    let functions = (0..tables.functions.len()).map(|id| function(tables, types, id, &mut diagnostics)).collect();
    let attributes = (0..tables.attributes.len()).map(|id| attribute(tables, types, id, &mut diagnostics)).collect();
    let start_rules = rules.iter().enumerate().filter(|(id, r)| r.is_start && tables.rules[*id].scope == 0);
    let start_rules = start_rules.map(|(id, _)| RuleId(id as u32)).collect();
    let files = tables.files.iter().map(|f| RuleFile { source: f.ast.source, folder: f.folder.clone() }).collect();
    let observes_tags = tables.observes_tags.get();
    Program {
        rules,
        functions,
        attributes,
        initial_order: Vec::new(),
        start_rules,
        import_attributes: Vec::new(),
        files,
        observes_tags,
        needs: tables.needs.get(),
    }
}

fn rule(tables: &Tables<'_>, types: &Types, id: usize, diagnostics: &mut Reported<'_>) -> program::Rule {
    let entry = &tables.rules[id];
    let mut body = Body::new(tables, types, entry.scope, diagnostics.is_none());
    body.parameters(entry.parameters, &types.rules[id]);
    let locals = body.locals(entry.locals);
    let successor = body.successor(entry.successor, true);
    let out = program::Rule {
        name: entry.name.clone(),
        path: format!("{}/{}", entry.name, entry.parameters.len()).into(),
        parameters: body.found_parameters(),
        locals,
        successor,
        draws: body.draws,
        is_start: entry.is_start,
        span: entry.span,
    };
    if let Some(diagnostics) = diagnostics {
        diagnostics.extend(body.diagnostics);
    }
    out
}

fn function(tables: &Tables<'_>, types: &Types, id: usize, diagnostics: &mut Reported<'_>) -> program::Function {
    let entry = &tables.functions[id];
    let parameters = entry.definition.parameters.as_deref().unwrap_or_default();
    let mut body = Body::new(tables, types, entry.scope, diagnostics.is_none());
    body.parameters(parameters, &types.functions[id].0);
    let locals = body.locals(&entry.definition.locals);
    let value = body.expression(&entry.definition.value);
    let out = program::Function {
        name: entry.name.clone(),
        path: format!("{}/{}", entry.name, parameters.len()).into(),
        parameters: body.found_parameters(),
        locals,
        body: value,
        draws: body.draws,
        span: entry.definition.name.span,
    };
    if let Some(diagnostics) = diagnostics {
        diagnostics.extend(body.diagnostics);
    }
    out
}

fn attribute(tables: &Tables<'_>, types: &Types, id: usize, diagnostics: &mut Reported<'_>) -> program::Attribute {
    let entry = &tables.attributes[id];
    let mut locals = Vec::new();
    let mut is_map = false;
    let scope = match entry.default {
        Default::Overridden { scope, .. } => scope,
        Default::Written(_) | Default::Propagated(_) => entry.scope,
    };
    let mut body = Body::new(tables, types, scope, diagnostics.is_none());
    body.attribute = Some(AttributeId(id as u32));
    let default = match entry.default {
        Default::Written(definition) => {
            body.map_attribute(definition);
            is_map = definition.parameters.as_ref().is_some_and(|p| p.len() == 1);
            body.parameters(definition.parameters.as_deref().unwrap_or_default(), &[Some(Type::Float)]);
            locals = body.locals(&definition.locals);
            body.expression(&definition.value)
        }
        Default::Overridden { value, .. } => body.expression(value),
        Default::Propagated(outer) => {
            let value = types.attributes[outer.0 as usize];
            program::Expr { kind: program::ExprKind::Attribute(outer), value, span: entry.span }
        }
    };
    let out = program::Attribute {
        name: entry.name.clone(),
        kind: if is_map { Some(Type::Floats) } else { default.value },
        is_const: entry.is_const,
        is_map,
        locals,
        default,
        draws: body.draws,
        annotations: entry.annotations.clone(),
        span: entry.span,
    };
    if let Some(diagnostics) = diagnostics {
        diagnostics.extend(body.diagnostics);
    }
    out
}

impl<'c, 'a> Body<'c, 'a> {
    fn new(tables: &'c Tables<'a>, types: &'c Types, scope: usize, quiet: bool) -> Self {
        Body {
            tables,
            types,
            scope,
            attribute: None,
            slots: Vec::new(),
            slot_spans: Vec::new(),
            parameters: 0,
            draws: 0,
            in_selector: false,
            quiet,
            diagnostics: Diagnostics::default(),
        }
    }

    pub fn error(&mut self, code: &'static str, span: Span, message: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(code, span, message));
    }

    /// Takes down what a name means, in the round that reports.
    pub fn refer(&self, scope: usize, name: &Text, meaning: Meaning) {
        if !self.quiet {
            self.tables.refer(scope, name, meaning);
        }
    }

    /// As [`Body::refer`], of a name of the language.
    pub fn note(&self, span: Span, meaning: Meaning) {
        if !self.quiet {
            self.tables.note(span, meaning);
        }
    }

    fn parameters(&mut self, names: &[Text], known: &[Option<Type>]) {
        for (i, name) in names.iter().enumerate() {
            self.slot(name, known.get(i).copied().flatten());
        }
        self.parameters = names.len();
    }

    fn locals(&mut self, locals: &[(Text, ast::Expr)]) -> Vec<program::Expr> {
        let mut out = Vec::new();
        for (name, value) in locals {
            let value = self.expression(value);
            self.slot(name, value.value);
            out.push(value);
        }
        out
    }

    fn slot(&mut self, name: &Text, kind: Option<Type>) {
        if self.slots.iter().any(|(other, _)| *other == name.text) {
            self.error(
                codes::DUPLICATE_PARAMETER,
                name.span,
                format!("two parameters or locals are named `{}`", name.text),
            );
        }
        self.slots.push((name.text.clone(), kind));
        self.slot_spans.push(name.span);
    }

    fn found_parameters(&self) -> Vec<Parameter> {
        let parameter = |(name, kind): &(Arc<str>, Option<Type>)| Parameter { name: name.clone(), kind: *kind };
        self.slots[..self.parameters].iter().map(parameter).collect()
    }

    /// `attr streetWidth(edge) = 0` is the only attribute with a parameter (reference 2.6).
    fn map_attribute(&mut self, definition: &ast::Definition) {
        let Some(parameters) = &definition.parameters else { return };
        let span = definition.name.span;
        match (&*definition.name.text, parameters.len()) {
            ("streetWidth", 1) => {
                self.tables.needs.set(program::Needs { edges: true, ..self.tables.needs.get() });
            }
            (_, 0) => {}
            (name, _) => {
                let message =
                    format!("`{name}` cannot have parameters; leave out `attr` or `const` to make it a function");
                self.error(codes::MISPLACED_DECLARATION, span, message);
            }
        }
    }
}
