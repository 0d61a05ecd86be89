//! How figures stand, fly and hold their arms, measured on the vertices of the GLBs that are built.
//!
//! Every figure of `tests/motion/figures` plays the clips that come along and the motions of the project. What its feet do is compared
//! with the actor's feet (`actor.rs`), which are computed from joints alone. Half of the figures are held back: rules were fitted to the
//! others only, and both halves are printed.
//!
//! `OKOSHI_FIGURE="cat dog"` measures these figures only, without checking the shares, and `OKOSHI_EACH=1` prints every clip.
//! `OKOSHI_BVH=FOLDER cargo test --test motion measured -- --nocapture` also measures the motions of another folder.

mod actor;
mod model;
mod totals;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{env, fs};

use glam::DVec3;
use okoshi::compile::Compiled;
use okoshi::internals::labels::{Class, LimbSegment, Side};
use okoshi::internals::mocap::Transform;
use okoshi::internals::rig::FigureClip;
use okoshi::resolver::MemoryResolver;

use crate::common::{compiled, glb};
use crate::figures::{Choice, DrawnFigure, figures, part_of};
use crate::retarget::clips::FILES;
use actor::{Actor, ActorFoot};
use model::{Model, Surface};
use totals::{Half, Totals};

/// The figures that rules were fitted to and whose pictures were looked at; the others are held back.
const SEEN: [&str; 8] = [
    "bird", "dancer", "girl", "horse", "knight", "robot", "spider", "stick",
];
/// The clips that come along and are measured.
const CLIPS: [&str; 9] = [
    "walk", "run", "trot", "sneak", "jump", "idle", "wave", "dance", "punch",
];
/// Two feet are equally low if their heights differ by less than this share of the figure's height.
const EQUAL: f64 = 0.002;
/// A foot of the actor that is higher than this, in leg lengths, is in the air. An actor whose feet all are flies.
const IN_AIR: f64 = 0.03;
/// Legs that are shorter than this, as a share of the figure's height, are feet only.
const NO_LEG: f64 = 0.12;
/// How many times of a clip arms are looked at.
const TIMES: usize = 12;
/// How many points of a forearm or a hand are looked at.
const POINTS: usize = 12;
/// A forearm is in the trunk if so many more of its points are than in the drawing.
const IN_TRUNK: f64 = 0.12;

/// A foot of the model: what it is made of, and the actor's foot that it follows.
struct Foot {
    nodes: Vec<usize>,
    /// The node that turns.
    node: usize,
    actor: usize,
    /// Whether it is a part of its own.
    is_foot: bool,
    /// Whether its leg keeps its drawn pose.
    is_splayed: bool,
}

/// An arm of the model: points of its forearm and its hand, as numbers of corners of nodes.
struct Arm {
    side: Side,
    points: Vec<(usize, Vec<usize>)>,
    /// The share of these points that is in the trunk as drawn.
    drawn: f64,
}

/// A figure that plays a clip.
struct Played<'a> {
    model: &'a Model,
    rest: &'a [Transform],
    clip: &'a FigureClip,
    actor: &'a Actor,
    feet: Vec<Foot>,
    /// The nodes of its legs, feet and the bones inside included.
    legs: Vec<usize>,
    /// The length of its legs, from hip to sole.
    leg: f64,
    /// The height of the ground, and the figure's own.
    ground: f64,
    height: f64,
}

/// The parts of a figure's legs, by side and pair.
fn legs(figure: &DrawnFigure) -> BTreeMap<(Side, usize), BTreeMap<LimbSegment, &str>> {
    let mut legs: BTreeMap<_, BTreeMap<_, _>> = BTreeMap::new();
    for (id, choices) in &figure.parts {
        if let Choice::Limb {
            class: Class::Leg,
            side,
            segment,
            pair,
            ..
        } = choices[0]
        {
            legs.entry((side, pair))
                .or_default()
                .insert(segment, id.as_str());
        }
    }
    legs
}

