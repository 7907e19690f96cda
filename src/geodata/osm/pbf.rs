//! OSM PBF, block by block. In: the bytes. Out: its objects in the builder.
//!
//! The frame (length, BlobHeader, Blob; <https://wiki.openstreetmap.org/wiki/PBF_Format>) is read here, because the
//! `osmpbf` crate takes a cut length for the end and cannot unpack LZ4; each unpacked blob is decoded by the crate.

use std::io::{self, ErrorKind, Read};

use osmpbf::{BlobReader, RelMemberType};

use super::container::CountedReader;
use super::data::{LonLatBox, OsmBuilder, Position};
use super::error::{Fault, MapPlace};
use crate::geodata::feature::ObjectKind;

/// Limits of the format.
const MAX_HEADER: usize = 64 * 1024;
const MAX_BLOB: usize = 32 * 1024 * 1024;

/// Required features that this reader understands.
const FEATURES: [&str; 2] = ["OsmSchema-V0.6", "DenseNodes"];

/// Reads all blobs to the end of the stream.
pub(super) fn read(mut input: CountedReader, builder: &mut OsmBuilder) -> Result<(), Fault> {
    let mut number = 0;
    loop {
        number += 1;
        let place = MapPlace::Blob { number, byte: input.bytes };
        let Some((kind, blob)) = next_blob(&mut input).map_err(|e| e.at(place))? else { return Ok(()) };
        let decoded = match kind.as_str() {
            "OSMHeader" => header(&blob, builder),
            "OSMData" => data(&blob, builder),
            _ => Ok(()),
        };
        decoded.map_err(|e| e.at(place))?;
    }
}

/// A fault whose place is the blob.
enum BlobFault {
    Io(io::Error),
    Bad(String),
}

impl BlobFault {
    fn at(self, place: MapPlace) -> Fault {
        match self {
            BlobFault::Io(error) => Fault::from_io(error, place),
            BlobFault::Bad(message) => Fault::Malformed(place, message),
        }
    }
}

impl From<io::Error> for BlobFault {
    fn from(error: io::Error) -> Self {
        BlobFault::Io(error)
    }
}

impl From<osmpbf::Error> for BlobFault {
    fn from(error: osmpbf::Error) -> Self {
        BlobFault::Bad(error.to_string())
    }
}

fn bad<T>(message: impl Into<String>) -> Result<T, BlobFault> {
    Err(BlobFault::Bad(message.into()))
}

/// Type and unpacked message of the next blob; `None` at the end.
fn next_blob(input: &mut CountedReader) -> Result<Option<(String, Vec<u8>)>, BlobFault> {
    let mut length = Vec::new();
    input.by_ref().take(4).read_to_end(&mut length)?;
    let Ok(length) = <[u8; 4]>::try_from(length.as_slice()) else {
        return if length.is_empty() { Ok(None) } else { Err(io::Error::from(ErrorKind::UnexpectedEof))? };
    };
    let length = u32::from_be_bytes(length) as usize;
    if length > MAX_HEADER {
        return bad(format!("a blob header of {length} bytes"));
    }
    let header = take(input, length)?;
    let (mut kind, mut size) = (String::new(), None);
    for field in fields(&header)? {
        match field {
            (1, Value::Bytes(name)) => kind = String::from_utf8_lossy(name).into_owned(),
            (3, Value::Number(n)) => size = usize::try_from(n).ok(),
            _ => {}
        }
    }
    match size {
        Some(size) if size <= MAX_BLOB => Ok(Some((kind, unpack(&take(input, size)?)?))),
        Some(size) => bad(format!("a blob of {size} bytes")),
        None => bad("a blob header without size"),
    }
}

fn take(input: &mut CountedReader, length: usize) -> Result<Vec<u8>, BlobFault> {
    let mut bytes = Vec::new();
    input.by_ref().take(length as u64).read_to_end(&mut bytes)?;
    if bytes.len() < length { Err(io::Error::from(ErrorKind::UnexpectedEof))? } else { Ok(bytes) }
}

