//! `okoshi inspect --matches`: the picture of a character's matching.

use std::path::Path;

use super::super::args::{Common, Inspect};
use super::super::loading::{Loaded, resolver};
use super::super::{Outcome, counted, fail};
use crate::disk::{Inputs, Naming};
use crate::render::write_png;
use crate::report::picture_of_matches;

/// Draws the matching of all characters and writes the picture. A drawing with errors gives none.
pub(super) fn draw(loaded: &Loaded, path: &Path, arguments: &Inspect, common: Common) -> Outcome {
    if loaded.compiled.has_errors() {
        if !common.quiet {
            eprintln!("`{}` was not written", path.display());
        }
        return Outcome::Errors;
    }
    let characters = &loaded.compiled.characters;
    if characters.is_empty() {
        return fail(format!(
            "`{}` has no character that is drawn from two sides, so there is nothing to match: put each side into a layer of its own, and write `Boy$View 0 0` in one and `Boy$View 45 0` in the other; `okoshi new fox --template turning` writes an example",
            loaded.path
        ));
    }
    let Some(picture) = picture_of_matches(characters) else {
        return fail(format!(
            "`{}` has too many views for one picture of their matching",
            loaded.path
        ));
    };
    let resolver = resolver(&arguments.drawing, &arguments.reading);
    let inputs = Inputs::of(&arguments.drawing).linking(loaded.linked(&resolver));
    let written = inputs
        .target(path, Naming::Given)
        .and_then(|target| target.write(|out| write_png(&picture, out)));
    if let Err(error) = written {
        return fail(error);
    }
    if !common.quiet {
        let regions = characters.iter().map(|character| character.regions.len());
        let alone = characters
            .iter()
            .map(|character| character.matching.unmatched.len());
        eprintln!(
            "wrote {}: {} × {} pixels, {}, {} without a partner",
            path.display(),
            picture.width(),
            picture.height(),
            counted(regions.sum(), "region"),
            alone.sum::<usize>()
        );
    }
    Outcome::Done
}
