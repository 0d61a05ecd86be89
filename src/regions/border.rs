//! The border around an area of pixels.

/// A side of a pixel that the border of an area runs along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Side {
    /// The pixel of the area, on the border's right.
    pub(crate) inner: usize,
    /// Its neighbor outside, on the border's left.
    pub(crate) outer: usize,
}

impl Side {
    /// The difference of index from a pixel to the one ahead of it, seen along the border, in a picture of this width.
    pub(crate) fn ahead(self, width: usize) -> isize {
        let width = width as isize;
        // East has south on its right, south has west.
        match self.inner as isize - self.outer as isize {
            1 => -width,
            -1 => width,
            right if right > 0 => 1,
            _ => -1,
        }
    }
}

/// Follows a border with the area on its right until it closes, and calls `visit` with each of its sides. At pixels that touch at a
/// corner only it turns right, so that they are apart. The picture's outermost pixels are outside.
pub(crate) fn follow(
    start: Side,
    width: usize,
    is_inside: impl Fn(usize) -> bool,
    mut visit: impl FnMut(Side),
) {
    let mut side = start;
    loop {
        visit(side);
        let ahead = side.ahead(width);
        let next_inner = side.inner.wrapping_add_signed(ahead);
        let next_outer = side.outer.wrapping_add_signed(ahead);
        if !is_inside(next_inner) {
            side.outer = next_inner;
        } else if is_inside(next_outer) {
            side.inner = next_outer;
        } else {
            side = Side {
                inner: next_inner,
                outer: next_outer,
            };
        }
        if side == start {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const WIDTH: usize = 8;

    proptest! {
        #[test]
        fn every_side_is_visited_once(pixels in prop::collection::vec(any::<bool>(), 36)) {
            let is_inside = |at: usize| {
                let (x, y) = (at % WIDTH, at / WIDTH);
                (1..7).contains(&x) && (1..7).contains(&y) && pixels[(y - 1) * 6 + x - 1]
            };
            let mut seen: Vec<(usize, usize)> = Vec::new();
            let mut expected = Vec::new();
            for inner in (0..WIDTH * WIDTH).filter(|at| is_inside(*at)) {
                for outer in [inner - WIDTH, inner - 1, inner + 1, inner + WIDTH] {
                    if is_inside(outer) {
                        continue;
                    }
                    expected.push((inner, outer));
                    if !seen.contains(&(inner, outer)) {
                        follow(Side { inner, outer }, WIDTH, is_inside, |side| {
                            seen.push((side.inner, side.outer));
                        });
                    }
                }
            }
            seen.sort_unstable();
            expected.sort_unstable();
            prop_assert_eq!(seen, expected);
        }

        #[test]
        fn a_border_has_its_area_on_the_right(column in 1..7_usize, row in 1..7_usize) {
            let only = row * WIDTH + column;
            let mut sides = Vec::new();
            let start = Side { inner: only, outer: only - WIDTH };
            follow(start, WIDTH, |at| at == only, |side| sides.push(side.ahead(WIDTH)));
            // Above it to the east, then down on the right, back below and up.
            prop_assert_eq!(sides, vec![1, WIDTH as isize, -1, -(WIDTH as isize)]);
        }
    }
}
