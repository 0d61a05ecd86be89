//! What can be written at a place.

use std::collections::BTreeSet;
use std::ops::Range;

use super::Analysis;
use super::at::attributes;
use super::quoting::{Role, written};
use super::typed::{Typed, typed_at};
use crate::bind::{PartKind, Place};
use crate::lang::ast::{Annotation, Argument, ArgumentKind, Attribute};
use crate::lang::keyword::colours::COLOURS;
use crate::lang::keyword::kinds::{KINDS, Kind};
use crate::lang::keyword::signature::Takes;
use crate::lang::keyword::words::{AXES, FUNCTIONS, STRINGS};
use crate::lang::keyword::{Holder, Keyword, Status};
use crate::lang::{self, explain, folded, in_name, in_word, slot};
use crate::source::{Span, Text};

/// What is known where something is typed.
pub struct Context<'a> {
    /// The drawing's text as it is now.
    pub source: &'a str,
    /// Its last analysis; names come from there.
    pub analysis: &'a Analysis,
    /// Lists the files that the drawing can link to.
    pub files: &'a dyn Fn() -> Vec<String>,
}

/// What can be written, and what it takes the place of.
#[derive(Debug, Clone, PartialEq)]
pub struct Completion {
    /// What is replaced: the word that is typed.
    pub span: Span,
    /// What can stand there, the likeliest first.
    pub proposals: Vec<Proposal>,
}

/// Something that can be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Proposal {
    /// How it is shown and found.
    pub label: String,
    /// What it is.
    pub kind: ProposalKind,
    /// A few words about it.
    pub detail: String,
    /// The word whose manual page tells more.
    pub page: Option<&'static str>,
    /// The text, escaped for XML.
    pub text: String,
    /// The text with places to fill in, in the syntax of snippets, escaped for XML; where there are such places.
    pub snippet: Option<String>,
}

/// What a proposal is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProposalKind {
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
    /// A variable.
    Variable,
    /// A function of calculations.
    Function,
    /// A colour.
    Colour,
    /// A file.
    File,
}

/// The string that is being written, up to the place.
struct Cursor<'a> {
    context: &'a Context<'a>,
    text: &'a Text,
    /// What stands before the place, decoded.
    head: &'a str,
    in_desc: bool,
    /// Index of the string in the sheet, if it is there.
    string: Option<usize>,
}

