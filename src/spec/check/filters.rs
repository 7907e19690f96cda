//! In: filters, rule assignments and attribute values as written. Out: their checked forms.

use super::Checker;
use super::values::is_unbound;
use crate::source::Span;
use crate::spec::ast::{Assignment, Expr, ExprKind, Name, Property, Test};
use crate::spec::filter::{CLASSES, Filter, FilterTerm, Order, TagTest, class_named};
use crate::spec::inherit::unknown_name;
use crate::spec::render_spec::{AttributeSpec, AttributeValue, RuleAssignment, ValueSpec};
use crate::spec::units::{Dimension, unit};

impl Checker<'_> {
    /// `building[house], highway, way/123`.
    pub fn filter(&mut self, values: &[Expr]) -> Option<Filter> {
        let terms: Vec<Option<FilterTerm>> = values.iter().map(|value| self.filter_term(value)).collect();
        Some(Filter { terms: terms.into_iter().collect::<Option<_>>()? })
    }

    fn filter_term(&mut self, value: &Expr) -> Option<FilterTerm> {
        match &value.kind {
            ExprKind::Word(word) if word == "all" => Some(FilterTerm::Class { class: None, tags: None }),
            ExprKind::Word(word) => self.class(word, value.span).map(|class| FilterTerm::Class { class, tags: None }),
            ExprKind::Filter { class, test } => {
                let class = self.class(&class.text, class.span)?;
                Some(FilterTerm::Class { class, tags: Some(self.test(test)?) })
            }
            ExprKind::Object { kind, id } => Some(FilterTerm::Object { kind: *kind, id: *id }),
            _ => {
                self.wrong(value, "a class of features, such as `building[house]`, or an object, such as `way/123`");
                None
            }
        }
    }

    fn class(&mut self, word: &str, span: Span) -> Option<Option<crate::geodata::feature::FeatureClass>> {
        if word == "all" {
            return Some(None);
        }
        let class = class_named(word);
        if class.is_none() {
            self.diagnostics.push(unknown_name("class", word, span, CLASSES.iter().map(|(name, _)| *name)));
        }
        class.map(Some)
    }

    fn test(&mut self, test: &Test) -> Option<TagTest> {
        match test {
            Test::Any(tests) => self.tests(tests).map(TagTest::Any),
            Test::All(tests) => self.tests(tests).map(TagTest::All),
            Test::Not(test) => self.test(test).map(|test| TagTest::Not(Box::new(test))),
            Test::Kind(name) => Some(TagTest::Kind(name.text.clone())),
            Test::Compare { tag, operator, value } => self.comparison(tag, operator, value.as_deref()),
        }
    }

    fn tests(&mut self, tests: &[Test]) -> Option<Vec<TagTest>> {
        tests.iter().map(|test| self.test(test)).collect()
    }

    fn comparison(&mut self, tag: &Name, operator: &str, value: Option<&Expr>) -> Option<TagTest> {
        let key = tag.text.clone();
        let order = match operator {
            "<" => Order::Less,
            "<=" => Order::LessOrEqual,
            ">" => Order::Greater,
            ">=" => Order::GreaterOrEqual,
            equality => {
                let test = match value {
                    None => TagTest::Has(key),
                    Some(value) => TagTest::Is { tag: key, value: tag_text(value) },
                };
                return Some(if equality == "!=" { TagTest::Not(Box::new(test)) } else { test });
            }
        };
        match value.map(|value| (&value.kind, value)) {
            Some((ExprKind::Quantity { unit: None, .. }, value)) => {
                Some(TagTest::Compares { tag: key, order, value: self.quantity(value, Dimension::Plain)? })
            }
            Some((ExprKind::Quantity { .. }, value)) => {
                Some(TagTest::Compares { tag: key, order, value: self.quantity(value, Dimension::Length)? })
            }
            _ => {
                let message = format!("`{}` is compared with a number", tag.text);
                self.error("spec::wrong-value", tag.span, message);
                None
            }
        }
    }

    /// `rules "…" start Lot for building { attribute = value }`.
    pub fn rules(&mut self, property: &Property) -> Option<RuleAssignment> {
        let file = self.one(property).and_then(|value| self.rule_file(value));
        let start = self.start(property);
        let filter = match property.clause("for") {
            Some(clause) => self.filter(&clause.values),
            None => Some(Filter::all()),
        };
        let attributes = self.attributes(property.body.as_deref().unwrap_or_default());
        Some(RuleAssignment {
            file: file?,
            start: start?,
            filter: filter?,
            attributes: attributes?,
            span: property.span,
        })
    }

    pub fn rule_file(&mut self, value: &Expr) -> Option<crate::spec::render_spec::FileRef> {
        self.file(value, true)
    }

    /// The start rule of a property; the inner `None` is the rule file's own.
    pub fn start(&mut self, property: &Property) -> Option<Option<String>> {
        let Some(clause) = property.clause("start") else { return Some(None) };
        let value = self.one_of(&clause.values, "start", clause.word.span)?;
        match &value.kind {
            ExprKind::Word(rule) | ExprKind::Text(rule) => Some(Some(rule.clone())),
            _ => {
                self.wrong(value, "the name of a rule");
                None
            }
        }
    }

    pub fn attributes(&mut self, body: &[Assignment]) -> Option<Vec<AttributeSpec>> {
        let read = body.iter().map(|assignment| {
            let value = self.attribute_value(&assignment.value)?;
            Some(AttributeSpec { name: assignment.name.text.clone(), value, span: assignment.name.span })
        });
        let read: Vec<Option<AttributeSpec>> = read.collect();
        read.into_iter().collect()
    }

    fn attribute_value(&mut self, value: &Expr) -> Option<AttributeValue> {
        let ExprKind::Call { name, arguments } = &value.kind else {
            return self.value_spec(value).map(AttributeValue::Value);
        };
        if name.text != "tag" {
            return self.value_spec(value).map(AttributeValue::Value);
        }
        let (key, default) = match arguments.as_slice() {
            [key] => (key, None),
            [key, default] => (key, Some(default)),
            _ => {
                self.wrong(value, "of the form `tag(\"key\")` or `tag(\"key\", default)`");
                return None;
            }
        };
        let key = match &key.value.kind {
            ExprKind::Word(key) => Some(key.clone()),
            _ => self.text(&key.value, "the tag's key"),
        };
        let default = default.map(|default| self.value_spec(&default.value));
        Some(AttributeValue::Tag { key: key?, default: default.map_or(Some(None), |value| value.map(Some))? })
    }

    /// A value of the rule language, or how to draw one.
    pub fn value_spec(&mut self, value: &Expr) -> Option<ValueSpec> {
        match &value.kind {
            ExprKind::Text(text) => Some(ValueSpec::Text(text.clone())),
            ExprKind::Word(word) if word == "true" => Some(ValueSpec::Bool(true)),
            ExprKind::Word(word) if word == "false" => Some(ValueSpec::Bool(false)),
            ExprKind::Word(word) => {
                let message = format!("`{word}` is not a value");
                self.error_with_help(
                    "spec::wrong-value",
                    value.span,
                    message,
                    format!("a text is written `\"{word}\"`"),
                );
                None
            }
            ExprKind::Call { name, arguments }
                if name.text == "choice"
                    && arguments.first().is_some_and(|first| matches!(first.value.kind, ExprKind::Text(_))) =>
            {
                let weights = self.weights(value, arguments)?;
                let texts = arguments.iter().map(|argument| self.text(&argument.value, "a text"));
                let texts: Option<Vec<String>> = texts.collect();
                Some(ValueSpec::TextChoice(texts?.into_iter().zip(weights).collect()))
            }
            _ => {
                let mut read = |checker: &mut Self, value: &Expr| checker.any_number(value);
                self.distribution_by(value, "a number", &mut read).map(ValueSpec::Number)
            }
        }
    }

    /// A number with any unit or none.
    fn any_number(&mut self, value: &Expr) -> Option<f64> {
        let written = match &value.kind {
            ExprKind::Quantity { unit, .. } => unit.as_deref(),
            _ if is_unbound(value) => return None,
            _ => {
                self.wrong(value, "a number, a text, `true`, `false`, a distribution or `tag(\"key\")`");
                return None;
            }
        };
        let dimension = written.and_then(unit).map_or(Dimension::Plain, |(dimension, _)| dimension);
        self.quantity(value, dimension)
    }
}

/// The tag value that a literal stands for.
fn tag_text(value: &Expr) -> String {
    match &value.kind {
        ExprKind::Text(text) => text.clone(),
        _ => value.to_string(),
    }
}
