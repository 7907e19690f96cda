//! What may be written at a place of a rule file, however broken the text is. In: a text and a byte offset. Out: the
//! [`Spot`], the call around it and the names that the declaration brings.
//!
//! It reads the tokens of the declaration up to the place, once, with a stack of open brackets; no tree is needed.

use crate::cga::builtins::Operation;
use crate::cga::parse::lex;
use crate::cga::parse::tokens::{Tokens, letter};

/// What may stand at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Spot {
    /// A comment, a name that is being declared, a number.
    Nothing,
    /// A declaration.
    Declaration,
    /// The name of an annotation.
    Annotation,
    /// An argument of this annotation.
    AnnotationArgument(String),
    /// A rule, an operation or a shape.
    Sequence,
    /// A value; with a call around it perhaps one of its keywords.
    Expression,
    /// A selector of a block.
    Selector,
    /// A name in the parentheses of this import.
    Override(String),
    /// The file of an import; the text begins at this offset.
    ImportPath(u32),
    /// Any other text.
    Text(u32),
}

/// A call whose parentheses are open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Call {
    pub name: String,
    /// Number of the argument at the place, from 0.
    pub argument: usize,
    /// Whether it stands where a value does, not in a sequence.
    pub is_value: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Context {
    pub spot: Spot,
    /// Where the dotted name begins that ends at the place.
    pub start: u32,
    pub call: Option<Call>,
    /// Parameters and locals of the declaration.
    pub locals: Vec<String>,
}

/// What one open bracket holds.
#[derive(Clone, Debug)]
struct Frame {
    open: u8,
    call: Option<Call>,
    mode: Mode,
    /// Mode behind the colon of a selector, size or condition.
    body: Mode,
    /// Colons that stand before the body of a block's part, and those still to come; none in other brackets.
    colons: (u32, u32),
    in_case: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Header,
    Sequence,
    Expression,
    Selector,
    Annotation,
    Import,
}

/// Reads up to `offset`.
pub fn context(text: &str, offset: u32) -> Context {
    let tokens = lex(text, 0);
    let at = offset as usize;
    let none = |spot| Context { spot, start: offset, call: None, locals: Vec::new() };
    let inside = |c: &crate::cga::parse::tokens::Comment| {
        let is_open = !text[..c.end as usize].ends_with("*/") || !text[c.start as usize..].starts_with("/*");
        (c.start as usize) < at && (at < c.end as usize || (is_open && at == c.end as usize))
    };
    if tokens.comments.iter().any(inside) {
        return none(Spot::Nothing);
    }
    let before = &text[..at];
    let start = before
        .rfind(|c: char| !(c.is_alphanumeric() || c == '_' || c == '.'))
        .map_or(0, |i| i + before[i..].chars().next().map_or(1, char::len_utf8));
    let string = open_text(text, &tokens, at);
    let end = string.map_or(start, |s| s as usize - 1);
    let limit = tokens.places.partition_point(|place| (place.start as usize) < end);
    let mut reader = Reader { text, tokens: &tokens, stack: Vec::new(), locals: Vec::new() };
    let first = reader.declaration(limit);
    reader.read(first, limit);
    let mut out = reader.finish(limit, start, before);
    if let Some(start) = string {
        out.start = start;
        out.spot = if out.spot == Spot::Override(String::new()) { Spot::ImportPath(start) } else { Spot::Text(start) };
    } else if out.spot == Spot::Override(String::new()) {
        out.spot = Spot::Nothing;
    }
    out
}

/// Where the content of the string begins that `at` lies in.
fn open_text(text: &str, tokens: &Tokens, at: usize) -> Option<u32> {
    let index = tokens.places.partition_point(|place| (place.start as usize) < at).checked_sub(1)?;
    let place = tokens.places[index];
    if !text[place.start as usize..].starts_with('"') {
        return None;
    }
    let closed = tokens.letter(index) == letter::STRING;
    let inside = if closed { at < place.end as usize } else { at <= place.end as usize };
    inside.then_some(place.start + 1)
}

struct Reader<'t> {
    text: &'t str,
    tokens: &'t Tokens,
    /// The declaration itself first.
    stack: Vec<Frame>,
    locals: Vec<String>,
}

fn frame(open: u8, mode: Mode) -> Frame {
    Frame { open, call: None, mode, body: mode, colons: (0, 0), in_case: false }
}

