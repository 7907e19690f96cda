//! What both languages share about pest: spans, recovery, error wording.
