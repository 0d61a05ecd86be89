//! Laws of key poses: at its second each part is where its copy is drawn.

use glam::{DAffine2, DVec2};
use proptest::prelude::*;
use typed_index_collections::TiVec;

use super::super::FigureClip;
use super::monotone;
use crate::compile::{Compiled, Options, compile};
use crate::diagnostic::Code;
use crate::geometry::y_up;
use crate::labels::FigurePartId;
use crate::resolver::MemoryResolver;

/// A crane: each part hangs on the one before it.
const PARTS: [(&str, &str, f64, f64); 4] = [
    ("base", "M170,260 h60 v30 h-60 z", 0.0, 0.0),
    ("boom", "M192,170 h16 v95 l-8,5 l-8,-5 z", 200.0, 265.0),
    ("arm", "M193,90 h14 l2,85 h-18 z", 200.0, 172.0),
    ("hook", "M195,50 h10 l9,45 h-22 z", 200.0, 92.0),
];

fn compiled(layers: &str) -> Compiled {
    let shapes = PARTS.iter().map(|(name, path, x, y)| {
        let string = match *name {
            "base" => "base".to_owned(),
            "boom" => format!("boom@base$Origin {x} {y}"),
            "arm" => format!("arm@boom$Origin {x} {y}"),
            _ => format!("hook@arm$Origin {x} {y}"),
        };
        format!(r##"<path id="{name}" d="{path}"><desc>{string}</desc></path>"##)
    });
    let shapes: String = shapes.collect();
    let text = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="400" height="300"><g transform="translate(0,0)">{shapes}</g>{layers}</svg>"##
    );
    compile(&text, &Options::default(), &MemoryResolver::default())
}

fn layer(string: &str, copies: &str, attributes: &str) -> String {
    format!(
        r##"<g inkscape:groupmode="layer" {attributes}><text x="9" y="9">{string}</text>{copies}</g>"##
    )
}

fn matrix(moved: DAffine2) -> String {
    let [a, b, c, d, e, f] = moved.to_cols_array();
    format!("matrix({a},{b},{c},{d},{e},{f})")
}

fn only(compiled: &Compiled) -> &FigureClip {
    let [clip] = compiled.clips.as_slice() else {
        panic!("{} clips: {:?}", compiled.clips.len(), compiled.diagnostics);
    };
    clip
}

/// Where a point of the page is in a frame, as a point of a part.
fn at(clip: &FigureClip, compiled: &Compiled, name: &str, frame: usize, point: DVec2) -> DVec2 {
    let rig = &clip.rig;
    let nodes = rig.parts.iter().map(|part| part.node);
    let mut placed: TiVec<FigurePartId, _> = nodes.collect();
    let mut found = None;
    for index in rig.order() {
        let node = clip.retargeted.node(rig, index, frame, &placed);
        let (part, bone) = clip.order[index];
        if compiled.bindings.parts[part].name == name && bone == 0 {
            let local = rig.parts[index].node.to_local(y_up(point).extend(0.0));
            found = Some(y_up(node.apply(local).truncate()));
        }
        placed[index] = node;
    }
    found.expect("a part")
}

/// The poses of the crane's parts, each about its joint, which goes with what it hangs on; the base is moved, too.
fn chain(angles: [f64; 4], shift: DVec2) -> [DAffine2; 4] {
    let mut above = DAffine2::from_translation(shift);
    let mut index = 0;
    angles.map(|angle| {
        let (_, _, x, y) = PARTS[index];
        let joint = DVec2::new(x, y);
        index += 1;
        above *= DAffine2::from_translation(joint)
            * DAffine2::from_angle(angle)
            * DAffine2::from_translation(-joint);
        above
    })
}

/// How a copy is made.
#[derive(Debug, Clone, Copy)]
enum Way {
    Clone,
    /// A clone at another place of the page, in a group that takes it back.
    CloneInGroup,
    CloneOfClone,
    /// A path with the same label as the part.
    Path,
    /// A path whose id is that of the part with a number.
    PathById,
    /// A path with its name as a description.
    PathByString,
}

