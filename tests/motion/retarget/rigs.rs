//! Rigs to retarget motions to: drawn at an angle, so that nothing points in the direction of the clip's rest pose.

use glam::{DQuat, DVec3, dvec3};
use okoshi::internals::labels::{Anatomy, Class, Facing, FigurePartId, Limb, Side, Tip};
use okoshi::internals::mocap::{JointId, Transform};
use okoshi::internals::retarget::{Drive, Follow};
use okoshi::internals::retarget::{Rig, RigPart};

/// How limbs are attached to the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Limbs {
    /// By strings: their nodes are children of their parent's node.
    Bound,
    /// By touching only: their nodes are children of the model's root, in the middle of the part.
    Loose,
}

impl Limbs {
    pub(crate) const ALL: [Self; 2] = [Self::Bound, Self::Loose];
}

/// The bones of a limb of this many pieces.
fn bones(limb: &Limb, pieces: usize) -> Vec<(JointId, Option<Tip>)> {
    let [lower, end] = [limb.lower, limb.end].map(|joint| joint.expect("a whole limb"));
    match pieces {
        1 => vec![(limb.upper, Some(Tip::Joint(end)))],
        2 => vec![
            (limb.upper, Some(Tip::Joint(lower))),
            (lower, Some(Tip::Joint(end))),
        ],
        _ => vec![
            (limb.upper, Some(Tip::Joint(lower))),
            (lower, Some(Tip::Joint(end))),
            (end, limb.tip.filter(|tip| *tip != Tip::Joint(end))),
        ],
    }
}

/// A part from a joint to a tip that nothing drives; +Y of its node points along it.
pub(crate) fn part(
    parent: Option<FigurePartId>,
    is_rooted: bool,
    [joint, tip]: [DVec3; 2],
) -> RigPart {
    let way = tip - joint;
    RigPart {
        parent,
        is_rooted,
        node: Transform {
            rotation: DQuat::from_rotation_z((-way.x).atan2(way.y)),
            position: if is_rooted {
                (joint + tip) / 2.0
            } else {
                joint
            },
        },
        joint,
        tip,
        surface: Vec::new(),
        outline: Vec::new(),
        is_arm: false,
        stands: false,
        drive: None,
        is_leg: false,
        swing: None,
        inside: None,
        shared: None,
    }
}

struct Builder {
    rig: Rig,
    limbs: Limbs,
}

impl Builder {
    fn add(
        &mut self,
        parent: Option<FigurePartId>,
        is_rooted: bool,
        [joint, tip]: [DVec3; 2],
    ) -> FigurePartId {
        let part = part(parent, is_rooted, [joint, tip]);
        self.rig.parts.push_and_get_key(part)
    }

    fn trunk(
        &mut self,
        parent: Option<FigurePartId>,
        ends: [DVec3; 2],
        joint: Option<JointId>,
    ) -> FigurePartId {
        let part = self.add(parent, parent.is_none() || self.limbs == Limbs::Loose, ends);
        self.rig.parts[part].drive = joint.map(|joint| Drive {
            joint,
            tip: None,
            follow: Follow::Change,
        });
        part
    }

    /// A limb along these points; the last piece of a leg has a sole.
    fn limb(&mut self, parent: FigurePartId, points: &[DVec3], limb: &Limb, pieces: usize) {
        let is_leg = limb.class == Class::Leg;
        let mut parent = parent;
        let bones = bones(limb, pieces);
        for (index, (joint, tip)) in bones.iter().enumerate() {
            let is_rooted = index == 0 && self.limbs == Limbs::Loose;
            let ends = [points[index], points[index + 1]];
            let part = self.add(Some(parent), is_rooted, ends);
            let own = &mut self.rig.parts[part];
            own.drive = Some(Drive {
                joint: *joint,
                tip: *tip,
                follow: match tip {
                    _ if is_leg && index == 2 => Follow::Sole,
                    Some(_) => Follow::Direction,
                    None => Follow::Change,
                },
            });
            own.is_leg = is_leg;
            if is_leg && index + 1 == bones.len() {
                own.stands = true;
                own.surface = match pieces {
                    3 => vec![
                        dvec3(ends[0].x.min(ends[1].x) - 3.0, ends[1].y - 2.0, 0.0),
                        dvec3(ends[0].x.max(ends[1].x) + 3.0, ends[1].y - 2.0, 0.0),
                    ],
                    _ => vec![dvec3(ends[1].x, ends[1].y - 2.0, 0.0)],
                };
            }
            parent = part;
        }
    }
}

fn limb(anatomy: &Anatomy, class: Class, side: Side) -> &Limb {
    anatomy.limb(class, side).expect("two arms and two legs")
}

