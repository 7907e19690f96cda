//! Features. In: what both sides made of every map object. Out: who came and went, and whose rules, change or outcome
//! differ.

use serde::Serialize;

use super::rules::Fate;
use super::snapshot::{FeatureSnapshot, SceneSnapshot};

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FeatureDifference {
    pub feature: String,
    pub class: String,
    pub fate: Fate,
    /// What differs: its name, in A, in B.
    pub differs: Vec<(&'static str, String, String)>,
}

/// What differs between the features of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FeaturesDifference {
    pub count_a: usize,
    pub count_b: usize,
    /// Change, share drawn in A and in B, where they differ.
    pub shares: Vec<(String, Option<f64>, Option<f64>)>,
    /// Those that came and went first.
    pub features: Vec<FeatureDifference>,
}

impl FeaturesDifference {
    pub fn is_none(&self) -> bool {
        self.shares.is_empty() && self.features.is_empty()
    }

    pub fn count(&self, fate: Fate) -> usize {
        self.features.iter().filter(|feature| feature.fate == fate).count()
    }
}

/// Compares the features of a scene.
pub fn compare_features(a: &SceneSnapshot, b: &SceneSnapshot) -> FeaturesDifference {
    let mut names: Vec<&String> = a.features.keys().chain(b.features.keys()).collect();
    names.sort();
    names.dedup();
    let mut features: Vec<FeatureDifference> =
        names.into_iter().filter_map(|name| difference(name, a.features.get(name), b.features.get(name))).collect();
    features.sort_by(|x, y| x.fate.cmp(&y.fate).then_with(|| x.feature.cmp(&y.feature)));
    let mut changes: Vec<&String> = a.shares.keys().chain(b.shares.keys()).collect();
    changes.sort();
    changes.dedup();
    let share = |name: &String| {
        let (a, b) = (a.shares.get(name).copied(), b.shares.get(name).copied());
        (a != b).then(|| (name.clone(), a, b))
    };
    let shares = changes.into_iter().filter_map(share).collect();
    FeaturesDifference { count_a: a.features.len(), count_b: b.features.len(), shares, features }
}

fn difference(name: &str, a: Option<&FeatureSnapshot>, b: Option<&FeatureSnapshot>) -> Option<FeatureDifference> {
    let class = b.or(a)?.class.clone();
    let of = |fate, differs| Some(FeatureDifference { feature: name.to_owned(), class, fate, differs });
    let (Some(a), Some(b)) = (a, b) else {
        return of(if a.is_some() { Fate::Removed } else { Fate::Added }, Vec::new());
    };
    let nothing = |text: &str| if text.is_empty() { "none".to_owned() } else { text.to_owned() };
    let mut differs = Vec::new();
    let mut add = |what, a: &str, b: &str| {
        if a != b {
            differs.push((what, nothing(a), nothing(b)));
        }
    };
    add("class", &a.class, &b.class);
    if let (Some(a), Some(b)) = (&a.rule, &b.rule) {
        add("rules", a, b);
    }
    add("change", &a.change, &b.change);
    add("outcome", &a.outcome, &b.outcome);
    if differs.is_empty() { None } else { of(Fate::Changed, differs) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(features: &[(&str, Option<&str>, &str, &str)]) -> SceneSnapshot {
        let one = |(name, rule, change, outcome): &(&str, Option<&str>, &str, &str)| {
            let feature = FeatureSnapshot {
                class: "building".to_owned(),
                rule: rule.map(str::to_owned),
                change: (*change).to_owned(),
                outcome: (*outcome).to_owned(),
            };
            ((*name).to_owned(), feature)
        };
        SceneSnapshot { features: features.iter().map(one).collect(), ..SceneSnapshot::default() }
    }

    #[test]
    fn features_come_go_and_change() {
        let a = scene(&[("way/1", Some("a"), "", "ok"), ("way/2", Some("a"), "", "ok"), ("way/3", None, "", "ok")]);
        let b = scene(&[
            ("way/2", Some("b"), "burnt", "skipped: x"),
            ("way/3", Some("b"), "", "ok"),
            ("way/4", None, "", "ok"),
        ]);
        let found = compare_features(&a, &b);
        let told: Vec<_> = found.features.iter().map(|f| (f.feature.as_str(), f.fate, f.differs.len())).collect();
        assert_eq!(told, [("way/1", Fate::Removed, 0), ("way/4", Fate::Added, 0), ("way/2", Fate::Changed, 3)]);
        assert_eq!(found.features[2].differs[1], ("change", "none".to_owned(), "burnt".to_owned()));
        assert!(compare_features(&a, &a).is_none());
    }
}
