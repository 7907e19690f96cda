//! Map and elevation of one scene. In: the recipe's scene block. Out: a [`Site`]: local frame, features, terrain, area,
//! and the lots of the features.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use glam::DVec2;

use super::error::PipelineError;
use super::lot::{Lot, Relief, relief};
use super::memory::Memory;
use super::memory::files::Content;
use super::progress::Progress;
use super::recipe::Recipe;
use super::streets::Streets;
use crate::geodata::elevation;
use crate::geodata::feature::{Feature, Outline};
use crate::geodata::features::ribbon::{Cap, caps};
use crate::geodata::greenery::{Greenery, greenery};
use crate::geodata::ledger::Ledger;
use crate::geodata::map::{Area, LonLatBox, extent, extract, read_map};
use crate::geodata::projection::LocalFrame;
use crate::geodata::tags;
use crate::geodata::terrain::{Terrain, Voids};
use crate::geometry::{Polygon, Ring};
use crate::interpreter::host::Place as OnEarth;
use crate::source::AccessError;
use crate::spec::render_spec::{AreaSpec, FileRef, SceneSpec};

/// Everything the map and the elevation say about one scene.
pub struct Place {
    pub frame: LocalFrame,
    /// Corners of the area in the plan, counter-clockwise.
    pub area: Ring,
    pub features: Vec<Feature>,
    /// Only where the recipe asks for vegetation.
    pub greenery: Option<Greenery>,
    pub terrain: Arc<Terrain>,
    pub ledger: Ledger,
}

/// A place with what follows from it alone.
pub struct Site {
    pub place: Place,
    /// Of every feature's ribbon; only roads' are used.
    ends: Vec<[Cap; 2]>,
    /// Relief under all parts of one building together, by its id: they share one base.
    wholes: BTreeMap<Arc<str>, Relief>,
    /// Of every feature, once it was asked for.
    lots: Vec<OnceLock<Result<Arc<Lot>, String>>>,
    streets: OnceLock<Streets>,
    pub on_earth: Arc<dyn OnEarth>,
}

/// A site and what it was made from.
pub(super) struct KeptSite {
    from: SiteKey,
    site: Arc<Site>,
}

impl KeptSite {
    /// Map and elevation.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.from.maps.iter().chain(&self.from.elevations).map(|(path, _)| path.as_path())
    }
}

/// Everything of a recipe that a place depends on.
#[derive(PartialEq)]
struct SiteKey {
    maps: Vec<(PathBuf, Content)>,
    elevations: Vec<(PathBuf, Content)>,
    area: Option<AreaSpec>,
    vegetation: bool,
}

/// The scene's frame as rules see it.
#[derive(Debug)]
struct SceneFrame(LocalFrame);

impl OnEarth for SceneFrame {
    fn lon_lat(&self, x: f64, z: f64) -> Option<(f64, f64)> {
        Some(self.0.inverse(DVec2::new(x, -z)))
    }
}

impl Site {
    fn new(place: Place) -> Site {
        Site {
            ends: road_ends(&place.features),
            wholes: wholes(&place.features, &place.terrain),
            lots: place.features.iter().map(|_| OnceLock::new()).collect(),
            streets: OnceLock::new(),
            on_earth: Arc::new(SceneFrame(place.frame)),
            place,
        }
    }

    /// The lot of the feature with this number, or why it has none.
    pub fn lot(&self, number: usize) -> Result<Arc<Lot>, String> {
        let feature = &self.place.features[number];
        let whole = || self.wholes.get(feature.tags.get(tags::OUTLINE_KEY)?).copied();
        let lot = || Lot::new(feature, self.ends[number], whole(), &self.place.terrain).map(Arc::new);
        self.lots[number].get_or_init(lot).clone()
    }

    pub fn streets(&self) -> &Streets {
        self.streets.get_or_init(|| Streets::new(&self.place.features))
    }
}

/// The site of a scene; that of the build before where nothing of it changed.
pub(super) fn site(
    recipe: &Recipe,
    scene: &SceneSpec,
    memory: &mut Memory,
    progress: &dyn Progress,
) -> Result<Arc<Site>, PipelineError> {
    if !memory.keeps {
        return Ok(Arc::new(Site::new(place(recipe, scene, progress)?)));
    }
    let mut contents = |files: &[FileRef]| -> Result<Vec<(PathBuf, Content)>, PipelineError> {
        let content = |file: &FileRef| {
            let path = file.resolve(&recipe.access)?;
            Ok((path.clone(), memory.files.content(&path)))
        };
        files.iter().map(content).collect()
    };
    let (maps, elevations) = (contents(&scene.maps)?, contents(&scene.elevations)?);
    let from = SiteKey { maps, elevations, area: scene.area.clone(), vegetation: recipe.spec.wants_vegetation() };
    if let Some(kept) = memory.site.as_ref().filter(|kept| kept.from == from) {
        return Ok(kept.site.clone());
    }
    memory.log_mut().place = true;
    let site = Arc::new(Site::new(place(recipe, scene, progress)?));
    memory.site = Some(KeptSite { from, site: site.clone() });
    Ok(site)
}

