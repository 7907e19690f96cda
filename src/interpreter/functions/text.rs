//! Texts and file names (reference 6.4, 6.11, 6.13). Positions count characters from 0.

use super::super::derivation::Derivation;
use super::super::limits::Outcome;
use super::super::value::Value;
use super::Input;
use crate::cga::builtins::Function as F;

pub fn call(function: F, input: &Input) -> Option<Value> {
    let text = input.text(0);
    let second = || input.text(1);
    Some(match function {
        F::Len => Value::Float(text.chars().count() as f64),
        F::Count => Value::Float(if second().is_empty() { 0.0 } else { text.matches(&*second()).count() as f64 }),
        F::Find => place(&text, nth(&text, &second(), input.float(2))),
        F::FindFirst if matches!(input.value(0), Some(Value::String(_))) => place(&text, text.find(&*second())),
        F::FindLast => place(&text, text.rfind(&*second())),
        F::Substring => {
            let length = text.chars().count() as f64;
            let at = |i: usize| input.float(i).clamp(0.0, length) as usize;
            let (from, to) = (at(1), at(2));
            Value::text(text.chars().skip(from).take(to.saturating_sub(from)).collect::<String>())
        }
        F::GetPrefix => Value::text(text.find(&*second()).map_or("", |i| &text[..i])),
        F::GetSuffix => {
            let mark = second();
            Value::text(text.rfind(&*mark).map_or("", |i| &text[i + mark.len()..]))
        }
        F::GetRange => {
            let (left, right) = (second(), input.text(2));
            let from = text.find(&*left).map(|i| i + left.len());
            let to = text.rfind(&*right);
            Value::text(from.zip(to).and_then(|(from, to)| text.get(from..to)).unwrap_or(""))
        }
        F::FileName => Value::text(file_name(&text)),
        F::FileDirectory => Value::text(&text[..text.len() - file_name(&text).len()]),
        F::FileBasename => {
            let name = file_name(&text);
            Value::text(name.rfind('.').map_or(name, |i| &name[..i]))
        }
        F::FileExtension => {
            let name = file_name(&text);
            Value::text(name.rfind('.').map_or("", |i| &name[i + 1..]))
        }
        _ => return None,
    })
}

/// Character position of a byte position; -1 for none.
fn place(text: &str, byte: Option<usize>) -> Value {
    Value::Float(byte.map_or(-1.0, |b| text[..b].chars().count() as f64))
}

/// The n-th occurrence, not overlapping.
fn nth(text: &str, wanted: &str, n: f64) -> Option<usize> {
    if n < 0.0 || wanted.is_empty() {
        return None;
    }
    text.match_indices(wanted).nth(n as usize).map(|(i, _)| i)
}

fn file_name(path: &str) -> &str {
    path.rfind('/').map_or(path, |i| &path[i + 1..])
}

/// `replace(text, old, new)`: all occurrences.
pub fn replace(run: &mut Derivation, input: &Input) -> Outcome<Value> {
    let (text, old, new) = (input.text(0), input.text(1), input.text(2));
    if old.is_empty() {
        return Ok(Value::String(text));
    }
    let grown = text.len() + text.matches(&*old).count() * new.len();
    run.check_text(grown, input.span)?;
    Ok(Value::text(text.replace(&*old, &new)))
}
