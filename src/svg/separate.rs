//! A string of a text as a text element of its own.

use std::sync::Arc;

use roxmltree::Node;

use super::prepare::Prepared;
use super::text::{Anchor, Frame, LINE_HEIGHT, Label, text_width};
use crate::source::{end_of_tag, escape_xml};

impl Label {
    /// The markup of a text element of its own for `content`, which is in this text from the decoded byte `start` on: in the same
    /// place, and looking the same. `None` if this text is flowed.
    pub fn as_own_element(&self, start: usize, content: &str) -> Option<String> {
        let name = self.start_tag.split(char::is_whitespace).next()?;
        if name.is_empty() || self.start_tag.contains("shape-inside") {
            return None;
        }
        let before = self.text.as_str().get(..start)?;
        let mut lines = before.matches('\n').count() as f64;
        let on_line = before.rsplit('\n').next().unwrap_or_default();
        let Frame { base, size, .. } = self.frame;
        let mut x = base.x;
        match self.frame.anchor {
            Anchor::Start => x += text_width(on_line) * size,
            // Centred lines would overlap.
            _ if !on_line.trim().is_empty() => lines += 1.0,
            _ => {}
        }
        let y = base.y + lines * LINE_HEIGHT * size;
        let round = |value: f64| (value * 1e3).round() / 1e3;
        let (x, y) = (round(x), round(y));
        let attributes = attributes_without(&self.start_tag[name.len()..], PLACED);
        let content = escape_xml(content);
        let prefix = name.strip_suffix("text")?;
        let content = if attributes.contains("font-size") {
            content
        } else {
            format!(
                "<{prefix}tspan style=\"font-size:{}px\">{content}</{prefix}tspan>",
                round(size)
            )
        };
        Some(format!(
            "<{name}{attributes} x=\"{x}\" y=\"{y}\">{content}</{name}>"
        ))
    }
}

/// The attributes that only one element may have, or that place it.
const PLACED: &[&str] = &[
    "id",
    "x",
    "y",
    "dx",
    "dy",
    "rotate",
    "textLength",
    "aria-label",
];

/// The attributes of a start tag but for some of them, as they are written.
fn attributes_without(tag: &str, left_out: &[&str]) -> String {
    let mut out = String::new();
    let mut rest = tag.trim_start();
    while let Some((name, after)) = rest.split_once('=') {
        let after = after.trim_start();
        let Some(quote) = after.chars().next().filter(|c| matches!(c, '"' | '\'')) else {
            break;
        };
        let Some((value, tail)) = after[1..].split_once(quote) else {
            break;
        };
        let name = name.trim();
        if !left_out.contains(&name) {
            out.push_str(&format!(" {name}={quote}{value}{quote}"));
        }
        rest = tail.trim_start();
    }
    out
}

/// The start tag of a `<text>` without its brackets; empty for other elements.
pub(super) fn start_tag_of(node: Node<'_, '_>, prepared: &Prepared) -> Arc<str> {
    let source = &prepared.text[node.range()];
    match end_of_tag(source, 1) {
        Some(end) if node.tag_name().name() == "text" => {
            source[1..end - 1].trim_end_matches('/').into()
        }
        _ => "".into(),
    }
}
