//! Parts that given depths hide, although they are drawn later, or let float.
//!
//! Looked for over a few lines across each part: at points where the drawing shows it, the fronts of what it lies over are
//! compared with its own. Fronts are those of the solids by themselves, lifted by what they lie on.

mod hint;
#[cfg(test)]
mod tests;

use glam::DVec2;
use rayon::prelude::*;

pub(in super::super) use hint::report;

use super::shapes::Shape;
use super::{Arrangement, FigureContext, Layers};
use crate::bind::PartId;
use crate::geometry::{Intervals, Scanlines};
use crate::threads::GRAIN;

/// The share of a part's visible area from which on it is reported as hidden: less is seldom more than an edge that was drawn
/// over on purpose.
const LEAST: f64 = 0.2;
/// The same as an area: that of 40 pixels in a picture whose larger side has 400, which is about the smallest detail that is
/// missed on a figure as large as the page.
const LEAST_AREA: f64 = 40.0 / (400.0 * 400.0);
/// How far a detail stands off what it is drawn on to be reported, as a share of the larger extent of that.
const FLOATS: f64 = 0.1;
/// Points along a line across a part.
const SAMPLES: f64 = 12.0;

/// What a given depth does to a part.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Harm {
    /// This share of it is hidden, 0 to 1.
    Hidden(f64),
    /// It is this far in front of what it is drawn on, drawing units.
    Floats(f64),
}

impl Harm {
    fn amount(self) -> f64 {
        match self {
            Self::Hidden(amount) | Self::Floats(amount) => amount,
        }
    }
}

/// A part that a given depth hides or lets float.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Buried {
    /// The part whose depth is given.
    given: PartId,
    /// The part that is hidden or floats.
    part: PartId,
    /// The part that hides it, or on which it is drawn.
    other: PartId,
    harm: Harm,
}

/// All that the search depends on.
pub(super) struct Search<'a> {
    pub(super) arrangement: Arrangement<'a>,
    pub(super) layers: &'a Layers,
}

/// A point of a part that the drawing shows.
struct Point {
    line: usize,
    at: DVec2,
    /// The length that it stands for.
    weight: f64,
    /// The fronts of what lies under it, back-most first.
    below: Vec<Front>,
}

/// The front of a shape over a point.
#[derive(Clone, Copy)]
struct Front {
    shape: usize,
    depth: f64,
    /// The shape whose depth it follows: itself, or what lifts it.
    from: usize,
}

