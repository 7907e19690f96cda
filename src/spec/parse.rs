//! In: a recipe's text. Out: its [`SpecAst`] and every syntax mistake.
//!
//! The grammar takes every text and marks what it could not read (`stray`), so parsing goes on after a mistake.

use pest::Parser;
use pest::iterators::{Pair, Pairs};

use super::ast::{Block, Expr, InputDecl, Name, SpecAst};
use super::expression::{expression, unquoted};
use super::properties::properties;
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::{SourceFile, SourceId, Span};

#[derive(pest_derive::Parser)]
#[grammar = "../grammar/render.pest"]
struct RenderParser;

/// The deepest nesting of brackets, so that hostile text cannot exhaust the stack.
const DEEPEST: usize = 64;

/// Reads one file. The tree holds everything that could be read, whatever the diagnostics say.
pub fn parse(file: &SourceFile) -> (SpecAst, Diagnostics) {
    let mut reader = Reader { source: file.id, text: &file.text, diagnostics: Diagnostics::default() };
    if let Some(at) = too_deep(&file.text) {
        let message = format!("brackets are nested more than {DEEPEST} deep");
        reader.error("spec::syntax", Span::new(file.id, at, at + 1), message);
        return (SpecAst::default(), reader.diagnostics);
    }
    let recipe = match RenderParser::parse(Rule::recipe, &file.text) {
        Ok(mut pairs) => pairs.next().expect("the grammar's root is one pair"),
        Err(error) => {
            let at = match error.location {
                pest::error::InputLocation::Pos(at) | pest::error::InputLocation::Span((at, _)) => at,
            };
            let end = file.text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
            reader.error("spec::syntax", Span::new(file.id, at, end), error.variant.message().into_owned());
            return (SpecAst::default(), reader.diagnostics);
        }
    };
    let ast = reader.recipe(recipe);
    (ast, reader.diagnostics)
}

/// Reads `text` as comma-separated values, as the command line gives them.
pub fn parse_values(file: &SourceFile) -> (Vec<Expr>, Diagnostics) {
    let mut reader = Reader { source: file.id, text: &file.text, diagnostics: Diagnostics::default() };
    let whole = Span::new(file.id, 0, file.text.len());
    let parsed = if too_deep(&file.text).is_some() { None } else { RenderParser::parse(Rule::body, &file.text).ok() };
    let body = parsed.and_then(|mut pairs| pairs.next());
    let complete = |body: &Pair<Rule>| file.text[body.as_span().end()..].trim().is_empty();
    let Some(body) = body.filter(complete) else {
        reader.error("spec::syntax", whole, "these are not values of the recipe language");
        return (Vec::new(), reader.diagnostics);
    };
    let mut values = Vec::new();
    for token in body.into_inner() {
        match token.as_rule() {
            Rule::expr => values.push(reader.expression(token)),
            Rule::comma => {}
            _ => reader.unreadable(&token),
        }
    }
    (values, reader.diagnostics)
}

/// Where brackets go deeper than [`DEEPEST`]; brackets inside texts and comments count too, which does no harm.
fn too_deep(text: &str) -> Option<usize> {
    let mut depth = 0usize;
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            return Some(at);
        }
    }
    None
}

/// What parsing carries along.
pub(super) struct Reader<'a> {
    pub source: SourceId,
    pub text: &'a str,
    pub diagnostics: Diagnostics,
}

impl Reader<'_> {
    pub fn span(&self, pair: &Pair<Rule>) -> Span {
        let span = pair.as_span();
        // A rule's pair may end in the white space that was skipped in search of more.
        let end = span.start() + span.as_str().trim_end().len();
        Span::new(self.source, span.start(), end)
    }

    pub fn name(&self, pair: &Pair<Rule>) -> Name {
        Name { text: unquoted(pair).to_owned(), span: self.span(pair) }
    }

    pub fn error(&mut self, code: &'static str, span: Span, message: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(code, span, message));
    }

    pub fn expression(&mut self, pair: Pair<Rule>) -> Expr {
        expression(self, pair)
    }

    /// Reports what the grammar could not read.
    pub fn unreadable(&mut self, pair: &Pair<Rule>) {
        let span = self.span(pair);
        let found = pair.as_str().trim_end();
        let (message, help) = match found.chars().next() {
            Some('"') => ("the text is not closed on its line", Some("write `\"` after it")),
            Some('(' | '[' | '{') => ("the bracket is not closed or holds something unexpected", None),
            Some('}') => ("this `}` closes nothing", None),
            Some(c) if !c.is_ascii() => ("names and numbers are written in ASCII", Some("other letters go in `\"…\"`")),
            _ => ("unexpected text", None),
        };
        let mut diagnostic = Diagnostic::error("spec::syntax", span, message);
        diagnostic.help = help.map(str::to_owned);
        self.diagnostics.push(diagnostic);
    }

    fn recipe(&mut self, recipe: Pair<Rule>) -> SpecAst {
        let mut ast = SpecAst::default();
        for pair in recipe.into_inner() {
            match pair.as_rule() {
                Rule::version => ast.version = pair.into_inner().nth(1).map(|number| self.expression(number)),
                Rule::use_file => ast.uses.extend(pair.into_inner().nth(1).map(|text| self.name(&text))),
                Rule::input => {
                    let input = self.input(pair);
                    ast.inputs.push(input);
                }
                Rule::block => {
                    let block = self.block(pair);
                    ast.blocks.push(block);
                }
                Rule::stray_line => {
                    self.stray_line(&pair);
                }
                _ => {}
            }
        }
        ast
    }

    fn stray_line(&mut self, pair: &Pair<Rule>) {
        let text = pair.as_str().trim_end();
        if !text.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return self.unreadable(pair);
        }
        let diagnostic = Diagnostic::error("spec::syntax", self.span(pair), "this is not a block of the recipe").help(
            "a block is written `kind name { … }`, a file is shared by `use \"file.render\"`, an input of the \
                   command line is declared by `input name : file`",
        );
        self.diagnostics.push(diagnostic);
    }

    fn input(&mut self, pair: Pair<Rule>) -> InputDecl {
        let span = self.span(&pair);
        let mut inner = pair.into_inner().skip(1);
        let name = self.name(&inner.next().expect("an input has a name"));
        let kind = self.name(&inner.next().expect("an input has a kind"));
        let default = inner.map(|value| self.expression(value)).collect();
        InputDecl { name, kind, default, span }
    }

    fn block(&mut self, pair: Pair<Rule>) -> Block {
        let mut words = Vec::new();
        let mut tokens: Option<Pairs<Rule>> = None;
        let start = self.span(&pair);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::word => words.push(self.name(&part)),
                Rule::body => tokens = Some(part.into_inner()),
                Rule::unclosed => {
                    let head = words.first().map_or(start, |kind: &Name| kind.span);
                    self.error("spec::syntax", head, "the block is not closed by `}`");
                }
                _ => {}
            }
        }
        let mut words = words.into_iter();
        let kind = words.next().expect("a block has a kind");
        let (name, parent) = (words.next(), words.next());
        let span = [&name, &parent].into_iter().flatten().fold(kind.span, |span, word| span.to(word.span));
        let properties = properties(self, &kind, tokens.expect("a block has a body"));
        Block { kind, name, parent, properties, span }
    }
}

impl Reader<'_> {
    /// The text under a span.
    pub fn slice(&self, span: Span) -> &str {
        &self.text[span.start as usize..span.end as usize]
    }
}
