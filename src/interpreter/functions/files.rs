//! Files, tables, assets, images, materials (reference 6.5, 6.9, 6.13). What cannot be read is empty or 0, with a warning.

use std::sync::Arc;

use super::super::appearance::Appearance;
use super::super::assets::AssetError;
use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::files::{folder, geometry, image, search};
use super::super::limits::Outcome;
use super::super::tree::Scalar;
use super::super::value::{Array, Value};
use super::{Input, file_order, list};
use crate::cga::builtins::{Function as F, Word};
use crate::cga::program::DrawSite;

/// Geometry that is always there.
const BUILTIN_GEOMETRY: &[&str] = &["builtin:cube", "builtin:cube:notex"];

pub fn call(
    run: &mut Derivation,
    function: F,
    input: &Input,
    site: Option<DrawSite>,
    env: &Env,
) -> Outcome<Option<Value>> {
    let path = || input.text(0);
    Ok(Some(match function {
        F::FileExists => Value::Bool(exists(run, &path(), input)),
        F::FileSearch => list::joined(search(run, &path(), input.span).iter().map(|s| &**s)),
        F::FilesSearch => Value::strings(search(run, &path(), input.span).to_vec()),
        F::FileRandom => {
            let found = search(run, &path(), input.span);
            if found.is_empty() {
                run.warn("cga::missing-file", input.span, || format!("no file matches `{}`", path()));
            }
            Value::String(pick(&found, env.draw(site)))
        }
        F::ReadTextFile => {
            let text = run.assets.text(folder(run, input.span), &path());
            let text = text.unwrap_or_else(|error| missing(run, input, &error));
            run.check_text(text.len(), input.span)?;
            Value::String(text)
        }
        F::ReadStringTable => Value::Strings(table(run, &path(), input)),
        F::ReadFloatTable => Value::Floats(Value::Strings(table(run, &path(), input)).to_floats()),
        F::ReadMaterial => {
            let pairs = run.assets.material(folder(run, input.span), &path());
            pairs_value(&pairs.unwrap_or_else(|error| missing(run, input, &error)))
        }
        F::GetMaterial => get_material(run, input, env),
        F::AssetInfo => match geometry(run, &path(), input.span) {
            Ok(asset) => Value::Float(match input.word(1) {
                Some(Word::Sx) => asset.size.x,
                Some(Word::Sy) => asset.size.y,
                Some(Word::Sz) => asset.size.z,
                Some(Word::Tx) => asset.low.x,
                Some(Word::Ty) => asset.low.y,
                _ => asset.low.z,
            }),
            Err(error) => Value::Float(missing(run, input, &error)),
        },
        F::AssetMetadata => metadata(run, &path(), input),
        F::AssetNamingInfo => list::joined(names(run, &path(), input).iter().map(|s| &**s)),
        F::AssetNamingInfos => Value::strings(names(run, &path(), input)),
        F::ImageInfo => match image(run, &path(), input.span) {
            Ok(info) if input.word(1) == Some(Word::Sx) => Value::Float(f64::from(info.width)),
            Ok(info) => Value::Float(f64::from(info.height)),
            Err(error) => Value::Float(missing(run, input, &error)),
        },
        other => return file_order::call(run, other, input, site, env),
    }))
}

/// An empty value, with a warning that says why.
fn missing<T: Default>(run: &mut Derivation, input: &Input, error: &AssetError) -> T {
    run.warn("cga::missing-file", input.span, || error.to_string());
    T::default()
}

/// One of several, by a draw in [0, 1); "" of none.
pub fn pick(list: &[Arc<str>], unit: f64) -> Arc<str> {
    list.get((unit * list.len() as f64) as usize).cloned().unwrap_or_else(|| "".into())
}

fn exists(run: &mut Derivation, path: &str, input: &Input) -> bool {
    BUILTIN_GEOMETRY.contains(&path)
        || (path.starts_with("builtin:") && image(run, path, input.span).is_ok())
        || run.assets.locate(folder(run, input.span), path).is_some()
}

fn table(run: &mut Derivation, path: &str, input: &Input) -> Arc<Array<Arc<str>>> {
    let table = run.assets.table(folder(run, input.span), path, run.limits.max_array);
    table.unwrap_or_else(|error| {
        run.warn("cga::missing-file", input.span, || error.to_string());
        Arc::new(Array::row(Vec::new()))
    })
}

/// The value of a key if it has the type of the default, else the default.
fn metadata(run: &mut Derivation, path: &str, input: &Input) -> Value {
    let default = input.any(2);
    let found = match geometry(run, path, input.span) {
        Ok(asset) => asset.metadata.get(&input.text(1)).cloned(),
        Err(error) => {
            run.warn("cga::missing-file", input.span, || error.to_string());
            None
        }
    };
    match (found, &default) {
        (Some(Scalar::Float(x)), Value::Float(_)) => Value::Float(x),
        (Some(Scalar::Bool(b)), Value::Bool(_)) => Value::Bool(b),
        (Some(Scalar::String(s)), Value::String(_)) => Value::String(s),
        _ => default,
    }
}

/// Names of an asset's groups (`g`) or materials (`m`), in the order of their first faces.
fn names(run: &mut Derivation, path: &str, input: &Input) -> Vec<Arc<str>> {
    match geometry(run, path, input.span) {
        Ok(asset) if input.word(1) == Some(Word::G) => asset.groups(),
        Ok(asset) => asset.materials(),
        Err(error) => missing(run, input, &error),
    }
}

/// `getMaterial(used | shape | geometry, changed | all)`.
fn get_material(run: &Derivation, input: &Input, env: &Env) -> Value {
    let own = &env.shape.state.appearance;
    let below = env.shape.form.first_material();
    let appearance: Appearance = match (input.word(0), below) {
        (Some(Word::Shape), _) => (**own).clone(),
        (Some(Word::Geometry), below) => below.cloned().unwrap_or_default(),
        (_, Some(below)) => own.over(below),
        (_, None) => (**own).clone(),
    };
    let folder = folder(run, input.span);
    let mut pairs = if input.word(1) == Some(Word::All) { appearance.all_pairs() } else { appearance.pairs() };
    for (_, value) in &mut pairs {
        *value = run.assets.shown(folder, value);
    }
    pairs_value(&pairs)
}

/// Two columns: name and value.
fn pairs_value(pairs: &[(Arc<str>, Arc<str>)]) -> Value {
    let items: Vec<Arc<str>> = pairs.iter().flat_map(|(name, value)| [name.clone(), value.clone()]).collect();
    let columns = if items.is_empty() { 0 } else { 2 };
    Value::Strings(Arc::new(Array { rows: pairs.len(), columns, items }))
}
