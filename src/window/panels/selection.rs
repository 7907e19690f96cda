//! Selection: what was clicked, from the map to the line of the rule that made it.

use egui::{RichText, Ui};

use super::Action;
use crate::live::{LeafInfo, LotInfo, thousands};
use crate::plan::demand::State;
use crate::window::attributes::color_of;
use crate::window::desk::{Desk, Picked};
use crate::window::theme;

pub fn show(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    theme::title(ui, "Selection");
    let Some(picked) = desk.picked.clone() else {
        theme::card().show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.weak("Click a building, a street or a field.");
        });
        return;
    };
    theme::card().show(ui, |ui| {
        ui.set_width(ui.available_width());
        match &picked.lot {
            Some(lot) => facts(ui, &picked, lot, actions),
            None => {
                ui.horizontal(|ui| {
                    ui.spinner();
                    ui.weak(format!("object {}", picked.instance));
                });
            }
        }
    });
}

fn facts(ui: &mut Ui, picked: &Picked, lot: &LotInfo, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let name = lot.feature.clone().unwrap_or_else(|| lot.class.to_owned());
        ui.label(RichText::new(name).size(15.0).strong().color(theme::STRONG));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.small_button("×").on_hover_text("Esc").clicked() {
                actions.push(Action::Deselect);
            }
            if lot.feature.is_some() && ui.small_button("Copy id").clicked() {
                actions.push(Action::Copy(lot.feature.clone().unwrap_or_default()));
            }
        });
    });
    if let Some(leaf) = &lot.leaf {
        source_line(ui, leaf, actions);
    }
    ui.add_space(2.0);
    egui::Grid::new("facts").num_columns(2).spacing([14.0, 4.0]).show(ui, |ui| {
        row(ui, "Class", lot.class);
        let state = if picked.state == State::Before { "before" } else { "after" };
        let change = match (&lot.change, &lot.level) {
            (Some(change), Some(level)) if level != change => format!("{change}, {level} ({state})"),
            (Some(change), _) => format!("{change} ({state})"),
            (None, _) => "none".to_owned(),
        };
        row(ui, "Change", &change);
        row(ui, "Rule file", lot.rule_file.as_deref().unwrap_or("none"));
        row(ui, "Leaves", &thousands(lot.leaves));
        row(ui, "Triangles", &thousands(lot.triangles));
        row(ui, "Derived in", &format!("{:.2} ms", lot.derivation_ms));
        if let Some(leaf) = lot.leaf.as_ref().filter(|leaf| !leaf.material.is_empty()) {
            row(ui, "Material", &leaf.material);
        }
    });
    if let Some(leaf) = &lot.leaf {
        rule_path(ui, leaf);
    }
    if !lot.attributes.is_empty() {
        values(ui, lot);
    }
}

fn row(ui: &mut Ui, name: &str, value: &str) {
    ui.weak(name);
    ui.add(egui::Label::new(value).truncate()).on_hover_text(value);
    ui.end_row();
}

/// `file:line:column`, to be copied.
fn source_line(ui: &mut Ui, leaf: &LeafInfo, actions: &mut Vec<Action>) {
    let place = format!("{}:{}:{}", leaf.file, leaf.line, leaf.column);
    let short = place.rsplit('/').next().unwrap_or(&place).to_owned();
    let text = RichText::new(short).monospace().color(theme::ACCENT);
    let link = ui.add(egui::Label::new(text).sense(egui::Sense::click()).truncate());
    let link = link.on_hover_cursor(egui::CursorIcon::PointingHand);
    if link.on_hover_text(format!("{place}\nmade this leaf; click copies the place")).clicked() {
        actions.push(Action::Copy(place));
    }
}

fn rule_path(ui: &mut Ui, leaf: &LeafInfo) {
    ui.add_space(4.0);
    ui.weak("Rules, from the start rule to this leaf");
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for (number, rule) in leaf.rules.iter().enumerate() {
            if number > 0 {
                ui.label(RichText::new("›").color(theme::WEAK));
            }
            let last = number + 1 == leaf.rules.len();
            let colour = if last { theme::ACCENT } else { theme::TEXT };
            ui.label(RichText::new(rule).monospace().color(colour));
        }
    });
}

fn values(ui: &mut Ui, lot: &LotInfo) {
    ui.add_space(4.0);
    let header = RichText::new(format!("Attributes ({})", lot.attributes.len()));
    egui::CollapsingHeader::new(header).id_salt("values").default_open(true).show(ui, |ui| {
        egui::ScrollArea::vertical().id_salt("values").max_height(170.0).auto_shrink([false, true]).show(ui, |ui| {
            egui::Grid::new("values").num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
                for (name, value) in &lot.attributes {
                    ui.weak(name);
                    ui.horizontal(|ui| {
                        if let Some([r, g, b]) = color_of(value) {
                            swatch(ui, egui::Color32::from_rgb(r, g, b));
                        }
                        ui.add(egui::Label::new(RichText::new(value).monospace()).truncate());
                    });
                    ui.end_row();
                }
            });
        });
    });
}

fn swatch(ui: &mut Ui, colour: egui::Color32) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), egui::Sense::hover());
    ui.painter().rect_filled(rect, 3.0, colour);
}
