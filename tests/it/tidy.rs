//! The house rules that a compiler does not check. In: the source tree. Out: every breach, by file and line.

use std::path::{Path, PathBuf};

/// Library modules in reading order: a module uses only what stands before it (`docs/architecture.md`).
const ORDER: &[&str] = &[
    "output",
    "source",
    "diagnostics",
    "parsing",
    "cga",
    "geometry",
    "geodata",
    "interpreter",
    "town",
    "scene",
    "spec",
    "plan",
    "frame",
    "sensor",
    "reference",
    "gpu",
    "cost",
    "dataset",
    "pipeline",
    "comparison",
    "live",
    "window",
    "language_server",
];

/// Modules that import nothing of ours.
const LEAVES: &[&str] = &["output", "source", "geometry", "frame"];

const LONGEST_FILE: usize = 600;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files(folder: &str, suffix: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
            let path = entry.expect("the folder can be listed").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.to_string_lossy().ends_with(suffix) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Path below the repository, for messages.
fn short(path: &Path) -> String {
    path.strip_prefix(root()).expect("all files lie in the repository").display().to_string()
}

/// The top-level module of a file under `src/`; `None` for `lib.rs` and the program.
fn module(path: &Path) -> Option<String> {
    let inside = path.strip_prefix(root().join("src")).expect("a source file");
    let first = inside.components().next().expect("a file has a name").as_os_str().to_string_lossy().into_owned();
    match first.strip_suffix(".rs").unwrap_or(&first) {
        "lib" | "bin" => None,
        name => Some(name.to_owned()),
    }
}

/// Names that follow `crate::` on a line of code, braces of one level included.
fn used_modules(line: &str) -> Vec<String> {
    let mut used = Vec::new();
    for (at, _) in line.match_indices("crate::") {
        let after = &line[at + "crate::".len()..];
        if at > 0 && line[..at].ends_with('$') {
            continue;
        }
        let end = after.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(after.len());
        if end > 0 {
            used.push(after[..end].to_owned());
        }
    }
    used
}

/// Lines of a file with their numbers, without comments and without what follows `#[cfg(test)]`.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .take_while(|(_, line)| !line.trim_start().starts_with("#[cfg(test)]"))
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
        .map(|(number, line)| (number + 1, line))
}

/// Whether a file belongs to a module that is declared under `#[cfg(test)]`.
fn is_test_file(path: &Path) -> bool {
    let declared = |folder: &Path, name: &str| {
        let own = folder.with_extension("rs");
        [folder.join("mod.rs"), own, folder.join("lib.rs")].iter().filter(|p| p.is_file()).any(|p| {
            let text = read(p);
            let lines: Vec<&str> = text.lines().map(str::trim).collect();
            lines.windows(2).any(|w| w[0] == "#[cfg(test)]" && w[1].ends_with(&format!("mod {name};")))
        })
    };
    path.ancestors().take_while(|p| p.starts_with(root().join("src")) && *p != root().join("src")).any(|p| {
        let name = p.file_stem().expect("a file or folder has a name").to_string_lossy().into_owned();
        declared(p.parent().expect("below src"), &name)
    })
}

#[test]
fn modules_use_only_what_stands_before_them() {
    let place = |name: &str| ORDER.iter().position(|m| *m == name);
    let mut breaches = Vec::new();
    for path in files("src", ".rs") {
        let Some(own) = module(&path) else { continue };
        let Some(own_place) = place(&own) else {
            breaches.push(format!("{}: module `{own}` is not in the list", short(&path)));
            continue;
        };
        if is_test_file(&path) {
            continue;
        }
        let text = read(&path);
        for (number, line) in code(&text) {
            for used in used_modules(line).into_iter().filter(|used| *used != own) {
                let allowed = place(&used).is_some_and(|p| p < own_place) && !LEAVES.contains(&own.as_str());
                if !allowed {
                    breaches.push(format!("{}:{number}: `{own}` may not use `{used}`", short(&path)));
                }
            }
        }
    }
    assert!(breaches.is_empty(), "{}", breaches.join("\n"));
}

#[test]
fn the_list_is_the_library() {
    let lib = read(&root().join("src/lib.rs"));
    let declared: Vec<&str> =
        lib.lines().filter_map(|l| l.strip_prefix("pub mod ")).map(|l| l.trim_end_matches(';')).collect();
    let mut expected = ORDER.to_vec();
    let mut sorted = declared.clone();
    expected.sort_unstable();
    sorted.sort_unstable();
    assert_eq!(sorted, expected);
}

#[test]
fn files_are_short_and_say_what_goes_in_and_out() {
    let mut breaches = Vec::new();
    for path in files("src", ".rs").into_iter().chain(files("tests", ".rs")) {
        let text = read(&path);
        let lines = text.lines().count();
        if lines > LONGEST_FILE {
            breaches.push(format!("{}: {lines} lines, at most {LONGEST_FILE}", short(&path)));
        }
        if !text.starts_with("//!") {
            breaches.push(format!("{}: does not open with `//!`", short(&path)));
        }
    }
    assert!(breaches.is_empty(), "{}", breaches.join("\n"));
}

#[test]
fn only_the_program_prints_or_exits_and_only_two_see_wgpu() {
    let mut breaches = Vec::new();
    for path in files("src", ".rs") {
        let Some(own) = module(&path) else { continue };
        if is_test_file(&path) {
            continue;
        }
        let text = read(&path);
        for (number, line) in code(&text) {
            let printed = ["println!", "eprintln!", "print!(", "eprint!(", "process::exit", "dbg!"];
            if printed.iter().any(|p| line.contains(p)) {
                breaches.push(format!("{}:{number}: prints or exits", short(&path)));
            }
            // The window's painter draws panels; nothing else of the window knows what shows it.
            let sees_wgpu = own == "gpu" || path.ends_with("window/painter.rs");
            if line.contains("wgpu") && !sees_wgpu {
                breaches.push(format!("{}:{number}: `{own}` speaks of wgpu", short(&path)));
            }
            if ["todo!(", "unimplemented!("].iter().any(|p| line.contains(p)) {
                breaches.push(format!("{}:{number}: not finished", short(&path)));
            }
        }
    }
    assert!(breaches.is_empty(), "{}", breaches.join("\n"));
}

#[test]
fn the_check_itself_sees_breaches() {
    assert_eq!(used_modules("use crate::gpu::device; let x = crate::plan::f();"), ["gpu", "plan"]);
    assert_eq!(used_modules("let y = $crate::plan;"), Vec::<String>::new());
    assert_eq!(code("a\n// b\nc\n#[cfg(test)]\nd").map(|(n, _)| n).collect::<Vec<_>>(), [1, 3]);
}
