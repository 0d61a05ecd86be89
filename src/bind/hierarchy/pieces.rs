//! Limbs in pieces: where upper arm, forearm and hand are siblings in one named group, they hang on each other from the trunk outward.

use std::collections::BTreeMap;

use typed_index_collections::TiSlice;

use super::names::Names;
use super::{Context, parents};
use crate::anatomy::{self, Role};
use crate::bind::bindings::{NamedBy, PartId};
use crate::bind::names::of_element;
use crate::svg::GroupId;

/// The pieces of one kind in one group: by what their names say of left and right.
#[derive(Default)]
struct Pieces([Vec<PartId>; 4]);

impl Pieces {
    fn of_sides(&mut self, sides: [bool; 2]) -> &mut Vec<PartId> {
        &mut self.0[place(sides)]
    }

    /// The piece on this side, if there is only one: that whose name says the side, else the only one whose name does not say the other.
    fn only(&self, sides: [bool; 2]) -> Option<PartId> {
        let own = &self.0[place(sides)];
        if let [only] = own.as_slice() {
            return Some(*only);
        }
        let other = place([sides[1], sides[0]]);
        let is_sided = sides[0] != sides[1];
        let fitting = self.0.iter().enumerate();
        let fitting = fitting.filter(|(place, _)| !(is_sided && *place == other));
        let mut fitting = fitting.flat_map(|(_, parts)| parts);
        match (fitting.next(), fitting.next()) {
            (Some(only), None) => Some(*only),
            _ => None,
        }
    }
}

fn place([left, right]: [bool; 2]) -> usize {
    usize::from(left) + 2 * usize::from(right)
}

/// Hangs the pieces of limbs that are siblings in a named group on each other, whatever they touch.
pub(super) fn chain(
    context: Context<'_>,
    names: &Names,
    tree: &mut TiSlice<PartId, Option<PartId>>,
) {
    let mut pieces: Vec<(PartId, GroupId, Role, [bool; 2])> = Vec::new();
    for part in context.mains() {
        if names.of_part[part].by == NamedBy::Automatic {
            continue;
        }
        let terms = anatomy::terms(names.of(part));
        let role = Role::of(&terms).filter(|role| role.is_piece_of_limb());
        if let Some((role, group)) = role.and_then(|role| Some((role, named_group(context, part)?)))
        {
            pieces.push((part, group, role, anatomy::sides(&terms)));
        }
    }
    let mut siblings: BTreeMap<(GroupId, Role), Pieces> = BTreeMap::new();
    for (part, group, role, sides) in &pieces {
        let of_role = siblings.entry((*group, *role)).or_default();
        of_role.of_sides(*sides).push(*part);
    }
    // From the trunk outward, so that what hangs on its carrier already stays there.
    pieces.sort_by_key(|(part, _, role, _)| (*role, *part));
    for (part, group, role, sides) in pieces {
        let carriers = role
            .carriers()
            .iter()
            .filter(|role| role.is_piece_of_limb());
        let mut carriers = carriers.filter_map(|role| siblings.get(&(group, *role)));
        if let Some(carrier) = carriers.find_map(|carriers| carriers.only(sides)) {
            parents::rehang(context.matched, tree, part, carrier);
        }
    }
}

/// The nearest group around a part to which a person gave a name; its own group is the part itself.
fn named_group(context: Context<'_>, part: PartId) -> Option<GroupId> {
    let Context {
        drawing, matched, ..
    } = context;
    let part = &matched.parts[part];
    let mut group = match part.node_group {
        Some(own) => drawing.groups[own].parent,
        None => drawing.shapes[part.shape].group,
    };
    while group != GroupId::ROOT {
        let element = &drawing.groups[group].element;
        if of_element(element, None).is_some() {
            return Some(group);
        }
        group = drawing.groups[group].parent;
    }
    None
}
