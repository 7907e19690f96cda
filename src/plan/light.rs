//! Light frame: the orthographic frame of a shadow map, fitted to what a camera sees.
//!
//! Along `u` and `v` it covers the receivers, that is the part of the scene's box inside the view volume; along the
//! sun it covers every object, so casters outside the image still throw shadows into it. No limit on low sun is
//! needed: the map is as wide as the receivers whatever the length of the shadows, and its texels are narrowed along
//! the sun's way on the ground by the fit.

use glam::{DVec2, DVec3};

use super::demand::{Camera, Projection};

/// Texels around the receivers, for the widest filter.
const BORDER: f64 = 8.0;

/// An orthographic map seen from the sun. A point `p` lies at texel `((p - anchor)·u / texel.x - corner.x, …)` and at
/// depth `((p - anchor)·direction - low) / (high - low)`, 1 nearest to the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightFrame {
    /// Least corner of the scene: the frame moves with it, so shifted scenes have equal shadows.
    pub anchor: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    /// Towards the sun; `u × v = direction`.
    pub direction: DVec3,
    /// Metres per texel along `u` and `v`.
    pub texel: DVec2,
    /// First texel of the map in whole texels from the anchor: maps of one texel size do not swim.
    pub corner: DVec2,
    /// Texels per side.
    pub size: u32,
    pub low: f64,
    pub high: f64,
}

/// Unit vectors across `direction`, from the axis along which it is smallest: the zenith is no special case.
pub fn across(direction: DVec3) -> (DVec3, DVec3) {
    let a = direction.abs();
    let axis = if a.y <= a.x && a.y <= a.z {
        DVec3::Y
    } else if a.x <= a.z {
        DVec3::X
    } else {
        DVec3::Z
    };
    let u = axis.cross(direction).normalize();
    (u, direction.cross(u))
}

/// Fits a map of `size` texels per side to all within `margin` metres of the receivers across the light; `None` when
/// the camera sees nothing of the scene's box `bounds`.
pub fn fit(camera: &Camera, bounds: (DVec3, DVec3), direction: DVec3, size: u32, margin: f64) -> Option<LightFrame> {
    let receivers = visible_corners(camera, bounds);
    let (anchor, top) = bounds;
    let (u, v) = across(direction);
    let flat = |p: &DVec3| DVec2::new(p.dot(u), p.dot(v));
    let first = flat(receivers.first()?);
    let (low_uv, high_uv) = receivers.iter().map(flat).fold((first, first), |(l, h), q| (l.min(q), h.max(q)));
    let (low_uv, high_uv) = (low_uv - margin, high_uv + margin);
    // One texel more than the extent needs, since the corner is moved to a whole texel.
    let inner = f64::from(size) - 2.0 * BORDER - 1.0;
    let texel = ((high_uv - low_uv) / inner).max(DVec2::splat(1e-4));
    let corner = (low_uv / texel).floor() - BORDER;
    let heights = box_corners(anchor, top).map(|p| (p - anchor).dot(direction));
    let low = heights.iter().copied().fold(f64::INFINITY, f64::min) - 1.0;
    let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 1.0;
    Some(LightFrame { anchor, u, v, direction, texel, corner, size, low, high })
}

pub fn box_corners(low: DVec3, high: DVec3) -> [DVec3; 8] {
    std::array::from_fn(|i| {
        DVec3::new(
            if i & 1 == 0 { low.x } else { high.x },
            if i & 2 == 0 { low.y } else { high.y },
            if i & 4 == 0 { low.z } else { high.z },
        )
    })
}

/// Half spaces `n·(p - position) + d ≥ 0` of the view volume, in no order; the far side is open.
pub fn view_planes(camera: &Camera) -> [(DVec3, f64); 5] {
    let (right, up, forward) = (camera.right, camera.up, camera.forward);
    let near = (forward, -camera.near);
    match camera.projection {
        Projection::Perspective { tan_x, tan_y } => [
            near,
            (forward * tan_x + right, 0.0),
            (forward * tan_x - right, 0.0),
            (forward * tan_y + up, 0.0),
            (forward * tan_y - up, 0.0),
        ],
        Projection::Orthographic { half_x, half_y } => {
            [near, (right, half_x), (-right, half_x), (up, half_y), (-up, half_y)]
        }
    }
}

