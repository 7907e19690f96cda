//! In: decoded pixels of any type. Out: heights in metres, NaN for voids.

use tiff::decoder::DecodingResult;

use super::error::ElevationProblem;

/// How a band's numbers become metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Band {
    /// The stored number that means "no height".
    pub nodata: Option<f64>,
    pub scale: f64,
    pub offset: f64,
}

impl Band {
    /// Height of a cell of a block of `cells` cells; further bands that are interleaved with the first are skipped.
    pub(super) fn metres(&self, values: &DecodingResult, cell: usize, cells: usize) -> Result<f32, ElevationProblem> {
        macro_rules! at {
            ($v:expr) => {
                $v.get(cell * ($v.len() / cells).max(1)).copied()
            };
        }
        let value = match values {
            DecodingResult::U8(v) => at!(v).map(f64::from),
            DecodingResult::U16(v) => at!(v).map(f64::from),
            DecodingResult::U32(v) => at!(v).map(f64::from),
            DecodingResult::U64(v) => at!(v).map(|x| x as f64),
            DecodingResult::I8(v) => at!(v).map(f64::from),
            DecodingResult::I16(v) => at!(v).map(f64::from),
            DecodingResult::I32(v) => at!(v).map(f64::from),
            DecodingResult::I64(v) => at!(v).map(|x| x as f64),
            DecodingResult::F32(v) => at!(v).map(f64::from),
            DecodingResult::F64(v) => at!(v),
            DecodingResult::F16(v) => at!(v).map(|x| f64::from(x.to_f32())),
        };
        let value = value.ok_or_else(|| ElevationProblem::Damaged("a block is shorter than its size".to_owned()))?;
        // The tag's text is rounded differently by different writers, so floats are compared as f32.
        let void = self.nodata.is_some_and(|n| n == value || n as f32 == value as f32);
        Ok(if void { f32::NAN } else { (value * self.scale + self.offset) as f32 })
    }
}

/// Text of the first band's (or the file's) `<Item role="...">` in GDAL's metadata.
pub(super) fn gdal_item<'a>(metadata: &'a str, role: &str) -> Option<&'a str> {
    let wanted = format!("role=\"{role}\"");
    metadata.split("<Item ").skip(1).find_map(|item| {
        let (attributes, rest) = item.split_once('>')?;
        let first_band = !attributes.contains("sample=") || attributes.contains("sample=\"0\"");
        (first_band && attributes.contains(&wanted)).then(|| rest.split('<').next().unwrap_or_default().trim())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_offset_nodata_and_other_bands() {
        let band = Band { nodata: Some(7.0), scale: 0.5, offset: -100.0 };
        let two_bands = DecodingResult::U16(vec![300, 1, 7, 1, 400, 1]);
        let m = |cell| band.metres(&two_bands, cell, 3).unwrap();
        assert_eq!((m(0), m(2)), (50.0, 100.0));
        assert!(m(1).is_nan());
        assert!(band.metres(&two_bands, 9, 3).is_err());
        let lowest = Band { nodata: "-3.40282346638529e+38".parse().ok(), scale: 1.0, offset: 0.0 };
        assert!(lowest.metres(&DecodingResult::F32(vec![f32::MIN]), 0, 1).unwrap().is_nan());
    }

    /// A stage case of `../shared/hard-cases/stages.json`: the header's value is void, all others are heights.
    #[test]
    fn dem_nodata_kinds() {
        for nodata in [f64::NAN, -32768.0, -9999.0, 0.0, 3.4e38] {
            let band = Band { nodata: Some(nodata), scale: 1.0, offset: 0.0 };
            let values = DecodingResult::F32(vec![nodata as f32, 0.0, -430.0, 8848.0, -9999.0]);
            let metres: Vec<f32> = (0..5).map(|cell| band.metres(&values, cell, 5).unwrap()).collect();
            assert!(metres[0].is_nan(), "{nodata}");
            let expected = [0.0_f32, -430.0, 8848.0, -9999.0];
            for (got, height) in metres[1..].iter().zip(expected) {
                assert!(if f64::from(height) == nodata { got.is_nan() } else { *got == height }, "{nodata}: {got}");
            }
        }
    }

    #[test]
    fn metadata_of_the_first_band_counts() {
        let xml = "<GDALMetadata><Item name=\"SCALE\" sample=\"1\" role=\"scale\">9</Item>\n\
                   <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item></GDALMetadata>";
        assert_eq!((gdal_item(xml, "scale"), gdal_item(xml, "offset")), (Some("0.1"), None));
    }
}
