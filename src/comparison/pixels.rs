//! Pixels. In: two image files of a dataset. Out: how many pixels differ, by how much, and for labels from what to what.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::error::ComparisonError;
use crate::frame::Pixels;

/// A decoded image.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    pub width: u32,
    pub height: u32,
    pub pixels: Pixels,
}

/// Reads an image as `dataset::writer` wrote it.
pub fn decode(path: &Path) -> Result<Decoded, ComparisonError> {
    let wrong = |why: String| ComparisonError::Image { path: path.to_owned(), why };
    let bytes = std::fs::read(path).map_err(ComparisonError::read(path))?;
    if path.extension().is_some_and(|suffix| suffix == "tif") {
        return decode_tiff(&bytes).map_err(wrong);
    }
    let image = image::load_from_memory(&bytes).map_err(|error| wrong(error.to_string()))?;
    let (width, height) = (image.width(), image.height());
    let pixels = match image {
        image::DynamicImage::ImageRgb8(image) => Pixels::Rgb8(image.into_raw()),
        image::DynamicImage::ImageLuma8(image) => Pixels::Gray8(image.into_raw()),
        image::DynamicImage::ImageRgb16(image) => Pixels::Rgb16(image.into_raw()),
        image::DynamicImage::ImageLuma16(image) => Pixels::Gray16(image.into_raw()),
        other => return Err(wrong(format!("it has pixels of the kind {:?}", other.color()))),
    };
    Ok(Decoded { width, height, pixels })
}

fn decode_tiff(bytes: &[u8]) -> Result<Decoded, String> {
    use tiff::decoder::{Decoder, DecodingResult};
    let mut decoder = Decoder::new(std::io::Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions().map_err(|error| error.to_string())?;
    let pixels = match decoder.read_image().map_err(|error| error.to_string())? {
        DecodingResult::U32(ids) => Pixels::Id32(ids),
        DecodingResult::F32(depths) => Pixels::Float32(depths),
        _ => return Err("it holds neither ids nor depths".to_owned()),
    };
    Ok(Decoded { width, height, pixels })
}

/// What kind of number an image holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Classes, masks, levels, ids: decisions, never blended.
    Labels,
    Depth,
    /// Light, rounded.
    Colour,
}

/// The kind of an image by what the manifest says, or, in old manifests, by how it is stored.
pub fn kind(output: Option<&str>, pixels: &Pixels) -> Kind {
    match (output, pixels) {
        (Some("colour"), _) => Kind::Colour,
        (Some("depth"), _) | (None, Pixels::Float32(_)) => Kind::Depth,
        (Some(_), _) | (None, Pixels::Gray8(_) | Pixels::Id32(_)) => Kind::Labels,
        (None, Pixels::Rgb8(_) | Pixels::Rgb16(_) | Pixels::Gray16(_)) => Kind::Colour,
    }
}

/// Differences of colour that nobody sees, parts of 255: rounding, and noise of the last bits of coordinates.
pub const FAINT: f64 = 2.0;

/// What differs between two images of the same size and kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PixelDifference {
    pub pixels: u64,
    pub differing: u64,
    /// Colour: pixels that differ by more than [`FAINT`], which people can see.
    pub visible: u64,
    /// Colour: of any channel, in parts of 255; depth: metres; labels: none.
    pub greatest: Option<f64>,
    /// Depth: of the distance.
    pub greatest_share: Option<f64>,
    /// Labels: from, to, how many, most first.
    pub turned: Vec<(u32, u32, u64)>,
}

/// Compares two images; says why they cannot be compared.
pub fn compare_pixels(a: &Decoded, b: &Decoded) -> Result<PixelDifference, String> {
    if (a.width, a.height) != (b.width, b.height) {
        return Err(format!("{} x {} pixels became {} x {}", a.width, a.height, b.width, b.height));
    }
    let pixels = u64::from(a.width) * u64::from(a.height);
    let out = PixelDifference { pixels, ..PixelDifference::default() };
    match (&a.pixels, &b.pixels) {
        (Pixels::Rgb8(a), Pixels::Rgb8(b)) => Ok(colours(a, b, 3, 1.0, out)),
        (Pixels::Rgb16(a), Pixels::Rgb16(b)) => Ok(colours(a, b, 3, 257.0, out)),
        (Pixels::Gray16(a), Pixels::Gray16(b)) => Ok(colours(a, b, 1, 257.0, out)),
        (Pixels::Gray8(a), Pixels::Gray8(b)) => {
            let out = labels(a.iter().zip(b).map(|(a, b)| (u32::from(*a), u32::from(*b))), out);
            let apart = || a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)));
            let visible = apart().filter(|apart| *apart > FAINT).count() as u64;
            Ok(PixelDifference { greatest: apart().reduce(f64::max), visible, ..out })
        }
        (Pixels::Id32(a), Pixels::Id32(b)) => Ok(labels(a.iter().copied().zip(b.iter().copied()), out)),
        (Pixels::Float32(a), Pixels::Float32(b)) => Ok(depths(a, b, out)),
        _ => Err("they hold numbers of different kinds".to_owned()),
    }
}

