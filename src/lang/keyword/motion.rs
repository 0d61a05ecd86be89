//! Rows of the table: motion, and figures on a stage.

use super::signature::{
    Bounds, Form, Parameter, Restriction, Takes, Usual, choice, number, parameter,
};
use super::{Allowed, Row, flag, vocabulary};

const BVH: Parameter = parameter("file", Takes::File, "a file in the drawing's folder");
const UP: Parameter = parameter(
    "up",
    Takes::SignedAxis,
    "the axis of the file that points up, where okoshi does not find it",
);
const NAME: Parameter = parameter("name", Takes::Text, "the name of the clip");
static FILE_CLIP: [Parameter; 2] = [BVH, UP];
static NAMED_CLIP: [Parameter; 3] = [BVH, NAME, UP];
static OWN_CLIP: [Parameter; 2] = [
    choice("clip", &vocabulary::CLIPS, "a clip that comes along"),
    NAME,
];
const SECONDS: Parameter = number(
    "seconds",
    Bounds::POSITIVE.usually(Usual::Between(0.5, 10.)),
    "how long it plays: as many whole cycles as come nearest to it; of a file that is no loop, so much of its beginning",
);
/// A motion is played at most so much faster, or slower.
pub(crate) const SPEED: Bounds =
    Bounds::new(0.01, 100.0, Restriction::None).usually(Usual::Between(0.25, 4.));
const SPEED_WORD: Parameter = choice("speed", &vocabulary::SPEED, "how fast it plays");
const FACTOR: Parameter = number("factor", SPEED, "2 is twice as fast, .5 half as fast");
static OF_FILES: [Parameter; 7] = [
    SECONDS,
    choice("from", &vocabulary::FROM, "where it begins"),
    number(
        "start",
        Bounds::NOT_NEGATIVE.usually(Usual::Between(0., 10.)),
        "in seconds of the file, which begins at 0",
    ),
    choice("to", &vocabulary::TO, "where it ends"),
    number(
        "end",
        Bounds::POSITIVE.usually(Usual::Between(0., 10.)),
        "in seconds of the file",
    ),
    SPEED_WORD,
    FACTOR,
];
static OF_OWN_CLIPS: [Parameter; 3] = [SECONDS, SPEED_WORD, FACTOR];
static OF_FITTING_CLIPS: [Parameter; 4] = [SECONDS, SPEED_WORD, FACTOR, NAME];
static FRAMES: [Parameter; 2] = [
    number(
        "omit",
        Bounds::COUNT.usually(Usual::Between(0., 24.)),
        "drawings to leave out",
    ),
    number(
        "hold",
        Bounds::COUNT.usually(Usual::Between(0., 60.)),
        "frames to hold",
    ),
];
static DRAWING: [Parameter; 2] = [
    number(
        "frame",
        Bounds::new(1., 1e6, Restriction::Integer),
        "a drawing: a frame of the motion, counted from 1",
    ),
    number(
        "frames",
        Bounds::COUNT,
        "for how many frames it stands; 0 leaves it out",
    ),
];
const TRACK: Parameter = parameter(
    "file",
    Takes::File,
    "a track made by `okoshi track`, in the drawing's folder",
);
const FRAME: Bounds = Bounds::new(1., 1e6, Restriction::Integer);
const INPUT_KEY: Parameter = number(
    "input-key",
    FRAME,
    "the key frame of the track, at 24 frames a second",
);
const MOTION_KEY: Parameter = number(
    "motion-key",
    FRAME,
    "the key frame of the motion, which is shown at the time of the track's",
);
static TRACK_AND_KEYS: [Parameter; 3] = [TRACK, INPUT_KEY, MOTION_KEY];
static TRACK_MARK_AND_KEYS: [Parameter; 4] = [
    TRACK,
    parameter(
        "mark",
        Takes::Text,
        "the name of the mark whose part is emphasised",
    ),
    INPUT_KEY,
    MOTION_KEY,
];

