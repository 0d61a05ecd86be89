//! The values of checked attributes.

use std::ops::Range;

use super::keyword::Keyword;

/// An attribute whose arguments were checked and computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// The attribute's keyword.
    pub keyword: Keyword,
    /// The attribute's value.
    pub value: Value,
    /// Its flags and arguments as text, with variables replaced by their values: `-cd default -5 5`.
    pub text: String,
    /// Its range in the decoded string, keyword included.
    pub range: Range<usize>,
    /// The `Limited` that belongs to a `Motion`: the one between it and the next.
    pub limited: Option<Box<Setting>>,
    /// The `Held` that belongs to a `Motion`, likewise.
    pub held: Option<Box<Setting>>,
    /// The `Perform` that belongs to a `Motion`, likewise.
    pub performance: Option<Box<Setting>>,
}

/// The value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `Color`, straight sRGB and alpha, each 0 to 1. `alpha` is `None` where the string does not give it.
    Color {
        /// Red, green, blue.
        rgb: [f64; 3],
        /// Opacity, if given.
        alpha: Option<f64>,
    },
    /// `Shape`
    Shape(Shape),
    /// `Origin`
    Origin(Origin),
    /// One number, such as `Offset`.
    Number(f64),
    /// Two numbers, such as `Limited`.
    Pair([f64; 2]),
    /// Three numbers, such as `Emissive`.
    Triple([f64; 3]),
    /// One word, file or text, such as `Texture`.
    Word(String),
    /// One or more names, such as `Bone`.
    Names(Vec<String>),
    /// `Axes`: the signed world axes that the drawing's right, its up and the viewer's direction become.
    Axes([SignedAxis; 3]),
    /// `Ground`
    Ground(Ground),
    /// `Motion`
    Motion(Motion),
    /// `Held`
    Held(Vec<HeldDrawing>),
    /// `Mark`
    Mark(Mark),
    /// `Perform`
    Performance(Performance),
    /// `Pose`
    Pose(Pose),
    /// `Let`: name and value.
    Let(String, f64),
    /// No arguments, such as `Hidden`.
    Flag,
}

/// `Shape [-scd] kind parameters…`
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The name of the kind, as in its row of the table.
    pub kind: &'static str,
    /// Its arguments, defaults filled in as far as the table has them.
    pub arguments: KindArguments,
    /// Whether depths are among the arguments that were given.
    pub has_depths: bool,
    /// `-s`: a second, mirrored solid in the same node.
    pub mirrored: bool,
    /// `-d`: a second, mirrored node.
    pub doubled: bool,
    /// `-c`: the origin is the centre.
    pub centered: bool,
}

/// The arguments of a kind of `Shape`.
#[derive(Debug, Clone, PartialEq)]
pub enum KindArguments {
    /// Angles in degrees, lengths in drawing units.
    Numbers(Vec<f64>),
    /// A file, as written.
    File(String),
}

impl Shape {
    /// The numbers of its kind.
    pub fn numbers(&self) -> &[f64] {
        match &self.arguments {
            KindArguments::Numbers(numbers) => numbers,
            KindArguments::File(_) => &[],
        }
    }

    /// The file of its kind, if that takes one.
    pub fn file(&self) -> Option<&str> {
        match &self.arguments {
            KindArguments::File(file) => Some(file),
            KindArguments::Numbers(_) => None,
        }
    }
}

/// A drawing of `Held`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HeldDrawing {
    /// Its frame of the motion, counted from 1.
    pub frame: usize,
    /// For how many frames it stands.
    pub frames: usize,
}

/// `Motion [-il] "file" …`, `Motion [-il] walk …`, `Motion [-il]`
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The motions that play in turn; at least one.
    pub turns: Vec<MotionTurn>,
    /// The clip's name, if given.
    pub clip: Option<String>,
    /// `-i`: without travel over the ground.
    pub is_in_place: bool,
    /// `-l`: a loop.
    pub is_loop: bool,
}

/// One of the motions that play in turn.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionTurn {
    /// The motion.
    pub source: MotionSource,
    /// The number of the argument that names it; `None` if none does.
    pub argument: Option<usize>,
    /// The axis that points up in the file, if given.
    pub up: Option<SignedAxis>,
    /// For how many seconds it plays, if given: more than 0.
    pub seconds: Option<f64>,
    /// Where in the file it begins, if given: seconds of the file, 0 or more.
    pub from: Option<f64>,
    /// Where in the file it ends, if given: after `from`.
    pub to: Option<f64>,
    /// How fast it plays, 0.01 to 100; 1 is as it is.
    pub speed: f64,
}

/// Where a motion comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MotionSource {
    /// A BVH file, as written.
    File(String),
    /// A clip that comes along, by its word in the table.
    BuiltIn(String),
    /// The clip that comes along and fits the figure.
    Fitting,
}

/// `Pose [-l] seconds [clip]`
#[derive(Debug, Clone, PartialEq)]
pub struct Pose {
    /// When the pose is reached, seconds from the beginning of the clip.
    pub seconds: f64,
    /// The clip's name, if given.
    pub clip: Option<String>,
    /// `-l`: a loop.
    pub is_loop: bool,
}

/// `Mark color`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mark {
    /// The colour as it is written, in lower case: `red`, `#ff8000`.
    pub word: String,
    /// Red, green, blue, sRGB.
    pub color: [u8; 3],
}

/// `Perform [-tecr] "file" [mark] [input-key motion-key]`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Performance {
    /// The file of the track, as written.
    pub file: String,
    /// What it does to a clip.
    pub effects: PerformanceEffects,
    /// The name of the mark that is emphasised, if given.
    pub emphasized: Option<String>,
    /// The key frames of the track and of the motion, if given, counted from 1 at 24 frames a second.
    pub keys: Option<[usize; 2]>,
}

/// What a performance does to a clip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PerformanceEffects {
    /// It gives the clip its timing; not with `-t`.
    pub timing: bool,
    /// It damps the joints that are not emphasised; not with `-e`.
    pub emphasis: bool,
    /// What keeps the emphasised joint in the middle of the picture.
    pub camerawork: Camerawork,
}

/// What keeps the emphasised joint of a performance in the middle of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Camerawork {
    /// A camera.
    Camera,
    /// The figure moves instead, as in the paper: `-r`.
    Root,
    /// Nothing: `-c`.
    None,
}

/// `Origin center | start | end | x y`
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Origin {
    /// The part's centre.
    Center,
    /// The end point nearer to the parent's centre.
    Start,
    /// The other end point.
    End,
    /// A point in drawing units.
    Point([f64; 2]),
}

/// `Ground bottom | page | x y`
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ground {
    /// The middle of the figures' lower edge.
    Bottom,
    /// The page's top left corner.
    Page,
    /// A point in drawing units.
    Point([f64; 2]),
}

/// A world axis with a sign, such as `+x`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SignedAxis {
    /// 0 is x, 1 is y, 2 is z.
    pub axis: usize,
    /// Whether it points in the negative direction.
    pub negative: bool,
}
