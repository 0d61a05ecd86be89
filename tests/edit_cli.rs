//! `okoshi edit`, which changes drawings, and `okoshi inspect --form`, which says what can be changed. What changes write is tested in
//! `tests/changes.rs`.
#![cfg(feature = "cli")]

mod common;

use common::program::{Room, Run};
use serde_json::{Value, json};

const FIGURE: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="200" height="200">
  <g id="upper">
    <rect x="20" y="20" width="60" height="40" fill="#cc0000" id="body"/>
    <text x="50" y="44" font-size="5" id="named">Body</text>
  </g>
  <rect x="90" y="30" width="60" height="10" fill="#0000cc" id="arm"/>
  <text x="120" y="39" font-size="5" id="string">Arm@Body$Offset 2</text>
  <rect x="90" y="80" width="60" height="10" fill="#0000cc" id="leg"/>
  <text x="120" y="89" font-size="5">Leg@Body</text>
  <g id="hat" inkscape:label="Hat">
    <rect x="20" y="5" width="60" height="10" fill="#00cc00" id="brim"/>
    <rect x="40" y="2" width="20" height="5" fill="#00cc00" id="crown"/>
  </g>
  <rect x="5" y="150" width="10" height="10" fill="#0000cc" id="sample"/>
  <text x="20" y="158" font-size="5" id="legend">$Shape round</text>
  <text x="120" y="190" font-size="5" id="all">%Let w 4</text>
</svg>
"##;

fn edit(room: &Room, changes: &[Value], more: &[&str]) -> Run {
    let changes: Vec<String> = changes.iter().map(Value::to_string).collect();
    let mut arguments = vec!["edit", "a.svg"];
    for change in &changes {
        arguments.extend(["--change", change]);
    }
    arguments.extend(more);
    room.run(&arguments)
}

fn set(part: &str, attribute: &str, value: &str) -> Value {
    json!({ "change": "set", "part": part, "attribute": attribute, "value": value })
}

fn changed(replacements: &[(&str, &str)]) -> String {
    let mut text = FIGURE.to_owned();
    for (old, new) in replacements {
        assert_eq!(text.matches(old).count(), 1, "{old}");
        text = text.replace(old, new);
    }
    text
}

