//! In: bytes. Out: expressions of a wanted type, from the tables of functions and attributes.

use arbitrary::{Result, Unstructured};

use crate::cga::builtins::{Attr, Function, ParameterKind, Signature};
use crate::cga::program::Type;

const NUMBERS: &[&str] = &[
    "0", "1", "2", "3", "0.5", "10", "-1", "-0.3", "45", "90", "180", "0.001", "1e-9", "1e9", "-1e30", "(0/0)",
    "(1/0)", "7.25",
];
const STRINGS: &[&str] = &[
    "\"\"",
    "\"a\"",
    "\"a;b;c;\"",
    "\"#ff8800\"",
    "\"builtin:cube\"",
    "\"x.obj\"",
    "\"1.5\"",
    "\"*\"",
    "\"wall.front\"",
    "\"(\"",
    "\"ä\\n\"",
    "\"edge.top\"",
    "\"top\"",
];

/// An expression of a type; `depth` is what is left for calls within calls.
pub fn value(bytes: &mut Unstructured<'_>, wanted: Type, depth: u32) -> Result<String> {
    if depth == 0 || bytes.is_empty() {
        return constant(bytes, wanted);
    }
    match bytes.int_in_range(0..=9)? {
        0..=2 => constant(bytes, wanted),
        3 => attribute(bytes, wanted),
        4 | 5 => call(bytes, wanted, depth - 1),
        6 => {
            let condition = value(bytes, Type::Bool, depth - 1)?;
            let (then, otherwise) = (value(bytes, wanted, depth - 1)?, value(bytes, wanted, depth - 1)?);
            Ok(format!("(case {condition} : {then} else : {otherwise})"))
        }
        7 => Ok(format!("(30% : {} else : {})", value(bytes, wanted, depth - 1)?, value(bytes, wanted, depth - 1)?)),
        _ => operation(bytes, wanted, depth - 1),
    }
}

fn constant(bytes: &mut Unstructured<'_>, wanted: Type) -> Result<String> {
    Ok(match wanted {
        Type::Float => (*bytes.choose(NUMBERS)?).to_owned(),
        Type::Bool => (*bytes.choose(&["true", "false"])?).to_owned(),
        Type::String => (*bytes.choose(STRINGS)?).to_owned(),
        Type::Floats => {
            (*bytes.choose(&["[1, 2, 3]", "[1:5]", "[0.5; 2]", "floatArray()", "[3:-1:-2]", "[1,2;3,4]"])?).to_owned()
        }
        Type::Bools => (*bytes.choose(&["[true, false]", "boolArray()", "([1, 2] .== [1, 3])"])?).to_owned(),
        Type::Strings => {
            (*bytes.choose(&["[\"a\", \"b\"]", "stringArray()", "splitString(\"a;b\", \";\")"])?).to_owned()
        }
    })
}

fn attribute(bytes: &mut Unstructured<'_>, wanted: Type) -> Result<String> {
    let rows: Vec<&str> = Attr::table().filter(|row| row.kind == wanted).map(|row| row.name).collect();
    if rows.is_empty() { constant(bytes, wanted) } else { Ok((*bytes.choose(&rows)?).to_owned()) }
}

fn call(bytes: &mut Unstructured<'_>, wanted: Type, depth: u32) -> Result<String> {
    let fitting: Vec<(Function, &Signature)> = Function::ALL
        .iter()
        .flat_map(|f| f.overloads().iter().map(|overload| (*f, overload)))
        .filter(|(_, overload)| overload.result == Some(wanted))
        .collect();
    if fitting.is_empty() {
        return constant(bytes, wanted);
    }
    let (function, overload) = *bytes.choose(&fitting)?;
    let args = arguments(bytes, &overload.parameters, depth)?;
    Ok(if args.is_empty() { function.name().to_owned() } else { format!("{}({args})", function.name()) })
}

fn operation(bytes: &mut Unstructured<'_>, wanted: Type, depth: u32) -> Result<String> {
    let operators: &[&str] = match wanted {
        Type::Float => &["+", "-", "*", "/", "%"],
        Type::Bool => &["&&", "||", "==", "!="],
        Type::String => &["+"],
        Type::Floats => &[".+", ".-", ".*", "./", ".%"],
        Type::Bools => &[".&&", ".||", ".==", ".!="],
        Type::Strings => &[".+"],
    };
    let operator = *bytes.choose(operators)?;
    Ok(format!("({} {operator} {})", value(bytes, wanted, depth)?, value(bytes, wanted, depth)?))
}

/// Arguments for parameters, without parentheses.
pub fn arguments(bytes: &mut Unstructured<'_>, parameters: &[ParameterKind], depth: u32) -> Result<String> {
    let mut args = Vec::new();
    for parameter in parameters {
        if parameter.optional && bytes.ratio(1, 2)? {
            break;
        }
        let takes_word = !parameter.words.is_empty() && (parameter.values.is_empty() || bytes.ratio(1, 2)?);
        args.push(if takes_word {
            bytes.choose(&parameter.words)?.text().to_owned()
        } else {
            let prefix = match (parameter.relative, parameter.floating) {
                (_, true) => *bytes.choose(&["", "'", "~"])?,
                (true, _) => *bytes.choose(&["", "'"])?,
                _ => "",
            };
            let kind = *bytes.choose(&parameter.values)?;
            format!("{prefix}{}", value(bytes, kind, depth)?)
        });
    }
    Ok(args.join(", "))
}
