//! The tracker on a clip that was filmed.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use image::AnimationDecoder as _;
use image::codecs::webp::WebPDecoder;
use okoshi::internals::mark_tracks::MarkTracks;
use okoshi::internals::tracking::{Follower, Frame, Learner, Mark};

#[test]
fn a_filmed_clip_agrees_with_another_program() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tracking/data");
    let file = BufReader::new(File::open(data.join("sticks.webp")).expect("the clip"));
    let frames = WebPDecoder::new(file).expect("a clip").into_frames();
    let frames: Vec<Vec<u8>> = frames
        .map(|frame| {
            image::DynamicImage::from(frame.expect("a frame").into_buffer())
                .into_rgb8()
                .into_raw()
        })
        .collect();
    let reference = std::fs::read(data.join("sticks.csv")).expect("the reference");
    let reference = MarkTracks::from_bytes(&reference).expect("a track");
    let frame = |number: usize| Frame::new(reference.size, &frames[number]).expect("it has pixels");
    let marks = [("red", [255, 0, 0]), ("green", [0, 128, 0])];
    let marks = marks.map(|(name, color)| Mark::new(name, color).expect("it is coloured"));
    let mut learner = Learner::new(reference.size, marks.to_vec());
    (0..frames.len()).for_each(|number| learner.push(frame(number)));
    let mut follower = Follower::new(learner.learned().expect("they are in the clip"));
    (0..frames.len()).for_each(|number| follower.push(frame(number)));
    let found = follower.tracks(reference.times.clone());
    for (mark, theirs) in found.marks.iter().zip(&reference.marks) {
        assert_eq!(mark.name, theirs.name);
        let lost = mark.is_lost.iter().filter(|lost| **lost).count();
        let both =
            (0..frames.len()).filter(|frame| !mark.is_lost[*frame] && !theirs.is_lost[*frame]);
        let mut distances: Vec<f64> = both
            .map(|frame| mark.points[frame].distance(theirs.points[frame]))
            .collect();
        distances.sort_by(f64::total_cmp);
        let (median, p95) = (
            distances[distances.len() / 2],
            distances[distances.len() * 95 / 100],
        );
        eprintln!(
            "{}: median {median:.2}, p95 {p95:.2}, {lost} lost",
            mark.name
        );
        assert!(median < 1.0 && p95 < 4.0 && lost <= 4);
    }
}
