//! Names for parts that nobody has named: examples without their strings get back what these said, and nothing that is there is lost.
//!
//! `OKOSHI_PRINT=1 cargo test --test annotate -- --nocapture` prints what differs. `tests/tools/annotate.mjs` scores figures by others.
#![cfg(feature = "cli")]
#![allow(
    clippy::print_stderr,
    reason = "the figures are for people who tune the rules"
)]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use common::program::Room;
use okoshi::FolderResolver;
use okoshi::compile::{Compiled, Options, compile};
use okoshi::diagnostic::Edit;
use okoshi::internals::bind::PartKind;
use okoshi::internals::ide::Analysis;
use okoshi::internals::ide::changes::{Change, Place, Step, check, edits};
use okoshi::internals::lang::keyword::Keyword;

/// Figures of the examples whose strings name heads, bodies and limbs.
const FIGURES: &[&str] = &[
    "doll",
    "human",
    "motion/dog",
    "motion/girl",
    "motion/horse",
    "motion/knight",
    "motion/monkey",
    "tutorial/5-face",
];
/// The least shares of names and of parents, in per cent.
const NAMES: usize = 72;
const PARENTS: usize = 87;
/// The least number of limbs, heads and trunks that are named beside others with names.
const ADDED: usize = 40;

fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{name}.svg"));
    fs::read_to_string(path).expect("an example")
}

fn compiled(text: &str) -> Compiled {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/motion");
    compile(text, &Options::default(), &FolderResolver::new(folder))
}

/// The text without everything from `from` to `to`, as often as it is there.
fn without(text: &str, from: &str, to: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(start) = rest.find(from) {
        let after = start + from.len();
        let Some(length) = rest[after..].find(to) else {
            break;
        };
        out += &rest[..start];
        rest = &rest[after + length + to.len()..];
    }
    out + rest
}

/// A drawing without its strings, labels and ids.
fn bare(text: &str) -> String {
    let mut text = without(&without(text, "<text", "</text>"), "<desc", "</desc>");
    text = text.replace("inkscape:label=\"Layer 1\"", "");
    text = without(&text, " inkscape:label=\"", "\"");
    let ids: Vec<String> = text
        .split(" id=\"")
        .skip(1)
        .filter_map(|rest| Some(rest.split_once('"')?.0.to_owned()))
        .collect();
    for id in ids {
        if !text.contains(&format!("#{id}")) {
            text = text.replace(&format!(" id=\"{id}\""), "");
        }
    }
    text
}

/// The class of a part by its name, as far as it is compared.
fn class(name: &str) -> Option<&'static str> {
    let name = name.to_lowercase();
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    let classes: [(&str, &[&str]); 7] = [
        (
            "",
            &[
                "hair", "ear", "eye", "nose", "mouth", "sleeve", "cloak", "shield", "sword",
            ],
        ),
        ("foot", &["foot", "feet", "shoe", "paw"]),
        ("leg", &["leg", "thigh", "shin"]),
        ("arm", &["arm", "hand"]),
        ("head", &["head", "skull", "face"]),
        ("tail", &["tail"]),
        ("trunk", &["body", "torso", "dress", "hips"]),
    ];
    let found = classes.into_iter().find(|(_, words)| has(words))?.0;
    (!found.is_empty()).then_some(found)
}

/// Per shape of a main part, by its number in the file, its name and the shape of what carries it.
fn parts(compiled: &Compiled) -> BTreeMap<usize, (String, Option<usize>)> {
    let parts = &compiled.bindings.parts;
    let mains = parts.iter().filter(|part| part.kind == PartKind::Main);
    mains
        .map(|part| {
            let parent = part
                .parent
                .map(|parent| compiled.drawing.shapes[parts[parent].shape].leaf);
            let leaf = compiled.drawing.shapes[part.shape].leaf;
            (leaf, (part.name.clone(), parent))
        })
        .collect()
}

