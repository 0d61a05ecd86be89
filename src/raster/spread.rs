//! Labels that spread over free pixels to the nearest seed.

use super::canvas::Canvas;

/// The label of a pixel without one.
pub(super) const FREE: u16 = u16::MAX;
/// The label of a pixel that neither takes labels nor gives its own.
pub(super) const WALL: u16 = u16::MAX - 1;
/// Steps per pixel of the queue's buckets.
const STEPS: f32 = 4.0;

/// Where the eight neighbours lie, in the order of [`Canvas::around`].
const AROUND: [[i32; 2]; 8] = [
    [0, -1],
    [-1, 0],
    [1, 0],
    [0, 1],
    [-1, -1],
    [1, -1],
    [-1, 1],
    [1, 1],
];

/// A pixel that a label may reach next.
#[derive(Clone, Copy)]
struct Entry {
    at: u32,
    label: u16,
    /// From the seed to the pixel.
    x: i32,
    y: i32,
}

/// What has spread where.
#[derive(Debug)]
pub(super) struct Spread {
    /// By pixel, the square of the distance to the nearest seed, 0 where nothing spread.
    pub(super) squared: Vec<u32>,
}

impl Spread {
    /// The distance from a pixel's centre to that of the nearest seed, in pixels.
    pub(super) fn distance(&self, at: usize) -> f32 {
        (self.squared[at] as f32).sqrt()
    }
}

/// Gives each [`FREE`] pixel the label of the nearest labelled one, except the outermost ring of the padding.
///
/// The distance is Euclidean, in the order of which pixels are visited (vector propagation): nearly exact, and only free pixels
/// cost time.
pub(super) fn spread(canvas: &Canvas, labels: &mut [u16]) -> Spread {
    let around = canvas.around();
    let mut squared = vec![0_u32; labels.len()];
    let mut buckets: Vec<Vec<Entry>> = Vec::new();
    let mut free = Vec::new();
    for row in canvas.rows() {
        free.extend(row.filter(|at| labels[*at] == FREE));
    }
    for &at in &free {
        squared[at] = u32::MAX;
    }
    let push = |buckets: &mut Vec<Vec<Entry>>, entry: Entry, squared: u32| {
        let bucket = ((squared as f32).sqrt() * STEPS) as usize;
        if buckets.len() <= bucket {
            buckets.resize_with(bucket + 1, Vec::new);
        }
        buckets[bucket].push(entry);
    };
    for &at in &free {
        let seeds = around.map(|offset| at.wrapping_add_signed(offset));
        let is_seed = |seed: &usize| labels[*seed] < WALL && squared[*seed] == 0;
        if let Some(index) = seeds.iter().position(is_seed) {
            let [dx, dy] = AROUND[index];
            let entry = Entry {
                at: at as u32,
                label: labels[seeds[index]],
                x: -dx,
                y: -dy,
            };
            push(&mut buckets, entry, (dx * dx + dy * dy) as u32);
        }
    }
    let mut next = 0;
    while next < buckets.len() {
        let entries = std::mem::take(&mut buckets[next]);
        for entry in entries {
            let at = entry.at as usize;
            let distance = (entry.x * entry.x + entry.y * entry.y) as u32;
            if distance >= squared[at] {
                continue;
            }
            squared[at] = distance;
            labels[at] = entry.label;
            for (offset, [dx, dy]) in around.into_iter().zip(AROUND) {
                let neighbor = at.wrapping_add_signed(offset);
                let (x, y) = (entry.x + dx, entry.y + dy);
                let distance = (x * x + y * y) as u32;
                // A seed stays at 0, so that only free pixels are entered.
                if distance < squared[neighbor] {
                    let at = neighbor as u32;
                    push(&mut buckets, Entry { at, x, y, ..entry }, distance);
                }
            }
        }
        // What was found for this bucket while it was worked through comes next.
        if buckets[next].is_empty() {
            next += 1;
        }
    }
    Spread { squared }
}
