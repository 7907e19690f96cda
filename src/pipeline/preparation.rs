//! Features → start shapes. In: a scene's features with their rules and changes. Out: per feature a [`Prepared`] lot
//! with a start shape for every state it has, and what was assumed for it.

use std::sync::Arc;

use rayon::prelude::*;

use super::lot::Lot;
use super::memory::Memory;
use super::place::Site;
use super::recipe::Recipe;
use crate::cga::program::Program;
use crate::geodata::feature::{Feature, FeatureClass, FeatureId};
use crate::geodata::ledger::{Ledger, Outcome};
use crate::geodata::tags::{self, Defaults, TagValue};
use crate::interpreter::host::{EdgeAttribute, EdgeValues};
use crate::interpreter::seed::Seed;
use crate::interpreter::tree::Scalar;
use crate::interpreter::{HostData, StartShape};
use crate::plan::change::{ChangeRecord, Changed, draw_changes};
use crate::scene::Presence;
use crate::spec::render_spec::{
    AttributeValue, ChangeSpec, DrawnValue, LevelEffect, MissingTag, RuleAssignment, SceneSpec, ValueSpec,
};

/// A feature before its derivation.
pub struct Prepared {
    /// `Ok`, or why there is nothing to derive.
    pub outcome: Outcome,
    pub lot: Option<Arc<Lot>>,
    /// None without a lot; one, or one before a change and one after it.
    pub states: Vec<PreparedState>,
    /// Assumptions only.
    ledger: Ledger,
}

/// A state of a feature before its derivation.
pub struct PreparedState {
    pub state: State,
    /// Key of the program.
    pub program: Arc<str>,
    pub start: Arc<StartShape>,
}

/// What a recipe makes of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Assignment {
    pub feature: FeatureId,
    pub class: FeatureClass,
    /// Index into the scene's rules.
    pub rule: Option<usize>,
    pub change: Option<Changed>,
}

/// All features of a scene.
pub struct PreparedScene {
    /// In the order of the features.
    pub features: Vec<Prepared>,
    /// Likewise.
    pub assignments: Vec<Assignment>,
    /// Assumptions only.
    pub ledger: Ledger,
    /// Changes as they were drawn.
    pub drawn: Vec<ChangeRecord>,
}

/// The prepared features and what they were made from.
pub(super) struct KeptPreparation {
    from: PreparationKey,
    site: Arc<Site>,
    prepared: Arc<PreparedScene>,
}

/// Everything that start shapes depend on besides the site.
#[derive(PartialEq)]
struct PreparationKey {
    seed: u64,
    rules: Vec<RuleAssignment>,
    missing: Vec<MissingTag>,
    changes: Vec<ChangeSpec>,
    /// Programs that ask for the streets along edges.
    curious: Vec<Arc<str>>,
}

/// A state of a feature.
#[derive(Clone, Copy, Debug)]
pub struct State {
    pub presence: Presence,
    /// Number of the change from 1, 0 for none.
    pub change: u16,
    /// Number of the level from 1, 0 for none.
    pub level: u8,
    /// A feature's reports count once: in its state before, or after where it is built new.
    pub counts: bool,
}

/// Start shapes of all features of a scene; those of the build before where nothing of them changed.
pub(super) fn prepare(recipe: &Recipe, scene: &SceneSpec, site: &Arc<Site>, memory: &mut Memory) -> Arc<PreparedScene> {
    let curious = recipe.programs.keys().filter(|key| recipe.programs.with_key(key).needs().edges);
    let from = PreparationKey {
        seed: scene.seed,
        rules: scene.rules.clone(),
        missing: scene.missing.clone(),
        changes: recipe.spec.changes.clone(),
        curious: curious.cloned().collect(),
    };
    if let Some(kept) = memory.prepared.as_ref().filter(|kept| Arc::ptr_eq(&kept.site, site) && kept.from == from) {
        return kept.prepared.clone();
    }
    let prepared = Arc::new(Preparation::new(recipe, scene, site).all());
    if memory.keeps {
        memory.prepared = Some(KeptPreparation { from, site: site.clone(), prepared: prepared.clone() });
    }
    prepared
}

