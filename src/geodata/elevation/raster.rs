//! In: decoded cells with their place on Earth. Out: heights at longitude and latitude.

use glam::DVec2;

use super::placement::Placement;

/// Heights beyond this (either sign) lie nowhere on land: an undeclared void value, metres.
pub const IMPLAUSIBLE_M: f64 = 9000.0;

/// A grid of heights in metres with its place on Earth.
#[derive(Debug)]
pub struct Raster {
    name: String,
    placement: Placement,
    /// Row by row; NaN is a void. An f32 holds heights on Earth to 0.5 mm.
    heights: Vec<f32>,
    implausible: usize,
}

impl Raster {
    /// Takes one height per cell, NaN for voids; implausible heights become voids and are counted.
    pub(super) fn new(name: &str, placement: Placement, mut heights: Vec<f32>) -> Self {
        assert_eq!(heights.len(), placement.width * placement.height, "one height per cell");
        let mut implausible = 0;
        for h in &mut heights {
            if f64::from(h.abs()) > IMPLAUSIBLE_M {
                *h = f32::NAN;
                implausible += 1;
            }
        }
        Raster { name: name.to_owned(), placement, heights, implausible }
    }

    /// The file it was read from.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Columns and rows held (of the window that was asked for); zero if that lies outside the file.
    pub fn size(&self) -> (usize, usize) {
        (self.placement.width, self.placement.height)
    }

    /// Definition of the coordinate reference system.
    pub fn crs(&self) -> &str {
        self.placement.crs.definition()
    }

    /// Number of cells without a height.
    pub fn voids(&self) -> usize {
        self.heights.iter().filter(|h| h.is_nan()).count()
    }

    /// Number of voids that the file did not declare: heights beyond [`IMPLAUSIBLE_M`].
    pub fn implausible(&self) -> usize {
        self.implausible
    }

    /// Bilinear height between cell centres, metres. Void corners are dropped and the other weights renormalised;
    /// `None` outside the cells or where all four corners are void.
    pub fn sample(&self, lon: f64, lat: f64) -> Option<f64> {
        let (sum, weight) = self.weighted(self.placement.cell_at(lon, lat)?);
        (weight > 0.0).then(|| sum / weight)
    }

    /// Height of the cell that holds a place, metres; `None` outside and in voids.
    pub fn cell(&self, lon: f64, lat: f64) -> Option<f64> {
        let c = self.placement.cell_at(lon, lat)?;
        let last = DVec2::new(self.placement.width as f64, self.placement.height as f64) - 1.0;
        self.height_of(c.floor().min(last))
    }

    /// Sums of weight times height and of weights over the valid ones of the four cells around cell coordinates.
    /// The weights sum to 1 inside; beyond the outermost cell centres and near voids to less.
    pub(crate) fn weighted(&self, cell: DVec2) -> (f64, f64) {
        let base = (cell - 0.5).floor();
        let f = cell - 0.5 - base;
        let (mut sum, mut total) = (0.0, 0.0);
        for corner in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
            let w = (1.0 - (f.x - corner.x).abs()) * (1.0 - (f.y - corner.y).abs());
            if let Some(h) = self.height_of(base + corner).filter(|_| w > 0.0) {
                sum += w * h;
                total += w;
            }
        }
        (sum, total)
    }

    /// Height of the cell with this column and row.
    fn height_of(&self, cell: DVec2) -> Option<f64> {
        let (w, h) = (self.placement.width, self.placement.height);
        if !(cell.x >= 0.0 && cell.y >= 0.0 && cell.x < w as f64 && cell.y < h as f64) {
            return None;
        }
        let value = self.heights[cell.y as usize * w + cell.x as usize];
        (!value.is_nan()).then_some(f64::from(value))
    }

    pub(crate) fn placement(&self) -> &Placement {
        &self.placement
    }

    /// Index and place of every void cell.
    pub(crate) fn void_places(&self) -> Vec<(usize, (f64, f64))> {
        let voids = self.heights.iter().enumerate().filter(|(_, h)| h.is_nan()).map(|(i, _)| i);
        let centre =
            |i: usize| DVec2::new((i % self.placement.width) as f64 + 0.5, (i / self.placement.width) as f64 + 0.5);
        voids.filter_map(|i| Some((i, self.placement.place_of(centre(i))?))).collect()
    }

    pub(crate) fn heights_mut(&mut self) -> &mut [f32] {
        &mut self.heights
    }

    /// Heights by cell in a reference system, north row first.
    #[cfg(test)]
    pub(crate) fn of_cells(crs: &str, crs_from_cell: glam::DAffine2, width: usize, heights: Vec<f32>) -> Self {
        let crs = super::crs::Crs::parse(crs).expect("a known system");
        let height = heights.len() / width;
        let placement = Placement::new(crs, crs_from_cell, width, height).expect("a transform with an inverse");
        Raster::new("cells", placement, heights)
    }

    /// A copy of some of the cells.
    #[cfg(test)]
    pub(crate) fn cropped(&self, column: usize, row: usize, width: usize, height: usize) -> Self {
        let window = super::placement::Window { column, row, width, height };
        let crs = super::crs::Crs::parse(self.crs()).expect("parsed before");
        let (w, h) = self.size();
        let placement = Placement::new(crs, self.placement.crs_from_cell, w, h).expect("placed before");
        let rows = self.heights.chunks(w).skip(row).take(height);
        let heights = rows.flat_map(|r| r[column..column + width].to_vec()).collect();
        Raster::new(&self.name, placement.cropped(window), heights)
    }
}
