//! Rays slip through no edge and no corner, and the tree finds what a search of all triangles finds.

use crate::interpreter::seed::Seed;
use crate::reference::hierarchy::Hierarchy;
use crate::reference::ray::{Ray, Triangle};

fn draw(seed: Seed, number: u64) -> f64 {
    seed.part(number).unit() * 2.0 - 1.0
}

/// A closed surface: an octahedron with corners that no grid holds, split twice at jittered midpoints.
fn ball(seed: Seed) -> Vec<Triangle> {
    let corner = |k: usize, sign: f64| {
        let mut p = [0.0; 3];
        p[k] = sign * (1.0 + 0.3 * seed.part(k as u64 * 2 + u64::from(sign > 0.0)).unit());
        p
    };
    let mut triangles = Vec::new();
    for octant in 0..8 {
        let sign = |k: usize| if octant >> k & 1 == 0 { 1.0 } else { -1.0 };
        triangles.push([corner(0, sign(0)), corner(1, sign(1)), corner(2, sign(2))]);
    }
    let middle = |a: [f64; 3], b: [f64; 3]| std::array::from_fn::<f64, 3, _>(|k| (a[k] + b[k]) * 0.61);
    for _ in 0..2 {
        let split = |[a, b, c]: Triangle| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(split).collect();
    }
    triangles
}

#[test]
fn rays_at_edges_and_corners_of_a_closed_surface_never_slip_through() {
    let seed = Seed::root(7);
    for number in 0..20 {
        let triangles = ball(seed.part(number));
        let (tree, _) = Hierarchy::new(&triangles);
        for (i, triangle) in triangles.iter().enumerate() {
            for try_number in 0..12 {
                let key = seed.part(number * 10_000 + i as u64 * 20 + try_number);
                // A corner, or a point of an edge; seen from inside and from far outside.
                let share = if try_number < 3 { 0.0 } else { key.part(9).unit() };
                let (a, b) = (triangle[try_number as usize % 3], triangle[(try_number as usize + 1) % 3]);
                let aim: [f64; 3] = std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share);
                let scale = if try_number % 2 == 0 { 0.1 } else { 1e5 };
                let eye: [f64; 3] = std::array::from_fn(|k| scale * draw(key, k as u64));
                let direction = std::array::from_fn(|k| aim[k] - eye[k]);
                let ray = Ray::new(eye, direction, tree.extent(eye));
                // From outside a ray may graze the outline; from inside it must meet something.
                if try_number % 2 == 0 {
                    let mut met = false;
                    tree.walk(&ray, 0.0, f64::INFINITY, |_, t, far| {
                        met |= ray.crosses(t).is_some_and(|c| c.t > 0.0);
                        far
                    });
                    assert!(met, "surface {number}, triangle {i}, try {try_number}");
                }
                // The tree shows every triangle that the test accepts.
                let accepted = |t: &Triangle| ray.crosses(t).is_some_and(|c| c.t >= 0.0);
                let mut shown = 0;
                tree.walk(&ray, 0.0, f64::INFINITY, |_, t, far| {
                    shown += usize::from(accepted(t));
                    far
                });
                assert_eq!(shown, triangles.iter().filter(|t| accepted(t)).count(), "{number} {i} {try_number}");
            }
        }
    }
}

#[test]
fn rays_along_the_axes_in_the_planes_of_boxes_are_met() {
    // Unit squares of two triangles: rays straight down through every corner, border and diagonal.
    let mut triangles = Vec::new();
    for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (f64::from(i), f64::from(j)))) {
        let p = |di: f64, dj: f64| [i + di, 0.0, j + dj];
        triangles.push([p(0.0, 0.0), p(0.0, 1.0), p(1.0, 1.0)]);
        triangles.push([p(0.0, 0.0), p(1.0, 1.0), p(1.0, 0.0)]);
    }
    let (tree, order) = Hierarchy::new(&triangles);
    assert_eq!(order.len(), triangles.len());
    for (i, j) in (0..=32).flat_map(|i| (0..=32).map(move |j| (f64::from(i) / 4.0, f64::from(j) / 4.0))) {
        for down in [[0.0, -1.0, 0.0], [-0.0, -1.0, -0.0], [-0.0, -2.5, 0.0]] {
            let eye = [i, 100.0, j];
            let ray = Ray::new(eye, down, tree.extent(eye));
            let mut distances = Vec::new();
            tree.walk(&ray, 0.0, f64::INFINITY, |_, t, far| {
                distances.extend(ray.crosses(t).map(|c| c.t));
                far
            });
            assert!(!distances.is_empty() && distances.iter().all(|t| *t == 100.0 / -down[1]), "({i}, {j})");
        }
    }
}

#[test]
fn triangles_in_one_place_make_a_tree() {
    let same = vec![[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]; 300];
    let (tree, order) = Hierarchy::new(&same);
    let ray = Ray::new([0.25, 1.0, 0.25], [0.0, -1.0, 0.0], tree.extent([0.25, 1.0, 0.25]));
    let mut met = 0;
    tree.walk(&ray, 0.0, f64::INFINITY, |_, _, far| {
        met += 1;
        far
    });
    assert_eq!((met, order.len()), (300, 300));
}
