use carom_mesh::{Matrix, Tie, Vector};

use super::chebyshev::Chebyshev;
use super::control::CONTROL;
use super::shared::{Shared, Sharing};
use super::{Factor, NodalMatrix, Precision};
use crate::FemError;

/// The inverse of a symmetric positive definite matrix of D × D blocks over a node graph, exact or good enough to iterate with.
///
/// Exact it is a [`Factor`]. A polynomial of the matrix stands for its inverse, and nothing is factorised, where three things hold. The
/// factor would be large, an approximation will do, and the matrix is so well-conditioned that a few products with it gain the digits an
/// iteration needs.
#[derive(Debug)]
pub struct Inverse<const D: usize> {
    ties: Vec<Tie>,
    precision: Precision,
    /// The nodes that a factor eliminates last, and those that the next one is to.
    last: Vec<u32>,
    next_last: Vec<u32>,
    /// Who has the rest of the matrix, if others have.
    sharing: Option<Sharing>,
    kind: Kind<D>,
}

#[derive(Debug)]
enum Kind<const D: usize> {
    None,
    Factor(Box<Factor<D>>),
    Polynomial(Box<Chebyshev<D>>),
    Shared(Box<Shared<D>>),
}

impl<const D: usize> Inverse<D> {
    /// For matrices whose nodes have these `ties`: see [`Factor`]. It is [made](Self::make) later.
    #[must_use]
    pub fn new(ties: &[Tie]) -> Self {
        Self {
            ties: ties.to_vec(),
            precision: Precision::default(),
            last: Vec::new(),
            next_last: Vec::new(),
            sharing: None,
            kind: Kind::None,
        }
    }

    /// The same of matrices of which this process has a part: what is not a polynomial is left to what the ranks solve with.
    #[must_use]
    pub fn shared(self, sharing: Option<Sharing>) -> Self {
        Self { sharing, ..self }
    }

    /// Names the `nodes`, ascending, that [responses](Self::respond) will be asked for of inverses made from now on. Where they are many but not
    /// most of the body, its factor is ordered by them: solving for each through all of it would take more time than the factor itself.
    pub fn expect(&mut self, nodes: &[u32]) {
        self.next_last.clear();
        self.next_last.extend(nodes);
    }

    /// Whether a factor over a graph of so many nodes is ordered by those expected.
    fn suits_last(&self, count: usize) -> bool {
        let surface = CONTROL.faces * (count as f64).powf(2.0 / 3.0);
        self.next_last.len() >= CONTROL.gathered && (self.next_last.len() as f64) <= surface
    }

    /// Makes the inverse of `matrix`: a factor in this `precision`, or what is good enough to iterate with if it may be `approximate`.
    ///
    /// # Errors
    /// If the matrix is not positive definite, or memory is lacking.
    pub fn make(
        &mut self,
        precision: Precision,
        approximate: bool,
        matrix: &NodalMatrix<Matrix<D>>,
    ) -> Result<(), FemError> {
        self.precision = precision;
        let suits = approximate && self.ties.is_empty();
        let entries = self.sharing.as_ref().map_or(matrix.values.len(), |s| s.graph.entry_count());
        if suits && entries >= CONTROL.many {
            if let Some(polynomial) = Chebyshev::of(matrix, self.sharing.as_ref())? {
                self.precision = Precision::Single;
                self.kind = Kind::Polynomial(Box::new(polynomial));
                return Ok(());
            }
        }
        if let Some(sharing) = &self.sharing {
            return make_shared(&mut self.kind, sharing, precision == Precision::Double, matrix);
        }
        self.make_factor(matrix, |_| precision)
    }

    /// Makes the exact inverse of `matrix`, in single precision if it is `economical` and the factor is large: one in double precision takes as
    /// much memory while it is made as it does afterwards.
    ///
    /// # Errors
    /// As [`Self::make`].
    pub fn make_exact(&mut self, economical: bool, matrix: &NodalMatrix<Matrix<D>>) -> Result<(), FemError> {
        if let Some(sharing) = &self.sharing {
            self.precision = Precision::Double;
            return make_shared(&mut self.kind, sharing, true, matrix);
        }
        let is_single = |values: usize| economical && values >= CONTROL.large;
        self.make_factor(
            matrix,
            |values| {
                if is_single(values) { Precision::Single } else { Precision::Double }
            },
        )
    }

