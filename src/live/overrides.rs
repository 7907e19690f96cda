//! What the user changes beside the files. In: a checked recipe. Out: the same recipe with these values in place of its
//! own.

use serde::Serialize;

use crate::interpreter::tree::Scalar;
use crate::spec::draw::Distribution;
use crate::spec::render_spec::{
    AttributeSpec, AttributeValue, LevelEffect, RenderSpec, RuleAssignment, SunPosition, ValueSpec,
};

/// Values in place of the recipe's; the default changes nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The scene to show, by name; the recipe's first otherwise.
    pub scene: Option<String>,
    /// Of that scene.
    pub seed: Option<u64>,
    /// Later ones win.
    pub attributes: Vec<AttributeOverride>,
    pub sun: Option<SunAngles>,
}

/// A value for an attribute wherever the recipe assigns the rule file.
#[derive(Clone, Debug, PartialEq)]
pub struct AttributeOverride {
    /// The rule file as [`FileRef::written`](crate::spec::render_spec::FileRef::written).
    pub file: String,
    /// With import prefixes, as [`Attribute::name`](crate::cga::program::Attribute::name).
    pub name: String,
    pub value: Scalar,
}

/// Degrees above the horizon and clockwise from north.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SunAngles {
    pub elevation: f64,
    pub azimuth: f64,
}

impl Overrides {
    /// Index of the scene to show, or what is to be said where the recipe has none of that name (any more).
    pub fn scene_of(&self, spec: &RenderSpec) -> Result<usize, String> {
        let Some(name) = &self.scene else { return Ok(0) };
        spec.scenes.iter().position(|scene| scene.name == *name).ok_or_else(|| {
            let names: Vec<&str> = spec.scenes.iter().map(|scene| scene.name.as_str()).collect();
            format!("the recipe has no scene `{name}`; it has {}", names.join(", "))
        })
    }

    /// Puts the values into a recipe.
    pub fn apply(&self, spec: &mut RenderSpec) {
        if let (Some(seed), Ok(scene)) = (self.seed, self.scene_of(spec)) {
            spec.scenes[scene].seed = seed;
        }
        let levels = spec.changes.iter_mut().flat_map(|change| &mut change.levels);
        let of_levels = levels.flat_map(|level| match &mut level.effect {
            LevelEffect::Rules(rules) => rules.as_mut_slice(),
            LevelEffect::Demolished | LevelEffect::Built => &mut [],
        });
        let of_scenes = spec.scenes.iter_mut().flat_map(|scene| &mut scene.rules);
        of_scenes.chain(of_levels).for_each(|assignment| self.assign(assignment));
        if let Some(SunAngles { elevation, azimuth }) = self.sun {
            let (elevation, azimuth) = (Distribution::Fixed(elevation), Distribution::Fixed(azimuth));
            for dataset in &mut spec.datasets {
                dataset.sun.position = SunPosition::Angles { elevation: elevation.clone(), azimuth: azimuth.clone() };
            }
        }
    }

    fn assign(&self, assignment: &mut RuleAssignment) {
        for own in self.attributes.iter().filter(|own| own.file == assignment.file.written) {
            let value = match &own.value {
                Scalar::Float(x) => ValueSpec::Number(Distribution::Fixed(*x)),
                Scalar::Bool(b) => ValueSpec::Bool(*b),
                Scalar::String(text) => ValueSpec::Text(text.to_string()),
            };
            let (name, span) = (own.name.clone(), assignment.span);
            assignment.attributes.push(AttributeSpec { name, value: AttributeValue::Value(value), span });
        }
    }
}
