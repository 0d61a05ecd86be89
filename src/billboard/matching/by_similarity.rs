//! The thesis' own method: each region gets the most similar one.

/// The similarity of regions with the same name: greater than all that are computed.
pub(super) const NAMED: f64 = 2.0;

/// For each row the most similar column, the first of equals; `None` if none is similar at all.
fn best(
    rows: usize,
    columns: usize,
    similarity: impl Fn(usize, usize) -> f64,
) -> Vec<Option<(usize, f64)>> {
    let best = |row: usize| {
        let similar = (0..columns).map(|column| (column, similarity(row, column)));
        let similar = similar.filter(|(_, s)| *s > 0.0);
        similar.reduce(|best, s| if s.1 > best.1 { s } else { best })
    };
    (0..rows).map(best).collect()
}

/// The same; of rows that want one column, the most similar one has it, the first of equals.
pub(super) fn kept(
    rows: usize,
    columns: usize,
    similarity: impl Fn(usize, usize) -> f64,
) -> Vec<Option<usize>> {
    let best = best(rows, columns, similarity);
    let mut owners: Vec<Option<(usize, f64)>> = vec![None; columns];
    for (row, found) in best.iter().enumerate() {
        let Some((column, similarity)) = *found else {
            continue;
        };
        if owners[column].is_none_or(|(_, other)| similarity > other) {
            owners[column] = Some((row, similarity));
        }
    }
    let is_owner = |row: usize, column: usize| owners[column].is_some_and(|(own, _)| own == row);
    let kept = best.into_iter().enumerate();
    kept.map(|(row, found)| {
        found
            .map(|(column, _)| column)
            .filter(|c| is_owner(row, *c))
    })
    .collect()
}

#[cfg(test)]
pub(in crate::billboard) mod compared {
    use typed_index_collections::TiVec;

    use super::super::cost::{Turn, features};
    use crate::billboard::place::Frame;
    use crate::billboard::region::{RegionId, View};

    /// For each region of the first view, the region of the second that is most similar by equations 4.1 and 4.2. Several may get
    /// the same; `None` where no colour fits.
    pub(in crate::billboard) fn most_similar(
        views: [&View; 2],
        frames: [&Frame; 2],
    ) -> TiVec<RegionId, Option<RegionId>> {
        let turn = Turn::new(views[0].direction, views[1].direction);
        let [first, second] = [0, 1].map(|i| features(views[i], frames[i]));
        let similarity = |row: usize, column: usize| {
            turn.similarity(&first[RegionId::from(row)], &second[RegionId::from(column)])
        };
        let best = super::best(first.len(), second.len(), similarity).into_iter();
        best.map(|found| found.map(|(column, _)| RegionId::from(column)))
            .collect()
    }
}
