//! The manual holds what it says. In: `docs/cga.md` and the program's tables. Out: the manual as it must be: signatures,
//! lists, outputs and the geometry behind every picture. `MANSARD_BLESS=1` writes what differs, pictures included.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use mansard::cga::builtins::{Attr, Function, Operation, usage};
use mansard::cga::program::Type;
use mansard::cga::{CompileOptions, compile_text};
use mansard::geometry::{Face, Mesh};
use mansard::interpreter::seed::Seed;
use mansard::interpreter::tree::ShapeTree;
use mansard::interpreter::{FileAssets, Limits, StartShape, derive, obj::to_obj, text::to_text};
use mansard::pipeline::portrait;
use mansard::source::{Access, SourceMap};

use crate::workshop::has_adapter;

/// Pixels of a picture.
const PICTURE: (u32, u32) = (360, 250);

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn blessing() -> bool {
    std::env::var("MANSARD_BLESS").is_ok_and(|v| v == "1")
}

/// The start shapes that examples name: corners (x, z) in metres.
fn lot(name: &str) -> Mesh {
    let corners: &[(f64, f64)] = match name {
        "lot" => &[(0.0, 0.0), (12.0, 0.0), (12.0, -8.0), (0.0, -8.0)],
        "L" => &[(0.0, 0.0), (14.0, 0.0), (14.0, -6.0), (6.0, -6.0), (6.0, -12.0), (0.0, -12.0)],
        other => panic!("the manual's examples use the lots `lot` and `L`, not `{other}`"),
    };
    let positions = corners.iter().map(|&(x, z)| glam::DVec3::new(x, 0.0, z)).collect();
    Mesh { positions, faces: vec![Face::new((0..corners.len() as u32).collect::<Vec<u32>>())] }
}

/// One example of the manual.
struct Example {
    heading: String,
    lot: String,
    rules: String,
}

impl Example {
    /// Derives the first rule; what goes wrong is added to `problems`.
    fn derive(&self, problems: &mut Vec<String>) -> ShapeTree {
        let mut sources = SourceMap::default();
        let (program, found) = compile_text(&self.heading, &self.rules, &mut sources, &CompileOptions::default());
        let start_rule = self.rules.lines().find_map(|l| l.split_once("-->")).map(|(name, _)| name.trim().to_owned());
        let wrong = found.iter().filter(|d| d.code != "cga::deprecated");
        let mut said: Vec<String> = wrong.map(|d| d.message.clone()).collect();
        let tree = program.map(|program| {
            let start = StartShape { start_rule, ..StartShape::new(lot(&self.lot), Seed::root(0), "lot") };
            let access = Access::new(root()).expect("the repository is there");
            derive(&program, &start, &FileAssets::new(access), &Limits::default())
        });
        let tree = tree.unwrap_or_default();
        said.extend(tree.diagnostics.iter().map(|d| d.message.clone()));
        problems.extend(said.into_iter().map(|m| format!("example of {}: {m}", self.heading)));
        tree
    }
}

/// A picture whose geometry is not the one the manual was blessed with.
struct Stale {
    name: PathBuf,
    tree: ShapeTree,
    lot: String,
}

/// The manual being read line by line.
#[derive(Default)]
struct Manual {
    out: String,
    headings: Vec<String>,
    functions: Vec<String>,
    attributes: Vec<String>,
    chapter: String,
    example: Option<Example>,
    tree: ShapeTree,
    problems: Vec<String>,
    stale: Vec<Stale>,
    picture: Option<PathBuf>,
}

