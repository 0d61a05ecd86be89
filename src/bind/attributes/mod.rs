//! The attributes of parts and tile layers as typed values, each with its source: own string, legend of the paint, `%`,
//! built-in default.
//!
//! `values` is the one place where an attribute's keyword is matched with the type of its value.

mod given_depths;
mod legends;
mod marks;
mod motions;
mod values;

pub(crate) use legends::Legend;
pub(crate) use marks::{FollowedName, PartMark};
#[cfg(test)]
pub(in crate::bind) use motions::PerformanceEffects;
pub(crate) use motions::{
    Camerawork, ClipLimits, ClipRequest, HeldRequest, MotionSource, MotionTurn, PerformanceRequest,
    SignedAxis, TurnRequest,
};

use typed_index_collections::{TiSlice, TiVec};

use super::bindings::{Bindings, DrawingString, Part, PartId, StringId};
use super::matching::{LayerId, Matched};
use crate::diagnostic::Diagnostic;
use crate::lang::keyword::{AttributeString, Keyword};
use crate::lang::value::{KindArguments, Setting, Shape};
use crate::solid::Profile;
use crate::source::Span;
use crate::svg::{Drawing, PaintKey};

/// How far a plate whose depths are not given reaches to either side, as a share of the page's diagonal.
const PLATE_DEPTH: f64 = 0.025;

/// The attributes that ink takes from the part on which it lies.
const OF_FORM: [Keyword; 7] = [
    Keyword::Shape,
    Keyword::Offset,
    Keyword::Stack,
    Keyword::Segments,
    Keyword::Smooth,
    Keyword::Axis,
    Keyword::Origin,
];

/// Who sets an attribute; the first of them wins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SetBy {
    /// The part's own string, or that of the layer of tiles or props.
    Own,
    /// The legend of its paint.
    Legend,
    /// A `%` string.
    Default,
    /// The program's default.
    Builtin,
}

impl SetBy {
    /// The word for `inspect`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Legend => "legend",
            Self::Default => "default",
            Self::Builtin => "builtin",
        }
    }
}

/// A setting and where it comes from.
#[derive(Debug, Clone, Copy)]
pub struct Source<'a> {
    /// The setting.
    pub setting: &'a Setting,
    /// Who sets it.
    pub from: SetBy,
    /// The string that sets it.
    pub string: StringId,
}

/// The value of an attribute that a string sets, and its source.
#[derive(Debug, Clone, Copy)]
pub struct Attribute<'a, T> {
    /// The value.
    pub value: T,
    /// Where it comes from.
    pub source: Source<'a>,
}

/// The word of `Carry`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carry {
    /// The limb points where the actor's does.
    Direction,
    /// It turns by as much as the actor's does, from the pose in which it is drawn.
    Change,
}

/// An attribute of a part, for people.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Resolved {
    /// The attribute.
    pub keyword: Keyword,
    /// Its value as words.
    pub value: String,
    /// Who sets it.
    pub from: SetBy,
    /// The string that sets it.
    pub string: Option<StringId>,
}

/// The word of `Side`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// A shape shows where it is drawn alone.
    Near,
    /// It shows on the back as well, mirrored.
    Both,
}

/// The colour that `Color` sets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetColor {
    /// sRGB, each 0 to 1.
    pub rgb: [f64; 3],
    /// Opacity, if given.
    pub alpha: Option<f64>,
}

/// The factors of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialFactors {
    /// sRGB and opacity, each 0 to 1.
    pub color: [f64; 4],
    /// glTF's metallic factor.
    pub metallic: f64,
    /// glTF's roughness factor.
    pub roughness: f64,
    /// sRGB, each 0 to 1.
    pub emissive: [f64; 3],
}