/// Everything the start shape of a feature depends on.
struct Preparation<'a> {
    recipe: &'a Recipe,
    scene: &'a SceneSpec,
    site: &'a Site,
    defaults: Defaults,
    seed: Seed,
}

impl<'a> Preparation<'a> {
    fn new(recipe: &'a Recipe, scene: &'a SceneSpec, site: &'a Site) -> Self {
        let seed = Seed::root(scene.seed).named("feature");
        Preparation { recipe, scene, site, defaults: Defaults::default(), seed }
    }

    fn all(&self) -> PreparedScene {
        let features = &self.site.place.features;
        let assigned = assign(&self.scene.rules, features);
        let with_rules: Vec<usize> = (0..features.len()).filter(|&i| assigned[i].is_some()).collect();
        let candidate = |&i: &usize| (features[i].id, features[i].class, &features[i].tags);
        let candidates: Vec<_> = with_rules.iter().map(candidate).collect();
        let (changed, drawn) = draw_changes(&self.recipe.spec, self.scene, &candidates);
        let mut touched = vec![None; features.len()];
        for (i, change) in with_rules.into_iter().zip(changed) {
            touched[i] = change;
        }
        let numbers = (0..features.len()).into_par_iter();
        let mut prepared: Vec<Prepared> =
            numbers.map(|number| self.feature(number, assigned[number], touched[number])).collect();
        let mut ledger = Ledger::default();
        for feature in &mut prepared {
            ledger.merge(std::mem::take(&mut feature.ledger));
        }
        let of = |(number, feature): (usize, &Feature)| Assignment {
            feature: feature.id,
            class: feature.class,
            rule: assigned[number],
            change: touched[number],
        };
        let assignments = features.iter().enumerate().map(of).collect();
        PreparedScene { features: prepared, assignments, ledger, drawn }
    }

    fn feature(&self, number: usize, rule: Option<usize>, touched: Option<Changed>) -> Prepared {
        let feature = &self.site.place.features[number];
        let mut out = Prepared { outcome: Outcome::Ok, lot: None, states: Vec::new(), ledger: Ledger::default() };
        let Some(rule) = rule else {
            out.outcome = Outcome::Skipped("no rule of the recipe is for it".to_owned());
            return out;
        };
        let lot = match self.site.lot(number) {
            Ok(lot) => lot,
            Err(why) => {
                out.outcome = Outcome::Skipped(why);
                return out;
            }
        };
        let own = &self.scene.rules[rule];
        match touched {
            None => self.state(feature, &lot, own, (Presence::Both, 0, 0), &mut out),
            Some(touched) => {
                let change = &self.recipe.spec.changes[touched.change];
                let key = |presence| (presence, touched.change as u16 + 1, touched.level as u8 + 1);
                let effect = &change.levels[touched.level].effect;
                if !matches!(effect, LevelEffect::Built) {
                    self.state(feature, &lot, own, key(Presence::BeforeOnly), &mut out);
                }
                if let Some(after) = after(feature, own, effect) {
                    self.state(feature, &lot, after, key(Presence::AfterOnly), &mut out);
                }
            }
        }
        out.lot = Some(lot);
        out
    }

    fn state(
        &self,
        feature: &Feature,
        lot: &Lot,
        rule: &RuleAssignment,
        (presence, change, level): (Presence, u16, u8),
        out: &mut Prepared,
    ) {
        let counts = presence != Presence::AfterOnly || out.states.is_empty();
        let attributes = self.attributes(feature, rule, if counts { Some(&mut out.ledger) } else { None });
        let (key, program) = self.recipe.programs.entry(&rule.file);
        let start = StartShape {
            mesh: lot.mesh.clone(),
            start_rule: rule.start.clone(),
            attributes,
            seed: self.seed.named(&feature.id.to_string()),
            name: feature.id.to_string().into(),
            host: self.host(lot, program),
        };
        let state = State { presence, change, level, counts };
        out.states.push(PreparedState { state, program: key.clone(), start: start.into() });
    }

