//! Linked pictures, and drawings that usvg rejects.

use std::sync::{Arc, Mutex};

use super::elements::start_tag;
use super::prepare::Prepared;
use crate::diagnostic::{Code, Diagnostic};
use crate::resolver::{LinkError, Resolver};
use crate::source::Span;

pub(super) fn options<'a>(
    resolver: &'a dyn Resolver,
    broken: &'a Mutex<Vec<(String, LinkError)>>,
) -> usvg::Options<'a> {
    let data = usvg::ImageHrefResolver::default_data_resolver();
    usvg::Options {
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: usvg::ImageHrefResolver::default_data_resolver(),
            resolve_string: Box::new(move |href, options| match resolver.read(href) {
                // usvg's own data resolver recognises the format by the first bytes.
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

pub(super) fn unusable(
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
            "with its clones, the drawing has more than a million elements, or it is nested too deep",
        )
        .help("split the drawing into several files"),
        other => Diagnostic::new(Code::NotSvg, tag, format!("the drawing cannot be read: {other}")),
    }
}

pub(super) fn report_links(
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

/// The diagnostic for a broken link.
pub(crate) fn broken_link(link: &str, error: &LinkError, span: Span) -> Diagnostic {
    let (code, help) = match error {
        LinkError::Missing => (
            Code::MissingFile,
            "put the file beside the drawing, or correct its name",
        ),
        LinkError::Outside | LinkError::Absolute | LinkError::Remote => (
            Code::LinkOutside,
            "copy the file into the drawing's folder and link it there, or embed it",
        ),
        LinkError::Unreadable(_) => (Code::MissingFile, "check whether the file can be opened"),
        LinkError::TooLarge { .. } => (Code::LimitPassed, "use a smaller file"),
    };
    Diagnostic::new(code, span, format!("the link `{link}` {error}")).help(help)
}
