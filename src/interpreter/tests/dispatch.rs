//! Every operation and function of the tables is evaluated: a row without an implementation would end the program.

use super::*;
use crate::cga::builtins::{Function, Operation, ParameterKind};
use crate::cga::program::Type;

/// Some argument that fits.
fn argument(kind: &ParameterKind) -> String {
    match (kind.words.first(), kind.values.first()) {
        (Some(word), _) => word.text().to_owned(),
        (None, Some(Type::Float)) => "1".to_owned(),
        (None, Some(Type::Bool)) => "true".to_owned(),
        (None, Some(Type::String)) => "\"a\"".to_owned(),
        (None, Some(Type::Floats)) => "[1]".to_owned(),
        (None, Some(Type::Bools)) => "[true]".to_owned(),
        (None, Some(Type::Strings)) => "[\"a\"]".to_owned(),
        (None, None) => unreachable!("a parameter takes something"),
    }
}

fn arguments(parameters: &[ParameterKind]) -> String {
    parameters.iter().map(argument).collect::<Vec<_>>().join(", ")
}

#[test]
fn every_function_is_evaluated() {
    for function in Function::ALL {
        for overload in function.overloads() {
            let rules = format!("Lot --> print({}({})) A.", function.name(), arguments(&overload.parameters));
            let tree = derived(&rules, ground(SMALL));
            let stopped = tree.diagnostics.iter().any(|d| d.code.starts_with("cga::limit"));
            assert!(stopped || !tree.prints.is_empty(), "{rules}: {:?}", tree.diagnostics);
        }
    }
}

#[test]
fn every_operation_without_a_block_is_evaluated() {
    for operation in Operation::ALL.iter().filter(|o| !o.takes_block() && **o != Operation::Set) {
        for overload in operation.overloads() {
            let rules = format!("Lot --> {}({}) A.", operation.name(), arguments(&overload.parameters));
            let tree = derived(&rules, ground(SMALL));
            assert!(tree.leaves.len() <= 1, "{rules}");
        }
    }
}

/// Unknown words in the place of an operation are shape symbols (reference 9, 2.11): a warning and a leaf.
#[test]
fn a_misspelt_operation_is_a_leaf() {
    let tree = derived("Lot --> extrud(3) Mass.", ground(SMALL));
    let leaves: Vec<(&str, usize)> = tree.leaves.iter().map(|l| (&*l.rule, l.mesh.faces.len())).collect();
    assert_eq!(leaves, [("extrud", 1), ("Mass", 1)]);
}
