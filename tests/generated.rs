//! The pages and grammars that are generated from the keyword table are up to date.
//!
//! `OKOSHI_REWRITE=generated cargo test --test generated` rewrites it.
#![cfg(feature = "cli")]

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use okoshi::FolderResolver;
use okoshi::compile::Compiled;
use okoshi::diagnostic::{Code, Diagnostic};
use okoshi::internals::cli::report::{Style, human};
use okoshi::internals::lang::reference;
use okoshi::internals::look::{compare, hints};
use okoshi::internals::report::Findings;
use okoshi::resolver::{LinkError, Resolver};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

#[track_caller]
fn same(name: &str, generated: &str) {
    let path = path(name);
    if common::rewrite::rewrites("generated") {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).expect("folder");
        }
        fs::write(&path, generated).expect("rewritten");
        return;
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        written == generated,
        "{name} is out of date: run `OKOSHI_REWRITE=generated cargo test --test generated`"
    );
}

/// The case whose report the page of diagnostics shows for each code. The other codes need more than a drawing.
const SHOWN: &[(Code, &str)] = &[
    (Code::NotXml, "file-bare-ampersand"),
    (Code::NotSvg, "file-not-svg"),
    (Code::EmptyFile, "file-empty"),
    (Code::LimitPassed, "tiles-grid-too-large"),
    (Code::MissingFile, "motion-missing"),
    (Code::LinkOutside, "texture-outside"),
    (Code::UnknownKeyword, "string-unknown-keyword"),
    (Code::UnknownWord, "string-unknown-word"),
    (Code::ArgumentCount, "string-argument-count"),
    (Code::ArgumentType, "string-argument-type"),
    (Code::OutOfRange, "mistake-colour-from-0-to-255"),
    (Code::UnclosedQuote, "string-unclosed-quote"),
    (Code::UnclosedParenthesis, "string-unclosed-parenthesis"),
    (Code::UnknownVariable, "string-unknown-variable"),
    (Code::VariableCycle, "string-variable-cycle"),
    (Code::NotAllowedHere, "string-not-allowed-here"),
    (Code::NoName, "string-no-name"),
    (Code::UnexpectedSign, "mistake-two-strings-on-a-line"),
    (Code::UnknownFlag, "string-unknown-flag"),
    (Code::BadExpression, "string-bad-expression"),
    (Code::UnquotedName, "mistake-name-with-spaces"),
    (Code::MissingSign, "string-missing-sign"),
    (Code::NoPartLeft, "bind-no-part-left"),
    (Code::TwoStrings, "bind-desc-second-string"),
    (Code::DuplicateName, "hierarchy-duplicate-name"),
    (Code::UnknownParent, "mistake-wrong-case-of-parent"),
    (Code::ParentCycle, "hierarchy-cycle"),
    (Code::UnclearTile, "tiles-unclear"),
    (Code::BrokenMotion, "motion-broken"),
    (Code::BrokenTrack, "perform-broken-track"),
    (Code::BrokenTiles, "tiled-broken"),
    (Code::GivenTwice, "string-given-twice"),
    (Code::Overridden, "mistake-percent-twice"),
    (Code::UnusedLegend, "legend-unused"),
    (Code::TwoLegends, "legend-twice"),
    (Code::ZeroThickness, "shape-zero-thickness"),
    (Code::CopiesCoincide, "shape-coincide"),
    (Code::Vanishes, "svg-clip-away"),
    (Code::Caption, "text-captions"),
    (Code::NoSolidMeaning, "svg-mask-and-filter"),
    (Code::NotBuiltYet, "string-not-built-yet"),
    (Code::PlainPaint, "paint-pattern-with-a-filter"),
    (Code::OffGrid, "tiles-off-grid"),
    (Code::NoTiles, "tiles-none"),
    (Code::NoTileLayer, "tiles-elsewhere"),
    (Code::OpenTerrain, "tiles-open"),
    (Code::UnclearJoint, "motion-bone-unknown"),
    (Code::IdleMotion, "motion-limited-without"),
    (Code::TooLimited, "motion-limited-out-of-reach"),
    (Code::HiddenStrings, "mistake-strings-hidden"),
    (Code::ConvertedText, "mistake-text-to-paths"),
    (Code::SignInName, "mistake-wrong-sign"),
    (Code::OutlinesLeftOut, "stroke-with-a-description"),
    (Code::UnusableView, "view-alone"),
    (Code::NoPartner, "view-no-partner"),
    (Code::UnlikelyViews, "view-wrong-sign"),
    (Code::UnusedFeature, "view-feature-points-unused"),
    (Code::NoMark, "mark-follow-without"),
    (Code::MarkMismatch, "perform-other-marks"),
    (Code::OddPerformance, "perform-still"),
    (Code::NoLimbs, "motion-without-limbs"),
    (Code::ComesOff, "motion-comes-off"),
    (Code::OutsideMotion, "motion-range-outside"),
    (Code::IdleBend, "bend-without-effect"),
    (Code::LongerDashes, "limit-dashes"),
    (Code::TooFine, "limit-corners"),
    (Code::TooMuchRound, "limit-round"),
    (Code::SoftShades, "view-soft-shades"),
    (Code::NoFooting, "terrain-props-footing"),
    (Code::IdlePose, "pose-without-copies"),
    (Code::CopyOfNoPart, "pose-of-no-part"),
    (Code::PoseOrder, "pose-order"),
    (Code::CopyDiffers, "pose-scaled"),
    (Code::OffJoint, "pose-off-joint"),
    (Code::Floats, "terrain-props-footing"),
    (Code::Uncertain, "bind-meant-uncertain"),
    (Code::AutomaticName, "bind-automatic-names"),
    (Code::AxisGuess, "shape-axis-guess"),
    (Code::TurnsAboutMiddle, "attribute-offset"),
    (Code::FullWidth, "text-full-width"),
    (Code::OffPage, "svg-off-the-page"),
    (Code::MotionRepaired, "motion-mended"),
    (Code::NoJoint, "motion-without-arms"),
    (Code::Background, "background-is-left-out"),
    (Code::FarAway, "mistake-huge-offset"),
    (Code::LooksDifferent, "depth-buries"),
    (Code::Buried, "depth-buries"),
    (Code::BentArm, "motion-bent-arm"),
    (Code::UnreadNames, "text-bare-names-too-far"),
    (Code::UnusualSize, "figure-of-unusual-size"),
    (Code::LinesLeftOut, "ink-outside-is-a-guide"),
    (Code::Lettering, "lettering-beside-shapes"),
    (Code::FirstLook, "first-look"),
];

