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
fn of_one_kind_the_first_is_reported() {
    insta::assert_snapshot!(usual(&[(Code::AutomaticName, 12), (Code::NoSolidMeaning, 1)]), @"
    warning[W309]: number 1
      --> a.svg:13:1
       |
    13 | W309-1
       | ^^^^^^

    hint[H402]: number 1
     --> a.svg:1:1
      |
    1 | H402-1
      | ^^^^^^
       … and 11 more H402 in lines 2, 3, 4 and 8 more; `okoshi check -v` shows all
    ");
}

#[test]
fn errors_are_not_hidden() {
    let text = usual(&[(Code::UnknownKeyword, 10), (Code::OutOfRange, 10)]);
    assert_eq!(text.matches("error[").count(), 20);
    assert!(!text.contains('…'));
    let text = usual(&[(Code::UnknownKeyword, 12)]);
    assert_eq!(text.matches("error[").count(), 10);
    assert!(text.contains("… and 2 more E101 in lines 11 and 12; `okoshi check -v` shows all"));
}

#[test]
fn other_findings_take_twenty_lines_at_most() {
    let warnings = Code::ALL
        .iter()
        .filter(|code| code.severity() != Severity::Error);
    let all: Vec<(Code, usize)> = warnings.map(|code| (*code, 3)).collect();
    for kinds in 1..all.len() {
        let text = usual(&all[..kinds]);
        let (shown, left_out) = match text.rsplit_once("… and") {
            Some((shown, last)) if last.contains("more findings (") => (shown, last),
            _ => (
                text.trim_end_matches("`okoshi check -v` shows all in full\n"),
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
    assert_eq!(out.matches("[W309]").count(), 11, "{out}");
    assert!(
        out.contains("a.svg:3:1: warning[W309]: number 3 (and 1 more)\n"),
        "{out}"
    );
    assert!(
        out.ends_with("… and 8 more findings (8 W309); `okoshi check -v` shows all\n"),
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
