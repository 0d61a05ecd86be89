//! Decodes the text of drawings. Drawings are UTF-8; other encodings are rejected by name.

/// Why bytes are not the text of a drawing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Decode {
    /// UTF-16.
    #[error("the drawing is UTF-16; save it as UTF-8")]
    Utf16,
    /// UTF-32.
    #[error("the drawing is UTF-32; save it as UTF-8")]
    Utf32,
    /// A zero byte, which XML cannot contain.
    #[error("byte {offset} is zero: this is not an SVG drawing")]
    Nul {
        /// The byte's offset.
        offset: usize,
    },
    /// Bytes that are not UTF-8.
    #[error("byte {offset} is not UTF-8; save the drawing as UTF-8")]
    NotUtf8 {
        /// The offset of the first such byte.
        offset: usize,
    },
    /// The XML declaration names an encoding in which the bytes have another meaning.
    #[error(
        "the drawing declares the encoding {encoding}, which is not supported; save it as UTF-8"
    )]
    Declared {
        /// The encoding's name in the drawing.
        encoding: String,
        /// The offset of the first character that depends on it.
        offset: usize,
    },
}

impl Decode {
    /// The offset that the error is about.
    pub fn offset(&self) -> usize {
        match self {
            Self::Utf16 | Self::Utf32 => 0,
            Self::Nul { offset } | Self::NotUtf8 { offset } | Self::Declared { offset, .. } => {
                *offset
            }
        }
    }
}

/// The text of a drawing.
///
/// A UTF-8 byte order mark stays in the text as its first character, so that offsets are those of the
/// file. Text in a declared one-byte encoding such as ISO-8859-1 is accepted if it is plain ASCII.
///
/// # Errors
/// If the bytes are not UTF-8, or contain a zero byte.
pub fn decode(bytes: Vec<u8>) -> Result<String, Decode> {
    if let Some(error) = wide(&bytes) {
        return Err(error);
    }
    let declared = declared_encoding(&bytes).filter(|encoding| reads_otherwise(encoding));
    if let Some(encoding) = declared
        && let Some(offset) = bytes.iter().position(|byte| !byte.is_ascii())
    {
        let encoding = encoding.to_owned();
        return Err(Decode::Declared { encoding, offset });
    }
    String::from_utf8(bytes).map_err(|error| Decode::NotUtf8 {
        offset: error.utf8_error().valid_up_to(),
    })
}

/// Recognises UTF-16 and UTF-32 by their byte order mark, or by the zeros around the first `<`.
fn wide(bytes: &[u8]) -> Option<Decode> {
    match bytes {
        [0xFF, 0xFE, 0, 0, ..] | [0, 0, 0xFE, 0xFF, ..] => Some(Decode::Utf32),
        [b'<', 0, 0, 0, ..] | [0, 0, 0, b'<', ..] => Some(Decode::Utf32),
        [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => Some(Decode::Utf16),
        [b'<', 0, ..] | [0, b'<', ..] => Some(Decode::Utf16),
        _ if bytes.contains(&0) => bytes
            .iter()
            .position(|byte| *byte == 0)
            .map(|offset| Decode::Nul { offset }),
        _ => None,
    }
}

/// The `encoding` of the XML declaration, which must be the first thing in the file.
fn declared_encoding(bytes: &[u8]) -> Option<&str> {
    const LONGEST: usize = 256;

    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let head = bytes.strip_prefix(b"<?xml")?;
    let head = &head[..head.len().min(LONGEST)];
    let end = head.windows(2).position(|two| two == b"?>")?;
    let head = std::str::from_utf8(&head[..end]).ok()?;
    let (_, value) = head.split_once("encoding")?;
    let value = value.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    value[1..].split(quote).next()
}

/// Whether bytes over 127 have another meaning in this encoding than in UTF-8.
///
/// Bytes without zeros are not UTF-16, whatever the declaration says: some programs declare UTF-16
/// and write UTF-8.
fn reads_otherwise(encoding: &str) -> bool {
    let encoding = encoding.trim().to_ascii_lowercase();
    let same = ["", "utf-8", "utf8", "us-ascii", "ascii"];
    !same.contains(&&*encoding) && !encoding.starts_with("utf-16")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<String, Decode> {
        decode(bytes.to_vec())
    }

    #[test]
    fn utf8_is_read_with_and_without_mark() {
        assert_eq!(read(b""), Ok(String::new()));
        assert_eq!(read("<svg>腕</svg>".as_bytes()).unwrap(), "<svg>腕</svg>");
        let marked = read(b"\xEF\xBB\xBF<svg/>").unwrap();
        assert_eq!((marked.len(), marked.find('<')), (9, Some(3)));
    }

    #[test]
    fn wide_encodings_are_named() {
        let utf16: Vec<u8> = "\u{FEFF}<svg/>"
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        assert_eq!(read(&utf16), Err(Decode::Utf16));
        assert_eq!(read(&utf16[2..]), Err(Decode::Utf16));
        let utf16: Vec<u8> = "\u{FEFF}<svg/>"
            .encode_utf16()
            .flat_map(u16::to_be_bytes)
            .collect();
        assert_eq!(read(&utf16), Err(Decode::Utf16));
        assert_eq!(read(&utf16[2..]), Err(Decode::Utf16));
        assert_eq!(read(b"\xFF\xFE\0\0<\0\0\0"), Err(Decode::Utf32));
        assert_eq!(read(b"\0\0\xFE\xFF\0\0\0<"), Err(Decode::Utf32));
        assert_eq!(read(b"\0\0\0<"), Err(Decode::Utf32));
        assert_eq!(read(b"<svg>\0"), Err(Decode::Nul { offset: 5 }));
    }

    #[test]
    fn broken_utf8_is_found() {
        assert_eq!(read(b"<svg>\xE8\x85"), Err(Decode::NotUtf8 { offset: 5 }));
        let message = Decode::NotUtf8 { offset: 5 }.to_string();
        assert_eq!(message, "byte 5 is not UTF-8; save the drawing as UTF-8");
    }

    #[test]
    fn declarations_count_where_they_matter() {
        let drawing = |encoding: &str, text: &[u8]| {
            let head = format!("<?xml version='1.0' encoding = '{encoding}' ?><svg>");
            read(&[head.as_bytes(), text].concat())
        };
        for encoding in ["UTF-8", "utf8", "us-ascii", "UTF-16"] {
            assert!(drawing(encoding, "腕".as_bytes()).is_ok(), "{encoding}");
        }
        assert!(drawing("ISO-8859-1", b"arm").is_ok());
        for text in [&b"\xE9"[..], "é".as_bytes()] {
            let error = drawing("ISO-8859-1", text).unwrap_err();
            assert_eq!(
                error.to_string(),
                "the drawing declares the encoding ISO-8859-1, which is not supported; save it as UTF-8"
            );
            assert_eq!(error.offset(), 51);
        }
        assert!(drawing("Shift_JIS", b"\x98\x72").is_err());
        assert!(read("<?xml encoding='é".as_bytes()).is_ok());
    }
}
