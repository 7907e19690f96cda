//! In: an EPSG code or a PROJ string. Out: a [`Crs`] that takes WGS84 longitude and latitude to the file's coordinates
//! and back.
//!
//! `proj4rs` computes with the platform's trigonometry: results may differ in the last bits between platforms, which
//! moves heights by less than 1e-8 m.

use glam::DVec2;
use proj4rs::Proj;
use proj4rs::transform::transform;

use super::error::ElevationProblem;

/// A horizontal coordinate reference system.
pub struct Crs {
    definition: String,
    kind: Kind,
}

enum Kind {
    /// Longitude and latitude in degrees on WGS84 or a datum that PROJ takes as equal to it.
    Degrees,
    /// Another datum, degrees.
    Geographic { file: Proj, wgs84: Proj },
    /// Metres or feet, x and y.
    Projected { file: Proj, wgs84: Proj },
}

const WGS84: &str = "+proj=longlat +datum=WGS84 +no_defs";

impl Crs {
    /// Reads `EPSG:<code>` or a PROJ string. Of a compound system the horizontal part is used.
    pub fn parse(text: &str) -> Result<Self, ElevationProblem> {
        let text = text.trim();
        let unknown = || ElevationProblem::UnknownCrs(text.to_owned());
        let definition = match text.get(..5).filter(|head| head.eq_ignore_ascii_case("EPSG:")) {
            Some(_) => epsg_definition(text[5..].trim().parse().map_err(|_| unknown())?).ok_or_else(unknown)?,
            None if text.starts_with('+') => text.to_owned(),
            None => return Err(unknown()),
        };
        let fail = |reason: String| ElevationProblem::Crs { definition: text.to_owned(), reason };
        let definition = horizontal(&definition).map_err(fail)?;
        let file = Proj::from_proj_string(&definition).map_err(|e| fail(e.to_string()))?;
        let wgs84 = Proj::from_proj_string(WGS84).expect("the definition of WGS84 is valid");
        let kind = if !file.is_latlong() {
            Kind::Projected { file, wgs84 }
        } else if is_identity(&wgs84, &file) {
            Kind::Degrees
        } else {
            Kind::Geographic { file, wgs84 }
        };
        Ok(Crs { definition: text.to_owned(), kind })
    }

    /// The text this was made from.
    pub fn definition(&self) -> &str {
        &self.definition
    }

    /// Whether coordinates are degrees, whose longitudes repeat every 360.
    pub fn is_geographic(&self) -> bool {
        !matches!(self.kind, Kind::Projected { .. })
    }

    /// WGS84 degrees to the file's coordinates; `None` outside the projection's domain.
    pub fn project(&self, lon: f64, lat: f64) -> Option<DVec2> {
        let (file, wgs84, unit) = match &self.kind {
            Kind::Degrees => return Some(DVec2::new(lon, lat)),
            Kind::Geographic { file, wgs84 } => (file, wgs84, 180.0 / std::f64::consts::PI),
            Kind::Projected { file, wgs84 } => (file, wgs84, 1.0),
        };
        let point = apply(wgs84, file, DVec2::new(lon.to_radians(), lat.to_radians()))?;
        Some(point * unit)
    }

    /// The file's coordinates to WGS84 degrees; `None` outside the projection's domain.
    pub fn unproject(&self, point: DVec2) -> Option<(f64, f64)> {
        let (file, wgs84, unit) = match &self.kind {
            Kind::Degrees => return Some((point.x, point.y)),
            Kind::Geographic { file, wgs84 } => (file, wgs84, std::f64::consts::PI / 180.0),
            Kind::Projected { file, wgs84 } => (file, wgs84, 1.0),
        };
        let place = apply(file, wgs84, point * unit)?;
        Some((place.x.to_degrees(), place.y.to_degrees()))
    }
}

impl std::fmt::Debug for Crs {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "Crs({})", self.definition)
    }
}

