//! The clips that figures play, and which joint drives which part, and why.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::compile::Compiled;
use crate::rig::{Driven, Shot};

/// A clip of a figure (frontends.md, `inspect --json`).
#[derive(Debug, Clone, Serialize)]
pub struct ClipReport<'a> {
    /// Its name.
    pub name: &'a str,
    /// The part that all others of the figure hang on.
    pub figure: &'a str,
    /// The file, as the string names it.
    pub file: &'a str,
    /// How long it is.
    pub seconds: f64,
    /// How many frames are shown.
    pub frames: usize,
    /// How many poses are shown.
    pub drawings: usize,
    /// The frames that were left out, counted from 1, in their order.
    pub omitted: Vec<u32>,
    /// The frames in whose place the one before stands, counted from 1, in their order.
    pub held: Vec<u32>,
    /// The joint of each part that has one.
    pub joints: BTreeMap<&'a str, &'a str>,
}

/// What drives a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Driver<'a> {
    /// The joint; `None` for a part that follows its parent.
    pub joint: Option<&'a str>,
    /// Why.
    pub why: &'a str,
}

/// The clips of a drawing, in the order in which strings ask for them.
pub fn clip_reports(compiled: &Compiled) -> Vec<ClipReport<'_>> {
    let parts = &compiled.bindings.parts;
    let report = |shot| {
        let shot: &Shot = shot;
        let joint = |driven: &Driven| {
            let name = parts[driven.part].name.as_str();
            driven.joint.map(|joint| (name, shot.joint_name(joint)))
        };
        let (omitted, held) = cut_frames(shot);
        ClipReport {
            name: &shot.name,
            figure: &parts[shot.root].name,
            file: &shot.file,
            seconds: shot.seconds(),
            frames: shot.frames(),
            drawings: shot.drawings(),
            omitted,
            held,
            joints: shot.parts.iter().filter_map(joint).collect(),
        }
    };
    compiled.shots.iter().map(report).collect()
}

/// The frames of a clip that were omitted, and those that were covered by the one before: counted from 1, in their order.
pub fn cut_frames(shot: &Shot) -> (Vec<u32>, Vec<u32>) {
    let Some(cut) = &shot.cut else {
        return (Vec::new(), Vec::new());
    };
    let mut omitted: Vec<u32> = cut.omitted.iter().map(|frame| frame + 1).collect();
    let mut held: Vec<u32> = cut.held.iter().map(|held| held.covered + 1).collect();
    omitted.sort_unstable();
    held.sort_unstable();
    (omitted, held)
}

/// Per part what drives it: the joint of the first clip of its figure that has one for it, else why the first clip has none.
/// `None` for parts of no figure that moves.
pub fn drivers(compiled: &Compiled) -> Vec<Option<Driver<'_>>> {
    let mut drivers: Vec<Option<Driver>> = vec![None; compiled.bindings.parts.len()];
    for shot in &compiled.shots {
        for driven in &shot.parts {
            let driver = &mut drivers[driven.part];
            let is_better =
                driver.is_none_or(|driver| driver.joint.is_none() && driven.joint.is_some());
            if is_better {
                *driver = Some(Driver {
                    joint: driven.joint.map(|joint| shot.joint_name(joint)),
                    why: &driven.why,
                });
            }
        }
    }
    drivers
}

/// What becomes of a part of a figure that no joint of a clip drives.
pub fn undriven(shot: &Shot, driven: &Driven) -> String {
    match driven.part == shot.root {
        true => format!("no joint drives it: {}", driven.why),
        false => format!("follows its parent: {}", driven.why),
    }
}

/// Ordered numbers, neighbours drawn together: `3-6, 9`. Of more than `most` such runs the rest is only counted.
pub fn ranges(numbers: &[u32], most: usize) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let mut texts: Vec<String> = Vec::new();
    let mut more = 0;
    for run in runs {
        match run {
            _ if texts.len() >= most => more += run.len(),
            [one] => texts.push(one.to_string()),
            run => texts.push(format!("{}-{}", run[0], run[run.len() - 1])),
        }
    }
    if more > 0 {
        texts.push(format!("{more} more"));
    }
    texts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_drawn_together() {
        assert_eq!(ranges(&[3, 4, 5, 9, 11, 12], usize::MAX), "3-5, 9, 11-12");
        assert_eq!(ranges(&[3, 4, 5, 9, 11, 12], 1), "3-5, 3 more");
        assert_eq!(ranges(&[], 1), "");
    }
}
