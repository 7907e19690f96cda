//! Picture: the scene in the middle, and the hands on it. In: the newest pictures, drags, scrolls, clicks, keys. Out: a
//! moved viewpoint, clicks on objects. Words over the picture are in [`super::over`].

use std::collections::BTreeMap;

use egui::{Color32, Pos2, Rect, Sense, TextureHandle, TextureOptions, Ui};
use glam::DVec3;

use super::{Action, over};
use crate::plan::demand::Camera;
use crate::window::desk::Desk;
use crate::window::picture::{Picture, outline};
use crate::window::take::Kind;
use crate::window::theme;
use crate::window::viewpoint::{Pixel, point_at, ray};

/// Degrees that a point of dragging turns.
const TURN: f64 = 0.3;
/// Points that the cursor may move before a scroll is about another place.
const SAME_PLACE: f32 = 4.0;

/// What the picture area keeps from one pass to the next.
#[derive(Default)]
pub struct Canvas {
    textures: BTreeMap<Kind, (u64, TextureHandle)>,
    outline: Option<((u64, Kind, u32), TextureHandle)>,
    /// How much of a drag was carried out, points.
    dragged: egui::Vec2,
    /// What the cursor holds while it pans.
    held: Option<DVec3>,
    /// Where a run of scrolls began, and what was there.
    scrolled: Option<(Pos2, DVec3)>,
    /// A click on a draft waits for the whole picture.
    clicked: Option<Pos2>,
    /// The picture on the screen, points.
    pub rect: Option<Rect>,
    /// Number of the wish that is on the screen.
    pub presented: u64,
}

pub fn show(ui: &mut Ui, desk: &mut Desk, canvas: &mut Canvas, actions: &mut Vec<Action>) {
    let frame = egui::Frame::new().fill(theme::BACKDROP);
    egui::CentralPanel::default().frame(frame).show(ui, |ui| {
        let area = ui.available_rect_before_wrap();
        let scale = ui.ctx().pixels_per_point();
        let pixels = ((area.width() * scale) as u32, (area.height() * scale) as u32);
        if pixels != desk.area {
            desk.area = pixels;
            actions.push(Action::Look { moving: desk.drawn.is_some() });
        }
        let response = ui.allocate_rect(area, Sense::click_and_drag());
        paint(ui, area, desk, canvas);
        hands(ui, area, &response, desk, canvas, actions);
        if desk.drawn.as_ref().is_some_and(|drawn| drawn.pictures.len() == 2) {
            bar(ui, desk, canvas);
        }
        over::show(ui, area, desk);
    });
}

/// The greatest rectangle of the shape of a camera's image in the middle of the area.
fn fitted(area: Rect, camera: &Camera) -> Rect {
    let (width, height) = (camera.width as f32, camera.height as f32);
    let scale = (area.width() / width).min(area.height() / height);
    Rect::from_center_size(area.center(), egui::vec2(width * scale, height * scale))
}

fn paint(ui: &Ui, area: Rect, desk: &Desk, canvas: &mut Canvas) {
    let Some(drawn) = &desk.drawn else { return };
    for picture in &drawn.pictures {
        upload(ui, drawn.wish.number, picture, canvas);
    }
    let rect = fitted(area, &drawn.pictures[0].camera);
    (canvas.rect, canvas.presented) = (Some(rect), drawn.wish.number);
    let bar = rect.left() + rect.width() * desk.bar as f32;
    for picture in &drawn.pictures {
        let part = match (drawn.pictures.len(), picture.kind) {
            (1, _) => rect,
            (_, Kind::Before) => Rect::from_x_y_ranges(rect.left()..=bar, rect.y_range()),
            (_, Kind::After | Kind::Mask) => Rect::from_x_y_ranges(bar..=rect.right(), rect.y_range()),
        };
        let painter = ui.painter().with_clip_rect(part);
        if let Some((_, texture)) = canvas.textures.get(&picture.kind) {
            painter.image(texture.id(), rect, UV, Color32::WHITE);
        }
        let picked = desk.picked.as_ref().filter(|picked| picked.state == picture.kind.state());
        if let Some(picked) = picked.filter(|_| !picture.instances.is_empty()) {
            mark(ui, drawn.wish.number, picture, picked.instance, canvas);
            if let Some((_, texture)) = &canvas.outline {
                painter.image(texture.id(), rect, UV, Color32::WHITE);
            }
        }
    }
}

const UV: Rect = Rect { min: Pos2::ZERO, max: Pos2::new(1.0, 1.0) };

