//! In: elevation rasters and the scene's frame. Out: [`Terrain`], heights anywhere in the plan.
//!
//! The surface is bilinear between the rasters' cell centres. Where rasters overlap the first that has a height wins;
//! in the half cell beyond a raster's outermost centres it is joined with its neighbour by the weights, so that
//! adjacent tiles have no step between them.

mod cell_map;
mod fill;
#[cfg(test)]
mod tests;

use glam::DVec2;

use super::elevation::{LonLatBox, Raster};
use super::projection::LocalFrame;
use crate::geometry::Polygon;
use cell_map::CellMap;

/// What becomes of places inside a raster that have no height.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Voids {
    /// They take the height of the next raster that has one there, else a membrane hung from the void's border.
    #[default]
    Fill,
    /// They stay open: [`Terrain::height`] is `None` there.
    Open,
}

/// Why rasters make no terrain.
#[derive(Debug, thiserror::Error)]
pub enum TerrainError {
    #[error("none of the elevation files covers the scene: {0}")]
    NoCover(String),
}

/// What was done to the rasters, in cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct TerrainReport {
    /// Voids that were filled from another raster.
    pub filled_from_other_raster: usize,
    /// Voids that were filled from the heights around them.
    pub filled_from_neighbours: usize,
    /// Voids left.
    pub open: usize,
    /// Voids that no file declared: heights beyond 9,000 m.
    pub undeclared: usize,
}

/// The height of the ground over the plan, metres above the rasters' datum.
#[derive(Debug, Default)]
pub struct Terrain {
    frame: Option<LocalFrame>,
    sheets: Vec<Sheet>,
    report: TerrainReport,
}

#[derive(Debug)]
struct Sheet {
    raster: Raster,
    map: CellMap,
    /// Least distance of neighbouring cell centres, metres.
    spacing: f64,
}

impl Terrain {
    /// Level ground at height 0 everywhere: no elevation was given.
    pub fn flat() -> Self {
        Terrain::default()
    }

    /// Takes rasters in order of preference; `lo` and `hi` are the corners of the scene in the plan.
    pub fn from_rasters(
        frame: LocalFrame,
        lo: DVec2,
        hi: DVec2,
        rasters: Vec<Raster>,
        voids: Voids,
    ) -> Result<Self, TerrainError> {
        let names: Vec<String> = rasters.iter().map(|r| r.name().to_owned()).collect();
        let mut rasters: Vec<Raster> = rasters.into_iter().filter(|r| r.voids() < r.size().0 * r.size().1).collect();
        let mut report =
            TerrainReport { undeclared: rasters.iter().map(Raster::implausible).sum(), ..Default::default() };
        if voids == Voids::Fill {
            fill_from_others(&mut rasters, &mut report);
            for raster in &mut rasters {
                let width = raster.size().0;
                report.filled_from_neighbours += fill::fill_voids(raster.heights_mut(), width);
            }
        }
        report.open = rasters.iter().map(Raster::voids).sum();
        let sheets = rasters.into_iter().map(|raster| Sheet::new(raster, &frame, lo, hi)).collect();
        let terrain = Terrain { frame: Some(frame), sheets, report };
        let covered = (0..25).any(|i| {
            let f = DVec2::new(f64::from(i % 5), f64::from(i / 5)) / 4.0;
            terrain.height(lo + (hi - lo) * f).is_some()
        });
        if covered { Ok(terrain) } else { Err(TerrainError::NoCover(names.join(", "))) }
    }

    /// The box in degrees that holds a rectangle of the plan: what to decode of large rasters.
    pub fn area(frame: &LocalFrame, lo: DVec2, hi: DVec2) -> LonLatBox {
        let middle = frame.centre().0;
        let mut area = LonLatBox { west: f64::MAX, south: f64::MAX, east: f64::MIN, north: f64::MIN };
        for i in 0..25 {
            let f = DVec2::new(f64::from(i % 5), f64::from(i / 5)) / 4.0;
            let (lon, lat) = frame.inverse(lo + (hi - lo) * f);
            let lon = middle + super::projection::reduce_longitude(lon - middle);
            area.west = area.west.min(lon);
            area.east = area.east.max(lon);
            area.south = area.south.min(lat);
            area.north = area.north.max(lat);
        }
        area
    }

