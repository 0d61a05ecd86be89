//! The syntax tree and values of strings.

use super::*;
use crate::lang::value::{KindArguments, Origin, Shape, Value};
use crate::lang::{annotates, looks_like_string};
use crate::source::{Form, Span};

fn head(input: &str, container: Container) -> String {
    let name = |name: Option<crate::lang::ast::Name>| name.map_or("-".to_owned(), |name| name.text);
    match read(&Text::plain(input, 0), container).annotation {
        Annotation::Empty => "empty".to_owned(),
        Annotation::Comment => "comment".to_owned(),
        Annotation::Unused => "unused".to_owned(),
        Annotation::Caption => "caption".to_owned(),
        Annotation::Feature(feature) => format!("feature {}", feature.text),
        Annotation::Defaults(attributes) => format!("defaults {}", attributes.len()),
        Annotation::Legend(attributes) => format!("legend {}", attributes.len()),
        Annotation::Part(part) => format!(
            "part {} of {}, {}",
            name(part.name),
            name(part.parent),
            part.attributes.len()
        ),
    }
}

#[test]
fn kinds_of_string() {
    for (input, found) in [
        (" \n　", "empty"),
        ("# a", "comment"),
        ("＃ a", "comment"),
        (" * Unuse this", "unused"),
        ("^ nose", "feature nose"),
        ("%Scale 2\nGround page", "defaults 2"),
        ("$Color red", "legend 1"),
        ("Head", "part Head of -, 0"),
        ("右腕＠胴", "part 右腕 of 胴, 0"),
        (
            "\"Left\n arm\"@\"Upper body\"$Offset 2",
            "part Left arm of Upper body, 1",
        ),
        ("U-1@Tyre.back", "part U-1 of Tyre.back, 0"),
        ("Arm @ Body $ Offset 2 Color red", "part Arm of Body, 2"),
        ("Left arm@Body", "part Left arm of Body, 0"),
        ("two words", "caption"),
        ("$", "legend 0"),
        ("Ｈｅａｄ", "part Head of -, 0"),
    ] {
        assert_eq!(head(input, Container::Text), found, "{input}");
    }
    for (input, found) in [
        ("$Color red", "part - of -, 1"),
        ("@Body$Color red", "part - of Body, 1"),
        ("Arm@Body", "part Arm of Body, 0"),
        ("%Scale 2", "defaults 1"),
    ] {
        assert_eq!(head(input, Container::Desc), found, "{input}");
        let reading = read(&Text::plain(input, 0), Container::Desc);
        assert_eq!(reading.diagnostics, [], "{input}");
    }
}

#[test]
fn strings_are_distinguished_from_other_texts() {
    for text in [
        "%",
        " $Color",
        "*Unuse",
        "@Body",
        "＄",
        "Arm@",
        "Arm$",
        "\"Left arm\"@Body",
        "Ａ＠Ｂ",
        "\n  %Scale 2",
        "Arm $Shape round",
        "Left arm$Shape round",
        "Arm　＄Ｓｈａｐｅ　ｒｏｕｎｄ",
        "\"Left arm\" $ Color red",
        "Arm @ Body",
        "Arm @Body $Shape round",
    ] {
        assert!(looks_like_string(text), "{text}");
    }
    for text in [
        "",
        "Arm",
        "two words",
        "# note",
        "^nose",
        "to me@home",
        "\"quoted\"",
        "5 $",
        "costs $5",
        "see you @ 5 pm",
        "write @ anne and bob",
        "(a)@b",
    ] {
        assert!(!looks_like_string(text), "{text}");
    }
}

