//! Diagnostics while the user types: incremental edits, unsaved imports, files that import the changed one, broken text.

use serde_json::{Value, json};

use super::editor::{Editor, shipped};

fn codes(diagnostics: &[Value]) -> Vec<String> {
    diagnostics.iter().map(|d| d["code"].as_str().unwrap_or_default().to_owned()).collect()
}

#[test]
fn diagnostics_follow_the_keystrokes() {
    let mut editor = Editor::new(&[]);
    editor.open("a.cga", "@StartRule\nLot --> extrud(3) Ä𝄞Leaf.\n");
    let found = editor.diagnostics("a.cga", 1);
    insta::assert_json_snapshot!(editor.local(&json!(found)));
    // An `e` behind `extrud`, then the leaf goes; columns count in UTF-16.
    let edit = |start: [u32; 2], end: [u32; 2], text: &str| {
        let position = |at: [u32; 2]| json!({ "line": at[0], "character": at[1] });
        json!({ "range": { "start": position(start), "end": position(end) }, "text": text })
    };
    let params = json!({
        "textDocument": { "uri": editor.uri("a.cga"), "version": 2 },
        "contentChanges": [edit([1, 14], [1, 14], "e"), edit([1, 19], [1, 27], "")],
    });
    editor.notify("textDocument/didChange", params);
    assert_eq!(editor.diagnostics("a.cga", 2), Vec::<Value>::new());
    let symbols = editor
        .request("textDocument/documentSymbol", json!({ "textDocument": { "uri": editor.uri("a.cga") } }))
        .expect("symbols");
    assert_eq!(symbols[0]["range"]["end"], json!({ "line": 1, "character": 18 }), "{symbols}");
}

#[test]
fn an_open_library_counts_as_it_is_shown() {
    let mut editor = Editor::new(&[("lib.cga", "Wall --> color(1, 0, 0)\n")]);
    editor.open("main.cga", "import lib : \"lib.cga\"\n@StartRule\nLot --> lib.Wall lib.Roof\n");
    assert_eq!(codes(&editor.diagnostics("main.cga", 1)), ["cga::undefined-rule"]);
    // The library gets the rule, unsaved.
    editor.open("lib.cga", "Wall --> color(1, 0, 0)\nRoof --> color(0, 0, 1)\n");
    assert_eq!(codes(&editor.diagnostics("main.cga", 1)), Vec::<String>::new());
    // A mistake in it is told where it is imported, with its place.
    editor.replace("lib.cga", 2, "Wall --> color(1, 0, 0)\nRoof --> color(0,\n");
    let found = editor.diagnostics("main.cga", 1);
    insta::assert_json_snapshot!(editor.local(&json!(found)));
    assert_eq!(codes(&editor.diagnostics("lib.cga", 2)), ["cga::syntax"]);
    // Closed without saving: the file counts again.
    editor.notify("textDocument/didClose", json!({ "textDocument": { "uri": editor.uri("lib.cga") } }));
    assert_eq!(codes(&editor.diagnostics("main.cga", 1)), ["cga::undefined-rule"]);
}

#[test]
fn a_library_that_was_never_saved_can_be_imported() {
    let mut editor = Editor::new(&[]);
    editor.open("new.cga", "Wall --> color(1, 0, 0)\n");
    editor.open("main.cga", "import lib : \"new.cga\"\n@StartRule\nLot --> lib.Wall\n");
    assert_eq!(codes(&editor.diagnostics("main.cga", 1)), Vec::<String>::new());
}

