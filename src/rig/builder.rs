//! Builds the clips of figures: matched, retargeted, performed, limited, filmed.

use std::cell::LazyCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use typed_index_collections::TiVec;

use super::Context;
use super::bones;
use super::diagnostics::{self, MatchProblems};
use super::figure_clip::{self, FigureClip};
use super::figures::FigureGroup;
use super::holding;
use super::lying;
use super::moves::{Moves, Role, Roles};
use super::performed::{self, Channels, Performed};
use super::rigging::{self, RestNodes};
use super::tracks::AnimatedNodes;
use super::turn::{self, PlayedTurn};
use crate::bind::{ClipLimits, ClipRequest, HeldRequest, PartId, PerformanceRequest, SetBy};
use crate::clips::{BuiltIn, Legs};
use crate::diagnostic::Diagnostic;
use crate::labels::{Class, Figure, FigurePartId};
use crate::limited::Measured;
use crate::limited::{self, Chosen, Cut, Exposure, Length};
use crate::mark_tracks::MarkTracks;
use crate::memo::{Exactly, Memo, Same};
use crate::mocap::resample::TimeMap;
use crate::mocap::travel::travel;
use crate::performance::{Filmed, Plan};
use crate::prepare::{self, PreparedClip};
use crate::retarget::{Matching, bent_arms, match_figure};
use crate::retarget::{RetargetedClip, Rig, Turns};
use crate::scene::Scene;

/// A motion on a rig, as it is performed: what a [`RetargetedClip`] is computed from.
#[derive(PartialEq, Eq, Hash)]
struct RetargetKey {
    rig: Exactly<Arc<Rig>>,
    motion: Same<PreparedClip>,
    /// How many steps from frame to frame it takes.
    steps: usize,
    plan: Option<Same<Plan>>,
    /// Per part the ratio of its turns that is left.
    ratios: Exactly<TiVec<FigurePartId, Option<f64>>>,
}

/// A figure's motion, as the key of the cached one in place.
#[derive(PartialEq, Eq, Hash)]
struct InPlaceKey {
    retargeted: Same<RetargetedClip>,
    /// The part whose travel is taken away from all.
    root: FigurePartId,
    motion: Same<PreparedClip>,
}

/// A figure's motion, as the key of its cached [`Measured`] points.
#[derive(PartialEq, Eq, Hash)]
struct MeasuredKey(Exactly<Arc<Rig>>, Same<RetargetedClip>);

/// A figure's motion, the numbers of drawings to omit and frames to hold, the frame that must stay, and whether it is a loop, as the
/// key of a cached [`Cut`].
#[derive(PartialEq, Eq, Hash)]
struct CutKey(Same<Measured>, [usize; 2], Option<usize>, bool);

/// A built-in clip, as the key of a cached [`PreparedClip`].
#[derive(PartialEq, Eq, Hash)]
struct BuiltInKey(BuiltIn, Legs);

/// A figure matched with a clip.
pub(super) struct MatchedFigure {
    pub(super) group: FigureGroup,
    pub(super) figure: Figure,
    pub(super) matching: Matching,
    /// The clip, where it moves parts by what they are and not by joints.
    pub(super) moves: Option<Arc<Moves>>,
}

/// A clip that a string asks for.
pub(super) struct Requested<'r, 'a> {
    pub(super) request: &'r ClipRequest<'a>,
    /// The motions that play in turn; at least one.
    pub(super) turns: &'r [PlayedTurn<'r>],
    pub(super) performance: Option<FoundPerformance<'a>>,
}

/// A performance of a figure.
pub(super) struct FoundPerformance<'a> {
    pub(super) request: PerformanceRequest<'a>,
    pub(super) tracks: Arc<MarkTracks>,
    pub(super) channels: Channels,
    pub(super) plan: Arc<Plan>,
}

