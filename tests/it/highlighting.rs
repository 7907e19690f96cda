//! The colours of rule files and recipes in editors. In: the TextMate grammars of docs/editors/vscode, the language's
//! tables, and every rule file and recipe of the repository. Out: grammars whose lists are those of the tables, and a scope
//! for every token, the one that its place in the program demands. `MANSARD_BLESS=1` writes the lists.
//!
//! Grammars are read by [`Grammar`], which knows the forms that ours use; `docs/editors/vscode/check.mjs` compares it with
//! VS Code's own reader.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use fancy_regex::Regex;
use mansard::cga::builtins::{Attr, Function, Operation, Word};
use mansard::cga::{CompileOptions, compile};
use mansard::source::{Access, SourceMap, Span};
use mansard::spec::schema::BLOCKS;
use serde_json::{Map, Value, json};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn grammar_path(name: &str) -> PathBuf {
    root().join(format!("docs/editors/vscode/syntaxes/{name}.tmLanguage.json"))
}

fn load(name: &str) -> Value {
    let text = std::fs::read_to_string(grammar_path(name)).expect("the grammar is there");
    serde_json::from_str(&text).expect("the grammar is JSON")
}

/// Alternatives, the longest first, since the first one that fits is taken.
fn any_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let mut words: Vec<String> = words.into_iter().map(|w| w.replace('.', "\\.")).collect();
    words.sort_by(|a, b| (b.len(), a).cmp(&(a.len(), b)));
    words.dedup();
    format!("(?:{})", words.join("|"))
}

const ANNOTATIONS: &[&str] = &[
    "StartRule",
    "Hidden",
    "Group",
    "Order",
    "Range",
    "Enum",
    "Color",
    "File",
    "Directory",
    "MaterialFile",
    "Angle",
    "Distance",
    "Percent",
    "Description",
    "DisplayName",
    "RuleFileDescription",
    "Handle",
    "InMesh",
    "InPolygon",
    "InLine",
    "InPoint",
];

/// What the tables make of the grammars' open places.
fn lists() -> [(&'static str, &'static str, String); 11] {
    let words = || Word::ALL.iter().map(|w| w.text());
    let operations = || Operation::ALL.iter().map(|o| o.name());
    let functions = || Function::ALL.iter().map(|f| f.name());
    let (letters, long): (Vec<&str>, Vec<&str>) =
        words().partition(|w| w.len() <= 3 && !w.contains('.') && *w != "all");
    let (places, long): (Vec<&str>, Vec<&str>) = long.into_iter().partition(|w| w.contains('.'));
    let attributes = Attr::table().map(|row| row.name);
    let blocks = BLOCKS.iter().map(|b| b.kind);
    let keys = BLOCKS.iter().flat_map(|b| b.keys).map(|k| k.key);
    let clauses = BLOCKS.iter().flat_map(|b| b.keys).flat_map(|k| k.clauses).copied();
    // `split`, `comp` and the like are operations and functions: what stands behind them decides little, so one scope.
    let calls = any_of(functions().filter(|f| Operation::from_name(f).is_none()));
    let steps = any_of(operations());
    [
        ("cga", "annotations", format!("@{}\\b", any_of(ANNOTATIONS.iter().copied()))),
        ("cga", "attributes", format!("\\b{}\\b(?!\\s*\\(|\\.)", any_of(attributes))),
        ("cga", "places", format!("\\b{}\\b(?!\\.\\w|\\()", any_of(places))),
        ("cga", "selectors", format!("\\b{}\\b(?=\\s*(?::(?!=)|=(?!=)))", any_of(long.iter().copied()))),
        ("cga", "letters", format!("(?<=[(,] |[(,{{|])\\b{}\\b(?=\\s*[,)])", any_of(letters))),
        ("cga", "functions", format!("\\b{calls}\\b(?=\\s*\\()")),
        ("cga", "operations", format!("\\b{steps}\\b(?=\\s*\\()|\\b{}\\b(?!\\s*[.(:=])", any_of(without_arguments()))),
        ("cga", "words", format!("\\b{}\\b(?=\\s*[,)])", any_of(long))),
        (
            "render",
            "blocks",
            format!("^\\s*({})(?:\\s+([A-Za-z_]\\w*))?(?:\\s*:\\s*([A-Za-z_]\\w*))?(?=\\s*\\{{)", any_of(blocks)),
        ),
        ("render", "keys", format!("(?<![\\w\\[|&.$/-]){}\\b(?=[ \\t]+[^\\s=|&\\],}}])", any_of(keys))),
        ("render", "clauses", format!("(?<![\\w\\[|&.$/-]){}\\b(?=[ \\t]+[^\\s=|&\\],}}])", any_of(clauses))),
    ]
}