pub(super) static BONE: Row = Row {
    forms: &[Form::new(
        &[parameter("name", Takes::Names, "one name or several")],
        &[],
    )],
    default: "matched by name and position",
    summary: "the joints of the motion that drive the part",
    long: "A motion file has joints of its own; okoshi matches them with the parts by name and \
           position. Where a match is wrong, name the joint here. A name with spaces or \
           punctuation needs quotes.",
    example: "Rarm@Ubody$Bone RightArm RightForeArm",
    ..Row::ROW
};

pub(super) static BEND: Row = Row {
    forms: &[Form::one(&number(
        "joints",
        Bounds::new(0., 16., Restriction::Integer),
        "how many joints the shape has inside; 0 is a rigid one",
    ))],
    default: "as the part needs",
    summary: "joints inside one shape: an arm with an elbow, a tail that curls",
    long: "An arm or a leg that is drawn as one shape has an elbow or a knee in its middle, or where it \
           is drawn bent; a neck has one joint too, and a tail four. The surface bends about them \
           like skin. With `Bend` a part has as many joints as you say, at equal distances along \
           its middle line, and with `Bend 0` none: a wooden leg. The model has a node for each \
           piece, `Arm`, `Arm.2` and so on.",
    example: "Tentacle@Body$Bend 6",
    ..Row::ROW
};

pub(super) static SWING: Row = Row {
    forms: &[Form::new(
        &[number(
            "stiffness",
            Bounds::POSITIVE.usually(Usual::Between(0.25, 8.)),
            "1 is like hair, 4 swings twice as fast",
        )],
        &[0, 1],
    )],
    default: "off",
    summary: "the part swings while the figure moves: hair, a tail, a cape",
    long: "The part lags behind what it hangs on and overshoots, like a weight on a spring, but it \
           never turns by more than 60 degrees. As it is drawn it is at rest. `stiffness` is 1 for \
           hair; with 4 the part swings twice as fast and half as far, with 0.25 it is slow and \
           heavy. Strands of several parts swing each on its own if each has `Swing`.",
    example: "Tail@Body$Swing 2",
    ..Row::ROW
};

pub(super) static FACING: Row = Row {
    forms: &[Form::one(&choice(
        "where",
        &vocabulary::FACING,
        "where the figure looks",
    ))],
    allowed: Allowed::PartAndDrawing,
    default: "found from the drawing",
    summary: "where the figure looks",
    long: "A figure in profile walks to the side that it looks to, and its limbs drawn last are on the \
           near side. okoshi finds the direction from the drawing: from a head beside the trunk, legs \
           that overlap, one eye, a nose that leaves the head, a tail at the other side, wheels in a \
           row, and words such as `front leg` and `far leg`; two eyes and a symmetric face speak for \
           the front. `okoshi inspect` tells which, and why. Where it is wrong, `Facing` in the \
           string of one of the figure's parts says so; in a `%` string, it says so of all figures. \
           `back` is a figure that is seen from behind: its left arm is drawn on the left. `up` is an \
           animal that is seen from above, such as a beetle: the model stands as it is drawn, and its \
           clips lay it on the ground, with its head away from us if that is drawn above, else \
           towards us.",
    example: "Dog$Facing left",
    ..Row::ROW
};

pub(super) static CARRY: Row = Row {
    forms: &[Form::one(&choice(
        "what",
        &vocabulary::CARRY,
        "what the limb takes over",
    ))],
    default: "direction; change for spread wings, and three or more pairs of legs",
    summary: "what a limb takes over from the motion",
    long: "`direction`: the arm or leg points where the actor's does, however it is drawn. `change`: \
           it keeps the pose in which it is drawn, and turns by as much as the actor's does. A \
           bird's wings stay spread, and a spider's legs do not hang down.",
    example: "Wing@Body$Carry change",
    ..Row::ROW
};

