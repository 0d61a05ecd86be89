//! Regions of characters: which regions of the other views show the same thing.

use std::fmt::Write as _;

use super::hover::escaped;
use super::subject::span_of_shape;
use super::{Analysis, Target};
use crate::billboard::{
    Candidate, Character, Pair, Reason, RegionInView, RegionModel, TrackId, Unmatched, ViewId,
};
use crate::bind::{LayerKind, StringId};
use crate::source::Span;
use crate::svg::ShapeId;

/// The most regions of a view that are listed; the rest is only counted.
const MAX_LISTED: usize = 12;
/// Costs above this are not given as numbers: such regions have nothing in common.
const MOST_COST: f64 = 100.0;
/// What the two numbers of a pair mean.
const SCORES: &str = "*Two equal regions have similarity 1 and cost 0. Pairs are chosen by cost.*";

/// A region of a view of a character.
#[derive(Debug, Clone, Copy)]
pub(super) struct Region<'a> {
    pub(super) character: &'a Character,
    pub(super) at: RegionInView,
}

impl<'a> Region<'a> {
    /// Its shape, or the picture that shows it.
    pub(super) fn shape(self) -> Option<ShapeId> {
        self.character.regions[self.track()?].shapes[self.at.view]
    }

    /// Its track in the character's matching.
    fn track(self) -> Option<TrackId> {
        let RegionInView { view, id } = self.at;
        let tracks = &self.character.matching.tracks;
        tracks.position(|track| track.regions[view] == Some(id))
    }

    /// What shows the same thing, in the order of the views.
    pub(super) fn partners(self) -> impl Iterator<Item = Region<'a>> {
        let track = self
            .track()
            .map(|track| &self.character.matching.tracks[track]);
        let regions = track
            .into_iter()
            .flat_map(|track| track.regions.iter_enumerated());
        regions.filter_map(move |(view, id)| {
            let at = RegionInView { view, id: (*id)? };
            (view != self.at.view).then_some(Self { at, ..self })
        })
    }

    /// Why it has no partner; `None` if it has one.
    pub(super) fn unmatched(self) -> Option<&'a Unmatched> {
        let mut unmatched = self.character.matching.unmatched.iter();
        unmatched.find(|unmatched| unmatched.region == self.at)
    }

    /// The name that a string or a label gives it.
    pub(super) fn name(self) -> Option<&'a str> {
        let RegionInView { view, id } = self.at;
        self.character.views[view].regions[id].name.as_deref()
    }

    /// The comparison with a region that it was matched with directly.
    fn pair_with(self, other: RegionInView) -> Option<&'a Pair> {
        let mut pairs = self.character.matching.pairs.iter();
        pairs.find(|pair| {
            [pair.first, pair.second] == [self.at, other]
                || [pair.second, pair.first] == [self.at, other]
        })
    }

    /// The paints of the views, if they differ: a list in Markdown.
    fn paints_card(self) -> String {
        let track = self.track().map(|track| &self.character.regions[track]);
        let Some(paints) = track.and_then(RegionModel::paints_in_views) else {
            return String::new();
        };
        let mut out = "\nEach view has its own paint, mixed in between:\n\n".to_owned();
        for (view, paint) in paints.into_iter_enumerated() {
            if let Some(paint) = paint {
                let _ = writeln!(out, "- in {}: {paint}", angles(self.character, view));
            }
        }
        out
    }

    /// `45 0`: the angles of its view as a string gives them.
    fn angles(self) -> String {
        angles(self.character, self.at.view)
    }
}

fn angles(character: &Character, view: ViewId) -> String {
    let [theta, phi] = character.turn.views[view];
    format!("`{theta} {phi}`")
}

