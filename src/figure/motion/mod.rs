//! Clips of motion capture on the figures of a drawing (motion.md).
//!
//! A figure is what hangs together, by strings or because it touches. Each clip becomes an animation of its parts' nodes; what figures
//! play under one name is one animation.

mod cast;
mod clips;
mod puppet;
mod shot;
mod told;
mod tracks;

use std::sync::Arc;

use super::Model;
use super::assemble::Stage;
use crate::diagnostic::Diagnostic;
use crate::kept::{Kept, Same};
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::lang::value::Value;
use crate::motion::carry::{self, Carried, Landmarks, Puppet};
use crate::motion::labels::Class;
use crate::motion::limited::{self, Cut, Length};
use crate::motion::matching::{Matching, match_figure};
use crate::resolver::Resolver;
use crate::scene::Scene;
use crate::source::Span;

use cast::Group;
use clips::{Prepared, Stock};
pub(super) use puppet::Nodes;
pub use shot::{Driven, Shot, originals};
use tracks::Shown;

/// The most keys of all clips of a drawing: frames × parts.
const MOST_KEYS: usize = 1 << 26;

/// What the next drawing may have use for.
#[derive(Debug, Default)]
pub(super) struct Memory {
    clips: clips::Memory,
    carried: Vec<Kept<(Puppet, Same<Prepared>), Arc<Carried>>>,
    cuts: Vec<Kept<([usize; 2], Same<Prepared>), Arc<Cut>>>,
}

/// A clip that somebody asks for.
pub(super) struct Wish<'a> {
    /// The part whose string does; `None` for a string that speaks to all figures.
    part: Option<usize>,
    file: &'a str,
    name: Option<&'a str>,
    span: Span,
}

/// What strings ask for, in their order.
pub(super) fn wishes<'a>(model: &Model<'a>) -> Vec<Wish<'a>> {
    let strings = model.sheet.strings.iter();
    let wishes = strings.flat_map(|string| {
        let part = match string.annotation {
            Annotation::Defaults(_) => Some(None),
            _ => string
                .binding
                .map(|binding| Some(model.sheet.parts[binding.part].main)),
        };
        string
            .settings
            .iter()
            .filter_map(move |setting| match &setting.value {
                Value::Motion { file, clip } => Some(Wish {
                    part: part?,
                    file,
                    name: clip.as_deref(),
                    span: string.text.span(setting.range.clone()),
                }),
                _ => None,
            })
    });
    wishes.collect()
}

/// What is known of a drawing's figures when clips are put on them.
pub(super) struct Ground<'a> {
    pub(super) stage: &'a Stage,
    pub(super) nodes: &'a Nodes,
    /// Per main part the parts whose solids are in its node.
    pub(super) members: &'a [Vec<usize>],
}

