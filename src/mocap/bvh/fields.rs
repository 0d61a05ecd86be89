//! The fields of a joint: OFFSET and CHANNELS.

use glam::DVec3;

use crate::mocap::{Axis, Channel};

use super::MAX_CHANNELS;
use super::error::{Error, quoted};
use super::hierarchy::{HierarchyParser, limit, unexpected};
use super::number::{explain, parse_word};
use super::tokens::{Line, Token};

/// The channels, by their names in the file.
pub(super) const CHANNELS: [(&str, Channel); 6] = [
    ("Xposition", Channel::Position(Axis::X)),
    ("Yposition", Channel::Position(Axis::Y)),
    ("Zposition", Channel::Position(Axis::Z)),
    ("Xrotation", Channel::Rotation(Axis::X)),
    ("Yrotation", Channel::Rotation(Axis::Y)),
    ("Zrotation", Channel::Rotation(Axis::Z)),
];

/// The words that can follow the channels of a joint.
const FIELDS: [&str; 4] = ["JOINT", "End", "OFFSET", "ROOT"];

impl HierarchyParser {
    pub(super) fn offset(&mut self, line: &mut Line<'_>, keyword: Token<'_>) -> Result<(), Error> {
        let mut offset = DVec3::ZERO;
        for axis in 0..3 {
            let Some(word) = line.tokens.peek().filter(Token::is_word) else {
                let message = format!("OFFSET has {axis} numbers, but it takes 3");
                return Err(line.error(line.tokens.at, message, "write OFFSET with x, y and z"));
            };
            line.tokens.next();
            offset[axis] = parse_word(word.text).ok_or_else(|| {
                let (message, help) = explain(word.text);
                line.error(word.at, message, help)
            })?;
        }
        let Some(open) = self.open.last_mut() else {
            return Err(unexpected(line, keyword));
        };
        match open.offset {
            None => open.offset = Some(offset),
            Some(before) if before == offset => {
                line.note("a second OFFSET with the same numbers: ignored");
            }
            Some(_) => {
                let help =
                    "A joint has one OFFSET. Is the beginning of a joint missing before this one?";
                return Err(line.error(keyword.at, "a second OFFSET, unlike the first", help));
            }
        }
        Ok(())
    }

    pub(super) fn channels(
        &mut self,
        line: &mut Line<'_>,
        keyword: Token<'_>,
    ) -> Result<(), Error> {
        let count = line.tokens.next().filter(Token::is_word);
        let stated =
            count.and_then(|word| std::str::from_utf8(word.text).ok()?.parse::<usize>().ok());
        let Some(stated) = stated else {
            let at = count.map_or(line.tokens.at, |word| word.at);
            let help = "CHANNELS is followed by their number and their names";
            return Err(line.error(at, "CHANNELS has no count", help));
        };
        let mut channels = Vec::new();
        while let Some(word) = line.tokens.peek().filter(Token::is_word) {
            let known = CHANNELS.iter().find(|(name, _)| word.is(name));
            // Line breaks are spaces to some programs: the next field may be on the same line.
            if known.is_none()
                && channels.len() == stated
                && FIELDS.iter().any(|name| word.is(name))
            {
                break;
            }
            line.tokens.next();
            let Some((_, channel)) = known else {
                let message = format!("{} is not a channel", quoted(word.text));
                let help = "the channels are Xposition, Yposition, Zposition, Xrotation, Yrotation and Zrotation";
                return Err(line.error(word.at, message, help));
            };
            channels.push(*channel);
        }
        if channels.len() != stated {
            let message = format!("CHANNELS says {stated}, but {} follow", channels.len());
            let help = "correct the count or the names; a frame has one number for each of them";
            return Err(line.error(count.map_or(keyword.at, |word| word.at), message, help));
        }
        let Some(open) = self.open.last_mut() else {
            return Err(unexpected(line, keyword));
        };
        let Some(joint) = self.skeleton.joints.get_mut(open.joint) else {
            return Ok(());
        };
        if open.end {
            if channels.is_empty() {
                return Ok(());
            }
            let help = "only joints have channels; make it a JOINT, or remove the line";
            return Err(line.error(keyword.at, "CHANNELS in an `End Site`", help));
        }
        if open.channels {
            if joint.channels == channels {
                line.note("a second CHANNELS with the same names: ignored");
                return Ok(());
            }
            let help = "A joint has one line of CHANNELS. Is the beginning of a joint missing before this one?";
            return Err(line.error(keyword.at, "second CHANNELS, unlike the first", help));
        }
        self.width += channels.len();
        if self.width > MAX_CHANNELS {
            return Err(limit(line, keyword, "numbers in a frame", MAX_CHANNELS));
        }
        open.channels = true;
        joint.channels = channels;
        Ok(())
    }
}
