//! How much marks and joints move: the input information and the motion information (Manya & Matsuda, section 3.2).

use glam::DVec3;

/// A second peak that is at least this share of the largest movement is an action of its own …
const SECOND_PEAK: f64 = 0.9;
/// … if the movement falls below this share in between.
const VALLEY: f64 = 0.5;

/// Where something moves most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Key {
    /// The channel that moves.
    pub channel: usize,
    /// The frame at which it arrives, counted from 0; at least 1.
    pub frame: usize,
}

/// The movement of all channels.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Information {
    /// Per channel and frame its movement since the frame before, as a ratio of the largest of all channels: 0 to 1.
    pub curves: Vec<Vec<f64>>,
    /// The largest movement, in the unit in which movement was measured; 0 if nothing moves.
    pub largest: f64,
    /// The largest movement; of equal ones the earliest. `None` if nothing moves.
    pub key: Option<Key>,
    /// The frame of a second movement that is nearly as large, after or before a pause.
    pub second: Option<usize>,
}

impl Information {
    /// The information in movements, per channel and frame, none of them negative. Those that are not finite count as 0.
    pub fn new(mut movements: Vec<Vec<f64>>) -> Self {
        for movement in movements.iter_mut().flatten() {
            if !movement.is_finite() {
                *movement = 0.0;
            }
        }
        let frames = movements.iter().map(Vec::len).max().unwrap_or(0);
        let of_frame = |frame: usize| {
            let channels = movements.iter().enumerate();
            channels.filter_map(move |(channel, curve)| Some((channel, *curve.get(frame)?)))
        };
        let mut largest = 0.0;
        let mut key = None;
        for frame in 1..frames {
            for (channel, movement) in of_frame(frame) {
                if movement > largest {
                    largest = movement;
                    key = Some(Key { channel, frame });
                }
            }
        }
        let Some(first) = key else {
            let still = |curve: &Vec<f64>| vec![0.0; curve.len()];
            return Self {
                curves: movements.iter().map(still).collect(),
                ..Self::default()
            };
        };
        let envelope: Vec<f64> = (0..frames)
            .map(|frame| {
                of_frame(frame)
                    .map(|(_, m)| m / largest)
                    .fold(0.0, f64::max)
            })
            .collect();
        for movement in movements.iter_mut().flatten() {
            *movement /= largest;
        }
        Self {
            second: second(&envelope, first.frame),
            curves: movements,
            largest,
            key,
        }
    }