fn annotated(text: &str) -> (String, Vec<Edit>) {
    let before = Analysis::new(text, compiled(text));
    let edits = edits(&before, &Change::NameParts).unwrap_or_else(|refusal| panic!("{refusal}"));
    let step = Step::new(Change::NameParts, text, &edits);
    let after = Analysis::new(step.after().clone(), compiled(step.after()));
    check(&before, &after, &Change::NameParts).expect("nothing else changes");
    assert_eq!(
        step.undone(step.after()).map(|edits| edits.len()),
        Some(edits.len())
    );
    (step.after().to_string(), edits)
}

#[test]
fn figures_get_back_the_names_that_their_strings_gave() {
    let (mut named, mut right, mut hung, mut hangs) = (0, 0, 0, 0);
    for figure in FIGURES {
        let original = example(figure);
        let truth = parts(&compiled(&original));
        let text = bare(&original);
        let found = parts(&compiled(&annotated(&text).0));
        for (shape, (name, parent)) in &truth {
            let Some(expected) = class(name) else {
                continue;
            };
            named += 1;
            let got = found.get(shape);
            let is_right = got.is_some_and(|(name, _)| class(name) == Some(expected));
            right += usize::from(is_right);
            hung += 1;
            let hangs_so = got.is_some_and(|(_, got)| got == parent);
            hangs += usize::from(hangs_so);
            if std::env::var_os("OKOSHI_PRINT").is_some() && !(is_right && hangs_so) {
                eprintln!("{figure}: {name} on {parent:?} is {got:?}");
            }
        }
    }
    if std::env::var_os("OKOSHI_PRINT").is_some() {
        eprintln!("{right} of {named} names, {hangs} of {hung} parents");
    }
    assert!(
        right * 100 >= NAMES * named,
        "{right} of {named} names are right"
    );
    assert!(
        hangs * 100 >= PARENTS * hung,
        "{hangs} of {hung} parents are right"
    );
}

/// What was named moves, and each of its parts can be changed, whatever its shapes were drawn as: both shoes in one path, say.
#[test]
fn what_was_named_moves_and_can_be_changed() {
    let art = [
        "fluent-dog",
        "fluent-person-standing",
        "openclipart-blueman-201",
    ];
    let mut pieces = 0;
    for case in art {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases");
        let path = path.join(format!("art-{case}/drawing.svg"));
        let bare = fs::read_to_string(path).expect("a case");
        let (text, _) = annotated(&bare);
        let before = Analysis::new(text.as_str(), compiled(&text));
        let parts = &before.compiled().bindings.parts;
        let mains = || parts.iter().filter(|part| part.kind == PartKind::Main);
        let body = mains().find(|part| part.name == "Body").expect("a body");
        let above = std::iter::successors(Some(body), |part| Some(&parts[part.parent?]));
        let carrier = above.last().expect("the body itself");
        let clip = Change::Clip {
            part: carrier.name.clone(),
            clip: 0,
            motion: Some(String::new()),
            limited: None,
            held: None,
            place: Place::Ask,
        };
        let set = mains().map(|part| Change::Set {
            part: part.name.clone(),
            attribute: Keyword::Offset,
            value: "1".to_owned(),
            place: Place::Ask,
        });
        for change in set.chain([clip]) {
            let edits = edits(&before, &change)
                .unwrap_or_else(|refusal| panic!("{case}: {change:?}: {refusal}"));
            let step = Step::new(change.clone(), &text, &edits);
            let after = Analysis::new(step.after().clone(), compiled(step.after()));
            if let Err(refusal) = check(&before, &after, &change) {
                panic!("{case}: {change:?}: {refusal}");
            }
            assert_eq!(after.compiled().bindings.parts.len(), parts.len());
        }
        pieces += mains().filter(|part| part.name.ends_with("-2")).count();
    }
    assert!(pieces >= 2, "only {pieces} second pieces of paths");
}

