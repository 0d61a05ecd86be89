//! The curves of which the clips are made. Time in a cycle counts in turns, from 0 to 1.

use std::f64::consts::TAU;

use crate::math;
use crate::smoothing::ease;

/// A wave with its crest, 1, at `crest` and its trough, −1, half a turn later.
pub(super) fn wave(t: f64, crest: f64) -> f64 {
    math::cos((t - crest) * TAU)
}

/// A bump from 0 up to 1 at `peak` and down to 0, while `t` goes from 0 to 1; it starts and ends without speed.
pub(super) fn bump(t: f64, peak: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    // Bends time so that `peak` is in the middle.
    let bent = math::powf(t, math::ln(0.5_f64) / math::ln(peak));
    (bent * (1.0 - bent) * 4.0).powi(2)
}

/// The value at `t` between keys, each a time and a value, in order; it eases from key to key and is constant beyond them.
pub(super) fn keyed(keys: &[(f64, f64)], t: f64) -> f64 {
    let after = keys.partition_point(|(time, _)| *time <= t);
    match (
        after.checked_sub(1).map(|before| keys[before]),
        keys.get(after),
    ) {
        (Some((from, a)), Some(&(to, b))) => a + (b - a) * ease((t - from) / (to - from)),
        (Some((_, only)), None) | (None, Some(&(_, only))) => only,
        (None, None) => 0.0,
    }
}

/// A cubic from `from` to `to` with these velocities at its ends, while `t` goes from 0 to 1.
pub(super) fn hermite(from: f64, to: f64, velocities: [f64; 2], t: f64) -> f64 {
    let (t2, t3) = (t * t, t * t * t);
    from * (2.0 * t3 - 3.0 * t2 + 1.0)
        + velocities[0] * (t3 - 2.0 * t2 + t)
        + to * (3.0 * t2 - 2.0 * t3)
        + velocities[1] * (t3 - t2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_pass_through_their_keys() {
        let keys = [(0.0, 1.0), (2.0, 5.0), (4.0, -1.0)];
        for (t, value) in [(-1.0, 1.0), (0.0, 1.0), (1.0, 3.0), (2.0, 5.0), (9.0, -1.0)] {
            assert!((keyed(&keys, t) - value).abs() < 1e-12, "{t}");
        }
        assert_eq!(keyed(&[], 1.0), 0.0);
        for peak in [0.3, 0.5, 0.7] {
            assert!((bump(peak, peak) - 1.0).abs() < 1e-9);
            assert!(bump(0.0, peak).abs() < 1e-12 && bump(1.0, peak).abs() < 1e-12);
        }
        assert_eq!(hermite(2.0, 7.0, [1.0, -1.0], 0.0), 2.0);
        assert_eq!(hermite(2.0, 7.0, [1.0, -1.0], 1.0), 7.0);
        assert!((wave(0.75, 0.25) + 1.0).abs() < 1e-12);
    }
}
