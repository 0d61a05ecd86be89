//! Performances of figures: which part each mark performs, and what that does to a clip (docs/performance.md).

use std::sync::Arc;

use glam::DVec3;
use typed_index_collections::TiVec;

use super::Context;
use super::builder::MatchedFigure;
use super::diagnostics::{self, MarkProblem};
use super::figures::FigureGroup;
use crate::bind::{Camerawork, PartId, PartMark, PerformanceRequest};
use crate::diagnostic::{Diagnostic, nearest_word};
use crate::labels::{Facing, FigurePartId, Tip};
use crate::mark_tracks::{Hsv, MarkId, MarkTrack, MarkTracks, hue_difference, same_name};
use crate::memo::{Memo, Same};
use crate::mocap::{Clip, JointId, Pose};
use crate::performance::{
    Effects, Filming, Finding, Limbs, Plan, Request, joint_steps, mark_movements, plan, ratios,
};
use crate::prepare::PreparedClip;
use crate::retarget::{Drive, MatchedPart, joints_named};
use crate::retarget::{RetargetedClip, to_drawing};
use crate::source::Span;

/// A mark whose hue differs by more than this from that of a part's `Mark` is another one, degrees.
const SAME_HUE: f64 = 30.0;
/// A colour of less chroma has no hue to compare, 0 to 1.
const LEAST_CHROMA: f64 = 40.0 / 255.0;

/// A clip's performance.
#[derive(Debug)]
pub struct Performed {
    /// The file of the track, as the string names it.
    pub file: String,
    /// Where the string asks for it.
    pub requested_at: Span,
    /// The motion without the performance, on the figure.
    pub(super) before: Arc<RetargetedClip>,
    /// The tracks.
    pub tracks: Arc<MarkTracks>,
    /// What it does to the clip. Its channels are those of `channels`.
    pub plan: Arc<Plan>,
    /// Which mark performs which parts.
    pub channels: Vec<PerformedParts>,
}

/// Parts of a figure that a mark performs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PerformedParts {
    /// The mark.
    pub mark: MarkId,
    /// The parts.
    pub parts: Vec<PartId>,
}

/// The channels of a performance of a figure.
#[derive(Debug, Default)]
pub(super) struct Channels {
    /// Per channel its mark, and the parts that the mark performs.
    marks: Vec<(MarkId, Vec<FigurePartId>)>,
    /// Per channel the parts that are edited along with them.
    followers: Vec<Vec<FigurePartId>>,
    /// The channel that the string emphasises.
    emphasized: Option<usize>,
}

/// Everything that a plan follows from, as the key of a cached [`Plan`].
#[derive(PartialEq, Eq, Hash)]
struct PlanKey {
    motion: Same<PreparedClip>,
    tracks: Same<MarkTracks>,
    /// Per channel its mark, and the drives of its parts.
    channels: Vec<(MarkId, Vec<Drive>)>,
    request: Request,
    facing: Facing,
}

