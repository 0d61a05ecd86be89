//! The camera: its direction, its projection, and how it is framed.

use std::borrow::Cow;

use glam::{DVec3, Vec2, Vec3};

use super::surface::{Normalization, Surface};
use crate::import::{CameraPose, CameraProjection, ModelCamera};
use crate::math;

/// How far the camera can be raised or lowered, in degrees.
pub const MAX_PITCH: f64 = 90.0;
/// Half the picture's longer side at distance 1: that of an 85 mm lens on 36 mm film, a usual portrait lens.
const LENS: f32 = 18.0 / 85.0;
/// The empty border, as a share of the picture's shorter side.
pub(super) const MARGIN: f32 = 0.06;
/// The smallest half extent of a framing, so that a flat model seen edge-on has a scale.
const LEAST: f32 = 1e-4;

/// The depths of a camera that shows everything in front of it.
const EVERYTHING: [f32; 2] = [0.0, f32::INFINITY];

/// Iterations of the centring; each removes most of the remaining offset.
const CENTRINGS: usize = 3;

/// The direction of the camera, in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Turns the camera around the model, to the model's left; 0 faces its front.
    pub yaw: f64,
    /// Raises the camera; 90 looks down on the model.
    pub pitch: f64,
}

impl Default for View {
    fn default() -> Self {
        Self {
            yaw: 30.0,
            pitch: 15.0,
        }
    }
}

impl View {
    /// Right and up in the picture, and towards the camera: unit vectors of the model's world.
    pub(super) fn axes(self) -> [DVec3; 3] {
        let (yaw_sin, yaw_cos) = math::sin_cos(self.yaw.to_radians());
        let (pitch_sin, pitch_cos) = math::sin_cos(self.pitch.to_radians());
        [
            DVec3::new(yaw_cos, 0.0, -yaw_sin),
            DVec3::new(-pitch_sin * yaw_sin, pitch_cos, -pitch_sin * yaw_cos),
            DVec3::new(pitch_cos * yaw_sin, pitch_sin, pitch_cos * yaw_cos),
        ]
    }
}

/// A rectangle in the world that a picture in parallel projection shows, seen along its normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet {
    /// Its top left corner, metres.
    pub corner: DVec3,
    /// Along its upper edge to the right: a unit vector.
    pub right: DVec3,
    /// Along its left edge upwards: a unit vector at a right angle to `right`.
    pub up: DVec3,
    /// The side of a pixel, metres.
    pub pixel: f64,
}

impl Sheet {
    /// Towards the viewer.
    pub(super) fn towards(&self) -> DVec3 {
        self.right.cross(self.up)
    }

    /// A camera that shows this rectangle of the world as a picture of `size` pixels. It stands in front of all of `surface`.
    pub(super) fn camera(&self, size: [u32; 2], surface: &Surface) -> Camera {
        let [width, height] = size.map(|side| f64::from(side) * self.pixel);
        let middle = self.corner + (self.right * width - self.up * height) / 2.0;
        let middle = surface.normalization.apply(middle);
        let towards = self.towards();
        let eye = middle + towards * (surface.reach() - middle.dot(towards));
        Camera {
            axes: Axes {
                right: self.right.as_vec3(),
                up: self.up.as_vec3(),
                forward: -towards.as_vec3(),
            },
            projection: Projection::Orthographic,
            yaw: 0.0,
            eye: eye.as_vec3(),
            half: (width.max(height) / 2.0 * surface.normalization.scale) as f32,
            size: Vec2::new(size[0] as f32, size[1] as f32),
            depths: EVERYTHING,
        }
    }
}

/// The projection of a camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Projection {
    /// Distant things are smaller.
    #[default]
    Perspective,
    /// Parallel lines stay parallel.
    Orthographic,
}

/// The axes of a camera, unit vectors.
#[derive(Debug, Clone, Copy)]
struct Axes {
    right: Vec3,
    up: Vec3,
    forward: Vec3,
}

impl Axes {
    fn new(view: View) -> Self {
        let [right, up, towards] = view.axes().map(|axis| axis.as_vec3());
        Self {
            right,
            up,
            forward: -towards,
        }
    }

    /// Right, up and depth of a point.
    fn of(&self, point: Vec3) -> Vec3 {
        Vec3::new(
            point.dot(self.right),
            point.dot(self.up),
            point.dot(self.forward),
        )
    }
}

/// The extent of the picture, in camera coordinates (right, up, depth).
#[derive(Debug, Clone, Copy)]
pub(super) struct Framing {
    projection: Projection,
    size: [u32; 2],
    middle: Vec2,
    /// Depth of the eye, or of the plane where parallel rays start.
    depth: f32,
    /// Half the picture's longer side: at distance 1, or at any distance for parallel rays.
    half: f32,
}

