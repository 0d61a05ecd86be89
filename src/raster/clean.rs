//! Makes flat areas of pictures that were not drawn cleanly: noise, as of scanners, and what JPEG files add to edges.
//!
//! A bilateral filter (Tomasi and Manduchi 1998) averages what differs little. The colours of what is flat then are clustered by their
//! density, each climbing to the densest colour near it (mean shift, Comaniciu and Meer 2002), and each pixel gets the colour of its
//! cluster. Soft edges between areas stay, as in a picture that was drawn cleanly. Areas between which there is no edge are steps of one
//! shade, and become one.

use rayon::prelude::*;

use super::canvas::{Canvas, TRANSPARENT, distance_squared};
use super::components::components;
use super::spread::{FREE, spread};
use crate::regions::{join, root};

/// Colours of neighbouring pixels that differ by up to this in each channel, in steps of 1/255, hardly differ.
const HARDLY: u8 = 12;
/// In flat art most pairs of neighbouring pixels that differ at all are at edges, and differ much: of 41 such pictures at most 39 % hardly
/// differ, and of the same with little noise or as JPEG files at least 65 %.
const DIRTY: f64 = 0.53;
/// Lines and strong compression make more pairs that differ much. Then some hardly differ far from all edges: of 24 flat pictures at most
/// 0.13 % of all pairs, and of the same as JPEG files of quality 30 at least 1.5 %; what narrower characters have is not measured.
const DIRTY_WITH_LINES: f64 = 0.35;
const DIRTY_OF_ALL: f64 = 0.005;
/// In smaller pictures, of fewer pixels, everything is near an edge: there many of all pairs must hardly differ.
const LARGE: usize = 40_000;
const DIRTY_OF_SMALL: f64 = 0.065;
/// There is no edge where the colours within 2 pixels differ by no more than this in each channel.
const NO_EDGE: u8 = 24;
/// Where so many of all pairs differ, there is strong noise: in 42 flat pictures it was at most 4 %.
const NOISY: f64 = 0.4;
/// The least area of a region of such a picture, as a share of the picture, and in pixels. The filter takes noise away, but not all that JPEG
/// files add to edges: with 2.5e-4, one more of 42 emoji as files of quality 30 had over 1.5 times the regions of the clean one.
const LEAST_OF_NOISE: f64 = 1.2e-4;
const LEAST_OF_JPEG: f64 = 3e-4;
const LEAST_OF_SHADES: f64 = 5e-4;
const LEAST_PIXELS: f64 = 8.0;
/// Rounding makes less noise than this of soft shades, in steps of 1/255; noise with a standard deviation of 1 is more.
const NO_NOISE: f64 = 0.7;
/// Blocks of JPEG files are flat far from edges: of 24 characters and of any quality from 30 to 95, at least 26 % of the neighbouring pixels
/// are equal. With noise they are hardly ever: up to 2 % if it has a standard deviation of 1 in each channel, 14 % if it is of one grey and of 2.
const EQUAL: f64 = 0.2;
/// Pixels to each side that the filter averages.
const REACH: usize = 3;
/// The distance of colours that are not averaged, in the noise's standard deviation, and the least such distance, in steps of 1/255.
const APART: f64 = 7.5;
const LEAST_APART: f64 = 30.0;
/// How often the filter is applied, and what share of the distance the next time has.
const PASSES: usize = 2;
const NEXT_APART: f64 = 0.6;
/// Squares of pixels of which the colours differ by more than this in a channel show edges, where noise is not measured.
const EDGE: u8 = 70;
/// After the filter, a pixel is flat if the colours around it differ by up to this in each channel, or by twice the noise.
const FLAT: f64 = 6.0;
/// Where colours differ by up to this in each channel after the filter, there is no edge; two areas are one if this is more than half of what
/// is between them. A picture has shades if so large a share of the borders between its clusters are none: of 41 shaded pictures 11 to
/// 40 %, with noise or as JPEG files up to 16 %.
const SOFT: u8 = 4;
const SHADED: f64 = 0.18;
/// How far apart the clusters of two steps of one shade are at most, in the least distance of clusters.
const STEP: f64 = 4.0;
/// With fewer pixels along borders this is not known.
const FEW_BORDERS: u64 = 1000;
/// Clusters nearer than this, or than 1.5 times the noise, are one, in steps of 1/255.
const SAME_CLUSTER: f64 = 10.0;
/// Steps of 1/255 in a cell of the densities of colours, and cells along each side.
const CELL: usize = 4;
const CELLS: usize = 256 / CELL;
/// More colours than this are not told apart afterwards.
const MOST_COLORS: usize = 192;
/// A pixel of which so many of the eight neighbours have its cluster lies on a flat area.
const NEIGHBORS: usize = 3;

