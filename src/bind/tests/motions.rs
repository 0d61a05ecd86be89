//! What strings ask for of motions.

use super::super::attributes::PerformanceEffects;
use super::super::{Camerawork, MotionSource, SetBy};
use super::{drawing, part, square, text};

#[test]
fn clips_are_requested_for_a_part_or_for_all() {
    let elements = [
        square(20, 20, "A$"),
        square(60, 20, "B@A$Motion \"b.bvh\" wave"),
        text(150, 150, "%Motion \"all.bvh\""),
    ];
    let compiled = drawing(&elements.concat());
    let requests = compiled.bindings.clip_requests();
    let mut requests: Vec<_> = requests
        .iter()
        .map(|request| {
            let MotionSource::File(file) = &request.turns[0].motion.source else {
                panic!("{request:?}");
            };
            (file.as_str(), request.name, request.part)
        })
        .collect();
    requests.sort_unstable();
    let b = Some(part(&compiled, "B"));
    assert_eq!(
        requests,
        [("all.bvh", None, None), ("b.bvh", Some("wave"), b)]
    );
}

#[test]
fn a_request_says_how_its_clip_is_played() {
    let elements = [
        square(20, 20, "A$Limited 9 9 Motion -il walk Limited 1 2"),
        text(
            150,
            150,
            "%Motion \"all.bvh\" all -z Limited 3 4 Motion -L \"b.bvh\" +x",
        ),
    ];
    let compiled = drawing(&elements.concat());
    let requests = compiled.bindings.clip_requests();
    let found: Vec<_> = requests
        .iter()
        .map(|request| {
            let limits = request.limits.map(|limits| [limits.omit, limits.hold]);
            let up = request.turns[0].motion.up.map(|up| (up.axis, up.negative));
            (up, request.is_in_place, request.is_loop, limits)
        })
        .collect();
    assert_eq!(
        found,
        [
            (None, true, true, Some([1, 2])),
            (Some((2, true)), false, false, Some([3, 4])),
            (Some((0, false)), false, true, None),
        ]
    );
    assert_eq!(
        requests[0].turns[0].motion.source,
        MotionSource::BuiltIn("walk".to_owned())
    );
    let (from, limits) = compiled.bindings.limits_of_clips(0.into()).unwrap();
    assert_eq!((from, limits.omit), (SetBy::Own, 9));
}

#[test]
fn a_performance_belongs_to_the_motion_before_it() {
    let elements = [
        square(
            20,
            20,
            "A$Perform \"a.json\" Motion walk Perform -te \"w.csv\" \"left hand\" 14 31 Motion run",
        ),
        text(150, 150, "%Perform -R \"all.json\" 3 (2 + 2)"),
    ];
    let compiled = drawing(&elements.concat());
    let bindings = &compiled.bindings;
    let requests = bindings.clip_requests();
    let own = requests[0].performance.as_ref().unwrap();
    assert_eq!(own.file, "w.csv");
    assert_eq!(own.emphasized, Some("left hand"));
    assert_eq!(own.keys, Some([14, 31]));
    let effects = PerformanceEffects {
        timing: false,
        emphasis: false,
        camerawork: Camerawork::Camera,
    };
    assert_eq!(own.effects, effects);
    assert!(requests[1].performance.is_none());
    let (from, all) = bindings.performance_of_clips(0.into()).unwrap();
    assert_eq!((from, all.file, all.keys), (SetBy::Own, "a.json", None));

    let elements = [
        square(20, 20, "A$Motion walk"),
        text(150, 150, "%Perform -R \"all.json\" 3 (2 + 2)"),
    ];
    let compiled = drawing(&elements.concat());
    let (from, all) = compiled.bindings.performance_of_clips(0.into()).unwrap();
    assert_eq!(
        (from, all.file, all.keys),
        (SetBy::Default, "all.json", Some([3, 4]))
    );
    let effects = PerformanceEffects {
        timing: true,
        emphasis: true,
        camerawork: Camerawork::Root,
    };
    assert_eq!(all.effects, effects);
}

#[test]
fn marks_and_what_follows_them_have_places() {
    let elements = [
        square(20, 20, "A$Mark Red Follow B \"left foot\""),
        square(60, 20, "B@A$Mark #00F"),
        square(100, 20, "C@A"),
    ];
    let compiled = drawing(&elements.concat());
    let bindings = &compiled.bindings;
    let mark = |name: &str| {
        let mark = bindings.mark(part(&compiled, name))?;
        Some((mark.word, mark.color))
    };
    assert_eq!(mark("A"), Some(("red", [255, 0, 0])));
    assert_eq!(mark("B"), Some(("#00f", [0, 0, 255])));
    assert_eq!(mark("C"), None);
    let follows = bindings.follows(part(&compiled, "A"));
    let follows: Vec<(&str, usize)> = follows
        .iter()
        .map(|followed| (followed.name, followed.span.end - followed.span.start))
        .collect();
    assert_eq!(follows, [("B", 1), ("left foot", "\"left foot\"".len())]);
}
