//! Reference 4.16.4, 6.8: labels, occlusion and context queries, two passes.

use super::super::context::{Batch, Member, Survey};
use super::*;

/// Lines printed by a batch of lots of one program, lot by lot. Runs it three ways that must agree.
#[track_caller]
fn batch(rules: &str, lots: &[&[(f64, f64)]]) -> Vec<Vec<String>> {
    let program = compiled(rules);
    let lot = |corners: &&[(f64, f64)]| Member {
        program: &program,
        start: start(ground(corners), 0).into(),
        is_in: 1,
        sees: 1,
    };
    let lots: Vec<Member> = lots.iter().map(lot).collect();
    let limits = Limits::default();
    let batch = Batch::new(&lots, &NoAssets, &limits);
    let trees = batch.derive_all();
    let prints: Vec<Vec<String>> = trees.iter().map(|t| t.prints.clone()).collect();
    // Backwards.
    let mut surveys: Vec<Option<Survey>> = (0..lots.len()).map(|_| None).collect();
    (0..lots.len()).rev().for_each(|i| surveys[i] = batch.survey(i));
    let again: Vec<_> = (0..lots.len()).rev().map(|i| batch.derive(i, &surveys, &NoAssets).prints).collect();
    assert!(again.into_iter().rev().eq(prints.iter().cloned()), "the order does not matter");
    // Each on a thread of its own.
    let threads: Vec<_> = std::thread::scope(|scope| {
        let (batch, surveys) = (&batch, &surveys);
        let handles: Vec<_> =
            (0..lots.len()).map(|i| scope.spawn(move || batch.derive(i, surveys, &NoAssets).prints)).collect();
        handles.into_iter().map(|h| h.join().expect("no panic")).collect()
    });
    assert_eq!(threads, prints);
    prints
}

