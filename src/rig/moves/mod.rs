//! Clips that move the parts of a figure by what they are: wheels, wings, fins, tails, tentacles, stems (docs/motion.md).
//!
//! [`Roles`] says what each part is, [`poses`] how it turns, and [`Moves`] puts the two together. Nothing is carried over from a
//! skeleton, so these clips fit whatever has such parts.

mod poses;
mod roles;
#[cfg(test)]
mod tests;

use glam::{DQuat, DVec3};
use typed_index_collections::TiVec;

use crate::clips::BuiltIn;
use crate::labels::FigurePartId;
use crate::mocap::{JointId, Transform};
use crate::retarget::{
    Drive, Follow, MatchedPart, Matching, RestSource, RetargetedClip, Rig, RigPart,
};

use poses::Piece;
pub(super) use roles::{Role, Roles};

/// A clip of a figure's parts.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Moves {
    which: BuiltIn,
    roles: Roles,
    /// How many frames a cycle takes: there is one more, which repeats the first.
    cycle: usize,
    /// How far the figure goes in a cycle, drawing units.
    travel: f64,
}

impl Moves {
    /// The clip for a figure.
    pub(super) fn new(which: BuiltIn, roles: Roles) -> Self {
        let (cycle, travel) = poses::cycle(which, &roles);
        Self {
            which,
            roles,
            cycle,
            travel,
        }
    }

    /// The same clip, played faster or slower; in a whole number of frames, at least one.
    #[must_use]
    pub(super) fn at_speed(self, speed: f64) -> Self {
        let cycle = (self.cycle as f64 / speed).round();
        Self {
            cycle: (cycle as usize).max(1),
            ..self
        }
    }

    /// The number of frames.
    pub(super) fn frames(&self) -> usize {
        self.cycle + 1
    }

    /// Which parts move, and as what, as if joints of these names drove them.
    pub(super) fn matching(&self, names: impl Fn(FigurePartId) -> String) -> Matching {
        let part = |part: FigurePartId| {
            let role = self.moves(part);
            let drive = role.map(|role| Drive {
                joint: JointId::from(role as usize),
                tip: None,
                follow: Follow::Change,
            });
            let why = match role {
                Some(role) => format!(
                    "`{}` is {}: {}",
                    names(part),
                    self.roles.why(part),
                    role.does()
                ),
                None => format!(
                    "`{}` has no motion of its own in `{}`",
                    names(part),
                    self.which.name()
                ),
            };
            MatchedPart {
                label: self.roles.labels[part].clone(),
                splayed: false,
                bones: Vec::default(),
                drive,
                why,
            }
        };
        Matching {
            parts: self.roles.parts.keys().map(part).collect(),
            facing: self.roles.facing.clone(),
            problems: Vec::new(),
        }
    }

    /// What a part moves as; `None` if it follows its parent, or is a bone inside of another part.
    fn moves(&self, part: FigurePartId) -> Option<Role> {
        if part == self.roles.root {
            return Some(Role::Body);
        }
        let role = self.roles.parts.get(part)?.role?;
        poses::moves(self.which, role).then_some(role)
    }

    /// What the parts of a rig are to the clip, bones inside of parts included, which follow after the parts of the figure.
    fn pieces(&self, rig: &Rig) -> TiVec<FigurePartId, Option<MovingPiece>> {
        let mut joints: TiVec<FigurePartId, usize> = vec![0; rig.parts.len()].into();
        for part in rig.parts.iter().filter(|part| part.shared.is_none()) {
            if let Some(of) = part.inside {
                joints[of] += 1;
            }
        }
        // Per part the number of the joint that comes next, and the share of its turn that is made before.
        let mut next: TiVec<FigurePartId, (usize, f64)> = vec![(0, 0.0); rig.parts.len()].into();
        let piece = |(index, part): (FigurePartId, &RigPart)| {
            let of = part.inside.unwrap_or(index);
            let mut role = self.moves(of);
            let piece = match part.inside {
                None if joints[of] == 0 || role == Some(Role::Body) => Piece::WHOLE,
                None => Piece::FIRST,
                Some(of) => {
                    let (joint, before) = next[of];
                    let share = part.shared.map_or(1.0, |shared| shared.share);
                    next[of] = match part.shared {
                        Some(_) => (joint, share),
                        None => (joint + 1, 0.0),
                    };
                    role = role.map(|role| match role {
                        Role::Body => poses::role_of_root(self.which),
                        role => role,
                    });
                    // A wheel is round however it bends.
                    role = role.filter(|role| !matches!(role, Role::Body | Role::Wheel));
                    Piece::inside(share - before, joint, joints[of])
                }
            };
            Some(MovingPiece {
                of,
                role: role?,
                piece,
            })
        };
        rig.parts.iter_enumerated().map(piece).collect()
    }

