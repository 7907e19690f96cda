//! `color`, `texture`, `resetMaterial` (reference 4.14, 4.17). In: colours and paths. Out: the shape's material.

use std::sync::Arc;

use super::super::appearance::{OPACITYMAP, parse_color};
use super::super::assets::builtin_image;
use super::super::derivation::Derivation;
use super::super::files;
use super::super::form::Materials;
use super::super::palette::Paint;
use super::super::shape::Shape;
use super::super::value::Value;
use super::args::Args;
use crate::cga::builtins::Word;
use crate::source::Span;

/// `color("#rrggbb[oo]")`, `color(r, g, b [, o])`. Text that is no colour warns and changes nothing.
pub fn color(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (rgb, opacity) = if let Some(Value::String(text)) = args.value(0) {
        let Some(parsed) = parse_color(text) else {
            run.warn("cga::bad-color", args.span, || format!("`{text}` is no colour of the form #rrggbb or #rrggbboo"));
            return;
        };
        parsed
    } else {
        let part = |run: &mut Derivation, i: usize| args.float_or(run, i, 0.0).clamp(0.0, 1.0);
        let rgb = [part(run, 0), part(run, 1), part(run, 2)];
        (rgb, (args.len() > 3).then(|| part(run, 3)))
    };
    paint(run, shape, Paint::Color { rgb, opacity });
}

/// `texture(path)`: the colour map, and the opacity map if the image has an alpha channel; "" for none.
pub fn texture(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let path = args.value(0).map_or_else(|| "".into(), Value::to_text);
    let path = texture_path(run, &path, args.span);
    // A host without files, and an image that cannot be read, tell nothing of channels.
    let has_alpha = !path.is_empty() && files::image(run, &path, args.span).is_ok_and(|info| info.has_alpha);
    let has_own = shape.form.first_material().is_some();
    let set_before = shape.state.appearance.get(OPACITYMAP).is_some();
    let opacity_map = if has_alpha { Some(path.clone()) } else { (set_before || has_own).then(|| Arc::from("")) };
    paint(run, shape, Paint::Texture { path, opacity_map });
}

fn paint(run: &mut Derivation, shape: &mut Shape, paint: Paint) {
    let painted = run.palette.painted(&shape.state.appearance, paint);
    shape.state_mut().appearance = painted;
}

/// A texture's path as the host finds it; a missing file becomes the stand-in, with a warning (reference 2.11).
pub fn texture_path(run: &mut Derivation, path: &Arc<str>, span: Span) -> Arc<str> {
    let found = match path.starts_with("builtin:") {
        true => builtin_image(path).map(|_| path.clone()),
        false if path.is_empty() => return path.clone(),
        false => run.assets.locate(files::folder(run, span), path),
    };
    found.unwrap_or_else(|| {
        run.warn("cga::missing-texture", span, || format!("texture `{path:.200}` was not found"));
        "builtin:unknowntexture.png".into()
    })
}

/// `resetMaterial([shape | geometry | all])`.
pub fn reset(args: &Args, shape: &mut Shape) {
    let word = args.word(0).unwrap_or(Word::Shape);
    if word != Word::Geometry {
        shape.state_mut().appearance = Arc::default();
    }
    if word != Word::Shape {
        let form = Arc::make_mut(&mut shape.form);
        form.face_materials = Vec::new();
        form.materials = Materials::default();
    }
}
