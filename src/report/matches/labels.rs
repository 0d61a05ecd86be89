//! Where the numbers of regions are written: in the regions if they fit, else beside them with a line that leads there.

use crate::math;
use resvg::tiny_skia::{Color, Mask, Paint, PathBuilder, Pixmap, Rect, Stroke, Transform};

use super::digits;

/// The height of digits, pixels, and the least height at which they can be read.
const DIGITS: f32 = 13.0;
const LEAST_DIGITS: f32 = 8.5;
/// Room around a number, pixels.
const ROOM: f32 = 2.5;
/// Distances at which a number beside its region is tried, pixels.
const DISTANCES: [f32; 6] = [8.0, 14.0, 20.0, 28.0, 38.0, 50.0];
/// Directions in which it is tried.
const DIRECTIONS: usize = 24;
/// A pixel that shows no region.
const NOTHING: u32 = u32::MAX;

/// What each pixel of a view shows, to find room for numbers.
pub(super) struct Labels {
    size: [usize; 2],
    /// Per pixel, in rows from the top, the track of the region drawn last.
    shown: Vec<u32>,
    /// The tracks, in the order of drawing.
    tracks: Vec<u32>,
}

/// The pixel of a region that is farthest from its visible border.
#[derive(Clone, Copy)]
struct Middle {
    at: [f32; 2],
    /// How far the border is, pixels.
    room: f32,
}

/// A number in the picture.
struct NumberBox {
    middle: [f32; 2],
    /// Half its width and height.
    half: [f32; 2],
}

impl Labels {
    /// Of a view with nothing in it, in pixels. What lies below this height gets no numbers.
    pub(super) fn new(width: u32, height: u32) -> Option<Self> {
        let size = [width as usize, height as usize];
        Some(Self {
            shown: vec![NOTHING; size[0].checked_mul(size[1])?],
            size,
            tracks: Vec::new(),
        })
    }

    /// Adds a region that is drawn over what is there; empties the mask that holds it.
    pub(super) fn cover(&mut self, mask: &mut Mask, bounds: Rect, track: usize) {
        let within = |at: f32, side: usize| (at.max(0.0) as usize).min(side);
        let columns =
            within(bounds.left() - 1.0, self.size[0])..within(bounds.right() + 2.0, self.size[0]);
        let rows =
            within(bounds.top() - 1.0, self.size[1])..within(bounds.bottom() + 2.0, self.size[1]);
        let track = track as u32;
        for row in rows {
            let start = row * self.size[0];
            let pixels = start + columns.start..start + columns.end;
            let covered = mask.data_mut()[pixels.clone()].iter_mut();
            for (covered, shown) in covered.zip(&mut self.shown[pixels]) {
                if std::mem::take(covered) > 127 {
                    *shown = track;
                }
            }
        }
        self.tracks.push(track);
    }

    /// Writes the numbers of all regions that are visible and have room for them.
    pub(super) fn write(&self, pixmap: &mut Pixmap) {
        let middles = self.middles();
        let mut boxes: Vec<NumberBox> = Vec::new();
        let mut beside: Vec<(u32, Middle)> = Vec::new();
        for track in &self.tracks {
            let Some(middle) = middles.get(*track as usize).copied().flatten() else {
                continue;
            };
            let text = number(*track);
            let diagonal = math::hypot(digits::width(&text, 1.0), 1.0) / 2.0;
            let height = ((middle.room - ROOM) / diagonal).min(DIGITS);
            if height < LEAST_DIGITS {
                beside.push((*track, middle));
                continue;
            }
            digits::write(pixmap, &text, middle.at, height);
            boxes.push(NumberBox::new(&text, middle.at, height));
        }
        for (track, middle) in beside {
            let text = number(track);
            let Some(at) = self.free_place(&text, middle, &boxes) else {
                continue;
            };
            let own = NumberBox::new(&text, at, LEAST_DIGITS);
            lead(pixmap, middle.at, own.side_towards(middle.at));
            digits::write(pixmap, &text, at, LEAST_DIGITS);
            boxes.push(own);
        }
    }

