//! What is seen from behind: the silhouettes of the views, with what its borders have.
//!
//! A drawing says what is in front. From behind, what one region frames from above and on both sides, as hair does a face, is under
//! that region; small things within others are not seen; all else goes round. This is decided once, in the view from the front.

use std::sync::Arc;

use typed_index_collections::{TiSlice, TiVec};

use super::grid::{Grid, OPAQUE, is_alike};
use super::{Side, Views, mirror, opposite, within_half_turn};
use crate::billboard::matching::{Track, TrackId};
use crate::billboard::place::{Frame, TrackPosition, angle};
use crate::billboard::region::{Direction, RegionId, View};
use crate::billboard::turn;
use crate::geometry::{Outline, area, offset, union};
use crate::math;
use crate::scene::ViewId;

/// What is within others and covers a smaller share of the silhouette is a detail.
const DETAIL: f64 = 0.04;
/// The share of a region's upper rows, and of its columns, in which what frames it is beside and above it, at least.
const BESIDE: f64 = 0.5;
const ABOVE: f64 = 0.5;
/// Views that show the character from behind have a smaller cosine of their angle around.
const FROM_BEHIND: f64 = -0.1;
/// Silhouettes of views with a smaller cosine are not those of a back: from the side, both sides look alike.
const FROM_FRONT: f64 = 0.49;
/// How far beside the straight way from behind a silhouette is seen, to both sides, if the character could not turn all around otherwise,
/// degrees.
const ASIDE: f64 = 2.0;
/// A view that is nearer than this to another one, degrees, adds nothing to it.
const NEAR: f64 = 20.0;
/// How far the border of what is covered stays behind that which covers it, heights.
const INSET: f64 = 0.01;
/// How far apart regions are in depth, heights.
const GAP: f64 = 0.002;

/// What becomes of a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Back<Id> {
    /// It is seen from behind, too.
    Own,
    /// Another region covers it.
    Under(Id),
    /// It is not seen.
    Hidden,
}

/// What becomes of the regions of a view from the front.
pub(super) struct Backs(pub(super) TiVec<RegionId, Back<RegionId>>);

/// What is around the cells in which a region is seen.
#[derive(Debug, Default, Clone)]
struct Around {
    cells: usize,
    /// Per row with such cells, what is left of the first and right of the last.
    beside: Vec<[Option<RegionId>; 2]>,
    /// What is above the topmost cell of each column.
    above: Vec<Option<RegionId>>,
    /// All neighbours.
    neighbors: Vec<Option<RegionId>>,
}

impl Backs {
    pub(super) fn of(view: &View) -> Self {
        let count = view.regions.len();
        let Some(grid) = Grid::new(view) else {
            return Self(vec![Back::Own; count].into());
        };
        let around = around(&grid, count);
        let silhouette = grid.cells() as f64;
        let back = |id: RegionId| {
            let (region, around) = (&view.regions[id], &around[id]);
            if region.is_line || region.color[3] < OPAQUE {
                return match region.container {
                    Some(_) => Back::Hidden,
                    None => Back::Own,
                };
            }
            if around.cells == 0 {
                return Back::Own;
            }
            let is_inside = around.neighbors.iter().all(Option::is_some);
            if is_inside && (around.cells as f64) < DETAIL * silhouette {
                return match region.container {
                    Some(_) => Back::Hidden,
                    None => most(around.neighbors.iter().copied()).map_or(Back::Own, Back::Under),
                };
            }
            framed_by(view, around).map_or(Back::Own, Back::Under)
        };
        let mut backs: TiVec<RegionId, _> = view.regions.keys().map(back).collect();
        // What covers a region may be covered, too; what is hidden covers nothing.
        for id in backs.keys() {
            let mut steps = 0;
            while let Back::Under(cover) = backs[id] {
                match backs[cover] {
                    Back::Under(next) if next != id && steps < count => {
                        backs[id] = Back::Under(next)
                    }
                    Back::Own => break,
                    _ => backs[id] = Back::Own,
                }
                steps += 1;
            }
        }
        Self(backs)
    }

    /// What becomes of tracks. What the view from the front does not show is a detail if it lies on something.
    pub(super) fn of_tracks(
        &self,
        front: ViewId,
        tracks: &TiSlice<TrackId, Track>,
    ) -> BacksOfTracks {
        let mut track_of: TiVec<RegionId, Option<TrackId>> = vec![None; self.0.len()].into();
        for (index, track) in tracks.iter_enumerated() {
            if let Some(region) = track.regions[front] {
                track_of[region] = Some(index);
            }
        }
        let back = |track: &Track| {
            Some(match self.0[track.regions[front]?] {
                Back::Own => Back::Own,
                Back::Hidden => Back::Hidden,
                Back::Under(cover) => track_of[cover].map_or(Back::Own, Back::Under),
            })
        };
        BacksOfTracks(tracks.iter().map(back).collect())
    }
}

