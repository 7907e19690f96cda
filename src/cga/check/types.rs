//! The types known so far of everything that has a name, and the words messages use for them.

use crate::cga::program::{Constant, Type};

/// What is known about parameters and results; `None` where nothing is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Types {
    /// Parameters of each rule.
    pub rules: Vec<Vec<Option<Type>>>,
    /// Parameters and result of each function.
    pub functions: Vec<(Vec<Option<Type>>, Option<Type>)>,
    pub attributes: Vec<Option<Type>>,
}

/// How a message names a type.
pub fn type_name(kind: Type) -> &'static str {
    match kind {
        Type::Float => "a number",
        Type::Bool => "a bool",
        Type::String => "a string",
        Type::Floats => "an array of numbers",
        Type::Bools => "an array of bools",
        Type::Strings => "an array of strings",
    }
}

/// `a number or a string`.
pub fn type_names(kinds: &[Type]) -> String {
    match kinds {
        [] => "a keyword".to_owned(),
        [one] => type_name(*one).to_owned(),
        [rest @ .., last] => {
            let rest: Vec<&str> = rest.iter().map(|k| type_name(*k)).collect();
            format!("{} or {}", rest.join(", "), type_name(*last))
        }
    }
}

/// The array type with elements of this type; arrays stay.
pub fn array_of(kind: Type) -> Type {
    match kind {
        Type::Float | Type::Floats => Type::Floats,
        Type::Bool | Type::Bools => Type::Bools,
        Type::String | Type::Strings => Type::Strings,
    }
}

/// The type of an array's elements; scalars stay.
pub fn element_of(kind: Type) -> Type {
    match kind {
        Type::Float | Type::Floats => Type::Float,
        Type::Bool | Type::Bools => Type::Bool,
        Type::String | Type::Strings => Type::String,
    }
}

/// Whether a literal can be a value, or an element, of this type.
pub fn is_element_of(constant: &Constant, kind: Type) -> bool {
    match constant {
        Constant::Float(_) => element_of(kind) == Type::Float,
        Constant::Bool(_) => element_of(kind) == Type::Bool,
        Constant::String(_) => element_of(kind) == Type::String,
    }
}

pub fn is_array(kind: Type) -> bool {
    matches!(kind, Type::Floats | Type::Bools | Type::Strings)
}
