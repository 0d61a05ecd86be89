//! What changes write, character by character.

use super::super::fixtures::{analysis, figure};
use super::*;
use crate::diagnostic::applied;

mod clips;
mod drawn;
mod poses;

fn set(part: &str, attribute: Keyword, value: &str, place: Place) -> Change {
    Change::Set {
        part: part.to_owned(),
        attribute,
        value: value.to_owned(),
        place,
    }
}

fn asked(part: &str, attribute: Keyword, value: &str) -> Change {
    set(part, attribute, value, Place::Ask)
}

/// The text after a change, which must do what it says and nothing else.
fn made(source: &str, change: &Change) -> Result<String, Refusal> {
    let (before, _) = analysis(source);
    let edits = edits(&before, change)?;
    let text = applied(before.source(), &edits);
    let (after, _) = analysis(&text);
    check(&before, &after, change)?;
    Ok(text)
}

/// The right arm's string after a change of it.
#[track_caller]
fn arm(string: &str, change: &Change) -> String {
    let strings = |arm| figure(["Body$Shape round", arm, "Larm@Body", "", "%Let w 4"]);
    let text = made(&strings(string), change).unwrap();
    let (before, after) = ("font-size=\"5\">", "</text>");
    let place = strings("¦").find('¦').unwrap();
    assert!(text[..place].ends_with(before));
    let end = text[place..].find(after).unwrap();
    text[place..place + end].to_owned()
}

#[test]
fn attributes_keep_their_places_and_new_ones_go_to_the_end() {
    for (before, keyword, value, after) in [
        ("Rarm@Body", Keyword::Offset, "3.5", "Rarm@Body$Offset 3.5"),
        ("Rarm@Body$", Keyword::Offset, "3.5", "Rarm@Body$Offset 3.5"),
        (
            "Rarm@Body$Offset  2  Smooth 9",
            Keyword::Offset,
            "3",
            "Rarm@Body$Offset  3  Smooth 9",
        ),
        (
            "Rarm@Body $ smooth 9",
            Keyword::Offset,
            "3",
            "Rarm@Body $ smooth 9 Offset 3",
        ),
        (
            "Rarm@Body$Shape -c cone 0 7 0.5 Offset 1",
            Keyword::Shape,
            "-c cone 0 7 0.25",
            "Rarm@Body$Shape -c cone 0 7 0.25 Offset 1",
        ),
        (
            "Rarm@Body$Shape roundv -90 90 Offset 1",
            Keyword::Shape,
            "-cd flat",
            "Rarm@Body$Shape -cd flat Offset 1",
        ),
        (
            "Rarm@Body$Shape -c round",
            Keyword::Shape,
            "round -60 60",
            "Rarm@Body$Shape round -60 60",
        ),
        (
            "Rarm@Body$Color red Offset 1",
            Keyword::Color,
            "#00ff00",
            "Rarm@Body$Color #00ff00 Offset 1",
        ),
        // What is not changed stays calculated.
        (
            "Rarm@Body$Shape cone 0 (w * 2) 0.5",
            Keyword::Shape,
            "cone 0 8 0.75",
            "Rarm@Body$Shape cone 0 (w * 2) 0.75",
        ),
    ] {
        assert_eq!(arm(before, &asked("Rarm", keyword, value)), after);
    }
}

#[test]
fn attributes_are_taken_away_with_their_sign() {
    let reset = Change::Reset {
        part: "Rarm".to_owned(),
        attribute: Keyword::Offset,
        place: Place::Ask,
    };
    for (before, after) in [
        ("Rarm@Body$Offset 3", "Rarm@Body"),
        ("Rarm@Body$Offset 3 Smooth 9", "Rarm@Body$Smooth 9"),
        ("Rarm@Body$Smooth 9 Offset 3", "Rarm@Body$Smooth 9"),
        ("Rarm@Body$Smooth 9", "Rarm@Body$Smooth 9"),
    ] {
        assert_eq!(arm(before, &reset), after);
    }
}

