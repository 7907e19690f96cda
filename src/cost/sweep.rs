//! Sweep: a bench and the recipe's own quality → errors and times of every setting.
//!
//! Each value of a knob is measured twice: *alone*, with everything else as fine as it gets, which is the error that the
//! knob itself makes; and with everything else as the recipe has it, which is what an image gets and what it takes.

use super::bench::{Bench, CostError, Setting, Times};
use super::errors::{Errors, Metric};
use super::knobs::{FINE, Subject, Unswept, combinations, knobs, unswept};
use super::pareto::{Measured, frontier, joint_frontier};
use crate::plan::demand::Quality;

/// What a row is a value of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Preset,
    Knob,
    Combination,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Kind::Preset => "preset",
            Kind::Knob => "knob",
            Kind::Combination => "combination",
        }
    }
}

/// One setting that was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub kind: Kind,
    /// `preset` or `combination` where it is none.
    pub knob: &'static str,
    pub value: String,
    pub setting: Setting,
    /// With all other knobs fine; of a knob's row only.
    pub alone: Option<Errors>,
    /// As an image gets it.
    pub errors: Errors,
    pub times: Times,
}

/// A knob and what is told about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KnobText {
    pub name: &'static str,
    pub metric: Metric,
    pub about: &'static str,
}

/// Everything that was measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sweep {
    pub rows: Vec<Row>,
    pub knobs: Vec<KnobText>,
    pub unswept: Vec<Unswept>,
}

/// How often images are drawn for their time, and whom to tell of every setting.
pub struct Work<'a> {
    pub repeats: usize,
    pub told: &'a dyn Fn(&str),
}

impl Sweep {
    /// Measures presets (the recipe's own quality among them), all knobs and their combinations.
    pub fn measure(
        &mut self,
        bench: &mut Bench,
        subject: Subject,
        presets: &[(String, Quality)],
        own: Quality,
        work: &Work,
    ) -> Result<(), CostError> {
        for (name, quality) in presets {
            self.row(bench, (Kind::Preset, "preset"), name, Setting::of(*quality), None, work)?;
        }
        for knob in knobs(subject) {
            for value in &knob.values {
                let alone = bench.errors(&value.change.apply(&Setting::of(FINE)))?;
                let setting = value.change.apply(&Setting::of(own));
                self.row(bench, (Kind::Knob, knob.name), &value.name, setting, Some(alone), work)?;
            }
            self.knobs.push(KnobText { name: knob.name, metric: knob.metric, about: knob.about });
        }
        for (name, quality) in combinations(subject, own) {
            self.row(bench, (Kind::Combination, "combination"), &name, Setting::of(quality), None, work)?;
        }
        self.unswept.extend(unswept(subject));
        Ok(())
    }

    /// Measures a value of a knob that changes the scene, which the bench holds already.
    pub fn scene_value(
        &mut self,
        bench: &mut Bench,
        knob: &KnobText,
        value: &str,
        own: Quality,
        work: &Work,
    ) -> Result<(), CostError> {
        let alone = bench.errors(&Setting::of(FINE))?;
        self.row(bench, (Kind::Knob, knob.name), value, Setting::of(own), Some(alone), work)?;
        if !self.knobs.contains(knob) {
            self.knobs.push(knob.clone());
        }
        Ok(())
    }

    fn row(
        &mut self,
        bench: &mut Bench,
        (kind, knob): (Kind, &'static str),
        value: &str,
        setting: Setting,
        alone: Option<Errors>,
        work: &Work,
    ) -> Result<(), CostError> {
        (work.told)(&format!("{knob} {value}"));
        let errors = bench.errors(&setting)?;
        let times = bench.time(&setting, work.repeats)?;
        self.rows.push(Row { kind, knob, value: value.to_owned(), setting, alone, errors, times });
        Ok(())
    }

    /// Rows of a knob, in the order of its values.
    pub fn of_knob(&self, knob: &str) -> Vec<&Row> {
        self.rows.iter().filter(|row| row.kind == Kind::Knob && row.knob == knob).collect()
    }

    /// One flag per row: whether no other setting is both faster and better by this metric.
    pub fn frontier(&self, metric: Metric) -> Vec<bool> {
        let points: Vec<_> = self.rows.iter().map(|row| (row.times.median, row.errors.get(metric))).collect();
        frontier(&points)
    }

    /// One flag per row: no other setting is faster beyond the spread of times, better by one metric and worse by none.
    pub fn joint_frontier(&self) -> Vec<bool> {
        let measured = |row: &Row| Measured {
            time: (row.times.least, row.times.most),
            errors: Metric::ALL.map(|metric| row.errors.get(metric)).to_vec(),
        };
        joint_frontier(&self.rows.iter().map(measured).collect::<Vec<_>>())
    }
}
