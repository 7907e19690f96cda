//! In: the pairs of a whole file. Out: its document: declarations, annotations, headers.

use pest::iterators::{Pair, Pairs};

use super::document::{Doc, group, must_break};
use crate::cga::parse::Rule;
use crate::cga::parse::tokens::Tokens;

/// The text that is laid out.
#[derive(Clone, Copy)]
pub struct Layout<'t> {
    pub text: &'t str,
    pub tokens: &'t Tokens,
}

/// A child of a pair: a token, or a pair with a layout of its own.
pub enum Part<'i> {
    Token(usize),
    Node(Pair<'i, Rule>),
}

/// The parts of a pair in order, no token left out.
pub fn parts(pair: Pair<'_, Rule>) -> Vec<Part<'_>> {
    let span = pair.as_span();
    let mut next = span.start();
    let mut parts = Vec::new();
    for child in pair.into_inner() {
        let inner = child.as_span();
        parts.extend((next..inner.start()).map(Part::Token));
        match has_layout(child.as_rule()) {
            true => parts.push(Part::Node(child)),
            false => parts.extend((inner.start()..inner.end()).map(Part::Token)),
        }
        next = inner.end();
    }
    parts.extend((next..span.end()).map(Part::Token));
    parts
}

fn has_layout(kind: Rule) -> bool {
    use Rule as R;
    matches!(
        kind,
        R::annotation_args
            | R::annotation_arg
            | R::annotation_value
            | R::import_styles
            | R::overrides
            | R::override_item
    ) || matches!(kind, R::parameters | R::locals | R::local | R::value | R::value_case | R::value_weights | R::percent)
        || matches!(
            kind,
            R::expression | R::unary_operator | R::binary_operator | R::parenthesised | R::call | R::arguments
        )
        || matches!(kind, R::argument | R::array | R::array_row | R::element_value | R::index | R::comp_function)
        || matches!(kind, R::value_selector | R::successor | R::successor_case | R::successor_weights | R::sequence)
        || matches!(
            kind,
            R::group | R::split_item | R::split_block | R::split_piece | R::unsized_piece | R::selector_item
        )
        || matches!(kind, R::selector_block | R::selector | R::scatter_item | R::braced | R::perimeter_item)
        || matches!(kind, R::perimeter_block | R::perimeter_section | R::inline_item | R::boolean_item | R::mode)
        || matches!(kind, R::boolean_operands | R::dynamic_call | R::plain_item | R::nil | R::style_name)
}

impl Layout<'_> {
    pub fn file(&self, pairs: Pairs<'_, Rule>) -> Vec<Doc> {
        let mut docs = Vec::new();
        let mut before: Option<Unit> = None;
        for declaration in pairs.flat_map(|root| root.into_inner()).filter(|p| p.as_rule() == Rule::declaration) {
            let unit = declaration.into_inner().next().expect("a declaration has one unit");
            let first = unit.as_span().start();
            let is_annotation = unit.as_rule() == Rule::annotation;
            let is_rule = unit.as_rule() == Rule::rule;
            let written = self.unit(unit);
            let now = Unit { is_annotation, is_paragraph: is_rule && must_break(&written) };
            match before {
                Some(before) if before.is_annotation && !self.author_broke(first) => docs.push(Doc::Space),
                Some(before) => {
                    docs.push(Doc::Hard);
                    docs.extend(self.blank(first));
                    let paragraph = before.is_paragraph || (now.is_paragraph && !before.is_annotation);
                    if paragraph && !self.is_apart(first) {
                        docs.push(Doc::Blank);
                    }
                }
                None => {}
            }
            docs.extend(written);
            before = Some(now);
        }
        self.comments_before(self.tokens.len(), &mut docs);
        docs
    }

    fn unit(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        match pair.as_rule() {
            Rule::annotation => self.tight(pair),
            Rule::attr | Rule::constant | Rule::function | Rule::rule => self.definition(pair),
            _ => self.spaced(pair),
        }
    }

    /// Parts without spaces between them.
    pub fn tight(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        parts(pair).into_iter().flat_map(|part| self.part(part)).collect()
    }

    /// Parts with a space between them.
    pub fn spaced(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let mut docs = Vec::new();
        for part in parts(pair) {
            if !docs.is_empty() {
                docs.push(Doc::Space);
            }
            docs.extend(self.part(part));
        }
        docs
    }

    /// `attr name = value`, `Name(a) with(b := 1) --> body`.
    fn definition(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let mut docs = Vec::new();
        for part in parts(pair) {
            match part {
                Part::Node(node) if matches!(node.as_rule(), Rule::value | Rule::successor) => {
                    docs.push(self.body(node));
                }
                Part::Node(node) if node.as_rule() == Rule::parameters => docs.extend(self.node(node)),
                part => {
                    if !docs.is_empty() {
                        docs.push(Doc::Space);
                    }
                    docs.extend(self.part(part));
                }
            }
        }
        docs
    }

    /// What stands behind `=`, `:` or `-->`: on the same line if it fits and was begun there, else indented below.
    pub fn body(&self, pair: Pair<'_, Rule>) -> Doc {
        let span = pair.as_span();
        if span.start() == span.end() {
            return group(Vec::new(), false);
        }
        let mut docs = vec![Doc::Line];
        docs.extend(self.node(pair));
        let broke = self.author_broke(span.start()) || self.has_comments_before(span.start());
        group(vec![Doc::Indent(docs)], broke)
    }

    pub fn part(&self, part: Part<'_>) -> Vec<Doc> {
        match part {
            Part::Token(index) => self.token(index),
            Part::Node(node) => self.node(node),
        }
    }

    /// A pair by its rule.
    pub fn node(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        use Rule as R;
        match pair.as_rule() {
            R::annotation_args | R::array_row => self.list(pair),
            R::annotation_arg | R::style_name => self.tight(pair),
            R::annotation_value => self.free_text(pair),
            R::parameters | R::import_styles | R::mode | R::overrides | R::arguments | R::parenthesised => {
                self.bracketed(pair)
            }
            R::array | R::index => self.bracketed(pair),
            R::override_item => self.definition(pair),
            R::locals => self.locals(pair),
            R::local => self.spaced(pair),
            R::value | R::expression | R::unary_operator | R::binary_operator | R::call => self.expression_node(pair),
            R::argument | R::element_value => self.expression_node(pair),
            R::value_case | R::value_weights | R::successor_case | R::successor_weights | R::percent => {
                self.chain_node(pair)
            }
            _ => self.successor_node(pair),
        }
    }

    /// Anything between commas, as written.
    fn free_text(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let (first, end) = (pair.as_span().start(), pair.as_span().end());
        let mut docs = Vec::new();
        self.comments_before(first, &mut docs);
        docs.push(Doc::Source(self.tokens.places[first].start, self.tokens.places[end - 1].end));
        docs.extend(self.trailing(end - 1));
        docs
    }

    /// Elements behind each other with commas or semicolons between them, filled into lines.
    fn list(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let mut docs = Vec::new();
        for part in parts(pair) {
            match part {
                Part::Token(index) if matches!(self.tokens.letter(index), b',' | b';') => {
                    docs.extend(self.token(index));
                    docs.push(Doc::Fill);
                }
                part => docs.extend(self.part(part)),
            }
        }
        while matches!(docs.last(), Some(Doc::Fill)) {
            docs.pop();
        }
        vec![Doc::Indent(docs)]
    }

    /// `(a, b)` and the like: on one line or filled into lines; what holds a chain or overrides stands between the
    /// brackets' lines, one element per line.
    fn bracketed(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let kind = pair.as_rule();
        let span = pair.as_span();
        let (open, close) = (span.start(), span.end() - 1);
        let inner: Vec<Part<'_>> = parts(pair).into_iter().filter(|part| !is_token(part, open, close)).collect();
        let in_lines = inner.iter().any(|part| is_chain(part)) || (kind == Rule::overrides && !inner.is_empty());
        let separator = if in_lines { Doc::Line } else { Doc::Fill };
        let mut docs = Vec::new();
        for part in inner {
            match part {
                Part::Token(index) if matches!(self.tokens.letter(index), b',' | b';') => {
                    docs.extend(self.token(index));
                    docs.push(separator.clone());
                }
                part => docs.extend(self.part(part)),
            }
        }
        self.comments_before(close, &mut docs);
        let mut out = self.token(open);
        let broke = kind == Rule::overrides && self.author_broke(open + 1) && open + 1 < close;
        if in_lines || must_break(&docs) {
            docs.insert(0, Doc::Soft);
            out.extend([Doc::Indent(docs), Doc::Soft]);
        } else {
            out.push(Doc::Indent(docs));
        }
        out.extend(self.closing(close));
        vec![group(out, broke)]
    }

    fn locals(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let span = pair.as_span();
        let (open, close) = (span.start() + 1, span.end() - 1);
        let mut docs = Vec::new();
        for part in parts(pair) {
            match part {
                Part::Token(index) if index <= open || index == close => {}
                Part::Node(node) => {
                    if !docs.is_empty() {
                        docs.push(Doc::Line);
                    }
                    docs.extend(self.node(node));
                }
                part => docs.extend(self.part(part)),
            }
        }
        self.comments_before(close, &mut docs);
        docs.insert(0, Doc::Soft);
        let mut out = self.token(open - 1);
        out.extend(self.token(open));
        out.extend([Doc::Indent(docs), Doc::Soft]);
        out.extend(self.closing(close));
        vec![group(out, false)]
    }
}

/// What was written last, as far as empty lines depend on it.
struct Unit {
    is_annotation: bool,
    /// A rule of several lines.
    is_paragraph: bool,
}

fn is_token(part: &Part<'_>, a: usize, b: usize) -> bool {
    matches!(part, Part::Token(index) if *index == a || *index == b)
}

/// Whether an argument or value is a chain.
fn is_chain(part: &Part<'_>) -> bool {
    let Part::Node(node) = part else { return false };
    match node.as_rule() {
        Rule::value_case | Rule::value_weights => true,
        Rule::argument | Rule::value | Rule::array_row | Rule::element_value => {
            node.clone().into_inner().any(|inner| is_chain(&Part::Node(inner)))
        }
        _ => false,
    }
}