/// Builds the clips of a drawing, one after the other.
pub(super) struct ClipBuilder<'a> {
    pub(super) context: &'a Context<'a>,
    pub(super) rest: &'a RestNodes,
    pub(super) animated: Arc<AnimatedNodes>,
    pub(super) memo: &'a Memo,
    pub(super) problems: MatchProblems,
    pub(super) clips: Vec<FigureClip>,
    /// Per root of a figure the clip that takes parts off what they hang on most, and these parts, the worst first.
    pub(super) loose: BTreeMap<PartId, LooseParts>,
}

/// Parts that a clip takes off what they hang on.
pub(super) struct LooseParts {
    clip: String,
    /// Each part with what it hangs on, and by how much the gap grows, as a share of the figure's height.
    parts: Vec<(PartId, PartId, f64)>,
}

impl<'a> ClipBuilder<'a> {
    /// A built-in clip, for as many legs as a figure has.
    pub(super) fn built_in(&self, which: BuiltIn, figure: &Figure) -> Arc<PreparedClip> {
        let legs = Legs::of(figure);
        self.memo.get(BuiltInKey(which, legs), |key| {
            Arc::new(prepare::built_in(key.0, key.1))
        })
    }

    /// Matches a figure, as it is drawn, with a motion; `None` if no joint drives any part.
    pub(super) fn match_figure(
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
                moves: None,
            }
        };
        let mut found = matched(group.clone(), figure);
        let is_hips = |part: &FigurePartId| {
            let label = found.matching.parts[*part].label.as_ref();
            label.is_some_and(|label| label.class == Class::Hips) && group.is_rooted(*part)
        };
        // Unless strings say otherwise, the hips become the root, because their travel is the figure's.
        let hips = group.parts.keys().find(is_hips);
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

    /// A figure with the clip that moves its parts, and how long that is.
    pub(super) fn moved(
        &self,
        which: BuiltIn,
        speed: f64,
        group: &FigureGroup,
        figure: Figure,
        roles: Roles,
    ) -> (MatchedFigure, Arc<PreparedClip>) {
        if let Some(root) = roles.better_root(which, group.rooted(), &figure) {
            let group = group.clone().rooted_at(group.parts[root]);
            let figure = rigging::drawn_figure(self.context, &group);
            let roles = Roles::find(&figure, root);
            return self.moved_about(Moves::new(which, roles).at_speed(speed), group, figure);
        }
        self.moved_about(
            Moves::new(which, roles).at_speed(speed),
            group.clone(),
            figure,
        )
    }

    fn moved_about(
        &self,
        moves: Moves,
        group: FigureGroup,
        figure: Figure,
    ) -> (MatchedFigure, Arc<PreparedClip>) {
        let parts = &self.context.bindings.parts;
        let matching = moves.matching(|part| parts[group.parts[part]].name.clone());
        let motion = prepare::of_parts(&Role::NAMES, moves.frames());
        let matched = MatchedFigure {
            group,
            figure,
            matching,
            moves: Some(Arc::new(moves)),
        };
        (matched, Arc::new(motion))
    }

    /// What a performance does to a clip of a figure; `None` if no part of it has a mark of the tracks.
    pub(super) fn perform<'r>(
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
        let name = |part: PartId| parts[part].name.clone();
        let of_parts = channels.parts(&matched.group);
        performed::report(&plan, tracks, &of_parts, name, &request, diagnostics);
        Some(FoundPerformance {
            request,
            tracks: Arc::clone(tracks),
            channels,
            plan,
        })
    }

    pub(super) fn add_clip(
        &mut self,
        requested: Requested<'_, '_>,
        scene: &mut Scene,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        let Requested {
            request,
            turns,
            performance,
        } = requested;
        let main = turn::main(turns);
        let (matched, motion) = (&turns[main].matched, &turns[main].motion);
        let group = &matched.group;
        let drawn = turns.iter().map(|turn| Arc::new(self.rig(&turn.matched)));
        let drawn: Vec<Arc<Rig>> = drawn.collect();
        let rigs: Vec<Arc<Rig>> = drawn.iter().map(lying::laid_down).collect();
        let single = |turn: usize, performance: Option<&FoundPerformance<'_>>| {
            self.retargeted(request, &turns[turn], &rigs[turn], performance)
        };
        let (rig, retargeted) = match turns {
            [only] if only.playing.cycles == 1 => {
                (Arc::clone(&rigs[0]), single(0, performance.as_ref()))
            }
            _ => {
                let clips = (0..turns.len()).map(|turn| single(turn, None));
                let clips: Vec<Arc<RetargetedClip>> = clips.collect();
                turn::joined(turns, &rigs, &clips, request.is_loop, self.memo)
            }
        };
        let measured = LazyCell::new(|| self.measured(&rig, &retargeted));
        let frames = retargeted.grounded.len();
        let limits = request.limits.or_else(|| self.limits(group));
        let key_frame = performance
            .as_ref()
            .and_then(|found| found.plan.key_frame());
        // A performance with a timing of its own ends where its track does.
        let is_timed = performance
            .as_ref()
            .is_some_and(|found| found.plan.timing.is_some());
        let ends_as_it_begins = match turns {
            [only] => only.playing.is_loop,
            _ => request.is_loop,
        };
        let is_loop = ends_as_it_begins && !is_timed;
        let held = request.held.clone().or_else(|| self.held(group));
        let (cut, chosen) = self.drawings(
            limits,
            held.as_ref(),
            || Arc::clone(&measured),
            (frames, key_frame, is_loop),
            diagnostics,
        );
        let filmed = performance.as_ref().and_then(|found| {
            let part = found.channels.filmed(&found.plan)?;
            let end = bones::driven_end(&rig, part);
            let driven = rig.parts[..end]
                .iter()
                .filter(|part| part.drive.is_some())
                .count();
            let shown = Exposure::shown(cut.as_ref().map(|cut| &cut.exposure), frames);
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
        let links = turns.iter().map(|turn| turn.link);
        let wanted = match request.name {
            Some(name) => name.to_owned(),
            None => figure_clip::name_of(links),
        };
        let clip = FigureClip {
            name: figure_clip::free_name(&self.clips, group.root, &wanted),
            file: turns[main].link.to_owned(),
            turns: turn::played(turns),
            is_posed: false,
            requested_at: request.span,
            root: group.root,
            parts: figure_clip::part_drives(&group.parts, &matched.matching, |part| {
                self.context.bindings.attributes(part).swing().is_some()
            }),
            motion: Arc::clone(motion),
            cut,
            limited_at: limits.map(|limits| limits.span),
            chosen,
            held_at: held.map(|held| held.span),
            performed: performance.map(|found| Performed {
                file: found.request.file.to_owned(),
                requested_at: found.request.span,
                before: single(main, None),
                channels: found.channels.parts(group),
                tracks: found.tracks,
                plan: found.plan,
            }),
            filmed: filmed.unwrap_or_default(),
            order: bones::nodes(group, &rig),
            retargeted,
            rig,
            animated: Arc::clone(&self.animated),
        };
        self.note_loose(&clip, group, &drawn[main]);
        clip.add_to(scene);
        self.clips.push(clip);
    }

    /// Which drawings of a clip are shown and for how long, and which of them are chosen by hand. `clip` are its frames, the one that
    /// must stay, and whether it is a loop.
    pub(super) fn drawings(
        &self,
        limits: Option<ClipLimits>,
        held: Option<&HeldRequest>,
        measured: impl Fn() -> Arc<Measured>,
        (frames, key_frame, is_loop): (usize, Option<usize>, bool),
        diagnostics: &mut Vec<Diagnostic>,
    ) -> (Option<Arc<Cut>>, Vec<Chosen>) {
        let cut = limits.map(|limits| {
            let amounts = [limits.omit, limits.hold];
            let cut = self.cut(amounts, &measured(), key_frame, is_loop);
            diagnostics::too_limited(&cut, frames, limits.span, diagnostics);
            cut
        });
        let Some(held) = held else {
            return (cut, Vec::new());
        };
        let chosen = held.drawings.iter().map(|(drawing, _)| Chosen {
            source: (drawing.frame - 1) as u32,
            frames: drawing.frames,
        });
        let chosen: Vec<Chosen> = chosen.collect();
        let measured = measured();
        let cut = cut.unwrap_or_else(|| self.cut([0; 2], &measured, key_frame, is_loop));
        let sources = measured.poses().looping(is_loop).count();
        let (cut, conflicts) = limited::by_hand(&cut, &chosen, sources, key_frame);
        diagnostics::not_held(held, &conflicts, sources, diagnostics);
        (Some(Arc::new(cut)), chosen)
    }

    fn note_loose(&mut self, clip: &FigureClip, group: &FigureGroup, rig: &Rig) {
        let loose = holding::loose(self.context, group, rig, &clip.retargeted);
        let parts = loose.iter().filter_map(|loose| {
            let parent = group.parents[loose.part]?;
            Some((group.parts[loose.part], group.parts[parent], loose.growth))
        });
        let parts: Vec<(PartId, PartId, f64)> = parts.collect();
        let worst = |parts: &[(PartId, PartId, f64)]| parts.first().map_or(0.0, |part| part.2);
        let known = self.loose.get(&group.root);
        if worst(&parts) > known.map_or(0.0, |known| worst(&known.parts)) {
            let clip = clip.name.clone();
            self.loose.insert(group.root, LooseParts { clip, parts });
        }
    }

    /// Reports the parts that come off, once per figure.
    pub(super) fn report_loose(&self, diagnostics: &mut Vec<Diagnostic>) {
        for LooseParts { clip, parts } in self.loose.values() {
            diagnostics.extend(super::diagnostics::comes_off(self.context, clip, parts));
        }
    }

    /// A figure as it is drawn.
    fn rig(&self, matched: &MatchedFigure) -> Rig {
        rigging::rig(
            self.context,
            &matched.figure,
            &matched.group,
            &matched.matching,
            self.rest,
        )
    }

    /// A motion on a figure, as it is performed, or as it is.
    fn retargeted(
        &self,
        request: &ClipRequest<'_>,
        turn: &PlayedTurn<'_>,
        rig: &Arc<Rig>,
        performance: Option<&FoundPerformance<'_>>,
    ) -> Arc<RetargetedClip> {
        let (matched, motion) = (&turn.matched, &turn.motion);
        if let Some(moves) = &matched.moves {
            return Arc::new(moves.play(rig, request.is_in_place));
        }
        let ratios = performance.map(|found| found.channels.ratios(&found.plan, matched));
        let ratios = ratios.unwrap_or_default();
        let plan = performance.map(|found| &found.plan);
        let key = RetargetKey {
            rig: Exactly(Arc::clone(rig)),
            motion: Same(Arc::clone(motion)),
            steps: turn.playing.steps,
            plan: plan.map(|plan| Same(Arc::clone(plan))),
            ratios: Exactly(ratios),
        };
        let retargeted = self.memo.get(key, |key| {
            let motion = &key.motion.0;
            let mut turns = Turns::new(&motion.clip, &key.rig.0, &motion.landmarks());
            let last = motion.clip.frames.saturating_sub(1);
            if let Some(timing) = key.plan.as_ref().and_then(|plan| plan.0.timing.as_ref()) {
                turns = turns.timed(timing);
            } else if key.steps != last {
                turns = turns.timed(&TimeMap::through(&[[0, 0], [key.steps, last]]));
            }
            Arc::new(turns.damped(&key.ratios.0).travel())
        });
        if !request.is_in_place {
            return retargeted;
        }
        let group = &matched.group;
        let root = group.parts.position(|part| *part == group.root);
        let key = InPlaceKey {
            retargeted: Same(retargeted),
            root: root.unwrap_or(FigurePartId::from(0)),
            motion: Same(Arc::clone(motion)),
        };
        self.memo.get(key, |key| {
            Arc::new(in_place(&key.retargeted.0, key.root, &key.motion.0))
        })
    }

    pub(super) fn measured(
        &self,
        rig: &Arc<Rig>,
        retargeted: &Arc<RetargetedClip>,
    ) -> Arc<Measured> {
        let key = MeasuredKey(Exactly(Arc::clone(rig)), Same(Arc::clone(retargeted)));
        self.memo.get(key, |MeasuredKey(rig, retargeted)| {
            Arc::new(Measured::of_figure(&rig.0, &retargeted.0))
        })
    }

    fn cut(
        &self,
        amounts: [usize; 2],
        measured: &Arc<Measured>,
        key_frame: Option<usize>,
        is_loop: bool,
    ) -> Arc<Cut> {
        let key = CutKey(Same(Arc::clone(measured)), amounts, key_frame, is_loop);
        self.memo
            .get(key, |CutKey(measured, [omit, hold], key_frame, is_loop)| {
                let (omit, hold) = (*omit, *hold);
                let options = limited::Options {
                    omit,
                    hold,
                    length: Length::Kept,
                };
                let poses = measured.0.poses().keeping(*key_frame).looping(*is_loop);
                Arc::new(limited::limit(poses, &options))
            })
    }

    /// The limits of all clips of a figure that have none of their own.
    pub(super) fn limits(&self, group: &FigureGroup) -> Option<ClipLimits> {
        let bindings = self.context.bindings;
        of_figure(group, |part| bindings.limits_of_clips(part))
    }

    /// The drawings that are chosen by hand for all clips of a figure that have none of their own.
    pub(super) fn held(&self, group: &FigureGroup) -> Option<HeldRequest> {
        let bindings = self.context.bindings;
        of_figure(group, |part| bindings.held_of_clips(part))
    }

    /// The performance of a clip: its own, or else that of all clips of the figure.
    pub(super) fn performance(
        &self,
        request: &ClipRequest<'a>,
        group: &FigureGroup,
    ) -> Option<PerformanceRequest<'a>> {
        let bindings = self.context.bindings;
        let own = request.performance.clone();
        own.or_else(|| of_figure(group, |part| bindings.performance_of_clips(part)))
    }
}

