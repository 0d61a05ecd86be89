//! What a performance does to a clip.

use serde::Serialize;

use super::{FigureClip, Performed};
use crate::bind::{Bindings, PartId};
use crate::performance::{Filming, Information};

/// The most values of a curve in a report: more cannot be told apart on a screen.
const MAX_VALUES: usize = 4096;
/// Curves are rounded to so many parts of the largest movement.
const PARTS: f64 = 1e4;

/// The performance of a clip. Frames are counted from 0.
#[derive(Debug, Clone, Serialize)]
pub struct Performance<'a> {
    /// The file of the track, as the drawing names it.
    pub track: &'a str,
    /// The marks that perform parts of the figure.
    pub marks: Vec<PerformedMark<'a>>,
    /// The frames of the largest movements.
    pub keys: Option<Frames>,
    /// The shown frame in which the key pose stands: limited animation leaves it there.
    pub shown: Option<usize>,
    /// Whether the motion has the timing of the performance: its key frame then stands in that of the performance.
    pub timed: bool,
    /// How many frames there are.
    pub lengths: Frames,
    /// How it is filmed: `camera`, `root` or `none`.
    pub filming: &'static str,
    /// The shown frame in which the camera, or the figure, is nearest.
    pub nearest: Option<usize>,
    /// The points through which the timing goes: frames of the performance with the frames of the motion that they show.
    pub timing: Vec<[usize; 2]>,
    /// Per mark how much it moves, as a ratio of the largest movement; each value is the highest of `input_step` frames.
    pub input_curves: Vec<Vec<f64>>,
    /// The number of frames of a value of `input_curves`.
    pub input_step: usize,
    /// The same of the joints of the motion that the marks perform.
    pub motion_curves: Vec<Vec<f64>>,
    /// The number of frames of a value of `motion_curves`.
    pub motion_step: usize,
}

/// A frame of the performance and one of the motion, or how many frames they have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Frames {
    /// In the performance, at the frame rate of the motion.
    pub performed: usize,
    /// In the motion, before it is retimed.
    pub motion: usize,
}

/// A mark that performs parts of the figure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PerformedMark<'a> {
    /// Its name in the track.
    pub name: &'a str,
    /// Its colour, `#rrggbb`.
    pub color: String,
    /// The names of the parts.
    pub performs: Vec<&'a str>,
    /// The ratio R of equation 1: its largest movement over that of the emphasised mark, 0 to 1.
    pub ratio: f64,
    /// Whether it is the emphasised one.
    pub emphasized: bool,
    /// Whether the parts turn less than in the motion: by the ratio.
    pub damped: bool,
}

impl FigureClip {
    /// What the performance does to it; `None` for a clip without one.
    pub fn performance<'a>(&'a self, bindings: &'a Bindings) -> Option<Performance<'a>> {
        let performed = self.performed.as_ref()?;
        let plan = &performed.plan;
        let channels = 0..performed.channels.len();
        let (input_curves, input_step) = thinned(&plan.input);
        let (motion_curves, motion_step) = thinned(&plan.motion);
        Some(Performance {
            track: &performed.file,
            marks: channels
                .map(|channel| performed.mark(bindings, channel))
                .collect(),
            keys: plan
                .keys
                .map(|[performed, motion]| Frames { performed, motion }),
            shown: plan.key_frame(),
            timed: plan.timing.is_some(),
            lengths: Frames {
                performed: plan.input.frames(),
                motion: plan.motion.frames(),
            },
            filming: match plan.filming {
                Filming::Camera => "camera",
                Filming::Character => "root",
                Filming::None => "none",
            },
            nearest: self.filmed.nearest(),
            timing: plan.timing_points(),
            input_curves,
            input_step,
            motion_curves,
            motion_step,
        })
    }
}

impl Performed {
    /// What a mark of the performance does; its channel must exist.
    pub fn mark<'a>(&'a self, bindings: &'a Bindings, channel: usize) -> PerformedMark<'a> {
        let plan = &self.plan;
        let parts = &self.channels[channel];
        let track = &self.tracks.marks[parts.mark];
        let [red, green, blue] = track.color;
        let emphasized = plan.emphasized == Some(channel);
        let ratio = plan.ratio(channel);
        let name = |part: &PartId| bindings.parts[*part].name.as_str();
        PerformedMark {
            name: &track.name,
            color: format!("#{red:02x}{green:02x}{blue:02x}"),
            performs: parts.parts.iter().map(name).collect(),
            ratio,
            emphasized,
            damped: plan.is_damping && !emphasized && ratio < 1.0,
        }
    }
}

