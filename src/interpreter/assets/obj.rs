//! Wavefront OBJ. In: the bytes of a file and a way to its material libraries. Out: faces with texture coordinates,
//! normals, groups and materials, or the line that is wrong.
//!
//! Read: `v`, `vt`, `vn`, `f` (also negative indices), `g` (the first name), `usemtl`, `mtllib`; of libraries `Kd`, `d`,
//! `Tr`, `map_Kd`. All other statements are skipped.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::AssetError;
use crate::geometry::Face;
use crate::geometry::mesh::{CornerUvs, Loop, UvSets};
use crate::interpreter::appearance::Appearance;
use crate::interpreter::form::Form;
use crate::interpreter::labels::GroupList;

/// Builds the form while the file is read.
struct Reader<'a> {
    name: &'a str,
    texture: Vec<DVec2>,
    normals: Vec<DVec3>,
    groups: GroupList,
    form: Form,
    materials: Vec<(String, Appearance)>,
    current: u16,
}

pub fn read(
    name: &str,
    bytes: &[u8],
    folder: &Path,
    library: &dyn Fn(&str) -> Option<Vec<u8>>,
) -> Result<Form, AssetError> {
    let text = String::from_utf8_lossy(bytes);
    let mut reader = Reader {
        name,
        texture: Vec::new(),
        normals: Vec::new(),
        groups: GroupList::default(),
        form: Form::default(),
        materials: Vec::new(),
        current: 0,
    };
    for (number, line) in text.lines().enumerate() {
        let (keyword, rest) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
        match keyword {
            "v" => {
                let p = reader.numbers::<3>(rest, number)?;
                reader.form.mesh.positions.push(DVec3::from_array(p));
            }
            "vt" => {
                let uv = reader.numbers::<2>(rest, number)?;
                reader.texture.push(DVec2::from_array(uv));
            }
            "vn" => {
                let n = reader.numbers::<3>(rest, number)?;
                reader.normals.push(DVec3::from_array(n).normalize_or_zero());
            }
            "g" => reader.groups.begin(rest.split_whitespace().next().unwrap_or("")),
            "f" => reader.face(rest, number)?,
            "mtllib" => {
                let materials = library(rest.trim()).map(|bytes| library_materials(&bytes, folder));
                reader.materials.extend(materials.unwrap_or_default());
            }
            "usemtl" => reader.use_material(rest.trim()),
            _ => {}
        }
    }
    Ok(reader.finish())
}

impl Reader<'_> {
    fn error(&self, line: usize, message: impl Into<String>) -> AssetError {
        AssetError::Obj { name: self.name.to_owned(), line: line + 1, message: message.into() }
    }

    fn numbers<const N: usize>(&self, text: &str, line: usize) -> Result<[f64; N], AssetError> {
        let mut out = [0.0; N];
        let mut words = text.split_whitespace();
        for slot in &mut out {
            let word = words.next().ok_or_else(|| self.error(line, format!("{N} numbers were expected")))?;
            let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
            *slot = number.ok_or_else(|| self.error(line, format!("`{word}` is no number")))?;
        }
        Ok(out)
    }

    fn index(&self, word: &str, count: usize, line: usize) -> Result<usize, AssetError> {
        let wrong = || self.error(line, format!("`{word}` is no index of {count} entries"));
        let index: i64 = word.parse().map_err(|_| wrong())?;
        let place = if index < 0 { count as i64 + index } else { index - 1 };
        usize::try_from(place).ok().filter(|&i| i < count).ok_or_else(wrong)
    }

    fn face(&mut self, rest: &str, line: usize) -> Result<(), AssetError> {
        let mut outer = Loop::new();
        let mut uv = CornerUvs::new();
        let mut normals = Vec::new();
        for corner in rest.split_whitespace() {
            let mut parts = corner.split('/');
            let position = parts.next().unwrap_or("");
            outer.push(self.index(position, self.form.mesh.positions.len(), line)? as u32);
            if let Some(texture) = parts.next().filter(|t| !t.is_empty()) {
                uv.push(self.texture[self.index(texture, self.texture.len(), line)?]);
            }
            if let Some(normal) = parts.next().filter(|n| !n.is_empty()) {
                normals.push(self.normals[self.index(normal, self.normals.len(), line)?]);
            }
        }
        if outer.len() < 3 {
            return Err(self.error(line, "a face needs three corners"));
        }
        let uvs = if uv.len() == outer.len() { [(0, uv)].into() } else { UvSets::new() };
        if normals.len() != outer.len() || normals.contains(&DVec3::ZERO) {
            normals.clear();
        }
        self.form.mesh.faces.push(Face { uvs, normals, ..Face::new(outer) });
        self.groups.add_face();
        self.form.face_materials.push(self.current);
        Ok(())
    }

    fn use_material(&mut self, name: &str) {
        let known = self.materials.iter().position(|(n, _)| n == name);
        let place = known.unwrap_or_else(|| {
            let appearance = Appearance { name: Some(name.into()), ..Appearance::default() };
            self.materials.push((name.to_owned(), appearance));
            self.materials.len() - 1
        });
        self.current = u16::try_from(place + 1).unwrap_or(0);
    }

    /// Texture coordinates and normals are kept only where all faces have them; unused vertices go.
    fn finish(self) -> Form {
        let mut form = self.form;
        if !form.mesh.faces.iter().all(|f| !f.uvs.is_empty()) {
            form.mesh.faces.iter_mut().for_each(|f| f.uvs.clear());
        }
        if !form.mesh.faces.iter().all(|f| !f.normals.is_empty()) {
            form.mesh.faces.iter_mut().for_each(|f| f.normals.clear());
        }
        form.labels = self.groups.into_labels();
        if form.face_materials.iter().all(|&m| m == 0) {
            form.face_materials.clear();
        }
        form.materials = self.materials.into_iter().map(|(_, appearance)| appearance).collect();
        let faces: Vec<usize> = (0..form.mesh.faces.len()).collect();
        Form { instanced: true, ..form.part(&faces) }
    }
}

