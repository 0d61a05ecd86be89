//! The copy of the drawing that is parsed: every shape and group has a unique id, and the outermost
//! `<svg>` is not scaled.
//!
//! usvg knows no source positions, so shapes are joined to the XML by id. Elements without one, and
//! elements that repeat one, are given one here, by byte range. Positions in the copy are mapped back by
//! [`Prepared::original`].

use rustc_hash::{FxHashMap, FxHashSet};
use xmlparser::{ElementEnd, EntityDefinition, Token, Tokenizer};

use super::growth::DRAWN_AGAIN;
use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

/// How deep elements may be nested; usvg's own limit is slightly higher.
pub(super) const MAX_DEPTH: usize = 1000;

/// The prefix of generated ids, unless the drawing itself has ids with that prefix.
pub(super) const ID_PREFIX: &str = "okoshi-";

/// How many characters all entities of a drawing may expand to.
pub(super) const MAX_ENTITY_TEXT: usize = 16 << 20;

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
    /// The text of the drawing's own entities, by name.
    pub entities: FxHashMap<String, String>,
    /// Replacements in order: start in the copy, length there, start in the original, length there.
    replacements: Vec<[usize; 4]>,
}

impl Prepared {
    /// The original offset of the copy's byte `offset`; offsets inside injected text map to its start.
    pub(super) fn original(&self, offset: usize) -> usize {
        let next = self.replacements.partition_point(|[at, ..]| *at <= offset);
        match next.checked_sub(1).map(|last| self.replacements[last]) {
            None => offset,
            Some([at, len, raw, _]) if offset < at + len => raw,
            Some([at, len, raw, raw_len]) => raw + raw_len + (offset - at - len),
        }
    }

    /// The original span of a span in the copy.
    pub(super) fn span(&self, range: std::ops::Range<usize>) -> Span {
        Span::new(self.original(range.start), self.original(range.end))
    }
}

/// A replacement to be made in the original.
struct Replacement {
    span: Span,
    text: String,
}

/// Makes the copy.
///
/// # Errors
///
/// If elements are nested deeper than [`MAX_DEPTH`], or entities expand to more than [`MAX_ENTITY_TEXT`]. Text that is
/// not well-formed is not an error here: from that position on the copy equals the original, and the parser reports the
/// problem.
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
        let Ok(token) = token else { break };
        scan.token(token)?;
    }
    scan.finish()
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
    tag: Tag,
    seen_root: bool,
    draws_again: bool,
    ids: FxHashSet<&'a str>,
    counter: usize,
    replacements: Vec<Replacement>,
    entities: FxHashMap<String, String>,
    entity_text: usize,
}

impl<'a> Scan<'a> {
    fn new(text: &'a str, prefix: &'a str) -> Self {
        Self {
            text,
            prefix,
            depth: 0,
            tag: Tag::default(),
            seen_root: false,
            draws_again: false,
            ids: FxHashSet::default(),
            counter: 0,
            replacements: Vec::new(),
            entities: FxHashMap::default(),
            entity_text: 0,
        }
    }

