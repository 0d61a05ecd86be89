//! The drawing as read by usvg and roxmltree together: shapes with their meaning, texts with their source maps.
//!
//! Invariants: coordinates are user units of the outermost `<svg>` after its `viewBox`, y down, f64;
//! shapes are in paint order; every element, group and text has its span in the file. This module does not know the
//! annotation language.

mod clip;
mod dashes;
mod dropped;
mod elements;
mod entities;
mod excerpts;
mod fit;
mod growth;
mod image;
mod incremental;
mod links;
mod oklab;
mod paint;
mod paths;
mod pictures;
mod poses;
mod prepare;
mod raster;
mod replacements;
mod round;
mod separate;
mod shapes;
mod sheets;
mod style;
mod tangles;
mod text;
mod unseen;
mod unsolid;
mod walk;

use std::sync::Arc;

use glam::DVec2;
use typed_index_collections::TiVec;

pub(crate) use entities::character;
pub(crate) use excerpts::{Excerpts, excerpts};
pub(crate) use image::{PictureSource, pixels_of};
pub(crate) use incremental::TextEdit;
pub(crate) use links::LinkedPicture;
#[cfg(test)]
pub(crate) use links::MAX_KEPT;
pub(crate) use links::broken_link;
pub(crate) use oklab::oklab;
pub(crate) use paths::StrokeSource;
pub(crate) use pictures::LARGE;
pub(crate) use poses::{DrawnPath, IsPose, PosedShape, Poses, transform_inside, transforms_around};
pub use raster::{LeftOut, raster};
pub(crate) use text::Label;
pub(crate) use unseen::{ConvertedText, Hidden, Unseen};

use crate::budget::Budget;
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::Outline;
use crate::index::index_type;
use crate::resolver::Resolver;
use crate::source::{Span, Text};
use crate::texture::PaintServer;

index_type!(
    /// A shape of a drawing, in paint order.
    pub ShapeId
);

index_type!(
    /// A group of a drawing. It comes after the group that contains it.
    pub GroupId
);

index_type!(
    /// A transparency group of a drawing: what has an opacity of its own, with all that is in it. Its shapes are painted as if it were
    /// opaque, and the whole then becomes translucent.
    pub TransparencyGroupId
);

impl GroupId {
    /// The outermost `<svg>`.
    pub const ROOT: Self = Self(0);
}

/// A drawing.
#[derive(Debug, Clone, Default)]
pub struct Drawing {
    /// Minimum corner and size of the page.
    pub page: (DVec2, DVec2),
    /// The groups; the first is the outermost `<svg>`, and a group comes after the group that contains it.
    pub groups: TiVec<GroupId, Group>,
    /// The shapes in paint order, back-most first.
    pub shapes: TiVec<ShapeId, Shape>,
    /// Per transparency group the one around it, which comes before it.
    pub transparency_groups: TiVec<TransparencyGroupId, Option<TransparencyGroupId>>,
    /// The texts in document order, each with its group.
    pub labels: Vec<(Label, GroupId)>,
    /// What the drawing holds but does not show.
    pub unseen: Unseen,
    /// The pose layers, and what is in them.
    pub(crate) poses: Poses,
    /// Per group whether its pictures are read pixel by pixel (see [`PixelGroups`]); `None` if there are no pictures.
    pub pixel_groups: Option<TiVec<GroupId, bool>>,
    /// The pictures that it links to and shows.
    pub pictures: Vec<LinkedPicture>,
    /// How much work it may cause.
    pub(crate) budget: Budget,
}

/// The width of the widest hairline, as a share of the page's larger side.
const HAIRLINE: f64 = 1.0 / 300.0;

impl Drawing {
    /// Whether a transparency group is another one or is in it.
    pub(crate) fn is_in_transparency_group(
        &self,
        group: TransparencyGroupId,
        other: TransparencyGroupId,
    ) -> bool {
        let around = |group: &TransparencyGroupId| self.transparency_groups[*group];
        std::iter::successors(Some(group), around).any(|group| group == other)
    }

    /// Whether a stroke is not wider than a 300th of the page, as those of guides are.
    pub(crate) fn is_hairline(&self, stroke: &StrokeSource) -> bool {
        stroke.width() <= HAIRLINE * self.page.1.max_element()
    }
}

