//! Which regions of a character's views show the same thing.
//!
//! Source: Kitamura, *Modeling and Animation of Pseudo-3D Objects*, section 4.2.3, for the similarity; the one-to-one assignment
//! is our own.

pub(super) mod by_similarity;
mod cost;
mod diagnose;
mod exchange;
mod gains;
mod strokes;
#[cfg(test)]
mod tests;

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use cost::{Features, Turn, features, may_match};
use exchange::{Sides, exchange};
use gains::Gains;

use super::place::{Frame, angle};
use super::region::{RegionId, View};
use crate::index::index_type;
use crate::scene::ViewId;

index_type!(
    /// Counts what is one thing in space: the tracks of a character, and its regions over all views.
    pub TrackId
);

/// Regions of all views, matched.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Matching {
    /// What is one thing in space. Every region of every view is in exactly one track. Those of the first view come first, in its
    /// order.
    pub tracks: TiVec<TrackId, Track>,
    /// The pairs that made the tracks, view by view.
    pub pairs: Vec<Pair>,
    /// Regions that are alone in their track.
    pub unmatched: Vec<Unmatched>,
    /// What looks wrong.
    pub warnings: Vec<Warning>,
}

/// One thing in space.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Track {
    /// Its region in each view; `None` where it is hidden.
    pub regions: TiVec<ViewId, Option<RegionId>>,
}

/// Two regions that show the same thing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// The region of the view that was matched first.
    pub first: RegionInView,
    /// The region of the view that was matched with it.
    pub second: RegionInView,
    /// The similarity of equation 4.1, from 0 to 1.
    pub similarity: f64,
    /// Our cost: 0 for a perfect pair; pairs above 3.5 are only made by names.
    pub cost: f64,
}

/// One region of one view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RegionInView {
    /// The view.
    pub view: ViewId,
    /// The region in the view.
    pub id: RegionId,
}

/// A region without a partner.
#[derive(Debug, Clone, PartialEq)]
pub struct Unmatched {
    /// The region.
    pub region: RegionInView,
    /// The regions of the view compared with it that fit best, at most three, the best first.
    pub candidates: Vec<Candidate>,
}

/// A region that might have been the partner of another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The region.
    pub region: RegionInView,
    /// The similarity of equation 4.1, from 0 to 1.
    pub similarity: f64,
    /// Our cost.
    pub cost: f64,
    /// Why the two are not a pair.
    pub reason: Reason,
}

/// Why two regions are not a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// Their colours differ by more than 0.3.
    Color,
    /// Only one of them is a line.
    Line,
    /// Both are lines, of regions that are not the same.
    OtherRegion,
    /// They have different names.
    Names,
    /// They are less alike than two regions may be.
    Cost,
    /// The candidate fits this region of the other's view better, or the whole does.
    Taken(RegionInView),
}

/// Something about the views as a whole that looks wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Warning {
    /// The directions of two views that were matched are less than 15° apart, so that depths are uncertain.
    SmallAngle {
        /// The views.
        views: [ViewId; 2],
        /// The angle between them, degrees.
        degrees: f64,
    },
    /// Most contained regions come to lie behind their containers: the sign of `theta` or `phi` may be wrong.
    BehindContainers {
        /// The views.
        views: [ViewId; 2],
        /// Contained regions behind their containers.
        behind: usize,
        /// Contained regions that were looked at.
        of: usize,
    },
}

/// How regions find their partners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Method {
    /// All pairs together cost the least.
    Whole,
    /// Each region has the most similar one, by equations 4.1 and 4.2; the most similar of those that want one keeps it.
    Thesis,
}

/// Matches the regions of all views one to one.
///
/// `frames` are those of the views, in the same order. Views are added one by one, the nearest first, and each is matched with
/// what is known already, seen from the nearest view that shows it. Regions with the same name are a pair, whatever they look
/// like, and regions with different names are none. A stroke pairs with one of the partner of its region.
pub(super) fn match_regions(
    views: &TiSlice<ViewId, View>,
    frames: &TiSlice<ViewId, Frame>,
) -> Matching {
    match_by(Method::Whole, views, frames)
}

