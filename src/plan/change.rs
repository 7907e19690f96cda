//! In: the changes of a recipe and the features of a scene. Out: which features change, in which degree.
//!
//! Every map object has a rank of its own in every change, so a share is met exactly, and an object more or less on
//! the map does not reshuffle the others.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::geodata::feature::{FeatureClass, FeatureId, ObjectKind, Tags};
use crate::geodata::tags::OUTLINE_KEY;
use crate::interpreter::seed::Seed;
use crate::spec::draw::pick;
use crate::spec::render_spec::{Amount, ChangeSpec, LevelEffect, LevelSpec, RenderSpec, SceneSpec};

/// A feature's change: indices into [`RenderSpec::changes`] and [`ChangeSpec::levels`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Changed {
    pub change: usize,
    pub level: usize,
}

/// What a change came to in one scene, for the manifest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChangeRecord {
    pub change: String,
    /// Map objects that the change is `of`.
    pub candidates: usize,
    /// The share that was drawn, 0..1; for a count what it comes to.
    pub share: f64,
    /// Objects that were drawn.
    pub drawn: usize,
    /// Of those, objects that an earlier change has.
    pub overruled: usize,
}

/// A feature as changes see it.
pub type Candidate<'a> = (FeatureId, FeatureClass, &'a Tags);

type Object = (ObjectKind, i64);

/// The change of every feature, in the features' order. All parts of one map object change together; where two changes
/// draw one object, the first of the recipe has it.
pub fn draw_changes(
    spec: &RenderSpec,
    scene: &SceneSpec,
    features: &[Candidate],
) -> (Vec<Option<Changed>>, Vec<ChangeRecord>) {
    let mut taken: BTreeMap<Object, Changed> = BTreeMap::new();
    let mut records = Vec::new();
    for (number, change) in spec.changes.iter().enumerate() {
        let seed = Seed::root(scene.seed).named("change").named(&change.name);
        let (candidates, share, drawn) = select_changed(change, features, seed);
        let weights: Vec<f64> = change.levels.iter().map(|level| level.weight).collect();
        let before = taken.len();
        for object in &drawn {
            let level = pick(&weights, object_seed(seed, *object).named("level"));
            taken.entry(*object).or_insert(Changed { change: number, level });
        }
        let overruled = drawn.len() - (taken.len() - before);
        let record = ChangeRecord { change: change.name.clone(), candidates, share, drawn: drawn.len(), overruled };
        records.push(record);
    }
    let of = |candidate: &Candidate| {
        let (id, class, tags) = candidate;
        let changed = taken.get(&object(candidate)).copied()?;
        // Another feature of the same object, such as a landuse around its building, is not touched.
        can_change(&spec.changes[changed.change], *id, *class, tags).then_some(changed)
    };
    (features.iter().map(of).collect(), records)
}

/// Whether a change is of this feature and has something to make of it at every level.
fn can_change(change: &ChangeSpec, id: FeatureId, class: FeatureClass, tags: &Tags) -> bool {
    let has_effect = |level: &LevelSpec| match &level.effect {
        LevelEffect::Rules(rules) => rules.iter().any(|rule| rule.filter.matches(class, tags, id)),
        LevelEffect::Demolished | LevelEffect::Built => true,
    };
    change.of.matches(class, tags, id) && change.levels.iter().all(has_effect)
}

/// The number of candidates, the share drawn, and the objects that change, by rank.
fn select_changed(change: &ChangeSpec, features: &[Candidate], seed: Seed) -> (usize, f64, Vec<Object>) {
    let matching = features.iter().filter(|(id, class, tags)| can_change(change, *id, *class, tags));
    let mut ranked: Vec<(u64, Object)> = matching
        .map(|candidate| {
            let object = object(candidate);
            (object_seed(seed, object).named("rank").bits(), object)
        })
        .collect();
    ranked.sort_unstable();
    ranked.dedup();
    let total = ranked.len();
    let wanted = match &change.amount {
        Amount::All => total as f64,
        Amount::Share(share) => share.draw(seed.named("share")) * total as f64,
        Amount::Count(count) => count.draw(seed.named("count")),
    };
    // Half an object counts as one.
    let wanted = (wanted + 0.5).floor().clamp(0.0, total as f64) as usize;
    let share = match &change.amount {
        Amount::Share(share) => share.draw(seed.named("share")),
        Amount::All | Amount::Count(_) if total == 0 => 0.0,
        Amount::All | Amount::Count(_) => wanted as f64 / total as f64,
    };
    (total, share, ranked.into_iter().take(wanted).map(|(_, object)| object).collect())
}

/// The map object that a feature changes with: building parts change with the building they belong to.
fn object((id, _, tags): &Candidate) -> Object {
    let outline = tags.get(OUTLINE_KEY).and_then(|outline| {
        let (kind, number) = outline.split_once('/')?;
        let kind = match kind {
            "way" => ObjectKind::Way,
            "relation" => ObjectKind::Relation,
            _ => return None,
        };
        Some((kind, number.split('#').next()?.parse().ok()?))
    });
    outline.unwrap_or((id.kind, id.id))
}

fn object_seed(seed: Seed, (kind, id): Object) -> Seed {
    let kind = match kind {
        ObjectKind::Node => "node",
        ObjectKind::Way => "way",
        ObjectKind::Relation => "relation",
        ObjectKind::Feature => "feature",
    };
    seed.named(kind).part(id as u64)
}
