//! `mansard derive`: one rule file on one footprint.

use std::path::Path;
use std::sync::Arc;

use mansard::cga::{self, program::Program};
use mansard::geometry::Mesh;
use mansard::interpreter::seed::Seed;
use mansard::interpreter::tree::{Scalar, ShapeTree};
use mansard::interpreter::{FileAssets, Limits, StartShape, derive, json::to_json, obj::to_obj, text::to_text};
use mansard::output::write_bytes;
use mansard::pipeline::single_scene;
use mansard::scene::export::to_glb;
use mansard::source::{Access, SourceMap};

use crate::args::{DeriveArgs, DeriveFormat};
use crate::check::rule_access;
use crate::footprint;
use crate::report::{self, Failure};

pub fn run(args: &DeriveArgs) -> Result<(), Failure> {
    let mesh = footprint::parse(&args.footprint).map_err(|e| Failure::unable(format!("--footprint: {e}")))?;
    let access = rule_access(&args.rules, &args.allow)?;
    let mut sources = SourceMap::default();
    let program = compile(&args.rules, &access, &mut sources)?;
    let attributes = args.attributes.iter().map(|a| attribute(a, &program)).collect::<Result<_, _>>()?;
    let start = StartShape { attributes, start_rule: args.start.clone(), ..start(mesh, args.seed) };
    let tree = derive(&program, &start, &FileAssets::new(access.clone()), &Limits::default());
    report::print(&tree.diagnostics, &sources);
    write(&tree, args, &access, &sources)?;
    if tree.diagnostics.has_errors() { Err(Failure::said()) } else { Ok(()) }
}

/// `mansard dump tree`: the tree on a 10 m × 8 m footprint.
pub fn dump(file: &Path) -> Result<(), Failure> {
    let access = rule_access(file, &[])?;
    let mut sources = SourceMap::default();
    let program = compile(file, &access, &mut sources)?;
    let mesh = footprint::parse("0,0 10,0 10,-8 0,-8").expect("four corners");
    let tree = derive(&program, &start(mesh, 0), &FileAssets::new(access), &Limits::default());
    report::print(&tree.diagnostics, &sources);
    print!("{}", to_text(&tree));
    if tree.diagnostics.has_errors() { Err(Failure::said()) } else { Ok(()) }
}

fn start(mesh: Mesh, seed: u64) -> StartShape {
    StartShape { mesh, start_rule: None, attributes: Vec::new(), seed: Seed::root(seed), name: "footprint".into() }
}

fn compile(file: &Path, access: &Access, sources: &mut SourceMap) -> Result<Program, Failure> {
    let (program, diagnostics) = cga::compile(file, access, sources, &cga::CompileOptions::default());
    report::print(&diagnostics, sources);
    program.ok_or_else(Failure::said)
}

/// `name=value`: a number, `true`, `false`, or text.
fn attribute(text: &str, program: &Program) -> Result<(Arc<str>, Scalar), Failure> {
    let Some((name, value)) = text.split_once('=') else {
        return Err(Failure::unable(format!("--attr {text}: write NAME=VALUE")));
    };
    let names = || program.attributes().iter().filter(|a| !a.is_const).map(|a| &*a.name);
    if !names().any(|n| n == name) {
        let meant = mansard::diagnostics::suggest(name, names()).map(|m| format!(", did you mean `{m}`?"));
        return Err(Failure::wrong(format!("the rule file has no attribute `{name}`{}", meant.unwrap_or_default())));
    }
    let value = match (value, value.parse::<f64>()) {
        ("true", _) => Scalar::Bool(true),
        ("false", _) => Scalar::Bool(false),
        (_, Ok(number)) if number.is_finite() => Scalar::Float(number),
        _ => Scalar::String(value.into()),
    };
    Ok((name.into(), value))
}

fn write(tree: &ShapeTree, args: &DeriveArgs, access: &Access, sources: &SourceMap) -> Result<(), Failure> {
    let bytes = match args.format {
        DeriveFormat::Tree => to_text(tree).into_bytes(),
        DeriveFormat::Obj => to_obj(tree).into_bytes(),
        DeriveFormat::Json => {
            let mut bytes = serde_json::to_vec(&to_json(tree, sources)).expect("plain values serialise");
            bytes.push(b'\n');
            bytes
        }
        DeriveFormat::Glb => {
            let scene = single_scene(tree, access).map_err(|e| report::failure(e, sources))?;
            to_glb(&scene, "").map_err(|e| Failure::unable(e.to_string()))?
        }
    };
    match &args.output {
        Some(path) => write_bytes(path, &bytes).map_err(|e| Failure::unable(e.to_string())),
        None => {
            use std::io::Write;
            std::io::stdout().write_all(&bytes).map_err(|e| Failure::unable(format!("standard output: {e}")))
        }
    }
}
