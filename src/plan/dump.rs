//! Dump: a plan as text for people, JSON for programs, DOT for graphviz.

use std::fmt::Write;

use serde_json::{Value, json};

use super::pass::{Pass, PassKind, PipelineKey, RenderPlan, Surface, ViewPlan};
use super::resource::ResourceId;

impl PipelineKey {
    /// Stable name, also the label on the GPU.
    pub fn name(self) -> String {
        match self {
            PipelineKey::ShadowMap { cutout } => format!("shadow_map{}", cutout_suffix(cutout)),
            PipelineKey::Ids { cutout } => format!("ids{}", cutout_suffix(cutout)),
            PipelineKey::Depth { cutout } => format!("depth{}", cutout_suffix(cutout)),
            PipelineKey::ShadowBounds { first: true } => "shadow_bounds".to_owned(),
            PipelineKey::ShadowBounds { first: false } => "shadow_bounds.coarse".to_owned(),
            PipelineKey::Resolve { supersample, linear } => {
                format!("resolve.{supersample}x{supersample}{}", if linear { ".linear" } else { "" })
            }
            PipelineKey::Shade { surface, terms } => {
                let surface = match surface {
                    Surface::Plain => "plain",
                    Surface::Textured => "textured",
                    Surface::Cutout => "cutout",
                };
                [&["shade", surface][..], &terms.words()].concat().join(".")
            }
        }
    }
}

fn cutout_suffix(cutout: bool) -> &'static str {
    if cutout { ".cutout" } else { "" }
}

/// One block per view: passes in order, what they read and write, what leaves, what is not done and why.
pub fn text(plan: &RenderPlan) -> String {
    let mut out = String::new();
    let counts = plan.counts();
    let _ = writeln!(
        out,
        "{} views, {} passes, {} render targets, {} pipelines",
        plan.views.len(),
        counts.passes,
        counts.textures,
        counts.pipelines
    );
    for view in &plan.views {
        let _ = writeln!(out, "view {} ({} x {})", view.name, view.camera.width, view.camera.height);
        for stage in &view.stages {
            for pass in &stage.passes {
                let _ = writeln!(out, "  {:<13} {}", pass.kind.stem(), pass_line(view, pass));
            }
            for product in &stage.products {
                let source = name(view, product.source);
                let _ = writeln!(out, "    -> {} ({:?}) from {source}", product.pass, product.output);
            }
        }
        for skipped in &view.skipped {
            let _ = writeln!(out, "  no {}: {}", skipped.what, skipped.reason);
        }
    }
    out
}

fn pass_line(view: &ViewPlan, pass: &Pass) -> String {
    let mut line = String::new();
    if let Some(draw) = pass.kind.draw() {
        let objects = draw.objects.iter().filter(|&&o| o).count();
        let _ = write!(line, "{:?}: {objects} objects, {} triangles; ", draw.state, draw.triangles);
    }
    if !pass.reads.is_empty() {
        let _ = write!(line, "reads {}; ", names(view, &pass.reads));
    }
    let _ = write!(line, "writes {}", names(view, &pass.writes));
    match &pass.kind {
        PassKind::ShadowMap { light, .. } => {
            let _ = write!(line, "; texel {:.3} x {:.3} m", light.texel.x, light.texel.y);
        }
        PassKind::SkyMaps { frames, .. } => {
            let _ = write!(line, "; from {} directions", frames.len());
        }
        PassKind::Field { frame, .. } => {
            let side = (frame.high - frame.low) / f64::from(frame.size);
            let _ = write!(line, "; texel {:.3} x {:.3} m", side.x, side.y);
        }
        PassKind::Shade { light, .. } if !light.terms().words().is_empty() => {
            let _ = write!(line, "; {}", light.terms().words().join(", "));
        }
        _ => {}
    }
    line
}

fn name(view: &ViewPlan, id: ResourceId) -> &str {
    &view.resources[id.0].name
}

fn names(view: &ViewPlan, ids: &[ResourceId]) -> String {
    ids.iter().map(|&id| name(view, id)).collect::<Vec<_>>().join(", ")
}

/// The same facts as [`text`], one object for the plan.
pub fn json(plan: &RenderPlan) -> Value {
    let counts = plan.counts();
    json!({
        "passes": counts.passes,
        "render_targets": counts.textures,
        "pipelines": counts.pipelines,
        "views": plan.views.iter().map(view_json).collect::<Vec<_>>(),
    })
}

fn view_json(view: &ViewPlan) -> Value {
    let resources = view.resources.iter().map(|r| {
        let t = r.texture;
        json!({ "name": r.name, "format": t.format.name(), "width": t.width, "height": t.height,
                "layers": t.layers, "samples_per_side": t.supersample })
    });
    let products = view.stages.iter().flat_map(|s| &s.products).map(
        |p| json!({ "pass": p.pass, "output": format!("{:?}", p.output).to_lowercase(), "source": name(view, p.source) }),
    );
    let skipped = view.skipped.iter().map(|s| json!({ "what": s.what, "reason": s.reason }));
    json!({
        "name": view.name,
        "width": view.camera.width,
        "height": view.camera.height,
        "resources": resources.collect::<Vec<_>>(),
        "passes": view.passes().map(|pass| pass_json(view, pass)).collect::<Vec<_>>(),
        "products": products.collect::<Vec<_>>(),
        "skipped": skipped.collect::<Vec<_>>(),
    })
}

fn pass_json(view: &ViewPlan, pass: &Pass) -> Value {
    let ids = |ids: &[ResourceId]| ids.iter().map(|&id| name(view, id)).collect::<Vec<_>>();
    let mut value = json!({
        "pass": pass.kind.stem(),
        "reads": ids(&pass.reads),
        "writes": ids(&pass.writes),
        "pipelines": pass.pipelines.iter().map(|p| p.name()).collect::<Vec<_>>(),
    });
    if let Some(draw) = pass.kind.draw() {
        value["state"] = format!("{:?}", draw.state).to_lowercase().into();
        value["objects"] = draw.objects.iter().filter(|&&o| o).count().into();
        value["triangles"] = draw.triangles.into();
    }
    if let PassKind::Shade { light, .. } = &pass.kind {
        value["terms"] = light.terms().words().into();
    }
    value
}

/// Passes as boxes, resources as ellipses, images as notes.
pub fn dot(plan: &RenderPlan) -> String {
    let mut out = String::from("digraph plan {\n  rankdir=LR;\n");
    for (v, view) in plan.views.iter().enumerate() {
        let _ = writeln!(out, "  subgraph cluster_{v} {{\n    label={:?};", view.name);
        for (r, resource) in view.resources.iter().enumerate() {
            let _ = writeln!(out, "    v{v}r{r} [label={:?}];", resource.name);
        }
        for (p, pass) in view.passes().enumerate() {
            let _ = writeln!(out, "    v{v}p{p} [shape=box, label={:?}];", pass.kind.stem());
            for id in &pass.reads {
                let _ = writeln!(out, "    v{v}r{} -> v{v}p{p};", id.0);
            }
            for id in &pass.writes {
                let _ = writeln!(out, "    v{v}p{p} -> v{v}r{};", id.0);
            }
        }
        for product in view.stages.iter().flat_map(|s| &s.products) {
            let (o, source) = (product.index, product.source.0);
            let _ =
                writeln!(out, "    v{v}o{o} [shape=note, label={:?}];\n    v{v}r{source} -> v{v}o{o};", product.pass);
        }
        out.push_str("  }\n");
    }
    out.push_str("}\n");
    out
}
