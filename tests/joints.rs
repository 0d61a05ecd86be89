//! Which joint drives which part, in `inspect` and in the language server.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::path::Path;

use common::editor::{Editor, address, position, slice};
use common::program::Room;
use serde_json::{Value, json};

/// The parts of the kicker with their joints.
const JOINTS: [(&str, &str); 13] = [
    ("Body", "Chest"),
    ("Head", "Head"),
    ("Hips", "Hips"),
    ("Larm", "LeftArm"),
    ("Lfoot", "LeftFoot"),
    ("Lforearm", "LeftForeArm"),
    ("Lleg", "LeftUpLeg"),
    ("Lshin", "LeftLeg"),
    ("Rarm", "RightArm"),
    ("Rfoot", "RightFoot"),
    ("Rforearm", "RightForeArm"),
    ("Rleg", "RightUpLeg"),
    ("Rshin", "RightLeg"),
];

fn example(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(root.join("examples/motion").join(name)).expect("an example")
}

/// The kicker, beside its motion, in a folder of its own.
fn kicker() -> Room {
    let room = Room::with("kick.svg", example("kick.svg"));
    room.write("kick.bvh", example("kick.bvh"));
    room
}

#[test]
fn inspect_names_the_joint_of_every_part() {
    let run = kicker().run(&["inspect", "--json", "kick.svg"]);
    assert_eq!(run.status, 0, "{}", run.err);
    let report: Value = serde_json::from_str(&run.out).expect("JSON");
    let clips = report["clips"].as_array().expect("clips");
    assert_eq!(clips.len(), 1);
    let clip = &clips[0];
    let named = ["name", "figure", "file"].map(|key| clip[key].as_str().expect("text"));
    assert_eq!(named, ["kick", "Hips", "kick.bvh"]);
    // 68 frames at 24 a second, 4 of them omitted and 30 held: `Limited 4 30`.
    let seconds = clip["seconds"].as_f64().expect("a number");
    assert!((seconds - 68.0 / 24.0).abs() < 1e-3, "{seconds}");
    assert_eq!(clip["frames"], 68);
    assert_eq!(clip["drawings"], 34);
    assert_eq!(clip["omitted"].as_array().expect("frames").len(), 4);
    assert_eq!(clip["held"].as_array().expect("frames").len(), 30);
    let joints = clip["joints"].as_object().expect("joints");
    let found: Vec<(&str, &str)> = joints
        .iter()
        .map(|(part, joint)| (part.as_str(), joint.as_str().expect("a name")))
        .collect();
    assert_eq!(found, JOINTS);
    for part in report["parts"].as_array().expect("parts") {
        let own = JOINTS.iter().find(|(name, _)| part["name"] == *name);
        let expected = own.map_or(Value::Null, |(_, joint)| json!(joint));
        assert_eq!(part["joint"], expected, "{part}");
        assert_eq!(part["joint_why"].is_string(), own.is_some(), "{part}");
    }
}

#[test]
fn inspect_explains_why_a_joint_drives_a_part() {
    let room = kicker();
    let run = room.run(&["inspect", "kick.svg"]);
    assert_eq!(run.status, 0, "{}", run.err);
    for line in [
        "clip kick of Hips, from kick.bvh: 2.83 s, 68 frames, 34 drawings\n",
        "   omitted 4 frames: 32-35\n",
        "   Rarm      RightArm      `Rarm` is an arm by its name, and its side is right; it points from `RightArm` to `RightForeArm`\n",
        "   Body      Chest         `Body` is a body by its name; it turns with `Chest` and leans with the line from the hips to the shoulders\n",
    ] {
        assert!(run.out.contains(line), "{line:?} is not in:\n{}", run.out);
    }
    // A part without a joint.
    let button = "<rect id=\"button\" x=\"150\" y=\"150\" width=\"6\" height=\"6\"><desc>Button@Body</desc></rect></svg>";
    room.write("kick.svg", example("kick.svg").replace("</svg>", button));
    let run = room.run(&["inspect", "kick.svg"]);
    let button = run.out.lines().find(|line| line.starts_with("   Button "));
    let button = button.expect("a line for the button");
    assert!(
        button.contains("  -  ") && button.contains("follows its parent: "),
        "{button}"
    );
    // Without a motion no part has a joint.
    let run = room.run(&["inspect", "--json", "kick.svg"]);
    assert!(run.out.contains("\"joint\": null"), "{}", run.out);
}

