//! Objects that show a tile: they stand on the map, like the props of a drawing.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::atlas;
use super::document::ObjectEntry;
use super::sets::{Sets, TileId};
use super::{Idle, TiledError};
use crate::geometry::{FillRule, Outline, pixel_borders, resolve_overlaps};
use crate::resolver::Resolver;
use crate::texture::{self, Decoded, Holes, Picture};

/// The largest number of objects, and of different tiles that they show: each is a material of its own.
const MAX_OBJECTS: usize = 1 << 14;
const MAX_PICTURES: usize = 48;
/// The largest side of an object, pixels: as far as any drawing reaches.
const LARGEST: f64 = 1e6;

/// An object that stands on a map.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::terrain) struct TileObject {
    /// Its name; empty if it has none.
    pub(in crate::terrain) name: String,
    /// The middle of its lower edge, pixels from the map's top left corner.
    pub(in crate::terrain) foot: DVec2,
    /// Width and height, pixels.
    pub(in crate::terrain) size: DVec2,
    /// The index of its picture.
    pub(in crate::terrain) picture: usize,
}

/// The picture of an object.
#[derive(Debug, Clone)]
pub(in crate::terrain) struct ObjectPicture {
    /// What of it is seen, in the unit square, y down.
    pub(in crate::terrain) outline: Arc<Outline>,
    pub(in crate::terrain) picture: Picture,
}

/// Reads the objects that show tiles; `corner` is the map's top left corner, pixels. Takes note of the others.
pub(super) fn read(
    entries: &[&ObjectEntry],
    corner: [f64; 2],
    sets: &Sets,
    resolver: &dyn Resolver,
    idle: &mut BTreeSet<Idle>,
) -> Result<(Vec<TileObject>, Vec<ObjectPicture>), TiledError> {
    let mut shown: Vec<(&ObjectEntry, TileId)> = vec![];
    for entry in entries {
        if entry.number == 0 {
            Idle::Objects.note(idle);
            continue;
        }
        if entry.is_turned {
            Idle::Turned.note(idle);
        }
        shown.push((entry, sets.tile(entry.number)?));
    }
    if shown.len() > MAX_OBJECTS {
        let message = format!("more than {MAX_OBJECTS} objects are in it");
        return Err(TiledError::Limit(message));
    }
    let tiles: BTreeSet<TileId> = shown.iter().map(|(_, tile)| *tile).collect();
    if tiles.len() > MAX_PICTURES {
        let message = format!("its objects show more than {MAX_PICTURES} different tiles");
        return Err(TiledError::Limit(message));
    }
    let mut pictures = vec![];
    let mut of_tile: FxHashMap<TileId, (usize, DVec2)> = FxHashMap::default();
    for (tile, size, pixels) in atlas::whole_tiles(&tiles, sets, resolver)? {
        let (width, height) = pixels.dimensions();
        let is_solid = |x: u32, y: u32| pixels.get_pixel(x, y).0[3] > 127;
        let mut rings = pixel_borders(width, height, is_solid);
        let side = DVec2::new(width.into(), height.into());
        rings.iter_mut().flatten().for_each(|point| *point /= side);
        let outline = resolve_overlaps(rings, FillRule::EvenOdd);
        let decoded = Decoded {
            pixels,
            media_type: None,
        };
        let nothing: Arc<[u8]> = Arc::new([]);
        let picture = texture::picture(decoded, &nothing, Holes::Outline).ok_or_else(|| {
            TiledError::Limit("the picture of an object cannot be written".to_owned())
        })?;
        of_tile.insert(tile, (pictures.len(), size));
        pictures.push(ObjectPicture {
            outline: Arc::new(outline),
            picture,
        });
    }
    let object = |(entry, tile): (&ObjectEntry, TileId)| {
        let (picture, own) = *of_tile.get(&tile)?;
        let said = DVec2::from_array(entry.size);
        let size = DVec2::select(said.cmpgt(DVec2::ZERO), said, own);
        let at = DVec2::from_array(entry.at) - DVec2::from_array(corner);
        let fits =
            size.cmple(DVec2::splat(LARGEST)).all() && at.abs().cmple(DVec2::splat(LARGEST)).all();
        // What nobody sees stands nowhere.
        let is_seen = fits && !pictures[picture].outline.polygons.is_empty();
        is_seen.then(|| TileObject {
            name: entry.name.clone(),
            foot: at + DVec2::new(size.x / 2.0, 0.0),
            size,
            picture,
        })
    };
    let objects = shown.into_iter().filter_map(object).collect();
    Ok((objects, pictures))
}
