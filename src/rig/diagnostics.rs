//! Diagnostics of motions on figures.

use std::collections::BTreeMap;

use crate::bind::{FollowedName, HeldRequest, PartId, PartMark, PerformanceRequest};
use crate::diagnostic::{Code, Diagnostic};
use crate::limited::{Conflict, Cut, MAX_OMITTED_RUN};
use crate::mark_tracks;
use crate::mocap::resample::Outside;
use crate::mocap::{JointId, Skeleton, bvh};
use crate::performance::Finding;
use crate::retarget::{Matching, Problem};
use crate::source::Span;

use super::figures::FigureGroup;
use super::keys::{Excess, SWING};
use super::{Context, MAX_MATCHES};

/// A file that cannot be read, or only its first `frames` complete frames.
pub(super) fn broken_file(link: &str, error: &bvh::Error, frames: usize, span: Span) -> Diagnostic {
    let message = format!(
        "the motion `{link}` cannot be read: line {}, column {}: {}",
        error.line, error.column, error.message
    );
    let help = match frames {
        0 => error.help.clone(),
        frames => format!(
            "{}; --keep-going uses the {frames} complete frames before the error",
            error.help
        ),
    };
    Diagnostic::new(Code::BrokenMotion, span, message).help(help)
}

/// A note about a file that was read nevertheless, or about frames that were left out.
pub(super) fn note(link: &str, note: &str, span: Span) -> Diagnostic {
    let message = format!("the motion `{link}`: {note}");
    Diagnostic::new(Code::MotionRepaired, span, message)
        .help("you need not change anything; `okoshi motion IN.bvh --full -o OUT.bvh` writes the motion as it was read")
}

/// A range that reaches beyond the end of a file; `timed` says whether a number of seconds asks for it.
pub(super) fn outside(link: &str, outside: Outside, timed: bool, span: Span) -> Diagnostic {
    let Outside { asked, seconds, .. } = outside;
    let (asked, seconds) = (rounded(asked), rounded(seconds));
    let message = if outside.is_beginning {
        format!(
            "the motion `{link}` is {seconds} seconds long, so nothing of it is left from {asked} on"
        )
    } else {
        format!("the motion `{link}` is {seconds} seconds long: it ends before {asked}")
    };
    let help = match (outside.is_beginning, timed) {
        (true, _) => format!("write a beginning before its end: a number below {seconds}"),
        (false, true) => "leave the number out, and it plays to its end; alone in a `Motion`, `-l` makes a loop of it, which plays for as long as you say".to_owned(),
        (false, false) => "leave `to` out, and it plays to its end".to_owned(),
    };
    Diagnostic::new(Code::OutsideMotion, span, message).help(help)
}

/// A number of seconds with at most two decimals.
fn rounded(seconds: f64) -> f64 {
    (seconds * 100.0).round() / 100.0
}

/// A drawing whose clips have too many keys.
pub(super) fn too_many_keys(excess: &Excess, span: Span) -> Diagnostic {
    let Excess { keys, most, swings } = excess;
    let counted = if *swings {
        format!(
            "frames times parts that move; a frame of one that swings counts {SWING} times more"
        )
    } else {
        "frames times parts that move".to_owned()
    };
    let message = format!(
        "the clips up to this one have {keys} keys ({counted}), and at most {most} are built"
    );
    let shorter = "use shorter motions: `from 0 to 20` behind a file plays its first 20 seconds";
    let help = if *swings {
        format!("{shorter}; or let fewer parts swing")
    } else {
        shorter.to_owned()
    };
    Diagnostic::new(Code::LimitPassed, span, message).help(help)
}

/// A drawing whose motions, each part of a file by itself, are too long together.
pub(super) fn too_many_numbers(numbers: usize, most: usize, span: Span) -> Diagnostic {
    let message = format!(
        "the motions before this one have {numbers} numbers together (frames times channels), and at most {most} are read"
    );
    let help = "play fewer parts of long files, or cut these parts out into files of their own: `okoshi motion IN.bvh -o OUT.bvh --range 1:240`";
    Diagnostic::new(Code::LimitPassed, span, message).help(help)
}

