//! Reference 6.1, 6.3, 6.4, 6.10 to 6.14: functions on values, one row each.

use super::*;

#[test]
fn numbers_arrays_and_conversions() {
    check(&[
        ("ceil(1.2) + floor(-1.2)", "0"),
        ("asin(1)", "90"),
        ("exp(0) + ln(1) + log10(1000) + pow(2, 10) + sqrt(9)", "1031"),
        ("isNull(float(\"x\")) && !isNull(\"\")", "true"),
        ("floatArray([true,false])", "(2)[1,0]"),
        ("stringArray([1,2.5])", "(2)[1,2.5]"),
        ("nRows([1,2;3,4;5,6]) * 10 + nColumns([1,2;3,4;5,6])", "32"),
        ("sortRowIndices([2,1;1,9;1,3])", "(3)[2,1,0]"),
    ]);
}

#[test]
fn regular_expressions_split() {
    check(&[
        (r#"splitString("a1b22c", "$[0-9]+")"#, "(3)[a,b,c]"),
        (r#"splitString("/q/", "/")"#, "(3)[,q,]"),
        (r#"splitString("", ",")"#, "(1)[]"),
    ]);
}

#[test]
fn regular_expressions_look_around() {
    check(&[
        (r#"splitString("ab", "$(?<=a)")"#, "(2)[a,b]"),
        (r#"splitString("WallWestUp", "$(?=[A-Z])")"#, "(4)[,Wall,West,Up]"),
        (r#"splitString("a,b\\,c", "$(?<!\\\\),")"#, "(2)[a,b\\,c]"),
        (r#"splitString("1--2-3", "$(-)\\1")"#, "(2)[1,2-3]"),
        (r#"splitString("häß", "$(?!^)(?=.)")"#, "(3)[h,ä,ß]"),
    ]);
}

/// Also what would never end: the text comes back whole.
#[test]
fn regular_expressions_are_bounded() {
    let many = "x".repeat(60) + "zy";
    let wide = "ab".repeat(20_000) + "c";
    for (text, expression) in [(&*many, "(x+x+)+(?>y)"), (&*wide, "(?=.*c)"), ("ab", "(?<=a")] {
        let tree =
            derived(&format!("Lot --> print(len(splitString(\"{text}\", \"${expression}\")[0])) NIL"), ground(LOT));
        assert_eq!(
            tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(),
            ["cga::regular-expression"],
            "{expression}"
        );
        assert_eq!(tree.prints, [text.len().to_string()], "{expression}");
    }
}

#[test]
fn lists_of_strings() {
    check(&[
        (r#"listClean("a;;b")"#, "a;b;"),
        (r#"listFirst("a;b;c;") + listLast("a;b;c;")"#, "ac"),
        (r#"listRetainAll("ab;cb;d;", "*b")"#, "ab;cb;"),
        (r#"listTerminate("a;b") + listTerminate("a;")"#, "a;b;a;"),
        (r#"listFromArray(["a","b"])"#, "a;b;"),
        (r#"listToArray("a;b;")"#, "(2)[a,b]"),
        (r#"listCount(listRandom("a;b;c;"), "*")"#, "1"),
    ]);
}

#[test]
fn names_of_files_and_colours() {
    check(&[
        (
            r#"fileName("a/b/c.01.obj") + " " + fileExtension("a/b/c.01.obj") + " " + fileDirectory("a/b/c.01.obj")"#,
            "c.01.obj obj a/b/",
        ),
        (r##"colorHexToR("#ff0080") + " " + colorHexToG("#ff0080") + " " + colorHexToV("#800000") * 255"##, "1 0 128"),
        (r##"colorHexToB("#0000ff")"##, "1"),
        ("colorRGBOToHex(1, 0, 0.5, 0.5)", "#FF008080"),
        ("colorHSVOToHex(120, 1, 1, 1)", "#00FF00FF"),
    ]);
}

#[track_caller]
fn check(cases: &[(&str, &str)]) {
    for (expression, expected) in cases {
        let tree = run(&format!("Lot --> print({expression}) NIL"), LOT);
        assert_eq!(tree.prints, [*expected], "{expression}");
    }
}
