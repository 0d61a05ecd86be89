//! New shapes: what is written for them, and where.

use glam::{DAffine2, DVec2};
use roxmltree::Node;

use super::{NewShape, color, digits, element_at, is_near_page, path, space_before, step, written};
use crate::bind::PartKind;
use crate::diagnostic::Edit;
use crate::ide::changes::poses::Ids;
use crate::ide::changes::{Analysis, Refusal};
use crate::source::{Span, end_of_tag};
use crate::svg::{self, GroupId, GroupKind, ShapeId};

/// What is smaller than this share of the page both ways is a slip of the hand.
const LEAST: f64 = 1.0 / 500.0;

/// Where a new element is written.
struct Spot {
    span: Span,
    /// What is written before it and behind it.
    around: [String; 2],
    /// From the coordinates in which it is placed to those of the drawing.
    transform: DAffine2,
}

impl Analysis {
    /// Adds a shape in front of all others in the layer of the front-most part.
    pub(in crate::ide::changes) fn draw(
        &self,
        shape: &NewShape,
        fill: &str,
    ) -> Result<Vec<Edit>, Refusal> {
        let fill = color(fill)?;
        self.check_size(shape)?;
        let spot = self.spot()?;
        let scale = spot.transform.matrix2.determinant().abs().sqrt();
        let inverse = spot.transform.inverse();
        if !(scale > 0.0 && inverse.is_finite()) {
            return Err(Refusal::new(
                "the layer of the drawing is scaled to nothing: draw on another layer",
            ));
        }
        let digits = digits(step(self.drawing()) / scale);
        let (tag, attributes) = described(shape, inverse, digits)?;
        let id = Ids::new(self).free(tag);
        let prefix = self.svg_prefix();
        let [before, after] = &spot.around;
        Ok(vec![Edit {
            span: spot.span,
            text: format!(
                "{before}<{prefix}{tag} id=\"{id}\" style=\"fill:{fill};stroke:none\"{attributes} />{after}"
            ),
        }])
    }

    /// Refuses what nobody would see.
    fn check_size(&self, shape: &NewShape) -> Result<(), Refusal> {
        let drawing = self.drawing();
        let (low, high, area) = match *shape {
            NewShape::Path(ref data) => {
                let path = path::closed(data)?;
                let (low, high) = path::bounds(&path);
                (low, high, path::area(&path))
            }
            NewShape::Ellipse([x, y, rx, ry]) => {
                let (center, radii) = (DVec2::new(x, y), DVec2::new(rx, ry));
                (center - radii, center + radii, rx.min(ry))
            }
            NewShape::Rect([x, y, width, height]) => {
                let (one, other) = (DVec2::new(x, y), DVec2::new(x + width, y + height));
                let (low, high) = (one.min(other), one.max(other));
                (low, high, (high - low).min_element())
            }
        };
        if !is_near_page(drawing, low) || !is_near_page(drawing, high) {
            return Err(Refusal::new(
                "the shape would lie far outside the page: draw it on the page",
            ));
        }
        let least = LEAST * drawing.page.1.max_element();
        if (high - low).max_element() < least || area <= 0.0 {
            return Err(Refusal::new(
                "the shape is too small to be seen: draw it larger",
            ));
        }
        Ok(())
    }

    /// The prefix of the elements of SVG, with its colon.
    fn svg_prefix(&self) -> &str {
        let root = self.drawing().groups[GroupId::ROOT].element.span;
        let name = self.source.get(root.start + 1..root.end);
        name.and_then(|name| name.strip_suffix("svg"))
            .unwrap_or_default()
    }

    fn spot(&self) -> Result<Spot, Refusal> {
        let document = self.document()?;
        let bindings = self.bindings();
        let is_drawn = |kind: PartKind| matches!(kind, PartKind::Main | PartKind::Sub);
        let drawn = bindings.parts.iter().filter(|part| is_drawn(part.kind));
        if let Some(front) = drawn.map(|part| part.shape).max() {
            let start = self.child_of_layer(front);
            return Ok(self.behind(element_at(&document, start)?));
        }
        let shown = || {
            let all = document.root_element().descendants();
            all.filter(|node| is_layer(*node) && is_shown(*node))
        };
        let is_bare = |layer: &Node<'_, '_>| {
            let mut inside = layer.descendants().filter(Node::is_element);
            !inside.any(|node| matches!(node.tag_name().name(), "text" | "desc" | "flowRoot"))
        };
        let layer = shown().find(is_bare).or_else(|| shown().next());
        self.last_in(layer.unwrap_or(document.root_element()))
    }

    /// The element of a shape, or of a group around it, that lies in a layer, or in none.
    fn child_of_layer(&self, shape: ShapeId) -> usize {
        let drawing = self.drawing();
        let shape = &drawing.shapes[shape];
        let mut start = shape.element.span.start;
        let mut group = shape.group;
        while drawing.groups[group].kind == GroupKind::Group {
            start = drawing.groups[group].element.span.start;
            group = drawing.groups[group].parent;
        }
        start
    }

