//! Hovers, definitions, the preview and `inspect` speak of the same things, at every offset of the example drawings.

use std::collections::BTreeSet;

use super::at::Found;
use super::fixtures::analysis;
use super::hover::escaped;
use super::{Analysis, Item, Subject, Target, Which};
use crate::lang::ast::Annotation;
use crate::report::{Part, everything};
use crate::source::{LineIndex, Span};

/// Figures, landscapes and characters; names by strings, labels, ids and in groups; legends, ink and unused shapes.
const DRAWINGS: &[(&str, &str)] = &[
    ("human", include_str!("../../examples/human.svg")),
    ("robot-ja", include_str!("../../examples/robot-ja.svg")),
    ("dog", include_str!("../../examples/dog.svg")),
    ("car", include_str!("../../examples/car.svg")),
    ("lady", include_str!("../../examples/lady.svg")),
    ("roundv", include_str!("../../examples/shapes/roundv.svg")),
    (
        "village",
        include_str!("../../examples/terrain/village.svg"),
    ),
    ("boy", include_str!("../../examples/characters/boy.svg")),
    ("cat", include_str!("../../examples/characters/cat.svg")),
    ("grouped", GROUPED),
];

/// Names that only groups have, shapes without names, several of them with one name, a legend, a shape that is left out, and a
/// region whose name is taken.
const GROUPED: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 100">
<g id="Body"><rect x="80" y="20" width="40" height="60" fill="#336699" stroke="black" stroke-width="3"/>
<rect x="90" y="30" width="8" height="8" fill="#eeeeee"/><rect id="Dot" x="102" y="30" width="8" height="8" fill="#dddddd"/></g>
<g id="Arm"><rect id="Upper" x="20" y="40" width="70" height="10" fill="#ffcc99"/>
<rect x="30" y="42" width="5" height="5" fill="red"/><text x="50" y="49" font-size="5">Arm@Body$Shape round Follow Body</text></g>
<rect id="swatch" x="2" y="2" width="5" height="5" fill="#ffcc99"/><text x="4" y="6" font-size="5">$Offset 4 Smooth 20</text>
<rect id="gone" x="180" y="80" width="9" height="9" fill="#00ff00"/><text x="184" y="85" font-size="5">* gone</text>
<g id="front"><rect id="box" x="230" y="20" width="40" height="50" fill="#3366cc"/>
<circle id="Dot-a" cx="240" cy="40" r="5" fill="#ffcc00"><desc>Dot</desc></circle><text x="210" y="90" font-size="8">Box$View 0 0</text></g>
<g id="side"><rect id="box-2" x="330" y="20" width="42" height="50" fill="#3366cc"/>
<circle id="Dot-b" cx="338" cy="40" r="5" fill="#ffcc00"><desc>Dot</desc></circle><text x="310" y="90" font-size="8">Box$View 45 0</text></g>
<text x="150" y="95" font-size="5">%Alpha 1</text></svg>
"##;

/// A drawing with the list that `inspect` and the preview's page show of it.
struct Drawing<'a> {
    analysis: &'a Analysis,
    listed: Vec<(Subject<'a>, Part<'a>)>,
}

impl<'a> Drawing<'a> {
    fn new(analysis: &'a Analysis) -> Self {
        let parts = everything(&analysis.compiled, analysis.source());
        Self {
            analysis,
            listed: Subject::all(&analysis.compiled).zip(parts).collect(),
        }
    }

    fn entry(&self, subject: Subject<'_>) -> &Part<'a> {
        let mut listed = self.listed.iter();
        let found = listed.find(|(listed, _)| listed.which == subject.which);
        &found.expect("every subject is listed").1
    }

    /// What the page shows for a name: the first of that name.
    fn shown(&self, name: &str) -> Option<Which> {
        let mut listed = self.listed.iter();
        let found = listed.find(|(_, part)| part.name == name)?;
        Some(found.0.which)
    }

    /// What is meant by the text at a span's start.
    fn at(&self, start: usize) -> Option<Which> {
        Some(self.analysis.at(start)?.subject?.which)
    }

    /// A subject, and the one whose node shows it.
    fn with_main(&self, subject: Subject<'_>) -> [Which; 2] {
        let main = subject.parent().filter(|_| subject.is_sub());
        [subject.which, main.unwrap_or(subject).which]
    }

    /// The preview selects what the text is about, and a click there leads back to it.
    fn check_preview(&self, offset: usize) {
        let subject = self.analysis.at(offset).and_then(|at| at.subject);
        let name = self.analysis.part_at(offset);
        let Some(name) = name else {
            let is_nameless = |subject: Subject<'_>| {
                let own = self.with_main(subject);
                !own.contains(&self.shown(subject.name()).expect("it is listed"))
                    || subject.name().is_empty()
            };
            assert!(subject.is_none_or(is_nameless), "nothing is selected");
            return;
        };
        let subject = subject.expect("what is selected is in the text");
        let shown = self.shown(name).expect("what is selected is listed");
        assert!(self.with_main(subject).contains(&shown), "selected: {name}");
        let place = self.analysis.place_of(name).expect("it has a place");
        assert_eq!(self.at(place.start), Some(shown), "a click on {name}");
    }

