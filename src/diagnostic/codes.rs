//! The table of diagnostics: code, severity, title and manual page of each.

use super::Severity;

macro_rules! codes {
    ($($(#[doc = $doc:literal])+ $name:ident = $id:literal, $title:literal;)+) => {
        /// A diagnostic's stable code. The letter gives the severity: E error, W warning, H hint.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Code {
            $($(#[doc = $doc])+ $name,)+
        }

        impl Code {
            /// All codes, in the order of the manual.
            pub const ALL: &'static [Code] = &[$(Code::$name,)+];

            /// The code as it is printed, `E101` for example.
            pub fn id(self) -> &'static str {
                match self { $(Code::$name => $id,)+ }
            }

            /// A title of a few words.
            pub fn title(self) -> &'static str {
                match self { $(Code::$name => $title,)+ }
            }

            /// The manual page, in Markdown: what it means, an example, what to do.
            pub fn manual(self) -> &'static str {
                match self { $(Code::$name => concat!($($doc, "\n",)+),)+ }
            }
        }
    };
}

codes! {
    // The file
    /// The file is not well-formed XML.
    NotXml = "E001", "not well-formed XML";
    /// The file is XML, but its root element is not `svg`.
    NotSvg = "E002", "not an SVG drawing";
    /// The file holds nothing.
    EmptyFile = "E003", "empty file";
    /// The file is not UTF-8 text.
    NotUtf8 = "E004", "not UTF-8";
    /// The drawing asks for more than okoshi is ready to do.
    LimitPassed = "E005", "limit passed";
    /// A linked file is not there.
    MissingFile = "E006", "missing linked file";
    /// A link leads out of the drawing's folder.
    LinkOutside = "E007", "link outside the drawing's folder";

    // The strings
    /// A word stands where a keyword is due, and is none.
    UnknownKeyword = "E101", "unknown keyword";
    /// A word that an attribute does not know, a kind of `Shape` for example.
    UnknownWord = "E102", "unknown word";
    /// Too few or too many arguments.
    ArgumentCount = "E103", "wrong number of arguments";
    /// An argument of the wrong type.
    ArgumentType = "E104", "wrong type of argument";
    /// A value out of its range.
    OutOfRange = "E105", "value out of range";
    /// A quote that is never closed.
    UnclosedQuote = "E106", "unclosed quote";
    /// A parenthesis that is never closed.
    UnclosedParenthesis = "E107", "unclosed parenthesis";
    /// A variable that no `Let` defines.
    UnknownVariable = "E108", "unknown variable";
    /// Variables that need each other.
    VariableCycle = "E109", "cycle of variables";
    /// An attribute in a kind of string that cannot have it.
    NotAllowedHere = "E110", "attribute not allowed here";
    /// A part string that does not name its part.
    NoName = "E111", "part string without a name";
    /// A sign where none can stand, often two strings that were typed into one text.
    UnexpectedSign = "E112", "unexpected sign";
    /// A flag that the attribute does not have.
    UnknownFlag = "E113", "unknown flag";
    /// An expression in parentheses that cannot be read.
    BadExpression = "E114", "malformed expression";
    /// A name with spaces or signs in it that does not stand in quotes.
    UnquotedName = "E115", "name needs quotes";
    /// Attributes without a `$` before them.
    MissingSign = "E116", "missing sign";

    // Strings and parts
    /// A string, and no part left for it.
    NoPartLeft = "E201", "string with no part left";
    /// Two strings that describe one part.
    TwoStrings = "E202", "two strings on one part";
    /// Two parts of one name.
    DuplicateName = "E203", "duplicate name";
    /// A parent that is no part.
    UnknownParent = "E204", "unknown parent";
    /// Parts that are each other's ancestors.
    ParentCycle = "E205", "cycle of parents";

    // Warnings
    /// An attribute that stands twice in one string.
    GivenTwice = "W301", "attribute given twice";
    /// A setting that a later `%` string sets again.
    Overridden = "W302", "setting overridden";
    /// A legend whose paint no part has.
    UnusedLegend = "W303", "legend paint that no part has";
    /// Two legends of the same paint.
    TwoLegends = "W304", "two legends for one paint";
    /// A solid without thickness.
    ZeroThickness = "W305", "zero thickness";
    /// Copies of `-s` or `-d` that lie in one place.
    CopiesCoincide = "W306", "copies coincide";
    /// A part of which nothing is left.
    Vanishes = "W307", "part vanishes";
    /// A text in an annotated drawing that says nothing to okoshi.
    Caption = "W308", "caption";
    /// An SVG feature without a meaning for solids.
    NoSolidMeaning = "W309", "SVG feature without solid meaning";
    /// An attribute that is understood, but that this version does not act upon.
    NotBuiltYet = "W310", "not built yet";

    // Hints
    /// A string that could as well belong to another part.
    NearlyAsNear = "H401", "second part almost as near";
    /// A part without a string got a name by itself.
    AutomaticName = "H402", "automatic name";
    /// A part whose outline has no long direction.
    AxisGuess = "H403", "axis is a guess";
    /// A long part turns about its middle.
    TurnsAboutMiddle = "H404", "turns about its middle";
    /// Full-width signs, read as ASCII.
    FullWidth = "H405", "full-width signs";
    /// A shape off the page.
    OffPage = "H406", "off the page";
}

impl Code {
    /// The severity, which is the code's letter.
    pub fn severity(self) -> Severity {
        match self.id().as_bytes()[0] {
            b'E' => Severity::Error,
            b'W' => Severity::Warning,
            _ => Severity::Hint,
        }
    }

    /// The code that is printed as `id`, whatever its case.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|code| code.id().eq_ignore_ascii_case(id))
    }
}
