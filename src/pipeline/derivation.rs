//! Features → parts. In: a scene's features with their rules and changes. Out: one [`FeatureParts`] per feature that
//! has something to show, the ledger, the reports and the mistakes met while deriving. Parallel; order and results do not
//! depend on the number of threads.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::lot::{Lot, Relief, relief};
use super::place::Place;
use super::progress::Progress;
use super::recipe::Recipe;
use crate::diagnostics::{Diagnostics, Severity};
use crate::geodata::feature::{Feature, Outline};
use crate::geodata::features::ribbon::{Cap, caps};
use crate::geodata::ledger::{Ledger, Outcome};
use crate::geodata::tags::{self, Defaults, TagValue};
use crate::geodata::terrain::Terrain;
use crate::interpreter::assets::Assets;
use crate::interpreter::limits::Limits;
use crate::interpreter::reports::Report;
use crate::interpreter::seed::Seed;
use crate::interpreter::tree::{Scalar, ShapeTree};
use crate::interpreter::{HostData, StartShape, derive};
use crate::plan::change::Changed;
use crate::scene::Presence;
use crate::scene::assemble::{FeatureParts, StateParts};
use crate::spec::render_spec::{AttributeValue, DrawnValue, LevelEffect, RuleAssignment, SceneSpec, ValueSpec};

/// Warnings after which a feature is there in a simpler form than its rules asked for.
const FALLBACKS: &[&str] =
    &["cga::roof", "cga::offset", "cga::setback", "cga::inner-rectangle", "cga::missing-asset", "cga::missing-texture"];

/// What derivation gives.
pub struct Derivation {
    pub features: Vec<FeatureParts>,
    /// What became of each feature, in the order of the features.
    pub outcomes: Vec<Outcome>,
    /// Assumptions only.
    pub ledger: Ledger,
    /// By feature, without those that reported nothing, in the order of the features.
    pub reports: Vec<(String, Vec<Report>)>,
    pub diagnostics: Diagnostics,
    /// Lines of `print`, in the order of the features.
    pub prints: Vec<String>,
}

/// One feature's share of it.
struct Derived {
    outcome: Outcome,
    states: Vec<StateParts>,
    ledger: Ledger,
    reports: Vec<Report>,
    diagnostics: Diagnostics,
    prints: Vec<String>,
}

/// Everything a feature's derivation may read.
struct Context<'a> {
    recipe: &'a Recipe,
    scene: &'a SceneSpec,
    place: &'a Place,
    assets: &'a dyn Assets,
    limits: Limits,
    defaults: Defaults,
    seed: Seed,
    /// Relief under all parts of one building together, by its id: they share one base.
    wholes: BTreeMap<Arc<str>, Relief>,
}

/// Index of the first rule that takes each feature.
pub fn assign(rules: &[RuleAssignment], features: &[Feature]) -> Vec<Option<usize>> {
    features.iter().map(|f| rules.iter().position(|r| r.filter.matches(f.class, &f.tags, f.id))).collect()
}

