//! The language as one table.
//!
//! A keyword is one [`Row`]. The parser, the checker, hovers, completion, signature help, the
//! reference page and the grammars are all made from these rows and from their neighbours:
//! the [`kinds`] of `Shape`, the [`words`] of the language, and the [`signature`]s that hold them together.

mod drawing;
mod figure;
mod scenes;

pub mod colours;
pub mod kinds;
pub mod signature;
pub mod words;

use signature::Form;

macro_rules! keywords {
    ($($name:ident)+) => {
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
        }
    };
}

keywords! {
    Color Shape Offset Origin Axis Segments Smooth Metallic Roughness Emissive Alpha
    Texture Depth Bone Mark Follow Tiles Tile Bevel Roof View Backing Hidden
    Scale Axes Ground Let Bind Strokes
    Motion Limited Stand Size Walk Pose Perform
}

/// What the table says about a keyword.
#[derive(Debug)]
pub struct Row {
    /// The keyword.
    pub keyword: Keyword,
    /// The ways to give its arguments; one of them must fit.
    pub forms: &'static [Form],
    /// The letters that may stand behind `-`.
    pub flags: &'static [Flag],
    /// In which strings it may stand.
    pub allowed: Allowed,
    /// What holds where the attribute is not given.
    pub default: &'static str,
    /// One line.
    pub summary: &'static str,
    /// The manual, in Markdown.
    pub long: &'static str,
    /// A whole string that uses it.
    pub example: &'static str,
    /// Whether this version acts upon it.
    pub status: Status,
}

/// A flag of a keyword.
#[derive(Debug)]
pub struct Flag {
    /// The letter behind `-`.
    pub letter: char,
    /// One line.
    pub summary: &'static str,
}

/// Whether a row of the table has an effect in this version.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// It is acted upon.
    Built,
    /// It is read and checked, and has no effect yet.
    Planned,
}

/// In which strings an attribute may stand.
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

/// The strings that have attributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Holder {
    /// `Name@Parent$ …`
    Part,
    /// `$ …`
    Legend,
    /// `% …`
    Defaults,
}

impl Allowed {
    /// Whether an attribute may stand in such a string.
    pub fn permits(self, holder: Holder) -> bool {
        match self {
            Self::Part | Self::PartAndDrawing => true,
            Self::Drawing => holder == Holder::Defaults,
            Self::Legend => holder == Holder::Legend,
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

    /// Where it may stand, in words.
    pub fn places(self) -> &'static str {
        match self {
            Self::Part => {
                "in part strings (`Name$ …`), in legends (`$ …`), and as a default for all parts in `%` strings"
            }
            Self::Drawing => "in `%` strings only, since it is about the whole drawing",
            Self::Legend => "in legends only (`$ …`, a text beside a sample of the paint)",
            Self::PartAndDrawing => {
                "in part strings (`Name$ …`), and in `%` strings for the whole drawing"
            }
        }
    }
}

impl Keyword {
    /// The keyword that is written `name`, whatever its case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|keyword| keyword.name().eq_ignore_ascii_case(name))
    }

    /// The keyword that `word` is a slip of the pen for, with the number of letters that differ.
    pub fn nearly(word: &str) -> Option<(Self, usize)> {
        let lower = word.to_ascii_lowercase();
        let letters = lower.chars().take(32).count();
        if letters >= 32 {
            return None;
        }
        Self::ALL
            .iter()
            .copied()
            .filter_map(|keyword| {
                let name = keyword.name().to_ascii_lowercase();
                // A third of the letters, as everywhere; of the shorter word, so that short words
                // are not found in longer ones.
                let allowed = (letters.min(name.len()) / 3).max(1);
                if letters < 3 || letters.abs_diff(name.len()) > allowed {
                    return None;
                }
                let distance = strsim::damerau_levenshtein(&lower, &name);
                (distance <= allowed).then_some((keyword, distance))
            })
            .min_by_key(|(_, distance)| *distance)
    }

    /// The row of the table.
    pub fn row(self) -> &'static Row {
        let index = self as usize;
        let [figure, scenes] = [figure::ROWS.len(), scenes::ROWS.len()];
        if index < figure {
            &figure::ROWS[index]
        } else if index < figure + scenes {
            &scenes::ROWS[index - figure]
        } else {
            &drawing::ROWS[index - figure - scenes]
        }
    }

    /// The printed form of its ways to give arguments: `Origin center|start|end`, `Origin x y`.
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
    fn rows_stand_in_the_order_of_the_keywords() {
        let rows = figure::ROWS.len() + scenes::ROWS.len() + drawing::ROWS.len();
        assert_eq!(rows, Keyword::ALL.len());
        for keyword in Keyword::ALL {
            assert_eq!(keyword.row().keyword, *keyword);
        }
    }

    #[test]
    fn no_word_of_the_language_is_a_keyword() {
        for word in words::all() {
            assert_eq!(Keyword::from_name(word), None, "{word}");
        }
    }

    #[test]
    fn usages_show_what_may_be_left_out() {
        assert_eq!(Keyword::Shape.usages(), ["Shape [-scd] kind parameters…"]);
        assert_eq!(
            Keyword::Color.usages(),
            ["Color r g b [a]", "Color #rrggbb[aa]", "Color colour"]
        );
        assert_eq!(
            Keyword::Origin.usages(),
            ["Origin center|start|end", "Origin x y"]
        );
        assert_eq!(Keyword::Motion.usages(), ["Motion \"file\" [clip]"]);
        assert_eq!(Keyword::Follow.usages(), ["Follow name…"]);
        assert_eq!(Keyword::Hidden.usages(), ["Hidden"]);
    }

    #[test]
    fn slips_of_the_pen_are_found() {
        assert_eq!(Keyword::nearly("Colr"), Some((Keyword::Color, 1)));
        assert_eq!(Keyword::nearly("shpae"), Some((Keyword::Shape, 1)));
        assert_eq!(Keyword::nearly("w"), None);
        assert_eq!(Keyword::nearly(&"x".repeat(1 << 20)), None);
    }
}
