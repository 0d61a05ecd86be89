//! Tile layers whose map is a file of Tiled.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;

use super::colors::{self, Named};
use super::content::Content;
use super::materials::{Paints, TileMaterial, TileTexture};
use super::{Layer, LayerObject, Reading, diagnostics, heights};
use crate::bind::Attribute;
use crate::diagnostic::{Code, Diagnostic};
use crate::memo::Memo;
use crate::resolver::Resolver;
use crate::source::Span;
use crate::svg::broken_link;
use crate::terrain::landscape::{DEFAULT_ROOF, Landscape};
use crate::terrain::map::{CellPictures, Map, Tile, UNSET};
use crate::terrain::tiled::{self, Idle, Pictured, TiledError, TiledMap};

/// The largest number of materials for walls; of a map with more colours each kind has one.
const MAX_MATERIALS: usize = 200;

/// The largest number of cells that show a picture each: every one is a square of its own in the model.
const MAX_PICTURED: usize = 1 << 20;

/// The key of a map file, by its link.
#[derive(PartialEq, Eq, Hash)]
struct MapFile(String);

/// The files of maps, through which they are read once for as long as they stay as they are.
#[derive(Clone, Copy)]
pub(super) struct Files<'a> {
    pub(super) resolver: &'a dyn Resolver,
    pub(super) memo: &'a Memo,
}

impl Files<'_> {
    fn map(self, link: &str) -> Arc<Result<TiledMap, TiledError>> {
        let read =
            |file: &MapFile, resolver: &dyn Resolver| Arc::new(tiled::read(&file.0, resolver));
        self.memo
            .get_reading(MapFile(link.to_owned()), self.resolver, read)
    }
}

