//! The tile sets of a map, and what its numbers of tiles stand for.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use super::document::{SetFile, SetLink, SetSource, TileEntry, short};
use super::{Idle, MAX_FILE, MAX_SETS, TiledError, beside, height_of, json, parsed, sides, xml};
use crate::resolver::Resolver;
use crate::terrain::map::{Tile, UNSET};

/// The bits of a number that turn its tile: mirrored across, mirrored down, and columns taken for rows.
const TURNS: u32 = 0b1110 << 28;
/// The bit that turns tiles of hexagonal maps.
const HEXAGONAL: u32 = 1 << 28;

/// A tile of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct TileId {
    /// The index of its set.
    pub(super) set: u32,
    /// Its number in the set.
    pub(super) local: u32,
    /// The bits of [`TURNS`], lowest first: columns taken for rows, mirrored down, mirrored across.
    pub(super) turns: u8,
}

/// What a set says about a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct About {
    /// Its height, or [`UNSET`].
    pub(super) height: i8,
    /// Its kind, if that is said.
    pub(super) kind: Option<Tile>,
}

/// A tile set with the file that it is in.
#[derive(Debug)]
pub(super) struct Set {
    first: u32,
    pub(super) file: SetFile,
    /// The link to the file that the links to its pictures start at.
    pub(super) link: String,
    /// Width and height of a tile, pixels.
    pub(super) tile: [u32; 2],
    /// The entries of its tiles, by number.
    entries: FxHashMap<u32, (usize, About)>,
}

impl Set {
    /// What the set's file says about a tile.
    pub(super) fn entry(&self, local: u32) -> Option<&TileEntry> {
        let (index, _) = self.entries.get(&local)?;
        self.file.tiles.get(*index)
    }

    pub(super) fn about(&self, local: u32) -> About {
        let nothing = About {
            height: UNSET,
            kind: None,
        };
        self.entries
            .get(&local)
            .map_or(nothing, |(_, about)| *about)
    }

    /// Whether it has a tile of this number.
    fn has(&self, local: u32) -> bool {
        match self.file.image {
            Some(_) => self.file.count == 0 || i64::from(local) < self.file.count,
            None => self.entries.contains_key(&local),
        }
    }
}

/// The tile sets, by the number of their first tile.
#[derive(Debug)]
pub(super) struct Sets {
    pub(super) list: Vec<Set>,
}

impl Sets {
    /// Reads the tile sets of a map.
    pub(super) fn read(
        links: &[SetLink],
        map: &str,
        resolver: &dyn Resolver,
        tile: [u32; 2],
        idle: &mut BTreeSet<Idle>,
    ) -> Result<Self, TiledError> {
        if links.len() > MAX_SETS {
            let message = format!("it has more than {MAX_SETS} tile sets");
            return Err(TiledError::Limit(message));
        }
        let mut room = MAX_FILE;
        let mut list = Vec::with_capacity(links.len());
        for SetLink { first, source } in links {
            let (file, link) = match source {
                SetSource::Embedded(set) => ((**set).clone(), map.to_owned()),
                SetSource::File(source) => {
                    let link = beside(map, source);
                    (
                        parsed(&link, resolver, &mut room, xml::set, json::set)?,
                        link,
                    )
                }
            };
            let size = match file.tile {
                // A set of pictures of their own may say no size.
                [0, 0] if file.image.is_none() => tile,
                size => sides(size, "tile of a tile set")?,
            };
            let mut entries = FxHashMap::default();
            for (index, entry) in file.tiles.iter().enumerate() {
                let id = u32::try_from(entry.id)
                    .map_err(|_| TiledError::number("id", &entry.id.to_string()))?;
                entries.insert(id, (index, about(entry, idle)));
            }
            list.push(Set {
                first: *first,
                file,
                link,
                tile: size,
                entries,
            });
        }
        list.sort_by_key(|set| set.first);
        Ok(Self { list })
    }

    /// The tile of a number other than 0.
    pub(super) fn tile(&self, number: u32) -> Result<TileId, TiledError> {
        let id = number & !(TURNS | HEXAGONAL);
        let after = self.list.partition_point(|set| set.first <= id);
        let set = after.checked_sub(1).map(|set| (set, &self.list[set]));
        let found = set.filter(|(_, set)| id > 0 && set.has(id - set.first));
        let Some((index, set)) = found else {
            let message =
                format!("a cell or an object has the tile {id}, which is in none of its tile sets");
            return Err(TiledError::Broken(message));
        };
        Ok(TileId {
            set: index as u32,
            local: id - set.first,
            turns: (number >> 29) as u8,
        })
    }
}

fn about(entry: &TileEntry, idle: &mut BTreeSet<Idle>) -> About {
    if entry.is_animated {
        Idle::Animated.note(idle);
    }
    let kind = |word: &str| {
        let mut kinds = Tile::DRAWN.iter().copied();
        kinds.find(|tile| tile.name().eq_ignore_ascii_case(word.trim()))
    };
    let word = entry.properties.tile.as_deref();
    if let Some(word) = word.filter(|word| kind(word).is_none()) {
        Idle::Kind(short(word)).note(idle);
    }
    let class = match entry.class.trim().to_ascii_lowercase().as_str() {
        "water" => Some(Tile::Blue),
        other => kind(other),
    };
    About {
        height: height_of(&entry.properties, idle),
        kind: word.and_then(kind).or(class),
    }
}
