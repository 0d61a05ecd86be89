//! The shapes of a drawing: usvg's tree joined to the XML by id.

use glam::{DAffine2, DMat2, DVec2};
use kurbo::BezPath;
use rayon::prelude::*;
use roxmltree::{Node, NodeId};
use rustc_hash::FxHashMap;
use std::sync::{Arc, Mutex};
use usvg::tiny_skia_path as skia;

use super::clip::Clip;
use super::prepare::Prepared;
use super::style::Styles;
use super::{Drawing, Element, Group, GroupKind, Line, Paint, PaintKey, Shape, image, text};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{FillRule, Outline, clean, flatten};
use crate::resolver::{LinkError, Resolver};
use crate::source::Span;

/// A stroke, from which an outline can be made when it is wanted.
#[derive(Debug, Clone)]
pub struct StrokeSource {
    path: skia::Path,
    stroke: skia::Stroke,
    transform: DAffine2,
    tolerance: f64,
    /// What it is painted with.
    pub paint: Paint,
}

impl StrokeSource {
    /// The area that the stroke covers.
    pub fn outline(&self) -> Outline {
        let extent = self
            .path
            .bounds()
            .width()
            .max(self.path.bounds().height())
            .max(self.stroke.width);
        let resolution = (1000.0 / extent).clamp(1e-3, 1e4);
        let dashed = self
            .stroke
            .dash
            .as_ref()
            .and_then(|dash| self.path.dash(dash, resolution));
        match dashed
            .as_ref()
            .unwrap_or(&self.path)
            .stroke(&self.stroke, resolution)
        {
            None => Outline::default(),
            Some(path) => {
                let path = bez_path(&path, self.transform);
                clean(rings(&path, self.tolerance), FillRule::NonZero)
            }
        }
    }
}

/// A usvg node that is to become a shape.
struct Task<'a> {
    node: Leaf<'a>,
    xml: NodeId,
    group: usize,
    opacity: f64,
    clips: Option<Arc<Vec<Clip>>>,
}

enum Leaf<'a> {
    Path(&'a usvg::Path),
    Image(&'a usvg::Image),
}

/// Joins what usvg and the XML know.
pub(super) fn read(
    document: &roxmltree::Document<'_>,
    prepared: &Prepared,
    tolerance: f64,
    resolver: &dyn Resolver,
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<Drawing, Box<Diagnostic>> {
    let broken_links = Mutex::new(Vec::new());
    let styles = Styles::read(document);
    // usvg works on one core; the texts, which it does not read, need only the XML.
    let (tree, labels) = rayon::join(
        || usvg::Tree::from_xmltree(document, &options(resolver, &broken_links)),
        || labels(document, &styles, prepared),
    );
    let tree = tree.map_err(|error| Box::new(unusable(&error, document, prepared)))?;
    report_links(
        document,
        prepared,
        broken_links.into_inner().unwrap_or_default(),
        diagnostics,
    );
    let offset = page_corner(document);
    let mut walk = Walk {
        prepared,
        root: document.root_element(),
        by_id: ids(document),
        group_of: vec![usize::MAX; document.descendants().count() + 1],
        groups: Vec::new(),
        tasks: Vec::new(),
        tolerance,
        page: DAffine2::from_translation(offset),
        diagnostics,
    };
    walk.group(document.root_element());
    let root = document.root_element().id();
    walk.children(tree.root(), root, 1.0, None);
    let labels = labels
        .into_iter()
        .map(|(node, label)| (label, walk.group(node)))
        .collect();
    let Walk {
        groups,
        tasks,
        page,
        by_id,
        ..
    } = walk;
    let size = DVec2::new(
        f64::from(tree.size().width()),
        f64::from(tree.size().height()),
    );
    let context = Context {
        document,
        styles: &styles,
        prepared,
        by_id,
        page,
        tolerance,
    };
    let made: Vec<_> = tasks
        .par_iter()
        .enumerate()
        .map(|(index, task)| context.shape(index, task))
        .collect();
    drop(tasks);
    // Taking a large tree apart takes a tenth of the time of making it: nobody need wait for that.
    super::deep::run_aside(move || drop(tree));
    let mut shapes = Vec::with_capacity(made.len());
    for (shape, finding) in made {
        shapes.extend(shape);
        diagnostics.extend(finding.map(|finding| *finding));
    }
    Ok(Drawing {
        page: (offset, size),
        groups,
        shapes,
        labels,
    })
}

fn options<'a>(
    resolver: &'a dyn Resolver,
    broken: &'a Mutex<Vec<(String, LinkError)>>,
) -> usvg::Options<'a> {
    let data = usvg::ImageHrefResolver::default_data_resolver();
    usvg::Options {
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: usvg::ImageHrefResolver::default_data_resolver(),
            resolve_string: Box::new(move |href, options| match resolver.read(href) {
                // usvg's own resolver for data tells the format by its first bytes.
                Ok(bytes) => data("text/plain", Arc::new(bytes.to_vec()), options),
                Err(error) => {
                    if let Ok(mut broken) = broken.lock() {
                        broken.push((href.to_owned(), error));
                    }
                    None
                }
            }),
        },
        ..usvg::Options::default()
    }
}

