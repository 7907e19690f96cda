//! Attributes: a panel for every rule file, made of its annotations.

use egui::{RichText, Ui};

use super::Action;
use super::left::{mark, name_cell};
use crate::interpreter::tree::Scalar;
use crate::window::attributes::{Field, Node, Widget, color_of, color_text, snapped};
use crate::window::desk::Desk;
use crate::window::shown::RulePanel;
use crate::window::theme;

/// Pixels of the column of names.
const NAMES: f32 = 112.0;

pub fn show(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    let Some(shown) = desk.shown.clone() else { return };
    ui.horizontal(|ui| {
        theme::title(ui, "Attributes");
        if !desk.overrides.attributes.is_empty() {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Max), |ui| {
                if ui.small_button("Reset all").clicked() {
                    desk.overrides.attributes.clear();
                    actions.push(Action::Choose);
                }
            });
        }
    });
    // That of the selection first.
    let selected = desk.picked.as_ref().and_then(|picked| picked.lot.as_ref()?.rule_file.clone());
    let mut rules: Vec<&RulePanel> = shown.rules.iter().filter(|rule| !rule.nodes.is_empty()).collect();
    rules.sort_by_key(|rule| Some(&rule.file) != selected.as_ref());
    for (number, rule) in rules.into_iter().enumerate() {
        theme::card().show(ui, |ui| {
            ui.set_width(ui.available_width());
            let name = RichText::new(&rule.file).strong().color(theme::STRONG);
            // Another header for the selected file, so that it opens.
            let salt = (&rule.file, Some(&rule.file) == selected.as_ref());
            egui::CollapsingHeader::new(name).id_salt(salt).default_open(number == 0).show_unindented(ui, |ui| {
                nodes(ui, desk, rule, &rule.nodes, actions);
            });
        });
    }
}

fn nodes(ui: &mut Ui, desk: &mut Desk, rule: &RulePanel, list: &[Node], actions: &mut Vec<Action>) {
    for node in list {
        match node {
            Node::Field(field) => line(ui, desk, rule, field, actions),
            Node::Group { name, nodes: inner } => {
                egui::CollapsingHeader::new(RichText::new(name).color(theme::TEXT))
                    .id_salt((&rule.file, name))
                    .default_open(true)
                    .show(ui, |ui| nodes(ui, desk, rule, inner, actions));
            }
        }
    }
}

/// Mark, name, widget, reset.
fn line(ui: &mut Ui, desk: &mut Desk, rule: &RulePanel, field: &Field, actions: &mut Vec<Action>) {
    let own = desk.overridden(&rule.file, &field.name).cloned();
    ui.horizontal(|ui| {
        mark(ui, own.is_some());
        let indent = ui.cursor().left() - ui.max_rect().left();
        name_cell(ui, &field.label, NAMES - indent).on_hover_text(hint(rule, field));
        let reset = if own.is_some() { 28.0 } else { 0.0 };
        let start = own.clone().unwrap_or_else(|| field.start());
        let width = (ui.available_width() - reset).max(60.0);
        let changed = ui.push_id(&*field.name, |ui| widget(ui, field, &start, own.is_some(), width)).inner;
        if let Some(value) = changed {
            desk.set_attribute(&rule.file, &field.name, Some(value));
            actions.push(Action::Choose);
        }
        if own.is_some() && ui.small_button("×").on_hover_text("as the recipe and the rules have it").clicked() {
            desk.set_attribute(&rule.file, &field.name, None);
            actions.push(Action::Choose);
        }
    });
}

fn hint(rule: &RulePanel, field: &Field) -> String {
    let mut lines: Vec<String> = field.description.iter().map(|text| text.to_string()).collect();
    lines.push(format!("attr {}", field.name));
    match rule.assigned.iter().rev().find(|(name, _)| **name == *field.name) {
        Some((_, value)) => lines.push(format!("The recipe says: {value}")),
        None => lines.push(match &field.default {
            Some(value) => format!("The rules say: {}", text(value)),
            None => "The rules work it out for every feature.".to_owned(),
        }),
    }
    lines.join("\n")
}

