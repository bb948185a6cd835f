//! Smooth surfaces in space: tiles through the nodes of a boundary, with one tangent plane where they meet.
//!
//! Every facet is a tile between its nodes; a quadratic one is cut into several. Tiles are Gregory patches (`gregory.rs`): a cubic curve along every
//! side, and a slope across it in which both tiles agree (`tile.rs`). All of it follows from the tangent planes at the nodes, which are those
//! of the function of second degree that fits the nodes around best (`tangents.rs`, `fit.rs`).
//!
//! **Every point of given ξ is a fixed combination of nodes**, whose weights come from the reference configuration and sum to 1. So the map from
//! nodal to relative motion is the gradient of the gap, forces have no resultant, and the surface moves with the nodes as a mesh does. The tangent
//! planes of two tiles agree in every configuration, as both have the same directions along and across their common side.
//!
//! Where the boundary turns by more than 40° in the reference configuration an edge stays sharp; there it is a cubic curve through its nodes as
//! well, and ends at corners (`network.rs`). Facets that are flat with all that is around them stay what their cells say, so that flat bodies
//! are as they would be with facets. At a node in a flat part the surface may bend as facets do.

mod combination;
mod fit;
mod gregory;
mod jet;
mod network;
mod tangents;
#[cfg(test)]
mod tests;
mod tile;

use std::ops::Range;

use carom_mesh::{Facet, Vector};
use smallvec::SmallVec;

use self::gregory::MAX_CONTROLS;
pub(crate) use self::network::Network;
use self::tangents::Tangents;
use self::tile::{Controls, Tile};
use crate::closest::{Local, Parametric};
use crate::patch::foot;
use crate::path::Positions;
use crate::project::{Projection, Reach, Weights, normal};
use crate::tolerances::SEARCH;

/// A smooth surface over the facets of a boundary in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    tiles: Vec<Tile>,
    /// The tiles of every facet; none of one that stays flat.
    of_facet: Vec<Range<u32>>,
}

impl Sheet {
    /// The smooth surface through the nodes of `facets`, which are triangles and quadrilaterals. `reference` are the positions [m] without deformation.
    pub fn through<const D: usize>(facets: &[Facet], reference: &Positions<'_, D>) -> Self {
        let network = Network::new(facets, reference);
        let tangents = Tangents::new(&network, reference);
        let is_flat = |t: u32| {
            let corners = 0..network.tiles[t as usize].nodes.len() as u32;
            corners.into_iter().all(|k| network.sector((t, k)).is_flat)
        };
        let mut tiles: Vec<Tile> = Vec::new();
        let mut of_facet = Vec::new();
        // Where the tiles of the network are among those that are kept.
        let mut kept: Vec<Option<u32>> = vec![None; network.tiles.len()];
        let mut next = 0;
        for f in 0..facets.len() as u32 {
            let cut = network.tiles[next..].iter().take_while(|tile| tile.facet == f).count();
            let all = next..next + cut;
            next += cut;
            let first = tiles.len() as u32;
            if !all.clone().all(|t| is_flat(t as u32)) {
                for t in all {
                    kept[t] = Some(tiles.len() as u32);
                    tiles.push(Tile::new(&network, t as u32, &tangents));
                }
            }
            of_facet.push(first..tiles.len() as u32);
        }
        for tile in &mut tiles {
            for neighbour in &mut tile.neighbours {
                *neighbour = neighbour.and_then(|(t, side)| Some((kept[t as usize]?, side)));
            }
        }
        Self { tiles, of_facet }
    }

    /// Whether the surface is smooth over a facet.
    pub fn covers(&self, facet: u32) -> bool {
        !self.of_facet[facet as usize].is_empty()
    }

    /// The tile over a part of a facet, in the order of `parts`.
    fn tile(&self, facet: u32, part: usize) -> &Tile {
        &self.tiles[self.of_facet[facet as usize].start as usize + part]
    }

    /// The nodes that points over a part of a facet are combinations of.
    pub fn nodes(&self, facet: u32, part: usize) -> &[u32] {
        &self.tile(facet, part).nodes
    }

    /// Their weights over the point of the part where its linear shape functions are `shape`.
    pub fn weights(&self, facet: u32, part: usize, shape: &[f64]) -> Weights {
        let tile = self.tile(facet, part);
        let mut xi = [0.0; 2];
        for (weight, corner) in shape.iter().zip(tile.domain.corners()) {
            (0..2).for_each(|i| xi[i] += weight * corner[i]);
        }
        tile.weights_at(&xi)
    }

    /// Points [m] whose convex hull holds the surface over a facet.
    pub fn control_points<const D: usize>(
        &self,
        facet: u32,
        position: &Positions<'_, D>,
    ) -> impl Iterator<Item = Vector<D>> {
        let tiles = self.of_facet[facet as usize].clone();
        tiles.flat_map(move |t| {
            let controls = self.tiles[t as usize].seen_from(&Vector::zeros(), position);
            SmallVec::<[Vector<D>; MAX_CONTROLS]>::from_slice(controls.points())
        })
    }

