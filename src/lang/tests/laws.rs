//! Properties that hold for every string.

use proptest::prelude::*;

use super::*;
use crate::diagnostic::Code;
use crate::lang::keyword::Keyword;
use crate::law;
use crate::patience::finish;

/// Pieces of strings, to be combined in valid and invalid ways.
fn piece() -> impl Strategy<Value = String> {
    prop_oneof![
        prop::sample::select(vec![
            "%",
            "$",
            "@",
            "*",
            "#",
            "^",
            "\"",
            "(",
            ")",
            " ",
            "\n",
            "　",
            "＄",
            "＠",
            "％",
            "（",
            "）",
            "＂",
            "-",
            "+",
            "/",
            ",",
            "Rarm",
            "左腕",
            "Shape",
            "Colr",
            "roundv",
            "default",
            "Color",
            "red",
            "#ff0000",
            "#12",
            "Let",
            "w",
            "Scale",
            "Axes",
            "+x",
            "-y",
            "Motion",
            "walk",
            "-il",
            "kick.bvh",
            "Follow",
            "-cd",
            "1",
            "-90",
            "90",
            ".5",
            "1.0v",
            "1e999",
            "２",
            "min",
            "sqrt",
            "Ｃｏｌｏｒ",
            "cone",
            "Origin",
            "start",
            "5px",
            "0,5",
            "−5",
            "“a”",
            "Segments",
        ])
        .prop_map(str::to_owned),
        "\\PC{0,4}",
    ]
}

fn string() -> impl Strategy<Value = String> {
    let pieces = prop::collection::vec((piece(), prop::bool::ANY), 0..24);
    pieces.prop_map(|pieces| {
        let spaced = pieces
            .into_iter()
            .map(|(piece, space)| if space { piece + " " } else { piece });
        spaced.collect()
    })
}

