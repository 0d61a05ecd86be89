//! What every track obeys, whatever file it comes from.

use std::collections::HashSet;

use super::write::TICKS;

/// The most frames of a track: more than two hours of 60 a second.
pub(crate) const MAX_FRAMES: usize = 1 << 19;
/// The most marks.
pub(crate) const MAX_MARKS: usize = 64;
/// The longest name of a mark, in characters.
pub(crate) const MAX_NAME: usize = 64;
/// The largest width and height of a clip's pictures, pixels.
pub(crate) const MAX_SIDE: u32 = 1 << 16;
/// Coordinates are within this many pixels of the picture's corner.
pub(super) const MAX_COORDINATE: f64 = 1e6;
/// Times are below this many seconds.
pub(super) const MAX_TIME: f64 = 1e6;

/// Whether a mark can have this name: letters of any script, digits, `-` and `_`.
pub(crate) fn is_name(name: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    !name.is_empty() && name.chars().all(is_part) && name.chars().nth(MAX_NAME).is_none()
}

/// What is wrong with a name, and how to fix it.
pub(super) fn name_problem(name: &str) -> Option<(String, &'static str)> {
    let shown: String = name.chars().take(MAX_NAME).collect();
    (!is_name(name)).then(|| {
        let message = format!("`{}` cannot be the name of a mark", shown.escape_debug());
        let help = "names have letters, digits, `-` and `_`, 64 at most, such as `red`";
        (message, help)
    })
}

/// What is wrong with the size of the pictures.
pub(super) fn size_problem(size: [u32; 2]) -> Option<String> {
    let is_right = size.iter().all(|side| (1..=MAX_SIDE).contains(side));
    (!is_right).then(|| {
        let [width, height] = size;
        format!("the pictures cannot be {width} × {height} pixels")
    })
}

/// The first name that an earlier mark has already, by its index.
pub(crate) fn repeated_name<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<usize> {
    let mut seen = HashSet::new();
    names.into_iter().position(|name| !seen.insert(name))
}

/// The nearest time that can be written, counted in steps of [`TICKS`].
pub(super) fn ticks(time: f64) -> f64 {
    (time * TICKS).round()
}

/// What is wrong with the time of a frame that follows on another.
pub(super) fn time_problem(before: Option<f64>, time: f64) -> Option<(String, &'static str)> {
    if !(-MAX_TIME..=MAX_TIME).contains(&time) {
        let message = format!("{time} is no time of a clip, in seconds");
        return Some((message, "give the time of each frame in seconds"));
    }
    // Frames closer than the times that are written would become one.
    let is_later = |before| ticks(time) > ticks(before);
    match before {
        Some(before) if !is_later(before) => Some((
            format!("the frame at {time} s does not come after the one at {before} s"),
            "sort the frames by their times; two frames are at least 0.0001 s apart",
        )),
        _ => None,
    }
}

/// What is wrong with a coordinate.
pub(super) fn coordinate_problem(coordinate: f64) -> Option<(String, &'static str)> {
    let is_right = coordinate.abs() <= MAX_COORDINATE;
    (!is_right).then(|| {
        let message = format!("{coordinate} is no place in a picture, in pixels");
        (
            message,
            "coordinates are pixels from the picture's top left corner",
        )
    })
}
