//! Which shape a text means: the one that its beginning, middle or end lies on or is nearest to, all texts together.

mod units;
mod words;

use std::sync::Arc;

use glam::DVec2;
use rustc_hash::FxHashMap;
use typed_index_collections::TiSlice;

use super::nearest::{AssignmentProblem, DistanceMode, Target};
use super::parts::MatchedPart;
use super::stacking::Stacking;
use crate::assignment::{self, Assignment};
use crate::bind::bindings::PartId;
use crate::memo::{Bits, Memo};
use units::{Candidate, Candidates, Units};
pub(in crate::bind::matching) use units::{Scope, TextPlace, UnitName};
use words::NEVER;
pub(in crate::bind::matching) use words::{Sense, Topic, said_side};

/// How many of the nearest units a text can have at first.
const NEAREST: usize = 8;
/// How much cheaper, in font sizes, a group of another text must be for it to be opened.
const OPENS: f64 = 2.0;
/// What it costs to leave a text without a unit: more than any unit may cost in sum with what it displaces.
const UNBOUND: f64 = 1e7;
/// How many candidates all texts have at most; where more texts compete for the units in one place, the rest get the nearest free ones.
const MAX_CANDIDATES: usize = 1 << 15;
/// A binding is uncertain if all texts together would cost less than this more without it, font sizes.
const UNCERTAIN: f64 = 0.6;
/// How much more certain a binding is for each point of the text at which the unit shows.
const SHOWS: f64 = 0.5;

/// The units of some texts.
#[derive(Debug, Default)]
pub(super) struct Meant {
    /// Per text the main part of what it means, and of what it means if it does not mean that.
    pub(super) found: Vec<Option<(PartId, Option<PartId>)>>,
    /// Main parts of groups that several texts mean, each text something in them.
    pub(super) opened: Vec<PartId>,
}

/// Finds what texts mean, by an assignment whose rows are the texts and whose columns are the units. `scope` tells for a main part which texts may mean its unit.
pub(super) fn find(
    texts: &[TextPlace],
    stacking: &Arc<Stacking>,
    parts: &TiSlice<PartId, MatchedPart>,
    scope: impl Fn(PartId) -> Option<Scope>,
    name: impl Fn(PartId) -> UnitName,
    memo: &Memo,
) -> Meant {
    let units = Units::read(stacking, parts, scope, name, memo);
    let counts = units.count_by_scope();
    let count = |text: usize| counts.get(&texts[text].scope).copied().unwrap_or(0);
    let mut wanted = vec![NEAREST; texts.len()];
    let (candidates, assignment) = loop {
        let each = texts.iter().copied().zip(wanted.iter().copied());
        let candidates = units.candidates(each, memo);
        let costs = |text: usize| {
            let candidates = candidates[text].iter();
            candidates.map(|candidate| (candidate.unit(), candidate.cost))
        };
        let assignment = assignment::cheapest(texts.len(), units.units.len(), UNBOUND, costs);
        let mut sum: usize = wanted.iter().sum();
        let mut widened = false;
        for (text, unit) in assignment.column_of.iter().enumerate() {
            let cost = || candidate(&candidates[text], (*unit)?).map(|found| found.cost);
            let lacks = cost().is_none_or(|cost| cost >= NEVER / 2.0);
            if lacks && wanted[text] < count(text) && sum < MAX_CANDIDATES {
                sum += wanted[text];
                wanted[text] *= 2;
                widened = true;
            }
        }
        if !widened {
            break (candidates, assignment);
        }
    };
    let mut assignment = assignment;
    share_out_rest(texts, &units, parts, &mut assignment);
    let main = |unit: usize| units.units[unit].main;
    let found = assignment.column_of.iter().enumerate();
    let found = found.map(|(text, unit)| {
        let rival = rival(&candidates, &assignment, text);
        unit.map(|unit| (main(unit), rival.map(main)))
    });
    let opened = opened(&candidates, &assignment, &units);
    Meant {
        found: found.collect(),
        opened: opened.into_iter().map(main).collect(),
    }
}

