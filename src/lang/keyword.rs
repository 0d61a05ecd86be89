//! The language as one table.
//!
//! A keyword is one [`Row`]. The parser, the checker, hovers, completion, signature help, the
//! reference page and the grammars all read these rows, together with the [`kinds`] of `Shape`, the
//! [`vocabulary`] of other words, and the [`signature`]s.

mod drawing;
mod motion;
mod part;
mod terrain;
mod views;

pub(crate) use motion::SPEED as MOTION_SPEED;

pub(crate) mod colors;
pub(crate) mod kinds;
pub(crate) mod signature;
pub(crate) mod vocabulary;

use signature::{Form, NO_ARGUMENTS};

macro_rules! keywords {
    ($($name:ident = $row:path;)+) => {
        /// A keyword of the language, in the order of the reference.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Keyword { $(#[doc = concat!("`", stringify!($name), "`")] $name,)+ }

        impl Keyword {
            /// All keywords, in the order of the reference.
            pub const ALL: &'static [Keyword] = &[$(Keyword::$name,)+];

            /// The canonical spelling.
            pub fn name(self) -> &'static str {
                match self { $(Keyword::$name => stringify!($name),)+ }
            }

            /// The keyword's row of the table.
            pub fn row(self) -> &'static Row {
                match self { $(Keyword::$name => &$row,)+ }
            }
        }
    };
}

keywords! {
    Color = part::COLOR;
    Shape = part::SHAPE;
    Offset = part::OFFSET;
    Stack = part::STACK;
    Origin = part::ORIGIN;
    Axis = part::AXIS;
    Segments = part::SEGMENTS;
    Smooth = part::SMOOTH;
    Side = part::SIDE;
    Metallic = part::METALLIC;
    Roughness = part::ROUGHNESS;
    Emissive = part::EMISSIVE;
    Alpha = part::ALPHA;
    Texture = part::TEXTURE;
    Depth = views::DEPTH;
    Bone = motion::BONE;
    Carry = motion::CARRY;
    Bend = motion::BEND;
    Swing = motion::SWING;
    Facing = motion::FACING;
    Mark = motion::MARK;
    Follow = motion::FOLLOW;
    Tiles = terrain::TILES;
    Tile = terrain::TILE;
    Bevel = terrain::BEVEL;
    Roof = terrain::ROOF;
    Height = terrain::HEIGHT;
    Stand = terrain::STAND;
    View = views::VIEW;
    Backing = views::BACKING;
    Mirror = views::MIRROR;
    Match = views::MATCH;
    Hidden = views::HIDDEN;
    Scale = drawing::SCALE;
    Axes = drawing::AXES;
    Ground = drawing::GROUND;
    Let = drawing::LET;
    Bind = drawing::BIND;
    Strokes = drawing::STROKES;
    Motion = motion::MOTION;
    Limited = motion::LIMITED;
    Held = motion::HELD;
    Size = motion::SIZE;
    Walk = motion::WALK;
    Pose = motion::POSE;
    Perform = motion::PERFORM;
}

/// What the table says about a keyword.
#[derive(Debug)]
pub struct Row {
    /// The argument lists that the keyword accepts; one of them must fit.
    pub forms: &'static [Form],
    /// The letters that may follow `-`.
    pub flags: &'static [Flag],
    /// In which strings the keyword is allowed.
    pub allowed: Allowed,
    /// The value without the attribute.
    pub default: &'static str,
    /// One line.
    pub summary: &'static str,
    /// The manual, in Markdown.
    pub long: &'static str,
    /// A whole string that uses it.
    pub example: &'static str,
    /// Whether this version supports it.
    pub status: Status,
}

impl Row {
    /// What most rows share. It has no texts, which every row has its own of.
    const ROW: Self = Self {
        forms: NO_ARGUMENTS,
        flags: &[],
        allowed: Allowed::Part,
        default: "none",
        summary: "",
        long: "",
        example: "",
        status: Status::Built,
    };
    /// A keyword that has no effect yet.
    const PLANNED: Self = Self {
        status: Status::Planned,
        ..Self::ROW
    };
    /// A setting of the whole drawing.
    const DRAWING: Self = Self {
        allowed: Allowed::Drawing,
        ..Self::ROW
    };
}

/// A flag of a keyword.
#[derive(Debug)]
pub struct Flag {
    /// The letter after `-`.
    pub letter: char,
    /// One line.
    pub summary: &'static str,
}

const fn flag(letter: char, summary: &'static str) -> Flag {
    Flag { letter, summary }
}

/// Whether a row of the table has an effect in this version.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// It has an effect.
    Built,
    /// It is read and checked, but has no effect yet: no list shows it, and no proposal.
    Planned,
}

/// In which strings an attribute is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Allowed {
    /// In part strings and legends, and as a default in `%` strings.
    Part,
    /// In `%` strings only.
    Drawing,
    /// In legends only.
    Legend,
    /// In part strings and legends, and in `%` strings for the whole drawing.
    PartAndDrawing,
}

/// The kinds of string that have attributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttributeString {
    /// `Name@Parent$ …`
    Part,
    /// `$ …`
    Legend,
    /// `% …`
    Defaults,
}

