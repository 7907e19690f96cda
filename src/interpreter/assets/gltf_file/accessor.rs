//! Numbers of a glTF file. In: an accessor and the bytes of the buffers. Out: vectors or indices, or what is wrong.
//!
//! The readers of the `gltf` crate trust counts, offsets and strides; files that rules name are not to be trusted.

use gltf::accessor::{DataType, sparse::IndexType};
use gltf::{Accessor, buffer};

/// Most elements of one accessor.
pub const MOST_ELEMENTS: usize = 4_000_000;

/// Bytes of every buffer of a file.
pub struct Buffers(pub Vec<Vec<u8>>);

/// Elements in some bytes: where they begin, how far apart they are, how long one is.
#[derive(Clone, Copy)]
struct Layout {
    offset: usize,
    stride: usize,
    size: usize,
    count: usize,
}

impl Buffers {
    fn view(&self, view: &buffer::View) -> Result<&[u8], String> {
        let bytes = self.0.get(view.buffer().index()).ok_or("a buffer view names no buffer")?;
        let range = view.offset()..view.offset().checked_add(view.length()).ok_or("a buffer view has no end")?;
        bytes.get(range).ok_or_else(|| "a buffer view passes the end of its buffer".into())
    }

    /// The bytes of an image that lies in a buffer.
    pub fn image(&self, view: &buffer::View) -> Result<&[u8], String> {
        self.view(view)
    }

    /// Vectors of `N` numbers; normalised integers become fractions.
    pub fn vectors<const N: usize>(&self, accessor: &Accessor) -> Result<Vec<[f64; N]>, String> {
        if accessor.dimensions().multiplicity() != N {
            return Err(format!("an accessor has {:?} where vectors of {N} are needed", accessor.dimensions()));
        }
        let (kind, normalized) = (accessor.data_type(), accessor.normalized());
        let read = |bytes: &[u8]| std::array::from_fn(|i| number(&bytes[i * kind.size()..], kind, normalized));
        self.elements(accessor, [0.0; N], read)
    }

    /// Whole numbers.
    pub fn indices(&self, accessor: &Accessor) -> Result<Vec<u32>, String> {
        let kind = accessor.data_type();
        if accessor.dimensions().multiplicity() != 1 || !matches!(kind, DataType::U8 | DataType::U16 | DataType::U32) {
            return Err("indices are not unsigned whole numbers".into());
        }
        self.elements(accessor, 0, |bytes| number(bytes, kind, false) as u32)
    }

    /// Every element; those that no bytes describe are `zero`.
    fn elements<T: Copy>(&self, accessor: &Accessor, zero: T, read: impl Fn(&[u8]) -> T) -> Result<Vec<T>, String> {
        let (count, size) = (accessor.count(), accessor.size());
        if count > MOST_ELEMENTS {
            return Err(format!("an accessor has {count} elements, more than {MOST_ELEMENTS}"));
        }
        let mut out = match accessor.view() {
            Some(view) => {
                let stride = view.stride().unwrap_or(size);
                let layout = Layout { offset: accessor.offset(), stride, size, count };
                layout.slices(self.view(&view)?)?.map(&read).collect()
            }
            None => vec![zero; count],
        };
        if let Some(sparse) = accessor.sparse() {
            let (indices, values, count) = (sparse.indices(), sparse.values(), sparse.count());
            let kind = match indices.index_type() {
                IndexType::U8 => DataType::U8,
                IndexType::U16 => DataType::U16,
                IndexType::U32 => DataType::U32,
            };
            let places = Layout { offset: indices.offset(), stride: kind.size(), size: kind.size(), count };
            let layout = Layout { offset: values.offset(), stride: size, size, count };
            let (places, from) = (places.slices(self.view(&indices.view())?)?, self.view(&values.view())?);
            for (place, value) in places.zip(layout.slices(from)?) {
                let place = number(place, kind, false) as usize;
                *out.get_mut(place).ok_or("a sparse index points past the elements")? = read(value);
            }
        }
        Ok(out)
    }
}

impl Layout {
    fn slices(self, bytes: &[u8]) -> Result<impl Iterator<Item = &[u8]>, String> {
        let last = self.count.saturating_sub(1).checked_mul(self.stride);
        let end = last.and_then(|last| last.checked_add(self.offset)?.checked_add(self.size));
        if self.count > 0 && end.is_none_or(|end| end > bytes.len()) {
            return Err("an accessor passes the end of its buffer view".into());
        }
        if self.stride < self.size {
            return Err("the elements of an accessor overlap".into());
        }
        Ok((0..self.count).map(move |i| &bytes[self.offset + i * self.stride..][..self.size]))
    }
}

/// The number at the start of some bytes, which hold at least one.
fn number(bytes: &[u8], kind: DataType, normalized: bool) -> f64 {
    let two = || [bytes[0], bytes[1]];
    let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
    let (x, most) = match kind {
        DataType::I8 => (f64::from(bytes[0] as i8), 127.0),
        DataType::U8 => (f64::from(bytes[0]), 255.0),
        DataType::I16 => (f64::from(i16::from_le_bytes(two())), 32767.0),
        DataType::U16 => (f64::from(u16::from_le_bytes(two())), 65535.0),
        DataType::U32 => (f64::from(u32::from_le_bytes(four())), f64::from(u32::MAX)),
        DataType::F32 => return f64::from(f32::from_le_bytes(four())),
    };
    if normalized { (x / most).max(-1.0) } else { x }
}
