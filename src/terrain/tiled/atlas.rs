//! The pictures of all looks in one, so that a map has one texture.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec2;
use image::RgbaImage;
use rustc_hash::FxHashMap;

use super::document::{ImageLink, short};
use super::looks::Look;
use super::sets::{Set, Sets, TileId};
use super::{Idle, TiledError, beside};
use crate::resolver::{LinkError, Resolver};
use crate::terrain::map::{PictureGrid, Tile};
use crate::texture::{self, Decoded, Holes, Picture};

/// The largest number of pixels of the picture of all looks, and the largest side of a look in it, pixels.
const MAX_PIXELS: u64 = 1 << 24;
const MAX_SIDE: u32 = 256;
/// The largest number of pixels of a tile set's picture, and of all of them together.
const MAX_SHEET: usize = 1 << 25;
const MAX_SHEETS: usize = 1 << 27;
/// How far each picture is continued around itself, pixels, so that filtering mixes nothing of its neighbours in.
const MARGIN: u32 = 2;

/// How a look looks.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::terrain) struct Pictured {
    /// Its place in the picture of all, from 1; 0 if nothing of it is seen.
    pub(in crate::terrain) place: u16,
    /// Its mean colour, sRGB.
    pub(in crate::terrain) color: [u8; 3],
    /// Its kind, if its tile set says it.
    pub(in crate::terrain) kind: Option<Tile>,
}

/// The picture of all looks.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::terrain) struct Atlas {
    pub(in crate::terrain) picture: Picture,
    pub(in crate::terrain) grid: PictureGrid,
}

/// Pixels, straight alpha, row by row.
type Pixels = Vec<[u8; 4]>;

/// Draws the looks. `tile` is the size of the map's tiles, pixels.
///
/// # Errors
/// A picture cannot be read.
pub(super) fn draw(
    looks: &[Look],
    sets: &Sets,
    resolver: &dyn Resolver,
    tile: [u32; 2],
    idle: &mut BTreeSet<Idle>,
) -> Result<(Vec<Pictured>, Option<Atlas>), TiledError> {
    if looks.is_empty() {
        return Ok((vec![], None));
    }
    let side = sides(looks.len(), tile);
    let tiles = tiles(looks, sets, resolver, tile, side, idle)?;
    let mut drawn: Vec<Pixels> = Vec::with_capacity(looks.len());
    let mut pictured: Vec<Pictured> = Vec::with_capacity(looks.len());
    let mut places: FxHashMap<Pixels, u16> = FxHashMap::default();
    let mut order: Vec<usize> = vec![];
    for look in looks {
        let below = usize::from(look.below).checked_sub(1);
        let own = &tiles[&look.tile];
        let pixels = match below {
            Some(below) => over(own, look.opacity, &drawn[below]),
            None => own
                .iter()
                .map(|[r, g, b, alpha]| [*r, *g, *b, share(*alpha, look.opacity)])
                .collect(),
        };
        let said = sets.list[look.tile.set as usize].about(look.tile.local);
        // What covers less than half of its cell lies on the kind below.
        let covered: usize = own.iter().map(|pixel| usize::from(pixel[3])).sum();
        let kind = match (said.kind, below) {
            (None, Some(below)) if covered * 2 < own.len() * 255 => pictured[below].kind,
            (kind, _) => kind,
        };
        let color = mean(&pixels);
        pictured.push(Pictured {
            place: 0,
            color: color.unwrap_or_default(),
            kind,
        });
        drawn.push(pixels);
    }
    for (index, pixels) in drawn.iter_mut().enumerate() {
        let Some(color) = mean(pixels) else {
            continue;
        };
        // Tops are solid: holes have the mean colour.
        let [r, g, b] = color;
        let solid = vec![[r, g, b, 255]; pixels.len()];
        *pixels = over(pixels, 255, &solid);
        let next = places.len() as u16 + 1;
        pictured[index].place = *places.entry(pixels.clone()).or_insert_with(|| {
            order.push(index);
            next
        });
    }
    let pictures: Vec<&Pixels> = order.iter().map(|index| &drawn[*index]).collect();
    let atlas = joined(&pictures, side).ok_or_else(|| {
        TiledError::Limit("the picture of its tiles cannot be written".to_owned())
    })?;
    Ok((pictured, atlas))
}

