//! In: the GeoKey directory of a GeoTIFF. Out: a CRS definition, pixel-is-point, the unit of heights.
//! Source: OGC GeoTIFF 1.1 (19-008r4), sections 7 and 8; user-defined projections as in annex C of GeoTIFF 1.0.

use std::collections::BTreeMap;

use super::crs::epsg_definition;
use super::error::ElevationProblem;

const USER_DEFINED: f64 = 32767.0;

/// GeoKeys by number; text keys are not needed and not kept.
#[derive(Debug, Default)]
pub(super) struct GeoKeys {
    values: BTreeMap<u16, f64>,
}

/// GeoKey numbers.
mod key {
    pub const MODEL_TYPE: u16 = 1024;
    pub const RASTER_TYPE: u16 = 1025;
    pub const GEODETIC_CRS: u16 = 2048;
    pub const ELLIPSOID: u16 = 2056;
    pub const SEMI_MAJOR: u16 = 2057;
    pub const SEMI_MINOR: u16 = 2058;
    pub const INVERSE_FLATTENING: u16 = 2059;
    pub const PROJECTED_CRS: u16 = 3072;
    pub const PROJECTION_METHOD: u16 = 3075;
    pub const LINEAR_UNITS: u16 = 3076;
    pub const LINEAR_UNIT_SIZE: u16 = 3077;
    pub const PARALLEL_1: u16 = 3078;
    pub const PARALLEL_2: u16 = 3079;
    /// Natural origin, false origin, centre: files use any of the three.
    pub const LON_0: [u16; 4] = [3084, 3080, 3088, 3095];
    pub const LAT_0: [u16; 3] = [3085, 3081, 3089];
    pub const X_0: [u16; 3] = [3086, 3082, 3090];
    pub const Y_0: [u16; 3] = [3087, 3083, 3091];
    pub const SCALE: [u16; 2] = [3092, 3093];
    pub const VERTICAL_CRS: u16 = 4096;
    pub const VERTICAL_UNITS: u16 = 4099;
}

impl GeoKeys {
    /// Reads the directory (tag 34735) with its doubles (tag 34736).
    pub(super) fn parse(directory: &[u16], doubles: &[f64]) -> Self {
        let mut values = BTreeMap::new();
        for entry in directory.get(4..).unwrap_or_default().chunks_exact(4) {
            let (id, tag, at) = (entry[0], entry[1], usize::from(entry[3]));
            let value = match tag {
                0 => Some(f64::from(entry[3])),
                34735 => directory.get(at).map(|&v| f64::from(v)),
                34736 => doubles.get(at).copied(),
                _ => None,
            };
            if let Some(value) = value {
                values.insert(id, value);
            }
        }
        GeoKeys { values }
    }

    fn get(&self, id: u16) -> Option<f64> {
        self.values.get(&id).copied()
    }

    fn first(&self, ids: &[u16]) -> Option<f64> {
        ids.iter().find_map(|&id| self.get(id))
    }

    /// An EPSG code under a key, unless it is absent or user-defined.
    fn code(&self, id: u16) -> Option<u32> {
        self.get(id).filter(|&v| v > 0.0 && v < USER_DEFINED).map(|v| v as u32)
    }

    /// Whether the tie point names the centre of a cell and not its corner.
    pub(super) fn pixel_is_point(&self) -> bool {
        self.get(key::RASTER_TYPE) == Some(2.0)
    }

    /// Metres per unit of height.
    pub(super) fn metres_per_height(&self) -> f64 {
        match (self.code(key::VERTICAL_UNITS), self.code(key::VERTICAL_CRS)) {
            (Some(unit), _) => metres_per_unit(unit).unwrap_or(1.0),
            // NAVD 88 in US survey feet and in feet.
            (None, Some(6360)) => metres_per_unit(9003).expect("listed"),
            (None, Some(8228)) => metres_per_unit(9002).expect("listed"),
            _ => 1.0,
        }
    }

    /// The horizontal system as `EPSG:<code>` or PROJ string.
    pub(super) fn crs(&self) -> Result<String, ElevationProblem> {
        if let Some(code) = self.code(key::PROJECTED_CRS) {
            return Ok(format!("EPSG:{code}"));
        }
        match self.get(key::MODEL_TYPE) {
            Some(1.0) => self.user_projection(),
            Some(2.0) => match self.code(key::GEODETIC_CRS) {
                Some(code) => Ok(format!("EPSG:{code}")),
                None => Ok(format!("+proj=longlat {} +no_defs", self.earth()?)),
            },
            Some(other) => Err(ElevationProblem::UserDefinedCrs(format!("model type {other}"))),
            None => Err(ElevationProblem::NoCrs),
        }
    }

    /// Datum or ellipsoid, as PROJ parameters.
    fn earth(&self) -> Result<String, ElevationProblem> {
        if let Some(definition) = self.code(key::GEODETIC_CRS).and_then(epsg_definition) {
            let keep = ["+datum=", "+ellps=", "+a=", "+b=", "+R=", "+rf=", "+towgs84=", "+pm=", "+nadgrids="];
            let kept: Vec<&str> =
                definition.split_whitespace().filter(|t| keep.iter().any(|k| t.starts_with(k))).collect();
            return Ok(kept.join(" "));
        }
        let known = match self.code(key::ELLIPSOID) {
            Some(7030) => Some("+ellps=WGS84"),
            Some(7019) => Some("+ellps=GRS80"),
            Some(7008) => Some("+ellps=clrk66"),
            Some(7022) => Some("+ellps=intl"),
            Some(7004) => Some("+ellps=bessel"),
            Some(7001) => Some("+ellps=airy"),
            _ => None,
        };
        match (self.get(key::SEMI_MAJOR), self.get(key::SEMI_MINOR), self.get(key::INVERSE_FLATTENING)) {
            (Some(a), Some(b), _) if a == b => Ok(format!("+R={a}")),
            (Some(a), None, Some(0.0)) => Ok(format!("+R={a}")),
            (Some(a), Some(b), _) => Ok(format!("+a={a} +b={b}")),
            (Some(a), None, Some(rf)) => Ok(format!("+a={a} +rf={rf}")),
            _ => known.map(str::to_owned).ok_or_else(|| ElevationProblem::UserDefinedCrs("no ellipsoid".to_owned())),
        }
    }

