//! App: the loop of the window. In: the system's events, reports of the threads. Out: passes of egui on the screen, orders
//! to the threads, events for those who listen. Nothing here waits for a build or a drawing.

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{Key, ViewportId};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::{Window, WindowId};

use super::builder::{Builder, PickOrder};
use super::desk::{Desk, Show, free_name};
use super::drawer::{Drawer, Screenshot};
use super::error::WindowError;
use super::events;
use super::painter::{Painted, Painter};
use super::panels::{self, Action, Canvas};
use super::report::Report;
use super::take::Care;
use super::theme;
use super::{Options, Say};

/// Hands rest for this long before the picture is drawn with full care.
const REST: Duration = Duration::from_millis(220);

/// The window with egui on it.
struct Glass {
    window: Arc<Window>,
    painter: Painter,
    input: egui_winit::State,
    context: egui::Context,
}

/// Everything that lives as long as the loop.
pub struct App {
    options: Options,
    say: Say,
    desk: Desk,
    canvas: Canvas,
    builder: Builder,
    drawer: Drawer,
    glass: Option<Glass>,
    /// When the picture is to be drawn with full care.
    rest: Option<Instant>,
    /// When egui wants another pass.
    repaint: Option<Instant>,
    /// Number of the last wish that was told to be on the screen.
    told: u64,
    pub failed: Option<WindowError>,
}

impl App {
    pub fn new(options: Options, say: Say, builder: Builder, drawer: Drawer) -> App {
        let name = options.recipe.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut desk = Desk::new(name);
        desk.view_name = options.view.clone().unwrap_or_default();
        (desk.show, desk.overrides.scene) = (options.show, options.scene.clone());
        App {
            options,
            say,
            desk,
            canvas: Canvas::default(),
            builder,
            drawer,
            glass: None,
            rest: None,
            repaint: None,
            told: 0,
            failed: None,
        }
    }

    fn open(&self, event_loop: &ActiveEventLoop) -> Result<Glass, WindowError> {
        let monitor = event_loop.primary_monitor().or_else(|| event_loop.available_monitors().next());
        let most = monitor.map(|monitor| monitor.size().to_logical::<u32>(monitor.scale_factor()));
        let (width, height) = self.options.size;
        let (width, height) = most.map_or((width, height), |most| (width.min(most.width), height.min(most.height)));
        let attributes = Window::default_attributes()
            .with_title(format!("{} · Mansard", self.desk.name))
            .with_inner_size(LogicalSize::new(width, height))
            .with_min_inner_size(LogicalSize::new(760, 480));
        let window =
            event_loop.create_window(attributes).map_err(|e| WindowError::NoDisplay { reason: e.to_string() })?;
        glass(Arc::new(window), event_loop)
    }

    fn redraw(&self) {
        if let Some(glass) = &self.glass {
            glass.window.request_redraw();
        }
    }

    /// One pass of egui, and what it asks for.
    fn pass(&mut self, event_loop: &ActiveEventLoop) {
        let Some(glass) = &mut self.glass else { return };
        let input = glass.input.take_egui_input(&glass.window);
        let (desk, canvas, mut actions) = (&mut self.desk, &mut self.canvas, Vec::new());
        let mut output = glass.context.run_ui(input, |ui| {
            keys(ui, desk, &mut actions);
            panels::show(ui, desk, canvas, &mut actions);
        });
        glass.input.handle_platform_output(&glass.window, output.platform_output);
        let delay = output.viewport_output.get(&ViewportId::ROOT).map_or(Duration::MAX, |root| root.repaint_delay);
        self.repaint = Instant::now().checked_add(delay);
        let scale = output.pixels_per_point;
        let shapes = glass.context.tessellate(output.shapes, scale);
        match glass.painter.paint(&shapes, std::mem::take(&mut output.textures_delta), scale) {
            Painted::Shown => self.tell_frame(scale),
            Painted::Later => self.repaint = Some(Instant::now() + Duration::from_millis(16)),
            Painted::Lost => self.reopen(event_loop),
        }
        actions.into_iter().for_each(|action| self.act(action));
    }

    fn tell_frame(&mut self, scale: f32) {
        let Some(rect) = self.canvas.rect.filter(|_| self.canvas.presented > self.told) else { return };
        self.told = self.canvas.presented;
        let event = events::frame(&self.desk, rect * scale);
        event.into_iter().for_each(|event| (self.say)(&event.to_string()));
    }

    /// Another painter on the same window; egui begins anew, the desk stays.
    fn reopen(&mut self, event_loop: &ActiveEventLoop) {
        let Some(Glass { window, .. }) = self.glass.take() else { return };
        self.canvas = Canvas::default();
        match glass(window, event_loop) {
            Ok(glass) => {
                self.glass = Some(glass);
                self.desk.note = Some("the window's adapter was lost and opened again".to_owned());
                self.redraw();
            }
            Err(error) => {
                self.failed = Some(error);
                event_loop.exit();
            }
        }
    }

    fn act(&mut self, action: Action) {
        match action {
            Action::Look { moving: false } => self.look(Care::Full),
            Action::Look { moving: true } => {
                self.look(Care::Draft);
                self.rest = Some(Instant::now() + REST);
            }
            Action::Choose => {
                self.desk.building = true;
                self.builder.choose(self.desk.overrides.clone());
            }
            Action::Pick { kind, at } => {
                if let Some((instance, state, ray)) = self.desk.pick(kind, at) {
                    self.builder.pick(PickOrder { instance, state, ray });
                }
            }
            Action::Deselect => self.desk.picked = None,
            Action::Screenshot => self.screenshot(),
            Action::Copy(text) => {
                (self.say)(&events::copied(&text).to_string());
                self.desk.note = Some(format!("copied {text}"));
                if let Some(glass) = &self.glass {
                    glass.context.copy_text(text);
                }
            }
        }
        self.redraw();
    }