impl Reading<'_> {
    /// Reads a layer whose string names a map. What is painted in the group says only where the map's top left corner is.
    ///
    /// # Errors
    /// Those of [`layer`](Self::layer).
    pub(super) fn tiled(
        &self,
        file: &Attribute<'_, &str>,
        content: &Content,
        found: &mut Vec<Diagnostic>,
    ) -> Result<Layer, Option<Box<Diagnostic>>> {
        let Self {
            drawing,
            bindings,
            index,
            ..
        } = *self;
        let link = file.value;
        let span = bindings.span_of(&file.source);
        let read = self.files.map(link);
        let map = match &*read {
            Ok(map) => map,
            Err(error) => return Err(Some(Box::new(refused(link, error, span)))),
        };
        found.extend(map.idle.iter().map(|idle| {
            let (what, help) = told(idle);
            let message = format!("the map `{link}` has {what}");
            Diagnostic::new(Code::NoSolidMeaning, span, message).help(help)
        }));
        let paints = Paints::new(bindings, index);
        let (mut materials, of_look) = materials(&paints, &map.pictured);
        let of_cell = |look: &u16| usize::from(*look).checked_sub(1);
        let cells: Vec<u8> = map
            .cells
            .iter()
            .map(|look| of_cell(look).map_or(0, |look| of_look[look]))
            .collect();
        if cells.iter().all(|material| *material == 0) {
            let message = format!("the map `{link}` has no tiles in its visible layers");
            return Err(Some(Box::new(
                Diagnostic::new(Code::NoTiles, span, message)
                    .help("draw tiles in a tile layer of the map, and save it"),
            )));
        }
        let of_layer = paints.height_of_layer().unwrap_or(UNSET);
        let height = |look: usize| match map.heights[look].height {
            UNSET => of_layer,
            height => height,
        };
        let mut heights: Vec<i8> = map
            .cells
            .iter()
            .map(|look| of_cell(look).map_or(UNSET, height))
            .collect();
        let is_loose = |cell: usize| {
            let is_of_tile = of_cell(&map.cells[cell]).map(|look| map.heights[look].is_of_tile);
            materials[usize::from(cells[cell])].tile == Tile::Blue && is_of_tile == Some(false)
        };
        let is_ground = |cell: usize| {
            let tile = materials[usize::from(cells[cell])].tile;
            !matches!(tile, Tile::None | Tile::Blue)
        };
        heights::sink(&mut heights, map.columns, is_loose, is_ground);
        heights::add_earth(&paints, &mut materials);
        let pictured = map.cells.iter().filter_map(of_cell);
        let pictured = pictured
            .filter(|look| map.pictured[*look].place != 0)
            .count();
        if pictured > MAX_PICTURED {
            let message = format!(
                "the map `{link}` has {pictured} tiles, more than the {MAX_PICTURED} that show their pictures, so they have one colour each"
            );
            found.push(
                Diagnostic::new(Code::PlainPaint, span, message)
                    .help("cut the map into smaller ones"),
            );
        }
        let atlas = map.atlas.as_ref();
        let pictures = atlas.filter(|_| pictured <= MAX_PICTURED).map(|atlas| {
            let mut tops = paints.material(Named::Tile(Tile::Green), None, [255.0; 3], 1.0);
            tops.texture = Some(TileTexture::Pictures(atlas.picture.clone()));
            materials.push(tops);
            let place = |look: usize| map.pictured[look].place;
            let places = map.cells.iter();
            CellPictures {
                material: materials.len() as u8 - 1,
                grid: atlas.grid,
                places: places.map(|look| of_cell(look).map_or(0, place)).collect(),
            }
        });
        let first = materials.len();
        for picture in &map.object_pictures {
            let mut own = paints.material(Named::Tile(Tile::Green), None, [255.0; 3], 1.0);
            own.texture = Some(TileTexture::Pictures(picture.picture.clone()));
            materials.push(own);
        }
        let size = map.size;
        let corner = content.bounds().map_or(DVec2::ZERO, |[low, _]| low);
        let objects = map.objects.iter().map(|object| LayerObject {
            name: object.name.clone(),
            foot: corner + object.foot,
            size: object.size,
            outline: Arc::clone(&map.object_pictures[object.picture].outline),
            material: (first + object.picture) as u8,
        });
        let objects = objects.collect();
        let of_layer = &bindings.layers[index];
        let attributes = bindings.layer_attributes(index);
        let map = Map {
            columns: map.columns,
            rows: map.rows,
            edges: vec![0; cells.len()],
            cells,
            tiles: materials.iter().map(|material| material.tile).collect(),
            heights,
            pictures,
        };
        let layer = Layer {
            index,
            name: of_layer.name.clone(),
            string: of_layer.string,
            group: of_layer.group,
            landscape: Landscape::new(&map),
            map,
            materials,
            origin: corner,
            size,
            roof: attributes.roof().unwrap_or(DEFAULT_ROOF),
            bevel: attributes.bevel(),
            parent: bindings.parent_of_layer(index),
            sources: vec![],
            objects,
        };
        diagnostics::open(drawing, &layer, found);
        Ok(layer)
    }
}

