//! What is done again after each kind of change, counted.

use super::workshop::{Told, Workshop, updated};
use crate::interpreter::tree::Scalar;
use crate::live::{AttributeOverride, Overrides, Redone, SunAngles, Update};

/// States of the town by their rule file, from what the first update derived.
fn begun(shop: &Workshop) -> (crate::live::Session, usize) {
    let mut session = shop.session();
    let first = updated(&mut session);
    assert!(!first.stands && first.diagnostics.is_empty(), "{:?}", first.diagnostics);
    assert!(first.redone.recipe && first.redone.place && first.redone.ground && first.redone.scene);
    assert_eq!((first.redone.programs, first.redone.lots_kept), (4, 0));
    (session, first.redone.lots_derived)
}

#[track_caller]
fn whole(update: &Update, shop: &Workshop, session: &crate::live::Session) {
    assert!(!update.stands, "{:?}", update.diagnostics);
    assert_eq!(Told::of(session), shop.cold().expect("the files are sound"));
}

#[test]
fn nothing_is_done_where_nothing_changed() {
    let shop = Workshop::new();
    let (mut session, all) = begun(&shop);
    let text = shop.read("house.cga");
    shop.write("house.cga", &text);
    let update = updated(&mut session);
    assert_eq!(update.redone, Redone::default());
    assert_eq!((update.changed.len(), update.scene), (0, 1));
    // Another text that means the same.
    shop.write("house.cga", &format!("// a comment\n{}", text.replace("extrude(height)", "extrude( height )")));
    let update = updated(&mut session);
    assert_eq!((update.redone.lots_derived, update.redone.lots_kept), (0, all));
    assert!(update.redone.recipe && !update.redone.scene && !update.redone.views && !update.redone.ground);
    assert_eq!(update.scene, 1);
    whole(&update, &shop, &session);
}

#[test]
fn a_changed_rule_concerns_the_lots_that_used_it() {
    let shop = Workshop::new();
    let (mut session, all) = begun(&shop);
    // Every house has a roof, and no other feature has.
    shop.edit("house.cga", "roofHip(30)", "roofHip(35)");
    let update = updated(&mut session);
    let houses = update.redone.lots_derived;
    assert!(houses > 0 && houses < all, "{houses} of {all}");
    assert!(!update.redone.place && !update.redone.ground && update.redone.scene);
    whole(&update, &shop, &session);
    // Plain floors are drawn for some.
    shop.edit("house.cga", "Plain --> color(wall)", "Plain --> color(1, 1, 1)");
    let update = updated(&mut session);
    assert!(update.redone.lots_derived > 0 && update.redone.lots_derived <= houses);
    whole(&update, &shop, &session);
    // A rule that nobody uses yet, in front of all others.
    shop.edit("house.cga", "@StartRule", "Unused --> NIL\n@StartRule");
    assert_eq!(updated(&mut session).redone.lots_derived, 0);
    // A rule of an imported file.
    shop.edit("lib.cga", "color(dark)", "color(dark) set(material.roughness, 0.4)");
    let update = updated(&mut session);
    assert_eq!(update.redone.lots_derived, houses);
    assert_eq!(update.changed.len(), 1);
    whole(&update, &shop, &session);
    shop.edit("house.cga", "2 * x", "3 * x");
    let update = updated(&mut session);
    assert!(update.redone.lots_derived > 0 && update.redone.lots_derived <= houses);
    whole(&update, &shop, &session);
}

#[test]
fn a_changed_default_concerns_the_lots_that_do_not_override_it() {
    let shop = Workshop::new();
    let (mut session, _) = begun(&shop);
    // Every lot has a height by its tags or the recipe, and the recipe says the storeys.
    shop.edit("house.cga", "attr height = 6", "attr height = 7");
    assert_eq!(updated(&mut session).redone.lots_derived, 0);
    shop.edit("house.cga", "attr storey = 3", "attr storey = 4");
    assert_eq!(updated(&mut session).redone.lots_derived, 0);
    // Nobody reads it.
    shop.edit("house.cga", "attr garden = 0", "attr garden = 1");
    assert_eq!(updated(&mut session).redone.lots_derived, 0);
    shop.edit("ruin.cga", "attr left = 1", "attr left = 2");
    let update = updated(&mut session);
    let ruins = update.redone.lots_derived;
    assert!(ruins > 0, "some houses burnt");
    whole(&update, &shop, &session);
    // An attribute that nobody knew.
    shop.edit("ruin.cga", "attr left", "attr more = 1\nattr left");
    assert_eq!(updated(&mut session).redone.lots_derived, 0);
    shop.edit("ruin.cga", "extrude(left)", "extrude(left + more)");
    let update = updated(&mut session);
    assert_eq!(update.redone.lots_derived, ruins);
    whole(&update, &shop, &session);
}

#[test]
fn a_changed_sun_draws_the_views_anew_and_nothing_else() {
    let shop = Workshop::new();
    let (mut session, all) = begun(&shop);
    shop.edit("town.render", "elevation 50deg", "elevation 20deg");
    let update = updated(&mut session);
    assert!(update.redone.views && !update.redone.scene && !update.redone.ground && !update.redone.place);
    assert_eq!((update.redone.lots_derived, update.redone.lots_kept), (0, all));
    let sun = Some(SunAngles { elevation: 60.0, azimuth: 90.0 });
    let update = session.update(&Overrides { sun, ..Overrides::default() });
    assert_eq!(update.redone, Redone { lots_kept: all, views: true, ..Redone::default() });
    let direction = session.views()[0].demands[0].sun.expect("it is lit").direction;
    assert!((direction.x - 0.5).abs() < 1e-9 && direction.z.abs() < 1e-9, "{direction}");
    assert_eq!(update.scene, 1);
}

