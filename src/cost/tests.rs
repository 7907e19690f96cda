//! A small town measured: errors fall where knobs are turned up, budgets are kept, work is counted. Without an adapter
//! this says so and passes.

use super::bench::{Bench, Part, Setting, Windows};
use super::budget::{Outcome, choose};
use super::knobs::{FINE, Subject};
use super::work::work;
use crate::gpu::tests::town::{self, demand, nadir, sun, view};
use crate::plan::demand::{Ambient, Look, Output, Quality, Shadows, State, ViewDemand};
use crate::scene::Scene;
use crate::spec::render_spec::{BudgetSpec, FixedKnobs};

const WINDOWS: Windows = Windows { side: 32, count: 4, enough: 4e-3 };

fn small_town() -> (Scene, ViewDemand) {
    let scene = town::town(5);
    let mut color = demand(&scene, Output::Color, State::After);
    color.look = Look::plain(Shadows::Hard, Ambient::Constant([0.2; 3]));
    (scene, view(nadir(0.3, -0.2, 0.9, 96, 96), sun(40.0, 130.0), vec![color]))
}

fn subject(view: &ViewDemand) -> Subject<'_> {
    Subject { look: &view.outputs[0].look, sun: true, textures: true }
}

#[test]
fn finer_settings_err_less() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let (scene, view) = small_town();
    let mut bench =
        Bench::new(&mut renderer, &scene, std::slice::from_ref(&view), Some(0.5), WINDOWS, &|_| {}).expect("it traces");
    let mut errors = |change: &dyn Fn(&mut Quality)| {
        let mut quality = FINE;
        change(&mut quality);
        bench.errors(&Setting::of(quality)).expect("it draws")
    };
    let fine = errors(&|_| {});
    let one_sample = errors(&|q| q.supersample = 1);
    let coarse_map = errors(&|q| q.shadow_map = 256);
    assert!(fine.light < 0.01 && fine.light * 3.0 < one_sample.light, "{fine:?} {one_sample:?}");
    let edges = [fine, one_sample].map(|e| e.edge.expect("houses have edges"));
    assert!(edges[0] * 2.0 < edges[1] && edges[1] > 0.15 && edges[1] < 0.6, "{edges:?}");
    assert!(fine.shadow.expect("shadows") < 0.03 && coarse_map.shadow > fine.shadow, "{fine:?} {coarse_map:?}");
    assert!(coarse_map.edge == fine.edge, "shadows move no edges");
    assert!(fine.label < 0.01 && fine.label == one_sample.label && fine.height == Some(0.5));
    let without = Setting { shadows: Some(Shadows::Off), ..Setting::of(FINE) };
    let without = bench.errors(&without).expect("it draws");
    assert!(without.shadow == Some(1.0) && without.light > 3.0 * fine.light, "{without:?}");
    let times = bench.time(&Setting::of(FINE), 2).expect("it draws");
    assert!(times.least > 0.0 && times.least <= times.median && times.median <= times.most && times.repeats == 2);
    assert!(times.passes.iter().any(|(pass, _)| pass == "shade"), "{:?}", times.passes);
}

#[test]
fn promises_are_kept_in_other_windows() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let (scene, view) = small_town();
    let views = std::slice::from_ref(&view);
    let mut bench = Bench::new(&mut renderer, &scene, views, None, WINDOWS, &|_| {}).expect("it traces");
    let mut costs = Vec::new();
    for error in [0.05, 0.02, 0.01, 0.005] {
        let budget = BudgetSpec { error: Some(error), ..BudgetSpec::default() };
        let outcome = choose(&mut bench, subject(&view), views, 1000, FINE, &budget).expect("it draws");
        let Outcome::Kept(choice) = outcome else { panic!("{error}: {outcome:?}") };
        assert!(choice.achieved.light <= error && choice.calibrated.light <= error, "{error}: {choice:?}");
        costs.push(work(&view, &choice.quality, 1000));
    }
    assert!(costs.is_sorted() && costs[0] < costs[3], "{costs:?}");
    let fixed = FixedKnobs { supersample: true, ..FixedKnobs::default() };
    let budget = BudgetSpec { error: Some(1e-4), fixed, ..BudgetSpec::default() };
    let own = Quality { supersample: 1, ..FINE };
    let outcome = choose(&mut bench, subject(&view), views, 1000, own, &budget).expect("it draws");
    let Outcome::Missed(best) = outcome else { panic!("{outcome:?}") };
    assert!(best.quality.supersample == 1 && best.quality.shadow_map == 8192 && best.achieved.light > 1e-4);
}

#[test]
fn halves_of_the_windows_are_all_of_them() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let (scene, view) = small_town();
    let mut bench =
        Bench::new(&mut renderer, &scene, std::slice::from_ref(&view), None, WINDOWS, &|_| {}).expect("it traces");
    let setting = Setting::of(Quality { supersample: 1, ..FINE });
    let mut differing = |part| bench.errors_in(part, &setting).expect("it draws").light;
    let [all, one, other] = [Part::All, Part::Calibration, Part::Check].map(&mut differing);
    assert!((all * all - (one * one + other * other) / 2.0).abs() < 1e-9, "{all} {one} {other}");
}

#[test]
fn more_of_anything_is_more_work() {
    let (_, mut view) = small_town();
    view.outputs[0].look.shadows = Shadows::Soft;
    view.outputs[0].look.ambient = Ambient::Sky { zenith: [0.3; 3], ground: [0.1; 3], occluded: true };
    let base = Quality { supersample: 2, shadow_map: 2048, shadow_samples: 4, sky_samples: 24, field_map: 512 };
    let at = |change: &dyn Fn(&mut Quality)| {
        let mut quality = base;
        change(&mut quality);
        work(&view, &quality, 1000)
    };
    let least = at(&|_| {});
    assert!(at(&|q| q.supersample = 3) > least && at(&|q| q.shadow_map = 4096) > least);
    assert!(at(&|q| q.shadow_samples = 8) > least && at(&|q| q.sky_samples = 64) > least);
    assert_eq!(at(&|q| q.field_map = 4096), least, "there are no fields");
    assert!(work(&view, &base, 100_000) > least);
}
