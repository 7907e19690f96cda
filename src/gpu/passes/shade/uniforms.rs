//! Uniforms of shading: light in world metres (f64) → numbers about the origin, as the parts of `shaders/shade`
//! name them.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::gpu::tiles::light_rows;
use crate::plan::demand::Ambient;
use crate::plan::effects::{Haze, with_red_as_infrared};
use crate::plan::light::LightFrame;
use crate::plan::shading::{FieldFrame, FieldLook, Illumination, SkyLook, SoftLook};

/// Distance, metres along the ray, within which a caster's shadow fades in: a constant against rounding, and a share
/// of a texel for smooth normals that differ from the plane of their triangle.
const FADE_METRES: f64 = 0.04;
const FADE_TEXELS: f64 = 0.5;

fn vector(v: DVec3, w: f64) -> [f32; 4] {
    v.extend(w).as_vec4().to_array()
}

fn numbers<const N: usize>(numbers: [f64; N]) -> [f32; N] {
    numbers.map(|n| n as f32)
}

fn with([r, g, b]: [f64; 3], n: Option<f64>) -> [f32; 4] {
    numbers([r, g, b, n.unwrap_or(0.0)])
}

/// `Lamp` of `main.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct LampUniform {
    sun: [f32; 4],
    irradiance: [f32; 4],
    zenith: [f32; 4],
    ground: [f32; 4],
}

impl LampUniform {
    pub fn new(light: &Illumination) -> LampUniform {
        let infrared = light.bands.near_infrared();
        let (zenith, ground, lit) = match light.ambient {
            Ambient::Off => ([0.0; 3], [0.0; 3], None),
            Ambient::Constant(radiance) => (radiance, radiance, infrared),
            Ambient::Sky { zenith, ground, .. } => (zenith, ground, infrared),
        };
        let direction = light.sun.map_or(DVec3::Y, |s| s.direction);
        let irradiance = light.sun.map_or([0.0; 3], |s| s.irradiance);
        LampUniform {
            sun: vector(direction, 0.0),
            irradiance: with(irradiance, infrared.filter(|_| light.sun.is_some()).map(|n| n.sun)),
            zenith: with(zenith, lit.map(|n| n.zenith)),
            ground: with(ground, lit.map(|n| n.ground)),
        }
    }
}

/// Depth over which light fades in.
fn fade(light: &LightFrame) -> f64 {
    (FADE_METRES + FADE_TEXELS * light.texel.max_element()) / (light.high - light.low)
}

/// `Shadow` of `shadow.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct ShadowUniform {
    rows: [[f32; 4]; 3],
    u: [f32; 4],
    v: [f32; 4],
    fade: f32,
    texel: f32,
    range: f32,
    unused: f32,
}

impl ShadowUniform {
    pub fn new(origin: DVec3, light: &LightFrame) -> ShadowUniform {
        let range = light.high - light.low;
        ShadowUniform {
            rows: light_rows(light, origin).map(numbers),
            u: vector(light.u, light.texel.x / range),
            v: vector(light.v, light.texel.y / range),
            fade: (1.0 / fade(light)) as f32,
            texel: (1.0 / f64::from(light.size)) as f32,
            range: range as f32,
            unused: 0.0,
        }
    }
}

/// `Disc` of `shadow_soft.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct DiscUniform {
    spread: [f32; 2],
    lift: f32,
    top: f32,
    rise: [f32; 2],
    climb: f32,
    samples: u32,
}

impl DiscUniform {
    pub fn new(origin: DVec3, light: &LightFrame, soft: &SoftLook, disc_deg: f64) -> DiscUniform {
        let radius = libm::tan((disc_deg / 2.0).to_radians());
        DiscUniform {
            spread: [radius / light.texel.x, radius / light.texel.y].map(|s| s as f32),
            lift: (origin.y - light.anchor.y) as f32,
            top: (soft.top - light.anchor.y) as f32,
            rise: [light.u.y * light.texel.x, light.v.y * light.texel.y].map(|r| r as f32),
            climb: light.direction.y as f32,
            samples: soft.samples,
        }
    }
}

/// `SkyView` of `sky.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct SkyView {
    rows: [[f32; 4]; 3],
    towards: [f32; 4],
    scale: [f32; 4],
}

/// `Sky` of `sky.wgsl`.
pub fn sky(origin: DVec3, look: &SkyLook, side: u32) -> Vec<u8> {
    let size = look.frames.first().map_or(1, |frame| frame.size);
    let view = |light: &LightFrame| {
        let range = light.high - light.low;
        let [x, y] = light.texel.to_array().map(|t| t * t / range);
        SkyView {
            rows: light_rows(light, origin).map(numbers),
            towards: vector(light.direction, 1.0 / light.direction.y),
            scale: numbers([x, y, 1.0 / fade(light), 0.0]),
        }
    };
    let views: Vec<SkyView> = look.frames.iter().map(view).collect();
    let texel = 1.0 / size as f32;
    let count = views.len() as u32;
    let header = [side.to_le_bytes(), look.subsets.to_le_bytes(), texel.to_le_bytes(), count.to_le_bytes()].concat();
    [&header, bytemuck::cast_slice(&views)].concat()
}

/// `Haze` of `haze.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct HazeUniform {
    extinction: [f32; 4],
    airlight: [f32; 4],
    base: f32,
    thinning: f32,
    unused: [f32; 2],
}

impl HazeUniform {
    pub fn new(origin: DVec3, haze: &Haze, light: &Illumination) -> HazeUniform {
        let infrared = light.bands.near_infrared();
        HazeUniform {
            extinction: with(haze.extinction, infrared.map(|n| n.extinction)),
            airlight: with(haze.airlight, infrared.map(|n| n.airlight)),
            base: (origin.y - haze.base) as f32,
            thinning: (1.0 / haze.scale_height) as f32,
            unused: [0.0; 2],
        }
    }
}

/// Scale and offset from metres about the origin (x, z) to a field's map.
pub fn field_row(origin: DVec3, frame: &FieldFrame) -> [f32; 4] {
    let scale = 1.0 / (frame.high - frame.low);
    let offset = [(origin.x - frame.low.x) * scale.x, (-origin.z - frame.low.y) * scale.y];
    numbers([scale.x, -scale.y, offset[0], offset[1]])
}

/// `Clouds` of `clouds.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct CloudsUniform {
    shadow: [f32; 4],
    cover: [f32; 4],
    color: [f32; 4],
    height: f32,
    unused: [f32; 3],
}

impl CloudsUniform {
    pub fn new(origin: DVec3, light: &Illumination) -> CloudsUniform {
        let row = |look: Option<FieldLook>| look.map_or([0.0; 4], |look| field_row(origin, &look.frame));
        let (color, height) = light.clouds.map_or(([0.0; 3], 0.0), |clouds| (clouds.color, clouds.height));
        CloudsUniform {
            shadow: row(light.cloud_shadow),
            cover: row(light.cloud_cover),
            color: numbers(with_red_as_infrared(color)),
            height: (height - origin.y) as f32,
            unused: [0.0; 3],
        }
    }
}