/// The kinds of groups.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GroupKind {
    /// The outermost `<svg>`.
    Root,
    /// An Inkscape layer.
    Layer,
    /// `g`, `a`, `switch`, an inner `svg`, a clone.
    Group,
}

/// A group of the drawing.
#[derive(Debug, Clone)]
pub struct Group {
    /// The group that contains it; the first group contains itself.
    pub parent: GroupId,
    /// Its kind.
    pub kind: GroupKind,
    /// The rectangle that it is clipped to, user units, if its clip is one: minimum and maximum corner.
    pub frame: Option<(DVec2, DVec2)>,
    /// Whether neither it nor what it is in has a `transform`, so that its coordinates are those of the drawing.
    pub is_untransformed: bool,
    /// Its element.
    pub element: Element,
}

/// An element of the file.
#[derive(Debug, Clone, Default)]
pub struct Element {
    /// Its start tag's bracket and name, `<rect`.
    pub span: Span,
    /// Its tag's name.
    pub tag: &'static str,
    /// Its `id`.
    pub id: Option<String>,
    /// The name that people see in the program that drew it: its `inkscape:label`, `serif:id` or `data-name`.
    pub label: Option<String>,
    /// Its `<desc>`.
    pub desc: Option<Arc<Text>>,
    /// Where a `<desc>` can be inserted, if it has none.
    pub desc_slot: Option<DescSlot>,
}

/// Where a description can be inserted into an element.
#[derive(Debug, Clone)]
pub struct DescSlot {
    /// The place behind the start tag, or the `/>` that ends it.
    pub span: Span,
    /// The prefix of the element's tag with its colon; usually empty.
    pub prefix: Box<str>,
}

/// The paint of a shape.
#[derive(Debug, Clone)]
pub struct Paint {
    /// Its identity.
    pub key: PaintKey,
    /// Its colour, or the mean of its colours, sRGB, each 0 to 255.
    pub color: [u8; 3],
    /// Its gradient, pattern or picture, if it is more than a colour.
    pub server: Option<Arc<PaintServer>>,
}

/// Paint identity.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PaintKey {
    /// A colour.
    Solid([u8; 3]),
    /// The id of the last gradient or pattern in the chain of references.
    Server(String),
    /// The picture of an `<image>`.
    Picture(usize),
}

/// A shape of the drawing.
#[derive(Debug, Clone)]
pub struct Shape {
    /// Its number among all visible paths and pictures of the file, in paint order; what is not built counts too.
    pub leaf: usize,
    /// The innermost group that contains it.
    pub group: GroupId,
    /// Its element; for the content of a clone, the clone.
    pub element: Element,
    /// Its filled area; empty for lines. Parts and solids share it.
    pub outline: Arc<Outline>,
    /// The share of the border of its filled area that is drawn as curves.
    pub curved: f64,
    /// Its fill, or its stroke if it has no fill.
    pub paint: Paint,
    /// Opacity of fill, element and groups together, 0 to 1.
    pub opacity: f64,
    /// The innermost transparency group that it is in.
    pub transparency_group: Option<TransparencyGroupId>,
    /// Whether its fill, or its stroke if it has no fill, hides what is painted before it in that group.
    pub is_opaque_in_group: bool,
    /// Its stroke, if it has a visible one.
    pub stroke: Option<Arc<StrokeSource>>,
    /// The ends of the line, if the shape is an unfilled open line.
    pub line: Option<Box<Line>>,
    /// The file of an `<image>` whose pixels are read one by one: its outline is its whole rectangle, its paint has
    /// no colour of its own. Other pictures have none.
    pub picture: Option<Arc<PictureSource>>,
}

/// An unfilled open line.
#[derive(Debug, Clone, Default)]
pub struct Line {
    /// Its two ends, user units.
    pub ends: [DVec2; 2],
    /// The ids of the elements that an Inkscape connector joins.
    pub connects: [Option<String>; 2],
}

/// A function that says, per group, whether its pictures are read pixel by pixel. Such pictures are not traced: their
/// outlines and textures would take longer to make than everything else about them.
pub(crate) type PixelGroups<'a> = &'a (dyn Fn(&Drawing) -> TiVec<GroupId, bool> + Sync);

