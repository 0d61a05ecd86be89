//! Clips in strings.

use super::*;

fn clip(part: &str, clip: usize, motion: Option<&str>, limited: Option<&str>) -> Change {
    Change::Clip {
        part: part.to_owned(),
        clip,
        motion: motion.map(str::to_owned),
        limited: limited.map(str::to_owned),
        held: None,
        place: Place::Ask,
    }
}

#[test]
fn clips_are_written_where_they_are_said_and_new_ones_at_the_part_that_carries_the_figure() {
    let strings = |body, defaults| figure([body, "Rarm@Body", "", "", defaults]);
    for ([body, defaults], change, after) in [
        (
            ["Body$Shape round", ""],
            clip("Rarm", 0, Some("walk"), None),
            ["Body$Shape round Motion walk", ""],
        ),
        (
            ["Body$Shape round", ""],
            clip("Body", 0, Some(""), Some("4 30")),
            ["Body$Shape round Motion Limited 4 30", ""],
        ),
        (
            ["Body", "%Scale 2 Motion walk 3 stroll Color red"],
            clip("Rarm", 0, Some("-i walk 4 stroll"), Some("2 8")),
            [
                "Body",
                "%Scale 2 Motion -i walk 4 stroll Limited 2 8 Color red",
            ],
        ),
        (
            ["Body$Motion walk Color red Limited 2 8 Motion run", ""],
            clip("Body", 0, Some("hop"), Some("2 9")),
            ["Body$Motion hop Color red Limited 2 9 Motion run", ""],
        ),
        (
            ["Body$Motion walk Limited 2 8 Motion run", ""],
            clip("Body", 0, Some("walk"), None),
            ["Body$Motion walk Motion run", ""],
        ),
        (
            ["Body$Motion walk Color red Limited 2 8 Motion run", ""],
            clip("Body", 0, None, None),
            ["Body$Color red Motion run", ""],
        ),
        (
            ["Body$Motion walk", "%Motion run"],
            clip("Body", 1, Some("sneak speed 0.5"), None),
            ["Body$Motion walk", "%Motion sneak speed 0.5"],
        ),
        (
            ["Body$Motion walk", ""],
            clip("Body", 1, Some("run"), None),
            ["Body$Motion walk Motion run", ""],
        ),
        (
            ["Body$Motion walk", ""],
            clip("Body", 0, None, None),
            ["Body", ""],
        ),
    ] {
        let text = made(&strings(body, defaults), &change).unwrap();
        assert_eq!(text, strings(after[0], after[1]), "{body} {defaults}");
    }
    // A text that says nothing any more goes.
    let text = made(
        &strings("Body", "%Motion walk"),
        &clip("Body", 0, None, None),
    )
    .unwrap();
    assert_eq!(text.replace("\n\n", "\n"), strings("Body", ""));
    // A part without a string gets one, and stays where it hangs.
    let bare = figure(["", "Rarm@body", "Larm@body", "", ""]);
    let text = made(&bare, &clip("Rarm", 0, Some("walk"), None)).unwrap();
    assert!(text.contains("<desc>$Motion walk</desc></rect>"), "{text}");
}

