//! Strings as they are written: the syntax tree.
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
    /// Several words without a sign: no string at all.
    Caption,
}

/// A part string.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Part {
    /// The part's name; may be left out in `<desc>` only.
    pub name: Option<Name>,
    /// What stands behind `@`.
    pub parent: Option<Name>,
    /// What stands behind `$`.
    pub attributes: Vec<Attribute>,
    /// Where the `@` and the `$` stand that were read as such.
    pub signs: Vec<Range<usize>>,
}

/// A name with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// The name, quotes taken off, full-width signs read as ASCII.
    pub text: String,
    /// Where it stands, quotes included.
    pub range: Range<usize>,
}

/// A keyword with its flags and arguments.
#[derive(Debug, Clone, PartialEq)]
pub struct Attribute {
    /// The keyword.
    pub keyword: Keyword,
    /// Where the keyword stands.
    pub keyword_range: Range<usize>,
    /// The letters behind `-`, each with its place.
    pub flags: Vec<(char, Range<usize>)>,
    /// The arguments.
    pub arguments: Vec<Argument>,
    /// From the keyword to the last argument.
    pub range: Range<usize>,
}

/// An argument with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Argument {
    /// What it is.
    pub kind: ArgumentKind,
    /// Where it stands.
    pub range: Range<usize>,
}

/// What an argument is.
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
    /// Something that could not be read; a diagnostic says why, so that nothing else need be said.
    Unreadable,
}

/// An arithmetic expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// A variable with its place.
    Variable(Name),
    /// `-a`
    Negate(Box<Expression>),
    /// `a op b`, `op` one of `+ - * /`
    Binary(char, Box<Expression>, Box<Expression>),
    /// `min(a, b)` and the like
    Call(Function, Vec<Expression>),
}

impl Expression {
    /// Gives all variables that stand in it to `found`, in their order.
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
