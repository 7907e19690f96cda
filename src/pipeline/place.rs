//! Map and elevation of one scene. In: the recipe's scene block. Out: a [`Place`]: local frame, features, terrain, area.

use std::path::PathBuf;

use glam::DVec2;

use super::error::PipelineError;
use super::progress::Progress;
use super::recipe::Recipe;
use crate::geodata::elevation;
use crate::geodata::feature::Feature;
use crate::geodata::greenery::{Greenery, greenery};
use crate::geodata::ledger::Ledger;
use crate::geodata::map::{Area, LonLatBox, extent, extract, read_map};
use crate::geodata::projection::LocalFrame;
use crate::geodata::terrain::{Terrain, Voids};
use crate::geometry::{Polygon, Ring};
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
    pub terrain: Terrain,
    pub ledger: Ledger,
}

/// Reads and projects the inputs of a scene.
pub fn place(recipe: &Recipe, scene: &SceneSpec, progress: &dyn Progress) -> Result<Place, PipelineError> {
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
    let terrain = terrain(&resolve(&scene.elevations)?, frame, &ring, &mut ledger)?;
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
