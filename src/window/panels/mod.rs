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
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                selection::show(ui, desk, actions);
                attributes::show(ui, desk, actions);
            });
        },
    );
    picture::show(ui, desk, canvas, actions);
    help::show(ui, desk);
}
