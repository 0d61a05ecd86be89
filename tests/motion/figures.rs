//! Drawn figures matched with motions: what drives each part, compared with what a careful person chose.
//!
//! `tests/motion/figures` holds sixteen drawings. Beside each is a list with a line for each part: the id of its shape or group,
//! and the choice, such as `left arm upper`, `right leg 2 splayed`, `hips | body` where both are right, or `-` for a part that
//! follows its parent. Numbers count pairs of limbs from the hind end, 0 is left out.
//!
//! The rules of `labels` were fitted to these sixteen figures with these motions, which are too few to hold half of them back. The
//! shares therefore tell that nothing got worse, not how many parts of other figures are driven as a person would choose.
//!
//! `OKOSHI_BVH=FOLDER cargo test --test motion figures -- --nocapture` also measures the motions of another folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{env, fs};

use okoshi::compile::Compiled;
use okoshi::internals::bind::PartId;
use okoshi::internals::labels::{Anatomy, Class, Limb, LimbSegment, Side, Tip, label_clip};
use okoshi::internals::mocap::bvh::{self, Decimals};
use okoshi::internals::mocap::{Clip, JointId, Skeleton};
use okoshi::internals::svg::GroupId;
use okoshi::resolver::MemoryResolver;

use crate::common::compiled;
use crate::retarget::clips::FILES;

/// Frames of a motion that are used: matching looks at 32 of them.
const FRAMES: usize = 64;
/// The least share of right parts, with the joints' own names and with names that say nothing, percent.
const LEAST: [f64; 2] = [98.0, 95.0];

/// A drawing and what drives its parts.
pub(crate) struct DrawnFigure {
    pub(crate) name: String,
    pub(crate) drawing: String,
    /// Per part its id and the choices that are right.
    pub(crate) parts: Vec<(String, Vec<Choice>)>,
}

/// What a part is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Choice {
    FollowsParent,
    Trunk(Class),
    Limb {
        class: Class,
        side: Side,
        segment: LimbSegment,
        pair: usize,
        splayed: bool,
    },
}

impl Choice {
    fn read(text: &str) -> Self {
        let mut class = None;
        let mut side = None;
        let (mut segment, mut pair, mut splayed) = (LimbSegment::Whole, 0, false);
        for word in text.split_whitespace() {
            match word {
                "-" => return Self::FollowsParent,
                "left" => side = Some(Side::Left),
                "right" => side = Some(Side::Right),
                "upper" => segment = LimbSegment::Upper,
                "lower" => segment = LimbSegment::Lower,
                "end" => segment = LimbSegment::End,
                "splayed" => splayed = true,
                word => match word.parse() {
                    Ok(number) => pair = number,
                    Err(_) => class = Some(class_named(word)),
                },
            }
        }
        let class = class.unwrap_or_else(|| panic!("`{text}` names no class"));
        match side {
            Some(side) => Self::Limb {
                class,
                side,
                segment,
                pair,
                splayed,
            },
            None => Self::Trunk(class),
        }
    }
}

fn class_named(word: &str) -> Class {
    let all = [
        Class::Head,
        Class::Neck,
        Class::Body,
        Class::Hips,
        Class::Arm,
        Class::Leg,
        Class::Tail,
    ];
    let found = all.into_iter().find(|class| class.name() == word);
    found.unwrap_or_else(|| panic!("no class is called `{word}`"))
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/motion/figures")
}

pub(crate) fn figures() -> Vec<DrawnFigure> {
    let files = fs::read_dir(folder()).expect("the figures");
    let mut paths: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "svg"));
    paths.sort();
    let read = |path: &Path| fs::read_to_string(path).expect("a text");
    let figure = |path: &PathBuf| {
        let list = read(&path.with_extension("txt"));
        let parts = list.lines().map(|line| {
            let (id, choices) = line.split_once(": ").expect("an id and a choice");
            let choices = choices.split(" | ").map(Choice::read);
            (id.to_owned(), choices.collect())
        });
        DrawnFigure {
            name: path.file_stem().expect("a name").display().to_string(),
            drawing: read(path),
            parts: parts.collect(),
        }
    };
    paths.iter().map(figure).collect()
}

