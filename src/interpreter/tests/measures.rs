//! Questions about the geometry: reference 6.6.

use super::*;

/// Runs `Lot --> body` on the small lot (10 x 6) and gives the line it printed.
#[track_caller]
fn told(body: &str) -> String {
    told_on(body, SMALL)
}

#[track_caller]
fn told_on(body: &str, corners: &[(f64, f64)]) -> String {
    let tree = run(&format!("Lot --> {body} NIL"), corners);
    assert_eq!(tree.prints.len(), 1, "{body}: {:?}", tree.prints);
    tree.prints[0].clone()
}

#[track_caller]
fn number(body: &str, expected: f64) {
    let got: f64 = told(body).parse().expect("a number was printed");
    assert!((got - expected).abs() < 1e-9, "{body}: {got}, not {expected}");
}

const L: &[(f64, f64)] = &[(0.0, 0.0), (10.0, 0.0), (10.0, -4.0), (4.0, -4.0), (4.0, -10.0), (0.0, -10.0)];

#[test]
fn areas_by_direction() {
    number("print(geometry.area)", 60.0);
    number("s('2, '1, '1) print(geometry.area())", 120.0);
    for (selector, area) in [
        ("all", 216.0),
        ("surface", 216.0),
        ("top", 60.0),
        ("world.down", 60.0),
        ("front", 30.0),
        ("object.side", 96.0),
        ("side", 96.0),
        ("vertical", 96.0),
        ("horizontal", 120.0),
        ("aslant", 0.0),
        ("world.east", 18.0),
    ] {
        number(&format!("extrude(3) print(geometry.area({selector}))"), area);
    }
    // Turned to the north the front is where the world's north is.
    number("extrude(3) s('1, '1, '0.5) r(0, 180, 0) print(geometry.area(front) - geometry.area(world.north))", 0.0);
    number("comp(e) { 0 : print(geometry.area) }", 0.0);
}

#[test]
fn slopes() {
    for (angle, flat) in [("maxSlope", 0.0), ("zenith", 90.0), ("azimuth", 0.0)] {
        number(&format!("print(geometry.angle({angle}))"), flat);
    }
    let plane =
        |selector: &str, angle: &str| format!("roofHip(30) comp(f) {{ {selector} : print(geometry.angle({angle})) }}");
    number(&plane("1", "maxSlope"), 30.0);
    number(&plane("2", "zenith"), 60.0);
    // Face 1 looks south, 2 east, 3 north, 4 west.
    for (face, azimuth) in [(1, 180.0), (2, 90.0), (3, 0.0), (4, 270.0)] {
        number(&plane(&face.to_string(), "azimuth"), azimuth);
    }
    // Of several faces the steepest one.
    number("extrude(2) print(geometry.angle(maxSlope))", 90.0);
}

#[test]
fn lengths_heights_volumes() {
    number("print(geometry.boundaryLength)", 32.0);
    number("extrude(3) print(geometry.boundaryLength)", 0.0);
    number("extrude(3) comp(f) { vertical = print(geometry.boundaryLength) }", 64.0);
    number("comp(e) { all = print(geometry.boundaryLength) }", 32.0);
    number("extrude(3) r(90, 0, 0) print(geometry.height)", 6.0);
    number("print(geometry.height)", 0.0);
    number("extrude(3) s('1, 5, '1) print(geometry.volume)", 300.0);
    number("taper(6) print(geometry.volume())", 120.0);
    assert_eq!(told("extrude(3) print(geometry.isClosedSurface)"), "true");
    assert_eq!(told("extrude(3) comp(f) { top : NIL | all = print(geometry.isClosedSurface) }"), "false");
    assert_eq!(told("comp(e) { all = print(geometry.isClosedSurface) }"), "false");
}

#[test]
fn counts() {
    let counts = |body: &str| {
        told(&format!(
            "{body} print(geometry.nFaces + \" \" + geometry.nEdges + \" \" + geometry.nVertices + \" \" + geometry.nHoles)"
        ))
    };
    assert_eq!(counts("extrude(3)"), "6 12 8 0");
    let holed = "setback(1) { all = extrude(2) print(geometry.nFaces + \" \" + geometry.nEdges + \" \" + geometry.nVertices + \" \" + geometry.nHoles) }";
    assert_eq!(told(holed), "10 24 16 2");
    let edges = "comp(e) { all = print(geometry.nFaces + \" \" + geometry.nEdges + \" \" + geometry.nVertices) }";
    assert_eq!(told(edges), "0 4 4");
    assert_eq!(told("comp(v) { all = print(geometry.nEdges + \" \" + geometry.nVertices) }"), "0 4");
}

