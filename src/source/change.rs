//! The change between two versions of a drawing's text, and how it moves spans.

use super::{Form, Span, Text};

/// Bytes compared at a time.
const BLOCK: usize = 256;

/// The replacement of one stretch of bytes by another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Change {
    /// Where it begins, in both texts.
    pub start: usize,
    /// Where the replaced bytes end in the old text.
    pub old_end: usize,
    /// Where the new bytes end in the new text.
    pub new_end: usize,
}

impl Change {
    /// Everything between the common head and the common tail of two texts, in whole characters. For equal texts, an
    /// empty change at their end.
    pub fn between(old: &str, new: &str) -> Self {
        let mut start = common_head(old.as_bytes(), new.as_bytes());
        while !(old.is_char_boundary(start) && new.is_char_boundary(start)) {
            start -= 1;
        }
        let mut tail = common_tail(&old.as_bytes()[start..], &new.as_bytes()[start..]);
        while !(old.is_char_boundary(old.len() - tail) && new.is_char_boundary(new.len() - tail)) {
            tail -= 1;
        }
        Self {
            start,
            old_end: old.len() - tail,
            new_end: new.len() - tail,
        }
    }

    /// Whether nothing is removed and nothing inserted.
    pub fn is_empty(self) -> bool {
        self.start == self.old_end && self.start == self.new_end
    }

    /// The new offset of the byte at `offset`, which is behind the change.
    fn behind(self, offset: usize) -> usize {
        offset - self.old_end + self.new_end
    }

    /// The new place of a span that neither begins nor ends inside the change. A span that ends where the change begins
    /// stays; one that begins where the change ends moves along.
    pub fn moved(self, span: Span) -> Span {
        let Span { start, end } = span;
        let moves = start >= self.old_end;
        Span {
            start: if moves { self.behind(start) } else { start },
            end: if end >= self.old_end && (moves || end > self.start) {
                self.behind(end)
            } else {
                end
            },
        }
    }
}

/// The length of the common prefix.
fn common_head(a: &[u8], b: &[u8]) -> usize {
    let blocks = a.chunks_exact(BLOCK).zip(b.chunks_exact(BLOCK));
    let at = BLOCK * blocks.take_while(|(a, b)| a == b).count();
    let rest = a[at..].iter().zip(&b[at..]);
    at + rest.take_while(|(a, b)| a == b).count()
}

/// The length of the common suffix.
fn common_tail(a: &[u8], b: &[u8]) -> usize {
    let blocks = a.rchunks_exact(BLOCK).zip(b.rchunks_exact(BLOCK));
    let tail = BLOCK * blocks.take_while(|(a, b)| a == b).count();
    let rest = a[..a.len() - tail]
        .iter()
        .rev()
        .zip(b[..b.len() - tail].iter().rev());
    tail + rest.take_while(|(a, b)| a == b).count()
}

impl Text {
    /// The plain run of this text, as bytes of the drawing, that contains or touches a change; `None` if there is none.
    pub fn plain_around(&self, change: Change) -> Option<Span> {
        let run = &self.runs[self.run_around(change)?];
        Some(Span::new(run.raw, run.raw + run.raw_len))
    }

    fn run_around(&self, change: Change) -> Option<usize> {
        self.runs.iter().position(|run| {
            run.form == Form::Plain
                && run.raw <= change.start
                && change.old_end <= run.raw + run.raw_len
        })
    }

    /// Whether any of the text lies at the start of a change or behind it.
    pub fn reaches(&self, change: Change) -> bool {
        // Entities are declared before everything else, so the last run need not be the last in the file.
        let mut runs = self.runs.iter().rev();
        runs.any(|run| run.raw + run.raw_len >= change.start)
    }

    /// Applies a change that inserts `inserted`: edits the characters if the change lies in a run of this text (see
    /// [`Text::plain_around`]), and moves all runs behind it.
    pub fn edit(&mut self, change: Change, inserted: &str) {
        let grown = |offset: usize| offset + inserted.len() - (change.old_end - change.start);
        let edited = self.run_around(change);
        if let Some(index) = edited {
            let run = &mut self.runs[index];
            let at = run.at + (change.start - run.raw);
            run.raw_len = grown(run.raw_len);
            self.text
                .replace_range(at..at + (change.old_end - change.start), inserted);
        }
        for (index, run) in self.runs.iter_mut().enumerate() {
            match edited {
                Some(edited) if index <= edited => continue,
                Some(_) => run.at = grown(run.at),
                None => {}
            }
            if run.raw >= change.old_end {
                run.raw = change.behind(run.raw);
            }
        }
        if self.end >= change.old_end {
            self.end = change.behind(self.end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_whole_characters() {
        let change = |old, new| {
            let Change {
                start,
                old_end,
                new_end,
            } = Change::between(old, new);
            (start, old_end, new_end)
        };
        assert_eq!(change("abc", "abxc"), (2, 2, 3));
        assert_eq!(change("abc", "ac"), (1, 2, 1));
        assert_eq!(change("aa", "aaa"), (2, 2, 3));
        assert_eq!(change("aaa", "aa"), (2, 3, 2));
        // These begin with the same bytes, and the next two end with the same byte.
        assert_eq!(change("xあy", "xいy"), (1, 4, 4));
        assert_eq!(change("é", "ĩ"), (0, 2, 2));
        assert!(Change::between("same", "same").is_empty());
        let long = "0123456789".repeat(100);
        let longer = format!("{}x{}", &long[..500], &long[500..]);
        assert_eq!(change(&long, &longer), (500, 500, 501));
    }

    #[test]
    fn a_text_is_edited_in_place() {
        // raw: `ab&amp;cd` then, in another element, `de`
        let text = |c: &str| {
            let grown = c.len() - 2;
            let mut text = Text::default();
            text.push("ab", Span::new(10, 12), Form::Plain);
            text.push("&", Span::new(12, 17), Form::Unit);
            text.push(c, Span::new(17, 19 + grown), Form::Plain);
            text.push("\n", Span::at(19 + grown), Form::Unit);
            text.push("de", Span::new(40 + grown, 42 + grown), Form::Plain);
            text
        };
        for (at, c) in [(17, "あcd"), (18, "cあd"), (19, "cdあ")] {
            let change = Change {
                start: at,
                old_end: at,
                new_end: at + 3,
            };
            let mut edited = text("cd");
            assert_eq!(edited.plain_around(change), Some(Span::new(17, 19)));
            edited.edit(change, "あ");
            assert_eq!(edited, text(c), "{c}");
        }
        let inside_entity = Change {
            start: 14,
            old_end: 15,
            new_end: 14,
        };
        assert_eq!(text("cd").plain_around(inside_entity), None);
    }

    #[test]
    fn neighbors_of_a_change_stay_or_move() {
        let change = Change {
            start: 10,
            old_end: 10,
            new_end: 13,
        };
        assert_eq!(change.moved(Span::new(4, 10)), Span::new(4, 10));
        assert_eq!(change.moved(Span::new(10, 12)), Span::new(13, 15));
        assert_eq!(change.moved(Span::new(4, 12)), Span::new(4, 15));
        assert_eq!(change.moved(Span::at(10)), Span::at(13));
        assert_eq!(change.moved(Span::at(0)), Span::at(0));
    }
}