/// A motion in few frames, as bytes with the joints' own names and with names that say nothing.
struct Motion {
    name: String,
    clip: Clip,
    bytes: [Vec<u8>; 2],
}

impl Motion {
    fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let clip = bvh::read_bytes(&bytes).expect("a motion").clip;
        let step = clip.frames.div_ceil(FRAMES);
        let clip = clip.select_frames((0..clip.frames).step_by(step));
        let mut skeleton = Skeleton::clone(&clip.skeleton);
        for (index, joint) in skeleton.joints.iter_mut().enumerate() {
            joint.name = format!("joint{index}");
        }
        let blank = Clip::new(Arc::new(skeleton), clip.frame_time, clip.values().to_vec());
        let written = |clip: &Clip| {
            let mut bytes = Vec::new();
            bvh::write(clip, Decimals::default(), &mut bytes).expect("memory");
            bytes
        };
        Self {
            name: path.file_stem().expect("a name").display().to_string(),
            bytes: [written(&clip), written(&blank)],
            clip,
        }
    }
}

/// Where the bone or chain that drives a part begins and ends; `None` for a part that follows its parent.
type Found = Option<(JointId, Option<Tip>)>;

/// Whether a part is driven as chosen. Which joint of spine or neck drives a segment of it is left open, and so is where a hand or
/// foot points.
fn is_right(choice: Choice, found: Found, anatomy: &Anatomy, whole: bool) -> bool {
    let joint = found.map(|(joint, _)| joint);
    let one_of = |joints: &[JointId]| match joints {
        [] => joint.is_none(),
        joints => joint.is_some_and(|joint| joints.contains(&joint)),
    };
    match choice {
        Choice::FollowsParent => found.is_none(),
        Choice::Trunk(Class::Head) => joint == anatomy.head,
        Choice::Trunk(Class::Hips) => joint == anatomy.hips,
        Choice::Trunk(Class::Neck) => one_of(&anatomy.neck),
        Choice::Trunk(Class::Tail) => one_of(&anatomy.tail),
        Choice::Trunk(_) => match anatomy.spine.as_slice() {
            [] => joint == anatomy.hips,
            spine => one_of(spine),
        },
        Choice::Limb {
            class,
            side,
            segment,
            pair,
            splayed,
        } => {
            // Every second pair of legs follows the other side's.
            let side = if class == Class::Leg && pair % 2 == 1 {
                side.other()
            } else {
                side
            };
            let Some(limb) = anatomy.limb(class, side) else {
                return found.is_none();
            };
            if whole && segment == LimbSegment::End && class == Class::Arm {
                return found.is_none();
            }
            let bone = bone(limb, segment);
            match found {
                Some((joint, None)) => {
                    (splayed || segment == LimbSegment::End) && Some(joint) == bone.0
                }
                Some((joint, Some(tip))) => {
                    let ends = segment == LimbSegment::End || bone.1.map(Tip::Joint) == Some(tip);
                    !splayed && Some(joint) == bone.0 && ends
                }
                None => false,
            }
        }
    }
}

fn bone(limb: &Limb, segment: LimbSegment) -> (Option<JointId>, Option<JointId>) {
    match segment {
        LimbSegment::Upper => (Some(limb.upper), limb.lower),
        LimbSegment::Lower => (limb.lower, limb.end),
        LimbSegment::End => (limb.end, None),
        _ => (Some(limb.upper), limb.end),
    }
}

/// The main part with the id of a shape or group; `None` if that is a detail of another part.
pub(crate) fn part_of(compiled: &Compiled, id: &str) -> Option<PartId> {
    let drawing = &compiled.drawing;
    let inside = |mut group: GroupId| {
        loop {
            if drawing.groups[group].element.id.as_deref() == Some(id) {
                return true;
            }
            if group == GroupId::ROOT {
                return false;
            }
            group = drawing.groups[group].parent;
        }
    };
    let parts = &compiled.bindings.parts;
    let mut own = parts.iter_enumerated().filter(|(_, part)| {
        let shape = &drawing.shapes[part.shape];
        shape.element.id.as_deref() == Some(id) || inside(shape.group)
    });
    let main = own.find(|(index, part)| part.main == *index);
    main.map(|(part, _)| part)
}

