//! In: `successor` and its items. Out: sequences, chains and blocks of the tree.

use pest::iterators::{Pair, Pairs};

use super::Rule;
use super::build::Builder;
use super::declarations::find;
use super::expressions::{read_prefix, selector_operator};
use crate::cga::ast::{
    Argument, Block, Expr, Item, ItemKind, Part, SectionBlock, SectionPart, Selector, Successor, Text,
};
use crate::cga::program::{BooleanOperator, Prefix};

impl Builder {
    /// A case chain, a percentage chain or a sequence. `else : case` is one longer chain.
    pub fn successor(&mut self, pair: Pair<'_, Rule>) -> Successor {
        let span = self.span(&pair);
        self.nested(span, |b| b.successor_here(pair)).unwrap_or(Successor::Sequence(Vec::new()))
    }

    fn successor_here(&mut self, pair: Pair<'_, Rule>) -> Successor {
        let mut branches = Vec::new();
        let mut next = pair;
        loop {
            let first = next.into_inner().next().expect("a successor has one part");
            let otherwise = match first.as_rule() {
                Rule::successor_case => {
                    let (more, last) = self.branches(first);
                    branches.extend(more);
                    next = last;
                    continue;
                }
                Rule::successor_weights => {
                    let (branches, last) = self.branches(first);
                    Successor::Stochastic { branches, otherwise: Box::new(self.successor(last)) }
                }
                _ => Successor::Sequence(first.into_inner().map(|item| self.item(item)).collect()),
            };
            if branches.is_empty() {
                return otherwise;
            }
            return Successor::Case { branches, otherwise: Box::new(otherwise) };
        }
    }