pub(super) static MARK: Row = Row {
    forms: &[
        Form::one(&parameter(
            "colour",
            Takes::ColorName,
            "the CSS name of the mark's colour",
        )),
        Form::one(&parameter("hex", Takes::Hex, "the mark's colour")),
    ],
    summary: "the coloured mark that performs the part",
    long: "A puppet of the figure, cut out of paper, carries coloured marks, and somebody moves it by \
           hand before a camera. A part with `Mark` is performed by the mark of that colour: \
           `okoshi puppet` prints the mark on the part, `okoshi track` finds it in the film, and \
           `Perform` gives the motion the timing and the emphasis of the performance.\n\n\
           The ends of arms or legs show a movement best: mark hands or feet, two to four of them, \
           in colours that are far apart.",
    example: "Rhand@Rarm$Mark red",
    ..Row::ROW
};

pub(super) static FOLLOW: Row = Row {
    forms: &[Form::new(
        &[parameter(
            "name",
            Takes::Names,
            "a part, or a joint of the motion",
        )],
        &[],
    )],
    summary: "joints that are edited together with this one",
    long: "A performance makes the movement of a part with `Mark` smaller where another mark is \
           emphasised. The parts named here, or joints of the motion, are treated in the same way: \
           the hips that swing with a leg, for example. A name that is a keyword, or that contains \
           spaces or punctuation, needs quotes.",
    example: "Rhand@Rarm$Mark red Follow Head",
    ..Row::ROW
};

pub(super) static MOTION: Row = Row {
    forms: &[
        Form::new(&FILE_CLIP, &[1, 2]).repeated(&OF_FILES),
        Form::new(&NAMED_CLIP, &[2, 3]).repeated(&OF_FILES),
        Form::new(&OWN_CLIP, &[1, 2]).repeated(&OF_OWN_CLIPS),
        Form::new(&[], &[0]).repeated(&OF_FITTING_CLIPS),
    ],
    flags: &[
        flag('i', "in place: the figure does not travel over the ground"),
        flag(
            'l',
            "a loop: the best cycle of the motion, with its ends blended",
        ),
    ],
    allowed: Allowed::PartAndDrawing,
    summary: "a motion for the figure",
    long: "The figure plays a motion-capture file (BVH), or one of the clips that come along: \
           `walk`, `run` and so on, without quotes. The motion's joints are matched with the \
           parts. `Motion` alone plays the clip that fits what the figure has: legs walk, wheels roll, \
           wings fly, fins swim, tentacles float, one body hops, and plants sway. In the string of a figure's root part, `Motion` applies to that figure; in a `%` \
           string, to all figures. Several `Motion` give several clips; a word behind the file, \
           or behind the clip that comes along, names the clip. An axis at the end says which way is up in the file: \
           `Motion \"crawl.bvh\" crawl +z`.\n\n\
           `from` and `to` cut a file, in its own seconds, and `speed` plays faster or slower: \
           `Motion \"kick.bvh\" kick from 1.2 to 2.4 speed .8`. A number says for how many seconds a \
           clip plays, and several clips in one `Motion` play in turn, as one clip: `Motion walk 2 wave 1 idle 1`. \
           Loops play as many whole cycles as come nearest to that, once without a number. The figure \
           goes on from where it is.\n\n\
           `-i` keeps the figure in place, `-l` makes a loop of the motion, or of all that play in turn: \
           `Motion -il walk`.",
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
           like a hand-drawn one.\n\n\
           Behind a `Motion`, `Limited` belongs to that clip: `Motion walk Limited 2 8`. \
           Elsewhere it applies to all clips of the figure, or of the drawing in a `%` string, \
           that have no `Limited` of their own.",
    example: "%Limited 4 30",
    ..Row::ROW
};

pub(super) static HELD: Row = Row {
    forms: &[Form::new(&DRAWING, &[2]).listed()],
    allowed: Allowed::PartAndDrawing,
    default: "as `Limited` says",
    summary: "drawings of a clip that are chosen by hand, and how long each stands",
    long: "A list of drawings, in their order: a frame of the motion, and for how many frames its \
           drawing stands. 0 leaves the drawing out, and the one before it stands for longer. \
           What stands for longer covers the drawings behind it; behind one that stands for \
           less, the next begins sooner. The clip is as long as before.\n\n\
           All other drawings stand as `Limited` says, or for a frame each without it. A \
           drawing that `Limited` leaves out or covers is back if it is in the list. On the \
           page of `okoshi preview` drawings are dragged, and nobody counts frames.\n\n\
           Behind a `Motion`, `Held` belongs to that clip: `Motion walk Held 7 3 12 0`. \
           Elsewhere it applies to all clips of the figure, or of the drawing in a `%` string, \
           that have no `Held` of their own.",
    example: "%Held 7 3 12 0",
    ..Row::ROW
};

