//! Laws that hold for every drawing, and malicious drawings.

mod common;

use std::cell::RefCell;
use std::collections::BTreeSet;

use base64::Engine;
use common::law::{self, check};
use common::patience::finish;
use okoshi::compile::Compiled;
use okoshi::diagnostic::{Code, Severity};
use okoshi::internals::lang::keyword::Keyword;
use okoshi::resolver::MemoryResolver;
use proptest::prelude::*;

fn compile(text: &str) -> Compiled {
    common::compiled(text, &MemoryResolver::default())
}

/// Compiles, writes and reads back.
fn laws(text: &str) -> Result<Compiled, String> {
    let compiled = compile(text);
    for diagnostic in &compiled.diagnostics {
        let (start, end) = (diagnostic.span.start, diagnostic.span.end);
        if text.get(start..end).is_none() {
            return Err(format!(
                "{start}..{end} is no place of the text: {diagnostic:?}"
            ));
        }
        for fix in &diagnostic.fixes {
            for edit in &fix.edits {
                if text.get(edit.span.start..edit.span.end).is_none() {
                    return Err(format!("{edit:?} is no edit of the text"));
                }
            }
        }
    }
    let nodes = common::nodes(&common::glb(&compiled))?;
    common::check_laws(&nodes)?;
    if !compiled.has_errors()
        && let Some(name) = common::repeated_name(&nodes)
    {
        return Err(format!("two nodes are named `{name}`"));
    }
    Ok(compiled)
}

