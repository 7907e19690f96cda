//! Laws of the camera: up stays up, what the cursor holds stays under it, a recipe's camera stays what it is.

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::plan::view::frame;

const BOUNDS: Bounds = (DVec3::new(-300.0, 0.0, -200.0), DVec3::new(250.0, 40.0, 220.0));
const SIZE: (u32, u32) = (800, 500);

fn recipe_camera(off_nadir: f64, azimuth: f64, heading: f64, projection: Projection) -> Camera {
    let (right, up, forward) = frame(off_nadir, azimuth, heading);
    let position = DVec3::new(10.0, 5.0, -20.0) - forward * 700.0;
    Camera { position, right, up, forward, projection, width: 640, height: 480, near: near(position, forward, BOUNDS) }
}

fn perspective() -> Projection {
    Projection::Perspective { tan_x: 0.4, tan_y: 0.3 }
}

fn lens() -> impl Strategy<Value = Projection> {
    prop_oneof![Just(perspective()), Just(Projection::Orthographic { half_x: 200.0, half_y: 150.0 })]
}

fn camera() -> impl Strategy<Value = Camera> {
    (0.0..70.0, 0.0..360.0, 0.0..360.0, lens()).prop_map(|(o, a, h, lens)| recipe_camera(o, a, h, lens))
}

/// Where a point is in the picture; `None` behind the camera.
fn project(camera: &Camera, point: DVec3) -> Option<Pixel> {
    let offset = point - camera.position;
    let ahead = offset.dot(camera.forward);
    let (x, y) = match camera.projection {
        Projection::Perspective { tan_x, tan_y } if ahead > 0.0 => {
            (offset.dot(camera.right) / (ahead * tan_x), offset.dot(camera.up) / (ahead * tan_y))
        }
        Projection::Perspective { .. } => return None,
        Projection::Orthographic { half_x, half_y } => {
            (offset.dot(camera.right) / half_x, offset.dot(camera.up) / half_y)
        }
    };
    Some(Pixel { x: (x + 1.0) / 2.0 * f64::from(camera.width), y: (1.0 - y) / 2.0 * f64::from(camera.height) })
}

fn assert_orthonormal(camera: &Camera) {
    let Camera { right, up, forward, .. } = *camera;
    for (a, b) in [(right, up), (up, forward), (forward, right)] {
        assert!(a.dot(b).abs() < 1e-9, "{a} and {b} are not perpendicular");
    }
    for axis in [right, up, forward] {
        assert!((axis.length() - 1.0).abs() < 1e-9, "{axis} is not a unit vector");
    }
    assert!((right.cross(up) + forward).length() < 1e-9, "left-handed");
}