impl PerformedMark<'_> {
    /// What it does to its parts, in words.
    pub fn effect(&self) -> String {
        let ratio = format!("R = {:.2}", self.ratio);
        match (self.emphasized, self.damped) {
            (true, _) => format!("{ratio}, emphasised"),
            (false, true) => format!("{ratio}, damped"),
            (false, false) => format!("{ratio}, not damped"),
        }
    }
}

impl Performance<'_> {
    /// What it does to the timing, in words, for people, who count frames from 1.
    pub fn timing(&self) -> String {
        let Some(keys) = self.keys.filter(|_| self.timed) else {
            return "the motion keeps its timing".to_owned();
        };
        format!(
            "frame {} of the motion stands in frame {} of {}",
            keys.motion + 1,
            keys.performed + 1,
            self.lengths.performed
        )
    }

    /// How it is filmed, in words; likewise.
    pub fn filmed(&self) -> String {
        let nearest = self.nearest.map(|nearest| nearest + 1);
        match (self.filming, nearest) {
            ("camera", Some(nearest)) => {
                format!("filmed by a camera that is nearest in frame {nearest}")
            }
            ("root", Some(nearest)) => {
                format!(
                    "filmed by moving the figure, which is nearest to the viewer in frame {nearest}"
                )
            }
            _ => "not filmed".to_owned(),
        }
    }
}

/// The curves with so few values that all can be drawn, and the number of frames of a value.
fn thinned(information: &Information) -> (Vec<Vec<f64>>, usize) {
    let step = information.frames().div_ceil(MAX_VALUES).max(1);
    let highest = |ratios: &[f64]| {
        let highest = ratios.iter().copied().fold(0.0, f64::max);
        (highest * PARTS).round() / PARTS
    };
    let curves = information.curves.iter();
    let thin = curves.map(|curve| curve.chunks(step).map(highest).collect());
    (thin.collect(), step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::resolver::MemoryResolver;

    /// The two clips of a case: both are performed, the second one is limited.
    #[test]
    fn clips_report_what_their_performance_does() {
        let drawing = include_str!("../../tests/cases/perform-plays/drawing.svg");
        let track = include_str!("../../tests/cases/perform-plays/hands.json");
        let files = MemoryResolver::default().with("hands.json", track.as_bytes());
        let compiled = compile(drawing, &Options::default(), &files);
        let clips = [0, 1].map(|clip| &compiled.clips[clip]);
        let [clip, limited] = clips.map(|clip| clip.performance(&compiled.bindings).unwrap());
        assert_eq!(clip.track, "hands.json");
        let keys = clip.keys.unwrap();
        assert_eq!((keys.performed, keys.motion), (36, 25));
        assert_eq!((clip.lengths.performed, clip.lengths.motion), (49, 49));
        assert_eq!(clip.timing, [[0, 0], [36, 25], [48, 48]]);
        assert_eq!((clip.timed, clip.filming), (true, "camera"));
        let [red, green] = &clip.marks[..] else {
            panic!("two marks");
        };
        assert_eq!((red.name, &*red.color), ("red", "#d03020"));
        assert_eq!((red.ratio, red.emphasized, red.damped), (1.0, true, false));
        assert_eq!((&green.performs[..], green.damped), (&["Larm"][..], true));
        for curves in [&clip.input_curves, &clip.motion_curves] {
            assert_eq!((curves.len(), curves[0].len()), (2, 49));
        }
        assert_eq!(
            (clip.input_curves[0][36], clip.motion_curves[0][25]),
            (1.0, 1.0)
        );
        // The limited clip follows the same performance, and its frames are those that are shown.
        assert_eq!(limited.marks, clip.marks);
        assert!(
            clip.timing()
                .starts_with("frame 26 of the motion stands in frame 37 of 49")
        );
        let nearest = clip.nearest.unwrap() + 1;
        assert_eq!(
            clip.filmed(),
            format!("filmed by a camera that is nearest in frame {nearest}")
        );
    }

    #[test]
    fn thinned_curves_keep_their_peaks() {
        let mut long = vec![0.25; 3 * MAX_VALUES];
        long[1000] = 8.0;
        let short = vec![0.0, 1.0];
        let (curves, step) = thinned(&Information::new(vec![long, short]));
        assert_eq!((step, curves[0].len(), curves[1].len()), (3, MAX_VALUES, 1));
        assert_eq!(curves[0][1000 / 3], 1.0);
        assert_eq!(curves[0][0], 0.0313);
        assert_eq!(thinned(&Information::default()), (Vec::new(), 1));
    }
}
