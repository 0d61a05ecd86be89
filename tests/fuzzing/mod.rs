//! What is fuzzed: for each target a law that must hold for every input, and the inputs that the search begins with.
//!
//! The targets in `fuzz/` run the laws with coverage feedback for as long as they are told to; `tests/fuzzed.rs` runs them
//! for a moment in the ordinary tests, without feedback. A law fails by a panic.

#[path = "../common/patience.rs"]
#[allow(dead_code, reason = "only the limit is needed here")]
mod patience;

mod changes;
mod character;
mod drawing;
mod files;
mod messages;
mod model;
mod motion;
mod performance;
mod picture;
mod puppet;
mod scene;
mod session;
mod string;
mod tiled;
mod track;

/// A reader of outside bytes, and the law that it is held to.
pub(crate) struct Target {
    /// The name of the fuzzing target, and of the folder with its regressions.
    pub(crate) name: &'static str,
    /// Panics if the law does not hold for an input. Returns whether it was one that could be read.
    pub(crate) check: fn(&[u8]) -> bool,
    /// The inputs that the search begins with.
    pub(crate) seeds: fn() -> Vec<Vec<u8>>,
}

/// All targets.
pub(crate) const TARGETS: [Target; 14] = [
    Target {
        name: "string",
        check: string::check,
        seeds: string::seeds,
    },
    Target {
        name: "drawing",
        check: drawing::check,
        seeds: drawing::seeds,
    },
    Target {
        name: "changes",
        check: changes::check,
        seeds: changes::seeds,
    },
    Target {
        name: "motion",
        check: motion::check,
        seeds: motion::seeds,
    },
    Target {
        name: "model",
        check: model::check,
        seeds: model::seeds,
    },
    Target {
        name: "scene",
        check: scene::check,
        seeds: scene::seeds,
    },
    Target {
        name: "picture",
        check: picture::check,
        seeds: picture::seeds,
    },
    Target {
        name: "character",
        check: character::check,
        seeds: character::seeds,
    },
    Target {
        name: "messages",
        check: messages::check,
        seeds: messages::seeds,
    },
    Target {
        name: "session",
        check: session::check,
        seeds: session::seeds,
    },
    Target {
        name: "track",
        check: track::check,
        seeds: track::seeds,
    },
    Target {
        name: "performance",
        check: performance::check,
        seeds: performance::seeds,
    },
    Target {
        name: "puppet",
        check: puppet::check,
        seeds: puppet::seeds,
    },
    Target {
        name: "tiled",
        check: tiled::check,
        seeds: tiled::seeds,
    },
];

/// The target of this name.
pub(crate) fn target(name: &str) -> &'static Target {
    let found = TARGETS.iter().find(|target| target.name == name);
    found.unwrap_or_else(|| panic!("there is no target `{name}`"))
}