fn upload(ui: &Ui, number: u64, picture: &Picture, canvas: &mut Canvas) {
    if canvas.textures.get(&picture.kind).is_some_and(|(own, _)| *own == number) {
        return;
    }
    let (width, height) = picture.size();
    let image = egui::ColorImage::from_rgba_unmultiplied([width as usize, height as usize], &picture.rgba);
    match canvas.textures.get_mut(&picture.kind) {
        Some((own, texture)) => {
            *own = number;
            texture.set(image, TextureOptions::LINEAR);
        }
        None => {
            let texture = ui.ctx().load_texture(picture.kind.name(), image, TextureOptions::LINEAR);
            canvas.textures.insert(picture.kind, (number, texture));
        }
    }
}

/// The outline of what was clicked.
fn mark(ui: &Ui, number: u64, picture: &Picture, instance: u32, canvas: &mut Canvas) {
    let key = (number, picture.kind, instance);
    if canvas.outline.as_ref().is_some_and(|(own, _)| *own == key) {
        return;
    }
    let (width, height) = picture.size();
    let rgba = outline(&picture.instances, width, instance, theme::OUTLINE);
    let image = egui::ColorImage::from_rgba_unmultiplied([width as usize, height as usize], &rgba);
    canvas.outline = Some((key, ui.ctx().load_texture("outline", image, TextureOptions::LINEAR)));
}

fn hands(
    ui: &Ui,
    area: Rect,
    response: &egui::Response,
    desk: &mut Desk,
    canvas: &mut Canvas,
    actions: &mut Vec<Action>,
) {
    let (Some(shown), Some(viewpoint)) = (desk.shown.clone(), desk.viewpoint) else { return };
    let camera = viewpoint.camera(desk.area, shown.summary.bounds);
    let place = Place { rect: fitted(area, &camera), camera };
    if response.clicked() {
        canvas.clicked = response.interact_pointer_pos();
    }
    click(desk, canvas, actions);
    let moved = drag(ui, response, &place, desk, canvas)
        | scroll(ui, response, &place, desk, canvas)
        | (desk.flying && fly(ui, desk));
    if moved {
        actions.push(Action::Look { moving: true });
    }
}

/// The picture as the present viewpoint would have it.
struct Place {
    rect: Rect,
    camera: Camera,
}

impl Place {
    fn pixel(&self, at: Pos2) -> Pixel {
        pixel_in(self.rect, (self.camera.width, self.camera.height), at)
    }

    /// What is under the cursor: what the picture shows there, else the plane of the target.
    fn anchor(&self, at: Pos2, desk: &Desk, canvas: &Canvas) -> DVec3 {
        let camera = &self.camera;
        let own = self.pixel(at);
        let seen = desk.drawn.as_ref().zip(canvas.rect).and_then(|(drawn, rect)| {
            let picture = drawn.pictures.iter().find(|picture| picture.kind == under(desk, rect, at))?;
            picture.point(pixel_in(rect, picture.size(), at))
        });
        let target = desk.viewpoint.map_or(DVec3::ZERO, |viewpoint| viewpoint.target);
        let depth = |point: DVec3| (point - camera.position).dot(camera.forward);
        let (origin, direction) = ray(camera, own);
        let plane = (target.y - origin.y) / direction.y;
        let far = 20.0 * depth(target);
        let depth = match seen {
            Some(point) => depth(point),
            None if plane.is_finite() && plane > 0.0 && plane < far => plane,
            None => depth(target),
        };
        point_at(camera, own, depth.max(0.1))
    }
}

fn pixel_in(rect: Rect, (width, height): (u32, u32), at: Pos2) -> Pixel {
    let share = (at - rect.min) / rect.size();
    Pixel { x: f64::from(share.x) * f64::from(width), y: f64::from(share.y) * f64::from(height) }
}

/// Which picture lies under a point of the screen; the right one of a split from its bar on.
fn under(desk: &Desk, rect: Rect, at: Pos2) -> Kind {
    let kinds = desk.drawn.as_ref().map(|drawn| &drawn.wish.kinds[..]);
    match kinds {
        Some(&[left, _]) if at.x < rect.left() + rect.width() * desk.bar as f32 => left,
        Some(&[_, right]) => right,
        Some(&[kind]) => kind,
        _ => Kind::After,
    }
}

fn click(desk: &Desk, canvas: &mut Canvas, actions: &mut Vec<Action>) {
    let Some((at, rect)) = canvas.clicked.zip(canvas.rect) else { return };
    // A draft has no numbers; the whole picture comes.
    let Some(drawn) = desk.drawn.as_ref().filter(|_| desk.is_current()) else { return };
    canvas.clicked = None;
    let kind = under(desk, rect, at);
    if let (true, Some(picture)) = (rect.contains(at), drawn.pictures.iter().find(|picture| picture.kind == kind)) {
        actions.push(Action::Pick { kind, at: pixel_in(rect, picture.size(), at) });
    }
}

