//! What somebody else's code says of a body, and how such a body moves as a whole.

use std::fmt;
use std::sync::Arc;

use carom_fem::{KineticParts, Momenta};
use carom_mesh::{Matrix, Vector, nodal, tensor};

use super::code::{Blocks, ForeignCode};

/// A body of somebody else's beside its nodes: its mass and its law.
#[derive(Clone)]
pub struct ForeignLaw<const D: usize> {
    /// Mass matrix [kg].
    pub mass: Blocks<D>,
    /// Which components of the motion of every node are held; none if empty.
    pub held: Vec<[bool; D]>,
    /// Velocities of its nodes at the start [m/s].
    pub velocity: Vec<Vector<D>>,
    /// Energy, force and stiffness.
    pub code: Arc<dyn ForeignCode<D>>,
}

impl<const D: usize> fmt::Debug for ForeignLaw<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mass, held, velocity, .. } = self;
        let mut shown = f.debug_struct("ForeignLaw");
        shown.field("mass", mass).field("held", held).field("velocity", velocity).finish_non_exhaustive()
    }
}

/// How it moves: centre of mass [m], velocity of that [m/s], spin [rad/s], and the momenta.
struct Whole<const D: usize> {
    centre: Vector<D>,
    velocity: Vector<D>,
    spin: Vector<3>,
    momentum: Vector<D>,
    /// About the centre [kg m²/s].
    moment: Vector<3>,
}

impl<const D: usize> ForeignLaw<D> {
    /// Its mass [kg].
    #[must_use]
    pub fn total_mass(&self) -> f64 {
        self.mass.iter().map(|(_, _, block)| block.trace()).sum::<f64>() / D as f64
    }

    /// The number of its unknowns, of so many nodes.
    pub(crate) fn dofs(&self, nodes: usize) -> usize {
        D * nodes - self.held.iter().flatten().filter(|&&held| held).count()
    }

    /// The mass of every node of a body of so many [kg]: the sum of its row, in the mean of the directions.
    pub(crate) fn nodal_mass(&self, nodes: usize) -> Vec<f64> {
        let mut sums = vec![0.0; nodes];
        self.mass.iter().for_each(|(a, _, block)| sums[*a as usize] += block.trace() / D as f64);
        sums
    }

    /// The mass by which every node of a body of so many resists what moves it alone [kg]: the sum of its row without signs.
    pub(crate) fn nodal_inertia(&self, nodes: usize) -> Vec<f64> {
        let mut sums = vec![0.0; nodes];
        let size = |block: &Matrix<D>| block.trace().abs() / D as f64;
        self.mass.iter().for_each(|(a, _, block)| sums[*a as usize] += size(block));
        sums
    }

    /// M times a nodal vector.
    fn times_mass(&self, v: &[Vector<D>]) -> Vec<Vector<D>> {
        let mut out = vec![Vector::zeros(); v.len()];
        self.mass.iter().for_each(|(a, b, block)| out[*a as usize] += block * v[*b as usize]);
        out
    }

    /// The mean of a nodal vector by mass.
    pub(crate) fn mean(&self, v: &[Vector<D>]) -> Vector<D> {
        nodal::total(&self.times_mass(v)) / self.total_mass()
    }

    /// Nodes at places `x` [m] with velocities `v` [m/s], whose momenta `of_mass` says. The spin is that of the rigid motion with the same momenta.
    fn whole(&self, [x, v]: [&[Vector<D>]; 2], of_mass: impl Fn(&[Vector<D>]) -> Vec<Vector<D>>) -> Whole<D> {
        let centre = self.mean(x);
        let arms: Vec<Vector<D>> = x.iter().map(|x| x - centre).collect();
        let momenta = of_mass(v);
        let turning = |of: &[Vector<D>]| -> Vector<3> {
            arms.iter().zip(of).map(|(arm, p)| Vector::<3>::from(tensor::cross(arm, p))).sum()
        };
        let (momentum, moment) = (nodal::total(&momenta), turning(&momenta));
        let mut inertia = Matrix::<3>::identity();
        for axis in if D == 3 { 0..3 } else { 2..3 } {
            let unit: [f64; 3] = std::array::from_fn(|i| f64::from(u8::from(i == axis)));
            let turned: Vec<Vector<D>> = arms.iter().map(|y| tensor::rotation_velocity(&unit, y)).collect();
            inertia.set_column(axis, &turning(&of_mass(&turned)));
        }
        let spin = tensor::inverse(&inertia).0 * moment;
        // A body without extent cannot turn.
        let spin = if spin.iter().all(|s| s.is_finite()) { spin } else { Vector::zeros() };
        Whole { centre, velocity: momentum / self.total_mass(), spin, momentum, moment }
    }

    /// Its centre of mass [m], the velocity of that [m/s] and its mean spin [rad/s], by masses of nodes as that of every body, where these are at `x` [m]
    /// and have velocities `v` [m/s].
    pub(crate) fn drift(&self, x: &[Vector<D>], v: &[Vector<D>]) -> [[f64; 3]; 3] {
        let masses = self.nodal_mass(x.len());
        let lumped = |v: &[Vector<D>]| v.iter().zip(&masses).map(|(v, &m)| v * m).collect();
        let Whole { centre, velocity, spin, .. } = self.whole([x, v], lumped);
        let padded = |x: Vector<D>| std::array::from_fn(|i| if i < D { x[i] } else { 0.0 });
        [padded(centre), padded(velocity), spin.into()]
    }

    /// What it has of motion, where its kinetic energy is `kinetic` [J].
    pub(crate) fn momenta(&self, x: &[Vector<D>], v: &[Vector<D>], kinetic: f64) -> Momenta<D> {
        let Whole { centre, velocity, spin, momentum, moment } = self.whole([x, v], |v| self.times_mass(v));
        let about_origin = moment + Vector::<3>::from(tensor::cross(&centre, &momentum));
        let (translation, rotation) = (0.5 * momentum.dot(&velocity), 0.5 * moment.dot(&spin));
        let kinetic = KineticParts { translation, rotation, vibration: kinetic - translation - rotation };
        Momenta { momentum, angular_momentum: about_origin.into(), kinetic }
    }
}
