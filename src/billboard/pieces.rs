//! A mesh with a paint of its own in each view, as pieces that every glTF viewer shows: nothing but their positions depends on the
//! weights of morph targets. (Blender reads only the positions of morph targets; colours, texture coordinates and materials that
//! change are not shown by all programs.)
//!
//! Three ways, by what is to be shown:
//! - *Mixtures*, if all paints are opaque colours. One copy of the mesh for each paint and for mixtures of them lie behind each other.
//!   The one whose mixture is nearest to the weights of the views is in front: copy c has the depth 2 c·u − |c|², linear in the
//!   shares u of the paints, which is the greatest for the c nearest to u (a power diagram).
//! - *Veils*, if a gradient, pattern or picture is among opaque paints. The first paint lies at rest. Copies in another paint, each
//!   with an alpha of its own, come through it to the front one after the other; the last is opaque. Copies in one paint may be
//!   blended in any order.
//! - *Hatches*, if something is seen through a paint, so that no copy may lie behind another. Narrow bands are divided between the
//!   paints in proportion to their shares.

use std::borrow::Cow;
use std::collections::BTreeSet;

use glam::DVec2;
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use super::paints::Paints;
use super::shape::Morph;
use crate::scene::ViewId;

/// How far in front of its place what is seen of a mesh lies at most, heights. The copies of a mesh share it, and the depth buffers of
/// viewers have to tell them apart.
pub(super) const DEPTH: f64 = 0.0012;
/// How far apart veils of different paints lie where none of them is seen, heights.
const VEILS_APART: f64 = DEPTH / 32.0;
/// Neighbouring mixtures differ by at most this in each channel, as far as [`MOST_STEPS`] allows.
const STEP: f64 = 0.08;
/// Steps from one paint to another.
const MOST_STEPS: usize = 4;
/// Copies of a mesh of three and more paints; of more there would be no mixtures.
const MOST_COPIES: usize = 32;
/// Veils of each paint.
const VEILS: usize = 4;
/// The height of bands, in heights of the character, as far as [`MOST_HATCHES`] allows.
const HATCH: f64 = 0.01;
/// At most about so many parts of triangles are bands of a mesh.
const MOST_HATCHES: usize = 300;

/// A part of a mesh that has one material.
#[derive(Debug)]
pub(super) struct Piece<'a> {
    /// Its shape in each view, drawing units.
    pub(super) morph: Cow<'a, Morph>,
    /// Per view how far in front of the mesh it lies, heights.
    pub(super) lifts: TiVec<ViewId, f64>,
    /// What it is filled with.
    pub(super) coat: Coat,
}

/// What a piece is filled with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Coat {
    /// A paint, by its index in the list, times this alpha.
    Paint(usize, f64),
    /// sRGB with straight alpha, each 0 to 1.
    Mixture([f64; 4]),
}

/// What decides in which way a paint is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cover {
    /// A colour without alpha.
    Color,
    /// A texture without alpha.
    Texture,
    /// Something is seen through it.
    Transparent,
}

/// The pieces of a mesh whose paints cover what is behind them like `covers`. `between` are the sets of views between which weights
/// are linear, `heights` those of the character in each view, drawing units.
pub(super) fn pieces<'a>(
    morph: &'a Morph,
    paints: &Paints,
    covers: &[Cover],
    between: &[Vec<ViewId>],
    heights: &TiSlice<ViewId, f64>,
) -> Vec<Piece<'a>> {
    if !paints.differ() {
        return vec![Piece {
            morph: Cow::Borrowed(morph),
            lifts: heights.iter().map(|_| 0.0).collect(),
            coat: Coat::Paint(0, 1.0),
        }];
    }
    if covers.contains(&Cover::Transparent) {
        hatches(morph, paints, heights)
    } else if covers.contains(&Cover::Texture) {
        veils(morph, paints)
    } else {
        mixtures(morph, paints, between)
    }
}

/// Shares of the paints in a mixture, in steps.
type Shares = Vec<usize>;