/// How many pieces a trunk has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Trunk {
    /// One, from the hips to the shoulders.
    One,
    /// Hips and two more.
    Three,
}

/// A figure that faces the viewer, with a trunk of hips and two more pieces, a head with a hat that has no drive, and limbs.
pub(crate) fn biped(anatomy: &Anatomy, limbs: Limbs, pieces: usize) -> Rig {
    figure(anatomy, limbs, pieces, Trunk::Three)
}

/// The same with a trunk of one piece.
pub(crate) fn stout(anatomy: &Anatomy, limbs: Limbs, pieces: usize) -> Rig {
    figure(anatomy, limbs, pieces, Trunk::One)
}

fn figure(anatomy: &Anatomy, limbs: Limbs, pieces: usize, trunk: Trunk) -> Rig {
    let mut figure = Builder {
        rig: Rig::default(),
        limbs,
    };
    let at = |x: f64, y: f64| dvec3(x, y, 0.0);
    let spine = &anatomy.spine;
    let [hips, chest] = match trunk {
        Trunk::One => {
            let ends = [at(0.0, 100.0), at(-4.0, 160.0)];
            let trunk = figure.trunk(None, ends, anatomy.chest());
            let shoulders = Side::BOTH.map(|side| limb(anatomy, Class::Arm, side).upper);
            let hips = anatomy.hips.expect("hips");
            let drive = figure.rig.parts[trunk].drive.as_mut().expect("a chest");
            drive.follow = Follow::Trunk { hips, shoulders };
            [trunk; 2]
        }
        Trunk::Three => {
            let hips = figure.trunk(None, [at(0.0, 100.0), at(2.0, 112.0)], anatomy.hips);
            let waist = figure.trunk(
                Some(hips),
                [at(2.0, 112.0), at(0.0, 130.0)],
                spine.first().copied(),
            );
            let chest = figure.trunk(
                Some(waist),
                [at(0.0, 130.0), at(-4.0, 160.0)],
                spine.last().copied(),
            );
            [hips, chest]
        }
    };
    let head = figure.trunk(Some(chest), [at(-4.0, 160.0), at(4.0, 190.0)], anatomy.head);
    figure.trunk(Some(head), [at(4.0, 190.0), at(14.0, 200.0)], None);
    for side in Side::BOTH {
        // The figure's left is the drawing's right.
        let out = if side == Side::Left { 1.0 } else { -1.0 };
        let arm = match pieces {
            1 => vec![at(16.0 * out, 155.0), at(50.0 * out, 118.0)],
            2 => vec![
                at(16.0 * out, 155.0),
                at(44.0 * out, 150.0),
                at(50.0 * out, 122.0),
            ],
            _ => vec![
                at(16.0 * out, 155.0),
                at(40.0 * out, 168.0),
                at(62.0 * out, 160.0),
                at(70.0 * out, 171.0),
            ],
        };
        figure.limb(chest, &arm, limb(anatomy, Class::Arm, side), pieces);
        let leg = match pieces {
            1 => vec![at(9.0 * out, 100.0), at(30.0 * out, 4.0)],
            2 => vec![
                at(9.0 * out, 100.0),
                at(26.0 * out, 54.0),
                at(20.0 * out, 4.0),
            ],
            _ => vec![
                at(9.0 * out, 100.0),
                at(20.0 * out, 56.0),
                at(24.0 * out, 12.0),
                at(40.0 * out, 5.0),
            ],
        };
        figure.limb(hips, &leg, limb(anatomy, Class::Leg, side), pieces);
    }
    figure.rig
}

/// A dog in profile: a level body, a raised head, four legs of two pieces, the front pair crossed.
pub(crate) fn dog(anatomy: &Anatomy, facing: Facing) -> Rig {
    let mut figure = Builder {
        rig: Rig {
            facing,
            ..Rig::default()
        },
        limbs: Limbs::Bound,
    };
    let ahead = if facing == Facing::Left { -1.0 } else { 1.0 };
    let at = |x: f64, y: f64| dvec3(x * ahead, y, 0.0);
    let chest = anatomy.chest();
    let body = figure.trunk(None, [at(-50.0, 70.0), at(50.0, 76.0)], chest);
    figure.trunk(Some(body), [at(50.0, 76.0), at(80.0, 105.0)], anatomy.head);
    figure.trunk(Some(body), [at(-50.0, 70.0), at(-75.0, 95.0)], None);
    for (x, crossed) in [(-45.0, false), (45.0, true)] {
        for side in Side::BOTH {
            let leg = limb(
                anatomy,
                Class::Leg,
                if crossed { side.other() } else { side },
            );
            let points = [at(x, 66.0), at(x + 6.0, 36.0), at(x - 3.0, 3.0)];
            figure.limb(body, &points, leg, 2);
        }
    }
    figure.rig
}
