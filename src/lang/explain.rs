//! The pages of the manual, in Markdown that also reads well in a terminal.

use std::fmt::Write as _;

use super::keyword::kinds::{KINDS, Kind};
use super::keyword::signature::{Form, Parameter, Takes};
use super::keyword::vocabulary::{FUNCTIONS, STRINGS};
use super::keyword::{Keyword, Status};
use super::topics::{TOPICS, Topic};
use crate::diagnostic::Code;

/// The note on keywords that have no effect yet.
const PLANNED: &str = "*This version reads and checks it, but it has no effect yet.*";

/// The page on `word`: a keyword, a kind of `Shape`, a diagnostic's code, or a question of people who know none of them, ignoring
/// case.
///
/// A keyword has precedence over a kind of the same name, and both over a question; a keyword without an effect comes last.
pub(crate) fn page(word: &str) -> Option<String> {
    let named = Keyword::from_name(word);
    let (built, planned) = match named {
        Some(keyword) if keyword.row().status == Status::Planned => (None, named),
        _ => (named, None),
    };
    built
        .map(keyword)
        .or_else(|| super::keyword::kinds::from_name(word).map(kind))
        .or_else(|| Topic::about(word).map(Topic::page))
        .or_else(|| Code::from_id(word).map(code))
        .or_else(|| planned.map(keyword))
}

/// All words that have a page, but for keywords without an effect.
pub(crate) fn topics() -> impl Iterator<Item = &'static str> {
    let keywords = Keyword::built().map(Keyword::name);
    let kinds = KINDS.iter().map(|kind| kind.name);
    keywords
        .chain(kinds)
        .chain(TOPICS.iter().flat_map(Topic::all_words))
        .chain(Code::ALL.iter().map(|code| code.id()))
}

/// The page on a keyword.
pub(crate) fn keyword(keyword: Keyword) -> String {
    let row = keyword.row();
    let mut out = format!(
        "# {}\n\n{}.\n\n```\n",
        keyword.name(),
        sentence(row.summary)
    );
    for usage in keyword.usages() {
        let _ = writeln!(out, "{usage}");
    }
    out.push_str("```\n\n");
    if row.status == Status::Planned {
        let _ = writeln!(out, "{PLANNED}\n");
    }
    let _ = writeln!(out, "{}\n", row.long);
    out.push_str(&parameters(row.forms));
    for flag in row.flags {
        let _ = writeln!(out, "- `-{}`: {}", flag.letter, flag.summary);
    }
    if !row.flags.is_empty() {
        out.push('\n');
    }
    if keyword == Keyword::Shape {
        out.push_str("Kinds:\n\n");
        for kind in &KINDS {
            let _ = writeln!(out, "- `{}`: {}", kind.usage(), kind.summary);
        }
        out.push('\n');
    }
    if !row.default.is_empty() {
        let _ = writeln!(out, "Default: {}\n", row.default);
    }
    let _ = writeln!(out, "Allowed {}.\n", row.allowed.places());
    let _ = write!(out, "Example:\n\n```\n{}\n```\n", row.example);
    out
}

/// The page on a kind of `Shape`.
pub(crate) fn kind(kind: &Kind) -> String {
    let mut out = format!(
        "# Shape {}\n\n{}.\n\n```\nShape {}\n```\n\n",
        kind.name,
        sentence(kind.summary),
        kind.usage()
    );
    let _ = writeln!(out, "{}\n", kind.long);
    out.push_str(&parameters(std::slice::from_ref(&kind.form)));
    if !kind.default.is_empty() {
        let _ = writeln!(out, "Default: {}\n", kind.default);
    }
    let _ = write!(out, "Example:\n\n```\n{}\n```\n", kind.example);
    out
}

/// The page on a diagnostic's code.
pub(crate) fn code(code: Code) -> String {
    format!(
        "# {}: {}\n\n*{}*\n\n{}",
        code.id(),
        code.title(),
        code.severity().name(),
        paragraphs(code.manual())
    )
}

/// What a diagnostic's code means and what to do about it: its page without the example. What the page advises there is about the
/// example; where better advice is known, that takes its place.
pub(crate) fn code_in_short(code: Code, advice: Option<&str>) -> String {
    let mut out = format!("**{}: {}**\n\n", code.id(), code.title());
    let page = paragraphs(code.manual());
    let page = match (page.split_once("\n```"), advice) {
        (Some((meaning, _)), Some(advice)) => format!("{meaning}\n{}.\n", sentence(advice)),
        _ => page,
    };
    let mut was_empty = true;
    for (line, _) in lines(&page).filter(|(_, fenced)| !fenced) {
        // What was around the example is one paragraph break.
        if !(line.is_empty() && was_empty) {
            let _ = writeln!(out, "{line}");
        }
        was_empty = line.is_empty();
    }
    out
}

/// A page for a small window: headings are bold lines.
pub(crate) fn without_headings(page: &str) -> String {
    let mut out = String::new();
    for (line, fenced) in lines(page) {
        let heading = line.trim_start_matches('#').strip_prefix(' ');
        let _ = match heading.filter(|_| !fenced && line.starts_with('#')) {
            // A heading ends the paragraph before it, a bold line does not.
            Some(heading) if !out.is_empty() && !out.ends_with("\n\n") => {
                writeln!(out, "\n**{heading}**")
            }
            Some(heading) => writeln!(out, "**{heading}**"),
            None => writeln!(out, "{line}"),
        };
    }
    out
}

