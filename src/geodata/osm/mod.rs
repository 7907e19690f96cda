//! Map files → [`OsmData`]. In: OSM XML, PBF, Overpass JSON, GeoJSON, plain or packed. Out: nodes, ways, relations, shapes.
//!
//! The format is found by content, never by name. A damaged file is an error with its place; nothing of it is used.

mod container;
mod data;
mod error;
mod json;
mod pbf;
mod xml;

#[cfg(test)]
mod tests;

use std::path::PathBuf;

pub use container::Format;
pub use data::{LonLatBox, Member, OsmBuilder, OsmData, Position, Relation, Shape, ShapeGeometry, TagsView, Way};
pub use error::{MapError, MapPlace};

use container::Opened;

/// Reads all files into one map; of objects with the same id the one read first stays. `heard` is told of every run of
/// bytes that was read.
pub fn read_files(paths: &[PathBuf], heard: &(dyn Fn(u64) + Sync)) -> Result<OsmData, MapError> {
    let mut builder = OsmBuilder::default();
    for path in paths {
        let name = path.display().to_string();
        let file = std::fs::File::open(path).map_err(|source| MapError::Io { file: name.clone(), source })?;
        read_stream(Counted { file, heard }, &name, &mut builder)?;
    }
    Ok(builder.finish())
}

/// A file that tells how much of it was read.
struct Counted<'a> {
    file: std::fs::File,
    heard: &'a (dyn Fn(u64) + Sync),
}

impl std::io::Read for Counted<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.file.read(buffer)?;
        (self.heard)(count as u64);
        Ok(count)
    }
}

/// Reads one file from any byte stream; `name` is for errors. Gives the format that was found.
pub fn read_stream(input: impl std::io::Read + Send, name: &str, builder: &mut OsmBuilder) -> Result<Format, MapError> {
    let Opened { format, reader } = container::open(input, name)?;
    let done = match format {
        Format::Xml => xml::read(reader, builder),
        Format::Pbf => pbf::read(reader, builder),
        Format::Json => json::read(reader, builder),
    };
    done.map(|()| format).map_err(|fault| fault.in_file(name))
}
