//! The exact warnings and hints.

use super::check;

#[test]
fn h405_full_width() {
    check(
        "Ｒａｒｍ＠Ｕｂｏｄｙ＄Ｓｈａｐｅ　ｒｏｕｎｄｖ",
        r#"
            Ｒａｒｍ＠Ｕｂｏｄｙ＄Ｓｈａｐｅ　ｒｏｕｎｄｖ
            ^^^^^^^^^^^^^^^^^^^^^^^ H405: `Ｒａｒｍ＠Ｕｂｏｄｙ＄Ｓｈａｐｅ　ｒｏｕｎｄｖ` is read as `Rarm@Ubody$Shape roundv` (full-width characters)
              help: switch the input method to half-width, or apply the fix
              fix: Write full-width characters as ASCII -> Rarm@Ubody$Shape roundv
        "#,
    );
    check(
        "右腕@胴$Shape　round（１）",
        r#"
            右腕@胴$Shape　round（１）
                      ^^^^^^^^^ H405: `（１）` is read as `(1)` (full-width characters)
              help: switch the input method to half-width, or apply the fix
              fix: Write full-width characters as ASCII -> 右腕@胴$Shape round(1)
                       ^^^^^^^^ E103: `round` has too few arguments (`a1` is missing)
              help: write `Shape round [a0 a1 [r]]`
        "#,
    );
    check(
        "＃ ＡＢＣ",
        r#"
            ＃ ＡＢＣ
            ^ H405: `＃` is read as `#` (full-width characters)
              help: switch the input method to half-width, or apply the fix
              fix: Write full-width characters as ASCII -> # ＡＢＣ
        "#,
    );
}

#[test]
fn w301_given_twice() {
    check(
        "%Scale 2 Scale 3",
        r#"
            %Scale 2 Scale 3
                     ^^^^^ W301: `Scale` is given twice (this one counts)
              see `Scale 2`: this one is ignored
              help: delete one of them
        "#,
    );
}

#[test]
fn w302_overridden() {
    check(
        "%Let a 1 Let a 2",
        r#"
            %Let a 1 Let a 2
                         ^ W302: `a` is defined again (this definition counts)
              see `a`: this one is ignored
              help: delete one of them, or give one another name
        "#,
    );
}

#[test]
fn w305_zero_thickness() {
    check(
        "Arm$Shape default 5 5",
        r#"
            Arm$Shape default 5 5
                              ^^^ W305: this `default` has no thickness
              help: write `Shape flat` for a thin sheet, or `Shape none` for no solid at all
        "#,
    );
    check(
        "Arm$Shape round -90 90 0",
        r#"
            Arm$Shape round -90 90 0
                            ^^^^^^^^ W305: this `round` has no thickness
              help: write `Shape flat` for a thin sheet, or `Shape none` for no solid at all
        "#,
    );
}

#[test]
fn w310_not_built_yet() {
    check(
        "Boy$Walk 40",
        r#"
            Boy$Walk 40
                ^^^^ W310: `Walk` has no effect in this version (read and checked, but not supported yet)
              help: leave it in for a later version, or delete it
        "#,
    );
}
