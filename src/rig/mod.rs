//! Clips of motion capture on the figures of a drawing (docs/motion.md).
//!
//! A figure is a group of parts that are connected, by strings or because they touch. Each clip becomes an animation of the nodes
//! of a figure's parts; figures that play clips of the same name share one animation.

mod bends;
mod bones;
mod builder;
mod diagnostics;
mod effects;
mod facings;
mod figure_clip;
mod figures;
#[cfg(test)]
mod fixtures;
mod holding;
mod keys;
mod limbless;
mod lying;
mod measured;
mod missing_files;
mod motion_files;
mod moves;
mod performances;
mod performed;
mod poses;
mod rigging;
mod surface;
mod tracks;
mod turn;

use std::collections::BTreeMap;
use std::sync::Arc;

use typed_index_collections::{TiSlice, TiVec};

pub(crate) use crate::labels::FigurePartId;
pub(crate) use crate::mocap::JointId;

use crate::bend::Bend;
use crate::bind::{Bindings, MotionSource, PartId};
use crate::clips::BuiltIn;
use crate::diagnostic::Diagnostic;
use crate::geometry::{Frame, Thickness};
use crate::memo::Memo;
use crate::prepare::PreparedClip;
use crate::resolver::Resolver;
use crate::scene::{NodeId, Scene, WorldTransform};
use crate::source::Span;
use crate::svg::Drawing;

pub(crate) use bends::{bends, idle_bends};
use builder::{ClipBuilder, Requested};
use diagnostics::MatchProblems;
pub(crate) use effects::{Performance, PerformedMark};
pub(crate) use facings::{FigureFacing, facings, seen};
pub use figure_clip::FigureClip;
pub(crate) use figure_clip::{PartDrive, originals};
pub(crate) use figures::FigureGroup;
pub(crate) use figures::find as find_figures;
use keys::Keys;
use limbless::{Limbless, Misfit};
use motion_files::MotionFiles;
use moves::Roles;
use performances::Performances;
pub(crate) use performed::Performed;
pub(crate) use poses::{Copies, KeptPoses, key_moments};
pub(crate) use rigging::RestNode;
use rigging::RestNodes;
use tracks::AnimatedNodes;
use turn::PlayedTurn;

/// How often a figure is matched with a motion at most.
const MAX_MATCHES: usize = 1 << 18;

/// The drawing whose figures are animated.
pub(crate) struct Context<'a> {
    /// The drawing.
    pub drawing: &'a Drawing,
    /// Its bindings.
    pub bindings: &'a Bindings,
    /// From the drawing's axes to the world's.
    pub world: &'a WorldTransform,
    /// Per part its rest frame.
    pub frames: &'a TiSlice<PartId, Frame>,
    /// Per main part the parts whose solids are in its node.
    pub parts_of_node: &'a TiSlice<PartId, Vec<PartId>>,
    /// Per main part how it bends; `None` for one that is rigid.
    pub bends: &'a TiSlice<PartId, Option<Arc<Bend>>>,
    /// Per part the thickness of its solid, `None` without one.
    pub thicknesses: &'a TiSlice<PartId, Option<Thickness>>,
}

/// A motion that a string asks for.
enum Motion {
    /// That of a file.
    File(Arc<PreparedClip>),
    /// A built-in one: which clip it is depends on the figure.
    BuiltIn(BuiltIn),
    /// The built-in one that fits the figure.
    Fitting,
}

/// What is found about one of the motions that a string asks for, on all figures that play it.
struct Findings<'a> {
    /// The file or the word.
    link: &'a str,
    span: Span,
    is_played: bool,
    limbless: Vec<Limbless>,
    misfits: Vec<Misfit>,
}

impl<'a> Findings<'a> {
    fn new(link: &'a str, span: Span) -> Self {
        Self {
            link,
            span,
            is_played: false,
            limbless: Vec::new(),
            misfits: Vec::new(),
        }
    }

    fn report(&self, diagnostics: &mut Vec<Diagnostic>) {
        limbless::report(&self.limbless, self.link, self.span, diagnostics);
        limbless::report_misfits(&self.misfits, self.span, diagnostics);
        if !self.is_played {
            diagnostics.push(diagnostics::idle_motion(self.span, self.link));
        }
    }
}

