//! Diagnostics for text that is not part of the language, with suggestions of what was meant.

use std::ops::Range;

use super::lexical;
use super::names::shorten;
use crate::diagnostic::{Code, Diagnostic, has_one_near_word};
use crate::lang::ast::{Argument, ArgumentKind};
use crate::lang::keyword::signature::{Form, Takes};
use crate::lang::keyword::{Keyword, colors, kinds, vocabulary};
use crate::lang::{did_you_mean, fixed_by_writing};
use crate::source::{Span, Text};

/// Whether `word`, found while looking for the next attribute, is a misspelled keyword.
pub(in crate::lang) fn is_misspelled_keyword(word: &str, lower_case: bool) -> bool {
    let cased = lower_case || word.starts_with(char::is_uppercase);
    cased && Keyword::nearest(word).is_some() && !vocabulary::is_known(word)
}

/// The diagnostic for `found` at `range` of the decoded string, in the place of a keyword.
pub(in crate::lang) fn unknown_keyword(
    text: &Text,
    range: Range<usize>,
    found: &str,
) -> Diagnostic {
    let shown = shorten(found);
    let message = format!("`{shown}` is not a keyword");
    let diagnostic = Diagnostic::new(Code::UnknownKeyword, text.span(range.clone()), message);
    let (head, tail) = found
        .split_once([':', '=', ',', ';'])
        .unwrap_or((found, ""));
    if let Some(keyword) = Keyword::from_name(head) {
        let better = format!("{} {tail}", keyword.name());
        let diagnostic = diagnostic.label("put only a space after a keyword");
        return fixed_by_writing(diagnostic, text, &range, better.trim_end()).safe();
    }
    let owner = owner_of(found);
    if let (None, Some((keyword, _))) = (owner, Keyword::nearest(found)) {
        let diagnostic = did_you_mean(diagnostic, text, &range, keyword.name());
        let names = Keyword::built().map(Keyword::name);
        return if has_one_near_word(found, names) {
            diagnostic.safe()
        } else {
            diagnostic
        };
    }
    match owner {
        Some(owner) => {
            let better = format!("{} {found}", owner.name());
            let label = format!("this is a value for `{}`", owner.name());
            fixed_by_writing(diagnostic.label(label), text, &range, &better)
        }
        None if lexical::is(found, lexical::number) => {
            diagnostic.label("a number needs a keyword before it")
        }
        None => diagnostic
            .label("expected a keyword")
            .help("`okoshi explain` lists the keywords; a name with spaces needs quotes"),
    }
}

/// The keyword that takes `word` as an argument.
fn owner_of(word: &str) -> Option<Keyword> {
    if kinds::from_name(word).is_some() {
        return Some(Keyword::Shape);
    }
    let takes = |keyword: &&Keyword| {
        let mut parameters = keyword.row().forms.iter().flat_map(Form::all);
        parameters.any(|parameter| match parameter.takes {
            Takes::Choice(words) => words
                .iter()
                .any(|known| known.name.eq_ignore_ascii_case(word)),
            Takes::ColorName => colors::is_color(word),
            _ => false,
        })
    };
    Keyword::ALL.iter().find(takes).copied()
}

/// An argument that cannot be read, with its context.
pub(super) struct BadArgument<'a> {
    pub(super) keyword: Keyword,
    pub(super) flags: &'a [(char, Range<usize>)],
    pub(super) before: &'a [Argument],
    pub(super) run: &'a str,
}

/// Its location in the decoded string.
pub(super) struct Location<'a> {
    pub(super) text: &'a Text,
    pub(super) range: Range<usize>,
}

impl Location<'_> {
    fn span(&self) -> Span {
        self.text.span(self.range.clone())
    }

    fn diagnostic(&self, message: String) -> Diagnostic {
        Diagnostic::new(Code::ArgumentType, self.span(), message)
    }

    /// Adds a fix that writes `better` instead.
    fn write(&self, diagnostic: Diagnostic, better: &str) -> Diagnostic {
        diagnostic.fix(
            format!("Write `{}`", shorten(better)),
            self.span(),
            self.text.escape_at(self.range.start, better),
        )
    }
}

