//! Parses the hierarchy into a skeleton, line by line.

use glam::DVec3;

use crate::mocap::{Joint, JointId, Skeleton};

use super::error::{Error, Notes, quoted};
use super::tokens::{Token, Tokens};
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

/// The current line, for errors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    pub number: usize,
    pub text: &'a [u8],
}

impl Line<'_> {
    pub(super) fn error(self, at: usize, message: String, help: &str) -> Error {
        Error::at(self.number, self.text, at, message, help)
    }
}

impl HierarchyParser {
    /// Parses a line. At the word MOTION it returns the byte after it, and the skeleton is complete.
    pub(super) fn line(
        &mut self,
        number: usize,
        text: &[u8],
        notes: &mut Notes,
    ) -> Result<Option<usize>, Error> {
        let line = Line { number, text };
        let mut tokens = Tokens::of_hierarchy(text);
        while let Some(word) = tokens.peek() {
            if self.pending.is_some() {
                self.brace(line, word, &mut tokens, notes)?;
                continue;
            }
            tokens.next();
            if !self.begun {
                self.begin(line, word, notes)?;
            }
            if word.is("hierarchy") {
                if !self.skeleton.joints.is_empty() {
                    return Err(unexpected(line, word));
                }
            } else if word.is("root") || word.is("joint") {
                self.name(line, word, &mut tokens, notes)?;
            } else if word.is("end") {
                tokens.until_brace();
                if self.open.last().is_none_or(|open| open.end) {
                    let help = "`End Site` belongs inside the braces of its joint";
                    return Err(line.error(
                        word.at,
                        "`End Site` is not within a joint".to_owned(),
                        help,
                    ));
                }
                self.pending = Some(PendingBlock::End);
            } else if word.is("}") {
                self.close(line, word, notes)?;
            } else if word.is("offset") {
                self.offset(line, word, &mut tokens, notes)?;
            } else if word.is("channels") {
                self.channels(line, word, &mut tokens, notes)?;
            } else if word.is("motion") {
                self.end(line, word)?;
                return Ok(Some(tokens.at));
            } else {
                return Err(unexpected(line, word));
            }
        }
        Ok(None)
    }

    /// The skeleton, after MOTION.
    pub(super) fn skeleton(self) -> Skeleton {
        self.skeleton
    }

    fn begin(&mut self, line: Line<'_>, word: Token<'_>, notes: &mut Notes) -> Result<(), Error> {
        self.begun = true;
        if word.is("hierarchy") {
            return Ok(());
        }
        if word.is("root") {
            notes.add(line.number, "HIERARCHY is missing before ROOT: ignored");
            return Ok(());
        }
        let wide = line.text.starts_with(b"\xFF\xFE") || line.text.starts_with(b"\xFE\xFF");
        let message = format!(
            "a BVH file begins with HIERARCHY, not with {}",
            quoted(word.text)
        );
        Err(if wide {
            let help = "save the file as UTF-8, or plain ASCII";
            line.error(
                word.at,
                "the text is UTF-16, an encoding that BVH does not use".to_owned(),
                help,
            )
        } else {
            line.error(
                word.at,
                message,
                "check whether this is a BVH file, and whether its beginning is missing",
            )
        })
    }

    fn name(
        &mut self,
        line: Line<'_>,
        keyword: Token<'_>,
        tokens: &mut Tokens<'_>,
        notes: &mut Notes,
    ) -> Result<(), Error> {
        if self.open.last().is_some_and(|open| open.end) {
            let help =
                "A joint belongs inside the braces of its parent. Is a `}` missing before it?";
            return Err(line.error(keyword.at, "a joint within an `End Site`".to_owned(), help));
        }
        if keyword.is("root") && !self.open.is_empty() {
            notes.add(line.number, "ROOT within a joint: taken as JOINT");
        } else if keyword.is("joint") && self.open.is_empty() {
            notes.add(line.number, "JOINT at the top level: taken as ROOT");
        }
        let name = joint_name(line, tokens.until_brace(), notes)?;
        self.pending = Some(PendingBlock::Joint(name));
        Ok(())
    }

