//! Whether a character is symmetric from the front, and which of its regions are mirror images of each other.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use super::axis::axis;
use super::grid::is_alike;
use super::mirror;
use crate::billboard::matching::{Track, TrackId, match_regions};
use crate::billboard::place::frames;
use crate::billboard::region::{Region, RegionId, View};
use crate::geometry::{Outline, area, bounds, intersect};
use crate::scene::ViewId;

// These were fitted to 121 emoji of four makers, of which 79 are symmetric; 136 others were held back.

/// The share of the areas of all regions that their mirror images cover, at least, in a symmetric drawing.
const COVERED: f64 = 0.86;
/// The share of the regions that have a partner, at least.
const PAIRED: f64 = 0.7;
/// A region is large from this share of the largest one on. Of each large one, its mirror image covers this share at least.
const LARGE: f64 = 0.1;
const COVERED_LARGE: f64 = 0.5;
/// The share that two regions of different colours have in common with each other's mirror images, at least.
const SAME: f64 = 0.7;
/// The share of a region without a partner that its own mirror image covers, at least, if it counts as symmetric.
const OWN: f64 = 0.3;

/// An outermost region of at least this share of the largest one is elsewhere on the other side, as a hand that is raised, if its partner's
/// mirror image covers less than this share of it.
const LIMB: f64 = 0.025;
const MOVED: f64 = 0.1;
/// What is added on one side, such as a stick, covers at most this share of the areas of all regions; of these, it is at most this
/// share.
const ADDED: f64 = 0.15;
const ADDED_COUNT: f64 = 0.3;
/// Two regions are the left and the right one of a pair, though not mirror images, if the smaller one has this share of the area of the
/// larger one, at least: an arm that is raised is no addition.
const COUNTERPART: f64 = 0.5;

/// The symmetry of a drawing from the front.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::billboard) struct Symmetry {
    /// Whether the drawing is its own mirror image, but for small things.
    pub(in crate::billboard) is_symmetric: bool,
    /// The place across of the upright line about which it is, drawing units.
    pub(in crate::billboard) axis: f64,
    /// Per region the one that is its mirror image, itself if it is symmetric; `None` without one.
    pub(in crate::billboard) partners: TiVec<RegionId, Option<RegionId>>,
}

