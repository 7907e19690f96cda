//! What the editor shows about a text: hovers, symbols, folds, layout, colours, lenses.

use serde_json::{Value, json};

use super::editor::{Editor, edited, marks, shipped};

const RULES: &str = "/* A town house. */\nimport lib : \"lib.cga\"\n\n// How high it stands,\n// to the eaves.\n\
                     @Range(min=1, max=40, stepsize=0.5)\nattr height = 3\nconst half = height / 2\n\
                     twice(x) = x * 2\n\n/** The lot. */\n@StartRule\nLot --> extrude(world.up, twice(half))\n    \
                     comp(f) {\n        top : lib.Roof(1) |\n        side : Wall(lib.pitch)\n    }\n\n\
                     Wall(h) with( w := scope.sx ) --> case w > h && rand(0, 1) < 0.5 : color(\"#ff0000\") X. else : NIL\n";
const LIB: &str = "attr pitch = 30\nRoof(a) --> roofHip(pitch * a)\n";

#[test]
fn hovers_tell_what_the_manual_and_the_author_say() {
    let mut editor = Editor::new(&[("lib.cga", LIB)]);
    editor.open("a.cga", RULES);
    let cases = [
        ("extrude", RULES.replace("extrude(", "ext¦rude(")),
        ("word", RULES.replace("world.up", "world¦.up")),
        ("attribute", RULES.replace("attr height", "attr hei¦ght")),
        ("constant", RULES.replace("twice(half)", "twice(ha¦lf)")),
        ("function", RULES.replace("twice(half)", "tw¦ice(half)")),
        ("imported rule", RULES.replace("lib.Roof", "lib.Ro¦of")),
        ("import", RULES.replace("lib.Roof", "l¦ib.Roof")),
        ("rule", RULES.replace("Lot -->", "L¦ot -->")),
        ("parameter", RULES.replace("w > h", "w > h¦")),
        ("built-in attribute", RULES.replace("scope.sx", "scope.s¦x")),
        ("built-in function", RULES.replace("rand(", "r¦and(")),
        ("leaf", RULES.replace("X.", "¦X.")),
        ("keyword", RULES.replace("case w", "ca¦se w")),
        ("annotation", RULES.replace("@Range", "@Ra¦nge")),
        ("nothing", RULES.replace("A town house", "A town¦ house")),
    ];
    let mut said = String::new();
    for (what, marked) in cases {
        let (text, positions) = marks(&marked);
        assert_eq!(text, RULES, "{what}: the text has no such place");
        let hover = editor.at("textDocument/hover", "a.cga", &positions[0]).expect("an answer");
        said += &format!("=== {what}\n{}\n", hover["contents"]["value"].as_str().unwrap_or("null"));
    }
    insta::assert_snapshot!(said);
}

#[test]
fn hovers_of_recipes_tell_values_and_defaults() {
    let text = "camera low { off_nadir 5deg }\nscene town {\n  rules \"lib.cga\" for building { pitch = 4 }\n}\n";
    let mut editor = Editor::new(&[("lib.cga", LIB)]);
    editor.open("a.render", text);
    let marked = [
        text.replace("off_nadir", "off_¦nadir"),
        text.replace("{ pitch", "{ pi¦tch"),
        text.replace("for building", "f¦or building"),
        text.replace("scene", "sc¦ene"),
    ];
    let mut said = String::new();
    for marked in marked {
        let (_, positions) = marks(&marked);
        let hover = editor.at("textDocument/hover", "a.render", &positions[0]).expect("an answer");
        said += &format!("{}\n===\n", hover["contents"]["value"].as_str().unwrap_or("null"));
    }
    insta::assert_snapshot!(said);
}

fn of_document(editor: &mut Editor, kind: &str, name: &str) -> Value {
    let params = json!({ "textDocument": { "uri": editor.uri(name) } });
    editor.request(&format!("textDocument/{kind}"), params).expect(kind)
}

/// `Name (detail) first-last` with children indented.
fn outline(symbols: &Value, indent: usize, out: &mut String) {
    for symbol in symbols.as_array().into_iter().flatten() {
        let (range, text) = (&symbol["range"], |key: &str| symbol[key].as_str().unwrap_or_default().to_owned());
        let lines = format!("{}-{}", range["start"]["line"], range["end"]["line"]);
        *out += &format!("{}{} ({}) {lines}\n", " ".repeat(indent), text("name"), text("detail"));
        outline(&symbol["children"], indent + 2, out);
    }
}

#[test]
fn symbols_and_folds_follow_the_declarations() {
    let mut editor = Editor::new(&[("lib.cga", LIB)]);
    editor.open("a.cga", RULES);
    let mut said = String::new();
    outline(&of_document(&mut editor, "documentSymbol", "a.cga"), 0, &mut said);
    editor.open("a.render", "camera low {\n  off_nadir 5deg\n}\nscene town {\n  seed 3\n}\n");
    outline(&of_document(&mut editor, "documentSymbol", "a.render"), 0, &mut said);
    let folds = of_document(&mut editor, "foldingRange", "a.cga");
    for fold in folds.as_array().expect("a list") {
        said += &format!("fold {}-{} {}\n", fold["startLine"], fold["endLine"], fold["kind"].as_str().unwrap_or(""));
    }
    insta::assert_snapshot!(said);
}