    /// Expects the brace of a named block; the name may be on a line of its own.
    fn brace(
        &mut self,
        line: Line<'_>,
        word: Token<'_>,
        tokens: &mut Tokens<'_>,
        notes: &mut Notes,
    ) -> Result<(), Error> {
        if let Some(PendingBlock::Joint(name)) = &mut self.pending
            && name.is_empty()
            && !KEYWORDS.iter().any(|keyword| word.is(keyword))
        {
            *name = joint_name(line, tokens.until_brace(), notes)?;
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
        tokens.next();
        let above = self.open.last().map(|open| open.joint);
        let (joint, end) = match self.pending.take() {
            Some(PendingBlock::Joint(name)) => (self.add(line, word, name, above, notes)?, false),
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
        line: Line<'_>,
        word: Token<'_>,
        mut name: String,
        parent: Option<JointId>,
        notes: &mut Notes,
    ) -> Result<JointId, Error> {
        if self.skeleton.joints.len() == MAX_JOINTS {
            return Err(limit(line, word, "joints", MAX_JOINTS));
        }
        if name.is_empty() {
            name = made_name(self.skeleton.joints.next_key());
            notes.add(line.number, format!("a joint has no name: called `{name}`"));
        }
        let joint = self.skeleton.joints.push_and_get_key(Joint {
            name,
            parent,
            ..Joint::default()
        });
        Ok(joint)
    }

    fn close(&mut self, line: Line<'_>, word: Token<'_>, notes: &mut Notes) -> Result<(), Error> {
        let Some(open) = self.open.pop() else {
            let help = "there are more `}` than `{` before this place: one of them is a duplicate, or a `{` or a joint is missing";
            return Err(line.error(word.at, "`}` closes nothing".to_owned(), help));
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
            notes.add(
                open.line,
                format!("{what} {name} has no OFFSET: taken as 0 0 0"),
            );
        }
        if !open.end && !open.channels {
            notes.add(
                open.line,
                format!("joint {name} has no CHANNELS: it does not move by itself"),
            );
        }
        Ok(())
    }

    fn end(&mut self, line: Line<'_>, word: Token<'_>) -> Result<(), Error> {
        if let Some(open) = self.open.last() {
            let name = self
                .skeleton
                .joints
                .get(open.joint)
                .map_or("", |joint| &joint.name);
            let name = quoted(name.as_bytes());
            let message = format!("MOTION, but {name} of line {} is still open", open.line);
            let help = "a `}` is missing somewhere before this place; without it the hierarchy of the joints is unknown";
            return Err(line.error(word.at, message, help));
        }
        if self.skeleton.joints.is_empty() {
            let help = "check whether the hierarchy is in the file";
            return Err(line.error(word.at, "MOTION, but there is no joint".to_owned(), help));
        }
        Ok(())
    }
}

pub(super) fn limit(line: Line<'_>, word: Token<'_>, what: &str, most: usize) -> Error {
    let message = format!("more than {most} {what}, which is the limit");
    line.error(
        word.at,
        message,
        "no figure needs so many: check whether the file is damaged",
    )
}

pub(super) fn unexpected(line: Line<'_>, word: Token<'_>) -> Error {
    let message = format!("{} is not expected here", quoted(word.text));
    let help = "a hierarchy is made of ROOT, JOINT and End Site, each with `{`, OFFSET, CHANNELS and `}`, and ends with MOTION";
    line.error(word.at, message, help)
}

fn joint_name(line: Line<'_>, word: Token<'_>, notes: &mut Notes) -> Result<String, Error> {
    if word.text.len() > MAX_NAME_BYTES {
        let message =
            format!("the joint's name is longer than {MAX_NAME_BYTES} bytes, which is the limit");
        return Err(line.error(word.at, message, "check whether a line end is missing"));
    }
    let name: String = match std::str::from_utf8(word.text) {
        Ok(name) => name.to_owned(),
        Err(_) => {
            notes.add(
                line.number,
                format!(
                    "the name {} is not UTF-8: taken as Latin-1",
                    quoted(word.text)
                ),
            );
            word.text.iter().map(|b| char::from(*b)).collect()
        }
    };
    if !name.contains(char::is_control) {
        return Ok(name);
    }
    notes.add(
        line.number,
        format!(
            "control characters in the name {}: taken as _",
            quoted(word.text)
        ),
    );
    Ok(name.replace(char::is_control, "_"))
}