    /// The point closest to `x` over a facet or, if it may reach beyond, over those that smooth sides lead to. Beyond a sharp edge the surface goes on straight
    /// for half a tile.
    ///
    /// The walk goes over a side where the distance falls beyond it. As the tangent plane is the same on both, it falls from there on, and the walk ends.
    pub fn project<const D: usize>(
        &self,
        facet: u32,
        x: &Vector<D>,
        reach: Reach,
        position: &Positions<'_, D>,
    ) -> Projection<'_, D> {
        let own = self.of_facet[facet as usize].clone();
        let mut t = self.nearest(own.clone(), x, position);
        let mut start = self.tiles[t as usize].domain.middle();
        let mut visited: SmallVec<[u32; 16]> = SmallVec::new();
        loop {
            visited.push(t);
            let tile = &self.tiles[t as usize];
            let controls = tile.seen_from(x, position);
            let (xi, at) = controls.closest_from(&Vector::zeros(), start);
            let falls = falling(&controls, &xi, &at);
            let across = |&(side, fraction): &(usize, f64)| {
                let (next, other) = tile.neighbours[side]?;
                let may = reach != Reach::Facet || own.contains(&next);
                (may && !visited.contains(&next)).then_some((next, other as usize, 1.0 - fraction))
            };
            match falls.iter().find_map(across) {
                Some((next, side, fraction)) => {
                    t = next;
                    start = self.tiles[t as usize].domain.on_edge(side, fraction);
                }
                None => {
                    let is_open = |&(side, _): &(usize, f64)| tile.neighbours[side].is_none();
                    let goes_on = reach != Reach::Facet && falls.iter().any(is_open);
                    return foot_at(x, &controls, tile, (xi, at), goes_on);
                }
            }
        }
    }

    /// The tile whose corners are nearest to `x`.
    fn nearest<const D: usize>(&self, tiles: Range<u32>, x: &Vector<D>, position: &Positions<'_, D>) -> u32 {
        let first = tiles.start;
        if tiles.len() == 1 {
            return first;
        }
        let distance = |t: u32| {
            let controls = self.tiles[t as usize].seen_from(x, position);
            let corners = self.tiles[t as usize].domain.corners().len();
            (controls.points()[..corners].iter().sum::<Vector<D>>() / corners as f64).norm_squared()
        };
        let distances = tiles.map(|t| (distance(t), t));
        distances.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(first, |(_, t)| t)
    }
}

/// The sides on which the closest point of a tile is and beyond which the distance falls, that in whose direction it is more so first; with how far along
/// them the point is.
fn falling<const D: usize>(
    controls: &Controls<'_, D>,
    xi: &[f64; 2],
    at: &Local<D>,
) -> SmallVec<[(usize, f64); 2]> {
    let domain = controls.domain();
    let slope = at.slope(&Vector::zeros());
    let sides = 0..domain.corners().len();
    let active: SmallVec<[usize; 3]> = sides.filter(|&k| domain.inside_of(k, xi) <= SEARCH.on_edge).collect();
    let fraction = |side: usize| {
        let (from, along) = (domain.corners()[side], domain.along(side));
        let dot = (xi[0] - from[0]) * along[0] + (xi[1] - from[1]) * along[1];
        (dot / (along[0] * along[0] + along[1] * along[1])).clamp(0.0, 1.0)
    };
    let outward = |side: usize| {
        let along = domain.along(side);
        [along[1], -along[0]]
    };
    match active[..] {
        [side] => {
            let out = outward(side);
            let falls = slope[0] * out[0] + slope[1] * out[1] < 0.0;
            falls.then(|| (side, fraction(side))).into_iter().collect()
        }
        [a, b] => {
            // −slope = λ_a out_a + λ_b out_b.
            let [p, q] = [a, b].map(outward);
            let det = p[0] * q[1] - p[1] * q[0];
            let lambda =
                [(-slope[0] * q[1] + slope[1] * q[0]) / det, (-slope[1] * p[0] + slope[0] * p[1]) / det];
            // How much the way to the point looks along each side, away from their corner.
            let towards = |side: usize| {
                let along = domain.along(side);
                let t = at.tangents[0] * along[0] + at.tangents[1] * along[1];
                let sign = if fraction(side) < 0.5 { 1.0 } else { -1.0 };
                -at.point.dot(&t) * sign / t.norm()
            };
            let mut sides: SmallVec<[(usize, f64); 2]> =
                [(a, lambda[0]), (b, lambda[1])].into_iter().filter(|&(_, l)| l > 0.0).collect();
            sides.sort_by(|a, b| towards(b.0).total_cmp(&towards(a.0)));
            sides.iter().map(|&(side, _)| (side, fraction(side))).collect()
        }
        _ => SmallVec::new(),
    }
}

/// What belongs to a point of a tile, or to where the tangent plane there is closest to `x`, if the surface goes on.
fn foot_at<'a, const D: usize>(
    x: &Vector<D>,
    controls: &Controls<'_, D>,
    tile: &'a Tile,
    (xi, at): ([f64; 2], Local<D>),
    goes_on: bool,
) -> Projection<'a, D> {
    let mut beyond = [0.0; 2];
    if goes_on {
        let straight = foot(&-at.point, &at.tangents);
        let end = tile.domain.reached([xi[0] + straight[0], xi[1] + straight[1]]);
        beyond = [end[0] - xi[0], end[1] - xi[1]];
    }
    let weights = tile.weights(&controls.shares(&xi, beyond));
    let point = at.point + at.tangents[0] * beyond[0] + at.tangents[1] * beyond[1];
    Projection { nodes: &tile.nodes, weights, point: x + point, normal: normal(&at.tangents) }
}
