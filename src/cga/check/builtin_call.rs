//! In: a built-in operation or function with its written arguments. Out: the arguments of the overload that fits, or
//! one error that says why none does.

use super::callable::{bare_name, computed_word, found};
use super::lower::Body;
use super::names::Meaning;
use super::types::type_names;
use crate::cga::ast::Argument;
use crate::cga::builtins::{Function, Operation, ParameterKind, Signature, Word, usage};
use crate::cga::codes;
use crate::cga::program::{Arg, Expr, ExprKind, Prefix, Type};
use crate::diagnostics::{Diagnostic, suggest};
use crate::source::Span;

/// A written argument, read once for all overloads.
struct Given<'e> {
    written: &'e Argument,
    /// The keyword a bare name may be.
    word: Option<Word>,
    /// The value, unless the name means none.
    value: Option<Expr>,
    /// `sel(...)`.
    computed: Option<Expr>,
}

/// Why an overload does not fit.
struct Misfit {
    /// Index of the argument.
    at: usize,
    kind: ParameterKind,
}

/// What is called.
#[derive(Clone, Copy)]
pub enum Builtin {
    Operation(Operation),
    Function(Function),
}

impl Builtin {
    fn name(self) -> &'static str {
        match self {
            Builtin::Operation(operation) => operation.name(),
            Builtin::Function(function) => function.name(),
        }
    }

    fn overloads(self) -> &'static [Signature] {
        match self {
            Builtin::Operation(operation) => operation.overloads(),
            Builtin::Function(function) => function.overloads(),
        }
    }

    /// How messages list the overloads.
    fn forms(self) -> String {
        let forms = match self {
            Builtin::Operation(operation) => usage::operation(operation),
            Builtin::Function(function) => usage::function(function),
        };
        format!("{} {}", if forms.len() == 1 { "its form is" } else { "its forms are" }, forms.join(", "))
    }
}

impl Body<'_, '_> {
    pub fn builtin_function(&mut self, function: Function, args: &[Argument], span: Span) -> Expr {
        if function.observes_tags() {
            self.tables.observes_tags.set(true);
        }
        let (args, result) = self.overload(Builtin::Function(function), args, span);
        self.tables.needs.set(self.tables.needs.get().with_call(function, &args));
        let site = function.draws().then(|| self.draw());
        Expr { kind: ExprKind::Builtin { function, args, site }, value: result, span }
    }

    /// Chooses among overloads; gives the arguments and the result type.
    pub fn overload(&mut self, builtin: Builtin, args: &[Argument], span: Span) -> (Vec<Arg>, Option<Type>) {
        let signatures = builtin.overloads();
        let takes = |i: usize, word: Word| {
            signatures.iter().filter_map(|s| s.parameters.get(i)).any(|p| p.words.contains(&word))
        };
        let given: Vec<Given<'_>> =
            args.iter().enumerate().map(|(i, arg)| self.given(arg, |word| takes(i, word))).collect();
        let fits = |s: &&Signature| (s.arity().0..=s.arity().1).contains(&given.len());
        let mut of_length = signatures.iter().filter(fits).peekable();
        if of_length.peek().is_none() {
            let counts: Vec<usize> = signatures.iter().flat_map(|s| s.arity().0..=s.arity().1).collect();
            self.argument_count(builtin.name(), &counts, given.len(), span, || builtin.forms());
            return (Vec::new(), signatures.first().and_then(|s| s.result));
        }
        let mut fitting: Vec<&Signature> = Vec::new();
        let mut misfit: Option<Misfit> = None;
        for signature in of_length {
            match mismatch(signature, &given) {
                None => fitting.push(signature),
                Some(m) if misfit.as_ref().is_none_or(|best| m.at > best.at) => misfit = Some(m),
                Some(m) => {
                    if let Some(best) = misfit.as_mut().filter(|best| best.at == m.at) {
                        best.kind.words.extend(m.kind.words);
                        best.kind.values.extend(m.kind.values);
                    }
                }
            }
        }
        let Some(&chosen) = fitting.first() else {
            let misfit = misfit.expect("an overload that does not fit has a reason");
            self.report(misfit, &given, builtin);
            return (Vec::new(), signatures[0].result);
        };
        let certain = fitting.iter().all(|s| s.result == chosen.result);
        let parameters = fitting.len() == 1;
        let args = given.into_iter().zip(&chosen.parameters).map(|(g, p)| self.argument(g, p, parameters)).collect();
        (args, chosen.result.filter(|_| certain))
    }

