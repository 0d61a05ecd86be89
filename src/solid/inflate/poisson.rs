//! Solves the Poisson equation Δu = −1 with u = 0 on the border, by linear finite elements on triangles: the cotangent
//! Laplacian (Pinkall & Polthier, *Computing Discrete Minimal Surfaces and Their Conjugates*, 1993) and conjugate gradients with
//! an incomplete Cholesky preconditioner.
//!
//! Written by hand, because the matrix is small, sparse and symmetric: general solvers bring linear algebra crates many times
//! the size of this file, and results would depend on their versions.

use glam::DVec2;

/// The residual at which iteration stops, relative to the right-hand side.
const PRECISION: f64 = 1e-7;
/// The largest number of iterations; a few dozen are usual.
const MAX_ITERATIONS: usize = 500;
/// The largest weight of one angle, so that slivers do not dominate the matrix.
const MAX_COTANGENT: f64 = 1e6;

/// The lower triangle of a symmetric sparse matrix, in compressed rows.
struct Lower {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
    diagonal: Vec<f64>,
}

/// The solution at each point, in squared units of the points; 0 on the border.
pub(super) fn solve(points: &[DVec2], triangles: &[[u32; 3]], on_border: &[bool]) -> Vec<f64> {
    let mut unknown = vec![u32::MAX; points.len()];
    let mut count = 0;
    for (i, on_border) in on_border.iter().enumerate() {
        if !on_border {
            unknown[i] = count;
            count += 1;
        }
    }
    let (matrix, load) = assemble(points, triangles, &unknown, count as usize);
    let solution = conjugate_gradients(&matrix, &matrix.factor(), &load);
    let value = |i: &u32| solution.get(*i as usize).copied().unwrap_or(0.0);
    unknown.iter().map(value).collect()
}

/// The stiffness matrix of the inner points, and the load: the area around each.
fn assemble(
    points: &[DVec2],
    triangles: &[[u32; 3]],
    unknown: &[u32],
    count: usize,
) -> (Lower, Vec<f64>) {
    let mut diagonal = vec![0.0; count];
    let mut load = vec![0.0; count];
    let mut entries: Vec<(u32, u32, f64)> = Vec::with_capacity(3 * triangles.len());
    for triangle in triangles {
        let at = triangle.map(|i| points[i as usize]);
        let area = (at[1] - at[0]).perp_dot(at[2] - at[0]) / 2.0;
        for i in 0..3 {
            let (a, b) = (triangle[(i + 1) % 3], triangle[(i + 2) % 3]);
            let (to_a, to_b) = (at[(i + 1) % 3] - at[i], at[(i + 2) % 3] - at[i]);
            let weight = (to_a.dot(to_b) / (4.0 * area)).clamp(-MAX_COTANGENT, MAX_COTANGENT);
            let (a, b) = (unknown[a as usize], unknown[b as usize]);
            for end in [a, b] {
                if end != u32::MAX {
                    diagonal[end as usize] += weight;
                }
            }
            if a != u32::MAX && b != u32::MAX {
                entries.push((a.max(b), a.min(b), -weight));
            }
            let own = unknown[triangle[i] as usize];
            if own != u32::MAX {
                load[own as usize] += area / 3.0;
            }
        }
    }
    entries.sort_unstable_by_key(|(row, column, _)| (*row, *column));
    let mut matrix = Lower {
        starts: vec![0; count + 1],
        columns: Vec::with_capacity(entries.len() / 2),
        values: Vec::with_capacity(entries.len() / 2),
        diagonal,
    };
    for edge in entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        matrix.columns.push(edge[0].1);
        matrix.values.push(edge.iter().map(|entry| entry.2).sum());
        matrix.starts[edge[0].0 as usize + 1] = matrix.columns.len();
    }
    for row in 0..count {
        matrix.starts[row + 1] = matrix.starts[row + 1].max(matrix.starts[row]);
    }
    (matrix, load)
}

