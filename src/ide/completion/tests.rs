use super::super::fixtures::{analysis, figure, moving};
use super::choice::MAX_LISTED;
use super::snippets::example_arguments;
use super::*;
use crate::lang::keyword::signature::Form;

fn proposed(source: &str) -> Option<(String, Vec<Proposal>)> {
    let (analysis, at) = analysis(source);
    let files = || {
        vec![
            "a.png".to_owned(),
            "b/c d.glb".to_owned(),
            "e.txt".to_owned(),
            "f.csv".to_owned(),
        ]
    };
    let context = Context {
        source: &analysis.source().clone(),
        analysis: &analysis,
        files: &files,
    };
    let found = completion(&context, at)?;
    let replaced = analysis.source()[found.span.start..found.span.end].to_owned();
    Some((replaced, found.proposals))
}

fn labels(string: &str) -> (String, Vec<String>) {
    let source = figure(["Body", string, "Larm@Rarm", "", "%Let wide 12"]);
    let (replaced, proposals) = proposed(&source).unwrap();
    (
        replaced,
        proposals
            .into_iter()
            .map(|proposal| proposal.label)
            .collect(),
    )
}

#[test]
fn a_part_and_its_descendants_cannot_be_its_parent() {
    assert_eq!(labels("Rarm@¦"), (String::new(), vec!["Body".to_owned()]));
    assert_eq!(labels("Rarm@Bo¦dx$Shape round").0, "Bodx");
}

#[test]
fn keywords_are_proposed_where_allowed() {
    let (replaced, found) = labels("Rarm@Body$Sh¦");
    assert_eq!(replaced, "Sh");
    assert!(found.contains(&"Shape".to_owned()) && !found.contains(&"Scale".to_owned()));
    let (_, found) = labels("Rarm@Body$Offset 3 ¦");
    assert!(!found.contains(&"Offset".to_owned()) && found.contains(&"Shape".to_owned()));
    let (_, found) = labels("%¦");
    assert!(found.contains(&"Scale".to_owned()) && found.contains(&"Shape".to_owned()));
    // A required argument is proposed alone.
    let (_, found) = labels("Rarm@Body$Offset ¦");
    assert_eq!(found, ["wide"]);
}

#[test]
fn every_motion_can_have_its_limits() {
    let has = |string: &str, word: &str| labels(string).1.contains(&word.to_owned());
    assert!(has("%Motion walk Limited 0 2 Motion run ¦", "Limited"));
    assert!(!has("%Motion walk Limited 0 2 ¦", "Limited"));
    assert!(has(
        "%Motion walk Perform \"f.csv\" Motion run ¦",
        "Perform"
    ));
    assert!(!has("%Motion walk Perform \"f.csv\" red ¦", "Perform"));
}

#[test]
fn the_marks_of_the_drawing_are_proposed_behind_a_track() {
    let drawing = |string: &str| {
        let parts = ["Body", "Rarm@Body$Mark #FF0000", "Larm@Body$Mark blue"];
        figure([parts[0], parts[1], parts[2], "", string])
    };
    let (_, found) = proposed(&drawing("%Motion walk Perform \"f.csv\" ¦")).unwrap();
    let marks: Vec<_> = found
        .iter()
        .filter(|proposal| proposal.kind == ProposalKind::Color)
        .map(|proposal| (proposal.text.as_str(), proposal.detail.as_str()))
        .collect();
    let expected = [
        ("\"#ff0000\"", "the mark of Rarm"),
        ("blue", "the mark of Larm"),
    ];
    assert_eq!(marks, expected);
    let (replaced, found) = proposed(&drawing("%Motion walk Perform \"f.csv\" bl¦")).unwrap();
    assert_eq!(replaced, "bl");
    assert!(found.iter().any(|proposal| proposal.label == "blue"));
}

#[test]
fn follow_can_name_descendants() {
    let has = |string: &str, name: &str| labels(string).1.contains(&name.to_owned());
    assert!(has("Rarm@Body$Mark red Follow ¦", "Larm"));
    assert!(!has("Rarm@Body$Mark red Follow ¦", "Rarm"));
}

