//! Rules of the main file that no start rule leads to. Decided only where the file says which rules start it; rules of
//! imported files are a library and may rest.

use std::collections::BTreeSet;

use super::super::instance::Tables;
use super::super::walk::items;
use crate::cga::codes;
use crate::cga::program::{Item, Program, RuleId};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::Span;

/// Symbols that hosts start with, whatever a file marks (reference 2.1, Start).
const HOST_SYMBOLS: &[&str] = &[
    "Lot",
    "LotInner",
    "LotCorner",
    "Street",
    "Sidewalk",
    "Crossing",
    "Junction",
    "Joint",
    "Freeway",
    "FreewayEntry",
    "Roundabout",
    "RoundaboutIsland",
];

pub fn check(program: &Program, tables: &Tables<'_>, diagnostics: &mut Diagnostics) {
    if program.start_rules.is_empty() {
        return;
    }
    let starts = |id: &usize| {
        let entry = &tables.rules[*id];
        program.rules[*id].is_start || entry.is_extension || HOST_SYMBOLS.contains(&&*entry.name)
    };
    let roots = (0..program.rules.len()).filter(|id| tables.rules[*id].scope == 0).filter(starts);
    let reached = reached_from(program, roots);
    // One text can be several rules: an import's copy for each dynamic import call.
    let places: BTreeSet<Span> = reached.iter().map(|id| program.rules[*id].span).collect();
    for (rule, entry) in program.rules.iter().zip(&tables.rules) {
        if entry.scope == 0 && !places.contains(&rule.span) {
            let message = format!("no start rule leads to `{}`", rule.name);
            let warning = Diagnostic::warning(codes::UNUSED_RULE, rule.span, message);
            diagnostics.push(warning.help("call it, mark it `@StartRule`, or remove it"));
        }
    }
}

/// The rules that others lead to, and those others.
fn reached_from(program: &Program, roots: impl Iterator<Item = usize>) -> BTreeSet<usize> {
    let mut waiting: Vec<usize> = roots.collect();
    let mut reached: BTreeSet<usize> = waiting.iter().copied().collect();
    while let Some(id) = waiting.pop() {
        items(&program.rules[id].successor, &mut |item| {
            if let Item::Call { rule: RuleId(next), .. } | Item::Instantiate { rule: RuleId(next), .. } = item
                && reached.insert(*next as usize)
            {
                waiting.push(*next as usize);
            }
        });
    }
    reached
}