/// A drawing with too many combinations of figures and motions.
pub(super) fn too_many_matches(span: Span) -> Diagnostic {
    let message = format!("there are more than {MAX_MATCHES} pairs of a motion and a figure");
    let help =
        "write `Motion` in the strings of the figures that should move, instead of in a `%` string";
    Diagnostic::new(Code::LimitPassed, span, message).help(help)
}

/// A motion that no figure plays.
pub(super) fn idle_motion(span: Span, link: &str) -> Diagnostic {
    let message = format!("the motion `{link}` moves nothing: none of its joints drives a part");
    let help = "name parts after what they are (Head, Rarm, Lleg …), or say which joint drives a part: `Bone RightArm`";
    Diagnostic::new(Code::IdleMotion, span, message).help(help)
}

/// Parts that a clip takes off what they hang on: each with what that is, and by how much the gap grows, the worst first.
pub(super) fn comes_off(
    context: &Context<'_>,
    clip: &str,
    parts: &[(PartId, PartId, f64)],
) -> Option<Diagnostic> {
    let (part, parent, growth) = *parts.first()?;
    let bindings = context.bindings;
    let element = |part: PartId| {
        let shape = bindings.parts[part].shape;
        context.drawing.shapes[shape].element.span
    };
    let name = bindings.describe(context.drawing, part);
    let parent_name = bindings.describe(context.drawing, parent);
    let others = match parts.len() {
        1 => String::new(),
        2 => "; so does another part".to_owned(),
        count => format!("; so do {} other parts", count - 1),
    };
    let message = format!(
        "in the clip `{clip}`, {name} comes off {parent_name} by up to {:.0} % of the figure's height{others}",
        growth * 100.0
    );
    let help = "draw the two so that they overlap where the part turns, attach it to the part that it touches, or write `Origin` with the point about which it turns";
    Some(
        Diagnostic::new(Code::ComesOff, element(part), message)
            .related(element(parent), "what it hangs on")
            .help(help),
    )
}

/// Omissions and holds that were not possible, and too many omissions in a row.
pub(super) fn too_limited(cut: &Cut, frames: usize, span: Span, diagnostics: &mut Vec<Diagnostic>) {
    let mut report = |message: String, help: String| {
        let diagnostic = Diagnostic::new(Code::TooLimited, span, message).help(help);
        // All figures that play the clip have the same problem.
        if !diagnostics.contains(&diagnostic) {
            diagnostics.push(diagnostic);
        }
    };
    let (omit, hold) = (cut.omissions, cut.holds);
    // Numbers that look right in most motions, and are possible in all but the shortest.
    let [less, shorter] = [
        omit.asked.min(4).min(frames / 4),
        hold.asked.min(frames / 3),
    ];
    if omit.shortfall() > 0 {
        report(
            format!(
                "only {} of {} drawings can be omitted from {frames} frames",
                omit.done, omit.asked
            ),
            format!("4 to 6 look right: write `Limited {less} {shorter}`, or take a longer motion"),
        );
    }
    if hold.shortfall() > 0 {
        report(
            format!(
                "only {} of {} frames can be held: no pose may be held for more than three of the {frames} frames",
                hold.done, hold.asked
            ),
            format!("up to a third of the frames looks right: write `Limited {less} {shorter}`"),
        );
    }
    if cut.omitted_run > MAX_OMITTED_RUN {
        report(
            format!(
                "{} drawings in a row are omitted where the motion is fastest, which tears it apart",
                cut.omitted_run
            ),
            "4 to 6 look right; if the motion has several actions, cut it into one file for each"
                .to_owned(),
        );
    }
}

