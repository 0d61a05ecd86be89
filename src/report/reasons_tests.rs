use std::collections::BTreeSet;

use super::{Reasons, Said, Undo};
use crate::compile::{Compiled, Options, compile};
use crate::ide::PartId;
use crate::resolver::MemoryResolver;

/// A person with a cape, and a wheel, each part with what is drawn for it.
const PARTS: &[(&str, &str)] = &[
    (
        "Cape@Body",
        "<path d='M30 40 Q50 30 70 40 Q80 70 75 100 Q50 95 25 100 Q20 70 30 40 Z' fill='#911'/>",
    ),
    (
        "Lleg@Body",
        "<ellipse cx='40' cy='115' rx='6' ry='25' fill='#228'/>",
    ),
    (
        "Rleg@Body",
        "<ellipse cx='60' cy='115' rx='6' ry='25' fill='#228'/>",
    ),
    (
        "Lshoe@Lleg",
        "<ellipse cx='39' cy='140' rx='9' ry='6' fill='#222'/>",
    ),
    (
        "Rshoe@Rleg",
        "<ellipse cx='61' cy='140' rx='9' ry='6' fill='#222'/>",
    ),
    (
        "Body",
        "<ellipse cx='50' cy='70' rx='20' ry='32' fill='#383' stroke='#000' stroke-width='3'/>",
    ),
    ("Head@Body", "<circle cx='50' cy='25' r='20' fill='#eca'/>"),
    (
        "Hair@Head",
        "<path d='M29 27 C29 -3 71 -3 71 27 Q50 5 29 27 Z' fill='#531'/>",
    ),
    ("Leye@Head", "<circle cx='43' cy='26' r='3' fill='#000'/>"),
    ("Reye@Head", "<circle cx='57' cy='26' r='3' fill='#000'/>"),
    (
        "Larm@Body",
        "<rect x='22' y='45' width='10' height='40' rx='5' fill='#eca'/>",
    ),
    ("Wheel", "<circle cx='150' cy='120' r='20' fill='#333'/>"),
];

/// The drawing, with an attribute for one of its parts.
fn drawing(changed: Option<(&str, &str)>) -> Compiled {
    let part = |(string, shape): &(&str, &str)| {
        let name = string.split('@').next().unwrap_or(string);
        let own = changed.filter(|(part, _)| *part == name);
        let own = own.map_or(String::new(), |(_, attribute)| format!("${attribute}"));
        let shape = shape.trim_end_matches("/>");
        let tag = &shape[1..shape.find(' ').unwrap_or(shape.len())];
        format!("{shape}><desc>{string}{own}</desc></{tag}>")
    };
    let parts: String = PARTS.iter().map(part).collect();
    let text =
        format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 160'>{parts}</svg>");
    compile(&text, &Options::default(), &MemoryResolver::default())
}

/// What is said of all nodes that can be undone, with their names.
fn said(compiled: &Compiled) -> Vec<(&str, Said)> {
    let reasons = Reasons::new(compiled);
    let of_node = |part: PartId| {
        let all = reasons.depth(part).into_iter();
        let all = all.chain(reasons.node_back(part));
        all.chain(reasons.node_forms(part))
    };
    let nodes = compiled.bindings.parts.iter_enumerated();
    let nodes = nodes.filter(|(part, _)| compiled.depths[*part].is_some());
    let all = nodes.flat_map(|(part, own)| of_node(part).map(|said| (own.name.as_str(), said)));
    all.filter(|(_, said)| said.undo.is_some()).collect()
}

#[test]
fn what_is_automatic_is_said_and_undone_by_the_string_that_it_names() {
    let compiled = drawing(None);
    let all = said(&compiled);
    let kinds: BTreeSet<Undo> = all.iter().filter_map(|(_, said)| said.undo).collect();
    let expected = [
        Undo::Depth,
        Undo::Cord,
        Undo::Back,
        Undo::Toes,
        Undo::Thin,
        Undo::Disc,
        Undo::Flattened,
    ];
    for kind in expected {
        assert!(kinds.contains(&kind), "{kind:?}: {all:?}");
    }
    for (name, said_of_it) in &all {
        let undo = said_of_it.undo.unwrap();
        let changed = drawing(Some((name, undo.string())));
        assert!(!changed.has_errors(), "{:?}", changed.diagnostics);
        let left = said(&changed);
        let is_left = |(part, said): &(&str, Said)| part == name && said.undo == Some(undo);
        assert!(!left.iter().any(is_left), "{name}: {undo:?}: {left:?}");
    }
}
