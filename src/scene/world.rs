//! The transform from the drawing to the world.

use glam::{DQuat, DVec2, DVec3};

/// From the drawing's axes to the world's: x right, y up, z towards the viewer, drawing units become metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorldTransform {
    /// The point of the drawing, y down, that becomes the world's origin.
    pub origin: DVec2,
    /// From the drawing's axes to the world's.
    pub rotation: DQuat,
    /// Metres in a drawing unit.
    pub scale: f64,
}

impl WorldTransform {
    /// Maps a point in drawing units, y up, to the world, metres.
    pub fn point(&self, point: DVec3) -> DVec3 {
        let point = point - DVec3::new(self.origin.x, -self.origin.y, 0.0);
        self.rotation * point * self.scale
    }

    /// Maps a way between two points in drawing units, y up, to the world, metres.
    pub fn way(&self, way: DVec3) -> DVec3 {
        self.rotation * way * self.scale
    }

    /// Maps a rotation in the drawing's axes to the world's axes.
    pub fn rotate(&self, rotation: DQuat) -> DQuat {
        self.rotation * rotation
    }

    /// The position of a landscape whose middle is at a point of the drawing, y down; metres. All landscapes are on the world's
    /// ground: what is lower on the page is nearer.
    pub fn point_on_ground(&self, point: DVec2) -> DVec3 {
        let point = point - self.origin;
        self.rotation * DVec3::new(point.x, 0.0, point.y) * self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_moved_turned_and_scaled() {
        let world = WorldTransform {
            origin: DVec2::new(10.0, 20.0),
            // Right stays, up becomes -z, towards the viewer becomes y.
            rotation: DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2),
            scale: 0.5,
        };
        let close = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-12, "{a} {b}");
        close(world.point(DVec3::new(10.0, -20.0, 0.0)), DVec3::ZERO);
        close(
            world.point(DVec3::new(12.0, -14.0, 4.0)),
            DVec3::new(1.0, 2.0, -3.0),
        );
        // Lower on the page is nearer to the viewer.
        close(
            world.point_on_ground(DVec2::new(12.0, 26.0)),
            DVec3::new(1.0, 3.0, 0.0),
        );
        close(world.rotate(DQuat::IDENTITY) * DVec3::Y, -DVec3::Z);
    }
}
