//! What the sheet says: how the puppet is made, and how it is filmed. Lengths are millimetres.

use super::marks::{MarkOrigin, PieceMark};

/// The size of letters.
pub(super) const FONT: f64 = 3.2;
/// The size of the title.
pub(super) const TITLE: f64 = 5.0;
/// The height of a line.
pub(super) const LINE: f64 = 4.8;
/// What is between the title and the first line.
pub(super) const BELOW_TITLE: f64 = 3.0;
/// The room for a sample of a mark's colour before a line.
pub(super) const SAMPLE: f64 = 5.0;
/// The width of most letters, as a share of their size.
const LETTER: f64 = 0.62;
/// How many marks are listed; nobody moves more with two hands.
const MAX_LISTED: usize = 8;
/// What ends a line of a command that goes on.
const GOES_ON: &str = " \\";

/// The texts of a sheet.
pub(super) struct Texts {
    /// The title.
    pub(super) title: String,
    /// The lines below it.
    pub(super) lines: Vec<Line>,
}

/// A line of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Line {
    pub(super) text: String,
    /// The colour of the mark that it is about.
    pub(super) color: Option<[u8; 3]>,
}

impl Texts {
    /// The texts of a sheet whose pages have room for lines of that width, for marks with the names of their parts.
    pub(super) fn new(title: &str, marks: &[(&PieceMark, String)], width: f64) -> Self {
        let mut texts = Self {
            title: shortened(title, width * FONT / TITLE),
            lines: Vec::new(),
        };
        texts.say(
            "Glue the sheet onto thin card and cut along the grey lines. Make a hole at each cross.",
            width,
        );
        texts.say(
            "Pin holes with the same letter together with paper fasteners.",
            width,
        );
        let listed = &marks[..marks.len().min(MAX_LISTED)];
        if !listed.is_empty() {
            texts.say(
                "Film it from the front, with a camera that stands still. Then:",
                width,
            );
            let words = listed.iter().map(|(mark, _)| mark.word.as_str());
            texts.add(track_command(words, width), None);
        }
        for (mark, name) in listed {
            let text = match mark.origin {
                MarkOrigin::Given => format!("{}: {name}", mark.word),
                MarkOrigin::Suggested => format!(
                    "{}: {name}. In the drawing, add Mark {} to the string of {name}.",
                    mark.word, mark.word
                ),
            };
            texts.add(wrapped(&text, width - SAMPLE), Some(mark.color));
        }
        match marks.len() - listed.len() {
            0 => {}
            more => texts.say(&format!("… and {more} more"), width),
        }
        texts
    }

    /// What they take of the first page, with the line of the ruler.
    pub(super) fn height(&self) -> f64 {
        TITLE + BELOW_TITLE + (self.lines.len() + 1) as f64 * LINE
    }

    fn say(&mut self, text: &str, width: f64) {
        self.add(wrapped(text, width), None);
    }

    /// Adds lines, the first with a sample of the colour.
    fn add(&mut self, lines: Vec<String>, mut color: Option<[u8; 3]>) {
        let lines = lines.into_iter().map(|text| Line {
            text,
            color: color.take(),
        });
        self.lines.extend(lines);
    }
}

/// The width of a line of text, roughly.
pub(super) fn text_width(text: &str) -> f64 {
    let letters = text
        .chars()
        .map(|c| if c.is_ascii() { LETTER } else { 1.0 });
    FONT * letters.sum::<f64>()
}

/// A line of text that is not wider than that.
pub(super) fn shortened(text: &str, width: f64) -> String {
    if text_width(text) <= width {
        return text.to_owned();
    }
    let mut short = text.to_owned();
    while !short.is_empty() && text_width(&short) > width - FONT {
        short.pop();
    }
    short + "…"
}

/// A text in lines that are not wider than that.
fn wrapped(text: &str, width: f64) -> Vec<String> {
    filled(text.split(' '), width, "")
}

/// The command that finds the marks in a film, for a shell.
fn track_command<'a>(marks: impl Iterator<Item = &'a str>, width: f64) -> Vec<String> {
    let mut options: Vec<String> = Vec::new();
    for word in marks {
        let option = if word.starts_with('#') {
            format!("--mark '{word}={word}'")
        } else {
            format!("--mark {word}={word}")
        };
        if !options.contains(&option) {
            options.push(option);
        }
    }
    let start = ["okoshi track film.mp4", "-o film.json"];
    let words = start.into_iter().chain(options.iter().map(String::as_str));
    filled(words, width, GOES_ON)
}

/// Fills lines with words; `end` is at the end of all lines but the last.
fn filled<'a>(words: impl Iterator<Item = &'a str>, width: f64, end: &str) -> Vec<String> {
    let width = width - text_width(end);
    let mut lines: Vec<String> = Vec::new();
    for word in words {
        match lines.last_mut() {
            Some(line) if text_width(line) + text_width(word) + FONT * LETTER <= width => {
                line.push(' ');
                line.push_str(word);
            }
            last => {
                if let Some(line) = last {
                    line.push_str(end);
                }
                lines.push(shortened(word, width));
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(word: &str) -> PieceMark {
        PieceMark {
            word: word.to_owned(),
            color: [1, 2, 3],
            part: 0.into(),
            origin: MarkOrigin::Suggested,
        }
    }

    #[test]
    fn commands_are_broken_between_options() {
        let words = ["red", "#00f", "red", "lime", "cyan"];
        let lines = track_command(words.into_iter(), 110.0);
        assert_eq!(
            lines,
            [
                "okoshi track film.mp4 -o film.json --mark red=red \\",
                "--mark '#00f=#00f' --mark lime=lime --mark cyan=cyan"
            ]
        );
    }

    #[test]
    fn no_line_is_wider_than_the_page() {
        let marks: Vec<PieceMark> = (0..20)
            .map(|index| mark(&format!("#00000{index}")))
            .collect();
        let long = "very".repeat(50);
        let marks: Vec<_> = marks.iter().map(|mark| (mark, long.clone())).collect();
        let texts = Texts::new(&long, &marks, 60.0);
        for line in &texts.lines {
            let indent = if line.color.is_some() { SAMPLE } else { 0.0 };
            assert!(text_width(&line.text) + indent <= 60.0, "{line:?}");
        }
        let colored = texts.lines.iter().filter(|line| line.color.is_some());
        assert_eq!(colored.count(), MAX_LISTED);
        assert_eq!(texts.lines.last().unwrap().text, "… and 12 more");
    }
}