impl<'a> Played<'a> {
    fn of(
        figure: &DrawnFigure,
        compiled: &Compiled,
        clip: &'a FigureClip,
        model: &'a Model,
        rest: &'a [Transform],
        actor: &'a Actor,
    ) -> Option<Self> {
        let node = |id: &str| {
            let part = part_of(compiled, id)?;
            Some((part, model.named(&compiled.bindings.parts[part].name)?))
        };
        let root = model.named(&compiled.bindings.parts[clip.root].name)?;
        let mut feet = Vec::new();
        let (mut lengths, mut nodes) = (Vec::new(), Vec::new());
        for segments in legs(figure).values() {
            let mut drives = segments
                .values()
                .filter_map(|id| clip.part_drive(node(id)?.0)?.joint);
            let Some(joint) = drives.next() else { continue };
            let is_of = |limb: &okoshi::internals::labels::Limb| {
                [Some(limb.upper), limb.lower, limb.end, limb.toe].contains(&Some(joint))
            };
            let Some(own) = actor.feet.iter().position(|(limb, _)| is_of(limb)) else {
                continue;
            };
            let (segment, id) = segments.last_key_value()?;
            let Some((_, sole)) = node(id) else { continue };
            feet.push(Foot {
                nodes: model.with_children(sole),
                node: sole,
                actor: own,
                is_splayed: node(segments.first_key_value()?.1)
                    .and_then(|(part, _)| clip.part_drive(part))
                    .is_some_and(|drive| drive.why.contains("keeps its drawn pose")),
                is_foot: *segment == LimbSegment::End && stands_drawn(model, rest, sole),
            });
            let (_, top) = node(segments.first_key_value()?.1)?;
            lengths.push(length(model, rest, [top, sole]));
            nodes.extend(model.with_children(top));
        }
        let low = |nodes: &[usize], world: &[Transform]| {
            let heights = model.corners(nodes, world).map(|corner| corner.y);
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| {
                (a.min(y), b.max(y))
            })
        };
        // What is drawn from above lies on the ground as soon as it moves.
        let first = model.at(&clip.name, 0);
        let lies = (first[root].rotation * rest[root].rotation.inverse() * DVec3::Z).y > 0.7;
        let standing = if lies { first.as_slice() } else { rest };
        let all: Vec<usize> = (0..model.nodes.len()).collect();
        let lowest = feet
            .iter()
            .map(|foot| low(&foot.nodes, standing).0)
            .reduce(f64::min)?;
        let (bottom, top) = low(&all, rest);
        let ground = if lies { bottom } else { lowest };
        let height = top - if lies { bottom } else { ground };
        Some(Self {
            leg: (lengths.iter().sum::<f64>() / lengths.len() as f64).max(NO_LEG * height),
            height,
            model,
            rest,
            clip,
            actor,
            feet,
            legs: nodes,
            ground,
        })
    }

    fn actor_foot(&self, foot: &Foot) -> &ActorFoot {
        &self.actor.feet[foot.actor].1
    }

    fn measure(&self, totals: &mut Totals) {
        let mut before: Option<Vec<Transform>> = None;
        let mut earlier: Option<Vec<Transform>> = None;
        let frames = self.actor.poses.len();
        let mut heights = Vec::with_capacity(frames);
        for frame in 0..frames {
            let world = self.model.at(&self.clip.name, frame);
            let lows = self.feet.iter().map(|foot| {
                let heights = self
                    .model
                    .corners(&foot.nodes, &world)
                    .map(|corner| corner.y);
                (heights.fold(f64::INFINITY, f64::min) - self.ground) / self.height
            });
            let lows: Vec<f64> = lows.collect();
            self.stand(frame, &world, &lows, totals);
            if let Some(before) = &before {
                self.slide(frame, [before, &world], totals);
            }
            if let (Some(earlier), Some(before)) = (&earlier, &before) {
                self.jerk([earlier, before, &world], totals);
            }
            heights.push(lows.into_iter().fold(f64::INFINITY, f64::min));
            earlier = before.replace(world);
        }
        self.fly(&heights, totals);
    }

    /// Soles of feet that stand, and which foot is lowest.
    fn stand(&self, frame: usize, world: &[Transform], lows: &[f64], totals: &mut Totals) {
        let stands = |foot: &Foot| self.actor_foot(foot).stands[frame];
        for (foot, low) in self.feet.iter().zip(lows).filter(|(foot, _)| stands(foot)) {
            totals.sunk.add((-low).max(0.0) * 100.0);
            if foot.is_foot {
                let turn = world[foot.node].rotation * self.rest[foot.node].rotation.inverse();
                let tilt = (turn * DVec3::Y).angle_between(DVec3::Y).to_degrees();
                totals
                    .tilt
                    .add((tilt - self.actor_foot(foot).tilt[frame]).abs());
            }
        }
        let lowest = |wanted: &dyn Fn(&Foot) -> bool| {
            let lows = self.feet.iter().zip(lows).filter(|(foot, _)| wanted(foot));
            lows.map(|(_, low)| *low).reduce(f64::min)
        };
        let moving = lowest(&|foot| self.actor_foot(foot).clearance[frame] > IN_AIR);
        if let (Some(standing), Some(moving)) = (lowest(&stands), moving) {
            let lowest = match self.feet.iter().any(|foot| foot.is_splayed) {
                true => &mut totals.lowest_splayed,
                false => &mut totals.lowest,
            };
            lowest.add(f64::from(u8::from(standing > moving + EQUAL)));
        }
        if self.feet.iter().any(stands) {
            // Somebody who kneels stands on more than feet.
            let all: Vec<usize> = (0..self.model.nodes.len()).collect();
            let heights = self.model.corners(&all, world).map(|corner| corner.y);
            let low = (heights.fold(f64::INFINITY, f64::min) - self.ground) / self.height;
            totals.off_ground.add(low.abs() * 100.0);
        }
    }

    /// How far the steadiest foot that stands slides, more than the actor's.
    fn slide(&self, frame: usize, [before, now]: [&Vec<Transform>; 2], totals: &mut Totals) {
        let standing = self.feet.iter().filter(|foot| {
            let actor = self.actor_foot(foot);
            actor.stands[frame] && actor.stands[frame - 1]
        });
        let slides = standing.map(|foot| {
            let [from, to] = [before, now].map(|world| self.model.corners(&foot.nodes, world));
            let pairs: Vec<(DVec3, DVec3)> = from.zip(to).collect();
            let height = |(a, b): &(DVec3, DVec3)| a.y + b.y;
            let low = pairs.iter().map(height).fold(f64::INFINITY, f64::min);
            // The mean of the points that are about as low as the lowest one.
            let near = pairs
                .iter()
                .filter(|pair| height(pair) < low + 0.004 * self.height);
            let (sum, count) = near.fold((DVec3::ZERO, 0.0), |(sum, count), (a, b)| {
                (sum + *b - *a, count + 1.0)
            });
            let way = sum / count;
            let speed = way.with_y(0.0).length() / self.leg / self.clip.frame_time();
            speed - self.actor_foot(foot).speed[frame]
        });
        if let Some(slide) = slides.reduce(f64::min) {
            totals.slide.add(slide.max(0.0));
        }
    }

    /// By how much the turns of legs change.
    fn jerk(&self, poses: [&Vec<Transform>; 3], totals: &mut Totals) {
        for node in &self.legs {
            let [a, b, c] = poses.map(|world| world[*node].rotation);
            let [first, second] = [b * a.inverse(), c * b.inverse()].map(|turn| {
                let turn = if turn.w < 0.0 { -turn } else { turn };
                turn.to_scaled_axis()
            });
            totals.jerks.add((second - first).length().to_degrees());
        }
    }

    /// Flights of the actor, and how high the figure is in them.
    fn fly(&self, heights: &[f64], totals: &mut Totals) {
        // A penguin has feet, but no legs.
        if self.leg <= NO_LEG * self.height {
            return;
        }
        let clearances: Vec<f64> = (0..heights.len())
            .map(|frame| self.actor.clearance(frame))
            .collect();
        let mut frame = 0;
        while frame < heights.len() {
            let end = (frame..heights.len()).find(|at| clearances[*at] <= IN_AIR);
            let end = end.unwrap_or(heights.len());
            if end == frame {
                frame += 1;
                continue;
            }
            let highest = |values: &[f64]| values[frame..end].iter().copied().fold(0.0, f64::max);
            let due = highest(&clearances);
            let own = highest(heights) * self.height / self.leg;
            totals.flight.add((own / due - 1.0).abs() * 100.0);
            frame = end;
        }
    }
}

