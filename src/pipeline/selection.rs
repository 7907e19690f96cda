//! Which features a recipe's changes touch. In: the change blocks and the features that have rules. Out: at most one
//! change and level per feature; where two changes draw the same feature, the first one has it.

use crate::geodata::feature::Feature;
use crate::interpreter::seed::Seed;
use crate::plan::changes::select_changed;
use crate::spec::render_spec::ChangeSpec;

/// The change of one feature, by index into the recipe's changes, with the index of its level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Touched {
    pub change: usize,
    pub level: usize,
}

/// What was drawn.
pub struct Changes {
    /// One per feature.
    pub touched: Vec<Option<Touched>>,
    /// Number of features that each change could have drawn.
    pub candidates: Vec<usize>,
}

/// Draws the changed features of a scene; `assigned` says which features have rules.
pub fn changes(specs: &[ChangeSpec], features: &[Feature], assigned: &[bool], seed: Seed) -> Changes {
    let mut touched: Vec<Option<Touched>> = vec![None; features.len()];
    let mut candidates = Vec::new();
    for (change, spec) in specs.iter().enumerate() {
        let of = |i: &usize| assigned[*i] && spec.of.matches(features[*i].class, &features[*i].tags, features[*i].id);
        let numbers: Vec<usize> = (0..features.len()).filter(of).collect();
        let ids: Vec<_> = numbers.iter().map(|&i| features[i].id).collect();
        candidates.push(numbers.len());
        for (&number, level) in numbers.iter().zip(select_changed(spec, &ids, seed)) {
            if let (Some(level), None) = (level, touched[number]) {
                touched[number] = Some(Touched { change, level });
            }
        }
    }
    Changes { touched, candidates }
}