fn unusable(
    error: &usvg::Error,
    document: &roxmltree::Document<'_>,
    prepared: &Prepared,
) -> Diagnostic {
    let tag = start_tag(document.root_element(), prepared);
    match error {
        usvg::Error::InvalidSize => Diagnostic::new(Code::OutOfRange, tag, "the page has no size")
            .help("give the drawing a page: in Inkscape, File → Document Properties → Resize to content"),
        usvg::Error::ElementsLimitReached
        | usvg::Error::ParsingFailed(roxmltree::Error::NodesLimitReached) => Diagnostic::new(
            Code::LimitPassed,
            tag,
            "the drawing has more than a million elements once its clones are drawn, or is nested too deep",
        )
        .help("split the drawing in several files"),
        other => Diagnostic::new(Code::NotSvg, tag, format!("the drawing cannot be read: {other}")),
    }
}

fn report_links(
    document: &roxmltree::Document<'_>,
    prepared: &Prepared,
    broken: Vec<(String, LinkError)>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    for (href, error) in broken {
        let images = document
            .descendants()
            .filter(|node| node.tag_name().name() == "image");
        let attribute = images
            .flat_map(|node| node.attributes().collect::<Vec<_>>())
            .find(|attribute| attribute.name() == "href" && attribute.value() == href);
        let span = attribute.map_or(Span::at(0), |attribute| {
            prepared.span(attribute.range_value())
        });
        diagnostics.push(broken_link(&href, &error, span));
    }
}

/// What is wrong with a link.
pub(crate) fn broken_link(link: &str, error: &LinkError, span: Span) -> Diagnostic {
    let (code, help) = match error {
        LinkError::Missing => (
            Code::MissingFile,
            "put the file beside the drawing, or write its name as it is",
        ),
        LinkError::Outside | LinkError::Absolute | LinkError::Remote => (
            Code::LinkOutside,
            "copy the file into the drawing's folder and link it there, or embed it",
        ),
        LinkError::Unreadable(_) => (Code::MissingFile, "see whether the file can be opened"),
        LinkError::TooLarge { .. } => (Code::LimitPassed, "use a smaller file"),
    };
    Diagnostic::new(code, span, format!("the link `{link}` {error}")).help(help)
}

fn page_corner(document: &roxmltree::Document<'_>) -> DVec2 {
    let view_box = document
        .root_element()
        .attribute("viewBox")
        .and_then(|value| value.parse().ok());
    view_box.map_or(DVec2::ZERO, |view_box: svgtypes::ViewBox| {
        DVec2::new(view_box.x, view_box.y)
    })
}

fn ids<'a>(document: &'a roxmltree::Document<'_>) -> FxHashMap<&'a str, NodeId> {
    let mut ids = FxHashMap::default();
    for node in document.descendants().filter(Node::is_element) {
        if let Some(id) = node.attribute("id") {
            ids.entry(id).or_insert(node.id());
        }
    }
    ids
}

/// The original place of an element's opening bracket and name: short enough to point at.
pub(super) fn start_tag(node: Node<'_, '_>, prepared: &Prepared) -> Span {
    let start = node.range().start;
    let name = prepared.text[start..].find(|c: char| c.is_whitespace() || matches!(c, '>' | '/'));
    prepared.span(start..name.map_or(node.range().end, |end| start + end))
}

/// The tag's name, as far as it can become a part or a group.
fn known_tag(name: &str) -> &'static str {
    super::prepare::JOINED
        .iter()
        .find(|known| **known == name)
        .copied()
        .unwrap_or("element")
}

