//! Reads the XML of Tiled: `.tmx` and `.tsx`.

use std::str::FromStr;

use roxmltree::{Document, Node, ParsingOptions};
use xmlparser::{Token, Tokenizer};

use super::TiledError;
use super::document::{
    Chunk, Content, Data, Encoding, ImageLink, LayerEntry, MapFile, ObjectEntry, Properties,
    SetFile, SetLink, SetSource, TileEntry, color,
};

/// The largest number of elements and texts of a file.
const MAX_NODES: u32 = 1 << 20;
/// The largest number of attributes of an element.
const MAX_ATTRIBUTES: usize = 64;
/// The largest number of groups of layers in each other.
pub(super) const MAX_DEPTH: usize = 32;

/// Reads a map.
pub(super) fn map(text: &str) -> Result<MapFile, TiledError> {
    let document = parsed(text)?;
    let root = named(&document, "map")?;
    let mut map = MapFile {
        orientation: root
            .attribute("orientation")
            .unwrap_or("orthogonal")
            .to_owned(),
        size: [number(root, "width")?, number(root, "height")?],
        tile: [number(root, "tilewidth")?, number(root, "tileheight")?],
        properties: properties(root),
        sets: vec![],
        layers: vec![],
    };
    for child in elements(root).filter(|child| child.has_tag_name("tileset")) {
        let source = match child.attribute("source") {
            Some(source) => SetSource::File(source.to_owned()),
            None => SetSource::Embedded(Box::new(read_set(child)?)),
        };
        map.sets.push(SetLink {
            first: number(child, "firstgid")?,
            source,
        });
    }
    map.layers = layers(root, MAX_DEPTH)?;
    Ok(map)
}

/// Reads a tile set.
pub(super) fn set(text: &str) -> Result<SetFile, TiledError> {
    read_set(named(&parsed(text)?, "tileset")?)
}

fn parsed(text: &str) -> Result<Document<'_>, TiledError> {
    check(text)?;
    let options = ParsingOptions {
        // Older versions of Tiled name a document type; entities were refused above.
        allow_dtd: true,
        nodes_limit: MAX_NODES,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options).map_err(|error| match error {
        roxmltree::Error::NodesLimitReached => {
            TiledError::Limit(format!("it has more than {MAX_NODES} elements"))
        }
        error => TiledError::Broken(error.to_string()),
    })
}

/// Checks the number of attributes of each element, which the parser compares with each other, and that there are no entities, which could
/// make a long text of a short one.
fn check(text: &str) -> Result<(), TiledError> {
    let mut count = 0;
    for token in Tokenizer::from(text) {
        match token {
            Ok(Token::ElementStart { .. }) => count = 0,
            Ok(Token::Attribute { .. }) => count += 1,
            Ok(Token::EntityDeclaration { .. }) => {
                let message = "it has entities of its own (`<!ENTITY`)".to_owned();
                return Err(TiledError::Broken(message));
            }
            Ok(_) => {}
            // The parser says better what is wrong.
            Err(_) => break,
        }
        if count > MAX_ATTRIBUTES {
            let message = format!("an element of it has more than {MAX_ATTRIBUTES} attributes");
            return Err(TiledError::Limit(message));
        }
    }
    Ok(())
}

fn named<'a, 'b>(document: &'a Document<'b>, name: &str) -> Result<Node<'a, 'b>, TiledError> {
    let root = document.root_element();
    let is_named = root.has_tag_name(name);
    is_named
        .then_some(root)
        .ok_or_else(|| TiledError::Broken(format!("its outermost element is not a `<{name}>`")))
}

fn elements<'a, 'b>(node: Node<'a, 'b>) -> impl Iterator<Item = Node<'a, 'b>> {
    node.children().filter(Node::is_element)
}

/// The number in an attribute; 0 if there is none.
fn number<T: FromStr + Default>(node: Node<'_, '_>, name: &str) -> Result<T, TiledError> {
    let Some(written) = node.attribute(name) else {
        return Ok(T::default());
    };
    written
        .trim()
        .parse()
        .map_err(|_| TiledError::number(name, written))
}

fn properties(node: Node<'_, '_>) -> Properties {
    let mut found = Properties::default();
    let lists = elements(node).filter(|child| child.has_tag_name("properties"));
    for property in lists.flat_map(elements) {
        // A text of several lines is the content of the element.
        let value = property.attribute("value").or(property.text());
        if let (Some(name), Some(value)) = (property.attribute("name"), value) {
            found.set(name, value.trim().to_owned());
        }
    }
    found
}

fn image(node: Node<'_, '_>) -> Option<ImageLink> {
    let image = elements(node).find(|child| child.has_tag_name("image"))?;
    Some(ImageLink {
        source: image.attribute("source").unwrap_or_default().to_owned(),
        clear: image.attribute("trans").and_then(color),
    })
}

