//! Picture: what one drawing came to, as the window shows it. In: the frame of a demand ([`super::take`]). Out: RGBA
//! pixels, the object under each pixel, distances; a split of two pictures; the outline of an object.

use std::sync::Arc;

use super::take::{DISTANCES, INSTANCES, Kind, PICTURE};
use super::viewpoint::{Pixel, point_at};
use crate::frame::{Frame, Pixels};
use crate::plan::demand::Camera;

/// One picture.
#[derive(Clone, Debug)]
pub struct Picture {
    pub kind: Kind,
    pub camera: Camera,
    /// Opaque sRGB, row by row.
    pub rgba: Arc<[u8]>,
    /// Object numbers; empty in drafts.
    pub instances: Vec<u32>,
    /// Metres along the camera's axis; empty in drafts.
    pub distances: Vec<f32>,
}

impl Picture {
    pub fn new(kind: Kind, camera: Camera, frame: Frame) -> Picture {
        let mut picture = Picture { kind, camera, rgba: [].into(), instances: Vec::new(), distances: Vec::new() };
        for image in frame.images {
            match (image.pass.as_str(), image.pixels) {
                (PICTURE, pixels) => picture.rgba = rgba(&pixels),
                (INSTANCES, Pixels::Id32(ids)) => picture.instances = ids,
                (DISTANCES, Pixels::Float32(metres)) => picture.distances = metres,
                (pass, _) => unreachable!("a take asks for no {pass} of another kind"),
            }
        }
        picture
    }

    pub fn size(&self) -> (u32, u32) {
        (self.camera.width, self.camera.height)
    }

    fn index(&self, at: Pixel) -> Option<usize> {
        let (width, height) = self.size();
        let inside = at.x >= 0.0 && at.y >= 0.0 && at.x < f64::from(width) && at.y < f64::from(height);
        inside.then(|| at.y as usize * width as usize + at.x as usize)
    }

    /// The object under a point; 0 is none.
    pub fn instance(&self, at: Pixel) -> Option<u32> {
        self.instances.get(self.index(at)?).copied()
    }

    /// What is seen at a point, world metres; `None` where nothing is, and in drafts.
    pub fn point(&self, at: Pixel) -> Option<glam::DVec3> {
        let distance = f64::from(*self.distances.get(self.index(at)?)?);
        distance.is_finite().then(|| point_at(&self.camera, at, distance))
    }
}

/// Images of any kind as the window shows them: single bands are grey, 16 bits are encoded to sRGB.
fn rgba(pixels: &Pixels) -> Arc<[u8]> {
    let opaque = |[r, g, b]: [u8; 3]| [r, g, b, u8::MAX];
    match pixels {
        Pixels::Rgb8(bytes) => bytes.as_chunks::<3>().0.iter().flat_map(|&rgb| opaque(rgb)).collect(),
        Pixels::Gray8(bytes) => bytes.iter().flat_map(|&grey| opaque([grey; 3])).collect(),
        Pixels::Rgb16(words) => words.as_chunks::<3>().0.iter().flat_map(|rgb| opaque(rgb.map(encoded))).collect(),
        Pixels::Gray16(words) => words.iter().flat_map(|&grey| opaque([encoded(grey); 3])).collect(),
        Pixels::Id32(_) | Pixels::Float32(_) => unreachable!("a take's picture is a colour image or a mask"),
    }
}

/// sRGB (IEC 61966-2-1) of linear light; 65535 is white.
fn encoded(linear: u16) -> u8 {
    let linear = f64::from(linear) / 65535.0;
    let value = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 };
    (255.0 * value).round() as u8
}

/// The left picture up to the bar, the right one from there; `bar` is a share of the width. Both have the same size.
pub fn split(left: &[u8], right: &[u8], width: u32, bar: f64) -> Vec<u8> {
    let row = 4 * width as usize;
    let at = 4 * bar_column(width, bar) as usize;
    let rows = left.chunks_exact(row).zip(right.chunks_exact(row));
    rows.flat_map(|(left, right)| left[..at].iter().chain(&right[at..])).copied().collect()
}

