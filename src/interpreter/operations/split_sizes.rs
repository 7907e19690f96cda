//! Where a split cuts (reference 4.3.2, 4.3.3; compatibility notes, "Split"). In: sizes with prefixes, nested and
//! repeated, and the total. Out: the slabs in order.

/// A size as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    Absolute(f64),
    /// Share of the total.
    Relative(f64),
    /// Weight of what is left.
    Floating(f64),
}

/// A block of the pattern; `body` is the caller's number of what to run in it.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    Piece { size: Size, body: usize },
    Group { blocks: Vec<Block>, repeat: bool },
}

/// One piece: from `start` to `end`, metres from the scope's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    pub body: usize,
    pub start: f64,
    pub end: f64,
}

/// The pieces of a pattern.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Resolved {
    pub slabs: Vec<Slab>,
    /// A size other than 0 that was asked for but is below [`LEAST`]: no piece is made of it.
    pub too_thin: Option<f64>,
}

/// The pattern gives more pieces than allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooMany;

/// Sizes below this are nothing (reference 4.3.1; numerics section 3, `min_size`).
pub const LEAST: f64 = 1e-6;
/// Up to this many slabs room is made at once.
const USUAL: usize = 64;
/// Ties of the repeat count go to the smaller number; ends this near to the total (as a share) are the total.
const TIE: f64 = 1e-9;

/// Fixed metres and floating weight of a stretch of pattern.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sums {
    fixed: f64,
    floating: f64,
    pieces: f64,
}

impl Sums {
    fn plus(self, other: Sums, times: f64) -> Sums {
        Sums {
            fixed: self.fixed + other.fixed * times,
            floating: self.floating + other.floating * times,
            pieces: self.pieces + other.pieces * times,
        }
    }
}

/// Lays the blocks out over `total` metres. Repeats take the count whose real sizes are nearest to the wanted ones.
pub fn resolve(blocks: &[Block], total: f64, most: usize) -> Result<Resolved, TooMany> {
    let mut layout = Layout { total, counts: vec![1.0; count_groups(blocks)], fill: None, fill_room: 0.0 };
    let depth = depth(blocks);
    for level in 0..depth {
        let groups = groups_at(blocks, level);
        if !groups.is_empty() {
            layout.choose_counts(blocks, &groups, level == 0);
        }
    }
    layout.slabs(blocks, most)
}

struct Layout {
    total: f64,
    /// Times each repeated group is laid out, numbered in source order.
    counts: Vec<f64>,
    /// Without floating sizes: the group that fills what the others leave.
    fill: Option<usize>,
    /// How much that is.
    fill_room: f64,
}

impl Layout {
    /// Metres, as written.
    fn wanted(&self, size: Size) -> f64 {
        match size {
            Size::Absolute(x) => x,
            Size::Relative(share) => share * self.total,
            Size::Floating(_) => 0.0,
        }
    }

    fn fixed(&self, size: Size) -> f64 {
        self.wanted(size).max(0.0)
    }

    fn sums(&self, blocks: &[Block], next: &mut usize) -> Sums {
        let mut sums = Sums::default();
        for block in blocks {
            match block {
                Block::Piece { size, .. } => {
                    let floating = if let Size::Floating(weight) = size { weight.max(0.0) } else { 0.0 };
                    sums = sums.plus(Sums { fixed: self.fixed(*size), floating, pieces: 1.0 }, 1.0);
                }
                Block::Group { blocks, repeat } => {
                    let number = *next;
                    *next += usize::from(*repeat);
                    let times = if *repeat { self.counts[number] } else { 1.0 };
                    sums = sums.plus(self.sums(blocks, next), times);
                }
            }
        }
        sums
    }

    fn all(&self, blocks: &[Block]) -> Sums {
        self.sums(blocks, &mut 0)
    }

    fn with_counts(&mut self, blocks: &[Block], groups: &[usize], count: f64) -> Sums {
        groups.iter().for_each(|&g| self.counts[g] = count);
        self.all(blocks)
    }

    /// |scale - 1| of floating sizes; infinite where there is no room.
    fn misfit(&self, sums: Sums) -> f64 {
        let scale = (self.total - sums.fixed) / sums.floating;
        if scale > 0.0 { (scale - 1.0).abs() } else { f64::INFINITY }
    }

    fn choose_counts(&mut self, blocks: &[Block], groups: &[usize], outermost: bool) {
        let one = self.with_counts(blocks, groups, 1.0);
        if one.floating <= 0.0 {
            if outermost {
                self.fill = groups.first().copied();
            }
            return;
        }
        let none = self.with_counts(blocks, groups, 0.0);
        let least = if outermost && none.floating > 0.0 { 0.0 } else { 1.0 };
        if let [only] = groups {
            let inner = one.plus(none, -1.0);
            self.counts[*only] = self.best_count(none, inner, least);
        } else {
            self.grow_greedily(blocks, groups, least);
        }
    }

    /// The n for which `outer + n inner` fits best; the scale falls with n, so it lies next to where the scale is 1.
    fn best_count(&self, outer: Sums, inner: Sums, least: f64) -> f64 {
        let step = inner.fixed + inner.floating;
        if step <= LEAST {
            return least;
        }
        let exact = (self.total - outer.fixed - outer.floating) / step;
        let low = exact.floor().max(least);
        let mut best = (least, self.misfit(outer.plus(inner, least)));
        for n in [low, low + 1.0] {
            let misfit = self.misfit(outer.plus(inner, n));
            if misfit < best.1 - TIE {
                best = (n, misfit);
            }
        }
        if best.1.is_infinite() { 0.0 } else { best.0 }
    }

