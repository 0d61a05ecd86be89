//! The names of hues.

pub(crate) use crate::mark_tracks::Hsv;
pub(super) use crate::mark_tracks::hue_difference;

/// The names of hues, and where they are on the circle, in degrees.
pub(crate) const HUES: [(&str, f64); 8] = [
    ("red", 0.0),
    ("orange", 30.0),
    ("yellow", 57.0),
    ("green", 130.0),
    ("cyan", 190.0),
    ("blue", 225.0),
    ("purple", 280.0),
    ("pink", 325.0),
];

/// The name of the nearest hue.
pub(crate) fn hue_name(hue: f64) -> &'static str {
    let mut nearest = HUES[0];
    for named in HUES {
        if hue_difference(hue, named.1).abs() < hue_difference(hue, nearest.1).abs() {
            nearest = named;
        }
    }
    nearest.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues_are_where_they_are_named() {
        for (rgb, name) in [
            ([220, 30, 40], "red"),
            ([250, 140, 20], "orange"),
            ([240, 230, 40], "yellow"),
            ([40, 160, 70], "green"),
            ([30, 200, 210], "cyan"),
            ([30, 60, 200], "blue"),
            ([130, 40, 180], "purple"),
            ([240, 60, 170], "pink"),
        ] {
            assert_eq!(hue_name(Hsv::of(rgb).hue), name);
        }
    }

    #[test]
    fn darker_light_changes_chroma_only() {
        let (bright, dark) = (Hsv::of([200, 40, 80]), Hsv::of([100, 20, 40]));
        assert_eq!((bright.hue, bright.saturation), (dark.hue, dark.saturation));
        assert_eq!(bright.chroma, 2.0 * dark.chroma);
        assert_eq!(hue_difference(350.0, 10.0), -20.0);
        assert_eq!(hue_difference(10.0, 350.0), 20.0);
    }
}
