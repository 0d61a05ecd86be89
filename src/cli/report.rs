//! Diagnostics for people, in the manner of rustc.

use std::borrow::Cow;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Patch, Renderer, Snippet};

use crate::diagnostic::{Diagnostic, Fix, Severity};
use crate::report::Findings;
use crate::source::LineIndex;
use crate::source::Span;

/// Whether the report goes to a terminal that shows colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Text alone.
    Plain,
    /// With escape sequences for colours.
    Colored,
}

/// A line longer than this is cut to what lies around the span. In bytes.
const MAX_LINE_LENGTH: usize = 600;

/// How much of a cut line is shown on either side of the span. In bytes.
const CONTEXT: usize = 40;

/// The longest span of a cut line that is shown whole. In bytes.
const MAX_SPAN_LENGTH: usize = 120;

/// How much text two places may have between them and still be shown together. In bytes.
const MAX_EXCERPT: usize = 32 * 1024;

/// A span over more lines than this is shown by its first line.
const MAX_LINES: usize = 8;

/// The findings as text, one paragraph each.
pub fn human(findings: Findings, style: Style) -> String {
    if findings.diagnostics.is_empty() {
        return String::new();
    }
    let reports = Reports::new(findings.path, findings.text, style);
    let all = findings.diagnostics.iter();
    all.map(|diagnostic| reports.report(diagnostic)).collect()
}

/// Reports on one drawing.
pub(super) struct Reports<'a> {
    page: Page<'a>,
    renderer: Renderer,
    style: Style,
}

impl<'a> Reports<'a> {
    pub(super) fn new(path: &'a str, text: &'a str, style: Style) -> Self {
        Self {
            page: Page {
                path,
                text,
                places: LineIndex::new(text),
            },
            renderer: match style {
                Style::Plain => Renderer::plain(),
                Style::Colored => Renderer::styled(),
            },
            style,
        }
    }

    /// A finding as a paragraph.
    pub(super) fn report(&self, diagnostic: &Diagnostic) -> String {
        let (groups, shown) = self.page.report(diagnostic);
        let rendered = self.renderer.render(&groups);
        self.page.with_places(rendered, &shown, diagnostic.on_page) + "\n\n"
    }

    /// A finding as one line, without line feed: place, cause and way out, such as
    /// ``a.svg:14:3, in the middle of the page: error[E204]: there is no part named `Bdoy`; write `Body` ``.
    pub(super) fn line(&self, diagnostic: &Diagnostic) -> String {
        let (line, column) = self.place(diagnostic);
        let path = tame(self.page.path);
        let place = diagnostic.on_page;
        let place = place.map_or(String::new(), |place| format!(", {place}"));
        let kind = format!("{}[{}]", diagnostic.severity().name(), diagnostic.code.id());
        let kind = match self.style {
            Style::Plain => kind,
            Style::Colored => format!("{}{kind}\x1b[0m", color(diagnostic.severity())),
        };
        let fix = diagnostic
            .fixes
            .first()
            .map(|fix| uncapitalized(&fix.title));
        let way_out = fix.or_else(|| Some(diagnostic.help.as_deref()?.to_owned()));
        let way_out = way_out.map_or(String::new(), |way_out| format!("; {way_out}"));
        let said = format!("{}{way_out}", diagnostic.message);
        let words: Vec<&str> = said.split_whitespace().collect();
        let said = words.join(" ");
        format!("{path}:{line}:{column}{place}: {kind}: {}", tame(&said))
    }

    /// The line and column of a finding.
    pub(super) fn place(&self, diagnostic: &Diagnostic) -> (usize, usize) {
        self.page.places.line_column(diagnostic.span.start)
    }
}

/// A drawing that is reported on.
struct Page<'a> {
    path: &'a str,
    text: &'a str,
    places: LineIndex<&'a str>,
}