/// The attributes of a part, of a tile layer or of its tiles. A view that resolves a value when it is asked for it: a drawing
/// has a hundred thousand parts, most of them without attributes.
#[derive(Debug, Clone, Copy)]
pub struct Attributes<'a> {
    /// The settings of the part's own string, with its id.
    own: Option<(StringId, &'a [Setting])>,
    /// The settings of the legend of the paint, each with its string.
    legend: &'a [(StringId, Setting)],
    /// For tiles and props, the settings of their layer's string, with its id.
    layer: Option<(StringId, &'a [Setting])>,
    /// The settings of the `%` strings, each with its string.
    defaults: &'a [(StringId, Setting)],
    /// The `Shape` without settings.
    builtin_shape: &'static Shape,
    /// Half the thickness of a plate without settings, drawing units, if it is not the same as everywhere.
    plate: Option<f64>,
}

/// Who can set attributes.
#[derive(Clone, Copy)]
struct Setters<'a> {
    strings: &'a TiSlice<StringId, DrawingString>,
    legends: &'a [Legend],
    defaults: &'a [(StringId, Setting)],
}

impl<'a> Setters<'a> {
    /// The attributes of something with this string, in a paint with this legend.
    fn attributes(self, string: Option<StringId>, legend: Option<usize>) -> Attributes<'a> {
        Attributes {
            builtin_shape: &PLATE,
            plate: None,
            own: string.map(|string| self.settings_of(string)),
            legend: legend.map_or(&[], |legend| &self.legends[legend].settings),
            layer: None,
            defaults: self.defaults,
        }
    }

    fn settings_of(self, string: StringId) -> (StringId, &'a [Setting]) {
        (string, &self.strings[string].settings)
    }
}

/// The legends, and the parts whose attributes they set.
pub(in crate::bind) struct PartAttributes {
    /// The legends, merged by paint.
    pub(in crate::bind) legends: Vec<Legend>,
    /// Per part the legend of its paint.
    pub(in crate::bind) legend_of_part: TiVec<PartId, Option<usize>>,
}

/// Finds out who sets the attributes of each part.
pub(in crate::bind) fn resolve(
    drawing: &Drawing,
    matched: &Matched,
    diagnostics: &mut Vec<Diagnostic>,
) -> PartAttributes {
    legends::merge(drawing, matched, diagnostics)
}

impl PartAttributes {
    /// The attributes of a part.
    pub(in crate::bind) fn attributes<'a>(
        &'a self,
        matched: &'a Matched,
        part: PartId,
    ) -> Attributes<'a> {
        let setters = Setters {
            strings: &matched.strings,
            legends: &self.legends,
            defaults: &matched.defaults,
        };
        let (part, legend) = (&matched.parts[part], self.legend_of_part[part]);
        let layer = part.stands_in.map(|layer| matched.layers[layer].string);
        setters
            .attributes(part.attributes_from(), legend)
            .in_layer(layer.map(|string| setters.settings_of(string)))
            .of_form(part.is_balloon, part.plate)
    }
}

impl Source<'_> {
    /// The place of the setting in one of these strings.
    pub(in crate::bind) fn span(&self, strings: &TiSlice<StringId, DrawingString>) -> Span {
        let text = &strings[self.string].text;
        text.span(self.setting.range.clone())
    }
}

