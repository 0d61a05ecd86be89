//! Tracks read from CSV, as `okoshi track` writes it and as spreadsheets do.

use glam::DVec2;

use super::check::{
    MAX_FRAMES, MAX_MARKS, check_coordinate, check_name, check_size, check_time, repeated_name,
};
use super::{Error, MarkTrack, MarkTracks, bridge, named_color, parse_hex};

/// The colour of a mark whose name says none.
const GRAY: [u8; 3] = [128; 3];

/// A cell: its text without quotes and blanks, and where it is.
#[derive(Clone, Copy)]
struct Cell<'a> {
    text: &'a str,
    line: usize,
    column: usize,
}

impl Cell<'_> {
    fn error(&self, message: impl Into<String>, help: impl Into<String>) -> Error {
        self.place(Error::whole(message, help))
    }

    fn place(&self, error: Error) -> Error {
        error.at(self.line, self.column)
    }
}

/// The size of the pictures and the colours of marks, from the lines that begin with `#`.
#[derive(Default)]
struct Comment<'a> {
    size: Option<[u32; 2]>,
    colors: Vec<(&'a str, [u8; 3])>,
}

/// The columns of a mark, and what was read from them.
struct Columns<'a> {
    name: &'a str,
    x: usize,
    y: usize,
    lost: Option<usize>,
    ambiguous: Option<usize>,
    points: Vec<Option<DVec2>>,
    is_lost: Vec<bool>,
    is_ambiguous: Vec<bool>,
}

pub(super) fn read(text: &str) -> Result<MarkTracks, Error> {
    let mut comment = Comment::default();
    let mut lines = text.lines().enumerate().filter(|(_, line)| !is_blank(line));
    let header = loop {
        let Some((index, line)) = lines.next() else {
            return Err(Error::whole(
                "the file has no frames",
                "`okoshi track` makes a track of a clip",
            ));
        };
        match line.trim_start_matches(['"', ' ']).strip_prefix('#') {
            Some(text) => comment.read(text, index + 1)?,
            None => break (index + 1, line),
        }
    };
    let separator = separator(header.1);
    let header = cells(header.1, separator, header.0);
    let time = header
        .iter()
        .position(|cell| cell.text.eq_ignore_ascii_case("time"));
    let mut marks = columns(&header)?;
    let (Some(time), false) = (time, marks.is_empty()) else {
        return Err(header[0].error(
            "the file is no track: its first row has no columns `time`, `NAME_x` and `NAME_y`",
            "name the columns, such as `frame,time,red_x,red_y,red_lost`; times are seconds",
        ));
    };
    let Some(size) = comment.size else {
        let help = "begin the file with the line `# 320x240`, with the pictures' width and height in pixels";
        return Err(Error::whole("the size of the clip's pictures is missing", help).at(1, 1));
    };
    let mut times = Vec::new();
    for (index, line) in lines {
        let row = cells(line, separator, index + 1);
        if row.len() < header.len() {
            return Err(row[row.len() - 1].error(
                format!("{} cells for {} columns", row.len(), header.len()),
                "give each frame a row with all cells; leave those of a lost mark empty",
            ));
        }
        let cell = row[time];
        let at = number(cell, separator)?
            .ok_or_else(|| cell.error("the time of the frame is missing", "give it in seconds"))?;
        check_time(times.last().copied(), at).map_err(|error| cell.place(error))?;
        if times.len() == MAX_FRAMES {
            let message = format!("a track has at most {MAX_FRAMES} frames");
            return Err(cell.error(message, "track a shorter clip"));
        }
        times.push(at);
        for mark in &mut marks {
            mark.read(&row, separator)?;
        }
    }
    if times.is_empty() {
        return Err(header[0].error("the file has no frames", "give each frame a row"));
    }
    let middle = DVec2::from_array(size.map(f64::from)) / 2.0;
    let track = |mark: Columns<'_>| MarkTrack {
        name: mark.name.to_owned(),
        color: comment.color(mark.name),
        points: bridge(&times, &mark.points, middle),
        is_lost: mark.is_lost,
        is_ambiguous: mark.is_ambiguous,
    };
    Ok(MarkTracks {
        size,
        marks: marks.into_iter().map(track).collect(),
        times,
    })
}

impl<'a> Comment<'a> {
    /// Reads a comment: its words are a size, such as `320x240`, and colours, such as `red=#d03020`. Others are a person's.
    fn read(&mut self, text: &'a str, line: usize) -> Result<(), Error> {
        for word in text.split([' ', ',', ';', '\t', '"']) {
            if let Some((name, color)) = word.split_once('=')
                && let Some(color) = parse_hex(color)
            {
                self.colors.push((name, color));
            } else if let Some((width, height)) = word.split_once(['x', '×'])
                && let (Ok(width), Ok(height)) = (width.parse(), height.parse())
            {
                check_size([width, height]).map_err(|error| error.at(line, 1))?;
                self.size = Some([width, height]);
            }
        }
        Ok(())
    }