fn mixtures<'a>(morph: &'a Morph, paints: &Paints, between: &[Vec<ViewId>]) -> Vec<Piece<'a>> {
    let apart = |a: &[f64; 4], b: &[f64; 4]| {
        let channels = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        channels.fold(0.0, f64::max)
    };
    let colors: Vec<[f64; 4]> = paints.list.iter().map(|paint| paint.color).collect();
    let pairs = colors
        .iter()
        .flat_map(|a| colors.iter().map(move |b| apart(a, b)));
    let greatest = pairs.fold(0.0, f64::max);
    let wanted = ((greatest / STEP).ceil() as usize).clamp(1, MOST_STEPS);
    let counts = (1..=wanted).rev();
    let mut found = counts.map(|steps| (steps, all_shares(paints, between, steps)));
    let found = found.find(|(steps, all)| *steps == 1 || all.len() <= MOST_COPIES);
    let (steps, all) = found.unwrap_or_default();

    let steps = steps as f64;
    // Within half a step of a view the gap to the next mixture is widened: at the drawn views nothing else may show. What is seen there
    // is `DEPTH` in front, what is seen between the views up to that much less.
    let (curve, corner) = (DEPTH / 2.0, DEPTH * steps);
    let copy = |shares: Shares| {
        let c: Vec<f64> = shares.iter().map(|share| *share as f64 / steps).collect();
        let squared: f64 = c.iter().map(|share| share * share).sum();
        let depth = |at: usize| {
            let edge = match c.iter().position(|share| *share == 1.0) {
                None => 0.0,
                Some(own) if own == at => corner / (2.0 * steps),
                Some(_) => corner / (2.0 * steps) - corner,
            };
            curve * (2.0 * c[at] - squared) + edge
        };
        let mut mixture = [0.0; 4];
        for (share, color) in c.iter().zip(&colors) {
            for (sum, channel) in mixture.iter_mut().zip(color) {
                *sum += share * channel;
            }
        }
        let only = c.iter().position(|share| *share == 1.0);
        Piece {
            morph: Cow::Borrowed(morph),
            lifts: paints.of_view.iter().map(|at| depth(*at)).collect(),
            coat: only.map_or(Coat::Mixture(mixture), |paint| Coat::Paint(paint, 1.0)),
        }
    };
    all.into_iter().map(copy).collect()
}

/// The mixtures between the paints of each set of views, in order.
fn all_shares(paints: &Paints, between: &[Vec<ViewId>], steps: usize) -> Vec<Shares> {
    let mut all: BTreeSet<Shares> = BTreeSet::new();
    let count = paints.list.len();
    for set in between {
        let own: BTreeSet<usize> = set.iter().map(|view| paints.of_view[*view]).collect();
        let own: Vec<usize> = own.into_iter().collect();
        for first in 0..=steps {
            for second in 0..=steps - first {
                let shares = [steps - first - second, first, second];
                // Sets have at most three views; what has no paint gets no share.
                if shares[own.len().min(3)..].iter().any(|share| *share > 0) {
                    continue;
                }
                let mut mixture = vec![0; count];
                for (paint, share) in own.iter().zip(shares) {
                    mixture[*paint] = share;
                }
                all.insert(mixture);
            }
        }
    }
    // In the order of the paints that they have most of.
    all.into_iter().rev().collect()
}

