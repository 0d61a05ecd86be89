//! Clips of motion capture on the figures of a drawing (motion.md).
//!
//! A figure is a group of parts that are connected, by strings or because they touch. Each clip becomes an animation of the nodes
//! of a figure's parts; figures that play clips of the same name share one animation.

mod diagnostics;
mod figure_clip;
mod figures;
mod missing_files;
mod motion_files;
mod performances;
mod performed;
mod rigging;
mod surface;
mod tracks;

use std::sync::Arc;

use glam::DVec3;

use crate::bind::{Bindings, ClipLimits, ClipRequest, MotionSource, PerformanceRequest, SetBy};
use crate::diagnostic::Diagnostic;
use crate::geometry::{Frame, Thickness};
use crate::memo::{Memo, Same};
use crate::motion::clips::{BuiltIn, Legs};
use crate::motion::figure::Figure;
use crate::motion::labels::Class;
use crate::motion::limited::{self, Cut, Length};
use crate::motion::mark_tracks::MarkTracks;
use crate::motion::matching::{Matching, bent_arms, match_figure};
use crate::motion::measured::Measured;
use crate::motion::performance::{Filmed, Plan};
use crate::motion::prepare::{self, PreparedClip};
use crate::motion::retarget::{RetargetedClip, Rig, Turns};
use crate::motion::travel::travel;
use crate::resolver::Resolver;
use crate::scene::{Scene, WorldTransform};
use crate::svg::Drawing;

use diagnostics::MatchProblems;
pub use figure_clip::{FigureClip, PartDrive, originals};
pub use figures::{FigureGroup, find as find_figures};
use motion_files::MotionFiles;
use performances::Performances;
use performed::Channels;
pub use performed::{Performed, PerformedParts};
pub use rigging::RestNode;
use rigging::{RestNodes, RetargetKey};
use tracks::AnimatedNodes;

/// The most keys of all clips of a drawing: frames × parts.
const MAX_KEYS: usize = 1 << 24;

/// How often a figure is matched with a motion at most.
const MAX_MATCHES: usize = 1 << 18;

/// A figure's motion, as the key of the cached one in place.
#[derive(PartialEq, Eq, Hash)]
struct InPlaceKey(Same<RetargetedClip>);

/// A figure's motion, as the key of its cached [`Measured`] points.
#[derive(PartialEq, Eq, Hash)]
struct MeasuredKey(Same<RetargetedClip>);

/// A figure's motion, the numbers of drawings to omit and frames to hold, and the frame that must stay, as the key of a cached [`Cut`].
#[derive(PartialEq, Eq, Hash)]
struct CutKey(Same<Measured>, [usize; 2], Option<usize>);

/// The drawing whose figures are animated.
pub struct Context<'a> {
    /// The drawing.
    pub drawing: &'a Drawing,
    /// Its bindings.
    pub bindings: &'a Bindings,
    /// From the drawing's axes to the world's.
    pub world: &'a WorldTransform,
    /// Per part its rest frame.
    pub frames: &'a [Frame],
    /// Per main part the parts whose solids are in its node.
    pub parts_of_node: &'a [Vec<usize>],
    /// Per part the thickness of its solid, `None` without one.
    pub thicknesses: &'a [Option<Thickness>],
}

/// A clip that comes along, as the key of a cached [`PreparedClip`].
#[derive(PartialEq, Eq, Hash)]
struct BuiltInKey(BuiltIn, Legs);

/// A motion that a string asks for.
enum Motion {
    /// That of a file.
    File(Arc<PreparedClip>),
    /// One that comes along: which clip it is depends on the figure.
    BuiltIn(BuiltIn),
}

/// A figure matched with a clip.
struct MatchedFigure {
    group: FigureGroup,
    figure: Figure,
    matching: Matching,
}

/// A clip that a string asks for.
struct Requested<'r, 'a> {
    request: &'r ClipRequest<'a>,
    /// The file or the word.
    link: &'a str,
    performance: Option<FoundPerformance<'a>>,
}

/// A performance of a figure.
struct FoundPerformance<'a> {
    request: PerformanceRequest<'a>,
    tracks: Arc<MarkTracks>,
    channels: Channels,
    plan: Arc<Plan>,
}

