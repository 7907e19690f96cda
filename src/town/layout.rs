//! The plan of the town: a grid of blocks between streets, bent by a smooth warp, with one river through it.
//!
//! In: seed and size. Out: what every block is, where the streets run, and the warp from grid to ground.

use glam::DVec2;
use std::f64::consts::TAU;

use crate::interpreter::seed::Seed;

/// Block pitch in metres, street centre to street centre.
pub const BLOCK: DVec2 = DVec2::new(150.0, 92.0);
/// Half the width of the river, metres.
pub const RIVER_HALF: f64 = 12.0;

/// What stands on a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    Houses,
    Courtyard,
    Industry,
    School,
    Park,
    River,
    Field,
}

/// The class of a street, as OSM's `highway` value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Street {
    Secondary,
    Tertiary,
    Residential,
}

impl Street {
    pub fn tag(self) -> &'static str {
        match self {
            Street::Secondary => "secondary",
            Street::Tertiary => "tertiary",
            Street::Residential => "residential",
        }
    }
}

/// The plan; blocks are numbered row by row from the south-west.
#[derive(Clone, Debug)]
pub struct Town {
    pub seed: Seed,
    pub buildings: u32,
    pub columns: u32,
    pub rows: u32,
    /// The row of blocks that the river flows through.
    pub river_row: u32,
}

impl Town {
    pub fn new(seed: u64, buildings: u32) -> Self {
        let blocks = (buildings as f64 / 7.5).ceil().max(12.0);
        let columns = ((blocks * 0.62).sqrt().ceil() as u32).max(4);
        let rows = (blocks / columns as f64).ceil() as u32 + 2;
        Town { seed: Seed::root(seed).named("town"), buildings, columns, rows, river_row: rows / 3 }
    }

    /// Blocks in the order in which they are built: from the centre outwards, ties by number.
    pub fn blocks(&self) -> Vec<(u32, u32)> {
        let centre = DVec2::new(self.columns as f64 - 1.0, self.rows as f64 - 1.0) / 2.0;
        let mut all: Vec<(u32, u32)> = (0..self.rows).flat_map(|r| (0..self.columns).map(move |c| (c, r))).collect();
        all.sort_by(|a, b| {
            let far = |&(c, r): &(u32, u32)| ((DVec2::new(c as f64, r as f64) - centre) * BLOCK).length_squared();
            far(a).total_cmp(&far(b)).then((a.1, a.0).cmp(&(b.1, b.0)))
        });
        all
    }

    /// What a block is used for while buildings are still wanted.
    pub fn block_use(&self, column: u32, row: u32) -> Use {
        let (mid_column, mid_row) = (self.columns / 2, self.rows / 2);
        if row == self.river_row {
            return Use::River;
        }
        if (column, row) == (mid_column, mid_row) {
            return Use::Courtyard;
        }
        if (column + 1, row) == (mid_column, mid_row) {
            return Use::Park;
        }
        let draw = self.seed.named("use").part(self.block_number(column, row)).unit();
        if column * 4 >= self.columns * 3 && row < self.river_row.max(2) {
            return Use::Industry;
        }
        match draw {
            d if d < 0.05 => Use::Park,
            d if d < 0.10 => Use::Courtyard,
            d if d < 0.13 => Use::School,
            d if d < 0.17 => Use::Industry,
            _ => Use::Houses,
        }
    }

    pub fn block_number(&self, column: u32, row: u32) -> u64 {
        u64::from(row) * u64::from(self.columns) + u64::from(column)
    }

    /// South-west corner of a block in grid metres, about the centre of the town.
    pub fn corner(&self, column: u32, row: u32) -> DVec2 {
        (DVec2::new(column as f64, row as f64) - DVec2::new(self.columns as f64, self.rows as f64) / 2.0) * BLOCK
    }

    /// Half the size of the built grid, metres.
    pub fn half_size(&self) -> DVec2 {
        DVec2::new(self.columns as f64, self.rows as f64) * BLOCK / 2.0
    }

    /// The class of the street that runs north along the west side of a column.
    pub fn column_street(&self, column: u32) -> Street {
        if column == self.columns / 2 + 1 {
            Street::Secondary
        } else if column % 4 == 1 {
            Street::Tertiary
        } else {
            Street::Residential
        }
    }

    /// The class of the street that runs east along the south side of a row.
    pub fn row_street(&self, row: u32) -> Street {
        if row == self.rows / 2 + 1 {
            Street::Secondary
        } else if row.is_multiple_of(4) {
            Street::Tertiary
        } else {
            Street::Residential
        }
    }

    /// Ground position of a grid point: streets bend by up to 14 m over some 600 m.
    pub fn warp(&self, p: DVec2) -> DVec2 {
        let (phase_x, phase_y) = (self.phase("warp x"), self.phase("warp y"));
        p + DVec2::new(12.0 * libm::sin(p.y / 610.0 * TAU + phase_x), 14.0 * libm::sin(p.x / 730.0 * TAU + phase_y))
    }

    /// Grid point of a ground position: the warp inverted by fixed-point iteration (its slope is below 0.13, so
    /// twelve rounds leave less than a micrometre).
    pub fn unwarp(&self, ground: DVec2) -> DVec2 {
        (0..12).fold(ground, |p, _| ground - (self.warp(p) - p))
    }

    /// Direction of the streets running east at a grid point, radians from east.
    pub fn angle(&self, p: DVec2) -> f64 {
        let ahead = self.warp(p + DVec2::new(1.0, 0.0)) - self.warp(p);
        libm::atan2(ahead.y, ahead.x)
    }

    /// Grid y of the river's middle at a grid x.
    pub fn river(&self, x: f64) -> f64 {
        self.corner(0, self.river_row).y + BLOCK.y / 2.0 + 16.0 * libm::sin(x / 420.0 * TAU + self.phase("river"))
    }

    /// Ground level in metres at a grid point: a hill in the north-west, a gentle fall to the south, the river's bed.
    pub fn level(&self, p: DVec2) -> f64 {
        let half = self.half_size();
        let hill = p - DVec2::new(-0.55 * half.x, 0.62 * half.y);
        let radius = 0.75 * half.min_element();
        let up = 30.0 * libm::exp(-hill.length_squared() / (radius * radius));
        let roll = 1.5 * libm::sin(p.x / 260.0 + 1.0) * libm::sin(p.y / 310.0);
        let bank = ((p.y - self.river(p.x)).abs() - RIVER_HALF - 4.0) / 30.0;
        let cut = if bank <= 0.0 { 0.0 } else { bank.min(1.0) };
        let river_level = 20.0;
        let land = 26.0 + 0.008 * (p.y - self.river(p.x)).abs().min(1500.0) + up + roll;
        river_level + (land - river_level) * cut * cut * (3.0 - 2.0 * cut)
    }

    fn phase(&self, name: &str) -> f64 {
        self.seed.named(name).unit() * TAU
    }
}
