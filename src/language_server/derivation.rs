//! Derivations for code lenses. In: a rule file, the recipe that uses it, unsaved texts. Out: [`Lenses`]: how often each
//! rule ran in the last derivation, how many leaves it made and how long it took.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use glam::DVec3;
use lsp_server::RequestId;

use super::uri;
use crate::cga::program::Program;
use crate::cga::{self, CompileOptions};
use crate::diagnostics::{Diagnostics, Severity};
use crate::geometry::{Face, Mesh};
use crate::interpreter::seed::Seed;
use crate::interpreter::{FileAssets, Limits, StartShape, derive_watched};
use crate::live::{thousands, usage};
use crate::pipeline::{PipelineError, RecipeOptions, load_recipe_over};
use crate::source::{Access, Overlay, SourceMap, Span};

/// What a derivation counted.
#[derive(Clone, Debug, Default)]
pub struct Lenses {
    pub counts: BTreeMap<Rule, Count>,
    /// What was derived, such as `riverside.render`.
    pub subject: String,
}

/// A rule, wherever it stands in its file by now.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rule {
    pub path: PathBuf,
    /// Without import prefixes.
    pub name: String,
    pub parameters: usize,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    pub calls: u64,
    /// Leaves that its body made.
    pub leaves: u64,
    /// Its own time, without the rules that it calls.
    pub milliseconds: f64,
}

/// A recipe to derive.
pub struct Subject {
    pub path: PathBuf,
    pub options: RecipeOptions,
    /// The user's settings name it; otherwise it was found, and a lot does as well.
    pub is_set: bool,
}

/// A derivation that another thread runs.
pub struct Work {
    pub rules: PathBuf,
    /// What the rules may read.
    pub access: Access,
    pub overlay: Overlay,
    pub recipe: Option<Subject>,
}

/// What came of it; `id` is the request that waits for it.
pub struct Derived {
    pub id: Option<RequestId>,
    /// The counts and one line for the user, or why there are none.
    pub outcome: Result<(Lenses, String), String>,
}

/// The lot that a rule file is derived on where no recipe uses it, metres.
const LOT: (f64, f64) = (10.0, 8.0);

impl Work {
    /// Derives; takes as long as the rules do, within their limits.
    pub fn run(self) -> Derived {
        let begun = Instant::now();
        let counted = match &self.recipe {
            Some(recipe) => self.in_recipe(recipe),
            None => self.on_lot(),
        };
        let outcome = counted.map(|lenses| {
            let summary = summary(&lenses, begun.elapsed());
            (lenses, summary)
        });
        Derived { id: None, outcome }
    }

    /// All features of all scenes in all their states, each alone.
    fn in_recipe(&self, subject: &Subject) -> Result<Lenses, String> {
        let mut sources = SourceMap::default();
        let recipe = match load_recipe_over(&subject.path, &subject.options, &self.overlay, &mut sources) {
            Ok(recipe) => recipe,
            // Its inputs are only known where it is rendered.
            Err(PipelineError::Diagnostics(found)) if !subject.is_set && is_incomplete(&found) => return self.on_lot(),
            Err(PipelineError::Diagnostics(found)) => return Err(first_error(&found)),
            Err(other) => return Err(other.to_string()),
        };
        let name = subject.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let mut lenses = Lenses { counts: BTreeMap::new(), subject: name };
        let mut rules: BTreeMap<Span, Rule> = BTreeMap::new();
        for program in recipe.programs.all() {
            rules.extend(keys(program, &sources, &recipe.access));
        }
        for scene in 0..recipe.spec.scenes.len() {
            for used in usage(&recipe, scene).map_err(|error| error.to_string())? {
                let Some(rule) = rules.get(&used.span) else { continue };
                let count = Count { calls: used.calls, leaves: used.leaves, milliseconds: used.milliseconds };
                lenses.counts.entry(rule.clone()).or_default().add(count);
            }
        }
        Ok(lenses)
    }

    /// As `mansard dump tree` does it.
    fn on_lot(&self) -> Result<Lenses, String> {
        let access = self.access.clone().with_overlay(&self.overlay);
        let mut sources = SourceMap::default();
        let (program, diagnostics) = cga::compile(&self.rules, &access, &mut sources, &CompileOptions::default());
        let program = program.ok_or_else(|| first_error(&diagnostics))?;
        let (x, z) = LOT;
        let positions = [(0.0, 0.0), (x, 0.0), (x, -z), (0.0, -z)].map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec();
        let mesh = Mesh { positions, faces: vec![Face::new(vec![0, 1, 2, 3])] };
        let start = StartShape::new(mesh, Seed::root(0), "footprint");
        let assets = FileAssets::new(access.clone());
        let (tree, watch) = derive_watched(&program, &start, &assets, &Limits::default(), None);
        if tree.diagnostics.has_errors() {
            return Err(first_error(&tree.diagnostics));
        }
        let mut lenses = Lenses { counts: BTreeMap::new(), subject: format!("a lot of {x} m × {z} m") };
        let rules: BTreeMap<Span, Rule> = keys(&program, &sources, &access).collect();
        for (number, rule) in program.rules().iter().enumerate() {
            let cost = watch.costs.iter().find(|(id, _)| id.0 as usize == number).map(|(_, cost)| *cost);
            let cost = cost.unwrap_or_default();
            let milliseconds = cost.time.as_secs_f64() * 1000.0;
            let count = Count { calls: cost.calls, leaves: cost.leaves, milliseconds };
            lenses.counts.entry(rules[&rule.span].clone()).or_default().add(count);
        }
        Ok(lenses)
    }
}

impl Count {
    fn add(&mut self, other: Count) {
        self.calls += other.calls;
        self.leaves += other.leaves;
        self.milliseconds += other.milliseconds;
    }
}

impl Rule {
    /// `name` with or without import prefixes.
    pub fn new(path: PathBuf, name: &str, parameters: usize) -> Rule {
        Rule { path, name: super::symbols::last_part(name).to_owned(), parameters }
    }
}

/// The rules of a program by the place of their names.
fn keys<'a>(
    program: &'a Program,
    sources: &'a SourceMap,
    access: &'a Access,
) -> impl Iterator<Item = (Span, Rule)> + use<'a> {
    program.rules().iter().map(|rule| {
        // Imported files are named from the first folder that may be read.
        let path = uri::real(&access.root().join(&*sources.get(rule.span.source).name));
        (rule.span, Rule::new(path, &rule.name, rule.parameters.len()))
    })
}

fn is_incomplete(found: &Diagnostics) -> bool {
    found.iter().all(|d| matches!(d.code, "spec::missing-input" | "spec::missing-block"))
}

fn first_error(found: &Diagnostics) -> String {
    let first = found.iter().find(|d| d.severity == Severity::Error);
    first.map_or_else(|| "nothing was derived".to_owned(), |d| d.message.clone())
}

fn summary(lenses: &Lenses, took: Duration) -> String {
    let leaves: u64 = lenses.counts.values().map(|count| count.leaves).sum();
    format!("{}: {} leaves in {:.0} ms", lenses.subject, thousands(leaves as usize), took.as_secs_f64() * 1000.0)
}
