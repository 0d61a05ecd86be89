//! What the paints of a layer mean and how they look in the model (terrain.md, Input; figure.md, Attributes of a part).

use rustc_hash::FxHashMap;

use super::colours;
use super::raster::{Code, paint_of, pixel_of};
use crate::bind::{Bindings, Look};
use crate::lang::keyword::Keyword;
use crate::lang::value::{Setting, Value};
use crate::svg::PaintKey;
use crate::terrain::Tile;

/// How tiles of one kind and paint look.
#[derive(Debug, Clone, PartialEq)]
pub struct LookOf {
    /// What they stand for.
    pub tile: Tile,
    /// Colour and what else their material has.
    pub look: Look,
    /// What is laid over each tile: the setting that says so, with the index of its string.
    pub texture: Option<(usize, Setting)>,
    /// Whether the material's colour is what a string says, by which a texture is tinted.
    pub is_tinted: bool,
    /// Index of the legend of their paint.
    pub legend: Option<usize>,
}

impl LookOf {
    /// The look of cells in which nothing is.
    pub(super) fn none() -> Self {
        Self {
            tile: Tile::None,
            look: Look {
                color: [0.0; 4],
                metallic: 0.0,
                roughness: 0.0,
                emissive: [0.0; 3],
            },
            texture: None,
            is_tinted: false,
            legend: None,
        }
    }
}

/// A paint of a layer's shapes.
pub(super) struct Painted<'a> {
    pub(super) key: &'a PaintKey,
    /// sRGB.
    pub(super) color: [u8; 3],
    /// 0 to 1.
    pub(super) opacity: f64,
    /// Index of the hindmost shape that has it.
    pub(super) shape: usize,
}

/// What a code means.
#[derive(Clone, Copy)]
pub(super) struct Meaning {
    /// `None`: it is not clear.
    pub(super) tile: Option<Tile>,
    pub(super) legend: Option<usize>,
    pub(super) color: [u8; 3],
    pub(super) opacity: f64,
}

/// All paints of a layer's shapes, and who says what of them.
pub(super) struct Paints<'a> {
    bindings: &'a Bindings,
    /// Index of the layer.
    layer: usize,
    pub(super) list: Vec<Painted<'a>>,
    known: FxHashMap<(&'a PaintKey, u64), usize>,
    legends: FxHashMap<&'a PaintKey, usize>,
}

impl<'a> Paints<'a> {
    pub(super) fn new(bindings: &'a Bindings, layer: usize) -> Self {
        let legends = bindings.legends.iter().enumerate();
        Self {
            bindings,
            layer,
            list: Vec::new(),
            known: FxHashMap::default(),
            legends: legends
                .map(|(index, legend)| (&legend.paint, index))
                .collect(),
        }
    }

    /// The index of a paint.
    pub(super) fn index(&mut self, paint: Painted<'a>) -> usize {
        let list = &mut self.list;
        let known = self.known.entry((paint.key, paint.opacity.to_bits()));
        *known.or_insert_with(|| {
            list.push(paint);
            list.len() - 1
        })
    }

    /// The colour and opacity with which a code is drawn.
    pub(super) fn appearance(&self, code: Code) -> ([u8; 3], f64) {
        match paint_of(code) {
            Some(paint) => (self.list[paint].color, self.list[paint].opacity),
            None => pixel_of(code).unwrap_or_default(),
        }
    }

    /// What a code means that is not that of nothing.
    pub(super) fn meaning(&self, code: Code) -> Meaning {
        let (color, opacity) = self.appearance(code);
        let legend = match paint_of(code) {
            Some(paint) => self.legends.get(self.list[paint].key),
            None => self.legends.get(&PaintKey::Solid(color)),
        };
        let legend = legend.copied();
        let said = legend.and_then(|legend| self.bindings.legends[legend].says(Keyword::Tile));
        let tile = match said.map(|said| &said.setting.value) {
            Some(Value::Word(word)) => Some(tile(word)),
            _ => colours::kind(color),
        };
        Meaning {
            tile,
            legend,
            color,
            opacity,
        }
    }

    /// How tiles look; `color` is that with which they are drawn, sRGB, each 0 to 255.
    pub(super) fn look(
        &self,
        tile: Tile,
        legend: Option<usize>,
        color: [f64; 3],
        opacity: f64,
    ) -> LookOf {
        let own = &self.bindings.strings[self.bindings.layers[self.layer].string];
        let says = |keyword: Keyword| -> Option<(usize, &'a Setting)> {
            let by_legend = legend.and_then(|legend| self.bindings.legends[legend].says(keyword));
            let by_legend = by_legend.map(|source| (source.string, source.setting));
            let string = self.bindings.layers[self.layer].string;
            let mut of_layer = own.settings.iter().map(|setting| (string, setting));
            let of_all = self.bindings.defaults.iter();
            let mut of_all = of_all.map(|(string, setting)| (*string, setting));
            by_legend
                .or_else(|| of_layer.find(|(_, setting)| setting.keyword == keyword))
                .or_else(|| of_all.find(|(_, setting)| setting.keyword == keyword))
        };
        let number = |keyword: Keyword| match says(keyword)?.1.value {
            Value::Number(number) => Some(number),
            _ => None,
        };
        let said = says(Keyword::Color).map(|(_, setting)| &setting.value);
        let (color, opacity, is_tinted) = match said {
            Some(Value::Color { rgb, alpha }) => (*rgb, alpha.unwrap_or(opacity), true),
            _ => (color.map(|channel| channel / 255.0), opacity, false),
        };
        let [r, g, b] = color;
        let emissive = says(Keyword::Emissive).map(|(_, setting)| &setting.value);
        LookOf {
            tile,
            look: Look {
                color: [r, g, b, number(Keyword::Alpha).unwrap_or(opacity)],
                metallic: number(Keyword::Metallic).unwrap_or(0.0),
                roughness: number(Keyword::Roughness).unwrap_or(0.9),
                emissive: match emissive {
                    Some(Value::Rgb(rgb)) => *rgb,
                    _ => [0.0; 3],
                },
            },
            texture: says(Keyword::Texture).map(|(string, setting)| (string, setting.clone())),
            is_tinted,
            legend,
        }
    }
}

/// The kind of tile that a word of the language names.
fn tile(word: &str) -> Tile {
    let named = Tile::DRAWN
        .iter()
        .find(|tile| tile.name().eq_ignore_ascii_case(word));
    named.copied().unwrap_or(Tile::None)
}
