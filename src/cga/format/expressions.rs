//! In: values, expressions and chains. Out: their documents.

use pest::iterators::Pair;

use super::document::{Doc, group};
use super::layout::{Layout, Part, parts};
use crate::cga::parse::Rule;
use crate::cga::parse::tokens::letter;

impl Layout<'_> {
    pub fn expression_node(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        match pair.as_rule() {
            Rule::value => self.value(pair),
            Rule::expression => self.expression(pair),
            Rule::element_value => self.element(pair),
            _ => self.tight(pair),
        }
    }

    fn value(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let is_weighted = pair.clone().into_inner().any(|inner| inner.as_rule() == Rule::value_weights);
        if is_weighted { self.chain(pair) } else { self.tight(pair) }
    }

    /// Operands and operators; lines break in front of the operators that bind least.
    fn expression(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let loosest = pair.clone().into_inner().filter_map(|part| self.looseness(&part)).max();
        let mut docs = Vec::new();
        for part in parts(pair) {
            match part {
                Part::Node(node) if node.as_rule() == Rule::binary_operator => {
                    let breaks = self.looseness(&node) == loosest;
                    docs.push(if breaks { Doc::Fill } else { Doc::Space });
                    docs.extend(self.tight(node));
                    docs.push(Doc::Space);
                }
                part => docs.extend(self.part(part)),
            }
        }
        docs
    }

    /// How little a binary operator binds (reference 1.8).
    fn looseness(&self, pair: &Pair<'_, Rule>) -> Option<u8> {
        if pair.as_rule() != Rule::binary_operator {
            return None;
        }
        Some(match self.tokens.letter(pair.as_span().end() - 1) {
            b'*' | b'/' | b'%' => 0,
            b'+' | b'-' | letter::TIGHT_MINUS => 1,
            letter::EQUAL | letter::NOT_EQUAL => 3,
            letter::AND => 4,
            letter::OR => 5,
            _ => 2,
        })
    }

    /// `a`, `a:b` or `a:step:b`.
    fn element(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let is_long = pair
            .clone()
            .into_inner()
            .any(|value| value.as_rule() == Rule::value && value.as_span().end() - value.as_span().start() > 2);
        if is_long { self.spaced(pair) } else { self.tight(pair) }
    }

    pub fn chain_node(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        match pair.as_rule() {
            Rule::percent => self.spaced(pair),
            _ => self.chain(pair),
        }
    }

    /// A case or percentage chain: branches on lines of their own, or all on one.
    fn chain(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let mut branches =
            Branches { broken: false, widest: self.widest_weight(&pair), docs: Vec::new(), continues: false };
        self.branches(pair, &mut branches);
        vec![group(branches.docs, branches.broken)]
    }

    fn branches(&self, pair: Pair<'_, Rule>, out: &mut Branches) {
        let mut all = Vec::new();
        flatten(pair, &mut all);
        let mut is_else = false;
        let mut parts = all.into_iter().peekable();
        while let Some(part) = parts.next() {
            match part {
                Part::Token(index) => match self.tokens.letter(index) {
                    letter::CASE | letter::ELSE => {
                        is_else = self.tokens.letter(index) == letter::ELSE;
                        self.begin_branch(index, out);
                        out.docs.extend(self.token(index));
                        if !is_else {
                            out.docs.push(Doc::Space);
                        }
                    }
                    _ => {
                        out.docs.push(Doc::Space);
                        out.docs.extend(self.token(index));
                    }
                },
                Part::Node(node) => match node.as_rule() {
                    Rule::expression => self.head(node, parts.peek(), out),
                    Rule::percent => out.docs.extend(self.percent(node)),
                    _ if is_else => match case_of(&node) {
                        // "else : case ..." is one longer chain.
                        Some(chain) => {
                            out.docs.push(Doc::Space);
                            out.continues = true;
                            self.branches(chain, out);
                        }
                        None => out.docs.push(self.body(node)),
                    },
                    _ => out.docs.push(self.body(node)),
                },
            }
        }
    }

    /// A condition or a percentage.
    fn head(&self, pair: Pair<'_, Rule>, next: Option<&Part<'_>>, out: &mut Branches) {
        let span = pair.as_span();
        let is_weight = matches!(next, Some(Part::Node(node)) if node.as_rule() == Rule::percent);
        if is_weight {
            self.begin_branch(span.start(), out);
            let width = self.token_width(span.start(), span.end());
            if let Some(pad) = out.widest.and_then(|widest| widest.checked_sub(width)).filter(|&pad| pad > 0) {
                out.docs.push(Doc::Pad(pad));
            }
        }
        match is_weight {
            true => out.docs.extend(self.node(pair)),
            false => out.docs.push(Doc::Indent(self.node(pair))),
        }
        if is_weight && span.end() - span.start() > 1 {
            out.docs.push(Doc::Space);
        }
    }

    fn percent(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        self.spaced(pair)
    }

    fn begin_branch(&self, index: usize, out: &mut Branches) {
        if std::mem::take(&mut out.continues) || out.docs.is_empty() {
            return;
        }
        out.docs.push(Doc::Line);
        out.docs.extend(self.blank(index));
        out.broken |= self.author_broke(index) || self.has_comments_before(index);
    }

    /// The width of the widest percentage if all are plain numbers.
    fn widest_weight(&self, pair: &Pair<'_, Rule>) -> Option<usize> {
        let weights = pair.clone().into_inner().flat_map(|inner| match inner.as_rule() {
            Rule::value_weights => inner.into_inner().collect::<Vec<_>>(),
            _ => vec![inner],
        });
        let mut widest = None;
        for weight in weights.filter(|inner| inner.as_rule() == Rule::expression) {
            let span = weight.as_span();
            if span.end() - span.start() > 1 || self.tokens.letter(span.start()) != letter::NUMBER {
                return None;
            }
            widest = widest.max(Some(self.token_width(span.start(), span.end())));
        }
        widest
    }

    fn token_width(&self, from: usize, to: usize) -> usize {
        (self.tokens.places[to - 1].end - self.tokens.places[from].start) as usize
    }
}

/// A chain while it is laid out.
struct Branches {
    docs: Vec<Doc>,
    /// The author gave a branch a line of its own.
    broken: bool,
    widest: Option<usize>,
    /// The next branch stands behind `else :`.
    continues: bool,
}

/// The parts of a chain, `value_weights` opened.
fn flatten<'i>(pair: Pair<'i, Rule>, out: &mut Vec<Part<'i>>) {
    for part in parts(pair) {
        match part {
            Part::Node(node) if node.as_rule() == Rule::value_weights => flatten(node, out),
            part => out.push(part),
        }
    }
}

/// The case chain that a body consists of.
fn case_of<'i>(pair: &Pair<'i, Rule>) -> Option<Pair<'i, Rule>> {
    let only = pair.clone().into_inner().next()?;
    matches!(only.as_rule(), Rule::value_case | Rule::successor_case).then_some(only)
}
