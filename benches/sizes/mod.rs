//! The sizes of drawings that a benchmark measures with.

/// The numbers of parts to measure with: from the arguments, else `usual`.
pub(crate) fn sizes(arguments: impl Iterator<Item = String>, usual: &[usize]) -> Vec<usize> {
    // cargo passes `--bench`, which is no number.
    let asked: Vec<usize> = arguments
        .filter_map(|argument| argument.parse().ok())
        .collect();
    if asked.is_empty() {
        usual.to_vec()
    } else {
        asked
    }
}
