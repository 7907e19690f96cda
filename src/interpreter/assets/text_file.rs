//! Text files. In: bytes. Out: text with line ends `\n`, control characters as `?` (reference 6.5, `readTextFile`).

use crate::parsing::decode;

pub fn read(bytes: &[u8]) -> String {
    let text = match utf16_without_mark(bytes) {
        Some(marked) => decode(&marked).text,
        None => decode(bytes).text,
    };
    let plain = |c: char| if c.is_control() && !matches!(c, '\n' | '\t') { '?' } else { c };
    text.replace("\r\n", "\n").replace('\r', "\n").chars().map(plain).collect()
}

/// UTF-16 of a western text: every second byte is 0. Gives it the mark that it lacks.
fn utf16_without_mark(bytes: &[u8]) -> Option<Vec<u8>> {
    let has_mark = matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..]);
    if has_mark || bytes.len() < 4 || !bytes.len().is_multiple_of(2) {
        return None;
    }
    let zeros = |start: usize| bytes.iter().skip(start).step_by(2).filter(|&&b| b == 0).count();
    let most = bytes.len() / 2 * 3 / 4;
    let mark: [u8; 2] = match (zeros(0), zeros(1)) {
        (even, 0) if even > most => [0xfe, 0xff],
        (0, odd) if odd > most => [0xff, 0xfe],
        _ => return None,
    };
    Some([&mark, bytes].concat())
}

#[cfg(test)]
mod tests {
    use super::read;

    #[test]
    fn every_encoding_and_line_end() {
        assert_eq!(read(b"a\r\nb\rc\nd\x07\te"), "a\nb\nc\nd?\te");
        assert_eq!(read("\u{feff}höhe".as_bytes()), "höhe");
        let units = |little: bool| {
            let bytes = |u: u16| if little { u.to_le_bytes() } else { u.to_be_bytes() };
            "abcd ef\r\n".encode_utf16().flat_map(bytes).collect::<Vec<u8>>()
        };
        assert_eq!(read(&units(true)), "abcd ef\n");
        assert_eq!(read(&units(false)), "abcd ef\n");
        assert_eq!(read(&[&[0xff, 0xfe][..], &units(true)].concat()), "abcd ef\n");
        assert_eq!(read(b"Stra\xdfe"), "Straße");
        assert_eq!(read(b""), "");
    }
}
