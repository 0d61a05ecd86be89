//! Mirror images of views.
//!
//! A thing on one side only, such as a badge or a stick, stays on its side: it is not mirrored.

use std::sync::Arc;

use glam::DVec2;

use super::{Drawings, Side, Views};
use crate::billboard::drawn::{Drawn, DrawnView, OpenLine};
use crate::billboard::matching::{Track, TrackId};
use crate::billboard::paints::is_same_color;
use crate::billboard::place::{nearest_to_rays, on_ray};
use crate::billboard::region::{Direction, Region, RegionId, View};
use crate::geometry::{Outline, bounds};
use crate::scene::ViewId;

/// How far from the mirror image of a feature point its partner may be, heights.
const NEAR: f64 = 0.05;

/// A point's image about an upright line.
fn image(axis: f64, point: DVec2) -> DVec2 {
    DVec2::new(2.0 * axis - point.x, point.y)
}

/// The image of an outline. Its rings run in the same directions.
pub(super) fn outline(outline: &Outline, axis: f64) -> Outline {
    outline.map_rings(|ring| ring.iter().rev().map(|point| image(axis, *point)).collect())
}

/// The image of a view about an upright line, seen from a direction.
pub(super) fn view(of: &View, axis: f64, direction: Direction) -> View {
    let region = |region: &Region| Region {
        outline: Arc::new(outline(&region.outline, axis)),
        ..region.clone()
    };
    View {
        direction,
        regions: of.regions.iter().map(region).collect(),
    }
}

/// The same with what the drawing says of its regions.
pub(super) fn drawn_view(of: &DrawnView, axis: f64, direction: Direction) -> DrawnView {
    let drawn = |drawn: &Drawn| Drawn {
        open_line: drawn.open_line.as_ref().map(|line| OpenLine {
            width: line.width,
            points: line
                .points
                .iter()
                .map(|point| image(axis, *point))
                .collect(),
        }),
        ..drawn.clone()
    };
    DrawnView {
        layer: of.layer,
        view: view(&of.view, axis, direction),
        drawn: of.drawn.iter().map(drawn).collect(),
        features: Vec::new(),
        is_shaded: of.is_shaded,
        // The image of an image is the drawing.
        mirror: match of.mirror {
            Some(_) => None,
            None => Some(axis),
        },
    }
}

impl Views {
    /// Adds the mirror image of a view.
    pub(super) fn add_mirrored(&mut self, of: ViewId) {
        let own = &self.drawings.views[of];
        let Direction { theta, phi } = own.view.direction;
        let direction = Direction { theta: -theta, phi };
        let axis = self.drawings.frames[of].center.x;
        let mut view = drawn_view(own, axis, direction);
        let partners = self.partners.iter();
        let regions = partners.map(|partner| self.drawings.tracks[(*partner)?].regions[of]);
        let mut regions: Vec<Option<RegionId>> = regions.collect();
        self.keep_colors(of, &regions, &mut view);
        for track in self.drawings.tracks.keys() {
            if self.partners[track].is_none() {
                let carried = self
                    .carried(track, of, &regions, &view)
                    .or_else(|| self.beside(track, of, direction));
                regions[usize::from(track)] = carried.map(|(region, drawn)| {
                    view.drawn.push(drawn);
                    view.view.regions.push_and_get_key(region)
                });
            }
        }
        let features = self.partners.iter_enumerated();
        let features: Vec<_> = features
            .map(|(track, partner)| self.mirrored_features(track, partner.unwrap_or(track), of))
            .collect();
        let added = self.add(Side::Mirrored(of), view, of);
        for (track, region) in self.drawings.tracks.iter_mut().zip(regions) {
            track.regions.push(region);
        }
        for (of_track, features) in self.drawings.features.iter_mut().zip(features) {
            of_track[added] = features;
        }
    }

    /// What has another colour than its partner keeps it: a red button does not become a yellow one.
    fn keep_colors(&self, of: ViewId, regions: &[Option<RegionId>], view: &mut DrawnView) {
        let tracks = &self.drawings.tracks;
        let region = |view: ViewId, id: RegionId| &self.drawings.views[view].view.regions[id];
        for (track, partner) in self.partners.iter_enumerated() {
            let (Some(partner), Some(id)) = (partner, regions[usize::from(track)]) else {
                continue;
            };
            let [own, other] = [track, *partner].map(|track| tracks[track].regions[self.front]);
            let (Some(own), Some(other)) = (own, other) else {
                continue;
            };
            let own = region(self.front, own).color;
            if is_same_color(own, region(self.front, other).color) {
                continue;
            }
            let own = tracks[track].regions[of].map_or(own, |own| region(of, own).color);
            view.view.regions[id].color = own;
            view.drawn[id].part = None;
        }
    }