/// [`match_regions`], or by the other method.
pub(super) fn match_by(
    method: Method,
    views: &TiSlice<ViewId, View>,
    frames: &TiSlice<ViewId, Frame>,
) -> Matching {
    let all = views.iter().zip(frames);
    let all: TiVec<ViewId, TiVec<RegionId, Features>> =
        all.map(|(view, frame)| features(view, frame)).collect();
    let views = &views[..all.next_key()];
    let owners: TiVec<ViewId, _> = views.iter().map(strokes::owners).collect();
    let mut matching = Matching::default();
    let mut added: Vec<ViewId> = Vec::new();
    while let Some((next, nearest)) = next_view(views, &added) {
        let tracks = matching.tracks.len();
        if let Some(nearest) = nearest {
            let known = Known {
                views,
                all: &all,
                owners: &owners,
            };
            Step::new(known, next, &added, &matching.tracks).run(method, &mut matching);
            diagnose::step(views, &all, [nearest, next], &mut matching);
        }
        let known = matching.tracks.iter().take(tracks);
        let mut is_new: TiVec<RegionId, bool> = vec![true; all[next].len()].into();
        for region in known.filter_map(|t| t.regions[next]) {
            is_new[region] = false;
        }
        for region in is_new.keys().filter(|r| is_new[*r]) {
            let mut regions = TiVec::from(vec![None; views.len()]);
            regions[next] = Some(region);
            matching.tracks.push(Track { regions });
        }
        added.push(next);
    }
    let known = Known {
        views,
        all: &all,
        owners: &owners,
    };
    diagnose::unmatched(known, &mut matching);
    matching
}

/// The view to add, and the nearest view that has been added; `None` once all are added.
fn next_view(views: &TiSlice<ViewId, View>, added: &[ViewId]) -> Option<(ViewId, Option<ViewId>)> {
    if added.is_empty() {
        return views.first_key().map(|first| (first, None));
    }
    let rest = views.keys().filter(|v| !added.contains(v));
    let near = rest.filter_map(|v| Some((v, nearest(views, v, added)?)));
    near.min_by(|a, b| {
        let degrees = |(v, n): (ViewId, ViewId)| angle(views[v].direction, views[n].direction);
        degrees(*a).total_cmp(&degrees(*b))
    })
    .map(|(v, n)| (v, Some(n)))
}

/// The view of some that is nearest to a view, the first of equals.
fn nearest(views: &TiSlice<ViewId, View>, view: ViewId, of: &[ViewId]) -> Option<ViewId> {
    let degrees = |v: ViewId| angle(views[view].direction, views[v].direction);
    let by_angle = |a: &ViewId, b: &ViewId| degrees(*a).total_cmp(&degrees(*b));
    of.iter().copied().min_by(by_angle)
}

/// What is compared of the regions of each view.
type FeaturesOfViews = TiSlice<ViewId, TiVec<RegionId, Features>>;

/// All views, and what is known of their regions.
#[derive(Clone, Copy)]
struct Known<'a> {
    views: &'a TiSlice<ViewId, View>,
    all: &'a FeaturesOfViews,
    /// Per stroke the region that it belongs to.
    owners: &'a TiSlice<ViewId, TiVec<RegionId, Option<RegionId>>>,
}

/// Which strokes can be pairs.
#[derive(Clone, Copy)]
enum Strokes<'a> {
    /// All.
    Any,
    /// Those that belong to no region.
    Free,
    /// Those of regions that are pairs, too: per row the column that is its partner.
    Of(&'a [Option<usize>]),
}

/// One view that is matched with what is known already.
struct Step<'a> {
    known: Known<'a>,
    view: ViewId,
    /// The track and the region that stands for it.
    rows: Vec<(TrackId, RegionInView)>,
    /// Per row of a stroke, the row of the region to which it belongs.
    rows_of_owners: Vec<Option<usize>>,
}

