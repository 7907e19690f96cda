//! Every diagnostic code of the rule language, stable across versions; `docs/diagnostics.md` has a page for each.

macro_rules! codes {
    ($($(#[$doc:meta])* $name:ident $code:literal)*) => {
        $($(#[$doc])* pub const $name: &str = $code;)*

        /// Codes of the parser and the checker.
        const CHECKED: &[&str] = &[$($code),*];
    };
}

codes! {
    /// The text does not follow the grammar.
    SYNTAX "cga::syntax"
    /// Expressions or blocks are nested deeper than the stated limit.
    TOO_DEEP "cga::too-deep"
    /// A backslash in a string stands before a letter that is no escape.
    UNKNOWN_ESCAPE "cga::unknown-escape"
    /// `version` stands twice, or after a declaration.
    MISPLACED_VERSION "cga::misplaced-version"
    /// The file is not Unicode and was read as Windows-1252.
    ENCODING "cga::encoding"
    /// A rule file cannot be read.
    UNREADABLE_FILE "cga::unreadable-file"
    /// An import leads outside the allowed folders.
    IMPORT_OUTSIDE "cga::import-outside"
    /// Files import each other in a ring.
    IMPORT_CYCLE "cga::import-cycle"
    /// The import tree has more instances than the stated limit.
    TOO_MANY_IMPORTS "cga::too-many-imports"
    /// An import overrides or protects something the imported file does not have, or does it twice.
    BAD_OVERRIDE "cga::bad-override"
    /// One name is defined twice with the same parameters in one style.
    DUPLICATE_DEFINITION "cga::duplicate-definition"
    /// Two parameters or locals of one definition share a name.
    DUPLICATE_PARAMETER "cga::duplicate-parameter"
    /// A declaration stands where its kind is not allowed, such as `start` in a style.
    MISPLACED_DECLARATION "cga::misplaced-declaration"
    /// The chosen style, or the base of a style, does not exist.
    UNKNOWN_STYLE "cga::unknown-style"
    /// A style makes something of another kind or type out of a definition of its base.
    STYLE_MISMATCH "cga::style-mismatch"
    /// An annotation stands in front of something it has no meaning for.
    MISPLACED_ANNOTATION "cga::misplaced-annotation"
    /// An annotation the language does not know.
    UNKNOWN_ANNOTATION "cga::unknown-annotation"
    /// An annotation has arguments it cannot take.
    ANNOTATION_ARGUMENT "cga::annotation-argument"
    /// Attributes need each other's values.
    ATTRIBUTE_CYCLE "cga::attribute-cycle"
    /// A name in an expression that is no parameter, attribute or function.
    UNKNOWN_NAME "cga::unknown-name"
    /// Probably a misspelt operation.
    UNKNOWN_OPERATION "cga::unknown-operation"
    /// A shape symbol without a rule and without the terminal dot: it becomes a leaf.
    UNDEFINED_RULE "cga::undefined-rule"
    /// A word in selector position that is neither selector nor expression.
    UNKNOWN_SELECTOR "cga::unknown-selector"
    /// A word that is not among those an argument takes.
    UNKNOWN_KEYWORD "cga::unknown-keyword"
    /// `set` on a name that is no attribute.
    UNKNOWN_ATTRIBUTE "cga::unknown-attribute"
    /// `set` on a constant or a read-only attribute.
    READ_ONLY "cga::read-only"
    /// A call with a number of arguments that no overload takes.
    ARGUMENT_COUNT "cga::argument-count"
    /// A value has another type than its place takes.
    TYPE_MISMATCH "cga::type-mismatch"
    /// `'` or `~` where it has no meaning.
    MISPLACED_PREFIX "cga::misplaced-prefix"
    /// An operation that needs a block stands without one.
    MISSING_BLOCK "cga::missing-block"
    /// A split block without a size, as before version 2015.
    MISSING_SIZE "cga::missing-size"
    /// Percentages add up to more than 100.
    WEIGHTS_OVER_100 "cga::weights-over-100"
    /// A name of an older version that has a new one.
    DEPRECATED "cga::deprecated"
    /// A branch, or a selector, that is never taken.
    UNREACHABLE "cga::unreachable"
    /// A rule or function that calls itself in every case.
    ENDLESS_RECURSION "cga::endless-recursion"
    /// A rule of the main file that no start rule leads to.
    UNUSED_RULE "cga::unused-rule"
    /// A part of a split that is never made.
    NEVER_FITS "cga::never-fits"
    /// A terminal dot behind a name that has a rule.
    NEEDLESS_DOT "cga::needless-dot"
    /// An operation behind the last shape.
    NO_EFFECT "cga::no-effect"
    /// A construct that meant something else in the version the file was written for.
    CHANGED_MEANING "cga::changed-meaning"
    /// An operation that the language no longer has.
    REMOVED "cga::removed"
}

/// Codes that only a derivation raises, where they are written.
const RAISED_BY_RUNS: &[&str] = &[
    "cga::no-start-rule",
    "cga::start-shape",
    "cga::doubled-vertex",
    "cga::value-not-allowed",
    "cga::not-finite",
    "cga::wrong-type",
    "cga::array-dimensions",
    "cga::limit-depth",
    "cga::limit-shapes",
    "cga::limit-vertices",
    "cga::limit-calls",
    "cga::limit-text",
    "cga::limit-array",
    "cga::bad-color",
    "cga::missing-texture",
    "cga::missing-asset",
    "cga::asset-part",
    "cga::missing-file",
    "cga::file-query",
    "cga::file-axes",
    "cga::uv-set",
    "cga::tile-size",
    "cga::no-projection",
    "cga::no-uv",
    "cga::split-flat",
    "cga::split-size",
    "cga::split-area",
    "cga::no-extent",
    "cga::no-face",
    "cga::taper-holes",
    "cga::footprint",
    "cga::roof",
    "cga::roof-index",
    "cga::roof-overlap",
    "cga::roof-holes",
    "cga::roof-fallback",
    "cga::roof-shape",
    "cga::offset",
    "cga::setback",
    "cga::inner-rectangle",
    "cga::material-pairs",
    "cga::scatter-count",
    "cga::scatter-empty",
    "cga::scatter-open",
    "cga::tag-name",
    "cga::too-many-parts",
    "cga::normal-angle",
    "cga::no-place",
    "cga::boolean",
    "cga::convexify",
    "cga::empty-label",
    "cga::envelope",
    "cga::rectify",
    "cga::reduce",
    "cga::setback-area",
    "cga::regular-expression",
];

/// All codes, those of the checker first.
pub static ALL: std::sync::LazyLock<Vec<&str>> = std::sync::LazyLock::new(|| [CHECKED, RAISED_BY_RUNS].concat());
