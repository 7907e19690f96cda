//! In: expressions. Out: numbers in metres, degrees and plain units, distributions, words, paths.
//!
//! Every function gives `None` after reporting why, or silently for an input that has no value yet.

use super::Checker;
use crate::diagnostics::suggest;
use crate::source::Span;
use crate::spec::ast::{CallArgument, Expr, ExprKind, Property};
use crate::spec::draw::Distribution;
use crate::spec::inherit::not_yet;
use crate::spec::render_spec::{FileRef, Origin};
use crate::spec::units::{Dimension, unit};

/// The prefix of rule files that come with the program.
const SHIPPED: &str = "mansard:";

impl Checker<'_> {
    /// The only value of a property that has just one.
    pub fn one<'p>(&mut self, property: &'p Property) -> Option<&'p Expr> {
        self.one_of(&property.values, &property.key.text, property.span)
    }

    pub fn one_of<'p>(&mut self, values: &'p [Expr], key: &str, span: Span) -> Option<&'p Expr> {
        if let [value] = values {
            return Some(value);
        }
        if !values.iter().any(is_unbound) {
            self.error("spec::wrong-value", span, format!("`{key}` takes one value, not {}", values.len()));
        }
        None
    }

    /// Reports a value of the wrong kind.
    pub fn wrong(&mut self, value: &Expr, expected: &str) {
        if !is_unbound(value) {
            self.error("spec::wrong-value", value.span, format!("`{value}` is not {expected}"));
        }
    }

    pub fn not_yet(&mut self, what: &str, span: Span) {
        self.diagnostics.push(not_yet(what, span));
    }

    /// A number with a unit that fits the dimension.
    pub fn quantity(&mut self, value: &Expr, dimension: Dimension) -> Option<f64> {
        let ExprKind::Quantity { value: number, unit: written } = &value.kind else {
            self.wrong(value, dimension.name());
            return None;
        };
        match (written.as_deref(), dimension) {
            (None, Dimension::Plain | Dimension::Pixels) => Some(*number),
            (None, _) => {
                let message = format!("`{value}` has no unit, but {} is due", dimension.name());
                let help = format!("write `{value}{}`; these fit: {}", dimension.usual_unit(), dimension.units());
                self.error_with_help("spec::missing-unit", value.span, message, help);
                None
            }
            (Some(written), _) => self.with_unit(value, *number, written, dimension),
        }
    }

    fn with_unit(&mut self, value: &Expr, number: f64, written: &str, dimension: Dimension) -> Option<f64> {
        let Some((found, size)) = unit(written) else {
            let message = format!("there is no unit `{written}`");
            self.error_with_help("spec::unknown-unit", value.span, message, fitting(dimension));
            return None;
        };
        if found != dimension {
            let message = format!("`{value}` is {}, but {} is due", found.name(), dimension.name());
            self.error_with_help("spec::wrong-unit", value.span, message, fitting(dimension));
            return None;
        }
        // Dividing keeps 40 % and 50 cm the nearest doubles to 0.4 and 0.5.
        Some(if size < 1.0 { number / (1.0 / size).round() } else { number * size }).filter(|n| n.is_finite()).or_else(
            || {
                self.error("spec::number-too-large", value.span, format!("`{value}` is too large"));
                None
            },
        )
    }

    /// A number or how to draw one, read number by number with `read`.
    pub fn distribution_by(
        &mut self,
        value: &Expr,
        expected: &str,
        read: &mut dyn FnMut(&mut Self, &Expr) -> Option<f64>,
    ) -> Option<Distribution> {
        let ExprKind::Call { name, arguments } = &value.kind else {
            return read(self, value).map(Distribution::Fixed);
        };
        match name.text.as_str() {
            "uniform" => {
                let (low, high) = self.two(value, arguments, "uniform(least, greatest)", read)?;
                if low > high {
                    let message = format!("the least value of `{value}` is greater than the greatest");
                    self.error("spec::wrong-value", value.span, message);
                    return None;
                }
                Some(Distribution::Uniform { low, high })
            }
            "normal" => {
                let (mean, deviation) = self.two(value, arguments, "normal(mean, deviation)", read)?;
                if deviation < 0.0 {
                    self.error("spec::wrong-value", value.span, format!("the deviation of `{value}` is negative"));
                    return None;
                }
                Some(Distribution::Normal { mean, deviation })
            }
            "choice" => {
                let weights = self.weights(value, arguments)?;
                let mut alternatives = Vec::new();
                for (argument, weight) in arguments.iter().zip(weights) {
                    alternatives.push((self.distribution_by(&argument.value, expected, read)?, weight));
                }
                Some(Distribution::Choice(alternatives))
            }
            other => {
                let message = format!("there is no distribution `{other}`");
                let near = suggest(other, ["uniform", "normal", "choice"]);
                let help = near.map(|name| format!("did you mean `{name}`?"));
                let help = help.unwrap_or_else(|| format!("{expected} is due, or `uniform`, `normal`, `choice`"));
                self.error_with_help("spec::unknown-distribution", name.span, message, help);
                None
            }
        }
    }

    fn two(
        &mut self,
        value: &Expr,
        arguments: &[CallArgument],
        form: &str,
        read: &mut dyn FnMut(&mut Self, &Expr) -> Option<f64>,
    ) -> Option<(f64, f64)> {
        let plain = arguments.iter().all(|argument| argument.name.is_none() && argument.weight.is_none());
        let [first, second] = arguments else {
            self.error("spec::wrong-value", value.span, format!("`{value}` is not of the form `{form}`"));
            return None;
        };
        if !plain {
            self.error("spec::wrong-value", value.span, format!("`{value}` is not of the form `{form}`"));
            return None;
        }
        let (first, second) = (read(self, &first.value), read(self, &second.value));
        first.zip(second)
    }

    /// The weights of `choice`: all given or none.
    pub fn weights(&mut self, value: &Expr, arguments: &[CallArgument]) -> Option<Vec<f64>> {
        let weighted = arguments.iter().filter(|argument| argument.weight.is_some()).count();
        let named = arguments.iter().any(|argument| argument.name.is_some());
        if arguments.is_empty() || named || (weighted != 0 && weighted != arguments.len()) {
            let message = format!("`{value}` is not of the form `choice(a, b, …)` or `choice(70%: a, 30%: b, …)`");
            self.error("spec::wrong-value", value.span, message);
            return None;
        }
        arguments.iter().map(|argument| argument.weight.as_ref().map_or(Some(1.0), |w| self.weight(w))).collect()
    }

    /// A positive share or plain number.
    pub fn weight(&mut self, value: &Expr) -> Option<f64> {
        let dimension = match &value.kind {
            ExprKind::Quantity { unit: Some(_), .. } => Dimension::Share,
            _ => Dimension::Plain,
        };
        let weight = self.quantity(value, dimension)?;
        if weight <= 0.0 {
            self.error("spec::out-of-range", value.span, format!("the weight `{value}` is not positive"));
            return None;
        }
        Some(weight)
    }

    /// A number of the dimension, or how to draw one.
    pub fn distribution(&mut self, value: &Expr, dimension: Dimension) -> Option<Distribution> {
        self.distribution_by(value, dimension.name(), &mut |checker, value| checker.quantity(value, dimension))
    }

    /// The distribution of a property, all of it inside `low..=high`.
    pub fn bounded(
        &mut self,
        properties: &[Property],
        key: &str,
        dimension: Dimension,
        (low, high): (f64, f64),
    ) -> Result<Option<Distribution>, ()> {
        let Some(property) = super::get(properties, key) else { return Ok(None) };
        let value = self.one(property).ok_or(())?;
        let distribution = self.distribution(value, dimension).ok_or(())?;
        self.within(&distribution, &format!("`{key}`"), value, dimension, (low, high)).ok_or(())?;
        Ok(Some(distribution))
    }

    /// Reports what can be drawn outside `low..=high`.
    pub fn within(
        &mut self,
        drawn: &Distribution,
        what: &str,
        value: &Expr,
        dimension: Dimension,
        (low, high): (f64, f64),
    ) -> Option<()> {
        let (least, greatest) = drawn.bounds();
        if least >= low && greatest <= high {
            return Some(());
        }
        let unit = dimension.usual_unit();
        let (low, high) = if dimension == Dimension::Share { (low * 100.0, high * 100.0) } else { (low, high) };
        let message = if high.is_finite() {
            format!("{what} lies between {low}{unit} and {high}{unit}, `{value}` does not")
        } else {
            format!("{what} is at least {low}{unit}, `{value}` can be less")
        };
        self.error("spec::out-of-range", value.span, message);
        None
    }

    /// A whole number in `low..=high`.
    pub fn whole(&mut self, value: &Expr, dimension: Dimension, low: u64, high: u64) -> Option<u64> {
        let number = self.quantity(value, dimension)?;
        if number.fract() != 0.0 || number < low as f64 || number > high as f64 {
            let message = format!("`{value}` is not a whole number from {low} to {high}");
            self.error("spec::out-of-range", value.span, message);
            return None;
        }
        Some(number as u64)
    }

    /// One of these words. Words that come `later` are part of the language and not evaluated yet.
    pub fn word(&mut self, value: &Expr, words: &[&'static str], later: &[&'static str]) -> Option<&'static str> {
        let (ExprKind::Word(found) | ExprKind::Call { name: crate::spec::ast::Name { text: found, .. }, .. }) =
            &value.kind
        else {
            self.wrong(value, &one_of(words));
            return None;
        };
        if let Some(word) = words.iter().find(|word| **word == *found) {
            return Some(word);
        }
        if later.contains(&found.as_str()) {
            self.not_yet(found, value.span);
            return None;
        }
        let message = format!("`{found}` is not {}", one_of(words));
        match suggest(found, words.iter().chain(later).copied()) {
            Some(near) => {
                self.error_with_help("spec::wrong-value", value.span, message, format!("did you mean `{near}`?"));
            }
            None => self.error("spec::wrong-value", value.span, message),
        }
        None
    }

    pub fn text(&mut self, value: &Expr, what: &str) -> Option<String> {
        let ExprKind::Text(text) = &value.kind else {
            self.wrong(value, &format!("{what} in quotes"));
            return None;
        };
        if text.is_empty() {
            self.error("spec::wrong-value", value.span, format!("{what} is empty"));
            return None;
        }
        Some(text.clone())
    }

    /// A path; `mansard:` names a rule file that comes with the program where `shipped` allows it.
    pub fn file(&mut self, value: &Expr, shipped: bool) -> Option<FileRef> {
        let written = self.text(value, "a path")?;
        match written.strip_prefix(SHIPPED) {
            Some(name) if shipped => {
                Some(FileRef { written: name.to_owned(), origin: Origin::Shipped, span: value.span })
            }
            Some(_) => {
                self.error("spec::wrong-value", value.span, "only rule files come with the program");
                None
            }
            None => Some(FileRef { written, origin: self.folders.origin(value.span.source), span: value.span }),
        }
    }
}

/// An input that `mansard check` was not given.
pub fn is_unbound(value: &Expr) -> bool {
    matches!(value.kind, ExprKind::Argument(_))
}

fn fitting(dimension: Dimension) -> String {
    match dimension {
        Dimension::Plain => "no unit is due here".to_owned(),
        _ => format!("these fit: {}", dimension.units()),
    }
}

fn one_of(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    match quoted.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("one of {} and {last}", rest.join(", ")),
        None => "a word".to_owned(),
    }
}
