//! The kinds and the materials of a layer's paints.

use rustc_hash::FxHashMap;

use super::colors::{self, Named};
use super::raster::{Code, paint_of, pixel_of};
use crate::bind::{Bindings, LayerId, MaterialFactors, SetBy, StringId};
use crate::source::Span;
use crate::svg::{PaintKey, ShapeId};
use crate::terrain::Tile;
use crate::texture::Picture;

/// The material of tiles of one kind and paint.
#[derive(Debug, Clone, PartialEq)]
pub struct TileMaterial {
    /// The kind of the tiles.
    pub tile: Tile,
    /// The factors of their material.
    pub factors: MaterialFactors,
    /// The image that is laid over each tile.
    pub texture: Option<TileTexture>,
    /// Whether a string sets the colour, which tints the texture.
    pub is_tinted: bool,
    /// Index of the legend of their paint.
    pub legend: Option<usize>,
    /// Whether they are ground because their colour is that of sand.
    pub is_sand: bool,
}

/// An image on tiles.
#[derive(Debug, Clone, PartialEq)]
pub enum TileTexture {
    /// The file that `Texture` names.
    File {
        /// The link to the image.
        link: String,
        /// The string that sets it.
        string: StringId,
        /// The place of the setting.
        span: Span,
    },
    /// The pictures of all tiles of a map, side by side.
    Pictures(Picture),
}

impl TileMaterial {
    /// The material of empty cells.
    pub(super) fn none() -> Self {
        Self {
            tile: Tile::None,
            factors: MaterialFactors {
                color: [0.0; 4],
                metallic: 0.0,
                roughness: 0.0,
                emissive: [0.0; 3],
            },
            texture: None,
            is_tinted: false,
            legend: None,
            is_sand: false,
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
    /// Index of the back-most shape that has it.
    pub(super) shape: ShapeId,
}

/// The meaning of a code.
#[derive(Clone, Copy)]
pub(super) struct Meaning {
    /// `None` if it is not clear.
    pub(super) named: Option<Named>,
    pub(super) legend: Option<usize>,
    pub(super) color: [u8; 3],
    pub(super) opacity: f64,
}

/// All paints of a layer's shapes, and the legends about them.
pub(super) struct Paints<'a> {
    bindings: &'a Bindings,
    layer: LayerId,
    pub(super) list: Vec<Painted<'a>>,
    known: FxHashMap<(&'a PaintKey, u64), usize>,
    legends: FxHashMap<&'a PaintKey, usize>,
}

impl<'a> Paints<'a> {
    pub(super) fn new(bindings: &'a Bindings, layer: LayerId) -> Self {
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

    /// What tiles of a paint are, if that is clear, and the index of their legend; `color` is the paint's mean.
    pub(super) fn named(&self, key: &PaintKey, color: [u8; 3]) -> (Option<Named>, Option<usize>) {
        let legend = self.legends.get(key).copied();
        let attributes = self.bindings.tile_attributes(self.layer, legend);
        let named = match attributes.tile() {
            Some(word) => Some(Named::Tile(tile(word))),
            None => colors::named(color),
        };
        (named, legend)
    }

    /// The height that the layer's own string gives its tiles, or a `%` string those of all layers.
    pub(super) fn height_of_layer(&self) -> Option<i8> {
        let height = self.bindings.layer_attributes(self.layer).height();
        height.map(|height| height.value)
    }

    /// The height that a legend gives the tiles of its paint.
    pub(super) fn height_of_legend(&self, legend: Option<usize>) -> Option<i8> {
        let height = self.bindings.tile_attributes(self.layer, legend).height();
        let height = height.filter(|height| height.source.from == SetBy::Legend);
        height.map(|height| height.value)
    }

    /// The meaning of a code other than [`NOTHING`](super::raster::NOTHING).
    pub(super) fn meaning(&self, code: Code) -> Meaning {
        let (color, opacity) = self.appearance(code);
        let (named, legend) = match paint_of(code) {
            Some(paint) => self.named(self.list[paint].key, color),
            None => self.named(&PaintKey::Solid(color), color),
        };
        Meaning {
            named,
            legend,
            color,
            opacity,
        }
    }

    /// The material of tiles that are drawn in `color`, sRGB from 0 to 255.
    pub(super) fn material(
        &self,
        named: Named,
        legend: Option<usize>,
        color: [f64; 3],
        opacity: f64,
    ) -> TileMaterial {
        let attributes = self.bindings.tile_attributes(self.layer, legend);
        let set_color = attributes.color();
        let [r, g, b] = color.map(|channel| channel / 255.0);
        let texture = attributes.texture();
        TileMaterial {
            tile: named.tile(),
            is_sand: named == Named::Sand,
            factors: attributes.material_factors([r, g, b, opacity], set_color),
            texture: texture.map(|texture| TileTexture::File {
                link: texture.value.to_owned(),
                string: texture.source.string,
                span: self.bindings.span_of(&texture.source),
            }),
            is_tinted: set_color.is_some(),
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
