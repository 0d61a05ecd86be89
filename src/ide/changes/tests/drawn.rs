//! What changes of the drawing itself write.

use super::*;
use crate::ide::changes::{NewShape, Stacking};

/// A drawing as Inkscape saves it: scaled, in a layer that is moved and doubled, with a layer of notes above.
fn layered(shapes: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"200mm\" viewBox=\"0 0 100 100\" height=\"200mm\">\n  \
         <g inkscape:groupmode=\"layer\" id=\"layer1\" transform=\"translate(10,20) scale(2)\">{shapes}\n  </g>\n  \
         <g inkscape:groupmode=\"layer\" id=\"layer2\">\n    <text x=\"5\" y=\"95\" font-size=\"4\"># a note</text>\n  </g>\n\
         </svg>\n"
    )
}

const BODY: &str = "\n    <rect id=\"body\" x=\"10\" y=\"5\" width=\"10\" height=\"20\" style=\"fill:#336699\" />\n    <text x=\"11\" y=\"15\" font-size=\"2\">Body$Shape round</text>";

fn draw(shape: NewShape) -> Change {
    Change::Draw {
        shape,
        fill: "#CC4422".to_owned(),
    }
}

#[test]
fn shapes_are_written_in_front_of_the_others_in_the_coordinates_of_their_layer() {
    let painted = "style=\"fill:#cc4422;stroke:none\"";
    for (shape, written) in [
        (
            NewShape::Ellipse([60.0, 40.0, 10.0, 10.0]),
            format!("<circle id=\"circle-1\" {painted} cx=\"25\" cy=\"10\" r=\"5\" />"),
        ),
        (
            NewShape::Ellipse([60.0, 40.0, 10.0, 5.001]),
            format!(
                "<ellipse id=\"ellipse-1\" {painted} cx=\"25\" cy=\"10\" rx=\"5\" ry=\"2.501\" />"
            ),
        ),
        (
            NewShape::Rect([60.0, 40.0, -10.0, 5.0]),
            format!(
                "<rect id=\"rect-1\" {painted} x=\"20\" y=\"10\" width=\"5\" height=\"2.5\" />"
            ),
        ),
        (
            NewShape::Path("M60 40h10v7.3C65 45 60 50 60 42".to_owned()),
            format!(
                "<path id=\"path-1\" {painted} d=\"M 25,10 L 30,10 L 30,13.65 C 27.5,12.5 25,15 25,11 Z\" />"
            ),
        ),
    ] {
        let before = layered(BODY);
        let text = made(&before, &draw(shape)).unwrap();
        let body = BODY.find("<text").unwrap() - "\n    ".len();
        let (front, texts) = BODY.split_at(body);
        assert_eq!(text, layered(&format!("{front}\n    {written}{texts}")));
    }
}

#[test]
fn the_first_shape_of_a_drawing_goes_into_the_layer_in_which_nothing_is_written() {
    let circle =
        "<circle id=\"circle-1\" style=\"fill:#cc4422;stroke:none\" cx=\"25\" cy=\"10\" r=\"5\" />";
    let change = draw(NewShape::Ellipse([60.0, 40.0, 10.0, 10.0]));
    assert_eq!(
        made(&layered(""), &change).unwrap(),
        layered(&format!("\n    {circle}"))
    );
    let empty = layered("").replace(">\n  </g>\n  <g", "/>\n  <g");
    let open = empty.replace(
        "scale(2)\"/>",
        &format!("scale(2)\">\n    {circle}\n  </g>"),
    );
    assert_eq!(made(&empty, &change).unwrap(), open);
    for (bare, drawn) in [
        (
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"/>",
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\">\n  #\n</svg>",
        ),
        (
            "<s:svg xmlns:s=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"></s:svg>",
            "<s:svg xmlns:s=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\">\n  #\n</s:svg>",
        ),
        (
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\">\n\t<defs/>\n</svg>",
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\">\n\t<defs/>\n  #\n</svg>",
        ),
    ] {
        let text = made(bare, &draw(NewShape::Rect([1.0, 2.0, 3.0, 4.0]))).unwrap();
        let prefix = if bare.starts_with("<s:") { "s:" } else { "" };
        let rect = format!(
            "<{prefix}rect id=\"rect-1\" style=\"fill:#cc4422;stroke:none\" x=\"1\" y=\"2\" width=\"3\" height=\"4\" />"
        );
        assert_eq!(text, drawn.replace('#', &rect));
    }
}

