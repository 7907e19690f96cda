//! Help: the keys, over everything.

use egui::{Align2, RichText, Ui};

use crate::window::desk::Desk;
use crate::window::theme;

const KEYS: [(&str, &str); 16] = [
    ("drag", "orbit; when flying, look about"),
    ("right drag, Shift + drag", "pan"),
    ("scroll", "zoom to what is under the cursor"),
    ("click", "select"),
    ("1  2  3", "before, after, mask"),
    ("S", "split, with a bar to drag"),
    ("F", "frame the whole scene"),
    ("G", "fly, or orbit again"),
    ("W A S D", "when flying: ahead, left, back, right"),
    ("Q  E", "when flying: down, up"),
    ("Shift", "when flying: four times as fast"),
    ("R", "re-roll the seed"),
    ("P", "screenshot"),
    ("Esc", "deselect"),
    ("?", "this list"),
    ("", "A recipe's view, untouched, is saved at the recipe's own size."),
];

pub fn show(ui: &mut Ui, desk: &mut Desk) {
    if !desk.help {
        return;
    }
    let mut open = true;
    egui::Window::new(RichText::new("Keys and hands").strong())
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .collapsible(false)
        .resizable(false)
        .open(&mut open)
        .show(ui.ctx(), |ui| {
            egui::Grid::new("keys").num_columns(2).spacing([24.0, 7.0]).show(ui, |ui| {
                for (keys, meaning) in KEYS {
                    ui.label(RichText::new(keys).monospace().color(theme::ACCENT));
                    ui.label(meaning);
                    ui.end_row();
                }
            });
        });
    desk.help = open;
}
