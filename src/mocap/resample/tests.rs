use std::f64::consts::PI;
use std::path::Path;

use fastrand::Rng;
use glam::{DQuat, DVec3};

use super::*;
use crate::mocap::bvh::read_bytes;
use crate::mocap::{Axis, Channel, Joint, Skeleton};

const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

fn file(name: &str) -> Clip {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    read_bytes(&std::fs::read(path).unwrap()).unwrap().clip
}

fn single(axes: &[Axis], fps: f64, rows: &[Vec<f64>]) -> Clip {
    let joint = Joint {
        name: "Hips".to_owned(),
        channels: axes.iter().map(|axis| Channel::Rotation(*axis)).collect(),
        ..Joint::default()
    };
    let skeleton = Skeleton {
        joints: vec![joint].into(),
    };
    Clip::new(Arc::new(skeleton), 1.0 / fps, rows.concat())
}

fn rotation(clip: &Clip, frame: usize) -> DQuat {
    Clip::local(&clip.skeleton.joints.raw[0], clip.row(frame)).rotation
}

/// The angle between two rotations, radians, precise for small ones.
fn between(a: DQuat, b: DQuat) -> f64 {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    4.0 * ((a - b).length() / 2.0).min(1.0).asin()
}

/// All orders of three axes that can express every rotation: six of Tait-Bryan angles, six of proper Euler angles.
fn orders() -> Vec<[Axis; 3]> {
    let mut orders = Vec::new();
    for i in AXES {
        for j in AXES {
            for k in AXES {
                if i != j && j != k {
                    orders.push([i, j, k]);
                }
            }
        }
    }
    assert_eq!(orders.len(), 12);
    orders
}

