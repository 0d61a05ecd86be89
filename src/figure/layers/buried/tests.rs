use crate::compile::{Compiled, Options, compile};
use crate::diagnostic::{Code, Diagnostic, applied};
use crate::resolver::MemoryResolver;

fn compiled(source: &str) -> Compiled {
    compile(source, &Options::default(), &MemoryResolver::default())
}

fn hints(compiled: &Compiled) -> Vec<&Diagnostic> {
    let all = compiled.diagnostics.iter();
    all.filter(|found| found.code == Code::Buried).collect()
}

/// A drawing of these shapes, each with its string.
fn drawing(shapes: &[(&str, &str)]) -> String {
    let head = "<svg xmlns='http://www.w3.org/2000/svg' width='400' height='400'>";
    let shape = |(shape, string): &(&str, &str)| format!("{shape}<desc>{string}</desc></g>");
    let shapes: String = shapes.iter().map(shape).collect();
    format!("{head}{shapes}</svg>")
}

const BODY: &str = "<g><circle cx='200' cy='200' r='120' fill='#48c'/>";
const EYE: &str = "<g><circle cx='200' cy='200' r='20' fill='#222'/>";
const ARM: &str = "<g><rect x='200' y='180' width='190' height='40' fill='#fc9'/>";
const HAND: &str = "<g><circle cx='210' cy='200' r='40' fill='#f96'/>";
const PATCH: &str = "<g><circle cx='200' cy='200' r='30' fill='#282'/>";

#[track_caller]
fn check(shapes: &[(&str, &str)], expected: &[&str]) {
    let compiled = compiled(&drawing(shapes));
    let hints = hints(&compiled);
    let messages: Vec<&str> = hints.iter().map(|hint| hint.message.as_str()).collect();
    assert_eq!(messages, expected);
}

#[test]
fn a_depth_that_hides_its_own_part_is_reported() {
    for string in ["Eye@Body$Shape default -5 5", "Eye@Body$Offset -40"] {
        let hidden = "100 % of `Eye` is hidden by `Body`, although it is drawn later";
        check(
            &[(BODY, "Body$Shape default -20 20"), (EYE, string)],
            &[hidden],
        );
    }
    check(
        &[(BODY, "Body$Shape default -20 20"), (EYE, "Eye@Body")],
        &[],
    );
    check(
        &[
            (BODY, "Body$Shape default -20 20"),
            (EYE, "Eye@Body$Shape default 0 25"),
        ],
        &[],
    );
}

#[test]
fn a_depth_that_hides_other_parts_is_reported() {
    // What is round and does not hang on the body keeps its volume beside it.
    let other = "<g><rect x='190' y='10' width='60' height='380' fill='#fc9'/>";
    let shapes = [(BODY, "Body$Offset 90"), (other, "Pole$Shape inflate 10")];
    check(
        &shapes,
        &["62 % of `Pole` is hidden by `Body`, although it is drawn later"],
    );
}

#[test]
fn what_hangs_on_a_part_that_is_moved_away_is_reported_with_it() {
    check(
        &[
            (BODY, "Wall$Shape default -20 20"),
            (ARM, "Arm$Offset -90"),
            (HAND, "Hand@Arm$Shape inflate 10"),
        ],
        &["100 % of `Hand` and 50 % of `Arm` are hidden by `Wall`, although they are drawn later"],
    );
}

#[test]
fn what_is_drawn_over_is_not_missed() {
    let shapes = [
        (BODY, "Body$Shape default -20 20"),
        (EYE, "Eye@Body$Shape default -5 5"),
        (PATCH, "Patch@Body"),
    ];
    check(&shapes, &[]);
}

#[test]
fn what_is_behind_glass_is_seen() {
    let glass = "<g><circle cx='200' cy='200' r='120' fill='#48c' fill-opacity='.5'/>";
    let shapes = [
        (glass, "Body$Shape default -20 20"),
        (EYE, "Eye@Body$Shape default -5 5"),
    ];
    check(&shapes, &[]);
}

#[test]
fn a_copy_in_front_counts() {
    let string = "Eye@Body$Shape -d default -30 -25";
    check(&[(BODY, "Body$Shape default -20 20"), (EYE, string)], &[]);
}

#[test]
fn a_speck_is_not_reported() {
    let speck = "<g><circle cx='200' cy='200' r='3' fill='#222'/>";
    let shapes = [
        (BODY, "Body$Shape default -20 20"),
        (speck, "Eye@Body$Offset -30"),
    ];
    check(&shapes, &[]);
}

#[test]
fn a_detail_that_floats_is_reported() {
    check(
        &[
            (BODY, "Body$Shape default -20 20"),
            (EYE, "Eye@Body$Shape default 60 65"),
        ],
        &["`Eye` floats 40.0 in front of `Body`, on which it is drawn"],
    );
    let near = "Eye@Body$Shape default 24 30";
    check(&[(BODY, "Body$Shape default -20 20"), (EYE, near)], &[]);
}

#[test]
fn the_fix_brings_parts_to_the_front() {
    for string in [
        "Eye@Body$Shape default -5 5",
        "Eye@Body$Offset -40",
        "Eye@Body$Shape default 60 65 Color red",
        "Eye@Body$Shape inflate 3 Offset -2",
    ] {
        let source = drawing(&[(BODY, "Body$Shape default -20 20"), (EYE, string)]);
        let before = compiled(&source);
        let edits = &hints(&before)[0].fixes[0].edits;
        let after = compiled(&applied(&source, edits));
        assert!(hints(&after).is_empty(), "{string}");
    }
}
