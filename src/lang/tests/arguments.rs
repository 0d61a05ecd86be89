//! The exact diagnostics about keywords, words and arguments.

use super::check;

#[test]
fn e101_unknown_keyword() {
    check(
        "Rarm@Ubody$Colr 1 0 0 Shape roundv",
        r#"
            Rarm@Ubody$Colr 1 0 0 Shape roundv
                       ^^^^ E101: `Colr` is not a keyword (did you mean `Color`?)
              fix: Write `Color` -> Rarm@Ubody$Color 1 0 0 Shape roundv
        "#,
    );
    check(
        "Rarm@Ubody$Shape default 0 20 Colr 1 0 0 Offset 2",
        r#"
            Rarm@Ubody$Shape default 0 20 Colr 1 0 0 Offset 2
                                          ^^^^ E101: `Colr` is not a keyword (did you mean `Color`?)
              fix: Write `Color` -> Rarm@Ubody$Shape default 0 20 Color 1 0 0 Offset 2
        "#,
    );
    check(
        "Rarm@Ubody$Shape round Colr 1 0 0 Shpe round",
        r#"
            Rarm@Ubody$Shape round Colr 1 0 0 Shpe round
                                   ^^^^ E101: `Colr` is not a keyword (did you mean `Color`?)
              fix: Write `Color` -> Rarm@Ubody$Shape round Color 1 0 0 Shpe round
                                              ^^^^ E101: `Shpe` is not a keyword (did you mean `Shape`?)
              fix: Write `Shape` -> Rarm@Ubody$Shape round Colr 1 0 0 Shape round
        "#,
    );
    check(
        "Arm$Follow Rarm Colr 1 0 0",
        r#"
            Arm$Follow Rarm Colr 1 0 0
                            ^^^^ E101: `Colr` is not a keyword (did you mean `Color`?)
              fix: Write `Color` -> Arm$Follow Rarm Color 1 0 0
        "#,
    );
    check(
        "Arm$roundv",
        r#"
            Arm$roundv
                ^^^^^^ E101: `roundv` is not a keyword (this is a value for `Shape`)
              fix: Write `Shape roundv` -> Arm$Shape roundv
        "#,
    );
    check(
        "Arm$red",
        r#"
            Arm$red
                ^^^ E101: `red` is not a keyword (this is a value for `Color`)
              fix: Write `Color red` -> Arm$Color red
        "#,
    );
    check(
        "Arm$Color=red Offset 1",
        r#"
            Arm$Color=red Offset 1
                ^^^^^^^^^ E101: `Color=red` is not a keyword (put only a space after a keyword)
              fix: Write `Color red` -> Arm$Color red Offset 1
        "#,
    );
    check(
        "Arm$5 Offset 1",
        r#"
            Arm$5 Offset 1
                ^ E101: `5` is not a keyword (a number needs a keyword before it)
        "#,
    );
    check(
        r##"Arm$Foo (Colr) cone "Shape" Offset 1"##,
        r#"
            Arm$Foo (Colr) cone "Shape" Offset 1
                ^^^ E101: `Foo` is not a keyword (expected a keyword)
              help: `okoshi explain` lists the keywords; a name with spaces needs quotes
        "#,
    );
}

#[test]
fn e102_unknown_word() {
    check(
        "Rarm@Ubody$Shape roundw -90 90 Offset 3",
        r#"
            Rarm@Ubody$Shape roundw -90 90 Offset 3
                             ^^^^^^ E102: `roundw` is not a kind of `Shape` (did you mean `roundv`?)
              fix: Write `roundv` -> Rarm@Ubody$Shape roundv -90 90 Offset 3
        "#,
    );
    check(
        "Arm$Color orang",
        r#"
            Arm$Color orang
                      ^^^^^ E102: `orang` is not a colour (did you mean `orange`?)
              fix: Write `orange` -> Arm$Color orange
        "#,
    );
    check(
        "%Bind centre",
        r#"
            %Bind centre
                  ^^^^^^ E102: `centre` is not a value for `Bind` (did you mean `center`?)
              fix: Write `center` -> %Bind center
        "#,
    );
    check(
        "%Axes -x +y z",
        r#"
            %Axes -x +y z
                        ^ E102: `z` is not a value for `Axes` (did you mean `+z`?)
              fix: Write `+z` -> %Axes -x +y +z
        "#,
    );
    check(
        "$Tile pink",
        r#"
            $Tile pink
                  ^^^^ E102: `pink` is not a value for `Tile`
              help: write one of `green`, `brown`, `blue`, `red`, `beige`, `none`
        "#,
    );
    check(
        "Arm$Offset (sqr(2))",
        r#"
            Arm$Offset (sqr(2))
                        ^^^ E102: `sqr` is not a function (did you mean `sqrt`?)
              help: the functions are `min`, `max`, `abs`, `sqrt`, `sin`, `cos`
              fix: Write `sqrt` -> Arm$Offset (sqrt(2))
        "#,
    );
}

