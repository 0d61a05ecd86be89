//! usvg's paths and transforms in f64, and properties of a single path.

use std::sync::Arc;

use glam::{DAffine2, DMat2, DVec2};
use kurbo::BezPath;
use roxmltree::Node;
use usvg::tiny_skia_path as skia;

use super::{Line, Paint};
use crate::geometry::{FillRule, Outline, bounds_of, flatten, resolve_overlaps, subtract};

/// The smallest tolerance of flattening, as a fraction of the path's extent. It limits the number of segments.
const FINEST: f64 = 1e-5;

/// A stroke, whose outline is computed on demand.
#[derive(Debug, Clone)]
pub struct StrokeSource {
    pub(super) path: skia::Path,
    pub(super) stroke: skia::Stroke,
    pub(super) transform: DAffine2,
    pub(super) tolerance: f64,
    /// The fill that is painted over the stroke, if it is.
    pub(super) covered_by: Option<Arc<Outline>>,
    /// The stroke's paint.
    pub paint: Paint,
    /// Whether nothing can be seen through it, apart from the opacities of its element and of groups.
    pub is_opaque: bool,
}

impl StrokeSource {
    /// The width of the stroke, drawing units; the mean of all directions if it is not scaled evenly.
    pub fn width(&self) -> f64 {
        let scale = self.transform.matrix2.determinant().abs().sqrt();
        f64::from(self.stroke.width) * scale
    }

    /// Whether it is drawn with gaps.
    pub fn is_dashed(&self) -> bool {
        self.stroke.dash.is_some()
    }

    /// The centre line of the stroke as line segments that deviate by at most `tolerance` drawing units, or by a
    /// hundred-thousandth of its extent. Gaps of dashes are filled.
    pub fn middle_line(&self, tolerance: f64, mut each: impl FnMut(DVec2, DVec2)) {
        let path = bez_path(&self.path, self.transform);
        let bounds = path.control_box();
        let finest = FINEST * bounds.width().max(bounds.height());
        if !finest.is_finite() {
            return;
        }
        let (mut start, mut at) = (DVec2::ZERO, DVec2::ZERO);
        kurbo::flatten(&path, tolerance.max(finest), |element| match element {
            kurbo::PathEl::MoveTo(p) => {
                at = DVec2::new(p.x, p.y);
                start = at;
            }
            kurbo::PathEl::LineTo(p) => {
                let to = DVec2::new(p.x, p.y);
                each(at, to);
                at = to;
            }
            kurbo::PathEl::ClosePath => {
                each(at, start);
                at = start;
            }
            // The curves have been flattened.
            kurbo::PathEl::QuadTo(..) | kurbo::PathEl::CurveTo(..) => {}
        });
    }

    /// The lower and the upper corner of a box around the stroke, drawing units, without the tips of mitred corners; `None` if there is
    /// no line.
    pub(crate) fn bounds(&self) -> Option<(DVec2, DVec2)> {
        let mut ends = Vec::new();
        self.middle_line(self.tolerance, |from, to| ends.extend([from, to]));
        let half = self.width() / 2.0;
        bounds_of(ends).map(|(low, high)| (low - half, high + half))
    }

    /// The middle of a single open line with round ends and no dashes, as of [`middle_line`](Self::middle_line).
    pub fn open_line(&self, tolerance: f64) -> Option<Vec<DVec2>> {
        if self.stroke.line_cap != skia::LineCap::Round || self.stroke.dash.is_some() {
            return None;
        }
        let mut points: Vec<DVec2> = Vec::new();
        let mut is_one = true;
        self.middle_line(tolerance, |from, to| {
            is_one &= points.last().is_none_or(|last| *last == from);
            if points.is_empty() {
                points.push(from);
            }
            points.push(to);
        });
        let is_open = points.first() != points.last();
        (is_one && is_open).then_some(points)
    }

    /// The area in which the stroke is seen.
    pub fn outline(&self) -> Outline {
        let whole = self.whole_outline();
        match &self.covered_by {
            Some(fill) => subtract(&whole, fill),
            None => whole,
        }
    }

