//! `clip-path`: cuts shapes to their visible part.

use glam::{DAffine2, DVec2};

use super::paths::{affine, bez_path, rings};
use crate::geometry::{FillRule, Outline, bounds, intersect, resolve_overlaps, union};

/// A clip path in user units.
#[derive(Debug, Clone)]
pub(super) struct Clip {
    outline: Outline,
    /// The minimum and maximum corner, if the clip is an axis-aligned rectangle.
    pub(super) rectangle: Option<(DVec2, DVec2)>,
}

impl Clip {
    /// Reads a clip path and the ones that clip it; `transform` maps the clipped group to the page.
    pub(super) fn read(clip: &usvg::ClipPath, transform: DAffine2, tolerance: f64) -> Vec<Self> {
        let transform = transform * affine(clip.transform());
        let mut areas = Vec::new();
        collect(clip.root(), transform, tolerance, &mut areas);
        let outline = match areas.len() {
            1 => areas.swap_remove(0),
            _ => union(&areas),
        };
        let rectangle = rectangle(&outline);
        let mut out = vec![Self { outline, rectangle }];
        if let Some(outer) = clip.clip_path() {
            out.extend(Self::read(outer, transform, tolerance));
        }
        out
    }

    /// The part of `outline` inside the clip.
    pub(super) fn cut(&self, outline: Outline) -> Outline {
        let Some((low, high)) = bounds(&outline) else {
            return outline;
        };
        match self.rectangle {
            // Figma and nested drawings clip everything to a frame, which seldom cuts anything.
            Some((least, most)) if low.cmpge(least).all() && high.cmple(most).all() => outline,
            _ => intersect(&outline, &self.outline),
        }
    }
}

fn collect(group: &usvg::Group, transform: DAffine2, tolerance: f64, out: &mut Vec<Outline>) {
    for node in group.children() {
        match node {
            usvg::Node::Group(inner) => {
                let first = out.len();
                collect(inner, transform, tolerance, out);
                if let Some(clip) = inner.clip_path() {
                    let clips =
                        Clip::read(clip, transform * affine(inner.abs_transform()), tolerance);
                    for outline in &mut out[first..] {
                        *outline = clips
                            .iter()
                            .fold(std::mem::take(outline), |outline, clip| clip.cut(outline));
                    }
                }
            }
            usvg::Node::Path(path) => {
                let rule = match path.fill().map(usvg::Fill::rule) {
                    Some(usvg::FillRule::EvenOdd) => FillRule::EvenOdd,
                    _ => FillRule::NonZero,
                };
                let bez = bez_path(path.data(), transform * affine(path.abs_transform()));
                out.push(resolve_overlaps(rings(&bez, tolerance), rule));
            }
            _ => {}
        }
    }
}

fn rectangle(outline: &Outline) -> Option<(DVec2, DVec2)> {
    let [polygon] = outline.polygons.as_slice() else {
        return None;
    };
    let [ring] = polygon.rings.as_slice() else {
        return None;
    };
    let (low, high) = bounds(outline)?;
    let corner = |p: &DVec2| (p.x == low.x || p.x == high.x) && (p.y == low.y || p.y == high.y);
    (ring.len() == 4 && ring.iter().all(corner)).then_some((low, high))
}
