//! `mansard lsp` as an editor sees it. In: a scripted client that speaks the protocol with the real program. Out: what the
//! editor would show, held.

mod editor;
mod keeps_up;
mod knows_names;
mod lifecycle;
mod proposes;
mod shows;
