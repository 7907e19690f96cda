//! Assets and images in the order in which they suit the scope (reference 6.5, 6.13). In: files and axes. Out: the
//! files sorted, or one of the best.
//!
//! Ratios differ by |ln(ra / rs)|, sizes by the greatest |ln(a / s)| of their axes. What cannot be read or compared
//! stands last. The order is stable.

use std::sync::Arc;

use glam::DVec3;

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::files::{geometry, image, search};
use super::super::limits::Outcome;
use super::super::value::Value;
use super::files::pick;
use super::{Input, list};
use crate::cga::builtins::{Function as F, Word};
use crate::cga::program::DrawSite;

/// What files are compared by.
#[derive(Clone, Copy, PartialEq)]
enum Measure {
    Ratio,
    Size,
    ImageRatio,
}

/// A file with its difference from the scope.
type Ranked = (f64, Arc<str>);

pub fn call(
    run: &mut Derivation,
    function: F,
    input: &Input,
    site: Option<DrawSite>,
    env: &Env,
) -> Outcome<Option<Value>> {
    use Measure as M;
    let scope = env.shape.scope.size.abs();
    Ok(Some(match function {
        F::AssetsSortRatio => sorted(run, input, M::Ratio, scope, 0.0),
        F::AssetsSortSize => sorted(run, input, M::Size, scope, input.float(2)),
        F::ImagesSortRatio => sorted(run, input, M::ImageRatio, scope, 0.0),
        F::AssetBestRatio => best(run, input, M::Ratio, scope),
        F::AssetBestSize => best(run, input, M::Size, scope),
        F::AssetApproxRatio => chosen(run, input, M::Ratio, scope, env.draw(site)),
        F::AssetApproxSize => chosen(run, input, M::Size, scope, env.draw(site)),
        F::ImageApproxRatio => chosen(run, input, M::ImageRatio, scope, env.draw(site)),
        F::ImageBestRatio => {
            let ranked = found(run, input, M::ImageRatio, scope, 0.0);
            let ties = ranked.iter().take_while(|(d, _)| *d == ranked[0].0).count();
            one_of(run, input, &ranked[..ties], env.draw(site))
        }
        F::AssetFitSize => {
            let ranked = found(run, input, M::Size, scope, input.float(2));
            one_of(run, input, &ranked, env.draw(site))
        }
        _ => return Ok(None),
    }))
}

/// A list, as text or array, in its new order and its old form.
fn sorted(run: &mut Derivation, input: &Input, measure: Measure, scope: DVec3, most_error: f64) -> Value {
    let axes = input.word(1).and_then(axes);
    match input.any(0) {
        Value::Strings(array) => {
            let ranked = ranked(run, input, array.items.to_vec(), measure, axes, scope, most_error);
            Value::strings(ranked.into_iter().map(|(_, file)| file).collect())
        }
        text => {
            let text = text.to_text();
            let files = list::items(&text).into_iter().map(Arc::from).collect();
            let ranked = ranked(run, input, files, measure, axes, scope, most_error);
            list::joined(ranked.iter().map(|(_, file)| &**file))
        }
    }
}

/// The files that a query finds, the best first. The axes are a text.
fn found(run: &mut Derivation, input: &Input, measure: Measure, scope: DVec3, most_error: f64) -> Vec<Ranked> {
    let text = input.text(1);
    let Some(axes) = Word::from_text(&text).filter(|word| fits(*word, measure)).and_then(axes) else {
        run.error("cga::file-axes", input.span, format!("`{text:.40}` names no axes to compare by"));
        return Vec::new();
    };
    let files = search(run, &input.text(0), input.span).to_vec();
    ranked(run, input, files, measure, Some(axes), scope, most_error)
}

fn best(run: &mut Derivation, input: &Input, measure: Measure, scope: DVec3) -> Value {
    let ranked = found(run, input, measure, scope, 0.0);
    one_of(run, input, &ranked[..ranked.len().min(1)], 0.0)
}

