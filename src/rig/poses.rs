//! Clips from key poses: each part turns about its joint from one drawn pose to the next.
//!
//! A part's pose is its turn relative to what it hangs on, so that a part without a copy moves with that. Only parts without a parent by
//! their string also move.

mod kept;
mod recorded;

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DAffine2, DQuat, DVec2};
use typed_index_collections::{TiVec, ti_vec};

use super::Context;
use super::bones;
use super::builder::ClipBuilder;
use super::diagnostics;
use super::figure_clip::{self, FigureClip, FigureTurn};
use super::figures::FigureGroup;
use super::keys::Keys;
use super::moves::Roles;
use super::rigging;
use crate::bind::{ClipLimits, KeyPose, PartId};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::y_up;
use crate::labels::{Figure, FigurePartId};
use crate::math;
use crate::mocap::resample::FPS;
use crate::mocap::{JointId, Transform};
use crate::performance::Filmed;
use crate::prepare::{self, PreparedClip};
use crate::retarget::{Drive, Follow, MatchedPart, Matching, RestSource, RetargetedClip, Rig};
use crate::scene::Scene;
use crate::source::Span;

pub(crate) use kept::{Copies, KeptPoses};
pub(crate) use recorded::{KeyBefore, key_moments};

/// The name of a clip whose strings give none.
const NAME: &str = "poses";
/// A pose that is kept on the page follows the first one after so many seconds.
const SEQUENCE_STEP: f64 = 0.5;
/// A copy may lie beside its joint by this share of the part's length.
const OFF_JOINT: f64 = 0.05;
/// Poses are the same if no part turns by more than this between them, radians, and none moves by more than this share of the figure's
/// height.
const SAME: f64 = 1e-3;

/// The pose of a part relative to what it hangs on.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Turned {
    /// Radians, counter-clockwise.
    angle: f64,
    /// By how much its joint is moved, drawing units, y up.
    shift: DVec2,
}

/// The key poses of a clip of a figure.
#[derive(Debug, PartialEq)]
struct PosedClip {
    /// The frame of each pose, ascending from 0.
    frames: Vec<usize>,
    /// Per part its poses; `None` if it has the drawn one in all of them.
    parts: TiVec<FigurePartId, Option<Vec<Turned>>>,
    /// Whether it ends as it begins.
    is_loop: bool,
    /// The `Limited` of its strings.
    limits: Option<ClipLimits>,
}

/// A clip of key poses, and the figure that plays it.
struct PosedFigure<'a> {
    /// The name of the clip.
    name: &'a str,
    /// Where its first pose is asked for.
    span: Span,
    group: &'a FigureGroup,
    figure: Figure,
    matching: Matching,
    /// How long it is.
    motion: PreparedClip,
    clip: PosedClip,
}

/// Key poses of one clip, in the order of their layers.
type Sequence<'a> = (&'a str, Vec<&'a KeyPose>);

/// Adds the clips of a drawing's key poses.
pub(super) fn add(
    builder: &mut ClipBuilder<'_>,
    groups: &[FigureGroup],
    keys: &mut Keys,
    scene: &mut Scene,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let context = builder.context;
    for group in groups {
        for (name, poses) in sequences(group, &context.bindings.poses, diagnostics) {
            let figure = rigging::drawn_figure(context, group);
            let root = group.parts.position(|part| *part == group.root);
            let roles = Roles::find(&figure, root.unwrap_or(FigurePartId::from(0)));
            let Some(clip) = PosedClip::read(builder, group, &figure, &poses, diagnostics) else {
                continue;
            };
            let Some(span) = poses.first().map(|pose| pose.span) else {
                continue;
            };
            let moving = clip.parts.iter().flatten().count();
            if let Err(excess) = keys.add_posed(moving, clip.length()) {
                diagnostics.push(diagnostics::too_many_keys(&excess, span));
                return;
            }
            let names = group.parts.iter();
            let names = names.map(|part| context.bindings.parts[*part].name.as_str());
            let names: Vec<&str> = names.collect();
            let motion = prepare::of_parts(&names, clip.length());
            let matching = clip.matching(&roles, &names);
            let posed = PosedFigure {
                name,
                span,
                group,
                figure,
                matching,
                motion,
                clip,
            };
            builder.add_posed(posed, scene, diagnostics);
        }
    }
}

