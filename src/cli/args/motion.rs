//! The arguments of `okoshi motion`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::clips::Legs;
use crate::export::extensions;
use crate::lang::keyword::MOTION_SPEED;
use crate::lang::keyword::signature::Bounds;
use crate::limited::Camera;
use crate::mocap::UpAxis;
use crate::mocap::resample::{Range, parse_range};
use crate::motion::PointChoice;

const MOTION_EXAMPLES: &str = "\
Examples:
  okoshi motion kick.bvh                          lists its joints and what they are recognised as
  okoshi motion kick.bvh -o snappy.bvh            limited animation: 4 drawings omitted, a third of the frames held
  okoshi motion kick.bvh -o snappy.bvh --omit 6 --hold 40
  okoshi motion kick.bvh -o kick.svg              a chart of its speed and of the omitted and held frames
  okoshi motion kick.bvh -o kick.glb              a model of its skeleton that plays it
  okoshi motion kick.bvh -o shot.bvh --drawings 14   the 14 drawings that fit it best
  okoshi motion kick.bvh -o twos.bvh --every 2    on twos
  okoshi motion take.bvh -o part.bvh --full --range 25:72 --fps 30
  okoshi motion take.bvh -o slow.bvh --full --from 1.2 --to 2.4 --speed .5
  okoshi motion walk 2 wave 1 idle 1 -o greeting.bvh   clips that come along, in turn
  okoshi motion hook.bvh -o performed.glb --perform hands.json --mark red=RightHand --mark green=LeftHand
                                                  as a puppet's marks tell it: timing, emphasis, a camera

Motions are BVH files, the common format for motion capture. A T-pose at the beginning is removed, the motion is resampled
to 24 frames a second, and then reduced. Frames count from 1, those of `--range` as in the file. A drawing links to a motion with `Motion \"kick.bvh\"`.";

#[derive(Debug, Args)]
#[command(after_help = MOTION_EXAMPLES)]
pub(in crate::cli) struct Motion {
    /// The motion, a BVH file (`-` is stdin), or a clip that comes along: walk, run, trot, sneak, jump, idle, wave, dance, punch
    #[arg(value_name = "IN.bvh|WORD")]
    pub(in crate::cli) motion: PathBuf,
    /// For how many seconds a clip that comes along plays, and further ones that play in turn, each with its own: walk 2 wave 1
    #[arg(value_name = "SECONDS|WORD")]
    pub(in crate::cli) in_turn: Vec<String>,
    /// The legs of a clip that comes along
    #[arg(long, value_name = "N", default_value = "2", value_parser = legs)]
    pub(in crate::cli) legs: Legs,
    #[arg(short, long, value_name = "OUT", help = motion_output_help())]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Drawings to omit where the motion is fastest [default: 4]
    #[arg(long, value_name = "N")]
    pub(in crate::cli) omit: Option<usize>,
    /// Frames to hold where the motion is slowest [default: a third]
    #[arg(long, value_name = "N")]
    pub(in crate::cli) hold: Option<usize>,
    /// Shorten the motion by the omitted drawings
    #[arg(long)]
    pub(in crate::cli) shorten: bool,
    /// Shoot on twos or threes: one drawing for every N frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=24), conflicts_with_all = ["omit", "hold", "shorten"])]
    pub(in crate::cli) every: Option<u32>,
    /// Keep the N drawings that fit the motion best
    #[arg(long, value_name = "N", conflicts_with_all = ["omit", "hold", "shorten", "every"])]
    pub(in crate::cli) drawings: Option<usize>,
    /// Keep every frame
    #[arg(long, conflicts_with_all = ["omit", "hold", "shorten", "every", "drawings"])]
    pub(in crate::cli) full: bool,
    /// Compare with other methods: on twos, on threes, the best drawings
    #[arg(long)]
    pub(in crate::cli) compare: bool,
    /// Frames a second
    #[arg(long, value_name = "F", default_value_t = crate::mocap::resample::FPS)]
    pub(in crate::cli) fps: f64,
    /// Use only these frames of the file, counted from 1 and including both ends; `10:` and `:48` are open-ended
    #[arg(long, value_name = "A:B", value_parser = range)]
    pub(in crate::cli) range: Option<Range>,
    /// Begin here, in seconds of the file
    #[arg(long, value_name = "S", value_parser = seconds, conflicts_with = "range")]
    pub(in crate::cli) from: Option<f64>,
    /// End here, in seconds of the file
    #[arg(long, value_name = "S", value_parser = seconds, conflicts_with = "range")]
    pub(in crate::cli) to: Option<f64>,
    /// Play faster or slower: 2 is twice as fast, .5 half as fast
    #[arg(long, value_name = "FACTOR", value_parser = speed, default_value = "1", hide_default_value = true)]
    pub(in crate::cli) speed: f64,
    /// Keep the T-pose at the beginning
    #[arg(long)]
    pub(in crate::cli) keep_rest: bool,
    /// Where speed is measured: at the joints that are seen and the ends of head, hands and feet, or at all joints, as in the
    /// thesis
    #[arg(long, value_name = "POINTS", value_parser = points, default_value = "seen")]
    pub(in crate::cli) points: PointChoice,

