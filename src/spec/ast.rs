//! The recipe as written: blocks of properties, with spans. Displays as canonical recipe text.

use std::fmt::{self, Display, Formatter, Write};

use crate::geodata::feature::ObjectKind;
use crate::source::Span;

/// One recipe file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpecAst {
    pub version: Option<Expr>,
    pub uses: Vec<Name>,
    pub inputs: Vec<InputDecl>,
    pub blocks: Vec<Block>,
}

/// A word or the inside of a quoted text.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    pub text: String,
    pub span: Span,
}

/// `input map : files = "a.osm"`.
#[derive(Clone, Debug, PartialEq)]
pub struct InputDecl {
    pub name: Name,
    pub kind: Name,
    /// Empty: the command line must give it.
    pub default: Vec<Expr>,
    pub span: Span,
}

/// `camera low : satellite { … }`.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    pub kind: Name,
    pub name: Option<Name>,
    pub parent: Option<Name>,
    pub properties: Vec<Property>,
    /// Kind, name and parent.
    pub span: Span,
}

/// `key values clause values … { body }`.
#[derive(Clone, Debug, PartialEq)]
pub struct Property {
    pub key: Name,
    pub values: Vec<Expr>,
    pub clauses: Vec<Clause>,
    pub body: Option<Vec<Assignment>>,
    pub span: Span,
}

/// A word inside a property that says what the values after it are, such as `for` in `rules "…" for building`.
#[derive(Clone, Debug, PartialEq)]
pub struct Clause {
    pub word: Name,
    pub values: Vec<Expr>,
}

/// `wallHeight = 6`.
#[derive(Clone, Debug, PartialEq)]
pub struct Assignment {
    pub name: Name,
    pub value: Expr,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    pub kind: ExprKind,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    Quantity {
        value: f64,
        unit: Option<String>,
    },
    Text(String),
    /// `2019-06-21`.
    Date(String),
    /// `18:30Z`.
    Clock(String),
    Word(String),
    /// `$map`.
    Argument(String),
    Object {
        kind: ObjectKind,
        id: i64,
    },
    Call {
        name: Name,
        arguments: Vec<CallArgument>,
    },
    Filter {
        class: Name,
        test: Test,
    },
    List(Vec<Expr>),
    Group(Vec<Expr>),
    /// `2km x 2km`.
    By(Box<Expr>, Box<Expr>),
    /// `4 * satellite`.
    Times(Box<Expr>, Box<Expr>),
    Or(Vec<Expr>),
    And(Vec<Expr>),
    Not(Box<Expr>),
}

/// `off_nadir = 0deg` or `30%: hipped` or just a value.
#[derive(Clone, Debug, PartialEq)]
pub struct CallArgument {
    pub name: Option<Name>,
    pub weight: Option<Expr>,
    pub value: Expr,
}

/// The inside of a tag filter.
#[derive(Clone, Debug, PartialEq)]
pub enum Test {
    Any(Vec<Test>),
    All(Vec<Test>),
    Not(Box<Test>),
    /// A value of the class's own tag.
    Kind(Name),
    /// `None` is `*`: any value.
    Compare {
        tag: Name,
        operator: String,
        value: Option<Box<Expr>>,
    },
}

impl Property {
    pub fn clause(&self, word: &str) -> Option<&Clause> {
        self.clauses.iter().find(|clause| clause.word.text == word)
    }
}

impl Display for Expr {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match &self.kind {
            ExprKind::Quantity { value, unit } => write!(f, "{value}{}", unit.as_deref().unwrap_or("")),
            ExprKind::Text(text) => write!(f, "\"{text}\""),
            ExprKind::Date(text) | ExprKind::Clock(text) | ExprKind::Word(text) => f.write_str(text),
            ExprKind::Argument(name) => write!(f, "${name}"),
            ExprKind::Object { kind, id } => write!(f, "{}/{id}", object_word(*kind)),
            ExprKind::Call { name, arguments } => write!(f, "{}({})", name.text, joined(arguments)),
            ExprKind::Filter { class, test } => write!(f, "{}[{test}]", class.text),
            ExprKind::List(values) => write!(f, "[{}]", joined(values)),
            ExprKind::Group(values) => write!(f, "({})", joined(values)),
            ExprKind::By(a, b) => write!(f, "{a} x {b}"),
            ExprKind::Times(a, b) => write!(f, "{a} * {b}"),
            ExprKind::Or(sets) => f.write_str(&chained(sets, " | ")),
            ExprKind::And(sets) => f.write_str(&chained(sets, " & ")),
            ExprKind::Not(a) => write!(f, "!{}", chained(std::slice::from_ref(a), "")),
        }
    }
}

