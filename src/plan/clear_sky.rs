//! In: the height of the sun and the turbidity of the air. Out: what the sun and a cloudless sky shine in red, green,
//! blue and near infrared.
//!
//! The simple spectral model of Bird and Riordan (1986, J. Climate Appl. Meteor. 25, 87-97; SPCTRL2) at one wavelength
//! per band, at sea level: Rayleigh scattering, aerosols (Ångström 1961), ozone, water vapour, light that ground and sky
//! pass to and fro; air mass by Kasten and Young (1989); the optical depth of aerosols from Linke's turbidity by
//! Ineichen (2008). The authors find it within 5 to 10 % of measured and rigorously modelled spectra while the sun is
//! over 10° high; below, the flat layers of its diffuse part make it a rough guess. One wavelength stands for a band of
//! some 60 nm, whose mean differs by less than 2 % over 10°.

/// Nanometres: red, green, blue, near infrared.
pub const WAVELENGTHS: [f64; 4] = [610.0, 550.0, 465.0, 850.0];
/// Absorption of ozone, per atm-cm (Bird and Riordan, table 1).
const OZONE: [f64; 4] = [0.12, 0.085, 0.0075, 0.0];
/// Absorption of water vapour, per cm of water.
const WATER: [f64; 4] = [0.0, 0.0, 0.0, 0.08];
/// Of a column, atm-cm.
const OZONE_COLUMN: f64 = 0.3;
/// Of a column, cm of water.
const WATER_COLUMN: f64 = 1.4;
/// Of aerosols over land.
const ANGSTROM_EXPONENT: f64 = 1.3;
/// Mean cosine of the angle by which aerosols scatter.
const ASYMMETRY: f64 = 0.65;
/// What the ground of a town and its country scatters back to the sky.
pub const GROUND_ALBEDO: [f64; 4] = [0.143, 0.125, 0.109, 0.25];
/// Irradiance of level ground in every band under a sun of the usual intensity, 45° high, in air of turbidity 3: the
/// same luminance as that of the recipe's default sun and sky.
const USUAL_GLOBAL: f64 = 0.872;
/// Degrees and Linke turbidity for which [`USUAL_GLOBAL`] holds.
const USUAL: (f64, f64) = (45.0, 3.0);

/// Irradiance of a surface in red, green, blue and near infrared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Daylight {
    /// Of one that faces the sun, by the sun alone.
    pub sun: [f64; 4],
    /// Of a level one, by the sky alone.
    pub sky: [f64; 4],
}

impl Daylight {
    /// `elevation` in degrees, over 0; `turbidity` is Linke's, from 2. Balanced so that level ground under the usual sky
    /// is neutral: lower suns are warm, shadows are blue.
    pub fn clear_sky(elevation: f64, turbidity: f64) -> Daylight {
        let band = |b: usize| {
            let (direct, diffuse) = share_of_sunlight(b, elevation, turbidity);
            let (usual, usual_sky) = share_of_sunlight(b, USUAL.0, USUAL.1);
            let scale = USUAL_GLOBAL / (usual * libm::sin(USUAL.0.to_radians()) + usual_sky);
            (direct * scale, diffuse * scale)
        };
        let bands = [0, 1, 2, 3].map(band);
        Daylight { sun: bands.map(|(sun, _)| sun), sky: bands.map(|(_, sky)| sky) }
    }

    /// Radiance of the ground below, as the irradiance that it would give.
    pub fn ground(&self, elevation: f64) -> [f64; 4] {
        let height = libm::sin(elevation.to_radians());
        std::array::from_fn(|b| GROUND_ALBEDO[b] * (self.sun[b] * height + self.sky[b]))
    }
}

/// Optical depth of aerosols at 550 nm from Linke's turbidity, at sea level over the water column used here
/// (Ineichen 2008, Solar Energy 82, 1095).
fn aerosols(turbidity: f64) -> f64 {
    ((turbidity - 2.2 - 0.376 * libm::log(WATER_COLUMN)) / (3.91 * libm::exp(0.689))).max(0.0)
}

/// Direct irradiance across the beam and diffuse irradiance of level ground in a band, of the sunlight above the air.
fn share_of_sunlight(band: usize, elevation: f64, turbidity: f64) -> (f64, f64) {
    let cosine = libm::sin(elevation.to_radians());
    let mass = 1.0 / (cosine + 0.50572 * libm::pow(elevation + 6.07995, -1.6364));
    let layer = 22.0 / 6370.0;
    let ozone_mass = (1.0 + layer) / (cosine * cosine + 2.0 * layer).sqrt();
    let air = Air::new(band, mass, ozone_mass, turbidity);
    let direct = air.rayleigh * air.aerosols * air.absorption;

    let log = libm::log(1.0 - ASYMMETRY);
    let a = log * (1.459 + log * (0.1595 + log * 0.4129));
    let b = log * (0.0783 + log * (-0.3824 - log * 0.5874));
    let forward = |c: f64| 1.0 - 0.5 * libm::exp((a + b * c) * c);
    let scattered = air.absorption * air.aerosol_absorption * cosine;
    let by_air = scattered * (1.0 - libm::pow(air.rayleigh, 0.95)) * 0.5;
    let by_aerosols = scattered * libm::pow(air.rayleigh, 1.5) * (1.0 - air.aerosol_scattering) * forward(cosine);

    // What the ground sends up comes back under a mean air mass of 1.8.
    let up = Air::new(band, 1.8, 1.8, turbidity);
    let back = up.aerosol_absorption * up.water;
    let back =
        back * (0.5 * (1.0 - up.rayleigh) + (1.0 - forward(1.0 / 1.8)) * up.rayleigh * (1.0 - up.aerosol_scattering));
    let bounce = GROUND_ALBEDO[band] * back;
    let diffuse = by_air + by_aerosols;
    (direct, diffuse + (direct * cosine + diffuse) * bounce / (1.0 - bounce))
}

