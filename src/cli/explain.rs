//! `okoshi explain`

use super::args::Common;
use super::report::Style;
use super::{Failure, Outcome, print_out, style};
use crate::diagnostic::nearest_word;
use crate::lang::explain;

/// Prints a page of the manual, or the overview.
pub(super) fn run(topic: Option<&str>, common: Common) -> Result<Outcome, Failure> {
    let page = match topic {
        None => explain::overview(),
        Some(topic) => explain::page(topic).ok_or_else(|| unknown(topic))?,
    };
    Ok(match style(common, &std::io::stdout()) {
        Style::Plain => print_out(&page),
        Style::Colored => print_out(&colored(&page)),
    })
}

fn unknown(topic: &str) -> String {
    let near = nearest_word(topic, explain::topics());
    let hint = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
    format!("there is no page on `{topic}`: {hint}`okoshi explain` lists them all")
}

/// The page with its headings bold and its code coloured.
fn colored(page: &str) -> String {
    let mut out = String::new();
    let mut fenced = false;
    for line in page.lines() {
        if line.starts_with("```") {
            fenced = !fenced;
            continue;
        }
        if fenced {
            out.push_str(&format!("    \x1b[36m{line}\x1b[0m\n"));
        } else if let Some(heading) = line.strip_prefix('#') {
            out.push_str(&format!(
                "\x1b[1m{}\x1b[0m\n",
                heading.trim_start_matches('#').trim()
            ));
        } else {
            let spans = line.split('`').enumerate();
            let spans = spans.map(|(place, span)| {
                if place % 2 == 1 {
                    format!("\x1b[36m{span}\x1b[0m")
                } else {
                    span.to_owned()
                }
            });
            out.push_str(&spans.collect::<String>());
            out.push('\n');
        }
    }
    out
}
