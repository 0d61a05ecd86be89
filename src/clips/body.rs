//! The skeletons of the clips that come along: one on two legs, one on four, one on six.
//!
//! Centimetres; +x is the body's left, +y up, +z its front. At rest they stand, arms hanging down. Joints have the names that most
//! motion files have; on four and six legs the hind legs have these names, and the others a number behind them.

use glam::DVec3;

use super::Legs;
use crate::labels::{Anatomy, Class, Label, Limb, LimbSegment, Side, Tip};
use crate::mocap::{Axis, Channel, Joint, JointId, Skeleton};

/// A skeleton, and what its joints are.
#[derive(Debug, Clone)]
pub(super) struct Body {
    pub(super) skeleton: Skeleton,
    pub(super) anatomy: Anatomy,
    /// The legs, each pair left and right, from the hind end on.
    pub(super) legs: Vec<Leg>,
    /// The arms, left and right; empty on more than two legs.
    pub(super) arms: Vec<Arm>,
}

/// A leg: two bones and a foot.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leg {
    pub(super) side: Side,
    /// 0 is the rearmost.
    pub(super) pair: usize,
    /// Thigh, shin and foot.
    pub(super) joints: [JointId; 3],
    /// The joint of the toes.
    pub(super) toe: Option<JointId>,
    /// The lengths of thigh and shin.
    pub(super) bones: [f64; 2],
    /// Where it stands at rest: the ankle.
    pub(super) ankle: DVec3,
    /// The points of the sole on which it rolls, from the ankle: heel and ball.
    pub(super) sole: [DVec3; 2],
    /// The direction that the knee points to.
    pub(super) knee: DVec3,
}

impl Leg {
    /// 1 for a left leg, −1 for a right one.
    pub(super) fn sign(&self) -> f64 {
        sign(self.side)
    }

    /// The length of the straight leg, from hip to ankle.
    pub(super) fn length(&self) -> f64 {
        self.bones[0] + self.bones[1]
    }
}

/// An arm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arm {
    pub(super) side: Side,
    /// Collar bone, upper arm, forearm, hand.
    pub(super) joints: [JointId; 4],
}

/// 1 for the left side, −1 for the right one: the sign of x.
pub(super) fn sign(side: Side) -> f64 {
    match side {
        Side::Left => 1.0,
        Side::Right => -1.0,
    }
}

impl Body {
    /// The body on so many legs.
    pub(super) fn on(legs: Legs) -> Self {
        match legs {
            Legs::Two => biped(),
            Legs::Four => quadruped(),
            Legs::Six => hexapod(),
        }
    }
}

/// An adult of 1.75 m.
fn biped() -> Body {
    let mut body = Body::begun(DVec3::new(0.0, 95.0, 0.0));
    let hips = JointId::default();
    let spine = body.trunk("Spine", hips, DVec3::new(0.0, 10.0, 0.0));
    let chest = body.trunk("Chest", spine, DVec3::new(0.0, 13.0, 0.0));
    let neck = body.neck(chest, DVec3::new(0.0, 26.0, 0.0));
    body.head(neck, DVec3::new(0.0, 9.0, 1.0), DVec3::new(0.0, 20.0, 0.0));
    for side in Side::BOTH {
        body.arm(chest, side);
    }
    for side in Side::BOTH {
        let x = sign(side);
        body.leg(LegPlan {
            side,
            pair: 0,
            parent: hips,
            hip: DVec3::new(9.0 * x, -3.0, 0.0),
            knee: DVec3::new(9.0 * x, 50.0, 0.0),
            ankle: DVec3::new(9.0 * x, 9.0, 0.0),
            ball: Some(DVec3::new(0.0, -7.0, 13.0)),
            sole: [DVec3::new(0.0, -9.0, -5.0), DVec3::new(0.0, -9.0, 13.0)],
            pole: DVec3::Z,
        });
    }
    body
}

/// A dog of 60 cm at the shoulder.
fn quadruped() -> Body {
    let mut body = Body::begun(DVec3::new(0.0, 58.0, -32.0));
    let hips = JointId::default();
    let spine = body.trunk("Spine", hips, DVec3::new(0.0, 2.0, 30.0));
    let chest = body.trunk("Chest", spine, DVec3::new(0.0, -2.0, 30.0));
    let neck = body.neck(chest, DVec3::new(0.0, 6.0, 8.0));
    body.head(
        neck,
        DVec3::new(0.0, 16.0, 14.0),
        DVec3::new(0.0, 0.0, 18.0),
    );
    let tail = body.tail("Tail", hips, DVec3::new(0.0, 3.0, -8.0));
    let tail = body.tail("Tail2", tail, DVec3::new(0.0, 4.0, -16.0));
    body.skeleton.joints[tail]
        .ends
        .push(DVec3::new(0.0, 6.0, -16.0));
    for (pair, parent, z) in [(0, hips, -32.0), (1, chest, 28.0)] {
        for side in Side::BOTH {
            let x = 8.0 * sign(side);
            body.leg(LegPlan {
                side,
                pair,
                parent,
                hip: DVec3::new(x, -2.0, 0.0),
                knee: DVec3::new(x, 30.0, z),
                ankle: DVec3::new(x, 4.0, z),
                ball: None,
                sole: [DVec3::new(0.0, -4.0, 0.0), DVec3::new(0.0, -4.0, 4.0)],
                pole: DVec3::Z,
            });
        }
    }
    body
}