impl Manual {
    fn read(text: &str) -> Manual {
        let mut manual = Manual::default();
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            let mut block = || lines.by_ref().take_while(|l| *l != "```").fold(String::new(), |all, l| all + l + "\n");
            if let Some(kind) = line.strip_prefix("```").filter(|k| !k.is_empty()) {
                let content = block();
                manual.block(kind, content);
            } else {
                manual.line(line);
            }
        }
        manual
    }

    fn put(&mut self, line: &str) {
        writeln!(self.out, "{line}").expect("a string takes everything");
    }

    fn block(&mut self, kind: &str, content: String) {
        let heading = self.headings.last().cloned().unwrap_or_default();
        let content = match kind.split_once(' ') {
            Some(("cga", lot)) => {
                let example = Example { heading, lot: lot.to_owned(), rules: content.clone() };
                self.tree = example.derive(&mut self.problems);
                self.example = Some(example);
                content
            }
            _ if kind == "text" => {
                let operation = Operation::from_name(&heading).expect("signatures stand under operations");
                usage::operation(operation).into_iter().fold(String::new(), |all, l| all + &l + "\n")
            }
            _ if kind == "output" => self.said(),
            _ => content,
        };
        self.put(&format!("```{kind}"));
        self.out.push_str(&content);
        self.put("```");
    }

    /// What the example prints and reports.
    fn said(&self) -> String {
        let all = to_text(&self.tree);
        let wanted = all.lines().filter(|l| l.starts_with("print ") || l.starts_with("report "));
        wanted.fold(String::new(), |all, l| all + l + "\n")
    }

    fn line(&mut self, line: &str) {
        if let Some(chapter) = line.strip_prefix("## ") {
            self.chapter = chapter.to_owned();
        } else if let Some(name) = line.strip_prefix("#### ") {
            self.headings.push(name.to_owned());
        } else if let Some(picture) = line.strip_prefix("![").and_then(|l| l.split_once("](")) {
            self.picture = Some(PathBuf::from(picture.1.trim_end_matches(')')));
        } else if line.starts_with("<!-- geometry") {
            return self.geometry(line);
        } else if line.starts_with("| ") && !line.starts_with("| ---") {
            return self.row(line);
        }
        self.put(line);
    }

    /// The hash of the geometry under a picture.
    fn geometry(&mut self, line: &str) {
        let heading = self.headings.last().cloned().unwrap_or_default();
        let name = self.picture.take().unwrap_or_else(|| panic!("{heading} has no picture"));
        if self.tree.leaves.is_empty() {
            self.problems.push(format!("example of {heading}: nothing is made"));
        }
        let hash = Seed::root(0).named(&to_obj(&self.tree)).bits();
        let fresh = format!("<!-- geometry {hash:016x} -->");
        let example = self.example.take().unwrap_or_else(|| panic!("{heading} has no example"));
        if fresh != line || !root().join("docs").join(&name).is_file() {
            self.stale.push(Stale { name, tree: std::mem::take(&mut self.tree), lot: example.lot });
        }
        self.put(&fresh);
    }

    /// A row of the tables of functions and attributes: the second column is ours.
    fn row(&mut self, line: &str) {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let (first, last) = (cells[0].replace('`', ""), cells[cells.len() - 1]);
        let code = |text: &str| format!("`{}`", text.replace('|', "\\|"));
        let second = match self.chapter.as_str() {
            "Functions" if first == "function" => "".into(),
            "Functions" => {
                let function = Function::from_name(&first).unwrap_or_else(|| panic!("`{first}` is no function"));
                self.functions.push(first.clone());
                usage::function(function).iter().map(|u| code(u)).collect::<Vec<_>>().join("<br>")
            }
            "Attributes" if first == "attribute" => "".into(),
            "Attributes" => self.attribute(&first),
            _ => return self.put(line),
        };
        if second.is_empty() {
            return self.put(line);
        }
        let names: Vec<String> = first.split_whitespace().map(code).collect();
        self.put(&format!("| {} | {second} | {last} |", names.join(" ")));
    }

    /// Type and whether it can be set, of attributes that share a row.
    fn attribute(&mut self, names: &str) -> String {
        let rows: Vec<_> = names
            .split_whitespace()
            .map(|name| Attr::from_name(name).unwrap_or_else(|| panic!("`{name}` is no attribute")))
            .collect();
        let kinds: Vec<_> = rows.iter().map(|r| (r.kind, r.writable)).collect();
        assert!(kinds.iter().all(|k| *k == kinds[0]), "{names} are not alike");
        self.attributes.extend(names.split_whitespace().map(str::to_owned));
        let kind = match kinds[0].0 {
            Type::Float => "number",
            Type::Bool => "bool",
            Type::String => "text",
            other => panic!("{names}: no attribute has type {other:?}"),
        };
        if kinds[0].1 { kind.to_owned() } else { format!("{kind}, read only") }
    }
}

/// Names of the tables that the manual lacks.
fn missing(manual: &Manual) -> Vec<String> {
    let operations = Operation::ALL.iter().map(|o| o.name()).filter(|n| !manual.headings.iter().any(|h| h == n));
    let functions = Function::ALL.iter().map(|f| f.name()).filter(|n| !manual.functions.iter().any(|f| f == n));
    let attributes = Attr::table().filter(|r| !r.deprecated).map(|r| r.name);
    let attributes = attributes.filter(|n| !manual.attributes.iter().any(|a| a == n));
    operations.chain(functions).chain(attributes).map(|n| format!("`{n}` is not in the manual")).collect()
}

#[test]
fn the_manual_says_what_the_program_does() {
    let path = root().join("docs/cga.md");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut manual = Manual::read(&text);
    let absent = missing(&manual);
    manual.problems.extend(absent);
    assert!(manual.problems.is_empty(), "{}", manual.problems.join("\n"));
    if blessing() {
        for stale in &manual.stale {
            draw(stale);
        }
        std::fs::write(&path, &manual.out).expect("the manual is writable");
        return;
    }
    let stale: Vec<String> = manual.stale.iter().map(|s| s.name.display().to_string()).collect();
    assert!(stale.is_empty(), "pictures of other geometry: {}; MANSARD_BLESS=1 draws them", stale.join(", "));
    for (number, (there, wanted)) in text.lines().zip(manual.out.lines()).enumerate() {
        assert_eq!(there, wanted, "docs/cga.md line {}; MANSARD_BLESS=1 writes it", number + 1);
    }
    assert_eq!(text.lines().count(), manual.out.lines().count(), "MANSARD_BLESS=1 writes docs/cga.md");
}

fn draw(stale: &Stale) {
    assert!(has_adapter(), "pictures are drawn by the renderer, which needs an adapter");
    let access = Access::new(root()).expect("the repository is there");
    let picture = portrait(&stale.tree, &lot(&stale.lot), &access, PICTURE).expect("the picture is drawn");
    let path = root().join("docs").join(&stale.name);
    std::fs::create_dir_all(path.parent().expect("pictures lie in a folder")).expect("docs is writable");
    picture.save(&path).expect("docs is writable");
}