fn element(node: Node<'_, '_>, prepared: &Prepared) -> Element {
    let own_id = node
        .attribute("id")
        .filter(|id| !id.starts_with(&prepared.id_prefix));
    let desc = node
        .children()
        .find(|child| child.is_element() && child.tag_name().name() == "desc");
    Element {
        span: start_tag(node, prepared),
        tag: known_tag(node.tag_name().name()),
        id: own_id.map(str::to_owned),
        label: node
            .attributes()
            .find(|attribute| attribute.name() == "label" && attribute.namespace().is_some())
            .map(|attribute| attribute.value().to_owned()),
        desc: desc.map(|desc| Box::new(text::content(desc, prepared))),
    }
}

/// The texts that are seen, in document order.
fn labels<'a, 'input>(
    document: &'a roxmltree::Document<'input>,
    styles: &Styles<'_>,
    prepared: &Prepared,
) -> Vec<(Node<'a, 'input>, text::Label)> {
    let drawn = |node: &Node<'_, '_>| {
        !node
            .ancestors()
            .any(|inner| NOT_DRAWN.contains(&inner.tag_name().name()))
    };
    let texts: Vec<_> = document
        .descendants()
        .filter(|node| node.is_element() && matches!(node.tag_name().name(), "text" | "flowRoot"))
        .filter(drawn)
        .collect();
    texts
        .into_par_iter()
        .filter_map(|node| Some((node, text::read(node, styles, prepared)?)))
        .collect()
}

/// Elements whose content is not drawn where it stands.
const NOT_DRAWN: &[&str] = &[
    "defs", "symbol", "pattern", "clipPath", "mask", "marker", "metadata",
];

/// The walk over usvg's tree.
struct Walk<'a, 'input, 'd> {
    prepared: &'a Prepared,
    root: Node<'a, 'input>,
    by_id: FxHashMap<&'a str, NodeId>,
    /// Per XML node the group it is, or that it is in; `usize::MAX` where not yet known.
    group_of: Vec<usize>,
    groups: Vec<Group>,
    tasks: Vec<Task<'a>>,
    tolerance: f64,
    page: DAffine2,
    diagnostics: &'d mut Vec<Diagnostic>,
}

impl<'a> Walk<'a, '_, '_> {
    /// The group that an element is, or the innermost one it is in.
    fn group(&mut self, node: Node<'_, '_>) -> usize {
        let slot = node.id().get_usize();
        if self.group_of[slot] != usize::MAX {
            return self.group_of[slot];
        }
        let parent = node.parent_element().map(|parent| self.group(parent));
        let layer = node.attributes().any(|attribute| {
            attribute.name() == "groupmode"
                && attribute.namespace().is_some()
                && attribute.value() == "layer"
        });
        let group = match (parent, node.tag_name().name()) {
            (None, _) => Some(GroupKind::Root),
            (_, "g") if layer => Some(GroupKind::Layer),
            (_, "g" | "a" | "switch" | "svg" | "use") => Some(GroupKind::Group),
            _ => None,
        };
        let index = match group {
            None => parent.unwrap_or(0),
            Some(kind) => {
                let element = element(node, self.prepared);
                self.groups.push(Group {
                    parent: parent.unwrap_or(0),
                    kind,
                    element,
                });
                self.groups.len() - 1
            }
        };
        self.group_of[slot] = index;
        index
    }