/// A tower of 4 x 4 x 6 in the south-west corner of the test lot, and probes: what they are asked at places x along
/// the front, y up, each 2 x 2 x 2.
fn probe(question: &str, places: &[(f64, f64)]) -> Vec<String> {
    let probes: String = places.iter().map(|(x, y)| format!("[ t({x}, {y}, 0) Probe ] ")).collect();
    let rules = format!(
        "Lot --> [ s(4, '1, 4) t(0, 0, 6) extrude(6) Tower. ] {probes}
Probe --> s(2, '1, 2) t(0, 0, 8) extrude(2) print({question}) Box."
    );
    run(&rules, LOT).prints
}

#[test]
fn boxes_within_across_beside_and_away() {
    let places = [(1.0, 1.0), (3.0, 1.0), (4.0, 1.0), (8.0, 1.0), (1.0, 6.0)];
    // Far enough from each other that the probes do not meet themselves.
    let one_by_one = |question: &str| -> Vec<String> { places.iter().flat_map(|p| probe(question, &[*p])).collect() };
    assert_eq!(one_by_one("inside"), ["true", "false", "false", "false", "false"]);
    assert_eq!(one_by_one("overlaps(intra)"), ["true", "true", "false", "false", "false"]);
    assert_eq!(one_by_one("touches(all)"), ["true", "true", "true", "false", "true"]);
    assert_eq!(one_by_one("touches(inter)"), ["false"; 5]);
}

#[test]
fn faces_edges_and_points_are_asked_too() {
    let rules = r#"Lot --> [ s(4, '1, 4) t(0, 0, 6) extrude(6) label("tower") Tower. ] [ s(2, '1, 2) t(4, 0, 8) extrude(2) Side ]
      [ s(2, '1, 2) t(3, 1, 8) extrude(2) Half ]
Side --> comp(f) { left : Ask("left") | right : Ask("right") | bottom : Ask("bottom") | all : NIL }
Half --> comp(f) { front : Ask("half") | all : NIL } comp(e) { all : Ask("edge") }
  comp(v) { geometry.nVertices == 1 && convert(x, scope, object, pos, 0, 0, 0) < 4 : Ask("in") | all : Ask("out") }
Ask(name) --> print(name + " " + inside(all, "tower") + " " + overlaps(all, "tower") + " " + touches(all, "tower")) NIL"#;
    let tree = run(rules, LOT);
    let line = |name: &str| tree.prints.iter().filter(|p| p.starts_with(name)).cloned().collect::<Vec<_>>();
    assert_eq!(line("left"), ["left true false true"], "on the surface, normals opposite");
    assert_eq!(line("right"), ["right false false false"]);
    assert_eq!(line("bottom"), ["bottom false false false"]);
    assert_eq!(line("half"), ["half false false true"], "in the plane of the tower's front");
    // Of the edges at x = 103 one lies in the front face of the tower; of those along x two run out of its inside.
    let edges = |answer: &str| line("edge").iter().filter(|l| *l == &format!("edge {answer}")).count();
    assert_eq!(["true true true", "true false true", "false true true", "false false true"].map(edges), [3, 1, 2, 2]);
    assert_eq!(edges("false false false"), 4);
    let points = |answer: &str| line("in").iter().filter(|l| *l == &format!("in {answer}")).count();
    assert_eq!((points("true true true"), points("true false true")), (2, 2), "two are in the front face");
    assert!(line("out").iter().all(|l| l == "out false false false"), "{:?}", line("out"));
}

#[test]
fn windows_keep_off_a_wing() {
    // The wing is made after the facade that asks about it: order does not matter.
    let rules = "Lot --> [ s('1, '1, 4) t(0, 0, 6) extrude(6) comp(f) { back : Facade | all : NIL } ]
      [ s(4, '1, 6) extrude(9) Wing. ]
Facade --> split(x) { ~2 : Tile }*
Tile --> case touches(intra) : Wall. else : Window.";
    let tree = run(rules, LOT);
    assert_eq!((count(&tree, "Wall"), count(&tree, "Window")), (2, 8));
    let wall = |l: &&super::super::tree::Leaf| &*l.rule == "Wall";
    assert!(tree.leaves.iter().filter(wall).all(|l| l.mesh.bounds().is_some_and(|(_, hi)| hi.x <= 104.0 + 1e-9)));
}

#[test]
fn nobody_meets_what_it_was_made_from_or_what_is_made_of_it() {
    let rules = "Lot --> extrude(6) print(overlaps) comp(f) { side : Wall | all : NIL }
Wall --> print(touches) extrude(0.3) print(touches + \" \" + overlaps) Slab
Slab --> print(inside) Leaf.";
    let prints = run(rules, LOT).prints;
    assert_eq!(prints[0], "false");
    let walls: Vec<&[String]> = prints[1..].chunks(3).collect();
    assert_eq!(walls.len(), 4);
    // A wall meets none of its ancestors or descendants, and its neighbours only at edges.
    assert!(walls.iter().all(|w| *w == ["false", "false false", "false"]), "{prints:?}");
}

#[test]
fn occluders_are_leaves_labels_and_what_comp_and_offset_took_apart() {
    let asks = |maker: &str| {
        let rules = format!(
            "Lot --> [ s(4, '1, 4) {maker} ] [ s(2, '1, 2) t(1, 1, 1) extrude(1) Probe ]
Probe --> print(overlaps) NIL\nMass --> extrude(6) comp(f) {{ all : NIL }}\nNames --> extrude(6) label(\"n\") NIL"
        );
        run(&rules, LOT).prints
    };
    assert_eq!(asks("extrude(6) A."), ["true"]);
    assert_eq!(asks("Mass"), ["true"]);
    assert_eq!(asks("Names"), ["true"]);
    assert_eq!(asks("extrude(6) NIL"), ["false"]);
    assert_eq!(asks("A."), ["false"], "an open face occludes nothing");
    assert_eq!(asks("extrude(6) offset(-0.5) NIL"), ["false"]);
    assert_eq!(asks("extrude(6) offset(-0.5, inside) NIL"), ["true"]);
}

#[test]
fn labels_choose() {
    let rules = r#"Lot --> [ s(4, '1, 4) extrude(6) label("tower") A. ] [ t(4, 0, 0) s(4, '1, 4) extrude(6) B. ]
      [ t(3, 1, 1) s(2, '1, 2) extrude(1) Probe ] [ t(5, 1, 1) s(2, '1, 2) extrude(1) Probe ]
Probe --> print(overlaps(intra) + " " + overlaps(intra, "tower") + " " + overlaps(all, "") + " " + touches(intra, "x")) NIL"#;
    assert_eq!(run(rules, LOT).prints, ["true true true false", "true false true false"]);
    let tree = derived("Lot --> label(\"\") A.", ground(LOT));
    assert_eq!(tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::empty-label"]);
}

#[test]
fn a_label_answers_shapes_that_were_not_made_from_it() {
    let rules = r#"Lot --> [ s(6, '1, '1) extrude(20) label("keep out") NIL ] extrude(6) comp(f) { front : Facade | all : NIL }
Facade --> label("facade") split(x) { ~2 : Tile }*
Tile --> case inside(intra, "keep out") : NIL else : print(minimumDistance(intra, "facade")) T."#;
    let tree = run(rules, LOT);
    assert_eq!(count(&tree, "T"), 7);
    // The facade is where the tiles come from.
    assert_eq!(tree.prints, ["inf"; 7]);
}

#[test]
fn labelled_shapes_are_counted_ranked_and_measured() {
    let rules = r#"Lot --> split(x) { 2 : A | 6 : NIL | 4 : A | 3 : B | ~1 : NIL }
A --> label("a") print(contextCount(intra, "a") + " " + contextCompare(intra, "a", world.easternmost) + " "
  + contextCompare(intra, "a", world.westernmost) + " " + contextCompare(intra, "a", area.largest) + " "
  + contextCompare(all, "a", area.smallest) + " " + contextCompare(intra, "a", world.northernmost)) X.
B --> print(contextCount(intra, "a") + " " + contextCompare(intra, "a", world.easternmost) + " "
  + minimumDistance(intra, "a") + " " + minimumDistance(all, "") + " " + contextCount(inter, "a"))
  t(1, 7, 0) print(minimumDistance(intra, "a") + " " + contextCompare(intra, "a", world.highest) + " "
  + contextCompare(intra, "a", world.lowest) + " " + contextCompare(intra, "none", world.southernmost)) X."#;
    let tree = run(rules, LOT);
    assert_eq!(tree.prints, ["2 1 0 1 0 0", "2 0 1 0 1 0", "2 0 0 inf 0", "7.07106781186548 0 2 0"]);
}

#[test]
fn the_first_pass_leaves_nothing_behind() {
    let rules = r#"Lot --> print("once") report("n", 1) [ case overlaps(intra, "x") : A. else : t(1/0, 0, 0) B. ]"#;
    let tree = derived(rules, ground(LOT));
    assert_eq!((tree.prints.len(), tree.reports[0].count, tree.diagnostics.iter().count()), (1, 1, 1));
}

#[test]
fn what_only_an_answer_makes_is_never_seen() {
    // In the first pass there is no tower, so the second probe sees none.
    let rules = r#"Lot --> [ s(2, '1, 2) extrude(9) label("first") A. ] [ s(4, '1, 4) B ] [ s(1, '1, 1) extrude(1) C ]
B --> case overlaps(intra, "first") || contextCount(intra, "first") > 0 : extrude(5) label("tower") D. else : NIL
C --> print(overlaps(intra, "tower") + " " + overlaps(intra, "first")) NIL"#;
    let tree = run(rules, LOT);
    assert_eq!((count(&tree, "D"), tree.prints), (1, vec!["false true".to_owned()]));
}

const ROW: [&[(f64, f64)]; 4] = [
    &[(0.0, 0.0), (10.0, 0.0), (10.0, -8.0), (0.0, -8.0)],
    &[(10.0, 0.0), (20.0, 0.0), (20.0, -8.0), (10.0, -8.0)],
    // An alley of half a metre, then a street.
    &[(20.5, 0.0), (30.0, 0.0), (30.0, -8.0), (20.5, -8.0)],
    &[(40.0, 0.0), (50.0, 0.0), (50.0, -8.0), (40.0, -8.0)],
];

#[test]
fn party_walls_have_no_windows() {
    let rules = r#"Lot --> extrude(6) comp(f) { side : Wall | all : NIL }
Wall --> print(comp.index + " " + touches(inter) + " " + touches(intra) + " " + touches) NIL"#;
    let prints = batch(rules, &ROW);
    let blind = |lot: usize| prints[lot].iter().filter(|l| l.contains("true")).cloned().collect::<Vec<_>>();
    assert_eq!(blind(0), ["1 true false true"]);
    assert_eq!(blind(1), ["3 true false true"]);
    assert_eq!((blind(2).len(), blind(3).len()), (0, 0));
}

#[test]
fn neighbours_count_within_reach_and_labels_everywhere() {
    let rules = r#"Lot --> extrude(rand(5, 9)) label("house") print(contextCount(inter, "house") + " " + contextCount(all, "house") + " "
  + contextCount(intra, "house") + " " + contextCompare(all, "house", world.easternmost) + " " + minimumDistance(inter, "house")) A."#;
    let prints = batch(rules, &ROW);
    assert_eq!(prints.concat(), ["3 4 1 3 0", "3 4 1 2 0", "3 4 1 1 0.5", "3 4 1 0 10"]);
    // A mast leans out over lots 2 and 3: lot 2 is too far from lot 0 to look.
    let rules = r#"Lot --> case initialShape.origin.px == 0 : s(45, 1, 1) extrude(1) A. else : s(1, '1, 1) extrude(1) print(overlaps(inter)) NIL"#;
    assert_eq!(batch(rules, &ROW).concat(), ["true", "false", "false"]);
}

#[test]
fn worlds_do_not_meet() {
    let program =
        compiled("Lot --> extrude(6) label(\"a\") print(overlaps(inter) + \" \" + contextCount(inter, \"a\")) A.");
    let lot = |is_in, sees| Member { program: &program, start: start(ground(LOT), 0).into(), is_in, sees };
    // One before a change, one after it, one in both, which looks at the state before.
    let lots = [lot(1, 1), lot(2, 2), lot(3, 1)];
    let trees = Batch::new(&lots, &NoAssets, &Limits::default()).derive_all();
    let prints: Vec<&str> = trees.iter().map(|t| t.prints[0].as_str()).collect();
    assert_eq!(prints, ["true 1", "true 1", "true 1"]);
    let lots = [lot(1, 1), lot(2, 2)];
    let trees = Batch::new(&lots, &NoAssets, &Limits::default()).derive_all();
    assert!(trees.iter().all(|t| t.prints == ["false 0"]));
}

#[test]
fn only_programs_that_ask_are_derived_twice() {
    let plain = compiled("Lot --> extrude(6) label(\"a\") A.");
    let asking = compiled("Lot --> case contextCount(inter, \"a\") > 0 : A. else : B.");
    let far: &[(f64, f64)] = &[(500.0, 0.0), (510.0, 0.0), (510.0, -8.0)];
    let lot = |program, corners| Member { program, start: start(ground(corners), 0).into(), is_in: 1, sees: 1 };
    let (limits, none) = (Limits::default(), compiled("Lot --> A."));
    let alone = [lot(&plain, LOT), lot(&plain, far)];
    let alone = Batch::new(&alone, &NoAssets, &limits);
    assert!((0..2).all(|i| !alone.needs_survey(i)));
    let lots = [lot(&plain, far), lot(&asking, LOT), lot(&none, LOT)];
    let batch = Batch::new(&lots, &NoAssets, &limits);
    assert_eq!([0, 1, 2].map(|i| batch.needs_survey(i)), [true, false, false]);
    assert_eq!(count(&batch.derive_all()[1], "A"), 1);
    assert!(!none.needs().asks() && plain.needs().labels && asking.needs().far && !asking.needs().own);
}
