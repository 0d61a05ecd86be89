//! Solves the Poisson equation Δu = −1 with u = 0 on the border, by linear finite elements on triangles: the cotangent
//! Laplacian (Pinkall & Polthier, *Computing Discrete Minimal Surfaces and Their Conjugates*, 1993) and conjugate gradients with
//! a modified incomplete Cholesky preconditioner (Gustafsson, *A Class of First Order Factorization Methods*, 1978).
//!
//! Written by hand, because the matrix is small, sparse and symmetric: general solvers bring linear algebra crates many times
//! the size of this file, and results would depend on their versions.

use glam::DVec2;

/// The residual at which iteration stops, relative to the right-hand side, both as the preconditioner weighs them.
const PRECISION: f64 = 1e-5;
/// The largest number of iterations; a dozen is usual.
const MAX_ITERATIONS: usize = 500;
/// The largest weight of one angle, so that slivers do not dominate the matrix.
const MAX_COTANGENT: f64 = 1e6;
/// The share of entries outside the matrix's pattern that the preconditioner adds to its diagonal.
const MODIFIED: f64 = 0.9;
/// The least diagonal of the preconditioner, relative to that of the matrix.
const LEAST_DIAGONAL: f64 = 0.05;

/// The lower triangle of a symmetric sparse matrix, in compressed rows.
struct Lower {
    starts: Vec<u32>,
    /// Columns with their values, in any order.
    entries: Vec<(u32, f64)>,
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
    let solution = Scaled::of(matrix).solve(load);
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
    let mut load = vec![0.0; count];
    let mut matrix = Lower {
        starts: vec![0; count + 1],
        entries: Vec::new(),
        diagonal: vec![0.0; count],
    };
    // Each inner edge has two triangles, which have it in opposite directions: one of them makes its place, in the row of its
    // end with the greater number.
    for triangle in triangles {
        let own = triangle.map(|i| unknown[i as usize]);
        for [a, b] in [[own[0], own[1]], [own[1], own[2]], [own[2], own[0]]] {
            if a < b && b != u32::MAX {
                matrix.starts[b as usize + 1] += 1;
            }
        }
    }
    for row in 0..count {
        matrix.starts[row + 1] += matrix.starts[row];
    }
    let mut ends = matrix.starts.clone();
    matrix.entries = vec![(0, 0.0); matrix.starts[count] as usize];
    for triangle in triangles {
        let at = triangle.map(|i| points[i as usize]);
        let own = triangle.map(|i| unknown[i as usize]);
        let twice = (at[1] - at[0]).perp_dot(at[2] - at[0]);
        let inverse = 0.5 / twice;
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let weight = (at[j] - at[i]).dot(at[k] - at[i]) * inverse;
            let weight = weight.clamp(-MAX_COTANGENT, MAX_COTANGENT);
            let (a, b) = (own[j], own[k]);
            for end in [a, b] {
                if end != u32::MAX {
                    matrix.diagonal[end as usize] += weight;
                }
            }
            if a != u32::MAX && b != u32::MAX {
                let (row, column) = (a.max(b) as usize, a.min(b));
                let places = matrix.starts[row] as usize..ends[row] as usize;
                let mut known = matrix.entries[places].iter_mut();
                if let Some((_, value)) = known.find(|(known, _)| *known == column) {
                    *value -= weight;
                } else {
                    matrix.entries[ends[row] as usize] = (column, -weight);
                    ends[row] += 1;
                }
            }
            if own[i] != u32::MAX {
                load[own[i] as usize] += twice / 6.0;
            }
        }
    }
    (matrix, load)
}