/// Gives texts without a unit the nearest free ones, nearest pairs first.
fn share_out_rest(
    texts: &[TextPlace],
    units: &Units,
    parts: &TiSlice<PartId, MatchedPart>,
    assignment: &mut Assignment,
) {
    // In the order of their first texts.
    let mut rest: Vec<(Scope, Vec<usize>)> = Vec::new();
    let mut places: FxHashMap<Scope, usize> = FxHashMap::default();
    for (text, unit) in assignment.column_of.iter().enumerate() {
        if unit.is_none() {
            let scope = texts[text].scope;
            let place = *places.entry(scope).or_insert(rest.len());
            if place == rest.len() {
                rest.push((scope, Vec::new()));
            }
            rest[place].1.push(text);
        }
    }
    for (scope, rest) in rest {
        let is_free = |unit: &usize| {
            units.units[*unit].scope == Some(scope) && assignment.row_of[*unit].is_none()
        };
        let free: Vec<usize> = (0..units.units.len()).filter(is_free).collect();
        let target = |unit: &usize| Target::of(&parts[units.units[*unit].main]);
        let middle = |text: &usize| Bits(DVec2::from(texts[*text].points.0[1]));
        let problem = AssignmentProblem {
            corners: rest.iter().map(middle).collect(),
            targets: free.iter().map(target).collect(),
            mode: DistanceMode::Center,
        };
        for (text, found) in rest.iter().zip(problem.solve()) {
            if let Some(unit) = found.target.map(|target| free[target]) {
                assignment.column_of[*text] = Some(unit);
                assignment.row_of[unit] = Some(*text);
            }
        }
    }
}

/// A unit among those that a text can have.
fn candidate(candidates: &Candidates, unit: usize) -> Option<&Candidate> {
    candidates.iter().find(|candidate| candidate.unit() == unit)
}

fn cheapest<'a>(candidates: impl Iterator<Item = &'a Candidate>) -> Option<&'a Candidate> {
    candidates.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// The unit that a text would have if it could not have its own, if all texts together would hardly cost more: the text that
/// has that one may take any other, but none beyond that is displaced.
fn rival(candidates: &[Candidates], assignment: &Assignment, text: usize) -> Option<usize> {
    let own = candidate(&candidates[text], assignment.column_of[text]?)?;
    let increase = |rival: &Candidate| {
        let displaced = assignment.row_of[rival.unit()].map_or(0.0, |other| {
            let costs = &candidates[other];
            let can_have = |candidate: &&Candidate| {
                candidate.unit() == own.unit() || assignment.row_of[candidate.unit()].is_none()
            };
            let next = cheapest(costs.iter().filter(can_have));
            let now = candidate(costs, rival.unit());
            let [next, now] =
                [next, now].map(|found| found.map_or(f64::INFINITY, |found| found.cost));
            next - now
        });
        rival.cost - own.cost + displaced
    };
    let others = candidates[text].iter();
    let others = others.filter(|candidate| candidate.unit() != own.unit());
    let (unit, least) = others
        .map(|rival| (rival.unit(), increase(rival)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    (least + SHOWS * f64::from(own.shows_at) < UNCERTAIN).then_some(unit)
}

/// The groups that texts want which other texts have, and want so much more than what they got that they mean something in
/// the group.
fn opened(candidates: &[Candidates], assignment: &Assignment, units: &Units) -> Vec<usize> {
    let mut opened = Vec::new();
    for (text, candidates) in candidates.iter().enumerate() {
        let Some(best) = cheapest(candidates.iter()) else {
            continue;
        };
        let has = assignment.column_of[text].and_then(|unit| candidate(candidates, unit));
        let has = has.map_or(f64::INFINITY, |has| has.cost);
        let is_taken = assignment.row_of[best.unit()].is_some_and(|other| other != text);
        let is_group = units.units[best.unit()].members.len() > 1;
        if is_group && is_taken && has >= best.cost + OPENS {
            opened.push(best.unit());
        }
    }
    opened.sort_unstable();
    opened.dedup();
    opened
}
