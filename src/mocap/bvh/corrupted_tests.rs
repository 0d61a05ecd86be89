//! Real files, corrupted at random: reading never panics and never yields a number that is not finite.

use fastrand::Rng;

use super::tests::{FILES, bytes};
use super::*;
use crate::mocap::Clip;

/// A file in which lines or bytes were cut out, swapped, repeated or deleted.
fn damaged(text: &[u8], random: &mut Rng) -> Vec<u8> {
    let mut lines: Vec<&[u8]> = text.split_inclusive(|b| *b == b'\n').collect();
    let (line_damage, byte_damage) = match random.usize(..3) {
        0 => (1, 0),
        1 => (0, 1),
        _ => (1 + random.usize(..2), 1 + random.usize(..3)),
    };
    for _ in 0..line_damage {
        // Half of the corruption hits the hierarchy, however long the motion is.
        let reach = if random.usize(..2) == 0 {
            lines.len()
        } else {
            lines.len().min(130)
        };
        let (a, b) = (random.usize(..reach), random.usize(..reach));
        match random.usize(..6) {
            0 => lines.swap(a, b),
            1 => lines.insert(a, lines[b]),
            2 => drop(lines.remove(a)),
            3 => lines.truncate(a),
            4 => drop(lines.drain(a.min(b)..a.max(b))),
            _ => {}
        }
        if lines.is_empty() {
            break;
        }
    }
    let mut text = lines.concat();
    for _ in 0..byte_damage {
        if text.is_empty() {
            break;
        }
        let reach = if random.usize(..2) == 0 {
            text.len()
        } else {
            text.len().min(4000)
        };
        let at = random.usize(..reach);
        match random.usize(..5) {
            0 => text[at] = random.usize(..256) as u8,
            1 => drop(text.remove(at)),
            2 => text.truncate(at),
            3 => text.insert(
                at,
                *b"{}\n\r\t ,.-eEnN0\x00\xFF:"
                    .get(random.usize(..17))
                    .unwrap(),
            ),
            _ => {
                let end = (at + random.usize(..40)).min(text.len());
                text.drain(at..end);
            }
        }
    }
    text
}

fn lines(text: &[u8]) -> usize {
    let ends = text
        .iter()
        .enumerate()
        .filter(|(at, b)| **b == b'\n' || (**b == b'\r' && text.get(at + 1) != Some(&b'\n')));
    ends.count() + 1
}

fn sound(clip: &Clip) {
    assert!(clip.frame_time > 0.0 && clip.frame_time.is_finite());
    assert!(
        clip.values()
            .iter()
            .all(|value| value.abs() <= MAX_MAGNITUDE)
    );
    for (id, joint) in clip.skeleton.joints.iter_enumerated() {
        assert!(
            joint.parent.is_none_or(|parent| parent < id)
                && joint.offset.is_finite()
                && !joint.name.is_empty()
        );
    }
    assert!(
        clip.frames == 0
            || clip
                .pose(clip.frames - 1)
                .iter()
                .all(|placed| placed.position.is_finite())
    );
}

#[test]
fn corrupted_files_are_rejected_with_a_line_or_read_with_notes() {
    let mut random = Rng::with_seed(11);
    let (mut refused, mut noted) = (0, 0);
    for (name, ..) in FILES {
        let text = bytes(name);
        // The first frames are enough, and leave time for many cases.
        let cut = text
            .iter()
            .enumerate()
            .filter(|(_, b)| **b == b'\n')
            .nth(470)
            .map_or(text.len(), |(at, _)| at + 1);
        let whole = &text[..cut];
        for case in 0..1000 {
            let text = damaged(whole, &mut random);
            match read_bytes(&text) {
                Ok(Reading { clip, notes }) => {
                    sound(&clip);
                    assert!(
                        notes
                            .iter()
                            .all(|note| (1..=lines(&text)).contains(&note.line))
                    );
                    noted += usize::from(!notes.is_empty());
                    let mut again = Vec::new();
                    write(&clip, Decimals::All, &mut again).unwrap();
                    assert_eq!(read_bytes(&again).unwrap().clip, clip, "{name} {case}");
                }
                Err(error) => {
                    refused += 1;
                    assert!(
                        (1..=lines(&text)).contains(&error.line),
                        "{name} {case}: {error} of {}",
                        lines(&text)
                    );
                    assert!(
                        error.column >= 1 && !error.message.is_empty() && !error.help.is_empty()
                    );
                    if let Some(clip) = error.partial {
                        assert!(clip.frames > 0);
                        sound(&clip);
                    }
                }
            }
        }
    }
    // Both outcomes have to occur often.
    assert!(refused > 1000 && noted > 500, "{refused} {noted}");
}
