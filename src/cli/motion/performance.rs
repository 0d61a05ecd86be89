//! `okoshi motion --perform`: which joint each mark performs, and what was done to the motion.

use std::fmt::Write as _;

use crate::cli::args::{self, Performing};
use crate::cli::{Outcome, fail};
use crate::diagnostic::nearest_word;
use crate::disk::read_file;
use crate::mark_tracks::{MarkTracks, same_name};
use crate::mocap::Skeleton;
use crate::motion::edit::Film;
use crate::motion::{JointChannel, PerformedClip, perform as perform_clip};
use crate::performance::{Effects, Filming, Finding, Plan, Request};
use crate::prepare::PreparedClip;
use crate::retarget::joints_named;

/// A motion that was performed, or left as it is.
pub(super) struct Performed {
    pub(super) prepared: PreparedClip,
    /// The frame of the motion's key pose.
    pub(super) key_frame: Option<usize>,
    pub(super) film: Option<Film>,
    pub(super) messages: String,
}

/// Performs a motion as the arguments say. Failures are reported.
pub(super) fn perform(
    arguments: &Performing,
    prepared: PreparedClip,
) -> Result<Performed, Outcome> {
    let Some(path) = &arguments.perform else {
        return Ok(Performed {
            prepared,
            key_frame: None,
            film: None,
            messages: String::new(),
        });
    };
    let name = path.display().to_string();
    let refused = |message: &str, help: &str| {
        let outcome = fail(message);
        eprintln!("  help: {help}");
        outcome
    };
    let bytes = read_file(path).map_err(fail)?;
    let tracks = MarkTracks::from_bytes(&bytes)
        .map_err(|error| refused(&format!("`{name}`: {error}"), &error.help))?;
    let channels = channels(arguments, &tracks, &prepared.clip.skeleton)
        .map_err(|[message, help]| refused(&format!("`{name}`: {message}"), &help))?;
    let emphasized = match &arguments.emphasize {
        Some(wanted) => {
            let is_it =
                |channel: &JointChannel| same_name(&tracks.marks[channel.mark].name, wanted);
            let found = channels.iter().position(is_it);
            Some(found.ok_or_else(|| {
                let message = format!("--emphasize {wanted}: no joint has this mark");
                refused(&message, &format!("write --mark {wanted}=JOINT for it"))
            })?)
        }
        None => None,
    };
    let request = Request {
        effects: Effects {
            timing: !arguments.no_timing,
            emphasis: !arguments.no_emphasis,
            filming: match arguments.filming {
                args::Filming::Camera => Filming::Camera,
                args::Filming::Root => Filming::Character,
                args::Filming::None => Filming::None,
            },
        },
        emphasized,
        keys: arguments.keys,
    };
    let PerformedClip { prepared, plan } = perform_clip(prepared, &tracks, &channels, &request);
    let joint = |channel: usize| {
        prepared.clip.skeleton.joints[channels[channel].joint]
            .name
            .as_str()
    };
    let mark = |channel: usize| tracks.marks[channels[channel].mark].name.as_str();
    let messages = describe(&plan, joint, mark);
    let film = plan.emphasized.map(|channel| Film {
        filming: plan.filming,
        joint: channels[channel].joint,
    });
    Ok(Performed {
        key_frame: plan.key_frame(),
        film,
        messages,
        prepared,
    })
}

