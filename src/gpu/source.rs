//! Source: what a pipeline draws → the text of its shader, put together from the parts that it needs and no others.
//!
//! Lines `#if WORD`, `#else`, `#endif` keep or drop what stands between them.

use std::collections::BTreeSet;
use std::fmt::Write;

use crate::plan::effects::{ASH_ALBEDO, GroundKind, LUMINANCE, MOST_INFRARED, WATER_MIRRORS, WET_ALBEDO};
use crate::plan::pass::{PipelineKey, Surface};
use crate::plan::shading::{Channels, ShadowFilter, Terms};

macro_rules! part {
    ($file:literal) => {
        include_str!(concat!("shaders/", $file, ".wgsl"))
    };
}

/// Name of the module that a pipeline is made of: equal names are equal sources.
pub fn module_name(key: PipelineKey) -> String {
    match key {
        PipelineKey::ShadowMap { .. } => "shadow_map".to_owned(),
        PipelineKey::ShadowBounds { .. } => "shadow_bounds".to_owned(),
        PipelineKey::Resolve { .. } => "resolve".to_owned(),
        PipelineKey::Ids { .. } => "ids".to_owned(),
        PipelineKey::Depth { .. } => "depth".to_owned(),
        PipelineKey::Shade { .. } => key.name(),
    }
}

pub fn shader_source(key: PipelineKey) -> String {
    match key {
        PipelineKey::ShadowMap { .. } => [part!("common"), part!("cutout"), part!("shadow_map")].join("\n"),
        PipelineKey::ShadowBounds { .. } => part!("shadow_bounds").to_owned(),
        PipelineKey::Resolve { .. } => part!("resolve").to_owned(),
        PipelineKey::Ids { .. } => [part!("common"), part!("cutout"), part!("ids")].join("\n"),
        PipelineKey::Depth { .. } => [part!("common"), part!("cutout"), part!("depth")].join("\n"),
        PipelineKey::Shade { surface, terms } => shade(surface, terms),
    }
}

fn shade(surface: Surface, terms: Terms) -> String {
    let words = words(surface, terms);
    let parts = [
        ("shadow", part!("shade/shadow")),
        ("hard", part!("shade/shadow_hard")),
        ("soft", part!("shade/shadow_soft")),
        ("occluded_sky", part!("shade/sky")),
        ("path", part!("shade/path")),
        ("haze", part!("shade/haze")),
        ("clouds", part!("shade/clouds")),
        ("ground", part!("shade/ground")),
    ];
    let mut text = [constants(&words), part!("common").to_owned(), part!("shade/main").to_owned()].join("\n");
    for (_, part) in parts.iter().filter(|(word, _)| words.contains(word)) {
        text.push('\n');
        text.push_str(part);
    }
    chosen(&text, &words)
}

/// What the conditions in the shading's parts ask about.
fn words(surface: Surface, terms: Terms) -> BTreeSet<&'static str> {
    let infrared = terms.channels != Channels::Rgb;
    let ground = terms.ground.is_some();
    let clouds = terms.cloud_shadow || terms.cloud_cover;
    let path = terms.haze || terms.cloud_cover || terms.ground == Some(GroundKind::Puddles);
    let derived = [
        ("texture", surface != Surface::Plain),
        ("cutout", surface == Surface::Cutout),
        ("shadow", terms.shadow != ShadowFilter::Unshadowed),
        ("clouds", clouds),
        ("path", path),
        ("place", terms.occluded_sky || ground || clouds || path),
        ("normal", terms.occluded_sky || ground),
        ("ground", ground),
        ("infrared", infrared),
        ("rgb", !infrared),
        ("albedo", ground || infrared),
    ];
    let derived = derived.into_iter().filter(|(_, on)| *on).map(|(word, _)| word);
    terms.words().into_iter().chain(derived).collect()
}

fn constants(words: &BTreeSet<&str>) -> String {
    let [r, g, b] = LUMINANCE;
    let all = [
        ("ash", format!("const ASH_ALBEDO: f32 = {ASH_ALBEDO:?};")),
        ("puddles", format!("const WET_ALBEDO: f32 = {WET_ALBEDO:?};")),
        ("puddles", format!("const WATER_MIRRORS: f32 = {WATER_MIRRORS:?};")),
        ("infrared", format!("const MOST_INFRARED: f32 = {MOST_INFRARED:?};")),
        ("infrared", format!("const LUMINANCE = vec3<f32>({r:?}, {g:?}, {b:?});")),
    ];
    all.iter().filter(|(word, _)| words.contains(word)).fold(String::new(), |mut text, (_, line)| {
        let _ = writeln!(text, "{line}");
        text
    })
}

/// The lines whose conditions all hold.
fn chosen(text: &str, words: &BTreeSet<&str>) -> String {
    let mut open: Vec<bool> = Vec::new();
    let mut kept = String::with_capacity(text.len());
    for line in text.lines() {
        if let Some(word) = line.strip_prefix("#if ") {
            open.push(words.contains(word.trim()));
        } else if line == "#else" {
            let last = open.last_mut().expect("an #else stands in an #if");
            *last = !*last;
        } else if line == "#endif" {
            open.pop().expect("an #endif ends an #if");
        } else if open.iter().all(|&o| o) {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    assert!(open.is_empty(), "every #if has its #endif");
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_nest() {
        let text = "a\n#if x\nb\n#if y\nc\n#else\nd\n#endif\n#else\ne\n#endif\nf";
        let of = |words: &[&'static str]| chosen(text, &words.iter().copied().collect()).replace('\n', "");
        assert_eq!([of(&[]), of(&["x"]), of(&["x", "y"]), of(&["y"])], ["aef", "abdf", "abcf", "aef"]);
    }

    #[test]
    fn a_term_that_is_not_asked_for_is_not_in_the_text() {
        let plain = shader_source(PipelineKey::Shade { surface: Surface::Plain, terms: Terms::default() });
        for absent in ["shadow_map", "lit_share", "sky_share", "haze", "cloud", "ground_share", "textureSample"] {
            assert!(!plain.contains(absent), "{absent}: {plain}");
        }
        let hazy = Terms { haze: true, ..Terms::default() };
        assert!(shader_source(PipelineKey::Shade { surface: Surface::Plain, terms: hazy }).contains("through_haze"));
    }
}
