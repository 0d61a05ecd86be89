//! The parts that a string can name: as parents, and after `Follow`.

use std::collections::HashSet;

use typed_index_collections::{TiVec, ti_vec};

use super::choice::{Choice, choose};
use super::{Cursor, Proposal, ProposalKind, own_name_of};
use crate::bind::{Bindings, Part, PartId, PartKind};
use crate::lang::quoting::{NamePlace, quoted_if_needed};

impl Cursor<'_> {
    /// The parts that can be the parent of the string's own part, of which `word` is typed, written as names in `place`.
    pub(super) fn parents(&self, word: &str, place: NamePlace) -> Choice<Proposal> {
        let bindings = self.context.analysis.bindings();
        let own = match self.string {
            Some(string) => self.context.analysis.part_of_string(string),
            None => None,
        };
        let carried = own.map_or_else(TiVec::new, |own| descendants_of(bindings, own));
        let is_possible = |index: PartId| !carried.get(index).copied().unwrap_or(false);
        self.parts(word, place, is_possible)
    }

    /// All parts but the string's own, of which `word` is typed, written as arguments.
    pub(super) fn other_parts(&self, word: &str) -> Choice<Proposal> {
        let own = self
            .string
            .and_then(|string| self.context.analysis.part_of_string(string));
        self.parts(word, NamePlace::Argument, |index| Some(index) != own)
    }

    fn parts(
        &self,
        word: &str,
        place: NamePlace,
        is_possible: impl Fn(PartId) -> bool,
    ) -> Choice<Proposal> {
        let bindings = self.context.analysis.bindings();
        let typed = own_name_of(self.text, self.in_desc);
        let parts = bindings.parts.iter_enumerated().filter(|(index, part)| {
            part.kind == PartKind::Main
                && !part.name.is_empty()
                && !part.name.contains('"')
                && typed.as_deref() != Some(part.name.as_str())
                && is_possible(*index)
        });
        let mut parts: Vec<&Part> = parts.map(|(_, part)| part).collect();
        // Parts with names that people gave come first.
        parts.sort_by_key(|part| part.is_automatic());
        let mut seen = HashSet::new();
        parts.retain(|part| seen.insert(part.name.as_str()));
        // Parts are chosen before they are described, since a drawing can have thousands.
        choose(parts, |part| &part.name, word).map(|part| {
            let on = part
                .parent
                .map(|parent| format!("on {}", bindings.parts[parent].name));
            Proposal {
                label: part.name.clone(),
                kind: ProposalKind::Part,
                detail: on.unwrap_or_else(|| "on the root".to_owned()),
                page: None,
                text: self.escape(&quoted_if_needed(&part.name, place)),
                snippet: None,
            }
        })
    }
}

/// For each part whether it is `own` or a descendant of it.
fn descendants_of(bindings: &Bindings, own: PartId) -> TiVec<PartId, bool> {
    let mut children: TiVec<PartId, Vec<PartId>> = ti_vec![vec![]; bindings.parts.len()];
    for (index, part) in bindings.parts.iter_enumerated() {
        if let Some(parent) = part.parent {
            children[parent].push(index);
        }
    }
    let mut carried = ti_vec![false; bindings.parts.len()];
    let mut waiting = vec![own];
    while let Some(part) = waiting.pop() {
        if !std::mem::replace(&mut carried[part], true) {
            waiting.append(&mut children[part]);
        }
    }
    carried
}
