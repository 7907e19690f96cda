//! Names and queries of reference 4.15.1.

use proptest::prelude::*;

use super::*;

#[test]
fn queries_match_beginnings_on_dots() {
    let cases: &[(&str, &[&str], &[&str])] = &[
        ("wall", &["wall", "wall.north", "wall.north.2"], &["wallet", "w", "my.wall"]),
        ("wall.north", &["wall.north", "wall.north.2"], &["wall", "wall.northern"]),
        ("?.north", &["wall.north", "roof.north.1"], &["north", "a.b.north"]),
        ("wall.*.lower", &["wall.a.lower", "wall.a.b.lower.x"], &["wall.lower", "wall.a.upper"]),
        ("*", &["a", "a.b"], &[]),
        ("*.*", &["a.b", "a.b.c"], &["a"]),
        ("a.?", &["a.b", "a.b.c"], &["a", "b.a"]),
        ("*.b.*.d", &["a.b.c.d", "a.b.b.c.d.e"], &["b.c.d", "a.b.d"]),
        ("", &["a", "a.b"], &[]),
    ];
    for (query, yes, no) in cases {
        let query = Query::new(*query);
        yes.iter().for_each(|tag| assert!(query.matches(tag), "{query:?} {tag}"));
        no.iter().for_each(|tag| assert!(!query.matches(tag), "{query:?} {tag}"));
    }
}

#[test]
fn names_lose_wildcards() {
    assert_eq!(tag_name("wa*ll.?").as_deref(), Some("wall."));
    assert_eq!(tag_name("*?"), None);
}

/// By the definition: every way a star can run.
fn plainly(query: &[&str], tag: &[&str]) -> bool {
    match (query.split_first(), tag.split_first()) {
        (None, _) => true,
        (Some(_), None) => false,
        (Some((&"*", rest)), Some(_)) => (1..=tag.len()).any(|n| plainly(rest, &tag[n..])),
        (Some((q, rest)), Some((t, tail))) => (*q == "?" || q == t) && plainly(rest, tail),
    }
}

proptest! {
    #[test]
    fn matching_is_what_the_definition_says(
        query in prop::collection::vec(prop::sample::select(vec!["a", "b", "?", "*"]), 1..6),
        tag in prop::collection::vec(prop::sample::select(vec!["a", "b", "c"]), 1..7),
    ) {
        prop_assert_eq!(Query::new(query.join(".")).matches(&tag.join(".")), plainly(&query, &tag));
    }
}
