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
