//! In: a token and the text around it. Out: the token with its comments; what the author's line breaks say.
//!
//! A comment behind a token on its line stays there; a comment on a line of its own stands before the next token. Around
//! separators (`|`, `,`, `;`) comments move behind the separator, so that it stays at its line's end.

use super::document::Doc;
use super::layout::Layout;
use crate::cga::parse::tokens::{Comment, letter};

impl Layout<'_> {
    /// Token `index` with the comments that belong to it.
    pub fn token(&self, index: usize) -> Vec<Doc> {
        let mut docs = Vec::new();
        let place = self.tokens.places[index];
        let written = Doc::Source(place.start, place.end);
        if self.is_separator(index) {
            docs.push(written);
            self.comments(index, true, &mut docs);
        } else {
            self.comments_before(index, &mut docs);
            docs.push(written);
        }
        docs.extend(self.trailing(index));
        docs
    }

    /// Token `index` without the comments on lines of their own in front of it: they were written before.
    pub fn closing(&self, index: usize) -> Vec<Doc> {
        let place = self.tokens.places[index];
        let mut docs = vec![Doc::Source(place.start, place.end)];
        docs.extend(self.trailing(index));
        docs
    }

    /// The comments on lines of their own in front of token `index`.
    pub fn comments_before(&self, index: usize, docs: &mut Vec<Doc>) {
        self.comments(index, false, docs);
    }

    /// Whether such comments exist.
    pub fn has_comments_before(&self, index: usize) -> bool {
        let mut docs = Vec::new();
        self.comments_before(index, &mut docs);
        !docs.is_empty()
    }

    /// Comments between token `index - 1` and token `index`: those on lines of their own, or with `all` also those
    /// that stand behind the token before.
    fn comments(&self, index: usize, all: bool, docs: &mut Vec<Doc>) {
        let found = self.comments_at(index);
        let count = found.iter().take_while(|comment| self.is_trailing(comment, index)).count();
        for (number, comment) in found.iter().enumerate() {
            let written = Doc::Comment(comment.start, comment.end);
            if number < count {
                if all {
                    docs.extend([Doc::Space, written, self.after_trailing(comment)]);
                }
                continue;
            }
            let next = found.get(number + 1).map_or(self.start(index), |next| next.start as usize);
            if !self.breaks(comment.end as usize, next) && !self.is_line(comment) {
                docs.extend([written, Doc::Space]);
                continue;
            }
            docs.push(Doc::OwnLine);
            if self.is_blank_before(comment.start as usize) && !self.opens(index) {
                docs.push(Doc::Blank);
            }
            docs.extend([written, Doc::EndLine]);
            if number + 1 == found.len() && self.is_blank_before(next) && !self.closes(index) {
                docs.push(Doc::Blank);
            }
        }
    }

    /// The comments behind token `index` on its line, unless they follow a separator there.
    pub fn trailing(&self, index: usize) -> Vec<Doc> {
        if self.is_separator(index + 1) {
            return Vec::new();
        }
        let found = self.comments_at(index + 1);
        let trailing = found.iter().take_while(|comment| self.is_trailing(comment, index + 1));
        trailing.flat_map(|c| [Doc::Space, Doc::Comment(c.start, c.end), self.after_trailing(c)]).collect()
    }

    fn after_trailing(&self, comment: &Comment) -> Doc {
        if self.is_line(comment) { Doc::EndLine } else { Doc::Space }
    }

    fn comments_at(&self, index: usize) -> &[Comment] {
        let all = &self.tokens.comments;
        let first = all.partition_point(|comment| (comment.before as usize) < index);
        let end = all.partition_point(|comment| comment.before as usize <= index);
        &all[first..end]
    }

    /// Whether a comment in front of token `index` stands on the line of the token before.
    fn is_trailing(&self, comment: &Comment, index: usize) -> bool {
        index > 0 && {
            let before = self.tokens.places[index - 1].end as usize;
            let gap = &self.text[before..comment.start as usize];
            let first = self.comments_at(index).first().is_none_or(|first| first.start == comment.start);
            if first { !gap.contains('\n') } else { self.follows_on_line(comment, index) }
        }
    }

    /// Whether only comments without line ends stand between a comment and the token before.
    fn follows_on_line(&self, comment: &Comment, index: usize) -> bool {
        let before = self.tokens.places[index - 1].end as usize;
        !self.text[before..comment.start as usize].contains('\n')
    }

    fn is_line(&self, comment: &Comment) -> bool {
        !self.text[comment.start as usize..].starts_with("/*")
    }

    fn is_separator(&self, index: usize) -> bool {
        matches!(self.tokens.letter(index), b'|' | b',' | b';')
    }

    /// Whether a body or bracket begins in front of token `index`, where no empty line belongs.
    fn opens(&self, index: usize) -> bool {
        index == 0 || {
            let before = self.tokens.letter(index - 1);
            matches!(before, b'(' | b'[' | b'{' | b':' | b'=' | letter::ARROW | letter::DEFINE | letter::CONNECTED)
        }
    }

    fn closes(&self, index: usize) -> bool {
        matches!(self.tokens.letter(index), b')' | b']' | b'}' | 0)
    }

    /// The offset of token `index`, or the end of the text.
    fn start(&self, index: usize) -> usize {
        self.tokens.places.get(index).map_or(self.text.len(), |place| place.start as usize)
    }

    /// Whether a line ends between two offsets.
    fn breaks(&self, from: usize, to: usize) -> bool {
        self.text[from..to].contains('\n')
    }

    /// Whether an empty line stands directly in front of `offset`.
    fn is_blank_before(&self, offset: usize) -> bool {
        let before = &self.text[..offset];
        let gap = &before[before.trim_end().len()..];
        gap.bytes().filter(|&b| b == b'\n').count() > 1
    }

    /// Whether the author ended a line in front of token `index`.
    pub fn author_broke(&self, index: usize) -> bool {
        index > 0 && self.breaks(self.tokens.places[index - 1].end as usize, self.start(index))
    }

    /// The author's empty line in front of token `index` or of its comments.
    pub fn blank(&self, index: usize) -> Option<Doc> {
        if self.opens(index) {
            return None;
        }
        let first = self.comments_at(index).iter().find(|comment| !self.is_trailing(comment, index));
        let start = first.map_or(self.start(index), |comment| comment.start as usize);
        self.is_blank_before(start).then_some(Doc::Blank)
    }

    /// Whether an empty line stands anywhere between token `index` and the token before.
    pub fn is_apart(&self, index: usize) -> bool {
        let starts = self.comments_at(index).iter().map(|c| c.start as usize).chain([self.start(index)]);
        starts.into_iter().any(|start| self.is_blank_before(start))
    }
}