impl Lower {
    fn row(&self, i: usize) -> &[(u32, f64)] {
        &self.entries[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// The diagonal of the factor: what is left of that of the matrix without the products of entries above it. Products outside
    /// the pattern are taken from the diagonal too, so that smooth vectors are preconditioned well.
    fn factor(&self) -> Vec<f64> {
        let n = self.diagonal.len();
        let mut right = vec![0.0; n];
        for (column, value) in &self.entries {
            right[*column as usize] += value;
        }
        let mut factor = vec![0.0; n];
        for i in 0..n {
            let mut rest = self.diagonal[i];
            for (column, value) in self.row(i) {
                let j = *column as usize;
                let products = value + MODIFIED * (right[j] - value);
                rest -= value * products / factor[j];
            }
            let least = (LEAST_DIAGONAL * self.diagonal[i].abs()).max(f64::MIN_POSITIVE);
            factor[i] = rest.max(least);
        }
        factor
    }
}

/// A matrix scaled so that its preconditioner is (I + L)(I + Lᵀ), where L is its strictly lower triangle.
struct Scaled {
    matrix: Lower,
    /// From solutions of the scaled matrix to those of the original one.
    scale: Vec<f64>,
}

impl Scaled {
    fn of(mut matrix: Lower) -> Self {
        let scale = matrix.factor();
        let scale: Vec<f64> = scale.into_iter().map(|x| x.sqrt().recip()).collect();
        for i in 0..scale.len() {
            matrix.diagonal[i] *= scale[i] * scale[i];
            let row = matrix.starts[i] as usize..matrix.starts[i + 1] as usize;
            for (column, value) in &mut matrix.entries[row] {
                *value *= scale[i] * scale[*column as usize];
            }
        }
        Self { matrix, scale }
    }

    /// Replaces x by the solution of (I + L)·y = x.
    fn forward(&self, x: &mut [f64]) {
        for i in 0..x.len() {
            x[i] = self.without_products(i, x[i], x);
        }
    }

    /// A number minus the products of row i of L and x.
    fn without_products(&self, i: usize, number: f64, x: &[f64]) -> f64 {
        let row = self.matrix.row(i).iter();
        row.fold(number, |rest, (column, value)| {
            rest - value * x[*column as usize]
        })
    }

    /// Replaces x by the solution of (I + Lᵀ)·y = x.
    fn backward(&self, x: &mut [f64]) {
        for i in (0..x.len()).rev() {
            let own = x[i];
            for (column, value) in self.matrix.row(i) {
                x[*column as usize] -= value * own;
            }
        }
    }

    /// Conjugate gradients with the preconditioned matrix (I + L)⁻¹·A·(I + Lᵀ)⁻¹. Its products need no more than the two solutions
    /// (Eisenstat, *Efficient Implementation of a Class of Preconditioned Conjugate Gradient Methods*, 1981).
    fn solve(&self, mut load: Vec<f64>) -> Vec<f64> {
        let n = load.len();
        for (load, scale) in load.iter_mut().zip(&self.scale) {
            *load *= scale;
        }
        self.forward(&mut load);
        let mut x = vec![0.0; n];
        let mut residual = load;
        let mut direction = residual.clone();
        let mut inner = residual.clone();
        let (mut outer, mut product) = (vec![0.0; n], vec![0.0; n]);
        let mut energy: f64 = residual.iter().map(|r| r * r).sum();
        let enough = PRECISION * PRECISION * energy;
        for _ in 0..MAX_ITERATIONS {
            if energy <= enough {
                break;
            }
            self.backward(&mut inner);
            let mut along = 0.0;
            for i in 0..n {
                let own = direction[i] + (self.matrix.diagonal[i] - 2.0) * inner[i];
                outer[i] = self.without_products(i, own, &outer);
                product[i] = inner[i] + outer[i];
                along += direction[i] * product[i];
            }
            let step = energy / along;
            if !step.is_finite() {
                break;
            }
            let before = std::mem::replace(&mut energy, 0.0);
            for i in 0..n {
                x[i] += step * direction[i];
                residual[i] -= step * product[i];
                energy += residual[i] * residual[i];
            }
            for i in 0..n {
                direction[i] = residual[i] + energy / before * direction[i];
                inner[i] = direction[i];
            }
        }
        self.backward(&mut x);
        for (x, scale) in x.iter_mut().zip(&self.scale) {
            *x *= scale;
        }
        x
    }
}
