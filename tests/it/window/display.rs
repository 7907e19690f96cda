//! A display of its own for a test. In: nothing but Xvfb. Out: pixels of the screen, clicks and keys.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use image::RgbImage;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt as _, ImageFormat, InputFocus, MapState, Window};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

pub const SIZE: (u16, u16) = (1280, 800);

// X11's numbers of events.
const KEY_PRESS: u8 = 2;
const KEY_RELEASE: u8 = 3;
const BUTTON_PRESS: u8 = 4;
const BUTTON_RELEASE: u8 = 5;
const MOTION: u8 = 6;

/// An X server without a screen, and a connection to it.
pub struct Display {
    server: Child,
    /// Such as `:3`.
    pub name: String,
    connection: RustConnection,
    root: Window,
}

impl Display {
    /// `None`, with a printed line, where Xvfb is not installed (a failure in CI).
    pub fn open() -> Option<Display> {
        let size = format!("{}x{}x24", SIZE.0, SIZE.1);
        let started = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", &size, "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = match started {
            Ok(server) => server,
            Err(error) => {
                let what = format!("Xvfb does not start ({error}): install the Debian package xvfb");
                assert!(std::env::var_os("CI").is_none(), "{what}");
                eprintln!("skipped: {what}");
                return None;
            }
        };
        let mut number = String::new();
        let stdout = server.stdout.take().expect("it is piped");
        BufReader::new(stdout).read_line(&mut number).expect("Xvfb prints its number");
        let name = format!(":{}", number.trim());
        let (connection, screen) = x11rb::connect(Some(&name)).expect("Xvfb listens");
        let root = connection.setup().roots[screen].root;
        Some(Display { server, name, connection, root })
    }

    /// What is on the screen.
    pub fn picture(&self) -> RgbImage {
        let (width, height) = SIZE;
        let image = self.connection.get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, width, height, !0);
        let data = image.expect("asked").reply().expect("the screen can be read").data;
        let rgb = data.as_chunks::<4>().0.iter().flat_map(|&[b, g, r, _]| [r, g, b]).collect();
        RgbImage::from_vec(width.into(), height.into(), rgb).expect("four bytes per pixel")
    }

    fn fake(&self, kind: u8, detail: u8, (x, y): (i16, i16)) {
        let request = self.connection.xtest_fake_input(kind, detail, 0, self.root, x, y, 0);
        request.expect("asked").check().expect("the server has XTEST");
        // As hands do: the program sees one thing after the other.
        std::thread::sleep(Duration::from_millis(60));
    }

    pub fn move_to(&self, x: i16, y: i16) {
        self.fake(MOTION, 0, (x, y));
    }

    pub fn click(&self, x: i16, y: i16) {
        self.move_to(x, y);
        self.fake(BUTTON_PRESS, 1, (0, 0));
        self.fake(BUTTON_RELEASE, 1, (0, 0));
    }

    pub fn drag(&self, from: (i16, i16), to: (i16, i16)) {
        self.move_to(from.0, from.1);
        self.fake(BUTTON_PRESS, 1, (0, 0));
        // Slowly enough for a window that is drawn in software beside a scene that is.
        for step in 1..=10 {
            let along = |a: i16, b: i16| a + (b - a) * step / 10;
            self.move_to(along(from.0, to.0), along(from.1, to.1));
            std::thread::sleep(Duration::from_millis(140));
        }
        self.fake(BUTTON_RELEASE, 1, (0, 0));
    }

    /// Gives the keyboard to the program's window, as a window manager would.
    pub fn focus(&self) {
        let tree = self.connection.query_tree(self.root).expect("asked").reply().expect("the root has a tree");
        let shown = |window: &&Window| {
            let attributes = self.connection.get_window_attributes(**window).expect("asked").reply();
            attributes.is_ok_and(|attributes| attributes.map_state == MapState::VIEWABLE)
        };
        let window = *tree.children.iter().find(shown).expect("the program has a window");
        let focus = self.connection.set_input_focus(InputFocus::PARENT, window, x11rb::CURRENT_TIME);
        focus.expect("asked").check().expect("the window takes the keyboard");
        std::thread::sleep(Duration::from_millis(200));
    }

    /// Presses the key that types this character without Shift.
    pub fn key(&self, character: char) {
        let setup = self.connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let mapping = self.connection.get_keyboard_mapping(first, last - first + 1);
        let mapping = mapping.expect("asked").reply().expect("there is a keyboard");
        let mut keys = mapping.keysyms.chunks(mapping.keysyms_per_keycode.into());
        let at = keys.position(|key| key[0] == u32::from(character)).expect("the keyboard has the key");
        let code = first + u8::try_from(at).expect("a key code is a byte");
        self.fake(KEY_PRESS, code, (0, 0));
        self.fake(KEY_RELEASE, code, (0, 0));
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ended = self.server.kill();
        let _status = self.server.wait();
    }
}
