//! Queries for files (reference 6.5). In: the text of a query and the workspace path of a project. Out: a [`Query`]
//! that is asked of workspace paths.
//!
//! `trees/*.obj` counts from the project's assets folder and from the project, `/…`, `*…` and `?…` from the workspace;
//! `*` stands for any run of characters, slashes included, `?` for one. White space joins parts that must all match;
//! `'…'` and `\s` keep it. `Name=`, `Ext=`, `Project=` and `Path=` ask for a part of the path. A `$` in front makes
//! the query a regular expression for the whole path.

use regex::{Regex, RegexBuilder};

/// Longest query, bytes.
const LONGEST: usize = 1000;
/// Memory that a regular expression may compile to, bytes.
const MOST_COMPILED: usize = 1 << 20;

#[derive(Debug)]
pub struct Query {
    /// All must match.
    parts: Vec<(Subject, Regex)>,
}

/// What of a path a part is asked of.
#[derive(Clone, Copy, Debug)]
enum Subject {
    Path,
    Name,
    Extension,
    Project,
}

const PROPERTIES: &[(&str, Subject)] =
    &[("Name=", Subject::Name), ("Ext=", Subject::Extension), ("Project=", Subject::Project), ("Path=", Subject::Path)];

impl Query {
    /// `project` is the workspace path of the project, such as `/town`.
    pub fn new(text: &str, project: &str) -> Result<Query, String> {
        if text.len() > LONGEST {
            return Err(format!("a query of more than {LONGEST} bytes"));
        }
        if let Some(expression) = text.strip_prefix('$') {
            return Ok(Query { parts: vec![(Subject::Path, regex(expression)?)] });
        }
        let part = |word: Word| -> Result<(Subject, Regex), String> {
            let property = PROPERTIES.iter().find(|(prefix, _)| !word.quoted && word.text.starts_with(prefix));
            if let Some((prefix, subject)) = property {
                return Ok((*subject, regex(&pattern(&word.text[prefix.len()..]))?));
            }
            let own = pattern(&word.text);
            if word.text.starts_with(['/', '*', '?']) {
                return Ok((Subject::Path, regex(&own)?));
            }
            Ok((Subject::Path, regex(&format!("{}/(assets/)?{own}", regex::escape(project)))?))
        };
        Ok(Query { parts: words(text).into_iter().map(part).collect::<Result<_, _>>()? })
    }

    /// A query without parts matches nothing.
    pub fn matches(&self, path: &str) -> bool {
        let matches = |(subject, regex): &(Subject, Regex)| regex.is_match(subject.of(path));
        !self.parts.is_empty() && self.parts.iter().all(matches)
    }
}

impl Subject {
    fn of(self, path: &str) -> &str {
        let name = path.rsplit('/').next().unwrap_or(path);
        match self {
            Subject::Path => path,
            Subject::Name => name,
            Subject::Extension => name.rsplit_once('.').map_or("", |(_, extension)| extension),
            Subject::Project => path.trim_start_matches('/').split('/').next().unwrap_or(""),
        }
    }
}

struct Word {
    text: String,
    /// It began with a quote.
    quoted: bool,
}

fn words(text: &str) -> Vec<Word> {
    let mut words = Vec::new();
    let mut word: Option<Word> = None;
    let mut in_quotes = false;
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        if c.is_whitespace() && !in_quotes {
            words.extend(word.take());
            continue;
        }
        let current = word.get_or_insert(Word { text: String::new(), quoted: c == '\'' });
        match c {
            '\'' => in_quotes = !in_quotes,
            '\\' if chars.peek() == Some(&'s') => {
                chars.next();
                current.text.push(' ');
            }
            c => current.text.push(c),
        }
    }
    words.extend(word);
    words
}

/// The regular expression of a text with wildcards.
fn pattern(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(['*', '?']) {
        out += &regex::escape(&rest[..at]);
        out += if rest[at..].starts_with('*') { ".*" } else { "." };
        rest = &rest[at + 1..];
    }
    out + &regex::escape(rest)
}

/// An expression for the whole text.
fn regex(expression: &str) -> Result<Regex, String> {
    let whole = format!("^(?:{expression})$");
    let built = RegexBuilder::new(&whole).dot_matches_new_line(true).size_limit(MOST_COMPILED).build();
    built.map_err(|error| match error {
        regex::Error::CompiledTooBig(_) => "the regular expression is too large".to_owned(),
        _ => format!("`{expression}` is no regular expression"),
    })
}

#[cfg(test)]
mod tests {
    use super::Query;

    const FILES: &[&str] = &[
        "/other/assets/oak.obj",
        "/town/assets/a b.txt",
        "/town/assets/trees/oak.obj",
        "/town/assets/trees/tall/fir.obj",
        "/town/assets/trees/fir.png",
        "/town/rules/x.cga",
        "/town/trees/oak.obj",
    ];

    #[track_caller]
    fn found(query: &str, expected: &[usize]) {
        let query_ = Query::new(query, "/town").expect(query);
        let hits: Vec<usize> = (0..FILES.len()).filter(|&i| query_.matches(FILES[i])).collect();
        assert_eq!(hits, expected, "{query}");
    }

    #[test]
    fn relative_queries_count_from_assets_and_project() {
        found("trees/oak.obj", &[2, 6]);
        found("trees/*.obj", &[2, 3, 6]);
        found("assets/trees/fir.*", &[4]);
        found("/town/trees/*", &[6]);
        found("*oak.obj", &[0, 2, 6]);
        found("?town?rules*", &[5]);
        found("", &[]);
        found("oak.obj", &[]);
    }

    #[test]
    fn parts_properties_quotes_and_expressions() {
        found("*.obj *trees*", &[2, 3, 6]);
        found("Name=oak.*", &[0, 2, 6]);
        found("Ext=obj Project=other", &[0]);
        found("Path=/town/* Ext=p?g", &[4]);
        found("'a b.txt'", &[1]);
        found("*a\\sb*", &[1]);
        found("$.*/(oak|fir)\\.obj", &[0, 2, 3, 6]);
        assert!(Query::new("$(", "/town").is_err_and(|e| e.contains("no regular expression")));
        assert!(Query::new("$(a{1000}){1000}", "/town").is_err_and(|e| e.contains("too large")));
        assert!(Query::new(&"*".repeat(1001), "/town").is_err());
        // Linear in the path whatever the query: no blow-up.
        assert!(
            !Query::new(&"*a".repeat(400), "/town")
                .expect("short enough")
                .matches(&"a".repeat(3000).replace("aaa", "b"))
        );
    }
}