/// What okoshi prints for a diagnostic of a drawing.
fn report(text: &str, diagnostic: Diagnostic) -> String {
    let findings = Findings {
        look: None,
        path: "drawing.svg",
        text,
        diagnostics: &[diagnostic],
    };
    human(findings, Style::Plain)
}

/// What okoshi prints for an example of a code.
fn printed(code: Code) -> String {
    match code {
        Code::NotUtf8 => not_utf8(),
        Code::Crash => crash(),
        _ => shown(code),
    }
}

/// The first report with the code in the case that is shown for it.
fn shown(code: Code) -> String {
    let row = SHOWN.iter().find(|(shown, _)| *shown == code);
    let (_, case) = row.unwrap_or_else(|| panic!("SHOWN has no case for {}", code.id()));
    let folder = path("tests/cases").join(case);
    let text = fs::read_to_string(folder.join("drawing.svg")).expect("a drawing");
    let resolver = FolderResolver::new(&folder);
    let compiled = common::compiled(&text, &resolver);
    let found = match code {
        Code::LooksDifferent => {
            let look = compare(&compiled, &text, &resolver, 400).expect("a look");
            hints(&compiled, &look)
        }
        _ => compiled.diagnostics,
    };
    let found = found.into_iter().find(|found| found.code == code);
    report(
        &text,
        found.unwrap_or_else(|| panic!("{case} does not show {}", code.id())),
    )
}

/// The report on a drawing in Latin-1, with a letter that is no UTF-8.
fn not_utf8() -> String {
    let drawing = b"<svg xmlns=\"http://www.w3.org/2000/svg\"><text>F\xfc\xdfe@Body</text></svg>";
    let room = common::program::Room::with("drawing.svg", drawing);
    let out = room.run(&["check", "-v", "drawing.svg"]).out;
    let (report, _count) = out.trim_end().rsplit_once("\n\n").expect("a report");
    report.to_owned()
}

/// The report on a panic, without the version, which would be out of date after the next.
fn crash() -> String {
    struct Faulty;
    impl Resolver for Faulty {
        fn read(&self, link: &str) -> Result<std::sync::Arc<[u8]>, LinkError> {
            panic!("cannot resolve {link}")
        }
    }
    let text = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
<rect width="30" height="40"/><text x="5" y="9">Body$Texture "a.png"</text></svg>"#;
    let Compiled { diagnostics, .. } = common::compiled(text, &Faulty);
    let crash = diagnostics
        .into_iter()
        .find(|found| found.code == Code::Crash);
    report(text, crash.expect("a crash")).replace(env!("CARGO_PKG_VERSION"), "…")
}

#[test]
fn reference_page() {
    same("docs/reference.md", &reference::reference());
}

#[test]
fn diagnostics_page() {
    let page = reference::diagnostics(|code| Some(printed(code)));
    same("docs/diagnostics.md", &page);
}

#[test]
fn ebnf() {
    same("grammar/okoshi.ebnf", &reference::ebnf());
}

#[test]
fn textmate() {
    same("grammar/okoshi.tmLanguage.json", &reference::textmate());
}

#[test]
fn injection() {
    same(
        "grammar/okoshi-injection.tmLanguage.json",
        &reference::injection(),
    );
}
