//! Cut-outs: a material's threshold of opacity → a texture whose holes are where alpha is under one half, which is what
//! the shaders test.

use std::collections::BTreeMap;
use std::sync::Arc;

use image::RgbaImage;

/// The scene's textures, and those of them again whose holes begin at another alpha than one half.
pub struct Textures {
    pub images: Vec<Arc<RgbaImage>>,
    moved: BTreeMap<(usize, u64), usize>,
}

impl Textures {
    pub fn new(images: impl Iterator<Item = Arc<RgbaImage>>) -> Textures {
        Textures { images: images.collect(), moved: BTreeMap::new() }
    }

    /// The number of the texture with holes under `least_alpha`, 0..1.
    pub fn with_holes_below(&mut self, texture: usize, least_alpha: f64) -> usize {
        if least_alpha == 0.5 {
            return texture;
        }
        let images = &mut self.images;
        *self.moved.entry((texture, least_alpha.to_bits())).or_insert_with(|| {
            let mut image = RgbaImage::clone(&images[texture]);
            image.pixels_mut().for_each(|pixel| pixel.0[3] = moved(pixel.0[3], least_alpha));
            images.push(Arc::new(image));
            images.len() - 1
        })
    }
}

/// Alpha on a scale on which `least` is one half: under it 0 to 127, from it on 128 to 255.
fn moved(alpha: u8, least: f64) -> u8 {
    let alpha = f64::from(alpha) / 255.0;
    if alpha < least {
        (alpha / least * 127.0).floor() as u8
    } else if least < 1.0 {
        (128.0 + (alpha - least) / (1.0 - least) * 127.0).floor() as u8
    } else {
        u8::MAX
    }
}

#[cfg(test)]
mod tests {
    use super::moved;

    #[test]
    fn holes_stay_holes_and_order_stays() {
        for least in [0.02, 0.3, 0.7, 0.95, 1.0] {
            let all: Vec<u8> = (0..=255).map(|alpha| moved(alpha, least)).collect();
            assert!(all.is_sorted());
            for (alpha, moved) in all.into_iter().enumerate() {
                assert_eq!(moved < 128, (alpha as f64) < least * 255.0, "{alpha} of {least}");
            }
        }
    }
}