fn containers() -> impl Strategy<Value = Container> {
    prop_oneof![Just(Container::Text), Just(Container::Desc)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn spans_are_on_character_boundaries(input in string(), container in containers()) {
        let reading = read(&Text::plain(&input, 0), container);
        let inside = |span: crate::source::Span| {
            span.start <= span.end && input.is_char_boundary(span.start) && input.is_char_boundary(span.end)
        };
        for diagnostic in &reading.diagnostics {
            prop_assert!(inside(diagnostic.span));
            for related in &diagnostic.related {
                prop_assert!(inside(related.span));
            }
            for edit in diagnostic.fixes.iter().flat_map(|fix| &fix.edits) {
                prop_assert!(inside(edit.span));
            }
            // A message is one sentence without a full stop.
            prop_assert!(!diagnostic.message.ends_with('.') || diagnostic.message.contains('…'));
        }
        for setting in &reading.settings {
            prop_assert!(input.get(setting.range.clone()).is_some());
        }
    }

    #[test]
    fn parsing_never_panics(input in "\\PC{0,40}") {
        let _ = crate::lang::looks_like_string(&input);
        let _ = read(&Text::plain(&input, 0), Container::Text);
    }
}

#[test]
fn ascii_needs_no_hint() {
    let wide = prop::sample::select(vec!["＄", "＠", "％", "（", "）", "＂", "２", "Ｃｏｌｏｒ"]);
    let strings = (string(), wide, string()).prop_map(|(a, wide, b)| format!("{a}{wide}{b}"));
    let inputs = (prop_oneof![1 => string(), 3 => strings], containers());
    law::check(law::config(1500), 50, inputs, |(input, container)| {
        let reading = read(&Text::plain(&input, 0), container);
        let hints: Vec<_> = reading
            .diagnostics
            .iter()
            .filter(|found| found.code == Code::FullWidth)
            .collect();
        prop_assert!(hints.len() <= 1);
        let Some(hint) = hints.first() else {
            return Ok(false);
        };
        let fixed = apply(&input, &hint.fixes[0]);
        let again = read(&Text::plain(&fixed, 0), container);
        prop_assert!(
            again
                .diagnostics
                .iter()
                .all(|found| found.code != Code::FullWidth),
            "{fixed}"
        );
        let values = |reading: &Reading| -> Vec<_> {
            let settings = reading.settings.iter();
            settings.map(|setting| setting.value.clone()).collect()
        };
        prop_assert_eq!(values(&reading), values(&again));
        Ok(true)
    });
}

/// A string with what the table shows of some keywords, and sometimes a piece of something else in it.
fn with_settings() -> impl Strategy<Value = String> {
    let example = |keyword: &Keyword| {
        let example = keyword.row().example;
        let start = example.find(['$', '%']).map_or(0, |at| at + 1);
        example[start..].to_owned()
    };
    let examples = prop::sample::select(Keyword::ALL.iter().map(example).collect::<Vec<_>>());
    let examples = prop::collection::vec(examples, 1..4);
    let sign = prop::sample::select(vec!["A$", "A@B$", "$", "%"]);
    let piece = prop::option::weighted(0.3, (any::<prop::sample::Index>(), piece()));
    (sign, examples, piece).prop_map(|(sign, examples, piece)| {
        let mut string = format!("{sign}{}", examples.join(" "));
        if let Some((place, piece)) = piece {
            let places: Vec<usize> = string.char_indices().map(|(at, _)| at).collect();
            string.insert_str(*place.get(&places), &piece);
        }
        string
    })
}

#[test]
fn the_text_of_a_setting_parses_to_the_same_value() {
    law::check(law::config(1500), 80, with_settings(), |input| {
        let reading = read(&Text::plain(&input, 0), Container::Text);
        let sign = match reading.annotation {
            Annotation::Defaults(_) => "%",
            Annotation::Legend(_) => "$",
            _ => "A$",
        };
        for setting in &reading.settings {
            let printed = format!("{sign}{} {}", setting.keyword.name(), setting.text);
            let again = read(&Text::plain(&printed, 0), Container::Text);
            prop_assert_eq!(again.settings.len(), 1, "{}", printed);
            prop_assert_eq!(&again.settings[0].value, &setting.value);
            prop_assert_eq!(&again.settings[0].text, &setting.text);
        }
        Ok(!reading.settings.is_empty())
    });
}

/// Long strings of one repeated piece, on which nested loops would not end and recursion would overflow the stack.
#[test]
fn long_strings_are_read() {
    const LENGTH: usize = 400_000;
    let units = [
        "(",
        ")",
        "\"",
        "((",
        "-",
        "1+",
        "Color (",
        "$",
        "@",
        "a ",
        "Let a ",
        "Shape \"",
        "Colr 1 ",
        "＄",
        "（",
        "＂",
        "1 ",
        "#",
        "x",
        "min(",
        "Color 1,2 ",
        "Shape default 0 20 w ",
    ];
    finish("the reading of long strings", move || {
        for unit in units {
            for head in ["%", "A$Color ", ""] {
                let input = format!("{head}{}", unit.repeat(LENGTH / unit.len()));
                let reading = read(&Text::plain(&input, 0), Container::Text);
                let ends = reading.settings.iter().map(|setting| setting.range.end);
                assert!(ends.max() <= Some(input.len()), "{head}{unit}…");
            }
        }
    });
}

#[test]
fn long_chains_of_variables_are_evaluated() {
    let mut input = String::from("%Let v0 1");
    for index in 1..20_000 {
        input.push_str(&format!(" Let v{} (v{} + 1)", index, index - 1));
    }
    // The last variable depends on all others.
    let text = Text::plain(&input, 0);
    let (annotation, mut diagnostics) = parse(&text, Container::Text);
    let variables = Variables::collect([(&text, &annotation)], &mut diagnostics);
    assert_eq!(diagnostics, []);
    assert_eq!(variables.get("v19999"), Some(20_000.));
}
