//! Maps of the editor Tiled (`.tmx`, `.tmj`) with their tile sets and pictures (ours).
//!
//! The format is that of <https://doc.mapeditor.org/en/stable/reference/tmx-map-format/>. The reader is our own and not the crate `tiled`
//! (0.16), which unpacks layers without a bound, reserves memory for as many tiles as a file claims, and reads no JSON. Here every size is
//! checked before memory is taken for it, and tiles are unpacked one by one.
//!
//! Invariant: a cell shows what its layers paint on each other there, its *look*; equal stacks of tiles are one look.

mod atlas;
mod document;
mod json;
mod looks;
mod numbers;
mod objects;
mod sets;
mod xml;

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

pub(super) use atlas::{Atlas, Pictured};
pub(super) use looks::LookHeight;
pub(super) use objects::{ObjectPicture, TileObject};

use super::map::{MAX_CELLS, UNSET};
use crate::resolver::{LinkError, Resolver};
use document::{Content, LayerEntry, MapFile, ObjectEntry, Properties, short};
use looks::Looks;
use sets::Sets;

/// The largest size of the file of a map, and of those of its tile sets together, bytes.
const MAX_FILE: usize = 64 << 20;
/// The largest number of cells of all layers, which are read one after another.
const MAX_READ: usize = 1 << 28;
/// The largest number of tile sets.
const MAX_SETS: usize = 1 << 10;
/// The largest height above and below 0.
const HIGHEST: f64 = 100.0;

/// A map that was read.
#[derive(Debug)]
pub(super) struct TiledMap {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// The side of a tile, pixels: of one that is not square its width.
    pub(super) size: f64,
    /// Per cell, row by row, its look, or 0.
    pub(super) cells: Vec<u16>,
    /// Per look, from 1, its picture.
    pub(super) pictured: Vec<Pictured>,
    /// Per look, from 1, the height that it gives its cells.
    pub(super) heights: Vec<LookHeight>,
    /// The pictures of all looks in one; `None` if none has any.
    pub(super) atlas: Option<Atlas>,
    /// What stands on it.
    pub(super) objects: Vec<TileObject>,
    /// The pictures of these.
    pub(super) object_pictures: Vec<ObjectPicture>,
    /// What the map has that means nothing here.
    pub(super) idle: BTreeSet<Idle>,
}

/// What a map may have that means nothing here.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Idle {
    /// Objects without a tile: points, areas, texts.
    Objects,
    /// Objects that are turned.
    Turned,
    /// Objects whose tile is transparent, or which are larger or farther away than drawings may be.
    Unseen,
    /// Layers that are one picture.
    Images,
    /// Layers that are drawn elsewhere than at their cells.
    Shifted,
    /// Layers that are drawn in another colour.
    Tinted,
    /// Tiles that are animated.
    Animated,
    /// Tiles of another size than the map's.
    OtherSize,
    /// Tiles that are not square.
    NotSquare,
    /// A height that is not a whole number in the limits.
    Height(String),
    /// A word that is no kind of tile.
    Kind(String),
}

impl Idle {
    /// Takes note of it, once a kind.
    fn note(self, idle: &mut BTreeSet<Self>) {
        let kind = std::mem::discriminant(&self);
        if !idle
            .iter()
            .any(|known| std::mem::discriminant(known) == kind)
        {
            idle.insert(self);
        }
    }
}

/// Why a map cannot be read. Messages go behind its name: the map `a.tmx` …
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(super) enum TiledError {
    /// A link of it leads nowhere.
    #[error("has a link `{0}` that {1}")]
    Link(String, LinkError),
    /// It, or a file that it links to, is damaged.
    #[error("cannot be read: {0}")]
    Broken(String),
    /// It uses something that okoshi does not read.
    #[error("is of a kind that is not read: {0}")]
    Unknown(String),
    /// It is larger than okoshi reads.
    #[error("is too large: {0}")]
    Limit(String),
    /// Its grid has too many cells: columns and rows.
    #[error("has a grid of {0} × {1} cells, more than the limit of {MAX_CELLS}")]
    Grid(i64, i64),
}

impl TiledError {
    /// A number that is none, or that is out of the range of its type.
    fn number(name: &str, written: &str) -> Self {
        Self::Broken(format!("`{name}` is `{}`, not a number", short(written)))
    }

