//! Surfaces of facets that somebody else has listed, turned so that the body is behind them.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use thiserror::Error;

use crate::{CellKind, Facet, Surface, Vector, tensor};

/// Why facets make no surface. Facets and nodes are numbered from 0.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum OutlineDefect {
    /// No facet has so many nodes.
    #[error("facet {facet} has {nodes} nodes; in {}", if *dimension == 2 { "the plane it has 2 or 3" } else { "space it has 3, 4, 6, 8 or 9" })]
    NoSuchFacet {
        /// Which facet.
        facet: usize,
        /// How many nodes it has.
        nodes: usize,
        /// Dimension of space.
        dimension: usize,
    },
    /// A node that there is not.
    #[error("facet {facet} has node {node}, and there are {count} points; nodes are numbered from 0")]
    NoSuchNode {
        /// Which facet.
        facet: usize,
        /// The node.
        node: u32,
        /// How many points there are.
        count: usize,
    },
    /// A node twice in one facet.
    #[error("facet {facet} has node {node} twice; leave facets without area out")]
    RepeatedNode {
        /// Which facet.
        facet: usize,
        /// The node.
        node: u32,
    },
    /// The same facet twice.
    #[error("facet {facet} has the nodes of facet {other}; give every facet once")]
    RepeatedFacet {
        /// Which facet.
        facet: usize,
        /// The one before.
        other: usize,
    },
    /// No way of turning the facets agrees with all of them.
    #[error(
        "the facets around facet {facet} have no two sides, as on a Möbius strip; give the boundary of a body"
    )]
    OneSided {
        /// A facet where two ways of turning meet.
        facet: usize,
    },
}

impl Surface {
    /// The surface of facets given by the numbers of their `points` [m], in VTK's order: in the plane 2 or 3 nodes each, in space 3, 4, 6, 8 or 9.
    ///
    /// Facets that are turned against their neighbours are turned. What is closed looks away from what it encloses, or into it, if it is a hollow
    /// of something that encloses it. Of what is not closed, the most facets say where its outside is.
    ///
    /// # Errors
    /// If a facet is of no kind that there is, has a node that there is not or one twice, or if there are no two sides.
    pub fn from_facets<const D: usize>(
        points: &[Vector<D>],
        facets: &[Vec<u32>],
    ) -> Result<Self, OutlineDefect> {
        let mut facets = kinds::<D>(points.len(), facets)?;
        let mut parts = connected(&facets)?;
        for part in &parts {
            part.facets.iter().filter(|f| f.1).for_each(|&(f, _)| facets[f] = reversed(&facets[f]));
            let turned = part.facets.iter().filter(|f| f.1).count();
            let inside_out = part.is_closed && enclosed(points, part, &facets) < 0.0;
            if inside_out || !part.is_closed && 2 * turned > part.facets.len() {
                turn(part, &mut facets);
            }
        }
        parts.retain(|part| part.is_closed);
        let is_hollow = |part: &Part| {
            let x = points[facets[part.facets[0].0].nodes[0] as usize];
            let around = parts.iter().filter(|other| other.facets[0] != part.facets[0]);
            around.filter(|other| winding(points, other, &facets, &x) > 0.5).count() % 2 == 1
        };
        let hollows: Vec<&Part> = parts.iter().filter(|part| is_hollow(part)).collect();
        hollows.into_iter().for_each(|part| turn(part, &mut facets));
        Ok(Self::of_facets(facets, &[]))
    }
}

impl Surface {
    /// Whether every facet has a neighbour at each of its borders.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        connected(self.facets()).is_ok_and(|parts| parts.iter().all(|part| part.is_closed))
    }
}

/// Facets that hang together.
struct Part {
    /// Which they are, and whether they are to be turned to agree with the first.
    facets: Vec<(usize, bool)>,
    is_closed: bool,
}