/// The message inside a Blob.
fn unpack(blob: &[u8]) -> Result<Vec<u8>, BlobFault> {
    let all = fields(blob)?;
    let raw_size = all.iter().find_map(|f| if let (2, Value::Number(n)) = f { usize::try_from(*n).ok() } else { None });
    if raw_size.is_some_and(|n| n > MAX_BLOB) {
        return bad("a blob that unpacks to more than 32 MiB");
    }
    let packed =
        all.iter().find_map(|f| if let (n @ (1 | 3..=7), Value::Bytes(b)) = f { Some((*n, *b)) } else { None });
    let unpacked = match packed {
        Some((1, bytes)) => bytes.to_vec(),
        Some((3, bytes)) => inflate(bytes)?,
        Some((6, bytes)) => {
            let Some(size) = raw_size else { return bad("an LZ4 blob without raw_size") };
            lz4_flex::block::decompress(bytes, size).map_err(|e| BlobFault::Bad(format!("LZ4: {e}")))?
        }
        Some((4, _)) => return bad("LZMA blobs are not supported"),
        Some((5, _)) => return bad("bzip2 blobs are not supported"),
        Some((7, _)) => return bad("Zstandard blobs are not supported"),
        _ => return bad("an empty blob"),
    };
    match raw_size {
        Some(size) if size != unpacked.len() => bad(format!("a blob of {} instead of {size} bytes", unpacked.len())),
        _ => Ok(unpacked),
    }
}

fn inflate(bytes: &[u8]) -> Result<Vec<u8>, BlobFault> {
    let mut out = Vec::new();
    flate2::read::ZlibDecoder::new(bytes)
        .take(MAX_BLOB as u64 + 1)
        .read_to_end(&mut out)
        .map_err(|e| BlobFault::Bad(format!("zlib: {e}")))?;
    if out.len() > MAX_BLOB { bad("a blob that unpacks to more than 32 MiB") } else { Ok(out) }
}

/// Gives the crate an unpacked message in the frame that it reads.
fn framed(kind: &str, message: &[u8]) -> Result<osmpbf::Blob, BlobFault> {
    let mut blob = vec![0x0a];
    varint(message.len(), &mut blob);
    blob.extend(message);
    let mut header = vec![0x0a, kind.len() as u8];
    header.extend(kind.as_bytes());
    header.push(0x18);
    varint(blob.len(), &mut header);
    let mut frame = (header.len() as u32).to_be_bytes().to_vec();
    frame.extend(header);
    frame.extend(blob);
    BlobReader::new(frame.as_slice()).next().map_or_else(|| bad("an empty blob"), |blob| Ok(blob?))
}

fn header(message: &[u8], builder: &mut OsmBuilder) -> Result<(), BlobFault> {
    let header = framed("OSMHeader", message)?.to_headerblock()?;
    if let Some(feature) = header.required_features().iter().find(|f| !FEATURES.contains(&f.as_str())) {
        return bad(format!("the file needs the feature `{feature}`, which cannot be read"));
    }
    if let Some(b) = header.bbox() {
        builder.bounds(LonLatBox { west: b.left, south: b.bottom, east: b.right, north: b.top });
    }
    Ok(())
}

fn data(message: &[u8], builder: &mut OsmBuilder) -> Result<(), BlobFault> {
    let block = framed("OSMData", message)?.to_primitiveblock()?;
    let raw = block.raw_stringtable();
    let mut strings = Strings { raw, ids: vec![None; raw.len()] };
    for group in block.groups() {
        for node in group.nodes() {
            builder.node(node.id(), position(node.id(), node.nano_lon(), node.nano_lat())?);
            strings.plant(node.id(), node.raw_tags().map(|(k, v)| (k as usize, v as usize)), builder)?;
        }
        for node in group.dense_nodes() {
            builder.node(node.id(), position(node.id(), node.nano_lon(), node.nano_lat())?);
            // Negative numbers become numbers beyond the table.
            strings.plant(node.id(), node.raw_tags().map(|(k, v)| (k as usize, v as usize)), builder)?;
        }
        for way in group.ways() {
            for (id, place) in way.refs().zip(way.node_locations()) {
                builder.node(id, position(id, place.nano_lon(), place.nano_lat())?);
            }
            let tags = strings.tags(way.raw_tags(), builder)?;
            builder.way(way.id(), way.refs(), tags);
        }
        for relation in group.relations() {
            let mut members = Vec::new();
            for member in relation.members() {
                let kind = match member.member_type {
                    RelMemberType::Node => ObjectKind::Node,
                    RelMemberType::Way => ObjectKind::Way,
                    RelMemberType::Relation => ObjectKind::Relation,
                };
                members.push((kind, member.member_id, strings.get(member.role_sid, builder)?));
            }
            let tags = strings.tags(relation.raw_tags(), builder)?;
            builder.relation(relation.id(), members, tags);
        }
    }
    Ok(())
}

