//! One request kind, one file. In: the workspace and the request's parameters. Out: its result, or a refusal that the
//! user reads.

pub mod code_action;
pub mod code_lens;
pub mod completion;
mod completion_recipe;
mod completion_rules;
pub mod definition;
pub mod document_highlight;
pub mod document_symbols;
pub mod execute_command;
pub mod folding_range;
pub mod formatting;
pub mod hover;
pub mod references;
pub mod rename;
pub mod selection_range;
pub mod semantic_tokens;
pub mod signature_help;
pub mod workspace_symbols;