/// A bare drawing with labels for some of its shapes, by their numbers in the file.
fn labelled(bare: &str, names: &[(usize, &str)]) -> String {
    let drawing = compiled(bare).drawing;
    let element = |leaf: usize| {
        let shape = drawing.shapes.iter().find(|shape| shape.leaf == leaf);
        shape.expect("a shape").element.span.end
    };
    let mut labels: Vec<(usize, String)> = names
        .iter()
        .map(|(leaf, name)| (element(*leaf), format!(" data-name=\"{name}\"")))
        .collect();
    labels.sort();
    labels.dedup_by_key(|(at, _)| *at);
    let mut text = bare.to_owned();
    for (at, label) in labels.into_iter().rev() {
        text.insert_str(at, &label);
    }
    text
}

/// What only one part of a figure is: its head, its trunk, its left upper arm.
fn role(name: &str) -> Option<String> {
    let class = class(name)?;
    let name = name.to_lowercase();
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    let first = |letter: char| {
        name.strip_prefix(letter).is_some_and(|rest| {
            [
                "arm", "leg", "fore", "hind", "upper", "thigh", "shin", "hand", "foot",
            ]
            .iter()
            .any(|word| rest.starts_with(word))
        })
    };
    let side = match class {
        "head" | "tail" => "",
        "trunk" => {
            return Some(
                if has(&["hips", "lbody"]) {
                    "hips"
                } else {
                    "trunk"
                }
                .to_owned(),
            );
        }
        _ if has(&["left"]) || first('l') => "left",
        _ if has(&["right"]) || first('r') => "right",
        _ => return None,
    };
    let piece = ["forearm", "hand", "shin", "foot", "shoe"];
    let piece = piece.into_iter().find(|piece| name.contains(piece));
    let pair = ["fore leg", "foreleg", "hind"];
    let pair = pair.into_iter().find(|pair| name.contains(pair));
    Some(format!("{side} {class} {piece:?} {pair:?}"))
}

#[test]
fn what_has_a_name_is_not_named_again_elsewhere() {
    let mut added = 0;
    for figure in FIGURES {
        let original = example(figure);
        let bare = bare(&original);
        let truth = parts(&compiled(&original));
        let mut names: Vec<(usize, &str)> = truth
            .iter()
            .filter(|(_, (name, _))| role(name).is_some())
            .map(|(leaf, (name, _))| (*leaf, name.as_str()))
            .collect();
        // Other words mean the same.
        for (_, name) in &mut names {
            match *name {
                "Body" => *name = "Torso",
                "Head" => *name = "Skull",
                _ => (),
            }
        }
        for first in 0..2 {
            let kept: Vec<(usize, &str)> = names.iter().copied().skip(first).step_by(2).collect();
            let text = labelled(&bare, &kept);
            let (new, edits) = annotated(&text);
            assert!(
                edits.iter().all(|edit| edit.span.start == edit.span.end),
                "{figure}: {edits:?}"
            );
            for (_, name) in &kept {
                let label = format!(" data-name=\"{name}\"");
                assert!(new.contains(&label), "{figure}: {name} is lost");
            }
            let taken: Vec<String> = kept.iter().filter_map(|(_, name)| role(name)).collect();
            let old = parts(&compiled(&text));
            for (leaf, (name, _)) in &parts(&compiled(&new)) {
                let is_new = old.get(leaf).is_none_or(|(old, _)| old != name);
                if let Some(role) = role(name).filter(|_| is_new) {
                    assert!(
                        !taken.contains(&role),
                        "{figure} with {kept:?}: {name} is a second {role}"
                    );
                    added += 1;
                }
            }
        }
    }
    if std::env::var_os("OKOSHI_PRINT").is_some() {
        eprintln!("{added} names beside others");
    }
    assert!(added > ADDED, "only {added} names were added");
}

#[test]
fn only_labels_are_added() {
    let text = bare(&example("doll"));
    let (after, edits) = annotated(&text);
    assert!(edits.iter().all(|edit| edit.span.start == edit.span.end));
    let mut back = after;
    for edit in edits.iter().rev() {
        let at = back.rfind(&edit.text).expect("the label");
        back.replace_range(at..at + edit.text.len(), "");
    }
    assert_eq!(back, text);
}

