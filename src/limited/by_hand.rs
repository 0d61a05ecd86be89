//! Drawings that are chosen by hand: how long each stands in the sheet.

use super::exposure::{Drawing, Exposure};
use super::{Cut, Hold};

/// A drawing that is chosen by hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Chosen {
    /// Its source frame.
    pub source: u32,
    /// For how many frames it stands; 0 leaves it out.
    pub frames: usize,
}

/// Why a drawing does not stand as chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Conflict {
    /// The source has no such frame.
    Missing,
    /// The first drawing cannot be left out: nothing would be shown.
    First,
    /// It is left out without that.
    LeftOut,
    /// It is left out, and the drawings beside it stand for one frame each: none is left for it.
    NoRoom,
    /// A drawing before it stands for so long that nothing is left of it.
    Covered,
    /// The last drawing stands until the end, for so many frames.
    UntilTheEnd(usize),
    /// The key pose of a performance would not stand in its frame.
    Key,
}

/// A sheet in which some drawings stand as chosen, in ascending order of their source frames, and what could not be done, by the
/// index of the choice.
///
/// The clip keeps its length, and drawings their order. First, drawings of 0 frames are left out: the one before stands for longer.
/// Then drawings that the sheet does not have come back, in the last frame of the drawing before; if that stands for one frame only, in
/// the first frame of the drawing behind. At last each drawing, from the front on, stands for as many frames as chosen: it covers
/// what comes behind it, or that begins sooner. A choice after which the source frame `key` would not be shown in its frame any more,
/// if it is there before, is not done.
pub(crate) fn by_hand(
    cut: &Cut,
    chosen: &[Chosen],
    sources: usize,
    key: Option<usize>,
) -> (Cut, Vec<(usize, Conflict)>) {
    let mut sheet = Sheet {
        drawings: cut.exposure.drawings().collect(),
        frames: cut.exposure.len(),
    };
    let key = key.filter(|key| sheet.shown_at(*key) == Some(*key as u32));
    let mut conflicts = Vec::new();
    let steps = [Sheet::leave_out, Sheet::put_back, Sheet::hold] as [Step; 3];
    let mut refused = vec![false; chosen.len()];
    for step in steps {
        for (index, one) in chosen.iter().enumerate() {
            if refused[index] {
                continue;
            }
            let before = sheet.clone();
            let done = match (one.source as usize) < sources {
                true => step(&mut sheet, *one),
                false => Err(Conflict::Missing),
            };
            let moves_key = key.is_some_and(|key| sheet.shown_at(key) != Some(key as u32));
            let done = if moves_key { Err(Conflict::Key) } else { done };
            if let Err(conflict) = done {
                refused[index] = true;
                conflicts.push((index, conflict));
                // The last drawing stands until the end all the same.
                if !matches!(conflict, Conflict::UntilTheEnd(_)) {
                    sheet = before;
                }
            }
        }
    }
    conflicts.sort_by_key(|(index, _)| *index);
    (sheet.cut(cut, chosen), conflicts)
}

/// Does what it does of a choice.
type Step = fn(&mut Sheet, Chosen) -> Result<(), Conflict>;

/// The drawings of a sheet, in ascending order of their source frames.
#[derive(Clone)]
struct Sheet {
    drawings: Vec<Drawing>,
    /// The number of shown frames.
    frames: usize,
}

impl Sheet {
    fn position(&self, source: u32) -> Result<usize, usize> {
        self.drawings
            .binary_search_by_key(&source, |drawing| drawing.source)
    }

    fn shown_at(&self, frame: usize) -> Option<u32> {
        let behind = self
            .drawings
            .partition_point(|drawing| drawing.start <= frame);
        let drawing = self.drawings.get(behind.checked_sub(1)?)?;
        (frame < self.frames).then_some(drawing.source)
    }

    fn leave_out(&mut self, chosen: Chosen) -> Result<(), Conflict> {
        if chosen.frames > 0 {
            return Ok(());
        }
        match self.position(chosen.source) {
            Ok(0) => Err(Conflict::First),
            Ok(at) => {
                let gone = self.drawings.remove(at);
                self.drawings[at - 1].length += gone.length;
                Ok(())
            }
            Err(_) => Err(Conflict::LeftOut),
        }
    }

