//! The faces of solids: where solid space borders on air.

use std::ops::Range;

use super::super::occlusion::Visible;
use super::super::solids::{MapContext, Solids};
use super::greedy::{FaceRun, Facing, GreedyMesher, Rect};
use super::slices::{Slice, Slices, Span};
use super::steps::{step, tiles};

/// Finds the faces of columns and between neighbouring columns.
struct Faces<'a> {
    context: &'a MapContext,
    solids: Solids,
    /// The column before, and this one.
    columns: [Slices; 2],
    /// For faces that look up, down, to the front and back.
    meshers: [GreedyMesher; 4],
    /// For faces that look right and left.
    sides: [GreedyMesher; 2],
    runs: [Vec<FaceRun>; 4],
    rects: Vec<Rect>,
}

/// The faces of a range of columns with their left sides, and with the right side of the map's last column.
pub(super) fn faces(context: &MapContext, columns: Range<usize>) -> Vec<Rect> {
    let mut faces = Faces {
        context,
        solids: Solids::default(),
        columns: Default::default(),
        meshers: [Facing::Up, Facing::Down, Facing::Front, Facing::Back].map(GreedyMesher::new),
        sides: [Facing::Right, Facing::Left].map(GreedyMesher::new),
        runs: Default::default(),
        rects: Vec::new(),
    };
    let plates = &context.levels.plates;
    if let Some(before) = columns.start.checked_sub(1) {
        faces.solids.build(context, before);
        faces.columns[1].build(&faces.solids.blocks, plates);
    }
    for column in columns.clone() {
        faces.solids.build(context, column);
        faces.columns.swap(0, 1);
        faces.columns[1].build(&faces.solids.blocks, plates);
        faces.column(column);
        faces.between(column as i32);
    }
    if columns.end == context.grid.columns {
        faces.columns.swap(0, 1);
        faces.columns[1].clear();
        faces.between(columns.end as i32);
    }
    let Faces {
        mut meshers,
        mut sides,
        mut rects,
        ..
    } = faces;
    let all = meshers.iter_mut().chain(&mut sides);
    all.for_each(|mesher| mesher.finish(&mut rects));
    rects
}

impl Faces<'_> {
    /// Adds the faces of a column that look up, down, to the front and back.
    fn column(&mut self, number: usize) {
        let slices = &self.columns[1];
        let [up, down, front, back] = &mut self.runs;
        let (context, solids) = (self.context, &self.solids);
        for (index, slice) in slices.list.iter().enumerate() {
            let spans = slices.spans(slice);
            for span in spans {
                down.push(FaceRun::new(span.y[0], slice.z, span.bottom));
                if let Some(material) = span.top {
                    let plane = span.y[1];
                    // Tops are at whole heights.
                    let [level, _] = tiles([plane; 2]);
                    let rows = slice.z[0] - level..slice.z[1] - level;
                    let is = |visible| visible == Visible::Top(level);
                    solids.drawn_materials(context, rows, is, |rows, drawn| {
                        let along = [rows.start + level, rows.end + level];
                        up.push(FaceRun::new(plane, along, drawn.unwrap_or(material)));
                    });
                }
            }
            let touches = |next: &&Slice| next.z[0] == slice.z[1];
            let next = slices.list.get(index + 1).filter(touches);
            let next = next.map_or(&[][..], |next| slices.spans(next));
            let z = slice.z[1];
            difference(spans, next, |y| {
                slices.sides(slice, y, |y, side| {
                    let [bottom, top] = tiles(y);
                    let is = |visible| visible == Visible::Front(z);
                    solids.drawn_materials(context, z - top..z - bottom, is, |rows, drawn| {
                        let along = [y[0].max(step(z - rows.end)), y[1].min(step(z - rows.start))];
                        front.push(FaceRun::new(z, along, drawn.unwrap_or(side)));
                    });
                });
            });
            let touches = |last: &&Slice| last.z[1] == slice.z[0];
            let last = index.checked_sub(1).map(|last| &slices.list[last]);
            let last = last.filter(touches);
            let last = last.map_or(&[][..], |last| slices.spans(last));
            difference(spans, last, |y| {
                let plane = slice.z[0];
                slices.sides(slice, y, |along, material| {
                    back.push(FaceRun::new(plane, along, material));
                });
            });
        }
        let inner = slices.inner.iter();
        down.extend(inner.map(|(plane, along, material)| FaceRun::new(*plane, *along, *material)));
        let across = [number as i32, number as i32 + 1];
        for (mesher, runs) in self.meshers.iter_mut().zip(&mut self.runs) {
            mesher.line(across, runs, &mut self.rects);
            runs.clear();
        }
    }

    /// Adds the faces between the column before and this one, which look right and left.
    fn between(&mut self, plane: i32) {
        let [one, other] = &self.columns;
        let [right, left] = &mut self.runs[..2] else {
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
                    one.sides(slice, y, |along, material| {
                        right.push(FaceRun::new(plane, along, material));
                    });
                });
            }
            if let Some(slice) = &slice_b {
                difference(spans_b, spans_a, |y| {
                    other.sides(slice, y, |along, material| {
                        left.push(FaceRun::new(plane, along, material));
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
        // Faces of the next plane do not continue these.
        self.sides
            .iter_mut()
            .for_each(|mesher| mesher.finish(&mut self.rects));
    }
}

/// The set difference of two lists of spans.
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
