//! Parts of a drawing as SVG of their own: shapes with the groups, paints and clips that they are drawn with.

use std::fmt::Write as _;

use roxmltree::Node;

use super::links::styled_tree;
use super::prepare::prepare;
use crate::resolver::Resolver;
use crate::source::end_of_tag;

/// Filters are left out: they blur and cast shadows beyond what is cut out.
const STYLE: &str = "* { filter: none !important }";

/// What the ids of definitions begin with, so that they differ from those of the sheet around them.
const PREFIX: &str = "drawn-";

/// Excerpts of a drawing, each with its own shapes only.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Excerpts {
    /// What they refer to: gradients, patterns, clips and masks, the content of a `<defs>` that may use the prefix `xlink`.
    pub definitions: String,
    /// The markup of each, in user units from the page's top left corner.
    pub excerpts: Vec<String>,
}

/// Distributes the shapes of a drawing over `count` excerpts: `excerpt_of` gives the one that a shape is in, by
/// [`Shape::leaf`](super::Shape::leaf). Clones, style sheets and links are resolved. Texts and filters are left out.
///
/// `None` if the drawing cannot be read. Needs a large stack, as [`read`](super::read) does.
pub(crate) fn excerpts(
    text: &str,
    resolver: &dyn Resolver,
    count: usize,
    excerpt_of: impl Fn(usize) -> Option<usize>,
) -> Option<Excerpts> {
    let plain = plain(text, resolver)?;
    let document = roxmltree::Document::parse(&plain).ok()?;
    let mut collector = Collector {
        text: &plain,
        excerpt_of,
        leaves: 0,
        open: Vec::new(),
        written: vec![Written::default(); count],
    };
    let mut definitions = String::new();
    for node in elements(document.root_element()) {
        match node.tag_name().name() {
            "defs" => {
                for definition in elements(node) {
                    definitions.push_str(plain.get(definition.range())?);
                }
            }
            _ => collector.node(node)?,
        }
    }
    Some(Excerpts {
        definitions,
        excerpts: collector.finish(),
    })
}

/// The drawing as usvg writes it: groups, paths and pictures, without styles and references to shapes.
fn plain(text: &str, resolver: &dyn Resolver) -> Option<String> {
    let prepared = prepare(text).ok()?;
    let tree = styled_tree(&prepared.text, STYLE, resolver)?;
    Some(tree.to_string(&usvg::WriteOptions {
        id_prefix: Some(PREFIX.to_owned()),
        indent: usvg::Indent::None,
        ..usvg::WriteOptions::default()
    }))
}

fn elements<'a, 'input>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(Node::is_element)
}

/// The markup of an excerpt so far.
#[derive(Debug, Clone, Default)]
struct Written {
    markup: String,
    /// The groups that are open in it, each with its number in document order.
    open: Vec<usize>,
}

/// A group around the node at hand.
struct OpenGroup {
    number: usize,
    start_tag: String,
}

/// Collects excerpts on one walk through the drawing.
struct Collector<'a, F> {
    text: &'a str,
    excerpt_of: F,
    /// How many shapes were passed.
    leaves: usize,
    open: Vec<OpenGroup>,
    written: Vec<Written>,
}

impl<F: Fn(usize) -> Option<usize>> Collector<'_, F> {
    fn node(&mut self, node: Node<'_, '_>) -> Option<()> {
        if node.tag_name().name() != "g" {
            // As shapes are counted where the drawing is read.
            if node.attribute("visibility").is_none() {
                if let Some(excerpt) = (self.excerpt_of)(self.leaves) {
                    self.take(node, excerpt)?;
                }
                self.leaves += 1;
            }
            return Some(());
        }
        let range = node.range();
        let tag = self.text.get(range.clone())?;
        let tag = tag.get(..end_of_tag(tag, 0)?)?;
        self.open.push(OpenGroup {
            number: range.start,
            start_tag: without_id(node, tag),
        });
        for child in elements(node) {
            self.node(child)?;
        }
        self.open.pop();
        Some(())
    }

    /// Adds a shape to an excerpt, in the groups that it is drawn in.
    fn take(&mut self, node: Node<'_, '_>, excerpt: usize) -> Option<()> {
        let written = self.written.get_mut(excerpt)?;
        let around = self.open.iter().map(|group| group.number);
        let pairs = written.open.iter().copied().zip(around);
        let common = pairs.take_while(|(open, around)| open == around).count();
        for _ in written.open.drain(common..) {
            written.markup.push_str("</g>");
        }
        for group in self.open.get(common..)? {
            written.markup.push_str(&group.start_tag);
            written.open.push(group.number);
        }
        let markup = self.text.get(node.range())?;
        let _ = write!(written.markup, "{}", without_id(node, markup));
        Some(())
    }

    fn finish(self) -> Vec<String> {
        let closed = self.written.into_iter().map(|mut written| {
            written.markup.push_str(&"</g>".repeat(written.open.len()));
            written.markup
        });
        closed.collect()
    }
}

/// The markup of an element, or its start tag, without the element's id: a group can be in several excerpts.
fn without_id(node: Node<'_, '_>, markup: &str) -> String {
    let start = node.range().start;
    let id = node.attribute_node("id").map(|id| id.range());
    match id.and_then(|id| {
        Some((
            markup.get(..id.start - start)?,
            markup.get(id.end - start..)?,
        ))
    }) {
        Some((before, behind)) => format!("{}{behind}", before.trim_end()),
        None => markup.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resolver::{LinkContent, LinkError};

    struct NoFiles;

    impl Resolver for NoFiles {
        fn read(&self, _: &str) -> LinkContent {
            Err(LinkError::Missing)
        }
    }

    #[test]
    fn shapes_keep_their_groups_paints_and_clips() {
        let text = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="-10 0 100 100">
<style>.red { fill: red }</style>
<linearGradient id="g"><stop stop-color="red"/><stop offset="1" stop-color="blue"/></linearGradient>
<clipPath id="c"><rect width="20" height="20"/></clipPath>
<g id="all" transform="translate(5)"><g opacity="0.5"><rect id="a" width="9" height="9" class="red"/></g>
<rect id="hidden" visibility="hidden" width="9" height="9"/>
<rect id="b" width="9" height="9" fill="url(#g)" clip-path="url(#c)" style="filter:blur(2px)"/>
<text>A$</text></g>
<use href="#a" x="30"/></svg>"##;
        let found = excerpts(text, &NoFiles, 2, |leaf| [Some(0), Some(1), Some(0)][leaf]).unwrap();
        let [first, second] = &found.excerpts[..] else {
            panic!("{found:?}");
        };
        assert_eq!(first.matches("<path").count(), 2);
        assert_eq!(first.matches("opacity=\"0.5\"").count(), 1);
        assert_eq!(first.matches("#ff0000").count(), 2);
        assert_eq!(first.matches("<g").count(), first.matches("</g>").count());
        assert!(second.contains("url(#drawn-g)") && second.contains("url(#drawn-c)"));
        assert!(!second.contains(" id=") && !second.contains("filter"));
        for id in ["drawn-g", "drawn-c"] {
            assert!(found.definitions.contains(&format!("id=\"{id}\"")), "{id}");
        }
    }
}
