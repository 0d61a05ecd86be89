//! The syntax tree of a string.
//!
//! Ranges are byte ranges of the decoded string ([`crate::source::Text::as_str`]).

use std::ops::Range;

use super::keyword::Keyword;

/// A parsed string.
#[derive(Debug, Clone, PartialEq)]
pub enum Annotation {
    /// Nothing but white space.
    Empty,
    /// `# …`
    Comment,
    /// `% …`
    Defaults(Vec<Attribute>),
    /// `* …`
    Unused,
    /// `$ …`
    Legend(Vec<Attribute>),
    /// `^ name`
    Feature(Name),
    /// `name@parent$ …`
    Part(Part),
    /// Several words without a sign: plain text, not a string.
    Caption,
}

impl Annotation {
    /// The attributes, in the order of the string.
    pub fn attributes(&self) -> &[Attribute] {
        match self {
            Self::Defaults(attributes) | Self::Legend(attributes) => attributes,
            Self::Part(part) => &part.attributes,
            Self::Empty | Self::Comment | Self::Unused | Self::Feature(_) | Self::Caption => &[],
        }
    }

    /// The attribute with this range.
    pub fn attribute_at(&self, range: &Range<usize>) -> Option<&Attribute> {
        let mut attributes = self.attributes().iter();
        attributes.find(|attribute| attribute.range == *range)
    }
}

/// A part string.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Part {
    /// The part's name; may be left out in `<desc>` only.
    pub name: Option<Name>,
    /// The name after `@`.
    pub parent: Option<Name>,
    /// The attributes after `$`.
    pub attributes: Vec<Attribute>,
    /// The ranges of the `@` and the `$`.
    pub signs: Vec<Range<usize>>,
}

/// A name with its range.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// The name without quotes, full-width characters read as ASCII.
    pub text: String,
    /// Its range, quotes included.
    pub range: Range<usize>,
}

/// A keyword with its flags and arguments.
#[derive(Debug, Clone, PartialEq)]
pub struct Attribute {
    /// The keyword.
    pub keyword: Keyword,
    /// The range of the keyword.
    pub keyword_range: Range<usize>,
    /// The letters after `-`, each with its range.
    pub flags: Vec<(char, Range<usize>)>,
    /// The arguments.
    pub arguments: Vec<Argument>,
    /// From the keyword to the last argument.
    pub range: Range<usize>,
}

/// An argument with its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Argument {
    /// The argument itself.
    pub kind: ArgumentKind,
    /// Its range.
    pub range: Range<usize>,
}

/// The kinds of argument.
#[derive(Debug, Clone, PartialEq)]
pub enum ArgumentKind {
    /// `12`, `-.5`
    Number(f64),
    /// `(a + 1)`
    Expression(Expression),
    /// `center`
    Word(String),
    /// `"kick.bvh"`
    Quoted(String),
    /// `#rrggbb`, without the sign
    Hex(String),
    /// An argument that could not be read. It has a diagnostic already, and must not get another one.
    Unreadable,
}

/// An arithmetic expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// A variable with its range.
    Variable(Name),
    /// `-a`
    Negate(Box<Expression>),
    /// `a op b`, `op` one of `+ - * /`
    Binary(char, Box<Expression>, Box<Expression>),
    /// `min(a, b)` and other functions
    Call(Function, Vec<Expression>),
}

impl Expression {
    /// Calls `found` for each variable, from left to right.
    pub fn variables<'a>(&'a self, found: &mut dyn FnMut(&'a Name)) {
        match self {
            Self::Number(_) => {}
            Self::Variable(name) => found(name),
            Self::Negate(inner) => inner.variables(found),
            Self::Binary(_, left, right) => {
                left.variables(found);
                right.variables(found);
            }
            Self::Call(_, arguments) => {
                for argument in arguments {
                    argument.variables(found);
                }
            }
        }
    }
}

/// The functions of expressions; angles are in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// The smallest argument.
    Min,
    /// The largest argument.
    Max,
    /// The absolute value.
    Abs,
    /// The square root.
    Sqrt,
    /// The sine.
    Sin,
    /// The cosine.
    Cos,
}
