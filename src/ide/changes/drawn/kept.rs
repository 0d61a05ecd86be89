//! Whether a change of what is drawn did what it says, and left everything else what it was.

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::{places::Places, step};
use crate::bind::{Part, PartId, PartKind, StringId};
use crate::diagnostic::Edit;
use crate::ide::Subject;
use crate::ide::changes::{Analysis, Change, Refusal, check::no_worse, described};
use crate::lang::keyword::Keyword;

/// What tells a part in a text: where its element begins, whether it is the stroke of that, and its number among what the element draws.
type Key = (usize, bool, usize);

/// A drawing before and after a change, and which parts are the same in both.
struct Pair<'a> {
    before: &'a Analysis,
    after: &'a Analysis,
    places: Places<'a>,
    /// Per part its place in the text before.
    old: Vec<Key>,
    /// The parts by their places in the text after.
    new: FxHashMap<Key, PartId>,
}

/// The name that the part of a change has after it; `None` if there is no such part.
pub(in crate::ide::changes) fn part_after(
    before: &Analysis,
    after: &Analysis,
    change: &Change,
    edits: &[Edit],
) -> Option<String> {
    let pair = Pair::new(before, after, edits);
    let part = match change {
        Change::Draw { .. } => pair.drawn(edits)?,
        change => pair.after(before.drawn_part(change.part()?).ok()?.0)?,
    };
    let part = Subject::of_part(&after.compiled, part)?;
    Some(part.name().to_owned())
}

/// Compares a drawing before and after a change of what is drawn: strings mean what they meant, and parts that a person named are called
/// so. What nobody has named is found by rule, and may come to hang elsewhere; then the answer says so.
///
/// # Errors
/// If there are new errors, or something else has changed.
pub(in crate::ide::changes) fn check(
    before: &Analysis,
    after: &Analysis,
    change: &Change,
) -> Result<Option<String>, Refusal> {
    no_worse(before, after)?;
    let edits = super::super::edits(before, change)?;
    let pair = Pair::new(before, after, &edits);
    let own = match change.part() {
        Some(name) => Some(before.drawn_part(name)?.0),
        None => None,
    };
    pair.strings_mean_the_same(own, change)?;
    let mut moved = 0;
    let mut elsewhere = 0;
    for (index, old) in before.bindings().parts.iter_enumerated() {
        let is_own = own.is_some_and(|own| before.is_of(index, own));
        let Some(part) = pair.after(index) else {
            if is_own && matches!(change, Change::Erase { .. }) {
                continue;
            }
            return Err(pair.would(index, "no longer be a part"));
        };
        let new = &after.bindings().parts[part];
        pair.is_the_same(index, old, new)?;
        if !is_own {
            pair.says_the_same(index, part)?;
            moved += usize::from(!pair.lies_so(old, new, DVec2::ZERO));
        }
        let parent = old.parent.and_then(|parent| pair.after(parent));
        let stays = parent == new.parent || old.parent.is_some() && parent.is_none();
        elsewhere += usize::from(old.kind == PartKind::Main && !stays);
    }
    pair.did_it(change, own, &edits)?;
    let name = change.part().unwrap_or("it");
    Ok(match (moved, elsewhere) {
        (0, 0) => None,
        (0, 1) => Some("1 part hangs elsewhere now, because nobody has said on what".to_owned()),
        (0, count) => Some(format!(
            "{count} parts hang elsewhere now, because nobody has said on what"
        )),
        (1, _) => Some(format!("its clone goes with `{name}`")),
        (count, _) => Some(format!("{count} clones go with `{name}`")),
    })
}

impl<'a> Pair<'a> {
    fn new(before: &'a Analysis, after: &'a Analysis, edits: &'a [Edit]) -> Self {
        let old = keys(before);
        let new = keys(after).into_iter().enumerate();
        let new = new.map(|(index, key)| (key, PartId::from(index)));
        Self {
            before,
            after,
            places: Places::new(before.source(), edits),
            old,
            new: new.collect(),
        }
    }

    /// The same part afterwards.
    fn after(&self, part: PartId) -> Option<PartId> {
        let (start, is_stroke, number) = self.old[usize::from(part)];
        let start = self.places.after(start)?;
        self.new.get(&(start, is_stroke, number)).copied()
    }

    /// The part that was drawn.
    fn drawn(&self, edits: &[Edit]) -> Option<PartId> {
        let edit = edits.first()?;
        let start = self.places.start_of(edit);
        let drawn = start..start + edit.text.len();
        let new = self.new.iter();
        let mut new = new.filter(|((at, ..), _)| drawn.contains(at));
        new.next().map(|(_, part)| *part)
    }

    /// A refusal that says what would become of a part of the drawing before.
    fn would(&self, part: PartId, what: &str) -> Refusal {
        let name = self.before.bindings().describe(self.before.drawing(), part);
        Refusal::new(format!("{name} would {what}"))
    }

