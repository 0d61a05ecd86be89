//! Tracks written as JSON and as CSV. The same track gives the same bytes.

use std::fmt::Write;

use super::{MarkTracks, hex};

/// Times are written with four decimals: this many steps a second.
pub(super) const TICKS: f64 = 1e4;

impl MarkTracks {
    /// The tracks as JSON: coordinates to a hundredth of a pixel, times to a ten-thousandth of a second, lost and ambiguous frames
    /// as ranges `[first, last]`.
    pub fn to_json(&self) -> String {
        let [width, height] = self.size;
        let times: Vec<String> = self.times.iter().map(|time| number(*time, 4)).collect();
        let mark = |(index, mark): (usize, &super::MarkTrack)| {
            let points = mark.points.iter();
            let points: Vec<String> = points
                .map(|point| format!("[{},{}]", number(point.x, 2), number(point.y, 2)))
                .collect();
            format!(
                "{}\n    {{\"name\": {}, \"colour\": \"{}\",\n     \"lost\": [{}], \"ambiguous\": [{}],\n     \"points\": [{}]}}",
                if index == 0 { "" } else { "," },
                serde_json::Value::from(mark.name.as_str()),
                hex(mark.color),
                ranges(&mark.is_lost),
                ranges(&mark.is_ambiguous),
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
    /// `NAME_x`, `NAME_y`, `NAME_lost` and `NAME_ambiguous` (0 or 1). Numbers are rounded as in JSON.
    pub fn to_csv(&self) -> String {
        let [width, height] = self.size;
        let mut text = format!("# {width}x{height}");
        for mark in &self.marks {
            let _ = write!(text, " {}={}", mark.name, hex(mark.color));
        }
        text.push_str("\nframe,time");
        for mark in &self.marks {
            let name = &mark.name;
            let _ = write!(text, ",{name}_x,{name}_y,{name}_lost,{name}_ambiguous");
        }
        text.push('\n');
        for (frame, time) in self.times.iter().enumerate() {
            let _ = write!(text, "{frame},{}", number(*time, 4));
            for mark in &self.marks {
                let point = mark.points[frame];
                let [x, y] = [point.x, point.y].map(|coordinate| number(coordinate, 2));
                let [lost, ambiguous] =
                    [&mark.is_lost, &mark.is_ambiguous].map(|is| u8::from(is[frame]));
                let _ = write!(text, ",{x},{y},{lost},{ambiguous}");
            }
            text.push('\n');
        }
        text
    }
}

/// The ranges of the frames that are marked, each as `[first,last]`, separated by commas.
fn ranges(is_marked: &[bool]) -> String {
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for (frame, _) in is_marked.iter().enumerate().filter(|(_, marked)| **marked) {
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == frame => *last = frame,
            _ => ranges.push((frame, frame)),
        }
    }
    let texts = ranges
        .iter()
        .map(|(first, last)| format!("[{first},{last}]"));
    texts.collect::<Vec<_>>().join(",")
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
