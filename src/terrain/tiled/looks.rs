//! The looks of cells: stacks of tiles.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use super::atlas::{self, Atlas, Pictured};
use super::sets::{Sets, TileId};
use super::{Idle, TiledError};
use crate::resolver::Resolver;
use crate::terrain::map::UNSET;

/// The largest number of looks.
pub(super) const MAX_LOOKS: usize = u16::MAX as usize;

/// A tile on another look.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Look {
    /// The look below, or 0.
    pub(super) below: u16,
    pub(super) tile: TileId,
    /// Of its layer, 0 to 255.
    pub(super) opacity: u8,
    height: LookHeight,
}

/// The height that a look gives its cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::terrain) struct LookHeight {
    /// The height, or [`UNSET`].
    pub(in crate::terrain) height: i8,
    /// Whether a tile gives it, and not a layer.
    pub(in crate::terrain) is_of_tile: bool,
}

/// The looks of a map while it is read.
pub(super) struct Looks<'a> {
    sets: &'a Sets,
    list: Vec<Look>,
    known: FxHashMap<Look, u16>,
    /// The last question and its answer: neighbours are mostly alike.
    last: Option<((u16, u32, u8, i8), u16)>,
}

impl<'a> Looks<'a> {
    pub(super) fn new(sets: &'a Sets) -> Self {
        Self {
            sets,
            list: vec![],
            known: FxHashMap::default(),
            last: None,
        }
    }

    /// The look of the tile with this number on another look. `height` is that of its layer.
    pub(super) fn over(
        &mut self,
        below: u16,
        number: u32,
        opacity: u8,
        height: i8,
    ) -> Result<u16, TiledError> {
        let question = (below, number, opacity, height);
        if let Some((last, answer)) = self.last
            && last == question
        {
            return Ok(answer);
        }
        let tile = self.sets.tile(number)?;
        let of_tile = self.sets.list[tile.set as usize].about(tile.local).height;
        let height = match (of_tile, height) {
            (UNSET, UNSET) => self.height(below),
            (UNSET, height) => LookHeight {
                height,
                is_of_tile: false,
            },
            (height, _) => LookHeight {
                height,
                is_of_tile: true,
            },
        };
        let look = Look {
            below,
            tile,
            opacity,
            height,
        };
        let next = self.list.len() + 1;
        if next > MAX_LOOKS && !self.known.contains_key(&look) {
            let message = format!("more than {MAX_LOOKS} different stacks of tiles are in it");
            return Err(TiledError::Limit(message));
        }
        let list = &mut self.list;
        let answer = *self.known.entry(look).or_insert_with(|| {
            list.push(look);
            next as u16
        });
        self.last = Some((question, answer));
        Ok(answer)
    }

    fn height(&self, look: u16) -> LookHeight {
        let none = LookHeight {
            height: UNSET,
            is_of_tile: false,
        };
        let index = usize::from(look).checked_sub(1);
        index.map_or(none, |index| self.list[index].height)
    }

    /// Per look its height and its picture, and all pictures in one. `tile` is the size of the map's tiles, pixels.
    #[expect(
        clippy::type_complexity,
        reason = "a pair of tables, one of which comes with its pictures"
    )]
    pub(super) fn finish(
        self,
        resolver: &dyn Resolver,
        tile: [u32; 2],
        idle: &mut BTreeSet<Idle>,
    ) -> Result<(Vec<LookHeight>, (Vec<Pictured>, Option<Atlas>)), TiledError> {
        let heights = self.list.iter().map(|look| look.height).collect();
        let drawn = atlas::draw(&self.list, self.sets, resolver, tile, idle)?;
        Ok((heights, drawn))
    }
}