    /// The colour of a mark: the one that the comment says, otherwise the one that its name says.
    fn color(&self, name: &str) -> [u8; 3] {
        let said = self.colors.iter().find(|(other, _)| *other == name);
        let color = said.map(|(_, color)| *color);
        color.or_else(|| named_color(name)).unwrap_or(GRAY)
    }
}

impl Columns<'_> {
    /// Reads the mark's cells of a row.
    fn read(&mut self, row: &[Cell<'_>], separator: char) -> Result<(), Error> {
        let coordinate = |column: usize| {
            let value = number(row[column], separator)?;
            let checked = value.map_or(Ok(()), check_coordinate);
            checked
                .map(|()| value)
                .map_err(|error| row[column].place(error))
        };
        let point = match (coordinate(self.x)?, coordinate(self.y)?) {
            (Some(x), Some(y)) => Some(DVec2::new(x, y)),
            (None, None) => None,
            (x, _) => {
                let cell = row[if x.is_none() { self.x } else { self.y }];
                let help = "leave both coordinates of a lost mark empty";
                return Err(cell.error("one coordinate of the place is missing", help));
            }
        };
        let is = |column: Option<usize>, what: &str| {
            let Some(cell) = column.map(|column| row[column]) else {
                return Ok(false);
            };
            match cell.text.to_ascii_lowercase().as_str() {
                "" | "0" | "false" => Ok(false),
                "1" | "true" => Ok(true),
                _ => {
                    let help = format!("write 1 where the mark is {what}");
                    Err(cell.error("this is neither 0 nor 1", help))
                }
            }
        };
        let is_ambiguous = is(self.ambiguous, "ambiguous")?;
        let is_lost = is(self.lost, "lost")? || is_ambiguous || point.is_none();
        self.points.push(point);
        self.is_lost.push(is_lost);
        self.is_ambiguous.push(is_ambiguous);
        Ok(())
    }
}

/// The columns of the marks, in the order of `NAME_x`.
fn columns<'a>(header: &[Cell<'a>]) -> Result<Vec<Columns<'a>>, Error> {
    let find = |name: &str, end: &str| {
        let is_it = |cell: &Cell<'_>| cell.text.strip_suffix(end) == Some(name);
        header.iter().position(is_it)
    };
    let mut marks = Vec::new();
    for (x, cell) in header.iter().enumerate() {
        let Some(name) = cell.text.strip_suffix("_x") else {
            continue;
        };
        check_name(name).map_err(|error| cell.place(error))?;
        let Some(y) = find(name, "_y") else {
            let message = format!("there is a column `{name}_x`, but no `{name}_y`");
            return Err(cell.error(message, format!("name a column `{name}_y`")));
        };
        marks.push(Columns {
            name,
            x,
            y,
            lost: find(name, "_lost"),
            ambiguous: find(name, "_ambiguous"),
            points: Vec::new(),
            is_lost: Vec::new(),
            is_ambiguous: Vec::new(),
        });
    }
    if let Some(index) = repeated_name(marks.iter().map(|mark| mark.name)) {
        let mark = &marks[index];
        let message = format!("there is a column `{}_x` already", mark.name);
        return Err(header[mark.x].error(message, "give each mark a name of its own"));
    }
    if let Some(mark) = marks.get(MAX_MARKS) {
        let message = format!("a track has at most {MAX_MARKS} marks");
        return Err(header[mark.x].error(message, "split the file"));
    }
    Ok(marks)
}

/// Whether a line has nothing but separators, which spreadsheets write for empty rows.
fn is_blank(line: &str) -> bool {
    line.chars()
        .all(|c| c.is_whitespace() || ",;\"".contains(c))
}

/// What separates the cells: what the header has most of.
fn separator(header: &str) -> char {
    let count = |separator: &char| header.matches(*separator).count();
    [',', ';', '\t']
        .into_iter()
        .rev()
        .max_by_key(count)
        .unwrap_or(',')
}

/// The cells of a line, one at least. No cell of a track has a separator in it, so quotes say nothing.
fn cells(line: &str, separator: char, number: usize) -> Vec<Cell<'_>> {
    let mut column = 1;
    let cell = |text: &'_ str| {
        let at = column;
        column += text.chars().count() + 1;
        at
    };
    let starts: Vec<usize> = line.split(separator).map(cell).collect();
    let texts = line.split(separator);
    texts
        .zip(starts)
        .map(|(text, column)| Cell {
            text: text.trim_matches(|c: char| c.is_whitespace() || c == '"'),
            line: number,
            column,
        })
        .collect()
}

/// The number in a cell; none if it is empty. Where cells are not separated by commas, one may stand for the decimal point.
fn number(cell: Cell<'_>, separator: char) -> Result<Option<f64>, Error> {
    if cell.text.is_empty() {
        return Ok(None);
    }
    let text = match separator {
        ',' => cell.text.to_owned(),
        _ => cell.text.replace(',', "."),
    };
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    number.map(Some).ok_or_else(|| {
        let shown: String = cell.text.chars().take(40).collect();
        let message = format!("`{}` is no number", shown.escape_debug());
        let help = "write a number such as 12.5, or leave the cells of a lost mark empty";
        cell.error(message, help)
    })
}
