//! Hard cases of rendering, each against rays, a formula or itself (`docs/numerics.md` lists them with their bounds).

mod acne;
mod cameras;
mod coplanar;
mod depth;
mod detail;
mod edges;
mod masks;
mod not_finite;
mod origin;
mod outlines;
mod quality;
mod suns;
mod thin;

use glam::{DVec2, DVec3};

use super::town::{self, demand, nadir};
use crate::frame::{Frame, Pixels};
use crate::gpu::mipmaps::linear_from_srgb;
use crate::plan::demand::{Ambient, Camera, Output, Projection, Shadows, State, Sun, ViewDemand};
use crate::plan::light::LightFrame;
use crate::plan::pass::PassKind;
use crate::reference::{Options, Rendered, Tracer};
use crate::scene::Scene;

/// A parallel camera 512 m above a point of the plan, north up, `gsd` metres per pixel.
fn above((x, z): (f64, f64), gsd: f64, (width, height): (u32, u32)) -> Camera {
    let half = |pixels: u32| f64::from(pixels) * gsd / 2.0;
    let projection = Projection::Orthographic { half_x: half(width), half_y: half(height) };
    Camera { projection, near: 1.0, ..nadir(x, z, gsd, width, height) }
}

/// A sun that lights level ground alike, whatever its height.
fn even_sun(elevation: f64, azimuth: f64) -> Sun {
    let sun = town::sun(elevation, azimuth);
    Sun { irradiance: [0.9 / sun.direction.y.max(1e-9); 3], ..sun }
}

/// The colour of what is lit by the sun alone.
fn sunlit(scene: &Scene, camera: Camera, sun: Sun, shadows: Shadows) -> ViewDemand {
    let mut output = demand(scene, Output::Color, State::Before);
    (output.look.shadows, output.look.ambient) = (shadows, Ambient::Off);
    town::view(camera, sun, vec![output])
}

/// Share of the sun's light in each pixel of level ground of material [`town::GROUND`] under an [`even_sun`].
fn shares(frame: &Frame, image: usize) -> Vec<f64> {
    let full = linear_from_srgb(0.6) * 0.9;
    let green = town::rgb(frame, image).iter().skip(1).step_by(3);
    green.map(|&g| linear_from_srgb(f64::from(g) / 255.0) / full).collect()
}

fn ids(frame: &Frame, image: usize) -> &[u32] {
    match &frame.images[image].pixels {
        Pixels::Id32(pixels) => pixels,
        other => panic!("an image of numbers, not {other:?}"),
    }
}

fn metres(frame: &Frame, image: usize) -> &[f32] {
    match &frame.images[image].pixels {
        Pixels::Float32(pixels) => pixels,
        other => panic!("an image of depth, not {other:?}"),
    }
}

/// One image of the `before` state.
fn labels(scene: &Scene, camera: Camera, output: Output) -> ViewDemand {
    town::view(camera, town::sun(45.0, 200.0), vec![demand(scene, output, State::Before)])
}

fn trace(scene: &Scene, view: &ViewDemand, side: u32) -> Rendered {
    let tracer = Tracer::new(scene).expect("finite");
    tracer.render(view, &Options { side, passes: 2, ..Options::default() }).expect("it renders")
}

/// Where a point lies on the image, pixels from the upper left corner.
fn pixel(camera: &Camera, p: DVec3) -> DVec2 {
    let p = p - camera.position;
    let (x, y) = (p.dot(camera.right), p.dot(camera.up));
    let (x, y) = match camera.projection {
        Projection::Perspective { tan_x, tan_y } => {
            let depth = p.dot(camera.forward);
            (x / (depth * tan_x), y / (depth * tan_y))
        }
        Projection::Orthographic { half_x, half_y } => (x / half_x, y / half_y),
    };
    DVec2::new((x + 1.0) / 2.0 * f64::from(camera.width), (1.0 - y) / 2.0 * f64::from(camera.height))
}

/// The way of sight through a place on the image: a point and a direction of length 1 along the camera's axis.
fn sight(camera: &Camera, at: DVec2) -> (DVec3, DVec3) {
    let (x, y) = (2.0 * at.x / f64::from(camera.width) - 1.0, 1.0 - 2.0 * at.y / f64::from(camera.height));
    match camera.projection {
        Projection::Perspective { tan_x, tan_y } => {
            (camera.position, camera.forward + camera.right * (x * tan_x) + camera.up * (y * tan_y))
        }
        Projection::Orthographic { half_x, half_y } => {
            (camera.position + camera.right * (x * half_x) + camera.up * (y * half_y), camera.forward)
        }
    }
}

/// Where that way meets the level of a height.
fn on_level(camera: &Camera, at: DVec2, height: f64) -> DVec3 {
    let (from, towards) = sight(camera, at);
    from + towards * ((height - from.y) / towards.y)
}

/// Centres of all pixels, row by row.
fn centres(camera: &Camera) -> impl Iterator<Item = DVec2> {
    let (width, height) = (camera.width, camera.height);
    (0..height).flat_map(move |y| (0..width).map(move |x| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)))
}

/// The frame of the shadow map that a view has.
fn light(scene: &Scene, view: &ViewDemand) -> LightFrame {
    let plan = town::plan(scene, view.clone());
    let map = plan.views[0].passes().find_map(|pass| match &pass.kind {
        PassKind::ShadowMap { light, .. } => Some(*light),
        _ => None,
    });
    map.expect("there is a shadow map")
}

/// The farther that a texel of the map reaches on level ground along one of its sides, metres.
fn texel_on_ground(light: &LightFrame) -> f64 {
    let (u, v) = (DVec2::new(light.u.x, light.u.z), DVec2::new(light.v.x, light.v.z));
    let area = u.perp_dot(v);
    let (along_u, along_v) = (v.perp() / area * light.texel.x, u.perp() / area * light.texel.y);
    along_u.length().max(along_v.length())
}
