//! In: bytes. Out: a syntactically correct program with every form of the grammar, comments and line breaks anywhere.

/// Draws from bytes; zeros once they are used up, which end every recursion.
pub struct Choices<'b> {
    bytes: std::slice::Iter<'b, u8>,
    out: String,
    comments: usize,
    /// One gap in so many is more than a space.
    plain: usize,
}

const GAPS: &[&str] = &[
    " ",
    " ",
    " ",
    " ",
    "  ",
    "\n",
    "\n    ",
    "\n\n",
    "\n\n\n",
    "\t",
    " // ",
    " # ",
    " /* ",
    " /**\n * ",
    "\n// ",
    "\n/* ",
];

impl<'b> Choices<'b> {
    pub fn new(bytes: &'b [u8]) -> Self {
        let plain = [1, 3, 20, 60][usize::from(bytes.first().copied().unwrap_or(0)) % 4];
        Choices { bytes: bytes.iter(), out: String::new(), comments: 0, plain }
    }

    pub fn program(mut self) -> String {
        if self.draw(2) == 1 {
            self.words(&["version", "\"2025.1\""]);
        }
        for _ in 0..self.draw(6) {
            self.declaration();
        }
        self.out
    }

    fn draw(&mut self, below: usize) -> usize {
        usize::from(self.bytes.next().copied().unwrap_or(0)) % below
    }

