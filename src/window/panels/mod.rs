//! Panels: what is drawn around and over the picture. In: the desk. Out: what the user did ([`Action`]), for the loop to
//! carry out.

mod attributes;
mod diagnostics;
mod help;
mod left;
mod over;
mod picture;
mod selection;
mod status;

use super::desk::Desk;
use super::take::Kind;
use super::viewpoint::Pixel;

pub use picture::Canvas;

/// Something that the user did and that another thread has to answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Something else is to be seen. `moving`: more of it will follow at once.
    Look {
        moving: bool,
    },
    /// Overrides changed.
    Choose,
    Pick {
        kind: Kind,
        at: Pixel,
    },
    Deselect,
    Screenshot,
    Copy(String),
}

/// Lays out the whole window.
pub fn show(ui: &mut egui::Ui, desk: &mut Desk, canvas: &mut Canvas, actions: &mut Vec<Action>) {
    status::show(ui, desk);
    diagnostics::show(ui, desk, actions);
    left::show(ui, desk, actions);
    egui::Panel::right("facts").default_size(330.0).size_range(260.0..=520.0).frame(super::theme::side()).show(
        ui,
        |ui| {
            fixed(ui, |ui| {
                selection::show(ui, desk, actions);
                attributes::show(ui, desk, actions);
            });
        },
    );
    picture::show(ui, desk, canvas, actions);
    help::show(ui, desk);
}

/// Contents that scroll and never widen their panel.
fn fixed(ui: &mut egui::Ui, add: impl FnOnce(&mut egui::Ui)) {
    let rect = ui.available_rect_before_wrap();
    let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(rect));
    inside.set_clip_rect(rect.intersect(ui.clip_rect()));
    egui::ScrollArea::vertical().auto_shrink(false).show(&mut inside, add);
    ui.advance_cursor_after_rect(rect);
}