#[test]
fn strings_are_written_for_their_place() {
    let strings = |arm| figure(["Body$Shape round", arm, "", "*", ""]);
    for (before, change, after) in [
        (
            "<tspan>Rarm@Body</tspan><tspan>$Offset 3</tspan>",
            asked("Rarm", Keyword::Smooth, "9"),
            "<tspan>Rarm@Body</tspan><tspan>$Offset 3 Smooth 9</tspan>",
        ),
        (
            "<tspan>Rarm@Body</tspan><tspan></tspan>",
            asked("Rarm", Keyword::Offset, "9"),
            "<tspan>Rarm@Body$Offset 9</tspan><tspan></tspan>",
        ),
        (
            "Rarm@Body$Offset&#x20;3",
            asked("Rarm", Keyword::Offset, "4"),
            "Rarm@Body$Offset&#x20;4",
        ),
        (
            "Rarm@Body",
            Change::Name {
                part: "Rarm".to_owned(),
                name: "a&b".to_owned(),
            },
            "a&amp;b@Body",
        ),
        (
            "Rarm",
            Change::Hang {
                part: "Rarm".to_owned(),
                parent: Some("Body".to_owned()),
            },
            "Rarm@Body",
        ),
        (
            "Rarm@Body",
            Change::Hang {
                part: "Rarm".to_owned(),
                parent: None,
            },
            "Rarm@Root",
        ),
        (
            "Rarm@Body$Offset 3",
            Change::LeaveOut {
                part: "Rarm".to_owned(),
            },
            "*Rarm@Body$Offset 3",
        ),
    ] {
        for ends in ["\n", "\r\n"] {
            let [before, after] = [before, after].map(|arm| strings(arm).replace('\n', ends));
            assert_eq!(made(&before, &change).as_deref(), Ok(&*after), "{change:?}");
        }
    }
}

#[test]
fn calculations_are_not_replaced_without_a_word() {
    let source = figure([
        "Body$Shape default 0 (w * 1.5)",
        "Rarm@Body$Offset w",
        "",
        "",
        "%Let w 4",
    ]);
    let refusal = made(&source, &asked("Body", Keyword::Shape, "default 0 9")).unwrap_err();
    assert_eq!(
        refusal.why,
        "`(w * 1.5)` is calculated, and would be replaced"
    );
    let titles: Vec<&str> = refusal
        .choices
        .iter()
        .map(|choice| &*choice.title)
        .collect();
    assert_eq!(
        titles,
        ["Change `w` to 6, which is used 2 times", "Replace it here"]
    );
    let variable = made(&source, &refusal.choices[0].change).unwrap();
    assert_eq!(variable, source.replace("%Let w 4", "%Let w 6"));
    let here = made(&source, &refusal.choices[1].change).unwrap();
    assert_eq!(here, source.replace("(w * 1.5)", "9"));
}

#[test]
fn what_a_legend_says_is_changed_for_all_or_for_one() {
    let strings = [
        "Body",
        "Rarm@Body",
        "Larm@Body",
        "$Offset 4 Shape round",
        "",
    ];
    let source = figure(strings);
    let refusal = made(&source, &asked("Rarm", Keyword::Offset, "3")).unwrap_err();
    assert!(
        refusal.why.contains("which 2 parts share"),
        "{}",
        refusal.why
    );
    let all = made(&source, &refusal.choices[0].change).unwrap();
    assert_eq!(all, source.replace("$Offset 4", "$Offset 3"));
    let one = made(&source, &refusal.choices[1].change).unwrap();
    assert_eq!(one, source.replace(">Rarm@Body<", ">Rarm@Body$Offset 3<"));
    // What the legend says anyway is not said again.
    let same = made(&one, &asked("Rarm", Keyword::Offset, "4")).unwrap();
    assert_eq!(same, source);
}

#[test]
fn the_first_shape_of_a_drawing_is_asked_about() {
    let source = figure(["Body", "Rarm@Body", "", "", ""]);
    let refusal = made(&source, &asked("Rarm", Keyword::Shape, "roundv")).unwrap_err();
    let text = made(&source, &refusal.choices[0].change).unwrap();
    assert!(text.contains(">Rarm@Body$Shape roundv<"));
}

#[test]
fn parts_without_a_string_get_a_description() {
    let source = figure(["Body$Shape round", "Rarm@Body", "", "", ""]);
    let text = made(&source, &asked("left", Keyword::Offset, "3")).unwrap();
    let tag = "height=\"10\" fill=\"#ffcc99\"";
    let place = source.rfind(&format!("{tag}/>")).unwrap() + tag.len();
    let expected = format!(
        "{}><desc>@Body$Offset 3</desc></rect>{}",
        &source[..place],
        &source[place + 2..]
    );
    assert_eq!(text, expected);
}

