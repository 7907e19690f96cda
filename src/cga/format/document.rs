//! In: a document, text with places where lines may break. Out: lines of at most [`WIDTH`] characters where that can be.
//!
//! A group is written on one line if it fits there and nothing in it needs a line of its own; otherwise all its [`Doc::Line`]s
//! break. [`Doc::Fill`] breaks by itself, where what follows up to the next possible break does not fit.

/// The line width that layouts aim at.
pub const WIDTH: usize = 100;

const INDENT: usize = 4;

#[derive(Clone, Debug)]
pub enum Doc {
    /// Bytes of the source, verbatim; may hold line ends (strings).
    Source(u32, u32),
    /// Bytes of the source that are a comment.
    Comment(u32, u32),
    Space,
    /// A space, or a line end in a broken group.
    Line,
    /// Nothing, or a line end in a broken group.
    Soft,
    /// A space, or a line end where what follows does not fit.
    Fill,
    Hard,
    /// What follows must stand on another line: behind a `//` comment.
    EndLine,
    /// What follows must begin a line.
    OwnLine,
    /// The next line end is followed by an empty line.
    Blank,
    /// Spaces in a broken group.
    Pad(usize),
    Indent(Vec<Doc>),
    Group(Group),
}

#[derive(Clone, Debug)]
pub struct Group {
    docs: Vec<Doc>,
    broken: bool,
}

/// A group, broken at once if `broken` or if something in it needs a line of its own.
pub fn group(docs: Vec<Doc>, broken: bool) -> Doc {
    let broken = broken || must_break(&docs);
    Doc::Group(Group { docs, broken })
}

/// Whether the text cannot stand on one line.
pub fn must_break(docs: &[Doc]) -> bool {
    Forced::default().look(docs)
}

#[derive(Default)]
struct Forced {
    line_ended: bool,
}

impl Forced {
    fn look(&mut self, docs: &[Doc]) -> bool {
        docs.iter().any(|doc| match doc {
            Doc::Hard | Doc::OwnLine => true,
            Doc::EndLine => {
                self.line_ended = true;
                false
            }
            Doc::Source(..) | Doc::Comment(..) => self.line_ended,
            Doc::Indent(inner) => self.look(inner),
            Doc::Group(inner) => inner.broken || self.look(&inner.docs),
            _ => false,
        })
    }
}

/// Writes a document with `newline` as line end, the last one included.
pub fn render(text: &str, docs: Vec<Doc>, newline: &'static str) -> String {
    let mut writer = Writer { newline, out: String::new(), column: 0, lines: 0, blank: false, space: false, pad: 0 };
    // What is left to write, the next on top.
    let mut left: Vec<Open> = docs.iter().rev().map(|doc| Open { indent: 0, broken: true, doc }).collect();
    while let Some(Open { indent, broken, doc }) = left.pop() {
        match doc {
            Doc::Line | Doc::Soft if broken => writer.line(),
            Doc::Line | Doc::Space => writer.space = true,
            Doc::Soft => {}
            Doc::Fill => {
                let room = WIDTH.saturating_sub(writer.column + 1);
                match broken && !chunk_fits(text, &left, room) {
                    true => writer.line(),
                    false => writer.space = true,
                }
            }
            Doc::Hard | Doc::EndLine => writer.line(),
            Doc::OwnLine => writer.fresh_line(),
            Doc::Blank => writer.blank = true,
            Doc::Pad(count) if broken => writer.pad = *count,
            Doc::Pad(_) => {}
            Doc::Source(start, end) => writer.write(indent, &text[*start as usize..*end as usize]),
            Doc::Comment(start, end) => writer.comment(indent, &text[*start as usize..*end as usize]),
            Doc::Indent(docs) => {
                left.extend(docs.iter().rev().map(|doc| Open { indent: indent + INDENT, broken, doc }));
            }
            Doc::Group(group) => {
                let broken = group.broken || !group_fits(text, group, &left, writer.room(indent));
                left.extend(group.docs.iter().rev().map(|doc| Open { indent, broken, doc }));
            }
        }
    }
    writer.finish()
}

#[derive(Clone, Copy)]
struct Open<'d> {
    indent: usize,
    broken: bool,
    doc: &'d Doc,
}

/// How measuring ended.
#[derive(Clone, Copy, PartialEq)]
enum Measure {
    /// All of it fits, with room left.
    Room(usize),
    /// It fits up to a place where the line can end.
    Ends,
    TooLong,
}

