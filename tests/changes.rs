//! Laws of changes, over all examples and cases: a change does what it says and nothing else, or it is refused.
//!
//! Of each drawing some changes are tried, other ones of every drawing; `OKOSHI_CHANGES=1000000 cargo test --test changes` tries
//! all.
#![cfg(feature = "disk")]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use common::changed::{analysis, applied};
use common::law::Tally;
use okoshi::compile::Compiled;
use okoshi::diagnostic::{Edit, Severity};
use okoshi::internals::bind::{PartId, PartKind};
use okoshi::internals::ide::Analysis;
use okoshi::internals::ide::changes::{
    Change, Moment, PartTurn, Place, Step, can_set, check, edits,
};
use okoshi::internals::lang::keyword::Keyword;

/// How many changes are tried of each drawing.
fn tried() -> usize {
    let set = std::env::var("OKOSHI_CHANGES").ok();
    set.and_then(|count| count.parse().ok()).unwrap_or(4)
}

/// A value for each attribute that is probably not the one that a part has.
fn value(keyword: Keyword) -> &'static str {
    match keyword.name() {
        "Color" => "#1f7a8c",
        "Shape" => "-c cone 0 7 0.5",
        "Offset" => "3.5",
        "Stack" | "Swing" => "0.25",
        "Origin" => "12 30.5",
        "Axis" => "41",
        "Segments" => "7",
        "Smooth" => "12",
        "Side" => "near",
        "Metallic" | "Roughness" | "Alpha" => "0.35",
        "Emissive" => "0.1 0 0.2",
        "Texture" => "\"no such file.png\"",
        "Bone" => "\"Left arm\" Spine",
        "Carry" => "change",
        "Bend" => "2",
        "Facing" => "left",
        "Mark" => "#ff00ff",
        "Follow" => "Root",
        "Stand" => "10 20",
        "Size" => "2",
        other => panic!("the laws have no value of `{other}`"),
    }
}

/// What a drawing says about its parts, without the attribute `but` of a part and of the other islands of its path, which share it.
fn described(compiled: &Compiled, but: Option<(usize, Keyword)>) -> Vec<String> {
    let bindings = &compiled.bindings;
    let parts = bindings.parts.iter_enumerated();
    let described = parts.map(|(index, part)| {
        let parent = part
            .parent
            .map(|parent| usize::from(bindings.parts[parent].shape));
        let attributes = bindings.resolved(&compiled.drawing, index).into_iter();
        let is_island_of = |other: usize| {
            let mut parts = bindings.parts.iter().skip(other);
            parts.next().is_some_and(|other| {
                other.shape == part.shape && !other.is_stroke && !part.is_stroke
            })
        };
        let attributes = attributes.filter(|one| {
            let changed =
                but.filter(|(other, _)| is_island_of(*other) || *other == usize::from(index));
            changed.is_none_or(|(_, keyword)| one.keyword != keyword)
        });
        let attributes: Vec<String> = attributes
            .map(|one| format!("{:?} {} {:?}", one.keyword, one.value, one.from))
            .collect();
        // The others are counted in the order of the file.
        let is_it = but.is_some_and(|(part, _)| part == usize::from(index));
        let is_counted = part.is_automatic() && !is_it;
        let name = if is_counted { "automatic" } else { &part.name };
        format!("{name} {:?} on {parent:?}: {attributes:?}", part.kind)
    });
    described.collect()
}

fn errors(compiled: &Compiled) -> Vec<String> {
    let found = compiled.diagnostics.iter();
    let errors = found.filter(|found| found.severity() == Severity::Error);
    errors.map(|found| found.message.clone()).collect()
}

/// A drawing and what was found in it.
struct Drawing {
    path: PathBuf,
    folder: PathBuf,
    before: Analysis,
}

impl Drawing {
    fn read(path: &Path) -> Option<Self> {
        let text = fs::read_to_string(path).ok()?;
        let folder = path.parent()?.to_owned();
        let before = analysis(&folder, &text);
        let path = path.to_owned();
        before.is_sound().then_some(Self {
            path,
            folder,
            before,
        })
    }

