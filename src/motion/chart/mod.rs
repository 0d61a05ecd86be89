//! A chart of a limited motion (Kitamura, figures 5.3 and 5.10): the speed of the source, what was omitted and held, and the
//! exposure sheet below.

mod scale;
#[cfg(test)]
mod tests;

use std::fmt::Write as _;

use crate::limited::Exposure;
use scale::{BOTTOM, LEFT, RIGHT, Scale, TOP, columns, number, step};

/// The picture's size, pixels.
const SIZE: [f64; 2] = [960.0, 444.0];
/// The top and bottom of the exposure sheet.
const SHEET: [f64; 2] = [328.0, 368.0];
/// Frames are marked individually if they are at least this wide, pixels.
const MIN_MARK_WIDTH: f64 = 4.0;
/// The highest speed on the axis, so that it stays finite.
const MAX_SPEED: f64 = 1e300;
/// The most ticks of an axis.
const MAX_TICKS: usize = 32;
/// The longest title, characters.
const MAX_TITLE: usize = 80;

const INK: &str = "#1f2328";
const QUIET: &str = "#59636e";
const CURVE: &str = "#41506b";
const OMITTED: &str = "#cf222e";
const LONGER: &str = "#1a7f37";
const HELD: &str = "#9a6700";
const DRAWING: &str = "#0969da";
const SHOWN: &str = "#d6e6fa";

/// The contents of a chart. Frame numbers that the source does not have are ignored.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chart<'a> {
    /// Its title.
    pub title: &'a str,
    /// Frames per second; seconds are only shown if this is a positive number.
    pub fps: f64,
    /// Per source frame its SSD to the frame before.
    pub speeds: &'a [f64],
    /// Omitted source frames.
    pub omitted: &'a [u32],
    /// Source frames that are shown for one frame more in place of omitted ones.
    pub duplicated: &'a [u32],
    /// Source frames that are covered by holding the pose before.
    pub held: &'a [u32],
    /// Which source frame each frame shows.
    pub exposure: &'a Exposure,
}

/// Draws the chart as an SVG. Its size is bounded however long the motion is, and every peak stays visible.
pub(crate) fn chart(chart: &Chart<'_>) -> String {
    let frames = chart.speeds.len().max(chart.exposure.len()).max(1);
    let finite = chart.speeds.iter().filter(|speed| speed.is_finite());
    let top = finite
        .fold(0.0_f64, |top, speed| top.max(*speed))
        .min(MAX_SPEED);
    let step = step(top / 5.0);
    let scale = Scale {
        wide: (RIGHT - LEFT) / frames as f64,
        top: (top / step).ceil().max(1.0) * step,
    };
    let mut out = String::new();
    open(&mut out, chart);
    heights(&mut out, &scale, step);
    curve(&mut out, chart.speeds, &scale);
    marks(&mut out, chart, &scale);
    sheet(&mut out, chart.exposure, &scale);
    times(&mut out, frames, chart.fps, &scale);
    legend(&mut out, chart, &scale);
    out.push_str("</svg>\n");
    out
}

fn escaped(text: &str) -> String {
    let mut out = String::new();
    for (index, letter) in text.chars().enumerate() {
        match letter {
            _ if index == MAX_TITLE => {
                out.push('…');
                break;
            }
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            // Characters that XML does not allow.
            _ if letter.is_control() || matches!(letter, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            _ => out.push(letter),
        }
    }
    out
}

fn open(out: &mut String, chart: &Chart<'_>) {
    let [width, height] = SIZE;
    let title = escaped(chart.title);
    let version = env!("CARGO_PKG_VERSION");
    let _ = write!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" role="img" font-family="system-ui, sans-serif" font-size="12" fill="{QUIET}">
<!-- Chart of a motion, written by okoshi {version} -->
<title>{title}</title>
<rect x="0.5" y="0.5" width="{}" height="{}" rx="8" fill="#ffffff" stroke="#d1d9e0"/>
<text x="24" y="32" font-size="17" font-weight="600" fill="{INK}">{title}</text>
"##,
        width - 1.0,
        height - 1.0
    );
}

fn heights(out: &mut String, scale: &Scale, step: f64) {
    let mut lines = String::new();
    let mut labels = String::new();
    for index in (0..=(scale.top / step).round() as usize).take(MAX_TICKS) {
        let y = scale.y(index as f64 * step);
        let _ = write!(lines, "M{LEFT} {y:.1}H{RIGHT}");
        let _ = write!(
            labels,
            r#"<text x="{}" y="{:.1}" text-anchor="end">{}</text>"#,
            LEFT - 8.0,
            y + 4.0,
            number(index as f64 * step)
        );
    }
    let _ = write!(
        out,
        r##"<path d="{lines}" stroke="#e6eaef" fill="none"/>
{labels}
<text transform="translate(26 {}) rotate(-90)" text-anchor="middle">SSD (unit²)</text>
"##,
        f64::midpoint(TOP, BOTTOM)
    );
}

