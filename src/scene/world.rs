//! How the drawing lies in the world.

use glam::{DQuat, DVec2, DVec3};

/// From the drawing's axes to the world's: x right, y up, z towards the viewer, drawing units become metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorldTransform {
    /// The point of the drawing, y down, that lies at the world's origin.
    pub origin: DVec2,
    /// From the drawing's axes to the world's.
    pub rotation: DQuat,
    /// Metres in a drawing unit.
    pub scale: f64,
}

impl WorldTransform {
    /// A point in drawing units, y up, in the world, metres.
    pub fn point(&self, point: DVec3) -> DVec3 {
        let point = point - DVec3::new(self.origin.x, -self.origin.y, 0.0);
        self.rotation * point * self.scale
    }

    /// A rotation in the drawing's axes, in the world's.
    pub fn rotate(&self, rotation: DQuat) -> DQuat {
        self.rotation * rotation
    }

    /// Where a landscape lies whose middle is at a point of the drawing, y down, metres. It lies on the world's ground, so that
    /// all landscapes of a drawing share it: what is lower on the page is nearer.
    pub fn point_on_ground(&self, point: DVec2) -> DVec3 {
        let point = point - self.origin;
        self.rotation * DVec3::new(point.x, 0.0, point.y) * self.scale
    }
}
