//! Applies fixes to the text of a drawing.

use super::{Diagnostic, Edit, Fix};
use crate::source::Span;

/// The text with the safe fixes of its diagnostics applied, and the number of diagnostics that were fixed; `None` if there is
/// nothing to apply.
///
/// Of fixes that touch the same place the first is applied: the others may fit after the text has been read again. Bytes
/// outside of the edits stay as they are.
pub fn apply_safe_fixes(text: &str, diagnostics: &[Diagnostic]) -> Option<(String, usize)> {
    let mut edits: Vec<&Edit> = Vec::new();
    let mut count = 0;
    for diagnostic in diagnostics {
        // Of several fixes a person has to choose.
        let [
            Fix {
                edits: own,
                safe: true,
                ..
            },
        ] = diagnostic.fixes.as_slice()
        else {
            continue;
        };
        let touches = |edit: &Edit| edits.iter().any(|other| touch(edit.span, other.span));
        let fits = |edit: &Edit| text.get(edit.span.start..edit.span.end).is_some();
        if own.is_empty() || own.iter().any(touches) || !own.iter().all(fits) {
            continue;
        }
        edits.extend(own);
        count += 1;
    }
    if count == 0 {
        return None;
    }
    edits.sort_by_key(|edit| edit.span);
    Some((applied(text, edits), count))
}

/// A text with edits applied, which are in order and do not overlap.
pub(crate) fn applied<'a>(text: &str, edits: impl IntoIterator<Item = &'a Edit>) -> String {
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    for edit in edits {
        out.push_str(&text[at..edit.span.start]);
        out.push_str(&edit.text);
        at = edit.span.end;
    }
    out.push_str(&text[at..]);
    out
}

fn touch(one: Span, other: Span) -> bool {
    one.start <= other.end && other.start <= one.end
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Code;

    #[test]
    fn edits_never_overlap_and_leave_all_else_alone() {
        let fix = |start: usize, end: usize, text: &str| {
            Diagnostic::new(Code::FullWidth, Span::new(start, end), "x").fix(
                "fix it",
                Span::new(start, end),
                text,
            )
        };
        let text = "abcdef\r\n";
        let findings = [
            fix(3, 4, "D").safe(),
            fix(0, 1, "A").safe(),
            fix(2, 4, "?").safe(),
            fix(5, 6, "?"),
        ];
        assert_eq!(
            apply_safe_fixes(text, &findings),
            Some(("AbcDef\r\n".to_owned(), 2))
        );
        assert_eq!(apply_safe_fixes(text, &findings[3..]), None);
        let choice = fix(0, 1, "A").fix("or so", Span::new(0, 1), "B").safe();
        assert_eq!(apply_safe_fixes(text, &[choice]), None);
    }
}
