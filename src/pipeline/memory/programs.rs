//! What changed from one program to the next. In: the fingerprints of both. Out: which items a derivation must not have
//! used to be still valid, and the new numbers of those it used.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::attributes::AttributeChanges;
use crate::cga::program::Program;
use crate::cga::program::fingerprint::{AttributePrint, Fingerprint, ItemPrint};
use crate::interpreter::tree::Scalar;
use crate::interpreter::used::{Bits, Used};

/// What is known of a program.
pub struct Facts {
    /// Hash of all its texts with their places in the source map: where it is equal, messages are too.
    identity: [u8; 32],
    whole: Fingerprint,
    rules: Vec<Item>,
    functions: Vec<Item>,
    pub(super) attributes: Vec<AttributePrint>,
    /// Path of the rule that derivations start with if the host names none.
    start: Option<Arc<str>>,
}

struct Item {
    path: Arc<str>,
    print: Fingerprint,
    reads: Bits,
}

impl Facts {
    pub fn new(program: &Program, identity: [u8; 32]) -> Facts {
        let prints = program.fingerprints();
        let item = |print: ItemPrint| {
            let ItemPrint { path, print, reads } = print;
            Item { path, print, reads: reads.into_iter().map(|id| id.0).collect() }
        };
        Facts {
            identity,
            whole: prints.whole,
            rules: prints.rules.into_iter().map(item).collect(),
            functions: prints.functions.into_iter().map(item).collect(),
            attributes: prints.attributes,
            start: program.start(None).map(|id| program.rule(id).path.clone()),
        }
    }

    pub fn identity(&self) -> &[u8; 32] {
        &self.identity
    }

    /// Attributes that these rules and functions may read, directly or through defaults.
    pub(super) fn reads(&self, used: &Used) -> Bits {
        let mut reads = Bits::default();
        used.rules.iter().for_each(|id| reads.join(&self.rules[id as usize].reads));
        used.functions.iter().for_each(|id| reads.join(&self.functions[id as usize].reads));
        let mut waiting: Vec<u32> = reads.iter().collect();
        while let Some(id) = waiting.pop() {
            for next in &self.attributes[id as usize].reads {
                if !reads.contains(next.0) {
                    reads.insert(next.0);
                    waiting.push(next.0);
                }
            }
        }
        reads
    }
}

/// From an old program to a new one.
pub struct Changes {
    /// Texts and places are the same.
    pub is_same: bool,
    whole: bool,
    start: bool,
    /// Old numbers → new numbers; `None` for what is gone or does something else.
    rules: Vec<Option<u32>>,
    functions: Vec<Option<u32>>,
    attributes: AttributeChanges,
}

impl Changes {
    pub fn between(old: &Facts, new: &Facts) -> Changes {
        Changes {
            is_same: old.identity == new.identity,
            whole: old.whole == new.whole,
            start: old.start == new.start,
            rules: numbers(&old.rules, &new.rules),
            functions: numbers(&old.functions, &new.functions),
            attributes: AttributeChanges::between(old, new),
        }
    }

    /// The new numbers of what a derivation used; `None` if any of it does something else now. `host` are the values that
    /// it was given, `names_start` whether the host named its start rule.
    pub fn follow(&self, old: &Facts, used: &Used, host: &[(Arc<str>, Scalar)], names_start: bool) -> Option<Used> {
        if self.is_same {
            return Some(used.clone());
        }
        if !self.whole || !(names_start || self.start) {
            return None;
        }
        let rules: Option<Bits> = used.rules.iter().map(|id| self.rules[id as usize]).collect();
        let functions: Option<Bits> = used.functions.iter().map(|id| self.functions[id as usize]).collect();
        let followed = Used { rules: rules?, functions: functions? };
        self.attributes.spare(old, used, host).then_some(followed)
    }
}

fn numbers(old: &[Item], new: &[Item]) -> Vec<Option<u32>> {
    let known: BTreeMap<(&str, Fingerprint), u32> =
        (0..).zip(new).map(|(number, item)| ((&*item.path, item.print), number)).collect();
    old.iter().map(|item| known.get(&(&*item.path, item.print)).copied()).collect()
}
