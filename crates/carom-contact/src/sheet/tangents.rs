//! The tangent planes at corners of tiles, as linear functions of the positions of nodes.

use std::collections::BTreeMap;

use carom_mesh::Vector;

use super::combination::Combination;
use super::fit::Slope;
use super::network::{CornerOf, Half, Network, Passage, Sector};
use crate::path::Positions;
use crate::project::area_normal;

/// The least sine of the angle between two sharp edges at a corner for them to span its tangent plane.
const SPANS: f64 = 0.3;

/// The least cosine of the angle between a side and a tangent plane in which it still has a direction.
pub(super) const IN_PLANE: f64 = 0.2;

/// A plane at a node, tangential in the reference configuration, and the linear map from its coordinates to space that it moves with.
#[derive(Debug, Clone)]
pub(super) struct TangentPlane<const D: usize> {
    /// Unit vectors in the reference configuration.
    axes: [Vector<D>; 2],
    /// What they become [1].
    images: [Combination; 2],
}

impl<const D: usize> TangentPlane<D> {
    /// The coordinates of the part of a vector that is in the plane.
    fn coordinates(&self, x: &Vector<D>) -> [f64; 2] {
        self.axes.map(|axis| axis.dot(x))
    }

    /// What becomes of the vector with these coordinates.
    pub fn image(&self, coordinates: [f64; 2]) -> Combination {
        Combination::sum(coordinates.into_iter().zip(&self.images))
    }

    /// The plane in which two vectors are and become these `images`; none if they are close to parallel.
    fn spanned(vectors: [Vector<D>; 2], images: [&Combination; 2]) -> Option<Self> {
        let [a, b] = vectors;
        let normal = area_normal(&[a, b]);
        if normal.norm() <= SPANS * a.norm() * b.norm() {
            return None;
        }
        let first = a.normalize();
        let second = area_normal(&[normal.normalize(), first]);
        let across = b.dot(&second);
        let image = Combination::sum([(1.0 / a.norm(), images[0])]);
        let slant = b.dot(&first);
        let other = Combination::sum([(1.0 / across, images[1]), (-slant / across, &image)]);
        Some(Self { axes: [first, second], images: [image, other] })
    }

    /// The plane with this `normal` in which a function of second degree fits nodes `around` best. If an `edge` is given, the vector that is
    /// tangential to it and becomes its image is in the plane.
    fn fitted(
        node: u32,
        normal: &Vector<D>,
        edge: Option<(Vector<D>, &Combination)>,
        around: &[u32],
        reference: &Positions<'_, D>,
    ) -> Option<(Self, bool)> {
        let first = match edge {
            Some((along, _)) => along.normalize(),
            None => {
                let mut axis = Vector::<D>::zeros();
                axis[normal.iamin()] = 1.0;
                (axis - normal * normal.dot(&axis)).normalize()
            }
        };
        let upright = (normal - first * first.dot(normal)).normalize();
        let axes = [first, area_normal(&[upright, first])];
        let offsets: Vec<[f64; 2]> = around
            .iter()
            .map(|&n| {
                let offset = reference(n) - reference(node);
                axes.map(|axis| axis.dot(&offset))
            })
            .collect();
        let slope = Slope::fitted(&offsets, edge.is_some())?;
        let known = edge.map(|(along, image)| Combination::sum([(1.0 / along.norm(), image)]));
        let mut images = [Combination::default(), Combination::default()];
        for ((&n, offset), weights) in around.iter().zip(&offsets).zip(&slope.weights) {
            let mut rise = Combination::between(node, n);
            if let Some(known) = &known {
                rise = rise.plus(-offset[0], known);
            }
            for (image, weight) in images.iter_mut().zip(weights) {
                *image = image.plus(*weight, &rise);
            }
        }
        if let Some(known) = known {
            images[0] = known;
        }
        Some((Self { axes, images }, slope.is_quadratic))
    }
}

