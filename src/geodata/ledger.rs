//! The ledger of a run: what became of every feature, by its map identity. Nothing disappears silently.

use std::collections::BTreeMap;

use serde::Serialize;

/// What became of one feature at one stage.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "outcome", content = "detail", rename_all = "snake_case")]
pub enum Outcome {
    Ok,
    /// Used after a repair; says what was done.
    Repaired(String),
    /// Used in a simpler form; says which and why.
    FellBack(String),
    /// Not used; says why.
    Skipped(String),
    /// Used with defects that mesh checks found, where they were asked for; says which.
    Invalid(String),
}

/// One line: a feature that was not simply ok.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// `way/123`, `relation/7#1`.
    pub feature: String,
    #[serde(flatten)]
    pub outcome: Outcome,
}

/// Counts of all features and a line for each that was not simply ok.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Ledger {
    pub ok: usize,
    pub repaired: usize,
    pub fell_back: usize,
    pub skipped: usize,
    /// Only where meshes were checked.
    #[serde(skip_serializing_if = "is_none")]
    pub invalid: usize,
    pub entries: Vec<Entry>,
    /// How many values were assumed because tags were missing: `height: default 6 m` → count, sorted.
    pub assumptions: BTreeMap<String, usize>,
}

fn is_none(count: &usize) -> bool {
    *count == 0
}

impl Ledger {
    /// How many features had this kind of outcome.
    fn count(&mut self, outcome: &Outcome) -> &mut usize {
        match outcome {
            Outcome::Ok => &mut self.ok,
            Outcome::Repaired(_) => &mut self.repaired,
            Outcome::FellBack(_) => &mut self.fell_back,
            Outcome::Skipped(_) => &mut self.skipped,
            Outcome::Invalid(_) => &mut self.invalid,
        }
    }

    pub fn record(&mut self, feature: impl ToString, outcome: Outcome) {
        *self.count(&outcome) += 1;
        if outcome == Outcome::Ok {
            return;
        }
        self.entries.push(Entry { feature: feature.to_string(), outcome });
    }

    /// Replaces what became of features by something worse that a later stage found; `Ok` changes nothing.
    pub fn revise(&mut self, revisions: impl IntoIterator<Item = (String, Outcome)>) {
        let known: BTreeMap<String, usize> =
            self.entries.iter().enumerate().map(|(i, e)| (e.feature.clone(), i)).collect();
        for (feature, outcome) in revisions.into_iter().filter(|(_, outcome)| *outcome != Outcome::Ok) {
            let Some(&known) = known.get(&feature) else {
                self.ok = self.ok.saturating_sub(1);
                self.record(feature, outcome);
                continue;
            };
            *self.count(&outcome) += 1;
            let before = std::mem::replace(&mut self.entries[known].outcome, outcome);
            *self.count(&before) -= 1;
        }
    }

    pub fn assume(&mut self, what: impl Into<String>) {
        *self.assumptions.entry(what.into()).or_default() += 1;
    }

    /// Adds another ledger's counts and lines after these.
    pub fn merge(&mut self, other: Ledger) {
        self.ok += other.ok;
        self.repaired += other.repaired;
        self.fell_back += other.fell_back;
        self.skipped += other.skipped;
        self.invalid += other.invalid;
        self.entries.extend(other.entries);
        for (what, count) in other.assumptions {
            *self.assumptions.entry(what).or_default() += count;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_feature_counts_once_whatever_later_stages_find() {
        let mut ledger = Ledger::default();
        for id in ["way/1", "way/2"] {
            ledger.record(id, Outcome::Ok);
        }
        ledger.record("way/3", Outcome::Repaired("spike".into()));
        ledger.revise([
            ("way/1".to_owned(), Outcome::Ok),
            ("way/2".to_owned(), Outcome::Skipped("rules".into())),
            ("way/3".to_owned(), Outcome::Skipped("rules".into())),
        ]);
        assert_eq!((ledger.ok, ledger.repaired, ledger.skipped), (1, 0, 2));
        assert_eq!(ledger.entries.len(), 2);
    }
}
