//! In: the overloads of a built-in. Out: how messages list them.

use crate::cga::builtins::{ParameterKind, Signature};
use crate::cga::program::Type;

/// Words of one parameter that are listed.
const WORDS: usize = 6;
/// Overloads that are listed.
const OVERLOADS: usize = 6;

/// `its forms are extrude(number), extrude(x | y | z, number)`; an optional argument has a `?`.
pub fn forms(name: &str, signatures: &[Signature]) -> String {
    let mut listed: Vec<String> = signatures.iter().take(OVERLOADS).map(|s| form(name, s)).collect();
    if signatures.len() > OVERLOADS {
        listed.push("…".to_owned());
    }
    let lead = if signatures.len() == 1 { "its form is" } else { "its forms are" };
    format!("{lead} {}", listed.join(", "))
}

fn form(name: &str, signature: &Signature) -> String {
    let parameters: Vec<String> = signature.parameters.iter().map(parameter).collect();
    format!("{name}({})", parameters.join(", "))
}

fn parameter(kind: &ParameterKind) -> String {
    let mut choices: Vec<String> = match kind.values.len() {
        0..=2 => kind.values.iter().map(|k| short_name(*k).to_owned()).collect(),
        3 => vec!["array".to_owned()],
        _ => vec!["any value".to_owned()],
    };
    choices.extend(kind.words.iter().take(WORDS).map(|w| w.text().to_owned()));
    if kind.words.len() > WORDS {
        choices.push("…".to_owned());
    }
    let mark = if kind.optional { "?" } else { "" };
    format!("{}{mark}", choices.join(" | "))
}

fn short_name(kind: Type) -> &'static str {
    match kind {
        Type::Float => "number",
        Type::Bool => "bool",
        Type::String => "string",
        Type::Floats => "number[]",
        Type::Bools => "bool[]",
        Type::Strings => "string[]",
    }
}

#[cfg(test)]
mod tests {
    use super::forms;
    use crate::cga::builtins::{Function, Operation};

    #[test]
    fn overloads_are_listed_as_a_call_is_written() {
        let of = |o: Operation| forms(o.name(), o.overloads());
        assert_eq!(
            of(Operation::RoofPyramid),
            "its forms are roofPyramid(number), roofPyramid(byAngle | byHeight, number)"
        );
        assert_eq!(
            of(Operation::CleanupGeometry),
            "its form is cleanupGeometry(vertices | edges | faces | all, number)"
        );
        assert_eq!(forms("size", Function::Size.overloads()), "its form is size(array)");
        assert_eq!(forms("str", Function::Str.overloads()), "its form is str(any value)");
    }
}
