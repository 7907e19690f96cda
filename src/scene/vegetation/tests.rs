//! Plants of small maps: where they stand, that they are closed, that they follow their keys.

use proptest::prelude::*;

use super::*;
use crate::geodata::feature::{ObjectKind, Tags};
use crate::geodata::greenery::{Row, RowKind, SinglePlant, Stand, StandKind};
use crate::geometry::Polygon;

fn square(low: f64, high: f64) -> Polygon {
    let outer = [(low, low), (high, low), (high, high), (low, high)].map(DVec2::from).to_vec();
    Polygon { outer, holes: Vec::new() }
}

fn id(id: i64) -> FeatureId {
    FeatureId { kind: ObjectKind::Way, id, part: 0 }
}

fn wood(outline: Polygon) -> Greenery {
    let stand = Stand { id: id(7), kind: StandKind::Wood, outline, tags: Tags::new() };
    Greenery { stands: vec![stand], ..Greenery::default() }
}

fn taken(polygons: Vec<Polygon>) -> Sites {
    Sites { taken: Obstacles::new(polygons), ..Sites::default() }
}

fn plants(greenery: &Greenery, sites: &Sites) -> Vec<Plant> {
    placing::groups(greenery, sites, Seed::root(3)).into_iter().flat_map(|group| group.plants).collect()
}

#[test]
fn a_wood_is_full_of_trees_that_keep_clear_of_a_house() {
    let sites = taken(vec![square(30.0, 50.0)]);
    let plants = plants(&wood(square(0.0, 100.0)), &sites);
    let trees = plants.iter().filter(|p| p.form != Form::Bush).count();
    assert!((150..260).contains(&trees), "{trees} trees on 0.96 ha");
    for plant in &plants {
        let outside = (plant.at - DVec2::splat(40.0)).abs().max_element() - 10.0;
        assert!(outside > 0.0 && sites.is_free(plant.at, 0.6 * plant.crown), "{plant:?} in the house");
    }
    let nearest = |i: usize| (0..i).map(|j| (plants[i].at - plants[j].at).length()).fold(f64::INFINITY, f64::min);
    let closest = (1..plants.len()).map(nearest).fold(f64::INFINITY, f64::min);
    assert!(closest > 2.0, "two trees {closest} m apart");
}

#[test]
fn cutting_the_area_moves_no_tree() {
    let all = plants(&wood(square(0.0, 100.0)), &Sites::default());
    let half = plants(&wood(square(0.0, 50.0)), &Sites::default());
    assert!(!half.is_empty() && half.iter().all(|plant| all.contains(plant)));
}

#[test]
fn mapped_trees_have_their_place_and_size() {
    let tags = |pairs: &[(&str, &str)]| pairs.iter().map(|&(k, v)| (k.into(), v.into())).collect::<Tags>();
    let tall = tags(&[("natural", "tree"), ("height", "21"), ("diameter_crown", "9 m"), ("leaf_type", "needleleaved")]);
    let mut greenery = Greenery::default();
    greenery.single.push(SinglePlant { id: id(1), at: DVec2::new(3.0, 4.0), tags: tall });
    greenery.single.push(SinglePlant { id: id(2), at: DVec2::new(12.0, 12.0), tags: Tags::new() });
    let mut scene = Scene::default();
    let paved = Obstacles::new(vec![square(0.0, 6.0)]);
    let sites = Sites { paved, ..taken(vec![square(10.0, 20.0)]) };
    let planted = plant(&mut scene, &greenery, &sites, &|_| Some(100.0), Seed::root(0));
    assert_eq!(planted.grown, [(id(1), 1)]);
    assert_eq!(planted.bare, [(id(2), "it stands in a building or in water".to_owned())]);
    let mesh = &scene.objects[0].mesh;
    let top = mesh.positions.iter().map(|p| p.y).fold(0.0, f64::max);
    assert!((top - 121.0).abs() < 1e-9, "{top}");
    let reach = mesh.positions.iter().map(|p| DVec2::new(p.x - 3.0, p.z + 4.0).length()).fold(0.0, f64::max);
    assert!((3.9..5.1).contains(&reach), "a crown of {reach} m");
}

#[test]
fn hedges_and_rows_follow_their_line() {
    let line = vec![DVec2::ZERO, DVec2::new(40.0, 0.0), DVec2::new(40.0, 40.0)];
    let row = |number, kind| Row { id: id(number), kind, line: line.clone(), tags: Tags::new() };
    let greenery = Greenery { rows: vec![row(1, RowKind::Trees), row(2, RowKind::Hedge)], ..Greenery::default() };
    let groups = placing::groups(&greenery, &Sites::default(), Seed::root(3));
    assert_eq!(groups.iter().map(|g| g.plants.len()).collect::<Vec<_>>(), [10, 89]);
    assert!(groups[1].plants.iter().all(|p| p.form == Form::Bush && (p.at.y == 0.0 || p.at.x == 40.0)));
}

#[test]
fn what_stands_on_unknown_ground_is_told() {
    let mut scene = Scene::default();
    let planted = plant(&mut scene, &wood(square(0.0, 30.0)), &Sites::default(), &|_| None, Seed::root(0));
    assert!(scene.objects.is_empty() && planted.grown.is_empty() && planted.bare.len() == 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Every edge of a plant has two triangles, each with its own direction, and the inside is the smaller side.
    #[test]
    fn plants_are_closed_bodies(form in 0usize..3, height in 0.5..30.0f64, share in 0.1..0.9f64, seed in any::<u64>()) {
        let form = [Form::Broadleaved, Form::Conifer, Form::Bush][form];
        let plant = Plant { at: DVec2::new(5.0, -3.0), form, height, crown: height * share, seed: Seed::root(seed) };
        let (mesh, _, _) = mesh(&[plant], &|_| Some(2.0));
        let mut edges = std::collections::BTreeMap::new();
        let mut volume = 0.0;
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize] - mesh.positions[0]);
            volume += a.dot(b.cross(c)) / 6.0;
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
            }
        }
        prop_assert!(edges.values().all(|&balance| balance == 0));
        prop_assert!(volume > 0.0);
        prop_assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5));
    }
}
