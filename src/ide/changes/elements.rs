//! The part that an element of the drawing belongs to: what is selected in a drawing program is an element.

use std::collections::BTreeSet;

use super::{Analysis, Refusal};
use crate::bind::{PartId, PartKind, StringHolder, StringId};
use crate::svg::{Element, GroupId, ShapeId};

impl Analysis {
    /// The name of the part that the element with an `id` belongs to: a shape, a text that is its string, or a group. Of a shape that is a
    /// piece of a part, this is the part.
    ///
    /// # Errors
    /// If there is no such element, or it belongs to no part, to several, or to one without a name.
    pub fn part_of_element(&self, id: &str) -> Result<String, Refusal> {
        let (bindings, drawing) = (self.bindings(), self.drawing());
        let is_it = |element: &Element| element.id.as_deref() == Some(id);
        if let Some(shape) = drawing.shapes.position(|shape| is_it(&shape.element)) {
            return self.part_made_of(id, shape);
        }
        let mut labels = drawing.labels.iter();
        if let Some(label) = labels.position(|(label, _)| label.id.as_deref() == Some(id)) {
            let strings = bindings.strings.iter_enumerated();
            let mut strings =
                strings.filter(|(_, string)| string.holder == StringHolder::Label(label));
            let part = strings.find_map(|(string, _)| self.part_of_string(string));
            return part.map_or_else(
                || {
                    Err(Refusal::new(format!(
                        "the text `#{id}` is the string of no part"
                    )))
                },
                |part| self.name_to_change(id, part),
            );
        }
        match drawing.groups.position(|group| is_it(&group.element)) {
            Some(group) => self.part_of_group(id, group),
            None => Err(Refusal::new(format!(
                "there is no visible shape, text or group with the id `{id}`"
            ))),
        }
    }

    fn part_made_of(&self, id: &str, shape: ShapeId) -> Result<String, Refusal> {
        match self.part_of_shape(shape) {
            Some(part) => self.name_to_change(id, part),
            None => Err(Refusal::new(format!(
                "`#{id}` is no part: a guide, a line to a string, or something without an area"
            ))),
        }
    }

    /// The part that a group is or names, or else the only one in it.
    fn part_of_group(&self, id: &str, group: GroupId) -> Result<String, Refusal> {
        let (bindings, drawing) = (self.bindings(), self.drawing());
        let holds =
            |string: StringId| bindings.strings[string].holder == StringHolder::Group(group);
        let element = drawing.groups[group].element.span;
        let mut parts = bindings.parts.iter_enumerated();
        let own = parts.find(|(index, part)| {
            let naming = bindings.naming_element(drawing, *index);
            part.string.is_some_and(holds)
                || naming
                    .is_some_and(|naming| naming.span == element && element.start < element.end)
        });
        if let Some((part, _)) = own {
            return self.name_to_change(id, part);
        }
        let is_inside = |shape: ShapeId| {
            let above = std::iter::successors(Some(drawing.shapes[shape].group), |inner| {
                // The first group contains itself.
                Some(drawing.groups[*inner].parent).filter(|outer| outer != inner)
            });
            above.into_iter().any(|above| above == group)
        };
        let inside = bindings.parts.iter_enumerated();
        let inside: BTreeSet<PartId> = inside
            .filter(|(_, part)| part.kind.is_solid() && is_inside(part.shape))
            .map(|(_, part)| part.main)
            .collect();
        let mut inside = inside.into_iter();
        match (inside.next(), inside.next()) {
            (Some(part), None) => self.name_to_change(id, part),
            (None, _) => Err(Refusal::new(format!(
                "there is no part in the group `#{id}`"
            ))),
            (Some(one), Some(other)) => {
                let named = [one, other].map(|part| bindings.describe(drawing, part));
                let more = if inside.next().is_some() {
                    " and others"
                } else {
                    ""
                };
                Err(Refusal::new(format!(
                    "there are several parts in the group `#{id}`: {}, {}{more}",
                    named[0], named[1]
                )))
            }
        }
    }

    /// The name by which changes speak of a part.
    fn name_to_change(&self, id: &str, index: PartId) -> Result<String, Refusal> {
        let parts = &self.bindings().parts;
        let part = &parts[index];
        let name = match part.kind {
            PartKind::Sub if part.name.is_empty() => &parts[part.main].name,
            _ => &part.name,
        };
        if !name.is_empty() {
            return Ok(name.clone());
        }
        let what = match part.kind {
            PartKind::Legend => {
                "belongs to a legend, which is changed with any part that is painted like it"
            }
            PartKind::Unused => {
                "is left out of the model until the `*` is taken away in the drawing"
            }
            PartKind::Tile => "is drawn in a landscape, and is changed in the drawing",
            PartKind::Region => "is drawn in a view of a character, and is changed in the drawing",
            _ => "is a part without a name: give it one in the drawing first",
        };
        Err(Refusal::new(format!("`#{id}` {what}")))
    }
}