    fn children(
        &mut self,
        group: &'a usvg::Group,
        xml: NodeId,
        opacity: f64,
        clips: Option<&Arc<Vec<Clip>>>,
    ) {
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => self.inner(inner, xml, opacity, clips),
                usvg::Node::Path(path) if path.is_visible() => {
                    self.leaf(Leaf::Path(path), path.id(), xml, opacity, clips);
                }
                usvg::Node::Image(image) if image.is_visible() => {
                    self.leaf(Leaf::Image(image), image.id(), xml, opacity, clips);
                }
                _ => {}
            }
        }
    }

    fn inner(
        &mut self,
        group: &'a usvg::Group,
        xml: NodeId,
        opacity: f64,
        clips: Option<&Arc<Vec<Clip>>>,
    ) {
        let xml = self.by_id.get(group.id()).copied().unwrap_or(xml);
        if group.mask().is_some() {
            self.no_solid_meaning(
                xml,
                "mask",
                "the part is built as if it were not masked; cut the shape itself instead",
            );
        }
        if !group.filters().is_empty() {
            self.no_solid_meaning(
                xml,
                "filter",
                "the part is built without the filter's effect",
            );
        }
        let opacity = opacity * f64::from(group.opacity().get());
        match group.clip_path() {
            None => self.children(group, xml, opacity, clips),
            Some(clip) => {
                let mut all = clips.map(|clips| Vec::clone(clips)).unwrap_or_default();
                all.extend(Clip::read(
                    clip,
                    self.page * affine(group.abs_transform()),
                    self.tolerance,
                ));
                self.children(group, xml, opacity, Some(&Arc::new(all)));
            }
        }
    }

    fn no_solid_meaning(&mut self, xml: NodeId, what: &str, help: &'static str) {
        let Some(node) = self.root.document().get_node(xml) else {
            return;
        };
        let span = start_tag(node, self.prepared);
        let message = format!("a {what} has no meaning for solids");
        self.diagnostics
            .push(Diagnostic::new(Code::NoSolidMeaning, span, message).help(help));
    }

    fn leaf(
        &mut self,
        leaf: Leaf<'a>,
        id: &str,
        xml: NodeId,
        opacity: f64,
        clips: Option<&Arc<Vec<Clip>>>,
    ) {
        let xml = self.by_id.get(id).copied().unwrap_or(xml);
        let Some(node) = self
            .root
            .document()
            .get_node(xml)
            .filter(|node| node.parent_element().is_some())
        else {
            return;
        };
        let group = self.group(node);
        self.tasks.push(Task {
            node: leaf,
            xml,
            group,
            opacity,
            clips: clips.cloned(),
        });
    }
}

/// What making a shape needs.
struct Context<'a, 'input> {
    document: &'a roxmltree::Document<'input>,
    styles: &'a Styles<'a>,
    prepared: &'a Prepared,
    by_id: FxHashMap<&'a str, NodeId>,
    page: DAffine2,
    tolerance: f64,
}

impl Context<'_, '_> {
    fn shape(&self, index: usize, task: &Task<'_>) -> (Option<Shape>, Option<Box<Diagnostic>>) {
        let Some(node) = self.document.get_node(task.xml) else {
            return (None, None);
        };
        match task.node {
            Leaf::Path(path) => {
                let shape = self.path(path, node, task);
                let finding = shape
                    .as_ref()
                    .and_then(|shape| self.clipped_away(shape, path, task));
                (shape, finding.map(Box::new))
            }
            Leaf::Image(image) => self.image(index, image, node, task),
        }
    }

    /// Says that a clip leaves nothing of a fill.
    fn clipped_away(
        &self,
        shape: &Shape,
        path: &usvg::Path,
        task: &Task<'_>,
    ) -> Option<Diagnostic> {
        let filled = path.fill().is_some_and(|fill| fill.opacity().get() > 0.0);
        if task.clips.is_none() || !filled || !shape.outline.polygons.is_empty() {
            return None;
        }
        let whole = bez_path(path.data(), self.page * affine(path.abs_transform()));
        let whole = clean(rings(&whole, self.tolerance), FillRule::NonZero);
        (!whole.polygons.is_empty()).then(|| {
            Diagnostic::new(
                Code::Vanishes,
                shape.element.span,
                format!("its clip leaves nothing of {}", shape.element.describe()),
            )
            .help("release the clip, or delete the shape")
        })
    }

