//! Changes that a panel of the client asks for. The client applies their edits to its text, so that its own undo takes them back;
//! nothing is written here.

use std::sync::Arc;

use ls_types::TextEdit;
use serde_json::{Value, json};

use super::document::{Analyzed, Document};
use crate::compile::{Options, compile};
use crate::export::{self, GLB};
use crate::ide::Analysis;
use crate::ide::changes::{Change, Possible, Refusal, possible};
use crate::resolver::Resolver;

/// What can be changed about a part, or why there is nothing; `motions` are the motion files in the drawing's folder.
pub(crate) fn form(analyzed: &Analyzed, part: &str, motions: Vec<String>) -> Value {
    match analyzed.analysis.form(part) {
        Ok(form) => json!({ "form": form.with_motion_files(motions) }),
        Err(refusal) => refused(&refusal),
    }
}

/// The edits of the text that make a change, and the version that they are for.
pub(crate) fn change(analyzed: &Analyzed, change: &Change, resolver: &dyn Resolver) -> Value {
    match wanted(analyzed, change, resolver) {
        Ok(Possible {
            edits, part, note, ..
        }) => {
            let Document {
                positions, version, ..
            } = &*analyzed.document;
            let edits = edits.into_iter().map(|edit| TextEdit {
                range: positions.range(edit.span),
                new_text: edit.text,
            });
            let edits: Vec<_> = edits.collect();
            json!({ "version": version, "edits": edits, "part": part, "note": note })
        }
        Err(refusal) => refused(&refusal),
    }
}

/// A model of what a change would make of the drawing, as binary glTF; `None` if the change would be refused, or changes
/// nothing.
pub(crate) fn attempt(
    analyzed: &Analyzed,
    change: &Change,
    resolver: &dyn Resolver,
) -> Option<Vec<u8>> {
    let after = wanted(analyzed, change, resolver).ok()?.after?;
    let model = export::to_memory(&GLB, &after.compiled().scene, None).ok()?;
    Some(model.bytes)
}

/// What a change makes of a copy of the text.
fn wanted(
    before: &Analyzed,
    change: &Change,
    resolver: &dyn Resolver,
) -> Result<Possible, Refusal> {
    possible(&before.analysis, change, |text| {
        let compiled = compile(text, &Options::default(), resolver);
        Arc::new(Analysis::new(text, compiled))
    })
}

fn refused(Refusal { why, choices }: &Refusal) -> Value {
    json!({ "refused": { "why": why, "choices": choices } })
}