/// The facets with their kinds.
fn kinds<const D: usize>(points: usize, facets: &[Vec<u32>]) -> Result<Vec<Facet>, OutlineDefect> {
    let mut seen: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
    let kind_of = |nodes: usize| match (D, nodes) {
        (2, 2) => Some(CellKind::Line2),
        (2, 3) => Some(CellKind::Line3),
        (3, 3) => Some(CellKind::Tri3),
        (3, 4) => Some(CellKind::Quad4),
        (3, 6) => Some(CellKind::Tri6),
        (3, 8) => Some(CellKind::Quad8),
        (3, 9) => Some(CellKind::Quad9),
        _ => None,
    };
    let checked = |(facet, nodes): (usize, &Vec<u32>)| {
        let no_such = OutlineDefect::NoSuchFacet { facet, nodes: nodes.len(), dimension: D };
        let kind = kind_of(nodes.len()).ok_or(no_such)?;
        if let Some(&node) = nodes.iter().find(|&&n| n as usize >= points) {
            return Err(OutlineDefect::NoSuchNode { facet, node, count: points });
        }
        let mut key = nodes.clone();
        key.sort_unstable();
        if let Some(twice) = key.windows(2).find(|n| n[0] == n[1]) {
            return Err(OutlineDefect::RepeatedNode { facet, node: twice[0] });
        }
        match seen.insert(key, facet) {
            Some(other) => Err(OutlineDefect::RepeatedFacet { facet, other }),
            None => Ok(Facet { kind, nodes: nodes.clone() }),
        }
    };
    facets.iter().enumerate().map(checked).collect()
}

/// The borders of a facet, each by its corners in ascending order, and whether the facet goes around in this order: the ends of a line, and the
/// edges of what has an area.
fn borders(facet: &Facet) -> impl Iterator<Item = ([u32; 2], bool)> {
    let corners = &facet.nodes[..facet.kind.corner_count()];
    let is_line = corners.len() == 2;
    corners.iter().enumerate().map(move |(k, &a)| {
        if is_line {
            return ([a, a], k == 0);
        }
        let b = corners[(k + 1) % corners.len()];
        ([a.min(b), a.max(b)], a < b)
    })
}

/// The facets part by part. Those hang together that have a border to themselves.
fn connected(facets: &[Facet]) -> Result<Vec<Part>, OutlineDefect> {
    let mut at: BTreeMap<[u32; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (f, facet) in facets.iter().enumerate() {
        borders(facet).for_each(|(border, way)| at.entry(border).or_default().push((f, way)));
    }
    let mut turned: Vec<Option<bool>> = vec![None; facets.len()];
    let mut parts = Vec::new();
    for first in 0..facets.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut part = Part { facets: vec![(first, false)], is_closed: true };
        let mut next = 0;
        while let Some(&(f, is_turned)) = part.facets.get(next) {
            next += 1;
            for (border, way) in borders(&facets[f]) {
                let [(a, _), (b, _)] = at[&border][..] else {
                    part.is_closed = false;
                    continue;
                };
                let other = if a == f { b } else { a };
                let other_way = at[&border].iter().find(|(g, _)| *g == other).is_some_and(|(_, way)| *way);
                // Neighbours go along their border in opposite directions.
                let is_other_turned = is_turned != (way == other_way);
                match turned[other] {
                    None => {
                        turned[other] = Some(is_other_turned);
                        part.facets.push((other, is_other_turned));
                    }
                    Some(known) if known != is_other_turned => {
                        return Err(OutlineDefect::OneSided { facet: other });
                    }
                    Some(_) => {}
                }
            }
        }
        parts.push(part);
    }
    Ok(parts)
}

fn turn(part: &Part, facets: &mut [Facet]) {
    part.facets.iter().for_each(|&(f, _)| facets[f] = reversed(&facets[f]));
}

/// The facet as seen from the other side.
fn reversed(facet: &Facet) -> Facet {
    let order: &[usize] = match facet.kind {
        CellKind::Line2 => &[1, 0],
        CellKind::Line3 => &[1, 0, 2],
        CellKind::Tri3 => &[0, 2, 1],
        CellKind::Tri6 => &[0, 2, 1, 5, 4, 3],
        CellKind::Quad4 => &[0, 3, 2, 1],
        CellKind::Quad8 => &[0, 3, 2, 1, 7, 6, 5, 4],
        _ => &[0, 3, 2, 1, 7, 6, 5, 4, 8],
    };
    Facet { kind: facet.kind, nodes: order.iter().map(|&k| facet.nodes[k]).collect() }
}

