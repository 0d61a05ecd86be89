use super::*;

/// Findings of so many kinds, as many of each as `counts` says; each has a line of its own.
fn drawing(kinds: &[(Code, usize)]) -> (String, Vec<Diagnostic>) {
    let mut text = String::new();
    let mut diagnostics = vec![];
    for (code, count) in kinds {
        for number in 1..=*count {
            let start = text.len();
            text += &format!("{}-{number}\n", code.id());
            let span = crate::source::Span::new(start, text.len() - 1);
            diagnostics.push(Diagnostic::new(*code, span, format!("number {number}")));
        }
    }
    (text, diagnostics)
}

fn described(kinds: &[(Code, usize)], verbose: bool, quiet: bool, detail: Detail) -> String {
    let (text, diagnostics) = drawing(kinds);
    of(&text, &diagnostics, verbose, quiet, detail)
}

fn of(
    text: &str,
    diagnostics: &[Diagnostic],
    verbose: bool,
    quiet: bool,
    detail: Detail,
) -> String {
    let findings = Findings {
        look: None,
        path: "a.svg",
        text,
        diagnostics,
    };
    let common = Common {
        quiet,
        verbose,
        color: crate::cli::args::Color::Never,
    };
    describe(findings, common, detail, Style::Plain)
}

fn usual(kinds: &[(Code, usize)]) -> String {
    described(kinds, false, false, Detail::All)
}

#[test]
fn of_one_kind_the_first_has_a_line() {
    insta::assert_snapshot!(usual(&[(Code::AutomaticName, 12), (Code::NoSolidMeaning, 1)]), @"
    a.svg:13:1: warning[W309]: number 1
    a.svg:1:1: hint[H402]: number 1 (and 11 more in lines 2, 3, 4 and 8 more)
    `okoshi check -v` shows all, each in its lines of the drawing
    ");
    insta::assert_snapshot!(usual(&[(Code::AutomaticName, 1)]), @"a.svg:1:1: hint[H402]: number 1");
}

#[test]
fn a_line_has_place_cause_and_way_out() {
    let (text, mut diagnostics) = drawing(&[(Code::UnknownKeyword, 2)]);
    diagnostics[0].on_page = Some("in the middle of the page");
    diagnostics[0].help = Some("`okoshi explain` lists\n the keywords".into());
    let [first, second] = diagnostics.clone().try_into().expect("two");
    let second = second
        .help("none")
        .fix("Write `Shape`", first.span, "Shape");
    insta::assert_snapshot!(of(&text, &[first, second], false, false, Detail::All), @"
    a.svg:1:1, in the middle of the page: error[E101]: number 1; `okoshi explain` lists the keywords
    a.svg:2:1: error[E101]: number 2; write `Shape`
    ");
}

#[test]
fn colors_are_for_those_who_ask() {
    let (text, diagnostics) = drawing(&[(Code::UnknownKeyword, 1), (Code::AutomaticName, 1)]);
    let reports = Reports::new("a.svg", &text, Style::Colored);
    let lines = diagnostics.iter().map(|finding| reports.line(finding));
    let lines: Vec<String> = lines.collect();
    assert_eq!(
        lines,
        [
            "a.svg:1:1: \x1b[1;31merror[E101]\x1b[0m: number 1",
            "a.svg:2:1: \x1b[1;36mhint[H402]\x1b[0m: number 1"
        ]
    );
}

#[test]
fn errors_are_not_hidden() {
    let text = usual(&[(Code::UnknownKeyword, 10), (Code::OutOfRange, 10)]);
    assert_eq!(text.matches("error[").count(), 20);
    assert!(!text.contains("more"));
    let text = usual(&[(Code::UnknownKeyword, 12)]);
    assert_eq!(text.matches("error[").count(), 10);
    assert!(
        text.contains("number 10 (and 2 more in lines 11 and 12)\n`okoshi check -v` shows all"),
        "{text}"
    );
}

#[test]
fn findings_take_twenty_lines_at_most() {
    let all: Vec<(Code, usize)> = Code::ALL.iter().map(|code| (*code, 3)).collect();
    for kinds in 1..all.len() {
        let text = usual(&all[..kinds]);
        let (shown, left_out) = match text.rsplit_once("… and") {
            Some((shown, last)) if last.contains("more findings (") => (shown, last),
            _ => (
                text.rsplit_once("`okoshi check -v`")
                    .map_or(&*text, |(shown, _)| shown),
                "",
            ),
        };
        let count = shown.lines().count();
        assert!(
            count <= MAX_LINES,
            "{kinds} kinds take {count} lines:\n{text}"
        );
        for (code, _) in &all[..kinds] {
            let id = code.id();
            let is_shown = shown.contains(&format!("[{id}]"));
            assert_ne!(
                is_shown,
                left_out.contains(&format!("3 {id}")),
                "{id} in\n{text}"
            );
        }
    }
}

#[test]
fn features_of_svg_are_kinds_of_their_own() {
    let (text, mut diagnostics) = drawing(&[(Code::NoSolidMeaning, 30)]);
    for (number, diagnostic) in diagnostics.iter_mut().enumerate() {
        diagnostic.help = Some(format!("the way out of feature {}", number / 2).into());
    }
    let out = of(&text, &diagnostics, false, false, Detail::All);
    assert_eq!(out.matches("[W309]").count(), 15, "{out}");
    assert!(
        out.contains(
            "a.svg:3:1: warning[W309]: number 3; the way out of feature 1 (and 1 more in line 4)\n"
        ),
        "{out}"
    );
}

#[test]
fn options_choose() {
    let kinds = [
        (Code::UnknownKeyword, 1),
        (Code::NoSolidMeaning, 2),
        (Code::AutomaticName, 12),
    ];
    let counts =
        |text: String| ["error[", "warning[", "hint["].map(|what| text.matches(what).count());
    assert_eq!(
        counts(described(&kinds, false, false, Detail::All)),
        [1, 1, 1]
    );
    assert_eq!(
        counts(described(&kinds, false, false, Detail::Repeated)),
        [1, 1, 0]
    );
    assert_eq!(
        counts(described(&kinds, false, true, Detail::All)),
        [1, 0, 0]
    );
    assert_eq!(
        counts(described(&kinds, true, false, Detail::Repeated)),
        [1, 2, 12]
    );
}