impl Framing {
    /// The closest framing that shows the points of all shots, with a margin. A shot is a view and something that
    /// distinguishes the shots of one view; `points` gives what is visible in a shot, and may fail.
    pub(super) fn new<'p, S: Copy, E>(
        shots: &[(View, S)],
        projection: Projection,
        size: [u32; 2],
        points: impl Fn(View, S) -> Result<Cow<'p, [Vec3]>, E>,
    ) -> Result<Self, E> {
        let size_of = Vec2::new(size[0] as f32, size[1] as f32);
        let aspect = size_of / size_of.max_element();
        let inner = aspect * (Vec2::ONE - 2.0 * MARGIN * size_of.min_element() / size_of);
        let tangents = match projection {
            Projection::Perspective => inner * LENS,
            Projection::Orthographic => Vec2::ZERO,
        };
        // The largest offsets of the four planes that bound the picture: right and top, left and bottom.
        let mut high = Vec2::NEG_INFINITY;
        let mut low = Vec2::NEG_INFINITY;
        let mut nearest = f32::INFINITY;
        for (view, shot) in shots {
            let axes = Axes::new(*view);
            for point in &*points(*view, *shot)? {
                let seen = axes.of(*point);
                let slope = tangents * seen.z;
                high = high.max(seen.truncate() - slope);
                low = low.max(-seen.truncate() - slope);
                nearest = nearest.min(seen.z);
            }
        }
        let middle = (high - low) / 2.0;
        let reach = (high + low) / 2.0;
        let (depth, half) = match projection {
            Projection::Perspective => {
                let depth = (-reach / tangents).min_element();
                (depth.min(nearest - LEAST), LENS)
            }
            Projection::Orthographic => (nearest - 1.0, (reach / inner).max_element().max(LEAST)),
        };
        let mut framing = Self {
            projection,
            size,
            middle,
            depth,
            half,
        };
        if projection == Projection::Perspective {
            for _ in 0..CENTRINGS {
                framing.center(shots, &points)?;
            }
        }
        Ok(framing)
    }

    /// The same camera, whose parallel rays start further back by `distance`, so that they also meet what is in front of the points.
    pub(super) fn stepping_back(mut self, distance: f32) -> Self {
        if self.projection == Projection::Orthographic {
            self.depth -= distance;
        }
        self
    }

    /// Moves the eye sideways, so that opposite margins become equal.
    fn center<'p, S: Copy, E>(
        &mut self,
        shots: &[(View, S)],
        points: impl Fn(View, S) -> Result<Cow<'p, [Vec3]>, E>,
    ) -> Result<(), E> {
        let mut high = Vec2::NEG_INFINITY;
        let mut low = Vec2::NEG_INFINITY;
        for (view, shot) in shots {
            let axes = Axes::new(*view);
            for point in &*points(*view, *shot)? {
                let seen = axes.of(*point);
                let place = (seen.truncate() - self.middle) / (seen.z - self.depth);
                high = high.max(place);
                low = low.max(-place);
            }
        }
        // The middle of the model lies at depth 0.
        self.middle += (high - low) / 2.0 * -self.depth;
        Ok(())
    }

    /// The camera for one of the views.
    pub(super) fn camera(&self, view: View) -> Camera {
        let axes = Axes::new(view);
        let eye = axes.right * self.middle.x + axes.up * self.middle.y + axes.forward * self.depth;
        let size = Vec2::new(self.size[0] as f32, self.size[1] as f32);
        Camera {
            axes,
            projection: self.projection,
            yaw: view.yaw,
            eye,
            half: self.half,
            size,
            depths: EVERYTHING,
        }
    }
}

/// The rays of a picture: linear functions of the place in it, in pixels from the top left. Directions are not normalised; depth
/// increases by 1 along them.
#[derive(Debug, Clone, Copy)]
pub(super) struct RayField {
    /// Origin and direction of the ray through the top left corner.
    corner: [Vec3; 2],
    /// Their change from a pixel to the next one, to the right and down.
    pub(super) steps: [[Vec3; 2]; 2],
}

impl RayField {
    /// Origin and direction of the ray through a point of the picture.
    #[inline]
    pub(super) fn at(&self, place: Vec2) -> [Vec3; 2] {
        let [right, down] = self.steps;
        let of = |part: usize| self.corner[part] + right[part] * place.x + down[part] * place.y;
        [of(0), of(1)]
    }
}

/// A camera, framed for a picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    axes: Axes,
    projection: Projection,
    /// The yaw of the view in degrees; the lights turn with it.
    pub(super) yaw: f64,
    eye: Vec3,
    half: f32,
    size: Vec2,
    /// The depths of the nearest and the farthest that is shown.
    pub(super) depths: [f32; 2],
}

