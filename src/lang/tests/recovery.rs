//! What is said about signs, names and strings as a whole, to the letter.

use super::check;

#[test]
fn e106_unclosed_quote() {
    check(
        r##"Arm$Texture "kick.png Offset 2"##,
        r#"
            Arm$Texture "kick.png Offset 2
                        ^ E106: this quote is never closed
              fix: Close the quote -> Arm$Texture "kick.png" Offset 2
        "#,
    );
    check(
        r##""Left arm@Body$Shape round"##,
        r#"
            "Left arm@Body$Shape round
            ^ E106: this quote is never closed
              fix: Close the quote -> "Left arm"@Body$Shape round
        "#,
    );
}

#[test]
fn e107_unclosed_parenthesis() {
    check(
        "Arm$Offset (1 + 2 Color red",
        r#"
            Arm$Offset (1 + 2 Color red
                       ^ E107: this parenthesis is never closed
              fix: Close it -> Arm$Offset (1 + 2) Color red
        "#,
    );
    check(
        "Arm$Offset 1) Color red",
        r#"
            Arm$Offset 1) Color red
                        ^ E107: this `)` closes nothing: `(` is missing
              fix: Delete it -> Arm$Offset 1 Color red
        "#,
    );
    check(
        "Arm$Shape default (1 + 2 5 Offset (3",
        r#"
            Arm$Shape default (1 + 2 5 Offset (3
                              ^ E107: this parenthesis is never closed
              fix: Close it -> Arm$Shape default (1 + 2) 5 Offset (3
                                              ^ E107: this parenthesis is never closed
              fix: Close it -> Arm$Shape default (1 + 2 5 Offset (3)
        "#,
    );
}

#[test]
fn e108_unknown_variable() {
    check(
        "Arm$Offset wdth",
        r#"
            Arm$Offset wdth
                       ^^^^ E108: no variable is called `wdth` (a number is due here)
              help: write a number, or define the variable in a `%` string: `%Let wdth 10`
        "#,
    );
    check(
        "%Let thick 5 Offset thikc",
        r#"
            %Let thick 5 Offset thikc
                                ^^^^^ E108: no variable is called `thikc` (did you mean `thick`?)
              fix: Write `thick` -> %Let thick 5 Offset thick
        "#,
    );
    check(
        "%Let a (b + 1)",
        r#"
            %Let a (b + 1)
                    ^ E108: no variable is called `b` (a number is due here)
              help: write a number, or define the variable in a `%` string: `%Let b 10`
        "#,
    );
}

#[test]
fn e109_variable_cycle() {
    check(
        "%Let a (b) Let b (a + 1) Offset a",
        r#"
            %Let a (b) Let b (a + 1) Offset a
                 ^ E109: the value of `a` depends on itself (a → b → a)
              see `b`: through `b`
              help: give one of them a number
        "#,
    );
    check(
        "%Let a a",
        r#"
            %Let a a
                 ^ E109: the value of `a` depends on itself (a → a)
              help: give one of them a number
        "#,
    );
}

#[test]
fn e110_not_allowed_here() {
    check(
        "Arm$Scale 2",
        r#"
            Arm$Scale 2
                ^^^^^ E110: `Scale` cannot stand in a part string
              help: `Scale` stands in `%` strings only, since it is about the whole drawing
        "#,
    );
    check(
        "Arm$Tile green Offset 1",
        r#"
            Arm$Tile green Offset 1
                ^^^^ E110: `Tile` cannot stand in a part string
              help: `Tile` stands in legends only (`$ …`, a text beside a sample of the paint)
        "#,
    );
    check(
        "$Let w 2",
        r#"
            $Let w 2
             ^^^ E110: `Let` cannot stand in a legend
              help: `Let` stands in `%` strings only, since it is about the whole drawing
        "#,
    );
}

#[test]
fn e111_no_name() {
    check(
        "@Body$Shape round",
        r#"
            @Body$Shape round
            ^ E111: this string does not name its part (a name is due here)
              help: write `Name@Parent$ attributes`; a name with spaces stands in quotes
        "#,
    );
    check(
        "Rarm@$Shape round",
        r#"
            Rarm@$Shape round
                ^ E111: no parent is named behind `@` (a name is due here)
              help: write `Name@Parent$ attributes`; a name with spaces stands in quotes
        "#,
    );
    check(
        "^",
        r#"
            ^
            ^ E111: a feature point needs a name behind `^` (a name is due here)
              help: write `Name@Parent$ attributes`; a name with spaces stands in quotes
        "#,
    );
}

#[test]
fn e112_unexpected_sign() {
    check(
        "Rarm@Ubody$Shape round$Shape default 0 20 Color 0.0 0.0 1.0v -90 90",
        r#"
            Rarm@Ubody$Shape round$Shape default 0 20 Color 0.0 0.0 1.0v -90 90
                                  ^ E112: `$` cannot stand here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and give it a text of its own
                                                                    ^^^^ E104: `1.0v` is neither a number nor a word
              help: put a space between numbers and words, and text with signs in quotes
        "#,
    );
    check(
        "Arm$Shape round Larm@Ubody$Shape round",
        r#"
            Arm$Shape round Larm@Ubody$Shape round
                                ^ E112: `@` cannot stand here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and give it a text of its own
        "#,
    );
    check(
        "Arm$$Offset 1",
        r#"
            Arm$$Offset 1
                ^ E112: `$` cannot stand here (the sign is typed twice)
              fix: Delete the second sign -> Arm$Offset 1
        "#,
    );
    check(
        "Arm@Body@Leg$Offset 1",
        r#"
            Arm@Body@Leg$Offset 1
                    ^ E112: `@` cannot stand here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and give it a text of its own
        "#,
    );
    check(
        "Arm$Offset 1%Scale 2",
        r#"
            Arm$Offset 1%Scale 2
                        ^ E112: `%` cannot stand here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and give it a text of its own
        "#,
    );
    check(
        "%Scale 2 *Unuse",
        r#"
            %Scale 2 *Unuse
                     ^ E112: `*` cannot stand here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and give it a text of its own
        "#,
    );
}

#[test]
fn e113_unknown_flag() {
    check(
        "Arm$Offset -w",
        r#"
            Arm$Offset -w
                        ^ E113: `Offset` has no flag `-w`
              help: if `w` is a variable, write it in parentheses: `(-w)`
              fix: Write `(-w)` -> Arm$Offset (-w)
        "#,
    );
    check(
        "Arm$Shape -x round",
        r#"
            Arm$Shape -x round
                       ^ E113: `Shape` has no flag `-x`
              help: its flags are: `-s` a second, mirrored copy on the other side of the drawing plane, moving with the first; `-c` the part turns about its centre, short for `Origin center`; `-d` a second, mirrored copy that moves by itself, with all that hangs on the part
        "#,
    );
}

#[test]
fn e114_bad_expression() {
    check(
        "Arm$Offset (1 + )",
        r#"
            Arm$Offset (1 + )
                            ^ E114: `(1 + )` cannot be read as a calculation (a number or a variable is due here)
        "#,
    );
    check(
        "Arm$Offset (1 2)",
        r#"
            Arm$Offset (1 2)
                          ^ E114: `(1 2)` cannot be read as a calculation (a sign of arithmetic is due here)
        "#,
    );
    check(
        "Arm$Offset (2w)",
        r#"
            Arm$Offset (2w)
                        ^^ E114: `(2w)` cannot be read as a calculation (a number and letters in one word are neither)
        "#,
    );
    check(
        "Arm$Offset min(2, 3)",
        r#"
            Arm$Offset min(2, 3)
                       ^^^^^^^^^ E114: the calculation `min(2, 3)` needs parentheses
              fix: Put it in parentheses -> Arm$Offset (min(2, 3))
        "#,
    );
    check(
        "Arm$Offset ()",
        r#"
            Arm$Offset ()
                        ^ E114: `()` cannot be read as a calculation (a number or a variable is due here)
        "#,
    );
}

#[test]
fn e115_unquoted_name() {
    check(
        "Left arm@Body$Shape round",
        r#"
            Left arm@Body$Shape round
            ^^^^^^^^ E115: the name `Left arm` needs quotes (a name with spaces or parentheses stands in quotes)
              fix: Put the name in quotes -> "Left arm"@Body$Shape round
        "#,
    );
    check(
        "Arm@Upper body",
        r#"
            Arm@Upper body
                ^^^^^^^^^^ E115: the name `Upper body` needs quotes (a name with spaces or parentheses stands in quotes)
              fix: Put the name in quotes -> Arm@"Upper body"
        "#,
    );
    check(
        r##""Left" arm@Body"##,
        r#"
            "Left" arm@Body
                   ^^^ E115: `arm` stands behind the quotes of a name (put all of the name into the quotes)
        "#,
    );
}

#[test]
fn e116_missing_sign() {
    check(
        "Rarm@Ubody Shape roundv",
        r#"
            Rarm@Ubody Shape roundv
                       ^^^^^ E116: `$` is missing before `Shape` (attributes stand behind `$`)
              fix: Insert `$` -> Rarm@Ubody $Shape roundv
        "#,
    );
    check(
        r##""Left arm" Shape$Color red"##,
        r#"
            "Left arm" Shape$Color red
                       ^^^^^ E103: `Shape` stands here without arguments
              help: write `Shape [-scd] kind parameters…`
                       ^^^^^ E116: `$` is missing before `Shape` (attributes stand behind `$`)
              fix: Insert `$` -> "Left arm" $Shape$Color red
        "#,
    );
}

#[test]
fn faultless() {
    check(
        "Arm$shape -CD ROUNDV color ORANGE",
        r#"
            Arm$shape -CD ROUNDV color ORANGE
        "#,
    );
    check(
        r##"Arm$Follow U-1 "Left arm" mixamorig:Hips"##,
        r#"
            Arm$Follow U-1 "Left arm" mixamorig:Hips
                ^^^^^^ W310: `Follow` has no effect in this version (understood, but not built yet)
        "#,
    );
    check(
        "Arm$Offset-5",
        r#"
            Arm$Offset-5
        "#,
    );
    check(
        "Arm$Shape-c round",
        r#"
            Arm$Shape-c round
        "#,
    );
    check(
        "# Colr $$ (",
        r#"
            # Colr $$ (
        "#,
    );
    check(
        "*Unuse (",
        r#"
            *Unuse (
        "#,
    );
    check(
        "Left arm",
        r#"
            Left arm
        "#,
    );
    check(
        "Scale 2",
        r#"
            Scale 2
        "#,
    );
    check(
        "Arm",
        r#"
            Arm
        "#,
    );
    check(
        r##""Left arm""##,
        r#"
            "Left arm"
        "#,
    );
    check(
        "Arm @ Body $ Offset .5",
        r#"
            Arm @ Body $ Offset .5
        "#,
    );
    check(
        "%Let wall 5 Shape default 0 wall",
        r#"
            %Let wall 5 Shape default 0 wall
        "#,
    );
    check(
        "%Let cone 2 Shape cone 0 cone",
        r#"
            %Let cone 2 Shape cone 0 cone
        "#,
    );
    check(
        "Arm$Color #F80 Shape none",
        r#"
            Arm$Color #F80 Shape none
        "#,
    );
    check(
        r##""Left arm" Shape roundv"##,
        r#"
            "Left arm" Shape roundv
        "#,
    );
}
