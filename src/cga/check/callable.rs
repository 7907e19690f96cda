//! In: a name in an expression, with or without arguments. Out: what it means: a slot, an attribute, a function, a
//! built-in, or an error with a suggestion. The file's own definitions come before built-in ones (reference 2.3).

use super::instance::Value;
use super::lower::Body;
use super::names::Meaning;
use super::types::type_name;
use crate::cga::ast::{self, Argument, Text};
use crate::cga::builtins::{Attr, Function, Word};
use crate::cga::codes;
use crate::cga::program::{AttributeId, Expr, ExprKind, FunctionId, Prefix, Type};
use crate::diagnostics::Diagnostic;
use crate::source::Span;

impl Body<'_, '_> {
    pub fn call(&mut self, name: &Text, args: Option<&[Argument]>, span: Span) -> Expr {
        if let (None, true, Some(word)) = (args, self.in_selector, selector_word(&name.text)) {
            self.note(name.span, Meaning::Word(word));
            return self.selector_word(word, span);
        }
        if let (None, Some(slot)) = (args, self.slots.iter().rposition(|(n, _)| *n == name.text)) {
            self.note(name.span, Meaning::Local(self.slot_spans[slot]));
            return Expr { kind: ExprKind::Slot(slot as u32), value: self.slots[slot].1, span };
        }
        let given = args.unwrap_or_default();
        if let Some(found) = self.user_value(name, given, span) {
            return found;
        }
        if args.is_none_or(<[Argument]>::is_empty)
            && let Some(row) = Attr::from_name(&name.text)
        {
            if row.deprecated {
                self.deprecated(name, row.attr.info().name);
            }
            self.note(name.span, Meaning::BuiltinAttribute(row.name));
            return Expr { kind: ExprKind::BuiltinAttribute(row.attr), value: Some(row.kind), span };
        }
        if let Some(function) = Function::from_name(&name.text) {
            self.note(name.span, Meaning::BuiltinFunction(function));
            return self.plain(|b| b.builtin_function(function, given, span));
        }
        if let Some(function) = Function::from_deprecated(&name.text) {
            self.deprecated(name, function.name());
            self.note(name.span, Meaning::BuiltinFunction(function));
            return self.plain(|b| b.builtin_function(function, given, span));
        }
        self.unknown_value(name, given);
        Expr { kind: ExprKind::Bool(false), value: None, span }
    }

    /// Whether a bare name is a parameter, a local, or a value of the rule files.
    pub fn is_own_value(&self, name: &str) -> bool {
        self.slots.iter().any(|(n, _)| **n == *name) || !self.tables.values(self.scope, name).is_empty()
    }

    /// Whether a bare name is a built-in attribute or function.
    pub fn is_builtin_value(&self, name: &str) -> bool {
        Attr::from_name(name).is_some() || Function::from_name(name).or(Function::from_deprecated(name)).is_some()
    }

    /// An attribute or function of the rule files.
    fn user_value(&mut self, name: &Text, args: &[Argument], span: Span) -> Option<Expr> {
        let candidates = self.tables.values(self.scope, &name.text);
        let fitting: Vec<Value> =
            candidates.iter().copied().filter(|v| self.tables.value_arity(*v) == args.len()).collect();
        let Some(&first) = fitting.first() else {
            let builtin = Function::from_name(&name.text).is_some();
            if !candidates.is_empty() && !builtin {
                self.refer(self.scope, name, self.tables.value_meaning(candidates[0]));
                let counts: Vec<usize> = candidates.iter().map(|v| self.tables.value_arity(*v)).collect();
                let own = || self::own_forms(&name.text, candidates.iter().map(|v| self.tables.value_parameters(*v)));
                self.argument_count(&name.text, &counts, args.len(), span, own);
                args.iter().for_each(|a| drop(self.expression(&a.value)));
                return Some(Expr { kind: ExprKind::Bool(false), value: None, span });
            }
            return None;
        };
        let values: Vec<Expr> = args.iter().map(|arg| self.plain(|b| b.plain_argument(arg))).collect();
        let chosen = fitting.iter().copied().find(|v| match v {
            Value::Attribute(_) => true,
            Value::Function(id) => fits(&self.types.functions[id.0 as usize].0, &values),
        });
        let chosen = chosen.unwrap_or(first);
        self.refer(self.scope, name, self.tables.value_meaning(chosen));
        Some(match chosen {
            Value::Attribute(id) => match values.into_iter().next() {
                Some(edge) => self.map_read(id, edge, span),
                None => self.attribute_read(id, span),
            },
            Value::Function(function) => self.function_call(function, values, span),
        })
    }

