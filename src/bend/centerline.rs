//! The line through the middle of an outline, from one end to the other.

use std::sync::Arc;

use glam::{DAffine2, DVec2};

use super::grid::{Cells, Grid};
use crate::geometry::{Outline, y_up};
use crate::math;

/// The distance of the line's points, in widths.
const SPACING: f64 = 0.25;
/// It has no more points than this: a hair a thousand times as long as wide is coarser.
const MAX_POINTS: f64 = 256.0;
/// How often each point is drawn towards its neighbours: steps of the grid disappear.
const PASSES: usize = 8;
/// How often the line is moved to the middles of the cross-sections.
const CENTERINGS: usize = 3;
/// By how much a point is moved at most each time, in widths.
const STEP: f64 = 0.25;
/// A slender outline is at least this much longer than it is wide.
const SLENDER: f64 = 2.2;
/// At most this share of an outline with a middle line is farther from it than it is wide.
const MOST_STRAY: f64 = 0.06;
/// What an outline branches into begins this far along its middle line or later, as a share of its length, or it has no such line.
const LEAST_STEM: f64 = 0.6;
/// How much faster one gets along the line inside a bend that is drawn counts up to this.
const MOST_RISE: f64 = 1.5;
/// A line that is as near to a straight one as this, in widths, is straight.
const STRAIGHT: f64 = 0.15;
/// The line ends within the outline by this many widths, because the middle way turns into a corner there.
const CLIP: f64 = 0.75;
/// How far it is extended beyond its ends, in widths.
const BEYOND: f64 = 1.5;
/// Points of the line that are farther apart than the first along it, and nearer than the second to each other, both in widths, belong to
/// a curl, in which what is near may be far along the line.
const CURL: [f64; 2] = [3.0, 2.5];
/// In a curl, only points of the line count that are this near along it, in widths, to where a point is by the way inside.
const WINDOW: f64 = 2.0;
/// Distances along the line are means over the points of it that are near: by this power of the inverse of their distance.
const NEARNESS: i32 = 3;

/// The line through the middle of an outline.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Centerline {
    /// Its points at equal distances, y up, extended straight beyond both ends.
    points: Vec<DVec2>,
    /// How far along the line the first point is: negative, for 0 is at the joint.
    first: f64,
    /// The distance of the points.
    spacing: f64,
    /// From the joint to the far end.
    length: f64,
    /// The mean width of the outline across it.
    width: f64,
    /// Per point how far from the line the outline reaches there at most, times how much faster one gets along the line there than on it.
    girths: Vec<f64>,
    /// The area of the outline along it.
    area: f64,
    /// The share of the area that is beside the line and farther from it than the outline is wide.
    stray: f64,
    /// For a line that curls, about how far along it the places in and near the outline are.
    ways: Option<Ways>,
}

/// About how far along a line places are, by the way inside the outline.
#[derive(Debug, Clone, PartialEq)]
struct Ways {
    /// Per cell of the grid.
    along: Arc<[f32]>,
    grid: Arc<Cells>,
    /// From the line's frame to the outline's.
    to_outline: DAffine2,
    /// The lengths of the line's frame, as multiples of the outline's.
    scale: f64,
}

impl Ways {
    fn at(&self, point: DVec2) -> f64 {
        let cell = self.grid.cell_at(self.to_outline.transform_point2(point));
        f64::from(self.along[cell]) * self.scale
    }
}

impl Centerline {
    /// The centreline of an outline, y down, from the end at which its joint is to the other one. The joint is a point of the drawing,
    /// y up. `None` if the outline has no area, or is no longer than it is wide.
    pub(crate) fn new(outline: &Outline, joint: DVec2) -> Option<Self> {
        let grid = Grid::new(outline)?;
        let tip = grid.farthest(grid.nearest(y_up(joint))?);
        let start = grid.farthest(tip);
        let way = grid.middle_way(start, tip);
        let way: Vec<DVec2> = way.iter().map(|cell| y_up(grid.place(*cell))).collect();
        let mut line = Self::through(&way, grid.area(), joint)?;
        line.find_ways(&grid);
        line.stray = line.stray(&grid);
        if line.stray > MOST_STRAY
            && let Some(stem) = line.stem(&grid, &way, joint)
        {
            line = stem;
        }
        if line.stray <= MOST_STRAY {
            let stray = line.stray;
            for _ in 0..CENTERINGS {
                line = line.centered(&grid, joint);
                line.find_ways(&grid);
            }
            line.stray = stray;
        }
        line.measure_girths(&grid);
        Some(line)
    }

