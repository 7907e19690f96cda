//! Lists of numbers by cells of a square grid. In: convex shapes with the number of what they belong to. Out: what was
//! entered near a place or a shape.

/// The end of a list.
const END: u32 = u32::MAX;

/// Shapes in more cells than this go to one list of large ones.
const MOST: usize = 1024;

/// A rectangle of square cells; what lies outside counts to its rim.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Frame {
    low: [f64; 2],
    per_step: f64,
    count: [usize; 2],
}

/// The cells that a shape touches, or that there are too many.
#[derive(Debug, Default)]
pub(super) struct Cover {
    pub cells: Vec<u32>,
    pub large: bool,
}

/// Numbers by cell.
#[derive(Debug, Default)]
pub(super) struct Lists {
    heads: Vec<u32>,
    /// Number and next entry.
    entries: Vec<(u32, u32)>,
    pub large: Vec<u32>,
}

/// A point and by how much it may be off, in grid steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub at: [f64; 2],
    pub pad: f64,
}

impl Frame {
    /// About `cells` square cells over a box.
    pub fn over(low: [f64; 2], high: [f64; 2], cells: usize) -> Frame {
        let size = [high[0] - low[0], high[1] - low[1]];
        let longest = size[0].max(size[1]);
        let side = (size[0] * size[1] / cells as f64).sqrt().max(longest / cells as f64).max(1.0);
        Frame { low, per_step: 1.0 / side, count: size.map(|s| (s / side) as usize + 1) }
    }

    pub fn side(&self) -> f64 {
        1.0 / self.per_step
    }

    pub fn cells(&self) -> usize {
        self.count[0] * self.count[1]
    }

    fn column(&self, axis: usize, value: f64) -> usize {
        (((value - self.low[axis]) * self.per_step).max(0.0) as usize).min(self.count[axis] - 1)
    }

    /// The cell of a point.
    pub fn cell(&self, at: [f64; 2]) -> usize {
        self.column(1, at[1]) * self.count[0] + self.column(0, at[0])
    }

    /// The cells that the convex hull of the spots touches.
    pub fn cover(&self, spots: &[Spot], cover: &mut Cover) {
        cover.cells.clear();
        cover.large = true;
        let pad = spots.iter().fold(0.0, |m, s| f64::max(m, s.pad));
        let reach = |sign: f64| spots.iter().map(move |s| sign * s.at[1]).fold(f64::NEG_INFINITY, f64::max);
        let (low, high) = (-reach(-1.0) - pad, reach(1.0) + pad);
        if !(low.is_finite() && high.is_finite() && spots.iter().all(|s| s.at[0].is_finite())) {
            return;
        }
        for row in self.column(1, low)..=self.column(1, high) {
            let (first, last) = self.row(spots, row, pad);
            if cover.cells.len() + last - first >= MOST {
                return;
            }
            cover.cells.extend((first..=last).map(|column| (row * self.count[0] + column) as u32));
        }
        cover.large = false;
    }

    /// First and last column of a hull in a row.
    fn row(&self, spots: &[Spot], row: usize, pad: f64) -> (usize, usize) {
        // The rows at the rim reach as far as there is anything.
        let bottom = if row == 0 { f64::NEG_INFINITY } else { self.low[1] + row as f64 * self.side() - pad };
        let top =
            if row + 1 == self.count[1] { f64::INFINITY } else { self.low[1] + (row + 1) as f64 * self.side() + pad };
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut take = |x: f64| (least, most) = (least.min(x), most.max(x));
        for (k, p) in spots.iter().enumerate() {
            let [px, py] = p.at;
            if py >= bottom && py <= top {
                take(px);
            }
            for q in &spots[k + 1..] {
                let [qx, qy] = q.at;
                for border in [bottom, top] {
                    if (py < border) != (qy < border) && border.is_finite() {
                        take(px + (border - py) / (qy - py) * (qx - px));
                    }
                }
            }
        }
        // Crossings of borders carry a rounding relative to the length of what crosses.
        let pad = pad + (most - least).abs().min(1e30) * 1e-9;
        (self.column(0, least - pad), self.column(0, most + pad))
    }
}

impl Lists {
    /// Empty lists for so many cells.
    pub fn clear(&mut self, cells: usize) {
        self.heads.clear();
        self.heads.resize(cells, END);
        self.entries.clear();
        self.large.clear();
    }

    pub fn enter(&mut self, cover: &Cover, number: u32) {
        if cover.large {
            self.large.push(number);
            return;
        }
        for &cell in &cover.cells {
            let head = &mut self.heads[cell as usize];
            self.entries.push((number, *head));
            *head = (self.entries.len() - 1) as u32;
        }
    }

    /// What is in a cell, the large ones not included.
    pub fn in_cell(&self, cell: usize) -> impl Iterator<Item = u32> {
        let mut at = self.heads[cell];
        std::iter::from_fn(move || {
            let &(number, next) = self.entries.get(at as usize)?;
            at = next;
            Some(number)
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Every point between the spots is in one of the cells, also outside of the frame.
        #[test]
        fn covers_the_hull(
            corners in prop::collection::vec(prop::array::uniform2(-2e3..2e3f64), 2..5),
            (size, cells) in (prop::array::uniform2(1.0..1e3f64), 1usize..400),
            shares in prop::collection::vec(prop::array::uniform4(0.0..1.0f64), 50),
        ) {
            let frame = Frame::over([-100.0, -50.0], [size[0] - 100.0, size[1] - 50.0], cells);
            let spots: Vec<Spot> = corners.iter().map(|&at| Spot { at, pad: 1e-6 }).collect();
            let mut cover = Cover::default();
            frame.cover(&spots, &mut cover);
            prop_assume!(!cover.large);
            for share in shares {
                let total: f64 = share[..spots.len()].iter().sum();
                let mean = |axis: usize| -> f64 { (0..spots.len()).map(|k| corners[k][axis] * share[k] / total).sum() };
                let cell = frame.cell([mean(0), mean(1)]) as u32;
                prop_assert!(cover.cells.contains(&cell));
            }
        }

        /// The number of cells is about the one asked for.
        #[test]
        fn frames_have_about_the_cells_wanted(size in prop::array::uniform2(1.0..1e8f64), cells in 1usize..20_000) {
            let frame = Frame::over([0.0, 0.0], size, cells);
            prop_assert!(frame.cells() <= 4 * cells + 4, "{} for {cells}", frame.cells());
        }
    }

    #[test]
    fn lists_give_back_what_was_entered() {
        let mut lists = Lists::default();
        lists.clear(4);
        lists.enter(&Cover { cells: vec![1, 3], large: false }, 7);
        lists.enter(&Cover { cells: vec![3], large: false }, 8);
        lists.enter(&Cover { cells: vec![0], large: true }, 9);
        let cell = |k: usize| lists.in_cell(k).collect::<Vec<u32>>();
        assert_eq!((cell(0), cell(1), cell(3)), (vec![], vec![7], vec![8, 7]));
        assert_eq!(lists.large, [9]);
    }
}
