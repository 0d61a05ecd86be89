//! Copies of a text with replacements, whose positions are mapped back to the original.

use crate::source::Span;

/// A replacement to be made in the original.
pub(super) struct Replacement {
    /// What is replaced, in the original.
    pub(super) span: Span,
    /// What stands there in the copy.
    pub(super) text: String,
}

/// Where the positions of a copy are in the original. All are byte offsets.
#[derive(Debug, Clone)]
pub(super) struct Positions {
    /// Replacements in order: start in the copy, length there, start in the original, length there.
    replacements: Vec<[usize; 4]>,
}

impl Positions {
    /// The original offset of the copy's byte `offset`; offsets inside replacements map to the start of what was replaced.
    pub(super) fn original(&self, offset: usize) -> usize {
        let next = self.replacements.partition_point(|[at, ..]| *at <= offset);
        match next.checked_sub(1).map(|last| self.replacements[last]) {
            None => offset,
            Some([at, len, raw, _]) if offset < at + len => raw,
            Some([at, len, raw, raw_len]) => raw + raw_len + (offset - at - len),
        }
    }
}

/// The copy of a text with replacements that do not overlap; those at the same place stay in their order.
pub(super) fn replaced(original: &str, mut replacements: Vec<Replacement>) -> (String, Positions) {
    replacements.sort_by_key(|replacement| replacement.span.start);
    let grown: usize = replacements
        .iter()
        .map(|replacement| replacement.text.len())
        .sum();
    let mut text = String::with_capacity(original.len() + grown);
    let mut positions = Vec::with_capacity(replacements.len());
    let mut done = 0;
    for Replacement { span, text: new } in &replacements {
        text.push_str(&original[done..span.start]);
        positions.push([text.len(), new.len(), span.start, span.end - span.start]);
        text.push_str(new);
        done = span.end;
    }
    text.push_str(&original[done..]);
    let replacements = positions;
    (text, Positions { replacements })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_map_back() {
        let replacement = |start, end, text: &str| Replacement {
            span: Span::new(start, end),
            text: text.to_owned(),
        };
        let all = vec![replacement(4, 6, "XYZ"), replacement(2, 2, "++")];
        let (text, positions) = replaced("abcdefgh", all);
        assert_eq!(text, "ab++cdXYZgh");
        let originals = [0, 1, 2, 2, 2, 3, 4, 4, 4, 6, 7];
        for (offset, original) in originals.into_iter().enumerate() {
            assert_eq!(positions.original(offset), original, "{offset}");
        }
    }
}
