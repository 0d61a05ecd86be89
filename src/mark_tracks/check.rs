//! What every track obeys, whatever file it comes from.

use std::collections::HashSet;

use super::Error;
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

/// Fails if a mark cannot have this name.
pub(super) fn check_name(name: &str) -> Result<(), Error> {
    if is_name(name) {
        return Ok(());
    }
    let shown: String = name.chars().take(MAX_NAME).collect();
    let message = format!("`{}` cannot be the name of a mark", shown.escape_debug());
    let help = "names have letters, digits, `-` and `_`, 64 at most, such as `red`";
    Err(Error::whole(message, help))
}

/// Fails if pictures cannot have this size.
pub(super) fn check_size([width, height]: [u32; 2]) -> Result<(), Error> {
    if [width, height]
        .iter()
        .all(|side| (1..=MAX_SIDE).contains(side))
    {
        return Ok(());
    }
    let message = format!("the pictures cannot be {width} × {height} pixels");
    Err(Error::whole(
        message,
        "give the width and the height of the clip's pictures",
    ))
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

/// Fails if a frame that follows on another cannot have this time.
pub(super) fn check_time(before: Option<f64>, time: f64) -> Result<(), Error> {
    if !(-MAX_TIME..=MAX_TIME).contains(&time) {
        let message = format!("{time} is no time of a clip, in seconds");
        return Err(Error::whole(
            message,
            "give the time of each frame in seconds",
        ));
    }
    // Frames closer than the times that are written would become one.
    let is_later = |before| ticks(time) > ticks(before);
    match before {
        Some(before) if !is_later(before) => Err(Error::whole(
            format!("the frame at {time} s does not come after the one at {before} s"),
            "sort the frames by their times; two frames are at least 0.0001 s apart",
        )),
        _ => Ok(()),
    }
}

/// Fails if no place in a picture has this coordinate.
pub(super) fn check_coordinate(coordinate: f64) -> Result<(), Error> {
    if coordinate.abs() <= MAX_COORDINATE {
        return Ok(());
    }
    let message = format!("{coordinate} is no place in a picture, in pixels");
    let help = "coordinates are pixels from the picture's top left corner";
    Err(Error::whole(message, help))
}
