//! Every motion file is read, or refused with a line; a clip that was read can be resampled, written and read again.

use okoshi::internals::mocap::bvh::{Decimals, MAX_MAGNITUDE, Reading, read_bytes, write};
use okoshi::internals::mocap::resample::resample;
use okoshi::internals::mocap::{Clip, JointId};
use okoshi::internals::prepare::find_lead_in;

use super::files;

/// The most numbers of a clip that is processed further: enough for every case, and fast.
const WORKED_ON: usize = 1 << 14;

/// The longest clip that is processed further, in seconds.
const LONGEST_CLIP: f64 = 60.0;

/// The longest motion that the search begins with, in bytes.
const LONGEST: usize = 64 << 10;

pub(super) fn check(text: &[u8]) -> bool {
    let lines = 1 + text
        .iter()
        .filter(|byte| matches!(byte, b'\n' | b'\r'))
        .count();
    match read_bytes(text) {
        Ok(Reading { clip, notes }) => {
            let placed = notes.iter().all(|note| (1..=lines).contains(&note.line));
            assert!(placed, "{notes:?}");
            check_clip(&clip);
            true
        }
        Err(error) => {
            let placed = (1..=lines).contains(&error.line) && error.column > 0;
            assert!(placed, "{error}");
            error.partial.is_some_and(|clip| {
                check_clip(&clip);
                true
            })
        }
    }
}

fn check_clip(clip: &Clip) {
    let values = clip.values();
    assert!(values.iter().all(|value| value.abs() <= MAX_MAGNITUDE));
    let mut written = Vec::new();
    write(clip, Decimals::All, &mut written).expect("all numbers are finite");
    let again = read_bytes(&written).expect("what was written is BVH").clip;
    assert_eq!(&again, clip);
    let arms = [[0, 1], [1, 2]].map(|arm| arm.map(JointId::from));
    let joints = clip.skeleton.joints.len();
    let lead_in = find_lead_in(&clip.positions(), joints, clip.frame_time, &arms);
    assert!(lead_in.frames <= clip.frames);
    if values.len() < WORKED_ON && clip.frames as f64 * clip.frame_time < LONGEST_CLIP {
        for fps in [5.0, 24.0, 100.0] {
            let clip = resample(clip.clone(), fps).expect("so few frames can be resampled");
            assert!(clip.values().iter().all(|value| value.is_finite()));
        }
    }
}

/// The motions of the examples and tests, the long ones cut after some frames.
pub(super) fn seeds() -> Vec<Vec<u8>> {
    let folders = ["examples/motion", "tests/motion/data"];
    let files = folders.map(|folder| files::ending(folder, ".bvh"));
    let cut = |path| {
        let mut bytes = files::read(path);
        bytes.truncate(LONGEST);
        bytes
    };
    files.into_iter().flatten().map(cut).collect()
}
