//! In: the terms of a block's body. Out: its properties, cut by the [`schema`](super::schema).
//!
//! A property ends at the end of its line, at `;`, or where the next key of the block stands. A line goes on after a
//! comma, inside brackets, and where the next line starts with a clause word of the property or with no word at all.

use pest::iterators::{Pair, Pairs};

use super::ast::{Assignment, Clause, Expr, ExprKind, Name, Property};
use super::parse::{Reader, Rule};
use super::schema::{BLOCKS, BlockShape, Key};
use crate::diagnostics::{Diagnostic, suggest};

/// Cuts a body into properties. Unknown keys are reported and left out.
pub(super) fn properties(reader: &mut Reader, kind: &Name, tokens: Pairs<Rule>) -> Vec<Property> {
    let shape = BlockShape::find(&kind.text);
    if shape.is_none() {
        let message = format!("there is no block `{}`", kind.text);
        let near = suggest(&kind.text, BLOCKS.iter().map(|block| block.kind));
        let help = near.map(|name| format!("did you mean `{name}`?")).unwrap_or_else(|| {
            let kinds: Vec<String> = BLOCKS.iter().map(|block| format!("`{}`", block.kind)).collect();
            format!("the blocks are {}", kinds.join(", "))
        });
        reader.diagnostics.push(Diagnostic::error("spec::unknown-block", kind.span, message).help(help));
        return Vec::new();
    }
    let mut cutter = Cutter { reader, shape: shape.expect("just checked"), open: None, done: Vec::new(), comma: None };
    let mut end = kind.span.end as usize;
    for token in tokens {
        let (start, next_end) = (token.as_span().start(), token.as_span().end());
        let newline = cutter.reader.text[end..start].contains('\n');
        end = start + cutter.reader.text[start..next_end].trim_end().len();
        cutter.token(token, newline);
    }
    cutter.finish();
    cutter.done
}

/// The property that is being read.
struct Open {
    property: Property,
    /// `None`: unknown, read to its end and dropped.
    key: Option<&'static Key>,
    /// One complaint about its form is enough.
    malformed: bool,
}

struct Cutter<'r, 'a> {
    reader: &'r mut Reader<'a>,
    shape: &'static BlockShape,
    open: Option<Open>,
    done: Vec<Property>,
    /// A comma that still waits for its value.
    comma: Option<crate::source::Span>,
}

impl Cutter<'_, '_> {
    fn token(&mut self, token: Pair<Rule>, newline: bool) {
        let span = self.reader.span(&token);
        match token.as_rule() {
            Rule::expr => {
                let value = self.reader.expression(token);
                self.value(value, newline);
            }
            Rule::comma => {
                if self.open.as_ref().is_none_or(|open| open.last_values().is_empty()) || self.comma.is_some() {
                    self.malformed(span, "a comma stands between two values");
                }
                self.comma = Some(span);
            }
            Rule::semicolon => self.finish(),
            Rule::assignments => self.body(token),
            _ => {
                self.reader.unreadable(&token);
                if let Some(open) = &mut self.open {
                    open.malformed = true;
                }
            }
        }
    }

    fn value(&mut self, value: Expr, newline: bool) {
        if let ExprKind::Word(word) = &value.kind
            && self.comma.is_none()
        {
            let clause = self.open.as_ref().and_then(|open| open.key).is_some_and(|key| key.clauses.contains(&&**word));
            let key = self.shape.key(word).is_some();
            let name = Name { text: word.clone(), span: value.span };
            if self.open.is_none() || (key && (newline || !clause)) || (newline && !clause) {
                self.finish();
                return self.start(name);
            }
            if clause {
                let open = self.open.as_mut().expect("a clause belongs to an open property");
                open.property.clauses.push(Clause { word: name, values: Vec::new() });
                open.property.span = open.property.span.to(value.span);
                return;
            }
        }
        let comma = self.comma.take();
        let Some(open) = &mut self.open else {
            return self.malformed(value.span, "a property starts with its name");
        };
        if comma.is_none() && !open.last_values().is_empty() {
            let message = format!("`{}` does not belong to what stands before it", self.reader.slice(value.span));
            let help = open.last_values().last().and_then(|before| join_help(before, &value));
            let diagnostic = Diagnostic::error("spec::syntax", value.span, message)
                .help(help.unwrap_or_else(|| "values are separated by commas, properties by line ends or `;`".into()));
            if !std::mem::replace(&mut open.malformed, true) {
                self.reader.diagnostics.push(diagnostic);
            }
            return;
        }
        open.property.span = open.property.span.to(value.span);
        match open.property.clauses.last_mut() {
            Some(clause) => clause.values.push(value),
            None => open.property.values.push(value),
        }
    }