/// Materials of a `.mtl` file by name.
fn library_materials(bytes: &[u8], folder: &Path) -> Vec<(String, Appearance)> {
    let text = String::from_utf8_lossy(bytes);
    let mut out: Vec<(String, Appearance)> = Vec::new();
    for line in text.lines() {
        let (keyword, rest) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
        let numbers: Vec<f64> = rest.split_whitespace().filter_map(|w| w.parse().ok()).collect();
        if keyword == "newmtl" {
            let name: Arc<str> = rest.trim().into();
            out.push((name.to_string(), Appearance { name: Some(name), ..Appearance::default() }));
        }
        let Some((_, material)) = out.last_mut() else { continue };
        match (keyword, numbers.as_slice()) {
            ("Kd", &[r, g, b, ..]) => material.color = [r, g, b].map(|c: f64| Some(c.clamp(0.0, 1.0))),
            ("d", &[d, ..]) => material.opacity = Some(d.clamp(0.0, 1.0)),
            ("Tr", &[t, ..]) => material.opacity = Some((1.0 - t).clamp(0.0, 1.0)),
            ("map_Kd", _) => {
                let file = rest.split_whitespace().last().unwrap_or("");
                material.colormap = Some(folder.join(file).to_string_lossy().into());
            }
            _ => {}
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Form, AssetError> {
        let library = |_: &str| Some(b"newmtl red\nKd 1 0 0\nd 0.5\n".to_vec());
        read("a.obj", text.as_bytes(), Path::new("x"), &library)
    }

    #[test]
    fn reads_faces_with_materials_and_negative_indices() {
        let form = parse(
            "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nusemtl red\nf 1/1 2/1 3/1\nf -4/-1 -2/1 -1/1\n",
        );
        let form = form.expect("the file is sound");
        assert_eq!(form.mesh.faces[1].outer[..], [0, 2, 3]);
        assert_eq!(form.face_materials, [1, 1]);
        assert_eq!(form.materials[0].color, [Some(1.0), Some(0.0), Some(0.0)]);
        assert_eq!(form.materials[0].opacity, Some(0.5));
        assert_eq!(form.mesh.faces[0].uv(0).map(<[DVec2]>::len), Some(3));
    }

    #[test]
    fn reads_groups_and_normals() {
        let form = parse(
            "v 0 0 0\nv 1 0 0\nv 1 0 1\nvn 0 2 0\ng roof extra\nf 1//1 2//1 3//1\ng wall\nf 3//1 2//1 1//-1\ng\nf 1//1 2//1 3//1\n",
        );
        let form = form.expect("the file is sound");
        let groups: Vec<_> = (0..3).map(|f| form.group_name(form.group(f)).to_string()).collect();
        assert_eq!(groups, ["roof", "wall", ""]);
        assert_eq!(form.mesh.faces[1].normals, [DVec3::Y; 3]);
        let some = parse("v 0 0 0\nv 1 0 0\nv 1 0 1\nvn 0 2 0\nf 1//1 2//1 3//1\nf 1 2 3\n").expect("sound too");
        assert!(some.mesh.faces.iter().all(|f| f.normals.is_empty()), "all or none");
    }

    #[test]
    fn names_the_line_that_is_wrong() {
        for (text, line) in
            [("v 0 0\n", 1), ("v 0 0 0\nf 1 2 3\n", 2), ("v 0 0 x\n", 1), ("v 0 0 0\n\nf 1 1\n", 3), ("v 0 0 nan", 1)]
        {
            match parse(text) {
                Err(AssetError::Obj { line: found, .. }) => assert_eq!(found, line, "{text}"),
                other => panic!("{text}: {other:?}"),
            }
        }
    }
}
