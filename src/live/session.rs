//! One recipe, kept up to date. In: its path, options, [`Overrides`]. Out: the last good scene and an [`Update`] per round.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Instant, SystemTime};

use super::overrides::Overrides;
use super::picking::{LotInfo, Ray, lot};
use super::update::{Message, Phase, Redone, Update};
use crate::cga::program::Program;
use crate::pipeline::memory::Memory;
use crate::pipeline::memory::files::FileTable;
use crate::pipeline::{
    BuiltScene, Checks, PipelineError, Progress, Recipe, RecipeOptions, drawn_views, load_recipe, rebuild_scene,
};
use crate::plan::demand::State;
use crate::plan::view::DrawnView;
use crate::source::{Looked, SourceMap};
use crate::spec::render_spec::{FileRef, LevelEffect, RenderSpec};

/// A rule file that the recipe assigns, with its program: attributes and their annotations.
pub struct RuleFile<'a> {
    /// As the recipe writes it; the key of [`super::AttributeOverride::file`].
    pub written: &'a str,
    pub program: &'a Program,
}

/// A recipe with the last good scene and everything that is kept of it.
pub struct Session {
    path: PathBuf,
    options: RecipeOptions,
    stop: Arc<AtomicBool>,
    files: FileTable,
    /// What the last reading of the recipe looked at.
    looked: BTreeSet<PathBuf>,
    loaded: Option<Loaded>,
    /// By the name of the scene.
    memories: BTreeMap<String, Memory>,
    good: Option<Good>,
    /// What the last update was made under; `None` where there was none, or it was given up.
    settled: Option<Overrides>,
    /// The last update was given up. The next one goes on to its end: somebody who saves all the time sees something, too.
    was_cancelled: bool,
    last: Last,
    updates: u64,
    scenes: u64,
}

/// The recipe as it was last read without mistakes.
struct Loaded {
    recipe: Recipe,
    /// Without overrides.
    spec: RenderSpec,
    sources: Arc<SourceMap>,
}

/// What is shown.
struct Good {
    recipe: Recipe,
    sources: Arc<SourceMap>,
    scene: usize,
    built: Arc<BuiltScene>,
    views: Vec<DrawnView>,
}

/// What an update that finds nothing to do says again.
#[derive(Default)]
struct Last {
    diagnostics: Vec<Message>,
    failed: bool,
}

/// Lets the pipeline ask whether it should go on.
struct Watching<'a>(Option<&'a AtomicBool>);