    /// The clip on the figure's rig, at its place or in place.
    pub(super) fn play(&self, rig: &Rig, is_in_place: bool) -> RetargetedClip {
        let travel = if is_in_place { 0.0 } else { self.travel };
        let order = rig.order();
        let frames = self.frames();
        let count = rig.parts.len();
        let pieces = self.pieces(rig);
        let mut rotations: TiVec<FigurePartId, Option<Vec<DQuat>>> = vec![None; count].into();
        let mut translations: TiVec<FigurePartId, Option<Vec<DVec3>>> = vec![None; count].into();
        let mut placed: TiVec<FigurePartId, Transform> =
            rig.parts.iter().map(|part| part.node).collect();
        for frame in 0..frames {
            // The last frame is the first one again.
            let time = (frame % self.cycle) as f64 / self.cycle as f64;
            let whole = self.roles.forward * (travel * frame as f64 / self.cycle as f64);
            let offset = poses::offset(self.which, &self.roles, travel, time);
            for &index in &order {
                let part = &rig.parts[index];
                let carried = self.carried(rig, index, &placed, [whole, offset]);
                let turn = pieces[index].map_or(DQuat::IDENTITY, |piece| self.turn(piece, time));
                let pivot = self.pivot(rig, index);
                let node = carried.apply(about(pivot, turn).apply(part.node.position));
                let rotation = (carried.rotation * turn * part.node.rotation).normalize();
                placed[index] = Transform {
                    rotation,
                    position: node,
                };
                let above = part.parent.filter(|_| !part.is_rooted);
                if above.is_none() {
                    translations[index].get_or_insert_default().push(node);
                }
                if part.is_rooted || above.is_none() || pieces[index].is_some() {
                    let inner = above.map_or(rotation, |above| {
                        placed[above].rotation.inverse() * rotation
                    });
                    rotations[index].get_or_insert_default().push(inner);
                }
            }
        }
        let grounded = (0..frames).map(|frame| {
            poses::is_grounded(self.which, (frame % self.cycle) as f64 / self.cycle as f64)
        });
        RetargetedClip {
            turned: rotations.iter().map(|_| None).collect(),
            rotations: rotations
                .into_iter()
                .map(|turns| turns.map(Into::into))
                .collect(),
            translations,
            grounded: grounded.collect(),
            rest: RestSource::default(),
        }
    }

    /// How what a part hangs on has moved from where it is drawn.
    fn carried(
        &self,
        rig: &Rig,
        part: FigurePartId,
        placed: &TiVec<FigurePartId, Transform>,
        [whole, offset]: [DVec3; 2],
    ) -> Transform {
        let own = &rig.parts[part];
        // What stands on the ground does not rise with the body on its springs.
        let is_rolling = self.moves(part) == Some(Role::Wheel) && own.is_rooted;
        let from_root = match own.parent {
            Some(parent) if !is_rolling => {
                let (now, rest) = (placed[parent], rig.parts[parent].node);
                let rotation = now.rotation * rest.rotation.inverse();
                return Transform {
                    rotation,
                    position: now.position - rotation * rest.position,
                };
            }
            Some(_) => whole,
            None => whole + offset,
        };
        Transform {
            rotation: DQuat::IDENTITY,
            position: from_root,
        }
    }

    fn turn(&self, moving: MovingPiece, time: f64) -> DQuat {
        let MovingPiece { of, role, piece } = moving;
        match role {
            Role::Body => poses::body(self.which, &self.roles, time),
            role => poses::turn(self.which, role, &self.roles, of, time, piece),
        }
    }

    /// The point about which a part turns.
    fn pivot(&self, rig: &Rig, part: FigurePartId) -> DVec3 {
        let own = &rig.parts[part];
        let depth = own.joint.z;
        match self.moves(part) {
            Some(Role::Wheel) if own.is_rooted => self.roles.parts[part].center.extend(depth),
            Some(Role::Body) => poses::pivot(self.which, &self.roles).extend(depth),
            _ => own.joint,
        }
    }
}

/// A node that moves.
#[derive(Debug, Clone, Copy)]
struct MovingPiece {
    /// The part of the figure that it is, or is inside of.
    of: FigurePartId,
    /// What that moves as.
    role: Role,
    piece: Piece,
}

/// A rotation about a point.
fn about(pivot: DVec3, rotation: DQuat) -> Transform {
    Transform {
        rotation,
        position: pivot - rotation * pivot,
    }
}
