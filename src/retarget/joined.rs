//! Retargeted clips that play in turn on one figure, joined by blends.
//!
//! Clips are joined after they were carried over, so motions of different skeletons, and those that move parts without any, can follow
//! each other.

use crate::math;
use std::sync::Arc;

use glam::{DQuat, DVec3};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::{RetargetedClip, Rig};
use crate::labels::FigurePartId;
use crate::mocap::Transform;
use crate::mocap::in_turn::{Fading, Moment, Path, Playing, moments, travel};
use crate::mocap::turns::continuous;

/// A clip that plays in turn with others.
pub(crate) struct Turn<'a> {
    /// The rig that it is retargeted to: that of all clips, though its root may be another part.
    pub rig: &'a Rig,
    /// The clip.
    pub clip: &'a RetargetedClip,
    /// How long it plays.
    pub playing: Playing,
    /// By how much the body is turned about the vertical at its end.
    pub turn: DQuat,
}

/// The poses of a figure in a clip: per frame and part where its node is, in the drawing's axes.
struct Poses {
    parts: usize,
    placed: Vec<Transform>,
}

impl Poses {
    fn of(turn: &Turn<'_>) -> Self {
        let order = turn.rig.order();
        let parts = turn.rig.parts.len();
        let rest: TiVec<FigurePartId, Transform> =
            turn.rig.parts.iter().map(|part| part.node).collect();
        let mut placed = Vec::with_capacity(parts * (turn.playing.steps + 1));
        let mut pose = rest;
        for frame in 0..=turn.playing.steps {
            for &part in &order {
                pose[part] = turn.clip.node(turn.rig, part, frame, &pose);
            }
            placed.extend_from_slice(&pose.raw);
        }
        Self { parts, placed }
    }

    fn at(&self, frame: usize) -> &TiSlice<FigurePartId, Transform> {
        TiSlice::from_ref(&self.placed[frame * self.parts..][..self.parts])
    }
}

