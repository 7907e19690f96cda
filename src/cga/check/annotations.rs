//! In: annotations as written. Out: what they say ([`Annotations`]); unknown or odd ones are warnings, because
//! misspelt annotations stand in files that are in use.

use std::sync::Arc;

use crate::cga::ast::{Annotation, AnnotationArg, AnnotationValue};
use crate::cga::codes;
use crate::cga::program::{Annotations, Choices, Constant, Range};
use crate::diagnostics::{Diagnostic, Diagnostics, suggest};

/// Annotations of reference 1.14.
const KNOWN: &[&str] = &[
    "StartRule",
    "Hidden",
    "Group",
    "Order",
    "Range",
    "Enum",
    "Color",
    "File",
    "Directory",
    "MaterialFile",
    "Angle",
    "Distance",
    "Percent",
    "Description",
    "DisplayName",
    "RuleFileDescription",
    "Handle",
    "InMesh",
    "InPolygon",
    "InLine",
    "InPoint",
    "InPointCloud",
    "Out",
];

/// The group that stays open from one declaration to the next.
#[derive(Default)]
pub struct Grouping {
    groups: Vec<Arc<str>>,
}

impl Grouping {
    /// Reads the annotations of one declaration.
    pub fn read(&mut self, annotations: &[Annotation], diagnostics: &mut Diagnostics) -> Annotations {
        let mut out = Annotations::default();
        for annotation in annotations {
            let name = &*annotation.name.text;
            let args = &annotation.args[..];
            match name {
                "Group" => self.groups = strings(args).collect(),
                "Hidden" => out.hidden = true,
                "Order" => out.order = numbers(args).next(),
                "Description" => out.description = strings(args).next(),
                "DisplayName" => out.display_name = strings(args).next(),
                "Range" => range(annotation, &mut out, diagnostics),
                "Enum" => out.choices = choices(args, true),
                "Percent" if out.range.is_none() => out.range = Some(open_range(0.0, 1.0)),
                "Angle" if out.range.is_none() => out.range = Some(open_range(0.0, 360.0)),
                known if KNOWN.contains(&known) => {}
                unknown => {
                    let message = format!("there is no annotation `@{unknown}`; it is ignored");
                    let warning = Diagnostic::warning(codes::UNKNOWN_ANNOTATION, annotation.name.span, message);
                    let help = suggest(unknown, KNOWN.iter().copied()).map(|near| format!("did you mean `@{near}`?"));
                    diagnostics.push(Diagnostic { help, ..warning });
                }
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