#[test]
fn forms_of_faces() {
    let asked = |body: &str, question: &str| told(&format!("{body} print({question})"));
    assert_eq!(asked("", "geometry.isRectangular(0)"), "true");
    assert_eq!(asked("extrude(3)", "geometry.isRectangular(0.1)"), "true");
    assert_eq!(asked("roofGable(30)", "geometry.isRectangular(5)"), "false");
    // A corner 1 m out over 10 m: 5.7 degrees.
    let skew = [(0.0, 0.0), (10.0, 0.0), (11.0, -6.0), (1.0, -6.0)];
    let leaning = |tolerance: f64| told_on(&format!("print(geometry.isRectangular({tolerance}))"), &skew);
    assert_eq!((leaning(9.0), leaning(10.0)), ("false".into(), "true".into()), "atan(1/6) is 9.46 degrees");
    assert_eq!(told_on("print(geometry.isConcave)", L), "true");
    assert_eq!(told_on("print(geometry.isRectangular(45))", L), "false");
    assert_eq!(asked("", "geometry.isConcave"), "false");
    let straight = [(0.0, 0.0), (5.0, 0.0), (10.0, 0.0), (10.0, -6.0), (0.0, -6.0)];
    assert_eq!(told_on("print(geometry.isConcave())", &straight), "false", "straight corners are convex");
    assert_eq!(told("setback(1) { all = print(geometry.isConcave) }"), "true", "a face with a hole is concave");
    assert_eq!(asked("extrude(3)", "geometry.isPlanar(0)"), "true");
    for question in ["geometry.isRectangular(1)", "geometry.isConcave", "geometry.isPlanar(90)"] {
        assert_eq!(told(&format!("comp(e) {{ 0 : print({question}) }}")), "false", "{question} of an edge");
        assert_eq!(told(&format!("comp(v) {{ 0 : print({question}) }}")), "false", "{question} of a point");
    }
}

#[test]
fn bent_faces_are_planar_within_their_bend() {
    // One corner of a square of 10 m lifted by 1 m: corner normals lean by up to about 6 degrees against each other.
    let mut mesh = ground(&[(0.0, 0.0), (10.0, 0.0), (10.0, -10.0), (0.0, -10.0)]);
    mesh.positions[2].y = 1.0;
    let planar = |tolerance: f64| {
        let tree = derived(&format!("Lot --> print(geometry.isPlanar({tolerance})) NIL"), mesh.clone());
        tree.prints[0].clone()
    };
    assert_eq!((planar(2.0), planar(8.0)), ("false".into(), "true".into()));
}

#[test]
fn orientations() {
    let asked = |body: &str, selector: &str| told(&format!("{body} print(geometry.isOriented({selector}))"));
    for (selector, answer) in
        [("top", "true"), ("world.up", "true"), ("bottom", "false"), ("side", "false"), ("all", "true")]
    {
        assert_eq!(asked("", selector), answer, "{selector}");
    }
    assert_eq!(asked("extrude(3)", "object.left"), "true");
    assert_eq!(
        told(
            "extrude(3) comp(f) { front : print(geometry.isOriented(object.front) && !geometry.isOriented(object.back)) }"
        ),
        "true"
    );
    // Edges and vertices look where the faces at them look.
    assert_eq!(
        told("comp(fe) { 0 : print(geometry.isOriented(object.front) && !geometry.isOriented(world.up)) }"),
        "true"
    );
    assert_eq!(told("comp(v) { 0 : print(geometry.isOriented(world.up)) }"), "true");
}

#[test]
fn instances() {
    for (body, answer) in [
        ("", "false"),
        ("primitiveCube()", "true"),
        ("primitiveCube() s('2, '1, '1) r(0, 20, 0) color(1, 0, 0)", "true"),
        ("primitiveCube() reverseNormals() extrude(1)", "false"),
        ("primitiveCube() scaleUV(0, 2, 2)", "false"),
    ] {
        assert_eq!(told(&format!("{body} print(geometry.isInstanced)")), answer, "{body}");
    }
    assert_eq!(told("primitiveCube() comp(f) { 0 : print(geometry.isInstanced) }"), "false");
}

#[test]
fn extents_of_textures() {
    let uv = "setupProjection(0, scope.xz, 2, 3) projectUV(0) ";
    for (question, value) in [
        ("geometry.du(0, uvSpace)", 5.0),
        ("geometry.dv(0, uvSpace)", 2.0),
        ("geometry.du(0, unitSpace)", 10.0),
        ("geometry.dv(0, unitSpace)", 6.0),
        ("geometry.du(1, uvSpace)", 0.0),
        ("geometry.uMin + geometry.vMin()", 0.0),
        ("geometry.uMax(0)", 5.0),
        ("geometry.vMax", 2.0),
        ("geometry.vMax(3)", 0.0),
    ] {
        number(&format!("{uv} print({question})"), value);
    }
    // Metres follow the scope; texture units do not.
    number(&format!("{uv} s('3, '1, '1) print(geometry.du(0, unitSpace))"), 30.0);
    number(&format!("{uv} s('3, '1, '1) print(geometry.du(0, uvSpace))"), 5.0);
    number(&format!("{uv} translateUV(0, -7, 1) print(geometry.uMin(0) + geometry.vMin(0))"), -6.0);
    assert_eq!(told("print(geometry.hasUVs)"), "false");
    assert_eq!(told(&format!("{uv} print(geometry.hasUVs && geometry.hasUVs(0) && !geometry.hasUVs(1))")), "true");
    let wrong = derived("Lot --> print(geometry.uMin(10)) print(geometry.hasUVs(-1)) NIL", ground(SMALL));
    assert_eq!(wrong.prints, ["0", "false"]);
    assert_eq!(wrong.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::uv-set", "cga::uv-set"]);
}