    /// Several groups side by side: each step repeats the group that helps most; ties go to the leftmost.
    fn grow_greedily(&mut self, blocks: &[Block], groups: &[usize], least: f64) {
        const STEPS: usize = 100_000;
        let least_sums = self.with_counts(blocks, groups, least);
        let mut misfit = self.misfit(least_sums);
        for _ in 0..STEPS {
            let mut best: Option<(usize, f64)> = None;
            for &g in groups {
                self.counts[g] += 1.0;
                let grown = self.misfit(self.all(blocks));
                self.counts[g] -= 1.0;
                if grown < best.map_or(misfit, |b| b.1) - TIE {
                    best = Some((g, grown));
                }
            }
            let Some((g, grown)) = best else { return };
            self.counts[g] += 1.0;
            misfit = grown;
        }
    }

    fn slabs(&mut self, blocks: &[Block], most: usize) -> Result<Resolved, TooMany> {
        let mut sums = self.all(blocks);
        if let Some(group) = self.fill {
            self.counts[group] = 0.0;
            let none = self.all(blocks);
            let copy = sums.plus(none, -1.0).fixed;
            self.fill_room = self.total - none.fixed;
            let copies = if copy > 0.0 { ((self.fill_room - LEAST) / copy).ceil().max(0.0) } else { 0.0 };
            self.counts[group] = copies;
            sums = self.all(blocks);
        }
        if sums.pieces > most as f64 {
            return Err(TooMany);
        }
        let room = self.total - sums.fixed;
        let scale = if sums.floating > 0.0 && room > 0.0 { room / sums.floating } else { 0.0 };
        let slabs = Vec::with_capacity((sums.pieces as usize).min(USUAL));
        let out = Resolved { slabs, too_thin: None };
        let mut cursor = Cursor { total: self.total, position: 0.0, lost: 0.0, out };
        self.lay(blocks, &mut 0, scale, f64::INFINITY, &mut cursor);
        Ok(cursor.out)
    }

    /// Lays the blocks out, cut off at `end`.
    fn lay(&self, blocks: &[Block], next: &mut usize, scale: f64, end: f64, cursor: &mut Cursor) {
        for block in blocks {
            match block {
                Block::Piece { size, body } => {
                    let length = match size {
                        Size::Floating(weight) => weight.max(0.0) * scale,
                        fixed => {
                            let wanted = self.wanted(*fixed);
                            if wanted < LEAST && wanted != 0.0 {
                                cursor.out.too_thin = Some(wanted);
                            }
                            wanted.max(0.0)
                        }
                    };
                    cursor.place(*body, length.min(end - cursor.position));
                }
                Block::Group { blocks, repeat: false } => self.lay(blocks, next, scale, end, cursor),
                Block::Group { blocks, repeat: true } => {
                    let number = *next;
                    let filled = if self.fill == Some(number) { cursor.position + self.fill_room } else { end };
                    for _ in 0..self.counts[number] as usize {
                        self.lay(blocks, &mut (number + 1), scale, filled.min(end), cursor);
                    }
                    *next += 1 + count_groups(blocks);
                }
            }
        }
    }
}

/// The end of what was laid out, summed without loss of small parts (Kahan).
struct Cursor {
    total: f64,
    position: f64,
    lost: f64,
    out: Resolved,
}

impl Cursor {
    fn place(&mut self, body: usize, length: f64) {
        // What f64 resolves of a long total is below a piece of any use.
        let least = LEAST.max(TIE * self.total);
        if length < LEAST || length.is_nan() || self.position >= self.total - least {
            return;
        }
        let start = self.position;
        let corrected = length - self.lost;
        let sum = start + corrected;
        self.lost = (sum - start) - corrected;
        self.position = sum;
        let end = if sum > self.total - least { self.total } else { sum };
        self.out.slabs.push(Slab { body, start, end });
    }
}

fn count_groups(blocks: &[Block]) -> usize {
    let inside = |block: &Block| match block {
        Block::Piece { .. } => 0,
        Block::Group { blocks, repeat } => usize::from(*repeat) + count_groups(blocks),
    };
    blocks.iter().map(inside).sum()
}

/// Repeats within repeats.
fn depth(blocks: &[Block]) -> usize {
    let inside = |block: &Block| match block {
        Block::Piece { .. } => 0,
        Block::Group { blocks, repeat } => usize::from(*repeat) + depth(blocks),
    };
    blocks.iter().map(inside).max().unwrap_or(0)
}

/// Numbers of the repeated groups with this many repeated groups around them.
fn groups_at(blocks: &[Block], level: usize) -> Vec<usize> {
    fn walk(blocks: &[Block], level: usize, at: usize, next: &mut usize, out: &mut Vec<usize>) {
        for block in blocks {
            if let Block::Group { blocks, repeat } = block {
                if *repeat {
                    if at == level {
                        out.push(*next);
                    }
                    *next += 1;
                }
                walk(blocks, level, at + usize::from(*repeat), next, out);
            }
        }
    }
    let mut out = Vec::new();
    walk(blocks, level, 0, &mut 0, &mut out);
    out
}

#[cfg(test)]
mod tests;
