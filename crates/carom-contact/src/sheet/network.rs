//! Tiles, how they hang together, and where the surface has edges.

use std::collections::BTreeMap;

use carom_mesh::{Facet, Vector};
use smallvec::SmallVec;

use crate::parts::parts;
use crate::path::Positions;
use crate::project::area_normal;
use crate::tolerances::{EDGES, SEARCH};

/// A corner of a tile: the tile, and the number of the corner in it.
pub(crate) type CornerOf = (u32, u32);

/// A triangle or quadrilateral between nodes of a facet: the facet itself or, of a quadratic one, a part of it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cut {
    pub facet: u32,
    /// Its corners.
    pub nodes: SmallVec<[u32; 4]>,
    /// The node in the middle of the side of the facet that a side of the tile is half of, and the far end of it.
    pub halves: SmallVec<[Option<Half>; 4]>,
}

/// A side of a tile that is half of a side of a quadratic facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Half {
    pub middle: u32,
    pub ends: [u32; 2],
}

/// The corners around a node between two sharp edges, one after the other against the clock, or all around it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Sector {
    pub node: u32,
    pub corners: Vec<CornerOf>,
    /// Whether no sharp edge bounds it.
    pub is_closed: bool,
    /// Whether it is flat, and its sharp edges straight, in the reference configuration.
    pub is_flat: bool,
}

/// The tiles of a surface in its reference configuration.
pub(crate) struct Network {
    pub tiles: Vec<Cut>,
    /// The tile across every side, and its side; none at a sharp edge.
    pub neighbours: Vec<SmallVec<[Option<CornerOf>; 4]>>,
    pub sectors: Vec<Sector>,
    /// The sector of every corner.
    pub sector_of: Vec<SmallVec<[u32; 4]>>,
    /// The other ends of the sharp edges at a node.
    sharp: BTreeMap<u32, SmallVec<[Sharp; 4]>>,
}

/// A sharp edge, seen from one of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sharp {
    /// Its other end.
    to: u32,
    /// Where it comes from, if it passes the node by less of a turn than at a corner, and whether it is straight there.
    from: Option<(u32, bool)>,
}

/// What a sharp edge is at one of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Passage {
    /// It comes from this node.
    From(u32),
    /// It ends at a corner.
    Corner,
    /// It fades out.
    Fades,
}

impl Network {
    /// The tiles of `facets`, which are triangles and quadrilaterals.
    pub fn new<const D: usize>(facets: &[Facet], reference: &Positions<'_, D>) -> Self {
        let tiles: Vec<Cut> = (0..).zip(facets).flat_map(|(f, facet)| cut(f, facet)).collect();
        let neighbours = neighbours(&tiles, reference);
        let sharp = sharp_edges(&tiles, &neighbours, reference);
        let mut network = Self { sector_of: Vec::new(), sectors: Vec::new(), tiles, neighbours, sharp };
        network.find_sectors(reference);
        network
    }

    /// What the sharp edge from a `node` to another is at the node.
    pub fn passage(&self, node: u32, to: u32) -> Passage {
        let at = self.sharp.get(&node).map_or(&[][..], |sharp| sharp);
        match at.iter().find(|edge| edge.to == to).and_then(|edge| edge.from) {
            Some((from, _)) => Passage::From(from),
            None if at.len() == 1 => Passage::Fades,
            None => Passage::Corner,
        }
    }

    /// The sector that a corner belongs to.
    pub fn sector(&self, (tile, corner): CornerOf) -> &Sector {
        &self.sectors[self.sector_of[tile as usize][corner as usize] as usize]
    }

    /// The two nodes next to a corner of a tile: those that the sides from it and to it lead to.
    pub fn beside(&self, (tile, corner): CornerOf) -> [u32; 2] {
        let nodes = &self.tiles[tile as usize].nodes;
        let (k, count) = (corner as usize, nodes.len());
        [nodes[(k + 1) % count], nodes[(k + count - 1) % count]]
    }

    /// The corners next to one around its node: across the side to it and across the side from it.
    fn around(&self, (tile, corner): CornerOf) -> [Option<CornerOf>; 2] {
        let neighbours = &self.neighbours[tile as usize];
        let (k, count) = (corner as usize, neighbours.len());
        let after = neighbours[(k + count - 1) % count];
        let before =
            neighbours[k].map(|(t, side)| (t, (side + 1) % self.tiles[t as usize].nodes.len() as u32));
        [after, before]
    }