    fn token(&mut self, token: Token<'a>) -> Result<(), Box<Diagnostic>> {
        match token {
            Token::ElementStart { local, span, .. } => {
                self.depth += 1;
                if self.depth > MAX_DEPTH {
                    let message = format!("elements are nested more than {MAX_DEPTH} deep");
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
                if prefix.as_str().is_empty() {
                    let place = Some(Span::from(value.range()));
                    match local.as_str() {
                        "id" => self.tag.id = place,
                        "width" => self.tag.width = place,
                        "height" => self.tag.height = place,
                        "viewBox" => self.tag.view_box = place,
                        _ => {}
                    }
                }
                self.count_entities(value.as_str(), value.start())?;
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
                self.count_entities(value.as_str(), value.start())?;
                let text = expand(value.as_str(), &self.entities);
                self.entities
                    .entry(name.as_str().to_owned())
                    .or_insert(text);
            }
            Token::Text { text } => self.count_entities(text.as_str(), text.start())?,
            _ => {}
        }
        Ok(())
    }

    /// Adds up the expanded size of the entities in `text`, before they are expanded.
    fn count_entities(&mut self, text: &str, at: usize) -> Result<(), Box<Diagnostic>> {
        if self.entities.is_empty() || !text.contains('&') {
            return Ok(());
        }
        for (name, _) in references(text) {
            self.entity_text += self.entities.get(name).map_or(0, String::len);
            if self.entity_text > MAX_ENTITY_TEXT {
                let message = format!(
                    "the drawing's entities expand to more than {} MiB of text",
                    MAX_ENTITY_TEXT >> 20
                );
                return Err(Box::new(
                    Diagnostic::new(Code::LimitPassed, Span::new(at, at + text.len()), message)
                        .help("save the drawing without entities, as Plain SVG"),
                ));
            }
        }
        Ok(())
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
                if !self.ids.insert(&self.text[span.start..span.end]) {
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

    fn finish(mut self) -> Result<Prepared, Box<Diagnostic>> {
        self.replacements
            .sort_by_key(|replacement| replacement.span.start);
        let grown: usize = self
            .replacements
            .iter()
            .map(|replacement| replacement.text.len())
            .sum();
        let mut text = String::with_capacity(self.text.len() + grown);
        let mut replacements = Vec::with_capacity(self.replacements.len());
        let mut done = 0;
        for Replacement { span, text: new } in &self.replacements {
            text.push_str(&self.text[done..span.start]);
            replacements.push([text.len(), new.len(), span.start, span.end - span.start]);
            text.push_str(new);
            done = span.end;
        }
        text.push_str(&self.text[done..]);
        Ok(Prepared {
            text,
            id_prefix: self.prefix.to_owned(),
            id_count: self.counter,
            draws_again: self.draws_again,
            entities: self.entities,
            replacements,
        })
    }
}

/// The references in `text`: name, and the byte range of `&name;`.
pub(super) fn references(text: &str) -> impl Iterator<Item = (&str, std::ops::Range<usize>)> {
    text.match_indices('&').filter_map(move |(at, _)| {
        let tail = &text[at + 1..];
        let end = tail.find(';')?;
        Some((&tail[..end], at..at + 1 + end + 1))
    })
}

/// `text` with its known references replaced.
fn expand(text: &str, entities: &FxHashMap<String, String>) -> String {
    let mut out = String::new();
    let mut done = 0;
    for (name, range) in references(text) {
        if range.start < done {
            continue;
        }
        out.push_str(&text[done..range.start]);
        match entities
            .get(name)
            .cloned()
            .or_else(|| character(name).map(String::from))
        {
            // Nested entities may multiply; an entity above the limit is rejected where it is used.
            Some(value) if out.len() + value.len() <= 2 * MAX_ENTITY_TEXT => out.push_str(&value),
            _ => out.push_str(&text[range.clone()]),
        }
        done = range.end;
    }
    out.push_str(&text[done..]);
    out
}

/// The character of a predefined or numeric reference.
pub(crate) fn character(name: &str) -> Option<char> {
    match name {
        "amp" => Some('&'),
        "lt" => Some('<'),
        "gt" => Some('>'),
        "quot" => Some('"'),
        "apos" => Some('\''),
        _ => {
            let digits = name.strip_prefix('#')?;
            let code = match digits.strip_prefix('x') {
                Some(hex) => u32::from_str_radix(hex, 16).ok()?,
                None => digits.parse().ok()?,
            };
            char::from_u32(code)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn entity_bombs_and_deep_nesting_are_refused() {
        let mut bomb =
            String::from("<!DOCTYPE svg [<!ENTITY a \"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\">");
        for (name, inner) in ["b", "c", "d", "e", "f", "g"]
            .iter()
            .zip(["a", "b", "c", "d", "e", "f"])
        {
            bomb.push_str(&format!(
                "<!ENTITY {name} \"{}\">",
                format!("&{inner};").repeat(32)
            ));
        }
        bomb.push_str("]><svg><text>&g;</text></svg>");
        assert_eq!(prepare(&bomb).unwrap_err().code, Code::LimitPassed);
        let deep = "<g>".repeat(100_000);
        assert_eq!(
            prepare(&format!("<svg>{deep}")).unwrap_err().code,
            Code::LimitPassed
        );
    }
}
