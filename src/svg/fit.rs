//! Pictures so narrow that no rectangle of single precision is left of them once they are fitted into their element.
//!
//! usvg panics at such a picture, so it is found before, with the calculation that usvg does.

use std::ops::RangeInclusive;

use data_url::DataUrl;
use resvg::tiny_skia::{NonZeroRect, Size};
use rustc_hash::FxHashMap;
use svgtypes::{Align, AspectRatio, Length, LengthUnit, ViewBox};

/// A font size in user units, to guess lengths that depend on it.
const FONT_SIZE: f32 = 16.0;

/// The width and height of a page that does not say them, in user units.
const PAGE: f32 = 100.0;

/// User units in an inch.
const DPI: f32 = 96.0;

/// The largest ratio of the sides of a picture: those whose sides are more unequal have more pixels than are read.
const MAX_RATIO: f32 = 16_384.0;

/// How much smaller a fitting picture could be: lengths are only guessed if they depend on fonts or the page.
const MARGIN: f32 = 8.0;

/// How links to embedded pictures begin.
pub(super) const EMBEDDED: &str = "data:";

/// Where a drawing shows pictures. A picture that does not fit into one of its viewports is left out of all.
///
/// Viewports in filters, and in drawings that are pictures, are not known.
pub(super) struct ImageViewports<'a> {
    /// By link, the ratios that fit into all its viewports. Links whose viewports take every picture are missing.
    linked: FxHashMap<&'a str, Ratios>,
    /// The same for the bytes of embedded pictures, with their data URI.
    embedded: FxHashMap<Vec<u8>, (&'a str, Ratios)>,
}

/// A range of the ratio of width to height; empty if it begins behind its end.
type Ratios = RangeInclusive<f32>;

/// Where a picture comes from.
#[derive(Clone, Copy)]
pub(super) enum Origin<'a> {
    Link(&'a str),
    /// The bytes of a data URI.
    Embedded(&'a [u8]),
}

impl<'a> ImageViewports<'a> {
    /// The viewports in a drawing.
    pub(super) fn of(document: &'a roxmltree::Document<'_>) -> Self {
        let page = page_size(document.root_element());
        let mut viewports = Self {
            linked: FxHashMap::default(),
            embedded: FxHashMap::default(),
        };
        let images = document
            .descendants()
            .filter(|node| node.tag_name().name() == "image");
        for image in images {
            let link = image
                .attributes()
                .find(|attribute| attribute.name() == "href");
            if let Some(link) = link
                && let Some(viewport) = ImageViewport::of(image, page)
                && let Some(ratios) = viewport.limited_ratios()
            {
                viewports.add(link.value(), ratios);
            }
        }
        viewports
    }

    fn add(&mut self, link: &'a str, ratios: Ratios) {
        let known = match DataUrl::process(link) {
            Err(_) => self.linked.entry(link).or_insert_with(|| ratios.clone()),
            Ok(url) => {
                // usvg leaves out what cannot be decoded.
                let Ok((bytes, _)) = url.decode_to_vec() else {
                    return;
                };
                let entry = self.embedded.entry(bytes);
                let (_, known) = entry.or_insert_with(|| (link, ratios.clone()));
                known
            }
        };
        *known = known.start().max(*ratios.start())..=known.end().min(*ratios.end());
    }

    /// The link or data URI of a picture, if it does not fit into one of its viewports, or is too narrow for any.
    pub(super) fn misfit(&self, origin: Origin<'_>, picture: &usvg::ImageKind) -> Option<String> {
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
        let ratio = size.map(|size| size.width() / size.height())?;
        let (link, limited) = match origin {
            Origin::Link(link) => (link, self.linked.get(link)),
            Origin::Embedded(bytes) => match self.embedded.get(bytes) {
                Some((link, ratios)) => (*link, Some(ratios)),
                None => (EMBEDDED, None),
            },
        };
        let fits =
            every_ratio().contains(&ratio) && limited.is_none_or(|ratios| ratios.contains(&ratio));
        (!fits).then(|| link.to_owned())
    }
}

fn every_ratio() -> Ratios {
    MAX_RATIO.recip()..=MAX_RATIO
}

/// The viewport of an `<image>`.
struct ImageViewport {
    rect: NonZeroRect,
    /// Whether the picture covers the viewport, rather than lying within it.
    covers: bool,
}

impl ImageViewport {
    /// `None` if every picture fits, because it gets the shape of the viewport or the viewport that of the picture.
    fn of(node: roxmltree::Node<'_, '_>, page: [f32; 2]) -> Option<Self> {
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
        let (width, height) = (length("width", page[0])?, length("height", page[1])?);
        let viewport = Self {
            rect: NonZeroRect::from_xywh(x, y, width, height)?,
            covers: aspect.slice,
        };
        (aspect.align != Align::None).then_some(viewport)
    }

    /// The ratios of the pictures that fit, either end too near by a factor of up to 2; `None` if all fit.
    fn limited_ratios(&self) -> Option<Ratios> {
        let every = every_ratio();
        if self.fits(*every.start()) && self.fits(*every.end()) {
            return None;
        }
        // A picture with the ratio of the viewport fits best.
        let own = (self.rect.width() / self.rect.height()).clamp(*every.start(), *every.end());
        let furthest = |factor: f32| {
            let ratios = std::iter::successors(Some(own), |ratio| Some(ratio * factor));
            let within = ratios.take_while(|ratio| every.contains(ratio) && self.fits(*ratio));
            within.last()
        };
        let none = Ratios::new(1.0, 0.0);
        Some(match (furthest(0.5), furthest(2.0)) {
            (Some(least), Some(most)) => least..=most,
            _ => none,
        })
    }

    /// Whether there is a rectangle for a picture with this ratio of width to height.
    fn fits(&self, ratio: f32) -> bool {
        let (width, height) = (self.rect.width(), self.rect.height());
        let fills_width = if self.covers {
            height * ratio <= width
        } else {
            height * ratio >= width
        };
        let (scaled_width, scaled_height) = if fills_width {
            (width, width / ratio)
        } else {
            (height * ratio, height)
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
