//! How a performance is filmed: by a camera of its own, or by moving the figure (docs/performance.md).

use glam::DVec3;

use super::camerawork::{CAMERA_FOV, CameraPath, camerawork};
use super::plan::Filming;
use crate::limited::KeyTimes;
use crate::scene::{
    Animation, Camera, CameraProjection, NewNode, Node, Scene, Track, Values, WorldTransform,
};

/// The near plane of a camera, as a share of its least distance from what it follows.
const NEAR: f64 = 0.02;

/// How a clip is filmed; lengths in the axes and the unit of the clip.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Filmed {
    /// Not at all.
    #[default]
    No,
    /// By a camera at these positions, one for each shown frame.
    Camera(CameraPath),
    /// By moving the figure.
    Character {
        /// By how much, per shown frame.
        shifts: Vec<DVec3>,
        /// The shown frame in which it is nearest to the viewer.
        nearest: usize,
    },
}

impl Filmed {
    /// Films what is shown of a clip along −z: `points` has so many per frame (x to the right, y up), `shown` are the frames that are
    /// seen one after the other, and the point `middle` is in the middle of the picture.
    pub fn new(
        filming: Filming,
        points: &[DVec3],
        per_frame: usize,
        shown: &[usize],
        middle: usize,
    ) -> Self {
        if filming == Filming::None || shown.is_empty() {
            return Self::No;
        }
        let points = |frame: usize| &points[frame * per_frame..][..per_frame];
        let tip = |frame: &usize| points(*frame)[middle];
        let joint: Vec<DVec3> = shown.iter().map(tip).collect();
        let (mut reach, mut depth) = (0.0_f64, 0.0_f64);
        for (frame, joint) in shown.iter().zip(&joint) {
            for point in points(*frame) {
                let way = *point - *joint;
                reach = reach.max(way.x.abs()).max(way.y.abs());
                depth = depth.max(way.z);
            }
        }
        let path = camerawork(&joint, DVec3::Z, reach, depth);
        match filming {
            Filming::Character => {
                let far = path.distances.iter().copied().fold(0.0, f64::max);
                let ways = joint.iter().zip(&path.distances);
                let shift =
                    |(at, distance): (&DVec3, &f64)| joint[0] - *at + DVec3::Z * (far - distance);
                Self::Character {
                    shifts: ways.map(shift).collect(),
                    nearest: path.nearest,
                }
            }
            _ => Self::Camera(path),
        }
    }

    /// The shown frame in which the camera, or the figure, is nearest.
    pub fn nearest(&self) -> Option<usize> {
        match self {
            Self::No => None,
            Self::Camera(path) => Some(path.nearest),
            Self::Character { nearest, .. } => Some(*nearest),
        }
    }

    /// By how much the figure is moved in each shown frame.
    pub fn shifts(&self) -> Option<&[DVec3]> {
        match self {
            Self::Character { shifts, .. } => Some(shifts),
            _ => None,
        }
    }

    /// Adds the camera of a clip to the scene, and its motion to the clip. `keys` has a key for each shown frame.
    pub fn add_camera(
        &self,
        world: &WorldTransform,
        keys: &KeyTimes,
        animation: &mut Animation,
        scene: &mut Scene,
    ) {
        let Self::Camera(path) = self else { return };
        let nearest = path.distances.iter().copied().fold(f64::INFINITY, f64::min);
        let projection = CameraProjection::Perspective {
            vertical_field_of_view: CAMERA_FOV,
            near: nearest * NEAR * world.scale,
            far: None,
        };
        // A figure of no size has no distance to film it from.
        let Some(first) = path.positions.first().filter(|_| projection.is_valid()) else {
            return;
        };
        let name = free_name(scene, &animation.name);
        let camera = scene.cameras.push_and_get_key(Camera {
            name: name.clone(),
            projection,
        });
        let node = scene.add(NewNode {
            node: Node {
                name,
                translation: world.point(*first),
                rotation: world.rotation,
                camera: Some(camera),
                ..Node::default()
            },
            ..NewNode::default()
        });
        animation.tracks.push(Track {
            node,
            timing: keys.timing(),
            values: Values::Translations(
                keys.of(&path.positions).map(|at| world.point(at)).collect(),
            ),
        });
    }
}

/// A name for the camera of a clip that no other camera has.
fn free_name(scene: &Scene, clip: &str) -> String {
    let wanted = format!("{clip} camera");
    let is_free = |name: &String| scene.cameras.iter().all(|camera| camera.name != *name);
    let numbered = (2..).map(|number| format!("{wanted} {number}"));
    let mut names = std::iter::once(wanted.clone()).chain(numbered);
    names.find(is_free).unwrap_or(wanted)
}
