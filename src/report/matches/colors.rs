//! Colours that are easy to tell apart, as many as are needed.

use crate::math;

/// The golden angle, degrees: hues that are this far apart never come close to each other soon.
const GOLDEN_ANGLE: f64 = 137.507_764;
/// The hue of the first colour, degrees.
const FIRST_HUE: f64 = 25.0;
/// Lightness of the colours in turn. Hues come back near each other after 8, 13 and 21 colours, which then differ in lightness.
const LIGHTNESS: [f64; 5] = [0.72, 0.85, 0.6, 0.79, 0.66];
/// Chroma, where sRGB has it.
const CHROMA: f64 = 0.14;
/// Steps of halving to the largest chroma that sRGB has.
const STEPS: usize = 12;

/// The colour with a number, sRGB: always the same one. The first 55 are easy to tell apart; then they are almost repeated.
pub(super) fn numbered(number: usize) -> [u8; 3] {
    let hue = (FIRST_HUE + number as f64 * GOLDEN_ANGLE).rem_euclid(360.0);
    let lightness = LIGHTNESS[number % LIGHTNESS.len()];
    let (mut most, mut found) = (CHROMA, [0.0; 3]);
    let (mut low, mut high) = (0.0, 2.0 * CHROMA);
    for _ in 0..STEPS {
        let color = linear([lightness, most, hue]);
        if color.iter().all(|channel| (0.0..=1.0).contains(channel)) {
            found = color;
            low = most;
            if most == CHROMA {
                break;
            }
        } else {
            high = most;
        }
        most = (low + high) / 2.0;
    }
    found.map(|channel| (encoded(channel) * 255.0).round() as u8)
}

/// Linear sRGB of a colour in Oklch, the polar form of Oklab (Ottosson, *A perceptual color space for image processing*, 2020):
/// lightness, chroma, and hue in degrees. Colours outside of sRGB have channels outside of 0 to 1.
fn linear([lightness, chroma, hue]: [f64; 3]) -> [f64; 3] {
    let (b, a) = math::sin_cos(hue.to_radians());
    let (a, b) = (chroma * a, chroma * b);
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

/// The sRGB value of a linear one, both 0 to 1.
fn encoded(channel: f64) -> f64 {
    if channel <= 0.003_130_8 {
        12.92 * channel
    } else {
        1.055 * math::powf(channel, 1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::oklab;

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        let squares = (0..3).map(|axis| (a[axis] - b[axis]).powi(2));
        squares.sum::<f64>().sqrt()
    }

    #[test]
    fn colors_are_different_and_none_is_gray() {
        let colors: Vec<[f64; 3]> = (0..55).map(|number| oklab(numbered(number))).collect();
        for (index, color) in colors.iter().enumerate() {
            let chroma = color[1].hypot(color[2]);
            assert!(chroma > 0.06, "{index}: {color:?}");
            for (other, second) in colors[..index].iter().enumerate() {
                let apart = distance(*color, *second);
                let least = if index < 20 { 0.06 } else { 0.03 };
                assert!(apart > least, "{other} and {index}: {apart}");
            }
        }
    }

    #[test]
    fn lightness_is_as_asked() {
        for number in 0..20 {
            let [lightness, ..] = oklab(numbered(number));
            assert!((lightness - LIGHTNESS[number % 5]).abs() < 0.01, "{number}");
        }
    }
}
