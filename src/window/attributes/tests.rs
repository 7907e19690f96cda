//! Every annotation gives the widget and the place that it asks for.

use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::cga::{CompileOptions, compile_text};
use crate::source::SourceMap;

fn of(text: &str) -> Vec<Node> {
    let (program, diagnostics) = compile_text("test.cga", text, &mut SourceMap::default(), &CompileOptions::default());
    panel(&program.unwrap_or_else(|| panic!("{diagnostics:?}")))
}

fn fields(nodes: &[Node]) -> Vec<Field> {
    let of_node = |node: &Node| match node {
        Node::Field(field) => vec![field.clone()],
        Node::Group { nodes, .. } => fields(nodes),
    };
    nodes.iter().flat_map(of_node).collect()
}

fn only(text: &str) -> Field {
    let all = fields(&of(text));
    assert_eq!(all.len(), 1, "{all:?}");
    all.into_iter().next().expect("there is one")
}

fn text(value: &str) -> Scalar {
    Scalar::String(Arc::from(value))
}

#[test]
fn ranges_are_sliders_with_their_step() {
    let field = only("@Range(min=2, max=8, stepsize=0.5)\nattr height = 3\nLot --> NIL");
    assert_eq!(field.widget, Widget::Slider { min: 2.0, max: 8.0, step: 0.5 });
    assert_eq!((field.kind, field.default), (Kind::Float, Some(Scalar::Float(3.0))));
    let half_open = only("@Range(min=2)\nattr height = -3\nLot --> NIL");
    assert_eq!(half_open.widget, Widget::Number { min: Some(2.0), max: None });
    assert_eq!(half_open.default, Some(Scalar::Float(-3.0)));
}

#[test]
fn lists_of_values_are_choices() {
    let field = only("@Enum(\"flat\", \"gabled\")\nattr roof = \"flat\"\nLot --> NIL");
    assert_eq!(field.widget, Widget::Choice(vec![text("flat"), text("gabled")]));
    let numbers = only("@Enum(1, 2, 4)\nattr lanes = 2\nLot --> NIL");
    let values = [1.0, 2.0, 4.0].map(Scalar::Float).to_vec();
    assert_eq!(numbers.widget, Widget::Choice(values));
}

#[test]
fn colours_flags_and_texts() {
    assert_eq!(only("@Color\nattr wall = \"#ff8000\"\nLot --> NIL").widget, Widget::Colour);
    assert_eq!(only("attr lit = true\nLot --> NIL").widget, Widget::Checkbox);
    assert_eq!(only("attr name = \"x\"\nLot --> NIL").widget, Widget::Text);
    assert_eq!(only("attr height = 2\nLot --> NIL").widget, Widget::Number { min: None, max: None });
}

#[test]
fn groups_nest_and_orders_sort() {
    let nodes = of("attr loose = 1\n\
                    @Group(\"Facade\", \"Windows\") @Order(2)\nattr width = 1\n\
                    @Group(\"Facade\", \"Windows\") @Order(1)\nattr depth = 1\n\
                    @Group(\"Facade\")\nattr wall = 1\n\
                    Lot --> NIL");
    let label = |node: &Node| match node {
        Node::Field(field) => field.label.clone(),
        Node::Group { name, .. } => format!("[{name}]"),
    };
    assert_eq!(nodes.iter().map(label).collect::<Vec<_>>(), ["loose", "[Facade]"]);
    let Node::Group { nodes: facade, .. } = &nodes[1] else { panic!("a group") };
    assert_eq!(facade.iter().map(label).collect::<Vec<_>>(), ["wall", "[Windows]"]);
    let Node::Group { nodes: windows, .. } = &facade[1] else { panic!("a group") };
    assert_eq!(windows.iter().map(label).collect::<Vec<_>>(), ["depth", "width"]);
}

#[test]
fn what_is_hidden_or_constant_is_not_there() {
    assert_eq!(of("@Hidden\nattr secret = 1\nconst fixed = 2\nLot --> NIL"), []);
}

#[test]
fn names_descriptions_and_drawn_defaults() {
    let field = only("@Description(\"Of one floor.\")\nattr floorHeight = 50% : 3 else : 4\nLot --> NIL");
    assert_eq!(field.label, "floor height");
    assert_eq!(field.description.as_deref(), Some("Of one floor."));
    assert_eq!(field.default, None, "it is drawn");
    assert_eq!(field.start(), Scalar::Float(0.0));
    assert_eq!(words("Building_OSM_Height2Top"), "Building OSM Height2 top");
    assert_eq!(only("@DisplayName(\"Storeys\")\nattr n = 2\nLot --> NIL").label, "Storeys");
}

proptest! {
    #[test]
    fn snapped_numbers_lie_on_steps_within_the_range(
        min in -50.0..50.0, steps in 1u32..40, step in 0.01..5.0, value in -500.0..500.0,
    ) {
        let max = min + f64::from(steps) * step + step * 0.4;
        let widget = Widget::Slider { min, max, step };
        let snapped = snapped(value, &widget);
        prop_assert!(snapped >= min && snapped <= max, "{snapped} is not within {min}..{max}");
        let number = (snapped - min) / step;
        prop_assert!((number - number.round()).abs() < 1e-6, "{snapped} is not on a step");
        if value > min && value < max - step {
            prop_assert!((snapped - value).abs() <= step / 2.0 + 1e-9);
        }
    }

    #[test]
    fn colours_come_back(r in 0u8.., g in 0u8.., b in 0u8..) {
        prop_assert_eq!(color_of(&color_text([r, g, b])), Some([r, g, b]));
    }
}

#[test]
fn what_is_no_colour_is_none() {
    for text in ["", "red", "#12345", "#12345g", "#1234567", "#äöü"] {
        assert_eq!(color_of(text), None, "{text}");
    }
}
