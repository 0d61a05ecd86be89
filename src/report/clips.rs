//! The clips that figures play: `inspect --json` (frontends.md) and the preview's page.

use std::collections::BTreeMap;

use serde::Serialize;

use super::own_name;
use super::performances::{Performance, performance};
use crate::compile::Compiled;
use crate::rig::FigureClip;

/// The most speeds in a report: more cannot be told apart on a screen.
const MAX_SPEEDS: usize = 4096;

/// The reader of a report. Both get the same facts under the same keys, in different detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reader {
    /// A user of `inspect --json`: frames are counted from 1.
    Inspect,
    /// The preview's page: frames are counted from 0, and it draws charts.
    Page,
}

/// A clip of a figure.
#[derive(Debug, Clone, Serialize)]
pub struct Clip<'a> {
    /// The animation's name.
    pub name: &'a str,
    /// The name of the figure's root.
    pub figure: &'a str,
    /// The motion file, as the drawing names it.
    pub file: &'a str,
    /// Its duration.
    pub seconds: f64,
    /// The number of frames that are shown.
    pub frames: usize,
    /// How many different poses are shown.
    pub drawings: usize,
    /// The frames of the motion that were omitted, in order.
    pub omitted: Vec<u32>,
    /// The frames that are covered by holding the pose before.
    pub held: Held,
    /// The joint that drives each part, if one does.
    pub joints: BTreeMap<&'a str, Joint<'a>>,
    /// What the performance does that it follows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub performance: Option<Performance<'a>>,
    /// What only the page shows.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub page: Option<PageDetails<'a>>,
}

/// The held frames of a clip.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum Held {
    /// Their numbers, in order.
    Frames(Vec<u32>),
    /// How many there are.
    Count(usize),
}

/// The joint that drives a part.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum Joint<'a> {
    /// Its name.
    Name(&'a str),
    /// Its name, and the reason.
    Reason {
        /// The joint's name.
        joint: &'a str,
        /// Why it drives the part.
        why: &'a str,
    },
}

/// What the page's player and charts need of a clip.
#[derive(Debug, Clone, Serialize)]
pub struct PageDetails<'a> {
    /// Frames per second.
    pub fps: f64,
    /// Whether it is limited animation.
    pub limited: bool,
    /// The drawings in order: the frame of the motion that is shown, and for how many frames. Empty for full animation.
    pub exposure: Vec<[usize; 2]>,
    /// The speed of the motion, squares of the file's unit; each value is the highest of `ssd_step` frames.
    pub ssd: Vec<f64>,
    /// The number of frames of a value of `ssd`.
    pub ssd_step: usize,
    /// The parts that no joint drives.
    pub unmatched: Vec<&'a str>,
}

/// The clips of a drawing, in the order of the strings that request them.
pub fn clips(compiled: &Compiled, reader: Reader) -> Vec<Clip<'_>> {
    let clips = compiled.clips.iter();
    clips.map(|clip| report(compiled, clip, reader)).collect()
}

fn report<'a>(compiled: &'a Compiled, clip: &'a FigureClip, reader: Reader) -> Clip<'a> {
    let name = |part: usize| own_name(compiled, &compiled.bindings.parts[part]);
    let joints = clip.parts.iter().filter_map(|drive| {
        let joint = clip.joint_name(drive.joint?);
        let why = &drive.why;
        let joint = match reader {
            Reader::Inspect => Joint::Name(joint),
            Reader::Page => Joint::Reason { joint, why },
        };
        Some((name(drive.part), joint))
    });
    let (mut omitted, held) = cut_frames(clip);
    let held = match reader {
        Reader::Inspect => Held::Frames(held),
        Reader::Page => Held::Count(held.len()),
    };
    let page = (reader == Reader::Page).then(|| {
        omitted.iter_mut().for_each(|frame| *frame -= 1);
        let unmatched = clip.parts.iter().filter(|drive| drive.joint.is_none());
        let drawings = clip.cut.iter().flat_map(|cut| cut.exposure.drawings());
        let speeds = clip.speeds();
        let step = speeds.len().div_ceil(MAX_SPEEDS).max(1);
        let fastest = |speeds: &[f64]| speeds.iter().copied().fold(0.0, f64::max);
        PageDetails {
            fps: 1.0 / clip.frame_time(),
            limited: clip.cut.is_some(),
            exposure: drawings
                .map(|drawing| [drawing.source as usize, drawing.length])
                .collect(),
            ssd: speeds.chunks(step).map(fastest).collect(),
            ssd_step: step,
            unmatched: unmatched.map(|drive| name(drive.part)).collect(),
        }
    });
    Clip {
        name: &clip.name,
        figure: name(clip.root),
        file: &clip.file,
        seconds: clip.seconds(),
        frames: clip.frames(),
        drawings: clip.drawings(),
        omitted,
        held,
        joints: joints.collect(),
        performance: performance(compiled, clip, reader),
        page,
    }
}

/// The frames of a clip that were omitted, and those that are covered by holding the pose before: counted from 1, in order.
pub fn cut_frames(clip: &FigureClip) -> (Vec<u32>, Vec<u32>) {
    let Some(cut) = &clip.cut else {
        return (Vec::new(), Vec::new());
    };
    let mut omitted: Vec<u32> = cut.omitted.iter().map(|frame| frame + 1).collect();
    let mut held: Vec<u32> = cut.held.iter().map(|hold| hold.covered + 1).collect();
    omitted.sort_unstable();
    held.sort_unstable();
    (omitted, held)
}
