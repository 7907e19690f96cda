//! Diagnostics: mistakes and warnings with their places; a click copies the place.

use egui::{RichText, Ui};

use super::Action;
use crate::live::Message;
use crate::window::desk::Desk;
use crate::window::theme;

pub fn show(ui: &mut Ui, desk: &Desk, actions: &mut Vec<Action>) {
    let Some(update) = desk.update.as_ref().filter(|update| !update.diagnostics.is_empty()) else { return };
    let errors = update.diagnostics.iter().filter(|message| message.is_error()).count();
    let frame = theme::side().inner_margin(egui::Margin::symmetric(12, 6));
    egui::Panel::bottom("diagnostics").default_size(96.0).resizable(true).frame(frame).show(ui, |ui| {
        let warnings = update.diagnostics.len() - errors;
        ui.horizontal(|ui| {
            let plural = |n: usize| if n == 1 { "" } else { "s" };
            ui.label(RichText::new("DIAGNOSTICS").size(10.5).color(theme::WEAK).strong());
            if errors > 0 {
                ui.colored_label(theme::ERROR, format!("{errors} error{}", plural(errors)));
            }
            if warnings > 0 {
                ui.colored_label(theme::WARNING, format!("{warnings} warning{}", plural(warnings)));
            }
        });
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let by_weight = |message: &&Message| !message.is_error();
            let mut sorted: Vec<&Message> = update.diagnostics.iter().collect();
            sorted.sort_by_key(by_weight);
            for message in sorted {
                line(ui, message, actions);
            }
        });
    });
}

/// `file:line:column`.
pub fn place_text(message: &Message) -> Option<String> {
    message.place.as_ref().map(|place| format!("{}:{}:{}", place.file, place.line, place.column))
}

fn line(ui: &mut Ui, message: &Message, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let colour = if message.is_error() { theme::ERROR } else { theme::WARNING };
        let (dot, _) = ui.allocate_exact_size(egui::vec2(8.0, 18.0), egui::Sense::hover());
        ui.painter().circle_filled(dot.center(), 3.5, colour);
        if let Some(place) = place_text(message) {
            let text = RichText::new(&place).monospace().color(theme::ACCENT);
            let label = ui.add(egui::Label::new(text).sense(egui::Sense::click()));
            let label = label.on_hover_cursor(egui::CursorIcon::PointingHand).on_hover_text("click copies the place");
            if label.clicked() {
                actions.push(Action::Copy(place));
            }
        }
        ui.label(RichText::new(&message.code).monospace().color(theme::WEAK));
        let text = ui.add(egui::Label::new(RichText::new(&message.message).color(theme::STRONG)).truncate());
        let full = message.rendered.trim_end();
        text.on_hover_ui(|ui| {
            ui.set_max_width(640.0);
            ui.label(RichText::new(full).monospace());
        });
    });
}
