//! A model of a clip's skeleton: a bone for each joint that leads to another, so that viewers show what a motion file holds.

use std::sync::Arc;

use glam::{DQuat, DVec3, Vec3};

use super::limited::Exposure;
use super::skeleton::{Channel, Clip, Transform, height};
use super::turns::continuous;
use crate::scene::{
    Animation, Interpolation, Material, Mesh, Node, Primitive, Scene, Surface, Timing, Track,
    Values,
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
pub fn skeleton_model(
    clip: &Clip,
    exposure: Option<&Exposure>,
    name: &str,
    to_model: DQuat,
) -> Scene {
    let skeleton = &clip.skeleton;
    let first = match clip.frames() {
        0 => skeleton.offset_pose(),
        _ => clip.pose(0),
    };
    let scale = scale(&first, to_model);
    let mut scene = Scene {
        materials: vec![Material {
            name: "bone".to_owned(),
            base_color: [0.61, 0.55, 0.42, 1.0],
            ..Material::default()
        }],
        ..Scene::default()
    };
    let children = skeleton.children();
    for (index, joint) in skeleton.joints.iter().enumerate() {
        let ways = children[index]
            .iter()
            .map(|child| skeleton.joints[*child].offset);
        let ways: Vec<DVec3> = ways
            .chain(joint.ends.iter().copied())
            .map(|way| way * scale)
            .collect();
        scene.meshes.push(Mesh {
            primitives: vec![Primitive {
                pieces: vec![bones(&ways).into()],
                material: 0,
            }],
        });
        let at_root = joint.parent.is_none();
        scene.nodes.push(Node {
            name: joint.name.clone(),
            children: children[index].clone(),
            translation: match at_root {
                true => to_model * joint.offset * scale,
                false => joint.offset * scale,
            },
            rotation: if at_root { to_model } else { DQuat::IDENTITY },
            mesh: Some(index),
            ..Node::default()
        });
        if at_root {
            scene.roots.push(index);
        }
    }
    scene
        .animations
        .push(animation(clip, exposure, name, to_model, scale));
    scene
}

/// Metres per unit of the file.
fn scale(pose: &[Transform], to_model: DQuat) -> f64 {
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
    let step = clip.frame_time;
    let keys: Vec<[usize; 2]> = match exposure {
        Some(sheet) => sheet.step_keys(),
        None => (0..clip.frames()).map(|frame| [frame; 2]).collect(),
    };
    let mut animation = Animation {
        name: name.to_owned(),
        tracks: Vec::new(),
    };
    if keys.is_empty() {
        return animation;
    }
    let timing = Arc::new(Timing {
        times: keys
            .iter()
            .map(|[at, _]| (*at as f64 * step) as f32)
            .collect(),
        interpolation: match exposure {
            Some(_) => Interpolation::Step,
            None => Interpolation::Linear,
        },
    });
    let mut start = 0;
    for (node, joint) in clip.skeleton.joints.iter().enumerate() {
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
            .iter()
            .map(|[_, frame]| Clip::local(joint, &clip.row(*frame)[numbers.clone()]));
        let (turns, places): (Vec<DQuat>, Vec<DVec3>) = local
            .map(|local| (turn * local.rotation, turn * local.position * scale))
            .unzip();
        let moves = joint
            .channels
            .iter()
            .any(|channel| matches!(channel, Channel::Position(_)));
        let mut add = |values| {
            animation.tracks.push(Track {
                node,
                timing: Arc::clone(&timing),
                values,
            });
        };
        if moves {
            add(Values::Translations(places));
        }
        add(Values::Rotations(continuous(turns)));
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
