//! Code actions: fixes of diagnostics, and rewrites of strings.

use super::Analysis;
use super::at::{At, Found, attributes};
use super::changes::{as_description, string_for};
use crate::bind::{BindRule, DistanceMode, Part, PartId, PartKind, StringId};
use crate::diagnostic::Edit;
use crate::lang::ast::{Annotation, Attribute};
use crate::source::{Span, Text, escape_xml};
use crate::svg::PaintKey;

/// About how wide a character is, in font sizes.
const CHARACTER: f64 = 0.6;
/// How small a text becomes to fit into a shape, as a share of the usual font size.
const SMALLEST: f64 = 0.25;

/// A code action.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Action {
    /// Its title, in the imperative.
    pub title: String,
    /// Its edits.
    pub edits: Vec<Edit>,
    /// Index of the diagnostic that it fixes; `None` for a rewrite.
    pub diagnostic: Option<usize>,
    /// Whether it is the obvious choice.
    pub is_preferred: bool,
}

impl Analysis {
    /// The code actions within `window`.
    pub fn actions(&self, window: Span) -> Vec<Action> {
        if !self.is_annotated() {
            return self.name_the_parts(window).into_iter().collect();
        }
        let mut actions = vec![];
        for (index, diagnostic) in self.diagnostics().iter().enumerate() {
            let span = diagnostic.span;
            if span.start > window.end || window.start > span.end {
                continue;
            }
            let only = diagnostic.fixes.len() == 1;
            actions.extend(diagnostic.fixes.iter().map(|fix| Action {
                title: fix.title.clone(),
                edits: fix.edits.clone(),
                diagnostic: Some(index),
                is_preferred: only,
            }));
        }
        let Some(At { found, part, .. }) = self.at(window.start) else {
            return actions;
        };
        match found {
            Found::Tag { shape } => {
                actions.extend(part.map_or(vec![], |part| self.give_a_string(part)));
                actions.extend(self.name_both(shape));
            }
            Found::String { string, .. } => {
                actions.extend(self.move_to_legend(string));
                if let Some(part) = part {
                    actions.extend(self.name_both(self.bindings().parts[part].shape));
                }
            }
        }
        actions
    }

    /// Names for all parts of a drawing in which nothing has one, at its start tag: finding them takes as long as some compiles, and
    /// editors ask for actions wherever the cursor goes.
    fn name_the_parts(&self, window: Span) -> Option<Action> {
        let root = self.drawing().groups.first()?.element.span;
        let is_at_root = (root.start..=root.end).contains(&window.start);
        if !is_at_root || !self.is_nameless() {
            return None;
        }
        let (edits, _) = self.named_parts().ok()?;
        Some(Action {
            title: "Name the parts of this drawing".to_owned(),
            edits,
            diagnostic: None,
            is_preferred: false,
        })
    }

    /// Actions that give a part without a string one: in its description, or as a text beside it.
    fn give_a_string(&self, index: PartId) -> Vec<Action> {
        let part = &self.bindings().parts[index];
        if part.string.is_some() || part.kind != PartKind::Main {
            return vec![];
        }
        let string = self.string_for(part);
        let action = |title: String, edits| Action {
            title,
            edits,
            diagnostic: None,
            is_preferred: false,
        };
        let mut actions = vec![];
        if let Some(edit) = self.beside(part, &string) {
            actions.push(action(
                format!("Write `{string}` beside this shape"),
                vec![edit],
            ));
        }
        let string = as_description(string);
        if let Ok(edits) = self.describe_with(index, &string) {
            actions.push(action(
                format!("Give this shape the description `{string}`"),
                edits,
            ));
        }
        actions
    }

    /// `name@parent` for a part without a string; named like its element, if no other part is.
    fn string_for(&self, part: &Part) -> String {
        let element = &self.drawing().shapes[part.shape].element;
        let own = element.own_name();
        let is_free = !own.is_empty()
            && !own.contains('"')
            && self.part_named(own).is_none()
            && self.named_in(own).is_none();
        let name = if is_free { own } else { &part.name };
        let parent = part
            .parent
            .map(|parent| &self.bindings().parts[parent].name);
        string_for(name, parent.map(String::as_str))
    }

    /// A text whose corner is at the part's centre, so that it lies on the part and is the nearest string; one that would reach
    /// beyond the part is centred, and so small that it hardly does.
    fn beside(&self, part: &Part, string: &str) -> Option<Edit> {
        if self.bindings().settings.bind == BindRule::Nearest(DistanceMode::Outline) {
            return None;
        }
        let mut size = self.font_size();
        let center = part.measure.center;
        let (low, high) = part.measure.bounds;
        let ems = CHARACTER * string.chars().count() as f64;
        let mut anchor = "";
        if self.bindings().settings.bind == BindRule::Meant && center.x + ems * size > high.x {
            anchor = " text-anchor=\"middle\"";
            size = size.min((high.x - low.x) / ems).max(SMALLEST * size);
        }
        let prefix = self.prefix();
        self.at_the_end(&format!(
            "<{prefix}text x=\"{}\" y=\"{}\" font-size=\"{}\"{anchor}>{}</{prefix}text>",
            round(center.x),
            round(center.y + 0.8 * size),
            round(size),
            escape_xml(string),
        ))
    }

