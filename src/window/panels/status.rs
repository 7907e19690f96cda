//! Status line: what the last update did again, how long each phase took, what is drawn and by what.

use egui::{RichText, Ui};

use crate::live::{Phase, Redone, Update, thousands};
use crate::window::desk::{Desk, Standing};
use crate::window::take::Care;
use crate::window::theme;

pub fn show(ui: &mut Ui, desk: &Desk) {
    let frame = egui::Frame::new().fill(theme::BACKDROP).inner_margin(egui::Margin::symmetric(12, 5));
    egui::Panel::bottom("status").resizable(false).frame(frame).show(ui, |ui| {
        ui.horizontal(|ui| {
            state(ui, desk);
            if let Some(update) = &desk.update {
                let text = RichText::new(redone_text(&update.redone)).small().color(theme::TEXT);
                ui.label(text).on_hover_ui(|ui| phases(ui, desk, update));
                let total: f64 = update.phases.iter().map(|phase| phase.ms).sum();
                ui.label(RichText::new(milliseconds(total)).small().color(theme::STRONG));
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| right(ui, desk));
        });
    });
}

fn state(ui: &mut Ui, desk: &Desk) {
    let (colour, text) = match (desk.building, desk.standing()) {
        (true, _) => (theme::ACCENT, "building"),
        (false, Standing::Stands) => (theme::ERROR, "last good scene"),
        (false, Standing::Empty) => (theme::ERROR, "no scene yet"),
        (false, Standing::Current) => (theme::GOOD, "up to date"),
    };
    let (dot, _) = ui.allocate_exact_size(egui::vec2(8.0, 14.0), egui::Sense::hover());
    ui.painter().circle_filled(dot.center(), 3.5, colour);
    ui.label(RichText::new(text).small().color(colour));
}

fn right(ui: &mut Ui, desk: &Desk) {
    if let Some(drawn) = &desk.drawn {
        ui.label(RichText::new(&drawn.adapter).small().color(theme::WEAK));
        let (width, height) = drawn.pictures[0].size();
        let care = if drawn.wish.care == Care::Draft { "draft" } else { "full quality" };
        let text = format!("{width} × {height}, {care}, {}", milliseconds(drawn.ms));
        ui.label(RichText::new(text).small().color(theme::TEXT)).on_hover_ui(|ui| list(ui, &drawn.phases));
        for note in &drawn.notes {
            ui.label(RichText::new(note).small().color(theme::WARNING));
        }
    }
    if let Some(update) = &desk.update {
        let text = format!("{} triangles", thousands(update.triangles));
        ui.label(RichText::new(text).small().color(theme::TEXT));
    }
    if let Some(note) = &desk.note {
        ui.label(RichText::new(note).small().color(theme::ACCENT));
    }
}

fn phases(ui: &mut Ui, desk: &Desk, update: &Update) {
    ui.label(RichText::new(format!("Update {}", update.number)).strong());
    for file in &update.changed {
        ui.weak(format!("{file} changed"));
    }
    list(ui, &update.phases);
    if let Some(drawn) = &desk.drawn {
        ui.weak("Drawing");
        list(ui, &drawn.phases);
    }
}

fn list(ui: &mut Ui, phases: &[Phase]) {
    egui::Grid::new(ui.next_auto_id()).num_columns(2).spacing([16.0, 2.0]).show(ui, |ui| {
        for phase in phases {
            ui.label(&phase.name);
            ui.label(RichText::new(milliseconds(phase.ms)).monospace());
            ui.end_row();
        }
    });
}

/// 3 digits, or seconds where it takes some.
pub fn milliseconds(ms: f64) -> String {
    match ms {
        ms if ms >= 10_000.0 => format!("{:.1} s", ms / 1e3),
        ms if ms >= 100.0 => format!("{ms:.0} ms"),
        ms if ms >= 10.0 => format!("{ms:.1} ms"),
        ms => format!("{ms:.2} ms"),
    }
}

/// What was done again, in words.
fn redone_text(redone: &Redone) -> String {
    let mut parts = Vec::new();
    let mut say = |done: bool, word: String| {
        if done {
            parts.push(word);
        }
    };
    say(redone.recipe, "recipe".to_owned());
    say(redone.programs > 0, format!("{} rule file{}", redone.programs, if redone.programs == 1 { "" } else { "s" }));
    say(redone.place, "map".to_owned());
    let (derived, kept) = (redone.lots_derived, redone.lots_kept);
    say(derived > 0, format!("{} of {} lots", thousands(derived), thousands(derived + kept)));
    say(redone.ground, "ground".to_owned());
    say(redone.views && !redone.scene, "views".to_owned());
    if parts.is_empty() { "nothing to do again".to_owned() } else { format!("done again: {}", parts.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_done_is_said() {
        assert_eq!(redone_text(&Redone::default()), "nothing to do again");
        let redone = Redone { programs: 1, lots_derived: 50, lots_kept: 3721, scene: true, ..Redone::default() };
        assert_eq!(redone_text(&redone), "done again: 1 rule file, 50 of 3,771 lots");
        assert_eq!(redone_text(&Redone { views: true, ..Redone::default() }), "done again: views");
    }

    #[test]
    fn times_have_three_digits() {
        let times = [0.123, 4.0, 45.67, 456.7, 12_345.0].map(milliseconds);
        assert_eq!(times, ["0.12 ms", "4.00 ms", "45.7 ms", "457 ms", "12.3 s"]);
    }
}