    /// A region that is on one side only, as seen from the other: where it is from the front, in the box around what it lies on.
    /// `None` if it lies on nothing that is seen there.
    fn carried(
        &self,
        track: TrackId,
        of: ViewId,
        regions: &[Option<RegionId>],
        view: &DrawnView,
    ) -> Option<(Region, Drawn)> {
        let front = self.front;
        let id = self.drawings.tracks[track].regions[front]?;
        let at_front = &self.drawings.views[front].view;
        let outer = at_front.regions[id].container?;
        let mut tracks = self.drawings.tracks.iter();
        let outer_track = tracks.position(|track| track.regions[front] == Some(outer))?;
        let container = regions[outer_track]?;
        let (low, high) = bounds(&at_front.regions[outer].outline)?;
        let (from, to) = bounds(&view.view.regions[container].outline)?;
        let scale = (to - from) / (high - low);
        let (mut region, drawn) = self.moved([front, of], id, |point| from + (point - low) * scale);
        region.container = Some(container);
        scale.is_finite().then_some((region, drawn))
    }

    /// A region on one side only that lies on nothing, as seen from the other: it looks as in the view from which that follows, and is
    /// where the views that show it say. Without that view it is at the depth of the character's middle. `None` if the front does not
    /// show it, or if it lies on something.
    fn beside(&self, track: TrackId, of: ViewId, direction: Direction) -> Option<(Region, Drawn)> {
        let Drawings {
            views,
            frames,
            tracks,
            ..
        } = &self.drawings;
        let regions = &tracks[track].regions;
        let front = regions[self.front]?;
        if views[self.front].view.regions[front].container.is_some() {
            return None;
        }
        let middle = |(view, id): (ViewId, RegionId)| {
            let (low, high) = bounds(&views[view].view.regions[id].outline)?;
            Some((low + high) / 2.0)
        };
        let ray = |(view, id): (ViewId, &Option<RegionId>)| {
            let on_screen = frames[view].on_screen(middle((view, (*id)?))?);
            Some((views[view].view.direction, on_screen))
        };
        let rays: Vec<_> = regions.iter_enumerated().filter_map(ray).collect();
        let (from, id) = match regions[of] {
            Some(id) => (of, id),
            None => (self.front, front),
        };
        let own = middle((from, id))?;
        let of_front = frames[self.front].on_screen(middle((self.front, front))?);
        let place = nearest_to_rays(&rays)
            .unwrap_or_else(|| on_ray(views[self.front].view.direction, of_front, 0.0));
        let [right, up, _] = direction.axes();
        let at = DVec2::new(place.dot(right), place.dot(up));
        let (to, scale) = (
            frames[of].in_drawing(at),
            frames[of].height / frames[from].height,
        );
        let mut moved = self.moved([from, of], id, |point| to + (point - own) * scale);
        moved.0.container = None;
        to.is_finite().then_some(moved)
    }

    /// A region of the first view with its points moved into one that is as large as the second view.
    fn moved(
        &self,
        [from, to]: [ViewId; 2],
        id: RegionId,
        place: impl Fn(DVec2) -> DVec2,
    ) -> (Region, Drawn) {
        let DrawnView { view, drawn, .. } = &self.drawings.views[from];
        let own = &view.regions[id];
        let outline = own
            .outline
            .map_rings(|ring| ring.iter().map(|point| place(*point)).collect());
        let scale = self.drawings.frames[to].height / self.drawings.frames[from].height;
        let mut drawn = drawn[id].clone();
        if let Some(line) = &mut drawn.line {
            line.width *= scale;
        }
        if let Some(line) = &mut drawn.open_line {
            line.points
                .iter_mut()
                .for_each(|point| *point = place(*point));
        }
        // Its texture would have to be moved as well.
        drawn.part = None;
        let region = Region {
            outline: Arc::new(outline),
            ..own.clone()
        };
        (region, drawn)
    }

    /// The feature points of a track in the mirror image of a view: where its partner has those that are its mirror images from the
    /// front, and else where they lie in the boxes around it.
    fn mirrored_features(
        &self,
        track: TrackId,
        partner: TrackId,
        of: ViewId,
    ) -> Vec<(String, DVec2)> {
        let front = self.front;
        let (at_front, at_side) = (
            self.drawings.frames[front],
            self.drawings.frames[of].center.x,
        );
        let boxed = |track: &Track, view: ViewId| {
            let region = &self.drawings.views[view].view.regions[track.regions[view]?];
            bounds(&region.outline)
        };
        let boxes = boxed(&self.drawings.tracks[track], front)
            .zip(boxed(&self.drawings.tracks[partner], of));
        let feature = |(name, point): &(String, DVec2)| {
            let wanted = image(at_front.center.x, *point);
            let namesakes = self.drawings.features[partner][front].iter();
            let nearest = namesakes
                .map(|(name, other)| (other.distance(wanted), name))
                .filter(|(distance, _)| *distance <= NEAR * at_front.height)
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let of_partner = nearest.and_then(|(_, name)| {
                let mut features = self.drawings.features[partner][of].iter();
                features.find(|(other, _)| other == name)
            });
            let point = match (of_partner, boxes) {
                (Some((_, point)), _) => image(at_side, *point),
                (None, Some(((low, high), (from, to)))) => {
                    let share = (*point - low) / (high - low);
                    let share = if share.is_finite() {
                        share
                    } else {
                        DVec2::ZERO
                    };
                    let [from, to] = [image(at_side, to), image(at_side, from)];
                    let (low, high) = (from.min(to), from.max(to));
                    low + share * (high - low)
                }
                _ => image(at_side, *point),
            };
            (name.clone(), point)
        };
        self.drawings.features[track][front]
            .iter()
            .map(feature)
            .collect()
    }
}