    /// The branches of a chain and the unread successor of its else.
    fn branches<'i>(&mut self, chain: Pair<'i, Rule>) -> (Vec<(Expr, Successor)>, Pair<'i, Rule>) {
        let mut condition = None;
        let (mut branches, mut last) = (Vec::new(), None);
        for part in chain.into_inner() {
            match (part.as_rule(), condition.take()) {
                (Rule::expression, _) => condition = Some(self.expression(part)),
                (Rule::successor, Some(condition)) => branches.push((condition, self.successor(part))),
                (Rule::successor, None) => last = Some(part),
                (_, pending) => condition = pending,
            }
        }
        (branches, last.expect("a chain ends with its else"))
    }

    fn item(&mut self, pair: Pair<'_, Rule>) -> Item {
        let span = self.span(&pair);
        let kind = match pair.as_rule() {
            Rule::group => ItemKind::Group(self.successor(find(pair, Rule::successor).expect("a group has a body"))),
            Rule::nil => ItemKind::Nil,
            Rule::plain_item => self.plain_item(pair),
            Rule::split_item => self.split_item(pair),
            Rule::selector_item => self.selector_item(pair),
            Rule::scatter_item => self.scatter_item(pair),
            Rule::perimeter_item => self.perimeter_item(pair),
            Rule::inline_item => self.inline_item(pair),
            Rule::boolean_item => self.boolean_item(pair),
            Rule::dynamic_call => self.dynamic_call(pair),
            other => unreachable!("{other:?} is no item of the grammar"),
        };
        Item { kind, span }
    }

    fn plain_item(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let mut parts = pair.into_inner();
        let name = self.text(&parts.next().expect("an item has a name"));
        let (mut args, mut terminal) = (None, false);
        for part in parts {
            match part.as_rule() {
                Rule::arguments => args = Some(self.arguments(part)),
                _ => terminal = true,
            }
        }
        ItemKind::Plain { name, args, terminal }
    }

    fn split_item(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let mut parts = pair.into_inner();
        let name = self.text(&parts.next().expect("a split has a name"));
        let args = self.arguments(parts.next().expect("a split has arguments"));
        ItemKind::Split { name, args, block: self.split_block(parts.next().expect("a split has a block")) }
    }

    fn split_block(&mut self, pair: Pair<'_, Rule>) -> Block {
        let span = self.span(&pair);
        let empty = Block { parts: Vec::new(), repeat: false };
        self.nested(span, |b| b.split_block_here(pair)).unwrap_or(empty)
    }

    fn split_block_here(&mut self, pair: Pair<'_, Rule>) -> Block {
        let mut out = Block { parts: Vec::new(), repeat: false };
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::split_block => out.parts.push(Part::Group(self.split_block(part))),
                Rule::split_piece => {
                    let (prefix, mut values, body) = self.piece(part);
                    let size = values.pop().expect("a piece has a size");
                    out.parts.push(Part::Piece { prefix, size, body });
                }
                Rule::unsized_piece => {
                    let body = part.into_inner().next().expect("a piece has a body");
                    out.parts.push(Part::Unsized(self.successor(body), span));
                }
                Rule::star => out.repeat = true,
                _ => {}
            }
        }
        out
    }

    /// Prefix, sizes and body of a split piece or perimeter section.
    fn piece(&mut self, pair: Pair<'_, Rule>) -> (Prefix, Vec<Expr>, Successor) {
        let (mut prefix, mut values) = (Prefix::Absolute, Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::prefix => prefix = read_prefix(&part),
                Rule::value => values.push(self.value(part)),
                Rule::successor => return (prefix, values, self.successor(part)),
                _ => {}
            }
        }
        unreachable!("a piece has a body")
    }

    fn selector_item(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let mut parts = pair.into_inner();
        let name = self.text(&parts.next().expect("an operation has a name"));
        let args = self.arguments(parts.next().expect("an operation has arguments"));
        ItemKind::Selectors { name, args, selectors: self.selectors(parts.next().expect("an operation has a block")) }
    }

    fn selectors(&mut self, pair: Pair<'_, Rule>) -> Vec<Selector<Successor>> {
        let mut out = Vec::new();
        for selector in pair.into_inner().filter(|p| p.as_rule() == Rule::selector) {
            let mut parts = selector.into_inner();
            let test = self.expression(parts.next().expect("a selector has a test"));
            let operator = selector_operator(&parts.next().expect("a selector has an operator"));
            let body = self.successor(parts.next().expect("a selector has a body"));
            out.push(Selector { test, operator, body });
        }
        out
    }

    fn scatter_item(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let mut parts = pair.into_inner();
        let name = self.text(&parts.next().expect("scatter has a name"));
        let args = self.arguments(parts.next().expect("scatter has arguments"));
        let body = Box::new(self.braced(parts.next().expect("scatter has a block")));
        ItemKind::Scatter { name, args, body }
    }

    fn braced(&mut self, pair: Pair<'_, Rule>) -> Successor {
        self.successor(find(pair, Rule::successor).expect("braces hold a successor"))
    }

    fn perimeter_item(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let mut parts = pair.into_inner();
        let name = self.text(&parts.next().expect("an operation has a name"));
        let args: Vec<Argument> = self.arguments(parts.next().expect("an operation has arguments"));
        let block = self.section_block(parts.next().expect("an operation has a block"));
        let remainder = parts.next().map(|block| self.selectors(block)).unwrap_or_default();
        ItemKind::Perimeter { name, args, block, remainder }
    }

    fn section_block(&mut self, pair: Pair<'_, Rule>) -> SectionBlock {
        let span = self.span(&pair);
        let empty = SectionBlock { parts: Vec::new(), repeat: false };
        self.nested(span, |b| b.section_block_here(pair)).unwrap_or(empty)
    }

    fn section_block_here(&mut self, pair: Pair<'_, Rule>) -> SectionBlock {
        let mut out = SectionBlock { parts: Vec::new(), repeat: false };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::perimeter_block => out.parts.push(SectionPart::Group(self.section_block(part))),
                Rule::perimeter_section => {
                    let (prefix, mut values, body) = self.piece(part);
                    let depth = values.pop().expect("a section has a depth");
                    let length = values.pop().expect("a section has a length");
                    out.parts.push(SectionPart::Section { prefix, length, depth, body });
                }
                Rule::star => out.repeat = true,
                _ => {}
            }
        }
        out
    }

    fn inline_item(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let mut parts = pair.into_inner();
        let name = self.text(&parts.next().expect("inline has a name"));
        let (mode, body) = self.mode(parts);
        let body = match body.as_rule() {
            Rule::braced => self.braced(body),
            _ => self.single(body),
        };
        ItemKind::Inline { name, mode, body: Box::new(body) }
    }

    fn boolean_item(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let mut parts = pair.into_inner();
        let name = self.text(&parts.next().expect("an operation has a name"));
        let operator = match &*name.text {
            "union" => BooleanOperator::Union,
            "subtract" => BooleanOperator::Subtract,
            _ => BooleanOperator::Intersect,
        };
        let (mode, body) = self.mode(parts);
        let (left, right) = match body.as_rule() {
            Rule::boolean_operands => {
                let mut sides = body.into_inner().filter(|p| p.as_rule() == Rule::successor);
                let left = self.successor(sides.next().expect("two operands"));
                let right = self.successor(sides.next().expect("two operands"));
                (left, Some(Box::new(right)))
            }
            _ => (self.single(body), None),
        };
        ItemKind::Boolean { operator, name, mode, left: Box::new(left), right }
    }

    /// The word in parentheses, if one stands there, and what follows.
    fn mode<'i>(&mut self, mut parts: Pairs<'i, Rule>) -> (Option<Text>, Pair<'i, Rule>) {
        let mut next = parts.next().expect("an operation has an operand");
        let mut mode = None;
        if next.as_rule() == Rule::mode {
            mode = find(next, Rule::name).map(|word| self.text(&word));
            next = parts.next().expect("an operation has an operand");
        }
        (mode, next)
    }

    /// A sequence of one item, one level deeper.
    fn single(&mut self, pair: Pair<'_, Rule>) -> Successor {
        let span = self.span(&pair);
        let item = self.nested(span, |b| b.item(pair));
        Successor::Sequence(item.into_iter().collect())
    }

    fn dynamic_call(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let mut parts = pair.into_inner();
        let prefix = self.text(&parts.next().expect("a dynamic call has a prefix"));
        let overrides = self.overrides(parts.next().expect("a dynamic call has overrides"));
        let name = self.text(&parts.next().expect("a dynamic call has a rule"));
        let name = Text { text: name.text[1..].into(), span: name.span };
        let args = parts.next().map(|args| self.arguments(args)).unwrap_or_default();
        ItemKind::Dynamic { prefix, overrides, name, args }
    }
}
