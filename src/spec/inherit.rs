//! In: the blocks of a recipe as written. Out: the blocks with what they inherit, each name once.
//!
//! `camera low : satellite { … }` has the properties of `satellite` but for the keys that it gives itself; a key that
//! repeats (such as `rules`) is replaced as a whole. `key auto` drops an inherited property.

use super::ast::{Block, ExprKind, Property};
use super::schema::{BlockShape, RESERVED};
use crate::diagnostics::{Diagnostic, Diagnostics, suggest};

/// Kinds whose blocks may go without a name: the recipe's default.
const MAY_BE_UNNAMED: [&str; 3] = ["sun", "effects", "quality"];

/// Checks names and keys of all blocks and fills in what they inherit.
pub(super) fn resolve(blocks: Vec<Block>, diagnostics: &mut Diagnostics) -> Vec<Block> {
    let mut known: Vec<Block> = Vec::new();
    for mut block in blocks {
        let Some(shape) = BlockShape::find(&block.kind.text) else { continue };
        check_name(&block, &known, diagnostics);
        check_keys(&mut block, shape, diagnostics);
        known.push(block);
    }
    let complete = |block: &Block| Block { properties: inherited(block, &known, diagnostics), ..block.clone() };
    let mut resolved: Vec<Block> = known.iter().map(complete).collect();
    for block in &mut resolved {
        block.properties.retain(|property| !is_auto(property));
    }
    resolved
}

fn check_name(block: &Block, known: &[Block], diagnostics: &mut Diagnostics) {
    let kind = &block.kind.text;
    let Some(name) = &block.name else {
        if !MAY_BE_UNNAMED.contains(&kind.as_str()) {
            let message = format!("a `{kind}` has a name");
            diagnostics.push(Diagnostic::error("spec::missing-name", block.span, message));
        } else if known.iter().any(|other| other.kind.text == *kind && other.name.is_none()) {
            let message = format!("there are two `{kind}` blocks without a name");
            diagnostics.push(Diagnostic::error("spec::repeated-name", block.span, message));
        }
        return;
    };
    // Changes are named in sets, where these words have a meaning of their own.
    let reserved = RESERVED.contains(&name.text.as_str()) || super::filter::class_named(&name.text).is_some();
    if kind == "change" && reserved {
        let message = format!("`{}` names a set of its own and cannot name a `{kind}`", name.text);
        diagnostics.push(Diagnostic::error("spec::reserved-name", name.span, message));
    }
    let same = |other: &&Block| other.kind.text == *kind && other.name.as_ref().is_some_and(|n| n.text == name.text);
    if known.iter().any(|other| same(&other)) {
        let message = format!("there are two `{kind}` blocks named `{}`", name.text);
        diagnostics.push(Diagnostic::error("spec::repeated-name", name.span, message));
    }
}

/// Reports repeated keys and keys that are not evaluated yet, and drops them.
fn check_keys(block: &mut Block, shape: &BlockShape, diagnostics: &mut Diagnostics) {
    let mut seen: Vec<String> = Vec::new();
    block.properties.retain(|property| {
        let key = shape.key(&property.key.text).expect("the parser keeps known keys only");
        if !key.evaluated && !is_auto(property) {
            diagnostics.push(not_yet(&property.key.text, property.span));
            return false;
        }
        let repeated = !key.repeats && seen.contains(&property.key.text);
        if repeated {
            let message = format!("`{}` is given twice", property.key.text);
            diagnostics.push(Diagnostic::error("spec::repeated-property", property.key.span, message));
        }
        seen.push(property.key.text.clone());
        !repeated
    });
}

/// The error for what the language can say and this version does not do.
pub(super) fn not_yet(what: &str, span: crate::source::Span) -> Diagnostic {
    Diagnostic::error(
        "spec::not-supported-yet",
        span,
        format!("`{what}` is part of the language, but not supported yet"),
    )
}

fn is_auto(property: &Property) -> bool {
    matches!(property.values.as_slice(), [only] if matches!(&only.kind, ExprKind::Word(word) if word == "auto"))
}

/// The block's own properties after those of its ancestors that it does not give itself.
fn inherited(block: &Block, known: &[Block], diagnostics: &mut Diagnostics) -> Vec<Property> {
    let mut properties = block.properties.clone();
    let mut line = vec![block];
    while let Some(parent) = &line.last().expect("the line starts with the block").parent {
        let same_kind = || known.iter().filter(|other| other.kind.text == block.kind.text);
        let named = |other: &&Block| other.name.as_ref().is_some_and(|name| name.text == parent.text);
        let Some(next) = same_kind().find(named) else {
            let names = same_kind().filter_map(|other| other.name.as_ref()).map(|name| name.text.as_str());
            diagnostics.push(unknown_name(&block.kind.text, &parent.text, parent.span, names));
            break;
        };
        if line.iter().any(|seen| std::ptr::eq(*seen, next)) {
            let message = format!("`{}` extends itself", parent.text);
            diagnostics.push(Diagnostic::error("spec::circular-extension", parent.span, message));
            break;
        }
        let mut merged: Vec<Property> = Vec::new();
        let given = |property: &&Property| properties.iter().any(|own| own.key.text == property.key.text);
        merged.extend(next.properties.iter().filter(|property| !given(property)).cloned());
        merged.append(&mut properties);
        properties = merged;
        line.push(next);
    }
    properties
}

/// The error for a name that no block of the kind has.
pub(super) fn unknown_name<'a>(
    kind: &str,
    name: &str,
    span: crate::source::Span,
    known: impl IntoIterator<Item = &'a str>,
) -> Diagnostic {
    let known: Vec<&str> = known.into_iter().collect();
    let diagnostic = Diagnostic::error("spec::unknown-name", span, format!("there is no {kind} `{name}`"));
    match suggest(name, known.iter().copied()) {
        Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
        None if known.is_empty() => diagnostic,
        None => {
            let known: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
            diagnostic.help(format!("there are {}", known.join(", ")))
        }
    }
}