impl Page<'_> {
    /// What to render, and the spans whose places its headers are to name.
    fn report<'d>(&self, diagnostic: &'d Diagnostic) -> (Vec<Group<'d>>, Vec<Span>) {
        let title = level(diagnostic.severity())
            .primary_title(&*diagnostic.message)
            .id(diagnostic.code.id());
        let mut spans = vec![diagnostic.span];
        spans.extend(diagnostic.related.iter().map(|related| related.span));
        let together = self.excerpt(&spans);
        let excerpt = match &together {
            Some(excerpt) => excerpt.clone(),
            None => self.window(diagnostic.span),
        };

        let mut shown = vec![diagnostic.span];
        let mut snippet = excerpt.snippet().path(token(0)).annotation(
            AnnotationKind::Primary
                .span(excerpt.ranges[0].clone())
                .label(diagnostic.label.as_deref()),
        );
        if together.is_some() {
            let related = diagnostic.related.iter().zip(&excerpt.ranges[1..]);
            snippet = snippet.annotations(related.map(|(related, range)| {
                let kind = AnnotationKind::Context;
                kind.span(range.clone()).label(&*related.message)
            }));
        }
        let mut main = Group::with_title(title).element(snippet);
        if let Some(help) = &diagnostic.help {
            main = main.element(Level::HELP.message(tame(help)));
        }

        let mut groups = vec![main];
        if together.is_none() {
            for related in &diagnostic.related {
                let excerpt = self.window(related.span);
                let range = excerpt.ranges[0].clone();
                let snippet = excerpt.snippet().path(token(shown.len()));
                let snippet = snippet.annotation(AnnotationKind::Primary.span(range));
                let title = Level::NOTE.secondary_title(tame(&related.message));
                groups.push(title.element(snippet));
                shown.push(related.span);
            }
        }
        groups.extend(diagnostic.fixes.iter().map(|fix| self.fix(fix)));
        (groups, shown)
    }

    /// A rendered report with the true places in its headers.
    ///
    /// The renderer takes a column from the text that it shows, and of a cut line that is not where
    /// the drawing has it. So it is given a token for a path, and token and place are replaced.
    fn with_places(&self, rendered: String, shown: &[Span], place: Option<&str>) -> String {
        let mut out = String::with_capacity(rendered.len());
        let mut rest = &*rendered;
        for (number, span) in shown.iter().enumerate() {
            let Some((before, after)) = rest.split_once(&token(number)) else {
                continue;
            };
            let (line, column) = self.places.line_column(span.start);
            out.push_str(before);
            out.push_str(&format!("{}:{line}:{column}", tame(self.path)));
            // The first place is that of the finding.
            if let (0, Some(place)) = (number, place) {
                out.push_str(&format!(", {place}"));
            }
            rest = after.trim_start_matches(|c: char| c == ':' || c.is_ascii_digit());
        }
        out.push_str(rest);
        out
    }

    /// A fix as the lines that it would leave, or by its title alone if those lie far apart.
    fn fix<'d>(&self, fix: &'d Fix) -> Group<'d> {
        let group = Group::with_title(Level::HELP.secondary_title(tame(&fix.title)));
        let spans: Vec<_> = fix.edits.iter().map(|edit| edit.span).collect();
        let short = fix
            .edits
            .iter()
            .all(|edit| edit.text.len() <= MAX_LINE_LENGTH);
        match self.excerpt(&spans).filter(|_| short) {
            None => group,
            Some(excerpt) => {
                let edits = fix.edits.iter().zip(excerpt.ranges.clone());
                let patches = edits.map(|(edit, range)| Patch::new(range, &*edit.text));
                group.element(excerpt.snippet().patches(patches))
            }
        }
    }

    /// The lines that hold all `spans`, if they can be shown in one piece.
    fn excerpt(&self, spans: &[Span]) -> Option<Excerpt> {
        let whole = spans.iter().copied().reduce(Span::join)?;
        let (first, last) = (self.first_line(whole), self.last_line(whole));
        let (start, end) = (self.places.extent(first).0, self.places.extent(last).1);
        let lines_of = |span: &Span| self.last_line(*span) - self.first_line(*span);
        let whole_lines = end - start <= MAX_EXCERPT
            && spans.iter().all(|span| lines_of(span) <= MAX_LINES)
            && !self.text[start..end]
                .split('\n')
                .any(|line| line.len() > MAX_LINE_LENGTH);
        if !whole_lines {
            let one_line =
                first == last && whole.end.saturating_sub(whole.start) <= MAX_SPAN_LENGTH;
            return one_line.then(|| self.cut(first, whole, spans));
        }
        Some(Excerpt {
            source: self.text[start..end].to_owned(),
            line: first,
            ranges: spans
                .iter()
                .map(|span| self.shift(*span, start, end))
                .collect(),
        })
    }

    /// What is shown of one span, always: its first line at least, cut if it is long.
    fn window(&self, span: Span) -> Excerpt {
        self.excerpt(&[span]).unwrap_or_else(|| {
            let line = self.first_line(span);
            let end = self.places.extent(line).1;
            let end = span.end.min(end).min(span.start + MAX_SPAN_LENGTH);
            let seen = Span::new(span.start, end.max(span.start));
            self.cut(line, seen, &[seen])
        })
    }

    /// A line from a little before `whole` to a little behind it.
    fn cut(&self, line: usize, whole: Span, spans: &[Span]) -> Excerpt {
        const MARK: &str = "…";

        let (line_start, line_end) = self.places.extent(line);
        let start = self
            .places
            .clamp(whole.start.saturating_sub(CONTEXT))
            .max(line_start);
        let end = self
            .places
            .clamp(whole.end + CONTEXT)
            .min(line_end)
            .max(start);
        let before = if start > line_start { MARK } else { "" };
        let after = if end < line_end { MARK } else { "" };
        let shifted = spans.iter().map(|span| {
            let range = self.shift(*span, start, end);
            range.start + before.len()..range.end + before.len()
        });
        Excerpt {
            ranges: shifted.collect(),
            source: format!("{before}{}{after}", &self.text[start..end]),
            line,
        }
    }

    /// Where `span` is in the text's stretch `start..end`.
    fn shift(&self, span: Span, start: usize, end: usize) -> Range<usize> {
        let place = |offset: usize| self.places.clamp(offset).clamp(start, end) - start;
        place(span.start)..place(span.end.max(span.start))
    }

    fn first_line(&self, span: Span) -> usize {
        self.places.line(self.places.clamp(span.start))
    }

    /// The line of the span's last character.
    fn last_line(&self, span: Span) -> usize {
        let last = span.end.saturating_sub(1).max(span.start);
        self.places.line(self.places.clamp(last))
    }
}

