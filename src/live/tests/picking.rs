//! What is under the cursor, and what rules cost.

use glam::DVec3;

use super::workshop::{Workshop, updated};
use crate::live::{Ray, usage};
use crate::plan::demand::State;
use crate::scene::{Presence, SceneClass};

#[test]
fn a_ray_from_above_meets_the_roof_and_one_from_aside_a_wall() {
    let shop = Workshop::new();
    let mut session = shop.session();
    updated(&mut session);
    let built = session.built().expect("something is shown").clone();
    let houses = built.scene.objects.iter().filter(|o| o.class == SceneClass::Building && o.presence == Presence::Both);
    let mut seen = std::collections::BTreeSet::new();
    for house in houses {
        let (low, high) = house.mesh.bounds().expect("it is not empty");
        // Through the middle of a wall or roof triangle, a little to its front.
        for (triangle, [a, b, c]) in
            house.mesh.triangles.iter().map(|t| t.map(|i| house.mesh.positions[i as usize])).enumerate()
        {
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let middle = (a + b + c) / 3.0;
            if normal == DVec3::ZERO || middle.y < low.y + 2.0 || triangle % 7 > 0 {
                continue;
            }
            let ray = Ray { origin: middle + normal * 0.05, direction: -normal };
            let info = session.lot(house.instance, State::After, Some(ray)).expect("it is there");
            assert_eq!(info.feature, house.feature.map(|f| f.to_string()));
            let group = house.mesh.groups.iter().find(|g| (g.first..g.first + g.count).contains(&(triangle as u32)));
            let material = &built.scene.materials[group.expect("groups cover a mesh").material as usize];
            if &*material.name == "foundation" {
                assert_eq!(info.leaf, None, "no rule made it");
                continue;
            }
            let leaf = info.leaf.expect("the ray meets it");
            assert_eq!(leaf.rules.first().map(String::as_str), Some("Lot"));
            let file = leaf.file.rsplit('/').next().expect("a name").to_owned();
            let line = shop.read(&file).lines().nth(leaf.line - 1).expect("the line is there").to_owned();
            let own = leaf.rules.last().expect("a name");
            let own = own.rsplit('.').next().expect("a name");
            assert!(line.contains(own), "{own} was not made by `{line}`");
            if info.rule_file.as_deref() == Some("house.cga") {
                let is_roof = normal.y.abs() > 0.1;
                assert_eq!(own == "Tile", is_roof, "{leaf:?} {normal}");
                assert!(info.attributes.iter().any(|(name, value)| name == "storey" && value == "2.8"));
            }
            seen.insert(own.to_owned());
        }
        assert!(high.y > low.y);
    }
    for leaf in ["Window", "Tile", "Side", "Flat"] {
        assert!(seen.contains(leaf), "{seen:?}");
    }
    assert_eq!(session.lot(u32::MAX, State::After, None), None);
    let terrain = session.lot(1, State::Before, None).expect("the terrain is there");
    assert_eq!((terrain.feature, terrain.class, terrain.leaves), (None, "terrain", 0));
}

#[test]
fn a_burnt_house_is_another_thing_before_and_after() {
    let shop = Workshop::new();
    let mut session = shop.session();
    updated(&mut session);
    let built = session.built().expect("something is shown").clone();
    let burnt =
        built.scene.objects.iter().find(|o| o.presence == Presence::AfterOnly && o.class == SceneClass::Building);
    let burnt = burnt.expect("some house burnt").instance;
    let info = |state| session.lot(burnt, state, None).expect("it is there in both states");
    let (before, after) = (info(State::Before), info(State::After));
    assert_eq!(before.rule_file.as_deref(), Some("house.cga"));
    assert_eq!((after.rule_file.as_deref(), after.change.as_deref()), (Some("ruin.cga"), Some("burnt")));
    assert_eq!((before.leaves > after.leaves, after.leaves), (true, 2));
}

#[test]
fn rules_are_counted_where_they_run() {
    let shop = Workshop::new();
    let mut session = shop.session();
    updated(&mut session);
    let recipe = session.recipe().expect("something is shown");
    let usage = usage(recipe, 0).expect("the town is sound");
    let of = |rule: &str| {
        let all = usage.iter().filter(|usage| usage.rule == rule);
        all.fold((0, 0), |(calls, leaves), usage| (calls + usage.calls, leaves + usage.leaves))
    };
    let (masses, _) = of("Mass");
    assert!(masses > 0);
    assert_eq!(of("Roof").0, masses);
    assert!(of("Facade").0 >= 3 * masses);
    let (tiles, leaves) = of("lib.Tiles");
    assert!(tiles >= masses && leaves >= tiles, "{tiles} {leaves}");
    assert_eq!(of("Window").0, of("Window").1);
    assert!(usage.iter().map(|usage| usage.milliseconds).sum::<f64>() > 0.0);
}