/// Transmittances of a way through the air.
struct Air {
    rayleigh: f64,
    aerosols: f64,
    /// The parts of `aerosols`.
    aerosol_scattering: f64,
    aerosol_absorption: f64,
    water: f64,
    /// Of ozone and water.
    absorption: f64,
}

impl Air {
    fn new(band: usize, mass: f64, ozone_mass: f64, turbidity: f64) -> Air {
        let micrometres = WAVELENGTHS[band] / 1000.0;
        let square = micrometres * micrometres;
        let depth = aerosols(turbidity) * libm::pow(micrometres / 0.55, -ANGSTROM_EXPONENT);
        let log = libm::log(micrometres / 0.4);
        let scattering = 0.945 * libm::exp(-0.095 * log * log);
        let wet = WATER[band] * WATER_COLUMN * mass;
        let water = libm::exp(-0.2385 * wet / libm::pow(1.0 + 20.07 * wet, 0.45));
        let ozone = libm::exp(-OZONE[band] * OZONE_COLUMN * ozone_mass);
        Air {
            rayleigh: libm::exp(-mass / (square * square * (115.6406 - 1.335 / square))),
            aerosols: libm::exp(-depth * mass),
            aerosol_scattering: libm::exp(-scattering * depth * mass),
            aerosol_absorption: libm::exp(-(1.0 - scattering) * depth * mass),
            water,
            absorption: water * ozone,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Direct and diffuse of each band.
    type Shares = [(f64, f64); 4];

    /// Shares of sunlight (direct, diffuse) at the four wavelengths by `pvlib.spectrum.spectrl2` of pvlib 0.13, which
    /// follows NREL's program: ozone 0.3 atm-cm, water 1.4 cm, exponent 1.3, the ground's albedo as here.
    const PUBLISHED: [(f64, f64, Shares); 5] = [
        (45.0, 3.0, [(0.7799, 0.0811), (0.7431, 0.1003), (0.6496, 0.1442), (0.8975, 0.0467)]),
        (10.0, 3.0, [(0.3791, 0.0381), (0.3120, 0.0462), (0.1819, 0.0641), (0.6694, 0.0276)]),
        (30.0, 5.0, [(0.4501, 0.1562), (0.3941, 0.1723), (0.2877, 0.1965), (0.6436, 0.1184)]),
        (80.0, 2.5, [(0.8854, 0.0506), (0.8622, 0.0689), (0.7953, 0.1166), (0.9587, 0.0220)]),
        (20.0, 8.0, [(0.1178, 0.1482), (0.0843, 0.1505), (0.0406, 0.1482), (0.2802, 0.1436)]),
    ];

    #[test]
    fn the_model_agrees_with_the_published_program() {
        for (elevation, turbidity, bands) in PUBLISHED {
            for (band, (direct, diffuse)) in bands.into_iter().enumerate() {
                let found = share_of_sunlight(band, elevation, turbidity);
                // 850 nm lies between two wavelengths of the program, whose absorption by water differs.
                let most = if band == 3 { 0.015 } else { 0.004 };
                let far = |a: f64, b: f64| (a - b).abs() / b > most && (a - b).abs() > 0.0015;
                assert!(!far(found.0, direct) && !far(found.1, diffuse), "{elevation} {turbidity} {band} {found:?}");
            }
        }
    }

    #[test]
    fn the_usual_sky_is_neutral_and_low_suns_are_dim_and_warm() {
        let usual = Daylight::clear_sky(45.0, 3.0);
        let level = |day: &Daylight, elevation: f64| {
            [0, 1, 2, 3].map(|b| day.sun[b] * libm::sin(elevation.to_radians()) + day.sky[b])
        };
        assert!(level(&usual, 45.0).iter().all(|v| (v - USUAL_GLOBAL).abs() < 1e-12));
        assert!(usual.sun[0] > usual.sun[1] && usual.sun[1] > usual.sun[2], "{usual:?}");
        assert!(usual.sky[0] < usual.sky[1] && usual.sky[1] < usual.sky[2] && usual.sky[3] < usual.sky[0], "{usual:?}");
        let mut brightness = f64::INFINITY;
        let mut warmth = 0.0;
        for elevation in [90.0, 60.0, 30.0, 15.0, 8.0, 3.0, 0.5, 0.01] {
            let day = Daylight::clear_sky(elevation, 3.0);
            let ground = level(&day, elevation);
            assert!(ground[1] < brightness && day.sun[0] / day.sun[2] > warmth, "{elevation} {day:?}");
            assert!(day.sun.iter().chain(&day.sky).all(|v| v.is_finite() && *v >= 0.0));
            (brightness, warmth) = (ground[1], day.sun[0] / day.sun[2]);
        }
    }

    #[test]
    fn turbid_air_takes_from_the_sun_and_gives_to_the_sky() {
        let (clean, murky) = (Daylight::clear_sky(40.0, 2.0), Daylight::clear_sky(40.0, 6.0));
        assert!((0..4).all(|b| murky.sun[b] < 0.8 * clean.sun[b] && murky.sky[b] > 1.5 * clean.sky[b]));
    }
}
