//! The loop of the server. In: messages of the client and results of derivations, one queue for both. Out: answers.
//!
//! Diagnostics are made when the queue is empty, so a burst of keystrokes is checked once; what arrived meanwhile makes
//! them stale, and stale ones are never sent.

use std::collections::{BTreeSet, VecDeque};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};

use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::notification::{self as told, Notification as _};
use lsp_types::request as asked;
use lsp_types::{
    DidChangeConfigurationParams, DidChangeTextDocumentParams, DidChangeWatchedFilesParams,
    DidChangeWorkspaceFoldersParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams, DidSaveTextDocumentParams,
    PublishDiagnosticsParams,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::json;

use super::capabilities::{capabilities, client};
use super::derivation::Derived;
use super::documents::Document;
use super::position::Encoding;
use super::publish::diagnostics;
use super::requests;
use super::uri;
use super::workspace::{Language, Settings, Workspace};

/// How a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// `shutdown`, then `exit`.
    Orderly,
    /// The client left without saying so.
    Abrupt,
}

/// Why a request got no result.
#[derive(Debug)]
pub struct Refusal {
    pub code: ErrorCode,
    pub message: String,
}

impl Refusal {
    /// A request that makes no sense here, in words for the user.
    pub fn failed(message: impl Into<String>) -> Self {
        Refusal { code: ErrorCode::RequestFailed, message: message.into() }
    }
}

/// What the loop waits for.
enum Event {
    Message(Message),
    Derived(Box<Derived>),
    /// The client closed its side.
    Closed,
}

/// Serves one client until it exits.
pub fn serve(connection: Connection) -> Ending {
    let Connection { sender, receiver } = connection;
    let (ours, events) = channel();
    let from_client = ours.clone();
    std::thread::spawn(move || {
        // The server is gone when nobody receives any more.
        for message in receiver {
            if from_client.send(Event::Message(message)).is_err() {
                return;
            }
        }
        drop(from_client.send(Event::Closed));
    });
    // A client that does not listen any more is about to close its side.
    let send = Box::new(move |message| drop(sender.send(message)));
    let mut server = Server {
        send,
        ours,
        events,
        waiting: VecDeque::new(),
        workspace: Workspace::default(),
        stage: Stage::New,
        unpublished: BTreeSet::new(),
        next_id: 0,
        derives: false,
    };
    server.run()
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    New,
    Ready,
    ShutDown,
}

struct Server {
    /// To the client.
    send: Box<dyn Fn(Message)>,
    /// Where derivations tell their results.
    ours: Sender<Event>,
    events: Receiver<Event>,
    /// Events taken from the channel and not handled yet.
    waiting: VecDeque<Event>,
    workspace: Workspace,
    stage: Stage,
    /// Open documents whose diagnostics may have changed.
    unpublished: BTreeSet<PathBuf>,
    /// Of our own requests.
    next_id: i32,
    /// Whether a derivation runs.
    derives: bool,
}

impl Server {
    fn run(&mut self) -> Ending {
        loop {
            self.waiting.extend(self.events.try_iter());
            let event = match self.waiting.pop_front() {
                Some(event) => event,
                None if !self.unpublished.is_empty() => {
                    self.publish_one();
                    continue;
                }
                // We hold a sender ourselves, so the channel is never closed.
                None => self.events.recv().unwrap_or(Event::Closed),
            };
            match event {
                Event::Closed => return Ending::Abrupt,
                Event::Message(Message::Notification(note)) if note.method == told::Exit::METHOD => {
                    return if self.stage == Stage::ShutDown { Ending::Orderly } else { Ending::Abrupt };
                }
                Event::Message(Message::Notification(note)) => self.notification(note),
                Event::Message(Message::Request(request)) => self.request(request),
                // Our own requests ask for nothing that an answer could change.
                Event::Message(Message::Response(_)) => {}
                Event::Derived(done) => self.derived(*done),
            }
        }
    }

    fn respond<T: Serialize>(&self, id: RequestId, result: Result<T, Refusal>) {
        let response = match result {
            Ok(value) => Response::new_ok(id, value),
            Err(refusal) => Response::new_err(id, refusal.code as i32, refusal.message),
        };
        (self.send)(response.into());
    }

