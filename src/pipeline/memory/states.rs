//! Derivations that are kept. In: start shapes and what each derivation used. Out: those that are still valid under the
//! programs and files of the next build.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::super::build::Checks;
use super::super::derivation::Derived;
use super::super::lot::Lot;
use super::super::preparation::{PreparedState, State};
use super::super::rules::Programs;
use super::files::FileTable;
use super::programs::{Changes, Facts};
use super::questions::Questions;
use crate::geodata::feature::FeatureId;
use crate::interpreter::assets::{Assets, FileAssets};
use crate::interpreter::tree::Scalar;
use crate::interpreter::used::{Bits, Used};
use crate::interpreter::{Limits, StartShape};
use crate::scene::Presence;

/// One derivation and what it was made from.
#[derive(Clone)]
pub struct KeptState {
    pub state: State,
    pub start: Arc<StartShape>,
    pub lot: Arc<Lot>,
    /// Key of the program.
    pub program: Arc<str>,
    pub derived: Arc<Derived>,
    /// Questions about files.
    pub asked: Bits,
    pub used: Used,
    /// Of the derivation.
    pub seconds: f64,
}

pub type StateKey = (FeatureId, Presence);

/// All derivations of the last build.
#[derive(Default)]
pub struct States {
    kept: BTreeMap<StateKey, KeptState>,
    facts: BTreeMap<Arc<str>, Arc<Facts>>,
    /// What all of them were derived under.
    under: Option<(Limits, Checks)>,
    pub questions: Questions,
    /// Questions that have another answer since the last build.
    answered_anew: Bits,
    /// What the last look at all questions was based on.
    read: Vec<PathBuf>,
}

/// The programs of a build beside those of the build before.
pub struct Round {
    facts: BTreeMap<Arc<str>, Arc<Facts>>,
    changes: BTreeMap<Arc<str>, Changes>,
}

impl States {
    pub fn get(&self, key: &StateKey) -> Option<&KeptState> {
        self.kept.get(key)
    }

    /// What the derivations were bounded by.
    pub fn limits(&self) -> Option<&Limits> {
        self.under.as_ref().map(|(limits, _)| limits)
    }

    pub fn len(&self) -> usize {
        self.kept.len()
    }

    /// Whether a question about files has another answer since the last build.
    pub fn has_new_answers(&self) -> bool {
        self.answered_anew != Bits::default()
    }

    pub fn all(&self) -> impl Iterator<Item = (&StateKey, &KeptState)> {
        self.kept.iter()
    }

    /// Whether all derivations are of these programs, texts and places.
    pub fn are_of(&self, programs: &Programs) -> bool {
        let mut others = programs.identities();
        let mut own = self.facts.iter().map(|(key, facts)| (key, facts.identity()));
        !self.has_new_answers() && own.by_ref().all(|own| others.next() == Some(own)) && others.next().is_none()
    }

    /// Asks all questions about files again.
    pub fn ask_again(&mut self, assets: &FileAssets, files: &mut FileTable) {
        let read = std::mem::take(&mut self.read);
        let changed = self.questions.ask_again(assets, files, &read);
        self.answered_anew.join(&changed);
        self.read = read;
    }

    /// Compares the programs of a build with those of the last one; derivations under other limits are forgotten.
    pub fn begin(&mut self, programs: &Programs, limits: &Limits, checks: Checks) -> Round {
        if self.under.as_ref().is_none_or(|(own, of)| own != limits || *of != checks) {
            self.kept.clear();
            self.under = Some((limits.clone(), checks));
        }
        let facts: BTreeMap<Arc<str>, Arc<Facts>> = programs.facts().collect();
        let change = |(key, new): (&Arc<str>, &Arc<Facts>)| {
            let old = self.facts.get(key)?;
            Some((key.clone(), Changes::between(old, new)))
        };
        let changes = facts.iter().filter_map(change).collect();
        Round { facts, changes }
    }

    /// The derivation of a state, if it would come out the same. Of programs that ask about other shapes only the text is
    /// compared here: whether the others are the same is for the caller to know.
    pub fn valid(
        &self,
        key: &StateKey,
        new: &PreparedState,
        lot: &Arc<Lot>,
        asks: bool,
        round: &Round,
    ) -> Option<KeptState> {
        let kept = self.kept.get(key)?;
        if kept.program != new.program || !Arc::ptr_eq(&kept.lot, lot) || kept.asked.meets(&self.answered_anew) {
            return None;
        }
        if !Arc::ptr_eq(&kept.start, &new.start) && !is_same_start(&kept.start, &new.start) {
            return None;
        }
        let (changes, old) = (round.changes.get(&kept.program)?, self.facts.get(&kept.program)?);
        // Messages tell places in the text, and texts that are printed come from anywhere.
        let tells = !kept.derived.diagnostics.is_empty() || !kept.derived.prints.is_empty();
        if (asks || tells) && !changes.is_same {
            return None;
        }
        let used = changes.follow(old, &kept.used, &new.start.attributes, new.start.start_rule.is_some())?;
        Some(KeptState { state: new.state, start: new.start.clone(), used, ..kept.clone() })
    }

    /// Keeps the derivations of a build and forgets all others.
    pub fn finish(
        &mut self,
        kept: BTreeMap<StateKey, KeptState>,
        round: Round,
        assets: &FileAssets,
        files: &mut FileTable,
    ) {
        (self.kept, self.facts) = (kept, round.facts);
        self.answered_anew = Bits::default();
        self.read = assets.files();
        self.questions.learn(assets as &dyn Assets, files, &self.read);
    }
}

/// Whether two start shapes on the same lot, with the same name, are derived alike. Edges have the same data where the
/// program is equally curious about them, which its fingerprint says.
fn is_same_start(old: &StartShape, new: &StartShape) -> bool {
    let StartShape { mesh: _, start_rule, attributes, seed, name, host: _ } = old;
    let same_value = |a: &Scalar, b: &Scalar| match (a, b) {
        (Scalar::Float(a), Scalar::Float(b)) => a.to_bits() == b.to_bits(),
        (a, b) => a == b,
    };
    let mut pairs = attributes.iter().zip(&new.attributes);
    *start_rule == new.start_rule
        && *seed == new.seed
        && *name == new.name
        && attributes.len() == new.attributes.len()
        && pairs.all(|((name, a), (other, b))| name == other && same_value(a, b))
}
