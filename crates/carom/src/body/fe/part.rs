use std::ops::Range;

use carom_fem::Body;
use carom_mesh::Vector;

use super::load::Load;
use super::supports::Supports;
use crate::signal::Signal;

/// A body of finite elements in its place in the model, and what drives it.
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
}

impl<const D: usize> ModelBody<D> {
    /// A body that nothing drives.
    #[must_use]
    pub fn new(name: impl Into<String>, body: Body<D>, first_node: usize) -> Self {
        let supports = Supports::none(&body);
        let gravity = Vector::zeros();
        Self { name: name.into(), body, first_node, loads: Vec::new(), gravity, growth: None, supports }
    }

    /// The numbers of its nodes.
    #[must_use]
    pub fn nodes(&self) -> Range<usize> {
        self.first_node..self.first_node + self.body.node_count()
    }

    /// Which components of the displacement of every node are prescribed; empty where none is.
    pub(crate) fn held(&self) -> Vec<[bool; D]> {
        let held = self.body.held();
        let of_node = |node| std::array::from_fn(|component| held.holds(node, component));
        if held.is_empty() { Vec::new() } else { (0..self.body.node_count()).map(of_node).collect() }
    }
}
