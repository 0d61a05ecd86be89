//! Laws of changes of what is drawn, over all examples and cases: a change does what it says and nothing else, or it is refused; it is
//! undone to the byte; and a part that is moved there and back is what it was. What they write is tested in `src/ide/changes/tests`.
#![cfg(feature = "disk")]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use okoshi::FolderResolver;
use okoshi::compile::Compiled;
use okoshi::diagnostic::{Edit, Severity};
use okoshi::internals::bind::PartKind;
use okoshi::internals::ide::Analysis;
use okoshi::internals::ide::changes::{Change, NewShape, Stacking, Step, check, edits, part_after};

/// How many parts are changed in each drawing, at most.
const PARTS: usize = 2;

fn analysis(folder: &Path, text: &str) -> Analysis {
    let compiled = common::compiled(text, &FolderResolver::new(folder));
    Analysis::new(text, compiled)
}

fn applied(text: &str, edits: &[Edit]) -> String {
    let mut out = String::new();
    let mut at = 0;
    for edit in edits {
        assert!(at <= edit.span.start, "{edits:?} are in order");
        out += &text[at..edit.span.start];
        out += &edit.text;
        at = edit.span.end;
    }
    out + &text[at..]
}

/// The names of parts that people gave, what they hang on by their strings, and how many errors there are.
fn said(compiled: &Compiled) -> Vec<String> {
    let bindings = &compiled.bindings;
    let named = bindings.parts.iter().filter(|part| !part.is_automatic());
    let named = named.filter(|part| part.kind == PartKind::Main);
    let mut said: Vec<String> = named.map(|part| part.name.clone()).collect();
    said.sort();
    said
}

fn errors(compiled: &Compiled) -> usize {
    let found = compiled.diagnostics.iter();
    found
        .filter(|found| found.severity() == Severity::Error)
        .count()
}

/// Where every part lies, with what its name and its strings say of it.
fn lies(compiled: &Compiled) -> Vec<String> {
    let round = |value: f64| (value * 1e3).round() / 1e3 + 0.0;
    let parts = compiled.bindings.parts.iter_enumerated();
    let lies = parts.map(|(index, part)| {
        let (low, high) = part.measure.bounds;
        let bounds = [low.x, low.y, high.x, high.y].map(round);
        let parent = part.parent.map(usize::from);
        let resolved = compiled.bindings.resolved(&compiled.drawing, index);
        let values: Vec<String> = resolved.into_iter().map(|one| one.value).collect();
        format!(
            "{} {:?} {parent:?} {bounds:?} {values:?}",
            part.name, part.kind
        )
    });
    lies.collect()
}

/// What became of the changes that were tried.
#[derive(Default)]
struct Counts {
    made: BTreeMap<&'static str, usize>,
    refused: BTreeMap<String, usize>,
}

fn kind(change: &Change) -> &'static str {
    match change {
        Change::Draw { .. } => "draw",
        Change::Move { .. } => "move",
        Change::Restack { .. } => "restack",
        Change::Erase { .. } => "erase",
        Change::Paint { .. } => "paint",
        other => panic!("{other:?} is no change of what is drawn"),
    }
}

/// The drawing after a change, and the name of its part then; `None` if it was refused.
fn made(
    folder: &Path,
    before: &Analysis,
    change: &Change,
    counts: &mut Counts,
) -> Option<(Analysis, Option<String>)> {
    let json = serde_json::to_string(change).expect("JSON");
    assert_eq!(
        serde_json::from_str::<Change>(&json).expect("a change"),
        *change
    );
    let mut refuse = |why: String| {
        assert!(!why.is_empty() && !why.ends_with('.'), "{why}");
        let mut words = why.split('`').step_by(2);
        let first = words.next().unwrap_or_default().to_owned();
        let plain = words.fold(first, |text, word| text + "…" + word);
        *counts
            .refused
            .entry(format!("{}: {plain}", kind(change)))
            .or_default() += 1;
    };
    let found = match edits(before, change) {
        Ok(found) => found,
        Err(refusal) => {
            refuse(refusal.why);
            return None;
        }
    };
    let source = before.source();
    let text = applied(source, &found);
    let step = Step::new(change.clone(), source, &found);
    let back = step.undone(&text).expect("nothing has changed since");
    assert!(applied(&text, &back) == **source, "{json} is not undone");
    let after = analysis(folder, &text);
    if let Err(refusal) = check(before, &after, change) {
        refuse(refusal.why);
        return None;
    }
    assert!(
        errors(after.compiled()) <= errors(before.compiled()),
        "{json} makes errors"
    );
    let (mut old, new) = (said(before.compiled()), said(after.compiled()));
    if let Change::Erase { part } = change {
        old.retain(|name| name != part || new.contains(name));
    }
    assert_eq!(old, new, "{json} changes names");
    *counts.made.entry(kind(change)).or_default() += 1;
    let part = part_after(before, &after, change, &found);
    Some((after, part))
}

