//! Interpolated rotations as angles of a joint's own channels: Euler-angle extraction for all twelve axis orders, as in
//! Shoemake, *Euler Angle Conversion* (Graphics Gems IV, 1994).

use glam::{DMat3, DQuat};

use crate::math;
use crate::mocap::{Axis, Channel, Clip, Joint};

/// If the sine or cosine of the second angle is below this, the first and the third rotate about the same line (gimbal lock)
/// and only their sum is determined. The first one then keeps its value.
const GIMBAL_LOCK: f64 = 1e-12;

/// Three axes that can express every rotation: R = R_i(α) · R_j(β) · R_l(γ), where l is i or the third axis k.
#[derive(Debug, Clone, Copy)]
struct AxisOrder {
    i: usize,
    j: usize,
    k: usize,
    /// Whether l = i (proper Euler angles, such as Z X Z); else Tait-Bryan angles.
    proper: bool,
    /// 1 if i, j, k are in cyclic order, else −1.
    sign: f64,
}

impl AxisOrder {
    fn of(axes: &[Axis]) -> Option<Self> {
        let [i, j, l] = axes else {
            return None;
        };
        if i == j || j == l {
            return None;
        }
        let (i, j) = (i.index(), j.index());
        Some(Self {
            i,
            j,
            k: 3 - i - j,
            proper: l.index() == i,
            sign: if (i + 1) % 3 == j { 1.0 } else { -1.0 },
        })
    }

    /// The angles of a rotation, degrees; `before` is the first angle in a gimbal lock.
    ///
    /// The second and third angles are extracted from the rotation with the first one undone, so that all three together are
    /// exact, however imprecise the first one is near the pole.
    fn angles(self, rotation: DQuat, before: f64) -> [f64; 3] {
        let matrix = DMat3::from_quat(rotation);
        let at = |row: usize, column: usize| matrix.col(column)[row];
        let Self { i, j, k, sign, .. } = self;
        let (y, x) = if self.proper {
            (at(j, i), -sign * at(k, i))
        } else {
            (-sign * at(j, k), at(k, k))
        };
        let alpha = if math::hypot(y, x) < GIMBAL_LOCK {
            before.to_radians()
        } else {
            math::atan2(y, x)
        };
        let (sin, cos) = math::sin_cos(alpha);
        let row_j = |column: usize| cos * at(j, column) + sign * sin * at(k, column);
        let row_k = |column: usize| cos * at(k, column) - sign * sin * at(j, column);
        let (beta, gamma) = if self.proper {
            (
                math::atan2(-sign * row_k(i), at(i, i)),
                math::atan2(-sign * row_j(k), row_j(j)),
            )
        } else {
            (
                math::atan2(sign * at(i, k), row_k(k)),
                math::atan2(sign * row_j(i), row_j(j)),
            )
        };
        [alpha, beta, gamma].map(f64::to_degrees)
    }

    /// Of all angles that are equivalent to these, the ones nearest to `before`.
    fn nearest(self, found: [f64; 3], before: [f64; 3]) -> [f64; 3] {
        let one = equivalents_near(found, before);
        let other = equivalents_near(self.flipped(found), before);
        if total_difference(one, before) <= total_difference(other, before) {
            one
        } else {
            other
        }
    }

    /// The second solution: other angles, within one turn, of the same rotation.
    fn flipped(self, [a, b, c]: [f64; 3]) -> [f64; 3] {
        [
            a + 180.0,
            if self.proper { -b } else { 180.0 - b },
            c + 180.0,
        ]
    }
}

/// The rotation channels of a joint over time.
pub(super) struct RotationTrack {
    joint: Joint,
    /// Indices of the rotation channels among the joint's channels.
    indices: Vec<usize>,
    order: Option<AxisOrder>,
    /// The angles of the previous sample.
    angles: Vec<f64>,
    /// Cached rotations of frames: the two that the previous sample lies between.
    known: [Option<(usize, DQuat)>; 2],
}

