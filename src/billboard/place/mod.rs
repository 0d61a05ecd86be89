//! Where the regions of a character are in space, and which of them is in front.
//!
//! Source: Kitamura, *Modeling and Animation of Pseudo-3D Objects*, section 4.2.4, after Rivers et al., *2.5D Cartoon Models*.
//! Lengths are in heights of the character, in the character's axes.

mod frame;
mod order;
mod rays;
#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};
use typed_index_collections::{TiSlice, TiVec};

pub(super) use frame::{Frame, frames};
pub(super) use rays::{angle, nearest_to_rays, on_ray};

use super::matching::RegionInView;
use super::matching::{Track, TrackId};
use super::region::{RegionId, View};
use crate::geometry::bounds;
use crate::scene::ViewId;

/// A track's place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TrackPosition {
    /// The point nearest to the rays of all views that show it.
    pub point: DVec3,
    /// The place for each view. Where the view shows the track, it lies on that view's ray, so that the drawing is reproduced
    /// exactly.
    pub in_views: TiVec<ViewId, DVec3>,
    /// The depth of each of them towards that view's viewer, in steps of 2⁻³⁰ so that equal depths stay equal.
    pub depths: TiVec<ViewId, f64>,
}

/// Places the tracks of some views.
///
/// `depths` gives for each view the depths that the drawing sets for its regions: drawing units towards the viewer of that view,
/// from the character's centre. Lists may be short. A set depth counts more than the rays and more than the order of painting.
///
/// A track that one view shows alone is at the depth of its container, or of the middle of the other tracks. Then what is painted over
/// something else comes to lie in front of it, by at least 0.002 and what that has in `rooms`, without a change to any drawing. The list
/// may be short, too.
pub(super) fn place(
    views: &TiSlice<ViewId, View>,
    frames: &TiSlice<ViewId, Frame>,
    tracks: &TiSlice<TrackId, Track>,
    depths: &TiSlice<ViewId, TiVec<RegionId, Option<f64>>>,
    rooms: &TiSlice<TrackId, f64>,
) -> TiVec<TrackId, TrackPosition> {
    let scene = Scene {
        rooms,
        ..Scene::new(views, frames, tracks, depths)
    };
    let mut points: TiVec<TrackId, Option<DVec3>> =
        tracks.iter().map(|t| scene.estimated(t)).collect();
    let containers: TiVec<TrackId, Option<TrackId>> =
        tracks.iter().map(|t| scene.container(t)).collect();
    let middle = middle(&points, &containers);
    // Containers first; those that contain each other are left over.
    let mut left: Vec<TrackId> = tracks.keys().filter(|t| points[*t].is_none()).collect();
    loop {
        let before = left.len();
        left.retain(|&t| {
            let outer = containers[t].map(|c| points[c]);
            if outer == Some(None) {
                return true;
            }
            points[t] = Some(scene.beside(&tracks[t], outer.flatten().or(middle)));
            false
        });
        if left.len() == before {
            break;
        }
    }
    let points: Vec<DVec3> = points
        .iter()
        .zip(tracks)
        .map(|(point, track)| point.unwrap_or_else(|| scene.beside(track, middle)))
        .collect();
    let mut placed: TiVec<TrackId, TrackPosition> = tracks
        .iter()
        .zip(&points)
        .map(|(track, point)| scene.on_rays(track, *point))
        .collect();
    follow(tracks, &containers, &mut placed);
    for placed in &mut placed {
        let depths = placed.in_views.iter().zip(scene.views);
        let depths = depths.map(|(p, view)| snapped(p.dot(view.direction.axes()[2])));
        placed.depths = depths.collect();
    }
    order::put_in_front(&scene, &mut placed);
    placed
}

/// The mean of the known places of what has no container.
fn middle(
    points: &TiSlice<TrackId, Option<DVec3>>,
    containers: &TiSlice<TrackId, Option<TrackId>>,
) -> Option<DVec3> {
    let outermost = points.iter().zip(containers).filter(|(_, c)| c.is_none());
    let known = outermost.filter_map(|(p, _)| *p);
    let (sum, count) = known.fold((DVec3::ZERO, 0), |(sum, n), p| (sum + p, n + 1));
    (count > 0).then(|| sum / f64::from(count))
}

/// A depth without what rounding added: 2⁻³⁰ of a height is less than anything that shows.
fn snapped(depth: f64) -> f64 {
    const STEPS: f64 = (1u64 << 30) as f64;
    (depth * STEPS).round() / STEPS
}

/// Whether places can be computed from a length in heights without overflow; no drawing has larger ones.
fn is_usable(length: f64) -> bool {
    length.abs() < 1e12
}

/// What the drawings say.
struct Scene<'a> {
    views: &'a TiSlice<ViewId, View>,
    frames: &'a TiSlice<ViewId, Frame>,
    tracks: &'a TiSlice<TrackId, Track>,
    depths: &'a TiSlice<ViewId, TiVec<RegionId, Option<f64>>>,
    /// How much farther away what is painted over each track is.
    rooms: &'a TiSlice<TrackId, f64>,
    /// The track of each region of each view.
    track_of: TiVec<ViewId, TiVec<RegionId, Option<TrackId>>>,
}