/// Whether a foot is on the ground in the drawing: not that of a leg which a dancer raises.
fn stands_drawn(model: &Model, rest: &[Transform], foot: usize) -> bool {
    let all: Vec<usize> = (0..model.nodes.len()).collect();
    let extent = |nodes: &[usize]| {
        let heights = model.corners(nodes, rest).map(|corner| corner.y);
        heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| {
            (a.min(y), b.max(y))
        })
    };
    let (low, high) = extent(&all);
    extent(&[foot]).0 < low + 0.1 * (high - low)
}

/// The length of a leg from its joint, which is half its width below its top, from joint to joint to the sole, given the nodes of its first
/// and last piece.
fn length(model: &Model, rest: &[Transform], [top, sole]: [usize; 2]) -> f64 {
    let corners: Vec<DVec3> = model.corners(&[top], rest).collect();
    let highest = corners
        .iter()
        .map(|corner| corner.y)
        .fold(f64::NEG_INFINITY, f64::max);
    let lowest = corners
        .iter()
        .map(|corner| corner.y)
        .fold(f64::INFINITY, f64::min);
    let near = corners
        .iter()
        .filter(|corner| corner.y > highest - 0.2 * (highest - lowest));
    let xs = near.map(|corner| corner.x);
    let (left, right) = xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
        (a.min(x), b.max(x))
    });
    let hip = DVec3::new(
        f64::midpoint(left, right),
        highest - (right - left) / 2.0,
        0.0,
    );
    let corners: Vec<DVec3> = model.corners(&[sole], rest).collect();
    let heights = corners.iter().map(|corner| corner.y);
    let lowest = heights.fold(f64::INFINITY, f64::min);
    // A sole is flat, and reaches ahead: its middle.
    let flat = 0.05 * (hip.y - lowest);
    let soles = corners.iter().filter(|corner| corner.y < lowest + flat);
    let (sum, count) = soles.fold((DVec3::ZERO, 0.0), |(sum, count), corner| {
        (sum + *corner, count + 1.0)
    });
    let end = (sum / count).with_y(lowest).with_z(0.0);
    let above = |node: &usize| model.nodes[*node].parent;
    let leg = model.with_children(top);
    let chain = std::iter::successors(Some(sole), above);
    let chain = chain.take_while(|node| *node != top && leg.contains(node));
    let joints = chain.map(|node| rest[node].position.with_z(0.0));
    let points: Vec<DVec3> = std::iter::once(end).chain(joints).chain([hip]).collect();
    points.windows(2).map(|way| way[0].distance(way[1])).sum()
}

