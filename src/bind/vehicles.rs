//! Parts of vehicles that are drawn from the side: bodies that are as deep as a toy's, and wheels on both sides.

use std::collections::BTreeMap;

use glam::DVec2;
use rustc_hash::FxHashSet;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::bindings::{Bindings, PartId, PartKind, Seen};
use super::{bodies, discs};
use crate::anatomy::{self, Role};
use crate::geometry::{Outline, area, bounds_of, union};
use crate::solid::Profile;

/// How deep a vehicle is: a share of its width, but no deeper than it is high.
const DEPTH: f64 = 0.3;
/// The same of one whose two wheels are in a line: a motorbike.
const NARROW_DEPTH: f64 = 0.2;
/// How thick a wheel is at most, as a share of the depth of its vehicle.
const OF_DEPTH: f64 = 0.25;
/// The wheels of a motorbike are about equally large, the smaller one at least this share of the larger one and this share of the width,
/// and its other parts cover at most this share of the box around it.
const ALIKE: f64 = 0.75;
const LARGE: f64 = 0.25;
const FRAME: f64 = 0.5;
/// From the first to the last they reach over at least this share of its width.
const SPAN: f64 = 0.85;

/// What a part is of a vehicle that is drawn from the side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum VehiclePart {
    /// A piece of its body, which reaches as far to either side of its middle plane, drawing units.
    Body { reach: f64 },
    /// A wheel, half as thick as that, on both sides of a body that reaches as far, drawing units.
    Wheel { half: f64, beside: f64 },
    /// One of two wheels in a line, half as thick as that.
    MiddleWheel { half: f64 },
}

impl VehiclePart {
    /// How far it reaches to either side of its own plane, drawing units.
    fn reach(self) -> f64 {
        match self {
            Self::Body { reach } => reach,
            Self::Wheel { half, .. } | Self::MiddleWheel { half } => half,
        }
    }

    /// How its outline gets its thickness; `usual` is how it would elsewhere.
    pub(crate) fn profile(self, usual: Profile) -> Profile {
        usual.boxed(self.reach())
    }
}

/// A vehicle.
struct Vehicle {
    /// Its size.
    size: DVec2,
    /// Whether its wheels are in a line.
    is_narrow: bool,
    /// Whether somebody drives it: names tell limbs or a head.
    has_rider: bool,
    /// What its wheels hang on.
    carriers: FxHashSet<PartId>,
}

impl Bindings {
    /// Per part what it is of a vehicle in profile, as far as no string says otherwise. Per main part, `seen` says from where it is
    /// drawn.
    pub(crate) fn vehicle_parts(
        &self,
        seen: &TiSlice<PartId, Seen>,
    ) -> TiVec<PartId, Option<VehiclePart>> {
        let mut found = ti_vec![None; self.parts.len()];
        if !self.is_first_look || !seen.contains(&Seen::VehicleInProfile) {
            return found;
        }
        let extents = self.extents_of_figures();
        let mut members: BTreeMap<PartId, Vec<PartId>> = BTreeMap::new();
        for (index, part) in self.parts.iter_enumerated() {
            let is_solid = matches!(part.kind, PartKind::Main | PartKind::Sub);
            if is_solid && seen[part.main] == Seen::VehicleInProfile {
                members.entry(extents[index].root).or_default().push(index);
            }
        }
        for (root, members) in members {
            let (low, high) = extents[root].bounds.unwrap_or_default();
            let vehicle = self.vehicle(&members, high - low);
            for part in members {
                found[part] = self.of_vehicle(&vehicle, part);
            }
        }
        found
    }

    fn vehicle(&self, members: &[PartId], size: DVec2) -> Vehicle {
        let mains = members
            .iter()
            .filter(|part| self.parts[**part].is_candidate());
        let mains: Vec<PartId> = mains.copied().collect();
        let name = |part: &PartId| self.parts[*part].name.as_str();
        let is_alive = |part: &PartId| {
            let role = Role::of(&anatomy::terms(name(part)));
            role.is_some_and(|role| role == Role::Head || role.is_piece_of_limb())
        };
        Vehicle {
            size,
            is_narrow: mains.iter().any(|part| anatomy::is_bike(name(part)))
                || self.has_two_in_line(members, size),
            has_rider: mains.iter().any(is_alive),
            carriers: mains
                .iter()
                .filter(|part| self.is_wheel(**part))
                .filter_map(|part| self.parts[*part].parent)
                .collect(),
        }
    }

