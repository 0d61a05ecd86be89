//! Code actions that give two regions of a character the same name, so that they are a pair.

use super::actions::Action;
use super::changes::as_description;
use super::regions::Region;
use super::rename::label_edit;
use super::uses::own_name;
use super::{Analysis, Symbol};
use crate::billboard::{Candidate, Reason, RegionInView};
use crate::bind::{PartKind, StringHolder, written_by_a_person};
use crate::diagnostic::{Code, Edit};
use crate::geometry::bounds;
use crate::lang::ast::Annotation;
use crate::lang::quoting::{NamePlace, quoted_if_needed};
use crate::svg::ShapeId;

/// A region that can become the partner of another one.
#[derive(Debug, Clone, Copy)]
struct Choice<'a> {
    region: Region<'a>,
    /// Whether no region fits better.
    is_best: bool,
    /// The region that it belongs to now, which would lose it.
    from: Option<Region<'a>>,
}

impl Analysis {
    /// Actions for a region without a partner: it and the region that fits it best get one name. The first choice is a region that
    /// has no partner either; another one that fits better is offered, too, although its partner would be left alone.
    pub(super) fn name_both(&self, shape: ShapeId) -> Vec<Action> {
        let regions = self.regions_of_shape(shape);
        let [region] = regions.as_slice() else {
            // Regions of a picture have no element that could have a name.
            return vec![];
        };
        let choices = self.choices(*region).into_iter();
        choices
            .filter_map(|choice| self.name_both_action(*region, choice))
            .collect()
    }

