//! `textDocument/foldingRange`: declarations, brackets and comments over several lines.

use std::collections::BTreeSet;

use lsp_types::{FoldingRange, FoldingRangeKind, FoldingRangeParams};

use crate::cga::parse::lex;
use crate::language_server::position::Lines;
use crate::language_server::recipe_context::{self, TokenKind};
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};

/// First and last line, and whether it is a comment.
type Fold = (u32, u32, bool);

pub fn folding_range(workspace: &mut Workspace, params: FoldingRangeParams) -> Result<Vec<FoldingRange>, Refusal> {
    let path = workspace.path(&params.text_document.uri);
    let Some(text) = workspace.lined(&path) else { return Ok(Vec::new()) };
    let lines = text.lines();
    let folds = match Language::of(&path) {
        Some(Language::Rules) => {
            let mut folds = of_tokens(&lines);
            if let Some(file) = workspace.rules(&path) {
                let own = file.main().map_or(&[][..], |main| &main.ast.declarations);
                folds.extend(own.iter().map(|d| (lines.line(d.span.start), lines.line(d.span.end), false)));
            }
            folds
        }
        Some(Language::Recipe) => of_recipe(&lines),
        None => Vec::new(),
    };
    // One fold per first line: the longest.
    let mut by_line: BTreeSet<(u32, std::cmp::Reverse<u32>, bool)> = BTreeSet::new();
    by_line.extend(folds.into_iter().filter(|(a, b, _)| a < b).map(|(a, b, c)| (a, std::cmp::Reverse(b), c)));
    let mut out: Vec<FoldingRange> = Vec::new();
    for (start, std::cmp::Reverse(end), is_comment) in by_line {
        if out.last().is_none_or(|last| last.start_line != start) {
            let kind = is_comment.then_some(FoldingRangeKind::Comment);
            out.push(FoldingRange { start_line: start, end_line: end, kind, ..FoldingRange::default() });
        }
    }
    Ok(out)
}

/// Brackets and comments. Lines of comments directly below each other are one.
fn of_tokens(lines: &Lines) -> Vec<Fold> {
    let tokens = lex(lines.text, 0);
    let mut out = Vec::new();
    let mut open: Vec<u32> = Vec::new();
    for (index, place) in tokens.places.iter().enumerate() {
        match tokens.letter(index) {
            b'(' | b'[' | b'{' => open.push(lines.line(place.start)),
            b')' | b']' | b'}' => {
                if let Some(start) = open.pop() {
                    // The closing bracket stays in sight.
                    out.push((start, lines.line(place.start).saturating_sub(1), false));
                }
            }
            _ => {}
        }
    }
    let comments = tokens.comments.iter().map(|c| (c.start, c.end));
    out.extend(comment_folds(lines, comments));
    out
}

fn comment_folds(lines: &Lines, comments: impl Iterator<Item = (u32, u32)>) -> Vec<Fold> {
    let mut out: Vec<Fold> = Vec::new();
    for (start, end) in comments {
        let (first, last) = (lines.line(start), lines.line(end.saturating_sub(1).max(start)));
        let alone = lines.text[lines.start(first) as usize..start as usize].trim().is_empty();
        match out.last_mut() {
            Some(before) if alone && before.1 + 1 == first => before.1 = last,
            _ if alone => out.push((first, last, true)),
            _ => {}
        }
    }
    out
}

fn of_recipe(lines: &Lines) -> Vec<Fold> {
    let mut out = Vec::new();
    let mut open: Vec<u32> = Vec::new();
    let tokens = recipe_context::tokens(lines.text);
    for token in &tokens {
        match (&token.kind, &lines.text[token.start..token.end]) {
            (TokenKind::Mark, "{" | "[" | "(") => open.push(lines.line(token.start as u32)),
            (TokenKind::Mark, "}" | "]" | ")") => {
                if let Some(start) = open.pop() {
                    out.push((start, lines.line(token.start as u32).saturating_sub(1), false));
                }
            }
            _ => {}
        }
    }
    let comments = tokens.iter().filter(|token| token.kind == TokenKind::Comment);
    out.extend(comment_folds(lines, comments.map(|token| (token.start as u32, token.end as u32))));
    out
}