fn drag(ui: &Ui, response: &egui::Response, place: &Place, desk: &mut Desk, canvas: &mut Canvas) -> bool {
    // Counted from where the button went down: nothing is lost in a slow pass.
    let whole = response.total_drag_delta().unwrap_or_default();
    let by = whole - canvas.dragged;
    canvas.dragged = whole;
    let (shift, cursor) = ui.input(|input| (input.modifiers.shift, input.pointer.latest_pos()));
    let turning = response.dragged_by(egui::PointerButton::Primary) && !shift;
    let panning = (response.dragged() && !turning).then_some(cursor).flatten();
    let Some(cursor) = panning else {
        canvas.held = None;
        if !turning || by == egui::Vec2::ZERO {
            return false;
        }
        let Some(viewpoint) = &mut desk.viewpoint else { return false };
        let (across, down, length) = (f64::from(by.x) * TURN, f64::from(by.y) * TURN, f64::from(by.length()));
        if desk.flying {
            viewpoint.look(-across, -down, length)
        } else {
            viewpoint.orbit(across, down, length)
        }
        return true;
    };
    let held = match canvas.held {
        Some(held) => held,
        None => {
            let start = ui.input(|input| input.pointer.press_origin()).unwrap_or(cursor);
            *canvas.held.insert(place.anchor(start, desk, canvas))
        }
    };
    let Some(viewpoint) = &mut desk.viewpoint else { return false };
    if by == egui::Vec2::ZERO {
        return false;
    }
    viewpoint.pan(held, place.pixel(cursor), &place.camera);
    true
}

fn scroll(ui: &Ui, response: &egui::Response, place: &Place, desk: &mut Desk, canvas: &mut Canvas) -> bool {
    let (by, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
    let Some(at) = response.hover_pos().filter(|_| by != 0.0 || pinch != 1.0) else { return false };
    let same = canvas.scrolled.filter(|(before, _)| before.distance(at) < SAME_PLACE && !desk.is_current());
    let anchor = same.map_or_else(|| place.anchor(at, desk, canvas), |(_, anchor)| anchor);
    canvas.scrolled = Some((at, anchor));
    let Some(viewpoint) = &mut desk.viewpoint else { return false };
    viewpoint.zoom(libm::exp(-0.004 * f64::from(by)) / f64::from(pinch), anchor);
    true
}

fn fly(ui: &Ui, desk: &mut Desk) -> bool {
    use egui::Key;
    if ui.ctx().egui_wants_keyboard_input() {
        return false;
    }
    let Some(viewpoint) = &mut desk.viewpoint else { return false };
    let (ways, seconds, fast) = ui.input(|input| {
        let way = |plus: Key, minus: Key| f64::from(input.key_down(plus)) - f64::from(input.key_down(minus));
        let ways = [way(Key::D, Key::A), way(Key::E, Key::Q), way(Key::W, Key::S)];
        (ways, f64::from(input.stable_dt).min(0.1), input.modifiers.shift)
    });
    if ways == [0.0; 3] {
        return false;
    }
    let metres = viewpoint.speed() * seconds * if fast { 4.0 } else { 1.0 };
    viewpoint.fly(ways[0] * metres, ways[1] * metres, ways[2] * metres);
    ui.ctx().request_repaint();
    true
}

/// The bar of a split.
fn bar(ui: &Ui, desk: &mut Desk, canvas: &Canvas) {
    let Some(rect) = canvas.rect else { return };
    let x = rect.left() + rect.width() * desk.bar as f32;
    let grip = Rect::from_x_y_ranges(x - 7.0..=x + 7.0, rect.y_range());
    let response = ui.interact(grip, ui.scope_id().with("bar"), Sense::drag());
    let response = response.on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        desk.bar = f64::from((at.x - rect.left()) / rect.width()).clamp(0.02, 0.98);
    }
    let x = rect.left() + rect.width() * desk.bar as f32;
    let colour = if response.hovered() || response.dragged() { theme::ACCENT } else { theme::STRONG };
    let painter = ui.painter();
    painter.line_segment([Pos2::new(x, rect.top()), Pos2::new(x, rect.bottom())], egui::Stroke::new(2.0, colour));
    let knob = Rect::from_center_size(Pos2::new(x, rect.center().y), egui::vec2(10.0, 34.0));
    painter.rect_filled(knob, 5.0, colour);
    let grey = egui::Stroke::new(1.0, theme::BACKDROP);
    for offset in [-1.5, 1.5] {
        let line = [Pos2::new(x + offset, knob.top() + 9.0), Pos2::new(x + offset, knob.bottom() - 9.0)];
        painter.line_segment(line, grey);
    }
}
