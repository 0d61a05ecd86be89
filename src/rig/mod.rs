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

use crate::bind::Bindings;
use crate::diagnostic::Diagnostic;
use crate::geometry::Frame;
use crate::kept::{Kept, Same};
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::lang::value::Value;
use crate::motion::carry::{self, Carried, Landmarks, Puppet};
use crate::motion::figure::Figure;
use crate::motion::labels::Class;
use crate::motion::limited::{self, Cut, Length};
use crate::motion::matching::{Matching, match_figure};
use crate::resolver::Resolver;
use crate::scene::{Scene, WorldTransform};
use crate::source::Span;
use crate::svg::Drawing;

use cast::Group;
use clips::{Prepared, Stock};
use puppet::Nodes;
pub use puppet::RestNode;
pub use shot::{Driven, Shot, originals};
use tracks::Shown;

/// The most keys of all clips of a drawing: frames × parts.
const MOST_KEYS: usize = 1 << 24;

/// The most figures that are looked at, once for each motion that is meant for them.
const MOST_CASTS: usize = 1 << 18;

/// A clip carried over, with the figure and the clip.
type KeptCarried = Kept<(Puppet, Same<Prepared>), Arc<Carried>>;
/// A clip cut, with how many drawings were to be omitted and how many frames held.
type KeptCut = Kept<([usize; 2], Same<Prepared>), Arc<Cut>>;

/// What the next drawing may have use for.
#[derive(Debug, Default)]
pub struct Memory {
    clips: clips::Memory,
    carried: Vec<KeptCarried>,
    cuts: Vec<KeptCut>,
}

/// A clip that somebody asks for.
struct Wish<'a> {
    /// The part whose string does; `None` for a string that speaks to all figures.
    part: Option<usize>,
    file: &'a str,
    name: Option<&'a str>,
    span: Span,
}