/// The symmetry of a view about an upright line.
pub(in crate::billboard) fn symmetry(view: &View) -> Symmetry {
    let areas: TiVec<RegionId, f64> = view.regions.iter().map(|r| area(&r.outline)).collect();
    let axis = axis(view, &areas);
    // A left arm is no right one by name.
    let unnamed = |region: &Region| Region {
        name: None,
        ..region.clone()
    };
    let own = View {
        regions: view.regions.iter().map(unnamed).collect(),
        ..*view
    };
    let image = mirror::view(&own, axis, own.direction);
    let pair: TiVec<ViewId, View> = vec![own, image].into();
    let mut frames = frames(&pair);
    for frame in &mut frames {
        frame.center.x = axis;
    }
    let matched = match_regions(&pair, &frames);
    let mut found: TiVec<RegionId, Option<RegionId>> = vec![None; view.regions.len()].into();
    for track in &matched.tracks {
        if let [Some(region), partner] = track.regions.raw[..] {
            found[region] = partner;
        }
    }
    let common = |a: RegionId, b: RegionId| {
        let [a, b] = [
            &pair[ViewId::FIRST].regions[a],
            &pair[ViewId::from(1)].regions[b],
        ];
        if overlap(&a.outline, &b.outline) {
            area(&intersect(&a.outline, &b.outline))
        } else {
            0.0
        }
    };
    // What is not each other's image is none, and a thing beside the middle is not its own.
    let mutual = |region: RegionId| {
        let partner = found[region].filter(|other| found[*other] == Some(region))?;
        let is_own = partner == region;
        (!is_own || common(region, region) >= OWN * areas[region]).then_some(partner)
    };
    let mut partners: TiVec<RegionId, Option<RegionId>> = view.regions.keys().map(mutual).collect();
    // Two that differ in colour alone, such as buttons, are a pair, too.
    for region in view.regions.keys() {
        if partners[region].is_some() {
            continue;
        }
        let fits = |other: &RegionId| {
            let least = SAME * areas[region].max(areas[*other]);
            partners[*other].is_none() && common(region, *other) >= least
        };
        let other = view.regions.keys().skip(usize::from(region)).find(fits);
        if let Some(other) = other {
            partners[region] = Some(other);
            partners[other] = Some(region);
        } else if common(region, region) >= OWN * areas[region] {
            partners[region] = Some(region);
        }
    }
    let largest = areas.iter().copied().fold(0.0, f64::max);
    // A fringe with its parting at one side is on both, and not its own image.
    for (id, region) in view.regions.iter_enumerated() {
        let is_large = areas[id] >= LARGE * largest;
        let is_own = partners[id] == Some(id) && region.container.is_some();
        if is_own && is_large && common(id, id) < COVERED_LARGE * areas[id] {
            partners[id] = None;
        }
    }
    let added = added(view, &partners, &areas);
    let is_added = |region: &RegionId| added.contains(region);
    let all: f64 = areas.iter().sum();
    let of_added: f64 = added.iter().map(|region| areas[*region]).sum();
    let total = all - of_added;
    let count = (view.regions.len() - added.len()) as f64;
    let (mut covered, mut paired) = (0.0, 0_u32);
    let mut is_symmetric = of_added <= ADDED * all;
    for (region, partner) in partners.iter_enumerated() {
        if is_added(&region) {
            continue;
        }
        let of_region = partner.map_or(0.0, |other| common(region, other));
        covered += of_region;
        paired += u32::from(partner.is_some());
        let Region {
            container, is_line, ..
        } = &view.regions[region];
        let least = if areas[region] >= LARGE * largest {
            COVERED_LARGE
        } else if areas[region] >= LIMB * largest && container.is_none() && !is_line {
            MOVED
        } else {
            0.0
        };
        is_symmetric &= of_region >= least * areas[region];
    }
    Symmetry {
        is_symmetric: is_symmetric
            && covered >= COVERED * total
            && f64::from(paired) >= PAIRED * count,
        axis,
        partners,
    }
}

/// What is added on one side only.
fn added(
    view: &View,
    partners: &TiSlice<RegionId, Option<RegionId>>,
    areas: &TiSlice<RegionId, f64>,
) -> Vec<RegionId> {
    let single: Vec<RegionId> = partners
        .keys()
        .filter(|id| partners[*id].is_none())
        .collect();
    let is_counterpart = |a: RegionId, b: RegionId| {
        let [first, second] = [a, b].map(|id| &view.regions[id]);
        a != b
            && is_alike(first.color, second.color)
            && first.is_line == second.is_line
            && areas[a].min(areas[b]) >= COUNTERPART * areas[a].max(areas[b])
    };
    let is_added = |id: &&RegionId| !single.iter().any(|other| is_counterpart(**id, *other));
    let added: Vec<RegionId> = single.iter().filter(is_added).copied().collect();
    if added.len() as f64 <= ADDED_COUNT * view.regions.len() as f64 {
        added
    } else {
        Vec::new()
    }
}

/// Whether the boxes around two outlines overlap.
fn overlap(a: &Outline, b: &Outline) -> bool {
    let boxes = bounds(a).zip(bounds(b));
    let common = boxes.map(|((low, high), (from, to))| high.min(to) - low.max(from));
    common.is_some_and(|size: DVec2| size.min_element() > 0.0)
}

/// Per track the one that is its mirror image. What the front view does not show is its own: seen from one side only, it looks alike
/// from the other.
pub(super) fn of_tracks(
    symmetry: &Symmetry,
    front: ViewId,
    tracks: &TiSlice<TrackId, Track>,
) -> TiVec<TrackId, Option<TrackId>> {
    let mut track_of: TiVec<RegionId, Option<TrackId>> = vec![None; symmetry.partners.len()].into();
    for (index, track) in tracks.iter_enumerated() {
        if let Some(region) = track.regions[front] {
            track_of[region] = Some(index);
        }
    }
    let partner = |(index, track): (TrackId, &Track)| match track.regions[front] {
        Some(region) => symmetry.partners[region].and_then(|other| track_of[other]),
        None => Some(index),
    };
    tracks.iter_enumerated().map(partner).collect()
}