/// The tangents of a network of tiles.
pub(super) struct Tangents<'a, const D: usize> {
    network: &'a Network,
    reference: &'a Positions<'a, D>,
    /// Those of the sectors that are not flat.
    planes: Vec<Option<TangentPlane<D>>>,
    /// The slopes at their first node of sharp edges, from there to the second, over the whole edge.
    edges: BTreeMap<[u32; 2], Combination>,
}

impl<'a, const D: usize> Tangents<'a, D> {
    /// Those of a network.
    pub fn new(network: &'a Network, reference: &'a Positions<'a, D>) -> Self {
        let mut tangents = Self { network, reference, planes: Vec::new(), edges: BTreeMap::new() };
        let closed = |sector: &Sector| sector.is_closed && !sector.is_flat;
        tangents.planes =
            network.sectors.iter().map(|s| closed(s).then(|| tangents.fitted(s, None)).flatten()).collect();
        for sector in &network.sectors {
            for to in network.bounds(sector).into_iter().flatten() {
                tangents.add_edge([sector.node, to]);
            }
        }
        for (s, sector) in network.sectors.iter().enumerate() {
            if let Some(ends) = network.bounds(sector).filter(|_| !sector.is_flat) {
                tangents.planes[s] = tangents.bounded(sector, ends);
            }
        }
        tangents
    }

    /// The slope of the side of a tile that begins at a corner: there, or at its end, always over the whole side and along it.
    pub fn of_side(&self, (tile, side): CornerOf) -> [Combination; 2] {
        let cut = &self.network.tiles[tile as usize];
        let count = cut.nodes.len() as u32;
        let next = (side + 1) % count;
        let [a, b] = [side, next].map(|k| cut.nodes[k as usize]);
        let half = cut.halves[side as usize];
        let is_sharp = self.network.neighbours[tile as usize][side as usize].is_none();
        [((tile, side), [a, b], 1.0), ((tile, next), [b, a], -1.0)].map(|(corner, [from, to], sign)| {
            let own = if is_sharp { self.edges.get(&[from, to]).cloned() } else { None };
            let slope = own.or_else(|| {
                let plane = self.planes[self.sector_number(corner)].as_ref()?;
                Some(plane.image(self.direction(plane, from, to)?))
            });
            Combination::sum([(sign, &slope.unwrap_or_else(|| chord(from, to, half)))])
        })
    }

    /// The tangent plane at a corner: of its sector or, where that is flat, of the sides there.
    pub fn plane_at(&self, corner: CornerOf) -> Option<TangentPlane<D>> {
        if let Some(plane) = &self.planes[self.sector_number(corner)] {
            return Some(plane.clone());
        }
        let (tile, k) = corner;
        let count = self.network.tiles[tile as usize].nodes.len() as u32;
        let [out, _] = self.of_side(corner);
        let [_, back] = self.of_side((tile, (k + count - 1) % count));
        let back = Combination::sum([(-1.0, &back)]);
        TangentPlane::spanned([out.at(self.reference), back.at(self.reference)], [&out, &back])
    }

    /// Where a slope is in a tangent plane in the reference configuration.
    pub fn coordinates(&self, plane: &TangentPlane<D>, slope: &Combination) -> [f64; 2] {
        plane.coordinates(&slope.at(self.reference))
    }

    /// How long a slope is in the reference configuration.
    pub fn length(&self, slope: &Combination) -> f64 {
        slope.at(self.reference).norm()
    }

    /// The place of a side in a tangent plane at its end `from`: as long as an arc that leaves there in the plane and ends where the side does. None if the
    /// side leaves the plane so steeply that it has no direction in it.
    fn direction(&self, plane: &TangentPlane<D>, from: u32, to: u32) -> Option<[f64; 2]> {
        let chord = (self.reference)(to) - (self.reference)(from);
        let at = plane.coordinates(&chord);
        let cosine = (at[0].hypot(at[1]) / chord.norm()).min(1.0);
        // A cubic with slopes at both ends of length L/cos²(θ/4) is a circular arc to sixth order; half the angle θ is that to the chord L.
        (cosine >= IN_PLANE).then(|| at.map(|x| x * 2.0 / (cosine * (1.0 + cosine))))
    }