    /// The axis of the motion that points up: +x, -x, +y, -y, +z or -z
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true)]
    pub(in crate::cli) up: Option<UpAxis>,

    /// Remove the travel over the ground
    #[arg(short, long)]
    pub(in crate::cli) in_place: bool,
    /// Make a loop of the best cycle of the motion
    #[arg(short = 'l', long = "loop")]
    pub(in crate::cli) is_loop: bool,
    /// Measure speed as seen by a camera: degrees to the body's left, degrees up and, for perspective, the distance
    /// in the file's unit
    #[arg(long, value_name = "YAW,PITCH[,DISTANCE]", value_parser = camera, allow_hyphen_values = true)]
    pub(in crate::cli) camera: Option<Camera>,
    /// Also write a chart of its speed, an SVG file
    #[arg(long, value_name = "FILE.svg", value_parser = plot)]
    pub(in crate::cli) plot: Option<PathBuf>,
    /// Continue with the frames before a damaged one
    #[arg(long)]
    pub(in crate::cli) keep_going: bool,
    #[command(flatten)]
    pub(in crate::cli) performing: Performing,
}

/// How a motion is performed.
#[derive(Debug, Args)]
#[command(next_help_heading = "Performance")]
pub(in crate::cli) struct Performing {
    /// Give the motion the timing and the emphasis of a performance: a track of colour marks, as `okoshi track` writes it
    #[arg(long, value_name = "TRACK", conflicts_with = "shorten")]
    pub(in crate::cli) perform: Option<PathBuf>,
    /// Which joint a mark of the track performs, and joints that are edited along with it; once for each mark
    #[arg(long = "mark", value_name = "NAME=JOINT[,JOINT...]", requires = "perform", value_parser = mark)]
    pub(in crate::cli) marks: Vec<MarkedJoint>,
    /// The mark whose joint is emphasised [default: the one that moves most]
    #[arg(long, value_name = "NAME", requires = "perform")]
    pub(in crate::cli) emphasize: Option<String>,
    /// The frames that belong together, counted from 1: that of the track, and that of the motion [default: where each moves
    /// most]
    #[arg(long, value_name = "TRACK:MOTION", requires = "perform", value_parser = keys)]
    pub(in crate::cli) keys: Option<[usize; 2]>,
    /// Keep the motion's own timing
    #[arg(long, requires = "perform")]
    pub(in crate::cli) no_timing: bool,
    /// Leave the joints that are not emphasised as they are
    #[arg(long, requires = "perform")]
    pub(in crate::cli) no_emphasis: bool,
    /// How it is filmed
    #[arg(
        long,
        value_name = "HOW",
        default_value = "camera",
        requires = "perform"
    )]
    pub(in crate::cli) filming: Filming,
}

