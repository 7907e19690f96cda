//! In: a `change` block. Out: a [`ChangeSpec`].

use super::{Checker, all, get};
use crate::spec::ast::{Block, ExprKind, Property};
use crate::spec::filter::Filter;
use crate::spec::render_spec::{Amount, ChangeSpec, LevelEffect, LevelSpec, RuleAssignment};
use crate::spec::units::Dimension;

/// Levels are written to 8-bit images.
const MOST_LEVELS: usize = 255;

impl Checker<'_> {
    pub fn change(&mut self, block: &Block) -> Option<ChangeSpec> {
        let properties = &block.properties;
        let of = self.required(properties, "of", block.span, "a change").and_then(|of| {
            if of.values.is_empty() {
                self.error("spec::wrong-value", of.span, "`of` names the features that may change");
                return None;
            }
            self.filter(&of.values)
        });
        let amount = self.amount(properties);
        let levels = self.levels(block);
        let non_target = match get(properties, "non_target") {
            None => Some(false),
            Some(property) if property.values.is_empty() => Some(true),
            Some(property) => {
                self.one(property).and_then(|v| self.word(v, &["true", "false"], &[])).map(|word| word == "true")
            }
        };
        Some(ChangeSpec {
            name: self.block_name(block),
            span: block.span,
            of: of?,
            amount: amount?,
            levels: levels?,
            non_target: non_target?,
        })
    }

    fn amount(&mut self, properties: &[Property]) -> Option<Amount> {
        let share = self.bounded(properties, "share", Dimension::Share, (0.0, 1.0));
        let count = self.bounded(properties, "count", Dimension::Plain, (0.0, f64::INFINITY));
        match (share.ok()?, count.ok()?) {
            (None, None) => Some(Amount::All),
            (Some(share), None) => Some(Amount::Share(share)),
            (None, Some(count)) => Some(Amount::Count(count)),
            (Some(_), Some(_)) => {
                let count = get(properties, "count").expect("just read");
                self.error("spec::over-determined", count.span, "a change has a `share` or a `count`, not both");
                None
            }
        }
    }

    fn levels(&mut self, block: &Block) -> Option<Vec<LevelSpec>> {
        let properties = &block.properties;
        let levels: Vec<&Property> = all(properties, "level").collect();
        let rules: Vec<&Property> = all(properties, "rules").collect();
        let effect = get(properties, "effect");
        if levels.is_empty() {
            let rules: Vec<Option<RuleAssignment>> = rules.into_iter().map(|rules| self.rules(rules)).collect();
            let rules = rules.into_iter().collect::<Option<Vec<_>>>();
            let effect = match effect {
                Some(effect) => self.one(effect).and_then(|value| self.effect(value)).map(Some),
                None => Some(None),
            };
            let effect = self.one_effect(rules?, effect?, block.span)?;
            return Some(vec![LevelSpec { name: self.block_name(block), weight: 1.0, effect, span: block.span }]);
        }
        if let Some(stray) = rules.first().copied().or(effect) {
            let message = format!("a change with levels has its `{}` in the levels", stray.key.text);
            self.error("spec::over-determined", stray.span, message);
            return None;
        }
        if levels.len() > MOST_LEVELS {
            self.error("spec::out-of-range", block.span, format!("a change has at most {MOST_LEVELS} levels"));
            return None;
        }
        let weighted = levels.iter().filter(|level| level.clause("share").is_some()).count();
        if weighted != 0 && weighted != levels.len() {
            self.error("spec::missing-property", block.span, "all levels of a change have a `share`, or none has");
            return None;
        }
        let read: Vec<Option<LevelSpec>> = levels.into_iter().map(|level| self.level(level)).collect();
        read.into_iter().collect()
    }

    /// `level destroyed share 30% rules "…" { attribute = value }`.
    fn level(&mut self, property: &Property) -> Option<LevelSpec> {
        let name = match self.one(property)? {
            value if matches!(value.kind, ExprKind::Word(_)) => value.to_string(),
            value => {
                self.wrong(value, "the name of a level");
                return None;
            }
        };
        let weight = match property.clause("share") {
            Some(clause) => self.one_of(&clause.values, "share", clause.word.span).and_then(|v| self.weight(v)),
            None => Some(1.0),
        };
        let rules = match property.clause("rules") {
            Some(clause) => {
                let mut read = Vec::new();
                for value in &clause.values {
                    read.push(RuleAssignment {
                        file: self.rule_file(value)?,
                        start: self.start(property)?,
                        filter: Filter::all(),
                        attributes: self.attributes(property.body.as_deref().unwrap_or_default())?,
                        span: property.span,
                    });
                }
                read
            }
            None => Vec::new(),
        };
        let effect = match property.clause("effect") {
            Some(clause) => {
                Some(self.one_of(&clause.values, "effect", clause.word.span).and_then(|value| self.effect(value))?)
            }
            None => None,
        };
        let effect = self.one_effect(rules, effect, property.span)?;
        Some(LevelSpec { name, weight: weight?, effect, span: property.span })
    }

    fn effect(&mut self, value: &crate::spec::ast::Expr) -> Option<LevelEffect> {
        Some(match self.word(value, &["demolished", "built"], &[])? {
            "demolished" => LevelEffect::Demolished,
            _ => LevelEffect::Built,
        })
    }

    fn one_effect(
        &mut self,
        rules: Vec<RuleAssignment>,
        effect: Option<LevelEffect>,
        span: crate::source::Span,
    ) -> Option<LevelEffect> {
        match effect {
            None if rules.is_empty() => {
                let help = "give `rules \"…\"`, `effect demolished` or `effect built`";
                self.error_with_help("spec::missing-property", span, "nothing says what the change does", help);
                None
            }
            None => Some(LevelEffect::Rules(rules)),
            Some(effect) if rules.is_empty() => Some(effect),
            Some(_) => {
                self.error("spec::over-determined", span, "a change has `rules` or an `effect`, not both");
                None
            }
        }
    }
}
