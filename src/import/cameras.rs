//! Cameras, each at a node.

use ::gltf::Document;
use ::gltf::json::Camera as JsonCamera;
use ::gltf::json::camera::Type;
use ::gltf::json::validation::Checked;
use glam::{DMat4, DVec3};

use super::pose::{Geometry, Pose};
use super::{Clip, ImportError, NodeId, id, malformed};
use crate::math;
use crate::scene::CameraProjection;

/// The sine of the least angle between a direction and the upright axis at which the direction is turned around that axis.
const LEAST_LEVEL: f64 = 1e-4;

/// A camera at a node of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelCamera {
    /// The name of its node, or that of the camera if the node has none.
    pub name: String,
    /// How space becomes a picture. Its distances may be less strict than in a scene: what is nearer than 0 or farther than
    /// infinity does not exist.
    pub(crate) projection: CameraProjection,
    node: NodeId,
}

/// Where a camera is and where it looks, in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CameraPose {
    /// Its place, metres.
    pub(crate) eye: DVec3,
    /// To the right in the picture, a unit vector.
    pub(crate) right: DVec3,
    /// Upwards in the picture, a unit vector.
    pub(crate) up: DVec3,
    /// Towards the viewer, a unit vector.
    pub(crate) towards: DVec3,
}

impl CameraPose {
    /// The pose of a camera whose frame has this transform to the world; a scale has no meaning for cameras. `None` if a number
    /// is not finite, or if the transform has no inverse.
    fn new(to_world: DMat4) -> Option<Self> {
        let [y, z, eye] =
            [to_world.y_axis, to_world.z_axis, to_world.w_axis].map(|column| column.truncate());
        let towards = z.try_normalize()?;
        let up = y.reject_from_normalized(towards).try_normalize()?;
        eye.is_finite().then_some(Self {
            eye,
            right: up.cross(towards),
            up,
            towards,
        })
    }

    /// How far it is turned around the upright axis, degrees, as the yaw of a view. For a camera that looks straight up or down,
    /// what is up in its picture counts.
    pub(crate) fn yaw(&self) -> f64 {
        let level = math::hypot(self.towards.x, self.towards.z);
        let yaw = if level > LEAST_LEVEL {
            math::atan2(self.towards.x, self.towards.z)
        } else {
            math::atan2(-self.right.z, self.right.x)
        };
        yaw.to_degrees()
    }
}

impl Geometry {
    /// Where a camera is in a pose.
    pub(crate) fn camera_pose(&self, pose: &Pose, camera: &ModelCamera) -> Option<CameraPose> {
        CameraPose::new(self.to_world(pose, camera.node))
    }

    /// Whether a clip moves a camera, or what carries it.
    pub(crate) fn is_moved(&self, camera: &ModelCamera, clip: &Clip) -> bool {
        let mut node = Some(camera.node);
        while let Some(id) = node {
            if clip.moves(id) {
                return true;
            }
            node = self.nodes[id].parent;
        }
        false
    }

    /// The pose with all cameras at rest, except one: poses that look equal are equal then. What a camera carries moves as before.
    pub(crate) fn without_cameras(
        &self,
        mut pose: Pose,
        cameras: &[ModelCamera],
        except: Option<&ModelCamera>,
    ) -> Pose {
        let still = cameras.iter().filter(|camera| Some(*camera) != except);
        for ModelCamera { node, .. } in still {
            if !self.carries(*node) {
                pose.locals[*node] = self.nodes[*node].local;
            }
        }
        pose
    }

    /// Whether a node has a mesh or children, or is a joint.
    fn carries(&self, node: NodeId) -> bool {
        self.nodes[node].mesh.is_some()
            || self.nodes.iter().any(|other| other.parent == Some(node))
            || self.skins.iter().any(|skin| skin.joints.contains(&node))
    }
}

/// Reads the cameras of a file's nodes, in the order of the nodes.
///
/// # Errors
/// A camera without a projection, or whose picture has no size.
pub(crate) fn read(
    document: &Document,
    geometry: &Geometry,
) -> Result<Vec<ModelCamera>, ImportError> {
    let json = &document.as_json().cameras;
    let projections = json.iter().enumerate().map(|(index, camera)| {
        projection(camera).ok_or_else(|| {
            malformed(format!(
                "camera {index} has no angle between 0 and 180 degrees, or no size"
            ))
        })
    });
    let projections: Vec<CameraProjection> = projections.collect::<Result<_, _>>()?;
    let at = |node: ::gltf::Node<'_>| {
        let index = node.camera()?.index();
        let name = node.name().or(json[index].name.as_deref());
        Some(ModelCamera {
            name: name.unwrap_or_default().to_owned(),
            projection: projections[index],
            node: id(&node),
        })
    };
    let nodes = document.nodes();
    Ok(nodes
        .filter(|node| geometry.visible[id(node)])
        .filter_map(at)
        .collect())
}