impl Lower {
    fn row(&self, i: usize) -> (&[u32], &[f64]) {
        let range = self.starts[i]..self.starts[i + 1];
        (&self.columns[range.clone()], &self.values[range])
    }

    /// The incomplete Cholesky factor without fill (Meijerink & van der Vorst 1977).
    fn factor(&self) -> Lower {
        let mut factor = Lower {
            starts: self.starts.clone(),
            columns: self.columns.clone(),
            values: self.values.clone(),
            diagonal: self.diagonal.clone(),
        };
        for i in 0..self.diagonal.len() {
            let range = self.starts[i]..self.starts[i + 1];
            let mut rest = self.diagonal[i];
            for at in range.clone() {
                let k = self.columns[at] as usize;
                let mut value = self.values[at];
                let (mut p, mut q) = (range.start, self.starts[k]);
                while p < at && q < self.starts[k + 1] {
                    match self.columns[p].cmp(&self.columns[q]) {
                        std::cmp::Ordering::Less => p += 1,
                        std::cmp::Ordering::Greater => q += 1,
                        std::cmp::Ordering::Equal => {
                            value -= factor.values[p] * factor.values[q];
                            p += 1;
                            q += 1;
                        }
                    }
                }
                value /= factor.diagonal[k];
                factor.values[at] = value;
                rest -= value * value;
            }
            // If rounding leaves no positive pivot, the diagonal alone still preconditions.
            let rest = if rest > 1e-9 * self.diagonal[i] {
                rest
            } else {
                self.diagonal[i].abs().max(f64::MIN_POSITIVE)
            };
            factor.diagonal[i] = rest.sqrt();
        }
        factor
    }

    /// The product of the symmetric matrix and a vector.
    fn times(&self, x: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.diagonal[i] * x[i];
        }
        for i in 0..x.len() {
            let (columns, values) = self.row(i);
            let mut sum = 0.0;
            for (column, value) in columns.iter().zip(values) {
                sum += value * x[*column as usize];
                out[*column as usize] += value * x[i];
            }
            out[i] += sum;
        }
    }

    /// Solves L·Lᵀ·x = b in place, where L is this matrix.
    fn solve_both(&self, x: &mut [f64]) {
        for i in 0..x.len() {
            let (columns, values) = self.row(i);
            let pairs = columns.iter().zip(values);
            let sum: f64 = pairs.map(|(j, value)| value * x[*j as usize]).sum();
            x[i] = (x[i] - sum) / self.diagonal[i];
        }
        for i in (0..x.len()).rev() {
            x[i] /= self.diagonal[i];
            let (columns, values) = self.row(i);
            for (j, value) in columns.iter().zip(values) {
                x[*j as usize] -= value * x[i];
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn conjugate_gradients(matrix: &Lower, factor: &Lower, load: &[f64]) -> Vec<f64> {
    let n = load.len();
    let mut x = vec![0.0; n];
    let mut residual = load.to_vec();
    let enough = PRECISION * PRECISION * dot(load, load);
    let mut eased = residual.clone();
    factor.solve_both(&mut eased);
    let mut direction = eased.clone();
    let mut energy = dot(&residual, &eased);
    let mut product = vec![0.0; n];
    for _ in 0..MAX_ITERATIONS {
        if dot(&residual, &residual) <= enough {
            break;
        }
        matrix.times(&direction, &mut product);
        let step = energy / dot(&direction, &product);
        if !step.is_finite() {
            break;
        }
        for i in 0..n {
            x[i] += step * direction[i];
            residual[i] -= step * product[i];
        }
        eased.copy_from_slice(&residual);
        factor.solve_both(&mut eased);
        let before = std::mem::replace(&mut energy, dot(&residual, &eased));
        for i in 0..n {
            direction[i] = eased[i] + energy / before * direction[i];
        }
    }
    x
}
