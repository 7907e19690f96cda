//! `textDocument/semanticTokens/full`: what every word is, from resolved names; the types are told in the module's page
//! ([`crate::language_server`]).

use std::collections::BTreeMap;
use std::path::Path;

use lsp_types::{
    SemanticToken, SemanticTokenModifier, SemanticTokenType, SemanticTokens, SemanticTokensLegend, SemanticTokensParams,
};

use crate::cga::Meaning;
use crate::cga::builtins::Attr;
use crate::cga::parse::lex;
use crate::cga::parse::tokens::letter;
use crate::language_server::position::{Encoding, Lines};
use crate::language_server::recipe_context::{self, TokenKind};
use crate::language_server::recipe_file;
use crate::language_server::rule_file::{Declared, Kind, RuleFile};
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};

/// Types in the order of the legend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Type {
    Import,
    Rule,
    Attribute,
    Constant,
    Function,
    Operation,
    Parameter,
    Word,
    Annotation,
    Keyword,
    Text,
    Number,
    Comment,
    Operator,
}

const DECLARATION: u32 = 1;
const READ_ONLY: u32 = 2;
const LANGUAGE: u32 = 4;
const DEPRECATED: u32 = 8;

pub fn legend() -> SemanticTokensLegend {
    use SemanticTokenModifier as M;
    use SemanticTokenType as T;
    SemanticTokensLegend {
        token_types: vec![
            T::NAMESPACE,
            T::CLASS,
            T::PROPERTY,
            T::VARIABLE,
            T::FUNCTION,
            T::METHOD,
            T::PARAMETER,
            T::ENUM_MEMBER,
            T::DECORATOR,
            T::KEYWORD,
            T::STRING,
            T::NUMBER,
            T::COMMENT,
            T::OPERATOR,
        ],
        token_modifiers: vec![M::DECLARATION, M::READONLY, M::DEFAULT_LIBRARY, M::DEPRECATED],
    }
}

/// Type and modifiers by start and end of the token.
type Found = BTreeMap<(u32, u32), (Type, u32)>;

pub fn semantic_tokens(
    workspace: &mut Workspace,
    params: SemanticTokensParams,
) -> Result<Option<SemanticTokens>, Refusal> {
    let path = workspace.path(&params.text_document.uri);
    let Some(text) = workspace.lined(&path) else { return Ok(None) };
    let found = match Language::of(&path) {
        Some(Language::Rules) => of_rules(workspace, &path, &text.text),
        Some(Language::Recipe) => of_recipe(workspace, &path, &text.text),
        None => return Ok(None),
    };
    Ok(Some(SemanticTokens { result_id: None, data: encoded(&text.lines(), workspace.encoding, &found) }))
}

fn of_rules(workspace: &mut Workspace, path: &Path, text: &str) -> Found {
    let mut found = lexical(text);
    let Some(file) = workspace.rules(path) else { return found };
    let Some(main) = file.main() else { return found };
    for name in file.index.names.iter().filter(|name| name.span.source == main.ast.source) {
        if let Some(kind) = of_meaning(&file, name.meaning) {
            put(&mut found, name.span.start, name.span.end, kind);
        }
    }
    for declared in file.declared.iter().filter(|d| d.file == 0) {
        let (kind, modifiers) = of_declared(declared);
        put(&mut found, declared.name.span.start, declared.name.span.end, (kind, modifiers | DECLARATION));
    }
    found
}

/// Puts a name in, and takes out the word that it is a part of: the lexer reads `lib.Wall` as one.
fn put(found: &mut Found, start: u32, end: u32, kind: (Type, u32)) {
    let around = found.range(..=(start, u32::MAX)).next_back().map(|(place, _)| *place);
    if let Some(around) = around.filter(|(a, b)| *a <= start && end <= *b) {
        found.remove(&around);
    }
    found.insert((start, end), kind);
}

fn of_meaning(file: &RuleFile, meaning: Meaning) -> Option<(Type, u32)> {
    Some(match meaning {
        Meaning::Operation(_) => (Type::Operation, LANGUAGE),
        Meaning::BuiltinFunction(_) => (Type::Function, LANGUAGE),
        Meaning::BuiltinAttribute(name) => {
            let row = Attr::from_name(name)?;
            let read_only = if row.writable { 0 } else { READ_ONLY };
            (Type::Attribute, LANGUAGE | read_only | if row.deprecated { DEPRECATED } else { 0 })
        }
        Meaning::Word(_) => (Type::Word, LANGUAGE),
        // A leaf is a rule that nobody wrote.
        Meaning::Leaf => (Type::Rule, 0),
        own => of_declared(file.declaration(own)?),
    })
}