/// The word before the slash in `way/123`.
pub fn object_word(kind: ObjectKind) -> &'static str {
    match kind {
        ObjectKind::Node => "node",
        ObjectKind::Way => "way",
        ObjectKind::Relation => "relation",
        ObjectKind::Feature => "feature",
    }
}

impl Display for CallArgument {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        if let Some(name) = &self.name {
            write!(f, "{} = ", name.text)?;
        }
        if let Some(weight) = &self.weight {
            write!(f, "{weight}: ")?;
        }
        self.value.fmt(f)
    }
}

impl Display for Test {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let list = |tests: &[Test], between: &str| tests.iter().map(grouped).collect::<Vec<_>>().join(between);
        match self {
            Test::Any(tests) => f.write_str(&list(tests, " | ")),
            Test::All(tests) => f.write_str(&list(tests, " & ")),
            Test::Not(test) => write!(f, "!{}", grouped(test)),
            Test::Kind(name) => write!(f, "\"{}\"", name.text),
            Test::Compare { tag, operator, value: Some(value) } => write!(f, "\"{}\" {operator} {value}", tag.text),
            Test::Compare { tag, operator, value: None } => write!(f, "\"{}\" {operator} *", tag.text),
        }
    }
}

fn grouped(test: &Test) -> String {
    match test {
        Test::Any(_) | Test::All(_) => format!("({test})"),
        Test::Not(_) | Test::Kind(_) | Test::Compare { .. } => test.to_string(),
    }
}

/// Operands with an operator between them, those that are chains themselves in brackets.
fn chained(operands: &[Expr], between: &str) -> String {
    let operand = |expr: &Expr| match expr.kind {
        ExprKind::Or(_) | ExprKind::And(_) => format!("({expr})"),
        _ => expr.to_string(),
    };
    operands.iter().map(operand).collect::<Vec<_>>().join(between)
}

fn joined<T: Display>(items: &[T]) -> String {
    items.iter().map(T::to_string).collect::<Vec<_>>().join(", ")
}

impl Display for Property {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(&self.key.text)?;
        if !self.values.is_empty() {
            write!(f, " {}", joined(&self.values))?;
        }
        for clause in &self.clauses {
            write!(f, " {} {}", clause.word.text, joined(&clause.values))?;
        }
        if let Some(body) = &self.body {
            let body: Vec<String> = body.iter().map(|a| format!("\"{}\" = {}", a.name.text, a.value)).collect();
            write!(f, " {{ {} }}", body.join(", "))?;
        }
        Ok(())
    }
}

impl Display for SpecAst {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        if let Some(version) = &self.version {
            writeln!(f, "version {version}")?;
        }
        for file in &self.uses {
            writeln!(f, "use \"{}\"", file.text)?;
        }
        for input in &self.inputs {
            let default =
                if input.default.is_empty() { String::new() } else { format!(" = {}", joined(&input.default)) };
            writeln!(f, "input {} : {}{default}", input.name.text, input.kind.text)?;
        }
        for block in &self.blocks {
            let mut head = block.kind.text.clone();
            if let Some(name) = &block.name {
                write!(head, " {}", name.text)?;
            }
            if let Some(parent) = &block.parent {
                write!(head, " : {}", parent.text)?;
            }
            writeln!(f, "{head} {{")?;
            for property in &block.properties {
                writeln!(f, "  {property}")?;
            }
            writeln!(f, "}}")?;
        }
        Ok(())
    }
}