    /// Changes that pose one of the parts, and let it swing.
    fn posed(&self, at: usize) -> [Change; 2] {
        let parts = &self.before.compiled().bindings.parts;
        let main = parts.iter().filter(|part| part.kind == PartKind::Main);
        let names: Vec<&str> = main.map(|part| part.name.as_str()).collect();
        let part = names.get(at % names.len().max(1)).copied();
        let turns = |degrees| {
            vec![PartTurn {
                part: part.unwrap_or_default().to_owned(),
                degrees,
            }]
        };
        let swing = [
            (0.0, 0.0),
            (0.5, 25.0),
            (1.0, -25.0),
            (1.0, -20.0),
            (2.0, -20.0),
        ];
        let moments = swing.map(|(seconds, degrees)| Moment {
            seconds,
            turns: turns(degrees),
        });
        [
            Change::KeepPose { turns: turns(25.0) },
            Change::KeepMovement {
                moments: moments.into(),
            },
        ]
    }

    /// All changes that are tried.
    fn changes(&self) -> Vec<Change> {
        let bindings = &self.before.compiled().bindings;
        let mut names: Vec<&str> = vec![];
        for part in &bindings.parts {
            if !part.name.is_empty() && !names.contains(&part.name.as_str()) && names.len() < 200 {
                names.push(&part.name);
            }
        }
        let keywords = || {
            Keyword::ALL
                .iter()
                .copied()
                .filter(|keyword| can_set(*keyword))
        };
        let mut all = vec![];
        for (at, name) in names.iter().enumerate() {
            let part = || (*name).to_owned();
            let other = names[(at + 1) % names.len()].to_owned();
            all.extend(keywords().map(|attribute| Change::Set {
                part: part(),
                attribute,
                value: value(attribute).to_owned(),
                place: if at % 2 == 0 { Place::Ask } else { Place::Own },
            }));
            all.extend(keywords().map(|attribute| Change::Reset {
                part: part(),
                attribute,
                place: Place::Ask,
            }));
            all.push(Change::Name {
                part: part(),
                name: "Zoë <& \"co\"".replace('"', "'"),
            });
            all.push(Change::Name {
                part: part(),
                name: "Zoe".to_owned(),
            });
            all.push(Change::Hang {
                part: part(),
                parent: Some(other),
            });
            all.push(Change::Hang {
                part: part(),
                parent: None,
            });
            all.push(Change::LeaveOut { part: part() });
            for (clip, motion, limited, held) in [
                (0, Some("-i dance 2.5 speed 0.5"), Some("3 7"), None),
                (0, Some("walk"), None, Some("3 2 7 0")),
                (0, Some("walk"), Some("0 4"), Some("5 3")),
                (0, None, None, None),
                (1, Some("wave"), None, None),
            ] {
                all.push(Change::Clip {
                    part: part(),
                    clip,
                    motion: motion.map(str::to_owned),
                    limited: limited.map(str::to_owned),
                    held: held.map(str::to_owned),
                    place: if at % 2 == 0 { Place::Ask } else { Place::Own },
                });
            }
        }
        all
    }
}

/// The attribute of a change, and the part's place in the list.
fn changed(compiled: &Compiled, change: &Change) -> Option<(usize, Keyword)> {
    let (Change::Set {
        part, attribute, ..
    }
    | Change::Reset {
        part, attribute, ..
    }) = change
    else {
        return None;
    };
    let parts = &compiled.bindings.parts;
    let mains = parts.position(|found| found.name == *part && found.kind == PartKind::Main);
    let index = mains.or_else(|| parts.position(|found| found.name == *part))?;
    Some((usize::from(index), *attribute))
}

#[derive(Default)]
struct Counts {
    /// Changes that were written, of those that were not refused for what the drawing is.
    written: Tally,
    refusals: BTreeMap<String, usize>,
    made: BTreeMap<&'static str, usize>,
    restored: usize,
    failures: Vec<String>,
}

