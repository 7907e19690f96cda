//! Dynamic import calls, `import( a = expr, Ext --> ops ).Rule(args)` (reference 1.12).
//!
//! In: the calls in all rule bodies. Out: for each call that brings rules of its own, an instance whose rules see
//! them; attributes stay those of the import, because every shape carries its own values.

use std::sync::Arc;

use super::callable::own_forms;
use super::instance::{Instance, MAX_INSTANCES, Tables};
use super::lower::Body;
use super::names::Meaning;
use crate::cga::ast::{self, Argument, ItemKind, Override, Text};
use crate::cga::ast_walk::{self, Visitor};
use crate::cga::codes;
use crate::cga::program::{AttributeId, Expr, Item, RuleId};
use crate::diagnostics::{Diagnostic, suggest};
use crate::source::Span;

impl<'a> Tables<'a> {
    /// Makes the instances for calls that replace rules. Rules made here can hold such calls themselves.
    pub fn dynamic_instances(&mut self) {
        let mut next = 0;
        while let Some(rule) = self.rules.get(next) {
            let (scope, successor) = (rule.scope, rule.successor);
            let mut calls = Calls::default();
            ast_walk::successor(successor, &mut calls);
            for call in calls.0 {
                self.dynamic_instance(scope, call);
            }
            next += 1;
        }
    }

    fn dynamic_instance(&mut self, scope: usize, call: &'a ast::Item) {
        let ItemKind::Dynamic { prefix, overrides, .. } = &call.kind else { return };
        let Some(child) = self.import_named(scope, &prefix.text) else { return };
        self.called_dynamically.insert(child);
        let rules = overrides.iter().any(|o| matches!(o, Override::Rule { .. }));
        if !rules || self.dynamic.contains_key(&(scope, call.span)) {
            return;
        }
        if self.instances.len() >= MAX_INSTANCES {
            let message = format!("more than {MAX_INSTANCES} imports, counting dynamic import calls");
            self.diagnostics.push(Diagnostic::error(codes::TOO_MANY_IMPORTS, prefix.span, message));
            return;
        }
        let copy = self.copy_rules(child);
        self.dynamic.insert((scope, call.span), copy);
        let originals = self.instances[scope].originals.clone();
        for item in overrides {
            if let Override::Rule { name, parameters, successor } = item {
                self.override_rule(scope, copy, name, parameters, successor);
            }
        }
        self.instances[scope].originals = originals;
    }

    /// An instance with the same attributes and functions, and its own copy of every rule.
    fn copy_rules(&mut self, of: usize) -> usize {
        let copy = self.instances.len();
        let Instance { prefix, children, values, rules, starts, originals } = &self.instances[of];
        let mut instance = Instance {
            prefix: prefix.clone(),
            children: children.clone(),
            values: values.clone(),
            originals: originals.clone(),
            ..Instance::default()
        };
        let (rules, starts) = (rules.clone(), starts.clone());
        for (name, ids) in rules {
            for id in ids {
                let mut entry = self.rules[id.0 as usize].clone();
                entry.scope = if entry.scope == of { copy } else { entry.scope };
                let new = self.push_rule(entry);
                instance.rules.entry(Arc::clone(&name)).or_default().push(new);
                if starts.contains(&id) {
                    instance.starts.push(new);
                }
            }
        }
        self.instances.push(instance);
        copy
    }

    /// The instance that a whole dotted name means.
    pub fn import_named(&self, scope: usize, name: &str) -> Option<usize> {
        name.split('.').try_fold(scope, |at, part| self.instances[at].children.get(part).copied())
    }
}

impl Body<'_, '_> {
    pub fn dynamic_call(
        &mut self,
        prefix: &Text,
        overrides: &[Override],
        name: &Text,
        args: &[Argument],
        span: Span,
    ) -> Item {
        let Some(child) = self.tables.import_named(self.scope, &prefix.text) else {
            let message = format!("there is no import `{}`", prefix.text);
            let near = suggest(&prefix.text, self.tables.instances[self.scope].children.keys().map(|k| &**k));
            let help = near.map(|near| format!("did you mean `{near}`?"));
            let error = Diagnostic::error(codes::UNKNOWN_NAME, prefix.span, message);
            self.diagnostics.push(Diagnostic { help, ..error });
            return Item::Discard;
        };
        self.refer_import(prefix);
        let overrides = self.dynamic_values(child, overrides);
        let args: Vec<Expr> = args.iter().map(|arg| self.plain_argument(arg)).collect();
        let scope = self.tables.dynamic.get(&(self.scope, span)).copied().unwrap_or(child);
        match self.dynamic_rule(scope, name, &args) {
            Some(rule) => Item::Instantiate { import: child as u32, overrides, rule, args, span },
            None => Item::Discard,
        }
    }

