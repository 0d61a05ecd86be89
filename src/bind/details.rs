//! Details: parts without a string stay with the part that they lie on (figure.md, Binding, rule 5).

use rustc_hash::FxHashSet;

use super::bindings::{Bindings, PartKind};
use super::ink;
use super::names;
use super::stacking::Stacking;
use crate::lang::ast::Annotation;
use crate::svg::Drawing;

/// What share of a part lies on another for it to stay with that one.
const STAYS: f64 = 0.75;

/// Makes main parts without a string sub-parts of the parts that they lie on. In drawings in which only labels and ids name parts,
/// those names count as well, and so does a name that a string refers to.
pub(super) fn join(drawing: &Drawing, bindings: &mut Bindings, stacking: &Stacking) {
    let mentioned: FxHashSet<String> = bindings
        .strings
        .iter()
        .filter_map(|string| match &string.annotation {
            Annotation::Part(part) => Some(part.parent.as_ref()?.text.clone()),
            _ => None,
        })
        .collect();
    let counts = |bindings: &Bindings, part: usize| {
        let own = names::of_part(drawing, bindings, part);
        own.is_some_and(|own| bindings.hierarchy_by_contact || mentioned.contains(&own.name))
    };
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); bindings.parts.len()];
    for (index, part) in bindings.parts.iter().enumerate() {
        if stacking.has(index) {
            members[part.main].push(index);
        }
    }
    // In paint order, so that what a part lies on has found its own owner.
    for (main, members) in members.iter().enumerate() {
        let part = &bindings.parts[main];
        let is_free = part.kind == PartKind::Main && part.string.is_none();
        if members.is_empty() || !is_free || stacking.is_ground(main) || counts(bindings, main) {
            continue;
        }
        let Some(owner) = owner(bindings, stacking, members) else {
            continue;
        };
        for &part in members {
            let part = &mut bindings.parts[part];
            part.main = owner;
            if part.kind == PartKind::Main {
                part.kind = PartKind::Sub;
            }
        }
    }
    ink::follow(bindings);
}

/// The main part on which most of a unit lies.
fn owner(bindings: &Bindings, stacking: &Stacking, members: &[usize]) -> Option<usize> {
    let facts = stacking.of_unit(members);
    let mut shares: Vec<(usize, f64)> = Vec::new();
    for &(part, share) in &facts.under {
        let main = bindings.parts[part].main;
        let takes_children = bindings.parts[main].kind == PartKind::Main;
        if !takes_children || stacking.is_ground(main) {
            continue;
        }
        match shares.iter_mut().find(|(other, _)| *other == main) {
            Some((_, sum)) => *sum += share,
            None => shares.push((main, share)),
        }
    }
    let most = shares.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (most.1 >= STAYS).then_some(most.0)
}
