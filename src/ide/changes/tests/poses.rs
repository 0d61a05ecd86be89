//! Keeping a pose.

use glam::DVec2;
use proptest::prelude::*;

use super::super::super::fixtures::analysis;
use super::super::poses::{Moment, PartTurn};
use super::*;
use crate::rig::FigureClip;

/// A crane in a transformed layer, with strings, namespaces and ids as Inkscape has them, or without.
fn crane(is_from_inkscape: bool) -> String {
    let (spaces, boom) = match is_from_inkscape {
        true => (
            " xmlns:xlink=\"http://www.w3.org/1999/xlink\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"",
            " id=\"boom\"",
        ),
        false => ("", ""),
    };
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg"{spaces} width="200" height="200" viewBox="-10 5 200 200">
<g transform="translate(30,20) rotate(10)"><rect x="40" y="100" width="40" height="14"><desc>Base</desc></rect>
<g{boom}><rect x="55" y="50" width="10" height="55"><desc>Boom@Base$Origin 60 102</desc></rect><circle cx="60" cy="70" r="3" fill="red"/></g>
<rect x="57" y="20" width="6" height="35"><desc>Arm@Boom$Origin 60 53</desc></rect></g>
</svg>"##
    )
}

fn keep(turns: &[(&str, f64)]) -> Change {
    let turns = turns.iter().map(|(part, degrees)| PartTurn {
        part: (*part).to_owned(),
        degrees: *degrees,
    });
    Change::KeepPose {
        turns: turns.collect(),
    }
}

