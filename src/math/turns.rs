//! Rotations in the plane and in space, as glam has them: glam takes sines from the standard library. (Its feature `libm` would take
//! square roots from there as well, which are instructions otherwise.)

use glam::{DMat2, DMat3, DQuat, DVec2, DVec3};

use super::{acos, atan2, sin, sin_cos};

/// The unit vector at `angle` radians from the x axis.
#[inline]
pub(crate) fn direction(angle: f64) -> DVec2 {
    let (sin, cos) = sin_cos(angle);
    DVec2::new(cos, sin)
}

/// The matrix that turns the plane by `angle` radians.
#[inline]
pub(crate) fn rotation(angle: f64) -> DMat2 {
    let along = direction(angle);
    DMat2::from_cols(along, along.perp())
}

/// The rotation by `angle` radians around the x axis.
#[inline]
pub(crate) fn rotation_x(angle: f64) -> DQuat {
    rotation_around(DVec3::X, angle)
}

/// The rotation by `angle` radians around the y axis.
#[inline]
pub(crate) fn rotation_y(angle: f64) -> DQuat {
    rotation_around(DVec3::Y, angle)
}

/// The rotation by `angle` radians around the z axis.
#[inline]
pub(crate) fn rotation_z(angle: f64) -> DQuat {
    rotation_around(DVec3::Z, angle)
}

/// The rotation by `angle` radians around an axis of length 1.
#[inline]
pub(crate) fn rotation_around(axis: DVec3, angle: f64) -> DQuat {
    let (sin, cos) = sin_cos(angle / 2.0);
    let vector = axis * sin;
    DQuat::from_xyzw(vector.x, vector.y, vector.z, cos)
}

/// The rotation around a vector, by its length in radians.
pub(crate) fn rotation_along(vector: DVec3) -> DQuat {
    let angle = vector.length();
    if angle == 0.0 {
        DQuat::IDENTITY
    } else {
        rotation_around(vector / angle, angle)
    }
}

/// The shorter rotation between two unit quaternions at a share of the way from the first to the second, at constant speed.
pub(crate) fn slerp(from: DQuat, to: DQuat, share: f64) -> DQuat {
    let dot = from.dot(to);
    let (to, dot) = if dot < 0.0 { (-to, -dot) } else { (to, dot) };
    if dot > 1.0 - f64::EPSILON {
        return (from * (1.0 - share) + to * share).normalize();
    }
    let angle = acos(dot);
    (from * sin(angle * (1.0 - share)) + to * sin(angle * share)) * (1.0 / sin(angle))
}

/// The angle of the rotation between two unit quaternions, in radians between 0 and π.
pub(crate) fn angle_between_turns(a: DQuat, b: DQuat) -> f64 {
    2.0 * acos(a.dot(b).abs().min(1.0))
}

/// The angle between two vectors that are not zero, in radians between 0 and π.
pub(crate) fn angle_between(a: DVec3, b: DVec3) -> f64 {
    let lengths = (a.length_squared() * b.length_squared()).sqrt();
    acos((a.dot(b) / lengths).clamp(-1.0, 1.0))
}

/// The angle from one vector to another, neither zero, in radians between -π and π.
pub(crate) fn angle_to(a: DVec2, b: DVec2) -> f64 {
    angle_between(a.extend(0.0), b.extend(0.0)) * a.perp_dot(b).signum()
}

/// The angles in radians around z, then the new y, then the new x, that make a unit quaternion: [x, y, z].
pub(crate) fn euler_zyx(turn: DQuat) -> [f64; 3] {
    let DMat3 {
        x_axis: x,
        y_axis: y,
        z_axis: z,
    } = DMat3::from_quat(turn);
    let flat = (x.x * x.x + x.y * x.y).sqrt();
    let around_y = atan2(-x.z, flat);
    if flat > 16.0 * f64::EPSILON {
        [atan2(y.z, z.z), around_y, atan2(x.y, x.x)]
    } else {
        // The axes of the first and the last turn are one: all of it is said to be the last one.
        [0.0, around_y, atan2(-y.x, y.y)]
    }
}

#[cfg(test)]
mod tests {
    use glam::EulerRot;

    use super::*;

    /// Random vectors, and those along axes.
    fn vectors() -> Vec<DVec3> {
        let mut random = fastrand::Rng::with_seed(11);
        let any = (0..200).map(|_| DVec3::from_array([(); 3].map(|()| random.f64() * 6.0 - 3.0)));
        let axes = DVec3::AXES.map(|axis| axis * std::f64::consts::FRAC_PI_2);
        any.chain(axes).collect()
    }

    #[test]
    fn turns_are_those_of_glam() {
        let near = |a: DQuat, b: DQuat| assert!(a.abs_diff_eq(b, 1e-14), "{a} {b}");
        near(rotation_along(DVec3::ZERO), DQuat::IDENTITY);
        for pair in vectors().windows(2) {
            let [a, b] = [pair[0], pair[1]];
            near(rotation_along(a), DQuat::from_scaled_axis(a));
            near(rotation_x(a.x), DQuat::from_rotation_x(a.x));
            near(rotation_y(a.x), DQuat::from_rotation_y(a.x));
            near(rotation_z(a.x), DQuat::from_rotation_z(a.x));
            assert!(rotation(a.x).abs_diff_eq(DMat2::from_angle(a.x), 1e-14));
            assert!((angle_between(a, b) - a.angle_between(b)).abs() < 1e-12);
            let [flat_a, flat_b] = [a, b].map(DVec3::truncate);
            if flat_a != DVec2::ZERO && flat_b != DVec2::ZERO {
                assert!((angle_to(flat_a, flat_b) - flat_a.angle_to(flat_b)).abs() < 1e-12);
            }
            let [from, to] = [a, b].map(rotation_along);
            assert!((angle_between_turns(from, to) - from.angle_between(to)).abs() < 1e-7);
            for share in [0.0, 0.3, 1.0] {
                near(slerp(from, to, share), from.slerp(to, share));
                near(slerp(from, from, share), from);
            }
        }
    }

    #[test]
    fn angles_make_the_turn_again() {
        for vector in vectors() {
            let turn = rotation_along(vector);
            let [x, y, z] = euler_zyx(turn);
            let again = DQuat::from_euler(EulerRot::ZYX, z, y, x);
            assert!(angle_between_turns(turn, again) < 1e-7, "{vector}");
        }
    }
}
