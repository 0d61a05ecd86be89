//! `okoshi annotate`: names for the parts of a drawing that nobody has named.

use serde::Serialize;

use super::args::{Annotate, Common};
use super::loading::compiled;
use super::progress::spinning;
use super::rewriting::{Original, Rewriting};
use super::{Failure, Outcome, counted, print_out};
use crate::diagnostic::applied;
use crate::ide::Analysis;
use crate::ide::changes::{self, Change, Suggestion};
use crate::labels::Certainty;
use crate::source::LineIndex;

/// A name as it was written.
#[derive(Debug, Serialize)]
struct Written<'a> {
    name: &'a str,
    /// What it hangs on; `None` for nothing.
    parent: Option<String>,
    certainty: &'static str,
    why: &'a str,
    /// The `id` of the element that has the name now.
    element: Option<&'a str>,
    /// Where that begins in the drawing as it was.
    line: usize,
    column: usize,
}

/// Names the parts of a drawing, writes it, and lists the names.
pub(super) fn run(arguments: &Annotate, common: Common) -> Result<Outcome, Failure> {
    let output = arguments.output.as_deref();
    let (rewriting, original) = Rewriting::read(&arguments.drawing, output, &arguments.reading)?;
    let to_stdout = rewriting.is_to_stdout();
    let Original {
        path,
        text,
        analysis: before,
    } = original;
    let found = spinning("looking for parts", || before.named_parts());
    let (edits, names) = match found {
        Ok(found) => found,
        Err(refusal) => {
            eprintln!("`{path}` stays as it is: {refusal}");
            if to_stdout {
                return Ok(print_out(&text));
            }
            return Ok(Outcome::Errors);
        }
    };
    let new = applied(&text, &edits);
    let after = compiled(&new, &arguments.drawing, &arguments.reading);
    let after = Analysis::new(new.as_str(), after);
    changes::check(&before, &after, &Change::NameParts)
        .map_err(|refusal| format!("`{path}` {refusal}"))?;
    rewriting.write(&text, &new)?;
    let lines = LineIndex::new(text.as_str());
    let written: Vec<Written<'_>> = names
        .iter()
        .map(|name| written(name, &after, &lines))
        .collect();
    let listed = if arguments.json {
        json(&path, &written)
    } else if common.quiet {
        String::new()
    } else {
        table(&path, &written, &names)
    };
    if to_stdout {
        eprint!("{listed}");
        return Ok(Outcome::Done);
    }
    Ok(print_out(&listed))
}

fn written<'a>(name: &'a Suggestion, after: &Analysis, lines: &LineIndex<&str>) -> Written<'a> {
    let (line, column) = lines.line_column(name.element.start);
    Written {
        name: &name.name,
        parent: after.carrier_of(&name.name),
        certainty: name.certainty.name(),
        why: &name.why,
        element: name.id.as_deref(),
        line,
        column,
    }
}

fn json(path: &str, written: &[Written<'_>]) -> String {
    let all = serde_json::json!({ "drawing": path, "parts": written });
    format!("{all:#}\n")
}

/// A line for each name, and how many a person should look at.
fn table(path: &str, written: &[Written<'_>], names: &[Suggestion]) -> String {
    let whole = |one: &Written<'_>| match &one.parent {
        Some(parent) => format!("{}@{parent}", one.name),
        None => one.name.to_owned(),
    };
    let heads: Vec<String> = written.iter().map(whole).collect();
    let width = heads.iter().map(|head| head.chars().count()).max();
    let width = width.unwrap_or(0);
    let mut out = format!("{path}: {}\n", counted(written.len(), "name"));
    for (one, head) in written.iter().zip(&heads) {
        out += &format!(
            "  {head:width$}  {:9}  line {}: {}\n",
            one.certainty, one.line, one.why
        );
    }
    let unsure = names
        .iter()
        .filter(|name| name.certainty == Certainty::Uncertain);
    let unsure = unsure.count();
    if unsure > 0 {
        out += &format!(
            "look at {}: only place and shape tell\n",
            counted(unsure, "uncertain name")
        );
    }
    out
}
