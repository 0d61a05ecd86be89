//! Pixels near a border in the drawing.

use super::drawn::Drawn;

/// How far neighbouring pixels differ on a border, of 255: more than a gradient changes from one pixel to the next.
const CLEARLY: u8 = 24;
/// How far from a border pixels are near it, besides the two that it runs between.
const REACH: usize = 1;

/// Which pixels are at most two pixels from a border.
pub(super) struct Borders(Vec<bool>);

impl Borders {
    /// Finds the places where another part begins, or the colour changes clearly.
    pub(super) fn find(drawn: &Drawn) -> Self {
        let [width, height] = drawn.size.map(|side| side as usize);
        let mut near = vec![false; width * height];
        let differ = |one: usize, other: usize| {
            let colors = drawn.colors[one].iter().zip(drawn.colors[other]);
            drawn.owners[one] != drawn.owners[other]
                || colors
                    .into_iter()
                    .any(|(one, other)| one.abs_diff(other) > CLEARLY)
        };
        for at in 0..near.len() {
            let right = (at % width + 1 < width).then_some(at + 1);
            let below = (at + width < near.len()).then_some(at + width);
            for other in [right, below].into_iter().flatten() {
                if differ(at, other) {
                    (near[at], near[other]) = (true, true);
                }
            }
        }
        Self(widened(&near, width))
    }

    /// Whether a pixel is near a border.
    pub(super) fn is_near(&self, at: usize) -> bool {
        self.0[at]
    }
}

/// The marked pixels of a picture with rows of this width, and those around them.
fn widened(marked: &[bool], width: usize) -> Vec<bool> {
    let mut wide = vec![false; marked.len()];
    for at in (0..marked.len()).filter(|at| marked[*at]) {
        let (x, y) = (at % width, at / width);
        let rows = y.saturating_sub(REACH)..=(y + REACH).min(marked.len() / width - 1);
        for row in rows {
            let columns = x.saturating_sub(REACH)..=(x + REACH).min(width - 1);
            columns.for_each(|column| wide[row * width + column] = true);
        }
    }
    wide
}

#[cfg(test)]
mod tests {
    use rustc_hash::FxHashMap;

    use super::*;
    use crate::assemble::Owner;

    #[test]
    fn two_pixels_on_each_side_of_a_border_are_near_it() {
        let (part, nothing) = (Some(Owner::Part(0.into())), None);
        let row = [nothing, nothing, nothing, nothing, part, part, part, part];
        let drawn = Drawn {
            size: [8, 2],
            colors: vec![[0; 4]; 16],
            lines: None,
            owners: [row, row].concat(),
            models: vec![false].into(),
            regions: FxHashMap::default(),
        };
        let borders = Borders::find(&drawn);
        let near: Vec<bool> = (0..8).map(|at| borders.is_near(at)).collect();
        assert_eq!(near, [false, false, true, true, true, true, false, false]);
    }
}
