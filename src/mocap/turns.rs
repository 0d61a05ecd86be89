//! Rotations that follow each other in time.

use crate::math;
use glam::{DQuat, DVec3};

/// Whether consecutive quaternions are as near to each other as they can be.
pub(crate) fn is_continuous(turns: &[DQuat]) -> bool {
    turns.windows(2).all(|pair| pair[1].dot(pair[0]) >= 0.0)
}

/// Flips signs so that consecutive quaternions are as near to each other as possible; the rotations are the same.
pub(crate) fn continuous(mut turns: Vec<DQuat>) -> Vec<DQuat> {
    for at in 1..turns.len() {
        if turns[at].dot(turns[at - 1]) < 0.0 {
            turns[at] = -turns[at];
        }
    }
    turns
}

/// Damps rotations: Fᵢ = B + (Fᵢ − B)·R, with B the first of them.
///
/// Source: equation 1 of the paper, which damps angles. Here the rotation from B to each frame is followed through time, so that a
/// turn of more than 180° stays one, and then shortened to the ratio R. With R = 1 nothing changes, with R = 0 all become B.
pub(crate) fn damp(turns: &mut Vec<DQuat>, ratio: f64) {
    if ratio == 1.0 || turns.is_empty() {
        return;
    }
    *turns = continuous(std::mem::take(turns));
    let first = turns[0];
    let mut before = DVec3::ZERO;
    for turn in turns {
        let way = first.inverse() * *turn;
        let length = way.xyz().length();
        // A whole turn has no axis of its own.
        let axis = if length > 1e-12 {
            way.xyz() / length
        } else {
            before.normalize_or_zero()
        };
        // Quaternions repeat after two whole turns; of all such angles, the one nearest to that of the frame before.
        let angle = 2.0 * math::atan2(length, way.w);
        let whole = 2.0 * std::f64::consts::TAU;
        let turns = ((before.dot(axis) - angle) / whole).round();
        let vector = axis * (angle + turns * whole);
        before = vector;
        *turn = match ratio {
            0.0 => first,
            _ => (first * math::rotation_along(vector * ratio)).normalize(),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_scale_angles_beyond_half_a_turn() {
        let start = DQuat::from_rotation_x(0.7);
        let spin = |degrees: f64| start * DQuat::from_rotation_z(degrees.to_radians());
        let angles: Vec<f64> = (0..=90).map(|frame| 10.0 * f64::from(frame)).collect();
        let full: Vec<DQuat> = angles.iter().map(|angle| spin(*angle)).collect();
        for ratio in [0.0, 0.1, 0.5, 0.99] {
            let mut damped = full.clone();
            damp(&mut damped, ratio);
            for (turn, angle) in damped.iter().zip(&angles) {
                assert!(turn.angle_between(spin(angle * ratio)) < 1e-6);
            }
        }
        let mut same = full.clone();
        damp(&mut same, 1.0);
        assert_eq!(same, full);
        let mut still = full;
        damp(&mut still, 0.0);
        assert!(still.iter().all(|turn| *turn == start));
    }
}
