//! The faces of solids: where something solid ends (terrain.md: no faces between solids that touch).

use std::ops::Range;

use super::super::solids::{Known, Seen, Solids};
use super::slices::{Slice, Slices, Span};
use super::sweep::{Facing, Rect, Strip, Sweep};

/// Finds the faces of neighbouring columns.
struct Faces<'a> {
    known: &'a Known<'a>,
    solids: Solids,
    /// The column before, and this one.
    columns: [Slices; 2],
    /// Sweeps for what looks up, down, to the front and back.
    sweeps: [Sweep; 4],
    /// Sweeps for what looks right and left.
    sides: [Sweep; 2],
    strips: [Vec<Strip>; 4],
    rects: Vec<Rect>,
}

/// The faces of a range of columns, and of their left sides; the last columns' right sides are those of the border.
pub(super) fn faces(known: &Known<'_>, columns: Range<usize>) -> Vec<Rect> {
    let mut faces = Faces {
        known,
        solids: Solids::default(),
        columns: Default::default(),
        sweeps: [Facing::Up, Facing::Down, Facing::Front, Facing::Back].map(Sweep::new),
        sides: [Facing::Right, Facing::Left].map(Sweep::new),
        strips: Default::default(),
        rects: Vec::new(),
    };
    if let Some(before) = columns.start.checked_sub(1) {
        faces.solids.build(known, before);
        faces.columns[1].build(&faces.solids.blocks);
    }
    for column in columns.clone() {
        faces.solids.build(known, column);
        faces.columns.swap(0, 1);
        faces.columns[1].build(&faces.solids.blocks);
        faces.column(column);
        faces.between(column as i32);
    }
    if columns.end == known.grid.columns {
        faces.columns.swap(0, 1);
        faces.columns[1].clear();
        faces.between(columns.end as i32);
    }
    let Faces {
        mut sweeps,
        mut sides,
        mut rects,
        ..
    } = faces;
    let all = sweeps.iter_mut().chain(&mut sides);
    all.for_each(|sweep| sweep.finish(&mut rects));
    rects
}