/// The copies of the last key pose: each part with its turn in degrees, counter-clockwise, and where its joint is moved to.
fn last_pose(text: &str) -> (f64, Vec<(String, f64, DVec2)>) {
    let (analysis, _) = analysis(text);
    let bindings = analysis.bindings();
    let pose = bindings.poses.last().expect("a pose");
    let parts = pose.parts.iter().map(|posed| {
        let part = &bindings.parts[posed.part];
        let turn = -posed.moved.matrix2.x_axis.to_angle().to_degrees();
        (
            part.name.clone(),
            turn,
            posed.moved.transform_point2(part.origin),
        )
    });
    let warnings = analysis.diagnostics().iter();
    let mut warnings =
        warnings.filter(|found| found.severity() == crate::diagnostic::Severity::Warning);
    assert_eq!(warnings.next().map(|found| &found.message), None, "{text}");
    (pose.seconds, parts.collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn kept_parts_are_turned_about_their_joints(
        is_from_inkscape: bool,
        boom in prop_oneof![Just(0.0), -170.0..170.0_f64],
        arm in 1.0..170.0_f64,
        later in -170.0..-1.0_f64,
    ) {
        let source = crane(is_from_inkscape);
        let turns = if boom == 0.0 { vec![("Arm", arm)] } else { vec![("Boom", boom), ("Arm", arm)] };
        let once = made(&source, &keep(&turns)).unwrap();
        let (seconds, parts) = last_pose(&once);
        prop_assert_eq!(seconds, 0.5);
        // Only what is turned is cloned.
        prop_assert_eq!(parts.len(), turns.len());
        let (name, turn, place) = &parts[parts.len() - 1];
        prop_assert_eq!(name, "Arm");
        let off = (turn - boom - arm + 180.0).rem_euclid(360.0) - 180.0;
        prop_assert!(off.abs() < 1e-3, "{turn} for {boom} + {arm}");
        // The arm's joint goes with the boom.
        let (before, _) = analysis(&source);
        let joint = |name: &str| {
            let part = before.part_named(name).unwrap();
            before.bindings().parts[part].origin
        };
        let [own, hung_on] = ["Arm", "Boom"].map(joint);
        let turned = DVec2::from_angle(-boom.to_radians()).rotate(own - hung_on) + hung_on;
        prop_assert!(turned.distance(*place) < 1e-3, "{turned} {place}");
        // What is as before is not cloned again; what is as it is drawn again, is.
        let twice = made(&once, &keep(&[("Arm", later), ("Boom", boom)])).unwrap();
        let (seconds, parts) = last_pose(&twice);
        let names: Vec<&str> = parts.iter().map(|(name, ..)| name.as_str()).collect();
        prop_assert_eq!((seconds, names), (1.0, vec!["Arm"]));
        let third = made(&twice, &keep(&[("Boom", 12.0)])).unwrap();
        let (seconds, parts) = last_pose(&third);
        let arm = parts.iter().find(|(name, ..)| name == "Arm").unwrap();
        prop_assert!(seconds == 1.5 && (arm.1 - 12.0).abs() < 1e-3, "{arm:?}");
        // The text before it stays as it is, but for ids that are missing.
        let kept = twice.rfind("</svg>").unwrap();
        prop_assert!(!is_from_inkscape || third.starts_with(&twice[..kept]));
    }
}

#[test]
fn a_kept_pose_is_a_small_layer() {
    let after = made(&crane(true), &keep(&[("Boom", 30.0)])).unwrap();
    let source = crane(true);
    let end = source.rfind("</svg>").unwrap();
    let layer = &after[end..];
    assert_eq!(
        layer.lines().collect::<Vec<_>>()[..3],
        [
            "  <g id=\"pose-1\" inkscape:groupmode=\"layer\" inkscape:label=\"Pose 0.5\" style=\"opacity:0.3\">",
            "    <desc>Base$Pose 0.5</desc>",
            // The group of the boom and its knob is one clone, in the layer's coordinates.
            "    <use id=\"copy-1\" xlink:href=\"#boom\" transform=\"matrix(0.939693,-0.34202,0.34202,0.939693,-6.980762,45.985917)\" />",
        ]
    );
    assert!(layer.ends_with("  </g>\n</svg>"));
}

#[test]
fn nothing_new_is_not_kept() {
    let source = crane(true);
    let once = made(&source, &keep(&[("Arm", 20.0)])).unwrap();
    for (text, turns) in [
        (&source, vec![]),
        (&source, vec![("Arm", 0.0)]),
        (&once, vec![("Arm", 20.0)]),
    ] {
        let refusal = made(text, &keep(&turns)).unwrap_err();
        assert!(refusal.why.starts_with("no part is posed"), "{refusal}");
    }
    let refusal = made(&source, &keep(&[("Leg", 20.0)])).unwrap_err();
    assert_eq!(refusal.why, "there is no part `Leg`");
}

fn movement(moments: &[(f64, &[(&str, f64)])]) -> Change {
    let moments = moments.iter().map(|(seconds, turns)| {
        let turns = turns.iter().map(|(part, degrees)| PartTurn {
            part: (*part).to_owned(),
            degrees: *degrees,
        });
        Moment {
            seconds: *seconds,
            turns: turns.collect(),
        }
    });
    Change::KeepMovement {
        moments: moments.collect(),
    }
}

/// Keeps the pose of the arm `before`, degrees, and then a movement of steps: how many frames later, and by how much boom and arm turn. Each
/// frame of the clip must have what was recorded.
fn is_played_as_recorded(
    is_from_inkscape: bool,
    before: Option<f64>,
    steps: &[(usize, f64, f64)],
) -> Result<(), TestCaseError> {
    let mut source = crane(is_from_inkscape);
    if let Some(degrees) = before {
        source = made(&source, &keep(&[("Arm", degrees)])).unwrap();
    }
    let (mut frame, mut boom, mut arm) = (0, 0.0, before.unwrap_or_default());
    let mut recorded = vec![(0, boom, arm)];
    for (step, boom_turn, arm_turn) in steps {
        frame += step;
        boom += boom_turn;
        arm += arm_turn;
        recorded.push((frame, boom, arm));
    }
    let turns: Vec<[(&str, f64); 2]> = recorded
        .iter()
        .map(|(_, boom, arm)| [("Boom", *boom), ("Arm", *arm)])
        .collect();
    let moments: Vec<(f64, &[(&str, f64)])> = recorded
        .iter()
        .zip(&turns)
        .map(|((frame, ..), turns)| (*frame as f64 / 24.0, turns.as_slice()))
        .collect();
    let after = made(&source, &movement(&moments)).unwrap();
    let (analysis, _) = analysis(&after);
    let warnings = analysis.diagnostics().iter().map(|found| &found.message);
    let warnings: Vec<_> = warnings.collect();
    let [clip] = analysis.compiled().clips.as_slice() else {
        panic!("{after}");
    };
    // The movement begins where the clip ended.
    let begin = before.map_or(0, |_| 12);
    prop_assert_eq!(
        clip.source_frames(),
        begin + frame + 1,
        "{:?} {}",
        warnings,
        after
    );
    let poses = &analysis.bindings().poses;
    prop_assert!(poses.len() <= recorded.len() + usize::from(before.is_some()));
    for (frame, boom, arm) in recorded {
        for (part, wanted) in [("Boom", boom), ("Arm", arm)] {
            let found = clip.turn_in(analysis.bindings(), part, begin + frame);
            let off = (found - wanted + 180.0).rem_euclid(360.0) - 180.0;
            prop_assert!(off.abs() < 2.6, "{part} in {frame}: {found} for {wanted}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Also after earlier key poses.
    #[test]
    fn a_movement_is_played_as_it_was_recorded(
        is_from_inkscape: bool,
        before in prop::option::of(1.0..90.0_f64),
        steps in prop::collection::vec((1_usize..5, -12.0..12.0_f64, -12.0..12.0_f64), 2..40),
    ) {
        is_played_as_recorded(is_from_inkscape, before, &steps)?;
    }
}

/// The curve comes out of the pose before with its swing, and would go too far unless one more moment is a key pose.
#[test]
fn a_movement_after_a_swift_pose_is_played_as_it_was_recorded() {
    let steps = [(4, 8.6, 7.0), (3, 9.3, 7.2), (1, -9.0, 0.0)];
    is_played_as_recorded(false, Some(81.0), &steps).unwrap();
}

#[test]
fn a_movement_waits_where_it_was_still() {
    let moments: &[(f64, &[(&str, f64)])] = &[
        (0.0, &[("Boom", 30.0)]),
        (1.0, &[]),
        (2.0, &[("Boom", -10.0)]),
        (3.0, &[]),
    ];
    let after = made(&crane(true), &movement(moments)).unwrap();
    let (analysis, _) = analysis(&after);
    let poses = analysis.bindings().poses.iter();
    let poses: Vec<(f64, usize)> = poses.map(|pose| (pose.seconds, pose.parts.len())).collect();
    assert_eq!(poses, [(0.0, 1), (1.0, 1), (2.0, 1), (3.0, 1)]);
    assert_eq!(analysis.compiled().clips[0].source_frames(), 73);
    // After a clip that ends otherwise it goes to where the movement begins first.
    let twice = made(&after, &movement(moments)).unwrap();
    let (seconds, _) = last_pose(&twice);
    assert_eq!(seconds, 3.0 + 1.0 + 3.0);
}

#[test]
fn a_figure_waits_while_another_moves() {
    let source = crane(true).replace(
        "</g>\n</svg>",
        r#"<rect x="140" y="140" width="30" height="30"><desc>Foot</desc></rect><rect x="150" y="90" width="8" height="55"><desc>Lamp@Foot$Origin 154 142</desc></rect></g>
</svg>"#,
    );
    let moments: &[(f64, &[(&str, f64)])] = &[
        (0.0, &[]),
        (0.5, &[("Boom", 30.0)]),
        (1.0, &[("Boom", -30.0), ("Lamp", 0.0)]),
        (1.5, &[("Lamp", 40.0)]),
    ];
    let after = made(&source, &movement(moments)).unwrap();
    let (analysis, _) = analysis(&after);
    for (part, wanted) in [
        ("Boom", [0.0, 30.0, -30.0, -30.0]),
        ("Lamp", [0.0, 0.0, 0.0, 40.0]),
    ] {
        let root = if part == "Boom" { "Base" } else { "Foot" };
        let clips = &analysis.compiled().clips;
        let of = |clip: &&FigureClip| analysis.bindings().parts[clip.root].name == root;
        let clip = clips.iter().find(of).expect(root);
        let turns = [0, 12, 24, 36].map(|frame| clip.turn_in(analysis.bindings(), part, frame));
        let off = turns
            .iter()
            .zip(wanted)
            .map(|(turn, wanted)| (turn - wanted).abs());
        assert!(off.fold(0.0, f64::max) < 0.01, "{part}: {turns:?}");
    }
}

#[test]
fn movements_that_are_none_are_refused() {
    let source = crane(true);
    let nothing: &[(f64, &[(&str, f64)])] = &[(0.0, &[("Arm", 0.0)]), (1.0, &[])];
    let backwards: &[(f64, &[(&str, f64)])] = &[(1.0, &[("Arm", 9.0)]), (0.5, &[])];
    for (moments, why) in [
        (&[][..], "no part of the movement is posed"),
        (nothing, "no part of the movement is posed"),
        (backwards, "the moments of the movement are not in order"),
        (&[(-1.0, &[][..])], "a movement lasts from 0 to 120 seconds"),
        (&[(f64::NAN, &[])], "a movement lasts from 0 to 120 seconds"),
        (&[(0.0, &[("Leg", 20.0)])], "there is no part `Leg`"),
        (&[(0.0, &[("Arm", f64::INFINITY)])], "`Arm` is turned by no"),
    ] {
        let refusal = made(&source, &movement(moments)).unwrap_err();
        assert!(refusal.why.starts_with(why), "{refusal}");
    }
}
