//! The sides of a boundary at its nodes.

use std::collections::BTreeMap;

use carom_mesh::Facet;
use smallvec::SmallVec;

use crate::curve::smooth_neighbour;
use crate::parts::parts;
use crate::path::Positions;
use crate::sheet::Network;

/// Which of the facets around a node are on one side of it: those that go on into one another without a corner or an edge.
///
/// A node on smooth ground has one side, a corner in the plane two, and in space a node on a sharp edge two and the corner of a block three.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Sides {
    /// The sides of the nodes of every facet, each a number from 0 on among the sides of its node; empty where every node has one side.
    of_facets: Vec<SmallVec<[u32; 4]>>,
}

impl Sides {
    /// Those of `facets`; `around` are the facets around a node, `reference` the positions [m] without deformation.
    pub fn of<'a, const D: usize>(
        facets: &[Facet],
        around: &impl Fn(u32) -> &'a [u32],
        reference: &Positions<'_, D>,
    ) -> Self {
        let fans =
            if D == 2 { fans_in_plane(facets, around, reference) } else { fans_in_space(facets, reference) };
        // The fans that were met at every node, in the order of the facets.
        let mut met: BTreeMap<u32, SmallVec<[u32; 4]>> = BTreeMap::new();
        let mut number = |node: u32, fan: u32| {
            let met = met.entry(node).or_default();
            met.iter().position(|&other| other == fan).unwrap_or_else(|| {
                met.push(fan);
                met.len() - 1
            }) as u32
        };
        let numbers = |(facet, fans): (&Facet, SmallVec<[u32; 4]>)| {
            facet.nodes.iter().zip(fans).map(|(&node, fan)| number(node, fan)).collect()
        };
        let of_facets: Vec<SmallVec<[u32; 4]>> = facets.iter().zip(fans).map(numbers).collect();
        let is_smooth = of_facets.iter().flatten().all(|&side| side == 0);
        Self { of_facets: if is_smooth { Vec::new() } else { of_facets } }
    }

    /// That of node `a` of the facet `f`.
    pub fn of_facet(&self, f: u32, a: usize) -> u32 {
        self.of_facets.get(f as usize).map_or(0, |sides| sides[a])
    }
}

/// The fan around each node of every line: the number of its first facet.
fn fans_in_plane<'a, const D: usize>(
    facets: &[Facet],
    around: &impl Fn(u32) -> &'a [u32],
    reference: &Positions<'_, D>,
) -> Vec<SmallVec<[u32; 4]>> {
    let fan = |f: u32, a: usize| match a {
        0 | 1 => smooth_neighbour(facets, f, a, around, reference).map_or(f, |g| g.min(f)),
        _ => f,
    };
    (0..).zip(facets).map(|(f, facet)| (0..facet.nodes.len()).map(|a| fan(f, a)).collect()).collect()
}

/// The fan around each node of every facet: the number of its sector.
fn fans_in_space<const D: usize>(facets: &[Facet], reference: &Positions<'_, D>) -> Vec<SmallVec<[u32; 4]>> {
    let network = Network::new(facets, reference);
    let mut fans: Vec<SmallVec<[u32; 4]>> =
        facets.iter().map(|f| SmallVec::from_elem(0, f.nodes.len())).collect();
    let parts =
        facets.iter().enumerate().flat_map(|(f, facet)| parts(facet.kind).iter().map(move |part| (f, part)));
    for ((f, (_, corners)), sectors) in parts.zip(&network.sector_of) {
        corners.iter().zip(sectors).for_each(|(&a, &sector)| fans[f][a] = sector);
    }
    fans
}

#[cfg(test)]
mod tests {
    use carom_mesh::{CellKind, Mesh, Surface, generate};

    use super::*;
    use crate::ContactSurface;

    /// How many sides every node of the boundary of a mesh has.
    fn side_counts<const D: usize>(mesh: &Mesh<D>) -> BTreeMap<u32, usize> {
        let at = |n: u32| mesh.nodes()[n as usize];
        let surface = ContactSurface::new(&Surface::of(mesh), 0, &at).sided(&at);
        let mut sides: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (f, facet) in (0..).zip(&surface.facets) {
            for (a, &n) in facet.nodes.iter().enumerate() {
                sides.entry(n).or_default().push(surface.side(f, a));
            }
        }
        let count = |(n, mut sides): (u32, Vec<u32>)| {
            sides.sort_unstable();
            sides.dedup();
            assert!(sides.iter().copied().eq(0..sides.len() as u32), "numbered from 0 on");
            (n, sides.len())
        };
        sides.into_iter().map(count).collect()
    }

    fn block<const D: usize>(kinds: impl Iterator<Item = CellKind>) {
        for kind in kinds {
            let block = generate::Grid { corner: [0.0; D], size: [1.0; D], divisions: [2; D] };
            let mesh = block.mesh(kind).expect("valid");
            for (n, count) in side_counts(&mesh) {
                let planes = mesh.nodes()[n as usize].iter().filter(|&&x| x == 0.0 || x == 1.0).count();
                assert_eq!(count, planes, "{kind:?}, node at {}", mesh.nodes()[n as usize]);
            }
        }
    }

    /// Two at the corner of a rectangle, in space two along an edge and three at a corner, whatever the cells.
    #[test]
    fn nodes_of_a_block_have_a_side_for_every_plane_that_they_are_on() {
        let of = |dimension: usize| CellKind::ALL.into_iter().filter(move |k| k.dimension() == dimension);
        block::<2>(of(2));
        block::<3>(of(3));
    }

    /// A polygon of eight sides turns by 45° at every node. With nodes in the middle of its arcs each half turns by 22.5°.
    #[test]
    fn round_boundaries_have_one_side_where_they_turn_by_less_than_40_degrees() {
        let disc = |divisions, kind| {
            let disc = generate::Disc { centre: [0.0; 2], radius: 1.0, divisions, rings: Some(1) };
            side_counts(&disc.mesh(kind).expect("valid")).into_values().max()
        };
        assert_eq!(disc(2, CellKind::Quad4), Some(2));
        assert_eq!(disc(3, CellKind::Quad4), Some(1));
        assert_eq!(disc(2, CellKind::Quad9), Some(1));
    }
}
