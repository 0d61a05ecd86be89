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
mod holding;
mod limbless;
mod lying;
mod measured;
mod missing_files;
mod motion_files;
mod moves;
mod performances;
mod performed;
mod rigging;
mod surface;
mod tracks;

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
use crate::svg::Drawing;

pub(crate) use bends::bends;
use builder::{ClipBuilder, Requested};
use diagnostics::MatchProblems;
pub(crate) use effects::{Performance, PerformedMark};
pub(crate) use facings::{FigureFacing, facings, seen};
pub use figure_clip::FigureClip;
pub(crate) use figure_clip::{PartDrive, originals};
pub(crate) use figures::FigureGroup;
pub(crate) use figures::find as find_figures;
use limbless::Misfit;
use motion_files::MotionFiles;
use moves::Roles;
use performances::Performances;
pub(crate) use performed::Performed;
pub(crate) use rigging::RestNode;
use rigging::RestNodes;
use tracks::AnimatedNodes;

/// The most keys of all clips of a drawing: frames × parts.
const MAX_KEYS: usize = 1 << 24;

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
    if requests.is_empty() {
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
    let (mut keys, mut matches) = (0_usize, 0_usize);
    for request in &requests {
        let (link, motion) = match request.source {
            MotionSource::File(link) => {
                let motion = files.get(link, request, resolver, memo, diagnostics);
                (link.as_str(), motion.map(Motion::File))
            }
            MotionSource::BuiltIn(word) => {
                (word.as_str(), BuiltIn::from_name(word).map(Motion::BuiltIn))
            }
            MotionSource::Fitting => ("", Some(Motion::Fitting)),
        };
        let Some(motion) = motion else {
            continue;
        };
        let mut is_played = false;
        let mut limbless = Vec::new();
        let mut misfits = Vec::new();
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
            let roles = group.parts.position(|part| *part == group.root);
            let roles = Roles::find(&figure, roles.unwrap_or(FigurePartId::from(0)));
            let fitting = roles.fitting();
            let which = match &motion {
                Motion::File(_) => None,
                Motion::BuiltIn(which) => Some(*which),
                Motion::Fitting => Some(fitting),
            };
            let link: &str = match which {
                Some(which) => which.name(),
                None => link,
            };
            let (matched, motion) = match (&motion, which) {
                (_, Some(which)) if which.moves_parts() => {
                    misfits.extend(Misfit::find(context, group, which, &roles));
                    let (matched, motion) = builder.moved(which, group, figure, roles);
                    (Some(matched), motion)
                }
                (_, Some(which)) => {
                    let motion = builder.built_in(which, &figure);
                    (builder.match_figure(group, figure, &motion), motion)
                }
                (Motion::File(motion), None) => (
                    builder.match_figure(group, figure, motion),
                    Arc::clone(motion),
                ),
                (_, None) => continue,
            };
            let Some(matched) = matched else {
                continue;
            };
            is_played = true;
            limbless.extend(limbless::find(context, which, &matched, fitting));
            keys = keys.saturating_add(motion.clip.frames.saturating_mul(group.parts.len()));
            if keys > MAX_KEYS {
                diagnostics.push(diagnostics::too_many_keys(request.span));
                break;
            }
            let performance = builder.performance(request, &matched.group);
            if let Some(request) = performance.as_ref().filter(|_| matched.moves.is_some()) {
                diagnostics.push(diagnostics::unperformed(request, link));
            }
            let performance = performance.filter(|_| matched.moves.is_none());
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
        limbless::report(&limbless, link, request.span, diagnostics);
        limbless::report_misfits(&misfits, request.span, diagnostics);
        if !is_played {
            diagnostics.push(diagnostics::idle_motion(request.span, link));
        }
    }
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
