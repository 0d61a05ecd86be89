//! Texts laid on art that was not drawn for okoshi, as people lay them: each is bound to what it means, or a hint says that this is
//! uncertain.
//!
//! The costs of `bind/matching/meant` were fitted to all of `texts.json`, so that its shares tell how well the rule does on what it was
//! made from. How well it does on other drawings is measured in `binding/held_back.rs`.
#![allow(clippy::print_stdout, reason = "what was measured is told")]

#[path = "binding/held_back.rs"]
mod held_back;

use std::collections::BTreeMap;
use std::path::Path;
use std::{fmt::Write as _, fs};

use okoshi::compile::{Compiled, Options, compile};
use okoshi::diagnostic::Code;
use okoshi::internals::source::escape_xml;
use okoshi::internals::svg::{GroupId, ShapeId};
use okoshi::resolver::MemoryResolver;
use serde::Deserialize;

/// Texts on a drawing.
#[derive(Deserialize)]
struct Laid {
    art: String,
    /// How the texts are placed.
    kind: String,
    leaders: Vec<Leader>,
    texts: Vec<Text>,
}

#[derive(Deserialize)]
struct Leader {
    d: String,
    width: f64,
}

#[derive(Deserialize)]
struct Text {
    x: f64,
    y: f64,
    size: f64,
    text: String,
    /// The ids of the elements that count as what it means.
    means: Vec<String>,
}

/// How many texts are right and wrong, and how many of each a hint names.
#[derive(Default, Clone, Copy)]
struct Count {
    right: [usize; 2],
    wrong: [usize; 2],
}

impl Count {
    fn add(&mut self, other: Self) {
        for hinted in 0..2 {
            self.right[hinted] += other.right[hinted];
            self.wrong[hinted] += other.wrong[hinted];
        }
    }

    fn all(&self) -> usize {
        self.right.iter().chain(&self.wrong).sum()
    }

    fn share_right(&self) -> f64 {
        self.right.iter().sum::<usize>() as f64 / self.all() as f64
    }
}

fn folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/binding")
}

fn read() -> Vec<Laid> {
    let texts = fs::read_to_string(folder().join("texts.json")).expect("texts.json");
    serde_json::from_str(&texts).expect("drawings")
}

/// The drawing that texts are laid on.
fn art(laid: &Laid) -> String {
    let art = folder().join(format!("art/{}.svg", laid.art));
    fs::read_to_string(art).expect("art")
}

/// A drawing with texts; their ids are `text0`, `text1` and so on.
fn drawing(mut svg: String, laid: &Laid) -> String {
    svg.truncate(svg.rfind("</svg>").expect("an end"));
    for Leader { d, width } in &laid.leaders {
        let _ = write!(
            svg,
            r#"<path d="{d}" style="fill:none;stroke:#000000;stroke-width:{width}"/>"#
        );
    }
    for (index, text) in laid.texts.iter().enumerate() {
        let Text { x, y, size, .. } = text;
        let words = escape_xml(&text.text);
        let _ = write!(
            svg,
            r##"<text id="text{index}" x="{x}" y="{y}" style="font-size:{size}px;fill:#000000">{words}</text>"##
        );
    }
    svg.push_str("</svg>");
    svg
}

/// The ids of a shape and of the groups around it.
fn ids(compiled: &Compiled, shape: ShapeId) -> Vec<String> {
    let drawing = &compiled.drawing;
    let shape = &drawing.shapes[shape];
    let mut ids: Vec<String> = shape.element.id.iter().cloned().collect();
    let mut group = shape.group;
    while group != GroupId::ROOT {
        ids.extend(drawing.groups[group].element.id.clone());
        group = drawing.groups[group].parent;
    }
    ids
}

fn compiled(svg: &str) -> Compiled {
    compile(svg, &Options::default(), &MemoryResolver::default())
}

/// The ids of what the text with an id is bound to: a shape and the groups around it. Also whether a hint says that it is uncertain.
fn bound_to(compiled: &Compiled, id: &str) -> (Vec<String>, bool) {
    let (drawing, bindings) = (&compiled.drawing, &compiled.bindings);
    let labels = &drawing.labels;
    let string = bindings.strings.iter().find(|string| {
        let start = string.text.whole().start;
        let mut labels = labels.iter();
        labels.any(|(label, _)| {
            let holds = label.element.start <= start && start < label.element.end;
            holds && label.id.as_deref() == Some(id)
        })
    });
    let Some((string, binding)) = string.and_then(|string| Some((string, string.binding?))) else {
        return (vec![], false);
    };
    let ids = ids(compiled, bindings.parts[binding.part].shape);
    let place = string.text.whole();
    let mut hints = compiled.diagnostics.iter();
    let uncertain = hints.any(|hint| hint.code == Code::Uncertain && hint.span == place);
    (ids, uncertain)
}