/// What strings ask for, in their order.
fn wishes(bindings: &Bindings) -> Vec<Wish<'_>> {
    let strings = bindings.strings.iter();
    let wishes = strings.flat_map(|string| {
        let part = match string.annotation {
            Annotation::Defaults(_) => Some(None),
            _ => string
                .binding
                .map(|binding| Some(bindings.parts[binding.part].main)),
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
pub struct Stage<'a> {
    /// The drawing.
    pub drawing: &'a Drawing,
    /// Its bindings.
    pub bindings: &'a Bindings,
    /// How it lies in the world.
    pub world: &'a WorldTransform,
    /// Per part its rest frame.
    pub frames: &'a [Frame],
    /// Per main part the parts whose solids are in its node.
    pub members: &'a [Vec<usize>],
}

/// A figure cast for a clip.
struct Role {
    group: Group,
    figure: Figure,
    matching: Matching,
}

/// Adds the clips that strings ask for to the scene, and tells of each what it is. `nodes` are the scene's first ones, parents
/// before children.
pub fn perform(
    stage: &Stage<'_>,
    nodes: impl Iterator<Item = RestNode>,
    resolver: &dyn Resolver,
    memory: &mut Memory,
    scene: &mut Scene,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Shot> {
    let wishes = wishes(stage.bindings);
    if wishes.is_empty() {
        *memory = Memory::default();
        told::without_motion(stage.bindings, diagnostics);
        return Vec::new();
    }
    let nodes = Nodes::new(stage.frames, nodes);
    let groups = cast::groups(stage.bindings);
    let before = std::mem::take(memory);
    let mut theatre = Theatre {
        stage,
        nodes: &nodes,
        carried: before.carried.into_iter(),
        cuts: before.cuts.into_iter(),
        now: Memory::default(),
        gathered: told::Gathered::default(),
        shots: Vec::new(),
    };
    let mut stock = Stock::new(before.clips);
    let (mut keys, mut casts) = (0_usize, 0_usize);
    for wish in &wishes {
        let Some(clip) = stock.get(wish.file, wish.span, resolver, diagnostics) else {
            continue;
        };
        let mut is_played = false;
        for group in groups.iter().filter(|group| group.hears(wish.part)) {
            casts += 1;
            if casts > MOST_CASTS {
                diagnostics.push(told::too_many_casts(wish.span));
                is_played = true;
                break;
            }
            let Some(role) = theatre.cast(group, &clip) else {
                continue;
            };
            is_played = true;
            keys = keys.saturating_add(clip.clip.frames().saturating_mul(group.parts.len()));
            if keys > MOST_KEYS {
                diagnostics.push(told::too_many_keys(wish.span));
                break;
            }
            theatre.play(wish, &role, &clip, scene, diagnostics);
        }
        if !is_played {
            diagnostics.push(told::nobody(wish.span, wish.file));
        }
    }
    let skeleton = theatre.shots.last().map(|shot| &*shot.skeleton);
    theatre.gathered.tell(stage, skeleton, diagnostics);
    *memory = theatre.now;
    memory.clips = stock.into_memory();
    theatre.shots
}

/// Clips on their way to figures.
struct Theatre<'a> {
    stage: &'a Stage<'a>,
    nodes: &'a Nodes,
    carried: std::vec::IntoIter<KeptCarried>,
    cuts: std::vec::IntoIter<KeptCut>,
    now: Memory,
    gathered: told::Gathered,
    shots: Vec<Shot>,
}

impl Theatre<'_> {
    /// Matches a figure with a clip; `None` if no joint drives any part.
    fn cast(&mut self, group: &Group, clip: &Prepared) -> Option<Role> {
        let matched = |group: Group| {
            let figure = puppet::figure(self.stage, &group);
            let matching = match_figure(&figure, &clip.clip.skeleton, &clip.anatomy);
            Role {
                group,
                figure,
                matching,
            }
        };
        let mut role = matched(group.clone());
        let is_hips = |part: &usize| {
            let label = role.matching.labels[*part].as_ref();
            label.is_some_and(|label| label.class == Class::Hips) && group.is_rooted(*part)
        };
        // The hips carry the rest, if no string says otherwise: their travel is the figure's.
        let hips = (0..group.parts.len()).find(is_hips);
        let hips = hips.map(|part| group.parts[part]);
        if let Some(hips) = hips.filter(|hips| *hips != group.root) {
            role = matched(group.clone().rooted_at(hips));
        }
        if role.matching.drives.iter().all(Option::is_none) {
            return None;
        }
        self.gathered.add(&role.group, &role.matching);
        Some(role)
    }

    fn play(
        &mut self,
        wish: &Wish<'_>,
        role: &Role,
        clip: &Arc<Prepared>,
        scene: &mut Scene,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        let group = &role.group;
        let carried = self.carried(role, clip);
        let limits = self.limits(group);
        let cut = limits.map(|(amounts, span)| {
            let cut = self.cut(amounts, clip);
            told::too_limited(&cut, clip.clip.frames(), span, diagnostics);
            cut
        });
        let wanted = wish.name.unwrap_or_else(|| shot::stem(wish.file));
        let name = shot::free_name(&self.shots, group.root, wanted);
        let step = clip.clip.frame_time;
        let (world, nodes) = (self.stage.world, self.nodes);
        let animation =
            |shown: &Shown| tracks::animation(world, nodes, &name, &group.parts, &carried, shown);
        let full = animation(&Shown::full(clip.clip.frames(), step));
        let (shown, full) = match &cut {
            Some(cut) => (animation(&Shown::held(&cut.exposure, step)), Some(full)),
            None => (full, None),
        };
        tracks::add(&mut scene.animations, shown);
        self.shots.push(Shot {
            name,
            file: wish.file.to_owned(),
            asked: wish.span,
            root: group.root,
            parts: shot::driven(&group.parts, &role.matching),
            skeleton: Arc::clone(&clip.clip.skeleton),
            anatomy: Arc::clone(&clip.anatomy),
            frame_time: step,
            speeds: Arc::clone(&clip.speeds),
            cut,
            limited: limits.map(|(_, span)| span),
            full,
        });
    }

    fn carried(&mut self, role: &Role, clip: &Arc<Prepared>) -> Arc<Carried> {
        let puppet = puppet::puppet(&role.figure, &role.group, &role.matching, self.nodes);
        let mut kept = self.carried.next().unwrap_or_default();
        let carried = kept.get((puppet, Same(Arc::clone(clip))), |(puppet, clip)| {
            let landmarks = Landmarks::of(&clip.0.anatomy);
            Arc::new(carry::carry(&clip.0.clip, puppet, &landmarks))
        });
        self.now.carried.push(kept);
        carried
    }

    fn cut(&mut self, amounts: [usize; 2], clip: &Arc<Prepared>) -> Arc<Cut> {
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
        cut
    }

    /// How many drawings of a figure's clips are omitted and how many frames held, and where that is said.
    fn limits(&self, group: &Group) -> Option<([usize; 2], Span)> {
        let bindings = self.stage.bindings;
        let said = |part: usize| {
            let source = bindings.setting(part, Keyword::Limited)?;
            let Value::Pair(amounts) = source.setting.value else {
                return None;
            };
            let span = bindings.strings[source.string]
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
