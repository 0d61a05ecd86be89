//! The copy of the drawing that is parsed: every shape and group has a unique id, and the outermost
//! `<svg>` is not scaled.
//!
//! usvg knows no source positions, so shapes are joined to the XML by id. Elements without one, and
//! elements that repeat one, are given one here, by byte range. Positions in the copy are mapped back by
//! [`Prepared::original`].
//!
//! Programs write names with spaces as ids (`Right arm`), and browsers find them, but usvg ends a link at a space: in the copy, ids and
//! links to them have another character there, which [`own_id`] takes back.

use std::borrow::Cow;

use rustc_hash::{FxHashMap, FxHashSet};
use xmlparser::{ElementEnd, EntityDefinition, StrSpan, Token, Tokenizer};

use super::entities::Entities;
use super::growth::DRAWN_AGAIN;
use super::replacements::{Positions, Replacement, replaced};
use super::round;
use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;
use crate::threads::nesting_limit;

/// The prefix of generated ids, unless the drawing itself has ids with that prefix.
pub(super) const ID_PREFIX: &str = "okoshi-";

/// What stands for a space in ids: a character for private use, which no other program gives a meaning.
const SPACE: &str = "\u{E020}";

/// The id that an element of the copy has in the drawing.
pub(super) fn own_id(id: &str) -> Cow<'_, str> {
    match id.contains(SPACE) {
        true => id.replace(SPACE, " ").into(),
        false => id.into(),
    }
}

/// How many elements a drawing may have; usvg reads no more.
const MAX_ELEMENTS: usize = 1_000_000;

/// Elements that usvg turns into nodes.
pub(super) const JOINED: &[&str] = &[
    "path", "rect", "g", "circle", "ellipse", "polygon", "use", "image", "line", "polyline", "a",
    "switch", "svg",
];

/// The copy of a drawing's text that is parsed.
#[derive(Debug, Clone)]
pub(super) struct Prepared {
    /// The text of the copy.
    pub text: String,
    /// The prefix of all generated ids.
    pub id_prefix: String,
    /// The largest number after that prefix.
    pub id_count: usize,
    /// Whether there are definitions that are drawn again at each reference.
    pub draws_again: bool,
    /// Whether there are clones.
    pub has_clones: bool,
    /// The text of the drawing's own entities, by name.
    pub entities: FxHashMap<String, String>,
    /// The number of elements in the text, without those in entities.
    element_count: usize,
    /// Where its positions are in the original.
    positions: Positions,
}

impl Prepared {
    /// The original offset of the copy's byte `offset`; offsets inside injected text map to its start.
    pub(super) fn original(&self, offset: usize) -> usize {
        self.positions.original(offset)
    }

    /// The original span of a span in the copy.
    pub(super) fn span(&self, range: std::ops::Range<usize>) -> Span {
        Span::new(self.original(range.start), self.original(range.end))
    }
}

/// Makes the copy.
///
/// # Errors
///
/// If the XML declaration is malformed, elements are nested deeper than [`nesting_limit`], or entities expand to too much
/// text. Other text that is not well-formed is not an error here: from that position on the copy equals the original,
/// and the parser, which knows more about XML, reports the problem.
pub(super) fn prepare(text: &str) -> Result<Prepared, Box<Diagnostic>> {
    let mut prefix = ID_PREFIX.to_owned();
    while ['"', '\'']
        .iter()
        .any(|quote| text.contains(&format!("{quote}{prefix}")))
    {
        prefix.push('-');
    }
    let mut scan = Scan::new(text, &prefix);
    for token in Tokenizer::from(text) {
        match token {
            Ok(token) => scan.token(token)?,
            // The only mistake that the parser overlooks: what follows would be read without ids and without limits.
            Err(xmlparser::Error::InvalidDeclaration(..)) => {
                return Err(Box::new(invalid_declaration(text)));
            }
            Err(_) => break,
        }
    }
    Ok(scan.finish())
}