    fn notify<N: told::Notification<Params: Serialize>>(&self, params: N::Params) {
        (self.send)(Notification::new(N::METHOD.to_owned(), params).into());
    }

    fn refuse(&self, id: RequestId, code: ErrorCode, message: &str) {
        (self.send)(Response::new_err(id, code as i32, message.to_owned()).into());
    }

    fn request(&mut self, request: Request) {
        let Request { id, method, params } = request;
        if self.is_cancelled(&id) {
            return self.refuse(id, ErrorCode::RequestCanceled, "cancelled");
        }
        match (self.stage, method.as_str()) {
            (Stage::New, "initialize") => self.initialize(id, params),
            (Stage::New, _) => self.refuse(id, ErrorCode::ServerNotInitialized, "`initialize` comes first"),
            (Stage::Ready, "initialize") => self.refuse(id, ErrorCode::InvalidRequest, "`initialize` comes once"),
            (Stage::Ready, "shutdown") => {
                self.stage = Stage::ShutDown;
                self.respond(id, Ok(()));
            }
            (Stage::Ready, _) => self.dispatch(id, &method, params),
            (Stage::ShutDown, _) => self.refuse(id, ErrorCode::InvalidRequest, "the server was shut down"),
        }
    }

    /// Whether the client took back a request that waits behind it.
    fn is_cancelled(&self, id: &RequestId) -> bool {
        self.waiting.iter().any(|event| match event {
            Event::Message(Message::Notification(note)) if note.method == told::Cancel::METHOD => {
                let cancelled = note.params.get("id").cloned();
                cancelled.and_then(|id| serde_json::from_value::<RequestId>(id).ok()).as_ref() == Some(id)
            }
            _ => false,
        })
    }

    #[expect(deprecated, reason = "older clients tell one folder in `rootUri`")]
    fn initialize(&mut self, id: RequestId, params: serde_json::Value) {
        let params: lsp_types::InitializeParams = match serde_json::from_value(params) {
            Ok(params) => params,
            Err(error) => return self.refuse(id, ErrorCode::InvalidParams, &error.to_string()),
        };
        let offered = params.capabilities.general.as_ref().and_then(|general| general.position_encodings.as_deref());
        self.workspace.encoding = Encoding::negotiated(offered);
        self.workspace.client = client(&params.capabilities);
        let folders = params.workspace_folders.unwrap_or_default().into_iter().map(|folder| folder.uri);
        let folders: Vec<_> = folders.chain(params.root_uri).filter_map(|uri| uri::path(&uri)).collect();
        self.workspace.roots = folders.iter().map(|path| uri::real(path)).collect();
        self.workspace.roots.dedup();
        self.workspace.settings = params.initialization_options.map(settings).unwrap_or_default();
        self.stage = Stage::Ready;
        self.respond(id, Ok(capabilities(self.workspace.encoding)));
    }

    fn dispatch(&mut self, id: RequestId, method: &str, params: serde_json::Value) {
        use requests as r;
        macro_rules! answer {
            ($($kind:ty => $work:path),* $(,)?) => {
                match method {
                    $(<$kind as asked::Request>::METHOD => self.answer::<$kind, _>(id, params, $work),)*
                    <asked::ExecuteCommand as asked::Request>::METHOD => self.execute(id, params),
                    _ => self.refuse(id, ErrorCode::MethodNotFound, &format!("`{method}` is not served")),
                }
            };
        }
        answer! {
            asked::HoverRequest => r::hover::hover,
            asked::Completion => r::completion::completion,
            asked::SignatureHelpRequest => r::signature_help::signature_help,
            asked::GotoDefinition => r::definition::definition,
            asked::References => r::references::references,
            asked::DocumentHighlightRequest => r::document_highlight::document_highlight,
            asked::PrepareRenameRequest => r::rename::prepare,
            asked::Rename => r::rename::rename,
            asked::DocumentSymbolRequest => r::document_symbols::document_symbols,
            asked::WorkspaceSymbolRequest => r::workspace_symbols::workspace_symbols,
            asked::FoldingRangeRequest => r::folding_range::folding_range,
            asked::SelectionRangeRequest => r::selection_range::selection_range,
            asked::Formatting => r::formatting::formatting,
            asked::SemanticTokensFullRequest => r::semantic_tokens::semantic_tokens,
            asked::CodeLensRequest => r::code_lens::code_lens,
            asked::CodeActionRequest => r::code_action::code_action,
        }
    }

