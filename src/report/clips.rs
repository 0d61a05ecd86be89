//! The clips of a drawing, for the preview's page.

use std::collections::BTreeMap;

use serde::Serialize;

use super::own_name;
use crate::compile::Compiled;
use crate::rig::Shot;

/// How many values of speed are told at most: more cannot be told apart on a screen.
const MOST_SPEEDS: usize = 4096;

/// A clip of a figure.
#[derive(Debug, Clone, Serialize)]
pub struct Clip<'a> {
    /// The animation's name.
    pub name: &'a str,
    /// The name of the figure's root part.
    pub figure: &'a str,
    /// The motion file, as the drawing names it.
    pub file: &'a str,
    /// How long it is.
    pub seconds: f64,
    /// Frames a second.
    pub fps: f64,
    /// How many frames are shown.
    pub frames: usize,
    /// How many poses are shown.
    pub drawings: usize,
    /// Whether it is limited animation.
    pub limited: bool,
    /// The drawings in order: the frame of the motion that is shown, and for how many frames it stands. Empty for full animation.
    pub exposure: Vec<[usize; 2]>,
    /// The frames of the motion that were omitted, in order.
    pub omitted: Vec<u32>,
    /// How many frames show the pose before instead of their own.
    pub held: usize,
    /// How fast each frame of the motion is, squares of the file's unit; of several frames the fastest.
    pub ssd: Vec<f64>,
    /// How many frames a value of `ssd` is for.
    pub ssd_step: usize,
    /// What drives each part.
    pub joints: BTreeMap<&'a str, Joint<'a>>,
    /// The parts that no joint drives.
    pub unmatched: Vec<&'a str>,
}

/// What drives a part.
#[derive(Debug, Clone, Serialize)]
pub struct Joint<'a> {
    /// The joint's name.
    pub joint: &'a str,
    /// Why.
    pub why: &'a str,
}

/// The clips of a drawing, in the order of the strings that ask for them.
pub fn clips(compiled: &Compiled) -> Vec<Clip<'_>> {
    compiled
        .shots
        .iter()
        .map(|shot| clip(compiled, shot))
        .collect()
}

fn clip<'a>(compiled: &'a Compiled, shot: &'a Shot) -> Clip<'a> {
    let name = |part: usize| own_name(compiled, &compiled.bindings.parts[part]);
    let mut joints = BTreeMap::new();
    let mut unmatched = Vec::new();
    for driven in &shot.parts {
        match driven.joint {
            Some(joint) => {
                let joint = Joint {
                    joint: &shot.skeleton.joints[joint].name,
                    why: &driven.why,
                };
                joints.insert(name(driven.part), joint);
            }
            None => unmatched.push(name(driven.part)),
        }
    }
    let step = shot.speeds.len().div_ceil(MOST_SPEEDS).max(1);
    let fastest = |speeds: &[f64]| speeds.iter().copied().fold(0.0, f64::max);
    let cut = shot.cut.as_deref();
    let mut omitted = cut.map_or_else(Vec::new, |cut| cut.omitted.clone());
    omitted.sort_unstable();
    let drawings = cut.into_iter().flat_map(|cut| cut.exposure.drawings());
    Clip {
        name: &shot.name,
        figure: name(shot.root),
        file: &shot.file,
        seconds: shot.seconds(),
        fps: 1.0 / shot.frame_time,
        frames: shot.frames(),
        drawings: shot.drawings(),
        limited: cut.is_some(),
        exposure: drawings
            .map(|drawing| [drawing.source as usize, drawing.length])
            .collect(),
        omitted,
        held: cut.map_or(0, |cut| cut.held.len()),
        ssd: shot.speeds.chunks(step).map(fastest).collect(),
        ssd_step: step,
        joints,
        unmatched,
    }
}
