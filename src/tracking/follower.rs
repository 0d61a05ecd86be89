//! Marks followed through a whole clip: what a tracker saw, and whether that can be something else.

use glam::DVec2;

use crate::mark_tracks::{MarkTrack, MarkTracks, bridge};

use super::frame::Frame;
use super::judge::{Verdict, judge};
use super::learn::{Learned, LearnedMark};
use super::pieces::{Piece, pieces};
use super::still::still_things;
use super::traces::{Trace, Tracer};
use super::track::{Sighting, Tracker};

/// What is nearer to a mark's thing than this part of its radius is seen there.
const SAME: f64 = 0.6;
/// What is nearer to another thing than so many radii may be that.
const BESIDE: f64 = 2.0;

/// Follows marks through a clip, and judges at its end which of all things that look like a mark is the mark.
#[derive(Debug, Clone)]
pub struct Follower {
    tracker: Tracker,
    /// Where each mark is in the first frame, if somebody said it.
    starts: Vec<Option<DVec2>>,
    tracers: Vec<Tracer>,
    /// Per mark and frame what the tracker saw.
    seen: Vec<Vec<Option<Sighting>>>,
}

/// A mark in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sight {
    /// It is seen there, pixels.
    Seen(DVec2),
    /// It is not seen.
    Lost,
    /// It may be in several places.
    Ambiguous,
}

impl Follower {
    /// A follower of these marks.
    pub fn new(learned: Learned) -> Self {
        let marks = learned.marks.len();
        Self {
            starts: vec![None; marks],
            tracers: vec![Tracer::new(learned.size); marks],
            seen: vec![Vec::new(); marks],
            tracker: Tracker::new(learned),
        }
    }

    /// Says where a mark is before the first frame, as a person does who points at it.
    pub fn start(&mut self, mark: usize, at: DVec2) {
        if let Some(start) = self.starts.get_mut(mark) {
            *start = Some(at);
            self.tracker.start(mark, at);
        }
    }

    /// Looks at the next frame of the clip.
    pub fn push(&mut self, frame: Frame<'_>) {
        let seen = self.tracker.push(frame);
        for (mark, sighting) in seen.into_iter().enumerate() {
            self.seen[mark].push(sighting);
            self.tracers[mark].push(&self.tracker.things(mark));
        }
    }

    /// The tracks of the marks. The frames that were pushed have these times, in seconds from 0; there must be as many.
    pub fn tracks(self, times: Vec<f64>) -> MarkTracks {
        let Learned { size, marks, .. } = &self.tracker.learned;
        let otherwise = DVec2::from_array(size.map(f64::from)) / 2.0;
        let followed = self.tracers.into_iter().zip(&self.seen).zip(&self.starts);
        let track = |(mark, ((tracer, seen), start)): (&LearnedMark, ((Tracer, &Vec<_>), &_))| {
            let sights = sights(mark, *size, &tracer.finish(), seen, *start);
            let at = |sight: &Sight| match sight {
                Sight::Seen(at) => Some(*at),
                Sight::Lost | Sight::Ambiguous => None,
            };
            let places: Vec<Option<DVec2>> = sights.iter().map(at).collect();
            MarkTrack {
                name: mark.mark.name.clone(),
                color: mark.mark.color,
                is_lost: places.iter().map(Option::is_none).collect(),
                is_ambiguous: sights
                    .iter()
                    .map(|sight| *sight == Sight::Ambiguous)
                    .collect(),
                points: bridge(&times, &places, otherwise),
            }
        };
        MarkTracks {
            size: *size,
            marks: marks.iter().zip(followed).map(track).collect(),
            times,
        }
    }
}

/// What is known about a mark in each frame, by what the tracker saw and by the traces of all things that look like the mark.
fn sights(
    mark: &LearnedMark,
    size: [u32; 2],
    traces: &[Trace],
    seen: &[Option<Sighting>],
    start: Option<DVec2>,
) -> Vec<Sight> {
    let radius = (mark.area / std::f64::consts::PI).sqrt();
    let pieces = pieces(traces, size, &still_things(traces, mark.look()));
    let verdicts = judge(&pieces, seen.len(), start, mark.look());
    let seen_at = |sighting: &Option<Sighting>| match sighting {
        Some(sighting) => Sight::Seen(sighting.at),
        None => Sight::Lost,
    };
    let mut sights: Vec<Sight> = seen.iter().map(seen_at).collect();
    let things = |piece: &Piece| {
        let trace = &traces[piece.trace];
        let from = piece.from;
        let things = &trace.things[from - trace.first..piece.to - trace.first];
        things
            .iter()
            .enumerate()
            .map(move |(index, thing)| (from + index, thing.at))
    };
    // First what may be something else, then what is the mark.
    for (piece, verdict) in pieces.iter().zip(&verdicts) {
        if *verdict == Verdict::Other {
            for (frame, at) in things(piece) {
                if seen[frame].is_some_and(|seen| seen.at.distance(at) < BESIDE * radius) {
                    sights[frame] = Sight::Ambiguous;
                }
            }
        }
    }
    for (piece, verdict) in pieces.iter().zip(&verdicts) {
        for (frame, at) in things(piece) {
            match verdict {
                Verdict::Other => {}
                Verdict::Ambiguous => sights[frame] = Sight::Ambiguous,
                Verdict::Mark => {
                    let near = seen[frame].filter(|seen| seen.at.distance(at) < SAME * radius);
                    sights[frame] = Sight::Seen(near.map_or(at, |seen| seen.at));
                }
            }
        }
    }
    sights
}