    fn path(&self, path: &usvg::Path, node: Node<'_, '_>, task: &Task<'_>) -> Option<Shape> {
        let transform = self.page * affine(path.abs_transform());
        let fill = path.fill().filter(|fill| fill.opacity().get() > 0.0);
        let stroke = path.stroke().filter(|stroke| stroke.opacity().get() > 0.0);
        let bez = bez_path(path.data(), transform);
        let mut outline = Outline::default();
        let mut line = None;
        if let Some(fill) = fill {
            let rule = match fill.rule() {
                usvg::FillRule::NonZero => FillRule::NonZero,
                usvg::FillRule::EvenOdd => FillRule::EvenOdd,
            };
            outline = clean(rings(&bez, self.tolerance), rule);
            for clip in task.clips.iter().flat_map(|clips| clips.iter()) {
                outline = clip.cut(outline);
            }
        } else if stroke.is_some() {
            line = open_line(&bez, node);
        }
        let stroke = stroke.map(|stroke| {
            Box::new(StrokeSource {
                path: path.data().clone(),
                stroke: stroke.to_tiny_skia(),
                transform,
                tolerance: self.tolerance,
                paint: self.paint(stroke.paint(), node, "stroke"),
            })
        });
        let (paint, opacity) = match (fill, &stroke) {
            (Some(fill), _) => (
                self.paint(fill.paint(), node, "fill"),
                f64::from(fill.opacity().get()),
            ),
            (None, Some(stroke)) => (
                stroke.paint.clone(),
                path.stroke()
                    .map_or(1.0, |stroke| f64::from(stroke.opacity().get())),
            ),
            (None, None) => return None,
        };
        let mut element = element(node, self.prepared);
        if element.tag == "use" {
            // The clone is a group too, and the description is the group's.
            element.desc = None;
        }
        let opacity = opacity * task.opacity;
        Some(Shape {
            group: task.group,
            element,
            outline,
            paint,
            opacity,
            stroke,
            line,
        })
    }

    fn image(
        &self,
        index: usize,
        picture: &usvg::Image,
        node: Node<'_, '_>,
        task: &Task<'_>,
    ) -> (Option<Shape>, Option<Box<Diagnostic>>) {
        let element = element(node, self.prepared);
        let transform = self.page * affine(picture.abs_transform());
        let image::Opaque { rings, color } = match image::opaque(picture) {
            Ok(opaque) => opaque,
            Err((code, message)) => {
                let help = "link a smaller picture, or save it again as PNG";
                let finding = Diagnostic::new(code, element.span, message).help(help);
                return (None, Some(Box::new(finding)));
            }
        };
        let rings = rings.into_iter().map(|ring| {
            ring.into_iter()
                .map(|p| transform.transform_point2(p))
                .collect()
        });
        let mut outline = clean(rings.collect(), FillRule::EvenOdd);
        for clip in task.clips.iter().flat_map(|clips| clips.iter()) {
            outline = clip.cut(outline);
        }
        let finding = outline.polygons.is_empty().then(|| {
            let message = format!(
                "nothing opaque is left of the picture {}",
                element.describe()
            );
            let finding = Diagnostic::new(Code::Vanishes, element.span, message);
            Box::new(finding.help("delete it, or show what its clip hides"))
        });
        let paint = Paint {
            key: PaintKey::Picture(index),
            color,
        };
        let opacity = task.opacity;
        (
            Some(Shape {
                group: task.group,
                element,
                outline,
                paint,
                opacity,
                stroke: None,
                line: None,
            }),
            finding,
        )
    }

    fn paint(&self, paint: &usvg::Paint, node: Node<'_, '_>, property: &str) -> Paint {
        let stops = |stops: &[usvg::Stop]| {
            mean(
                stops
                    .iter()
                    .map(|stop| [stop.color().red, stop.color().green, stop.color().blue]),
            )
        };
        let color = match paint {
            usvg::Paint::Color(color) => {
                let color = [color.red, color.green, color.blue];
                return Paint {
                    key: PaintKey::Solid(color),
                    color,
                };
            }
            usvg::Paint::LinearGradient(gradient) => stops(gradient.stops()),
            usvg::Paint::RadialGradient(gradient) => stops(gradient.stops()),
            usvg::Paint::Pattern(pattern) => {
                let mut colors = Vec::new();
                solid_colors(pattern.root(), &mut colors);
                mean(colors.into_iter())
            }
        };
        let id = self.server(node, property).unwrap_or_else(|| match paint {
            usvg::Paint::LinearGradient(gradient) => gradient.id().to_owned(),
            usvg::Paint::RadialGradient(gradient) => gradient.id().to_owned(),
            usvg::Paint::Pattern(pattern) => pattern.id().to_owned(),
            usvg::Paint::Color(_) => String::new(),
        });
        Paint {
            key: PaintKey::Server(id),
            color,
        }
    }

