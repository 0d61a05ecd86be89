//! Cameras, which nodes of a scene place and clips move.

/// A camera: it is at the origin of its node and looks along the node's −z axis, with +y upwards in the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Its name.
    pub name: String,
    /// How space becomes a picture.
    pub projection: CameraProjection,
}

/// The projection of a camera. The aspect ratio is that of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum CameraProjection {
    /// Distant things are smaller.
    Perspective {
        /// The angle between the upper and the lower border of the picture, radians, between 0 and π.
        vertical_field_of_view: f64,
        /// What is nearer is not shown: a distance in metres, greater than 0.
        near: f64,
        /// What is farther is not shown, metres; `None` shows everything.
        far: Option<f64>,
    },
    /// Parallel lines stay parallel.
    Orthographic {
        /// Half the height of the picture, metres, greater than 0.
        half_height: f64,
        /// What is nearer is not shown, metres, at least 0.
        near: f64,
        /// What is farther is not shown, metres, greater than `near`.
        far: f64,
    },
}

impl CameraProjection {
    /// Whether all numbers are in their ranges, at single precision too, which files have.
    pub fn is_valid(&self) -> bool {
        match *self {
            Self::Perspective {
                vertical_field_of_view,
                near,
                far,
            } => {
                let [angle, near] = [vertical_field_of_view, near].map(|number| number as f32);
                let far = far.map_or(f32::MAX, |far| far as f32);
                let is_angle = angle > 0.0 && angle < std::f32::consts::PI;
                is_angle && near > 0.0 && far > near && far.is_finite()
            }
            Self::Orthographic {
                half_height,
                near,
                far,
            } => {
                let [half_height, near, far] = [half_height, near, far].map(|number| number as f32);
                let has_height = half_height > 0.0 && half_height.is_finite();
                has_height && near >= 0.0 && far > near && far.is_finite()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_out_of_range_are_invalid() {
        let perspective = |vertical_field_of_view, near, far| {
            CameraProjection::Perspective {
                vertical_field_of_view,
                near,
                far,
            }
            .is_valid()
        };
        assert!(perspective(0.5, 0.01, None) && perspective(3.0, 1.0, Some(2.0)));
        for angle in [0.0, -1.0, 3.15, f64::NAN] {
            assert!(!perspective(angle, 0.1, None), "{angle}");
        }
        for near in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-60] {
            assert!(!perspective(0.5, near, None), "{near}");
        }
        for far in [0.1, f64::NAN, f64::INFINITY, 1e60] {
            assert!(!perspective(0.5, 0.1, Some(far)), "{far}");
        }
        let orthographic = |half_height, near, far| {
            CameraProjection::Orthographic {
                half_height,
                near,
                far,
            }
            .is_valid()
        };
        assert!(orthographic(2.0, 0.0, 9.0));
        for [half_height, near, far] in [
            [0.0, 0.0, 9.0],
            [f64::NAN, 0.0, 9.0],
            [2.0, -1.0, 9.0],
            [2.0, 9.0, 9.0],
            [2.0, 0.0, f64::INFINITY],
        ] {
            assert!(!orthographic(half_height, near, far));
        }
    }
}