impl Faces<'_> {
    /// What looks up, down, to the front and back in a column.
    fn column(&mut self, number: usize) {
        let slices = &self.columns[1];
        let [up, down, front, back] = &mut self.strips;
        let (known, solids) = (self.known, &self.solids);
        for (index, slice) in slices.list.iter().enumerate() {
            let spans = slices.spans(slice);
            for span in spans {
                let under = Strip {
                    plane: span.y[0],
                    look: span.bottom,
                    along: slice.z,
                };
                down.push(under);
                if let Some(look) = span.top {
                    top(known, solids, number, slice, span.y[1], look, up);
                }
            }
            let touches = |next: &&Slice| next.z[0] == slice.z[1];
            let next = slices.list.get(index + 1).filter(touches);
            let next = next.map_or(&[][..], |next| slices.spans(next));
            let z = slice.z[1];
            difference(spans, next, |y| {
                slices.sides(slice, y, |y, side| {
                    before(known, solids, number, z, y, side, front);
                });
            });
            let touches = |last: &&Slice| last.z[1] == slice.z[0];
            let last = index.checked_sub(1).map(|last| &slices.list[last]);
            let last = last.filter(touches);
            let last = last.map_or(&[][..], |last| slices.spans(last));
            difference(spans, last, |y| {
                let plane = slice.z[0];
                slices.sides(slice, y, |along, look| {
                    back.push(Strip { plane, look, along });
                });
            });
        }
        let inner = slices.inner.iter().map(|(plane, along, look)| Strip {
            plane: *plane,
            look: *look,
            along: *along,
        });
        down.extend(inner);
        let across = [number as i32, number as i32 + 1];
        for (sweep, strips) in self.sweeps.iter_mut().zip(&mut self.strips) {
            sweep.line(across, strips, &mut self.rects);
            strips.clear();
        }
    }

    /// What looks right and left between the column before and this one.
    fn between(&mut self, plane: i32) {
        let [one, other] = &self.columns;
        let [right, left] = &mut self.strips[..2] else {
            return;
        };
        let [mut a, mut b] = [one.list.as_slice(), other.list.as_slice()];
        let mut z = i32::MIN;
        while !a.is_empty() || !b.is_empty() {
            let start = |list: &[Slice]| list.first().map_or(i32::MAX, |slice| slice.z[0].max(z));
            z = start(a).min(start(b));
            let here = |list: &'_ [Slice]| list.first().copied().filter(|slice| slice.z[0] <= z);
            let bound = |list: &[Slice]| match list.first() {
                Some(slice) if slice.z[0] <= z => slice.z[1],
                Some(slice) => slice.z[0],
                None => i32::MAX,
            };
            let end = bound(a).min(bound(b));
            let [slice_a, slice_b] = [here(a), here(b)];
            let spans_a = slice_a.as_ref().map_or(&[][..], |slice| one.spans(slice));
            let spans_b = slice_b.as_ref().map_or(&[][..], |slice| other.spans(slice));
            if let Some(slice) = &slice_a {
                difference(spans_a, spans_b, |y| {
                    one.sides(slice, y, |along, look| {
                        right.push(Strip { plane, look, along });
                    });
                });
            }
            if let Some(slice) = &slice_b {
                difference(spans_b, spans_a, |y| {
                    other.sides(slice, y, |along, look| {
                        left.push(Strip { plane, look, along });
                    });
                });
            }
            self.sides[0].line([z, end], right, &mut self.rects);
            self.sides[1].line([z, end], left, &mut self.rects);
            right.clear();
            left.clear();
            let pass = |list: &mut &[Slice]| {
                if list.first().is_some_and(|slice| slice.z[1] <= end) {
                    *list = &list[1..];
                }
            };
            pass(&mut a);
            pass(&mut b);
            z = end;
        }
        // The next plane's faces do not go on from these.
        self.sides
            .iter_mut()
            .for_each(|sweep| sweep.finish(&mut self.rects));
    }
}

/// The pieces of a top.
fn top(
    known: &Known<'_>,
    solids: &Solids,
    number: usize,
    slice: &Slice,
    plane: i32,
    hidden: u8,
    strips: &mut Vec<Strip>,
) {
    let rows = slice.z[0] - plane..slice.z[1] - plane;
    let is = |seen| seen == Seen::Top(plane);
    solids.looks(known, number, rows, is, |rows, look| {
        strips.push(Strip {
            plane,
            look: look.unwrap_or(hidden),
            along: [rows.start + plane, rows.end + plane],
        });
    });
}

/// The pieces of a front.
fn before(
    known: &Known<'_>,
    solids: &Solids,
    number: usize,
    plane: i32,
    y: [i32; 2],
    hidden: u8,
    strips: &mut Vec<Strip>,
) {
    let is = |seen| seen == Seen::Front(plane);
    solids.looks(
        known,
        number,
        plane - y[1]..plane - y[0],
        is,
        |rows, look| {
            strips.push(Strip {
                plane,
                look: look.unwrap_or(hidden),
                along: [plane - rows.end, plane - rows.start],
            });
        },
    );
}

/// What is in one list of spans and not in another.
fn difference(one: &[Span], other: &[Span], mut each: impl FnMut([i32; 2])) {
    let mut at = 0;
    for span in one {
        let mut from = span.y[0];
        while let Some(next) = other.get(at)
            && next.y[1] <= from
        {
            at += 1;
        }
        let mut next = at;
        while let Some(hole) = other.get(next)
            && hole.y[0] < span.y[1]
        {
            if hole.y[0] > from {
                each([from, hole.y[0]]);
            }
            from = from.max(hole.y[1]);
            next += 1;
        }
        if from < span.y[1] {
            each([from, span.y[1]]);
        }
    }
}