    pub fn is_flat(&self) -> bool {
        self.sheets.is_empty()
    }

    pub fn report(&self) -> TerrainReport {
        self.report
    }

    /// Least distance of neighbouring heights in the files, metres; `None` for flat ground.
    pub fn spacing(&self) -> Option<f64> {
        self.sheets.iter().map(|s| s.spacing).min_by(f64::total_cmp)
    }

    /// Height of the ground at a plan point, metres; `None` where no raster covers it and in voids left open.
    pub fn height(&self, plan: DVec2) -> Option<f64> {
        let Some(frame) = &self.frame else { return Some(0.0) };
        let (mut sum, mut total, mut covered) = (0.0, 0.0, false);
        for sheet in &self.sheets {
            let Some(cell) = sheet.cell(frame, plan) else { continue };
            let (part, weight) = sheet.raster.weighted(cell);
            if weight <= 0.0 {
                continue;
            }
            let share = ((1.0 - total) / weight).min(1.0);
            sum += part * share;
            total += weight * share;
            covered |= sheet.covers(cell);
            if total > 1.0 - 1e-9 {
                break;
            }
        }
        (covered && total > 0.0).then(|| sum / total)
    }

    /// Plan positions of the files' heights (cell centres) inside a rectangle, in a fixed order. Those of a raster
    /// that an earlier one covers are left out.
    pub fn posts(&self, lo: DVec2, hi: DVec2) -> Vec<DVec2> {
        let Some(frame) = &self.frame else { return Vec::new() };
        let mut posts = Vec::new();
        for (index, sheet) in self.sheets.iter().enumerate() {
            for post in sheet.posts(frame, lo, hi) {
                let hidden =
                    self.sheets[..index].iter().any(|s| s.cell(frame, post).is_some_and(|cell| s.covers(cell)));
                if !hidden {
                    posts.push(post);
                }
            }
        }
        posts
    }

    /// Where the ground along a line can bend: the parameters in (0, 1), ascending, at which the line from `a` to `b`
    /// passes from one bilinear patch to the next, and the middles between them.
    pub fn bends(&self, a: DVec2, b: DVec2) -> Vec<f64> {
        let Some(frame) = &self.frame else { return Vec::new() };
        let mut crossings = vec![0.0, 1.0];
        for sheet in &self.sheets {
            let (Some(from), Some(to)) = (sheet.cell(frame, a), sheet.cell(frame, b)) else { continue };
            for (s, e, cells) in [(from.x, to.x, sheet.raster.size().0), (from.y, to.y, sheet.raster.size().1)] {
                let clamp = |v: f64| v.clamp(0.0, cells as f64);
                let lines = (clamp(s.min(e)) - 0.5).ceil() as usize..(clamp(s.max(e)) + 0.5).floor() as usize;
                crossings.extend(lines.map(|line| (line as f64 + 0.5 - s) / (e - s)).filter(|t| *t > 0.0 && *t < 1.0));
            }
        }
        crossings.sort_unstable_by(f64::total_cmp);
        let mut bends: Vec<f64> = crossings.windows(2).flat_map(|w| [w[0], (w[0] + w[1]) / 2.0]).skip(1).collect();
        bends.dedup();
        bends
    }

