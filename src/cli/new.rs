//! `okoshi new`

use std::fmt::Write as _;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};

use clap::ValueEnum as _;

use super::args::{Common, New};
use super::terminal::Protocol;
use super::{Failure, Outcome, print_out};
use crate::disk::{WriteError, is_standard_stream, write_new};
use crate::starters::Template;

impl Template {
    /// The template of a drawing that is called like one, and else the girl.
    fn called(drawing: &Path) -> Self {
        let stem = drawing.file_stem().unwrap_or_default().to_string_lossy();
        Self::from_str(&stem, false).unwrap_or(Self::Girl)
    }
}

/// Their models side by side, in the order of the list, as a PNG: `tests/tools/starters.sh` makes it.
const SHEET: &[u8] = include_bytes!("../../docs/starters.png");

/// Writes a starter drawing, and suggests the next commands; or lists the drawings.
pub(super) fn run(arguments: &New, common: Common) -> Result<Outcome, Failure> {
    let Some(name) = &arguments.name else {
        return Ok(list());
    };
    let template = arguments.template.unwrap_or_else(|| Template::called(name));
    let drawing = template.drawing();
    if is_standard_stream(name) {
        return Ok(print_out(drawing));
    }
    let path = named(name)?;
    write_new(&path, drawing.as_bytes()).map_err(|error| explained(&error))?;
    if !common.quiet {
        eprint!("{}", next_steps(&path));
    }
    Ok(Outcome::Done)
}

/// Prints a line for each template, below a picture of all where the terminal shows pictures.
fn list() -> Outcome {
    let mut text = String::new();
    if std::io::stdout().is_terminal()
        && let Some(protocol) = Protocol::of_terminal(|name| std::env::var(name).ok())
    {
        text = protocol.show(SHEET);
    }
    for value in Template::value_variants()
        .iter()
        .filter_map(Template::to_possible_value)
    {
        let help = value.get_help().map(ToString::to_string);
        let help = help.unwrap_or_default();
        let _ = writeln!(text, "{:<12}{help}", value.get_name());
    }
    print_out(&text)
}

/// The file of the drawing: the name, with `.svg` appended unless it has that extension.
fn named(name: &Path) -> Result<PathBuf, String> {
    let bare = name.as_os_str().as_encoded_bytes();
    let closed = bare
        .last()
        .is_none_or(|byte| std::path::is_separator(char::from(*byte)));
    let Some(file) = name.file_name().filter(|_| !closed) else {
        return Err(format!(
            "`{}` is not a file name; name the drawing, for example `okoshi new robot`",
            name.display()
        ));
    };
    let ending = name.extension().unwrap_or_default().to_string_lossy();
    if ending.eq_ignore_ascii_case("svg") {
        return Ok(name.to_owned());
    }
    if ending.eq_ignore_ascii_case("svgz") {
        return Err(format!(
            "`{}` would be compressed, and new drawings are not; write `{}`",
            name.display(),
            name.with_extension("svg").display()
        ));
    }
    let mut file = file.to_owned();
    file.push(".svg");
    Ok(name.with_file_name(file))
}

/// Why a new drawing is not written, and what to do about it.
pub(super) fn explained(error: &WriteError) -> String {
    match error {
        WriteError::Exists(path) => format!(
            "`{0}` exists, and drawings are never overwritten; choose another name, or build it: okoshi build {1}",
            path.display(),
            quoted(path)
        ),
        WriteError::NoFolder(folder) => format!(
            "the folder `{}` is not there; create it, or name a drawing in one that is",
            folder.display()
        ),
        WriteError::FolderDenied(folder) => format!(
            "no permission to write in the folder `{}`; name a drawing in another",
            folder.display()
        ),
        other => other.to_string(),
    }
}

fn next_steps(path: &Path) -> String {
    let drawing = quoted(path);
    format!(
        "wrote {}; draw on in Inkscape, and try next:\n  okoshi preview {drawing} --open\n  okoshi build {drawing}\n  okoshi inspect {drawing}\n",
        path.display()
    )
}

/// A path quoted for a shell.
pub(super) fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    // A name that begins with `-` would be taken for an option.
    let text = match text.strip_prefix('-') {
        Some(_) => format!("./{text}"),
        None => text,
    };
    let plain = |c: char| c.is_alphanumeric() || "/._-+:\\".contains(c);
    if text.chars().all(plain) {
        text
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_get_their_ending_once() {
        for (given, path) in [
            ("robot", "robot.svg"),
            ("robot.svg", "robot.svg"),
            ("robot.SVG", "robot.SVG"),
            ("my.robot", "my.robot.svg"),
            ("in/a/folder", "in/a/folder.svg"),
            (".svg", ".svg.svg"),
            ("ロボット", "ロボット.svg"),
        ] {
            assert_eq!(named(Path::new(given)), Ok(PathBuf::from(path)), "{given}");
        }
        for given in ["", ".", "..", "/", "folder/", "a.svg/", "a.svgz"] {
            assert!(named(Path::new(given)).is_err(), "{given}");
        }
    }

    #[test]
    fn a_drawing_that_is_called_like_a_template_is_one() {
        for (name, template) in [
            ("robot", Template::Robot),
            ("in/a/folder/dog.svg", Template::Dog),
            ("racing-car.SVG", Template::RacingCar),
            ("car", Template::RacingCar),
            ("human", Template::Girl),
            ("Robot", Template::Girl),
            ("robot.v2.svg", Template::Girl),
            ("-", Template::Girl),
            ("", Template::Girl),
        ] {
            assert_eq!(Template::called(Path::new(name)), template, "{name}");
        }
    }

    #[test]
    fn commands_can_be_pasted() {
        for (path, word) in [
            ("robot.svg", "robot.svg"),
            ("a/ロボット.svg", "a/ロボット.svg"),
            ("my robot.svg", "'my robot.svg'"),
            ("it's.svg", r"'it'\''s.svg'"),
            ("-v.svg", "./-v.svg"),
        ] {
            assert_eq!(quoted(Path::new(path)), word);
        }
    }
}
