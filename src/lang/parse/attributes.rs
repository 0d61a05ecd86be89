//! Parses attributes: a keyword, its flags and its arguments.

use super::{Parser, lexical, suggestions};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::{Argument, ArgumentKind, Attribute};
use crate::lang::keyword::signature::Takes;
use crate::lang::keyword::{Keyword, kinds, vocabulary};
use crate::lang::motion;

impl Parser<'_> {
    /// Reads attributes to the end of the string.
    pub(super) fn attributes(&mut self) -> Vec<Attribute> {
        let mut attributes: Vec<Attribute> = vec![];
        loop {
            self.skip_blank();
            let rest = self.rest();
            if rest.is_empty() {
                return attributes;
            }
            if starts_sign(rest) {
                self.drop_name_of_next_string(attributes.last_mut());
                self.unexpected_sign();
            } else if let Some((keyword, length)) = keyword_at(rest) {
                let attribute = self.attribute(keyword, length);
                attributes.push(attribute);
            } else {
                self.unknown_keyword();
            }
        }
    }

    fn attribute(&mut self, keyword: Keyword, length: usize) -> Attribute {
        let start = self.at;
        self.at += length;
        let keyword_range = self.range(start..self.at);
        let mut end = self.at;
        let mut flags = vec![];
        if !starts_with_axis(keyword) {
            loop {
                self.skip_blank();
                let Ok((rest, letters)) = lexical::flags(self.rest()) else {
                    break;
                };
                for (index, letter) in letters.char_indices() {
                    let at = self.at + 1 + index;
                    flags.push((letter, self.range(at..at + 1)));
                }
                self.move_to(rest);
                end = self.at;
            }
        }
        let mut arguments = vec![];
        loop {
            self.skip_blank();
            let rest = self.rest();
            let is_word = if arguments.is_empty() {
                starts_with_word_of(keyword, rest)
            } else {
                keyword == Keyword::Motion && continues_motion(&arguments, rest)
            };
            let ends = starts_sign(rest) || keyword_at(rest).is_some_and(|_| !is_word);
            if rest.is_empty() || ends {
                break;
            }
            let argument = self.argument(keyword, &flags, &arguments);
            arguments.push(argument);
            end = self.at;
        }
        Attribute {
            keyword,
            keyword_range,
            flags,
            arguments,
            range: self.range(start..end.max(start + length)),
        }
    }

    /// Reports text in the place of a keyword, and continues at the next attribute.
    fn unknown_keyword(&mut self) {
        let rest = self.rest();
        let length = match lexical::run(rest) {
            0 => rest.chars().next().map_or(0, char::len_utf8),
            length => length,
        };
        let found = &rest[..length];
        let range = self.range(self.at..self.at + length);
        let diagnostic = suggestions::unknown_keyword(self.text, range, found);
        self.report(diagnostic);
        self.at += match found {
            // `skip_to_attribute` skips quotes and parentheses together with their contents.
            "\"" | "(" => 0,
            _ => length,
        };
        self.skip_to_attribute(found.starts_with(char::is_lowercase));
    }

    /// Goes to the next keyword, misspelled keyword, or sign. Words in parentheses and quotes do not
    /// count. Misspelled keywords in lower case count only if `lower_case` is set.
    pub(super) fn skip_to_attribute(&mut self, lower_case: bool) {
        let mut depth = 0_usize;
        loop {
            self.skip_blank();
            let rest = self.rest();
            let Some(c) = rest.chars().next() else {
                return;
            };
            if starts_sign(rest) || keyword_at(rest).is_some() {
                return;
            }
            if let Ok((after, _)) = lexical::quoted(rest) {
                self.move_to(after);
                continue;
            }
            match c {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                _ => {}
            }
            let run = lexical::run(rest);
            if run > 0 && depth == 0 && suggestions::is_misspelled_keyword(&rest[..run], lower_case)
            {
                return;
            }
            self.at += run.max(c.len_utf8());
        }
    }

    /// Reports the next sign, but only once in a string, and continues after the sign and its name.
    pub(super) fn unexpected_sign(&mut self) {
        let at = self.at;
        let rest = self.rest();
        let Some(sign) = rest.chars().next() else {
            return;
        };
        self.at += sign.len_utf8();
        if !self.sign_reported {
            self.sign_reported = true;
            let span = self.span(at..self.at);
            let message = format!("`{sign}` is not allowed here");
            let diagnostic = Diagnostic::new(Code::UnexpectedSign, span, message);
            let doubled = self.normalized.as_str()[..at].ends_with(sign);
            let diagnostic = if doubled {
                diagnostic
                    .label("the sign was typed twice")
                    .fix("Delete the second sign", span, "")
                    .safe()
            } else {
                diagnostic.label("a new string seems to begin here").help(
                    "two strings seem to have been typed into one text: cut the second one out and \
                     paste it into a text of its own",
                )
            };
            self.report(diagnostic);
        }
        if matches!(sign, '@' | '*' | '^') {
            self.skip_blank();
            match lexical::quoted(self.rest()) {
                Ok((after, _)) => self.move_to(after),
                Err(_) => self.at += lexical::run(self.rest()),
            }
        }
    }

    /// In `Shape round Larm@Body` the word before the sign is not an argument, but the name in another string.
    fn drop_name_of_next_string(&self, attribute: Option<&mut Attribute>) {
        let Some(attribute) = attribute else { return };
        let sign = self.range(self.at..self.at).start;
        let Some(last) = attribute.arguments.last() else {
            return;
        };
        let ArgumentKind::Word(word) = &last.kind else {
            return;
        };
        let adjacent = last.range.end == sign;
        if adjacent && !vocabulary::is_known(word) && fits_without_last(attribute) {
            attribute.arguments.pop();
        }
    }
}

