//! Rows of the table: textures, motion marks, terrain and billboards.

use super::signature::{Bounds, Form, Grain, NOTHING, Parameter, Takes, number};
use super::words::TILE;
use super::{Allowed, Keyword, Row, Status};

static FILE: [Parameter; 1] = [Parameter {
    name: "file",
    summary: "a file in the drawing's folder",
    takes: Takes::File,
}];
static DEPTH: [Parameter; 1] = [number(
    "d",
    Bounds::ANY,
    "towards the viewer, drawing units",
)];
static NAMES: [Parameter; 1] = [Parameter {
    name: "name",
    summary: "one name or several",
    takes: Takes::Names,
}];
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
static SIZE: [Parameter; 1] = [number(
    "size",
    Bounds::POSITIVE,
    "side of a tile, drawing units",
)];
static TILE_WORD: [Parameter; 1] = [Parameter {
    name: "tile",
    summary: "what the tiles are",
    takes: Takes::Choice(&TILE),
}];
static RADIUS: [Parameter; 1] = [number(
    "r",
    Bounds::new(0., 0.5, Grain::Any),
    "radius of the bevel, in tiles",
)];
static FACTOR: [Parameter; 1] = [number(
    "factor",
    Bounds::NOT_NEGATIVE,
    "ridge height over roof depth",
)];
static ANGLES: [Parameter; 2] = [
    number(
        "theta",
        Bounds::ANY,
        "by how much the character is turned, degrees",
    ),
    number(
        "phi",
        Bounds::new(-90., 90., Grain::Any),
        "by how much it is seen from above, degrees",
    ),
];

const fn one(parameters: &'static [Parameter]) -> Form {
    Form {
        parameters,
        counts: &[1],
    }
}

pub(super) static ROWS: [Row; 12] = [
    Row {
        keyword: Keyword::Texture,
        forms: &[one(&FILE)],
        flags: &[],
        allowed: Allowed::Part,
        default: "none",
        summary: "an image on the part",
        long: "The image (PNG, JPEG, GIF or WebP) is laid over the part's box as it is seen from the \
               front; on terrain, over each tile. It takes the place of the part's fill; `Color` tints it. \
               The file must lie in the drawing's folder or below it.",
        example: "Sail@Ship$Texture \"canvas.png\"",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Depth,
        forms: &[one(&DEPTH)],
        flags: &[],
        allowed: Allowed::Part,
        default: "estimated from the views",
        summary: "the depth of a billboard's region",
        long: "A character drawn in two views gets the depth of each region from how far it moves \
               between them. `Depth` sets it instead, in drawing units towards the viewer of the \
               front view.",
        example: "Nose$Depth 14",
        status: Status::Planned,
    },
    Row {
        keyword: Keyword::Bone,
        forms: &[Form {
            parameters: &NAMES,
            counts: &[],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "matched by name and place",
        summary: "the joints of the motion that drive the part",
        long: "A motion file has joints of its own; okoshi matches them with the parts by name and \
               place. Where it is wrong, name the joint here. A name with signs in it stands in \
               quotes.",
        example: "Rarm@Ubody$Bone RightArm RightForeArm",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Mark,
        forms: &[one(&COLOUR), one(&HEX)],
        flags: &[],
        allowed: Allowed::Part,
        default: "none",
        summary: "the colour mark that performs the part",
        long: "In a filmed performance small coloured marks are moved by hand. The part with `Mark` \
               is the one that the mark of this colour performs.",
        example: "Rhand@Rarm$Mark red",
        status: Status::Planned,
    },
    Row {
        keyword: Keyword::Follow,
        forms: &[Form {
            parameters: &NAMES,
            counts: &[],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "none",
        summary: "joints that are edited together with this one",
        long: "What a performance does to the part with `Mark` it does to the parts named here too: \
               the upper arm along with the hand, say. A name that is a keyword, or that has signs in \
               it, stands in quotes.",
        example: "Rhand@Rarm$Mark red Follow Rarm Ubody",
        status: Status::Planned,
    },
    Row {
        keyword: Keyword::Tiles,
        forms: &[one(&SIZE)],
        flags: &[],
        allowed: Allowed::Part,
        default: "none",
        summary: "makes the string's group a map of tiles",
        long: "The group or layer that holds the string is read as a map seen from above, as in \
               role-playing games, and becomes a landscape of blocks. `size` is the side of a tile \
               in drawing units.",
        example: "Island$Tiles 16",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Tile,
        forms: &[one(&TILE_WORD)],
        flags: &[],
        allowed: Allowed::Legend,
        default: "by the paint's colour",
        summary: "what tiles of this paint are",
        long: "Draw a small shape in the paint of your tiles and say beside it what they mean: \
               ground (`green`), cliff (`brown`), water (`blue`), roof (`red`), wall (`beige`) or \
               `none`.",
        example: "$Tile green Color #88bb44",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Bevel,
        forms: &[one(&RADIUS)],
        flags: &[],
        allowed: Allowed::Part,
        default: "0",
        summary: "bevels the corners of the ground",
        long: "The corners of a landscape's ground are cut by `r` tiles, so that it looks less like \
               boxes.",
        example: "Island$Tiles 16 Bevel 0.2",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::Roof,
        forms: &[one(&FACTOR)],
        flags: &[],
        allowed: Allowed::Part,
        default: "0.7071",
        summary: "how steep the roofs of a landscape are",
        long: "The height of the ridge over the depth of the roof. With 0.5 the model looks exactly \
               like the drawing when seen at 45°.",
        example: "Village$Tiles 16 Roof 0.5",
        status: Status::Built,
    },
    Row {
        keyword: Keyword::View,
        forms: &[Form {
            parameters: &ANGLES,
            counts: &[2],
        }],
        flags: &[],
        allowed: Allowed::Part,
        default: "none",
        summary: "makes the string's group one view of a character",
        long: "Draw a character twice, in two layers, from two sides, and give both the same name. \
               `theta` is how far the viewer has gone round towards the character's left, `phi` how \
               far up, both in degrees; the front is `0 0`.",
        example: "Boy$View 45 0",
        status: Status::Planned,
    },
    Row {
        keyword: Keyword::Backing,
        forms: NOTHING,
        flags: &[],
        allowed: Allowed::Part,
        default: "off",
        summary: "closes the gaps between a character's regions",
        long: "Between two views small gaps can open where a region slides away from its neighbour. \
               `Backing` puts a slightly larger copy behind each region.",
        example: "Boy$View 0 0 Backing",
        status: Status::Planned,
    },
    Row {
        keyword: Keyword::Hidden,
        forms: NOTHING,
        flags: &[],
        allowed: Allowed::Part,
        default: "off",
        summary: "a region that this view does not show",
        long: "A region that is not seen in this view can be drawn all the same, to say what shape \
               it has there while it is hidden.",
        example: "Ear$Hidden",
        status: Status::Planned,
    },
];
