//! Tiles: an image larger than a render target is drawn piece by piece; and the matrices that place the pieces.
//!
//! All tiles of a *panel* share one viewport, moved by whole samples: clipping and rounding are then the same for
//! each, and a triangle covers the same samples whichever tile shows it. A panel is the whole image wherever the
//! adapter's largest viewport allows.

use glam::DVec3;

use crate::plan::demand::{Camera, Projection};
use crate::plan::light::{LightFrame, view_planes};

/// Samples per side of the largest tile: 2048² samples of radiance and depth take 50 MB. Larger tiles were no faster
/// on llvmpipe (3072² pixels of 2 × 2 samples).
pub const TILE_SAMPLES: u32 = 2048;

/// A rectangle of pixels of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

impl Tile {
    /// First column to the right of it.
    pub fn right(&self) -> u32 {
        self.x + self.width
    }

    /// First row below it.
    pub fn bottom(&self) -> u32 {
        self.y + self.height
    }
}

/// Pixels per side of a tile: as few equal tiles as keep within `limit` samples.
pub fn tile_size(image: u32, supersample: u32, limit: u32) -> u32 {
    let most = (limit / supersample).max(1);
    image.div_ceil(image.div_ceil(most).max(1))
}

/// Tiles of `tile` pixels that cover the image, row by row.
pub fn tiles(image: (u32, u32), tile: (u32, u32)) -> Vec<Tile> {
    let starts = |image: u32, tile: u32| (0..image).step_by(tile as usize);
    let row = |y: u32| {
        starts(image.0, tile.0).map(move |x| Tile {
            x,
            y,
            width: tile.0.min(image.0 - x),
            height: tile.1.min(image.1 - y),
        })
    };
    starts(image.1, tile.1).flat_map(row).collect()
}

/// What windows show of each tile; all of it if there are no windows.
pub fn within(tiles: Vec<Tile>, windows: &[Tile]) -> Vec<Tile> {
    if windows.is_empty() {
        return tiles;
    }
    let common = |tile: &Tile, window: &Tile| {
        let (x, y) = (tile.x.max(window.x), tile.y.max(window.y));
        let (right, bottom) = (tile.right().min(window.right()), tile.bottom().min(window.bottom()));
        (right > x && bottom > y).then(|| Tile { x, y, width: right - x, height: bottom - y })
    };
    tiles.iter().flat_map(|tile| windows.iter().filter_map(|window| common(tile, window))).collect()
}

/// The panel that holds `tile`: whole tiles of `size` pixels, at most `limit` samples per side.
pub fn panel(image: (u32, u32), tile: Tile, size: (u32, u32), supersample: u32, limit: u32) -> Tile {
    let side = |image: u32, at: u32, size: u32| {
        let panel = size * (limit / (size * supersample)).max(1);
        let start = at / panel * panel;
        (start, panel.min(image - start))
    };
    let (x, width) = side(image.0, tile.x, size.0);
    let (y, height) = side(image.1, tile.y, size.1);
    Tile { x, y, width, height }
}

/// `View` of `shaders/common.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ViewUniform {
    pub clip_from_origin: [[f32; 4]; 4],
    pub forward: [f32; 4],
    pub to_origin: [f32; 4],
    pub image_half: [f32; 2],
    pub panel_center: [f32; 2],
    pub panel_half: [f32; 2],
    pub front: f32,
    pub unused: f32,
}

fn row(axis: DVec3, constant: f64) -> [f32; 4] {
    axis.extend(constant).as_vec4().to_array()
}

/// View of a panel.
pub fn panel_view(camera: &Camera, far: f64, panel: Tile, supersample: u32) -> ViewUniform {
    let parallel = matches!(camera.projection, Projection::Orthographic { .. });
    let (to_origin, range) = (camera.to_origin(), far - camera.near);
    // Of a point from the origin: how far it is from the camera along an axis, times a factor.
    let along = |axis: DVec3, factor: f64| row(axis * factor, axis.dot(to_origin) * factor);
    let beyond = |factor: f64| row(-camera.forward * factor, (far - camera.forward.dot(to_origin)) * factor);
    let clip_from_origin = match camera.projection {
        Projection::Perspective { tan_x, tan_y } => [
            along(camera.right, 1.0 / tan_x),
            along(camera.up, 1.0 / tan_y),
            beyond(camera.near / range),
            along(camera.forward, 1.0),
        ],
        Projection::Orthographic { half_x, half_y } => [
            along(camera.right, 1.0 / half_x),
            along(camera.up, 1.0 / half_y),
            beyond(1.0 / range),
            row(DVec3::ZERO, 1.0),
        ],
    };
    let half = |samples: u32| f64::from(samples) / 2.0;
    let image_half = [half(camera.width * supersample), half(camera.height * supersample)];
    let panel_half = [half(panel.width * supersample), half(panel.height * supersample)];
    let right = f64::from(panel.x * supersample) + panel_half[0] - image_half[0];
    let down = f64::from(panel.y * supersample) + panel_half[1] - image_half[1];
    ViewUniform {
        clip_from_origin,
        forward: row(camera.forward, if parallel { 1.0 } else { 0.0 }),
        to_origin: row(to_origin, 0.0),
        image_half: image_half.map(|v| v as f32),
        panel_center: [right as f32, -down as f32],
        panel_half: panel_half.map(|v| v as f32),
        front: if parallel { 0.5 } else { (camera.near * 0.5) as f32 },
        unused: 0.0,
    }
}