fn curve(out: &mut String, speeds: &[f64], scale: &Scale) {
    // The first frame has no speed.
    let Some((_, speeds)) = speeds.split_first() else {
        return;
    };
    let mut line = String::new();
    let mut area = String::new();
    let mut last = LEFT;
    for range in columns(speeds.len()) {
        let column = &speeds[range.clone()];
        let order = |a: &(usize, &f64), b: &(usize, &f64)| a.1.total_cmp(b.1);
        let least = column.iter().enumerate().min_by(order);
        let most = column.iter().enumerate().max_by(order);
        let (Some(least), Some(most)) = (least, most) else {
            continue;
        };
        let mut ends = [least.0, most.0];
        ends.sort_unstable();
        let begin = if line.is_empty() { "M" } else { "L" };
        for (index, end) in ends
            .iter()
            .enumerate()
            .take(1 + usize::from(ends[0] != ends[1]))
        {
            let begin = if index == 0 { begin } else { "L" };
            let [x, y] = [scale.middle(1 + range.start + end), scale.y(column[*end])];
            let _ = write!(line, "{begin}{x:.1} {y:.1}");
        }
        last = scale.middle(1 + range.start + most.0);
        if area.is_empty() {
            let _ = write!(area, "M{last:.1} {BOTTOM}");
        }
        let _ = write!(area, "L{last:.1} {:.1}", scale.y(*most.1));
    }
    let _ = write!(
        out,
        r##"<path d="{area}L{last:.1} {BOTTOM}Z" fill="#eef1f6"/>
<path d="{line}" fill="none" stroke="{CURVE}" stroke-width="1.5" stroke-linejoin="round"/>
"##
    );
}

/// The frames to mark: of those in the same pixel only the fastest.
fn visible_marks(frames: &[u32], speeds: &[f64], scale: &Scale) -> Vec<usize> {
    let mut all: Vec<(i64, f64, usize)> = frames
        .iter()
        .map(|frame| *frame as usize)
        .filter_map(|frame| Some((scale.middle(frame) as i64, *speeds.get(frame)?, frame)))
        .collect();
    all.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)).then(a.2.cmp(&b.2)));
    all.dedup_by_key(|mark| mark.0);
    all.into_iter().map(|mark| mark.2).collect()
}

/// Dots, as subpaths of zero length.
fn points(frames: &[usize], speeds: &[f64], scale: &Scale) -> String {
    let mut points = String::new();
    for frame in frames {
        let _ = write!(
            points,
            "M{:.1} {:.1}h0",
            scale.middle(*frame),
            scale.y(speeds[*frame])
        );
    }
    points
}

