//! What an attribute of a part is, and who says so: own string, legend of its paint, `%`, built-in default
//! (figure.md, Attributes of a part).

use rustc_hash::FxHashMap;

use super::bindings::{Bindings, PartKind};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::keyword::{AttributeString, Keyword};
use crate::lang::value::{Setting, Shape, ShapeKind, Value};
use crate::svg::{Drawing, PaintKey};

/// A legend: what parts of a paint have in common.
#[derive(Debug)]
pub struct Legend {
    /// The paint.
    pub paint: PaintKey,
    /// What it says, each with the index of its string.
    pub settings: Vec<(usize, Setting)>,
    /// Index of the shape beside which it stands.
    pub swatch: usize,
    /// Index of its string, the first one if there are several.
    pub string: usize,
    /// Whether something has the paint that may have use for it: a part or a drawn tile. What pictures show in
    /// tile layers is not counted.
    pub is_used: bool,
}

/// Who says what an attribute is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SetBy {
    /// The part's own string.
    Own,
    /// The legend of its paint.
    Legend,
    /// A `%` string.
    Default,
    /// Nobody: the program's default.
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
    /// Who says so.
    pub from: SetBy,
    /// Index of the string that says so.
    pub string: usize,
}

/// What an attribute of a part is, for people.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Resolved {
    /// The attribute.
    pub keyword: Keyword,
    /// Its value as words.
    pub value: String,
    /// Who says so.
    pub from: SetBy,
    /// Index of the string that says so.
    pub string: Option<usize>,
}

/// How a part's surface looks, all sources added up.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// sRGB and opacity, each 0 to 1.
    pub color: [f64; 4],
    /// glTF's metallic factor.
    pub metallic: f64,
    /// glTF's roughness factor.
    pub roughness: f64,
    /// sRGB, each 0 to 1.
    pub emissive: [f64; 3],
}

impl Bindings {
    /// What a part's attribute is set to, and by whom; `None` leaves the built-in default.
    pub fn setting(&self, index: usize, keyword: Keyword) -> Option<Source<'_>> {
        let part = &self.parts[index];
        let own = part.string.and_then(|string| {
            let setting = self.strings[string]
                .settings
                .iter()
                .find(|setting| setting.keyword == keyword)?;
            Some(Source {
                setting,
                from: SetBy::Own,
                string,
            })
        });
        own.or_else(|| self.inherited(index, keyword))
    }

    /// What a part's attribute would be set to without its own string.
    pub fn inherited(&self, part: usize, keyword: Keyword) -> Option<Source<'_>> {
        let part = &self.parts[part];
        let found = |settings: &'_ [(usize, Setting)]| {
            settings
                .iter()
                .position(|(_, setting)| setting.keyword == keyword)
        };
        let by_legend = || {
            let legend = &self.legends[part.legend?].settings;
            let (string, setting) = &legend[found(legend)?];
            Some(Source {
                setting,
                from: SetBy::Legend,
                string: *string,
            })
        };
        by_legend().or_else(|| {
            let (string, setting) = &self.defaults[found(&self.defaults)?];
            Some(Source {
                setting,
                from: SetBy::Default,
                string: *string,
            })
        })
    }

    /// Every attribute of a part that is set, and the ones that every solid has, in the order of the reference.
    pub fn resolved(&self, drawing: &Drawing, part: usize) -> Vec<Resolved> {
        let builtin = |keyword| match keyword {
            Keyword::Color => {
                let [r, g, b, _] = self
                    .look(drawing, part)
                    .color
                    .map(|channel| (channel * 1000.0).round() / 1000.0);
                Some(format!("{r} {g} {b}"))
            }
            Keyword::Shape => Some("default".to_owned()),
            _ => None,
        };
        let keywords = Keyword::ALL.iter().copied();
        let of_parts =
            keywords.filter(|keyword| keyword.row().allowed.permits(AttributeString::Part));
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

    /// The number that an attribute of a part is set to.
    pub fn number(&self, part: usize, keyword: Keyword) -> Option<f64> {
        match self.setting(part, keyword)?.setting.value {
            Value::Number(number) => Some(number),
            _ => None,
        }
    }

    /// A part's `Shape`.
    pub fn shape(&self, part: usize) -> Shape {
        match self
            .setting(part, Keyword::Shape)
            .map(|source| &source.setting.value)
        {
            Some(Value::Shape(shape)) => shape.clone(),
            _ => Shape {
                kind: ShapeKind::Default(None),
                mirrored: false,
                doubled: false,
                centered: false,
            },
        }
    }

    /// How a part's surface looks.
    pub fn look(&self, drawing: &Drawing, part: usize) -> Look {
        let shape = &drawing.shapes[self.parts[part].shape];
        let paint = self.parts[part].paint(drawing);
        let mut color = paint.color.map(|channel| f64::from(channel) / 255.0);
        let mut alpha = shape.opacity;
        let picture = matches!(paint.key, PaintKey::Picture(_));
        if let Some(Value::Color { rgb, alpha: own }) = self
            .setting(part, Keyword::Color)
            .map(|source| &source.setting.value)
            && !picture
        {
            color = *rgb;
            alpha = own.unwrap_or(alpha);
        }
        if let Some(own) = self.number(part, Keyword::Alpha) {
            alpha = own;
        }
        let emissive = match self
            .setting(part, Keyword::Emissive)
            .map(|source| &source.setting.value)
        {
            Some(Value::Rgb(rgb)) => *rgb,
            _ => [0.0; 3],
        };
        Look {
            color: [color[0], color[1], color[2], alpha],
            metallic: self.number(part, Keyword::Metallic).unwrap_or(0.0),
            roughness: self.number(part, Keyword::Roughness).unwrap_or(0.9),
            emissive,
        }
    }
}

