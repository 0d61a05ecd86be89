//! What people mean when they write something that is not the language.

use std::ops::Range;

use super::lexical;
use super::names::shorten;
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::{Argument, ArgumentKind};
use crate::lang::keyword::signature::Takes;
use crate::lang::keyword::{Keyword, colours, kinds, words};
use crate::source::{Span, Text};

/// Whether `word`, found while looking for the next attribute, is a keyword with a slip of the pen.
pub(in crate::lang) fn is_nearly_keyword(word: &str, lower_case: bool) -> bool {
    let cased = lower_case || word.starts_with(char::is_uppercase);
    cased && Keyword::nearly(word).is_some() && !words::is_known(word)
}

/// `found` stands at `range` of the decoded string, where a keyword is due.
pub(in crate::lang) fn no_keyword(text: &Text, range: Range<usize>, found: &str) -> Diagnostic {
    let span = text.span(range.clone());
    let shown = shorten(found);
    let diagnostic = Diagnostic::new(
        Code::UnknownKeyword,
        span,
        format!("`{shown}` is no keyword"),
    );
    let write = |diagnostic: Diagnostic, better: &str| {
        diagnostic.fix(
            format!("Write `{better}`"),
            span,
            text.escape_at(range.start, better),
        )
    };
    let (head, tail) = found
        .split_once([':', '=', ',', ';'])
        .unwrap_or((found, ""));
    if let Some(keyword) = Keyword::from_name(head) {
        let better = format!("{} {tail}", keyword.name());
        let said = diagnostic.label("only a space stands behind a keyword");
        return write(said, better.trim_end());
    }
    let owner = owner_of(found);
    if let (None, Some((keyword, _))) = (owner, Keyword::nearly(found)) {
        let name = keyword.name();
        return write(diagnostic.label(format!("did you mean `{name}`?")), name);
    }
    match owner {
        Some(owner) => {
            let better = format!("{} {found}", owner.name());
            let label = format!("this is a word of `{}`", owner.name());
            write(diagnostic.label(label), &better)
        }
        None if lexical::is(found, lexical::number) => {
            diagnostic.label("a number stands behind a keyword")
        }
        None => diagnostic
            .label("a keyword is due here")
            .help("`okoshi explain` lists the keywords; a name with spaces stands in quotes"),
    }
}

/// The keyword among whose words is `word`.
fn owner_of(word: &str) -> Option<Keyword> {
    if kinds::from_name(word).is_some() {
        return Some(Keyword::Shape);
    }
    let takes = |keyword: &&Keyword| {
        let mut parameters = keyword.row().forms.iter().flat_map(|form| form.parameters);
        parameters.any(|parameter| match parameter.takes {
            Takes::Choice(words) => words
                .iter()
                .any(|known| known.name.eq_ignore_ascii_case(word)),
            Takes::ColourName => colours::is_colour(word),
            _ => false,
        })
    };
    Keyword::ALL.iter().find(takes).copied()
}

/// An argument that cannot be read, and what stands before it.
pub(super) struct Slip<'a> {
    pub(super) keyword: Keyword,
    pub(super) flags: &'a [(char, Range<usize>)],
    pub(super) before: &'a [Argument],
    pub(super) run: &'a str,
}

/// Its place in the decoded string.
pub(super) struct At<'a> {
    pub(super) text: &'a Text,
    pub(super) range: Range<usize>,
}

