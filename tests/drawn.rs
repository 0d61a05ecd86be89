//! Laws of changes of what is drawn, over all examples and cases: a change does what it says and nothing else, or it is refused; it is
//! undone to the byte; and a part that is moved there and back is what it was. What they write is tested in `src/ide/changes/tests`.
#![cfg(feature = "disk")]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use common::changed::{analysis, applied};
use okoshi::compile::Compiled;
use okoshi::diagnostic::Severity;
use okoshi::internals::bind::PartKind;
use okoshi::internals::ide::Analysis;
use okoshi::internals::ide::changes::{Change, NewShape, Stacking, Step, check, edits, part_after};

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

/// Which parts have nodes of their own.
fn kinds(compiled: &Compiled) -> Vec<PartKind> {
    let parts = compiled.bindings.parts.iter();
    parts.map(|part| part.kind).collect()
}

/// How many drawings of a folder are drawn on, at most.
const MOST: usize = 150;

/// What became of the changes that were tried.
#[derive(Default)]
struct Counts {
    made: BTreeMap<&'static str, usize>,
    /// Parts that were moved there and back.
    back: usize,
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
        old.retain(|name| name != part);
    }
    // What is no detail of another part any more may have a name that nothing called it by before.
    old.retain(|name| !new.contains(name));
    assert_eq!(old, [""; 0], "{json} changes names");
    *counts.made.entry(kind(change)).or_default() += 1;
    let part = part_after(before, &after, change, &found);
    Some((after, part))
}

/// A small shape in a corner of the page.
fn small(compiled: &Compiled, is_round: bool) -> NewShape {
    let (corner, size) = compiled.drawing.page;
    if is_round {
        let [x, y] = [corner.x + 0.97 * size.x, corner.y + 0.03 * size.y];
        return NewShape::Ellipse([x, y, size.x / 50.0, size.y / 60.0].map(short));
    }
    let [x, y] = [corner.x + 0.01 * size.x, corner.y + 0.99 * size.y];
    let [width, height] = [size.x / 40.0, size.y / 50.0];
    NewShape::Path(format!("M {x} {y} l {width} 0 q 0 {height} {} 0", -width))
}

/// Numbers with few digits are the same again after they were written as JSON.
fn short(number: f64) -> f64 {
    (number * 100.0).round() / 100.0
}

/// Draws on a drawing, and changes one of its parts: other ones in every drawing.
fn hold(path: &Path, at: usize, counts: &mut Counts) {
    let Ok(text) = fs::read_to_string(path) else {
        return;
    };
    let folder = path.parent().expect("a folder");
    let before = analysis(folder, &text);
    if !before.is_sound() {
        return;
    }
    let compiled = before.compiled();
    let change = Change::Draw {
        shape: small(compiled, at.is_multiple_of(2)),
        fill: "#12ab9f".to_owned(),
    };
    if let Some((after, part)) = made(folder, &before, &change, counts) {
        let part = part.unwrap_or_else(|| panic!("{} has a new part", path.display()));
        let drawn = after.compiled().bindings.parts.iter();
        // What belongs to another part goes by its element.
        let shapes = &after.compiled().drawing.shapes;
        let mut drawn = drawn.filter(|one| {
            one.name == part || shapes[one.shape].element.id.as_deref() == Some(&*part)
        });
        let painted = drawn
            .next()
            .map(|part| part.paint(&after.compiled().drawing).color);
        assert_eq!(painted, Some([0x12, 0xab, 0x9f]), "{}", path.display());
    }
    let main = compiled.bindings.parts.iter();
    let main = main.filter(|part| part.kind == PartKind::Main);
    let names: Vec<&str> = main.map(|part| part.name.as_str()).collect();
    let Some(name) = names.get(at * 7 % names.len().max(1)) else {
        return;
    };
    let part = || (*name).to_owned();
    goes_back(path, &before, name, counts);
    let ways = [
        Stacking::Front,
        Stacking::Back,
        Stacking::Forward,
        Stacking::Backward,
    ];
    let to = ways[at % ways.len()];
    let fill = "#12ab9f".to_owned();
    for change in [
        Change::Restack { part: part(), to },
        Change::Erase { part: part() },
        Change::Paint { part: part(), fill },
    ] {
        made(folder, &before, &change, counts);
    }
}

/// A part that is moved there and back lies where it did, and so does everything else.
fn goes_back(path: &Path, before: &Analysis, name: &str, counts: &mut Counts) {
    let folder = path.parent().expect("a folder");
    let compiled = before.compiled();
    let (_, size) = compiled.drawing.page;
    let by = [size.x / 97.0, -size.y / 89.0].map(short);
    let part = name.to_owned();
    let Some((there, now)) = made(folder, before, &Change::Move { part, by }, counts) else {
        return;
    };
    // What lies on a part by then goes back with it.
    if kinds(there.compiled()) != kinds(compiled) {
        return;
    }
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
    counts.back += 1;
}

#[allow(
    clippy::print_stdout,
    reason = "with --nocapture it says what was tried"
)]
fn assert_counts(folder: &str, back: usize, least: [(&str, usize); 5]) {
    let mut counts = Counts::default();
    // Of the many cases, which are small, some say enough.
    let all = common::drawings_in(folder);
    let stride = all.len().div_ceil(MOST);
    for (at, path) in all.iter().enumerate().step_by(stride) {
        hold(path, at / stride, &mut counts);
    }
    println!(
        "made: {:?}, moved there and back: {}",
        counts.made, counts.back
    );
    for (why, count) in &counts.refused {
        println!("{count:6} {why}");
    }
    assert!(
        counts.back >= back,
        "only {} parts were moved back",
        counts.back
    );
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
        ("draw", 35),
        ("move", 50),
        ("restack", 20),
        ("erase", 10),
        ("paint", 10),
    ];
    assert_counts("examples", 20, least);
}

#[test]
fn drawings_of_cases_are_drawn_on() {
    let least = [
        ("draw", 60),
        ("move", 100),
        ("restack", 50),
        ("erase", 30),
        ("paint", 50),
    ];
    assert_counts("tests/cases", 50, least);
}
