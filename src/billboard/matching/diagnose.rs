//! What to say about a matching: regions without a partner, and views that contradict each other.

use typed_index_collections::{TiSlice, TiVec};

use super::cost::Turn;
use super::{
    Candidate, Comparison, FeaturesOfViews, Known, Matching, Names, Pair, Reason, RegionId,
    RegionInView, TrackId, Unmatched, ViewId, Warning, compare, nearest,
};
use crate::billboard::place::{angle, nearest_to_rays};
use crate::billboard::region::View;

/// Views closer than this give uncertain depths, degrees.
const SMALL_ANGLE: f64 = 15.0;
/// Differences in depth below this say nothing, heights.
const LEAST_DEPTH: f64 = 0.01;
/// A wrong sign is suspected from so many details that have a depth, if two thirds of them are behind what they are drawn on.
const LEAST_DETAILS: usize = 3;
/// Candidates named for a region without a partner.
const CANDIDATES: usize = 3;

/// Looks at the pairs of two views that were matched just now.
pub(super) fn step(
    views: &TiSlice<ViewId, View>,
    all: &FeaturesOfViews,
    pair: [ViewId; 2],
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
    let depth_of = |regions: [RegionId; 2]| {
        let at = [0, 1].map(|i| all[pair[i]][regions[i]].at);
        nearest_to_rays(&[(a, at[0]), (b, at[1])]).map(|p| p.dot(toward) / toward.length())
    };
    // The partner of each region of the first view.
    let mut partners: TiVec<RegionId, Option<RegionId>> = vec![None; all[pair[0]].len()].into();
    for pair in matching.pairs.iter().filter(of_views) {
        partners[pair.first.id] = Some(pair.second.id);
    }
    let (mut behind, mut of) = (0, 0);
    for (inner, partner) in partners.iter_enumerated() {
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
    if of >= LEAST_DETAILS && 3 * behind >= 2 * of {
        matching.warnings.push(Warning::BehindContainers {
            views: pair,
            behind,
            of,
        });
    }
}

/// Lists the regions that are alone, with those that fit them best.
pub(super) fn unmatched(known: Known<'_>, matching: &mut Matching) {
    let Known { views, all, owners } = known;
    let mut partners: TiVec<ViewId, TiVec<RegionId, Option<TrackId>>> = all
        .iter()
        .map(|regions| vec![None; regions.len()].into())
        .collect();
    for (i, track) in matching.tracks.iter_enumerated() {
        for (view, region) in track.regions.iter_enumerated() {
            if let Some(region) = region {
                partners[view][*region] = Some(i);
            }
        }
    }
    let mut found = Vec::new();
    for track in &matching.tracks {
        let seen = track.regions.iter_enumerated();
        let mut seen = seen.filter_map(|(view, id)| Some(RegionInView { view, id: (*id)? }));
        let (Some(region), None) = (seen.next(), seen.next()) else {
            continue;
        };
        let others: Vec<_> = views.keys().filter(|v| *v != region.view).collect();
        let Some(view) = nearest(views, region.view, &others) else {
            continue;
        };
        // The same direction of comparison as in the matching, where the earlier view predicts the later one.
        let ordered = |other: RegionInView| {
            if region.view < view {
                [region, other]
            } else {
                [other, region]
            }
        };
        let [from, to] = [region.view.min(view), region.view.max(view)];
        let turn = Turn::new(views[from].direction, views[to].direction);
        let candidate = |id: RegionId| {
            let other = RegionInView { view, id };
            let of = [region, other].map(|at| {
                let owner = owners[at.view][at.id];
                owner.map(|owner| partners[at.view][owner])
            });
            let compared = compare(known, &turn, ordered(other), of[0] == of[1]);
            let track = partners[view][id].map(|t| &matching.tracks[t]);
            let taken = track.and_then(|t| t.regions[region.view]);
            Candidate {
                region: other,
                similarity: {
                    let [a, b] = ordered(other).map(|r| &all[r.view][r.id]);
                    turn.similarity(a, b)
                },
                cost: compared.cost,
                reason: reason(&compared, taken.map(|id| RegionInView { id, ..region })),
            }
        };
        let mut candidates: Vec<_> = all[view].keys().map(candidate).collect();
        candidates.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        candidates.truncate(CANDIDATES);
        found.push(Unmatched { region, candidates });
    }
    matching.unmatched = found;
}

fn reason(compared: &Comparison, taken: Option<RegionInView>) -> Reason {
    match (compared.names, compared.gain(), taken) {
        (Names::Different, ..) => Reason::Names,
        (Names::Nothing, None, _) if !compared.colors_fit => Reason::Color,
        (Names::Nothing, None, _) if !compared.kinds_fit => Reason::Line,
        (Names::Nothing, None, _) => Reason::OtherRegion,
        (_, Some(gain), Some(by)) if gain > 0.0 => Reason::Taken(by),
        _ => Reason::Cost,
    }
}