fn marks(out: &mut String, chart: &Chart<'_>, scale: &Scale) {
    let speeds = chart.speeds;
    if scale.wide >= MIN_MARK_WIDTH {
        let held = points(&visible_marks(chart.held, speeds, scale), speeds, scale);
        dots(out, &held, 6.5, HELD);
        dots(out, &held, 3.5, "#ffffff");
    }
    let omitted = visible_marks(chart.omitted, speeds, scale);
    let mut lines = String::new();
    for frame in &omitted {
        let [x, y] = [scale.middle(*frame), scale.y(speeds[*frame])];
        let _ = write!(lines, "M{x:.1} {y:.1}V{BOTTOM}");
    }
    let _ = writeln!(out, r#"<path d="{lines}" stroke="{OMITTED}" fill="none"/>"#);
    dots(out, &points(&omitted, speeds, scale), 7.0, OMITTED);
    let mut longer = String::new();
    for frame in visible_marks(chart.duplicated, speeds, scale) {
        // The pose is shown once more in the place of its successor.
        let _ = write!(
            longer,
            "{}",
            triangle(scale.x(frame as f64 + 1.0), BOTTOM + 12.0)
        );
    }
    let _ = writeln!(out, r#"<path d="{longer}" fill="{LONGER}"/>"#);
}

fn dots(out: &mut String, points: &str, size: f64, color: &str) {
    let _ = writeln!(
        out,
        r#"<path d="{points}" stroke="{color}" stroke-width="{size}" stroke-linecap="round" fill="none"/>"#
    );
}

fn triangle(x: f64, y: f64) -> String {
    format!("M{x:.1} {:.1}l4 8h-8Z", y - 8.0)
}

/// The exposure sheet: a bar at the first frame of each drawing. If a column stands for several frames, its height is the share
/// of drawings.
fn sheet(out: &mut String, exposure: &Exposure, scale: &Scale) {
    let [top, bottom] = SHEET;
    let mut key = vec![false; exposure.len()];
    for frame in exposure.keys() {
        key[frame] = true;
    }
    let mut bars = String::new();
    for range in columns(key.len()) {
        let keys = key[range.clone()].iter().filter(|key| **key).count();
        if keys == 0 {
            continue;
        }
        let wide = scale.wide * range.len() as f64;
        let gap = if wide >= MIN_MARK_WIDTH { 1.0 } else { 0.0 };
        let high = (bottom - top) * keys as f64 / range.len() as f64;
        let x = scale.x(range.start as f64);
        let _ = write!(
            bars,
            "M{x:.2} {bottom}v-{high:.1}h{:.2}v{high:.1}Z",
            wide - gap
        );
    }
    let _ = write!(
        out,
        r#"<rect x="{LEFT}" y="{top}" width="{:.1}" height="{}" fill="{SHOWN}"/>
<path d="{bars}" fill="{DRAWING}"/>
<text x="{}" y="{:.1}" text-anchor="end">drawings</text>
"#,
        scale.wide * exposure.len() as f64,
        bottom - top,
        LEFT - 8.0,
        f64::midpoint(top, bottom) + 4.0
    );
}

/// The time axes: frames and seconds.
fn times(out: &mut String, frames: usize, fps: f64, scale: &Scale) {
    let [_, sheet] = SHEET;
    axis(
        out,
        "frame",
        sheet + 6.0,
        [1.0, step(frames as f64 / 10.0).max(1.0)],
        frames,
        // Frames are counted from 1.
        |frame| scale.x(frame - 0.5),
    );
    if fps > 0.0 && fps.is_finite() {
        let seconds = frames as f64 / fps;
        let step = step(seconds / 10.0);
        // Time 0 is at the first frame.
        let at = |second: f64| scale.x(second * fps + 0.5);
        axis(
            out,
            "seconds",
            sheet + 38.0,
            [0.0, step],
            (seconds / step).ceil() as usize,
            at,
        );
    }
}

/// An axis with a tick at its first value and at each multiple of the step.
fn axis(
    out: &mut String,
    name: &str,
    y: f64,
    [first, step]: [f64; 2],
    most: usize,
    at: impl Fn(f64) -> f64,
) {
    let mut ticks = String::new();
    let mut labels = String::new();
    let multiples = (1..=most).take(MAX_TICKS).map(|index| index as f64 * step);
    // Two ticks need room for their numbers.
    let multiples = multiples.filter(|value| value - first >= step / 2.0);
    for value in std::iter::once(first).chain(multiples) {
        let x = at(value);
        if x > RIGHT {
            break;
        }
        let _ = write!(ticks, "M{x:.1} {y}v5");
        let _ = write!(
            labels,
            r#"<text x="{x:.1}" y="{}" text-anchor="middle">{}</text>"#,
            y + 18.0,
            number(value)
        );
    }
    let _ = write!(
        out,
        r##"<path d="M{LEFT} {y}H{RIGHT}{ticks}" stroke="#9198a1" fill="none"/>
{labels}
<text x="{}" y="{}" text-anchor="end">{name}</text>
"##,
        LEFT - 8.0,
        y + 14.0
    );
}

fn legend(out: &mut String, chart: &Chart<'_>, scale: &Scale) {
    let keys = chart.exposure.keys().count();
    let y = 60.0;
    let mut x = LEFT;
    let mut entry = |mark: &str, text: String| {
        let _ = writeln!(
            out,
            r#"<g transform="translate({x:.0} {y})">{mark}<text x="22" y="4">{text}</text></g>"#
        );
        // Approximately the width of letters in most fonts.
        x += 44.0 + 6.4 * text.chars().count() as f64;
    };
    let line = format!(r#"<path d="M0 0h16" stroke="{CURVE}" stroke-width="2"/>"#);
    entry(&line, "SSD of the source".to_owned());
    let dot = |size: f64, color: &str| {
        format!(
            r#"<path d="M8 0h0" stroke="{color}" stroke-width="{size}" stroke-linecap="round"/>"#
        )
    };
    if !chart.omitted.is_empty() {
        entry(
            &dot(7.0, OMITTED),
            format!("{} omitted", chart.omitted.len()),
        );
    }
    if !chart.duplicated.is_empty() {
        let mark = format!(r#"<path d="{}" fill="{LONGER}"/>"#, triangle(8.0, 4.0));
        entry(
            &mark,
            format!("{} shown longer instead", chart.duplicated.len()),
        );
    }
    if !chart.held.is_empty() {
        // If frames are too narrow for marks, only the exposure sheet shows holds.
        let mark = if scale.wide >= MIN_MARK_WIDTH {
            dot(6.5, HELD) + &dot(3.5, "#ffffff")
        } else {
            format!(r#"<path d="M2 -6h12v12h-12Z" fill="{SHOWN}"/>"#)
        };
        entry(&mark, format!("{} held", chart.held.len()));
    }
    let mark = format!(r#"<path d="M5 -6h6v12h-6Z" fill="{DRAWING}"/>"#);
    entry(
        &mark,
        format!("{keys} drawings in {} frames", chart.exposure.len()),
    );
}
