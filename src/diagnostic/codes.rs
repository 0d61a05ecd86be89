//! The table of diagnostics: code, severity, title and manual page of each.

use super::Severity;

macro_rules! codes {
    ($($(#[doc = $doc:literal])+ $name:ident = $id:literal, $title:literal;)+) => {
        /// A diagnostic's stable code. The letter gives the severity: E error, W warning, H hint.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
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

            /// A short title.
            pub fn title(self) -> &'static str {
                match self { $(Code::$name => $title,)+ }
            }

            /// The manual page, in Markdown: what the diagnostic means, an example of the mistake, and the fix.
            pub fn manual(self) -> &'static str {
                match self { $(Code::$name => concat!($($doc, "\n",)+),)+ }
            }
        }
    };
}

codes! {
    // The file
    /// The drawing is not well-formed XML: a tag is never closed, a quote is missing in a tag, or a text
    /// contains a bare `&` or `<`, or the first line is no XML declaration but looks like one. Drawing programs
    /// write correct XML, so this usually comes from editing the file by hand, or from a file that was cut off.
    /// Entities that stand for elements are not read either.
    ///
    /// ```text
    /// <text>Salt & Pepper</text>
    /// ```
    ///
    /// Fix the marked place. In texts, write `&amp;` for `&` and `&lt;` for `<`. Or open the drawing in the
    /// drawing program and save it again.
    NotXml = "E001", "not well-formed XML";
    /// The file is XML, but its outermost element is not `svg`, so it is not a drawing.
    ///
    /// ```text
    /// <html>…</html>
    /// ```
    ///
    /// Save the drawing as SVG, and give that file to okoshi.
    NotSvg = "E002", "not an SVG drawing";
    /// The file is empty.
    ///
    /// Save the drawing again, and check that the disk is not full.
    EmptyFile = "E003", "empty file";
    /// The file is not encoded in UTF-8, the encoding that okoshi reads.
    ///
    /// Open the drawing in the drawing program and save it again as plain SVG.
    NotUtf8 = "E004", "not UTF-8";
    /// The drawing passes one of okoshi's limits: parentheses or groups are nested too deep, or an image or a
    /// map is too large. The limits are there so that a mistake cannot use up the computer's memory.
    ///
    /// ```text
    /// Arm$Offset ((((…))))
    /// ```
    ///
    /// Make what is marked smaller or simpler. To shorten a calculation, define parts of it as variables with
    /// `Let`.
    LimitPassed = "E005", "limit passed";
    /// The drawing names a file that does not exist, or that cannot be read as the expected kind of file. File
    /// names are relative to the drawing's folder, and upper and lower case matter.
    ///
    /// ```text
    /// Lbody$Motion "Kick.bvh"
    /// ```
    ///
    /// Put the file there, or correct its name. If a picture cannot be read, save it again as PNG.
    MissingFile = "E006", "missing linked file";
    /// The drawing names a file outside its own folder: by `..`, an absolute path or a web address. Such files
    /// are not read, so that a drawing from somebody else cannot read files from your computer.
    ///
    /// ```text
    /// Sail$Texture "../../photos/canvas.png"
    /// ```
    ///
    /// Copy the file into the drawing's folder or a folder below it.
    LinkOutside = "E007", "link outside the drawing's folder";
    /// okoshi crashed while it compiled the drawing. The bug is in okoshi, not in the drawing, but no model can be built
    /// until it is fixed.
    ///
    /// Please report it to the maintainers, with the drawing, the files that it links to, the whole message (it names
    /// the place in the program) and the version, which `okoshi --version` prints.
    ///
    /// Meanwhile, undo the last change, or open the drawing in Inkscape and save it as Plain SVG.
    Crash = "E008", "okoshi crashed";

    // The strings
    /// The marked word is not a keyword. Either a keyword is misspelled, or the attribute before it has a word
    /// too many.
    ///
    /// ```text
    /// Rarm@Ubody$Colr 1 0 0
    /// ```
    ///
    /// Correct the keyword: `Color`. `okoshi explain` lists all keywords. The text up to the next keyword is
    /// skipped; the rest of the string still counts.
    UnknownKeyword = "E101", "unknown keyword";
    /// An attribute that takes one of a few words got a word it does not know, for example as a kind of
    /// `Shape`, a colour name or a function.
    ///
    /// ```text
    /// Rarm@Ubody$Shape roundw
    /// ```
    ///
    /// Write one of the words the attribute knows: `Shape roundv`.
    UnknownWord = "E102", "unknown word";
    /// An attribute has too few or too many arguments.
    ///
    /// ```text
    /// Rarm@Ubody$Shape roundv 90
    /// ```
    ///
    /// Give as many arguments as the help shows: `Shape roundv` takes two angles or none. If an argument is a
    /// name that is also a keyword, put it in quotes.
    ArgumentCount = "E103", "wrong number of arguments";
    /// An argument has the wrong type: text instead of a number, a number with a unit or a comma, or a file name
    /// without quotes.
    ///
    /// ```text
    /// Rarm@Ubody$Offset 12px
    /// ```
    ///
    /// Write numbers without units, and with a point for decimals (`0.5`). Put files and text in quotes
    /// (`"kick.bvh"`), and calculations in parentheses (`(2 * 3)`).
    ArgumentType = "E104", "wrong type of argument";
    /// A number is outside the range that the attribute accepts, or a calculation has no result, for example
    /// because it divides by zero.
    ///
    /// ```text
    /// Window@Car$Alpha 30
    /// ```
    ///
    /// Write a number in the range that the message shows. Opacity goes from 0 to 1, so 30 % is `Alpha 0.3`.
    OutOfRange = "E105", "value out of range";
    /// A quoted text begins here, but its closing quote is missing.
    ///
    /// ```text
    /// Lbody$Motion "kick.bvh Color red
    /// ```
    ///
    /// Add the closing `"`: `Motion "kick.bvh"`.
    UnclosedQuote = "E106", "unclosed quote";
    /// An opening parenthesis has no closing one, or a closing parenthesis has no opening one.
    ///
    /// ```text
    /// Rarm@Ubody$Offset (1 + 2
    /// ```
    ///
    /// Add the missing parenthesis: `Offset (1 + 2)`.
    UnclosedParenthesis = "E107", "unclosed parenthesis";
    /// A word is used in place of a number. It could be a variable, but no `%` string defines it.
    ///
    /// ```text
    /// Rarm@Ubody$Offset thick
    /// ```
    ///
    /// Write a number, or define the variable: `%Let thick 12`. Upper and lower case matter in variable names.
    UnknownVariable = "E108", "unknown variable";
    /// Variables are defined in terms of each other in a circle, so that none of them has a value.
    ///
    /// ```text
    /// %Let a (b + 1) Let b (a - 1)
    /// ```
    ///
    /// Give one of the variables a plain number.
    VariableCycle = "E109", "cycle of variables";
    /// The attribute is not allowed in this kind of string. `Scale`, for example, applies to the whole drawing
    /// and is only allowed in `%` strings.
    ///
    /// ```text
    /// Rarm@Ubody$Scale 2
    /// ```
    ///
    /// Move the attribute to a string where it is allowed. The help says which.
    NotAllowedHere = "E110", "attribute not allowed here";
    /// A string has a parent or attributes but no name, or there is no name after `@`.
    ///
    /// ```text
    /// @Ubody$Shape roundv
    /// ```
    ///
    /// Write the name first: `Rarm@Ubody$Shape roundv`. Only in the description of an object may the name be
    /// left out.
    NoName = "E111", "part string without a name";
    /// A sign is in a place where it is not allowed. Most often, two strings were typed into one text because
    /// the cursor was still in the first text.
    ///
    /// ```text
    /// Rarm@Ubody$Shape round$Shape default 0 20 Color 1 0 0v -90 90
    /// ```
    ///
    /// Cut out the second string and paste it into a text of its own. Until then, the attributes after the sign
    /// are read as if the sign were not there.
    UnexpectedSign = "E112", "unexpected sign";
    /// The attribute does not know the letter after `-`. Directly after a keyword, `-` and letters are flags.
    ///
    /// ```text
    /// Wheel@Car$Shape -x round
    /// ```
    ///
    /// Use the flags that the help lists. A negative variable needs parentheses: `Offset (-w)`.
    UnknownFlag = "E113", "unknown flag";
    /// A calculation cannot be read: an operator, a number or the parentheses are missing.
    ///
    /// ```text
    /// Rarm@Ubody$Offset (1 + )
    /// ```
    ///
    /// Complete the calculation: `Offset (1 + 2)`.
    BadExpression = "E114", "malformed expression";
    /// A name contains spaces or parentheses, but is not in quotes.
    ///
    /// ```text
    /// Left arm@Body$Shape roundv
    /// ```
    ///
    /// Put the name in quotes, here and wherever else it is used: `"Left arm"@Body$Shape roundv`.
    UnquotedName = "E115", "name needs quotes";
    /// The `$` between a name and its attributes is missing.
    ///
    /// ```text
    /// Rarm@Ubody Shape roundv
    /// ```
    ///
    /// Write `$` before the first attribute: `Rarm@Ubody$Shape roundv`.
    MissingSign = "E116", "missing sign";

    // Strings and parts
    /// No part is left for this string: every part has a string already, or the drawing has fewer parts than
    /// strings.
    ///
    /// Delete the string, draw its part, or group the string with its part. A part is a filled shape; a
    /// line without a fill is one only if it is grouped with the string, or if `Strokes` says so.
    NoPartLeft = "E201", "string with no part left";
    /// Two strings belong to the same part: both are grouped with it, or one is in its description. Or two
    /// strings with `Tiles` are in the same group.
    ///
    /// Delete one of them, or move it to the part it belongs to. One string can hold the attributes of both.
    TwoStrings = "E202", "two strings on one part";
    /// Two parts have the same name, so that a parent given by `@` would be ambiguous.
    ///
    /// ```text
    /// two texts that both say Arm@Body
    /// ```
    ///
    /// Rename one of them, for example to `Rarm` and `Larm`.
    DuplicateName = "E203", "duplicate name";
    /// No part of this drawing has the name after `@`.
    ///
    /// ```text
    /// Rarm@Upbody$Shape roundv
    /// ```
    ///
    /// Write the parent's name exactly as in the parent's own string. Upper and lower case matter.
    UnknownParent = "E204", "unknown parent";
    /// Parts are attached to each other in a circle, so that none of them is attached to the rest of the figure.
    ///
    /// ```text
    /// Arm@Hand, and Hand@Arm
    /// ```
    ///
    /// Attach one of them to another part, or give it no parent.
    ParentCycle = "E205", "cycle of parents";

    // Tiles
    /// It is not clear what kind of tile this colour stands for: no legend has the colour, and it is not close
    /// enough to exactly one of the five tile colours.
    ///
    /// ```text
    /// a purple square in a group with Island$Tiles 16
    /// ```
    ///
    /// Draw a small square of that colour in the same layer, and write beside it what such tiles are: `$Tile green`
    /// (ground), `brown` (cliff), `blue` (water), `red` (roof), `beige` (wall) or `none`.
    UnclearTile = "E206", "tile of unclear colour";
    /// The motion file is not a readable BVH file: a line is missing or damaged, or a frame has too many or too few
    /// numbers. The message gives the line and the column in that file. With `--keep-going`, the complete frames
    /// before the error are used.
    ///
    /// ```text
    /// %Motion "kick.bvh", whose last line is cut off
    /// ```
    ///
    /// Export the motion again. Or delete the damaged frame, and set `Frames:` to the number of frames that are left.
    BrokenMotion = "E207", "motion file that cannot be read";
    /// The file that `Perform` names is not a readable file of tracks: JSON or CSV, as `okoshi track` writes it.
    ///
    /// ```text
    /// %Motion "hook.bvh" Perform "hands.json", and hands.json is cut off
    /// ```
    ///
    /// Track the clip again: `okoshi track CLIP -o hands.json --mark red`.
    BrokenTrack = "E208", "track that cannot be read";
    /// The file that `Tiles` names is not a map of Tiled, or it is damaged, or of a kind that okoshi does not read: a hexagonal or isometric
    /// map, for example. The same is said of the tile sets that it needs.
    ///
    /// ```text
    /// Island$Tiles "isle.tmx", and a cell has a tile that is in no tile set
    /// ```
    ///
    /// Open the map in Tiled, and save it again, as an orthogonal map.
    BrokenTiles = "E209", "map that cannot be read";

    // Warnings
    /// A string sets the same attribute twice. The later one counts.
    ///
    /// ```text
    /// Rarm@Ubody$Color red Shape roundv Color blue
    /// ```
    ///
    /// Delete the one you do not want.
    GivenTwice = "W301", "attribute given twice";
    /// A `%` string sets a variable or a setting that an earlier `%` string has set already. The later one counts,
    /// for the whole drawing.
    ///
    /// ```text
    /// %Let thick 5 Let thick 8
    /// ```
    ///
    /// Delete one of them, or give the second variable another name.
    Overridden = "W302", "setting overridden";
    /// No part has the paint of this legend's sample, so the legend has no effect.
    ///
    /// Give the sample exactly the same fill as the parts, for example by picking the colour from one of them.
    /// Or delete the legend.
    UnusedLegend = "W303", "legend paint that no part has";
    /// Two legends have samples with the same paint. Where both set the same attribute, the later legend counts.
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
    /// The two copies that `-s` or `-d` makes are in the same place, because the part reaches equally far to both
    /// sides of the drawing plane.
    ///
    /// ```text
    /// Tyre@Car$Shape -d default -5 5
    /// ```
    ///
    /// Move the part off the plane, by its depths (`Shape -d default 20 30`) or by `Offset`.
    CopiesCoincide = "W306", "copies coincide";
    /// Nothing is left of the part: it has no area, or a clip removes all of it.
    ///
    /// Draw it larger, or delete it.
    Vanishes = "W307", "part vanishes";
    /// A text consists of several words and has no sign, so okoshi does not read it as a string. It is taken for a
    /// caption.
    ///
    /// ```text
    /// Left arm
    /// ```
    ///
    /// If it is a caption, put `#` before it. If it is a part's name, put it in quotes.
    Caption = "W308", "caption";
    /// The drawing uses an SVG feature that has no meaning for solids, for example a mask or a filter, or one that okoshi does
    /// not read, such as an animation, a mesh gradient or a value of CSS like `calc()`. The part is built without it. The same is
    /// said of what a map of Tiled has that is not built.
    ///
    /// Draw the outline itself, or use a clip, which okoshi understands.
    NoSolidMeaning = "W309", "SVG feature without solid meaning";
    /// This version reads and checks the attribute, or the kind of shape, but does not build it yet.
    ///
    /// ```text
    /// Boy$Walk 40
    /// ```
    ///
    /// Leave it in for a later version, or use something else for now.
    NotBuiltYet = "W310", "not supported yet";
    /// A gradient, a pattern or a picture cannot be drawn on the part, because that would take too much time or
    /// memory, or because it uses something that okoshi does not draw, such as a filter in a pattern. The part gets
    /// the mean colour instead.
    ///
    /// ```text
    /// a pattern whose tile holds 5,000 shapes
    /// ```
    ///
    /// Simplify the pattern, export it as a picture and use that as `Texture`, or set the part's colour with
    /// `Color`.
    PlainPaint = "W311", "paint shown as its mean colour";

    /// A tile is more than a tenth of a tile off the grid. Each cell of the grid becomes whatever is drawn at its
    /// centre, so such a tile can become larger or smaller than it is drawn, or vanish. The fix writes the size, and
    /// moves the layer to the place, that fit all borders best. The same warning names what is drawn but is not in
    /// the map: a stroke that runs across tiles, and a shape that covers the centre of no tile.
    ///
    /// ```text
    /// squares of 18 in a group with Island$Tiles 16
    /// ```
    ///
    /// Apply the fix, or write the size that the tiles are drawn with, or move them onto the grid. In Inkscape, use a
    /// grid with that spacing and with its origin at a multiple of the size, and turn on snapping. For decoration,
    /// write the string `*` beside it.
    OffGrid = "W312", "tiles off the grid";
    /// A tile layer has no tiles: nothing in its group is painted, or nothing covers the centre of a cell.
    ///
    /// ```text
    /// Island$Tiles 16, alone in a group
    /// ```
    ///
    /// Put the string into the group or layer that contains the tiles.
    NoTiles = "W313", "tile layer without tiles";
    /// `Tiles`, `Bevel` or `Roof` is in a string that does not make a tile layer, `Height` outside of one, or `Depth` or `Hidden` in one outside of a
    /// character's views, or `Stand` where nothing stands on a map, or `Motion` and the like in the string of a prop, which does not move: so it has
    /// no effect.
    ///
    /// ```text
    /// Hat@Head$Roof 0.5
    /// ```
    ///
    /// Move it to the string that turns a layer or a group into a map: `Village$Tiles 16 Roof 0.5`; or into a layer with a string like
    /// `Boy$View 0 0`. The string of a region in a picture may say `Depth` and `Hidden`; how it looks is up to the picture.
    NoTileLayer = "W314", "attribute of a layer elsewhere";
    /// The rules of terrain allow more than one reading of this tile map, or none. It is built all the same: a group
    /// without a height lies on the ground, a group with fewer brown tiles than it is high hangs in the air, brown
    /// tiles in the middle of green ones are pits, and a wall or a roof on its own is ground of its colour.
    ///
    /// ```text
    /// a brown tile in the midst of green ones, and no edge in the map
    /// ```
    ///
    /// Draw what is missing: brown tiles below a block, an edge (a stroke along the line between two tiles) where one
    /// thing ends and another begins, or roofs over walls.
    OpenTerrain = "W315", "terrain with more than one reading";
    /// `Bone` names a joint that no motion of the figure has, or a name that several joints share; or it names two
    /// joints, and the second is not below the first. The part is matched by its name and position instead, or it
    /// follows the first of the joints.
    ///
    /// ```text
    /// Rarm@Ubody$Bone RightAm
    /// ```
    ///
    /// Write the joint's name as in the motion file. Editors complete it, and `okoshi motion FILE` lists all joints.
    /// `Bone` takes one joint, or two: the first and the last of a chain.
    UnclearJoint = "W316", "unclear joint";
    /// A motion moves nothing, or the drawing has `Limited`, `Held`, `Bone` or `Perform` but no motion.
    ///
    /// ```text
    /// %Limited 4 30, and no Motion
    /// ```
    ///
    /// Write `%Motion "file.bvh"` for all figures, or `Motion "file.bvh"` in the string of a figure's root part. okoshi
    /// must recognise some parts as head, body, arms or legs, by their names or positions; `Bone` says which joint
    /// drives a part.
    IdleMotion = "W317", "motion without effect";
    /// The motion cannot be limited as asked, or limiting leaves a large gap. No pose is held for more than three
    /// frames, so at most about two thirds of the frames can be held. And more than six omitted drawings in one place
    /// look like a mistake.
    ///
    /// ```text
    /// %Motion "kick.bvh" Limited 12 90, and kick.bvh has 60 frames
    /// ```
    ///
    /// Ask for less: omit 4 to 6 drawings, and hold a third of the frames.
    ///
    /// Likewise for drawings that `Held` lists: frames that the motion does not have, drawings that others cover or that are left out anyway, and more
    /// frames than are left until the end.
    TooLimited = "W318", "limited animation out of reach";
    /// All strings of the drawing are hidden, so none is read: what is hidden does not count. The drawing is built as if it
    /// had no strings.
    ///
    /// ```text
    /// a layer `Text`, hidden, that holds all strings
    /// ```
    ///
    /// Show the layer again; in Inkscape, click the eye beside its name in *Layer → Layers and Objects*.
    HiddenStrings = "W319", "all strings are hidden";
    /// A text that said a string was converted to paths: it looks the same, but its letters are shapes now. Drawing programs
    /// keep what the text said in the attribute `aria-label`, which is how okoshi knows.
    ///
    /// ```text
    /// a path with aria-label="Arm@Body"
    /// ```
    ///
    /// Undo the conversion, or delete the letters and type the text again.
    ConvertedText = "W320", "text converted to paths";
    /// A name ends in a sign and the name of another part, so the sign is probably meant to be `@`.
    ///
    /// ```text
    /// Rarm:Ubody
    /// ```
    ///
    /// Write `@` between a part and what it is attached to: `Rarm@Ubody`.
    SignInName = "W321", "another sign in the place of @";
    /// Filled shapes have outlines (strokes), and the drawing does not say what is to become of them. They are left out,
    /// so that the model shows filled areas only, and is smaller than the drawing by half the width of each outline.
    ///
    /// ```text
    /// %Strokes all
    /// ```
    ///
    /// Write this text anywhere on the page to build outlines as ink on their shapes, or `%Strokes none` if the filled
    /// areas are enough.
    OutlinesLeftOut = "W322", "outlines left out";
    /// A view of a character cannot be used: it is the only one, nothing is drawn in it, more than 1,000 shapes are, or another
    /// one has the same angles.
    /// A character turns between two views or more.
    ///
    /// ```text
    /// Boy$View 0 0
    /// ```
    ///
    /// Draw the character from another side, in a layer or group of its own, and write the string with the angles there, for example
    /// `Boy$View 45 0`.
    UnusableView = "W323", "view that cannot be used";
    /// A region of a character was drawn in one of its views, but nothing in the other views looks like the same thing. Within
    /// 15° of its view it shrinks to nothing. Often it is hidden in the others, or its colour differs, or it is far away from where
    /// it was expected.
    ///
    /// ```text
    /// Boy$View 45 0      and only this layer has a yellow badge
    /// ```
    ///
    /// You need not change anything if the region is hidden in the other view. To say that two regions are the same, write the
    /// same name beside both. To give the shape that a region has while it is hidden, draw it in the other view, too, and
    /// mark it with `Hidden`.
    NoPartner = "W324", "region without a partner";
    /// Two views of a character do not fit each other: they are almost from the same side, so that a small difference in
    /// drawing makes a large one in depth; or details end up behind what they are drawn on, which happens if the sign of an
    /// angle is wrong.
    ///
    /// ```text
    /// Boy$View 0 0    Boy$View -45 0      and the face moves to the left of the picture
    /// ```
    ///
    /// The first number is positive if the viewer walks to the character's left: then its face moves to the left of the picture. The
    /// second one is positive if the viewer looks from above: then the face moves down.
    ///
    /// It is also reported if a view says `Mirror`, but there is nothing to mirror: no view is from the front (`View 0 0`), or none
    /// from the side, or both sides are drawn.
    UnlikelyViews = "W325", "views that do not fit";
    /// A feature point has no effect: it is outside of a character's views, its view has another one of that name, or another view
    /// that shows its region has none.
    ///
    /// ```text
    /// ^tip beside an ear in one view, and none in the other
    /// ```
    ///
    /// Write the same name beside the same place of the outline in every view that shows the region.
    UnusedFeature = "W326", "feature point without effect";
    /// `Follow` names what is edited together with a characteristic joint, but its part is none: it has no `Mark`. So `Follow`
    /// has no effect.
    ///
    /// ```text
    /// Rhand@Rarm$Follow Head
    /// ```
    ///
    /// Write the colour of the mark that performs the part, `Mark red Follow Head` for example, or delete `Follow`.
    NoMark = "W327", "`Follow` without a mark";
    /// The marks of a performed track and those of the drawing do not fit together: a mark without a part, a part whose mark is not
    /// in the track or which no joint of the motion drives, or a name that means nothing.
    ///
    /// ```text
    /// Rhand@Rarm$Mark purple, and the track has the marks `red` and `green`
    /// ```
    ///
    /// Write the colour or the name of one of the track's marks, or track the clip again with `--mark purple`.
    MarkMismatch = "W328", "mark that does not fit";
    /// A performance does not do what one expects of it: no mark moves, there are two actions, or the motion's largest movement is that of
    /// another joint.
    ///
    /// ```text
    /// %Motion "hook.bvh" Perform "hands.json", and no mark moves in hands.json
    /// ```
    ///
    /// Film the puppet from the front, and cut the clip to one action: `okoshi track CLIP --range 1:48`. Or name the frames that
    /// belong together, that of the track first: `Perform "hands.json" 31 44`.
    OddPerformance = "W329", "performance with an unexpected effect";
    /// A gait such as `walk` is played by a figure in which no legs are found, or any motion by one without limbs: it glides. Or a
    /// clip moves wheels, wings, fins or tentacles, and the figure has none.
    ///
    /// ```text
    /// Ghost$Motion walk
    /// ```
    ///
    /// Name the parts on which it stands after what they are, such as `Lleg@Ghost` and `Rleg@Ghost`, or say which joints drive
    /// them with `Bone`. Or write the clip that fits what the figure has, or `Motion` alone, which finds it. `okoshi inspect` tells
    /// what each part is taken for.
    NoLimbs = "W330", "motion without limbs";
    /// The motion takes a part off what it hangs on, because it turns about a point that lies beside one of the two. Over the
    /// clip, the gap between them grows by more than 3 % of the figure's height.
    ///
    /// ```text
    /// Larm@Body$Origin 300 40
    /// ```
    ///
    /// Draw the two so that they overlap where the part turns, attach the part to what it touches, or choose the point with
    /// `Origin`.
    ComesOff = "W331", "part that comes off";
    /// `from`, `to` or a number of seconds asks for more of a motion file than there is.
    ///
    /// ```text
    /// %Motion "kick.bvh" kick from 1.2 to 24, and kick.bvh takes 2.8 seconds
    /// ```
    ///
    /// Times are seconds of the file, which begins at 0; the message says how long it is. Without `to` it plays to its end.
    OutsideMotion = "W332", "range outside of a motion";
    /// `Bend` gives a part joints inside it, but this one has no room for them, or no solid. So `Bend` has no effect.
    ///
    /// ```text
    /// a ball with the string Ball@Hand$Bend 2
    /// ```
    ///
    /// Write `Bend` in the string of the part that should bend, which must be longer than it is wide, or delete it.
    IdleBend = "W333", "bend without effect";
    /// The dashes of strokes are so fine that the drawing would have more of them than okoshi builds. They, and the gaps between them, are
    /// drawn longer.
    ///
    /// ```text
    /// a long line with the dash pattern 0.01 0.01
    /// ```
    ///
    /// Make the dashes longer, or draw the lines without dashes: in Inkscape, *Fill and Stroke → Stroke style → Dashes*.
    LongerDashes = "W334", "dashes drawn longer";
    /// A shape has too many corners to be rounded or pointed with `round`, `roundv`, `roundh`, `cone`, `conev`, `coneh` or `lathe`. It is a
    /// plate instead. The corners of a curve are those of the polygon that it becomes.
    ///
    /// ```text
    /// a traced picture of several thousand points with the string Coat$Shape roundv
    /// ```
    ///
    /// Simplify the path, in Inkscape with *Path → Simplify*, or use `Shape inflate`, which has no such limit.
    TooFine = "W335", "too many corners";
    /// So much of the drawing is rounded or pointed that its solids would have too many triangles, however few layers each has. Those that
    /// take the most are plates instead. A line has more of them the longer and thinner it is.
    ///
    /// ```text
    /// a thousand hair-thin lines across the page
    /// ```
    ///
    /// Draw fewer shapes or simpler ones, in Inkscape with *Path → Simplify*, or write `Shape default` for those that may be flat.
    TooMuchRound = "W336", "too much that is round";
    /// A picture of a character has soft shades instead of areas in one colour each: it was painted with a soft brush, or it is a
    /// photograph. Each shade became a region of one colour; or, if there are too many to tell them from areas, each step of them
    /// did, so that there are more regions than anybody would draw, and they hardly match those of another view. Noise, and what
    /// JPEG files add to edges, are cleaned away without a word.
    ///
    /// ```text
    /// a layer with the string Bird$View 0 0 and a photograph of a bird
    /// ```
    ///
    /// Paint each area in one colour, in Krita or GIMP with *Posterize*, or trace the picture with few colours, in Inkscape with
    /// *Path → Trace Bitmap*.
    SoftShades = "W337", "picture with soft shades";
    /// The foot of a prop, the middle of its lowest edge, is not drawn on ground: it is beside the map, where the prop stands at height 0, or on the
    /// front of a wall, where it stands on top of the wall.
    ///
    /// ```text
    /// Trees$Stand, with a tree that is drawn beside the island
    /// ```
    ///
    /// Move the prop so that its lowest edge is on a top of the map, or write the point on which it stands into its string: `Tree$Stand 40 120`.
    NoFooting = "W338", "prop beside the ground";
    /// A string with `Pose` makes no key pose: its layer holds no copies of parts, or the string is in no layer; or a part of the
    /// figure that it names is missing, so that the copies alone say whose pose it is.
    ///
    /// ```text
    /// Boy$Pose 1.5 in an empty layer
    /// ```
    ///
    /// Clone the parts that move (in Inkscape, Alt+D), move the clones into the layer of the string (Shift+Page Up), and turn them there.
    IdlePose = "W339", "key pose without effect";
    /// Something in a pose layer is a copy of no part: neither a clone of one, nor has it the label, the string or the id of one.
    /// It has no effect; nothing in a pose layer is built.
    ///
    /// ```text
    /// a ball that is drawn in the layer of Boy$Pose 1.5
    /// ```
    ///
    /// Clone the part itself, or give the copy the part's label. What is to be built belongs into another layer.
    CopyOfNoPart = "W340", "copy of no part";
    /// The key poses of a clip do not come one after the other: the layer above has a second that is not later. It is left out.
    ///
    /// ```text
    /// $Pose 2 in a layer, and $Pose 1 in the layer above it
    /// ```
    ///
    /// Order the layers as they play, from bottom to top, or correct the seconds.
    PoseOrder = "W341", "key poses out of order";
    /// A copy in a pose layer has another size or outline than its part, or is mirrored. Parts are turned and moved, but not scaled,
    /// redrawn or flipped.
    ///
    /// ```text
    /// a clone of an arm that was scaled to 120 %
    /// ```
    ///
    /// Clone the part again, and turn the clone without scaling it.
    CopyDiffers = "W342", "copy that is not like its part";
    /// A copy in a pose layer lies beside the joint about which its part turns, by more than 5 % of the part's length. Only its turn
    /// counts, so that in the model the part stays where it hangs.
    ///
    /// ```text
    /// a clone of an arm that was moved away from the shoulder
    /// ```
    ///
    /// Put the copy back onto its joint. In Inkscape, drag the cross of a selected object onto the joint and turn the object: it turns about the cross.
    OffJoint = "W343", "copy off its joint";

    // Hints
    /// The string may mean one of two shapes: it lies on both, or between them.
    ///
    /// Move it onto the shape that it means, draw a line from it to the shape, or group the two. The fixes make the
    /// string the description of one shape or the other (Inkscape: *Object Properties → Description*), which settles it.
    Uncertain = "H401", "uncertain which shape a string means";
    /// A part without a string got the name of its label or id, or an automatic name, such as `U-1`, and the nearest named part as
    /// its parent.
    ///
    /// Write a name beside the part if you want to give it a parent or attributes.
    AutomaticName = "H402", "automatic name";
    /// The part is about as long as it is wide, so its axis is a guess: upright.
    ///
    /// ```text
    /// Head@Ubody$Shape roundv
    /// ```
    ///
    /// Set the axis with `Axis`, or use `Shape round`, which needs no axis.
    AxisGuess = "H403", "axis is a guess";
    /// A long part turns about its middle, which is seldom right for a lever or a door. It does so because both its
    /// ends are about equally far from the parent. Limbs that are named as such, `Arm`, `Lleg`, `尾`, never do.
    ///
    /// Write `Origin start` (the end nearer to the parent) or `Origin end` (the other end).
    TurnsAboutMiddle = "H404", "turns about its middle";
    /// The string contains full-width characters, as Japanese input methods type them. They are read as ASCII.
    ///
    /// ```text
    /// Ｒａｒｍ＠Ｕｂｏｄｙ＄Ｓｈａｐｅ　ｒｏｕｎｄ
    /// ```
    ///
    /// You need not change anything. The fix writes the ASCII forms: `Rarm@Ubody$Shape round`.
    FullWidth = "H405", "full-width characters";
    /// A shape is off the page. It still becomes a part.
    ///
    /// If it is a leftover, delete it. Otherwise move it onto the page, or put an unused string (`*`) beside it.
    OffPage = "H406", "off the page";
    /// A motion file was read in spite of a small error in it, or a part of it was left out because it is not motion:
    /// the T-pose that many clips begin with.
    ///
    /// You need not change anything. `okoshi motion IN.bvh --full -o OUT.bvh` writes the motion as okoshi read it.
    MotionRepaired = "H407", "small error in a motion file";
    /// The motion has no joint for a limb of the figure. The part moves along with its parent.
    ///
    /// Name the joint that drives it with `Bone`, or leave it as it is.
    NoJoint = "H408", "limb without a joint";
    /// A rectangle as large as the page lies behind everything else. Such a rectangle is the paper rather than a part of the
    /// figure, so it is left out of the model. One with rounded corners is built, and so is one below shapes that together reach
    /// all edges of the page, as those of a flag do. A flat grey, dark or translucent ellipse below the feet of what is drawn is a shadow
    /// on the ground, and is left out as well.
    ///
    /// You need not change anything. To build it too, write a name on it.
    Background = "H409", "background left out";
    /// `Offset` moves the part so far that the rest of the model is a dot beside it.
    ///
    /// ```text
    /// Rarm@Ubody$Offset 100000
    /// ```
    ///
    /// Write lengths in drawing units, in which the page is as wide as the message says.
    FarAway = "H410", "part far away";
    /// Seen from the front, the model does not show the part as it is drawn: something is in front of it, it is inside a
    /// rounder part, nothing is built of it, or its colour differs. Only `okoshi check --look` reports this.
    ///
    /// ```text
    /// Eye@Head$Offset -30
    /// ```
    ///
    /// Bring the part to the front with `Offset`, choose a flatter `Shape` for what hides it, or take away depths that
    /// strings give. `okoshi render --as-drawn` draws the same view.
    LooksDifferent = "H411", "looks different from the front";
    /// A depth that is given by numbers hides a part that is drawn later, or leaves a gap between a detail and what it is drawn
    /// on. Depths of `Shape`, and `Offset`, in a part's own string or in a legend are kept exactly, whatever the order of
    /// drawing says; so a part can end up inside another one, behind it, or far in front of it. Only what is noticeable is
    /// reported: at least 20 % of what the drawing shows of the part, and no speck.
    ///
    /// ```text
    /// Head@Body$Shape default -20 20
    /// Nose@Head$Shape default -5 5
    /// ```
    ///
    /// The fix takes the depth away, so that the part lies as it is drawn: `Nose@Head`. Where `%Shape` sets another kind, the
    /// kind stays: `Nose@Head$Shape default`. For a thickness that all parts have, write it after `%`:
    /// `%Shape default -20 20`. If the part is meant to be hidden, leave it as it is. The fix is not offered for copies
    /// (`-s`, `-d`), which need their depths.
    Buried = "H412", "depth hides or detaches a part";
    /// An arm is one rigid piece, because it is too short to bend inside or its string says `Bend 0`. So it is always stretched, while
    /// the motion bends the elbow most of the time. In half of its
    /// frames, the hand is more than a quarter of the arm's length away from where it should be.
    ///
    /// ```text
    /// Rarm@Ubody$Bend 0
    /// ```
    ///
    /// Let the arm bend, with `Bend 1`. Or split it into two shapes at the elbow, the second attached to the first:
    /// `Rarm@Ubody` and `Rforearm@Rarm`. Or leave it as it is.
    BentArm = "H413", "arm in one piece where the motion bends the elbow";
    /// The drawing has no string, but words that could be names of its parts. They are read as names only if every text of
    /// the drawing is a single word, no word is there twice, and each lies on its shape or at most one letter beside it, or is
    /// grouped with it.
    ///
    /// ```text
    /// the words Head, Arm and Leg, and a sentence about the figure
    /// ```
    ///
    /// Put `#` before every text that is no name, and move the words onto their shapes. Or write one string with a sign, such as
    /// `Head@Body`: then all texts are read.
    UnreadNames = "H414", "words that may be names are not read";
    /// A figure with arms or legs is taller than 4 m or smaller than 0.3 m, and no string says `Scale`. A drawing unit is
    /// one centimetre, and drawing programs write millimetres, points or pixels, so that a knight of 1,050 pixels becomes 10.5 m tall.
    ///
    /// ```text
    /// a figure 1,050 units tall, with a part `Rarm`
    /// ```
    ///
    /// Write `%Scale 0.16`, or accept the fix, which computes the number for 1.7 m. `%Scale 1` says that the size is meant.
    UnusualSize = "H415", "a figure of an unusual size";
    /// Lines without a fill are not built: they neither lie on a shape nor begin on one, so they are taken for guides. Those
    /// that are not wider than a 300th of the page are guides without a hint.
    ///
    /// ```text
    /// a line that crosses the page, in a drawing with strings
    /// ```
    ///
    /// Write `%Strokes lines` to build them, or `%Strokes none` to do without all lines.
    LinesLeftOut = "H416", "lines left out";
    /// No string says `Shape`, so the drawing is built as a toy at first: shapes whose outline is more than half curves are
    /// inflated, lines become tubes, the others are plates, and outlines are built. Of thousands of shapes only the largest are
    /// rounded. As soon as any string says `Shape`, all shapes that say nothing are plates, and outlines are left out.
    ///
    /// ```text
    /// a round head on a square body, with the names Head and Body
    /// ```
    ///
    /// Leave it as it is, or choose: `%Shape default` makes plates of all shapes, `%Shape inflate` inflates all, and
    /// `%Strokes lines` leaves outlines out. One shape gets its own by its string: `Head$Shape round`.
    FirstLook = "H417", "no string says `Shape`";
    /// The texts of a drawing look like names of parts or like strings, but make no sense together: there are more than shapes, two
    /// are the same, or a parent is not in the drawing. None has a keyword, and most name nothing that figures have. So they are taken
    /// for lettering, as the pins of a chip, a price or an address, and the drawing is built without strings.
    ///
    /// ```text
    /// the words GND, VCC and P$1 beside the only shape
    /// ```
    ///
    /// Leave it as it is if the texts are lettering. If they name parts, write a text with a keyword too, such as `%Scale 1`: then all
    /// texts are read as strings, and what is wrong with each is reported.
    Lettering = "H418", "texts are taken as lettering";
    /// The foot of a prop, the middle of its lowest edge, is drawn on water: it floats, with its foot at the water's level.
    ///
    /// ```text
    /// Boats$Stand, with a boat on the sea
    /// ```
    ///
    /// Leave it as it is if it floats: a boat, a lily. Move a tree onto its shore.
    Floats = "H419", "prop on water";
}

impl Code {
    /// The severity, given by the code's letter.
    pub fn severity(self) -> Severity {
        match self.id().as_bytes()[0] {
            b'E' => Severity::Error,
            b'W' => Severity::Warning,
            _ => Severity::Hint,
        }
    }

    /// The code printed as `id`, ignoring case.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|code| code.id().eq_ignore_ascii_case(id))
    }
}