/// Adds the clips that strings ask for to the scene, and returns what they are. `nodes` are the scene's first nodes, parents before
/// children.
pub fn add_clips(
    context: &Context<'_>,
    nodes: impl Iterator<Item = RestNode>,
    resolver: &dyn Resolver,
    memo: &Memo,
    scene: &mut Scene,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<FigureClip> {
    let requests = context.bindings.clip_requests();
    if requests.is_empty() {
        return Vec::new();
    }
    let nodes: Vec<RestNode> = nodes.collect();
    let rest = RestNodes::new(context.frames, &nodes);
    let groups = figures::find(context.bindings);
    let mut builder = ClipBuilder {
        context,
        rest: &rest,
        animated: Arc::new(AnimatedNodes {
            nodes,
            world: *context.world,
        }),
        memo,
        problems: MatchProblems::default(),
        clips: Vec::new(),
    };
    let (mut files, mut performances) = (MotionFiles::default(), Performances::default());
    let (mut keys, mut matches) = (0_usize, 0_usize);
    for request in &requests {
        let (link, motion) = match request.source {
            MotionSource::File(link) => {
                let motion = files.get(link, request, resolver, memo, diagnostics);
                (link, motion.map(Motion::File))
            }
            MotionSource::BuiltIn(word) => (word, BuiltIn::from_name(word).map(Motion::BuiltIn)),
        };
        let Some(motion) = motion else {
            continue;
        };
        let mut is_played = false;
        for group in groups
            .iter()
            .filter(|group| group.is_addressed_by(request.part))
        {
            matches += 1;
            if matches > MAX_MATCHES {
                diagnostics.push(diagnostics::too_many_matches(request.span));
                is_played = true;
                break;
            }
            let figure = rigging::drawn_figure(context, group);
            let motion = match &motion {
                Motion::File(motion) => Arc::clone(motion),
                Motion::BuiltIn(which) => builder.built_in(*which, &figure),
            };
            let Some(matched) = builder.match_figure(group, figure, &motion) else {
                continue;
            };
            is_played = true;
            keys = keys.saturating_add(motion.clip.frames().saturating_mul(group.parts.len()));
            if keys > MAX_KEYS {
                diagnostics.push(diagnostics::too_many_keys(request.span));
                break;
            }
            let performance = builder.performance(request, &matched.group);
            let performance = performance.and_then(|request| {
                let tracks = performances.get(&request, resolver, memo, diagnostics)?;
                let found = builder.perform(request, &tracks, &matched, &motion, diagnostics);
                let marks = found.iter().flat_map(|found| found.channels.marks());
                performances.note_used(&found.as_ref()?.request, &tracks, marks);
                found
            });
            let frames = performance.as_ref().map_or(0, |found| found.plan.frames(0));
            keys = keys.saturating_add(frames.saturating_mul(group.parts.len()));
            if keys > MAX_KEYS {
                diagnostics.push(diagnostics::too_many_keys(request.span));
                break;
            }
            let requested = Requested {
                request,
                link,
                performance,
            };
            builder.add_clip(requested, &matched, &motion, scene, diagnostics);
        }
        if !is_played {
            diagnostics.push(diagnostics::idle_motion(request.span, link));
        }
    }
    let skeleton = builder.clips.last().map(|clip| clip.skeleton());
    builder.problems.report(context, skeleton, diagnostics);
    performances.report_unused(diagnostics);
    builder.clips
}

/// Builds the clips of a drawing, one after the other.
struct ClipBuilder<'a> {
    context: &'a Context<'a>,
    rest: &'a RestNodes,
    animated: Arc<AnimatedNodes>,
    memo: &'a Memo,
    problems: MatchProblems,
    clips: Vec<FigureClip>,
}

impl<'a> ClipBuilder<'a> {
    /// A clip that comes along, for as many legs as a figure has.
    fn built_in(&self, which: BuiltIn, figure: &Figure) -> Arc<PreparedClip> {
        let legs = Legs::of(figure);
        self.memo.get(BuiltInKey(which, legs), |key| {
            Arc::new(prepare::built_in(key.0, key.1))
        })
    }

    /// Matches a figure, as it is drawn, with a motion; `None` if no joint drives any part.
    fn match_figure(
        &mut self,
        group: &FigureGroup,
        figure: Figure,
        motion: &PreparedClip,
    ) -> Option<MatchedFigure> {
        let matched = |group: FigureGroup, figure: Figure| {
            let matching = match_figure(&figure, &motion.clip.skeleton, &motion.anatomy);
            MatchedFigure {
                group,
                figure,
                matching,
            }
        };
        let mut found = matched(group.clone(), figure);
        let is_hips = |part: &usize| {
            let label = found.matching.parts[*part].label.as_ref();
            label.is_some_and(|label| label.class == Class::Hips) && group.is_rooted(*part)
        };
        // Unless strings say otherwise, the hips become the root, because their travel is the figure's.
        let hips = (0..group.parts.len()).find(is_hips);
        let hips = hips.map(|part| group.parts[part]);
        if let Some(hips) = hips.filter(|hips| *hips != group.root) {
            let group = group.clone().rooted_at(hips);
            let figure = rigging::drawn_figure(self.context, &group);
            found = matched(group, figure);
        }
        let mut parts = found.matching.parts.iter();
        if parts.all(|part| part.drive.is_none()) {
            return None;
        }
        let bent = bent_arms(&found.matching, &motion.clip, &motion.anatomy);
        found.matching.problems.extend(bent);
        self.problems.add(&found.group, &found.matching);
        Some(found)
    }

