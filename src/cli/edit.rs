//! `okoshi edit`: changes of a drawing that speak of its parts.

use std::sync::Arc;

use serde::Serialize;

use super::args::{Common, Edit};
use super::loading::compiled;
use super::rewriting::{Original, Rewriting};
use super::{Failure, Outcome, print_out};
use crate::ide::Analysis;
use crate::ide::changes::{Change, Choice, Possible, Refusal, possible};

/// What became of the changes.
#[derive(Debug, Serialize)]
struct Report<'a> {
    drawing: &'a str,
    made: &'a [Made<'a>],
    refused: Option<&'a Refused<'a>>,
}

/// A change that was made.
#[derive(Debug, Serialize)]
struct Made<'a> {
    change: &'a Change,
    /// What was changed, in words: `Shape of Rarm`.
    title: String,
    /// The part by its name after the change; `None` for a change that is about none.
    part: Option<String>,
    /// What else has changed, as a sentence without a full stop.
    note: Option<String>,
}

/// A change that was not made, so that none was.
#[derive(Debug, Serialize)]
struct Refused<'a> {
    change: &'a Change,
    why: &'a str,
    choices: &'a [Choice],
}

/// Makes changes in a drawing, writes it, and lists them.
pub(super) fn run(arguments: &Edit, common: Common) -> Result<Outcome, Failure> {
    let output = arguments.output.as_deref();
    let (rewriting, original) = Rewriting::read(&arguments.drawing, output, &arguments.reading)?;
    let to_stdout = rewriting.is_to_stdout();
    let Original {
        path,
        text,
        analysis: before,
    } = original;
    let listed = match made(before, arguments) {
        Ok((new, made)) => {
            // A drawing in which everything is so already keeps its time.
            if output.is_some() || to_stdout || new != text {
                rewriting.write(&text, &new)?;
            }
            if arguments.json {
                json(&path, &made, None)?
            } else if common.quiet {
                String::new()
            } else {
                told(&path, &made, new != text)
            }
        }
        Err((change, refusal)) => {
            let refused = Refused {
                change,
                why: &refusal.why,
                choices: &refusal.choices,
            };
            if arguments.json {
                let report = json(&path, &[], Some(&refused))?;
                if to_stdout {
                    eprint!("{report}");
                } else {
                    print_out(&report);
                }
            } else {
                eprint!("{}", instead(&path, &refused)?);
            }
            return Ok(Outcome::Errors);
        }
    };
    if to_stdout {
        eprint!("{listed}");
        return Ok(Outcome::Done);
    }
    Ok(print_out(&listed))
}

/// The text after all changes, and what they did; otherwise the one that is refused.
fn made(before: Analysis, arguments: &Edit) -> Result<(String, Vec<Made<'_>>), (&Change, Refusal)> {
    let Edit {
        drawing,
        changes,
        reading,
        ..
    } = arguments;
    let mut before = Arc::new(before);
    let mut all = vec![];
    for change in changes {
        let read = |text: &str| Arc::new(Analysis::new(text, compiled(text, drawing, reading)));
        let Possible {
            after, part, note, ..
        } = possible(&before, change, read).map_err(|refusal| (change, refusal))?;
        all.push(Made {
            change,
            title: change.title(),
            part,
            note,
        });
        if let Some(after) = after {
            before = after;
        }
    }
    Ok((before.source().to_string(), all))
}

fn json(
    path: &str,
    made: &[Made<'_>],
    refused: Option<&Refused<'_>>,
) -> Result<String, serde_json::Error> {
    let report = Report {
        drawing: path,
        made,
        refused,
    };
    Ok(serde_json::to_string_pretty(&report)? + "\n")
}

fn told(path: &str, made: &[Made<'_>], is_changed: bool) -> String {
    if !is_changed {
        return format!("{path}: everything is so already\n");
    }
    let lines = made.iter().map(|one| match &one.note {
        Some(note) => format!("{path}: changed {}; {note}\n", one.title),
        None => format!("{path}: changed {}\n", one.title),
    });
    lines.collect()
}

/// Why a change was not made, and each choice as it can be typed.
fn instead(path: &str, refused: &Refused<'_>) -> Result<String, serde_json::Error> {
    let mut out = format!("`{path}` stays as it is: {}\n", refused.why);
    for Choice { title, change } in refused.choices {
        let change = serde_json::to_string(change)?;
        out += &format!("  {title}:\n    --change {}\n", in_quotes(&change));
    }
    Ok(out)
}

/// A word as shells read it.
fn in_quotes(text: &str) -> String {
    format!("'{}'", text.replace('\'', r"'\''"))
}
