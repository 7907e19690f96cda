//! Masks of many objects: numbers above 65,535 come through to the last bit.

use glam::DVec3;

use super::{above, ids, labels};
use crate::gpu::tests::town;
use crate::plan::demand::Output;
use crate::scene::{Presence, SceneClass};

#[test]
fn mask_ids() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    // 70,000 roofs of 2 × 2 pixels, 265 in a row.
    let (count, row) = (70_000usize, 265usize);
    let mut scene = town::empty();
    for i in 0..count {
        let (x, z) = ((i % row) as f64, (i / row) as f64);
        let corners = [(x, z), (x, z + 1.0), (x + 1.0, z + 1.0), (x + 1.0, z)];
        let face = corners.map(|(x, z)| DVec3::new(x, 6.0, z)).to_vec();
        town::add(&mut scene, SceneClass::Building, Presence::Both, &[(face, town::ROOF)]);
    }
    let side = 2 * row as u32;
    let camera = above((row as f64 / 2.0, row as f64 / 2.0), 0.5, (side, side));
    let drawn = town::render(&mut renderer, &scene, labels(&scene, camera, Output::Instance));
    for (at, &id) in ids(&drawn, 0).iter().enumerate() {
        let (x, z) = (at % side as usize / 2, at / side as usize / 2);
        let building = z * row + x;
        assert_eq!(id as usize, if building < count { building + 1 } else { 0 }, "pixel {at}");
    }
}
