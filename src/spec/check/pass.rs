//! In: a `pass` block. Out: a [`PassSpec`].

use super::{Checker, get};
use crate::spec::ast::{Block, Clause, ExprKind, Property};
use crate::spec::render_spec::{AcquisitionSpec, OutputSpec, PassSpec, SetSpec, StateSpec};

/// Names of outputs that are evaluated.
const OUTPUTS: [(&str, OutputSpec); 7] = [
    ("colour", OutputSpec::Colour),
    ("color", OutputSpec::Colour),
    ("class", OutputSpec::Class),
    ("mask", OutputSpec::Mask),
    ("level", OutputSpec::Level),
    ("instance", OutputSpec::Instance),
    ("depth", OutputSpec::Depth),
];

/// Outputs that the language knows besides.
const LATER: [&str; 7] =
    ["height", "normal", "shadow_mask", "roof_mask", "footprint_mask", "visible_mask", "roof_offset"];

impl Checker<'_> {
    pub fn pass(&mut self, block: &Block, changes: &[String]) -> Option<PassSpec> {
        let properties = &block.properties;
        let name = self.block_name(block);
        let show = self.required(properties, "show", block.span, "a pass");
        let effects = self.effect_overrides(properties);
        let acquisition = match get(properties, "acquisition") {
            Some(property) => self.acquisition(property).map(Some),
            None => Some(None),
        };
        let show = show?;
        let shown = self.shown(show, changes);
        let state = match show.clause("with") {
            Some(with) => self.state(with, changes),
            None => Some(StateSpec::Before),
        };
        let outputs = self.outputs(show, &name);
        let mark = match show.clause("mark") {
            Some(mark) => self.union(&mark.values, changes).map(Some),
            None => Some(None),
        };
        if let (Some(outputs), Some(mark)) = (&outputs, show.clause("mark"))
            && !outputs.iter().any(|(output, _)| *output == OutputSpec::Mask)
        {
            let message = "`mark` says what a mask marks, but the pass writes none";
            self.error_with_help("spec::wrong-value", mark.word.span, message, "add `as mask`");
        }
        Some(PassSpec {
            name,
            span: block.span,
            show: shown?,
            state: state?,
            mark: mark?,
            outputs: outputs?,
            effects: effects?,
            acquisition: acquisition?,
        })
    }

    /// `show SET` and `show only SET` say the same; `only` reads better where little is left.
    fn shown(&mut self, show: &Property, changes: &[String]) -> Option<SetSpec> {
        match (show.values.as_slice(), show.clause("only")) {
            ([], None) => {
                let help = "write `show all` or `show only building & changed`";
                self.error_with_help("spec::wrong-value", show.span, "`show` says what is shown", help);
                None
            }
            ([], Some(only)) => self.union(&only.values, changes),
            (values, None) => self.union(values, changes),
            (_, Some(only)) => {
                self.error("spec::wrong-value", only.word.span, "`show` takes a set or `only` a set, not both");
                None
            }
        }
    }

    /// `with burnt, rebuilt`: after these changes; `with both`: before and after together.
    fn state(&mut self, with: &Clause, changes: &[String]) -> Option<StateSpec> {
        let all = || (0..changes.len()).collect::<Vec<_>>();
        if let [only] = with.values.as_slice() {
            match &only.kind {
                ExprKind::Word(word) if word == "before" => return Some(StateSpec::Before),
                ExprKind::Word(word) if word == "all" => return Some(StateSpec::After(all())),
                ExprKind::Word(word) if word == "both" => return Some(StateSpec::Both(all())),
                ExprKind::Call { name, arguments } if name.text == "both" => {
                    let named = arguments.iter().map(|argument| self.change_index(&argument.value, changes));
                    return named.collect::<Vec<_>>().into_iter().collect::<Option<_>>().map(StateSpec::Both);
                }
                _ => {}
            }
        }
        let named: Vec<Option<usize>> = with.values.iter().map(|value| self.change_index(value, changes)).collect();
        named.into_iter().collect::<Option<_>>().map(StateSpec::After)
    }

    fn change_index(&mut self, value: &crate::spec::ast::Expr, changes: &[String]) -> Option<usize> {
        let ExprKind::Word(name) = &value.kind else {
            self.wrong(value, "the name of a change");
            return None;
        };
        self.index_of("change", name, value.span, changes)
    }

    /// What the pass writes, with the names of the images.
    fn outputs(&mut self, show: &Property, pass: &str) -> Option<Vec<(OutputSpec, String)>> {
        let Some(clause) = show.clause("as") else { return Some(vec![(OutputSpec::Colour, pass.to_owned())]) };
        let words = OUTPUTS.map(|(name, _)| name);
        let several = clause.values.len() > 1;
        let mut outputs: Vec<(OutputSpec, String)> = Vec::new();
        for value in &clause.values {
            let word = self.word(value, &words, &LATER)?;
            let output = OUTPUTS.iter().find(|(name, _)| *name == word).expect("the word is one of these").1;
            if outputs.iter().any(|(known, _)| *known == output) {
                self.error("spec::repeated-property", value.span, format!("`{word}` is written twice"));
                return None;
            }
            outputs.push((output, if several { format!("{pass}_{word}") } else { pass.to_owned() }));
        }
        Some(outputs)
    }

    /// `acquisition second` draws a camera, a sun and effects of its own; `redraw sun` keeps the view's camera.
    fn acquisition(&mut self, property: &Property) -> Option<AcquisitionSpec> {
        let value = self.one(property)?;
        let ExprKind::Word(name) = &value.kind else {
            self.wrong(value, "the name of an acquisition");
            return None;
        };
        let (mut camera, mut sun, mut effects) = (true, true, true);
        if let Some(redraw) = property.clause("redraw") {
            (camera, sun, effects) = (false, false, false);
            for value in &redraw.values {
                match self.word(value, &["camera", "sun", "effects"], &[])? {
                    "camera" => camera = true,
                    "sun" => sun = true,
                    _ => effects = true,
                }
            }
        }
        Some(AcquisitionSpec { name: name.clone(), camera, sun, effects })
    }
}
