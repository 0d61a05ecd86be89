//! Models that pages can fetch.

use std::collections::VecDeque;
use std::sync::{Arc, OnceLock};

use serde_json::value::RawValue;

use super::delta::delta;
use crate::compile::Compiled;
use crate::export::{self, GLB, Written};
use crate::render::{self, Options, PosedModel, write_png};
use crate::resolver::MemoryResolver;

/// How many models of changes that were only tried are kept, so that only what differs is sent of the next one.
const MAX_TRIED: usize = 4;

/// The side of the thumbnails in the gallery, in pixels.
const THUMBNAIL_SIZE: u32 = 320;

/// A file that is sent.
pub(crate) type Bytes = Arc<[u8]>;

/// A model that can be fetched.
pub(crate) struct StoredModel {
    pub(crate) number: u64,
    pub(crate) bytes: Bytes,
    /// Its clips before they were performed and limited, as binary glTF without meshes.
    pub(crate) originals: Option<Bytes>,
    /// The description of its clips.
    pub(crate) clips: Box<RawValue>,
    pub(crate) written: Written,
    picture: OnceLock<Option<Bytes>>,
    /// The number of the model before, and what changed since.
    delta: OnceLock<(u64, Option<Bytes>)>,
}

impl StoredModel {
    pub(crate) fn new(
        number: u64,
        bytes: Bytes,
        originals: Option<Bytes>,
        clips: Box<RawValue>,
        written: Written,
    ) -> Self {
        Self {
            number,
            bytes,
            originals,
            clips,
            written,
            picture: OnceLock::new(),
            delta: OnceLock::new(),
        }
    }

    /// Whether it is made of these.
    pub(crate) fn is(&self, bytes: &Bytes, originals: Option<&Bytes>, clips: &RawValue) -> bool {
        let same = self.bytes == *bytes && self.originals.as_ref() == originals;
        same && self.clips.get() == clips.get()
    }

    /// What changed since another model, as binary glTF; the whole model if that is too much.
    pub(crate) fn since(&self, (before, bytes): &(u64, Bytes)) -> Bytes {
        let compare = || delta(bytes, &self.bytes, *before).map(Bytes::from);
        let (number, delta) = self.delta.get_or_init(|| (*before, compare()));
        let delta = if number == before {
            delta.clone()
        } else {
            compare()
        };
        delta.unwrap_or_else(|| self.bytes.clone())
    }

    /// A thumbnail as PNG; `None` if it cannot be drawn. It is drawn on the first call.
    pub(crate) fn picture(&self) -> Option<Bytes> {
        let drawn = || thumbnail(&self.bytes);
        self.picture.get_or_init(drawn).clone()
    }
}

/// The last models of changes that were only tried, with their numbers.
#[derive(Default)]
pub(crate) struct TriedModels(VecDeque<(u64, Bytes)>);

impl TriedModels {
    pub(crate) fn keep(&mut self, number: u64, bytes: Bytes) {
        self.0.push_back((number, bytes));
        if self.0.len() > MAX_TRIED {
            self.0.pop_front();
        }
    }

    pub(crate) fn get(&self, number: u64) -> Option<Bytes> {
        let found = self.0.iter().find(|(known, _)| *known == number);
        found.map(|(_, bytes)| bytes.clone())
    }
}

/// The clips of a drawing before they were performed and limited, as binary glTF; `None` if none was either.
pub(crate) fn originals(compiled: &Compiled) -> Option<Bytes> {
    let model = export::to_memory(&GLB, &compiled.originals()?, None).ok()?;
    Some(model.bytes.into())
}

/// A small picture of a model in binary glTF, as PNG; `None` if it cannot be drawn.
pub(crate) fn thumbnail(model: &[u8]) -> Option<Bytes> {
    let model = render::read(model, &MemoryResolver::default()).ok()?;
    let posed = PosedModel::new(&model, &model.rest()).ok()?;
    let options = Options {
        size: [THUMBNAIL_SIZE; 2],
        ..Options::default()
    };
    let mut png = Vec::new();
    write_png(&posed.picture(&options).ok()?, &mut png).ok()?;
    Some(Bytes::from(png))
}
