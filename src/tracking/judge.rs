//! Which of all things that look like a mark is the mark, judged by the whole clip.
//!
//! The mark's way is the row of pieces that explains the clip best: it is in the picture in most frames, does not jump, and looks the same
//! before a gap and after it. Costs are logarithms of odds.

use glam::{DVec2, DVec3};

use super::pieces::Piece;
use super::still::similarity;

/// What it is worth to explain all frames of a clip.
const WORTH: f64 = 12.0;
/// How much of that a thing is worth that stands still: there are many such things, and marks are there to move.
const STILL: f64 = 0.15;
/// What it is worth that a way begins where the mark was pointed at.
const POINTED_AT: f64 = 4.0;
/// How much a mark's look differs from before: its hue in degrees, and the logarithms of its chroma and of its area.
const SPREAD: DVec3 = DVec3::new(2.5, 0.08, 0.15);
/// The most that another look costs.
const MOST_LOOK: f64 = 8.0;
/// How far a mark is from where it should be after a gap, in pixels: at least, for each frame, and by its speed.
const JUMP: [f64; 3] = [6.0, 0.5, 0.1];
/// After more frames than this it may be anywhere, and is so many pixels farther away for each.
const SHORT_GAP: f64 = 6.0;
const LONG_GAP: f64 = 6.0;
/// The most that a jump costs.
const MOST_JUMP: f64 = 6.0;
/// What a link of a mark's own pieces usually costs.
const USUAL_LINK: f64 = 1.0;
/// How many pieces before and after one are looked at.
const MOST_LINKS: usize = 64;
/// How much a frame is worth, of one in which it is seen, in which a thing that left the picture is gone before it returns.
const GONE: f64 = 0.5;
/// How much two ways that have a piece in common differ at most by the frames that they explain: of one mark the other way may be hidden.
const SHARED: f64 = 1.5;
/// A way is about as good as the best one if it is worth more than this part of it,
const RIVAL: f64 = 0.28;
/// and if it shares no piece with it, or is worse by less than this.
const MARGIN: f64 = 3.0;

/// What a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The mark.
    Mark,
    /// The mark, or something else is.
    Ambiguous,
    /// Something else.
    Other,
}

/// A row of pieces: what its frames are worth, what its links cost, and its next piece.
#[derive(Debug, Clone, Copy, Default)]
struct Row {
    worth: f64,
    cost: f64,
    next: Option<usize>,
}

impl Row {
    fn total(&self) -> f64 {
        self.worth - self.cost
    }

    /// The row with a piece put before it.
    fn extended(&self, piece: usize, cost: f64) -> Self {
        Self {
            worth: self.worth,
            cost: self.cost + cost,
            next: Some(piece),
        }
    }
}

/// The best rows of pieces that end with each piece, and that begin with it.
struct Rows<'a> {
    pieces: &'a [Piece],
    worths: Vec<f64>,
    before: Vec<Row>,
    after: Vec<Row>,
}

/// What each of the pieces of a clip is. They are in the order of their first frames; `start` is where the mark is in the first one, if
/// somebody pointed at it, and `look` how it looks usually.
pub(super) fn judge(
    pieces: &[Piece],
    frames: usize,
    start: Option<DVec2>,
    look: DVec3,
) -> Vec<Verdict> {
    let mut verdicts = vec![Verdict::Other; pieces.len()];
    let candidates = (0..pieces.len()).filter(|index| pieces[*index].may_be_mark);
    let candidates: Vec<usize> = candidates.collect();
    let rows = Rows::new(pieces, &candidates, frames, start, look);
    let all = candidates.iter().copied();
    let total = |index: usize| rows.through(index).total();
    let Some(best) = all.clone().max_by(|a, b| total(*a).total_cmp(&total(*b))) else {
        return verdicts;
    };
    let way = rows.way(best);
    for index in &way {
        verdicts[*index] = Verdict::Mark;
    }
    let best = rows.through(best);
    let is_shared = rows.have(&candidates, &verdicts);
    for other in all {
        if verdicts[other] != Verdict::Other {
            continue;
        }
        let other_row = rows.through(other);
        // Of ways that part, the one that is seen longer is no better: of the mark's the rest may be hidden.
        let more = (best.worth - other_row.worth).clamp(-SHARED, SHARED);
        let margin = more + other_row.cost - best.cost;
        let is_long = other_row.total() > RIVAL * best.total();
        let is_as_good = is_long && (!is_shared[other] || margin < MARGIN);
        if is_as_good {
            let Piece { from, to, .. } = pieces[other];
            let first = way.partition_point(|index| pieces[*index].to <= from);
            let meanwhile = way[first..].iter();
            for index in meanwhile.take_while(|index| pieces[**index].from < to) {
                verdicts[*index] = Verdict::Ambiguous;
            }
        }
    }
    verdicts
}

