//! What may be written at a place of a recipe, however broken the text is. In: a text and a byte offset. Out: the [`Spot`].

use crate::spec::schema::{BLOCKS, BlockShape, Key};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    Word,
    /// `$name`.
    Input,
    /// With its quotes; to the end of the line if it is not closed.
    Text,
    Number,
    Comment,
    Mark,
}

/// A piece of a recipe's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    pub kind: TokenKind,
    pub start: usize,
    pub end: usize,
}

/// The pieces of a recipe, white space left out. Never fails.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let word = |rest: &str| rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
        let line = rest.find(['\n', '\r']).unwrap_or(rest.len());
        let (kind, length) = if c.is_whitespace() || c == '\u{feff}' {
            at += c.len_utf8();
            continue;
        } else if c == '#' || rest.starts_with("//") {
            (TokenKind::Comment, line)
        } else if let Some(inner) = rest.strip_prefix("/*") {
            (TokenKind::Comment, inner.find("*/").map_or(rest.len(), |end| end + 4))
        } else if c == '"' {
            (TokenKind::Text, rest[1..line].find('"').map_or(line, |end| end + 2))
        } else if c == '$' {
            (TokenKind::Input, 1 + word(&rest[1..]))
        } else if c.is_ascii_alphabetic() || c == '_' {
            (TokenKind::Word, word(rest))
        } else if c.is_ascii_digit() {
            let ends = |c: char| !(c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '%' | '°'));
            (TokenKind::Number, rest.find(ends).unwrap_or(rest.len()))
        } else {
            (TokenKind::Mark, c.len_utf8())
        };
        out.push(Token { kind, start: at, end: at + length });
        at += length;
    }
    out
}

/// What may stand at a place.
#[derive(Clone, Debug)]
pub enum Spot {
    Nothing,
    /// A block, `input` or `use`.
    Top,
    /// The name of the block that the new one takes its properties from.
    Parent(String),
    /// A property of this block, or a clause of the property before.
    Key {
        block: &'static BlockShape,
        before: Option<&'static Key>,
    },
    Value {
        block: &'static BlockShape,
        key: &'static Key,
        clause: Option<String>,
    },
    /// A name in the braces of a property with this rule file.
    Attribute(Option<String>),
    /// A value there.
    AttributeValue,
    /// Inside `[ ]` of a filter.
    Filter,
    /// Inside a text; what it is, the spot around it says.
    Text(Box<Spot>),
}

/// The spot at `offset` and where the word begins that ends there.
pub fn spot(text: &str, offset: u32) -> (Spot, u32) {
    let at = offset as usize;
    let all = tokens(text);
    let inside = all.iter().find(|t| t.start < at && at <= t.end && (at < t.end || t.kind != TokenKind::Mark));
    let closed = |t: &Token| t.end - t.start > 1 && text[t.start..t.end].ends_with('"');
    match inside {
        Some(t) if t.kind == TokenKind::Comment && (at < t.end || !text[t.start..t.end].ends_with("*/")) => {
            (Spot::Nothing, offset)
        }
        Some(t) if t.kind == TokenKind::Text && (at < t.end || !closed(t)) => {
            let around = outside(text, &all, t.start);
            (Spot::Text(Box::new(around)), t.start as u32 + 1)
        }
        Some(t) if t.kind == TokenKind::Number => (Spot::Nothing, offset),
        Some(t) if matches!(t.kind, TokenKind::Word | TokenKind::Input) => {
            (outside(text, &all, t.start), t.start as u32)
        }
        _ => (outside(text, &all, at), offset),
    }
}

