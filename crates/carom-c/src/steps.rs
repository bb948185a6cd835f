//! The steps of [`PlantedContact`] without its dimension: flat arrays in, flat arrays out, one row for each point or contact.

use carom::{PairLedger, PlantedContact, PlantedStep, StepError};
use carom_contact::{Candidate, Site};
use carom_friction::{Matrix, SolveReport};
use carom_mesh::Vector;

/// Contact in the plane or in space. Arrays have the right sizes.
pub trait Steps: Send {
    /// See [`PlantedContact::search`].
    fn search(
        &mut self,
        points: &[f64],
        velocity: &[f64],
        dt: f64,
        reach: Option<f64>,
    ) -> Result<(), StepError>;
    /// See [`PlantedContact::evaluate`].
    fn evaluate(&mut self, points: &[f64]);
    /// See [`PlantedContact::solve`]; W is dense.
    fn solve(&mut self, w: &[f64], free: &[f64]) -> Result<SolveReport, StepError>;
    /// See [`PlantedContact::missed`].
    fn missed(&mut self, points: &[f64]) -> Result<bool, StepError>;
    /// See [`PlantedContact::accept`]; with what was done by the numbers of pairs.
    fn accept(&mut self, points: &[f64]) -> (PlantedStep, Vec<(usize, PairLedger)>);
    /// See [`PlantedContact::set_reactions`].
    fn set_reactions(&mut self, reactions: &[f64]);
    /// How many take part.
    fn count(&self) -> usize;
    /// The number of the pair of every contact.
    fn pairs(&self) -> Vec<usize>;
    /// The source node of every contact, by the caller's numbers.
    fn nodes(&self) -> Vec<Option<u32>>;
    /// Gaps [m].
    fn gaps(&self) -> Vec<f64>;
    /// Frames, row by row.
    fn frames(&self) -> Vec<f64>;
    /// Friction coefficients.
    fn friction(&self) -> Vec<f64>;
    /// What motions lack of the variables of the laws [m].
    fn offsets(&self) -> Vec<f64>;
    /// Reactions [N].
    fn reactions(&self) -> Vec<f64>;
    /// Calls back with (contact, node of the caller, weight).
    fn each_weight(&self, each: &mut dyn FnMut(usize, u32, f64));
    /// The two names of a pair by its number.
    fn pair_names(&self, number: usize) -> Option<[String; 2]>;
    /// The number of the pair of two names, in either order.
    fn pair_of(&self, names: &[String; 2]) -> Option<usize>;
    /// Time [s].
    fn time(&self) -> f64;
}

/// One vector for every D numbers.
pub fn vectors<const D: usize>(flat: &[f64]) -> Vec<Vector<D>> {
    flat.chunks_exact(D).map(Vector::from_column_slice).collect()
}

/// The numbers of vectors.
pub fn flat<const D: usize>(vectors: impl IntoIterator<Item = Vector<D>>) -> Vec<f64> {
    vectors.into_iter().flat_map(|v| v.data.0[0]).collect()
}

impl<const D: usize> Steps for PlantedContact<D> {
    fn search(
        &mut self,
        points: &[f64],
        velocity: &[f64],
        dt: f64,
        reach: Option<f64>,
    ) -> Result<(), StepError> {
        PlantedContact::search(self, &vectors(points), &vectors(velocity), dt, reach)
    }

    fn evaluate(&mut self, points: &[f64]) {
        PlantedContact::evaluate(self, &vectors(points));
    }

    fn solve(&mut self, w: &[f64], free: &[f64]) -> Result<SolveReport, StepError> {
        let width = free.len();
        let block = |i: usize, j: usize| Matrix::from_fn(|a, b| w[(i * D + a) * width + j * D + b]);
        PlantedContact::solve(self, block, &vectors(free))
    }

    fn missed(&mut self, points: &[f64]) -> Result<bool, StepError> {
        PlantedContact::missed(self, &vectors(points))
    }

    fn accept(&mut self, points: &[f64]) -> (PlantedStep, Vec<(usize, PairLedger)>) {
        let step = PlantedContact::accept(self, &vectors(points));
        let pairs = &self.assembly().contact.pairs;
        let done = step.pairs.iter().map(|(between, work)| (pairs.place(between), *work)).collect();
        (step, done)
    }

    fn set_reactions(&mut self, reactions: &[f64]) {
        PlantedContact::set_reactions(self, &vectors(reactions));
    }

    fn count(&self) -> usize {
        self.candidates().len()
    }

    fn pairs(&self) -> Vec<usize> {
        let pairs = &self.assembly().contact.pairs;
        let number = |c: &Candidate| pairs.place(pairs.get(c.pair as usize).between());
        self.candidates().iter().map(number).collect()
    }

    fn nodes(&self) -> Vec<Option<u32>> {
        let node = |site: Site| match site {
            Site::Node(node) | Site::Multiplier(node, _) | Site::Second(node) => {
                self.callers_node(node as usize)
            }
            _ => None,
        };
        self.candidates().iter().map(|c| node(c.site)).collect()
    }

    fn gaps(&self) -> Vec<f64> {
        self.contacts().iter().map(|c| c.gap).collect()
    }

    fn frames(&self) -> Vec<f64> {
        // nalgebra stores a matrix by columns.
        self.contacts().iter().flat_map(|c| c.frame.transpose().data.0).flatten().collect()
    }

    fn friction(&self) -> Vec<f64> {
        PlantedContact::friction(self).to_vec()
    }

    fn offsets(&self) -> Vec<f64> {
        flat(PlantedContact::offsets(self))
    }

    fn reactions(&self) -> Vec<f64> {
        flat(PlantedContact::reactions(self).iter().copied())
    }

    fn each_weight(&self, each: &mut dyn FnMut(usize, u32, f64)) {
        for (i, contact) in self.contacts().iter().enumerate() {
            for (node, weight) in contact.stencil() {
                // What is no node of the caller is an obstacle, whose motion is prescribed.
                if let Some(node) = self.callers_node(node) {
                    each(i, node, weight);
                }
            }
        }
    }

    fn pair_names(&self, number: usize) -> Option<[String; 2]> {
        let between = self.assembly().contact.pairs.at_place(number)?;
        Some(between.map(|solid| self.assembly().solid_name(solid).to_string()))
    }

    fn pair_of(&self, names: &[String; 2]) -> Option<usize> {
        let between = self.assembly().between(names)?;
        Some(self.assembly().contact.pairs.place(between))
    }

    fn time(&self) -> f64 {
        PlantedContact::time(self)
    }
}
