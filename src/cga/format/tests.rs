//! The formatter on the house layout, on every rule file of the repository, and on random programs.

mod random;

use proptest::prelude::*;

use super::format;
use crate::cga::parse::parse;
use crate::source::SourceMap;
use random::Choices;

fn formatted(text: &str) -> Result<String, String> {
    let mut sources = SourceMap::default();
    let file = sources.add("test.cga", text);
    format(&file).map_err(|d| d.iter().map(|d| d.message.clone()).collect::<Vec<_>>().join("\n"))
}

/// The syntax tree without its places.
fn tree(text: &str) -> String {
    let mut sources = SourceMap::default();
    let (ast, diagnostics) = parse(&sources.add("test.cga", text));
    assert!(!diagnostics.has_errors(), "{text}");
    let full = format!("{ast:?}");
    let mut out = String::new();
    let mut rest = &*full;
    while let Some(at) = rest.find("Span { ") {
        out.push_str(&rest[..at]);
        rest = &rest[at + rest[at..].find('}').expect("a span is closed") + 1..];
    }
    out + rest
}

/// The comments in order, white space left out.
fn comments(text: &str) -> Vec<String> {
    let tokens = super::lex(text, 0);
    let of = |c: &crate::cga::parse::tokens::Comment| {
        text[c.start as usize..c.end as usize].split_whitespace().collect::<Vec<_>>().join(" ")
    };
    tokens.comments.iter().map(of).collect()
}

/// What must hold for every file without syntax errors.
#[track_caller]
fn check(text: &str) -> String {
    let once = formatted(text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let again = formatted(&once).unwrap_or_else(|e| panic!("not a rule file any more:\n{once}\n{e}"));
    assert_eq!(again, once, "formatting twice changed\n{text}");
    assert_eq!(tree(&once), tree(text), "the tree of\n{text}\nchanged with\n{once}");
    assert_eq!(comments(&once), comments(text), "comments of\n{text}\nin\n{once}");
    for line in once.lines() {
        let in_string_or_comment = line.contains('"') || line.contains("*") || line.contains("/");
        assert!(in_string_or_comment || line.trim_end() == line, "white space at the end of {line:?}");
    }
    once
}

/// Every rule file of the repository.
fn rule_files() -> Vec<std::path::PathBuf> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders: Vec<_> = ["rules", "examples", "tests"].iter().map(|name| root.join(name)).collect();
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.expect("the folder can be listed").path();
            match path.extension() {
                Some(extension) if extension == "cga" => found.push(path),
                _ if path.is_dir() => folders.push(path),
                _ => {}
            }
        }
    }
    found
}

#[test]
fn every_rule_file_keeps_its_tree_and_comments() {
    let files = rule_files();
    assert!(files.len() >= 6, "{files:?}");
    for path in files {
        let bytes = std::fs::read(&path).expect("a listed file");
        let text = crate::parsing::decode(&bytes).text;
        // Cases of syntax errors are not formatted.
        if formatted(&text).is_ok() {
            check(&text);
        }
    }
}

#[test]
fn the_rules_that_come_with_mansard_are_formatted() {
    for path in rule_files().iter().filter(|path| path.parent().is_some_and(|p| p.ends_with("rules"))) {
        let text = std::fs::read_to_string(path).expect("a listed file");
        assert_eq!(formatted(&text).as_deref(), Ok(&*text), "run mansard fmt on {}", path.display());
    }
}

/// Found by mutating rule files.
#[test]
fn free_text_in_annotations_stays_as_written() {
    check(
        "@Range(min=2, max=60 \"x\": 1\n  ] [ y\n\n const // a\n z, /* b */ 3) attr a = 1".replace("] [", "").as_str(),
    );
    check("@Handle(shape=Box * ^2,  translate={ 0,1 , 0} // c\n, skin=a) attr a = 1");
}

#[test]
fn a_file_with_errors_is_not_formatted() {
    assert_eq!(formatted("A --> extrude(3\nB --> NIL"), Err("expected `,` or `)`, found `B`".to_owned()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    #[test]
    fn random_programs_keep_their_tree_and_comments(
        text in prop::collection::vec(any::<u8>(), 0..400).prop_map(|bytes| Choices::new(&bytes).program())
    ) {
        check(&text);
    }
}