    fn put_back(&mut self, chosen: Chosen) -> Result<(), Conflict> {
        let Err(at) = self.position(chosen.source) else {
            return Ok(());
        };
        if chosen.frames == 0 {
            return Ok(());
        }
        let place = |start| Drawing {
            source: chosen.source,
            start,
            length: 1,
        };
        let (before, behind) = self.drawings.split_at_mut(at);
        match (before.last_mut(), behind.first_mut()) {
            (Some(before), _) if before.length > 1 => {
                before.length -= 1;
                let start = before.start + before.length;
                self.drawings.insert(at, place(start));
            }
            (_, Some(behind)) if behind.length > 1 => {
                let start = behind.start;
                behind.start += 1;
                behind.length -= 1;
                self.drawings.insert(at, place(start));
            }
            _ => return Err(Conflict::NoRoom),
        }
        Ok(())
    }

    fn hold(&mut self, chosen: Chosen) -> Result<(), Conflict> {
        if chosen.frames == 0 {
            return Ok(());
        }
        let at = self
            .position(chosen.source)
            .map_err(|_| Conflict::Covered)?;
        let start = self.drawings[at].start;
        let is_last = at + 1 == self.drawings.len();
        let end = start.saturating_add(chosen.frames);
        if end > self.frames || (is_last && end < self.frames) {
            self.drawings.truncate(at + 1);
            self.drawings[at].length = self.frames - start;
            return Err(Conflict::UntilTheEnd(self.frames - start));
        }
        let covered = |drawing: &Drawing| drawing.start + drawing.length <= end;
        let next = self.drawings[at + 1..]
            .iter()
            .position(|drawing| !covered(drawing))
            .map_or(self.drawings.len(), |next| at + 1 + next);
        self.drawings.drain(at + 1..next);
        self.drawings[at].length = chosen.frames;
        if let Some(next) = self.drawings.get_mut(at + 1) {
            next.length = next.start + next.length - end;
            next.start = end;
        }
        Ok(())
    }

