//! The JSON of `mansard derive` (issue 2). In: a tree and the texts its diagnostics point into. Out: one JSON object,
//! numbers in f64 as computed.

use serde_json::{Map, Value, json};

use super::material::{MapTransform, Material};
use super::reports::Report;
use super::tree::{Leaf, Scalar, ShapeTree};
use crate::diagnostics::Rendered;
use crate::source::SourceMap;

/// `{"leaves", "reports", "prints", "diagnostics"}`.
pub fn to_json(tree: &ShapeTree, sources: &SourceMap) -> Value {
    let diagnostics: Vec<Value> = tree
        .diagnostics
        .iter()
        .map(|d| serde_json::to_value(Rendered::new(d, sources)).expect("plain strings and numbers serialise"))
        .collect();
    let reports: Map<String, Value> = tree.reports.iter().map(|r| (report_key(r, &tree.reports), report(r))).collect();
    json!({
        "leaves": tree.leaves.iter().map(leaf).collect::<Vec<_>>(),
        "reports": reports,
        "prints": tree.prints,
        "diagnostics": diagnostics,
    })
}

fn leaf(leaf: &Leaf) -> Value {
    let attributes: Map<String, Value> = leaf.attributes.iter().map(|(n, v)| (n.to_string(), scalar(v))).collect();
    let vertices: Vec<[f64; 3]> = leaf.mesh.positions.iter().map(|p| p.to_array()).collect();
    let faces: Vec<Value> = leaf.mesh.faces.iter().map(|f| json!({ "outer": f.outer, "holes": f.holes })).collect();
    json!({
        "rule": &*leaf.rule,
        "attributes": attributes,
        "material": material(&leaf.material),
        "vertices": vertices,
        "faces": faces,
        "uvs": uvs(leaf),
    })
}

/// By set: one list of `[u, v]` per corner, faces one after the other, each the outer loop first, then the holes.
/// A face without the set gives `null` for each of its corners.
fn uvs(leaf: &Leaf) -> Value {
    let mut sets: Vec<u8> = leaf.mesh.faces.iter().flat_map(|f| f.uvs.iter().map(|(set, _)| *set)).collect();
    sets.sort_unstable();
    sets.dedup();
    let list = |set: u8| {
        let corners = leaf.mesh.faces.iter().flat_map(|face| -> Vec<Value> {
            match face.uv(set) {
                Some(uv) => uv.iter().map(|p| json!([p.x, p.y])).collect(),
                None => face.corners().map(|_| Value::Null).collect(),
            }
        });
        Value::Array(corners.collect())
    };
    Value::Object(sets.into_iter().map(|set| (set.to_string(), list(set))).collect())
}

fn material(material: &Material) -> Value {
    let other: Map<String, Value> =
        material.other.iter().map(|(n, v)| (n.to_string(), Value::String(v.to_string()))).collect();
    let map = |path: &str, t: &MapTransform| json!({ "path": path, "scale": t.scale, "offset": t.offset, "rotation": t.rotation });
    let color = material.colormap.iter().map(|path| ("colormap".to_owned(), map(path, &material.colormap_transform)));
    let others = material.maps.iter().map(|m| (m.layer_name().to_owned(), map(&m.path, &m.transform)));
    let maps: Map<String, Value> = color.chain(others).collect();
    json!({
        "name": &*material.name,
        "color": material.color,
        "opacity": material.opacity,
        "opacity_mode": material.opacity_mode.name(),
        "opacity_cutoff": material.opacity_cutoff,
        "roughness": material.roughness,
        "metallic": material.metallic,
        "emissive": material.emissive,
        "double_sided": material.double_sided,
        "colormap": material.colormap.as_deref(),
        "maps": maps,
        "other": other,
    })
}

/// JSON has no NaN and no infinity: they become `null`.
fn scalar(value: &Scalar) -> Value {
    match value {
        Scalar::Float(x) => json!(x),
        Scalar::Bool(b) => json!(b),
        Scalar::String(s) => json!(&**s),
    }
}

/// The name; with the type where values of several types were reported under it.
fn report_key(report: &Report, all: &[Report]) -> String {
    match all.iter().filter(|r| r.name == report.name).count() {
        1 => report.name.to_string(),
        _ => format!("{} ({})", report.name, report.kind.name()),
    }
}

fn report(report: &Report) -> Value {
    json!({
        "type": report.kind.name(),
        "count": report.count,
        "sum": report.sum,
        "average": report.average(),
        "min": report.min,
        "max": report.max,
    })
}
