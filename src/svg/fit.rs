//! Pictures that no rectangle of single precision shows: their sides are too unequal for their place.
//!
//! usvg panics at such a picture, so it is found before, with the calculation that usvg does.

use data_url::DataUrl;
use resvg::tiny_skia::{NonZeroRect, Size};
use svgtypes::{Align, AspectRatio, Length, LengthUnit, ViewBox};

/// A font size in user units, to guess lengths that depend on it.
const FONT_SIZE: f32 = 16.0;

/// The width and height of a page that does not say them, in user units.
const PAGE: f32 = 100.0;

/// User units in an inch.
const DPI: f32 = 96.0;

/// Pictures whose sides are less unequal fit into nearly every place; only the others are compared with each.
const USUAL_RATIO: f32 = 16_384.0;

/// How much smaller a fitting picture could be: lengths are only guessed if they depend on fonts or the page.
const MARGIN: f32 = 8.0;

/// Where a drawing shows pictures. A picture that does not fit into one of its places is left out of all.
pub(super) struct Places<'a> {
    all: Vec<Place<'a>>,
    /// Those that not every picture of a usual ratio fits into.
    narrow: Vec<Place<'a>>,
}

/// Where a picture comes from.
#[derive(Clone, Copy)]
pub(super) enum Origin<'a> {
    Link(&'a str),
    /// The bytes of a data URI.
    Embedded(&'a [u8]),
}

/// The place of an `<image>`.
#[derive(Clone, Copy)]
struct Place<'a> {
    link: &'a str,
    rect: NonZeroRect,
    /// Whether the picture covers the place, rather than lying within it.
    covers: bool,
}

impl<'a> Places<'a> {
    /// The places in a drawing.
    pub(super) fn of(document: &'a roxmltree::Document<'_>) -> Self {
        let page = page_size(document.root_element());
        let images = document
            .descendants()
            .filter(|node| node.tag_name().name() == "image");
        let all: Vec<Place<'a>> = images.filter_map(|node| Place::of(node, page)).collect();
        let is_narrow = |place: &&Place<'_>| {
            let extremes = [[USUAL_RATIO, 1.0], [1.0, USUAL_RATIO]];
            !extremes.into_iter().all(|[width, height]| {
                Size::from_wh(width, height).is_some_and(|size| place.fits(size))
            })
        };
        let narrow = all.iter().filter(is_narrow).copied().collect();
        Self { all, narrow }
    }

    /// The link, or data URI, at a place of the picture that it does not fit into.
    pub(super) fn misfit(&self, origin: Origin<'_>, picture: &usvg::ImageKind) -> Option<&'a str> {
        let size = match picture {
            usvg::ImageKind::SVG(tree) => Some(tree.size()),
            usvg::ImageKind::JPEG(bytes)
            | usvg::ImageKind::PNG(bytes)
            | usvg::ImageKind::GIF(bytes)
            | usvg::ImageKind::WEBP(bytes) => imagesize::blob_size(bytes)
                .ok()
                .and_then(|size| Size::from_wh(size.width as f32, size.height as f32)),
        };
        // usvg leaves out pictures without a size.
        let size = size?;
        let ratio = size.width() / size.height();
        let places = match (USUAL_RATIO.recip()..=USUAL_RATIO).contains(&ratio) {
            true => &self.narrow,
            false => &self.all,
        };
        let is_meant = |place: &&Place<'_>| match origin {
            Origin::Link(link) => place.link == link,
            Origin::Embedded(bytes) => DataUrl::process(place.link)
                .ok()
                .and_then(|url| url.decode_to_vec().ok())
                .is_some_and(|(embedded, _)| embedded == bytes),
        };
        let mut places = places.iter().filter(|place| !place.fits(size));
        places.find(is_meant).map(|place| place.link)
    }
}

impl<'a> Place<'a> {
    fn of(node: roxmltree::Node<'a, '_>, page: [f32; 2]) -> Option<Self> {
        let attributes = || node.attributes();
        let link = attributes().find(|attribute| attribute.name() == "href")?;
        let length = |name, page| {
            let length: Length = node.attribute(name)?.parse().ok()?;
            Some(user_units(length, page))
        };
        let aspect = node.attribute("preserveAspectRatio");
        let aspect: AspectRatio = aspect
            .and_then(|aspect| aspect.parse().ok())
            .unwrap_or_default();
        let [x, y] =
            [("x", page[0]), ("y", page[1])].map(|(name, page)| length(name, page).unwrap_or(0.0));
        // Without a width or a height, the place has the shape of the picture.
        let (width, height) = (length("width", page[0])?, length("height", page[1])?);
        Some(Self {
            link: link.value(),
            rect: NonZeroRect::from_xywh(x, y, width, height)?,
            covers: aspect.slice,
        })
        .filter(|_| aspect.align != Align::None)
    }

    /// Whether there is a rectangle for a picture of this size in its own units.
    fn fits(&self, size: Size) -> bool {
        let (width, height) = (self.rect.width(), self.rect.height());
        let scaled_width = height * size.width() / size.height();
        let fills_width = match self.covers {
            true => scaled_width <= width,
            false => scaled_width >= width,
        };
        let (scaled_width, scaled_height) = match fills_width {
            true => (width, width * size.height() / size.width()),
            false => (scaled_width, height),
        };
        [MARGIN.recip(), 1.0, MARGIN].into_iter().all(|margin| {
            let (scaled_width, scaled_height) = (scaled_width * margin, scaled_height * margin);
            [0.0, 0.5, 1.0].into_iter().all(|share| {
                let x = self.rect.x() + (width - scaled_width) * share;
                let y = self.rect.y() + (height - scaled_height) * share;
                NonZeroRect::from_xywh(x, y, scaled_width, scaled_height).is_some()
            })
        })
    }
}

/// Width and height of the page in user units.
fn page_size(root: roxmltree::Node<'_, '_>) -> [f32; 2] {
    let view_box = root.attribute("viewBox");
    if let Some(view_box) = view_box.and_then(|value| value.parse::<ViewBox>().ok()) {
        return [view_box.w as f32, view_box.h as f32];
    }
    ["width", "height"].map(|name| {
        let length = root.attribute(name).and_then(|value| value.parse().ok());
        length.map_or(PAGE, |length| user_units(length, PAGE))
    })
}

/// A length in user units, guessed if it depends on the font or the page.
fn user_units(length: Length, page: f32) -> f32 {
    let number = length.number as f32;
    match length.unit {
        LengthUnit::None | LengthUnit::Px => number,
        LengthUnit::Em => number * FONT_SIZE,
        LengthUnit::Ex => number * FONT_SIZE / 2.0,
        LengthUnit::In => number * DPI,
        LengthUnit::Cm => number * DPI / 2.54,
        LengthUnit::Mm => number * DPI / 25.4,
        LengthUnit::Pt => number * DPI / 72.0,
        LengthUnit::Pc => number * DPI / 6.0,
        LengthUnit::Percent => number * page / 100.0,
    }
}