fn veils<'a>(morph: &'a Morph, paints: &Paints) -> Vec<Piece<'a>> {
    let first = Piece {
        morph: Cow::Borrowed(morph),
        lifts: paints.of_view.iter().map(|_| 0.0).collect(),
        coat: Coat::Paint(0, 1.0),
    };
    let of_paint = |paint: usize| {
        (1..=VEILS).map(move |number| {
            // The share of the paint at which it passes the first one.
            let passes = (number as f64 - 0.5) / VEILS as f64;
            let in_front = DEPTH * (1.0 + number as f64 / VEILS as f64) / 2.0;
            let slope = in_front / (1.0 - passes);
            // Where several paints are not seen, they are behind the first one, and apart from each other: from behind they would flicker.
            let apart = VEILS_APART * (paint - 1) as f64;
            let lift = |at: &usize| {
                if *at == paint {
                    slope * (1.0 - passes)
                } else {
                    -slope * passes - apart
                }
            };
            Piece {
                morph: Cow::Borrowed(morph),
                lifts: paints.of_view.iter().map(lift).collect(),
                // So much that after each of them an equal part of what lies behind is gone.
                coat: Coat::Paint(paint, 1.0 / (VEILS + 1 - number) as f64),
            }
        })
    };
    let others = (1..paints.list.len()).flat_map(of_paint);
    std::iter::once(first).chain(others).collect()
}

/// Divides the mesh into bands, and each of them between the paints. In a view with paint p, cuts up to the p-th are at a band's upper
/// border, the others at the lower one; between the views they move from one to the other.
fn hatches<'a>(morph: &Morph, paints: &Paints, heights: &TiSlice<ViewId, f64>) -> Vec<Piece<'a>> {
    let view = paints.list[0].view;
    let (fine, bands) = banded(morph, view, heights[view]);
    let count = paints.list.len();
    let piece = |paint: usize| {
        let mut morph = Morph {
            points: TiVec::from(vec![Vec::new(); heights.len()]),
            ..Morph::default()
        };
        // Corners by the ends of the way that their cut takes, and by the number of the cut.
        let mut known: FxHashMap<(u32, u32, usize), u32> = FxHashMap::default();
        let mut corner = |from: u32, to: u32, number: usize| {
            let key = match number {
                0 => (from, from, 0),
                _ if number == count || from == to => (to, to, 0),
                _ => (from, to, number),
            };
            *known.entry(key).or_insert_with(|| {
                for (view, points) in morph.points.iter_mut_enumerated() {
                    let at = if number <= paints.of_view[view] {
                        from
                    } else {
                        to
                    };
                    points.push(fine[view][at as usize]);
                }
                morph.points[ViewId::FIRST].len() as u32 - 1
            })
        };
        for Band { lower, upper } in &bands {
            let [a, b] = [0, 1].map(|side| corner(upper[side], lower[side], paint + 1));
            let [d, c] = [0, 1].map(|side| corner(upper[side], lower[side], paint));
            let triangles = [[a, b, c], [a, c, d]];
            let is_area = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
            morph
                .triangles
                .extend(triangles.iter().filter(|t| is_area(t)));
        }
        Piece {
            morph: Cow::Owned(morph),
            lifts: heights.iter().map(|_| 0.0).collect(),
            coat: Coat::Paint(paint, 1.0),
        }
    };
    (0..count).map(piece).collect()
}

/// A part of a triangle between two lines: its corners on each, so that lower 0, lower 1, upper 1, upper 0 goes around it as the
/// corners of the triangle do.
struct Band {
    lower: [u32; 2],
    upper: [u32; 2],
}