impl Reader<'_> {
    /// The token that begins the declaration in front of token `limit`.
    fn declaration(&self, limit: usize) -> usize {
        let begins = |i: &usize| match self.tokens.letter(*i) {
            letter::ATTR | letter::CONST | letter::IMPORT | letter::STYLE | letter::VERSION | b'@' => true,
            letter::MODIFIER | letter::RULE | letter::FUNCTION => self.tokens.begins_line(self.text, *i),
            _ => self.begins_header(*i, limit),
        };
        (0..limit).rev().find(begins).unwrap_or(0)
    }

    /// Whether a name at the margin has open parentheses: the parameters of a declaration that is being written.
    fn begins_header(&self, i: usize, limit: usize) -> bool {
        let at_margin =
            self.tokens.places[i].start == 0 || self.text[..self.tokens.places[i].start as usize].ends_with('\n');
        let open = |from: usize| {
            (from..limit).fold(0i32, |depth, j| {
                depth + i32::from(self.tokens.letter(j) == b'(') - i32::from(self.tokens.letter(j) == b')')
            })
        };
        at_margin
            && self.is_name(i)
            && self.tokens.letter(i + 1) == b'('
            && Operation::from_name(self.name(i)).is_none()
            && i + 1 < limit
            && open(i + 1) > 0
    }

    fn name(&self, index: usize) -> &str {
        self.tokens.text(self.text, index)
    }

    fn is_name(&self, index: usize) -> bool {
        self.tokens.letter(index).is_ascii_lowercase()
    }

    fn read(&mut self, first: usize, limit: usize) {
        let mode = match self.tokens.letter(first) {
            b'@' => Mode::Annotation,
            letter::IMPORT => Mode::Import,
            _ => Mode::Header,
        };
        self.stack.push(frame(0, mode));
        for i in first..limit {
            self.token(i, first);
        }
    }

    fn top(&mut self) -> &mut Frame {
        self.stack.last_mut().expect("the declaration is never closed")
    }

    fn token(&mut self, i: usize, first: usize) {
        let kind = self.tokens.letter(i);
        match kind {
            b'(' => self.open_call(i, first),
            b'[' => {
                let mode = if self.top().mode == Mode::Sequence { Mode::Sequence } else { Mode::Expression };
                self.stack.push(frame(b'[', mode));
            }
            b'{' => self.open_block(i),
            b')' => self.close(b'('),
            b']' => self.close(b'['),
            b'}' => self.close(b'{'),
            letter::ARROW => {
                let mode = if self.top().mode == Mode::Import { Mode::Import } else { Mode::Sequence };
                *self.top() = Frame { mode, body: mode, ..self.top().clone() };
            }
            b'=' if self.stack.len() == 1 && self.top().mode == Mode::Header => {
                *self.top() = Frame { mode: Mode::Expression, body: Mode::Expression, ..self.top().clone() };
            }
            letter::DEFINE => {
                let name = self.name(i.saturating_sub(1)).to_owned();
                self.locals.push(name);
                self.top().mode = Mode::Expression;
            }
            letter::CASE => {
                let top = self.top();
                (top.in_case, top.mode) = (true, Mode::Expression);
            }
            letter::ELSE => self.top().in_case = true,
            letter::PERCENT => {}
            b':' | letter::CONNECTED => self.colon(),
            // `top = Roof` in a selector.
            b'=' if self.top().colons.1 > 0 => self.colon(),
            b'|' => {
                let top = self.top();
                if top.colons.0 > 0 {
                    top.colons.1 = top.colons.0;
                    top.in_case = false;
                    let selects = top.call.as_ref().is_some_and(|call| selects(&call.name));
                    top.mode = if selects { Mode::Selector } else { Mode::Expression };
                }
            }
            b',' => {
                let top = self.top();
                if let Some(call) = &mut top.call {
                    call.argument += 1;
                }
                if top.mode == Mode::Expression && top.body == Mode::Header {
                    top.mode = Mode::Header;
                }
            }
            _ if self.is_name(i) && self.declares(i) => {
                let name = self.name(i).to_owned();
                self.locals.push(name);
            }
            _ => {}
        }
    }

    /// Whether a name is a parameter; what `:=` follows is taken there.
    fn declares(&mut self, i: usize) -> bool {
        let in_header = self.top().mode == Mode::Header && self.top().open == b'(';
        in_header && self.tokens.letter(i + 1) != letter::DEFINE
    }

    /// Behind a condition, a percentage, a selector or a size.
    fn colon(&mut self) {
        let top = self.top();
        if top.in_case {
            (top.in_case, top.mode) = (false, top.body);
        } else if top.colons.1 > 0 {
            top.colons.1 -= 1;
            if top.colons.1 == 0 {
                top.mode = top.body;
            }
        }
    }

    fn open_call(&mut self, i: usize, first: usize) {
        let outer = self.top().mode;
        let previous = i.checked_sub(1).filter(|&p| p >= first && self.is_name(p));
        let mode = match outer {
            // The parameters of a declaration, or what stands behind `with`.
            Mode::Header => Mode::Header,
            Mode::Annotation => Mode::Annotation,
            Mode::Import => Mode::Import,
            Mode::Sequence | Mode::Expression | Mode::Selector => Mode::Expression,
        };
        let called = matches!(outer, Mode::Sequence | Mode::Expression | Mode::Selector);
        let call = previous.filter(|_| called || outer == Mode::Annotation).map(|p| Call {
            name: self.name(p).to_owned(),
            argument: 0,
            is_value: outer != Mode::Sequence,
        });
        self.stack.push(Frame { call, ..frame(b'(', mode) });
    }

    fn open_block(&mut self, i: usize) {
        let owner = self.owner(i);
        // A block inside a block stands where its sizes do, and holds what it holds.
        let nested = self.top().colons.0 > 0 && matches!(self.tokens.letter(i.wrapping_sub(1)), b'{' | b'|');
        let around = if nested { self.top().body } else { self.top().mode };
        let is_value = around != Mode::Sequence;
        let body = if is_value { Mode::Expression } else { Mode::Sequence };
        let (colons, mode) = match owner.as_str() {
            "splitAndSetbackPerimeter" => (2, Mode::Expression),
            "split" | "splitArea" => (1, Mode::Expression),
            name if selects(name) => (1, Mode::Selector),
            _ => (0, body),
        };
        let call = Some(Call { name: owner, argument: 0, is_value });
        self.stack.push(Frame { call, mode, body, colons: (colons, colons), ..frame(b'{', mode) });
    }

    /// The operation that a block belongs to: the name in front of its parentheses, or directly in front of it. A block
    /// inside a block of the same operation repeats its form.
    fn owner(&self, i: usize) -> String {
        let mut at = i;
        if at > 0 && self.tokens.letter(at - 1) == b')' {
            let mut depth = 0;
            while at > 0 {
                at -= 1;
                match self.tokens.letter(at) {
                    b')' => depth += 1,
                    b'(' => depth -= 1,
                    _ => {}
                }
                if depth == 0 {
                    break;
                }
            }
        }
        match at.checked_sub(1) {
            Some(p) if self.is_name(p) => self.name(p).to_owned(),
            Some(p) if self.tokens.letter(p) == b'}' => "setback".to_owned(),
            _ => self.stack.last().and_then(|f| f.call.as_ref()).map(|c| c.name.clone()).unwrap_or_default(),
        }
    }

    fn close(&mut self, open: u8) {
        if let Some(at) = self.stack.iter().rposition(|frame| frame.open == open) {
            self.stack.truncate(at);
        }
        if self.stack.is_empty() {
            self.stack.push(frame(0, Mode::Sequence));
        }
    }

    fn finish(mut self, limit: usize, start: usize, before: &str) -> Context {
        let top = self.top().clone();
        let previous = limit.checked_sub(1).map_or(0, |p| self.tokens.letter(p));
        let begins_line = before[..start].rsplit('\n').next().is_some_and(|line| line.trim().is_empty());
        // A name at the very start of a line begins a declaration; indented ones go on with what stands before.
        let at_margin = before[..start].is_empty() || before[..start].ends_with('\n');
        let is_digit = before[start..].starts_with(|c: char| c.is_ascii_digit());
        let spot = match top.mode {
            _ if is_digit => Spot::Nothing,
            Mode::Annotation if previous == b'@' => Spot::Annotation,
            Mode::Annotation if top.open == b'(' => {
                Spot::AnnotationArgument(top.call.as_ref().map(|c| c.name.clone()).unwrap_or_default())
            }
            _ if self.stack.len() == 1 && (at_margin || limit == 0) => Spot::Declaration,
            Mode::Annotation => Spot::Declaration,
            Mode::Header if begins_line && self.stack.len() == 1 => Spot::Declaration,
            Mode::Header => Spot::Nothing,
            Mode::Import if top.open == b'(' => Spot::Override(self.name(self.declaration(limit) + 1).to_owned()),
            // The caller knows whether the cursor is in the string of an import.
            Mode::Import => Spot::Override(String::new()),
            Mode::Sequence => Spot::Sequence,
            Mode::Expression => Spot::Expression,
            Mode::Selector => Spot::Selector,
        };
        let call = self.stack.iter().rev().find(|f| f.open == b'(').and_then(|f| f.call.clone());
        let call = call.filter(|_| top.open != b'{' && top.open != 0);
        self.locals.dedup();
        Context { spot, start: start as u32, call, locals: self.locals }
    }
}

