//! Material files (reference 6.9, `readMaterial`). In: the bytes of a `.cgamat` file (a line per attribute: name, comma,
//! value) or of a `.mtl` file (its first material). Out: name and value pairs; textures under the names they are loaded by.

use super::{Pairs, mtl, table, text_file};
use crate::cga::builtins::{Attr, MapPart, MaterialAttr};

const MOST_CELLS: usize = 10_000;

pub fn read_cgamat(bytes: &[u8], place: &dyn Fn(&str) -> String) -> Result<Pairs, String> {
    let table = table::read(&text_file::read(bytes), MOST_CELLS)?;
    if table.columns != 2 && table.rows > 0 {
        return Err(format!("it has {} columns, not a name and a value", table.columns));
    }
    let pairs = table.items.chunks_exact(2).map(|pair| match is_texture(&pair[0]) {
        true if !pair[1].is_empty() && !pair[1].starts_with("builtin:") => (pair[0].clone(), place(&pair[1]).into()),
        _ => (pair[0].clone(), pair[1].clone()),
    });
    Ok(pairs.collect())
}

pub fn read_mtl(bytes: &[u8], place: &dyn Fn(&str) -> String) -> Result<Pairs, String> {
    let materials = mtl::read(bytes, place);
    let (_, first) = materials.first().ok_or("it holds no material")?;
    Ok(first.pairs())
}

fn is_texture(name: &str) -> bool {
    let attr = Attr::from_name(&format!("material.{name}")).map(|row| row.attr);
    matches!(attr, Some(Attr::Material(MaterialAttr::Map(_, MapPart::Path))))
}
