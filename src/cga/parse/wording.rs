//! In: a rule of the grammar. Out: how a syntax error names it.

use super::Rule;

use crate::parsing::Expected;

/// What a reader calls this rule; [`Expected::Weak`] for what may almost always follow.
pub fn wording(kind: &Rule) -> Expected {
    let text = match kind {
        Rule::plain_name => return Expected::Weak("an operation or a rule name"),
        Rule::binary_operator => return Expected::Weak("an operator"),
        Rule::arguments | Rule::parameters | Rule::open_paren => return Expected::Weak("`(`"),
        Rule::open_bracket | Rule::index | Rule::group => return Expected::Weak("`[`"),
        Rule::percent => return Expected::Weak("`% :`"),
        Rule::name | Rule::style_name | Rule::rule_name | Rule::function_name | Rule::annotation_name => "a name",
        Rule::string => "a string in quotes",
        Rule::number
        | Rule::value
        | Rule::expression
        | Rule::argument
        | Rule::element_value
        | Rule::array_row
        | Rule::call
        | Rule::called_name
        | Rule::comp_word
        | Rule::parenthesised
        | Rule::array
        | Rule::boolean => "an expression",
        Rule::close_paren => "`)`",
        Rule::comma => "`,`",
        Rule::colon => "`:`",
        Rule::semicolon => "`;`",
        Rule::equals => "`=`",
        Rule::bar => "`|`",
        Rule::open_brace
        | Rule::split_block
        | Rule::selector_block
        | Rule::perimeter_block
        | Rule::boolean_operands
        | Rule::braced => "`{`",
        Rule::close_brace => "`}`",
        Rule::close_bracket => "`]`",
        Rule::arrow => "`-->`",
        Rule::define => "`:=`",
        Rule::case_word => "`case`",
        Rule::else_word => "`else`",
        Rule::version_word => "`version`",
        Rule::selector_operator => "`:`",
        Rule::selector | Rule::value_selector => "a selector",
        Rule::split_piece | Rule::perimeter_section => "a size",
        Rule::successor | Rule::sequence | Rule::plain_item => "an operation or a rule name",
        Rule::declaration | Rule::next_declaration | Rule::function | Rule::rule => "a declaration",
        _ => return Expected::Silent,
    };
    Expected::Strong(text)
}