/// The width and height of a look, pixels: as many as its tiles have, or fewer if there is no room for all looks.
fn sides(count: usize, tile: [u32; 2]) -> [u32; 2] {
    let largest = tile[0].max(tile[1]).max(1);
    let scaled = |most: u32| {
        let most = most.min(largest);
        tile.map(|side| (u64::from(side) * u64::from(most) / u64::from(largest)).max(1) as u32)
    };
    let fits = |[width, height]: [u32; 2]| {
        let area = u64::from(width + 2 * MARGIN) * u64::from(height + 2 * MARGIN);
        area * count as u64 <= MAX_PIXELS
    };
    let mut most = MAX_SIDE;
    while most > 1 && !fits(scaled(most)) {
        most -= 1;
    }
    scaled(most)
}

/// The picture of each tile of the looks, at the size of a look.
fn tiles(
    looks: &[Look],
    sets: &Sets,
    resolver: &dyn Resolver,
    tile: [u32; 2],
    side: [u32; 2],
    idle: &mut BTreeSet<Idle>,
) -> Result<FxHashMap<TileId, Pixels>, TiledError> {
    // By the file of their picture, so that one at a time is in memory.
    let mut by_file: BTreeMap<String, BTreeSet<TileId>> = BTreeMap::new();
    for look in looks {
        let set = &sets.list[look.tile.set as usize];
        let image = image(set, look.tile.local).ok_or_else(|| no_picture(set))?;
        let link = beside(&set.link, &image.source);
        by_file.entry(link).or_default().insert(look.tile);
    }
    let mut found = FxHashMap::default();
    let mut room = MAX_SHEETS;
    for (link, tiles) in by_file {
        let sheet = sheet(&link, resolver, &mut room)?;
        for id in tiles {
            let set = &sets.list[id.set as usize];
            let (corner, size) =
                place(set, id.local, &sheet).ok_or_else(|| outside(&link, id.local))?;
            if size != tile {
                Idle::OtherSize.note(idle);
            }
            let clear = image(set, id.local).and_then(|image| image.clear);
            let pixels = cut(&sheet, corner, size, id.turns, clear, tile, side);
            found.insert(id, pixels);
        }
    }
    Ok(found)
}

/// Each of these tiles with its size and its picture as a whole, turned, pixels.
pub(super) fn whole_tiles(
    wanted: &BTreeSet<TileId>,
    sets: &Sets,
    resolver: &dyn Resolver,
) -> Result<Vec<(TileId, DVec2, RgbaImage)>, TiledError> {
    let mut found = vec![];
    let mut room = MAX_SHEETS;
    let mut last: Option<(String, RgbaImage)> = None;
    for id in wanted {
        let set = &sets.list[id.set as usize];
        let own = image(set, id.local).ok_or_else(|| no_picture(set))?;
        let link = beside(&set.link, &own.source);
        let is_last = last.as_ref().is_some_and(|(known, _)| *known == link);
        if !is_last {
            last = Some((link.clone(), sheet(&link, resolver, &mut room)?));
        }
        let Some((_, sheet)) = &last else { continue };
        let (corner, size) = place(set, id.local, sheet).ok_or_else(|| outside(&link, id.local))?;
        let turned = if id.turns & 1 != 0 {
            [size[1], size[0]]
        } else {
            size
        };
        let largest = turned[0].max(turned[1]).max(1);
        let most = largest.min(MAX_SIDE);
        let side = turned
            .map(|side| (u64::from(side) * u64::from(most) / u64::from(largest)).max(1) as u32);
        let pixels = cut(sheet, corner, size, id.turns, own.clear, turned, side);
        let mut picture = RgbaImage::new(side[0], side[1]);
        for (to, from) in picture.pixels_mut().zip(pixels) {
            *to = image::Rgba(from);
        }
        found.push((*id, DVec2::new(turned[0].into(), turned[1].into()), picture));
    }
    Ok(found)
}

fn no_picture(set: &Set) -> TiledError {
    let name = short(&set.file.name);
    TiledError::Broken(format!("the tile set `{name}` has no picture"))
}

