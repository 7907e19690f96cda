//! In: a `dataset` block and everything it refers to. Out: a [`DatasetSpec`] with one entry per view.

use super::{Checker, Found, Named, get};
use crate::source::Span;
use crate::spec::ast::{Block, Expr, ExprKind, Name, Property};
use crate::spec::inherit::{not_yet, unknown_name};
use crate::spec::render_spec::{CameraSpec, DatasetSpec, EffectsSpec, LayoutSpec, OutputSpec, Pair, Split, ViewSpec};
use crate::spec::schema::BlockShape;
use crate::spec::units::Dimension;

/// Of one entry of `views`, and of all together.
const MOST_VIEWS: u64 = 100_000;

/// Layouts of peers.md §5 that are not written yet.
const LATER_LAYOUTS: [&str; 9] =
    ["levir_plus", "whu", "s2looking", "second", "clcd", "xbd", "bright", "synrs3d", "aeronet"];

impl Checker<'_> {
    pub(super) fn dataset(&mut self, block: &Block, found: &Found) -> Option<DatasetSpec> {
        let properties = &block.properties;
        let scenes = self.references(properties, "scenes", "scene", &found.scene_names);
        let passes = self.references(properties, "passes", "pass", &found.pass_names);
        let sun = self.named_block(block, "sun", &found.suns, Checker::default_sun(block.span));
        let effects = self.named_block(block, "effects", &found.effects, EffectsSpec::OFF);
        let quality = self.named_block(block, "quality", &found.qualities, super::quality::STANDARD);
        self.only_word(properties, "format", &["png8"], &["png16", "geotiff", "cog"]);
        self.only_word(properties, "correction", &["raw"], &["ortho"]);
        let splits = self.splits(properties, &found.scene_names);
        let views = self.required(properties, "views", block.span, "a dataset");
        let views = self.views(views?, &scenes?, &splits?, found);
        let passes = passes?;
        let layout = match get(properties, "layout") {
            Some(property) => self.layout(property, &passes, found),
            None => Some(LayoutSpec::Plain),
        };
        Some(DatasetSpec {
            name: self.block_name(block),
            span: block.span,
            views: views?,
            passes,
            sun: sun?,
            effects: effects?,
            quality: quality?,
            layout: layout?,
        })
    }

    /// The named blocks as indices; all blocks where the property is not given.
    fn references(&mut self, properties: &[Property], key: &str, kind: &str, known: &[String]) -> Option<Vec<usize>> {
        let Some(property) = get(properties, key) else { return Some((0..known.len()).collect()) };
        let mut indices = Vec::new();
        for value in &property.values {
            let index = self.reference(value, kind, known)?;
            if !indices.contains(&index) {
                indices.push(index);
            }
        }
        if indices.is_empty() {
            self.error("spec::wrong-value", property.span, format!("`{key}` names nothing"));
            return None;
        }
        Some(indices)
    }

    fn reference(&mut self, value: &Expr, kind: &str, known: &[String]) -> Option<usize> {
        let ExprKind::Word(name) = &value.kind else {
            self.wrong(value, &format!("the name of a {kind}"));
            return None;
        };
        self.index_of(kind, name, value.span, known)
    }

    /// The block that the dataset names; else the unnamed one, else the only one, else the default.
    fn named_block<T: Clone>(&mut self, block: &Block, kind: &str, known: &Named<T>, default: T) -> Option<T> {
        if let Some(property) = get(&block.properties, kind) {
            let value = self.one(property)?;
            let names: Vec<String> = known.iter().map(|(name, _)| name.clone().unwrap_or_default()).collect();
            let index = self.reference(value, kind, &names)?;
            return known[index].1.clone();
        }
        if let Some((_, unnamed)) = known.iter().find(|(name, _)| name.is_none()) {
            return unnamed.clone();
        }
        match known.as_slice() {
            [] => Some(default),
            [(_, only)] => only.clone(),
            _ => {
                let message = format!("the recipe has several `{kind}` blocks and the dataset names none");
                let names: Vec<&str> = known.iter().filter_map(|(name, _)| name.as_deref()).collect();
                let help = format!("add `{kind} {}`", names.join(&format!("` or `{kind} ")));
                self.error_with_help("spec::ambiguous-block", block.span, message, help);
                None
            }
        }
    }

    /// A property that may only have its default value so far.
    fn only_word(&mut self, properties: &[Property], key: &str, words: &[&'static str], later: &[&'static str]) {
        if let Some(value) = get(properties, key).and_then(|property| self.one(property)) {
            self.word(value, words, later);
        }
    }

    /// The split of each scene; a scene that none names is for training.
    fn splits(&mut self, properties: &[Property], scenes: &[String]) -> Option<Vec<Split>> {
        let mut splits: Vec<Option<Split>> = vec![None; scenes.len()];
        let Some(property) = get(properties, "split") else { return Some(vec![Split::Train; scenes.len()]) };
        if !property.values.is_empty() {
            let help = "write `split train a, b val c test d`";
            self.error_with_help("spec::wrong-value", property.span, "`split` goes by scene, never by crop", help);
            return None;
        }
        for clause in &property.clauses {
            let split = match clause.word.text.as_str() {
                "train" => Split::Train,
                "val" => Split::Val,
                _ => Split::Test,
            };
            for value in &clause.values {
                let index = self.reference(value, "scene", scenes)?;
                if splits[index].replace(split).is_some() {
                    self.error("spec::repeated-name", value.span, format!("`{value}` is in two splits"));
                }
            }
        }
        Some(splits.into_iter().map(|split| split.unwrap_or(Split::Train)).collect())
    }

    fn views(&mut self, views: &Property, scenes: &[usize], splits: &[Split], found: &Found) -> Option<Vec<ViewSpec>> {
        let mut cameras: Vec<(CameraSpec, u32)> = Vec::new();
        for value in &views.values {
            let (count, camera) = match &value.kind {
                ExprKind::Times(count, camera) => (self.whole(count, Dimension::Plain, 1, MOST_VIEWS)?, &**camera),
                _ => (1, value),
            };
            cameras.push((self.view_camera(camera, found)?, count as u32));
        }
        if cameras.is_empty() {
            self.error("spec::wrong-value", views.span, "`views` names cameras, such as `4 * satellite`");
            return None;
        }
        let total = cameras.iter().map(|(_, count)| u64::from(*count)).sum::<u64>() * scenes.len() as u64;
        if total > MOST_VIEWS {
            self.error("spec::out-of-range", views.span, format!("a dataset has at most {MOST_VIEWS} views"));
            return None;
        }
        let mut made: Vec<ViewSpec> = Vec::new();
        for &scene in scenes {
            let mut numbers: Vec<(&str, u32)> = Vec::new();
            for (camera, count) in &cameras {
                for _ in 0..*count {
                    let number = next_number(&mut numbers, &camera.name);
                    let name = format!("{}_{}_{number}", found.scene_names[scene], camera.name);
                    made.push(ViewSpec { name, scene, camera: camera.clone(), number, split: splits[scene] });
                }
            }
        }
        Some(made)
    }

    /// `satellite` or `satellite(off_nadir = 0deg)`.
    fn view_camera(&mut self, value: &Expr, found: &Found) -> Option<CameraSpec> {
        let (name, arguments) = match &value.kind {
            ExprKind::Word(name) => (name, [].as_slice()),
            ExprKind::Call { name, arguments } => (&name.text, arguments.as_slice()),
            _ => {
                self.wrong(value, "a camera, such as `satellite` or `4 * satellite(off_nadir = 5deg)`");
                return None;
            }
        };
        let named = |block: &&&Block| block.name.as_ref().is_some_and(|known| known.text == *name);
        let Some(block) = found.cameras.iter().find(named) else {
            let known = found.cameras.iter().filter_map(|block| block.name.as_ref()).map(|name| name.text.as_str());
            self.diagnostics.push(unknown_name("camera", name, value.span, known));
            return None;
        };
        let shape = BlockShape::find("camera").expect("cameras are part of the language");
        let mut properties = block.properties.clone();
        for argument in arguments {
            let Some(key) = &argument.name else {
                self.error("spec::wrong-value", argument.value.span, "write `property = value` in a view's camera");
                return None;
            };
            match shape.key(&key.text) {
                Some(known) if known.evaluated => {}
                Some(_) => {
                    self.diagnostics.push(not_yet(&key.text, key.span));
                    return None;
                }
                None => {
                    let known = shape.keys.iter().map(|key| key.key);
                    self.diagnostics.push(unknown_name("camera property", &key.text, key.span, known));
                    return None;
                }
            }
            properties.retain(|property| property.key.text != key.text);
            if !matches!(&argument.value.kind, ExprKind::Word(word) if word == "auto") {
                properties.push(override_property(key, &argument.value));
            }
        }
        self.camera(&properties, name, block.span)
    }

    fn layout(&mut self, property: &Property, passes: &[usize], found: &Found) -> Option<LayoutSpec> {
        let value = self.one(property)?;
        let word = self.word(value, &["plain", "levir", "levir_flat"], &LATER_LAYOUTS)?;
        let arguments = match &value.kind {
            ExprKind::Call { arguments, .. } => arguments.as_slice(),
            _ => &[],
        };
        if word == "plain" {
            return Some(LayoutSpec::Plain);
        }
        let mut pair = Pair { a: "before".to_owned(), b: "after".to_owned(), label: "mask".to_owned() };
        for argument in arguments {
            let (Some(key), ExprKind::Word(image)) = (&argument.name, &argument.value.kind) else {
                self.wrong(value, "of the form `levir(a = before, b = after, label = mask)`");
                return None;
            };
            match key.text.as_str() {
                "a" => pair.a = image.clone(),
                "b" => pair.b = image.clone(),
                "label" => pair.label = image.clone(),
                other => {
                    self.diagnostics.push(unknown_name("part of a pair", other, key.span, ["a", "b", "label"]));
                    return None;
                }
            }
        }
        let colour = [OutputSpec::Colour];
        let labels = [OutputSpec::Mask, OutputSpec::Class, OutputSpec::Level];
        let a = self.image(&pair.a, &colour, "a colour image", passes, found, value.span);
        let b = self.image(&pair.b, &colour, "a colour image", passes, found, value.span);
        let label = self.image(&pair.label, &labels, "a mask, class or level image", passes, found, value.span);
        (a? && b? && label?).then_some(if word == "levir" {
            LayoutSpec::Levir(pair)
        } else {
            LayoutSpec::LevirFlat(pair)
        })
    }

    /// Whether an image of this name and one of these kinds is among the passes; reports why not.
    fn image(
        &mut self,
        name: &str,
        kinds: &[OutputSpec],
        what: &str,
        passes: &[usize],
        found: &Found,
        span: Span,
    ) -> Option<bool> {
        let mut images: Vec<(OutputSpec, String)> = Vec::new();
        for &pass in passes {
            images.extend(found.passes[pass].as_ref()?.outputs.iter().cloned());
        }
        match images.iter().find(|(_, image)| image == name) {
            Some((kind, _)) if kinds.contains(kind) => return Some(true),
            Some(_) => {
                let message = format!("the layout needs {what}, which `{name}` is not");
                self.error("spec::wrong-value", span, message);
            }
            None => {
                let mut diagnostic = unknown_name("image", name, span, images.iter().map(|(_, name)| name.as_str()));
                diagnostic.help = diagnostic.help.map(|help| {
                    format!("{help}; the layout takes `before`, `after` and `mask`, or as told: `levir(a = …)`")
                });
                self.diagnostics.push(diagnostic);
            }
        }
        Some(false)
    }
}

/// From 1, separately for each camera.
fn next_number<'a>(numbers: &mut Vec<(&'a str, u32)>, camera: &'a str) -> u32 {
    match numbers.iter_mut().find(|(name, _)| *name == camera) {
        Some((_, number)) => {
            *number += 1;
            *number
        }
        None => {
            numbers.push((camera, 1));
            1
        }
    }
}

fn override_property(key: &Name, value: &Expr) -> Property {
    Property { key: key.clone(), values: vec![value.clone()], clauses: Vec::new(), body: None, span: value.span }
}