/// Whether the parts of an operation's block begin with selectors.
fn selects(name: &str) -> bool {
    Operation::from_name(name).is_some_and(|operation| {
        matches!(
            operation,
            Operation::Comp
                | Operation::Modify
                | Operation::Setback
                | Operation::SetbackPerEdge
                | Operation::SetbackToArea
                | Operation::ShapeL
                | Operation::ShapeU
                | Operation::ShapeO
                | Operation::InnerRectangle
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The context at `¦`.
    fn at(marked: &str) -> Context {
        let offset = marked.find('¦').expect("a mark");
        context(&marked.replace('¦', ""), offset as u32)
    }

    #[test]
    fn the_spot_is_known_in_broken_text() {
        use Spot as S;
        let cases = [
            ("¦", S::Declaration),
            ("at¦", S::Declaration),
            ("A --> B\n\nat¦", S::Declaration),
            ("@Ra¦", S::Annotation),
            ("@Range(mi¦", S::AnnotationArgument("Range".to_owned())),
            ("A --> ex¦", S::Sequence),
            ("A -->\n    extrude(3)\n    co¦", S::Sequence),
            ("A --> extrude(w¦", S::Expression),
            ("A --> comp(f) { fr¦", S::Selector),
            ("A --> comp(f) { front : Wa¦", S::Sequence),
            ("A --> comp(f) { front : Wall | to¦ }\nB --> C", S::Selector),
            ("A --> split(x) { 3 : B | ~wi¦", S::Expression),
            ("A --> split(x) { { 3 : B | ~1 : Wi¦", S::Sequence),
            ("A --> case wi¦", S::Expression),
            ("A --> case w > 1 : Wi¦", S::Sequence),
            ("A --> 30% : Wi¦", S::Sequence),
            ("A(width) --> ¦", S::Sequence),
            ("A(wid¦", S::Nothing),
            ("A --> B\nC(wid¦", S::Nothing),
            ("A -->\nextrude(wid¦", S::Expression),
            ("attr a = he¦", S::Expression),
            ("attr a = 1¦", S::Nothing),
            ("// a comm¦", S::Nothing),
            ("A --> splitAndSetbackPerimeter(1) { 3 : wi¦", S::Expression),
            ("A --> setback(2) { remai¦", S::Selector),
            ("A --> inline(append) { Wi¦", S::Sequence),
            ("import a : \"b.cga\" (hei¦", S::Override("a".to_owned())),
        ];
        for (text, spot) in cases {
            assert_eq!(at(text).spot, spot, "{text}");
        }
    }

    #[test]
    fn texts_begin_behind_their_quote() {
        assert_eq!(at("import a : \"rules/¦").spot, Spot::ImportPath(12));
        assert_eq!(at("A --> texture(\"a/¦b\")").spot, Spot::Text(15));
        assert_eq!(at("A --> texture(\"a/b\"¦)").spot, Spot::Expression);
    }

    #[test]
    fn the_call_and_its_argument_are_known() {
        let call = at("A --> extrude(world.up, max(1, h¦").call.expect("a call");
        assert_eq!((call.name.as_str(), call.argument, call.is_value), ("max", 1, true));
        let call = at("A --> extrude(world.up, max(1, h), ¦").call.expect("a call");
        assert_eq!((call.name.as_str(), call.argument, call.is_value), ("extrude", 2, false));
        assert_eq!(at("A --> comp(f) { top : ¦").call, None);
    }

    #[test]
    fn parameters_and_locals_are_in_scope() {
        let found = at("A(width, n) with( half := width / 2 ) --> extrude(ha¦");
        assert_eq!(found.locals, ["width", "n", "half"]);
        assert_eq!(at("A(x) --> B\nB(y) --> extrude(¦").locals, ["y"]);
    }

    #[test]
    fn a_dotted_name_is_one_name() {
        assert_eq!(at("A --> extrude(scope.¦").start, 14);
        assert_eq!(at("A --> lib.Wa¦").start, 6);
    }
}
