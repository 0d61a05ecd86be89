//! Smooth changes in time.

use crate::math;
use glam::DVec3;

/// How far the filter reaches, in standard deviations.
const REACH: f64 = 3.0;

/// Eases from 0 to 1 while `t` goes from 0 to 1, with no speed at either end; constant beyond.
pub(crate) fn ease(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Smooths a path by a Gaussian filter of this standard deviation, in points; one that is not positive changes nothing. The path is
/// continued at both ends by its mirror image through the end, so that the ends stay and a steady movement remains one.
pub(crate) fn smoothed(path: &[DVec3], deviation: f64) -> Vec<DVec3> {
    if path.is_empty() || deviation.is_nan() || deviation <= 0.0 {
        return path.to_vec();
    }
    let last = path.len() as i64 - 1;
    let reach = ((deviation * REACH).ceil() as i64).min(last);
    let weight = |offset: i64| math::exp(-0.5 * (offset as f64 / deviation).powi(2));
    let weights: Vec<f64> = (0..=reach).map(weight).collect();
    let total = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    let at = |index: i64| {
        let inside = |index: i64| path[index.clamp(0, last) as usize];
        match index {
            ..0 => 2.0 * path[0] - inside(-index),
            _ if index > last => 2.0 * inside(last) - inside(2 * last - index),
            _ => inside(index),
        }
    };
    let point = |index: i64| {
        let around = (1..=reach)
            .map(|offset| (at(index - offset) + at(index + offset)) * weights[offset as usize]);
        (at(index) * weights[0] + around.sum::<DVec3>()) / total
    };
    (0..=last).map(point).collect()
}

/// The smooth curve that is nowhere below some values and nowhere far above them: the greatest value within `reach` points, averaged
/// over as many to both sides with the weights of a cosine bell. In a cycle, the last value is the first one again.
pub(crate) fn envelope(values: &[f64], reach: usize, is_cycle: bool) -> Vec<f64> {
    let period = values.len().saturating_sub(1);
    let is_cycle = is_cycle && period > 0;
    let reach = reach.min(period);
    // Places are counted from one reach before the first value.
    let around = |at: usize| {
        let (from, to) = (at, at + 2 * reach + 1);
        (from..to).filter_map(move |place| match is_cycle {
            true => Some((place + period - reach % period) % period),
            false => place.checked_sub(reach).filter(|place| *place <= period),
        })
    };
    let greatest = |at: usize| {
        around(at)
            .map(|place| values[place])
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let greatest: Vec<f64> = (0..values.len()).map(greatest).collect();
    let bell = |at: usize, place: usize| {
        let apart = at.abs_diff(place);
        let apart = if is_cycle {
            apart.min(period.abs_diff(apart))
        } else {
            apart
        };
        1.0 + math::cos(std::f64::consts::PI * apart as f64 / (reach + 1) as f64)
    };
    let mean = |at: usize| {
        let weighed = around(at).map(|place| (greatest[place], bell(at, place)));
        let (sum, weights) = weighed.fold((0.0, 0.0), |(sum, all), (value, weight)| {
            (sum + value * weight, all + weight)
        });
        sum / weights
    };
    (0..values.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points 24 times a second, for 4 seconds.
    fn path(place: impl Fn(f64) -> f64) -> Vec<DVec3> {
        (0..=96)
            .map(|index| DVec3::X * place(f64::from(index) / 24.0))
            .collect()
    }

    fn largest_difference(one: &[DVec3], other: &[DVec3]) -> f64 {
        let pairs = one.iter().zip(other);
        pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }

    #[test]
    fn steady_movements_stay_and_swaying_vanishes() {
        let steady = path(|time| 1.3 * time + 0.2);
        assert!(largest_difference(&smoothed(&steady, 9.6), &steady) < 1e-9);
        let swaying =
            path(|time| 1.3 * time + 0.2 + 0.1 * (time * 2.0 * std::f64::consts::TAU).sin());
        assert!(largest_difference(&smoothed(&swaying, 9.6), &steady) < 0.02);
        // Longer than the path.
        assert!(largest_difference(&smoothed(&steady[..5], 9.6), &steady[..5]) < 1e-9);
        assert_eq!(smoothed(&steady[..1], 9.6), &steady[..1]);
    }

    #[test]
    fn an_envelope_is_above_its_values_and_smooth() {
        let values: Vec<f64> = (0..60).map(|at| if at == 30 { 1.0 } else { 0.0 }).collect();
        let curve = envelope(&values, 4, false);
        assert!(
            curve
                .iter()
                .zip(&values)
                .all(|(curve, value)| curve >= value)
        );
        assert_eq!((curve[30], curve[21], curve[39]), (1.0, 0.0, 0.0));
        let steps = curve.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        assert!(steps.fold(0.0, f64::max) < 0.3);
        assert_eq!(envelope(&values, 0, false), values);
        assert!(envelope(&[], 3, true).is_empty());
        // Of a cycle, the end knows of the beginning.
        let values: Vec<f64> = (0..=20)
            .map(|at| if at % 20 == 1 { 1.0 } else { 0.0 })
            .collect();
        let curve = envelope(&values, 3, true);
        assert!((curve[0] - curve[20]).abs() < 1e-12 && curve[18] > 0.0 && curve[10] == 0.0);
        assert!(
            curve
                .iter()
                .zip(&values)
                .all(|(curve, value)| *curve >= value - 1e-12)
        );
    }

    #[test]
    fn without_a_deviation_nothing_changes() {
        let path = path(|time| time * time);
        for deviation in [0.0, -1.0, f64::NAN] {
            assert_eq!(smoothed(&path, deviation), path);
        }
        assert!(smoothed(&[], 2.0).is_empty());
    }
}
