//! Whole processes, as a user starts them, and what they write.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// How long a command takes.
pub(crate) fn timed(command: &mut Command) -> Duration {
    let start = Instant::now();
    let status = command.stdout(Stdio::null()).status().expect("it starts");
    assert!(status.success(), "{command:?} failed");
    start.elapsed()
}

/// `okoshi build` into a file that does not exist.
pub(crate) fn build(drawing: &Path, model: &Path) -> Command {
    let _ = std::fs::remove_file(model);
    let mut build = Command::new(env!("CARGO_BIN_EXE_okoshi"));
    build
        .args(["build", "-q"])
        .arg(drawing)
        .arg("-o")
        .arg(model);
    build
}

/// The triangles of a model.
pub(crate) fn triangles(model: &Path) -> usize {
    let model = gltf::Gltf::open(model).expect("a model");
    let indices = model
        .meshes()
        .flat_map(|mesh| mesh.primitives().collect::<Vec<_>>());
    indices
        .filter_map(|primitive| primitive.indices())
        .map(|list| list.count() / 3)
        .sum()
}