    /// Whether there are two large wheels with a narrow frame.
    fn has_two_in_line(&self, members: &[PartId], size: DVec2) -> bool {
        let filled = members.iter().copied();
        let filled = filled.filter(|part| self.parts[*part].is_candidate());
        let (wheels, others): (Vec<PartId>, Vec<PartId>) =
            filled.partition(|part| self.is_wheel(*part));
        let mut wide: Vec<DVec2> = Vec::new();
        for part in wheels {
            for polygon in &self.parts[part].outline.polygons {
                let ring = polygon.rings.first().into_iter().flatten();
                let Some((low, high)) = bounds_of(ring.copied()) else {
                    continue;
                };
                // A hub is at the same place as its tyre.
                let is_same = |other: &DVec2| low.x < other.y && other.x < high.x;
                match wide.iter_mut().find(|other| is_same(other)) {
                    Some(other) => *other = DVec2::new(other.x.min(low.x), other.y.max(high.x)),
                    None => wide.push(DVec2::new(low.x, high.x)),
                }
            }
        }
        let [a, b] = wide.as_slice() else {
            return false;
        };
        let span = a.y.max(b.y) - a.x.min(b.x);
        let [a, b] = [a, b].map(|wheel| wheel.y - wheel.x);
        let outlines = others
            .iter()
            .map(|part| (*self.parts[*part].outline).clone());
        let frame = || area(&union(&outlines.collect::<Vec<Outline>>()));
        a.min(b) >= ALIKE * a.max(b)
            && a.min(b) >= LARGE * size.x
            && span >= SPAN * size.x
            && frame() <= FRAME * size.x * size.y
    }

    fn of_vehicle(&self, vehicle: &Vehicle, index: PartId) -> Option<VehiclePart> {
        let part = &self.parts[index];
        let is_given = |part: PartId| self.given_depth(part).is_some();
        let is_plain = part.host.is_none() && !part.is_stroke && !part.is_sheet();
        if !is_plain || is_given(index) || is_given(part.main) {
            return None;
        }
        let (low, high) = part.measure.bounds;
        let wide = high.x - low.x;
        let share = if vehicle.is_narrow {
            NARROW_DEPTH
        } else {
            DEPTH
        };
        let reach = 0.5 * (share * vehicle.size.x).min(vehicle.size.y);
        if self.is_wheel(index) {
            let half = 0.5 * discs::THICKNESS * discs::diameter(&part.outline)?;
            return Some(if vehicle.is_narrow {
                VehiclePart::MiddleWheel {
                    half: half.min(reach),
                }
            } else {
                VehiclePart::Wheel {
                    half: half.min(OF_DEPTH * reach),
                    beside: reach,
                }
            });
        }
        let is_of_rider = vehicle.has_rider && self.is_of_rider(vehicle, part.main);
        // What is drawn narrow from the side is narrow from the front as well: a chimney, a lamp.
        (!is_of_rider).then_some(VehiclePart::Body {
            reach: reach.min(0.5 * wide),
        })
    }

    /// Whether a part is a wheel, or a piece of one.
    pub(crate) fn is_wheel(&self, part: PartId) -> bool {
        let part = &self.parts[part];
        anatomy::is_disc(&part.name) || anatomy::is_disc(&self.parts[part.main].name)
    }

    /// Whether a part is one of a body, or hangs on one, as long as that carries no wheels.
    fn is_of_rider(&self, vehicle: &Vehicle, part: PartId) -> bool {
        let mut at = Some(part);
        for _ in 0..self.parts.len() {
            let Some(part) = at.filter(|part| !vehicle.carriers.contains(part)) else {
                return false;
            };
            if bodies::is_of_body(&self.parts[part].name) {
                return true;
            }
            at = self.parts[part].parent;
        }
        false
    }
}