    /// The cut with these drawings. What is not shown any more counts as omitted if that is chosen, else as held.
    fn cut(self, before: &Cut, chosen: &[Chosen]) -> Cut {
        let is_shown = |source: &u32| self.position(*source).is_ok();
        let by = |covered: u32| {
            let behind = self
                .drawings
                .partition_point(|drawing| drawing.source < covered);
            self.drawings[..behind].last().map(|drawing| drawing.source)
        };
        let (mut omitted, mut held) = (before.omitted.clone(), before.held.clone());
        omitted.retain(|source| !is_shown(source));
        held.retain(|hold| !is_shown(&hold.covered));
        let gone = before.exposure.drawings().map(|drawing| drawing.source);
        for source in gone.filter(|source| !is_shown(source)) {
            let is_chosen = chosen
                .iter()
                .any(|one| one.source == source && one.frames == 0);
            match by(source) {
                Some(by) if !is_chosen => held.push(Hold {
                    covered: source,
                    by,
                }),
                _ => omitted.push(source),
            }
        }
        let sources = self
            .drawings
            .iter()
            .flat_map(|drawing| std::iter::repeat_n(drawing.source, drawing.length));
        Cut {
            exposure: Exposure::new(sources.collect()),
            omitted,
            held,
            ..before.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::limited::{Length, Options, Poses, limit};
    use glam::DVec3;

    /// A clip of so many frames whose steps differ, limited.
    fn cut(frames: usize, omit: usize, hold: usize) -> Cut {
        let points: Vec<DVec3> = (0..frames)
            .map(|frame| DVec3::X * (frame as f64 + ((frame * frame) % 7) as f64 * 0.1))
            .collect();
        let options = Options {
            omit,
            hold,
            length: Length::Kept,
        };
        limit(Poses::new(&points, 1), &options)
    }

    fn runs(cut: &Cut) -> Vec<[usize; 2]> {
        let drawings = cut.exposure.drawings();
        drawings
            .map(|drawing| [drawing.source as usize, drawing.length])
            .collect()
    }

    fn chosen(pairs: &[[usize; 2]]) -> Vec<Chosen> {
        let pairs = pairs.iter();
        pairs
            .map(|[source, frames]| Chosen {
                source: *source as u32,
                frames: *frames,
            })
            .collect()
    }

    #[test]
    fn drawings_stand_as_chosen() {
        let full = cut(8, 0, 0);
        for (pairs, expected, conflicts) in [
            (
                vec![[2, 3]],
                vec![[0, 1], [1, 1], [2, 3], [5, 1], [6, 1], [7, 1]],
                vec![],
            ),
            (
                vec![[2, 0], [3, 2]],
                vec![[0, 1], [1, 2], [3, 2], [5, 1], [6, 1], [7, 1]],
                vec![],
            ),
            // One that is covered first is back, but not for as long.
            (
                vec![[1, 4], [3, 2]],
                vec![[0, 1], [1, 4], [5, 1], [6, 1], [7, 1]],
                vec![(1, Conflict::Covered)],
            ),
            (vec![[0, 8]], vec![[0, 8]], vec![]),
            (
                vec![[0, 0], [6, 3], [9, 2]],
                vec![[0, 1], [1, 1], [2, 1], [3, 1], [4, 1], [5, 1], [6, 2]],
                vec![
                    (0, Conflict::First),
                    (1, Conflict::UntilTheEnd(2)),
                    (2, Conflict::Missing),
                ],
            ),
            (
                vec![[7, 0]],
                vec![[0, 1], [1, 1], [2, 1], [3, 1], [4, 1], [5, 1], [6, 2]],
                vec![],
            ),
        ] {
            let (cut, found) = by_hand(&full, &chosen(&pairs), 8, None);
            assert_eq!(runs(&cut), expected, "{pairs:?}");
            assert_eq!(found, conflicts, "{pairs:?}");
        }
        // A key pose stays where it is.
        let (kept, found) = by_hand(&full, &chosen(&[[2, 3], [5, 1]]), 8, Some(4));
        assert_eq!(
            (runs(&kept), found),
            (runs(&full), vec![(0, Conflict::Key)])
        );
    }

    #[test]
    fn a_drawing_that_was_left_out_comes_back() {
        let limited = cut(12, 0, 4);
        let before = runs(&limited);
        let at = before.iter().position(|[_, length]| *length > 1).unwrap();
        let [source, length] = before[at];
        let (back, found) = by_hand(&limited, &chosen(&[[source + 1, 1]]), 12, None);
        assert_eq!(found, []);
        assert_eq!(
            runs(&back)[at..at + 2],
            [[source, length - 1], [source + 1, 1]]
        );
        let covered: Vec<u32> = back.held.iter().map(|hold| hold.covered).collect();
        assert!(!covered.contains(&(source as u32 + 1)));
        assert_eq!(back.held.len() + 1, limited.held.len());
        let (same, found) = by_hand(&limited, &chosen(&[[source + 1, 0]]), 12, None);
        assert_eq!((same, found), (limited, vec![(0, Conflict::LeftOut)]));
    }

    proptest! {
        /// The clip keeps its length, its order and its first drawing; what has no conflict stands as chosen; the rest stands as
        /// long as before if nothing is chosen before it.
        #[test]
        fn what_is_chosen_is_shown(
            (frames, omit, hold) in (1_usize..40, 0_usize..6, 0_usize..12),
            wanted in prop::collection::btree_map(0_u32..42, 0_usize..5, 0..8),
        ) {
            let limited = cut(frames, omit, hold);
            let wanted: Vec<Chosen> = wanted
                .into_iter()
                .map(|(source, frames)| Chosen { source, frames })
                .collect();
            let (cut, conflicts) = by_hand(&limited, &wanted, frames, None);
            let sources = &cut.exposure.sources;
            prop_assert_eq!(sources.len(), limited.exposure.len());
            prop_assert_eq!(sources[0], 0);
            prop_assert!(sources.is_sorted());
            for (index, one) in wanted.iter().enumerate() {
                let stands = sources.iter().filter(|source| **source == one.source).count();
                match conflicts.iter().find(|(at, _)| *at == index) {
                    None => prop_assert_eq!(stands, one.frames),
                    Some((_, Conflict::UntilTheEnd(left))) => prop_assert_eq!(stands, *left),
                    Some((_, Conflict::First)) => prop_assert!(stands > 0),
                    Some(_) => prop_assert_eq!(stands, 0),
                }
            }
            let is_shown = |source: &u32| sources.contains(source);
            prop_assert!(!cut.omitted.iter().any(is_shown));
            prop_assert!(!cut.held.iter().any(|hold| is_shown(&hold.covered)));
            if wanted.is_empty() {
                prop_assert_eq!(&cut, &limited);
            }
        }
    }
}