#[test]
fn a_layer_that_is_turned_takes_shapes_as_they_are_drawn() {
    let before = layered(BODY).replace("scale(2)", "rotate(30)");
    let text = made(&before, &draw(NewShape::Rect([60.0, 40.0, 10.0, 5.0]))).unwrap();
    let (analysis, _) = analysis(&text);
    let bounds = analysis.bindings().parts.last().unwrap().measure.bounds;
    let expected = (glam::DVec2::new(60.0, 40.0), glam::DVec2::new(70.0, 45.0));
    assert!(
        bounds.0.distance(expected.0) < 1e-4 && bounds.1.distance(expected.1) < 1e-4,
        "{bounds:?}"
    );
}

fn shift(part: &str, by: [f64; 2]) -> Change {
    Change::Move {
        part: part.to_owned(),
        by,
    }
}

#[test]
fn a_part_is_moved_with_its_string_in_the_fewest_characters() {
    let before = layered(BODY);
    let text = made(&before, &shift("Body", [3.0, -4.0])).unwrap();
    let expected = before.replace("x=\"10\" y=\"5\"", "x=\"11.5\" y=\"3\"");
    let expected = expected.replace("x=\"11\" y=\"15\"", "x=\"12.5\" y=\"13\"");
    assert_eq!(text, expected);
    assert_eq!(made(&text, &shift("Body", [-3.0, 4.0])).unwrap(), before);

    let lines =
        "<text x=\"50\" y=\"49\" font-size=\"5\"><tspan x=\"50\" y=\"49\">Rarm@Body</tspan></text>";
    let figure = figure(["Body$Shape round", "Rarm@Body$Origin 78 45", "", "", ""]);
    let figure = figure.replace(
        "<text x=\"50\" y=\"49\" font-size=\"5\">Rarm@Body",
        &lines.replace("</tspan></text>", ""),
    );
    let figure = figure.replace("$Origin 78 45</text>", "$Origin 78 45</tspan></text>");
    let text = made(&figure, &shift("Rarm", [2.25, 1.0])).unwrap();
    let expected = figure
        .replace(
            "id=\"right\" x=\"20\" y=\"40\"",
            "id=\"right\" x=\"22.25\" y=\"41\"",
        )
        .replace("x=\"50\" y=\"49\"", "x=\"52.25\" y=\"50\"")
        .replace("Origin 78 45", "Origin 80.25 46");
    assert_eq!(text, expected);
}

#[test]
fn what_has_no_numbers_of_its_own_is_moved_by_a_transform() {
    for (element, moved) in [
        (
            "<path d=\"M 5,5 h 9 v 9 z\"/>",
            "<path transform=\"translate(2,-1.5)\" d=\"M 5,5 h 9 v 9 z\"/>",
        ),
        (
            "<rect transform=\"translate(1, 1) rotate(4)\" width=\"9\" height=\"9\"/>",
            "<rect transform=\"translate(3,-0.5) rotate(4)\" width=\"9\" height=\"9\"/>",
        ),
        (
            "<rect transform=\"matrix(1 0 0 1 -2 .25)\" width=\"9\" height=\"9\"/>",
            "<rect transform=\"matrix(1,0,0,1,0,-1.25)\" width=\"9\" height=\"9\"/>",
        ),
        (
            "<rect transform=\"rotate(4)\" width=\"9\" height=\"9\"/>",
            "<rect transform=\"translate(2,-1.5) rotate(4)\" width=\"9\" height=\"9\"/>",
        ),
        (
            "<path d=\"M 5,5 h 9 v 9 z\" transform=\"translate(-2,1.5)\"/>",
            "<path d=\"M 5,5 h 9 v 9 z\"/>",
        ),
        (
            "<rect width=\"9\" height=\"9\"/>",
            "<rect y=\"-1.5\" x=\"2\" width=\"9\" height=\"9\"/>",
        ),
        (
            "<circle cx=\"1e1\" cy=\"9\" r=\"5\"/>",
            "<circle transform=\"translate(2,-1.5)\" cx=\"1e1\" cy=\"9\" r=\"5\"/>",
        ),
        (
            "<rect x=\"1in\" width=\"9\" height=\"9\"/>",
            "<rect transform=\"translate(2,-1.5)\" x=\"1in\" width=\"9\" height=\"9\"/>",
        ),
    ] {
        let drawing = |element: &str| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"200\">{element}<rect x=\"150\" y=\"150\" width=\"9\" height=\"9\"/></svg>"
            )
        };
        let text = made(&drawing(element), &shift("U-1", [2.0, -1.5])).unwrap();
        // Attributes that are both missing may come in either order.
        let text = text.replace(
            "<rect x=\"2\" y=\"-1.5\" width",
            "<rect y=\"-1.5\" x=\"2\" width",
        );
        assert_eq!(text, drawing(moved));
    }
}