/// The first column that shows the right picture.
pub fn bar_column(width: u32, bar: f64) -> u32 {
    (f64::from(width) * bar.clamp(0.0, 1.0)).round() as u32
}

/// Marks where an object meets others: RGBA of the size of `instances`, clear elsewhere.
pub fn outline(instances: &[u32], width: u32, object: u32, colour: [u8; 4]) -> Vec<u8> {
    let width = width as usize;
    let height = instances.len() / width.max(1);
    let is = |x: usize, y: usize| instances[y * width + x] == object;
    let mut out = vec![0; 4 * instances.len()];
    for y in 0..height {
        for x in 0..width {
            if is(x, y) {
                continue;
            }
            let (left, right) = (x.saturating_sub(2), (x + 2).min(width - 1));
            let (top, bottom) = (y.saturating_sub(2), (y + 2).min(height - 1));
            if (top..=bottom).any(|y| (left..=right).any(|x| is(x, y))) {
                out[4 * (y * width + x)..][..4].copy_from_slice(&colour);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::frame::Image;
    use crate::plan::demand::Projection;

    fn picture(width: u32, height: u32, instances: Vec<u32>) -> Picture {
        let camera = Camera {
            position: DVec3::new(0.0, 100.0, 0.0),
            right: DVec3::X,
            up: -DVec3::Z,
            forward: -DVec3::Y,
            projection: Projection::Orthographic { half_x: 10.0, half_y: 10.0 },
            width,
            height,
            near: 1.0,
        };
        let count = (width * height) as usize;
        let image = |pass: &str, pixels| Image { pass: pass.to_owned(), pixels };
        let images = vec![
            image(PICTURE, Pixels::Rgb8(vec![7; 3 * count])),
            image(INSTANCES, Pixels::Id32(instances)),
            image(DISTANCES, Pixels::Float32((0..count).map(|i| if i == 0 { f32::INFINITY } else { 40.0 }).collect())),
        ];
        Picture::new(Kind::After, camera, Frame { view: "v".to_owned(), width, height, images })
    }

    #[test]
    fn a_pixel_tells_its_object_and_place() {
        let picture = picture(4, 2, vec![0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(picture.instance(Pixel { x: 2.9, y: 1.1 }), Some(6));
        for (x, y) in [(-0.1, 0.0), (4.0, 0.0), (0.0, 2.0)] {
            assert_eq!(picture.instance(Pixel { x, y }), None);
        }
        let point = picture.point(Pixel { x: 4.0 - 1e-9, y: 1.0 }).expect("something is there");
        assert!((point - DVec3::new(10.0, 60.0, 0.0)).length() < 1e-6, "{point}");
        assert_eq!(picture.point(Pixel { x: 0.5, y: 0.5 }), None, "nothing is there");
        assert_eq!(&picture.rgba[..4], [7, 7, 7, 255]);
    }

    #[test]
    fn an_outline_runs_around_its_object() {
        let mut instances = vec![1; 9 * 9];
        instances[4 * 9 + 4] = 2;
        let marked = outline(&instances, 9, 2, [255, 200, 0, 255]);
        let at = |x: usize, y: usize| marked[4 * (9 * y + x) + 3];
        assert_eq!((at(4, 4), at(3, 4), at(2, 2), at(1, 4), at(6, 6), at(7, 4)), (0, 255, 255, 0, 255, 0));
    }

    #[test]
    fn linear_light_is_encoded() {
        assert_eq!((encoded(0), encoded(u16::MAX), encoded(14028)), (0, 255, 128));
    }

    proptest! {
        #[test]
        fn a_split_is_left_up_to_the_bar_and_right_from_there(width in 1u32..40, height in 1u32..5, bar in -0.5..1.5) {
            let count = (4 * width * height) as usize;
            let whole = split(&vec![1; count], &vec![2; count], width, bar);
            prop_assert_eq!(whole.len(), count);
            let column = bar_column(width, bar);
            for (i, pixel) in whole.chunks_exact(4).enumerate() {
                let expected = if (i as u32 % width) < column { [1; 4] } else { [2; 4] };
                prop_assert_eq!(pixel, expected);
            }
        }
    }
}