    /// How many frames there are.
    pub fn frames(&self) -> usize {
        self.curves.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// The frame in which a channel moves most, the earliest of equal ones; `None` if it does not move.
    pub fn peak(&self, channel: usize) -> Option<usize> {
        let curve = self.curves.get(channel)?;
        let mut best = (None, 0.0);
        for (frame, movement) in curve.iter().enumerate().skip(1) {
            if *movement > best.1 {
                best = (Some(frame), *movement);
            }
        }
        best.0
    }

    /// The largest ratio of a channel: 1 for the one that moves most.
    pub fn largest_of(&self, channel: usize) -> f64 {
        let curve = self.curves.get(channel);
        curve.map_or(0.0, |curve| curve.iter().copied().fold(0.0, f64::max))
    }
}

/// The largest peak besides the first one, if it is nearly as large and there is a pause between the two.
fn second(envelope: &[f64], first: usize) -> Option<usize> {
    let before = envelope[..first].iter().rposition(|m| *m < VALLEY);
    let after = envelope[first..].iter().position(|m| *m < VALLEY);
    let before = 0..before.unwrap_or(0);
    let after = after.map_or(envelope.len(), |after| first + after)..envelope.len();
    let high = before
        .chain(after)
        .filter(|frame| envelope[*frame] >= SECOND_PEAK);
    high.max_by(|a, b| envelope[*a].total_cmp(&envelope[*b]).then(b.cmp(a)))
}

/// The movement of joints: per joint and frame the step since the frame before, relative to the hips. `paths` are the joints' positions,
/// frame by frame, in any unit.
pub(crate) fn joint_steps(paths: &[Vec<DVec3>], hips: &[DVec3]) -> Vec<Vec<DVec3>> {
    let steps = |path: &Vec<DVec3>| {
        let places = path.iter().zip(hips);
        let relative: Vec<DVec3> = places.map(|(at, hips)| *at - *hips).collect();
        let steps = relative.windows(2).map(|pair| pair[1] - pair[0]);
        let first = relative.first().map(|_| DVec3::ZERO);
        first.into_iter().chain(steps).collect()
    };
    paths.iter().map(steps).collect()
}

/// How much of a movement goes towards the viewer or away, 0 to 1: that of the steps around the frame `key` which are at least half as
/// long as that one. `viewer` is a unit vector.
pub(super) fn share_towards(steps: &[DVec3], key: usize, viewer: DVec3) -> f64 {
    let Some(largest) = steps.get(key).map(|step| step.length()) else {
        return 0.0;
    };
    let is_short = |step: &DVec3| step.length() < VALLEY * largest;
    let first = steps[..key]
        .iter()
        .rposition(is_short)
        .map_or(0, |frame| frame + 1);
    let after = steps[key..].iter().position(is_short);
    let stroke = &steps[first..after.map_or(steps.len(), |after| key + after)];
    let way: f64 = stroke.iter().map(|step| step.length()).sum();
    let towards: f64 = stroke.iter().map(|step| step.dot(viewer).abs()).sum();
    if way > 0.0 { towards / way } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_earliest_of_the_largest_movements_is_the_key() {
        let information = Information::new(vec![vec![9.0, 1.0, 2.0, 4.0], vec![0.0, 4.0, 3.0]]);
        assert_eq!(information.largest, 4.0);
        assert_eq!(
            information.key,
            Some(Key {
                channel: 1,
                frame: 1
            })
        );
        assert_eq!(information.curves[0][3], 1.0);
        assert_eq!(information.peak(0), Some(3));
        assert_eq!(information.largest_of(1), 1.0);
    }

    #[test]
    fn what_does_not_move_has_no_key() {
        for still in [
            vec![],
            vec![vec![]],
            vec![vec![0.0; 5], vec![0.0, f64::NAN]],
        ] {
            let information = Information::new(still);
            assert_eq!((information.key, information.largest), (None, 0.0));
            assert!(
                information
                    .curves
                    .iter()
                    .flatten()
                    .all(|ratio| *ratio == 0.0)
            );
        }
    }

    #[test]
    fn a_second_action_is_one_after_a_pause() {
        let of = |curve: &[f64]| Information::new(vec![curve.to_vec()]).second;
        assert_eq!(of(&[0.0, 1.0, 10.0, 9.5, 9.2, 1.0]), None);
        assert_eq!(of(&[0.0, 1.0, 10.0, 3.0, 9.2, 1.0]), Some(4));
        assert_eq!(of(&[0.0, 9.1, 1.0, 10.0, 3.0, 8.0]), Some(1));
        assert_eq!(of(&[0.0, 9.1, 6.0, 10.0]), None);
    }

    #[test]
    fn joints_move_relative_to_the_hips() {
        let hips = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
        let paths = [hips.to_vec(), vec![DVec3::ZERO; 3]];
        let steps = joint_steps(&paths, &hips);
        assert_eq!(steps[0], [DVec3::ZERO; 3]);
        assert_eq!(steps[1], [DVec3::ZERO, DVec3::NEG_X, DVec3::NEG_X]);
    }

    #[test]
    fn strokes_are_judged_as_a_whole() {
        let steps = [
            DVec3::X,
            DVec3::Z * 4.0,
            DVec3::Z * 5.0,
            DVec3::X * 3.0,
            DVec3::X * 2.0,
        ];
        assert!((share_towards(&steps, 2, DVec3::Z) - 9.0 / 12.0).abs() < 1e-12);
        assert_eq!(share_towards(&steps, 9, DVec3::Z), 0.0);
        assert_eq!(share_towards(&[DVec3::ZERO; 2], 1, DVec3::Z), 0.0);
    }
}