    /// Moves the attributes of a part's string to the legend of its paint.
    fn move_to_legend(&self, string: StringId) -> Option<Action> {
        let part = &self.bindings().parts[self.part_of_string(string)?];
        let found = &self.bindings().strings[string];
        let Annotation::Part(annotation) = &found.annotation else {
            return None;
        };
        let sign = annotation.signs.last()?;
        let (first, last) = (
            annotation.attributes.first()?,
            annotation.attributes.last()?,
        );
        let is_main = part.kind == PartKind::Main && annotation.name.is_some();
        if !is_main || sign.end > first.range.start {
            return None;
        }
        let paint = part.paint(self.drawing());
        let alike = self.bindings().parts.iter().filter(|other| {
            matches!(other.kind, PartKind::Main | PartKind::Sub)
                && other.paint(self.drawing()).key == paint.key
        });
        let alike = alike.count();
        let words = words_of(&found.text, first.range.start..last.range.end);
        let mut edits = Edit::replacing(&found.text, sign.start..last.range.end, "")?;
        match part.legend {
            Some(legend) => {
                let (legend, _) = *self.bindings().legends[legend].settings.first()?;
                let legend = &self.bindings().strings[legend];
                if shares_a_keyword(&annotation.attributes, attributes(&legend.annotation)) {
                    return None;
                }
                let text = &legend.text;
                let end = text.as_str().trim_end().len();
                let before = text.as_str()[..end]
                    .chars()
                    .next_back()
                    .map_or(0, char::len_utf8);
                edits.push(Edit {
                    span: Span::at(text.span(0..end).end),
                    text: format!(" {}", text.escape_at(end - before, &words)),
                });
            }
            None => edits.push(self.new_legend(&paint.key, &words)?),
        }
        edits.sort_by_key(|edit| edit.span);
        let whom = match alike {
            1 => "of its paint".to_owned(),
            _ => format!("of all {alike} parts that are painted like it"),
        };
        Some(Action {
            title: format!("Move these attributes to the legend {whom}"),
            edits,
            diagnostic: None,
            is_preferred: false,
        })
    }

    /// A swatch of a paint with a legend string, in a corner of the page.
    fn new_legend(&self, paint: &PaintKey, words: &str) -> Option<Edit> {
        let fill = match paint {
            PaintKey::Solid([r, g, b]) => format!("#{r:02x}{g:02x}{b:02x}"),
            PaintKey::Server(id) => format!("url(#{id})"),
            PaintKey::Picture(_) => return None,
        };
        let (low, size) = self.drawing().page;
        let side = 0.03 * size.min_element();
        let row = self.bindings().legends.len() as f64;
        let (x, y) = (low.x + side, low.y + side * (1.0 + 1.5 * row));
        let font = self.font_size();
        let prefix = self.prefix();
        self.at_the_end(&format!(
            "<{prefix}g><{prefix}rect x=\"{}\" y=\"{}\" width=\"{side}\" height=\"{side}\" fill=\"{}\"/>\
             <{prefix}text x=\"{}\" y=\"{}\" font-size=\"{}\">${}</{prefix}text></{prefix}g>",
            round(x),
            round(y),
            escape_xml(&fill).replace('"', "&quot;"),
            round(x + 1.5 * side),
            round(y + side),
            round(font),
            escape_xml(words),
            side = round(side),
        ))
    }

    /// Inserts an element as the last one of the drawing, on a line of its own.
    fn at_the_end(&self, element: &str) -> Option<Edit> {
        let end = self.source.rfind("</")?;
        let line = if self.source.contains("\r\n") {
            "\r\n"
        } else {
            "\n"
        };
        let on_own_line = self.source[..end].ends_with(['\n', '\r']);
        Some(Edit {
            span: Span::at(end),
            text: if on_own_line {
                format!("  {element}{line}")
            } else {
                format!("{line}  {element}{line}")
            },
        })
    }

    /// The namespace prefix of the drawing's elements: `svg:` in `<svg:svg>`, usually empty.
    fn prefix(&self) -> &str {
        let root = self
            .drawing()
            .groups
            .first()
            .map(|group| group.element.span);
        let name = root.and_then(|span| self.source.get(span.start + 1..span.end));
        let prefix = name.and_then(|name| name.find(':').map(|colon| &name[..=colon]));
        prefix.unwrap_or_default()
    }

    /// The median font size of the strings.
    fn font_size(&self) -> f64 {
        let mut sizes: Vec<f64> = self
            .drawing()
            .labels
            .iter()
            .map(|(label, _)| label.font_size)
            .filter(|size| size.is_finite() && *size > 0.0)
            .collect();
        sizes.sort_by(f64::total_cmp);
        match sizes.get(sizes.len() / 2) {
            Some(size) => *size,
            None => 0.03 * self.drawing().page.1.max_element(),
        }
    }
}

/// The words of a string on one line.
fn words_of(text: &Text, range: std::ops::Range<usize>) -> String {
    let words = text.as_str()[range].split_whitespace();
    words.collect::<Vec<_>>().join(" ")
}