/// The error of a drawing that begins with a malformed XML declaration.
fn invalid_declaration(text: &str) -> Diagnostic {
    const PLAIN: &str = r#"<?xml version="1.0" encoding="UTF-8"?>"#;
    let start = text.find("<?xml").unwrap_or_default();
    let end = text[start..]
        .find("?>")
        .map_or(text.len(), |end| start + end + 2);
    let span = Span::new(start, end);
    let message = "not well-formed XML: the XML declaration at the beginning is malformed";
    Diagnostic::new(Code::NotXml, span, message)
        .help(format!("write it as `{PLAIN}`, or remove it"))
        .fix(format!("Write `{PLAIN}`"), span, PLAIN)
        .safe()
}

/// Checks that the parsed copy has exactly the elements that were prepared.
///
/// # Errors
///
/// If it has others: those that entities stand for have no ids, and their growth was not counted.
pub(super) fn check_elements(
    document: &roxmltree::Document<'_>,
    prepared: &Prepared,
) -> Result<(), Box<Diagnostic>> {
    let elements = || document.descendants().filter(roxmltree::Node::is_element);
    if elements().count() == prepared.element_count {
        return Ok(());
    }
    let root = document.root_element().range().start;
    let start = elements()
        .map(|node| node.range().start)
        .find(|start| *start < root)
        .unwrap_or(root);
    let message = "an entity stands for elements, which okoshi does not read";
    let place = prepared.original(start);
    Err(Box::new(
        Diagnostic::new(Code::NotXml, Span::new(place, place + 1), message)
            .label("elements in an entity")
            .help("open the drawing in Inkscape and save it as Plain SVG, which has no entities"),
    ))
}

/// The state of the start tag that is being read.
#[derive(Default)]
struct Tag {
    joined: bool,
    outermost: bool,
    name_end: usize,
    id: Option<Span>,
    width: Option<Span>,
    height: Option<Span>,
    view_box: Option<Span>,
}

struct Scan<'a> {
    text: &'a str,
    prefix: &'a str,
    depth: usize,
    depth_limit: usize,
    tag: Tag,
    seen_root: bool,
    draws_again: bool,
    has_clones: bool,
    ids: FxHashSet<&'a str>,
    counter: usize,
    replacements: Vec<Replacement>,
    entities: Entities,
    element_count: usize,
}

impl<'a> Scan<'a> {
    fn new(text: &'a str, prefix: &'a str) -> Self {
        Self {
            text,
            prefix,
            depth: 0,
            depth_limit: nesting_limit(),
            tag: Tag::default(),
            seen_root: false,
            draws_again: false,
            has_clones: false,
            ids: FxHashSet::default(),
            counter: 0,
            replacements: Vec::new(),
            entities: Entities::new(text.len()),
            element_count: 0,
        }
    }

    fn token(&mut self, token: Token<'a>) -> Result<(), Box<Diagnostic>> {
        match token {
            Token::ElementStart { local, span, .. } => {
                self.element_count += 1;
                if self.element_count > MAX_ELEMENTS {
                    let message = format!("the drawing has more than {MAX_ELEMENTS} elements");
                    return Err(Box::new(
                        Diagnostic::new(Code::LimitPassed, span.range().into(), message)
                            .help("split the drawing into several files"),
                    ));
                }
                self.has_clones |= local.as_str() == "use";
                self.depth += 1;
                if self.depth > self.depth_limit {
                    let message =
                        format!("elements are nested more than {} deep", self.depth_limit);
                    return Err(Box::new(
                        Diagnostic::new(Code::LimitPassed, span.range().into(), message)
                            .help("ungroup the drawing a few times"),
                    ));
                }
                self.tag = Tag {
                    joined: JOINED.contains(&local.as_str()),
                    outermost: !self.seen_root,
                    name_end: span.end(),
                    ..Tag::default()
                };
                self.seen_root = true;
                self.draws_again |= DRAWN_AGAIN.contains(&local.as_str());
            }
            Token::Attribute {
                prefix,
                local,
                value,
                ..
            } => {
                if local.as_str() == "href" && value.as_str().trim_start().starts_with('#') {
                    self.join_words(value.range().into());
                }
                if prefix.as_str().is_empty() {
                    let place = Some(Span::from(value.range()));
                    match local.as_str() {
                        "id" => self.tag.id = place,
                        "width" => self.tag.width = place,
                        "height" => self.tag.height = place,
                        "viewBox" => self.tag.view_box = place,
                        name => self.bound(name, value),
                    }
                }
                self.entities.count(value.as_str(), value.start())?;
            }
            Token::ElementEnd { end, .. } => match end {
                ElementEnd::Open => self.end_tag(),
                ElementEnd::Empty => {
                    self.end_tag();
                    self.depth -= 1;
                }
                ElementEnd::Close(..) => self.depth = self.depth.saturating_sub(1),
            },
            Token::EntityDeclaration {
                name,
                definition: EntityDefinition::EntityValue(value),
                ..
            } => {
                self.entities
                    .declare(name.as_str(), value.as_str(), value.start())?;
            }
            Token::Text { text } => self.entities.count(text.as_str(), text.start())?,
            _ => {}
        }
        Ok(())
    }

