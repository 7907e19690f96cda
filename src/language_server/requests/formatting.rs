//! `textDocument/formatting`: rule files in the house layout. Recipes have none; a file with syntax errors stays.

use lsp_types::{DocumentFormattingParams, TextEdit};

use crate::cga;
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};
use crate::source::SourceMap;

pub fn formatting(workspace: &mut Workspace, params: DocumentFormattingParams) -> Result<Vec<TextEdit>, Refusal> {
    let path = workspace.path(&params.text_document.uri);
    let Some(text) = workspace.lined(&path).filter(|_| Language::of(&path) == Some(Language::Rules)) else {
        return Ok(Vec::new());
    };
    let file = SourceMap::default().add(path.display().to_string(), text.text.clone());
    let Ok(formatted) = cga::format(&file) else {
        return Err(Refusal::failed("the file has syntax errors; it stays as it is"));
    };
    Ok(difference(&text.text, &formatted)
        .map(|(start, end, new_text)| TextEdit { range: text.lines().range(start, end), new_text })
        .into_iter()
        .collect())
}

/// What lies between the common beginning and the common end of two texts; nothing if they are equal.
fn difference(old: &str, new: &str) -> Option<(u32, u32, String)> {
    if old == new {
        return None;
    }
    let common =
        |a: &str, b: &str| a.split_inclusive('\n').zip(b.split_inclusive('\n')).take_while(|(a, b)| a == b).count();
    let skip = |text: &str, lines: usize| text.split_inclusive('\n').take(lines).map(str::len).sum::<usize>();
    let lines = common(old, new);
    let (start, new_start) = (skip(old, lines), skip(new, lines));
    // The rest differs; its common end keeps markers and cursors of the editor where they are.
    let (rest, new_rest) = (&old[start..], &new[new_start..]);
    let ends = rest.split_inclusive('\n').rev().zip(new_rest.split_inclusive('\n').rev());
    let end: usize = ends.take_while(|(a, b)| a == b).map(|(a, _)| a.len()).sum();
    Some((start as u32, (old.len() - end) as u32, new_rest[..new_rest.len() - end].to_owned()))
}

#[cfg(test)]
mod tests {
    use super::difference;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_difference_makes_the_new_text(old in "[ab\n]{0,12}", new in "[ab\n]{0,12}") {
            let made = match difference(&old, &new) {
                None => old.clone(),
                Some((start, end, text)) => [&old[..start as usize], &text, &old[end as usize..]].concat(),
            };
            prop_assert_eq!(made, new);
        }
    }
}
