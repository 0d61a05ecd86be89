//! The height fields that were needed last.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use glam::{DAffine2, DVec2};
use rustc_hash::FxHashMap;

use super::field::Field;
use crate::scene::SurfaceSource;
use crate::solid::Solid;
use crate::solid::heights::BothHeights;

/// Limit of the triangles that are kept.
const MAX_FACETS: usize = 1 << 20;

/// A solid as others lie on it.
#[derive(Debug, Clone)]
pub(super) struct Recent {
    pub(super) heights: BothHeights,
    /// What it is lifted to, if it is lifted itself.
    pub(super) field: Option<Arc<Field>>,
}

impl Recent {
    /// A solid that is lifted.
    pub(super) fn lifted(field: Field) -> Self {
        Self {
            heights: field.heights(),
            field: Some(Arc::new(field)),
        }
    }
}

/// The solids that others were laid on last, so that one with much on it is made once, and thousands of them do not fill the
/// memory. They are known by hashes of all that they are made from.
#[derive(Debug, Default)]
pub struct RecentHeights(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    slots: FxHashMap<u128, Slot>,
    /// The keys by when they were last asked for.
    order: BTreeMap<u64, u128>,
    next: u64,
    /// The triangles of all.
    facets: usize,
}

#[derive(Debug)]
struct Slot {
    cell: Arc<OnceLock<Option<Recent>>>,
    used: u64,
    /// Its triangles, once they are known.
    facets: usize,
}

impl RecentHeights {
    /// The heights of a solid by itself.
    pub(super) fn of_solid(&self, solid: &Solid) -> BothHeights {
        let make = || Recent {
            heights: BothHeights::of(&solid.surface()),
            field: None,
        };
        let found = self.get(solid.long_key(), || Some(make()));
        found.unwrap_or_else(make).heights
    }

    /// What is kept for a key, if anything is.
    pub(super) fn find(&self, key: u128) -> Option<Option<Recent>> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.slots
            .contains_key(&key)
            .then(|| kept.slot(key))?
            .get()
            .cloned()
    }

    /// What is kept for a key, or made now.
    pub(super) fn get(&self, key: u128, make: impl FnOnce() -> Option<Recent>) -> Option<Recent> {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let cell = lock().slot(key);
        let mut is_new = false;
        let made = cell.get_or_init(|| {
            is_new = true;
            make()
        });
        if is_new {
            let facets = made
                .as_ref()
                .map_or(0, |recent| recent.heights.facet_count());
            lock().grow(key, facets);
        }
        made.clone()
    }
}

impl Kept {
    /// The slot of a key, which becomes the one that was asked for last.
    fn slot(&mut self, key: u128) -> Arc<OnceLock<Option<Recent>>> {
        let used = self.next;
        self.next += 1;
        let slot = self.slots.entry(key).or_insert_with(|| Slot {
            cell: Arc::default(),
            used,
            facets: 0,
        });
        self.order.remove(&slot.used);
        slot.used = used;
        self.order.insert(used, key);
        Arc::clone(&slot.cell)
    }

    /// Notes how large a result is, and forgets the oldest ones if all together are too large.
    fn grow(&mut self, key: u128, facets: usize) {
        if let Some(slot) = self.slots.get_mut(&key) {
            self.facets += facets - slot.facets;
            slot.facets = facets;
        }
        while self.facets > MAX_FACETS
            && self.order.len() > 1
            && let Some((_, oldest)) = self.order.pop_first()
        {
            let forgotten = self.slots.remove(&oldest);
            self.facets -= forgotten.map_or(0, |slot| slot.facets);
        }
    }
}

/// How far a solid by itself reaches from its plane, over points of the drawing.
#[derive(Debug, Clone)]
pub struct SolidHeights {
    both: BothHeights,
    /// From the drawing, y down, to the solid's final positions.
    to_final: DAffine2,
    scale: f64,
}

impl SolidHeights {
    /// The heights of a solid, its plane at depth 0.
    pub fn of(solid: &Solid, recent: &RecentHeights) -> Self {
        Self {
            both: recent.of_solid(solid),
            to_final: solid.to_final(),
            scale: solid.options.placement.scale,
        }
    }

    /// How far it reaches to the front over a point, drawing units; 0 beside it.
    pub fn front(&self, point: DVec2) -> f64 {
        let height = self.both.front.at(self.to_final.transform_point2(point));
        height.unwrap_or(0.0) / self.scale
    }

    /// How far it reaches to the front and to the back at most, drawing units.
    pub fn highest(&self) -> [f64; 2] {
        [&self.both.front, &self.both.back].map(|side| side.highest() / self.scale)
    }
}
