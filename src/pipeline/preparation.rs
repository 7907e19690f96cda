//! Features → start shapes. In: a scene's features with their rules and changes. Out: per feature a [`Prepared`] lot
//! with a start shape for every state it has, and what was assumed for it.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;

use super::lot::{Lot, Relief, relief};
use super::place::Place;
use super::recipe::Recipe;
use super::streets::Streets;
use crate::cga::program::Program;
use crate::geodata::feature::{Feature, Outline};
use crate::geodata::features::ribbon::{Cap, caps};
use crate::geodata::ledger::{Ledger, Outcome};
use crate::geodata::projection::LocalFrame;
use crate::geodata::tags::{self, Defaults, TagValue};
use crate::geodata::terrain::Terrain;
use crate::interpreter::host::{EdgeAttribute, EdgeValues, Place as OnEarth};
use crate::interpreter::seed::Seed;
use crate::interpreter::tree::Scalar;
use crate::interpreter::{HostData, StartShape};
use crate::plan::change::Changed;
use crate::scene::Presence;
use crate::spec::render_spec::{AttributeValue, DrawnValue, LevelEffect, RuleAssignment, SceneSpec, ValueSpec};

/// A feature before its derivation.
pub struct Prepared<'a> {
    /// `Ok`, or why there is nothing to derive.
    pub outcome: Outcome,
    pub lot: Option<Lot>,
    /// None without a lot; one, or one before a change and one after it.
    pub states: Vec<(State, &'a Program, StartShape)>,
    /// Assumptions only.
    pub ledger: Ledger,
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

/// Everything the start shape of a feature depends on.
pub struct Preparation<'a> {
    recipe: &'a Recipe,
    scene: &'a SceneSpec,
    place: &'a Place,
    defaults: Defaults,
    seed: Seed,
    /// Relief under all parts of one building together, by its id: they share one base.
    wholes: BTreeMap<Arc<str>, Relief>,
    /// Where some rules ask for streets.
    streets: Option<Streets>,
    on_earth: Arc<dyn OnEarth>,
}

/// The scene's frame as rules see it.
#[derive(Debug)]
struct SceneFrame(LocalFrame);

impl OnEarth for SceneFrame {
    fn lon_lat(&self, x: f64, z: f64) -> Option<(f64, f64)> {
        Some(self.0.inverse(DVec2::new(x, -z)))
    }
}

impl<'a> Preparation<'a> {
    pub fn new(recipe: &'a Recipe, scene: &'a SceneSpec, place: &'a Place) -> Self {
        let asks = recipe.programs.all().any(|program| program.needs().edges);
        Preparation {
            recipe,
            scene,
            place,
            defaults: Defaults::default(),
            seed: Seed::root(scene.seed).named("feature"),
            wholes: wholes(&place.features, &place.terrain),
            streets: asks.then(|| Streets::new(&place.features)),
            on_earth: Arc::new(SceneFrame(place.frame)),
        }
    }

    fn whole(&self, feature: &Feature) -> Option<Relief> {
        self.wholes.get(feature.tags.get(tags::OUTLINE_KEY)?).copied()
    }

    pub fn feature(
        &self,
        feature: &Feature,
        ends: [Cap; 2],
        rule: Option<usize>,
        touched: Option<Changed>,
    ) -> Prepared<'a> {
        let mut out = Prepared { outcome: Outcome::Ok, lot: None, states: Vec::new(), ledger: Ledger::default() };
        let Some(rule) = rule else {
            out.outcome = Outcome::Skipped("no rule of the recipe is for it".to_owned());
            return out;
        };
        let lot = match Lot::new(feature, ends, self.whole(feature), &self.place.terrain) {
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
        out: &mut Prepared<'a>,
    ) {
        let counts = presence != Presence::AfterOnly || out.states.is_empty();
        let attributes = self.attributes(feature, rule, if counts { Some(&mut out.ledger) } else { None });
        let program = self.recipe.programs.get(&rule.file);
        let start = StartShape {
            mesh: lot.mesh.clone(),
            start_rule: rule.start.clone(),
            attributes,
            seed: self.seed.named(&feature.id.to_string()),
            name: feature.id.to_string().into(),
            host: self.host(lot, program),
        };
        out.states.push((State { presence, change, level, counts }, program, start));
    }

    fn host(&self, lot: &Lot, program: &Program) -> HostData {
        let streets = self.streets.as_ref().filter(|_| program.needs().edges);
        let mut known = streets.map_or_else(HostData::default, |streets| streets.of_edges(&lot.mesh));
        if program.needs().edges && !lot.map_edges.is_empty() {
            let values = EdgeValues::Floats(lot.map_edges.iter().map(|&number| number as f64).collect());
            known.edge_attributes.push(EdgeAttribute { name: "mapEdge".into(), values });
        }
        HostData { place: Some(self.on_earth.clone()), ..known }
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
pub fn assign(rules: &[RuleAssignment], features: &[Feature]) -> Vec<Option<usize>> {
    features.iter().map(|f| rules.iter().position(|r| r.filter.matches(f.class, &f.tags, f.id))).collect()
}

/// The relief under all parts of each building that has parts.
fn wholes(features: &[Feature], terrain: &Terrain) -> BTreeMap<Arc<str>, Relief> {
    let mut wholes: BTreeMap<Arc<str>, Relief> = BTreeMap::new();
    for feature in features {
        let (Some(whole), Outline::Area(polygon)) = (feature.tags.get(tags::OUTLINE_KEY), &feature.outline) else {
            continue;
        };
        if let Some((least, greatest)) = relief(std::slice::from_ref(polygon), terrain) {
            let known = wholes.entry(whole.clone()).or_insert((least, greatest));
            *known = (known.0.min(least), known.1.max(greatest));
        }
    }
    wholes
}

/// The ends of every feature's ribbon; only roads' are used.
pub fn road_ends(features: &[Feature]) -> Vec<[Cap; 2]> {
    let line = |f: &Feature| match &f.outline {
        Outline::Line(line) => line.clone(),
        Outline::Area(_) => Vec::new(),
    };
    let lines: Vec<Vec<DVec2>> = features.iter().map(line).collect();
    caps(&lines.iter().map(Vec::as_slice).collect::<Vec<_>>())
}