    fn user_projection(&self) -> Result<String, ElevationProblem> {
        let refuse = |what: String| Err(ElevationProblem::UserDefinedCrs(what));
        let Some(method) = self.get(key::PROJECTION_METHOD) else {
            return refuse("no projection method".to_owned());
        };
        let unit = match (self.get(key::LINEAR_UNITS), self.get(key::LINEAR_UNIT_SIZE)) {
            (None, _) => 1.0,
            (Some(USER_DEFINED), Some(size)) => size,
            (Some(code), _) => match metres_per_unit(code as u32) {
                Some(unit) => unit,
                None => return refuse(format!("linear unit {code}")),
            },
        };
        let lat_0 = self.first(&key::LAT_0).unwrap_or(0.0);
        let (p1, p2) = (self.get(key::PARALLEL_1), self.get(key::PARALLEL_2));
        let k = self.first(&key::SCALE).unwrap_or(1.0);
        let own = match (method as u32, p1, p2) {
            (1, ..) => format!("+proj=tmerc +lat_0={lat_0} +k={k}"),
            (7, Some(ts), _) => format!("+proj=merc +lat_ts={ts}"),
            (7, None, _) => format!("+proj=merc +k={k}"),
            (8, Some(p1), Some(p2)) => format!("+proj=lcc +lat_1={p1} +lat_2={p2} +lat_0={lat_0}"),
            (9, ..) => format!("+proj=lcc +lat_1={lat_0} +lat_0={lat_0} +k_0={k}"),
            (10, ..) => format!("+proj=laea +lat_0={lat_0}"),
            (11, Some(p1), Some(p2)) => format!("+proj=aea +lat_1={p1} +lat_2={p2} +lat_0={lat_0}"),
            (15, ..) if lat_0 != 0.0 => {
                format!("+proj=stere +lat_0={} +lat_ts={lat_0} +k={k}", if lat_0 > 0.0 { 90 } else { -90 })
            }
            (16, ..) => format!("+proj=sterea +lat_0={lat_0} +k={k}"),
            (17, ..) => format!("+proj=eqc +lat_ts={} +lat_0={lat_0}", p1.unwrap_or(0.0)),
            (24, ..) => "+proj=sinu".to_owned(),
            (method, ..) => return refuse(format!("projection method {method}")),
        };
        let lon_0 = self.first(&key::LON_0).unwrap_or(0.0);
        let (x_0, y_0) = (self.first(&key::X_0).unwrap_or(0.0) * unit, self.first(&key::Y_0).unwrap_or(0.0) * unit);
        Ok(format!("{own} +lon_0={lon_0} +x_0={x_0} +y_0={y_0} {} +to_meter={unit} +no_defs", self.earth()?))
    }
}

/// Length units (EPSG 9001 to 9003).
fn metres_per_unit(code: u32) -> Option<f64> {
    match code {
        9001 => Some(1.0),
        9002 => Some(0.3048),
        9003 => Some(1200.0 / 3937.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(pairs: &[(u16, f64)]) -> GeoKeys {
        GeoKeys { values: pairs.iter().copied().collect() }
    }

    #[test]
    fn a_directory_is_read_with_its_doubles() {
        let k = GeoKeys::parse(&[1, 1, 0, 3, 1024, 0, 1, 1, 3078, 34736, 1, 1, 1026, 34737, 4, 0], &[7.0, 35.5]);
        assert_eq!(k.values, BTreeMap::from([(1024, 1.0), (3078, 35.5)]));
        assert!(GeoKeys::parse(&[1, 1, 0, 9, 1024, 34736, 1, 900], &[]).values.is_empty());
        assert!(matches!(GeoKeys::parse(&[], &[]).crs(), Err(ElevationProblem::NoCrs)));
    }

    #[test]
    fn a_projection_of_ones_own() {
        let lcc = [(1024, 1.0), (3072, USER_DEFINED), (3075, 8.0), (3078, 35.5), (3079, 41.5), (3085, 35.5)];
        let mut sphere = lcc.to_vec();
        sphere.extend([(3084, -122.7), (2057, 6_371_200.0), (2059, 0.0), (3076, 9003.0), (3086, 3937.0)]);
        let text = keys(&sphere).crs().unwrap();
        assert!(text.contains("+R=6371200") && text.contains("+lon_0=-122.7") && text.contains("+x_0=1200 "), "{text}");
        assert!(matches!(keys(&lcc).crs(), Err(ElevationProblem::UserDefinedCrs(_))));
        let hotine = [(1024, 1.0), (3075, 3.0), (2057, 6_371_200.0), (2059, 0.0)];
        assert!(keys(&hotine).crs().unwrap_err().to_string().contains("projection method 3"));
    }

    #[test]
    fn heights_in_feet() {
        assert_eq!(keys(&[(4099, 9002.0)]).metres_per_height(), 0.3048);
        assert_eq!(keys(&[(4096, 6360.0)]).metres_per_height(), 1200.0 / 3937.0);
        assert_eq!(keys(&[(4096, 5773.0)]).metres_per_height(), 1.0);
    }
}
