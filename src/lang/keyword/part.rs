//! Rows of the table: the shape, position and material of a part.

use super::signature::{
    Bounds, DISTANCE, Form, POINT, Parameter, Restriction, Takes, Usual, choice, number, parameter,
};
use super::{Row, flag, vocabulary};

static RGBA: [Parameter; 4] = [
    number("r", Bounds::FRACTION, "red"),
    number("g", Bounds::FRACTION, "green"),
    number("b", Bounds::FRACTION, "blue"),
    number(
        "a",
        Bounds::FRACTION,
        "opacity: 0 is transparent, 1 is opaque",
    ),
];
static FACTOR: [Parameter; 1] = [number("factor", Bounds::FRACTION, "0 is none, 1 is full")];
static RGB: [Parameter; 3] = [
    number("r", Bounds::FRACTION, "red"),
    number("g", Bounds::FRACTION, "green"),
    number("b", Bounds::FRACTION, "blue"),
];

pub(super) static COLOR: Row = Row {
    forms: &[
        Form::new(&RGBA, &[3, 4]),
        Form::one(&parameter(
            "hex",
            Takes::Hex,
            "the colour; the seventh and eighth digit give the opacity",
        )),
        Form::one(&parameter(
            "colour",
            Takes::ColorName,
            "the colour's CSS name",
        )),
    ],
    default: "the shape's own fill",
    summary: "the part's colour",
    long: "Without `Color` a part keeps the colour it is filled with. `Color` sets another one: \
           as red, green and blue from 0 to 1 (with opacity as an optional fourth number), as \
           `#rrggbb`, or by its CSS name.\n\n`Color` replaces a fill. It does not change the \
           picture of an image.",
    example: "Rarm@Ubody$Color 1 0.8 0.6",
    ..Row::ROW
};

pub(super) static SHAPE: Row = Row {
    forms: &[Form::one(&parameter(
        "kind",
        Takes::Kind,
        "how the part gets its thickness",
    ))],
    flags: &[
        flag(
            's',
            "a second, mirrored copy on the other side of the drawing plane that moves with the first",
        ),
        flag(
            'c',
            "the part turns about its centre, short for `Origin center`",
        ),
        flag(
            'd',
            "a second, mirrored copy that moves independently, with copies of all attached parts",
        ),
    ],
    default: "default",
    summary: "how the flat outline becomes a solid",
    long: "Every part is drawn flat; `Shape` says how it gets its thickness: a plate (`default`), \
           rounded like an arm (`roundv`), rounded like a ball (`round`), pointed (`cone`) and so \
           on. Each kind has its own parameters. All of them are optional, except for the file \
           that `model` needs.\n\nFlags come directly after the keyword: `-s` adds a mirrored copy \
           behind the drawing plane (a second ear, for example), `-d` makes that copy a part of its \
           own (`Tyre` and `Tyre.back`), `-c` lets the part turn about its centre. Flags can be \
           combined: `Shape -cd round`.\n\nA drawing that never says `Shape` is built as a toy: shapes \
           of which more than half of the outline is curved are inflated, lines are tubes, and the \
           others are plates. `%Shape default` makes plates of all.",
    example: "Tyre@Car$Shape -cd default 20 30",
    ..Row::ROW
};

pub(super) static OFFSET: Row = Row {
    forms: &[Form::new(&DISTANCE, &[1])],
    default: "0",
    summary: "moves the part towards the viewer, or away",
    long: "Moves the part by `d` drawing units towards the viewer, or away if `d` is negative. \
           With `Shape -s` and `Shape -d` one copy moves to `d` and the other to `-d`.",
    example: "Rarm@Ubody$Offset 12",
    ..Row::ROW
};

pub(super) static STACK: Row = Row {
    forms: &[Form::one(&number(
        "factor",
        Bounds::NOT_NEGATIVE.usually(Usual::Between(0., 3.)),
        "0 is none, 1 is the usual distance",
    ))],
    default: "1",
    summary: "how far the order of drawing spreads parts in depth",
    long: "What is drawn later lies in front: an arm that is drawn over the trunk is moved towards \
           the viewer, one that is drawn before it away. `Stack` multiplies that distance, of one \
           part or, after `%`, of all. With 0 parts stay in one plane; what is drawn later still \
           comes out of what it covers.",
    example: "Rarm@Ubody$Stack 0.5",
    ..Row::ROW
};

pub(super) static ORIGIN: Row = Row {
    forms: &[
        Form::one(&choice("where", &vocabulary::ORIGIN, "the point")),
        Form::new(&POINT, &[2]),
    ],
    default: "the part's centre or one of its two ends, whichever is nearest to the parent's centre; of a limb the end at its parent, of a wheel its centre",
    summary: "the point about which the part turns",
    long: "A part turns about its origin: an arm about the shoulder, a wheel about its hub. okoshi \
           guesses the origin from the parent; a limb by its name, such as `Rarm` or `Tail`, turns about \
           the end at its parent. Where the guess is wrong, write `center`, `start` \
           (the end nearer to the parent), `end` (the other end), or give the point itself in \
           drawing units.",
    example: "Rarm@Ubody$Origin start",
    ..Row::ROW
};