/// What can be written at byte `offset` of the text as it is now; `None` where no string is.
pub fn completion(context: &Context<'_>, offset: usize) -> Option<Completion> {
    let analysis = context.analysis;
    let is_current = analysis.is_sound() && **analysis.source() == *context.source;
    if let Some((string, at)) = is_current.then(|| analysis.string_at(offset)).flatten() {
        let found = &analysis.sheet().strings[string];
        let cursor = Cursor {
            context,
            text: &found.text,
            head: found.text.as_str().get(..at)?,
            in_desc: !matches!(found.place, Place::Label(_)),
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
    match text.as_str().is_empty() {
        true => Some(Completion {
            span: Span::at(offset),
            proposals: cursor.starts(),
        }),
        false => cursor.completion(),
    }
}

impl Cursor<'_> {
    fn completion(&self) -> Option<Completion> {
        if self.head.trim().is_empty() {
            let word = self.head.len()..self.head.len();
            let is_empty = self.text.as_str().trim().is_empty();
            let starts = if is_empty { self.starts() } else { vec![] };
            return Some(self.replacing(word, starts));
        }
        let (annotation, _) = self.parsed(self.head);
        match &annotation {
            Annotation::Defaults(_) | Annotation::Legend(_) => {}
            Annotation::Part(part)
                if part.signs.iter().any(|sign| is_sign(self.head, sign, '$')) => {}
            Annotation::Part(part) if !part.signs.is_empty() => {
                let from = part.signs[0].end;
                let blank = self.head[from..].len() - self.head[from..].trim_start().len();
                return Some(self.replacing(from + blank..self.head.len(), self.parents()));
            }
            _ => return None,
        }
        self.in_attributes()
    }

    /// How a string can begin.
    fn starts(&self) -> Vec<Proposal> {
        let rows = STRINGS.iter().filter(|row| match self.in_desc {
            true => matches!(row.sign, "" | "$" | "*"),
            false => row.sign != "^",
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
                label: label.to_owned(),
                kind: ProposalKind::String,
                detail: row.summary.to_owned(),
                page: None,
                text: self.escape(&text),
                snippet: Some(self.escape(&snippet)),
            }
        })
        .collect()
    }

    /// What can stand behind `$` and `%`.
    fn in_attributes(&self) -> Option<Completion> {
        if let Some(quote) = open_quote(self.head) {
            let (annotation, _) = self.parsed(&self.head[..quote]);
            let proposals = self.arguments(attributes(&annotation).last()?, true);
            return Some(self.replacing(quote..self.head.len(), proposals));
        }
        let word = self.word();
        let before = &self.head[..word.start];
        let (annotation, _) = self.parsed(before);
        if open_parenthesis(before) {
            let mut proposals = self.variables();
            proposals.extend(self.functions());
            return Some(self.replacing(word, proposals));
        }
        let written = attributes(&annotation);
        let mut proposals = vec![];
        if let Some(last) = written.last() {
            proposals.extend(self.flags(last));
            proposals.extend(self.arguments(last, false));
        }
        if written.last().is_none_or(can_end) {
            proposals.extend(self.keywords(&annotation));
        }
        Some(self.replacing(word, proposals))
    }

    /// The word before the place: it may begin with a sign of numbers, flags and colours.
    fn word(&self) -> Range<usize> {
        let letters = self.head.trim_end_matches(in_word);
        let start = letters.strip_suffix(['-', '+', '#']).unwrap_or(letters);
        start.len()..self.head.len()
    }

    fn parsed(&self, head: &str) -> (Annotation, usize) {
        let place = match self.in_desc {
            true => lang::Place::Desc,
            false => lang::Place::Text,
        };
        let (annotation, findings) = lang::parse(&Text::plain(head, 0), place);
        (annotation, findings.len())
    }

    /// The parts that the string's own part can hang on.
    fn parents(&self) -> Vec<Proposal> {
        let sheet = self.context.analysis.sheet();
        let own = match self.string {
            Some(string) => self.context.analysis.part_of_string(string),
            None => None,
        };
        let typed = own_name_of(self.text, self.in_desc);
        let below = |part: usize| {
            let mut at = Some(part);
            // A cycle of parents is cut by the binder, so the way up ends.
            while let Some(here) = at {
                if Some(here) == own {
                    return true;
                }
                at = sheet.parts[here].parent;
            }
            false
        };
        let parts = sheet.parts.iter().enumerate().filter(|(index, part)| {
            part.kind == PartKind::Main
                && !part.name.is_empty()
                && typed.as_deref() != Some(part.name.as_str())
                && !below(*index)
        });
        parts
            .map(|(_, part)| {
                let on = part
                    .parent
                    .map(|parent| format!("on {}", sheet.parts[parent].name));
                Proposal {
                    label: part.name.clone(),
                    kind: ProposalKind::Part,
                    detail: on.unwrap_or_else(|| "on the root".to_owned()),
                    page: None,
                    text: self.escape(&written(&part.name, Role::Head)),
                    snippet: None,
                }
            })
            .collect()
    }

    /// The keywords that can stand here and are not given yet.
    fn keywords(&self, annotation: &Annotation) -> Vec<Proposal> {
        let holder = match annotation {
            Annotation::Defaults(_) => Holder::Defaults,
            Annotation::Legend(_) => Holder::Legend,
            _ => Holder::Part,
        };
        let whole = self.string.map(|string| {
            let string = &self.context.analysis.sheet().strings[string];
            attributes(&string.annotation)
        });
        let given: BTreeSet<Keyword> = whole
            .unwrap_or(attributes(annotation))
            .iter()
            .map(|attribute| attribute.keyword)
            .filter(|keyword| !matches!(keyword, Keyword::Let | Keyword::Motion))
            .collect();
        // What is built comes first; the rest can be written, and says that it has no effect yet.
        let mut keywords: Vec<Keyword> = Keyword::ALL.to_vec();
        keywords
            .retain(|keyword| keyword.row().allowed.permits(holder) && !given.contains(keyword));
        keywords.sort_by_key(|keyword| keyword.row().status == Status::Planned);
        keywords
            .into_iter()
            .map(|keyword| {
                let row = keyword.row();
                let later = match row.status {
                    Status::Built => "",
                    Status::Planned => " (no effect yet)",
                };
                Proposal {
                    label: keyword.name().to_owned(),
                    kind: ProposalKind::Keyword,
                    detail: format!("{}{later}", row.summary),
                    page: Some(keyword.name()),
                    text: keyword.name().to_owned(),
                    snippet: self.filled(keyword.name(), example_arguments(keyword)),
                }
            })
            .collect()
    }

    fn flags(&self, attribute: &Attribute) -> Vec<Proposal> {
        if !attribute.arguments.is_empty() {
            return vec![];
        }
        let given = |letter| {
            attribute
                .flags
                .iter()
                .any(|(given, _)| given.eq_ignore_ascii_case(&letter))
        };
        let flags = attribute.keyword.row().flags.iter();
        flags
            .filter(|flag| !given(flag.letter))
            .map(|flag| Proposal {
                label: format!("-{}", flag.letter),
                kind: ProposalKind::Flag,
                detail: flag.summary.to_owned(),
                page: Some(attribute.keyword.name()),
                text: format!("-{}", flag.letter),
                snippet: None,
            })
            .collect()
    }

    /// What the next argument of an attribute can be. In quotes only files and names stand.
    fn arguments(&self, attribute: &Attribute, in_quotes: bool) -> Vec<Proposal> {
        let next = attribute.arguments.len();
        let is_variable = |name: &str| self.context.analysis.is_variable(name);
        let forms: Vec<&Takes> = match (next, attribute.keyword) {
            (0, keyword) => {
                let forms = keyword.row().forms.iter();
                let first = forms.filter_map(|form| form.parameters.first());
                first.map(|parameter| &parameter.takes).collect()
            }
            _ => slot(attribute, next, &is_variable)
                .map(|slot| &slot.parameter().takes)
                .into_iter()
                .collect(),
        };
        let mut proposals = vec![];
        for takes in forms {
            let is_quoted = matches!(takes, Takes::File | Takes::Text | Takes::Names);
            if in_quotes && !is_quoted {
                continue;
            }
            match takes {
                Takes::Kind => proposals.extend(KINDS.iter().map(|kind| self.kind(kind))),
                Takes::Choice(words) => proposals.extend(words.iter().map(|word| Proposal {
                    page: Some(attribute.keyword.name()),
                    ..simple(word.name, ProposalKind::Word, word.summary)
                })),
                Takes::SignedAxis => {
                    let given = |name: &str| {
                        attribute.arguments.iter().any(|argument| {
                            matches!(&argument.kind, ArgumentKind::Word(word) if word[1..].eq_ignore_ascii_case(&name[1..]))
                        })
                    };
                    let axes = AXES.iter().filter(|axis| !given(axis.name));
                    proposals.extend(
                        axes.map(|axis| simple(axis.name, ProposalKind::Word, axis.summary)),
                    );
                }
                Takes::ColourName => {
                    proposals.extend(
                        COLOURS
                            .iter()
                            .map(|name| simple(name, ProposalKind::Colour, "a colour")),
                    );
                }
                Takes::Number(_) => proposals.extend(self.variables()),
                Takes::File => proposals.extend(self.files(attribute)),
                Takes::Names if attribute.keyword == Keyword::Follow => {
                    let parts = self.parents().into_iter();
                    proposals.extend(parts.map(|part| Proposal {
                        text: self.escape(&written(&part.label, Role::Argument)),
                        ..part
                    }));
                }
                Takes::Names | Takes::Text | Takes::Variable | Takes::Hex => {}
            }
        }
        proposals
    }

    fn kind(&self, kind: &'static Kind) -> Proposal {
        let later = match kind.status {
            Status::Built => "",
            Status::Planned => " (no effect yet)",
        };
        Proposal {
            page: Some(kind.name),
            detail: format!("{}{later}", kind.summary),
            snippet: self.filled(kind.name, kind_arguments(kind)),
            ..simple(kind.name, ProposalKind::Word, "")
        }
    }

    fn variables(&self) -> Vec<Proposal> {
        let variables = self.context.analysis.sheet().variables.iter();
        variables
            .map(|(name, variable)| {
                let value = variable.value.map(|value| value.to_string());
                let value = value.unwrap_or_else(|| "no value".to_owned());
                simple(name, ProposalKind::Variable, &value)
            })
            .collect()
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

    /// The files of the drawing's folder that the attribute can use.
    fn files(&self, attribute: &Attribute) -> Vec<Proposal> {
        let endings: &[&str] = match attribute.keyword {
            Keyword::Texture => &["png", "jpg", "jpeg", "gif", "webp"],
            Keyword::Shape => &["glb", "gltf"],
            Keyword::Motion => &["bvh"],
            _ => &["json"],
        };
        let fits = |name: &String| {
            let ending = name
                .rsplit_once('.')
                .map(|(_, ending)| ending.to_lowercase());
            ending.is_some_and(|ending| endings.contains(&ending.as_str()))
        };
        let files = (self.context.files)().into_iter().filter(fits);
        files
            .filter(|name| !name.contains('"'))
            .map(|name| Proposal {
                text: self.escape(&format!("\"{name}\"")),
                ..simple(&name, ProposalKind::File, "in the drawing's folder")
            })
            .collect()
    }

    /// A word with the arguments that its example gives, each to be typed over.
    fn filled(&self, word: &str, arguments: Vec<String>) -> Option<String> {
        if arguments.is_empty() {
            return None;
        }
        let mut out = word.to_owned();
        for (index, argument) in arguments.iter().enumerate() {
            let (open, inner, close) = match argument.strip_prefix('"') {
                Some(inner) => ("\"", inner.trim_end_matches('"'), "\""),
                None => ("", argument.as_str(), ""),
            };
            let inner = inner
                .replace('\\', "\\\\")
                .replace('$', "\\$")
                .replace('}', "\\}");
            out.push_str(&format!(" {open}${{{}:{inner}}}{close}", index + 1));
        }
        Some(self.escape(&out))
    }

    fn escape(&self, text: &str) -> String {
        self.text.escape_at(self.head.len(), text)
    }

    /// The proposals, in place of the word `range` of the decoded string and what of it stands behind the place.
    fn replacing(&self, range: Range<usize>, proposals: Vec<Proposal>) -> Completion {
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
                tail.len() - tail.trim_start_matches(in_name).len()
            }
            Some(_) => tail.len() - tail.trim_start_matches(in_word).len(),
            None => 0,
        };
        let whole = self.text.span(range.start..range.end + rest);
        let span = match self.text.is_whole(whole) {
            true => whole,
            false => self.text.span(range.end..range.end),
        };
        let mut seen = BTreeSet::new();
        let mut proposals = proposals;
        proposals.retain(|proposal| seen.insert((proposal.label.clone(), proposal.kind as u8)));
        Completion { span, proposals }
    }
}

