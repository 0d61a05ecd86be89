//! Axis, centre and end points of a part (Arai & Horry, section 3.3).
//!
//! Drawing units, y down. The paper fits a regression line to the vertices; here the axis is the principal axis of the
//! area within the borders, so that it depends neither on how curves are flattened nor on the frame.

use crate::math;
use glam::DVec2;

use super::{Outline, query};

/// Up in the drawing.
const UP: DVec2 = DVec2::new(0.0, -1.0);
/// Principal moments this close, relative to the larger, leave the axis undetermined.
const EQUAL_MOMENTS: f64 = 0.01;
/// Directions this close to horizontal or vertical are snapped to it.
const SNAP_TO_AXIS: f64 = 1e-9;

/// Position, direction and size of an outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// Unit vector along the axis; it points up in the drawing, or right if horizontal.
    pub axis: DVec2,
    /// The middle of the extents along and across the axis.
    pub center: DVec2,
    /// The ends of the extent along the axis, on the line through the centre; the axis points to the first.
    pub ends: [DVec2; 2],
    /// Half the extent along the axis.
    pub half_along: f64,
    /// Half the extent across the axis.
    pub half_across: f64,
    /// The bounding box along the page's axes: the lower and the upper corner.
    pub bounds: (DVec2, DVec2),
    /// False if the moments do not determine the axis, as for a circle or a square.
    pub certain: bool,
}

impl Measure {
    /// The ends of the axis: the one nearer to the parent's centre first; without a parent, the upper one first.
    pub(crate) fn sorted_ends(&self, parent: Option<DVec2>) -> [DVec2; 2] {
        let [a, b] = self.ends;
        let swapped = match parent {
            Some(parent) => b.distance_squared(parent) < a.distance_squared(parent),
            None => b.y < a.y,
        };
        if swapped { [b, a] } else { [a, b] }
    }
}

/// How far a solid reaches to the back and to the front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Thickness {
    /// Its least and its greatest depth in the frame of its node, drawing units.
    pub depths: [f64; 2],
    /// Whether it is thinner towards its outline.
    pub is_soft: bool,
}

/// The measure of an outline along its principal axis; `None` if it has no area.
pub(crate) fn measure(outline: &Outline) -> Option<Measure> {
    let (low, high) = query::bounds(outline)?;
    let extent = (high - low).max_element();
    if !(extent > 0.0 && extent.is_finite()) {
        return None;
    }
    // Moments about the middle in units of the extent, for accuracy far from the origin.
    let middle = low.midpoint(high);
    let (mut area, mut first, mut second, mut mixed) = (0.0, DVec2::ZERO, DVec2::ZERO, 0.0);
    for border in outline.polygons.iter().filter_map(|p| p.rings.first()) {
        let Some(last) = border.last() else { continue };
        let mut a = (*last - middle) / extent;
        for &p in border {
            let b = (p - middle) / extent;
            let cross = a.perp_dot(b);
            area += cross / 2.0;
            first += (a + b) * (cross / 6.0);
            second += (a * a + a * b + b * b) * (cross / 12.0);
            mixed += (a.x * (2.0 * a.y + b.y) + b.x * (a.y + 2.0 * b.y)) * (cross / 24.0);
            a = b;
        }
    }
    if area == 0.0 {
        return None;
    }
    let mean = first / area;
    let square = second / area - mean * mean;
    let mixed = mixed / area - mean.x * mean.y;
    let difference = square.x - square.y;
    let spread = math::hypot(difference, 2.0 * mixed);
    let larger = (square.x + square.y + spread) / 2.0;
    let certain = spread > EQUAL_MOMENTS * larger;
    let axis = if certain {
        math::direction(math::atan2(2.0 * mixed, difference) / 2.0)
    } else {
        UP
    };
    let mut measure = within(outline, axis, (low, high))?;
    measure.certain = certain;
    Some(measure)
}

/// The measure of an outline along a given axis; `None` if either is empty.
pub(crate) fn measure_along(outline: &Outline, axis: DVec2) -> Option<Measure> {
    within(outline, axis, query::bounds(outline)?)
}