/// Per track what becomes of it; `None` if the view from the front does not show it.
pub(super) struct BacksOfTracks(TiVec<TrackId, Option<Back<TrackId>>>);

fn around(grid: &Grid, count: usize) -> TiVec<RegionId, Around> {
    let mut around: TiVec<RegionId, Around> = vec![Around::default(); count].into();
    let mut is_topped: TiVec<RegionId, usize> = vec![usize::MAX; count].into();
    for row in 0..grid.rows() {
        let mut ends: Vec<(RegionId, [usize; 2])> = Vec::new();
        for column in 0..grid.columns() {
            let (x, y) = (column as isize, row as isize);
            let Some(id) = grid.at(x, y) else { continue };
            around[id].cells += 1;
            for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1)] {
                let other = grid.at(x + dx, y + dy);
                if other != Some(id) {
                    around[id].neighbors.push(other);
                }
            }
            match ends.iter_mut().find(|(other, _)| *other == id) {
                Some((_, ends)) => ends[1] = column,
                None => ends.push((id, [column; 2])),
            }
        }
        for (id, [first, last]) in ends {
            let y = row as isize;
            let beside = [
                grid.at(first as isize - 1, y),
                grid.at(last as isize + 1, y),
            ];
            around[id].beside.push(beside);
        }
    }
    for column in 0..grid.columns() {
        for row in 0..grid.rows() {
            let (x, y) = (column as isize, row as isize);
            let Some(id) = grid.at(x, y) else { continue };
            if is_topped[id] != column {
                is_topped[id] = column;
                around[id].above.push(grid.at(x, y - 1));
            }
        }
    }
    around
}

/// The one that occurs most, and the first of equals.
fn most(all: impl Iterator<Item = Option<RegionId>>) -> Option<RegionId> {
    let mut counts: Vec<(RegionId, usize)> = Vec::new();
    for id in all.flatten() {
        match counts.iter_mut().find(|(other, _)| *other == id) {
            Some((_, count)) => *count += 1,
            None => counts.push((id, 1)),
        }
    }
    counts
        .into_iter()
        .reduce(|best, next| if next.1 > best.1 { next } else { best })
        .map(|(id, _)| id)
}

/// The region that is on both sides of the upper half of another one, and above it.
fn framed_by(view: &View, around: &Around) -> Option<RegionId> {
    let upper = &around.beside[..around.beside.len().div_ceil(2)];
    let both = |[left, right]: &[Option<RegionId>; 2]| left.filter(|_| left == right);
    let frame = most(upper.iter().map(both))?;
    let beside = upper
        .iter()
        .filter(|ends| both(ends) == Some(frame))
        .count();
    let color = view.regions[frame].color;
    let above = around
        .above
        .iter()
        .flatten()
        .filter(|id| is_alike(color, view.regions[**id].color))
        .count();
    let is_frame = beside as f64 >= BESIDE * upper.len() as f64
        && above as f64 >= ABOVE * around.above.len() as f64;
    is_frame.then_some(frame)
}

impl Views {
    /// The views whose silhouettes are seen from behind, and from where: in directions that no view shows.
    pub(super) fn without_back(&self) -> Vec<(ViewId, Direction)> {
        let cosine =
            |view: &ViewId| math::cos(self.drawings.views[*view].view.direction.theta.to_radians());
        let mut drawn = self
            .drawings
            .views
            .keys()
            .take(self.drawings.views.len() - self.sides.len());
        if drawn.any(|view| cosine(&view) < FROM_BEHIND) {
            return Vec::new();
        }
        let is_free = |view: &ViewId| {
            let behind = opposite(self.drawings.views[*view].view.direction);
            let mut views = self.drawings.views.iter();
            views.all(|other| angle(other.view.direction, behind) >= NEAR)
        };
        let from_front = self
            .drawings
            .views
            .keys()
            .filter(|view| cosine(view) >= FROM_FRONT);
        let direction = |view: ViewId| self.drawings.views[view].view.direction;
        let from_front: Vec<ViewId> = from_front.filter(is_free).collect();
        let behind = from_front.iter().map(|view| opposite(direction(*view)));
        let all = (self.drawings.views.keys().map(direction)).chain(behind);
        let all: Vec<f64> = all.map(|direction| direction.theta).collect();
        let goes_around = turn::goes_around(all.into_iter());
        let from = |view: ViewId| {
            let straight = opposite(direction(view));
            // Half a turn from one view to the other goes one way only.
            let ways = if goes_around {
                vec![0.0]
            } else {
                vec![ASIDE, -ASIDE]
            };
            ways.into_iter().map(move |aside| {
                let theta = within_half_turn(straight.theta + aside);
                (view, Direction { theta, ..straight })
            })
        };
        from_front.iter().flat_map(|view| from(*view)).collect()
    }

