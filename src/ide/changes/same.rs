//! Whether a change that was decided for one text of a drawing still means the same in another one.

use super::{Analysis, Change, Refusal};
use crate::bind::PartId;
use crate::lang::keyword::Keyword;
use crate::source::end_of_tag;

impl Analysis {
    /// Refuses a change that somebody decided while `shown` was shown, if this drawing, which was made of it by changes elsewhere,
    /// has another part of that name, or if what is to be changed was changed there too: that would be lost without a word.
    ///
    /// # Errors
    /// If the change would mean something else, or would undo what others did.
    pub fn still_means(&self, shown: &Self, change: &Change) -> Result<(), Refusal> {
        let Some(part) = change.part() else {
            return Ok(());
        };
        let names = match change {
            Change::Hang {
                parent: Some(parent),
                ..
            } => vec![part, parent],
            _ => vec![part],
        };
        for name in names {
            let (Ok(old), Ok(new)) = (shown.part_to_change(name), self.part_to_change(name)) else {
                // What is not there any more is refused anyway.
                continue;
            };
            if shown.identity(old) != self.identity(new) {
                return Err(Refusal::new(format!(
                    "the drawing was saved by another program, and `{name}` is another shape there now: look at it again"
                )));
            }
        }
        let (Ok(old), Ok(new)) = (shown.part_to_change(part), self.part_to_change(part)) else {
            return Ok(());
        };
        let differs = match change {
            Change::Set { attribute, .. } | Change::Reset { attribute, .. } => {
                let [old, new] = [shown.said(old, *attribute), self.said(new, *attribute)];
                (old != new).then(|| match new {
                    Some(new) => format!("`{}` of `{part}` is `{new}` now", attribute.name()),
                    None => format!("`{}` of `{part}` is no longer said", attribute.name()),
                })
            }
            Change::Hang { .. } => {
                let parent = |analysis: &Self, part: PartId| {
                    let parts = &analysis.bindings().parts;
                    parts[part].parent.map(|parent| parts[parent].name.clone())
                };
                let [old, new] = [parent(shown, old), parent(self, new)];
                (old != new).then(|| match new {
                    Some(new) => format!("`{part}` hangs on `{new}` now"),
                    None => format!("`{part}` hangs on nothing now"),
                })
            }
            Change::Clip { .. } => {
                let [old, new] = [shown.clips_said(old), self.clips_said(new)];
                (old != new).then(|| format!("`{part}` has other clips now"))
            }
            _ => None,
        };
        match differs {
            Some(what) => Err(Refusal::new(format!(
                "the drawing was saved by another program: {what}"
            ))
            .or("Change it all the same", change.clone())),
            None => Ok(()),
        }
    }

    /// What tells a part's element from others: its id, or its tag.
    fn identity(&self, part: PartId) -> (bool, String) {
        let part = &self.bindings().parts[part];
        let element = &self.drawing().shapes[part.shape].element;
        let tag = || {
            let start = element.span.start;
            let end = end_of_tag(&self.source, start).unwrap_or(start);
            self.source[start..end].to_owned()
        };
        (part.is_stroke, element.id.clone().unwrap_or_else(tag))
    }

    /// The value of an attribute that strings say.
    fn said(&self, part: PartId, keyword: Keyword) -> Option<String> {
        let resolved = self.bindings().resolved(self.drawing(), part);
        let found = resolved.into_iter().find(|one| one.keyword == keyword)?;
        found.string.map(|_| found.value)
    }
}