#[test]
fn editors_complete_joints_and_motions() {
    let room = kicker();
    let uri = address(&room.path("kick.svg"));
    let mut editor = Editor::new();
    let text = example("kick.svg").replace("Rshin@Rleg<", "Rshin@Rleg$Bone <");
    editor.opened(&uri, &text);
    let items = |editor: &mut Editor, text: &str, behind: &str| {
        let at = text.find(behind).expect("the words are there") + behind.len();
        let place = json!({"textDocument": {"uri": uri}, "position": position(text, at), "context": {"triggerKind": 1}});
        let items = editor.ask("textDocument/completion", place);
        items.as_array().cloned().unwrap_or_default()
    };
    let found = items(&mut editor, &text, "Rshin@Rleg$Bone ");
    let shin = found.iter().find(|item| item["label"] == "RightLeg");
    let shin = shin.expect("the joint is proposed");
    assert_eq!(shin["detail"], "right leg, lower");
    assert_eq!(shin["textEdit"]["newText"], "RightLeg");
    // A second joint is one below the first.
    let next = text.replace("$Bone <", "$Bone RightUpLeg <");
    editor.change(&uri, 2, &[json!({"text": next})]);
    editor.diagnostics(&uri, 2);
    let found = items(&mut editor, &next, "Rshin@Rleg$Bone RightUpLeg ");
    let joints: Vec<&str> = found
        .iter()
        .filter(|item| {
            item["detail"]
                .as_str()
                .is_some_and(|detail| detail.starts_with("right leg"))
        })
        .map(|item| item["label"].as_str().expect("a label"))
        .collect();
    assert_eq!(joints, ["RightLeg", "RightFoot", "RightToeBase"]);
    assert!(found.iter().all(|item| item["label"] != "LeftLeg"));
    let found = items(&mut editor, &next, "Motion \"");
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0]["label"], "kick.bvh");
    assert_eq!(slice(&next, &found[0]["textEdit"]["range"]), "\"kick.bvh\"");
    assert!(editor.shut_down().success());
}

#[test]
fn hovers_name_the_joint_of_a_part() {
    let room = kicker();
    let uri = address(&room.path("kick.svg"));
    let mut editor = Editor::new();
    let text = example("kick.svg").replace("Rshin@Rleg<", "Rshin@Rleg$Bone RightLeg<");
    editor.opened(&uri, &text);
    for (word, told) in [
        ("Rforearm@", "In clip `kick`: driven by `RightForeArm`: "),
        (
            "path\n         style=\"fill:#22223b",
            "driven by `RightFoot`",
        ),
        (
            "Motion \"kick",
            "clip `kick` of `Hips`: 2.83 s, 68 frames, 34 drawings; 13 of 13 parts are driven by the ",
        ),
        (
            "Limited 4",
            "of 68 frames 4 are omitted (32-35) and 30 are held (",
        ),
        (
            "RightLeg<",
            "**RightLeg**, a joint of `kick.bvh`: right leg, lower",
        ),
    ] {
        let at = text.find(word);
        let Some(at) = at else {
            panic!("{word} is not there")
        };
        let place = json!({"textDocument": {"uri": uri}, "position": position(&text, at)});
        let hover = editor.ask("textDocument/hover", place);
        let card = hover["contents"]["value"].as_str().unwrap_or_default();
        assert!(card.contains(told), "{word}: {told} is not in:\n{card}");
    }
    assert!(editor.shut_down().success());
}