impl<'a> Rows<'a> {
    fn new(
        pieces: &'a [Piece],
        candidates: &[usize],
        frames: usize,
        start: Option<DVec2>,
        look: DVec3,
    ) -> Self {
        let worth = |piece: &Piece| {
            let still = if piece.is_still { STILL } else { 1.0 };
            let part = (piece.to - piece.from) as f64 / frames as f64;
            WORTH * part * still * similarity(piece.look, look)
        };
        let mut rows = Self {
            pieces,
            worths: pieces.iter().map(worth).collect(),
            before: vec![Row::default(); pieces.len()],
            after: vec![Row::default(); pieces.len()],
        };
        let begins = candidates.iter().filter(|index| pieces[**index].from == 0);
        if let Some(start) = start {
            let away = |index: usize| pieces[index].ends[0].distance(start);
            let pointed_at = begins.min_by(|a, b| away(**a).total_cmp(&away(**b)));
            if let Some(index) = pointed_at {
                rows.worths[*index] += POINTED_AT;
            }
        }
        let better = |best: Row, found: Row| match found.total() > best.total() {
            true => found,
            false => best,
        };
        for (place, index) in candidates.iter().enumerate() {
            let earlier = candidates[..place].iter().rev().take(MOST_LINKS);
            let earlier = earlier.filter(|earlier| pieces[**earlier].to <= pieces[*index].from);
            let row = earlier.fold(Row::default(), |best, earlier| {
                let cost = rows.link(*earlier, *index);
                better(best, rows.before[*earlier].extended(*earlier, cost))
            });
            rows.before[*index] = Row {
                worth: row.worth + rows.worths[*index],
                ..row
            };
        }
        for (place, index) in candidates.iter().enumerate().rev() {
            let later = candidates[place + 1..].iter().take(MOST_LINKS);
            let later = later.filter(|later| pieces[*index].to <= pieces[**later].from);
            let row = later.fold(Row::default(), |best, later| {
                let cost = rows.link(*index, *later);
                better(best, rows.after[*later].extended(*later, cost))
            });
            rows.after[*index] = Row {
                worth: row.worth + rows.worths[*index],
                ..row
            };
        }
        rows
    }

    /// What it costs to say that a piece goes on as another one.
    fn link(&self, from: usize, to: usize) -> f64 {
        let (before, after) = (&self.pieces[from], &self.pieces[to]);
        let each = |index: usize| {
            let Piece { from, to, .. } = self.pieces[index];
            self.worths[index] / (to - from) as f64
        };
        let gone = match before.leaves && after.enters {
            true => GONE * each(from).min(each(to)) * (after.from - before.to) as f64,
            false => 0.0,
        };
        link(before, after) - gone
    }

    /// The best row that a piece is in.
    fn through(&self, index: usize) -> Row {
        let (before, after) = (self.before[index], self.after[index]);
        Row {
            worth: before.worth + after.worth - self.worths[index],
            cost: before.cost + after.cost,
            next: None,
        }
    }

