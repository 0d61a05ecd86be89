//! Terrain: maps of landscapes whose heights are known come out as those landscapes.

#[path = "common/worlds.rs"]
mod worlds;

use okoshi::terrain::Land;
use worlds::World;

/// Cells that come out right, and all that something is drawn in.
fn score(seed: u64) -> [usize; 2] {
    let drawn = World::random(seed).draw();
    let land = Land::new(&drawn.map);
    let mut score = [0; 2];
    for column in 0..drawn.map.columns {
        for (row, seen) in land.seen(column).into_iter().enumerate() {
            if let Some(height) = drawn.heights[drawn.map.index(column, row)] {
                score[0] += usize::from(seen == Some(height));
                score[1] += 1;
            }
        }
    }
    score
}

#[test]
fn landscapes_come_out_of_their_maps() {
    let scores: Vec<[usize; 2]> = (0..2000).map(score).collect();
    let sum = |at: usize| scores.iter().map(|score| score[at]).sum::<usize>() as f64;
    let exact = scores.iter().filter(|[right, all]| right == all).count();
    let right = sum(0) / sum(1);
    eprintln!("{right:.4} of all cells are right, {exact} of {} maps", scores.len());
    assert!(right >= 0.95);
    assert!(exact * 2 >= scores.len());
}
