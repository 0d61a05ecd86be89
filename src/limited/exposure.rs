//! Exposure sheets: which drawing is shown in which frame.

/// An exposure sheet: for each shown frame the source frame whose drawing it shows.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Exposure {
    /// The source frame of each shown frame.
    pub sources: Vec<u32>,
}

/// A drawing on an exposure sheet: consecutive shown frames that show the same source frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Drawing {
    /// The source frame.
    pub source: u32,
    /// The first frame that shows it.
    pub start: usize,
    /// For how many frames it is held; at least 1.
    pub length: usize,
}

impl Exposure {
    /// An exposure sheet from the source frame of each shown frame.
    pub fn new(sources: Vec<u32>) -> Self {
        Self { sources }
    }

    /// The number of shown frames.
    pub fn len(&self) -> usize {
        self.sources.len()
    }

    /// Whether no frame is shown.
    pub fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    /// The drawings, in the order in which they are shown.
    pub fn drawings(&self) -> impl Iterator<Item = Drawing> + '_ {
        let mut start = 0;
        self.sources.chunk_by(|a, b| a == b).map(move |run| {
            let drawing = Drawing {
                source: run[0],
                start,
                length: run.len(),
            };
            start += run.len();
            drawing
        })
    }

    /// The `STEP` keys of a clip: the frame in which each drawing begins, with its source frame, and a closing key that repeats the
    /// last drawing at the end, because readers take the last key for the end of the clip.
    pub fn step_keys(&self) -> Vec<[usize; 2]> {
        let drawings = self.drawings();
        let mut keys: Vec<[usize; 2]> = drawings
            .map(|drawing| [drawing.start, drawing.source as usize])
            .collect();
        keys.extend(keys.last().map(|[_, source]| [self.len(), *source]));
        keys
    }

    /// Per shown frame the frame of a clip of so many frames; without a sheet every frame is shown.
    pub fn shown(sheet: Option<&Self>, frames: usize) -> Vec<usize> {
        match sheet {
            Some(sheet) => sheet
                .sources
                .iter()
                .map(|source| *source as usize)
                .collect(),
            None => (0..frames).collect(),
        }
    }

    /// The frames in which a new drawing begins.
    pub fn keys(&self) -> impl Iterator<Item = usize> + '_ {
        self.drawings().map(|drawing| drawing.start)
    }
}

/// Shoots on twos, on threes, or on any other number: every `n`-th of `frames` frames is a drawing that is held for `n` frames,
/// the last one for the remaining frames. 0 is taken as 1.
pub fn every(frames: u32, n: u32) -> Exposure {
    every_through(frames, n, 0)
}

/// The same, so that the frame `key` is a drawing: the first drawing is held for fewer frames if necessary.
pub(crate) fn every_through(frames: u32, n: u32, key: u32) -> Exposure {
    let n = n.max(1);
    let late = |frame: u32| (frame + n - key % n) % n;
    Exposure::new(
        (0..frames)
            .map(|frame| frame - late(frame).min(frame))
            .collect(),
    )
}
