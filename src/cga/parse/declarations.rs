//! In: a `declaration` pair. Out: a declaration, a pending annotation or the version in the tree.

use pest::iterators::Pair;

use super::Rule;
use super::build::Builder;
use crate::cga::ast::{
    self, Annotation, AnnotationArg, AnnotationValue, Declaration, DeclarationKind, Definition, DefinitionKind, Expr,
    Import, Modifier, Override, Style, Text,
};
use crate::cga::codes;
use crate::cga::program::Constant;
use crate::diagnostics::Diagnostic;

impl Builder {
    pub fn declaration(&mut self, pair: Pair<'_, Rule>) {
        let unit = pair.into_inner().next().expect("a declaration has one unit");
        let span = self.span(&unit);
        let kind = match unit.as_rule() {
            Rule::annotation => {
                let annotation = self.annotation(unit);
                self.pending.push(annotation);
                return;
            }
            Rule::version => return self.version(unit),
            Rule::import => DeclarationKind::Import(self.import(unit)),
            Rule::style => DeclarationKind::Style(self.style(unit)),
            Rule::attr => DeclarationKind::Definition(self.definition(DefinitionKind::Attr, unit)),
            Rule::constant => DeclarationKind::Definition(self.definition(DefinitionKind::Const, unit)),
            Rule::function => DeclarationKind::Definition(self.definition(DefinitionKind::Function, unit)),
            Rule::rule => DeclarationKind::Rule(self.rule(unit)),
            other => unreachable!("{other:?} is no unit of the grammar"),
        };
        let annotations = std::mem::take(&mut self.pending);
        self.ast.declarations.push(Declaration { annotations, kind, span });
    }

    fn version(&mut self, pair: Pair<'_, Rule>) {
        let span = self.span(&pair);
        let string = find(pair, Rule::string).expect("version has a string");
        let text = self.string(&string);
        if self.ast.version.is_some() || !self.ast.declarations.is_empty() {
            self.diagnostics.push(Diagnostic::warning(
                codes::MISPLACED_VERSION,
                span,
                "`version` must come first, once",
            ));
        }
        self.ast.version.get_or_insert(text);
    }

    fn annotation(&mut self, pair: Pair<'_, Rule>) -> Annotation {
        let mut out = Annotation { name: Text { text: "".into(), span: self.span(&pair) }, args: Vec::new() };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::annotation_name => out.name = self.text(&part),
                Rule::annotation_args => out.args = part.into_inner().map(|arg| self.annotation_arg(arg)).collect(),
                _ => {}
            }
        }
        out
    }

    fn annotation_arg(&mut self, pair: Pair<'_, Rule>) -> AnnotationArg {
        let span = self.span(&pair);
        let (mut key, mut value) = (None, AnnotationValue::Text("".into()));
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::annotation_key => key = Some(self.text(&part)),
                _ => value = self.annotation_value(part),
            }
        }
        AnnotationArg { key, value, span }
    }

    fn annotation_value(&mut self, pair: Pair<'_, Rule>) -> AnnotationValue {
        let written = AnnotationValue::Text(self.written(&pair).into());
        let literal = pair.into_inner().next().filter(|part| part.as_rule() == Rule::annotation_literal);
        let Some(literal) = literal.and_then(|part| part.into_inner().next()) else { return written };
        match literal.as_rule() {
            Rule::string => AnnotationValue::Constant(Constant::String(self.string(&literal).text)),
            Rule::boolean => AnnotationValue::Constant(Constant::Bool(self.written(&literal) == "true")),
            Rule::name => AnnotationValue::Name(self.written(&literal).into()),
            _ => match self.written(&literal).replace(char::is_whitespace, "").parse() {
                Ok(number) => AnnotationValue::Constant(Constant::Float(number)),
                Err(_) => written,
            },
        }
    }

    fn import(&mut self, pair: Pair<'_, Rule>) -> Import {
        let empty = Text { text: "".into(), span: self.span(&pair) };
        let mut out = Import { prefix: empty.clone(), styles: Vec::new(), path: empty, overrides: None };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => out.prefix = self.text(&part),
                Rule::import_styles => out.styles = self.names(part, Rule::style_name),
                Rule::string => out.path = self.string(&part),
                Rule::overrides => out.overrides = Some(self.overrides(part)),
                _ => {}
            }
        }
        out
    }

    pub fn overrides(&mut self, pair: Pair<'_, Rule>) -> Vec<Override> {
        let items = pair.into_inner().filter(|p| p.as_rule() == Rule::override_item);
        items.map(|item| self.override_item(item)).collect()
    }

    fn override_item(&mut self, pair: Pair<'_, Rule>) -> Override {
        let mut name = Text { text: "".into(), span: self.span(&pair) };
        let mut parameters = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => name = self.text(&part),
                Rule::parameters => parameters = self.names(part, Rule::name),
                Rule::value => return Override::Value(name, self.value(part)),
                Rule::successor => return Override::Rule { name, parameters, successor: self.successor(part) },
                _ => {}
            }
        }
        Override::Keep(name)
    }

    fn style(&mut self, pair: Pair<'_, Rule>) -> Style {
        let mut names = self.names(pair, Rule::style_name).into_iter();
        Style { name: names.next().expect("a style has a name"), base: names.next() }
    }

    fn definition(&mut self, kind: DefinitionKind, pair: Pair<'_, Rule>) -> Definition {
        let span = self.span(&pair);
        let mut name = Text { text: "".into(), span };
        let (mut parameters, mut locals) = (None, Vec::new());
        let mut value = Expr { kind: ast::ExprKind::Bool(false), span };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name | Rule::function_name => name = self.text(&part),
                Rule::parameters => parameters = Some(self.names(part, Rule::name)),
                Rule::locals => locals = self.locals(part),
                Rule::value => value = self.value(part),
                _ => {}
            }
        }
        Definition { kind, name, parameters, locals, value }
    }

    fn rule(&mut self, pair: Pair<'_, Rule>) -> ast::Rule {
        let mut out = ast::Rule {
            modifier: None,
            name: Text { text: "".into(), span: self.span(&pair) },
            parameters: Vec::new(),
            locals: Vec::new(),
            successor: ast::Successor::Sequence(Vec::new()),
        };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::modifier if self.written(&part) == "start" => out.modifier = Some(Modifier::Start),
                Rule::modifier => out.modifier = Some(Modifier::Extension),
                Rule::rule_name => out.name = self.text(&part),
                Rule::parameters => out.parameters = self.names(part, Rule::name),
                Rule::locals => out.locals = self.locals(part),
                Rule::successor => out.successor = self.successor(part),
                _ => {}
            }
        }
        out
    }

    fn locals(&mut self, pair: Pair<'_, Rule>) -> Vec<(Text, Expr)> {
        let mut out = Vec::new();
        for local in pair.into_inner().filter(|p| p.as_rule() == Rule::local) {
            let mut parts = local.into_inner();
            let name = parts.next().expect("a local has a name");
            let value = parts.find(|p| p.as_rule() == Rule::value).expect("a local has a value");
            out.push((self.text(&name), self.value(value)));
        }
        out
    }

    /// The inner pairs of one kind as names.
    fn names(&self, pair: Pair<'_, Rule>, kind: Rule) -> Vec<Text> {
        pair.into_inner().filter(|p| p.as_rule() == kind).map(|p| self.text(&p)).collect()
    }
}

/// The first inner pair of a kind.
pub fn find(pair: Pair<'_, Rule>, kind: Rule) -> Option<Pair<'_, Rule>> {
    pair.into_inner().find(|p| p.as_rule() == kind)
}
