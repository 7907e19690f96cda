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

/// A rule file cannot be read.
pub const UNREADABLE_FILE: &str = "cga::unreadable-file";
/// An import leads outside the allowed folders.
pub const IMPORT_OUTSIDE: &str = "cga::import-outside";
/// Files import each other in a ring.
pub const IMPORT_CYCLE: &str = "cga::import-cycle";
/// The import tree has more instances than the stated limit.
pub const TOO_MANY_IMPORTS: &str = "cga::too-many-imports";
/// An import overrides or protects something the imported file does not have, or does it twice.
pub const BAD_OVERRIDE: &str = "cga::bad-override";

/// One name is defined twice with the same parameters in one style.
pub const DUPLICATE_DEFINITION: &str = "cga::duplicate-definition";
/// Two parameters or locals of one definition share a name.
pub const DUPLICATE_PARAMETER: &str = "cga::duplicate-parameter";
/// A declaration stands where its kind is not allowed, such as `start` in a style.
pub const MISPLACED_DECLARATION: &str = "cga::misplaced-declaration";
/// The chosen style, or the base of a style, does not exist.
pub const UNKNOWN_STYLE: &str = "cga::unknown-style";
/// A style makes something of another kind or type out of a definition of its base.
pub const STYLE_MISMATCH: &str = "cga::style-mismatch";
/// An annotation stands in front of something it has no meaning for.
pub const MISPLACED_ANNOTATION: &str = "cga::misplaced-annotation";
/// An annotation the language does not know.
pub const UNKNOWN_ANNOTATION: &str = "cga::unknown-annotation";
/// An annotation has arguments it cannot take.
pub const ANNOTATION_ARGUMENT: &str = "cga::annotation-argument";
/// Attributes need each other's values.
pub const ATTRIBUTE_CYCLE: &str = "cga::attribute-cycle";

/// A name in an expression that is no parameter, attribute or function.
pub const UNKNOWN_NAME: &str = "cga::unknown-name";
/// Probably a misspelt operation.
pub const UNKNOWN_OPERATION: &str = "cga::unknown-operation";
/// A shape symbol without a rule and without the terminal dot: it becomes a leaf.
pub const UNDEFINED_RULE: &str = "cga::undefined-rule";
/// A word in selector position that is neither selector nor expression.
pub const UNKNOWN_SELECTOR: &str = "cga::unknown-selector";
/// A word that is not among those an argument takes.
pub const UNKNOWN_KEYWORD: &str = "cga::unknown-keyword";
/// `set` on a name that is no attribute.
pub const UNKNOWN_ATTRIBUTE: &str = "cga::unknown-attribute";
/// `set` on a constant or a read-only attribute.
pub const READ_ONLY: &str = "cga::read-only";
/// A call with a number of arguments that no overload takes.
pub const ARGUMENT_COUNT: &str = "cga::argument-count";
/// A value has another type than its place takes.
pub const TYPE_MISMATCH: &str = "cga::type-mismatch";
/// `'` or `~` where it has no meaning.
pub const MISPLACED_PREFIX: &str = "cga::misplaced-prefix";
/// An operation that needs a block stands without one.
pub const MISSING_BLOCK: &str = "cga::missing-block";
/// A split block without a size, as before version 2015.
pub const MISSING_SIZE: &str = "cga::missing-size";
/// Percentages add up to more than 100.
pub const WEIGHTS_OVER_100: &str = "cga::weights-over-100";
/// A name of an older version that has a new one.
pub const DEPRECATED: &str = "cga::deprecated";
/// Known CGA, but not evaluated by this version.
pub const NOT_SUPPORTED_YET: &str = "cga::not-supported-yet";

/// A branch, or a selector, that is never taken.
pub const UNREACHABLE: &str = "cga::unreachable";
/// A rule or function that calls itself in every case.
pub const ENDLESS_RECURSION: &str = "cga::endless-recursion";
/// A rule of the main file that no start rule leads to.
pub const UNUSED_RULE: &str = "cga::unused-rule";
/// A part of a split that is never made.
pub const NEVER_FITS: &str = "cga::never-fits";
/// A terminal dot behind a name that has a rule.
pub const NEEDLESS_DOT: &str = "cga::needless-dot";
/// A construct that meant something else in the version the file was written for.
pub const CHANGED_MEANING: &str = "cga::changed-meaning";
/// An operation that the language no longer has.
pub const REMOVED: &str = "cga::removed";
