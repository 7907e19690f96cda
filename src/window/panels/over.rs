//! Over the picture: which view and state it is, whether it is the last word, and, while files hold mistakes, that the
//! last good scene stands.

use egui::{Align2, Color32, CornerRadius, Margin, Rect, RichText, Stroke, Ui};

use super::diagnostics::place_text;
use super::left::capital;
use crate::live::Message;
use crate::window::desk::{Desk, Standing};
use crate::window::take::Care;
use crate::window::theme;

pub fn show(ui: &Ui, area: Rect, desk: &Desk) {
    names(ui, area, desk);
    working(ui, area, desk);
    let errors: Vec<&Message> =
        desk.update.iter().flat_map(|update| &update.diagnostics).filter(|message| message.is_error()).collect();
    match (desk.standing(), errors.first(), &desk.drawing_failed) {
        (_, _, Some(reason)) => banner(ui, area, "The adapter could not draw", reason, None),
        (Standing::Stands, Some(first), None) => {
            let more = if errors.len() > 1 { format!(" and {} more", errors.len() - 1) } else { String::new() };
            let place = place_text(first).map(|place| format!("{place}{more}"));
            banner(ui, area, "The last good scene is shown", &first.message, place.as_deref());
        }
        (Standing::Stands, None, None) => banner(ui, area, "The last good scene is shown", "The update failed", None),
        (Standing::Empty, Some(first), None) => {
            let place = place_text(first);
            banner(ui, area, "There is no scene yet", &first.message, place.as_deref());
        }
        (Standing::Empty, None, None) => waiting(ui, area),
        (Standing::Current, _, None) => {}
    }
}

fn chip(fill: Color32) -> egui::Frame {
    egui::Frame::new().fill(fill).corner_radius(CornerRadius::same(6)).inner_margin(Margin::symmetric(9, 4))
}

const SHADE: Color32 = Color32::from_rgba_premultiplied(9, 10, 12, 190);

/// An area over the picture, which no hand can hold.
fn place(ui: &Ui, name: &str, align: Align2, area: Rect, inset: egui::Vec2, add: impl FnOnce(&mut Ui)) {
    let sign = egui::vec2(
        if align.x() == egui::Align::Max { -1.0 } else { 1.0 },
        if align.y() == egui::Align::Max { -1.0 } else { 1.0 },
    );
    let at = align.pos_in_rect(&area) + inset * sign;
    egui::Area::new(egui::Id::unique(name))
        .pivot(align)
        .fixed_pos(at)
        .interactable(false)
        .order(egui::Order::Middle)
        .show(ui.ctx(), |ui| add(ui));
}

fn names(ui: &Ui, area: Rect, desk: &Desk) {
    // What is on the screen, which may not yet be what was asked for.
    let Some(wish) = desk.drawn.as_ref().map(|drawn| &drawn.wish) else { return };
    let touched = wish.viewpoint.given().is_none();
    place(ui, "names", Align2::LEFT_TOP, area, egui::vec2(12.0, 12.0), |ui| {
        chip(SHADE).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(RichText::new(&wish.shown.views[wish.view].name).color(theme::STRONG));
                if touched {
                    ui.label(RichText::new(if desk.flying { "flying" } else { "free camera" }).color(theme::WEAK));
                }
                if let [kind] = wish.kinds[..] {
                    ui.label(RichText::new(capital(kind.name())).color(theme::ACCENT));
                }
            });
        });
    });
    if wish.kinds.len() == 2 {
        let sides = [("before", Align2::LEFT_BOTTOM, "Before"), ("after", Align2::RIGHT_BOTTOM, "After")];
        for (name, align, word) in sides {
            place(ui, name, align, area, egui::vec2(12.0, 12.0), |ui| {
                chip(SHADE).show(ui, |ui| ui.label(RichText::new(word).color(theme::ACCENT)));
            });
        }
    }
}

/// A picture that is not the last word says so.
fn working(ui: &Ui, area: Rect, desk: &Desk) {
    let Some(drawn) = &desk.drawn else { return };
    let word = match (desk.building, desk.is_current(), drawn.wish.care) {
        (true, _, _) => "building",
        (false, true, _) => return,
        (false, false, Care::Draft) => "draft",
        (false, false, Care::Full) => "drawing",
    };
    place(ui, "working", Align2::RIGHT_TOP, area, egui::vec2(12.0, 12.0), |ui| {
        chip(SHADE).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.add(egui::Spinner::new().size(12.0).color(theme::ACCENT));
                ui.label(RichText::new(word).color(theme::TEXT));
            });
        });
    });
}

fn waiting(ui: &Ui, area: Rect) {
    place(ui, "waiting", Align2::CENTER_CENTER, area, egui::Vec2::ZERO, |ui| {
        ui.horizontal(|ui| {
            ui.add(egui::Spinner::new().size(20.0).color(theme::ACCENT));
            ui.label(RichText::new("Building the scene").size(15.0).color(theme::TEXT));
        });
    });
}

fn banner(ui: &Ui, area: Rect, title: &str, message: &str, at: Option<&str>) {
    let width = (area.width() - 120.0).clamp(240.0, 620.0);
    place(ui, "banner", Align2::CENTER_TOP, area, egui::vec2(0.0, 48.0), |ui| {
        chip(theme::ERROR_DEEP).stroke(Stroke::new(1.0, theme::ERROR)).inner_margin(Margin::symmetric(14, 9)).show(
            ui,
            |ui| {
                ui.set_max_width(width);
                ui.label(RichText::new(title).strong().color(theme::STRONG));
                ui.label(RichText::new(message).color(theme::STRONG));
                if let Some(at) = at {
                    ui.label(RichText::new(at).monospace().color(theme::WARNING));
                }
            },
        );
    });
}
