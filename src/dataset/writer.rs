//! One image as one file. In: pixels and a path without suffix. Out: a PNG (colour, masks, classes) or a TIFF
//! (32-bit instance numbers, 32-bit float depth), whole or not at all, and its content hash.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::error::{UnsupportedError, UnsupportedErrorKind};
use image::{ExtendedColorType, ImageEncoder, ImageError, ImageFormat};
use sha2::{Digest, Sha256};
use tiff::encoder::colortype::{Gray32, Gray32Float};
use tiff::encoder::{Compression, DeflateLevel, TiffEncoder};

use crate::frame::Pixels;
use crate::output::{OutputError, write_bytes};

/// Why a dataset could not be written.
#[derive(Debug, thiserror::Error)]
pub enum DatasetError {
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error("cannot encode {}: {source}", path.display())]
    Png { path: PathBuf, source: image::ImageError },
    #[error("cannot encode {}: {source}", path.display())]
    Tiff { path: PathBuf, source: tiff::TiffError },
}

/// A file of the dataset, by its path below the dataset's folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub struct WrittenFile {
    pub path: String,
    pub sha256: String,
}

/// SHA-256 in lower-case hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}

/// Writes bytes under `folder/name` and gives the line for the manifest.
pub fn write_file(folder: &Path, name: &Path, bytes: &[u8]) -> Result<WrittenFile, DatasetError> {
    let path = folder.join(name);
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent).map_err(|source| OutputError::new(parent, source))?;
    }
    write_bytes(&path, bytes)?;
    let path = name.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
    Ok(WrittenFile { path, sha256: sha256(bytes) })
}

/// Encodes and writes one image; `name` has no suffix.
pub fn write_image(
    folder: &Path,
    name: &Path,
    (width, height): (u32, u32),
    pixels: &Pixels,
) -> Result<WrittenFile, DatasetError> {
    let with_suffix = |suffix: &str| {
        let mut name = name.as_os_str().to_owned();
        name.push(suffix);
        PathBuf::from(name)
    };
    let mut bytes = Vec::new();
    let name = match pixels {
        Pixels::Rgb8(_) | Pixels::Gray8(_) | Pixels::Rgb16(_) | Pixels::Gray16(_) => {
            let name = with_suffix(".png");
            bytes = encode_png((width, height), pixels)
                .map_err(|source| DatasetError::Png { path: folder.join(&name), source })?;
            name
        }
        Pixels::Id32(data) => {
            let name = with_suffix(".tif");
            tiff::<Gray32>(&mut bytes, data, (width, height))
                .map_err(|source| DatasetError::Tiff { path: folder.join(&name), source })?;
            name
        }
        Pixels::Float32(data) => {
            let name = with_suffix(".tif");
            tiff::<Gray32Float>(&mut bytes, data, (width, height))
                .map_err(|source| DatasetError::Tiff { path: folder.join(&name), source })?;
            name
        }
    };
    write_file(folder, &name, &bytes)
}

/// Colours, masks and classes as a PNG.
///
/// # Errors
/// Also for instance numbers and depths, which PNG cannot hold.
pub fn encode_png((width, height): (u32, u32), pixels: &Pixels) -> image::ImageResult<Vec<u8>> {
    // The encoder takes words in the machine's order and writes them as PNG has them, the higher byte first.
    let (data, color): (&[u8], _) = match pixels {
        Pixels::Rgb8(data) => (data, ExtendedColorType::Rgb8),
        Pixels::Gray8(data) => (data, ExtendedColorType::L8),
        Pixels::Rgb16(data) => (bytemuck::cast_slice(data), ExtendedColorType::Rgb16),
        Pixels::Gray16(data) => (bytemuck::cast_slice(data), ExtendedColorType::L16),
        Pixels::Id32(_) | Pixels::Float32(_) => {
            let kind = UnsupportedErrorKind::GenericFeature("numbers of 32 bits".to_owned());
            let error = UnsupportedError::from_format_and_kind(ImageFormat::Png.into(), kind);
            return Err(ImageError::Unsupported(error));
        }
    };
    let mut bytes = Vec::new();
    png(&mut bytes, data, (width, height), color)?;
    Ok(bytes)
}

fn png(out: &mut Vec<u8>, data: &[u8], (w, h): (u32, u32), color: ExtendedColorType) -> image::ImageResult<()> {
    let mut writer = BufWriter::new(out);
    let filter = if color == ExtendedColorType::L8 { FilterType::NoFilter } else { FilterType::Sub };
    PngEncoder::new_with_quality(&mut writer, CompressionType::Fast, filter).write_image(data, w, h, color)?;
    writer.flush().map_err(image::ImageError::IoError)
}

fn tiff<C>(out: &mut Vec<u8>, data: &[C::Inner], (w, h): (u32, u32)) -> tiff::TiffResult<()>
where
    C: tiff::encoder::colortype::ColorType,
    [C::Inner]: tiff::encoder::TiffValue,
{
    let mut writer = std::io::Cursor::new(out);
    TiffEncoder::new(&mut writer)?
        .with_compression(Compression::Deflate(DeflateLevel::Fast))
        .write_image::<C>(w, h, data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_image_reads_back_as_written() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let write = |name: &str, pixels: &Pixels| {
            let file = write_image(folder.path(), Path::new(name), (3, 2), pixels).expect("the folder is writable");
            (folder.path().join(&file.path), file)
        };
        let rgb: Vec<u8> = (0..18).collect();
        let (path, file) = write("a/b", &Pixels::Rgb8(rgb.clone()));
        assert_eq!(file.path, "a/b.png");
        assert_eq!(image::open(&path).expect("a PNG").to_rgb8().into_raw(), rgb);
        assert_eq!(file.sha256, sha256(&std::fs::read(&path).expect("written")));
        let (path, _) = write("mask", &Pixels::Gray8(vec![0, 255, 0, 255, 255, 0]));
        assert_eq!(image::open(path).expect("a PNG").to_luma8().into_raw(), [0, 255, 0, 255, 255, 0]);
        let words: Vec<u16> = (0..18).map(|i| i * 3641 + 5).collect();
        let (path, _) = write("rgb16", &Pixels::Rgb16(words.clone()));
        match image::open(path).expect("a PNG") {
            image::DynamicImage::ImageRgb16(read) => assert_eq!(read.into_raw(), words),
            other => panic!("16-bit colour came back as {other:?}"),
        }
        let (path, _) = write("gray16", &Pixels::Gray16(words[..6].to_vec()));
        match image::open(path).expect("a PNG") {
            image::DynamicImage::ImageLuma16(read) => assert_eq!(read.into_raw(), words[..6]),
            other => panic!("16-bit grey came back as {other:?}"),
        }
        let ids = vec![0, 1, 70_000, u32::MAX, 5, 6];
        let (path, _) = write("ids", &Pixels::Id32(ids.clone()));
        let mut decoder = tiff::decoder::Decoder::new(std::fs::File::open(path).expect("written")).expect("a TIFF");
        match decoder.read_image().expect("whole") {
            tiff::decoder::DecodingResult::U32(read) => assert_eq!(read, ids),
            other => panic!("ids came back as {other:?}"),
        }
    }
}