fn read(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn changes_are_made_in_turn_and_nothing_else_is() {
    let room = Room::with("a.svg", FIGURE);
    let changes = [
        set("Arm", "Offset", "3.5"),
        json!({ "change": "name", "part": "Arm", "name": "Wing" }),
        json!({ "change": "hang", "part": "Wing", "parent": "Hat" }),
    ];
    edit(&room, &changes, &[]).ends(
        0,
        "a.svg: changed Offset of Arm\na.svg: changed the name Wing\na.svg: changed the parent of Wing\n",
        "",
    );
    let expected = changed(&[("Arm@Body$Offset 2", "Wing@Hat$Offset 3.5")]);
    assert_eq!(room.read("a.svg"), expected.as_bytes());
    assert_eq!(room.files(), ["a.svg"]);
    edit(&room, &[set("Wing", "Offset", "3.5")], &[]).ends(
        0,
        "a.svg: everything is so already",
        "",
    );
    assert_eq!(room.read("a.svg"), expected.as_bytes());
}

#[test]
fn what_is_drawn_is_changed_too_and_the_report_has_the_name_of_the_new_part() {
    let room = Room::with("a.svg", FIGURE);
    let changes = [
        json!({ "change": "draw", "shape": { "ellipse": [50, 100, 10, 10] }, "fill": "#cc4422" }),
        json!({ "change": "move", "part": "Arm", "by": [5, -2] }),
        json!({ "change": "erase", "part": "Leg" }),
    ];
    let run = edit(&room, &changes, &["--json"]);
    assert_eq!((run.status, run.err.as_str()), (0, ""));
    let report = read(&run.out);
    let parts: Vec<&Value> = (0..3).map(|at| &report["made"][at]["part"]).collect();
    assert_eq!(parts, [&json!("U-1"), &json!("Arm"), &Value::Null]);
    let leg = "  <rect x=\"90\" y=\"80\" width=\"60\" height=\"10\" fill=\"#0000cc\" id=\"leg\"/>\n  <text x=\"120\" y=\"89\" font-size=\"5\">Leg@Body</text>\n";
    let hat =
        "<rect x=\"40\" y=\"2\" width=\"20\" height=\"5\" fill=\"#00cc00\" id=\"crown\"/>\n  </g>";
    let circle = "\n  <circle id=\"circle-1\" style=\"fill:#cc4422;stroke:none\" cx=\"50\" cy=\"100\" r=\"10\" />";
    let expected = changed(&[
        (leg, ""),
        ("x=\"90\" y=\"30\"", "x=\"95\" y=\"28\""),
        ("x=\"120\" y=\"39\"", "x=\"125\" y=\"37\""),
        (hat, &format!("{hat}{circle}")),
    ]);
    assert_eq!(room.read("a.svg"), expected.as_bytes());
}

#[test]
fn the_result_goes_where_it_is_asked_for() {
    let room = Room::with("a.svg", FIGURE);
    let change = [set("Arm", "Offset", "3.5")];
    let expected = changed(&[("Offset 2", "Offset 3.5")]);
    edit(&room, &change, &["-o", "b.svg", "-q"]).ends(0, "", "");
    assert_eq!(room.read("b.svg"), expected.as_bytes());
    let run = edit(&room, &change, &["-o", "-"]);
    assert_eq!((run.status, run.out.as_str()), (0, expected.as_str()));
    assert_eq!(run.err, "a.svg: changed Offset of Arm\n");
    let change = change[0].to_string();
    let piped = room.pipe(&["edit", "-", "-c", &change], FIGURE.as_bytes());
    assert_eq!(piped.stdout, expected.as_bytes());
    // Nothing to change is a result, too.
    let piped = room.pipe(&["edit", "-", "-c", &change], expected.as_bytes());
    assert_eq!(piped.stdout, expected.as_bytes());
    assert_eq!(room.read("a.svg"), FIGURE.as_bytes());
}

#[test]
fn a_refusal_says_what_can_be_done_instead() {
    let room = Room::with("a.svg", FIGURE);
    let changes = [
        set("Arm", "Offset", "3.5"),
        set("Leg", "Shape", "cone 0 7 0.5"),
    ];
    let run = edit(&room, &changes, &[]);
    let instead = "--change '{\"change\":\"set\",\"part\":\"Leg\",\"attribute\":\"Shape\",\"value\":\"cone 0 7 0.5\",\"place\":\"own\"}'";
    assert!(run.err.contains(instead), "{}", run.err);
    run.ends(
        1,
        "",
        "`a.svg` stays as it is: `Shape` of `Leg` comes from the legend `$Shape round`",
    );
    let run = edit(&room, &changes, &["--json"]);
    assert_eq!((run.status, run.err.as_str()), (1, ""));
    let report = read(&run.out);
    assert_eq!(report["made"], json!([]));
    let refused = &report["refused"];
    assert_eq!(refused["change"]["part"], "Leg");
    let choices = refused["choices"].as_array().expect("choices");
    let own = choices
        .iter()
        .find(|choice| choice["change"]["place"] == "own");
    let own = own.expect("a choice")["change"].clone();
    // All or none.
    assert_eq!(room.read("a.svg"), FIGURE.as_bytes());
    let run = edit(&room, &[changes[0].clone(), own], &["--json"]);
    assert_eq!(run.status, 0, "{}", run.err);
    let report = read(&run.out);
    assert_eq!(report["refused"], Value::Null);
    assert_eq!(report["made"][1]["title"], "Shape of Leg");
    assert_eq!(report["made"][1]["part"], "Leg");
    let expected = changed(&[
        ("Offset 2", "Offset 3.5"),
        ("Leg@Body", "Leg@Body$Shape cone 0 7 0.5"),
    ]);
    assert_eq!(room.read("a.svg"), expected.as_bytes());
}

#[test]
fn wrong_uses_of_edit() {
    let room = Room::with("a.svg", FIGURE);
    room.write("broken.svg", "<svg");
    room.write("other.svg", FIGURE);
    let bad = |change: Value, said: &str| edit(&room, &[change], &[]).ends(2, "", said);
    bad(json!("Arm"), "expected");
    bad(json!({}), "missing field `change`");
    bad(json!({ "change": "dye" }), "expected one of `set`");
    bad(
        json!({ "change": "set", "part": "Arm" }),
        "missing field `attribute`",
    );
    bad(set("Arm", "Shap", "round"), "there is no attribute `Shap`");
    bad(
        json!({ "change": "leave-out", "part": "Arm", "why": "" }),
        "unknown field `why`",
    );
    let run = room.run(&["edit", "a.svg", "-c", "{"]);
    run.ends(2, "", "a change is JSON, for example {\"change\"");
    edit(&room, &[], &[]).ends(2, "", "--change <JSON>");
    let change = [set("Arm", "Offset", "3")];
    edit(&room, &change, &["-o", "a.glb"]).ends(2, "", "must end in .svg");
    edit(&room, &change, &["-o", "other.svg"]).ends(2, "", "other.svg");
    let refused = |change: Value, said: &str| edit(&room, &[change], &[]).ends(1, "", said);
    refused(set("Nobody", "Offset", "3"), "there is no part `Nobody`");
    refused(set("Arm", "Shape", "squirrel"), "squirrel");
    refused(set("Arm", "Offset", "3 $Color red"), "stays as it is");
    let change = change[0].to_string();
    room.run(&["edit", "broken.svg", "-c", &change])
        .ends(1, "", "correct its errors first");
    room.run(&["edit", "gone.svg", "-c", &change])
        .ends(2, "", "gone.svg");
    assert_eq!(room.read("a.svg"), FIGURE.as_bytes());
    assert_eq!(room.read("other.svg"), FIGURE.as_bytes());
    assert_eq!(room.files(), ["a.svg", "broken.svg", "other.svg"]);
}

#[test]
fn the_form_says_what_each_attribute_is_and_may_be() {
    let room = Room::with("a.svg", FIGURE);
    room.write("kick.bvh", "");
    let run = room.run(&["inspect", "a.svg", "--form", "Arm"]);
    assert_eq!((run.status, run.err.as_str()), (0, ""));
    let report = read(&run.out);
    assert_eq!(report["drawing"], "a.svg");
    let form = &report["forms"][0];
    assert_eq!(form["part"], "Arm");
    assert_eq!(form["parent"], "Body");
    assert_eq!(form["motion"]["files"], json!(["kick.bvh"]));
    let fields = form["fields"].as_array().expect("fields");
    let field = |name: &str| {
        let field = fields.iter().find(|field| field["attribute"] == name);
        field.expect("a field")
    };
    assert_eq!(field("Offset")["value"], "2");
    assert_eq!(field("Offset")["from"], "own");
    assert_eq!(field("Shape")["from"], "legend");
    assert_eq!(field("Shape")["shared"], json!(["`Leg`"]));
    let kinds = field("Shape")["variants"].as_array().expect("kinds");
    assert!(kinds.iter().any(|kind| kind["word"] == "cone"));
}

#[test]
fn a_form_is_found_by_the_elements_of_its_part() {
    let room = Room::with("a.svg", FIGURE);
    let part = |element: &str| {
        let run = room.run(&["inspect", "a.svg", "--form", &format!("#{element}")]);
        assert_eq!((run.status, run.err.as_str()), (0, ""), "{element}");
        read(&run.out)["forms"][0]["part"].clone()
    };
    for (element, name) in [
        ("body", "Body"),
        ("named", "Body"),
        ("upper", "Body"),
        ("arm", "Arm"),
        ("string", "Arm"),
        ("hat", "Hat"),
        ("brim", "Hat"),
        ("crown", "Hat"),
    ] {
        assert_eq!(part(element), name, "{element}");
    }
}

#[test]
fn forms_that_there_are_not() {
    let room = Room::with("a.svg", FIGURE);
    room.write("broken.svg", "<svg");
    let form = |part: &str, said: &str| {
        let run = room.run(&["inspect", "a.svg", "--form", part]);
        assert!(run.err.contains("`okoshi inspect a.svg` lists the parts"));
        run.ends(2, "", &format!("error: a.svg: {said}"));
    };
    form("Nobody", "there is no part `Nobody`");
    form("#nobody", "there is no visible shape, text or group");
    form("#all", "the text `#all` is the string of no part");
    form("#sample", "`#sample` belongs to a legend");
    form("#legend", "`#legend` belongs to a legend");
    // Beside others, which are printed.
    let run = room.run(&["inspect", "a.svg", "--form=#all", "--form=Arm"]);
    assert_eq!(
        read(&run.out)["forms"].as_array().map(Vec::len),
        Some(1),
        "{}",
        run.err
    );
    run.ends(2, "Arm", "`#all`");
    room.run(&["inspect", "a.svg", "--form", "Arm", "--json"])
        .ends(2, "", "--json");
    room.run(&["inspect", "broken.svg", "--form", "Arm"])
        .ends(1, "", "error[E0");
    room.run(&["inspect", "gone.svg", "--form", "Arm"])
        .ends(2, "", "gone.svg");
}
