//! The motion of a reduced body over a step under forces that are known.
//!
//! A node moves by Δc + θ × R̄(X − C + Φη̄) + R̄ΦΔη, with R̄ = ½(R₀ + R₁) and η̄ = ½(η₀ + η₁): exactly, as θ is the vector of Cayley's rotation. So a force on it
//! works on what the body gets of it: its resultant, its moment by the mean arm, and the force R̄ᵀf on amplitudes.

use carom_mesh::{Matrix, Vector};

use super::part::{Reading, ReducedPart};
use super::place::{Place, Rates};
use crate::StepMap;
use crate::body::rigid::equation::Equation;
use crate::body::rigid::pose::{Displaced, lift, lower};
use crate::body::rigid::shape::Wrench;
use crate::scheme::StressRule;

/// Rounds between the rigid motion and the vibrations, each of which leaves of an error about the strain.
const ROUNDS: usize = 50;

/// What is less than this of the motion of nodes is the round-off of it.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// The motion of a reduced body in a step.
#[derive(Debug, Clone)]
pub(super) struct Moved {
    pub rigid: Displaced,
    /// Δη [m √kg].
    pub stretch: Vec<f64>,
}

impl Moved {
    /// None.
    pub fn of(count: usize) -> Self {
        Self { rigid: Displaced { shift: Vector::zeros(), turn: Vector::zeros() }, stretch: vec![0.0; count] }
    }

    /// The same as another motion, without new memory.
    pub fn copy(&mut self, other: &Self) {
        self.rigid = other.rigid;
        self.stretch.copy_from_slice(&other.stretch);
    }
}

/// The forces on a reduced body.
#[derive(Debug, Clone)]
pub(super) struct Forces<const D: usize> {
    /// What does not act on nodes.
    pub wrench: Wrench,
    /// f [N] at every node.
    pub at: Vec<Vector<D>>,
    /// The nodes that have one.
    pub pressed: Vec<u32>,
    is_pressed: Vec<bool>,
}

impl<const D: usize> Forces<D> {
    /// None on a body of so many nodes, of which these may be pressed on.
    pub fn none(nodes: usize, most: usize) -> Self {
        Self {
            wrench: Wrench::default(),
            at: vec![Vector::zeros(); nodes],
            pressed: Vec::with_capacity(most),
            is_pressed: vec![false; nodes],
        }
    }

    /// Takes all forces away but those that do not act on nodes, which become these.
    pub fn restart(&mut self, wrench: Wrench) {
        let Self { at, pressed, is_pressed, .. } = self;
        for node in pressed.drain(..).map(|n| n as usize) {
            at[node] = Vector::zeros();
            is_pressed[node] = false;
        }
        self.wrench = wrench;
    }

    /// Adds a force [N] at a node.
    pub fn add(&mut self, node: u32, force: &Vector<D>) {
        if *force == Vector::<D>::zeros() {
            return;
        }
        if !std::mem::replace(&mut self.is_pressed[node as usize], true) {
            self.pressed.push(node);
        }
        self.at[node as usize] += force;
    }
}

/// A step of a reduced body without contacts: how it starts, and what is the same for all forces.
#[derive(Debug, Clone)]
pub(super) struct ReducedEquation<const D: usize> {
    pub rigid: Equation,
    pub place: Place,
    pub rates: Rates,
    /// How amplitudes yield, one by one [m/N √kg √kg].
    pub compliance: Vec<f64>,
    /// η̄ where K̄ was made.
    pub mean: Vec<f64>,
    /// Φη at the start of every node that steps move [m].
    pub bent: Vec<Vector<D>>,
}

/// Damping of a mode with a stiffness [1/s].
#[inline]
fn damping<const D: usize>(part: &ReducedPart<D>, stiffness: f64) -> f64 {
    part.damping * stiffness
}

/// The share of the end of the step in the stress.
#[inline]
fn end_share(map: &StepMap) -> f64 {
    if map.stress == StressRule::Weighted { map.xi } else { 0.5 }
}

impl<const D: usize> ReducedEquation<D> {
    /// Makes the equation of a step in which the nodes start with these displacements [m] and velocities [m/s].
    pub fn begin(
        &mut self,
        part: &ReducedPart<D>,
        map: StepMap,
        [u, v]: [&[Vector<D>]; 2],
        reading: &mut Reading<D>,
    ) {
        let Self { rigid, place, rates, compliance, bent, .. } = self;
        part.place(u, reading, place);
        for node in part.moved.iter().map(|&n| n as usize) {
            bent[node] = part.reduction.displacement(node, &place.amplitudes);
        }
        let read = part.reduction.read_nodes().iter().map(|&n| bent[n as usize]);
        part.rates(&place.pose.rotation, read, v, reading, rates);
        *rigid = Equation::new(&part.shape, map, place.pose, rates.twist);
        for (own, &k) in compliance.iter_mut().zip(part.reduction.stiffness()) {
            let damped = damping(part, k) * map.damping_coefficient();
            *own = 1.0 / (map.mass_coefficient() + damped + end_share(&map) * k);
        }
    }

