//! `splitString` (reference 6.4). In: a text and a delimiter, plain or a regular expression. Out: the parts, empty ones
//! too.
//!
//! An expression that `regex` takes runs in linear time. One that looks around or refers back runs step by step, and
//! may take so many steps that it is stopped: the longer the text, the fewer, as a step may look at all of it.

use fancy_regex::RegexBuilder;

use super::super::array::check_size;
use super::super::derivation::Derivation;
use super::super::limits::Outcome;
use super::super::value::Value;
use super::Input;

/// Largest compiled expression, bytes.
const LARGEST_EXPRESSION: usize = 1 << 20;
/// Instructions of an expression that looks around.
const LARGEST_PROGRAM: usize = 10_000;
/// Steps times bytes of text.
const MOST_WORK: usize = 1 << 28;

/// `splitString(text, delimiter)`. A delimiter that starts with `$` is a regular expression; where it is none, or takes
/// too long, the text comes back whole.
pub fn split(run: &mut Derivation, input: &Input) -> Outcome<Value> {
    let (text, delimiter) = (input.text(0), input.text(1));
    let parts: Result<Vec<&str>, String> = match delimiter.strip_prefix('$').filter(|e| !e.is_empty()) {
        None => Ok(text.split(&*delimiter).collect()),
        Some(expression) => match regex::RegexBuilder::new(expression).size_limit(LARGEST_EXPRESSION).build() {
            Ok(plain) => Ok(plain.split(&text).collect()),
            Err(regex::Error::CompiledTooBig(_)) => Err("this regular expression is too large".into()),
            Err(_) => Stepwise::new(expression, text.len()).and_then(|steps| steps.split(&text)),
        },
    };
    match parts {
        Ok(parts) => {
            check_size(run, parts.len(), input.span)?;
            Ok(Value::strings(parts.into_iter().map(Into::into).collect()))
        }
        Err(why) => {
            run.error("cga::regular-expression", input.span, why);
            Ok(Value::strings(vec![text]))
        }
    }
}

/// An expression that looks around, and the steps it has left.
struct Stepwise<'e> {
    expression: &'e str,
    regex: fancy_regex::Regex,
    /// Steps of one search: ten times as many after each that was too short.
    steps: usize,
    left: usize,
}

impl<'e> Stepwise<'e> {
    fn new(expression: &'e str, length: usize) -> Result<Stepwise<'e>, String> {
        const FIRST: usize = 100;
        let regex = built(expression, FIRST)?;
        Ok(Stepwise { expression, regex, steps: FIRST, left: MOST_WORK / length.max(64) })
    }

    fn split(mut self, text: &str) -> Result<Vec<&str>, String> {
        let (mut parts, mut start, mut at) = (Vec::new(), 0, 0);
        let mut last = None;
        while let Some((from, to)) = self.find(text, at)? {
            let next_character = || text[to..].chars().next().map(|c| to + c.len_utf8());
            // Nothing between this match and the one before it is no place to split at.
            let again = from == to && last == Some(to);
            if !again {
                parts.push(&text[start..from]);
                (start, last) = (to, Some(to));
            }
            match if from == to { next_character() } else { Some(to) } {
                Some(next) => at = next,
                None => break,
            }
        }
        parts.push(&text[start..]);
        Ok(parts)
    }

    /// The first match from a byte on.
    fn find(&mut self, text: &str, at: usize) -> Result<Option<(usize, usize)>, String> {
        use fancy_regex::{Error, RuntimeError};
        loop {
            let spent = self.left.checked_sub(self.steps);
            self.left = spent.ok_or_else(|| {
                format!("this regular expression takes too many steps on a text of {} bytes", text.len())
            })?;
            match self.regex.find_from_pos(text, at) {
                Ok(found) => return Ok(found.map(|m| (m.start(), m.end()))),
                Err(Error::RuntimeError(RuntimeError::BacktrackLimitExceeded)) => {
                    self.steps *= 10;
                    self.regex = built(self.expression, self.steps)?;
                }
                Err(error) => return Err(format!("this regular expression does not run: {error}")),
            }
        }
    }
}

fn built(expression: &str, steps: usize) -> Result<fancy_regex::Regex, String> {
    let mut builder = RegexBuilder::new(expression);
    builder.backtrack_limit(steps).delegate_size_limit(LARGEST_EXPRESSION).max_prog_size(LARGEST_PROGRAM);
    builder.build().map_err(|error| format!("not a regular expression: {error}"))
}