    fn too_deep() -> Self {
        Self::Limit(format!(
            "more than {} groups of layers lie in each other",
            xml::MAX_DEPTH
        ))
    }
}

/// Reads a map and all files that it needs; `link` is relative to the drawing, and those in it to the file that has them.
///
/// # Errors
/// See [`TiledError`].
pub(super) fn read(link: &str, resolver: &dyn Resolver) -> Result<TiledMap, TiledError> {
    let file = parsed(link, resolver, &mut { MAX_FILE }, xml::map, json::map)?;
    if file.orientation != "orthogonal" {
        let what = format!(
            "it is {}; only orthogonal maps are read",
            short(&file.orientation)
        );
        return Err(TiledError::Unknown(what));
    }
    let tile = sides(file.tile, "tile")?;
    let mut idle = BTreeSet::new();
    if tile[0] != tile[1] {
        Idle::NotSquare.note(&mut idle);
    }
    let sets = Sets::read(&file.sets, link, resolver, tile, &mut idle)?;
    let (layers, entries) = visible(&file, &mut idle);
    let [low, high] = bounds(&file, &layers)?;
    let [columns, rows] = [0, 1].map(|axis| high[axis] - low[axis]);
    let cells = i128::from(columns) * i128::from(rows);
    if cells > MAX_CELLS as i128 {
        return Err(TiledError::Grid(columns, rows));
    }
    let (columns, rows) = (columns as usize, rows as usize);
    let chunks = layers.iter().flat_map(|layer| layer.chunks);
    let chunks = chunks.filter(|chunk| !chunk.is_blank());
    // Each lies in the grid, so no product overflows.
    let read: usize = chunks
        .map(|chunk| (chunk.size[0] * chunk.size[1]) as usize)
        .fold(0, usize::saturating_add);
    if read > MAX_READ {
        let what = format!("its layers have more than {MAX_READ} cells in total");
        return Err(TiledError::Limit(what));
    }
    let mut looks = Looks::new(&sets);
    let mut cells = vec![0; columns * rows];
    for layer in &layers {
        for chunk in layer.chunks {
            if chunk.is_blank() {
                continue;
            }
            let [width, height] = chunk.size.map(|side| side as usize);
            let [left, top] = [0, 1].map(|axis| (chunk.at[axis] - low[axis]) as usize);
            chunk.each(width * height, |at, number| {
                if number == 0 {
                    return Ok(());
                }
                let cell = &mut cells[(top + at / width) * columns + left + at % width];
                *cell = looks.over(*cell, number, layer.opacity, layer.height)?;
                Ok(())
            })?;
        }
    }
    let corner = [0, 1].map(|axis| low[axis] as f64 * f64::from(tile[axis]));
    let (objects, object_pictures) = objects::read(&entries, corner, &sets, resolver, &mut idle)?;
    let (heights, (pictured, atlas)) = looks.finish(resolver, tile, &mut idle)?;
    Ok(TiledMap {
        columns,
        rows,
        size: f64::from(tile[0]),
        cells,
        pictured,
        heights,
        atlas,
        objects,
        object_pictures,
        idle,
    })
}

/// A layer of tiles that is visible.
struct TileLayer<'a> {
    chunks: &'a [document::Chunk],
    /// 0 to 255.
    opacity: u8,
    /// The height that it, or the innermost group around it that has one, gives its tiles, or [`UNSET`].
    height: i8,
}

/// The visible layers of tiles, from the lowest to the topmost, and the visible objects. Takes note of the others.
fn visible<'a>(
    file: &'a MapFile,
    idle: &mut BTreeSet<Idle>,
) -> (Vec<TileLayer<'a>>, Vec<&'a ObjectEntry>) {
    fn add<'a>(
        layers: &'a [LayerEntry],
        opacity: f64,
        height: i8,
        found: &mut Vec<TileLayer<'a>>,
        objects: &mut Vec<&'a ObjectEntry>,
        idle: &mut BTreeSet<Idle>,
    ) {
        for layer in layers.iter().filter(|layer| layer.is_visible) {
            let height = match height_of(&layer.properties, idle) {
                UNSET => height,
                own => own,
            };
            let own = if layer.opacity.is_finite() {
                layer.opacity.clamp(0.0, 1.0)
            } else {
                1.0
            };
            let opacity = opacity * own;
            if layer.is_shifted {
                Idle::Shifted.note(idle);
            }
            if layer.is_tinted {
                Idle::Tinted.note(idle);
            }
            match &layer.content {
                Content::Tiles(chunks) => {
                    let opacity = (opacity * 255.0).round() as u8;
                    if opacity > 0 {
                        found.push(TileLayer {
                            chunks,
                            opacity,
                            height,
                        });
                    }
                }
                Content::Objects(list) => {
                    objects.extend(list.iter().filter(|object| object.is_visible));
                }
                Content::Image => {
                    Idle::Images.note(idle);
                }
                Content::Group(layers) => add(layers, opacity, height, found, objects, idle),
            }
        }
    }
    let (mut found, mut objects) = (vec![], vec![]);
    let height = height_of(&file.properties, idle);
    add(&file.layers, 1.0, height, &mut found, &mut objects, idle);
    (found, objects)
}

