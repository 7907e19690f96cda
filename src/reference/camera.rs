//! Camera: a place on the image → the ray whose distances are metres along the viewing direction.

use glam::DVec3;

use crate::plan::demand::{Camera, Projection};

/// Origin and direction of the ray through `(x, y)` in pixels from the upper left corner, y downwards. The direction's
/// component along the viewing direction is 1.
pub fn ray(camera: &Camera, x: f64, y: f64) -> (DVec3, DVec3) {
    let across = 2.0 * x / f64::from(camera.width) - 1.0;
    let up = 1.0 - 2.0 * y / f64::from(camera.height);
    match camera.projection {
        Projection::Perspective { tan_x, tan_y } => {
            (camera.position, camera.forward + camera.right * (across * tan_x) + camera.up * (up * tan_y))
        }
        Projection::Orthographic { half_x, half_y } => {
            (camera.position + camera.right * (across * half_x) + camera.up * (up * half_y), camera.forward)
        }
    }
}