#[test]
fn drawings_that_are_chosen_by_hand_stand_behind_what_limits_the_clip() {
    let strings = |body: &str| figure([body, "Rarm@Body", "", "", ""]);
    let change =
        |limited: Option<&str>, held: Option<&str>| match clip("Body", 0, Some("walk"), limited) {
            Change::Clip {
                part,
                clip,
                motion,
                limited,
                place,
                ..
            } => Change::Clip {
                part,
                clip,
                motion,
                limited,
                held: held.map(str::to_owned),
                place,
            },
            other => other,
        };
    for (before, limited, held, after) in [
        ("walk", None, Some("3 2"), "walk Held 3 2"),
        (
            "walk Color red",
            Some("0 4"),
            Some("3 2"),
            "walk Limited 0 4 Held 3 2 Color red",
        ),
        (
            "walk Limited 0 4 Motion run",
            Some("0 4"),
            Some("3 2 7 0"),
            "walk Limited 0 4 Held 3 2 7 0 Motion run",
        ),
        (
            "walk Limited 0 4 Motion run",
            None,
            Some("3 2"),
            "walk Held 3 2 Motion run",
        ),
        (
            "walk Held 3 2",
            Some("0 4"),
            Some("3 2"),
            "walk Limited 0 4 Held 3 2",
        ),
        (
            "walk Limited 0 4 Held 3 2 7 0 Color red",
            Some("0 4"),
            Some("3 2"),
            "walk Limited 0 4 Held 3 2 Color red",
        ),
        (
            "walk Limited 0 4 Held 3 2 Color red",
            None,
            None,
            "walk Color red",
        ),
    ] {
        let before = strings(&format!("Body$Motion {before}"));
        let text = made(&before, &change(limited, held)).unwrap();
        assert_eq!(text, strings(&format!("Body$Motion {after}")), "{before}");
    }
    let drawing = strings("Body$Held 4 2 Motion walk stroll Motion run Held 3 2");
    let (analysis, _) = analysis(&drawing);
    let clips = analysis.form("Body").unwrap().motion.unwrap().clips;
    let said = |clip: &super::super::clips::ClipForm| {
        let held = &clip.held;
        (
            clip.plays.as_ref().map(|clip| clip.name.clone()),
            held.value.clone(),
            held.from,
        )
    };
    assert_eq!(
        clips.iter().map(said).collect::<Vec<_>>(),
        [
            (Some("stroll".to_owned()), Some("4 2".to_owned()), "default"),
            (Some("run".to_owned()), Some("3 2".to_owned()), "own")
        ]
    );
}

#[test]
fn clips_that_others_play_or_that_are_calculated_are_asked_about() {
    let bodies = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 100\">\n\
        <rect id=\"a\" x=\"10\" y=\"20\" width=\"30\" height=\"60\" fill=\"#336699\"/>\n\
        <rect id=\"b\" x=\"120\" y=\"20\" width=\"30\" height=\"60\" fill=\"#336699\"/>\n\
        <text x=\"25\" y=\"54\" font-size=\"5\">Ann@Root</text>\n\
        <text x=\"135\" y=\"54\" font-size=\"5\">Bob@Root</text>\n\
        <text x=\"2\" y=\"98\" font-size=\"5\">%Motion hop</text>\n</svg>\n";
    let refusal = made(bodies, &clip("Bob", 0, Some("sway"), None)).unwrap_err();
    assert_eq!(
        refusal.why,
        "`%Motion hop` is for all 2 figures of the drawing"
    );
    let [choice] = refusal.choices.as_slice() else {
        panic!("{refusal:?}");
    };
    assert_eq!(choice.title, "Change it for all 2");
    let text = made(bodies, &choice.change).unwrap();
    assert_eq!(text, bodies.replace("hop", "sway"));
    // One of its own is nobody else's business.
    let text = made(bodies, &clip("Bob", 1, Some("sway"), None)).unwrap();
    assert_eq!(text, bodies.replace("Bob@Root", "Bob@Root$Motion sway"));

    let calculated = figure([
        "Body$Motion walk speed (w / 8)",
        "Rarm@Body",
        "",
        "",
        "%Let w 4",
    ]);
    let same = made(&calculated, &clip("Body", 0, Some("run speed 0.5"), None)).unwrap();
    assert_eq!(same, calculated.replace("walk", "run"));
    let refusal = made(&calculated, &clip("Body", 0, Some("walk speed 2"), None)).unwrap_err();
    assert_eq!(
        refusal.why,
        "`(w / 8)` is calculated, and would be replaced"
    );
    assert_eq!(
        refusal.choices[0].title,
        "Change `w` to 16, which is used here alone"
    );

    for (motion, why) in [
        ("walk Color red", "more than one value"),
        ("wlak", "`wlak`"),
    ] {
        let refusal = made(&calculated, &clip("Body", 0, Some(motion), None)).unwrap_err();
        assert!(refusal.why.contains(why), "{refusal:?}");
    }
}