/// The names of an annotated drawing's parts, each with that of what carries it.
fn carriers(text: &str) -> BTreeMap<String, String> {
    let (text, _) = annotated(text);
    let compiled = compiled(&text);
    let parts = &compiled.bindings.parts;
    let main = parts.iter().filter(|part| part.kind == PartKind::Main);
    main.map(|part| {
        let parent = part.parent.map_or("Root", |parent| &parts[parent].name);
        (part.name.clone(), parent.to_owned())
    })
    .collect()
}

/// A man before his cape, with both hands in one shape.
const HERO: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 300">
  <path fill="#a01030" d="M70 95H130L165 260H35Z"/>
  <path fill="#203070" d="M76 180H98V282H74Z"/>
  <path fill="#203070" d="M102 180H124L126 282H102Z"/>
  <path fill="#f0c090" d="M40 168h18v20h-18zM142 168h18v20h-18z"/>
  <path fill="#3050a0" d="M72 95H128L124 190H76Z"/>
  <path fill="#3050a0" d="M74 98L60 172H42L56 100Z"/>
  <path fill="#3050a0" d="M126 98L140 172H158L144 100Z"/>
  <circle fill="#f0c090" cx="100" cy="62" r="34"/>
  <path fill="#201008" d="M86 56h7v8h-7zM107 56h7v8h-7z"/>
</svg>
"##;

/// A stag in profile, whose far legs are one shape with the shadow on its chest.
const STAG: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 300 240">
  <path fill="#a06030" d="M84 150h16v78h-16zM206 150h16v78h-16zM62 92h26v60h-26z"/>
  <path fill="#d09050" d="M20 70L60 50L88 60L100 100H250L262 228H246L236 160H120L112 228H96L78 150Z"/>
  <path fill="#503010" d="M60 60L56 6h6L68 30L90 4h6L74 62Z"/>
  <circle fill="#100804" cx="52" cy="70" r="5"/>
  <path fill="#100804" d="M12 66h14v12h-14z"/>
</svg>
"##;

#[test]
fn what_is_worn_or_grows_on_a_head_is_no_limb() {
    let hero = carriers(HERO);
    for (name, parent) in [
        ("Cape", "Body"),
        ("Lleg", "Body"),
        ("Rleg", "Body"),
        ("Larm", "Body"),
        ("Rarm", "Body"),
        ("Head", "Body"),
    ] {
        assert_eq!(hero.get(name).map(String::as_str), Some(parent), "{hero:?}");
    }
    assert!(hero.contains_key("Hands"), "{hero:?}");

    let stag = carriers(STAG);
    for name in ["Body", "Far legs", "Horns", "Mouth", "Eye"] {
        assert!(stag.contains_key(name), "{name} in {stag:?}");
    }
    let arms = stag.keys().filter(|name| class(name) == Some("arm"));
    assert_eq!(arms.count(), 0, "{stag:?}");
}

/// A man whose jacket is drawn as two halves, each with its sleeve, over a shirt.
const DANCER: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 300">
  <path fill="#203070" d="M76 180H98V282H74Z"/>
  <path fill="#203070" d="M102 180H124L126 282H102Z"/>
  <path fill="#e06020" d="M80 95H120V192H80Z"/>
  <path fill="#2080c0" d="M90 96L94 192H60L62 140L38 176L24 162L60 98Z"/>
  <path fill="#2080c0" d="M110 96L106 192H140L138 140L162 176L176 162L140 98Z"/>
  <circle fill="#f0c090" cx="100" cy="62" r="34"/>
  <path fill="#201008" d="M86 56h7v8h-7zM107 56h7v8h-7z"/>
</svg>
"##;

