//! A model of a clip's skeleton: a bone for each joint that leads to another, so that viewers show what a motion file holds.

use glam::{DQuat, DVec2, DVec3, Vec3};
use typed_index_collections::TiSlice;

use crate::limited::{Exposure, KeyTimes};
use crate::mocap::turns::continuous;
use crate::mocap::{Channel, Clip, JointId, Transform, height};
use crate::performance::{Filmed, Filming};
use crate::scene::{
    Animation, Material, Mesh, Node, NodeId, Primitive, Scene, Surface, Track, Values,
    WorldTransform,
};

/// The height of the model in the first frame, metres: files have any unit.
const HEIGHT: f64 = 1.7;
/// The thickness of a bone, as a share of its length.
const GIRTH: f64 = 0.1;
/// Where a bone is thickest, as a share of its length from the joint.
const WAIST: f64 = 0.2;
/// The size of a joint without a bone, as a share of the model's height.
const KNOB: f64 = 0.01;

/// A model of the clip's skeleton with its animation: linear from frame to frame without an exposure sheet, else one step per
/// drawing. `to_model` rotates the clip's world so that it stands upright and faces +z.
pub(crate) fn skeleton_model(
    clip: &Clip,
    exposure: Option<&Exposure>,
    name: &str,
    to_model: DQuat,
) -> Scene {
    let skeleton = &clip.skeleton;
    let first = match clip.frames {
        0 => skeleton.offset_pose(),
        _ => clip.pose(0),
    };
    let scale = scale(&first, to_model);
    let mut scene = Scene::default();
    let material = scene.materials.push_and_get_key(Material {
        name: "bone".to_owned(),
        base_color: [0.61, 0.55, 0.42, 1.0],
        ..Material::default()
    });
    let children = skeleton.children();
    for (id, joint) in skeleton.joints.iter_enumerated() {
        let ways = children[id]
            .iter()
            .map(|child| skeleton.joints[*child].offset);
        let ways: Vec<DVec3> = ways
            .chain(joint.ends.iter().copied())
            .map(|way| way * scale)
            .collect();
        let mesh = scene.meshes.push_and_get_key(Mesh {
            primitives: vec![Primitive {
                patches: vec![bones(&ways).into()],
                material,
            }],
        });
        let at_root = joint.parent.is_none();
        let node = scene.nodes.push_and_get_key(Node {
            name: joint.name.clone(),
            children: children[id].iter().copied().map(node_of).collect(),
            translation: if at_root {
                to_model * joint.offset * scale
            } else {
                joint.offset * scale
            },
            rotation: if at_root { to_model } else { DQuat::IDENTITY },
            mesh: Some(mesh),
            ..Node::default()
        });
        if at_root {
            scene.roots.push(node);
        }
    }
    scene
        .animations
        .push(animation(clip, exposure, name, to_model, scale));
    scene
}

/// Films the model of a clip's skeleton, which [`skeleton_model`] made: a camera keeps a joint in the middle of its picture.
pub(crate) fn add_camera(
    scene: &mut Scene,
    clip: &Clip,
    exposure: Option<&Exposure>,
    joint: JointId,
    to_model: DQuat,
) {
    let Some(mut animation) = scene.animations.pop() else {
        return;
    };
    let world = WorldTransform {
        origin: DVec2::ZERO,
        rotation: DQuat::IDENTITY,
        scale: scale(&clip.pose(0), to_model),
    };
    let points: Vec<DVec3> = clip.positions().iter().map(|at| to_model * *at).collect();
    let shown = Exposure::shown(exposure, clip.frames);
    let keys = KeyTimes::of_shown(exposure, clip.frames, clip.frame_time);
    let per_frame = clip.skeleton.joints.len();
    let filmed = Filmed::new(Filming::Camera, &points, per_frame, &shown, joint.into());
    filmed.add_camera(&world, &keys, &mut animation, scene);
    scene.animations.push(animation);
}

/// The node of a joint: they have the same order.
fn node_of(joint: JointId) -> NodeId {
    usize::from(joint).into()
}

/// Metres per unit of the file.
fn scale(pose: &TiSlice<JointId, Transform>, to_model: DQuat) -> f64 {
    match height(pose.iter().map(|placed| to_model * placed.position)) {
        height if height > 0.0 && height.is_finite() => HEIGHT / height,
        _ => 1.0,
    }
}

fn animation(
    clip: &Clip,
    exposure: Option<&Exposure>,
    name: &str,
    to_model: DQuat,
    scale: f64,
) -> Animation {
    let keys = KeyTimes::new(exposure, clip.frames, clip.frame_time);
    let mut animation = Animation {
        name: name.to_owned(),
        tracks: Vec::new(),
    };
    if keys.frames.is_empty() {
        return animation;
    }
    let mut start = 0;
    for (id, joint) in clip.skeleton.joints.iter_enumerated() {
        let numbers = start..start + joint.channels.len();
        start = numbers.end;
        if joint.channels.is_empty() {
            continue;
        }
        let turn = if joint.parent.is_none() {
            to_model
        } else {
            DQuat::IDENTITY
        };
        let local = keys
            .frames
            .iter()
            .map(|frame| Clip::local(joint, &clip.row(*frame)[numbers.clone()]));
        let (turns, places): (Vec<DQuat>, Vec<DVec3>) = local
            .map(|local| (turn * local.rotation, turn * local.position * scale))
            .unzip();
        let moves = joint
            .channels
            .iter()
            .any(|channel| matches!(channel, Channel::Position(_)));
        let mut add = |values| {
            animation.tracks.push(Track {
                node: node_of(id),
                timing: keys.timing(),
                values,
            });
        };
        if moves {
            add(Values::Translations(places));
        }
        add(Values::Rotations(continuous(turns).into()));
    }
    animation
}

/// Bones from a joint to these points; without any, a small one that points up.
fn bones(ways: &[DVec3]) -> Surface {
    let mut surface = Surface::default();
    for way in ways {
        surface.append(&bone(*way));
    }
    if surface.triangles.is_empty() {
        surface.append(&bone(DVec3::Y * (HEIGHT * KNOB)));
    }
    surface
}

/// A bone as two pyramids, base to base; nothing for a bone without length.
fn bone(way: DVec3) -> Surface {
    let Some(along) = way.try_normalize() else {
        return Surface::default();
    };
    let (across, over) = along.any_orthonormal_pair();
    let girth = way.length() * GIRTH;
    let waist = [across, over, -across, -over].map(|side| way * WAIST + side * girth);
    let mut surface = Surface::default();
    for side in 0..4 {
        let [a, b] = [waist[side], waist[(side + 1) % 4]];
        for corners in [[DVec3::ZERO, b, a], [way, a, b]] {
            // Triangles do not share corners, so that the bone's edges look sharp.
            let corners = corners.map(DVec3::as_vec3);
            let normal = (corners[1] - corners[0])
                .cross(corners[2] - corners[0])
                .normalize_or(Vec3::Y);
            let base = surface.positions.len() as u32;
            surface
                .positions
                .extend(corners.map(|corner| corner.to_array()));
            surface.normals.extend([normal.to_array(); 3]);
            surface.triangles.push([base, base + 1, base + 2]);
        }
    }
    surface
}
