//! The rule files of a recipe, each compiled once. In: the recipe's references. Out: [`Programs`], and a diagnostic at the
//! recipe's own text for every file that is missing or out of bounds.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use sha2::{Digest, Sha256};

use super::memory::programs::Facts;
use super::shipped;
use crate::cga;
use crate::cga::program::Program;
use crate::diagnostics::{Diagnostic, Diagnostics, suggest};
use crate::source::{Access, AccessError, Project, SourceFile, SourceMap};
use crate::spec::render_spec::{AttributeSpec, FileRef, LevelEffect, Origin, RenderSpec, RuleAssignment};

/// Compiled rule files by [`key`].
#[derive(Default)]
pub struct Programs {
    programs: BTreeMap<Arc<str>, Compiled>,
    /// Trees of rule files that the command line names: their rules may read there.
    trees: Vec<PathBuf>,
}

struct Compiled {
    program: Program,
    /// Hash of its texts and of their places in the source map.
    identity: [u8; 32],
    /// Made when a build first keeps something.
    facts: OnceLock<Arc<Facts>>,
}

impl Programs {
    pub fn all(&self) -> impl Iterator<Item = &Program> {
        self.programs.values().map(|compiled| &compiled.program)
    }

    /// All keys, sorted.
    pub fn keys(&self) -> impl Iterator<Item = &Arc<str>> {
        self.programs.keys()
    }

    /// Key and program of a reference.
    pub fn entry(&self, file: &FileRef) -> (&Arc<str>, &Program) {
        let found = self.programs.get_key_value(&*key(file));
        let (key, compiled) = found.expect("every rule file of a checked recipe was compiled");
        (key, &compiled.program)
    }

    /// The program of a reference.
    pub fn get(&self, file: &FileRef) -> &Program {
        self.entry(file).1
    }

    /// The program with this key, if the recipe has it.
    pub fn find(&self, key: &str) -> Option<&Program> {
        self.programs.get(key).map(|compiled| &compiled.program)
    }

    /// The program with this key of the same recipe.
    pub fn with_key(&self, key: &str) -> &Program {
        self.find(key).expect("keys come from the same recipe")
    }

    /// Hash of the texts of each program and of their places in the source map, by key.
    pub(super) fn identities(&self) -> impl Iterator<Item = (&Arc<str>, &[u8; 32])> {
        self.programs.iter().map(|(key, compiled)| (key, &compiled.identity))
    }

    /// What is known of each program, by key.
    pub(super) fn facts(&self) -> impl Iterator<Item = (Arc<str>, Arc<Facts>)> {
        self.programs.iter().map(|(key, Compiled { program, identity, facts })| {
            let facts = facts.get_or_init(|| Arc::new(Facts::new(program, *identity)));
            (key.clone(), facts.clone())
        })
    }

    /// Folder trees besides the recipe's own that rules may read.
    pub fn trees(&self) -> &[PathBuf] {
        &self.trees
    }
}

fn key(file: &FileRef) -> String {
    match &file.origin {
        Origin::Shipped => format!("mansard:{}", file.written),
        Origin::CommandLine => file.written.clone(),
        Origin::Beside(folder) => format!("{}|{}", folder.display(), file.written),
    }
}

/// All rule assignments of a recipe in order.
fn assignments(spec: &RenderSpec) -> impl Iterator<Item = &RuleAssignment> {
    let levels = spec.changes.iter().flat_map(|c| &c.levels).flat_map(|level| match &level.effect {
        LevelEffect::Rules(rules) => rules.as_slice(),
        LevelEffect::Demolished | LevelEffect::Built => &[],
    });
    spec.scenes.iter().flat_map(|s| &s.rules).chain(levels)
}

/// Reports every map and elevation file that cannot be read, at the place that names it.
pub fn check_files(spec: &RenderSpec, access: &Access, diagnostics: &mut Diagnostics) {
    let data = spec.scenes.iter().flat_map(|s| s.maps.iter().chain(&s.elevations));
    for file in data.filter(|f| f.origin != Origin::Shipped) {
        if let Err(error) = file.resolve(access) {
            diagnostics.push(unreadable(file, &error));
        }
    }
}

