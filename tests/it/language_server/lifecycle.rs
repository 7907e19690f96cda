//! The protocol's own rules: first words, last words, requests that nobody serves.

use serde_json::{Value, json};

use super::editor::Editor;

#[test]
fn the_server_says_what_it_serves() {
    let mut editor = Editor::silent(&[]);
    let utf8 = json!({ "general": { "positionEncodings": ["utf-8", "utf-16"] } });
    let mut result = editor.initialize(utf8);
    result["serverInfo"]["version"] = json!("VERSION");
    insta::assert_json_snapshot!(result);
    assert_eq!(editor.leave().code(), Some(0));
}

#[test]
fn nothing_is_served_before_initialize_and_after_shutdown() {
    let mut editor = Editor::silent(&[]);
    let early = editor.request("textDocument/hover", json!({})).expect_err("too early");
    assert_eq!(early["code"], json!(-32002));
    editor.initialize(json!({}));
    let again = editor.request("initialize", json!({ "capabilities": {} })).expect_err("once is enough");
    assert_eq!(again["code"], json!(-32600));
    let unknown = editor.request("textDocument/moniker", json!({})).expect_err("not served");
    assert_eq!(unknown["code"], json!(-32601));
    let wrong = editor.request("textDocument/hover", json!({ "position": 7 })).expect_err("no parameters");
    assert_eq!(wrong["code"], json!(-32602));
    editor.notify("$/setTrace", json!({ "value": "off" }));
    assert_eq!(editor.request("shutdown", Value::Null), Ok(Value::Null));
    let late = editor.request("textDocument/hover", json!({})).expect_err("too late");
    assert_eq!(late["code"], json!(-32600));
    editor.notify("exit", Value::Null);
    assert_eq!(editor.end().code(), Some(0));
}

#[test]
fn leaving_without_shutdown_is_a_failure() {
    let mut editor = Editor::new(&[]);
    editor.notify("exit", Value::Null);
    assert_eq!(editor.end().code(), Some(1));
    assert_eq!(Editor::new(&[]).end().code(), Some(1), "the client just vanished");
}

#[test]
fn a_request_that_was_taken_back_is_answered_as_such() {
    let mut editor = Editor::new(&[]);
    editor.open("a.cga", &format!("Lot --> {}\n", "extrude(3) ".repeat(5_000)));
    let params = json!({ "textDocument": { "uri": editor.uri("a.cga") } });
    // All at once: while the first requests are at work, the last one waits behind them, with its cancellation.
    let request =
        |id: i64| json!({ "jsonrpc": "2.0", "id": id, "method": "textDocument/semanticTokens/full", "params": params });
    let mut messages: Vec<Value> = (1001..=1020).map(request).collect();
    messages.push(json!({ "jsonrpc": "2.0", "method": "$/cancelRequest", "params": { "id": 1020 } }));
    editor.send_all(&messages);
    assert!(editor.answer(1001).is_ok());
    assert_eq!(editor.answer(1020).expect_err("cancelled")["code"], json!(-32800));
}

#[test]
fn files_are_watched_where_the_client_can() {
    let mut editor = Editor::silent(&[("lib.cga", "Wall --> NIL\n")]);
    editor.initialize(json!({ "workspace": { "didChangeWatchedFiles": { "dynamicRegistration": true } } }));
    editor.open("main.cga", "import lib : \"lib.cga\"\n@StartRule\nLot --> lib.Wall\n");
    assert!(editor.diagnostics("main.cga", 1).is_empty());
    let asked = editor.notes.iter().find(|note| note["method"] == json!("client/registerCapability"));
    let asked = asked.expect("a registration");
    assert_eq!(asked["params"]["registrations"][0]["method"], json!("workspace/didChangeWatchedFiles"));
    // Another program writes the library.
    std::fs::write(editor.path("lib.cga"), "Roof --> NIL\n").expect("writable");
    let change = json!({ "uri": editor.uri("lib.cga"), "type": 2 });
    editor.notify("workspace/didChangeWatchedFiles", json!({ "changes": [change] }));
    assert_eq!(editor.diagnostics("main.cga", 1)[0]["code"], json!("cga::undefined-rule"));
}

#[test]
fn settings_come_as_options_and_as_configuration() {
    let files =
        [("lot.cga", "attr height = 3\n@StartRule\nLot --> extrude(height)\n"), ("a.osm", "<osm version=\"0.6\"/>")];
    let mut editor = Editor::silent(&files);
    let folder = json!({ "uri": editor.uri(""), "name": "test" });
    let options = json!({ "set": ["rules=lot.cga"], "explainScheme": "pages" });
    let params = json!({ "capabilities": {}, "workspaceFolders": [folder], "initializationOptions": options });
    editor.request("initialize", params).expect("initialize succeeds");
    editor.notify("initialized", json!({}));
    let recipe =
        "input rules : text\ninput map : files\nscene a { map $map; rules $rules for building { hight = 1 } }\n";
    editor.open("a.render", recipe);
    // The map is not given: the recipe is checked as far as it goes, which is not into its rules.
    assert_eq!(editor.diagnostics("a.render", 1), Vec::<serde_json::Value>::new());
    let set =
        [format!("rules={}", editor.path("lot.cga").display()), format!("map={}", editor.path("a.osm").display())];
    let section = json!({ "mansard": { "recipe": "", "set": set, "allow": [], "path": "mansard" } });
    editor.notify("workspace/didChangeConfiguration", json!({ "settings": section }));
    let found = editor.diagnostics("a.render", 1);
    assert_eq!(found[0]["code"], json!("render::unknown-attribute"), "{found:?}");
    editor.open("b.cga", "Lot --> extrud(3)\n");
    let found = editor.diagnostics("b.cga", 1);
    let href = &found[0]["codeDescription"]["href"];
    assert_eq!(href, &json!("pages:cga::unknown-operation.md"), "the scheme was told once");
}

#[test]
fn a_document_without_a_file_is_served() {
    let mut editor = Editor::new(&[]);
    let document =
        json!({ "uri": "untitled:Untitled-1", "languageId": "cga", "version": 1, "text": "Lot --> extrude(3)\n" });
    editor.notify("textDocument/didOpen", json!({ "textDocument": document }));
    let params =
        json!({ "textDocument": { "uri": "untitled:Untitled-1" }, "position": { "line": 0, "character": 10 } });
    let hover = editor.request("textDocument/hover", params).expect("an answer");
    assert!(hover["contents"]["value"].as_str().is_some_and(|said| said.contains("extrude(number)")), "{hover}");
}

#[test]
fn commands_that_do_not_exist_are_refused() {
    let mut editor = Editor::new(&[]);
    let error = editor
        .request("workspace/executeCommand", json!({ "command": "mansard.dance", "arguments": [] }))
        .expect_err("no such command");
    assert_eq!(error["code"], json!(-32602));
    let page = editor
        .request("workspace/executeCommand", json!({ "command": "mansard.explain", "arguments": ["cga::syntax"] }))
        .expect("a page");
    assert!(page.as_str().is_some_and(|text| text.starts_with("## cga::syntax")), "{page}");
}