impl Camera {
    /// One of the file's cameras in a pose, for a picture of `size` pixels. Its vertical angle holds whatever the picture's shape.
    pub(super) fn in_model(
        camera: &ModelCamera,
        pose: &CameraPose,
        normalization: Normalization,
        size: [u32; 2],
    ) -> Self {
        let [width, height] = size.map(f64::from);
        let scale = normalization.scale;
        let (projection, half_height, near, far) = match camera.projection {
            CameraProjection::Perspective {
                vertical_field_of_view,
                near,
                far,
            } => {
                let half = math::tan(vertical_field_of_view / 2.0);
                let far = far.unwrap_or(f64::INFINITY);
                (Projection::Perspective, half, near, far)
            }
            CameraProjection::Orthographic {
                half_height,
                near,
                far,
            } => (Projection::Orthographic, half_height * scale, near, far),
        };
        let longer = width.max(height);
        Self {
            axes: Axes {
                right: pose.right.as_vec3(),
                up: pose.up.as_vec3(),
                forward: -pose.towards.as_vec3(),
            },
            projection,
            yaw: pose.yaw(),
            eye: normalization.apply(pose.eye).as_vec3(),
            half: (half_height * longer / height) as f32,
            size: Vec2::new(width as f32, height as f32),
            depths: [near * scale, far * scale].map(|depth| depth as f32),
        }
    }

    /// The distances along a ray between which something is shown.
    #[inline]
    pub(super) fn limits(&self, direction: Vec3) -> [f32; 2] {
        let cosine = direction.dot(self.axes.forward);
        self.depths.map(|depth| depth / cosine)
    }

    /// The origin and direction of the ray through a point of the picture, in pixels from the top left.
    #[inline]
    pub(super) fn ray(&self, place: Vec2) -> (Vec3, Vec3) {
        let longer = self.size.max_element();
        let across = (place * 2.0 - self.size) / longer * self.half;
        let (right, up) = (self.axes.right * across.x, self.axes.up * -across.y);
        match self.projection {
            Projection::Perspective => (self.eye, (self.axes.forward + right + up).normalize()),
            Projection::Orthographic => (self.eye + right + up, self.axes.forward),
        }
    }

    /// The rays of the picture, as functions of the place in it.
    pub(super) fn ray_field(&self) -> RayField {
        let pixel = 2.0 * self.half / self.size.max_element();
        let [right, down] = [self.axes.right * pixel, self.axes.up * -pixel];
        let corner = (right * self.size.x + down * self.size.y) / -2.0;
        let forward = self.axes.forward;
        match self.projection {
            Projection::Perspective => RayField {
                corner: [self.eye, forward + corner],
                steps: [[Vec3::ZERO, right], [Vec3::ZERO, down]],
            },
            Projection::Orthographic => RayField {
                corner: [self.eye + corner, forward],
                steps: [[right, Vec3::ZERO], [down, Vec3::ZERO]],
            },
        }
    }

    /// The point of the picture at which a point in space is seen, in pixels from the top left; `None` if it is not in front
    /// of the camera.
    pub(super) fn project(&self, point: Vec3) -> Option<Vec2> {
        let seen = self.axes.of(point - self.eye);
        let across = match self.projection {
            Projection::Perspective if seen.z > 0.0 => seen.truncate() / seen.z,
            Projection::Perspective => return None,
            Projection::Orthographic => seen.truncate(),
        };
        let across = Vec2::new(across.x, -across.y) / self.half;
        Some((across * self.size.max_element() + self.size) / 2.0)
    }

    /// The point on the horizontal plane at height `level` that is seen from above at a point of the picture, unless it is
    /// very far away.
    #[inline]
    pub(super) fn on_level(&self, place: Vec2, level: f32) -> Option<Vec3> {
        let (origin, direction) = self.ray(place);
        on_level(origin, direction, level).map(|distance| origin + direction * distance)
    }

    /// The same camera, moved.
    pub(super) fn moved(self, by: Vec3) -> Self {
        Self {
            eye: self.eye + by,
            ..self
        }
    }

    /// The width of a pixel on a surface at a distance along its ray.
    #[inline]
    pub(super) fn pixel(&self, distance: f32) -> f32 {
        let width = 2.0 * self.half / self.size.max_element();
        match self.projection {
            Projection::Perspective => width * distance,
            Projection::Orthographic => width,
        }
    }

    /// A factor that fades shadows towards the picture's border: 1 inside, 0 at the edge (smoothstep).
    #[inline]
    pub(super) fn border(&self, place: Vec2) -> f32 {
        let to_edge = place.min(self.size - place).min_element();
        let share = (to_edge / (MARGIN * self.size.min_element())).clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    }
}

/// The distance at which a ray from above meets the horizontal plane at height `level`, unless it is very far away.
#[inline]
pub(super) fn on_level(origin: Vec3, direction: Vec3, level: f32) -> Option<f32> {
    let distance = (level - origin.y) / direction.y;
    (direction.y <= -1e-4 && (0.0..1e6).contains(&distance)).then_some(distance)
}