impl Counts {
    /// Keeps what does not hold: all of it is reported at the end.
    fn require(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            self.failures.push(what());
        }
    }
}

fn kind(change: &Change) -> &'static str {
    match change {
        Change::Set { .. } => "set",
        Change::Reset { .. } => "reset",
        Change::Name { .. } => "name",
        Change::Hang { .. } => "hang",
        Change::LeaveOut { .. } => "leave out",
        Change::NameParts => "name-parts",
        Change::Clip { .. } => "clip",
        Change::KeepPose { .. } => "keep-pose",
        Change::KeepMovement { .. } => "keep-movement",
        Change::Draw { .. } => "draw",
        Change::Move { .. } => "move",
        Change::Restack { .. } => "restack",
        Change::Erase { .. } => "erase",
        Change::Paint { .. } => "paint",
        Change::Variable { .. } => "variable",
        Change::Write { .. } => "write",
        Change::Apply { .. } => "apply",
    }
}

/// Whether a clip of key poses turns a part.
fn is_posed(compiled: &Compiled, part: &str) -> bool {
    let clips = compiled.clips.iter();
    let mut clips = clips.filter(|clip| clip.is_posed);
    clips.any(|clip| {
        let mut drives = clip.parts.iter();
        drives
            .any(|drive| drive.joint.is_some() && compiled.bindings.parts[drive.part].name == part)
    })
}

/// A refusal without what it names.
fn plain(why: &str) -> String {
    let mut words = why.split('`').step_by(2);
    let first = words.next().unwrap_or_default().to_owned();
    words.fold(first, |text, word| text + "…" + word)
}

/// Makes a change if it is possible. Returns the text after it.
fn made(drawing: &Drawing, change: &Change, counts: &mut Counts) -> Option<(String, Vec<Edit>)> {
    let Drawing { folder, before, .. } = drawing;
    let source = before.source();
    let json = serde_json::to_string(change).expect("JSON");
    assert_eq!(
        serde_json::from_str::<Change>(&json).expect("a change"),
        *change,
        "{json}"
    );
    let found = match edits(before, change) {
        Ok(edits) if edits.is_empty() => return None,
        Ok(edits) => edits,
        Err(refusal) => {
            assert!(
                !refusal.why.is_empty() && !refusal.why.ends_with('.'),
                "{refusal:?}"
            );
            *counts.refusals.entry(plain(&refusal.why)).or_default() += 1;
            return None;
        }
    };
    let text = applied(source, &found);
    let after = analysis(folder, &text);
    let step = Step::new(change.clone(), source, &found);
    assert_eq!(**step.after(), text);
    let back = step.undone(&text).expect("nothing has changed since");
    let place = format!("{json} of {}", drawing.path.display());
    counts.require(applied(&text, &back) == **source, || {
        format!("{place} is not undone")
    });
    if let Err(refusal) = check(before, &after, change) {
        counts.written.count(false);
        let key = format!("{}: afterwards, {}", kind(change), plain(&refusal.why));
        *counts.refusals.entry(key).or_default() += 1;
        return None;
    }
    counts.written.count(true);
    *counts.made.entry(kind(change)).or_default() += 1;
    let (old, new) = (before.compiled(), after.compiled());
    for error in errors(new) {
        counts.require(errors(old).contains(&error), || {
            format!("{place} makes an error: {error}")
        });
    }
    let posed = match change {
        Change::KeepPose { turns } => turns.first(),
        Change::KeepMovement { moments } => moments.first().and_then(|first| first.turns.first()),
        _ => None,
    };
    if let Some(PartTurn { part, .. }) = posed {
        counts.require(is_posed(new, part), || format!("{place} poses nothing"));
        // What is written is read without complaints.
        let complaints = |compiled: &Compiled| {
            let warnings = compiled.diagnostics.iter();
            warnings
                .filter(|found| found.severity() == Severity::Warning)
                .count()
        };
        counts.require(complaints(new) <= complaints(old), || {
            format!("{place} makes warnings")
        });
    }
    if let Some(but) = changed(old, change) {
        let agreed = but.1 == Keyword::Shape && old.bindings.is_first_look;
        if !agreed {
            let (old, new) = (described(old, Some(but)), described(new, Some(but)));
            let differs = old.iter().zip(&new).find(|(old, new)| old != new);
            counts.require(old.len() == new.len() && differs.is_none(), || {
                format!("{place} changes more: {differs:?}")
            });
        }
        // With the first `Shape`, lines may be parts no longer.
        let place = changed(new, change).map_or(but.0, |(index, _)| index);
        let now = new.bindings.resolved(&new.drawing, PartId::from(place));
        let now = now.into_iter().find(|one| one.keyword == but.1);
        match change {
            Change::Set { value, .. } => {
                let now = now.map(|now| now.value).unwrap_or_default();
                let is_set = now.replace('"', "") == value.replace('"', "");
                counts.require(is_set, || format!("{place} sets `{now}`"));
            }
            _ => counts.require(now.is_none_or(|now| now.from.name() != "own"), || {
                format!("{place} takes nothing away")
            }),
        }
    }
    Some((text, found))
}