impl Search<'_> {
    /// The parts that given depths hide or let float, in the order of drawing.
    pub(super) fn find(&self) -> Vec<Buried> {
        let is_moved: Vec<bool> = self.moved();
        let is_numbered = |shape: usize| {
            self.arrangement.shapes[shape].is_given
                || is_moved[self.arrangement.nodes.of_shape[shape]]
        };
        if !(0..self.arrangement.shapes.len()).any(is_numbered) {
            return Vec::new();
        }
        let highest = self.highest();
        let may_be_hidden = |above: usize| {
            let below = || {
                self.arrangement.overlaps[above]
                    .iter()
                    .map(|overlap| overlap.below)
            };
            let lowest = self.lowest(above);
            (is_numbered(above) || below().any(is_numbered))
                && below().any(|below| highest[below] > lowest && !self.is_lifted_by(above, below))
        };
        let wanted: Vec<bool> = (0..self.arrangement.shapes.len())
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|shape| {
                !self.arrangement.shapes[shape].is_ink
                    && (may_be_hidden(shape) || self.may_float(shape))
            })
            .collect();
        let mut above: Vec<Vec<usize>> = vec![Vec::new(); self.arrangement.shapes.len()];
        for (later, below) in self.arrangement.overlaps.iter().enumerate() {
            for overlap in below.iter().filter(|overlap| wanted[overlap.below]) {
                above[overlap.below].push(later);
            }
        }
        if !wanted.contains(&true) {
            return Vec::new();
        }
        let opaque: Vec<bool> = (0..self.arrangement.shapes.len())
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|shape| self.is_opaque(shape))
            .collect();
        (0..self.arrangement.shapes.len())
            .into_par_iter()
            .filter(|shape| wanted[*shape])
            .flat_map_iter(|shape| self.look_at(shape, &above[shape], &opaque))
            .collect()
    }

    /// Per node whether an `Offset` moves it or what it hangs on.
    fn moved(&self) -> Vec<bool> {
        let mut moved = vec![false; self.arrangement.nodes.len()];
        for node in self.arrangement.nodes.by_level() {
            let parent = self.arrangement.nodes.parent[node].filter(|_| !self.arrangement.is_one);
            moved[node] = self.arrangement.nodes.given[node].is_some_and(|offset| offset != 0.0)
                || parent.is_some_and(|parent| moved[parent]);
        }
        moved
    }

    fn is_laid(&self, shape: usize) -> bool {
        self.layers.is_lifted(self.arrangement.shapes[shape].part)
    }

    /// Whether a shape keeps its volume, rather than being a skin on what it lies on.
    fn is_volume(&self, shape: usize) -> bool {
        !self.arrangement.covers[shape].is_detail
            && !self.arrangement.shapes[shape].profile.is_open()
    }

    /// Whether a shape comes out in front of an earlier one that it lies over.
    fn is_lifted_by(&self, shape: usize, below: usize) -> bool {
        self.is_laid(shape)
            && (!self.is_volume(shape)
                || !self.arrangement.shapes[below].is_given
                || self.arrangement.is_kin(shape, below))
    }

    /// How deep the front of a shape by itself may be at least, drawing units.
    fn lowest(&self, shape: usize) -> f64 {
        let own = &self.arrangement.shapes[shape];
        let front = if own.is_soft {
            0.0
        } else {
            own.plate[1] + self.layers.raised(own.part)[1]
        };
        self.arrangement.plane(shape) + front
    }

    /// Per shape how far its front reaches at most, what lifts it included, drawing units.
    fn highest(&self) -> Vec<f64> {
        let shapes = self.arrangement.shapes;
        let heights: Vec<f64> = shapes.par_iter().map(Shape::height).collect();
        let mut highest: Vec<f64> = Vec::with_capacity(shapes.len());
        for (index, (shape, height)) in shapes.iter().zip(heights).enumerate() {
            let reach = height.max(shape.plate[1]) + self.layers.raised(shape.part)[1];
            let own = self.arrangement.plane(index) + reach;
            let copies = self.mirrors(index).map(|plane| {
                2.0 * plane - self.arrangement.plane(index) + height.max(shape.plate[0])
            });
            let mut most = copies.fold(own, f64::max);
            if self.is_laid(index) {
                let below = self.arrangement.overlaps[index].iter();
                let below = below.map(|overlap| {
                    highest[overlap.below] + reach.max(self.arrangement.steps[index])
                });
                most = below.fold(most, f64::max);
            }
            highest.push(most);
        }
        highest
    }

    /// The planes, drawing units, in which copies of a shape are mirrored.
    fn mirrors(&self, shape: usize) -> impl Iterator<Item = f64> {
        let node = self.arrangement.nodes.of_shape[shape];
        let (_, both) = self.arrangement.context.stand(
            self.arrangement.shapes[shape].main,
            self.arrangement.shapes[shape].part,
        );
        let own = both.then(|| self.arrangement.depths[node]);
        let is_doubled = |node: usize| {
            let attributes = self
                .arrangement
                .context
                .bindings
                .attributes(self.arrangement.nodes.main[node]);
            attributes.shape().doubled
        };
        let parent = is_doubled(node).then(|| {
            let parent = self.arrangement.nodes.parent[node];
            parent.map_or(0.0, |parent| self.arrangement.depths[parent])
        });
        own.into_iter().chain(parent)
    }

    /// How deep the front of a shape by itself is over a point, copies included, drawing units.
    fn own_front(&self, shape: usize, at: DVec2) -> f64 {
        let own = &self.arrangement.shapes[shape];
        let (plane, front) = (self.arrangement.plane(shape), own.front(at));
        // What is soft is about as thick behind its plane as in front of it.
        let back = if own.is_soft { front } else { own.plate[0] };
        let copies = self
            .mirrors(shape)
            .map(|mirror| 2.0 * mirror - plane + back);
        copies.fold(plane + front + self.layers.raised(own.part)[1], f64::max)
    }

    /// The front of a shape over a point, above these.
    fn front(&self, shape: usize, at: DVec2, below: &[Front]) -> Front {
        let own = Front {
            shape,
            depth: self.own_front(shape, at),
            from: shape,
        };
        if !self.is_laid(shape) {
            return own;
        }
        let lifting = below
            .iter()
            .filter(|below| self.is_lifted_by(shape, below.shape));
        let Some(top) = lifting.max_by(|a, b| a.depth.total_cmp(&b.depth)) else {
            return own;
        };
        let depth = top.depth + self.arrangement.steps[shape];
        if self.is_volume(shape) && own.depth >= depth {
            return own;
        }
        Front {
            depth,
            shape,
            from: top.from,
        }
    }

    fn is_opaque(&self, shape: usize) -> bool {
        let FigureContext {
            drawing, bindings, ..
        } = self.arrangement.context;
        let factors = bindings.material_factors(drawing, self.arrangement.shapes[shape].part);
        factors.color[3] >= 1.0
    }

    /// Whether the depth of a shape on others is given so that it could float. What has copies stands off the plane between
    /// them on purpose.
    fn may_float(&self, shape: usize) -> bool {
        let has_copies = self.mirrors(shape).next().is_some();
        self.arrangement.covers[shape].is_detail && self.gives(shape).is_some() && !has_copies
    }

    /// The part whose numbers say how deep a shape lies by itself.
    fn gives(&self, shape: usize) -> Option<PartId> {
        let bindings = self.arrangement.context.bindings;
        let part = bindings.form(self.arrangement.shapes[shape].part);
        bindings.given_depth(part).map(|_| part)
    }

    /// The part whose `Offset` moves a shape away from another one, to this side.
    fn moves(&self, shape: usize, other: usize, is_forward: bool) -> Option<PartId> {
        let nodes = self.arrangement.nodes;
        let mut next = Some(nodes.of_shape[shape]).filter(|_| !self.arrangement.is_one);
        while let Some(node) = next.filter(|node| !nodes.hangs_on(nodes.of_shape[other], *node)) {
            let offset = nodes.given[node].unwrap_or_default();
            if (is_forward && offset > 0.0) || (!is_forward && offset < 0.0) {
                return Some(nodes.main[node]);
            }
            next = nodes.parent[node];
        }
        None
    }

    /// What given depths do to a shape, which these shapes are drawn over.
    fn look_at(&self, shape: usize, above: &[usize], opaque: &[bool]) -> Vec<Buried> {
        let (points, whole) = self.points(shape, above, opaque);
        let visible: f64 = points.iter().map(|point| point.weight).sum();
        let own = &self.arrangement.shapes[shape];
        if visible <= 0.0 {
            return Vec::new();
        }
        // Per part whose depth is given, and what it hides this shape behind, how much.
        let mut hidden: Vec<(PartId, PartId, f64)> = Vec::new();
        let mut gaps: Vec<(f64, usize)> = Vec::new();
        for point in &points {
            let front = self.front(shape, point.at, &point.below).depth;
            let by = point.below.iter().filter(|below| {
                below.depth > front + 0.5 * self.arrangement.steps[shape]
                    && !self.is_lifted_by(shape, below.shape)
                    && opaque[below.shape]
            });
            let top = by.max_by(|a, b| a.depth.total_cmp(&b.depth));
            let given = top.and_then(|top| {
                let given = self.gives(shape);
                let given = given.or_else(|| self.moves(shape, top.from, false));
                let given = given.or_else(|| self.gives(top.from));
                let given = given.or_else(|| self.moves(top.from, shape, true))?;
                Some((given, self.arrangement.shapes[top.shape].part))
            });
            if let Some((given, other)) = given {
                let mut found = hidden.iter_mut();
                match found.find(|(by, at, _)| (*by, *at) == (given, other)) {
                    Some((_, _, weight)) => *weight += point.weight,
                    None => hidden.push((given, other, point.weight)),
                }
            }
            let below = point
                .below
                .iter()
                .max_by(|a, b| a.depth.total_cmp(&b.depth));
            if let Some(below) = below {
                let back = if own.is_soft {
                    own.front(point.at)
                } else {
                    own.plate[0]
                };
                gaps.push((
                    self.arrangement.plane(shape) - back - below.depth,
                    below.shape,
                ));
            }
        }
        let mut found = Vec::new();
        let page = self.arrangement.context.drawing.page.1.max_element();
        let shown = visible / whole * own.area;
        let mut givens: Vec<PartId> = hidden.iter().map(|(given, ..)| *given).collect();
        givens.sort_unstable();
        givens.dedup();
        for given in givens {
            let by = hidden.iter().filter(|(by, ..)| *by == given);
            let share = by.clone().map(|(.., weight)| weight).sum::<f64>() / visible;
            let most = by.max_by(|a, b| a.2.total_cmp(&b.2));
            if let Some((_, other, _)) = most
                && share >= LEAST
                && share * shown >= LEAST_AREA * page * page
            {
                found.push(Buried {
                    given,
                    part: own.part,
                    other: *other,
                    harm: Harm::Hidden(share),
                });
            }
        }
        found.extend(self.floating(shape, &gaps));
        found
    }

    /// A detail that touches nothing, with these distances from what is under it.
    fn floating(&self, shape: usize, gaps: &[(f64, usize)]) -> Option<Buried> {
        let nearest = gaps.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let (gap, other) = *nearest.filter(|_| self.may_float(shape))?;
        let (own, other) = (
            &self.arrangement.shapes[shape],
            &self.arrangement.shapes[other],
        );
        let extent = (other.bounds.1 - other.bounds.0).max_element();
        (gap > FLOATS * extent && gap > 2.0 * own.height()).then_some(Buried {
            given: self.gives(shape)?,
            part: own.part,
            other: other.part,
            harm: Harm::Floats(gap),
        })
    }

    /// Points spread over what the drawing shows of a shape that these are drawn over, and the length that all of the shape would
    /// stand for.
    fn points(&self, shape: usize, above: &[usize], opaque: &[bool]) -> (Vec<Point>, f64) {
        let own = &self.arrangement.shapes[shape];
        let lines = Scanlines::across(own.bounds);
        let (mut shown, mut other) = (Intervals::default(), Intervals::default());
        let cut = |shape: usize, out: &mut Intervals| {
            let shape = &self.arrangement.shapes[shape];
            lines.cut(&shape.outline, &shape.ranges, out);
        };
        cut(shape, &mut shown);
        let whole = shown.length();
        for later in above.iter().filter(|later| opaque[**later]) {
            cut(*later, &mut other);
            shown.remove(&other);
        }
        let apart = (own.bounds.1.x - own.bounds.0.x) / SAMPLES;
        let mut points = Vec::new();
        shown.spread(apart, |line, x, weight| {
            points.push(Point {
                line,
                at: DVec2::new(x, lines.place(line)),
                weight,
                below: Vec::new(),
            });
        });
        for overlap in &self.arrangement.overlaps[shape] {
            cut(overlap.below, &mut other);
            for point in &mut points {
                if other.contains(point.line, point.at.x) {
                    let front = self.front(overlap.below, point.at, &point.below);
                    point.below.push(front);
                }
            }
        }
        (points, whole)
    }
}
