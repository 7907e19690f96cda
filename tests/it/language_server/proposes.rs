//! Completion, signature help, quick fixes: what the editor proposes.

use serde_json::{Value, json};

use super::editor::{Editor, edited, marks};

const LIB: &str = "attr depth = 1\nWall(h) --> extrude(h)\nextension Pane --> NIL\n";
const HEAD: &str = "import lib : \"lib.cga\"\nattr height = 5\ntwice(x) = x * 2\nWindow --> NIL\n";

/// Labels of the proposals at the mark in a rule file that begins with [`HEAD`].
fn labels(editor: &mut Editor, rest: &str) -> Vec<String> {
    items(editor, rest).iter().map(|item| item["label"].as_str().unwrap_or_default().to_owned()).collect()
}

fn items(editor: &mut Editor, rest: &str) -> Vec<Value> {
    let (text, positions) = marks(&format!("{HEAD}{rest}"));
    editor.open("main.cga", &text);
    let found = editor.at("textDocument/completion", "main.cga", &positions[0]).expect("proposals");
    found["items"].as_array().cloned().unwrap_or_default()
}

#[test]
fn proposals_fit_their_place() {
    let mut editor = Editor::new(&[("lib.cga", LIB), ("assets/wood.png", ""), ("assets/tree.obj", "")]);
    // What must be there, what must not.
    let cases: [(&str, &[&str], &[&str]); 14] = [
        ("Lot --> Win¦", &["Window", "extrude", "comp", "lib", "NIL"], &["height", "front", "sin"]),
        ("Lot --> lib.¦", &["lib.Wall", "lib.Pane"], &["extrude", "Window"]),
        ("Lot(n) --> extrude(¦", &["world.up", "height", "n", "twice", "rand", "scope.sx"], &["Window", "extrude"]),
        ("Lot --> extrude(lib.¦", &["lib.depth"], &["height"]),
        ("Lot --> comp(¦", &["f", "e", "fv"], &["world.up"]),
        ("Lot --> comp(f) { fr¦", &["front", "world.south", "all", "height"], &["extrude", "Window"]),
        ("Lot --> comp(f) { front : ¦ }\nB --> C", &["Window", "extrude"], &["front"]),
        ("Lot --> split(x) { hei¦", &["height", "scope.sx"], &["Window"]),
        ("Lot --> set(ma¦", &["material.color.r", "height"], &["scope.elevation", "Window"]),
        ("@Ra¦", &["Range", "StartRule"], &["extrude"]),
        ("@Range(¦", &["min", "max", "restricted"], &["Range"]),
        ("at¦", &["attr", "import", "const"], &["extrude"]),
        ("import b : \"¦", &["lib.cga"], &["wood.png", "tree.obj"]),
        ("Lot --> texture(\"w¦", &["wood.png"], &["tree.obj", "lib.cga"]),
    ];
    for (text, wanted, unwanted) in cases {
        let found = labels(&mut editor, text);
        for name in wanted {
            assert!(found.iter().any(|label| label == name), "{name} at {text}: {found:?}");
        }
        for name in unwanted {
            assert!(!found.iter().any(|label| label == name), "no {name} at {text}");
        }
    }
    assert_eq!(labels(&mut editor, "// a comment ¦"), Vec::<String>::new());
    assert_eq!(labels(&mut editor, "Lot(wid¦"), Vec::<String>::new());
}

#[test]
fn a_proposal_has_a_form_a_text_and_places_to_fill_in() {
    let mut editor = Editor::new(&[("lib.cga", LIB)]);
    let found = items(&mut editor, "Lot --> ¦");
    let named = |name: &str| found.iter().find(|item| item["label"] == json!(name)).cloned();
    insta::assert_json_snapshot!("operation", named("taper"));
    insta::assert_json_snapshot!("rule", named("Window"));
    let found = items(&mut editor, "Lot --> extrude(twi¦");
    let twice = found.iter().find(|item| item["label"] == json!("twice")).expect("the function");
    assert_eq!(twice["textEdit"]["newText"], json!("twice(${1:x})"));
    assert_eq!(twice["textEdit"]["range"]["start"], json!({ "line": 4, "character": 16 }));
}

#[test]
fn clients_without_snippets_get_names() {
    let mut editor = Editor::silent(&[("lib.cga", LIB)]);
    editor.initialize(json!({}));
    let found = items(&mut editor, "Lot --> ¦");
    assert!(found.iter().all(|item| item.get("insertTextFormat").is_none()));
    assert!(found.iter().all(|item| item["textEdit"]["newText"] == item["label"]));
}

