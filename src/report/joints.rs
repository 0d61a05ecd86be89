//! Which joint drives which part, and why.

use crate::compile::Compiled;
use crate::rig::{FigureClip, PartDrive};

/// The joint that drives a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Driver<'a> {
    /// Its name; `None` for a part that follows its parent.
    pub joint: Option<&'a str>,
    /// The reason.
    pub why: &'a str,
}

/// Per part the joint that drives it, from the first clip of its figure in which one does, else the first clip's reason why none does.
/// `None` for parts of figures that do not move.
pub fn drivers(compiled: &Compiled) -> Vec<Option<Driver<'_>>> {
    let mut drivers: Vec<Option<Driver>> = vec![None; compiled.bindings.parts.len()];
    for clip in &compiled.clips {
        for drive in &clip.parts {
            let driver = &mut drivers[drive.part];
            let is_better =
                driver.is_none_or(|driver| driver.joint.is_none() && drive.joint.is_some());
            if is_better {
                *driver = Some(Driver {
                    joint: drive.joint.map(|joint| clip.joint_name(joint)),
                    why: &drive.why,
                });
            }
        }
    }
    drivers
}

/// What happens to a part that no joint of a clip drives, and why.
pub fn undriven(clip: &FigureClip, drive: &PartDrive) -> String {
    if drive.part == clip.root {
        format!("no joint drives it: {}", drive.why)
    } else {
        format!("follows its parent: {}", drive.why)
    }
}

/// Sorted frames as text for people, who count from 1, runs abbreviated: `3-6, 9`. After `most` runs the rest is only counted.
pub fn frame_ranges(frames: &[u32], most: usize) -> String {
    let runs = frames.chunk_by(|a, b| a + 1 == *b);
    let mut texts: Vec<String> = Vec::new();
    let mut more = 0;
    for run in runs {
        match run {
            _ if texts.len() >= most => more += run.len(),
            [one] => texts.push((one + 1).to_string()),
            [first, .., last] => texts.push(format!("{}-{}", first + 1, last + 1)),
            [] => {}
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
    fn runs_are_abbreviated() {
        let frames = [2, 3, 4, 8, 10, 11];
        assert_eq!(frame_ranges(&frames, usize::MAX), "3-5, 9, 11-12");
        assert_eq!(frame_ranges(&frames, 1), "3-5, 3 more");
        assert_eq!(frame_ranges(&[], 1), "");
    }
}
