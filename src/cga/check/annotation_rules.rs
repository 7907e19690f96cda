//! In: annotations and what they stand in front of. Out: warnings where the language gives them no meaning there, or
//! not with these arguments (reference 1.14). They stay warnings: annotations never change the model.

use super::instance::Tables;
use super::names::Meaning;
use super::types::{Types, element_of, is_element_of, type_name};
use crate::cga::ast::{Annotation, AnnotationValue, DeclarationKind, DefinitionKind, Modifier, Text};
use crate::cga::codes;
use crate::cga::program::{Constant, Type};
use crate::diagnostics::{Diagnostic, Diagnostics, suggest};

/// What an annotation may stand in front of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Target {
    Attribute,
    Rule,
    Import,
    /// Constants, functions and styles: no annotation has a meaning there but those of any place.
    Other,
}

use Target::{Attribute, Import, Rule};

/// What the arguments may be.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Arguments {
    None,
    /// Any number of strings.
    Strings,
    OneString,
    OneNumber,
    /// Read where the annotation is.
    Own,
}

struct Known {
    name: &'static str,
    /// Empty for any place.
    targets: &'static [Target],
    arguments: Arguments,
    /// Type of the attribute, or of its elements.
    kind: Option<Type>,
}

const fn known(name: &'static str, targets: &'static [Target], arguments: Arguments, kind: Option<Type>) -> Known {
    Known { name, targets, arguments, kind }
}

/// Annotations of reference 1.14. Groups stay open for what follows, so they may stand anywhere.
static KNOWN: &[Known] = &[
    known("StartRule", &[Rule], Arguments::None, None),
    known("Hidden", &[Attribute, Rule, Import], Arguments::Own, None),
    known("Group", &[], Arguments::Own, None),
    known("Order", &[Attribute, Rule], Arguments::OneNumber, None),
    known("Range", &[Attribute], Arguments::Own, None),
    known("Enum", &[Attribute], Arguments::Own, None),
    known("Color", &[Attribute], Arguments::None, Some(Type::String)),
    known("File", &[Attribute], Arguments::Strings, Some(Type::String)),
    known("Directory", &[Attribute], Arguments::None, Some(Type::String)),
    known("MaterialFile", &[Attribute], Arguments::None, Some(Type::String)),
    known("Angle", &[Attribute], Arguments::None, Some(Type::Float)),
    known("Distance", &[Attribute], Arguments::None, Some(Type::Float)),
    known("Percent", &[Attribute], Arguments::None, Some(Type::Float)),
    known("Description", &[Attribute, Rule], Arguments::OneString, None),
    known("DisplayName", &[Attribute, Rule], Arguments::OneString, None),
    known("RuleFileDescription", &[], Arguments::OneString, None),
    known("Handle", &[Attribute], Arguments::Own, None),
    known("InMesh", &[Rule], Arguments::None, None),
    known("InPolygon", &[Rule], Arguments::None, None),
    known("InLine", &[Rule], Arguments::None, None),
    known("InPoint", &[Rule], Arguments::None, None),
    known("InPointCloud", &[Rule], Arguments::None, None),
    known("Out", &[Rule], Arguments::Own, None),
];

/// The annotations that the language knows, without `@`.
pub fn names() -> impl Iterator<Item = &'static str> {
    KNOWN.iter().map(|row| row.name)
}

/// Checks one annotation in front of a declaration (none after the last one).
pub fn check(annotation: &Annotation, on: Option<&DeclarationKind>, diagnostics: &mut Diagnostics) {
    let name = &*annotation.name.text;
    let Some(row) = KNOWN.iter().find(|row| row.name == name) else {
        let message = format!("there is no annotation `@{name}`; it is ignored");
        let warning = Diagnostic::warning(codes::UNKNOWN_ANNOTATION, annotation.name.span, message);
        let help = suggest(name, KNOWN.iter().map(|row| row.name)).map(|near| format!("did you mean `@{near}`?"));
        diagnostics.push(Diagnostic { help, ..warning });
        return;
    };
    let (target, what) = on.map_or((Target::Other, "the end of the file"), target);
    if !row.targets.is_empty() && !row.targets.contains(&target) {
        let message = format!("`@{name}` has no effect in front of {what}");
        diagnostics.push(Diagnostic::warning(codes::MISPLACED_ANNOTATION, annotation.name.span, message));
    }
    arguments(annotation, row, diagnostics);
}

fn target(kind: &DeclarationKind) -> (Target, &'static str) {
    match kind {
        DeclarationKind::Definition(d) => match d.kind {
            DefinitionKind::Attr => (Target::Attribute, "an attribute"),
            DefinitionKind::Const => (Target::Other, "a constant"),
            DefinitionKind::Function => (Target::Other, "a function"),
        },
        DeclarationKind::Rule(rule) if rule.modifier == Some(Modifier::Extension) => {
            (Target::Rule, "an extension rule")
        }
        DeclarationKind::Rule(_) => (Target::Rule, "a rule"),
        DeclarationKind::Import(_) => (Target::Import, "an import"),
        DeclarationKind::Style(_) => (Target::Other, "a style"),
    }
}

