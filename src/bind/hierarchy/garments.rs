//! Clothes that are drawn apart hang on what they cover: a sleeve on its arm, whatever else it touches, a skirt on the hips.

use rayon::prelude::*;
use typed_index_collections::TiSlice;

use super::limbs::Limbs;
use super::names::Names;
use super::{Context, parents};
use crate::anatomy::{self, Role, Term};
use crate::bind::bindings::{NamedBy, PartId};
use crate::geometry::{BoxTree, Outline, area, area_around, bounds, indexed_box, intersect};

/// The least share of a garment that lies on limbs of one kind for it to hang on the one of which it covers most.
const COVERS: f64 = 0.6;
/// The least share of a hand or a foot that a glove or a boot covers for it to hang on that, however much of the boot lies on the leg.
const FILLS: f64 = 0.5;
/// The most parts of a body that a garment is compared with.
const MAX_COMPARED: usize = 64;

/// What a garment is worn on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wearer {
    Arm,
    Leg,
    Hips,
}

impl Wearer {
    /// What wears a part that is a garment by its name.
    fn of_garment(terms: &[Term]) -> Option<Self> {
        let says = |term| terms.contains(&term);
        let is_of_leg =
            says(Term::Leg) || says(Term::Thigh) || says(Term::Shin) || says(Term::Foot);
        let [one, other] = anatomy::sides(terms);
        match () {
            () if says(Term::Sleeve) => Some(Self::Arm),
            () if says(Term::Worn) && says(Term::Hand) => Some(Self::Arm),
            () if says(Term::Stocking) || says(Term::Worn) && says(Term::Foot) => Some(Self::Leg),
            // A left trouser is that of one leg.
            () if says(Term::HipWear) && (is_of_leg || one != other) => Some(Self::Leg),
            () if says(Term::HipWear) => Some(Self::Hips),
            () => None,
        }
    }

    /// What a part is that can wear something, by its name.
    fn of_body(terms: &[Term]) -> Option<Self> {
        match Role::of(terms)? {
            Role::UpperArm | Role::LowerArm | Role::Hand => Some(Self::Arm),
            Role::Thigh | Role::Shin | Role::Foot => Some(Self::Leg),
            Role::Hips => Some(Self::Hips),
            _ => None,
        }
    }

    /// The least share of a garment that lies on what wears it. A skirt hangs from the hips, which are narrow.
    fn least_share(self) -> f64 {
        match self {
            Self::Arm | Self::Leg => COVERS,
            Self::Hips => 0.0,
        }
    }
}

/// A part that wears something, or that is worn.
struct Named<'a> {
    part: PartId,
    wearer: Wearer,
    sides: [bool; 2],
    /// Whether it is a hand or a foot, or what is worn there.
    is_end: bool,
    outline: &'a Outline,
}

/// Hangs garments on what wears them, unless a string says what they hang on.
pub(super) fn dress(
    context: Context<'_>,
    names: &Names,
    limbs: &Limbs<'_>,
    tree: &mut TiSlice<PartId, Option<PartId>>,
) {
    let (mut garments, mut bodies) = (Vec::new(), Vec::new());
    for part in context.mains() {
        if names.of_part[part].by == NamedBy::Automatic {
            continue;
        }
        let terms = anatomy::terms(names.of(part));
        let garment = Wearer::of_garment(&terms);
        let Some(wearer) = garment.or_else(|| Wearer::of_body(&terms)) else {
            continue;
        };
        let named = Named {
            part,
            wearer,
            sides: anatomy::sides(&terms),
            is_end: matches!(Role::of(&terms), Some(Role::Hand | Role::Foot)),
            outline: limbs.whole(part),
        };
        match garment {
            Some(_) => garments.push(named),
            None => bodies.push(named),
        }
    }
    let boxes = bodies.iter().enumerate();
    let boxes = boxes.filter_map(|(index, body)| Some(indexed_box(bounds(body.outline)?, index)));
    let boxes = BoxTree::bulk_load(boxes.collect());
    let worn = garments.par_iter().map(|garment| {
        let near =
            boxes.locate_in_envelope_intersecting(area_around(bounds(garment.outline)?, 0.0));
        let near = near.map(|found| &bodies[found.data]);
        worn_on(garment, near.filter(|body| fit(garment, body)))
    });
    let worn: Vec<Option<PartId>> = worn.collect();
    for (garment, wearer) in garments.iter().zip(worn) {
        if let Some(wearer) = wearer {
            parents::rehang(context.matched, tree, garment.part, wearer);
        }
    }
}

/// Whether a part may wear a garment by their names.
fn fit(garment: &Named<'_>, body: &Named<'_>) -> bool {
    let is_opposite = garment.sides != body.sides
        && garment.sides[0] != garment.sides[1]
        && body.sides[0] != body.sides[1];
    garment.wearer == body.wearer && !is_opposite
}

/// The part of which a garment covers most, if enough of it lies on parts of this kind; of several the back-most.
fn worn_on<'a>(garment: &Named<'_>, bodies: impl Iterator<Item = &'a Named<'a>>) -> Option<PartId> {
    let mut bodies: Vec<&Named<'_>> = bodies.take(MAX_COMPARED).collect();
    bodies.sort_by_key(|body| body.part);
    let shared = |body: &Named<'_>| area(&intersect(garment.outline, body.outline));
    let shared: Vec<f64> = bodies.iter().map(|body| shared(body)).collect();
    let all: f64 = shared.iter().sum();
    let least = garment.wearer.least_share() * area(garment.outline);
    let bodies = bodies.into_iter().zip(shared).rev();
    let filled = bodies.clone().filter(|(body, shared)| {
        garment.is_end && body.is_end && *shared >= FILLS * area(body.outline)
    });
    let most = |a: &(&Named<'_>, f64), b: &(&Named<'_>, f64)| a.1.total_cmp(&b.1);
    let (body, most) = filled.max_by(most).or_else(|| bodies.max_by(most))?;
    (most > 0.0 && all >= least).then_some(body.part)
}
