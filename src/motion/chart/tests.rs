use super::scale::{LEFT, RIGHT, Scale, TOP, number, step};
use super::*;

fn picture(speeds: &[f64], exposure: &Exposure, marked: &[u32]) -> String {
    chart(&Chart {
        title: "a < b & \"c\"\u{1}",
        fps: 24.0,
        speeds,
        omitted: marked,
        duplicated: marked,
        held: marked,
        exposure,
    })
}

fn all(frames: usize) -> Exposure {
    Exposure::new((0..frames as u32).collect())
}

#[test]
fn charts_are_well_formed_whatever_they_show() {
    let odd = [
        0.0,
        f64::INFINITY,
        f64::NAN,
        f64::MAX,
        f64::MIN_POSITIVE,
        -1.0,
    ];
    for speeds in [
        &[][..],
        &[0.0],
        &[0.0, 0.0],
        &[0.0, 1e-300],
        &[0.0, f64::MAX],
        &odd,
    ] {
        for exposure in [Exposure::default(), all(1), all(9)] {
            for fps in [24.0, 0.0, f64::NAN, 1e-300, 1e300] {
                let shown = chart(&Chart {
                    fps,
                    title: &"<&\u{0}".repeat(100),
                    speeds,
                    omitted: &[0, 1, 7, u32::MAX],
                    duplicated: &[1, 1],
                    held: &[5],
                    exposure: &exposure,
                });
                let read = roxmltree::Document::parse(&shown);
                assert!(read.is_ok(), "{read:?}\n{shown}");
                assert!(!shown.contains("NaN") && !shown.contains("inf"), "{shown}");
            }
        }
    }
}

#[test]
fn long_motions_have_small_charts_that_keep_their_peaks() {
    let frames = 100_000;
    let mut speeds: Vec<f64> = (0..frames).map(|frame| f64::from(frame % 7)).collect();
    speeds[61_803] = 1000.0;
    let marked: Vec<u32> = (1..frames as u32).step_by(2).collect();
    let shown = picture(&speeds, &all(frames as usize), &marked);
    assert!(shown.len() < 300_000, "{} bytes", shown.len());
    let scale = Scale {
        wide: (RIGHT - LEFT) / f64::from(frames),
        top: 1000.0,
    };
    let peak = format!("{:.1} {TOP:.1}", scale.middle(61_803));
    assert!(shown.contains(&peak), "no peak at {peak}");
}

#[test]
fn a_chart_marks_each_frame_once() {
    let speeds: Vec<f64> = (0..20).map(f64::from).collect();
    let exposure = Exposure::new((0..20).map(|frame| frame - frame % 2).collect());
    let shown = picture(&speeds, &exposure, &[4, 9, 9]);
    let read = roxmltree::Document::parse(&shown).expect("an SVG");
    let paths = |color: &str| -> Vec<String> {
        let paths = read.descendants().filter(|node| {
            [node.attribute("stroke"), node.attribute("fill")].contains(&Some(color))
                && node
                    .parent()
                    .is_some_and(|parent| parent.has_tag_name("svg"))
        });
        paths
            .filter_map(|node| node.attribute("d"))
            .map(str::to_owned)
            .collect()
    };
    let dots = |path: &str| path.matches("h0").count();
    assert_eq!(
        paths(OMITTED).iter().map(|path| dots(path)).sum::<usize>(),
        2
    );
    assert_eq!(paths(HELD).iter().map(|path| dots(path)).sum::<usize>(), 2);
    assert_eq!(paths(LONGER)[0].matches('Z').count(), 2);
    assert_eq!(paths(DRAWING)[0].matches('Z').count(), 10);
    assert!(shown.contains("10 drawings in 20 frames"));
    assert!(shown.contains("a &lt; b &amp; \"c\" "));
}

#[test]
fn steps_are_round() {
    let steps = [0.013, 1.0, 2.1, 5.1, 700.0, 0.0, f64::MIN_POSITIVE].map(step);
    for (step, round) in steps.iter().zip([0.02, 1.0, 5.0, 10.0, 1000.0, 1.0, 1.0]) {
        assert!((step / round - 1.0).abs() < 1e-9, "{step} is not {round}");
    }
    assert_eq!(
        [0.0, 0.1 + 0.2, 2500.0, 1e-7, 3e9].map(number),
        ["0", "0.3", "2500", "1e-7", "3e9"]
    );
}
