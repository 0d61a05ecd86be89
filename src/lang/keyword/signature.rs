//! The signatures of attributes: which arguments they take, as data.

use std::fmt::Write as _;

use super::vocabulary::Word;

/// One of the argument lists that a keyword accepts, or the parameter list of a kind of `Shape`.
#[derive(Debug)]
pub struct Form {
    /// The parameters, in order.
    pub parameters: &'static [Parameter],
    /// How many of them may be given, in ascending order.
    pub counts: &'static [usize],
    /// What may follow in any order: numbers, and words with the number behind them, such as `speed factor`.
    pub options: &'static [Parameter],
    /// Whether another list may follow: clips that play in turn.
    pub repeats: bool,
}

/// One parameter.
#[derive(Debug)]
pub struct Parameter {
    /// The name in the reference.
    pub name: &'static str,
    /// A few words.
    pub summary: &'static str,
    /// The type of argument.
    pub takes: Takes,
}

/// The type of argument that a parameter takes.
#[derive(Debug)]
pub enum Takes {
    /// A number, an expression or a variable.
    Number(Bounds),
    /// One of a few words.
    Choice(&'static [Word]),
    /// `#rgb`, `#rrggbb`, `#rrggbbaa`
    Hex,
    /// A CSS colour name.
    ColorName,
    /// A kind of `Shape`; the kind's own parameters follow.
    Kind,
    /// `+x` and the like.
    SignedAxis,
    /// A file name, best in quotes.
    File,
    /// Some text, in quotes if it is more than one word.
    Text,
    /// The name of a new variable.
    Variable,
    /// One or more names: takes all remaining arguments.
    Names,
}

/// The numbers that a parameter takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The smallest number.
    pub min: f64,
    /// The largest number.
    pub max: f64,
    /// What else holds for the numbers.
    pub restriction: Restriction,
    /// Which of them people use: a slider is about these.
    pub usual: Usual,
}

/// The numbers that people use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Usual {
    /// Those from one to another.
    Between(f64, f64),
    /// Lengths, drawing units: as far as the part is large, to both sides if there are numbers below 0.
    Length,
    /// From the left to the right of the page, drawing units.
    Across,
    /// From the top to the bottom of the page, drawing units.
    Down,
}

/// Which numbers between two bounds are allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Restriction {
    /// All of them.
    None,
    /// All but the lower bound itself.
    MinExclusive,
    /// Whole numbers.
    Integer,
}

impl Bounds {
    /// Any number.
    pub const ANY: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY, Restriction::None);
    /// 0 to 1.
    pub const FRACTION: Self = Self::new(0., 1., Restriction::None);
    /// 0 or more.
    pub const NOT_NEGATIVE: Self = Self::new(0., f64::INFINITY, Restriction::None);
    /// More than 0.
    pub const POSITIVE: Self = Self::new(0., f64::INFINITY, Restriction::MinExclusive);
    /// 0, 1, 2 …
    pub const COUNT: Self = Self::new(0., 1e6, Restriction::Integer);
    /// An angle of a rounding, in degrees.
    pub const QUARTER: Self = Self::new(-90., 90., Restriction::None);

    /// Numbers from `min` to `max`.
    pub const fn new(min: f64, max: f64, restriction: Restriction) -> Self {
        Self {
            min,
            max,
            restriction,
            usual: if min.is_finite() && max.is_finite() {
                Usual::Between(min, max)
            } else {
                Usual::Length
            },
        }
    }

    /// The same, of which people use these.
    pub const fn usually(self, usual: Usual) -> Self {
        Self { usual, ..self }
    }

    /// Whether `number` is allowed.
    pub fn contains(self, number: f64) -> bool {
        let in_range = (self.min..=self.max).contains(&number);
        in_range
            && match self.restriction {
                Restriction::None => true,
                Restriction::MinExclusive => number > self.min,
                Restriction::Integer => number.fract() == 0.,
            }
    }

    /// The bounds in words: `a number from 0 to 1`.
    pub fn describe(self) -> String {
        let noun = match self.restriction {
            Restriction::Integer => "a whole number",
            Restriction::None | Restriction::MinExclusive => "a number",
        };
        match (self.min.is_finite(), self.max.is_finite()) {
            _ if self.restriction == Restriction::MinExclusive && self.max.is_finite() => {
                format!("{noun} above {}, up to {}", self.min, self.max)
            }
            _ if self.restriction == Restriction::MinExclusive => {
                format!("{noun} above {}", self.min)
            }
            (true, true) => format!("{noun} from {} to {}", self.min, self.max),
            (true, false) => format!("{noun} of at least {}", self.min),
            (false, true) => format!("{noun} of at most {}", self.max),
            (false, false) => noun.to_owned(),
        }
    }
}

