//! Pictures in the terminal.
//!
//! There is no safe question to ask: a terminal that does not know one prints it. So only terminals that say in their
//! environment that they show pictures get one, and none inside a multiplexer, which would have to pass it on.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// How a terminal takes a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Protocol {
    /// kitty's [graphics protocol](https://sw.kovidgoyal.net/kitty/graphics-protocol/), also Ghostty's.
    Kitty,
    /// iTerm2's [inline images](https://iterm2.com/documentation-images.html), also WezTerm's.
    Iterm,
}

/// The width of a picture in the terminal, in columns: that of the smallest usual window.
const COLUMNS: u32 = 80;

/// The most letters of base64 in one escape sequence of kitty's protocol.
const CHUNK: usize = 4096;

impl Protocol {
    /// What the terminal understands, by its environment variables; `None` if it is not known to show pictures.
    pub(super) fn of_terminal(variable: impl Fn(&str) -> Option<String>) -> Option<Self> {
        let value = |name| variable(name).unwrap_or_default();
        let (kind, program) = (value("TERM"), value("TERM_PROGRAM"));
        let multiplexed = ["TMUX", "STY", "ZELLIJ"]
            .iter()
            .any(|name| !value(name).is_empty());
        if multiplexed || kind.starts_with("screen") || kind.starts_with("tmux") {
            return None;
        }
        match (kind.as_str(), program.as_str()) {
            ("xterm-kitty" | "xterm-ghostty", _) => Some(Self::Kitty),
            (_, "iTerm.app" | "WezTerm") => Some(Self::Iterm),
            _ => None,
        }
    }

    /// The escape sequences that show a PNG, and the end of its last line.
    pub(super) fn show(self, png: &[u8]) -> String {
        let data = STANDARD.encode(png);
        let mut out = String::with_capacity(data.len() + data.len() / 64 + 128);
        match self {
            Self::Kitty => {
                let chunks = data.as_bytes().chunks(CHUNK);
                let last = chunks.len().saturating_sub(1);
                for (k, chunk) in chunks.enumerate() {
                    let keys = match k {
                        0 => format!("a=T,f=100,q=2,c={COLUMNS},"),
                        _ => String::new(),
                    };
                    let more = u8::from(k < last);
                    let chunk = String::from_utf8_lossy(chunk);
                    let _ = write!(out, "\x1b_G{keys}m={more};{chunk}\x1b\\");
                }
            }
            Self::Iterm => {
                let size = png.len();
                let _ = write!(
                    out,
                    "\x1b]1337;File=inline=1;size={size};width={COLUMNS};preserveAspectRatio=1:{data}\x07"
                );
            }
        }
        out.push('\n');
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(variables: &[(&str, &str)]) -> Option<Protocol> {
        Protocol::of_terminal(|name| {
            let found = variables.iter().find(|(key, _)| *key == name);
            found.map(|(_, value)| (*value).to_owned())
        })
    }

    #[test]
    fn only_terminals_that_say_so_show_pictures() {
        assert_eq!(of(&[("TERM", "xterm-kitty")]), Some(Protocol::Kitty));
        assert_eq!(of(&[("TERM", "xterm-ghostty")]), Some(Protocol::Kitty));
        for program in ["iTerm.app", "WezTerm"] {
            let variables = [("TERM", "xterm-256color"), ("TERM_PROGRAM", program)];
            assert_eq!(of(&variables), Some(Protocol::Iterm), "{program}");
        }
        for (term, program) in [
            ("", ""),
            ("dumb", ""),
            ("linux", ""),
            ("xterm-256color", ""),
            ("xterm-256color", "vscode"),
            ("xterm-256color", "Apple_Terminal"),
            ("tmux-256color", "iTerm.app"),
            ("screen", "WezTerm"),
        ] {
            assert_eq!(of(&[("TERM", term), ("TERM_PROGRAM", program)]), None);
        }
        for multiplexer in ["TMUX", "STY", "ZELLIJ"] {
            let variables = [("TERM", "xterm-kitty"), (multiplexer, "0")];
            assert_eq!(of(&variables), None, "{multiplexer}");
        }
    }

    /// The picture between the sequences, whatever the number of chunks.
    #[test]
    fn the_picture_arrives_whole() {
        for length in [0, 1, 3071, 3072, 3073, 3074, 20_000] {
            let png: Vec<u8> = (0..length).map(|k| (k * 7 % 251) as u8).collect();
            let shown = Protocol::Kitty.show(&png);
            let mut data = String::new();
            let parts: Vec<_> = shown.trim_end().split_terminator("\x1b\\").collect();
            for (k, part) in parts.iter().enumerate() {
                let (keys, chunk) = part.split_once(';').expect("keys");
                assert!(keys.starts_with("\x1b_G") && chunk.len() <= CHUNK);
                let more = if k + 1 < parts.len() { "m=1" } else { "m=0" };
                assert!(keys.ends_with(more), "{length}: {keys}");
                assert_eq!(keys.contains("f=100"), k == 0);
                data.push_str(chunk);
            }
            assert_eq!(STANDARD.decode(data).expect("base64"), png);
            let shown = Protocol::Iterm.show(&png);
            let (keys, data) = shown.split_once(':').expect("keys");
            assert!(keys.starts_with("\x1b]1337;File=inline=1;"), "{keys}");
            let data = data.strip_suffix("\x07\n").expect("an end");
            assert_eq!(STANDARD.decode(data).expect("base64"), png);
        }
    }
}