    /// Finds the motion under these forces, from the guess that `moved` is; `before` is scratch of as many amplitudes.
    pub fn solve(&self, part: &ReducedPart<D>, forces: &Forces<D>, moved: &mut Moved, before: &mut [f64]) {
        let map = &self.rigid.map;
        let size = part.shape.mass.sqrt();
        let mut last = f64::INFINITY;
        for _ in 0..ROUNDS {
            let mut wrench = forces.wrench;
            for &node in &forces.pressed {
                let arm = self.mean_arm(part, &moved.stretch, node as usize);
                wrench.add(&arm, &lift(&forces.at[node as usize]));
            }
            let rigid = self.rigid.solve(&wrench, &moved.rigid);
            let change = (rigid.shift - moved.rigid.shift).norm() * size;
            moved.rigid = rigid;
            before.copy_from_slice(&moved.stretch);
            self.force_on_amplitudes(part, forces, &rigid, &mut moved.stretch);
            let mut change = change;
            let starts = self.place.amplitudes.iter().zip(&self.rates.amplitudes);
            let modes = part.reduction.stiffness().iter().zip(&self.compliance);
            for (((g, before), (a0, v0)), (&k, c)) in
                moved.stretch.iter_mut().zip(&*before).zip(starts).zip(modes)
            {
                let carried = v0 * (1.0 - map.velocity_of_velocity) / map.dt;
                let seen = (1.0 - map.xi) + map.xi * map.velocity_of_velocity;
                *g = (*g + carried - damping(part, k) * seen * v0 - k * a0) * c;
                change += (*g - before).abs();
            }
            if forces.pressed.is_empty() || change.is_nan() || change >= last || change == 0.0 {
                break;
            }
            last = change;
        }
    }

    /// X − C + Φη̄ of a node that steps move [m].
    #[inline]
    pub fn mean_arm(&self, part: &ReducedPart<D>, stretch: &[f64], node: usize) -> Vector<3> {
        self.arm_half_way(part, &part.reduction.displacement(node, stretch), node)
    }

    /// The same where ΦΔη is known [m].
    #[inline]
    fn arm_half_way(&self, part: &ReducedPart<D>, stretched: &Vector<D>, node: usize) -> Vector<3> {
        part.shape.arm(node) + lift(&(self.bent[node] + stretched * 0.5))
    }

    /// Writes Φᵀ R̄ᵀ f to `out`.
    pub fn force_on_amplitudes(
        &self,
        part: &ReducedPart<D>,
        forces: &Forces<D>,
        rigid: &Displaced,
        out: &mut [f64],
    ) {
        let mean = rigid.mean_rotation(&self.place.pose);
        out.fill(0.0);
        for &node in &forces.pressed {
            let own = lower::<D>(&mean.tr_mul(&lift(&forces.at[node as usize])));
            part.reduction.add_force(node as usize, &own, out);
        }
    }

    /// The motion of a node [m], where ½(R₀ + R₁) is `mean`.
    #[inline]
    pub fn motion(&self, part: &ReducedPart<D>, moved: &Moved, mean: &Matrix<3>, node: usize) -> Vector<D> {
        let stretch = part.reduction.displacement(node, &moved.stretch);
        let arm = self.arm_half_way(part, &stretch, node);
        let Displaced { shift, turn } = moved.rigid;
        lower(&(shift + turn.cross(&(mean * arm)) + mean * lift(&stretch)))
    }

    /// Finds the motion in which the nodes that are read move as `asked` [m], from the guess that `moved` is, in which they move as `told` [m] where that
    /// is known. Returns whether it has become another than that.
    pub fn read(
        &self,
        part: &ReducedPart<D>,
        asked: impl Fn(usize) -> Vector<D>,
        told: Option<&[Vector<D>]>,
        moved: &mut Moved,
        reading: &mut Reading<D>,
    ) -> bool {
        let Reading { local, content, .. } = reading;
        let mut last = f64::INFINITY;
        for round in 0..ROUNDS {
            let mean = moved.rigid.mean_rotation(&self.place.pose);
            let told = told.filter(|_| round == 0);
            let (mut size, mut whole) = (0.0_f64, 0.0_f64);
            for (local, node) in local.iter_mut().zip(part.reduction.read_nodes().iter().map(|&n| n as usize))
            {
                let asked = asked(node);
                let own = told.map_or_else(|| self.motion(part, moved, &mean, node), |told| told[node]);
                let left = asked - own;
                size = size.max(left.norm_squared());
                whole = whole.max(asked.norm_squared());
                *local = lower(&mean.tr_mul(&lift(&left)));
            }
            if size.is_nan() || size >= last || size <= ROUND_OFF * ROUND_OFF * whole {
                return round > 0;
            }
            last = size;
            part.reduction.read(local, content);
            moved.rigid.shift += mean * lift(&content.shift);
            moved.rigid.turn += mean * Vector::<3>::from(content.turn);
            moved.stretch.iter_mut().zip(&content.amplitudes).for_each(|(d, a)| *d += a);
        }
        true
    }

    /// Velocities of amplitudes at the end of the step.
    pub fn end_rates(&self, stretch: &[f64], out: &mut [f64]) {
        let map = &self.rigid.map;
        for ((out, d), v) in out.iter_mut().zip(stretch).zip(&self.rates.amplitudes) {
            *out = map.velocity_of_velocity * v + map.velocity_of_motion * d;
        }
    }

    /// What damping takes [J], and the scheme from the vibrations, where they end at these `rates`.
    pub fn taken(&self, part: &ReducedPart<D>, stretch: &[f64], rates: &[f64]) -> [f64; 2] {
        let map = &self.rigid.map;
        let (mut damped, mut scheme) = (0.0, 0.0);
        let motions = stretch.iter().zip(&self.rates.amplitudes).zip(rates);
        for (((d, v0), v1), &k) in motions.zip(part.reduction.stiffness()) {
            damped += damping(part, k) * ((1.0 - map.xi) * v0 + map.xi * v1) * d;
            scheme += map.kinetic_dissipation * (v1 - v0) * (v1 - v0) + map.strain_dissipation * k * d * d;
        }
        [damped, scheme]
    }
}