/// The diagnostic for an argument that cannot be read. `calculates` says whether it would be a calculation in
/// parentheses.
pub(super) fn malformed(
    bad: &BadArgument<'_>,
    location: &Location<'_>,
    calculates: bool,
) -> Diagnostic {
    let run = bad.run;
    let shown = shorten(run);
    if wants_file(bad) && !run.starts_with(['“', '”', '„', '«', '»']) {
        let diagnostic = location
            .diagnostic(format!("the file name `{shown}` needs quotes"))
            .help("a file name with spaces or punctuation needs quotes");
        return location.write(diagnostic, &format!("\"{run}\"")).safe();
    }
    if run.starts_with(['“', '”', '„', '«', '»', '‘', '’']) {
        let diagnostic = location
            .diagnostic(format!("`{shown}` has typographic quotes"))
            .help("use the straight quotation mark `\"`");
        let inner = run.trim_matches(['“', '”', '„', '«', '»', '‘', '’']);
        let closed = run.ends_with(['“', '”', '«', '»', '‘', '’']) && !inner.is_empty();
        return if closed {
            location.write(diagnostic, &format!("\"{inner}\"")).safe()
        } else {
            diagnostic
        };
    }
    let ascii = run.replace(['−', '–', '—', '‐', '‑', 'ー'], "-");
    if ascii != run && lexical::is(&ascii, lexical::number) {
        let diagnostic =
            location.diagnostic(format!("`{shown}` does not start with a plain minus sign"));
        return location.write(diagnostic, &ascii).safe();
    }
    if let Some(word) = run.strip_prefix('-')
        && lexical::is(word, lexical::word)
    {
        return minus_word(bad, location, word);
    }
    if let Ok((unit, number)) = lexical::number(run)
        && is_unit(unit)
    {
        let diagnostic = location
            .diagnostic(format!("`{shown}` is a number with a unit"))
            .help("write numbers without units: lengths are in drawing units, angles in degrees");
        return location.write(diagnostic, number);
    }
    if run.contains(',') {
        return commas(location, run, &shown);
    }
    if calculates {
        let diagnostic =
            location.diagnostic(format!("the calculation `{shown}` needs parentheses"));
        return location.write(diagnostic, &format!("({run})"));
    }
    if !run.contains(char::is_alphanumeric) {
        return location
            .diagnostic(format!("`{shown}` is not an argument"))
            .help("put calculations in parentheses, as in `(2 * 3)`");
    }
    location
        .diagnostic(format!("`{shown}` is neither a number nor a word"))
        .help("put a space between numbers and words, and quotes around text with punctuation")
}

/// `-w` among the arguments.
fn minus_word(bad: &BadArgument<'_>, location: &Location<'_>, word: &str) -> Diagnostic {
    let known = bad.keyword.row().flags;
    let all_flags = word
        .chars()
        .all(|letter| known.iter().any(|flag| flag.letter == letter));
    let name = bad.keyword.name();
    if all_flags && bad.flags.is_empty() {
        return location
            .diagnostic(format!(
                "the flag `-{word}` must come directly after `{name}`"
            ))
            .help(format!("write `{name} -{word} …`"));
    }
    let diagnostic = location
        .diagnostic(format!("`-{word}` is not a number"))
        .label("a negative variable needs parentheses");
    location.write(diagnostic, &format!("(-{word})"))
}

fn commas(location: &Location<'_>, run: &str, shown: &str) -> Diagnostic {
    let diagnostic = location
        .diagnostic(format!("`{shown}` contains a comma"))
        .help("separate arguments with spaces, and write decimals with a point: `0.5 1 2`");
    let parts: Vec<_> = run.split(',').filter(|part| !part.is_empty()).collect();
    let numbers = parts.iter().all(|part| lexical::is(part, lexical::number));
    match parts.as_slice() {
        [whole, decimals] if numbers && decimals.bytes().all(|b| b.is_ascii_digit()) => {
            let decimal = format!("{whole}.{decimals}");
            let diagnostic = if lexical::is(&decimal, lexical::number) {
                location.write(diagnostic, &decimal)
            } else {
                diagnostic
            };
            location.write(diagnostic, &format!("{whole} {decimals}"))
        }
        [] => diagnostic,
        parts => location.write(diagnostic, &parts.join(" ")),
    }
}

fn wants_file(bad: &BadArgument<'_>) -> bool {
    let form_takes_file = bad.keyword.row().forms.iter().any(|form| {
        let parameter = form.parameters.get(bad.before.len());
        parameter.is_some_and(|parameter| matches!(parameter.takes, Takes::File | Takes::Text))
    });
    let model = matches!(
        bad.before.first().map(|first| &first.kind),
        Some(ArgumentKind::Word(kind)) if bad.keyword == Keyword::Shape && kind.eq_ignore_ascii_case("model")
    );
    form_takes_file || model && bad.before.len() == 1
}

fn is_unit(unit: &str) -> bool {
    const UNITS: [&str; 12] = [
        "px", "mm", "cm", "m", "in", "pt", "pc", "em", "deg", "°", "%", "s",
    ];
    UNITS.iter().any(|known| known.eq_ignore_ascii_case(unit))
}
