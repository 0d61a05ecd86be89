//! Sides of a character that nobody drew.
//!
//! A character that is symmetric from the front looks from the one side like the mirror image of what it looks like from the other. So
//! a view from an angle serves the opposite angle as well, with left and right exchanged: what is seen there of a left arm is seen
//! here of the right one. From behind, each silhouette is the mirror image of that from the front; [`behind`] tells what is in it.

mod axis;
mod behind;
mod grid;
mod mirror;
mod symmetry;
#[cfg(test)]
mod tests;

use glam::DVec3;
use typed_index_collections::{TiSlice, TiVec};

use super::diagnostics;
use super::drawn::{self, DrawnView};
use super::features::OfRegion;
use super::keys;
use super::matching::{Track, TrackId};
use super::place::{Frame, TrackPosition, on_ray};
use super::region::{Direction, RegionId};
use crate::bind::Bindings;
use crate::diagnostic::Diagnostic;
use crate::geometry::bounds;
use crate::lang::keyword::Keyword;
use crate::lang::value::Value;
use crate::math;
use crate::memo::Memo;
use crate::scene::ViewId;
use behind::Backs;
pub(super) use symmetry::{Symmetry, symmetry};

/// Angles that differ by less are the same, degrees.
const SAME_ANGLE: f64 = 1e-6;

/// A view that follows from another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The mirror image of a drawn view, from the opposite angle.
    Mirrored(ViewId),
    /// The same silhouette from behind.
    Behind(ViewId),
}

/// Drawings of a character, and what is known of their regions.
pub(super) struct Drawings {
    pub(super) views: TiVec<ViewId, DrawnView>,
    pub(super) frames: TiVec<ViewId, Frame>,
    pub(super) tracks: TiVec<TrackId, Track>,
    /// Per track its feature points.
    pub(super) features: TiVec<TrackId, OfRegion>,
}

/// The views of a character, those that follow from the drawn ones included.
pub(super) struct Views {
    /// All views; the drawn ones come first.
    pub(super) drawings: Drawings,
    /// Whether gaps are to be closed (`Backing`).
    pub(super) has_backing: bool,
    /// What the views after the drawn ones are.
    pub(super) sides: Vec<Side>,
    /// Per track the one that is its mirror image, itself if it is symmetric; `None` without one. Empty if the character does not
    /// serve as its own mirror image.
    partners: TiVec<TrackId, Option<TrackId>>,
    /// Per view from behind the regions that others cover there, with those.
    covered: Vec<Vec<(RegionId, RegionId)>>,
    /// The view from the front.
    front: ViewId,
}

/// What the strings of a character's views say about mirroring it; the first one counts.
fn said(bindings: &Bindings, views: &TiSlice<ViewId, DrawnView>) -> Option<bool> {
    let mut said = views
        .iter()
        .filter_map(|view| drawn::setting(bindings, view.layer, Keyword::Mirror));
    said.next()
        .map(|value| !matches!(value, Value::Word(word) if word == "off"))
}

/// The level view from the front, or else the most level one.
fn front(views: &TiSlice<ViewId, DrawnView>) -> Option<ViewId> {
    let direction = |view: ViewId| views[view].view.direction;
    let from_front = views
        .keys()
        .filter(|view| direction(*view).theta.abs() < SAME_ANGLE);
    from_front.min_by(|a, b| {
        let [a, b] = [*a, *b].map(|view| direction(view).phi.abs());
        a.total_cmp(&b)
    })
}

