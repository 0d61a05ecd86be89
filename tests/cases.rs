//! Drawings with their expected results: `tests/cases/<name>/drawing.svg` and `expected.txt` beside it.
//!
//! A new case is a new folder, and each is a test of its own: `cargo test --test cases NAME` runs those with NAME in their names. `OKOSHI_REWRITE=cases cargo test --test cases` writes what is expected; look at it
//! against the design before you keep it. The comment in a drawing says the rule that it is a case of.
mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use common::rewrite::rewrites;
use libtest_mimic::{Arguments, Failed, Trial};
use okoshi::FolderResolver;
use okoshi::diagnostic::{Code, Diagnostic};
use okoshi::internals::cli::report::{Style, human};
use okoshi::internals::report::Findings;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases")
}

fn cases() -> Vec<PathBuf> {
    let entries = fs::read_dir(folder()).expect("tests/cases");
    let mut cases: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.is_dir())
        .collect();
    cases.sort();
    cases
}

/// The result of a drawing: diagnostics, report, nodes and clips.
fn outcome(case: &Path) -> Result<String, String> {
    let drawing = case.join("drawing.svg");
    let text = fs::read_to_string(&drawing).map_err(|error| error.to_string())?;
    let compiled = common::compiled(&text, &FolderResolver::new(case));
    let findings = human(
        Findings {
            look: None,
            path: "drawing.svg",
            text: &text,
            diagnostics: &compiled.diagnostics,
        },
        Style::Plain,
    );
    if let Some(found) = compiled.diagnostics.iter().find(|found| !is_worded(found)) {
        return Err(format!(
            "the wording of {found:?} is not that of the others"
        ));
    }
    let glb = common::glb(&compiled);
    if glb != common::glb(&common::compiled(&text, &FolderResolver::new(case))) {
        return Err("two builds differ".to_owned());
    }
    let nodes = common::nodes(&glb)?;
    common::check_laws(&nodes)?;
    if let Some(name) = common::repeated_name(&nodes).filter(|_| !compiled.has_errors()) {
        return Err(format!("two nodes are named `{name}`, and nothing is said"));
    }
    let inspected = Command::new(env!("CARGO_BIN_EXE_okoshi"))
        .args(["inspect", "-q", "drawing.svg"])
        .current_dir(case)
        .output()
        .map_err(|error| error.to_string())?;
    let inspected = String::from_utf8_lossy(&inspected.stdout);
    // The size of the model follows from what is built; `tests/cli.rs` tests that line.
    let inspected = inspected.lines().filter(|line| !line.starts_with("model "));
    let inspected: String = inspected.map(|line| format!("{line}\n")).collect();
    let clips = match common::clips(&glb)? {
        clips if clips.is_empty() => clips,
        clips => format!("\n==== clips\n{clips}"),
    };
    Ok(format!(
        "{findings}==== inspect\n{inspected}\n==== nodes\n{}{clips}",
        common::tree(&nodes)
    ))
}

/// Whether a diagnostic reads as all do: a message and help that begin like the middle of a sentence and end without a full stop or a
/// question, and a way out, which is help, a fix, or what was expected.
fn is_worded(diagnostic: &Diagnostic) -> bool {
    let is_plain = |text: &str| {
        !text.starts_with(|c: char| c.is_uppercase()) && !text.ends_with(['.', '?', '!', ':'])
    };
    let label = diagnostic.label.as_deref().unwrap_or_default();
    let help = diagnostic.help.as_deref();
    is_plain(&diagnostic.message)
        && help.is_none_or(is_plain)
        && (help.is_some() || !diagnostic.fixes.is_empty() || label.starts_with("expected "))
}

/// Compares the result of a drawing with its `expected.txt`, or writes that.
fn check(case: &Path) -> Result<(), Failed> {
    let file = case.join("expected.txt");
    let outcome = outcome(case)?;
    if rewrites("cases") {
        return Ok(fs::write(file, outcome)?);
    }
    let expected = fs::read_to_string(file).unwrap_or_default();
    if expected == outcome {
        return Ok(());
    }
    let difference = difference(&expected, &outcome);
    Err(format!(
        "{difference}If this is right, `OKOSHI_REWRITE=cases cargo test --test cases` writes it."
    )
    .into())
}

fn main() -> ExitCode {
    let cases = cases();
    assert!(cases.len() > 200, "only {} cases were found", cases.len());
    let trial = |case: PathBuf| {
        let name = case.file_name().unwrap_or_default().to_string_lossy();
        Trial::test(name.into_owned(), move || check(&case))
    };
    let mut trials: Vec<Trial> = cases.into_iter().map(trial).collect();
    let others: [(&str, fn()); 3] = [
        ("every_diagnostic_has_a_case", every_diagnostic_has_a_case),
        ("every_mistake_is_listed", every_mistake_is_listed),
        (
            "four_segments_make_an_octagonal_prism",
            four_segments_make_an_octagonal_prism,
        ),
    ];
    trials.extend(others.map(|(name, test)| {
        Trial::test(name, move || {
            test();
            Ok(())
        })
    }));
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}