fn copy(way: Way, index: usize, number: usize, moved: DAffine2) -> String {
    let (name, path, ..) = PARTS[index];
    let transform = matrix(moved);
    let away = DAffine2::from_angle(0.7) * DAffine2::from_translation(DVec2::new(31.0, -12.0));
    match way {
        Way::Clone => format!(r##"<use href="#{name}" transform="{transform}"/>"##),
        Way::CloneInGroup => format!(
            r##"<g transform="{}"><g><use href="#{name}" x="5" y="7" transform="{}"/></g></g>"##,
            matrix(away.inverse()),
            matrix(away * moved * DAffine2::from_translation(DVec2::new(-5.0, -7.0))),
        ),
        Way::CloneOfClone => format!(
            r##"<use id="c{number}" href="#d{number}" transform="{transform}"/><defs><use id="d{number}" href="#{name}"/></defs>"##
        ),
        Way::Path => {
            format!(r##"<path inkscape:label="{name}" d="{path}" transform="{transform}"/>"##)
        }
        Way::PathById => {
            format!(r##"<path id="{name}-{number}-5" d="{path}" transform="{transform}"/>"##)
        }
        Way::PathByString => {
            format!(r##"<path d="{path}" transform="{transform}"><desc>{name}</desc></path>"##)
        }
    }
}

const WAYS: [Way; 6] = [
    Way::Clone,
    Way::CloneInGroup,
    Way::CloneOfClone,
    Way::Path,
    Way::PathById,
    Way::PathByString,
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Turns and shifts are the same or differ visibly: what turns or moves by less than a pose's tolerance counts as still.
    #[test]
    fn parts_are_where_their_copies_are_drawn(
        poses in prop::collection::vec((prop::array::uniform4(-30..30_i32), -40..40_i32, 2_usize..30), 1..4),
        ways in prop::collection::vec(prop::sample::select(WAYS.to_vec()), 16),
        begins_at_0: bool,
        is_hidden: bool,
        is_moved: bool,
    ) {
        let mut layers = String::new();
        let mut frame = 0;
        let mut keys = Vec::new();
        for (number, (angles, shift, step)) in poses.into_iter().enumerate() {
            if number > 0 || !begins_at_0 {
                frame += step;
            }
            let shift = f64::from(shift);
            let placed = chain(angles.map(|angle| f64::from(angle) / 20.0), DVec2::new(shift, -shift / 2.0));
            let away = DAffine2::from_translation(DVec2::new(60.0, 11.0));
            let around = if is_moved { away } else { DAffine2::IDENTITY };
            let copies: String = (0..4)
                .map(|index| copy(ways[4 * number + index], index, 10 * number + index, around.inverse() * placed[index]))
                .collect();
            let hidden = if is_hidden { "style='display:none;opacity:.3'" } else { "" };
            let attributes = format!("{hidden} transform='{}'", matrix(around));
            let seconds = frame as f64 / 24.0;
            layers += &layer(&format!("base$Pose {seconds:.6}"), &copies, &attributes);
            keys.push((frame, placed));
        }
        let compiled = compiled(&layers);
        let warnings: Vec<_> = compiled.diagnostics.iter().map(|found| &found.message).collect();
        // What is drawn as a copy is built nowhere.
        prop_assert_eq!(compiled.bindings.parts.len(), 4, "{:?}", warnings);
        let odd = compiled.diagnostics.iter().filter(|found| found.code.id() >= "W339" && found.code.id() < "W399");
        prop_assert_eq!(odd.count(), 0, "{:?}", warnings);
        let clip = only(&compiled);
        prop_assert_eq!(&clip.name, "poses");
        prop_assert_eq!(clip.source_frames(), keys[keys.len() - 1].0 + 1);
        for (frame, placed) in keys {
            for (index, (name, _, x, y)) in PARTS.iter().enumerate() {
                for point in [DVec2::new(*x, *y), DVec2::new(205.0, 60.0)] {
                    let wanted = placed[index].transform_point2(point);
                    let found = at(clip, &compiled, name, frame, point);
                    prop_assert!(wanted.distance(found) < 1e-3, "{name} {frame}: {found} for {wanted}");
                }
            }
        }
    }
}

fn turned(index: usize, degrees: f64) -> String {
    let (name, _, x, y) = PARTS[index];
    format!(r##"<use href="#{name}" transform="rotate({degrees} {x} {y})"/>"##)
}

proptest! {
    #[test]
    fn curves_pass_their_keys_and_never_overshoot(
        keys in prop::collection::vec((1_usize..30, -3.0..3.0_f64), 1..7),
        is_loop: bool,
    ) {
        let mut frames = vec![0];
        let mut values = vec![0.5];
        for (step, value) in keys {
            frames.push(frames[frames.len() - 1] + step);
            values.push(value);
        }
        if is_loop {
            values[frames.len() - 1] = 0.5;
        }
        let curve = monotone(&frames, &values, is_loop);
        prop_assert_eq!(curve.len(), frames[frames.len() - 1] + 1);
        for (key, frame) in frames.iter().enumerate() {
            prop_assert!((curve[*frame] - values[key]).abs() < 1e-12);
        }
        for key in 1..frames.len() {
            let (low, high) = (values[key - 1].min(values[key]), values[key - 1].max(values[key]));
            for value in &curve[frames[key - 1]..=frames[key]] {
                prop_assert!((low - 1e-9..=high + 1e-9).contains(value));
            }
        }
    }
}

#[test]
fn a_part_that_is_left_out_keeps_its_pose() {
    let layers = [
        layer("$Pose .5", &turned(1, 30.0), ""),
        // The arm goes with the boom, which stays as it was.
        layer(
            "$Pose 1",
            &(turned(1, 30.0)
                + r##"<use href="#arm" transform="rotate(30 200 265) rotate(-20 200 172)"/>"##),
            "",
        ),
        layer("$Pose 1.5", &turned(1, 0.0), ""),
    ];
    let compiled = compiled(&layers.concat());
    let clip = only(&compiled);
    let tip = DVec2::new(200.0, 50.0);
    let joint = DVec2::new(200.0, 172.0);
    let about = |joint: DVec2, degrees: f64, at: DVec2| {
        DVec2::from_angle(degrees.to_radians()).rotate(at - joint) + joint
    };
    // At the end the boom is upright, and the arm still turned.
    let wanted = about(joint, -20.0, tip);
    let found = at(clip, &compiled, "hook", 36, tip);
    assert!(wanted.distance(found) < 1e-3, "{found} for {wanted}");
    // The drawing itself is the first pose.
    assert!(at(clip, &compiled, "hook", 0, tip).distance(tip) < 1e-9);
}

#[test]
fn poses_turn_the_short_way() {
    let layers = [170.0, -170.0].map(|angle| turned(1, angle));
    let layers = layer("$Pose 0", &layers[0], "") + &layer("$Pose 1", &layers[1], "");
    let compiled = compiled(&layers);
    let clip = only(&compiled);
    // Half-way it points down, not up.
    let found = at(clip, &compiled, "boom", 12, DVec2::new(200.0, 165.0));
    assert!(found.distance(DVec2::new(200.0, 365.0)) < 1e-3, "{found}");
}

#[test]
fn loops_end_as_they_begin() {
    let frames = |flag: &str, last: f64| {
        let layers = layer(&format!("$Pose {flag} .5"), &turned(1, 30.0), "")
            + &layer("$Pose 1", &turned(1, last), "");
        let compiled = compiled(&layers);
        let clip = only(&compiled);
        let tip = DVec2::new(200.0, 165.0);
        let end = clip.source_frames() - 1;
        (
            end,
            at(clip, &compiled, "boom", end, tip).distance(tip) < 1e-3,
        )
    };
    assert_eq!(frames("", 60.0), (24, false));
    // Back in as many seconds as between the last two poses; unless the last pose is the first.
    assert_eq!(frames("-l", 60.0), (36, true));
    assert_eq!(frames("-l", 0.0), (24, true));
}

#[test]
fn clips_have_the_names_of_their_strings() {
    let layers = layer("base$Pose .5 nod", &turned(3, 30.0), "")
        + &layer("base$Pose 1", &turned(1, 30.0), "")
        + &layer("base$Pose 1 nod", &turned(3, -30.0), "");
    let compiled = compiled(&layers);
    let clips = compiled.clips.iter();
    let clips: Vec<(&str, usize)> = clips
        .map(|clip| (clip.name.as_str(), clip.source_frames()))
        .collect();
    assert_eq!(clips, [("nod", 25), ("poses", 25)]);
}

#[test]
fn limited_poses_are_drawn_seldom() {
    let layers = layer("$Pose 1 Limited 6 4", &turned(1, 60.0), "");
    let compiled = compiled(&layers);
    let clip = only(&compiled);
    assert!(
        clip.drawings() < 25 && clip.limited_at.is_some(),
        "{}",
        clip.drawings()
    );
}

fn codes(layers: &str) -> Vec<Code> {
    let compiled = compiled(layers);
    let warnings = compiled.diagnostics.iter();
    let warnings =
        warnings.filter(|found| found.severity() == crate::diagnostic::Severity::Warning);
    warnings.map(|found| found.code).collect()
}

#[test]
fn misuse_is_reported() {
    let scaled =
        r##"<use href="#arm" transform="translate(200 172) scale(1.1) translate(-200 -172)"/>"##;
    let slightly =
        r##"<use href="#arm" transform="translate(200 172) scale(1.01) translate(-200 -172)"/>"##;
    let mirrored = r##"<use href="#hook" transform="matrix(-1 0 0 1 390 0)"/>"##;
    let other = r##"<path inkscape:label="arm" d="M193,90 h60 v60 h-90 l20,-80 z"/>"##;
    let off = r##"<use href="#arm" transform="translate(30 0)"/>"##;
    let unknown = r##"<circle cx="40" cy="40" r="9" inkscape:label="ball"/>"##;
    for (copies, code) in [
        ("", Code::IdlePose),
        (scaled, Code::CopyDiffers),
        (mirrored, Code::CopyDiffers),
        (other, Code::CopyDiffers),
        (off, Code::OffJoint),
        (unknown, Code::CopyOfNoPart),
    ] {
        assert_eq!(codes(&layer("$Pose 1", copies, "")), [code], "{copies}");
    }
    assert_eq!(codes(&layer("$Pose 1", slightly, "")), []);
    assert_eq!(
        codes(&layer("crane$Pose 1", &turned(1, 5.0), "")),
        [Code::IdlePose]
    );
    assert_eq!(
        codes(r##"<text x="9" y="9">base$Pose 1</text>"##),
        [Code::IdlePose]
    );
    let back = layer("$Pose 1", &turned(1, 5.0), "") + &layer("$Pose 1", &turned(1, 9.0), "");
    assert_eq!(codes(&back), [Code::PoseOrder]);
}
