//! Reads and compiles drawings for the commands.

use std::path::{Path, PathBuf};

use super::args::{Common, Reading};
use super::digest::{Detail, describe};
use super::{Outcome, counted, fail, style};
use crate::compile::{Compiled, Options, compile};
use crate::diagnostic::Diagnostic;
use crate::disk::{FolderResolver, decode, is_standard_stream, read_drawing, read_file};
use crate::look::Look;
use crate::report::{Findings, Likeness};

/// A drawing that was read and compiled.
pub(super) struct Loaded {
    /// The path as the user wrote it.
    pub(super) path: String,
    pub(super) text: String,
    pub(super) compiled: Compiled,
    /// How the model looks from the front, if that was asked for.
    pub(super) look: Option<Look>,
}

impl Loaded {
    pub(super) fn findings(&self) -> Findings<'_> {
        Findings {
            path: &self.path,
            text: &self.text,
            diagnostics: &self.compiled.diagnostics,
            look: self.look.as_ref().map(|look| Likeness {
                right: look.right,
                pixels: look.pixels,
                right_without_lines: look.right_without_lines,
                lines: look.lines.map_or(0.0, |lines| lines.share),
                lines_built_by: look.lines.map(|lines| lines.built_by),
            }),
        }
    }

    /// Its findings as text for people, beside what a command does with it.
    pub(super) fn findings_aside(&self, common: Common) -> String {
        let stderr = style(common, &std::io::stderr());
        describe(self.findings(), common, Detail::All, stderr)
    }

    /// The files that it links to, including missing ones.
    pub(super) fn linked(&self, resolver: &FolderResolver) -> Vec<PathBuf> {
        let links = self.compiled.dependencies.iter();
        links.filter_map(|link| resolver.place(link).ok()).collect()
    }

    /// Whether there is a model to write: the empty one that an unreadable drawing gives is worth less than an old one.
    pub(super) fn can_be_written(&self, keep_going: bool) -> bool {
        let is_empty = self.compiled.scene.nodes.is_empty();
        !self.compiled.has_errors() || (keep_going && !is_empty)
    }

    /// Gives back the memory of all that writing the model does not need: of a drawing of very many parts, half of it.
    pub(super) fn keep_model(&mut self) {
        self.text = String::new();
        self.compiled = Compiled {
            scene: std::mem::take(&mut self.compiled.scene),
            diagnostics: std::mem::take(&mut self.compiled.diagnostics),
            dependencies: std::mem::take(&mut self.compiled.dependencies),
            ..Compiled::default()
        };
    }

    pub(super) fn outcome(&self) -> Outcome {
        if self.compiled.has_errors() {
            Outcome::Errors
        } else {
            Outcome::Done
        }
    }
}

/// Where the file goes that is made from a drawing: beside it, or into a folder.
pub(super) fn made_from(
    drawing: &Path,
    folder: Option<&Path>,
    extension: &str,
) -> Result<PathBuf, &'static str> {
    match (folder, drawing.file_name()) {
        (None, _) if is_standard_stream(drawing) => {
            Err("a drawing from stdin is in no folder: name the output with -o")
        }
        (None, _) => Ok(drawing.with_extension(extension)),
        (Some(folder), Some(name)) if !is_standard_stream(drawing) => {
            Ok(folder.join(name).with_extension(extension))
        }
        _ => Err("a drawing from stdin has no name: name the output file with -o"),
    }
}

/// Reads and compiles a drawing.
pub(super) fn load(path: &Path, reading: &Reading) -> Result<Loaded, Outcome> {
    let name = if is_standard_stream(path) {
        "<stdin>".to_owned()
    } else {
        path.display().to_string()
    };
    let bytes = read_drawing(path).map_err(fail)?;
    let lossy = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 12)]).into_owned();
    let (text, compiled) = match decode(bytes) {
        Ok(text) => {
            let compiled = compiled(&text, path, reading);
            (text, compiled)
        }
        Err(error) => (lossy, Compiled::undecoded(&error.to_string())),
    };
    Ok(Loaded {
        path: name,
        text,
        compiled,
        look: None,
    })
}

/// Compiles the text of the drawing at `path`.
pub(super) fn compiled(text: &str, path: &Path, reading: &Reading) -> Compiled {
    let resolver = resolver(path, reading);
    let options = Options {
        tolerance: reading.tolerance,
    };
    compile(text, &options, &resolver)
}

/// Resolves the links of the drawing, or of the model, at `path`.
pub(super) fn resolver(path: &Path, reading: &Reading) -> FolderResolver {
    FolderResolver::new(folder_of_links(path, reading)).allowing(reading.root.as_deref())
}

/// The folder where the links of the drawing at `path` start.
pub(super) fn folder_of_links(path: &Path, reading: &Reading) -> PathBuf {
    let beside = || path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
    reading.base.clone().unwrap_or_else(beside)
}

/// `2 errors, 1 warning`
pub(super) fn count(counts: [usize; 3]) -> String {
    let words = ["error", "warning", "hint"];
    let parts: Vec<String> = counts
        .into_iter()
        .zip(words)
        .filter(|(count, _)| *count > 0)
        .map(|(count, word)| counted(count, word))
        .collect();
    parts.join(", ")
}

/// How many errors, warnings and hints there are.
pub(super) fn tally(diagnostics: &[Diagnostic]) -> [usize; 3] {
    let mut counts = [0; 3];
    for diagnostic in diagnostics {
        counts[diagnostic.severity() as usize] += 1;
    }
    counts
}

/// Refuses to write over a drawing that was changed since it was read.
pub(super) fn check_unchanged(path: &Path, text: &str) -> Result<(), String> {
    let on_disk = read_file(path).map_err(|error| error.to_string())?;
    if on_disk == text.as_bytes() {
        return Ok(());
    }
    Err(format!(
        "`{}` was changed meanwhile; nothing was written",
        path.display()
    ))
}