/// Derives all features of a scene in all their states.
pub fn derive_features(
    recipe: &Recipe,
    scene: &SceneSpec,
    place: &Place,
    (assigned, touched): (&[Option<usize>], &[Option<Changed>]),
    assets: &dyn Assets,
    progress: &dyn Progress,
) -> Derivation {
    let context = Context {
        recipe,
        scene,
        place,
        assets,
        limits: Limits::default(),
        defaults: Defaults::default(),
        seed: Seed::root(scene.seed).named("feature"),
        wholes: wholes(&place.features, &place.terrain),
    };
    progress.begin("derive", Some(place.features.len() as u64));
    let derived: Vec<Derived> = place
        .features
        .par_iter()
        .zip(road_ends(&place.features))
        .zip(assigned.par_iter().zip(touched))
        .map(|((feature, ends), (rule, touched))| {
            let derived = context.feature(feature, ends, *rule, *touched);
            progress.step(1);
            derived
        })
        .collect();
    let mut out = Derivation {
        features: Vec::new(),
        outcomes: Vec::new(),
        ledger: Ledger::default(),
        reports: Vec::new(),
        diagnostics: Diagnostics::default(),
        prints: Vec::new(),
    };
    for (feature, derived) in place.features.iter().zip(derived) {
        out.outcomes.push(derived.outcome);
        out.ledger.merge(derived.ledger);
        if !derived.reports.is_empty() {
            out.reports.push((feature.id.to_string(), derived.reports));
        }
        out.diagnostics.extend(derived.diagnostics);
        out.prints.extend(derived.prints);
        if !derived.states.is_empty() {
            let class = feature.class.into();
            out.features.push(FeatureParts { feature: feature.id, class, states: derived.states });
        }
    }
    let triangles: usize = out.features.iter().flat_map(|f| &f.states).map(|s| s.parts.solid.triangles.len()).sum();
    progress.end(&format!("{} features, {triangles} triangles", out.features.len()));
    out.diagnostics = out.diagnostics.sorted();
    out
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
fn road_ends(features: &[Feature]) -> Vec<[Cap; 2]> {
    let line = |f: &Feature| match &f.outline {
        Outline::Line(line) => line.clone(),
        Outline::Area(_) => Vec::new(),
    };
    let lines: Vec<Vec<DVec2>> = features.iter().map(line).collect();
    caps(&lines.iter().map(Vec::as_slice).collect::<Vec<_>>())
}

impl Context<'_> {
    fn whole(&self, feature: &Feature) -> Option<Relief> {
        self.wholes.get(feature.tags.get(tags::OUTLINE_KEY)?).copied()
    }

    fn feature(&self, feature: &Feature, ends: [Cap; 2], rule: Option<usize>, touched: Option<Changed>) -> Derived {
        let mut out = Derived {
            outcome: Outcome::Ok,
            states: Vec::new(),
            ledger: Ledger::default(),
            reports: Vec::new(),
            diagnostics: Diagnostics::default(),
            prints: Vec::new(),
        };
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
                if let (false, Some(after)) = (matches!(out.outcome, Outcome::Skipped(_)), after(feature, own, effect))
                {
                    self.state(feature, &lot, after, key(Presence::AfterOnly), &mut out);
                }
            }
        }
        out
    }

    /// Derives one state and adds what it gives.
    fn state(
        &self,
        feature: &Feature,
        lot: &Lot,
        rule: &RuleAssignment,
        (presence, change, level): (Presence, u16, u8),
        out: &mut Derived,
    ) {
        // A feature counts once: in its state before, or after where it is built new.
        let counts_once = presence != Presence::AfterOnly || out.states.is_empty();
        let attributes = self.attributes(feature, rule, if counts_once { Some(&mut out.ledger) } else { None });
        let start = StartShape {
            mesh: lot.mesh.clone(),
            start_rule: rule.start.clone(),
            attributes,
            seed: self.seed.named(&feature.id.to_string()),
            name: feature.id.to_string().into(),
            host: HostData::default(),
        };
        let tree = derive(self.recipe.programs.get(&rule.file), &start, self.assets, &self.limits);
        let failed = tree.diagnostics.iter().find(|d| d.severity == Severity::Error);
        if let Some(why) = failed.map(|d| format!("its rules failed: {}", d.message)) {
            out.outcome = Outcome::Skipped(why);
            out.diagnostics.extend(tree.diagnostics);
            out.states.clear();
            out.reports = Vec::new();
            out.prints.clear();
            return;
        }
        if let (Outcome::Ok, Some(simpler)) =
            (&out.outcome, tree.diagnostics.iter().find(|d| FALLBACKS.contains(&d.code)))
        {
            out.outcome = Outcome::FellBack(simpler.message.clone());
        }
        let parts = lot.parts(&tree.leaves, &self.place.terrain);
        let ShapeTree { diagnostics, prints, reports, .. } = tree;
        if counts_once {
            out.reports = reports;
        }
        out.diagnostics.extend(diagnostics);
        out.prints.extend(prints);
        out.states.push(StateParts { presence, change, level, parts });
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