    /// Least and greatest height under an outline: along its rings wherever the ground can bend, and at the files' own
    /// heights inside. `None` if the ground has no height at any of these.
    pub fn extremes_under(&self, outline: &Polygon) -> Option<(f64, f64)> {
        if self.is_flat() {
            return Some((0.0, 0.0));
        }
        let mut extremes: Option<(f64, f64)> = None;
        let mut take = |p: DVec2| {
            if let Some(h) = self.height(p) {
                let (least, greatest) = extremes.unwrap_or((h, h));
                extremes = Some((least.min(h), greatest.max(h)));
            }
        };
        for ring in outline.rings() {
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                take(a);
                self.bends(a, b).into_iter().for_each(|t| take(a.lerp(b, t)));
            }
        }
        let (lo, hi) = outline.bounds()?;
        self.posts(lo, hi).into_iter().filter(|&p| outline.contains(p)).for_each(take);
        extremes
    }
}

impl Sheet {
    fn new(raster: Raster, frame: &LocalFrame, lo: DVec2, hi: DVec2) -> Self {
        let map = CellMap::new(raster.placement(), frame, lo, hi);
        let mut sheet = Sheet { raster, map, spacing: f64::MAX };
        let middle = sheet.cell(frame, (lo + hi) / 2.0).unwrap_or(DVec2::ZERO);
        let origin = sheet.plan(frame, middle);
        for neighbour in [DVec2::X, DVec2::Y] {
            if let (Some(a), Some(b)) = (origin, sheet.plan(frame, middle + neighbour)) {
                sheet.spacing = sheet.spacing.min(a.distance(b));
            }
        }
        sheet
    }

    fn cell(&self, frame: &LocalFrame, plan: DVec2) -> Option<DVec2> {
        self.map.get(plan).or_else(|| cell_map::exact(self.raster.placement(), frame, plan))
    }

    fn plan(&self, frame: &LocalFrame, cell: DVec2) -> Option<DVec2> {
        let (lon, lat) = self.raster.placement().place_of(cell)?;
        frame.forward(lon, lat).ok()
    }

    fn covers(&self, cell: DVec2) -> bool {
        let (w, h) = self.raster.size();
        (0.0..=w as f64).contains(&cell.x) && (0.0..=h as f64).contains(&cell.y)
    }

    /// Plan positions of the cell centres with a height inside a rectangle, row by row.
    fn posts(&self, frame: &LocalFrame, lo: DVec2, hi: DVec2) -> Vec<DVec2> {
        let (w, h) = self.raster.size();
        let corners = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y), (lo + hi) / 2.0];
        let cells: Vec<DVec2> = corners.into_iter().filter_map(|p| self.cell(frame, p)).collect();
        let Some(&first) = cells.first() else { return Vec::new() };
        let (least, greatest) = cells.iter().fold((first, first), |(a, b), &c| (a.min(c), b.max(c)));
        let clamp = |v: f64, n: usize| v.clamp(0.0, n as f64) as usize;
        let mut posts = Vec::new();
        for row in clamp(least.y.floor() - 1.0, h)..clamp(greatest.y.ceil() + 1.0, h) {
            for column in clamp(least.x.floor() - 1.0, w)..clamp(greatest.x.ceil() + 1.0, w) {
                let centre = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                if self.raster.weighted(centre).1 < 1.0 {
                    continue;
                }
                posts.extend(self.plan(frame, centre).filter(|p| p.cmpge(lo).all() && p.cmple(hi).all()));
            }
        }
        posts
    }
}

/// Gives voids the height of the first other raster that has one there.
fn fill_from_others(rasters: &mut [Raster], report: &mut TerrainReport) {
    if rasters.len() < 2 {
        return;
    }
    let found: Vec<Vec<(usize, f32)>> = (0..rasters.len())
        .map(|i| {
            let others = || rasters.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, r)| r);
            let places = rasters[i].void_places();
            let height = |(lon, lat): (f64, f64)| others().find_map(|r| r.sample(lon, lat));
            places.into_iter().filter_map(|(cell, place)| Some((cell, height(place)? as f32))).collect()
        })
        .collect();
    for (raster, found) in rasters.iter_mut().zip(found) {
        report.filled_from_other_raster += found.len();
        for (cell, height) in found {
            raster.heights_mut()[cell] = height;
        }
    }
}