impl<'a> Step<'a> {
    fn new(
        known: Known<'a>,
        view: ViewId,
        added: &[ViewId],
        tracks: &TiSlice<TrackId, Track>,
    ) -> Self {
        let row = |(i, track): (TrackId, &Track)| {
            let seen = added.iter().copied();
            let seen: Vec<_> = seen.filter(|v| track.regions[*v].is_some()).collect();
            let from = nearest(known.views, view, &seen)?;
            let region = track.regions[from]?;
            Some((
                i,
                RegionInView {
                    view: from,
                    id: region,
                },
            ))
        };
        let rows: Vec<(TrackId, RegionInView)> = tracks.iter_enumerated().filter_map(row).collect();
        let row_of_owner = |(_, at): &(TrackId, RegionInView)| {
            let owner = known.owners[at.view][at.id]?;
            let track = tracks.position(|track| track.regions[at.view] == Some(owner))?;
            rows.iter().position(|(other, _)| *other == track)
        };
        Self {
            rows_of_owners: rows.iter().map(row_of_owner).collect(),
            known,
            view,
            rows,
        }
    }

    fn run(&self, method: Method, matching: &mut Matching) {
        let Known { views, all, .. } = self.known;
        let known = &all[self.view];
        let turn = |v: &View| Turn::new(v.direction, views[self.view].direction);
        let mut turns: TiVec<ViewId, _> = views.iter().map(turn).collect();
        if method == Method::Thesis {
            let compared = self.compared(&turns, Strokes::Any);
            let partners = self.most_similar(&turns, &compared);
            self.add_pairs(&partners, &turns, &compared, matching);
            return;
        }
        let rough = self.gains(&self.compared(&turns, Strokes::Any)).assign();
        for (view, turn) in turns.iter_mut_enumerated() {
            let of_view = |(row, _): &(&(TrackId, RegionInView), _)| row.1.view == view;
            let pairs = self.rows.iter().zip(&rough).filter(of_view);
            let pairs = pairs
                .filter_map(|(row, p)| Some((self.features(row), &known[RegionId::from((*p)?)])));
            turn.shift_by(&pairs.collect::<Vec<_>>());
        }
        let at = |row: &(TrackId, RegionInView)| {
            (row.1.view, turns[row.1.view].predicted(self.features(row)))
        };
        let rows: Vec<_> = self.rows.iter().map(at).collect();
        let columns: Vec<DVec2> = known.iter().map(|f| f.at).collect();
        let paired = |compared: &[Comparison], fixed: &[Option<usize>]| {
            let gains = self.gains(compared);
            let mut partners = gains.without(fixed).assign();
            for (partner, fixed) in partners.iter_mut().zip(fixed) {
                *partner = partner.or(*fixed);
            }
            let sides = Sides {
                gains: &gains,
                rows: &rows,
                columns: &columns,
            };
            exchange(&sides, &mut partners);
            partners
        };
        let mut compared = self.compared(&turns, Strokes::Free);
        let mut partners = paired(&compared, &[]);
        if self.known.owners.iter().flatten().any(Option::is_some) {
            compared = self.compared(&turns, Strokes::Of(&partners));
            partners = paired(&compared, &partners);
        }
        self.add_pairs(&partners, &turns, &compared, matching);
    }

    /// The partner of each row by similarity; of those with the same name, that one.
    fn most_similar(
        &self,
        turns: &TiSlice<ViewId, Turn>,
        compared: &[Comparison],
    ) -> Vec<Option<usize>> {
        let known = &self.known.all[self.view];
        let similarity = |row: usize, column: usize| {
            let region = &self.rows[row];
            match compared[row * known.len() + column].names {
                Names::Same => by_similarity::NAMED,
                Names::Different => 0.0,
                Names::Nothing => turns[region.1.view]
                    .similarity(self.features(region), &known[RegionId::from(column)]),
            }
        };
        by_similarity::kept(self.rows.len(), known.len(), similarity)
    }

