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
    pub entries: Vec<Entry>,
    /// How many values were assumed because tags were missing: `height: default 6 m` → count, sorted.
    pub assumptions: BTreeMap<String, usize>,
}

impl Ledger {
    pub fn record(&mut self, feature: impl ToString, outcome: Outcome) {
        match outcome {
            Outcome::Ok => {
                self.ok += 1;
                return;
            }
            Outcome::Repaired(_) => self.repaired += 1,
            Outcome::FellBack(_) => self.fell_back += 1,
            Outcome::Skipped(_) => self.skipped += 1,
        }
        self.entries.push(Entry { feature: feature.to_string(), outcome });
    }

    /// Replaces what became of features by something worse that a later stage found; `Ok` changes nothing.
    pub fn revise(&mut self, revisions: impl IntoIterator<Item = (String, Outcome)>) {
        let known: BTreeMap<String, usize> =
            self.entries.iter().enumerate().map(|(i, e)| (e.feature.clone(), i)).collect();
        for (feature, outcome) in revisions.into_iter().filter(|(_, outcome)| *outcome != Outcome::Ok) {
            let entry = known.get(&feature).map(|i| &mut self.entries[*i]);
            match entry.as_ref().map(|e| &e.outcome) {
                None | Some(Outcome::Ok) => self.ok = self.ok.saturating_sub(1),
                Some(Outcome::Repaired(_)) => self.repaired -= 1,
                Some(Outcome::FellBack(_)) => self.fell_back -= 1,
                Some(Outcome::Skipped(_)) => self.skipped -= 1,
            }
            match entry {
                Some(entry) => {
                    entry.outcome = outcome;
                    match &entry.outcome {
                        Outcome::Ok => self.ok += 1,
                        Outcome::Repaired(_) => self.repaired += 1,
                        Outcome::FellBack(_) => self.fell_back += 1,
                        Outcome::Skipped(_) => self.skipped += 1,
                    }
                }
                None => self.record(feature, outcome),
            }
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
