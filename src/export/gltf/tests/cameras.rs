use super::animated::waving;
use super::*;
use crate::scene::{Animation, Camera, CameraProjection, Interpolation, Timing, Track, Values};

/// A waving arm and two cameras, one of which moves in held drawings and turns smoothly.
fn filmed() -> Scene {
    let mut scene = waving();
    let camera = scene.nodes.next_key();
    for (number, name) in ["Camera wave", "Above"].into_iter().enumerate() {
        scene.add(crate::scene::NewNode {
            node: Node {
                name: name.to_owned(),
                translation: DVec3::new(0.0, 1.0, 4.0),
                camera: Some(number.into()),
                ..Node::default()
            },
            mesh: None,
            parent: None,
        });
    }
    scene.cameras = ti_vec![
        Camera {
            name: "wave".to_owned(),
            projection: CameraProjection::Perspective {
                vertical_field_of_view: 0.5,
                near: 0.125,
                far: None,
            },
        },
        Camera {
            name: String::new(),
            projection: CameraProjection::Orthographic {
                half_height: 2.0,
                near: 0.0,
                far: 16.0,
            },
        },
    ];
    let timing = |interpolation| {
        Arc::new(Timing {
            times: vec![0.0, 0.5],
            interpolation,
        })
    };
    let turn = DQuat::from_rotation_y(0.5);
    scene.animations.push(Animation {
        name: "filmed".to_owned(),
        tracks: vec![
            Track {
                node: camera,
                timing: timing(Interpolation::Step),
                values: Values::Translations(vec![DVec3::Z * 4.0, DVec3::Z * 2.0]),
            },
            Track {
                node: camera,
                timing: timing(Interpolation::Linear),
                values: Values::Rotations(vec![DQuat::IDENTITY, turn].into()),
            },
        ],
    });
    scene
}

#[test]
fn cameras_are_written_with_their_nodes_and_tracks() {
    for exporter in BOTH {
        let scene = filmed();
        let file = bytes(&scene, exporter);
        assert_round_trip(&scene, exporter);
        let json = json(&file);
        assert_eq!(
            json["cameras"],
            json!([
                {
                    "name": "wave",
                    "type": "perspective",
                    "perspective": { "yfov": 0.5, "znear": 0.125 },
                },
                {
                    "type": "orthographic",
                    "orthographic": { "xmag": 2, "ymag": 2, "zfar": 16, "znear": 0 },
                },
            ])
        );
        let node = &json["nodes"][2];
        assert_eq!(
            *node,
            json!({ "name": "Camera wave", "camera": 0, "translation": [0, 1, 4] })
        );
        assert_eq!(json["nodes"][4]["children"], json!([0, 2, 3]));
        let channels = &json["animations"][2]["channels"];
        assert_eq!(channels[0]["target"]["node"], 2);
        assert_eq!(channels[0]["target"]["path"], "translation");
        let samplers = &json["animations"][2]["samplers"];
        assert_eq!(samplers[0]["interpolation"], "STEP");
    }
}

#[test]
fn a_camera_is_no_joint_of_a_skin() {
    let mut scene = filmed();
    // The camera comes before the hand.
    scene.nodes.swap(1.into(), 2.into());
    scene.nodes.raw[0].children = vec![2.into()];
    scene.roots = [0, 1, 3].map(NodeId::from).to_vec();
    scene.animations.clear();
    let hand = scene.nodes.raw[0].mesh;
    scene.nodes.raw[2].mesh = hand;
    let skinned = scene.skinned().unwrap();
    let skin = skinned.skin.as_ref().unwrap();
    assert_eq!(skin.joints, [0, 2].map(NodeId::from));
    assert_eq!(skin.rest.len(), 2);
    let file = bytes(&skinned, &GLB);
    let json = json(&file);
    assert_eq!(json["skins"][0]["joints"], json!([0, 2]));
    assert_eq!(json["nodes"][1]["camera"], 0);
    let (document, buffers) = read(&file);
    let mesh = document.meshes().next().unwrap();
    let primitive = mesh.primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(&buffers[0]));
    let joints = reader.read_joints(0).unwrap().into_u16();
    let mut joints: Vec<u16> = joints.map(|joints| joints[0]).collect();
    joints.dedup();
    assert_eq!(joints, [0, 1]);
}

#[test]
fn invalid_cameras_are_refused() {
    let break_it: [fn(&mut Scene); 5] = [
        |scene| scene.nodes.raw[2].camera = Some(2.into()),
        |scene| scene.nodes.raw[2].mesh = Some(0.into()),
        |scene| scene.nodes.raw[2].children = vec![3.into()],
        |scene| scene.roots = [0, 3].map(NodeId::from).to_vec(),
        |scene| {
            scene.cameras.raw[0].projection = CameraProjection::Perspective {
                vertical_field_of_view: f64::NAN,
                near: 0.1,
                far: None,
            };
        },
    ];
    for break_it in break_it {
        let mut scene = filmed();
        break_it(&mut scene);
        let error = export::to_memory(&GLB, &scene, None).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
        assert!(error.to_string().contains("camera"), "{error}");
    }
}