/// The points of a mesh and of the bands into which evenly spaced level lines of one view divide it, and these bands.
fn banded(morph: &Morph, view: ViewId, height: f64) -> (TiVec<ViewId, Vec<DVec2>>, Vec<Band>) {
    let level = |corner: u32| morph.points[view][corner as usize].y;
    let sorted = |triangle: &[u32; 3]| {
        let mut corners = *triangle;
        corners.sort_by(|a, b| level(*a).total_cmp(&level(*b)));
        corners
    };
    let spans = morph.triangles.iter().map(|triangle| {
        let [low, _, high] = sorted(triangle);
        level(high) - level(low)
    });
    // So many bands of this height, besides two for each triangle.
    let sum: f64 = spans.sum();
    let step = (HATCH * height).max(sum / MOST_HATCHES as f64);

    let mut points = morph.points.clone();
    let mut known: FxHashMap<(u32, u32, u64), u32> = FxHashMap::default();
    // The point of a side at a level: of neighbours the same.
    let mut cut = |a: u32, b: u32, at: f64| {
        let (a, b) = (a.min(b), a.max(b));
        if at == level(a) {
            return a;
        }
        if at == level(b) {
            return b;
        }
        let share = (at - level(a)) / (level(b) - level(a));
        *known.entry((a, b, at.to_bits())).or_insert_with(|| {
            for points in &mut points {
                points.push(points[a as usize].lerp(points[b as usize], share));
            }
            points[ViewId::FIRST].len() as u32 - 1
        })
    };
    let mut bands = Vec::new();
    for triangle in &morph.triangles {
        let [low, middle, high] = sorted(triangle);
        let span = level(high) - level(low);
        if span <= 0.0 {
            // It may have an area in other views.
            let [a, b, c] = *triangle;
            bands.push(Band {
                lower: [a, b],
                upper: [c, c],
            });
            continue;
        }
        // Around the triangle from low over the middle one to high, or the other way.
        let start = triangle.iter().position(|corner| *corner == low);
        let is_around = start.is_some_and(|start| triangle[(start + 1) % 3] == middle);
        let mut levels = vec![level(low), level(middle), level(high)];
        if step > 0.0 && span.is_finite() {
            let first = (level(low) / step).floor() + 1.0;
            let inner = (0..=(span / step) as usize).map(|number| (first + number as f64) * step);
            levels.extend(inner.filter(|at| *at < level(high)));
        }
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let ends = |at: f64| {
            let long = cut(low, high, at);
            let short = if at < level(middle) {
                cut(low, middle, at)
            } else if at > level(middle) {
                cut(middle, high, at)
            } else {
                middle
            };
            if is_around {
                [long, short]
            } else {
                [short, long]
            }
        };
        let ends: Vec<[u32; 2]> = levels.into_iter().map(ends).collect();
        let pairs = ends.windows(2);
        bands.extend(pairs.map(|pair| Band {
            lower: pair[0],
            upper: pair[1],
        }));
    }
    (points, bands)
}

#[cfg(test)]
mod tests {
    use super::super::paints::Paint;
    use super::*;

    /// Paints of so many views, in one set.
    fn paints(colors: &[[f64; 4]]) -> (Paints, Vec<Vec<ViewId>>) {
        let views = (0..colors.len()).map(ViewId::from);
        let shown = views
            .zip(colors)
            .map(|(view, color)| (view, Paint::plain(*color, view)));
        let paints = Paints::collect(colors.len(), shown, |a, b| a.color == b.color);
        let set = (0..colors.len()).map(ViewId::from).collect();
        (paints, vec![set])
    }

