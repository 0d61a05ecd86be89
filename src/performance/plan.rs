//! What a performance does to a motion: its timing, and what it emphasises (Manya & Matsuda, section 3.3).

use glam::DVec3;

use super::emphasis::ratio;
use super::information::{Information, share_towards};
use crate::mocap::resample::TimeMap;

/// A joint that moves less than this share of the largest movement is not the one that the motion is about.
const NEARLY_LARGEST: f64 = 0.9;
/// A movement that goes towards the viewer by more than this share hardly moves a mark when it is imitated.
const TOWARDS: f64 = 0.85;

/// How a camera is to show a performance.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Filming {
    /// By a camera of its own, which follows the emphasised joint.
    #[default]
    Camera,
    /// By moving the character in front of a camera that stands still, as in the paper.
    Character,
    /// Not at all.
    None,
}

/// Which effects a performance has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Effects {
    /// Whether the motion gets the performance's timing.
    pub timing: bool,
    /// Whether what is not emphasised is damped.
    pub emphasis: bool,
    /// How it is filmed.
    pub filming: Filming,
}

impl Default for Effects {
    fn default() -> Self {
        Self {
            timing: true,
            emphasis: true,
            filming: Filming::Camera,
        }
    }
}

/// What a person asks of a performance, instead of what follows from the movements.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub(crate) struct Request {
    /// Its effects.
    pub effects: Effects,
    /// The channel that is emphasised.
    pub emphasized: Option<usize>,
    /// The key frames of input and motion, counted from 1.
    pub keys: Option<[usize; 2]>,
}

/// Something that a person should know about a performance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Finding {
    /// No mark moves: the performance has no timing and no emphasis.
    NoInput,
    /// No characteristic joint of the motion moves: the performance has no timing.
    NoMotion,
    /// A second movement of a mark is nearly as large as the largest; its frame, counted from 0.
    SecondInput(usize),
    /// A second movement of a joint is nearly as large as the largest; its frame, counted from 0.
    SecondMotion(usize),
    /// The motion's key joint is not the one whose mark moves most: its channel.
    OtherJoint(usize),
    /// The motion's key joint moves towards the viewer, which hardly moves a mark in the picture. This is its channel.
    TowardsViewer(usize),
    /// A key that a person gives lies beyond the end: the key, counted from 1, and the number of frames. It is not used.
    NoSuchInputKey(usize, usize),
    /// The same for the motion.
    NoSuchMotionKey(usize, usize),
}

/// What a performance does to a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// How much the marks move, at the motion's frame rate.
    pub input: Information,
    /// How much the joints of the motion move, before it is retimed.
    pub motion: Information,
    /// The frames of the largest input and of the largest motion, counted from 0.
    pub keys: Option<[usize; 2]>,
    /// The times along which the motion is played; `None` if it keeps its timing.
    pub timing: Option<TimeMap>,
    /// The channel that is emphasised; `None` if nothing moves.
    pub emphasized: Option<usize>,
    /// Whether the other channels are damped.
    pub is_damping: bool,
    /// How it is filmed.
    pub filming: Filming,
    /// What to tell.
    pub findings: Vec<Finding>,
}

impl Plan {
    /// The largest input of each channel: what equation 1 takes its ratios from.
    pub fn largest_inputs(&self) -> Vec<f64> {
        let channels = 0..self.input.curves.len();
        channels
            .map(|channel| self.input.largest_of(channel))
            .collect()
    }

    /// The ratio R of equation 1 of a channel: its largest input over that of the emphasised one, 0 to 1. All are 0 if nothing moves.
    pub fn ratio(&self, channel: usize) -> f64 {
        let most = self
            .emphasized
            .map(|channel| self.input.largest_of(channel));
        let most = most.filter(|most| *most > 0.0);
        most.map_or(0.0, |most| ratio(self.input.largest_of(channel), most))
    }