/// The clips one after the other. The figure goes on from where it is, into the direction in which it is heading; in the first `blend`
/// frames of a clip the one before it fades out. In a loop the last one fades into the first. Frames of the result are as many as the clips
/// have steps, and one more.
pub(crate) fn joined(rig: &Rig, turns: &[Turn<'_>], blend: usize, is_loop: bool) -> RetargetedClip {
    let order = rig.order();
    let Some(&root) = order.first() else {
        return RetargetedClip::default();
    };
    let poses: Vec<Poses> = turns.iter().map(Poses::of).collect();
    let playing: Vec<Playing> = turns.iter().map(|turn| turn.playing).collect();
    let moments = moments(&playing, blend, is_loop);
    let roots: Vec<Vec<DVec3>> = poses
        .iter()
        .zip(turns)
        .map(|(poses, turn)| {
            let frames = 0..=turn.playing.steps;
            frames.map(|frame| poses.at(frame)[root].position).collect()
        })
        .collect();
    let paths = roots.iter().zip(turns).map(|(root, turn)| Path {
        root,
        turn: turn.turn,
    });
    let paths: Vec<Path<'_>> = paths.collect();
    let (places, headings) = travel(&moments, &paths, DVec3::Y);
    let start = roots.first().and_then(|root| root.first());
    let start = start.map_or(DVec3::ZERO, |start| start.reject_from(DVec3::Y));

    let mut joined = Joined::new(rig, turns, moments.len());
    for (moment, place) in moments.iter().zip(&places) {
        let ground = start + *place;
        let put = |motion: usize, frame: usize| {
            let (pose, heading) = (poses[motion].at(frame), headings[motion]);
            let from = pose[root].position.reject_from(DVec3::Y);
            let put = |node: &Transform| Transform {
                rotation: heading * node.rotation,
                position: heading * (node.position - from) + ground,
            };
            pose.iter()
                .map(put)
                .collect::<TiVec<FigurePartId, Transform>>()
        };
        let own = put(moment.motion, moment.place.frame);
        let pose = match moment.fading.filter(|fading| fading.share > 0.0) {
            Some(fading) => {
                let before = put(fading.motion, fading.place.frame);
                blended(rig, &order, &before, &own, 1.0 - fading.share)
            }
            None => own,
        };
        joined.push(rig, turns, moment, &pose);
    }
    let mut clip = joined.0;
    for rotations in clip.rotations.iter_mut().flatten() {
        let rotations = Arc::make_mut(rotations);
        *rotations = continuous(std::mem::take(rotations));
    }
    clip
}

/// The pose between two, a share `t` of the way from the first to the second: turned about the joints of the parts, and as far above the
/// ground as lies between them.
fn blended(
    rig: &Rig,
    order: &[FigurePartId],
    from: &TiSlice<FigurePartId, Transform>,
    to: &TiSlice<FigurePartId, Transform>,
    t: f64,
) -> TiVec<FigurePartId, Transform> {
    let mut pose: TiVec<FigurePartId, Transform> = from.to_owned();
    for &part in order {
        let own = &rig.parts[part];
        let whole = Transform {
            rotation: DQuat::IDENTITY,
            position: DVec3::ZERO,
        };
        let above = |pose: &TiSlice<FigurePartId, Transform>| {
            own.parent.map_or(whole, |parent| pose[parent])
        };
        let (from_above, to_above) = (above(from), above(to));
        let turned = |above: &Transform, node: &Transform| above.rotation.inverse() * node.rotation;
        let (start, mut end) = (
            turned(&from_above, &from[part]),
            turned(&to_above, &to[part]),
        );
        if start.dot(end) < 0.0 {
            end = -end;
        }
        // It hangs on the point that stays at its place on what carries it: its joint, or the hub of a wheel.
        let hangs = [own.joint, own.node.position].map(|point| {
            let inside = own.node.to_local(point);
            let at = |above: &Transform, node: &Transform| above.to_local(node.apply(inside));
            (
                inside,
                at(&from_above, &from[part]),
                at(&to_above, &to[part]),
            )
        });
        let [joint, middle] = hangs;
        let apart = |hang: &(DVec3, DVec3, DVec3)| hang.1.distance(hang.2);
        let (inside, first, second) = if apart(&joint) <= apart(&middle) {
            joint
        } else {
            middle
        };
        let carried = above(&pose);
        let rotation = (carried.rotation * math::slerp(start, end, t)).normalize();
        pose[part] = Transform {
            rotation,
            position: carried.apply(first.lerp(second, t)) - rotation * inside,
        };
    }
    // Legs that swing past each other are longer than those that stand apart.
    let low = |pose: &TiSlice<FigurePartId, Transform>| lowest(rig, pose);
    if let (Some(first), Some(second), Some(now)) = (low(from), low(to), low(&pose)) {
        let rise = DVec3::Y * (first + (second - first) * t - now);
        for &part in order {
            pose[part].position += rise;
        }
    }
    pose
}

/// The height of the lowest point on which a figure stands; `None` without legs.
fn lowest(rig: &Rig, pose: &TiSlice<FigurePartId, Transform>) -> Option<f64> {
    let standing = rig.parts.iter_enumerated().filter(|(_, part)| part.stands);
    let points = standing.flat_map(|(index, part)| {
        let node = pose[index];
        let surface = part.surface.iter();
        surface.map(move |point| node.apply(part.node.to_local(*point)).y)
    });
    points.reduce(f64::min)
}

/// The clip that is put together, frame by frame.
struct Joined(RetargetedClip);

impl Joined {
    /// What any of the clips moves.
    fn new(rig: &Rig, turns: &[Turn<'_>], frames: usize) -> Self {
        let empty = RetargetedClip {
            rotations: ti_vec![None; rig.parts.len()],
            translations: ti_vec![None; rig.parts.len()],
            grounded: Vec::with_capacity(frames),
            turned: ti_vec![None; rig.parts.len()],
            rest: turns.first().map(|turn| turn.clip.rest).unwrap_or_default(),
        };
        let mut joined = Self(empty);
        for part in rig.parts.keys() {
            let clips = || turns.iter().map(|turn| turn.clip);
            let clip = &mut joined.0;
            let moves = clips().any(|clip| clip.rotations[part].is_some());
            clip.rotations[part] = moves.then(Arc::default);
            let travels = clips().any(|clip| clip.translations[part].is_some());
            clip.translations[part] = travels.then(Vec::new);
            let makes_room = clips().any(|clip| clip.turned[part].is_some());
            clip.turned[part] = makes_room.then(Vec::new);
        }
        joined
    }

    fn push(
        &mut self,
        rig: &Rig,
        turns: &[Turn<'_>],
        moment: &Moment,
        pose: &TiSlice<FigurePartId, Transform>,
    ) {
        let clip = &mut self.0;
        for (index, part) in rig.parts.iter_enumerated() {
            if let Some(places) = &mut clip.translations[index] {
                places.push(pose[index].position);
            }
            if let Some(rotations) = &mut clip.rotations[index] {
                Arc::make_mut(rotations).push(match part.parent.filter(|_| !part.is_rooted) {
                    Some(parent) => {
                        (pose[parent].rotation.inverse() * pose[index].rotation).normalize()
                    }
                    None => pose[index].rotation,
                });
            }
            if let Some(turned) = &mut clip.turned[index] {
                let of = |motion: usize, frame: usize| {
                    let turned = &turns[motion].clip.turned[index];
                    turned.as_ref().map_or(0.0, |turned| turned[frame])
                };
                let own = of(moment.motion, moment.place.frame);
                turned.push(match moment.fading {
                    Some(Fading {
                        motion,
                        place,
                        share,
                    }) => own + (of(motion, place.frame) - own) * share,
                    None => own,
                });
            }
        }
        let is_grounded = |motion: usize, frame: usize| turns[motion].clip.grounded[frame];
        let fading = moment.fading.filter(|fading| fading.share > 0.0);
        clip.grounded.push(
            is_grounded(moment.motion, moment.place.frame)
                && fading.is_none_or(|fading| is_grounded(fading.motion, fading.place.frame)),
        );
    }
}
