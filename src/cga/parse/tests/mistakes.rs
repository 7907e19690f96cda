//! What people see for the mistakes they make: place, message and help.

use super::read;

/// Every message of a text: "line:column message (help)".
fn seen(text: &str) -> Vec<String> {
    let (_, diagnostics, sources) = read(text);
    let show = |d: &crate::diagnostics::Diagnostic| {
        let place = sources.get(d.span.source).place(d.span.start);
        let help = d.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
        format!("{}:{} {}{help}", place.line, place.column, d.message)
    };
    diagnostics.iter().map(show).collect()
}

#[track_caller]
fn shows(text: &str, help: &str) {
    let found = seen(text);
    assert_eq!(found.len(), 1, "{text}\n{found:#?}");
    assert!(found[0].ends_with(&format!("({help})")), "{text}\n{found:#?}");
}

#[test]
fn misspelt_keywords_are_named() {
    for (text, word) in [
        ("atr h = 3\nA --> NIL", "attr"),
        ("conts h = 3", "const"),
        ("imprt a : \"f.cga\"", "import"),
        ("vesion \"2025.1\"", "version"),
        ("sytle Night", "style"),
        ("strat Lot --> NIL", "start"),
        ("extention Lot --> NIL", "extension"),
        ("A -->\n    case x : B\n    esle : C", "else"),
        ("A -->\n    csae x : B\n    else : C", "case"),
        ("A -->\n    Case x : B\n    else : C", "case"),
        ("A --> csae x : B else : C", "case"),
    ] {
        shows(text, &format!("did you mean `{word}`?"));
    }
}

#[test]
fn habits_of_other_languages_are_answered() {
    shows("Lot -> extrude(5)", "rules are written `Name --> ...`");
    shows("Lot -- > extrude(5)", "rules are written `Name --> ...`");
    shows("Lot(x) ==> extrude(5)", "rules are written `Name --> ...`");
    shows("Lot → extrude(5)", "rules are written `Name --> ...`");
    shows("A --> case a = 1 : B else : C", "`==` compares");
    shows("A --> case a and b : B else : C", "`&&` joins conditions");
    shows("A --> case not a : B else : C", "`!` negates");
    shows("A --> texture('a.jpg')", "strings stand in double quotes");
    shows("A --> B;", "nothing stands between operations or declarations: leave the `;` out");
    shows("attr a = 2m", "numbers have no units and names do not begin with digits");
    shows("attr a$b = 1", "names cannot hold `$`");
    shows("import \"f.cga\"", "imports are written `import prefix : \"file.cga\"`");
    shows("import rules/window.cga", "imports are written `import prefix : \"file.cga\"`");
}

#[test]
fn chains_are_explained() {
    shows("A --> case x : B\nC --> NIL", "every chain of cases or percentages ends with `else : ...`");
    shows("A --> 30% : B", "every chain of cases or percentages ends with `else : ...`");
    shows("A --> case x : B 30% : C else : D", "`case` and percentages cannot be mixed in one chain");
    shows("A --> 30% : B case x : C else : D", "`case` and percentages cannot be mixed in one chain");
    shows("A --> t(1,0,0) case x : B else : C", "a chain begins its body: put it in `[ ]`, or in a rule of its own");
}

#[test]
fn an_open_bracket_is_pointed_at() {
    shows("A --> comp(f) {\n  top : B\nC --> NIL", "the `{` of line 1 is still open here");
    shows("attr a = max(1,\n  2\nattr b = 3", "the `(` of line 1 is still open here");
}

#[test]
fn one_mistake_does_not_hide_or_cause_others() {
    let found = seen(
        "version \"2025.1\"\natr h = 3\n\nLot -->\n    extrude(h\n    comp(f) { top : Roof }\n\nRoof --> color(\"#fff)\n\n\
         Wall -> NIL\nattr ok = 1\nimport x \"f.cga\"\nGood --> NIL\nBad --> split(x) { ~1 : A | 2 B }\nf = (1 + \n",
    );
    let lines: Vec<&str> = found.iter().map(|m| m.split(':').next().expect("a line")).collect();
    assert_eq!(lines, ["2", "6", "8", "10", "12", "14", "16"], "{found:#?}");
}