/// The corners of a facet in straight pieces: a line, or triangles.
fn pieces<const D: usize>(points: &[Vector<D>], facet: &Facet) -> impl Iterator<Item = [Vector<D>; D]> {
    let corner = |k: usize| points[facet.nodes[k] as usize];
    let count = facet.kind.corner_count();
    (0..=count - D).map(move |k| std::array::from_fn(|i| corner(if i == 0 { 0 } else { k + i })))
}

/// What a part encloses, as a positive or a negative multiple of its area or volume.
fn enclosed<const D: usize>(points: &[Vector<D>], part: &Part, facets: &[Facet]) -> f64 {
    let origin = points[facets[part.facets[0].0].nodes[0] as usize];
    let all = part.facets.iter().flat_map(|&(f, _)| pieces(points, &facets[f]));
    all.map(|piece| determinant(&piece.map(|x| x - origin))).sum()
}

/// How often a closed part goes around a point: 1 inside, 0 outside.
fn winding<const D: usize>(points: &[Vector<D>], part: &Part, facets: &[Facet], x: &Vector<D>) -> f64 {
    let all = part.facets.iter().flat_map(|&(f, _)| pieces(points, &facets[f]));
    let angle = |piece: [Vector<D>; D]| {
        let to = piece.map(|corner| corner - x);
        let n = to.map(|a| a.norm());
        if D == 2 {
            return determinant(&to).atan2(to[0].dot(&to[1]));
        }
        // The solid angle of a triangle (Van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30, 1983), of 4π.
        let beside = n[0] * n[1] * n[2]
            + to[0].dot(&to[1]) * n[2]
            + to[1].dot(&to[2]) * n[0]
            + to[2].dot(&to[0]) * n[1];
        determinant(&to).atan2(beside)
    };
    all.map(angle).sum::<f64>() / TAU
}