/// Points, from the box's least corner, whose hull is the box within the view volume.
pub fn visible_corners(camera: &Camera, bounds: (DVec3, DVec3)) -> Vec<DVec3> {
    const FACES: [[usize; 4]; 6] = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let corners = box_corners(bounds.0, bounds.1);
    let planes = view_planes(camera);
    let eye = camera.position - bounds.0;
    let mut points = Vec::new();
    for face in FACES {
        let mut polygon: Vec<DVec3> = face.map(|i| corners[i] - camera.position).to_vec();
        for &(normal, offset) in &planes {
            polygon = clip(&polygon, normal, offset);
        }
        points.extend(polygon.into_iter().map(|p| p + eye));
    }
    // Corners of the view volume inside the box: only those of the near plane can be, the far side being open.
    let extent = bounds.1 - bounds.0;
    let near = near_corners(camera).map(|p| p + eye);
    points.extend(near.into_iter().filter(|p| p.cmpge(DVec3::ZERO).all() && p.cmple(extent).all()));
    points
}

/// From the camera's position.
fn near_corners(camera: &Camera) -> [DVec3; 4] {
    let (half_x, half_y) = match camera.projection {
        Projection::Perspective { tan_x, tan_y } => (tan_x * camera.near, tan_y * camera.near),
        Projection::Orthographic { half_x, half_y } => (half_x, half_y),
    };
    let center = camera.forward * camera.near;
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| center + camera.right * (x * half_x) + camera.up * (y * half_y))
}

/// Part of a convex polygon with `n·p + d ≥ 0` (Sutherland and Hodgman 1974).
fn clip(polygon: &[DVec3], normal: DVec3, offset: f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &b) in polygon.iter().enumerate() {
        let a = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (da, db) = (normal.dot(a) + offset, normal.dot(b) + offset);
        if (da < 0.0) != (db < 0.0) {
            kept.push(a + (b - a) * (da / (da - db)));
        }
        if db >= 0.0 {
            kept.push(b);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nadir(height: f64, tan: f64) -> Camera {
        Camera {
            position: DVec3::new(0.0, height, 0.0),
            right: DVec3::X,
            up: DVec3::NEG_Z,
            forward: DVec3::NEG_Y,
            projection: Projection::Perspective { tan_x: tan, tan_y: tan },
            width: 64,
            height: 64,
            near: 1.0,
        }
    }

    const BOX: (DVec3, DVec3) = (DVec3::new(-500.0, 0.0, -500.0), DVec3::new(500.0, 20.0, 500.0));

    #[test]
    fn receivers_are_inside_the_map_and_fill_it() {
        for (x, y, z) in [(0.0, 1.0, 0.0), (0.9, 0.1, 0.2), (0.3, 0.5, -0.8), (-0.5, 0.02, 0.5)] {
            let direction = DVec3::new(x, y, z).normalize();
            let frame = fit(&nadir(100.0, 1.0), BOX, direction, 1024, 0.0).expect("the camera sees the ground");
            assert!((frame.u.cross(frame.v) - direction).length() < 1e-12);
            let mut reached = DVec2::ZERO;
            // Corners of the view volume on the ground and at the top of the box.
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            for (x, z, y) in
                corners.iter().flat_map(|&(x, z)| [(100.0 * x, 100.0 * z, 0.0), (80.0 * x, 80.0 * z, 20.0)])
            {
                let p = DVec3::new(x, y, z) - frame.anchor;
                let t = DVec2::new(p.dot(frame.u), p.dot(frame.v)) / frame.texel - frame.corner;
                assert!(t.cmpge(DVec2::splat(7.0)).all() && t.cmple(DVec2::splat(1017.0)).all(), "{t}");
                reached = reached.max(t);
            }
            assert!(reached.min_element() > 1000.0, "{reached}");
        }
    }

    #[test]
    fn a_camera_that_sees_nothing_has_no_map() {
        let mut camera = nadir(100.0, 1.0);
        camera.forward = DVec3::Y;
        camera.up = DVec3::Z;
        assert_eq!(fit(&camera, BOX, DVec3::Y, 64, 0.0), None);
    }

    #[test]
    fn frame_moves_with_the_scene() {
        let shift = DVec3::new(524_288.0, 1024.0, -4_194_304.0);
        let direction = DVec3::new(0.5, 0.5, 0.25).normalize();
        let mut camera = nadir(128.0, 0.5);
        let here = fit(&camera, BOX, direction, 512, 0.0).expect("seen");
        camera.position += shift;
        let there = fit(&camera, (BOX.0 + shift, BOX.1 + shift), direction, 512, 0.0).expect("seen");
        assert_eq!(LightFrame { anchor: here.anchor + shift, ..here }, there);
    }
}
