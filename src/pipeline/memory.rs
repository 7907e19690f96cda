//! What a build keeps for the next one. In: the results of every phase with what each was made from. Out: the same results
//! again where nothing of that changed.
//!
//! There is one path through the phases. A build with an empty memory is a cold one; what a memory gives back is what the
//! same code made before from equal inputs, so that both end in the same bytes.

pub(super) mod attributes;
pub(crate) mod files;
pub(super) mod programs;
pub(super) mod questions;
pub(crate) mod states;

use std::sync::Arc;
use std::time::{Instant, SystemTime};

use super::build::{BuiltScene, Fineness};
use super::place::KeptSite;
use super::preparation::{KeptPreparation, PreparedScene};
use super::recipe::Recipe;
use super::textures;
use crate::geodata::terrain::Terrain;
use crate::geometry::Polygon;
use crate::interpreter::FileAssets;
use crate::scene::assemble;
use crate::scene::ground::{GroundError, GroundLayer, GroundMesh, build_ground};
use crate::source::Looked;
use crate::spec::render_spec::SceneSpec;
use files::FileTable;
use states::States;

/// Results of the builds before of one scene. The default keeps nothing: every build with it is a cold one.
#[derive(Default)]
pub struct Memory {
    pub(super) keeps: bool,
    pub(super) files: FileTable,
    pub(super) site: Option<KeptSite>,
    pub(super) prepared: Option<KeptPreparation>,
    pub(super) states: States,
    pub(super) meshes: assemble::Kept,
    pub(super) textures: textures::Kept,
    scene: Option<KeptScene>,
    ground: Option<KeptGround>,
    assets: Option<KeptAssets>,
    log: Log,
    /// The scene that is kept is older than the states or the ground: a build was given up between them.
    is_behind: bool,
    /// When the build began.
    began: Option<SystemTime>,
}

/// What the last build did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log {
    /// Map and elevation were read.
    pub place: bool,
    /// States of features.
    pub derived: usize,
    pub kept: usize,
    pub ground: bool,
    /// The scene is another one than before.
    pub scene: bool,
    /// Seconds by phase, in the order they ran.
    pub phases: Vec<(&'static str, f64)>,
}

struct KeptGround {
    /// What the terrain was made from; the same terrain is the same `Arc`.
    terrain: Arc<Terrain>,
    area: Polygon,
    tolerance_m: f64,
    layers: Vec<GroundLayer>,
    mesh: Arc<GroundMesh>,
}

struct KeptAssets {
    assets: Arc<FileAssets>,
    looked: Looked,
}

/// The last scene with what it was made from besides states and ground, which say themselves whether they are the same.
struct KeptScene {
    built: Arc<BuiltScene>,
    fineness: Fineness,
    prepared: Arc<PreparedScene>,
    assets: Arc<FileAssets>,
}

impl Memory {
    /// Keeps what every build makes.
    pub fn keeping() -> Memory {
        let (meshes, states) = (assemble::Kept::keeping(), States::default());
        Memory { keeps: true, meshes, states, ..Memory::default() }
    }

    /// What the last build did.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// Files that the last build looked for, besides those of the recipe and its programs.
    pub fn looked(&self) -> Option<&Looked> {
        self.assets.as_ref().map(|kept| &kept.looked)
    }

    /// Seconds that the last derivation of each state took, and everything else that is known of it.
    pub(crate) fn states(&self) -> &States {
        &self.states
    }

    /// What of the memory is kept in files that rules read.
    pub(crate) fn kept_assets(&self) -> Option<&Arc<FileAssets>> {
        self.assets.as_ref().map(|kept| &kept.assets)
    }

    pub(super) fn begin(&mut self) {
        self.log = Log::default();
        self.began = Some(SystemTime::now());
    }

    /// Learns what the build looked at.
    pub(super) fn end(&mut self) {
        if let (Some(began), Some(kept)) = (self.began, &self.assets) {
            self.files.learn(&kept.looked.paths(), began);
        }
        // A map that was written while it was read is read again.
        if !self.site.as_ref().is_some_and(|site| site.files().all(|path| self.files.is_untouched(path))) {
            self.site = None;
        }
    }

