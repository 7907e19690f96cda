//! Budget: errors to keep → the cheapest quality that keeps them in the windows of a bench.
//!
//! Half of the windows calibrate, the other half checks. First every knob is measured alone, from coarse to fine, with
//! everything else fine; mean squares of independent errors add up, which predicts every combination. Then combinations
//! are drawn in the order of their counted [`work`], the least first, leaving out what is predicted to miss; the first
//! that keeps the promise in both halves is taken. Clocks decide nothing.

use super::bench::{Bench, CostError, Part, Setting};
use super::errors::{Errors, Metric};
use super::knobs::{FINE, Subject};
use super::work::work;
use crate::plan::demand::{Quality, Shadows, ViewDemand};
use crate::spec::render_spec::{BudgetSpec, FixedKnobs};

/// Share of a promise that calibration may use up: the rest is for what other windows have more of.
const SPENT: f64 = 0.9;
/// Combinations that are drawn at most.
const TRIES: usize = 40;

/// What was promised of images: greatest errors, by metric.
#[derive(Clone, Debug, PartialEq)]
pub struct Promise(Vec<(Metric, f64)>);

impl Promise {
    pub fn new(budget: &BudgetSpec) -> Promise {
        let all = [
            (Metric::Light, budget.error),
            (Metric::Edge, budget.edge),
            (Metric::Shadow, budget.shadow.map(|share| 1.0 - share)),
        ];
        Promise(all.into_iter().filter_map(|(metric, limit)| Some((metric, limit?))).collect())
    }

    /// Whether only the ground is promised something.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn limits(&self) -> &[(Metric, f64)] {
        &self.0
    }

    /// Mean standard error that the truth needs so as not to blur the promise.
    pub fn enough(&self) -> f64 {
        let light = self.0.iter().find(|(metric, _)| *metric == Metric::Light);
        light.map_or(4e-3, |(_, limit)| (limit / 8.0).clamp(5e-4, 4e-3))
    }

    /// Whether errors keep within this share of every limit; what cannot be measured is kept.
    fn kept(&self, errors: &Errors, share: f64) -> bool {
        self.0.iter().all(|&(metric, limit)| errors.get(metric).is_none_or(|error| error <= limit * share))
    }
}

/// The settings that were chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    pub quality: Quality,
    /// In the windows that it was chosen by, and in the others.
    pub calibrated: Errors,
    pub achieved: Errors,
    /// Combinations that were drawn.
    pub tried: usize,
}

/// What was found: a choice, or the best there is.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    Kept(Choice),
    Missed(Choice),
}

/// Values of one free knob.
struct Ladder {
    values: Vec<u32>,
    set: fn(&mut Quality, u32),
    /// Errors alone, value by value.
    alone: Vec<Errors>,
}

/// Finds the cheapest quality for the views of a bench; knobs that the recipe fixes are those of `own`.
pub fn choose(
    bench: &mut Bench,
    subject: Subject,
    views: &[ViewDemand],
    triangles: u64,
    own: Quality,
    budget: &BudgetSpec,
) -> Result<Outcome, CostError> {
    let promise = Promise::new(budget);
    let fine = fixed(FINE, own, &budget.fixed);
    let base = bench.errors_in(Part::Calibration, &Setting::of(fine))?;
    let mut ladders = ladders(subject, &budget.fixed);
    for ladder in &mut ladders {
        for &value in &ladder.values {
            let mut quality = fine;
            (ladder.set)(&mut quality, value);
            ladder.alone.push(bench.errors_in(Part::Calibration, &Setting::of(quality))?);
        }
    }
    // Knobs that do not matter here keep the recipe's values.
    let mut candidates: Vec<(f64, Quality, Vec<usize>)> = combinations(&ladders)
        .into_iter()
        .map(|steps| {
            let mut quality = own;
            ladders.iter().zip(&steps).for_each(|(ladder, &step)| (ladder.set)(&mut quality, ladder.values[step]));
            let work = views.iter().map(|view| work(view, &quality, triangles)).sum();
            (work, quality, steps)
        })
        .collect();
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    search(bench, &promise, &base, &ladders, candidates)
}

fn search(
    bench: &mut Bench,
    promise: &Promise,
    base: &Errors,
    ladders: &[Ladder],
    candidates: Vec<(f64, Quality, Vec<usize>)>,
) -> Result<Outcome, CostError> {
    let finest = candidates.iter().max_by_key(|(_, _, steps)| steps.iter().sum::<usize>()).map(|c| c.1);
    let mut failed: Vec<Vec<usize>> = Vec::new();
    for (_, quality, steps) in candidates {
        let coarser = |other: &Vec<usize>| steps.iter().zip(other).all(|(a, b)| a <= b);
        if failed.len() >= TRIES || failed.iter().any(coarser) || !predicted(promise, base, ladders, &steps) {
            continue;
        }
        let setting = Setting::of(quality);
        let calibrated = bench.errors_in(Part::Calibration, &setting)?;
        if promise.kept(&calibrated, SPENT) {
            let achieved = bench.errors_in(Part::Check, &setting)?;
            if promise.kept(&achieved, 1.0) {
                return Ok(Outcome::Kept(Choice { quality, calibrated, achieved, tried: failed.len() + 1 }));
            }
        }
        failed.push(steps);
    }
    let quality = finest.unwrap_or(FINE);
    let setting = Setting::of(quality);
    let calibrated = bench.errors_in(Part::Calibration, &setting)?;
    let achieved = bench.errors_in(Part::Check, &setting)?;
    let choice = Choice { quality, calibrated, achieved, tried: failed.len() + 1 };
    // The finest may keep what a coarser one was predicted to miss.
    let kept = promise.kept(&calibrated, 1.0) && promise.kept(&achieved, 1.0);
    Ok(if kept { Outcome::Kept(choice) } else { Outcome::Missed(choice) })
}

