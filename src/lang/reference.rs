//! Everything generated from the table: the reference, the list of diagnostics, the grammars.
//!
//! A test compares each with its file in the repository, and rewrites the file on demand.

mod ebnf;
mod textmate;

use std::fmt::Write as _;

use super::explain::{keyword, kind, paragraphs, sentence};
use super::keyword::Keyword;
use super::keyword::kinds::KINDS;
use super::keyword::vocabulary::{FUNCTIONS, STRINGS};
use crate::diagnostic::{Code, Severity};

pub use ebnf::ebnf;
pub use textmate::{injection, textmate};

const GENERATED: &str = "<!-- Generated from the keyword table: `OKOSHI_REWRITE=generated cargo test --test generated`. -->\n";

/// `docs/reference.md`: the whole language.
pub fn reference() -> String {
    let mut out = format!("# Language reference\n\n{GENERATED}\n");
    out.push_str(include_str!("reference/strings.md"));
    out.push_str("\n| starts with | kind | belongs to | meaning |\n|---|---|---|---|\n");
    for row in &STRINGS {
        let sign = match row.sign {
            "" => "anything else".to_owned(),
            sign => format!("`{sign}`"),
        };
        let _ = writeln!(
            out,
            "| {sign} | [{}](#{}-string) | {} | {} |",
            row.name,
            row.name.replace(' ', "-"),
            row.bound,
            row.summary
        );
    }
    for row in &STRINGS {
        let _ = write!(
            out,
            "\n### {} string\n\n{}\n\n```\n{}\n```\n",
            sentence(row.name),
            row.long,
            row.example
        );
    }
    out.push('\n');
    out.push_str(include_str!("reference/writing.md"));
    out.push_str("\n| function | value |\n|---|---|\n");
    for row in &FUNCTIONS {
        let _ = writeln!(out, "| `{}` | {} |", row.usage, row.summary);
    }
    out.push_str("\n## Attributes\n\n");
    out.push_str(&keyword_table());
    for each in Keyword::built() {
        out.push('\n');
        out.push_str(&deeper(&keyword(each)));
    }
    out.push_str("\n## Shapes\n\n| kind | meaning |\n|---|---|\n");
    for each in &KINDS {
        let _ = writeln!(
            out,
            "| [`{}`](#shape-{}) | {} |",
            each.usage(),
            each.name,
            each.summary
        );
    }
    for each in &KINDS {
        out.push('\n');
        out.push_str(&deeper(&kind(each)));
    }
    out
}

/// `docs/diagnostics.md`: a section for each code. `report` gives what okoshi prints for a drawing with the diagnostic, if that is to be
/// shown.
pub fn diagnostics(report: impl Fn(Code) -> Option<String>) -> String {
    let mut out = format!(
        "# Diagnostics\n\n{GENERATED}\nWith errors, `okoshi build` does not write a model; warnings and hints \
         do not prevent it. `okoshi explain CODE` prints a section in the terminal. Of many findings of one kind, commands \
         [print the first](commands.md) and count the others, unless you add `-v`.\n"
    );
    for severity in [Severity::Error, Severity::Warning, Severity::Hint] {
        let _ = write!(out, "\n## {}s\n", sentence(severity.name()));
        for each in Code::ALL.iter().filter(|code| code.severity() == severity) {
            let _ = write!(
                out,
                "\n<a id=\"{}\"></a>\n\n### {}: {}\n\n{}",
                each.id().to_ascii_lowercase(),
                each.id(),
                each.title(),
                paragraphs(each.manual())
            );
            if let Some(report) = report(*each) {
                let _ = write!(out, "\nPrinted as:\n\n```text\n{}\n```\n", report.trim());
            }
        }
    }
    out
}

/// The table of the keywords that have an effect.
fn keyword_table() -> String {
    let mut out = String::from("| keyword | where | meaning | default |\n|---|---|---|---|\n");
    for keyword in Keyword::built() {
        let row = keyword.row();
        let usages: Vec<_> = keyword
            .usages()
            .iter()
            .map(|usage| format!("`{}`", usage.replace('|', "\\|")))
            .collect();
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} |",
            usages.join("<br>"),
            row.allowed.name(),
            row.summary,
            row.default
        );
    }
    out
}

/// A page of the manual with its heading two levels deeper, as a section of a larger page.
fn deeper(page: &str) -> String {
    match page.strip_prefix("# ") {
        Some(rest) => format!("### {rest}"),
        None => page.to_owned(),
    }
}