impl Bindings {
    fn setters(&self) -> Setters<'_> {
        Setters {
            strings: &self.strings,
            legends: &self.legends,
            defaults: &self.defaults,
        }
    }

    /// For a prop, the settings of its layer's string, with its id.
    fn settings_around(&self, part: &Part) -> Option<(StringId, &[Setting])> {
        let layer = part.stands_in?;
        Some(self.setters().settings_of(self.layers[layer].string))
    }

    /// The attributes of a part.
    pub fn attributes(&self, part: PartId) -> Attributes<'_> {
        let part = &self.parts[part];
        let attributes = self.setters().attributes(part.string, part.legend);
        let attributes = attributes.in_layer(self.settings_around(part));
        attributes.of_form(part.is_balloon, part.plate)
    }

    /// The attributes of a layer.
    pub fn layer_attributes(&self, layer: LayerId) -> Attributes<'_> {
        let string = self.layers[layer].string;
        self.setters().attributes(Some(string), None)
    }

    /// The attributes of the tiles of a layer whose paint has this legend.
    pub fn tile_attributes(&self, layer: LayerId, legend: Option<usize>) -> Attributes<'_> {
        let setters = self.setters();
        Attributes {
            layer: Some(setters.settings_of(self.layers[layer].string)),
            ..setters.attributes(None, legend)
        }
    }

    /// The place of a setting.
    pub fn span_of(&self, source: &Source<'_>) -> Span {
        source.span(&self.strings)
    }

    /// The source of a part's attribute; `None` leaves the built-in default.
    pub fn setting(&self, part: PartId, keyword: Keyword) -> Option<Source<'_>> {
        self.attributes(part).source(keyword)
    }

    /// Where a part's own string says `Bend`.
    pub(crate) fn bend_span(&self, part: PartId) -> Option<Span> {
        let source = self.setting(part, Keyword::Bend)?;
        (source.from == SetBy::Own).then(|| self.span_of(&source))
    }

    /// The source that a part's attribute would have without the part's own string.
    pub fn inherited(&self, part: PartId, keyword: Keyword) -> Option<Source<'_>> {
        let part = &self.parts[part];
        let attributes = self.setters().attributes(None, part.legend);
        attributes
            .in_layer(self.settings_around(part))
            .source(keyword)
    }

    /// The part whose attributes give a part its form: for ink the part on which it lies, unless the legend of its paint has a
    /// `Shape`.
    pub fn form(&self, part: PartId) -> PartId {
        let host = self.parts[part].host;
        let host = host.filter(|_| !self.attributes(part).have_own_form());
        host.unwrap_or(part)
    }

    /// Whether a string says a part's `Shape`.
    pub fn is_shape_set(&self, part: PartId) -> bool {
        self.setting(part, Keyword::Shape).is_some()
    }

    /// Whether a string says how far drawing order moves a part.
    pub fn is_stack_set(&self, part: PartId) -> bool {
        self.setting(part, Keyword::Stack).is_some()
    }

    /// How a part's outline gets its thickness; `None` for `Shape none`, and for ink on a model, which takes the place of all
    /// that is drawn there.
    pub fn profile(&self, drawing: &Drawing, part: PartId) -> Option<Profile> {
        let form = self.form(part);
        let profile = self.attributes(form).profile(drawing)?;
        let Part {
            shape,
            host,
            sheet,
            is_too_fine,
            ..
        } = &self.parts[part];
        let stroke = drawing.shapes[*shape].stroke.as_ref();
        let line = stroke.filter(|_| self.parts[part].is_stroke && host.is_none());
        if *is_too_fine {
            let usual = plate_depth(drawing);
            // A hair is as thick as it is wide.
            let reach = line.map_or(usual, |line| usual.min(line.width() / 2.0));
            return Some(Profile::plate(reach));
        }
        let profile = match sheet.filter(|_| !self.is_shape_set(form)) {
            Some(most) => profile.at_most(most),
            None => profile,
        };
        let profile = match line {
            Some(line) => profile.of_line(line.width()),
            None => profile,
        };
        Some(profile).filter(|profile| form == part || !matches!(profile, Profile::Model(_)))
    }

    /// Half of the width of a part where it is narrower, drawing units: that of its line, or of its outline.
    pub(crate) fn half_width(&self, drawing: &Drawing, part: PartId) -> f64 {
        let Part {
            measure,
            is_stroke,
            shape,
            ..
        } = &self.parts[part];
        let stroke = drawing.shapes[*shape].stroke.as_ref();
        let line = stroke.filter(|_| *is_stroke);
        line.map_or_else(
            || measure.half_across.min(measure.half_along),
            |line| line.width() / 2.0,
        )
    }

    /// `Side` of a part: its own, or that of its main part's string.
    pub fn side(&self, part: PartId) -> Option<Side> {
        let form = self.form(part);
        let own = self.attributes(form);
        let is_own = own
            .source(Keyword::Side)
            .is_some_and(|side| side.from < SetBy::Default);
        let main = self.parts[form].main;
        if is_own || main == form {
            own.side()
        } else {
            self.attributes(main).side()
        }
    }

    /// The factors of a part's material.
    pub fn material_factors(&self, drawing: &Drawing, part: PartId) -> MaterialFactors {
        let attributes = self.attributes(part);
        let paint = self.parts[part].paint(drawing);
        let [r, g, b] = paint.color.map(|channel| f64::from(channel) / 255.0);
        let opacity = drawing.shapes[self.parts[part].shape].opacity;
        // `Color` takes the place of a fill; a picture stays as it is.
        let is_picture = matches!(paint.key, PaintKey::Picture(_));
        let color = attributes.color().filter(|_| !is_picture);
        attributes.material_factors([r, g, b, opacity], color)
    }

    /// Every attribute of a part that is set, and the ones that every solid has, in the order of the reference.
    pub fn resolved(&self, drawing: &Drawing, part: PartId) -> Vec<Resolved> {
        let builtin = |keyword| match keyword {
            Keyword::Color => {
                let [r, g, b, _] = self
                    .material_factors(drawing, part)
                    .color
                    .map(|channel| (channel * 1000.0).round() / 1000.0);
                Some(format!("{r} {g} {b}"))
            }
            Keyword::Shape => Some(self.attributes(part).builtin_shape.kind.to_owned()),
            _ => None,
        };
        let keywords = Keyword::ALL.iter().copied();
        let has_form = self.form(part) == part;
        let of_parts = keywords.filter(|keyword| {
            keyword.row().allowed.permits(AttributeString::Part)
                && (has_form || !OF_FORM.contains(keyword))
        });
        of_parts
            .filter_map(|keyword| match self.setting(part, keyword) {
                Some(source) => Some(Resolved {
                    keyword,
                    value: source.setting.text.clone(),
                    from: source.from,
                    string: Some(source.string),
                }),
                None => Some(Resolved {
                    keyword,
                    value: builtin(keyword)?,
                    from: SetBy::Builtin,
                    string: None,
                }),
            })
            .collect()
    }
}