impl Analysis {
    /// The regions that a shape is, or shows if it is a picture. None for shapes outside of characters.
    pub(super) fn regions_of_shape(&self, shape: ShapeId) -> Vec<Region<'_>> {
        let mut found = Vec::new();
        for character in &self.compiled.characters {
            let tracks = character.regions.iter().zip(&character.matching.tracks);
            for (model, track) in tracks {
                for (view, own) in model.shapes.iter_enumerated() {
                    if let Some(id) = track.regions[view].filter(|_| *own == Some(shape)) {
                        let at = RegionInView { view, id };
                        found.push(Region { character, at });
                    }
                }
            }
        }
        found.sort_by_key(|found| found.at.id);
        found
    }

    /// The region of a picture that a string names.
    fn region_of_string(&self, string: StringId) -> Option<Region<'_>> {
        self.compiled.characters.iter().find_map(|character| {
            let tracks = character.regions.iter().zip(&character.matching.tracks);
            let mut named = tracks.filter_map(|(model, track)| {
                let view = model.strings.position(|own| *own == Some(string))?;
                let id = track.regions[view]?;
                let at = RegionInView { view, id };
                Some(Region { character, at })
            });
            named.next()
        })
    }

    /// Describes the region of a picture that a string names. `None` for other strings.
    pub(super) fn named_region_card(&self, string: StringId) -> Option<String> {
        let region = self.region_of_string(string)?;
        let (what, name) = (
            self.describe_region(region),
            escaped(&region.character.name),
        );
        let head = format!("{what} of {name}, seen from {}", region.angles());
        Some(format!("{head}\n\n{}", self.partners_card(region)))
    }

    /// The partners of a region that is a shape, with how well they fit, or why it has none.
    pub(super) fn region_card(&self, shape: ShapeId) -> Option<String> {
        let regions = self.regions_of_shape(shape);
        let [region] = regions.as_slice() else {
            return None;
        };
        Some(self.partners_card(*region))
    }

    /// The partners of a region, with how well they fit, or why it has none.
    fn partners_card(&self, region: Region<'_>) -> String {
        if let Some(unmatched) = region.unmatched() {
            return self.alone_card(region, unmatched);
        }
        let mut out = "The same in other views:\n\n".to_owned();
        for partner in region.partners() {
            let (angles, what) = (partner.angles(), self.partner(region, partner));
            let _ = writeln!(out, "- in {angles}: {what}");
        }
        out.push_str(&region.paints_card());
        let _ = write!(out, "\n{SCORES}");
        out
    }

    /// Why a region has no partner, and what fits it best.
    fn alone_card(&self, region: Region<'_>, unmatched: &Unmatched) -> String {
        let name = escaped(&region.character.name);
        let mut out = format!(
            "No other view of {name} has a partner for it: it shrinks to nothing within 15° of this one."
        );
        if unmatched.candidates.is_empty() {
            return out;
        }
        out.push_str(" What fits it best:\n\n");
        for candidate in &unmatched.candidates {
            let at = candidate.region;
            let other = Region { at, ..region };
            let _ = writeln!(
                out,
                "- in {}: {}, {}; {}",
                other.angles(),
                self.describe_region(other),
                scores(candidate.similarity, candidate.cost),
                self.why_not(region, candidate)
            );
        }
        let _ = write!(out, "\n{SCORES}");
        out
    }

    /// Why a candidate is no partner.
    fn why_not(&self, region: Region<'_>, candidate: &Candidate) -> String {
        match candidate.reason {
            Reason::Color => "its colour differs too much".to_owned(),
            Reason::Names => "it has another name".to_owned(),
            Reason::Line => "only one of the two is a line".to_owned(),
            Reason::OtherRegion => "it is a line of another region".to_owned(),
            Reason::Cost => "it is too far away, or too different in size".to_owned(),
            Reason::Taken(at) => {
                let by = self.describe_region(Region { at, ..region });
                format!("it belongs to {by}")
            }
        }
    }

    /// A partner of a region, and how well it fits.
    fn partner(&self, region: Region<'_>, partner: Region<'_>) -> String {
        let mut out = self.describe_region(partner);
        match region.pair_with(partner.at) {
            Some(pair) => {
                let _ = write!(out, ", {}", scores(pair.similarity, pair.cost));
            }
            None => out.push_str(", because both belong to a region of a third view"),
        }
        if region.name().is_some() && region.name() == partner.name() {
            out.push_str("; they have the same name");
        }
        out
    }

    /// A region in Markdown: its name, and its element or its number and colour in a picture.
    fn describe_region(&self, region: Region<'_>) -> String {
        let element = self.element_of_region(region);
        match region.name() {
            Some(name) => format!("**{}** ({element})", escaped(name)),
            None => element,
        }
    }

    /// The same for the title of an action.
    pub(super) fn title_of_region(&self, region: Region<'_>) -> String {
        let element = self.element_of_region(region);
        match region.name() {
            Some(name) => format!("`{name}` ({element})"),
            None => element,
        }
    }

    fn element_of_region(&self, region: Region<'_>) -> String {
        let RegionInView { view, id } = region.at;
        let shape = region
            .shape()
            .map(|shape| (shape, &self.drawing().shapes[shape]));
        match shape {
            Some((shape, found)) if found.picture.is_none() => {
                let element = &found.element;
                if element.label.is_some() || element.id.is_some() {
                    element.describe()
                } else {
                    self.drawing().describe(shape)
                }
            }
            _ => {
                let color = region.character.views[view].regions[id].color;
                let [r, g, b] = [0, 1, 2].map(|i| (color[i] * 255.0).round() as u8);
                format!("region {} in `#{r:02x}{g:02x}{b:02x}`", usize::from(id) + 1)
            }
        }
    }

    /// Describes the view that a string makes of its layer: its regions and their partners. `None` for other strings.
    pub(super) fn view_card(&self, string: StringId) -> Option<String> {
        let bindings = self.bindings();
        let index = bindings.layers.position(|layer| layer.string == string)?;
        let layer = &bindings.layers[index];
        if layer.kind != LayerKind::View {
            return None;
        }
        let name = escaped(&layer.name);
        let group = self.drawing().describe_group(layer.group);
        let found = self.compiled.characters.iter().find_map(|character| {
            let view = character.layers.position(|layer| *layer == index)?;
            Some((character, view))
        });
        let Some((character, view)) = found else {
            return Some(format!(
                "**{name}**, {group}\n\nThis view is not built: a character needs two views from different sides, with shapes in both."
            ));
        };
        let regions = character.views[view].regions.keys();
        let regions = regions.map(|id| Region {
            character,
            at: RegionInView { view, id },
        });
        let angles = angles(character, view);
        let head = format!("**{name}**, seen from {angles}: {group}");
        Some(format!(
            "{head}\n\n{}",
            self.pairs_card(&regions.collect::<Vec<_>>())
        ))
    }

    /// Describes the regions of a picture in a view, and their partners. `None` for what is no such picture.
    pub(super) fn picture_card(&self, shape: ShapeId) -> Option<String> {
        self.drawing().shapes[shape].picture.as_ref()?;
        let regions = self.regions_of_shape(shape);
        let first = *regions.first()?;
        let name = escaped(&first.character.name);
        let head = format!("**A picture** of {name}, seen from {}", first.angles());
        Some(format!("{head}\n\n{}", self.pairs_card(&regions)))
    }

    /// How many regions have a partner, and which; those without one first.
    fn pairs_card(&self, regions: &[Region<'_>]) -> String {
        let (alone, matched): (Vec<Region<'_>>, Vec<Region<'_>>) = regions
            .iter()
            .partition(|region| region.unmatched().is_some());
        let count = regions.len();
        let mut out = match alone.len() {
            0 => format!("Regions: {count}, all with a partner in another view\n\n"),
            alone => {
                format!("Regions: {count}, {alone} of them without a partner in another view\n\n")
            }
        };
        for region in alone.iter().chain(&matched).take(MAX_LISTED) {
            let what = self.describe_region(*region);
            let mut partners = region.partners();
            let _ = match (partners.next(), partners.count()) {
                (None, _) => writeln!(out, "- {what} has no partner"),
                (Some(first), more) => {
                    let partner = self.partner(*region, first);
                    let more = match more {
                        0 => String::new(),
                        1 => ", and in 1 more view".to_owned(),
                        more => format!(", and in {more} more views"),
                    };
                    writeln!(out, "- {what} – {partner}{more}")
                }
            };
        }
        if let Some(more) = count.checked_sub(MAX_LISTED).filter(|more| *more > 0) {
            let _ = writeln!(out, "- … and {more} more");
        }
        let _ = write!(out, "\n{SCORES}");
        out
    }

    /// Where the partners of a shape's regions are: their strings, or the tags of their shapes.
    pub(super) fn partners_of_shape(&self, shape: ShapeId) -> Vec<Span> {
        let regions = self.regions_of_shape(shape).into_iter();
        let partners = regions.flat_map(Region::partners);
        let mut found: Vec<Span> = Vec::new();
        for span in partners.filter_map(|partner| self.span_of_region(partner)) {
            // All regions of a picture are in one place.
            if !found.contains(&span) {
                found.push(span);
            }
        }
        found
    }

    /// The span that names a region, or the tag of its shape.
    fn span_of_region(&self, region: Region<'_>) -> Option<Span> {
        let model = region.track().map(|track| &region.character.regions[track]);
        if let Some(string) = model.and_then(|model| model.strings[region.at.view]) {
            return Some(self.span_of_string(string));
        }
        Some(span_of_shape(&self.compiled, region.shape()?))
    }

    /// Where what a string names is in the other views of a character: the partners of its region, or the strings of the other
    /// views. `None` if there are none.
    pub(super) fn in_other_views(&self, string: StringId) -> Option<Vec<Target>> {
        let spans = match self.part_of_string(string) {
            Some(part) => self.partners_of_shape(self.bindings().parts[part].shape),
            None => match self.region_of_string(string) {
                Some(region) => {
                    let partners = region.partners();
                    let spans = partners.filter_map(|partner| self.span_of_region(partner));
                    spans.collect()
                }
                None => self.other_views(string),
            },
        };
        (!spans.is_empty()).then(|| spans.into_iter().map(Target::Here).collect())
    }

    /// The strings of the other views of the character whose view a string makes.
    fn other_views(&self, string: StringId) -> Vec<Span> {
        let layers = &self.bindings().layers;
        let strings = |character: &Character| -> Vec<StringId> {
            let views = character.layers.iter();
            views.map(|layer| layers[*layer].string).collect()
        };
        let mut characters = self.compiled.characters.iter().map(strings);
        let found = characters.find(|strings| strings.contains(&string));
        let others = found.into_iter().flatten().filter(|other| *other != string);
        others.map(|other| self.span_of_string(other)).collect()
    }
}

