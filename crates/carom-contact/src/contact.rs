use carom_mesh::cell::MAX_FACET_NODES;
use carom_mesh::{Matrix, Vector};
use smallvec::SmallVec;

use crate::frame::{carried, frame, lengths, stretched};
use crate::path::Positions;

/// What may touch at one place: gap, frame, and the stencil that maps nodal to relative motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact<const D: usize> {
    /// Distance along the normal [m]; negative = penetration. Of a mortar row the mean under its multiplier.
    pub gap: f64,
    /// Rows n, t₁, t₂; n points from the target to the source. Of [orthotropic](Self::stretch_frame) friction tangents are shorter than one.
    pub frame: Matrix<D>,
    /// The area that a reaction is spread over, so that the pressure is r_n over it. For a body in the plane it is a length
    /// [m], to be multiplied by the thickness, otherwise [m²]. 0 where a node stands for it.
    pub area: f64,
    /// How much larger its gap is than the way of its stencil along the normal [m]: an obstacle has one node, and is touched somewhere else.
    offset: f64,
    /// Without an allocation for a source node and the facet of a target.
    stencil: SmallVec<[(u32, f64); 1 + MAX_FACET_NODES]>,
    /// How many entries of the stencil are source nodes; they come first.
    sources: usize,
}

impl<const D: usize> Contact<D> {
    /// A contact of the node `source` with a target whose `nodes` follow the target point with these `weights`.
    pub(crate) fn new(gap: f64, frame: Matrix<D>, source: u32, target: &[u32], weights: &[f64]) -> Self {
        let target = target.iter().zip(weights).map(|(&node, &weight)| (node, -weight));
        let stencil = std::iter::once((source, 1.0)).chain(target).collect();
        Self { gap, frame, area: 0.0, offset: 0.0, stencil, sources: 1 }
    }

    /// The contact of a source point, which follows `nodes` with these `weights`, with the `obstacle` that has this number if it may move.
    pub(crate) fn before_obstacle(
        gap: f64,
        frame: Matrix<D>,
        nodes: &[u32],
        weights: &[f64],
        obstacle: Option<u32>,
    ) -> Self {
        let source = nodes.iter().zip(weights).map(|(&node, &weight)| (node, weight));
        let stencil = source.chain(obstacle.map(|node| (node, -1.0))).collect();
        Self { gap, frame, area: 0.0, offset: 0.0, stencil, sources: nodes.len() }
    }

    /// The contact of a point of an edge with one of a facet or of another edge, which follow nodes with these weights.
    pub(crate) fn of_edge(
        gap: f64,
        normal: &Vector<D>,
        source: &[(u32, f64)],
        target: impl Iterator<Item = (u32, f64)>,
    ) -> Self {
        let opposite = target.map(|(node, weight)| (node, -weight));
        Self {
            gap,
            frame: frame(normal),
            area: 0.0,
            offset: 0.0,
            stencil: source.iter().copied().chain(opposite).collect(),
            sources: source.len(),
        }
    }

    /// The contact of a multiplier that covers `area`: its gap is the mean of the offsets along the normal.
    pub(crate) fn of_multiplier(
        area: f64,
        frame: Matrix<D>,
        sources: impl ExactSizeIterator<Item = (u32, f64)>,
        targets: impl ExactSizeIterator<Item = (u32, f64)>,
        position: &Positions<'_, D>,
    ) -> Self {
        let source_count = sources.len();
        let stencil = sources.chain(targets).collect();
        Self { gap: 0.0, frame, area, offset: 0.0, stencil, sources: source_count }.moved(position)
    }

    /// A contact as it was: with what [`Self::stencil`] gave, of which the first `sources` entries are source nodes.
    ///
    /// # Panics
    /// If there are fewer entries.
    #[must_use]
    pub fn of_stencil(
        gap: f64,
        frame: Matrix<D>,
        area: f64,
        stencil: impl Iterator<Item = (u32, f64)>,
        sources: usize,
    ) -> Self {
        let stencil: SmallVec<_> = stencil.collect();
        assert!(sources <= stencil.len(), "source nodes are part of the stencil");
        Self { gap, frame, area, offset: 0.0, stencil, sources }
    }

    /// That of a candidate which its pair cannot have: as far from everything as can be, and nothing moves in it.
    pub(crate) fn with_nothing() -> Self {
        Self {
            gap: f64::MAX,
            frame: Matrix::identity(),
            area: 0.0,
            offset: 0.0,
            stencil: SmallVec::new(),
            sources: 0,
        }
    }

