//! Which derivations a changed attribute concerns. In: the attributes of two programs. Out: whether a derivation gives the
//! same under both.
//!
//! Every default is computed once per start shape, unless the host gives a value. A default that is a literal has no
//! effect but its value, which matters only to what may read it; any other may warn, and concerns every derivation.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::programs::Facts;
use crate::cga::program::fingerprint::AttributePrint;
use crate::interpreter::tree::Scalar;
use crate::interpreter::used::{Bits, Used};

/// Attributes that are new or not what they were.
pub struct AttributeChanges {
    changed: Vec<Changed>,
}

struct Changed {
    name: Arc<str>,
    kind: Kind,
}

enum Kind {
    /// What the host may give is another matter now.
    Declaration,
    /// `old` is the number in the old program.
    Default {
        old: u32,
        takes_host: bool,
        is_literal: bool,
    },
    New {
        is_literal: bool,
    },
}

impl AttributeChanges {
    pub fn between(old: &Facts, new: &Facts) -> AttributeChanges {
        let known: BTreeMap<&str, (u32, &AttributePrint)> =
            (0..).zip(&old.attributes).map(|(number, attribute)| (&*attribute.name, (number, attribute))).collect();
        let change = |new: &AttributePrint| {
            let &AttributePrint { ref name, declared, default, takes_host, is_literal, reads: _ } = new;
            let kind = match known.get(&**name) {
                None => Kind::New { is_literal },
                Some((_, old)) if old.declared != declared => Kind::Declaration,
                Some(&(number, old)) if old.default != default => Kind::Default { old: number, takes_host, is_literal },
                Some(_) => return None,
            };
            Some(Changed { name: name.clone(), kind })
        };
        AttributeChanges { changed: new.attributes.iter().filter_map(change).collect() }
    }

    /// Whether a derivation under the old program does not notice.
    pub fn spare(&self, old: &Facts, used: &Used, host: &[(Arc<str>, Scalar)]) -> bool {
        let mut reads: Option<Bits> = None;
        self.changed.iter().all(|Changed { name, kind }| {
            let given = host.iter().any(|(other, _)| other == name);
            match *kind {
                Kind::Declaration => false,
                Kind::Default { takes_host: true, .. } if given => true,
                Kind::Default { old: number, is_literal, .. } => {
                    let reads = reads.get_or_insert_with(|| old.reads(used));
                    is_literal && !reads.contains(number)
                }
                Kind::New { is_literal } => is_literal && !given,
            }
        })
    }
}