fn text(value: &Scalar) -> String {
    match value {
        Scalar::Float(number) => number.to_string(),
        Scalar::Bool(flag) => flag.to_string(),
        Scalar::String(text) => text.to_string(),
    }
}

/// The value that the user gives now, if any. `own`: it is the user's already.
fn widget(ui: &mut Ui, field: &Field, start: &Scalar, own: bool, width: f32) -> Option<Scalar> {
    match (&field.widget, start) {
        (Widget::Slider { min, max, step }, Scalar::Float(start)) => {
            let mut value = *start;
            ui.spacing_mut().slider_width = (width - 62.0).max(40.0);
            // What the rules say is shown as it is, even off the steps or out of the range.
            let slider = egui::Slider::new(&mut value, *min..=*max).clamping(egui::SliderClamping::Edits);
            let known = own || field.default.is_some();
            let slider = slider.max_decimals(3).show_value(known).trailing_fill(known);
            let changed = ui.add(if *step > 0.0 { slider.step_by(*step) } else { slider }).changed();
            drawn_note(ui, field, own);
            changed.then(|| Scalar::Float(snapped(value, &field.widget)))
        }
        (Widget::Number { .. }, Scalar::Float(start)) => {
            let mut value = *start;
            let speed = (start.abs() * 0.01).max(0.02);
            let drag = egui::DragValue::new(&mut value).speed(speed).max_decimals(3);
            let changed = ui.add_sized([72.0, 20.0], drag).changed();
            drawn_note(ui, field, own);
            changed.then(|| Scalar::Float(snapped(value, &field.widget)))
        }
        (Widget::Checkbox, Scalar::Bool(start)) => {
            let mut value = *start;
            let changed = ui.checkbox(&mut value, "").changed();
            drawn_note(ui, field, own);
            changed.then_some(Scalar::Bool(value))
        }
        (Widget::Choice(values), start) => choice(ui, field, values, start, own, width),
        (Widget::Colour, Scalar::String(start)) => {
            let mut rgb = color_of(start).unwrap_or([128; 3]);
            let changed = ui.color_edit_button_srgb(&mut rgb).changed();
            if own || field.default.is_some() {
                ui.label(RichText::new(&**start).monospace());
            }
            drawn_note(ui, field, own);
            changed.then(|| Scalar::String(color_text(rgb).into()))
        }
        (Widget::Text, Scalar::String(start)) => {
            let mut value = start.to_string();
            let hint = if own || field.default.is_some() { "" } else { "by rule" };
            let edit = egui::TextEdit::singleline(&mut value).hint_text(hint).desired_width(width - 8.0);
            ui.add(edit).changed().then(|| Scalar::String(value.into()))
        }
        // A default of another type than its annotation: nothing to edit.
        _ => {
            ui.weak(text(start));
            None
        }
    }
}

/// Where the rules draw or work out a value, no number is shown as if it held.
fn drawn_note(ui: &mut Ui, field: &Field, own: bool) {
    if !own && field.default.is_none() {
        ui.weak("by rule");
    }
}

fn choice(ui: &mut Ui, field: &Field, values: &[Scalar], start: &Scalar, own: bool, width: f32) -> Option<Scalar> {
    let known = own || field.default.is_some();
    let mut chosen = start.clone();
    let selected = if known { text(start) } else { "by rule".to_owned() };
    let combo = egui::ComboBox::from_id_salt("choice").selected_text(selected).width(width - 8.0);
    let mut clicked = false;
    combo.show_ui(ui, |ui| {
        for value in values {
            clicked |= ui.selectable_value(&mut chosen, value.clone(), text(value)).clicked();
        }
    });
    clicked.then_some(chosen)
}
