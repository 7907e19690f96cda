//! The standard error says how far the truth is; threads and other outputs change nothing.

use std::cell::RefCell;

use super::{estimate, render};
use crate::gpu::tests::town::{self, demand, nadir, sun, tilted, view};
use crate::plan::demand::{Ambient, BACKGROUND, Output, Shadows, State, ViewDemand};
use crate::reference::{Options, color};
use crate::scene::Scene;

/// Ground that covers a share of every pixel of the second column, and the green of that column.
fn edge(covered: f64) -> (Scene, ViewDemand, f64) {
    let mut scene = town::empty();
    town::plane(&mut scene, (-300.0, -300.0), (covered, 300.0), town::GROUND);
    let mut output = demand(&scene, Output::Color, State::Before);
    (output.look.shadows, output.look.ambient) = (Shadows::Off, Ambient::Constant([1.0; 3]));
    let mut view = view(nadir(0.0, 0.0, 1.0, 2, 400), sun(45.0, 0.0), vec![output]);
    view.sun = None;
    (scene, view, color::linear(0.6) * covered + BACKGROUND[1] * (1.0 - covered))
}

#[test]
fn the_standard_error_falls_with_the_root_of_the_passes() {
    let (scene, view, _) = edge(0.37);
    let error = |passes: u32| {
        let options = Options { side: 3, passes, ..Options::default() };
        estimate(&render(&scene, &view, &options)).mean_standard_error
    };
    let (few, many) = (error(16), error(256));
    assert!(few > 0.0 && (few / many - 4.0).abs() < 0.3, "{few} with 16 passes, {many} with 256");
}

#[test]
fn the_truth_lies_within_the_standard_error() {
    for covered in [0.37, 0.5, 0.81] {
        let (scene, view, truth) = edge(covered);
        let rendered = render(&scene, &view, &Options { side: 3, passes: 40, ..Options::default() });
        let estimate = estimate(&rendered);
        let column = (0..400).map(|y| 2 * y + 1);
        let off = column.map(|i| (estimate.linear[i][1] - truth) / estimate.standard_error[i][1].max(1e-12));
        let (mut one, mut two, mut mean) = (0, 0, 0.0);
        for z in off {
            one += usize::from(z.abs() < 1.0);
            two += usize::from(z.abs() < 2.0);
            mean += z / 400.0;
        }
        // 68 % and 95 % of 400, with their own spread.
        assert!((240..=310).contains(&one) && two >= 365, "{covered}: {one} within one, {two} within two of 400");
        assert!(mean.abs() < 0.2, "{covered}: {mean} standard errors off in the mean");
        assert!(estimate.standard_error.iter().step_by(2).all(|e| *e == [0.0; 3]), "the first column is certain");
    }
}

fn town_view(scene: &Scene) -> ViewDemand {
    let outputs = [Output::Color, Output::Instance, Output::Depth].map(|o| demand(scene, o, State::After)).to_vec();
    view(tilted(nadir(0.0, 0.0, 0.8, 60, 44), 25.0), sun(35.0, 120.0), outputs)
}

#[test]
fn threads_change_no_byte() {
    let scene = town::town(4);
    let view = town_view(&scene);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be made");
        pool.install(|| render(&scene, &view, &Options { passes: 2, ..Options::default() }))
    };
    assert!(with(1) == with(4));
}

#[test]
fn a_seed_changes_noise_and_nothing_else() {
    let scene = town::town(3);
    let view = town_view(&scene);
    let with = |seed: u64| render(&scene, &view, &Options { seed, ..Options::default() });
    let (a, b) = (with(0), with(1));
    assert!(a.frame.images[0] != b.frame.images[0] && a.frame.images[1..] == b.frame.images[1..]);
    let (a, b) = (estimate(&a), estimate(&b));
    let far = |i: &usize| (0..3).any(|k| (a.linear[*i][k] - b.linear[*i][k]).abs() > 0.3);
    assert_eq!((0..a.linear.len()).filter(far).count(), 0);
}

#[test]
fn unchanged_pixels_are_equal_before_and_after() {
    let mut scene = town::town(3);
    scene.objects.iter_mut().for_each(|o| o.presence = crate::scene::Presence::Both);
    scene.objects[9].presence = crate::scene::Presence::BeforeOnly;
    let outputs = [State::Before, State::After].map(|s| demand(&scene, Output::Color, s)).to_vec();
    let view = view(nadir(0.0, 0.0, 1.0, 60, 60), sun(50.0, 135.0), outputs);
    let rendered = render(&scene, &view, &Options { passes: 2, ..Options::default() });
    let [before, after] = [0, 1].map(|i| town::rgb(&rendered.frame, i));
    let changed: Vec<usize> = (0..3600).filter(|i| before[i * 3..][..3] != after[i * 3..][..3]).collect();
    // The house and its shadow to the north-west lie in the lower right of the image.
    assert!(changed.len() > 60 && changed.iter().all(|i| i % 60 > 30 && i / 60 > 30), "{changed:?}");
}

#[test]
fn sampling_stops_when_it_is_enough() {
    let (scene, view, _) = edge(0.37);
    let told = RefCell::new(Vec::new());
    let tell =
        |progress: crate::reference::Progress| told.borrow_mut().push((progress.passes, progress.standard_error));
    let options = Options { side: 3, passes: 500, enough: Some(0.001), told: &tell, ..Options::default() };
    let rendered = render(&scene, &view, &options);
    let (told, estimate) = (told.borrow(), estimate(&rendered));
    let passes = told.len() as u32;
    assert!((3..500).contains(&passes) && estimate.samples == passes * 9, "{passes} passes");
    assert!(estimate.mean_standard_error <= 0.001 && told[0] == (1, None));
    assert!(told[passes as usize - 2].1.is_some_and(|e| e > 0.001), "one pass less was not enough");
}
