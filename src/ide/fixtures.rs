//! Drawings for the tests of `ide`.

use super::*;
use crate::compile::{Options, compile};
use crate::resolver::MemoryResolver;

/// The analysis of a drawing without its `¦`, and the offset where that was.
pub(super) fn analysis(source: &str) -> (Analysis, usize) {
    analysis_among(source, &MemoryResolver::default())
}

/// The same, of a drawing that can link to [`motion`] as `kick.bvh`.
pub(super) fn moving(source: &str) -> (Analysis, usize) {
    let files = MemoryResolver::default().with("kick.bvh", motion().into_bytes());
    analysis_among(source, &files)
}

/// The same, and to a track as `hands.json`: the mark `red` strikes late, `green` moves a quarter as much.
pub(super) fn performed(source: &str) -> (Analysis, usize) {
    let files = MemoryResolver::default()
        .with("kick.bvh", motion().into_bytes())
        .with("hands.json", track().into_bytes());
    analysis_among(source, &files)
}

fn track() -> String {
    let points = |far: i32| -> Vec<String> {
        let place = |frame: i32| if frame < 7 { 0 } else { far };
        let places = (0..25).map(place);
        places.map(|x| format!("[{},50]", x + 10)).collect()
    };
    let times: Vec<String> = (0..25)
        .map(|frame| format!("{}", f64::from(frame) / 24.0))
        .collect();
    let mark = |name: &str, color: &str, far: i32| {
        let points = points(far).join(",");
        format!("{{\"name\":\"{name}\",\"colour\":\"{color}\",\"points\":[{points}]}}")
    };
    format!(
        "{{\"format\":\"okoshi track\",\"version\":1,\"size\":[100,100],\"times\":[{}],\"marks\":[{},{}]}}",
        times.join(","),
        mark("red", "#ff0000", 80),
        mark("green", "#008000", 20)
    )
}

fn analysis_among(source: &str, files: &MemoryResolver) -> (Analysis, usize) {
    let at = source.find('¦').unwrap_or(0);
    let source = source.replacen('¦', "", 1);
    let compiled = compile(&source, &Options::default(), files);
    (Analysis::new(source, compiled), at)
}

/// A motion of an upright figure that turns its right arm: 13 frames at 24 a second.
fn motion() -> String {
    let joints = [
        (0, "Hips", [0, 0, 0]),
        (1, "Spine", [0, 20, 0]),
        (2, "Head", [0, 30, 0]),
        (2, "LeftArm", [15, 20, 0]),
        (3, "LeftForeArm", [25, 0, 0]),
        (4, "LeftHand", [25, 0, 0]),
        (2, "RightArm", [-15, 20, 0]),
        (3, "RightForeArm", [-25, 0, 0]),
        (4, "RightHand", [-25, 0, 0]),
        (5, "Grip:1", [-5, 0, 0]),
        (1, "LeftUpLeg", [10, 0, 0]),
        (2, "LeftLeg", [0, -40, 0]),
        (1, "RightUpLeg", [-10, 0, 0]),
        (2, "RightLeg", [0, -40, 0]),
    ];
    let mut out = "HIERARCHY\n".to_owned();
    for (place, (depth, name, [x, y, z])) in joints.iter().enumerate() {
        let (word, channels) = match depth {
            0 => (
                "ROOT",
                "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation",
            ),
            _ => ("JOINT", "3 Zrotation Xrotation Yrotation"),
        };
        out += &format!("{word} {name} {{ OFFSET {x} {y} {z} CHANNELS {channels}\n");
        let next = joints.get(place + 1).map_or(0, |(depth, ..)| *depth);
        if next <= *depth {
            out += &format!("End Site {{ OFFSET {x} {y} {z} }}\n");
            out += &"}\n".repeat(depth + 1 - next);
        }
    }
    out += "MOTION\nFrames: 13\nFrame Time: 0.041666667\n";
    for frame in 0..13 {
        for (_, name, _) in joints {
            let turn = if name == "RightArm" { frame * 5 } else { 0 };
            let own = format!("{turn} 0 0 ");
            out += &if name == "Hips" {
                format!("0 90 0 {own}")
            } else {
                own
            };
        }
        out += "\n";
    }
    out
}

/// A drawing of a body, two arms and a swatch, with these strings beside them: body, right arm, left arm, swatch, and
/// one for the whole drawing.
pub(super) fn figure(strings: [&str; 5]) -> String {
    let [body, right, left, swatch, defaults] = strings;
    let text = |x: i32, y: i32, string: &str| match string {
        "" => String::new(),
        string => format!("<text x=\"{x}\" y=\"{y}\" font-size=\"5\">{string}</text>\n"),
    };
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 100\">\n\
         <rect id=\"body\" x=\"80\" y=\"20\" width=\"40\" height=\"60\" fill=\"#336699\"/>\n\
         <rect id=\"right\" x=\"20\" y=\"40\" width=\"60\" height=\"10\" fill=\"#ffcc99\"/>\n\
         <rect id=\"left\" x=\"120\" y=\"40\" width=\"60\" height=\"10\" fill=\"#ffcc99\"/>\n\
         <rect id=\"swatch\" x=\"2\" y=\"2\" width=\"5\" height=\"5\" fill=\"#ffcc99\"/>\n\
         {}{}{}{}{}</svg>\n",
        text(100, 54, body),
        text(50, 49, right),
        text(150, 49, left),
        text(5, 8, swatch),
        text(150, 95, defaults),
    )
}
