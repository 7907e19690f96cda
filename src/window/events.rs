//! Events: what the window prints for those who drive it, one JSON object per line, beside the updates of the session.

use egui::Rect;
use serde_json::{Value, json};

use super::desk::{Desk, Picked};
use super::take::Care;
use crate::plan::demand::State;

/// Pictures are on the screen; `rect` is where, pixels of the window.
pub fn frame(desk: &Desk, rect: Rect) -> Option<Value> {
    let drawn = desk.drawn.as_ref()?;
    let (width, height) = drawn.pictures[0].size();
    let place = [rect.left(), rect.top(), rect.width(), rect.height()].map(f32::round);
    Some(json!({
        "event": "frame",
        "number": drawn.wish.number,
        "width": width,
        "height": height,
        "update": drawn.wish.shown.update,
        "scene": drawn.wish.shown.number,
        "view": drawn.wish.shown.views[drawn.wish.view].name,
        "exact": drawn.wish.viewpoint.given().is_some(),
        "show": drawn.wish.kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>(),
        "draft": drawn.wish.care == Care::Draft,
        "rect": place,
        "phases": drawn.phases,
        "ms": (drawn.ms * 1e3).round() / 1e3,
        "adapter": drawn.adapter,
        "notes": drawn.notes,
    }))
}

/// A click was answered, or what was clicked was made again.
pub fn picked(desk: &Desk, picked: &Picked) -> Value {
    json!({
        "event": "picked",
        "update": desk.shown.as_ref().map(|shown| shown.update),
        "at": [picked.at.0, picked.at.1],
        "size": [picked.size.0, picked.size.1],
        "state": if picked.state == State::Before { "before" } else { "after" },
        "instance": picked.instance,
        "lot": picked.lot,
    })
}

pub fn screenshot(path: &std::path::Path) -> Value {
    json!({ "event": "screenshot", "path": path })
}

pub fn copied(text: &str) -> Value {
    json!({ "event": "copied", "text": text })
}
