//! What is written can be read back.

use std::io::Write;
use std::sync::Arc;

use glam::DVec3;
use proptest::prelude::*;
use typed_index_collections::{TiVec, ti_vec};

use super::tests::{SMALL, small, written};
use super::*;
use crate::mocap::{Axis, Channel, Clip, Joint, JointId, Skeleton};

#[test]
fn joints_in_any_order_are_written_depth_first() {
    let clip = small();
    let joint = |name: &str, parent| Joint {
        name: name.to_owned(),
        parent,
        channels: vec![Channel::Rotation(Axis::X)],
        ..Joint::default()
    };
    let joints = ti_vec![
        joint("a", None),
        joint("b", Some(0.into())),
        joint("c", Some(0.into())),
        joint("d", Some(1.into())),
    ];
    let odd = Clip::new(
        Arc::new(Skeleton { joints }),
        clip.frame_time,
        vec![1.0, 2.0, 3.0, 4.0],
    );
    let read = read_bytes(&written(&odd, Decimals::All)).unwrap().clip;
    let names: Vec<_> = read
        .skeleton
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    assert_eq!(names, ["a", "b", "d", "c"]);
    assert_eq!(read.values(), [1.0, 2.0, 4.0, 3.0]);
}

#[test]
fn names_that_a_file_cannot_hold_are_changed() {
    let clip = small();
    for (name, read) in [
        ("", "Joint1"),
        (" a b ", "a b"),
        ("a{b}\n", "a_b__"),
        ("\u{FEFF}x", "\u{FEFF}x"),
        ("OFFSET", "OFFSET"),
    ] {
        let mut skeleton = Skeleton::clone(&clip.skeleton);
        skeleton.joints.raw[0].name = name.to_owned();
        let clip = Clip::new(Arc::new(skeleton), clip.frame_time, clip.values().to_vec());
        let again = read_bytes(&written(&clip, Decimals::All)).unwrap().clip;
        assert_eq!(again.skeleton.joints.raw[0].name, read);
        assert_eq!(again.values(), clip.values());
    }
    let mut skeleton = Skeleton::clone(&clip.skeleton);
    skeleton.joints.raw[0].name = "ü".repeat(MAX_NAME_BYTES);
    let long = Clip::new(Arc::new(skeleton), clip.frame_time, Vec::new());
    assert_eq!(
        read_bytes(&written(&long, Decimals::All))
            .unwrap()
            .clip
            .skeleton
            .joints
            .raw[0]
            .name
            .len(),
        MAX_NAME_BYTES
    );
}

#[test]
fn numbers_that_are_not_finite_are_not_written() {
    for number in [f64::NAN, f64::INFINITY] {
        let clip = Clip::new(Arc::clone(&small().skeleton), 0.1, vec![number; 9]);
        let error = write(&clip, Decimals::All, &mut Vec::new()).unwrap_err();
        assert_eq!(error.kind(), std::io::ErrorKind::InvalidData);
    }
}

#[test]
fn six_decimals_are_rounded_and_short() {
    let values = vec![
        1.0,
        -2.5,
        1.0 / 3.0,
        -2e-7,
        123_456.789_012_4,
        1e11 + 0.1,
        0.0,
        -0.000_001,
        9.999_999_6,
    ];
    let clip = Clip::new(Arc::clone(&small().skeleton), 0.1, values);
    let text = String::from_utf8(written(&clip, Decimals::Six)).unwrap();
    assert!(
        text.ends_with("\n1 -2.5 0.333333 0 123456.789012 100000000000.1 0 -0.000001 10\n"),
        "{text}"
    );
}

prop_compose! {
    fn joint_of(index: usize)(
        name in "[A-Za-z:_ü腕]{1,6}( [a-z]{1,3})?",
        above in 0..=index,
        offset in prop::array::uniform3(-1e3..1e3f64),
        channels in prop::collection::vec(0..6usize, 0..7),
        ends in prop::collection::vec(prop::array::uniform3(-10.0..10.0f64), 0..3),
    ) -> (usize, Joint) {
        let channels = channels.iter().map(|channel| super::fields::CHANNELS[*channel].1).collect();
        let ends = ends.iter().map(|end| DVec3::from_array(*end)).collect();
        (above, Joint { name, parent: None, offset: DVec3::from_array(offset), channels, ends })
    }
}

fn clips() -> impl Strategy<Value = Clip> {
    let number = prop_oneof![
        -180.0..180.0f64,
        (-1_000_000_000..1_000_000_000i64).prop_map(|millionths| millionths as f64 / 1e6),
        prop_oneof![
            Just(0.0),
            Just(-0.0),
            Just(1e12),
            Just(-1e12),
            Just(5e-324),
            Just(1e-5),
            Just(9.999_999e-6)
        ],
        any::<f64>().prop_filter("as reading takes", |number| number.abs() <= MAX_MAGNITUDE),
    ];
    let joints = (1..12usize).prop_flat_map(|count| (0..count).map(joint_of).collect::<Vec<_>>());
    let frame_time = prop_oneof![1e-5..10.0f64, Just(1.0 / 24.0), Just(0.008333)];
    (joints, frame_time, prop::collection::vec(number, 0..400)).prop_map(
        |(parts, frame_time, values)| {
            // The path from a root to the last joint: the next joint is a child of one of these, or a root.
            let mut path: Vec<JointId> = Vec::new();
            let mut joints = TiVec::new();
            for (above, mut joint) in parts {
                path.truncate(above % (path.len() + 1));
                joint.parent = path.last().copied();
                path.push(joints.push_and_get_key(joint));
            }
            Clip::new(Arc::new(Skeleton { joints }), frame_time, values)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn what_is_written_is_read_back(clip in clips()) {
        let text = written(&clip, Decimals::All);
        let again = read_bytes(&text).unwrap().clip;
        prop_assert_eq!(&again, &clip);
        let bits = |clip: &Clip| clip.values().iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&again), bits(&clip));
        // The standard library's shortest form, whichever code path wrote it.
        let number = |value: &f64| match value.abs() {
            0.0 | 1e-5..1e16 => format!("{value}"),
            _ => format!("{value:e}"),
        };
        let row = |frame: usize| clip.row(frame).iter().map(number).collect::<Vec<_>>().join(" ");
        let rows: String = (0..clip.frames).map(|frame| row(frame) + "\n").collect();
        prop_assert!(text.ends_with(rows.as_bytes()));
        let six = read_bytes(&written(&clip, Decimals::Six)).unwrap().clip;
        for (a, b) in six.values().iter().zip(clip.values()) {
            prop_assert!((a - b).abs() <= 5e-7 + b.abs() * 1e-15);
        }
    }
}

#[test]
fn writing_stops_where_the_output_does() {
    struct Full(usize);
    impl Write for Full {
        fn write(&mut self, text: &[u8]) -> std::io::Result<usize> {
            self.0 = self
                .0
                .checked_sub(text.len())
                .ok_or(std::io::ErrorKind::StorageFull)?;
            Ok(text.len())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let clip = read_bytes(SMALL.as_bytes()).unwrap().clip;
    for room in [0, 50, 200] {
        assert!(write(&clip, Decimals::All, &mut Full(room)).is_err());
    }
    assert!(write(&clip, Decimals::All, &mut Full(4000)).is_ok());
}
