//! The exact diagnostics about signs, names and whole strings.

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
                        ^ E107: this `)` has no matching `(`
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
                       ^^^^ E108: there is no variable called `wdth` (expected a number)
              help: write a number, or define the variable in a `%` string: `%Let wdth 10`
        "#,
    );
    check(
        "%Let thick 5 Offset thikc",
        r#"
            %Let thick 5 Offset thikc
                                ^^^^^ E108: there is no variable called `thikc` (did you mean `thick`?)
              fix: Write `thick` -> %Let thick 5 Offset thick
        "#,
    );
    check(
        "%Let a (b + 1)",
        r#"
            %Let a (b + 1)
                    ^ E108: there is no variable called `b` (expected a number)
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
              help: give one of these variables a plain number
        "#,
    );
    check(
        "%Let a a",
        r#"
            %Let a a
                 ^ E109: the value of `a` depends on itself (a → a)
              help: give one of these variables a plain number
        "#,
    );
}

#[test]
fn e110_not_allowed_here() {
    check(
        "Arm$Scale 2",
        r#"
            Arm$Scale 2
                ^^^^^ E110: `Scale` is not allowed in a part string
              help: `Scale` is allowed in `%` strings only, because it applies to the whole drawing
        "#,
    );
    check(
        "Arm$Tile green Offset 1",
        r#"
            Arm$Tile green Offset 1
                ^^^^ E110: `Tile` is not allowed in a part string
              help: `Tile` is allowed in legends only (`$ …`, a text beside a sample of the paint)
        "#,
    );
    check(
        "$Let w 2",
        r#"
            $Let w 2
             ^^^ E110: `Let` is not allowed in a legend
              help: `Let` is allowed in `%` strings only, because it applies to the whole drawing
        "#,
    );
}

#[test]
fn e111_no_name() {
    check(
        "@Body$Shape round",
        r#"
            @Body$Shape round
            ^ E111: this string does not name its part (expected a name)
              help: write `Name@Parent$ attributes`; a name with spaces needs quotes
        "#,
    );
    check(
        "Rarm@$Shape round",
        r#"
            Rarm@$Shape round
                ^ E111: there is no parent's name after `@` (expected a name)
              help: write `Name@Parent$ attributes`; a name with spaces needs quotes
        "#,
    );
    check(
        "^",
        r#"
            ^
            ^ E111: a feature point needs a name after `^` (expected a name)
              help: write `Name@Parent$ attributes`; a name with spaces needs quotes
        "#,
    );
}

#[test]
fn e112_unexpected_sign() {
    check(
        "Rarm@Ubody$Shape round$Shape default 0 20 Color 0.0 0.0 1.0v -90 90",
        r#"
            Rarm@Ubody$Shape round$Shape default 0 20 Color 0.0 0.0 1.0v -90 90
                                  ^ E112: `$` is not allowed here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and paste it into a text of its own
                                                                    ^^^^ E104: `1.0v` is neither a number nor a word
              help: put a space between numbers and words, and quotes around text with punctuation
        "#,
    );
    check(
        "Arm$Shape round Larm@Ubody$Shape round",
        r#"
            Arm$Shape round Larm@Ubody$Shape round
                                ^ E112: `@` is not allowed here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and paste it into a text of its own
        "#,
    );
    check(
        "Arm$$Offset 1",
        r#"
            Arm$$Offset 1
                ^ E112: `$` is not allowed here (the sign was typed twice)
              fix: Delete the second sign -> Arm$Offset 1
        "#,
    );
    check(
        "Arm@Body@Leg$Offset 1",
        r#"
            Arm@Body@Leg$Offset 1
                    ^ E112: `@` is not allowed here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and paste it into a text of its own
        "#,
    );
    check(
        "Arm$Offset 1%Scale 2",
        r#"
            Arm$Offset 1%Scale 2
                        ^ E112: `%` is not allowed here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and paste it into a text of its own
        "#,
    );
    check(
        "%Scale 2 *Unuse",
        r#"
            %Scale 2 *Unuse
                     ^ E112: `*` is not allowed here (a new string seems to begin here)
              help: two strings seem to have been typed into one text: cut the second one out and paste it into a text of its own
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
              help: its flags are: `-s` a second, mirrored copy on the other side of the drawing plane that moves with the first; `-c` the part turns about its centre, short for `Origin center`; `-d` a second, mirrored copy that moves independently, with copies of all attached parts
        "#,
    );
}

#[test]
fn e114_bad_expression() {
    check(
        "Arm$Offset (1 + )",
        r#"
            Arm$Offset (1 + )
                            ^ E114: `(1 + )` is not a valid calculation (expected a number or a variable)
        "#,
    );
    check(
        "Arm$Offset (1 2)",
        r#"
            Arm$Offset (1 2)
                          ^ E114: `(1 2)` is not a valid calculation (expected an operator: `+`, `-`, `*` or `/`)
        "#,
    );
    check(
        "Arm$Offset (2w)",
        r#"
            Arm$Offset (2w)
                        ^^ E114: `(2w)` is not a valid calculation (letters directly after a number: put a space or an operator between them)
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
                        ^ E114: `()` is not a valid calculation (expected a number or a variable)
        "#,
    );
}

#[test]
fn e115_unquoted_name() {
    check(
        "Left arm@Body$Shape round",
        r#"
            Left arm@Body$Shape round
            ^^^^^^^^ E115: the name `Left arm` needs quotes (a name with spaces or parentheses needs quotes)
              fix: Put the name in quotes -> "Left arm"@Body$Shape round
        "#,
    );
    check(
        "Arm@Upper body",
        r#"
            Arm@Upper body
                ^^^^^^^^^^ E115: the name `Upper body` needs quotes (a name with spaces or parentheses needs quotes)
              fix: Put the name in quotes -> Arm@"Upper body"
        "#,
    );
    check(
        r##""Left" arm@Body"##,
        r#"
            "Left" arm@Body
                   ^^^ E115: `arm` follows the closing quote of a name (put the whole name inside the quotes)
        "#,
    );
}

#[test]
fn e116_missing_sign() {
    check(
        "Rarm@Ubody Shape roundv",
        r#"
            Rarm@Ubody Shape roundv
                       ^^^^^ E116: `$` is missing before `Shape` (attributes come after `$`)
              fix: Insert `$` -> Rarm@Ubody $Shape roundv
        "#,
    );
    check(
        r##""Left arm" Shape$Color red"##,
        r#"
            "Left arm" Shape$Color red
                       ^^^^^ E103: `Shape` needs arguments
              help: write `Shape [-scd] kind parameters…`
                       ^^^^^ E116: `$` is missing before `Shape` (attributes come after `$`)
              fix: Insert `$` -> "Left arm" $Shape$Color red
        "#,
    );
}

#[test]
fn read_without_diagnostics() {
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