proptest! {
    #[test]
    fn a_recipes_camera_comes_back_to_the_bit(camera in camera()) {
        let viewpoint = Viewpoint::of(&camera, DVec3::ZERO);
        prop_assert_eq!(viewpoint.camera((640, 480), BOUNDS), camera);
        let smaller = viewpoint.camera((320, 1000), BOUNDS);
        prop_assert_eq!(Camera { width: 640, height: 480, ..smaller }, camera);
        prop_assert_eq!((smaller.width, smaller.height), (320, 240));
    }

    #[test]
    fn the_first_touch_does_not_jump(camera in camera()) {
        let mut viewpoint = Viewpoint::of(&camera, DVec3::ZERO);
        viewpoint.orbit(0.0, 0.0, 0.0);
        let moved = viewpoint.camera((640, 480), BOUNDS);
        for at in [Pixel { x: 3.0, y: 4.0 }, Pixel { x: 600.0, y: 470.0 }] {
            let point = point_at(&camera, at, 650.0);
            let back = project(&moved, point).expect("in front");
            prop_assert!((back.x - at.x).abs() < 1e-6 && (back.y - at.y).abs() < 1e-6, "{:?} became {:?}", at, back);
        }
    }

    #[test]
    fn orbiting_never_flips(
        azimuth in 0.0..360.0, off_nadir in 0.0..70.0,
        drags in prop::collection::vec((-200.0..200.0, -200.0..200.0), 1..30),
    ) {
        // Upright: the top of the image points away from where the camera stands.
        let camera = recipe_camera(off_nadir, azimuth, azimuth + 180.0, perspective());
        let mut viewpoint = Viewpoint::of(&camera, DVec3::ZERO);
        let target = viewpoint.target;
        for (across, down) in drags {
            viewpoint.orbit(across, down, 50.0);
            let camera = viewpoint.camera(SIZE, BOUNDS);
            assert_orthonormal(&camera);
            prop_assert!(camera.up.y >= -1e-9, "upside down: {}", camera.up);
            prop_assert!(camera.forward.y < 0.0, "looks up: {}", camera.forward);
            prop_assert!(camera.right.y.abs() < 1e-9, "the horizon is tilted: {}", camera.right);
            prop_assert!((viewpoint.target - target).length() < 1e-9, "the target moved");
        }
    }

    #[test]
    fn dragging_levels_a_tilted_horizon(azimuth in 0.0..360.0, heading in 0.0..360.0, off_nadir in 0.0..30.0) {
        let mut viewpoint = Viewpoint::of(&recipe_camera(off_nadir, azimuth, heading, perspective()), DVec3::ZERO);
        for _ in 0..60 {
            viewpoint.orbit(1.0, -3.0, 20.0);
        }
        let camera = viewpoint.camera(SIZE, BOUNDS);
        prop_assert!(camera.up.y > 0.9 && camera.right.y.abs() < 0.02, "up {} right {}", camera.up, camera.right);
    }

    #[test]
    fn zooming_keeps_the_point_under_the_cursor(
        camera in camera(), x in 0.0..800.0, y in 0.0..500.0, depth in 300.0..900.0, factor in 0.3..3.0,
    ) {
        let mut viewpoint = Viewpoint::of(&camera, DVec3::ZERO);
        viewpoint.orbit(5.0, 2.0, 6.0);
        let before = viewpoint.camera(SIZE, BOUNDS);
        let at = Pixel { x, y };
        let anchor = point_at(&before, at, depth);
        viewpoint.zoom(factor, anchor);
        let after = viewpoint.camera(SIZE, BOUNDS);
        let back = project(&after, anchor).expect("in front");
        prop_assert!((back.x - x).abs() < 1e-6 && (back.y - y).abs() < 1e-6, "{:?} became {:?}", at, back);
        // What is as far as the anchor grows by the inverse factor.
        let beside = point_at(&before, Pixel { x: x + 10.0, y }, depth);
        let now = project(&after, beside).expect("in front");
        prop_assert!((now.x - x - 10.0 / factor).abs() < 1e-6, "10 pixels became {}", now.x - x);
    }

    #[test]
    fn panning_follows_the_cursor(
        camera in camera(), x in 0.0..800.0, y in 0.0..500.0, dx in -300.0..300.0, dy in -200.0..200.0,
    ) {
        let mut viewpoint = Viewpoint::of(&camera, DVec3::ZERO);
        viewpoint.orbit(5.0, 2.0, 6.0);
        let before = viewpoint.camera(SIZE, BOUNDS);
        let anchor = point_at(&before, Pixel { x, y }, 600.0);
        let cursor = Pixel { x: f64::clamp(x + dx, 0.0, 800.0), y: f64::clamp(y + dy, 0.0, 500.0) };
        viewpoint.pan(anchor, cursor, &before);
        let back = project(&viewpoint.camera(SIZE, BOUNDS), anchor).expect("in front");
        prop_assert!((back.x - cursor.x).abs() < 1e-5 && (back.y - cursor.y).abs() < 1e-5, "{:?} for {:?}", back, cursor);
    }

    #[test]
    fn looking_about_stays_in_place(
        drags in prop::collection::vec((-90.0..90.0, -90.0..90.0), 1..20), azimuth in 0.0..360.0,
    ) {
        let mut viewpoint = Viewpoint::of(&recipe_camera(60.0, azimuth, azimuth + 180.0, perspective()), DVec3::ZERO);
        let position = viewpoint.position();
        for (across, down) in drags {
            viewpoint.look(across, down, 30.0);
            prop_assert!((viewpoint.position() - position).length() < 1e-6);
            let camera = viewpoint.camera(SIZE, BOUNDS);
            assert_orthonormal(&camera);
            prop_assert!(camera.up.y >= -1e-9);
        }
    }

    #[test]
    fn framing_shows_every_corner(camera in camera(), wide in any::<bool>()) {
        let viewpoint = Viewpoint::of(&camera, DVec3::ZERO).framing(BOUNDS);
        let size = if wide { (900, 300) } else { (300, 900) };
        let camera = viewpoint.camera(size, BOUNDS);
        let (low, high) = BOUNDS;
        for corner in 0..8 {
            let pick = |bit: u32, a: f64, b: f64| if corner & bit == 0 { a } else { b };
            let corner = DVec3::new(pick(1, low.x, high.x), pick(2, low.y, high.y), pick(4, low.z, high.z));
            let at = project(&camera, corner).expect("in front");
            let inside = at.x >= 0.0 && at.x <= f64::from(size.0) && at.y >= 0.0 && at.y <= f64::from(size.1);
            prop_assert!(inside, "{corner} is at {at:?} of {size:?}");
            prop_assert!((corner - camera.position).dot(camera.forward) >= camera.near);
        }
    }
}

#[test]
fn the_overview_is_upright_and_looks_north() {
    let camera = Viewpoint::overview(BOUNDS).camera(SIZE, BOUNDS);
    assert!(camera.up.y > 0.5 && camera.forward.z < 0.0 && camera.right.x > 0.99);
}

#[test]
fn flying_goes_where_it_says() {
    let mut viewpoint = Viewpoint::overview(BOUNDS);
    let before = viewpoint.position();
    viewpoint.fly(2.0, 3.0, 0.0);
    let moved = viewpoint.position() - before;
    assert!((moved - DVec3::new(2.0, 3.0, 0.0)).length() < 1e-9, "{moved}");
    assert!(viewpoint.given().is_none());
}
