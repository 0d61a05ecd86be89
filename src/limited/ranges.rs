//! Runs of frames as text.

/// Sorted frames as text for people, who count from 1, runs abbreviated: `3-6, 9`. After `most` runs the rest is only counted.
pub(crate) fn frame_ranges(frames: &[u32], most: usize) -> String {
    let runs = frames.chunk_by(|a, b| a + 1 == *b);
    let mut texts: Vec<String> = Vec::new();
    let mut more = 0;
    for run in runs {
        match run {
            _ if texts.len() >= most => more += run.len(),
            [one] => texts.push((one + 1).to_string()),
            [first, .., last] => texts.push(format!("{}-{}", first + 1, last + 1)),
            [] => {}
        }
    }
    if more > 0 {
        texts.push(format!("{more} more"));
    }
    texts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_abbreviated() {
        let frames = [2, 3, 4, 8, 10, 11];
        assert_eq!(frame_ranges(&frames, usize::MAX), "3-5, 9, 11-12");
        assert_eq!(frame_ranges(&frames, 1), "3-5, 3 more");
        assert_eq!(frame_ranges(&[], 1), "");
    }
}
