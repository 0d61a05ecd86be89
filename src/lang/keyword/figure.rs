//! Rows of the table: how a part looks and where it is.

use super::signature::{Bounds, Form, Grain, Parameter, Takes, number};
use super::words::ORIGIN;
use super::{Allowed, Flag, Keyword, Row, Status};

static RGBA: [Parameter; 4] = [
    number("r", Bounds::SHARE, "red"),
    number("g", Bounds::SHARE, "green"),
    number("b", Bounds::SHARE, "blue"),
    number("a", Bounds::SHARE, "opacity: 0 is clear, 1 is solid"),
];
static HEX: [Parameter; 1] = [Parameter {
    name: "hex",
    summary: "the colour, with opacity as seventh and eighth digit",
    takes: Takes::Hex,
}];
static COLOUR: [Parameter; 1] = [Parameter {
    name: "colour",
    summary: "the colour, as in CSS",
    takes: Takes::ColourName,
}];
static KIND: [Parameter; 1] = [Parameter {
    name: "kind",
    summary: "how thickness is given",
    takes: Takes::Kind,
}];
static ORIGIN_WORD: [Parameter; 1] = [Parameter {
    name: "where",
    summary: "the point",
    takes: Takes::Choice(&ORIGIN),
}];
static POINT: [Parameter; 2] = [
    number("x", Bounds::ANY, "to the right, drawing units"),
    number("y", Bounds::ANY, "down the page, drawing units"),
];
static DISTANCE: [Parameter; 1] = [number(
    "d",
    Bounds::ANY,
    "towards the viewer, drawing units",
)];
static DEGREES: [Parameter; 1] = [number(
    "degrees",
    Bounds::ANY,
    "counter-clockwise from the drawing's right",
)];
static SEGMENTS: [Parameter; 1] = [number(
    "n",
    Bounds::new(1., 256., Grain::Whole),
    "layers per half turn",
)];
static CREASE: [Parameter; 1] = [number(
    "degrees",
    Bounds::new(0., 180., Grain::Any),
    "the angle between two faces",
)];
static SHARE: [Parameter; 1] = [number("factor", Bounds::SHARE, "0 is none, 1 is full")];
static RGB: [Parameter; 3] = [
    number("r", Bounds::SHARE, "red"),
    number("g", Bounds::SHARE, "green"),
    number("b", Bounds::SHARE, "blue"),
];

