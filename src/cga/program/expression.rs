//! In: resolved names. Out: the expression tree the interpreter evaluates.

use std::sync::Arc;

use super::{AttributeId, DrawSite, FunctionId};
use crate::cga::builtins::{Attr, Function as Builtin, Word};
use crate::source::Span;

/// The value types of the language (reference 1.6). Arrays are rows x columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Type {
    Float,
    Bool,
    String,
    Floats,
    Bools,
    Strings,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    pub kind: ExprKind,
    /// `None` where only the run can tell.
    pub value: Option<Type>,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    Number(f64),
    Bool(bool),
    String(Arc<str>),
    /// Rows of elements; an element may be a [`ExprKind::Range`] or itself an array (concatenated).
    Array(Vec<Vec<Expr>>),
    /// `from : step : to`, only as an element of an array or an index. Step 1 where absent.
    Range {
        from: Box<Expr>,
        step: Option<Box<Expr>>,
        to: Box<Expr>,
    },
    /// A parameter or local of the rule, function or attribute being evaluated.
    Slot(u32),
    Attribute(AttributeId),
    /// A user function, evaluated on the current shape.
    Call {
        function: FunctionId,
        args: Vec<Expr>,
    },
    /// A built-in attribute such as `scope.sx`.
    BuiltinAttribute(Attr),
    /// A built-in function. `site` is set where the function draws random numbers ([`Builtin::draws`]).
    Builtin {
        function: Builtin,
        args: Vec<Arg>,
        site: Option<DrawSite>,
    },
    Unary(UnaryOperator, Box<Expr>),
    Binary(BinaryOperator, Box<Expr>, Box<Expr>),
    Case {
        branches: Vec<(Expr, Expr)>,
        otherwise: Box<Expr>,
    },
    /// Weights in percent.
    Stochastic {
        branches: Vec<(Expr, Expr)>,
        otherwise: Box<Expr>,
        site: DrawSite,
    },
    /// `array[row]` (linear) or `array[row, column]`.
    Index {
        array: Box<Expr>,
        row: Box<Expr>,
        column: Option<Box<Expr>>,
    },
    /// The comp function: one value per component.
    Comp {
        component: Component,
        keep_axes: bool,
        selectors: Vec<ExprSelector>,
    },
    /// In a selector only: true if the current component matches the word.
    Selector(Word),
}

/// `selector op value` of a comp function.
#[derive(Clone, Debug, PartialEq)]
pub struct ExprSelector {
    /// See [`super::Selector::test`].
    pub test: Expr,
    pub operator: SelectorOperator,
    pub text: Arc<str>,
    pub value: Expr,
}

/// `:` one shape per element, `=` one for all, `=:` one per connected part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelectorOperator {
    Each,
    All,
    Connected,
}

/// What `comp` takes apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    Faces,
    Edges,
    FaceEdges,
    Vertices,
    FaceVertices,
    Groups,
    Materials,
    Holes,
}

/// How a number in an argument or size is to be read (reference 1.8).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prefix {
    Absolute,
    /// `'`: times the scope size (or what the operation says).
    Relative,
    /// `~`: floating.
    Floating,
}

/// An argument of a built-in operation or function.
#[derive(Clone, Debug, PartialEq)]
pub enum Arg {
    Value(Prefix, Expr),
    /// A keyword such as `world.up`; one of those the overload allows.
    Word(Word, Span),
    /// `sel(text)`: a keyword computed at run time; the interpreter checks it with [`Word::from_text`].
    ComputedWord(Expr),
}

macro_rules! operators {
    ($(#[$doc:meta])* $name:ident { $($variant:ident $text:literal)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name { $($variant),* }

        impl $name {
            pub const ALL: &'static [$name] = &[$($name::$variant),*];

            /// As written in a rule file.
            pub fn text(self) -> &'static str {
                match self { $($name::$variant => $text),* }
            }
        }
    };
}

operators! {
    /// Operators before an operand; `Element...` ones work on every element of an array.
    UnaryOperator {
        Not "!" Plus "+" Minus "-" ElementNot ".!" ElementPlus ".+" ElementMinus ".-"
    }
}

operators! {
    /// Operators between two operands; `Element...` ones pair the elements of arrays (reference 1.8).
    BinaryOperator {
        Multiply "*" Divide "/" Remainder "%" Add "+" Subtract "-"
        Less "<" LessEqual "<=" Greater ">" GreaterEqual ">=" Equal "==" NotEqual "!=" And "&&" Or "||"
        ElementMultiply ".*" ElementDivide "./" ElementRemainder ".%" ElementAdd ".+" ElementSubtract ".-"
        ElementLess ".<" ElementLessEqual ".<=" ElementGreater ".>" ElementGreaterEqual ".>="
        ElementEqual ".==" ElementNotEqual ".!=" ElementAnd ".&&" ElementOr ".||"
    }
}
