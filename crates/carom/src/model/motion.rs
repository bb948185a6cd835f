use carom_fem::HeldDof;
use carom_mesh::Vector;

use crate::Signal;
use crate::model::ModelBody;

/// The displacement of some nodes of a body, component by component, as functions of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion<const D: usize> {
    /// Name, for the history.
    pub name: String,
    /// Index of the body.
    pub body: usize,
    /// Nodes of the body.
    pub nodes: Vec<u32>,
    /// Displacement [m] of each component; what is `None` is free.
    pub components: [Option<Signal>; D],
}

/// Which motion drives each held displacement of a body; `None` where it is held at zero by symmetry.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Drivers(pub Vec<Option<u32>>);

impl Drivers {
    /// Holds what the `motions` of body `index` prescribe. Of two that prescribe the same displacement the first has it.
    pub fn of<const D: usize>(index: usize, body: &mut ModelBody<D>, motions: &[Motion<D>]) -> Self {
        let own = || motions.iter().enumerate().filter(|(_, m)| m.body == index);
        let masters = body.body.mesh().masters();
        let mut driver = vec![[None; D]; masters.len()];
        for (k, motion) in own() {
            // What moves alike is prescribed alike.
            let mut named = vec![false; masters.len()];
            motion.nodes.iter().for_each(|&n| named[masters[n as usize] as usize] = true);
            for (node, &master) in masters.iter().enumerate().filter(|&(_, &m)| named[m as usize]) {
                debug_assert!(master as usize <= masters.len());
                for (driver, signal) in driver[node].iter_mut().zip(&motion.components) {
                    if signal.is_some() && driver.is_none() {
                        *driver = Some(k as u32);
                    }
                }
            }
        }
        let prescribed = driver.iter().enumerate().flat_map(|(node, components)| {
            let of_node = components.iter().enumerate().filter(|(_, k)| k.is_some());
            of_node.map(move |(i, _)| HeldDof { node: node as u32, component: i as u8 })
        });
        body.body.hold(prescribed);
        let held = body.body.held().dofs().iter();
        Self(held.map(|dof| driver[dof.node as usize][dof.component as usize]).collect())
    }
}

/// How a rigid obstacle moves.
#[derive(Debug, Clone, PartialEq)]
pub enum ObstacleMotion<const D: usize> {
    /// At a constant velocity [m/s].
    Velocity(Vector<D>),
    /// By a displacement [m], component by component.
    Displacement(Box<[Signal; D]>),
}

impl<const D: usize> ObstacleMotion<D> {
    /// Velocity [m/s] at time `t` [s].
    #[must_use]
    pub fn velocity(&self, t: f64) -> Vector<D> {
        match self {
            Self::Velocity(v) => *v,
            Self::Displacement(signals) => Vector::from_fn(|i, _| signals[i].at(t).rate),
        }
    }

    /// Motion [m] from the displacement `u` at the start of a step to its end, at time `end` [s] after `dt` [s].
    #[must_use]
    pub fn increment(&self, u: &Vector<D>, end: f64, dt: f64) -> Vector<D> {
        match self {
            Self::Velocity(v) => v * dt,
            // The difference to where it is, so that round-off does not add up.
            Self::Displacement(signals) => Vector::from_fn(|i, _| signals[i].at(end).value - u[i]),
        }
    }
}
