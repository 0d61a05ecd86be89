//! Reads the JSON of Tiled: `.tmj` and `.tsj`, or `.json`.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::TiledError;
use super::document::{
    Chunk, Content, Data, Encoding, ImageLink, LayerEntry, MapFile, ObjectEntry, Properties,
    SetFile, SetLink, SetSource, TileEntry, color,
};
use super::xml::MAX_DEPTH;

/// The largest number of objects of a file.
const MAX_OBJECTS: usize = 1 << 18;

/// Reads a map.
pub(super) fn map(text: &str) -> Result<MapFile, TiledError> {
    let map: Map = parsed(text)?;
    let sets = map.tilesets.into_iter().map(|mut set| SetLink {
        first: set.firstgid,
        source: match set.source.take() {
            Some(source) => SetSource::File(source),
            None => SetSource::Embedded(Box::new(set.into())),
        },
    });
    Ok(MapFile {
        sets: sets.collect(),
        layers: layers(map.layers, MAX_DEPTH)?,
        orientation: map.orientation.unwrap_or_else(|| "orthogonal".to_owned()),
        size: [map.width, map.height],
        tile: [map.tilewidth, map.tileheight],
        properties: map.properties.0,
    })
}

/// Reads a tile set.
pub(super) fn set(text: &str) -> Result<SetFile, TiledError> {
    let set: Set = parsed(text)?;
    Ok(set.into())
}

fn parsed<'a, T: Deserialize<'a>>(text: &'a str) -> Result<T, TiledError> {
    // Each may take a hundred times as much memory as it is long.
    if text.bytes().filter(|byte| *byte == b'{').count() > MAX_OBJECTS {
        let message = format!("it has more than {MAX_OBJECTS} objects");
        return Err(TiledError::Limit(message));
    }
    serde_json::from_str(text).map_err(|error| TiledError::Broken(error.to_string()))
}

#[derive(Deserialize)]
struct Map {
    orientation: Option<String>,
    #[serde(default)]
    width: i64,
    #[serde(default)]
    height: i64,
    tilewidth: i64,
    tileheight: i64,
    #[serde(default)]
    properties: Named,
    #[serde(default)]
    tilesets: Vec<Set>,
    layers: Vec<Layer>,
}

/// A tile set, or a link to the file of one.
#[derive(Deserialize, Default)]
#[serde(default)]
struct Set {
    firstgid: u32,
    source: Option<String>,
    name: String,
    tilewidth: i64,
    tileheight: i64,
    spacing: i64,
    margin: i64,
    columns: i64,
    tilecount: i64,
    image: Option<String>,
    transparentcolor: Option<String>,
    tiles: Vec<Tile>,
}

#[derive(Deserialize)]
struct Tile {
    id: i64,
    #[serde(default, alias = "class")]
    r#type: String,
    #[serde(default)]
    properties: Named,
    image: Option<String>,
    #[serde(default)]
    x: i64,
    #[serde(default)]
    y: i64,
    #[serde(default)]
    width: i64,
    #[serde(default)]
    height: i64,
    animation: Option<IgnoredAny>,
}

