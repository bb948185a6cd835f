use crate::clock::Clock;
use crate::lu::Lu;
use crate::{ContactProblem, Matrix, Vector};

/// Whether the step from `before` to `r` shows that no reactions keep the contacts apart.
///
/// Let z ≥ 0 be normal reactions with Wᵀz = 0. Whatever the reactions, z · w = z · q; where that is negative some contact
/// penetrates (Farkas' lemma). If W is positive definite there is no such z, and the problem has a solution [V. Acary,
/// F. Cadoux, C. Lemaréchal, J. Malick, Z. Angew. Math. Mech. 91 (2011) 155–175], however badly W is conditioned. So z is sharpened
/// until Wᵀz is zero but for the rounding of the numbers of W, or nothing is said.
pub(crate) fn contradicts<const D: usize>(
    problem: &ContactProblem<D>,
    r: &[Vector<D>],
    before: &[Vector<D>],
    stiffness: f64,
    lu: &mut Lu<D>,
    clock: Clock,
) -> bool {
    let growth = |(r, before): (&Vector<D>, &Vector<D>)| normal(r[0] - before[0]);
    let mut z: Vec<Vector<D>> = r.iter().zip(before).map(growth).collect();
    if !normalise(&mut z) {
        return false;
    }
    let rows = Rows::new(problem, stiffness);
    if !rows.look_contradicted_by(&z) {
        return false;
    }
    let refuted = |z: &[Vector<D>]| rows.are_contradicted_by(z);
    refuted(&z) || (0..CONTROL.refinements).any(|_| rows.sharpen(&mut z, lu, clock) && refuted(&z))
}

/// What counts as a proof, and how z is sharpened until it is one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Control {
    /// Size of reactions, relative to those that the motions call for, that nothing physical needs.
    out_of_proportion: f64,
    /// Share of q along z, of both their lengths, below which contacts only touch.
    closing: f64,
    /// |Wᵀz| over |z| that the rounding of W explains, over the root of the number of rows, where the mean of its diagonal blocks is one.
    round_off: f64,
    /// The most that it explains of any W. One with a condition number below the inverse of this, 5.6e14, has no such z.
    most_round_off: f64,
    /// Steps of inverse iteration.
    refinements: usize,
    /// Their shift, relative to the compliance of each contact: a component of z outside of the null space shrinks by as much.
    shift: f64,
}

/// The thresholds of every problem.
const CONTROL: Control = Control {
    out_of_proportion: 1e8,
    closing: 1e-9,
    round_off: 2.0 * f64::EPSILON,
    most_round_off: 8.0 * f64::EPSILON,
    refinements: 3,
    shift: 1e-13,
};

/// The rows of a problem, counted in the compliance of their own contact: soft contacts must not hide stiff ones.
struct Rows<'a, const D: usize> {
    problem: &'a ContactProblem<D>,
    /// tr W_ii/D, or the mean of all for a contact that nothing can move [m/N].
    compliance: Vec<f64>,
}

impl<'a, const D: usize> Rows<'a, D> {
    fn new(problem: &'a ContactProblem<D>, stiffness: f64) -> Self {
        let own = |i| problem.w.diagonal(i).trace() / D as f64;
        let compliance = (0..problem.len()).map(|i| if own(i) > 0.0 { own(i) } else { 1.0 / stiffness });
        Self { problem, compliance: compliance.collect() }
    }

    /// |z|, z·q, |Wᵀz| and |q|, each row in its own units.
    fn lengths(&self, z: &[Vector<D>]) -> [f64; 4] {
        let roots = || self.compliance.iter().map(|c| c.sqrt());
        let length = |squares: f64| squares.sqrt();
        // Divided first and squared then: squares of what is small in itself may vanish.
        let size = z.iter().zip(roots()).map(|(z, root)| (z[0] * root).powi(2)).sum();
        let response = transposed_times(self.problem, z);
        let response = response.iter().zip(roots()).map(|(x, root)| (x / root).norm_squared()).sum();
        let q = self.problem.q.iter().zip(roots()).map(|(q, root)| (q / root).norm_squared()).sum();
        let along = Sum::of(z.iter().zip(&self.problem.q).map(|(z, q)| (z[0], q[0])));
        [length(size), along, length(response), length(q)]
    }

    /// Whether it is worth sharpening `z`.
    fn look_contradicted_by(&self, z: &[Vector<D>]) -> bool {
        let [size, along, response, q] = self.lengths(z);
        -along > CONTROL.closing * size * q && -along > CONTROL.out_of_proportion.sqrt() * q * response
    }

    /// Whether `z` proves that there are no reactions, but for the rounding of W.
    fn are_contradicted_by(&self, z: &[Vector<D>]) -> bool {
        let [size, along, response, q] = self.lengths(z);
        let rows = (self.problem.len() * D) as f64;
        let explained = (CONTROL.round_off * rows.sqrt()).min(CONTROL.most_round_off);
        -along > CONTROL.closing * size * q
            && -along > CONTROL.out_of_proportion * q * response
            && response <= explained * size
    }