/// How a performance is filmed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Filming {
    /// By a camera in the model that follows the emphasised joint
    Camera,
    /// By moving the character in front of a camera that stands still, as in the paper
    Root,
    /// Not at all
    None,
}

/// A mark, and the joints that it performs: the characteristic joint first.
#[derive(Debug, Clone)]
pub(in crate::cli) struct MarkedJoint {
    pub(in crate::cli) mark: String,
    pub(in crate::cli) joints: Vec<String>,
}

fn mark(text: &str) -> Result<MarkedJoint, String> {
    let split = text.split_once('=').filter(|(mark, joints)| {
        !mark.trim().is_empty() && joints.split(',').all(|joint| !joint.trim().is_empty())
    });
    let (mark, joints) = split.ok_or("expected a mark and a joint, for example `red=RightHand`")?;
    Ok(MarkedJoint {
        mark: mark.trim().to_owned(),
        joints: joints
            .split(',')
            .map(|joint| joint.trim().to_owned())
            .collect(),
    })
}

fn keys(text: &str) -> Result<[usize; 2], String> {
    let frame = |text: &str| text.trim().parse().ok().filter(|frame| *frame > 0);
    let split = text.split_once(':');
    let keys = split.and_then(|(track, motion)| Some([frame(track)?, frame(motion)?]));
    keys.ok_or_else(|| "expected two frames, counted from 1, for example `31:44`".to_owned())
}

fn legs(text: &str) -> Result<Legs, String> {
    let found = Legs::ALL
        .into_iter()
        .find(|legs| legs.count().to_string() == text);
    found.ok_or_else(|| "expected 2, 4 or 6".to_owned())
}

/// A number of seconds, 0 or more.
fn seconds(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    number
        .filter(|seconds: &f64| seconds.is_finite() && *seconds >= 0.0)
        .ok_or_else(|| "expected a number of seconds, for example `1.2`".to_owned())
}

/// How fast a motion is played, as strings may say it.
fn speed(text: &str) -> Result<f64, String> {
    let Bounds { min, max, .. } = MOTION_SPEED;
    let number = text.parse().ok();
    number
        .filter(|speed| (min..=max).contains(speed))
        .ok_or_else(|| format!("expected a number from {min} to {max}; 2 is twice as fast"))
}

fn range(text: &str) -> Result<Range, String> {
    parse_range(text).map_err(|error| error.to_string())
}

fn plot(text: &str) -> Result<PathBuf, String> {
    if text.to_lowercase().ends_with(".svg") {
        Ok(PathBuf::from(text))
    } else {
        Err("the name of the chart must end in .svg".to_owned())
    }
}

fn points(text: &str) -> Result<PointChoice, String> {
    match text {
        "seen" => Ok(PointChoice::Seen),
        "all" => Ok(PointChoice::All),
        _ => Err("expected `seen` or `all`".to_owned()),
    }
}

fn camera(text: &str) -> Result<Camera, String> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|number| number.trim().parse().ok())
        .collect();
    let finite = numbers.filter(|numbers| numbers.iter().all(|number: &f64| number.is_finite()));
    match finite.as_deref() {
        Some([yaw, pitch]) => Ok(Camera {
            yaw: *yaw,
            pitch: *pitch,
            distance: None,
        }),
        Some([yaw, pitch, distance]) if *distance > 0.0 => Ok(Camera {
            yaw: *yaw,
            pitch: *pitch,
            distance: Some(*distance),
        }),
        _ if text == "root" => {
            Err("to move the character instead of a camera, write `--filming root`".to_owned())
        }
        _ => Err(
            "expected two numbers, for example `30,15`, or three with the camera's distance"
                .to_owned(),
        ),
    }
}

fn motion_output_help() -> String {
    format!(
        "Where to write: a .bvh, {} or .svg file, `-` for BVH on stdout [default: nowhere, the joints are listed]",
        extensions(|exporter| exporter.is_animated())
    )
}
