//! Where bodies are in a step.

use carom_mesh::Vector;

use crate::body::Ball;

/// Where bodies are in a step, as far as outlines are placed by it.
#[derive(Debug, Default)]
pub(crate) struct Whereabouts<const D: usize> {
    /// Of every body: the balls that hold its outline all the way through the step, none if all its nodes are placed.
    pub balls: Vec<Vec<Ball<D>>>,
    /// The box that it is in all the way, by its lowest and its highest corner [m].
    pub boxes: Vec<[Vector<D>; 2]>,
    /// Those that come near the body that is placed.
    pub near: Vec<usize>,
}

impl<const D: usize> Whereabouts<D> {
    /// Of so many bodies.
    pub fn new(bodies: usize) -> Self {
        Self { balls: vec![Vec::new(); bodies], boxes: vec![[Vector::zeros(); 2]; bodies], near: Vec::new() }
    }
}