    fn start(&mut self, key: Name) {
        let found = self.shape.key(&key.text);
        if found.is_none() {
            let message = format!("`{}` has no property `{}`", self.shape.kind, key.text);
            let near = suggest(&key.text, self.shape.keys.iter().map(|key| key.key));
            let help = near.map(|name| format!("did you mean `{name}`?")).unwrap_or_else(|| {
                let keys: Vec<String> = self.shape.keys.iter().map(|key| format!("`{}`", key.key)).collect();
                format!("its properties are {}", keys.join(", "))
            });
            self.reader.diagnostics.push(Diagnostic::error("spec::unknown-property", key.span, message).help(help));
        }
        let span = key.span;
        let property = Property { key, values: Vec::new(), clauses: Vec::new(), body: None, span };
        self.open = Some(Open { property, key: found, malformed: found.is_none() });
    }

    fn body(&mut self, token: Pair<Rule>) {
        let span = self.reader.span(&token);
        let mut assignments = Vec::new();
        for part in token.into_inner() {
            if part.as_rule() != Rule::assignment {
                self.reader.unreadable(&part);
                continue;
            }
            let mut inner = part.into_inner();
            let name = self.reader.name(&inner.next().expect("an assignment has a name"));
            let value = self.reader.expression(inner.next().expect("an assignment has a value"));
            assignments.push(Assignment { name, value });
        }
        let takes = self.open.as_ref().is_some_and(|open| open.key.is_none_or(|key| key.body));
        if !takes {
            return self.malformed(span, "`{ … }` does not belong here");
        }
        let open = self.open.as_mut().expect("just checked");
        open.property.span = open.property.span.to(span);
        if open.property.body.replace(assignments).is_some() {
            self.malformed(span, "a property has one `{ … }`");
        }
    }

    fn malformed(&mut self, span: crate::source::Span, message: &str) {
        let silent = self.open.as_mut().is_some_and(|open| std::mem::replace(&mut open.malformed, true));
        if !silent {
            self.reader.error("spec::syntax", span, message);
        }
    }

    /// Ends the open property.
    fn finish(&mut self) {
        if let Some(comma) = self.comma.take() {
            self.malformed(comma, "nothing follows this comma");
        }
        let Some(open) = self.open.take() else { return };
        if let Some(clause) = open.property.clauses.iter().find(|clause| clause.values.is_empty())
            && !open.malformed
        {
            let message = format!("nothing follows `{}`", clause.word.text);
            self.reader.error("spec::syntax", clause.word.span, message);
            return;
        }
        let clauses = &open.property.clauses;
        let repeated = (1..clauses.len()).find(|&i| clauses[..i].iter().any(|c| c.word.text == clauses[i].word.text));
        if let Some(repeated) = repeated.map(|i| &clauses[i].word)
            && !open.malformed
        {
            let message = format!("`{}` is given twice", repeated.text);
            self.reader.error("spec::repeated-property", repeated.span, message);
            return;
        }
        if !open.malformed {
            self.done.push(open.property);
        }
    }
}

impl Open {
    /// The values of what is being read: of the last clause, or of the property itself.
    fn last_values(&self) -> &[Expr] {
        self.property.clauses.last().map_or(&self.property.values, |clause| &clause.values)
    }
}

/// `30 deg` is written `30deg`.
fn join_help(before: &Expr, value: &Expr) -> Option<String> {
    match (&before.kind, &value.kind) {
        (ExprKind::Quantity { unit: None, .. }, ExprKind::Word(unit)) if super::units::is_unit(unit) => {
            Some(format!("a unit stands right after its number: `{before}{unit}`"))
        }
        _ => None,
    }
}
