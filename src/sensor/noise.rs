//! Noise: a share of full scale → what the sensor counts for it. In: a value and its key. Out: the value with shot and
//! read noise.

use crate::interpreter::seed::Seed;
use crate::plan::effects::Sensor;

/// Mean counts from which the normal distribution with the Poisson distribution's skew stands for it: its quantiles
/// are then within a tenth of an electron.
const MANY: f64 = 64.0;

pub struct Noise {
    full_well: f64,
    read: f64,
}

impl Noise {
    pub fn new(sensor: &Sensor) -> Noise {
        Noise { full_well: sensor.full_well.max(0.0), read: sensor.read_noise.max(0.0) }
    }

    /// The value with its noise; not clamped.
    pub fn over(&self, value: f64, key: Seed) -> f64 {
        if self.full_well == 0.0 && self.read == 0.0 {
            return value;
        }
        let [shot, read] = normal_pair(key);
        let counted = match self.full_well * value {
            electrons if self.full_well == 0.0 || electrons <= 0.0 || electrons.is_nan() => value,
            electrons if electrons < MANY => f64::from(poisson(electrons, key.part(2).unit())) / self.full_well,
            electrons => (electrons + electrons.sqrt() * shot + (shot * shot - 1.0) / 6.0).round() / self.full_well,
        };
        counted + self.read * read
    }
}

/// Two independent standard normal numbers (Box and Muller 1958).
pub fn normal_pair(key: Seed) -> [f64; 2] {
    let radius = (-2.0 * libm::log(1.0 - key.part(0).unit())).sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * key.part(1).unit());
    [radius * cos, radius * sin]
}

/// The Poisson distribution's quantile, by adding up.
fn poisson(mean: f64, share: f64) -> u32 {
    let mut term = libm::exp(-mean);
    let (mut sum, mut count) = (term, 0);
    while sum <= share && term > 0.0 {
        count += 1;
        term *= mean / f64::from(count);
        sum += term;
    }
    count
}
