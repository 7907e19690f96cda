//! `mansard derive`: one rule file on one footprint or several.

use std::path::Path;
use std::sync::Arc;

use mansard::cga::program::{Program, Type};
use mansard::cga::{self, CompileOptions};
use mansard::dataset::reports::SceneReports;
use mansard::geometry::Mesh;
use mansard::interpreter::reports::table;
use mansard::interpreter::seed::Seed;
use mansard::interpreter::tree::{Scalar, ShapeTree};
use mansard::interpreter::{FileAssets, StartShape, json::to_json, obj::to_obj, text::to_text};
use mansard::output::write_bytes;
use mansard::pipeline::{portrait, single_scene};
use mansard::scene::export::to_glb;
use mansard::source::{Access, SourceMap};

use crate::args::{DeriveArgs, DeriveFormat};
use crate::check::rule_access;
use crate::footprint;
use crate::report::{self, Failure};
use crate::reports;
use crate::start_shapes;

/// Pixels.
const PICTURE: (u32, u32) = (640, 480);

pub fn run(args: &DeriveArgs, quiet: bool) -> Result<(), Failure> {
    reports::check(args.reports.as_ref())?;
    let parse = |text: &String| footprint::parse(text).map_err(|e| Failure::unable(format!("--footprint: {e}")));
    let meshes: Vec<Mesh> = args.footprint.iter().map(parse).collect::<Result<_, _>>()?;
    let host = start_shapes::host(&args.street_width, &args.edge_attr).map_err(Failure::unable)?;
    let access = rule_access(&args.rules, &args.allow)?;
    let mut sources = SourceMap::default();
    let (program, mut diagnostics) = cga::compile(&args.rules, &access, &mut sources, &CompileOptions::default());
    let outline = start_shapes::together(&meshes);
    let mut trees = Vec::new();
    if let Some(program) = &program {
        let attributes: Vec<_> = args.attributes.iter().map(|a| attribute(a, program)).collect::<Result<_, _>>()?;
        let start = |(number, mesh)| StartShape {
            attributes: attributes.clone(),
            start_rule: args.start.clone(),
            host: host.clone(),
            ..StartShape::new(mesh, Seed::root(args.seed), &name(number))
        };
        let starts = meshes.into_iter().enumerate().map(start).collect();
        trees = start_shapes::derive_all(program, starts, &FileAssets::new(access.clone()));
    }
    let reported = |(number, tree): (usize, &ShapeTree)| (name(number), tree.reports.clone());
    let features = trees.iter().enumerate().map(reported).collect();
    let mut tree = start_shapes::joined(trees);
    diagnostics.extend(std::mem::take(&mut tree.diagnostics));
    tree.diagnostics = diagnostics;
    report::print(&tree.diagnostics, &sources, quiet);
    if program.is_some() || args.format == DeriveFormat::Json {
        write(&tree, &outline, args, &access, &sources)?;
    }
    if program.is_some() {
        let scene = args.rules.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        reports::write(args.reports.as_ref(), &[SceneReports { scene, features }])?;
    }
    // The tree and the JSON hold the reports themselves.
    if !quiet && !matches!(args.format, DeriveFormat::Tree | DeriveFormat::Json) {
        eprint!("{}", table(&tree.reports));
    }
    if tree.diagnostics.has_errors() { Err(Failure::said()) } else { Ok(()) }
}

/// `mansard dump tree`: the tree on a 10 m × 8 m footprint.
pub fn dump(file: &Path, quiet: bool) -> Result<(), Failure> {
    let args = DeriveArgs {
        rules: file.to_owned(),
        footprint: vec!["0,0 10,0 10,-8 0,-8".to_owned()],
        street_width: Vec::new(),
        edge_attr: Vec::new(),
        start: None,
        attributes: Vec::new(),
        seed: 0,
        format: DeriveFormat::Tree,
        output: None,
        reports: None,
        allow: Vec::new(),
    };
    run(&args, quiet)
}

/// `footprint`, `footprint-2`, ...
fn name(number: usize) -> String {
    if number == 0 { "footprint".to_owned() } else { format!("footprint-{}", number + 1) }
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
    let kind = program.attributes().iter().find(|a| &*a.name == name).and_then(|a| a.kind);
    let value = match (kind, value, value.parse::<f64>()) {
        (Some(Type::String), text, _) => Scalar::String(text.into()),
        (_, "true", _) => Scalar::Bool(true),
        (_, "false", _) => Scalar::Bool(false),
        (_, _, Ok(number)) if number.is_finite() => Scalar::Float(number),
        (Some(Type::Float | Type::Bool), value, _) => {
            return Err(Failure::wrong(format!("--attr {text}: `{value}` is no value of `{name}`")));
        }
        (_, text, _) => Scalar::String(text.into()),
    };
    Ok((name.into(), value))
}

fn write(
    tree: &ShapeTree,
    outline: &Mesh,
    args: &DeriveArgs,
    access: &Access,
    sources: &SourceMap,
) -> Result<(), Failure> {
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
        DeriveFormat::Png => {
            let picture = portrait(tree, outline, access, PICTURE).map_err(|e| report::failure(e, sources))?;
            let mut bytes = std::io::Cursor::new(Vec::new());
            picture.write_to(&mut bytes, image::ImageFormat::Png).expect("an RGB image in memory is encoded");
            bytes.into_inner()
        }
    };
    match &args.output {
        Some(path) => write_bytes(path, &bytes).map_err(|e| Failure::unable(e.to_string())),
        None => report::out_bytes(&bytes),
    }
}
