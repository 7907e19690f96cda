//! In: parsed files. Out: the tables of names: every rule, function and attribute of every import under its id.
//!
//! An *instance* is one import of one file: it has its own rules and attributes, named with its prefix.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::annotations::Grouping;
use super::load::LoadedFile;
use crate::cga::ast::{self, Declaration, DeclarationKind, Definition, DefinitionKind, Modifier, Text};
use crate::cga::codes;
use crate::cga::program::{Annotations, AttributeId, FunctionId, RuleId};
use crate::diagnostics::{Diagnostic, Diagnostics, suggest};
use crate::source::Span;

/// Most imports in the whole tree; a ladder of files that each import the next one twice doubles per step.
const MAX_INSTANCES: usize = 1000;

/// What a name in an expression leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    Attribute(AttributeId),
    Function(FunctionId),
}

#[derive(Default)]
pub struct Instance {
    /// Empty for the main file, else with a dot at its end, such as `lib.`.
    pub prefix: String,
    pub children: BTreeMap<Arc<str>, usize>,
    pub values: BTreeMap<Arc<str>, Vec<Value>>,
    pub rules: BTreeMap<Arc<str>, Vec<RuleId>>,
    /// Rules declared with `start`, callable by that name.
    pub starts: Vec<RuleId>,
}

pub struct RuleEntry<'a> {
    pub name: Arc<str>,
    /// Instance in which the body's names are looked up.
    pub scope: usize,
    pub parameters: &'a [Text],
    pub locals: &'a [(Text, ast::Expr)],
    pub successor: &'a ast::Successor,
    pub is_start: bool,
    pub is_extension: bool,
    pub span: Span,
}

pub struct FunctionEntry<'a> {
    pub name: Arc<str>,
    pub scope: usize,
    pub definition: &'a Definition,
}

/// Where an attribute's value comes from.
#[derive(Clone, Copy)]
pub enum Default<'a> {
    Written(&'a Definition),
    /// `import x : "..." (a = expr)`, resolved in the importing instance.
    Overridden {
        scope: usize,
        value: &'a ast::Expr,
    },
    /// The importing file's attribute of the same name.
    Propagated(AttributeId),
}

pub struct AttributeEntry<'a> {
    pub name: Arc<str>,
    pub scope: usize,
    pub is_const: bool,
    pub definition: &'a Definition,
    pub default: Default<'a>,
    pub annotations: Annotations,
    pub span: Span,
}

/// All tables of one compilation.
pub struct Tables<'a> {
    pub files: &'a [LoadedFile],
    pub instances: Vec<Instance>,
    pub rules: Vec<RuleEntry<'a>>,
    pub functions: Vec<FunctionEntry<'a>>,
    pub attributes: Vec<AttributeEntry<'a>>,
    /// For attributes that the importing attribute itself reads: the imported file's own default.
    pub own_defaults: BTreeMap<AttributeId, AttributeId>,
    pub diagnostics: Diagnostics,
    /// See [`crate::cga::program::Program::observes_tags`]; set while bodies are resolved.
    pub observes_tags: Cell<bool>,
}

/// One definition that is in force, and the style it came from (0 is the default style).
struct InForce<'a> {
    style: usize,
    declaration: &'a Declaration,
    annotations: Annotations,
}

impl<'a> Tables<'a> {
    pub fn new(files: &'a [LoadedFile]) -> Self {
        Tables {
            files,
            instances: Vec::new(),
            rules: Vec::new(),
            functions: Vec::new(),
            attributes: Vec::new(),
            own_defaults: BTreeMap::new(),
            diagnostics: Diagnostics::default(),
            observes_tags: Cell::new(false),
        }
    }

    pub fn instantiate_main(&mut self, style: Option<&str>) {
        if !self.files.is_empty() {
            self.instantiate(0, String::new(), style, false);
        }
    }

    fn instantiate(&mut self, file: usize, prefix: String, style: Option<&str>, hidden: bool) -> usize {
        let id = self.instances.len();
        self.instances.push(Instance { prefix, ..Instance::default() });
        let chain = self.style_chain(file, style);
        let in_force = self.in_force(file, &chain);
        for definition in &in_force {
            self.declare(id, definition, hidden);
        }
        self.imports(id, file, hidden);
        for definition in in_force {
            if let DeclarationKind::Rule(rule) = &definition.declaration.kind {
                self.continue_import(id, rule);
            }
        }
        id
    }