/// The joints that marks perform; else a message, and what to do.
fn channels(
    arguments: &Performing,
    tracks: &MarkTracks,
    skeleton: &Skeleton,
) -> Result<Vec<JointChannel>, [String; 2]> {
    let names: Vec<&str> = tracks.marks.iter().map(|mark| mark.name.as_str()).collect();
    if arguments.marks.is_empty() {
        let help = match names.as_slice() {
            [] => "track the clip again, with --mark red for a red mark".to_owned(),
            names => format!(
                "write --mark {}=RightHand, and likewise for each of its marks: {}",
                names[0],
                names.join(", ")
            ),
        };
        return Err(["no mark performs a joint".to_owned(), help]);
    }
    let joint = |name: &str| {
        joints_named(skeleton, name)
            .first()
            .copied()
            .ok_or_else(|| {
                let joints = skeleton.joints.iter().map(|joint| joint.name.as_str());
                let help = match nearest_word(name, joints) {
                    Some(nearest) => format!("did you mean `{nearest}`?"),
                    None => "okoshi motion IN.bvh lists the joints".to_owned(),
                };
                [format!("the motion has no joint `{name}`"), help]
            })
    };
    let mut channels: Vec<JointChannel> = Vec::new();
    for marked in &arguments.marks {
        let mark = tracks.mark_named(&marked.mark).ok_or_else(|| {
            [
                format!("the track has no mark `{}`", marked.mark),
                format!("its marks are {}", names.join(", ")),
            ]
        })?;
        if channels.iter().any(|channel| channel.mark == mark) {
            return Err([
                format!("--mark {}: this mark performs a joint already", marked.mark),
                "write joints that are edited along with it behind a comma: red=RightHand,RightShoulder"
                    .to_owned(),
            ]);
        }
        let joints = marked.joints.iter().map(|name| joint(name));
        let mut joints: Vec<_> = joints.collect::<Result<_, _>>()?;
        channels.push(JointChannel {
            mark,
            joint: joints.remove(0),
            followers: joints,
        });
    }
    Ok(channels)
}

/// What a performance does, for people to read. Frames count from 1.
fn describe<'a>(
    plan: &Plan,
    joint: impl Fn(usize) -> &'a str,
    mark: impl Fn(usize) -> &'a str,
) -> String {
    let mut out = String::new();
    if let Some(emphasized) = plan.emphasized {
        let _ = writeln!(
            out,
            "  performed: `{}` moves most, so {} is emphasised",
            mark(emphasized),
            joint(emphasized)
        );
        if plan.is_damping {
            for channel in 0..plan.input.curves.len() {
                if channel != emphasized {
                    let percent = 100.0 * plan.ratio(channel);
                    let _ = writeln!(
                        out,
                        "  {} keeps {percent:.0} % of its turns (`{}`)",
                        joint(channel),
                        mark(channel)
                    );
                }
            }
        }
    }
    if let (Some([input, motion]), Some(timing)) = (plan.keys, &plan.timing) {
        let _ = writeln!(
            out,
            "  frame {} of the motion stands in frame {} of {}",
            motion + 1,
            input + 1,
            timing.frames()
        );
    }
    for finding in &plan.findings {
        let text = match finding {
            Finding::NoInput => {
                "no mark of the track moves: the motion keeps its timing, and no joint is emphasised".to_owned()
            }
            Finding::NoMotion => {
                "none of these joints moves: the motion keeps its timing".to_owned()
            }
            Finding::SecondInput(frame) => format!(
                "the track has a second movement that is nearly as large, in frame {}: cut it to one action, or give --keys",
                frame + 1
            ),
            Finding::SecondMotion(frame) => format!(
                "the motion has a second movement that is nearly as large, in frame {}: cut it to one action with --range, or give --keys",
                frame + 1
            ),
            Finding::OtherJoint(channel) => format!(
                "in the motion it is {} that moves most: --emphasize {} would emphasise it",
                joint(*channel),
                mark(*channel)
            ),
            Finding::TowardsViewer(channel) => format!(
                "{} moves towards the viewer, which moves a mark little: film such a motion from the side",
                joint(*channel)
            ),
            Finding::NoSuchInputKey(key, frames) => format!(
                "the track has no frame {key}, only {frames} at this rate: the frame of its largest movement is used"
            ),
            Finding::NoSuchMotionKey(key, frames) => format!(
                "the motion has no frame {key}, only {frames}: the frame of its largest movement is used"
            ),
        };
        let _ = writeln!(out, "  warning: {text}");
    }
    out
}
