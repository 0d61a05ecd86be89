//! Parts of bodies by their names: they are rounded even where they are drawn with straight lines.

use super::bindings::PartId;
use super::hierarchy::Tree;
use super::matching::Matched;
use crate::anatomy::{self, Role, Term};
use crate::svg::Drawing;

/// The share of its border that is drawn as curves, at least, of a part of a body that is inflated. What is drawn with straight lines
/// alone is meant to have edges.
const CURVED: f64 = 0.15;

/// Inflates the parts of bodies that would be plates because no string says `Shape` and most of their border is straight: trousers,
/// a horse with straight legs.
pub(super) fn soften(drawing: &Drawing, matched: &mut Matched, tree: &Tree) {
    if !matched.is_first_look {
        return;
    }
    for (index, part) in matched.parts.iter_mut_enumerated() {
        let is_main = tree.nodes.main[index] == index;
        part.is_balloon = part.is_balloon
            || is_main
                && (is_worn(tree, index)
                    || drawing.shapes[part.shape].curved >= CURVED
                        && is_of_body(&tree.names[index].name));
    }
}

/// Whether a part is a garment that is round about what it hangs on, however straight its border is: a crown, a skirt.
fn is_worn(tree: &Tree, part: PartId) -> bool {
    tree.parents[part].is_some() && anatomy::garment(&tree.names[part].name).is_some()
}

/// Whether a name is that of a part of a body, or of clothes.
fn is_of_body(name: &str) -> bool {
    let terms = anatomy::terms(name);
    let is_worn = |term: &Term| matches!(term, Term::BodyWear | Term::HeadWear | Term::HipWear);
    !terms.contains(&Term::Detail) && (Role::of(&terms).is_some() || terms.iter().any(is_worn))
}
