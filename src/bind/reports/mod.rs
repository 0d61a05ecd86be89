//! Reports what is known about a drawing only when its strings, attributes and hierarchy are.

mod backgrounds;
mod first_look;
mod idle;
mod legends;
mod located;
mod misplaced;
mod off_page;
mod outlines;
mod size;
mod unbound;
mod uncertain;
mod unseen;

pub(crate) use located::locate;

use super::attributes::PartAttributes;
use super::hierarchy::Tree;
use super::matching::Matched;
use crate::diagnostic::Diagnostic;
use crate::svg::Drawing;

/// All reports.
pub(in crate::bind) fn all(
    drawing: &Drawing,
    matched: &Matched,
    attributes: &PartAttributes,
    tree: &Tree,
) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    misplaced::report(drawing, matched, &mut found);
    unbound::report(drawing, matched, &mut found);
    backgrounds::report(drawing, matched, &mut found);
    legends::unused(drawing, matched, attributes, &mut found);
    idle::without_motion(matched, &mut found);
    idle::without_mark(matched, attributes, tree, &mut found);
    uncertain::report(drawing, matched, &mut found);
    off_page::report(drawing, matched, tree, &mut found);
    outlines::report(drawing, matched, tree, &mut found);
    outlines::lines(drawing, matched, &mut found);
    first_look::report(drawing, matched, tree, &mut found);
    size::report(drawing, matched, tree, &mut found);
    off_page::far_away(drawing, matched, attributes, tree, &mut found);
    unseen::hidden(drawing, matched, &mut found);
    unseen::converted(drawing, &mut found);
    unseen::names(drawing, matched, &mut found);
    found
}