fn svg(body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         width=\"200\" height=\"200\">{body}</svg>"
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

// ---- generated drawings

/// Words of strings, valid and invalid, all keywords among them.
fn word() -> impl Strategy<Value = String> {
    let words = [
        "A",
        "B",
        "C",
        "A.back",
        "U-1",
        "@",
        "$",
        "%",
        "*",
        "#",
        "^",
        "@A",
        "@B",
        "$Shape",
        "roundv",
        "roundh",
        "round",
        "cone",
        "conev",
        "coneh",
        "default",
        "flat",
        "none",
        "inflate",
        "lathe",
        "-s",
        "-d",
        "-c",
        "-sd",
        "start",
        "end",
        "center",
        "4",
        "0",
        "-90",
        "90",
        "5",
        "-5",
        "0.5",
        "1e3",
        "1e30",
        "1e-30",
        "red",
        "#abc",
        "x",
        "(x + 1)",
        "(1 / 0)",
        "(",
        ")",
        "\"",
        "\"a b\"",
        "+x",
        "+y",
        "-z",
        "page",
        "outline",
        "all",
        "lines",
        "\n",
        "＄",
        "＠",
        "Ｓｈａｐｅ",
        "腕",
    ];
    let keywords = Keyword::ALL.iter().map(|keyword| keyword.name());
    let words: Vec<&str> = words.into_iter().chain(keywords).collect();
    prop_oneof![
        8 => prop::sample::select(words).prop_map(str::to_owned),
        1 => any::<char>().prop_map(|c| c.to_string()),
    ]
}

/// A string, usually of a part.
fn string() -> impl Strategy<Value = String> {
    let names = || {
        prop::sample::select(vec![
            "A", "B", "C", "D", "E", "F", "G", "H", "U-1", "A.back", "\"a b\"",
        ])
    };
    let kinds = prop::sample::select(vec![
        "default",
        "default 0 5",
        "default 3 -3",
        "roundv",
        "roundv 0 90",
        "roundh",
        "roundh -20 70",
        "round",
        "round -90 90 4",
        "cone",
        "cone 0 20 0.5",
        "cone 5 -9 2",
        "conev",
        "conev 0 5 0.2",
        "coneh",
        "flat",
        "none",
        "-s default 2 4",
        "-d default 2 4",
        "-d roundv",
        "-cd round",
        "-s cone",
        "inflate",
        "inflate 4",
        "-s inflate 3",
        "-d lathe 180",
        "lathe",
        "lathe 90",
    ]);
    let more = prop::sample::select(vec![
        "",
        " Offset 7",
        " Origin start",
        " Origin 3 4",
        " Axis 33",
        " Segments 3",
        " Segments 4 Smooth 0",
        " Color red",
        " Alpha 0.4",
        " Metallic 1",
    ]);
    // What the table shows of each keyword, for a part of the drawing.
    let example = |keyword: &Keyword| {
        keyword
            .row()
            .example
            .trim_start_matches(|c| c != '$' && c != '%')
    };
    let examples = prop::sample::select(Keyword::ALL.iter().map(example).collect::<Vec<_>>());
    prop_oneof![
        6 => (names(), prop::option::weighted(0.3, names()), kinds, more).prop_map(|(name, parent, kind, more)| {
            let parent = parent.map_or(String::new(), |parent| format!("@{parent}"));
            format!("{name}{parent}$Shape {kind}{more}")
        }),
        1 => Just("* unused".to_owned()),
        1 => Just("$Shape roundv Color blue".to_owned()),
        1 => Just("% Strokes all Segments 5".to_owned()),
        1 => (names(), examples).prop_map(|(name, example)| if example.starts_with('%') { example.to_owned() } else { format!("{name}{example}") }),
        1 => prop::collection::vec(word(), 0..12).prop_map(|words| words.join(" ")),
    ]
}

/// Path data on a coarse grid, so that lines cross, touch and lie on each other.
fn path() -> impl Strategy<Value = String> {
    let point = || (0..9_i32, 0..9_i32).prop_map(|(x, y)| format!("{} {}", x * 20, y * 20));
    let segment = prop_oneof![
        4 => point().prop_map(|p| format!("L {p}")),
        1 => (point(), point()).prop_map(|(a, p)| format!("Q {a} {p}")),
        1 => (point(), point(), point()).prop_map(|(a, b, p)| format!("C {a} {b} {p}")),
        1 => point().prop_map(|p| format!("A 30 20 10 1 0 {p}")),
        1 => Just("Z".to_owned()),
        1 => point().prop_map(|p| format!("M {p}")),
    ];
    (point(), prop::collection::vec(segment, 1..12))
        .prop_map(|(start, segments)| format!("M {start} {}", segments.join(" ")))
}

fn paint() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "fill=\"#cc0000\"",
        "fill=\"#00cc00\"",
        "fill=\"#cc0000\" fill-rule=\"evenodd\"",
        "fill=\"none\" stroke=\"#000000\" stroke-width=\"6\"",
        "fill=\"#0000cc\" stroke=\"#000000\" stroke-width=\"3\" stroke-dasharray=\"7 3\"",
        "fill=\"none\" stroke=\"#000000\" stroke-width=\"9\" stroke-linejoin=\"round\" stroke-linecap=\"round\"",
        "fill=\"#cc0000\" opacity=\"0.5\"",
    ])
}

fn transform() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "",
        " transform=\"rotate(30 100 100)\"",
        " transform=\"scale(-1 1) translate(-200 0)\"",
        " transform=\"matrix(1 0.3 0 1 0 0)\"",
        " transform=\"scale(0.001)\"",
        " transform=\"scale(1 0)\"",
        " display=\"none\"",
        " clip-path=\"url(#clip)\"",
    ])
}