/// A woman with a hat, whose ears are a band behind the face, and whose lapels are as long as her sleeves.
const BUST: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 220">
  <path fill="#503020" d="M30 20H170V150H30Z"/>
  <path fill="#3050a0" d="M30 170H170L190 220H10Z"/>
  <path fill="#504080" d="M24 185H44V220H10ZM156 185H176L190 220H156Z"/>
  <path fill="#d0d0f0" d="M60 170L90 220H74L40 178ZM140 170L110 220H126L160 178Z"/>
  <path fill="#e0a060" d="M88 140H112V180H88Z"/>
  <path fill="#e0a060" d="M38 80H162V110H38Z"/>
  <ellipse fill="#f0c090" cx="100" cy="95" rx="55" ry="62"/>
  <path fill="#201008" d="M76 86h9v11h-9zM115 86h9v11h-9z"/>
  <path fill="#102040" d="M40 40H160V66H40Z"/>
  <path fill="#406080" d="M30 66H170V74H30Z"/>
</svg>
"##;

/// A man who squats below a bar with weights.
const LIFTER: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 240 260">
  <path fill="#402040" d="M60 236H96V250H60ZM144 236H180V250H144Z"/>
  <path fill="#f0c090" d="M56 30H74L104 92L88 102ZM184 30H166L136 92L152 102Z"/>
  <path fill="#2090d0" d="M84 88H156V170H84Z"/>
  <path fill="#909090" d="M70 170H170V190L150 206H90L70 190Z"/>
  <path fill="#f0c090" d="M72 190H92V236H72ZM148 190H168V236H148Z"/>
  <path fill="#808080" d="M20 18H220V26H20Z"/>
  <path fill="#402040" d="M66 150H96V192H66ZM144 150H174V192H144Z"/>
  <path fill="#f0b080" d="M54 16H76V32H54ZM164 16H186V32H164Z"/>
  <path fill="#302040" d="M14 2H36V44H14ZM204 2H226V44H204Z"/>
  <path fill="#f0c090" d="M98 62H142V116H98Z"/>
  <path fill="#201008" d="M108 84h7v8h-7zM125 84h7v8h-7z"/>
</svg>
"##;

/// A snowman in one shape, with his outline behind him.
const SNOWMAN: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 260">
  <path fill="#c0c0d0" d="M100 24C150 24 164 90 140 108C190 130 190 250 150 250H50C10 250 10 130 60 108C36 90 50 24 100 24Z"/>
  <path fill="#503020" d="M14 96L24 90L66 130L58 138ZM186 96L176 90L134 130L142 138Z"/>
  <path fill="#ffffff" d="M100 32C142 32 154 90 130 108C176 130 176 244 146 244H54C24 244 24 130 70 108C46 90 58 32 100 32Z"/>
  <path fill="#2050c0" d="M60 108H140V126H60Z"/>
  <path fill="#302040" d="M66 14H134V36H66Z"/>
  <path fill="#201008" d="M84 58h8v10h-8zM108 58h8v10h-8z"/>
</svg>
"##;

/// A fairy whose arms are one shape with her body, and whose wings are one shape behind it.
const FAIRY: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 240 300">
  <path fill="#80e0f0" d="M120 120L60 60L40 110L70 150L64 190L120 150L176 190L170 150L200 110L180 60Z"/>
  <path fill="#e0a060" d="M98 110H150L214 128V142L142 136L140 196L138 290H122L120 200L116 290H102L98 196L100 136L30 142V128Z"/>
  <path fill="#8060c0" d="M98 112H142L140 196H100Z"/>
  <circle fill="#f0c090" cx="120" cy="76" r="34"/>
  <path fill="#201008" d="M106 70h7v8h-7zM127 70h7v8h-7z"/>
</svg>
"##;

/// A man in profile, whose near leg hides the far one.
const WALKER: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 320">
  <circle fill="#f0c090" cx="92" cy="50" r="36"/>
  <circle fill="#201008" cx="72" cy="48" r="5"/>
  <path fill="#505050" d="M84 180H116L156 280L138 292Z"/>
  <path fill="#707070" d="M80 180H114L100 292H78Z"/>
  <path fill="#10a080" d="M78 84H118V186H78Z"/>
  <path fill="#3050a0" d="M60 288H102V306H60Z"/>
  <path fill="#304080" d="M138 288H170V306H132Z"/>
