//! In: the text of an overload, such as `"{yUp zUp} F F? -> S"`. Out: its parameters and result.

use std::sync::LazyLock;

use super::{Function, Operation, Word};
use crate::cga::program::Type;

/// What one parameter takes.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterKind {
    /// Types of value taken; empty where only a word fits.
    pub values: Vec<Type>,
    /// Words taken; empty where only a value fits.
    pub words: Vec<Word>,
    /// `'` may stand before the value.
    pub relative: bool,
    /// `~` may stand before the value.
    pub floating: bool,
    pub optional: bool,
}

/// One overload of an operation or function.
#[derive(Clone, Debug, PartialEq)]
pub struct Signature {
    pub parameters: Vec<ParameterKind>,
    /// `None` for operations.
    pub result: Option<Type>,
}

const EVERY: [Type; 6] = [Type::Float, Type::Bool, Type::String, Type::Floats, Type::Bools, Type::Strings];

/// The orientation selectors that `geometry.area` and `geometry.isOriented` take (reference 3.5, 3.7).
const ORIENTATION: &[Word] = &[
    Word::Front,
    Word::Back,
    Word::Right,
    Word::Left,
    Word::Top,
    Word::Bottom,
    Word::Side,
    Word::ObjectFront,
    Word::ObjectBack,
    Word::ObjectRight,
    Word::ObjectLeft,
    Word::ObjectTop,
    Word::ObjectBottom,
    Word::ObjectSide,
    Word::WorldSouth,
    Word::WorldNorth,
    Word::WorldEast,
    Word::WorldWest,
    Word::WorldUp,
    Word::WorldDown,
    Word::WorldSide,
    Word::Vertical,
    Word::Aslant,
    Word::Nutant,
    Word::Horizontal,
    Word::All,
    Word::StreetFront,
    Word::StreetBack,
    Word::StreetLeft,
    Word::StreetRight,
    Word::StreetSide,
];

impl Signature {
    /// Reads a signature of the tables; they are our own text, so a malformed one is our bug.
    pub fn parse(text: &str) -> Signature {
        let (parameters, result) = match text.split_once("->") {
            Some((parameters, result)) => (parameters, value_type(result.trim())),
            None => (text, None),
        };
        Signature { parameters: split_parameters(parameters).map(ParameterKind::parse).collect(), result }
    }

    /// Fewest and most arguments.
    pub fn arity(&self) -> (usize, usize) {
        let least = self.parameters.iter().filter(|p| !p.optional).count();
        (least, self.parameters.len())
    }
}

/// Every row's signatures, read once.
static OPERATIONS: LazyLock<Vec<Vec<Signature>>> =
    LazyLock::new(|| Operation::ALL.iter().map(|o| parse_all(o.signatures())).collect());
static FUNCTIONS: LazyLock<Vec<Vec<Signature>>> =
    LazyLock::new(|| Function::ALL.iter().map(|f| parse_all(f.signatures())).collect());

fn parse_all(texts: &[&str]) -> Vec<Signature> {
    texts.iter().map(|text| Signature::parse(text)).collect()
}

impl Operation {
    /// [`Operation::signatures`], read.
    pub fn overloads(self) -> &'static [Signature] {
        &OPERATIONS[self as usize]
    }
}

impl Function {
    /// [`Function::signatures`], read.
    pub fn overloads(self) -> &'static [Signature] {
        &FUNCTIONS[self as usize]
    }
}

impl ParameterKind {
    fn parse(text: &str) -> ParameterKind {
        let (text, optional) = match text.strip_suffix('?') {
            Some(rest) => (rest, true),
            None => (text, false),
        };
        let (value, words) = match text.split_once('{') {
            Some((value, words)) => (value, words.strip_suffix('}').expect("braces of a signature are closed")),
            None => (text, ""),
        };
        let floating = value.ends_with('~');
        let relative = floating || value.ends_with('\'');
        let mut out = ParameterKind { values: Vec::new(), words: Vec::new(), relative, floating, optional };
        out.values = match value.trim_end_matches(['~', '\'']) {
            "" => Vec::new(),
            "X" => EVERY.to_vec(),
            "A" => EVERY[3..].to_vec(),
            name => vec![value_type(name).expect("signatures name known types")],
        };
        for word in words.split_whitespace() {
            match word {
                "@orientation" => out.words.extend(ORIENTATION),
                word => out.words.push(Word::from_text(word).expect("signatures name known words")),
            }
        }
        out
    }
}

/// Splits at spaces outside braces.
pub(super) fn split_parameters(text: &str) -> impl Iterator<Item = &str> {
    let mut depth = 0;
    text.split(move |c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        depth == 0 && c.is_whitespace()
    })
    .filter(|part| !part.is_empty())
}

fn value_type(name: &str) -> Option<Type> {
    Some(match name {
        "F" => Type::Float,
        "B" => Type::Bool,
        "S" => Type::String,
        "F[]" => Type::Floats,
        "B[]" => Type::Bools,
        "S[]" => Type::Strings,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::{Function, Operation, Signature, Type, Word};
    use crate::cga::builtins::Attr;

    #[test]
    fn every_signature_of_the_tables_parses() {
        for operation in Operation::ALL {
            assert_eq!(operation.overloads().len(), operation.signatures().len());
            assert!(operation.overloads().iter().all(|s| s.result.is_none()), "{}", operation.name());
        }
        for function in Function::ALL {
            assert_eq!(function.overloads().len(), function.signatures().len());
            assert!(function.overloads().iter().all(|s| s.result.is_some()), "{}", function.name());
        }
    }

    #[test]
    fn reads_types_words_prefixes_and_options() {
        let signature = Signature::parse("{yUp zUp} F{any} F~ S[]? -> B");
        assert_eq!(signature.arity(), (3, 4));
        assert_eq!(signature.result, Some(Type::Bool));
        assert_eq!(signature.parameters[0].words, [Word::YUp, Word::ZUp]);
        assert_eq!(
            (&signature.parameters[1].values[..], &signature.parameters[1].words[..]),
            (&[Type::Float][..], &[Word::Any][..])
        );
        assert!(signature.parameters[2].floating && signature.parameters[2].relative);
        assert_eq!(signature.parameters[3].values, [Type::Strings]);
    }

    #[test]
    fn names_lead_back_to_their_rows() {
        assert!(Word::ALL.iter().all(|&w| Word::from_text(w.text()) == Some(w)));
        assert!(Operation::ALL.iter().all(|&o| Operation::from_name(o.name()) == Some(o)));
        assert!(Function::ALL.iter().all(|&f| Function::from_name(f.name()) == Some(f)));
        assert!(Attr::table().all(|row| row.deprecated || row.attr.info().name == row.name));
    }
}