fn shape() -> impl Strategy<Value = String> {
    let desc = prop::option::weighted(0.2, string());
    let element = prop_oneof![
        3 => path().prop_map(|data| format!("path d=\"{data}\"")),
        2 => (0..9_i32, 0..9_i32, 0..6_i32, 0..6_i32).prop_map(|(x, y, w, h)| {
            format!("rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"", x * 20, y * 20, w * 15, h * 15)
        }),
        1 => (0..9_i32, 0..9_i32, 1..5_i32).prop_map(|(x, y, r)| {
            format!("circle cx=\"{}\" cy=\"{}\" r=\"{}\"", x * 20, y * 20, r * 9)
        }),
        1 => Just("use href=\"#group\" x=\"15\"".to_owned()),
    ];
    (element, paint(), transform(), desc).prop_map(|(element, paint, transform, desc)| {
        let name = element.split(' ').next().unwrap_or_default().to_owned();
        let desc = desc.map_or(String::new(), |desc| {
            format!("<desc>{}</desc>", escaped(&desc))
        });
        format!("<{element} {paint}{transform}>{desc}</{name}>")
    })
}

fn drawing() -> impl Strategy<Value = String> {
    let text = (0..9_i32, 0..9_i32, string()).prop_map(|(x, y, string)| {
        format!(
            "<text x=\"{}\" y=\"{}\" font-size=\"8\">{}</text>",
            x * 20,
            y * 20,
            escaped(&string)
        )
    });
    let leaf = prop_oneof![3 => shape(), 2 => text].boxed();
    let content = leaf.prop_recursive(3, 24, 6, |inner| {
        (
            prop::sample::select(vec![
                "g",
                "g",
                "g",
                "a",
                "g inkscape:groupmode=\"layer\"",
                "g id=\"group\"",
                "svg",
            ]),
            transform(),
            prop::collection::vec(inner, 0..6),
        )
            .prop_map(|(tag, transform, inner)| {
                let name = tag.split(' ').next().unwrap_or_default();
                format!("<{tag}{transform}>{}</{name}>", inner.concat())
            })
    });
    prop::collection::vec(content, 1..8).prop_map(|content| {
        let clip =
            "<defs><clipPath id=\"clip\"><circle cx=\"90\" cy=\"90\" r=\"70\"/></clipPath></defs>";
        svg(&format!("{clip}{}", content.concat()))
    })
}

#[test]
fn every_drawing_becomes_closed_solids() {
    // Only without errors, which 24 % are, must the names of nodes differ.
    check(law::config(256), 15, drawing(), |text| {
        let compiled = laws(&text).map_err(TestCaseError::fail)?;
        // Deterministic.
        prop_assert_eq!(common::glb(&compiled), common::glb(&compile(&text)));
        Ok(!compiled.has_errors())
    });
}

#[test]
fn every_string_compiles() {
    let seen = RefCell::new(BTreeSet::<&Keyword>::new());
    let inputs = (prop::collection::vec(word(), 0..24), any::<bool>());
    // 80 % are without errors.
    check(law::config(256), 50, inputs, |(words, desc)| {
        let of_table = Keyword::ALL
            .iter()
            .filter(|keyword| words.iter().any(|word| word == keyword.name()));
        seen.borrow_mut().extend(of_table);
        let string = escaped(&words.join(" "));
        let text = if desc {
            format!("<rect width=\"30\" height=\"50\"><desc>{string}</desc></rect>")
        } else {
            format!("<rect width=\"30\" height=\"50\"/><text x=\"9\" y=\"9\">{string}</text>")
        };
        let compiled = laws(&svg(&format!(
            "{text}<rect x=\"60\" width=\"9\" height=\"20\"/>"
        )));
        Ok(!compiled.map_err(TestCaseError::fail)?.has_errors())
    });
    assert_eq!(seen.into_inner().len(), Keyword::ALL.len(), "keywords");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn truncated_files_are_errors(at in 1_usize..7000) {
        let text = include_str!("cases/inkscape-human-gui/drawing.svg");
        let cut = text.char_indices().map(|(index, _)| index).take_while(|index| *index <= at).last().unwrap_or(0);
        let compiled = laws(&text[..cut]).map_err(TestCaseError::fail)?;
        prop_assert!(compiled.has_errors());
    }

    #[test]
    fn damaged_files_compile(at in 0_usize..8000, with in any::<char>()) {
        let text = include_str!("cases/inkscape-human-features-inkex/drawing.svg");
        let at = text.char_indices().map(|(index, _)| index).take_while(|index| *index <= at).last().unwrap_or(0);
        let next = text[at..].chars().next().map_or(0, char::len_utf8);
        let damaged = format!("{}{with}{}", &text[..at], &text[at + next..]);
        laws(&damaged).map_err(TestCaseError::fail)?;
    }
}

// ---- malicious drawings

/// Compiles a drawing, which must end.
#[track_caller]
fn survived(text: &str) -> Compiled {
    let text = text.to_owned();
    let compiled = finish("a drawing to be compiled", move || laws(&text));
    compiled.expect("the laws hold")
}

#[track_caller]
fn refused(text: &str, code: Code) {
    let compiled = survived(text);
    let told: Vec<_> = compiled
        .diagnostics
        .iter()
        .map(|diagnostic| diagnostic.code)
        .collect();
    assert!(told.contains(&code), "{:?}", &told[..told.len().min(5)]);
}

#[test]
fn deep_nesting_is_refused() {
    let deep = |count: usize| {
        svg(&format!(
            "{}<rect width=\"9\" height=\"9\"/>{}",
            "<g>".repeat(count),
            "</g>".repeat(count)
        ))
    };
    refused(&deep(100_000), Code::LimitPassed);
    refused(&svg(&"<g>".repeat(100_000)), Code::LimitPassed);
    let compiled = survived(&deep(900));
    assert_eq!(compiled.scene.nodes.len(), 1);
    let spans = format!(
        "<text>{}A{}</text>",
        "<tspan>".repeat(900),
        "</tspan>".repeat(900)
    );
    survived(&svg(&spans));
}

#[test]
fn entity_bombs_are_refused() {
    let mut bomb = "<!DOCTYPE svg [<!ENTITY a0 \"boom\">".to_owned();
    for level in 1..30 {
        bomb.push_str(&format!("<!ENTITY a{level} \"&a{0};&a{0};\">", level - 1));
    }
    refused(
        &format!("{bomb}]>{}", svg("<text>&a29;</text>")),
        Code::LimitPassed,
    );
    // An entity that refers to itself.
    let compiled = compile(&format!(
        "<!DOCTYPE svg [<!ENTITY a \"&a;\">]>{}",
        svg("<text>&a;</text>")
    ));
    assert!(compiled.has_errors());
}

#[test]
fn bombs_of_clones_are_refused() {
    let mut bomb = "<defs><rect id=\"u0\" width=\"9\" height=\"9\"/>".to_owned();
    for level in 1..=30 {
        let inner = format!("<use href=\"#u{}\"/>", level - 1).repeat(2);
        bomb.push_str(&format!("<g id=\"u{level}\">{inner}</g>"));
    }
    refused(
        &svg(&format!("{bomb}</defs><use href=\"#u30\"/>")),
        Code::LimitPassed,
    );
}

/// References to patterns, clips, masks and markers can grow exponentially too.
#[test]
fn bombs_of_definitions_are_refused() {
    for (element, property) in [
        ("pattern width=\"9\" height=\"9\"", "fill"),
        ("clipPath", "clip-path"),
        ("mask", "mask"),
        ("marker markerWidth=\"3\" markerHeight=\"3\"", "marker-mid"),
    ] {
        let name = element.split(' ').next().unwrap_or(element);
        let mut bomb = format!("<defs><{element} id=\"d0\"><path d=\"M0 0 9 9 9 0\"/></{name}>");
        for level in 1..=13 {
            let inner = format!(
                "<path d=\"M0 0 9 9 9 0 0 5\" {property}=\"url(#d{})\"/>",
                level - 1
            );
            let inner = inner.repeat(6);
            bomb.push_str(&format!(
                "<{element} id=\"d{level}\"><g>{inner}</g></{name}>"
            ));
        }
        let drawn = format!("<path d=\"M0 0 9 9 9 0 0 5\" style=\"{property}:url('#d13')\"/>");
        refused(&svg(&format!("{bomb}</defs>{drawn}")), Code::LimitPassed);
        let inherited = format!("<g {property}=\"url(#d13)\"><path d=\"M0 0 9 9 9 0 0 5\"/></g>");
        refused(
            &svg(&format!("{bomb}</defs>{inherited}")),
            Code::LimitPassed,
        );
        // Small nested definitions, and those that refer to themselves, are no bombs.
        for small in [format!("{property}=\"url(#d1)\""), String::new()] {
            let itself = format!(
                "<{element} id=\"e\"><path {property}=\"url(#e)\" d=\"M0 0 9 9 9 0\"/></{name}>"
            );
            let drawn = format!(
                "<path d=\"M0 0 9 9 9 0 0 5\" {small}/><path d=\"M0 0 9 9 9 0 0 5\" {property}=\"url(#e)\"/>"
            );
            let compiled = common::compiled(
                &svg(&format!("{bomb}{itself}</defs>{drawn}")),
                &MemoryResolver::default(),
            );
            let codes = compiled.diagnostics.iter().map(|found| found.code);
            assert!(
                codes.clone().all(|code| code != Code::LimitPassed),
                "{property} {small}"
            );
        }
    }
}

#[test]
fn long_chains_of_definitions_are_refused() {
    for property in ["clip-path", "mask"] {
        let name = if property == "mask" {
            "mask"
        } else {
            "clipPath"
        };
        let chain: String = (0..100_000)
            .map(|level| format!("<{name} id=\"d{level}\"><path d=\"M0 0 9 9 9 0\" {property}=\"url(#d{})\"/></{name}>", level + 1))
            .collect();
        let drawn = format!("<path d=\"M0 0 9 9 9 0\" {property}=\"url(#d0)\"/>");
        refused(
            &svg(&format!("<defs>{chain}</defs>{drawn}")),
            Code::LimitPassed,
        );
    }
}

#[test]
fn coordinates_that_are_no_numbers() {
    for number in [
        "1e30", "-1e30", "NaN", "inf", "1e-30", "1e400", "1e38", "3.4e38", "-0",
    ] {
        for body in [
            format!("<rect x=\"{number}\" y=\"0\" width=\"20\" height=\"9\" id=\"a\"/>"),
            format!("<rect width=\"{number}\" height=\"{number}\"/>"),
            format!("<rect width=\"{number}\" height=\"9\"/>"),
            format!("<path d=\"M 0 0 L {number} 0 L 50 {number} Z\"/>"),
            format!(
                "<path d=\"M 0 0 C {number} 0 9 {number} 50 40 Z\" transform=\"scale({number})\"/>"
            ),
            format!("<circle r=\"{number}\"/>"),
            format!("<path d=\"M 0 0 L 90 0\" stroke=\"red\" stroke-width=\"{number}\"/>"),
            format!(
                "<path d=\"M 0 0 L 90 0\" stroke=\"red\" stroke-dasharray=\"{number} 1\" stroke-dashoffset=\"{number}\"/>"
            ),
            format!(
                "<text x=\"{number}\" y=\"{number}\" font-size=\"{number}\">A$</text><rect width=\"9\" height=\"9\"/>"
            ),
        ] {
            let both = format!("{body}<rect x=\"100\" width=\"20\" height=\"50\"/>");
            survived(&svg(&both));
            survived(&svg(&format!(
                "{both}<text x=\"100\" y=\"20\">B$Shape round</text><text>% Strokes all</text>"
            )));
        }
        for string in [
            "Shape default 0 N",
            "Offset N",
            "Shape cone N 5 N",
            "Scale N",
            "Axis N",
            "Origin N N",
            "Smooth N",
        ] {
            let string = string.replace('N', number);
            let sign = if string.starts_with("Scale") {
                "%"
            } else {
                "A$"
            };
            survived(&svg(&format!(
                "<rect width=\"9\" height=\"20\"/><text>{sign}{string}</text>"
            )));
        }
        survived(
            &svg("<rect width=\"9\" height=\"20\"/>")
                .replace("width=\"200\"", &format!("width=\"{number}\"")),
        );
        survived(&svg("<rect width=\"9\" height=\"20\"/>").replace(
            "width=\"200\"",
            &format!("viewBox=\"0 0 {number} {number}\""),
        ));
    }
}

/// usvg makes the more curves of an arc, the larger its radius is.
#[test]
fn round_shapes_of_any_radius() {
    for shape in [
        "<circle r=\"1e38\"/>",
        "<ellipse rx=\"9\" ry=\"1e38\"/>",
        "<rect width=\"3e38\" height=\"3e38\" rx=\"1e38\"/>",
        "<path d=\"M0 0A1e38 1e38 0 0 0 1e38 0z\"/>",
    ] {
        survived(&svg(&shape.repeat(1000)));
    }
}

#[test]
fn dashes_without_end() {
    let dashed = |length: &str, dash: &str| {
        svg(&format!(
            "<path d=\"M 0 0 L {length} 0\" fill=\"none\" stroke=\"red\" stroke-width=\"1\" stroke-dasharray=\"{dash}\"/>"
        ))
    };
    survived(&dashed("1000000", "0.001 0.001"));
    survived(&dashed("100", "1e-9"));
    survived(&dashed("100", &"1 ".repeat(100_000)));
}

#[test]
fn a_picture_that_claims_to_be_huge_is_refused() {
    let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
    bytes.extend(100_000_u32.to_be_bytes());
    bytes.extend(100_000_u32.to_be_bytes());
    bytes.extend([8, 6, 0, 0, 0]);
    bytes.extend([0; 64]);
    let data = base64::engine::general_purpose::STANDARD.encode(bytes);
    let compiled = survived(&svg(&format!(
        "<image width=\"9\" height=\"9\" href=\"data:image/png;base64,{data}\"/>"
    )));
    assert!(compiled.scene.nodes.is_empty());
}

#[test]
fn groups_of_nothing() {
    survived(&svg(&"<g><g/></g>".repeat(20_000)));
    survived(&svg(&"<g><desc>A$</desc></g>".repeat(2000)));
}

#[test]
fn a_megabyte_of_one_string() {
    for piece in [
        "a ",
        "A@",
        "$",
        "(",
        "\"",
        "Let x 1 ",
        "Color red ",
        "1 ",
        "＄",
        "Shape roundv -90 90 ",
        "((((",
        "-",
    ] {
        for lead in ["% ", "A$", ""] {
            let string = piece.repeat((1 << 20) / piece.len());
            survived(&svg(&format!(
                "<rect width=\"9\" height=\"9\"/><text>{lead}{string}</text><text>B$</text>"
            )));
        }
    }
}

#[test]
fn thousands_of_strings_at_one_point() {
    let texts: String = (0..4000)
        .map(|i| format!("<text x=\"50\" y=\"50\">N{i}$</text>"))
        .collect();
    let shapes: String = (0..4000)
        .map(|i| {
            format!(
                "<rect x=\"{}\" y=\"{}\" width=\"2\" height=\"2\"/>",
                i % 60 * 3,
                i / 60 * 3
            )
        })
        .collect();
    let compiled = survived(&svg(&format!("{shapes}{texts}")));
    assert!(
        compiled
            .bindings
            .parts
            .iter()
            .all(|part| part.string.is_some())
    );
    // All parts at one point, too; and by outlines.
    let shapes = "<rect x=\"49\" y=\"43\" width=\"2\" height=\"2\"/>".repeat(2000);
    let texts: String = (0..2000)
        .map(|i| format!("<text x=\"50\" y=\"50\">N{i}$</text>"))
        .collect();
    survived(&svg(&format!("{shapes}{texts}")));
    survived(&svg(&format!("{shapes}{texts}<text>% Bind outline</text>")));
}

#[test]
fn names_that_are_all_alike() {
    let parts: String = (0..3000)
        .map(|i| {
            format!("<rect x=\"{i}\" width=\"2\" height=\"2\"><desc>Same@Sane{i}</desc></rect>")
        })
        .collect();
    survived(&svg(&parts));
}

#[test]
fn doubling_thirty_times_is_refused() {
    let parts: String = (0..30)
        .map(|i| {
            let parent = if i == 0 { String::new() } else { format!("@P{}", i - 1) };
            format!("<rect x=\"{}\" width=\"5\" height=\"3\"><desc>P{i}{parent}$Shape -d default 2 3</desc></rect>", i * 6)
        })
        .collect();
    refused(&svg(&parts), Code::LimitPassed);
}

#[test]
fn a_chain_of_ten_thousand_parts() {
    let parts: String = (0..10_000)
        .map(|i| {
            let parent = if i == 0 { String::new() } else { format!("@P{}", i - 1) };
            format!("<rect x=\"{}\" width=\"5\" height=\"3\"><desc>P{i}{parent}$Shape flat</desc></rect>", i * 6)
        })
        .collect();
    let compiled = survived(&svg(&parts));
    let errors = compiled
        .diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.severity() == Severity::Error);
    assert_eq!(errors.count(), 0);
}

