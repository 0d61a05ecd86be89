//! Where things are on the page of a drawing: what a click on its picture means.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::sync::Arc;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::DVec2;
use imagesize::ImageType;
use serde::Serialize;
use typed_index_collections::TiVec;

use crate::bind::{PartId, StringHolder};
use crate::compile::Compiled;
use crate::geometry::Outline;
use crate::ide::{Subject, Which};
use crate::math;
use crate::svg::{LinkedPicture, ShapeId};

/// To how many parts of the page's larger side places on it are rounded: less than a pixel on any screen.
const STEPS: f64 = 20_000.0;

/// The page of a drawing. It shares the outlines of the compiled drawing, so that it costs little until somebody looks at it.
#[derive(Debug)]
pub(crate) struct Paper {
    text: Arc<str>,
    page: (DVec2, DVec2),
    /// The visible shapes with the name of what each is part of, in paint order.
    shapes: Vec<(String, Arc<Outline>)>,
    /// The strings that are written on the page, each with the name of what it is bound to, and the corners of its box.
    strings: Vec<(String, [DVec2; 2])>,
    /// The pictures that it links to.
    pictures: Vec<LinkedPicture>,
}

/// A [`Paper`] as the page reads it. Lengths are user units, y down.
#[derive(Serialize)]
struct Described<'a> {
    /// Left, top, width and height of the page.
    page: [f64; 4],
    /// The drawing's text, with the pictures in it that it links to. Whoever shows it takes care that nothing in it is executed or fetched.
    picture: Cow<'a, str>,
    /// The links of pictures that are too large to be in it.
    left_out: Vec<&'a str>,
    /// Per shape the name of its part, and its area as path data, to be filled by the even-odd rule.
    shapes: Vec<(&'a str, String)>,
    /// Per string the name of its part, and left, top, right and bottom of its estimated box.
    strings: Vec<(&'a str, [f64; 4])>,
}

impl Paper {
    /// The page of a drawing that was compiled from `text`; `None` if that cannot be read. An empty page is one, too: it can be drawn on.
    pub(crate) fn new(compiled: &Compiled, text: &Arc<str>) -> Option<Self> {
        let Compiled {
            bindings, drawing, ..
        } = compiled;
        let mut shapes: Vec<(ShapeId, String, Arc<Outline>)> = vec![];
        let mut names: TiVec<PartId, Option<&str>> = bindings.parts.iter().map(|_| None).collect();
        for subject in Subject::all(compiled) {
            let outline_of = |shape: ShapeId| drawing.shapes[shape].outline.clone();
            let mut add = |shape, outline| shapes.push((shape, subject.name().to_owned(), outline));
            match subject.which {
                Which::Part(part) => {
                    names[part] = Some(subject.name());
                    let part = &bindings.parts[part];
                    add(part.shape, part.outline.clone());
                }
                Which::Landscape(layer) => {
                    for tiles in &compiled.layers[layer].sources {
                        add(tiles.shape, outline_of(tiles.shape));
                    }
                }
                Which::Character(_) => {}
                Which::Region(character, region) => {
                    let region = &compiled.characters[character].regions[region];
                    for shape in region.shapes.iter().copied().flatten() {
                        add(shape, outline_of(shape));
                    }
                }
            }
        }
        // A shape that is drawn later hides the ones before it.
        shapes.sort_by_key(|(shape, ..)| *shape);
        let shapes = shapes.into_iter().map(|(_, name, outline)| (name, outline));
        let strings = bindings.strings.iter().filter_map(|string| {
            let StringHolder::Label(label) = string.holder else {
                return None;
            };
            let name = names[string.binding?.part]?;
            let (low, high) = drawing.labels[label].0.position.bounds;
            Some((name.to_owned(), [low, high]))
        });
        let paper = Self {
            text: text.clone(),
            page: drawing.page,
            shapes: shapes.collect(),
            strings: strings.collect(),
            pictures: drawing.pictures.clone(),
        };
        (paper.page.1.min_element() > 0.0).then_some(paper)
    }

    /// As JSON.
    pub(crate) fn json(&self) -> Vec<u8> {
        let (corner, size) = self.page;
        let step = size.max_element() / STEPS;
        // As many digits as tell two steps apart.
        let digits = (-math::log10(step)).ceil().clamp(0.0, 9.0) as usize;
        let rounded = |length: f64| (length / step).round() * step;
        let described = Described {
            page: [corner.x, corner.y, size.x, size.y],
            picture: with_pictures(&self.text, &self.pictures),
            left_out: self
                .pictures
                .iter()
                .filter(|picture| picture.bytes.is_none())
                .map(|picture| picture.link.as_str())
                .collect(),
            shapes: self
                .shapes
                .iter()
                .map(|(name, outline)| (name.as_str(), path_data(outline, digits)))
                .collect(),
            strings: self
                .strings
                .iter()
                .map(|(name, [low, high])| {
                    (name.as_str(), [low.x, low.y, high.x, high.y].map(rounded))
                })
                .collect(),
        };
        serde_json::to_vec(&described).unwrap_or_default()
    }
}

/// A drawing's text in which its linked pictures are embedded, as far as their bytes are there: a browser fetches nothing for a drawing that
/// it shows as a picture.
fn with_pictures<'a>(text: &'a str, pictures: &[LinkedPicture]) -> Cow<'a, str> {
    if pictures.iter().all(|picture| picture.bytes.is_none()) {
        return text.into();
    }
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..Default::default()
    };
    let Ok(document) = roxmltree::Document::parse_with_options(text, options) else {
        return text.into();
    };
    let images = document.descendants();
    let images = images.filter(|node| node.tag_name().name() == "image");
    let links = images.flat_map(|node| {
        let attributes = node.attributes();
        attributes.filter(|attribute| attribute.name() == "href")
    });
    let mut new = String::new();
    let mut end = 0;
    for link in links {
        let picture = pictures.iter().find(|one| one.link == link.value());
        if let Some(bytes) = picture.and_then(|picture| picture.bytes.as_deref()) {
            let place = link.range_value();
            new += text.get(end..place.start).unwrap_or_default();
            new += "data:";
            new += media_type(bytes);
            new += ";base64,";
            STANDARD.encode_string(bytes, &mut new);
            end = place.end;
        }
    }
    new += text.get(end..).unwrap_or_default();
    new.into()
}

