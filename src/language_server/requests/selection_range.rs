//! `textDocument/selectionRange`: the word, then what every bracket around it holds, the declaration, the file.

use lsp_types::{SelectionRange, SelectionRangeParams};

use crate::cga::parse::lex;
use crate::language_server::recipe_context;
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};

pub fn selection_range(
    workspace: &mut Workspace,
    params: SelectionRangeParams,
) -> Result<Vec<SelectionRange>, Refusal> {
    let path = workspace.path(&params.text_document.uri);
    let (Some(language), Some(text)) = (Language::of(&path), workspace.lined(&path)) else { return Ok(Vec::new()) };
    let lines = text.lines();
    // Tokens with whether they open (1) or close (-1) a bracket.
    let bracket = |at: u32| match text.text.as_bytes()[at as usize] {
        b'(' | b'[' | b'{' => 1,
        b')' | b']' | b'}' => -1,
        _ => 0,
    };
    let tokens: Vec<(u32, u32, i32)> = match language {
        Language::Rules => lex(&text.text, 0).places.iter().map(|p| (p.start, p.end, bracket(p.start))).collect(),
        Language::Recipe => recipe_context::tokens(&text.text)
            .iter()
            .map(|t| (t.start as u32, t.end as u32, bracket(t.start as u32)))
            .collect(),
    };
    let declarations: Vec<(u32, u32)> = match (language, workspace.rules(&path).filter(|_| language == Language::Rules))
    {
        (Language::Rules, Some(file)) => {
            let own = file.main().map_or(&[][..], |main| &main.ast.declarations);
            own.iter().map(|d| (d.span.start, d.span.end)).collect()
        }
        _ => Vec::new(),
    };
    let of = |offset: u32| {
        let mut ranges = vec![(0, text.text.len() as u32)];
        ranges.extend(declarations.iter().filter(|(a, b)| *a <= offset && offset <= *b));
        ranges.extend(brackets(&tokens, offset));
        let word = tokens.iter().filter(|(a, b, _)| *a <= offset && offset <= *b).max_by_key(|(a, _, _)| *a);
        ranges.extend(word.map(|(a, b, _)| (*a, *b)));
        let nested = |around: Option<Box<SelectionRange>>, (a, b): &(u32, u32)| {
            let range = lines.range(*a, *b);
            match around {
                Some(outer) if outer.range == range => Some(outer),
                outer => Some(Box::new(SelectionRange { range, parent: outer })),
            }
        };
        *ranges.iter().fold(None, nested).expect("the file is a range")
    };
    Ok(params.positions.into_iter().map(|position| of(lines.offset(position))).collect())
}

/// The brackets around a place, outer ones first: with their content, then the content alone.
fn brackets(tokens: &[(u32, u32, i32)], offset: u32) -> Vec<(u32, u32)> {
    let mut open: Vec<(u32, u32)> = Vec::new();
    let mut found: Vec<(u32, u32)> = Vec::new();
    for (start, end, bracket) in tokens {
        if *bracket > 0 {
            open.push((*start, *end));
        } else if *bracket < 0
            && let Some((from, inner)) = open.pop()
            && from < offset
            && offset < *end
        {
            found.extend([(inner, *start), (from, *end)]);
        }
    }
    found.retain(|(a, b)| *a <= offset && offset <= *b);
    found.reverse();
    found
}