    /// What a performance does to a clip of a figure; `None` if no part of it has a mark of the tracks.
    fn perform<'r>(
        &self,
        request: PerformanceRequest<'r>,
        tracks: &Arc<MarkTracks>,
        matched: &MatchedFigure,
        motion: &Arc<PreparedClip>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<FoundPerformance<'r>> {
        let channels = Channels::find(self.context, matched, &request, tracks, motion, diagnostics);
        if channels.is_empty() {
            return None;
        }
        let plan = channels.plan(matched, &request, tracks, motion, self.memo);
        let parts = &self.context.bindings.parts;
        let name = |part: usize| parts[part].name.clone();
        let of_parts = channels.parts(&matched.group);
        performed::report(&plan, tracks, &of_parts, name, &request, diagnostics);
        Some(FoundPerformance {
            request,
            tracks: Arc::clone(tracks),
            channels,
            plan,
        })
    }

    fn add_clip(
        &mut self,
        requested: Requested<'_, '_>,
        matched: &MatchedFigure,
        motion: &Arc<PreparedClip>,
        scene: &mut Scene,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        let Requested {
            request,
            link,
            performance,
        } = requested;
        let group = &matched.group;
        let rig = rigging::rig(
            self.context,
            &matched.figure,
            group,
            &matched.matching,
            self.rest,
        );
        let retargeted = self.retargeted(request, matched, motion, &rig, performance.as_ref());
        let measured = self.measured(&rig, &retargeted);
        let frames = retargeted.grounded.len();
        let limits = request.limits.or_else(|| self.limits(group));
        let key_frame = performance
            .as_ref()
            .and_then(|found| found.plan.key_frame());
        let cut = limits.map(|limits| {
            let cut = self.cut([limits.omit, limits.hold], &measured, key_frame);
            diagnostics::too_limited(&cut, frames, limits.span, diagnostics);
            cut
        });
        let filmed = performance.as_ref().and_then(|found| {
            let part = found.channels.filmed(&found.plan)?;
            let driven = rig.parts[..part]
                .iter()
                .filter(|part| part.drive.is_some())
                .count();
            let shown = figure_clip::shown_frames(cut.as_deref(), frames);
            // Of each driven part the joint and the far end are measured.
            let (points, tip) = (&measured.points, 2 * driven + 1);
            let filming = found.plan.filming;
            Some(Filmed::new(
                filming,
                points,
                measured.per_frame,
                &shown,
                tip,
            ))
        });
        let wanted = request.name.unwrap_or_else(|| figure_clip::stem(link));
        let clip = FigureClip {
            name: figure_clip::free_name(&self.clips, group.root, wanted),
            file: link.to_owned(),
            requested_at: request.span,
            root: group.root,
            parts: figure_clip::part_drives(&group.parts, &matched.matching, |part| {
                self.context.bindings.attributes(part).swing().is_some()
            }),
            motion: Arc::clone(motion),
            cut,
            limited_at: limits.map(|limits| limits.span),
            performed: performance.map(|found| Performed {
                file: found.request.file.to_owned(),
                requested_at: found.request.span,
                before: self.retargeted(request, matched, motion, &rig, None),
                channels: found.channels.parts(group),
                tracks: found.tracks,
                plan: found.plan,
            }),
            filmed: filmed.unwrap_or_default(),
            order: group.parts.clone(),
            retargeted,
            measured,
            animated: Arc::clone(&self.animated),
        };
        clip.add_to(scene);
        self.clips.push(clip);
    }

    /// A motion on a figure, as it is performed, or as it is.
    fn retargeted(
        &self,
        request: &ClipRequest<'_>,
        matched: &MatchedFigure,
        motion: &Arc<PreparedClip>,
        rig: &Rig,
        performance: Option<&FoundPerformance<'_>>,
    ) -> Arc<RetargetedClip> {
        let ratios = performance.map(|found| found.channels.ratios(&found.plan, matched, rig));
        let ratios = ratios.unwrap_or_default();
        let plan = performance.map(|found| &found.plan);
        let key = RetargetKey::new(rig, motion, plan.map(|plan| (plan, ratios.as_slice())));
        let mut retargeted = self.memo.get(key, |_| {
            let mut turns = Turns::new(&motion.clip, rig, &motion.landmarks());
            if let Some(timing) = plan.and_then(|plan| plan.timing.as_ref()) {
                turns = turns.timed(timing);
            }
            Arc::new(turns.damped(&ratios).travel())
        });
        if request.is_in_place {
            let group = &matched.group;
            let root = group.parts.iter().position(|part| *part == group.root);
            let key = InPlaceKey(Same(Arc::clone(&retargeted)));
            retargeted = self.memo.get(key, |_| {
                Arc::new(in_place(&retargeted, root.unwrap_or(0), motion))
            });
        }
        retargeted
    }

    fn measured(&self, rig: &Rig, retargeted: &Arc<RetargetedClip>) -> Arc<Measured> {
        let key = MeasuredKey(Same(Arc::clone(retargeted)));
        let measure = |_: &MeasuredKey| Arc::new(Measured::of_figure(rig, retargeted));
        self.memo.get(key, measure)
    }

    fn cut(
        &self,
        amounts: [usize; 2],
        measured: &Arc<Measured>,
        key_frame: Option<usize>,
    ) -> Arc<Cut> {
        let key = CutKey(Same(Arc::clone(measured)), amounts, key_frame);
        self.memo.get(key, |_| {
            let [omit, hold] = amounts;
            let options = limited::Options {
                omit,
                hold,
                length: Length::Kept,
            };
            let poses = measured.poses().keeping(key_frame);
            Arc::new(limited::limit(poses, &options))
        })
    }

    /// The limits of all clips of a figure that have none of their own.
    fn limits(&self, group: &FigureGroup) -> Option<ClipLimits> {
        let bindings = self.context.bindings;
        of_figure(group, |part| bindings.limits_of_clips(part))
    }

    /// The performance of a clip: its own, or else that of all clips of the figure.
    fn performance(
        &self,
        request: &ClipRequest<'a>,
        group: &FigureGroup,
    ) -> Option<PerformanceRequest<'a>> {
        let bindings = self.context.bindings;
        let own = request.performance.clone();
        own.or_else(|| of_figure(group, |part| bindings.performance_of_clips(part)))
    }
}