impl Progress for Watching<'_> {
    fn begin(&self, _: &'static str, _: Option<u64>) {}
    fn step(&self, _: u64) {}
    fn end(&self, _: &str) {}
    fn warn(&self, _: &str) {}

    fn is_stopped(&self) -> bool {
        self.0.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

impl Session {
    /// Nothing is read yet: the first [`Session::update`] does it, and tells what is wrong.
    pub fn open(path: &Path, options: RecipeOptions) -> Session {
        Session {
            path: path.to_owned(),
            options,
            stop: Arc::default(),
            files: FileTable::default(),
            looked: BTreeSet::new(),
            loaded: None,
            memories: BTreeMap::new(),
            good: None,
            settled: None,
            was_cancelled: false,
            last: Last::default(),
            updates: 0,
            scenes: 0,
        }
    }

    /// Set it from any thread to give up the update that is running; the update clears it when it begins.
    pub fn stop(&self) -> Arc<AtomicBool> {
        self.stop.clone()
    }

    /// Brings everything up to date with the files on disk and the overrides. Never fails: what went wrong is in the
    /// update, and the scene before stands.
    pub fn update(&mut self, overrides: &Overrides) -> Update {
        self.stop.store(false, Ordering::Relaxed);
        self.updates += 1;
        let mut round = Round { began: SystemTime::now(), phases: Vec::new(), redone: Redone::default() };
        let changed = round.timed("look", || self.files.changed(&self.watched_now()));
        let is_first = self.updates == 1;
        if !is_first && changed.is_empty() && self.settled.as_ref() == Some(overrides) {
            return self.told(round, changed, false);
        }
        let cancelled = match self.bring(&changed, overrides, &mut round) {
            Ok(diagnostics) => {
                self.last = Last { failed: false, diagnostics };
                false
            }
            Err(Failed::Told(diagnostics)) => {
                self.last = Last { failed: true, diagnostics };
                false
            }
            Err(Failed::Stopped) => true,
        };
        self.was_cancelled = cancelled;
        self.settled = (!cancelled).then(|| overrides.clone());
        let looked = self.watched_now();
        self.files.learn(&looked, round.began);
        self.told(round, changed, cancelled)
    }

    fn told(&self, round: Round, changed: Vec<PathBuf>, cancelled: bool) -> Update {
        let name = |path: &PathBuf| {
            let here = std::env::current_dir().ok();
            let short = here.as_ref().and_then(|here| path.strip_prefix(here).ok());
            short.unwrap_or(path).display().to_string()
        };
        Update {
            number: self.updates,
            changed: changed.iter().map(name).collect(),
            redone: round.redone,
            phases: round.phases,
            diagnostics: self.last.diagnostics.clone(),
            stands: self.last.failed || cancelled,
            cancelled,
            triangles: self.built().map_or(0, |built| built.record.triangles),
            scene: self.scenes,
        }
    }

    /// Reads what changed, builds the scene and draws its views. Out: warnings.
    fn bring(&mut self, changed: &[PathBuf], overrides: &Overrides, round: &mut Round) -> Result<Vec<Message>, Failed> {
        if self.loaded.is_none() || changed.iter().any(|path| self.looked.contains(path)) {
            self.load(round)?;
        }
        let Some(Loaded { recipe, spec, sources }) = &mut self.loaded else {
            unreachable!("loading gives a recipe or says why not")
        };
        recipe.spec = spec.clone();
        overrides.apply(&mut recipe.spec);
        let scene = overrides.scene_of(&recipe.spec).map_err(|message| Failed::Told(vec![Message::plain(message)]))?;
        let name = recipe.spec.scenes[scene].name.clone();
        let memory = self.memories.entry(name).or_insert_with(Memory::keeping);
        let progress = Watching((!self.was_cancelled).then_some(&*self.stop));
        let built = rebuild_scene(recipe, scene, Checks::Off, memory, &progress);
        round.note(memory);
        let built = built.map_err(|error| failed(error, sources))?;
        let all = recipe.warnings.iter().chain(built.diagnostics.iter());
        let messages: Vec<Message> = all.map(|diagnostic| Message::new(diagnostic, sources)).collect();
        if messages.iter().any(Message::is_error) && self.good.is_some() {
            return Err(Failed::Told(messages));
        }
        let datasets = recipe.spec.datasets.iter();
        let views: Vec<DrawnView> =
            round.timed("views", || datasets.flat_map(|dataset| drawn_views(recipe, dataset, scene, &built)).collect());
        let before = self.good.as_ref();
        let is_new = before.is_none_or(|good| !Arc::ptr_eq(&good.built, &built));
        round.redone.scene = is_new;
        round.redone.views = is_new || before.is_none_or(|good| good.views != views);
        self.scenes += u64::from(is_new);
        self.good = Some(Good { recipe: recipe.clone(), sources: sources.clone(), scene, built, views });
        Ok(messages)
    }

    fn load(&mut self, round: &mut Round) -> Result<(), Failed> {
        let looked = Looked::default();
        let options = RecipeOptions { looked: Some(looked.clone()), ..self.options.clone() };
        let mut sources = SourceMap::default();
        let recipe = round.timed("compile", || load_recipe(&self.path, &options, &mut sources));
        self.looked = looked.paths();
        let sources = Arc::new(sources);
        // Until it is read again without mistakes there is nothing to build from.
        self.loaded = None;
        let recipe = recipe.map_err(|error| failed(error, &sources))?;
        round.redone.recipe = true;
        round.redone.programs = recipe.programs.keys().count();
        self.loaded = Some(Loaded { spec: recipe.spec.clone(), recipe, sources });
        Ok(())
    }

    /// Whether nothing that was looked at changed since the last update.
    pub fn is_current(&mut self) -> bool {
        self.settled.is_some() && self.files.is_current(&self.watched_now())
    }

    /// The last good scene; another `Arc` whenever anything of it changed.
    pub fn built(&self) -> Option<&Arc<BuiltScene>> {
        self.good.as_ref().map(|good| &good.built)
    }

    /// The recipe of the last good scene, overrides applied.
    pub fn recipe(&self) -> Option<&Recipe> {
        self.good.as_ref().map(|good| &good.recipe)
    }

    /// Texts of the last good scene's recipe and rules.
    pub fn sources(&self) -> Option<&SourceMap> {
        self.good.as_ref().map(|good| &*good.sources)
    }

    /// Index of the scene shown, into the recipe's.
    pub fn scene(&self) -> usize {
        self.good.as_ref().map_or(0, |good| good.scene)
    }

    /// Views that the recipe's datasets have of the scene shown, in their order, drawn under the overrides.
    pub fn views(&self) -> &[DrawnView] {
        self.good.as_ref().map_or(&[], |good| &good.views)
    }

    /// Every file that an update would look at, those included that are missing now.
    pub fn watched(&self) -> Vec<PathBuf> {
        self.watched_now().into_iter().collect()
    }

    fn watched_now(&self) -> BTreeSet<PathBuf> {
        let of_rules = self.memories.values().filter_map(Memory::looked).flat_map(Looked::paths);
        self.looked.iter().cloned().chain(of_rules).collect()
    }

    /// Rule files of the last good recipe, without repeats, in its order.
    pub fn rule_files(&self) -> Vec<RuleFile<'_>> {
        let Some(Good { recipe, .. }) = &self.good else { return Vec::new() };
        let mut files: Vec<RuleFile> = Vec::new();
        for file in assigned(&recipe.spec) {
            if files.iter().all(|known| known.written != file.written) {
                files.push(RuleFile { written: &file.written, program: recipe.programs.get(file) });
            }
        }
        files
    }

    /// What is known of an object of the scene shown, by its label in instance images; with a ray also the leaf that it
    /// meets first.
    pub fn lot(&self, instance: u32, state: State, ray: Option<Ray>) -> Option<LotInfo> {
        let Good { recipe, sources, scene, built, .. } = self.good.as_ref()?;
        let memory = self.memories.get(&recipe.spec.scenes[*scene].name)?;
        lot(recipe, sources, built, memory, (instance, state), ray)
    }

    /// Hash of all meshes, materials and labels of the scene shown, as the manifest tells it.
    pub fn geometry_sha256(&self) -> Option<&str> {
        self.built().map(|built| built.record.geometry_sha256.as_str())
    }
}

/// Every rule file that a recipe assigns, in its order.
pub(super) fn assigned(spec: &RenderSpec) -> impl Iterator<Item = &FileRef> {
    let levels = spec.changes.iter().flat_map(|change| &change.levels).flat_map(|level| match &level.effect {
        LevelEffect::Rules(rules) => rules.as_slice(),
        LevelEffect::Demolished | LevelEffect::Built => &[],
    });
    spec.scenes.iter().flat_map(|scene| &scene.rules).chain(levels).map(|rule| &rule.file)
}

/// Why a round did not end in a scene.
enum Failed {
    Told(Vec<Message>),
    Stopped,
}

fn failed(error: PipelineError, sources: &SourceMap) -> Failed {
    let messages = match error {
        PipelineError::Stopped => return Failed::Stopped,
        PipelineError::Diagnostics(list) => list.iter().map(|d| Message::new(d, sources)).collect(),
        PipelineError::Endless(list) => {
            let own =
                Message::plain(format!("{}; this update was given up", PipelineError::Endless(Default::default())));
            list.iter().map(|d| Message::new(d, sources)).chain([own]).collect()
        }
        other => vec![Message::plain(other.to_string())],
    };
    Failed::Told(messages)
}

/// One update while it runs.
struct Round {
    began: SystemTime,
    phases: Vec<Phase>,
    redone: Redone,
}

impl Round {
    fn timed<T>(&mut self, name: &str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.phases.push(Phase::new(name, start.elapsed().as_secs_f64()));
        result
    }

    /// Takes over what a build did.
    fn note(&mut self, memory: &Memory) {
        let log = memory.log();
        self.redone.place = log.place;
        (self.redone.lots_derived, self.redone.lots_kept) = (log.derived, log.kept);
        self.redone.ground = log.ground;
        self.phases.extend(log.phases.iter().map(|(name, seconds)| Phase::new(*name, *seconds)));
    }
}