/// Whether the number of arguments is also right without the last one.
fn fits_without_last(attribute: &Attribute) -> bool {
    let left = attribute.arguments.len().saturating_sub(1);
    let kind = match attribute.arguments.first().map(|first| &first.kind) {
        Some(ArgumentKind::Word(kind)) if attribute.keyword == Keyword::Shape => {
            kinds::from_name(kind)
        }
        _ => None,
    };
    match kind {
        _ if attribute.keyword == Keyword::Motion => {
            motion::is_complete(&attribute.arguments[..left])
        }
        Some(kind) => left >= 1 && kind.form.accepts(left - 1),
        None => attribute
            .keyword
            .row()
            .forms
            .iter()
            .any(|form| form.accepts(left)),
    }
}

/// The keyword at the start of `rest`, and its length. Flags or a colour may follow without a space.
fn keyword_at(rest: &str) -> Option<(Keyword, usize)> {
    let run = &rest[..lexical::run(rest)];
    let (after, word) = lexical::word(run).ok()?;
    (after.is_empty() || after.starts_with(['-', '#']))
        .then(|| Keyword::from_name(word))?
        .map(|keyword| (keyword, word.len()))
}

/// Whether `rest` starts with a sign that can only start another string.
fn starts_sign(rest: &str) -> bool {
    let mut chars = rest.chars();
    match chars.next() {
        Some('$' | '@' | '%') => true,
        Some('*' | '^') => chars.next().is_some_and(char::is_alphabetic),
        _ => false,
    }
}

/// What the first argument of a keyword may be.
fn first_takes(keyword: Keyword) -> impl Iterator<Item = &'static Takes> {
    let forms = keyword.row().forms.iter();
    let first = forms.filter_map(|form| form.parameters.first());
    first.map(|parameter| &parameter.takes)
}

/// Whether what follows a keyword, `-x` for example, is an axis and not a flag.
fn starts_with_axis(keyword: Keyword) -> bool {
    first_takes(keyword).any(|takes| matches!(takes, Takes::SignedAxis))
}

/// Whether `rest` begins with a clip that plays in turn, and not with the keyword `Walk`.
fn continues_motion(before: &[Argument], rest: &str) -> bool {
    let (run, behind) = rest.split_at(lexical::run(rest));
    let behind = behind.trim_start();
    let is_timed = behind.starts_with('(') || {
        let next = &behind[..lexical::run(behind)];
        lexical::is(next, lexical::number)
    };
    motion::continues(before, run, is_timed)
}

/// Whether `rest` begins with one of the words that a keyword takes as its first argument: in `Motion walk`, the word is not the
/// keyword `Walk`.
fn starts_with_word_of(keyword: Keyword, rest: &str) -> bool {
    let run = &rest[..lexical::run(rest)];
    first_takes(keyword).any(|takes| match takes {
        Takes::Choice(words) => words.iter().any(|word| word.name.eq_ignore_ascii_case(run)),
        _ => false,
    })
}
