//! Definitions, references, highlights and renames across rule files and recipes.

use serde_json::{Value, json};

use super::editor::{Editor, edited, marks};

const LIB: &str = "// How high it stands.\n@Range(min=1, max=40)\nattr height = 3\nWall(h) --> extrude(h) Pane\n\
                   extension Pane --> color(0, 0, 1)\n";
const MAIN: &str = "import lib : \"lib.cga\"\nattr height = 5\nconst half = height / 2\n\
                    area(w, d) = w * d\n@StartRule\nLot --> s('1, half, '1) lib.Wall(area(2, lib.height))\n\
                    Other(height) --> lib.Wall(height)\n";
const RECIPE: &str = "camera low { altitude 500m }\ncamera high : low { }\nscene town {\n  map \"town.osm\"\n  \
                      rules \"main.cga\" for building start Lot { height = 4 }\n}\n\
                      dataset all { views 2 * low, high }\n";

fn files() -> [(&'static str, &'static str); 3] {
    [("lib.cga", LIB), ("main.cga", MAIN), ("town.render", RECIPE)]
}

/// `file:line:character` of every location.
fn places(editor: &Editor, locations: &Value) -> Vec<String> {
    let place = |location: &Value| {
        let (range, uri) = (&location["range"]["start"], location["uri"].as_str().unwrap_or_default());
        let name = uri.strip_prefix(&editor.uri("")).unwrap_or(uri).trim_start_matches('/');
        format!("{name}:{}:{}", range["line"], range["character"])
    };
    locations.as_array().map(|list| list.iter().map(place).collect()).unwrap_or_default()
}

/// Asks about the place of the mark in a file that is open without it.
fn asked(editor: &mut Editor, method: &str, name: &str, marked: &str) -> Result<Value, Value> {
    let (_, positions) = marks(marked);
    editor.at(method, name, &positions[0])
}

#[test]
fn definitions_lead_across_files() {
    let mut editor = Editor::new(&files());
    for (name, text) in files() {
        editor.open(name, text);
    }
    let cases = [
        ("main.cga", MAIN.replace("lib.Wall(area", "lib.Wa¦ll(area"), vec!["lib.cga:3:0"]),
        ("main.cga", MAIN.replace("lib.Wall(area", "l¦ib.Wall(area"), vec!["main.cga:0:7"]),
        ("main.cga", MAIN.replace("\"lib.cga\"", "\"lib¦.cga\""), vec!["lib.cga:0:0"]),
        ("main.cga", MAIN.replace("(2, lib.height)", "(2, lib.hei¦ght)"), vec!["lib.cga:2:5"]),
        ("main.cga", MAIN.replace("lib.Wall(height)", "lib.Wall(he¦ight)"), vec!["main.cga:6:6"]),
        ("main.cga", MAIN.replace("half, ", "ha¦lf, "), vec!["main.cga:2:6"]),
        ("main.cga", MAIN.replace("s('1", "¦s('1"), vec![]),
        ("lib.cga", LIB.replace("extrude(h)", "extrude(h¦)"), vec!["lib.cga:3:5"]),
        ("town.render", RECIPE.replace("start Lot", "start L¦ot"), vec!["main.cga:5:0"]),
        ("town.render", RECIPE.replace("{ height", "{ ¦height"), vec!["main.cga:1:5"]),
        ("town.render", RECIPE.replace("\"main.cga\"", "\"¦main.cga\""), vec!["main.cga:0:0"]),
        ("town.render", RECIPE.replace(": low", ": lo¦w"), vec!["town.render:0:7"]),
        ("town.render", RECIPE.replace("* low", "* lo¦w"), vec!["town.render:0:7"]),
    ];
    for (name, marked, expected) in cases {
        let found = asked(&mut editor, "textDocument/definition", name, &marked).expect("an answer");
        assert_eq!(places(&editor, &found), expected, "{marked}");
    }
}

#[test]
fn references_are_found_in_files_that_are_not_open() {
    let mut editor = Editor::new(&files());
    let at = editor.open("main.cga", &MAIN.replace("attr height", "attr h¦eight"));
    let params = json!({
        "textDocument": { "uri": editor.uri("main.cga") }, "position": at[0], "context": { "includeDeclaration": true },
    });
    let found = editor.request("textDocument/references", params).expect("references");
    assert_eq!(places(&editor, &found), ["main.cga:1:5", "main.cga:2:13", "town.render:4:44"]);
    let marked = MAIN.replace("Other(height)", "Other(h¦eight)");
    let lights = asked(&mut editor, "textDocument/documentHighlight", "main.cga", &marked).expect("highlights");
    let kinds: Vec<&Value> = lights.as_array().expect("a list").iter().map(|light| &light["kind"]).collect();
    assert_eq!(kinds, [&json!(3), &json!(2)], "{lights}");
}

fn renamed(editor: &mut Editor, name: &str, marked: &str, new: &str) -> Result<Value, Value> {
    let (_, positions) = marks(marked);
    let params = json!({ "textDocument": { "uri": editor.uri(name) }, "position": positions[0], "newName": new });
    editor.request("textDocument/rename", params)
}