/// The views of a character with all sides that follow from the drawn ones.
pub(super) fn with_sides(
    bindings: &Bindings,
    name: &str,
    drawings: Drawings,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Views {
    let said = said(bindings, &drawings.views);
    let front = front(&drawings.views);
    let says = |view: &DrawnView, keyword| drawn::setting(bindings, view.layer, keyword).is_some();
    let mut views = Views {
        has_backing: (drawings.views.iter()).any(|view| says(view, Keyword::Backing)),
        partners: TiVec::new(),
        covered: Vec::new(),
        sides: Vec::new(),
        front: front.unwrap_or(ViewId::FIRST),
        drawings,
    };
    let one_sided = views.one_sided();
    if said == Some(true) && (front.is_none() || one_sided.is_empty()) {
        let mut all = views.drawings.views.iter();
        let layer = all.find(|view| says(view, Keyword::Mirror));
        let cause = match front {
            None => "none of its views is from the front",
            Some(_) => "no side of it is drawn whose opposite is not",
        };
        let idle = |view: &DrawnView| diagnostics::idle_mirror(bindings, view.layer, name, cause);
        diagnostics.extend(layer.map(idle));
    }
    let Some(front) = front else {
        return views;
    };
    if said != Some(false) && !one_sided.is_empty() {
        let symmetry = keys::symmetry(&views.drawings.views[front].view, memo);
        if said == Some(true) || symmetry.is_symmetric {
            views.partners = symmetry::of_tracks(&symmetry, front, &views.drawings.tracks);
            views.center_on(symmetry.axis);
            for view in one_sided {
                views.add_mirrored(view);
            }
        }
    }
    if views.has_backing {
        let backs = Backs::of(&views.drawings.views[front].view);
        let backs = backs.of_tracks(front, &views.drawings.tracks);
        for (view, direction) in views.without_back() {
            views.add_behind(view, direction, &backs);
        }
    }
    views
}

impl Views {
    /// The views from the side, if all of them are from the same side.
    fn one_sided(&self) -> Vec<ViewId> {
        let theta = |view: &ViewId| self.drawings.views[*view].view.direction.theta;
        let from_side = |view: &ViewId| {
            let (sin, _) = math::sin_cos(theta(view).to_radians());
            sin.abs() > 1e-6
        };
        let views: Vec<ViewId> = self.drawings.views.keys().filter(from_side).collect();
        let left = |view: &ViewId| math::sin(theta(view).to_radians()) > 0.0;
        let first = views.first().map(left);
        if views.iter().all(|view| Some(left(view)) == first) {
            views
        } else {
            Vec::new()
        }
    }

    /// Moves the centre of the front view to the axis of symmetry, and those of the other views to the middle of what has a mirror image:
    /// a stick in one hand would move the axis about which the character turns.
    fn center_on(&mut self, axis: f64) {
        let Drawings {
            views,
            frames,
            tracks,
            ..
        } = &mut self.drawings;
        for (view, frame) in frames.iter_mut_enumerated() {
            let pairs = tracks.iter().zip(&self.partners);
            let symmetric = pairs.filter(|(_, partner)| partner.is_some());
            let boxes = symmetric.filter_map(|(track, _)| {
                let region = &views[view].view.regions[track.regions[view]?];
                bounds(&region.outline)
            });
            let around = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
            let middle = around.map(|(low, high)| (low.x + high.x) / 2.0);
            frame.center.x = match middle {
                _ if view == self.front => axis,
                Some(middle) => middle,
                None => frame.center.x,
            };
        }
    }

    fn add(&mut self, side: Side, view: DrawnView, of: ViewId) -> ViewId {
        self.sides.push(side);
        self.drawings.frames.push(self.drawings.frames[of]);
        for features in &mut self.drawings.features {
            let own = features[of].clone();
            features.push(own);
        }
        self.drawings.views.push_and_get_key(view)
    }

    /// Places the tracks in the views that were added, after those of the drawn views. `rooms` are those that tracks need.
    pub(super) fn place(
        &self,
        placed: &mut TiSlice<TrackId, TrackPosition>,
        rooms: &TiSlice<TrackId, f64>,
    ) {
        let drawn = self.drawings.views.len() - self.sides.len();
        let mut covered = self.covered.iter();
        for (index, side) in self.sides.iter().enumerate() {
            let view = ViewId::from(drawn + index);
            match side {
                Side::Mirrored(of) => self.place_mirrored(view, *of, placed),
                Side::Behind(of) => {
                    let covered = covered.next().map_or(&[][..], Vec::as_slice);
                    self.place_behind(view, *of, placed, rooms, covered);
                }
            }
        }
    }

    fn place_mirrored(
        &self,
        view: ViewId,
        of: ViewId,
        placed: &mut TiSlice<TrackId, TrackPosition>,
    ) {
        let Drawings {
            views,
            frames,
            tracks,
            ..
        } = &self.drawings;
        let mirrored = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
        let direction = views[view].view.direction;
        let place = |(track, partner): (TrackId, &Option<TrackId>)| {
            if let Some(partner) = partner {
                let partner = &placed[*partner];
                return (mirrored(partner.in_views[of]), partner.depths[of]);
            }
            // As far in front of what it lies on as from the front.
            let own = placed[track].in_views[self.front];
            let region = tracks[track].regions[view];
            let carried = region.and_then(|id| {
                let region = &views[view].view.regions[id];
                let (low, high) = bounds(&region.outline)?;
                let at = frames[view].on_screen((low + high) / 2.0);
                let outer = tracks.position(|track| track.regions[view] == region.container)?;
                let before = self.partners[outer].map(|outer| placed[outer].depths[of])?;
                let in_front = placed[track].depths[self.front] - placed[outer].depths[self.front];
                let depth = before + in_front;
                Some((on_ray(direction, at, depth), depth))
            });
            carried.unwrap_or((own, own.dot(direction.axes()[2])))
        };
        let places: Vec<_> = self.partners.iter_enumerated().map(place).collect();
        for (placed, (place, depth)) in placed.iter_mut().zip(places) {
            placed.in_views.push(place);
            placed.depths.push(depth);
        }
    }
}

/// A direction's opposite, the turn between −180 and 180.
fn opposite(direction: Direction) -> Direction {
    Direction {
        theta: within_half_turn(direction.theta + 180.0),
        // No minus zero.
        phi: 0.0 - direction.phi,
    }
}

/// An angle above −180 and up to 180, degrees.
fn within_half_turn(degrees: f64) -> f64 {
    180.0 - (180.0 - degrees).rem_euclid(360.0)
}
