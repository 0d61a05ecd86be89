//! The similarity transform that takes one outline to another: a turn, a scale and a shift.

use std::f64::consts::PI;

use crate::math;

use glam::{DAffine2, DVec2};

use super::Ring;

/// Outlines are compared at so many points, evenly spaced along their borders.
const SAMPLES: usize = 64;

/// The similarity transform that takes one outline as near to another as possible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Similarity {
    /// Turn, radians, from x to y.
    pub angle: f64,
    /// Scale, above 0.
    pub scale: f64,
    /// Where the middle of the first outline goes: from, to.
    pub middle: [DVec2; 2],
    /// How far points of the two are apart then, root mean square, as a share of the second outline's own.
    pub residual: f64,
    /// Whether the mirrored outline would fit, and this one does not.
    pub is_mirrored: bool,
}

impl Similarity {
    /// The turn and the shift without the scale, about the outline's middle.
    pub(crate) fn rigid(&self) -> DAffine2 {
        let [from, to] = self.middle;
        DAffine2::from_translation(to)
            * DAffine2::from_mat2(math::rotation(self.angle))
            * DAffine2::from_translation(-from)
    }
}

/// The similarity that takes points to others, in least squares; `None` if there are not as many, or all are in one place.
pub(crate) fn between_points(from: &[DVec2], to: &[DVec2]) -> Option<Similarity> {
    if from.len() != to.len() || from.len() < 2 {
        return None;
    }
    let count = from.len() as f64;
    let mean = |points: &[DVec2]| points.iter().sum::<DVec2>() / count;
    let middle = [mean(from), mean(to)];
    // As complex numbers: the best factor is Σ conj(p) q / Σ |p|²; of the mirror image, Σ p q / Σ |p|².
    let (mut turned, mut mirrored) = (DVec2::ZERO, DVec2::ZERO);
    let (mut own, mut other) = (0.0, 0.0);
    for (p, q) in from.iter().zip(to) {
        let (p, q) = (*p - middle[0], *q - middle[1]);
        turned += DVec2::new(p.dot(q), p.perp_dot(q));
        mirrored += DVec2::new(p.x * q.x - p.y * q.y, p.x * q.y + p.y * q.x);
        own += p.length_squared();
        other += q.length_squared();
    }
    if own <= 0.0 || other <= 0.0 {
        return None;
    }
    let rest = |factor: DVec2| ((other - factor.length_squared() / own).max(0.0) / other).sqrt();
    let (residual, mirror) = (rest(turned), rest(mirrored));
    Some(Similarity {
        angle: math::atan2(turned.y, turned.x),
        scale: turned.length() / own,
        middle,
        residual,
        is_mirrored: residual > MIRRORED && mirror < 0.5 * residual,
    })
}

/// An outline that fits less well than this may be mirrored.
const MIRRORED: f64 = 0.02;

/// The borders of a round outline are spread by at most this share more in one direction than across it.
const ROUND: f64 = 0.02;
/// A round outline is turned only if it then fits better by this.
const ROUND_MARGIN: f64 = 0.005;

/// The similarity that takes an outline to one that may have other points, by lengths along the borders; `None` if one has no length.
pub(crate) fn between_rings(from: &[Ring], to: &[Ring]) -> Option<Similarity> {
    let (one, other) = (Spread::of(from)?, Spread::of(to)?);
    let scale = other.length / one.length;
    let turn = other.direction - one.direction;
    let [samples, targets] = [from, to].map(samples);
    let middle = [one.middle, other.middle];
    let fit = |angle: f64| {
        let map = |at: &DVec2| middle[1] + math::direction(angle).rotate(*at - middle[0]) * scale;
        let apart = samples.iter().map(|at| {
            let at = map(at);
            let near = targets.iter().map(|target| target.distance_squared(at));
            near.fold(f64::INFINITY, f64::min)
        });
        (apart.sum::<f64>() / samples.len() as f64).sqrt() / other.radius
    };
    // What is round has no direction: then no turn is the best guess.
    let is_round = one.is_round || other.is_round;
    let mut best: Option<Similarity> = None;
    for angle in std::iter::once(0.0)
        .filter(|_| is_round)
        .chain([turn, turn + PI])
    {
        let residual = fit(angle);
        let margin = if is_round { ROUND_MARGIN } else { 0.0 };
        if best.is_none_or(|best| residual < best.residual - margin) {
            best = Some(Similarity {
                angle,
                scale,
                middle,
                residual,
                is_mirrored: false,
            });
        }
    }
    best
}

/// How the borders of an outline are spread.
struct Spread {
    length: f64,
    middle: DVec2,
    /// The direction in which they are spread most, radians.
    direction: f64,
    /// Whether they are spread alike in all directions.
    is_round: bool,
    /// The root mean square distance from the middle.
    radius: f64,
}

