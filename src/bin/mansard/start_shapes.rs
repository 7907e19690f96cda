//! The start shapes of `mansard derive`. In: footprints, street widths and edge attributes of the command line. Out:
//! meshes with host data, and one tree for all of them.

use mansard::cga::program::Program;
use mansard::geometry::{Face, Mesh};
use mansard::interpreter::assets::Assets;
use mansard::interpreter::context::{Batch, Member};
use mansard::interpreter::host::{EdgeAttribute, EdgeValues};
use mansard::interpreter::reports::Reports;
use mansard::interpreter::tree::ShapeTree;
use mansard::interpreter::{HostData, Limits, StartShape};

/// `EDGE=METRES` and `NAME=VALUE,VALUE,...`: numbers, `true` and `false`, or texts, one per edge from the first.
pub fn host(street_widths: &[String], edge_attributes: &[String]) -> Result<HostData, String> {
    let mut host = HostData::default();
    for text in street_widths {
        let wrong = || format!("--street-width {text}: write EDGE=METRES");
        let (edge, width) = text.split_once('=').ok_or_else(wrong)?;
        let edge = edge.trim().parse::<usize>().ok().filter(|e| *e < MOST_EDGES).ok_or_else(wrong)?;
        let width = width.trim().parse::<f64>().ok().filter(|w| w.is_finite()).ok_or_else(wrong)?;
        host.street_widths.resize(host.street_widths.len().max(edge + 1), 0.0);
        host.street_widths[edge] = width;
    }
    for text in edge_attributes {
        let wrong = || format!("--edge-attr {text}: write NAME=VALUE,VALUE,...");
        let (name, list) = text.split_once('=').ok_or_else(wrong)?;
        host.edge_attributes.push(EdgeAttribute { name: name.trim().into(), values: values(list) });
    }
    Ok(host)
}

const MOST_EDGES: usize = 100_000;

fn values(list: &str) -> EdgeValues {
    let items: Vec<&str> = list.split(',').map(str::trim).collect();
    if let Some(numbers) = items.iter().map(|t| t.parse::<f64>().ok()).collect::<Option<Vec<f64>>>() {
        return EdgeValues::Floats(numbers);
    }
    if let Some(truths) = items.iter().map(|t| t.parse::<bool>().ok()).collect::<Option<Vec<bool>>>() {
        return EdgeValues::Bools(truths);
    }
    EdgeValues::Strings(items.into_iter().map(Into::into).collect())
}

/// Derives start shapes that see each other, in order; with several, paths begin with the number of the start shape.
pub fn derive_all(program: &Program, starts: Vec<StartShape>, assets: &dyn Assets) -> Vec<ShapeTree> {
    let members: Vec<Member> =
        starts.into_iter().map(|start| Member { program, start: start.into(), is_in: 1, sees: 1 }).collect();
    let mut trees = Batch::new(&members, assets, &Limits::default()).derive_all();
    if trees.len() > 1 {
        for (number, leaf) in
            trees.iter_mut().enumerate().flat_map(|(n, tree)| tree.leaves.iter_mut().map(move |l| (n, l)))
        {
            leaf.path = std::iter::once(number as u32).chain(leaf.path.iter().copied()).collect();
        }
    }
    trees
}

/// All trees as one.
pub fn joined(trees: Vec<ShapeTree>) -> ShapeTree {
    let mut out = ShapeTree::default();
    let mut reports = Reports::default();
    for tree in trees {
        out.leaves.extend(tree.leaves);
        out.prints.extend(tree.prints);
        out.diagnostics.extend(tree.diagnostics);
        reports.merge(&tree.reports);
    }
    out.reports = reports.into_list();
    out
}

/// All meshes as one.
pub fn together(meshes: &[Mesh]) -> Mesh {
    let mut out = Mesh::default();
    for mesh in meshes {
        let start = out.positions.len() as u32;
        out.positions.extend(&mesh.positions);
        out.faces.extend(mesh.faces.iter().cloned().map(|mut face: Face| {
            face.loops_mut().flatten().for_each(|v| *v += start);
            face
        }));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_of_edges_is_read() {
        let texts = |list: &[&str]| list.iter().map(|t| (*t).to_owned()).collect::<Vec<_>>();
        let host =
            host(&texts(&["2=7.5", "0=4"]), &texts(&["a=1,2.5", "b=true, false", "c=x,1"])).expect("well formed");
        assert_eq!(host.street_widths, [4.0, 0.0, 7.5]);
        let values: Vec<EdgeValues> = host.edge_attributes.into_iter().map(|a| a.values).collect();
        assert_eq!(values[0], EdgeValues::Floats(vec![1.0, 2.5]));
        assert_eq!(values[1], EdgeValues::Bools(vec![true, false]));
        assert_eq!(values[2], EdgeValues::Strings(["x", "1"].map(Into::into).into()));
        for wrong in ["2", "x=1", "1=inf", "-1=2", "999999999999=2"] {
            assert!(super::host(&texts(&[wrong]), &[]).is_err(), "{wrong}");
        }
        assert!(super::host(&[], &texts(&["a"])).is_err());
    }
}
