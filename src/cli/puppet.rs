//! `okoshi puppet`

use std::path::{Path, PathBuf};

use super::args::{Common, Puppet};
use super::loading::{Loaded, load, resolver};
use super::progress::spinning;
use super::{Failure, Outcome, counted, ending};
use crate::disk::{Inputs, Naming, is_standard_stream};
use crate::math;
use crate::puppet::{self, MarkOrigin, Options, Sheet};

/// Writes the sheet of a drawing's figures.
pub(super) fn run(arguments: &Puppet, common: Common) -> Result<Outcome, Failure> {
    let (output, naming) = output(arguments)?;
    let loaded = load(&arguments.drawing, &arguments.reading)?;
    eprint!("{}", loaded.findings_aside(common));
    if loaded.compiled.has_errors() {
        if !common.quiet {
            eprintln!("`{}` was not written", output.display());
        }
        return Ok(Outcome::Errors);
    }
    let sheet = write(&loaded, &output, naming, arguments)?;
    if !common.quiet {
        eprintln!("wrote {}: {}", output.display(), summary(&loaded, &sheet));
        if sheet.pages > 1 {
            eprintln!("print it with Inkscape: other programs show only its first page");
        }
    }
    Ok(loaded.outcome())
}

fn write(
    loaded: &Loaded,
    output: &Path,
    naming: Naming,
    arguments: &Puppet,
) -> Result<Sheet, Failure> {
    let resolver = resolver(&arguments.drawing, &arguments.reading);
    let inputs = Inputs::of(&arguments.drawing).linking(loaded.linked(&resolver));
    let target = inputs.target(output, naming)?;
    let title = if is_standard_stream(&arguments.drawing) {
        "puppet".into()
    } else {
        arguments
            .drawing
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
    };
    let options = Options {
        page: arguments.page,
        scale: arguments.scale,
    };
    let make = || puppet::sheet(&loaded.compiled, &loaded.text, &title, &resolver, &options);
    let sheet = spinning("laying out", make);
    let sheet = sheet.map_err(|error| format!("`{}` {error}", loaded.path))?;
    target.write(|out| out.write_all(sheet.svg.as_bytes()))?;
    Ok(sheet)
}

/// The file of the sheet, and how it got its name.
fn output(arguments: &Puppet) -> Result<(PathBuf, Naming), String> {
    let drawing = &arguments.drawing;
    let derived = || -> Option<PathBuf> {
        let mut name = drawing
            .file_stem()
            .filter(|_| !is_standard_stream(drawing))?
            .to_owned();
        name.push("-puppet.svg");
        Some(PathBuf::from(name))
    };
    let unnamed = "a drawing from stdin has no name: name the sheet with -o";
    match &arguments.output {
        Some(folder) if folder.is_dir() => {
            let name = derived().ok_or(unnamed)?;
            Ok((folder.join(name), Naming::Derived))
        }
        Some(output) => {
            if ending(output) == "svg" || is_standard_stream(output) {
                Ok((output.clone(), Naming::Given))
            } else {
                Err(format!(
                    "a sheet is an SVG file, so the name of `{}` must end in .svg",
                    output.display()
                ))
            }
        }
        None => {
            let name = derived().ok_or(unnamed)?;
            Ok((drawing.with_file_name(name), Naming::Derived))
        }
    }
}

/// `12 pieces on 2 pages, 24 cm tall (--scale 0.8); marks: red on Rhand, blue on Lhand (suggested)`
fn summary(loaded: &Loaded, sheet: &Sheet) -> String {
    let parts = &loaded.compiled.bindings.parts;
    let marks: Vec<String> = sheet
        .marks
        .iter()
        .map(|mark| format!("{} on {}", mark.word, parts[mark.part].name))
        .collect();
    let is_suggested = |mark: &puppet::PieceMark| mark.origin == MarkOrigin::Suggested;
    let suggested = if sheet.marks.iter().any(is_suggested) {
        ", suggested"
    } else {
        ""
    };
    let marks = if marks.is_empty() {
        String::new()
    } else {
        format!("; marks{suggested}: {}", marks.join(", "))
    };
    format!(
        "{} on {}, {:.0} mm large, --scale {}{marks}",
        counted(sheet.pieces, "piece"),
        counted(sheet.pages, "page"),
        sheet.size,
        rounded(sheet.scale)
    )
}

/// A scale with four digits.
fn rounded(scale: f64) -> f64 {
    let digits = math::powf(10_f64, 3.0 - math::log10(scale).floor());
    (scale * digits).round() / digits
}
