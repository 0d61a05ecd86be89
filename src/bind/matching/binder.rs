//! The rules by which strings are bound to parts, in their order.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use rayon::prelude::*;
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::leaders::Leaders;
use super::meant::{self, Scope, TextPlace};
use super::nearest::{self, DistanceMode};
use super::node_groups::{self, GroupRole, NodeGroups};
use super::parts::MatchedPart;
use super::said::Said;
use super::settings::BindRule;
use super::stacking::Stacking;
use super::strings::ReadString;
use crate::bind::bindings::{Binding, BoundBy, PartId, StringHolder, StringId};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::Annotation;
use crate::memo::{Bits, Memo};
use crate::svg::{Drawing, GroupId, ShapeId};

/// How often groups are opened for the texts in them: as deep as a person nests groups. Deeper ones stay closed.
const MAX_OPENINGS: usize = 32;

/// A string with the part that it is bound to, and another part that it may mean.
struct Match {
    string: StringId,
    part: PartId,
    runner_up: Option<PartId>,
}

/// What a string is bound to.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bound {
    pub(super) binding: Option<Binding>,
    /// Another part that is almost as near.
    pub(super) runner_up: Option<PartId>,
    /// The container to whose children the string is restricted.
    pub(super) scope: Scope,
}

/// Strings and parts, bound to each other.
pub(super) struct Rules {
    /// Per string.
    pub(super) bound: TiVec<StringId, Bound>,
    pub(super) parts: TiVec<PartId, MatchedPart>,
    pub(super) node_groups: NodeGroups,
    /// How the parts cover each other, if it had to be found out.
    pub(super) stacking: Option<Arc<Stacking>>,
}

/// The state of binding.
pub(super) struct Binder<'a> {
    drawing: &'a Drawing,
    strings: &'a TiSlice<StringId, ReadString>,
    leaders: &'a Leaders,
    memo: &'a Memo,
    diagnostics: &'a mut Vec<Diagnostic>,
    /// Per string.
    bound: TiVec<StringId, Bound>,
    parts: TiVec<PartId, MatchedPart>,
    node_groups: NodeGroups,
    /// How the parts cover each other, once it has been asked for.
    stacking: OnceLock<Arc<Stacking>>,
    /// Per group its back-most part.
    back_most: TiVec<GroupId, Option<PartId>>,
    /// Per shape its first part.
    part_of_shape: TiVec<ShapeId, Option<PartId>>,
}

impl<'a> Binder<'a> {
    pub(super) fn new(
        drawing: &'a Drawing,
        strings: &'a TiSlice<StringId, ReadString>,
        leaders: &'a Leaders,
        mut parts: TiVec<PartId, MatchedPart>,
        node_groups: NodeGroups,
        memo: &'a Memo,
        diagnostics: &'a mut Vec<Diagnostic>,
    ) -> Self {
        let mut back_most: TiVec<GroupId, _> = ti_vec![None; drawing.groups.len()];
        let mut part_of_shape: TiVec<ShapeId, _> = ti_vec![None; drawing.shapes.len()];
        // As with the main part of a node: a line that is drawn before the shapes of its group is an extra of theirs.
        let [fills, lines] = [false, true].map(|is_line| {
            let parts = parts.iter_enumerated();
            parts.filter(move |(_, part)| part.host.is_none() && part.is_stroke == is_line)
        });
        for (index, part) in fills.chain(lines) {
            // If an inner group has a part already, so have the groups around it.
            let chain = node_groups.chain(drawing.shapes[part.shape].group);
            for group in chain
                .take_while(|group| back_most[*group].is_none())
                .collect::<Vec<_>>()
            {
                back_most[group] = Some(index);
            }
            part_of_shape[part.shape].get_or_insert(index);
        }
        node_groups::choose_mains(&node_groups, &mut parts);
        Self {
            drawing,
            strings,
            leaders,
            memo,
            diagnostics,
            bound: ti_vec![Bound::default(); strings.len()],
            parts,
            node_groups,
            stacking: OnceLock::new(),
            back_most,
            part_of_shape,
        }
    }