/// How far a plate whose depths are not given reaches to the front and to the back, drawing units.
pub(crate) fn plate_depth(drawing: &Drawing) -> f64 {
    drawing.page.1.length() * PLATE_DEPTH
}

/// The `Shape` of a part that sets none.
static PLATE: Shape = builtin("default");
/// That of a rounded one in a drawing that never says `Shape`.
static BALLOON: Shape = builtin("inflate");

const fn builtin(kind: &'static str) -> Shape {
    Shape {
        kind,
        arguments: KindArguments::Numbers(Vec::new()),
        has_depths: false,
        mirrored: false,
        doubled: false,
        centered: false,
    }
}

#[cfg(test)]
mod tests {
    use crate::lang::keyword::kinds::KINDS;
    use crate::lang::keyword::signature::Takes;
    use crate::solid::Profile;

    #[test]
    fn every_kind_of_the_table_is_built() {
        for kind in &KINDS {
            let is_number = |index: usize| {
                let parameter = &kind.form.parameters[index];
                matches!(parameter.takes, Takes::Number(_))
            };
            for count in kind.form.counts {
                let given = (0..*count).filter(|index| is_number(*index)).map(|_| 1.0);
                let defaults = kind.numbers.iter().skip(*count).copied();
                let numbers: Vec<f64> = given.chain(defaults).collect();
                let profile = Profile::new(kind.name, &numbers, 1.0);
                assert_eq!(profile.is_none(), kind.name == "none", "{}", kind.name);
            }
        }
    }
}