    fn strings_mean_the_same(&self, own: Option<PartId>, change: &Change) -> Result<(), Refusal> {
        let (old, new) = (self.before.bindings(), self.after.bindings());
        let start_of = |analysis: &Analysis, string: StringId| {
            analysis.bindings().strings[string].text.whole().start
        };
        let found: FxHashMap<usize, StringId> = new
            .strings
            .keys()
            .map(|string| (start_of(self.after, string), string))
            .collect();
        for (index, string) in old.strings.iter_enumerated() {
            let bound = string.binding.map(|binding| binding.part);
            let start = self.places.after(start_of(self.before, index));
            let now = start.and_then(|start| found.get(&start));
            let is_own = bound.zip(own);
            let is_own = is_own.is_some_and(|(part, own)| self.before.is_of(part, own));
            let is_same = match now {
                None => is_own && matches!(change, Change::Erase { .. }),
                Some(now) => {
                    let now = new.strings[*now].binding.map(|binding| binding.part);
                    now == bound.and_then(|part| self.after(part))
                }
            };
            if !is_same {
                let way = match change {
                    Change::Draw { .. } => "draw it farther from that text",
                    Change::Move { .. } => "move it elsewhere, or move the text first",
                    Change::Erase { .. } => "delete both in the program that drew them",
                    _ => "move the text onto its shape first",
                };
                let text = string.text.as_str().trim();
                return Err(Refusal::new(format!(
                    "the text `{text}` would mean another shape then, or none: {way}"
                )));
            }
        }
        Ok(())
    }

    fn is_the_same(&self, index: PartId, old: &Part, new: &Part) -> Result<(), Refusal> {
        let has_node = |part: &Part| matches!(part.kind, PartKind::Main | PartKind::Sub);
        // What has no name is by rule a part of its own, or belongs to what it lies on.
        let is_named = !old.is_automatic() && !old.name.is_empty();
        if old.kind != new.kind {
            let is_by_rule = has_node(old) && has_node(new) && !is_named;
            let what = match new.kind {
                PartKind::Sub => "belong to the part that it lies on then: leave more of it beside that, or write a string for it".to_owned(),
                kind => format!("be {} then", described(kind)),
            };
            return if is_by_rule {
                Ok(())
            } else {
                Err(self.would(index, &what))
            };
        }
        if is_named && old.name != new.name {
            return Err(self.would(index, &format!("be called `{}`", new.name)));
        }
        Ok(())
    }

    /// Whether strings say the same of a part as before.
    fn says_the_same(&self, old: PartId, new: PartId) -> Result<(), Refusal> {
        let said = |analysis: &Analysis, part: PartId| -> Vec<(Keyword, String)> {
            let resolved = analysis.bindings().resolved(analysis.drawing(), part);
            let said = resolved.into_iter().filter(|one| one.string.is_some());
            said.map(|one| (one.keyword, one.value)).collect()
        };
        if said(self.before, old) == said(self.after, new) {
            return Ok(());
        }
        Err(self.would(old, "get other attributes"))
    }

    /// Whether a part lies where it did, or so far from there.
    fn lies_so(&self, old: &Part, new: &Part, by: DVec2) -> bool {
        let near = |old: DVec2, new: DVec2| {
            (new - old - by).abs().max_element() <= 2.0 * step(self.before.drawing())
        };
        let (old, new) = (old.measure.bounds, new.measure.bounds);
        near(old.0, new.0) && near(old.1, new.1)
    }

    /// Whether the drawing shows what the change is about.
    fn did_it(&self, change: &Change, own: Option<PartId>, edits: &[Edit]) -> Result<(), Refusal> {
        let new = |part: PartId| Some(&self.after.bindings().parts[self.after(part)?]);
        let pair = own.and_then(|part| Some((&self.before.bindings().parts[part], new(part)?)));
        match (change, pair) {
            (Change::Draw { .. }, _) => {
                let drawn = self
                    .drawn(edits)
                    .map(|part| &self.after.bindings().parts[part]);
                let is_drawn =
                    drawn.is_some_and(|part| matches!(part.kind, PartKind::Main | PartKind::Sub));
                match (is_drawn, drawn) {
                    (true, _) => Ok(()),
                    (false, Some(part)) => Err(Refusal::new(format!(
                        "the shape would be {}: draw it elsewhere, or in another colour",
                        described(part.kind)
                    ))),
                    (false, None) => Err(Refusal::new(
                        "nothing of the shape would be seen: the layer that it is drawn on is clipped or translucent",
                    )),
                }
            }
            (Change::Move { by, .. }, Some((old, new)))
                if !self.lies_so(old, new, DVec2::from(*by)) =>
            {
                Err(Refusal::new(format!(
                    "`{}` would not go where it should, because something else in the drawing places it: move it in the program that drew it",
                    change.part().unwrap_or_default()
                )))
            }
            (Change::Paint { part, fill }, Some((_, new))) => {
                let [r, g, b] = new.paint(self.after.drawing()).color;
                if fill.eq_ignore_ascii_case(&format!("#{r:02x}{g:02x}{b:02x}")) {
                    return Ok(());
                }
                Err(Refusal::new(format!(
                    "`{part}` would not get this colour: a clone is painted as its original, and a style sheet may say otherwise"
                )))
            }
            _ => Ok(()),
        }
    }
}

/// Per part what tells it in the text.
fn keys(analysis: &Analysis) -> Vec<Key> {
    let mut seen: FxHashMap<(usize, bool), usize> = FxHashMap::default();
    let parts = analysis.bindings().parts.iter();
    let keys = parts.map(|part| {
        let start = analysis.drawing().shapes[part.shape].element.span.start;
        let number = seen.entry((start, part.is_stroke)).or_default();
        *number += 1;
        (start, part.is_stroke, *number)
    });
    keys.collect()
}
