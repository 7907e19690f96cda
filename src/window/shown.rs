//! Shown: everything the window knows of the last good scene. In: a session after an update. Out: one value that the
//! drawing thread and the panels share; it never changes.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::attributes::{Node, panel};
use super::viewpoint::{Bounds, Viewpoint};
use crate::live::Session;
use crate::pipeline::BuiltScene;
use crate::plan::demand::{Quality, ViewDemand};
use crate::plan::view::{DrawnView, SceneSummary};
use crate::scene::SceneClass;
use crate::spec::draw::Distribution;
use crate::spec::render_spec::{AttributeValue, RuleAssignment, ValueSpec};

/// A good scene with its views and what can be chosen of its rules.
pub struct Shown {
    /// As [`crate::live::Update::scene`].
    pub number: u64,
    /// Of the update that made it.
    pub update: u64,
    pub built: Arc<BuiltScene>,
    pub summary: SceneSummary,
    /// At least one.
    pub views: Vec<DrawnView>,
    /// Names of the recipe's scenes, and which of them it is.
    pub scenes: Vec<String>,
    pub scene: usize,
    pub seed: u64,
    pub rules: Vec<RulePanel>,
    /// Classes of its objects.
    pub classes: Vec<SceneClass>,
    pub triangles: usize,
}

/// What can be chosen of one rule file.
#[derive(Clone, Debug, PartialEq)]
pub struct RulePanel {
    /// As the recipe writes it.
    pub file: String,
    pub nodes: Vec<Node>,
    /// What the recipe says of its attributes, in words.
    pub assigned: Vec<(String, String)>,
}

impl Shown {
    /// `None` before there is a good scene.
    pub fn of(session: &Session, number: u64, update: u64) -> Option<Shown> {
        let (built, recipe) = (session.built()?.clone(), session.recipe()?);
        let mut views = session.views().to_vec();
        if views.is_empty() {
            views.push(overview(built.scene.bounds));
        }
        let ground = built.terrain.height(DVec2::ZERO).unwrap_or(built.scene.bounds.0.y);
        let summary = SceneSummary::new(&built.scene, DVec3::new(0.0, ground, 0.0));
        let scene = session.scene();
        let assignments = &recipe.spec.scenes[scene].rules;
        let rules = session.rule_files().into_iter().map(|file| RulePanel {
            file: file.written.to_owned(),
            nodes: panel(file.program),
            assigned: assigned(assignments, file.written),
        });
        let mut classes: Vec<SceneClass> = built.scene.objects.iter().map(|object| object.class).collect();
        classes.sort();
        classes.dedup();
        Some(Shown {
            number,
            update,
            summary,
            views,
            scenes: recipe.spec.scenes.iter().map(|scene| scene.name.clone()).collect(),
            scene,
            seed: recipe.spec.scenes[scene].seed,
            rules: rules.collect(),
            classes,
            triangles: built.record.triangles,
            built,
        })
    }

    /// The view of this name, or the first.
    pub fn view(&self, name: &str) -> usize {
        self.views.iter().position(|view| view.name == name).unwrap_or(0)
    }
}

/// A view of all of the scene, for recipes that have none.
fn overview(bounds: Bounds) -> DrawnView {
    let name = "overview".to_owned();
    let quality = Quality { supersample: 2, shadow_map: 2048, shadow_samples: 3, sky_samples: 16, field_map: 256 };
    let camera = Viewpoint::overview(bounds).camera(OVERVIEW, bounds);
    let demand = ViewDemand { name: name.clone(), camera, sun: None, quality, outputs: Vec::new() };
    DrawnView { view: 0, name, demands: vec![demand], draws: Vec::new() }
}

/// Pixels of the view of recipes that have none.
const OVERVIEW: (u32, u32) = (1024, 1024);

fn assigned(rules: &[RuleAssignment], file: &str) -> Vec<(String, String)> {
    let of_file = rules.iter().filter(|rule| rule.file.written == file);
    of_file.flat_map(|rule| &rule.attributes).map(|a| (a.name.clone(), words(&a.value))).collect()
}

fn words(value: &AttributeValue) -> String {
    match value {
        AttributeValue::Value(value) => value_words(value),
        AttributeValue::Tag { key, .. } => format!("the tag {key}"),
    }
}

fn value_words(value: &ValueSpec) -> String {
    match value {
        ValueSpec::Number(Distribution::Fixed(number)) => number.to_string(),
        ValueSpec::Number(_) => "drawn per feature".to_owned(),
        ValueSpec::Bool(flag) => flag.to_string(),
        ValueSpec::Text(text) => text.clone(),
        ValueSpec::TextChoice(alternatives) => {
            let names: Vec<&str> = alternatives.iter().map(|(name, _)| name.as_str()).collect();
            format!("one of {}", names.join(", "))
        }
    }
}