/// How well two regions fit each other.
fn scores(similarity: f64, cost: f64) -> String {
    if cost < MOST_COST {
        format!("similarity {similarity:.2}, cost {cost:.2}")
    } else {
        format!("similarity {similarity:.2}, cost above {MOST_COST}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::analysis;
    use super::super::{Analysis, Target};

    /// A box from two sides: `front` and `side` are the contents of the views besides its body.
    fn box_with(front: &str, side: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"100\">\n\
             <g id=\"front\"><rect id=\"body\" x=\"30\" y=\"20\" width=\"40\" height=\"50\" fill=\"#3366cc\"/>\n{front}\n\
             <text x=\"10\" y=\"90\" font-size=\"8\">Box$View 0 0</text></g>\n\
             <g id=\"side\"><rect id=\"body-2\" x=\"130\" y=\"20\" width=\"42\" height=\"50\" fill=\"#3366cc\"/>\n{side}\n\
             <text x=\"110\" y=\"90\" font-size=\"8\">Box$View 45 0</text></g>\n</svg>\n"
        )
    }

    const BADGE: &str = "<circle id=\"badge\" cx=\"40\" cy=\"40\" r=\"5\" fill=\"#ffcc00\"/>";
    const OTHER_BADGE: &str =
        "<circle id=\"badge-2\" cx=\"138\" cy=\"40\" r=\"5\" fill=\"#ffcc00\"/>";

    fn card(source: &str) -> String {
        let (analysis, at) = analysis(source);
        analysis
            .hover(at)
            .map_or(String::new(), |hover| hover.markdown)
    }

    #[track_caller]
    fn assert_has(card: &str, parts: &[&str]) {
        for part in parts {
            assert!(card.contains(part), "{part} is not in:\n{card}");
        }
    }

    #[test]
    fn hovers_of_regions_tell_their_partners() {
        let badge = BADGE.replace("<circle", "<cir¦cle");
        let found = card(&box_with(&badge, OTHER_BADGE));
        assert_has(
            &found,
            &[
                "**A region** of Box",
                "- in `45 0`: `#badge-2`, similarity 0.",
                ", cost 0.",
            ],
        );
        let named = |circle: &str, name: &str| {
            let named = format!("><desc>{name}</desc></circle>");
            circle.replace("/>", &named)
        };
        let found = card(&box_with(
            &named(BADGE, "St¦ar"),
            &named(OTHER_BADGE, "Star"),
        ));
        assert_has(
            &found,
            &["**Star** (`#badge-2`)", "they have the same name"],
        );
    }

    #[test]
    fn hovers_of_regions_tell_the_paints_of_the_views() {
        let badge = BADGE.replace("<circle", "<cir¦cle");
        let found = card(&box_with(&badge, OTHER_BADGE));
        assert!(!found.contains("paint"), "{found}");
        let other = OTHER_BADGE.replace("#ffcc00", "#cc9900\" fill-opacity=\".8");
        let found = card(&box_with(&badge, &other));
        assert_has(
            &found,
            &[
                "Each view has its own paint",
                "- in `0 0`: #ffcc00\n",
                "- in `45 0`: #cc9900cc\n",
            ],
        );
    }

    #[test]
    fn hovers_of_regions_without_a_partner_tell_the_candidates() {
        let found = card(&box_with(&BADGE.replace("<circle", "<cir¦cle"), ""));
        assert_has(
            &found,
            &[
                "No other view of Box has a partner for it",
                "- in `45 0`: `#body-2`, similarity 0.00, cost ",
                "; its colour differs too much",
            ],
        );
    }

    #[test]
    fn hovers_of_views_list_their_regions() {
        let source = box_with(BADGE, "").replacen("Box$View 0 0", "B¦ox$View 0 0", 1);
        let found = card(&source);
        assert_has(
            &found,
            &[
                "**Box**, seen from `0 0`: ",
                "Regions: 2, 1 of them without a partner",
                "- `#badge` has no partner",
                "- `#body` – `#body-2`, similarity 0.",
            ],
        );
        let keyword = card(&source.replace('¦', "").replacen("View", "Vi¦ew", 1));
        assert_has(&keyword, &["Regions: 2", "**View**\n"]);
        let alone = card(&source.replace("View 45 0", "View 0 0"));
        assert_has(&alone, &["**Box**", "This view is not built"]);
    }

    fn leads(source: &str) -> Vec<String> {
        let (analysis, at) = analysis(source);
        let targets = analysis
            .definition(at)
            .map_or(vec![], |(_, targets)| targets);
        let text = |target: &Target| match target {
            Target::Here(span) => analysis.source()[span.start..].chars().take(18).collect(),
            Target::File(name) => name.clone(),
        };
        targets.iter().map(text).collect()
    }

    #[test]
    fn definitions_lead_to_the_partner() {
        let star = BADGE.replace("/>", "><desc>Sta¦r</desc></circle>");
        // To its shape, its string, its own shape if there is none.
        assert_eq!(
            leads(&box_with(&star, OTHER_BADGE)),
            ["<circle id=\"badge-"]
        );
        let other = OTHER_BADGE.replace("/>", "><desc>Star$Depth 2</desc></circle>");
        assert_eq!(leads(&box_with(&star, &other)), ["Star$Depth 2</desc"]);
        assert_eq!(leads(&box_with(&star, "")), ["<circle id=\"badge\""]);
        let tag = BADGE.replace("<circle", "<cir¦cle");
        assert_eq!(leads(&box_with(&tag, &other)), ["Star$Depth 2</desc"]);
        let views = box_with(BADGE, "").replacen("Box$View 0", "B¦ox$View 0", 1);
        assert_eq!(leads(&views), ["Box$View 45 0</tex"]);
    }

    #[test]
    fn references_are_in_all_views() {
        let star = BADGE.replace("/>", "><desc>Sta¦r</desc></circle>");
        let other = OTHER_BADGE.replace("/>", "><desc>Star</desc></circle>");
        let places = |side: &str| {
            let (analysis, at) = analysis(&box_with(&star, side));
            let texts =
                |span: &crate::source::Span| analysis.source()[span.start..span.end].to_owned();
            let found = analysis.references(at, true);
            found.iter().map(texts).collect::<Vec<_>>()
        };
        assert_eq!(places(&other), ["Star", "Star"]);
        assert_eq!(places(OTHER_BADGE), ["Star", "<circle"]);
        let of_tag = |analysis: &Analysis, at| analysis.references(at, true).len();
        let (analysis, at) = analysis(&box_with(
            &BADGE.replace("<circle", "<cir¦cle"),
            OTHER_BADGE,
        ));
        assert_eq!(of_tag(&analysis, at), 2);
    }
}
