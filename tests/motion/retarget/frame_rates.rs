//! The same motion at other frame rates moves what hangs on a figure in the same way.
//!
//! `OKOSHI_BVH=FOLDER cargo test --test motion frame_rate -- --nocapture` also measures the motions in a folder.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use okoshi::internals::clips::{BuiltIn, Legs};
use okoshi::internals::labels::FigurePartId;
use okoshi::internals::mocap::bvh;
use okoshi::internals::prepare::{Options, PreparedClip, built_in, prepare};
use okoshi::internals::retarget::retarget;

use super::clips::FILES;
use super::swing::hairy;
use super::{apart, placed};

/// The largest difference between parts that hang, degrees.
const MOST: f64 = 2.5;
/// Clips in which feet leave the ground within less than a frame at the lower rate: what hangs differs more.
const FAST: [&str; 1] = ["run"];
/// Frames a second, and how many frames there are from one moment to the next at which both have a frame.
const RATES: [(f64, usize); 2] = [(24.0, 2), (60.0, 5)];

fn at(fps: f64) -> Options {
    Options {
        fps,
        ..Options::default()
    }
}

fn read(path: &Path, fps: f64) -> PreparedClip {
    let bytes = fs::read(path).expect("a file");
    let clip = bvh::read_bytes(&bytes).expect("a motion").clip;
    prepare(clip, &at(fps)).expect("a rate")
}

/// How a figure stands on the ground.
#[derive(Debug, Clone, Copy)]
enum Feet {
    /// It floats.
    None,
    /// On its feet, which are locked while they are in contact.
    Locked,
}

/// What was compared: how far parts that hang are apart, degrees.
#[derive(Default)]
struct Compared {
    most: f64,
    sum: f64,
    count: usize,
}

/// Compares the parts that hang on a figure at all times that two motions share.
fn compare(clip: impl Fn(f64) -> PreparedClip, feet: Feet) -> Compared {
    let mut clips = RATES.map(|(fps, _)| clip(fps));
    let counts = clips.each_ref().map(|clip| clip.clip.frames);
    let moments = (counts[0] - 1) / RATES[0].1;
    let moments = moments.min((counts[1] - 1) / RATES[1].1);
    for (clip, (_, every)) in clips.iter_mut().zip(RATES) {
        // Both end at the same time.
        clip.clip = clip.clip.select_frames(0..moments * every + 1);
    }
    let played = clips.map(|prepared| {
        let (mut rig, hanging) = hairy(&prepared.anatomy, Some(1.0));
        if matches!(feet, Feet::None) {
            rig.parts.iter_mut().for_each(|part| part.stands = false);
        }
        let played = retarget(&prepared.clip, &rig, &prepared.landmarks());
        (rig, played, hanging)
    });
    let mut compared = Compared::default();
    for moment in 0..=moments {
        let turns = [0, 1].map(|rate| {
            let (rig, clip, hanging) = &played[rate];
            let now = placed(rig, clip, moment * RATES[rate].1);
            let turn = |part: &FigurePartId| {
                let parent = rig.parts[*part].parent.expect("it hangs");
                now[parent].rotation.inverse() * now[*part].rotation
            };
            hanging.iter().map(turn).collect::<Vec<_>>()
        });
        for (a, b) in turns[0].iter().zip(&turns[1]) {
            let apart = apart(*a, *b);
            compared.most = compared.most.max(apart);
            compared.sum += apart;
            compared.count += 1;
        }
    }
    compared
}

/// Prints a row of the table, and returns the largest difference and the number of poses.
fn measure(name: &str, clip: impl Fn(f64) -> PreparedClip) -> (f64, usize) {
    let [floating, standing] = [Feet::None, Feet::Locked].map(|feet| compare(&clip, feet));
    let row = [&floating, &standing]
        .map(|c| format!("{:6.2}° (mean {:.2}°)", c.most, c.sum / c.count as f64));
    eprintln!(
        "{name:40} floating {}, standing {}, {} poses",
        row[0], row[1], standing.count
    );
    (floating.most.max(standing.most), standing.count)
}

#[test]
fn the_frame_rate_does_not_matter() {
    let mut rows: Vec<(String, f64)> = Vec::new();
    let mut poses = 0;
    for file in FILES {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        let (most, count) = measure(file, |fps| read(&path, fps));
        poses += count;
        rows.push((file.to_owned(), most));
    }
    let skeletal = BuiltIn::ALL.into_iter();
    let skeletal: Vec<BuiltIn> = skeletal.filter(|which| !which.moves_parts()).collect();
    for which in &skeletal {
        let clip = |fps| {
            let clip = built_in(*which, Legs::Two);
            clip.change(&at(fps)).expect("a rate")
        };
        let (most, count) = measure(which.name(), clip);
        poses += count;
        rows.push((which.name().to_owned(), most));
    }
    if let Ok(folder) = env::var("OKOSHI_BVH") {
        let files = fs::read_dir(folder).expect("a folder of motions");
        let mut paths: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
        paths.sort();
        for path in paths {
            if read(&path, 24.0).anatomy.limbs.len() == 4 {
                measure(&path.display().to_string(), |fps| read(&path, fps));
            }
        }
    }
    for (name, most) in rows
        .iter()
        .filter(|(name, _)| !FAST.contains(&name.as_str()))
    {
        assert!(*most < MOST, "{name}: {most}°");
    }
    assert_eq!(rows.len(), FILES.len() + skeletal.len());
    assert!(poses >= 2000, "{poses}");
}