#[test]
fn e103_argument_count() {
    check(
        "Arm$Offset 1 2",
        r#"
            Arm$Offset 1 2
                         ^ E103: `Offset` has too many arguments (one too many)
              help: write `Offset d`
        "#,
    );
    check(
        "Arm$Shape roundv 5",
        r#"
            Arm$Shape roundv 5
                      ^^^^^^^^ E103: `roundv` has too few arguments (`a1` is missing)
              help: write `Shape roundv [a0 a1]`
        "#,
    );
    check(
        "Arm$Color 1 0",
        r#"
            Arm$Color 1 0
                ^^^^^^^^^ E103: `Color` has too few arguments (`b` is missing)
              help: write `Color r g b [a]`, or `Color #rrggbb[aa]`, or `Color colour`
        "#,
    );
    check(
        "Arm$Offset (sqrt(2, 3))",
        r#"
            Arm$Offset (sqrt(2, 3))
                        ^^^^^^^^^^ E103: `sqrt` takes one number
              help: write `sqrt(a)`
        "#,
    );
    check(
        "Arm$Shape Offset 1",
        r#"
            Arm$Shape Offset 1
                ^^^^^ E103: `Shape` needs arguments
              help: write `Shape [-scd] kind parameters…`
        "#,
    );
    check(
        "%Let Size 5",
        r#"
            %Let Size 5
             ^^^ E103: `Let` needs arguments
              help: write `Let name value`; a variable cannot have the name of a keyword
                 ^^^^ W310: `Size` has no effect in this version (read and checked, but not supported yet)
              help: leave it in for a later version, or delete it
        "#,
    );
    check(
        r##"Lbody$Motion "walk.bvh" walk"##,
        r#"
            Lbody$Motion "walk.bvh" walk
                                    ^^^^ E103: `Walk` needs arguments
              help: write `Walk speed`; if it is a name that belongs to `Motion`, put it in quotes
              fix: Put it in quotes -> Lbody$Motion "walk.bvh" "walk"
        "#,
    );
}

#[test]
fn e104_argument_type() {
    check(
        r##"Arm$Offset "3""##,
        r#"
            Arm$Offset "3"
                       ^^^ E104: `"3"` is not what `Offset` needs here (expected a number)
              help: write `Offset d`
        "#,
    );
    check(
        "Arm$Follow Rarm 5",
        r#"
            Arm$Follow Rarm 5
                            ^ E104: `5` is not what `Follow` needs here (expected one or more names)
              help: write `Follow name…`
        "#,
    );
    check(
        "Arm$Color #12345",
        r#"
            Arm$Color #12345
                      ^^^^^^ E104: `#12345` is not a colour (expected 3, 4, 6 or 8 digits from 0 to f)
              help: write a colour as `#rrggbb`, for example `#ff8800`
        "#,
    );
    check(
        "Arm$Texture my-pic.png",
        r#"
            Arm$Texture my-pic.png
                        ^^^^^^^^^^ E104: the file name `my-pic.png` needs quotes
              help: a file name with spaces or punctuation needs quotes
              fix: Write `"my-pic.png"` -> Arm$Texture "my-pic.png"
        "#,
    );
    check(
        "Arm$Texture “pic.png”",
        r#"
            Arm$Texture “pic.png”
                        ^^^^^^^^^ E104: `“pic.png”` has typographic quotes
              help: use the straight quotation mark `"`
              fix: Write `"pic.png"` -> Arm$Texture "pic.png"
        "#,
    );
    check(
        "Arm$Offset 5px Color red",
        r#"
            Arm$Offset 5px Color red
                       ^^^ E104: `5px` is a number with a unit
              help: write numbers without units: lengths are in drawing units, angles in degrees
              fix: Write `5` -> Arm$Offset 5 Color red
        "#,
    );
    check(
        "Arm$Color 1,0,0",
        r#"
            Arm$Color 1,0,0
                      ^^^^^ E104: `1,0,0` contains a comma
              help: separate arguments with spaces, and write decimals with a point: `0.5 1 2`
              fix: Write `1 0 0` -> Arm$Color 1 0 0
        "#,
    );
    check(
        "Arm$Color 1, 0, 0",
        r#"
            Arm$Color 1, 0, 0
                      ^^ E104: `1,` contains a comma
              help: separate arguments with spaces, and write decimals with a point: `0.5 1 2`
              fix: Write `1` -> Arm$Color 1 0, 0
        "#,
    );
    check(
        "Arm$Offset 0,5",
        r#"
            Arm$Offset 0,5
                       ^^^ E104: `0,5` contains a comma
              help: separate arguments with spaces, and write decimals with a point: `0.5 1 2`
              fix: Write `0.5` -> Arm$Offset 0.5
              fix: Write `0 5` -> Arm$Offset 0 5
        "#,
    );
    check(
        "Arm$Offset −5",
        r#"
            Arm$Offset −5
                       ^^ E104: `−5` does not start with a plain minus sign
              fix: Write `-5` -> Arm$Offset -5
        "#,
    );
    check(
        "Arm$Offset 2*3",
        r#"
            Arm$Offset 2*3
                       ^^^ E104: the calculation `2*3` needs parentheses
              fix: Write `(2*3)` -> Arm$Offset (2*3)
        "#,
    );
    check(
        "Arm$Offset 2 * 3",
        r#"
            Arm$Offset 2 * 3
                         ^ E104: `*` is not an argument
              help: put calculations in parentheses, as in `(2 * 3)`
        "#,
    );
    check(
        "Arm$Shape round -c",
        r#"
            Arm$Shape round -c
                            ^^ E104: the flag `-c` must come directly after `Shape`
              help: write `Shape -c …`
        "#,
    );
    check(
        "Arm$Shape default -w 5",
        r#"
            Arm$Shape default -w 5
                              ^^ E104: `-w` is not a number (a negative variable needs parentheses)
              fix: Write `(-w)` -> Arm$Shape default (-w) 5
        "#,
    );
}

