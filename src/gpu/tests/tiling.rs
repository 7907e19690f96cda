//! Tiles leave no seam: an image in tiles is the image in one piece.

use super::town::{self, demand, rgb, sun, tilted, view};
use crate::plan::demand::{Output, State};

#[test]
fn tiles_and_one_piece_agree() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(12);
    let outputs = [Output::Color, Output::Instance, Output::Depth].map(|o| demand(&scene, o, State::After)).to_vec();
    let demand = view(tilted(town::nadir(0.0, 0.0, 0.4, 500, 400), 25.0), sun(35.0, 120.0), outputs);
    let whole = town::render(&mut renderer, &scene, demand.clone());
    town::keep(&whole, 0, "tiling_whole.png");
    for samples in [512, 256, 190] {
        renderer.set_tile(samples);
        let tiled = town::render(&mut renderer, &scene, demand.clone());
        assert!(whole.images[1] == tiled.images[1], "object numbers differ in tiles of {samples} samples");
        let worst = rgb(&whole, 0).iter().zip(rgb(&tiled, 0)).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst <= Some(1), "colours differ by {worst:?} in tiles of {samples} samples");
    }
}
