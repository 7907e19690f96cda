//! Left: where to look from, which state, which layers, the sun, the draws.

use egui::{RichText, Ui};

use super::{Action, fixed};
use crate::live::{SunAngles, thousands};
use crate::window::desk::{Desk, Show};
use crate::window::theme;

pub fn show(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    egui::Panel::left("choices").default_size(258.0).size_range(230.0..=360.0).frame(theme::side()).show(ui, |ui| {
        fixed(ui, |ui| {
            heading(ui, desk);
            state(ui, desk, actions);
            views(ui, desk, actions);
            sun(ui, desk, actions);
            layers(ui, desk, actions);
            draws(ui, desk, actions);
        });
    });
}

fn heading(ui: &mut Ui, desk: &Desk) {
    ui.label(RichText::new(&desk.name).heading().color(theme::STRONG));
    let Some(shown) = &desk.shown else {
        ui.weak("building the first scene");
        return;
    };
    let objects = shown.built.record.features;
    ui.label(RichText::new(format!("{objects} features · {} triangles", thousands(shown.triangles))).weak());
}

fn state(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    theme::title(ui, "State");
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.x = 5.0;
        ui.columns(4, |columns| {
            for ((ui, show), key) in columns.iter_mut().zip(Show::ALL).zip(["1", "2", "3", "S"]) {
                let chosen = desk.show == show;
                let fill = if chosen { theme::ACCENT_DEEP } else { theme::RAISED };
                ui.spacing_mut().button_padding.x = 2.0;
                let text = RichText::new(show.name()).color(if chosen { theme::STRONG } else { theme::TEXT });
                if ui
                    .add_sized([ui.available_width(), 26.0], egui::Button::new(text).fill(fill))
                    .on_hover_text(format!("key {key}"))
                    .clicked()
                    && !chosen
                {
                    desk.show = show;
                    actions.push(Action::Look { moving: false });
                }
            }
        });
    });
}

fn views(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    let Some(shown) = desk.shown.clone() else { return };
    if shown.scenes.len() > 1 {
        theme::title(ui, "Scene");
        let mut chosen = shown.scene;
        let combo = egui::ComboBox::from_id_salt("scene").selected_text(shown.scenes[chosen].as_str());
        combo.width(ui.available_width()).show_ui(ui, |ui| {
            for (index, name) in shown.scenes.iter().enumerate() {
                ui.selectable_value(&mut chosen, index, name);
            }
        });
        if chosen != shown.scene {
            desk.overrides.scene = Some(shown.scenes[chosen].clone());
            actions.push(Action::Choose);
        }
    }
    theme::title(ui, "Views of the recipe");
    theme::card().show(ui, |ui| {
        egui::ScrollArea::vertical().id_salt("views").max_height(190.0).auto_shrink([false, true]).show(ui, |ui| {
            for (index, view) in shown.views.iter().enumerate() {
                let exactly = desk.view == index && desk.viewpoint.is_some_and(|v| v.given().is_some());
                let light = desk.view == index;
                let colour = if light { theme::STRONG } else { theme::TEXT };
                let label = ui.selectable_label(exactly, RichText::new(&view.name).color(colour));
                let camera = &view.demands[0].camera;
                let size = format!("{} × {} pixels, its sun and effects", camera.width, camera.height);
                if label.on_hover_text(size).clicked() {
                    desk.go_to(index);
                    actions.push(Action::Look { moving: false });
                }
            }
        });
    });
    ui.horizontal(|ui| {
        if ui.button("Frame all").on_hover_text("key F").clicked() {
            desk.frame_scene();
            actions.push(Action::Look { moving: false });
        }
        let fly = ui.add(egui::Button::new("Fly").selected(desk.flying));
        if fly.on_hover_text("key G: then W A S D, Q down, E up, drag to look about").clicked() {
            desk.flying = !desk.flying;
        }
    });
}

fn sun(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    let Some(now) = desk.sun() else { return };
    theme::title(ui, "Sun");
    theme::card().show(ui, |ui| {
        let SunAngles { mut elevation, mut azimuth } = now;
        ui.spacing_mut().slider_width = (ui.available_width() - 138.0).max(40.0);
        let slider = |ui: &mut Ui, name: &str, value: &mut f64, range: std::ops::RangeInclusive<f64>| {
            ui.horizontal(|ui| {
                name_cell(ui, name, 56.0);
                // A value that the recipe drew is not touched before the user does.
                let slider = egui::Slider::new(value, range).clamping(egui::SliderClamping::Edits);
                ui.add(slider.max_decimals(1).suffix("°")).changed()
            })
            .inner
        };
        let changed = slider(ui, "Elevation", &mut elevation, 1.0..=90.0);
        let changed = slider(ui, "Azimuth", &mut azimuth, 0.0..=360.0) || changed;
        if changed {
            desk.overrides.sun = Some(SunAngles { elevation, azimuth });
            actions.push(Action::Choose);
        }
        let own = desk.overrides.sun.is_some();
        ui.horizontal(|ui| {
            if ui.add_enabled(own, egui::Button::new("As in the recipe").small()).clicked() {
                desk.overrides.sun = None;
                actions.push(Action::Choose);
            }
            mark(ui, own);
        });
    });
}

/// A name in a column of this width.
pub fn name_cell(ui: &mut Ui, name: &str, width: f32) -> egui::Response {
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let cell = ui.allocate_ui_with_layout(egui::vec2(width, 20.0), layout, |ui| {
        ui.set_width(width);
        ui.add(egui::Label::new(name).truncate())
    });
    cell.inner
}

/// A dot where a value is not the recipe's.
pub fn mark(ui: &mut Ui, own: bool) {
    let (rect, response) = ui.allocate_exact_size(egui::vec2(8.0, 18.0), egui::Sense::hover());
    if own {
        ui.painter().circle_filled(rect.center(), 3.0, theme::ACCENT);
        response.on_hover_text("not as in the recipe");
    }
}

fn layers(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    let Some(shown) = desk.shown.clone() else { return };
    theme::title(ui, "Layers");
    theme::card().show(ui, |ui| {
        ui.columns(2, |columns| {
            for (index, &class) in shown.classes.iter().enumerate() {
                let ui = &mut columns[index % 2];
                let mut on = desk.layers.shows(class);
                if ui.checkbox(&mut on, capital(class.name())).changed() {
                    desk.layers.set(class, on);
                    actions.push(Action::Look { moving: false });
                }
            }
        });
    });
}

pub fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn draws(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    let Some(shown) = desk.shown.clone() else { return };
    theme::title(ui, "Seed");
    theme::card().show(ui, |ui| {
        let own = desk.overrides.seed.is_some();
        ui.horizontal(|ui| {
            let seed = desk.overrides.seed.unwrap_or(shown.seed);
            ui.label(RichText::new(seed.to_string()).monospace().size(15.0).color(theme::STRONG));
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Re-roll").on_hover_text("key R").clicked() {
                    desk.reroll();
                    actions.push(Action::Choose);
                }
            });
        });
        ui.horizontal(|ui| {
            if ui.add_enabled(own, egui::Button::new("As in the recipe").small()).clicked() {
                desk.overrides.seed = None;
                actions.push(Action::Choose);
            }
            mark(ui, own);
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_begin_with_capitals() {
        assert_eq!(capital("terrain"), "Terrain");
    }
}
