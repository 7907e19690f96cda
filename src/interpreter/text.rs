//! The tree for people (`mansard derive --format tree`). In: a tree. Out: one line per leaf, then a table of reports, then prints.

use std::fmt::Write;

use super::reports::table;
use super::tree::{Leaf, ShapeTree};
use super::value::format_float;

pub fn to_text(tree: &ShapeTree) -> String {
    let mut out = String::new();
    for leaf in &tree.leaves {
        leaf_line(&mut out, leaf);
    }
    out.push_str(&table(&tree.reports));
    for line in &tree.prints {
        add(&mut out, format_args!("print {line}"));
    }
    out
}

fn add(out: &mut String, line: std::fmt::Arguments) {
    writeln!(out, "{line}").expect("writing to a string cannot fail");
}

/// `0.2.1 Wall  #ffffff  4 vertices, 1 face, box 0 0 -10 … 20 8 0`.
fn leaf_line(out: &mut String, leaf: &Leaf) {
    let path: Vec<String> = leaf.path.iter().map(u32::to_string).collect();
    let [r, g, b] = leaf.material.color.map(|c| (c * 255.0 + 0.5) as u8);
    let (low, high) = leaf.mesh.bounds().unwrap_or_default();
    let corner = |p: glam::DVec3| p.to_array().map(format_float).join(" ");
    let (vertices, faces) = (leaf.mesh.positions.len(), leaf.mesh.faces.len());
    let texture = leaf.material.colormap.as_deref().map(|t| format!("  {t}")).unwrap_or_default();
    add(
        out,
        format_args!(
            "{} {}  #{r:02x}{g:02x}{b:02x}{texture}  {vertices} vertices, {faces} faces, box {} … {}",
            path.join("."),
            leaf.rule,
            corner(low),
            corner(high)
        ),
    );
}
