//! In: longitude and latitude in degrees on WGS84. Out: the scene's local metric frame (x east, y north), and back.
//!
//! The frame is a transverse Mercator projection with its own central meridian and origin, scale 1 at the centre
//! (Krüger's series in the form of Karney, "Transverse Mercator with an accuracy of a few nanometers", J. Geodesy 85,
//! 2011, equations 7-36, kept to n^4). Grid north is true north on the central meridian; at `x` metres east of it grid
//! north is turned by `x tan(lat) / R` (0.009 degrees at 1 km and latitude 45). Against the tangent plane and against
//! ellipsoidal distances the error over 2 km x 2 km is below 3e-5 m; the series itself and its inverse are good to 1e-6 m.

use glam::DVec2;
use libm::{asinh, atan, atan2, atanh, cos, cosh, hypot, sin, sinh, sqrt, tan};

/// Semi-major axis of WGS84, metres.
pub const SEMI_MAJOR_M: f64 = 6_378_137.0;
/// Flattening of WGS84.
pub const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// Centres nearer to a pole than this are refused, degrees.
const POLE_MARGIN_DEG: f64 = 1e-6;
/// Points further from the central meridian than this (about 3,200 km) are refused: transverse Mercator diverges.
const MAX_ETA: f64 = 0.5;

/// Third flattening.
const N: f64 = FLATTENING / (2.0 - FLATTENING);
/// Rectifying radius, metres (Karney, equation 14).
const RECTIFYING_RADIUS_M: f64 = SEMI_MAJOR_M / (1.0 + N) * (1.0 + N * N / 4.0 + N * N * N * N / 64.0);
/// Conformal to rectifying sphere (Karney, equation 35).
const ALPHA: [f64; 4] = [
    N * (0.5 + N * (-2.0 / 3.0 + N * (5.0 / 16.0 + N * 41.0 / 180.0))),
    N * N * (13.0 / 48.0 + N * (-3.0 / 5.0 + N * 557.0 / 1440.0)),
    N * N * N * (61.0 / 240.0 - N * 103.0 / 140.0),
    N * N * N * N * 49_561.0 / 161_280.0,
];
/// Rectifying to conformal sphere (Karney, equation 36).
const BETA: [f64; 4] = [
    N * (0.5 + N * (-2.0 / 3.0 + N * (37.0 / 96.0 - N / 360.0))),
    N * N * (1.0 / 48.0 + N * (1.0 / 15.0 - N * 437.0 / 1440.0)),
    N * N * N * (17.0 / 480.0 - N * 37.0 / 840.0),
    N * N * N * N * 4_397.0 / 161_280.0,
];

/// Why a place has no local coordinates.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ProjectionError {
    #[error("longitude {lon}, latitude {lat} is not a place on Earth")]
    NotAPlace { lon: f64, lat: f64 },
    #[error("a scene cannot be centred on a pole (latitude {lat})")]
    Pole { lat: f64 },
    #[error("longitude {lon}, latitude {lat} is more than 3,000 km away from the scene's central meridian")]
    TooFar { lon: f64, lat: f64 },
}

/// The local frame of one scene: metres east and north of a centre on the WGS84 ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalFrame {
    lon_deg: f64,
    lat_deg: f64,
    /// Northing of the centre, metres from the equator.
    northing_m: f64,
}

impl LocalFrame {
    /// Frame about a centre in degrees.
    pub fn new(lon_deg: f64, lat_deg: f64) -> Result<Self, ProjectionError> {
        check_place(lon_deg, lat_deg)?;
        if lat_deg.abs() > 90.0 - POLE_MARGIN_DEG {
            return Err(ProjectionError::Pole { lat: lat_deg });
        }
        let frame = LocalFrame { lon_deg: reduce_longitude(lon_deg), lat_deg, northing_m: 0.0 };
        let northing_m = frame.forward(lon_deg, lat_deg)?.y;
        Ok(LocalFrame { northing_m, ..frame })
    }

    /// Longitude and latitude of the centre, degrees; the longitude lies in (-180, 180].
    pub fn centre(&self) -> (f64, f64) {
        (self.lon_deg, self.lat_deg)
    }