    fn add_pairs(
        &self,
        partners: &[Option<usize>],
        turns: &TiSlice<ViewId, Turn>,
        compared: &[Comparison],
        matching: &mut Matching,
    ) {
        let known = &self.known.all[self.view];
        for (row, partner) in partners.iter().enumerate() {
            let (Some(column), (track, first)) = (*partner, self.rows[row]) else {
                continue;
            };
            let compared = &compared[row * known.len() + column];
            let id = RegionId::from(column);
            matching.tracks[track].regions[self.view] = Some(id);
            matching.pairs.push(Pair {
                first,
                second: RegionInView {
                    view: self.view,
                    id,
                },
                similarity: turns[first.view]
                    .similarity(self.features(&self.rows[row]), &known[id]),
                cost: compared.cost,
            });
        }
    }

    fn features(&self, row: &(TrackId, RegionInView)) -> &Features {
        &self.known.all[row.1.view][row.1.id]
    }

    /// All rows with all regions of the view, row by row.
    fn compared(&self, turns: &TiSlice<ViewId, Turn>, strokes: Strokes<'_>) -> Vec<Comparison> {
        let row = |((_, first), row_of_owner): (&(TrackId, RegionInView), &Option<usize>)| {
            let (first, turn, row_of_owner) = (*first, &turns[first.view], *row_of_owner);
            self.known.all[self.view].keys().map(move |id| {
                let second = RegionInView {
                    view: self.view,
                    id,
                };
                let owners = [first, second].map(|at| self.known.owners[at.view][at.id]);
                let owners_fit = match (strokes, owners) {
                    (Strokes::Any, _) | (_, [None, None]) => true,
                    (Strokes::Of(partners), [Some(_), Some(owner)]) => {
                        let partner = row_of_owner.and_then(|row| partners[row]);
                        partner.map(RegionId::from) == Some(owner)
                    }
                    _ => false,
                };
                compare(self.known, turn, [first, second], owners_fit)
            })
        };
        self.rows
            .iter()
            .zip(&self.rows_of_owners)
            .flat_map(row)
            .collect()
    }

    fn gains(&self, compared: &[Comparison]) -> Gains {
        Gains {
            rows: self.rows.len(),
            columns: self.known.all[self.view].len(),
            values: compared.iter().map(Comparison::gain).collect(),
        }
    }
}

/// Two regions of two views, compared.
#[derive(Debug, Clone, Copy)]
struct Comparison {
    cost: f64,
    names: Names,
    /// J of equation 4.2.
    colors_fit: bool,
    /// Whether both are lines, or neither is.
    kinds_fit: bool,
    /// Whether the regions are the same to which they belong, if they are lines.
    owners_fit: bool,
}

/// What the names of two regions say.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Names {
    Same,
    Different,
    /// At least one has none.
    Nothing,
}

impl Comparison {
    fn gain(&self) -> Option<f64> {
        match self.names {
            Names::Same => Some(Gains::of_named(self.cost)),
            Names::Different => None,
            Names::Nothing => {
                let fit = self.colors_fit && self.kinds_fit && self.owners_fit;
                fit.then(|| Gains::of(self.cost))
            }
        }
    }
}

fn compare(known: Known<'_>, turn: &Turn, pair: [RegionInView; 2], owners_fit: bool) -> Comparison {
    let [a, b] = pair.map(|r| &known.all[r.view][r.id]);
    let [name_a, name_b] = pair.map(|r| &known.views[r.view].regions[r.id].name);
    Comparison {
        cost: turn.cost(a, b),
        names: match (name_a, name_b) {
            (Some(a), Some(b)) if a == b => Names::Same,
            (Some(_), Some(_)) => Names::Different,
            _ => Names::Nothing,
        },
        colors_fit: may_match(a, b),
        kinds_fit: a.is_line == b.is_line,
        owners_fit,
    }
}