#[test]
fn arguments_fit_their_parameter() {
    for (string, expected) in [
        ("Rarm@Body$Motion ¦", "walk"),
        ("Rarm@Body$Motion ¦", "-l"),
        ("Rarm@Body$Motion -l wa¦", "walk"),
        ("Rarm@Body$Motion \"a.bvh\" ¦", "+z"),
        ("Rarm@Body$Motion \"a.bvh\" ¦", "from"),
        ("Rarm@Body$Motion \"a.bvh\" from 1 ¦", "to"),
        ("Rarm@Body$Motion \"a.bvh\" from 1 to ¦", "wide"),
        ("Rarm@Body$Motion walk 2 wa¦", "wave"),
        ("Rarm@Body$Motion walk 2 ¦", "speed"),
        ("Rarm@Body$Motion walk 2 ¦", "Limited"),
        ("Rarm@Body$Motion \"a.bvh\" crawl ¦", "-x"),
        ("Rarm@Body$Shape ¦", "inflate"),
        ("Rarm@Body$Shape ¦", "-d"),
        ("Rarm@Body$Shape -¦", "-s"),
        ("Rarm@Body$Shape cone ¦", "wide"),
        ("Rarm@Body$Origin ¦", "center"),
        ("Rarm@Body$Color ¦", "orange"),
        ("Rarm@Body$Offset (¦", "sqrt"),
        ("Rarm@Body$Offset (2 * ¦)", "wide"),
        ("Rarm@Body$Texture ¦", "a.png"),
        ("Rarm@Body$Texture \"¦", "a.png"),
        ("Rarm@Body$Shape model \"b¦\"", "b/c d.glb"),
        ("Rarm@Body$Mark red Follow ¦", "Body"),
        ("Rarm@Body$Mark ¦", "crimson"),
        ("Rarm@Body$Perform ¦", "-t"),
        ("Rarm@Body$Perform -t ¦", "f.csv"),
        ("Rarm@Body$Perform \"f.csv\" ¦", "wide"),
        ("Rarm@Body$Perform \"f.csv\" red ¦", "wide"),
        ("%Axes +x ¦", "-y"),
    ] {
        let (_, found) = labels(string);
        assert!(found.contains(&expected.to_owned()), "{string}: {found:?}");
    }
    assert!(!labels("%Axes +x ¦").1.contains(&"-x".to_owned()));
    assert_eq!(labels("Rarm@Body$Texture \"¦a.png\"").0, "\"a.png\"");
}

#[test]
fn nothing_is_proposed_outside_of_strings() {
    for source in [
        figure(["Body", "Rarm@Body", "", "", ""])
            .replace("<rect id=\"right\"", "<rect ¦id=\"right\""),
        figure(["Body", "# Rarm@¦", "", "", ""]),
        figure(["Body", "Rarm ¦", "", "", ""]),
    ] {
        assert!(
            proposed(&source).is_none_or(|(_, found)| found.is_empty()),
            "{source}"
        );
    }
}

#[test]
fn an_empty_text_can_begin_any_string() {
    let source = figure(["Body", "<tspan>¦</tspan>", "", "", ""]);
    let (_, found) = proposed(&source).unwrap();
    let named: Vec<_> = found
        .iter()
        .map(|proposal| proposal.label.as_str())
        .collect();
    assert_eq!(named, ["# …", "% …", "*", "$ …", "Name@Parent$ …"]);
    assert_eq!(found[4].text, "Name@Parent$Shape roundv");
}

#[test]
fn a_text_that_is_no_drawing_is_read_around_the_place() {
    let (good, _) = analysis(&figure(["Body", "Rarm@Body", "", "", ""]));
    let source = figure(["Body", "Rarm@Body$Shape ¦", "", "", ""]).replace("</svg>", "<text>&");
    let at = source.find('¦').unwrap();
    let source = source.replacen('¦', "", 1);
    let context = Context {
        source: &source,
        analysis: &good,
        files: &Vec::new,
    };
    let found = completion(&context, at).unwrap();
    assert!(
        found
            .proposals
            .iter()
            .any(|proposal| proposal.label == "roundv")
    );
}

#[test]
fn every_example_fills_its_keyword() {
    for keyword in Keyword::ALL {
        let mut forms = keyword.row().forms.iter();
        let takes_nothing = |form: &Form| form.max_arguments() == 0;
        let is_bare = example_arguments(*keyword).is_empty();
        let name = keyword.name();
        if forms.clone().all(takes_nothing) {
            assert!(is_bare, "{name}");
        } else if is_bare {
            assert!(forms.any(takes_nothing), "{name}");
        }
    }
    assert_eq!(example_arguments(Keyword::Color), ["1", "0.8", "0.6"]);
}

/// The proposals in the string of the right arm of a moving figure: labels, details, texts.
fn joints(right: &str) -> Vec<[String; 3]> {
    let source = figure(["Body", right, "Larm@Body", "", "%Motion \"kick.bvh\""]);
    let (analysis, at) = moving(&source);
    let context = Context {
        source: &analysis.source().clone(),
        analysis: &analysis,
        files: &Vec::new,
    };
    let found = completion(&context, at).unwrap();
    let joints = found
        .proposals
        .into_iter()
        .filter(|proposal| proposal.kind == ProposalKind::Joint);
    joints
        .map(|joint| [joint.label, joint.detail, joint.text])
        .collect()
}