    /// Takes down the imports that a prefix names, one after the other.
    fn refer_import(&self, prefix: &Text) {
        let (outer, last) = match prefix.text.rsplit_once('.') {
            Some((head, last)) => (self.tables.import_named(self.scope, head), last),
            None => (Some(self.scope), &*prefix.text),
        };
        if let Some(meaning) = outer.and_then(|outer| self.tables.import_meaning(outer, last)) {
            self.refer(self.scope, prefix, meaning);
        }
    }

    /// The attributes that get values, and those values, in the caller's terms.
    fn dynamic_values(&mut self, child: usize, overrides: &[Override]) -> Vec<(AttributeId, Expr)> {
        let mut out: Vec<(AttributeId, Expr)> = Vec::new();
        for item in overrides {
            let Override::Value(name, value) = item else {
                if let Override::Keep(name) = item {
                    let message = "a dynamic import call gives values or rules; a bare name has no meaning";
                    self.error(codes::BAD_OVERRIDE, name.span, message);
                }
                continue;
            };
            let value = self.expression(value);
            let found = self.tables.attribute_named(child, &name.text);
            let Some(id) = found.filter(|id| !self.tables.attributes[id.0 as usize].is_const) else {
                let message = format!("the imported file has no attribute `{}`", name.text);
                self.error(codes::BAD_OVERRIDE, name.span, message);
                continue;
            };
            self.note(name.span, Meaning::Value(self.tables.attributes[id.0 as usize].span));
            if out.iter().any(|(other, _)| *other == id) {
                self.error(codes::BAD_OVERRIDE, name.span, format!("`{}` is overridden twice", name.text));
            }
            if let Some(kind) = self.types.attributes[id.0 as usize] {
                self.require(&value, kind);
            }
            out.push((id, value));
        }
        out
    }

    fn dynamic_rule(&mut self, scope: usize, name: &Text, args: &[Expr]) -> Option<RuleId> {
        let rules = self.tables.rules_named(scope, &name.text);
        let parameters = |id: &RuleId| self.tables.rules[id.0 as usize].parameters;
        if rules.is_empty() {
            let message = format!("the imported file has no rule `{}`", name.text);
            let near = suggest(&name.text, self.tables.instances[scope].rules.keys().map(|k| &**k));
            let help = near.map(|near| format!("did you mean `{near}`?"));
            let error = Diagnostic::error(codes::UNKNOWN_OPERATION, name.span, message);
            self.diagnostics.push(Diagnostic { help, ..error });
            return None;
        }
        let fitting: Vec<RuleId> = rules.iter().copied().filter(|id| parameters(id).len() == args.len()).collect();
        let Some(&first) = fitting.first() else {
            let counts: Vec<usize> = rules.iter().map(|id| parameters(id).len()).collect();
            let forms = || own_forms(&name.text, rules.iter().map(parameters));
            self.argument_count(&name.text, &counts, args.len(), name.span, forms);
            return None;
        };
        let types = self.types;
        let chosen = fitting.into_iter().find(|id| super::callable::fits(&types.rules[id.0 as usize], args));
        let rule = chosen.unwrap_or(first);
        self.refer(scope, name, Meaning::Rule(self.tables.rules[rule.0 as usize].span));
        self.check_arguments(&types.rules[rule.0 as usize], args);
        Some(rule)
    }
}

/// The dynamic import calls in a rule and in the rules they bring.
#[derive(Default)]
struct Calls<'a>(Vec<&'a ast::Item>);

impl<'a> Visitor<'a> for Calls<'a> {
    fn item(&mut self, item: &'a ast::Item) {
        if matches!(item.kind, ItemKind::Dynamic { .. }) {
            self.0.push(item);
        }
    }
}