/// Makes flat areas of those of a picture that has none. If it has shades, the number of areas that remain when each shade is one.
pub(super) fn clean(canvas: &mut Canvas) -> Option<usize> {
    let noise = noise(canvas);
    let least_share = if has_flat_blocks(canvas) {
        LEAST_OF_JPEG
    } else if noise > NO_NOISE {
        LEAST_OF_NOISE
    } else {
        LEAST_OF_SHADES
    };
    let mut apart = (APART * noise).max(LEAST_APART);
    for _ in 0..PASSES {
        canvas.pixels = filtered(canvas, apart);
        apart = (NEXT_APART * apart).max(NEXT_APART * LEAST_APART);
    }
    let least = (canvas.pixels.len() as f64 * least_share).max(LEAST_PIXELS) as usize;
    let same = SAME_CLUSTER.max(1.5 * noise);
    let colors = clusters(canvas, FLAT.max(2.0 * noise), same, least);
    if colors.is_empty() {
        return Some(0);
    }
    let (colors, areas) = snap(canvas, &colors, same, least);
    canvas.least_share = least_share;
    canvas.flat_colors = Some(colors);
    canvas.find_background();
    areas
}

/// Whether a picture was not drawn cleanly: many neighbouring pixels that differ hardly do, or nearly all differ.
pub(super) fn is_dirty(canvas: &Canvas) -> bool {
    let (mut all, mut differ, mut hardly) = (0_u64, 0_u64, 0_u64);
    for at in canvas.rows().flatten() {
        let own = canvas.pixels[at];
        for other in [canvas.pixels[at + 1], canvas.pixels[at + canvas.width]] {
            let most = most_apart(own, other);
            // What is not opaque may be the soft edge of what is cut out.
            let is_opaque = own[3] == u8::MAX && other[3] == u8::MAX;
            all += u64::from(is_opaque);
            differ += u64::from(most > 0 && is_opaque);
            hardly += u64::from((1..=HARDLY).contains(&most) && is_opaque);
        }
    }
    let [all, differ, hardly] = [all, differ, hardly].map(|count| count as f64);
    hardly > DIRTY * differ
        || differ > NOISY * all
        || (hardly > DIRTY_WITH_LINES * differ
            && (hardly > DIRTY_OF_SMALL * all
                || (canvas.pixels.len() >= LARGE && far_from_edges(canvas) > DIRTY_OF_ALL * all)))
}

/// Whether many neighbouring pixels are exactly equal, as in JPEG files. Pixels with a channel at an end of its range do not count: noise
/// is cut off there. If there are no others, what was added is not known, and may be that of a JPEG file.
fn has_flat_blocks(canvas: &Canvas) -> bool {
    let is_inner = |[r, g, b, alpha]: [u8; 4]| {
        let channels = [r, g, b];
        alpha == u8::MAX && channels.iter().all(|c| (1..u8::MAX).contains(c))
    };
    let (mut all, mut equal) = (0_u64, 0_u64);
    for at in canvas.rows().flatten() {
        let own = canvas.pixels[at];
        if !is_inner(own) {
            continue;
        }
        for other in [canvas.pixels[at + 1], canvas.pixels[at + canvas.width]] {
            all += u64::from(is_inner(other));
            equal += u64::from(own == other);
        }
    }
    equal as f64 >= EQUAL * all as f64
}