/// The arms of a figure, with points of their meshes.
fn arms(
    figure: &DrawnFigure,
    compiled: &Compiled,
    model: &Model,
    rest: &[Transform],
    trunk: &[usize],
) -> Vec<Arm> {
    let mut parts: BTreeMap<Side, Vec<(LimbSegment, usize)>> = BTreeMap::new();
    for (id, choices) in &figure.parts {
        if let Choice::Limb {
            class: Class::Arm,
            side,
            segment,
            pair: 0,
            splayed: false,
        } = choices[0]
        {
            let part = part_of(compiled, id);
            let node = part.and_then(|part| model.named(&compiled.bindings.parts[part].name));
            parts
                .entry(side)
                .or_default()
                .extend(node.map(|node| (segment, node)));
        }
    }
    let arms = parts.into_iter().map(|(side, nodes)| {
        let points = nodes
            .iter()
            .filter(|(segment, _)| *segment != LimbSegment::Upper);
        let points = points.map(|(segment, node)| {
            let corners = &model.nodes[*node].corners;
            let top = rest[nodes[0].1].position;
            let far = |corner: usize| corners[corner].place(rest).distance(top);
            let all = 0..corners.len();
            let farthest = all.clone().map(far).fold(0.0, f64::max);
            let is_forearm =
                |corner: &usize| *segment != LimbSegment::Whole || far(*corner) > farthest / 2.0;
            let own: Vec<usize> = all.filter(is_forearm).collect();
            let step = own.len().div_ceil(POINTS).max(1);
            (*node, own.into_iter().step_by(step).collect())
        });
        let mut arm = Arm {
            side,
            points: points.collect(),
            drawn: 0.0,
        };
        arm.drawn = inside(model, rest, trunk, &arm);
        arm
    });
    arms.filter(|arm| !arm.points.is_empty()).collect()
}

