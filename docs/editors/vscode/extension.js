// Starts `mansard lsp` for rule files and recipes, and runs `mansard check` and `mansard watch` where they are asked for.
"use strict";

const vscode = require("vscode");
const { LanguageClient, TransportKind } = require("vscode-languageclient/node");

const LANGUAGES = ["cga", "mansard-render"];
/** Documents `mansard-explain:CODE.md` are pages of `mansard explain`. */
const EXPLAIN = "mansard-explain";

/** @type {LanguageClient | undefined} */
let client;

function settings() {
  return vscode.workspace.getConfiguration("mansard");
}

function program() {
  return settings().get("path", "mansard");
}

async function start() {
  const run = { command: program(), args: ["lsp"], transport: TransportKind.stdio };
  client = new LanguageClient(
    "mansard",
    "Mansard",
    { run, debug: run },
    {
      documentSelector: LANGUAGES.map((language) => ({ language })),
      initializationOptions: {
        recipe: settings().get("recipe") || undefined,
        set: settings().get("set", []),
        allow: settings().get("allow", []),
        explainScheme: EXPLAIN,
      },
      synchronize: {
        configurationSection: "mansard",
        fileEvents: vscode.workspace.createFileSystemWatcher("**/*.{cga,render}"),
      },
    },
  );
  try {
    await client.start();
  } catch (error) {
    const choice = await vscode.window.showErrorMessage(
      `Mansard's language server did not start: ${error.message ?? error}`,
      "Set the program's path",
    );
    if (choice) vscode.commands.executeCommand("workbench.action.openSettings", "mansard.path");
  }
}

async function stop() {
  const running = client;
  client = undefined;
  if (running?.isRunning()) await running.stop();
}

/** The file that a command is for: the one clicked on, or the one being edited. */
function target(uri) {
  const chosen = uri ?? vscode.window.activeTextEditor?.document.uri;
  if (!chosen || chosen.scheme !== "file") {
    vscode.window.showWarningMessage("Mansard: no file is open that could be used.");
    return undefined;
  }
  return chosen.fsPath;
}

function checkTask(file, definition = { type: "mansard", file }) {
  const execution = new vscode.ProcessExecution(program(), ["check", "--format", "short", file]);
  const name = `check ${vscode.workspace.asRelativePath(file)}`;
  const task = new vscode.Task(definition, vscode.TaskScope.Workspace, name, "mansard", execution, "$mansard");
  task.presentationOptions = { reveal: vscode.TaskRevealKind.Silent, clear: true };
  return task;
}

function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("mansard.restart", async () => {
      await stop();
      await start();
    }),
    vscode.commands.registerCommand("mansard.check", (uri) => {
      const file = target(uri);
      return file && vscode.tasks.executeTask(checkTask(file));
    }),
    vscode.commands.registerCommand("mansard.watch", (uri) => {
      const file = target(uri);
      if (!file) return;
      const terminal = vscode.window.createTerminal({ name: "mansard watch", shellPath: program(), shellArgs: ["watch", file] });
      terminal.show(true);
    }),
    vscode.workspace.registerTextDocumentContentProvider(EXPLAIN, {
      provideTextDocumentContent: (uri) =>
        client?.sendRequest("workspace/executeCommand", {
          command: "mansard.explain",
          arguments: [uri.path.replace(/\.md$/, "")],
        }),
    }),
    vscode.tasks.registerTaskProvider("mansard", {
      provideTasks() {
        const document = vscode.window.activeTextEditor?.document;
        return document && LANGUAGES.includes(document.languageId) ? [checkTask(document.uri.fsPath)] : [];
      },
      resolveTask: (task) => checkTask(task.definition.file, task.definition),
    }),
    vscode.workspace.onDidChangeConfiguration(async (change) => {
      if (change.affectsConfiguration("mansard.path")) {
        await stop();
        await start();
      }
    }),
  );
  return start();
}

module.exports = { activate, deactivate: stop };