    /// Replaces a radius that is beyond use.
    fn bound(&mut self, attribute: &str, value: StrSpan<'_>) {
        if !round::ATTRIBUTES.contains(&attribute) {
            return;
        }
        let text = self.entities.expand(value.as_str());
        if let Some(text) = round::bounded(attribute, &text) {
            self.replacements.push(Replacement {
                span: value.range().into(),
                text: text.to_owned(),
            });
        }
    }

    fn end_tag(&mut self) {
        let tag = std::mem::take(&mut self.tag);
        if tag.outermost {
            self.unscale(&tag);
        }
        if !tag.joined {
            return;
        }
        match tag.id {
            Some(span) if span.start < span.end => {
                if self.ids.insert(&self.text[span.start..span.end]) {
                    self.join_words(span);
                } else {
                    let text = self.fresh_id();
                    self.replacements.push(Replacement { span, text });
                }
            }
            Some(span) => {
                let text = self.fresh_id();
                self.replacements.push(Replacement { span, text });
            }
            None => {
                let text = format!(" id=\"{}\"", self.fresh_id());
                self.replacements.push(Replacement {
                    span: Span::at(tag.name_end),
                    text,
                });
            }
        }
    }

    /// Replaces the spaces in an id, or in a link to one, but not those around it.
    fn join_words(&mut self, span: Span) {
        let text = &self.text[span.start..span.end];
        let start = span.start + text.len() - text.trim_start().len();
        for (at, _) in text.trim().match_indices(' ') {
            self.replacements.push(Replacement {
                span: Span::new(start + at, start + at + 1),
                text: SPACE.to_owned(),
            });
        }
    }

    fn fresh_id(&mut self) -> String {
        self.counter += 1;
        format!("{}{}", self.prefix, self.counter)
    }

    /// Sets the page size to the size of its `viewBox`, so that usvg's pixels are user units.
    fn unscale(&mut self, tag: &Tag) {
        let Some(span) = tag.view_box else { return };
        let Ok(view_box) = self.text[span.start..span.end].parse::<svgtypes::ViewBox>() else {
            return;
        };
        for (attribute, length, name) in [
            (tag.width, view_box.w, "width"),
            (tag.height, view_box.h, "height"),
        ] {
            self.replacements.push(match attribute {
                Some(span) => Replacement {
                    span,
                    text: length.to_string(),
                },
                None => Replacement {
                    span: Span::at(tag.name_end),
                    text: format!(" {name}=\"{length}\""),
                },
            });
        }
    }

