//! The paints of shapes, and when two paints are the same.

use std::sync::Arc;

use glam::{DAffine2, DVec2};
use roxmltree::Node;

use super::paths::affine;
use super::shapes::Context;
use super::{Paint, PaintKey};
use crate::texture::{Focus, Gradient, PaintServer, Source, Spread, Stop};

impl Context<'_, '_> {
    /// The paint of a path; `transform` maps the path to the drawing.
    pub(super) fn paint(
        &self,
        paint: &usvg::Paint,
        node: Node<'_, '_>,
        property: &str,
        transform: DAffine2,
    ) -> Paint {
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
                    server: None,
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
            server: server(paint, transform).map(Arc::new),
        }
    }

    /// The id at the end of the chain of links of an element's paint.
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
        // Links can form a cycle; real chains of gradients are shorter than this.
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
        self.document.get_node(self.by_id.get(id)?)
    }
}

/// Whether nothing can be seen through a paint with this opacity. Patterns may have gaps.
pub(super) fn is_opaque(paint: &usvg::Paint, opacity: usvg::Opacity) -> bool {
    let are_opaque = |stops: &[usvg::Stop]| stops.iter().all(|stop| stop.opacity().get() >= 1.0);
    let is_opaque = match paint {
        usvg::Paint::Color(_) => true,
        usvg::Paint::LinearGradient(gradient) => are_opaque(gradient.stops()),
        usvg::Paint::RadialGradient(gradient) => are_opaque(gradient.stops()),
        usvg::Paint::Pattern(_) => false,
    };
    is_opaque && opacity.get() >= 1.0
}

/// A paint in its own coordinates, and their position in the drawing.
fn server(paint: &usvg::Paint, transform: DAffine2) -> Option<PaintServer> {
    let point = |x: f32, y: f32| DVec2::new(x.into(), y.into());
    let (source, own) = match paint {
        usvg::Paint::Color(_) => return None,
        usvg::Paint::LinearGradient(linear) => {
            let start = point(linear.x1(), linear.y1());
            let along = point(linear.x2(), linear.y2()) - start;
            let own = DAffine2::from_cols(along, along.perp(), start);
            let own = affine(linear.transform()) * own;
            (Source::Linear(gradient(linear)), own)
        }
        usvg::Paint::RadialGradient(radial) => {
            let (center, radius) = (point(radial.cx(), radial.cy()), f64::from(radial.r().get()));
            let focus = (point(radial.fx(), radial.fy()) - center) / radius;
            let focus = Focus {
                x: focus.x,
                y: focus.y,
                radius: f64::from(radial.fr().get()) / radius,
            };
            let own =
                DAffine2::from_translation(center) * DAffine2::from_scale(DVec2::splat(radius));
            let own = affine(radial.transform()) * own;
            (Source::Radial(gradient(radial), focus), own)
        }
        usvg::Paint::Pattern(pattern) => {
            let rect = pattern.rect();
            let own = DAffine2::from_translation(point(rect.x(), rect.y()))
                * DAffine2::from_scale(point(rect.width(), rect.height()));
            let own = affine(pattern.transform()) * own;
            (Source::Pattern(Arc::clone(pattern)), own)
        }
    };
    Some(PaintServer {
        source,
        place: transform * own,
    })
}

fn gradient(gradient: &usvg::BaseGradient) -> Gradient {
    let stop = |stop: &usvg::Stop| {
        let color = stop.color();
        Stop {
            offset: f64::from(stop.offset().get()),
            color: [
                color.red.into(),
                color.green.into(),
                color.blue.into(),
                f64::from(stop.opacity().get()) * 255.0,
            ],
        }
    };
    Gradient {
        stops: gradient.stops().iter().map(stop).collect(),
        spread: match gradient.spread_method() {
            usvg::SpreadMethod::Pad => Spread::Pad,
            usvg::SpreadMethod::Reflect => Spread::Reflect,
            usvg::SpreadMethod::Repeat => Spread::Repeat,
        },
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