    /// The hover describes the item with the name and the attributes that `inspect` lists.
    fn check_hover(&self, offset: usize) {
        let Some(at) = self.analysis.at(offset) else {
            assert!(self.analysis.hover(offset).is_none_or(|hover| {
                let is_there = |span: Span| span.touches(offset);
                let mut found = self.analysis.diagnostics().iter();
                is_there(hover.span) && found.any(|one| is_there(one.span))
            }));
            return;
        };
        let Some(meant) = at.meant else { return };
        let hover = self.analysis.hover(offset).expect("it is described");
        let entry = self.entry(meant);
        let text = &hover.markdown;
        if let Found::String { string, .. } = &at.found
            && let Annotation::Legend(_) = self.analysis.bindings().strings[*string].annotation
        {
            // It tells about the legend, whose sample the string has for its part.
            let sample = meant.element().unwrap().describe();
            assert!(text.contains(&sample), "{sample} is not in:\n{text}");
            return;
        }
        if matches!(entry.kind, "main" | "terrain" | "character") {
            let name = format!("**{}**", escaped(entry.name));
            let of = format!(" of {}", escaped(entry.name));
            assert!(text.contains(&name) || text.contains(&of), "{text}");
        }
        if let ("main", Some(parent)) = (entry.kind, entry.parent) {
            let lineage = format!("{} › **{}**", escaped(parent), escaped(entry.name));
            assert!(text.contains(&lineage), "{lineage} is not in:\n{text}");
        }
        if matches!(entry.kind, "main" | "sub") {
            let attributes = entry.attributes.iter();
            let lines = attributes.map(|(name, one)| {
                let from = match one.from {
                    "own" => "its own string",
                    "legend" => "the legend of its paint",
                    "default" => "a `%` string",
                    _ if *name == "Color" => "its own fill",
                    _ => "okoshi",
                };
                match one.value.replace('`', "'").as_str() {
                    "" => format!("- {name}, from {from}"),
                    value => format!("- {name} `{value}`, from {from}"),
                }
            });
            let listed: BTreeSet<String> = lines.collect();
            let lines = text.lines().filter(|line| line.starts_with("- "));
            let lines = lines.filter(|line| line.contains(", from "));
            let described: BTreeSet<String> = lines.map(str::to_owned).collect();
            assert_eq!(described, listed, "{text}");
        }
    }

    /// A definition leads to the string or the shape of what the hover describes.
    fn check_definition(&self, offset: usize) {
        let Some((from, targets)) = self.analysis.definition(offset) else {
            return;
        };
        let at = self.analysis.at(offset).expect("something is there");
        assert_eq!(at.span, from);
        let is_keyword = matches!(&at.found, Found::String { token: Some(token), .. }
            if matches!(token.item, Item::Keyword(_)));
        let wanted = at.meant.or(at.subject.filter(|_| is_keyword));
        for target in &targets {
            let (Target::Here(span), Some(wanted)) = (target, wanted) else {
                continue;
            };
            if is_keyword {
                let origin = self.analysis.at(span.start).expect("a setting is there");
                assert!(matches!(origin.found, Found::String { .. }));
            } else {
                let found = self.at(span.start).expect("a definition is a subject's");
                assert!(self.with_main(wanted).contains(&found), "{found:?}");
            }
        }
    }

    /// The string that `inspect` lists for what is here is the one in which the page's click ends.
    fn check_strings(&self) {
        let places = LineIndex::new(&**self.analysis.source());
        for (subject, entry) in &self.listed {
            let place = subject.span();
            assert_eq!(self.at(place.start), Some(subject.which), "{}", entry.name);
            let Some(string) = &entry.string else {
                continue;
            };
            let found = self.analysis.at(place.start).map(|at| at.found);
            let Some(Found::String { string: found, .. }) = found else {
                panic!("{} has a string, and no click leads there", entry.name);
            };
            let text = &self.analysis.bindings().strings[found].text;
            let line_column = places.line_column(text.whole().start);
            assert_eq!((string.line, string.column), line_column, "{}", entry.name);
        }
    }

    /// A click on a node of the model is one on something that is listed, by its element as the page does.
    fn check_model(&self) {
        for node in &self.analysis.compiled.scene.nodes {
            let source = node.provenance.as_ref();
            let Some(element) = source.and_then(|source| source.element.as_deref()) else {
                continue;
            };
            let mut listed = self.listed.iter();
            let found = listed.find(|(_, part)| part.element == Some(element));
            let (_, part) = found.expect("every node is a part's");
            assert!(self.analysis.place_of(part.name).is_some(), "{element}");
        }
    }
}

#[test]
fn hovers_definitions_the_preview_and_inspect_agree() {
    for (name, source) in DRAWINGS {
        let (analysis, _) = analysis(source);
        let drawing = Drawing::new(&analysis);
        assert!(!drawing.listed.is_empty(), "{name}");
        drawing.check_strings();
        drawing.check_model();
        let mut subjects = BTreeSet::new();
        for (offset, _) in source.char_indices() {
            drawing.check_preview(offset);
            drawing.check_hover(offset);
            drawing.check_definition(offset);
            subjects.extend(drawing.at(offset));
        }
        let listed: BTreeSet<Which> = drawing.listed.iter().map(|(one, _)| one.which).collect();
        assert_eq!(subjects, listed, "{name}: each is somewhere in the text");
    }
}