/// A piece of the drawing, and where the spans are in it.
#[derive(Clone)]
struct Excerpt {
    source: String,
    line: usize,
    ranges: Vec<Range<usize>>,
}

impl Excerpt {
    fn snippet<'a, T: Clone>(&self) -> Snippet<'a, T> {
        Snippet::source(self.source.clone()).line_start(self.line)
    }
}

/// Stands for a path while a report is rendered: private characters, which nobody writes.
fn token(number: usize) -> String {
    format!("\u{10FFFD}{number}\u{10FFFD}")
}

fn level(severity: Severity) -> Level<'static> {
    match severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Hint => Level::INFO.with_name(severity.name()),
    }
}

/// A title within a sentence.
fn uncapitalized(title: &str) -> String {
    let mut letters = title.chars();
    let first = letters.next().into_iter().flat_map(char::to_lowercase);
    first.chain(letters).collect()
}

/// The escape sequence for the colour of a severity.
fn color(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "\x1b[1;31m",
        Severity::Warning => "\x1b[1;33m",
        Severity::Hint => "\x1b[1;36m",
    }
}

/// Words of the drawing can stand in any message: none of them may steer the terminal. (The renderer
/// sees to titles, labels and sources, but lets these through.)
fn tame(text: &str) -> Cow<'_, str> {
    let steers = |c: char| {
        (c.is_control() && c != '\n')
            || matches!(c, '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}')
    };
    if text.contains(steers) {
        text.replace(steers, "\u{FFFD}").into()
    } else {
        text.into()
    }
}

#[cfg(test)]
#[path = "report_tests.rs"]
mod tests;