/// How many opaque neighbouring pixels hardly differ without an edge nearby.
fn far_from_edges(canvas: &Canvas) -> f64 {
    let ranges = ranges(canvas, 2);
    let mut far = 0_u64;
    for at in canvas.rows().flatten().filter(|at| ranges[*at] <= NO_EDGE) {
        let own = canvas.pixels[at];
        for other in [canvas.pixels[at + 1], canvas.pixels[at + canvas.width]] {
            let is_opaque = own[3] == u8::MAX && other[3] == u8::MAX;
            let hardly_differs = (1..=HARDLY).contains(&most_apart(own, other));
            far += u64::from(is_opaque && hardly_differs);
        }
    }
    far as f64
}

/// The largest difference of two colours in a channel.
fn most_apart(a: [u8; 4], b: [u8; 4]) -> u8 {
    let channels = [0, 1, 2, 3].map(|i| a[i].abs_diff(b[i]));
    channels.into_iter().max().unwrap_or_default()
}

/// The standard deviation of the noise, in steps of 1/255, by the median of second differences both ways (Immerkær 1996) where they are
/// not 0 and there are no edges.
fn noise(canvas: &Canvas) -> f64 {
    const WEIGHTS: [[i32; 3]; 3] = [[1, -2, 1], [-2, 4, -2], [1, -2, 1]];
    /// The standard deviation of such a difference, in that of the noise.
    const GAIN: f64 = 6.0;
    /// That of a normal distribution, in its median absolute deviation.
    const NORMAL: f64 = 1.4826;
    let mut counts = vec![0_u64; 16 * 256];
    let ranges = ranges(canvas, 2);
    for at in canvas.rows().flatten() {
        if ranges[at] > EDGE {
            continue;
        }
        let mut sums = [0_i32; 3];
        for (row, weights) in WEIGHTS.iter().enumerate() {
            let first = at + row * canvas.width - canvas.width - 1;
            for (pixel, weight) in canvas.pixels[first..first + 3].iter().zip(weights) {
                for (sum, channel) in sums.iter_mut().zip(pixel) {
                    *sum += weight * i32::from(*channel);
                }
            }
        }
        if sums != [0; 3] {
            for sum in sums {
                counts[sum.unsigned_abs() as usize] += 1;
            }
        }
    }
    let all: u64 = counts.iter().sum();
    let mut seen = 0;
    let median = counts.iter().position(|count| {
        seen += count;
        2 * seen >= all
    });
    median.filter(|_| all > 0).unwrap_or_default() as f64 * NORMAL / GAIN
}

/// By pixel the largest difference in a channel within so many pixels to each side, up to 2; 0 in the padding.
fn ranges(canvas: &Canvas, reach: usize) -> Vec<u8> {
    let width = canvas.width;
    // The least and the greatest of each channel along rows, then along columns.
    let joined = |a: Extremes, b: Extremes| Extremes {
        low: each(a.low, b.low, u8::min),
        high: each(a.high, b.high, u8::max),
    };
    let single = |pixel: &[u8; 4]| Extremes {
        low: *pixel,
        high: *pixel,
    };
    let pixels = canvas.pixels.iter().map(single);
    let mut along: Vec<Extremes> = pixels.collect();
    for step in [1, width] {
        let before = along.clone();
        for at in canvas.rows().flatten() {
            for apart in 1..=reach {
                let both = joined(before[at - apart * step], before[at + apart * step]);
                along[at] = joined(along[at], both);
            }
        }
    }
    let mut ranges = vec![0; along.len()];
    for at in canvas.rows().flatten() {
        ranges[at] = most_apart(along[at].low, along[at].high);
    }
    ranges
}

/// The least and the greatest value of each channel of some colours.
#[derive(Clone, Copy)]
struct Extremes {
    low: [u8; 4],
    high: [u8; 4],
}