/// Reads a drawing. `tolerance` is how far a flattened curve may deviate, as a share of its shape's larger extent;
/// `pixel_groups` is called only if there are pictures; `is_pose` says which texts make pose layers.
///
/// Never fails: what cannot be read becomes a diagnostic, and the rest is in the drawing. Recurses as deep as the
/// drawing is nested, so the thread needs a large stack, as [`crate::compile::compile`] gives it; where there are no
/// threads but the caller's, 1 MiB is enough, as less nesting is allowed there.
pub fn read(
    source: &str,
    tolerance: f64,
    resolver: &dyn Resolver,
    pixel_groups: PixelGroups<'_>,
    is_pose: IsPose<'_>,
) -> (Drawing, Vec<Diagnostic>) {
    let mut diagnostics = Vec::new();
    let drawing = read_document(
        source,
        tolerance,
        resolver,
        pixel_groups,
        is_pose,
        &mut diagnostics,
    );
    let drawing = drawing.unwrap_or_else(|diagnostic| {
        diagnostics.push(*diagnostic);
        Drawing::default()
    });
    (drawing, diagnostics)
}

fn read_document(
    source: &str,
    tolerance: f64,
    resolver: &dyn Resolver,
    pixel_groups: PixelGroups<'_>,
    is_pose: IsPose<'_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<Drawing, Box<Diagnostic>> {
    if source.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(Box::new(
            Diagnostic::new(Code::EmptyFile, Span::at(0), "the file is empty")
                .help("draw something, and save it as SVG"),
        ));
    }
    let prepared = prepare::prepare(source)?;
    let document = roxmltree::Document::parse_with_options(&prepared.text, links::parsing())
        .map_err(|error| Box::new(not_xml(&error, &prepared, source)))?;
    prepare::check_elements(&document, &prepared)?;
    let root = document.root_element();
    if root.tag_name().name() != "svg"
        || !matches!(
            root.tag_name().namespace(),
            None | Some("http://www.w3.org/2000/svg")
        )
    {
        let start = prepared.original(root.range().start);
        let span = Span::new(start, start + 1 + root.tag_name().name().len());
        let message = format!(
            "the file is XML, but its root element is `{}`, not `svg`",
            root.tag_name().name()
        );
        return Err(Box::new(
            Diagnostic::new(Code::NotSvg, span, message).help("save the drawing as SVG"),
        ));
    }
    let mut drawing = shapes::read(
        &document,
        &prepared,
        tolerance,
        resolver,
        is_pose,
        diagnostics,
    )?;
    if drawing.shapes.iter().any(|shape| shape.picture.is_some()) {
        let pixel_groups = pixel_groups(&drawing);
        pictures::trace(&mut drawing, &pixel_groups, diagnostics);
        drawing.pixel_groups = Some(pixel_groups);
    }
    Ok(drawing)
}

/// The error of the XML parser, at the byte of the original that it is about.
fn not_xml(error: &roxmltree::Error, prepared: &prepare::Prepared, source: &str) -> Diagnostic {
    let ended = matches!(
        error,
        roxmltree::Error::UnclosedRootNode | roxmltree::Error::UnexpectedEndOfStream
    );
    let position = error.pos();
    let line = prepared
        .text
        .split_inclusive('\n')
        .take(position.row.saturating_sub(1) as usize);
    let start: usize = line.map(str::len).sum();
    let column = prepared.text[start..]
        .char_indices()
        .nth(position.col.saturating_sub(1) as usize);
    // For a file that ends too early the parser gives no position: it is the end.
    let at = match column {
        Some((offset, _)) if !ended => prepared.original(start + offset).min(source.len()),
        _ => source.trim_end().len(),
    };
    let next = source[at..].chars().next().map_or(0, char::len_utf8);
    // The parser's message ends with the position, which the report shows better.
    let message = error.to_string();
    let message = message
        .rsplit_once(" at ")
        .map_or(message.as_str(), |(head, _)| head);
    let help = if ended {
        "the file ends too early, as if it was cut off while it was saved: save it again"
    } else {
        "open the drawing in Inkscape and save it again, or fix the text at this place"
    };
    let message = format!("not well-formed XML: {message}");
    Diagnostic::new(Code::NotXml, Span::new(at, at + next), message).help(help)
}