    fn look(&mut self, care: Care) {
        self.rest = None;
        if let Some(wish) = self.desk.wish(care) {
            self.drawer.draw(wish);
        }
    }

    fn screenshot(&mut self) {
        let path = free_name(&self.options.screenshots, &self.desk.name);
        let before = self.desk.wished;
        let wish = self.desk.wish(Care::Full);
        // A file is no picture on the screen.
        self.desk.wished = before;
        if let Some(wish) = wish {
            self.desk.note = Some("saving".to_owned());
            self.drawer.save(Screenshot { wish, bar: self.desk.bar, path });
        }
    }

    fn report(&mut self, report: Report) {
        match report {
            Report::Building => self.desk.building = true,
            Report::Built(shown) => {
                self.desk.take_over(shown);
                self.look(Care::Full);
                // What was clicked was made again.
                if let Some(picked) = &self.desk.picked {
                    let (instance, state, ray) = (picked.instance, picked.state, picked.ray);
                    self.builder.pick(PickOrder { instance, state, ray });
                }
            }
            Report::Updated(update) => {
                (self.say)(&update.json_line());
                if !update.cancelled {
                    self.desk.building = false;
                    self.desk.update = Some(*update);
                }
            }
            Report::Picked(lot) => self.picked(lot.map(|lot| *lot)),
            Report::Drawn(drawn) => {
                self.desk.drawing_failed = None;
                self.desk.drawn = Some(*drawn);
            }
            Report::NotDrawn(reason) => self.desk.drawing_failed = Some(reason),
            Report::Saved(path) => {
                (self.say)(&events::screenshot(&path).to_string());
                self.desk.note = Some(format!("saved {}", path.display()));
            }
            Report::NotSaved(reason) => self.desk.note = Some(format!("not saved: {reason}")),
        }
        self.redraw();
    }

    fn picked(&mut self, lot: Option<crate::live::LotInfo>) {
        let Some(mut picked) = self.desk.picked.take() else { return };
        let other = |old: &crate::live::LotInfo| lot.as_ref().is_none_or(|new| new.feature != old.feature);
        // The answer to an earlier click, or an object that an edit of the map took away.
        if lot.as_ref().is_some_and(|lot| lot.instance != picked.instance) || picked.lot.as_ref().is_some_and(other) {
            self.desk.picked = picked.lot.is_none().then_some(picked);
            return;
        }
        picked.lot = lot;
        (self.say)(&events::picked(&self.desk, &picked).to_string());
        self.desk.picked = picked.lot.is_some().then_some(picked);
    }
}

fn glass(window: Arc<Window>, event_loop: &ActiveEventLoop) -> Result<Glass, WindowError> {
    let painter = Painter::open(window.clone(), event_loop.owned_display_handle())?;
    let context = egui::Context::default();
    theme::apply(&context);
    let most = Some(painter.max_texture());
    let scale = Some(window.scale_factor() as f32);
    let input = egui_winit::State::new(context.clone(), ViewportId::ROOT, &*window, scale, None, most);
    window.request_redraw();
    Ok(Glass { window, painter, input, context })
}

fn keys(ui: &egui::Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let pressed = |key: Key| ui.input(|input| input.modifiers.is_none() && input.key_pressed(key));
    let asked = ui.input(|input| input.key_pressed(Key::Questionmark) || input.key_pressed(Key::F1));
    let mut show = [(Key::Num1, Show::Before), (Key::Num2, Show::After), (Key::Num3, Show::Mask)]
        .into_iter()
        .find(|(key, _)| pressed(*key))
        .map(|(_, show)| show);
    if !desk.flying && pressed(Key::S) {
        show = Some(if desk.show == Show::Split { Show::After } else { Show::Split });
    }
    if let Some(show) = show.filter(|show| *show != desk.show) {
        desk.show = show;
        actions.push(Action::Look { moving: false });
    }
    if pressed(Key::F) {
        desk.frame_scene();
        actions.push(Action::Look { moving: false });
    }
    if pressed(Key::R) && desk.shown.is_some() {
        desk.reroll();
        actions.push(Action::Choose);
    }
    if pressed(Key::P) {
        actions.push(Action::Screenshot);
    }
    if pressed(Key::Escape) {
        if desk.help { desk.help = false } else { actions.push(Action::Deselect) }
    }
    desk.flying ^= pressed(Key::G);
    desk.help ^= asked;
}

impl ApplicationHandler<Report> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.glass.is_some() {
            return;
        }
        match self.open(event_loop) {
            Ok(glass) => self.glass = Some(glass),
            Err(error) => {
                self.failed = Some(error);
                event_loop.exit();
            }
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, report: Report) {
        self.report(report);
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(glass) = &mut self.glass else { return };
        let response = glass.input.on_window_event(&glass.window, &event);
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => {
                glass.painter.resize(size.width, size.height);
                glass.window.request_redraw();
            }
            WindowEvent::RedrawRequested => self.pass(event_loop),
            _ if response.repaint => glass.window.request_redraw(),
            _ => {}
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, _: StartCause) {
        let now = Instant::now();
        if self.rest.is_some_and(|rest| rest <= now) {
            self.look(Care::Full);
            self.redraw();
        }
        if self.repaint.is_some_and(|repaint| repaint <= now) {
            self.repaint = None;
            self.redraw();
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let next = self.rest.into_iter().chain(self.repaint).min();
        event_loop.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }
}
