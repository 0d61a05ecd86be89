//! Parts of bodies and clothes by their names: they are rounded even where they are drawn with straight lines.

use typed_index_collections::{TiVec, ti_vec};

use super::bindings::PartId;
use super::extents;
use super::hierarchy::Tree;
use super::matching::Matched;
use crate::anatomy::{self, Role, Term};
use crate::geometry::area;
use crate::svg::Drawing;

/// The share of its border that is drawn as curves, at least, of a part of a body that is rounded by itself.
const CURVED: f64 = 0.15;
/// The share of a body that is rounded, by area and without its clothes, from which on all of it is. What is drawn with straight lines
/// alone is meant to have edges only where most of the body has them, as a robot's.
const MOSTLY: f64 = 0.5;

/// Inflates the parts of bodies that would be plates because no string says `Shape` and most of their border is straight: a horse with
/// straight legs; trousers and a jacket below a round head.
pub(super) fn soften(drawing: &Drawing, matched: &mut Matched, tree: &Tree) {
    if !matched.is_first_look {
        return;
    }
    for (index, part) in matched.parts.iter_mut_enumerated() {
        part.is_balloon |= tree.nodes.main[index] == index && goes_round(tree, index);
    }
    let of_body: Vec<PartId> = matched
        .parts
        .keys()
        .filter(|part| tree.nodes.main[*part] == *part && is_of_body(&tree.names[*part].name))
        .collect();
    if of_body.is_empty() {
        return;
    }
    for part in &of_body {
        let part = &mut matched.parts[*part];
        part.is_balloon |= drawing.shapes[part.shape].curved >= CURVED;
    }
    let main = |part: PartId| tree.nodes.main[part];
    let roots = extents::roots(matched.parts.len(), main, |part| tree.parents[part]);
    let terms = |part: PartId| anatomy::terms(&tree.names[part].name);
    let is_clothes = |part: PartId| is_worn(&terms(part));
    // A flat sole is what a figure stands on.
    let is_foot = |part: PartId| Role::of(&terms(part)) == Some(Role::Foot) && !is_clothes(part);
    // Per root the areas of what is rounded and of all of the body below its clothes.
    let mut areas: TiVec<PartId, [f64; 2]> = ti_vec![[0.0; 2]; matched.parts.len()];
    for index in of_body.iter().copied().filter(|part| !is_clothes(*part)) {
        let part = &matched.parts[index];
        let area = area(&part.outline);
        let [rounded, all] = &mut areas[roots[index]];
        *all += area;
        if part.is_balloon {
            *rounded += area;
        }
    }
    for part in of_body.into_iter().filter(|part| !is_foot(*part)) {
        let [rounded, all] = areas[roots[part]];
        matched.parts[part].is_balloon |= all > 0.0 && rounded >= MOSTLY * all;
    }
}

/// Whether a part is a garment that is round about what it hangs on, however straight its border is: a crown, a skirt.
fn goes_round(tree: &Tree, part: PartId) -> bool {
    tree.parents[part].is_some() && anatomy::garment(&tree.names[part].name).is_some()
}

/// Whether a name is that of a part of a body, of clothes, or of hair.
pub(super) fn is_of_body(name: &str) -> bool {
    let terms = anatomy::terms(name);
    let is_part = Role::of(&terms).is_some() || terms.contains(&Term::Hair);
    !terms.contains(&Term::Detail) && (is_part || is_worn(&terms))
}

fn is_worn(terms: &[Term]) -> bool {
    let worn = [Term::BodyWear, Term::HeadWear, Term::HipWear];
    terms.iter().any(|term| worn.contains(term))
}
