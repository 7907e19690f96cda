//! Tiles leave no seam: an image in tiles is the image in one piece.

use super::town::{self, demand, rgb, sun, tilted, view};
use crate::frame::Pixels;
use crate::gpu::{Positions, TextureFilter, Tile};
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

#[test]
fn windows_are_parts_of_the_image() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(12);
    let outputs = [Output::Color, Output::Instance].map(|o| demand(&scene, o, State::After)).to_vec();
    let demand = view(tilted(town::nadir(0.0, 0.0, 0.4, 500, 400), 25.0), sun(35.0, 120.0), outputs);
    let whole = town::render(&mut renderer, &scene, demand.clone());
    let windows = [(64, 128, 64, 64), (300, 10, 64, 64)].map(|(x, y, width, height)| Tile { x, y, width, height });
    let plan = town::plan(&scene, demand);
    let parts = renderer.render_windows(&plan.views[0], &windows).expect("it renders");
    let (Pixels::Id32(all), Pixels::Id32(some)) = (&whole.images[1].pixels, &parts.images[1].pixels) else {
        panic!("numbers")
    };
    for (i, (wanted, found)) in all.iter().zip(some).enumerate() {
        let (x, y) = (i as u32 % 500, i as u32 / 500);
        let inside = windows.iter().any(|w| (w.x..w.right()).contains(&x) && (w.y..w.bottom()).contains(&y));
        let colors = [&whole, &parts].map(|frame| &rgb(frame, 0)[i * 3..][..3]);
        let (number, color) = if inside { (*wanted, colors[0]) } else { (0, &[0u8; 3][..]) };
        let off = color.iter().zip(colors[1]).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(*found == number && off <= Some(1), "at {x}, {y}: {off:?}");
    }
}

/// Ways of drawing that are there to be measured do what they say, and can be left again.
#[test]
fn measured_ways_of_drawing_differ() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::town(6);
    let outputs = [Output::Color, Output::Instance].map(|o| demand(&scene, o, State::After)).to_vec();
    let mut demand = view(tilted(town::nadir(0.0, 0.0, 0.4, 200, 160), 50.0), sun(35.0, 120.0), outputs);
    // At a distance where f32 has steps of a quarter metre.
    let shift = glam::DVec3::new(3.0e6, 0.0, -4.0e6);
    demand.camera.position += shift;
    scene.objects.iter_mut().flat_map(|o| &mut o.mesh.positions).for_each(|p| *p += shift);
    let usual = town::render(&mut renderer, &scene, demand.clone());
    let plan = town::plan(&scene, demand);
    renderer.set_texture_filter(TextureFilter::Nearest);
    let nearest = renderer.render(&plan.views[0]).expect("it renders");
    assert!(nearest.images[0] != usual.images[0] && nearest.images[1] == usual.images[1]);
    renderer.set_texture_filter(TextureFilter::Usual);
    renderer.set_positions(Positions::AboutOrigin);
    assert!(renderer.render(&plan.views[0]).expect("it renders").images[1] != usual.images[1]);
    renderer.set_positions(Positions::AboutCamera);
    assert!(renderer.render(&plan.views[0]).expect("it renders") == usual);
}