#[test]
fn recipes_are_checked_with_their_rules() {
    let rules = "@Range(min=1, max=9)\nattr height = 3\n@StartRule\nLot --> extrude(height)\n";
    let mut editor = Editor::new(&[("lot.cga", rules), ("town.osm", "<osm version=\"0.6\"/>")]);
    let recipe = "scene town {\n  map \"town.osm\"\n  rules \"lot.cga\" for building { hight = 4 }\n  sed 3\n}\n";
    editor.open("town.render", recipe);
    let found = editor.diagnostics("town.render", 1);
    assert_eq!(codes(&found), ["spec::unknown-property"]);
    editor.replace("town.render", 2, &recipe.replace("  sed 3\n", ""));
    let found = editor.diagnostics("town.render", 2);
    assert_eq!(codes(&found), ["render::unknown-attribute"]);
    let context = json!({ "diagnostics": found });
    let params = json!({
        "textDocument": { "uri": editor.uri("town.render") }, "range": found[0]["range"], "context": context,
    });
    let actions = editor.request("textDocument/codeAction", params).expect("actions");
    assert_eq!(actions[0]["title"], json!("Change to `height`"), "{actions}");
    // The rule file loses the attribute, unsaved.
    editor.replace("town.render", 3, &recipe.replace("  sed 3\n", "").replace("hight", "height"));
    assert_eq!(codes(&editor.diagnostics("town.render", 3)), Vec::<String>::new());
    editor.open("lot.cga", &rules.replace("height", "tall"));
    assert_eq!(codes(&editor.diagnostics("town.render", 3)), ["render::unknown-attribute"]);
}

#[test]
fn a_burst_of_keystrokes_ends_in_the_last_version() {
    let mut editor = Editor::new(&[]);
    editor.open("a.cga", "");
    let text = std::fs::read_to_string(&shipped()[0]).expect("a rule file");
    let steps: Vec<&str> = text.char_indices().step_by(40).map(|(at, _)| &text[..at]).collect();
    for (number, step) in steps.iter().enumerate() {
        editor.replace("a.cga", number as i64 + 2, step);
    }
    let last = steps.len() as i64 + 2;
    editor.replace("a.cga", last, &text);
    let found = editor.diagnostics("a.cga", last);
    assert!(found.iter().all(|d| d["severity"] != json!(1)), "{found:?}");
    let versions = editor.notes.iter().filter_map(|note| note["params"]["version"].as_i64());
    let versions: Vec<i64> = versions.collect();
    assert!(versions.is_sorted(), "{versions:?}");
}

/// Every request at many places of texts that end anywhere: the server answers and goes on.
#[test]
fn broken_text_breaks_nothing() {
    let mut editor = Editor::new(&[]);
    let recipe = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/riverside/riverside.render");
    editor.open("a.cga", "");
    editor.open("a.render", "");
    let mut version = 1;
    for path in shipped().into_iter().chain([recipe]) {
        let text = std::fs::read_to_string(&path).expect("readable");
        let name = if path.extension().is_some_and(|e| e == "cga") { "a.cga" } else { "a.render" };
        for part in 1..5 {
            let mut end = text.len() * part / 5 + part * 7;
            end = (0..=end.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
            version += 1;
            editor.replace(name, version, &text[..end]);
            let line = text[..end].matches('\n').count() as u64;
            for position in [json!({ "line": line, "character": 3 }), json!({ "line": line / 2, "character": 900 })] {
                all_requests(&mut editor, name, &position);
            }
        }
    }
    assert_eq!(editor.leave().code(), Some(0));
}

/// Sends one request of each kind; refusals of renames and of formatting are answers too.
fn all_requests(editor: &mut Editor, name: &str, position: &Value) {
    let document = json!({ "uri": editor.uri(name) });
    for method in ["hover", "completion", "signatureHelp", "definition", "documentHighlight", "prepareRename"] {
        let result = editor.at(&format!("textDocument/{method}"), name, position);
        assert!(result.is_ok() || method == "prepareRename", "{method}: {result:?}");
    }
    for method in ["documentSymbol", "foldingRange", "semanticTokens/full", "codeLens"] {
        editor.request(&format!("textDocument/{method}"), json!({ "textDocument": document })).expect(method);
    }
    let at = json!({ "textDocument": document, "position": position, "context": { "includeDeclaration": true } });
    editor.request("textDocument/references", at).expect("references");
    let at = json!({ "textDocument": document, "position": position, "newName": "another" });
    drop(editor.request("textDocument/rename", at));
    let options = json!({ "tabSize": 4, "insertSpaces": true });
    drop(editor.request("textDocument/formatting", json!({ "textDocument": document, "options": options })));
    let at = json!({ "textDocument": document, "positions": [position] });
    editor.request("textDocument/selectionRange", at).expect("selection ranges");
}
