//! Tracks written as JSON and as CSV. The same track gives the same bytes.

use std::fmt::Write;

use super::{MarkTracks, hex};

/// Times are written with four decimals: this many steps a second.
pub(super) const TICKS: f64 = 1e4;

impl MarkTracks {
    /// The tracks as JSON: coordinates to a hundredth of a pixel, times to a ten-thousandth of a second, lost frames as ranges
    /// `[first, last]`.
    pub fn to_json(&self) -> String {
        let [width, height] = self.size;
        let times: Vec<String> = self.times.iter().map(|time| number(*time, 4)).collect();
        let mark = |(index, mark): (usize, &super::MarkTrack)| {
            let points = mark.points.iter();
            let points: Vec<String> = points
                .map(|point| format!("[{},{}]", number(point.x, 2), number(point.y, 2)))
                .collect();
            let lost: Vec<String> = ranges(&mark.is_lost)
                .iter()
                .map(|(first, last)| format!("[{first},{last}]"))
                .collect();
            format!(
                "{}\n    {{\"name\": {}, \"colour\": \"{}\",\n     \"lost\": [{}],\n     \"points\": [{}]}}",
                if index == 0 { "" } else { "," },
                serde_json::Value::from(mark.name.as_str()),
                hex(mark.color),
                lost.join(","),
                points.join(","),
            )
        };
        let marks: String = self.marks.iter().enumerate().map(mark).collect();
        format!(
            "{{\n  \"format\": \"okoshi track\",\n  \"version\": 1,\n  \"size\": [{width},{height}],\n  \"times\": [{}],\n  \"marks\": [{marks}\n  ]\n}}\n",
            times.join(",")
        )
    }

    /// The tracks as CSV, a row per frame: a line with the size and the colours, and the columns `frame` (from 0), `time`, and for each mark
    /// `NAME_x`, `NAME_y` and `NAME_lost` (0 or 1). Numbers are rounded as in JSON.
    pub fn to_csv(&self) -> String {
        let [width, height] = self.size;
        let mut text = format!("# {width}x{height}");
        for mark in &self.marks {
            let _ = write!(text, " {}={}", mark.name, hex(mark.color));
        }
        text.push_str("\nframe,time");
        for mark in &self.marks {
            let name = &mark.name;
            let _ = write!(text, ",{name}_x,{name}_y,{name}_lost");
        }
        text.push('\n');
        for (frame, time) in self.times.iter().enumerate() {
            let _ = write!(text, "{frame},{}", number(*time, 4));
            for mark in &self.marks {
                let (point, is_lost) = (mark.points[frame], mark.is_lost[frame]);
                let [x, y] = [point.x, point.y].map(|coordinate| number(coordinate, 2));
                let _ = write!(text, ",{x},{y},{}", u8::from(is_lost));
            }
            text.push('\n');
        }
        text
    }
}

/// The ranges of frames that are lost, by their first and last frame.
fn ranges(is_lost: &[bool]) -> Vec<(usize, usize)> {
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for (frame, _) in is_lost.iter().enumerate().filter(|(_, lost)| **lost) {
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == frame => *last = frame,
            _ => ranges.push((frame, frame)),
        }
    }
    ranges
}

/// A number with at most so many decimals, without zeros at the end.
fn number(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" | "" => "0".to_owned(),
        _ => text.to_owned(),
    }
}