#[test]
fn a_selection_grows_from_the_word_to_the_file() {
    let mut editor = Editor::new(&[]);
    let at = editor.open("a.cga", "Lot --> extrude(max(1, hei¦ght))\n");
    let params = json!({ "textDocument": { "uri": editor.uri("a.cga") }, "positions": at });
    let found = editor.request("textDocument/selectionRange", params).expect("ranges");
    let mut columns = Vec::new();
    let mut range = &found[0];
    while range.is_object() {
        columns.push((range["range"]["start"]["character"].clone(), range["range"]["end"]["character"].clone()));
        range = &range["parent"];
    }
    let ends: Vec<(u64, u64)> =
        columns.iter().map(|(a, b)| (a.as_u64().unwrap_or(0), b.as_u64().unwrap_or(0))).collect();
    assert_eq!(ends[..5], [(23, 29), (20, 29), (19, 30), (16, 30), (15, 31)], "{ends:?}");
}

#[test]
fn formatting_gives_the_house_layout() {
    let mut editor = Editor::new(&[]);
    let text = "attr a=1\nLot-->extrude( a )   X.\n";
    editor.open("a.cga", text);
    let params =
        json!({ "textDocument": { "uri": editor.uri("a.cga") }, "options": { "tabSize": 2, "insertSpaces": true } });
    let edits = editor.request("textDocument/formatting", params.clone()).expect("edits");
    assert_eq!(edited(text, edits.as_array().expect("a list")), "attr a = 1\nLot --> extrude(a) X.\n");
    editor.replace("a.cga", 2, "attr a = 1\nLot --> extrude(a) X.\n");
    assert_eq!(editor.request("textDocument/formatting", params.clone()), Ok(json!([])));
    editor.replace("a.cga", 3, "Lot --> extrude(\n");
    let error = editor.request("textDocument/formatting", params).expect_err("refused");
    assert_eq!(error["message"], json!("the file has syntax errors; it stays as it is"));
}

const TYPES: [&str; 14] = [
    "import",
    "rule",
    "attribute",
    "constant",
    "function",
    "operation",
    "parameter",
    "word",
    "annotation",
    "keyword",
    "text",
    "number",
    "comment",
    "operator",
];

/// `written type modifiers` for each token, and the tokens' places.
fn tokens(text: &str, answer: &Value) -> Vec<(String, String)> {
    let data: Vec<usize> =
        answer["data"].as_array().expect("a list").iter().map(|n| n.as_u64().expect("a number") as usize).collect();
    let lines: Vec<Vec<u16>> = text.lines().map(|line| line.encode_utf16().collect()).collect();
    let (mut line, mut column) = (0, 0);
    let token = |t: &[usize]| {
        (line, column) = if t[0] > 0 { (line + t[0], t[1]) } else { (line, column + t[1]) };
        let written = String::from_utf16(&lines[line][column..column + t[2]]).expect("whole characters");
        (written, format!("{}{}", TYPES[t[3]], ["", "!"][t[4] & 1]))
    };
    data.chunks(5).map(token).collect()
}

#[test]
fn tokens_have_the_kinds_of_what_they_name() {
    let mut editor = Editor::new(&[("lib.cga", LIB)]);
    editor.open("a.cga", RULES);
    let answer = of_document(&mut editor, "semanticTokens/full", "a.cga");
    let said: Vec<String> = tokens(RULES, &answer).into_iter().map(|(text, kind)| format!("{kind}: {text}")).collect();
    insta::assert_snapshot!(said.join("\n"));
    let recipe = "input m : files\n# a town\ncamera low { off_nadir 5deg }\nscene s { map $m; rules \"lib.cga\" for building { pitch = 4 } }\n";
    editor.open("a.render", recipe);
    let answer = of_document(&mut editor, "semanticTokens/full", "a.render");
    let said: Vec<String> = tokens(recipe, &answer).into_iter().map(|(text, kind)| format!("{kind}: {text}")).collect();
    insta::assert_snapshot!("tokens_of_a_recipe", said.join("\n"));
}

/// Every word of every shipped rule file has a kind: nothing in them is left to guess.
#[test]
fn every_name_in_the_shipped_rules_is_known() {
    let mut editor = Editor::new(&[]);
    for path in shipped() {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("readable");
        editor.open(&name, &text);
        let answer = of_document(&mut editor, "semanticTokens/full", &name);
        let known = tokens(&text, &answer);
        let mut rest = text.as_str();
        let mut unknown: Vec<String> = Vec::new();
        for (written, _) in &known {
            let at = rest.find(written.as_str()).expect("tokens are in order");
            unknown.extend(words(&rest[..at]));
            rest = &rest[at + written.len()..];
        }
        unknown.extend(words(rest));
        assert_eq!(unknown, Vec::<String>::new(), "{name}");
    }
}

