//! Details: parts without a string stay with the part that they lie on.

use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::{TiVec, ti_vec};

use super::Nodes;
use super::names::{self, Behind};
use crate::anatomy;
use crate::bind::bindings::{PartId, PartKind};
use crate::bind::matching::{Matched, Stacking, of_ink, wants_part};
use crate::lang::ast::Annotation;
use crate::svg::Drawing;

/// What share of a part lies on another for it to stay with that one.
const STAYS: f64 = 0.75;
/// What share of a small part lies on another one for it to stay with that if the rest of it lies on nothing: a whisker, a bow.
const MOSTLY: f64 = 0.5;
/// What share of what a part lies on, of all that it lies on, is enough for it to be said that the rest lies on nothing.
const ALONE: f64 = 0.95;
/// What share of such a part is seen at least. What is covered more lies between parts, as a neck does under a head.
const SEEN: f64 = 0.75;
/// The largest part that stays so, as a share of the area that it lies on. Larger ones may be limbs.
const SMALL: f64 = 0.25;
/// What lies on a cape and is at least this share of it is its lining. Less may be a leg that hangs before it.
const LINING: f64 = 0.4;
/// What share of a part lies on a wheel for it to turn with that: a fork and a mudguard reach out.
const TURNS: f64 = 0.95;

/// The nodes, after main parts without a string became sub-parts of the parts that they lie on. In drawings in which only labels
/// and ids name parts (`by_contact`, or no string is about a part), those names count as well, and so does a name that a string refers
/// to.
pub(super) fn join(
    drawing: &Drawing,
    matched: &Matched,
    mut nodes: Nodes,
    by_contact: bool,
    stacking: &Stacking,
) -> Nodes {
    let mentioned: FxHashSet<&str> = matched
        .strings
        .iter()
        .filter_map(|string| match &string.annotation {
            Annotation::Part(part) => Some(part.parent.as_ref()?.text.as_str()),
            _ => None,
        })
        .collect();
    let is_unread = !matched
        .strings
        .iter()
        .any(|string| wants_part(&string.annotation));
    let counts = |part: PartId| {
        let own = names::of_main_part(drawing, matched, part);
        own.is_some_and(|own| by_contact || is_unread || mentioned.contains(own.name.as_str()))
    };
    let called = |part: PartId| {
        let is_main = nodes.kind[part] == PartKind::Main && counts(part);
        let own = is_main.then(|| names::of_main_part(drawing, matched, part))??;
        let behind = Behind::of(&own.name, &anatomy::terms(&own.name))?;
        Some((part, behind))
    };
    let behind = matched.parts.keys().filter_map(called).collect();
    let mut members: TiVec<PartId, Vec<PartId>> = ti_vec![Vec::new(); matched.parts.len()];
    for (index, part) in matched.parts.iter_enumerated() {
        if stacking.has(index) {
            members[part.main].push(index);
        }
    }
    // In paint order, so that what a part lies on has found its own owner.
    for (main, members) in members.iter_enumerated() {
        let is_free = nodes.kind[main] == PartKind::Main && matched.parts[main].string.is_none();
        if members.is_empty() || !is_free || stacking.is_ground(main) || counts(main) {
            continue;
        }
        let Some(owner) = owner(&nodes, stacking, &behind, members) else {
            continue;
        };
        for &part in members {
            nodes.main[part] = owner;
            if nodes.kind[part] == PartKind::Main {
                nodes.kind[part] = PartKind::Sub;
            }
        }
    }
    for (index, part) in matched.parts.iter_enumerated() {
        if let Some(host) = part.host {
            nodes.main[index] = nodes.main[host];
            nodes.kind[index] = of_ink(nodes.kind[host]);
        }
    }
    nodes
}

/// The main part on which most of a unit lies.
fn owner(
    nodes: &Nodes,
    stacking: &Stacking,
    behind: &FxHashMap<PartId, Behind>,
    members: &[PartId],
) -> Option<PartId> {
    let facts = stacking.of_unit(members);
    let is_before = |main: PartId| {
        behind.get(&main) == Some(&Behind::Cape)
            && facts.area < LINING * stacking.of_part(main).area
    };
    let mut all = 0.0;
    let mut shares: Vec<(PartId, f64)> = Vec::new();
    for &(part, share) in &facts.under {
        let main = nodes.main[part];
        let takes_children = nodes.kind[main] == PartKind::Main;
        if !stacking.is_ground(main) {
            all += share;
        }
        if !takes_children || stacking.is_ground(main) || is_before(main) {
            continue;
        }
        match shares.iter_mut().find(|(other, _)| *other == main) {
            Some((_, sum)) => *sum += share,
            None => shares.push((main, share)),
        }
    }
    let (owner, most) = shares.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let reaches_out = || {
        let is_small = facts.area <= SMALL * stacking.of_part(owner).area;
        let is_seen = facts.shown >= SEEN * facts.area;
        most >= MOSTLY && most >= ALONE * all && is_small && is_seen
    };
    let stays = match behind.get(&owner) {
        Some(Behind::Wheel) => most >= TURNS,
        _ => most >= STAYS || reaches_out(),
    };
    stays.then_some(owner)
}
