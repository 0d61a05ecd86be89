use super::*;

/// A chain of turned nodes, each with a strip of its own material.
fn chain(joints: usize) -> Scene {
    let node = |index: usize| Node {
        name: format!("N{index}"),
        children: if index + 1 < joints {
            vec![(index + 1).into()]
        } else {
            vec![]
        },
        translation: DVec3::new(0.5, 1.0, -0.25),
        rotation: DQuat::from_rotation_z(0.7) * DQuat::from_rotation_x(0.3),
        mesh: Some((index % 3).into()),
        ..Node::default()
    };
    let mesh = |material: usize| Mesh {
        primitives: vec![primitive(strip(5 + material as u32), material % 2)],
    };
    Scene {
        nodes: (0..joints).map(node).collect(),
        roots: vec![0.into()],
        meshes: (0..3).map(mesh).collect(),
        materials: ti_vec![material(1.0), material(0.5)],
        ..Scene::default()
    }
}

/// All corners in the world, once by the nodes and once by the skin, with any pose of the joints.
fn corners(bytes: &[u8], pose: impl Fn(usize) -> glam::Mat4) -> Vec<[f32; 3]> {
    use glam::{Mat4, Vec3};
    let (document, buffers) = read(bytes);
    let nodes: Vec<_> = document.nodes().collect();
    let mut world = vec![Mat4::IDENTITY; nodes.len()];
    let mut waiting: Vec<(usize, Mat4)> = vec![];
    waiting.extend(
        document
            .scenes()
            .next()
            .unwrap()
            .nodes()
            .map(|node| (node.index(), Mat4::IDENTITY)),
    );
    while let Some((index, outer)) = waiting.pop() {
        let own = Mat4::from_cols_array_2d(&nodes[index].transform().matrix());
        world[index] = outer * own * pose(index);
        waiting.extend(
            nodes[index]
                .children()
                .map(|child| (child.index(), world[index])),
        );
    }
    let mut out = vec![];
    for node in &nodes {
        let Some(mesh) = node.mesh() else { continue };
        let joints: Option<Vec<Mat4>> = node.skin().map(|skin| {
            let reader = skin.reader(|_| Some(&buffers[0]));
            let back = reader.read_inverse_bind_matrices().unwrap();
            let joints = skin.joints().zip(back);
            joints
                .map(|(joint, back)| world[joint.index()] * Mat4::from_cols_array_2d(&back))
                .collect()
        });
        for primitive in mesh.primitives() {
            let reader = primitive.reader(|_| Some(&buffers[0]));
            let positions: Vec<_> = reader.read_positions().unwrap().map(Vec3::from).collect();
            match &joints {
                None => out.extend(
                    positions
                        .iter()
                        .map(|p| world[node.index()].transform_point3(*p).to_array()),
                ),
                Some(joints) => {
                    let numbers = reader.read_joints(0).unwrap().into_u16();
                    let weights = reader.read_weights(0).unwrap().into_f32();
                    for ((p, numbers), weights) in positions.iter().zip(numbers).zip(weights) {
                        assert_eq!(weights, [1.0, 0.0, 0.0, 0.0]);
                        out.push(joints[numbers[0] as usize].transform_point3(*p).to_array());
                    }
                }
            }
        }
    }
    out.sort_by(|a, b| (a[0], a[1], a[2]).partial_cmp(&(b[0], b[1], b[2])).unwrap());
    out
}

/// 300 joints have numbers of two bytes, 3 of one.
#[test]
fn a_skinned_model_stands_and_moves_like_the_other() {
    for joints in [3, 300] {
        let scene = chain(joints);
        let skinned = scene.clone().skinned().unwrap();
        assert_eq!(skinned.meshes.len(), 1);
        assert_eq!(skinned.meshes.raw[0].primitives.len(), 2);
        for exporter in BOTH {
            let [plain, skin] = [&scene, &skinned].map(|scene| bytes(scene, exporter));
            for turned in [usize::MAX, 1] {
                let pose = |index: usize| {
                    if index == turned {
                        glam::Mat4::from_rotation_y(1.0)
                    } else {
                        glam::Mat4::IDENTITY
                    }
                };
                let [plain, skin] = [&plain, &skin].map(|bytes| corners(bytes, pose));
                assert_eq!(plain.len(), skin.len());
                let far = plain.as_flattened().iter().zip(skin.as_flattened());
                let far = far.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(far < 1e-3, "{joints} joints, {turned} turned: {far}");
            }
        }
    }
}

#[test]
fn a_skin_has_an_end() {
    let most = chain(crate::scene::MAX_JOINTS);
    assert!(most.skinned().is_ok());
    let error = chain(crate::scene::MAX_JOINTS + 1).skinned().unwrap_err();
    assert!(error.to_string().contains("65537 joints"));
    let empty = Scene::default().skinned().unwrap();
    assert_eq!(empty, Scene::default());
}