</svg>
"##;

/// A cow in profile, with a mane, an udder, and a nostril on its muzzle.
const COW: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 300 240">
  <path fill="#909090" d="M104 150h14v78h-14zM206 150h14v78h-14z"/>
  <path fill="#f08080" d="M158 140H206V188H170Z"/>
  <path fill="#604020" d="M64 24L84 16L112 76L96 96Z"/>
  <path fill="#d0d0d0" d="M20 70L60 40L88 60L100 90H250L262 228H246L236 160H120L112 228H96L78 150L20 104Z"/>
  <path fill="#f0a0a0" d="M10 78H44V108H16Z"/>
  <circle fill="#100804" cx="62" cy="62" r="5"/>
  <circle fill="#401010" cx="22" cy="90" r="4"/>
</svg>
"##;

/// Asserts that parts hang on others.
fn assert_hang(text: &str, expected: &[(&str, &str)]) -> BTreeMap<String, String> {
    let found = carriers(text);
    for (name, parent) in expected {
        let got = found.get(*name).map(String::as_str);
        assert_eq!(got, Some(*parent), "{name} in {found:?}");
    }
    found
}

#[test]
fn a_shirt_between_the_halves_of_a_jacket_is_the_body() {
    let limbs = ["Larm", "Rarm", "Lleg", "Rleg", "Head"];
    assert_hang(DANCER, &limbs.map(|limb| (limb, "Body")));
}