fn determinant<const D: usize>(rows: &[Vector<D>; D]) -> f64 {
    if D == 2 {
        return rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0];
    }
    let product = tensor::cross(&rows[0], &rows[1]);
    (0..D).map(|i| product[i] * rows[2][i]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Mesh, generate};

    fn listed<const D: usize>(mesh: &Mesh<D>) -> Vec<Vec<u32>> {
        Surface::of(mesh).facets().iter().map(|f| f.nodes.clone()).collect()
    }

    /// ∫ x·n dA / D: area or volume of what a surface encloses.
    fn volume<const D: usize>(mesh: &Mesh<D>, surface: &Surface) -> f64 {
        let centre = |f: &Facet| {
            let corners = &f.nodes[..f.kind.corner_count()];
            corners.iter().map(|&n| mesh.nodes()[n as usize]).sum::<Vector<D>>() / corners.len() as f64
        };
        surface.facets().iter().map(|f| f.area_vector(mesh).dot(&centre(f))).sum::<f64>() / D as f64
    }

    /// However facets are turned, the surface is that of the mesh.
    #[test]
    fn facets_turn_so_that_the_body_is_behind_them() {
        let rectangle = generate::grid([0.0, 0.0], [3.0, 2.0], [3, 2]).expect("valid");
        let grid = generate::grid([0.0; 3], [1.0, 2.0, 3.0], [2, 2, 2]).expect("valid");
        for start in 0..4 {
            let mut lines = listed(&rectangle);
            lines.iter_mut().skip(start).step_by(3).for_each(|nodes| nodes.reverse());
            let surface = Surface::from_facets(rectangle.nodes(), &lines).expect("a surface");
            assert!((volume(&rectangle, &surface) - 6.0).abs() < 1e-13);
            let mut squares = listed(&grid);
            squares.iter_mut().skip(start).step_by(3).for_each(|nodes| nodes.reverse());
            let surface = Surface::from_facets(grid.nodes(), &squares).expect("a surface");
            assert!((volume(&grid, &surface) - 6.0).abs() < 1e-13);
        }
    }

    /// A frame: the outside turns one way, the hollow the other, and what is in the hollow again as the outside.
    #[test]
    fn hollows_look_inwards() {
        let square = |low: f64, size: f64| generate::grid([low; 2], [size; 2], [2, 2]).expect("valid");
        let parts = [square(0.0, 4.0), square(1.0, 2.0), square(1.5, 1.0)];
        let (mut points, mut facets) = (Vec::new(), Vec::new());
        for part in &parts {
            let first = points.len() as u32;
            points.extend_from_slice(part.nodes());
            facets.extend(listed(part).iter().map(|nodes| nodes.iter().map(|n| n + first).collect()));
        }
        let surface = Surface::from_facets::<2>(&points, &facets).expect("a surface");
        let area = |nodes: &[u32]| determinant(&[points[nodes[0] as usize], points[nodes[1] as usize]]) * 0.5;
        let enclosed: f64 = surface.facets().iter().map(|f| area(&f.nodes)).sum();
        assert!((enclosed - (16.0 - 4.0 + 1.0)).abs() < 1e-13, "{enclosed}");
        let cube = |low: f64, size: f64| generate::grid([low; 3], [size; 3], [1; 3]).expect("valid");
        let (outer, inner) = (cube(0.0, 3.0), cube(1.0, 1.0));
        let points: Vec<Vector<3>> = outer.nodes().iter().chain(inner.nodes()).copied().collect();
        let hollow = listed(&inner).into_iter().map(|nodes| nodes.iter().map(|n| n + 8).collect());
        let facets: Vec<Vec<u32>> = listed(&outer).into_iter().chain(hollow).collect();
        let surface = Surface::from_facets(&points, &facets).expect("a surface");
        let pieces = surface.facets().iter().flat_map(|f| pieces(&points, f));
        let enclosed = pieces.map(|p| determinant(&p)).sum::<f64>() / 6.0;
        assert!((enclosed - 26.0).abs() < 1e-13, "{enclosed}");
        assert!(surface.is_closed());
    }

    /// Of the side of a body that alone may touch, most facets say where the outside is.
    #[test]
    fn what_is_open_looks_where_most_of_it_looks() {
        let points: Vec<Vector<2>> = (0..6).map(|k| Vector::<2>::new(f64::from(k), 0.0)).collect();
        let facets = vec![vec![1, 0], vec![1, 2], vec![3, 2], vec![4, 3], vec![5, 4]];
        let surface = Surface::from_facets(&points, &facets).expect("a surface");
        assert!(surface.facets().iter().all(|f| f.nodes[0] > f.nodes[1]), "{surface:?}");
        assert!(!surface.is_closed());
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        let points =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector::<3>::from);
        let refused = |facets: &[&[u32]]| {
            let facets: Vec<Vec<u32>> = facets.iter().map(|f| f.to_vec()).collect();
            Surface::from_facets(&points, &facets).expect_err("no surface")
        };
        let no_such = OutlineDefect::NoSuchFacet { facet: 1, nodes: 2, dimension: 3 };
        assert_eq!(refused(&[&[0, 1, 2], &[0, 1]]), no_such);
        assert_eq!(refused(&[&[0, 1, 4]]), OutlineDefect::NoSuchNode { facet: 0, node: 4, count: 4 });
        assert_eq!(refused(&[&[0, 1, 1]]), OutlineDefect::RepeatedNode { facet: 0, node: 1 });
        assert_eq!(refused(&[&[0, 1, 2], &[2, 1, 0]]), OutlineDefect::RepeatedFacet { facet: 1, other: 0 });
        // A band of five triangles whose ends are joined crosswise.
        let points: Vec<Vector<3>> =
            (0..5).map(|k| Vector::<3>::new(f64::from(k), f64::from(k * k), 1.0)).collect();
        let band: Vec<Vec<u32>> = (0..5).map(|k| vec![k, (k + 1) % 5, (k + 2) % 5]).collect();
        assert!(matches!(Surface::from_facets(&points, &band), Err(OutlineDefect::OneSided { .. })));
    }
}