    /// Longitude and latitude in degrees to metres (x east, y north).
    pub fn forward(&self, lon_deg: f64, lat_deg: f64) -> Result<DVec2, ProjectionError> {
        check_place(lon_deg, lat_deg)?;
        let lambda = reduce_longitude(lon_deg - self.lon_deg).to_radians();
        let t = conformal_tangent(tan(lat_deg.to_radians()));
        let (sin_l, cos_l) = (sin(lambda), cos(lambda));
        let (xi, eta) = (atan2(t, cos_l), asinh(sin_l / hypot(t, cos_l)));
        if eta.is_nan() || eta.abs() > MAX_ETA {
            return Err(ProjectionError::TooFar { lon: lon_deg, lat: lat_deg });
        }
        let (dxi, deta) = series(&ALPHA, xi, eta);
        Ok(DVec2::new(RECTIFYING_RADIUS_M * (eta + deta), RECTIFYING_RADIUS_M * (xi + dxi) - self.northing_m))
    }

    /// Metres (x east, y north) to longitude in (-180, 180] and latitude, degrees.
    pub fn inverse(&self, plan: DVec2) -> (f64, f64) {
        let (xi, eta) = ((plan.y + self.northing_m) / RECTIFYING_RADIUS_M, plan.x / RECTIFYING_RADIUS_M);
        let (dxi, deta) = series(&BETA, xi, eta);
        let (xi, eta) = (xi - dxi, eta - deta);
        let (sinh_eta, cos_xi) = (sinh(eta), cos(xi));
        let lambda = atan2(sinh_eta, cos_xi);
        let t = sin(xi) / hypot(sinh_eta, cos_xi);
        (reduce_longitude(self.lon_deg + lambda.to_degrees()), atan(geographic_tangent(t)).to_degrees())
    }
}

/// The same angle in (-180, 180].
pub fn reduce_longitude(lon_deg: f64) -> f64 {
    if lon_deg > -180.0 && lon_deg <= 180.0 {
        return lon_deg;
    }
    let turned = lon_deg - 360.0 * ((lon_deg + 180.0) / 360.0).floor();
    if turned <= -180.0 { turned + 360.0 } else { turned }
}

fn check_place(lon: f64, lat: f64) -> Result<(), ProjectionError> {
    if lon.is_finite() && (-90.0..=90.0).contains(&lat) { Ok(()) } else { Err(ProjectionError::NotAPlace { lon, lat }) }
}

/// Real and imaginary part of the sum of `c[j] sin(2 j (xi + i eta))`.
fn series(coefficients: &[f64; 4], xi: f64, eta: f64) -> (f64, f64) {
    let (mut re, mut im) = (0.0, 0.0);
    for (c, j) in coefficients.iter().zip([2.0, 4.0, 6.0, 8.0]) {
        re += c * sin(j * xi) * cosh(j * eta);
        im += c * cos(j * xi) * sinh(j * eta);
    }
    (re, im)
}

/// Tangent of the conformal latitude from the tangent of the geographic latitude (Karney, equations 7-9).
fn conformal_tangent(tau: f64) -> f64 {
    let e = sqrt(FLATTENING * (2.0 - FLATTENING));
    let sec = hypot(1.0, tau);
    let sigma = sinh(e * atanh(e * tau / sec));
    tau * hypot(1.0, sigma) - sigma * sec
}

/// Inverse of [`conformal_tangent`] by Newton's method (Karney, equations 19-21).
fn geographic_tangent(target: f64) -> f64 {
    let e2 = FLATTENING * (2.0 - FLATTENING);
    let mut tau = target;
    for _ in 0..4 {
        let t = conformal_tangent(tau);
        let step = (target - t) / hypot(1.0, t) * (1.0 + (1.0 - e2) * tau * tau) / ((1.0 - e2) * hypot(1.0, tau));
        tau += step;
        if step.abs() <= 1e-15 * tau.abs() {
            break;
        }
    }
    tau
}

#[cfg(test)]
mod tests {
    mod stages;

    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;

    /// Earth-centred coordinates of a point on the ellipsoid.
    fn ecef(lon: f64, lat: f64) -> DVec3 {
        let e2 = FLATTENING * (2.0 - FLATTENING);
        let (lon, lat) = (lon.to_radians(), lat.to_radians());
        let n = SEMI_MAJOR_M / sqrt(1.0 - e2 * sin(lat) * sin(lat));
        DVec3::new(n * cos(lat) * cos(lon), n * cos(lat) * sin(lon), n * (1.0 - e2) * sin(lat))
    }

