//! How a built-in is written, for people. In: a name and an overload's [`Signature`] text. Out: `split(x | y | z [, …])`.

use super::Operation;

/// `text` is a signature of the tables; operations that take a block end in `{ … }`.
pub fn operation(operation: Operation) -> Vec<String> {
    let block = if operation.takes_block() { " { … }" } else { "" };
    let written = |text: &&str| format!("{}{}{block}", operation.name(), parameters(text));
    operation.signatures().iter().map(written).collect()
}

/// `name(parameters) → result` for every overload of a function.
pub fn function(function: super::Function) -> Vec<String> {
    let written = |text: &&str| {
        let (parameters_text, result) = text.split_once("->").expect("signatures of functions have results");
        format!("{}{} → {}", function.name(), parameters(parameters_text), kind(result.trim()))
    };
    function.signatures().iter().map(written).collect()
}

/// `(number, x | y [, number])`; nothing where there are no parameters.
fn parameters(text: &str) -> String {
    let mut out = String::new();
    let mut open = 0;
    for (number, part) in super::signature::split_parameters(text).enumerate() {
        let optional = part.ends_with('?');
        let part = part.strip_suffix('?').unwrap_or(part);
        match (number, optional) {
            (0, true) => out.push('['),
            (_, true) => out.push_str(" [, "),
            (0, false) => {}
            (_, false) => out.push_str(", "),
        }
        open += usize::from(optional);
        out.push_str(&parameter(part));
    }
    if out.is_empty() { String::from("()") } else { format!("({out}{})", "]".repeat(open)) }
}

fn parameter(text: &str) -> String {
    let (value, words) = text.split_once('{').unwrap_or((text, ""));
    let words = words.trim_end_matches('}').split_whitespace().map(|w| w.strip_prefix('@').unwrap_or(w));
    let value = (!value.is_empty()).then(|| kind(value));
    value.into_iter().chain(words.map(str::to_owned)).collect::<Vec<_>>().join(" | ")
}

/// The name of a type with the prefixes that may stand before it.
fn kind(text: &str) -> String {
    let prefix = match text.chars().last() {
        Some('~') => "'~",
        Some('\'') => "'",
        _ => "",
    };
    let name = match text.trim_end_matches(['~', '\'']) {
        "F" => "number",
        "B" => "bool",
        "S" => "text",
        "F[]" => "numbers",
        "B[]" => "bools",
        "S[]" => "texts",
        "A" => "array",
        "X" => "value",
        other => unreachable!("signatures name known types, not {other}"),
    };
    format!("{prefix}{name}")
}

#[cfg(test)]
mod tests {
    use super::super::{Function, Operation};
    use super::{function, operation};

    #[test]
    fn overloads_read_like_calls() {
        assert_eq!(operation(Operation::Taper), ["taper(number)"]);
        assert_eq!(operation(Operation::ReverseNormals), ["reverseNormals()"]);
        assert_eq!(operation(Operation::S), ["s('number, 'number, 'number)"]);
        assert_eq!(operation(Operation::RoofHip)[0], "roofHip(number [, number [, bool]])");
        assert_eq!(operation(Operation::PrimitiveDisk)[0], "primitiveDisk([number [, number]])");
        assert_eq!(operation(Operation::Split)[0], "split(x | y | z [, adjust | noAdjust]) { … }");
        assert_eq!(function(Function::Pow), ["pow(number, number) → number"]);
        assert_eq!(function(Function::GeometryArea)[1], "geometry.area(orientation | surface) → number");
    }
}
