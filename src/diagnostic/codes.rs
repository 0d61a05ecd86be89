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

            /// The manual page, in Markdown: what it means, a wrong example, the way out.
            pub fn manual(self) -> &'static str {
                match self { $(Code::$name => concat!($($doc, "\n",)+),)+ }
            }
        }
    };
}

codes! {
    // The file
    /// The drawing is not well-formed XML: a tag that is never closed, a quote missing in a tag, or a bare
    /// `&` or `<` in a text. Drawing programs write good XML, so this comes from editing by hand, or from a
    /// file that was cut off.
    ///
    /// ```text
    /// <text>Salt & Pepper</text>
    /// ```
    ///
    /// Mend the place that is shown. In texts write `&amp;` for `&` and `&lt;` for `<`; or open the drawing
    /// in the drawing program and save it again.
    NotXml = "E001", "not well-formed XML";
    /// The file is XML, but its outermost element is not `svg`, so it is no drawing.
    ///
    /// ```text
    /// <html>…</html>
    /// ```
    ///
    /// Save the drawing as SVG, and give that file to okoshi.
    NotSvg = "E002", "not an SVG drawing";
    /// The file holds nothing at all.
    ///
    /// Save the drawing again; look whether the disk is full.
    EmptyFile = "E003", "empty file";
    /// The file's bytes are not UTF-8, the encoding that drawings are written in.
    ///
    /// Open the drawing in the drawing program and save it again as plain SVG.
    NotUtf8 = "E004", "not UTF-8";
    /// The drawing asks for more than okoshi is ready to do: parentheses nested too deep, an image or a map
    /// too large, groups within groups within groups. The limits are there so that a slip cannot fill the
    /// memory.
    ///
    /// ```text
    /// Arm$Offset ((((…))))
    /// ```
    ///
    /// Make the thing smaller or simpler. Calculations become shorter when parts of them get names with
    /// `Let`.
    LimitPassed = "E005", "limit passed";
    /// The drawing names a file that is not there, or that is there but cannot be read as what it should be.
    /// Names of files are read from the drawing's own folder on, and upper and lower case matter.
    ///
    /// ```text
    /// Lbody$Motion "Kick.bvh"
    /// ```
    ///
    /// Put the file there, or write its name as it is. A picture that cannot be read is mended by saving it
    /// again as PNG.
    MissingFile = "E006", "missing linked file";
    /// The drawing names a file outside its own folder, by `..`, a full path or a web address. Such files
    /// are not read, so that a drawing from somebody else cannot look around in your computer.
    ///
    /// ```text
    /// Sail$Texture "../../photos/canvas.png"
    /// ```
    ///
    /// Copy the file into the drawing's folder, or below it.
    LinkOutside = "E007", "link outside the drawing's folder";

    // The strings
    /// A keyword is due here, and the word is none: a slip of the pen, or a word too many behind the
    /// attribute before it.
    ///
    /// ```text
    /// Rarm@Ubody$Colr 1 0 0
    /// ```
    ///
    /// Write the keyword that was meant: `Color`. `okoshi explain` lists all of them. What follows up to
    /// the next keyword is skipped; the rest of the string counts.
    UnknownKeyword = "E101", "unknown keyword";
    /// An attribute that takes one of a few words got another one: a kind of `Shape`, a colour's name, a
    /// function.
    ///
    /// ```text
    /// Rarm@Ubody$Shape roundw
    /// ```
    ///
    /// Write one of the words that it knows: `Shape roundv`.
    UnknownWord = "E102", "unknown word";
    /// An attribute got too few arguments, or too many.
    ///
    /// ```text
    /// Rarm@Ubody$Shape roundv 90
    /// ```
    ///
    /// Give as many as the help says: `Shape roundv` takes two angles or none. If a name is also a keyword,
    /// put it in quotes.
    ArgumentCount = "E103", "wrong number of arguments";
    /// An argument is of another sort than the one that is due: text for a number, a number with a unit or
    /// a comma, a file's name without quotes.
    ///
    /// ```text
    /// Rarm@Ubody$Offset 12px
    /// ```
    ///
    /// Write numbers bare, with a point for decimals (`0.5`); put files and text into quotes
    /// (`"kick.bvh"`); put calculations into parentheses (`(2 * 3)`).
    ArgumentType = "E104", "wrong type of argument";
    /// A number is outside what the attribute can use, or a calculation has no result, such as a division
    /// by zero.
    ///
    /// ```text
    /// Window@Car$Alpha 30
    /// ```
    ///
    /// Write a number in the range that is shown: opacity goes from 0 to 1, so 30 % is `Alpha 0.3`.
    OutOfRange = "E105", "value out of range";
    /// A text in quotes begins here and never ends.
    ///
    /// ```text
    /// Lbody$Motion "kick.bvh Color red
    /// ```
    ///
    /// Close it with `"`: `Motion "kick.bvh"`.
    UnclosedQuote = "E106", "unclosed quote";
    /// A parenthesis is opened and never closed, or closed without having been opened.
    ///
    /// ```text
    /// Rarm@Ubody$Offset (1 + 2
    /// ```
    ///
    /// Write the missing one: `Offset (1 + 2)`.
    UnclosedParenthesis = "E107", "unclosed parenthesis";
    /// A word stands where a number is due. It could be a variable, but no `%` string defines it.
    ///
    /// ```text
    /// Rarm@Ubody$Offset thick
    /// ```
    ///
    /// Write a number, or define the variable: `%Let thick 12`. Upper and lower case matter in names of
    /// variables.
    UnknownVariable = "E108", "unknown variable";
    /// Variables are defined by each other in a circle, so that none of them has a value.
    ///
    /// ```text
    /// %Let a (b + 1) Let b (a - 1)
    /// ```
    ///
    /// Give one of them a number.
    VariableCycle = "E109", "cycle of variables";
    /// The attribute means nothing in this kind of string. `Scale`, say, is about the whole drawing and
    /// stands in `%` strings only.
    ///
    /// ```text
    /// Rarm@Ubody$Scale 2
    /// ```
    ///
    /// Move it to a string where it can stand; the help says which.
    NotAllowedHere = "E110", "attribute not allowed here";
    /// A string gives a parent or attributes but no name, or there is no name behind `@`.
    ///
    /// ```text
    /// @Ubody$Shape roundv
    /// ```
    ///
    /// Write the name first: `Rarm@Ubody$Shape roundv`. (In the description of an object the name may be
    /// left out.)
    NoName = "E111", "part string without a name";
    /// A sign stands where none can stand. Most often two strings were typed into one text: the cursor was
    /// still in the first when the second was typed.
    ///
    /// ```text
    /// Rarm@Ubody$Shape round$Shape default 0 20 Color 1 0 0v -90 90
    /// ```
    ///
    /// Cut out what does not belong there and give it a text of its own. Attributes behind the sign are
    /// read all the same.
    UnexpectedSign = "E112", "unexpected sign";
    /// A letter behind `-` that the attribute does not know. Directly behind a keyword `-` and letters are
    /// flags.
    ///
    /// ```text
    /// Wheel@Car$Shape -x round
    /// ```
    ///
    /// Use the flags that the help names. If you meant a negative variable, put it in parentheses: `Offset
    /// (-w)`.
    UnknownFlag = "E113", "unknown flag";
    /// A calculation cannot be read: a sign or a number is missing, or it lacks its parentheses.
    ///
    /// ```text
    /// Rarm@Ubody$Offset (1 + )
    /// ```
    ///
    /// Mend the calculation: `Offset (1 + 2)`.
    BadExpression = "E114", "malformed expression";
    /// A name has spaces or parentheses in it and no quotes around it.
    ///
    /// ```text
    /// Left arm@Body$Shape roundv
    /// ```
    ///
    /// Put it in quotes, here and wherever else the name stands: `"Left arm"@Body$Shape roundv`.
    UnquotedName = "E115", "name needs quotes";
    /// Attributes stand behind a name without the `$` that begins them.
    ///
    /// ```text
    /// Rarm@Ubody Shape roundv
    /// ```
    ///
    /// Write `$` before the first attribute: `Rarm@Ubody$Shape roundv`.
    MissingSign = "E116", "missing sign";

    // Strings and parts
    /// There is no part left that this string could belong to: every part has one already, or the drawing
    /// has fewer parts than strings.
    ///
    /// Delete the string, draw its part, or group the two (a filled shape; lines alone are no parts unless
    /// `Strokes` says so).
    NoPartLeft = "E201", "string with no part left";
    /// Two strings belong to one part: both are in its group, or one is in its description. Or two strings with
    /// `Tiles` make one group a tile layer.
    ///
    /// Delete one, or put it where it belongs. Attributes of both can stand in one string.
    TwoStrings = "E202", "two strings on one part";
    /// Two parts have the same name, so that nobody can tell which one is meant by `@`.
    ///
    /// ```text
    /// two texts that both say Arm@Body
    /// ```
    ///
    /// Give one of them another name: `Rarm` and `Larm`.
    DuplicateName = "E203", "duplicate name";
    /// The name behind `@` is no part of this drawing.
    ///
    /// ```text
    /// Rarm@Upbody$Shape roundv
    /// ```
    ///
    /// Write the parent's name as its own string has it. Upper and lower case matter.
    UnknownParent = "E204", "unknown parent";
    /// Parts hang on each other in a circle, so that none of them hangs on the figure.
    ///
    /// ```text
    /// Arm@Hand, and Hand@Arm
    /// ```
    ///
    /// Let one of them hang on something else, or on nothing.
    ParentCycle = "E205", "cycle of parents";

    // Tiles
    /// The colour of a tile could mean more than one thing, or nothing that tiles can be: it is neither the colour
    /// of a legend nor near to one of the five colours of tiles.
    ///
    /// ```text
    /// a purple square in a group with Island$Tiles 16
    /// ```
    ///
    /// Draw a small square of that colour in the same layer, and beside it write what such tiles are: `$Tile green`
    /// (ground), `brown` (cliff), `blue` (water), `red` (roof), `beige` (wall) or `none`.
    UnclearTile = "E206", "tile of unclear colour";
    /// A motion file is no BVH that can be read: a line is missing or damaged, or frames have too many numbers or too
    /// few. The message tells the line and the column in that file. With `--keep-going` the whole frames before it are used.
    ///
    /// ```text
    /// %Motion "kick.bvh", whose last line is cut off
    /// ```
    ///
    /// Export the motion again, or delete the damaged frame and set `Frames:` to how many there are.
    BrokenMotion = "E207", "motion file that cannot be read";

    // Warnings
    /// An attribute stands twice in one string. The later one holds.
    ///
    /// ```text
    /// Rarm@Ubody$Color red Shape roundv Color blue
    /// ```
    ///
    /// Delete the one that is not meant.
    GivenTwice = "W301", "attribute given twice";
    /// Something that an earlier `%` string sets, or a variable, is set again. The later one holds for the
    /// whole drawing.
    ///
    /// ```text
    /// %Let thick 5 Let thick 8
    /// ```
    ///
    /// Delete one, or give the second variable another name.
    Overridden = "W302", "setting overridden";
    /// A legend stands beside a sample whose paint no part has, so that it does nothing.
    ///
    /// Fill the sample exactly like the parts (pick the colour from one of them), or delete the legend.
    UnusedLegend = "W303", "legend paint that no part has";
    /// Two legends stand beside samples of the same paint. The later one holds where both say something.
    ///
    /// Put all attributes into one of them.
    TwoLegends = "W304", "two legends for one paint";
    /// A solid has no thickness, because both depths are the same or its height is zero.
    ///
    /// ```text
    /// Ubody$Shape default 5 5
    /// ```
    ///
    /// Write two different depths, or `Shape flat 5` for a thin sheet.
    ZeroThickness = "W305", "zero thickness";
    /// The copies that `-s` or `-d` make lie in the same place, because the part reaches evenly to both
    /// sides of the drawing plane.
    ///
    /// ```text
    /// Tyre@Car$Shape -d default -5 5
    /// ```
    ///
    /// Move the part off the plane, by its depths (`Shape -d default 20 30`) or by `Offset`.
    CopiesCoincide = "W306", "copies coincide";
    /// Nothing is left of a part: it has no area, or a clip cuts all of it away.
    ///
    /// Draw it larger, or delete it.
    Vanishes = "W307", "part vanishes";
    /// A text of several words without a sign says nothing to okoshi. It is taken for a caption.
    ///
    /// ```text
    /// Left arm
    /// ```
    ///
    /// If it is one, put `#` before it. If it is a part's name, put it in quotes.
    Caption = "W308", "caption";
    /// The drawing uses something of SVG that has no meaning for solids, a mask or a filter for example.
    /// The part is built as if it were not there.
    ///
    /// Draw the outline itself, or use a clip, which is understood.
    NoSolidMeaning = "W309", "SVG feature without solid meaning";
    /// The attribute, or the kind of shape, is read and checked, but this version does not act upon it.
    ///
    /// ```text
    /// Boy$View 0 0
    /// ```
    ///
    /// Leave it for a later version, or use something else meanwhile.
    NotBuiltYet = "W310", "not built yet";
    /// A gradient, a pattern or a picture cannot be laid on the part, because drawing it would take too much
    /// time or memory or it uses something that okoshi does not draw, a filter within a pattern for example.
    /// The part has the mean of its colours.
    ///
    /// ```text
    /// a pattern whose tile holds 5,000 shapes
    /// ```
    ///
    /// Make the pattern simpler, export it as a picture and use that as `Texture`, or set the part's colour with
    /// `Color`.
    PlainPaint = "W311", "paint shown as its mean colour";

    /// A tile lies more than a tenth of a tile off the grid. Each cell of the grid becomes what is drawn at its
    /// middle, so that such a tile may become larger or smaller than it was drawn, or vanish.
    ///
    /// ```text
    /// squares of 18 in a group with Island$Tiles 16
    /// ```
    ///
    /// Write the size that tiles are drawn with; or move them onto the grid: in Inkscape with a grid of that
    /// spacing and snapping, from a multiple of the size on.
    OffGrid = "W312", "tiles off the grid";
    /// A tile layer holds no tile: nothing is painted in its group, or nothing that reaches the middle of a cell.
    ///
    /// ```text
    /// Island$Tiles 16, alone in a group
    /// ```
    ///
    /// Put the string into the group or layer that holds the tiles, beside them.
    NoTiles = "W313", "tile layer without tiles";
    /// `Tiles`, `Bevel` or `Roof` stands in a string that makes no tile layer, so that it has no effect.
    ///
    /// ```text
    /// Hat@Head$Roof 0.5
    /// ```
    ///
    /// Move it to the string that makes a layer or group a map: `Village$Tiles 16 Roof 0.5`.
    NoTileLayer = "W314", "attribute of a tile layer elsewhere";
    /// A tile map can be read in more than one way, or in none that the rules of terrain explain. It is built all the same: a
    /// group whose height nothing tells lies on the ground, one with fewer brown tiles than it is high hangs, brown tiles
    /// in the midst of green ones are pits, and a wall or a roof alone is ground of its colour.
    ///
    /// ```text
    /// a brown tile in the midst of green ones, and no edge in the map
    /// ```
    ///
    /// Draw what is missing: brown tiles below what stands, an edge (a stroke along the line between two tiles) where one
    /// thing ends and another begins, roofs over walls.
    OpenTerrain = "W315", "terrain with more than one reading";
    /// `Bone` names a joint that no motion of the figure has, or that several joints are called; or two joints of which the second
    /// does not hang on the first. The part is matched by its name and place, or follows the first of the joints.
    ///
    /// ```text
    /// Rarm@Ubody$Bone RightAm
    /// ```
    ///
    /// Write the joint as the motion file does; editors complete it, and `okoshi motion FILE` lists them all. `Bone` takes a joint,
    /// or two: where a chain begins and where it ends.
    UnclearJoint = "W316", "unclear joint";
    /// A motion that moves nothing, or `Limited` or `Bone` in a drawing without a motion.
    ///
    /// ```text
    /// %Limited 4 30, and no Motion
    /// ```
    ///
    /// Write `%Motion "file.bvh"` for all figures, or `Motion "file.bvh"` in the string of a figure's root. A figure needs parts
    /// that are known as head, body, arms or legs by their names or places; `Bone` says which joint drives a part.
    IdleMotion = "W317", "motion without effect";
    /// Limited animation could not be made as asked, or tears the motion apart: no pose stands for more than three frames, so
    /// that at most about two thirds of the frames can be held; and more than six drawings left out in one place look like a
    /// mistake.
    ///
    /// ```text
    /// %Motion "kick.bvh" Limited 12 90, and kick.bvh has 60 frames
    /// ```
    ///
    /// Ask for less: 4 to 6 drawings to omit, and a third of the frames to hold.
    TooLimited = "W318", "limited animation out of reach";

    // Hints
    /// Another part lies almost as near to the string as the one it was given to.
    ///
    /// Group the string with its part, or move it nearer.
    NearlyAsNear = "H401", "second part almost as near";
    /// A part without a string was given a name, `U-1` for example, and the nearest named part as its
    /// parent.
    ///
    /// Write a name beside it if you want to say more about it.
    AutomaticName = "H402", "automatic name";
    /// The part is about as long as it is wide, so that its axis is a guess: upright.
    ///
    /// ```text
    /// Head@Ubody$Shape roundv
    /// ```
    ///
    /// Set the axis with `Axis`, or use `Shape round`, which needs none.
    AxisGuess = "H403", "axis is a guess";
    /// A long part turns about its middle, which is seldom meant for an arm or a leg. Both its ends are
    /// about equally far from the parent.
    ///
    /// Write `Origin start` (the end nearer to the parent) or `Origin end`.
    TurnsAboutMiddle = "H404", "turns about its middle";
    /// The string has full-width signs, as Japanese input methods type them. They are read as their
    /// half-width forms.
    ///
    /// ```text
    /// Ｒａｒｍ＠Ｕｂｏｄｙ＄Ｓｈａｐｅ　ｒｏｕｎｄ
    /// ```
    ///
    /// Nothing need be done. The fix writes the half-width forms: `Rarm@Ubody$Shape round`.
    FullWidth = "H405", "full-width signs";
    /// A shape lies off the page. It becomes a part all the same.
    ///
    /// Delete it if it is a leftover; move it onto the page, or put an unused string (`*`) beside it.
    OffPage = "H406", "off the page";
    /// A motion file was read in spite of a slip in it, or a part of it was left out because it is no motion: the T-pose
    /// that many clips begin with.
    ///
    /// Nothing need be done. `okoshi motion IN.bvh --full -o OUT.bvh` writes the motion as it was understood.
    MotionMended = "H407", "motion file read with care";
    /// The motion has no joint for a limb of the figure. The part follows the one that it hangs on.
    ///
    /// Say which joint drives it with `Bone`, or leave it as it is.
    NoJoint = "H408", "limb without a joint";
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
