//! In: where a declaration could not be read. Out: what was probably meant, if that can be told.

use super::Rule;
use super::explain::Reading;
use super::tokens::letter;
use crate::diagnostics::suggest;

/// Words that only other languages have, with what the rule language has instead.
const FOREIGN: &[(&str, &str)] = &[
    ("and", "`&&` joins conditions"),
    ("or", "`||` joins conditions"),
    ("not", "`!` negates"),
    ("if", "conditions are written `case condition : ... else : ...`"),
    ("elif", "another branch is written `case condition : ...`"),
    ("elseif", "another branch is written `case condition : ...`"),
    ("then", "a `:` stands behind a condition"),
    ("endif", "a chain ends with its `else : ...`"),
];

/// Words that begin a line, or a declaration.
const FIRST: &[&str] = &["attr", "const", "import", "style", "version", "start", "extension", "case", "else"];

impl Reading<'_> {
    /// The help for an error at `token`, where `expected` would have fitted.
    pub fn help(&self, token: usize, expected: &[Rule]) -> Option<String> {
        let fixed = self.character(token).or_else(|| self.arrow(token)).or_else(|| self.foreign_word(token));
        if let Some(fixed) = fixed.or_else(|| self.chain(token, expected)) {
            return Some(fixed.to_owned());
        }
        if let Some(word) = self.misspelt_keyword(token) {
            return Some(format!("did you mean `{word}`?"));
        }
        self.unclosed_bracket(token)
    }

    /// What a single token says.
    fn character(&self, token: usize) -> Option<&'static str> {
        let (letter, text) = (self.tokens.letter(token), self.text(token));
        match letter {
            b';' => Some("nothing stands between operations or declarations: leave the `;` out"),
            b'\'' if self.line(token).any(|i| i < token && self.tokens.letter(i) == b'\'') => {
                Some("strings stand in double quotes")
            }
            b'=' if self.line(token).any(|i| i < token && self.tokens.letter(i) == letter::CASE) => {
                Some("`==` compares")
            }
            letter::STRANGE if text == "$" => Some("names cannot hold `$`"),
            letter::STRANGE if text.starts_with(|c: char| c.is_ascii_digit()) => {
                Some("numbers have no units and names do not begin with digits")
            }
            letter::STRING if self.tokens.letter(self.first) == letter::IMPORT => {
                Some("imports are written `import prefix : \"file.cga\"`")
            }
            _ if self.tokens.letter(self.first) == letter::IMPORT && token == self.first + 2 => {
                Some("imports are written `import prefix : \"file.cga\"`")
            }
            _ => None,
        }
    }

    /// An arrow that is none, anywhere on the line.
    fn arrow(&self, token: usize) -> Option<&'static str> {
        let is_one = |i: usize| {
            let pair = (self.text(i), self.text(i + 1));
            matches!(pair, ("-" | "=" | "==" | "–" | "—", ">")) || matches!(pair.0, "→" | "⟶")
        };
        self.line(token).any(is_one).then_some("rules are written `Name --> ...`")
    }

    fn foreign_word(&self, token: usize) -> Option<&'static str> {
        let near = [Some(token), token.checked_sub(1).filter(|&i| i >= self.first)];
        let words = near.into_iter().flatten().map(|i| self.text(i));
        words.into_iter().find_map(|word| FOREIGN.iter().find(|(name, _)| *name == word)).map(|(_, help)| *help)
    }

    /// Mistakes in chains.
    fn chain(&self, token: usize, expected: &[Rule]) -> Option<&'static str> {
        let (has_else, has_case) = (expected.contains(&Rule::else_word), expected.contains(&Rule::case_word));
        match self.tokens.letter(token) {
            letter::CASE if has_else && !has_case => Some("`case` and percentages cannot be mixed in one chain"),
            letter::CASE => Some("a chain begins its body: put it in `[ ]`, or in a rule of its own"),
            letter::NUMBER | letter::WEIGHT if has_else && has_case => {
                Some("`case` and percentages cannot be mixed in one chain")
            }
            b':' if has_else && self.misspelt_keyword(token).is_none() => {
                Some("a branch begins with `case` and ends with the chain's `else : ...`")
            }
            b':' | letter::NUMBER => None,
            _ if has_else => Some("every chain of cases or percentages ends with `else : ...`"),
            _ => None,
        }
    }

    /// A word of the line, up to one token further, that is nearly a keyword in its place.
    fn misspelt_keyword(&self, token: usize) -> Option<&'static str> {
        let words = self.line(token).filter(|&i| i <= token + 1 && self.tokens.letter(i).is_ascii_lowercase());
        words.into_iter().find_map(|i| {
            let before = if i == self.first { 0 } else { self.tokens.letter(i - 1) };
            let begins = i == self.first || self.tokens.begins_line(&self.file.text, i);
            let keywords: &[&'static str] = match self.tokens.letter(i + 1) {
                _ if begins => FIRST,
                b':' => &["else"],
                b'(' => &["with"],
                _ if matches!(before, b':' | b'=' | b'[' | letter::ARROW) => &["case"],
                _ => return None,
            };
            suggest(self.text(i), keywords.iter().copied())
                .and_then(|found| keywords.iter().copied().find(|keyword| *keyword == found))
        })
    }

    /// The innermost bracket that is open where a declaration begins or the file ends.
    fn unclosed_bracket(&self, token: usize) -> Option<String> {
        let mut open = Vec::new();
        for i in self.first..token.min(self.tokens.len()) {
            match self.tokens.letter(i) {
                b'(' | b'[' | b'{' => open.push(i),
                b')' | b']' | b'}' => {
                    open.pop();
                }
                _ => {}
            }
        }
        let last = open.pop()?;
        let line = self.file.place(self.tokens.places[last].start).line;
        let here = self.file.place(self.tokens.span(self.file, token, token).start).line;
        (line != here).then(|| format!("the `{}` of line {line} is still open here", self.text(last)))
    }

    /// The tokens of the declaration that stand on the line of `token`; at its end, of its last line.
    fn line(&self, token: usize) -> impl Iterator<Item = usize> {
        let last = self.tokens.len().saturating_sub(1);
        let mut start = token.min(last);
        // Of long lines, what stands near the mistake.
        while start > self.first && start + 60 > token && !self.tokens.begins_line(&self.file.text, start) {
            start -= 1;
        }
        let mut end = start + 1;
        while end < self.tokens.len() && end < token + 20 && !self.tokens.begins_line(&self.file.text, end) {
            end += 1;
        }
        start..end
    }
}
