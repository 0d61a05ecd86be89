//! What names do to the forms of parts that no string gives a `Shape`.

use super::bindings::{Bindings, PartId};
use super::matching::ROUNDED;
use crate::svg::Drawing;

/// What a part's name does to its form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FormByName {
    /// It is part of a body: rounded, though it is drawn with straight lines.
    Rounded,
    /// It is a wheel: a disc.
    Disc,
    /// It is cloth: thin.
    Thin,
}

impl Bindings {
    /// What a part's name does to its form.
    pub(crate) fn form_by_name(&self, drawing: &Drawing, part: PartId) -> Option<FormByName> {
        let own = &self.parts[part];
        if own.host.is_some() || self.is_shape_set(part) {
            return None;
        }
        let is_soft = own.is_balloon && !own.is_stroke;
        if own.plate.is_some() && own.stands_in.is_none() {
            Some(FormByName::Disc)
        } else if own.is_balloon && own.is_sheet() {
            Some(FormByName::Thin)
        } else if is_soft && drawing.shapes[own.shape].curved <= ROUNDED {
            Some(FormByName::Rounded)
        } else {
            None
        }
    }
}