/// The projection of a camera. Distances out of range, which many programs write, limit nothing.
fn projection(camera: &JsonCamera) -> Option<CameraProjection> {
    let nearest = |near: f32| f64::from(near).max(0.0);
    let farthest = |near: f64, far: f32| Some(f64::from(far)).filter(|far| *far > near);
    match (&camera.type_, &camera.perspective, &camera.orthographic) {
        (Checked::Valid(Type::Perspective), Some(lens), _) => {
            let near = nearest(lens.znear);
            let angle = f64::from(lens.yfov);
            (angle > 0.0 && angle < std::f64::consts::PI).then_some(CameraProjection::Perspective {
                vertical_field_of_view: angle,
                near,
                far: lens.zfar.and_then(|far| farthest(near, far)),
            })
        }
        (Checked::Valid(Type::Orthographic), _, Some(lens)) => {
            let near = nearest(lens.znear);
            // Negative magnifications, which some programs write, would turn the picture upside down.
            let half_height = f64::from(lens.ymag).abs();
            (half_height > 0.0 && half_height.is_finite()).then_some(
                CameraProjection::Orthographic {
                    half_height,
                    near,
                    far: farthest(near, lens.zfar).unwrap_or(f64::INFINITY),
                },
            )
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::resolver::MemoryResolver;

    /// The cameras of a file with this JSON, and its geometry.
    fn cameras(root: &Value) -> Result<(Geometry, Vec<ModelCamera>), ImportError> {
        let bytes = serde_json::to_vec(root).unwrap();
        let file = crate::import::read(&bytes, &MemoryResolver::default())?;
        let cameras = read(&file.document, &file.geometry)?;
        Ok((file.geometry, cameras))
    }

    fn two() -> Value {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0, 3] }],
            "nodes": [
                { "children": [1], "translation": [1, 2, 3], "scale": [2, 2, 2] },
                { "camera": 1, "name": "Eye", "translation": [0, 1, 0], "rotation": [0, half, 0, half] },
                { "camera": 0, "name": "Hidden" },
                { "camera": 0 },
            ],
            "cameras": [
                {
                    "name": "Lens",
                    "type": "perspective",
                    "perspective": { "yfov": 0.5, "znear": 0.125, "aspectRatio": 1.5 },
                },
                {
                    "type": "orthographic",
                    "orthographic": { "xmag": 3, "ymag": -2, "znear": 0, "zfar": 8 },
                },
            ],
        })
    }

    #[test]
    fn cameras_are_read_with_their_nodes() {
        let (geometry, cameras) = cameras(&two()).unwrap();
        let names: Vec<&str> = cameras.iter().map(|camera| &*camera.name).collect();
        assert_eq!(names, ["Eye", "Lens"]);
        assert_eq!(
            cameras[1].projection,
            CameraProjection::Perspective {
                vertical_field_of_view: 0.5,
                near: 0.125,
                far: None,
            }
        );
        assert_eq!(
            cameras[0].projection,
            CameraProjection::Orthographic {
                half_height: 2.0,
                near: 0.0,
                far: 8.0,
            }
        );
        let rest = geometry.rest();
        let eye = geometry.camera_pose(&rest, &cameras[0]).unwrap();
        let close = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-6, "{a} {b}");
        close(eye.eye, DVec3::new(1.0, 4.0, 3.0));
        // Turned to its left by a right angle, it looks along -x.
        close(eye.towards, DVec3::X);
        close(eye.right, DVec3::NEG_Z);
        close(eye.up, DVec3::Y);
    }

    #[test]
    fn distances_out_of_range_limit_nothing_and_angles_are_refused() {
        let with = |lens: Value| {
            let mut root = two();
            root["cameras"][0]["perspective"] = lens;
            cameras(&root).map(|(_, cameras)| cameras[1].projection)
        };
        let projection = with(json!({ "yfov": 0.5, "znear": -1, "zfar": 0 })).unwrap();
        assert_eq!(
            projection,
            CameraProjection::Perspective {
                vertical_field_of_view: 0.5,
                near: 0.0,
                far: None,
            }
        );
        for angle in [0.0, -1.0, 3.2] {
            let error = with(json!({ "yfov": angle, "znear": 1 })).unwrap_err();
            assert!(error.to_string().contains("camera 0 has no angle"));
        }
        // The other projection than its type says.
        let mut root = two();
        root["cameras"][0]["type"] = "orthographic".into();
        assert!(cameras(&root).is_err());
        root["cameras"][0]["type"] = "fisheye".into();
        assert!(cameras(&root).is_err());
        root = two();
        root["nodes"][1]["camera"] = 2.into();
        assert!(cameras(&root).is_err());
    }

    #[test]
    fn a_camera_without_a_direction_has_no_pose() {
        let mut root = two();
        root["nodes"][0]["scale"] = json!([0, 0, 0]);
        let (geometry, cameras) = cameras(&root).unwrap();
        assert_eq!(geometry.camera_pose(&geometry.rest(), &cameras[0]), None);
    }
}
