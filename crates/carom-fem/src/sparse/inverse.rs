use carom_mesh::{Matrix, Tie, Vector};

use super::chebyshev::Chebyshev;
use super::control::CONTROL;
use super::{Factor, NodalMatrix, Precision};
use crate::FemError;

/// The inverse of a symmetric positive definite matrix of D × D blocks over a node graph, exact or good enough to iterate with.
///
/// Exact it is a [`Factor`]. A polynomial of the matrix stands for its inverse, and nothing is factorised, where three things hold. The
/// factor would be large, single precision will do, and the matrix is so well-conditioned that a few products with it gain the digits an
/// iteration needs.
#[derive(Debug)]
pub struct Inverse<const D: usize> {
    ties: Vec<Tie>,
    precision: Precision,
    kind: Kind<D>,
}

#[derive(Debug)]
enum Kind<const D: usize> {
    None,
    Factor(Box<Factor<D>>),
    Polynomial(Box<Chebyshev<D>>),
}

impl<const D: usize> Inverse<D> {
    /// For matrices whose nodes have these `ties`: see [`Factor`]. It is [made](Self::make) later.
    #[must_use]
    pub fn new(ties: &[Tie]) -> Self {
        Self { ties: ties.to_vec(), precision: Precision::default(), kind: Kind::None }
    }

    /// Makes the inverse of `matrix`, exact but for round-off if `precision` is double.
    ///
    /// # Errors
    /// If the matrix is not positive definite, or memory is lacking.
    pub fn make(&mut self, precision: Precision, matrix: &NodalMatrix<Matrix<D>>) -> Result<(), FemError> {
        self.precision = precision;
        let suits = precision == Precision::Single && self.ties.is_empty();
        if suits && matrix.values.len() >= CONTROL.many {
            if let Some(polynomial) = Chebyshev::of(matrix)? {
                self.kind = Kind::Polynomial(Box::new(polynomial));
                return Ok(());
            }
        }
        if !matches!(self.kind, Kind::Factor(_)) {
            self.kind = Kind::None;
            self.kind = Kind::Factor(Box::new(Factor::new(matrix.graph(), &self.ties)?));
        }
        match &mut self.kind {
            Kind::Factor(factor) => factor.factorize(precision, |entry| matrix.values[entry]),
            _ => unreachable!("a factor was put there"),
        }
    }

    /// The numbers that it is kept in.
    #[must_use]
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// Whether there is anything to solve with.
    #[must_use]
    pub fn is_made(&self) -> bool {
        match &self.kind {
            Kind::None => false,
            Kind::Factor(factor) => factor.is_factorized(),
            Kind::Polynomial(_) => true,
        }
    }

    /// Whether it is exact but for round-off.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        matches!(self.kind, Kind::Factor(_))
    }

    /// Memory [bytes].
    #[must_use]
    pub fn bytes(&self) -> usize {
        match &self.kind {
            Kind::None => 0,
            Kind::Factor(factor) => factor.bytes(),
            Kind::Polynomial(polynomial) => polynomial.bytes(),
        }
    }

    /// See [`Factor::begin`].
    ///
    /// # Panics
    /// If the length does not fit or nothing was made; so do the methods below.
    pub fn begin(&mut self, x: &mut [Vector<D>]) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.begin(x),
            Kind::Polynomial(polynomial) => polynomial.begin(x),
        }
    }

    /// See [`Factor::end`].
    pub fn end(&mut self, x: &mut [Vector<D>]) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.end(x),
            Kind::Polynomial(polynomial) => polynomial.end(x),
        }
    }

    /// See [`Factor::set_reach`].
    pub fn set_reach(&mut self, nodes: impl Iterator<Item = usize>) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.set_reach(nodes),
            Kind::Polynomial(polynomial) => polynomial.set_reach(nodes),
        }
    }

    /// See [`Factor::look`].
    pub fn look(&mut self) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.look(),
            Kind::Polynomial(polynomial) => polynomial.look(),
        }
    }

    /// See [`Factor::seen`].
    #[must_use]
    pub fn seen(&self, node: usize) -> Vector<D> {
        match &self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.seen(node),
            Kind::Polynomial(polynomial) => polynomial.seen(node),
        }
    }

    /// See [`Factor::AT_ONCE`].
    pub const AT_ONCE: usize = Factor::<D>::AT_ONCE;

    /// See [`Factor::respond`].
    pub fn respond(&mut self, nodes: impl Iterator<Item = usize>) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.respond(nodes),
            Kind::Polynomial(polynomial) => polynomial.respond(nodes),
        }
    }

    /// See [`Factor::response`].
    #[must_use]
    pub fn response(&self, number: usize, node: usize) -> Matrix<D> {
        match &self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.response(number, node),
            Kind::Polynomial(polynomial) => polynomial.response(number, node),
        }
    }

    /// The place of a node in an order in which neighbours ask for [responses](Self::respond) at least cost.
    #[must_use]
    pub fn order(&self, node: usize) -> usize {
        match &self.kind {
            Kind::Factor(factor) => factor.order(node),
            Kind::None | Kind::Polynomial(_) => node,
        }
    }

    /// See [`Factor::add`].
    pub fn add(&mut self, forces: impl Iterator<Item = (usize, Vector<D>)>) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.add(forces),
            Kind::Polynomial(polynomial) => polynomial.add(forces),
        }
    }
}

fn not_made() -> ! {
    unreachable!("a solve needs an inverse that was made")
}
