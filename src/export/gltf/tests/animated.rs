use super::*;
use crate::scene::{Animation, Interpolation, Timing, Track, Values};
use gltf::animation::util::ReadOutputs;

fn timing(times: &[f32], interpolation: Interpolation) -> Arc<Timing> {
    Arc::new(Timing {
        times: times.to_vec(),
        interpolation,
    })
}

fn turns(count: usize, step: f64) -> Values {
    let turn = |key| DQuat::from_rotation_x(key as f64 * step);
    Values::Rotations(Arc::new((0..count).map(turn).collect()))
}

fn places(count: usize) -> Values {
    let place = |key| DVec3::new(0.1 * key as f64, 1.0, -0.25);
    Values::Translations((0..count).map(place).collect())
}

fn track(node: usize, timing: &Arc<Timing>, values: Values) -> Track {
    Track {
        node: node.into(),
        timing: timing.clone(),
        values,
    }
}

/// An arm of two nodes that waves, once smoothly and once in held drawings.
pub(super) fn waving() -> Scene {
    let mut scene = single(strip(5));
    scene.nodes.raw[0].children = vec![1.into()];
    scene.nodes.push(Node {
        name: "Hand".to_owned(),
        translation: DVec3::Y,
        mesh: Some(0.into()),
        ..Node::default()
    });
    let smooth = timing(&[0.0, 0.5, 1.0], Interpolation::Linear);
    let held = timing(&[0.0, 1.0 / 3.0], Interpolation::Step);
    scene.animations = vec![
        Animation {
            name: "wave \"hello\"".to_owned(),
            tracks: vec![
                track(0, &smooth, turns(3, 0.5)),
                track(0, &smooth, places(3)),
                track(1, &smooth, turns(3, -0.7)),
            ],
        },
        Animation {
            name: "still".to_owned(),
            tracks: vec![],
        },
        Animation {
            name: "held".to_owned(),
            tracks: vec![track(1, &held, turns(2, 0.3))],
        },
    ];
    scene
}

/// Compares what a strict reader finds with the scene, key by key.
fn assert_keys(scene: &Scene, file: &[u8]) {
    let (document, buffers) = read(file);
    let wanted: Vec<&Animation> = scene
        .animations
        .iter()
        .filter(|animation| !animation.tracks.is_empty())
        .collect();
    assert_eq!(document.animations().count(), wanted.len());
    for (animation, wanted) in document.animations().zip(wanted) {
        assert_eq!(animation.name(), Some(&*wanted.name));
        assert_eq!(animation.channels().count(), wanted.tracks.len());
        for (channel, track) in animation.channels().zip(&wanted.tracks) {
            assert_eq!(NodeId::from(channel.target().node().index()), track.node);
            let (sampler, timing) = (channel.sampler(), &track.timing);
            let interpolation = match timing.interpolation {
                Interpolation::Linear => gltf::animation::Interpolation::Linear,
                Interpolation::Step => gltf::animation::Interpolation::Step,
            };
            assert_eq!(sampler.interpolation(), interpolation);
            let bound = |bound: Option<serde_json::Value>| bound.unwrap()[0].as_f64().unwrap();
            let input = sampler.input();
            assert_eq!(bound(input.min()) as f32, timing.times[0]);
            assert_eq!(bound(input.max()) as f32, *timing.times.last().unwrap());
            for accessor in [input, sampler.output()] {
                let view = accessor.view().unwrap();
                assert!(view.target().is_none() && view.stride().is_none());
            }
            let reader = channel.reader(|buffer| Some(&buffers[buffer.index()]));
            let times: Vec<f32> = reader.read_inputs().unwrap().collect();
            assert_eq!(times, timing.times);
            match (reader.read_outputs().unwrap(), &track.values) {
                (ReadOutputs::Rotations(turns), Values::Rotations(wanted)) => {
                    let turns: Vec<_> = turns.into_f32().map(glam::Quat::from_array).collect();
                    assert_eq!(turns.len(), wanted.len());
                    for (turn, wanted) in turns.iter().zip(wanted.iter()) {
                        assert!((turn.length() - 1.0).abs() < 1e-6);
                        assert!(turn.abs_diff_eq(wanted.as_quat(), 1e-6), "{turn} {wanted}");
                    }
                }
                (ReadOutputs::Translations(places), Values::Translations(wanted)) => {
                    let wanted: Vec<_> = wanted.iter().map(|p| p.as_vec3().to_array()).collect();
                    assert_eq!(places.collect::<Vec<_>>(), wanted);
                }
                _ => panic!("another kind of track"),
            }
        }
    }
}

