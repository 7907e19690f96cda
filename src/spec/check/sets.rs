//! In: set expressions of passes. Out: a [`SetSpec`].

use super::Checker;
use crate::spec::ast::{Expr, ExprKind};
use crate::spec::filter::{CLASSES, class_named};
use crate::spec::inherit::unknown_name;
use crate::spec::render_spec::SetSpec;

impl Checker<'_> {
    /// `building & changed | terrain`; `changes` are the names of the recipe's changes.
    pub fn set(&mut self, value: &Expr, changes: &[String]) -> Option<SetSpec> {
        match &value.kind {
            ExprKind::Or(sets) => self.sets(sets, changes).map(SetSpec::Any),
            ExprKind::And(sets) => self.sets(sets, changes).map(SetSpec::Every),
            ExprKind::Not(set) => self.set(set, changes).map(|set| SetSpec::Not(Box::new(set))),
            ExprKind::Word(word) => self.named_set(word, value, changes),
            ExprKind::Filter { .. } | ExprKind::Object { .. } => {
                self.not_yet(&value.to_string(), value.span);
                None
            }
            _ => {
                self.wrong(value, "a set of objects, such as `all`, `building & changed` or the name of a change");
                None
            }
        }
    }

    /// Several sets with commas between them are their union.
    pub fn union(&mut self, values: &[Expr], changes: &[String]) -> Option<SetSpec> {
        let mut sets = self.sets(values, changes)?;
        if sets.len() == 1 { sets.pop() } else { Some(SetSpec::Any(sets)) }
    }

    fn sets(&mut self, values: &[Expr], changes: &[String]) -> Option<Vec<SetSpec>> {
        let sets: Vec<Option<SetSpec>> = values.iter().map(|value| self.set(value, changes)).collect();
        sets.into_iter().collect()
    }

    fn named_set(&mut self, word: &str, value: &Expr, changes: &[String]) -> Option<SetSpec> {
        match word {
            "all" => return Some(SetSpec::All),
            "terrain" => return Some(SetSpec::Terrain),
            "vegetation" => return Some(SetSpec::Vegetation),
            "changed" => return Some(SetSpec::Changed),
            "unchanged" => return Some(SetSpec::Not(Box::new(SetSpec::Changed))),
            "building_part" => {
                self.not_yet(word, value.span);
                return None;
            }
            _ => {}
        }
        if let Some(class) = class_named(word) {
            return Some(SetSpec::Class(class));
        }
        let change = changes.iter().position(|name| name == word);
        if change.is_none() {
            let fixed = ["all", "terrain", "vegetation", "changed", "unchanged"];
            let classes = CLASSES.iter().map(|(name, _)| *name);
            let known = fixed.into_iter().chain(classes).chain(changes.iter().map(String::as_str));
            self.diagnostics.push(unknown_name("set of objects", word, value.span, known));
        }
        change.map(SetSpec::Change)
    }
}