#[test]
fn e105_out_of_range() {
    check(
        "Arm$Alpha 2",
        r#"
            Arm$Alpha 2
                      ^ E105: `Alpha` cannot be 2 (expected a number from 0 to 1)
        "#,
    );
    check(
        "Arm$Segments 1.5",
        r#"
            Arm$Segments 1.5
                         ^^^ E105: `Segments` cannot be 1.5 (expected a whole number from 1 to 256)
        "#,
    );
    check(
        "Arm$Color 255 128 0",
        r#"
            Arm$Color 255 128 0
                      ^^^^^^^^^ E105: red, green and blue go from 0 to 1, not from 0 to 255
              fix: Write `#ff8000` -> Arm$Color #ff8000
        "#,
    );
    check(
        "Arm$Shape roundv 90 -90",
        r#"
            Arm$Shape roundv 90 -90
                             ^^^^^^ E105: nothing is left of a rounding from 90 to -90 degrees (expected the smaller angle first)
              fix: Swap the angles -> Arm$Shape roundv -90 90
        "#,
    );
    check(
        "Arm$Offset (2 / 0)",
        r#"
            Arm$Offset (2 / 0)
                       ^^^^^^^ E105: this calculation divides by zero
              help: change the calculation, or a variable in it, so that it has a result
        "#,
    );
    check(
        "Arm$Offset (sqrt(-1))",
        r#"
            Arm$Offset (sqrt(-1))
                       ^^^^^^^^^^ E105: this calculation takes the square root of a negative number
              help: change the calculation, or a variable in it, so that it has a result
        "#,
    );
    check(
        "Arm$Offset 1e999",
        r#"
            Arm$Offset 1e999
                       ^^^^^ E105: the number `1e999` is too large
        "#,
    );
    check(
        "%Axes +x +x +z",
        r#"
            %Axes +x +x +z
             ^^^^^^^^^^^^^ E105: `Axes` uses one axis twice
              help: use each of x, y and z once: `%Axes +x +y +z`
        "#,
    );
    check(
        "%Let w (1 / 0) Offset w",
        r#"
            %Let w (1 / 0) Offset w
                   ^^^^^^^ E105: this calculation divides by zero
              help: change the calculation, or a variable in it, so that it has a result
        "#,
    );
}

#[test]
fn performances_and_marks() {
    check(
        "Arm$Mark reed Perform \"a.json\" red 0 2.5",
        r#"
            Arm$Mark reed Perform "a.json" red 0 2.5
                     ^^^^ E102: `reed` is not a colour (did you mean `red`?)
              fix: Write `red` -> Arm$Mark red Perform "a.json" red 0 2.5
                                               ^ E105: `input-key` of `Perform` cannot be 0 (expected a whole number from 1 to 1000000)
                                                 ^^^ E105: `motion-key` of `Perform` cannot be 2.5 (expected a whole number from 1 to 1000000)
        "#,
    );
    check(
        "Arm$Perform \"a.json\" 3",
        r#"
            Arm$Perform "a.json" 3
                ^^^^^^^^^^^^^^^^^^ E103: `Perform` has too few arguments (`motion-key` is missing)
              help: write `Perform [-tecr] "file" [input-key motion-key]`, or `Perform [-tecr] "file" mark [input-key motion-key]`
        "#,
    );
    check(
        "Arm$Mark #ff8000 Perform -TC \"a.json\" \"left hand\" 3 4",
        r#"
            Arm$Mark #ff8000 Perform -TC "a.json" "left hand" 3 4
        "#,
    );
    check(
        "Arm$Mark 1 0 0",
        r#"
            Arm$Mark 1 0 0
                     ^ E104: `1` is not what `Mark` needs here (expected a CSS colour name, `orange` for example)
              help: write `Mark colour`, or `Mark #rrggbb[aa]`
        "#,
    );
}
