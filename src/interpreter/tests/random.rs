//! Reference 2.2, 2.9: draws depend on the seed and the place in the tree, not on what happens elsewhere.

use super::*;

fn prints(rules: &str, seed: u64) -> Vec<String> {
    derive(&compiled(rules), &start(ground(LOT), seed), &NoAssets, &Limits::default()).prints
}

#[test]
fn the_same_seed_gives_the_same_and_another_another() {
    let rules = "attr a = rand\nLot --> split(x) { ~1 : A }*\nA --> print(rand(1, 2)) print(a) NIL";
    assert_eq!(prints(rules, 7), prints(rules, 7));
    assert_ne!(prints(rules, 7), prints(rules, 8));
    let drawn = prints(rules, 7);
    let mut own: Vec<&String> = drawn.iter().step_by(2).collect();
    own.sort();
    own.dedup();
    assert_eq!(own.len(), 20, "every piece draws for itself");
}

#[test]
fn neighbours_do_not_matter() {
    let plain = prints("Lot --> split(x) { 10 : NIL | 10 : A }\nA --> print(rand) split(y) { ~1 : NIL }", 1);
    let busy = prints(
        "f = rand\nLot --> split(x) { 10 : B B t(f, f, 0) B | 10 : A }\nA --> print(rand) NIL\nB --> color(rand, f, f) X.",
        1,
    );
    assert_eq!(plain, busy);
}

#[test]
fn position_does_not_matter() {
    let rules = compiled("Lot --> print(rand) comp(fe) { all : print(rand) NIL }");
    let moved: Vec<(f64, f64)> = LOT.iter().map(|&(x, z)| (x + 1000.0, z - 500.0)).collect();
    let here = derive(&rules, &start(ground(LOT), 3), &NoAssets, &Limits::default());
    let there = derive(&rules, &start(ground(&moved), 3), &NoAssets, &Limits::default());
    assert_eq!((here.prints.len(), here.prints), (5, there.prints));
}

#[test]
fn a_function_draws_anew_at_every_use() {
    let drawn = prints("h = rand(3, 5)\nLot --> print(h) print(h) print(h + h) NIL", 5);
    assert_ne!(drawn[0], drawn[1]);
    let x: Vec<f64> = drawn.iter().map(|l| l.parse().expect("a number")).collect();
    assert!(x[..2].iter().all(|x| (3.0..5.0).contains(x)));
    assert_ne!(x[0] + x[1], x[2]);
}

#[test]
fn shares_come_out_as_written() {
    let rules = "Lot --> split(x) { ~0.01 : A }*\nA --> 20% : One. 30% : Two. 0% : Never. else : Rest.";
    let tree = run(rules, LOT);
    let n = tree.leaves.len() as f64;
    for (rule, share) in [("One", 0.2), ("Two", 0.3), ("Never", 0.0), ("Rest", 0.5)] {
        let got = count(&tree, rule) as f64 / n;
        assert!((got - share).abs() < 0.04, "{rule}: {got}");
    }
}

#[test]
fn setting_the_seed_repeats_the_draws() {
    let drawn =
        prints("Lot --> A A B\nA --> set(seedian, 42) print(seedian) print(rand) NIL\nB --> print(rand) NIL", 0);
    assert_eq!((&drawn[0][..], &drawn[1]), ("42", &drawn[3]));
    assert_ne!(drawn[4], drawn[1]);
}
