//! How much the marks of a puppet move.

use glam::DVec2;

use crate::mark_tracks::{MarkId, MarkTrack, MarkTracks};

/// Movement below this is that of noise: fractions of the picture's diagonal per second (0.25 % per frame at 24 frames a second).
const NOISE: f64 = 0.0025 * 24.0;
/// Positions are replaced by the median of so many.
const MEDIAN: usize = 5;
/// Times in files are rounded: a frame that is nearer than this to one of the track, in frames, is that one.
const SAME_TIME: f64 = 0.01;
/// The most frames of a performance: more than an hour at any usual rate.
const MAX_FRAMES: f64 = (1 << 18) as f64;

/// The movement of some marks, brought to `fps` frames a second by their times: per mark and frame |dx| + |dy| since the frame before,
/// in fractions of the picture's diagonal. Frames count from the first frame of the track. Steps from or to a frame in which the mark
/// was lost are 0, and so is what noise may be. Every index in `marks` must be valid.
pub(crate) fn mark_movements(tracks: &MarkTracks, marks: &[MarkId], fps: f64) -> Vec<Vec<f64>> {
    let size = DVec2::new(tracks.size[0].into(), tracks.size[1].into());
    let samples = samples(&tracks.times, fps);
    let movement = |mark: &MarkId| {
        let seen = resampled(&tracks.marks[*mark], &samples);
        let seen = smoothed(&seen);
        let step = |pair: &[Option<DVec2>]| {
            let way = (pair[1]? - pair[0]?) / size.length();
            Some(way.x.abs() + way.y.abs()).filter(|step| *step >= NOISE / fps)
        };
        let steps = seen.windows(2).map(|pair| step(pair).unwrap_or(0.0));
        let first = seen.first().map(|_| 0.0);
        first.into_iter().chain(steps).collect()
    };
    marks.iter().map(movement).collect()
}

/// Where a frame of the result lies: after frame `from` of the track, `t` of the way to the next.
struct Sample {
    from: usize,
    t: f64,
}

/// The frames of the result. The last one does not lie after the end of the track.
fn samples(times: &[f64], fps: f64) -> Vec<Sample> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return Vec::new();
    };
    let count = ((last - first) * fps + SAME_TIME).floor().min(MAX_FRAMES) as usize + 1;
    let mut from = 0;
    let sample = |frame: usize| {
        let time = first + frame as f64 / fps;
        while from + 1 < times.len() && times[from + 1] <= time {
            from += 1;
        }
        let next = times.get(from + 1).copied().unwrap_or(times[from]);
        let whole = |from| Sample { from, t: 0.0 };
        if (time - times[from]) * fps < SAME_TIME || from + 1 == times.len() {
            return whole(from);
        }
        if (next - time) * fps < SAME_TIME {
            return whole(from + 1);
        }
        Sample {
            from,
            t: (time - times[from]) / (next - times[from]),
        }
    };
    (0..count).map(sample).collect()
}

/// The places of a mark in the frames of the result; `None` where one of the frames beside it was lost.
fn resampled(mark: &MarkTrack, samples: &[Sample]) -> Vec<Option<DVec2>> {
    let seen = |frame: usize| {
        let is_lost = mark.is_lost.get(frame).copied().unwrap_or(true);
        mark.points.get(frame).copied().filter(|_| !is_lost)
    };
    let place = |sample: &Sample| {
        let from = seen(sample.from)?;
        match sample.t {
            0.0 => Some(from),
            t => Some(from.lerp(seen(sample.from + 1)?, t)),
        }
    };
    samples.iter().map(place).collect()
}

/// Each place replaced by the median, per coordinate, of those around it that were seen.
fn smoothed(places: &[Option<DVec2>]) -> Vec<Option<DVec2>> {
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let middle = values.len() / 2;
        match values.len() % 2 {
            0 => (values[middle - 1] + values[middle]) / 2.0,
            _ => values[middle],
        }
    };
    let at = |frame: usize| {
        places[frame]?;
        // The same number on both sides: else a steady movement would bend at the ends.
        let reach = (MEDIAN / 2).min(frame).min(places.len() - 1 - frame);
        let around = || places[frame - reach..=frame + reach].iter().flatten();
        Some(DVec2::new(
            median(around().map(|place| place.x).collect()),
            median(around().map(|place| place.y).collect()),
        ))
    };
    (0..places.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A track of one mark at `fps` frames a second.
    fn track(fps: f64, points: &[[f64; 2]]) -> MarkTracks {
        MarkTracks {
            size: [300, 400],
            times: (0..points.len()).map(|frame| frame as f64 / fps).collect(),
            marks: vec![MarkTrack {
                name: "red".to_owned(),
                color: [255, 0, 0],
                points: points
                    .iter()
                    .map(|point| DVec2::from_array(*point))
                    .collect(),
                is_lost: vec![false; points.len()],
                is_ambiguous: vec![false; points.len()],
            }]
            .into(),
        }
    }

    #[test]
    fn movement_is_in_diagonals() {
        let track = track(
            24.0,
            &[[0.0, 0.0], [10.0, 15.0], [20.0, 30.0], [30.0, 45.0]],
        );
        let movement = &mark_movements(&track, &[MarkId::from(0)], 24.0)[0];
        assert_eq!(movement.len(), 4);
        assert_eq!(movement[0], 0.0);
        assert!(movement[1..].iter().all(|step| (step - 0.05).abs() < 1e-12));
    }

    #[test]
    fn other_rates_are_brought_to_ours_by_their_times() {
        let points: Vec<[f64; 2]> = (0..13)
            .map(|frame| [30.0 * f64::from(frame), 0.0])
            .collect();
        let movement = &mark_movements(&track(12.0, &points), &[MarkId::from(0)], 24.0)[0];
        assert_eq!(movement.len(), 25);
        let even = movement[1..].iter().all(|step| (step - 0.03).abs() < 1e-12);
        assert!(even, "{movement:?}");
        let slow = &mark_movements(&track(48.0, &points), &[MarkId::from(0)], 24.0)[0];
        assert_eq!(slow.len(), 7);
        assert!(slow[1..].iter().all(|step| (step - 0.12).abs() < 1e-12));
    }

    #[test]
    fn noise_and_single_errors_do_not_count() {
        let mut points = vec![[100.0, 100.0]; 20];
        for (frame, point) in points.iter_mut().enumerate() {
            point[0] += [0.4, -0.4][frame % 2];
        }
        points[10] = [250.0, 30.0];
        let movement = &mark_movements(&track(24.0, &points), &[MarkId::from(0)], 24.0)[0];
        assert!(movement.iter().all(|step| *step == 0.0), "{movement:?}");
    }

    #[test]
    fn steps_that_touch_a_lost_frame_do_not_count() {
        let points: Vec<[f64; 2]> = (0..20)
            .map(|frame| [10.0 * f64::from(frame), 0.0])
            .collect();
        let mut track = track(24.0, &points);
        track.marks.raw[0].is_lost[8] = true;
        let movement = &mark_movements(&track, &[MarkId::from(0)], 24.0)[0];
        let still: Vec<usize> = (1..20).filter(|frame| movement[*frame] == 0.0).collect();
        assert_eq!(still, [8, 9]);
    }

    #[test]
    fn tracks_without_frames_have_no_movement() {
        assert!(mark_movements(&track(24.0, &[]), &[MarkId::from(0)], 24.0)[0].is_empty());
        assert_eq!(
            mark_movements(&track(24.0, &[[1.0, 2.0]]), &[MarkId::from(0)], 24.0),
            [[0.0]]
        );
    }
}