    /// The points through which the timing goes: frames of the result with the frames of the motion that they show; none if the motion
    /// keeps its timing.
    pub fn timing_points(&self) -> Vec<[usize; 2]> {
        let keys = self.keys.filter(|_| self.timing.is_some());
        let lengths = [self.input.frames(), self.motion.frames()];
        keys.map_or_else(Vec::new, |keys| points(keys, lengths))
    }

    /// The frame of the result in which the motion's key pose stands, which limited animation must not lose.
    pub fn key_frame(&self) -> Option<usize> {
        let [input, motion] = self.keys?;
        Some(if self.timing.is_some() { input } else { motion })
    }

    /// The number of frames of the result, for a motion of so many.
    pub fn frames(&self, motion: usize) -> usize {
        self.timing.as_ref().map_or(motion, TimeMap::frames)
    }
}

/// Plans a performance. `input` holds the movements of marks, `steps` those of the joints of the same channels, at the same frame rate;
/// `viewer` is the direction from the motion to the viewer, a unit vector.
pub(crate) fn plan(
    input: Vec<Vec<f64>>,
    steps: &[Vec<DVec3>],
    viewer: DVec3,
    request: &Request,
) -> Plan {
    let length = |steps: &Vec<DVec3>| steps.iter().map(|step| step.length()).collect();
    let motion = steps.iter().map(length).collect();
    let (input, motion) = (Information::new(input), Information::new(motion));
    let lengths = [input.frames(), motion.frames()];
    let mut findings = Vec::new();
    let emphasized = request.emphasized.or(input.key.map(|key| key.channel));
    match input.key {
        None => findings.push(Finding::NoInput),
        // Whoever gives the keys knows which action counts.
        Some(_) if request.keys.is_some() => {}
        Some(_) => findings.extend(input.second.map(Finding::SecondInput)),
    }
    match motion.key {
        None => findings.push(Finding::NoMotion),
        Some(_) if request.keys.is_some() => {}
        Some(_) => findings.extend(motion.second.map(Finding::SecondMotion)),
    }
    if let (Some(emphasized), Some(key)) = (emphasized, motion.key)
        && request.emphasized.is_none()
        && motion.largest_of(emphasized) < NEARLY_LARGEST
    {
        findings.push(Finding::OtherJoint(key.channel));
    }
    if let Some(key) = motion.key
        && share_towards(&steps[key.channel], key.frame, viewer) > TOWARDS
    {
        findings.push(Finding::TowardsViewer(key.channel));
    }
    let given = request.keys.map(|keys| {
        let [input, motion] = [0, 1].map(|side| {
            let (key, frames) = (keys[side], lengths[side]);
            (1..=frames).contains(&key).then(|| key - 1)
        });
        if input.is_none() {
            findings.push(Finding::NoSuchInputKey(keys[0], lengths[0]));
        }
        if motion.is_none() {
            findings.push(Finding::NoSuchMotionKey(keys[1], lengths[1]));
        }
        [input, motion]
    });
    let [given_input, given_motion] = given.unwrap_or_default();
    // Whoever names the joint that counts means its movement, not that of another one.
    let peak = |information: &Information| match request.emphasized {
        Some(channel) => information.peak(channel),
        None => information.key.map(|key| key.frame),
    };
    let keys = (given_input.or_else(|| peak(&input)))
        .zip(given_motion.or_else(|| peak(&motion)))
        .map(|(input, motion)| [input, motion]);
    let timing = keys.filter(|_| request.effects.timing && input.key.is_some());
    Plan {
        timing: timing.map(|keys| TimeMap::through(&points(keys, lengths))),
        is_damping: request.effects.emphasis && input.key.is_some() && input.curves.len() > 1,
        filming: request.effects.filming,
        input,
        motion,
        keys,
        emphasized,
        findings,
    }
}

/// The first frames, the keys and the last frames. A key in the last frame of either is held to the end.
fn points([input, motion]: [usize; 2], [inputs, motions]: [usize; 2]) -> Vec<[usize; 2]> {
    let mut points = vec![[input, motion]];
    if input > 0 {
        points.insert(0, [0, 0]);
    }
    if input + 1 < inputs {
        points.push([inputs - 1, motions - 1]);
    }
    points
}
