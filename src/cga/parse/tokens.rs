//! What the lexer makes of a text: tokens of one ASCII letter each, so that the grammar (grammar/cga.pest) reads a short
//! text without layout and byte i of that text is token i.

use crate::source::{SourceFile, Span};

/// The letters of tokens; grammar/cga.pest gives them their names. Lower case: every word that may be a name.
pub mod letter {
    pub const NAME: u8 = b'a';
    /// `comp` with parentheses and a block behind it; so for the following.
    pub const COMP: u8 = b'o';
    pub const SPLIT: u8 = b'p';
    pub const SELECTORS: u8 = b'q';
    pub const SCATTER: u8 = b'k';
    pub const PERIMETER: u8 = b't';
    /// `inline` before a mode, a block or an item.
    pub const INLINE: u8 = b'i';
    /// `union`, `subtract`, `intersect` before a mode, a block or an item.
    pub const BOOLEAN_OPERATION: u8 = b'u';
    /// A name with parentheses and a dotted name directly behind them.
    pub const DYNAMIC: u8 = b'l';
    pub const EXTENDS: u8 = b'e';
    /// The first name of a percentage such as `share * 2 % :`.
    pub const WEIGHT: u8 = b'w';
    /// A name with `=` behind it and its parameters.
    pub const FUNCTION: u8 = b'x';
    /// A name with `-->` behind it and its parameters.
    pub const RULE: u8 = b'y';
    /// `start` or `extension` in front of a rule.
    pub const MODIFIER: u8 = b'z';

    pub const VERSION: u8 = b'V';
    pub const IMPORT: u8 = b'I';
    pub const STYLE: u8 = b'S';
    pub const ATTR: u8 = b'A';
    pub const CONST: u8 = b'C';
    pub const WITH: u8 = b'W';
    pub const CASE: u8 = b'K';
    pub const ELSE: u8 = b'E';
    pub const NIL: u8 = b'N';
    pub const BOOLEAN: u8 = b'B';

    pub const NUMBER: u8 = b'0';
    pub const STRING: u8 = b'"';
    pub const ARROW: u8 = b'Y';
    pub const DEFINE: u8 = b'D';
    pub const CONNECTED: u8 = b'Z';
    pub const EQUAL: u8 = b'Q';
    pub const NOT_EQUAL: u8 = b'U';
    pub const LESS_EQUAL: u8 = b'L';
    pub const GREATER_EQUAL: u8 = b'G';
    pub const AND: u8 = b'&';
    pub const OR: u8 = b'O';
    /// `%` in front of a colon.
    pub const PERCENT: u8 = b'P';
    /// `-` between two names without spaces: a difference, or part of a style's name.
    pub const TIGHT_MINUS: u8 = b'_';
    /// The dot of an element-wise operator; a terminal dot where a symbol stands before it.
    pub const ELEMENT: u8 = b'H';
    /// A dot with a name directly behind it, in one.
    pub const DOT_NAME: u8 = b'J';
    /// A dot directly in front of `(`.
    pub const DOT_CALL: u8 = b'T';
    /// What no form of the language holds: a string that is not closed, `$`, `2m`.
    pub const STRANGE: u8 = b'?';
    /// A bracket deeper than [`super::MAX_BRACKETS`].
    pub const TOO_DEEP: u8 = b'^';
}

/// Brackets within brackets of one declaration. Real rule files nest 8.
pub const MAX_BRACKETS: usize = 200;

/// The bytes of one token in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub start: u32,
    pub end: u32,
}

/// `// ...`, `# ...` or `/* ... */`, without the line end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Comment {
    pub start: u32,
    pub end: u32,
    /// Index of the token that follows, or the number of tokens.
    pub before: u32,
}

/// The tokens and comments of one text, in order.
#[derive(Clone, Debug, Default)]
pub struct Tokens {
    /// One letter per token.
    pub letters: String,
    pub places: Vec<Place>,
    pub comments: Vec<Comment>,
}

impl Tokens {
    pub fn len(&self) -> usize {
        self.places.len()
    }

    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The letter of token `index`, 0 behind the last.
    pub fn letter(&self, index: usize) -> u8 {
        self.letters.as_bytes().get(index).copied().unwrap_or(0)
    }

    /// What token `index` says; nothing behind the last.
    pub fn text<'t>(&self, text: &'t str, index: usize) -> &'t str {
        self.places.get(index).map_or("", |place| &text[place.start as usize..place.end as usize])
    }

    /// The span of tokens `from..to`; an empty place if there are none, the end of the text behind the last.
    pub fn span(&self, file: &SourceFile, from: usize, to: usize) -> Span {
        let start = self.places.get(from).map_or(file.text.len(), |place| place.start as usize);
        let to = to.min(self.places.len());
        let end = if to > from { self.places[to - 1].end as usize } else { start };
        Span::new(file.id, start, end)
    }

    /// Whether only white space stands before token `index` on its line.
    pub fn begins_line(&self, text: &str, index: usize) -> bool {
        let Some(place) = self.places.get(index) else { return false };
        let before = text[..place.start as usize].trim_end_matches([' ', '\t', '\u{feff}']);
        before.is_empty() || before.ends_with('\n')
    }
}