/// The share of an arm's points that is in the trunk.
fn inside(model: &Model, world: &[Transform], trunk: &[usize], arm: &Arm) -> f64 {
    let points = arm.points.iter().flat_map(|(node, points)| {
        let corners = points
            .iter()
            .map(|corner| &model.nodes[*node].corners[*corner]);
        corners.map(|corner| corner.place(world))
    });
    let trunk = trunk.iter().map(|node| model.surface(*node, world));
    let trunk: Vec<Surface<'_>> = trunk.collect();
    let (mut all, mut within) = (0.0, 0.0);
    for point in points {
        all += 1.0;
        if trunk.iter().any(|surface| surface.contains(point)) {
            within += 1.0;
        }
    }
    within / f64::max(all, 1.0)
}

/// Whether the actor's own forearm is where its chest must be: in a cylinder about the line from the hips to the shoulders, as wide as
/// these and half as deep.
fn actor_holds_in(actor: &Actor, clip: &FigureClip, side: Side, frame: usize) -> bool {
    let anatomy = &clip.motion.anatomy;
    let arms = Side::BOTH.map(|side| anatomy.limb(Class::Arm, side));
    let ([Some(left), Some(right)], Some(hips)) = (arms, anatomy.hips) else {
        return false;
    };
    let pose = &actor.poses[frame];
    let [a, b] = [left, right].map(|arm| pose[arm.upper].position);
    let own = if side == Side::Left { left } else { right };
    let Some(hand) = own.end.or(own.lower) else {
        return false;
    };
    let low = pose[hips].position;
    let spine = (a + b) / 2.0 - low;
    let across = (a - b).reject_from(spine);
    let off = pose[hand].position - low;
    let along = off.dot(spine) / spine.length_squared();
    let front = spine.cross(across).normalize();
    let x = off.dot(across) / across.length_squared() * 2.0;
    let z = off.dot(front) / across.length() * 4.0;
    (0.0..1.0).contains(&along) && x.hypot(z) < 1.0
}

fn measure_arms(arms: &[Arm], trunk: &[usize], played: &Played<'_>, totals: &mut Totals) {
    let frames = played.actor.poses.len();
    for time in 0..TIMES.min(frames) {
        let frame = time * (frames - 1) / (TIMES - 1);
        let world = played.model.at(&played.clip.name, frame);
        for arm in arms {
            if actor_holds_in(played.actor, played.clip, arm.side, frame) {
                continue;
            }
            let share = inside(played.model, &world, trunk, arm);
            totals
                .arms
                .add(f64::from(u8::from(share > arm.drawn + IN_TRUNK)));
        }
    }
}

