//! Rows of the table: motion, and figures on a stage.

use super::signature::{
    Bounds, COLOUR_NAME, FILE, Form, HEX, NAMES, POINT, Parameter, Takes, number,
};
use super::{Allowed, Row, vocabulary};

static CLIP: [Parameter; 2] = [
    Parameter {
        name: "file",
        summary: "a file in the drawing's folder",
        takes: Takes::File,
    },
    Parameter {
        name: "clip",
        summary: "the name of the clip",
        takes: Takes::Text,
    },
];
static FRAMES: [Parameter; 2] = [
    number("omit", Bounds::COUNT, "drawings to leave out"),
    number("hold", Bounds::COUNT, "frames to hold"),
];
static CARRY_WORD: [Parameter; 1] = [Parameter {
    name: "what",
    summary: "what the limb takes over",
    takes: Takes::Choice(&vocabulary::CARRY),
}];
static FACTOR: [Parameter; 1] = [number("factor", Bounds::POSITIVE, "1 is the size as drawn")];
static SPEED: [Parameter; 1] = [number(
    "speed",
    Bounds::POSITIVE,
    "in drawing units per second",
)];
static SECONDS: [Parameter; 1] = [number(
    "seconds",
    Bounds::NOT_NEGATIVE,
    "when the pose is reached",
)];

pub(super) static BONE: Row = Row {
    forms: &[Form::new(&NAMES, &[])],
    default: "matched by name and position",
    summary: "the joints of the motion that drive the part",
    long: "A motion file has joints of its own; okoshi matches them with the parts by name and \
           position. Where a match is wrong, name the joint here. A name with spaces or \
           punctuation needs quotes.",
    example: "Rarm@Ubody$Bone RightArm RightForeArm",
    ..Row::ROW
};

pub(super) static CARRY: Row = Row {
    forms: &[Form::new(&CARRY_WORD, &[1])],
    default: "direction; change for spread wings, and three or more pairs of legs",
    summary: "what a limb takes over from the motion",
    long: "`direction`: the arm or leg points where the actor's does, however it is drawn. `change`: \
           it keeps the pose in which it is drawn, and turns by as much as the actor's does. A \
           bird's wings stay spread, and a spider's legs do not hang down.",
    example: "Wing@Body$Carry change",
    ..Row::ROW
};

pub(super) static MARK: Row = Row {
    forms: &[Form::new(&COLOUR_NAME, &[1]), Form::new(&HEX, &[1])],
    summary: "the coloured mark that moves the part in a filmed performance",
    long: "In a filmed performance, small coloured marks are moved by hand. A part with `Mark` \
           follows the mark of that colour.",
    example: "Rhand@Rarm$Mark red",
    ..Row::PLANNED
};

pub(super) static FOLLOW: Row = Row {
    forms: &[Form::new(&NAMES, &[])],
    summary: "joints that are edited together with this one",
    long: "Whatever a performance does to the part with `Mark`, it also does to the parts named \
           here: it moves the upper arm along with the hand, for example. A name that is a keyword, \
           or that contains spaces or punctuation, needs quotes.",
    example: "Rhand@Rarm$Mark red Follow Rarm Ubody",
    ..Row::PLANNED
};

pub(super) static MOTION: Row = Row {
    forms: &[Form::new(&CLIP, &[1, 2])],
    allowed: Allowed::PartAndDrawing,
    summary: "a motion for the figure",
    long: "The figure plays a motion-capture file (BVH); the file's joints are matched with the \
           parts. In the string of a figure's root part, `Motion` applies to that figure; in a `%` \
           string, to all figures. Several `Motion` give several clips; the second argument names \
           the clip.",
    example: "Lbody$Motion \"kick.bvh\" kick",
    ..Row::ROW
};

pub(super) static LIMITED: Row = Row {
    forms: &[Form::new(&FRAMES, &[2])],
    allowed: Allowed::PartAndDrawing,
    default: "full animation",
    summary: "limited animation, as in hand-drawn films",
    long: "`omit` is the number of in-between drawings to leave out where the motion is fastest, \
           `hold` the number of frames to hold where it is slowest. The motion snaps and rests \
           like a hand-drawn one.",
    example: "%Limited 4 30",
    ..Row::ROW
};

pub(super) static STAND: Row = Row {
    forms: &[Form::new(&POINT, &[2])],
    default: "where it is drawn",
    summary: "the figure's position on the stage",
    long: "The figure's position on the stage in drawing units, instead of the position where it \
           is drawn.",
    example: "Tree$Stand 40 -120",
    ..Row::PLANNED
};

pub(super) static SIZE: Row = Row {
    forms: &[Form::new(&FACTOR, &[1])],
    default: "1",
    summary: "makes the figure larger or smaller on the stage",
    long: "2 makes it twice as large, 0.5 half as large.",
    example: "Tree$Stand 40 -120 Size 1.5",
    ..Row::PLANNED
};

pub(super) static WALK: Row = Row {
    forms: &[Form::new(&SPEED, &[1])],
    summary: "makes the string's line a path that the named figure walks",
    long: "Draw a line, and write the figure's name and its speed beside it. The speed is in \
           drawing units per second.",
    example: "Boy$Walk 40",
    ..Row::PLANNED
};

pub(super) static POSE: Row = Row {
    forms: &[Form::new(&SECONDS, &[1])],
    summary: "makes the string's layer a key pose",
    long: "Copy the figure to a layer of its own and move its parts there: that is the figure's \
           pose at the given second.",
    example: "Boy$Pose 1.5",
    ..Row::PLANNED
};

pub(super) static PERFORM: Row = Row {
    forms: &[Form::new(&FILE, &[1])],
    allowed: Allowed::PartAndDrawing,
    summary: "a performed track that times and exaggerates the motion",
    long: "A track of coloured marks, made by `okoshi track` from a film in which somebody moves \
           them by hand. The motion takes its timing and its emphasis from the track.",
    example: "Lbody$Motion \"kick.bvh\" Perform \"hands.json\"",
    ..Row::PLANNED
};
