//! What can be wrong with a map file: always the file and the place in it.

use std::io;

/// Where in a file (after unpacking .gz or .bz2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapPlace {
    /// Line, from 1.
    Line(u64),
    /// Line and column, from 1.
    LineColumn(u64, u64),
    /// PBF blob, from 1, and the byte where it starts.
    Blob { number: u64, byte: u64 },
}

impl std::fmt::Display for MapPlace {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            MapPlace::Line(line) => write!(f, "line {line}"),
            MapPlace::LineColumn(line, column) => write!(f, "line {line}, column {column}"),
            MapPlace::Blob { number, byte } => write!(f, "blob {number} at byte {byte}"),
        }
    }
}

/// Why a map file could not be read. Nothing of such a file is used.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    #[error("{file}: {source}")]
    Io { file: String, source: io::Error },
    #[error("{file}: not a map: expected OSM XML, PBF, Overpass JSON or GeoJSON (plain, .gz or .bz2), found {found}")]
    UnknownFormat { file: String, found: String },
    #[error("{file}: {place}: {message}")]
    Malformed { file: String, place: MapPlace, message: String },
    #[error("{file}: {place}: the file ends in the middle of its data")]
    Truncated { file: String, place: MapPlace },
}

/// A [`MapError`] before the file's name is known.
#[derive(Debug)]
pub(super) enum Fault {
    Io(io::Error),
    Malformed(MapPlace, String),
    Truncated(MapPlace),
}

impl Fault {
    pub(super) fn in_file(self, file: &str) -> MapError {
        let file = file.to_owned();
        match self {
            Fault::Io(source) => MapError::Io { file, source },
            Fault::Malformed(place, message) => MapError::Malformed { file, place, message },
            Fault::Truncated(place) => MapError::Truncated { file, place },
        }
    }

    /// Sorts an error of a (decompressing) reader into the three kinds.
    pub(super) fn from_io(error: io::Error, place: MapPlace) -> Fault {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => Fault::Truncated(place),
            io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput => Fault::Malformed(place, error.to_string()),
            _ => Fault::Io(error),
        }
    }
}
