//! Theme: how the window looks. Slate and copper, as the roofs it is named after.

use egui::{Color32, CornerRadius, FontFamily, FontId, Frame, Margin, Shadow, Stroke, TextStyle, Vec2, Visuals};

pub const BACKDROP: Color32 = Color32::from_rgb(16, 18, 22);
pub const PANEL: Color32 = Color32::from_rgb(24, 27, 33);
pub const CARD: Color32 = Color32::from_rgb(31, 35, 42);
pub const RAISED: Color32 = Color32::from_rgb(43, 48, 58);
pub const LINE: Color32 = Color32::from_rgb(50, 56, 67);
pub const TEXT: Color32 = Color32::from_rgb(214, 219, 227);
pub const STRONG: Color32 = Color32::from_rgb(245, 247, 250);
pub const WEAK: Color32 = Color32::from_rgb(139, 148, 162);
pub const ACCENT: Color32 = Color32::from_rgb(232, 147, 84);
pub const ACCENT_DEEP: Color32 = Color32::from_rgb(140, 78, 36);
pub const GOOD: Color32 = Color32::from_rgb(112, 190, 138);
pub const WARNING: Color32 = Color32::from_rgb(233, 190, 92);
pub const ERROR: Color32 = Color32::from_rgb(240, 104, 96);
pub const ERROR_DEEP: Color32 = Color32::from_rgb(92, 30, 30);
/// Around what was clicked.
pub const OUTLINE: [u8; 4] = [255, 176, 92, 255];

const ROUND: CornerRadius = CornerRadius::same(5);

pub fn apply(context: &egui::Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        style.visuals = visuals();
        style.spacing.item_spacing = Vec2::new(8.0, 6.0);
        style.spacing.button_padding = Vec2::new(9.0, 4.0);
        style.spacing.interact_size.y = 22.0;
        style.spacing.slider_width = 128.0;
        style.spacing.slider_rail_height = 4.0;
        style.spacing.indent = 12.0;
        style.spacing.combo_width = 128.0;
        style.spacing.tooltip_width = 320.0;
        style.animation_time = 0.08;
        let sizes = [
            (TextStyle::Small, 11.0, FontFamily::Proportional),
            (TextStyle::Body, 13.0, FontFamily::Proportional),
            (TextStyle::Button, 13.0, FontFamily::Proportional),
            (TextStyle::Heading, 17.0, FontFamily::Proportional),
            (TextStyle::Monospace, 12.0, FontFamily::Monospace),
        ];
        style.text_styles = sizes.into_iter().map(|(name, size, family)| (name, FontId::new(size, family))).collect();
    });
}

fn visuals() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = PANEL;
    visuals.window_fill = CARD;
    visuals.window_stroke = Stroke::new(1.0, LINE);
    visuals.window_corner_radius = CornerRadius::same(10);
    visuals.menu_corner_radius = CornerRadius::same(7);
    visuals.window_shadow = Shadow { offset: [0, 10], blur: 30, spread: 0, color: Color32::from_black_alpha(140) };
    visuals.popup_shadow = Shadow { offset: [0, 4], blur: 14, spread: 0, color: Color32::from_black_alpha(120) };
    visuals.extreme_bg_color = BACKDROP;
    visuals.faint_bg_color = CARD;
    visuals.code_bg_color = BACKDROP;
    visuals.weak_text_color = Some(WEAK);
    visuals.hyperlink_color = ACCENT;
    visuals.warn_fg_color = WARNING;
    visuals.error_fg_color = ERROR;
    visuals.selection.bg_fill = ACCENT_DEEP;
    visuals.selection.stroke = Stroke::new(1.0, STRONG);
    visuals.slider_trailing_fill = true;
    visuals.indent_has_left_vline = false;
    visuals.widgets.noninteractive.fg_stroke = Stroke::new(1.0, TEXT);
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, LINE);
    for (widget, fill, text, line) in [
        (&mut visuals.widgets.inactive, RAISED, TEXT, Stroke::NONE),
        (&mut visuals.widgets.hovered, Color32::from_rgb(54, 60, 72), STRONG, Stroke::new(1.0, WEAK)),
        (&mut visuals.widgets.active, ACCENT_DEEP, STRONG, Stroke::new(1.0, ACCENT)),
        (&mut visuals.widgets.open, RAISED, STRONG, Stroke::new(1.0, LINE)),
    ] {
        (widget.bg_fill, widget.weak_bg_fill, widget.bg_stroke) = (fill, fill, line);
        (widget.fg_stroke, widget.corner_radius, widget.expansion) = (Stroke::new(1.0, text), ROUND, 0.0);
    }
    visuals
}

/// Around the contents of a side.
pub fn side() -> Frame {
    Frame::new().fill(PANEL).inner_margin(Margin::symmetric(12, 10))
}

/// Around things that belong together.
pub fn card() -> Frame {
    Frame::new().fill(CARD).corner_radius(CornerRadius::same(8)).inner_margin(Margin::symmetric(12, 10))
}

/// A small title over a card.
pub fn title(ui: &mut egui::Ui, text: &str) {
    ui.add_space(6.0);
    ui.label(egui::RichText::new(text.to_uppercase()).size(10.5).color(WEAK).strong());
}