    /// Adds what is seen from behind of a view's silhouette.
    pub(super) fn add_behind(&mut self, of: ViewId, direction: Direction, backs: &BacksOfTracks) {
        let Frame { center, height } = self.drawings.frames[of];
        let own = &self.drawings.views[of];
        let mut view = mirror::drawn_view(own, center.x, direction);
        let mut regions: TiVec<TrackId, Option<RegionId>> = self
            .drawings
            .tracks
            .iter()
            .map(|track| track.regions[of])
            .collect();
        let mut covered: Vec<(RegionId, RegionId)> = Vec::new();
        for track in self.drawings.tracks.keys() {
            let Some(region) = regions[track] else {
                continue;
            };
            let is_on_another = view.view.regions[region].container.is_some();
            match backs.0[track] {
                Some(Back::Own) => {}
                None if !is_on_another => {}
                None | Some(Back::Hidden) => regions[track] = None,
                Some(Back::Under(cover)) => {
                    let cover = self.drawings.tracks[cover].regions[of];
                    covered.extend(cover.map(|cover| (region, cover)));
                }
            }
        }
        for (region, cover) in &covered {
            let [own, of_cover] = [region, cover].map(|id| &view.view.regions[*id]);
            let outlines = [own, of_cover].map(|region| Outline::clone(&region.outline));
            let color = of_cover.color;
            view.view.regions[*cover].outline = Arc::new(union(&outlines));
            let inner = offset(&outlines[0], -INSET * height);
            let drawn = &mut view.drawn[*region];
            if region < cover && area(&inner) > 0.0 {
                // What is painted under its cover, as a face under hair, goes out of sight behind it, and keeps its paint until then.
                view.view.regions[*region].outline = Arc::new(inner);
            } else {
                view.view.regions[*region].color = color;
                drawn.part = None;
            }
            (drawn.line, drawn.open_line) = (None, None);
        }
        self.add(Side::Behind(of), view, of);
        let added = regions.into_iter();
        for (track, region) in self.drawings.tracks.iter_mut().zip(added) {
            track.regions.push(region);
        }
        self.covered.push(covered);
    }

    /// Places what is seen from behind in the order of its view, so that clothes stay on bodies; what is covered comes before that
    /// which covers it.
    pub(super) fn place_behind(
        &self,
        view: ViewId,
        of: ViewId,
        placed: &mut TiSlice<TrackId, TrackPosition>,
        rooms: &TiSlice<TrackId, f64>,
        covered: &[(RegionId, RegionId)],
    ) {
        let depth_of = |region: RegionId| {
            let track = self
                .drawings
                .tracks
                .position(|track| track.regions[view] == Some(region));
            track.map(|track| placed[track].depths[of])
        };
        let key = |track: TrackId| {
            let own = placed[track].depths[of];
            let cover = self.drawings.tracks[track].regions[view].and_then(|region| {
                let mut covers = covered.iter();
                covers.find(|(other, _)| *other == region)
            });
            match cover.and_then(|(_, cover)| depth_of(*cover)) {
                Some(depth) => (depth.min(own), 0),
                None => (own, 1),
            }
        };
        let mut order: Vec<((f64, u8), TrackId)> =
            placed.keys().map(|track| (key(track), track)).collect();
        order.sort_by(|(a, i), (b, j)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(i.cmp(j)));
        let mut depth = 0.0;
        let mut depths: TiVec<TrackId, f64> = vec![0.0; placed.len()].into();
        for (_, track) in &order {
            depths[*track] = depth;
            depth += GAP + rooms.get(*track).copied().unwrap_or_default();
        }
        let towards = self.drawings.views[view].view.direction.axes()[2];
        for (track, placed) in placed.iter_mut_enumerated() {
            let own = placed.in_views[of];
            let depth = depths[track] - depth / 2.0;
            let place = own + towards * (depth - own.dot(towards));
            placed.in_views.push(place);
            placed.depths.push(depth);
        }
    }
}