    fn finish(self) -> Prepared {
        let (text, positions) = replaced(self.text, self.replacements);
        Prepared {
            text,
            id_prefix: self.prefix.to_owned(),
            id_count: self.counter,
            draws_again: self.draws_again,
            has_clones: self.has_clones,
            entities: self.entities.into_texts(),
            element_count: self.element_count,
            positions,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection;
    use proptest::prelude::*;
    use proptest::sample::{self, Index};

    use super::*;
    use crate::law;

    #[test]
    fn ids_of_several_words_can_be_linked_to() {
        let text = r##"<svg><g id="an arm"/><use href=" #an arm "/><use id=" a b " xlink:href="#c"/></svg>"##;
        let prepared = prepare(text).unwrap();
        let copy = &prepared.text;
        assert!(copy.contains("id=\"an\u{E020}arm\""), "{copy}");
        assert!(copy.contains("href=\" #an\u{E020}arm \""), "{copy}");
        assert!(copy.contains("id=\" a\u{E020}b \""), "{copy}");
        assert_eq!(own_id("an\u{E020}arm"), "an arm");
        let use_at = copy.find("<use").expect("the clone");
        assert_eq!(
            prepared.original(use_at),
            text.find("<use").expect("the clone")
        );
    }

    #[test]
    fn ids_are_given_and_repeats_replaced() {
        let text = r#"<svg><g id="a"><rect id="a"/><path d="M0 0"/></g></svg>"#;
        let prepared = prepare(text).unwrap();
        let ids: Vec<_> = prepared.text.match_indices("id=").collect();
        assert_eq!(ids.len(), 4);
        assert_eq!(prepared.text.matches("\"a\"").count(), 1);
        roxmltree::Document::parse(&prepared.text).unwrap();
    }

    #[test]
    fn positions_map_back() {
        let text = r#"<svg width="9mm" viewBox="0 0 20 10"><g><rect/></g><text>x</text></svg>"#;
        let prepared = prepare(text).unwrap();
        for needle in ["<g", "<rect", "<text", ">x<", "</svg>"] {
            let copy = prepared.text.find(needle).unwrap();
            assert_eq!(
                prepared.original(copy),
                text.find(needle).unwrap(),
                "{needle}"
            );
        }
        assert!(
            prepared.text.contains(r#"width="20""#) && prepared.text.contains(r#"height="10""#)
        );
    }

    #[test]
    fn deep_nesting_is_refused() {
        let deep = "<g>".repeat(100_000);
        assert_eq!(
            prepare(&format!("<svg>{deep}")).unwrap_err().code,
            Code::LimitPassed
        );
    }

    const BOMB: &str = r#"<!DOCTYPE svg [<!ENTITY a "0123456789">]>"#;

    /// The diagnostic of a drawing that is not read.
    fn refused(text: &str) -> Diagnostic {
        let (drawing, mut diagnostics) = crate::svg::read(
            text,
            0.001,
            &crate::resolver::MemoryResolver::default(),
            &|_| vec![].into(),
            &|_, _| false,
        );
        assert!(drawing.shapes.is_empty());
        assert_eq!(diagnostics.len(), 1, "{diagnostics:?}");
        diagnostics.remove(0)
    }

    #[test]
    fn a_malformed_declaration_does_not_hide_the_drawing() {
        for declaration in [
            r#"<?xml version="1"?>"#,
            r#"<?xml version="2.0"?>"#,
            r#"<?xml version="1.0" standalone="maybe"?>"#,
            "<?xml ?>",
            "<?xml ",
        ] {
            let text = format!("{declaration}<svg><rect width='9' height='9'/></svg>");
            let diagnostic = refused(&text);
            assert_eq!(diagnostic.code, Code::NotXml, "{declaration}");
            assert_eq!(diagnostic.span.start, 0);
        }
        let fixed = r#"<?xml version="1.0" encoding="UTF-8"?><svg/>"#;
        let text = r#"<?xml version="1"?><svg/>"#;
        let (_, applied) = (
            refused(text),
            crate::diagnostic::applied(text, &refused(text).fixes[0].edits),
        );
        assert_eq!(applied, fixed);
    }

    #[test]
    fn limits_apply_behind_every_declaration() {
        let text = format!(
            "<?xml version='2.0'?>{BOMB}<svg><text>{}</text></svg>",
            "&a;".repeat(200_000)
        );
        assert_eq!(refused(&text).code, Code::NotXml);
        let text = format!("{BOMB}<svg><text>{}</text></svg>", "&a;".repeat(2_000_000));
        prepare(&text).unwrap();
        let long = BOMB.replace("0123456789", &"0123456789".repeat(1000));
        let text = format!("{long}<svg><text>{}</text></svg>", "&a;".repeat(200));
        assert_eq!(refused(&text).code, Code::LimitPassed);
    }

    #[test]
    fn elements_in_entities_are_refused() {
        let text = "<!DOCTYPE svg [<!ENTITY a \"<rect width='9' height='9'/>\">]><svg>&a;</svg>";
        let diagnostic = refused(text);
        assert_eq!(diagnostic.code, Code::NotXml);
        assert_eq!(diagnostic.span.start, text.find("<rect").unwrap());
    }

    /// Pieces of XML that parsers may disagree about.
    const PIECES: &[&str] = &[
        "<",
        ">",
        "/",
        "\"",
        "'",
        "&",
        "&a;",
        "&#x0;",
        "&#60;",
        "<!--",
        "-->",
        "--",
        "<![CDATA[",
        "]]>",
        "<?",
        "?>",
        "<?xml ",
        "<!DOCTYPE svg",
        "[",
        "]",
        "=",
        " ",
        "\n",
        "\u{feff}",
        "\u{0}",
        "\u{1}",
        "\u{ffff}",
        "é",
        ":",
        "xmlns=''",
        "<g>",
        "</g>",
        "<g/>",
        "<!ENTITY b '<g/>'>",
        "&b;",
        "%",
        "1",
        "\u{b7}",
        "xml:",
        "xmlns:",
        "\r",
    ];

    /// What stands in it before places where any characters may be.
    const FREE: &[&str] = &[
        "!-- c", "?pi x", "a = 'b", "CDATA[q", "&#65;", " ]]", "x:g>",
    ];

    const WELL_FORMED: &str = "<?xml version='1.0' encoding='utf-8' standalone='no'?><!DOCTYPE svg PUBLIC 'a' 'b' \
        [<!ENTITY a 'x'><!ENTITY % p SYSTEM 'u'><!ELEMENT q (z)><!-- c --><?pi x?>]><!-- c --><?pi y?><svg \
        xmlns='http://www.w3.org/2000/svg' xmlns:x='u' a = 'b'><x:g><![CDATA[q]]>&a;&amp;&#65; ]]</x:g><rect/></svg>";

    #[test]
    fn what_is_parsed_was_prepared() {
        // Most edits anywhere break the text, so that most only insert something where any characters may be.
        let anywhere = (any::<Index>().prop_map(Err), 0..6_usize);
        let in_text = (sample::select(FREE).prop_map(Ok), Just(0));
        let place = prop_oneof![1 => anywhere, 5 => in_text];
        let edit = (place, sample::select(PIECES));
        law::check(law::config(512), 30, collection::vec(edit, 1..3), |edits| {
            let mut text = WELL_FORMED.to_owned();
            for ((place, removed), piece) in edits {
                let last = text.len();
                let place = match place {
                    Ok(free) => text.find(free).map_or(0, |at| at + free.len()),
                    Err(place) => place.index(last + 1),
                };
                let before = |at: usize| (0..=at.min(last)).rev();
                let start = before(place).find(|at| text.is_char_boundary(*at));
                let start = start.unwrap();
                let end = before(start + removed).find(|at| text.is_char_boundary(*at));
                text.replace_range(start..end.unwrap().max(start), piece);
            }
            let tokenized = Tokenizer::from(text.as_str()).all(|token| token.is_ok());
            let Ok(prepared) = prepare(&text) else {
                return Ok(false);
            };
            let options = roxmltree::ParsingOptions {
                allow_dtd: true,
                ..Default::default()
            };
            let parsed = roxmltree::Document::parse_with_options(&prepared.text, options);
            let Ok(document) = parsed else {
                return Ok(false);
            };
            if check_elements(&document, &prepared).is_err() {
                return Ok(false);
            }
            prop_assert!(tokenized, "{text}");
            let mut joined = document
                .descendants()
                .filter(|node| JOINED.contains(&node.tag_name().name()));
            prop_assert!(joined.all(|node| node.attribute("id").is_some()), "{text}");
            Ok(true)
        });
    }
}