    fn find_sectors<const D: usize>(&mut self, reference: &Positions<'_, D>) {
        const NONE: u32 = u32::MAX;
        let unknown = |tile: &Cut| tile.nodes.iter().map(|_| NONE).collect();
        self.sector_of = self.tiles.iter().map(unknown).collect();
        for t in 0..self.tiles.len() as u32 {
            for k in 0..self.tiles[t as usize].nodes.len() as u32 {
                if self.sector_of[t as usize][k as usize] != NONE {
                    continue;
                }
                let mut first = (t, k);
                let mut is_closed = false;
                while let Some(before) = self.around(first)[1] {
                    first = before;
                    if first == (t, k) {
                        is_closed = true;
                        break;
                    }
                }
                let mut corners = vec![first];
                let mut last = first;
                while let Some(after) = self.around(last)[0].filter(|&after| after != first) {
                    corners.push(after);
                    last = after;
                }
                for &(t, k) in &corners {
                    self.sector_of[t as usize][k as usize] = self.sectors.len() as u32;
                }
                let node = self.tiles[t as usize].nodes[k as usize];
                let mut sector = Sector { node, corners, is_closed, is_flat: false };
                sector.is_flat = self.is_flat(&sector, reference);
                self.sectors.push(sector);
            }
        }
    }

    /// Whether a sector is flat, and the sharp edges that bound it are straight, to 1°.
    fn is_flat<const D: usize>(&self, sector: &Sector, reference: &Positions<'_, D>) -> bool {
        let normal =
            |&(t, k): &CornerOf| corner_normal(&self.tiles[t as usize], k as usize, reference).normalize();
        let first = normal(&sector.corners[0]);
        let is_straight = |to: u32| {
            let sharp =
                self.sharp.get(&sector.node).and_then(|sharp| sharp.iter().find(|edge| edge.to == to));
            sharp.and_then(|edge| edge.from).is_none_or(|(_, is_straight)| is_straight)
        };
        sector.corners.iter().all(|corner| normal(corner).dot(&first) > EDGES.flat)
            && self.bounds(sector).is_none_or(|bounds| bounds.into_iter().all(is_straight))
    }

    /// The far ends of the sharp edges that bound a sector: the first and the last against the clock.
    pub fn bounds(&self, sector: &Sector) -> Option<[u32; 2]> {
        let (first, last) = (sector.corners[0], sector.corners[sector.corners.len() - 1]);
        (!sector.is_closed).then(|| [self.beside(first)[0], self.beside(last)[1]])
    }

    /// The mean outward normal of a sector.
    pub fn normal<const D: usize>(&self, sector: &Sector, reference: &Positions<'_, D>) -> Vector<D> {
        let normal =
            |&(t, k): &CornerOf| corner_normal(&self.tiles[t as usize], k as usize, reference).normalize();
        sector.corners.iter().map(normal).sum::<Vector<D>>().normalize()
    }

    /// The other nodes of the tiles of a sector and, if it is `widened`, of the tiles around these that no sharp edge is before.
    pub fn nodes_around(&self, sector: &Sector, widened: bool) -> Vec<u32> {
        let nodes = |t: u32| self.tiles[t as usize].nodes.iter().copied();
        let mut found: Vec<u32> = sector.corners.iter().flat_map(|&(t, _)| nodes(t)).collect();
        if widened {
            for &(t, _) in &sector.corners {
                let next = self.sector_of[t as usize].iter().map(|&s| &self.sectors[s as usize]);
                found.extend(next.flat_map(|next| &next.corners).flat_map(|&(t, _)| nodes(t)));
            }
        }
        found.sort_unstable();
        found.dedup();
        found.retain(|&n| n != sector.node);
        found
    }
}

/// The tiles of a facet.
fn cut(number: u32, facet: &Facet) -> impl Iterator<Item = Cut> {
    let corners = facet.kind.corner_count();
    let half = move |a: usize, b: usize| {
        let (middle, end) = (a.max(b), a.min(b));
        // Behind the corners are the middles of the sides, each after the corner that its side begins at.
        if middle < corners || middle >= 2 * corners || end >= corners {
            return None;
        }
        let side = middle - corners;
        let ends = [side, (side + 1) % corners].map(|k| facet.nodes[k]);
        Some(Half { middle: facet.nodes[middle], ends })
    };
    parts(facet.kind).iter().map(move |&(_, part)| Cut {
        facet: number,
        nodes: part.iter().map(|&a| facet.nodes[a]).collect(),
        halves: (0..part.len()).map(|k| half(part[k], part[(k + 1) % part.len()])).collect(),
    })
}

