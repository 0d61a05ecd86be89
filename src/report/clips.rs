//! The clips that figures play.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::compile::Compiled;
use crate::ide::PartId;
use crate::rig::{FigureClip, PartDrive, Performance};

/// The most speeds in a report: more cannot be told apart on a screen.
const MAX_SPEEDS: usize = 4096;

/// A clip of a figure. Frames are counted from 0.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Clip<'a> {
    /// The animation's name.
    pub name: &'a str,
    /// The name of the figure's root.
    pub figure: &'a str,
    /// The motion file, as the drawing names it; of motions that play in turn, that of the first one with joints.
    pub file: &'a str,
    /// The motions that play in turn, one or more.
    pub turns: Vec<Turn<'a>>,
    /// Its duration.
    pub seconds: f64,
    /// Frames per second.
    pub fps: f64,
    /// The number of frames that are shown.
    pub frames: usize,
    /// How many different poses are shown.
    pub drawings: usize,
    /// Whether it is limited animation.
    pub limited: bool,
    /// The drawings in order: the frame of the motion that is shown, and for how many frames. Empty for full animation.
    pub exposure: Vec<[usize; 2]>,
    /// The drawings that are chosen by hand, in order: the frame of the motion, and for how many frames it is to be shown.
    pub chosen: Vec<[usize; 2]>,
    /// The frames of the motion that were omitted, in order.
    pub omitted: Vec<u32>,
    /// The shown frames that are covered by holding the pose before, in order.
    pub held: Vec<u32>,
    /// The speed of the motion, squares of the file's unit; each value is the highest of `ssd_step` frames.
    pub ssd: Vec<f64>,
    /// The number of frames of a value of `ssd`.
    pub ssd_step: usize,
    /// The joint that drives each part, for the parts that one drives.
    pub joints: BTreeMap<&'a str, &'a str>,
    /// Why that joint, for the same parts.
    pub joint_reasons: BTreeMap<&'a str, &'a str>,
    /// The parts that no joint drives.
    pub unmatched: Vec<&'a str>,
    /// The performance that it follows and what that does; `None` for a clip without one.
    pub performance: Option<Performance<'a>>,
}

/// One of the motions that play in turn in a clip.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Turn<'a> {
    /// The motion file, or the word for one that comes along.
    pub file: &'a str,
    /// The frame of the motion with which it begins.
    pub first: usize,
    /// How long it plays.
    pub seconds: f64,
    /// How often it is repeated in that time.
    pub cycles: usize,
}

/// The clips of a drawing, in the order of the strings that request them.
pub(crate) fn clips(compiled: &Compiled) -> Vec<Clip<'_>> {
    let clips = compiled.clips.iter();
    clips.map(|clip| report(compiled, clip)).collect()
}

fn report<'a>(compiled: &'a Compiled, clip: &'a FigureClip) -> Clip<'a> {
    let name = |part: PartId| compiled.bindings.parts[part].name.as_str();
    let (driven, unmatched): (Vec<_>, Vec<_>) =
        clip.parts.iter().partition(|drive| drive.joint.is_some());
    let joint = |drive: &&PartDrive| Some((name(drive.part), clip.joint_name(drive.joint?)));
    let reason = |drive: &&'a PartDrive| (name(drive.part), drive.why.as_str());
    let (omitted, held) = clip.cut_frames();
    let drawings = clip.cut.iter().flat_map(|cut| cut.exposure.drawings());
    let turns = clip.turns.iter().map(|turn| Turn {
        file: &turn.file,
        first: turn.first,
        seconds: turn.steps as f64 * clip.frame_time(),
        cycles: turn.cycles,
    });
    let speeds = clip.speeds();
    let step = speeds.len().div_ceil(MAX_SPEEDS).max(1);
    let fastest = |speeds: &[f64]| speeds.iter().copied().fold(0.0, f64::max);
    Clip {
        name: &clip.name,
        figure: name(clip.root),
        file: &clip.file,
        turns: turns.collect(),
        seconds: clip.seconds(),
        fps: 1.0 / clip.frame_time(),
        frames: clip.frames(),
        drawings: clip.drawings(),
        limited: clip.cut.is_some(),
        exposure: drawings
            .map(|drawing| [drawing.source as usize, drawing.length])
            .collect(),
        chosen: clip
            .chosen
            .iter()
            .map(|chosen| [chosen.source as usize, chosen.frames])
            .collect(),
        omitted,
        held,
        ssd: speeds.chunks(step).map(fastest).collect(),
        ssd_step: step,
        joints: driven.iter().filter_map(joint).collect(),
        joint_reasons: driven.iter().map(reason).collect(),
        unmatched: unmatched.iter().map(|drive| name(drive.part)).collect(),
        performance: clip.performance(&compiled.bindings),
    }
}