    /// The area that the stroke covers.
    fn whole_outline(&self) -> Outline {
        let extent = self
            .path
            .bounds()
            .width()
            .max(self.path.bounds().height())
            .max(self.stroke.width);
        let resolution = (1000.0 / extent).clamp(1e-3, 1e4);
        let dashed = self
            .stroke
            .dash
            .as_ref()
            .and_then(|dash| self.path.dash(dash, resolution));
        match dashed
            .as_ref()
            .unwrap_or(&self.path)
            .stroke(&self.stroke, resolution)
        {
            None => Outline::default(),
            Some(path) => {
                let path = bez_path(&path, self.transform);
                resolve_overlaps(flatten(&path, self.tolerance), FillRule::NonZero)
            }
        }
    }
}

/// usvg's transform in f64.
pub(super) fn affine(t: usvg::Transform) -> DAffine2 {
    DAffine2::from_mat2_translation(
        DMat2::from_cols(
            DVec2::new(f64::from(t.sx), f64::from(t.ky)),
            DVec2::new(f64::from(t.kx), f64::from(t.sy)),
        ),
        DVec2::new(f64::from(t.tx), f64::from(t.ty)),
    )
}

/// A path with its transform applied in f64.
pub(super) fn bez_path(path: &skia::Path, transform: DAffine2) -> BezPath {
    let point = |p: skia::Point| {
        let p = transform.transform_point2(DVec2::new(f64::from(p.x), f64::from(p.y)));
        kurbo::Point::new(p.x, p.y)
    };
    let mut out = BezPath::with_capacity(path.verbs().len());
    for segment in path.segments() {
        match segment {
            skia::PathSegment::MoveTo(p) => out.move_to(point(p)),
            skia::PathSegment::LineTo(p) => out.line_to(point(p)),
            skia::PathSegment::QuadTo(a, p) => out.quad_to(point(a), point(p)),
            skia::PathSegment::CubicTo(a, b, p) => out.curve_to(point(a), point(b), point(p)),
            skia::PathSegment::Close => out.close_path(),
        }
    }
    out
}

/// How far a curve leaves the straight line between its ends at least, as a share of that line's length.
const BENT: f64 = 0.02;

/// The share of a path's length that is curves. Those that are almost straight count as lines.
pub(super) fn curved(path: &BezPath) -> f64 {
    let (mut curved, mut straight) = (0.0, 0.0);
    for segment in path.segments() {
        let points = match segment {
            kurbo::PathSeg::Line(line) => {
                straight += (line.p1 - line.p0).hypot();
                continue;
            }
            kurbo::PathSeg::Quad(quad) => [quad.p0, quad.p1, quad.p1, quad.p2],
            kurbo::PathSeg::Cubic(cubic) => [cubic.p0, cubic.p1, cubic.p2, cubic.p3],
        };
        let [start, .., end] = points;
        let chord = end - start;
        let is_away = |control: &kurbo::Point| {
            let out = *control - start;
            // A curve that returns to its start has no straight line between its ends.
            out.cross(chord).abs() > BENT * chord.hypot2() || out.hypot2() > chord.hypot2()
        };
        // Between its chord and its control polygon, which is near enough for a share.
        let around: f64 = points
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).hypot())
            .sum();
        let length = chord.hypot().midpoint(around);
        if points[1..3].iter().any(is_away) {
            curved += length;
        } else {
            straight += length;
        }
    }
    let length = curved + straight;
    if length > 0.0 { curved / length } else { 0.0 }
}

pub(super) fn open_line(path: &BezPath, node: Node<'_, '_>) -> Option<Box<Line>> {
    let mut ends = None;
    for element in path.elements() {
        match element {
            kurbo::PathEl::MoveTo(p) if ends.is_none() => ends = Some([*p, *p]),
            // Several subpaths or a closed one: not a leader line.
            kurbo::PathEl::MoveTo(_) | kurbo::PathEl::ClosePath => return None,
            other => {
                if let (Some(ends), Some(p)) = (&mut ends, other.end_point()) {
                    ends[1] = p;
                }
            }
        }
    }
    let connects = ["connection-start", "connection-end"].map(|name| {
        let attribute = node
            .attributes()
            .find(|attribute| attribute.name() == name)?;
        attribute.value().strip_prefix('#').map(str::to_owned)
    });
    ends.map(|ends| {
        Box::new(Line {
            ends: ends.map(|p| DVec2::new(p.x, p.y)),
            connects,
        })
    })
}
