//! The scripted client. In: texts with marks and requests. Out: the server's answers, folders cut from their paths.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use serde_json::{Value, json};

/// Seconds that an answer may take on a machine under load.
const PATIENCE: Duration = Duration::from_secs(120);

/// An editor with its own server and a folder of files.
pub struct Editor {
    child: Child,
    stdin: Option<ChildStdin>,
    messages: Receiver<Value>,
    next_id: i64,
    /// Notifications that came while an answer was awaited.
    pub notes: Vec<Value>,
    folder: tempfile::TempDir,
}

impl Editor {
    /// A server that was told nothing yet, beside these files.
    pub fn silent(files: &[(&str, &str)]) -> Editor {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().expect("below the folder")).expect("writable");
            std::fs::write(path, text).expect("writable");
        }
        let mut child = Command::new(env!("CARGO_BIN_EXE_mansard"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program was built");
        let mut stdout = BufReader::new(child.stdout.take().expect("piped"));
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            while let Some(message) = read_frame(&mut stdout) {
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        let stdin = child.stdin.take();
        Editor { child, stdin, messages, next_id: 0, notes: Vec::new(), folder }
    }

    /// A server that has the folder open, told what VS Code would tell it.
    pub fn new(files: &[(&str, &str)]) -> Editor {
        let mut editor = Editor::silent(files);
        let capabilities = json!({
            "textDocument": {
                "completion": { "completionItem": { "snippetSupport": true } },
                "documentSymbol": { "hierarchicalDocumentSymbolSupport": true },
            },
            "workspace": { "codeLens": { "refreshSupport": true } },
        });
        editor.initialize(capabilities);
        editor
    }

    pub fn initialize(&mut self, capabilities: Value) -> Value {
        let folder = json!({ "uri": self.uri(""), "name": "test" });
        let params = json!({ "processId": null, "capabilities": capabilities, "workspaceFolders": [folder] });
        let result = self.request("initialize", params).expect("initialize succeeds");
        self.notify("initialized", json!({}));
        result
    }

    pub fn path(&self, name: &str) -> PathBuf {
        let root = self.folder.path().canonicalize().expect("it exists");
        if name.is_empty() { root } else { root.join(name) }
    }

    pub fn uri(&self, name: &str) -> String {
        format!("file://{}", self.path(name).display())
    }

    pub fn send(&mut self, message: &Value) {
        self.send_all(std::slice::from_ref(message));
    }

    /// Sends messages in one piece.
    pub fn send_all(&mut self, messages: &[Value]) {
        let frame = |message: &Value| {
            let text = message.to_string();
            format!("Content-Length: {}\r\n\r\n{text}", text.len())
        };
        let stdin = self.stdin.as_mut().expect("the input is open");
        stdin.write_all(messages.iter().map(frame).collect::<String>().as_bytes()).expect("the server listens");
        stdin.flush().expect("the server listens");
    }

    pub fn notify(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// Sends a request without waiting; gives its id.
    pub fn ask(&mut self, method: &str, params: Value) -> i64 {
        self.next_id += 1;
        self.send(&json!({ "jsonrpc": "2.0", "id": self.next_id, "method": method, "params": params }));
        self.next_id
    }

    /// The result of a request, or its error.
    pub fn request(&mut self, method: &str, params: Value) -> Result<Value, Value> {
        let id = self.ask(method, params);
        self.answer(id)
    }

    pub fn answer(&mut self, id: i64) -> Result<Value, Value> {
        loop {
            let message = self.receive();
            if message["id"] == json!(id) && message.get("method").is_none() {
                return match message.get("error") {
                    Some(error) => Err(error.clone()),
                    None => Ok(message["result"].clone()),
                };
            }
        }
    }

    /// The next message; notifications are kept, requests of the server are answered.
    pub fn receive(&mut self) -> Value {
        let message = self.messages.recv_timeout(PATIENCE).expect("the server answers");
        if message.get("method").is_some() {
            if let Some(id) = message.get("id") {
                self.send(&json!({ "jsonrpc": "2.0", "id": id, "result": null }));
            }
            self.notes.push(message.clone());
        }
        message
    }

    /// Opens a document; marks `¦` are taken out, their positions given.
    pub fn open(&mut self, name: &str, marked: &str) -> Vec<Value> {
        let (text, positions) = marks(marked);
        let language = name.rsplit('.').next().unwrap_or_default();
        let document = json!({ "uri": self.uri(name), "languageId": language, "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
        positions
    }

    /// Replaces the whole text of an open document.
    pub fn replace(&mut self, name: &str, version: i64, text: &str) {
        let params = json!({
            "textDocument": { "uri": self.uri(name), "version": version },
            "contentChanges": [{ "text": text }],
        });
        self.notify("textDocument/didChange", params);
    }

    /// Asks about a place.
    pub fn at(&mut self, method: &str, name: &str, position: &Value) -> Result<Value, Value> {
        let params = json!({ "textDocument": { "uri": self.uri(name) }, "position": position });
        self.request(method, params)
    }

    /// The diagnostics of a version of a document, those of older versions dropped.
    pub fn diagnostics(&mut self, name: &str, version: i64) -> Vec<Value> {
        let uri = self.uri(name);
        let wanted = |note: &Value| {
            note["method"] == "textDocument/publishDiagnostics"
                && note["params"]["uri"] == json!(uri)
                && note["params"]["version"] == json!(version)
        };
        loop {
            if let Some(at) = self.notes.iter().position(wanted) {
                let note = self.notes.remove(at);
                return note["params"]["diagnostics"].as_array().cloned().unwrap_or_default();
            }
            self.receive();
        }
    }

    /// An answer with the editor's folder cut out of it.
    pub fn local(&self, value: &Value) -> Value {
        let text =
            value.to_string().replace(&self.uri(""), "file://").replace(&format!("{}/", self.path("").display()), "");
        serde_json::from_str(&text).expect("still JSON")
    }

    /// Closes the input and waits for the end.
    pub fn end(mut self) -> ExitStatus {
        drop(self.stdin.take());
        self.child.wait().expect("the server ends")
    }

    /// `shutdown`, `exit`, and how the program ended.
    pub fn leave(mut self) -> ExitStatus {
        self.request("shutdown", Value::Null).expect("shutdown succeeds");
        self.notify("exit", Value::Null);
        self.end()
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        // Most tests leave the server running; one that has ended cannot be killed.
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

fn read_frame(stdout: &mut impl BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if stdout.read_line(&mut line).ok()? == 0 {
            return None;
        }
        match line.trim() {
            "" => break,
            header => {
                if let Some(value) = header.strip_prefix("Content-Length: ") {
                    length = value.parse().expect("a length");
                }
            }
        }
    }
    let mut bytes = vec![0; length];
    stdout.read_exact(&mut bytes).ok()?;
    Some(serde_json::from_slice(&bytes).expect("the server writes JSON"))
}

/// The text without `¦`, and where they stood, in UTF-16.
pub fn marks(marked: &str) -> (String, Vec<Value>) {
    let (mut text, mut positions) = (String::new(), Vec::new());
    let (mut line, mut character) = (0, 0);
    for c in marked.chars() {
        match c {
            '¦' => {
                positions.push(json!({ "line": line, "character": character }));
                continue;
            }
            '\n' => (line, character) = (line + 1, 0),
            c => character += c.len_utf16(),
        }
        text.push(c);
    }
    (text, positions)
}

/// Applies the edits of one file to its text; positions in UTF-16.
pub fn edited(text: &str, edits: &[Value]) -> String {
    let offset = |position: &Value| {
        let number = |key: &str| position[key].as_u64().expect("a number") as usize;
        let start: usize = text.split_inclusive('\n').take(number("line")).map(str::len).sum();
        let mut left = number("character");
        let rest = text[start..].char_indices().find(|(_, c)| {
            let there = left == 0;
            left = left.saturating_sub(c.len_utf16());
            there
        });
        rest.map_or(text.len(), |(at, _)| start + at)
    };
    let mut list: Vec<(usize, usize, &str)> = edits
        .iter()
        .map(|edit| {
            let range = &edit["range"];
            (offset(&range["start"]), offset(&range["end"]), edit["newText"].as_str().expect("a text"))
        })
        .collect();
    list.sort_unstable();
    let mut out = text.to_owned();
    for (start, end, new) in list.into_iter().rev() {
        out.replace_range(start..end, new);
    }
    out
}

/// Rule files that come with the program.
pub fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("rules");
    let mut found: Vec<PathBuf> =
        std::fs::read_dir(folder).expect("rules").map(|entry| entry.expect("listed").path()).collect();
    found.retain(|path| path.extension().is_some_and(|e| e == "cga"));
    found.sort();
    found
}