/// Lays texts on a drawing and counts those that name what they mean.
fn count(svg: String, laid: &Laid) -> Count {
    let compiled = compiled(&drawing(svg, laid));
    let mut count = Count::default();
    for (index, text) in laid.texts.iter().enumerate() {
        let (ids, uncertain) = bound_to(&compiled, &format!("text{index}"));
        let is_right = ids.iter().any(|id| text.means.contains(id));
        let side = if is_right {
            &mut count.right
        } else {
            &mut count.wrong
        };
        side[usize::from(uncertain)] += 1;
    }
    count
}

/// The counts by kind and of all texts, and a table of them.
fn report<'a>(
    counts: impl Iterator<Item = (&'a str, Count)>,
) -> (BTreeMap<&'a str, Count>, Count, String) {
    let mut kinds: BTreeMap<&str, Count> = BTreeMap::new();
    let mut all = Count::default();
    for (kind, count) in counts {
        kinds.entry(kind).or_default().add(count);
        all.add(count);
    }
    let mut table = String::new();
    for (kind, count) in kinds.iter().chain([(&"all", &all)]) {
        let _ = writeln!(
            table,
            "{kind:8} {:5} texts, {:5.1} % right",
            count.all(),
            100.0 * count.share_right()
        );
    }
    let _ = writeln!(
        table,
        "hinted at: {:.3} of the wrong ones, {:.3} of the right ones",
        hinted(all.wrong),
        hinted(all.right)
    );
    (kinds, all, table)
}

/// The share of texts that a hint names.
fn hinted(count: [usize; 2]) -> f64 {
    count[1] as f64 / (count[0] + count[1]) as f64
}

#[test]
fn texts_name_what_a_person_means() {
    let drawings = read();
    let counts = drawings
        .iter()
        .map(|laid| (laid.kind.as_str(), count(art(laid), laid)));
    let (kinds, all, table) = report(counts);
    println!("{table}");
    let (wrong, right) = (hinted(all.wrong), hinted(all.right));
    assert_eq!(all.all(), 1682);
    assert!(all.share_right() >= 0.94, "{table}");
    for (kind, count) in &kinds {
        let least = match *kind {
            "natural" | "beside" => 0.95,
            _ => 0.88,
        };
        assert!(count.share_right() >= least, "{kind}\n{table}");
    }
    assert!(wrong >= 0.5 && right <= 0.08, "{table}");
}

/// Fixes of uncertain strings settle what they say: the shape has the string afterwards, and nothing is uncertain about it.
#[test]
fn fixes_settle_what_is_uncertain() {
    let settled: usize = read()
        .iter()
        .step_by(7)
        .map(|laid| {
            let svg = drawing(art(laid), laid);
            let before = compiled(&svg);
            let uncertain = before
                .diagnostics
                .iter()
                .filter(|found| found.code == Code::Uncertain);
            let mut count = 0;
            for hint in uncertain {
                assert_eq!(hint.fixes.len(), 2, "{}: {}", laid.art, hint.message);
                for (fix, meant) in hint.fixes.iter().zip(&hint.related) {
                    let element = |compiled: &Compiled, start: usize| {
                        let mut shapes = compiled.drawing.shapes.iter_enumerated();
                        let found = shapes.find(|(_, shape)| shape.element.span.start == start);
                        found.map(|(shape, _)| shape)
                    };
                    let shape = element(&before, meant.span.start).expect("a shape");
                    let mut after = svg.clone();
                    let mut edits = fix.edits.clone();
                    edits.sort_by_key(|edit| std::cmp::Reverse(edit.span.start));
                    for edit in edits {
                        after.replace_range(edit.span.start..edit.span.end, &edit.text);
                    }
                    let after = compiled(&after);
                    let parts = &after.bindings.parts;
                    let part = parts.position(|part| part.shape == shape && !part.is_stroke);
                    let part = part.expect("its part");
                    let main = after.bindings.parts[part].main;
                    let string = after.bindings.parts[main].string.expect("a string");
                    let text = after.bindings.strings[string].text.as_str().trim();
                    assert!(
                        svg[hint.span.start..hint.span.end].trim() == escape_xml(text),
                        "{}: {text}",
                        laid.art
                    );
                    count += 1;
                }
            }
            count
        })
        .sum();
    assert!(settled >= 40, "only {settled} fixes were tried");
}
