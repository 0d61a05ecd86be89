use serde_json::{Value, json};

use super::Studio;

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
  <rect x="40" y="40" width="20" height="40" fill="#c30"/>
  <text x="45" y="60">Body$Shape default -2 2</text>
</svg>"##;

/// The messages since the last call, by their types.
fn messages(studio: &mut Studio) -> Vec<(String, Value)> {
    let messages = studio.messages();
    let read = messages.iter().map(|message| {
        let message: Value = serde_json::from_str(message).unwrap();
        (message["type"].as_str().unwrap().to_owned(), message)
    });
    read.collect()
}

/// The last build among the messages since the last call.
fn build(studio: &mut Studio) -> Value {
    let messages = messages(studio).into_iter();
    let mut builds = messages.rev().filter(|(kind, _)| kind == "build");
    builds.next().expect("a build").1["build"].take()
}

fn with_drawing(path: &str) -> Studio {
    let mut studio = Studio::default();
    studio.put(path, DRAWING.into(), 0.0).unwrap();
    studio
}

fn change(studio: &mut Studio, to_do: &Value, revision: u64) -> Value {
    let request = json!({ "drawing": "a.svg", "revision": revision, "do": to_do });
    serde_json::from_str(&studio.change(&request.to_string(), 1.0)).unwrap()
}

#[test]
fn a_drawing_is_listed_and_built() {
    let mut studio = with_drawing("folder/a.svg");
    let told = messages(&mut studio);
    let kinds: Vec<&str> = told.iter().map(|(kind, _)| kind.as_str()).collect();
    assert_eq!(kinds, ["editing", "drawings", "build"]);
    let listed = json!([{ "id": "folder/a.svg", "name": "a.svg", "folder": "folder" }]);
    assert_eq!(told[1].1["drawings"], listed);
    let build = &told[2].1["build"];
    assert_eq!(build["parts"][0]["name"], "Body");
    let bytes = |what: &str| studio.bytes(build[what].as_str().unwrap()).unwrap();
    assert!(bytes("model").starts_with(b"glTF"));
    assert!(bytes("picture").starts_with(b"\x89PNG"));
    assert!(studio.bytes("builds/99.glb").is_none() && studio.bytes("nothing").is_none());
    assert!(messages(&mut studio).is_empty());
}

#[test]
fn a_change_is_tried_made_and_undone() {
    let mut studio = with_drawing("a.svg");
    let first = build(&mut studio);
    let set =
        json!({ "change": "set", "part": "Body", "attribute": "Shape", "value": "default -5 5" });
    let asked =
        json!({ "drawing": "a.svg", "revision": 1, "change": set, "shows": first["model"] });
    let tried = studio.attempt(&asked.to_string()).unwrap();
    assert!(tried.address.starts_with("tries/") && tried.bytes.starts_with(b"okdl"));
    assert_eq!(studio.text("a.svg").as_deref(), Some(DRAWING));

    let made = change(&mut studio, &json!({ "make": set }), 1);
    assert_eq!(
        (&made["ok"], &made["body"]["part"]),
        (&json!(true), &json!("Body"))
    );
    let after = DRAWING.replace("Shape default -2 2", "Shape default -5 5");
    assert_eq!(studio.text("a.svg").as_deref(), Some(after.as_str()));
    let second = build(&mut studio);
    assert_eq!(
        (&second["revision"], &second["since"]),
        (&json!(2), &json!(1))
    );
    let address = format!(
        "{}?since={}",
        second["model"].as_str().unwrap(),
        first["model"].as_str().unwrap()
    );
    let [delta, whole] =
        [&address, second["model"].as_str().unwrap()].map(|address| studio.bytes(address).unwrap());
    assert_ne!(delta, whole);

    let form = studio.form(&json!({ "drawing": "a.svg", "part": "Body" }).to_string());
    let form: Value = serde_json::from_str(&form).unwrap();
    assert_eq!(form["ok"], true);

    change(&mut studio, &json!("undo"), 2);
    assert_eq!(studio.text("a.svg").as_deref(), Some(DRAWING));
    let refused = change(&mut studio, &json!("undo"), 3);
    let why = json!({ "why": "there is nothing to undo", "choices": [] });
    assert_eq!((&refused["ok"], &refused["body"]), (&json!(false), &why));
    let unread = studio.change("{}", 2.0);
    assert!(unread.contains("the change cannot be read"), "{unread}");
}

