//! Where the camera stands and what it sees.

use std::borrow::Cow;

use glam::{DVec3, Vec2, Vec3};

/// How far the camera can be lifted or lowered, degrees.
pub const PITCH_LIMIT: f64 = 90.0;
/// Half the picture's longer side at distance 1: that of an 85 mm lens on film of 36 mm, which flatters without
/// flattening.
const LENS: f32 = 18.0 / 85.0;
/// The empty border, as a share of the picture's shorter side.
pub(super) const MARGIN: f32 = 0.06;
/// The smallest half extent that is framed, so that a flat thing seen edge-on has a scale.
const LEAST: f32 = 1e-4;

/// How often the picture is centred; each time leaves a small part of what the last one left.
const CENTRINGS: usize = 3;

/// The direction that the camera looks from, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Turns the camera about the model to the model's left; 0 looks at its front.
    pub yaw: f64,
    /// Lifts the camera; 90 looks down on the model.
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
        let (yaw_sin, yaw_cos) = self.yaw.to_radians().sin_cos();
        let (pitch_sin, pitch_cos) = self.pitch.to_radians().sin_cos();
        [
            DVec3::new(yaw_cos, 0.0, -yaw_sin),
            DVec3::new(-pitch_sin * yaw_sin, pitch_cos, -pitch_sin * yaw_cos),
            DVec3::new(pitch_cos * yaw_sin, pitch_sin, pitch_cos * yaw_cos),
        ]
    }
}

/// How space becomes a plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Projection {
    /// What is farther away is smaller.
    #[default]
    Perspective,
    /// Parallels stay parallel.
    Orthographic,
}

/// The axes of a view, unit vectors.
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

/// Where the picture's edges lie, in the coordinates of the camera (right, up, depth).
#[derive(Debug, Clone, Copy)]
pub(super) struct Framing {
    projection: Projection,
    size: [u32; 2],
    middle: Vec2,
    /// Depth of the eye, or of the plane that parallel rays start from.
    depth: f32,
    /// Half the picture's longer side: at distance 1, or for parallel rays anywhere.
    half: f32,
}

impl Framing {
    /// Has all points in the picture at each of the sights, with a margin, as large as they can be. A sight is a view and
    /// something that tells the sights of one view apart; `points` tells what is to be seen there, and may fail.
    pub(super) fn new<'p, S: Copy, E>(
        sights: &[(View, S)],
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
        // How far the four planes that bound the picture lie out: right, top, left, bottom.
        let mut high = Vec2::NEG_INFINITY;
        let mut low = Vec2::NEG_INFINITY;
        let mut nearest = f32::INFINITY;
        for (view, sight) in sights {
            let axes = Axes::new(*view);
            for point in &*points(*view, *sight)? {
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
                framing.centre(sights, &points)?;
            }
        }
        Ok(framing)
    }

    /// Moves the eye sideways, so that the border is as wide on the left as on the right, and above as below.
    fn centre<'p, S: Copy, E>(
        &mut self,
        sights: &[(View, S)],
        points: impl Fn(View, S) -> Result<Cow<'p, [Vec3]>, E>,
    ) -> Result<(), E> {
        let mut high = Vec2::NEG_INFINITY;
        let mut low = Vec2::NEG_INFINITY;
        for (view, sight) in sights {
            let axes = Axes::new(*view);
            for point in &*points(*view, *sight)? {
                let seen = axes.of(*point);
                let place = (seen.truncate() - self.middle) / (seen.z - self.depth);
                high = high.max(place);
                low = low.max(-place);
            }
        }
        // The model's middle lies at depth 0.
        self.middle += (high - low) / 2.0 * -self.depth;
        Ok(())
    }

    /// The camera that sees one of the views so.
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
        }
    }
}

/// A camera.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    axes: Axes,
    projection: Projection,
    /// The degrees that it is turned by; the lights turn with it.
    pub(super) yaw: f64,
    eye: Vec3,
    half: f32,
    size: Vec2,
}

impl Camera {
    /// Where the ray through a place in the picture starts, and its direction. Pixels, from the top left.
    pub(super) fn ray(&self, place: Vec2) -> (Vec3, Vec3) {
        let longer = self.size.max_element();
        let across = (place * 2.0 - self.size) / longer * self.half;
        let (right, up) = (self.axes.right * across.x, self.axes.up * -across.y);
        match self.projection {
            Projection::Perspective => (self.eye, (self.axes.forward + right + up).normalize()),
            Projection::Orthographic => (self.eye + right + up, self.axes.forward),
        }
    }

    /// How wide a pixel is on something that a ray meets after `distance`.
    pub(super) fn pixel(&self, distance: f32) -> f32 {
        let width = 2.0 * self.half / self.size.max_element();
        match self.projection {
            Projection::Perspective => width * distance,
            Projection::Orthographic => width,
        }
    }

    /// How much of what lies at the picture's border is left: 1 inside, 0 at the edge.
    pub(super) fn border(&self, place: Vec2) -> f32 {
        let to_edge = place.min(self.size - place).min_element();
        let share = (to_edge / (MARGIN * self.size.min_element())).clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    }
}