#[test]
fn clones_go_along_and_are_told_of() {
    let drawing = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"200\"><rect id=\"a\" x=\"20\" y=\"20\" width=\"30\" height=\"30\"/><use href=\"#a\" x=\"60\"/></svg>";
    let (before, _) = analysis(drawing);
    let change = shift("U-1", [5.0, 0.0]);
    let text = applied(drawing, &edits(&before, &change).unwrap());
    assert_eq!(text, drawing.replace("x=\"20\"", "x=\"25\""));
    let note = check(&before, &analysis(&text).0, &change).unwrap();
    assert_eq!(note.as_deref(), Some("its clone goes with `U-1`"));
    let own = made(drawing, &shift("U-2", [5.0, 0.0])).unwrap();
    assert_eq!(own, drawing.replace("x=\"60\"", "x=\"65\""));
    let erase = Change::Erase {
        part: "U-1".to_owned(),
    };
    assert!(
        made(drawing, &erase)
            .unwrap_err()
            .why
            .contains("refers to `#a`")
    );
}

fn stacked(order: [&str; 3]) -> String {
    let shapes = order.map(|name| {
        let x = 10 * (name.len() + 1);
        format!("\n  <rect id=\"{name}\" x=\"{x}\" y=\"20\" width=\"30\" height=\"30\"/>")
    });
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"200\"><desc>x</desc>{}\n  <text x=\"150\" y=\"150\"># note</text>\n</svg>",
        shapes.concat()
    )
}

#[test]
fn parts_are_drawn_later_or_earlier() {
    let order = ["back", "middle", "front"];
    let before = stacked(order);
    for (part, to, after) in [
        ("back", Stacking::Front, ["middle", "front", "back"]),
        ("back", Stacking::Forward, ["middle", "back", "front"]),
        ("back", Stacking::Back, order),
        ("front", Stacking::Back, ["front", "back", "middle"]),
        ("front", Stacking::Backward, ["back", "front", "middle"]),
        ("front", Stacking::Forward, order),
        ("middle", Stacking::Front, ["back", "front", "middle"]),
    ] {
        let change = Change::Restack {
            part: part.to_owned(),
            to,
        };
        assert_eq!(
            made(&before, &change).unwrap(),
            stacked(after),
            "{part} {to:?}"
        );
    }
}

#[test]
fn a_part_is_deleted_with_its_string_unless_others_hang_on_it() {
    let erase = |part: &str| Change::Erase {
        part: part.to_owned(),
    };
    let drawing = |arm: &str| figure(["Body$Shape round", arm, "Larm@Body", "", ""]);
    let before = drawing("Rarm@Body");
    let text = made(&before, &erase("Rarm")).unwrap();
    let expected = before.replace(
        "\n<rect id=\"right\" x=\"20\" y=\"40\" width=\"60\" height=\"10\" fill=\"#ffcc99\"/>",
        "",
    );
    let expected = expected.replace(
        "\n<text x=\"50\" y=\"49\" font-size=\"5\">Rarm@Body</text>",
        "",
    );
    assert_eq!(text, expected);
    let refusal = made(&before, &erase("Body")).unwrap_err();
    assert_eq!(
        refusal.why,
        "`Rarm` and `Larm` hang on `Body`: hang them elsewhere first"
    );
    let hung = made(&before, &refusal.choices[0].change).unwrap();
    assert!(hung.contains("Rarm@Root"));
}