    /// A step of inverse iteration on the normal rows and columns in which z > 0; false where there is no factor.
    fn sharpen(&self, z: &mut [Vector<D>], lu: &mut Lu<D>, clock: Clock) -> bool {
        let n = z.len();
        let (mut a, mut b) = (vec![Matrix::zeros(); n], vec![Matrix::identity(); n]);
        for i in 0..n {
            if z[i][0] > 0.0 {
                a[i][(0, 0)] = 1.0;
                b[i] = Matrix::identity() * self.compliance[i];
                b[i][(0, 0)] *= CONTROL.shift;
            }
            z[i][0] *= self.compliance[i];
        }
        if lu.factorize(&self.problem.w, 0.0, &a, &b, clock).is_err() {
            return false;
        }
        lu.solve(z);
        normalise(z)
    }
}

/// Makes z normal reactions that do not pull, the largest of which is 1; false where there is none.
fn normalise<const D: usize>(z: &mut [Vector<D>]) -> bool {
    let largest = z.iter().map(|z| z[0]).fold(0.0, f64::max);
    z.iter_mut().for_each(|z| *z = normal(z[0] / largest));
    largest.is_normal()
}

/// A normal reaction that does not pull.
fn normal<const D: usize>(x: f64) -> Vector<D> {
    let mut z = Vector::zeros();
    z[0] = x.max(0.0);
    z
}

/// Wᵀz of normal reactions z, exact but for one rounding.
fn transposed_times<const D: usize>(problem: &ContactProblem<D>, z: &[Vector<D>]) -> Vec<Vector<D>> {
    let mut sums = vec![[Sum::default(); D]; z.len()];
    for (i, z) in z.iter().enumerate().filter(|(_, z)| z[0] > 0.0) {
        for (j, block) in problem.w.row(i) {
            for (k, sum) in sums[j].iter_mut().enumerate() {
                sum.add(z[0], block[(0, k)]);
            }
        }
    }
    sums.iter().map(|sum| Vector::from_fn(|k, _| sum[k].value())).collect()
}

/// A sum of products in twice the precision [T. Ogita, S. M. Rump, S. Oishi, SIAM J. Sci. Comput. 26 (2005) 1955–1988].
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn of(products: impl Iterator<Item = (f64, f64)>) -> f64 {
        let mut sum = Self::default();
        products.for_each(|(a, b)| sum.add(a, b));
        sum.value()
    }

    fn add(&mut self, a: f64, b: f64) {
        let product = a * b;
        let sum = self.sum + product;
        let part = sum - self.sum;
        self.lost += a.mul_add(b, -product) + ((self.sum - (sum - part)) + (product - part));
        self.sum = sum;
    }

    fn value(self) -> f64 {
        self.sum + self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BlockMatrix;

    #[test]
    fn sums_keep_what_cancels() {
        let products = [(1e8 + 1.0, 1e8 - 1.0), (-1e8, 1e8), (0.5, 0.25)];
        assert_eq!(Sum::of(products.into_iter()), -0.875);
    }

    /// Three contacts that hold a body in a plane from all sides, too tightly. z = (1, 1, 1) is the proof, z with an error of
    /// 1e-4 is none, and one step of inverse iteration makes it one.
    #[test]
    fn a_direction_with_an_error_is_no_proof_until_it_is_sharpened() {
        let normals = [[0.1, 0.7], [-0.9, -0.4], [0.8, -0.3]];
        let mut w = BlockMatrix::<1>::default();
        for a in normals {
            let row = normals.map(|b| Matrix::<1>::new((a[0] * b[0] + a[1] * b[1]) / 3.0));
            w.push_row(row.into_iter().enumerate());
        }
        let problem = ContactProblem { w, q: vec![Vector::<1>::new(-1.0); 3], mu: vec![0.0; 3] };
        let clock = Clock::new(None);
        let mut lu = Lu::new(&problem.w, 100, clock).expect("few blocks");
        let rows = Rows::new(&problem, problem.natural_stiffness());
        let mut z = [1.0, 1.0001, 0.9999].map(Vector::<1>::new);
        assert!(!rows.are_contradicted_by(&z));
        assert!(rows.look_contradicted_by(&z.map(|z| z.map(|x| 1.0 + 1e-3 * (x - 1.0)))));
        assert!(rows.sharpen(&mut z, &mut lu, clock));
        assert!(rows.are_contradicted_by(&z));
        let [size, along, response, q] = rows.lengths(&z);
        let mean: f64 = rows.compliance.iter().sum();
        assert!((size - mean.sqrt()).abs() < 1e-9 && (along + 3.0).abs() < 1e-9);
        assert!((q - rows.compliance.iter().map(|c| 1.0 / c).sum::<f64>().sqrt()).abs() < 1e-12);
        assert!(response < 1e-15);
        // Where the contacts open along z, or only touch, it is no proof.
        let open = ContactProblem { q: vec![Vector::<1>::new(1.0); 3], ..problem.clone() };
        assert!(!Rows::new(&open, 1.0).are_contradicted_by(&z));
        let touching = ContactProblem { q: [-1.0, 1.0, 0.0].map(Vector::<1>::new).to_vec(), ..problem };
        assert!(!Rows::new(&touching, 1.0).are_contradicted_by(&z));
    }
}
