//! In: pest pairs of whole declarations. Out: the [`Ast`]; the helpers every part of the builder uses.

use std::rc::Rc;
use std::sync::Arc;

use pest::iterators::Pair;

use super::Rule;
use super::tokens::Tokens;
use crate::cga::ast::{Annotation, Ast, Text};
use crate::cga::codes;
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::{SourceFile, Span};

/// Deepest tree of expressions and successors, where an expression of n operands counts as n levels. Real rule files
/// nest 8 brackets; the limit keeps every later recursion over the tree within a thread's stack.
pub const MAX_DEPTH: usize = 500;

pub struct Builder {
    file: SourceFile,
    tokens: Rc<Tokens>,
    /// The token at which the pairs count 0.
    base: usize,
    pub diagnostics: Diagnostics,
    pub ast: Ast,
    /// Annotations waiting for their declaration.
    pub pending: Vec<Annotation>,
    depth: usize,
    too_deep: bool,
}

impl Builder {
    pub fn new(file: &SourceFile) -> Builder {
        Builder {
            file: file.clone(),
            tokens: Rc::default(),
            base: 0,
            diagnostics: Diagnostics::default(),
            ast: Ast { source: file.id, version: None, declarations: Vec::new(), trailing: Vec::new() },
            pending: Vec::new(),
            depth: 0,
            too_deep: false,
        }
    }

    pub fn finish(mut self) -> (Ast, Diagnostics) {
        self.ast.trailing = self.pending;
        (self.ast, self.diagnostics)
    }

    /// The pairs that follow were read from token `base` on.
    pub fn reads(&mut self, tokens: &Rc<Tokens>, base: usize) {
        self.tokens = Rc::clone(tokens);
        self.base = base;
    }

    pub fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let tokens = pair.as_span();
        self.tokens.span(&self.file, self.base + tokens.start(), self.base + tokens.end())
    }

    /// What is written where the pair lies.
    pub fn written(&self, pair: &Pair<'_, Rule>) -> &str {
        let span = self.span(pair);
        &self.file.text[span.start as usize..span.end as usize]
    }

    /// The name a pair consists of.
    pub fn text(&self, pair: &Pair<'_, Rule>) -> Text {
        Text { text: Arc::from(self.written(pair)), span: self.span(pair) }
    }

    /// Runs `make` one level deeper; `None` (after one error) where the text is nested too deeply.
    pub fn nested<T>(&mut self, span: Span, make: impl FnOnce(&mut Self) -> T) -> Option<T> {
        self.deeper(1, span, make)
    }

    /// As [`Builder::nested`], several levels deeper.
    pub fn deeper<T>(&mut self, levels: usize, span: Span, make: impl FnOnce(&mut Self) -> T) -> Option<T> {
        if self.depth + levels > MAX_DEPTH {
            self.refuse_depth(span);
            return None;
        }
        self.depth += levels;
        let made = make(self);
        self.depth -= levels;
        Some(made)
    }

    /// Says once per file that a text is too deep.
    fn refuse_depth(&mut self, span: Span) {
        if !std::mem::replace(&mut self.too_deep, true) {
            let message = format!("nested more than {MAX_DEPTH} levels deep");
            self.diagnostics.push(
                Diagnostic::error(codes::TOO_DEEP, span, message).help("move the inner part into a rule or function"),
            );
        }
    }

    /// The content of a string literal with its escapes resolved (reference 1.5).
    pub fn string(&mut self, pair: &Pair<'_, Rule>) -> Text {
        let span = self.span(pair);
        let file = self.file.clone();
        let raw = &file.text[span.start as usize + 1..span.end as usize - 1];
        if !raw.contains('\\') {
            return Text { text: Arc::from(raw), span };
        }
        let start = span.start as usize + 1;
        let mut out = String::with_capacity(raw.len());
        let mut chars = raw.char_indices();
        while let Some((at, c)) = chars.next() {
            if c != '\\' {
                out.push(c);
                continue;
            }
            let Some((_, escape)) = chars.next() else { break };
            match escape {
                'n' => out.push('\n'),
                't' => out.push('\t'),
                'r' => out.push('\r'),
                '"' | '\\' => out.push(escape),
                'u' if unicode_escape(&raw[at + 2..]).is_some() => {
                    out.extend(unicode_escape(&raw[at + 2..]));
                    chars.nth(3);
                }
                other => {
                    let at = Span::new(span.source, start + at, start + at + 1 + other.len_utf8());
                    let message = format!("`\\{other}` is not an escape; the backslash is dropped");
                    self.diagnostics.push(Diagnostic::warning(codes::UNKNOWN_ESCAPE, at, message));
                    out.push(other);
                }
            }
        }
        Text { text: Arc::from(out), span }
    }
}

/// The character of `\uXXXX`.
fn unicode_escape(text: &str) -> Option<char> {
    let digits = text.get(..4).filter(|d| d.bytes().all(|b| b.is_ascii_hexdigit()))?;
    char::from_u32(u32::from_str_radix(digits, 16).ok()?)
}