impl ClipBuilder<'_> {
    /// Adds a clip of key poses.
    fn add_posed(
        &mut self,
        posed: PosedFigure<'_>,
        scene: &mut Scene,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        let PosedFigure {
            name,
            span,
            group,
            figure,
            matching,
            motion,
            clip: posed,
        } = posed;
        let rig = Arc::new(rigging::rig(
            self.context,
            &figure,
            group,
            &matching,
            self.rest,
        ));
        let retargeted = Arc::new(posed.play(&rig));
        let frames = retargeted.grounded.len();
        let limits = posed.limits().or_else(|| self.limits(group));
        // What is said of all clips may be too much for a short one.
        let mut of_all = Vec::new();
        let findings = match posed.limits() {
            Some(_) => diagnostics,
            None => &mut of_all,
        };
        let held = self.held(group);
        let (cut, chosen) = self.drawings(
            limits,
            held.as_ref(),
            || self.measured(&rig, &retargeted),
            (frames, None, posed.is_loop()),
            findings,
        );
        let word = KeyPose::word().to_owned();
        let clip = FigureClip {
            name: figure_clip::free_name(&self.clips, group.root, name),
            file: word.clone(),
            turns: vec![FigureTurn {
                file: word,
                first: 0,
                steps: frames - 1,
                cycles: 1,
            }],
            is_posed: true,
            requested_at: span,
            root: group.root,
            parts: figure_clip::part_drives(&group.parts, &matching, |_| false),
            motion: Arc::new(motion),
            cut,
            limited_at: limits.map(|limits| limits.span),
            chosen,
            held_at: held.map(|held| held.span),
            performed: None,
            filmed: Filmed::default(),
            order: bones::nodes(group, &rig),
            retargeted,
            rig,
            animated: Arc::clone(&self.animated),
        };
        clip.add_to(scene);
        self.clips.push(clip);
    }
}

/// The clips of a figure's key poses, each with its poses in order; reports those that are out of order.
fn sequences<'a>(
    group: &FigureGroup,
    poses: &'a [KeyPose],
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Sequence<'a>> {
    let is_own = |part: &PartId| group.parts.contains(part);
    let mut clips: Vec<Sequence<'a>> = Vec::new();
    for pose in poses {
        // A pose without copies of the figure is one of another figure, unless the string says that it is of this one.
        let is_posed = pose.parts.iter().any(|posed| is_own(&posed.part));
        if !is_posed || pose.actor.is_some_and(|actor| !is_own(&actor)) {
            continue;
        }
        let name = pose.clip.as_deref().unwrap_or(NAME);
        let known = clips.iter().position(|(known, _)| *known == name);
        let Some(known) = known else {
            clips.push((name, vec![pose]));
            continue;
        };
        let others = &mut clips[known].1;
        match others.last().filter(|last| last.seconds >= pose.seconds) {
            Some(last) => {
                let (seconds, before) = (pose.seconds, last.seconds);
                let message = format!(
                    "this key pose is left out: it is at {seconds} seconds, and the one in the layer below it at {before}"
                );
                diagnostics.push(
                    Diagnostic::new(Code::PoseOrder, pose.span, message)
                        .related(last.span, "the pose before")
                        .help("order the layers as they play, from bottom to top, or give this one a later second"),
                );
            }
            None => others.push(pose),
        }
    }
    clips
}