pub(super) static ROWS: [Row; 11] = [
    Row {
        keyword: Keyword::Color,
        forms: &[
            Form {
                parameters: &RGBA,
                counts: &[3, 4],
            },
            Form {
                parameters: &HEX,
                counts: &[1],
            },
            Form {
                parameters: &COLOUR,
                counts: &[1],
            },
        ],
        flags: &[],
        allowed: Allowed::Part,
        default: "the shape's own fill",
        summary: "the part's colour",
        long: "Without `Color` a part has the colour that it is filled with. `Color` gives it \
               another one: as red, green and blue from 0 to 1 (and opacity as a fourth number), as \
               `#rrggbb`, or by its CSS name.\n\nIt takes the place of a fill; the picture of an \
               image stays as it is.",
        example: "Rarm@Ubody$Color 1 0.8 0.6",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Shape,
        forms: &[Form {
            parameters: &KIND,
            counts: &[1],
        }],
        flags: &[
            Flag {
                letter: 's',
                summary: "a second, mirrored copy on the other side of the drawing plane, moving with the first",
            },
            Flag {
                letter: 'c',
                summary: "the part turns about its centre, short for `Origin center`",
            },
            Flag {
                letter: 'd',
                summary: "a second, mirrored copy that moves by itself, with all that hangs on the part",
            },
        ],
        allowed: Allowed::Part,
        default: "default",
        summary: "how the flat outline becomes a solid",
        long: "Every part is drawn flat; `Shape` says how it gets its thickness: a plate \
               (`default`), rounded like an arm (`roundv`), like a ball (`round`), pointed (`cone`) \
               and so on. Each kind has its own parameters, and all of them may be left out \
               unless the kind needs a file.\n\nFlags stand directly behind the word: `-s` puts a \
               mirrored copy behind the drawing plane (two ears, say), `-d` makes that copy a part of \
               its own (`Tyre` and `Tyre.back`), `-c` lets the part turn about its centre. They \
               combine: `Shape -cd round`.",
        example: "Tyre@Car$Shape -cd default 20 30",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Offset,
        forms: &[Form {
            parameters: &DISTANCE,
            counts: &[1],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "0",
        summary: "moves the part towards the viewer, or away",
        long: "The part is moved by `d` drawing units towards the viewer; a negative `d` moves it \
               away. With `Shape -s` and `Shape -d` the two copies go to `d` and to `-d`.",
        example: "Rarm@Ubody$Offset 12",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Origin,
        forms: &[
            Form {
                parameters: &ORIGIN_WORD,
                counts: &[1],
            },
            Form {
                parameters: &POINT,
                counts: &[2],
            },
        ],
        flags: &[],
        allowed: Allowed::Part,
        default: "of the part's centre and its two ends, the one nearest to the parent's centre",
        summary: "the point about which the part turns",
        long: "A part turns about its origin: an arm about the shoulder, a wheel about its hub. \
               okoshi guesses it from the parent; where the guess is wrong, say `center`, `start` \
               (the end nearer to the parent), `end` (the other), or give the point itself in \
               drawing units.",
        example: "Rarm@Ubody$Origin start",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Axis,
        forms: &[Form {
            parameters: &DEGREES,
            counts: &[1],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "the outline's long direction",
        summary: "the direction of the part's axis",
        long: "`roundv`, `roundh`, `conev`, `coneh` and `lathe` go by the part's axis, which is the \
               outline's long direction. `Axis` sets it: 0 points to the right, 90 up, 180 to the left.",
        example: "Head@Ubody$Axis 90",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Segments,
        forms: &[Form {
            parameters: &SEGMENTS,
            counts: &[1],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "16",
        summary: "how fine a rounding is",
        long: "The number of steps in half a turn of a rounding. 16 looks round; 4 gives the \
               eight-sided look of old games; more than 32 is seldom worth its triangles.",
        example: "%Segments 8",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Smooth,
        forms: &[Form {
            parameters: &CREASE,
            counts: &[1],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "30",
        summary: "up to which angle an edge is shaded smooth",
        long: "Where two faces meet at less than this angle they are shaded as one smooth surface, \
               else as an edge. 0 shows every face, 180 none.",
        example: "%Smooth 0",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Metallic,
        forms: &[Form {
            parameters: &SHARE,
            counts: &[1],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "0",
        summary: "how metallic the part looks",
        long: "0 is paint, wood, cloth, skin; 1 is bare metal.",
        example: "Sword@Rarm$Metallic 1 Roughness 0.3",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Roughness,
        forms: &[Form {
            parameters: &SHARE,
            counts: &[1],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "0.9",
        summary: "how dull the part looks",
        long: "0 is a mirror, 1 is chalk.",
        example: "Visor@Head$Roughness 0.1",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Emissive,
        forms: &[Form {
            parameters: &RGB,
            counts: &[3],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "0 0 0",
        summary: "the light that the part gives off",
        long: "Red, green and blue from 0 to 1. The part is seen in this colour even in the dark: a \
               lamp, an eye, lava. It does not light other parts.",
        example: "Lamp$Emissive 1 0.9 0.5",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Alpha,
        forms: &[Form {
            parameters: &SHARE,
            counts: &[1],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "the fill's opacity",
        summary: "the part's opacity",
        long: "1 is solid, 0 is not seen at all; glass is something like 0.3.",
        example: "Window@Car$Alpha 0.3",
        status: Status::Built,
    },
];