impl<'a> Scene<'a> {
    fn new(
        views: &'a TiSlice<ViewId, View>,
        frames: &'a TiSlice<ViewId, Frame>,
        tracks: &'a TiSlice<TrackId, Track>,
        depths: &'a TiSlice<ViewId, TiVec<RegionId, Option<f64>>>,
    ) -> Self {
        let views = &views[..views.next_key().min(frames.next_key())];
        let regions = views.iter().map(|v| vec![None; v.regions.len()].into());
        let mut track_of: TiVec<ViewId, TiVec<RegionId, _>> = regions.collect();
        for (i, track) in tracks.iter_enumerated() {
            for (of_view, region) in track_of.iter_mut().zip(&track.regions) {
                if let Some(slot) = region.and_then(|r| of_view.get_mut(r)) {
                    *slot = Some(i);
                }
            }
        }
        Self {
            views,
            frames,
            tracks,
            depths,
            rooms: TiSlice::from_ref(&[]),
            track_of,
        }
    }

    /// The regions of a track.
    fn regions(&self, track: &Track) -> Vec<RegionInView> {
        let regions = track.regions.iter_enumerated();
        let regions = regions.filter_map(|(view, id)| Some(RegionInView { view, id: (*id)? }));
        let exists = |region: &RegionInView| {
            let view = self.views.get(region.view);
            view.is_some_and(|view| view.regions.get(region.id).is_some())
        };
        regions.filter(exists).collect()
    }

    /// The middle of a region's bounding box on the screen.
    fn at(&self, RegionInView { view, id }: RegionInView) -> DVec2 {
        let (low, high) = bounds(&self.views[view].regions[id].outline).unwrap_or_default();
        let at = self.frames[view].on_screen((low + high) / 2.0);
        if is_usable(at.x) && is_usable(at.y) {
            at
        } else {
            DVec2::ZERO
        }
    }

    /// The depth that the drawing sets for a region, heights.
    fn set_depth(&self, RegionInView { view, id }: RegionInView) -> Option<f64> {
        let depth = (*self.depths.get(view)?.get(id)?)? / self.frames[view].height;
        is_usable(depth).then_some(depth)
    }

    /// The place that set depths or several rays tell.
    fn estimated(&self, track: &Track) -> Option<DVec3> {
        let regions = self.regions(track);
        let set = regions.iter().filter_map(|r| {
            let depth = self.set_depth(*r)?;
            Some(on_ray(self.views[r.view].direction, self.at(*r), depth))
        });
        let (sum, count) = set.fold((DVec3::ZERO, 0), |(sum, n), p| (sum + p, n + 1));
        if count > 0 {
            return Some(sum / f64::from(count));
        }
        let ray = |r: &RegionInView| (self.views[r.view].direction, self.at(*r));
        nearest_to_rays(&regions.iter().map(ray).collect::<Vec<_>>())
    }

    /// The track of the container in the first view that shows one.
    fn container(&self, track: &Track) -> Option<TrackId> {
        self.regions(track)
            .into_iter()
            .find_map(|RegionInView { view, id }| {
                let container = self.views[view].regions[id].container?;
                *self.track_of[view].get(container)?
            })
    }

    /// The place on the first ray at the depth of another place.
    fn beside(&self, track: &Track, other: Option<DVec3>) -> DVec3 {
        let Some(&region) = self.regions(track).first() else {
            return other.unwrap_or_default();
        };
        let direction = self.views[region.view].direction;
        let depth = other.map_or(0.0, |p| p.dot(direction.axes()[2]));
        on_ray(direction, self.at(region), depth)
    }

    /// The places on the rays of the views that show a track.
    fn on_rays(&self, track: &Track, point: DVec3) -> TrackPosition {
        let mut in_views = TiVec::from(vec![point; self.views.len()]);
        for region in self.regions(track) {
            let direction = self.views[region.view].direction;
            let depth = self.set_depth(region);
            let depth = depth.unwrap_or_else(|| point.dot(direction.axes()[2]));
            in_views[region.view] = on_ray(direction, self.at(region), depth);
        }
        TrackPosition {
            point,
            in_views,
            depths: TiVec::new(),
        }
    }
}

/// In views that do not show a track, it stays at the same place relative to its container.
fn follow(
    tracks: &TiSlice<TrackId, Track>,
    containers: &TiSlice<TrackId, Option<TrackId>>,
    placed: &mut TiSlice<TrackId, TrackPosition>,
) {
    for (i, track) in tracks.iter_enumerated() {
        // Chains of containers are short; those that contain each other are climbed once.
        let mut outer = containers[i];
        let mut steps = tracks.len();
        for view in placed[i].in_views.keys() {
            if track.regions.get(view).copied().flatten().is_some() {
                continue;
            }
            while let Some(c) = outer
                && tracks[c].regions.get(view).copied().flatten().is_none()
                && steps > 0
            {
                (outer, steps) = (containers[c], steps - 1);
            }
            if let Some(c) = outer {
                let moved = placed[c].in_views[view] - placed[c].point;
                placed[i].in_views[view] += moved;
            }
            outer = containers[i];
        }
    }
}
