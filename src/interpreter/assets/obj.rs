//! Wavefront OBJ. In: the bytes of a file and a way to its material libraries. Out: faces with texture coordinates,
//! normals, materials and groups, or the line that is wrong.
//!
//! Read: `v`, `vt`, `vn`, `f` (also negative indices), `g` (the first name), `o`, `usemtl`, `mtllib`. All other statements are skipped.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::{Contents, Files, mtl};
use crate::geometry::Face;
use crate::geometry::mesh::{CornerUvs, Loop, UvSets};
use crate::interpreter::appearance::Appearance;

/// A line that is wrong, counted from 1, and why.
pub type Wrong = (usize, String);

/// Builds the contents while the file is read.
struct Reader<'a> {
    files: &'a Files<'a>,
    texture: Vec<DVec2>,
    normals: Vec<DVec3>,
    out: Contents,
    materials: Vec<Appearance>,
    /// Places in `materials` by name.
    named: BTreeMap<String, u16>,
    current: u16,
}

pub fn read(bytes: &[u8], files: &Files) -> Result<Contents, Wrong> {
    let text = String::from_utf8_lossy(bytes);
    let mut reader = Reader {
        files,
        texture: Vec::new(),
        normals: Vec::new(),
        out: Contents::default(),
        materials: Vec::new(),
        named: BTreeMap::new(),
        current: 0,
    };
    let mut lines = text.lines().zip(1..);
    while let Some((line, number)) = lines.next() {
        let mut statement = line.split('#').next().unwrap_or("").trim().to_owned();
        // A backslash at the end of a line joins the next one.
        while let Some(open) = statement.strip_suffix('\\') {
            let next = lines.next().map_or("", |(line, _)| line);
            statement = format!("{open} {}", next.split('#').next().unwrap_or("").trim());
        }
        let (keyword, rest) = statement.split_once(char::is_whitespace).unwrap_or((&statement, ""));
        reader.statement(keyword, rest.trim()).map_err(|why| (number, why))?;
    }
    Ok(reader.finish())
}

impl Reader<'_> {
    fn statement(&mut self, keyword: &str, rest: &str) -> Result<(), String> {
        match keyword {
            "v" => self.out.form.mesh.positions.push(DVec3::from_array(numbers::<3>(rest, 3)?)),
            "vt" => self.texture.push(DVec2::from_array(numbers::<2>(rest, 1)?)),
            "vn" => self.normals.push(DVec3::from_array(numbers::<3>(rest, 3)?).normalize_or_zero()),
            "f" => self.face(rest)?,
            "g" => self.out.begin_group(rest.split_whitespace().next().unwrap_or(""))?,
            "o" => self.out.begin_group(rest)?,
            "mtllib" => self.library(rest)?,
            "usemtl" => self.use_material(rest)?,
            _ => {}
        }
        Ok(())
    }

    fn face(&mut self, rest: &str) -> Result<(), String> {
        let (mut outer, mut uv, mut normals) = (Loop::new(), CornerUvs::new(), Vec::new());
        for corner in rest.split_whitespace() {
            let mut parts = corner.split('/');
            outer.push(index(parts.next().unwrap_or(""), self.out.form.mesh.positions.len())? as u32);
            if let Some(place) = parts.next().filter(|t| !t.is_empty()) {
                uv.push(self.texture[index(place, self.texture.len())?]);
            }
            if let Some(place) = parts.next().filter(|n| !n.is_empty()) {
                normals.push(self.normals[index(place, self.normals.len())?]);
            }
        }
        if outer.len() < 3 {
            return Err("a face needs three corners".into());
        }
        let uvs = if uv.len() == outer.len() { [(0, uv)].into() } else { UvSets::new() };
        let whole = normals.len() == outer.len() && normals.iter().all(|n| *n != DVec3::ZERO);
        let face = Face { uvs, normals: if whole { normals } else { Vec::new() }, ..Face::new(outer) };
        self.out.face(face, self.current);
        Ok(())
    }

    /// Names with spaces are one name if there is such a file, else several.
    fn library(&mut self, rest: &str) -> Result<(), String> {
        let whole = (self.files.read)(rest).map(|bytes| vec![(rest, bytes)]);
        let found = whole.unwrap_or_else(|_| {
            let read = |name| match (self.files.read)(name) {
                Ok(bytes) => Some((name, bytes)),
                Err(why) => {
                    self.out.notes.push(why);
                    None
                }
            };
            rest.split_whitespace().filter_map(read).collect()
        });
        for (name, bytes) in found {
            let folder = name.rfind('/').map_or("", |slash| &name[..=slash]);
            let place = |file: &str| (self.files.place)(&format!("{folder}{file}"));
            for (name, appearance) in mtl::read(&bytes, &place) {
                self.material(&name, appearance)?;
            }
        }
        Ok(())
    }

    /// The number of a material, new or known: its place in `materials` plus one.
    fn material(&mut self, name: &str, appearance: Appearance) -> Result<u16, String> {
        if let Some(&known) = self.named.get(name) {
            return Ok(known);
        }
        self.materials.push(appearance);
        let number = u16::try_from(self.materials.len()).map_err(|_| "there are too many materials")?;
        self.named.insert(name.to_owned(), number);
        Ok(number)
    }

    fn use_material(&mut self, name: &str) -> Result<(), String> {
        let unknown = Appearance { name: Some(name.into()), ..Appearance::default() };
        self.current = self.material(name, unknown)?;
        Ok(())
    }

    fn finish(mut self) -> Contents {
        self.out.form.materials = self.materials.into();
        self.out.even_channels();
        self.out
    }
}

/// The first `least` to `N` numbers of a statement; those that are missing are 0.
fn numbers<const N: usize>(text: &str, least: usize) -> Result<[f64; N], String> {
    let mut out = [0.0; N];
    let mut words = text.split_whitespace();
    for (place, slot) in out.iter_mut().enumerate() {
        let Some(word) = words.next() else {
            if place < least {
                return Err(format!("{least} numbers were expected"));
            }
            break;
        };
        let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
        *slot = number.ok_or_else(|| format!("`{word:.40}` is no number"))?;
    }
    Ok(out)
}

/// Indices count from 1, negative ones from the end.
fn index(word: &str, count: usize) -> Result<usize, String> {
    let wrong = || format!("`{word:.40}` is no index of {count} entries");
    let index: i64 = word.parse().map_err(|_| wrong())?;
    let place = if index < 0 { (count as i64).checked_add(index) } else { Some(index - 1) };
    place.and_then(|place| usize::try_from(place).ok()).filter(|&i| i < count).ok_or_else(wrong)
}
