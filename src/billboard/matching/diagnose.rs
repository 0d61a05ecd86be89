//! What to say about a matching: regions without a partner, and views that contradict each other.

use super::cost::{Features, Turn};
use super::{
    Candidate, Comparison, Matching, Names, Pair, Place, Reason, TrackId, Unmatched, Warning,
    compare, nearest,
};
use crate::billboard::place::{angle, nearest_to_rays};
use crate::billboard::region::View;

/// Views closer than this give uncertain depths, degrees.
const SMALL_ANGLE: f64 = 15.0;
/// Differences in depth below this say nothing, heights.
const LEAST_DEPTH: f64 = 0.01;
/// Candidates named for a region without a partner.
const CANDIDATES: usize = 3;

/// Looks at the pairs of two views that were matched just now.
pub(super) fn step(
    views: &[View],
    all: &[Vec<Features>],
    pair: [usize; 2],
    matching: &mut Matching,
) {
    let [a, b] = pair.map(|v| views[v].direction);
    let degrees = angle(a, b);
    if degrees < SMALL_ANGLE {
        matching.warnings.push(Warning::SmallAngle {
            views: pair,
            degrees,
        });
    }
    let toward = a.axes()[2] + b.axes()[2];
    let of_views = |p: &&Pair| [p.first.view, p.second.view] == pair;
    let depth_of = |place: [usize; 2]| {
        let at = [0, 1].map(|i| all[pair[i]][place[i]].at);
        nearest_to_rays(&[(a, at[0]), (b, at[1])]).map(|p| p.dot(toward) / toward.length())
    };
    // The partner of each region of the first view.
    let mut partners = vec![None; all[pair[0]].len()];
    for pair in matching.pairs.iter().filter(of_views) {
        partners[pair.first.region] = Some(pair.second.region);
    }
    let (mut behind, mut of) = (0, 0);
    for (inner, partner) in partners.iter().enumerate() {
        let containers = partner.and_then(|p| {
            let outer = all[pair[0]][inner].container?;
            let other = all[pair[1]][p].container?;
            (partners[outer] == Some(other)).then_some([[inner, p], [outer, other]])
        });
        let Some([Some(inner), Some(outer)]) = containers.map(|c| c.map(depth_of)) else {
            continue;
        };
        if (inner - outer).abs() > LEAST_DEPTH {
            of += 1;
            behind += usize::from(inner < outer);
        }
    }
    if 2 * behind > of {
        matching.warnings.push(Warning::BehindContainers {
            views: pair,
            behind,
            of,
        });
    }
}

/// Lists the regions that are alone, with those that fit them best.
pub(super) fn unmatched(views: &[View], all: &[Vec<Features>], matching: &mut Matching) {
    let mut partners: Vec<Vec<Option<TrackId>>> = all
        .iter()
        .map(|regions| vec![None; regions.len()])
        .collect();
    for (i, track) in matching.tracks.iter_enumerated() {
        for (view, region) in track.regions.iter().enumerate() {
            if let Some(region) = region {
                partners[view][*region] = Some(i);
            }
        }
    }
    let mut found = Vec::new();
    for track in &matching.tracks {
        let mut seen = track.regions.iter().enumerate();
        let mut seen = seen.by_ref().filter_map(|(view, r)| {
            Some(Place {
                view,
                region: (*r)?,
            })
        });
        let (Some(place), None) = (seen.next(), seen.next()) else {
            continue;
        };
        let others: Vec<_> = (0..views.len()).filter(|v| *v != place.view).collect();
        let Some(view) = nearest(views, place.view, &others) else {
            continue;
        };
        // The same direction of comparison as in the matching, where the earlier view predicts the later one.
        let ordered = |other: Place| {
            if place.view < view {
                [place, other]
            } else {
                [other, place]
            }
        };
        let [from, to] = [place.view.min(view), place.view.max(view)];
        let turn = Turn::new(views[from].direction, views[to].direction);
        let candidate = |region: usize| {
            let other = Place { view, region };
            let compared = compare(views, all, &turn, ordered(other));
            let track = partners[view][region].map(|t| &matching.tracks[t]);
            let taken = track.and_then(|t| t.regions[place.view]);
            Candidate {
                place: other,
                similarity: {
                    let [a, b] = ordered(other).map(|p| &all[p.view][p.region]);
                    turn.similarity(a, b)
                },
                cost: compared.cost,
                reason: reason(&compared, taken.map(|region| Place { region, ..place })),
            }
        };
        let mut candidates: Vec<_> = (0..all[view].len()).map(candidate).collect();
        candidates.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        candidates.truncate(CANDIDATES);
        found.push(Unmatched { place, candidates });
    }
    matching.unmatched = found;
}

fn reason(compared: &Comparison, taken: Option<Place>) -> Reason {
    match (compared.names, compared.gain(), taken) {
        (Names::Different, ..) => Reason::Names,
        (Names::Nothing, None, _) => Reason::Color,
        (_, Some(gain), Some(by)) if gain > 0.0 => Reason::Taken(by),
        _ => Reason::Cost,
    }
}