    pub(super) fn log_mut(&mut self) -> &mut Log {
        &mut self.log
    }

    /// Runs a phase and writes down how long it took.
    pub(super) fn timed<T>(&mut self, phase: &'static str, work: impl FnOnce(&mut Memory) -> T) -> T {
        let start = Instant::now();
        let result = work(self);
        self.log.phases.push((phase, start.elapsed().as_secs_f64()));
        result
    }

    /// Files that rules may read; those of the build before with all that was read, unless a file changed.
    pub(super) fn assets(&mut self, recipe: &Recipe) -> Arc<FileAssets> {
        if !self.keeps {
            return Arc::new(recipe.assets());
        }
        let roots = recipe.assets_access().roots();
        if let Some(KeptAssets { assets, looked }) = &self.assets
            && assets.access().roots() == roots
            && self.files.changed(&looked.paths()).is_empty()
        {
            return assets.clone();
        }
        let looked = Looked::default();
        let assets = Arc::new(FileAssets::new(recipe.assets_access().noting(looked.clone())));
        self.states.ask_again(&assets, &mut self.files);
        self.assets = Some(KeptAssets { assets: assets.clone(), looked });
        assets
    }

    /// Writes down how many states were derived and how many kept.
    pub(super) fn note_derived(&mut self, derived: usize, kept: usize) {
        self.log.derived += derived;
        self.log.kept = kept;
        self.is_behind |= derived > 0;
    }

    /// The last scene, if nothing was derived and no ground laid since, and everything else is the same.
    pub(super) fn unchanged(
        &self,
        spec: &SceneSpec,
        fineness: Fineness,
        prepared: &Arc<PreparedScene>,
        assets: &Arc<FileAssets>,
    ) -> Option<Arc<BuiltScene>> {
        let kept = self.scene.as_ref()?;
        let is_same = !self.is_behind
            && kept.fineness == fineness
            && kept.built.record.name == spec.name
            && Arc::ptr_eq(&kept.prepared, prepared)
            && Arc::ptr_eq(&kept.assets, assets);
        is_same.then(|| kept.built.clone())
    }

    /// The last scene, if it is made from the very same start shapes, texts and files: there is nothing to look into.
    pub(super) fn settled(
        &mut self,
        recipe: &Recipe,
        fineness: Fineness,
        prepared: &Arc<PreparedScene>,
        assets: &Arc<FileAssets>,
    ) -> Option<Arc<BuiltScene>> {
        let name = &self.scene.as_ref()?.built.record.name;
        let spec = recipe.spec.scenes.iter().find(|scene| scene.name == *name)?;
        let built = self.unchanged(spec, fineness, prepared, assets)?;
        if !self.states.are_of(&recipe.programs) {
            return None;
        }
        self.log.kept = self.states.len();
        Some(built)
    }

    pub(super) fn keep_scene(
        &mut self,
        built: &Arc<BuiltScene>,
        fineness: Fineness,
        prepared: Arc<PreparedScene>,
        assets: Arc<FileAssets>,
    ) {
        (self.log.scene, self.is_behind) = (true, false);
        if self.keeps {
            self.scene = Some(KeptScene { built: built.clone(), fineness, prepared, assets });
        }
    }

    /// The ground; that of the build before where nothing of it changed.
    pub(super) fn ground(
        &mut self,
        area: Polygon,
        terrain: &Arc<Terrain>,
        tolerance_m: f64,
        layers: Vec<GroundLayer>,
    ) -> Result<Arc<GroundMesh>, GroundError> {
        if let Some(kept) = &self.ground
            && Arc::ptr_eq(&kept.terrain, terrain)
            && kept.tolerance_m == tolerance_m
            && kept.area == area
            && kept.layers == layers
        {
            return Ok(kept.mesh.clone());
        }
        (self.log.ground, self.is_behind) = (true, true);
        let mesh = Arc::new(build_ground(&area, terrain, tolerance_m, &layers)?);
        if self.keeps {
            let (terrain, mesh) = (terrain.clone(), mesh.clone());
            self.ground = Some(KeptGround { terrain, area, tolerance_m, layers, mesh });
        }
        Ok(mesh)
    }
}
