//! In: bytes. Out: texts of the language's own words in any order.

use arbitrary::{Result, Unstructured};

use crate::cga::builtins::{Attr, Function, Operation, Word};

const MARKS: &[&str] = &[
    "(", ")", "(", ")", "[", "]", "{", "}", "{", "}", "|", "|", ",", ",", ";", ":", ":", ":", "=", "=:", "-->", "-->",
    ":=", "%", "% :", "*", "+", "-", "/", "!", "<", "<=", "==", "!=", "&&", "||", ".+", ".*", ".==", ".", "'", "~",
    "@", "\"", "\n", "\n", "// c\n", "/*", "*/", "$",
];
const WORDS: &[&str] = &[
    "version",
    "import",
    "style",
    "extends",
    "attr",
    "const",
    "start",
    "extension",
    "with",
    "case",
    "else",
    "NIL",
    "true",
    "false",
    "split",
    "comp",
    "setback",
    "scatter",
    "inline",
    "union",
    "subtract",
    "modify",
    "A",
    "B",
    "C.",
    "x",
    "y",
    "lib",
    "lib.A",
    "A -->",
    "B -->",
    "attr x =",
    "x =",
    "f(x) =",
    "1",
    "0.5",
    "-1",
    "1e9",
    "\"a\"",
    "\"f.cga\"",
    "case x :",
    "else :",
    "50% :",
    "split(x) {",
    "comp(f) {",
    "top :",
    "~1 :",
    "}*",
    "@Range(0, 1)",
    "@Group",
    "@StartRule",
    "@Hidden",
];

/// A text of up to 300 words.
pub fn text(bytes: &mut Unstructured<'_>) -> Result<String> {
    let mut out = String::new();
    for _ in 0..bytes.int_in_range(0..=300)? {
        if bytes.is_empty() {
            break;
        }
        let word = match bytes.int_in_range(0..=9)? {
            0 => Operation::ALL[bytes.choose_index(Operation::ALL.len())?].name(),
            1 => Function::ALL[bytes.choose_index(Function::ALL.len())?].name(),
            2 => Word::ALL[bytes.choose_index(Word::ALL.len())?].text(),
            3 => {
                let count = Attr::table().count();
                Attr::table().nth(bytes.choose_index(count)?).expect("below the count").name
            }
            4..=6 => *bytes.choose(MARKS)?,
            _ => *bytes.choose(WORDS)?,
        };
        out.push_str(word);
        out.push(' ');
    }
    Ok(out)
}