    fn sector_number(&self, (tile, corner): CornerOf) -> usize {
        self.network.sector_of[tile as usize][corner as usize] as usize
    }

    /// The plane that fits the nodes around a sector, of wider surroundings where those next to it do not know how it bends.
    fn fitted(&self, sector: &Sector, edge: Option<(Vector<D>, &Combination)>) -> Option<TangentPlane<D>> {
        let normal = self.network.normal(sector, self.reference);
        let fit = |widened: bool| {
            let around = self.network.nodes_around(sector, widened);
            TangentPlane::fitted(sector.node, &normal, edge, &around, self.reference)
        };
        match fit(false) {
            Some((plane, true)) => Some(plane),
            narrow => fit(true).or(narrow).map(|(plane, _)| plane),
        }
    }

    /// The plane of a sector between two sharp edges with these far `ends`.
    fn bounded(&self, sector: &Sector, ends: [u32; 2]) -> Option<TangentPlane<D>> {
        let slopes = ends.map(|to| self.edges.get(&[sector.node, to]));
        let [Some(first), Some(last)] = slopes else { return self.fitted(sector, None) };
        let along = first.at(self.reference);
        if self.network.passage(sector.node, ends[0]) == Passage::From(ends[1]) {
            return self.fitted(sector, Some((along, first)));
        }
        TangentPlane::spanned([along, last.at(self.reference)], [first, last])
            .or_else(|| self.fitted(sector, None))
    }

    /// Finds the slope at its first node of a sharp edge.
    fn add_edge(&mut self, nodes: [u32; 2]) {
        let [node, to] = nodes;
        if self.edges.contains_key(&nodes) {
            return;
        }
        let here = self.passing(node, to);
        // At a corner the edge bends as it does at its other end: it is a parabola.
        let slope = here.unwrap_or_else(|| match self.passing(to, node) {
            Some(there) => Combination::sum([(1.5, &Combination::between(node, to)), (0.5, &there)]),
            None => Combination::between(node, to),
        });
        self.edges.insert(nodes, slope);
    }

    /// The slope of a sharp edge at a node that it passes, or at which it fades out.
    fn passing(&self, node: u32, to: u32) -> Option<Combination> {
        let from = match self.network.passage(node, to) {
            Passage::From(from) => from,
            Passage::Fades => {
                let plane = self
                    .network
                    .sectors
                    .iter()
                    .zip(&self.planes)
                    .find(|(s, _)| s.node == node)?
                    .1
                    .as_ref()?;
                return Some(plane.image(self.direction(plane, node, to)?));
            }
            Passage::Corner => return None,
        };
        // That of the parabola through three nodes, with distances as parameter.
        let length = |n: u32| ((self.reference)(n) - (self.reference)(node)).norm();
        let (behind, before) = (length(from), length(to));
        let whole = behind + before;
        let terms = [
            (before / (behind * whole), &Combination::between(from, node)),
            (behind / (before * whole), &Combination::between(node, to)),
        ];
        let tangent = Combination::sum(terms);
        let direction = tangent.at(self.reference);
        let chord = (self.reference)(to) - (self.reference)(node);
        let cosine = (chord.dot(&direction) / (before * direction.norm())).clamp(IN_PLANE, 1.0);
        Some(Combination::sum([(2.0 * before / ((1.0 + cosine) * direction.norm()), &tangent)]))
    }
}

/// The slope at its end `from` of a straight side, or of half a side of a quadratic facet.
fn chord(from: u32, to: u32, half: Option<Half>) -> Combination {
    let Some(Half { middle, ends: [a, b] }) = half else { return Combination::between(from, to) };
    let far = if [from, to].contains(&a) { b } else { a };
    if from == middle {
        // Half of the way from one end to the other.
        return Combination::sum([(0.5, &Combination::between(far, to))]);
    }
    // The parabola through from, to and far: (−3 from + 4 to − far)/2.
    Combination::sum([(2.0, &Combination::between(from, to)), (-0.5, &Combination::between(from, far))])
}
