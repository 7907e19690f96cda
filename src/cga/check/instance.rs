//! In: parsed files. Out: the tables of names: every rule, function and attribute of every import under its id.
//!
//! An *instance* is one import of one file: it has its own rules and attributes, named with its prefix.

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::load::LoadedFile;
use super::names::{Meaning, Recorder};
use super::style::InForce;
use crate::cga::ast::{self, AnnotationValue, DeclarationKind, Definition, DefinitionKind, Import, Modifier, Text};
use crate::cga::codes;
use crate::cga::program::{Annotations, AttributeId, FunctionId, Needs, RuleId};
use crate::diagnostics::{Diagnostic, Diagnostics, suggest};
use crate::source::Span;

/// Most imports in the whole tree; a ladder of files that each import the next one twice doubles per step.
pub const MAX_INSTANCES: usize = 1000;

/// Searches among all names of a file for one that was meant.
const MOST_SEARCHES: usize = 200;

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
    /// What `import.Name` means in this file where it has replaced that extension rule: the imported file's own.
    pub originals: BTreeMap<Arc<str>, Vec<RuleId>>,
}

#[derive(Clone)]
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
    /// Those in front of the definition.
    pub written: &'a [ast::Annotation],
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
    /// The instance that a dynamic import call with new rules runs in, by the caller's instance and the call.
    pub dynamic: BTreeMap<(usize, Span), usize>,
    /// Instances whose rules are called so.
    pub called_dynamically: BTreeSet<usize>,
    pub diagnostics: Diagnostics,
    /// Takes down what names mean, where an editor wants to know.
    pub names: Option<Recorder>,
    /// Searches for meant names that are left: see [`Tables::meant`].
    searches: Cell<usize>,
    /// See [`crate::cga::program::Program::observes_tags`]; set while bodies are resolved.
    pub observes_tags: Cell<bool>,
    /// See [`crate::cga::program::Program::needs`]; added to while bodies are resolved.
    pub needs: Cell<Needs>,
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
            dynamic: BTreeMap::new(),
            called_dynamically: BTreeSet::new(),
            diagnostics: Diagnostics::default(),
            names: None,
            searches: Cell::new(MOST_SEARCHES),
            observes_tags: Cell::new(false),
            needs: Cell::default(),
        }
    }

    /// The main file and all its imports; `style` is one of its own, or `import.Style` for one of an imported file.
    pub fn instantiate_main(&mut self, style: Option<&str>) {
        if !self.files.is_empty() {
            self.instantiate(0, String::new(), style, false);
            self.dynamic_instances();
        }
    }

    fn instantiate(&mut self, file: usize, prefix: String, style: Option<&str>, hidden: bool) -> usize {
        let id = self.instances.len();
        self.instances.push(Instance { prefix, ..Instance::default() });
        let own = style.filter(|s| self.has_style(file, s) || self.style_of_import(file, s).is_none());
        let chain = self.style_chain(file, own);
        let in_force = self.in_force(file, &chain);
        let prefixes: BTreeSet<&str> = self.imports_of(file).map(|(import, _)| &*import.prefix.text).collect();
        let imported = |name: &str| name.split_once('.').is_some_and(|(first, _)| prefixes.contains(first));
        for InForce { declaration, annotations } in &in_force {
            match &declaration.kind {
                DeclarationKind::Rule(rule) if imported(&rule.name.text) => {}
                DeclarationKind::Rule(rule) => self.declare_rule(id, rule, &declaration.annotations),
                DeclarationKind::Definition(d) => {
                    let mut annotations = annotations.clone();
                    annotations.hidden |= hidden;
                    self.declare_value(id, d, &declaration.annotations, annotations);
                }
                DeclarationKind::Import(_) | DeclarationKind::Style(_) => {}
            }
        }
        self.imports(id, file, style.filter(|_| own.is_none()), hidden);
        for definition in in_force {
            if let DeclarationKind::Rule(rule) = &definition.declaration.kind {
                self.continue_import(id, rule);
            }
        }
        id
    }

    fn imports_of(&self, file: usize) -> impl Iterator<Item = (&'a Import, &'a [ast::Annotation])> + use<'a> {
        let files = self.files;
        files[file].ast.declarations.iter().filter_map(|d| match &d.kind {
            DeclarationKind::Import(import) => Some((import, &d.annotations[..])),
            _ => None,
        })
    }

    /// `import.Style`: the import and the rest.
    fn style_of_import<'s>(&self, file: usize, style: &'s str) -> Option<(&'a Import, &'s str)> {
        let (prefix, rest) = style.split_once('.')?;
        let (import, _) = self.imports_of(file).find(|(import, _)| &*import.prefix.text == prefix)?;
        Some((import, rest))
    }

    fn declare_value(
        &mut self,
        instance: usize,
        definition: &'a Definition,
        written: &'a [ast::Annotation],
        annotations: Annotations,
    ) {
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
                written,
                annotations,
                span,
            });
            Value::Attribute(AttributeId(self.attributes.len() as u32 - 1))
        };
        let known = self.instances[instance].values.get(&text.text).map_or(&[][..], Vec::as_slice);
        let clash =
            |other: &Value| (arity == 0 || matches!(other, Value::Attribute(_))) && self.value_arity(*other) == arity;
        if known.iter().any(clash) {
            self.duplicate(span, &text.text);
        }
        self.instances[instance].values.entry(text.text.clone()).or_default().push(value);
    }

    /// The parameters; none for attributes but `streetWidth(edge)`.
    pub fn value_parameters(&self, value: Value) -> &'a [Text] {
        match value {
            Value::Attribute(id) => match self.attributes[id.0 as usize].default {
                Default::Written(definition) => definition.parameters.as_deref().unwrap_or_default(),
                Default::Propagated(outer) => self.value_parameters(Value::Attribute(outer)),
                Default::Overridden { .. } => &[],
            },
            Value::Function(id) => self.functions[id.0 as usize].definition.parameters.as_deref().unwrap_or_default(),
        }
    }

    pub fn value_arity(&self, value: Value) -> usize {
        self.value_parameters(value).len()
    }

    fn declare_rule(&mut self, instance: usize, rule: &'a ast::Rule, annotations: &[ast::Annotation]) {
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
        let known = self.instances[instance].rules.get(&rule.name.text).map_or(&[][..], Vec::as_slice);
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

    fn imports(&mut self, parent: usize, file: usize, style: Option<&str>, hidden: bool) {
        let files = self.files;
        for ((import, annotations), target) in self.imports_of(file).zip(&files[file].imports) {
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
            let style = self.imported_style(target, import, file, style);
            let child = self.instantiate(target, prefix, style, all);
            self.instances[parent].children.insert(import.prefix.text.clone(), child);
            if let Some(names) = &mut self.names {
                names.import(parent, &import.prefix);
            }
            self.connect(parent, child, import);
            hide.into_iter().for_each(|annotation| self.hide(child, annotation));
        }
    }

    /// The style of the imported file that was chosen as `import.Style`, if the import allows it (reference 1.12).
    fn imported_style<'s>(
        &mut self,
        target: usize,
        import: &Import,
        file: usize,
        style: Option<&'s str>,
    ) -> Option<&'s str> {
        for listed in import.styles.iter().filter(|s| !self.has_style(target, &s.text)).collect::<Vec<_>>() {
            self.unknown_style(target, listed.span, &listed.text);
        }
        let (chosen, name) = self.style_of_import(file, style?)?;
        if chosen.prefix != import.prefix {
            return None;
        }
        if !import.styles.is_empty() && !import.styles.iter().any(|s| &*s.text == name) {
            let message = format!("the import leaves out the style `{name}`");
            self.diagnostics.push(Diagnostic::error(codes::UNKNOWN_STYLE, import.prefix.span, message));
            return None;
        }
        Some(name)
    }

    /// `@Hidden(a, b)` in front of an import.
    fn hide(&mut self, child: usize, annotation: &ast::Annotation) {
        for arg in &annotation.args {
            let found = match &arg.value {
                AnnotationValue::Name(name) => self.attribute_named(child, name),
                _ => None,
            };
            match found {
                Some(id) => {
                    self.attributes[id.0 as usize].annotations.hidden = true;
                    self.note(arg.span, Meaning::Value(self.attributes[id.0 as usize].span));
                }
                None => {
                    let message = "the imported file has no such attribute";
                    self.diagnostics.push(Diagnostic::warning(codes::ANNOTATION_ARGUMENT, arg.span, message));
                }
            }
        }
    }

    /// The attribute or constant that a name means in an instance.
    pub fn attribute_named(&self, instance: usize, name: &str) -> Option<AttributeId> {
        self.values(instance, name).iter().find_map(|v| match v {
            Value::Attribute(id) => Some(*id),
            Value::Function(_) => None,
        })
    }

    /// The name that was probably meant. A text with very many unknown names is answered in time rather than in full.
    pub fn meant<'n>(&self, name: &str, candidates: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
        self.searches.set(self.searches.get().checked_sub(1)?);
        suggest(name, candidates)
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
        if let Some(originals) = self.instances[instance].originals.get(name) {
            return originals;
        }
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
