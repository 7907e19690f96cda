//! Attribute panel: what a rule file lets its user choose. In: the attributes of a program with their annotations. Out: a
//! tree of groups and fields, in the order in which they are shown, each with the widget that fits it.

use std::sync::Arc;

use crate::cga::program::{Annotations, Attribute, Constant, Expr, ExprKind, Program, Type, UnaryOperator};
use crate::interpreter::tree::Scalar;

/// What a field is edited with.
#[derive(Clone, Debug, PartialEq)]
pub enum Widget {
    /// Steps count from `min`; 0 is none.
    Slider {
        min: f64,
        max: f64,
        step: f64,
    },
    Number {
        min: Option<f64>,
        max: Option<f64>,
    },
    Checkbox,
    Choice(Vec<Scalar>),
    Colour,
    Text,
}

/// One attribute.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// As in the rule file, with import prefixes.
    pub name: Arc<str>,
    /// What people read.
    pub label: String,
    pub description: Option<Arc<str>>,
    pub widget: Widget,
    /// Of the widget's type; what it starts from.
    pub kind: Kind,
    /// The default, where the rule file writes a plain value.
    pub default: Option<Scalar>,
}

/// The type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Float,
    Bool,
    String,
}

/// What the panel shows, one below the other.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    Field(Field),
    Group { name: String, nodes: Vec<Node> },
}

/// What can be chosen of a program: neither constants, nor what is hidden, nor maps over edges.
pub fn panel(program: &Program) -> Vec<Node> {
    let shown = |a: &&Attribute| !a.is_const && !a.is_map && !a.annotations.hidden;
    let mut placed: Vec<(f64, &Attribute, Field)> = program
        .attributes()
        .iter()
        .filter(shown)
        .filter_map(|a| Some((a.annotations.order.unwrap_or(f64::INFINITY), a, field(a)?)))
        .collect();
    // Without an order: as the file has them.
    placed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut nodes = Vec::new();
    for (_, attribute, field) in placed {
        let prefix = attribute.name.rsplit_once('.').map(|(prefix, _)| prefix.to_owned());
        let groups = attribute.annotations.groups.iter().map(|group| group.to_string());
        insert(&mut nodes, prefix.into_iter().chain(groups), field);
    }
    own_fields_first(&mut nodes);
    nodes
}

fn insert(nodes: &mut Vec<Node>, mut groups: impl Iterator<Item = String>, field: Field) {
    let Some(group) = groups.next() else { return nodes.push(Node::Field(field)) };
    let found = nodes.iter().position(|node| matches!(node, Node::Group { name, .. } if *name == group));
    let at = found.unwrap_or_else(|| {
        nodes.push(Node::Group { name: group, nodes: Vec::new() });
        nodes.len() - 1
    });
    let Node::Group { nodes, .. } = &mut nodes[at] else { unreachable!("it was found or made as a group") };
    insert(nodes, &mut groups as &mut dyn Iterator<Item = String>, field);
}

/// Fields without a group stand before the groups.
fn own_fields_first(nodes: &mut [Node]) {
    nodes.sort_by_key(|node| matches!(node, Node::Group { .. }));
    for node in nodes {
        if let Node::Group { nodes, .. } = node {
            own_fields_first(nodes);
        }
    }
}

fn field(attribute: &Attribute) -> Option<Field> {
    let kind = match attribute.kind.or(attribute.default.value)? {
        Type::Float => Kind::Float,
        Type::Bool => Kind::Bool,
        Type::String => Kind::String,
        Type::Floats | Type::Bools | Type::Strings => return None,
    };
    let annotations = &attribute.annotations;
    let own_name = attribute.name.rsplit('.').next().expect("a name has a last part");
    let label = annotations.display_name.as_ref().map_or_else(|| words(own_name), |name| name.to_string());
    let description = annotations.description.clone();
    let default = literal(&attribute.default);
    let widget = widget(kind, annotations);
    Some(Field { name: attribute.name.clone(), label, description, widget, kind, default })
}