fn outside(link: &str, id: u32) -> TiledError {
    let name = short(link);
    TiledError::Broken(format!(
        "its tile {id} lies outside of the picture `{name}`"
    ))
}

/// The picture that a tile is in.
fn image(set: &Set, local: u32) -> Option<&ImageLink> {
    let own = set.entry(local).and_then(|entry| entry.image.as_ref());
    own.or(set.file.image.as_ref())
}

/// Decodes a picture of at most so many pixels, which it takes.
fn sheet(link: &str, resolver: &dyn Resolver, room: &mut usize) -> Result<RgbaImage, TiledError> {
    let wrong = |error: LinkError| TiledError::Link(link.to_owned(), error);
    let bytes = resolver.read(link).map_err(wrong)?;
    let unreadable = |reason: String| wrong(LinkError::Unreadable(reason));
    let size = imagesize::blob_size(&bytes).map_err(|error| unreadable(error.to_string()))?;
    let pixels = size.width.saturating_mul(size.height);
    *room = room.checked_sub(pixels).ok_or_else(|| {
        TiledError::Limit(format!("its pictures have more than {MAX_SHEETS} pixels"))
    })?;
    if pixels > MAX_SHEET {
        let what = format!(
            "its picture `{}` has more than {MAX_SHEET} pixels",
            short(link)
        );
        return Err(TiledError::Limit(what));
    }
    let decoded = texture::decode(&bytes).map_err(|error| unreadable(error.to_string()))?;
    Ok(decoded.pixels)
}

/// The top left corner and the size of a tile in its picture, pixels, if it lies in it.
fn place(set: &Set, local: u32, sheet: &RgbaImage) -> Option<([u32; 2], [u32; 2])> {
    let (width, height) = sheet.dimensions();
    if let Some(entry) = set.entry(local).filter(|entry| entry.image.is_some()) {
        if entry.area == [0; 4] {
            return Some(([0; 2], [width, height]));
        }
        let area = entry.area.map(|number| u32::try_from(number).ok());
        let [Some(left), Some(top), Some(own_width), Some(own_height)] = area else {
            return None;
        };
        let is_inside = own_width > 0
            && own_height > 0
            && left.checked_add(own_width)? <= width
            && top.checked_add(own_height)? <= height;
        return is_inside.then_some(([left, top], [own_width, own_height]));
    }
    let [tile_width, tile_height] = set.tile.map(i64::from);
    let [spacing, margin] = [set.file.spacing, set.file.margin];
    let step = tile_width.checked_add(spacing).filter(|step| *step > 0)?;
    let columns = match set.file.columns {
        columns if columns > 0 => columns,
        _ => {
            let inner = i64::from(width).checked_sub(margin.checked_mul(2)?)?;
            inner.checked_add(spacing)? / step
        }
    };
    if columns <= 0 {
        return None;
    }
    let at = |number: i64, side: i64| {
        let step = side.checked_add(spacing)?;
        number.checked_mul(step)?.checked_add(margin)
    };
    let [column, row] = [i64::from(local) % columns, i64::from(local) / columns];
    let (left, top) = (at(column, tile_width)?, at(row, tile_height)?);
    let inside = left >= 0
        && top >= 0
        && left.checked_add(tile_width)? <= i64::from(width)
        && top.checked_add(tile_height)? <= i64::from(height);
    inside.then_some(([left as u32, top as u32], set.tile))
}

