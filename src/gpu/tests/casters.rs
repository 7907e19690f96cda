//! Which objects a shadow map draws: those between the sun and what the camera sees.

use glam::DVec3;

use super::town::{self, demand, nadir, sun, view};
use crate::plan::demand::{Output, Shadows, State};
use crate::scene::Presence;

/// Triangles drawn for an image of 32 m × 32 m, with a tower of 10 triangles at a place.
fn drawn(tower: Option<(f64, f64)>) -> Option<(u64, u64)> {
    let mut renderer = super::renderer()?;
    let mut scene = town::empty();
    town::plane(&mut scene, (-400.0, -401.0), (402.0, 403.0), town::GROUND);
    if let Some((x, z)) = tower {
        let low = DVec3::new(x, 0.0, z);
        town::block(&mut scene, Presence::Both, low, low + DVec3::new(8.0, 40.0, 8.0));
    }
    let mut output = demand(&scene, Output::Color, State::Before);
    output.look.shadows = Shadows::Hard;
    let view = view(nadir(0.0, 0.0, 0.5, 64, 64), sun(30.0, 90.0), vec![output]);
    let planned = town::plan(&scene, view.clone()).counts().triangles;
    town::render(&mut renderer, &scene, view);
    Some((renderer.drawn(), planned))
}

#[test]
fn only_casters_that_the_sun_sees_before_the_image_are_drawn() {
    // The ground once for the map and once for the image.
    let Some(ground) = drawn(None) else { return };
    assert_eq!(ground, (4, 4));
    let with = |x: f64, z: f64| drawn(Some((x, z))).expect("there is an adapter");
    // In the image: twice.
    assert_eq!(with(0.0, 0.0), (24, 24));
    // The sun is in the east: what stands there may throw its shadow into the image.
    assert_eq!(with(60.0, -4.0), (14, 24));
    // What stands aside, or behind the image, throws none into it.
    assert_eq!(with(0.0, 200.0), (4, 24));
    assert_eq!(with(0.0, -200.0), (4, 24));
    assert_eq!(with(-120.0, -4.0), (4, 24));
}
