//! In: `file:` URIs of the editor, real paths of ours. Out: the other one.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use lsp_types::Uri;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

/// What stays as it is in the path of a URI.
const KEPT: &AsciiSet = &NON_ALPHANUMERIC.remove(b'/').remove(b'-').remove(b'_').remove(b'.').remove(b'~');

/// The path of a `file:` URI; none for other schemes.
pub fn path(uri: &Uri) -> Option<PathBuf> {
    let rest = uri.as_str().strip_prefix("file://")?;
    // A host may stand before the path; only this machine's files are read.
    let path = &rest[rest.find('/')?..];
    let decoded = percent_decode_str(path).decode_utf8().ok()?;
    // `/c:/rules` on Windows.
    let is_drive = decoded.as_bytes().get(2) == Some(&b':') && cfg!(windows);
    Some(PathBuf::from(if is_drive { &decoded[1..] } else { &decoded }))
}

/// The URI of a path; `None` only if the path is not Unicode.
pub fn uri(path: &Path) -> Option<Uri> {
    let text = path.to_str()?.replace('\\', "/");
    let slash = if text.starts_with('/') { "" } else { "/" };
    Uri::from_str(&format!("file://{slash}{}", utf8_percent_encode(&text, KEPT))).ok()
}

/// The real path of a file that need not exist; its folder is followed through links as far as it does.
pub fn real(path: &Path) -> PathBuf {
    if let Ok(real) = path.canonicalize() {
        return real;
    }
    match (path.parent(), path.file_name()) {
        (Some(folder), Some(name)) => real(folder).join(name),
        _ => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{path, uri};
    use std::path::Path;

    #[test]
    fn paths_come_back_from_their_uris() {
        for text in ["/home/me/a.cga", "/tmp/with space/größe #1?.cga", "/a%20b.cga"] {
            let there = uri(Path::new(text)).expect("Unicode");
            assert_eq!(path(&there).as_deref(), Some(Path::new(text)), "{}", there.as_str());
        }
        assert_eq!(
            uri(Path::new("/a b/ü.cga")).map(|u| u.as_str().to_owned()).as_deref(),
            Some("file:///a%20b/%C3%BC.cga")
        );
        assert_eq!(path(&"untitled:Untitled-1".parse().expect("a URI")), None);
    }
}