    /// The line up to where the outline is branched at its far end, like an arm with spread fingers; `None` if that is not near the end.
    /// `way` is the way through the outline along which the line leads.
    fn stem(&self, grid: &Grid, way: &[DVec2], joint: DVec2) -> Option<Self> {
        let along = |cell: usize| self.along(y_up(grid.place(cell)));
        let mut far: Vec<f64> = self.far_cells(grid).map(along).collect();
        far.sort_unstable_by(f64::total_cmp);
        let few = (MOST_STRAY * LEAST_STEM * grid.inside_cells().count() as f64) as usize;
        // What is farther away than the outline is wide left the line before.
        let end = far.get(few)? - self.width;
        if end < LEAST_STEM * self.length {
            return None;
        }
        let cells = grid.inside_cells().filter(|cell| along(*cell) <= end);
        let area = cells.count() as f64 * grid.side().powi(2);
        let at = self.at(end);
        let off = |number: &usize| way[*number].distance_squared(at);
        let last = (0..way.len()).min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let mut stem = Self::through(&way[..=last], area, joint)?;
        stem.find_ways(grid);
        stem.stray = stem.stray(grid);
        Some(stem)
    }

    /// For a line that curls, finds about how far along it the places in and near the outline are.
    fn find_ways(&mut self, grid: &Grid) {
        self.ways = None;
        if !self.curls() {
            return;
        }
        let count = (self.length / self.spacing) as usize;
        let places = (0..=count).map(|number| number as f64 * self.spacing);
        let places: Vec<(DVec2, f64)> = places.map(|along| (y_up(self.at(along)), along)).collect();
        self.ways = Some(Ways {
            along: grid.labeled(&places).into(),
            grid: Arc::new(grid.cells),
            to_outline: DAffine2::from_scale(DVec2::new(1.0, -1.0)),
            scale: 1.0,
        });
    }

    /// The cells inside that are beside the line and farther from it than the outline is wide.
    fn far_cells<'a>(&'a self, grid: &'a Grid) -> impl Iterator<Item = usize> + 'a {
        grid.inside_cells().filter(|cell| {
            let place = y_up(grid.place(*cell));
            let along = self.along(place);
            along < self.length && place.distance(self.at(along)) > self.width
        })
    }

    /// The share of the area that is beside the line and farther from it than the outline is wide.
    fn stray(&self, grid: &Grid) -> f64 {
        self.far_cells(grid).count() as f64 / grid.inside_cells().count().max(1) as f64
    }

    /// Whether this is the middle line of a slender outline. What is branched is not, nor a wide shape with a thin end.
    pub(crate) fn is_slender(&self) -> bool {
        self.length >= SLENDER * self.width && self.stray <= MOST_STRAY
    }

    /// Whether parts of the line that are far from each other along it are near to each other.
    fn curls(&self) -> bool {
        let apart = (CURL[0] * self.width / self.spacing) as usize;
        let near = (CURL[1] * self.width).powi(2);
        let points = self.points.iter().enumerate();
        points.into_iter().any(|(number, point)| {
            let far = self.points.iter().skip(number + apart.max(1));
            far.into_iter()
                .any(|other| point.distance_squared(*other) < near)
        })
    }

