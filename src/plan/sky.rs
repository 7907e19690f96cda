//! Sky: how many directions → which, spread over the hemisphere with the cosine to the zenith.

use glam::DVec3;

/// Radians between neighbours of a sunflower spiral.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
/// Least directions that one sample of a pixel looks into: fewer tell little about a wall.
const LEAST_PER_SAMPLE: u32 = 6;
/// Texels of all maps together: 256 MB.
const MOST_TEXELS: u32 = 1 << 26;

/// Into how many sets the directions are dealt out over the `side × side` samples of a pixel.
pub fn subsets(count: u32, side: u32) -> u32 {
    let samples = side * side;
    (1..=samples).rev().find(|m| samples.is_multiple_of(*m) && count / m >= LEAST_PER_SAMPLE).unwrap_or(1)
}

/// `count` unit vectors above the horizon; every `subsets`-th, from any on, is a spiral of equal shares of the disc
/// under the hemisphere (Vogel 1979; Malley's projection), and so are nearly all of them together.
pub fn directions(count: u32, subsets: u32) -> Vec<DVec3> {
    let direction = |i: u32| {
        let (turn, start) = (f64::from(i / subsets), f64::from(i % subsets) / f64::from(subsets));
        let angle = turn * GOLDEN_ANGLE + start * std::f64::consts::TAU;
        let share = (f64::from(i) + 0.5) / f64::from(count);
        let (sin, cos) = libm::sincos(angle);
        DVec3::new(share.sqrt() * cos, (1.0 - share).sqrt(), share.sqrt() * sin)
    };
    (0..count).map(direction).collect()
}

/// Texels per side of one of `count` maps beside a shadow map of `shadow_map`.
pub fn map_size(shadow_map: u32, count: u32) -> u32 {
    let affordable = f64::from(MOST_TEXELS / count.max(1)).sqrt() as u32;
    (shadow_map / 4).min(affordable).max(256)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share of a uniform sky that a surface of this normal sees, by the sum that the shader makes.
    fn irradiance(normal: DVec3, directions: impl Iterator<Item = DVec3>) -> f64 {
        let (sum, count) = directions.fold((0.0, 0), |(s, n), d| (s + normal.dot(d).max(0.0) / d.y, n + 1));
        sum / f64::from(count)
    }

    #[test]
    fn directions_integrate_the_cosine() {
        for (count, side) in [(8, 1), (24, 2), (64, 4), (256, 2)] {
            let subsets = subsets(count, side);
            let all = directions(count, subsets);
            assert!(all.iter().all(|d| (d.length() - 1.0).abs() < 1e-12 && d.y > 0.0));
            assert!((irradiance(DVec3::Y, all.iter().copied()) - 1.0).abs() < 1e-12);
            // A slope of 60° sees three quarters of the sky.
            for azimuth in 0..12 {
                let (sin, cos) = libm::sincos(f64::from(30 * azimuth).to_radians());
                let slope = DVec3::new(0.75f64.sqrt() * cos, 0.5, 0.75f64.sqrt() * sin);
                let error = irradiance(slope, all.iter().copied()) - 0.75;
                assert!(error.abs() < 1.0 / f64::from(count).sqrt(), "{count} directions: {error}");
            }
        }
    }

    #[test]
    fn sets_are_as_many_as_leave_enough_in_each() {
        assert_eq!([subsets(24, 2), subsets(8, 2), subsets(64, 4), subsets(4, 1), subsets(20, 3)], [4, 1, 8, 1, 3]);
        assert_eq!([map_size(4096, 24), map_size(8192, 64), map_size(512, 8)], [1024, 1024, 256]);
    }
}
