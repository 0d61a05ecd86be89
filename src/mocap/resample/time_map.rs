//! Monotone maps of time, along which a motion is played.

use super::Mix;

/// A map from the frames of a result to places between the frames of a source: monotone and piecewise linear.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TimeMap {
    /// Per frame of the result what it shows.
    pub places: Vec<Mix>,
}

impl TimeMap {
    /// The map through these points, each a frame of the result with the frame of the source that it shows, both ascending. The first
    /// point is frame 0 of the result, the last one its end. Frames at points are exactly frames of the source.
    pub fn through(points: &[[usize; 2]]) -> Self {
        let last = points.last().map_or(0, |point| point[1]);
        let mut places = Vec::new();
        for pair in points.windows(2) {
            let [[from, start], [to, end]] = [pair[0], pair[1]];
            let frames = to.saturating_sub(from);
            let way = end.saturating_sub(start) as u128;
            let place = |step: usize| {
                let (frames, gone) = (frames as u128, step as u128 * way);
                Mix {
                    from: start + (gone / frames) as usize,
                    to: (start + (gone / frames) as usize + 1).min(last),
                    t: (gone % frames) as f64 / frames as f64,
                }
            };
            places.extend((0..frames).map(place));
        }
        if !points.is_empty() {
            places.push(Mix {
                from: last,
                to: last,
                t: 0.0,
            });
        }
        Self { places }
    }

    /// The number of frames of the result.
    pub fn frames(&self) -> usize {
        self.places.len()
    }

    /// Values of the source as the result has them: `mix` makes one that lies between two others, and is not asked where a frame of the
    /// result is one of the source.
    pub fn apply<T: Copy>(&self, values: &[T], mix: impl Fn(T, T, f64) -> T) -> Vec<T> {
        let at = |place: &Mix| match place.t {
            0.0 => values[place.from],
            t => mix(values[place.from], values[place.to], t),
        };
        self.places.iter().map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn points_are_frames() {
        let map = TimeMap::through(&[[0, 0], [2, 6], [7, 9]]);
        let places: Vec<f64> = map
            .places
            .iter()
            .map(|mix| mix.from as f64 + mix.t)
            .collect();
        assert_eq!(places[..3], [0.0, 3.0, 6.0]);
        assert_eq!(places[7], 9.0);
        assert_eq!(places.len(), 8);
        assert_eq!(TimeMap::through(&[]).frames(), 0);
        assert_eq!(TimeMap::through(&[[0, 0]]).frames(), 1);
    }

    proptest! {
        #[test]
        fn maps_are_monotone_and_pass_their_points(
            steps in prop::collection::vec((1_usize..40, 0_usize..40), 0..5),
        ) {
            let mut points = vec![[0, 0]];
            for (frames, way) in steps {
                let [from, start] = points[points.len() - 1];
                points.push([from + frames, start + way]);
            }
            let map = TimeMap::through(&points);
            let place = |mix: &Mix| mix.from as f64 + mix.t;
            let [last, end] = points[points.len() - 1];
            prop_assert_eq!(map.frames(), last + 1);
            for [frame, source] in points {
                prop_assert_eq!((map.places[frame].from, map.places[frame].t), (source, 0.0));
            }
            for pair in map.places.windows(2) {
                prop_assert!(place(&pair[0]) <= place(&pair[1]));
                prop_assert!(pair[1].to <= end && (0.0..1.0).contains(&pair[1].t));
            }
        }
    }
}
