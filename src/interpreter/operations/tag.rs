//! `tag` and `deleteTags` (reference 4.15.2). In: a name or query and a kind of component. Out: the shape's components
//! with the name, or without those that match.

use std::sync::Arc;

use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::labels::{Level, Query, tag_name};
use super::super::shape::Shape;
use super::super::value::Value;
use super::args::Args;
use crate::cga::builtins::Word;

/// `tag(name [, auto | faces | edges | vertices])`.
pub fn tag(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let text = args.value(0).map_or_else(|| "".into(), Value::to_text);
    let Some(name) = tag_name(&text) else {
        run.warn("cga::tag-name", args.span, || format!("`{text}` leaves no name for a tag"));
        return;
    };
    if !run.program.observes_tags() {
        return;
    }
    let form = Arc::make_mut(&mut shape.form);
    match level_of(form, args.word(1)) {
        Level::Faces => (0..form.mesh.faces.len()).for_each(|f| form.tags_mut().add_face(f, name.clone())),
        Level::Edges => {
            form.edge_list().into_iter().for_each(|edge| form.tags_mut().add_edge(edge, name.clone()));
        }
        Level::Vertices => {
            form.vertex_list().into_iter().for_each(|vertex| form.tags_mut().add_vertex(vertex, name.clone()));
        }
    }
}

/// The kind asked for, or the highest there is.
fn level_of(form: &Form, word: Option<Word>) -> Level {
    match word {
        Some(Word::Faces) => Level::Faces,
        Some(Word::Edges) => Level::Edges,
        Some(Word::Vertices) => Level::Vertices,
        _ if !form.mesh.faces.is_empty() => Level::Faces,
        _ if !form.edges.is_empty() => Level::Edges,
        _ => Level::Vertices,
    }
}

/// The kinds a word names; all without one.
pub fn levels(word: Option<Word>) -> &'static [Level] {
    match word {
        Some(Word::Faces) => &[Level::Faces],
        Some(Word::Edges) => &[Level::Edges],
        Some(Word::Vertices) => &[Level::Vertices],
        _ => Level::ALL,
    }
}

/// `deleteTags([query [, all | faces | edges | vertices]])`.
pub fn delete(args: &Args, shape: &mut Shape) {
    if shape.form.tags().is_none() {
        return;
    }
    let query = args.value(0).map_or_else(Query::any, |text| Query::new(text.to_text()));
    Arc::make_mut(&mut shape.form).tags_mut().remove(&query, levels(args.word(1)));
}
