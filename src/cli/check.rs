//! `okoshi check`

use super::args::{Check, Common, Format};
use super::fix::fix;
use super::loading::{Detail, Loaded, count, describe, load, tally};
use super::parallel::each;
use super::progress::spinning;
use super::{Outcome, counted, json, print_out, sarif, style};
use crate::disk::is_standard_stream;

/// A drawing that was checked, and the number of findings that were fixed in it.
type Checked = (Loaded, usize);

/// Checks every drawing, fixes it if asked to, and reports in the order given.
pub(super) fn run(arguments: &Check, common: Common) -> Outcome {
    let checked = spinning("checking", || {
        each(&arguments.drawings, |drawing| -> Result<Checked, Outcome> {
            let mut loaded = load(drawing, &arguments.reading)?;
            let fixed = match arguments.fix {
                true => fix(drawing, &mut loaded, arguments)?,
                false => 0,
            };
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
        Format::Json => json::json(&findings),
        Format::Sarif => sarif::sarif(&findings),
    };
    let fixes_stdin = arguments
        .drawings
        .iter()
        .any(|path| is_standard_stream(path));
    match arguments.fix && fixes_stdin {
        // The fixed drawing is on stdout.
        true => eprint!("{text}"),
        false => worst = worst.max(print_out(&text)),
    }
    worst
}

fn human(read: &[Checked], arguments: &Check, common: Common) -> String {
    let style = style(common, &std::io::stdout());
    let mut out = String::new();
    for (loaded, fixed) in read {
        out.push_str(&describe(loaded.findings(), common, Detail::Asked, style));
        if !common.quiet {
            let counts = tally(&loaded.compiled.diagnostics);
            let findings = match (counts == [0; 3], arguments.fix) {
                (true, false) => "no findings".to_owned(),
                (true, true) => "nothing left".to_owned(),
                (false, false) => count(counts),
                (false, true) => format!("{} left", count(counts)),
            };
            let fixed = match arguments.fix {
                true => format!("{} fixed, ", counted(*fixed, "finding")),
                false => String::new(),
            };
            out.push_str(&format!("{}: {fixed}{findings}\n", loaded.path));
        }
    }
    out
}
