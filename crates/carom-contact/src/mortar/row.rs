//! What a multiplier sees: the integrals that become its row.

use carom_mesh::Vector;

use crate::Contact;
use crate::frame::frame;
use crate::path::Positions;
use crate::tolerances::MORTAR;

/// The integrals of a multiplier Φ over the part of the source that faces the target.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row<const D: usize> {
    /// ∫ Φ [m^(D−1)], or [m²] of a body of revolution.
    area: f64,
    /// The same without regard to what the target covers.
    whole: f64,
    /// ∫ Φ n with the outward normal of the source.
    normal: Vector<D>,
    /// ∫ Φ N_b for the nodes of the source.
    sources: Vec<(u32, f64)>,
    /// ∫ Φ N_c for the nodes of the target.
    targets: Vec<(u32, f64)>,
}

impl<const D: usize> Default for Row<D> {
    fn default() -> Self {
        Self { area: 0.0, whole: 0.0, normal: Vector::zeros(), sources: Vec::new(), targets: Vec::new() }
    }
}

impl<const D: usize> Row<D> {
    /// Empties the row and keeps its room.
    pub fn clear(&mut self) {
        (self.area, self.whole, self.normal) = (0.0, 0.0, Vector::zeros());
        self.sources.clear();
        self.targets.clear();
    }

    /// Adds to ∫ Φ over a whole part.
    pub fn add_whole(&mut self, size: f64) {
        self.whole += size;
    }

    /// Adds to ∫ Φ where the outward normal of the source is `normal`.
    pub fn add_covered(&mut self, size: f64, normal: &Vector<D>) {
        self.area += size;
        self.normal += normal * size;
    }

    /// Adds to ∫ Φ N_b.
    pub fn add_source(&mut self, node: u32, integral: f64) {
        add(&mut self.sources, node, integral);
    }

    /// Adds to ∫ Φ N_c.
    pub fn add_target(&mut self, node: u32, integral: f64) {
        add(&mut self.targets, node, integral);
    }

    /// The contact that the multiplier stands for where nodes are at `position`; none if the target does not cover it.
    pub fn contact(&self, position: &Positions<'_, D>) -> Option<Contact<D>> {
        if self.area <= MORTAR.covered * self.whole {
            return None;
        }
        let normal = (-self.normal).try_normalize(0.0)?;
        let share = |&(node, integral): &(u32, f64)| (node, integral / self.area);
        let sources = self.sources.iter().map(share);
        let targets = self.targets.iter().map(share).map(|(node, weight)| (node, -weight));
        Some(Contact::of_multiplier(self.area, frame(&normal), sources, targets, position))
    }
}

fn add(entries: &mut Vec<(u32, f64)>, node: u32, integral: f64) {
    match entries.iter_mut().find(|(n, _)| *n == node) {
        Some((_, sum)) => *sum += integral,
        None => entries.push((node, integral)),
    }
}