#[test]
fn a_part_is_painted_where_its_paint_stands() {
    let paint = |part: &str, fill: &str| Change::Paint {
        part: part.to_owned(),
        fill: fill.to_owned(),
    };
    let before = layered(BODY);
    let text = made(&before, &paint("Body", "#CC4422")).unwrap();
    assert_eq!(text, before.replace("fill:#336699", "fill:#cc4422"));
    let said = figure(["Body$Color red", "Rarm@Body", "", "", ""]);
    let refusal = made(&said, &paint("Body", "#cc4422")).unwrap_err();
    assert!(
        refusal.why.contains("says the colour of `Body`"),
        "{}",
        refusal.why
    );
    let changed = made(&said, &refusal.choices[0].change).unwrap();
    assert_eq!(changed, said.replace("Color red", "Color #cc4422"));
    let styled = before.replace("<g inkscape:groupmode=\"layer\" id=\"layer1\"", "<style>rect { fill: #112233 !important }</style><g inkscape:groupmode=\"layer\" id=\"layer1\"");
    let refusal = made(&styled, &paint("Body", "#cc4422")).unwrap_err();
    assert!(
        refusal.why.contains("a style sheet may say otherwise"),
        "{}",
        refusal.why
    );
}

#[test]
fn what_would_change_more_or_nothing_is_refused() {
    let before = figure(["Body$Shape round", "Rarm@Body", "", "", ""]);
    for (change, why) in [
        (draw(NewShape::Rect([10.0, 10.0, 0.1, 0.1])), "too small"),
        (
            draw(NewShape::Path("M 10 10 L 30 30".to_owned())),
            "too small",
        ),
        (draw(NewShape::Path("rect".to_owned())), "no path data"),
        (
            draw(NewShape::Rect([1e5, 10.0, 9.0, 9.0])),
            "outside the page",
        ),
        (
            Change::Draw {
                shape: NewShape::Rect([10.0, 10.0, 9.0, 9.0]),
                fill: "red".to_owned(),
            },
            "`red` is no colour",
        ),
        (
            draw(NewShape::Rect([19.0, 39.0, 62.0, 12.0])),
            "the text `Rarm@Body` would mean another shape then, or none: draw it farther",
        ),
        (shift("Rarm", [1e5, 0.0]), "outside the page"),
        (shift("Nobody", [1.0, 0.0]), "there is no part `Nobody`"),
    ] {
        let refusal = made(&before, &change).unwrap_err();
        assert!(refusal.why.contains(why), "{}", refusal.why);
    }
}

#[test]
fn the_part_of_a_change_is_known_afterwards() {
    let drawing = stacked(["path1", "path22", "path333"]);
    let (before, _) = analysis(&drawing);
    let after = |change: &Change| {
        let edits = edits(&before, change).unwrap();
        let (after, _) = analysis(&applied(&drawing, &edits));
        part_after(&before, &after, change, &edits)
    };
    let front = Change::Restack {
        part: "U-1".to_owned(),
        to: Stacking::Front,
    };
    assert_eq!(after(&front).as_deref(), Some("U-3"));
    assert_eq!(
        after(&draw(NewShape::Rect([9.0, 9.0, 9.0, 9.0]))).as_deref(),
        Some("U-4")
    );
    assert_eq!(
        after(&Change::Erase {
            part: "U-1".to_owned()
        }),
        None
    );
}

#[test]
fn a_shape_that_belongs_to_a_part_is_changed_by_itself_and_goes_with_the_part() {
    let before = figure(["Body$Shape round", "Rarm@Body", "", "", ""]);
    let button = "<circle id=\"circle-1\" style=\"fill:#cc4422;stroke:none\" cx=\"100\" cy=\"40\" r=\"4\" />";
    let drawn = made(&before, &draw(NewShape::Ellipse([100.0, 40.0, 4.0, 4.0]))).unwrap();
    assert!(drawn.contains(button));
    let moved = made(&drawn, &shift("circle-1", [1.0, 2.0])).unwrap();
    assert_eq!(
        moved,
        drawn.replace("cx=\"100\" cy=\"40\"", "cx=\"101\" cy=\"42\"")
    );
    let with_body = made(&drawn, &shift("Body", [1.0, 2.0])).unwrap();
    assert!(with_body.contains("cx=\"101\" cy=\"42\"") && with_body.contains("x=\"81\" y=\"22\""));
    let erased = made(
        &drawn,
        &Change::Erase {
            part: "circle-1".to_owned(),
        },
    )
    .unwrap();
    assert_eq!(erased, before);
}