#[test]
fn a_long_chain_of_variables() {
    let lets: String = (0..5000)
        .map(|i| format!("Let v{i} (v{} + 1) ", i + 1))
        .collect();
    survived(&svg(&format!(
        "<rect width=\"9\" height=\"20\"/><text>A$Offset v0</text><text>% {lets} Let v5000 1</text>"
    )));
}

#[test]
fn gradients_and_clips_in_circles() {
    survived(&svg(
        "<defs><linearGradient id=\"a\" href=\"#b\"/><linearGradient id=\"b\" href=\"#a\"/>\
         <clipPath id=\"c\" clip-path=\"url(#d)\"><rect width=\"9\" height=\"9\"/></clipPath>\
         <clipPath id=\"d\" clip-path=\"url(#c)\"><rect width=\"9\" height=\"9\"/></clipPath>\
         <pattern id=\"p\" width=\"9\" height=\"9\"><rect width=\"5\" height=\"5\" fill=\"url(#p)\"/></pattern></defs>\
         <rect width=\"9\" height=\"20\" fill=\"url(#a)\"/><rect width=\"9\" height=\"20\" clip-path=\"url(#c)\"/>\
         <rect x=\"50\" width=\"9\" height=\"20\" fill=\"url(#p)\"/>",
    ));
}

