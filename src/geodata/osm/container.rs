//! What a file is. In: a byte stream. Out: the unpacked stream and the map format, both found by content.

use std::io::{self, BufRead, BufReader, Read};

use super::error::{Fault, MapError, MapPlace};

/// Map formats; Overpass JSON and GeoJSON are told apart while reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Xml,
    Pbf,
    Json,
}

/// A stream that counts what was taken from it.
pub(super) struct CountedReader<'a> {
    inner: Box<dyn BufRead + Send + 'a>,
    pub bytes: u64,
    /// Line of the next byte, from 1.
    pub line: u64,
}

impl CountedReader<'_> {
    pub fn place(&self) -> MapPlace {
        MapPlace::Line(self.line)
    }
}

impl Read for CountedReader<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let mut available = self.fill_buf()?;
        let count = available.read(out)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for CountedReader<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.inner.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        if let Ok(buffer) = self.inner.fill_buf() {
            self.line += buffer[..count.min(buffer.len())].iter().filter(|&&b| b == b'\n').count() as u64;
        }
        self.bytes += count as u64;
        self.inner.consume(count);
    }
}

pub(super) struct Opened<'a> {
    pub format: Format,
    pub reader: CountedReader<'a>,
}

const BUFFER: usize = 128 * 1024;

/// Unpacks .gz and .bz2 (also of several joined members) and recognises the format by its first bytes.
pub(super) fn open<'a>(input: impl Read + Send + 'a, name: &str) -> Result<Opened<'a>, MapError> {
    let fail = |error: io::Error| Fault::from_io(error, MapPlace::Line(1)).in_file(name);
    let mut raw = BufReader::with_capacity(BUFFER, input);
    let magic = raw.fill_buf().map_err(fail)?;
    let mut inner: Box<dyn BufRead + Send + 'a> = if magic.starts_with(&[0x1f, 0x8b]) {
        Box::new(BufReader::with_capacity(BUFFER, flate2::bufread::MultiGzDecoder::new(raw)))
    } else if magic.starts_with(b"BZh") {
        Box::new(BufReader::with_capacity(BUFFER, bzip2::bufread::MultiBzDecoder::new(raw)))
    } else {
        Box::new(raw)
    };
    let start = inner.fill_buf().map_err(fail)?;
    let format =
        recognise(start).map_err(|found| MapError::UnknownFormat { file: name.to_owned(), found: found.to_owned() })?;
    Ok(Opened { format, reader: CountedReader { inner, bytes: 0, line: 1 } })
}

/// The format of unpacked bytes, or a word for what they are instead.
fn recognise(start: &[u8]) -> Result<Format, &'static str> {
    let blob_header = start.get(4..15);
    if blob_header.is_some_and(|h| h.starts_with(b"\x0a\x09OSMHeader") || h.starts_with(b"\x0a\x07OSMData")) {
        return Ok(Format::Pbf);
    }
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    match text.iter().find(|b| !b.is_ascii_whitespace()) {
        Some(b'<') => Ok(Format::Xml),
        Some(b'{') => Ok(Format::Json),
        None if start.is_empty() => Err("an empty file"),
        None => Err("only white space"),
        Some(_) if start.starts_with(b"PK\x03\x04") => Err("a zip archive (unpack it first)"),
        Some(_) if start.starts_with(b"\xfd7zXZ") => Err("an xz archive (unpack it first)"),
        Some(_) if start.starts_with(b"\x28\xb5\x2f\xfd") => Err("a zstd archive (unpack it first)"),
        Some(_) if start.starts_with(b"SQLite format 3") => Err("an SQLite database (GeoPackage)"),
        Some(_) if start.starts_with(b"\xff\xfe") || start.starts_with(b"\xfe\xff") => Err("UTF-16 text"),
        Some(_) => Err("something else"),
    }
}