fn widget(kind: Kind, annotations: &Annotations) -> Widget {
    if let Some(choices) = &annotations.choices {
        let fits = |value: &Scalar| kind_of(value) == kind;
        let values: Vec<Scalar> = choices.values.iter().map(scalar).filter(fits).collect();
        if !values.is_empty() {
            return Widget::Choice(values);
        }
    }
    match kind {
        Kind::Bool => Widget::Checkbox,
        Kind::String if annotations.color => Widget::Colour,
        Kind::String => Widget::Text,
        Kind::Float => match &annotations.range {
            Some(range) => match (range.min, range.max) {
                (Some(min), Some(max)) => Widget::Slider { min, max, step: range.step },
                (min, max) => Widget::Number { min, max },
            },
            None => Widget::Number { min: None, max: None },
        },
    }
}

/// `windowHeight`, `Window_Height` → `window height`.
fn words(name: &str) -> String {
    let mut words = String::new();
    let mut before: Option<char> = None;
    for c in name.chars() {
        let starts = c.is_uppercase() && before.is_some_and(|b| b.is_lowercase() || b.is_numeric());
        if (starts || c == '_') && !words.is_empty() && !words.ends_with(' ') {
            words.push(' ');
        }
        if c != '_' {
            words.extend(if starts { c.to_lowercase().collect::<Vec<_>>() } else { vec![c] });
        }
        before = Some(c);
    }
    words
}

fn scalar(constant: &Constant) -> Scalar {
    match constant {
        Constant::Float(x) => Scalar::Float(*x),
        Constant::Bool(b) => Scalar::Bool(*b),
        Constant::String(s) => Scalar::String(s.clone()),
    }
}

pub fn kind_of(value: &Scalar) -> Kind {
    match value {
        Scalar::Float(_) => Kind::Float,
        Scalar::Bool(_) => Kind::Bool,
        Scalar::String(_) => Kind::String,
    }
}

/// A default that is a plain value.
fn literal(expression: &Expr) -> Option<Scalar> {
    match &expression.kind {
        ExprKind::Number(x) => Some(Scalar::Float(*x)),
        ExprKind::Bool(b) => Some(Scalar::Bool(*b)),
        ExprKind::String(s) => Some(Scalar::String(s.clone())),
        ExprKind::Unary(UnaryOperator::Minus, inner) => match literal(inner)? {
            Scalar::Float(x) => Some(Scalar::Float(-x)),
            Scalar::Bool(_) | Scalar::String(_) => None,
        },
        _ => None,
    }
}

impl Field {
    /// A value to begin with where the rule file has an expression.
    pub fn start(&self) -> Scalar {
        match (&self.default, &self.widget) {
            (Some(value), _) => value.clone(),
            (None, Widget::Slider { min, max, .. }) => Scalar::Float(snapped((min + max) / 2.0, &self.widget)),
            (None, Widget::Number { min, max }) => {
                let (least, most) = (min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY));
                Scalar::Float(0.0_f64.max(least).min(most))
            }
            (None, Widget::Checkbox) => Scalar::Bool(false),
            (None, Widget::Choice(values)) => values[0].clone(),
            (None, Widget::Colour) => Scalar::String("#808080".into()),
            (None, Widget::Text) => Scalar::String("".into()),
        }
    }
}

/// A number on the steps and within the limits of its widget.
pub fn snapped(value: f64, widget: &Widget) -> f64 {
    match widget {
        Widget::Slider { min, max, step } if *step > 0.0 => {
            let steps = ((value - min) / step).round().clamp(0.0, ((max - min) / step + 1e-9).floor());
            min + steps * step
        }
        Widget::Slider { min, max, .. } => value.clamp(*min, *max),
        Widget::Number { min, max } => value.max(min.unwrap_or(f64::NEG_INFINITY)).min(max.unwrap_or(f64::INFINITY)),
        Widget::Checkbox | Widget::Choice(_) | Widget::Colour | Widget::Text => value,
    }
}

/// `#rrggbb` as sRGB bytes.
pub fn color_of(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.is_ascii())?;
    let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).ok();
    Some([byte(0)?, byte(2)?, byte(4)?])
}

/// The other way.
pub fn color_text([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests;