pub(super) static SIZE: Row = Row {
    forms: &[Form::one(&number(
        "factor",
        Bounds::POSITIVE,
        "1 is the size as drawn",
    ))],
    default: "1",
    summary: "makes the figure larger or smaller on the stage",
    long: "2 makes it twice as large, 0.5 half as large.",
    example: "Tree$Size 1.5",
    ..Row::PLANNED
};

pub(super) static WALK: Row = Row {
    forms: &[Form::one(&number(
        "speed",
        Bounds::POSITIVE,
        "in drawing units per second",
    ))],
    summary: "makes the string's line a path that the named figure walks",
    long: "Draw a line, and write the figure's name and its speed beside it. The speed is in \
           drawing units per second.",
    example: "Boy$Walk 40",
    ..Row::PLANNED
};

static POSE_PARAMETERS: [Parameter; 2] = [
    number(
        "seconds",
        Bounds::new(0., 3600., Restriction::None).usually(Usual::Between(0., 4.)),
        "when the pose is reached, from the beginning of the clip",
    ),
    parameter(
        "clip",
        Takes::Text,
        "the name of the clip, `poses` if none is given",
    ),
];

pub(super) static POSE: Row = Row {
    forms: &[Form::new(&POSE_PARAMETERS, &[1, 2])],
    flags: &[flag('l', "the clip is a loop: it ends with its first pose")],
    summary: "makes the string's layer a key pose: copies of parts, moved to where they are then",
    long: "Draw key poses as in a cartoon: add a layer, clone the parts that move into it (in Inkscape, \
           Alt+D and Shift+Page Up, or Keep pose on the page of `okoshi preview`), turn the clones, and write \
           this string into the layer. Nothing in it is built, and it may be hidden or half transparent.\n\n\
           Each part is turned about its joint as its copy is turned; a part on which nothing \
           but others hang also moves. A part without a copy keeps the pose of the layer before. Several layers \
           play in their order, from bottom to top, smoothly from one pose to the next. The clip begins with the pose \
           at 0 seconds, or with the drawing itself.\n\n\
           The name of a part before `$` says whose poses they are. It may be missing, \
           as the copies say so, too.",
    example: "Boy$Pose 1.5",
    ..Row::ROW
};

pub(super) static PERFORM: Row = Row {
    forms: &[
        Form::new(&TRACK_AND_KEYS, &[1, 3]),
        Form::new(&TRACK_MARK_AND_KEYS, &[2, 4]),
    ],
    flags: &[
        flag('t', "the motion keeps its own timing"),
        flag('e', "no emphasis: the other joints move as far as before"),
        flag('c', "no camera"),
        flag('r', "the figure moves instead of a camera"),
    ],
    allowed: Allowed::PartAndDrawing,
    default: "as recorded",
    summary: "a performed track that times and exaggerates the motion",
    long: "The file is a track of coloured marks, made by `okoshi track` from a film in which \
           somebody moves a puppet. The motion takes its timing from the mark that moves most: the \
           key pose comes when that mark is fastest. The part with that `Mark` keeps its movement, \
           those with other marks move less, and a camera approaches it.\n\n\
           Behind a `Motion`, `Perform` belongs to that clip. Elsewhere it applies to all clips of \
           the figure, or of the drawing in a `%` string, that have no `Perform` of their own.\n\n\
           Nothing else needs to be set. A mark's name behind the file says which one is \
           emphasised, and two numbers say which frame of the track and which frame of the motion \
           are the keys, counted from 1: `Perform \"hands.json\" red 14 31`.",
    example: "Lbody$Motion \"kick.bvh\" Perform \"hands.json\"",
    ..Row::ROW
};