/// A proposal that is written as it is shown.
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

/// The name that a text gives its part, whether it is bound yet or not.
fn own_name_of(text: &Text, in_desc: bool) -> Option<String> {
    let place = if in_desc {
        lang::Place::Desc
    } else {
        lang::Place::Text
    };
    let (annotation, _) = lang::parse(&Text::plain(text.as_str(), 0), place);
    match annotation {
        Annotation::Part(part) => part.name.map(|name| name.text),
        _ => None,
    }
}

fn is_sign(text: &str, range: &Range<usize>, sign: char) -> bool {
    folded(&text[range.clone()]).starts_with(sign)
}

/// Where a quote is opened that is not closed.
fn open_quote(head: &str) -> Option<usize> {
    let mut open = None;
    for (at, c) in head.char_indices() {
        if matches!(c, '"' | '＂') {
            open = match open {
                None => Some(at),
                Some(_) => None,
            };
        }
    }
    open
}

/// Whether a parenthesis is opened that is not closed.
fn open_parenthesis(head: &str) -> bool {
    let mut depth = 0_usize;
    for c in folded(head).chars() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    depth > 0
}

/// Whether an attribute has all that it needs, so that another can follow.
fn can_end(attribute: &Attribute) -> bool {
    let count = attribute.arguments.len();
    let kind = match attribute.arguments.first().map(|first| &first.kind) {
        Some(ArgumentKind::Word(word)) if attribute.keyword == Keyword::Shape => KINDS
            .iter()
            .find(|kind| kind.name.eq_ignore_ascii_case(word)),
        _ => None,
    };
    match kind {
        Some(kind) => kind.form.fits(count - 1),
        None => {
            let forms = attribute.keyword.row().forms;
            forms.iter().any(|form| form.fits(count))
        }
    }
}

