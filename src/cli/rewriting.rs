//! Writes drawings that a command has changed.

use std::path::{Path, PathBuf};

use super::args::Reading;
use super::loading::{Loaded, check_unchanged, load, resolver};
use super::{Failure, ending};
use crate::disk::{Inputs, Naming, is_packed, is_standard_stream, rewrite};
use crate::ide::Analysis;

/// Refuses a name for a drawing that is none.
pub(super) fn is_svg(output: &Path) -> Result<(), String> {
    if is_standard_stream(output) || ending(output) == "svg" {
        return Ok(());
    }
    Err(format!(
        "the result is an SVG file, so the name of `{}` must end in .svg",
        output.display()
    ))
}

/// A drawing that becomes another one.
pub(super) struct Rewriting<'a> {
    /// The drawing that was read; `-` is stdin.
    drawing: &'a Path,
    /// Where to write it, `-` for stdout; `None` for the drawing itself.
    output: Option<&'a Path>,
    /// The files that it links to.
    linked: Vec<PathBuf>,
}

/// A drawing as it was read.
pub(super) struct Original {
    /// What it is called in messages.
    pub(super) path: String,
    pub(super) text: String,
    pub(super) analysis: Analysis,
}

impl<'a> Rewriting<'a> {
    /// Reads a drawing that is to become another one.
    pub(super) fn read(
        drawing: &'a Path,
        output: Option<&'a Path>,
        reading: &Reading,
    ) -> Result<(Self, Original), Failure> {
        if let Some(output) = output {
            is_svg(output)?;
        }
        let loaded = load(drawing, reading)?;
        let linked = loaded.linked(&resolver(drawing, reading));
        let Loaded {
            path,
            text,
            compiled,
            ..
        } = loaded;
        let analysis = Analysis::new(text.as_str(), compiled);
        let original = Original {
            path,
            text,
            analysis,
        };
        Ok((
            Self {
                drawing,
                output,
                linked,
            },
            original,
        ))
    }

    /// Whether the drawing goes to stdout, so that reports do not.
    pub(super) fn is_to_stdout(&self) -> bool {
        is_standard_stream(self.output.unwrap_or(self.drawing))
    }

    /// Writes the drawing, unless it was changed in the meantime.
    pub(super) fn write(self, old: &str, new: &str) -> Result<(), Failure> {
        let output = self.output.unwrap_or(self.drawing);
        if is_standard_stream(output) {
            rewrite(output, new.as_bytes())?;
            return Ok(());
        }
        if self.output.is_some() {
            let inputs = Inputs::of(self.drawing).linking(self.linked);
            let target = inputs.target(output, Naming::Given)?;
            target.write(|out| out.write_all(new.as_bytes()))?;
            return Ok(());
        }
        if is_packed(output) {
            return Err(format!(
                "`{}` is compressed: name the result with -o",
                output.display()
            )
            .into());
        }
        check_unchanged(output, old)?;
        rewrite(output, new.as_bytes())?;
        Ok(())
    }
}