    fn answer<R: asked::Request<Params: DeserializeOwned>, T: Serialize>(
        &mut self,
        id: RequestId,
        params: serde_json::Value,
        work: impl FnOnce(&mut Workspace, R::Params) -> Result<T, Refusal>,
    ) {
        match serde_json::from_value(params) {
            Ok(params) => {
                let result = work(&mut self.workspace, params);
                self.respond(id, result);
            }
            Err(error) => self.refuse(id, ErrorCode::InvalidParams, &error.to_string()),
        }
    }

    fn execute(&mut self, id: RequestId, params: serde_json::Value) {
        let params: lsp_types::ExecuteCommandParams = match serde_json::from_value(params) {
            Ok(params) => params,
            Err(error) => return self.refuse(id, ErrorCode::InvalidParams, &error.to_string()),
        };
        match params.command.as_str() {
            requests::execute_command::EXPLAIN => {
                let result = requests::execute_command::explain(&params.arguments);
                self.respond(id, result);
            }
            requests::execute_command::DERIVE if self.derives => {
                self.refuse(id, ErrorCode::RequestFailed, "a derivation is running already");
            }
            requests::execute_command::DERIVE => {
                let work = requests::execute_command::derive(&mut self.workspace, &params.arguments);
                let Ok(work) = work else {
                    return self.respond::<()>(id, work.map(|_| ()));
                };
                let ours = self.ours.clone();
                self.derives = true;
                std::thread::spawn(move || {
                    let done = Derived { id: Some(id), ..work.run() };
                    // The server may have ended meanwhile.
                    drop(ours.send(Event::Derived(Box::new(done))));
                });
            }
            other => self.refuse(id, ErrorCode::InvalidParams, &format!("there is no command `{other}`")),
        }
    }

    /// A derivation has ended: its counts are shown.
    fn derived(&mut self, done: Derived) {
        let Derived { id, outcome } = done;
        self.derives = false;
        let result = outcome.map(|(lenses, summary)| {
            self.workspace.lenses = lenses;
            summary
        });
        if result.is_ok() && self.workspace.client.refreshes_lenses {
            self.next_id += 1;
            let method = <asked::CodeLensRefresh as asked::Request>::METHOD.to_owned();
            (self.send)(Request::new(RequestId::from(self.next_id), method, ()).into());
        }
        if let Some(id) = id {
            self.respond(id, result.map_err(Refusal::failed));
        }
    }

    fn notification(&mut self, note: Notification) {
        let Notification { method, params } = note;
        if self.stage != Stage::Ready {
            return;
        }
        // A notification that cannot be read is dropped, as the protocol has it: nobody waits for an answer.
        match method.as_str() {
            told::Initialized::METHOD if self.workspace.client.registers_watchers => self.watch_files(),
            told::DidOpenTextDocument::METHOD => read(params).into_iter().for_each(|p| self.opened(p)),
            told::DidChangeTextDocument::METHOD => read(params).into_iter().for_each(|p| self.changed(p)),
            told::DidCloseTextDocument::METHOD => read(params).into_iter().for_each(|p| self.closed(p)),
            told::DidSaveTextDocument::METHOD => {
                if let Some(DidSaveTextDocumentParams { text_document, .. }) = read(params) {
                    self.unpublished.insert(self.workspace.path(&text_document.uri));
                }
            }
            told::DidChangeWatchedFiles::METHOD => {
                read(params).into_iter().for_each(|DidChangeWatchedFilesParams { .. }| self.forget_everything());
            }
            told::DidChangeConfiguration::METHOD => {
                if let Some(DidChangeConfigurationParams { settings: given }) = read(params) {
                    let explain_scheme = self.workspace.settings.explain_scheme.take();
                    self.workspace.settings = settings(given);
                    // The editor's own, not the user's: told once.
                    self.workspace.settings.explain_scheme =
                        self.workspace.settings.explain_scheme.take().or(explain_scheme);
                    self.forget_everything();
                }
            }
            told::DidChangeWorkspaceFolders::METHOD => {
                if let Some(DidChangeWorkspaceFoldersParams { event }) = read(params) {
                    let paths = |folders: Vec<lsp_types::WorkspaceFolder>| -> Vec<PathBuf> {
                        folders.iter().filter_map(|f| uri::path(&f.uri)).map(|path| uri::real(&path)).collect()
                    };
                    let removed = paths(event.removed);
                    self.workspace.roots.retain(|root| !removed.contains(root));
                    self.workspace.roots.extend(paths(event.added));
                    self.forget_everything();
                }
            }
            _ => {}
        }
    }