fn read_set(node: Node<'_, '_>) -> Result<SetFile, TiledError> {
    let tiles = elements(node).filter(|child| child.has_tag_name("tile"));
    let tiles = tiles.map(|tile| {
        let class = tile.attribute("class").or(tile.attribute("type"));
        Ok(TileEntry {
            id: number(tile, "id")?,
            class: class.unwrap_or_default().to_owned(),
            properties: properties(tile),
            image: image(tile),
            area: [
                number(tile, "x")?,
                number(tile, "y")?,
                number(tile, "width")?,
                number(tile, "height")?,
            ],
            is_animated: elements(tile).any(|child| child.has_tag_name("animation")),
        })
    });
    Ok(SetFile {
        name: node.attribute("name").unwrap_or_default().to_owned(),
        tile: [number(node, "tilewidth")?, number(node, "tileheight")?],
        spacing: number(node, "spacing")?,
        margin: number(node, "margin")?,
        columns: number(node, "columns")?,
        count: number(node, "tilecount")?,
        image: image(node),
        tiles: tiles.collect::<Result<_, TiledError>>()?,
    })
}

/// The layers in an element, as far as they may be nested.
fn layers(node: Node<'_, '_>, depth: usize) -> Result<Vec<LayerEntry>, TiledError> {
    let mut found = vec![];
    for child in elements(node) {
        let content = match child.tag_name().name() {
            "layer" => Content::Tiles(chunks(child)?),
            "objectgroup" => {
                let objects = elements(child).filter(|child| child.has_tag_name("object"));
                Content::Objects(objects.map(object).collect::<Result<_, TiledError>>()?)
            }
            "imagelayer" => Content::Image,
            "group" if depth == 0 => return Err(TiledError::too_deep()),
            "group" => Content::Group(layers(child, depth - 1)?),
            _ => continue,
        };
        let opacity: Option<f64> = child
            .attribute("opacity")
            .and_then(|text| text.parse().ok());
        let differs = |name: &str, usual: f64| {
            let number: Option<f64> = child.attribute(name).and_then(|text| text.parse().ok());
            number.is_some_and(|number| number != usual)
        };
        found.push(LayerEntry {
            is_visible: child.attribute("visible") != Some("0"),
            opacity: opacity.unwrap_or(1.0),
            is_shifted: differs("offsetx", 0.0)
                || differs("offsety", 0.0)
                || differs("parallaxx", 1.0)
                || differs("parallaxy", 1.0),
            is_tinted: child.has_attribute("tintcolor"),
            properties: properties(child),
            content,
        });
    }
    Ok(found)
}

fn object(node: Node<'_, '_>) -> Result<ObjectEntry, TiledError> {
    let turn: f64 = number(node, "rotation")?;
    Ok(ObjectEntry {
        name: node.attribute("name").unwrap_or_default().to_owned(),
        number: number(node, "gid")?,
        at: [number(node, "x")?, number(node, "y")?],
        size: [number(node, "width")?, number(node, "height")?],
        is_turned: turn != 0.0,
        is_visible: node.attribute("visible") != Some("0"),
    })
}

fn chunks(layer: Node<'_, '_>) -> Result<Vec<Chunk>, TiledError> {
    let Some(data) = elements(layer).find(|child| child.has_tag_name("data")) else {
        return Ok(vec![]);
    };
    let encoding = match data.attribute("encoding") {
        None => None,
        Some(encoding) => Some(Encoding::named(
            encoding,
            data.attribute("compression").unwrap_or_default(),
        )?),
    };
    let content = |node: Node<'_, '_>| match encoding {
        Some(encoding) => {
            // A comment in it would split the text.
            let texts = node.children().filter_map(|child| child.text());
            Ok(Data::Text(encoding, texts.collect()))
        }
        None => {
            let tiles = elements(node).filter(|child| child.has_tag_name("tile"));
            let numbers = tiles.map(|tile| number(tile, "gid"));
            Ok(Data::Numbers(numbers.collect::<Result<_, TiledError>>()?))
        }
    };
    let mut chunks = vec![];
    for chunk in elements(data).filter(|child| child.has_tag_name("chunk")) {
        chunks.push(Chunk {
            at: [number(chunk, "x")?, number(chunk, "y")?],
            size: [number(chunk, "width")?, number(chunk, "height")?],
            data: content(chunk)?,
        });
    }
    if chunks.is_empty() {
        chunks.push(Chunk {
            at: [0; 2],
            size: [number(layer, "width")?, number(layer, "height")?],
            data: content(data)?,
        });
    }
    Ok(chunks)
}
