//! Drawings that are short and might take long, in any size: for each kind a function that makes one.

use std::f64::consts::TAU;
use std::fmt::Write as _;

/// A kind of hostile drawing.
#[derive(Clone, Copy)]
pub(crate) struct Kind {
    /// Its name, as of a file.
    pub(crate) name: &'static str,
    /// The size at which it must be fast or refused. The drawing is under 1 MiB then.
    pub(crate) full: usize,
    /// The smallest of the sizes at which its work is counted. Twice and four times as large, it must be twice and four times as much.
    pub(crate) small: usize,
    /// Makes one of a size: about so many elements, points or whatever the kind repeats.
    pub(crate) make: fn(usize) -> String,
}

/// A drawing of 1000 × 1000 with this content.
pub(crate) fn page(body: &str) -> String {
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="1000" height="1000">{body}</svg>
"#
    )
}

/// A text, such as a string that begins with `%`; nothing of nothing.
pub(crate) fn text(content: &str) -> String {
    if content.is_empty() {
        return String::new();
    }
    format!(r#"<text x="5" y="5">{content}</text>"#)
}

/// A filled path.
pub(crate) fn filled(data: &str) -> String {
    format!(r#"<path fill-rule="evenodd" d="{data}"/>"#)
}

/// Path data of a closed polygon, with a digit after the point.
pub(crate) fn polygon(points: impl IntoIterator<Item = [f64; 2]>) -> String {
    line(points) + "Z"
}

/// Path data of an open line, with a digit after the point.
pub(crate) fn line(points: impl IntoIterator<Item = [f64; 2]>) -> String {
    let mut data = String::from("M");
    for (number, [x, y]) in points.into_iter().enumerate() {
        let separator = if number > 0 { " " } else { "" };
        let _ = write!(data, "{separator}{x:.1} {y:.1}");
    }
    data
}

/// Repeats what is made of the numbers up to a number.
pub(crate) fn each(count: usize, make: impl FnMut(usize) -> String) -> String {
    (0..count).map(make).collect()
}

/// The points of a star with so many tips.
pub(crate) fn star(tips: usize, [x, y]: [f64; 2], radius: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..2 * tips).map(move |i| {
        let angle = TAU * i as f64 / (2 * tips) as f64;
        let r = if i % 2 == 0 { radius } else { radius * 0.6 };
        [x + r * angle.cos(), y + r * angle.sin()]
    })
}

/// Columns and rows of a square grid for so many things: the middle of one, and the distance between two.
pub(crate) fn grid(count: usize, number: usize) -> ([f64; 2], f64) {
    let columns = (count as f64).sqrt().ceil().max(1.0) as usize;
    let step = 1000.0 / columns as f64;
    let middle = |index: usize| (index as f64 + 0.5) * step;
    ([middle(number % columns), middle(number / columns)], step)
}
