//! Names of tags and questions about them. In: texts of a rule file. Out: clean names, and [`Query`]s that match them
//! (reference 4.15.1).

use std::sync::Arc;

/// A question about tag names: dot-separated subtags, `?` for exactly one of any name, `*` for one or more. It matches
/// every tag that begins with what it says. An empty query matches every tag.
#[derive(Clone, Debug, PartialEq)]
pub struct Query {
    text: Arc<str>,
}

impl Query {
    pub fn new(text: impl Into<Arc<str>>) -> Self {
        Query { text: text.into() }
    }

    /// Matches everything.
    pub fn any() -> Self {
        Query::new("")
    }

    pub fn matches(&self, tag: &str) -> bool {
        if self.text.is_empty() {
            return true;
        }
        let query: Vec<&str> = self.text.split('.').collect();
        let tag: Vec<&str> = tag.split('.').collect();
        begins(&query, &tag)
    }
}

/// Whether a beginning of `tag` is what `query` says. Tries the shortest run of every `*` first; of several stars only
/// the last needs to be tried again, so the time is the product of both lengths.
fn begins(query: &[&str], tag: &[&str]) -> bool {
    let (mut q, mut t) = (0, 0);
    let mut retry: Option<(usize, usize)> = None;
    while q < query.len() {
        let fits = t < tag.len() && (matches!(query[q], "?" | "*") || query[q] == tag[t]);
        if fits {
            if query[q] == "*" {
                retry = Some((q, t));
            }
            q += 1;
            t += 1;
        } else if let Some((star, from)) = retry {
            if from + 1 >= tag.len() {
                return false;
            }
            retry = Some((star, from + 1));
            q = star + 1;
            t = from + 2;
        } else {
            return false;
        }
    }
    true
}

/// A name as it is kept: `*` and `?` are left out; `None` if nothing remains.
pub fn tag_name(text: &str) -> Option<Arc<str>> {
    let clean: String = text.chars().filter(|c| !matches!(c, '*' | '?')).collect();
    (!clean.is_empty()).then(|| clean.into())
}