#[test]
fn the_name_of_an_import_is_changed_in_recipes_too() {
    let main = "import lib : \"lib.cga\"\n@StartRule\nLot --> lib.Wall(lib.depth)\n";
    let recipe = "scene town {\n  map \"town.osm\"\n  rules \"main.cga\" for building { \"lib.depth\" = 4 }\n}\n";
    let lib = "attr depth = 3\nWall(h) --> extrude(h)\n";
    let mut editor = Editor::new(&[("lib.cga", lib), ("main.cga", main), ("town.render", recipe)]);
    editor.open("main.cga", main);
    let edit = renamed(&mut editor, "main.cga", &main.replace("import lib", "import l¦ib"), "walls").expect("a rename");
    let changed = |name: &str, text: &str| {
        edited(text, edit["changes"][editor.uri(name)].as_array().expect("edits of this file"))
    };
    assert_eq!(
        changed("main.cga", main),
        main.replace("import lib", "import walls").replace("lib.W", "walls.W").replace("lib.d", "walls.d")
    );
    assert_eq!(changed("town.render", recipe), recipe.replace("lib.depth", "walls.depth"));
}

/// All files after the edits, one below the other.
fn after(editor: &Editor, edit: &Value) -> String {
    let mut out = String::new();
    for (name, text) in files() {
        let edits = edit["changes"][editor.uri(name)].as_array().cloned().unwrap_or_default();
        out += &format!("--- {name}\n{}", edited(text, &edits));
    }
    out
}

#[test]
fn a_rename_changes_every_file_that_names_the_thing() {
    let mut editor = Editor::new(&files());
    editor.open("main.cga", MAIN);
    // The imported attribute of the same name gets its value from this one: they keep one name.
    let marked = MAIN.replace("attr height", "attr h¦eight");
    let edit = renamed(&mut editor, "main.cga", &marked, "storeys").expect("a rename");
    insta::assert_snapshot!("attribute", after(&editor, &edit));
    let marked = MAIN.replace("lib.Wall(area", "lib.W¦all(area");
    let edit = renamed(&mut editor, "main.cga", &marked, "Mauer").expect("a rename");
    insta::assert_snapshot!("rule", after(&editor, &edit));
    let marked = MAIN.replace("Other(height)", "Other(h¦eight)");
    let edit = renamed(&mut editor, "main.cga", &marked, "tall").expect("a rename");
    assert!(after(&editor, &edit).contains("Other(tall) --> lib.Wall(tall)"), "{edit}");
    editor.open("town.render", RECIPE);
    let edit = renamed(&mut editor, "town.render", &RECIPE.replace(": low", ": l¦ow"), "near").expect("a rename");
    insta::assert_snapshot!("camera", after(&editor, &edit));
}

#[test]
fn renames_that_would_change_a_meaning_are_refused() {
    let mut editor = Editor::new(&files());
    editor.open("main.cga", MAIN);
    let cases = [
        (MAIN.replace("s('1", "¦s('1"), "t2"),
        (MAIN.replace("attr height", "attr h¦eight"), "half"),
        (MAIN.replace("attr height", "attr h¦eight"), "3d"),
        (MAIN.replace("attr height", "attr h¦eight"), "extrude"),
        (MAIN.replace("Lot -->", "L¦ot -->"), "case"),
        (MAIN.replace("area(w, d)", "area(w¦, d)"), "d"),
        (MAIN.replace("const half", "const ha¦lf"), "area"),
    ];
    let said = cases.map(|(marked, new)| {
        let error = renamed(&mut editor, "main.cga", &marked, new).expect_err("refused");
        format!("{new}: {}", error["message"].as_str().unwrap_or_default())
    });
    insta::assert_snapshot!(said.join("\n"));
    // A parameter of this name would capture the attribute where it is used.
    let text = "attr tall = 3\nLot(w) --> extrude(tall)\n";
    editor.open("b.cga", text);
    let error = renamed(&mut editor, "b.cga", &text.replace("attr tall", "attr t¦all"), "w").expect_err("refused");
    assert!(error["message"].as_str().is_some_and(|m| m.contains("would hide it")), "{error}");
}

#[test]
fn what_can_be_renamed_is_told_beforehand() {
    let mut editor = Editor::new(&files());
    editor.open("main.cga", MAIN);
    let marked = MAIN.replace("lib.Wall(area", "lib.Wa¦ll(area");
    let found = asked(&mut editor, "textDocument/prepareRename", "main.cga", &marked).expect("it can");
    assert_eq!(found["placeholder"], json!("Wall"));
    assert_eq!(found["range"]["start"], json!({ "line": 5, "character": 28 }));
    let marked = MAIN.replace("s('1", "¦s('1");
    let error = asked(&mut editor, "textDocument/prepareRename", "main.cga", &marked).expect_err("it cannot");
    assert_eq!(error["message"], json!("`s` is an operation of the language and keeps its name"));
}

#[test]
fn symbols_of_the_workspace_are_found_by_their_letters() {
    let mut editor = Editor::new(&files());
    let found = editor.request("workspace/symbol", json!({ "query": "hg" })).expect("symbols");
    let names: Vec<&str> =
        found.as_array().expect("a list").iter().map(|s| s["name"].as_str().unwrap_or_default()).collect();
    assert_eq!(names, ["height", "height", "high"]);
}
