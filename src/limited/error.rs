//! The error of a thinned-out motion against its source.

use rayon::prelude::*;

use super::drawings::{MAX_HOLD, drawings};
use super::exposure::{Exposure, every};
use super::poses::Poses;

/// Frames that are summed separately, so that the sum does not depend on the number of threads.
const GRAIN: usize = 1024;

/// A way to thin out a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The requested way.
    Asked,
    /// On twos: every second frame.
    Twos,
    /// On threes: every third frame.
    Threes,
    /// The best drawings, as many as the requested way has.
    Best,
}

/// The error of a thinned-out motion against its source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Error {
    /// The number of drawings.
    pub drawings: usize,
    /// The root mean square of the points' distances, over all points and frames, in the positions' unit.
    pub rms: f64,
    /// The same in percent of the figure's height; `None` if that is not a positive number.
    pub percent: Option<f64>,
}

/// The error of what is shown against the source at the same time: each shown frame is compared with the source frame of the
/// same number. Of a shortened clip only its own frames are compared; source frames that do
/// not exist are skipped. `height` is the figure's, in the positions' unit.
pub fn error(frames: Poses<'_>, height: f64, exposure: &Exposure) -> Error {
    let shown = &exposure.sources;
    let shown = &shown[..shown.len().min(frames.count())];
    let sums: Vec<[f64; 2]> = shown
        .par_chunks(GRAIN)
        .enumerate()
        .map(|(chunk, shown)| {
            let sources = shown.iter().map(|source| *source as usize);
            let pairs = sources
                .enumerate()
                .filter(|(_, source)| *source < frames.count());
            pairs.fold([0.0; 2], |[sum, count], (offset, source)| {
                let apart = match chunk * GRAIN + offset {
                    frame if frame == source => 0.0,
                    frame => frames.ssd(source, frame),
                };
                [sum + apart, count + 1.0]
            })
        })
        .collect();
    let [sum, count] = sums.iter().fold([0.0; 2], |[sum, count], [more, frames]| {
        [sum + more, count + frames]
    });
    let rms = if count > 0.0 {
        (sum / (count * frames.per_frame() as f64)).sqrt()
    } else {
        0.0
    };
    Error {
        drawings: exposure.drawings().count(),
        rms,
        percent: (height > 0.0).then(|| 100.0 * rms / height),
    }
}

/// The error of an exposure sheet next to those of other ways: on twos, on threes, and the best drawings of the same number (or
/// the nearest possible), each held for at most [`MAX_HOLD`] frames.
pub fn compare(poses: Poses<'_>, height: f64, asked: &Exposure) -> [(Method, Error); 4] {
    let frames = poses.count() as u32;
    let best = drawings(poses, asked.drawings().count(), MAX_HOLD);
    [
        (Method::Asked, asked),
        (Method::Twos, &every(frames, 2)),
        (Method::Threes, &every(frames, 3)),
        (Method::Best, &best.exposure),
    ]
    .map(|(method, exposure)| (method, error(poses, height, exposure)))
}
