//! In: an import statement and its instance. Out: the instance's attributes and rules connected to the importing
//! file: propagated, protected, overridden or continued (reference 1.12).

use std::collections::BTreeSet;
use std::sync::Arc;

use super::instance::{AttributeEntry, Default, RuleEntry, Tables, Value};
use super::names::Meaning;
use crate::cga::ast::{self, Expr, ExprKind, Import, Override, Text};
use crate::cga::codes;
use crate::cga::program::{Annotations, AttributeId};
use crate::diagnostics::{Diagnostic, suggest};

impl<'a> Tables<'a> {
    /// Applies the overrides of an import, then lets like-named attributes of the importing file flow in.
    pub fn connect(&mut self, parent: usize, child: usize, import: &'a Import) {
        let mut settled: BTreeSet<Arc<str>> = BTreeSet::new();
        let overrides = import.overrides.as_deref().unwrap_or_default();
        // `()` protects every attribute.
        let sealed = import.overrides.as_ref().is_some_and(Vec::is_empty);
        for item in overrides {
            let name = match item {
                Override::Keep(name) | Override::Value(name, _) | Override::Rule { name, .. } => name,
            };
            if !settled.insert(name.text.clone()) {
                self.bad_override(name, format!("`{}` is overridden twice", name.text));
                continue;
            }
            match item {
                Override::Keep(name) => {
                    self.imported_attribute(child, name);
                }
                Override::Value(name, value) => {
                    if let Some(id) = self.imported_attribute(child, name) {
                        self.attributes[id.0 as usize].default = Default::Overridden { scope: parent, value };
                    }
                }
                Override::Rule { name, parameters, successor } => {
                    self.override_rule(parent, child, name, parameters, successor);
                }
            }
        }
        if !sealed {
            self.propagate(parent, child, import, &settled);
        }
    }

    pub fn bad_override(&mut self, name: &Text, message: String) {
        self.diagnostics.push(Diagnostic::error(codes::BAD_OVERRIDE, name.span, message));
    }

    /// The attribute of the imported file that an override names.
    pub fn imported_attribute(&mut self, child: usize, name: &Text) -> Option<AttributeId> {
        let found = self.values(child, &name.text).iter().find_map(|v| match v {
            Value::Attribute(id) if !self.attributes[id.0 as usize].is_const => Some(*id),
            _ => None,
        });
        if let Some(id) = found {
            self.note(name.span, Meaning::Value(self.attributes[id.0 as usize].span));
        } else {
            let message = format!("the imported file has no attribute `{}`", name.text);
            let names = self.instances[child].values.keys().map(|k| &**k);
            let help = suggest(&name.text, names).map(|near| format!("did you mean `{near}`?"));
            let diagnostic = Diagnostic::error(codes::BAD_OVERRIDE, name.span, message);
            self.diagnostics.push(Diagnostic { help, ..diagnostic });
        }
        found
    }

    pub fn override_rule(
        &mut self,
        parent: usize,
        child: usize,
        name: &'a Text,
        parameters: &'a [Text],
        successor: &'a ast::Successor,
    ) {
        let found =
            self.rules_named(child, &name.text).iter().copied().find(|id| self.rules[id.0 as usize].is_extension);
        let Some(id) = found else {
            let message = format!("the imported file has no extension rule `{}`", name.text);
            return self.bad_override(name, message);
        };
        let old = &self.rules[id.0 as usize];
        let original = old.clone();
        self.note(name.span, Meaning::Rule(original.span));
        self.link(name.span, original.span);
        if old.parameters.len() != parameters.len() {
            let message =
                format!("`{}` takes {} parameters, not {}", name.text, old.parameters.len(), parameters.len());
            return self.bad_override(name, message);
        }
        let entry = RuleEntry {
            name: old.name.clone(),
            scope: parent,
            parameters,
            locals: &[],
            successor,
            is_start: false,
            is_extension: true,
            span: name.span,
        };
        self.rules[id.0 as usize] = entry;
        // The importing file still reaches the rule that it replaced, by its full name (reference 1.12).
        let prefix = &self.instances[child].prefix[self.instances[parent].prefix.len()..];
        let dotted = format!("{prefix}{}", name.text).into();
        let original = self.push_rule(original);
        self.instances[parent].originals.insert(dotted, vec![original]);
    }