    fn attribute_read(&mut self, id: AttributeId, span: Span) -> Expr {
        let own = self.attribute.and_then(|reader| {
            let reads_back = matches!(
                self.tables.attributes[id.0 as usize].default,
                super::instance::Default::Propagated(outer) if outer == reader
            );
            if reads_back { self.tables.own_defaults.get(&id).copied() } else { None }
        });
        let id = own.unwrap_or(id);
        Expr { kind: ExprKind::Attribute(id), value: self.types.attributes[id.0 as usize], span }
    }

    /// `streetWidth(edge)`: an entry of the attribute's list; 0 for an edge that is not there.
    fn map_read(&mut self, id: AttributeId, edge: Expr, span: Span) -> Expr {
        self.require(&edge, Type::Float);
        let array = Box::new(self.attribute_read(id, span));
        Expr { kind: ExprKind::Index { array, row: Box::new(edge), column: None }, value: Some(Type::Float), span }
    }

    fn function_call(&mut self, function: FunctionId, args: Vec<Expr>, span: Span) -> Expr {
        let (parameters, result) = &self.types.functions[function.0 as usize];
        let result = *result;
        self.check_arguments(parameters, &args);
        Expr { kind: ExprKind::Call { function, args }, value: result, span }
    }

    /// Reports arguments of another type than their parameter's.
    pub fn check_arguments(&mut self, parameters: &[Option<Type>], args: &[Expr]) {
        for (wanted, arg) in parameters.iter().zip(args) {
            if let Some(wanted) = wanted {
                self.require(arg, *wanted);
            }
        }
    }

    /// An argument of a rule or user function: a value without prefix.
    pub fn plain_argument(&mut self, arg: &Argument) -> Expr {
        if arg.prefix != Prefix::Absolute {
            self.misplaced_prefix(arg);
        }
        self.expression(&arg.value)
    }

    pub fn misplaced_prefix(&mut self, arg: &Argument) {
        let sign = if arg.prefix == Prefix::Floating { "~" } else { "'" };
        self.error(codes::MISPLACED_PREFIX, arg.span, format!("`{sign}` has no meaning for this argument"));
    }

    pub fn argument_count(
        &mut self,
        name: &str,
        counts: &[usize],
        given: usize,
        span: Span,
        forms: impl FnOnce() -> String,
    ) {
        if self.quiet {
            return;
        }
        let mut counts: Vec<usize> = counts.to_vec();
        counts.sort_unstable();
        counts.dedup();
        let listed: Vec<String> = counts.iter().map(usize::to_string).collect();
        let plural = if counts == [1] { "" } else { "s" };
        let message = format!("`{name}` takes {} argument{plural}, not {given}", listed.join(" or "));
        let error = Diagnostic::error(codes::ARGUMENT_COUNT, span, message);
        self.diagnostics.push(error.help(forms()));
    }

    pub fn deprecated(&mut self, name: &Text, new: &str) {
        let message = format!("`{}` is an old name", name.text);
        self.diagnostics
            .push(Diagnostic::warning(codes::DEPRECATED, name.span, message).help(format!("write `{new}`")));
    }

    fn unknown_value(&mut self, name: &Text, args: &[Argument]) {
        args.iter().for_each(|a| drop(self.expression(&a.value)));
        if self.quiet {
            return;
        }
        let slots = self.slots.iter().map(|(n, _)| &**n);
        let own = self.tables.instances[self.scope].values.keys().map(|k| &**k);
        let builtin = Function::ALL.iter().map(|f| f.name()).chain(Attr::table().map(|row| row.name));
        let words = SELECTORS.iter().map(|w| w.text()).filter(|_| self.in_selector);
        let near = self.tables.meant(&name.text, slots.chain(own).chain(builtin).chain(words));
        let (code, message) = if self.in_selector && args.is_empty() {
            (codes::UNKNOWN_SELECTOR, format!("`{}` is neither a selector nor a value", name.text))
        } else {
            let what = if args.is_empty() { "attribute, parameter or function" } else { "function" };
            (codes::UNKNOWN_NAME, format!("there is no {what} `{}`", name.text))
        };
        let mut diagnostic = Diagnostic::error(code, name.span, message);
        diagnostic.help = match near {
            Some(near) => Some(format!("did you mean `{near}`?")),
            None if Word::from_text(&name.text).is_some() => {
                Some("it is a keyword, but not one of this place".to_owned())
            }
            None => None,
        };
        self.diagnostics.push(diagnostic);
    }

