//! Recognises files that are no drawings by their first bytes.

/// A kind of file that people give in place of a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NotADrawing {
    /// What the file is, with its article.
    pub what: &'static str,
    /// What to do instead.
    pub way_out: &'static str,
}

const TRACE: &str = "trace it in Inkscape (Path → Trace Bitmap) and save that as SVG, or put it into a drawing as an image";
const EXPORT: &str = "open it in the program that made it, and export it as SVG";
const MODEL: &str =
    "okoshi makes models from drawings; a drawing can use it with `Shape model \"FILE.glb\"`";

/// The first bytes of files, each with what such a file is and what to do.
#[rustfmt::skip]
const KINDS: &[(&[u8], &str, &str)] = &[
    (b"\x89PNG", "a PNG picture", TRACE),
    (b"\xFF\xD8\xFF", "a JPEG picture", TRACE),
    (b"GIF8", "a GIF picture", TRACE),
    (b"BM", "a BMP picture", TRACE),
    (b"II*\0", "a TIFF picture", TRACE),
    (b"MM\0*", "a TIFF picture", TRACE),
    (b"8BPS", "a Photoshop file", TRACE),
    (b"gimp xcf", "a GIMP file", TRACE),
    (b"%PDF", "a PDF", "open it in Inkscape and save it as Inkscape SVG; in Illustrator, use File → Export → SVG"),
    (b"%!PS", "a PostScript file", "open it in Inkscape or Illustrator and save it as SVG"),
    (b"\x00\xFFKA", "an Affinity file", "in Affinity, use File → Export → SVG"),
    (b"fig-kiwi", "a Figma file", "in Figma, select the frame and export it as SVG"),
    (b"BLENDER", "a Blender file", MODEL),
    (b"glTF", "a glTF model", MODEL),
    (b"HIERARCHY", "a motion (BVH)", "link it in a drawing with `%Motion \"FILE.bvh\"`, or try `okoshi motion FILE.bvh`"),
    (b"PK\x03\x04", "a zip archive or an office document", EXPORT),
    (b"\xD0\xCF\x11\xE0", "an office document", EXPORT),
    (b"\x7FELF", "a program", "name the SVG file"),
    (b"MZ", "a program", "name the SVG file"),
];

/// What `bytes` are, if they are a file of another kind that people know.
pub(super) fn not_a_drawing(bytes: &[u8]) -> Option<NotADrawing> {
    let webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
    let heic = bytes.get(4..8) == Some(b"ftyp");
    if webp || heic {
        let what = if webp {
            "a WebP picture"
        } else {
            "a HEIC picture or a film"
        };
        return Some(NotADrawing {
            what,
            way_out: TRACE,
        });
    }
    let mut kinds = KINDS.iter();
    let kind = kinds.find(|(magic, ..)| bytes.starts_with(magic));
    kind.map(|(_, what, way_out)| NotADrawing { what, way_out })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_are_none_of_these() {
        for text in [
            "<svg/>",
            "<?xml version=\"1.0\"?><svg/>",
            "\u{feff}<svg/>",
            "",
            "B",
            "MOTION",
        ] {
            assert_eq!(not_a_drawing(text.as_bytes()), None, "{text}");
        }
        let png = not_a_drawing(b"\x89PNG\r\n\x1A\n").unwrap();
        assert_eq!(png.what, "a PNG picture");
        assert_eq!(
            not_a_drawing(b"RIFF....WEBP").unwrap().what,
            "a WebP picture"
        );
    }
}
