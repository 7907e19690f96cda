//! Places as the editor counts them: lines from 0, and units of the agreed encoding within a line. In: byte offsets, or
//! positions. Out: the other ones; what lies outside the text is brought to its nearest place.

use lsp_types::{Position, PositionEncodingKind, Range};

use crate::source::Span;

/// The unit of [`Position::character`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    Utf8,
    #[default]
    Utf16,
    Utf32,
}

impl Encoding {
    /// The first one that the client offers and that we know; UTF-16 where it offers none.
    pub fn negotiated(offered: Option<&[PositionEncodingKind]>) -> Encoding {
        let known = |kind: &PositionEncodingKind| match kind.as_str() {
            "utf-8" => Some(Encoding::Utf8),
            "utf-16" => Some(Encoding::Utf16),
            "utf-32" => Some(Encoding::Utf32),
            _ => None,
        };
        offered.unwrap_or_default().iter().find_map(known).unwrap_or_default()
    }

    pub fn kind(self) -> PositionEncodingKind {
        match self {
            Encoding::Utf8 => PositionEncodingKind::UTF8,
            Encoding::Utf16 => PositionEncodingKind::UTF16,
            Encoding::Utf32 => PositionEncodingKind::UTF32,
        }
    }

    /// Units of a character.
    fn units(self, c: char) -> usize {
        match self {
            Encoding::Utf8 => c.len_utf8(),
            Encoding::Utf16 => c.len_utf16(),
            Encoding::Utf32 => 1,
        }
    }

    /// Units of a text.
    pub fn length(self, text: &str) -> u32 {
        text.chars().map(|c| self.units(c)).sum::<usize>() as u32
    }
}

/// A text with the starts of its lines.
#[derive(Clone, Copy, Debug)]
pub struct Lines<'t> {
    pub text: &'t str,
    pub encoding: Encoding,
    starts: &'t [u32],
}

/// Byte offsets at which lines begin: behind `\n`, `\r\n` and `\r`.
pub fn line_starts(text: &str) -> Vec<u32> {
    let bytes = text.as_bytes();
    let ends = (0..bytes.len())
        .filter(|&i| bytes[i] == b'\n' || (bytes[i] == b'\r' && bytes.get(i + 1) != Some(&b'\n')))
        .map(|i| i as u32 + 1);
    std::iter::once(0).chain(ends).collect()
}

impl<'t> Lines<'t> {
    /// `starts` are those of [`line_starts`] of this text.
    pub fn new(text: &'t str, starts: &'t [u32], encoding: Encoding) -> Self {
        Lines { text, encoding, starts }
    }

    pub fn position(&self, offset: u32) -> Position {
        let mut offset = (offset as usize).min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.starts.partition_point(|start| *start as usize <= offset) - 1;
        let start = self.starts[line] as usize;
        Position { line: line as u32, character: self.encoding.length(&self.text[start..offset]) }
    }

    pub fn range(&self, start: u32, end: u32) -> Range {
        Range { start: self.position(start), end: self.position(end) }
    }

    pub fn of(&self, span: Span) -> Range {
        self.range(span.start, span.end)
    }

    /// The byte offset of a position; behind the end of its line it is that end.
    pub fn offset(&self, position: Position) -> u32 {
        let Some(&start) = self.starts.get(position.line as usize) else { return self.text.len() as u32 };
        let next = self.starts.get(position.line as usize + 1).map_or(self.text.len(), |next| *next as usize);
        let line = self.text[start as usize..next].trim_end_matches(['\r', '\n']);
        let mut left = position.character as usize;
        let mut at = start as usize;
        for c in line.chars() {
            let units = self.encoding.units(c);
            if left < units {
                break;
            }
            left -= units;
            at += c.len_utf8();
        }
        at as u32
    }

    /// Line of a byte offset, from 0.
    pub fn line(&self, offset: u32) -> u32 {
        self.starts.partition_point(|start| *start <= offset) as u32 - 1
    }

    /// Byte offset at which a line begins.
    pub fn start(&self, line: u32) -> u32 {
        self.starts.get(line as usize).copied().unwrap_or(self.text.len() as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::{Encoding, Lines, line_starts};
    use lsp_types::Position;
    use proptest::prelude::*;

    #[test]
    fn characters_count_in_units_of_the_encoding() {
        let text = "aä𝄞b\r\nzwei";
        let starts = line_starts(text);
        for (encoding, b) in [(Encoding::Utf8, 7), (Encoding::Utf16, 4), (Encoding::Utf32, 3)] {
            let lines = Lines::new(text, &starts, encoding);
            assert_eq!(lines.position(7), Position::new(0, b));
            assert_eq!(lines.offset(Position::new(0, b)), 7);
            assert_eq!(lines.offset(Position::new(0, 99)), 8, "the line ends before its line end");
            assert_eq!(lines.position(10), Position::new(1, 0));
            assert_eq!(lines.offset(Position::new(9, 0)), text.len() as u32);
        }
        let lines = Lines::new(text, &starts, Encoding::Utf16);
        assert_eq!(lines.offset(Position::new(0, 3)), 3, "half of a surrogate pair is its start");
    }

    proptest! {
        #[test]
        fn offsets_come_back(text in "[a\u{e4}\u{1d11e}\r\n]{0,30}", encoding in 0..3usize) {
            let encoding = [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32][encoding];
            let starts = line_starts(&text);
            let lines = Lines::new(&text, &starts, encoding);
            for (offset, _) in text.char_indices() {
                let at = lines.position(offset as u32);
                let inside_line_end = text[..offset].ends_with('\r') && text[offset..].starts_with('\n');
                if !inside_line_end {
                    prop_assert_eq!(lines.offset(at), offset as u32);
                }
            }
        }
    }
}
