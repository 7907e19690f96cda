//! In: a text and a place in it that could not be read. Out: where the next declaration probably begins.

/// The offset of the first declaration header at or after `from`, or the end of the text.
///
/// A header is `attr`, `const`, `import`, `style`, an annotation, or a name with `-->` behind it; a function (a name
/// with `=`) counts only at the start of a line, because selectors look the same.
pub fn next_declaration(text: &str, from: usize) -> usize {
    let mut at = outside_word(text, from);
    while at < text.len() {
        let rest = &text[at..];
        let first = rest.chars().next().expect("at is inside the text");
        if first == '@' {
            return at;
        }
        if is_word(first) {
            let length = word_length(rest);
            if begins_declaration(text, at, length) {
                return at;
            }
            at += length;
            continue;
        }
        at += layout(rest).or_else(|| string(rest)).unwrap_or(first.len_utf8());
    }
    text.len()
}

/// The start of the first string before `end` that runs over a line end (or is never closed), if there is one.
pub fn string_over_lines(text: &str, end: usize) -> Option<usize> {
    let mut at = 0;
    while at <= end && at < text.len() {
        let rest = &text[at..];
        if rest.starts_with('"') {
            let length = closing(rest).unwrap_or(rest.len());
            if rest[..length].contains('\n') || closing(rest).is_none() {
                return Some(at);
            }
            at += length;
            continue;
        }
        at += layout(rest).unwrap_or_else(|| rest.chars().next().map_or(1, char::len_utf8));
    }
    None
}

fn begins_declaration(text: &str, at: usize, length: usize) -> bool {
    let (word, rest) = text[at..].split_at(length);
    match word {
        "attr" | "const" | "import" | "style" => return rest.starts_with(char::is_whitespace),
        "case" | "else" | "NIL" => return false,
        "start" | "extension" => {
            let rest = skip_layout(rest);
            let next = word_length(rest);
            if next > 0 && header_tail(&rest[next..]) == Some("-->") {
                return true;
            }
        }
        _ => {}
    }
    let line_start = text[..at].ends_with('\n') || at == 0;
    match header_tail(rest) {
        Some("-->") => true,
        Some(_) => line_start,
        None => false,
    }
}

/// `-->` or `=` if one stands behind optional parentheses.
fn header_tail(rest: &str) -> Option<&'static str> {
    let mut rest = skip_layout(rest);
    if rest.starts_with('(') {
        rest = skip_layout(&rest[parentheses(rest)?..]);
    }
    if rest.starts_with("-->") {
        return Some("-->");
    }
    (rest.starts_with('=') && !rest.starts_with("==") && !rest.starts_with("=:")).then_some("=")
}

/// The length of a balanced argument list; none if it is not closed within 2000 bytes.
fn parentheses(text: &str) -> Option<usize> {
    let mut depth = 0;
    let mut at = 0;
    while at < text.len().min(2000) {
        let rest = &text[at..];
        let first = rest.chars().next()?;
        depth += i32::from(first == '(') - i32::from(first == ')');
        at += layout(rest).or_else(|| string(rest)).unwrap_or(first.len_utf8());
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

fn skip_layout(mut text: &str) -> &str {
    while let Some(length) = layout(text) {
        text = &text[length..];
    }
    text
}

/// The length of the white space or comment at the start, if there is one.
fn layout(text: &str) -> Option<usize> {
    if text.starts_with("//") || text.starts_with('#') {
        return Some(text.find('\n').unwrap_or(text.len()));
    }
    if text.starts_with("/*") {
        return Some(text.find("*/").map_or(text.len(), |end| end + 2));
    }
    let length = text.len() - text.trim_start().len();
    (length > 0).then_some(length)
}

/// The length of the string at the start; one that is not closed ends with its line.
fn string(text: &str) -> Option<usize> {
    text.starts_with('"').then(|| {
        let line = text.find('\n').unwrap_or(text.len());
        closing(text).filter(|&end| end <= line).unwrap_or(line)
    })
}

/// The length of the string literal at the start with both quotes.
fn closing(text: &str) -> Option<usize> {
    let mut escaped = true;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = true,
            b'"' => return Some(at + 1),
            _ => {}
        }
    }
    None
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The length of the dotted name at the start.
fn word_length(text: &str) -> usize {
    text.find(|c| !is_word(c) && c != '.').unwrap_or(text.len())
}

/// The first character boundary at or after `at` that is not inside a name.
fn outside_word(text: &str, mut at: usize) -> usize {
    at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at += 1;
    }
    if text[..at].ends_with(is_word) { at + word_length(&text[at..]) } else { at }
}