/// Whether a combination should keep the promise: what each knob adds to the error of the finest settings, in mean
/// squares for light and edges, in areas for shadows.
fn predicted(promise: &Promise, base: &Errors, ladders: &[Ladder], steps: &[usize]) -> bool {
    promise.0.iter().all(|&(metric, limit)| {
        let Some(least) = base.get(metric) else { return true };
        let power = if metric == Metric::Shadow { 1.0 } else { 2.0 };
        let raised = |error: f64| if power == 2.0 { error * error } else { error };
        let added = |(ladder, &step): (&Ladder, &usize)| {
            ladder.alone[step].get(metric).map_or(0.0, |error| (raised(error) - raised(least)).max(0.0))
        };
        let sum = raised(least) + ladders.iter().zip(steps).map(added).sum::<f64>();
        // Errors of several knobs may share their places: a little more than the limit is worth a look.
        sum <= raised(limit * SPENT) * 1.05
    })
}

fn fixed(fine: Quality, own: Quality, fixed: &FixedKnobs) -> Quality {
    let pick = |is_fixed: bool, own: u32, fine: u32| if is_fixed { own } else { fine };
    Quality {
        supersample: pick(fixed.supersample, own.supersample, fine.supersample),
        shadow_map: pick(fixed.shadow_map, own.shadow_map, fine.shadow_map),
        shadow_samples: pick(fixed.shadow_samples, own.shadow_samples, fine.shadow_samples),
        sky_samples: pick(fixed.sky_samples, own.sky_samples, fine.sky_samples),
        field_map: pick(fixed.field_map, own.field_map, fine.field_map),
    }
}

fn ladders(subject: Subject, fixed: &FixedKnobs) -> Vec<Ladder> {
    let soft = subject.shadows() && subject.look.shadows == Shadows::Soft;
    let ladder =
        |values: &[u32], set: fn(&mut Quality, u32)| Ladder { values: values.to_vec(), set, alone: Vec::new() };
    let all = [
        (!fixed.supersample, ladder(&[1, 2, 3, 4, 5, 6, 8], |q, n| q.supersample = n)),
        (!fixed.shadow_map && subject.shadows(), ladder(&[1024, 2048, 4096, 8192], |q, n| q.shadow_map = n)),
        (!fixed.shadow_samples && soft, ladder(&[1, 2, 4, 8, 16], |q, n| q.shadow_samples = n)),
        (!fixed.sky_samples && subject.sky(), ladder(&[8, 16, 32, 64, 128, 256], |q, n| q.sky_samples = n)),
        (!fixed.field_map && subject.fields(), ladder(&[512, 1024, 2048, 4096], |q, n| q.field_map = n)),
    ];
    all.into_iter().filter(|(free, _)| *free).map(|(_, ladder)| ladder).collect()
}

/// All ways to take one step of each ladder.
fn combinations(ladders: &[Ladder]) -> Vec<Vec<usize>> {
    ladders.iter().fold(vec![Vec::new()], |ways, ladder| {
        let longer = |way: Vec<usize>| (0..ladder.values.len()).map(move |step| [way.as_slice(), &[step]].concat());
        ways.into_iter().flat_map(longer).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn promises_are_kept_by_what_cannot_be_measured() {
        let budget = BudgetSpec { error: Some(0.01), shadow: Some(0.98), ..BudgetSpec::default() };
        let promise = Promise::new(&budget);
        let errors = |light: f64, shadow: Option<f64>| Errors { light, shadow, ..Errors::default() };
        assert!(promise.kept(&errors(0.01, Some(0.02 - 1e-12)), 1.0) && promise.kept(&errors(0.01, None), 1.0));
        assert!(!promise.kept(&errors(0.011, None), 1.0) && !promise.kept(&errors(0.0, Some(0.03)), 1.0));
        assert!(!promise.kept(&errors(0.0095, None), SPENT));
        assert!(Promise::new(&BudgetSpec { height: Some(0.25), ..BudgetSpec::default() }).is_empty());
    }

    #[test]
    fn squares_of_independent_errors_add_up() {
        let alone = |light: f64| Errors { light, ..Errors::default() };
        let ladder = |errors: &[f64]| Ladder {
            values: vec![1; errors.len()],
            set: |_, _| {},
            alone: errors.iter().map(|&e| alone(e)).collect(),
        };
        let ladders = [ladder(&[0.03, 0.006]), ladder(&[0.008, 0.001])];
        let promise = Promise(vec![(Metric::Light, 0.01 / SPENT)]);
        let ok: Vec<bool> =
            combinations(&ladders).iter().map(|steps| predicted(&promise, &alone(0.0), &ladders, steps)).collect();
        assert_eq!(ok, [false, false, true, true]);
        let promise = Promise(vec![(Metric::Light, 0.0097 / SPENT)]);
        assert!(!predicted(&promise, &alone(0.0), &ladders, &[1, 0]));
    }
}
