//! In: blocks with everything inherited and every input filled in. Out: the [`RenderSpec`], or what is wrong with it.

mod camera;
mod change;
mod dataset;
mod effects;
mod filters;
mod light;
mod pass;
mod quality;
mod scene;
mod sets;
mod values;

pub use quality::PRESETS;

use super::ast::{Block, Property};
use super::inherit::unknown_name;
use super::read::Folders;
use super::render_spec::{ChangeSpec, EffectsSpec, PassSpec, QualitySpec, RenderSpec, SceneSpec, SunSpec};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::Span;

/// The spec, if the blocks could be read; errors may still stand in the diagnostics.
pub(super) fn check(blocks: &[Block], folders: &Folders) -> (Option<RenderSpec>, Diagnostics) {
    let mut checker = Checker { folders, diagnostics: Diagnostics::default() };
    let of_kind = |kind: &'static str| blocks.iter().filter(move |block| block.kind.text == kind);
    let mut found = Found { cameras: of_kind("camera").collect(), ..Found::default() };
    let name_of = |block: &Block| block.name.as_ref().map(|name| name.text.clone());
    // A change without errors in its own block is known by name even if another one is wrong.
    found.change_names = of_kind("change").map(|block| checker.block_name(block)).collect();
    for block in of_kind("camera") {
        checker.camera(&block.properties, &checker.block_name(block), block.span);
    }
    let scenes: Vec<Option<SceneSpec>> = of_kind("scene").map(|block| checker.scene(block)).collect();
    let changes: Vec<Option<ChangeSpec>> = of_kind("change").map(|block| checker.change(block)).collect();
    found.non_target = changes.iter().map(|change| change.as_ref().is_some_and(|change| change.non_target)).collect();
    found.scene_names = of_kind("scene").map(|block| checker.block_name(block)).collect();
    found.suns = of_kind("sun").map(|block| (name_of(block), checker.sun(block))).collect();
    found.effects = of_kind("effects").map(|block| (name_of(block), checker.effects(block))).collect();
    found.qualities = of_kind("quality").map(|block| (name_of(block), checker.quality(block))).collect();
    found.passes = of_kind("pass").map(|block| checker.pass(block, &found.change_names)).collect();
    found.pass_names = of_kind("pass").map(|block| checker.block_name(block)).collect();
    let datasets = of_kind("dataset").map(|block| checker.dataset(block, &found)).collect::<Vec<_>>();
    let spec = (|| {
        Some(RenderSpec {
            scenes: scenes.into_iter().collect::<Option<_>>()?,
            changes: changes.into_iter().collect::<Option<_>>()?,
            passes: found.passes.into_iter().collect::<Option<_>>()?,
            datasets: datasets.into_iter().collect::<Option<_>>()?,
        })
    })();
    (spec, checker.diagnostics)
}

/// Blocks that may be named or not, with what they say.
type Named<T> = Vec<(Option<String>, Option<T>)>;

/// What other blocks refer to. `None` stands for a block with errors of its own.
#[derive(Default)]
struct Found<'a> {
    cameras: Vec<&'a Block>,
    scene_names: Vec<String>,
    change_names: Vec<String>,
    non_target: Vec<bool>,
    pass_names: Vec<String>,
    passes: Vec<Option<PassSpec>>,
    suns: Named<SunSpec>,
    effects: Named<EffectsSpec>,
    qualities: Named<QualitySpec>,
}

/// What checking carries along.
struct Checker<'a> {
    folders: &'a Folders,
    diagnostics: Diagnostics,
}

impl Checker<'_> {
    fn error(&mut self, code: &'static str, span: Span, message: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(code, span, message));
    }

    fn error_with_help(&mut self, code: &'static str, span: Span, message: impl Into<String>, help: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(code, span, message).help(help));
    }

    fn block_name(&self, block: &Block) -> String {
        block.name.as_ref().map(|name| name.text.clone()).unwrap_or_default()
    }

    /// The index of a name; unknown ones are reported.
    fn index_of(&mut self, kind: &str, name: &str, span: Span, known: &[String]) -> Option<usize> {
        let found = known.iter().position(|candidate| candidate == name);
        if found.is_none() {
            self.diagnostics.push(unknown_name(kind, name, span, known.iter().map(String::as_str)));
        }
        found
    }

    fn required<'p>(&mut self, properties: &'p [Property], key: &str, span: Span, what: &str) -> Option<&'p Property> {
        let found = get(properties, key);
        if found.is_none() {
            self.error("spec::missing-property", span, format!("{what} needs `{key}`"));
        }
        found
    }
}

/// The property with this key.
fn get<'p>(properties: &'p [Property], key: &str) -> Option<&'p Property> {
    properties.iter().find(|property| property.key.text == key)
}

/// All properties with this key.
fn all<'p>(properties: &'p [Property], key: &'static str) -> impl Iterator<Item = &'p Property> {
    properties.iter().filter(move |property| property.key.text == key)
}