    /// Turns the tangents to where those of an earlier frame of the contact were (`carried` in frame.rs). A frame of zeros stands for none.
    pub fn carry_frame(&mut self, before: &Matrix<D>) {
        self.frame = carried(&self.frame, before);
    }

    /// Lays the first tangent along `direction` and makes the tangents as long as these `lengths`, so that an elliptic cone is a circular one; leaves
    /// the frame as it is where the direction stands on the surface.
    pub fn stretch_frame(&mut self, direction: &Vector<D>, lengths: [f64; 2]) {
        if let Some(frame) = stretched(&self.frame, direction, lengths) {
            self.frame = frame;
        }
    }

    /// Makes the tangents so many times as long.
    pub fn stretch_tangents(&mut self, by: [f64; 2]) {
        for (k, by) in (1..D).zip(by) {
            self.frame.row_mut(k).scale_mut(by);
        }
    }

    /// The components of a `force` [N] in the frame: the reaction whose force it is.
    #[must_use]
    pub fn components(&self, force: &Vector<D>) -> Vector<D> {
        let mut components = self.frame * force;
        for (k, length) in (1..D).zip(lengths(&self.frame)) {
            components[k] /= length * length;
        }
        components
    }

    /// How far along the surface a relative motion `w` goes that is given in the frame [m].
    #[must_use]
    pub fn distance(&self, w: &Vector<D>) -> f64 {
        let lengths = lengths(&self.frame);
        (1..D).zip(lengths).map(|(k, length)| (w[k] / length).powi(2)).sum::<f64>().sqrt()
    }

    /// The same contact, frame and stencil, with its gap where nodes are at `position`.
    #[must_use]
    pub fn moved(&self, position: &Positions<'_, D>) -> Self {
        Self { gap: self.relative(|n| position(n as u32))[0] + self.offset, ..self.clone() }
    }

    /// The same contact, whose gap was found where nodes are at `position`: how much of it the stencil does not say.
    pub(crate) fn anchored(mut self, position: &Positions<'_, D>) -> Self {
        self.offset = self.gap - self.relative(|n| position(n as u32))[0];
        self
    }

    /// How much larger its gap is than the way of its stencil along the normal [m].
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// The same contact with this [`Self::offset`] [m].
    #[must_use]
    pub fn with_offset(self, offset: f64) -> Self {
        Self { offset, ..self }
    }

    /// The nodes involved with their weights, source nodes first: of a single node +1, and minus the shape functions for the target.
    /// The weights of either side sum to ±1.
    #[inline]
    pub fn stencil(&self) -> impl ExactSizeIterator<Item = (usize, f64)> + Clone {
        self.stencil.iter().map(|&(node, weight)| (node as usize, weight))
    }

    /// The part of the stencil on the source.
    pub fn sources(&self) -> impl ExactSizeIterator<Item = (usize, f64)> + Clone {
        self.stencil().take(self.sources)
    }

    /// The point of the source [m] where nodes are at `position`.
    #[must_use]
    pub fn source_point(&self, position: &Positions<'_, D>) -> Vector<D> {
        self.sources().fold(Vector::zeros(), |x, (n, weight)| x + position(n as u32) * weight)
    }

    /// Where it is on the target [m], if that deforms or has nodes of its own.
    pub fn target_point(&self, position: &Positions<'_, D>) -> Vector<D> {
        self.targets().fold(Vector::zeros(), |x, (n, weight)| x - position(n as u32) * weight)
    }

    /// The part of the stencil on the target.
    pub fn targets(&self) -> impl ExactSizeIterator<Item = (usize, f64)> + Clone {
        self.stencil().skip(self.sources)
    }

    /// H d: the relative motion in the frame of a nodal motion `d`.
    #[inline]
    #[must_use]
    pub fn relative(&self, d: impl Fn(usize) -> Vector<D>) -> Vector<D> {
        self.frame * self.stencil().fold(Vector::zeros(), |s, (n, weight)| s + d(n) * weight)
    }

    /// Adds the nodal forces Hᵀ r [N] of a reaction `r` to `f`.
    #[inline]
    pub fn add_force(&self, r: &Vector<D>, f: &mut [Vector<D>]) {
        let force = self.frame.tr_mul(r);
        for (node, weight) in self.stencil() {
            f[node] += force * weight;
        }
    }
}

/// How the nodes of one side of a contact share what happens to it: in proportion to their weights, none of them negative.
pub fn shares(side: impl Iterator<Item = (usize, f64)> + Clone) -> impl Iterator<Item = (usize, f64)> {
    let whole: f64 = side.clone().map(|(_, weight)| weight.abs()).sum();
    side.map(move |(node, weight)| (node, weight.abs() / whole))
}
