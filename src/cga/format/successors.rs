//! In: sequences, blocks and items. Out: their documents.

use pest::iterators::Pair;

use super::document::{Doc, group};
use super::layout::{Layout, Part, parts};
use crate::cga::parse::Rule;
use crate::cga::parse::tokens::letter;

impl Layout<'_> {
    pub fn successor_node(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        use Rule as R;
        match pair.as_rule() {
            R::sequence => self.sequence(pair),
            R::group | R::braced | R::split_block | R::selector_block | R::perimeter_block | R::boolean_operands => {
                self.block(pair)
            }
            R::selector | R::value_selector | R::split_piece | R::perimeter_section => self.piece(pair),
            R::split_item | R::selector_item | R::scatter_item | R::perimeter_item | R::inline_item => self.item(pair),
            R::boolean_item => self.item(pair),
            R::comp_function => self.comp_function(pair),
            // `successor`, `unsized_piece`, `plain_item`, `dynamic_call`, `nil`
            _ => self.tight(pair),
        }
    }

    /// Items, broken where the author broke them and where a line is full.
    fn sequence(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let mut docs = Vec::new();
        for part in parts(pair) {
            let start = match &part {
                Part::Token(index) => *index,
                Part::Node(node) => node.as_span().start(),
            };
            if !docs.is_empty() {
                match self.author_broke(start) {
                    true => {
                        docs.push(Doc::Hard);
                        docs.extend(self.blank(start));
                    }
                    false => docs.push(Doc::Fill),
                }
            }
            docs.extend(self.part(part));
        }
        docs
    }

    /// An operation with its arguments, mode, blocks or operand.
    fn item(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let mut docs = Vec::new();
        for part in parts(pair) {
            let is_tight = match &part {
                Part::Token(_) => true,
                Part::Node(node) => matches!(node.as_rule(), Rule::arguments | Rule::mode),
            };
            if !is_tight {
                docs.push(Doc::Space);
            }
            docs.extend(self.part(part));
        }
        docs
    }

    /// `{ a | b }*` or `[ a ]`: on one line if it was begun there and fits, else one item per line.
    fn block(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let all = parts(pair);
        self.block_of(all)
    }

    fn block_of(&self, all: Vec<Part<'_>>) -> Vec<Doc> {
        let Some(Part::Token(open)) = all.first() else { unreachable!("a block begins with its bracket") };
        let open = *open;
        let mut docs = Vec::new();
        let mut inner = vec![Doc::Line];
        let mut closed = None;
        for part in all.into_iter().skip(1) {
            match part {
                Part::Token(index) if closed.is_none() => match self.tokens.letter(index) {
                    b'|' => {
                        inner.push(Doc::Space);
                        inner.extend(self.token(index));
                        inner.push(Doc::Line);
                    }
                    b'}' | b']' => {
                        if matches!(inner.last(), Some(Doc::Line)) {
                            inner.pop();
                        }
                        self.comments_before(index, &mut inner);
                        closed = Some(index);
                    }
                    _ => inner.extend(self.token(index)),
                },
                Part::Token(index) => docs.extend(self.token(index)),
                Part::Node(node) => {
                    inner.extend(self.blank(node.as_span().start()));
                    inner.extend(self.node(node));
                }
            }
        }
        let close = closed.expect("a block is closed");
        let broke = self.author_broke(open + 1) && open + 1 < close;
        let mut out = self.token(open);
        out.extend([Doc::Indent(inner), Doc::Line]);
        out.extend(self.closing(close));
        out.extend(docs);
        vec![group(out, broke)]
    }

    /// `size : body`, `selector : body`, `length : depth : body`.
    fn piece(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let mut docs = Vec::new();
        let mut colons = 0;
        let is_section = pair.as_rule() == Rule::perimeter_section;
        for part in parts(pair) {
            match part {
                Part::Token(index) => {
                    let is_operator = matches!(self.tokens.letter(index), b':' | b'=' | letter::CONNECTED);
                    if is_operator {
                        docs.push(Doc::Space);
                        colons += 1;
                    }
                    docs.extend(self.token(index));
                    if is_operator && is_section && colons == 1 {
                        docs.push(Doc::Space);
                    }
                }
                Part::Node(node) if colons == if is_section { 2 } else { 1 } => docs.push(self.body(node)),
                // What begins the line must not be indented against it.
                Part::Node(node) if docs.is_empty() => docs.extend(self.node(node)),
                Part::Node(node) => docs.push(Doc::Indent(self.node(node))),
            }
        }
        docs
    }

    /// `comp(f) { selector : value | ... }` in an expression.
    fn comp_function(&self, pair: Pair<'_, Rule>) -> Vec<Doc> {
        let mut all = parts(pair);
        let block = all.split_off(2);
        let mut docs: Vec<Doc> = all.into_iter().flat_map(|part| self.part(part)).collect();
        docs.push(Doc::Space);
        docs.extend(self.block_of(block));
        docs
    }
}