/// The relief under all parts of each building that has parts.
fn wholes(features: &[Feature], terrain: &Terrain) -> BTreeMap<Arc<str>, Relief> {
    let mut wholes: BTreeMap<Arc<str>, Relief> = BTreeMap::new();
    for feature in features {
        let (Some(whole), Outline::Area(polygon)) = (feature.tags.get(tags::OUTLINE_KEY), &feature.outline) else {
            continue;
        };
        if let Some((least, greatest)) = relief(std::slice::from_ref(polygon), terrain) {
            let known = wholes.entry(whole.clone()).or_insert((least, greatest));
            *known = (known.0.min(least), known.1.max(greatest));
        }
    }
    wholes
}

/// The ends of every feature's ribbon.
fn road_ends(features: &[Feature]) -> Vec<[Cap; 2]> {
    let line = |f: &Feature| match &f.outline {
        Outline::Line(line) => line.clone(),
        Outline::Area(_) => Vec::new(),
    };
    let lines: Vec<Vec<DVec2>> = features.iter().map(line).collect();
    caps(&lines.iter().map(Vec::as_slice).collect::<Vec<_>>())
}

/// Reads and projects the inputs of a scene.
fn place(recipe: &Recipe, scene: &SceneSpec, progress: &dyn Progress) -> Result<Place, PipelineError> {
    let resolve = |files: &[FileRef]| -> Result<Vec<PathBuf>, PipelineError> {
        Ok(files.iter().map(|f| f.resolve(&recipe.access)).collect::<Result<_, _>>()?)
    };
    let mut ledger = Ledger::default();

    let maps = resolve(&scene.maps)?;
    let bytes = maps.iter().map(|path| std::fs::metadata(path).map_or(0, |m| m.len())).sum();
    progress.begin("map", Some(bytes));
    let data = read_map(&maps, &|count| progress.step(count))?;
    let area = match &scene.area {
        Some(spec) => area(spec)?,
        None => {
            let names: Vec<&str> = scene.maps.iter().map(|m| m.written.as_str()).collect();
            Area::Box(extent(&data).ok_or_else(|| PipelineError::NoExtent(names.join(", ")))?)
        }
    };
    let bounds = area.bounds().expect("an area of the recipe has corners");
    let frame = LocalFrame::new((bounds.west + bounds.east) / 2.0, (bounds.south + bounds.north) / 2.0)?;
    let project = |lon: f64, lat: f64| frame.forward(lon, lat).unwrap_or(DVec2::NAN);
    let features = extract(&data, Some(&area), &project, &mut ledger);
    let greenery = recipe.spec.wants_vegetation().then(|| greenery(&data, &features, &area, &project));
    let ring = area.ring(&project);
    drop(data);
    if features.is_empty() && ledger.entries.is_empty() {
        return Err(PipelineError::NothingInArea(scene.name.clone()));
    }
    progress.end(&format!("{} features", features.len()));

    progress.begin("elevation", None);
    let terrain = Arc::new(terrain(&resolve(&scene.elevations)?, frame, &ring, &mut ledger)?);
    progress.end(&format!("{} files", scene.elevations.len()));
    Ok(Place { frame, area: ring, features, greenery, terrain, ledger })
}

/// The ground under the scene; voids are filled, and counted in the ledger.
fn terrain(files: &[PathBuf], frame: LocalFrame, area: &Ring, ledger: &mut Ledger) -> Result<Terrain, PipelineError> {
    if files.is_empty() {
        ledger.assume("elevation: none given, flat ground");
        return Ok(Terrain::flat());
    }
    let outline = Polygon { outer: area.clone(), holes: Vec::new() };
    let (lo, hi) = outline.bounds().expect("an area has corners");
    let window = Terrain::area(&frame, lo, hi);
    let mut rasters = Vec::new();
    for path in files {
        let bytes =
            std::fs::read(path).map_err(|source| AccessError::Io { path: path.display().to_string(), source })?;
        rasters.push(elevation::read(&path.display().to_string(), &bytes, Some(window), None)?);
    }
    let terrain = Terrain::from_rasters(frame, lo, hi, rasters, Voids::Fill)?;
    let report = terrain.report();
    for (what, cells) in [
        ("elevation: voids filled from another file", report.filled_from_other_raster),
        ("elevation: voids filled from neighbours", report.filled_from_neighbours),
        ("elevation: implausible heights taken as voids", report.undeclared),
    ] {
        if cells > 0 {
            *ledger.assumptions.entry(what.to_owned()).or_default() += cells;
        }
    }
    Ok(terrain)
}

/// The recipe's area in degrees; a size in metres becomes degrees about its centre.
fn area(spec: &AreaSpec) -> Result<Area, PipelineError> {
    Ok(match spec {
        AreaSpec::BoundingBox { west, south, east, north } => {
            Area::Box(LonLatBox { west: *west, south: *south, east: *east, north: *north })
        }
        AreaSpec::Around { latitude, longitude, width, height } => {
            let frame = LocalFrame::new(*longitude, *latitude)?;
            let (x, y) = (width / 2.0, height / 2.0);
            let corners = [(-x, -y), (x, -y), (x, y), (-x, y)];
            Area::Polygon(corners.iter().map(|&(x, y)| frame.inverse(DVec2::new(x, y))).collect())
        }
        AreaSpec::Polygon(corners) => Area::Polygon(corners.iter().map(|&(lat, lon)| (lon, lat)).collect()),
    })
}