/// What a picture is, by its first bytes, as usvg tells it.
fn media_type(bytes: &[u8]) -> &'static str {
    match imagesize::image_type(bytes) {
        Ok(ImageType::Png) => "image/png",
        Ok(ImageType::Jpeg) => "image/jpeg",
        Ok(ImageType::Gif) => "image/gif",
        Ok(ImageType::Webp) => "image/webp",
        _ => "image/svg+xml",
    }
}

/// The rings of an outline as the path data of SVG.
fn path_data(outline: &Outline, digits: usize) -> String {
    let mut data = String::new();
    for ring in outline.rings() {
        for (index, point) in ring.iter().enumerate() {
            let command = if index == 0 { 'M' } else { ' ' };
            // Writing to a string cannot fail.
            let _ = write!(data, "{command}{:.digits$} {:.digits$}", point.x, point.y);
        }
        data.push('Z');
    }
    data
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;
    use std::sync::Arc;

    use image::{ImageFormat, RgbImage};
    use serde_json::Value;

    use super::Paper;
    use crate::compile::{Options, compile};
    use crate::resolver::MemoryResolver;
    use crate::svg::MAX_KEPT;

    /// A PNG picture of one black pixel.
    fn pixel() -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        RgbImage::new(1, 1)
            .write_to(&mut bytes, ImageFormat::Png)
            .expect("it fits");
        bytes.into_inner()
    }

    fn described(text: &str, files: &[(&str, Vec<u8>)]) -> Value {
        let resolver = files
            .iter()
            .fold(MemoryResolver::default(), |all, (name, bytes)| {
                all.with(name, bytes.as_slice())
            });
        let compiled = compile(text, &Options::default(), &resolver);
        let paper = Paper::new(&compiled, &Arc::from(text)).expect("something is drawn");
        serde_json::from_slice(&paper.json()).expect("it is JSON")
    }

    const BODY: &str = r#"<rect x="1" y="1" width="8" height="8"/><text x="3" y="5" font-size="2">Body</text></svg>"#;

    #[test]
    fn pictures_that_are_linked_are_embedded_where_they_are_drawn_and_nothing_else_changes() {
        let drawing = |links: [&str; 3]| {
            let [first, second, third] = links;
            format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="20" height="20"><a href="a b.png"><image xlink:href='{first}' width="5" height="5"/></a><image href="{second}" x="9" width="5" height="5"/><image href="{third}" width="5" height="5"/>{BODY}"#
            )
        };
        let links = ["a b.png", "gone.png", "../a b.png"];
        let described = described(&drawing(links), &[("a b.png", pixel())]);
        let (before, after) = match described["picture"].as_str() {
            Some(picture) => picture
                .split_once("data:image/png;base64,iVBORw0KGgo")
                .expect("a picture is embedded"),
            None => panic!("{described}"),
        };
        let rest = after.split_once('\'').map(|(_, rest)| rest);
        let (expected, end) = (drawing(["\n", links[1], links[2]]), "\n'");
        assert_eq!(
            (Some(before), rest),
            (
                expected.split(end).next(),
                expected.split_once(end).map(|(_, rest)| rest)
            )
        );
        assert_eq!(described["left_out"], serde_json::json!([]));
    }

    #[test]
    fn pictures_that_are_too_large_together_are_named() {
        let mut large = pixel();
        // What stands behind the end of a picture is not read.
        large.resize(MAX_KEPT - pixel().len(), 0);
        let text = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="20" height="20"><image href="large.png" width="5" height="5"/><image href="small.png" width="5" height="5"/><image href="more.png" width="5" height="5"/>{BODY}"#
        );
        let files = [
            ("large.png", large),
            ("small.png", pixel()),
            ("more.png", pixel()),
        ];
        let described = described(&text, &files);
        assert_eq!(described["left_out"], serde_json::json!(["more.png"]));
        let picture = described["picture"].as_str().unwrap_or_default();
        assert_eq!(picture.matches("data:image/png").count(), 2);
        assert!(picture.contains("more.png"));
    }
}