/// The arguments that a keyword has in its example.
fn example_arguments(keyword: Keyword) -> Vec<String> {
    arguments_of(keyword.row().example, keyword, 0)
}

/// The parameters that a kind of shape has in its example.
fn kind_arguments(kind: &Kind) -> Vec<String> {
    arguments_of(kind.example, Keyword::Shape, 1)
}

/// The arguments of a keyword in a string, without the first few.
fn arguments_of(string: &str, keyword: Keyword, skipped: usize) -> Vec<String> {
    let (annotation, _) = lang::parse(&Text::plain(string, 0), lang::Place::Text);
    let found = attributes(&annotation)
        .iter()
        .find(|attribute| attribute.keyword == keyword);
    let arguments = found.map_or(&[][..], |attribute| attribute.arguments.as_slice());
    let words = arguments.iter().skip(skipped);
    words
        .map(|argument: &Argument| string[argument.range.clone()].to_owned())
        .collect()
}

/// A snippet's text, its places filled as they are.
fn plain(snippet: &str) -> String {
    let mut out = String::new();
    let mut rest = snippet;
    while let Some(c) = rest.chars().next() {
        rest = &rest[c.len_utf8()..];
        match c {
            '\\' => {
                let escaped = rest.chars().next();
                out.extend(escaped);
                rest = &rest[escaped.map_or(0, char::len_utf8)..];
            }
            '$' => {
                let inner = rest
                    .split_once(':')
                    .and_then(|(_, inner)| inner.split_once('}'));
                let (inner, behind) = inner.unwrap_or_default();
                out.push_str(inner);
                rest = behind;
            }
            c => out.push(c),
        }
    }
    out
}