/// One of the n best.
fn chosen(run: &mut Derivation, input: &Input, measure: Measure, scope: DVec3, unit: f64) -> Value {
    let ranked = found(run, input, measure, scope, 0.0);
    let count = (input.float(2).round().max(1.0) as usize).min(ranked.len());
    one_of(run, input, &ranked[..count], unit)
}

fn one_of(run: &mut Derivation, input: &Input, ranked: &[Ranked], unit: f64) -> Value {
    if ranked.is_empty() {
        run.warn("cga::missing-file", input.span, || format!("no file suits `{}`", input.text(0)));
    }
    let files: Vec<Arc<str>> = ranked.iter().map(|(_, file)| file.clone()).collect();
    Value::String(pick(&files, unit))
}

fn ranked(
    run: &mut Derivation,
    input: &Input,
    files: Vec<Arc<str>>,
    measure: Measure,
    axes: Option<&[usize]>,
    scope: DVec3,
    most_error: f64,
) -> Vec<Ranked> {
    let axes = axes.unwrap_or(&[]);
    let mut out: Vec<Ranked> = Vec::with_capacity(files.len());
    for file in files {
        let size = match measure {
            Measure::ImageRatio => image(run, &file, input.span)
                .map(|info| (DVec3::new(f64::from(info.width), f64::from(info.height), 0.0), true)),
            _ => geometry(run, &file, input.span).map(|asset| (asset.size, false)),
        };
        let difference = match size {
            // The image's sides lie along the two axes named.
            Ok((sides, true)) => log_ratio(sides.x / sides.y, scope[axes[0]] / scope[axes[1]]),
            Ok((size, false)) if measure == Measure::Ratio => ratio_difference(size, scope, axes),
            Ok((size, false)) => {
                let needed = |&axis: &usize| (scope[axis] / size[axis] - 1.0).abs();
                if most_error > 0.0 && !axes.iter().all(|axis| needed(axis) <= most_error) {
                    continue;
                }
                axes.iter().map(|&axis| log_ratio(size[axis], scope[axis])).fold(0.0, f64::max)
            }
            Err(error) => {
                run.warn("cga::missing-file", input.span, || error.to_string());
                f64::INFINITY
            }
        };
        out.push((difference, file));
    }
    out.sort_by(|a, b| a.0.total_cmp(&b.0));
    out
}

/// The sum over all pairs of the axes.
fn ratio_difference(size: DVec3, scope: DVec3, axes: &[usize]) -> f64 {
    let pairs = (0..axes.len()).flat_map(|i| (i + 1..axes.len()).map(move |j| (axes[i], axes[j])));
    pairs.map(|(i, j)| log_ratio(size[i] / size[j], scope[i] / scope[j])).sum()
}

/// |ln(a / b)|; infinite where there is no such ratio.
fn log_ratio(a: f64, b: f64) -> f64 {
    let difference = libm::log(a / b).abs();
    if difference.is_finite() { difference } else { f64::INFINITY }
}

/// Whether an axes word is one that the measure takes.
fn fits(word: Word, measure: Measure) -> bool {
    use Word as W;
    match measure {
        Measure::Ratio => matches!(word, W::Xy | W::Xz | W::Yz | W::Xyz),
        Measure::Size => matches!(word, W::X | W::Y | W::Z | W::Xy | W::Xz | W::Yz | W::Xyz),
        Measure::ImageRatio => matches!(word, W::Xy | W::Xz | W::Yx | W::Yz | W::Zx | W::Zy),
    }
}

fn axes(word: Word) -> Option<&'static [usize]> {
    use Word as W;
    Some(match word {
        W::X => &[0],
        W::Y => &[1],
        W::Z => &[2],
        W::Xy => &[0, 1],
        W::Xz => &[0, 2],
        W::Yz => &[1, 2],
        W::Yx => &[1, 0],
        W::Zx => &[2, 0],
        W::Zy => &[2, 1],
        W::Xyz => &[0, 1, 2],
        _ => return None,
    })
}
