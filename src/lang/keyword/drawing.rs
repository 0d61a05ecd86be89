//! Rows of the table: the whole drawing, and motion.

use super::signature::{Bounds, Form, Parameter, Takes, number};
use super::words::{BIND, GROUND, STROKES};
use super::{Allowed, Keyword, Row, Status};

static SCALE: [Parameter; 1] = [number("s", Bounds::POSITIVE, "centimetres a drawing unit")];
static AXES: [Parameter; 3] = [
    Parameter {
        name: "right",
        summary: "what the drawing's right becomes",
        takes: Takes::SignedAxis,
    },
    Parameter {
        name: "up",
        summary: "what the drawing's up becomes",
        takes: Takes::SignedAxis,
    },
    Parameter {
        name: "front",
        summary: "what the viewer's direction becomes",
        takes: Takes::SignedAxis,
    },
];
static GROUND_WORD: [Parameter; 1] = [Parameter {
    name: "where",
    summary: "what lies at the world's origin",
    takes: Takes::Choice(&GROUND),
}];
static POINT: [Parameter; 2] = [
    number("x", Bounds::ANY, "to the right, drawing units"),
    number("y", Bounds::ANY, "down the page, drawing units"),
];
static LET: [Parameter; 2] = [
    Parameter {
        name: "name",
        summary: "the new variable",
        takes: Takes::Variable,
    },
    number("value", Bounds::ANY, "what the name stands for"),
];
static BIND_WORD: [Parameter; 1] = [Parameter {
    name: "distance",
    summary: "what the distance is measured to",
    takes: Takes::Choice(&BIND),
}];
static STROKES_WORD: [Parameter; 1] = [Parameter {
    name: "which",
    summary: "what becomes a part",
    takes: Takes::Choice(&STROKES),
}];
static MOTION: [Parameter; 2] = [
    Parameter {
        name: "file",
        summary: "a file in the drawing's folder",
        takes: Takes::File,
    },
    Parameter {
        name: "clip",
        summary: "how the clip is called",
        takes: Takes::Text,
    },
];
static FRAMES: [Parameter; 2] = [
    number("omit", Bounds::COUNT, "drawings to leave out"),
    number("hold", Bounds::COUNT, "drawings to hold"),
];
static FACTOR: [Parameter; 1] = [number("factor", Bounds::POSITIVE, "1 is the size as drawn")];
static SPEED: [Parameter; 1] = [number(
    "speed",
    Bounds::POSITIVE,
    "how fast the path is walked",
)];
static SECONDS: [Parameter; 1] = [number(
    "seconds",
    Bounds::NOT_NEGATIVE,
    "when the pose is reached",
)];
static FILE: [Parameter; 1] = [Parameter {
    name: "file",
    summary: "a file in the drawing's folder",
    takes: Takes::File,
}];

const fn one(parameters: &'static [Parameter]) -> Form {
    Form {
        parameters,
        counts: &[1],
    }
}

const fn two(parameters: &'static [Parameter]) -> Form {
    Form {
        parameters,
        counts: &[2],
    }
}

