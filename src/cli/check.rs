//! `okoshi check`

use super::args::{Check, Common, Format};
use super::loading::{Detail, Loaded, count, describe, load, tally};
use super::parallel::each;
use super::progress::spinning;
use super::{Outcome, json, print_out, sarif, style};

/// Checks every drawing and reports in the order given.
pub(super) fn run(arguments: &Check, common: Common) -> Outcome {
    let loaded = spinning("checking", || {
        each(&arguments.drawings, |drawing| {
            load(drawing, &arguments.reading)
        })
    });
    let mut worst = Outcome::Done;
    let mut read = Vec::new();
    for loaded in loaded {
        match loaded {
            Ok(loaded) => {
                worst = worst.max(loaded.outcome());
                read.push(loaded);
            }
            Err(outcome) => worst = worst.max(outcome),
        }
    }
    let findings: Vec<_> = read.iter().map(Loaded::findings).collect();
    let text = match arguments.format {
        Format::Human => human(&read, common),
        Format::Json => json::json(&findings),
        Format::Sarif => sarif::sarif(&findings),
    };
    worst.max(print_out(&text))
}

fn human(read: &[Loaded], common: Common) -> String {
    let style = style(common, &std::io::stdout());
    let mut out = String::new();
    for loaded in read {
        out.push_str(&describe(loaded.findings(), common, Detail::Asked, style));
        if !common.quiet {
            let counts = tally(&loaded.compiled.diagnostics);
            let findings = if counts == [0; 3] {
                "no findings".to_owned()
            } else {
                count(counts)
            };
            out.push_str(&format!("{}: {findings}\n", loaded.path));
        }
    }
    out
}