    /// The styles whose definitions hold, from the default style (0) to the chosen one; styles count from 1.
    fn style_chain(&mut self, file: usize, style: Option<&str>) -> Vec<usize> {
        let ast = &self.files[file].ast;
        let styles: Vec<&ast::Style> = ast
            .declarations
            .iter()
            .filter_map(|d| match &d.kind {
                DeclarationKind::Style(style) => Some(style),
                _ => None,
            })
            .collect();
        let names = || styles.iter().map(|s| &*s.name.text);
        let find = |name: &str| styles.iter().position(|s| &*s.name.text == name);
        let unknown = |span: Span, name: &str| {
            let diagnostic = Diagnostic::error(codes::UNKNOWN_STYLE, span, format!("there is no style `{name}`"));
            match suggest(name, names()) {
                Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
                None => diagnostic,
            }
        };
        for style in &styles {
            if let Some(base) = style.base.as_ref().filter(|b| &*b.text != "Default" && find(&b.text).is_none()) {
                self.diagnostics.push(unknown(base.span, &base.text));
            }
        }
        let Some(name) = style.filter(|name| *name != "Default") else { return vec![0] };
        let Some(mut at) = find(name) else {
            self.diagnostics.push(unknown(Span::new(ast.source, 0, 0), name));
            return vec![0];
        };
        let mut chain = vec![at + 1];
        while let Some(base) = styles[at].base.as_ref().and_then(|b| find(&b.text)) {
            if chain.contains(&(base + 1)) {
                let message = format!("style `{}` extends itself", styles[at].name.text);
                self.diagnostics.push(Diagnostic::error(codes::UNKNOWN_STYLE, styles[at].name.span, message));
                break;
            }
            chain.push(base + 1);
            at = base;
        }
        chain.push(0);
        chain.reverse();
        chain
    }

