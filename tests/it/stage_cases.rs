//! The stage cases of `../shared/hard-cases/stages.json`: each is a test of its name somewhere in `src` or here, or in a list
//! here that says why not. In: the file and the sources. Out: names that are missing, unknown or taken twice.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

/// What does not hold or has nothing to hold on, with the reason.
const NOT_MET: &[(&str, &str)] = &[
    ("roof-ngon-apex", "rounding to 2^-30 of the extent parts the bisectors of edges 0.36 degrees apart by 0.7 mm"),
    ("tri-cocircular", "nothing here triangulates loose points; the ground's posts are those the tolerance needs"),
    ("dem-datum", "heights keep the datum of their file, and no camera has heights above the ellipsoid"),
];

/// The name of the test of a case.
fn test_name(id: &str) -> String {
    id.replace("--", "-minus-").replace(['-', '.'], "_").to_lowercase()
}

/// How often every function that follows `#[test]` is defined below a folder.
fn count_tests(folder: &Path, found: &mut BTreeMap<String, usize>) {
    for entry in std::fs::read_dir(folder).expect("the sources are there") {
        let path = entry.expect("the folder can be listed").path();
        if path.is_dir() {
            count_tests(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).expect("a source file");
            let lines: Vec<&str> = text.lines().map(str::trim).collect();
            for pair in lines.windows(2).filter(|pair| pair[0] == "#[test]") {
                if let Some(name) = pair[1].strip_prefix("fn ").and_then(|rest| rest.split('(').next()) {
                    *found.entry(name.to_owned()).or_default() += 1;
                }
            }
        }
    }
}

/// Names of all tests and how often they are there.
fn all_tests(root: &Path) -> BTreeMap<String, usize> {
    let mut tests = BTreeMap::new();
    ["src", "tests/it"].iter().for_each(|folder| count_tests(&root.join(folder), &mut tests));
    tests
}

#[test]
fn every_stage_case_is_a_test_or_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = root.join("../shared/hard-cases/stages.json");
    let Ok(text) = std::fs::read_to_string(&file) else {
        assert!(std::env::var_os("CI").is_none(), "{} is missing", file.display());
        return;
    };
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let ids: Vec<&str> = file["cases"].as_array().expect("cases").iter().filter_map(|c| c["id"].as_str()).collect();
    assert_eq!(ids.len(), 136);
    let tests = all_tests(root);
    let listed: Vec<&str> = NOT_MET.iter().map(|(id, _)| *id).collect();
    let mut wrong: Vec<String> = Vec::new();
    for id in &ids {
        let ways = listed.iter().filter(|l| l == &id).count() + tests.get(&test_name(id)).copied().unwrap_or(0);
        if ways != 1 {
            wrong.push(format!("{id}: {ways} times (test `{}`)", test_name(id)));
        }
    }
    wrong.extend(listed.iter().filter(|l| !ids.contains(l)).map(|l| format!("{l} is no case")));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// `docs/numerics.md` names tests; every name in the last columns of its tables must be one.
#[test]
fn the_tests_that_the_manual_names_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(root.join("docs/numerics.md")).expect("docs/numerics.md");
    let tests = all_tests(root);
    let mut named = 0;
    for line in text.lines().filter(|l| l.starts_with('|')) {
        for name in line.split('`').skip(1).step_by(2).filter(|n| n.len() > 6 && !n.contains([':', '.', ' '])) {
            assert!(tests.contains_key(name), "{name} is no test");
            named += 1;
        }
    }
    assert!(named > 80, "{named}");
}