/// A new attribute that is taken away again, and an old one that is set back, leave the same bytes.
fn goes_back(drawing: &Drawing, change: &Change, text: &str, counts: &mut Counts) {
    let Change::Set {
        part, attribute, ..
    } = change
    else {
        return;
    };
    let old = drawing.before.compiled();
    let Some((index, _)) = changed(old, change) else {
        return;
    };
    // What stands in a string with mistakes is not all read.
    if !errors(old).is_empty() {
        return;
    }
    let found = &old.bindings.parts[PartId::from(index)];
    let Some(string) = found.string.map(|string| &old.bindings.strings[string]) else {
        return;
    };
    // Entities are not written again, and a lone sign is taken for one that came with the attribute.
    let raw = &drawing.before.source()[string.text.whole().start..string.text.whole().end];
    if raw.contains(['&', '＄', '<']) || raw.trim_end().ends_with('$') {
        return;
    }
    let own = string.annotation.attributes();
    let own: Vec<_> = own.iter().filter(|one| one.keyword == *attribute).collect();
    let back = match own.as_slice() {
        [] => Change::Reset {
            part: part.clone(),
            attribute: *attribute,
            place: Place::Own,
        },
        [one] if text.len() > drawing.before.source().len() / 2 => {
            let written = &string.text.as_str()[one.keyword_range.end..one.range.end];
            if written.split_whitespace().count() != written.split(' ').count() - 1 {
                return;
            }
            Change::Set {
                part: part.clone(),
                attribute: *attribute,
                value: written.trim().to_owned(),
                place: Place::Own,
            }
        }
        _ => return,
    };
    let after = analysis(&drawing.folder, text);
    // Without an own value, the old one may be what the part has anyway.
    let is_inherited = old
        .bindings
        .inherited(PartId::from(index), *attribute)
        .is_some();
    if is_inherited && !own.is_empty() {
        return;
    }
    let found = edits(&after, &back).map(|edits| applied(text, &edits));
    let is_back = found.as_deref() == Ok(&**drawing.before.source());
    counts.require(is_back, || {
        format!(
            "{back:?} does not go back to `{raw}` of {}: {:?}",
            drawing.path.display(),
            found.err()
        )
    });
    counts.restored += 1;
}

/// Two changes of different parts give the same text in either order, or are refused for the same reason.
fn commute(drawing: &Drawing, pair: [(&Change, &str); 2], counts: &mut Counts) {
    let [(one, after_one), (other, after_other)] = pair;
    let then = |text: &str, change: &Change| {
        let analysis = analysis(&drawing.folder, text);
        let edits = edits(&analysis, change).map_err(|refusal| refusal.why);
        edits.map(|edits| applied(text, &edits))
    };
    let (first, second) = (then(after_one, other), then(after_other, one));
    counts.require(first == second, || {
        format!(
            "{one:?} and {other:?} of {} do not commute: {:?} {:?}",
            drawing.path.display(),
            first.err(),
            second.err()
        )
    });
    *counts.made.entry("pairs").or_default() += 1;
}

