//! Encoding: a share of full scale → the nearest number of a file. What lies outside 0..1 is clipped, NaN is 0.

/// sRGB's curve (IEC 61966-2-1).
fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

/// 16 bits, linear.
pub fn word(value: f64) -> u16 {
    (value.clamp(0.0, 1.0) * 65535.0).round() as u16
}

/// 8 bits on sRGB's curve.
fn byte(value: f64) -> u8 {
    (srgb(value.clamp(0.0, 1.0)) * 255.0).round() as u8
}

/// Cells of 0..1 whose first byte is known.
const CELLS: usize = 4096;

/// [`byte`] without its power: where each byte begins.
pub struct Table {
    /// Least value of the byte that follows each byte.
    next: [f64; 256],
    /// The byte at the lower end of each cell.
    first: Vec<u8>,
}

impl Table {
    pub fn new() -> Table {
        let mut next = [f64::INFINITY; 256];
        for (at, next) in next.iter_mut().take(255).enumerate() {
            // Halving ends at neighbouring numbers, so the table is the function.
            let (mut below, mut from) = (0f64, 1f64);
            loop {
                let middle = 0.5 * (below + from);
                if middle <= below || middle >= from {
                    break;
                }
                if usize::from(byte(middle)) > at { from = middle } else { below = middle }
            }
            *next = from;
        }
        Table { next, first: (0..=CELLS).map(|cell| byte(cell as f64 / CELLS as f64)).collect() }
    }

    pub fn byte(&self, value: f64) -> u8 {
        let value = value.clamp(0.0, 1.0);
        let mut byte = self.first[(value * CELLS as f64) as usize];
        while value >= self.next[usize::from(byte)] {
            byte += 1;
        }
        byte
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_curve() {
        let table = Table::new();
        for i in 0..=1_000_000 {
            let value = f64::from(i) * 1.02e-6 - 0.01;
            assert_eq!(table.byte(value), byte(value), "{value}");
        }
        for value in table.next.into_iter().take(255) {
            assert_eq!((table.byte(value), table.byte(value.next_down())), (byte(value), byte(value.next_down())));
        }
        assert_eq!([f64::NAN, f64::INFINITY, -1.0].map(|v| table.byte(v)), [0, 255, 0]);
    }

    #[test]
    fn numbers_come_back_at_both_depths() {
        for number in 0..=255u8 {
            let encoded = f64::from(number) / 255.0;
            let linear = if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) };
            assert_eq!(byte(linear), number);
        }
        for number in 0..=u16::MAX {
            let value = f64::from(number) / 65535.0;
            let near = [value, value + 0.49 / 65535.0, value - 0.49 / 65535.0];
            assert_eq!(near.map(word), [number; 3]);
        }
        assert_eq!([f64::NAN, f64::INFINITY, -1.0].map(word), [0, 65535, 0]);
    }
}
