//! `okoshi check --fix`: applies the safe fixes to drawings.

use std::path::Path;

use super::args::Check;
use super::loading::{Loaded, check_unchanged, compiled, tally};
use super::{Outcome, counted, fail};
use crate::diagnostic::{Code, Diagnostic, Severity, apply_safe_fixes};
use crate::disk::{is_packed, is_standard_stream, rewrite};

/// How often a drawing is read again for fixes that others made possible.
const MAX_ROUNDS: usize = 8;

/// Fixes a drawing and writes it; returns the number of findings that were fixed. A drawing from stdin goes to stdout, fixed or
/// not.
///
/// Nothing is written if the file was changed in the meantime.
pub(super) fn fix(path: &Path, loaded: &mut Loaded, arguments: &Check) -> Result<usize, Outcome> {
    let undecoded = |found: &Diagnostic| found.code == Code::NotUtf8;
    if loaded.compiled.diagnostics.iter().any(undecoded) {
        return Ok(0);
    }
    let original = loaded.text.clone();
    let mut fixed = 0;
    for _ in 0..MAX_ROUNDS {
        let found = &loaded.compiled.diagnostics;
        let Some((text, count)) = apply_safe_fixes(&loaded.text, found) else {
            break;
        };
        let after = compiled(&text, path, &arguments.reading);
        let readable = !after.drawing.groups.is_empty();
        let errors = |diagnostics| tally(diagnostics)[Severity::Error as usize];
        // A fix that makes matters worse is none.
        if !readable || errors(&after.diagnostics) > errors(found) {
            break;
        }
        loaded.text = text;
        loaded.compiled = after;
        fixed += count;
    }
    let to_stdout = is_standard_stream(path);
    if fixed == 0 && !to_stdout {
        return Ok(0);
    }
    if !to_stdout {
        check_unchanged(path, &original).map_err(fail)?;
        if is_packed(path) {
            return Err(fail(format!(
                "`{}` is compressed: save it as plain SVG, then its {} can be fixed",
                path.display(),
                counted(fixed, "finding")
            )));
        }
    }
    rewrite(path, loaded.text.as_bytes()).map_err(fail)?;
    Ok(fixed)
}
