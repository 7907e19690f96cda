//! In: the text of a rule file. Out: its [`Tokens`] and comments (reference 1.1 to 1.5), every letter but those that
//! need a look ahead (see `classify`). Never fails: what is no token becomes [`letter::STRANGE`].

use super::classify::classify;
use super::tokens::{Comment, Place, Tokens, letter};

/// Reads `text` from byte `from` on; places count from the start of `text`.
pub fn lex(text: &str, from: usize) -> Tokens {
    let mut lexer = Lexer { text, at: from, tokens: Tokens::default(), letters: Vec::new() };
    let expected = (text.len() - from) / 5;
    lexer.tokens.places.reserve(expected);
    lexer.letters.reserve(expected);
    lexer.run();
    let Lexer { mut tokens, mut letters, .. } = lexer;
    classify(&mut letters);
    tokens.letters = String::from_utf8(letters).expect("the letters of tokens are ASCII");
    tokens
}

struct Lexer<'t> {
    text: &'t str,
    at: usize,
    tokens: Tokens,
    letters: Vec<u8>,
}

impl Lexer<'_> {
    fn run(&mut self) {
        while let Some(byte) = self.byte(0) {
            let start = self.at;
            match byte {
                b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c => self.at += 1,
                b'#' => self.comment(),
                b'/' if matches!(self.byte(1), Some(b'/' | b'*')) => self.comment(),
                b'"' => self.string(),
                b'0'..=b'9' => self.number(),
                b'.' if self.byte(1).is_some_and(|b| b.is_ascii_digit()) => self.number(),
                b'a'..=b'z' | b'A'..=b'Z' | b'_' => self.word(),
                0x80.. => self.beyond_ascii(),
                _ => {
                    let (kind, length) = self.mark(byte);
                    self.at += length;
                    self.push(kind, start);
                }
            }
        }
    }

    fn byte(&self, ahead: usize) -> Option<u8> {
        self.text.as_bytes().get(self.at + ahead).copied()
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn push(&mut self, kind: u8, start: usize) {
        self.letters.push(kind);
        self.tokens.places.push(Place { start: start as u32, end: self.at as u32 });
    }

    fn comment(&mut self) {
        let start = self.at;
        let rest = &self.text[start..];
        let length = match rest.starts_with("/*") {
            true => rest[2..].find("*/").map_or(rest.len(), |end| end + 4),
            false => rest.find('\n').map_or(rest.len(), |end| rest[..end].trim_end_matches('\r').len()),
        };
        self.at += length;
        let before = self.letters.len() as u32;
        self.tokens.comments.push(Comment { start: start as u32, end: self.at as u32, before });
    }

    /// A string up to its closing quote, over line ends; one that is never closed ends with its line.
    fn string(&mut self) {
        let start = self.at;
        let bytes = &self.text.as_bytes()[start..];
        let mut at = 1;
        loop {
            match bytes.get(at) {
                Some(b'\\') => at += 2,
                Some(b'"') => {
                    self.at += at + 1;
                    return self.push(letter::STRING, start);
                }
                Some(_) => at += 1,
                None => break,
            }
        }
        self.at += self.rest().lines().next().map_or(1, str::len);
        self.push(letter::STRANGE, start);
    }

    fn number(&mut self) {
        let start = self.at;
        self.digits();
        if self.byte(0) == Some(b'.') {
            if self.byte(1).is_some_and(|b| b.is_ascii_digit()) {
                self.at += 1;
                self.digits();
            } else if self.final_dot() {
                self.at += 1;
            }
        }
        self.exponent();
        let tail = word_length(self.rest());
        self.at += tail;
        self.push(if tail > 0 { letter::STRANGE } else { letter::NUMBER }, start);
    }

    fn digits(&mut self) {
        while self.byte(0).is_some_and(|b| b.is_ascii_digit()) {
            self.at += 1;
        }
    }

    /// Whether the dot behind digits belongs to the number: in `3.*v` it belongs to the operator.
    fn final_dot(&self) -> bool {
        let rest = &self.rest()[1..];
        let comment = rest.starts_with("//") || rest.starts_with("/*");
        let exponent =
            matches!(rest.as_bytes(), [b'e' | b'E', b'0'..=b'9', ..] | [b'e' | b'E', b'+' | b'-', b'0'..=b'9', ..]);
        comment || exponent || !rest.starts_with(|c| is_name_start(c) || "+-*/%=!<>&|.".contains(c))
    }

    fn exponent(&mut self) {
        if !matches!(self.byte(0), Some(b'e' | b'E')) {
            return;
        }
        let sign = usize::from(matches!(self.byte(1), Some(b'+' | b'-')));
        if self.byte(1 + sign).is_some_and(|b| b.is_ascii_digit()) {
            self.at += 1 + sign;
            self.digits();
        }
    }

    /// A name with the dots inside it: a dot belongs to the name only if a name follows it at once.
    fn word(&mut self) {
        let start = self.at;
        self.at += word_length(self.rest());
        while self.byte(0) == Some(b'.') && self.rest()[1..].starts_with(is_name_start) {
            self.at += 1;
            self.at += word_length(self.rest());
        }
        let kind = word_letter(&self.text[start..self.at]);
        self.push(kind, start);
    }

    fn beyond_ascii(&mut self) {
        let start = self.at;
        let first = self.rest().chars().next().expect("a byte stands here");
        if is_name_start(first) {
            return self.word();
        }
        self.at += first.len_utf8();
        match first {
            '\u{2019}' => self.push(b'\'', start),
            _ if first.is_whitespace() || first == '\u{feff}' => {}
            _ => self.push(letter::STRANGE, start),
        }
    }

    /// The letter and length of punctuation or an operator.
    fn mark(&self, byte: u8) -> (u8, usize) {
        let next = self.byte(1);
        match (byte, next) {
            (b'-', Some(b'-')) if self.byte(2) == Some(b'>') => (letter::ARROW, 3),
            (b'-', Some(_)) if self.is_tight() => (letter::TIGHT_MINUS, 1),
            (b':', Some(b'=')) => (letter::DEFINE, 2),
            (b'=', Some(b'=')) => (letter::EQUAL, 2),
            (b'=', Some(b':')) => (letter::CONNECTED, 2),
            (b'!', Some(b'=')) => (letter::NOT_EQUAL, 2),
            (b'<', Some(b'=')) => (letter::LESS_EQUAL, 2),
            (b'>', Some(b'=')) => (letter::GREATER_EQUAL, 2),
            (b'&', Some(b'&')) => (letter::AND, 2),
            (b'|', Some(b'|')) => (letter::OR, 2),
            (b'.', _) => self.dot(),
            (b'(' | b')' | b'[' | b']' | b'{' | b'}', _) => (byte, 1),
            (b'|' | b',' | b':' | b';' | b'=' | b'\'' | b'~' | b'@', _) => (byte, 1),
            (b'<' | b'>' | b'+' | b'-' | b'*' | b'/' | b'%' | b'!', _) => (byte, 1),
            _ => (letter::STRANGE, 1),
        }
    }

    /// Whether names stand directly on both sides.
    fn is_tight(&self) -> bool {
        self.text[..self.at].ends_with(is_name_part) && self.rest()[1..].starts_with(is_name_start)
    }

    fn dot(&self) -> (u8, usize) {
        let rest = &self.rest()[1..];
        if rest.starts_with(is_name_start) {
            let mut length = word_length(rest);
            while rest[length..].starts_with('.') && rest[length + 1..].starts_with(is_name_start) {
                length += 1 + word_length(&rest[length + 1..]);
            }
            return (letter::DOT_NAME, 1 + length);
        }
        let comment = rest.starts_with("//") || rest.starts_with("/*");
        let operator = rest.starts_with(['+', '-', '*', '/', '%', '!', '<', '>'])
            || ["==", "&&", "||"].iter().any(|o| rest.starts_with(o));
        match rest.as_bytes().first() {
            _ if operator && !comment && !rest.starts_with("-->") => (letter::ELEMENT, 1),
            Some(b'(') => (letter::DOT_CALL, 1),
            _ => (b'.', 1),
        }
    }
}