/// Operations that may stand without parentheses.
fn without_arguments() -> Vec<&'static str> {
    let bare = |o: &Operation| o.signatures().iter().any(|s| s.split(' ').all(|p| p.is_empty() || p.ends_with('?')));
    Operation::ALL.iter().filter(|o| bare(o)).map(|o| o.name()).filter(|name| name.len() > 1).collect()
}

#[test]
fn the_grammars_lists_are_those_of_the_tables() {
    let mut grammars: BTreeMap<&str, Value> = ["cga", "render"].map(|name| (name, load(name))).into_iter().collect();
    let mut stale = Vec::new();
    for (name, entry, pattern) in lists() {
        let place =
            &mut grammars.get_mut(name).expect("it is one of the two")["repository"][entry]["patterns"][0]["match"];
        assert!(place.is_string(), "{name} has no place for {entry}");
        if *place != json!(pattern) {
            stale.push(format!("{name}: {entry}"));
            *place = json!(pattern);
        }
    }
    if std::env::var("MANSARD_BLESS").is_ok_and(|v| v == "1") {
        for (name, grammar) in &grammars {
            let text = serde_json::to_string_pretty(grammar).expect("JSON") + "\n";
            std::fs::write(grammar_path(name), text).expect("the grammar can be written");
        }
    } else {
        assert!(stale.is_empty(), "{stale:?} are not what the tables say; MANSARD_BLESS=1 writes them");
    }
}

/// The forms of TextMate grammars that ours use: `match` with `captures`, `begin` and `end`, `include` of a repository.
struct Grammar {
    rules: Vec<Rule>,
}

struct Rule {
    name: Option<String>,
    form: Form,
}

enum Form {
    Match(Regex, BTreeMap<usize, String>),
    Block(Regex, Regex, Vec<Rule>),
}

impl Grammar {
    fn new(json: &Value) -> Grammar {
        Grammar { rules: rules(&json["patterns"], json["repository"].as_object().expect("a repository")) }
    }
}

