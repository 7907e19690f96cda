//! Tags: reference 3.11, 4.15.

use super::*;

/// Runs rules on the small lot and gives what they printed.
#[track_caller]
fn prints(rules: &str) -> Vec<String> {
    run(rules, SMALL).prints
}

#[test]
fn names_are_added_asked_for_and_taken_away() {
    let show = r#"print(geometry.tags) print(geometry.hasTags("a")) print(geometry.hasTags("a.?.c")) "#;
    assert_eq!(prints(&format!(r#"Lot --> tag("a.b") tag("wo*od") {show} NIL"#)), ["(2)[a.b,wood]", "true", "false"]);
    assert_eq!(
        prints(&format!(r#"Lot --> tag("a.b.c") tag("z") deleteTags("a") {show} NIL"#)),
        ["(1)[z]", "false", "false"]
    );
    assert_eq!(prints(&format!(r#"Lot --> tag("a.b.c") {show} NIL"#)), ["(1)[a.b.c]", "true", "true"]);
    assert_eq!(prints(&format!(r#"Lot --> tag("a") tag("b") deleteTags {show} NIL"#)), ["(0)[]", "false", "false"]);
}

#[test]
fn operations_name_what_they_make() {
    let count = |rules: &str, query: &str| {
        let tree = run(&format!("{rules} comp(f) {{ isTagged(\"{query}\") : A. }}"), SMALL);
        count(&tree, "A")
    };
    for (query, faces) in
        [("extrude", 6), ("extrude.side", 4), ("extrude.side.inner", 0), ("extrude.top", 1), ("top", 0)]
    {
        assert_eq!(count("Lot --> extrude(3)", query), faces, "{query}");
    }
    for (query, faces) in [("roof.bottom", 1), ("roof.top", 2), ("roof.side", 2), ("roof.side.outer", 0)] {
        assert_eq!(count("Lot --> roofGable(30)", query), faces, "{query}");
    }
    for (query, faces) in [("roof.bottom", 1), ("roof.top", 1), ("roof.side.outer", 3), ("roof.side.inner", 0)] {
        assert_eq!(count("Lot --> roofShed(30)", query), faces, "{query}");
    }
    for (query, faces) in [("taper.bottom", 1), ("taper.side", 4), ("roof", 0)] {
        assert_eq!(count("Lot --> taper(3)", query), faces, "{query}");
    }
    assert_eq!(count("Lot --> roofHip(30)", "roof.top"), 4);
    assert_eq!(count("Lot --> roofPyramid(30)", "roof.top"), 4);
    assert_eq!(count("Lot --> setback(1) { all = R }\nR --> extrude(3)", "extrude.side.inner"), 4);
}

#[test]
fn an_operation_replaces_its_own_names_only() {
    let rules = r#"Lot --> tag("mine.face") extrude(3) comp(f) { isTagged("extrude.top") : Top }
Top --> print(geometry.tags) extrude(1) print(geometry.tags("extrude.bottom")) comp(f) { isTagged("extrude.top") : print(geometry.tags) NIL }"#;
    assert_eq!(prints(rules), ["(2)[extrude.top,mine.face]", "(1)[extrude.bottom]", "(2)[extrude.top,mine.face]"]);
    let sides =
        r#"Lot --> tag("mine.face") extrude(3) comp(f) { isTagged("mine") : A. | isTagged("extrude.side") : B. }"#;
    let tree = run(sides, SMALL);
    assert_eq!((count(&tree, "A"), count(&tree, "B")), (2, 4), "sides stand on edges, which were not tagged");
}

#[test]
fn walls_have_the_tags_of_their_edges() {
    let rules = r#"Lot --> tag("corner", vertices) tag("rim", edges) extrude(3) comp(f) { isTagged("rim") && isTagged("corner") : X. | isTagged("rim") : Wall }
Wall --> print(geometry.tags("rim", faces) + " " + geometry.tags("rim", edges) + " " + geometry.tags("corner", edges) + " " + geometry.tags("corner", vertices)) NIL"#;
    let tree = run(rules, SMALL);
    assert_eq!((count(&tree, "X"), tree.prints.len()), (0, 4));
    assert_eq!(tree.prints[0], "(1)[rim] (1)[rim] (1)[corner] (1)[corner]");
}

#[test]
fn tapers_pass_tags_on() {
    let rules = r#"Lot --> tag("whole") tag("rim", edges) tag("corner", vertices) taper(3) comp(f) { isTagged("whole") : Base | all : Side }
Base --> print(geometry.tags) NIL
Side --> print(str(geometry.tags("?", faces)) + geometry.tags("?", edges)) NIL"#;
    let prints = prints(rules);
    assert_eq!(prints[0], "(4)[corner,rim,taper.bottom,whole]");
    assert_eq!(prints[1..], ["(2)[rim,taper.side](2)[corner,rim]"; 4]);
}

#[test]
fn components_see_the_tags_around_them() {
    let rules = |component: &str, test: &str| {
        format!(
            "Lot --> extrude(3) comp(f) {{ isTagged(\"extrude.top\") = T | all = NIL }}\nT --> comp({component}) {{ {test} : A. }}"
        )
    };
    for (component, test, n) in [
        ("e", "isTagged(\"extrude.top\")", 4),
        ("e", "isTagged(\"extrude.bottom\")", 0),
        ("v", "isTagged(\"extrude.top\")", 4),
        ("f", "isTagged(\"extrude.top\", e)", 1),
        ("fe", "isTagged(\"extrude.top\", v) && !isTagged(\"x\")", 4),
        ("fv", "isTagged(\"extrude\")", 4),
    ] {
        assert_eq!(count(&run(&rules(component, test), SMALL), "A"), n, "{component} {test}");
    }
    // A face beside a tagged one, through an edge they share.
    let block = |test: &str| count(&run(&format!("Lot --> extrude(3) comp(f) {{ {test} : A. }}"), SMALL), "A");
    assert_eq!(block("isTagged(\"extrude.top\", e)"), 5);
    assert_eq!(block("isTagged(\"extrude.top\", v)"), 5);
    assert_eq!(block("isTagged(\"extrude.top\")"), 1);
    // Bare edges keep their own.
    let bare = r#"Lot --> tag("rim", edges) tag("whole") comp(e) { isTagged("whole") : print(geometry.tags) E }
E --> comp(v) { isTagged("rim") : A. }"#;
    let tree = run(bare, SMALL);
    assert_eq!((tree.prints[0].as_str(), tree.prints.len(), count(&tree, "A")), ("(1)[rim]", 4, 8));
}

#[test]
fn tags_survive_cuts_and_caps_have_none() {
    let rules = r#"Lot --> tag("a") extrude(3) tag("rim", edges) split(x) { 4 : P | ~1 : P }
P --> print(geometry.nFaces + " " + geometry.tags("extrude")) comp(f) { geometry.hasTags("extrude", faces) : NIL | all : print(geometry.tags(" ", edges)) print(geometry.tags("rim", edges)) Cap. }"#;
    let tree = run(rules, SMALL);
    assert_eq!(count(&tree, "Cap"), 2);
    let names = "(3)[extrude.bottom,extrude.side.outer,extrude.top]";
    assert_eq!(tree.prints[0], format!("6 {names}"));
    // The cut edges are new; none of the old ones lies in the cut.
    assert_eq!(tree.prints.iter().filter(|p| *p == "(0)[]").count(), 4, "{:?}", tree.prints);
    let long = run(
        r#"Lot --> tag("rim", edges) split(x) { 4 : P | ~1 : P }
P --> comp(e) { geometry.hasTags("rim", edges) : A. | all : B. }"#,
        SMALL,
    );
    assert_eq!((count(&long, "A"), count(&long, "B")), (6, 2));
}

#[test]
fn tags_survive_cuts_of_edges_and_points() {
    let rules = |component: &str| {
        format!(
            r#"Lot --> tag("rim", edges) tag("end", vertices) comp({component}) {{ 0 : split(x) {{ 4 : P | ~1 : P }} }}
P --> print(geometry.tags) comp(v) {{ all : print(geometry.tags) NIL }}"#
        )
    };
    let edges = prints(&rules("e"));
    assert_eq!(edges.iter().filter(|p| *p == "(2)[end,rim]").count(), 2, "both pieces: {edges:?}");
    assert_eq!(edges.iter().filter(|p| *p == "(1)[end]").count(), 2, "one old end each: {edges:?}");
    assert_eq!(edges.iter().filter(|p| *p == "(0)[]").count(), 2, "the cut point twice: {edges:?}");
}

#[test]
fn setbacks_tag_edges() {
    let rules = r#"Lot --> setback(1) { front : Strip | remainder : Rest }
Strip --> comp(e) { isTagged("setback.front") : F. | isTagged("setback.back") : B. | isTagged("setback.side") : S. | all : X. }
Rest --> comp(e) { isTagged("setback.front") : X. | isTagged("setback.back") : RB. | isTagged("setback.remainder") : RR. | all : X. }"#;
    let tree = run(rules, SMALL);
    assert_eq!(["F", "B", "S", "RB", "RR", "X"].map(|rule| count(&tree, rule)), [1, 1, 2, 1, 3, 0]);
}

#[test]
fn offsets_pass_tags_on() {
    let rules = r#"Lot --> tag("whole") tag("rim", edges) tag("corner", vertices) offset(-1) comp(f) { inside : In | all : Border }
In --> print(geometry.tags) NIL
Border --> print(geometry.tags("*", faces) + " " + geometry.tags("*", edges)) NIL"#;
    let prints = prints(rules);
    assert_eq!(prints[0], "(1)[whole]");
    assert!(prints[1..].iter().all(|p| p == "(1)[rim] (2)[corner,rim]"), "{prints:?}");
    assert_eq!(prints.len(), 5);
}

#[test]
fn replaced_geometry_has_no_tags() {
    for operation in ["primitiveCube()", "i(\"builtin:cube\")"] {
        assert_eq!(
            prints(&format!("Lot --> tag(\"a\") {operation} print(geometry.tags) NIL")),
            ["(0)[]"],
            "{operation}"
        );
    }
}

#[test]
fn nothing_is_kept_where_nothing_asks() {
    let program = compiled("Lot --> tag(\"a\") extrude(3) A.");
    assert!(!program.observes_tags());
    assert!(compiled("Lot --> case geometry.hasTags(\"a\") : A. else : B.").observes_tags());
    assert!(compiled("f = comp(f) { isTagged(\"a\") : 1 }\nLot --> A.").observes_tags());
}

#[test]
fn cleaning_keeps_what_is_tagged() {
    // Two coplanar halves of a floor join only if nothing marks the edge between them. The end of the first edge stays.
    let halves = |tags: &str| {
        let mut mesh = ground(&[(0.0, 0.0), (4.0, 0.0), (4.0, -4.0), (0.0, -4.0)]);
        let right = ground(&[(4.0, 0.0), (9.0, 0.0), (9.0, -4.0), (4.0, -4.0)]);
        let start = mesh.positions.len() as u32;
        mesh.positions.extend(right.positions);
        mesh.faces.push(crate::geometry::Face::new(vec![start, start + 1, start + 2, start + 3]));
        let rules = format!(
            "Lot --> {tags} cleanupGeometry(all, 0) print(geometry.nFaces + \" \" + geometry.nVertices + \" \" + geometry.tags) comp(f) {{ isTagged(\"left\") : L. | all : R. }}"
        );
        let tree = derived(&rules, mesh);
        assert!(tree.diagnostics.is_empty(), "{rules}");
        (tree.prints[0].clone(), areas(&tree, "L"), areas(&tree, "R"))
    };
    assert_eq!(halves(""), ("1 5 (0)[]".into(), vec![], vec![36.0]));
    assert_eq!(halves("tag(\"same\")"), ("1 5 (1)[same]".into(), vec![], vec![36.0]));
    assert_eq!(halves("tag(\"rim\", edges)"), ("2 6 (1)[rim]".into(), vec![], vec![16.0, 20.0]));
    assert_eq!(halves("tag(\"rim\", edges) deleteTags(\"rim\")"), ("1 5 (0)[]".into(), vec![], vec![36.0]));
    assert_eq!(halves("tag(\"corner\", vertices)"), ("1 6 (1)[corner]".into(), vec![], vec![36.0]));
}

#[test]
fn roofs_keep_the_tags_of_their_floor() {
    let rules = r#"Lot --> tag("plan") tag("eave", edges) roofHip(30) comp(f) { isTagged("plan") : print(geometry.tags("eave", edges)) A. }"#;
    let tree = run(rules, SMALL);
    assert_eq!((count(&tree, "A"), tree.prints.iter().filter(|p| *p == "(1)[eave]").count()), (5, 5));
}
