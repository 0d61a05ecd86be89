//! The attributes of parts, tile layers and tiles by their keywords: the one place where a keyword is matched with the type of its
//! value.

use super::{
    Attribute, Attributes, BALLOON, Carry, MaterialFactors, PLATE, SetBy, SetColor, Side, Source,
    plate_depth,
};
use glam::DVec2;

use crate::bind::StringId;
use crate::lang::keyword::Keyword;
use crate::lang::value::{Mark, Origin, Setting, Shape, Value};
use crate::solid::Profile;
use crate::svg::Drawing;

/// The value of an attribute where it has the form of the pattern.
macro_rules! typed {
    ($attributes:ident, $keyword:expr, $pattern:pat => $value:expr) => {
        $attributes.get($keyword, |value| match value {
            $pattern => Some($value),
            _ => None,
        })
    };
}

impl<'a> Attributes<'a> {
    /// Those of what is in a layer whose string has these settings.
    pub(super) fn in_layer(self, layer: Option<(StringId, &'a [Setting])>) -> Self {
        Self { layer, ..self }
    }

    /// Those of a part that is inflated if nothing sets its `Shape`, or is a plate, of half this thickness, drawing units, if it is a
    /// disc or a prop.
    pub(super) fn of_form(self, is_balloon: bool, plate: Option<f64>) -> Self {
        let builtin_shape = if is_balloon { &BALLOON } else { &PLATE };
        Self {
            builtin_shape,
            plate,
            ..self
        }
    }

    /// Where an attribute is set.
    pub fn source(&self, keyword: Keyword) -> Option<Source<'a>> {
        let in_string = |(string, settings): (StringId, &'a [Setting])| {
            let mut settings = settings.iter();
            let setting = settings.find(|setting| setting.keyword == keyword)?;
            Some((string, setting))
        };
        let in_list = |settings: &'a [(StringId, Setting)]| {
            let mut settings = settings.iter();
            let (string, setting) = settings.find(|(_, setting)| setting.keyword == keyword)?;
            Some((*string, setting))
        };
        let found = |from, found: Option<(StringId, &'a Setting)>| {
            found.map(|(string, setting)| Source {
                setting,
                from,
                string,
            })
        };
        found(SetBy::Own, self.own.and_then(in_string))
            .or_else(|| found(SetBy::Legend, in_list(self.legend)))
            .or_else(|| found(SetBy::Own, self.layer.and_then(in_string)))
            .or_else(|| found(SetBy::Default, in_list(self.defaults)))
    }

    fn get<T>(
        &self,
        keyword: Keyword,
        typed: impl Fn(&'a Value) -> Option<T>,
    ) -> Option<Attribute<'a, T>> {
        let source = self.source(keyword)?;
        let value = typed(&source.setting.value)?;
        Some(Attribute { value, source })
    }

    fn number(&self, keyword: Keyword) -> Option<Attribute<'a, f64>> {
        typed!(self, keyword, Value::Number(number) => *number)
    }

    fn word(&self, keyword: Keyword) -> Option<Attribute<'a, &'a str>> {
        typed!(self, keyword, Value::Word(word) => word.as_str())
    }

    fn value_or(&self, keyword: Keyword, default: f64) -> f64 {
        self.number(keyword).map_or(default, |number| number.value)
    }

    /// `Shape`, if it is set.
    pub fn shape_if_set(&self) -> Option<Attribute<'a, &'a Shape>> {
        typed!(self, Keyword::Shape, Value::Shape(shape) => shape)
    }

    /// `Shape`.
    pub fn shape(&self) -> &'a Shape {
        self.shape_if_set()
            .map_or(self.builtin_shape, |shape| shape.value)
    }

    /// Whether ink with these attributes has a form of its own rather than that of the part on which it lies.
    pub(in crate::bind) fn have_own_form(&self) -> bool {
        let shape = self.source(Keyword::Shape);
        shape.is_some_and(|shape| shape.from < SetBy::Default)
    }

    /// How an outline with these attributes gets its thickness; `None` for `Shape none`.
    pub(in crate::bind) fn profile(&self, drawing: &Drawing) -> Option<Profile> {
        let shape = self.shape();
        let plate = self.plate.filter(|_| self.source(Keyword::Shape).is_none());
        let plate = plate.unwrap_or_else(|| plate_depth(drawing));
        Profile::new(shape.kind, shape.numbers(), plate)
    }

    /// `Stand`: the point of the page on which a prop stands, if it is set, drawing units.
    pub fn stand(&self) -> Option<Attribute<'a, DVec2>> {
        typed!(self, Keyword::Stand, Value::Pair(point) => DVec2::from_array(*point))
    }

    /// `Offset`: towards the viewer, drawing units.
    pub fn offset(&self) -> Option<Attribute<'a, f64>> {
        self.number(Keyword::Offset)
    }

    /// `Stack`: how far drawing order spreads parts in depth.
    pub fn stack(&self) -> f64 {
        self.value_or(Keyword::Stack, 1.0)
    }

    /// `Origin`, if it or `Shape -c` is set.
    pub fn origin(&self) -> Option<Origin> {
        let origin = typed!(self, Keyword::Origin, Value::Origin(origin) => *origin);
        let centered = || self.shape().centered.then_some(Origin::Center);
        origin.map(|origin| origin.value).or_else(centered)
    }

    /// `Axis`: degrees, counter-clockwise from the drawing's right.
    pub fn axis(&self) -> Option<f64> {
        self.number(Keyword::Axis).map(|axis| axis.value)
    }

    /// `Segments`, if it is set: layers per half turn.
    pub fn segments(&self) -> Option<u32> {
        let segments = self.number(Keyword::Segments)?;
        Some(segments.value as u32)
    }

    /// `Smooth`: the angle between faces from which on an edge is sharp, degrees.
    pub fn crease(&self) -> f64 {
        self.value_or(Keyword::Smooth, 30.0)
    }

    /// `Color`.
    pub fn color(&self) -> Option<SetColor> {
        let color = typed!(self, Keyword::Color, Value::Color { rgb, alpha } => SetColor {
            rgb: *rgb,
            alpha: *alpha,
        });
        color.map(|color| color.value)
    }

    /// The factors of the material of a surface that is painted with this sRGB colour and opacity; `color` replaces it.
    pub fn material_factors(&self, painted: [f64; 4], color: Option<SetColor>) -> MaterialFactors {
        let [r, g, b, opacity] = painted;
        let color = color.unwrap_or(SetColor {
            rgb: [r, g, b],
            alpha: None,
        });
        let [r, g, b] = color.rgb;
        let opacity = color.alpha.unwrap_or(opacity);
        let emissive = typed!(self, Keyword::Emissive, Value::Triple(rgb) => *rgb);
        MaterialFactors {
            color: [r, g, b, self.value_or(Keyword::Alpha, opacity)],
            metallic: self.value_or(Keyword::Metallic, 0.0),
            roughness: self.value_or(Keyword::Roughness, 0.9),
            emissive: emissive.map_or([0.0; 3], |emissive| emissive.value),
        }
    }

    /// `Texture`: the link to an image.
    pub fn texture(&self) -> Option<Attribute<'a, &'a str>> {
        self.word(Keyword::Texture)
    }

    /// `Bone`: the names of the joints that drive the part.
    pub fn bones(&self) -> Option<Attribute<'a, &'a [String]>> {
        typed!(self, Keyword::Bone, Value::Names(names) => names.as_slice())
    }

    /// `Mark`: the colour mark that performs the part.
    pub fn mark(&self) -> Option<Attribute<'a, &'a Mark>> {
        typed!(self, Keyword::Mark, Value::Mark(mark) => mark)
    }

    /// `Follow`: the names of the parts or joints that are edited together with the part.
    pub fn follows(&self) -> Option<Attribute<'a, &'a [String]>> {
        typed!(self, Keyword::Follow, Value::Names(names) => names.as_slice())
    }

    /// `Side`.
    pub fn side(&self) -> Option<Side> {
        match self.word(Keyword::Side)?.value.to_lowercase().as_str() {
            "near" => Some(Side::Near),
            _ => Some(Side::Both),
        }
    }

    /// `Bend`, if it is set: how many joints a part has inside.
    pub fn bend(&self) -> Option<usize> {
        let joints = self.number(Keyword::Bend)?;
        Some(joints.value as usize)
    }

    /// `Swing`: how stiff a part is that swings, `None` for one that does not.
    pub fn swing(&self) -> Option<f64> {
        let stiffness = self.get(Keyword::Swing, |value| match value {
            Value::Number(stiffness) => Some(*stiffness),
            _ => Some(1.0),
        });
        stiffness.map(|stiffness| stiffness.value)
    }

    /// `Carry`: what a limb takes over from the joint that drives it.
    pub fn carry(&self) -> Option<Carry> {
        match self.word(Keyword::Carry)?.value {
            "direction" => Some(Carry::Direction),
            "change" => Some(Carry::Change),
            _ => None,
        }
    }

    /// `Tile`: the word for what tiles of the paint are, from the legend.
    pub fn tile(&self) -> Option<&'a str> {
        let word = self.word(Keyword::Tile);
        let word = word.filter(|word| word.source.from == SetBy::Legend);
        word.map(|word| word.value)
    }

    /// `Tiles`: the side of a tile, drawing units. A layer has it in its own string.
    pub fn tile_size(&self) -> Option<Attribute<'a, f64>> {
        let size = self.number(Keyword::Tiles);
        size.filter(|size| size.source.from == SetBy::Own)
    }

    /// `Tiles`: the link to the file of a map, if the layer is one.
    pub fn tile_file(&self) -> Option<Attribute<'a, &'a str>> {
        let file = self.word(Keyword::Tiles);
        file.filter(|file| file.source.from == SetBy::Own)
    }

    /// `Roof`: the height of roofs over their depth.
    pub fn roof(&self) -> Option<f64> {
        self.number(Keyword::Roof).map(|roof| roof.value)
    }

    /// `Height`: that of the tops of tiles, if it is set.
    pub fn height(&self) -> Option<Attribute<'a, i8>> {
        typed!(self, Keyword::Height, Value::Number(height) => *height as i8)
    }

    /// `Bevel`: the radius of the ground's bevel, tiles.
    pub fn bevel(&self) -> f64 {
        self.value_or(Keyword::Bevel, 0.0)
    }
}