#[test]
fn what_a_refusal_offers_is_decided_in_the_text_that_it_tells_of() {
    let mut studio = with_drawing("a.svg");
    let saved = |depth: u32| DRAWING.replace("default -2 2", &format!("default -{depth} {depth}"));
    let set =
        json!({ "change": "set", "part": "Body", "attribute": "Shape", "value": "default -5 5" });
    // The page shows the first build all the time.
    studio.put("a.svg", saved(3).into_bytes(), 1.0).unwrap();
    let refused = change(&mut studio, &json!({ "make": set }), 1);
    assert_eq!(refused["ok"], false);
    let offered = &refused["body"]["choices"][0];
    assert_eq!(offered["title"], "Change it all the same");
    // What is saved after that is asked about anew.
    studio.put("a.svg", saved(4).into_bytes(), 2.0).unwrap();
    let choose = json!({ "choose": offered["change"] });
    assert_eq!(change(&mut studio, &choose, 1)["ok"], false);
    assert_eq!(studio.text("a.svg").as_deref(), Some(saved(4).as_str()));
    assert_eq!(change(&mut studio, &choose, 1)["ok"], true);
    assert_eq!(studio.text("a.svg").as_deref(), Some(saved(5).as_str()));
    change(&mut studio, &json!("undo"), 1);
    assert_eq!(studio.text("a.svg").as_deref(), Some(saved(4).as_str()));
}