#[test]
fn joints_are_those_of_the_motion() {
    let found = joints("Rarm@Body$Bone ¦");
    assert_eq!(found.len(), 14);
    assert_eq!(found[0], ["Hips", "hips", "Hips"]);
    let arm = ["RightArm", "right arm, upper", "RightArm"].map(str::to_owned);
    assert!(found.contains(&arm), "{found:?}");
    // Joints of no limb come last; a name with signs is quoted.
    assert_eq!(found[13], ["Grip:1", "on RightHand", "\"Grip:1\""]);
    assert_eq!(joints("Rarm@Body$Bone \"¦").len(), 14);
    assert_eq!(joints("Rarm@Body$Offset 2 ¦"), Vec::<[String; 3]>::new());
}

#[test]
fn a_chain_of_joints_leads_downward() {
    let labels = |right: &str| -> Vec<String> {
        joints(right).into_iter().map(|[label, ..]| label).collect()
    };
    assert_eq!(
        labels("Rarm@Body$Bone RightArm ¦"),
        ["RightForeArm", "RightHand", "Grip:1"]
    );
    // Names are found as `Bone` finds them.
    assert_eq!(
        labels("Rarm@Body$Bone rightforearm ¦"),
        ["RightHand", "Grip:1"]
    );
    assert_eq!(
        labels("Rarm@Body$Bone RightArm Right¦"),
        ["RightForeArm", "RightHand", "Grip:1"]
    );
    assert_eq!(labels("Rarm@Body$Bone Nobody ¦"), Vec::<String>::new());
    assert_eq!(
        labels("Rarm@Body$Bone RightArm RightHand ¦"),
        Vec::<String>::new()
    );
}

/// A drawing of so many parts in rows; the last one has the string `last`.
fn parts(count: usize, last: &str) -> String {
    let part = |index: usize| {
        let string = if index + 1 == count {
            last.to_owned()
        } else {
            format!("Part{index}")
        };
        let (x, y) = (40 * (index % 100), 40 * (index / 100));
        format!(
            "<rect x='{x}' y='{y}' width='30' height='20'/><text x='{}' y='{}'>{string}</text>",
            x + 15,
            y + 10
        )
    };
    let parts: String = (0..count).map(part).collect();
    format!("<svg xmlns='http://www.w3.org/2000/svg'>{parts}</svg>")
}

/// The labels that are listed after `typed` in the last string of a drawing of so many parts, and whether there are more.
fn listed(count: usize, typed: &[&str]) -> Vec<(Vec<String>, bool)> {
    let (analysis, _) = analysis(&parts(count, "Last@"));
    let listed = |typed: &&str| {
        let source = parts(count, &format!("Last@{typed}¦"));
        let at = source.find('¦').unwrap();
        let context = Context {
            source: &source.replacen('¦', "", 1),
            analysis: &analysis,
            files: &Vec::new,
        };
        let found = completion(&context, at).unwrap();
        let labels = found.proposals.into_iter().map(|proposal| proposal.label);
        (labels.collect(), found.is_incomplete)
    };
    typed.iter().map(listed).collect()
}

#[test]
fn a_list_of_thousands_of_parts_is_bounded() {
    let words = [
        "",
        "Part4998",
        "pART4998",
        "&quot;Part4998",
        "\"Part4998",
        "Pt4998",
        "Part49",
        "Part4998$Mark red Follow ",
        "Part4998$Mark red Follow Part4997",
        "Nobody",
    ];
    let found = listed(5000, &words);
    assert!(found.iter().all(|(_, is_incomplete)| *is_incomplete));
    let labels: Vec<&[String]> = found.iter().map(|(labels, _)| labels.as_slice()).collect();
    assert_eq!(labels[0].len(), MAX_LISTED);
    assert!(!labels[0].contains(&"Part4998".to_owned()));
    for found in &labels[1..6] {
        assert_eq!(**found, ["Part4998"]);
    }
    // Names that begin with the word come before those that have its letters further apart.
    let (start, others) = labels[6].split_at(110);
    assert!(start.iter().all(|name| name.starts_with("Part49")));
    assert!(others.contains(&"Part409".to_owned()));
    assert!(labels[7].len() >= MAX_LISTED);
    assert!(labels[8].contains(&"Part4997".to_owned()));
    assert!(labels[9].is_empty());
}

#[test]
fn a_list_of_some_hundreds_of_parts_is_complete() {
    for (found, is_incomplete) in listed(MAX_LISTED + 1, &["", "Part1"]) {
        assert_eq!(found.len(), MAX_LISTED);
        assert!(!is_incomplete);
    }
    let found = listed(MAX_LISTED + 2, &[""]);
    assert_eq!((found[0].0.len(), found[0].1), (MAX_LISTED, true));
}