/// Drawings that do not stand as `Held` says.
pub(super) fn not_held(
    held: &HeldRequest,
    conflicts: &[(usize, Conflict)],
    frames: usize,
    diagnostics: &mut Vec<Diagnostic>,
) {
    for (index, conflict) in conflicts {
        let Some((drawing, span)) = held.drawings.get(*index) else {
            continue;
        };
        let frame = drawing.frame;
        let (why, help) = match conflict {
            Conflict::Missing => (
                format!("the clip has no frame {frame}: it has {frames}"),
                format!("write a frame from 1 to {frames}"),
            ),
            Conflict::First => (
                "the first drawing cannot be left out".to_owned(),
                "leave out the drawings behind it, or hold it for longer".to_owned(),
            ),
            Conflict::LeftOut => (
                format!("the drawing {frame} is left out anyway"),
                format!("take `{frame} 0` away"),
            ),
            Conflict::NoRoom => (
                format!("there is no frame for the drawing {frame}: those beside it stand for one frame each"),
                "leave out the drawing before or behind it".to_owned(),
            ),
            Conflict::Covered => (
                format!("the drawing {frame} is covered by one before it"),
                "let the drawing before it stand for fewer frames, or take this one away".to_owned(),
            ),
            Conflict::UntilTheEnd(stands) => (
                format!("the drawing {frame} stands until the end of the clip, for {stands} frames"),
                format!("write `{frame} {stands}`: the clip is as long as before"),
            ),
            Conflict::Key => (
                format!("with the drawing {frame} so, the key pose of the performance would not stand in its frame"),
                "let the drawings before the key pose stand for as long as before, all together, or write `Perform -t`, which keeps the motion's timing".to_owned(),
            ),
        };
        let diagnostic = Diagnostic::new(Code::TooLimited, *span, why).help(help);
        // All figures that play the clip have the same problem.
        if !diagnostics.contains(&diagnostic) {
            diagnostics.push(diagnostic);
        }
    }
}

/// A file of tracks that cannot be read.
pub(super) fn broken_track(link: &str, error: &mark_tracks::Error, span: Span) -> Diagnostic {
    let message = format!("the track `{link}` cannot be read: {error}");
    Diagnostic::new(Code::BrokenTrack, span, message).help(error.help.clone())
}

/// What does not fit between the marks of a drawing and those of a track.
#[derive(Debug)]
pub(super) enum MarkProblem<'a> {
    /// No part of the figure has a mark.
    Unmarked,
    /// A part with a mark that no joint drives.
    Undriven { part: &'a str, mark: PartMark<'a> },
    /// A mark that is not among those of the track.
    Untracked {
        mark: PartMark<'a>,
        names: Vec<&'a str>,
    },
    /// A name in `Follow` that is neither a part nor a joint.
    UnknownFollower {
        follower: FollowedName<'a>,
        nearest: Option<&'a str>,
    },
    /// An emphasised mark that no part has.
    UnknownEmphasis {
        wanted: &'a str,
        names: Vec<&'a str>,
    },
}

pub(super) fn mark_problem(
    problem: &MarkProblem<'_>,
    request: &PerformanceRequest<'_>,
) -> Diagnostic {
    let file = request.file;
    let (span, message, help) = match problem {
        MarkProblem::Unmarked => (
            request.span,
            format!("`Perform \"{file}\"` has no effect: no part of the figure has a mark"),
            "write the colour of its mark behind each part that the puppet performs: `Rhand@Rarm$Mark red`"
                .to_owned(),
        ),
        MarkProblem::Undriven { part, mark } => (
            mark.span,
            format!("the mark of `{part}` has no effect: no joint of the motion drives this part"),
            "move `Mark` to a part that moves, or say which joint drives it: `Bone RightHand`".to_owned(),
        ),
        MarkProblem::Untracked { mark, names } => (
            mark.span,
            format!("the track `{file}` has no mark like `{}`", mark.word),
            if names.is_empty() { format!("track it: `okoshi track CLIP -o {file} --mark {}`", mark.word) } else { format!(
                    "its marks are {}: write one of them, or track the clip again with `--mark {}`",
                    listed(names),
                    mark.word
                ) },
        ),
        MarkProblem::UnknownFollower { follower, .. } => (
            follower.span,
            format!(
                "`Follow {}` means nothing: no part and no joint of the motion has this name",
                follower.name
            ),
            "write the name of a part of the figure".to_owned(),
        ),
        MarkProblem::UnknownEmphasis { wanted, names } => (
            request.span,
            format!("`{wanted}` cannot be emphasised: no part that is performed has this mark"),
            format!("these marks are performed: {}", listed(names)),
        ),
    };
    let diagnostic = Diagnostic::new(Code::MarkMismatch, span, message).help(help);
    match problem {
        MarkProblem::UnknownFollower {
            nearest: Some(nearest),
            ..
        } => diagnostic.label(format!("did you mean `{nearest}`?")),
        _ => diagnostic,
    }
}