pub(super) static AXIS: Row = Row {
    forms: &[Form::one(&number(
        "degrees",
        Bounds::ANY.usually(Usual::Between(-180., 180.)),
        "counter-clockwise from the drawing's right",
    ))],
    default: "the outline's long direction",
    summary: "the direction of the part's axis",
    long: "`roundv`, `roundh`, `conev`, `coneh` and `lathe` depend on the part's axis, which is \
           the outline's long direction. `Axis` sets it: 0 points right, 90 up, 180 left.",
    example: "Head@Ubody$Axis 90",
    ..Row::ROW
};

pub(super) static SIDE: Row = Row {
    forms: &[Form::one(&choice(
        "which",
        &vocabulary::SIDE,
        "where the shape shows",
    ))],
    default: "found from the drawing",
    summary: "whether a shape shows on the far side too",
    long: "A drawing shows the front; what the back shows follows from it. Hair, hats and hoods that \
           go around a head from above close behind it, and so does a jacket that covers most of the \
           border of a shirt; a face, a button or a badge shows in front alone. `both` puts a detail \
           on the back as well, mirrored: a saddle, the wheel cover of a car. `near` keeps a shape \
           where it is drawn: a fringe without hair behind. Shapes in one group share the word of \
           their string.",
    example: "Saddle@Horse$Side both",
    ..Row::ROW
};

pub(super) static SEGMENTS: Row = Row {
    forms: &[Form::one(&number(
        "n",
        Bounds::new(1., 256., Restriction::Integer).usually(Usual::Between(2., 48.)),
        "steps per half turn",
    ))],
    default: "16",
    summary: "how finely a rounding is divided",
    long: "The number of steps in half a turn of a rounding. 16 looks round; 4 gives the \
           eight-sided look of old games; more than 32 is seldom worth the extra triangles. \
           Without it, `inflate` divides shapes that are very small beside the rest of the \
           drawing more coarsely, down to 8.",
    example: "%Segments 8",
    ..Row::ROW
};

pub(super) static SMOOTH: Row = Row {
    forms: &[Form::one(&number(
        "degrees",
        Bounds::new(0., 180., Restriction::None),
        "the angle between two faces",
    ))],
    default: "30",
    summary: "the largest angle at which an edge is shaded smooth",
    long: "Where two faces meet at less than this angle they are shaded as one smooth surface; \
           otherwise the edge between them shows. With 0 every edge shows, with 180 none.",
    example: "%Smooth 0",
    ..Row::ROW
};

pub(super) static METALLIC: Row = Row {
    forms: &[Form::new(&FACTOR, &[1])],
    default: "0",
    summary: "how metallic the part looks",
    long: "0 is paint, wood, cloth or skin; 1 is bare metal.",
    example: "Sword@Rarm$Metallic 1 Roughness 0.3",
    ..Row::ROW
};

pub(super) static ROUGHNESS: Row = Row {
    forms: &[Form::new(&FACTOR, &[1])],
    default: "0.9",
    summary: "how matt the part looks",
    long: "0 is a mirror, 1 is chalk.",
    example: "Visor@Head$Roughness 0.1",
    ..Row::ROW
};

pub(super) static EMISSIVE: Row = Row {
    forms: &[Form::new(&RGB, &[3])],
    default: "0 0 0",
    summary: "the light that the part gives off",
    long: "Red, green and blue from 0 to 1. The part shows this colour even in the dark: a lamp, \
           an eye, lava. It does not light other parts.",
    example: "Lamp$Emissive 1 0.9 0.5",
    ..Row::ROW
};

pub(super) static ALPHA: Row = Row {
    forms: &[Form::new(&FACTOR, &[1])],
    default: "the fill's opacity",
    summary: "the part's opacity",
    long: "1 is opaque, 0 is invisible; glass is about 0.3.",
    example: "Window@Car$Alpha 0.3",
    ..Row::ROW
};

pub(super) static TEXTURE: Row = Row {
    forms: &[Form::one(&parameter(
        "file",
        Takes::File,
        "a file in the drawing's folder",
    ))],
    summary: "an image on the part",
    long: "The image (PNG, JPEG, GIF or WebP) covers the part's bounding box as seen from the \
           front; on terrain it covers each tile. It replaces the part's fill; `Color` tints it. \
           The file must be in the drawing's folder or below it.",
    example: "Sail@Ship$Texture \"canvas.png\"",
    ..Row::ROW
};
