//! Wheels by their names: a wheel is a disc, not a ball.

use glam::DVec2;

use super::hierarchy::Tree;
use super::matching::Matched;
use crate::anatomy;
use crate::geometry::{Outline, bounds_of};

/// How thick a wheel is, as a share of its diameter.
pub(super) const THICKNESS: f64 = 0.35;

/// Makes discs of the wheels that would be inflated because no string says `Shape`. The other shapes of a wheel are plates on it.
pub(super) fn find(matched: &mut Matched, tree: &Tree) {
    if !matched.is_first_look {
        return;
    }
    for (index, part) in matched.parts.iter_mut_enumerated() {
        let main = tree.nodes.main[index];
        // The line of a wheel's rim is a tube.
        if part.is_stroke || !anatomy::is_disc(&tree.names[main].name) {
            continue;
        }
        part.is_balloon = false;
        if main == index {
            part.plate = diameter(&part.outline).map(|diameter| THICKNESS / 2.0 * diameter);
        }
    }
}

/// The diameter of the largest disc of an outline, which may be that of several wheels, drawing units.
pub(super) fn diameter(outline: &Outline) -> Option<f64> {
    let borders = outline.polygons.iter();
    let borders = borders.filter_map(|polygon| polygon.rings.first());
    let sizes = borders.filter_map(|ring| {
        let (low, high) = bounds_of(ring.iter().copied())?;
        Some(DVec2::min_element(high - low))
    });
    sizes.reduce(f64::max).filter(|diameter| *diameter > 0.0)
}