impl RotationTrack {
    /// A track that begins with a joint's numbers in the first frame, unchanged.
    pub(super) fn new(channels: &[Channel], first: &[f64]) -> Self {
        let rotations = channels
            .iter()
            .enumerate()
            .filter_map(|(index, channel)| match channel {
                Channel::Rotation(axis) => Some((index, *axis)),
                Channel::Position(_) => None,
            });
        let (indices, axes): (Vec<usize>, Vec<Axis>) = rotations.unzip();
        let angles = indices
            .iter()
            .map(|index| first.get(*index).copied().unwrap_or(0.0))
            .collect();
        Self {
            joint: Joint {
                channels: channels.to_vec(),
                ..Joint::default()
            },
            order: AxisOrder::of(&axes),
            indices,
            angles,
            known: [None; 2],
        }
    }

    /// The rotation in a frame, from the frame's index and the joint's numbers.
    fn rotation(&self, (frame, numbers): (usize, &[f64])) -> DQuat {
        let known = self
            .known
            .iter()
            .flatten()
            .find(|(known, _)| *known == frame);
        known.map_or_else(
            || Clip::local(&self.joint, numbers).rotation,
            |(_, rotation)| *rotation,
        )
    }

    /// Writes the rotation at fraction `t` (0…1) between two frames, each given by index and numbers, to the numbers of a new
    /// frame. Of all equivalent angles it takes the ones nearest to the previous sample's.
    pub(super) fn rotations(&mut self, between: [(usize, &[f64]); 2], t: f64, out: &mut [f64]) {
        let [(first, from), (second, to)] = between;
        match (self.order, self.angles.as_slice()) {
            (Some(order), &[a, b, c]) => {
                let ends = between.map(|end| self.rotation(end));
                self.known = [Some((first, ends[0])), Some((second, ends[1]))];
                let found = match (t, self.indices.as_slice()) {
                    // The very numbers of the frame, but for whole turns.
                    (0.0, &[a, b, c]) => [from[a], from[b], from[c]],
                    _ => order.angles(slerp(ends[0], ends[1], t), a),
                };
                let found = order.nearest(found, [a, b, c]);
                self.angles.copy_from_slice(&found);
            }
            _ => {
                for (index, angle) in self.indices.iter().zip(&mut self.angles) {
                    if let (Some(from), Some(to)) = (from.get(*index), to.get(*index)) {
                        *angle = nearest(from + shorter_turn(to - from) * t, *angle);
                    }
                }
            }
        }
        self.write(out);
    }

    /// Whether the channels can express every rotation.
    pub(super) fn is_complete(&self) -> bool {
        self.order.is_some()
    }

    /// Writes a rotation to the numbers of a new frame, as angles nearest to the previous sample's. Channels that cannot express every
    /// rotation are left as they are.
    pub(super) fn set(&mut self, rotation: DQuat, out: &mut [f64]) {
        if let (Some(order), &[a, b, c]) = (self.order, self.angles.as_slice()) {
            let found = order.nearest(order.angles(rotation, a), [a, b, c]);
            self.angles.copy_from_slice(&found);
            self.write(out);
        }
    }

    fn write(&self, out: &mut [f64]) {
        for (index, angle) in self.indices.iter().zip(&self.angles) {
            if let Some(number) = out.get_mut(*index) {
                *number = *angle;
            }
        }
    }
}

/// Spherical linear interpolation along the shorter arc, precise for the smallest angles too.
fn slerp(from: DQuat, to: DQuat, t: f64) -> DQuat {
    let to = if from.dot(to) < 0.0 { -to } else { to };
    // The angle from the chords by arc tangent: the arc cosine of the dot product loses half the digits near 1.
    let angle = 2.0 * math::atan2((to - from).length(), (to + from).length());
    let sin = math::sin(angle);
    if sin < 1e-9 {
        return (from * (1.0 - t) + to * t).normalize();
    }
    (from * (math::sin((1.0 - t) * angle) / sin) + to * (math::sin(t * angle) / sin)).normalize()
}

/// The equivalent angle difference of the shorter way, degrees: −180…180.
fn shorter_turn(angle: f64) -> f64 {
    angle - 360.0 * (angle / 360.0).round()
}

/// The angle that is equivalent to `angle` and nearest to `to`.
fn nearest(angle: f64, to: f64) -> f64 {
    angle - 360.0 * ((angle - to) / 360.0).round()
}

fn equivalents_near(angles: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|index| nearest(angles[index], to[index]))
}

fn total_difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|index| (a[index] - b[index]).abs()).sum()
}
