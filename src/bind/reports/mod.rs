//! Reports what is known about a drawing only when its strings, attributes and hierarchy are.

mod backgrounds;
mod first_look;
mod idle;
mod legends;
mod lettering;
mod located;
mod misplaced;
mod off_page;
mod outlines;
mod size;
mod unbound;
mod uncertain;
mod unseen;

pub(in crate::bind) use first_look::first_look;
pub(in crate::bind) use lettering::lettering;
pub(crate) use located::locate;

use super::attributes::PartAttributes;
use super::hierarchy::Tree;
use super::matching::{Matched, Texts};
use crate::diagnostic::Diagnostic;
use crate::svg::Drawing;

/// All reports but [`first_look`], which needs to know what is too fine to be round.
pub(in crate::bind) fn all(
    drawing: &Drawing,
    texts: Texts,
    matched: &Matched,
    attributes: &PartAttributes,
    tree: &Tree,
) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    misplaced::report(drawing, matched, &mut found);
    unbound::report(drawing, matched, &mut found);
    backgrounds::report(drawing, matched, &mut found);
    legends::unused(drawing, matched, attributes, &mut found);
    idle::without_motion(drawing, matched, &mut found);
    idle::without_mark(matched, attributes, tree, &mut found);
    uncertain::report(drawing, matched, &mut found);
    off_page::report(drawing, matched, tree, &mut found);
    outlines::report(drawing, matched, tree, &mut found);
    outlines::lines(drawing, matched, &mut found);
    size::report(drawing, matched, tree, &mut found);
    off_page::far_away(drawing, matched, attributes, tree, &mut found);
    unseen::hidden(drawing, matched, &mut found);
    unseen::converted(drawing, &mut found);
    if texts == Texts::Strings {
        unseen::names(drawing, matched, &mut found);
    }
    found
}