#[test]
fn overrides_stand_in_place_of_the_recipe_s_values() {
    let shop = Workshop::new();
    let (mut session, all) = begun(&shop);
    let before = Told::of(&session);
    let value = |value| AttributeOverride { file: "block.cga".to_owned(), name: "height".to_owned(), value };
    let attributes = vec![value(Scalar::Float(20.0))];
    let update = session.update(&Overrides { attributes, ..Overrides::default() });
    assert!(update.redone.lots_derived > 0 && update.redone.lots_derived < all && !update.redone.recipe);
    shop.edit("town.render", "rules \"block.cga\" for building", "rules \"block.cga\" for building { height = 20m }");
    let shown = Told::of(&session);
    assert_eq!(shown.glb, shop.cold().expect("sound").glb);
    let update = session.update(&Overrides { seed: Some(99), ..Overrides::default() });
    assert_eq!(update.redone.lots_derived + update.redone.lots_kept, all);
    shop.edit("town.render", "seed      3", "seed      99");
    assert_eq!(Told::of(&session).glb, shop.cold().expect("sound").glb);
    // Everything as it was.
    shop.edit("town.render", "seed      99", "seed      3");
    shop.edit("town.render", " { height = 20m }", "");
    updated(&mut session);
    assert_eq!(Told::of(&session), before);
}

#[test]
fn mistakes_leave_the_last_good_scene_and_a_fix_clears_them() {
    let shop = Workshop::new();
    let (mut session, all) = begun(&shop);
    let before = Told::of(&session);
    shop.edit("house.cga", "Facade -->", "Facade ->");
    let update = updated(&mut session);
    assert!(update.stands && update.has_errors() && update.scene == 1);
    let place = update.diagnostics[0].place.as_ref().expect("it has a place");
    assert!(place.file.ends_with("house.cga") && place.line == 11, "{place:?}");
    assert_eq!(Told::of(&session), before);
    // The same again, with nothing saved meanwhile.
    let update = updated(&mut session);
    assert!(update.stands && update.has_errors() && update.redone == Redone::default());
    shop.edit("house.cga", "Facade ->", "Facade -->");
    let update = updated(&mut session);
    assert!(!update.stands && update.diagnostics.is_empty());
    assert_eq!((update.redone.lots_derived, update.redone.lots_kept), (0, all));
    std::fs::remove_file(shop.path("lib.cga")).expect("it is there");
    let update = updated(&mut session);
    assert!(update.stands && update.has_errors());
    shop.write("lib.cga", super::workshop::LIB);
    assert!(!updated(&mut session).stands);
    assert_eq!(Told::of(&session), before);
}

#[test]
fn rules_that_never_end_are_given_up_after_a_few_lots() {
    let shop = Workshop::new();
    let (mut session, _) = begun(&shop);
    shop.edit("house.cga", "Mass -->", "Mass --> Mass Mass\nOld -->");
    let update = updated(&mut session);
    assert!(update.stands && update.has_errors());
    assert!(update.diagnostics.iter().any(|d| d.code.starts_with("cga::limit")), "{:?}", update.diagnostics);
    assert!(update.diagnostics.iter().any(|d| d.message.contains("given up")));
    shop.edit("house.cga", "Mass --> Mass Mass\nOld -->", "Mass -->");
    let update = updated(&mut session);
    assert!(!update.stands);
    whole(&update, &shop, &session);
}

#[test]
fn what_is_no_longer_wanted_is_given_up_once() {
    let shop = Workshop::new();
    let (mut session, _) = begun(&shop);
    let stop = session.stop();
    shop.edit("house.cga", "roofHip(30)", "roofHip(35)");
    // The flag is cleared when an update begins, so it is set from beside.
    let setting = std::thread::spawn(move || {
        for _ in 0..2_000 {
            stop.store(true, std::sync::atomic::Ordering::Relaxed);
            std::thread::sleep(std::time::Duration::from_micros(500));
        }
    });
    let update = updated(&mut session);
    assert!(update.cancelled && update.stands);
    let update = updated(&mut session);
    assert!(!update.cancelled && !update.stands && update.redone.lots_derived > 0);
    setting.join().expect("it does not panic");
    whole(&update, &shop, &session);
}

#[test]
fn prints_and_warnings_come_again_with_their_places() {
    let shop = Workshop::new();
    shop.edit("house.cga", "Lot --> extrude", "Lot --> print(height) extrude");
    let (mut session, _) = begun(&shop);
    shop.edit("house.cga", "@StartRule", "// a line more\n@StartRule");
    let update = updated(&mut session);
    whole(&update, &shop, &session);
    shop.edit("house.cga", "roofHip(30)", "roofHip(0 / 0)");
    let update = updated(&mut session);
    whole(&update, &shop, &session);
    shop.edit("house.cga", "// a line more\n", "");
    let update = updated(&mut session);
    whole(&update, &shop, &session);
}