impl PosedClip {
    /// The poses on a figure; `None` if nothing moves. Reports copies that are off their joints.
    fn read(
        builder: &ClipBuilder<'_>,
        group: &FigureGroup,
        figure: &Figure,
        poses: &[&KeyPose],
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Self> {
        let Context {
            drawing, bindings, ..
        } = builder.context;
        let mut frames = vec![];
        let mut keys: Vec<TiVec<FigurePartId, Turned>> = vec![];
        let mut now: TiVec<FigurePartId, Turned> = ti_vec![Turned::default(); group.parts.len()];
        if poses.first().is_some_and(|first| first.seconds > 0.0) {
            frames.push(0);
            keys.push(now.clone());
        }
        for pose in poses {
            advance(&mut now, group, figure, pose, |part, shift, length| {
                let copy = pose.parts.iter().find(|posed| posed.part == part);
                let name = bindings.describe_as_drawn(drawing, part);
                diagnostics.extend(copy.map(|copy| off_joint(&name, shift, length, copy.copy)));
            });
            let frame = (pose.seconds * FPS).round() as usize;
            // Two poses in one frame follow each other as fast as they can.
            let frame = frames.last().map_or(frame, |last| frame.max(last + 1));
            frames.push(if keys.is_empty() { 0 } else { frame });
            keys.push(now.clone());
        }
        let bounds = figure.parts.iter().map(|part| part.bounds);
        let [low, high] = bounds.fold(
            [DVec2::INFINITY, DVec2::NEG_INFINITY],
            |[low, high], [from, to]| [low.min(from), high.max(to)],
        );
        let reach = SAME * (high - low).max_element();
        let is_same = |one: &Turned, other: &Turned| {
            (one.angle - other.angle).abs() <= SAME && one.shift.distance(other.shift) <= reach
        };
        let is_loop = poses.iter().any(|pose| pose.is_loop);
        if is_loop
            && let ([first, .., last], [.., before, end]) = (keys.as_slice(), frames.as_slice())
        {
            let closing: TiVec<FigurePartId, Turned> = first
                .iter()
                .zip(last)
                .map(|(first, last)| Turned {
                    // Back by the short way, too.
                    angle: last.angle + (first.angle - last.angle + PI).rem_euclid(TAU) - PI,
                    shift: first.shift,
                })
                .collect();
            let is_closed = closing
                .iter()
                .zip(last)
                .all(|(one, other)| is_same(one, other));
            if !is_closed {
                let next = end + (end - before);
                frames.push(next);
                keys.push(closing);
            }
        }
        let parts = group.parts.keys().map(|part| {
            let own: Vec<Turned> = keys.iter().map(|key| key[part]).collect();
            let moves = own
                .iter()
                .any(|turned| !is_same(turned, &Turned::default()));
            moves.then_some(own)
        });
        let parts: TiVec<FigurePartId, _> = parts.collect();
        let moves = parts.iter().any(Option::is_some);
        moves.then_some(Self {
            frames,
            parts,
            is_loop,
            limits: poses.iter().find_map(|pose| pose.limits),
        })
    }

    /// The number of frames.
    fn length(&self) -> usize {
        self.frames.last().map_or(1, |last| last + 1)
    }

    /// Whether it ends as it begins.
    fn is_loop(&self) -> bool {
        self.is_loop
    }

    /// The `Limited` of its strings.
    fn limits(&self) -> Option<ClipLimits> {
        self.limits
    }

    /// Which parts move, as if joints of their own names drove them.
    fn matching(&self, roles: &Roles, names: &[&str]) -> Matching {
        let part = |part: FigurePartId| {
            let moves = self.parts[part].is_some();
            MatchedPart {
                label: roles.label(part),
                splayed: false,
                bones: Vec::default(),
                drive: moves.then_some(Drive {
                    joint: JointId::from(usize::from(part)),
                    tip: None,
                    follow: Follow::Change,
                }),
                why: match moves {
                    true => "its copies in the pose layers turn it".to_owned(),
                    false => format!("no pose layer turns `{}`", names[usize::from(part)]),
                },
            }
        };
        Matching {
            parts: self.parts.keys().map(part).collect(),
            facing: roles.facing(),
            problems: Vec::new(),
        }
    }

    /// The clip on the figure's rig, at its place or in place.
    fn play(&self, rig: &Rig) -> RetargetedClip {
        let count = rig.parts.len();
        let frames = self.length();
        // Bones inside of parts, which follow behind the parts of the figure, keep their pose.
        let curves: TiVec<FigurePartId, Option<Vec<Turned>>> = rig
            .parts
            .keys()
            .map(|part| {
                let keys = self.parts.get(part)?.as_ref()?;
                Some(self.curve(keys))
            })
            .collect();
        let mut rotations: TiVec<FigurePartId, Option<Vec<DQuat>>> = vec![None; count].into();
        let mut translations: TiVec<FigurePartId, Option<Vec<_>>> = vec![None; count].into();
        let order = rig.order();
        let mut placed: TiVec<FigurePartId, DAffine2> = ti_vec![DAffine2::IDENTITY; count];
        let mut nodes: TiVec<FigurePartId, Transform> =
            rig.parts.iter().map(|part| part.node).collect();
        for frame in 0..frames {
            for &index in &order {
                let part = &rig.parts[index];
                let above = part
                    .parent
                    .map_or(DAffine2::IDENTITY, |parent| placed[parent]);
                let turned = curves[index].as_ref().map(|curve| curve[frame]);
                let own = turned.map_or(DAffine2::IDENTITY, |turned| {
                    about(part.joint.truncate(), turned)
                });
                placed[index] = above * own;
                let rest = part.node;
                let place = placed[index].transform_point2(rest.position.truncate());
                let turn = math::rotation_z(angle_of(placed[index]));
                nodes[index] = Transform {
                    rotation: (turn * rest.rotation).normalize(),
                    position: place.extend(rest.position.z),
                };
                let carrier = part.parent.filter(|_| !part.is_rooted);
                match carrier {
                    None => {
                        let places = translations[index].get_or_insert_default();
                        places.push(nodes[index].position);
                        let turns = rotations[index].get_or_insert_default();
                        turns.push(nodes[index].rotation);
                    }
                    Some(carrier) if turned.is_some() => {
                        let turn = nodes[carrier].rotation.inverse() * nodes[index].rotation;
                        rotations[index].get_or_insert_default().push(turn);
                    }
                    Some(_) => {}
                }
            }
        }
        RetargetedClip {
            turned: ti_vec![None; count],
            rotations: rotations
                .into_iter()
                .map(|turns| turns.map(Arc::new))
                .collect(),
            translations,
            grounded: vec![false; frames],
            rest: RestSource::default(),
        }
    }

    /// The pose of a part in each frame.
    fn curve(&self, keys: &[Turned]) -> Vec<Turned> {
        let channel = |of: fn(&Turned) -> f64| {
            let values: Vec<f64> = keys.iter().map(of).collect();
            monotone(&self.frames, &values, self.is_loop)
        };
        let angles = channel(|turned| turned.angle);
        let (x, y) = (
            channel(|turned| turned.shift.x),
            channel(|turned| turned.shift.y),
        );
        let shifts = x.into_iter().zip(y).map(|(x, y)| DVec2::new(x, y));
        let poses = angles.into_iter().zip(shifts);
        poses
            .map(|(angle, shift)| Turned { angle, shift })
            .collect()
    }
}

/// The pose of a figure after a key pose, given that before. `off_joint` is called with each part whose copy lies beside its joint, how
/// far, and the length of the part.
fn advance(
    now: &mut TiVec<FigurePartId, Turned>,
    group: &FigureGroup,
    figure: &Figure,
    pose: &KeyPose,
    mut off_joint: impl FnMut(PartId, f64, f64),
) {
    let mut placed: TiVec<FigurePartId, DAffine2> = ti_vec![DAffine2::IDENTITY; group.parts.len()];
    for index in order(group) {
        let above = group.parents[index].map_or(DAffine2::IDENTITY, |parent| placed[parent]);
        let joint = figure.parts[index].joint;
        let part = group.parts[index];
        if let Some(copy) = pose.parts.iter().find(|posed| posed.part == part) {
            let moved = turned_up(copy.moved);
            let angle = angle_of(moved) - angle_of(above);
            // From the pose before the short way.
            let before = now[index].angle;
            let angle = before + (angle - before + PI).rem_euclid(TAU) - PI;
            let shift = moved.transform_point2(joint) - above.transform_point2(joint);
            let shift = if group.is_rooted(index) {
                above.inverse().transform_vector2(shift)
            } else {
                let length = joint.distance(figure.parts[index].tip);
                if shift.length() > OFF_JOINT * length {
                    off_joint(part, shift.length(), length);
                }
                DVec2::ZERO
            };
            now[index] = Turned { angle, shift };
        }
        placed[index] = above * about(joint, now[index]);
    }
}

/// The values of each frame between keys, by the monotone cubic interpolation of Fritsch and Butland: no value lies beyond those of the
/// keys around it. The ends rest, unless the values are those of a loop.
fn monotone(frames: &[usize], values: &[f64], is_loop: bool) -> Vec<f64> {
    let spans = frames.windows(2).map(|pair| (pair[1] - pair[0]) as f64);
    let spans: Vec<f64> = spans.collect();
    let steps = values.windows(2).zip(&spans);
    let slopes: Vec<f64> = steps
        .map(|(pair, span)| (pair[1] - pair[0]) / span)
        .collect();
    let tangent = |before: usize, behind: usize| {
        let (d0, d1) = (slopes[before], slopes[behind]);
        if d0 * d1 <= 0.0 {
            return 0.0;
        }
        let (h0, h1) = (spans[before], spans[behind]);
        let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
        (w0 + w1) / (w0 / d0 + w1 / d1)
    };
    let last = values.len().saturating_sub(1);
    let tangents: Vec<f64> = (0..values.len())
        .map(|key| match key {
            key if key > 0 && key < last => tangent(key - 1, key),
            _ if is_loop && last > 0 => tangent(last - 1, 0),
            _ => 0.0,
        })
        .collect();
    let mut found = Vec::with_capacity(frames.last().map_or(0, |last| last + 1));
    for (key, span) in spans.iter().enumerate() {
        for frame in frames[key]..frames[key + 1] {
            let t = (frame - frames[key]) as f64 / span;
            let (from, to) = (values[key], values[key + 1]);
            let (m0, m1) = (tangents[key] * span, tangents[key + 1] * span);
            let (t2, t3) = (t * t, t * t * t);
            found.push(
                (2.0 * t3 - 3.0 * t2 + 1.0) * from
                    + (t3 - 2.0 * t2 + t) * m0
                    + (3.0 * t2 - 2.0 * t3) * to
                    + (t3 - t2) * m1,
            );
        }
    }
    found.extend(values.last());
    found
}

/// The parts of a figure, parents before children.
fn order(group: &FigureGroup) -> Vec<FigurePartId> {
    let depth = |part: FigurePartId| {
        let above = |part: &FigurePartId| group.parents[*part];
        std::iter::successors(Some(part), above)
            .take(group.parts.len())
            .count()
    };
    let mut order: Vec<FigurePartId> = group.parts.keys().collect();
    order.sort_by_cached_key(|part| depth(*part));
    order
}

/// A pose about a joint, in the frame of what the part hangs on.
fn about(joint: DVec2, turned: Turned) -> DAffine2 {
    DAffine2::from_translation(joint + turned.shift)
        * DAffine2::from_mat2(math::rotation(turned.angle))
        * DAffine2::from_translation(-joint)
}

fn angle_of(moved: DAffine2) -> f64 {
    math::atan2(moved.matrix2.x_axis.y, moved.matrix2.x_axis.x)
}

/// A turn and a shift of the page with y up.
fn turned_up(moved: DAffine2) -> DAffine2 {
    DAffine2::from_translation(y_up(moved.translation))
        * DAffine2::from_mat2(math::rotation(-angle_of(moved)))
}

fn off_joint(name: &str, off: f64, length: f64, copy: Span) -> Diagnostic {
    let share = (100.0 * off / length.max(f64::MIN_POSITIVE))
        .round()
        .min(999.0);
    let message = format!(
        "this copy of {name} came off its joint, by {share} % of its length: only its turn counts"
    );
    Diagnostic::new(Code::OffJoint, copy, message).help(
        "turn it about its joint: in Inkscape, click the copy twice and drag the cross in its middle onto the joint first",
    )
}

#[cfg(test)]
mod tests;
