use std::fmt::Debug;

use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;

use super::real::Real;
use super::substitution::Substitution;

/// Numbers that a factor is kept in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// `f32`: half the memory, and as solves wait for memory, half the time. For an iteration whose residual is exact it is enough,
    /// unless the matrix is so ill-conditioned that errors of 10⁻⁷ matter.
    Single,
    /// `f64`.
    #[default]
    Double,
}

impl Precision {
    /// An empty factor in this precision for `unknowns`.
    pub(super) fn triangular(self, unknowns: usize) -> Box<dyn Triangular> {
        match self {
            Self::Single => Box::new(Halves::<f32>::new(unknowns)),
            Self::Double => Box::new(Halves::<f64>::new(unknowns)),
        }
    }
}

/// A triangular factor and a right-hand side on its way through both substitutions; all places are in the order of elimination.
pub(super) trait Triangular: Debug + Send + Sync {
    /// Memory [bytes].
    fn bytes(&self) -> usize;
    /// Takes over the values of a factor.
    fn load(&mut self, factor: &SupernodalLltRef<'_, usize, f64>);
    /// Takes the right-hand side whose k-th value is `x[ordering[k]]` through the forward substitution.
    fn begin(&mut self, x: &[f64], ordering: &[usize]);
    /// The backward substitution: the solution goes where the right-hand side came from.
    fn end(&mut self, x: &mut [f64], ordering: &[usize]);
    /// Names the places at which the solution is wanted before the end, and the right-hand side is added to.
    fn set_reach(&mut self, places: &mut dyn Iterator<Item = usize>);
    /// Solves for the right-hand side as it is, within the reach.
    fn look(&mut self);
    /// Solves for the unit vector of a place of the reach, within the reach.
    fn respond(&mut self, place: usize);
    /// What was seen at a place of the reach.
    fn seen(&self, place: usize) -> f64;
    /// Adds values at places of the reach to the right-hand side.
    fn add(&mut self, values: &mut dyn Iterator<Item = (usize, f64)>);
}

#[derive(Debug)]
struct Halves<T> {
    substitution: Substitution<T>,
    /// The right-hand side and what becomes of it.
    ordered: Vec<T>,
    /// The same within the reach.
    partial: Vec<T>,
    reach: Vec<u32>,
    /// The reach of one place.
    path: Vec<u32>,
}

impl<T: Real> Halves<T> {
    fn new(unknowns: usize) -> Self {
        let zeros = vec![T::default(); unknowns];
        Self {
            substitution: Substitution::default(),
            ordered: zeros.clone(),
            partial: zeros,
            reach: Vec::new(),
            path: Vec::new(),
        }
    }
}

impl<T: Real> Triangular for Halves<T> {
    fn bytes(&self) -> usize {
        self.substitution.bytes() + 2 * size_of_val(&self.ordered[..])
    }

    fn load(&mut self, factor: &SupernodalLltRef<'_, usize, f64>) {
        self.substitution.load(factor);
    }

    fn begin(&mut self, x: &[f64], ordering: &[usize]) {
        for (ordered, &k) in self.ordered.iter_mut().zip(ordering) {
            *ordered = T::of(x[k]);
        }
        self.substitution.forward(&mut self.ordered);
    }

    fn end(&mut self, x: &mut [f64], ordering: &[usize]) {
        self.substitution.backward(&mut self.ordered);
        for (ordered, &k) in self.ordered.iter().zip(ordering) {
            x[k] = ordered.to_f64();
        }
    }

    fn set_reach(&mut self, places: &mut dyn Iterator<Item = usize>) {
        self.substitution.reach(places, &mut self.reach);
    }

    fn look(&mut self) {
        for columns in self.substitution.columns_within(&self.reach) {
            self.partial[columns.clone()].copy_from_slice(&self.ordered[columns]);
        }
        self.substitution.backward_within(&self.reach, &mut self.partial);
    }

    fn respond(&mut self, place: usize) {
        for columns in self.substitution.columns_within(&self.reach) {
            self.partial[columns].fill(T::default());
        }
        self.partial[place] = T::of(1.0);
        self.substitution.reach(std::iter::once(place), &mut self.path);
        self.substitution.forward_within(&self.path, &mut self.partial);
        self.substitution.backward_within(&self.reach, &mut self.partial);
    }

    fn seen(&self, place: usize) -> f64 {
        self.partial[place].to_f64()
    }

    fn add(&mut self, values: &mut dyn Iterator<Item = (usize, f64)>) {
        for columns in self.substitution.columns_within(&self.reach) {
            self.partial[columns].fill(T::default());
        }
        values.for_each(|(place, value)| self.partial[place] += T::of(value));
        self.substitution.forward_within(&self.reach, &mut self.partial);
        for columns in self.substitution.columns_within(&self.reach) {
            let (ordered, partial) = (&mut self.ordered[columns.clone()], &self.partial[columns]);
            ordered.iter_mut().zip(partial).for_each(|(ordered, partial)| *ordered += *partial);
        }
    }
}