/// A short file that is cut in very many ways does not fill the memory.
#[test]
fn motions_have_so_many_numbers_together() {
    const FRAMES: usize = 4_000;
    let mut motion = format!(
        "HIERARCHY\nROOT Hips\n{{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
         JOINT LeftUpLeg\n{{\nOFFSET 0 -5 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{{\nOFFSET 0 -5 0\n}}\n}}\n}}\n\
         MOTION\nFrames: {FRAMES}\nFrame Time: 0.041667\n"
    );
    for frame in 0..FRAMES {
        motion += &format!("{} 9 0 0 {} 0 0 0 0\n", frame % 7, frame % 5);
    }
    let files = MemoryResolver::default().with("a.bvh", motion.into_bytes());
    let refused = |clips: usize| {
        let strings = (0..clips).map(|clip| {
            format!(r#"<text x="5" y="5">%Motion "a.bvh" c{clip} from 0.{clip:03}1</text>"#)
        });
        let strings: String = strings.collect();
        let drawing = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300">{strings}<rect x="60" y="60" width="80" height="90"/><text x="90" y="90">Box</text></svg>"#
        );
        let compiled = common::compiled(&drawing, &files);
        let found = compiled.diagnostics.iter();
        let found = found.filter(|found| found.message.contains("numbers together"));
        found.count()
    };
    assert_eq!(refused(110), 0);
    assert_eq!(refused(130), 1);
}
