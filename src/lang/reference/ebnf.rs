//! The grammar as EBNF.

use std::fmt::Write as _;

use crate::lang::keyword::kinds::KINDS;
use crate::lang::keyword::signature::{Form, Parameter, Takes};
use crate::lang::keyword::vocabulary::FUNCTIONS;
use crate::lang::keyword::{Allowed, Keyword};

/// `grammar/okoshi.ebnf`: the grammar of a string.
pub fn ebnf() -> String {
    let mut out = String::from(include_str!("head.ebnf"));
    rule(&mut out, "attribute", &mentions(|_| true));
    out.push('\n');
    for keyword in Keyword::ALL {
        let row = keyword.row();
        let mut head = format!("\"{}\"", keyword.name());
        if !row.flags.is_empty() {
            let letters: Vec<_> = row
                .flags
                .iter()
                .map(|flag| format!("\"{}\"", flag.letter))
                .collect();
            let letters = letters.join(" | ");
            let _ = write!(head, " [ \"-\" ( {letters} ) {{ {letters} }} ]");
        }
        let forms: Vec<_> = row.forms.iter().map(print).collect();
        let arguments = match forms.as_slice() {
            [form] => form.clone(),
            forms => format!("( {} )", forms.join(" | ")),
        };
        let body = format!("{head} {arguments}");
        let _ = writeln!(out, "{:<10} = {} ;", rule_name(*keyword), body.trim_end());
    }
    let of = |allowed: Allowed| mentions(|keyword| keyword.row().allowed == allowed);
    let _ = writeln!(
        out,
        "\n(* only in defaults: {} *)\n(* only in legends: {} *)\n",
        of(Allowed::Drawing).join(", "),
        of(Allowed::Legend).join(", ")
    );
    let kinds: Vec<_> = KINDS
        .iter()
        .map(|kind| {
            format!("\"{}\" {}", kind.name, print(&kind.form))
                .trim_end()
                .to_owned()
        })
        .collect();
    rule(&mut out, "kind", &kinds);
    let functions: Vec<_> = FUNCTIONS
        .iter()
        .map(|row| format!("\"{}\"", row.name))
        .collect();
    rule(&mut out, "function", &functions);
    out
}

fn rule(out: &mut String, name: &str, alternatives: &[String]) {
    let _ = writeln!(
        out,
        "{name:<10} = {} ;",
        alternatives.join("\n           | ")
    );
}

fn mentions(which: impl Fn(&Keyword) -> bool) -> Vec<String> {
    let keywords = Keyword::ALL.iter().filter(|keyword| which(keyword));
    keywords.map(|keyword| rule_name(*keyword)).collect()
}

fn rule_name(keyword: Keyword) -> String {
    keyword.name().to_ascii_lowercase()
}

fn print(form: &Form) -> String {
    let once = form.print_with(term, ["[ ", " ]"]);
    if form.repeats {
        format!("{once} {{ {once} }}")
    } else {
        once
    }
}

fn term(parameter: &Parameter) -> String {
    match &parameter.takes {
        Takes::Number(_) => "value".to_owned(),
        Takes::Choice(words) => {
            let words: Vec<_> = words
                .iter()
                .map(|word| format!("\"{}\"", word.name))
                .collect();
            format!("( {} )", words.join(" | "))
        }
        Takes::Hex => "hex".to_owned(),
        Takes::ColorName | Takes::Variable => "word".to_owned(),
        Takes::Kind => "kind".to_owned(),
        Takes::SignedAxis => "( \"+\" | \"-\" ) ( \"x\" | \"y\" | \"z\" )".to_owned(),
        Takes::File | Takes::Text => "( word | quoted )".to_owned(),
        Takes::Names => "( word | quoted ) { word | quoted }".to_owned(),
    }
}
