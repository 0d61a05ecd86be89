//! Places for the frames in which a mark was lost.

use glam::DVec2;

/// The places of a mark, with those between the frames around them where it was lost: on a straight line by time, and before the first and
/// after the last sight where it was seen next. If it never was seen, all places are `otherwise`.
pub(crate) fn bridge(times: &[f64], seen: &[Option<DVec2>], otherwise: DVec2) -> Vec<DVec2> {
    let mut places: Vec<DVec2> = Vec::with_capacity(seen.len());
    for (frame, place) in seen.iter().enumerate() {
        if let Some(next) = *place {
            let last = places.len().checked_sub(1).map(|last| (last, places[last]));
            for lost in places.len()..frame {
                places.push(match last {
                    Some((last, from)) => {
                        let part = (times[lost] - times[last]) / (times[frame] - times[last]);
                        from.lerp(next, part)
                    }
                    None => next,
                });
            }
            places.push(next);
        }
    }
    let last = places.last().copied().unwrap_or(otherwise);
    places.resize(seen.len(), last);
    places
}