fn arguments(annotation: &Annotation, row: &Known, diagnostics: &mut Diagnostics) {
    let args = &annotation.args;
    let string = |v: &AnnotationValue| matches!(v, AnnotationValue::Constant(Constant::String(_)));
    let number = |v: &AnnotationValue| matches!(v, AnnotationValue::Constant(Constant::Float(_)));
    let (fits, wanted) = match row.arguments {
        Arguments::None => (args.is_empty(), "no arguments"),
        Arguments::Strings => (args.iter().all(|a| string(&a.value)), "strings"),
        Arguments::OneString => (args.len() == 1 && string(&args[0].value), "one string"),
        Arguments::OneNumber => (args.len() == 1 && number(&args[0].value), "one number"),
        Arguments::Own => return own_arguments(annotation, diagnostics),
    };
    if !fits {
        let message = format!("`@{}` takes {wanted}", row.name);
        diagnostics.push(Diagnostic::warning(codes::ANNOTATION_ARGUMENT, annotation.name.span, message));
    }
}

/// Keys and values of `@Handle` and `@Out`; the others are read in `annotations`.
fn own_arguments(annotation: &Annotation, diagnostics: &mut Diagnostics) {
    let mut warn = |span, message: &str, help: &str| {
        diagnostics.push(Diagnostic::warning(codes::ANNOTATION_ARGUMENT, span, message).help(help));
    };
    for arg in &annotation.args {
        let key = arg.key.as_ref().map(|k| &*k.text);
        let value = match &arg.value {
            AnnotationValue::Name(name) | AnnotationValue::Text(name) => &**name,
            AnnotationValue::Constant(_) => "",
        };
        match (&*annotation.name.text, key) {
            ("Handle", None) => warn(arg.span, "the arguments of `@Handle` are named", "such as `shape=Name, axis=y`"),
            ("Handle", Some("type")) if !HANDLES.contains(&value) => {
                warn(
                    arg.span,
                    "there is no such type of handle",
                    "the types are linear, move, angular, toggle, selector and color",
                );
            }
            ("Out", Some("granularity")) if !["separatedShapes", "combinedShape"].contains(&value) => {
                warn(arg.span, "there is no such granularity", "write separatedShapes or combinedShape");
            }
            ("Out", key) if key != Some("granularity") => {
                warn(arg.span, "`@Out` has no such argument", "its argument is granularity");
            }
            _ => {}
        }
    }
}

static HANDLES: &[&str] = &["linear", "move", "angular", "toggle", "selector", "color"];

/// Annotations that want another type of attribute, lists of values of another type, attributes that do not exist.
pub fn check_types(tables: &Tables<'_>, types: &Types, diagnostics: &mut Diagnostics) {
    for (entry, kind) in tables.attributes.iter().zip(&types.attributes) {
        let Some(kind) = *kind else { continue };
        for annotation in entry.written {
            let mut warn = |span, message| {
                diagnostics.push(Diagnostic::warning(codes::ANNOTATION_ARGUMENT, span, message));
            };
            let name = &*annotation.name.text;
            let wanted = KNOWN.iter().find(|row| row.name == name).and_then(|row| row.kind);
            if let Some(wanted) = wanted.filter(|w| element_of(kind) != *w) {
                let message = format!("`@{name}` is for {}; this is {}", type_name(wanted), type_name(kind));
                warn(annotation.name.span, message);
            }
            if !matches!(name, "Range" | "Enum") {
                continue;
            }
            for arg in &annotation.args {
                match (&arg.value, arg.key.as_ref().map(|k| &*k.text)) {
                    (AnnotationValue::Constant(value), None | Some("min" | "max" | "stepsize"))
                        if !is_element_of(value, kind) =>
                    {
                        warn(arg.span, format!("this is no value for an attribute that is {}", type_name(kind)));
                    }
                    (AnnotationValue::Name(from), Some("valuesAttr")) => {
                        let values = tables.attribute_named(entry.scope, from);
                        if let Some(id) = values {
                            let text = Text { text: from.clone(), span: arg.span };
                            tables.refer(entry.scope, &text, Meaning::Value(tables.attributes[id.0 as usize].span));
                        }
                        match values.map(|id| types.attributes[id.0 as usize]) {
                            None => warn(arg.span, format!("there is no attribute `{from}`")),
                            Some(Some(found)) if element_of(found) != element_of(kind) => {
                                let message =
                                    format!("`{from}` is {}, the attribute {}", type_name(found), type_name(kind));
                                warn(arg.span, message);
                            }
                            Some(_) => {}
                        }
                    }
                    _ => {}
                }
            }
        }
    }
}