/// View of a whole shadow map of positions from `origin`; row 0 of the map is the least `v`.
pub fn light_view(light: &LightFrame, origin: DVec3) -> ViewUniform {
    let [u, v, depth] = light_rows(light, origin);
    let to_clip = |row: [f64; 4], scale: f64| {
        let [x, y, z, w] = row.map(|c| c * 2.0 * scale / f64::from(light.size));
        [x as f32, y as f32, z as f32, (w - scale) as f32]
    };
    let half = light.size as f32 / 2.0;
    ViewUniform {
        clip_from_origin: [to_clip(u, 1.0), to_clip(v, -1.0), depth.map(|c| c as f32), [0.0, 0.0, 0.0, 1.0]],
        forward: row(-light.direction, 1.0),
        to_origin: [0.0; 4],
        image_half: [half; 2],
        panel_center: [0.0; 2],
        panel_half: [half; 2],
        front: 0.5,
        unused: 0.0,
    }
}

/// Rows from metres about `origin` to texel column, texel row and depth of the map.
pub fn light_rows(light: &LightFrame, origin: DVec3) -> [[f64; 4]; 3] {
    let offset = origin - light.anchor;
    let range = light.high - light.low;
    let rows = [
        (light.u / light.texel.x, offset.dot(light.u) / light.texel.x - light.corner.x),
        (light.v / light.texel.y, offset.dot(light.v) / light.texel.y - light.corner.y),
        (light.direction / range, (offset.dot(light.direction) - light.low) / range),
    ];
    rows.map(|(axis, constant)| [axis.x, axis.y, axis.z, constant])
}

/// Half spaces `n·p + d ≥ 0`, `p` from the camera, that hold all that a tile (grown by a pixel) shows.
pub fn tile_planes(camera: &Camera, tile: Tile) -> Vec<(DVec3, f64)> {
    let [x0, x1] = [f64::from(tile.x) - 1.0, f64::from(tile.x + tile.width) + 1.0]
        .map(|x| 2.0 * x / f64::from(camera.width) - 1.0);
    let [y1, y0] = [f64::from(tile.y) - 1.0, f64::from(tile.y + tile.height) + 1.0]
        .map(|y| 1.0 - 2.0 * y / f64::from(camera.height));
    let near = view_planes(camera)[0];
    let (right, up, forward) = (camera.right, camera.up, camera.forward);
    match camera.projection {
        Projection::Perspective { tan_x, tan_y } => vec![
            near,
            (right - forward * (x0 * tan_x), 0.0),
            (forward * (x1 * tan_x) - right, 0.0),
            (up - forward * (y0 * tan_y), 0.0),
            (forward * (y1 * tan_y) - up, 0.0),
        ],
        Projection::Orthographic { half_x, half_y } => {
            vec![near, (right, -x0 * half_x), (-right, x1 * half_x), (up, -y0 * half_y), (-up, y1 * half_y)]
        }
    }
}

/// The same of a shadow map: its four sides and the end away from the sun.
pub fn light_planes(light: &LightFrame, camera: DVec3) -> Vec<(DVec3, f64)> {
    let [u, v, depth] = light_rows(light, camera);
    let size = f64::from(light.size);
    let side = |r: [f64; 4]| {
        let axis = DVec3::new(r[0], r[1], r[2]);
        [(axis, r[3]), (-axis, size - r[3])]
    };
    [&side(u)[..], &side(v), &[(DVec3::new(depth[0], depth[1], depth[2]), depth[3])]].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_whole_tiles_and_within_the_limit() {
        let (image, size, limit) = ((1000, 700), (60, 50), 400);
        for tile in tiles(image, size) {
            let panel = panel(image, tile, size, 2, limit);
            assert!(panel.width * 2 <= limit && panel.height * 2 <= limit);
            assert!(panel.x <= tile.x && tile.x + tile.width <= panel.x + panel.width);
            assert!(panel.y <= tile.y && tile.y + tile.height <= panel.y + panel.height);
            assert_eq!((panel.x % 60, panel.y % 50), (0, 0));
        }
        assert_eq!(panel((64, 64), Tile { x: 0, y: 0, width: 64, height: 64 }, (64, 64), 2, 8192).width, 64);
    }

    #[test]
    fn windows_take_their_pixels_from_every_tile() {
        let window = |x, y, width, height| Tile { x, y, width, height };
        let parts = within(tiles((100, 70), (32, 32)), &[window(16, 16, 32, 32), window(90, 60, 30, 30)]);
        let area: u32 = parts.iter().map(|t| t.width * t.height).sum();
        // Each lies on four tiles, the second beyond the image's corner.
        assert_eq!((parts.len(), area), (8, 32 * 32 + 10 * 10));
        assert_eq!(within(tiles((100, 70), (32, 32)), &[]).len(), 12);
    }

    #[test]
    fn tiles_cover_each_pixel_once() {
        for (image, limit, k) in [((100, 70), 64, 2), ((1, 1), 64, 4), ((64, 64), 64, 1), ((65, 3), 64, 1)] {
            let size = (tile_size(image.0, k, limit), tile_size(image.1, k, limit));
            assert!(size.0 * k <= limit && size.1 * k <= limit);
            let area: u32 = tiles(image, size).iter().map(|t| t.width * t.height).sum();
            assert_eq!(area, image.0 * image.1);
        }
    }
}
