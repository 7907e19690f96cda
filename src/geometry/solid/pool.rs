//! Vertices of both meshes and of their intersections. In: positions. Out: numbers; positions within the tolerance of
//! an earlier one get its number.

use std::collections::BTreeMap;

use glam::DVec3;

pub struct Pool {
    pub positions: Vec<DVec3>,
    cells: BTreeMap<[i64; 3], Vec<u32>>,
    pub tolerance: f64,
}

impl Pool {
    pub fn new(tolerance: f64) -> Pool {
        Pool { positions: Vec::new(), cells: BTreeMap::new(), tolerance: tolerance.max(f64::MIN_POSITIVE) }
    }

    fn cell(&self, p: DVec3) -> [i64; 3] {
        // Saturates far out, where everything falls into one cell and is still compared by distance.
        (p / (2.0 * self.tolerance)).floor().as_i64vec3().to_array()
    }

    /// The nearest vertex within the tolerance, or a new one.
    pub fn place(&mut self, p: DVec3) -> u32 {
        let [x, y, z] = self.cell(p);
        let mut best: Option<(f64, u32)> = None;
        for key in (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [i, j, k]))) {
            let key = [x.saturating_add(key[0]), y.saturating_add(key[1]), z.saturating_add(key[2])];
            for &v in self.cells.get(&key).into_iter().flatten() {
                let candidate = (self.positions[v as usize].distance(p), v);
                if candidate.0 <= self.tolerance && best.is_none_or(|b| candidate < b) {
                    best = Some(candidate);
                }
            }
        }
        if let Some((_, v)) = best {
            return v;
        }
        let v = self.positions.len() as u32;
        self.positions.push(p);
        self.cells.entry([x, y, z]).or_default().push(v);
        v
    }
}
