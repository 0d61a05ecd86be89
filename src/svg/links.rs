//! Linked pictures, and drawings that usvg rejects.

use std::sync::{Arc, Mutex};

use super::elements::start_tag;
use super::fit::{EMBEDDED, ImageViewports, Origin};
use super::prepare::Prepared;
use crate::diagnostic::{Code, Diagnostic};
use crate::resolver::{LinkError, Resolver};
use crate::source::Span;

/// Why a picture is not shown.
#[derive(Debug)]
pub(super) enum Unshown {
    /// Its link cannot be followed.
    Broken(String, LinkError),
    /// It does not fit into the place with this link or data URI.
    TooNarrow(String),
}

/// How many bytes of linked pictures are kept of a drawing.
pub(crate) const MAX_KEPT: usize = 8 << 20;

/// A picture that a drawing links to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LinkedPicture {
    /// The link, as the drawing has it.
    pub link: String,
    /// The file; `None` if all pictures together would be larger than 8 MiB.
    pub bytes: Option<Arc<[u8]>>,
}

/// What is noted while usvg reads pictures.
#[derive(Debug, Default)]
pub(super) struct Noted {
    pub(super) unshown: Vec<Unshown>,
    /// The pictures that are shown, each link once.
    pub(super) linked: Vec<LinkedPicture>,
}

impl Noted {
    fn keep(&mut self, link: &str, bytes: Arc<[u8]>) {
        if self.linked.iter().any(|picture| picture.link == link) {
            return;
        }
        let kept = self.linked.iter().flat_map(|picture| &picture.bytes);
        let sum: usize = kept.map(|bytes| bytes.len()).sum();
        self.linked.push(LinkedPicture {
            link: link.to_owned(),
            bytes: (sum + bytes.len() <= MAX_KEPT).then_some(bytes),
        });
    }
}

/// What usvg reads from a drawing with one more style sheet. What it cannot show is left out.
pub(super) fn styled_tree(text: &str, style: &str, resolver: &dyn Resolver) -> Option<usvg::Tree> {
    let document = roxmltree::Document::parse_with_options(text, parsing()).ok()?;
    let noted = Mutex::default();
    let viewports = ImageViewports::of(&document);
    let options = usvg::Options {
        style_sheet: Some(style.to_owned()),
        ..options(resolver, &viewports, &noted)
    };
    usvg::Tree::from_xmltree(&document, &options).ok()
}

/// How drawings are parsed: those of Illustrator have entities.
pub(super) fn parsing<'input>() -> roxmltree::ParsingOptions<'input> {
    roxmltree::ParsingOptions {
        allow_dtd: true,
        ..Default::default()
    }
}

pub(super) fn options<'a>(
    resolver: &'a dyn Resolver,
    viewports: &'a ImageViewports<'_>,
    noted: &'a Mutex<Noted>,
) -> usvg::Options<'a> {
    // usvg's own data resolver recognises the format by the first bytes.
    let read = usvg::ImageHrefResolver::default_data_resolver();
    let read_embedded = usvg::ImageHrefResolver::default_data_resolver();
    let leave_out = |why| {
        if let Ok(mut noted) = noted.lock() {
            noted.unshown.push(why);
        }
        None
    };
    usvg::Options {
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(move |media_type, bytes, options| {
                let picture = read_embedded(media_type, Arc::clone(&bytes), options)?;
                match viewports.misfit(Origin::Embedded(&bytes), &picture) {
                    None => Some(picture),
                    Some(link) => leave_out(Unshown::TooNarrow(link)),
                }
            }),
            resolve_string: Box::new(move |href, options| match resolver.read(href) {
                Ok(bytes) => {
                    let picture = read("text/plain", Arc::new(bytes.to_vec()), options)?;
                    match viewports.misfit(Origin::Link(href), &picture) {
                        None => {
                            if let Ok(mut noted) = noted.lock() {
                                noted.keep(href, bytes);
                            }
                            Some(picture)
                        }
                        Some(link) => leave_out(Unshown::TooNarrow(link)),
                    }
                }
                Err(error) => leave_out(Unshown::Broken(href.to_owned(), error)),
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

/// Reports the pictures that are not shown.
pub(super) fn report_links(
    document: &roxmltree::Document<'_>,
    prepared: &Prepared,
    unshown: Vec<Unshown>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    for why in unshown {
        let (Unshown::Broken(link, _) | Unshown::TooNarrow(link)) = &why;
        let images = document
            .descendants()
            .filter(|node| node.tag_name().name() == "image");
        let attribute = images
            .flat_map(|node| node.attributes().collect::<Vec<_>>())
            .find(|attribute| attribute.name() == "href" && attribute.value() == link);
        let span = attribute.map_or(Span::at(0), |attribute| {
            prepared.span(attribute.range_value())
        });
        diagnostics.push(match &why {
            Unshown::Broken(link, error) => broken_link(link, error, span),
            Unshown::TooNarrow(link) => too_narrow(link, span),
        });
    }
}

fn too_narrow(link: &str, span: Span) -> Diagnostic {
    let picture = if link.trim_start().starts_with(EMBEDDED) {
        "an embedded picture".to_owned()
    } else {
        format!("the picture `{link}`")
    };
    let message = format!(
        "{picture} is too narrow to be shown: fitted into its width and height, one of its sides has no length"
    );
    Diagnostic::new(Code::Vanishes, span, message).help(
        "crop the picture, give it more width and height, or set its preserveAspectRatio to none",
    )
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
