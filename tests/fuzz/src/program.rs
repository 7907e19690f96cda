//! In: bytes. Out: a rule file that mostly compiles: attributes, functions, and rules of operations from the tables.

use arbitrary::{Result, Unstructured};

use super::expression::{arguments, value};
use crate::cga::builtins::{Attr, Operation, Word};
use crate::cga::program::Type;

const TYPES: [Type; 6] = [Type::Float, Type::Bool, Type::String, Type::Floats, Type::Bools, Type::Strings];
/// Rules of a program; a rule calls later ones, and now and then any.
const RULES: usize = 6;

/// A program whose start rule is `Lot`.
pub fn program(bytes: &mut Unstructured<'_>) -> Result<String> {
    let mut out = String::from("version \"2025.1\"\n");
    for number in 0..bytes.int_in_range(0..=3)? {
        let kind = *bytes.choose(&TYPES)?;
        out += &format!("attr a{number} = {}\n", value(bytes, kind, 3)?);
    }
    for number in 0..bytes.int_in_range(0..=2)? {
        let kind = *bytes.choose(&TYPES)?;
        out += &format!("f{number}(x) = {}\n", value(bytes, kind, 3)?);
    }
    out += "@StartRule\nLot --> ";
    out += *bytes.choose(&["extrude(6) R0", "R0", "extrude(10) comp(f) { all : R0 }", "extrude(3) roofHip(30) R0"])?;
    out.push('\n');
    for number in 0..RULES {
        out += &format!("R{number} --> {}\n", successor(bytes, number, 3)?);
    }
    Ok(out)
}

fn successor(bytes: &mut Unstructured<'_>, rule: usize, depth: u32) -> Result<String> {
    if depth == 0 || bytes.is_empty() {
        return symbol(bytes, rule);
    }
    Ok(match bytes.int_in_range(0..=7)? {
        0 => {
            let condition = value(bytes, Type::Bool, 2)?;
            let then = successor(bytes, rule, depth - 1)?;
            format!("case {condition} : {then} else : {}", successor(bytes, rule, depth - 1)?)
        }
        1 => format!("40% : {} else : {}", successor(bytes, rule, depth - 1)?, successor(bytes, rule, depth - 1)?),
        _ => {
            let mut items = Vec::new();
            for _ in 0..bytes.int_in_range(1..=4)? {
                items.push(item(bytes, rule, depth - 1)?);
            }
            items.join(" ")
        }
    })
}

fn symbol(bytes: &mut Unstructured<'_>, rule: usize) -> Result<String> {
    Ok(match bytes.int_in_range(0..=7)? {
        0 => "Leaf.".to_owned(),
        1 => "NIL".to_owned(),
        // Any rule: recursion that only a limit ends.
        2 => format!("R{}", bytes.choose_index(RULES)?),
        _ if rule + 1 < RULES => format!("R{}", bytes.int_in_range(rule + 1..=RULES - 1)?),
        _ => "Leaf.".to_owned(),
    })
}

fn item(bytes: &mut Unstructured<'_>, rule: usize, depth: u32) -> Result<String> {
    Ok(match bytes.int_in_range(0..=9)? {
        0 => symbol(bytes, rule)?,
        1 => format!("[ {} ]", successor(bytes, rule, depth)?),
        2 => {
            let rows: Vec<_> = Attr::table().filter(|row| row.writable).collect();
            let row = *bytes.choose(&rows)?;
            format!("set({}, {})", row.name, value(bytes, row.kind, 2)?)
        }
        3 => format!("inline {{ {} }}", successor(bytes, rule, depth)?),
        4 => {
            let operation = *bytes.choose(&["union", "subtract", "intersect"])?;
            format!("{operation} {{ {} | {} }}", successor(bytes, rule, depth)?, successor(bytes, rule, depth)?)
        }
        _ => {
            let operation = *bytes.choose(Operation::ALL)?;
            let overload = bytes.choose(operation.overloads())?;
            let args = arguments(bytes, &overload.parameters, 2)?;
            format!("{}({args}){}", operation.name(), block(bytes, operation.name(), rule, depth)?)
        }
    })
}

/// The block that an operation takes.
fn block(bytes: &mut Unstructured<'_>, operation: &str, rule: usize, depth: u32) -> Result<String> {
    match operation {
        "split" | "splitArea" => split_block(bytes, rule, depth, 2),
        "comp" | "modify" | "setback" | "setbackPerEdge" | "setbackToArea" | "shapeL" | "shapeU" | "shapeO"
        | "innerRectangle" => selector_block(bytes, rule, depth),
        "scatter" => Ok(format!(" {{ {} }}", successor(bytes, rule, depth)?)),
        "splitAndSetbackPerimeter" => {
            let size = value(bytes, Type::Float, 1)?;
            let offset = value(bytes, Type::Float, 1)?;
            let body = successor(bytes, rule, depth)?;
            let star = *bytes.choose(&["", "*"])?;
            Ok(format!(" {{ ~{size} : {offset} : {body} }}{star} {{ remainder : {} }}", successor(bytes, rule, depth)?))
        }
        _ => Ok(String::new()),
    }
}

fn split_block(bytes: &mut Unstructured<'_>, rule: usize, depth: u32, groups: u32) -> Result<String> {
    let mut parts = Vec::new();
    for _ in 0..bytes.int_in_range(1..=3)? {
        if groups > 0 && bytes.ratio(1, 5)? {
            parts.push(split_block(bytes, rule, depth, groups - 1)?);
            continue;
        }
        let prefix = *bytes.choose(&["", "~", "'"])?;
        parts.push(format!("{prefix}{} : {}", value(bytes, Type::Float, 1)?, successor(bytes, rule, depth)?));
    }
    let star = *bytes.choose(&["", "*"])?;
    Ok(format!(" {{ {} }}{star}", parts.join(" | ")))
}

fn selector_block(bytes: &mut Unstructured<'_>, rule: usize, depth: u32) -> Result<String> {
    let mut parts = Vec::new();
    for _ in 0..bytes.int_in_range(1..=3)? {
        let test = match bytes.int_in_range(0..=4)? {
            0 => value(bytes, Type::Bool, 1)?,
            1 => bytes.int_in_range(0..=9)?.to_string(),
            _ => bytes.choose(Word::ALL)?.text().to_owned(),
        };
        let operator = *bytes.choose(&[":", ":", "=", "=:"])?;
        parts.push(format!("{test} {operator} {}", successor(bytes, rule, depth)?));
    }
    Ok(format!(" {{ {} }}", parts.join(" | ")))
}
