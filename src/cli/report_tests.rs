use super::*;
use crate::diagnostic::Code;
use crate::report::samples::{DRAWING, at, misspelled};

fn report(text: &str, diagnostics: &[Diagnostic]) -> String {
    let findings = Findings {
        look: None,
        path: "human.svg",
        text,
        diagnostics,
    };
    human(findings, Style::Plain)
}

#[test]
fn a_finding_is_shown_in_its_line() {
    insta::assert_snapshot!(report(DRAWING, &[misspelled(DRAWING)]), @r#"
        error[E101]: unknown keyword `Shap`
         --> human.svg:2:21
          |
        2 |   <text>Rarm@Ubody$    Shap roundv</text>
          |                        ^^^^ not a keyword
          |
          = help: `okoshi explain` lists the keywords
        help: write `Shape`
          |
        2 |   <text>Rarm@Ubody$    Shape roundv</text>
          |                            +
    "#);
}

#[test]
fn places_near_each_other_share_a_piece() {
    let second = at(DRAWING, "2</");
    let range = Diagnostic::new(
        Code::OutOfRange,
        Span::new(second.start, second.start + 1),
        "blue is `2`, but ends at 1",
    )
    .related(at(DRAWING, "Rarm"), "the other one");
    insta::assert_snapshot!(report(DRAWING, &[range]), @r#"
        error[E105]: blue is `2`, but ends at 1
         --> human.svg:7:26
          |
        2 |   <text>Rarm@Ubody$    Shap roundv</text>
          |         ---- the other one
        ...
        7 |   <text>腕腕@頭 $ Color 1 1 2</text>
          |                             ^
    "#);
}

#[test]
fn wide_characters_take_two_columns_and_control_characters_none() {
    let parent = Diagnostic::new(
        Code::UnknownParent,
        at(DRAWING, "頭"),
        "no part `頭\u{1B}[31m`",
    )
    .help("name \u{1B}[31mone");
    insta::assert_snapshot!(report(DRAWING, &[parent]), @r#"
        error[E204]: no part `頭␛[31m`
         --> human.svg:7:12
          |
        7 |   <text>腕腕@頭 $ Color 1 1 2</text>
          |              ^^
          |
          = help: name �[31mone
    "#);
}

#[test]
fn several_lines_are_shown_with_a_bar() {
    let both = at(DRAWING, "<path/>\n  <path/>");
    let lines = Diagnostic::new(Code::Vanishes, both, "parts vanish");
    insta::assert_snapshot!(report(DRAWING, &[lines]), @r#"
        warning[W307]: parts vanish
         --> human.svg:3:3
          |
        3 | /   <path/>
        4 | |   <path/>
          | |_________^
    "#);
}

#[test]
fn a_long_line_is_cut_around_the_span() {
    let mut text = "<path d='M 0 0 L 腕'/>".repeat(200_000);
    text.insert_str(23 * 130_000, "<text>Rarm@Ubody$Shap roundv</text>");
    text.insert_str(23 * 39_000, "<text>Other</text>");
    let finding = misspelled(&text).related(at(&text, "Other"), "the other one");
    insta::assert_snapshot!(report(&text, std::slice::from_ref(&finding)), @r#"
        error[E101]: unknown keyword `Shap`
         --> human.svg:1:2730036
          |
        1 | …<path d='M 0 0 L 腕'/><text>Rarm@Ubody$Shap roundv</text><path d='M 0 0 L 腕'/><pa…
          |                                         ^^^^ not a keyword
          |
          = help: `okoshi explain` lists the keywords
        note: the other one
         --> human.svg:1:819007
          |
        1 | … 0 L 腕'/><path d='M 0 0 L 腕'/><text>Other</text><path d='M 0 0 L 腕'/><path d='M…
          |                                        ^^^^^
        help: write `Shape`
          |
        1 | …<path d='M 0 0 L 腕'/><text>Rarm@Ubody$Shape roundv</text><path d='M 0 0 L 腕'/><pa…
          |                                             +
    "#);

    // As many again cost next to nothing, however long the line.
    let many = report(&text, &vec![finding; 2000]);
    assert!(many.len() < 2000 * 2000);
    let most = Span::new(22, 4_000_000);
    let whole = report(&text, &[Diagnostic::new(Code::Vanishes, most, "much")]);
    assert!(whole.len() < 1000, "{whole}");
}

#[test]
fn odd_places_do_no_harm() {
    let odd = |text: &str, span| {
        report(
            text,
            &[Diagnostic::new(Code::NotXml, span, "odd")
                .related(span, "also odd")
                .fix("mend it", span, "<svg/>")],
        )
    };
    for text in ["", "\n", "\r\n\r", "腕", "a\tb\n", DRAWING] {
        for start in 0..text.len() + 3 {
            for end in [start, start + 1, text.len() + 2, 0] {
                assert!(odd(text, Span { start, end }).contains("odd"));
            }
        }
    }
}

#[test]
fn colors_are_for_those_who_ask() {
    let findings = Findings {
        look: None,
        path: "human.svg",
        text: DRAWING,
        diagnostics: &[misspelled(DRAWING)],
    };
    assert!(human(findings, Style::Colored).contains("\u{1B}["));
    assert!(!human(findings, Style::Plain).contains('\u{1B}'));
}
