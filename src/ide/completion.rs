//! Completion: what can be written at an offset.

mod choice;
mod joints;
mod marks;
mod parents;
mod snippets;
#[cfg(test)]
mod tests;
mod unfinished;

use std::collections::BTreeSet;
use std::ops::Range;

use super::Analysis;
use super::at::attributes;
use super::typed::{Typed, typed_at};
use crate::bind::{StringHolder, StringId};
use crate::lang::ast::{Annotation, ArgumentKind, Attribute};
use crate::lang::keyword::colors::COLORS;
use crate::lang::keyword::kinds::{KINDS, Kind};
use crate::lang::keyword::signature::Takes;
use crate::lang::keyword::vocabulary::{AXES, FUNCTIONS, STRINGS};
use crate::lang::keyword::{AttributeString, Keyword};
use crate::lang::quoting::NamePlace;
use crate::lang::{self, is_name_char, is_word_char, normalize, parameter_at};
use crate::source::{Span, Text};
use choice::{Choice, choose};
use snippets::{example_arguments, filled, kind_arguments, plain};
use unfinished::{can_end, open_parenthesis, open_quote};

/// The input of a completion.
pub(crate) struct Context<'a> {
    /// The drawing's present text.
    pub source: &'a str,
    /// Its last analysis, which has the names.
    pub analysis: &'a Analysis,
    /// Lists the files that the drawing can link to.
    pub files: &'a dyn Fn() -> Vec<String>,
}

/// Proposals, and the word that they replace.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Completion {
    /// The span that is replaced: the word at the cursor.
    pub span: Span,
    /// The proposals, the likeliest first.
    pub proposals: Vec<Proposal>,
    /// Whether there are more parts, joints, variables or files than are listed, so that another letter of the word
    /// can bring others.
    pub is_incomplete: bool,
}

/// A proposal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Proposal {
    /// The label that is shown.
    pub label: String,
    /// What it is.
    pub kind: ProposalKind,
    /// A short description.
    pub detail: String,
    /// The word whose manual page describes it.
    pub page: Option<&'static str>,
    /// The text to insert, escaped for XML.
    pub text: String,
    /// The same as a snippet with placeholders, escaped for XML, if there are any.
    pub snippet: Option<String>,
}

/// The kind of a proposal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ProposalKind {
    /// A whole string.
    String,
    /// A keyword.
    Keyword,
    /// A kind of shape, or another word of the language.
    Word,
    /// A flag.
    Flag,
    /// A part's name.
    Part,
    /// A joint of a motion.
    Joint,
    /// A variable.
    Variable,
    /// A function of calculations.
    Function,
    /// A colour.
    Color,
    /// A file.
    File,
}

/// The string that is being written, up to the cursor.
struct Cursor<'a> {
    context: &'a Context<'a>,
    text: &'a Text,
    /// The decoded text before the cursor.
    head: &'a str,
    in_desc: bool,
    /// Index of the string in the bindings, if it is bound.
    string: Option<StringId>,
}

/// The completion at byte `offset` of the present text; `None` outside of strings.
pub(crate) fn completion(context: &Context<'_>, offset: usize) -> Option<Completion> {
    let analysis = context.analysis;
    let is_current = analysis.is_sound() && **analysis.source() == *context.source;
    if let Some((string, at)) = is_current.then(|| analysis.string_at(offset)).flatten() {
        let found = &analysis.bindings().strings[string];
        let cursor = Cursor {
            context,
            text: &found.text,
            head: found.text.as_str().get(..at)?,
            in_desc: !matches!(found.holder, StringHolder::Label(_)),
            string: Some(string),
        };
        return cursor.completion();
    }
    let Typed {
        text,
        offset: at,
        in_desc,
    } = typed_at(context.source, offset)?;
    let cursor = Cursor {
        context,
        text: &text,
        head: text.as_str().get(..at)?,
        in_desc,
        string: None,
    };
    if text.as_str().is_empty() {
        Some(Completion {
            span: Span::at(offset),
            proposals: cursor.starts(),
            is_incomplete: false,
        })
    } else {
        cursor.completion()
    }
}