    /// Binds all strings by the rules, in their order.
    pub(super) fn apply_rules(mut self, rule: BindRule) -> Rules {
        self.descriptions();
        self.groups();
        self.connectors();
        self.texts(rule);
        Rules {
            bound: self.bound,
            parts: self.parts,
            node_groups: self.node_groups,
            stacking: self.stacking.into_inner(),
        }
    }

    /// Rule 1: descriptions belong to their element.
    fn descriptions(&mut self) {
        for string in self.strings.keys() {
            let part = match self.strings[string].holder {
                _ if !self.strings[string].wants_part() => continue,
                StringHolder::Label(_) => continue,
                StringHolder::Shape(shape) => self.part_of_shape[shape],
                StringHolder::Group(group) => match self.node_groups.roles[group] {
                    GroupRole::Transparent => None,
                    _ => self.back_most[group],
                },
            };
            if let Some(part) = part
                && !self.describe_islands(string, part)
            {
                self.bind(string, part, BoundBy::Desc);
            }
        }
    }

    /// Whether a description is that of a shape whose islands are parts, of which a part is the first: then it is about all of them.
    fn describe_islands(&mut self, string: StringId, first: PartId) -> bool {
        let StringHolder::Shape(shape) = self.strings[string].holder else {
            return false;
        };
        // They come one after the other. A shape with an outline has none.
        let is_island = |part: &&mut MatchedPart| part.shape == shape && !part.is_stroke;
        let islands = self.parts.raw[first.into()..].iter_mut();
        let islands: Vec<&mut MatchedPart> = islands.take_while(is_island).collect();
        if islands.len() < 2 {
            return false;
        }
        for island in islands {
            island.described_by = Some(string);
        }
        self.bound[string].binding = Some(Binding {
            part: first,
            by: BoundBy::Desc,
        });
        true
    }

    /// Rule 2: strings in a group belong to the back-most part of the innermost group that holds a part.
    fn groups(&mut self) {
        for string in self.strings.keys() {
            let Some(group) = self
                .waiting_label(string)
                .map(|label| self.drawing.labels[label].1)
            else {
                continue;
            };
            let roles = &self.node_groups.roles;
            let holder = self.node_groups.chain(group).find(|group| {
                roles[*group] == GroupRole::Container
                    || (roles[*group] == GroupRole::Node && self.back_most[*group].is_some())
            });
            match holder {
                Some(group) if roles[group] == GroupRole::Container => {
                    self.bound[string].scope = Some(group);
                }
                Some(group) => {
                    if let Some(part) = self.back_most[group] {
                        self.bind(string, part, BoundBy::Group);
                    }
                }
                None => {
                    self.bound[string].scope = self.node_groups.scope_of_layer(group);
                }
            }
        }
    }

    /// Rule 3: connectors. What other leaders point to is found by rule 4, except for a legend, which may be a sub-part.
    fn connectors(&mut self) {
        let leaders = self.leaders;
        for &(string, shape) in &leaders.connected {
            if self.waiting_label(string).is_some()
                && let Some(part) = self.part_of_shape[shape]
            {
                self.bind(string, part, BoundBy::Leader);
            }
        }
        for string in self.strings.keys() {
            let is_legend = matches!(self.strings[string].annotation, Annotation::Legend(_));
            if let Some(point) = leaders.points.get(&string)
                && is_legend
                && self.waiting_label(string).is_some()
                && let Some(part) = self.stacking().topmost(*point, 1).first()
            {
                self.bind(string, *part, BoundBy::Leader);
            }
        }
    }

    /// Rule 4: every other string belongs to the part that it means. Containers bind their own strings first.
    fn texts(&mut self, rule: BindRule) {
        let leaders = self.leaders;
        let mut waiting: Vec<(Scope, StringId)> = self
            .strings
            .keys()
            .filter(|string| !self.strings[*string].is_of_picture)
            .filter(|string| self.waiting_label(*string).is_some())
            .map(|string| (self.bound[string].scope, string))
            .collect();
        waiting.sort_by_key(|(scope, string)| (scope.is_none(), *scope, *string));
        let free = waiting.split_off(waiting.partition_point(|(scope, _)| scope.is_some()));
        for (strings, is_free) in [(waiting, false), (free, true)] {
            let BindRule::Nearest(mode) = rule else {
                self.meant(strings, is_free);
                continue;
            };
            let has_leader = |(_, string): &(Scope, StringId)| leaders.points.contains_key(string);
            let (with_leader, others) = strings.into_iter().partition(has_leader);
            self.meant(with_leader, is_free);
            self.nearest(&others, is_free, mode);
        }
    }