    /// A square of 100 drawing units, the same in all views.
    fn square(views: usize) -> Morph {
        let corners = [(0.0, 0.0), (0.0, 100.0), (100.0, 100.0), (100.0, 0.0)];
        let corners = corners.map(|(x, y)| DVec2::new(x, y)).to_vec();
        Morph {
            points: vec![corners; views].into(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            rings: vec![vec![0, 1, 2, 3]],
        }
    }

    /// Weights of up to three views.
    fn weights(views: usize) -> impl Iterator<Item = Vec<f64>> {
        let all = (0..=20).flat_map(move |a| (0..=20 - a).map(move |b| [a, b, 20 - a - b]));
        let used = all.filter(move |all| all[views..].iter().all(|rest| *rest == 0));
        used.map(move |all| {
            all[..views]
                .iter()
                .map(|part| f64::from(*part) / 20.0)
                .collect()
        })
    }

    fn lift(piece: &Piece<'_>, weights: &[f64]) -> f64 {
        piece
            .lifts
            .iter()
            .zip(weights)
            .map(|(lift, weight)| lift * weight)
            .sum()
    }

    #[test]
    fn the_mixture_in_front_is_that_of_the_weights() {
        let colors = [
            [0.8, 0.3, 0.2, 1.0],
            [0.5, 0.4, 0.3, 1.0],
            [0.7, 0.6, 0.1, 1.0],
        ];
        for views in [2, 3] {
            let (paints, between) = paints(&colors[..views]);
            let morph = square(views);
            let heights = TiVec::from(vec![100.0; views]);
            let pieces = pieces(
                &morph,
                &paints,
                &vec![Cover::Color; views],
                &between,
                &heights,
            );
            assert_eq!(pieces.len(), [5, 15][views - 2]);
            for weights in weights(views) {
                let mut order: Vec<&Piece<'_>> = pieces.iter().collect();
                order.sort_by(|a, b| lift(b, &weights).total_cmp(&lift(a, &weights)));
                let front = lift(order[0], &weights);
                assert!(
                    (-DEPTH / 4.0..DEPTH * 1.001).contains(&front),
                    "{weights:?}: {front}"
                );
                let shown = match order[0].coat {
                    Coat::Mixture(color) => color,
                    Coat::Paint(paint, alpha) => {
                        assert_eq!(alpha, 1.0);
                        paints.list[paint].color
                    }
                };
                for channel in 0..3 {
                    let all = colors
                        .iter()
                        .zip(&weights)
                        .map(|(color, weight)| color[channel] * weight);
                    let mixed: f64 = all.sum();
                    // Half a step from one paint to another, or within three.
                    let step = 0.3 / MOST_STEPS as f64;
                    assert!(
                        (shown[channel] - mixed).abs() < 0.7 * step,
                        "{weights:?}: {shown:?}"
                    );
                }
                if weights.contains(&1.0) {
                    assert!(
                        front - lift(order[1], &weights) > DEPTH / 2.0,
                        "{weights:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn veils_in_front_mix_by_the_weights() {
        let (paints, between) = paints(&[[0.0, 0.0, 0.0, 1.0], [1.0, 1.0, 1.0, 1.0]]);
        let (morph, heights) = (square(2), TiVec::from(vec![100.0; 2]));
        let pieces = pieces(&morph, &paints, &[Cover::Texture; 2], &between, &heights);
        for weights in weights(2) {
            let mut order: Vec<&Piece<'_>> = pieces.iter().collect();
            order.sort_by(|a, b| lift(b, &weights).total_cmp(&lift(a, &weights)));
            let (mut white, mut rest) = (0.0, 1.0);
            for piece in order {
                let Coat::Paint(paint, alpha) = piece.coat else {
                    panic!("a mixture");
                };
                white += rest * alpha * paint as f64;
                rest *= 1.0 - alpha;
            }
            let off = (white - weights[1]).abs();
            assert!(
                rest == 0.0 && off < 0.51 / VEILS as f64,
                "{weights:?}: {white}"
            );
        }
    }

    #[test]
    fn hatches_cover_areas_by_the_weights() {
        let colors = [
            [0.0, 0.0, 0.0, 0.5],
            [1.0, 1.0, 1.0, 0.7],
            [1.0, 0.0, 0.0, 1.0],
        ];
        for views in [2, 3] {
            let (paints, between) = paints(&colors[..views]);
            let (morph, heights) = (square(views), TiVec::from(vec![100.0; views]));
            let pieces = pieces(
                &morph,
                &paints,
                &vec![Cover::Transparent; views],
                &between,
                &heights,
            );
            // Two triangles of each band in each half of the square, but one at its corners.
            assert!((396..=400).contains(&pieces[0].morph.triangles.len()));
            for weights in weights(views) {
                for (piece, weight) in pieces.iter().zip(&weights) {
                    let point = |corner: u32| -> DVec2 {
                        let views = piece.morph.points.iter().zip(&weights);
                        views
                            .map(|(points, weight)| points[corner as usize] * *weight)
                            .sum()
                    };
                    let areas = piece.morph.triangles.iter().map(|triangle| {
                        let [a, b, c] = triangle.map(point);
                        let area = -(b - a).perp_dot(c - a) / 2.0;
                        assert!(area > -1e-9);
                        area
                    });
                    let share = areas.sum::<f64>() / 1e4;
                    assert!((share - weight).abs() < 1e-9, "{weights:?}: {share}");
                }
            }
        }
    }
}
