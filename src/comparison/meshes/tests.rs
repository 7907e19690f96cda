//! A mesh against itself is the same; whatever is done to one feature is told of exactly that feature.

use proptest::prelude::*;

use super::*;

fn mesh(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> Mesh {
    let count = corners.len();
    Mesh {
        positions: corners.iter().map(|c| DVec3::from_array(*c)).collect(),
        normals: (0..count).map(|i| Vec3::new(i as f32, 1.0, 0.0)).collect(),
        uvs: vec![(0, (0..count).map(|i| Vec2::new(i as f32, 0.5)).collect())],
        triangles: triangles.to_vec(),
        groups: vec![MaterialGroup { material: "brick".into(), first: 0, count: triangles.len() as u32 }],
    }
}

/// A mesh whose corners are all apart.
fn any_mesh() -> impl Strategy<Value = Mesh> {
    (3usize..20, 1usize..20).prop_flat_map(|(corners, triangles)| {
        let place = move |i: usize| (-50.0..50.0f64).prop_map(move |x| [100.0 * i as f64 + x, x * 0.5, -x]);
        let index = 0..corners as u32;
        let triangle = (index.clone(), index.clone(), index).prop_map(|(a, b, c)| [a, b, c]);
        let places: Vec<_> = (0..corners).map(place).collect();
        (places, proptest::collection::vec(triangle, triangles)).prop_map(|(p, t)| mesh(&p, &t))
    })
}

fn scene(meshes: &[Mesh]) -> SceneSnapshot {
    let object = |(i, mesh): (usize, &Mesh)| ObjectSnapshot {
        feature: format!("way/{i}"),
        class: "building".to_owned(),
        before: i % 3 != 1,
        after: i % 3 != 2,
        mesh: mesh.clone(),
    };
    SceneSnapshot { objects: meshes.iter().enumerate().map(object).collect(), ..SceneSnapshot::default() }
}

proptest! {
    #[test]
    fn a_mesh_is_the_same_as_itself(mesh in any_mesh()) {
        prop_assert_eq!(compare_surfaces(&[&mesh], &[&mesh]), Surface::Same);
    }

    #[test]
    fn order_makes_no_difference(mesh in any_mesh(), turn in 0usize..3, by in 0usize..20) {
        let mut other = mesh.clone();
        let by = by % other.triangles.len();
        other.triangles.rotate_left(by);
        other.triangles.iter_mut().for_each(|t| t.rotate_left(turn));
        prop_assert!(compare_surfaces(&[&mesh], &[&other]).is_same());
    }

    #[test]
    fn one_vertex_moved_is_exactly_that_feature(
        meshes in proptest::collection::vec(any_mesh(), 1..6), which in 0usize..6, corner in 0usize..20, by in 1e-9..3.0f64,
    ) {
        let which = which % meshes.len();
        let a = scene(&meshes);
        prop_assert!(compare_meshes(&a, &a).is_none());
        let mut moved = meshes.clone();
        // One that a triangle uses.
        let triangle = moved[which].triangles[corner % moved[which].triangles.len()];
        moved[which].positions[triangle[corner % 3] as usize].y += by;
        let found = compare_meshes(&a, &scene(&moved));
        prop_assert_eq!(found.features.len(), 1);
        let found = &found.features[0];
        prop_assert_eq!(&found.feature, &format!("way/{which}"));
        for (surface, is_in) in [(found.before, which % 3 != 1), (found.after, which % 3 != 2)] {
            match surface {
                Surface::Shape { moved_m: Some(moved_m), gone, new, .. } => {
                    prop_assert!(is_in && (moved_m - by).abs() < 1e-9 && gone == new && gone > 0, "{:?}", surface);
                }
                other => prop_assert!(!is_in && other == Surface::Same, "{:?}", other),
            }
        }
    }
}

#[test]
fn looks_and_shapes_are_told_apart() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
    let a = mesh(&square, &[[0, 1, 2], [0, 2, 3]]);
    let mut painted = a.clone();
    painted.groups[0].material = "plaster".into();
    assert_eq!(compare_surfaces(&[&a], &[&painted]), Surface::Look { triangles: 2 });
    let mut turned = a.clone();
    turned.triangles[1].swap(0, 1);
    let shape = |gone, new, a, b, moved_m| Surface::Shape { triangles_a: a, triangles_b: b, gone, new, moved_m };
    assert_eq!(compare_surfaces(&[&a], &[&turned]), shape(1, 1, 2, 2, None));
    let half = mesh(&square, &[[0, 1, 2]]);
    assert_eq!(compare_surfaces(&[&a], &[&half]), shape(1, 0, 2, 1, None));
    assert_eq!(compare_surfaces(&[], &[&half]), shape(0, 1, 0, 1, None));
    // Two halves are the whole.
    let other = mesh(&square, &[[0, 2, 3]]);
    assert_eq!(compare_surfaces(&[&a], &[&other, &half]), Surface::Reordered);
}
