//! How well two regions of two views fit each other.

use glam::{DVec2, DVec3, Vec2Swizzles as _};
use typed_index_collections::{TiSlice, TiVec};

use crate::billboard::place::Frame;
use crate::billboard::region::{Direction, Region, RegionId, View};
use crate::geometry::{bounds, shoelace};
use crate::math;

/// Colours farther apart than this cannot be the same surface (Tc of equation 4.2).
pub(super) const COLOR_DISTANCE: f64 = 0.3;
/// What a distance of one height costs along the way on which depth moves things, and across it.
const ALONG: f64 = 4.0;
const ACROSS: f64 = 12.0;
/// What it costs if the extents across that way differ by one height, and the most that it costs: parts may be hidden.
const EXTENT: f64 = 6.0;
const MOST_EXTENT: f64 = 0.5;
/// What a colour distance of 1 costs.
const COLOR: f64 = 3.0;
/// What it costs if the containers differ in colour, or if only one region has one.
const OTHER_CONTAINER: f64 = 1.0;
const ONE_CONTAINER: f64 = 0.5;
/// What it costs per height that a region is behind the middle of the character in the other view: of two arms that look alike from the
/// side, the near one is seen.
const FAR_SIDE: f64 = 2.0;
/// The most that it costs: of wide things both sides are seen, and keep their partners.
const MOST_FAR_SIDE: f64 = 0.5;
/// What it costs per height that a region is nearer than the middle of the character in the other view, although its partner lies under
/// one that looks alike, or farther, although its partner lies over one: of two legs, the near one is painted over the far one.
const PAINT_ORDER: f64 = 4.0;
/// Regions look alike if their colours are no farther apart, and their areas differ by no more than this share of their mean.
const ALIKE_COLOR: f64 = 0.05;
const ALIKE_AREA: f64 = 0.7;
/// The fewest pairs that tell how far two drawings' centres are apart.
const LEAST_PAIRS: usize = 5;
/// Costs do not exceed this, so that no input overflows.
const MOST: f64 = 1e6;
/// Turns with less effect on the screen than this, per unit of depth, have no direction.
const LEAST_TURN: f64 = 1e-6;

/// What is compared of a region. Lengths are heights, y up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Features {
    /// The middle of its bounding box.
    pub(super) at: DVec2,
    /// Half the size of the box.
    half: DVec2,
    /// Its area with holes filled.
    area: f64,
    color: DVec3,
    pub(super) container: Option<RegionId>,
    pub(super) is_line: bool,
    container_color: Option<DVec3>,
    /// Towards the viewer, guessed from its place in its container.
    pub(super) depth: f64,
    /// 1 if it is painted over one that looks alike, -1 if such a one is painted over it, 0 without one.
    order: f64,
}

/// The features of all regions of a view.
pub(super) fn features(view: &View, frame: &Frame) -> TiVec<RegionId, Features> {
    let mut all: TiVec<RegionId, _> = view.regions.iter().map(|r| own(r, frame)).collect();
    for i in all.keys() {
        let container = all[i].container.filter(|c| *c < all.next_key() && *c != i);
        all[i].container = container;
        all[i].container_color = container.map(|c| all[c].color);
    }
    for i in all.keys() {
        all[i].depth = guessed_depth(&all, i);
    }
    for upper in all.keys() {
        for lower in all.keys().take_while(|lower| *lower < upper) {
            if all[upper].is_alike(&all[lower]) {
                all[upper].order = 1.0;
                all[lower].order = -1.0;
            }
        }
    }
    all
}

impl Features {
    /// Where it is in a view with these axes, as far as its depth is known.
    fn place(&self, [right, up, toward]: [DVec3; 3]) -> DVec3 {
        right * self.at.x + up * self.at.y + toward * self.depth
    }

    /// Whether another region of the same view looks alike and lies in the same place, and both are limbs rather than details.
    fn is_alike(&self, other: &Self) -> bool {
        let meets = (self.at - other.at)
            .abs()
            .cmplt(self.half + other.half)
            .all();
        meets
            && self.container.is_none()
            && other.container.is_none()
            && self.color.distance(other.color) <= ALIKE_COLOR
            && relative(self.area, other.area) <= ALIKE_AREA
    }
}

fn own(region: &Region, frame: &Frame) -> Features {
    let (low, high) = bounds(&region.outline).unwrap_or_default();
    let finite = |v: DVec2| if v.is_finite() { v } else { DVec2::ZERO };
    let borders = region
        .outline
        .polygons
        .iter()
        .filter_map(|p| p.rings.first());
    let area: f64 = borders.map(|ring| shoelace(ring).abs()).sum();
    let area = area / (frame.height * frame.height);
    let [r, g, b, _] = region.color;
    let color = DVec3::new(r, g, b);
    Features {
        at: finite(frame.on_screen((low + high) / 2.0)),
        half: finite((high - low) / 2.0 / frame.height),
        area: if area.is_finite() { area } else { 0.0 },
        color: if color.is_finite() {
            color
        } else {
            DVec3::ZERO
        },
        container: region.container,
        is_line: region.is_line,
        container_color: None,
        depth: 0.0,
        order: 0.0,
    }
}