/// The measure of an outline with the given bounding box along a given axis.
fn within(outline: &Outline, axis: DVec2, (low, high): (DVec2, DVec2)) -> Option<Measure> {
    let axis = upright(axis.try_normalize()?);
    let middle = low.midpoint(high);
    let borders = outline.polygons.iter().flat_map(|p| p.rings.first());
    let (least, most) = query::bounds_of(borders.flatten().map(|p| {
        let p = *p - middle;
        DVec2::new(axis.dot(p), axis.perp_dot(p))
    }))?;
    let half = (most - least) / 2.0;
    let foot = least.midpoint(most);
    let center = middle + axis * foot.x + axis.perp() * foot.y;
    center.is_finite().then_some(Measure {
        axis,
        center,
        ends: [center + axis * half.x, center - axis * half.x],
        half_along: half.x,
        half_across: half.y,
        bounds: (low, high),
        certain: true,
    })
}

fn upright(axis: DVec2) -> DVec2 {
    if axis.y.abs() < SNAP_TO_AXIS {
        DVec2::X
    } else if axis.x.abs() < SNAP_TO_AXIS {
        UP
    } else if axis.y > 0.0 {
        -axis
    } else {
        axis
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{FillRule, Ring, resolve_overlaps};
    use proptest::prelude::*;

    fn outline(ring: Ring) -> Outline {
        resolve_overlaps(vec![ring], FillRule::NonZero)
    }

    fn rectangle(w: f64, h: f64, turn: f64, at: DVec2) -> Outline {
        let turn = DVec2::from_angle(turn);
        let corners = [(-w, -h), (w, -h), (w, h), (-w, h)];
        outline(
            corners
                .map(|(x, y)| at + turn.rotate(DVec2::new(x, y)))
                .to_vec(),
        )
    }

    #[test]
    fn upright_and_level_rectangles() {
        let m = measure(&rectangle(1.0, 3.0, 0.0, DVec2::new(5.0, 7.0))).unwrap();
        assert_eq!(
            (m.axis, m.center, m.certain),
            (UP, DVec2::new(5.0, 7.0), true)
        );
        assert_eq!(m.ends, [DVec2::new(5.0, 4.0), DVec2::new(5.0, 10.0)]);
        assert_eq!((m.half_along, m.half_across), (3.0, 1.0));
        let m = measure(&rectangle(3.0, 1.0, 0.0, DVec2::ZERO)).unwrap();
        assert_eq!((m.axis, m.half_along), (DVec2::X, 3.0));
        assert_eq!(m.ends[0], DVec2::new(3.0, 0.0));
    }

    #[test]
    fn squares_and_circles_have_an_upright_axis() {
        let circle =
            (0..48).map(|i| 1e4 + 7.0 * DVec2::from_angle(i as f64 / 48.0 * std::f64::consts::TAU));
        for o in [
            rectangle(2.0, 2.0, 0.3, DVec2::ONE),
            outline(circle.collect()),
        ] {
            let m = measure(&o).unwrap();
            assert_eq!((m.axis, m.certain), (UP, false));
        }
    }

    #[test]
    fn empty_outlines_have_no_measure() {
        assert_eq!(measure(&Outline::default()), None);
        let o = rectangle(1.0, 2.0, 0.0, DVec2::ZERO);
        assert_eq!(measure_along(&o, DVec2::ZERO), None);
        assert_eq!(measure_along(&o, DVec2::NAN), None);
        assert_eq!(
            measure_along(&o, DVec2::new(2.0, 0.0)).unwrap().half_along,
            1.0
        );
    }

    #[test]
    fn a_slanted_triangle_has_its_principal_axis() {
        let m = measure(&outline(vec![
            DVec2::ZERO,
            DVec2::new(10.0, -10.0),
            DVec2::new(9.0, -11.0),
        ]))
        .unwrap();
        assert!((m.axis - DVec2::new(1.0, -1.0).normalize()).length() < 0.1 && m.axis.y < 0.0);
    }

    proptest! {
        #[test]
        fn the_measure_follows_rotation_and_translation(
            w in 0.1..5.0f64, h in 6.0..20.0f64, turn in -3.1..3.1f64, x in -1e4..1e4f64, y in -1e4..1e4f64,
        ) {
            let at = DVec2::new(x, y);
            let m = measure(&rectangle(w, h, turn, at)).unwrap();
            let axis = DVec2::from_angle(turn).perp();
            prop_assert!(m.axis.perp_dot(axis).abs() < 1e-6, "{:?}", m);
            prop_assert!((m.center - at).length() < 1e-5);
            prop_assert!((m.half_along - h).abs() < 1e-5 && (m.half_across - w).abs() < 1e-5);
            prop_assert!(m.certain && m.axis.y < 1e-8);
            prop_assert!((m.ends[0] - m.center).dot(m.axis) > 0.0);
        }
    }
}