impl Takes {
    /// The type in words, for messages that say what was expected.
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
            Self::ColorName => "a CSS colour name, `orange` for example".to_owned(),
            Self::Kind => "a kind of shape, `roundv` for example".to_owned(),
            Self::SignedAxis => "one of `+x`, `-x`, `+y`, `-y`, `+z`, `-z`".to_owned(),
            Self::File => "a file name in quotes".to_owned(),
            Self::Text => "a word, or text in quotes".to_owned(),
            Self::Variable => "the name of a variable".to_owned(),
            Self::Names => "one or more names".to_owned(),
        }
    }
}

impl Form {
    /// A form with these parameters, of which as many may be given as `counts` says.
    pub(super) const fn new(parameters: &'static [Parameter], counts: &'static [usize]) -> Self {
        Self {
            parameters,
            counts,
            options: &[],
            repeats: false,
        }
    }

    /// The form with what may follow its parameters, and with more lists like it.
    pub(super) const fn repeated(self, options: &'static [Parameter]) -> Self {
        Self {
            options,
            repeats: true,
            ..self
        }
    }

    /// The form as a list: its parameters again and again.
    pub(super) const fn listed(self) -> Self {
        Self {
            repeats: true,
            ..self
        }
    }

    /// Whether it is a list of its parameters.
    pub fn is_list(&self) -> bool {
        self.repeats && self.options.is_empty()
    }

    /// The index of the parameter that argument `index` is for. The last of several names stands for all further arguments. `None`
    /// after the last parameter.
    pub fn parameter_index(&self, index: usize) -> Option<usize> {
        let last = self.parameters.len().checked_sub(1)?;
        (index < self.max_arguments()).then(|| match self.is_list() {
            true => index % self.parameters.len(),
            false => index.min(last),
        })
    }

    /// Its parameters and those of its options, in the order in which they are printed.
    pub fn all(&self) -> impl Iterator<Item = &'static Parameter> + Clone {
        self.parameters.iter().chain(self.options)
    }

    /// One argument, which must be given.
    pub(super) const fn one(parameter: &'static Parameter) -> Self {
        Self::new(std::slice::from_ref(parameter), &[1])
    }

    /// The largest number of arguments.
    pub fn max_arguments(&self) -> usize {
        match self.parameters.last() {
            Some(Parameter {
                takes: Takes::Names,
                ..
            }) => usize::MAX,
            Some(_) if self.is_list() => usize::MAX,
            _ => self.counts.last().copied().unwrap_or(0),
        }
    }

    /// Whether `count` arguments may be given.
    pub fn accepts(&self, count: usize) -> bool {
        if self.is_list() {
            return count > 0 && count.is_multiple_of(self.parameters.len());
        }
        self.counts.contains(&count) || (self.max_arguments() == usize::MAX && count > 0)
    }

    /// The printed form: `r g b [a]`.
    pub fn print(&self) -> String {
        let once = self.print_with(Parameter::print, ["[", "]"]);
        if self.repeats {
            format!("{once} …")
        } else {
            once
        }
    }

    /// The same with other words for its parameters, and other brackets around those that can be left out.
    pub(crate) fn print_with(
        &self,
        print: fn(&Parameter) -> String,
        [opening, closing]: [&str; 2],
    ) -> String {
        let mut out = String::new();
        let mut open = 0;
        for (index, parameter) in self.parameters.iter().enumerate() {
            if index > 0 {
                out.push(' ');
            }
            if self.counts.contains(&index) {
                out.push_str(opening);
                open += 1;
            }
            out.push_str(&print(parameter));
        }
        out += &closing.repeat(open);
        let mut after_word = false;
        for option in self.options {
            let space = if out.is_empty() { "" } else { " " };
            let printed = print(option);
            let is_word = matches!(option.takes, Takes::Choice(_));
            let (start, end) = match (after_word, is_word) {
                (true, _) => ("", closing),
                (false, true) => (opening, ""),
                (false, false) => (opening, closing),
            };
            let _ = write!(out, "{space}{start}{printed}{end}");
            after_word = is_word;
        }
        out
    }
}

impl Parameter {
    /// The printed form: the name, or the words to choose from.
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

/// The forms of a keyword without arguments.
pub(super) const NO_ARGUMENTS: &[Form] = &[Form::new(&[], &[0])];

/// A point of the drawing.
pub(super) static POINT: [Parameter; 2] = [
    number(
        "x",
        Bounds::ANY.usually(Usual::Across),
        "to the right, in drawing units",
    ),
    number(
        "y",
        Bounds::ANY.usually(Usual::Down),
        "down the page, in drawing units",
    ),
];
/// A depth.
pub(super) static DISTANCE: [Parameter; 1] = [number(
    "d",
    Bounds::ANY,
    "towards the viewer, in drawing units",
)];

pub(super) const fn number(name: &'static str, bounds: Bounds, summary: &'static str) -> Parameter {
    parameter(name, Takes::Number(bounds), summary)
}

pub(super) const fn choice(
    name: &'static str,
    words: &'static [Word],
    summary: &'static str,
) -> Parameter {
    parameter(name, Takes::Choice(words), summary)
}

pub(super) const fn parameter(
    name: &'static str,
    takes: Takes,
    summary: &'static str,
) -> Parameter {
    Parameter {
        name,
        summary,
        takes,
    }
}