/// A performance of a clip that moves parts by what they are.
pub(super) fn unperformed(request: &PerformanceRequest<'_>, clip: &str) -> Diagnostic {
    let message = format!(
        "`Perform \"{}\"` has no effect on `{clip}`, which has no joints that a mark could perform",
        request.file
    );
    Diagnostic::new(Code::MarkMismatch, request.span, message)
        .help("perform a motion of a body, such as a file or `Motion wave`, or leave `Perform` out")
}

/// A performance of several motions in turn.
pub(super) fn unperformed_turns(request: &PerformanceRequest<'_>) -> Diagnostic {
    let message = format!(
        "`Perform \"{}\"` has no effect on motions that play in turn, because it times one action",
        request.file
    );
    Diagnostic::new(Code::MarkMismatch, request.span, message)
        .help("give the motion that is performed a `Motion` of its own, which plays once")
}

/// Marks of a track that no part of the drawing has.
pub(super) fn unused_marks(names: &[&str], span: Span) -> Diagnostic {
    let (which, verb) = match names {
        [name] => (format!("mark `{name}`"), "is"),
        names => (format!("marks {}", listed(names)), "are"),
    };
    let message = format!(
        "the {which} {verb} in the track, but no part has {}",
        match names.len() {
            1 => "it",
            _ => "them",
        }
    );
    let first = names.first().copied().unwrap_or("red");
    Diagnostic::new(Code::MarkMismatch, span, message).help(format!(
        "write it behind the part that it performs: `Rhand@Rarm$Mark {first}`"
    ))
}

