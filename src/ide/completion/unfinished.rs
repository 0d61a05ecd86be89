//! What the characters before the cursor leave open.

use crate::lang::ast::{ArgumentKind, Attribute};
use crate::lang::keyword::Keyword;
use crate::lang::keyword::kinds::KINDS;
use crate::lang::{motion, normalize};

/// The offset of a quote that is not closed.
pub(super) fn open_quote(head: &str) -> Option<usize> {
    let mut open = None;
    for (at, c) in head.char_indices() {
        if matches!(c, '"' | '＂') {
            open = match open {
                None => Some(at),
                Some(_) => None,
            };
        }
    }
    open
}

/// Whether there is a parenthesis that is not closed.
pub(super) fn open_parenthesis(head: &str) -> bool {
    let mut depth = 0_usize;
    for c in normalize(head).chars() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    depth > 0
}

/// Whether an attribute is complete, so that another can follow.
pub(super) fn can_end(attribute: &Attribute) -> bool {
    let count = attribute.arguments.len();
    let kind = match attribute.arguments.first().map(|first| &first.kind) {
        Some(ArgumentKind::Word(word)) if attribute.keyword == Keyword::Shape => KINDS
            .iter()
            .find(|kind| kind.name.eq_ignore_ascii_case(word)),
        _ => None,
    };
    match kind {
        Some(kind) => kind.form.accepts(count - 1),
        None if attribute.keyword == Keyword::Motion => motion::is_complete(&attribute.arguments),
        None => {
            let forms = attribute.keyword.row().forms;
            forms.iter().any(|form| form.accepts(count))
        }
    }
}