#[test]
fn ears_in_one_shape_hang_on_the_head_and_hair_does_not_hang_on_them() {
    assert_hang(
        BUST,
        &[
            ("Ears", "Head"),
            ("Hair", "Head"),
            ("Hat", "Head"),
            ("Head", "Neck"),
        ],
    );
    // Lapels are nearer to each other than sleeves, and not at both sides.
    let (text, _) = annotated(BUST);
    assert!(
        text.contains(r##"data-name="Arms" fill="#504080""##),
        "{text}"
    );
}

#[test]
fn arms_are_raised_and_legs_stand_in_shoes() {
    let found = assert_hang(
        LIFTER,
        &[
            ("Arms", "Body"),
            ("Arms-2", "Body"),
            ("Hands", "Arms"),
            ("Shoes", "Legs"),
        ],
    );
    assert!(
        !found.contains_key("Hair") && !found.contains_key("Hat"),
        "{found:?}"
    );
    // The weights are beside the hands, but lie on the bar.
    let (text, _) = annotated(LIFTER);
    let compiled = compiled(&text);
    let parts = &compiled.bindings.parts;
    let of = |leaf: usize| {
        let part = parts
            .iter()
            .find(|part| compiled.drawing.shapes[part.shape].leaf == leaf);
        part.expect("a part")
    };
    assert_eq!(
        of(8).parent.map(|parent| parts[parent].name.clone()),
        Some(of(5).name.clone())
    );
}

/// Somebody whose shirt hangs over trousers, which part below the hips, or are a skirt with a notch in its hem.
const STANDING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 240">
  <path fill="#335588" d="M68 120h64l6 94h-26l-12-60l-12 60h-26z"/>
  <path fill="#e0b080" d="M40 70h25v60h-18z M160 70h-25v60h18z"/>
  <path fill="#aa3344" d="M65 60h70v80h-70z"/>
  <path fill="#222222" d="M58 212h30v18h-36z M142 212h-30v18h36z"/>
  <circle fill="#e0b080" cx="100" cy="40" r="25"/>
  <path fill="#302020" d="M88 36h6v6h-6z M106 36h6v6h-6z"/>
</svg>
"##;

#[test]
fn trousers_in_one_piece_are_legs_and_a_skirt_is_not() {
    let legs = [("Legs", "Body"), ("Legs-2", "Body")];
    let shoes = [("Shoes", "Legs"), ("Shoes-2", "Legs-2")];
    assert_hang(STANDING, &[legs, shoes].concat());
    let skirt = STANDING.replace("l-12-60l-12 60h", "l-12-10l-12 10h");
    assert_ne!(skirt, STANDING);
    let found = carriers(&skirt);
    assert!(
        !found.keys().any(|name| class(name) == Some("leg")),
        "{found:?}"
    );
}

#[test]
fn a_snowman_is_a_body_with_eyes() {
    let found = assert_hang(SNOWMAN, &[("Body", "Root"), ("Eyes", "Body")]);
    // Neither his outline nor his hat is a leg.
    assert!(
        !found.keys().any(|name| class(name) == Some("leg")),
        "{found:?}"
    );
    assert!(!found.contains_key("Head"), "{found:?}");
}

#[test]
fn wings_behind_the_body_are_no_arm() {
    let found = assert_hang(FAIRY, &[("Body", "Root"), ("Head", "Body")]);
    assert!(
        !found.keys().any(|name| class(name) == Some("arm")),
        "{found:?}"
    );
}

#[test]
fn the_near_leg_of_a_walker_is_not_the_hips() {
    let legs = [
        ("Lleg", "Body"),
        ("Rleg", "Body"),
        ("Lfoot", "Lleg"),
        ("Rfoot", "Rleg"),
    ];
    assert_hang(WALKER, &legs);
}

#[test]
fn manes_udders_and_nostrils_are_neither_limbs_nor_mouths() {
    // Without a head, the face hangs on the body.
    let found = assert_hang(
        COW,
        &[("Mouth", "Body"), ("Eye", "Body"), ("Far legs", "Body")],
    );
    let others = found
        .keys()
        .filter(|name| matches!(class(name), Some("arm" | "tail")));
    assert_eq!(others.count(), 0, "{found:?}");
    assert!(!found.contains_key("Mouth-2"), "{found:?}");
}

const PEBBLES: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">
  <rect x="10" y="10" width="20" height="30" fill="#a00"/>
  <rect x="60" y="50" width="30" height="20" fill="#0a0"/>
</svg>
"##;

#[test]
fn a_drawing_without_a_figure_stays_as_it_is() {
    let room = Room::with("pebbles.svg", PEBBLES);
    let run = room.run(&["annotate", "pebbles.svg"]);
    assert_eq!(run.status, 1, "{}", run.err);
    assert!(
        run.err.contains("stays as it is") && run.err.contains("name at least two parts"),
        "{}",
        run.err
    );
    assert_eq!(room.read("pebbles.svg"), PEBBLES.as_bytes());
    assert_eq!(room.files(), ["pebbles.svg"]);
}

#[test]
fn the_program_lists_the_names_and_loses_no_drawing() {
    let text = bare(&example("doll"));
    let room = Room::with("doll.svg", &text);
    room.write("other.svg", PEBBLES);
    let run = room.run(&["annotate", "doll.svg", "-o", "other.svg"]);
    assert_eq!(run.status, 2, "a drawing would be lost: {}", run.err);
    assert_eq!(room.read("other.svg"), PEBBLES.as_bytes());

    let run = room.run(&["annotate", "doll.svg", "-o", "me.svg"]);
    assert_eq!(run.status, 0, "{}", run.err);
    assert!(run.out.contains("Head@"), "{}", run.out);
    assert_eq!(room.read("doll.svg"), text.as_bytes());

    let run = room.run(&["annotate", "doll.svg", "--json"]);
    let listed: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    let parts = listed["parts"].as_array().expect("parts");
    let head = parts
        .iter()
        .find(|part| part["name"] == "Head")
        .expect("a head");
    assert!(head["certainty"].is_string() && head["why"].is_string() && head["line"].is_u64());
    // Without -o the drawing itself gets the names.
    assert_eq!(room.read("doll.svg"), room.read("me.svg"));
}