/// The lines that differ, with `-` and `+`.
fn difference(expected: &str, outcome: &str) -> String {
    let old: Vec<&str> = expected.lines().collect();
    let new: Vec<&str> = outcome.lines().collect();
    let same = |(a, b): &(&&str, &&str)| a == b;
    let head = old.iter().zip(&new).take_while(same).count();
    let most = old.len().min(new.len()) - head;
    let tail = old.iter().rev().zip(new.iter().rev()).take_while(same);
    let tail = tail.count().min(most);
    let removed = old[head..old.len() - tail].iter();
    let added = new[head..new.len() - tail].iter();
    removed
        .map(|line| format!("- {line}\n"))
        .chain(added.map(|line| format!("+ {line}\n")))
        .collect()
}

/// Codes that no drawing of the cases can show, and where they are tested instead.
const ELSEWHERE: &[(Code, &str)] = &[
    (
        Code::NotUtf8,
        "the file is no text; tests/cli.rs, `encodings`",
    ),
    (
        Code::Crash,
        "no drawing is known to crash okoshi; tests/crash.rs",
    ),
    (
        Code::LooksDifferent,
        "compiling does not draw the model; tests/as_drawn/comparison.rs",
    ),
];

fn every_diagnostic_has_a_case() {
    let mut seen = BTreeSet::new();
    for case in cases() {
        let expected = fs::read_to_string(case.join("expected.txt")).unwrap_or_default();
        for code in Code::ALL {
            if expected.contains(&format!("[{}]: ", code.id())) {
                seen.insert(code.id());
            }
        }
    }
    for code in Code::ALL {
        let elsewhere = ELSEWHERE.iter().any(|(other, _)| other == code);
        let id = code.id();
        assert!(
            seen.contains(id) || elsewhere,
            "no case shows {id}, {}",
            code.title()
        );
        assert!(
            !(seen.contains(id) && elsewhere),
            "a case shows {id}: take it off the list of exceptions"
        );
    }
}

/// The page of common mistakes lists at least 60, each with a case of that code, and all cases named after mistakes.
fn every_mistake_is_listed() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/mistakes.md");
    let page = fs::read_to_string(page).expect("the page");
    let rows: Vec<&str> = page
        .lines()
        .filter(|line| line.contains("tests/c"))
        .collect();
    let rows: Vec<&str> = rows
        .into_iter()
        .filter(|line| line.starts_with("| "))
        .collect();
    assert!(rows.len() >= 60, "only {} mistakes are listed", rows.len());
    let mut listed = BTreeSet::new();
    for row in rows {
        let Some((_, case)) = row.split_once("../tests/cases/") else {
            continue;
        };
        let case = case.split('/').next().unwrap_or_default();
        let expected = fs::read_to_string(folder().join(case).join("expected.txt"));
        let expected = expected.unwrap_or_else(|error| panic!("{case}: {error}"));
        let code = row.split_once("| [").map_or("", |(_, code)| &code[..4]);
        assert!(
            code.is_empty()
                || !code.ends_with(|c: char| c.is_ascii_digit())
                || expected.contains(&format!("[{code}]: ")),
            "{case} does not show {code}"
        );
        assert!(listed.insert(case.to_owned()), "{case} is listed twice");
    }
    for case in cases() {
        let name = case.file_name().unwrap_or_default().to_string_lossy();
        assert!(
            !name.starts_with("mistake-") || listed.contains(&*name),
            "docs/mistakes.md does not list {name}"
        );
    }
}

/// The paper's figure 8: a rectangle rounded about its axis in four layers is a prism over an octagon.
fn four_segments_make_an_octagonal_prism() {
    let case = folder().join("shape-octagonal-prism");
    let text = fs::read_to_string(case.join("drawing.svg")).expect("the case");
    let compiled = common::compiled(&text, &FolderResolver::new(&case));
    let nodes = common::nodes(&common::glb(&compiled)).expect("a model");
    let prism = &nodes
        .iter()
        .find(|node| node.name == "A")
        .expect("the part")
        .primitives[0];
    // Half the width is 0.2 m, half the length 0.6 m.
    let mut places: Vec<[i64; 3]> = prism
        .positions
        .iter()
        .map(|p| p.map(|x| (f64::from(x) * 1e5).round() as i64))
        .collect();
    places.sort_unstable();
    places.dedup();
    let mut octagon = Vec::new();
    for step in 0..8 {
        let (sin, cos) = (f64::from(step) * 45.0).to_radians().sin_cos();
        for end in [-60_000, 60_000] {
            let at = |x: f64| (x * 0.2 * 1e5).round() as i64;
            octagon.push([at(cos), end, at(sin)]);
        }
    }
    octagon.sort_unstable();
    assert_eq!(places, octagon);
    // Eight side faces and two ends: a normal each, as it is shaded flat.
    let mut faces: Vec<[i64; 3]> = prism
        .normals
        .iter()
        .map(|n| n.map(|x| (f64::from(x) * 1e3).round() as i64))
        .collect();
    faces.sort_unstable();
    faces.dedup();
    assert_eq!(faces.len(), 10, "{faces:?}");
    assert_eq!(faces.iter().filter(|n| n[1].abs() == 1000).count(), 2);
    assert_eq!(faces.iter().filter(|n| n[1] == 0).count(), 8);
    // Two triangles a side, six an end.
    assert_eq!(prism.triangles.len(), 8 * 2 + 2 * 6);
}
