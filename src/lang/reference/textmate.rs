//! TextMate grammars for syntax highlighting in editors.

use serde_json::{Value, json};

use crate::lang::keyword::Keyword;
use crate::lang::keyword::kinds::KINDS;
use crate::lang::keyword::vocabulary::{
    AXES, BIND, CLIPS, FROM, FUNCTIONS, GROUND, MATCH, MIRROR, ORIGIN, SPEED, STROKES, TILE, TO,
};

const NOTE: &str =
    "Generated from the keyword table: OKOSHI_REWRITE=generated cargo test --test generated";

/// A number that is not part of a word.
const NUMBER: &str = r"(?<![\w.])[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![\w.])";

/// `grammar/okoshi.tmLanguage.json`: one string.
pub fn textmate() -> String {
    pretty(&json!({
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "information_for_contributors": [NOTE],
        "name": "Okoshi",
        "scopeName": "source.okoshi",
        "patterns": [{ "include": "#string" }],
        "repository": {
            "string": { "patterns": [
                { "include": "#comment" },
                { "include": "#unused" },
                { "include": "#head" },
                { "include": "#sign" },
                { "include": "#feature" },
                { "include": "#attributes" },
            ]},
            "comment": {
                "name": "comment.line.okoshi",
                "match": r"(?:^|(?<=>))\s*[#＃][^<]*",
            },
            "unused": {
                "name": "comment.block.unused.okoshi",
                "match": r"(?:^|(?<=>))\s*[*＊][^<]*",
            },
            "head": {
                // The lookahead requires a character: on an empty match, engines stop tokenizing the line.
                "match": r#"(?:^|(?<=>))\s*(?=[^\s$＄%％^()<>])("[^"<]*"|[^\s@$＠＄%％^"()<>]+)?\s*(?:([@＠])\s*("[^"<]*"|[^\s@$＠＄"()<>]+))?(?=\s*(?:[$＄<]|$))"#,
                "captures": {
                    "1": { "name": "entity.name.type.part.okoshi" },
                    "2": { "name": "keyword.operator.parent.okoshi" },
                    "3": { "name": "entity.other.inherited-class.parent.okoshi" },
                },
            },
            "sign": {
                "name": "keyword.operator.sign.okoshi",
                "match": "[$＄%％@＠]",
            },
            "feature": {
                "match": r"(\^)\s*([^\s<]+)",
                "captures": {
                    "1": { "name": "keyword.operator.sign.okoshi" },
                    "2": { "name": "entity.name.tag.feature.okoshi" },
                },
            },
            "attributes": { "patterns": [
                { "include": "#keyword" },
                { "include": "#quoted" },
                { "include": "#expression" },
                { "include": "#word" },
                { "include": "#colour" },
                { "include": "#number" },
                { "include": "#variable" },
            ]},
            "keyword": {
                "match": format!(r"(?i)(?<![\w.])({})\b(\s*-[a-z]+\b)?", keywords()),
                "captures": {
                    "1": { "name": "keyword.control.okoshi" },
                    "2": { "name": "storage.modifier.flag.okoshi" },
                },
            },
            "quoted": {
                "name": "string.quoted.double.okoshi",
                "begin": "\"",
                "end": "\"|(?=<)",
            },
            "expression": {
                "name": "meta.expression.okoshi",
                "begin": "[(（]",
                "beginCaptures": { "0": { "name": "punctuation.section.parens.begin.okoshi" } },
                "end": "[)）]|(?=<)",
                "endCaptures": { "0": { "name": "punctuation.section.parens.end.okoshi" } },
                "patterns": [
                    {
                        "name": "support.function.okoshi",
                        "match": format!(r"(?i)\b({})(?=\s*\()", functions()),
                    },
                    { "include": "#expression" },
                    { "name": "constant.numeric.okoshi", "match": r"(?<![\w.])(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![\w.])" },
                    { "name": "keyword.operator.arithmetic.okoshi", "match": "[-+*/]" },
                    { "include": "#variable" },
                ],
            },
            "word": {
                "name": "constant.language.kind.okoshi",
                "match": format!(r"(?i)(?<![\w.+-])({})(?![\w.])", words()),
            },
            "colour": {
                "name": "constant.other.color.rgb-value.okoshi",
                "match": r"#[0-9A-Fa-f]{3,8}\b",
            },
            "number": {
                "name": "constant.numeric.okoshi",
                "match": NUMBER,
            },
            "variable": {
                "name": "variable.other.okoshi",
                "match": r"(?<![\w.])[\p{L}][\p{L}\d_.]*",
            },
        },
    }))
}

/// `grammar/okoshi-injection.tmLanguage.json`: strings inside the texts and descriptions of an SVG file.
pub fn injection() -> String {
    // Only text that starts like a string is coloured; other text of the drawing is left alone.
    let like_a_string = r#"(?=\s*(?:[%$*@#^％＄＊＠＃＾]|(?:"[^"<]*"|[^\s@$＠＄"()<>]+)[@$＠＄]))"#;
    // Excluded are tags, comments, CDATA (style sheets), and text that this rule has matched already: an engine that
    // matches a rule again at the position where it has just begun stops tokenizing the line.
    let outside = "-meta.tag -comment -string -meta.embedded.okoshi";
    pretty(&json!({
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "information_for_contributors": [NOTE],
        "scopeName": "okoshi.injection",
        "injectionSelector": format!("L:text.xml {outside}, L:text.xml.svg {outside}"),
        "patterns": [{ "include": "#content" }],
        "repository": {
            "content": {
                "name": "meta.embedded.okoshi",
                "contentName": "source.okoshi",
                "begin": format!(r"(?<=>){like_a_string}"),
                // Ends at any tag, so that inner elements and comments keep XML's own colours.
                "end": "(?=<)",
                "patterns": [
                    { "include": "text.xml#entity" },
                    { "include": "source.okoshi#string" },
                ],
            },
        },
    }))
}

fn keywords() -> String {
    let names: Vec<_> = Keyword::ALL.iter().map(|keyword| keyword.name()).collect();
    longest_first(names)
}

fn functions() -> String {
    longest_first(FUNCTIONS.iter().map(|row| row.name).collect())
}

fn words() -> String {
    let choices = ORIGIN.iter().chain(&GROUND).chain(&BIND).chain(&STROKES);
    let choices = choices.chain(&TILE).chain(&CLIPS);
    let choices = choices.chain(MIRROR.iter().chain(&MATCH));
    let choices = choices.chain(FROM.iter().chain(&TO).chain(&SPEED));
    let choices = choices.map(|word| word.name);
    let mut names: Vec<_> = KINDS.iter().map(|kind| kind.name).chain(choices).collect();
    names.sort_unstable();
    names.dedup();
    let axes: Vec<_> = AXES
        .iter()
        .map(|axis| axis.name.replace('+', r"\+"))
        .collect();
    format!("{}|{}", longest_first(names), axes.join("|"))
}

/// Alternatives of a regular expression, longest first, so that no word hides a longer one.
fn longest_first(mut names: Vec<&str>) -> String {
    names.sort_by_key(|name| std::cmp::Reverse(name.len()));
    names.join("|")
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}