    /// Binds strings to what they mean, and opens the groups in which several strings mean something.
    fn meant(&mut self, strings: Vec<(Scope, StringId)>, is_free: bool) {
        let leaders = self.leaders;
        if strings.is_empty() {
            return;
        }
        let point = |string: StringId| leaders.points.get(&string).copied();
        let points = |string: StringId| match (point(string), self.strings[string].holder) {
            (Some(point), _) => [point; 3],
            (None, StringHolder::Label(label)) => self.drawing.labels[label].0.position.points,
            (None, StringHolder::Shape(_) | StringHolder::Group(_)) => Default::default(),
        };
        let waiting = strings
            .iter()
            .map(|(_, string)| (*string, points(*string)[1].x));
        let said = Said::read(self.drawing, self.strings, waiting);
        let place = |(scope, string): &(Scope, StringId)| {
            let em = match self.strings[*string].holder {
                StringHolder::Label(label) => self.drawing.labels[label].0.font_size,
                StringHolder::Shape(_) | StringHolder::Group(_) => 0.0,
            };
            TextPlace {
                points: Bits(points(*string).map(|point| point.to_array())),
                em: Bits(if em > 0.0 { em } else { 1.0 }),
                has_leader: point(*string).is_some(),
                scope: *scope,
                sense: said.by(*string),
            }
        };
        let places: Vec<TextPlace> = strings.iter().map(place).collect();
        let stacking = self.stacking();
        for round in 0.. {
            let scope = |part: PartId| self.scope_of(part, is_free);
            let name = |part: PartId| {
                let backgrounds = &self.node_groups.backgrounds;
                said.of_unit(&self.parts[part], backgrounds)
            };
            let meant = meant::find(&places, &stacking, &self.parts, scope, name, self.memo);
            if meant.opened.is_empty() || round == MAX_OPENINGS {
                let pairs = strings.iter().zip(&meant.found);
                let matches = pairs.filter_map(|((_, string), found)| {
                    let (part, runner_up) = (*found)?;
                    Some(Match {
                        string: *string,
                        part,
                        runner_up,
                    })
                });
                let is_led = |string| leaders.points.contains_key(&string);
                self.bind_matches(matches, is_led);
                return;
            }
            self.open(&meant.opened);
        }
    }

    /// Opens the groups of main parts.
    fn open(&mut self, mains: &[PartId]) {
        let mut members: BTreeMap<PartId, Vec<(usize, GroupId)>> = BTreeMap::new();
        for part in &self.parts {
            if mains.binary_search(&part.main).is_ok() {
                let group = self.drawing.shapes[part.shape].group;
                let members = members.entry(part.main).or_default();
                members.push((part.source, group));
            }
        }
        for members in members.values() {
            self.node_groups.open(members);
        }
        node_groups::choose_mains(&self.node_groups, &mut self.parts);
    }

    /// Which strings may name a main part: those of its container, or all outside of containers; `None` if none may.
    fn scope_of(&self, part: PartId, is_free: bool) -> Option<Scope> {
        let MatchedPart { string, source, .. } = self.parts[part];
        let scope = if is_free {
            // Parts in a tile layer are reserved for the strings in it.
            (!self.node_groups.in_layer[source]).then_some(None)
        } else {
            self.node_groups.container[source].map(Some)
        };
        scope.filter(|_| string.is_none())
    }

    fn stacking(&self) -> Arc<Stacking> {
        let read = || {
            let is_scoped = self.bound.iter().any(|bound| bound.scope.is_some());
            stacking(
                self.drawing,
                &self.parts,
                &self.node_groups,
                is_scoped,
                self.memo,
            )
        };
        Arc::clone(self.stacking.get_or_init(read))
    }