impl Cursor<'_> {
    fn completion(&self) -> Option<Completion> {
        if self.head.trim().is_empty() {
            let word = self.head.len()..self.head.len();
            let is_empty = self.text.as_str().trim().is_empty();
            let starts = if is_empty { self.starts() } else { vec![] };
            return Some(self.replacing(word, starts.into()));
        }
        let (annotation, _) = parsed(self.head, self.in_desc);
        match &annotation {
            Annotation::Defaults(_) | Annotation::Legend(_) => {}
            Annotation::Part(part)
                if part.signs.iter().any(|sign| is_sign(self.head, sign, '$')) => {}
            Annotation::Part(part) if !part.signs.is_empty() => {
                let from = part.signs[0].end;
                let blank = self.head[from..].len() - self.head[from..].trim_start().len();
                let word = from + blank..self.head.len();
                let parents = self.parents(&self.head[word.clone()], NamePlace::Head);
                return Some(self.replacing(word, parents));
            }
            _ => return None,
        }
        self.in_attributes()
    }

    /// The proposals at the start of a string.
    fn starts(&self) -> Vec<Proposal> {
        let rows = STRINGS.iter().filter(|row| {
            if self.in_desc {
                matches!(row.sign, "" | "$" | "*")
            } else {
                row.sign != "^"
            }
        });
        rows.map(|row| {
            let (label, snippet) = match row.sign {
                "" => (
                    "Name@Parent$ …",
                    "${1:Name}@${2:Parent}\\$Shape ${3:roundv}".to_owned(),
                ),
                "%" => ("% …", "%${1:Shape} ${2:roundv}".to_owned()),
                "$" => ("$ …", "\\$${1:Shape} ${2:roundv}".to_owned()),
                "*" => ("*", "*".to_owned()),
                _ => ("# …", "# ${1:note}".to_owned()),
            };
            let text = plain(&snippet);
            Proposal {
                text: self.escape(&text),
                snippet: Some(self.escape(&snippet)),
                ..simple(label, ProposalKind::String, row.summary)
            }
        })
        .collect()
    }

    /// The proposals after `$` and `%`.
    fn in_attributes(&self) -> Option<Completion> {
        if let Some(quote) = open_quote(self.head) {
            let (annotation, _) = parsed(&self.head[..quote], self.in_desc);
            let word = &self.head[quote..];
            let proposals = self.arguments(attributes(&annotation).last()?, true, word);
            return Some(self.replacing(quote..self.head.len(), proposals));
        }
        let word = self.word();
        let (before, typed) = self.head.split_at(word.start);
        let (annotation, _) = parsed(before, self.in_desc);
        if open_parenthesis(before) {
            let mut proposals = self.variables(typed);
            proposals.extend(self.functions().into());
            return Some(self.replacing(word, proposals));
        }
        let written = attributes(&annotation);
        let mut proposals = Choice::default();
        if let Some(last) = written.last() {
            proposals.extend(self.flags(last).into());
            proposals.extend(self.arguments(last, false, typed));
        }
        if written.last().is_none_or(can_end) {
            proposals.extend(self.keywords(&annotation).into());
        }
        Some(self.replacing(word, proposals))
    }

    /// The word before the cursor, which may begin with the sign of a number, flag or colour.
    fn word(&self) -> Range<usize> {
        let letters = self.head.trim_end_matches(is_word_char);
        let start = letters.strip_suffix(['-', '+', '#']).unwrap_or(letters);
        start.len()..self.head.len()
    }

    /// The keywords that are allowed here and not given yet.
    fn keywords(&self, annotation: &Annotation) -> Vec<Proposal> {
        let holder = match annotation {
            Annotation::Defaults(_) => AttributeString::Defaults,
            Annotation::Legend(_) => AttributeString::Legend,
            _ => AttributeString::Part,
        };
        let whole = self.string.map(|string| {
            let string = &self.context.analysis.bindings().strings[string];
            attributes(&string.annotation)
        });
        let mut given = BTreeSet::new();
        for attribute in whole.unwrap_or(attributes(annotation)) {
            match attribute.keyword {
                Keyword::Let => {}
                // Each motion can have its own `Limited`, `Held` and `Perform`.
                Keyword::Motion => given.retain(|keyword: &Keyword| !keyword.belongs_to_motion()),
                keyword => drop(given.insert(keyword)),
            }
        }
        Keyword::built()
            .filter(|keyword| keyword.row().allowed.permits(holder) && !given.contains(keyword))
            .map(|keyword| {
                let row = keyword.row();
                Proposal {
                    detail: row.summary.to_owned(),
                    page: Some(keyword.name()),
                    snippet: filled(keyword.name(), &example_arguments(keyword))
                        .map(|snippet| self.escape(&snippet)),
                    ..simple(keyword.name(), ProposalKind::Keyword, "")
                }
            })
            .collect()
    }

    fn flags(&self, attribute: &Attribute) -> Vec<Proposal> {
        if !attribute.arguments.is_empty() {
            return vec![];
        }
        let given = |letter| {
            let mut flags = attribute.flags.iter();
            flags.any(|(given, _)| given.eq_ignore_ascii_case(&letter))
        };
        let flags = attribute.keyword.row().flags.iter();
        flags
            .filter(|flag| !given(flag.letter))
            .map(|flag| Proposal {
                page: Some(attribute.keyword.name()),
                ..simple(
                    &format!("-{}", flag.letter),
                    ProposalKind::Flag,
                    flag.summary,
                )
            })
            .collect()
    }

    /// The proposals for the next argument of an attribute, of which `word` is typed; in quotes only files and names.
    fn arguments(&self, attribute: &Attribute, in_quotes: bool, word: &str) -> Choice<Proposal> {
        let next = attribute.arguments.len();
        let is_variable = |name: &str| self.context.analysis.is_variable(name);
        let forms = attribute.keyword.row().forms.iter();
        let nth = |index: usize| {
            forms
                .clone()
                .filter_map(move |form| form.parameters.get(index))
        };
        // What follows a file tells its forms apart.
        let is_file = nth(0).all(|parameter| matches!(parameter.takes, Takes::File));
        let forms: Vec<&Takes> = match next {
            _ if attribute.keyword == Keyword::Motion => {
                let next = lang::motion::parameters_behind(&attribute.arguments, &is_variable);
                next.iter().map(|slot| &slot.parameter().takes).collect()
            }
            0 => nth(0).map(|parameter| &parameter.takes).collect(),
            1 if is_file => nth(1).map(|parameter| &parameter.takes).collect(),
            _ => parameter_at(attribute, next, &is_variable)
                .map(|slot| &slot.parameter().takes)
                .into_iter()
                .collect(),
        };
        let mut proposals = Choice::default();
        for takes in forms {
            let is_quoted = matches!(takes, Takes::File | Takes::Text | Takes::Names);
            if in_quotes && !is_quoted {
                continue;
            }
            proposals.extend(match takes {
                Takes::Kind => KINDS.iter().map(|kind| self.kind(kind)).collect(),
                Takes::Choice(words) => words
                    .iter()
                    .map(|word| Proposal {
                        page: Some(attribute.keyword.name()),
                        ..simple(word.name, ProposalKind::Word, word.summary)
                    })
                    .collect(),
                Takes::SignedAxis => {
                    let axis = |name: &str| name.trim_start_matches(['+', '-']).to_owned();
                    let given = |name: &str| {
                        attribute.arguments.iter().any(|argument| {
                            matches!(&argument.kind, ArgumentKind::Word(word) if axis(word).eq_ignore_ascii_case(&axis(name)))
                        })
                    };
                    let axes = AXES.iter().filter(|axis| !given(axis.name));
                    axes.map(|axis| simple(axis.name, ProposalKind::Word, axis.summary))
                        .collect()
                }
                Takes::ColorName => COLORS
                    .iter()
                    .map(|name| simple(name, ProposalKind::Color, "a colour"))
                    .collect(),
                Takes::Number(_) => self.variables(word),
                Takes::File => self.files(attribute, word),
                Takes::Names if attribute.keyword == Keyword::Follow => self.other_parts(word),
                Takes::Names if attribute.keyword == Keyword::Bone => {
                    choose(self.joints(attribute), |joint| &joint.label, word)
                }
                Takes::Text if attribute.keyword == Keyword::Perform => self.marks(word),
                Takes::Names | Takes::Text | Takes::Variable | Takes::Hex => Choice::default(),
            });
        }
        proposals
    }

    fn kind(&self, kind: &'static Kind) -> Proposal {
        Proposal {
            page: Some(kind.name),
            detail: kind.summary.to_owned(),
            snippet: filled(kind.name, &kind_arguments(kind)).map(|snippet| self.escape(&snippet)),
            ..simple(kind.name, ProposalKind::Word, "")
        }
    }

    fn variables(&self, word: &str) -> Choice<Proposal> {
        let variables = self.context.analysis.bindings().variables.iter();
        choose(variables.collect(), |(name, _)| name, word).map(|(name, variable)| {
            let value = variable.value.map(|value| value.to_string());
            let value = value.unwrap_or_else(|| "no value".to_owned());
            simple(name, ProposalKind::Variable, &value)
        })
    }

    fn functions(&self) -> Vec<Proposal> {
        FUNCTIONS
            .iter()
            .map(|row| Proposal {
                text: format!("{}()", row.name),
                snippet: Some(format!("{}(${{1}})", row.name)),
                detail: format!("{}: {}", row.usage, row.summary),
                ..simple(row.name, ProposalKind::Function, "")
            })
            .collect()
    }

    /// The files in the drawing's folder that the attribute can use.
    fn files(&self, attribute: &Attribute, word: &str) -> Choice<Proposal> {
        let endings: &[&str] = match attribute.keyword {
            Keyword::Texture => &["png", "jpg", "jpeg", "gif", "webp"],
            Keyword::Shape => &["glb", "gltf"],
            Keyword::Motion => &["bvh"],
            Keyword::Tiles => &["tmx", "tmj"],
            _ => &["json", "csv"],
        };
        let fits = |name: &String| {
            let ending = name
                .rsplit_once('.')
                .map(|(_, ending)| ending.to_lowercase());
            ending.is_some_and(|ending| endings.contains(&ending.as_str()))
        };
        let files = (self.context.files)().into_iter().filter(fits);
        let files = files.filter(|name| !name.contains('"'));
        choose(files.collect(), String::as_str, word).map(|name| Proposal {
            text: self.escape(&format!("\"{name}\"")),
            ..simple(&name, ProposalKind::File, "in the drawing's folder")
        })
    }

    fn escape(&self, text: &str) -> String {
        self.text.escape_at(self.head.len(), text)
    }

    /// The proposals in place of the word `range` of the decoded string, including its characters after the cursor.
    fn replacing(&self, range: Range<usize>, choice: Choice<Proposal>) -> Completion {
        let Choice {
            items: mut proposals,
            is_cut: is_incomplete,
        } = choice;
        let text = self.text.as_str();
        let tail = &text[range.end..];
        let rest = match text[range.clone()].chars().next() {
            Some('"') => {
                let inside = tail.split(['"', '\n']).next().unwrap_or_default().len();
                let closed = tail[inside..].starts_with('"');
                if closed { inside + 1 } else { 0 }
            }
            Some(_)
                if proposals
                    .iter()
                    .any(|proposal| proposal.kind == ProposalKind::Part) =>
            {
                tail.len() - tail.trim_start_matches(is_name_char).len()
            }
            Some(_) => tail.len() - tail.trim_start_matches(is_word_char).len(),
            None => 0,
        };
        let whole = self.text.span(range.start..range.end + rest);
        let span = if self.text.is_whole(whole) {
            whole
        } else {
            self.text.span(range.end..range.end)
        };
        let mut seen = BTreeSet::new();
        proposals.retain(|proposal| seen.insert((proposal.label.clone(), proposal.kind as u8)));
        Completion {
            span,
            proposals,
            is_incomplete,
        }
    }
}

/// A proposal that inserts its label.
fn simple(label: &str, kind: ProposalKind, detail: &str) -> Proposal {
    Proposal {
        label: label.to_owned(),
        kind,
        detail: detail.to_owned(),
        page: None,
        text: label.to_owned(),
        snippet: None,
    }
}

/// A string by itself, and the number of findings in it.
fn parsed(head: &str, in_desc: bool) -> (Annotation, usize) {
    let place = if in_desc {
        lang::Container::Desc
    } else {
        lang::Container::Text
    };
    let (annotation, findings) = lang::parse(&Text::plain(head, 0), place);
    (annotation, findings.len())
}

/// The name that a text gives its part, bound or not.
fn own_name_of(text: &Text, in_desc: bool) -> Option<String> {
    let (annotation, _) = parsed(text.as_str(), in_desc);
    match annotation {
        Annotation::Part(part) => part.name.map(|name| name.text),
        _ => None,
    }
}

fn is_sign(text: &str, range: &Range<usize>, sign: char) -> bool {
    normalize(&text[range.clone()]).starts_with(sign)
}
