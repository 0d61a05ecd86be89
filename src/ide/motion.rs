//! Hover texts about motion: the joint that drives a part, clips and how they are limited, joints.

use std::fmt::Write as _;

use super::Analysis;
use super::at::attributes;
use super::hover::{escaped, some_of};
use crate::bind::{PartId, PartKind, StringId};
use crate::diagnostic::listed;
use crate::lang::keyword::Keyword;
use crate::limited::frame_ranges;
use crate::rig::{FigureClip, JointId};
use crate::source::Span;

/// How many clips are listed individually.
const MAX_CLIPS: usize = 8;
/// How many runs of frames are listed individually.
const MAX_RANGES: usize = 12;

impl Analysis {
    /// The clips of the drawing, those of the part's figure first.
    pub(super) fn clips_for(&self, part: Option<PartId>) -> Vec<&FigureClip> {
        let main = part.map(|part| self.bindings().parts[part].main);
        let mut clips: Vec<&FigureClip> = self.compiled.clips.iter().collect();
        clips.sort_by_key(|clip| main.is_none_or(|main| clip.part_drive(main).is_none()));
        clips
    }

    /// The joint that drives a part, and why, in each clip of its figure: one paragraph for all clips that agree. `None` for
    /// parts of figures without clips.
    pub(super) fn driven_card(&self, part: PartId) -> Option<String> {
        if self.bindings().parts[part].kind != PartKind::Main {
            return None;
        }
        let mut lines: Vec<(String, Vec<&str>)> = vec![];
        for clip in &self.compiled.clips {
            let Some(drive) = clip.part_drive(part) else {
                continue;
            };
            let line = match drive.joint {
                Some(_) if clip.is_posed => drive.why.clone(),
                Some(joint) => {
                    format!("driven by {}: {}", code(clip.joint_name(joint)), drive.why)
                }
                None => clip.undriven(drive),
            };
            match lines.iter_mut().find(|(known, _)| *known == line) {
                Some((_, names)) => names.push(&clip.name),
                None => lines.push((line, vec![&clip.name])),
            }
        }
        let mut out = String::new();
        for (line, names) in lines.iter().take(MAX_CLIPS) {
            let clips = if names.len() == 1 { "clip" } else { "clips" };
            let names = some_of(names.iter().map(|name| code(name))).unwrap_or_default();
            let _ = writeln!(out, "In {clips} {names}: {line}.\n");
        }
        let others = lines.iter().skip(MAX_CLIPS);
        match others.map(|(_, names)| names.len()).sum() {
            0 => {}
            1 => out.push_str("And in 1 more clip.\n"),
            more => {
                let _ = writeln!(out, "And in {more} more clips.");
            }
        }
        let out = out.trim_end();
        (!out.is_empty()).then(|| format!("{out}\n"))
    }

    /// The clips that attribute `index` of a string asks for, limits or performs, or the joint or mark of its part.
    pub(super) fn motion_card(&self, string: StringId, index: usize) -> Option<String> {
        let string_of = &self.bindings().strings[string];
        let attribute = &attributes(&string_of.annotation)[index];
        let span = string_of.text.span(attribute.range.clone());
        match attribute.keyword {
            Keyword::Motion => Some(self.asked_card(span)),
            Keyword::Limited | Keyword::Held => self.limited_card(span),
            Keyword::Pose => self.pose_card(span),
            Keyword::Perform => self.performance_card(span),
            Keyword::Mark => self.mark_card(string),
            Keyword::Bone => self.driven_card(self.part_of_string(string)?),
            _ => None,
        }
    }

    fn asked_card(&self, span: Span) -> String {
        let clips = self.compiled.clips.iter();
        let clips = clips.filter(|clip| clip.requested_at == span);
        let lines = clips.map(|clip| {
            let driven = clip.parts.iter().filter(|drive| drive.joint.is_some());
            let turns = clip.turns_in_words();
            let in_turn = if turns.is_empty() {
                String::new()
            } else {
                let turns: Vec<String> = turns.iter().map(|turn| code(turn)).collect();
                format!("; in turn {}", turns.join(", "))
            };
            let by = match clip.is_posed {
                true => "posed".to_owned(),
                false => format!(
                    "driven by the {} of {}",
                    counted(clip.skeleton().joints.len(), "joint"),
                    code(&clip.file)
                ),
            };
            format!(
                "clip {} of {}: {:.2} s, {}, {}{in_turn}; {} of {} are {by}",
                code(&clip.name),
                self.figure_of(clip),
                clip.seconds(),
                counted(clip.frames(), "frame"),
                counted(clip.drawings(), "drawing"),
                driven.count(),
                counted(clip.parts.len(), "part"),
            )
        });
        list(lines.collect()).unwrap_or_else(|| "No figure plays it.\n".to_owned())
    }

