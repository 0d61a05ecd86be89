//! Which points of a line matter (Douglas & Peucker 1973).

/// The indices of the points of a line that are kept: ascending, with both ends.
///
/// `farthest` gets the indices of two kept points and gives the point between them that deviates most from the straight line between
/// the two, or `None` if no point deviates by more than is tolerated.
pub(crate) fn simplify(
    count: usize,
    farthest: impl Fn(usize, usize) -> Option<usize>,
) -> Vec<usize> {
    let Some(last) = count.checked_sub(1) else {
        return Vec::new();
    };
    let mut kept = vec![0, last];
    kept.dedup();
    let mut stack = vec![(0, last)];
    while let Some((from, to)) = stack.pop() {
        if let Some(middle) = farthest(from, to) {
            kept.push(middle);
            stack.extend([(from, middle), (middle, to)]);
        }
    }
    kept.sort_unstable();
    kept
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The heights of a profile whose points are 1 apart.
    fn keep(heights: &[f64], tolerance: f64) -> Vec<usize> {
        simplify(heights.len(), |from, to| {
            let slope = (heights[to] - heights[from]) / (to - from) as f64;
            let deviation = |index: &usize| {
                (heights[*index] - heights[from] - slope * (*index - from) as f64).abs()
            };
            let between = from + 1..to;
            let farthest = between.max_by(|a, b| deviation(a).total_cmp(&deviation(b)));
            farthest.filter(|index| deviation(index) > tolerance)
        })
    }

    #[test]
    fn corners_are_kept() {
        assert!(keep(&[], 1.0).is_empty());
        assert_eq!(keep(&[5.0], 1.0), [0]);
        assert_eq!(keep(&[0.0, 4.0], 1.0), [0, 1]);
        assert_eq!(keep(&[0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.5], 0.6), [0, 3, 6]);
        assert_eq!(keep(&[0.0, 0.5, 0.0, 0.5, 0.0], 0.5), [0, 4]);
    }

    proptest! {
        #[test]
        fn no_point_deviates_by_more(
            heights in prop::collection::vec(-9.0..9.0, 1..60),
            tolerance in 0.0..9.0,
        ) {
            let kept = keep(&heights, tolerance);
            prop_assert_eq!(kept.first(), Some(&0));
            prop_assert_eq!(kept.last(), Some(&(heights.len() - 1)));
            for ends in kept.windows(2) {
                prop_assert!(ends[0] < ends[1]);
                let between = keep(&heights[ends[0]..=ends[1]], tolerance);
                prop_assert_eq!(between.len(), 2);
            }
        }
    }
}