    /// Makes a factor in the precision for so many values.
    fn make_factor(
        &mut self,
        matrix: &NodalMatrix<Matrix<D>>,
        precision: impl Fn(usize) -> Precision,
    ) -> Result<(), FemError> {
        if !self.suits_last(matrix.graph().node_count()) {
            self.next_last.clear();
        }
        if !matches!(self.kind, Kind::Factor(_)) || self.last != self.next_last {
            self.kind = Kind::None;
            self.last.clone_from(&self.next_last);
            self.kind = Kind::Factor(Box::new(Factor::new(matrix.graph(), &self.ties, &self.last)?));
        }
        match &mut self.kind {
            Kind::Factor(factor) => {
                self.precision = precision(factor.value_count());
                factor.factorize(self.precision, |entry| matrix.values[entry])
            }
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
            Kind::Polynomial(_) | Kind::Shared(_) => true,
        }
    }

    /// Whether it is exact but for round-off.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        match &self.kind {
            Kind::Factor(_) => true,
            Kind::Shared(shared) => shared.is_exact(),
            Kind::None | Kind::Polynomial(_) => false,
        }
    }

    /// Whether making it takes far longer than many solves.
    #[must_use]
    pub fn is_large(&self) -> bool {
        matches!(&self.kind, Kind::Factor(factor) if factor.value_count() >= CONTROL.large)
    }

    /// Memory [bytes].
    #[must_use]
    pub fn bytes(&self) -> usize {
        match &self.kind {
            Kind::None => 0,
            Kind::Factor(factor) => factor.bytes(),
            Kind::Polynomial(polynomial) => polynomial.bytes(),
            Kind::Shared(shared) => shared.bytes(),
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
            Kind::Shared(shared) => shared.begin(x),
        }
    }

    /// See [`Factor::end`].
    pub fn end(&mut self, x: &mut [Vector<D>]) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.end(x),
            Kind::Polynomial(polynomial) => polynomial.end(x),
            Kind::Shared(shared) => shared.end(x),
        }
    }

    /// See [`Factor::set_reach`].
    pub fn set_reach(&mut self, nodes: impl Iterator<Item = usize>) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.set_reach(nodes),
            Kind::Polynomial(polynomial) => polynomial.set_reach(nodes),
            Kind::Shared(shared) => shared.set_reach(nodes),
        }
    }

    /// See [`Factor::look`].
    pub fn look(&mut self) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.look(),
            Kind::Polynomial(polynomial) => polynomial.look(),
            Kind::Shared(shared) => shared.look(),
        }
    }

    /// See [`Factor::seen`].
    #[must_use]
    pub fn seen(&self, node: usize) -> Vector<D> {
        match &self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.seen(node),
            Kind::Polynomial(polynomial) => polynomial.seen(node),
            Kind::Shared(shared) => shared.seen(node),
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
            Kind::Shared(shared) => shared.respond(nodes),
        }
    }

    /// See [`Factor::response`].
    #[must_use]
    pub fn response(&self, number: usize, node: usize) -> Matrix<D> {
        match &self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.response(number, node),
            Kind::Polynomial(polynomial) => polynomial.response(number, node),
            Kind::Shared(shared) => shared.response(number, node),
        }
    }

    /// The place of a node in an order in which neighbours ask for [responses](Self::respond) at least cost.
    #[must_use]
    pub fn order(&self, node: usize) -> usize {
        match &self.kind {
            Kind::Factor(factor) => factor.order(node),
            Kind::None | Kind::Polynomial(_) | Kind::Shared(_) => node,
        }
    }

    /// See [`Factor::add`].
    pub fn add(&mut self, forces: impl Iterator<Item = (usize, Vector<D>)>) {
        match &mut self.kind {
            Kind::None => not_made(),
            Kind::Factor(factor) => factor.add(forces),
            Kind::Polynomial(polynomial) => polynomial.add(forces),
            Kind::Shared(shared) => shared.add(forces),
        }
    }
}

/// Makes the inverse of a matrix that others have a part of.
fn make_shared<const D: usize>(
    kind: &mut Kind<D>,
    sharing: &Sharing,
    exact: bool,
    matrix: &NodalMatrix<Matrix<D>>,
) -> Result<(), FemError> {
    if !matches!(kind, Kind::Shared(_)) {
        *kind = Kind::Shared(Box::new(Shared::new(sharing)));
    }
    match kind {
        Kind::Shared(shared) => shared.make(exact, matrix),
        _ => unreachable!("one was put there"),
    }
}

fn not_made() -> ! {
    unreachable!("a solve needs an inverse that was made")
}