/// Whether a group fits on the line together with what follows it up to the next possible break.
fn group_fits(text: &str, group: &Group, rest: &[Open<'_>], room: usize) -> bool {
    let mut measure = measure(text, &group.docs, room, false);
    for open in rest.iter().rev() {
        match measure {
            Measure::Room(room) => measure = measure_one(text, open.doc, room, open.broken),
            _ => break,
        }
    }
    measure != Measure::TooLong
}

/// Whether what is left fits up to the next possible break, groups on one line.
fn chunk_fits(text: &str, rest: &[Open<'_>], room: usize) -> bool {
    let mut measure = Measure::Room(room);
    for open in rest.iter().rev() {
        match measure {
            Measure::Room(room) => {
                measure = match open.doc {
                    Doc::Group(group) if begins_with_break(&group.docs) => Measure::Ends,
                    Doc::Group(group) if group.broken => Measure::TooLong,
                    Doc::Group(group) => self::measure(text, &group.docs, room, false),
                    doc => measure_one(text, doc, room, true),
                }
            }
            _ => break,
        }
    }
    measure != Measure::TooLong
}

/// Whether a line can end in front of a group's first text, as in front of a body.
fn begins_with_break(docs: &[Doc]) -> bool {
    match docs.first() {
        Some(Doc::Line | Doc::Soft | Doc::Fill | Doc::Hard | Doc::OwnLine) => true,
        Some(Doc::Indent(inner)) => begins_with_break(inner),
        _ => false,
    }
}

fn measure(text: &str, docs: &[Doc], room: usize, broken: bool) -> Measure {
    let mut measure = Measure::Room(room);
    for doc in docs {
        match measure {
            Measure::Room(room) => measure = measure_one(text, doc, room, broken),
            _ => break,
        }
    }
    measure
}

fn measure_one(text: &str, doc: &Doc, room: usize, broken: bool) -> Measure {
    let takes = |count: usize| room.checked_sub(count).map_or(Measure::TooLong, Measure::Room);
    match doc {
        Doc::Line | Doc::Soft | Doc::Fill if broken => Measure::Ends,
        Doc::Hard | Doc::EndLine | Doc::OwnLine => Measure::Ends,
        Doc::Line | Doc::Fill | Doc::Space => takes(1),
        Doc::Soft | Doc::Blank | Doc::Pad(_) => Measure::Room(room),
        Doc::Source(start, end) => {
            let written = &text[*start as usize..*end as usize];
            match written.find('\n') {
                Some(_) => Measure::Ends,
                // No more characters than bytes: count only where it matters.
                None => takes(if written.len() <= room { written.chars().count() } else { width(written, room) }),
            }
        }
        // Comments may stand beyond the width.
        Doc::Comment(..) => Measure::Room(room),
        Doc::Indent(docs) => measure(text, docs, room, broken),
        Doc::Group(group) => measure(text, &group.docs, room, broken && group.broken),
    }
}

/// The number of characters, counted no further than just beyond `room`.
fn width(text: &str, room: usize) -> usize {
    text.chars().take(room + 1).count()
}

struct Writer {
    newline: &'static str,
    out: String,
    /// Characters on the current line.
    column: usize,
    /// Line ends to be written before the next text.
    lines: usize,
    blank: bool,
    space: bool,
    /// Spaces in front of the next token.
    pad: usize,
}

impl Writer {
    fn line(&mut self) {
        self.lines = self.lines.max(1);
    }

    fn fresh_line(&mut self) {
        if self.column > 0 {
            self.line();
        }
    }

    /// The characters that fit on the line if something is written now at `indent`.
    fn room(&self, indent: usize) -> usize {
        let start = if self.lines > 0 || self.column == 0 { indent } else { self.column + usize::from(self.space) };
        WIDTH.saturating_sub(start)
    }

    /// Ends lines as asked for and moves to where text goes on.
    fn move_on(&mut self, indent: usize) {
        let at_start = self.out.is_empty();
        if self.lines > 0 && !at_start {
            self.out.push_str(self.newline);
            if self.blank {
                self.out.push_str(self.newline);
            }
            self.column = 0;
        } else if self.space && self.column > 0 {
            self.out.push(' ');
            self.column += 1;
        }
        (self.lines, self.blank, self.space) = (0, false, false);
        if self.column == 0 {
            self.out.extend(std::iter::repeat_n(' ', indent));
            self.column = indent;
        }
    }

    fn write(&mut self, indent: usize, written: &str) {
        self.move_on(indent);
        let pad = std::mem::take(&mut self.pad);
        self.out.extend(std::iter::repeat_n(' ', pad));
        self.column += pad;
        self.out.push_str(written);
        match written.rfind('\n') {
            Some(end) => self.column = written[end + 1..].chars().count().max(1),
            None => self.column += written.chars().count(),
        }
    }

    /// A comment of several lines keeps its text; where every line begins with `*` the stars stand below each other.
    fn comment(&mut self, indent: usize, written: &str) {
        self.move_on(indent);
        let mut lines = written.lines();
        let first = lines.next().unwrap_or("").trim_end();
        self.out.push_str(first);
        self.column += first.chars().count();
        let starred = written.lines().skip(1).all(|line| line.trim_start().starts_with('*'));
        let indent = indent.min(self.column);
        for line in lines {
            self.out.push_str(self.newline);
            let line = line.trim_end();
            let line = if starred { line.trim_start() } else { line };
            if starred {
                self.out.extend(std::iter::repeat_n(' ', indent + 1));
            }
            self.out.push_str(line);
            self.column = line.chars().count().max(1);
        }
    }

    fn finish(mut self) -> String {
        if !self.out.is_empty() {
            self.out.push_str(self.newline);
        }
        self.out
    }
}
