//! In: the bytes of a text file. Out: its text: UTF-8 (with or without BOM), UTF-16 with BOM, else Windows-1252.

use encoding_rs::{Encoding, WINDOWS_1252};

/// A decoded text. Line ends are LF or CRLF; a CR alone, as old systems wrote, has become LF.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    pub text: String,
    /// The bytes were not Unicode and were read as Windows-1252.
    pub guessed: bool,
}

/// Decodes a rule or recipe file. Never fails: every byte string is some Windows-1252 text.
pub fn decode(bytes: &[u8]) -> Decoded {
    let Decoded { text, guessed } = characters(bytes);
    let alone = text.bytes().zip(text.bytes().skip(1).chain([0])).any(|pair| pair.0 == b'\r' && pair.1 != b'\n');
    let text = if alone { text.replace("\r\n", "\n").replace('\r', "\n") } else { text };
    Decoded { text, guessed }
}

fn characters(bytes: &[u8]) -> Decoded {
    if let Some((encoding, mark)) = Encoding::for_bom(bytes) {
        let (text, _) = encoding.decode_without_bom_handling(&bytes[mark..]);
        return Decoded { text: text.into_owned(), guessed: false };
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Decoded { text: text.to_owned(), guessed: false },
        Err(_) => Decoded { text: WINDOWS_1252.decode_without_bom_handling(bytes).0.into_owned(), guessed: true },
    }
}

#[cfg(test)]
mod tests {
    use super::decode;

    #[test]
    fn reads_unicode_with_and_without_mark_and_single_bytes() {
        assert_eq!(decode("höhe".as_bytes()).text, "höhe");
        assert_eq!(decode(b"\xef\xbb\xbfattr").text, "attr");
        assert_eq!(decode(b"\xff\xfea\0b\0").text, "ab");
        let old = decode(b"// Stra\xdfe");
        assert_eq!((&*old.text, old.guessed), ("// Straße", true));
        assert_eq!(decode(b"a\rb\r\nc\n").text, "a\nb\nc\n");
        assert_eq!(decode(b"a\r\nb\r\n").text, "a\r\nb\r\n");
    }
}