/// What the tokens in front of `at` say.
fn outside(text: &str, all: &[Token], at: usize) -> Spot {
    let before: Vec<&Token> = all.iter().filter(|t| t.end <= at && t.kind != TokenKind::Comment).collect();
    let written = |t: &Token| &text[t.start..t.end];
    let Some(open) = block_start(text, &before) else { return top(text, &before, at) };
    let mut head = before[..open].iter().rev().map_while(|t| head_word(text, t));
    let Some(block) = head.find_map(BlockShape::find) else { return Spot::Nothing };
    // Properties of the block, up to the place.
    let (mut key, mut clause): (Option<&'static Key>, Option<String>) = (None, None);
    let mut file: Option<String> = None;
    let (mut braces, mut brackets) = (0i32, 0i32);
    let mut end = before[open].end;
    let mut comma = false;
    for token in &before[open + 1..] {
        let newline = text[end..token.start].contains('\n');
        end = token.end;
        let word = written(token);
        match (token.kind, word) {
            (TokenKind::Mark, "{") => braces += 1,
            (TokenKind::Mark, "}") => braces -= 1,
            (TokenKind::Mark, "[" | "(") => brackets += 1,
            (TokenKind::Mark, "]" | ")") => brackets -= 1,
            (TokenKind::Mark, ";") if braces == 0 => (key, clause) = (None, None),
            (TokenKind::Text, text) if key.is_some_and(|k| k.key == "rules") || clause.as_deref() == Some("rules") => {
                file = Some(text.trim_matches('"').to_owned());
            }
            (TokenKind::Word, word) if braces == 0 && brackets == 0 && !comma => {
                let is_clause = key.is_some_and(|k| k.clauses.contains(&word));
                match block.key(word) {
                    Some(found) if key.is_none() || newline || !is_clause => {
                        (key, clause, file) = (Some(found), None, None);
                    }
                    _ if is_clause => clause = Some(word.to_owned()),
                    _ => {}
                }
            }
            _ => {}
        }
        comma = word == ",";
    }
    if brackets > 0 {
        return if braces == 0 && key.is_some() { Spot::Filter } else { Spot::Nothing };
    }
    if braces > 0 {
        let is_value = before.last().is_some_and(|t| written(t) == "=");
        return if is_value { Spot::AttributeValue } else { Spot::Attribute(file) };
    }
    let line = &text[before.last().map_or(0, |t| t.end)..at];
    let begins = line.contains('\n') && !comma || before.last().is_some_and(|t| matches!(written(t), "{" | ";"));
    match key {
        Some(key) if !begins => Spot::Value { block, key, clause },
        before => Spot::Key { block, before },
    }
}

/// Index of the `{` of the block that is open at the end.
fn block_start(text: &str, before: &[&Token]) -> Option<usize> {
    let mut depth = 0;
    let mut found = None;
    for (index, token) in before.iter().enumerate().filter(|(_, t)| t.kind == TokenKind::Mark) {
        match &text[token.start..token.end] {
            // A block that was left open ends where the next one begins.
            "{" if depth == 0 || is_head(text, &before[..index]) => (depth, found) = (1, Some(index)),
            "{" => depth += 1,
            "}" => {
                depth = (depth - 1).max(0);
                found = found.filter(|_| depth > 0);
            }
            _ => {}
        }
    }
    found
}

/// Whether tokens end in `kind [name [: parent]]` at the start of a line.
fn is_head(text: &str, before: &[&Token]) -> bool {
    let head: Vec<&&Token> = before.iter().rev().take_while(|t| head_word(text, t).is_some()).collect();
    let Some(first) = head.iter().rev().find(|t| BLOCKS.iter().any(|b| b.kind == &text[t.start..t.end])) else {
        return false;
    };
    text[..first.start].rsplit('\n').next().is_some_and(|line| line.trim().is_empty())
        && head.len() <= 4
        && BLOCKS.iter().any(|b| b.kind == &text[first.start..first.end])
        && text[first.start..].lines().next().is_some_and(|line| line.contains('{'))
}

/// Words and the colon of a block's head.
fn head_word<'t>(text: &'t str, token: &Token) -> Option<&'t str> {
    let written = &text[token.start..token.end];
    (token.kind == TokenKind::Word || written == ":").then_some(written)
}

fn top(text: &str, before: &[&Token], at: usize) -> Spot {
    let line: Vec<&&Token> = before
        .iter()
        .rev()
        .take_while(|t| !text[t.start..at].contains('\n') && !matches!(&text[t.start..t.end], "}"))
        .collect();
    let words: Vec<&str> = line.iter().rev().map(|t| &text[t.start..t.end]).collect();
    match words[..] {
        [] => Spot::Top,
        [kind, _, ":"] if BlockShape::find(kind).is_some() => Spot::Parent(kind.to_owned()),
        ["use"] => Spot::Top,
        _ => Spot::Nothing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(marked: &str) -> Spot {
        let offset = marked.find('¦').expect("a mark");
        spot(&marked.replace('¦', ""), offset as u32).0
    }

    fn value(spot: Spot) -> (String, String, Option<String>) {
        match spot {
            Spot::Value { block, key, clause } => (block.kind.to_owned(), key.key.to_owned(), clause),
            other => panic!("{other:?}"),
        }
    }

    fn key(spot: Spot) -> (String, Option<String>) {
        match spot {
            Spot::Key { block, before } => (block.kind.to_owned(), before.map(|k| k.key.to_owned())),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn keys_values_and_clauses_are_told_apart() {
        assert!(matches!(at("¦"), Spot::Top));
        assert!(matches!(at("scene a { seed 1 }\nca¦"), Spot::Top));
        assert_eq!(key(at("scene a {\n  se¦")), ("scene".to_owned(), None));
        assert_eq!(key(at("scene a {\n  seed 1\n  ru¦\n}")), ("scene".to_owned(), Some("seed".to_owned())));
        assert_eq!(value(at("camera c { projection per¦ }")), ("camera".to_owned(), "projection".to_owned(), None));
        let found = value(at("scene a { rules \"x.cga\" for buil¦ }"));
        assert_eq!(found, ("scene".to_owned(), "rules".to_owned(), Some("for".to_owned())));
        let found = value(at("dataset d { views a,\n   b¦ }"));
        assert_eq!(found, ("dataset".to_owned(), "views".to_owned(), None));
        assert!(matches!(at("camera low : sat¦"), Spot::Parent(kind) if kind == "camera"));
    }

    #[test]
    fn attributes_know_their_rule_file() {
        let spot = at("scene a { rules \"x.cga\" for building { hei¦ } }");
        assert!(matches!(spot, Spot::Attribute(Some(file)) if file == "x.cga"));
        assert!(matches!(at("scene a { rules \"x.cga\" { height = ta¦ } }"), Spot::AttributeValue));
    }

    #[test]
    fn a_block_that_was_left_open_ends_at_the_next() {
        assert_eq!(key(at("scene a {\n seed 1\ncamera c {\n  g¦ }")), ("camera".to_owned(), None));
    }

    #[test]
    fn texts_and_comments() {
        assert!(matches!(at("scene a { rules \"x¦"), Spot::Text(around) if matches!(*around, Spot::Value { .. })));
        assert!(matches!(at("# scene¦"), Spot::Nothing));
    }
}