    /// Per track the middle of what is visible of its region. Distances are measured along rows, columns and diagonals.
    fn middles(&self) -> Vec<Option<Middle>> {
        const STRAIGHT: f32 = 1.0;
        const DIAGONAL: f32 = std::f32::consts::SQRT_2;
        let [width, height] = self.size;
        let most = self
            .tracks
            .iter()
            .max()
            .map_or(0, |track| *track as usize + 1);
        let mut middles: Vec<Option<Middle>> = vec![None; most];
        if width < 3 || height < 3 {
            return middles;
        }
        let mut room = vec![0.0_f32; self.shown.len()];
        let step = |room: &[f32], at: usize, other: usize, length: f32| {
            if self.shown[other] == self.shown[at] {
                room[other] + length
            } else {
                length / 2.0
            }
        };
        for row in 1..height {
            for column in 1..width - 1 {
                let at = row * width + column;
                let above = at - width;
                let found = step(&room, at, at - 1, STRAIGHT)
                    .min(step(&room, at, above, STRAIGHT))
                    .min(step(&room, at, above - 1, DIAGONAL))
                    .min(step(&room, at, above + 1, DIAGONAL));
                room[at] = found;
            }
        }
        for row in (0..height - 1).rev() {
            for column in (1..width - 1).rev() {
                let at = row * width + column;
                let below = at + width;
                let found = step(&room, at, at + 1, STRAIGHT)
                    .min(step(&room, at, below, STRAIGHT))
                    .min(step(&room, at, below - 1, DIAGONAL))
                    .min(step(&room, at, below + 1, DIAGONAL));
                room[at] = room[at].min(found);
                let Some(best) = middles.get_mut(self.shown[at] as usize) else {
                    continue;
                };
                if best.is_none_or(|best| room[at] > best.room) {
                    *best = Some(Middle {
                        at: [column as f32 + 0.5, row as f32 + 0.5],
                        room: room[at],
                    });
                }
            }
        }
        middles
    }

    /// A place near a region where a number lies on a single region or on the paper, and on no other number.
    fn free_place(&self, text: &str, region: Middle, boxes: &[NumberBox]) -> Option<[f32; 2]> {
        let directions = (0..DIRECTIONS).map(|index| {
            let turn = index as f32 / DIRECTIONS as f32 * std::f32::consts::TAU;
            math::sin_cos(turn)
        });
        let places = DISTANCES.iter().flat_map(|distance| {
            let far = region.room + distance;
            directions
                .clone()
                .map(move |(y, x)| [region.at[0] + x * far, region.at[1] + y * far])
        });
        places.into_iter().find(|at| {
            let own = NumberBox::new(text, *at, LEAST_DIGITS);
            boxes.iter().all(|other| !own.overlaps(other)) && self.is_even(&own)
        })
    }

    /// Whether all pixels of a box show the same.
    fn is_even(&self, place: &NumberBox) -> bool {
        let edge = |axis: usize, sign: f32| place.middle[axis] + sign * place.half[axis];
        let inside = (0..2)
            .all(|axis| edge(axis, -1.0) >= 0.0 && edge(axis, 1.0) < self.size[axis] as f32 - 1.0);
        if !inside {
            return false;
        }
        let range = |axis: usize| edge(axis, -1.0) as usize..=edge(axis, 1.0) as usize;
        let first = self.shown[edge(1, -1.0) as usize * self.size[0] + edge(0, -1.0) as usize];
        range(1).all(|row| {
            let line = &self.shown[row * self.size[0]..][range(0)];
            line.iter().all(|shown| *shown == first)
        })
    }
}

impl NumberBox {
    fn new(text: &str, middle: [f32; 2], height: f32) -> Self {
        let half = [digits::width(text, height), height].map(|side| side / 2.0 + ROOM);
        Self { middle, half }
    }

    /// The point of its box that is on the way to a point outside of it.
    fn side_towards(&self, point: [f32; 2]) -> [f32; 2] {
        let way = [0, 1].map(|axis| point[axis] - self.middle[axis]);
        let shares = [0, 1].map(|axis| self.half[axis] / way[axis].abs());
        let share = shares[0].min(shares[1]).min(1.0);
        [0, 1].map(|axis| self.middle[axis] + share * way[axis])
    }

    fn overlaps(&self, other: &Self) -> bool {
        (0..2).all(|axis| {
            (self.middle[axis] - other.middle[axis]).abs() < self.half[axis] + other.half[axis]
        })
    }
}

fn number(track: u32) -> String {
    (track + 1).to_string()
}

/// A thin line from a region to its number.
fn lead(pixmap: &mut Pixmap, from: [f32; 2], to: [f32; 2]) {
    let mut path = PathBuilder::new();
    path.move_to(from[0], from[1]);
    path.line_to(to[0], to[1]);
    let Some(path) = path.finish() else {
        return;
    };
    let mut paint = Paint::default();
    paint.set_color(Color::from_rgba8(20, 20, 24, 255));
    let stroke = Stroke {
        width: 1.0,
        ..Stroke::default()
    };
    pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
}