impl Channels {
    /// Finds the parts that marks of a file perform. What does not fit is reported.
    pub(super) fn find(
        context: &Context<'_>,
        matched: &MatchedFigure,
        request: &PerformanceRequest<'_>,
        tracks: &MarkTracks,
        motion: &PreparedClip,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let bindings = context.bindings;
        let group = &matched.group;
        let mut found = Self::default();
        let mut report = |problem: MarkProblem<'_>| {
            let diagnostic = diagnostics::mark_problem(&problem, request);
            // Figures that play several clips have the same problem in each.
            if !diagnostics.contains(&diagnostic) {
                diagnostics.push(diagnostic);
            }
        };
        let mut has_mark = false;
        for (place, part) in group.parts.iter_enumerated() {
            let Some(mark) = bindings.mark(*part) else {
                continue;
            };
            has_mark = true;
            let name = &bindings.parts[*part].name;
            if matched.matching.parts[place].drive.is_none() {
                report(MarkProblem::Undriven { part: name, mark });
                continue;
            }
            let Some(index) = mark_of(tracks, &mark) else {
                let names = tracks.marks.iter().map(|mark| mark.name.as_str());
                report(MarkProblem::Untracked {
                    mark,
                    names: names.collect(),
                });
                continue;
            };
            let channel = found.marks.iter().position(|(known, _)| *known == index);
            let channel = channel.unwrap_or_else(|| {
                found.marks.push((index, Vec::new()));
                found.followers.push(Vec::new());
                found.marks.len() - 1
            });
            found.marks[channel].1.push(place);
            for follower in bindings.follows(*part) {
                let places = followers(context, matched, motion, follower.name);
                if places.is_empty() {
                    let parts = group
                        .parts
                        .iter()
                        .map(|part| bindings.parts[*part].name.as_str());
                    let nearest = nearest_word(follower.name, parts);
                    report(MarkProblem::UnknownFollower { follower, nearest });
                }
                found.followers[channel].extend(places);
            }
        }
        if found.marks.is_empty() && !has_mark {
            report(MarkProblem::Unmarked);
        }
        if let Some(wanted) = request.emphasized {
            let names = || {
                found
                    .marks
                    .iter()
                    .map(|(mark, _)| tracks.marks[*mark].name.as_str())
            };
            let word = |channel: &usize| {
                let parts = &found.marks[*channel].1;
                let mut words = parts
                    .iter()
                    .filter_map(|place| bindings.mark(group.parts[*place]));
                names()
                    .nth(*channel)
                    .is_some_and(|name| same_name(name, wanted))
                    || words.any(|mark| same_name(mark.word, wanted))
            };
            found.emphasized = (0..found.marks.len()).find(word);
            if found.emphasized.is_none() && !found.marks.is_empty() {
                let names: Vec<&str> = names().collect();
                report(MarkProblem::UnknownEmphasis { wanted, names });
            }
        }
        found
    }

    pub(super) fn is_empty(&self) -> bool {
        self.marks.is_empty()
    }

    /// The marks of the channels.
    pub(super) fn marks(&self) -> impl Iterator<Item = MarkId> + '_ {
        self.marks.iter().map(|(mark, _)| *mark)
    }

    /// What the performance does to a clip.
    pub(super) fn plan(
        &self,
        matched: &MatchedFigure,
        request: &PerformanceRequest<'_>,
        tracks: &Arc<MarkTracks>,
        motion: &Arc<PreparedClip>,
        memo: &Memo,
    ) -> Arc<Plan> {
        let drive = |place: &FigurePartId| matched.matching.parts[*place].end_drive();
        let channel = |(mark, places): &(MarkId, Vec<FigurePartId>)| {
            (*mark, places.iter().filter_map(drive).collect())
        };
        let key = PlanKey {
            motion: Same(Arc::clone(motion)),
            tracks: Same(Arc::clone(tracks)),
            channels: self.marks.iter().map(channel).collect(),
            request: Request {
                effects: effects(request),
                emphasized: self.emphasized,
                keys: request.keys,
            },
            facing: matched.matching.facing.facing,
        };
        memo.get(key, |key| {
            let marks: Vec<MarkId> = key.channels.iter().map(|(mark, _)| *mark).collect();
            let motion = &key.motion.0;
            let input = mark_movements(&key.tracks.0, &marks, 1.0 / motion.clip.frame_time);
            let drives = key.channels.iter().map(|(_, drives)| drives.as_slice());
            let hips = motion.landmarks().hips;
            let steps = drives.map(|drives| drive_steps(&motion.clip, drives, hips));
            let steps: Vec<Vec<DVec3>> = steps.collect();
            let to_drawing = to_drawing(&motion.clip, &motion.landmarks(), key.facing);
            let viewer = to_drawing.inverse() * DVec3::Z;
            Arc::new(plan(input, &steps, viewer, &key.request))
        })
    }

    /// Per part of a figure the ratio of its turns that is left.
    pub(super) fn ratios(
        &self,
        plan: &Plan,
        matched: &MatchedFigure,
    ) -> TiVec<FigurePartId, Option<f64>> {
        let Some(emphasized) = plan.emphasized.filter(|_| plan.is_damping) else {
            return TiVec::new();
        };
        let parents = matched.figure.parts.iter();
        let parents: TiVec<_, _> = parents.map(|part| part.parent).collect();
        let class = |part: &MatchedPart| part.label.as_ref().map(|label| label.class);
        let classes: TiVec<_, _> = matched.matching.parts.iter().map(class).collect();
        let limbs = Limbs {
            parents: &parents,
            classes: &classes,
        };
        let channels: Vec<Vec<FigurePartId>> = self
            .marks
            .iter()
            .map(|(_, places)| places.clone())
            .collect();
        let largest = plan.largest_inputs();
        ratios(&limbs, &channels, &self.followers, &largest, emphasized)
    }

    /// The part that the camera shows.
    pub(super) fn filmed(&self, plan: &Plan) -> Option<FigurePartId> {
        self.marks[plan.emphasized?].1.first().copied()
    }

    /// The channels in parts of the drawing.
    pub(super) fn parts(&self, group: &FigureGroup) -> Vec<PerformedParts> {
        let channel = |(mark, places): &(MarkId, Vec<FigurePartId>)| PerformedParts {
            mark: *mark,
            parts: places.iter().map(|place| group.parts[*place]).collect(),
        };
        self.marks.iter().map(channel).collect()
    }
}

fn effects(request: &PerformanceRequest<'_>) -> Effects {
    Effects {
        timing: request.effects.timing,
        emphasis: request.effects.emphasis,
        filming: match request.effects.camerawork {
            Camerawork::Camera => Filming::Camera,
            Camerawork::Root => Filming::Character,
            Camerawork::None => Filming::None,
        },
    }
}