    /// Asks the client to tell when rule files or recipes change on disk.
    fn watch_files(&mut self) {
        self.next_id += 1;
        let method = told::DidChangeWatchedFiles::METHOD;
        let watched = json!({ "watchers": [{ "globPattern": "**/*.{cga,render}" }] });
        let registration = json!({ "id": "files", "method": method, "registerOptions": watched });
        let params = json!({ "registrations": [registration] });
        let method = <asked::RegisterCapability as asked::Request>::METHOD.to_owned();
        (self.send)(Request::new(RequestId::from(self.next_id), method, params).into());
    }

    fn opened(&mut self, params: DidOpenTextDocumentParams) {
        let opened = params.text_document;
        let mut path = self.workspace.path(&opened.uri);
        if Language::of(&path).is_none() && uri::path(&opened.uri).is_none() {
            // A document that was never saved has no ending yet.
            let is_recipe = opened.language_id.ends_with("render");
            path.as_mut_os_string().push(if is_recipe { ".render" } else { ".cga" });
        }
        let document = Document { uri: opened.uri, version: opened.version, text: opened.text.into() };
        self.workspace.documents.open(path, document);
        self.forget_everything();
    }

    fn changed(&mut self, params: DidChangeTextDocumentParams) {
        let path = self.workspace.path(&params.text_document.uri);
        let encoding = self.workspace.encoding;
        let version = params.text_document.version;
        if self.workspace.documents.change(&path, version, params.content_changes, encoding) {
            self.workspace.changed(&path);
            let stale = self.workspace.documents.paths().filter(|path| !self.workspace.is_fresh(path)).cloned();
            self.unpublished.extend(stale.collect::<Vec<_>>());
        }
    }

    fn closed(&mut self, params: DidCloseTextDocumentParams) {
        let uri = params.text_document.uri;
        let path = self.workspace.path(&uri);
        if self.workspace.documents.close(&path).is_some() {
            self.unpublished.remove(&path);
            self.notify::<told::PublishDiagnostics>(PublishDiagnosticsParams::new(uri, Vec::new(), None));
            self.forget_everything();
        }
    }

    fn forget_everything(&mut self) {
        self.workspace.changed_anything();
        self.unpublished.extend(self.workspace.documents.paths().cloned());
    }

    /// Checks one document and sends what is wrong with it, unless it changed meanwhile.
    fn publish_one(&mut self) {
        let Some(path) = self.unpublished.pop_first() else { return };
        let Some(document) = self.workspace.documents.get(&path) else { return };
        let (uri, version) = (document.uri.clone(), document.version);
        if Language::of(&path).is_none() {
            return;
        }
        let found = diagnostics(&mut self.workspace, &path);
        self.waiting.extend(self.events.try_iter());
        let changes = |event: &Event| matches!(event, Event::Message(Message::Notification(note)) if note.method.starts_with("textDocument/did"));
        if self.waiting.iter().any(changes) {
            self.unpublished.insert(path);
            return;
        }
        self.notify::<told::PublishDiagnostics>(PublishDiagnosticsParams::new(uri, found, Some(version)));
    }
}

fn read<T: DeserializeOwned>(params: serde_json::Value) -> Option<T> {
    serde_json::from_value(params).ok()
}

/// The settings, whether or not they come below `mansard`; those that cannot be read are the defaults.
fn settings(mut given: serde_json::Value) -> Settings {
    let own = given.get_mut("mansard").map(serde_json::Value::take).unwrap_or(given);
    let mut settings: Settings = serde_json::from_value(own).unwrap_or_default();
    // Editors write an empty text where nothing is set.
    settings.recipe = settings.recipe.filter(|path| !path.as_os_str().is_empty());
    settings
}