fn unreadable(file: &FileRef, error: &AccessError) -> Diagnostic {
    match error {
        AccessError::Outside(_) => {
            let message = format!("`{}` leaves the recipe's folder tree", file.written);
            Diagnostic::error("render::path-outside", file.span, message)
                .help("`--allow DIR` lets the recipe read from one more folder tree")
        }
        AccessError::Io { source, .. } => {
            let message = format!("cannot read `{}`: {source}", file.written);
            Diagnostic::error("render::missing-file", file.span, message)
        }
        other => Diagnostic::error("render::missing-file", file.span, format!("cannot read {other}")),
    }
}

/// Compiles every rule file once and checks the attributes that the recipe sets.
pub fn compile(spec: &RenderSpec, access: &Access, sources: &mut SourceMap, diagnostics: &mut Diagnostics) -> Programs {
    let mut compiled = Programs::default();
    let mut tried: Vec<String> = Vec::new();
    for assignment in assignments(spec) {
        let key = key(&assignment.file);
        if !tried.contains(&key) {
            tried.push(key.clone());
            let before = sources.files().len();
            if let Some(program) = compile_file(&assignment.file, access, sources, &mut compiled.trees, diagnostics) {
                let identity = identity(&sources.files()[before..]);
                let own = Compiled { program, identity, facts: OnceLock::new() };
                compiled.programs.insert(key.as_str().into(), own);
            }
        }
        if let Some(Compiled { program, .. }) = compiled.programs.get(key.as_str()) {
            check_assignment(assignment, program, diagnostics);
        }
    }
    compiled
}

fn identity(files: &[SourceFile]) -> [u8; 32] {
    let mut hash = Sha256::new();
    for SourceFile { id, name, text } in files {
        hash.update(id.0.to_le_bytes());
        hash.update((name.len() as u64).to_le_bytes());
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(name.as_bytes());
        hash.update(text.as_bytes());
    }
    hash.finalize().into()
}

fn compile_file(
    file: &FileRef,
    access: &Access,
    sources: &mut SourceMap,
    trees: &mut Vec<PathBuf>,
    diagnostics: &mut Diagnostics,
) -> Option<Program> {
    let options = cga::CompileOptions::default();
    let (program, found) = if file.origin == Origin::Shipped {
        let Some(text) = shipped::text(&file.written) else {
            let names: Vec<&str> = shipped::names().collect();
            let message = format!("no rule file `{}` comes with Mansard", file.written);
            diagnostics.push(
                Diagnostic::error("render::missing-file", file.span, message)
                    .help(format!("there are {}", names.join(", "))),
            );
            return None;
        };
        cga::compile_text(&format!("mansard:{}", file.written), text, sources, &options)
    } else {
        match file.resolve(access) {
            Ok(path) => {
                let mut own = access.clone();
                if file.origin == Origin::CommandLine
                    && let Some(project) = path.parent().map(Project::of)
                {
                    if let Err(error) = own.allow(project.tree()) {
                        diagnostics.push(unreadable(file, &error));
                        return None;
                    }
                    trees.push(project.tree().to_owned());
                }
                cga::compile(&path, &own, sources, &options)
            }
            Err(error) => {
                diagnostics.push(unreadable(file, &error));
                return None;
            }
        }
    };
    diagnostics.extend(found);
    program
}

/// The start rule and the attributes that a recipe names must exist in the rule file.
fn check_assignment(assignment: &RuleAssignment, program: &Program, diagnostics: &mut Diagnostics) {
    if let Some(start) = &assignment.start
        && program.rule_named(start, 0).is_none()
    {
        let rules = program.rules().iter().filter(|r| r.parameters.is_empty()).map(|r| &*r.name);
        let message = format!("`{}` has no rule `{start}` without parameters", assignment.file.written);
        diagnostics.push(with_suggestion(
            Diagnostic::error("render::unknown-rule", assignment.span, message),
            suggest(start, rules),
        ));
    }
    for AttributeSpec { name, span, .. } in &assignment.attributes {
        let attributes = || program.attributes().iter().filter(|a| !a.is_const).map(|a| &*a.name);
        if !attributes().any(|a| a == name) {
            let message = format!("`{}` has no attribute `{name}`", assignment.file.written);
            diagnostics.push(with_suggestion(
                Diagnostic::error("render::unknown-attribute", *span, message),
                suggest(name, attributes()),
            ));
        }
    }
}

fn with_suggestion(diagnostic: Diagnostic, meant: Option<&str>) -> Diagnostic {
    match meant {
        Some(meant) => diagnostic.help(format!("did you mean `{meant}`?")),
        None => diagnostic,
    }
}