#[derive(Deserialize)]
struct Layer {
    r#type: String,
    #[serde(default)]
    width: i64,
    #[serde(default)]
    height: i64,
    visible: Option<bool>,
    opacity: Option<f64>,
    #[serde(default)]
    offsetx: f64,
    #[serde(default)]
    offsety: f64,
    parallaxx: Option<f64>,
    parallaxy: Option<f64>,
    tintcolor: Option<String>,
    #[serde(default)]
    properties: Named,
    encoding: Option<String>,
    #[serde(default)]
    compression: String,
    data: Option<Numbers>,
    #[serde(default)]
    chunks: Vec<Part>,
    #[serde(default)]
    objects: Vec<Object>,
    #[serde(default)]
    layers: Vec<Layer>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Object {
    name: String,
    gid: u32,
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    rotation: f64,
    visible: Option<bool>,
}

impl From<Object> for ObjectEntry {
    fn from(object: Object) -> Self {
        Self {
            name: object.name,
            number: object.gid,
            at: [object.x, object.y],
            size: [object.width, object.height],
            is_turned: object.rotation != 0.0,
            is_visible: object.visible.unwrap_or(true),
        }
    }
}

#[derive(Deserialize)]
struct Part {
    x: i64,
    y: i64,
    width: i64,
    height: i64,
    data: Numbers,
}

/// Numbers of tiles: a list, or a text.
enum Numbers {
    List(Vec<u32>),
    Text(String),
}

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Numbers;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a list of numbers of tiles, or a text")
            }

            fn visit_str<E>(self, text: &str) -> Result<Numbers, E> {
                Ok(Numbers::Text(text.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Numbers, A::Error> {
                let mut numbers = vec![];
                while let Some(number) = list.next_element()? {
                    numbers.push(number);
                }
                Ok(Numbers::List(numbers))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// Properties, of which only those that mean something are kept.
#[derive(Default)]
struct Named(Properties);

impl<'de> Deserialize<'de> for Named {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        struct Property {
            name: String,
            value: Scalar,
        }
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Named;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a list of properties")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Named, A::Error> {
                let mut found = Properties::default();
                while let Some(Property { name, value }) = list.next_element()? {
                    if let Some(value) = value.0 {
                        found.set(&name, value);
                    }
                }
                Ok(Named(found))
            }
        }
        deserializer.deserialize_seq(Reader)
    }
}

/// A value as text; `None` for lists and objects, which mean nothing here.
struct Scalar(Option<String>);

impl<'de> Deserialize<'de> for Scalar {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Scalar;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a value")
            }

            fn visit_bool<E>(self, value: bool) -> Result<Scalar, E> {
                Ok(Scalar(Some(value.to_string())))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Scalar, E> {
                Ok(Scalar(Some(value.to_string())))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Scalar, E> {
                Ok(Scalar(Some(value.to_string())))
            }

            fn visit_f64<E>(self, value: f64) -> Result<Scalar, E> {
                Ok(Scalar(Some(value.to_string())))
            }

            fn visit_str<E>(self, value: &str) -> Result<Scalar, E> {
                Ok(Scalar(Some(value.trim().to_owned())))
            }

            fn visit_unit<E>(self) -> Result<Scalar, E> {
                Ok(Scalar(None))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Scalar, A::Error> {
                while list.next_element::<IgnoredAny>()?.is_some() {}
                Ok(Scalar(None))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Scalar, A::Error> {
                while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
                Ok(Scalar(None))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl From<Set> for SetFile {
    fn from(set: Set) -> Self {
        let clear = set.transparentcolor.as_deref().and_then(color);
        let image = |source: String, clear| ImageLink { source, clear };
        let tiles = set.tiles.into_iter().map(|tile| TileEntry {
            id: tile.id,
            class: tile.r#type,
            properties: tile.properties.0,
            image: tile.image.map(|source| image(source, None)),
            area: [tile.x, tile.y, tile.width, tile.height],
            is_animated: tile.animation.is_some(),
        });
        Self {
            tiles: tiles.collect(),
            name: set.name,
            tile: [set.tilewidth, set.tileheight],
            spacing: set.spacing,
            margin: set.margin,
            columns: set.columns,
            count: set.tilecount,
            image: set.image.map(|source| image(source, clear)),
        }
    }
}

fn layers(list: Vec<Layer>, depth: usize) -> Result<Vec<LayerEntry>, TiledError> {
    let mut found = Vec::with_capacity(list.len());
    for layer in list {
        let content = match layer.r#type.as_str() {
            "tilelayer" => {
                let data = |numbers: Numbers| match numbers {
                    Numbers::List(numbers) => Ok(Data::Numbers(numbers)),
                    Numbers::Text(text) => {
                        let encoding = layer.encoding.as_deref().unwrap_or("base64");
                        Ok(Data::Text(
                            Encoding::named(encoding, &layer.compression)?,
                            text,
                        ))
                    }
                };
                let mut chunks = vec![];
                for part in layer.chunks {
                    chunks.push(Chunk {
                        at: [part.x, part.y],
                        size: [part.width, part.height],
                        data: data(part.data)?,
                    });
                }
                if let Some(numbers) = layer.data {
                    chunks.push(Chunk {
                        at: [0; 2],
                        size: [layer.width, layer.height],
                        data: data(numbers)?,
                    });
                }
                Content::Tiles(chunks)
            }
            "objectgroup" => {
                Content::Objects(layer.objects.into_iter().map(ObjectEntry::from).collect())
            }
            "imagelayer" => Content::Image,
            "group" if depth == 0 => return Err(TiledError::too_deep()),
            "group" => Content::Group(layers(layer.layers, depth - 1)?),
            _ => continue,
        };
        let differs = |factor: Option<f64>| factor.is_some_and(|factor| factor != 1.0);
        found.push(LayerEntry {
            is_visible: layer.visible.unwrap_or(true),
            opacity: layer.opacity.unwrap_or(1.0),
            is_shifted: layer.offsetx != 0.0
                || layer.offsety != 0.0
                || differs(layer.parallaxx)
                || differs(layer.parallaxy),
            is_tinted: layer.tintcolor.is_some(),
            properties: layer.properties.0,
            content,
        });
    }
    Ok(found)
}