    /// A word in a selector.
    fn selector_word(&mut self, word: Word, span: Span) -> Expr {
        use Word as W;
        self.tables.needs.set(self.tables.needs.get().with_word(word));
        match word {
            W::LegacyStreetSide => self.old_form(span, "`streetSide` is an old name", "street.front"),
            W::LegacyNoStreetSide => self.old_form(span, "`noStreetSide` is an old name", "!street.front"),
            _ => {}
        }
        Expr { kind: ExprKind::Selector(word), value: Some(Type::Bool), span }
    }
}

/// How messages list definitions of the rule files: `its forms are f(x), f(x, y)`.
pub fn own_forms<'t>(name: &str, definitions: impl Iterator<Item = &'t [Text]>) -> String {
    let form = |parameters: &[Text]| {
        let names: Vec<&str> = parameters.iter().map(|p| &*p.text).collect();
        if names.is_empty() { name.to_owned() } else { format!("{name}({})", names.join(", ")) }
    };
    let forms: Vec<String> = definitions.take(6).map(form).collect();
    format!("{} {}", if forms.len() == 1 { "its form is" } else { "its forms are" }, forms.join(", "))
}

/// Whether values can be the arguments of these parameters.
pub fn fits(parameters: &[Option<Type>], values: &[Expr]) -> bool {
    parameters.iter().zip(values).all(|(p, v)| p.zip(v.value).is_none_or(|(p, v)| p == v))
}

/// Words that select components (reference 3.5 to 3.7 and the named regions).
static SELECTORS: &[Word] = &{
    use Word as W;
    [
        W::Front,
        W::Back,
        W::Right,
        W::Left,
        W::Top,
        W::Bottom,
        W::Side,
        W::ObjectFront,
        W::ObjectBack,
        W::ObjectRight,
        W::ObjectLeft,
        W::ObjectTop,
        W::ObjectBottom,
        W::ObjectSide,
        W::WorldSouth,
        W::WorldNorth,
        W::WorldEast,
        W::WorldWest,
        W::WorldUp,
        W::WorldDown,
        W::WorldSide,
        W::Vertical,
        W::Aslant,
        W::Nutant,
        W::Horizontal,
        W::All,
        W::Border,
        W::Inside,
        W::Eave,
        W::Hip,
        W::Valley,
        W::Ridge,
        W::StreetFront,
        W::StreetBack,
        W::StreetLeft,
        W::StreetRight,
        W::StreetSide,
        W::LegacyStreetSide,
        W::LegacyNoStreetSide,
        W::UvLeft,
        W::UvRight,
        W::UvBottom,
        W::UvTop,
        W::UvUMin,
        W::UvUMax,
        W::UvVMin,
        W::UvVMax,
        W::Remainder,
        W::Shape,
    ]
};

/// Words that select components.
pub fn selector_words() -> &'static [Word] {
    SELECTORS
}

pub fn selector_word(name: &str) -> Option<Word> {
    SELECTORS.iter().copied().find(|w| w.text() == name)
}

/// The value expression of an argument that is a bare name.
pub fn bare_name(expr: &ast::Expr) -> Option<&Text> {
    match &expr.kind {
        ast::ExprKind::Call { name, args: None } => Some(name),
        _ => None,
    }
}

/// The argument of `sel(text)`.
pub fn computed_word(expr: &ast::Expr) -> Option<&ast::Expr> {
    match &expr.kind {
        ast::ExprKind::Call { name, args: Some(args) } if &*name.text == "sel" && args.len() == 1 => {
            Some(&args[0].value)
        }
        _ => None,
    }
}

/// For messages: what was found where a keyword was wanted.
pub fn found(kind: Option<Type>) -> &'static str {
    kind.map_or("a value", type_name)
}