#[inline]
fn each(a: [u8; 4], b: [u8; 4], of: fn(u8, u8) -> u8) -> [u8; 4] {
    // Not `map`, which is not inlined.
    [
        of(a[0], b[0]),
        of(a[1], b[1]),
        of(a[2], b[2]),
        of(a[3], b[3]),
    ]
}

/// The picture with each opaque pixel the mean of those around it, the more weight the less their colours differ (Tukey's biweight).
fn filtered(canvas: &Canvas, apart: f64) -> Vec<[u8; 4]> {
    const SCALE: f64 = 1024.0;
    let most = (apart * apart) as usize;
    let weights: Vec<u32> = (0..=most)
        .map(|squared| {
            let rest = 1.0 - squared as f64 / (apart * apart);
            (SCALE * rest.max(0.0) * rest.max(0.0)).round() as u32
        })
        .collect();
    let mut filtered = canvas.pixels.clone();
    let rows = filtered.par_chunks_mut(canvas.width).enumerate();
    rows.for_each(|(y, row)| {
        for (x, pixel) in row.iter_mut().enumerate() {
            if pixel[3] == u8::MAX {
                *pixel = mean_around(canvas, [x, y], &weights);
            }
        }
    });
    filtered
}

/// The mean of the colours around a pixel, each with the weight of the square of its distance.
fn mean_around(canvas: &Canvas, [x, y]: [usize; 2], weights: &[u32]) -> [u8; 4] {
    let own = canvas.pixels[y * canvas.width + x];
    let (left, right) = (x.saturating_sub(REACH), (x + REACH).min(canvas.width - 1));
    let [mut r, mut g, mut b, mut sum] = [0_u32; 4];
    for row in y.saturating_sub(REACH)..=(y + REACH).min(canvas.height - 1) {
        for other in &canvas.pixels[row * canvas.width..][left..=right] {
            let squared = distance_squared(own, *other) as usize;
            let weight = weights.get(squared).copied().unwrap_or_default();
            r += weight * u32::from(other[0]);
            g += weight * u32::from(other[1]);
            b += weight * u32::from(other[2]);
            sum += weight;
        }
    }
    let mean = |channel: u32| ((channel + sum / 2) / sum.max(1)) as u8;
    [mean(r), mean(g), mean(b), u8::MAX]
}

/// The colours of flat areas of at least so many pixels, the commonest first. `flat`: by how much the colours around a flat pixel may
/// differ; `same`: how far clusters are apart.
fn clusters(canvas: &Canvas, flat: f64, same: f64, least: usize) -> Vec<[u8; 4]> {
    let cell_of = |[r, g, b, _]: [u8; 4]| {
        let [r, g, b] = [r, g, b].map(|channel| usize::from(channel) / CELL);
        (r * CELLS + g) * CELLS + b
    };
    let mut counts = vec![0_u32; CELLS * CELLS * CELLS];
    let mut sums = vec![[0_u64; 3]; counts.len()];
    let ranges = ranges(canvas, 1);
    for at in canvas.rows().flatten() {
        let color = canvas.pixels[at];
        if color[3] == u8::MAX && f64::from(ranges[at]) <= flat {
            let cell = cell_of(color);
            counts[cell] += 1;
            for (sum, channel) in sums[cell].iter_mut().zip(color) {
                *sum += u64::from(channel);
            }
        }
    }
    let densities = densities(&counts);
    let mut occupied: Vec<usize> = (0..counts.len()).filter(|cell| counts[*cell] > 0).collect();
    occupied.sort_by_key(|cell| std::cmp::Reverse(densities[*cell]));
    let mut cluster_of = vec![usize::MAX; counts.len()];
    let mut found: Vec<(u64, [u64; 3])> = Vec::new();
    for cell in occupied {
        let denser =
            around(cell).max_by_key(|other| (densities[*other], std::cmp::Reverse(*other)));
        let up = denser.filter(|other| densities[*other] > densities[cell]);
        // A way up over a colour that no flat pixel has ends here.
        let known = up.map(|up| cluster_of[up]);
        let cluster = known
            .filter(|cluster| *cluster < usize::MAX)
            .unwrap_or_else(|| {
                found.push((0, [0; 3]));
                found.len() - 1
            });
        cluster_of[cell] = cluster;
        let (count, sum) = &mut found[cluster];
        *count += u64::from(counts[cell]);
        for (sum, channel) in sum.iter_mut().zip(sums[cell]) {
            *sum += channel;
        }
    }
    found.retain(|(count, _)| *count >= least as u64);
    found.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
    let mean = |(count, sum): &(u64, [u64; 3])| {
        let [r, g, b] = sum.map(|channel| ((channel + count / 2) / count) as u8);
        [r, g, b, u8::MAX]
    };
    let mut colors: Vec<[u8; 4]> = Vec::new();
    for color in found.iter().map(mean) {
        let is_near = |other: &[u8; 4]| f64::from(distance_squared(*other, color)) < same * same;
        if !colors.iter().any(is_near) {
            colors.push(color);
        }
    }
    colors
}