/// Names in a text; keys of annotations are none.
fn words(text: &str) -> Vec<String> {
    let split = |c: char| !(c.is_alphanumeric() || c == '_');
    let keys = ["min", "max", "stepsize", "restricted"];
    let found = text.split(split).filter(|w| w.starts_with(|c: char| c.is_alphabetic()) && !keys.contains(w));
    found.map(str::to_owned).collect()
}

#[test]
fn lenses_count_what_the_last_derivation_made() {
    let mut editor = Editor::new(&[]);
    let text = "@StartRule\nLot --> extrude(3) comp(f) { side : Wall | top : Roof }\nWall --> split(x) { ~1 : Pane }*\nPane --> color(1, 0, 0)\nRoof --> color(0, 0, 1)\n";
    editor.open("a.cga", text);
    let titles = |lenses: &Value| -> Vec<String> {
        let title = |lens: &Value| lens["command"]["title"].as_str().unwrap_or_default().to_owned();
        lenses.as_array().expect("a list").iter().map(title).collect()
    };
    let lenses = of_document(&mut editor, "codeLens", "a.cga");
    assert_eq!(titles(&lenses), ["Derive"]);
    let command = json!({ "command": lenses[0]["command"]["command"], "arguments": lenses[0]["command"]["arguments"] });
    let summary = editor.request("workspace/executeCommand", command.clone()).expect("it derives");
    let asked = editor.notes.iter().any(|note| note["method"] == json!("workspace/codeLens/refresh"));
    assert!(asked, "the editor is told to ask for lenses again");
    let without_time = |text: &str| text.split(" · ").next().unwrap_or_default().to_owned();
    let leaves = summary.as_str().unwrap_or_default().split(" in ").next().unwrap_or_default().to_owned();
    let after = titles(&of_document(&mut editor, "codeLens", "a.cga"));
    let shown: Vec<String> = after.iter().map(|title| without_time(title)).collect();
    insta::assert_json_snapshot!(json!({ "summary": leaves, "lenses": shown }));
    // A line above moves the lenses; what they say stays until the next derivation.
    editor.replace("a.cga", 2, &format!("// moved\n{text}"));
    let moved = of_document(&mut editor, "codeLens", "a.cga");
    assert_eq!(titles(&moved), after);
    assert_eq!(moved[0]["range"]["start"]["line"], json!(2));
    editor.replace("a.cga", 3, "Lot --> extrude(\n");
    let error = editor.request("workspace/executeCommand", command).expect_err("the rules are broken");
    assert_eq!(error["code"], json!(-32803));
}

#[test]
fn lenses_count_in_the_recipe_that_uses_the_rules() {
    let osm = "<osm version=\"0.6\"><node id=\"1\" lat=\"47.0\" lon=\"8.0\"/><node id=\"2\" lat=\"47.0\" lon=\"8.0002\"/>\
               <node id=\"3\" lat=\"47.0001\" lon=\"8.0002\"/><node id=\"4\" lat=\"47.0001\" lon=\"8.0\"/><way id=\"9\"><nd ref=\"1\"/>\
               <nd ref=\"2\"/><nd ref=\"3\"/><nd ref=\"4\"/><nd ref=\"1\"/><tag k=\"building\" v=\"yes\"/></way></osm>";
    let lib = "Wall --> color(1, 0, 0)\n";
    let main = "import lib : \"lib.cga\"\n@StartRule\nLot --> extrude(3) comp(f) { side : lib.Wall }\n";
    let recipe = "scene town {\n  map \"town.osm\"\n  rules \"main.cga\" for building\n}\n";
    let files = [("town.osm", osm), ("lib.cga", lib), ("main.cga", main), ("town.render", recipe)];
    let mut editor = Editor::new(&files);
    // The library is used through the file that the recipe names; its text as it is shown counts.
    editor.open("lib.cga", "Wall --> split(x) { '0.5 : Half | ~1 : Half }\nHalf --> color(1, 0, 0)\n");
    let command = json!({ "command": "mansard.derive", "arguments": [editor.uri("lib.cga")] });
    let summary = editor.request("workspace/executeCommand", command).expect("it derives");
    assert!(summary.as_str().is_some_and(|said| said.starts_with("town.render: 8 leaves in ")), "{summary}");
    let lenses = of_document(&mut editor, "codeLens", "lib.cga");
    let titles: Vec<&str> =
        lenses.as_array().expect("a list").iter().filter_map(|lens| lens["command"]["title"].as_str()).collect();
    let counts: Vec<&str> = titles.iter().map(|title| title.split(" · ").next().unwrap_or_default()).collect();
    assert_eq!(counts, ["4 calls", "Derived: town.render", "8 leaves"]);
}
