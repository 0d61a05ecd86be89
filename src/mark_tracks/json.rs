//! Tracks read from JSON.

use glam::DVec2;
use serde::Deserialize;

use super::check::{
    MAX_FRAMES, MAX_MARKS, check_coordinate, check_name, check_size, check_time, repeated_name,
};
use super::{Error, MarkTrack, MarkTracks, bridge, parse_hex};

/// What tells a track from other JSON.
#[derive(Deserialize)]
struct Header {
    format: Option<String>,
    version: Option<u64>,
}

/// A file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(rename = "format")]
    _format: String,
    #[serde(rename = "version")]
    _version: u64,
    size: [u32; 2],
    times: Vec<f64>,
    marks: Vec<Mark>,
}

/// A mark as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Mark {
    name: String,
    #[serde(rename = "colour")]
    color: String,
    /// `null` where the mark was lost and nobody knows a position.
    points: Vec<Option<[f64; 2]>>,
    /// Ranges of frames: the first and the last.
    #[serde(default)]
    lost: Vec<[usize; 2]>,
    /// Those of the lost frames in which the mark may be in several places.
    #[serde(default)]
    ambiguous: Vec<[usize; 2]>,
}

pub(super) fn read(text: &str) -> Result<MarkTracks, Error> {
    let header: Header = serde_json::from_str(text).map_err(|error| invalid(&error))?;
    if header.format.as_deref() != Some("okoshi track") {
        return Err(Error::field(
            "format",
            "this JSON is no track: it does not say `\"format\": \"okoshi track\"`",
            "`okoshi track` makes a track of a clip",
        ));
    }
    if header.version != Some(1) {
        let help = "make the track again with this version of okoshi";
        return Err(Error::field("version", "only version 1 can be read", help));
    }
    let file: File = serde_json::from_str(text).map_err(|error| invalid(&error))?;
    check_size(file.size).map_err(|error| error.of("size".to_owned()))?;
    check_times(&file.times)?;
    check_marks(&file.marks)?;
    let [width, height] = file.size.map(f64::from);
    let middle = DVec2::new(width, height) / 2.0;
    let marks = file.marks.iter().enumerate();
    let marks = marks.map(|(index, mark)| read_mark(index, mark, &file.times, middle));
    Ok(MarkTracks {
        size: file.size,
        marks: marks.collect::<Result<_, _>>()?,
        times: file.times,
    })
}

/// What is wrong with the syntax, or the type of a field.
fn invalid(error: &serde_json::Error) -> Error {
    let message = error.to_string();
    let message = match message.rfind(" at line ") {
        Some(at) => message[..at].to_owned(),
        None => message,
    };
    let help = "compare it with a track that `okoshi track` writes, or make it again";
    Error::whole(message, help).at(error.line().max(1), error.column().max(1))
}

fn check_times(times: &[f64]) -> Result<(), Error> {
    if times.is_empty() || times.len() > MAX_FRAMES {
        let frames = times.len();
        let message = format!("a track has from 1 to {MAX_FRAMES} frames, this one {frames}");
        let help = "give the time of each frame in seconds";
        return Err(Error::field("times", message, help));
    }
    for (frame, time) in times.iter().enumerate() {
        let before = frame.checked_sub(1).map(|before| times[before]);
        check_time(before, *time).map_err(|error| error.of(format!("times[{frame}]")))?;
    }
    Ok(())
}

fn check_marks(marks: &[Mark]) -> Result<(), Error> {
    if marks.is_empty() || marks.len() > MAX_MARKS {
        let count = marks.len();
        let message = format!("a track has from 1 to {MAX_MARKS} marks, this one {count}");
        let help = "give a name, a colour and a point for each frame";
        return Err(Error::field("marks", message, help));
    }
    for (index, mark) in marks.iter().enumerate() {
        check_name(&mark.name).map_err(|error| error.of(format!("marks[{index}].name")))?;
    }
    match repeated_name(marks.iter().map(|mark| mark.name.as_str())) {
        Some(index) => Err(Error::field(
            format!("marks[{index}].name"),
            format!("there is a mark `{}` already", marks[index].name),
            "give each mark a name of its own",
        )),
        None => Ok(()),
    }
}

fn read_mark(index: usize, mark: &Mark, times: &[f64], middle: DVec2) -> Result<MarkTrack, Error> {
    let field = |field: &str| format!("marks[{index}].{field}");
    let color = parse_hex(&mark.color).ok_or_else(|| {
        Error::field(
            field("colour"),
            "this is no colour",
            "write it as `#d03020`",
        )
    })?;
    let frames = times.len();
    if mark.points.len() != frames {
        return Err(Error::field(
            field("points"),
            format!("{} points for {frames} frames", mark.points.len()),
            "give a point for each of the `times`, or `null` where the mark is lost",
        ));
    }
    for (frame, point) in mark.points.iter().enumerate() {
        for (axis, coordinate) in point.iter().flatten().enumerate() {
            let place = || field(&format!("points[{frame}][{axis}]"));
            check_coordinate(*coordinate).map_err(|error| error.of(place()))?;
        }
    }
    let is_ambiguous = marked(&mark.ambiguous, frames, &field("ambiguous"))?;
    let is_listed = marked(&mark.lost, frames, &field("lost"))?;
    let is_lost = mark.points.iter().zip(is_listed.iter().zip(&is_ambiguous));
    let is_lost = is_lost.map(|(point, (lost, ambiguous))| point.is_none() || *lost || *ambiguous);
    let is_lost = is_lost.collect();
    let points: Vec<Option<DVec2>> = mark
        .points
        .iter()
        .map(|point| point.map(DVec2::from_array))
        .collect();
    Ok(MarkTrack {
        name: mark.name.clone(),
        color,
        points: bridge(times, &points, middle),
        is_lost,
        is_ambiguous,
    })
}

/// Per frame whether it is in one of some ranges.
fn marked(ranges: &[[usize; 2]], frames: usize, field: &str) -> Result<Vec<bool>, Error> {
    let mut is_marked = vec![false; frames];
    for (range, [first, last]) in ranges.iter().enumerate() {
        let marked = is_marked.get_mut(*first..last.saturating_add(1));
        let Some(marked) = marked.filter(|_| first <= last) else {
            let message = format!("there are no frames {first} to {last}");
            let most = frames - 1;
            let help = format!("give the first and the last frame, from 0 to {most}");
            return Err(Error::field(format!("{field}[{range}]"), message, help));
        };
        marked.fill(true);
    }
    Ok(is_marked)
}