    /// Binds strings to their nearest parts, as the paper does.
    fn nearest(&mut self, strings: &[(Scope, StringId)], is_free: bool, mode: DistanceMode) {
        let mut candidates: FxHashMap<Scope, Vec<PartId>> = FxHashMap::default();
        for part in self.parts.keys() {
            if self.parts[part].main == part
                && let Some(scope) = self.scope_of(part, is_free)
            {
                candidates.entry(scope).or_default().push(part);
            }
        }
        let scopes: Vec<&[(Scope, StringId)]> = strings
            .chunk_by(|(one, _), (other, _)| one == other)
            .collect();
        let found: Vec<Vec<Match>> = scopes
            .par_iter()
            .map(|strings| {
                let candidates = candidates.get(&strings[0].0);
                self.matches(strings, candidates.map_or(&[], Vec::as_slice), mode)
            })
            .collect();
        self.bind_matches(found.into_iter().flatten(), |_| false);
    }

    /// Assigns the strings of one scope to their nearest parts.
    fn matches(
        &self,
        strings: &[(Scope, StringId)],
        candidates: &[PartId],
        mode: DistanceMode,
    ) -> Vec<Match> {
        let corner = |(_, string): &(Scope, StringId)| match self.strings[*string].holder {
            StringHolder::Label(label) => self.drawing.labels[label].0.position.corner,
            StringHolder::Shape(_) | StringHolder::Group(_) => glam::DVec2::ZERO,
        };
        let target = |part: &PartId| nearest::Target::of(&self.parts[*part]);
        let problem = nearest::AssignmentProblem {
            corners: strings.iter().map(corner).map(Bits).collect(),
            targets: candidates.iter().map(target).collect(),
            mode,
        };
        let found = (self.memo).get(problem, |problem| Arc::<[_]>::from(problem.solve()));
        let pairs = strings.iter().zip(found.iter());
        pairs
            .filter_map(|((_, string), found)| {
                Some(Match {
                    string: *string,
                    part: candidates[found.target?],
                    runner_up: found.runner_up.map(|runner_up| candidates[runner_up]),
                })
            })
            .collect()
    }

    fn bind_matches(
        &mut self,
        matches: impl Iterator<Item = Match>,
        has_leader: impl Fn(StringId) -> bool,
    ) {
        for Match {
            string,
            part,
            runner_up,
        } in matches
        {
            let by = if has_leader(string) {
                BoundBy::Leader
            } else {
                BoundBy::Nearest
            };
            self.bind(string, part, by);
            self.bound[string].runner_up = runner_up;
        }
    }

    /// The label of a string that still needs a part.
    fn waiting_label(&self, string: StringId) -> Option<usize> {
        let is_bound = self.bound[string].binding.is_some();
        let string = &self.strings[string];
        match string.holder {
            StringHolder::Label(label) if string.wants_part() && !is_bound => Some(label),
            _ => None,
        }
    }

    fn bind(&mut self, string: StringId, part: PartId, by: BoundBy) {
        // Bound in any case, so that it is not reported as unbound too.
        self.bound[string].binding = Some(Binding { part, by });
        if let Some(other) = self.parts[part].attributes_from() {
            let other_span = self.strings[other].text.whole();
            let shape = self.parts[part].shape;
            let element = &self.drawing.shapes[shape].element;
            let message = format!(
                "this string and another one describe the same part, {}",
                self.drawing.describe(shape)
            );
            self.diagnostics.push(
                Diagnostic::new(Code::TwoStrings, self.strings[string].text.whole(), message)
                    .related(other_span, "the other string")
                    .related(element.span, "the part")
                    .help("delete one of them, or move it out of the group"),
            );
            return;
        }
        self.parts[part].string = Some(string);
    }
}

/// How the parts of a drawing cover each other. Ink covers nothing, and parts in a tile layer count only if there are strings for
/// them: if `is_scoped`.
pub(super) fn stacking(
    drawing: &Drawing,
    parts: &TiSlice<PartId, MatchedPart>,
    node_groups: &NodeGroups,
    is_scoped: bool,
    memo: &Memo,
) -> Arc<Stacking> {
    let takes_part = |part: &MatchedPart| {
        part.host.is_none() && (is_scoped || !node_groups.in_layer[part.source])
    };
    Stacking::read(parts, drawing.page, takes_part, memo)
}
