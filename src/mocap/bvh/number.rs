//! Numbers in the text: fast parsing, and explanations of what is not a number.

use super::MAX_MAGNITUDE;
use super::error::quoted;

/// Powers of ten that are exact as doubles, as many as are needed here.
const TENS: [f64; 16] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
];

/// Parses the number that begins at a byte, and returns where its word ends. `None` for a word that is not a finite number, or
/// one whose magnitude exceeds [`MAX_MAGNITUDE`].
///
/// Up to 15 digits, the digits and the power of ten are exact as doubles and their quotient is rounded once, so it is the nearest
/// double (Clinger 1990, the fast case); the standard library parses everything else. Written by hand because `fast-float2` takes
/// about 1.4 times as long for numbers like those of capture systems, and the standard library alone 2.5 times.
pub(super) fn parse_number(text: &[u8], start: usize) -> (Option<f64>, usize) {
    let mut at = start;
    let sign = text.get(at).copied();
    at += usize::from(matches!(sign, Some(b'-' | b'+')));
    let mut digits: u64 = 0;
    let first = at;
    while let Some(digit) = digit(text, at) {
        digits = digits.wrapping_mul(10).wrapping_add(digit);
        at += 1;
    }
    let (mut count, mut decimals) = (at - first, 0);
    if text.get(at) == Some(&b'.') {
        at += 1;
        let first = at;
        while let Some(digit) = digit(text, at) {
            digits = digits.wrapping_mul(10).wrapping_add(digit);
            at += 1;
        }
        decimals = at - first;
        count += decimals;
    }
    let ends = text.get(at).is_none_or(|b| is_end(*b));
    match TENS.get(decimals) {
        Some(ten) if ends && (1..=15).contains(&count) => {
            let value = digits as f64 / ten;
            let value = if sign == Some(b'-') { -value } else { value };
            ((value.abs() <= MAX_MAGNITUDE).then_some(value), at)
        }
        _ => slow(text, start),
    }
}

fn digit(text: &[u8], at: usize) -> Option<u64> {
    let digit = text.get(at)?.wrapping_sub(b'0');
    (digit < 10).then_some(u64::from(digit))
}

fn is_end(byte: u8) -> bool {
    matches!(byte, b' ' | b'\n' | b'\r' | b'\t' | 0x0B | 0x0C)
}

#[cold]
fn slow(text: &[u8], start: usize) -> (Option<f64>, usize) {
    let left = text.get(start..).unwrap_or_default();
    let long = left.iter().position(|b| is_end(*b)).unwrap_or(left.len());
    (parse_word(&left[..long]), start + long)
}

/// The number that a word spells.
pub(super) fn parse_word(word: &[u8]) -> Option<f64> {
    let value: f64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    (value.abs() <= MAX_MAGNITUDE).then_some(value)
}

/// Why a word is not a usable number, and how to fix it.
pub(super) fn explain(word: &[u8]) -> (String, &'static str) {
    let shown = quoted(word);
    let lower = word.to_ascii_lowercase();
    let bare = lower
        .strip_prefix(b"-")
        .or(lower.strip_prefix(b"+"))
        .unwrap_or(&lower);
    if bare.starts_with(b"nan") || bare.starts_with(b"inf") || bare.starts_with(b"1.#") {
        let help = "the program that wrote the file lost track of this joint: fix that frame, or cut out the frames with `nan` and `inf`";
        return (format!("{shown} is not a finite number"), help);
    }
    if word.contains(&b',') {
        let help = "numbers use a decimal point and are separated by spaces: change the number format of the program that wrote the file, or replace the commas";
        return (format!("{shown} has a comma"), help);
    }
    if std::str::from_utf8(word).is_ok_and(|word| word.parse::<f64>().is_ok()) {
        let help = "no joint is so far away or turns so often: the number is damaged";
        return (
            format!("{shown} is too large: the limit is {MAX_MAGNITUDE:e}"),
            help,
        );
    }
    let help =
        "a number was expected here; check whether a line was cut off or joined with another";
    (format!("{shown} is not a number"), help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_standard_library() {
        let mut state = 1u64;
        let mut random = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            state >> 33
        };
        for _ in 0..200_000 {
            let sign = ["", "-", "+"][random() as usize % 3];
            let (a, b) = (
                random() % 10u64.pow(random() as u32 % 10),
                random() * random(),
            );
            let long = random() as usize % 18;
            let b = format!("{b:018}");
            let text = match random() % 4 {
                0 => format!("{sign}{a}"),
                1 => format!("{sign}{a}."),
                2 => format!("{sign}.{}", &b[..long.max(1)]),
                _ => format!("{sign}{a}.{}", &b[..long]),
            };
            let ours = parse_number(text.as_bytes(), 0);
            let std: f64 = text.parse().unwrap();
            assert_eq!(ours.0.map(f64::to_bits), Some(std.to_bits()), "{text}");
            assert_eq!(ours.1, text.len());
        }
    }

    #[test]
    fn words_that_are_not_numbers_are_rejected() {
        for word in [
            "", "-", ".", "+.", "1,5", "nan", "-inf", "1e999", "1e13", "-1e13", "0x10", "1_000",
            "1.2.3", "--1", "1-",
        ] {
            assert_eq!(
                parse_number(word.as_bytes(), 0),
                (None, word.len()),
                "{word}"
            );
        }
        assert_eq!(parse_number(b"1e3 7", 0), (Some(1000.0), 3));
        assert_eq!(parse_number(b" 9.27476e-16\n", 1), (Some(9.27476e-16), 12));
        assert!(
            parse_number(b"-0", 0)
                .0
                .is_some_and(|zero| zero.is_sign_negative())
        );
        assert!(explain(b"1,5").0.contains("comma"));
        assert!(explain(b"-1.#IND").0.contains("finite"));
        assert!(explain(b"1e13").0.contains("limit is 1e12"));
    }
}
