//! What a file of a map or of a tile set says, before its sizes are checked. XML and JSON give the same.

use super::TiledError;

/// A map.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct MapFile {
    /// How its tiles lie: `orthogonal` and others.
    pub(super) orientation: String,
    /// Columns and rows, of a map that is not infinite.
    pub(super) size: [i64; 2],
    /// Width and height of a tile, pixels.
    pub(super) tile: [i64; 2],
    pub(super) properties: Properties,
    pub(super) sets: Vec<SetLink>,
    /// From the lowest to the topmost.
    pub(super) layers: Vec<LayerEntry>,
}

/// A tile set of a map.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SetLink {
    /// The number of its first tile in the map.
    pub(super) first: u32,
    pub(super) source: SetSource,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum SetSource {
    /// The link to its file, from the map's folder.
    File(String),
    Embedded(Box<SetFile>),
}

/// A tile set.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct SetFile {
    pub(super) name: String,
    /// Width and height of a tile, pixels.
    pub(super) tile: [i64; 2],
    pub(super) spacing: i64,
    pub(super) margin: i64,
    pub(super) columns: i64,
    /// The number of its tiles.
    pub(super) count: i64,
    /// The picture of all tiles; `None` if each has its own.
    pub(super) image: Option<ImageLink>,
    /// The tiles about which the file says something.
    pub(super) tiles: Vec<TileEntry>,
}

/// A link to a picture.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct ImageLink {
    pub(super) source: String,
    /// The colour that is transparent.
    pub(super) clear: Option<[u8; 3]>,
}

/// A tile of a set.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct TileEntry {
    pub(super) id: i64,
    /// Its class, `type` in older files.
    pub(super) class: String,
    pub(super) properties: Properties,
    /// Its own picture.
    pub(super) image: Option<ImageLink>,
    /// The part of its own picture that it is: left, top, width and height, pixels; all 0 for the whole.
    pub(super) area: [i64; 4],
    pub(super) is_animated: bool,
}

/// The properties that mean something here.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Properties {
    /// `height`, as it is written.
    pub(super) height: Option<String>,
    /// `tile`: a word for the kind of tile.
    pub(super) tile: Option<String>,
}

impl Properties {
    /// Takes note of a property.
    pub(super) fn set(&mut self, name: &str, value: String) {
        match name.to_ascii_lowercase().as_str() {
            "height" => self.height = Some(value),
            "tile" => self.tile = Some(value),
            _ => {}
        }
    }
}

/// A layer.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LayerEntry {
    pub(super) is_visible: bool,
    /// 0 to 1.
    pub(super) opacity: f64,
    /// Whether it is drawn elsewhere than at its cells: shifted, or with parallax.
    pub(super) is_shifted: bool,
    pub(super) is_tinted: bool,
    pub(super) properties: Properties,
    pub(super) content: Content,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Content {
    Tiles(Vec<Chunk>),
    Objects(Vec<ObjectEntry>),
    Image,
    Group(Vec<LayerEntry>),
}

/// An object.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct ObjectEntry {
    pub(super) name: String,
    /// The number of the tile that it shows; 0 for one that shows none.
    pub(super) number: u32,
    /// Its place, pixels: of one that shows a tile its lower left corner.
    pub(super) at: [f64; 2],
    /// Width and height, pixels; 0 for those of its tile.
    pub(super) size: [f64; 2],
    pub(super) is_turned: bool,
    pub(super) is_visible: bool,
}

/// A rectangle of cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chunk {
    /// Its first column and row.
    pub(super) at: [i64; 2],
    pub(super) size: [i64; 2],
    pub(super) data: Data,
}

/// The numbers of a chunk's tiles, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Data {
    Numbers(Vec<u32>),
    Text(Encoding, String),
}

/// How a text encodes numbers of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Numbers with commas between them.
    Csv,
    /// Numbers of four bytes, the lowest first, in base64.
    Base64(Compression),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Zlib,
    Gzip,
    Zstd,
}

impl Encoding {
    /// The encoding that these attributes name.
    pub(super) fn named(encoding: &str, compression: &str) -> Result<Self, TiledError> {
        let compression = match compression {
            "" => Compression::None,
            "zlib" => Compression::Zlib,
            "gzip" => Compression::Gzip,
            "zstd" => Compression::Zstd,
            other => {
                let what = format!("its layers are compressed with `{}`", short(other));
                return Err(TiledError::Unknown(what));
            }
        };
        match encoding {
            "csv" => Ok(Self::Csv),
            "base64" => Ok(Self::Base64(compression)),
            other => {
                let what = format!("its layers are encoded as `{}`", short(other));
                Err(TiledError::Unknown(what))
            }
        }
    }
}

/// The beginning of a word from a file, for messages.
pub(super) fn short(word: &str) -> String {
    const LONGEST: usize = 32;
    match word.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &word[..end]),
        None => word.to_owned(),
    }
}

/// A colour written as `#rrggbb`, with or without its sign and an alpha before it.
pub(super) fn color(written: &str) -> Option<[u8; 3]> {
    let digits = written.trim_start_matches('#');
    let digits = match digits.len() {
        8 => digits.get(2..)?,
        6 => digits,
        _ => return None,
    };
    let value = u32::from_str_radix(digits, 16).ok()?;
    let [_, r, g, b] = value.to_be_bytes();
    Some([r, g, b])
}