/// An insect, as large as a dog, on three pairs of splayed legs.
fn hexapod() -> Body {
    let mut body = Body::begun(DVec3::new(0.0, 30.0, -14.0));
    let hips = JointId::default();
    let spine = body.trunk("Spine", hips, DVec3::new(0.0, 0.0, 14.0));
    let chest = body.trunk("Chest", spine, DVec3::new(0.0, 0.0, 14.0));
    let neck = body.neck(chest, DVec3::new(0.0, 2.0, 6.0));
    body.head(neck, DVec3::new(0.0, 2.0, 6.0), DVec3::new(0.0, 0.0, 12.0));
    let tail = body.tail("Tail", hips, DVec3::new(0.0, 0.0, -8.0));
    body.skeleton.joints[tail]
        .ends
        .push(DVec3::new(0.0, 2.0, -26.0));
    let pairs = [
        (0, hips, -14.0, -10.0),
        (1, spine, 0.0, 0.0),
        (2, chest, 14.0, 10.0),
    ];
    for (pair, parent, z, reach) in pairs {
        for side in Side::BOTH {
            let x = sign(side);
            body.leg(LegPlan {
                side,
                pair,
                parent,
                hip: DVec3::new(7.0 * x, 0.0, 0.0),
                knee: DVec3::new(18.0 * x, 34.0, z + reach * 0.6),
                ankle: DVec3::new(22.0 * x, 1.0, z + reach),
                ball: None,
                sole: [DVec3::new(0.0, -1.0, 0.0); 2],
                pole: DVec3::Y,
            });
        }
    }
    body
}

/// Where a leg is, at rest.
struct LegPlan {
    side: Side,
    pair: usize,
    /// The joint that carries it.
    parent: JointId,
    /// The hip joint, from that joint.
    hip: DVec3,
    /// The knee, in the world.
    knee: DVec3,
    /// The ankle, in the world.
    ankle: DVec3,
    /// The ball of the foot, from the ankle, if toes turn about it.
    ball: Option<DVec3>,
    sole: [DVec3; 2],
    /// Where its knee points if the leg is straight.
    pole: DVec3,
}

/// The parts of a body, added one by one with their labels.
impl Body {
    /// The hips, with their place at rest.
    fn begun(hips: DVec3) -> Self {
        let mut body = Self {
            skeleton: Skeleton::default(),
            anatomy: Anatomy::default(),
            legs: Vec::new(),
            arms: Vec::new(),
        };
        let hips = body.joint("Hips".to_owned(), None, hips, Class::Hips, None);
        let position = [Axis::X, Axis::Y, Axis::Z].map(Channel::Position);
        body.skeleton.joints[hips].channels.splice(0..0, position);
        body.anatomy.hips = Some(hips);
        body
    }

    fn joint(
        &mut self,
        name: String,
        parent: Option<JointId>,
        offset: DVec3,
        class: Class,
        limb: Option<(Side, usize, LimbSegment)>,
    ) -> JointId {
        let side = limb.map(|(side, ..)| side);
        let why = format!("`{name}` is a joint of okoshi's own clip");
        self.anatomy.labels.push(Some(Label {
            class,
            side,
            segment: limb.map_or(LimbSegment::Whole, |(.., segment)| segment),
            pair: limb.map_or(0, |(_, pair, _)| pair),
            why,
        }));
        self.skeleton.joints.push_and_get_key(Joint {
            name,
            parent,
            offset,
            // The least turn is about y, so the middle angle stays far from a quarter turn.
            channels: [Axis::Z, Axis::Y, Axis::X].map(Channel::Rotation).to_vec(),
            ends: Vec::new(),
        })
    }

    fn trunk(&mut self, name: &str, parent: JointId, offset: DVec3) -> JointId {
        let joint = self.joint(name.to_owned(), Some(parent), offset, Class::Body, None);
        self.anatomy.spine.push(joint);
        joint
    }

