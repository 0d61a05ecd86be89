//! Parses the hierarchy into a skeleton, line by line.

use glam::DVec3;

use crate::mocap::{Joint, JointId, Skeleton};

use super::error::{Error, quoted};
use super::tokens::{Line, Token};
use super::{MAX_JOINTS, MAX_NAME_BYTES};

/// The name of a joint that has none in the file.
pub(super) fn made_name(joint: JointId) -> String {
    format!("Joint{}", usize::from(joint) + 1)
}

/// The words that can begin a statement of the hierarchy, to tell a missing name from a statement.
const KEYWORDS: [&str; 9] = [
    "hierarchy",
    "root",
    "joint",
    "end",
    "offset",
    "channels",
    "motion",
    "{",
    "}",
];

/// A block between braces that is still open.
#[derive(Debug)]
pub(super) struct OpenBlock {
    /// The joint; for an end site the joint that it belongs to.
    pub joint: JointId,
    /// Whether it is an end site.
    pub end: bool,
    pub line: usize,
    pub offset: Option<DVec3>,
    /// Whether CHANNELS was read.
    pub channels: bool,
}

/// A block whose opening brace is still expected.
#[derive(Debug)]
enum PendingBlock {
    /// A joint, with its name.
    Joint(String),
    /// An end site.
    End,
}

/// The parser's state: the skeleton so far, and the open blocks.
#[derive(Debug, Default)]
pub(super) struct HierarchyParser {
    pub(super) skeleton: Skeleton,
    pub(super) open: Vec<OpenBlock>,
    pending: Option<PendingBlock>,
    begun: bool,
    pub(super) width: usize,
    ends: usize,
}

impl HierarchyParser {
    /// Parses a line. At the word MOTION it returns the byte after it, and the skeleton is complete.
    pub(super) fn line(&mut self, line: &mut Line<'_>) -> Result<Option<usize>, Error> {
        while let Some(word) = line.tokens.peek() {
            if self.pending.is_some() {
                self.brace(line, word)?;
                continue;
            }
            line.tokens.next();
            if !self.begun {
                self.begin(line, word)?;
            }
            if word.is("hierarchy") {
                if !self.skeleton.joints.is_empty() {
                    return Err(unexpected(line, word));
                }
            } else if word.is("root") || word.is("joint") {
                self.name(line, word)?;
            } else if word.is("end") {
                line.tokens.until_brace();
                if self.open.last().is_none_or(|open| open.end) {
                    let help = "`End Site` belongs inside the braces of its joint";
                    return Err(line.error(word.at, "`End Site` is not within a joint", help));
                }
                self.pending = Some(PendingBlock::End);
            } else if word.is("}") {
                self.close(line, word)?;
            } else if word.is("offset") {
                self.offset(line, word)?;
            } else if word.is("channels") {
                self.channels(line, word)?;
            } else if word.is("motion") {
                self.end(line, word)?;
                return Ok(Some(line.tokens.at));
            } else {
                return Err(unexpected(line, word));
            }
        }
        Ok(None)
    }

    fn begin(&mut self, line: &mut Line<'_>, word: Token<'_>) -> Result<(), Error> {
        self.begun = true;
        if word.is("hierarchy") {
            return Ok(());
        }
        if word.is("root") {
            line.note("HIERARCHY is missing before ROOT: ignored");
            return Ok(());
        }
        if line.text.starts_with(b"\xFF\xFE") || line.text.starts_with(b"\xFE\xFF") {
            let message = "the text is UTF-16, an encoding that BVH does not use";
            return Err(line.error(word.at, message, "save the file as UTF-8, or plain ASCII"));
        }
        let found = quoted(word.text);
        let message = format!("a BVH file begins with HIERARCHY, not with {found}");
        let help = "check whether this is a BVH file, and whether its beginning is missing";
        Err(line.error(word.at, message, help))
    }

    fn name(&mut self, line: &mut Line<'_>, keyword: Token<'_>) -> Result<(), Error> {
        if self.open.last().is_some_and(|open| open.end) {
            let help =
                "A joint belongs inside the braces of its parent. Is a `}` missing before it?";
            return Err(line.error(keyword.at, "a joint within an `End Site`", help));
        }
        if keyword.is("root") && !self.open.is_empty() {
            line.note("ROOT within a joint: taken as JOINT");
        } else if keyword.is("joint") && self.open.is_empty() {
            line.note("JOINT at the top level: taken as ROOT");
        }
        let name = joint_name(line)?;
        self.pending = Some(PendingBlock::Joint(name));
        Ok(())
    }

