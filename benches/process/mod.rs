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

/// What repeated measurements of a time gave, in seconds.
pub(crate) struct Times {
    pub(crate) median: f64,
    pub(crate) least: f64,
}

/// Measures several times in turn, so that what else the machine does disturbs all of them alike. One more round warms up.
pub(crate) fn interleaved<const N: usize>(
    rounds: usize,
    measures: [&dyn Fn() -> Duration; N],
) -> [Times; N] {
    for measure in measures {
        let _ = measure();
    }
    let mut times = [const { Vec::new() }; N];
    for _ in 0..rounds {
        for (times, measure) in times.iter_mut().zip(measures) {
            times.push(measure().as_secs_f64());
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        Times {
            median: times[times.len() / 2],
            least: times[0],
        }
    })
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
