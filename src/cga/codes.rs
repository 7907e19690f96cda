//! Every diagnostic code of the rule language, stable across versions.

/// The text does not follow the grammar.
pub const SYNTAX: &str = "cga::syntax";
/// Expressions or blocks are nested deeper than the stated limit.
pub const TOO_DEEP: &str = "cga::too-deep";
/// A backslash in a string stands before a letter that is no escape.
pub const UNKNOWN_ESCAPE: &str = "cga::unknown-escape";
/// `version` stands twice, or after a declaration.
pub const MISPLACED_VERSION: &str = "cga::misplaced-version";
/// The file is not Unicode and was read as Windows-1252.
pub const ENCODING: &str = "cga::encoding";