/// Twice the area of the triangle at a corner as a vector, outwards.
fn corner_normal<const D: usize>(tile: &Cut, corner: usize, reference: &Positions<'_, D>) -> Vector<D> {
    let count = tile.nodes.len();
    let x = |k: usize| reference(tile.nodes[k % count]);
    area_normal(&[x(corner + 1) - x(corner), x(corner + count - 1) - x(corner)])
}

fn neighbours<const D: usize>(
    tiles: &[Cut],
    reference: &Positions<'_, D>,
) -> Vec<SmallVec<[Option<CornerOf>; 4]>> {
    let mut sides: BTreeMap<[u32; 2], SmallVec<[(CornerOf, u32); 2]>> = BTreeMap::new();
    for (t, tile) in (0..).zip(tiles) {
        for (k, &from) in (0..).zip(&tile.nodes) {
            let to = tile.nodes[(k as usize + 1) % tile.nodes.len()];
            sides.entry([from.min(to), from.max(to)]).or_default().push(((t, k), from));
        }
    }
    let mut neighbours: Vec<_> = tiles.iter().map(|tile| tile.nodes.iter().map(|_| None).collect()).collect();
    for beside in sides.values() {
        // Three sides at an edge, or two that go the same way, are not of one surface there.
        let [(a, from), (b, other)] = beside[..] else { continue };
        let normal = |(t, k): CornerOf| {
            let (tile, k) = (&tiles[t as usize], k as usize);
            let at = |k: usize| corner_normal(tile, k % tile.nodes.len(), reference);
            (at(k) + at(k + 1)).normalize()
        };
        let same_facet = tiles[a.0 as usize].facet == tiles[b.0 as usize].facet;
        if from != other && (same_facet || normal(a).dot(&normal(b)) >= SEARCH.corner) {
            let set = |neighbours: &mut Vec<SmallVec<[Option<CornerOf>; 4]>>, (t, k): CornerOf, to| {
                neighbours[t as usize][k as usize] = Some(to);
            };
            set(&mut neighbours, a, b);
            set(&mut neighbours, b, a);
        }
    }
    neighbours
}

/// The sharp edges at every node, and which of them go on through it.
fn sharp_edges<const D: usize>(
    tiles: &[Cut],
    neighbours: &[SmallVec<[Option<CornerOf>; 4]>],
    reference: &Positions<'_, D>,
) -> BTreeMap<u32, SmallVec<[Sharp; 4]>> {
    let mut ends: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (tile, neighbours) in tiles.iter().zip(neighbours) {
        for (k, _) in neighbours.iter().enumerate().filter(|(_, neighbour)| neighbour.is_none()) {
            let (a, b) = (tile.nodes[k], tile.nodes[(k + 1) % tile.nodes.len()]);
            ends.entry(a).or_default().push(b);
            ends.entry(b).or_default().push(a);
        }
    }
    let mut sharp = BTreeMap::new();
    for (node, mut others) in ends {
        others.sort_unstable();
        others.dedup();
        let direction = |&n: &u32| (reference(n) - reference(node)).normalize();
        let directions: Vec<Vector<D>> = others.iter().map(direction).collect();
        let pairs = (0..others.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let mut pairs: Vec<(f64, usize, usize)> =
            pairs.map(|(i, j)| (-directions[i].dot(&directions[j]), i, j)).collect();
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut edges: SmallVec<[Sharp; 4]> = others.iter().map(|&to| Sharp { to, from: None }).collect();
        for (cosine, i, j) in pairs {
            if cosine >= SEARCH.corner && edges[i].from.is_none() && edges[j].from.is_none() {
                let is_straight = cosine > EDGES.flat;
                (edges[i].from, edges[j].from) =
                    (Some((others[j], is_straight)), Some((others[i], is_straight)));
            }
        }
        sharp.insert(node, edges);
    }
    sharp
}
