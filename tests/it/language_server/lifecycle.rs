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
    editor.open("a.cga", &format!("Lot --> {}\n", "extrude(3) ".repeat(20_000)));
    let first = editor.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": editor.uri("a.cga") } }));
    // While the first one is at work, the second one waits behind it, with its cancellation.
    let second = editor.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": editor.uri("a.cga") } }));
    editor.notify("$/cancelRequest", json!({ "id": second }));
    assert!(editor.answer(first).is_ok());
    assert_eq!(editor.answer(second).expect_err("cancelled")["code"], json!(-32800));
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