    /// The definitions of a file that hold in a chain of styles: a later style replaces the same name and arity.
    fn in_force(&mut self, file: usize, chain: &[usize]) -> Vec<InForce<'a>> {
        let files = self.files;
        let (mut style, mut grouping) = (0, Grouping::default());
        let mut out: Vec<InForce<'a>> = Vec::new();
        for declaration in &files[file].ast.declarations {
            let annotations = grouping.read(&declaration.annotations, &mut self.diagnostics);
            match &declaration.kind {
                DeclarationKind::Style(_) => style += 1,
                DeclarationKind::Import(_) => {}
                kind => {
                    if style > 0 {
                        self.refuse_outside_default(kind);
                    }
                    if let Some(level) = chain.iter().position(|s| *s == style) {
                        let replaced = |old: &InForce<'_>| chain.iter().position(|s| *s == old.style) < Some(level);
                        let key = key(kind);
                        out.retain(|old| !replaced(old) || self::key(&old.declaration.kind) != key);
                        let newer = |old: &InForce<'_>| chain.iter().position(|s| *s == old.style) > Some(level);
                        if !out.iter().any(|old| newer(old) && self::key(&old.declaration.kind) == key) {
                            out.push(InForce { style, declaration, annotations });
                        }
                    }
                }
            }
        }
        grouping.read(&files[file].ast.trailing, &mut self.diagnostics);
        out
    }

    fn refuse_outside_default(&mut self, kind: &DeclarationKind) {
        if let DeclarationKind::Rule(ast::Rule { modifier: Some(_), name, .. }) = kind {
            let message = "`start` and `extension` rules belong in the default style";
            self.diagnostics.push(Diagnostic::error(codes::MISPLACED_DECLARATION, name.span, message));
        }
    }

    fn declare(&mut self, instance: usize, definition: &InForce<'a>, hidden: bool) {
        match &definition.declaration.kind {
            DeclarationKind::Rule(rule) => self.declare_rule(instance, rule, &definition.declaration.annotations),
            DeclarationKind::Definition(d) => {
                let mut annotations = definition.annotations.clone();
                annotations.hidden |= hidden;
                self.declare_value(instance, d, annotations);
            }
            DeclarationKind::Import(_) | DeclarationKind::Style(_) => {}
        }
    }

    fn declare_value(&mut self, instance: usize, definition: &'a Definition, annotations: Annotations) {
        let text = &definition.name;
        let name: Arc<str> = format!("{}{}", self.instances[instance].prefix, text.text).into();
        let arity = definition.parameters.as_ref().map_or(0, Vec::len);
        let span = text.span;
        let value = if definition.kind == DefinitionKind::Function {
            self.functions.push(FunctionEntry { name, scope: instance, definition });
            Value::Function(FunctionId(self.functions.len() as u32 - 1))
        } else {
            let is_const = definition.kind == DefinitionKind::Const;
            let default = Default::Written(definition);
            self.attributes.push(AttributeEntry {
                name,
                scope: instance,
                is_const,
                definition,
                default,
                annotations,
                span,
            });
            Value::Attribute(AttributeId(self.attributes.len() as u32 - 1))
        };
        let known = self.instances[instance].values.get(&text.text).cloned().unwrap_or_default();
        let clash = known
            .iter()
            .any(|&other| self.value_arity(other) == arity && (arity == 0 || matches!(other, Value::Attribute(_))));
        if clash {
            self.duplicate(span, &text.text);
        }
        self.instances[instance].values.entry(text.text.clone()).or_default().push(value);
    }

    /// The number of parameters; 0 for attributes but `streetWidth(edge)`.
    pub fn value_arity(&self, value: Value) -> usize {
        match value {
            Value::Attribute(id) => match self.attributes[id.0 as usize].default {
                Default::Written(definition) => definition.parameters.as_ref().map_or(0, Vec::len),
                Default::Propagated(outer) => self.value_arity(Value::Attribute(outer)),
                Default::Overridden { .. } => 0,
            },
            Value::Function(id) => self.functions[id.0 as usize].definition.parameters.as_ref().map_or(0, Vec::len),
        }
    }

    fn declare_rule(&mut self, instance: usize, rule: &'a ast::Rule, annotations: &[ast::Annotation]) {
        if self.import_of(instance, &rule.name.text).is_some() {
            return;
        }
        let starts = rule.modifier == Some(Modifier::Start);
        let id = self.push_rule(RuleEntry {
            name: format!("{}{}", self.instances[instance].prefix, rule.name.text).into(),
            scope: instance,
            parameters: &rule.parameters,
            locals: &rule.locals,
            successor: &rule.successor,
            is_start: starts || annotations.iter().any(|a| a.name.text.eq_ignore_ascii_case("StartRule")),
            is_extension: rule.modifier == Some(Modifier::Extension),
            span: rule.name.span,
        });
        let known = self.instances[instance].rules.get(&rule.name.text).cloned().unwrap_or_default();
        if rule.parameters.is_empty() && known.iter().any(|k| self.rules[k.0 as usize].parameters.is_empty()) {
            self.duplicate(rule.name.span, &rule.name.text);
        }
        self.instances[instance].rules.entry(rule.name.text.clone()).or_default().push(id);
        if starts {
            self.instances[instance].starts.push(id);
        }
    }

    pub fn push_rule(&mut self, entry: RuleEntry<'a>) -> RuleId {
        self.rules.push(entry);
        RuleId(self.rules.len() as u32 - 1)
    }

    pub fn duplicate(&mut self, span: Span, name: &str) {
        let message = format!("`{name}` is defined twice with the same parameters");
        self.diagnostics
            .push(Diagnostic::error(codes::DUPLICATE_DEFINITION, span, message).label("the second definition"));
    }

    fn imports(&mut self, parent: usize, file: usize, hidden: bool) {
        let files = self.files;
        let imports = files[file].ast.declarations.iter().filter_map(|d| match &d.kind {
            DeclarationKind::Import(import) => Some((import, &d.annotations)),
            _ => None,
        });
        for ((import, annotations), target) in imports.zip(&files[file].imports) {
            if self.instances[parent].children.contains_key(&import.prefix.text) {
                self.duplicate(import.prefix.span, &import.prefix.text);
                continue;
            }
            let Some(target) = *target else { continue };
            if self.instances.len() >= MAX_INSTANCES {
                let message = format!("more than {MAX_INSTANCES} imports, counting imports of imports");
                self.diagnostics.push(Diagnostic::error(codes::TOO_MANY_IMPORTS, import.prefix.span, message));
                return;
            }
            let hide = annotations.iter().find(|a| &*a.name.text == "Hidden");
            let all = hidden || hide.is_some_and(|a| a.args.is_empty());
            let prefix = format!("{}{}.", self.instances[parent].prefix, import.prefix.text);
            let child = self.instantiate(target, prefix, None, all);
            self.instances[parent].children.insert(import.prefix.text.clone(), child);
            self.connect(parent, child, import);
        }
    }

    /// The imported instance and the name in it that a dotted name means, if its first part is an import.
    pub fn import_of<'n>(&self, instance: usize, name: &'n str) -> Option<(usize, &'n str)> {
        let (first, rest) = name.split_once('.')?;
        let child = *self.instances[instance].children.get(first)?;
        self.import_of(child, rest).or(Some((child, rest)))
    }

    /// What a name in an expression may mean, before looking at arguments.
    pub fn values(&self, instance: usize, name: &str) -> &[Value] {
        match self.instances[instance].values.get(name) {
            Some(values) => values,
            None => match self.import_of(instance, name) {
                Some((child, rest)) => self.instances[child].values.get(rest).map_or(&[], Vec::as_slice),
                None => &[],
            },
        }
    }

    /// The rules of a name, before looking at arguments. `start` is the file's start rule.
    pub fn rules_named(&self, instance: usize, name: &str) -> &[RuleId] {
        let (at, rest) = match self.instances[instance].rules.contains_key(name) {
            true => (instance, name),
            false => self.import_of(instance, name).unwrap_or((instance, name)),
        };
        match self.instances[at].rules.get(rest) {
            Some(rules) => rules,
            None if rest == "start" => &self.instances[at].starts,
            None => &[],
        }
    }
}

/// What makes two definitions the same across styles: namespace, name, number of parameters.
fn key(kind: &DeclarationKind) -> (bool, &str, usize) {
    match kind {
        DeclarationKind::Rule(rule) => (true, &rule.name.text, rule.parameters.len()),
        DeclarationKind::Definition(d) => (false, &d.name.text, d.parameters.as_ref().map_or(0, Vec::len)),
        DeclarationKind::Import(_) | DeclarationKind::Style(_) => (false, "", usize::MAX),
    }
}