/// The cells beside a cell of colours, over sides, edges and corners.
fn around(cell: usize) -> impl Iterator<Item = usize> {
    let place = [cell / (CELLS * CELLS), cell / CELLS % CELLS, cell % CELLS];
    let near = |along: usize| along.saturating_sub(1)..(along + 2).min(CELLS);
    let cells = near(place[0]).flat_map(move |r| {
        near(place[1]).flat_map(move |g| near(place[2]).map(move |b| (r * CELLS + g) * CELLS + b))
    });
    cells.filter(move |other| *other != cell)
}

/// Counts by cell with those of the cells beside it, which have half the weight along each of the three axes.
fn densities(counts: &[u32]) -> Vec<u64> {
    let mut densities: Vec<u64> = counts.iter().map(|count| u64::from(*count)).collect();
    for step in [1, CELLS, CELLS * CELLS] {
        let before = densities.clone();
        for (cell, density) in densities.iter_mut().enumerate() {
            let along = cell / step % CELLS;
            let lower = if along > 0 { before[cell - step] } else { 0 };
            let higher = if along + 1 < CELLS {
                before[cell + step]
            } else {
                0
            };
            *density = lower + 2 * before[cell] + higher;
        }
    }
    densities
}

/// Gives the pixels of flat areas the colours of their clusters, or the mean one of their shades. These colours, the commonest first, and if
/// the picture has shades the number of areas.
fn snap(
    canvas: &mut Canvas,
    colors: &[[u8; 4]],
    same: f64,
    least: usize,
) -> (Vec<[u8; 4]>, Option<usize>) {
    let nearest = |pixel: &[u8; 4]| {
        if pixel[3] <= TRANSPARENT {
            return FREE;
        }
        let distances = colors.iter().map(|color| distance_squared(*color, *pixel));
        let nearest = distances.enumerate().min_by_key(|(_, distance)| *distance);
        let near = nearest.filter(|(_, distance)| f64::from(*distance) < (2.0 * same).powi(2));
        near.map_or(FREE, |(index, _)| index as u16)
    };
    let classes: Vec<u16> = canvas.pixels.par_iter().map(nearest).collect();
    let around = canvas.around();
    let mut labels = vec![FREE; classes.len()];
    for at in canvas.rows().flatten() {
        let alike = |offset: &&isize| classes[at.wrapping_add_signed(**offset)] == classes[at];
        if around.iter().filter(alike).count() >= NEIGHBORS {
            labels[at] = classes[at];
        }
    }
    let (found, ids) = components(&labels, canvas.width);
    for (label, id) in labels.iter_mut().zip(&ids) {
        if found[*id as usize].area < least {
            *label = FREE;
        }
    }
    let flat = labels.clone();
    spread(canvas, &mut labels);
    let (found, ids) = components(&labels, canvas.width);
    let borders = borders(canvas, &labels, &ids);
    let [all, soft] = [0, 1].map(|i| borders.iter().map(|(_, counts)| counts[i]).sum::<u64>());
    let is_shaded = all >= FEW_BORDERS && soft as f64 > SHADED * all as f64;
    let mut parents: Vec<u32> = (0..found.len() as u32).collect();
    for ([a, b], [all, soft]) in borders {
        let both = [a, b].map(|id| &found[id as usize]);
        let [first, second] = both.map(|one| colors.get(usize::from(one.class)));
        let are_near = first.zip(second).is_some_and(|(first, second)| {
            f64::from(distance_squared(*first, *second)) < (STEP * same).powi(2)
        });
        if 2 * soft > all && are_near && both.iter().all(|one| one.area >= least) {
            join(&mut parents, a, b);
        }
    }
    let shades: Vec<u32> = (0..found.len() as u32)
        .map(|id| root(&mut parents, id))
        .collect();
    // Per shade the sum of its colours, and its pixels.
    let mut sums = vec![([0_u64; 3], 0_u64); found.len()];
    for (component, shade) in found.iter().zip(&shades) {
        if let Some(color) = colors.get(usize::from(component.class)) {
            let (sum, count) = &mut sums[*shade as usize];
            let area = component.area as u64;
            for (sum, channel) in sum.iter_mut().zip(color) {
                *sum += area * u64::from(*channel);
            }
            *count += area;
        }
    }
    let mean = |shade: u32| {
        let (sum, count) = sums[shade as usize];
        let [r, g, b] = sum.map(|sum| ((sum + count / 2) / count.max(1)) as u8);
        [r, g, b, u8::MAX]
    };
    for (at, id) in ids.into_iter().enumerate() {
        let Some(color) = colors.get(usize::from(labels[at])) else {
            continue;
        };
        let pixel = &mut canvas.pixels[at];
        let is_near = f64::from(distance_squared(*pixel, *color)) < (3.0 * same).powi(2);
        if flat[at] != FREE || (pixel[3] == u8::MAX && is_near) {
            *pixel = mean(shades[id as usize]);
        }
    }
    let mut found: Vec<(u64, [u8; 4])> = Vec::new();
    for (shade, (_, count)) in sums.iter().enumerate().filter(|(_, (_, count))| *count > 0) {
        found.push((*count, mean(shade as u32)));
    }
    let areas = found.iter().filter(|(count, _)| *count >= least as u64);
    let areas = is_shaded.then(|| areas.count());
    found.sort_unstable_by_key(|(count, color)| (std::cmp::Reverse(*count), *color));
    let mut colors: Vec<[u8; 4]> = Vec::new();
    for (_, color) in found {
        if colors.len() < MOST_COLORS && !colors.contains(&color) {
            colors.push(color);
        }
    }
    (colors, areas)
}

/// The borders between areas of clusters: the two, and how many pairs of pixels are on both sides, and how many of those hardly differ.
fn borders(canvas: &Canvas, labels: &[u16], ids: &[u32]) -> Vec<([u32; 2], [u64; 2])> {
    let mut pairs: Vec<([u32; 2], bool)> = Vec::new();
    for at in canvas.rows().flatten() {
        for beside in [at + 1, at + canvas.width] {
            if ids[at] != ids[beside] && labels[at].max(labels[beside]) < FREE {
                let both = [ids[at].min(ids[beside]), ids[at].max(ids[beside])];
                let is_soft = most_apart(canvas.pixels[at], canvas.pixels[beside]) <= SOFT;
                pairs.push((both, is_soft));
            }
        }
    }
    pairs.sort_unstable();
    let borders = pairs.chunk_by(|(a, _), (b, _)| a == b);
    let counted = borders.map(|border| {
        let soft = border.iter().filter(|(_, is_soft)| *is_soft).count();
        (border[0].0, [border.len(), soft].map(|count| count as u64))
    });
    counted.collect()
}
