//! In: a decoded rule file. Out: its [`Ast`] and the syntax errors; after an error reading goes on at the next
//! declaration, so that one file shows all its mistakes at once.

mod build;
mod classify;
mod declarations;
mod explain;
mod expressions;
mod hints;
mod lexer;
mod successors;
#[cfg(test)]
mod tests;
pub mod tokens;
mod wording;

use std::rc::Rc;

use pest::Parser;

use super::ast::Ast;
use crate::diagnostics::Diagnostics;
use crate::source::SourceFile;
use build::Builder;
use explain::{Reading, explain};
use tokens::{Tokens, letter};

/// Syntax errors shown per file; later ones are mostly echoes of earlier ones.
const MAX_ERRORS: usize = 50;

/// The pest parser of grammar/cga.pest, which reads the letters of tokens.
mod grammar {
    #![allow(missing_docs)]

    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/cga.pest"]
    pub struct Grammar;
}

pub(super) use grammar::{Grammar, Rule};
pub use lexer::lex;

/// Parses a whole file. The tree holds every declaration that could be read.
///
/// Deeply nested text is refused, not overflowed: brackets are counted, pest watches the stack, and the tree has a depth
/// limit of its own. The time is linear in the length of the text.
pub fn parse(file: &SourceFile) -> (Ast, Diagnostics) {
    let text = &*file.text;
    let mut builder = Builder::new(file);
    let mut tokens = Rc::new(lex(text, 0));
    let mut at = 0;
    for _ in 0..MAX_ERRORS {
        at += read_declarations(&mut builder, &tokens, at);
        if at == tokens.len() {
            break;
        }
        // Read the declaration that did not fit once more, alone, for its error.
        let Err(error) = Grammar::parse(Rule::one_declaration, &tokens.letters[at..]) else { break };
        let problem = explain(&Reading { file, tokens: &tokens, first: at }, &error);
        builder.diagnostics.push(problem.diagnostic);
        // They stood in front of what could not be read.
        builder.pending.clear();
        match problem.unclosed_until {
            Some(offset) => {
                tokens = Rc::new(lex(text, offset));
                at = next_declaration(&tokens, text, 0);
            }
            None => at = next_declaration(&tokens, text, line_start(&tokens, text, problem.token).max(at + 1)),
        }
    }
    builder.finish()
}

/// Builds the declarations from token `at` on; how many tokens they have.
fn read_declarations(builder: &mut Builder, tokens: &Rc<Tokens>, at: usize) -> usize {
    let Ok(pairs) = Grammar::parse(Rule::declarations, &tokens.letters[at..]) else { return 0 };
    builder.reads(tokens, at);
    let mut end = 0;
    for pair in pairs.flat_map(|root| root.into_inner()).filter(|p| p.as_rule() == Rule::declaration) {
        end = pair.as_span().end();
        builder.declaration(pair);
    }
    end
}

/// The first token of the line that holds `token`: in "attr a = <newline> b = 3" the error is found at the second `=`.
fn line_start(tokens: &Tokens, text: &str, token: usize) -> usize {
    let mut at = token.min(tokens.len());
    while at > 0 && !tokens.begins_line(text, at) {
        at -= 1;
    }
    at
}

/// The first token from `from` on that begins a declaration. A function counts only at the start of a line, because
/// selectors and overrides look the same.
fn next_declaration(tokens: &Tokens, text: &str, from: usize) -> usize {
    let begins = |at: &usize| match tokens.letter(*at) {
        letter::ATTR | letter::CONST | letter::IMPORT | letter::STYLE | letter::MODIFIER | b'@' => true,
        letter::RULE | letter::FUNCTION => tokens.begins_line(text, *at),
        _ => false,
    };
    (from..tokens.len()).find(begins).unwrap_or(tokens.len())
}
