//! What arguments an attribute takes, as data.

use super::words::Word;

/// One way to give the arguments of a keyword, or the parameters of a kind of `Shape`.
#[derive(Debug)]
pub struct Form {
    /// The parameters, in order.
    pub parameters: &'static [Parameter],
    /// How many of them may be given; ascending.
    pub counts: &'static [usize],
}

/// One parameter.
#[derive(Debug)]
pub struct Parameter {
    /// Its name in the reference.
    pub name: &'static str,
    /// What it means, in a few words.
    pub summary: &'static str,
    /// What it takes.
    pub takes: Takes,
}

/// What a parameter takes.
#[derive(Debug)]
pub enum Takes {
    /// A number, an expression or a variable.
    Number(Bounds),
    /// One of a few words.
    Choice(&'static [Word]),
    /// `#rgb`, `#rrggbb`, `#rrggbbaa`
    Hex,
    /// A colour's name as in CSS.
    ColourName,
    /// A kind of `Shape`; the kind's own parameters follow.
    Kind,
    /// `+x` and the like.
    SignedAxis,
    /// A file's name, best in quotes.
    File,
    /// Some text, in quotes if it is more than one word.
    Text,
    /// The name of a new variable.
    Variable,
    /// One or more names; takes all arguments that are left.
    Names,
}

/// The numbers that a parameter takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least.
    pub min: f64,
    /// The largest.
    pub max: f64,
    /// What else they must be.
    pub grain: Grain,
}

/// What numbers between two bounds count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grain {
    /// All of them.
    Any,
    /// All but the lower bound itself.
    Above,
    /// Whole numbers.
    Whole,
}

impl Bounds {
    /// Any number.
    pub const ANY: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY, Grain::Any);
    /// A share: 0 to 1.
    pub const SHARE: Self = Self::new(0., 1., Grain::Any);
    /// 0 or more.
    pub const NOT_NEGATIVE: Self = Self::new(0., f64::INFINITY, Grain::Any);
    /// More than 0.
    pub const POSITIVE: Self = Self::new(0., f64::INFINITY, Grain::Above);
    /// 0, 1, 2 …
    pub const COUNT: Self = Self::new(0., 1e6, Grain::Whole);
    /// An angle of a rounding.
    pub const QUARTER: Self = Self::new(-90., 90., Grain::Any);

    /// Numbers from `min` to `max`.
    pub const fn new(min: f64, max: f64, grain: Grain) -> Self {
        Self { min, max, grain }
    }

    /// Whether `number` is one of them.
    pub fn holds(self, number: f64) -> bool {
        let in_range = (self.min..=self.max).contains(&number);
        in_range
            && match self.grain {
                Grain::Any => true,
                Grain::Above => number > self.min,
                Grain::Whole => number.fract() == 0.,
            }
    }

    /// The bounds in words: `a number from 0 to 1`.
    pub fn describe(self) -> String {
        let noun = match self.grain {
            Grain::Whole => "a whole number",
            Grain::Any | Grain::Above => "a number",
        };
        match (self.min.is_finite(), self.max.is_finite()) {
            _ if self.grain == Grain::Above && self.max.is_finite() => {
                format!("{noun} above {}, up to {}", self.min, self.max)
            }
            _ if self.grain == Grain::Above => format!("{noun} above {}", self.min),
            (true, true) => format!("{noun} from {} to {}", self.min, self.max),
            (true, false) => format!("{noun} of at least {}", self.min),
            (false, true) => format!("{noun} of at most {}", self.max),
            (false, false) => noun.to_owned(),
        }
    }
}

impl Takes {
    /// What is due, in words.
    pub fn describe(&self) -> String {
        match self {
            Self::Number(bounds) => bounds.describe(),
            Self::Choice(words) => {
                let names: Vec<_> = words
                    .iter()
                    .map(|word| format!("`{}`", word.name))
                    .collect();
                format!("one of {}", names.join(", "))
            }
            Self::Hex => "a colour as `#rrggbb`".to_owned(),
            Self::ColourName => "a colour's name as in CSS, `orange` for example".to_owned(),
            Self::Kind => "a kind of shape, `roundv` for example".to_owned(),
            Self::SignedAxis => "one of `+x`, `-x`, `+y`, `-y`, `+z`, `-z`".to_owned(),
            Self::File => "a file's name in quotes".to_owned(),
            Self::Text => "a word, or text in quotes".to_owned(),
            Self::Variable => "the name of a variable".to_owned(),
            Self::Names => "one or more names".to_owned(),
        }
    }
}

impl Form {
    /// The largest number of arguments.
    pub fn most(&self) -> usize {
        match self.parameters.last() {
            Some(Parameter {
                takes: Takes::Names,
                ..
            }) => usize::MAX,
            _ => self.counts.last().copied().unwrap_or(0),
        }
    }

    /// Whether so many arguments are right.
    pub fn fits(&self, count: usize) -> bool {
        self.counts.contains(&count) || (self.most() == usize::MAX && count > 0)
    }

    /// The printed form: `r g b [a]`.
    pub fn print(&self) -> String {
        let mut out = String::new();
        let mut open = 0;
        for (index, parameter) in self.parameters.iter().enumerate() {
            if index > 0 {
                out.push(' ');
            }
            if self.counts.contains(&index) {
                out.push('[');
                open += 1;
            }
            out.push_str(&parameter.print());
        }
        out.extend(std::iter::repeat_n(']', open));
        out
    }
}

impl Parameter {
    /// The printed form: the name, or what is written literally.
    pub fn print(&self) -> String {
        match &self.takes {
            Takes::Choice(words) => {
                let names: Vec<_> = words.iter().map(|word| word.name).collect();
                names.join("|")
            }
            Takes::Hex => "#rrggbb[aa]".to_owned(),
            Takes::Kind => "kind parameters…".to_owned(),
            Takes::File => format!("\"{}\"", self.name),
            Takes::Names => format!("{}…", self.name),
            _ => self.name.to_owned(),
        }
    }
}

/// A form with no arguments.
pub(super) const NOTHING: &[Form] = &[Form {
    parameters: &[],
    counts: &[0],
}];

/// A number of the name `name`.
pub(super) const fn number(name: &'static str, bounds: Bounds, summary: &'static str) -> Parameter {
    Parameter {
        name,
        summary,
        takes: Takes::Number(bounds),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_told_in_words() {
        for (bounds, words) in [
            (Bounds::ANY, "a number"),
            (Bounds::SHARE, "a number from 0 to 1"),
            (Bounds::POSITIVE, "a number above 0"),
            (Bounds::NOT_NEGATIVE, "a number of at least 0"),
            (
                Bounds::new(1., 256., Grain::Whole),
                "a whole number from 1 to 256",
            ),
        ] {
            assert_eq!(bounds.describe(), words);
        }
        assert!(!Bounds::POSITIVE.holds(0.) && Bounds::POSITIVE.holds(1e-9));
        assert!(!Bounds::COUNT.holds(1.5) && !Bounds::ANY.holds(f64::NAN));
    }
}
