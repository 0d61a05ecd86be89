//! Which parts bend, and how: limbs, necks and tails that are drawn as one shape, and those whose strings say `Bend`.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use super::facings::FigureFacing;
use crate::anatomy::{self, Term};
use crate::bend::{Bend, Centerline};
use crate::bind::{Bindings, Part, PartId, PartKind};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{self, Outline, area, y_up};
use crate::index::par_keys;
use crate::labels::{Class, Label, LimbSegment};
use crate::solid::{self, Placement, Profile};
use crate::svg::Drawing;

/// How many joints a part has that bends all along its length.
const SUPPLE: usize = 4;
/// A garment bends with its parent if at least this share of it lies on that.
const COVERS: f64 = 0.6;
/// A shape of a limb's group belongs to its outline if it has at least this share of the main shape's area.
const OF_OUTLINE: f64 = 0.1;

/// Per main part how it bends; `None` for one that is rigid. A garment over a limb that bends, such as a sleeve, bends with it. `figures` are the drawing's figures.
pub(crate) fn bends(
    drawing: &Drawing,
    bindings: &Bindings,
    figures: &[FigureFacing],
) -> TiVec<PartId, Option<Arc<Bend>>> {
    // Parts of what is no body, such as a machine, are limbs only if they are to move like ones.
    let is_moving = !bindings.clip_requests().is_empty();
    let bodies = figures
        .iter()
        .filter(|figure| figure.has_names || is_moving);
    let labels = bodies.filter(|figure| !figure.found.is_vehicle);
    let labels = labels.flat_map(|figure| &figure.labels);
    // What is spread, such as the legs of a spider, keeps its drawn pose.
    let hanging = labels.filter(|(_, _, is_splayed)| !is_splayed);
    let labels: FxHashMap<PartId, &Label> =
        hanging.map(|(part, label, _)| (*part, label)).collect();
    let parts_of_node = bindings.parts_of_nodes();
    let bend = |index: PartId| {
        let part = &bindings.parts[index];
        if part.kind != PartKind::Main {
            return None;
        }
        let asked = bindings.attributes(index).bend();
        let joints = match asked {
            Some(joints) => joints,
            None if part.parent.is_some() => joints(part, labels.get(&index).copied()),
            None => 0,
        };
        if joints == 0 {
            return None;
        }
        let profile = bindings.profile(drawing, index)?;
        if asked.is_none() && !profile.is_flexible() {
            return None;
        }
        let outline = outline(bindings, index, &parts_of_node[index]);
        let line = Centerline::new(&outline, y_up(part.origin))?;
        if asked.is_none() && !line.is_slender() {
            return None;
        }
        let bend = match joints {
            1 => Bend::limb(line, depth(&profile, part)),
            _ => Bend::chain(line, joints),
        };
        (asked.is_some() || bend.fits()).then(|| Arc::new(bend))
    };
    let own: Vec<_> = par_keys(&bindings.parts).map(bend).collect();
    let mut bends: TiVec<PartId, Option<Arc<Bend>>> = own.into();
    let worn = |index: PartId| {
        let part = &bindings.parts[index];
        let wearer = part.parent.filter(|_| part.kind == PartKind::Main)?;
        let bend = bends[wearer].as_deref()?;
        let attributes = bindings.attributes(index);
        // What has a place of its own in motions, or is held, moves for itself.
        let is_free = labels.contains_key(&index) && !is_worn_on_limbs(&part.name);
        if is_free || attributes.bend().is_some() || attributes.carry().is_some() {
            return None;
        }
        bindings.profile(drawing, index)?;
        let [covering, covered] =
            [index, wearer].map(|part| outline(bindings, part, &parts_of_node[part]));
        let (low, high) = geometry::bounds(&covering)?;
        let rings = covering.rings();
        let points = rings.flatten().map(|point| y_up(*point));
        if bend.is_rigid(high - low) || !bend.bends_at(points) {
            return None;
        }
        let shared = area(&geometry::intersect(&covering, &covered));
        (shared >= COVERS * area(&covering)).then(|| Arc::new(bend.worn()))
    };
    let worn: Vec<_> = par_keys(&bindings.parts).map(worn).collect();
    for (bend, worn) in bends.iter_mut().zip(worn) {
        if worn.is_some() {
            *bend = worn;
        }
    }
    bends
}

/// Whether a part is a garment of limbs by its name.
fn is_worn_on_limbs(name: &str) -> bool {
    let terms = anatomy::terms(name);
    let worn = [Term::Sleeve, Term::Stocking, Term::HipWear, Term::Worn];
    worn.iter().any(|term| terms.contains(term))
}

/// Reports each `Bend` in a string whose part has no joints inside nevertheless. `bends` are those of the main parts.
pub(crate) fn idle_bends(
    drawing: &Drawing,
    bindings: &Bindings,
    bends: &TiSlice<PartId, Option<Arc<Bend>>>,
) -> Vec<Diagnostic> {
    let idle = |(index, part): (PartId, &Part)| {
        if part.kind != PartKind::Main || bends[index].is_some() {
            return None;
        }
        let span = bindings.bend_span(index)?;
        bindings
            .attributes(index)
            .bend()
            .filter(|joints| *joints > 0)?;
        let (reason, help) = if bindings.profile(drawing, index).is_none() {
            (
                "has no solid",
                "delete it, or write `Bend` in the string of the shape that should bend",
            )
        } else {
            (
                "is too short for a joint",
                "draw it longer than it is wide, or delete `Bend`",
            )
        };
        let name = &part.name;
        let message = format!("`Bend` has no effect: `{name}` {reason}");
        Some(Diagnostic::new(Code::IdleBend, span, message).help(help))
    };
    bindings.parts.iter_enumerated().filter_map(idle).collect()
}

/// How many joints a part has inside by its name and by what it is of its figure.
fn joints(part: &Part, label: Option<&Label>) -> usize {
    if anatomy::is_supple(&part.name) {
        return SUPPLE;
    }
    // A wing folds in its own ways, and what is cloth hangs.
    let terms = anatomy::terms(&part.name);
    if terms.contains(&Term::Wing) || part.is_sheet() {
        return 0;
    }
    match label {
        Some(label) if label.segment == LimbSegment::Whole => match label.class {
            Class::Arm | Class::Leg | Class::Neck => 1,
            Class::Tail => SUPPLE,
            Class::Head | Class::Body | Class::Hips => 0,
        },
        _ => 0,
    }
}

/// How far the surface of a part reaches from its plane, drawing units.
fn depth(profile: &Profile, part: &Part) -> f64 {
    let half = DVec2::new(part.measure.half_across, part.measure.half_along);
    let options = solid::Options {
        segments: 1,
        crease: 0.0,
        placement: Placement::default(),
    };
    let depths = profile.depths(half, &options).unwrap_or_default();
    depths.into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// The outline of a part with the larger shapes of its group: a sleeve with its hand.
fn outline(bindings: &Bindings, main: PartId, members: &[PartId]) -> Arc<Outline> {
    let own = &bindings.parts[main].outline;
    let least = OF_OUTLINE * area(own);
    let others = members.iter().filter(|part| **part != main);
    let others = others.map(|part| &bindings.parts[*part]);
    let others = others.filter(|part| part.host.is_none() && area(&part.outline) >= least);
    let mut all: Vec<Outline> = others.map(|part| part.outline.as_ref().clone()).collect();
    if all.is_empty() {
        return Arc::clone(own);
    }
    all.push(own.as_ref().clone());
    Arc::new(geometry::union(&all))
}