/// Names in backquotes, as a sentence lists them.
fn listed(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// What a performance has besides what one expects. `emphasized` are the emphasised part and its mark, `other` the part that moves most
/// in the motion.
pub(super) fn odd_performance(
    finding: Finding,
    emphasized: Option<(String, String)>,
    other: Option<String>,
    request: &PerformanceRequest<'_>,
) -> Diagnostic {
    let file = request.file;
    let (part, mark) = emphasized.unwrap_or_default();
    let cut = format!(
        "cut the clip to one action (`okoshi track CLIP --range 1:48`), or give the key frames of track and motion: `Perform \"{file}\" 31 44`"
    );
    let (message, help) = match finding {
        Finding::NoInput => (
            "no mark of the track moves: the clip keeps its timing, and no joint is emphasised".to_owned(),
            "film the puppet from the front, larger or with less blur, and see what `okoshi track` reports as lost".to_owned(),
        ),
        Finding::NoMotion => (
            "no part with a mark moves in the motion: the clip keeps its timing".to_owned(),
            "put `Mark` on the parts that the motion is about, such as the hands of a boxer".to_owned(),
        ),
        Finding::SecondInput(frame) => (
            format!("the track has a second movement that is nearly as large, in frame {}", frame + 1),
            cut,
        ),
        Finding::SecondMotion(frame) => (
            format!("the motion has a second movement that is nearly as large, in frame {}", frame + 1),
            format!("use a motion of one action (`okoshi motion IN.bvh -o OUT.bvh --range 1:48`), or give the key frames of track and motion: `Perform \"{file}\" 31 44`"),
        ),
        Finding::OtherJoint(_) => (
            format!(
                "the mark `{mark}` of `{part}` moves most in the track, but in the motion `{}` does",
                other.unwrap_or_default()
            ),
            format!("perform with the mark of that part, or name the one that counts: `Perform \"{file}\" {mark}`"),
        ),
        Finding::TowardsViewer(_) => (
            format!(
                "in the motion `{}` moves towards the viewer, which moves a mark little when a puppet does the same",
                other.unwrap_or_default()
            ),
            "film the puppet from the side, or let its mark go sideways at that moment".to_owned(),
        ),
        Finding::NoSuchInputKey(key, frames) => (
            format!("the track has no frame {key}, only {frames} at the motion's rate: the frame of its largest movement is used"),
            format!("write a frame from 1 to {frames}"),
        ),
        Finding::NoSuchMotionKey(key, frames) => (
            format!("the motion has no frame {key}, only {frames}: the frame of its largest movement is used"),
            format!("write a frame from 1 to {frames}"),
        ),
    };
    Diagnostic::new(Code::OddPerformance, request.span, message).help(help)
}

/// Problems of matching parts with joints, over all clips: a problem is only reported if every clip of the figure has it.
#[derive(Debug, Default)]
pub(super) struct MatchProblems {
    /// Per part, and the name that its string gives or an empty one, how often the problem occurred, and its last occurrence.
    problems: BTreeMap<(PartId, String), (usize, Problem)>,
    /// Per part how many clips its figure has.
    clips: BTreeMap<PartId, usize>,
}

impl MatchProblems {
    pub(super) fn add(&mut self, group: &FigureGroup, matching: &Matching) {
        for part in &group.parts {
            *self.clips.entry(*part).or_default() += 1;
        }
        for problem in &matching.problems {
            let keys: Vec<(PartId, String)> = match problem {
                Problem::UnknownBone { part, name, .. }
                | Problem::AmbiguousBone { part, name, .. } => {
                    vec![(group.parts[*part], name.clone())]
                }
                Problem::NotAChain { part, .. }
                | Problem::TooManyBones { part }
                | Problem::BentArm { part, .. } => {
                    vec![(group.parts[*part], String::new())]
                }
                Problem::NoSuchLimb { parts, .. } => parts
                    .iter()
                    .map(|part| (group.parts[*part], String::new()))
                    .collect(),
                Problem::NothingMatched => Vec::new(),
            };
            for key in keys {
                let entry = self
                    .problems
                    .entry(key)
                    .or_insert_with(|| (0, problem.clone()));
                *entry = (entry.0 + 1, problem.clone());
            }
        }
    }

    /// Reports the problems that all clips of a figure have.
    pub(super) fn report(
        &self,
        context: &Context<'_>,
        skeleton: Option<&Skeleton>,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        for ((part, _), (count, problem)) in &self.problems {
            if self.clips.get(part).is_none_or(|clips| count >= clips) {
                diagnostics.push(match_problem(context, *part, problem, skeleton));
            }
        }
    }
}

fn match_problem(
    context: &Context<'_>,
    part: PartId,
    problem: &Problem,
    skeleton: Option<&Skeleton>,
) -> Diagnostic {
    let bindings = context.bindings;
    let element = context.drawing.shapes[bindings.parts[part].shape]
        .element
        .span;
    let bones = bindings.attributes(part).bones();
    let span = bones.map_or(element, |bones| bindings.span_of(&bones.source));
    let called = |joint: JointId| {
        let joint = skeleton.and_then(|skeleton| skeleton.joints.get(joint));
        joint.map_or_else(String::new, |joint| format!("`{}`", joint.name))
    };
    let unclear = |message: String| Diagnostic::new(Code::UnclearJoint, span, message);
    let name = bindings.describe(context.drawing, part);
    match problem {
        Problem::UnknownBone { name, nearest, .. } => {
            let diagnostic = unclear(format!("the motion has no joint `{name}`"));
            match nearest.as_slice() {
                [] => diagnostic.help("`okoshi motion FILE` lists the joints of a motion"),
                nearest => {
                    let names: Vec<String> = nearest.iter().map(|name| format!("`{name}`")).collect();
                    diagnostic.help(format!("write {} instead", names.join(" or ")))
                }
            }
        }
        Problem::AmbiguousBone { name, joints, .. } => unclear(format!("{} joints of the motion are called `{name}`", joints.len()))
            .help("the first of them is used; `Bone first second` names a chain"),
        Problem::NotAChain { from, to, .. } => {
            unclear(format!("the joint {} is not below {}", called(*to), called(*from)))
                .help("name the joint where the chain begins first, then the one where it ends: `Bone RightArm RightHand`")
        }
        Problem::TooManyBones { .. } => unclear("`Bone` names more than two joints".to_owned())
            .help("name the joint where the chain begins and the one where it ends: `Bone RightArm RightHand`"),
        Problem::NoSuchLimb { class, side, .. } => {
            let message = format!("the motion has no {} {} for {name}, so it moves along with its parent", side.name(), class.name());
            Diagnostic::new(Code::NoJoint, element, message).help("use `Bone` to say which joint drives the part")
        }
        Problem::BentArm { error, .. } => {
            let message = format!(
                "{name} is drawn in one piece, and the motion bends the elbow: the hand is {:.0} % of the arm's length away from where it should be",
                error * 100.0
            );
            Diagnostic::new(Code::BentArm, element, message)
                .help("split the arm into two shapes at the elbow to show the motion better, or let it bend: `Bend 1` in its string")
        }
        Problem::NothingMatched => unclear("no joint drives any part".to_owned()),
    }
}