    fn pick<'s>(&mut self, from: &[&'s str]) -> &'s str {
        from[self.draw(from.len())]
    }

    /// A token and a gap behind it.
    fn word(&mut self, word: &str) {
        self.out.push_str(word);
        let gap = if self.draw(self.plain) > 0 { " " } else { self.pick(GAPS) };
        self.out.push_str(gap);
        if gap.contains(['/', '#']) {
            self.comments += 1;
            let number = self.comments.to_string();
            let end = match gap.contains('*') {
                true if self.draw(2) == 1 => " */\n",
                true => " */ ",
                false => "\n",
            };
            self.out.push_str(&number);
            self.out.push_str(end);
        }
    }

    fn words(&mut self, words: &[&str]) {
        for word in words {
            self.word(word);
        }
    }

    fn many(&mut self, most: usize, separator: &str, each: impl Fn(&mut Self)) {
        for number in 0..=self.draw(most) {
            if number > 0 && !separator.is_empty() {
                self.word(separator);
            }
            each(self);
        }
    }

    fn name(&mut self) {
        let name =
            self.pick(&["a", "top", "Lot", "scope.sx", "split", "comp", "inline", "a_long_name_of_something", "ö"]);
        self.word(name);
    }

    fn declaration(&mut self) {
        match self.draw(8) {
            0 => self.annotation(),
            1 => {
                self.words(&["import", "lib", ":", "\"f.cga\""]);
                if self.draw(2) == 1 {
                    self.overrides();
                    self.out.push('\n');
                }
            }
            2 => self.words(&["style", "Night-Blue", "extends", "Base"]),
            3 => {
                let word = self.pick(&["attr", "const"]);
                self.words(&[word, "x", "="]);
                self.value();
            }
            4 => {
                self.words(&["f", "(", "a", ",", "b", ")", "with", "(", "c", ":="]);
                self.expression();
                self.words(&[")", "="]);
                self.value();
            }
            _ => {
                let head = self.pick(&["Rule", "start", "lib.Rule", "extension Cap", "start Go"]);
                self.word(head);
                if self.draw(2) == 1 {
                    self.words(&["(", "a", ")"]);
                }
                self.word("-->");
                self.successor();
            }
        }
    }

    fn annotation(&mut self) {
        let name = self.pick(&["@Range", "@Hidden", "@Handle", "@Description"]);
        self.word(name);
        if self.draw(2) == 1 {
            self.word("(");
            self.many(3, ",", |c| {
                let key = c.pick(&["", "min=", "shape ="]);
                c.word(key);
                let value = c.pick(&["1", "-0.5", "\"a // b\"", "name", "Box*^2", "(1, 2) x", "{0,1}", "true"]);
                c.word(value);
            });
            self.word(")");
        }
        self.words(&["attr", "y", "=", "1"]);
    }

    fn overrides(&mut self) {
        self.word("(");
        self.many(3, ",", |c| {
            c.word("z");
            match c.draw(3) {
                1 => {
                    c.word("=");
                    c.value();
                }
                2 => {
                    c.words(&["(", "h", ")", "-->"]);
                    c.sequence();
                }
                _ => {}
            }
        });
        self.word(")");
    }

    fn value(&mut self) {
        match self.draw(6) {
            1 => {
                self.many(2, "", |c| {
                    c.word("case");
                    c.expression();
                    c.word(":");
                    c.value();
                });
                self.words(&["else", ":"]);
                self.value();
            }
            2 => {
                self.many(2, "", |c| {
                    let weight = c.pick(&["5", "20.5", "w*2"]);
                    c.words(&[weight, "%", ":"]);
                    c.value();
                });
                self.words(&["else", ":"]);
                self.value();
            }
            _ => self.expression(),
        }
    }

    fn expression(&mut self) {
        self.operand();
        for _ in 0..self.draw(4) {
            let operator = self.pick(&["+", "-", "*", "%", "==", "&&", "||", "<=", ".*", ".+", "./", ".==", "!="]);
            self.word(operator);
            self.operand();
        }
    }

    fn operand(&mut self) {
        let sign = self.pick(&["", "", "-", "!", ".-", "+"]);
        self.out.push_str(sign);
        match self.draw(9) {
            1 => {
                let text = self.pick(&[
                    "\"a\"",
                    "\"#ff // no\"",
                    "\"two\nlines\"",
                    "\"\\\"\"",
                    "\"a long text, long enough to fill a line\"",
                ]);
                self.word(text);
            }
            2 => self.name(),
            3 => {
                self.name();
                self.arguments();
            }
            4 => {
                self.word("(");
                self.value();
                self.word(")");
            }
            5 => {
                self.word("[");
                self.many(2, ";", |c| c.many(3, ",", |c| c.expression()));
                self.words(&[",", "1", ":", "n", "]", "[", "2", "]"]);
            }
            6 => {
                self.words(&["comp", "(", "fe", ")", "{", "top", "="]);
                self.value();
                self.words(&["|", "all", ":", "1", "}"]);
            }
            7 => self.word("true"),
            _ => {
                let number = self.pick(&["1", ".5", "2.", "1e-3", "007"]);
                self.word(number);
            }
        }
    }

    fn arguments(&mut self) {
        self.word("(");
        if self.draw(4) > 0 {
            self.many(5, ",", |c| {
                let prefix = c.pick(&["", "", "'", "~", "\u{2019}"]);
                c.out.push_str(prefix);
                c.value();
            });
        }
        self.word(")");
    }

    fn successor(&mut self) {
        match self.draw(6) {
            1 => {
                self.many(2, "", |c| {
                    c.word("case");
                    c.expression();
                    c.word(":");
                    c.successor();
                });
                self.words(&["else", ":"]);
                self.successor();
            }
            2 => {
                self.many(3, "", |c| {
                    let weight = c.pick(&["5", "100", "w * 2", "f(x)"]);
                    c.words(&[weight, "%", ":"]);
                    c.successor();
                });
                self.words(&["else", ":"]);
                self.successor();
            }
            _ => self.sequence(),
        }
    }

    fn sequence(&mut self) {
        for _ in 0..=self.draw(4) {
            self.item();
        }
    }

    fn item(&mut self) {
        match self.draw(13) {
            1 => self.call("extrude"),
            2 => self.word("Wall."),
            3 => {
                self.word("[");
                self.successor();
                self.word("]");
            }
            4 => {
                self.words(&["split", "(", "x", ")"]);
                self.split_block();
            }
            5 => {
                self.words(&["comp", "(", "f", ")", "{"]);
                self.many(3, "|", |c| {
                    c.expression();
                    let operator = c.pick(&[":", "=", "=:"]);
                    c.word(operator);
                    c.successor();
                });
                self.word("}");
            }
            6 => {
                self.words(&["scatter", "(", "surface", ")", "{"]);
                self.successor();
                self.word("}");
            }
            7 => {
                self.words(&["inline", "(", "append", ")"]);
                self.call("A");
            }
            8 => {
                self.words(&["union", "{"]);
                self.successor();
                self.word("|");
                self.successor();
                self.word("}");
            }
            9 => {
                self.word("lib");
                self.overrides();
                // The dot stands directly behind the parenthesis, so a comment there has to go.
                let at = self.out.rfind(')').expect("overrides end with a parenthesis");
                self.out.truncate(at + 1);
                self.word(".Rule");
            }
            10 => {
                self.words(&["splitAndSetbackPerimeter", "(", "1", ")", "{", "~1", ":", "2", ":"]);
                self.successor();
                self.words(&["}", "*", "{", "remainder", ":", "R", "}"]);
            }
            11 => self.word("NIL"),
            12 => self.words(&["D.(2)", "Tail(1)."]),
            _ => self.word("Leaf"),
        }
    }

    fn call(&mut self, name: &str) {
        self.word(name);
        self.arguments();
    }

    fn split_block(&mut self) {
        self.word("{");
        self.many(3, "|", |c| match c.draw(4) {
            1 => c.split_block(),
            2 => c.word("Unsized"),
            _ => {
                let prefix = c.pick(&["", "~", "'"]);
                c.out.push_str(prefix);
                c.expression();
                c.word(":");
                c.successor();
            }
        });
        self.word("}");
        if self.draw(2) == 1 {
            self.word("*");
        }
    }
}