/// What the strings say about a figure: that of any of its parts takes precedence over one for all figures.
pub(super) fn of_figure<T>(
    group: &FigureGroup,
    said: impl Fn(PartId) -> Option<(SetBy, T)>,
) -> Option<T> {
    let parts = std::iter::once(&group.root).chain(&group.parts);
    let said = parts.filter_map(|part| said(*part));
    let (_, first) = said.min_by_key(|(from, _)| *from)?;
    Some(first)
}

/// The clip without the travel of the figure's root over the ground.
fn in_place(clip: &RetargetedClip, root: FigurePartId, motion: &PreparedClip) -> RetargetedClip {
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

    #[test]
    fn in_place_all_nodes_lose_the_travel_of_the_root() {
        let motion = prepare::built_in(BuiltIn::Walk, Legs::Two);
        let path = |x: f64| {
            (0..25)
                .map(|t| DVec3::new(x, 1.0, 2.0 * f64::from(t)))
                .collect()
        };
        let clip = RetargetedClip {
            translations: vec![Some(path(0.0)), None, Some(path(5.0))].into(),
            ..RetargetedClip::default()
        };
        let still = in_place(&clip, 0.into(), &motion);
        for (path, x) in still.translations.iter().flatten().zip([0.0, 5.0]) {
            let place = DVec3::new(x, 1.0, 0.0);
            assert!(path.iter().all(|at| at.distance(place) < 1e-9));
        }
    }
}