    /// East and north in the tangent plane at the centre.
    fn tangent_plane(centre: (f64, f64), place: (f64, f64)) -> DVec2 {
        let d = ecef(place.0, place.1) - ecef(centre.0, centre.1);
        let (lon, lat) = (centre.0.to_radians(), centre.1.to_radians());
        let east = DVec3::new(-sin(lon), cos(lon), 0.0);
        let north = DVec3::new(-sin(lat) * cos(lon), -sin(lat) * sin(lon), cos(lat));
        DVec2::new(d.dot(east), d.dot(north))
    }

    proptest! {
        #[test]
        fn agrees_with_the_tangent_plane_over_two_kilometres(
            lon in -180.0..180.0, lat in -89.5..89.5, x in -1000.0..1000.0, y in -1000.0..1000.0
        ) {
            let frame = LocalFrame::new(lon, lat).unwrap();
            let place = frame.inverse(DVec2::new(x, y));
            let enu = tangent_plane((lon, lat), place);
            prop_assert!((enu - DVec2::new(x, y)).length() < 3e-5, "{enu} is not {x}, {y}");
        }

        #[test]
        fn distances_between_near_points_are_ellipsoidal(
            lon in -180.0..180.0, lat in -85.0..85.0, x in -1000.0..1000.0, y in -1000.0..1000.0, u in -30.0..30.0, v in -30.0..30.0
        ) {
            let frame = LocalFrame::new(lon, lat).unwrap();
            let (p, q) = (DVec2::new(x, y), DVec2::new(x + u, y + v));
            let (a, b) = (frame.inverse(p), frame.inverse(q));
            let chord = (ecef(a.0, a.1) - ecef(b.0, b.1)).length();
            prop_assert!((chord - p.distance(q)).abs() < 5e-6);
        }

        #[test]
        fn inverse_undoes_forward(lon in -180.0..180.0, lat in -89.0..89.0, dlon in -5.0..5.0, dlat in -5.0..5.0) {
            let frame = LocalFrame::new(lon, lat).unwrap();
            let place = (lon + dlon, f64::clamp(lat + dlat, -89.9, 89.9));
            let back = frame.inverse(frame.forward(place.0, place.1).unwrap());
            prop_assert!((ecef(place.0, place.1) - ecef(back.0, back.1)).length() < 1e-6);
        }
    }

    #[test]
    fn the_centre_is_zero_and_the_date_line_is_no_border() {
        let frame = LocalFrame::new(179.999, -16.5).unwrap();
        assert!(frame.forward(179.999, -16.5).unwrap().length() < 1e-9);
        let east = frame.forward(-179.999, -16.5).unwrap();
        assert!((east.x - 213.5).abs() < 0.2, "{east}");
        let back = frame.inverse(east);
        assert!((back.0 + 179.999).abs() < 1e-11 && back.0 > -180.0);
        assert_eq!(frame.forward(540.0 + 179.999 - 180.0, -16.5), frame.forward(180.0 - 0.001 + 360.0, -16.5));
        assert_eq!(
            (reduce_longitude(-180.0), reduce_longitude(180.0), reduce_longitude(-190.0)),
            (180.0, 180.0, 170.0)
        );
    }

    #[test]
    fn places_without_coordinates_are_typed_errors() {
        assert_eq!(LocalFrame::new(0.0, 90.0), Err(ProjectionError::Pole { lat: 90.0 }));
        assert!(matches!(LocalFrame::new(f64::NAN, 0.0), Err(ProjectionError::NotAPlace { .. })));
        assert!(matches!(LocalFrame::new(0.0, 91.0), Err(ProjectionError::NotAPlace { .. })));
        let queens = LocalFrame::new(-73.74, 40.7).unwrap();
        assert!(matches!(queens.forward(10.7, 59.9), Err(ProjectionError::TooFar { .. })));
        assert!(queens.forward(-80.0, 30.0).is_ok());
    }

    #[test]
    fn a_degree_of_meridian_has_its_known_length() {
        // 111,132.95 m from latitude 44.5 to 45.5 on WGS84 (meridian arc).
        let frame = LocalFrame::new(7.0, 44.5).unwrap();
        let top = frame.forward(7.0, 45.5).unwrap();
        assert!((top.y - 111_131.78).abs() < 1.5 && top.x == 0.0, "{top}");
    }
}