    /// The line through the middles of the cross-sections. What bends about it keeps its area.
    fn centered(self, grid: &Grid, joint: DVec2) -> Self {
        let last = self.points.len() - 1;
        let mut sums = vec![(0.0, 0.0); self.points.len()];
        for cell in grid.inside_cells() {
            let place = y_up(grid.place(cell));
            let along = self.along(place);
            // What branches off does not count.
            if place.distance(self.at(along)) > self.width {
                continue;
            }
            let number = self.nearest(along);
            let off = (place - self.at(along)).dot(self.across(number));
            sums[number].0 += off;
            sums[number].1 += 1.0;
        }
        let beyond = self.beyond();
        let mut line: Vec<DVec2> = self.points[beyond..=last - beyond].to_vec();
        for (number, point) in line.iter_mut().enumerate() {
            // Over some points, so that a single bump does not bend it.
            let number = number + beyond;
            let near = &sums[number.saturating_sub(1)..=(number + 1).min(last)];
            let (off, cells) = near
                .iter()
                .fold((0.0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
            if cells > 0.0 {
                let most = STEP * self.width;
                *point += self.across(number) * (off / cells).clamp(-most, most);
            }
        }
        smooth(&mut line);
        Self::of_points(line, self.area, joint)
    }

    /// To the left of the line at one of its points.
    fn across(&self, number: usize) -> DVec2 {
        let last = self.points.len() - 1;
        let [before, after] = [number.saturating_sub(1), (number + 1).min(last)];
        (self.points[after] - self.points[before])
            .perp()
            .normalize_or_zero()
    }

    /// The number of the point that is nearest to a distance along the line.
    fn nearest(&self, along: f64) -> usize {
        let number = ((along - self.first) / self.spacing).round().max(0.0) as usize;
        number.min(self.points.len() - 1)
    }

    /// How many points there are beyond each end.
    fn beyond(&self) -> usize {
        beyond(self.width, self.spacing)
    }

    fn measure_girths(&mut self, grid: &Grid) {
        let along: Vec<f64> = grid
            .all_cells()
            .map(|cell| {
                if grid.is_inside(cell) {
                    self.along(y_up(grid.place(cell)))
                } else {
                    0.0
                }
            })
            .collect();
        let mut girths = vec![0.0_f64; self.points.len()];
        for cell in grid.inside_cells() {
            let rise = grid
                .next(cell)
                .map(|next| next.map_or(0.0, |next| along[next] - along[cell]));
            let rise = DVec2::from(rise).length() / grid.side();
            let own = along[cell];
            let far = self.at(own).distance(y_up(grid.place(cell))) + grid.side() / 2.0;
            let girth = &mut girths[self.nearest(own)];
            *girth = girth.max(far * rise.clamp(1.0, MOST_RISE));
        }
        self.girths = girths;
    }

    /// The length of a bend about a place of the line, in widths of the outline there. The surface reaches as far as `depth` from the
    /// drawing plane.
    pub(super) fn arc(&self, at: f64, widths: f64, depth: f64) -> f64 {
        const STEPS: usize = 8;
        /// A tube that is inflated is as much deeper than wide.
        const INFLATED: f64 = std::f64::consts::SQRT_2;

        let mut arc = widths * 0.5 * self.width;
        for _ in 0..STEPS {
            let [from, to] = [at - arc / 2.0, at + arc / 2.0].map(|along| self.nearest(along));
            let girth = self.girths[from..=to].iter().copied().fold(0.0, f64::max);
            let wanted = widths * 2.0 * girth.max(depth.min(INFLATED * girth));
            if wanted <= arc {
                break;
            }
            arc = wanted;
        }
        arc
    }

    fn through(way: &[DVec2], area: f64, joint: DVec2) -> Option<Self> {
        let whole = length(way);
        // A way of one point has no length; one that is not finite leads nowhere.
        if !(whole > 0.0 && whole.is_finite()) {
            return None;
        }
        let width = area / whole;
        let clip = CLIP * width;
        if whole <= 2.0 * clip + SPACING * width {
            return None;
        }
        let inner = whole - 2.0 * clip;
        let count = (inner / (SPACING * width)).ceil().clamp(2.0, MAX_POINTS) as usize;
        let mut line = resampled(way, clip, inner, count);
        for _ in 0..PASSES {
            smooth(&mut line);
        }
        Some(Self::of_points(line, area, joint))
    }

    /// The line through these points, to be extended at both ends; those of the outline are farther by the clip.
    fn of_points(mut line: Vec<DVec2>, area: f64, joint: DVec2) -> Self {
        let count = line.len() - 1;
        let near = STRAIGHT * area / length(&line);
        straighten(&mut line, near);
        // Smoothing made it shorter here and there.
        let inner = length(&line);
        let line = resampled(&line, 0.0, inner, count);
        // Without the ways into corners: the clip is a share of the width itself.
        let width = (math::hypot(inner, (8.0 * CLIP * area).sqrt()) - inner) / (4.0 * CLIP);
        let clip = CLIP * width;
        let spacing = inner / count as f64;
        let beyond = beyond(width, spacing);
        let extended = |end: DVec2, way: DVec2| {
            let way = way.normalize_or_zero() * spacing;
            (1..=beyond).map(move |number| end + way * number as f64)
        };
        // A few points back, so that a crooked end does not count.
        let back = (count / 4).clamp(1, 4);
        let before = extended(line[0], line[0] - line[back]);
        let mut points: Vec<DVec2> = before.collect();
        points.reverse();
        points.extend(&line);
        points.extend(extended(line[count], line[count] - line[count - back]));
        let mut centerline = Self {
            points,
            first: -(beyond as f64) * spacing,
            spacing,
            length: inner + clip,
            width,
            girths: Vec::new(),
            area,
            stray: 0.0,
            ways: None,
        };
        let joint = centerline.along(joint).clamp(-clip, inner / 2.0);
        centerline.first -= joint;
        centerline.length -= joint;
        centerline
    }

    /// From the joint to the far end.
    pub(crate) fn length(&self) -> f64 {
        self.length
    }

    /// The mean width of the outline.
    pub(crate) fn width(&self) -> f64 {
        self.width
    }

    /// The point at a distance along the line.
    pub(super) fn at(&self, distance: f64) -> DVec2 {
        let place = (distance - self.first) / self.spacing;
        let last = self.points.len() - 2;
        let segment = (place.floor().max(0.0) as usize).min(last);
        self.points[segment].lerp(self.points[segment + 1], place - segment as f64)
    }

    /// How far along the line a point is. It changes smoothly from point to point, also where several points of the line are equally
    /// near.
    pub(super) fn along(&self, point: DVec2) -> f64 {
        let near = self.spacing * self.spacing;
        let (mut sum, mut total) = (0.0, 0.0);
        let range = match &self.ways {
            None => 0..self.points.len(),
            Some(ways) => {
                let about = ways.at(point) - self.first;
                let place = |along: f64| (along / self.spacing).max(0.0) as usize;
                let reach = WINDOW * self.width;
                let last = self.points.len() - 1;
                place(about - reach).min(last)..(place(about + reach) + 1).min(last + 1)
            }
        };
        let mut number = range.start as f64;
        for own in &self.points[range] {
            let weight = (own.distance_squared(point) + near).powi(-NEARNESS);
            sum += weight * number;
            total += weight;
            number += 1.0;
        }
        self.first + self.spacing * sum / total
    }

    /// Where the line bends most, between two distances along it, if it bends by more than this angle, degrees.
    pub(super) fn sharpest(&self, [from, to]: [f64; 2], least: f64) -> Option<f64> {
        let reach = self.length * 0.25;
        let bend = |at: f64| {
            let [before, here, after] = [at - reach, at, at + reach].map(|at| self.at(at));
            math::angle_to(here - before, after - here).abs()
        };
        let count = ((to - from) / self.spacing).ceil().max(1.0) as usize;
        let places = (0..=count).map(|step| from + (to - from) * step as f64 / count as f64);
        let sharpest = places.max_by(|a, b| bend(*a).total_cmp(&bend(*b)))?;
        (bend(sharpest) > least.to_radians()).then_some(sharpest)
    }

    /// The line in another frame: its points mapped, its lengths scaled.
    pub(super) fn mapped(&self, map: DAffine2, scale: f64) -> Self {
        Self {
            points: self
                .points
                .iter()
                .map(|point| map.transform_point2(*point))
                .collect(),
            first: self.first * scale,
            spacing: self.spacing * scale,
            length: self.length * scale,
            width: self.width * scale,
            girths: self.girths.iter().map(|girth| girth * scale).collect(),
            area: self.area * scale * scale,
            stray: self.stray,
            ways: self.ways.as_ref().map(|ways| Ways {
                to_outline: ways.to_outline * map.inverse(),
                scale: ways.scale * scale,
                ..ways.clone()
            }),
        }
    }

    /// The numbers that it consists of.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let own = [self.first, self.spacing, self.length, self.width];
        let points = self.points.iter().flat_map(|point| point.to_array());
        let ways = self.ways.iter().flat_map(|ways| {
            let along = ways.along.iter().map(|along| f64::from(*along));
            along.chain(ways.to_outline.to_cols_array())
        });
        own.into_iter().chain(points).chain(ways)
    }
}

fn length(way: &[DVec2]) -> f64 {
    way.windows(2).map(|ends| ends[0].distance(ends[1])).sum()
}

/// `count` + 1 points at equal distances along a way, from a distance on.
fn resampled(way: &[DVec2], from: f64, length: f64, count: usize) -> Vec<DVec2> {
    let mut points = Vec::with_capacity(count + 1);
    let mut passed = 0.0;
    let mut segments = way.windows(2).map(|ends| [ends[0], ends[1]]).peekable();
    let last = way.last().copied().unwrap_or_default();
    for number in 0..=count {
        let wanted = from + length * number as f64 / count as f64;
        while let Some([a, b]) = segments.peek() {
            let own = a.distance(*b);
            if passed + own >= wanted {
                break;
            }
            passed += own;
            segments.next();
        }
        points.push(match segments.peek() {
            Some([a, b]) => {
                let own = a.distance(*b);
                let share = if own > 0.0 {
                    (wanted - passed) / own
                } else {
                    0.0
                };
                a.lerp(*b, share)
            }
            None => last,
        });
    }
    points
}

/// Draws each point but the ends half way to the mean of its neighbours.
fn smooth(line: &mut [DVec2]) {
    let mut before = line[0];
    for at in 1..line.len() - 1 {
        let own = line[at];
        line[at] = own.lerp(before.midpoint(line[at + 1]), 0.5);
        before = own;
    }
}

/// How many points are beyond each end of a line.
fn beyond(width: f64, spacing: f64) -> usize {
    (BEYOND * width / spacing).ceil() as usize
}

/// Makes a line straight if all its points are nearer than this to the straight line that fits them best.
fn straighten(line: &mut [DVec2], near: f64) {
    let count = line.len() as f64;
    let middle = line.iter().sum::<DVec2>() / count;
    let [first, .., last] = line else { return };
    let (first, last) = (*first, *last);
    // The direction in which the points are spread most.
    let (mut spread, mut skew) = (0.0, 0.0);
    for point in line.iter() {
        let own = *point - middle;
        spread += own.x * own.x - own.y * own.y;
        skew += 2.0 * own.x * own.y;
    }
    let whole = math::hypot(spread, skew);
    if whole == 0.0 {
        return;
    }
    let [across, along] =
        [1.0 - spread / whole, 1.0 + spread / whole].map(|share| (share.max(0.0) / 2.0).sqrt());
    let axis = DVec2::new(along, across.copysign(skew));
    let on = |point: DVec2| middle + axis * (point - middle).dot(axis);
    if line.iter().all(|point| on(*point).distance(*point) < near) {
        let ends = [on(first), on(last)];
        let steps = count - 1.0;
        for (number, point) in line.iter_mut().enumerate() {
            *point = ends[0].lerp(ends[1], number as f64 / steps);
        }
    }
}