    fn neck(&mut self, parent: JointId, offset: DVec3) -> JointId {
        let joint = self.joint("Neck".to_owned(), Some(parent), offset, Class::Neck, None);
        self.anatomy.neck.push(joint);
        joint
    }

    fn head(&mut self, parent: JointId, offset: DVec3, end: DVec3) {
        let joint = self.joint("Head".to_owned(), Some(parent), offset, Class::Head, None);
        self.skeleton.joints[joint].ends.push(end);
        self.anatomy.head = Some(joint);
    }

    fn tail(&mut self, name: &str, parent: JointId, offset: DVec3) -> JointId {
        let joint = self.joint(name.to_owned(), Some(parent), offset, Class::Tail, None);
        self.anatomy.tail.push(joint);
        joint
    }

    fn arm(&mut self, chest: JointId, side: Side) {
        let x = sign(side);
        let segments = [
            (
                "Shoulder",
                DVec3::new(3.0 * x, 22.0, 0.0),
                LimbSegment::Collar,
            ),
            ("Arm", DVec3::new(15.0 * x, 0.0, 0.0), LimbSegment::Upper),
            ("ForeArm", DVec3::new(0.0, -28.0, 0.0), LimbSegment::Lower),
            ("Hand", DVec3::new(0.0, -25.0, 0.0), LimbSegment::End),
        ];
        let mut parent = chest;
        let joints = segments.map(|(name, offset, segment)| {
            let name = sided(side, name, 0);
            parent = self.joint(
                name,
                Some(parent),
                offset,
                Class::Arm,
                Some((side, 0, segment)),
            );
            parent
        });
        let [collar, upper, lower, hand] = joints;
        self.skeleton.joints[hand]
            .ends
            .push(DVec3::new(0.0, -16.0, 0.0));
        self.anatomy.limbs.push(Limb {
            class: Class::Arm,
            side,
            pair: 0,
            collar: Some(collar),
            upper,
            lower: Some(lower),
            end: Some(hand),
            toe: None,
            tip: Some(Tip::End {
                joint: hand,
                end: 0,
            }),
        });
        self.arms.push(Arm { side, joints });
    }

    fn leg(&mut self, plan: LegPlan) {
        let above = self.skeleton.offset_pose()[plan.parent].position;
        let hip = above + plan.hip;
        let (side, pair) = (plan.side, plan.pair);
        let mut parent = plan.parent;
        let segments = [
            ("UpLeg", plan.hip, LimbSegment::Upper),
            ("Leg", plan.knee - hip, LimbSegment::Lower),
            ("Foot", plan.ankle - plan.knee, LimbSegment::End),
        ];
        let joints = segments.map(|(name, offset, segment)| {
            let name = sided(side, name, pair);
            parent = self.joint(
                name,
                Some(parent),
                offset,
                Class::Leg,
                Some((side, pair, segment)),
            );
            parent
        });
        let foot = joints[2];
        let toe = plan.ball.map(|ball| {
            let name = sided(side, "Toe", pair);
            let limb = Some((side, pair, LimbSegment::Beyond));
            let toe = self.joint(name, Some(foot), ball, Class::Leg, limb);
            self.skeleton.joints[toe]
                .ends
                .push(DVec3::new(0.0, 0.0, 7.0));
            toe
        });
        if toe.is_none() {
            let end = plan.sole[1] + DVec3::new(0.0, 0.0, 0.1);
            self.skeleton.joints[foot].ends.push(end);
        }
        self.anatomy.limbs.push(Limb {
            class: Class::Leg,
            side,
            pair,
            collar: None,
            upper: joints[0],
            lower: Some(joints[1]),
            end: Some(foot),
            toe,
            tip: Some(toe.map_or(
                Tip::End {
                    joint: foot,
                    end: 0,
                },
                Tip::Joint,
            )),
        });
        self.legs.push(Leg {
            side,
            pair,
            joints,
            toe,
            bones: [hip.distance(plan.knee), plan.knee.distance(plan.ankle)],
            ankle: plan.ankle,
            sole: plan.sole,
            knee: pole(hip, &plan),
        });
    }
}

/// The direction that a knee points to: as it does at rest, unless the leg is straight there.
fn pole(hip: DVec3, plan: &LegPlan) -> DVec3 {
    let off = (plan.knee - hip).reject_from(plan.ankle - hip);
    if off.length() > 1.0 {
        off.normalize()
    } else {
        plan.pole
    }
}

/// `LeftFoot`; of other than the hind legs `LeftFoot2`.
fn sided(side: Side, name: &str, pair: usize) -> String {
    let side = match side {
        Side::Left => "Left",
        Side::Right => "Right",
    };
    match pair {
        0 => format!("{side}{name}"),
        pair => format!("{side}{name}{}", pair + 1),
    }
}
