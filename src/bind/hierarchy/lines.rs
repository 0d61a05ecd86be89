//! Lines that hold things: a line hangs on what it begins on, and what it leads to hangs on the line if nothing else holds that.

use glam::DVec2;
use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::Context;
use super::names::Names;
use super::parents;
use crate::anatomy::{self, Role, Thing};
use crate::bind::bindings::{PartId, PartKind};
use crate::bind::matching::Hold;
use crate::geometry::{self, Body, Outline, bounds};
use crate::svg::ShapeId;

/// What holds a part, and where, drawing units.
pub(super) type Holder = (PartId, DVec2);

/// A main part that is a line, with what it begins on and what it leads to.
struct Line {
    part: PartId,
    begins: Holder,
    leads_to: Option<Holder>,
}

/// The lines among the main parts that are held. Lines and what holds them do not hold each other in a circle: a line holds no line.
fn lines(context: Context<'_>) -> Vec<Line> {
    let Context { matched, nodes, .. } = context;
    let held = context
        .mains()
        .filter_map(|part| Some((part, matched.parts[part].hold?)));
    let held: Vec<(PartId, Hold)> = held.collect();
    if held.is_empty() {
        return vec![];
    }
    let fills = matched
        .parts
        .iter_enumerated()
        .filter(|(_, part)| !part.is_stroke);
    let fills: FxHashMap<ShapeId, PartId> =
        fills.map(|(index, part)| (part.shape, index)).collect();
    let main = |shape: ShapeId| {
        let main = nodes.main[*fills.get(&shape)?];
        (nodes.kind[main] == PartKind::Main).then_some(main)
    };
    let line = |(part, hold): (PartId, Hold)| {
        let begins = main(hold.by).filter(|main| *main != part)?;
        let leads_to = hold.to.and_then(|(shape, at)| Some((main(shape)?, at)));
        Some(Line {
            part,
            begins: (begins, hold.at),
            leads_to: leads_to.filter(|(to, _)| *to != begins && *to != part),
        })
    };
    held.into_iter().filter_map(line).collect()
}

/// The parts that hold lines, and where, by the main parts that these lines are.
pub(super) fn holders(context: Context<'_>) -> FxHashMap<PartId, Holder> {
    let lines = lines(context).into_iter();
    lines.map(|line| (line.part, line.begins)).collect()
}

/// Hangs on lines what they lead to, if nothing else holds it. A line that begins on what nothing holds, and leads to what is held, is
/// taken the other way round: a string that was drawn from the balloon to the hand.
pub(super) fn hang(
    context: Context<'_>,
    names: &Names,
    tree: &mut TiSlice<PartId, Option<PartId>>,
    holders: &mut FxHashMap<PartId, Holder>,
) {
    let lines = lines(context);
    if lines.iter().all(|line| line.leads_to.is_none()) {
        return;
    }
    let ties = Ties::read(context, names);
    for line in lines {
        let Some(leads_to) = line.leads_to else {
            continue;
        };
        // A string may say what the line hangs on.
        if tree[line.part] != Some(line.begins.0)
            || parents::is_attached(context.matched, line.part)
        {
            continue;
        }
        let ends = [line.begins, leads_to];
        let [begins, leads_to] = ends.map(|(part, _)| ties.firmness(part, tree));
        let [holder, hung] = if leads_to > begins {
            [ends[1], ends[0]]
        } else {
            ends
        };
        let above = parents::chain(tree, holder.0);
        let is_circle = above.is_none_or(|above| above.contains(&hung.0));
        if is_circle || !ties.is_free(hung.0, tree) {
            continue;
        }
        tree[line.part] = Some(holder.0);
        tree[hung.0] = Some(line.part);
        holders.insert(line.part, holder);
        holders.insert(hung.0, (line.part, hung.1));
    }
}

/// What is known of how parts are held, apart from lines.
struct Ties<'a> {
    context: Context<'a>,
    names: &'a Names,
    /// The parts to which strings attach others.
    carrying: FxHashSet<PartId>,
    /// Per main part, the shapes of its node.
    outlines: TiVec<PartId, Vec<&'a Outline>>,
}

impl<'a> Ties<'a> {
    fn read(context: Context<'a>, names: &'a Names) -> Self {
        let Context { matched, nodes, .. } = context;
        let mut outlines = ti_vec![vec![]; matched.parts.len()];
        for (part, main) in matched.parts.iter().zip(&nodes.main) {
            outlines[*main].push(&*part.outline);
        }
        Self {
            context,
            names,
            carrying: parents::carrying(matched, names),
            outlines,
        }
    }

    fn has_string(&self, part: PartId) -> bool {
        self.context.matched.parts[part].string.is_some()
    }

    /// Whether nothing holds a part: no string attaches it, and where it hangs without a string on what is nearest, it does not touch
    /// that. Trunks and scenery hang on nothing.
    fn is_free(&self, part: PartId, tree: &TiSlice<PartId, Option<PartId>>) -> bool {
        let name = self.names.of(part);
        let stands = || {
            let role = Role::of(&anatomy::terms(name));
            role.and_then(Role::trunk).is_some() || anatomy::thing(name) == Some(Thing::Scenery)
        };
        let is_held = |parent| self.has_string(part) || self.touch(part, parent);
        !parents::is_attached(self.context.matched, part)
            && !tree[part].is_some_and(is_held)
            && !stands()
    }

    /// How firmly a part is held; the firmer end of a line holds it.
    fn firmness(&self, part: PartId, tree: &TiSlice<PartId, Option<PartId>>) -> [bool; 3] {
        let is_free = self.is_free(part, tree);
        [
            !is_free,
            self.has_string(part),
            self.carrying.contains(&part),
        ]
    }

    fn touch(&self, one: PartId, other: PartId) -> bool {
        let body = |part: PartId| {
            let outlines = self.outlines[part].clone();
            let all = outlines.iter().filter_map(|outline| bounds(outline));
            let bounds = all.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
            Some(Body {
                outlines,
                bounds,
                slack: 0.0,
            })
        };
        let bodies: Vec<Body<'_>> = [one, other].into_iter().filter_map(body).collect();
        geometry::touching(&bodies)
            .iter()
            .any(|others| !others.is_empty())
    }
}