/// Adds the clips that strings ask for to the scene, and returns what they are. `nodes` are the scene's first nodes, parents before
/// children.
pub(crate) fn add_clips(
    context: &Context<'_>,
    nodes: TiVec<NodeId, RestNode>,
    resolver: &dyn Resolver,
    memo: &Memo,
    scene: &mut Scene,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<FigureClip> {
    let requests = context.bindings.clip_requests();
    if requests.is_empty() && context.bindings.poses.is_empty() {
        return Vec::new();
    }
    let rest = RestNodes::new(context.frames, &nodes.raw);
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
        loose: BTreeMap::new(),
    };
    let (mut files, mut performances) = (MotionFiles::default(), Performances::default());
    let (mut keys, mut matches) = (Keys::of(context.drawing.budget), 0_usize);
    for request in &requests {
        let is_single = request.turns.len() == 1;
        let mut motions = Vec::with_capacity(request.turns.len());
        for turn in &request.turns {
            let span = if is_single {
                request.span
            } else {
                turn.source_span()
            };
            let (link, motion) = match &turn.motion.source {
                MotionSource::File(link) => {
                    // Of several motions, all together are the loop.
                    let is_loop = request.is_loop && is_single;
                    let motion = files.get(turn, is_loop, span, resolver, memo, diagnostics);
                    (link.as_str(), motion.map(Motion::File))
                }
                MotionSource::BuiltIn(word) => {
                    (word.as_str(), BuiltIn::from_name(word).map(Motion::BuiltIn))
                }
                MotionSource::Fitting => ("", Some(Motion::Fitting)),
            };
            if let Some(motion) = motion {
                motions.push((turn, motion, Findings::new(link, span)));
            }
        }
        if motions.is_empty() {
            continue;
        }
        for group in groups
            .iter()
            .filter(|group| group.is_addressed_by(request.part))
        {
            matches += motions.len();
            if matches > MAX_MATCHES {
                diagnostics.push(diagnostics::too_many_matches(request.span));
                motions.clear();
                break;
            }
            let figure = rigging::drawn_figure(context, group);
            let root = group.parts.position(|part| *part == group.root);
            let roles = Roles::find(&figure, root.unwrap_or(FigurePartId::from(0)));
            let fitting = roles.fitting();
            let mut turns = Vec::with_capacity(motions.len());
            for (turn, motion, findings) in &mut motions {
                let which = match motion {
                    Motion::File(_) => None,
                    Motion::BuiltIn(which) => Some(*which),
                    Motion::Fitting => Some(fitting),
                };
                let (matched, motion) = match (which, motion) {
                    (Some(which), _) if which.moves_parts() => {
                        let misfit = Misfit::find(context, group, which, &roles);
                        findings.misfits.extend(misfit);
                        let (figure, roles) = (figure.clone(), roles.clone());
                        let speed = turn.motion.speed;
                        let (matched, motion) = builder.moved(which, speed, group, figure, roles);
                        (Some(matched), motion)
                    }
                    (Some(which), _) => {
                        let motion = builder.built_in(which, &figure);
                        (builder.match_figure(group, figure.clone(), &motion), motion)
                    }
                    (None, Motion::File(motion)) => (
                        builder.match_figure(group, figure.clone(), motion),
                        Arc::clone(motion),
                    ),
                    (None, _) => continue,
                };
                let Some(matched) = matched else {
                    continue;
                };
                findings.is_played = true;
                let limbless = limbless::find(context, which, &matched, fitting);
                findings.limbless.extend(limbless);
                let link: &str = match which {
                    Some(which) => which.name(),
                    None => findings.link,
                };
                turns.push(PlayedTurn::new(link, matched, motion, turn.motion));
            }
            let Some(first) = turns.first() else {
                continue;
            };
            if let Err(excess) = keys.add_turns(context, &turns) {
                diagnostics.push(diagnostics::too_many_keys(&excess, request.span));
                break;
            }
            let performance = builder.performance(request, &first.matched.group);
            let unperformed = performance.as_ref().and_then(|request| {
                if turns.len() > 1 || first.playing.cycles > 1 {
                    Some(diagnostics::unperformed_turns(request))
                } else if first.matched.moves.is_some() {
                    Some(diagnostics::unperformed(request, first.link))
                } else {
                    None
                }
            });
            let performance = performance.filter(|_| unperformed.is_none());
            diagnostics.extend(unperformed);
            let performance = performance.and_then(|request| {
                let tracks = performances.get(&request, resolver, memo, diagnostics)?;
                let (matched, motion) = (&first.matched, &first.motion);
                let found = builder.perform(request, &tracks, matched, motion, diagnostics);
                let marks = found.iter().flat_map(|found| found.channels.marks());
                performances.note_used(&found.as_ref()?.request, &tracks, marks);
                found
            });
            if let Some(found) = &performance
                && let Err(excess) = keys.add_performed(context, first, found.plan.frames(0))
            {
                diagnostics.push(diagnostics::too_many_keys(&excess, request.span));
                break;
            }
            let requested = Requested {
                request,
                turns: &turns,
                performance,
            };
            builder.add_clip(requested, scene, diagnostics);
        }
        for (_, _, findings) in &motions {
            findings.report(diagnostics);
        }
    }
    poses::add(&mut builder, &groups, &mut keys, scene, diagnostics);
    let skeleton = builder.clips.last().map(|clip| clip.skeleton());
    builder.report_loose(diagnostics);
    builder.problems.report(context, skeleton, diagnostics);
    performances.report_unused(diagnostics);
    builder.clips
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
}