fn colours<T: Copy + PartialEq + Into<f64>>(
    a: &[T],
    b: &[T],
    channels: usize,
    scale: f64,
    mut out: PixelDifference,
) -> PixelDifference {
    let mut greatest = 0.0f64;
    for (a, b) in a.chunks_exact(channels).zip(b.chunks_exact(channels)) {
        if a != b {
            out.differing += 1;
            let channel = a.iter().zip(b).map(|(a, b)| ((*a).into() - (*b).into()).abs());
            let own = channel.fold(0.0, f64::max);
            out.visible += u64::from(own > FAINT * scale);
            greatest = greatest.max(own);
        }
    }
    PixelDifference { greatest: Some(greatest / scale), ..out }
}

fn labels(pairs: impl Iterator<Item = (u32, u32)>, mut out: PixelDifference) -> PixelDifference {
    let mut turned: BTreeMap<(u32, u32), u64> = BTreeMap::new();
    for pair in pairs.filter(|(a, b)| a != b) {
        *turned.entry(pair).or_default() += 1;
    }
    out.differing = turned.values().sum();
    out.turned = turned.into_iter().map(|((from, to), count)| (from, to, count)).collect();
    out.turned.sort_by_key(|(from, to, count)| (std::cmp::Reverse(*count), *from, *to));
    out
}

fn depths(a: &[f32], b: &[f32], mut out: PixelDifference) -> PixelDifference {
    let (mut greatest, mut share) = (0.0f64, 0.0f64);
    for (a, b) in a.iter().zip(b).filter(|(a, b)| a.to_bits() != b.to_bits()) {
        out.differing += 1;
        let (a, b) = (f64::from(*a), f64::from(*b));
        // Something against nothing is infinitely far.
        let apart = if a == b { 0.0 } else { (a - b).abs() };
        (greatest, share) = (greatest.max(apart), share.max(apart / a.abs().max(b.abs()).max(1e-300)));
    }
    // Infinity over infinity.
    let share = if greatest.is_infinite() { f64::INFINITY } else { share };
    PixelDifference { greatest: Some(greatest), greatest_share: Some(share), ..out }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, pixels: Pixels) -> Decoded {
        Decoded { width, height: 1, pixels }
    }

    #[test]
    fn colours_are_measured_in_parts_of_255() {
        let (a, b) = (image(2, Pixels::Rgb8(vec![0, 0, 0, 9, 9, 9])), image(2, Pixels::Rgb8(vec![0, 0, 0, 9, 7, 10])));
        let found = compare_pixels(&a, &b).expect("the same size");
        assert_eq!((found.pixels, found.differing, found.visible, found.greatest), (2, 1, 0, Some(2.0)));
        let visible = image(2, Pixels::Rgb8(vec![3, 0, 0, 9, 7, 10]));
        assert_eq!(compare_pixels(&a, &visible).expect("the same size").visible, 1);
        let (a, b) = (image(1, Pixels::Gray16(vec![0])), image(1, Pixels::Gray16(vec![514])));
        assert_eq!(compare_pixels(&a, &b).expect("the same size").greatest, Some(2.0));
        assert_eq!(compare_pixels(&a, &a).expect("the same size").differing, 0);
        assert!(compare_pixels(&a, &image(2, Pixels::Gray16(vec![0, 0]))).is_err());
        assert!(compare_pixels(&a, &image(1, Pixels::Gray8(vec![0]))).is_err());
    }

    #[test]
    fn labels_are_counted_from_what_to_what() {
        let (a, b) = (image(4, Pixels::Id32(vec![1, 1, 2, 3])), image(4, Pixels::Id32(vec![1, 2, 1, 1])));
        let found = compare_pixels(&a, &b).expect("the same size");
        assert_eq!((found.differing, found.greatest), (3, None));
        assert_eq!(found.turned, [(1, 2, 1), (2, 1, 1), (3, 1, 1)]);
    }

    #[test]
    fn depths_are_metres_and_nothing_is_infinitely_far() {
        let nothing = f32::INFINITY;
        let (a, b) = (image(2, Pixels::Float32(vec![100.0, nothing])), image(2, Pixels::Float32(vec![101.0, nothing])));
        let found = compare_pixels(&a, &b).expect("the same size");
        assert_eq!((found.differing, found.greatest), (1, Some(1.0)));
        let gone = image(2, Pixels::Float32(vec![100.0, 5.0]));
        let found = compare_pixels(&a, &gone).expect("the same size");
        assert_eq!((found.greatest, found.greatest_share), (Some(f64::INFINITY), Some(f64::INFINITY)));
    }
}
