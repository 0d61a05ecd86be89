//! The characters of a drawing that turn.

use serde::Serialize;

use crate::billboard::{Character, Looks, RegionId, RegionInView, Side, Track, TrackId, ViewId};
use crate::compile::Compiled;

/// A character.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Billboard<'a> {
    /// Its name.
    pub name: &'a str,
    /// The directions of its drawn views, degrees: around and up.
    pub views: &'a [[f64; 2]],
    /// The sides that nobody drew, but that follow from the views.
    pub sides: Vec<BillboardSide>,
    /// Its regions, back-most first in the first view that shows each.
    pub regions: Vec<BillboardRegion<'a>>,
}

/// A side of a character that follows from a view.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct BillboardSide {
    /// From where it is seen, degrees: around and up.
    pub view: [f64; 2],
    /// The direction of the view that it follows from.
    pub of: [f64; 2],
    /// How.
    pub kind: SideKind,
}

/// How a side follows from a view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum SideKind {
    /// It is its mirror image: the character is symmetric.
    Mirrored,
    /// It has the same silhouette, seen from behind.
    Behind,
}

/// A region of a character.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct BillboardRegion<'a> {
    /// Its name.
    pub name: &'a str,
    /// Per view the `id` of its element; `None` where the view does not show it, and for a region of a picture.
    pub members: Vec<Option<&'a str>>,
    /// Per view its number there, from 1; `None` where the view does not show it.
    pub numbers: Vec<Option<usize>>,
    /// Per view how it looks there; `None` where the view does not show it.
    pub looks: Vec<Option<Looks>>,
    /// The least similarity of its pairs (Kitamura, equation 4.1), 0 to 1; `None` for a region without a partner.
    pub similarity: Option<f64>,
    /// The greatest cost of its pairs, by which they were chosen: 0 for a perfect one; `None` for a region without a partner.
    pub cost: Option<f64>,
    /// What its pairs were made by; `None` for a region without a partner.
    pub matched_by: Option<MatchedBy>,
    /// Its position in the character's space, heights: its left, up, its front.
    pub position: [f64; 3],
    /// Per view what it is painted with; `None` where the view does not show it. Only of a region that does not look the same in all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub paints: Option<Vec<Option<String>>>,
}

/// What a region's pairs are made by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum MatchedBy {
    /// All have the same name or label.
    Name,
    /// Colour, place, size, and what they lie on.
    ColorAndPlace,
}

/// How well the regions that are taken for one fit each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fit {
    /// The least similarity of the pairs (Kitamura, equation 4.1), 0 to 1.
    pub similarity: f64,
    /// Their greatest cost, from 0; pairs above 3.5 are only made by names.
    pub cost: f64,
    /// What they were made by.
    pub by: MatchedBy,
}

impl Fit {
    /// That of a track; `None` if only one view shows it.
    pub(crate) fn of(character: &Character, track: &Track) -> Option<Self> {
        let name = |at: RegionInView| character.views[at.view].regions[at.id].name.as_ref();
        let pairs = character.matching.pairs.iter();
        let own = pairs.filter(|pair| track.regions[pair.second.view] == Some(pair.second.id));
        let fits = own.map(|pair| {
            let first = name(pair.first);
            let by = if first.is_some() && first == name(pair.second) {
                MatchedBy::Name
            } else {
                MatchedBy::ColorAndPlace
            };
            Self {
                similarity: pair.similarity,
                cost: pair.cost,
                by,
            }
        });
        fits.reduce(|a, b| Self {
            similarity: a.similarity.min(b.similarity),
            cost: a.cost.max(b.cost),
            by: if a.by == b.by {
                a.by
            } else {
                MatchedBy::ColorAndPlace
            },
        })
    }
}

/// The characters of a drawing.
pub(crate) fn billboards(compiled: &Compiled) -> Vec<Billboard<'_>> {
    let characters = compiled.characters.iter();
    characters
        .map(|character| Billboard {
            name: &character.name,
            views: &character.turn.views.raw[..character.layers.len()],
            sides: sides(character).collect(),
            regions: (character.regions.keys())
                .map(|index| region(compiled, character, index))
                .collect(),
        })
        .collect()
}

fn sides(character: &Character) -> impl Iterator<Item = BillboardSide> + '_ {
    let views = &character.turn.views;
    let added = views.iter().skip(character.layers.len());
    added.zip(&character.sides).map(|(view, side)| {
        let (kind, of) = match side {
            Side::Mirrored(of) => (SideKind::Mirrored, of),
            Side::Behind(of) => (SideKind::Behind, of),
        };
        BillboardSide {
            view: *view,
            of: views[*of],
            kind,
        }
    })
}

fn region<'a>(
    compiled: &'a Compiled,
    character: &'a Character,
    index: TrackId,
) -> BillboardRegion<'a> {
    let model = &character.regions[index];
    let track = &character.matching.tracks[index];
    let shapes = model.shapes.iter();
    let members = shapes.map(|shape| {
        let shape = &compiled.drawing.shapes[(*shape)?];
        let id = shape.element.id.as_deref();
        id.filter(|_| shape.picture.is_none())
    });
    let number = |region: &Option<RegionId>| Some(usize::from((*region)?) + 1);
    let looks = track.regions.iter().zip(&character.views);
    let looks = looks.map(|(region, view)| Some(view.looks((*region)?)));
    let fit = Fit::of(character, track);
    BillboardRegion {
        name: &model.name,
        members: members.collect(),
        numbers: track.regions.iter().map(number).collect(),
        looks: looks.collect(),
        similarity: fit.map(|fit| fit.similarity),
        cost: fit.map(|fit| fit.cost),
        matched_by: fit.map(|fit| fit.by),
        position: model.positions[ViewId::FIRST].to_array(),
        paints: model.paints_in_views().map(|paints| paints.raw),
    }
}

/// A character for people.
pub(crate) fn describe_character(character: &Character) -> String {
    let angles = |[theta, phi]: [f64; 2]| format!("{theta} {phi}");
    let views = character.turn.views.iter().take(character.layers.len());
    let views: Vec<String> = views.map(|view| angles(*view)).collect();
    let of_kind = |kind: SideKind| {
        let found = sides(character).filter(|side| side.kind == kind);
        let found: Vec<String> = found.map(|side| angles(side.view)).collect();
        found.join(" and ")
    };
    let also = [
        ("mirrored to", of_kind(SideKind::Mirrored)),
        ("from behind at", of_kind(SideKind::Behind)),
    ];
    let also = also.iter().filter(|(_, views)| !views.is_empty());
    let also: String = also
        .map(|(how, views)| format!(", {how} {views}"))
        .collect();
    let alone = character.matching.unmatched.len();
    let alone = match alone {
        0 => String::new(),
        count => format!(", {count} without a partner"),
    };
    let regions = match character.regions.len() {
        1 => "1 region".to_owned(),
        count => format!("{count} regions"),
    };
    format!(
        "character of {regions}{alone}, drawn from {}{also}",
        views.join(" and ")
    )
}