impl Proposal {
    /// The manual page of what it is, in Markdown.
    pub fn manual(page: &str) -> Option<String> {
        explain::page(page)
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{analysis, figure};
    use super::*;

    fn proposed(source: &str) -> Option<(String, Vec<Proposal>)> {
        let (analysis, at) = analysis(source);
        let files = || {
            vec![
                "a.png".to_owned(),
                "b/c d.glb".to_owned(),
                "e.txt".to_owned(),
            ]
        };
        let context = Context {
            source: &analysis.source().clone(),
            analysis: &analysis,
            files: &files,
        };
        let found = completion(&context, at)?;
        let replaced = analysis.source()[found.span.start..found.span.end].to_owned();
        Some((replaced, found.proposals))
    }

    fn labels(string: &str) -> (String, Vec<String>) {
        let source = figure(["Body", string, "Larm@Rarm", "", "%Let wide 12"]);
        let (replaced, proposals) = proposed(&source).unwrap();
        (
            replaced,
            proposals
                .into_iter()
                .map(|proposal| proposal.label)
                .collect(),
        )
    }

    #[test]
    fn parents_are_all_but_oneself_and_what_one_carries() {
        assert_eq!(labels("Rarm@¦"), (String::new(), vec!["Body".to_owned()]));
        assert_eq!(labels("Rarm@Bo¦dx$Shape round").0, "Bodx");
    }

    #[test]
    fn keywords_stand_where_they_can() {
        let (replaced, found) = labels("Rarm@Body$Sh¦");
        assert_eq!(replaced, "Sh");
        assert!(found.contains(&"Shape".to_owned()) && !found.contains(&"Scale".to_owned()));
        let (_, found) = labels("Rarm@Body$Offset 3 ¦");
        assert!(!found.contains(&"Offset".to_owned()) && found.contains(&"Shape".to_owned()));
        let (_, found) = labels("%¦");
        assert!(found.contains(&"Scale".to_owned()) && found.contains(&"Shape".to_owned()));
        // What must still be given is proposed alone.
        let (_, found) = labels("Rarm@Body$Offset ¦");
        assert_eq!(found, ["wide"]);
    }

    #[test]
    fn arguments_go_by_their_parameter() {
        for (string, expected) in [
            ("Rarm@Body$Shape ¦", "inflate"),
            ("Rarm@Body$Shape ¦", "-d"),
            ("Rarm@Body$Shape -¦", "-s"),
            ("Rarm@Body$Shape cone ¦", "wide"),
            ("Rarm@Body$Origin ¦", "center"),
            ("Rarm@Body$Color ¦", "orange"),
            ("Rarm@Body$Offset (¦", "sqrt"),
            ("Rarm@Body$Offset (2 * ¦)", "wide"),
            ("Rarm@Body$Texture ¦", "a.png"),
            ("Rarm@Body$Texture \"¦", "a.png"),
            ("Rarm@Body$Shape model \"b¦\"", "b/c d.glb"),
            ("Rarm@Body$Mark red Follow ¦", "Body"),
            ("%Axes +x ¦", "-y"),
        ] {
            let (_, found) = labels(string);
            assert!(found.contains(&expected.to_owned()), "{string}: {found:?}");
        }
        assert!(!labels("%Axes +x ¦").1.contains(&"-x".to_owned()));
        assert_eq!(labels("Rarm@Body$Texture \"¦a.png\"").0, "\"a.png\"");
    }

    #[test]
    fn nothing_is_proposed_outside_of_strings() {
        for source in [
            figure(["Body", "Rarm@Body", "", "", ""])
                .replace("<rect id=\"right\"", "<rect ¦id=\"right\""),
            figure(["Body", "# Rarm@¦", "", "", ""]),
            figure(["Body", "Rarm ¦", "", "", ""]),
        ] {
            assert!(
                proposed(&source).is_none_or(|(_, found)| found.is_empty()),
                "{source}"
            );
        }
    }

    #[test]
    fn an_empty_text_can_begin_any_string() {
        let source = figure(["Body", "<tspan>¦</tspan>", "", "", ""]);
        let (_, found) = proposed(&source).unwrap();
        let named: Vec<_> = found
            .iter()
            .map(|proposal| proposal.label.as_str())
            .collect();
        assert_eq!(named, ["# …", "% …", "*", "$ …", "Name@Parent$ …"]);
        assert_eq!(found[4].text, "Name@Parent$Shape roundv");
    }

    #[test]
    fn a_text_that_is_no_drawing_is_read_around_the_place() {
        let (good, _) = analysis(&figure(["Body", "Rarm@Body", "", "", ""]));
        let source = figure(["Body", "Rarm@Body$Shape ¦", "", "", ""]).replace("</svg>", "<text>&");
        let at = source.find('¦').unwrap();
        let source = source.replacen('¦', "", 1);
        let context = Context {
            source: &source,
            analysis: &good,
            files: &Vec::new,
        };
        let found = completion(&context, at).unwrap();
        assert!(
            found
                .proposals
                .iter()
                .any(|proposal| proposal.label == "roundv")
        );
    }

    #[test]
    fn every_example_fills_its_keyword() {
        for keyword in Keyword::ALL {
            let takes_nothing = keyword.row().forms.iter().all(|form| form.most() == 0);
            assert_eq!(
                example_arguments(*keyword).is_empty(),
                takes_nothing,
                "{}",
                keyword.name()
            );
        }
        assert_eq!(example_arguments(Keyword::Color), ["1", "0.8", "0.6"]);
    }
}
