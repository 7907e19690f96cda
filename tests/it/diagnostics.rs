//! Every diagnostic code of the rule language has a page in `docs/diagnostics.md` and a case that raises it: the
//! example of the page is `tests/cases/diagnostics/CODE.cga`, and what the program says of it stands in `CODE.txt`.
//!
//! A case that begins with `//! derive` is derived on a footprint, which may be named, with `attr NAME=TEXT` behind it.
//! `MANSARD_BLESS=1` writes the texts anew; read them before they are committed.

use std::path::{Path, PathBuf};

use mansard::cga::{self, CompileOptions, codes};
use mansard::diagnostics::{Diagnostic, Diagnostics, explain, pages, render};
use mansard::geometry::{Mesh, PlaneFrame, Polygon};
use mansard::interpreter::seed::Seed;
use mansard::interpreter::tree::Scalar;
use mansard::interpreter::{FileAssets, Limits, StartShape, derive};
use mansard::source::{Access, SourceMap};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn cases() -> PathBuf {
    root().join("tests/cases/diagnostics")
}

/// `unknown-name` of `cga::unknown-name`.
fn stem(code: &str) -> &str {
    code.strip_prefix("cga::").unwrap_or_else(|| panic!("{code} is no code of the rule language"))
}

fn footprint(name: &str) -> Mesh {
    let corners: &[(f64, f64)] = match name {
        "" | "ring" | "nan" | "hollow" => &[(0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)],
        "doubled" => &[(0.0, 0.0), (10.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)],
        "wide" => &[(0.0, 0.0), (4e9, 0.0), (4e9, 8.0), (0.0, 8.0)],
        "ell" => &[(0.0, 0.0), (10.0, 0.0), (10.0, 3.0), (3.0, 3.0), (3.0, 8.0), (0.0, 8.0)],
        "cee" => &[(0.0, 0.0), (10.0, 0.0), (10.0, 1.0), (1.0, 1.0), (1.0, 7.0), (10.0, 7.0), (10.0, 8.0), (0.0, 8.0)],
        "spike" => &[(0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (10.0, 3.0), (0.0, 8.0)],
        other => panic!("there is no footprint `{other}`"),
    };
    let points = |list: &[(f64, f64)]| list.iter().map(|&(x, y)| glam::DVec2::new(x, y)).collect::<Vec<_>>();
    let holes = match name {
        "ring" => vec![points(&[(3.0, 3.0), (3.0, 5.0), (7.0, 5.0), (7.0, 3.0)])],
        "hollow" => vec![points(corners).into_iter().rev().collect()],
        _ => Vec::new(),
    };
    let mut mesh = Mesh::default();
    PlaneFrame::PLAN.push_face(&mut mesh, &Polygon { outer: points(corners), holes }, 0.0);
    if name == "nan" {
        mesh.positions[0].x = f64::NAN;
    }
    mesh
}

/// All that checking a case, and deriving it where it asks for that, has to say.
fn said(path: &Path, text: &str) -> (Diagnostics, SourceMap) {
    let mut sources = SourceMap::default();
    let access = Access::new(&cases()).expect("the folder of the cases exists");
    let Some(words) = text.lines().next().and_then(|line| line.strip_prefix("//! derive")) else {
        return (cga::check(path, &access, &mut sources), sources);
    };
    let mut words = words.split_whitespace().peekable();
    let mesh = footprint(words.next_if(|w| *w != "attr").unwrap_or(""));
    let mut start = StartShape::new(mesh, Seed::root(0), "case");
    if let Some((name, value)) = words.nth(1).and_then(|w| w.split_once('=')) {
        start.attributes.push((name.into(), Scalar::String(value.into())));
    }
    let (program, mut all) = cga::compile(path, &access, &mut sources, &CompileOptions::default());
    let Some(program) = program else { return (all, sources) };
    let limits = Limits { max_shapes: 2_000, max_vertices: 20_000, max_depth: 100, ..Limits::default() };
    all.extend(derive(&program, &start, &FileAssets::new(access), &limits).diagnostics);
    (all, sources)
}

/// Problems with one code, nothing if there are none.
fn problems(code: &str) -> Vec<String> {
    let path = cases().join(format!("{}.cga", stem(code)));
    let Ok(bytes) = std::fs::read(&path) else { return vec![format!("{code}: no case {}", path.display())] };
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let (diagnostics, sources) = said(&path, &text);
    let here = format!("{}/", cases().display());
    let real = format!("{}/", cases().canonicalize().expect("the folder of the cases exists").display());
    let shown = |d: &Diagnostic| {
        // Before the lines are broken: where the repository lies must not show.
        let message = d.message.replace(&here, "").replace(&real, "");
        render(&Diagnostic { message, ..d.clone() }, &sources, false).replace(&here, "").replace(&real, "")
    };
    let got: String = diagnostics.iter().map(shown).collect();
    let mut out = Vec::new();
    if !diagnostics.iter().any(|d| d.code == code) {
        let found: Vec<&str> = diagnostics.iter().map(|d| d.code).collect();
        out.push(format!("{code}: its case raises {found:?}"));
    }
    let expected = path.with_extension("txt");
    if std::env::var_os("MANSARD_BLESS").is_some() {
        std::fs::write(&expected, &got).expect("the folder of the cases can be written");
    } else if std::fs::read_to_string(&expected).ok().as_deref() != Some(&got) {
        out.push(format!("{code}: not what {} says:\n{got}", expected.display()));
    }
    out
}

#[test]
fn every_code_has_a_case_that_raises_it() {
    let problems: Vec<String> = codes::ALL.iter().copied().flat_map(problems).collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn every_case_has_a_code() {
    for entry in std::fs::read_dir(cases()).expect("the folder of the cases exists") {
        let path = entry.expect("the folder can be listed").path();
        let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
        assert!(path.is_dir() || codes::ALL.iter().any(|c| self::stem(c) == stem), "{}: no such code", path.display());
    }
}

#[test]
fn every_code_has_a_page_with_its_case_and_every_page_a_code() {
    let documented: Vec<&str> = pages().collect();
    let mut missing: Vec<&str> = codes::ALL.iter().copied().filter(|c| !documented.contains(c)).collect();
    missing.extend(documented.iter().filter(|c| !codes::ALL.contains(c)));
    assert!(missing.is_empty(), "a page or a code is missing: {missing:?}");
    for code in codes::ALL.iter().copied() {
        let page = explain(code).expect("it is documented");
        let bytes = std::fs::read(cases().join(format!("{}.cga", stem(code)))).expect("a case");
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let example: String = text.lines().filter(|l| !l.starts_with("//!")).map(|l| format!("{l}\n")).collect();
        let long = text.len() > 600;
        assert!(long || page.contains(&example) || !text.is_ascii(), "{code}: its page does not show its case");
    }
}

/// Whoever raises a new code adds it to the table, and so writes a page and a case.
#[test]
fn every_code_that_is_raised_is_in_the_table() {
    let mut unknown = Vec::new();
    let mut folders = vec![root().join("src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("the folder can be listed") {
            let path = entry.expect("the folder can be listed").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("sources are text");
            let text = text.split("#[cfg(test)]").next().unwrap_or_default();
            if path.components().any(|c| c.as_os_str().to_string_lossy().starts_with("tests")) {
                continue;
            }
            for part in text.split("\"cga::").skip(1) {
                let code = format!("cga::{}", part.split('"').next().unwrap_or_default());
                let whole = code[5..].bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-');
                if whole && !codes::ALL.contains(&&*code) {
                    unknown.push(format!("{}: {code}", path.display()));
                }
            }
        }
    }
    assert!(unknown.is_empty(), "{}", unknown.join("\n"));
}