/// The depth of a region that lies on a rounded container: 0 without one, and that of its container if that is contained, too.
fn guessed_depth(all: &TiSlice<RegionId, Features>, region: RegionId) -> f64 {
    let mut inner = region;
    let Some(mut outer) = all[inner].container else {
        return 0.0;
    };
    // Containers that contain each other would be climbed for ever.
    for _ in 0..all.len() {
        let Some(next) = all[outer].container else {
            break;
        };
        (inner, outer) = (outer, next);
    }
    let half = all[outer].half;
    let radius = half.min_element();
    let offset = (all[inner].at - all[outer].at) / half;
    if radius > 0.0 {
        radius * (1.0 - offset.length_squared()).max(0.0).sqrt()
    } else {
        0.0
    }
}

/// The step from one view to another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    from: [DVec3; 3],
    to: [DVec3; 3],
    /// Where depth in the first view moves things in the second.
    along: Option<DVec2>,
    /// The weights of equation 4.1.
    weights: DVec2,
    /// How far the drawings' centres are apart.
    shift: DVec2,
}

impl Turn {
    pub(super) fn new(from: Direction, to: Direction) -> Self {
        let (start, axes) = (from.axes(), to.axes());
        let toward = start[2];
        let same = |a: f64, b: f64| if a == b { 1.0 } else { 0.5 };
        Self {
            from: start,
            to: axes,
            along: DVec2::new(toward.dot(axes[0]), toward.dot(axes[1]))
                .try_normalize()
                .filter(|_| toward.cross(axes[2]).length() > LEAST_TURN),
            weights: DVec2::new(same(from.theta, to.theta), same(from.phi, to.phi)),
            shift: DVec2::ZERO,
        }
    }

    /// Moves the second drawing to where some pairs say that it should be: the middle of what bounding boxes show is not the same
    /// point of the character in both. Takes the median, and nothing from fewer than five pairs.
    pub(super) fn shift_by(&mut self, pairs: &[(&Features, &Features)]) {
        if pairs.len() < LEAST_PAIRS {
            return;
        }
        let off: Vec<_> = pairs
            .iter()
            .map(|(a, b)| b.at - self.predicted(a))
            .collect();
        let median = |of: fn(&DVec2) -> f64| {
            let mut values: Vec<f64> = off.iter().map(of).collect();
            let middle = values.len() / 2;
            *values.select_nth_unstable_by(middle, f64::total_cmp).1
        };
        self.shift = DVec2::new(median(|v| v.x), median(|v| v.y));
    }

    /// Where a region should come to lie in the second view.
    pub(super) fn predicted(&self, region: &Features) -> DVec2 {
        let p = region.place(self.from);
        DVec2::new(p.dot(self.to[0]), p.dot(self.to[1]))
    }

    /// The similarity of equations 4.1 and 4.2, from 0 to 1.
    pub(super) fn similarity(&self, a: &Features, b: &Features) -> f64 {
        if !may_match(a, b) {
            return 0.0;
        }
        let apart = (a.at - b.at).abs().dot(self.weights);
        math::exp(-apart - relative(a.area, b.area))
    }

    /// The cost of a pair, without colours that exclude each other: 0 for a perfect one.
    pub(super) fn cost(&self, a: &Features, b: &Features) -> f64 {
        let off = b.at - self.predicted(a) - self.shift;
        let place = self.along.map_or(ACROSS * off.length(), |along| {
            // A turn moves points along one direction only, so that what a box measures across it stays.
            let across = (a.half - b.half).abs().dot(along.abs().yx());
            let extent = (EXTENT * across).min(MOST_EXTENT);
            ALONG * off.dot(along).abs() + ACROSS * off.perp_dot(along).abs() + extent
        });
        let container = match (a.container_color, b.container_color) {
            (Some(a), Some(b)) if a.distance(b) > COLOR_DISTANCE => OTHER_CONTAINER,
            (Some(_), None) | (None, Some(_)) => ONE_CONTAINER,
            _ => 0.0,
        };
        let color = COLOR * a.color.distance(b.color);
        let far = self.far_side(a, b);
        (place + relative(a.area, b.area) + color + container + far).min(MOST)
    }

    /// What it costs if a region is on the side of the character that is turned away in the other one's view, or the order of painting
    /// says that it is on the other side.
    fn far_side(&self, a: &Features, b: &Features) -> f64 {
        let depths = [
            a.place(self.from).dot(self.to[2]),
            b.place(self.to).dot(self.from[2]),
        ];
        let behind: f64 = depths.iter().map(|depth| (-depth).max(0.0)).sum();
        let orders = [depths[0] * b.order, depths[1] * a.order];
        let disorder: f64 = orders.iter().map(|order| (-order).max(0.0)).sum();
        (FAR_SIDE * behind + PAINT_ORDER * disorder).min(MOST_FAR_SIDE)
    }
}

/// Whether the colours are close enough (J of equation 4.2).
pub(super) fn may_match(a: &Features, b: &Features) -> bool {
    a.color.distance(b.color) <= COLOR_DISTANCE
}

/// The difference of two areas relative to their mean, from 0 to 2.
fn relative(a: f64, b: f64) -> f64 {
    let mean = (a + b) / 2.0;
    if mean > 0.0 {
        (a - b).abs() / mean
    } else {
        0.0
    }
}