#[test]
fn the_form_says_which_part_of_a_file_is_played() {
    let drawing = figure([
        "Body$Motion -l \"kick.bvh\" high +z from 0.1 to 0.4 speed 2",
        "Rarm@Body",
        "",
        "",
        "",
    ]);
    let (analysis, _) = analysis(&drawing);
    let form = analysis.form("Body").unwrap();
    let form = form.with_motion_files(vec!["walk.bvh".to_owned()]);
    let motion = form.motion.unwrap();
    assert_eq!(motion.files, ["walk.bvh"]);
    let clip = &motion.clips[0];
    assert_eq!(
        (
            clip.word.as_deref(),
            clip.file.as_deref(),
            clip.up.as_deref()
        ),
        (None, Some("kick.bvh"), Some("+z"))
    );
    let numbers = [&clip.seconds, &clip.start, &clip.end, &clip.speed];
    assert_eq!(
        numbers.map(|number| number.value.as_deref()),
        [None, Some("0.1"), Some("0.4"), Some("2")]
    );
    assert_eq!(motion.new.file, None);
}

#[test]
fn the_form_says_what_a_figure_plays() {
    let drawing = figure([
        "Body$Motion -i walk 3 speed 0.5 stroll Limited 2 8 Motion \"kick.bvh\" from 1",
        "Rarm@Body",
        "",
        "",
        "%Motion Limited 4 30",
    ]);
    let (analysis, _) = analysis(&drawing);
    let form = analysis.form("Rarm").unwrap().motion.unwrap();
    assert_eq!(form.figure, "Body");
    assert!(form.choices.iter().any(|[word, _]| *word == "walk"));
    let told: Vec<_> = form
        .clips
        .iter()
        .map(|clip| {
            let number = |field: &form::ArgumentField| field.value.clone().unwrap_or_default();
            let on = clip
                .flags
                .iter()
                .filter(|flag| flag.on)
                .map(|flag| flag.letter);
            (
                clip.words.as_deref().unwrap_or_default(),
                clip.word.as_deref(),
                clip.name.as_deref(),
                [number(&clip.seconds), number(&clip.speed)],
                on.collect::<String>(),
                clip.limited.value.as_deref(),
                [clip.from, clip.limited.from],
            )
        })
        .collect();
    let none = || [String::new(), String::new()];
    assert_eq!(
        told,
        [
            (
                "-i walk 3 speed 0.5 stroll",
                Some("walk"),
                Some("stroll"),
                ["3".to_owned(), "0.5".to_owned()],
                "i".to_owned(),
                Some("2 8"),
                ["own", "own"],
            ),
            (
                "\"kick.bvh\" from 1",
                None,
                None,
                none(),
                String::new(),
                None,
                ["own", "builtin"]
            ),
            (
                "",
                Some(""),
                None,
                none(),
                String::new(),
                Some("4 30"),
                ["default", "own"]
            ),
        ]
    );
}

#[test]
fn a_clip_is_known_by_the_part_that_the_motion_moves_as_the_root() {
    let drawing = include_str!("../../../../examples/human.svg");
    let drawing = drawing.replace(">Ubody<", ">Ubody$Motion wave<");
    let (analysis, _) = analysis(&drawing);
    for part in ["Ubody", "Lbody", "Rarm"] {
        let motion = analysis.form(part).unwrap().motion.unwrap();
        assert_eq!(motion.figure, "Ubody", "a new clip is said there");
        let [clip] = motion.clips.as_slice() else {
            panic!("{:?}", motion.clips);
        };
        let played = clip.plays.as_ref().unwrap();
        let clip = &analysis.compiled().clips[0];
        let root = &analysis.bindings().parts[clip.root].name;
        assert_eq!((&played.name, &played.root), (&clip.name, root));
        assert_eq!(root, "Lbody", "the hips");
    }
}
