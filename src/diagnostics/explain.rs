//! The pages of `docs/diagnostics.md`. In: a code. Out: what it means, an example, the fix.

static PAGES: &str = include_str!("../../docs/diagnostics.md");

/// The codes that have a page, in the order of the document.
pub fn pages() -> impl Iterator<Item = &'static str> {
    PAGES.lines().filter_map(|line| line.strip_prefix("## "))
}

/// The page of a code, as Markdown; the code may be written without what stands before `::`.
pub fn explain(code: &str) -> Option<&'static str> {
    let heading = pages().find(|page| *page == code || page.split("::").last() == Some(code))?;
    let start = PAGES.find(&format!("\n## {heading}\n"))? + 1;
    let page = &PAGES[start..];
    let end = ["\n## ", "\n# "].iter().filter_map(|next| page.find(next)).min().unwrap_or(page.len());
    Some(page[..end].trim_end())
}

#[cfg(test)]
mod tests {
    use super::{explain, pages};

    #[test]
    fn a_page_ends_where_the_next_begins() {
        let page = explain("cga::unknown-operation").expect("a page");
        assert!(page.starts_with("## cga::unknown-operation\n") && page.matches("\n## ").count() == 0, "{page}");
        assert_eq!(explain("unknown-operation"), Some(page));
        assert_eq!(explain("cga::unknown-operations"), None);
        assert!(pages().all(|code| explain(code).is_some_and(|page| !page.contains("\n# "))));
    }
}
