//! Reference 10.8, 1.7, 1.8, 6.

use super::*;

/// Prints an expression in a rule and gives the line.
#[track_caller]
fn printed(expression: &str) -> String {
    let rules = format!("Lot --> print({expression}) NIL");
    let tree = run(&rules, LOT);
    assert_eq!(tree.prints.len(), 1, "{expression}");
    tree.prints[0].clone()
}

#[test]
fn the_table_of_the_reference() {
    let cases = [
        ("1 + 2 * 3 - 4 / 2", "5"),
        ("-7 % 3", "-1"),
        ("-8 % 5", "-3"),
        ("9 % -4", "1"),
        (r#""a" + 1.50 + true"#, "a1.5true"),
        ("str(1/3)", "0.333333333333333"),
        (r#"str(bool("f")) + bool("no") + bool(0.1)"#, "falsetruetrue"),
        (r#"str(float("12px")) + float("px")"#, "12nan"),
        (r#"substring("facade", 2, 99)"#, "cade"),
        (r#"find("a.b.c", ".", 1)"#, "3"),
        (r#"count("aaaa", "aa")"#, "2"),
        (r#"splitString("x;;y", ";")"#, "(3)[x,,y]"),
        (r#"splitString("hi", "")"#, "(4)[,h,i,]"),
        (r#"splitString("a$b", "$\\$")"#, "(2)[a,b]"),
        ("[1:3] .* 2 .+ [1,0,1]", "(3)[3,4,7]"),
        ("[1,2;3,4][3]", "4"),
        ("[1,2;3,4][1,0]", "3"),
        ("[1,2][5]", "0"),
        ("[5,6,7][[true,false,true]]", "(2)[5,7]"),
        ("setElems([1,1], 3, 9)", "(4)[1,1,0,9]"),
        ("sortIndices([3,1,2,1])", "(4)[1,3,2,0]"),
        ("sum([true,true,false])", "2"),
        (r#"sum(["a","b"])"#, "ab"),
        ("[4,6] < [4,6,0]", "true"),
        ("[4,6] == [4;6]", "false"),
        (r#"getRange("img.win.03.png", "win.", ".png")"#, "03"),
        (r#"listRange("a;b;c;d;", 1, 3)"#, "b;c;"),
        (r#"listIndex("oak;elm;ash;", "*m")"#, "1"),
        ("colorRGBToHex(0.2, 0.5, 1)", "#3380FF"),
        ("colorHSVToHex(-240, 1, 0.5)", "#008000"),
        (r#"fileBasename("a/b/roof.v2.obj")"#, "roof.v2"),
        ("2.+[1,2]", "(2)[3,4]"),
    ];
    for (expression, expected) in cases {
        assert_eq!(printed(expression), expected, "{expression}");
    }
}

#[test]
fn more_of_the_library() {
    let cases = [
        ("size([5:2]) + size([6:-1:6]) + size([3:0:3])", "1"),
        ("boolArray[1:2]", "(2)[false,false]"),
        ("rint(2.5) + rint(3.5)", "6"),
        ("atan2(1, 1) + acos(0) + sin(90)", "136"),
        ("max(2, 3) + min(2, 3) + clamp(7, 0, 5)", "10"),
        (r#"listItem("a;b;", 1) + listItem("a;b;", 9) + listSize("a;b") + listCount("ab;b;cb;", "*b")"#, "b23"),
        (r#"listRemove("a;b;a;", "a") + listRemoveAll("a;b;a;", "a") + listAdd("a", "c")"#, "b;a;b;a;c;"),
        (r#"replace("a-b-c", "-", 1) + getPrefix("a.b", ".") + getSuffix("a.b.c", ".")"#, "a1b1cac"),
        (r##"colorHexToH("#ff0000") + colorHexToS("#808080") + colorHexToO("#00000000")"##, "0"),
        (r#"colorRamp("whiteToBlack", 0.5) + colorRamp("spectrum", 9)"#, "#808080#FF0000"),
        ("transpose([1,2;3,4])[0,1]", "3"),
        ("len(\"häuser\")", "6"),
        ("isnan(0/0) && isinf(1/0) && !isinf(0/0)", "true"),
        ("findFirst([1,2,3], 2.05, 0.1)", "1"),
        (r#"findFirst(["a","b"], "b") + findFirst("abc", "c") + findLast("abcb", "b")"#, "6"),
        ("case scope.sx > 10 : \"wide\" else : \"narrow\"", "wide"),
        ("convert(x, scope, world, pos, 1, 0, 0)", "101"),
    ];
    for (expression, expected) in cases {
        assert_eq!(printed(expression), expected, "{expression}");
    }
}

#[test]
fn angles_are_degrees() {
    let cases = [
        ("rint(100 * cos(60)) + rint(100 * sin(30)) + rint(100 * tan(45))", "200"),
        ("cos(0) + cos(180)", "0"),
        ("rint(acos(cos(33))) + rint(asin(sin(12))) + rint(atan(tan(-7)))", "38"),
        ("isinf(1 / cos(90)) || cos(90) < 1e-15", "true"),
    ];
    for (expression, expected) in cases {
        assert_eq!(printed(expression), expected, "{expression}");
    }
}

#[test]
fn functions_locals_and_recursion() {
    let rules = r#"
half(x) with( h := x / 2 ) = h
fact(n) = case n <= 1 : 1 else : n * fact(n - 1)
area = geometry.area
Lot with( a := area  b := a + 1 ) --> s('0.5, '1, '1) print(half(9) + " " + fact(10) + " " + a + " " + b + " " + area) NIL"#;
    assert_eq!(run(rules, LOT).prints, ["4.5 3628800 200 201 100"]);
}

#[test]
fn attributes_and_hosts() {
    let rules = r#"
attr height = 3 * floors
attr floors = 4
@Hidden
attr secret = "x"
const double = height * 2
attr kind = case height > 10 : "tall" else : "low"
Lot --> set(height, 1) print(height + " " + double + " " + kind + secret) extrude(height)"#;
    let tree = run(rules, LOT);
    assert_eq!(tree.prints, ["1 24 tallx"]);
    let names: Vec<&str> = tree.leaves[0].attributes.iter().map(|(n, _)| &**n).collect();
    assert_eq!(names, ["floors", "height", "kind"]);
    assert_eq!(tree.leaves[0].attributes[1].1, Scalar::Float(12.0), "a later set does not show");
    let mut start = start(ground(LOT), 0);
    start.attributes = vec![("floors".into(), Scalar::String("2".into())), ("nothing".into(), Scalar::Bool(true))];
    let tree = derive(&compiled(rules), &start, &NoAssets, &Limits::default());
    assert_eq!(tree.prints, ["1 12 lowx"]);
}

#[test]
fn numbers_that_are_none_become_zero_once_per_place() {
    let tree = derived("Lot --> A A\nA --> extrude(float(\"x\")) t(1/0, 0, 0) B.", ground(LOT));
    assert_eq!(count(&tree, "B"), 2);
    let codes: Vec<&str> = tree.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(codes, ["cga::not-finite"; 2]);
    assert!(tree.leaves.iter().all(|l| l.mesh.positions.iter().all(|p| p.is_finite())));
}

#[test]
fn reports_count_every_shape() {
    let rules = r#"Lot --> split(x) { ~5 : A }*
A --> report("area", geometry.area) report("area", split.index) report("name", "x") NIL"#;
    let tree = run(rules, LOT);
    let area = &tree.reports[0];
    assert_eq!((&*area.name, area.count, area.sum, area.min, area.max), ("area", 8, 206.0, 0.0, 50.0));
    assert_eq!((&*tree.reports[1].name, tree.reports[1].count), ("name", 4));
    assert!(tree.leaves.is_empty());
}