#[test]
fn shapes_without_a_name_are_named_by_a_label() {
    let source =
        figure(["Body$Shape round", "Rarm@Body", "", "", ""]).replace("\"left\"", "\"path2\"");
    let name = |name: &str| Change::Name {
        part: "U-1".to_owned(),
        name: name.to_owned(),
    };
    let text = made(&source, &name("wing <1>")).unwrap();
    assert_eq!(
        text,
        source.replace(
            "<rect id=\"path2\"",
            "<rect data-name=\"wing &lt;1&gt;\" id=\"path2\""
        )
    );
}

#[test]
fn what_would_be_wrong_is_refused() {
    let source = figure(["Body$Shape round", "Rarm@Body", "Hand@Rarm", "", ""]);
    for (change, why) in [
        (asked("Leg", Keyword::Offset, "3"), "there is no part `Leg`"),
        (
            asked("Rarm", Keyword::Offset, "3 Smooth 4"),
            "`3 Smooth 4` is more than one value of `Offset`",
        ),
        (
            asked("Rarm", Keyword::Offset, "(q)"),
            "there is no variable called `q`",
        ),
        (asked("Rarm", Keyword::Alpha, "2"), "`Alpha` cannot be 2"),
        (
            asked("Rarm", Keyword::View, "0 0"),
            "more than an attribute",
        ),
        (asked("Rarm", Keyword::Offset, "3\n"), "no line ends"),
        (
            Change::Name {
                part: "Rarm".to_owned(),
                name: "Body".to_owned(),
            },
            "there is a part named `Body` already",
        ),
        (
            Change::Hang {
                part: "Body".to_owned(),
                parent: Some("Hand".to_owned()),
            },
            "`Hand` hangs on `Body`",
        ),
        (
            Change::LeaveOut {
                part: "Rarm".to_owned(),
            },
            "hang on `Rarm`",
        ),
    ] {
        let refusal = made(&source, &change).unwrap_err();
        assert!(refusal.why.contains(why), "{}", refusal.why);
    }
}

#[test]
fn changes_are_undone_beside_what_was_saved_since() {
    let before = figure(["Body$Shape round", "Rarm@Body", "", "", ""]);
    let change = asked("Rarm", Keyword::Offset, "3");
    let (analysis, _) = analysis(&before);
    let found = edits(&analysis, &change).unwrap();
    let step = Step::new(change, &before, &found);
    let saved = |text: &str| {
        let text = text.replace(
            "viewBox=\"0 0 200 100\"",
            "viewBox=\"0 0 300 200\" width=\"3\"",
        );
        text.replace(
            "<rect id=\"swatch\"",
            "<circle r=\"1\"/><rect id=\"swatch\"",
        )
    };
    let mut now = saved(step.after());
    let mut history = History::default();
    history.add(step);
    let undone = history.last().unwrap().undone(&now).unwrap();
    let text = applied(&now, &undone);
    assert_eq!(text, saved(&before));
    history.undo(&now, &undone);
    now = text;
    let redone = history.next().unwrap().undone(&now).unwrap();
    let text = applied(&now, &redone);
    history.redo(&now, &redone);
    assert!(text.contains("Rarm@Body$Offset 3"));
    // The string itself was changed elsewhere: it stays.
    let other = text.replace("Offset 3", "Offset 30");
    assert_eq!(history.last().unwrap().undone(&other), None);
    assert!(history.next().is_none());
}

#[test]
fn the_form_says_where_a_part_is_in_the_model() {
    let drawing = figure(["Body", "Rarm@Body$Bend 0", "", "", "%Scale 2 Axes +x +z -y"]);
    let (analysis, _) = analysis(&drawing);
    let place = analysis.form("Rarm").unwrap().place.unwrap();
    assert_eq!(place.meters, 0.02);
    let at = |word| {
        place
            .points
            .iter()
            .find(|point| point.word == word)
            .unwrap()
            .at
    };
    assert_eq!(
        [at("start"), at("center"), at("end")],
        [[80.0, 45.0], [50.0, 45.0], [20.0, 45.0]]
    );
    assert_eq!(place.joint, at("start"));
    // The arm's node points to the left of the drawing, along its own y.
    let near =
        |way: [f64; 3], other: [f64; 3]| way.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(near(place.right, [0.0, -1.0, 0.0]), "{place:?}");
    assert!(near(place.up, [1.0, 0.0, 0.0]), "{place:?}");
    assert!(near(place.front, [0.0, 0.0, 1.0]), "{place:?}");
}