    fn host(&self, lot: &Lot, program: &Program) -> HostData {
        let streets = program.needs().edges.then(|| self.site.streets());
        let mut known = streets.map_or_else(HostData::default, |streets| streets.of_edges(&lot.mesh));
        if program.needs().edges && !lot.map_edges.is_empty() {
            let values = EdgeValues::Floats(lot.map_edges.iter().map(|&number| number as f64).collect());
            known.edge_attributes.push(EdgeAttribute { name: "mapEdge".into(), values });
        }
        HostData { place: Some(self.site.on_earth.clone()), ..known }
    }

    /// The attributes of a start shape: tags, defaults of the recipe, then the assignment's own values.
    fn attributes(
        &self,
        feature: &Feature,
        rule: &RuleAssignment,
        ledger: Option<&mut Ledger>,
    ) -> Vec<(Arc<str>, Scalar)> {
        let mut unused = Ledger::default();
        let ledger = ledger.unwrap_or(&mut unused);
        let seed = self.seed.named(&feature.id.to_string());
        let mut filled = feature.clone();
        for missing in &self.scene.missing {
            let taken = missing.filter.matches(feature.class, &feature.tags, feature.id);
            if taken && !filled.tags.contains_key(missing.tag.as_str()) {
                let value = drawn_text(&missing.value.draw(seed.named("missing").named(&missing.tag)));
                ledger.assume(format!("{}: filled by the recipe", missing.tag));
                filled.tags.insert(missing.tag.as_str().into(), value.into());
            }
        }
        let mut list: Vec<(Arc<str>, Scalar)> = Vec::new();
        for (name, value) in tags::attributes(&filled, &self.defaults, ledger) {
            let value = match value {
                TagValue::Number(x) => Scalar::Float(x),
                TagValue::Bool(b) => Scalar::Bool(b),
                TagValue::Text(text) => Scalar::String(text),
            };
            set(&mut list, name, value);
        }
        for attribute in &rule.attributes {
            let draw = |value: &ValueSpec| scalar(value.draw(seed.named("attribute").named(&attribute.name)));
            let value = match &attribute.value {
                AttributeValue::Value(value) => Some(draw(value)),
                AttributeValue::Tag { key, default } => match filled.tags.get(key.as_str()) {
                    Some(text) => Some(Scalar::String(text.clone())),
                    None => default.as_ref().map(draw),
                },
            };
            if let Some(value) = value {
                set(&mut list, attribute.name.as_str().into(), value);
            }
        }
        list
    }
}

/// The rules of the state *after*; `None` where the feature is gone.
fn after<'a>(feature: &Feature, own: &'a RuleAssignment, effect: &'a LevelEffect) -> Option<&'a RuleAssignment> {
    match effect {
        LevelEffect::Rules(rules) => rules.iter().find(|r| r.filter.matches(feature.class, &feature.tags, feature.id)),
        LevelEffect::Demolished => None,
        LevelEffect::Built => Some(own),
    }
}

fn set(list: &mut Vec<(Arc<str>, Scalar)>, name: Arc<str>, value: Scalar) {
    match list.iter_mut().find(|(n, _)| *n == name) {
        Some((_, old)) => *old = value,
        None => list.push((name, value)),
    }
}

fn scalar(value: DrawnValue) -> Scalar {
    match value {
        DrawnValue::Number(x) => Scalar::Float(x),
        DrawnValue::Bool(b) => Scalar::Bool(b),
        DrawnValue::Text(text) => Scalar::String(text.into()),
    }
}

fn drawn_text(value: &DrawnValue) -> String {
    match value {
        DrawnValue::Number(x) => x.to_string(),
        DrawnValue::Bool(b) => if *b { "yes" } else { "no" }.to_owned(),
        DrawnValue::Text(text) => text.clone(),
    }
}

/// Index of the first rule that takes each feature.
fn assign(rules: &[RuleAssignment], features: &[Feature]) -> Vec<Option<usize>> {
    features.iter().map(|f| rules.iter().position(|r| r.filter.matches(f.class, &f.tags, f.id))).collect()
}
