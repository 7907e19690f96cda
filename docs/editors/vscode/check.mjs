// Reads every rule file and recipe of the repository with the grammars, as VS Code does (vscode-textmate, oniguruma).
// In: the repository, and what tests/it/highlighting.rs read with its own reader, where MANSARD_HIGHLIGHTING names the file:
//   MANSARD_HIGHLIGHTING=/tmp/read.json cargo test --release --test it highlighting
//   MANSARD_HIGHLIGHTING=/tmp/read.json npm run check
// Out: a line per file; exit code 1 if a token has no scope, or another one.
import { readFileSync, readdirSync, existsSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { createRequire } from "node:module";

const require = createRequire(import.meta.url);
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

const here = dirname(fileURLToPath(import.meta.url));
const root = process.env.MANSARD_ROOT ?? join(here, "../../..");
const grammars = { "source.cga": "cga", "source.mansard-render": "render" };

await oniguruma.loadWASM(readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm")).buffer);
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async (scope) => {
    const path = join(here, "syntaxes", `${grammars[scope]}.tmLanguage.json`);
    return textmate.parseRawGrammar(readFileSync(path, "utf8"), path);
  },
});

function* files(folder) {
  for (const entry of readdirSync(folder, { withFileTypes: true }).sort((a, b) => (a.name < b.name ? -1 : 1))) {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) yield* files(path);
    else if (/\.(cga|render)$/.test(entry.name)) yield path;
  }
}

/** One line per token: what tests/it/highlighting.rs writes. */
async function read(path) {
  const grammar = await registry.loadGrammar(path.endsWith(".cga") ? "source.cga" : "source.mansard-render");
  const lines = [];
  let stack = textmate.INITIAL;
  readFileSync(path, "utf8").split("\n").forEach((line, number) => {
    const result = grammar.tokenizeLine(line, stack);
    stack = result.ruleStack;
    const pieces = [];
    for (const { startIndex: from, endIndex: to, scopes } of result.tokens) {
      const last = pieces.at(-1);
      if (last?.scope === scopes.at(-1)) last.to = to;
      else pieces.push({ from, to, scope: scopes.at(-1) });
    }
    for (const { from, to, scope } of pieces) {
      const text = line.slice(from, to).trim();
      if (text) lines.push(`${number + 1}:${from + 1} ${scope.startsWith("source.") ? "NOTHING" : scope} ${text}`);
    }
  });
  return lines;
}

const expected = process.env.MANSARD_HIGHLIGHTING;
const wanted = expected && existsSync(expected) ? JSON.parse(readFileSync(expected, "utf8")) : undefined;
let wrong = 0;
for (const folder of ["rules", "examples"]) {
  for (const path of files(join(root, folder))) {
    const name = relative(root, path);
    const tokens = await read(path);
    const bare = tokens.filter((token) => token.includes(" NOTHING "));
    const other = wanted ? tokens.filter((token, i) => token !== wanted[name]?.[i]) : [];
    wrong += bare.length + other.length;
    console.log(`${name}: ${tokens.length} tokens, ${bare.length} without a scope${wanted ? `, ${other.length} unlike the tests' reader` : ""}`);
    for (const token of [...bare, ...other].slice(0, 5)) console.log(`  ${token}`);
  }
}
process.exit(wrong ? 1 : 0);
