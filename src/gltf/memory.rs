//! Solids that were made, kept for the next time the model is written.

use std::borrow::Cow;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use crate::scene::Surface;
use crate::solid::Solid;

/// What writing remembers from one time to the next: the surfaces of the solids of the last scene, as large as the
/// model itself. A solid is found by all that it is made from, so that what is written does not depend on it.
#[derive(Debug, Default)]
pub struct Memory {
    known: FxHashMap<u64, Vec<Made>>,
    made: usize,
}

/// A solid and its surface.
#[derive(Debug, Clone)]
pub(super) struct Made {
    solid: Solid,
    surface: Arc<Surface>,
}

impl Memory {
    /// How many solids were made the last time, and not found.
    pub fn made(&self) -> usize {
        self.made
    }

    fn find(&self, key: u64, solid: &Solid) -> Option<&Made> {
        let all = self.known.get(&key)?;
        all.iter().find(|made| made.solid == *solid)
    }

    /// Remembers `used`, and nothing else.
    pub(super) fn keep(&mut self, used: Used) {
        self.known.clear();
        for (key, made) in used.solids {
            let same = self.known.entry(key).or_default();
            if !same.iter().any(|known| known.solid == made.solid) {
                same.push(made);
            }
        }
        self.made = used.made;
    }
}

/// The solids that were used, and how many of them were made.
#[derive(Debug, Default)]
pub(super) struct Used {
    solids: Vec<(u64, Made)>,
    made: usize,
}

impl Used {
    /// The surface of a solid, found or made.
    pub(super) fn surface<'a>(&mut self, solid: &Solid, memory: &'a Memory) -> Cow<'a, Surface> {
        let key = solid.key();
        if let Some(made) = memory.find(key, solid) {
            self.solids.push((key, made.clone()));
            return Cow::Borrowed(&made.surface);
        }
        let surface = solid.surface();
        self.made += 1;
        let made = Made {
            solid: solid.clone(),
            surface: Arc::new(surface.clone()),
        };
        self.solids.push((key, made));
        Cow::Owned(surface)
    }

    pub(super) fn append(&mut self, other: &mut Self) {
        self.solids.append(&mut other.solids);
        self.made += std::mem::take(&mut other.made);
    }
}