fn hold(path: &Path, counts: &mut Counts) {
    let Ok(text) = fs::read_to_string(path) else {
        return;
    };
    let folder = path.parent().expect("a folder");
    let before = analysis(folder, &text);
    if !before.is_sound() {
        return;
    }
    let compiled = before.compiled();
    let (corner, size) = compiled.drawing.page;
    // Numbers with few digits are the same again after they were written as JSON.
    let short = |number: f64| (number * 100.0).round() / 100.0;
    let [x, y, width, height] = [corner.x, corner.y, size.x, size.y];
    let shapes = [
        NewShape::Ellipse(
            [
                x + 0.97 * width,
                y + 0.03 * height,
                width / 50.0,
                height / 60.0,
            ]
            .map(short),
        ),
        NewShape::Path(format!(
            "M {} {} l {} 0 q 0 {} {} 0",
            x + 0.01 * width,
            y + 0.99 * height,
            width / 40.0,
            height / 50.0,
            -width / 40.0
        )),
    ];
    for shape in shapes {
        let change = Change::Draw {
            shape,
            fill: "#12ab9f".to_owned(),
        };
        if let Some((after, part)) = made(folder, &before, &change, counts) {
            let part = part.unwrap_or_else(|| panic!("{} has a new part", path.display()));
            let drawn = after.compiled().bindings.parts.iter();
            let mut drawn = drawn.filter(|one| one.name == part);
            assert_eq!(
                drawn
                    .next()
                    .map(|part| part.paint(&after.compiled().drawing).color),
                Some([0x12, 0xab, 0x9f]),
                "{}",
                path.display()
            );
        }
    }
    let main = compiled.bindings.parts.iter();
    let main = main.filter(|part| part.kind == PartKind::Main);
    let names: Vec<&str> = main.map(|part| part.name.as_str()).collect();
    let stride = names.len().div_ceil(PARTS).max(1);
    for name in names.into_iter().step_by(stride) {
        let part = || name.to_owned();
        let by = [width / 97.0, -height / 89.0].map(short);
        if let Some((there, now)) =
            made(folder, &before, &Change::Move { part: part(), by }, counts)
        {
            let back = Change::Move {
                part: now.expect("a moved part stays one"),
                by: by.map(|by| -by),
            };
            let (again, _) = made(folder, &there, &back, counts)
                .unwrap_or_else(|| panic!("{name} of {} does not go back", path.display()));
            assert_eq!(
                lies(again.compiled()),
                lies(compiled),
                "{name} of {} does not lie where it did",
                path.display()
            );
        }
        for to in [
            Stacking::Front,
            Stacking::Back,
            Stacking::Forward,
            Stacking::Backward,
        ] {
            made(
                folder,
                &before,
                &Change::Restack { part: part(), to },
                counts,
            );
        }
        made(folder, &before, &Change::Erase { part: part() }, counts);
        let fill = "#12ab9f".to_owned();
        made(
            folder,
            &before,
            &Change::Paint { part: part(), fill },
            counts,
        );
    }
}

#[allow(
    clippy::print_stdout,
    reason = "with --nocapture it says what was tried"
)]
fn assert_counts(folder: &str, least: [(&str, usize); 5]) {
    let mut counts = Counts::default();
    for path in common::drawings_in(folder) {
        hold(&path, &mut counts);
    }
    println!("made: {:?}", counts.made);
    for (why, count) in &counts.refused {
        println!("{count:6} {why}");
    }
    for (kind, least) in least {
        let count = counts.made.get(kind).copied().unwrap_or_default();
        assert!(
            count >= least,
            "only {count} changes of kind {kind} were made"
        );
    }
}

#[test]
fn drawings_of_examples_are_drawn_on() {
    let least = [
        ("draw", 50),
        ("move", 50),
        ("restack", 50),
        ("erase", 10),
        ("paint", 10),
    ];
    assert_counts("examples", least);
}

#[test]
fn drawings_of_cases_are_drawn_on() {
    let least = [
        ("draw", 200),
        ("move", 200),
        ("restack", 200),
        ("erase", 50),
        ("paint", 50),
    ];
    assert_counts("tests/cases", least);
}