fn shares_a_keyword(one: &[Attribute], two: &[Attribute]) -> bool {
    one.iter()
        .any(|one| two.iter().any(|two| one.keyword == two.keyword))
}

/// A length, rounded to the precision that a drawing needs.
fn round(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;
    use crate::bind::BoundBy;
    use crate::diagnostic::{Code, Diagnostic, applied};
    use crate::lang::keyword::Keyword;

    fn after(source: &str, title: &str) -> Analysis {
        let (before, at) = analysis(source);
        let actions = before.actions(Span::at(at));
        let action = actions
            .iter()
            .find(|action| action.title.contains(title))
            .unwrap_or_else(|| panic!("{title} is not among {actions:?}"));
        let (after, _) = analysis(&applied(before.source(), &action.edits));
        assert!(after.is_sound(), "{}", after.source());
        after
    }

    fn value(analysis: &Analysis, name: &str, keyword: Keyword) -> Option<(String, &'static str)> {
        let part = analysis.part_named(name).unwrap();
        let source = analysis.bindings().setting(part, keyword)?;
        Some((source.setting.text.clone(), source.from.name()))
    }

    #[test]
    fn a_fix_removes_its_diagnostic() {
        let source = figure(["Body", "Rarm@¦Bdoy", "", "", ""]);
        let after = after(&source, "Write `Body`");
        assert!(after.source().contains("Rarm@Body"));
        assert!(!after.compiled().has_errors());
    }

    #[test]
    fn a_depth_that_hides_its_part_is_taken_away() {
        let source = "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>\
            <rect width='100' height='100'><desc>Body$Shape default -20 20</desc></rect>\
            <circle cx='50' cy='50' r='20'><desc>Eye@Body$Color red Off¦set -40</desc></circle></svg>";
        let after = after(source, "Take the depth of `Eye` away");
        assert!(after.source().contains("<desc>Eye@Body$Color red</desc>"));
        let is_hidden = |found: &Diagnostic| found.code == Code::Buried;
        assert!(!after.diagnostics().iter().any(is_hidden));
    }

    #[test]
    fn a_view_from_the_wrong_side_is_turned() {
        let source = include_str!("../../tests/cases/view-wrong-sign/drawing.svg");
        let after = after(
            &source.replace("View -45", "Vi¦ew -45"),
            "Change `-45` to `45`",
        );
        assert!(after.source().contains("Boy$View 45 0"));
        assert_eq!(after.diagnostics(), []);
    }

    #[test]
    fn a_shape_is_given_a_string() {
        let source = figure(["Body", "Rarm@Body", "", "", ""])
            .replace("<rect id=\"left\"", "<¦rect id=\"left\"");
        for (title, by) in [("beside", BoundBy::Nearest), ("description", BoundBy::Desc)] {
            let after = after(&source, title);
            let part = &after.bindings().parts[after.part_named("left").unwrap()];
            let binding = after.bindings().strings[part.string.unwrap()]
                .binding
                .unwrap();
            assert_eq!(binding.by, by);
            assert_eq!(part.parent, after.part_named("Body"));
        }
    }

    #[test]
    fn a_description_that_needs_quotes_is_a_string() {
        let source = "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100' \
            xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape'>\
            <rect x='5' y='40' width='60' height='40'/><circle cx='80' cy='20' r='10'/>\
            <text x='10' y='60'>Body$Shape round</text>\
            <¦circle cx='80' cy='85' r='12' inkscape:label='Gold $ star'/></svg>";
        let after = after(source, "Give this shape the description `\"Gold $ star\"");
        let part = after.part_named("Gold $ star").expect("a part");
        assert!(after.bindings().parts[part].string.is_some());
    }

    #[test]
    fn attributes_move_to_a_new_legend() {
        let source = figure([
            "Body",
            "Rarm@Body$¦Shape roundv Offset 3",
            "Larm@Body",
            "",
            "",
        ])
        .replace(
            "<rect id=\"swatch\"",
            "<rect id=\"swatch\" display=\"none\"",
        );
        let after = after(&source, "all 2 parts");
        for name in ["Rarm", "Larm"] {
            let found = value(&after, name, Keyword::Offset);
            assert_eq!(
                found,
                Some(("3".to_owned(), "legend")),
                "{name} in {}",
                after.source()
            );
        }
        assert!(after.source().contains(">Rarm@Body<"));
        assert!(!after.compiled().has_errors());
    }

    #[test]
    fn attributes_move_to_the_legend_that_is_there() {
        let source = figure(["Body", "Rarm@Body$¦Offset 3", "", "$Smooth 4", ""]);
        let after = after(&source, "Move these");
        assert!(after.source().contains(">$Smooth 4 Offset 3<"));
        assert_eq!(
            value(&after, "Rarm", Keyword::Offset),
            Some(("3".to_owned(), "legend"))
        );
        let source = figure(["Body", "Rarm@Body$¦Offset 3", "", "$Offset 4", ""]);
        let (before, at) = analysis(&source);
        assert_eq!(before.actions(Span::at(at)), []);
    }
}