/// The part of a tile that lies in its cell, turned, at the size of a look: tiles lie on the lower left corner of their cells.
fn cut(
    sheet: &RgbaImage,
    [left, top]: [u32; 2],
    size: [u32; 2],
    turns: u8,
    clear: Option<[u8; 3]>,
    cell: [u32; 2],
    side: [u32; 2],
) -> Pixels {
    let [across, down, swapped] = [4, 2, 1].map(|bit| turns & bit != 0);
    let [width, height] = if swapped { [size[1], size[0]] } else { size };
    // The middle of a pixel of the look, in pixels of the cell.
    let at = |pixel: u32, side: u32, cell: u32| {
        (u64::from(2 * pixel + 1) * u64::from(cell) / u64::from(2 * side)) as u32
    };
    let mut pixels = Vec::with_capacity(side[0] as usize * side[1] as usize);
    for y in 0..side[1] {
        for x in 0..side[0] {
            let from_left = at(x, side[0], cell[0]);
            let from_below = cell[1] - 1 - at(y, side[1], cell[1]);
            if from_left >= width || from_below >= height {
                pixels.push([0; 4]);
                continue;
            }
            let (mut u, mut v) = (from_left, height - 1 - from_below);
            if across {
                u = width - 1 - u;
            }
            if down {
                v = height - 1 - v;
            }
            if swapped {
                (u, v) = (v, u);
            }
            let pixel = sheet.get_pixel(left + u, top + v).0;
            let is_clear = clear.is_some_and(|clear| pixel[..3] == clear);
            pixels.push(if is_clear { [0; 4] } else { pixel });
        }
    }
    pixels
}

/// A share of 255 of a value.
fn share(value: u8, of: u8) -> u8 {
    ((u32::from(value) * u32::from(of) + 127) / 255) as u8
}

/// One picture on another; `opacity` is that of the upper one.
fn over(upper: &[[u8; 4]], opacity: u8, lower: &[[u8; 4]]) -> Pixels {
    let mixed = upper.iter().zip(lower).map(|(one, other)| {
        let alpha = share(one[3], opacity);
        if alpha == 255 {
            return *one;
        }
        let rest = share(other[3], 255 - alpha);
        let all = u32::from(alpha) + u32::from(rest);
        if all == 0 {
            return [0; 4];
        }
        let mix = |channel: usize| {
            let sum = u32::from(one[channel]) * u32::from(alpha)
                + u32::from(other[channel]) * u32::from(rest);
            ((sum + all / 2) / all) as u8
        };
        [mix(0), mix(1), mix(2), all.min(255) as u8]
    });
    mixed.collect()
}

/// The mean colour of a picture by opacity; `None` if nothing of it is seen.
fn mean(pixels: &[[u8; 4]]) -> Option<[u8; 3]> {
    let (mut sum, mut all) = ([0_u64; 3], 0_u64);
    for [r, g, b, alpha] in pixels {
        let alpha = u64::from(*alpha);
        for (sum, channel) in sum.iter_mut().zip([r, g, b]) {
            *sum += u64::from(*channel) * alpha;
        }
        all += alpha;
    }
    (all > 0).then(|| sum.map(|sum| ((sum + all / 2) / all) as u8))
}

/// The picture of these pictures, each continued around itself; `None` inside if there are none, outside if it cannot be written.
#[expect(
    clippy::option_option,
    reason = "there may be nothing to draw, which is no failure"
)]
fn joined(pictures: &[&Pixels], side: [u32; 2]) -> Option<Option<Atlas>> {
    if pictures.is_empty() {
        return Some(None);
    }
    let step = side.map(|side| side + 2 * MARGIN);
    let count = pictures.len() as u32;
    // About square.
    let columns = (1..=count)
        .find(|columns| columns * step[0] >= count.div_ceil(*columns) * step[1])
        .unwrap_or(count);
    let rows = count.div_ceil(columns);
    let mut pixels = RgbaImage::new(columns * step[0], rows * step[1]);
    for (number, picture) in (0..).zip(pictures) {
        let corner = [number % columns * step[0], number / columns * step[1]];
        for y in 0..step[1] {
            for x in 0..step[0] {
                let inner = |at: u32, side: u32| at.saturating_sub(MARGIN).min(side - 1);
                let at = inner(y, side[1]) * side[0] + inner(x, side[0]);
                let pixel = image::Rgba(picture[at as usize]);
                pixels.put_pixel(corner[0] + x, corner[1] + y, pixel);
            }
        }
    }
    let decoded = Decoded {
        pixels,
        media_type: None,
    };
    let nothing: Arc<[u8]> = Arc::new([]);
    let picture = texture::picture(decoded, &nothing, Holes::Alpha)?;
    let grid = PictureGrid {
        columns,
        rows,
        side,
        margin: MARGIN,
    };
    Some(Some(Atlas { picture, grid }))
}
