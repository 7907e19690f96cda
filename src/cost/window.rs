//! Window: a view and its objects → small parts of its image in which much happens, always the same ones.

use crate::gpu::Tile;
use crate::plan::demand::{Camera, Projection};
use crate::plan::summary::ObjectSummary;
use crate::scene::SceneClass;

/// Windows of one view, the busiest first: cells of a grid over the image, by how many buildings have their middle in
/// them; of equal ones the upper and left first. A busy window has more edges and shadows than the image on average, so
/// what holds there holds for the image. The same on every machine: nothing is drawn for it.
pub fn windows(camera: &Camera, objects: &[ObjectSummary], shown: &[bool], side: u32, count: usize) -> Vec<Tile> {
    let fitting = |pixels: u32| side.min((pixels / 2).max(1));
    let (width, height) = (fitting(camera.width), fitting(camera.height));
    let (columns, rows) = (camera.width / width, camera.height / height);
    let mut buildings = vec![0usize; (columns * rows) as usize];
    for (object, _) in objects.iter().zip(shown).filter(|(o, shown)| **shown && o.class == SceneClass::Building as u8) {
        let Some((x, y)) = object.bounds.and_then(|(low, high)| place(camera, (low + high) / 2.0)) else { continue };
        let (column, row) = ((x / f64::from(width)) as u32, (y / f64::from(height)) as u32);
        if x >= 0.0 && y >= 0.0 && column < columns && row < rows {
            buildings[(row * columns + column) as usize] += 1;
        }
    }
    let mut cells: Vec<u32> = (0..columns * rows).collect();
    cells.sort_by_key(|&cell| (std::cmp::Reverse(buildings[cell as usize]), cell));
    let tile = |cell: u32| Tile { x: cell % columns * width, y: cell / columns * height, width, height };
    cells.into_iter().take(count).map(tile).collect()
}

/// Where a point lies on the image, in pixels from its upper left corner; `None` behind the camera.
fn place(camera: &Camera, point: glam::DVec3) -> Option<(f64, f64)> {
    let from_eye = point - camera.position;
    let depth = from_eye.dot(camera.forward);
    let (half_x, half_y) = match camera.projection {
        Projection::Perspective { tan_x, tan_y } => (tan_x * depth, tan_y * depth),
        Projection::Orthographic { half_x, half_y } => (half_x, half_y),
    };
    let x = (1.0 + from_eye.dot(camera.right) / half_x) / 2.0 * f64::from(camera.width);
    let y = (1.0 - from_eye.dot(camera.up) / half_y) / 2.0 * f64::from(camera.height);
    (depth > 0.0).then_some((x, y))
}

/// The camera of a window for the reference renderer, which takes slanted ones: its rays through the window's pixels
/// are those of the view's camera. `forward` is no unit vector, but its component along the view's is 1, so depth stays
/// what it is.
pub fn camera_of(camera: &Camera, window: Tile) -> Camera {
    let share = |at: u32, size: u32, all: u32| {
        let all = f64::from(all);
        ((2.0 * f64::from(at) + f64::from(size)) / all - 1.0, f64::from(size) / all)
    };
    let (x, wide) = share(window.x, window.width, camera.width);
    let (y, high) = share(window.y, window.height, camera.height);
    let moved = |half_x: f64, half_y: f64| camera.right * (x * half_x) - camera.up * (y * half_y);
    let mut part = Camera { width: window.width, height: window.height, ..*camera };
    match camera.projection {
        Projection::Perspective { tan_x, tan_y } => {
            part.forward += moved(tan_x, tan_y);
            part.projection = Projection::Perspective { tan_x: tan_x * wide, tan_y: tan_y * high };
        }
        Projection::Orthographic { half_x, half_y } => {
            part.position += moved(half_x, half_y);
            part.projection = Projection::Orthographic { half_x: half_x * wide, half_y: half_y * high };
        }
    }
    part
}

/// The part of an image of the view's width that a window shows.
pub fn crop<T: Copy>(pixels: &[T], width: u32, window: Tile) -> Vec<T> {
    let row = |y: u32| &pixels[(y * width + window.x) as usize..][..window.width as usize];
    (window.y..window.bottom()).flat_map(row).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn camera(projection: Projection) -> Camera {
        Camera {
            position: DVec3::new(3.0, 100.0, -5.0),
            right: DVec3::X,
            up: DVec3::NEG_Z,
            forward: DVec3::NEG_Y,
            projection,
            width: 80,
            height: 60,
            near: 1.0,
        }
    }

    fn building(x: f64, z: f64) -> ObjectSummary {
        let middle = DVec3::new(x, 0.0, z);
        let bounds = Some((middle - 1.0, middle + 1.0));
        ObjectSummary {
            bounds,
            class: SceneClass::Building as u8,
            instance: 2,
            level: 0,
            triangles: 12,
            surfaces: Vec::new(),
        }
    }

    #[test]
    fn the_busiest_cells_come_first() {
        let camera = camera(Projection::Orthographic { half_x: 40.0, half_y: 30.0 });
        // One pixel is a metre; the image's upper left corner lies at x = -37, z = -35.
        let objects = [building(-20.0, -20.0), building(30.0, 10.0), building(31.0, 12.0), building(500.0, 0.0)];
        let found = windows(&camera, &objects, &[true; 4], 20, 3);
        assert_eq!(found[0], Tile { x: 60, y: 40, width: 20, height: 20 });
        assert_eq!(found[1], Tile { x: 0, y: 0, width: 20, height: 20 });
        assert_eq!(found[2], Tile { x: 20, y: 0, width: 20, height: 20 });
        let hidden = windows(&camera, &objects, &[true, false, false, true], 20, 1);
        assert_eq!(hidden[0], found[1]);
        assert_eq!(windows(&camera, &objects, &[true; 4], 500, 9).len(), 4, "small images have four quarters");
    }

    #[test]
    fn rays_of_a_window_are_those_of_the_view() {
        let window = Tile { x: 16, y: 40, width: 16, height: 20 };
        for projection in [
            Projection::Perspective { tan_x: 0.4, tan_y: 0.3 },
            Projection::Orthographic { half_x: 40.0, half_y: 30.0 },
        ] {
            let camera = camera(projection);
            let part = camera_of(&camera, window);
            let (depth, x, y) = (70.0, 5.25, 11.5);
            let point = |camera: &Camera, x: f64, y: f64| {
                let across = 2.0 * x / f64::from(camera.width) - 1.0;
                let up = 1.0 - 2.0 * y / f64::from(camera.height);
                match camera.projection {
                    Projection::Perspective { tan_x, tan_y } => {
                        let way = camera.forward + camera.right * (across * tan_x) + camera.up * (up * tan_y);
                        camera.position + way * depth
                    }
                    Projection::Orthographic { half_x, half_y } => {
                        let from = camera.right * (across * half_x) + camera.up * (up * half_y);
                        camera.position + from + camera.forward * depth
                    }
                }
            };
            let (wanted, found) = (point(&camera, x + 16.0, y + 40.0), point(&part, x, y));
            assert!((wanted - found).length() < 1e-12, "{wanted} {found}");
            let (px, py) = place(&camera, wanted).expect("it is in front");
            assert!((px - x - 16.0).abs() < 1e-9 && (py - y - 40.0).abs() < 1e-9, "{px} {py}");
        }
    }

    #[test]
    fn crops_are_rows_of_the_image() {
        let image: Vec<usize> = (0..12).collect();
        assert_eq!(crop(&image, 4, Tile { x: 1, y: 1, width: 2, height: 2 }), [5, 6, 9, 10]);
    }
}
