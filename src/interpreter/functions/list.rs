//! String lists (reference 6.12): one text with `;` after every item. A wanted item may start or end with `*`.

use super::super::value::Value;
use super::Input;
use crate::cga::builtins::Function as F;

pub fn items(list: &str) -> Vec<&str> {
    let mut items: Vec<&str> = list.split(';').collect();
    if items.last().is_some_and(|last| last.is_empty()) {
        items.pop();
    }
    items
}

pub fn joined<'a>(items: impl IntoIterator<Item = &'a str>) -> Value {
    let mut out = String::new();
    for item in items {
        out.push_str(item);
        out.push(';');
    }
    Value::text(out)
}

fn matches(item: &str, wanted: &str) -> bool {
    match (wanted.strip_prefix('*'), wanted.strip_suffix('*')) {
        (Some(_), Some(_)) => item.contains(wanted.trim_matches('*')),
        (Some(end), None) => item.ends_with(end),
        (None, Some(start)) => item.starts_with(start),
        (None, None) => item == wanted,
    }
}

pub fn call(function: F, input: &Input) -> Option<Value> {
    let list = input.text(0);
    let items = items(&list);
    let wanted = input.text(1);
    let is_wanted = |item: &&&str| matches(item, &wanted);
    Some(match function {
        F::ListAdd => joined(items.iter().copied().chain([&*wanted])),
        F::ListClean => joined(items.into_iter().filter(|item| !item.is_empty())),
        F::ListCount => Value::Float(items.iter().filter(is_wanted).count() as f64),
        F::ListFirst => Value::text(items.first().copied().unwrap_or("")),
        F::ListLast => Value::text(items.last().copied().unwrap_or("")),
        F::ListItem => Value::text(at(input.float(1)).and_then(|i| items.get(i)).copied().unwrap_or("")),
        F::ListIndex => Value::Float(items.iter().position(|item| matches(item, &wanted)).map_or(-1.0, |i| i as f64)),
        F::ListRange => {
            let bound = |i: usize| input.float(i).clamp(0.0, items.len() as f64) as usize;
            let (from, to) = (bound(1), bound(2));
            joined(items.iter().copied().take(to).skip(from))
        }
        F::ListRemove => {
            let first = items.iter().position(|item| matches(item, &wanted));
            joined(items.iter().enumerate().filter(|(i, _)| Some(*i) != first).map(|(_, item)| *item))
        }
        F::ListRemoveAll => joined(items.iter().filter(|item| !matches(item, &wanted)).copied()),
        F::ListRetainAll => joined(items.iter().filter(is_wanted).copied()),
        F::ListSize => Value::Float(items.len() as f64),
        F::ListTerminate => joined(items),
        F::ListFromArray => {
            let strings = input.any(0).to_strings();
            joined(strings.items.iter().map(|s| &**s))
        }
        F::ListToArray => Value::strings(items.into_iter().map(Into::into).collect()),
        _ => return None,
    })
}

fn at(index: f64) -> Option<usize> {
    (index >= 0.0).then_some(index as usize)
}

/// `listRandom(list)`; `unit` is the draw in [0, 1).
pub fn random(input: &Input, unit: f64) -> Value {
    let list = input.text(0);
    let items = items(&list);
    Value::text(items.get((unit * items.len() as f64) as usize).copied().unwrap_or(""))
}