/// The lines of a page, and whether each belongs to a fenced block of code.
fn lines(page: &str) -> impl Iterator<Item = (&str, bool)> {
    let mut inside = false;
    page.lines().map(move |line| {
        let fence = line.starts_with("```");
        inside ^= fence;
        (line, inside || fence)
    })
}

/// An overview of the language.
pub(crate) fn overview() -> String {
    let mut out = String::from("# The strings of a drawing\n\n");
    for row in &STRINGS {
        let start = match row.sign {
            "" => "Name@Parent$ …".to_owned(),
            sign => format!("{sign} …"),
        };
        let _ = writeln!(out, "- `{start}` {}: {}", row.name, row.summary);
    }
    out.push_str("\n# Keywords\n\n");
    for keyword in Keyword::built() {
        let _ = writeln!(out, "- `{}`: {}", keyword.name(), keyword.row().summary);
    }
    out.push_str("\n# Kinds of `Shape`\n\n");
    for kind in &KINDS {
        let _ = writeln!(out, "- `{}`: {}", kind.usage(), kind.summary);
    }
    out.push_str(
        "\n# Calculations\n\nIn parentheses, with `+ - * /` and variables; functions:\n\n",
    );
    for row in &FUNCTIONS {
        let _ = writeln!(out, "- `{}`: {}", row.usage, row.summary);
    }
    out.push_str("\n# Questions\n\n");
    for topic in &TOPICS {
        let words: Vec<&str> = topic.all_words().collect();
        let _ = writeln!(out, "- {}", words.join(", "));
    }
    out.push_str(
        "\n`okoshi explain WORD` shows the page on a keyword, a kind, a word of a question, or a diagnostic's code.\n",
    );
    out
}

/// A list of the parameters of some forms; empty if the printed forms say everything.
pub(super) fn parameters(forms: &[Form]) -> String {
    let mut out = String::new();
    let all: Vec<&Parameter> = forms.iter().flat_map(Form::all).collect();
    for (index, parameter) in all.iter().enumerate() {
        let same =
            |other: &&Parameter| (other.name, other.summary) == (parameter.name, parameter.summary);
        // Several forms can have it.
        if all[..index].iter().any(same) {
            continue;
        }
        match &parameter.takes {
            Takes::Choice(words) => {
                for word in *words {
                    let _ = writeln!(out, "- `{}`: {}", word.name, word.summary);
                }
            }
            Takes::Kind => {}
            takes => {
                let (name, summary) = (parameter.print(), parameter.summary);
                let _ = writeln!(out, "- `{name}`: {summary} ({})", takes.describe());
            }
        }
    }
    if !out.is_empty() {
        out.push('\n');
    }
    out
}

/// `text` with its first letter capitalized.
pub(super) fn sentence(text: &str) -> String {
    let mut chars = text.chars();
    match chars.next() {
        Some(first) => first.to_uppercase().chain(chars).collect(),
        None => String::new(),
    }
}

/// Doc comments as Markdown: removes the leading space of each line.
pub(super) fn paragraphs(manual: &str) -> String {
    let lines: Vec<_> = manual
        .lines()
        .map(|line| line.strip_prefix(' ').unwrap_or(line).trim_end())
        .collect();
    let mut out = lines.join("\n").trim().to_owned();
    out.push('\n');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_has_a_page() {
        for word in topics() {
            let page = page(word).unwrap();
            assert!(page.starts_with("# ") && page.ends_with('\n'), "{page}");
            assert!(!page.contains("\n\n\n"), "{page}");
        }
        assert_eq!(page("nonsense"), None);
        assert!(page("ROUNDV").unwrap().contains("Shape roundv [a0 a1]"));
        assert!(page("e112").unwrap().starts_with("# E112: unexpected sign"));
    }

    #[test]
    fn codes_in_short_have_a_cause_and_a_way_out() {
        assert_eq!(
            code_in_short(Code::from_id("E204").unwrap(), None),
            "**E204: unknown parent**\n\nNo part of this drawing has the name after `@`.\n\n\
             Write the parent's name exactly as in the parent's own string. Upper and lower case matter.\n"
        );
        for code in Code::ALL {
            for advice in [None, Some("write `Shape`")] {
                let short = code_in_short(*code, advice);
                assert!(
                    !short.contains("```") && !short.contains("\n\n\n"),
                    "{short}"
                );
                assert!(short.lines().count() > 2, "{short}");
            }
        }
        let advised = code_in_short(Code::UnknownKeyword, Some("write `Shape`"));
        assert!(
            advised.ends_with("a word\ntoo many.\n\nWrite `Shape`.\n"),
            "{advised}"
        );
    }

    #[test]
    fn headings_become_bold_lines() {
        assert_eq!(
            without_headings("# Shape\n\n```\n# a note\n```\n## More\n\n#no heading\n"),
            "**Shape**\n\n```\n# a note\n```\n\n**More**\n\n#no heading\n"
        );
        for word in topics() {
            let page = without_headings(&page(word).unwrap());
            assert!(page.starts_with("**") && page.ends_with('\n'), "{page}");
        }
    }

    #[test]
    fn the_overview_names_the_keywords_that_have_an_effect() {
        let overview = overview();
        for keyword in Keyword::ALL {
            let is_named = overview.contains(&format!("- `{}`: ", keyword.name()));
            assert_eq!(
                is_named,
                keyword.row().status == Status::Built,
                "{}",
                keyword.name()
            );
        }
    }
}
