//! The loop without a window: one line of JSON per update, the picture in a file.

use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use mansard::frame::{Frame, Image};
use mansard::live::{Canvas, Drawing, Overrides, Phase, Session, Shown, Update, Watcher, demand_of};
use mansard::output::write_bytes;
use serde_json::{Value, json};

use crate::args::{ShownName, WatchArgs};
use crate::report::{self, Failure};

/// How long the loop sleeps at a time.
const WAIT: Duration = Duration::from_secs(3600);

pub fn run(args: &WatchArgs) -> Result<(), Failure> {
    let mut session = Session::open(&args.recipe, args.options.recipe()?);
    let overrides = Overrides { scene: args.scene.clone(), ..Overrides::default() };
    let stop = session.stop();
    let mut watcher = Watcher::new(move || stop.store(true, Ordering::Relaxed))
        .map_err(|error| Failure::unable(error.to_string()))?;
    let mut canvas = Canvas::new();
    let mut left = if args.once { Some(1) } else { args.updates };
    loop {
        let update = session.update(&overrides);
        // Only now is it known what to follow; what was saved meanwhile is found by looking.
        watcher.follow(session.watched());
        let picture = picture(args, &session, &update, &mut canvas);
        let failed = update.has_errors() || picture.is_err();
        tell(&update, &session, picture)?;
        if let Some(left) = &mut left {
            *left -= 1;
            if *left == 0 {
                return if failed { Err(Failure::said()) } else { Ok(()) };
            }
        }
        if session.is_current() {
            while !watcher.wait(WAIT) {}
        }
    }
}

/// What was drawn.
struct Picture {
    view: String,
    drawing: Drawing,
}

/// Draws the picture where it may be another one, and writes it.
fn picture(
    args: &WatchArgs,
    session: &Session,
    update: &Update,
    canvas: &mut Canvas,
) -> Result<Option<Picture>, String> {
    let Some(path) = &args.png else { return Ok(None) };
    let (Some(built), true) = (session.built(), update.redone.views) else { return Ok(None) };
    let shown = match args.state {
        ShownName::Before => Shown::Before,
        ShownName::After => Shown::After,
        ShownName::Mask => Shown::Mask,
    };
    let named = |name: &String| session.views().iter().find(|view| view.name == *name);
    let view = match &args.view {
        Some(name) => named(name).ok_or_else(|| format!("no view of the recipe is called {name}"))?,
        None => session.views().first().ok_or("the recipe has no view of the scene")?,
    };
    let demand = demand_of(view, shown).ok_or_else(|| format!("view {} has no such image", view.name))?;
    let mut drawing = canvas.draw(built, &demand).map_err(|error| error.to_string())?;
    let start = Instant::now();
    write(path, &mut drawing.frame)?;
    drawing.phases.push(Phase::new("encode", start.elapsed().as_secs_f64()));
    Ok(Some(Picture { view: view.name.clone(), drawing }))
}

fn write(path: &Path, frame: &mut Frame) -> Result<(), String> {
    let Image { pixels, .. } = frame.images.pop().ok_or("nothing was drawn")?;
    let bytes =
        mansard::dataset::encode_png((frame.width, frame.height), &pixels).map_err(|error| error.to_string())?;
    write_bytes(path, &bytes).map_err(|error| error.to_string())
}

fn tell(update: &Update, session: &Session, picture: Result<Option<Picture>, String>) -> Result<(), Failure> {
    let mut line = serde_json::to_value(update).expect("plain strings and numbers serialise");
    line["geometry_sha256"] = json!(session.geometry_sha256());
    line["picture"] = match picture {
        Ok(None) => Value::Null,
        Ok(Some(Picture { view, drawing })) => {
            let Drawing { frame, phases, notes } = drawing;
            json!({ "view": view, "width": frame.width, "height": frame.height, "phases": phases, "notes": notes })
        }
        Err(error) => json!({ "error": error }),
    };
    report::out(&format!("{line}\n"))
}