    /// What a key pose holds, and the clips that it begins.
    fn pose_card(&self, span: Span) -> Option<String> {
        let bindings = self.bindings();
        let pose = bindings.poses.iter().find(|pose| pose.span == span)?;
        let names = pose.parts.iter();
        let names = names.map(|posed| code(&bindings.parts[posed.part].name));
        let plays = self.compiled.clips.iter();
        let mut plays = plays.filter(|clip| clip.requested_at == span);
        let mut card = match pose.parts.as_slice() {
            [] => "It holds no copies of parts.\n".to_owned(),
            _ => format!("A key pose of {}.\n", listed(names)),
        };
        if plays.next().is_some() {
            card.push('\n');
            card.push_str(&self.asked_card(span));
        }
        Some(card)
    }

    fn limited_card(&self, span: Span) -> Option<String> {
        let clips = self.compiled.clips.iter();
        let clips = clips.filter(|clip| [clip.limited_at, clip.held_at].contains(&Some(span)));
        let lines = clips.map(|clip| {
            let (omitted, held) = clip.cut_frames();
            let what = |frames: &[u32]| {
                let ranges = || format!(" ({})", frame_ranges(frames, MAX_RANGES));
                if frames.is_empty() {
                    String::new()
                } else {
                    ranges()
                }
            };
            format!(
                "clip {} of {}: of {} {} omitted{} and {} held{}; {}",
                code(&clip.name),
                self.figure_of(clip),
                counted(clip.source_frames(), "frame"),
                are(omitted.len()),
                what(&omitted),
                are(held.len()),
                what(&held),
                counted(clip.drawings(), "drawing"),
            )
        });
        list(lines.collect())
    }

    /// The joint that a `Bone` names, in each motion of the part's figure, or of the whole drawing if its figure has none.
    pub(super) fn joint_card(&self, string: StringId, name: &str) -> Option<String> {
        let part = self.part_of_string(string);
        let clips = self.clips_for(part);
        let is_own = |clip: &&&FigureClip| {
            part.is_some_and(|part| clip.part_drive(self.bindings().parts[part].main).is_some())
        };
        let own = clips.iter().filter(is_own).count();
        let clips = if own > 0 { &clips[..own] } else { &clips[..] };
        let mut files: Vec<&str> = vec![];
        let mut cards: Vec<String> = vec![];
        for clip in clips {
            if files.contains(&clip.file.as_str()) {
                continue;
            }
            files.push(&clip.file);
            if files.len() <= MAX_CLIPS {
                cards.push(match clip.joint_named(name) {
                    Some(joint) => joint_of(clip, joint),
                    None => {
                        let (file, name) = (code(&clip.file), code(name));
                        format!("The motion {file} has no joint {name}.")
                    }
                });
            }
        }
        (!cards.is_empty()).then(|| cards.join("\n\n"))
    }

    pub(super) fn figure_of(&self, clip: &FigureClip) -> String {
        code(&self.bindings().parts[clip.root].name)
    }
}

/// Describes a joint: its label, the reason for it, its parent and its children.
fn joint_of(clip: &FigureClip, joint: JointId) -> String {
    let joints = &clip.skeleton().joints;
    let (name, file) = (escaped(&joints[joint].name), code(&clip.file));
    let mut out = format!("**{name}**, a joint of {file}");
    match clip.label(joint) {
        Some(label) => {
            let _ = write!(out, ": {}\n\n{}.", label.describe(), label.why);
        }
        None => out.push_str("\n\nNot recognised as a limb, head or trunk."),
    }
    match joints[joint].parent {
        Some(parent) => {
            let _ = write!(out, " It is a child of {}", code(&joints[parent].name));
        }
        None => out.push_str(" It is a root"),
    }
    let carried = joints.iter().filter(|other| other.parent == Some(joint));
    let carried: Vec<String> = carried.map(|other| code(&other.name)).collect();
    if let Some(names) = some_of(carried.into_iter()) {
        let _ = write!(out, " and the parent of {names}");
    }
    out.push('.');
    out
}

