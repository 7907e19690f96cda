//! Every operation and function has a test. In: the tables of built-ins and the texts of all tests. Out: the table
//! `docs/cga-coverage.md`; a name that no test's rules use is a failure. `MANSARD_BLESS=1` writes the table.
//!
//! A test covers a name if a rule text in its own body uses it; that the test asserts on the result is for people to see.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use mansard::cga::builtins::{Function, Operation};

/// Tests of how rules run; those of parser and checker do not count.
const FOLDERS: &[&str] = &["src/interpreter", "tests/it"];

/// Names of one letter stand for much else in a text.
const SHORT: usize = 1;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap_or_else(|e| panic!("{}: {e}", folder.display()))
        .map(|entry| entry.expect("the folder can be listed").path())
        .collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") && !path.ends_with("tests/it/coverage.rs") {
            found.push(path);
        }
    }
}

/// Name and text of every `#[test]` function; a test ends where the next item at the margin begins.
fn tests(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for part in text.split("#[test]").skip(1) {
        let Some((_, after)) = part.split_once("fn ") else { continue };
        let Some((name, body)) = after.split_once('(') else { continue };
        let margin = part.find("fn ").map_or(0, |at| at - part[..at].rfind('\n').map_or(0, |n| n + 1));
        let end = format!("\n{}}}", " ".repeat(margin));
        let body = body.find(&end).map_or(body, |at| &body[..at]);
        found.push((name.to_owned(), strings(body)));
    }
    found
}

/// The string literals of a piece of Rust, joined.
fn strings(code: &str) -> String {
    let mut out = String::new();
    let mut rest = code;
    while let Some(at) = rest.find('"') {
        let hashes = rest[..at].len() - rest[..at].trim_end_matches('#').len();
        let raw = rest[..at - hashes].ends_with('r');
        rest = &rest[at + 1..];
        let close = if raw {
            rest.find(&format!("\"{}", "#".repeat(hashes)))
        } else {
            let mut escaped = false;
            rest.char_indices().find_map(|(i, c)| {
                let found = c == '"' && !escaped;
                escaped = c == '\\' && !escaped;
                found.then_some(i)
            })
        };
        let close = close.unwrap_or(rest.len());
        out.push_str(&rest[..close]);
        out.push('\n');
        rest = rest.get(close + 1 + if raw { hashes } else { 0 }..).unwrap_or("");
    }
    out
}

/// Whether rules in `text` use `name`.
fn uses(text: &str, name: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    text.match_indices(name).any(|(at, _)| {
        let (before, after) = (text[..at].chars().next_back(), text[at + name.len()..].chars().next());
        let whole = !before.is_some_and(|c| part(c) || c == '"') && !after.is_some_and(|c| part(c) && c != '.');
        whole && (name.len() > SHORT || after == Some('('))
    })
}

/// Name → first test that uses it, tests in the order of their files.
fn covered() -> (BTreeMap<&'static str, String>, Vec<&'static str>) {
    let mut files = Vec::new();
    FOLDERS.iter().for_each(|folder| rust_files(&root().join(folder), &mut files));
    let mut all = Vec::new();
    for path in files {
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let short = path.strip_prefix(root()).expect("below the repository").display().to_string();
        let module = short.trim_end_matches(".rs").trim_start_matches("src/").replace('/', "::");
        all.extend(tests(&text).into_iter().map(|(name, rules)| (format!("{module}::{name}"), rules)));
    }
    let names = Operation::ALL.iter().map(|o| o.name()).chain(Function::ALL.iter().map(|f| f.name()));
    let mut found = BTreeMap::new();
    let mut without = Vec::new();
    for name in names {
        match all.iter().find(|(_, rules)| uses(rules, name)) {
            Some((test, _)) => drop(found.insert(name, test.clone())),
            None => without.push(name),
        }
    }
    (found, without)
}

fn table(found: &BTreeMap<&'static str, String>, without: usize) -> String {
    let mut out =
        String::from("# Which test covers what\n\nOne test for each operation and function of the language; ");
    out.push_str("most have several. Written by `tests/it/coverage.rs`.\n");
    let lists: [(&str, Vec<&'static str>); 2] = [
        ("operation", Operation::ALL.iter().map(|o| o.name()).collect()),
        ("function", Function::ALL.iter().map(|f| f.name()).collect()),
    ];
    for (kind, names) in lists {
        write!(out, "\n| {kind} | test |\n| --- | --- |\n").expect("a string takes everything");
        for name in names {
            let test = found.get(name).map_or("–", String::as_str);
            writeln!(out, "| `{name}` | `{test}` |").expect("a string takes everything");
        }
    }
    write!(out, "\nWithout a test: {without}.\n").expect("a string takes everything");
    out
}

#[test]
fn every_operation_and_function_has_a_test() {
    let (found, without) = covered();
    let wanted = table(&found, without.len());
    let path = root().join("docs/cga-coverage.md");
    if std::env::var("MANSARD_BLESS").is_ok_and(|v| v == "1") {
        std::fs::write(&path, &wanted).expect("docs is writable");
    }
    assert!(without.is_empty(), "no test's rules use {}", without.join(", "));
    let there = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert_eq!(there, wanted, "MANSARD_BLESS=1 writes docs/cga-coverage.md");
}

#[test]
fn only_rule_texts_of_the_test_itself_count() {
    let code = "const A: &str = \"taper(1)\";\n#[test]\nfn one() {\n    run(\"Lot --> extrude(2)\", r#\"s('1,\"2\",3)\"#);\n}\nfn t() { \"split\" }\n";
    let found = tests(code);
    assert_eq!(found[0].0, "one");
    assert!(uses(&found[0].1, "extrude") && uses(&found[0].1, "s"));
    assert!(!uses(&found[0].1, "taper") && !uses(&found[0].1, "split") && !uses("listS.(1)", "s"));
    assert!(uses("x = geometry.area(top)", "geometry.area") && !uses("geometry.areas", "geometry.area"));
}