/// PROJ string of an EPSG code.
pub(super) fn epsg_definition(code: u32) -> Option<String> {
    crs_definitions::from_code(u16::try_from(code).ok()?).map(|d| d.proj4.to_owned())
}

/// Drops vertical parts; refuses datums that are only known through shift grids, which would be off by 100 m without.
fn horizontal(definition: &str) -> Result<String, String> {
    let has = |key: &str| definition.split_whitespace().any(|t| t.starts_with(key));
    let shifted = has("+towgs84=");
    let mut kept = Vec::new();
    for token in definition.split_whitespace() {
        let grid = token.strip_prefix("+nadgrids=").is_some_and(|g| g != "@null");
        if (grid || token == "+datum=NAD27") && !shifted {
            return Err("it needs datum shift grids, which are not supported; reproject the file to WGS84".to_owned());
        }
        let vertical = ["+geoidgrids=", "+vunits=", "+vto_meter=", "+geoid_crs="].iter().any(|v| token.starts_with(v));
        if !vertical && !grid {
            kept.push(token);
        }
    }
    Ok(kept.join(" "))
}

fn apply(from: &Proj, to: &Proj, point: DVec2) -> Option<DVec2> {
    let mut p = (point.x, point.y, 0.0);
    transform(from, to, &mut p).ok()?;
    let out = DVec2::new(p.0, p.1);
    out.is_finite().then_some(out)
}

fn is_identity(wgs84: &Proj, file: &Proj) -> bool {
    [DVec2::new(0.3, 0.8), DVec2::new(-2.0, -0.4)]
        .into_iter()
        .all(|p| apply(wgs84, file, p).is_some_and(|q| p.distance(q) < 1e-12))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feet_and_metres_and_degrees() {
        // State plane zone 3 (US feet) and Albers at their published false origins.
        let feet = Crs::parse("EPSG:2227").unwrap();
        let origin = feet.project(-120.5, 36.5).unwrap();
        assert!((origin - DVec2::new(6_561_666.667, 1_640_416.667)).length() < 0.01, "{origin}");
        let albers = Crs::parse("EPSG:3310").unwrap();
        assert!((albers.project(-120.0, 0.0).unwrap() - DVec2::new(0.0, -4_000_000.0)).length() < 1e-3);
        let degrees = Crs::parse("epsg:4269").unwrap();
        assert_eq!(degrees.project(-120.0, 35.0), Some(DVec2::new(-120.0, 35.0)));
        assert!(degrees.is_geographic() && !albers.is_geographic());
        let back = feet.unproject(feet.project(-122.0, 37.5).unwrap()).unwrap();
        assert!((back.0 + 122.0).abs() < 1e-9 && (back.1 - 37.5).abs() < 1e-9);
    }

    #[test]
    fn a_shifted_datum_is_shifted() {
        // Airy's ellipsoid lies about 100 m off WGS84 in Britain.
        let osgb = Crs::parse("EPSG:4277").unwrap();
        let p = osgb.project(-2.0, 52.0).unwrap();
        let metres = DVec2::new((p.x + 2.0) * 68_600.0, (p.y - 52.0) * 111_250.0);
        assert!((60.0..160.0).contains(&metres.length()), "{metres}");
    }

    #[test]
    fn unusable_definitions_are_refused_with_their_reason() {
        assert!(matches!(Crs::parse("EPSG:1"), Err(ElevationProblem::UnknownCrs(_))));
        assert!(matches!(Crs::parse("WGS84"), Err(ElevationProblem::UnknownCrs(_))));
        assert!(matches!(Crs::parse("EPSG:four"), Err(ElevationProblem::UnknownCrs(_))));
        assert!(matches!(Crs::parse("é́́PSG:4326"), Err(ElevationProblem::UnknownCrs(_))));
        let message = Crs::parse("EPSG:4267").unwrap_err().to_string();
        assert!(message.contains("shift grids"), "{message}");
        assert!(matches!(Crs::parse("+proj=nonsense"), Err(ElevationProblem::Crs { .. })));
    }
}