fn hold(paths: &[PathBuf], shift: usize) -> Counts {
    let mut counts = Counts::default();
    for (at, path) in paths.iter().enumerate() {
        let Some(drawing) = Drawing::read(path) else {
            continue;
        };
        let all = drawing.changes();
        if at % 2 == shift % 2 {
            for change in drawing.posed(at) {
                made(&drawing, &change, &mut counts);
            }
        }
        let count = tried().min(all.len());
        let stride = all.len() / count.max(1);
        let mut last: Option<(&Change, String)> = None;
        for pick in 0..count {
            let change = &all[(pick * stride.max(1) + at * 7 + shift) % all.len()];
            let Some((text, _)) = made(&drawing, change, &mut counts) else {
                continue;
            };
            goes_back(&drawing, change, &text, &mut counts);
            if !matches!(change, Change::Set { .. } | Change::Reset { .. }) {
                continue;
            }
            let of = |change| changed(drawing.before.compiled(), change).map(|(part, _)| part);
            if let Some((before, after)) =
                last.take().filter(|(before, _)| of(before) != of(change))
            {
                commute(&drawing, [(before, &after), (change, &text)], &mut counts);
            }
            last = Some((change, text));
        }
    }
    counts
}

#[allow(
    clippy::print_stdout,
    reason = "with --nocapture it says what was tried"
)]
fn assert_counts(counts: &Counts, made: &[(&str, usize)], restored: usize) {
    println!("made: {:?}, restored: {}", counts.made, counts.restored);
    for (why, count) in &counts.refusals {
        println!("{count:6} {why}");
    }
    for failure in counts.failures.iter().take(25) {
        println!("FAILS: {failure}");
    }
    assert!(
        counts.failures.is_empty(),
        "{} laws are broken: {}",
        counts.failures.len(),
        counts.failures[0]
    );
    counts
        .written
        .assert_share("changes that are written do nothing else", 85);
    for (kind, least) in made {
        let count = counts.made.get(kind).copied().unwrap_or_default();
        assert!(
            count >= *least,
            "only {count} changes of kind {kind} were made"
        );
    }
    assert!(
        counts.restored >= restored,
        "only {} changes were taken back",
        counts.restored
    );
}

/// Each of two limbs that are one path is posed by a copy of the path that is turned about its own joint.
#[test]
fn islands_of_a_path_are_posed_one_by_one() {
    let mut counts = Counts::default();
    for case in ["pairs-in-one-path", "pairs-with-attributes"] {
        let path = format!("tests/cases/{case}/drawing.svg");
        let drawing = Drawing::read(Path::new(&path)).expect("a drawing");
        let parts = &drawing.before.compiled().bindings.parts;
        let mains = parts.iter().filter(|part| part.kind == PartKind::Main);
        for at in 0..mains.count() {
            for change in drawing.posed(at) {
                made(&drawing, &change, &mut counts);
            }
        }
    }
    let made = [("keep-pose", 12), ("keep-movement", 12)];
    assert_counts(&counts, &made, 0);
}

#[test]
fn changes_of_examples_do_what_they_say() {
    let counts = hold(&common::drawings_in("examples"), 0);
    assert_counts(&counts, &[("set", 40), ("pairs", 20)], 30);
}

#[test]
fn changes_of_cases_do_what_they_say() {
    let counts = hold(&common::drawings_in("tests/cases"), 3);
    let made = [
        ("set", 400),
        ("reset", 3),
        ("name", 40),
        ("hang", 15),
        ("leave out", 12),
        ("keep-pose", 100),
        ("keep-movement", 100),
        ("pairs", 80),
    ];
    assert_counts(&counts, &made, 200);
}