/// The nodes of a figure's trunk.
fn trunk(figure: &DrawnFigure, compiled: &Compiled, model: &Model) -> Vec<usize> {
    let is_trunk =
        |choices: &[Choice]| matches!(choices[0], Choice::Trunk(Class::Body | Class::Hips));
    let parts = figure.parts.iter().filter(|(_, choices)| is_trunk(choices));
    let nodes = parts.filter_map(|(id, _)| {
        let part = part_of(compiled, id)?;
        model.named(&compiled.bindings.parts[part].name)
    });
    nodes.collect()
}

/// Measures a figure with all clips, whose limbs of one piece bend or not.
fn measure(figure: &DrawnFigure, files: &[(String, Vec<u8>)], bends: bool, half: &mut Half) {
    let mut resolver = MemoryResolver::default();
    let mut words: Vec<String> = CLIPS.map(|clip| format!("Motion {clip}")).to_vec();
    for (name, bytes) in files {
        resolver = resolver.with(&format!("{name}.bvh"), bytes.clone());
        words.push(format!("Motion \"{name}.bvh\""));
    }
    let drawing = figure.drawing.replacen(
        "Motion \"clip.bvh\"",
        &format!("{}{}", if bends { "" } else { "Bend 0 " }, words.join(" ")),
        1,
    );
    assert_ne!(drawing, figure.drawing, "{} plays nothing", figure.name);
    let compiled = compiled(&drawing, &resolver);
    let model = Model::read(&glb(&compiled));
    let rest = model.at_rest();
    let trunk = trunk(figure, &compiled, &model);
    let arms = arms(figure, &compiled, &model, &rest, &trunk);
    for clip in &compiled.clips {
        let actor = Actor::of(&clip.motion);
        let mut totals = Totals::default();
        if let Some(played) = Played::of(figure, &compiled, clip, &model, &rest, &actor) {
            played.measure(&mut totals);
            measure_arms(&arms, &trunk, &played, &mut totals);
        }
        if env::var("OKOSHI_EACH").is_ok() {
            let legs = if bends { "bent" } else { "rigid" };
            eprintln!("{} {} {legs}: {totals}", figure.name, clip.name);
        }
        half.add(&totals);
    }
}

fn read(paths: impl Iterator<Item = PathBuf>) -> Vec<(String, Vec<u8>)> {
    let file = |path: PathBuf| {
        let name = path.file_stem().expect("a name").display().to_string();
        (name, fs::read(&path).expect("a motion"))
    };
    paths.map(file).collect()
}

/// Measures all figures, and prints both halves: those that were seen, and those that were held back. First with limbs of one piece that
/// bend, and then with rigid ones.
fn halves(files: &[(String, Vec<u8>)]) -> Vec<Half> {
    let mut all = Vec::new();
    for (bends, legs) in [(true, "that bend"), (false, "that are rigid")] {
        let mut halves = [Half::default(), Half::default()];
        let only = env::var("OKOSHI_FIGURE").ok();
        let is_wanted =
            |figure: &DrawnFigure| only.as_ref().is_none_or(|name| name.contains(&figure.name));
        for figure in figures().into_iter().filter(is_wanted) {
            let is_held_back = !SEEN.contains(&figure.name.as_str());
            let half = &mut halves[usize::from(is_held_back)];
            measure(&figure, files, bends, half);
        }
        for (half, name) in halves.iter().zip(["seen", "held back"]) {
            eprintln!("{name}, legs {legs}:\n{half}");
        }
        all.extend(halves);
    }
    all
}

#[test]
fn figures_stand_fly_and_hold_their_arms_as_the_actor_does() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = read(FILES.iter().map(|file| project.join(file)));
    let halves = halves(&files);
    if let Ok(folder) = env::var("OKOSHI_BVH") {
        let entries = fs::read_dir(folder).expect("a folder of motions");
        let mut paths: Vec<PathBuf> = entries.map(|file| file.expect("a file").path()).collect();
        paths.sort();
        self::halves(&read(paths.into_iter()));
    }
    if env::var("OKOSHI_FIGURE").is_ok() {
        return;
    }
    for half in &halves {
        half.check();
    }
}