    /// The place behind an element, on a line of its own if that has one.
    fn behind(&self, node: Node<'_, '_>) -> Spot {
        let Span { start, end } = node.range().into();
        let around = svg::transforms_around(&self.source, &[start]);
        Spot {
            span: Span::at(end),
            around: [space_before(&self.source, start).to_owned(), String::new()],
            transform: around.first().copied().flatten().unwrap_or_default(),
        }
    }

    /// The place in front of all that is in an element; its elements are no shapes.
    fn last_in(&self, node: Node<'_, '_>) -> Result<Spot, Refusal> {
        let source = &*self.source;
        let Span { start, end } = node.range().into();
        let own = match space_before(source, start) {
            // The outermost element may begin the file.
            "" if node.parent_element().is_none() => "\n",
            space => space,
        };
        let open = end_of_tag(source, start).unwrap_or(end);
        let line = if own.is_empty() { "" } else { "  " };
        let before = format!("{own}{line}");
        let (span, around) = if source[..open].ends_with("/>") {
            let mut words = source[start + 1..].split(|c: char| c.is_whitespace() || c == '/');
            let name = words.next().unwrap_or_default();
            (
                Span::new(open - "/>".len(), open),
                [format!(">{before}"), format!("{own}</{name}>")],
            )
        } else {
            let last = node.children().rfind(Node::is_element);
            let at = last.map_or(open, |last| last.range().end);
            let is_empty = last.is_none() && !source[open..end].starts_with(char::is_whitespace);
            let after = if is_empty { own } else { "" };
            (Span::at(at), [before, after.to_owned()])
        };
        Ok(Spot {
            span,
            around,
            transform: svg::transform_inside(source, start).unwrap_or_default(),
        })
    }
}

fn is_layer(node: Node<'_, '_>) -> bool {
    let mut attributes = node.attributes();
    node.tag_name().name() == "g"
        && attributes.any(|one| one.name() == "groupmode" && one.value() == "layer")
}

/// Whether what is drawn in a layer is seen, and may be changed.
fn is_shown(layer: Node<'_, '_>) -> bool {
    let is_hidden = |node: Node<'_, '_>| {
        let style: String = node
            .attribute("style")
            .unwrap_or_default()
            .split_whitespace()
            .collect();
        style.contains("display:none")
            || node.attribute("display") == Some("none")
            || matches!(
                node.tag_name().name(),
                "defs" | "symbol" | "clipPath" | "mask" | "pattern"
            )
            || node
                .attributes()
                .any(|one| one.name() == "insensitive" && one.value() == "true")
    };
    !layer.ancestors().any(is_hidden)
}

/// The tag of a shape and its other attributes.
fn described(
    shape: &NewShape,
    inverse: DAffine2,
    digits: usize,
) -> Result<(&'static str, String), Refusal> {
    let number = |value: f64| written(value, digits);
    // Along the axes, numbers are enough; else the shape takes a transform of its own.
    let [along, across] = [inverse.matrix2.x_axis, inverse.matrix2.y_axis];
    let is_straight = along.y.abs() < 1e-9 && across.x.abs() < 1e-9;
    let (scale, shift, transform) = if is_straight {
        (
            DVec2::new(along.x, across.y),
            inverse.translation,
            String::new(),
        )
    } else {
        let [a, b, c, d, e, f] = inverse.to_cols_array().map(|one| written(one, 9));
        let transform = format!(" transform=\"matrix({a},{b},{c},{d},{e},{f})\"");
        (DVec2::ONE, DVec2::ZERO, transform)
    };
    Ok(match *shape {
        NewShape::Path(ref data) => {
            let data = path::data(&path::closed(data)?, inverse, digits);
            ("path", format!(" d=\"{data}\""))
        }
        NewShape::Ellipse([x, y, rx, ry]) => {
            let center = scale * DVec2::new(x, y) + shift;
            let radii = (scale * DVec2::new(rx, ry)).abs();
            let [x, y, rx, ry] = [center.x, center.y, radii.x, radii.y].map(number);
            if rx == ry {
                (
                    "circle",
                    format!(" cx=\"{x}\" cy=\"{y}\" r=\"{rx}\"{transform}"),
                )
            } else {
                let attributes =
                    format!(" cx=\"{x}\" cy=\"{y}\" rx=\"{rx}\" ry=\"{ry}\"{transform}");
                ("ellipse", attributes)
            }
        }
        NewShape::Rect([x, y, width, height]) => {
            let one = scale * DVec2::new(x, y) + shift;
            let other = scale * DVec2::new(x + width, y + height) + shift;
            let (corner, size) = (one.min(other), (other - one).abs());
            let [x, y, width, height] = [corner.x, corner.y, size.x, size.y].map(number);
            let attributes =
                format!(" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"{transform}");
            ("rect", attributes)
        }
    })
}