    /// The pieces of the best row that a piece is in, in the order of time.
    fn way(&self, index: usize) -> Vec<usize> {
        let before = std::iter::successors(Some(index), |index| self.before[*index].next);
        let mut way: Vec<usize> = before.collect();
        way.reverse();
        let after = std::iter::successors(self.after[index].next, |index| self.after[*index].next);
        way.extend(after);
        way
    }

    /// For each piece whether the best row that it is in has a piece of the mark.
    fn have(&self, candidates: &[usize], verdicts: &[Verdict]) -> Vec<bool> {
        let is_mark = |index: usize| verdicts[index] == Verdict::Mark;
        let mut before = vec![false; self.pieces.len()];
        for index in candidates {
            let earlier = self.before[*index].next;
            before[*index] = is_mark(*index) || earlier.is_some_and(|earlier| before[earlier]);
        }
        let mut after = vec![false; self.pieces.len()];
        for index in candidates.iter().rev() {
            let later = self.after[*index].next;
            after[*index] = is_mark(*index) || later.is_some_and(|later| after[later]);
        }
        before.iter().zip(after).map(|(a, b)| *a || b).collect()
    }
}

/// What it costs to say that a piece goes on as another one.
fn link(from: &Piece, to: &Piece) -> f64 {
    let gap = (to.from + 1 - from.to) as f64;
    // Both are carried on to the middle between them.
    let steps = gap.min(SHORT_GAP) / 2.0;
    let there = from.ends[1] + steps * from.velocities[1];
    let here = to.ends[0] - steps * to.velocities[0];
    let speed = from.velocities[1].length().max(to.velocities[0].length());
    let [least, each, part] = JUMP;
    let spread = least + gap * (each + part * speed) + (gap - SHORT_GAP).max(0.0) * LONG_GAP;
    let jump = there.distance_squared(here) / (2.0 * spread * spread);
    let variance = SPREAD * SPREAD + (from.variance + to.variance) / 2.0;
    let away = from.look - to.look;
    let look = (away * away / variance).element_sum() / 2.0;
    (jump.min(MOST_JUMP) + look.min(MOST_LOOK) - USUAL_LINK).max(0.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::tracking::pieces::pieces;
    use crate::tracking::still::still_things;
    use crate::tracking::traces::{Thing, Trace, Tracer};

    const SIZE: [u32; 2] = [320, 240];
    const FRAMES: usize = 100;
    const AREA: f64 = 150.0;

    fn look() -> DVec3 {
        DVec3::new(0.0, 0.5_f64.ln(), AREA.ln())
    }

    fn thing(at: DVec2, hue: f64) -> Thing {
        Thing {
            at,
            area: AREA,
            tint: DVec2::new(hue, 0.5),
            is_beside_clutter: false,
            often: 0.0,
        }
    }

    /// What a clip of some things in each frame is judged to be.
    fn judged(things: impl Fn(usize) -> Vec<Thing>) -> (Vec<Trace>, Vec<Piece>, Vec<Verdict>) {
        let mut tracer = Tracer::new(SIZE);
        (0..FRAMES).for_each(|frame| tracer.push(&things(frame)));
        let traces = tracer.finish();
        let pieces = pieces(&traces, SIZE, &still_things(&traces, look()));
        let verdicts = judge(&pieces, FRAMES, None, look());
        (traces, pieces, verdicts)
    }

    /// Where the mark is by the verdicts in a frame, and whether it is ambiguous.
    fn found(
        (traces, pieces, verdicts): &(Vec<Trace>, Vec<Piece>, Vec<Verdict>),
        frame: usize,
    ) -> (Option<DVec2>, bool) {
        let now = pieces.iter().zip(verdicts);
        let mut now = now.filter(|(piece, verdict)| {
            (piece.from..piece.to).contains(&frame) && **verdict != Verdict::Other
        });
        let place = now.next().map(|(piece, verdict)| {
            let at = traces[piece.trace].at(frame).expect("it is then").at;
            (at, *verdict == Verdict::Ambiguous)
        });
        assert!(now.next().is_none(), "the mark is in one place");
        (
            place
                .filter(|(_, is_ambiguous)| !is_ambiguous)
                .map(|(at, _)| at),
            place.is_some_and(|(_, is_ambiguous)| is_ambiguous),
        )
    }

    fn round(frame: usize) -> DVec2 {
        DVec2::new(160.0, 100.0) + 70.0 * DVec2::from_angle(frame as f64 / 9.0)
    }

    #[test]
    fn what_moves_for_as_long_is_as_good() {
        let other = |frame: usize| DVec2::new(20.0 + 2.0 * frame as f64, 220.0);
        let both = judged(|frame| vec![thing(round(frame), 0.0), thing(other(frame), 1.0)]);
        assert!((0..FRAMES).all(|frame| found(&both, frame).1));
        let short = |frame: usize| {
            let mut things = vec![thing(round(frame), 0.0)];
            things.extend((frame < 15).then(|| thing(other(frame), 1.0)));
            things
        };
        let judged = judged(short);
        for frame in 0..FRAMES {
            assert_eq!(found(&judged, frame), (Some(round(frame)), false));
        }
    }

    /// Two things that meet in frame 85, after the mark was alone; the other one has another hue.
    fn meeting(hue: f64) -> impl Fn(usize) -> Vec<Thing> {
        move |frame| {
            let time = frame as f64;
            let mark = DVec2::new(20.0 + 2.0 * time, 120.0);
            let other = DVec2::new(190.0, 120.0 + 6.0 * (time - 85.0));
            match mark.distance(other) {
                // One thing with both colours.
                ..14.0 => vec![Thing {
                    area: 1.6 * AREA,
                    ..thing((mark + other) / 2.0, hue / 2.0)
                }],
                _ if frame < 76 => vec![thing(mark, 0.0)],
                _ => vec![thing(mark, 0.0), thing(other, hue)],
            }
        }
    }

    #[test]
    fn things_that_part_are_told_apart_by_their_hues() {
        for (hue, is_told_apart) in [(0.0, false), (15.0, true)] {
            let judged = judged(meeting(hue));
            assert!(found(&judged, 40).0.is_some());
            assert_eq!(found(&judged, 85), (None, false), "they are one thing");
            let (at, is_ambiguous) = found(&judged, 95);
            assert_eq!(is_ambiguous, !is_told_apart, "hue {hue}");
            assert_eq!(
                at.is_some_and(|at| at.distance(DVec2::new(210.0, 120.0)) < 1.0),
                is_told_apart
            );
        }
    }

    #[test]
    fn a_mark_that_is_gone_is_not_what_stood_elsewhere() {
        let still = DVec2::new(60.0, 200.0);
        let judged = judged(|frame| {
            let mut things = vec![thing(still, 0.0)];
            things.extend((frame < 70).then(|| thing(round(frame), 0.0)));
            things
        });
        for frame in 0..FRAMES {
            let (at, _) = found(&judged, frame);
            assert!(at.is_none_or(|at| at.distance(still) > 1.0), "{frame}");
        }
        assert_eq!(found(&judged, 30).0, Some(round(30)));
    }

    proptest! {
        #[test]
        fn a_mark_is_in_one_place_at_most(
            ways in prop::collection::vec((0.0..320.0, 0.0..240.0, -6.0..6.0, -6.0..6.0, 0..FRAMES, 0..FRAMES), 0..6)
        ) {
            let judged = judged(|frame| {
                let now = ways.iter().filter(|way| (way.4..way.5).contains(&frame));
                let at = |way: &(f64, f64, f64, f64, usize, usize)| {
                    DVec2::new(way.0, way.1) + frame as f64 * DVec2::new(way.2, way.3)
                };
                now.map(|way| thing(at(way), 0.0)).collect()
            });
            for frame in 0..FRAMES {
                // It fails if there are two.
                found(&judged, frame);
            }
            for (piece, verdict) in judged.1.iter().zip(&judged.2) {
                prop_assert!(piece.may_be_mark || *verdict == Verdict::Other);
            }
        }
    }
}
