//! Drawer: the thread that owns the renderer. In: what the window wants to see; only the newest wish counts. Out: whole
//! pictures, and screenshots on disk.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use super::error::WindowError;
use super::mailbox::Mailbox;
use super::picture::{Picture, split};
use super::report::{Report, Tell};
use super::shown::Shown;
use super::take::{Care, Kind, Layers, demand};
use super::viewpoint::Viewpoint;
use crate::dataset::write_image;
use crate::frame::Pixels;
use crate::gpu::GpuError;
use crate::live::{Canvas, Phase};

/// Everything a picture depends on.
#[derive(Clone)]
pub struct Wish {
    pub shown: Arc<Shown>,
    /// Index into [`Shown::views`]: whose light and effects.
    pub view: usize,
    pub viewpoint: Viewpoint,
    /// One, or two of a split.
    pub kinds: Vec<Kind>,
    pub layers: Layers,
    pub care: Care,
    /// Pixels that there are at most.
    pub size: (u32, u32),
    /// Counts up with every wish.
    pub number: u64,
}

/// Whole pictures of one wish.
pub struct Drawn {
    pub wish: Wish,
    pub pictures: Vec<Picture>,
    pub phases: Vec<Phase>,
    /// Such as that the adapter was lost and opened again.
    pub notes: Vec<String>,
    pub adapter: String,
    pub ms: f64,
}

#[derive(Default)]
struct Orders {
    wish: Option<Wish>,
    screenshot: Option<Screenshot>,
    quit: bool,
}

/// A picture for a file.
pub struct Screenshot {
    pub wish: Wish,
    /// Share of the width where a split changes over.
    pub bar: f64,
    pub path: PathBuf,
}

/// The thread, from outside.
pub struct Drawer {
    mailbox: Arc<Mailbox<Orders>>,
}

impl Drawer {
    pub fn start(tell: Tell) -> Result<Drawer, WindowError> {
        let mailbox: Arc<Mailbox<Orders>> = Arc::default();
        let drawer = Drawer { mailbox: mailbox.clone() };
        std::thread::Builder::new().name("draw".to_owned()).spawn(move || work(&mailbox, &tell))?;
        Ok(drawer)
    }

    pub fn draw(&self, wish: Wish) {
        self.mailbox.post(|orders| orders.wish = Some(wish));
    }

    pub fn save(&self, screenshot: Screenshot) {
        self.mailbox.post(|orders| orders.screenshot = Some(screenshot));
    }
}

impl Drop for Drawer {
    fn drop(&mut self) {
        self.mailbox.post(|orders| orders.quit = true);
    }
}

fn work(mailbox: &Mailbox<Orders>, tell: &Tell) {
    let mut canvas = Canvas::new();
    loop {
        let orders = mailbox.take();
        if orders.quit {
            return;
        }
        if let Some(wish) = orders.wish {
            tell(match draw(&mut canvas, wish) {
                Ok(drawn) => Report::Drawn(Box::new(drawn)),
                Err(error) => Report::NotDrawn(error.to_string()),
            });
        }
        if let Some(screenshot) = orders.screenshot {
            tell(match save(&mut canvas, screenshot) {
                Ok(path) => Report::Saved(path),
                Err(reason) => Report::NotSaved(reason),
            });
        }
    }
}

fn draw(canvas: &mut Canvas, wish: Wish) -> Result<Drawn, GpuError> {
    let start = Instant::now();
    let Shown { built, summary, views, .. } = &*wish.shown;
    let camera = wish.viewpoint.camera(wish.size, summary.bounds);
    let (mut pictures, mut phases, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    for &kind in &wish.kinds {
        let demand = demand(&views[wish.view], &summary.objects, kind, camera, wish.layers, wish.care);
        let drawing = canvas.draw(built, &demand)?;
        phases.extend(drawing.phases);
        notes.extend(drawing.notes);
        pictures.push(Picture::new(kind, camera, drawing.frame));
    }
    let adapter = canvas.adapter().map_or(String::new(), |adapter| adapter.name.clone());
    let ms = start.elapsed().as_secs_f64() * 1e3;
    Ok(Drawn { wish, pictures, phases, notes, adapter, ms })
}

/// Draws with full care and writes a PNG; a recipe's camera at the recipe's own size, so that the file shows what the
/// dataset would.
fn save(canvas: &mut Canvas, Screenshot { mut wish, bar, path }: Screenshot) -> Result<PathBuf, String> {
    wish.care = Care::Full;
    if let Some(given) = wish.viewpoint.given() {
        wish.size = (given.width, given.height);
    }
    let drawn = draw(canvas, wish).map_err(|error| error.to_string())?;
    let (width, height) = drawn.pictures[0].size();
    let rgba = match &drawn.pictures[..] {
        [left, right] => split(&left.rgba, &right.rgba, width, bar).into(),
        pictures => pictures[0].rgba.clone(),
    };
    let rgb = rgba.as_chunks::<4>().0.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect();
    let (folder, name) = (path.parent().unwrap_or(&path), path.file_stem().unwrap_or_default());
    write_image(folder, name.as_ref(), (width, height), &Pixels::Rgb8(rgb)).map_err(|error| error.to_string())?;
    Ok(path)
}