impl Allowed {
    /// Whether an attribute is allowed in such a string.
    pub fn permits(self, string: AttributeString) -> bool {
        match self {
            Self::Part | Self::PartAndDrawing => true,
            Self::Drawing => string == AttributeString::Defaults,
            Self::Legend => string == AttributeString::Legend,
        }
    }

    /// The column *where* of the reference.
    pub fn name(self) -> &'static str {
        match self {
            Self::Part => "part",
            Self::Drawing => "drawing",
            Self::Legend => "legend",
            Self::PartAndDrawing => "part, drawing",
        }
    }

    /// Where the attribute is allowed, as the end of a sentence.
    pub fn places(self) -> &'static str {
        match self {
            Self::Part => {
                "in part strings (`Name$ …`), in legends (`$ …`), and as a default for all parts in `%` strings"
            }
            Self::Drawing => "in `%` strings only, because it applies to the whole drawing",
            Self::Legend => "in legends only (`$ …`, a text beside a sample of the paint)",
            Self::PartAndDrawing => {
                "in part strings (`Name$ …`), and in `%` strings for the whole drawing"
            }
        }
    }
}

impl Keyword {
    /// The keywords that have an effect.
    pub fn built() -> impl Iterator<Item = Self> {
        let all = Self::ALL.iter().copied();
        all.filter(|keyword| keyword.row().status == Status::Built)
    }

    /// The keyword called `name`, ignoring case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|keyword| keyword.name().eq_ignore_ascii_case(name))
    }

    /// Whether an attribute behind a `Motion` belongs to that clip, so that each motion can have its own.
    pub fn belongs_to_motion(self) -> bool {
        matches!(self, Self::Limited | Self::Held | Self::Perform)
    }

    /// The keyword with an effect that `word` is probably a misspelling of, and their edit distance.
    pub fn nearest(word: &str) -> Option<(Self, usize)> {
        let lower = word.to_ascii_lowercase();
        let letters = lower.chars().take(32).count();
        if letters >= 32 {
            return None;
        }
        Self::built()
            .filter_map(|keyword| {
                let name = keyword.name().to_ascii_lowercase();
                // A third of the letters, as in `nearest_word`, but of the shorter word: a short word
                // must not match a much longer one.
                let allowed = (letters.min(name.len()) / 3).max(1);
                if letters < 3 || letters.abs_diff(name.len()) > allowed {
                    return None;
                }
                let distance = strsim::damerau_levenshtein(&lower, &name);
                (distance <= allowed).then_some((keyword, distance))
            })
            .min_by_key(|(_, distance)| *distance)
    }

    /// The printed form of each argument list: `Origin center|start|end`, `Origin x y`.
    pub fn usages(self) -> Vec<String> {
        let row = self.row();
        let flags: String = row.flags.iter().map(|flag| flag.letter).collect();
        row.forms
            .iter()
            .map(|form| {
                let mut words = vec![self.name().to_owned()];
                if !flags.is_empty() {
                    words.push(format!("[-{flags}]"));
                }
                let arguments = form.print();
                if !arguments.is_empty() {
                    words.push(arguments);
                }
                words.join(" ")
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_keyword_has_its_own_row() {
        for keyword in Keyword::ALL {
            let same = |other: &&Keyword| std::ptr::eq(keyword.row(), other.row());
            assert_eq!(Keyword::ALL.iter().filter(same).count(), 1);
            assert!(keyword.row().example.contains(keyword.name()));
            assert!(!keyword.row().summary.is_empty() && !keyword.row().long.is_empty());
        }
    }

    #[test]
    fn no_other_word_of_the_language_is_a_keyword() {
        // The parser reads `walk` directly after `Motion` as the clip.
        for word in vocabulary::all().filter(|word| *word != "walk") {
            assert_eq!(Keyword::from_name(word), None, "{word}");
        }
    }

    #[test]
    fn usages_show_optional_arguments() {
        assert_eq!(Keyword::Shape.usages(), ["Shape [-scd] kind parameters…"]);
        assert_eq!(
            Keyword::Color.usages(),
            ["Color r g b [a]", "Color #rrggbb[aa]", "Color colour"]
        );
        assert_eq!(
            Keyword::Origin.usages(),
            ["Origin center|start|end", "Origin x y"]
        );
        assert_eq!(
            Keyword::Motion.usages()[..2],
            [
                "Motion [-il] \"file\" [up] [seconds] [from start] [to end] [speed factor] …",
                "Motion [-il] \"file\" name [up] [seconds] [from start] [to end] [speed factor] …"
            ]
        );
        assert_eq!(Keyword::Follow.usages(), ["Follow name…"]);
        assert_eq!(
            Keyword::Perform.usages(),
            [
                "Perform [-tecr] \"file\" [input-key motion-key]",
                "Perform [-tecr] \"file\" mark [input-key motion-key]"
            ]
        );
        assert_eq!(Keyword::Hidden.usages(), ["Hidden"]);
    }

    #[test]
    fn misspelled_keywords_are_recognized() {
        assert_eq!(Keyword::nearest("Colr"), Some((Keyword::Color, 1)));
        assert_eq!(Keyword::nearest("shpae"), Some((Keyword::Shape, 1)));
        assert_eq!(Keyword::nearest("w"), None);
        assert_eq!(Keyword::nearest(&"x".repeat(1 << 20)), None);
    }
}
