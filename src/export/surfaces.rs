//! Surfaces of solids that are kept for the next time the model is written.

use std::borrow::Cow;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use crate::scene::{Surface, SurfaceSource};

/// Results that writing a scene keeps for the next one: the deferred surfaces of the last scene, as large as the
/// model itself. A surface is found by everything it is made from, so that the output does not depend on the cache.
#[derive(Debug, Default)]
pub struct SurfaceCache {
    known: FxHashMap<u64, Vec<Made>>,
    made: usize,
}

/// A surface and what it was made from.
#[derive(Debug, Clone)]
pub(super) struct Made {
    source: Arc<dyn SurfaceSource>,
    surface: Arc<Surface>,
}

impl SurfaceCache {
    /// How many surfaces were made the last time, and not found.
    pub fn made(&self) -> usize {
        self.made
    }

    fn find(&self, key: u64, source: &dyn SurfaceSource) -> Option<&Made> {
        let all = self.known.get(&key)?;
        all.iter().find(|made| *made.source == *source)
    }

    /// Remembers `used`, and nothing else.
    pub(super) fn keep(&mut self, used: Used) {
        self.known.clear();
        for (key, made) in used.surfaces {
            let same = self.known.entry(key).or_default();
            if !same.iter().any(|known| *known.source == *made.source) {
                same.push(made);
            }
        }
        self.made = used.made;
    }
}

/// The surfaces that were used, and how many of them were made.
#[derive(Debug, Default)]
pub(super) struct Used {
    surfaces: Vec<(u64, Made)>,
    made: usize,
}

impl Used {
    /// The surface of a source, found or made.
    pub(super) fn surface<'a>(
        &mut self,
        source: &Arc<dyn SurfaceSource>,
        cache: &'a SurfaceCache,
    ) -> Cow<'a, Surface> {
        let key = source.key();
        if let Some(made) = cache.find(key, &**source) {
            self.surfaces.push((key, made.clone()));
            return Cow::Borrowed(&made.surface);
        }
        let surface = source.surface();
        self.made += 1;
        let made = Made {
            source: Arc::clone(source),
            surface: Arc::new(surface.clone()),
        };
        self.surfaces.push((key, made));
        Cow::Owned(surface)
    }

    pub(super) fn append(&mut self, other: &mut Self) {
        self.surfaces.append(&mut other.surfaces);
        self.made += std::mem::take(&mut other.made);
    }
}
