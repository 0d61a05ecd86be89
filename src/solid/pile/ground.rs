//! What a solid lies on, and how far it has to come out in front of that (layers.md, step 6).

use glam::{DAffine2, DVec2};

use super::{Lay, LayForm, Placed};
use crate::solid::heights::Heights;

/// A body that another one lies on or around, as seen from that.
pub(super) struct Place {
    pub(super) placed: Placed,
    /// From the frame of the other one.
    pub(super) to: DAffine2,
    pub(super) is_given: bool,
    pub(super) is_detail: bool,
}

/// What a solid lies on, around and behind.
pub(super) struct Ground {
    /// The topmost first.
    pub(super) below: Vec<Place>,
    pub(super) wraps: Vec<Place>,
    pub(super) behind: Vec<Place>,
}

impl Place {
    fn front(&self, point: DVec2) -> Option<f64> {
        self.placed.front(self.to.transform_point2(point))
    }

    fn back(&self, point: DVec2) -> Option<f64> {
        self.placed.back(self.to.transform_point2(point))
    }

    pub(super) fn front_heights(&self) -> &Heights {
        &self.placed.heights.front
    }

    pub(super) fn back_heights(&self) -> &Heights {
        &self.placed.heights.back
    }

    /// Where a line crosses edges of the front, as shares of its length: in no order, some of them several times.
    pub(super) fn crossings(&self, from: DVec2, to: DVec2, found: &mut Vec<f64>) {
        let [from, to] = [from, to].map(|point| self.to.transform_point2(point));
        self.front_heights().crossings(from, to, found);
    }

    /// Calls `each` with the corners of one side's triangles that are in a box, some of them several times.
    pub(super) fn corners(
        &self,
        [low, high]: [DVec2; 2],
        side: fn(&Self) -> &Heights,
        mut each: impl FnMut(DVec2),
    ) {
        let corners = [
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ];
        let turned = corners.map(|corner| self.to.transform_point2(corner));
        let [first, rest @ ..] = turned;
        let lowest = rest.into_iter().fold(first, DVec2::min);
        let highest = rest.into_iter().fold(first, DVec2::max);
        let back = self.to.inverse();
        for corner in side(self).corners(lowest, highest) {
            let corner = back.transform_point2(corner);
            if corner.clamp(low, high) == corner {
                each(corner);
            }
        }
    }
}

impl Ground {
    /// The front of what lies below a point: of all of it, and, if wanted, of the volumes alone.
    fn fronts(&self, point: DVec2, wants_volumes: bool) -> [Option<f64>; 2] {
        let (mut all, mut volumes) = (None, None);
        let (mut needs_all, mut needs_volumes) = (true, wants_volumes);
        let higher = |highest: Option<f64>, front: f64| {
            Some(highest.map_or(front, |highest| highest.max(front)))
        };
        for place in &self.below {
            if !(needs_all || needs_volumes) {
                break;
            }
            let is_wanted = needs_all || !place.is_detail;
            let Some(front) = is_wanted.then(|| place.front(point)).flatten() else {
                continue;
            };
            if needs_all {
                all = higher(all, front);
                // What is not given comes out in front of all that is below it itself.
                needs_all = place.is_given;
            }
            if needs_volumes && !place.is_detail {
                volumes = higher(volumes, front);
                needs_volumes = place.is_given;
            }
        }
        [all, volumes]
    }

    /// The depth of the nearest border of what lies directly below.
    fn nearest(&self, point: DVec2) -> Option<f64> {
        let nearest = |place: &Place| {
            let Placed {
                heights,
                depth,
                factor,
            } = &place.placed;
            let height = heights.front.nearest(place.to.transform_point2(point))?;
            Some(depth + factor * height)
        };
        self.below
            .iter()
            .find(|place| !place.is_detail)
            .and_then(nearest)
    }
}

/// What the height fields of a solid are to be.
pub(super) struct Target<'a> {
    /// The solid by itself; a line has no heights of its own.
    pub(super) own: Option<Placed>,
    /// The depth of its plane.
    pub(super) depth: f64,
    pub(super) lay: &'a Lay,
    pub(super) ground: &'a Ground,
}