/// The materials of walls, and of tops without a picture, and that of each look: of one mean colour and kind there is one.
fn materials(paints: &Paints<'_>, looks: &[Pictured]) -> (Vec<TileMaterial>, Vec<u8>) {
    // A sixteenth of the range of a channel is not seen as another colour.
    let coarse = |color: [u8; 3]| color.map(|channel| channel >> 4);
    let kind = |look: &Pictured| match (look.kind, colors::named(look.color)) {
        (Some(kind), _) => kind,
        (None, Some(named)) => named.tile(),
        // Of no clear colour, its walls are like its top.
        (None, None) => Tile::Beige,
    };
    let seen = || looks.iter().filter(|look| look.place != 0);
    let keys = |by_color: bool| {
        let mut keys: BTreeMap<(Tile, [u8; 3]), ([u64; 3], u64)> = BTreeMap::new();
        for look in seen() {
            let of_color = if by_color { coarse(look.color) } else { [0; 3] };
            let (sum, count) = keys.entry((kind(look), of_color)).or_default();
            for (sum, channel) in sum.iter_mut().zip(look.color) {
                *sum += u64::from(channel);
            }
            *count += 1;
        }
        keys
    };
    let (mut by_color, mut keys_found) = (true, keys(true));
    if keys_found.len() > MAX_MATERIALS {
        (by_color, keys_found) = (false, keys(false));
    }
    let mut materials = vec![TileMaterial::none()];
    let mut numbers: BTreeMap<(Tile, [u8; 3]), u8> = BTreeMap::new();
    for (key, (sum, count)) in keys_found {
        numbers.insert(key, materials.len() as u8);
        let color = sum.map(|sum| sum as f64 / count as f64);
        materials.push(paints.material(Named::Tile(key.0), None, color, 1.0));
    }
    let of_look = looks.iter().map(|look| {
        let of_color = if by_color { coarse(look.color) } else { [0; 3] };
        let number = numbers.get(&(kind(look), of_color));
        number.copied().filter(|_| look.place != 0).unwrap_or(0)
    });
    let of_look = of_look.collect();
    (materials, of_look)
}

/// The diagnostic for a map that is not read.
fn refused(link: &str, error: &TiledError, span: Span) -> Diagnostic {
    let (code, help) = match error {
        TiledError::Link(to, wrong) => {
            let mut finding = broken_link(to, wrong, span);
            if to != link {
                finding.message = format!("the map `{link}` needs `{to}`, which {wrong}");
            }
            return finding;
        }
        TiledError::Broken(_) => (
            Code::BrokenTiles,
            "open the map in Tiled, and save it again",
        ),
        TiledError::Unknown(_) => (
            Code::BrokenTiles,
            "in Tiled, make an orthogonal map, and choose CSV or Base64 as the format of its layers",
        ),
        TiledError::Limit(_) | TiledError::Grid(..) => {
            (Code::LimitPassed, "cut the map into smaller ones")
        }
    };
    let message = format!("the map `{link}` {error}");
    Diagnostic::new(code, span, message).help(help)
}

/// What a map has that means nothing here, and the way out.
fn told(idle: &Idle) -> (String, String) {
    let (what, help) = match idle {
        Idle::Objects => (
            "objects without a tile (points, areas, texts), which are not built",
            "insert tiles as objects in Tiled, or hide the layer of the others",
        ),
        Idle::Turned => (
            "objects that are turned, which stand upright",
            "set their rotation to 0 in Tiled",
        ),
        Idle::Images => (
            "a layer that is an image, which is not built",
            "hide it in Tiled, or make a tile set of the image",
        ),
        Idle::Shifted => (
            "a layer with an offset or parallax, whose tiles are built in their cells",
            "set the offsets to 0 and the parallax factors to 1 in Tiled",
        ),
        Idle::Tinted => (
            "a layer with a tint, which is built in its own colours",
            "remove the tint in Tiled, or paint the tile set in those colours",
        ),
        Idle::Animated => (
            "animated tiles, of which the first picture is shown",
            "nothing needs to be done if that is right",
        ),
        Idle::OtherSize => (
            "tiles of another size than its own, of which only what lies in their cell is shown",
            "use a tile set whose tiles are as large as those of the map",
        ),
        Idle::NotSquare => (
            "tiles that are not square, which are built as squares of their width",
            "make a map of square tiles",
        ),
        Idle::Height(written) => {
            return (
                format!("the height `{written}`, which is not a whole number from -100 to 100"),
                "write a whole number of tiles as the value of the property `height`".to_owned(),
            );
        }
        Idle::Kind(written) => {
            return (
                format!("the kind of tile `{written}`, which is unknown"),
                "write green, brown, blue, red or beige as the value of the property `tile`"
                    .to_owned(),
            );
        }
    };
    (what.to_owned(), help.to_owned())
}