/// The steps of the far ends of some drives relative to the hips; of several, in each frame that of the one that moves most.
fn drive_steps(clip: &Clip, drives: &[Drive], hips: JointId) -> Vec<DVec3> {
    let mut paths = vec![Vec::with_capacity(clip.frames); drives.len()];
    let mut hip_path = Vec::with_capacity(clip.frames);
    let mut pose = Pose::new();
    for frame in 0..clip.frames {
        clip.pose_into(frame, &mut pose);
        hip_path.push(pose.get(hips).map_or(DVec3::ZERO, |hips| hips.position));
        for (path, drive) in paths.iter_mut().zip(drives) {
            let end = drive.tip.unwrap_or(Tip::Joint(drive.joint));
            path.push(end.place(&clip.skeleton, &pose));
        }
    }
    let steps = joint_steps(&paths, &hip_path);
    let most = |frame: usize| {
        let steps = steps.iter().map(|steps| steps[frame]);
        let longest = steps.max_by(|a, b| a.length().total_cmp(&b.length()));
        longest.unwrap_or_default()
    };
    (0..clip.frames).map(most).collect()
}

/// The mark of a file that a part's `Mark` means: that of the same name, else of the same colour, else of the nearest hue.
fn mark_of(tracks: &MarkTracks, mark: &PartMark<'_>) -> Option<MarkId> {
    let position = |fits: &dyn Fn(&MarkTrack) -> bool| tracks.marks.position(fits);
    let named = tracks.mark_named(mark.word);
    let exact = || position(&|track| track.color == mark.color);
    let near = || {
        let own = hue(mark.color)?;
        let off = |track: &MarkTrack| {
            let off = hue_difference(hue(track.color)?, own).abs();
            (off <= SAME_HUE).then_some(off)
        };
        let offs = tracks.marks.iter_enumerated();
        let offs = offs.filter_map(|(index, track)| Some((index, off(track)?)));
        let nearest = offs.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(nearest.0)
    };
    named.or_else(exact).or_else(near)
}

/// The hue of a colour, degrees; `None` for one that is nearly grey.
fn hue(color: [u8; 3]) -> Option<f64> {
    let color = Hsv::of(color);
    (color.chroma >= LEAST_CHROMA).then_some(color.hue)
}

/// The parts that a name in `Follow` means: the part of that name, else all that a joint of that name drives.
fn followers(
    context: &Context<'_>,
    matched: &MatchedFigure,
    motion: &PreparedClip,
    name: &str,
) -> Vec<FigurePartId> {
    let parts = &matched.group.parts;
    let is_named = |part: &PartId| context.bindings.parts[*part].name == name;
    if let Some(place) = parts.position(is_named) {
        return vec![place];
    }
    let joints = joints_named(&motion.clip.skeleton, name);
    let is_driven = |place: &FigurePartId| {
        let part = &matched.matching.parts[*place];
        let mut drives = part.drive.iter().chain(part.bones.iter().flatten());
        drives.any(|drive| joints.contains(&drive.joint))
    };
    parts.keys().filter(is_driven).collect()
}

/// Reports what a plan found, once for each place and kind.
pub(super) fn report(
    plan: &Plan,
    tracks: &MarkTracks,
    channels: &[PerformedParts],
    names: impl Fn(PartId) -> String,
    request: &PerformanceRequest<'_>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    for finding in &plan.findings {
        let of = |channel: usize| {
            let parts = channels[channel].parts.first();
            parts.map_or_else(String::new, |part| names(*part))
        };
        let emphasized = plan.emphasized.map(|channel| {
            (
                of(channel),
                tracks.marks[channels[channel].mark].name.clone(),
            )
        });
        let other = match finding {
            Finding::OtherJoint(channel) | Finding::TowardsViewer(channel) => Some(of(*channel)),
            _ => None,
        };
        let diagnostic = diagnostics::odd_performance(*finding, emphasized, other, request);
        if !diagnostics.contains(&diagnostic) {
            diagnostics.push(diagnostic);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_found_by_name_color_and_hue() {
        let track = |name: &str, color| MarkTrack {
            name: name.to_owned(),
            color,
            ..MarkTrack::default()
        };
        let tracks = MarkTracks {
            marks: vec![
                track("left", [30, 160, 60]),
                track("Red", [90, 40, 200]),
                track("hand", [200, 60, 40]),
                track("grey", [90, 90, 95]),
            ]
            .into(),
            ..MarkTracks::default()
        };
        let find = |word: &'static str, color| {
            let span = Span::default();
            mark_of(&tracks, &PartMark { word, color, span }).map(usize::from)
        };
        assert_eq!(find("red", [255, 0, 0]), Some(1), "names come first");
        assert_eq!(find("green", [0, 128, 0]), Some(0));
        assert_eq!(find("#c83c28", [200, 60, 40]), Some(2));
        assert_eq!(find("orange", [255, 90, 0]), Some(2));
        assert_eq!(find("yellow", [255, 255, 0]), None);
        assert_eq!(find("white", [255, 255, 255]), None);
    }
}