    /// The regions of other views that a region without a partner may belong to, the likeliest first.
    fn choices<'a>(&self, region: Region<'a>) -> Vec<Choice<'a>> {
        let Some(unmatched) = region.unmatched() else {
            return vec![];
        };
        let of = |at| Region { at, ..region };
        let can_be_named = |choice: &Region<'_>| self.shape_to_name(*choice).is_some();
        let candidates = || unmatched.candidates.iter();
        let is_alone = |candidate: &&Candidate| of(candidate.region).unmatched().is_some();
        let free = candidates()
            .find(|candidate| is_alone(candidate) && can_be_named(&of(candidate.region)));
        let free = match free {
            Some(candidate) => Some(of(candidate.region)),
            None => self.nearest_alone(region),
        };
        let mut choices = Vec::new();
        let best = candidates().next();
        choices.extend(free.map(|region| Choice {
            region,
            is_best: best.is_none_or(|best| best.region == region.at),
            from: None,
        }));
        let best = best.filter(|best| !is_alone(best));
        if let Some(best) = best {
            let taken = match best.reason {
                Reason::Taken(by) => Some(of(by)),
                _ => of(best.region)
                    .partners()
                    .find(|partner| partner.at.view == region.at.view),
            };
            let choice = Choice {
                region: of(best.region),
                is_best: true,
                from: taken,
            };
            // A name that makes a pair already cannot be given to a third region.
            if can_be_named(&choice.region) && choice.region.name().is_none() {
                choices.push(choice);
            }
        }
        choices
    }

    /// The region without a partner in another view that lies nearest to where a region is in its own view.
    fn nearest_alone<'a>(&self, region: Region<'a>) -> Option<Region<'a>> {
        let middle = |region: &Region<'_>| {
            let RegionInView { view, id } = region.at;
            let outline = &region.character.views[view].regions[id].outline;
            let (low, high) = bounds(outline)?;
            Some(region.character.frames[view].on_screen(low.midpoint(high)))
        };
        let own = middle(&region)?;
        let unmatched = region.character.matching.unmatched.iter();
        let others = unmatched.filter(|other| other.region.view != region.at.view);
        let others = others.map(|other| Region {
            at: other.region,
            ..region
        });
        let near = others
            .filter(|other| self.shape_to_name(*other).is_some())
            .filter_map(|other| Some((other, middle(&other)?.distance(own))));
        near.min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(other, _)| other)
    }

    fn name_both_action(&self, region: Region<'_>, choice: Choice<'_>) -> Option<Action> {
        let both = [region, choice.region];
        let name = self.common_name(both)?;
        let edits = self.named_by_strings(both, &name);
        let mut edits = edits.or_else(|| self.named_by_labels(both, &name))?;
        edits.sort_by_key(|edit| edit.span);
        let shape = self.shape_to_name(region)?;
        let span = self.drawing().shapes[shape].element.span;
        let mut found = self.diagnostics().iter();
        let diagnostic =
            found.position(|found| found.code == Code::NoPartner && found.span == span);
        let shown = self.title_of_region(choice.region);
        let title = match choice.from {
            None => format!("Name both `{name}`: this region and {shown}"),
            Some(from) => {
                let from = self.title_of_region(from);
                format!(
                    "Name both `{name}`: this region and {shown}, which leaves {from} without a partner"
                )
            }
        };
        Some(Action {
            title,
            edits,
            diagnostic,
            is_preferred: choice.is_best && choice.from.is_none(),
        })
    }

    /// The shape of a region that can be named: no picture, and no clone, whose original has other copies.
    fn shape_to_name(&self, region: Region<'_>) -> Option<ShapeId> {
        let shape = region.shape()?;
        let found = &self.drawing().shapes[shape];
        let alike = self.drawing().shapes.iter();
        let alike = alike.filter(|other| other.element.span == found.element.span);
        (found.picture.is_none() && found.element.tag != "use" && alike.count() == 1)
            .then_some(shape)
    }

    /// The name for two regions: that of one of them, or a new one after their elements.
    fn common_name(&self, both: [Region<'_>; 2]) -> Option<String> {
        if let Some(name) = both.iter().find_map(|region| region.name()) {
            return Some(name.to_owned());
        }
        let elements = both.map(|region| self.shape_to_name(region));
        let elements = elements.into_iter().flatten();
        let elements = elements.map(|shape| &self.drawing().shapes[shape].element);
        let labels = elements
            .clone()
            .filter_map(|element| element.label.as_deref());
        let ids = elements.filter_map(|element| element.id.as_deref());
        let mut given = labels.chain(ids).filter_map(written_by_a_person);
        let wanted = given.next().unwrap_or_else(|| "Region".to_owned());
        let taken = |name: &String| {
            let character = both[0].character;
            let mut regions = character.views.iter().flat_map(|view| &view.regions);
            regions.any(|region| region.name.as_ref() == Some(name))
                || self.part_named(name).is_some()
                || !self.uses(&Symbol::Part(name.clone())).is_empty()
        };
        let mut names = std::iter::once(wanted.clone())
            .chain((2..1000).map(|number| format!("{wanted}-{number}")));
        names.find(|name| !taken(name))
    }

    /// The edits that name regions by their own strings: the name is changed or added there, or written as a description. `None` if
    /// that is not possible for all of them.
    fn named_by_strings(&self, regions: [Region<'_>; 2], name: &str) -> Option<Vec<Edit>> {
        let mut edits = Vec::new();
        for region in regions {
            if region.name() != Some(name) {
                edits.extend(self.named_by_string(self.shape_to_name(region)?, name)?);
            }
        }
        Some(edits)
    }

    fn named_by_string(&self, shape: ShapeId, name: &str) -> Option<Vec<Edit>> {
        let new = quoted_if_needed(name, NamePlace::Head);
        let element = &self.drawing().shapes[shape].element;
        let mut parts = self.bindings().parts.iter();
        let part = parts.find(|part| part.shape == shape && part.kind == PartKind::Region);
        let Some(string) = part.and_then(|part| part.string) else {
            return Some(vec![element.with_description(&as_description(new))?]);
        };
        let string = &self.bindings().strings[string];
        let Annotation::Part(annotation) = &string.annotation else {
            return None;
        };
        if let Some(old) = &annotation.name {
            return Edit::replacing(&string.text, old.range.clone(), &new);
        }
        // A description without a name has that of its element.
        let is_described = !matches!(string.holder, StringHolder::Label(_));
        let head = string.text.as_str();
        let start = head.len() - head.trim_start().len();
        (is_described && own_name(string).is_none()).then(|| {
            vec![Edit {
                span: string.text.span(start..start),
                text: string.text.escape_at(start, &new),
            }]
        })
    }

    /// The edits that name regions by labels, for elements that already have a description. Only regions without a name can be
    /// named so.
    fn named_by_labels(&self, regions: [Region<'_>; 2], name: &str) -> Option<Vec<Edit>> {
        if regions.iter().any(|region| region.name().is_some()) {
            return None;
        }
        let edits = regions.map(|region| {
            let element = &self.drawing().shapes[self.shape_to_name(region)?].element;
            Some(label_edit(&self.source, element.span, name))
        });
        edits.into_iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Analysis;
    use super::super::actions::Action;
    use super::super::fixtures::analysis;
    use crate::diagnostic::{Code, applied};
    use crate::source::Span;

    /// A box with a badge whose colour differs too much in the second view.
    const DRAWING: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"100\">\n\
        <g id=\"front\"><rect id=\"body\" x=\"30\" y=\"20\" width=\"40\" height=\"50\" fill=\"#3366cc\"/>\n\
        <cir¦cle id=\"badge\" cx=\"40\" cy=\"40\" r=\"5\" fill=\"#ffcc00\"/>\n\
        <text x=\"10\" y=\"90\" font-size=\"8\">Box$View 0 0</text></g>\n\
        <g id=\"side\"><rect id=\"body-2\" x=\"130\" y=\"20\" width=\"42\" height=\"50\" fill=\"#3366cc\"/>\n\
        <circle id=\"star\" cx=\"138\" cy=\"40\" r=\"5\" fill=\"#333333\"/>\n\
        <text x=\"110\" y=\"90\" font-size=\"8\">Box$View 45 0</text></g>\n</svg>\n";

    fn actions(source: &str) -> (Analysis, Vec<Action>) {
        let (before, at) = analysis(source);
        let mut actions = before.actions(Span::at(at));
        actions.retain(|action| action.title.starts_with("Name both"));
        (before, actions)
    }

    /// The drawing after the first action, which must make a pair of the two regions.
    #[track_caller]
    fn paired(source: &str, title: &str) -> String {
        let (before, actions) = actions(source);
        assert_eq!(actions[0].title, title);
        let text = applied(before.source(), &actions[0].edits);
        let (after, _) = analysis(&text);
        assert!(
            after.diagnostics().is_empty(),
            "{:?}\n{text}",
            after.diagnostics()
        );
        let matching = &after.compiled().characters[0].matching;
        assert_eq!(matching.unmatched, [], "{text}");
        assert_eq!(matching.pairs.len(), 2);
        text
    }

    #[test]
    fn two_regions_without_a_partner_become_a_pair() {
        let text = paired(DRAWING, "Name both `badge`: this region and `#star`");
        assert_eq!(text.matches("<desc>badge</desc></circle>").count(), 2);
        let (before, actions) = actions(DRAWING);
        let found = actions[0]
            .diagnostic
            .map(|index| before.diagnostics()[index].code);
        assert_eq!(found, Some(Code::NoPartner));
        assert!(actions[0].is_preferred);
    }

    #[test]
    fn the_name_of_one_is_given_to_the_other() {
        let star = "fill=\"#333333\"><desc>\"Gold star\"$Depth 30</desc></circle>";
        let source = DRAWING.replace("fill=\"#333333\"/>", star);
        let text = paired(
            &source,
            "Name both `Gold star`: this region and `Gold star` (`#star`)",
        );
        assert!(text.contains("<desc>\"Gold star\"$</desc>"), "{text}");
        let badge = "fill=\"#ffcc00\"><desc>Badge</desc></circle>";
        let text = paired(
            &source.replace("fill=\"#ffcc00\"/>", badge),
            "Name both `Badge`: this region and `Gold star` (`#star`)",
        );
        assert!(text.contains("<desc>Badge$Depth 30</desc>"), "{text}");
    }

    #[test]
    fn texts_beside_shapes_are_changed() {
        let source = DRAWING
            .replace(
                "<text x=\"10\"",
                "<text x=\"40\" y=\"40.5\" font-size=\"2\" text-anchor=\"middle\">Badge</text><text x=\"10\"",
            )
            .replace(
                "<text x=\"110\"",
                "<text x=\"138\" y=\"40.5\" font-size=\"2\" text-anchor=\"middle\">Star</text><text x=\"110\"",
            );
        let text = paired(
            &source,
            "Name both `Badge`: this region and `Star` (`#star`)",
        );
        assert_eq!(text.matches(">Badge</text>").count(), 2, "{text}");
    }

    #[test]
    fn shapes_with_a_description_get_labels() {
        let described = "fill=\"#333333\"><desc>a star, hand-drawn</desc></circle>";
        let source = DRAWING.replace("fill=\"#333333\"/>", described);
        let text = paired(&source, "Name both `badge`: this region and `#star`");
        assert_eq!(text.matches("data-name=\"badge\"").count(), 2, "{text}");
    }

    #[test]
    fn names_in_use_are_not_given() {
        let source = DRAWING.replace(
            "height=\"50\" fill=\"#3366cc\"/>",
            "height=\"50\" fill=\"#3366cc\"><desc>badge</desc></rect>",
        );
        let text = paired(&source, "Name both `badge-2`: this region and `#star`");
        assert_eq!(text.matches("<desc>badge-2</desc>").count(), 2, "{text}");
    }

    #[test]
    fn a_partner_of_another_region_can_be_taken() {
        // Two badges in front, and one at the side that belongs to the nearer of them.
        let source = DRAWING.replace("#333333", "#ffcc00").replace(
            "<cir¦cle",
            "<ci¦rcle id=\"second\" cx=\"52\" cy=\"60\" r=\"5\" fill=\"#ffcc00\"/><circle",
        );
        let (before, actions) = actions(&source);
        let title =
            "Name both `second`: this region and `#star`, which leaves `#badge` without a partner";
        assert_eq!(actions[0].title, title);
        assert!(!actions[0].is_preferred);
        let (after, _) = analysis(&applied(before.source(), &actions[0].edits));
        let alone: Vec<&str> = after
            .diagnostics()
            .iter()
            .map(|d| d.message.as_str())
            .collect();
        assert!(
            alone.len() == 1 && alone[0].starts_with("`#badge`"),
            "{alone:?}"
        );
    }

    #[test]
    fn regions_with_a_partner_need_no_name() {
        let source = DRAWING.replace("#333333", "#ffcc00");
        assert_eq!(actions(&source).1, []);
    }
}
