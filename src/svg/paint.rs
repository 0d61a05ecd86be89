//! What shapes are painted with (language.md, Paint identity).

use roxmltree::Node;

use super::shapes::Context;
use super::{Paint, PaintKey};

impl Context<'_, '_> {
    pub(super) fn paint(&self, paint: &usvg::Paint, node: Node<'_, '_>, property: &str) -> Paint {
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
