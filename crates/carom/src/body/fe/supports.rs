use carom_fem::{Body, HeldDof};

use crate::signal::{Dual, Signal};

/// The displacement of some nodes of a body since a moment, component by component, as functions of time.
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
    /// Of a rigid body: angles by which it has turned about the axes of space [rad]; what is `None` is free. Its components are those of its
    /// centre of mass, and its nodes are not named.
    pub turns: [Option<Signal>; 3],
    /// Since when [s].
    pub since: f64,
}

/// What drives the held displacements of a body.
#[derive(Debug, Clone)]
pub(crate) struct Supports<const D: usize> {
    /// The motions of the body: the number of each in the model, and its components.
    motions: Vec<(usize, [Option<Signal>; D])>,
    /// For every held displacement, in the order of `Body::held`, the motion that drives it; `None` where symmetry holds it at zero.
    drivers: Vec<Option<u32>>,
}

impl<const D: usize> Supports<D> {
    /// Of a body that nothing but symmetry holds.
    pub fn none(body: &Body<D>) -> Self {
        Self { motions: Vec::new(), drivers: vec![None; body.held().dofs().len()] }
    }

    /// Holds what the `motions` of body `index` prescribe. Of two that prescribe the same displacement the first has it.
    pub fn of(index: usize, body: &mut Body<D>, motions: &[Motion<D>]) -> Self {
        let own: Vec<(usize, &Motion<D>)> =
            motions.iter().enumerate().filter(|(_, m)| m.body == index).collect();
        let masters = body.mesh().masters();
        let mut driver = vec![[None; D]; masters.len()];
        for (k, (_, motion)) in own.iter().enumerate() {
            // What moves alike is prescribed alike.
            let mut named = vec![false; masters.len()];
            motion.nodes.iter().for_each(|&n| named[masters[n as usize] as usize] = true);
            for (node, _) in masters.iter().enumerate().filter(|&(_, &m)| named[m as usize]) {
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
        body.hold(prescribed);
        let held = body.held().dofs().iter();
        Self {
            drivers: held.map(|dof| driver[dof.node as usize][dof.component as usize]).collect(),
            motions: own.into_iter().map(|(k, m)| (k, m.components.clone())).collect(),
        }
    }

    /// Displacement since its motion began [m] and velocity [m/s] at time `t` [s] of everything held, in the order of `Body::held`.
    pub fn at<'a>(&'a self, body: &'a Body<D>, t: f64) -> impl Iterator<Item = (&'a HeldDof, Dual)> {
        body.held().dofs().iter().zip(&self.drivers).map(move |(dof, driver)| {
            let signal = driver.and_then(|k| self.motions[k as usize].1[dof.component as usize].as_ref());
            (dof, signal.map_or_else(Dual::default, |signal| signal.at(t)))
        })
    }

    /// Whether its motions are where they were at another time [s], and stand still at both.
    pub fn stand_still(&self, times: [f64; 2]) -> bool {
        self.motions
            .iter()
            .flat_map(|(_, components)| components)
            .flatten()
            .all(|signal| signal.stands_still(times))
    }

    /// The numbers of its motions in the model.
    pub fn numbers(&self) -> impl Iterator<Item = usize> {
        self.motions.iter().map(|(number, _)| *number)
    }

    /// Everything that symmetry holds at zero.
    pub fn bound<'a>(&'a self, body: &'a Body<D>) -> impl Iterator<Item = &'a HeldDof> {
        body.held()
            .dofs()
            .iter()
            .zip(&self.drivers)
            .filter(|(_, driver)| driver.is_none())
            .map(|(dof, _)| dof)
    }

    /// Everything held that a motion drives, with its place in `Body::held` and the number of the motion in the model.
    pub fn driven<'a>(&'a self, body: &'a Body<D>) -> impl Iterator<Item = (&'a HeldDof, usize)> {
        let held = body.held().dofs().iter().zip(&self.drivers);
        held.filter_map(|(dof, driver)| Some((dof, self.motions[(*driver)? as usize].0)))
    }
}
