//! Every motion file is read, or refused with a line; a clip that was read can be resampled, written and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use okoshi::motion::bvh::{Decimals, MAX_MAGNITUDE, Reading, read_bytes, write};
use okoshi::motion::lead_in::find_lead_in;
use okoshi::motion::resample::resample;
use okoshi::motion::skeleton::Clip;

/// The most numbers of a clip that is processed further: enough for every case, and fast.
const WORKED_ON: usize = 1 << 14;

fuzz_target!(|text: &[u8]| {
    let lines = 1 + text
        .iter()
        .filter(|byte| matches!(byte, b'\n' | b'\r'))
        .count();
    match read_bytes(text) {
        Ok(Reading { clip, notes }) => {
            assert!(
                notes.iter().all(|note| (1..=lines).contains(&note.line)),
                "{notes:?}"
            );
            sound(&clip);
        }
        Err(error) => {
            assert!(
                (1..=lines).contains(&error.line) && error.column > 0,
                "{error}"
            );
            if let Some(clip) = error.partial {
                sound(&clip);
            }
        }
    }
});

fn sound(clip: &Clip) {
    assert!(clip.values().iter().all(|value| value.abs() <= MAX_MAGNITUDE));
    let mut written = Vec::new();
    write(clip, Decimals::All, &mut written).expect("all numbers are finite");
    let again = read_bytes(&written).expect("what was written is BVH").clip;
    assert_eq!(&again, clip);
    let arms = [[0, 1], [1, 2]];
    let joints = clip.skeleton.joints.len();
    let lead_in = find_lead_in(&clip.positions(), joints, clip.frame_time, &arms);
    assert!(lead_in.frames <= clip.frames());
    if clip.values().len() < WORKED_ON && clip.frames() as f64 * clip.frame_time < 60.0 {
        for fps in [5.0, 24.0, 100.0] {
            let clip = resample(clip.clone(), fps).expect("so few frames can be resampled");
            assert!(clip.values().iter().all(|value| value.is_finite()));
        }
    }
}