pub(super) static ROWS: [Row; 13] = [
    Row {
        keyword: Keyword::Scale,
        forms: &[one(&SCALE)],
        flags: &[],
        allowed: Allowed::Drawing,
        default: "1",
        summary: "how large the model is: one drawing unit is `s` centimetres",
        long: "A figure that is 170 units high in the drawing becomes 1.7 metres high with `Scale 1`. \
               Drawing units are what the drawing program shows at a document scale of 1.",
        example: "%Scale 2",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Axes,
        forms: &[Form {
            parameters: &AXES,
            counts: &[3],
        }],
        flags: &[],
        allowed: Allowed::Drawing,
        default: "+x +y +z",
        summary: "which way the drawing faces in the model's world",
        long: "Three directions: what the drawing's right, its up and the viewer's direction become. \
               `+x +y +z` is right for glTF; `+x +z -y` stands a drawing up in a world where z is up.",
        example: "%Axes +x +z -y",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Ground,
        forms: &[one(&GROUND_WORD), two(&POINT)],
        flags: &[],
        allowed: Allowed::Drawing,
        default: "bottom",
        summary: "what lies at the world's origin",
        long: "`bottom` is the middle of the figures' lower edge, so that they stand on the ground. \
               `page` is the page's top left corner; or give a point in drawing units.",
        example: "%Ground 120 300",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Let,
        forms: &[two(&LET)],
        flags: &[],
        allowed: Allowed::Drawing,
        default: "",
        summary: "gives a number a name",
        long: "The name can then stand wherever a number can: alone (`Offset thick`) or in a \
               calculation (`Offset (thick / 2)`). A negative one needs parentheses: `(-thick)`. \
               `Let` may stand behind its use, and in another `%` string. A variable cannot have \
               the name of a keyword.",
        example: "%Let thick 20 Let half (thick / 2)",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Bind,
        forms: &[one(&BIND_WORD)],
        flags: &[],
        allowed: Allowed::Drawing,
        default: "center",
        summary: "how a string finds its part",
        long: "A string that is not grouped with its part goes to the nearest one. `center` measures \
               to the parts' centres, `outline` to their outlines, which is better for parts that \
               are long or lie inside each other.",
        example: "%Bind outline",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Strokes,
        forms: &[one(&STROKES_WORD)],
        flags: &[],
        allowed: Allowed::Drawing,
        default: "none in annotated drawings, lines in others",
        summary: "which strokes become parts",
        long: "Usually lines are guides and only filled shapes are parts. `lines` makes parts of \
               lines without a fill, `all` of the borders of filled shapes too.",
        example: "%Strokes lines",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Motion,
        forms: &[Form {
            parameters: &MOTION,
            counts: &[1, 2],
        }],
        flags: &[],
        allowed: Allowed::PartAndDrawing,
        default: "none",
        summary: "a motion for the figure",
        long: "A motion-capture file (BVH) that the figure plays; its joints are matched with the \
               parts. In the string of the figure's root part it is for that figure, in a `%` string for all. \
               Several add up to several clips; the second word names the clip.",
        example: "Lbody$Motion \"kick.bvh\" kick",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Limited,
        forms: &[two(&FRAMES)],
        flags: &[],
        allowed: Allowed::PartAndDrawing,
        default: "full animation",
        summary: "limited animation, as in hand-drawn films",
        long: "`omit` is the number of in-betweens to leave out where the motion is fastest, `hold` \
               the number of frames to hold where it is slowest: the motion snaps and rests like a \
               drawn one.",
        example: "%Limited 4 30",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Stand,
        forms: &[two(&POINT)],
        flags: &[],
        allowed: Allowed::Part,
        default: "where it is drawn",
        summary: "where the figure stands on the stage",
        long: "The place on the stage, in drawing units, instead of the place where the figure is drawn.",
        example: "Tree$Stand 40 -120",
        status: Status::Planned,
    },
    Row {
        keyword: Keyword::Size,
        forms: &[one(&FACTOR)],
        flags: &[],
        allowed: Allowed::Part,
        default: "1",
        summary: "makes the figure larger or smaller on the stage",
        long: "2 makes it twice as large, 0.5 half as large.",
        example: "Tree$Stand 40 -120 Size 1.5",
        status: Status::Planned,
    },
    Row {
        keyword: Keyword::Walk,
        forms: &[one(&SPEED)],
        flags: &[],
        allowed: Allowed::Part,
        default: "none",
        summary: "the string's line is a path that the named figure walks",
        long: "Draw a line, and write beside it the figure's name and its speed, in drawing units a \
               second.",
        example: "Boy$Walk 40",
        status: Status::Planned,
    },
    Row {
        keyword: Keyword::Pose,
        forms: &[one(&SECONDS)],
        flags: &[],
        allowed: Allowed::Part,
        default: "none",
        summary: "the string's layer is a key pose",
        long: "Copy the figure to a layer of its own and move its parts there: that is its pose at \
               that second.",
        example: "Boy$Pose 1.5",
        status: Status::Planned,
    },
    Row {
        keyword: Keyword::Perform,
        forms: &[one(&FILE)],
        flags: &[],
        allowed: Allowed::PartAndDrawing,
        default: "none",
        summary: "a performed track that times and exaggerates the motion",
        long: "A track of coloured marks, made by `okoshi track` from a film in which somebody moves \
               them by hand. The motion takes its timing and its emphasis from it.",
        example: "Lbody$Motion \"kick.bvh\" Perform \"hands.json\"",
        status: Status::Planned,
    },
];
