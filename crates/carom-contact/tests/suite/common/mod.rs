//! A target and a source that is placed freely behind it, in the plane and in space.

use carom_contact::{Candidate, Contact, ContactModel, ContactSurface, Discretisation, Pair, Target};
use carom_mesh::{Mesh, Surface, Vector};

/// A target and, behind its nodes, a source.
pub struct Scene<const D: usize> {
    pub model: ContactModel<D>,
    pub reference: Vec<Vector<D>>,
    /// The first node of the source.
    pub probe: u32,
}

impl<const D: usize> Scene<D> {
    /// The nodes of `target`, moved to `shape`, are the reference configuration of the target.
    pub fn new(
        target: &Mesh<D>,
        shape: impl Fn(Vector<D>) -> Vector<D>,
        source: &Mesh<D>,
        is_smooth: bool,
    ) -> Self {
        let probe = target.nodes().len() as u32;
        let reference: Vec<Vector<D>> =
            target.nodes().iter().map(|&x| shape(x)).chain(source.nodes().iter().copied()).collect();
        let at = |n: u32| reference[n as usize];
        let faceted = ContactSurface::new(&Surface::of(target), 0, &at);
        let target = if is_smooth { faceted.smoothed(&at) } else { faceted };
        let model = ContactModel {
            surfaces: vec![target, ContactSurface::new(&Surface::of(source), probe, &at)],
            obstacles: vec![],
            pairs: vec![Pair {
                source: 1,
                target: Target::Surface(0),
                friction: 0.3,
                discretisation: Discretisation::NodeToSegment,
            }]
            .into(),
        };
        Self { model, reference, probe }
    }

    /// The first node of the source at `x`, the others at `nodes`, where it started over the facet `facet`.
    pub fn contact(&self, nodes: &[Vector<D>], x: Vector<D>, facet: u32) -> Contact<D> {
        let at = |n: u32| if n == self.probe { x } else { nodes[n as usize] };
        self.model.evaluate(&Candidate::at_node(0, self.probe, Some(facet)), &at)
    }

    /// The facet whose corners are closest to `x`.
    pub fn facet(&self, nodes: &[Vector<D>], x: &Vector<D>) -> u32 {
        let facets = self.model.surfaces[0].facets.iter().enumerate();
        let middle = |corners: &[u32]| {
            corners.iter().map(|&n| nodes[n as usize]).sum::<Vector<D>>() / corners.len() as f64
        };
        let distance = facets
            .map(|(f, facet)| ((middle(&facet.nodes[..facet.kind.corner_count()]) - x).norm(), f as u32));
        distance.min_by(|a, b| a.0.total_cmp(&b.0)).expect("a surface has facets").1
    }
}