/// What the strings say about all clips of a figure: that of any of its parts takes precedence over one for all figures.
fn of_figure<T>(group: &FigureGroup, said: impl Fn(usize) -> Option<(SetBy, T)>) -> Option<T> {
    let parts = std::iter::once(&group.root).chain(&group.parts);
    let said = parts.filter_map(|part| said(*part));
    let (_, first) = said.min_by_key(|(from, _)| *from)?;
    Some(first)
}

/// The clip without the travel of the figure's root over the ground.
fn in_place(clip: &RetargetedClip, root: usize, motion: &PreparedClip) -> RetargetedClip {
    let mut clip = clip.clone();
    let fps = 1.0 / motion.clip.frame_time;
    let travel = match clip.translations.get(root) {
        Some(Some(path)) => travel(path, DVec3::Y, fps, motion.ending),
        _ => Vec::new(),
    };
    for path in clip.translations.iter_mut().flatten() {
        for (place, travel) in path.iter_mut().zip(&travel) {
            *place -= *travel;
        }
    }
    clip
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::keyword::vocabulary::CLIPS;

    #[test]
    fn every_word_is_a_clip() {
        let words: Vec<&str> = CLIPS.iter().map(|word| word.name).collect();
        assert_eq!(words, BuiltIn::ALL.map(BuiltIn::name));
    }

    #[test]
    fn in_place_all_nodes_lose_the_travel_of_the_root() {
        let motion = prepare::built_in(BuiltIn::Walk, Legs::Two);
        let path = |x: f64| {
            (0..25)
                .map(|t| DVec3::new(x, 1.0, 2.0 * f64::from(t)))
                .collect()
        };
        let clip = RetargetedClip {
            translations: vec![Some(path(0.0)), None, Some(path(5.0))],
            ..RetargetedClip::default()
        };
        let still = in_place(&clip, 0, &motion);
        for (path, x) in still.translations.iter().flatten().zip([0.0, 5.0]) {
            let place = DVec3::new(x, 1.0, 0.0);
            assert!(path.iter().all(|at| at.distance(place) < 1e-9));
        }
    }
}