/// The height that properties give, or [`UNSET`].
fn height_of(properties: &Properties, idle: &mut BTreeSet<Idle>) -> i8 {
    let Some(written) = &properties.height else {
        return UNSET;
    };
    let number: Option<f64> = written.parse().ok();
    match number.filter(|number| number.fract() == 0.0 && number.abs() <= HIGHEST) {
        Some(number) => number as i8,
        None => {
            Idle::Height(short(written)).note(idle);
            UNSET
        }
    }
}

/// The first cell of a map, and the one after its last. An infinite map reaches as far as its chunks do.
fn bounds(file: &MapFile, layers: &[TileLayer<'_>]) -> Result<[[i64; 2]; 2], TiledError> {
    // So far away that no sum overflows.
    const FAR: i64 = 1 << 40;
    let chunks = layers.iter().flat_map(|layer| layer.chunks);
    let mut chunks = chunks.filter(|chunk| !chunk.is_blank()).peekable();
    if chunks.peek().is_none() {
        // A map without tiles has its size all the same.
        sides(file.size, "map")?;
        return Ok([[0; 2]; 2]);
    }
    let mut bounds = [[i64::MAX; 2], [i64::MIN; 2]];
    for chunk in chunks {
        let size = chunk.size.map(|side| side.min(FAR));
        sides(chunk.size.map(|side| side.min(1)), "layer")?;
        for axis in 0..2 {
            let at = chunk.at[axis];
            if at.unsigned_abs() > FAR as u64 {
                let what = format!("a part of a layer is at {at}");
                return Err(TiledError::Limit(what));
            }
            bounds[0][axis] = bounds[0][axis].min(at);
            bounds[1][axis] = bounds[1][axis].max(at + size[axis]);
        }
    }
    Ok(bounds)
}

/// Width and height, if they are above 0 and not larger than any picture or map.
fn sides(size: [i64; 2], what: &str) -> Result<[u32; 2], TiledError> {
    let [width, height] = size;
    let sides = size.map(|side| u32::try_from(side).ok().filter(|side| *side > 0));
    match sides {
        [Some(width), Some(height)] => Ok([width, height]),
        _ => Err(TiledError::Broken(format!(
            "the size of a {what} is {width} × {height}"
        ))),
    }
}

/// Reads a file of at most so many bytes, which it takes, as XML or as JSON, whichever it is.
fn parsed<T>(
    link: &str,
    resolver: &dyn Resolver,
    room: &mut usize,
    xml: impl Fn(&str) -> Result<T, TiledError>,
    json: impl Fn(&str) -> Result<T, TiledError>,
) -> Result<T, TiledError> {
    let bytes = resolver
        .read(link)
        .map_err(|error| TiledError::Link(link.to_owned(), error))?;
    *room = room.checked_sub(bytes.len()).ok_or_else(|| {
        let limit = MAX_FILE as u64;
        TiledError::Link(link.to_owned(), LinkError::TooLarge { limit })
    })?;
    let text = str::from_utf8(&bytes)
        .map_err(|_| TiledError::Broken(format!("`{}` is not UTF-8", short(link))))?;
    let text = text.trim_start_matches('\u{feff}');
    if text.trim_start().starts_with('{') {
        json(text)
    } else {
        xml(text)
    }
}

/// A link in a file, as it is from the drawing's folder.
fn beside(file: &str, link: &str) -> String {
    let (folder, _) = crate::resolver::folder_and_name(file);
    match crate::resolver::relative(link) {
        Ok(_) => format!("{folder}{link}"),
        // The resolver says what is wrong with it.
        Err(_) => link.to_owned(),
    }
}