/// Merges the legends by paint and gives them to the parts of that paint.
pub(super) fn legends(
    drawing: &Drawing,
    bindings: &mut Bindings,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let mut by_paint: FxHashMap<&PaintKey, usize> = FxHashMap::default();
    for part in bindings
        .parts
        .iter()
        .filter(|part| part.kind == PartKind::Legend && part.is_candidate())
    {
        let Some(string) = part.string else { continue };
        let paint = &part.paint(drawing).key;
        let settings = bindings.strings[string]
            .settings
            .iter()
            .map(|setting| (string, setting.clone()));
        if let Some(legend) = by_paint.get(paint) {
            let first = bindings.legends[*legend].string;
            diagnostics.push(
                Diagnostic::new(
                    Code::TwoLegends,
                    bindings.strings[string].text.whole(),
                    "this legend's paint has a legend already; where both set an attribute, this one counts",
                )
                .related(bindings.strings[first].text.whole(), "the other legend")
                .help("give the sample another colour, or combine both strings"),
            );
            let legend: &mut Legend = &mut bindings.legends[*legend];
            for (string, setting) in settings {
                legend
                    .settings
                    .retain(|(_, old)| old.keyword != setting.keyword);
                legend.settings.push((string, setting));
            }
            continue;
        }
        by_paint.insert(paint, bindings.legends.len());
        bindings.legends.push(Legend {
            paint: paint.clone(),
            settings: settings.collect(),
            swatch: part.shape,
            string,
            is_used: false,
        });
    }
    for part in &mut bindings.parts {
        let is_tile = part.kind == PartKind::Tile;
        if (is_tile || matches!(part.kind, PartKind::Main | PartKind::Sub))
            && let Some(index) = by_paint.get(&part.paint(drawing).key)
        {
            part.legend = Some(*index);
            let legend = &mut bindings.legends[*index];
            // What a legend says of tiles is of no use to parts.
            legend.is_used |= is_tile || legend.says(Keyword::Tile).is_none();
        }
    }
    let shapes = 0..drawing.shapes.len();
    let mut pictures = shapes.filter(|shape| bindings.is_picture_of_tiles(drawing, *shape));
    let has_maps = pictures.next().is_some();
    for legend in &bindings.legends {
        // Pictures are looked through where they are read.
        let may_be_used = has_maps && matches!(legend.paint, PaintKey::Solid(_));
        if !legend.is_used && !may_be_used {
            diagnostics.push(legend.unused(drawing, bindings));
        }
    }
}

impl Legend {
    /// What it says of an attribute, with the index of the string that does.
    pub fn says(&self, keyword: Keyword) -> Option<Source<'_>> {
        let mut settings = self.settings.iter();
        let (string, setting) = settings.find(|(_, setting)| setting.keyword == keyword)?;
        Some(Source {
            setting,
            from: SetBy::Legend,
            string: *string,
        })
    }

    /// Says that nothing has the legend's paint.
    pub fn unused(&self, drawing: &Drawing, bindings: &Bindings) -> Diagnostic {
        let swatch = &drawing.shapes[self.swatch].element;
        let (what, whence) = match self.says(Keyword::Tile) {
            Some(_) => ("tile", "tiles"),
            None => ("part", "parts"),
        };
        Diagnostic::new(
            Code::UnusedLegend,
            bindings.strings[self.string].text.whole(),
            format!(
                "no {what} has the paint of this legend, {}",
                swatch.describe()
            ),
        )
        .related(swatch.span, "the legend")
        .help(format!(
            "pick the sample's colour from the {whence} with the colour picker, or delete the legend"
        ))
    }
}
