//! In: annotations as written. Out: what they say ([`Annotations`]); unknown or odd ones are warnings, because
//! misspelt annotations stand in files that are in use.

use std::sync::Arc;

use super::annotation_rules;
use crate::cga::ast::{Annotation, AnnotationArg, AnnotationValue, Declaration, DeclarationKind};
use crate::cga::codes;
use crate::cga::program::{Annotations, Choices, Constant, Range};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::Span;

/// The group that stays open from one declaration to the next.
#[derive(Default)]
pub struct Grouping {
    groups: Vec<Arc<str>>,
    /// The first `@Range` in the old form without names, and how many there are.
    old_ranges: Option<(Span, usize)>,
}

impl Grouping {
    /// Reads the annotations of one declaration.
    pub fn read(&mut self, declaration: &Declaration, diagnostics: &mut Diagnostics) -> Annotations {
        self.annotations(&declaration.annotations, Some(&declaration.kind), diagnostics)
    }

    /// Reads those after the last declaration.
    pub fn trailing(&mut self, annotations: &[Annotation], diagnostics: &mut Diagnostics) {
        self.annotations(annotations, None, diagnostics);
        if let Some((span, count)) = self.old_ranges {
            let uses = if count == 1 { String::new() } else { format!(" ({count} times in this file)") };
            let message = format!("`@Range` without names is an old form{uses}");
            let help = "write `@Range(min=0, max=1)` for a range, `@Enum(\"a\", \"b\")` for a list of values";
            diagnostics.push(Diagnostic::warning(codes::DEPRECATED, span, message).help(help));
        }
    }

    fn annotations(
        &mut self,
        annotations: &[Annotation],
        on: Option<&DeclarationKind>,
        diagnostics: &mut Diagnostics,
    ) -> Annotations {
        let mut out = Annotations::default();
        for annotation in annotations {
            annotation_rules::check(annotation, on, diagnostics);
            let args = &annotation.args[..];
            match &*annotation.name.text {
                "Group" => self.groups = strings(args).collect(),
                "Hidden" => out.hidden = true,
                "Color" => out.color = true,
                "Order" => out.order = numbers(args).next(),
                "Description" => out.description = strings(args).next(),
                "DisplayName" => out.display_name = strings(args).next(),
                "Range" => {
                    if args.iter().any(|a| a.key.is_none()) {
                        self.old_ranges.get_or_insert((annotation.name.span, 0)).1 += 1;
                    }
                    range(annotation, &mut out, diagnostics);
                }
                "Enum" => out.choices = choices(args, true),
                "Percent" if out.range.is_none() => out.range = Some(open_range(0.0, 1.0)),
                "Angle" if out.range.is_none() => out.range = Some(open_range(0.0, 360.0)),
                _ => {}
            }
        }
        out.groups = self.groups.clone();
        out
    }
}

fn open_range(min: f64, max: f64) -> Range {
    Range { min: Some(min), max: Some(max), step: 0.0, restricted: false }
}

/// `@Range(min=.., max=.., stepsize=.., restricted=..)`, `@Range(a, b)`, or a legacy list of values.
fn range(annotation: &Annotation, out: &mut Annotations, diagnostics: &mut Diagnostics) {
    let args = &annotation.args[..];
    let (plain, keyed): (Vec<&AnnotationArg>, Vec<&AnnotationArg>) = args.iter().partition(|a| a.key.is_none());
    let positional: Vec<f64> = plain.iter().filter_map(|a| number(a)).collect();
    if !plain.is_empty() && (positional.len() != 2 || plain.len() != 2) {
        out.choices = choices(args, true);
        return;
    }
    let mut range = Range { min: None, max: None, step: 0.0, restricted: true };
    if let [min, max] = positional[..] {
        (range.min, range.max) = (Some(min), Some(max));
    }
    for arg in keyed {
        match arg.key.as_ref().map(|k| &*k.text) {
            Some("min") => range.min = number(arg),
            Some("max") => range.max = number(arg),
            Some("stepsize") => range.step = number(arg).unwrap_or(0.0),
            Some("restricted") => range.restricted = flag(arg),
            _ => {
                let message = "`@Range` has no such argument; it is ignored";
                let warning = Diagnostic::warning(codes::ANNOTATION_ARGUMENT, arg.span, message);
                diagnostics.push(warning.help("its arguments are min, max, stepsize and restricted"));
            }
        }
    }
    if range.min.zip(range.max).is_some_and(|(min, max)| min > max) {
        let message = "the least value is greater than the greatest; the range is ignored";
        diagnostics.push(Diagnostic::warning(codes::ANNOTATION_ARGUMENT, annotation.name.span, message));
    } else if range.min.is_some() || range.max.is_some() {
        out.range = Some(range);
    }
}

fn choices(args: &[AnnotationArg], restricted: bool) -> Option<Choices> {
    let mut out = Choices { values: Vec::new(), restricted };
    for arg in args {
        match (&arg.key, &arg.value) {
            (None, AnnotationValue::Constant(constant)) => out.values.push(constant.clone()),
            (Some(key), _) if &*key.text == "restricted" => out.restricted = flag(arg),
            _ => {}
        }
    }
    (!out.values.is_empty()).then_some(out)
}

fn number(arg: &AnnotationArg) -> Option<f64> {
    match arg.value {
        AnnotationValue::Constant(Constant::Float(number)) => Some(number),
        _ => None,
    }
}

fn flag(arg: &AnnotationArg) -> bool {
    arg.value != AnnotationValue::Constant(Constant::Bool(false))
}

fn numbers(args: &[AnnotationArg]) -> impl Iterator<Item = f64> {
    args.iter().filter_map(number)
}

fn strings(args: &[AnnotationArg]) -> impl Iterator<Item = Arc<str>> {
    args.iter().filter_map(|arg| match &arg.value {
        AnnotationValue::Constant(Constant::String(text)) => Some(text.clone()),
        _ => None,
    })
}
