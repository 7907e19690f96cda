//! Images of a window → PNG files, and the text that puts them into a page.

use base64::Engine;
use image::{ExtendedColorType, ImageEncoder};

use crate::cost::metrics::Rgb;
use crate::cost::probe::{Images, Truth};

/// What differences are multiplied with to be seen.
pub const AMPLIFIED: f32 = 8.0;

/// An 8-bit colour picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub bytes: Vec<u8>,
}

impl Picture {
    fn new(images: &Images, pixels: impl Iterator<Item = [u8; 3]>) -> Picture {
        let bytes = pixels.flatten().collect();
        Picture { width: images.window.width, height: images.window.height, bytes }
    }

    /// As it looks.
    pub fn light(images: &Images) -> Picture {
        Picture::new(images, images.light.iter().map(|c| c.map(encoded)))
    }

    /// Difference of linear light, amplified: grey is none, brighter is too bright, darker too dark.
    pub fn difference(images: &Images, truth: &Truth) -> Picture {
        let channel = |a: f32, b: f32| (127.5 + (a.clamp(0.0, 1.0) - b.clamp(0.0, 1.0)) * AMPLIFIED * 127.5) as u8;
        let pixel = |(a, b): (&Rgb, &Rgb)| std::array::from_fn(|k| channel(a[k], b[k]));
        Picture::new(images, images.light.iter().zip(&truth.images.light).map(pixel))
    }

    /// Shadow where there should be none is blue, missing shadow is red; shadow is dark, sun is light, and what the sun
    /// does not reach anyway is grey.
    pub fn shadows(images: &Images, truth: &Truth) -> Option<Picture> {
        let (mask, wanted) = (images.shadow.as_ref()?, truth.images.shadow.as_ref()?);
        let pixel = |(a, b): (&Option<bool>, &Option<bool>)| match (a, b) {
            (Some(true), Some(false)) => [30, 90, 255],
            (Some(false), Some(true)) => [235, 40, 30],
            (Some(true), Some(true)) => [70, 70, 74],
            (Some(false), Some(false)) => [228, 228, 224],
            _ => [150, 150, 150],
        };
        Some(Picture::new(images, mask.iter().zip(wanted).map(pixel)))
    }

    /// Pixels with a wrong object's number are red on the picture in grey.
    pub fn labels(images: &Images, truth: &Truth) -> Picture {
        let pixel = |i: usize| {
            let grey = encoded(images.plain[i]);
            if images.labels[i] == truth.images.labels[i] { [grey / 2 + 96; 3] } else { [235, 40, 30] }
        };
        Picture::new(images, (0..images.labels.len()).map(pixel))
    }

    /// The bytes of a PNG file.
    pub fn png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        image::codecs::png::PngEncoder::new(&mut bytes)
            .write_image(&self.bytes, self.width, self.height, ExtendedColorType::Rgb8)
            .expect("memory takes every picture");
        bytes
    }

    /// For the `src` of an `<img>`.
    pub fn data_uri(&self) -> String {
        format!("data:image/png;base64,{}", base64::engine::general_purpose::STANDARD.encode(self.png()))
    }
}

/// The sRGB byte of linear light.
fn encoded(light: f32) -> u8 {
    let light = f64::from(light.clamp(0.0, 1.0));
    let encoded = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Tile;

    #[test]
    fn colours_say_what_is_wrong() {
        let window = Tile { x: 0, y: 0, width: 2, height: 1 };
        let images = |light: f32, label: u32, shadow: bool| Images {
            window,
            light: vec![[light; 3], [0.5; 3]],
            plain: vec![light, 0.5],
            labels: vec![label, 1],
            shadow: Some(vec![Some(shadow), None]),
        };
        let truth = Truth { images: images(0.25, 1, false), standard_error: vec![[0.0; 3]; 2], samples: 16 };
        let drawn = images(0.3, 2, true);
        assert_eq!(Picture::difference(&drawn, &truth).bytes, [178, 178, 178, 127, 127, 127]);
        assert_eq!(Picture::shadows(&drawn, &truth).expect("masks").bytes, [30, 90, 255, 150, 150, 150]);
        assert_eq!(Picture::labels(&drawn, &truth).bytes[..3], [235, 40, 30]);
        assert_eq!(Picture::light(&drawn).bytes[3..], [188; 3]);
        let read = image::load_from_memory(&Picture::light(&drawn).png()).expect("it is a PNG file").to_rgb8();
        assert_eq!(read.as_raw(), &Picture::light(&drawn).bytes);
    }
}