impl At<'_> {
    fn span(&self) -> Span {
        self.text.span(self.range.clone())
    }

    fn says(&self, message: String) -> Diagnostic {
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

/// What is wrong with an argument; `calculates` if it would be a calculation in parentheses.
pub(super) fn malformed(slip: &Slip<'_>, at: &At<'_>, calculates: bool) -> Diagnostic {
    let run = slip.run;
    let shown = shorten(run);
    if wants_file(slip) && !run.starts_with(['“', '”', '„', '«', '»']) {
        let said = at
            .says(format!("the file name `{shown}` needs quotes"))
            .help("a name with signs or spaces in it stands in quotes");
        return at.write(said, &format!("\"{run}\""));
    }
    if run.starts_with(['“', '”', '„', '«', '»', '‘', '’']) {
        let said = at
            .says(format!("`{shown}` has typographic quotes"))
            .help("use the plain quotation mark `\"`");
        let inner = run.trim_matches(['“', '”', '„', '«', '»', '‘', '’']);
        let closed = run.ends_with(['“', '”', '«', '»', '‘', '’']) && !inner.is_empty();
        return match closed {
            true => at.write(said, &format!("\"{inner}\"")),
            false => said,
        };
    }
    let ascii = run.replace(['−', '–', '—', '‐', '‑', 'ー'], "-");
    if ascii != run && lexical::is(&ascii, lexical::number) {
        let said = at.says(format!("`{shown}` does not begin with a plain minus sign"));
        return at.write(said, &ascii);
    }
    if let Some(word) = run.strip_prefix('-')
        && lexical::is(word, lexical::word)
    {
        return minus_word(slip, at, word);
    }
    if let Ok((unit, number)) = lexical::number(run)
        && is_unit(unit)
    {
        let said = at
            .says(format!("`{shown}` is a number with a unit"))
            .help("numbers stand alone: lengths are in drawing units, angles in degrees");
        return at.write(said, number);
    }
    if run.contains(',') {
        return commas(at, run, &shown);
    }
    if calculates {
        let said = at.says(format!("the calculation `{shown}` needs parentheses"));
        return at.write(said, &format!("({run})"));
    }
    if !run.contains(char::is_alphanumeric) {
        return at
            .says(format!("`{shown}` is no argument"))
            .help("calculations stand in parentheses, as in `(2 * 3)`");
    }
    at.says(format!("`{shown}` is neither a number nor a word"))
        .help("put a space between numbers and words, and text with signs in quotes")
}

/// `-w` among the arguments.
fn minus_word(slip: &Slip<'_>, at: &At<'_>, word: &str) -> Diagnostic {
    let known = slip.keyword.row().flags;
    let all_flags = word
        .chars()
        .all(|letter| known.iter().any(|flag| flag.letter == letter));
    let name = slip.keyword.name();
    if all_flags && slip.flags.is_empty() {
        return at
            .says(format!(
                "the flag `-{word}` must stand directly behind `{name}`"
            ))
            .help(format!("write `{name} -{word} …`"));
    }
    let said = at
        .says(format!("`-{word}` is no number"))
        .label("a negative variable needs parentheses");
    at.write(said, &format!("(-{word})"))
}

fn commas(at: &At<'_>, run: &str, shown: &str) -> Diagnostic {
    let said = at
        .says(format!("`{shown}` has a comma"))
        .help("arguments are separated by spaces, and decimals have a point: `0.5 1 2`");
    let parts: Vec<_> = run.split(',').filter(|part| !part.is_empty()).collect();
    let numbers = parts.iter().all(|part| lexical::is(part, lexical::number));
    match parts.as_slice() {
        [whole, decimals] if numbers && decimals.bytes().all(|b| b.is_ascii_digit()) => {
            let decimal = format!("{whole}.{decimals}");
            let said = match lexical::is(&decimal, lexical::number) {
                true => at.write(said, &decimal),
                false => said,
            };
            at.write(said, &format!("{whole} {decimals}"))
        }
        [] => said,
        parts => at.write(said, &parts.join(" ")),
    }
}

fn wants_file(slip: &Slip<'_>) -> bool {
    let form_takes_file = slip.keyword.row().forms.iter().any(|form| {
        let parameter = form.parameters.get(slip.before.len());
        parameter.is_some_and(|parameter| matches!(parameter.takes, Takes::File | Takes::Text))
    });
    let model = matches!(
        slip.before.first().map(|first| &first.kind),
        Some(ArgumentKind::Word(kind)) if slip.keyword == Keyword::Shape && kind.eq_ignore_ascii_case("model")
    );
    form_takes_file || model && slip.before.len() == 1
}

fn is_unit(unit: &str) -> bool {
    const UNITS: [&str; 12] = [
        "px", "mm", "cm", "m", "in", "pt", "pc", "em", "deg", "°", "%", "s",
    ];
    UNITS.iter().any(|known| known.eq_ignore_ascii_case(unit))
}