fn position(id: i64, nano_lon: i64, nano_lat: i64) -> Result<Position, BlobFault> {
    Position::from_degrees(nano_lon as f64 / 1e9, nano_lat as f64 / 1e9)
        .map_or_else(|| bad(format!("node {id} lies outside the earth's coordinates")), Ok)
}

/// The builder's ids of those strings of a block that are used (the table also names mappers).
struct Strings<'a> {
    raw: &'a [Vec<u8>],
    ids: Vec<Option<u32>>,
}

impl Strings<'_> {
    fn get(&mut self, index: impl TryInto<usize>, builder: &mut OsmBuilder) -> Result<u32, BlobFault> {
        let found = index.try_into().ok().filter(|i: &usize| *i < self.raw.len());
        let Some(index) = found else { return bad("a string number outside the string table") };
        if let Some(id) = self.ids[index] {
            return Ok(id);
        }
        let Ok(text) = std::str::from_utf8(&self.raw[index]) else { return bad("a string that is not UTF-8") };
        let id = builder.string(text);
        self.ids[index] = Some(id);
        Ok(id)
    }

    /// Keeps the tags of a node that stands for a plant; those of others are not even looked up.
    fn plant(
        &mut self,
        id: i64,
        raw: impl Iterator<Item = (usize, usize)> + Clone,
        builder: &mut OsmBuilder,
    ) -> Result<(), BlobFault> {
        let text = |index: usize| self.raw.get(index).and_then(|bytes| std::str::from_utf8(bytes).ok()).unwrap_or("");
        if raw.clone().any(|(key, value)| OsmBuilder::is_plant(text(key), text(value))) {
            let tags: Result<Vec<_>, BlobFault> =
                raw.map(|(key, value)| Ok((self.get(key, builder)?, self.get(value, builder)?))).collect();
            builder.plant(id, tags?);
        }
        Ok(())
    }

    fn tags(
        &mut self,
        raw: impl Iterator<Item = (u32, u32)>,
        builder: &mut OsmBuilder,
    ) -> Result<Vec<(u32, u32)>, BlobFault> {
        raw.map(|(key, value)| Ok((self.get(key, builder)?, self.get(value, builder)?))).collect()
    }
}

/// One field of a protobuf message.
enum Value<'a> {
    Number(u64),
    Bytes(&'a [u8]),
}

/// Splits a protobuf message into its fields, as far as the frame's two messages need it.
fn fields(mut message: &[u8]) -> Result<Vec<(u64, Value<'_>)>, BlobFault> {
    let mut out = Vec::new();
    while !message.is_empty() {
        let key = take_varint(&mut message)?;
        let value = match key & 7 {
            0 => Value::Number(take_varint(&mut message)?),
            2 => {
                let length = usize::try_from(take_varint(&mut message)?).unwrap_or(usize::MAX);
                let Some((bytes, rest)) = message.split_at_checked(length) else { return bad("a cut field") };
                message = rest;
                Value::Bytes(bytes)
            }
            kind => return bad(format!("a field of wire type {kind}")),
        };
        out.push((key >> 3, value));
    }
    Ok(out)
}

fn take_varint(message: &mut &[u8]) -> Result<u64, BlobFault> {
    let mut value = 0u64;
    for shift in (0..64).step_by(7) {
        let Some((&byte, rest)) = message.split_first() else { return bad("a cut number") };
        *message = rest;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Ok(value);
        }
    }
    bad("a number of more than 64 bits")
}

fn varint(mut value: usize, out: &mut Vec<u8>) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}