#[test]
fn files_that_are_linked_to_come_and_go() {
    let text = DRAWING.replace("Shape default -2 2", r#"Texture "wood.png""#);
    let mut studio = Studio::default();
    studio.put("toys/a.svg", text.into_bytes(), 0.0).unwrap();
    assert_eq!(build(&mut studio)["findings"][0]["severity"], "error");
    let mut png = Vec::new();
    let picture = image::RgbImage::from_pixel(2, 2, image::Rgb([200, 150, 100]));
    let mut out = std::io::Cursor::new(&mut png);
    picture.write_to(&mut out, image::ImageFormat::Png).unwrap();
    // A file of another folder is none that it can mean.
    studio.put("wood.png", png.clone(), 1.0).unwrap();
    assert!(
        messages(&mut studio)
            .iter()
            .all(|(kind, _)| kind != "build")
    );
    studio.put("toys/wood.png", png, 2.0).unwrap();
    assert_eq!(build(&mut studio)["findings"], json!([]));
    assert_eq!(studio.links("toys/a.svg"), ["wood.png"]);
    assert!(studio.links("toys/b.svg").is_empty());
    studio.remove("toys/wood.png", 3.0);
    assert_eq!(build(&mut studio)["findings"][0]["severity"], "error");
    studio.remove("toys/a.svg", 4.0);
    assert_eq!(messages(&mut studio)[0].1["drawings"], json!([]));
    assert!(studio.text("toys/a.svg").is_none());
}

#[test]
fn a_starter_is_begun() {
    let mut studio = Studio::default();
    studio.offer();
    let told = messages(&mut studio);
    let starters = told.iter().find(|(kind, _)| kind == "starters").unwrap();
    assert_eq!(starters.1["starters"][0]["name"], "girl");
    assert!(
        studio
            .bytes("starters/girl.png")
            .unwrap()
            .starts_with(b"\x89PNG")
    );
    let begin =
        |starter: &str| json!({ "type": "begin", "key": "", "starter": starter }).to_string();
    studio.receive(&begin("nobody"), 0.0);
    assert_eq!(
        messages(&mut studio)[0].1["why"],
        "there is no starter `nobody`"
    );
    studio.receive(&begin("robot"), 0.0);
    assert!(build(&mut studio)["parts"].as_array().unwrap().len() > 5);
    assert!(studio.text("robot.svg").is_some());
}

#[test]
fn what_is_no_text_is_refused() {
    let mut studio = Studio::default();
    let refused = studio.put("a.svg", vec![0xff, 0xfe, 0], 0.0);
    assert_eq!(
        refused.unwrap_err(),
        "the drawing is not text in UTF-8: save it as plain SVG"
    );
    studio.put("a.svg", b"<svg".to_vec(), 0.0).unwrap();
    assert_eq!(build(&mut studio)["findings"][0]["severity"], "error");
}

#[test]
fn a_link_does_not_leave_the_folder_however_it_is_spelled() {
    let mut studio = Studio::default();
    studio.put("wood.png", vec![1], 0.0).unwrap();
    studio.put("toys/in here.png", vec![1], 0.0).unwrap();
    for (link, why) in [
        ("../wood.png", "is outside the drawing's folder"),
        ("%2e%2e/wood.png", "is outside the drawing's folder"),
        ("%252e%252e/wood.png", "is not there"),
        ("in%20here.png", "format could not be determined"),
    ] {
        let text = DRAWING.replace("Shape default -2 2", &format!(r#"Texture "{link}""#));
        studio.put("toys/a.svg", text.into_bytes(), 0.0).unwrap();
        let build = build(&mut studio);
        let message = build["findings"][0]["message"].as_str().unwrap();
        assert!(message.contains(why), "{link}: {message}");
    }
}

/// A drawing with an accent, a sign that is escaped, a mistake, and a text of two lines.
const STRINGS: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
  <rect id="r" x="40" y="40" width="20" height="40" fill="#c30"/>
  <text x="45" y="60">Bödy$Shape default -2 2</text>
  <rect x="60" y="40" width="20" height="10" fill="#03c"/>
  <text x="65" y="45">Arm@Body</text>
  <text x="80" y="10">%a &amp; 😀</text>
  <text x="5" y="95"><tspan x="5" y="95">two</tspan><tspan x="5" y="99" sodipodi:role="line" xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd">lines</tspan></text>
</svg>"##;

fn asked(studio: &Studio, ask: &Value) -> Value {
    let request = json!({ "drawing": "a.svg", "ask": ask });
    serde_json::from_str(&studio.ask(&request.to_string())).unwrap()
}

#[test]
fn texts_are_listed_with_what_is_wrong_in_them() {
    let mut studio = Studio::default();
    studio.put("a.svg", STRINGS.into(), 0.0).unwrap();
    let texts = asked(&studio, &json!("texts"))["body"].take();
    let told: Vec<_> = texts
        .as_array()
        .unwrap()
        .iter()
        .map(|line| line["text"].as_str().unwrap())
        .collect();
    assert_eq!(told, ["Bödy$Shape default -2 2", "Arm@Body", "%a & 😀"]);
    assert_eq!(texts[0]["part"], "Bödy");
    let problem = &texts[1]["problems"][0];
    assert_eq!(
        (&problem["severity"], &problem["from"], &problem["to"]),
        (&json!("error"), &json!(4), &json!(8)),
        "{texts}"
    );

    let start = &texts[1]["start"];
    let place = asked(&studio, &json!({ "place": { "start": start, "at": 5 } }))["body"].take();
    assert!(
        place["hover"]["markdown"]
            .as_str()
            .unwrap()
            .contains("Body"),
        "{place}"
    );
    let title = place["actions"][0]["title"].as_str().unwrap().to_owned();
    let apply = json!({ "change": "apply", "start": start, "was": "Arm@Body", "at": place["byte"], "title": title });
    let made = change(&mut studio, &json!({ "make": apply }), 1);
    assert_eq!(made["ok"], true, "{made}");
    assert!(studio.text("a.svg").unwrap().contains(">Arm@Bödy<"));
    // Only what differs is written, and what XML reserves as an entity.
    let write = json!({ "change": "write", "start": texts[2]["start"], "was": "%a & 😀", "text": "%a & <😁", "typing": 1 });
    assert_eq!(
        change(&mut studio, &json!({ "make": write }), 2)["ok"],
        false,
        "the text before it has grown"
    );
    let moved = texts[2]["start"].as_u64().unwrap() + 1;
    let write = json!({ "change": "write", "start": moved, "was": "%a & 😀", "text": "%a & <😁", "typing": 1 });
    assert_eq!(
        change(&mut studio, &json!({ "make": write }), 2)["ok"],
        true
    );
    assert!(studio.text("a.svg").unwrap().contains(">%a &amp; &lt;😁<"));
    let gone = asked(&studio, &json!({ "place": { "start": 1, "at": 0 } }));
    assert_eq!(
        gone["body"]["why"],
        "this string is not in the drawing any more"
    );
}

#[test]
fn a_text_is_typed_with_mistakes_and_undone_at_once() {
    let mut studio = Studio::default();
    studio.put("a.svg", STRINGS.into(), 0.0).unwrap();
    let texts = asked(&studio, &json!("texts"))["body"].take();
    let write = |was: &str, text: &str, typing: u32| json!({ "make": { "change": "write", "start": texts[0]["start"], "was": was, "text": text, "typing": typing } });
    let first = "Bödy$Shape default -2 2";
    let typed = [
        (first, "Bödy$Shap"),
        ("Bödy$Shap", "Bödy$<&"),
        ("Bödy$<&", "Bödy$Shape round"),
    ];
    for (revision, (was, text)) in (1..).zip(typed) {
        let made = change(&mut studio, &write(was, text, 7), revision);
        assert_eq!(made["ok"], true, "{made}");
    }
    let typed = STRINGS.replace(first, "Bödy$Shape round");
    assert_eq!(studio.text("a.svg").as_deref(), Some(typed.as_str()));
    // Another stretch of typing is another step.
    change(
        &mut studio,
        &write("Bödy$Shape round", "Bödy$Shape roundv", 8),
        4,
    );
    change(&mut studio, &json!("undo"), 5);
    assert_eq!(studio.text("a.svg").as_deref(), Some(typed.as_str()));
    change(&mut studio, &json!("undo"), 6);
    assert_eq!(studio.text("a.svg").as_deref(), Some(STRINGS));
    change(&mut studio, &json!("redo"), 7);
    assert_eq!(studio.text("a.svg").as_deref(), Some(typed.as_str()));
    for (was, text, why) in [
        (first, "Body", "the drawing has changed since"),
        ("Bödy$Shape round", "  ", "a string is not empty"),
        ("Bödy$Shape round", "a\nb", "a string is one line"),
    ] {
        let refused = change(&mut studio, &write(was, text, 9), 8);
        assert!(
            refused["body"]["why"].as_str().unwrap().starts_with(why),
            "{refused}"
        );
    }
}

#[test]
fn proposals_are_for_the_text_as_it_is_typed() {
    let mut studio = Studio::default();
    studio.put("a.svg", STRINGS.into(), 0.0).unwrap();
    let start = asked(&studio, &json!("texts"))["body"][1]["start"].take();
    // Behind a sign that is escaped and one of two units.
    for (text, at, word, first) in [("Arm@B", 5, "B", "Bödy"), ("Ärm$Sha %𝔟", 7, "Sha", "Shape")]
    {
        let ask = json!({ "proposals": { "start": start, "at": at, "text": text } });
        let found = asked(&studio, &ask)["body"].take();
        assert_eq!(
            (&found["from"], &found["to"]),
            (&json!(at - word.len()), &json!(at)),
            "{found}"
        );
        let texts = found["options"].as_array().unwrap().iter();
        let texts: Vec<_> = texts
            .map(|option| option["text"].as_str().unwrap())
            .collect();
        assert!(
            texts.iter().any(|text| text.starts_with(first)),
            "{texts:?}"
        );
    }
}

/// What is on the page of a drawing.
fn paper(studio: &Studio, build: &Value) -> Value {
    let bytes = studio.bytes(build["paper"].as_str().unwrap()).unwrap();
    serde_json::from_slice(&bytes).unwrap()
}

#[test]
fn the_page_of_a_drawing_has_its_shapes_and_strings_where_they_are_drawn() {
    let mut studio = with_drawing("a.svg");
    let built = build(&mut studio);
    let page = paper(&studio, &built);
    assert_eq!(page["page"], json!([0.0, 0.0, 100.0, 100.0]));
    assert_eq!(page["picture"], DRAWING);
    let shapes = page["shapes"].as_array().unwrap();
    assert_eq!(shapes.len(), 1);
    assert_eq!(shapes[0][0], "Body");
    let area = shapes[0][1].as_str().unwrap();
    let numbers = area.split(|letter: char| !letter.is_ascii_digit() && letter != '.');
    let mut numbers: Vec<f64> = numbers.filter_map(|number| number.parse().ok()).collect();
    numbers.sort_by(f64::total_cmp);
    assert_eq!(numbers, [40.0, 40.0, 40.0, 40.0, 60.0, 60.0, 80.0, 80.0]);
    assert_eq!(page["strings"][0][0], "Body");
    let corner = &page["strings"][0][1];
    assert_eq!(corner[0], 45.0);
    assert!(
        corner[1].as_f64() < Some(60.0) && corner[3].as_f64() >= Some(60.0),
        "{corner}"
    );
}

#[test]
fn a_page_is_replaced_by_that_of_the_next_build_unless_that_cannot_be_read() {
    let mut studio = with_drawing("a.svg");
    let first = build(&mut studio);
    studio
        .put("a.svg", DRAWING.replace("Body", "Trunk").into(), 1.0)
        .unwrap();
    let second = build(&mut studio);
    assert_ne!(first["paper"], second["paper"]);
    assert!(studio.bytes(first["paper"].as_str().unwrap()).is_none());
    assert_eq!(paper(&studio, &second)["shapes"][0][0], "Trunk");
    studio.put("a.svg", DRAWING[..60].into(), 2.0).unwrap();
    let third = build(&mut studio);
    assert_eq!(third["paper"], second["paper"]);
}