    /// Lets attributes of the importing file override imported ones of the same name.
    fn propagate(&mut self, parent: usize, child: usize, import: &Import, settled: &BTreeSet<Arc<str>>) {
        let names: Vec<Arc<str>> =
            self.instances[child].values.keys().filter(|k| !settled.contains(*k)).cloned().collect();
        for name in names {
            let attribute = |tables: &Self, instance: usize| {
                tables.instances[instance].values.get(&name)?.iter().find_map(|v| match v {
                    Value::Attribute(id) if !tables.attributes[id.0 as usize].is_const => Some(*id),
                    _ => None,
                })
            };
            let (Some(outer), Some(inner)) = (attribute(self, parent), attribute(self, child)) else { continue };
            self.link(self.attributes[outer.0 as usize].span, self.attributes[inner.0 as usize].span);
            let dotted = format!("{}.{name}", import.prefix.text);
            if mentions(&self.attributes[outer.0 as usize].definition.value, &dotted) {
                self.keep_own_default(inner);
            }
            self.attributes[inner.0 as usize].default = Default::Propagated(outer);
        }
    }

    /// `attr w = imp.w * 2`: inside `w`, `imp.w` means the imported file's own default.
    fn keep_own_default(&mut self, inner: AttributeId) {
        let entry = &self.attributes[inner.0 as usize];
        let own = AttributeEntry {
            name: format!("{} (own default)", entry.name).into(),
            scope: entry.scope,
            is_const: true,
            definition: entry.definition,
            default: entry.default,
            written: &[],
            annotations: Annotations { hidden: true, ..Annotations::default() },
            span: entry.span,
        };
        self.attributes.push(own);
        self.own_defaults.insert(inner, AttributeId(self.attributes.len() as u32 - 1));
    }

    /// `prefix.Rule --> ...` in the importing file replaces or adds a rule of the import.
    pub fn continue_import(&mut self, instance: usize, rule: &'a ast::Rule) {
        let Some((child, name)) = self.import_of(instance, &rule.name.text) else { return };
        let entry = RuleEntry {
            name: format!("{}{name}", self.instances[child].prefix).into(),
            scope: instance,
            parameters: &rule.parameters,
            locals: &rule.locals,
            successor: &rule.successor,
            is_start: false,
            is_extension: false,
            span: rule.name.span,
        };
        let same = self.rules_named(child, name).iter().copied();
        match same.into_iter().find(|id| self.rules[id.0 as usize].parameters.len() == rule.parameters.len()) {
            Some(id) if self.rules[id.0 as usize].scope == instance => self.duplicate(rule.name.span, &rule.name.text),
            Some(id) => {
                let replaced = self.rules[id.0 as usize].span;
                self.refer(instance, &rule.name, Meaning::Rule(replaced));
                self.link(rule.name.span, replaced);
                self.rules[id.0 as usize] = entry;
            }
            None => {
                let id = self.push_rule(entry);
                self.instances[child].rules.entry(name.into()).or_default().push(id);
            }
        }
    }
}

/// Whether an expression reads a name anywhere.
fn mentions(expr: &Expr, name: &str) -> bool {
    let inside = |e: &Expr| mentions(e, name);
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Bool(_) | ExprKind::String(_) => false,
        ExprKind::Call { name: called, args } => {
            &*called.text == name || args.iter().flatten().any(|a| inside(&a.value))
        }
        ExprKind::Array(rows) => rows.iter().flatten().any(inside),
        ExprKind::Range { from, step, to } => inside(from) || step.as_deref().is_some_and(inside) || inside(to),
        ExprKind::Comp { selectors, .. } => selectors.iter().any(|s| inside(&s.test) || inside(&s.body)),
        ExprKind::Unary(_, inner) => inside(inner),
        ExprKind::Binary(_, a, b) => inside(a) || inside(b),
        ExprKind::Index { array, row, column } => inside(array) || inside(row) || column.as_deref().is_some_and(inside),
        ExprKind::Case { branches, otherwise } | ExprKind::Stochastic { branches, otherwise } => {
            branches.iter().any(|(a, b)| inside(a) || inside(b)) || inside(otherwise)
        }
    }
}
