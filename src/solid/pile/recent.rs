//! The height fields that were needed last.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use glam::{DAffine2, DVec2};
use rustc_hash::FxHashMap;

use super::field::Field;
use crate::solid::Solid;
use crate::solid::heights::{BothHeights, Heights};
use crate::solid::inflate;

/// Limit of the triangles of the fields that are kept: to make a field again, all below it is needed.
const MAX_OF_FIELDS: usize = 1 << 23;
/// Limit of the triangles of the fields of solids by themselves that are kept: each is needed for its surface and for its heights.
const MAX_OF_SOLIDS: usize = 1 << 20;
/// Limit of the triangles of the heights that are kept, which take more memory and are made from fields in no time.
const MAX_OF_HEIGHTS: usize = 1 << 20;

/// The solids that others were laid on last, so that one with much on it is made once, and thousands of them do not fill the
/// memory. They are known by hashes of all that they are made from.
#[derive(Debug)]
pub(crate) struct RecentHeights {
    /// What solids are lifted to; `None` for one that nothing lifts.
    fields: Cache<Option<Arc<Field>>>,
    /// The height fields of solids by themselves; `None` for one that is none.
    solids: Cache<Option<Arc<inflate::Field>>>,
    heights: Cache<BothHeights>,
}

impl Default for RecentHeights {
    fn default() -> Self {
        Self {
            fields: Cache::new(MAX_OF_FIELDS, |field| {
                field.as_ref().map_or(0, |field| field.facet_count())
            }),
            solids: Cache::new(MAX_OF_SOLIDS, |field| {
                field.as_ref().map_or(0, |field| field.mesh.triangles.len())
            }),
            heights: Cache::new(MAX_OF_HEIGHTS, BothHeights::facet_count),
        }
    }
}

impl RecentHeights {
    /// The heights of a solid by itself, whose [`Solid::long_key`] this is.
    pub(super) fn of_solid(&self, key: u128, solid: &Solid) -> BothHeights {
        self.heights.get(key, || {
            BothHeights::of_solid(solid, self.solid_field(key, solid).as_deref())
        })
    }

    /// The height field of a solid by itself, whose [`Solid::long_key`] this is, if it is one.
    pub(super) fn solid_field(&self, key: u128, solid: &Solid) -> Option<Arc<inflate::Field>> {
        self.solids.get(key, || solid.field().map(Arc::new))
    }

    /// The heights of a body with this key that is lifted to a field.
    pub(super) fn of_field(&self, key: u128, field: &Arc<Field>) -> BothHeights {
        self.heights.get(key, || field.heights())
    }

    /// The field of a body with this key, if it is kept.
    pub(super) fn find_field(&self, key: u128) -> Option<Option<Arc<Field>>> {
        self.fields.find(key)
    }

    /// The field of a body with this key, kept or made now.
    pub(super) fn field(
        &self,
        key: u128,
        make: impl FnOnce() -> Option<Field>,
    ) -> Option<Arc<Field>> {
        self.fields.get(key, || make().map(Arc::new))
    }
}

/// Results that were needed last, up to a total size.
#[derive(Debug)]
struct Cache<T> {
    kept: Mutex<Kept<T>>,
    most: usize,
    size: fn(&T) -> usize,
}

#[derive(Debug)]
struct Kept<T> {
    slots: FxHashMap<u128, Slot<T>>,
    /// The keys by when they were last asked for.
    order: BTreeMap<u64, u128>,
    next: u64,
    /// The size of all.
    size: usize,
}

#[derive(Debug)]
struct Slot<T> {
    cell: Arc<OnceLock<T>>,
    used: u64,
    /// Its size, once it is known.
    size: usize,
}

impl<T: Clone> Cache<T> {
    fn new(most: usize, size: fn(&T) -> usize) -> Self {
        let kept = Kept {
            slots: FxHashMap::default(),
            order: BTreeMap::new(),
            next: 0,
            size: 0,
        };
        Self {
            kept: Mutex::new(kept),
            most,
            size,
        }
    }

    fn lock(&self) -> MutexGuard<'_, Kept<T>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What is kept for a key, if anything is.
    fn find(&self, key: u128) -> Option<T> {
        let mut kept = self.lock();
        let is_kept = kept.slots.contains_key(&key);
        is_kept.then(|| kept.slot(key))?.get().cloned()
    }

    /// What is kept for a key, or made now.
    fn get(&self, key: u128, make: impl FnOnce() -> T) -> T {
        let cell = self.lock().slot(key);
        let mut is_new = false;
        let made = cell.get_or_init(|| {
            is_new = true;
            make()
        });
        if is_new {
            self.lock().grow(key, (self.size)(made), self.most);
        }
        made.clone()
    }
}

impl<T> Kept<T> {
    /// The slot of a key, which becomes the one that was asked for last.
    fn slot(&mut self, key: u128) -> Arc<OnceLock<T>> {
        let used = self.next;
        self.next += 1;
        let slot = self.slots.entry(key).or_insert_with(|| Slot {
            cell: Arc::default(),
            used,
            size: 0,
        });
        self.order.remove(&slot.used);
        slot.used = used;
        self.order.insert(used, key);
        Arc::clone(&slot.cell)
    }

    /// Notes how large a result is, and forgets the oldest ones if all together are larger than `most`.
    fn grow(&mut self, key: u128, size: usize, most: usize) {
        if let Some(slot) = self.slots.get_mut(&key) {
            self.size += size - slot.size;
            slot.size = size;
        }
        while self.size > most
            && self.order.len() > 1
            && let Some((_, oldest)) = self.order.pop_first()
        {
            let forgotten = self.slots.remove(&oldest);
            self.size -= forgotten.map_or(0, |slot| slot.size);
        }
    }
}

/// How far a solid by itself reaches from its plane, over points of the drawing. It is made when that is first asked for.
#[derive(Debug)]
pub(crate) struct SolidHeights {
    solid: Solid,
    recent: Arc<RecentHeights>,
    /// From the drawing, y down, to the solid's final positions.
    to_final: DAffine2,
    made: OnceLock<Made>,
}

/// What is made when it is first asked for.
#[derive(Debug)]
struct Made {
    both: BothHeights,
    /// Model units.
    highest: f64,
}

impl SolidHeights {
    /// The heights of a solid, its plane at depth 0.
    pub(crate) fn new(solid: Solid, recent: Arc<RecentHeights>) -> Self {
        Self {
            to_final: solid.to_final(),
            solid,
            recent,
            made: OnceLock::new(),
        }
    }

    fn made(&self) -> &Made {
        self.made.get_or_init(|| {
            let both = self.recent.of_solid(self.solid.long_key(), &self.solid);
            let [front, back] = [&both.front, both.back()].map(Heights::highest);
            Made {
                both,
                highest: front.max(back).max(0.0),
            }
        })
    }

    fn scale(&self) -> f64 {
        self.solid.options.placement.scale
    }

    /// How far it reaches to the front over a point, drawing units; 0 beside it.
    pub(crate) fn front(&self, point: DVec2) -> f64 {
        let front = &self.made().both.front;
        let height = front.at(self.to_final.transform_point2(point));
        height.unwrap_or(0.0) / self.scale()
    }

    /// How far it reaches from its plane at most, drawing units.
    pub(crate) fn highest(&self) -> f64 {
        self.made().highest / self.scale()
    }
}
