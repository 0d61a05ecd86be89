//! `okoshi check`

use std::path::Path;

use super::args::{Check, Common, Format};
use super::digest::{Detail, describe};
use super::fix::fix;
use super::loading::{Loaded, count, load, resolver, tally};
use super::parallel::each;
use super::progress::spinning;
use super::{Outcome, counted, fail, print_out, sarif, style};
use crate::bind;
use crate::diagnostic;
use crate::disk::is_standard_stream;
use crate::look::{self, Look};
use crate::report::findings_json;

/// The larger side of the pictures that `--look` compares, pixels.
const LOOK_SIDE: u32 = 800;

/// A drawing that was checked, and the number of findings that were fixed in it.
type Checked = (Loaded, usize);

/// Checks every drawing, fixes it if asked to, and reports in the order given.
pub(super) fn run(arguments: &Check, common: Common) -> Outcome {
    let checked = spinning("checking", || {
        each(&arguments.drawings, |drawing| -> Result<Checked, Outcome> {
            let mut loaded = load(drawing, &arguments.reading)?;
            let fixed = if arguments.fix {
                fix(drawing, &mut loaded, arguments)?
            } else {
                0
            };
            if arguments.look && !loaded.compiled.has_errors() {
                look_at(drawing, &mut loaded, arguments)?;
            }
            Ok((loaded, fixed))
        })
    });
    let mut worst = Outcome::Done;
    let mut read = Vec::new();
    for checked in checked {
        match checked {
            Ok((loaded, fixed)) => {
                worst = worst.max(loaded.outcome());
                read.push((loaded, fixed));
            }
            Err(outcome) => worst = worst.max(outcome),
        }
    }
    let findings: Vec<_> = read.iter().map(|(loaded, _)| loaded.findings()).collect();
    let text = match arguments.format {
        Format::Human => human(&read, arguments, common),
        Format::Json => findings_json(&findings),
        Format::Sarif => sarif::sarif(&findings),
    };
    let fixes_stdin = arguments
        .drawings
        .iter()
        .any(|path| is_standard_stream(path));
    if arguments.fix && fixes_stdin {
        // The fixed drawing is on stdout.
        eprint!("{text}");
    } else {
        worst = worst.max(print_out(&text));
    }
    worst
}

/// Compares the model with the drawing, and adds what looks different to the findings.
fn look_at(path: &Path, loaded: &mut Loaded, arguments: &Check) -> Result<(), Outcome> {
    let resolver = resolver(path, &arguments.reading);
    let found = look::compare(&loaded.compiled, &loaded.text, &resolver, LOOK_SIDE);
    let found = found.map_err(|error| fail(format!("`{}` {error}", loaded.path)))?;
    let mut hints = look::hints(&loaded.compiled, &found);
    bind::locate(&loaded.compiled.drawing, &mut hints);
    loaded.compiled.diagnostics.append(&mut hints);
    diagnostic::sort(&mut loaded.compiled.diagnostics);
    loaded.look = Some(found);
    Ok(())
}

fn human(read: &[Checked], arguments: &Check, common: Common) -> String {
    let style = style(common, &std::io::stdout());
    let mut out = String::new();
    for (loaded, fixed) in read {
        out.push_str(&describe(loaded.findings(), common, Detail::All, style));
        if !common.quiet {
            let counts = tally(&loaded.compiled.diagnostics);
            let findings = match (counts == [0; 3], arguments.fix) {
                (true, false) => "no findings".to_owned(),
                (true, true) => "nothing left".to_owned(),
                (false, false) => count(counts),
                (false, true) => format!("{} left", count(counts)),
            };
            let fixed = if arguments.fix {
                format!("{} fixed, ", counted(*fixed, "finding"))
            } else {
                String::new()
            };
            out.push_str(&format!("{}: {fixed}{findings}\n", loaded.path));
            if let Some(look) = &loaded.look {
                out.push_str(&format!("{}: {}\n", loaded.path, likeness(look)));
            }
        }
    }
    out
}

/// How much of the drawing a model shows, in words.
fn likeness(look: &Look) -> String {
    // Rounded down, so that 100 % means all of them.
    let down = |share: f64| (share * 1000.0).floor() / 10.0;
    let mut out = format!(
        "{:.1} % of the drawing's pixels show the right colour from the front",
        down(look.right)
    );
    if let Some(lines) = look.lines {
        out += &format!(
            "; {:.1} % belong to lines that are not built, which `%Strokes {}` builds, and without them {:.1} % are right",
            // Rounded up, so that 0 % means none.
            (lines.share * 1000.0).ceil() / 10.0,
            lines.built_by,
            down(look.right_without_lines)
        );
    }
    out
}