/// The letter of a word by itself; the words of operations and modifiers still depend on what follows.
fn word_letter(word: &str) -> u8 {
    match word {
        "version" => letter::VERSION,
        "import" => letter::IMPORT,
        "style" => letter::STYLE,
        "attr" => letter::ATTR,
        "const" => letter::CONST,
        "with" => letter::WITH,
        "case" => letter::CASE,
        "else" => letter::ELSE,
        "NIL" => letter::NIL,
        "true" | "false" => letter::BOOLEAN,
        "start" | "extension" => letter::MODIFIER,
        "extends" => letter::EXTENDS,
        "comp" => letter::COMP,
        "split" | "splitArea" => letter::SPLIT,
        "modify" | "setback" | "setbackPerEdge" | "setbackToArea" | "shapeL" | "shapeU" | "shapeO"
        | "innerRectangle" => letter::SELECTORS,
        "scatter" => letter::SCATTER,
        "splitAndSetbackPerimeter" => letter::PERIMETER,
        "inline" => letter::INLINE,
        "union" | "subtract" | "intersect" => letter::BOOLEAN_OPERATION,
        _ => letter::NAME,
    }
}

/// The length of the name without dots at the start.
fn word_length(text: &str) -> usize {
    let ascii = text.bytes().take_while(|b| b.is_ascii_alphanumeric() || *b == b'_').count();
    match text.as_bytes().get(ascii) {
        Some(0x80..) => text.find(|c| !is_name_part(c)).unwrap_or(text.len()),
        _ => ascii,
    }
}

fn is_name_start(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn is_name_part(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}