#[test]
fn signs_alone_do_not_annotate() {
    for text in [
        "%Scale 2",
        "% Strokes all",
        "%Scael 2",
        "%Mtoion",
        "$Color red",
        "$Colr red",
        "%%Scale 2",
        "%$Scale 2",
        "Arm$",
        "Arm@Body",
        "@Body$Shape round",
        "*$Shape round",
        "＄Ｃｏｌｏｒ red",
    ] {
        assert!(annotates(text), "{text}");
    }
    for text in [
        "*",
        "**",
        "#",
        "%",
        "$",
        "@",
        "5",
        "*5",
        "* required",
        "$5.99",
        "$ 20",
        "%50",
        "100%",
        "@5 pm",
        "@anna",
        "%name%",
        "$NAME$",
        "${total}",
        "%s",
        "%d items",
        "$Band",
        "%Shaep",
        "$title",
        "$-3",
        "*Unuse",
        "@",
        "%,5",
        "$!",
        "%(a)",
    ] {
        assert!(!annotates(text), "{text}");
    }
    for text in ["$5.99", "% 20", "@ 5 pm", "$-3"] {
        let reading = read(&Text::plain(text, 0), Container::Text);
        assert_eq!(reading.annotation, Annotation::Caption, "{text}");
        assert_eq!(reading.diagnostics, [], "{text}");
    }
}

#[test]
fn values_are_computed() {
    let input = "%Let w 4 Offset (w * (2 + 1) / 2 - -1) Shape -cs round Origin 1 w Color #f008";
    let reading = read(&Text::plain(input, 0), Container::Text);
    assert_eq!(reading.diagnostics, []);
    let values: Vec<_> = reading
        .settings
        .iter()
        .map(|setting| (&setting.value, setting.text.as_str()))
        .collect();
    let round = Shape {
        kind: "round",
        arguments: KindArguments::Numbers(vec![-90., 90.]),
        has_depths: false,
        mirrored: true,
        doubled: false,
        centered: true,
    };
    let red = Value::Color {
        rgb: [1., 0., 0.],
        alpha: Some(f64::from(0x88) / 255.),
    };
    assert_eq!(
        values,
        [
            (&Value::Let("w".to_owned(), 4.), "w 4"),
            (&Value::Number(7.), "7"),
            (&Value::Shape(round), "-cs round"),
            (&Value::Origin(Origin::Point([1., 4.])), "1 4"),
            (&red, "#f008"),
        ]
    );
}

#[test]
fn valid_attributes_count_beside_invalid_ones() {
    for (input, expected) in [
        (
            "Arm$Shape rond Offset 3 Colr red Alpha .5",
            vec!["Offset", "Alpha"],
        ),
        ("Arm$Color red Color 2 2 2", vec!["Color"]),
        (
            "Rarm@Ubody$Shape round$Shape default 0 20 Color 0.0 0.0 1.0v -90 90",
            vec!["Shape"],
        ),
        ("Arm$Texture \"a.png Offset 3", vec!["Offset"]),
        ("Arm$Offset (1 Alpha .5", vec!["Alpha"]),
        ("Arm$Shape default 0 20 Colr 1 0 0", vec!["Shape"]),
    ] {
        let reading = read(&Text::plain(input, 0), Container::Text);
        let found: Vec<_> = reading
            .settings
            .iter()
            .map(|setting| setting.keyword.name())
            .collect();
        assert_eq!(found, expected, "{input}");
    }
}

#[test]
fn spans_and_fixes_cross_entities_and_elements() {
    // `Arm$Co` `lr` in a second element, `red`, all behind an entity for `$`.
    let mut text = Text::default();
    text.push("Arm", Span::new(10, 13), Form::Plain);
    text.push("$", Span::new(13, 18), Form::Unit);
    text.push("Colr red Offset wx", Span::new(18, 36), Form::Plain);
    let reading = read(&text, Container::Text);
    assert_eq!(reading.diagnostics[0].span, Span::new(18, 22));
    assert_eq!(reading.diagnostics[0].fixes.len(), 1);

    let mut torn = Text::default();
    torn.push("Arm$Co", Span::new(10, 16), Form::Plain);
    torn.push("lr red", Span::new(40, 46), Form::Plain);
    let reading = read(&torn, Container::Text);
    assert_eq!(reading.diagnostics[0].span, Span::new(14, 42));
    assert_eq!(
        reading.diagnostics[0].fixes,
        [],
        "a fix would delete the tags in between"
    );
}
