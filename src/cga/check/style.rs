//! In: the declarations of a file and a chosen style. Out: the definitions that hold in it (reference 1.13).

use std::collections::BTreeMap;
use std::sync::Arc;

use super::annotations::Grouping;
use super::instance::Tables;
use super::types::type_name;
use crate::cga::ast::{self, Ast, Declaration, DeclarationKind, DefinitionKind};
use crate::cga::codes;
use crate::cga::program::{Annotations, Program, Type};
use crate::diagnostics::{Diagnostic, Diagnostics, suggest};
use crate::source::Span;

/// One definition that is in force.
pub struct InForce<'a> {
    pub declaration: &'a Declaration,
    pub annotations: Annotations,
}

/// What makes two definitions the same across styles: namespace, name, number of parameters.
type Key<'a> = (bool, &'a str, usize);

impl<'a> Tables<'a> {
    fn styles(&self, file: usize) -> Vec<&'a ast::Style> {
        let files = self.files;
        let style = |d: &'a Declaration| match &d.kind {
            DeclarationKind::Style(style) => Some(style),
            _ => None,
        };
        files[file].ast.declarations.iter().filter_map(style).collect()
    }

    /// There is no style of this name in the file.
    pub fn unknown_style(&mut self, file: usize, span: Span, name: &str) {
        let diagnostic = Diagnostic::error(codes::UNKNOWN_STYLE, span, format!("there is no style `{name}`"));
        let styles = self.styles(file);
        let near = suggest(name, styles.iter().map(|s| &*s.name.text));
        let help = near.map(|near| format!("did you mean `{near}`?"));
        self.diagnostics.push(Diagnostic { help, ..diagnostic });
    }

    pub fn has_style(&self, file: usize, name: &str) -> bool {
        name == "Default" || self.styles(file).iter().any(|s| &*s.name.text == name)
    }

    /// The styles whose definitions hold, from the default style (0) to the chosen one; styles count from 1.
    pub fn style_chain(&mut self, file: usize, style: Option<&str>) -> Vec<usize> {
        let styles = self.styles(file);
        let find = |name: &str| styles.iter().position(|s| &*s.name.text == name);
        for style in &styles {
            if let Some(base) = style.base.as_ref().filter(|b| &*b.text != "Default" && find(&b.text).is_none()) {
                self.unknown_style(file, base.span, &base.text);
            }
        }
        let Some(name) = style.filter(|name| *name != "Default") else { return vec![0] };
        let Some(mut at) = find(name) else {
            self.unknown_style(file, Span::new(self.files[file].ast.source, 0, 0), name);
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
    pub fn in_force(&mut self, file: usize, chain: &[usize]) -> Vec<InForce<'a>> {
        let files = self.files;
        let (mut style, mut grouping) = (0, Grouping::default());
        let mut out: Vec<Option<InForce<'a>>> = Vec::new();
        // The nearest style that defines a key, and where its definitions lie in `out`.
        let mut nearest: BTreeMap<Key<'a>, (usize, Vec<usize>)> = BTreeMap::new();
        for declaration in &files[file].ast.declarations {
            let annotations = grouping.read(declaration, &mut self.diagnostics);
            let kind = &declaration.kind;
            let Some(key) = key(kind) else {
                style += usize::from(matches!(kind, DeclarationKind::Style(_)));
                continue;
            };
            if style > 0 {
                self.refuse_outside_default(kind);
            }
            let Some(level) = chain.iter().position(|s| *s == style) else { continue };
            let known = nearest.entry(key).or_insert_with(|| (level, Vec::new()));
            if let Some(other) = known.1.first().and_then(|i| out[*i].as_ref()).filter(|_| known.0 != level) {
                let (base, own) =
                    if known.0 < level { (other.declaration, declaration) } else { (declaration, other.declaration) };
                self.kept_kind(base, own);
            }
            if known.0 > level {
                continue;
            }
            if known.0 < level {
                std::mem::take(&mut known.1).into_iter().for_each(|old| out[old] = None);
                known.0 = level;
            }
            known.1.push(out.len());
            out.push(Some(InForce { declaration, annotations }));
        }
        grouping.trailing(&files[file].ast.trailing, &mut self.diagnostics);
        out.into_iter().flatten().collect()
    }

    /// A style may not make an attribute of a function, or a constant of an attribute.
    fn kept_kind(&mut self, base: &Declaration, own: &Declaration) {
        let (DeclarationKind::Definition(base), DeclarationKind::Definition(own)) = (&base.kind, &own.kind) else {
            return;
        };
        if base.kind != own.kind {
            let word = |kind| match kind {
                DefinitionKind::Attr => "an attribute",
                DefinitionKind::Const => "a constant",
                DefinitionKind::Function => "a function",
            };
            let message =
                format!("`{}` is {} here and {} in the base style", own.name.text, word(own.kind), word(base.kind));
            self.diagnostics.push(Diagnostic::error(codes::STYLE_MISMATCH, own.name.span, message));
        }
    }

    fn refuse_outside_default(&mut self, kind: &DeclarationKind) {
        if let DeclarationKind::Rule(ast::Rule { modifier: Some(_), name, .. }) = kind {
            let message = "`start` and `extension` rules belong in the default style";
            self.diagnostics.push(Diagnostic::error(codes::MISPLACED_DECLARATION, name.span, message));
        }
    }
}

fn key(kind: &DeclarationKind) -> Option<Key<'_>> {
    match kind {
        DeclarationKind::Rule(rule) => Some((true, &rule.name.text, rule.parameters.len())),
        DeclarationKind::Definition(d) => Some((false, &d.name.text, d.parameters.as_ref().map_or(0, Vec::len))),
        DeclarationKind::Import(_) | DeclarationKind::Style(_) => None,
    }
}

/// The styles of a file, in source order.
pub fn names(ast: &Ast) -> Vec<Arc<str>> {
    let style = |d: &Declaration| match &d.kind {
        DeclarationKind::Style(style) => Some(style.name.text.clone()),
        _ => None,
    };
    ast.declarations.iter().filter_map(style).collect()
}

/// Definitions whose type in a style is not that of the default style.
pub fn kept_types(default: &Program, program: &Program, diagnostics: &mut Diagnostics) {
    let attributes = |p: &'_ Program| -> BTreeMap<Arc<str>, (Option<Type>, Span)> {
        let attributes = p.attributes.iter().map(|a| (a.name.clone(), (a.kind, a.span)));
        attributes.chain(p.functions.iter().map(|f| (f.path.clone(), (f.body.value, f.span)))).collect()
    };
    let base = attributes(default);
    for (name, (kind, span)) in attributes(program) {
        let Some((wanted, at)) = base.get(&name).copied().filter(|(_, at)| *at != span) else { continue };
        if let (Some(kind), Some(wanted)) = (kind, wanted)
            && kind != wanted
            && at.source == span.source
        {
            let message = format!("this is {} here and {} in the default style", type_name(kind), type_name(wanted));
            diagnostics.push(Diagnostic::error(codes::STYLE_MISMATCH, span, message));
        }
    }
}