/// What drives the part with an id, and the reason.
fn found(compiled: &Compiled, id: &str) -> (Found, String) {
    let Some(part) = part_of(compiled, id) else {
        return (None, "a detail of another part".to_owned());
    };
    match compiled.clips.iter().find_map(|clip| clip.part_drive(part)) {
        Some(drive) => (
            drive.joint.map(|joint| (joint, drive.tip)),
            drive.why.clone(),
        ),
        None => (None, "in no figure that moves".to_owned()),
    }
}

fn is_whole(parts: &[(String, Vec<Choice>)], choice: Choice) -> bool {
    let Choice::Limb {
        class, side, pair, ..
    } = choice
    else {
        return false;
    };
    parts.iter().flat_map(|(_, choices)| choices).any(|other| {
        matches!(other, Choice::Limb { class: c, side: s, segment: LimbSegment::Whole, pair: p, .. } if (*c, *s, *p) == (class, side, pair))
    })
}

/// Counts right parts and all parts, and adds to `wrong`, by figure and part, in which motions it is driven wrongly and why.
fn count(
    figures: &[DrawnFigure],
    motions: &[Motion],
    names: usize,
    wrong: &mut BTreeMap<String, Vec<String>>,
) -> [usize; 2] {
    let [mut right, mut all] = [0, 0];
    for motion in motions {
        let anatomy = label_clip(&motion.clip);
        let bytes = motion.bytes[names].clone();
        let resolver = MemoryResolver::default().with("clip.bvh", bytes);
        for figure in figures {
            let compiled = compiled(&figure.drawing, &resolver);
            for (id, choices) in &figure.parts {
                let (found, why) = found(&compiled, id);
                let fits = |choice: &Choice| {
                    // A hand follows an arm of one piece, and its own joint if that bends.
                    let is_whole = is_whole(&figure.parts, *choice);
                    is_right(*choice, found, &anatomy, false)
                        || is_whole && is_right(*choice, found, &anatomy, true)
                };
                all += 1;
                if choices.iter().any(fits) {
                    right += 1;
                } else {
                    let part = format!("{} {id}", figure.name);
                    let entry = wrong.entry(part).or_default();
                    entry.push(format!("{}: {found:?}, {why}", motion.name));
                }
            }
        }
    }
    [right, all]
}

fn percent([right, all]: [usize; 2]) -> f64 {
    100.0 * right as f64 / all as f64
}

/// Measures these motions and prints what is wrong.
fn measured(figures: &[DrawnFigure], motions: &[Motion]) -> [f64; 2] {
    [0, 1].map(|names| {
        let mut wrong = BTreeMap::new();
        let counts = count(figures, motions, names, &mut wrong);
        let which = ["names of their own", "names that say nothing"][names];
        eprintln!(
            "{:.2} % of {} right with {which}",
            percent(counts),
            counts[1]
        );
        for (part, motions) in wrong {
            eprintln!("  {part}: {} of the motions; {}", motions.len(), motions[0]);
        }
        percent(counts)
    })
}

#[test]
fn parts_are_driven_as_people_choose() {
    let figures = figures();
    assert_eq!(figures.len(), 16);
    let file = |file: &&str| Motion::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(file));
    let motions: Vec<Motion> = FILES.iter().map(file).collect();
    let shares = measured(&figures, &motions);
    if let Ok(folder) = env::var("OKOSHI_BVH") {
        let files = fs::read_dir(folder).expect("a folder of motions");
        let mut paths: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
        paths.sort();
        let mut motions: Vec<Motion> = paths.iter().map(|path| Motion::read(path)).collect();
        motions.retain(|motion| label_clip(&motion.clip).limbs.len() == 4);
        measured(&figures, &motions);
    }
    for (share, least) in shares.into_iter().zip(LEAST) {
        assert!(share >= least, "only {share:.2} % of the parts are right");
    }
}
