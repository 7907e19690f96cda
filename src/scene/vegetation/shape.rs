//! Shape: a plant → its triangles. Crowns are closed bodies of few triangles whose corners are moved by the plant's seed,
//! smooth to the light; seen from above at 0.1 to 1 m per pixel that is what a tree is.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec3, Vec2};

use super::{Form, Plant};
use crate::interpreter::material::Material;
use crate::interpreter::seed::Seed;
use crate::scene::TriMesh;
use crate::scene::triangles::Builder;

/// sRGB of crowns, one of which a plant draws.
const LEAVES: [[f64; 3]; 4] = [[0.24, 0.33, 0.15], [0.29, 0.37, 0.18], [0.20, 0.29, 0.14], [0.33, 0.39, 0.21]];
const NEEDLES: [[f64; 3]; 2] = [[0.16, 0.25, 0.16], [0.19, 0.28, 0.17]];
const BUSHES: [[f64; 3]; 2] = [[0.30, 0.36, 0.19], [0.36, 0.39, 0.23]];
const BARK: [f64; 3] = [0.30, 0.25, 0.20];

/// Corners around.
const SIDES: usize = 9;

/// Adds the plant, standing on ground of height `ground`.
pub fn add(builder: &mut Builder, plant: &Plant, ground: f64) {
    let foot = DVec3::new(plant.at.x, ground, -plant.at.y);
    let (height, crown) = (plant.height, plant.crown);
    // Rings of a crown: height as a share of the plant's, radius as a share of the crown's.
    let (names, colors, rings): (_, &[[f64; 3]], &[(f64, f64)]) = match plant.form {
        Form::Broadleaved => {
            ("leaves", &LEAVES, &[(0.26, 0.0), (0.33, 0.62), (0.52, 1.0), (0.74, 0.88), (0.92, 0.48), (1.0, 0.0)])
        }
        Form::Conifer => ("needles", &NEEDLES, &[(0.1, 0.0), (0.14, 1.0), (0.42, 0.68), (0.72, 0.33), (1.0, 0.0)]),
        // The lowest ring lies under the ground, so that slopes leave no gap.
        Form::Bush => ("bush", &BUSHES, &[(-0.3, 0.0), (-0.1, 0.9), (0.35, 1.0), (0.8, 0.6), (1.0, 0.0)]),
    };
    let shade = (plant.seed.named("shade").unit() * colors.len() as f64) as usize;
    let material = material(&format!("vegetation.{names}.{shade}"), colors[shade]);
    let roughness = if plant.form == Form::Conifer { 0.12 } else { 0.2 };
    let rings: Vec<(f64, f64)> = rings.iter().map(|&(up, out)| (up * height, out * crown)).collect();
    lathe(builder.run(&material), foot, &rings, SIDES, roughness, plant.seed.named("crown"));
    if plant.form != Form::Bush {
        let radius = (0.025 * height).max(0.08);
        let trunk = [(-1.0, 0.0), (-1.0, radius), (0.4 * height, 0.8 * radius), (0.4 * height, 0.0)];
        lathe(builder.run(&self::material("vegetation.bark", BARK)), foot, &trunk, 6, 0.0, plant.seed);
    }
}

fn material(name: &str, color: [f64; 3]) -> Arc<Material> {
    Arc::new(Material { name: name.into(), color, ..Material::default() })
}

/// A closed body about the vertical through `foot`. The first and last rings are points; others move by a share
/// `roughness` of their radius, each corner by a draw of its own.
fn lathe(run: &mut TriMesh, foot: DVec3, rings: &[(f64, f64)], sides: usize, roughness: f64, seed: Seed) {
    let first = run.positions.len() as u32;
    let turn = seed.named("turn").unit();
    let mut corners: Vec<Vec<u32>> = Vec::new();
    for (level, &(up, out)) in rings.iter().enumerate() {
        let count = if out == 0.0 { 1 } else { sides };
        let ring = (0..count).map(|side| {
            let draw = seed.part(level as u64).part(side as u64);
            let (sin, cos) = libm::sincos((side as f64 / sides as f64 + turn) * TAU);
            let out = out * (1.0 + roughness * (2.0 * draw.unit() - 1.0));
            run.positions.push(foot + DVec3::new(out * cos, up, -out * sin));
            run.uvs.push(Vec2::ZERO);
            run.positions.len() as u32 - 1
        });
        corners.push(ring.collect());
    }
    let start = run.triangles.len();
    for pair in corners.windows(2) {
        let (below, above) = (&pair[0], &pair[1]);
        for side in 0..sides {
            let at = |ring: &[u32], side: usize| ring[side % ring.len()];
            let (a, b) = (at(below, side), at(below, side + 1));
            let (c, d) = (at(above, side), at(above, side + 1));
            if below.len() > 1 {
                run.triangles.push([a, b, if above.len() > 1 { d } else { c }]);
            }
            if above.len() > 1 {
                run.triangles.push([a, d, c]);
            }
        }
    }
    // Normals of the corners: the sum of their triangles' by area.
    let mut sums = vec![DVec3::ZERO; run.positions.len() - first as usize];
    for triangle in &run.triangles[start..] {
        let [a, b, c] = triangle.map(|i| run.positions[i as usize]);
        let normal = (b - a).cross(c - a);
        triangle.iter().for_each(|&i| sums[(i - first) as usize] += normal);
    }
    run.normals.extend(sums.into_iter().map(|sum| sum.normalize_or(DVec3::Y).as_vec3()));
}