/// The target over a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Level {
    pub(super) front: f64,
    pub(super) back: f64,
    /// The front of what lies below, if something does.
    pub(super) below: Option<f64>,
}

impl Target<'_> {
    /// How far the solid by itself reaches to the front and to the back.
    fn reach(&self, point: DVec2) -> [f64; 2] {
        let own = self.own.as_ref();
        own.map_or([0.0; 2], |own| own.reach(point))
    }

    /// The front of what lies below a point.
    pub(super) fn below(&self, point: DVec2) -> Option<f64> {
        let [below, _] = self.ground.fronts(point, false);
        below
    }

    /// How far the solid by itself reaches to the front.
    pub(super) fn front_reach(&self, point: DVec2) -> f64 {
        let own = self.own.as_ref();
        own.map_or(0.0, |own| own.front_reach(point))
    }

    /// The front of what lies below a point, and the depth that it lifts this solid to, which by itself reaches this far to the
    /// front there.
    pub(super) fn lifted(&self, point: DVec2, front: impl Fn() -> f64) -> Option<[f64; 2]> {
        let Lay { step, bulge, .. } = self.lay;
        let [below, volumes] = self.ground.fronts(point, *bulge > 0.0);
        let below = below?;
        let on_volumes = volumes.map_or(f64::NEG_INFINITY, |volumes| volumes + bulge * front());
        Some([below, on_volumes.max(below + step)])
    }

    /// Whether what lies below a point lifts the solid there.
    pub(super) fn lifts(&self, point: DVec2) -> bool {
        let front = self.front_reach(point);
        let lifted = self.lifted(point, || front);
        lifted.is_some_and(|[_, lifted]| lifted > self.depth + front)
    }

    /// Whether anything makes the solid differ from what it is by itself, as far as these points of it tell.
    pub(super) fn is_lifting(&self, points: &[DVec2]) -> bool {
        let Ground { wraps, behind, .. } = self.ground;
        self.lay.form != LayForm::Volume
            || points.is_empty()
            || self.lay.clips
            || !wraps.is_empty()
            || !behind.is_empty()
            || points.iter().any(|point| self.lifts(*point))
    }

    /// The target over a point.
    pub(super) fn at(&self, point: DVec2) -> Level {
        let Lay {
            step, bulge, form, ..
        } = self.lay;
        let [front, back] = self.reach(point);
        let lifted = self.lifted(point, || front);
        let below = lifted.map(|[below, _]| below);
        let lifted = lifted.map(|[_, lifted]| lifted);
        let natural = [self.depth + front, self.depth - back];
        let [front, back] = match (form, lifted, below) {
            (LayForm::Volume, lifted, _) => {
                let lifted = lifted.unwrap_or(f64::NEG_INFINITY);
                [natural[0].max(lifted), natural[1]]
            }
            (LayForm::Sheet, lifted, _) => [lifted.unwrap_or(natural[0]); 2],
            (LayForm::DeepSkin, Some(lifted), Some(below)) => [lifted, below - step - back],
            (_, Some(lifted), Some(below)) => [lifted, below - step],
            (LayForm::Ink, ..) => {
                let beside = self.ground.nearest(point).unwrap_or(self.depth);
                [beside + step, beside - step]
            }
            _ => {
                let bulge = bulge * front;
                [
                    self.depth + bulge.max(*step),
                    self.depth - back.min(bulge + step),
                ]
            }
        };
        let behind = |places: &[Place]| {
            let backs = places.iter().filter_map(|place| place.back(point));
            backs.reduce(f64::min)
        };
        let around = behind(&self.ground.wraps);
        let around = around.map(|around| around - step - bulge * (natural[0] - self.depth));
        let covered = behind(&self.ground.behind).map(|covered| covered - step);
        let back = around.into_iter().chain(covered).fold(back, f64::min);
        Level { front, back, below }
    }
}