/// A list in Markdown, shortened if it is long.
pub(super) fn list(lines: Vec<String>) -> Option<String> {
    let mut out = String::new();
    for line in lines.iter().take(MAX_CLIPS) {
        let _ = writeln!(out, "- {line}");
    }
    if lines.len() > MAX_CLIPS {
        let _ = writeln!(out, "- and {} more", lines.len() - MAX_CLIPS);
    }
    (!out.is_empty()).then_some(out)
}

/// A name as code in Markdown.
pub(super) fn code(name: &str) -> String {
    format!("`{}`", name.replace('`', "'"))
}

fn are(count: usize) -> String {
    match count {
        0 => "none is".to_owned(),
        1 => "1 is".to_owned(),
        count => format!("{count} are"),
    }
}

fn counted(count: usize, thing: &str) -> String {
    match count {
        1 => format!("1 {thing}"),
        count => format!("{count} {thing}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::TokenClass;
    use super::super::fixtures::{figure, moving};
    use super::*;

    /// The hover text at the place that is marked in the right arm's string or in the string for the whole drawing.
    fn hover(right: &str, defaults: &str) -> String {
        let (analysis, at) = moving(&figure(["Body", right, "Larm@Body", "", defaults]));
        analysis
            .hover(at)
            .map_or(String::new(), |hover| hover.markdown)
    }

    #[test]
    fn part_names_show_their_joint() {
        let card = hover("Rar¦m@Body", "%Motion \"kick.bvh\"");
        assert!(
            card.contains("In clip `kick`: driven by `RightArm`: `Rarm` is an arm by its name, and its side is right; it points"),
            "{card}"
        );
        // Clips that agree share a line.
        let card = hover(
            "Rar¦m@Body",
            "%Motion \"kick.bvh\" Motion \"kick.bvh\" again",
        );
        assert!(
            card.contains("In clips `kick`, `again`: driven by `RightArm`: "),
            "{card}"
        );
        let card = hover("Swo¦rd@Body$Bone RightHand", "%Motion \"kick.bvh\"");
        assert!(
            card.contains("driven by `RightHand`: its string names the joint with `Bone`"),
            "{card}"
        );
        assert!(!hover("Rar¦m@Body", "").contains("driven"));
    }

    #[test]
    fn key_poses_show_what_they_hold() {
        let card = |string: &str, right: &str| {
            let layer = format!(
                "<g><text x=\"1\" y=\"99\">{string}</text><use href=\"#right\" transform=\"rotate(30 80 45)\"/></g></svg>"
            );
            let source = figure(["Body", right, "Larm@Body", "", ""]).replace("</svg>", &layer);
            let (analysis, at) = moving(&source);
            analysis
                .hover(at)
                .map_or(String::new(), |hover| hover.markdown)
        };
        let pose = card("Body$Po¦se 1", "Rarm@Body");
        assert!(pose.starts_with("A key pose of `Rarm`.\n"), "{pose}");
        let clip = "clip `poses` of `Body`: 1.00 s, 25 frames, 25 drawings; 1 of 4 parts are posed";
        assert!(pose.contains(clip), "{pose}");
        assert!(pose.contains("a key pose: copies of parts"), "{pose}");
        let seconds = card("Body$Pose 1¦ nod", "Rarm@Body");
        assert!(seconds.contains("when the pose is reached"), "{seconds}");
        let part = card("Body$Pose 1", "Rar¦m@Body");
        assert!(
            part.contains("In clip `poses`: its copies in the pose layers turn it."),
            "{part}"
        );
    }

    #[test]
    fn shapes_show_their_joint() {
        let source = figure(["Body", "Rarm@Body", "Larm@Body", "", "%Motion \"kick.bvh\""]);
        let (analysis, at) = moving(&source.replace("<rect id=\"left\"", "<re¦ct id=\"left\""));
        let card = analysis
            .hover(at)
            .map_or(String::new(), |hover| hover.markdown);
        assert!(card.contains("driven by `LeftArm`"), "{card}");
    }

    #[test]
    fn a_part_without_a_joint_follows_its_parent() {
        // A button in the middle of the body.
        let swatch =
            "<rect id=\"swatch\" x=\"2\" y=\"2\" width=\"5\" height=\"5\" fill=\"#ffcc99\"/>";
        let button = "<rect id=\"pin\" x=\"97\" y=\"45\" width=\"6\" height=\"6\"><desc>Pi¦n@Body</desc></rect>";
        let source = figure(["Body", "Rarm@Body", "Larm@Body", "", "%Motion \"kick.bvh\""]);
        let source = source.replace(swatch, button);
        let (analysis, at) = moving(&source);
        let card = analysis
            .hover(at)
            .map_or(String::new(), |hover| hover.markdown);
        assert!(
            card.contains("In clip `kick`: follows its parent: "),
            "{card}"
        );
    }

    #[test]
    fn motions_show_their_clips() {
        for defaults in [
            "%Mo¦tion \"kick.bvh\" high Limited 0 3",
            "%Motion \"kick¦.bvh\" high Limited 0 3",
        ] {
            let card = hover("Rarm@Body", defaults);
            let expected = "- clip `high` of `Body`: 0.54 s, 13 frames, 10 drawings; 4 of 4 parts are driven by the 14 joints of `kick.bvh`";
            assert!(card.contains(expected), "{card}");
        }
        assert!(hover("Rarm@Body", "%Mo¦tion \"none.bvh\"").starts_with("No figure plays it."));
        let card = hover("Rarm@Body", "%Mo¦tion idle \"kick.bvh\" wave 6 hello");
        let expected = "- clip `hello` of `Body`: 8.50 s, 205 frames, 205 drawings; in turn `idle 3.00 s`, `kick.bvh 0.50 s`, `wave 5.00 s (2 cycles)`; ";
        assert!(card.contains(expected), "{card}");
    }

    #[test]
    fn limits_show_their_frames() {
        for defaults in [
            "%Motion \"kick.bvh\" Limi¦ted 2 3",
            "%Motion \"kick.bvh\" Limited ¦2 3",
        ] {
            let card = hover("Rarm@Body", defaults);
            assert!(
                card.contains("- clip `kick` of `Body`: of 13 frames 2 are omitted ("),
                "{card}"
            );
            assert!(card.contains(") and 3 are held ("), "{card}");
        }
    }

    #[test]
    fn joints_show_their_labels() {
        let card = hover("Rarm@Body$Bone Right¦Arm", "%Motion \"kick.bvh\"");
        for expected in [
            "**RightArm**, a joint of `kick.bvh`: right arm, upper",
            "It is a child of `Spine` and the parent of `RightForeArm`.",
        ] {
            assert!(card.contains(expected), "{card}");
        }
        let card = hover("Rarm@Body$Bone Right¦Am", "%Motion \"kick.bvh\"");
        let expected = "\n---\n\nThe motion `kick.bvh` has no joint `RightAm`.\n";
        assert!(
            card.starts_with("**W316: ") && card.ends_with(expected),
            "{card}"
        );
        // The name of a joint is not a reference to a part of the same name.
        let card = hover("Rarm@Body$Bone Bo¦dy", "");
        assert!(!card.contains("**Body**"), "{card}");
    }

    #[test]
    fn joints_are_not_renamed_with_parts() {
        let (analysis, at) = moving(&figure([
            "Spi¦ne",
            "Rarm@Spine$Bone Spine RightArm",
            "",
            "",
            "%Motion \"kick.bvh\"",
        ]));
        let edits = analysis.rename(at, "Trunk").unwrap();
        let (arm, _) = analysis
            .source()
            .match_indices("Spine RightArm")
            .next()
            .unwrap();
        assert_eq!(edits.len(), 2);
        assert!(edits.iter().all(|edit| edit.span.start != arm));
        let found = analysis.prepare_rename(arm + 1);
        assert!(found.is_err(), "{found:?}");
    }

    #[test]
    fn joints_have_the_color_of_names() {
        let string = "Rarm@Body$Bone RightArm \"Grip:1\" Offset 2";
        let (analysis, _) = moving(&figure(["Body", string, "", "", "%Motion \"kick.bvh\""]));
        let (at, _) = analysis.source().match_indices(string).next().unwrap();
        let tokens = analysis.semantic_tokens(Span::new(at, at + string.len()));
        let names = tokens.iter().filter(|one| one.class == TokenClass::Part);
        let names = names.map(|one| {
            (
                &analysis.source()[one.span.start..one.span.end],
                one.defines,
            )
        });
        let expected = [
            ("Rarm", true),
            ("Body", false),
            ("RightArm", false),
            ("\"Grip:1\"", false),
        ];
        assert_eq!(names.collect::<Vec<_>>(), expected);
    }
}