/// Adds the clips that strings ask for to the scene, and tells of each what it is.
pub(super) fn perform(
    model: &Model<'_>,
    wishes: &[Wish<'_>],
    ground: &Ground<'_>,
    resolver: &dyn Resolver,
    memory: &mut Memory,
    scene: &mut Scene,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Shot> {
    let groups = cast::groups(model);
    let before = std::mem::take(memory);
    let mut theatre = Theatre {
        model,
        ground,
        carried: before.carried.into_iter(),
        cuts: before.cuts.into_iter(),
        now: Memory::default(),
        gathered: told::Gathered::default(),
        shots: Vec::new(),
    };
    let mut stock = Stock::new(before.clips);
    let mut keys = 0_usize;
    for wish in wishes {
        let Some(clip) = stock.get(wish.file, wish.span, resolver, diagnostics) else {
            continue;
        };
        let mut is_played = false;
        for group in groups.iter().filter(|group| group.hears(wish.part)) {
            let Some((group, figure, matching)) = theatre.cast(group, &clip) else {
                continue;
            };
            is_played = true;
            keys = keys.saturating_add(clip.clip.frames().saturating_mul(group.parts.len()));
            if keys > MOST_KEYS {
                diagnostics.push(told::too_many_keys(wish.span));
                break;
            }
            theatre.play(wish, &group, &figure, &matching, &clip, scene, diagnostics);
        }
        if !is_played {
            diagnostics.push(told::nobody(wish.span, wish.file));
        }
    }
    let skeleton = theatre.shots.last().map(|shot| &*shot.skeleton);
    theatre.gathered.tell(model, skeleton, diagnostics);
    *memory = theatre.now;
    memory.clips = stock.into_memory();
    theatre.shots
}

/// Says what has no effect in a drawing without motions.
pub(super) fn without(model: &Model<'_>, diagnostics: &mut Vec<Diagnostic>) {
    told::without_motion(model.sheet, diagnostics);
}

/// Clips on their way to figures.
struct Theatre<'a> {
    model: &'a Model<'a>,
    ground: &'a Ground<'a>,
    carried: std::vec::IntoIter<Kept<(Puppet, Same<Prepared>), Arc<Carried>>>,
    cuts: std::vec::IntoIter<Kept<([usize; 2], Same<Prepared>), Arc<Cut>>>,
    now: Memory,
    gathered: told::Gathered,
    shots: Vec<Shot>,
}

impl Theatre<'_> {
    /// Matches a figure with a clip; `None` if no joint drives any part.
    fn cast(
        &mut self,
        group: &Group,
        clip: &Prepared,
    ) -> Option<(Group, crate::motion::figure::Figure, Matching)> {
        let matched = |group: &Group| {
            let figure = puppet::figure(self.model, group, self.ground.members);
            let matching = match_figure(&figure, &clip.clip.skeleton, &clip.anatomy);
            (figure, matching)
        };
        let (figure, matching) = matched(group);
        let is_hips = |part: &usize| {
            let label = matching.labels[*part].as_ref();
            label.is_some_and(|label| label.class == Class::Hips) && group.is_rooted(*part)
        };
        // The hips carry the rest, if no string says otherwise: their travel is the figure's.
        let hips = (0..group.parts.len())
            .find(is_hips)
            .map(|part| group.parts[part]);
        let (group, figure, matching) = match hips.filter(|hips| *hips != group.root) {
            Some(hips) => {
                let group = group.clone().rooted_at(hips);
                let (figure, matching) = matched(&group);
                (group, figure, matching)
            }
            None => (group.clone(), figure, matching),
        };
        let is_driven = matching.drives.iter().any(Option::is_some);
        if is_driven {
            self.gathered.add(&group, &matching);
        }
        is_driven.then_some((group, figure, matching))
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "a clip, a figure, and where they meet"
    )]
    fn play(
        &mut self,
        wish: &Wish<'_>,
        group: &Group,
        figure: &crate::motion::figure::Figure,
        matching: &Matching,
        clip: &Arc<Prepared>,
        scene: &mut Scene,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        let puppet = puppet::puppet(figure, group, matching, self.ground.nodes);
        let mut kept = self.carried.next().unwrap_or_default();
        let carried = kept.get((puppet, Same(Arc::clone(clip))), |(puppet, clip)| {
            let landmarks = Landmarks::of(&clip.0.anatomy);
            Arc::new(carry::carry(&clip.0.clip, puppet, &landmarks))
        });
        self.now.carried.push(kept);
        let limits = self.limits(group);
        let cut = limits.map(|(amounts, span)| {
            let mut kept = self.cuts.next().unwrap_or_default();
            let cut = kept.get((amounts, Same(Arc::clone(clip))), |([omit, hold], clip)| {
                let options = limited::Options {
                    omit: *omit,
                    hold: *hold,
                    length: Length::Kept,
                };
                Arc::new(clip.0.cut(&options))
            });
            self.now.cuts.push(kept);
            told::too_limited(&cut, clip.clip.frames(), span, diagnostics);
            cut
        });
        let wanted = wish.name.unwrap_or_else(|| shot::stem(wish.file));
        let name = shot::free_name(&self.shots, group.root, wanted);
        let step = clip.clip.frame_time;
        let full = Shown::full(clip.clip.frames(), step);
        let full = tracks::animation(
            self.ground,
            self.model.scale,
            &name,
            &group.parts,
            &carried,
            &full,
        );
        let full = match &cut {
            Some(cut) => {
                let held = Shown::held(&cut.exposure, step);
                let held = tracks::animation(
                    self.ground,
                    self.model.scale,
                    &name,
                    &group.parts,
                    &carried,
                    &held,
                );
                tracks::add(&mut scene.animations, held);
                Some(full)
            }
            None => {
                tracks::add(&mut scene.animations, full);
                None
            }
        };
        self.shots.push(Shot {
            name,
            file: wish.file.to_owned(),
            asked: wish.span,
            root: group.root,
            parts: shot::driven(&group.parts, matching),
            skeleton: Arc::clone(&clip.clip.skeleton),
            anatomy: Arc::clone(&clip.anatomy),
            frame_time: step,
            speeds: Arc::clone(&clip.speeds),
            cut,
            limited: limits.map(|(_, span)| span),
            full,
        });
    }

    /// How many drawings of a figure's clips are omitted and how many frames held, and where that is said.
    fn limits(&self, group: &Group) -> Option<([usize; 2], Span)> {
        let sheet = self.model.sheet;
        let said = |part: usize| {
            let source = sheet.setting(part, Keyword::Limited)?;
            let Value::Pair(amounts) = source.setting.value else {
                return None;
            };
            let span = sheet.strings[source.string]
                .text
                .span(source.setting.range.clone());
            Some((amounts.map(|amount| amount as usize), span, source.from))
        };
        // What the string of any part of the figure says counts more than what is said to all.
        let all = std::iter::once(group.root)
            .chain(group.parts.iter().copied())
            .filter_map(said);
        let (amounts, span, _) = all.min_by_key(|(_, _, from)| *from as usize)?;
        Some((amounts, span))
    }
}