#[test]
fn recipes_get_keys_values_names_and_attributes() {
    let mut editor = Editor::new(&[("lot.cga", "attr height = 3\n@StartRule\nLot --> Roof\nRoof --> NIL\n")]);
    let cases: [(&str, &[&str], &[&str]); 13] = [
        ("¦", &["scene", "camera", "input", "use"], &["seed"]),
        ("scene a {\n  ¦\n}", &["seed", "map", "rules"], &["gsd", "imagery"]),
        ("scene a {\n  rules \"lot.cga\"\n  ¦", &["for", "start", "map"], &["gsd"]),
        ("camera c { projection ¦ }", &["perspective", "orthographic"], &["true_ortho", "size"]),
        ("effects { shadows ¦ }", &["off", "hard", "soft"], &["trees"]),
        ("camera low { }\ndataset d { views ¦ }", &["low"], &["d"]),
        ("camera low { }\ncamera high : ¦", &["low"], &["scene"]),
        ("scene a { rules \"lot.cga\" start ¦ }", &["Lot", "Roof"], &["height"]),
        ("scene a { rules \"lot.cga\" for ¦ }", &["building", "highway"], &["Lot"]),
        ("scene a { rules \"lot.cga\" for building { ¦ } }", &["height"], &["Lot"]),
        ("scene a { rules \"¦\" }", &["lot.cga"], &["seed"]),
        ("input town : files\nscene a { map ¦ }", &["$town"], &["scene"]),
        ("quality { preset ¦ }", &["draft", "standard", "high"], &["off"]),
    ];
    for (marked, wanted, unwanted) in cases {
        let (text, positions) = marks(marked);
        editor.open("a.render", &text);
        let found = editor.at("textDocument/completion", "a.render", &positions[0]).expect("proposals");
        let found: Vec<&str> =
            found["items"].as_array().expect("a list").iter().filter_map(|i| i["label"].as_str()).collect();
        for name in wanted {
            assert!(found.contains(name), "{name} at {marked}: {found:?}");
        }
        for name in unwanted {
            assert!(!found.contains(name), "no {name} at {marked}");
        }
    }
}

#[test]
fn signatures_follow_the_argument() {
    let mut editor = Editor::new(&[("lib.cga", LIB)]);
    let mut help = |rest: &str| {
        let (text, positions) = marks(&format!("{HEAD}{rest}"));
        editor.open("main.cga", &text);
        editor.at("textDocument/signatureHelp", "main.cga", &positions[0]).expect("help")
    };
    let found = help("Lot --> extrude(world.up, ¦");
    let forms: Vec<&Value> = found["signatures"].as_array().expect("a list").iter().map(|s| &s["label"]).collect();
    assert_eq!(forms[0], &json!("extrude(number)"));
    // The second argument belongs to the second form.
    assert_eq!((&found["activeSignature"], &found["activeParameter"]), (&json!(1), &json!(1)));
    assert_eq!(help("Lot --> extrude(twice(¦")["signatures"][0]["label"], json!("twice(x)"));
    assert_eq!(help("Lot --> lib.Wall(¦")["signatures"][0]["label"], json!("Wall(h)"));
    assert_eq!(help("Lot --> Window ¦"), Value::Null);
}

#[test]
fn help_becomes_quick_fixes() {
    let mut editor = Editor::new(&[("lib.cga", LIB)]);
    // Text, title of the fix, text afterwards.
    let cases = [
        ("Lot --> extrud(3)\n", "Change to `extrude`", "Lot --> extrude(3)\n"),
        ("Lot --> Windwo\n", "Make `Windwo.` a leaf", "Lot --> Windwo.\n"),
        ("Lot --> extrude(hieght)\n", "Change to `height`", "Lot --> extrude(height)\n"),
        ("Lot --> comp(f) { frnt : Window }\n", "Change to `front`", "Lot --> comp(f) { front : Window }\n"),
        ("@Rnge(min=1, max=2)\nattr b = 1\n", "Change to `@Range`", "@Range(min=1, max=2)\nattr b = 1\n"),
        ("Lot --> Window.\n", "Take the dot away", "Lot --> Window\n"),
    ];
    for (number, (text, title, wanted)) in cases.into_iter().enumerate() {
        let name = format!("fix{number}.cga");
        let text = format!("{HEAD}{text}");
        editor.open(&name, &text);
        let found = editor.diagnostics(&name, 1);
        let whole = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 9, "character": 0 } });
        let uri = editor.uri(&name);
        let params = json!({ "textDocument": { "uri": uri }, "range": whole, "context": { "diagnostics": found } });
        let actions = editor.request("textDocument/codeAction", params).expect("actions");
        let action = actions.as_array().expect("a list").iter().find(|action| action["title"] == json!(title));
        let action = action.unwrap_or_else(|| panic!("{title}: {actions} of {found:?}"));
        let edits = action["edit"]["changes"][&uri].as_array().expect("edits").clone();
        assert_eq!(edited(&text, &edits), format!("{HEAD}{wanted}"), "{title}");
    }
}
