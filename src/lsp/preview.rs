//! A picture of the model, for editors to show.

use std::io::{self, Cursor};
use std::path::PathBuf;

use crate::disk::write_cached;
use crate::gltf::{self, Container};
use crate::ide::Analysis;
use crate::render::{self, Options, Stage, write_png};
use crate::resolver::MemoryResolver;

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(super) enum PreviewError {
    /// The drawing has errors.
    #[error("the drawing has errors: mend them first, they are marked in the text")]
    Errors,
    /// There is nothing to see.
    #[error("the drawing has no parts that could be shown")]
    Nothing,
    /// It could not be drawn or written.
    #[error("the model cannot be shown: {0}")]
    Failed(String),
}

/// Draws the model of a drawing, and says in which file the picture is. `name` tells drawings apart.
pub(super) fn picture(analysis: &Analysis, name: &str) -> Result<PathBuf, PreviewError> {
    let compiled = analysis.compiled();
    if compiled.has_errors() {
        return Err(PreviewError::Errors);
    }
    if compiled.scene.nodes.is_empty() {
        return Err(PreviewError::Nothing);
    }
    let failed = |error: &dyn std::fmt::Display| PreviewError::Failed(error.to_string());
    let mut bytes = Cursor::new(Vec::new());
    gltf::write(&compiled.scene, Container::Glb, &mut bytes).map_err(|error| failed(&error))?;
    let model = render::read(&bytes.into_inner(), &MemoryResolver::default())
        .map_err(|error| failed(&error))?;
    let stage = Stage::new(&model, &model.rest()).map_err(|error| failed(&error))?;
    let options = Options {
        background: Some([255, 255, 255]),
        ..Options::default()
    };
    let image = stage.picture(&options).map_err(|error| failed(&error))?;
    let file = format!("preview-{name}.png");
    write_cached(&file, |out| {
        write_png(&image, out).map_err(io::Error::other)
    })
    .ok_or_else(|| failed(&"there is no folder for it"))
}