#[test]
fn each_order_expresses_each_rotation() {
    let mut random = Rng::with_seed(7);
    for axes in orders() {
        for case in 0..300 {
            // A third of the cases are at or near a pole.
            let pole = if axes[0] == axes[2] { 0.0 } else { 90.0 };
            let off = [0.0, 1e-13, 1e-9, 1e-5, 1e-2][case % 5];
            let mut random_row = || {
                let mut row: Vec<f64> = (0..3).map(|_| random.f64() * 720.0 - 360.0).collect();
                if case % 3 == 0 {
                    row[1] = pole + off;
                }
                row
            };
            let rows = [random_row(), random_row(), random_row()];
            let clip = single(&axes, 30.0, &rows);
            let doubled = resample(clip.clone(), 60.0).unwrap();
            assert_eq!(doubled.frames, 5);
            for frame in 0..3 {
                let error = between(rotation(&clip, frame), rotation(&doubled, 2 * frame));
                assert!(error < 1e-11, "{axes:?} {rows:?} {error}");
            }
            for frame in 0..2 {
                let (a, b) = (rotation(&clip, frame), rotation(&clip, frame + 1));
                let middle = rotation(&doubled, 2 * frame + 1);
                let whole = between(a, b);
                // A half turn has two shortest ways.
                if whole < PI - 1e-6 {
                    assert!(
                        (between(a, middle) - whole / 2.0).abs() < 1e-7,
                        "{axes:?} {rows:?}"
                    );
                    assert!(
                        (between(middle, b) - whole / 2.0).abs() < 1e-7,
                        "{axes:?} {rows:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn angles_are_continuous() {
    for axes in orders() {
        // Through the poles of all orders, and several turns about each axis.
        for turning in 0..3 {
            let mut row = [10.0, 20.0, 30.0];
            let rows: Vec<Vec<f64>> = (0..120)
                .map(|frame| {
                    row[turning] = -180.0 + f64::from(frame) * 9.0;
                    // As in files: within half a turn.
                    row.iter()
                        .map(|angle| angle - 360.0 * (angle / 360.0).round())
                        .collect()
                })
                .collect();
            let clip = single(&axes, 30.0, &rows);
            for fps in [24.0, 60.0, 100.0] {
                let other = resample(clip.clone(), fps).unwrap();
                for frame in 1..other.frames {
                    let (a, b) = (other.row(frame - 1), other.row(frame));
                    let most = a
                        .iter()
                        .zip(b)
                        .map(|(a, b)| (a - b).abs())
                        .fold(0.0, f64::max);
                    assert!(
                        most < 9.0 * 30.0 / fps + 1e-6,
                        "{axes:?} {turning} {fps} {frame}: {a:?} {b:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn unusual_channels_are_interpolated_by_the_shorter_way() {
    let orders: [&[Axis]; 5] = [
        &[Axis::X],
        &[Axis::Z, Axis::X],
        &[Axis::Y, Axis::Y, Axis::X],
        &[Axis::X, Axis::Y, Axis::Z, Axis::X],
        &[Axis::Z, Axis::Z],
    ];
    let mut random = Rng::with_seed(3);
    for axes in orders {
        let mut row: Vec<f64> = axes.iter().map(|_| 170.0).collect();
        let rows: Vec<Vec<f64>> = (0..40)
            .map(|_| {
                row.iter_mut()
                    .for_each(|angle| *angle += random.f64() * 40.0 - 10.0);
                row.iter()
                    .map(|angle| angle - 360.0 * (angle / 360.0).round())
                    .collect()
            })
            .collect();
        let clip = single(axes, 30.0, &rows);
        let tripled = resample(clip.clone(), 90.0).unwrap();
        assert_eq!(tripled.frames, 118);
        for frame in 0..40 {
            assert!(between(rotation(&clip, frame), rotation(&tripled, 3 * frame)) < 1e-10);
        }
        for frame in 1..118 {
            for (a, b) in tripled.row(frame - 1).iter().zip(tripled.row(frame)) {
                assert!((a - b).abs() < 10.0 + 1e-9, "{axes:?} {frame}");
            }
        }
    }
}

#[test]
fn real_clips_keep_their_poses_at_common_times() {
    let files = [
        ("examples/motion/boxing.bvh", 100.0, 25, 4, 1),
        ("examples/motion/boxing.bvh", 100.0, 24, 25, 6),
        ("tests/motion/data/mixed_orders.bvh", 120.0, 24, 5, 1),
        ("tests/motion/data/mocapbank.bvh", 30.0, 24, 5, 4),
        ("tests/motion/data/mocapbank.bvh", 30.0, 60, 1, 2),
        ("tests/motion/data/rotation_first.bvh", 25.0, 100, 1, 4),
    ];
    for (name, own, fps, each, sample) in files {
        let clip = file(name);
        assert_eq!(rate(clip.frame_time), own, "{name}");
        let other = resample(clip.clone(), f64::from(fps)).unwrap();
        assert_eq!(
            other.frames,
            ((clip.frames - 1) as f64 * f64::from(fps) / own) as usize + 1
        );
        for frame in (0..clip.frames).step_by(each) {
            let now = frame / each * sample;
            if now >= other.frames {
                break;
            }
            for (before, after) in clip.pose(frame).iter().zip(other.pose(now)) {
                assert!(
                    between(before.rotation, after.rotation) < 1e-9,
                    "{name} {frame}"
                );
                assert!(
                    before.position.distance(after.position) < 1e-8,
                    "{name} {frame}"
                );
            }
        }
        assert_eq!(clip.row(0), other.row(0));
    }
}

#[test]
fn positions_lie_on_the_path() {
    let clip = file("examples/motion/boxing.bvh");
    let other = resample(clip.clone(), 24.0).unwrap();
    for frame in 0..other.frames {
        let place = frame as f64 * 100.0 / 24.0;
        let (before, t) = (place as usize, place.fract());
        let root = |row: &[f64]| DVec3::new(row[0], row[1], row[2]);
        let expected =
            root(clip.row(before)).lerp(root(clip.row((before + 1).min(clip.frames - 1))), t);
        assert!(root(other.row(frame)).distance(expected) < 1e-9, "{frame}");
    }
}

#[test]
fn a_clip_near_the_rate_stays_bit_for_bit() {
    let clip = file("examples/motion/zombie-walk.bvh");
    assert_eq!(resample(clip.clone(), 24.0).unwrap(), clip);
    for (fps, stays) in [(23.89, true), (24.11, true), (23.8, false), (24.2, false)] {
        let clip = single(&AXES, fps, &vec![vec![1.0, 2.0, 3.0]; 100]);
        assert_eq!(
            resample(clip.clone(), 24.0).unwrap() == clip,
            stays,
            "{fps}"
        );
    }
    let one = single(&AXES, 60.0, &[vec![1.0, 2.0, 3.0]]);
    assert_eq!(resample(one.clone(), 24.0).unwrap(), one);
}

#[test]
fn impossible_rates_are_rejected() {
    let clip = single(&AXES, 60.0, &vec![vec![1.0, 2.0, 3.0]; 10]);
    for fps in [0.0, -24.0, f64::NAN, f64::INFINITY, 1e9] {
        assert!(matches!(resample(clip.clone(), fps), Err(Error::Rate(_))));
    }
    let long = single(&AXES, 0.1, &vec![vec![1.0, 2.0, 3.0]; 1000]);
    assert!(matches!(resample(long, 1e5), Err(Error::Frames { .. })));
}

#[test]
fn ranges_count_as_animators_do() {
    let clip = single(
        &[Axis::X],
        24.0,
        &(1..=10)
            .map(|frame| vec![f64::from(frame)])
            .collect::<Vec<_>>(),
    );
    let cut = |text: &str| parse_range(text).and_then(|part| range(&clip, part));
    let values = |text: &str| cut(text).unwrap().values().to_vec();
    assert_eq!(values("2:4"), [2.0, 3.0, 4.0]);
    assert_eq!(values(" 9 : "), [9.0, 10.0]);
    assert_eq!(values(":2"), [1.0, 2.0]);
    assert_eq!(values("10:10"), [10.0]);
    for wrong in [
        "",
        ":",
        "5",
        "a:b",
        "1:2:3",
        "-1:4",
        "1.5:3",
        "+1:3",
        "99999999999999999999999:",
    ] {
        assert!(matches!(cut(wrong), Err(Error::NotARange(_))), "{wrong}");
    }
    assert_eq!(cut("4:2"), Err(Error::Backwards(4, 2)));
    assert_eq!(
        cut("4:11").unwrap_err().to_string(),
        "there is no frame 11: the clip has 10"
    );
    assert_eq!(
        cut("11:").unwrap_err().to_string(),
        "there is no frame 11: the clip has 10"
    );
    assert_eq!(
        cut("0:3").unwrap_err().to_string(),
        "there is no frame 0: the first is 1"
    );
    assert!(cut("x").unwrap_err().to_string().contains("such as 10:48"));
}