fn regex(pattern: &Value) -> Regex {
    let text = pattern.as_str().expect("a pattern is a string");
    Regex::new(text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn rules(patterns: &Value, repository: &Map<String, Value>) -> Vec<Rule> {
    let mut out = Vec::new();
    for pattern in patterns.as_array().into_iter().flatten() {
        let fields = pattern.as_object().expect("a rule is an object");
        let name = pattern["name"].as_str().map(str::to_owned);
        for field in fields.keys() {
            let known = ["name", "match", "captures", "begin", "end", "patterns", "include"];
            assert!(known.contains(&field.as_str()), "the tests' reader does not know `{field}`");
        }
        if let Some(include) = pattern["include"].as_str() {
            let entry = include.strip_prefix('#').expect("includes name the repository");
            out.extend(rules(&repository[entry]["patterns"], repository));
        } else if fields.contains_key("begin") {
            let inner = rules(&pattern["patterns"], repository);
            out.push(Rule { name, form: Form::Block(regex(&pattern["begin"]), regex(&pattern["end"]), inner) });
        } else {
            let captures = pattern["captures"].as_object().into_iter().flatten();
            let scope = |(number, value): (&String, &Value)| {
                (number.parse().expect("a number"), value["name"].as_str().expect("a name").to_owned())
            };
            out.push(Rule { name, form: Form::Match(regex(&pattern["match"]), captures.map(scope).collect()) });
        }
    }
    out
}

/// Bytes of a line with a scope.
#[derive(Clone, Debug)]
struct Piece {
    line: usize,
    from: usize,
    to: usize,
    /// `None` where no rule fits.
    scope: Option<String>,
}

/// The pieces of a text in order; the parts of a line that hold nothing but space are left out.
fn read(grammar: &Grammar, text: &str) -> Vec<Piece> {
    let mut out = Vec::new();
    let mut open: Option<&Rule> = None;
    for (line, content) in text.split('\n').enumerate() {
        let mut scopes: Vec<Option<&str>> = vec![None; content.len()];
        let mut at = 0;
        while at <= content.len() {
            let (active, end): (&[Rule], Option<&Regex>) = match open.map(|rule| &rule.form) {
                Some(Form::Block(_, end, inner)) => (inner, Some(end)),
                _ => (&grammar.rules, None),
            };
            // The end of a block goes before what is inside it, where both begin at the same place.
            let ended = end.and_then(|end| end.find_from_pos(content, at).expect("the pattern runs"));
            let mut best: Option<(usize, usize, &Rule)> = None;
            for rule in active {
                let (Form::Match(pattern, _) | Form::Block(pattern, _, _)) = &rule.form;
                if let Some(found) = pattern.find_from_pos(content, at).expect("the pattern runs")
                    && best.is_none_or(|(start, _, _)| found.start() < start)
                {
                    best = Some((found.start(), found.end(), rule));
                }
            }
            let whole = open.and_then(|rule| rule.name.as_deref());
            match (ended, best) {
                (Some(end), best) if best.is_none_or(|(start, _, _)| end.start() <= start) => {
                    scopes[at..end.end()].fill(whole);
                    at = end.end();
                    open = None;
                }
                (_, Some((start, end, rule))) => {
                    scopes[at..start].fill(whole);
                    scopes[start..end].fill(rule.name.as_deref().or(whole));
                    match &rule.form {
                        Form::Block(..) => open = Some(rule),
                        Form::Match(pattern, captures) => {
                            let groups = pattern.captures_from_pos(content, at).expect("it runs").expect("it fits");
                            for (number, scope) in captures {
                                groups
                                    .get(*number)
                                    .into_iter()
                                    .for_each(|g| scopes[g.start()..g.end()].fill(Some(scope)));
                            }
                        }
                    }
                    at = if end > at { end } else { at + 1 };
                }
                _ => {
                    scopes[at..].fill(whole);
                    break;
                }
            }
        }
        let mut from = 0;
        while from < content.len() {
            let to = (from..content.len()).find(|&i| scopes[i] != scopes[from]).unwrap_or(content.len());
            if !content[from..to].trim().is_empty() {
                out.push(Piece { line, from, to, scope: scopes[from].map(str::to_owned) });
            }
            from = to;
        }
    }
    out
}

fn files(suffix: &str) -> Vec<PathBuf> {
    let mut folders = vec![root().join("rules"), root().join("examples")];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("the folder is there") {
            let path = entry.expect("it can be listed").path();
            match path.is_dir() {
                true => folders.push(path),
                false if path.to_string_lossy().ends_with(suffix) => found.push(path),
                false => {}
            }
        }
    }
    found.sort();
    assert!(!found.is_empty(), "there are files of {suffix}");
    found
}

#[test]
fn every_token_of_every_file_has_a_scope() {
    let mut all = BTreeMap::new();
    for (name, suffix) in [("cga", ".cga"), ("render", ".render")] {
        let grammar = Grammar::new(&load(name));
        for path in files(suffix) {
            let text = std::fs::read_to_string(&path).expect("it can be read");
            let lines: Vec<&str> = text.split('\n').collect();
            let short = path.strip_prefix(root()).expect("below the repository").display().to_string();
            let mut tokens = Vec::new();
            for Piece { line, from, to, scope } in read(&grammar, &text) {
                let piece = &lines[line][from..to];
                let scope = scope.unwrap_or_else(|| panic!("{short}:{}: `{}` has no scope", line + 1, piece.trim()));
                let column = lines[line][..from].encode_utf16().count() + 1;
                tokens.push(format!("{}:{column} {scope} {}", line + 1, piece.trim()));
            }
            all.insert(short, tokens);
        }
    }
    // For docs/editors/vscode/check.mjs, which compares VS Code's reader with this one.
    if let Some(file) = std::env::var_os("MANSARD_HIGHLIGHTING") {
        std::fs::write(file, serde_json::to_string(&all).expect("JSON")).expect("it can be written");
    }
}

/// The scope at the first byte of a span.
fn scope_at(pieces: &[Piece], text: &str, span: Span) -> Option<String> {
    let start = span.start as usize;
    let line = text[..start].matches('\n').count();
    let column = start - text[..start].rfind('\n').map_or(0, |at| at + 1);
    pieces.iter().find(|p| p.line == line && (p.from..p.to).contains(&column)).and_then(|p| p.scope.clone())
}

#[test]
fn declarations_have_the_scope_of_what_they_declare() {
    let grammar = Grammar::new(&load("cga"));
    let mut seen = 0;
    for path in files(".cga") {
        let mut sources = SourceMap::default();
        let access = Access::new(path.parent().expect("a file has a folder")).expect("the folder is there");
        let (program, _) = compile(&path, &access, &mut sources, &CompileOptions::default());
        let program = program.unwrap_or_else(|| panic!("{} compiles", path.display()));
        let source = program.files()[0].source;
        let text = sources.get(source).text.to_string();
        let pieces = read(&grammar, &text);
        let rules = program.rules().iter().map(|r| (r.span, &r.name, "entity.name.function.rule.cga"));
        let attributes = program.attributes().iter().map(|a| (a.span, &a.name, "variable.other.attribute.cga"));
        for (span, name, expected) in rules.chain(attributes).filter(|(span, ..)| span.source == source) {
            let found = scope_at(&pieces, &text, span);
            assert_eq!(found.as_deref(), Some(expected), "{}: {name}", path.display());
            seen += 1;
        }
    }
    assert!(seen > 100, "{seen} declarations");
}

#[test]
fn every_word_of_the_tables_is_highlighted_where_it_may_stand() {
    let grammar = Grammar::new(&load("cga"));
    let scope = |text: &str, word: &str| {
        let at = text.find(word).expect("the word is in the text");
        let pieces = read(&grammar, text);
        let whole = pieces.iter().find(|p| p.from <= at && at + word.len() <= p.to);
        whole.and_then(|p| p.scope.clone()).unwrap_or_default()
    };
    let mut wrong = Vec::new();
    let mut expect = |text: String, word: &str, wanted: &str| {
        let found = scope(&text, word);
        if !found.starts_with(wanted) {
            wrong.push(format!("`{word}` in `{text}`: {found:?}, not {wanted}"));
        }
    };
    for operation in Operation::ALL {
        let name = operation.name();
        expect(format!("A --> {name}(1) B"), name, "support.function");
    }
    for name in without_arguments() {
        expect(format!("A --> {name} B"), name, "support.function.operation");
    }
    for function in Function::ALL {
        expect(format!("A --> set(a, {}(1))", function.name()), function.name(), "support.function");
    }
    for row in Attr::table() {
        expect(format!("A --> t(0, {} * 2, 0)", row.name), row.name, "support.variable");
    }
    for word in Word::ALL.iter().map(|w| w.text()) {
        expect(format!("A --> q({word}, 1)"), &format!("{word},")[..word.len()], "support.constant");
        if word.len() > 3 {
            expect(format!("A --> comp(f) {{ {word} : B }}"), word, "support.constant");
        }
    }
    for annotation in ANNOTATIONS {
        expect(format!("@{annotation}"), annotation, "storage.type.annotation");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn recipes_show_their_blocks_keys_and_units() {
    let grammar = Grammar::new(&load("render"));
    let text = "camera satellite : base {\n  size  1024 x 1024  gsd 0.6m\n}\npass after { show all with burnt }\nmap \"a.osm\"";
    let pieces = read(&grammar, text);
    let lines: Vec<&str> = text.split('\n').collect();
    let scope = |word: &str| {
        let piece = pieces.iter().find(|p| lines[p.line][p.from..p.to].trim() == word);
        piece.and_then(|p| p.scope.clone()).unwrap_or_else(|| panic!("`{word}` is no piece of its own: {pieces:?}"))
    };
    for (word, expected) in [
        ("camera", "storage.type.block.mansard-render"),
        ("satellite", "entity.name.type.mansard-render"),
        ("base", "entity.other.inherited-class.mansard-render"),
        ("size", "support.type.property-name.mansard-render"),
        ("gsd", "support.type.property-name.mansard-render"),
        ("0.6", "constant.numeric.mansard-render"),
        ("m", "keyword.other.unit.mansard-render"),
        ("x", "keyword.operator.mansard-render"),
        ("with", "keyword.other.clause.mansard-render"),
        ("burnt", "constant.other.word.mansard-render"),
        ("\"a.osm\"", "string.quoted.double.mansard-render"),
    ] {
        assert_eq!(scope(word), expected, "{word}");
    }
}