#[test]
fn keys_are_read_back_as_they_are() {
    let scene = waving();
    let skinned = scene.clone().skinned().unwrap();
    for scene in [&scene, &skinned] {
        for exporter in BOTH {
            let file = bytes(scene, exporter);
            assert_keys(scene, &file);
            let cached = export::to_memory(exporter, scene, Some(&mut Memo::default()));
            assert_eq!(file, cached.unwrap().bytes);
        }
    }
    assert_round_trip(&scene, &GLB);
    // A model may be bones alone.
    let mut bare = scene;
    bare.meshes.clear();
    bare.nodes.iter_mut().for_each(|node| node.mesh = None);
    assert_keys(&bare, &bytes(&bare, &GLB));
    bare.animations.drain(..1);
    bare.animations.truncate(1);
    let file = json(&bytes(&bare, &GLB));
    assert!(file.get("animations").is_none() && file.get("accessors").is_none());
}

#[test]
fn equal_moments_are_one_list_whoever_shares_them() {
    let scene = waving();
    let file = json(&bytes(&scene, &GLTF));
    let inputs = file["animations"][0]["samplers"].as_array().unwrap();
    assert!(inputs.iter().all(|s| s["input"] == inputs[0]["input"]));
    assert!(inputs[0]["input"] != file["animations"][1]["samplers"][0]["input"]);
    let mut apart = scene.clone();
    for track in apart.animations.iter_mut().flat_map(|a| &mut a.tracks) {
        track.timing = Arc::new((*track.timing).clone());
    }
    assert_eq!(apart, scene);
    assert!(bytes(&apart, &GLB) == bytes(&scene, &GLB));
}

/// More keys than wait in memory, in many tracks and in many small clips: the description is never too long for its gap.
#[test]
fn long_and_many_animations_fit() {
    let nodes = 40;
    let mut scene = waving();
    scene.nodes = (0..nodes).map(|_| Node::default()).collect();
    scene.meshes.clear();
    scene.roots = scene.nodes.keys().collect();
    let times: Vec<f32> = (0..9000).map(|key| key as f32 / 24.0).collect();
    let long = timing(&times, Interpolation::Linear);
    let tracks = |timing: &Arc<Timing>| {
        let count = timing.times.len();
        (0..nodes)
            .flat_map(|node| {
                [
                    track(node, timing, turns(count, 0.01)),
                    track(node, timing, places(count)),
                ]
            })
            .collect()
    };
    scene.animations = vec![Animation {
        name: "long".to_owned(),
        tracks: tracks(&long),
    }];
    let short = (0..500).map(|index| Animation {
        name: "\u{1}\"".repeat(index % 7),
        tracks: tracks(&timing(&[index as f32 * 1.234_567e-7], Interpolation::Step)),
    });
    scene.animations.extend(short);
    let file = bytes(&scene, &GLB);
    let keys = (nodes * (9000 + 500) * 28 + (9000 + 500) * 4) as u64;
    let model = export::to_memory(&GLB, &scene, None).unwrap();
    assert_eq!(model.written.bytes, keys);
    assert!(file == model.bytes);
    let (document, buffers) = read(&file);
    let last = document.animations().last().unwrap();
    let channel = last.channels().last().unwrap();
    let reader = channel.reader(|_| Some(&buffers[0]));
    let time = reader.read_inputs().unwrap().next();
    assert_eq!(time, Some(499.0 * 1.234_567e-7_f32));
    scene.animations.truncate(1);
    assert_keys(&scene, &bytes(&scene, &GLB));
}

#[test]
fn broken_animations_are_refused() {
    let refused = |change: &dyn Fn(&mut Animation), message: &str| {
        let mut scene = waving();
        change(&mut scene.animations[0]);
        let mut out = SeekableOutput::new(io::Cursor::new(Vec::new()));
        let error = export::write(&GLB, &scene, &mut out, None).unwrap_err();
        assert!(error.to_string().contains(message), "{error}");
        assert!(out.finish().unwrap().get_ref().is_empty());
    };
    let times = |times: &'static [f32]| {
        move |animation: &mut Animation| {
            for track in &mut animation.tracks {
                track.timing = timing(times, Interpolation::Linear);
            }
        }
    };
    refused(&|a| a.tracks[1].node = 2.into(), "a node out of range");
    refused(&|a| a.tracks[2].node = 0.into(), "two tracks of one kind");
    for wrong in [
        &[][..],
        &[0.0, 0.5, 0.5],
        &[1.0, 0.5, 2.0],
        &[-0.1, 0.0, 1.0],
        &[0.0, f32::NAN, 1.0],
        &[0.0, 1.0, f32::INFINITY],
        &[f32::NAN],
    ] {
        refused(&times(wrong), "keys out of order in time, or none");
    }
    refused(&times(&[0.0, 1.0]), "a different number of keys");
    let turns = vec![DQuat::IDENTITY, DQuat::IDENTITY * 0.5, DQuat::IDENTITY];
    let wrong = Values::Rotations(turns.into());
    refused(&|a| a.tracks[0].values = wrong.clone(), "or not a rotation");
    let far = Values::Translations(vec![DVec3::ZERO, DVec3::ZERO, DVec3::X * 1e40]);
    refused(&|a| a.tracks[1].values = far.clone(), "not a number");
}