fn of_declared(declared: &Declared) -> (Type, u32) {
    match declared.kind {
        Kind::Rule => (Type::Rule, 0),
        Kind::Attribute => (Type::Attribute, 0),
        Kind::Constant => (Type::Constant, READ_ONLY),
        Kind::Function => (Type::Function, 0),
        Kind::Parameter | Kind::Local => (Type::Parameter, 0),
        Kind::Import | Kind::Style => (Type::Import, 0),
    }
}

/// What the lexer knows: comments, texts, numbers, keywords, annotations, operators.
fn lexical(text: &str) -> Found {
    let tokens = lex(text, 0);
    let mut out: Found = tokens.comments.iter().map(|c| ((c.start, c.end), (Type::Comment, 0))).collect();
    for (index, place) in tokens.places.iter().enumerate() {
        let kind = match tokens.letter(index) {
            letter::STRING => Type::Text,
            letter::NUMBER => Type::Number,
            letter::VERSION | letter::IMPORT | letter::STYLE | letter::ATTR | letter::CONST | letter::WITH => {
                Type::Keyword
            }
            letter::CASE | letter::ELSE | letter::NIL | letter::BOOLEAN | letter::MODIFIER | letter::EXTENDS => {
                Type::Keyword
            }
            b'@' => continue,
            _ if index > 0 && tokens.letter(index - 1) == b'@' => {
                out.insert((place.start - 1, place.end), (Type::Annotation, 0));
                continue;
            }
            letter::ARROW | letter::DEFINE | letter::EQUAL | letter::NOT_EQUAL | letter::LESS_EQUAL => Type::Operator,
            letter::GREATER_EQUAL | letter::AND | letter::OR | letter::CONNECTED => Type::Operator,
            _ => continue,
        };
        out.insert((place.start, place.end), (kind, 0));
    }
    out
}

fn of_recipe(workspace: &mut Workspace, path: &Path, text: &str) -> Found {
    let mut out = Found::new();
    for token in recipe_context::tokens(text) {
        let kind = match token.kind {
            TokenKind::Comment => Type::Comment,
            TokenKind::Text => Type::Text,
            TokenKind::Number => Type::Number,
            TokenKind::Input => Type::Parameter,
            TokenKind::Word => match &text[token.start..token.end] {
                "version" | "use" | "input" => Type::Keyword,
                _ => continue,
            },
            TokenKind::Mark => continue,
        };
        out.insert((token.start as u32, token.end as u32), (kind, 0));
    }
    let file = workspace.recipe(path);
    let Some(part) = file.parts.first() else { return out };
    for word in part.words() {
        use recipe_file::Meaning as M;
        let declares = if word.declares { DECLARATION } else { 0 };
        let kind = match &word.meaning {
            M::Kind(_) => (Type::Keyword, 0),
            M::Block { kind, name } => {
                let known =
                    file.blocks().any(|b| b.kind.text == *kind && b.name.as_ref().is_some_and(|n| n.text == *name));
                if known { (Type::Rule, declares) } else { (Type::Word, LANGUAGE) }
            }
            M::Key { .. } => (Type::Attribute, LANGUAGE),
            M::Clause { .. } => (Type::Word, LANGUAGE),
            M::Input(_) => (Type::Parameter, declares),
            M::Start { .. } => (Type::Rule, 0),
            M::Attribute { .. } => (Type::Attribute, 0),
            M::File(_) => continue,
        };
        out.insert((word.span.start, word.span.end), kind);
    }
    out
}

/// Tokens relative to each other, each on one line. Counts on from the token before, so long lines cost no more.
fn encoded(lines: &Lines, encoding: Encoding, found: &Found) -> Vec<SemanticToken> {
    let mut out = Vec::new();
    let (mut line, mut before) = (0, 0);
    for ((start, end), (kind, modifiers)) in found {
        let mut at = *start;
        for piece in lines.text[*start as usize..*end as usize].split_inclusive('\n') {
            let length = encoding.length(piece.trim_end_matches(['\r', '\n']));
            let here = at;
            at += piece.len() as u32;
            if length == 0 || here < before {
                continue;
            }
            let own_line = lines.line(here);
            let from = if own_line == line { before } else { lines.start(own_line) };
            out.push(SemanticToken {
                delta_line: own_line - line,
                delta_start: encoding.length(&lines.text[from as usize..here as usize]),
                length,
                token_type: *kind as u32,
                token_modifiers_bitset: *modifiers,
            });
            (line, before) = (own_line, here);
        }
    }
    out
}