impl Spread {
    fn of(rings: &[Ring]) -> Option<Self> {
        let edges = || rings.iter().flat_map(closed);
        let length: f64 = edges().map(|[a, b]| a.distance(b)).sum();
        if length <= 0.0 {
            return None;
        }
        let middle = edges().map(|[a, b]| a.midpoint(b) * a.distance(b));
        let middle = middle.sum::<DVec2>() / length;
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for [a, b] in edges() {
            let (at, along) = (a.midpoint(b) - middle, b - a);
            let weight = a.distance(b) / length;
            xx += weight * (at.x * at.x + along.x * along.x / 12.0);
            xy += weight * (at.x * at.y + along.x * along.y / 12.0);
            yy += weight * (at.y * at.y + along.y * along.y / 12.0);
        }
        let radius = (xx + yy).sqrt();
        (radius > 0.0).then_some(Self {
            length,
            middle,
            direction: 0.5 * math::atan2(2.0 * xy, xx - yy),
            is_round: math::hypot(2.0 * xy, xx - yy) < ROUND * (xx + yy),
            radius,
        })
    }
}

fn closed(ring: &Ring) -> impl Iterator<Item = [DVec2; 2]> {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// Points along the borders.
fn samples(rings: &[Ring]) -> Vec<DVec2> {
    let edges = || rings.iter().flat_map(closed);
    let length: f64 = edges().map(|[a, b]| a.distance(b)).sum();
    let step = length / SAMPLES as f64;
    let (mut found, mut next) = (Vec::with_capacity(SAMPLES + 1), 0.0);
    let mut passed = 0.0;
    for [a, b] in edges() {
        let own = a.distance(b);
        while next < passed + own && found.len() <= SAMPLES {
            found.push(a.lerp(b, (next - passed) / own));
            next += step;
        }
        passed += own;
    }
    found
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn turned(points: &[DVec2], angle: f64, scale: f64, shift: DVec2) -> Vec<DVec2> {
        let turn = DVec2::from_angle(angle);
        let points = points.iter();
        points.map(|at| turn.rotate(*at) * scale + shift).collect()
    }

    /// A club: it looks the same neither turned by half a circle nor mirrored.
    const CLUB: [DVec2; 6] = [
        DVec2::new(0.0, 0.0),
        DVec2::new(4.0, 0.0),
        DVec2::new(5.0, 20.0),
        DVec2::new(9.0, 26.0),
        DVec2::new(1.0, 29.0),
        DVec2::new(-1.0, 22.0),
    ];

    proptest! {
        #[test]
        fn a_moved_outline_is_found(angle in -3.1..3.1_f64, scale in 0.5..2.0_f64, x in -99.0..99.0_f64) {
            let shift = DVec2::new(x, 3.0 - x);
            let moved = turned(&CLUB, angle, scale, shift);
            let found = between_points(&CLUB, &moved).unwrap();
            prop_assert!((found.angle - angle).abs() < 1e-9 && (found.scale - scale).abs() < 1e-9);
            prop_assert!(found.residual < 1e-7 && !found.is_mirrored);
            if (scale - 1.0).abs() < 1e-9 {
                prop_assert!(found.rigid().transform_point2(CLUB[2]).distance(moved[2]) < 1e-9);
            }
            // With one more point on an edge, and another first one.
            let mut other = moved.clone();
            other.insert(2, moved[1].lerp(moved[2], 0.3));
            other.rotate_left(3);
            prop_assert!(between_points(&CLUB, &other).is_none());
            let found = between_rings(&[CLUB.to_vec()], &[other]).unwrap();
            let off = DVec2::from_angle(found.angle).angle_to(DVec2::from_angle(angle));
            prop_assert!(off.abs() < 0.01, "{found:?} {angle}");
            prop_assert!((found.scale - scale).abs() < 1e-9);
        }
    }

    #[test]
    fn mirror_images_are_told_from_other_shapes() {
        let mirrored: Vec<DVec2> = CLUB.iter().map(|at| DVec2::new(-at.x, at.y)).collect();
        assert!(between_points(&CLUB, &mirrored).unwrap().is_mirrored);
        let mut bent = CLUB.to_vec();
        bent[3].x += 1.0;
        let found = between_points(&CLUB, &bent).unwrap();
        assert!(!found.is_mirrored && found.residual > 0.01, "{found:?}");
    }

    #[test]
    fn round_outlines_are_not_turned() {
        let circle = |count: usize| -> Ring {
            let angles = (0..count).map(|index| 2.0 * PI * index as f64 / count as f64);
            angles.map(DVec2::from_angle).collect()
        };
        let found = between_rings(&[circle(80)], &[circle(66)]).unwrap();
        assert_eq!(found.angle, 0.0);
    }
}
