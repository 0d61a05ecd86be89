//! Traces, cut where they meet: nobody knows which goes on as which there.

use glam::{DVec2, DVec3};

use super::traces::{Thing, Trace};

/// A shorter trace is noise.
const LEAST_LENGTH: usize = 3;
/// Things that come nearer to each other than this have met, pixels between their borders.
const NEAR: f64 = 6.0;
/// Things that met and part again are one in between, in at most so many frames.
const MOST_MERGED: usize = 20;
/// What is so many times as large as before has something else in it.
const LARGER: f64 = 1.3;
/// What is nearer to the edge of the picture is leaving it, in pixels.
const EDGE: f64 = 4.0;
/// Velocities are measured over so many frames.
const STEPS: usize = 3;

/// A part of a trace in which it meets nothing.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// The index of the trace.
    pub(super) trace: usize,
    /// The first frame, and the one after the last.
    pub(super) from: usize,
    pub(super) to: usize,
    /// Whether it may be the mark: it is not several things that met, and no clutter.
    pub(super) may_be_mark: bool,
    /// Whether it enters the picture at its beginning, and leaves it at its end.
    pub(super) enters: bool,
    pub(super) leaves: bool,
    /// Whether its trace stands still.
    pub(super) is_still: bool,
    /// How it looks: its hue in degrees, and the logarithms of its chroma and of its area.
    pub(super) look: DVec3,
    /// The variances of these.
    pub(super) variance: DVec3,
    /// Where it begins and ends, pixels.
    pub(super) ends: [DVec2; 2],
    /// How far it moves in a frame there, pixels.
    pub(super) velocities: [DVec2; 2],
}

/// The pieces of all traces, which are in the order of their first frames; so are the pieces.
pub(super) fn pieces(traces: &[Trace], size: [u32; 2], is_still_thing: &[bool]) -> Vec<Piece> {
    let is_long = |index: &usize| traces[*index].things.len() >= LEAST_LENGTH;
    let by_first: Vec<usize> = (0..traces.len()).filter(is_long).collect();
    let mut by_end = by_first.clone();
    by_end.sort_by_key(|index| traces[*index].end());
    let mut pieces = Vec::new();
    for index in &by_first {
        let trace = &traces[*index];
        let from = by_first.partition_point(|other| traces[*other].first <= trace.first);
        let begun = by_first[from..].iter().map(|other| &traces[*other]);
        let begun = begun.take_while(|other| other.first < trace.end());
        let parted = begun.filter(|other| has_parted(trace, other));
        let parted: Vec<usize> = parted.map(|other| other.first).collect();
        let from = by_end.partition_point(|other| traces[*other].end() <= trace.first);
        let ended = by_end[from..].iter().map(|other| &traces[*other]);
        let ended = ended.take_while(|other| other.end() < trace.end());
        let met = ended.filter(|other| has_met(trace, other));
        let met = met.map(|other| (other.end(), merged_until(trace, other.end(), &parted)));
        let mut cuts: Vec<(usize, usize)> = met.collect();
        cuts.extend(parted.iter().map(|frame| (*frame, *frame)));
        cuts.sort_unstable();
        let is_still = trace.is_still();
        let is_mark = !trace.is_clutter() && !is_still_thing[*index];
        let piece = |from: usize, to: usize, may_be_mark: bool| Piece {
            may_be_mark,
            is_still,
            ..Piece::new(trace, *index, [from, to], size)
        };
        let mut at = trace.first;
        for (from, to) in cuts.into_iter().chain([(trace.end(), trace.end())]) {
            if from > at {
                pieces.push(piece(at, from, is_mark));
            }
            at = at.max(from);
            if to > at {
                pieces.push(piece(at, to, false));
                at = to;
            }
        }
    }
    pieces.sort_by_key(|piece| piece.from);
    pieces
}

/// Whether another trace begins beside a trace.
fn has_parted(trace: &Trace, other: &Trace) -> bool {
    let thing = &other.things[0];
    trace
        .at(other.first)
        .is_some_and(|own| own.distance(thing) < NEAR)
}

/// Whether another trace ends beside a trace, or would be there in the next frame.
fn has_met(trace: &Trace, other: &Trace) -> bool {
    let last = other.things.len() - 1;
    let mut thing = other.things[last];
    let is_near = |frame: usize, thing: &Thing| {
        trace
            .at(frame)
            .is_some_and(|own| own.distance(thing) < NEAR)
    };
    if is_near(other.end() - 1, &thing) {
        return true;
    }
    thing.at += velocity(other, last.saturating_sub(STEPS), last);
    is_near(other.end(), &thing)
}

/// The frame in which a trace is one thing again, after something met it in this frame.
fn merged_until(trace: &Trace, met: usize, parted: &[usize]) -> usize {
    let mut parted = parted.iter().copied();
    let next = parted.find(|frame| (met + 1..=met + MOST_MERGED).contains(frame));
    let area = trace.at(met - 1).map_or(f64::INFINITY, |thing| thing.area);
    let is_small = |frame: &usize| {
        trace
            .at(*frame)
            .is_some_and(|thing| thing.area < LARGER * area)
    };
    next.or_else(|| (met + 1..trace.end()).find(is_small))
        .unwrap_or(trace.end())
}

/// How far a trace moves in a frame, from one of its things to another.
fn velocity(trace: &Trace, from: usize, to: usize) -> DVec2 {
    let steps = to.saturating_sub(from).max(1) as f64;
    (trace.things[to].at - trace.things[from].at) / steps
}

impl Piece {
    /// A piece of a trace with this index, of which is not yet known what it is.
    fn new(trace: &Trace, index: usize, [from, to]: [usize; 2], size: [u32; 2]) -> Self {
        let (first, last) = (from - trace.first, to - 1 - trace.first);
        let things = &trace.things[first..=last];
        let count = things.len() as f64;
        let look = things.iter().map(|thing| thing.look()).sum::<DVec3>() / count;
        let away = things.iter().map(|thing| thing.look() - look);
        let variance = away.map(|away| away * away).sum::<DVec3>() / count;
        let velocities = [
            velocity(trace, first, (first + STEPS).min(last)),
            velocity(trace, last.saturating_sub(STEPS).max(first), last),
        ];
        let most = DVec2::from_array(size.map(f64::from));
        let is_at_edge = |index: usize, velocity: DVec2| {
            let thing = trace.things[index];
            let reach = EDGE + thing.radius() + velocity.length();
            let inside = thing.at.min(most - thing.at);
            inside.min_element() < reach
        };
        Self {
            enters: is_at_edge(first, velocities[0]),
            leaves: is_at_edge(last, velocities[1]),
            trace: index,
            from,
            to,
            may_be_mark: false,
            is_still: false,
            look,
            variance,
            ends: [trace.things[first].at, trace.things[last].at],
            velocities,
        }
    }
}
