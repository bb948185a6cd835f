use std::ops::Range;

use carom_fem::{Body, KineticParts, Momenta};
use carom_mesh::Vector;

use super::load::Load;
use super::supports::Supports;
use crate::body::foreign::law::ForeignLaw;
use crate::body::reduced::part::ReducedPart;
use crate::body::reduced::vibrations::VibrationEnergies;
use crate::body::rigid::part::RigidPart;
use crate::body::rigid::shape::RigidSpec;
use crate::signal::Signal;

/// A body in its place in the model, and what drives it. Its cells are those of finite elements; of a rigid body they make the mass.
#[derive(Debug)]
pub struct ModelBody<const D: usize> {
    /// Name.
    pub name: String,
    /// The body itself.
    pub body: Body<D>,
    /// Number of its first node; nodes are numbered body after body.
    pub first_node: usize,
    /// Its loads.
    pub loads: Vec<Load<D>>,
    /// Gravity [m/s²].
    pub gravity: Vector<D>,
    /// The linear strain by which it would grow if nothing held it.
    pub growth: Option<Signal>,
    pub(crate) supports: Supports<D>,
    /// What makes it rigid, if it is.
    pub(crate) rigid: Option<RigidPart<D>>,
    /// What makes it reduced, if it is.
    pub(crate) reduced: Option<ReducedPart<D>>,
    /// The law of somebody else's code, if it is that which knows it.
    pub(crate) foreign: Option<ForeignLaw<D>>,
}

impl<const D: usize> ModelBody<D> {
    /// A body that nothing drives.
    #[must_use]
    pub fn new(name: impl Into<String>, body: Body<D>, first_node: usize) -> Self {
        let supports = Supports::none(&body);
        let gravity = Vector::zeros();
        Self {
            name: name.into(),
            body,
            first_node,
            loads: Vec::new(),
            gravity,
            growth: None,
            supports,
            rigid: None,
            reduced: None,
            foreign: None,
        }
    }

    /// The same, rigid: with the mass of its cells, but for what is said of it.
    #[must_use]
    pub(crate) fn rigid(self, spec: &RigidSpec<D>) -> Self {
        Self { rigid: Some(RigidPart::new(&self.body, spec)), ..self }
    }

    /// Whether its loads are the same at two times [s], and how far it has grown.
    pub(crate) fn is_loaded_alike(&self, [a, b]: [f64; 2]) -> bool {
        self.loads.iter().all(|load| load.is_alike([a, b])) && self.growth_at(a) == self.growth_at(b)
    }

    /// Whether it is rigid.
    #[must_use]
    pub fn is_rigid(&self) -> bool {
        self.rigid.is_some()
    }

    /// The same, reduced.
    pub(crate) fn reduced(self, part: ReducedPart<D>) -> Self {
        Self { reduced: Some(part), ..self }
    }

    /// The same, by somebody else's code.
    pub(crate) fn foreign(self, law: ForeignLaw<D>) -> Self {
        Self { foreign: Some(law), ..self }
    }

    /// Whether it is of somebody else's code.
    #[must_use]
    pub fn is_foreign(&self) -> bool {
        self.foreign.is_some()
    }

    /// Whether it is reduced to few shapes.
    #[must_use]
    pub fn is_reduced(&self) -> bool {
        self.reduced.is_some()
    }

    /// Number of its unknowns.
    #[must_use]
    pub fn dofs(&self) -> usize {
        if let Some(reduced) = &self.reduced {
            return reduced.dofs();
        }
        if let Some(law) = &self.foreign {
            return law.dofs(self.body.node_count());
        }
        self.rigid.as_ref().map_or_else(|| self.body.dofs(), RigidPart::dofs)
    }

    /// Speed of pressure waves in it [m/s], where it is lowest; none of a rigid body, in which they need no time, and of one whose law is not known.
    #[must_use]
    pub fn wave_speed(&self) -> Option<f64> {
        (!self.is_rigid() && !self.is_foreign()).then(|| self.body.wave_speed())
    }

    /// What it has of motion at these displacements [m] and velocities [m/s] of its nodes, where its kinetic energy is `kinetic` [J].
    #[must_use]
    pub fn momenta(&self, u: &[Vector<D>], v: &[Vector<D>], kinetic: f64) -> Momenta<D> {
        if let Some(reduced) = &self.reduced {
            return reduced.momenta(u, v, kinetic);
        }
        if let Some(law) = &self.foreign {
            return law.momenta(&self.places(u), v, kinetic);
        }
        let Some(rigid) = &self.rigid else { return self.body.momenta(u, v, kinetic) };
        let (momentum, angular_momentum) = rigid.momenta(u, v);
        let translation = 0.5 * momentum.norm_squared() / rigid.mass();
        let kinetic = KineticParts { translation, rotation: kinetic - translation, vibration: 0.0 };
        Momenta { momentum, angular_momentum, kinetic }
    }

    /// The vibrations of a reduced body at these displacements [m] and velocities [m/s] of its nodes; none of any other.
    #[must_use]
    pub fn vibrations(&self, u: &[Vector<D>], v: &[Vector<D>]) -> Option<VibrationEnergies> {
        self.reduced.as_ref().map(|reduced| reduced.vibrations(u, v))
    }

    /// The mean of a nodal vector by mass: the centre of mass of places.
    #[must_use]
    pub fn mean(&self, v: &[Vector<D>]) -> Vector<D> {
        match (&self.rigid, &self.foreign) {
            (Some(rigid), _) => rigid.shape.at_centre(v),
            (None, Some(law)) => law.mean(v),
            (None, None) => self.body.mean(v),
        }
    }

    /// Where its nodes are at these displacements [m].
    fn places(&self, u: &[Vector<D>]) -> Vec<Vector<D>> {
        self.body.mesh().nodes().iter().zip(u).map(|(x, u)| x + u).collect()
    }

    /// Its centre of mass [m], the velocity of that [m/s] and its mean spin [rad/s], with three components each, at these displacements [m] and
    /// velocities [m/s] of its nodes. Of a reduced body only those are asked that every step places.
    pub(crate) fn drift(&self, u: &[Vector<D>], v: &[Vector<D>]) -> [[f64; 3]; 3] {
        if let Some(reduced) = &self.reduced {
            return reduced.drift(u, v);
        }
        if let Some(rigid) = &self.rigid {
            return rigid.drift(u, v);
        }
        if let Some(law) = &self.foreign {
            return law.drift(&self.places(u), v);
        }
        let padded = |x: Vector<D>| std::array::from_fn(|i| if i < D { x[i] } else { 0.0 });
        [padded(self.body.centre(u)), padded(self.body.mean(v)), self.body.spin(u, v)]
    }

    /// The numbers of its nodes.
    #[must_use]
    pub fn nodes(&self) -> Range<usize> {
        self.first_node..self.first_node + self.body.node_count()
    }

    /// Which components of the displacement of every node are prescribed; empty where none is.
    pub(crate) fn held(&self) -> Vec<[bool; D]> {
        if let Some(rigid) = &self.rigid {
            let held = rigid.held();
            return if held == [false; D] { Vec::new() } else { vec![held; self.body.node_count()] };
        }
        if let Some(law) = &self.foreign {
            return law.held.clone();
        }
        let held = self.body.held();
        let of_node = |node| std::array::from_fn(|component| held.holds(node, component));
        if held.is_empty() { Vec::new() } else { (0..self.body.node_count()).map(of_node).collect() }
    }
}