    /// `takes` tells whether some overload takes a keyword here.
    fn given<'e>(&mut self, written: &'e Argument, takes: impl Fn(Word) -> bool) -> Given<'e> {
        let name = bare_name(&written.value);
        let word = name.and_then(|n| Word::from_text(&n.text));
        let computed = computed_word(&written.value).map(|text| {
            let text = self.expression(text);
            self.require(&text, Type::String);
            text
        });
        // A word that is also a built-in function, such as `inside`, is the word where one is taken.
        let known = match name {
            Some(n) => self.is_own_value(&n.text) || word.is_none_or(|w| !takes(w)) && self.is_builtin_value(&n.text),
            None => computed.is_none(),
        };
        let value = known.then(|| self.expression(&written.value));
        Given { written, word, value, computed }
    }

    /// The argument as the chosen overload takes it. With only one overload left its types teach parameters theirs.
    fn argument(&mut self, given: Given<'_>, kind: &ParameterKind, certain: bool) -> Arg {
        if let Some(text) = given.computed {
            return Arg::ComputedWord(text);
        }
        if let Some(word) = given.word.filter(|w| kind.words.contains(w)) {
            self.note(given.written.span, Meaning::Word(word));
            return Arg::Word(word, given.written.span);
        }
        let prefix = given.written.prefix;
        let allowed = match prefix {
            Prefix::Absolute => true,
            Prefix::Relative => kind.relative,
            Prefix::Floating => kind.floating,
        };
        if !allowed {
            self.misplaced_prefix(given.written);
        }
        let value = given.value.expect("an argument that fits has a value");
        if let (true, [one]) = (certain, &kind.values[..]) {
            self.learn(&value, *one);
        }
        Arg::Value(prefix, value)
    }

    fn report(&mut self, misfit: Misfit, given: &[Given<'_>], builtin: Builtin) {
        if self.quiet {
            return;
        }
        let arg = &given[misfit.at];
        let span = arg.written.span;
        let words = &misfit.kind.words;
        let Some(name) = bare_name(&arg.written.value).filter(|_| arg.value.is_none()) else {
            let wanted = match (misfit.kind.values.is_empty(), words.is_empty()) {
                (true, _) => format!("one of {}", list(words)),
                (false, true) => type_names(&misfit.kind.values),
                (false, false) => format!("{} or one of {}", type_names(&misfit.kind.values), list(words)),
            };
            let found = found(arg.value.as_ref().and_then(|v| v.value));
            let error = Diagnostic::error(codes::TYPE_MISMATCH, span, format!("expected {wanted}, found {found}"));
            return self.diagnostics.push(error.help(builtin.forms()));
        };
        if words.is_empty() {
            // Resolving it as a value says what is wrong with the name.
            self.expression(&arg.written.value);
            return;
        }
        let diagnostic = Diagnostic::error(codes::UNKNOWN_KEYWORD, span, format!("`{}` does not fit here", name.text));
        let near = suggest(&name.text, words.iter().map(|w| w.text()));
        self.diagnostics.push(diagnostic.help(match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("expected one of {}", list(words)),
        }));
    }
}

/// The first argument an overload cannot take.
fn mismatch(signature: &Signature, given: &[Given<'_>]) -> Option<Misfit> {
    let at = given.iter().zip(&signature.parameters).position(|(arg, kind)| {
        let as_word =
            arg.word.is_some_and(|w| kind.words.contains(&w)) || arg.computed.is_some() && !kind.words.is_empty();
        let value = arg.value.as_ref().filter(|_| !kind.values.is_empty());
        let as_value = value.is_some_and(|v| v.value.is_none_or(|found| kind.values.contains(&found)));
        !as_word && !as_value
    })?;
    Some(Misfit { at, kind: signature.parameters[at].clone() })
}

fn list(words: &[Word]) -> String {
    let words: Vec<String> = words.iter().map(|w| format!("`{}`", w.text())).collect();
    words.join(", ")
}