    /// Expects the brace of a named block; the name may be on a line of its own.
    fn brace(&mut self, line: &mut Line<'_>, word: Token<'_>) -> Result<(), Error> {
        if let Some(PendingBlock::Joint(name)) = &mut self.pending
            && name.is_empty()
            && !KEYWORDS.iter().any(|keyword| word.is(keyword))
        {
            *name = joint_name(line)?;
            return Ok(());
        }
        if !word.is("{") {
            let what = match &self.pending {
                Some(PendingBlock::Joint(name)) => format!("joint {}", quoted(name.as_bytes())),
                _ => "`End Site`".to_owned(),
            };
            let message = format!("`{{` is missing after {what}, before {}", quoted(word.text));
            return Err(line.error(word.at, message, "add the `{` on a line of its own"));
        }
        line.tokens.next();
        let above = self.open.last().map(|open| open.joint);
        let (joint, end) = match self.pending.take() {
            Some(PendingBlock::Joint(name)) => (self.add(line, word, name, above)?, false),
            _ => {
                self.ends += 1;
                if self.ends > MAX_JOINTS {
                    return Err(limit(line, word, "ends of bones", MAX_JOINTS));
                }
                (above.unwrap_or_default(), true)
            }
        };
        self.open.push(OpenBlock {
            joint,
            end,
            line: line.number,
            offset: None,
            channels: false,
        });
        Ok(())
    }

    fn add(
        &mut self,
        line: &mut Line<'_>,
        word: Token<'_>,
        mut name: String,
        parent: Option<JointId>,
    ) -> Result<JointId, Error> {
        if self.skeleton.joints.len() == MAX_JOINTS {
            return Err(limit(line, word, "joints", MAX_JOINTS));
        }
        if name.is_empty() {
            name = made_name(self.skeleton.joints.next_key());
            line.note(format!("a joint has no name: called `{name}`"));
        }
        let joint = Joint {
            name,
            parent,
            ..Joint::default()
        };
        Ok(self.skeleton.joints.push_and_get_key(joint))
    }

    fn close(&mut self, line: &mut Line<'_>, word: Token<'_>) -> Result<(), Error> {
        let Some(open) = self.open.pop() else {
            let help = "there are more `}` than `{` before this place: one of them is a duplicate, or a `{` or a joint is missing";
            return Err(line.error(word.at, "`}` closes nothing", help));
        };
        let Some(joint) = self.skeleton.joints.get_mut(open.joint) else {
            return Ok(());
        };
        if open.end {
            joint.ends.push(open.offset.unwrap_or_default());
        } else {
            joint.offset = open.offset.unwrap_or_default();
        }
        let name = quoted(joint.name.as_bytes());
        if open.offset.is_none() {
            let what = if open.end {
                "the `End Site` of"
            } else {
                "joint"
            };
            let message = format!("{what} {name} has no OFFSET: taken as 0 0 0");
            line.notes.add(open.line, message);
        }
        if !open.end && !open.channels {
            let message = format!("joint {name} has no CHANNELS: it does not move by itself");
            line.notes.add(open.line, message);
        }
        Ok(())
    }

    fn end(&self, line: &Line<'_>, word: Token<'_>) -> Result<(), Error> {
        if let Some(open) = self.open.last() {
            let joint = self.skeleton.joints.get(open.joint);
            let name = quoted(joint.map_or("", |joint| &joint.name).as_bytes());
            let message = format!("MOTION, but {name} of line {} is still open", open.line);
            let help = "a `}` is missing somewhere before this place; without it the hierarchy of the joints is unknown";
            return Err(line.error(word.at, message, help));
        }
        if self.skeleton.joints.is_empty() {
            let help = "check whether the hierarchy is in the file";
            return Err(line.error(word.at, "MOTION, but there is no joint", help));
        }
        Ok(())
    }
}

pub(super) fn limit(line: &Line<'_>, word: Token<'_>, what: &str, most: usize) -> Error {
    let message = format!("more than {most} {what}, which is the limit");
    let help = "no figure needs so many: check whether the file is damaged";
    line.error(word.at, message, help)
}

pub(super) fn unexpected(line: &Line<'_>, word: Token<'_>) -> Error {
    let message = format!("{} is not expected here", quoted(word.text));
    let help = "a hierarchy is made of ROOT, JOINT and End Site, each with `{`, OFFSET, CHANNELS and `}`, and ends with MOTION";
    line.error(word.at, message, help)
}

/// The name of a joint: the rest of the line, or what is before a brace.
fn joint_name(line: &mut Line<'_>) -> Result<String, Error> {
    let word = line.tokens.until_brace();
    if word.text.len() > MAX_NAME_BYTES {
        let message =
            format!("the joint's name is longer than {MAX_NAME_BYTES} bytes, which is the limit");
        return Err(line.error(word.at, message, "check whether a line end is missing"));
    }
    let shown = || quoted(word.text);
    let name = std::str::from_utf8(word.text).map_or_else(
        |_| {
            line.note(format!(
                "the name {} is not UTF-8: taken as Latin-1",
                shown()
            ));
            word.text.iter().map(|b| char::from(*b)).collect()
        },
        str::to_owned,
    );
    if !name.contains(char::is_control) {
        return Ok(name);
    }
    line.note(format!(
        "control characters in the name {}: taken as _",
        shown()
    ));
    Ok(name.replace(char::is_control, "_"))
}