    /// The id at which the chain of links of an element's paint ends.
    fn server(&self, node: Node<'_, '_>, property: &str) -> Option<String> {
        let mut node = node;
        for _ in 0..32 {
            if node.tag_name().name() != "use" {
                break;
            }
            node = self.linked(node)?;
        }
        let value = self.styles.inherited(node, property)?;
        let mut id = value
            .strip_prefix("url(")?
            .split(')')
            .next()?
            .trim_matches(['"', '\'', ' '])
            .strip_prefix('#')?;
        // A link may lead in a circle; nobody chains more gradients than this.
        for _ in 0..32 {
            let server = self.by_attribute_id(id)?;
            match server
                .attributes()
                .find(|attribute| attribute.name() == "href")
            {
                Some(href) => id = href.value().strip_prefix('#')?,
                None => break,
            }
        }
        Some(id.to_owned())
    }

    fn linked(&self, node: Node<'_, '_>) -> Option<Node<'_, '_>> {
        let href = node
            .attributes()
            .find(|attribute| attribute.name() == "href")?
            .value()
            .strip_prefix('#')?
            .to_owned();
        self.by_attribute_id(&href)
    }

    fn by_attribute_id(&self, id: &str) -> Option<Node<'_, '_>> {
        self.document.get_node(*self.by_id.get(id)?)
    }
}

fn solid_colors(group: &usvg::Group, out: &mut Vec<[u8; 3]>) {
    for node in group.children() {
        match node {
            usvg::Node::Group(inner) => solid_colors(inner, out),
            usvg::Node::Path(path) => {
                if let Some(usvg::Paint::Color(color)) = path.fill().map(usvg::Fill::paint) {
                    out.push([color.red, color.green, color.blue]);
                }
            }
            _ => {}
        }
    }
}

fn mean(colors: impl ExactSizeIterator<Item = [u8; 3]>) -> [u8; 3] {
    let count = colors.len().max(1) as f64;
    let sum = colors.fold([0.0; 3], |sum, color| {
        [0, 1, 2].map(|i| sum[i] + f64::from(color[i]))
    });
    sum.map(|channel| (channel / count).round() as u8)
}

/// usvg's transform in f64.
pub(super) fn affine(t: usvg::Transform) -> DAffine2 {
    DAffine2::from_mat2_translation(
        DMat2::from_cols(
            DVec2::new(f64::from(t.sx), f64::from(t.ky)),
            DVec2::new(f64::from(t.kx), f64::from(t.sy)),
        ),
        DVec2::new(f64::from(t.tx), f64::from(t.ty)),
    )
}

/// A path with its transform applied in f64.
pub(super) fn bez_path(path: &skia::Path, transform: DAffine2) -> BezPath {
    let point = |p: skia::Point| {
        let p = transform.transform_point2(DVec2::new(f64::from(p.x), f64::from(p.y)));
        kurbo::Point::new(p.x, p.y)
    };
    let mut out = BezPath::with_capacity(path.verbs().len());
    for segment in path.segments() {
        match segment {
            skia::PathSegment::MoveTo(p) => out.move_to(point(p)),
            skia::PathSegment::LineTo(p) => out.line_to(point(p)),
            skia::PathSegment::QuadTo(a, p) => out.quad_to(point(a), point(p)),
            skia::PathSegment::CubicTo(a, b, p) => out.curve_to(point(a), point(b), point(p)),
            skia::PathSegment::Close => out.close_path(),
        }
    }
    out
}

/// Flattens a path to a share of its larger extent.
pub(super) fn rings(path: &BezPath, tolerance: f64) -> Vec<crate::geometry::Ring> {
    let bounds = path.control_box();
    flatten(path, tolerance * bounds.width().max(bounds.height()))
}

fn open_line(path: &BezPath, node: Node<'_, '_>) -> Option<Box<Line>> {
    let mut ends = None;
    for element in path.elements() {
        match element {
            kurbo::PathEl::MoveTo(p) if ends.is_none() => ends = Some([*p, *p]),
            // A second subpath or a closed one: no leader.
            kurbo::PathEl::MoveTo(_) | kurbo::PathEl::ClosePath => return None,
            other => {
                if let (Some(ends), Some(p)) = (&mut ends, other.end_point()) {
                    ends[1] = p;
                }
            }
        }
    }
    let connects = ["connection-start", "connection-end"].map(|name| {
        let attribute = node
            .attributes()
            .find(|attribute| attribute.name() == name)?;
        attribute.value().strip_prefix('#').map(str::to_owned)
    });
    ends.map(|ends| {
        Box::new(Line {
            ends: ends.map(|p| DVec2::new(p.x, p.y)),
            connects,
        })
    })
}
