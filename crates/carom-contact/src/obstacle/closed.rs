use std::collections::BTreeMap;
use std::fmt;

use carom_mesh::{CellKind, Facet, Vector};

use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::patch::Patch;
use crate::project::{area_normal, normal};
use crate::tolerances::SEARCH;

use super::direction::along;

/// A closed surface of straight facets, triangles in space and segments in the plane, with the body inside.
///
/// Its signed distance takes the sign from pseudo-normals. That of a facet is its normal, and that of an edge the sum over its
/// two facets. That of a vertex is the sum over the facets around it, weighted by their angles there (Bærentzen & Aanæs 2005); in the plane
/// the sum over its two segments.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedSurface<const D: usize> {
    vertices: Vec<Vector<D>>,
    facets: Vec<Facet>,
    normals: Vec<Vector<D>>,
    /// Of the edges opposite to each corner of a triangle, in the plane none; not normalised.
    edge_normals: Vec<[Vector<D>; 3]>,
    vertex_normals: Vec<Vector<D>>,
    bounds: Aabb<D>,
    tree: Bvh<D>,
}

/// Why triangles enclose nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurfaceDefect {
    /// The space has not three dimensions.
    NotInSpace,
    /// There are no triangles.
    Empty,
    /// A coordinate is not a finite number.
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A triangle refers to a vertex that does not exist.
    UnknownVertex {
        /// The triangle.
        triangle: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// Triangles without area.
    Degenerate {
        /// How many.
        count: usize,
        /// The first.
        triangle: usize,
        /// Its first vertex [m].
        at: [f64; 3],
    },
    /// Edges of one triangle only.
    Open {
        /// How many.
        count: usize,
        /// The ends of the first [m].
        at: [[f64; 3]; 2],
    },
    /// Edges of three triangles or more.
    NonManifold {
        /// How many.
        count: usize,
        /// The ends of the first [m].
        at: [[f64; 3]; 2],
    },
    /// Edges whose two triangles turn in different senses.
    Twisted {
        /// How many.
        count: usize,
        /// The ends of the first [m].
        at: [[f64; 3]; 2],
    },
    /// The normals point into the body.
    InsideOut,
}

impl fmt::Display for SurfaceDefect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = |x: &[f64; 3]| format!("({:.6}, {:.6}, {:.6})", x[0], x[1], x[2]);
        let edge = |count: usize, [a, b]: &[[f64; 3]; 2]| {
            format!(
                "{count} edge{}, the first from {} to {}",
                if count == 1 { "" } else { "s" },
                place(a),
                place(b)
            )
        };
        match self {
            Self::NotInSpace => write!(f, "a surface of triangles encloses something in 3D only"),
            Self::Empty => write!(f, "the surface has no triangles"),
            Self::NotFinite { vertex } => {
                write!(f, "vertex {vertex} has a coordinate that is not a finite number")
            }
            Self::UnknownVertex { triangle, vertices } => {
                write!(f, "triangle {triangle} refers to a vertex beyond the {vertices} there are")
            }
            Self::Degenerate { count, triangle, at } => write!(
                f,
                "{count} triangle{} without area, the first is number {triangle} at {}; remove what has none",
                if *count == 1 { "" } else { "s" },
                place(at)
            ),
            Self::Open { count, at } => {
                write!(
                    f,
                    "the surface is not closed: only one triangle is at {}; close the holes",
                    edge(*count, at)
                )
            }
            Self::NonManifold { count, at } => write!(
                f,
                "more than two triangles meet at {}; the surface must enclose one side only",
                edge(*count, at)
            ),
            Self::Twisted { count, at } => write!(
                f,
                "neighbouring triangles turn in different senses at {}; orient all of them outwards",
                edge(*count, at)
            ),
            Self::InsideOut => {
                write!(f, "the triangles turn the wrong way: their normals point inwards; reverse them")
            }
        }
    }
}

impl std::error::Error for SurfaceDefect {}

impl<const D: usize> ClosedSurface<D> {
    /// The body inside `triangles` of these `vertices` [m]; normals point outwards by the right-hand rule.
    ///
    /// # Errors
    /// If the triangles are not the boundary of a body: see [`SurfaceDefect`].
    pub fn new(vertices: Vec<Vector<D>>, triangles: &[[u32; 3]]) -> Result<Self, SurfaceDefect> {
        check(&vertices, triangles)?;
        let x = |n: u32| vertices[n as usize];
        let normals: Vec<Vector<D>> =
            triangles.iter().map(|&[a, b, c]| normal(&[x(b) - x(a), x(c) - x(a)])).collect();
        let mut vertex_normals = vec![Vector::zeros(); vertices.len()];
        let mut of_edge: BTreeMap<[u32; 2], Vector<D>> = BTreeMap::new();
        for (t, n) in triangles.iter().zip(&normals) {
            for k in 0..3 {
                let [a, b, c] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
                vertex_normals[a as usize] += n * (x(b) - x(a)).angle(&(x(c) - x(a)));
                *of_edge.entry([b.min(c), b.max(c)]).or_insert_with(Vector::zeros) += n;
            }
        }
        let edge_normals = triangles
            .iter()
            .map(|t| {
                [0, 1, 2].map(|k| {
                    let [b, c] = [t[(k + 1) % 3], t[(k + 2) % 3]];
                    of_edge[&[b.min(c), b.max(c)]]
                })
            })
            .collect();
        let facets = triangles.iter().map(|t| Facet { kind: CellKind::Tri3, nodes: t.to_vec() }).collect();
        Ok(Self { edge_normals, ..Self::of_facets(vertices, facets, normals, vertex_normals) })
    }

    /// One of these facets with their unit normals, and the pseudo-normals of its vertices, of any length.
    pub(super) fn of_facets(
        vertices: Vec<Vector<D>>,
        facets: Vec<Facet>,
        normals: Vec<Vector<D>>,
        vertex_normals: Vec<Vector<D>>,
    ) -> Self {
        let tree = Bvh::new(facets.iter().map(|f| Aabb::of(f.nodes.iter().map(|&n| vertices[n as usize]))));
        let bounds = Aabb::of(vertices.iter().copied());
        Self { vertices, facets, normals, edge_normals: Vec::new(), vertex_normals, bounds, tree }
    }

    pub(crate) fn vertices(&self) -> &[Vector<D>] {
        &self.vertices
    }

    pub(crate) fn facets(&self) -> &[Facet] {
        &self.facets
    }

    /// The ends of its edges [m], every edge once.
    pub(crate) fn edges(&self) -> impl Iterator<Item = [Vector<D>; 2]> {
        let around = self.facets.iter().flat_map(|f| (0..D).map(|k| [f.nodes[k], f.nodes[(k + 1) % D]]));
        // A triangle has its edges in common with others that run through them the other way, a segment is one.
        around.filter(|[a, b]| a < b).map(|ends| ends.map(|n| self.vertices[n as usize]))
    }

    /// Signed distance of `x` [m], negative inside, and the unit normal.
    pub(super) fn gap(&self, x: &Vector<D>) -> (f64, Vector<D>) {
        let at = |n: u32| self.vertices[n as usize];
        let (mut best, mut distance) = (None, f64::INFINITY);
        self.tree.nearest(x, |f, _| {
            let patch = Patch::new(&self.facets[f as usize], &at);
            let point = patch.at(&patch.closest(x));
            let d = (x - point.point).norm();
            if d < distance {
                distance = d;
                best = Some((f as usize, point));
            }
            distance
        });
        let Some((f, point)) = best else { return (f64::INFINITY, along(0, 1.0)) };
        let offset = x - point.point;
        let is_zero = |k: usize| point.weights[k] <= SEARCH.on_edge;
        let pseudo = match (0..D).filter(|&k| is_zero(k)).count() {
            0 => return (self.normals[f].dot(&offset), self.normals[f]),
            1 if D == 3 => (0..D).find(|&k| is_zero(k)).map_or(self.normals[f], |k| self.edge_normals[f][k]),
            _ => {
                let corner = point.weights[..D].iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
                self.vertex_normals[self.facets[f].nodes[corner.map_or(0, |(k, _)| k)] as usize]
            }
        };
        let side = 1.0_f64.copysign(pseudo.dot(&offset));
        let towards =
            if distance > SEARCH.touching * self.bounds.diameter() { offset * side } else { pseudo };
        (side * distance, towards.normalize())
    }
}

/// Whether the triangles are the oriented boundary of a body.
fn check<const D: usize>(vertices: &[Vector<D>], triangles: &[[u32; 3]]) -> Result<(), SurfaceDefect> {
    if D != 3 {
        return Err(SurfaceDefect::NotInSpace);
    }
    if triangles.is_empty() {
        return Err(SurfaceDefect::Empty);
    }
    if let Some(vertex) = vertices.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
        return Err(SurfaceDefect::NotFinite { vertex });
    }
    if let Some(triangle) = triangles.iter().position(|t| t.iter().any(|&n| n as usize >= vertices.len())) {
        return Err(SurfaceDefect::UnknownVertex { triangle, vertices: vertices.len() });
    }
    let x = |n: u32| vertices[n as usize];
    let flat = |&[a, b, c]: &[u32; 3]| {
        let (s, t) = (x(b) - x(a), x(c) - x(a));
        area_normal(&[s, t]).norm() <= 1e-12 * s.norm_squared().max(t.norm_squared())
    };
    let at = |n: u32| std::array::from_fn(|i| x(n)[i]);
    if let Some(triangle) = triangles.iter().position(flat) {
        let count = triangles.iter().filter(|&t| flat(t)).count();
        return Err(SurfaceDefect::Degenerate { count, triangle, at: at(triangles[triangle][0]) });
    }
    // How often every edge is run through in either sense.
    let mut uses: BTreeMap<[u32; 2], [usize; 2]> = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            uses.entry([a.min(b), a.max(b)]).or_default()[usize::from(a > b)] += 1;
        }
    }
    let faulty = |is_faulty: fn(&[usize; 2]) -> bool| {
        let mut edges = uses.iter().filter(move |(_, n)| is_faulty(n)).map(|(e, _)| e.map(at));
        edges.next().map(|first| (1 + edges.count(), first))
    };
    if let Some((count, at)) = faulty(|[a, b]| a + b == 1) {
        return Err(SurfaceDefect::Open { count, at });
    }
    if let Some((count, at)) = faulty(|[a, b]| a + b > 2) {
        return Err(SurfaceDefect::NonManifold { count, at });
    }
    if let Some((count, at)) = faulty(|[a, b]| a != b) {
        return Err(SurfaceDefect::Twisted { count, at });
    }
    let origin = vertices[0];
    let volume = |&[a, b, c]: &[u32; 3]| (x(a) - origin).dot(&area_normal(&[x(b) - origin, x(c) - origin]));
    if triangles.iter().map(volume).sum::<f64>() <= 0.0 {
        return Err(SurfaceDefect::InsideOut);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::convex::cuboid;
    use super::*;

    /// The cube between −1 and 1, two triangles per side.
    fn cube() -> (Vec<Vector<3>>, Vec<[u32; 3]>) {
        let vertices =
            (0..8).map(|k| Vector::from_fn(|i, _| if k >> i & 1 == 1 { 1.0 } else { -1.0 })).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        (vertices, quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
    }

    #[test]
    fn triangles_enclose_nothing_in_the_plane() {
        let refused =
            ClosedSurface::<2>::new(vec![Vector::zeros(); 3], &[[0, 1, 2]]).expect_err("is refused");
        assert_eq!(refused.to_string(), "a surface of triangles encloses something in 3D only");
    }

    #[test]
    fn a_cube_of_triangles_is_as_far_away_as_the_box() {
        let (vertices, triangles) = cube();
        let surface = ClosedSurface::new(vertices, &triangles).expect("closed");
        // Faces, edges, corners and diagonals of sides, from in- and outside.
        let at = [-1.7, -0.9, -0.35, 0.0, 0.3, 0.8, 1.4];
        for x in at.iter().flat_map(|&x| at.iter().flat_map(move |&y| at.map(|z| Vector::<3>::new(x, y, z))))
        {
            let (expected, normal) = cuboid(&x, &Vector::<3>::repeat(1.0));
            let (gap, n) = surface.gap(&x);
            assert!((gap - expected).abs() < 1e-14, "{x}: {gap} {expected}");
            // On the diagonals inside two sides are equally near.
            let unique = {
                let mut beyond = x.abs().as_slice().to_vec();
                beyond.sort_by(f64::total_cmp);
                expected > 0.0 || beyond[2] > beyond[1]
            };
            assert!(!unique || (n - normal).norm() < 1e-12, "{x}: {n} {normal}");
        }
    }

    /// Symptom guarded against: the sign from the nearest facet alone is wrong in front of an edge that is nearer to its back
    /// than to its front. That is so before the tip of a spike.
    #[test]
    fn before_a_spike_one_is_outside() {
        let vertices =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.9, 0.1, 0.0], [0.8, 0.0, 6.0]].map(Vector::<3>::from);
        let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let surface = ClosedSurface::new(vertices.to_vec(), &triangles).expect("closed");
        for offset in [[0.0, 0.0, 0.3], [0.05, 0.01, 0.1], [-0.02, 0.03, 0.3], [0.3, -0.2, 0.1]] {
            let offset = Vector::<3>::from(offset);
            let (gap, normal) = surface.gap(&(vertices[3] + offset));
            assert!((gap - offset.norm()).abs() < 1e-14, "{gap}");
            assert!((normal - offset.normalize()).norm() < 1e-12);
        }
        assert!(surface.gap(&Vector::<3>::new(0.7, 0.02, 0.5)).0 < 0.0);
    }

    #[test]
    fn triangles_that_enclose_nothing_are_refused_with_count_and_place() {
        let (vertices, triangles) = cube();
        let refused =
            |triangles: &[[u32; 3]]| ClosedSurface::new(vertices.clone(), triangles).expect_err("faulty");
        let open = refused(&triangles[1..]);
        assert!(matches!(open, SurfaceDefect::Open { count: 3, .. }), "{open}");
        assert!(
            open.to_string().contains("3 edges, the first from (-1.000000, -1.000000, -1.000000) to"),
            "{open}"
        );
        let mut more = triangles.clone();
        more.push(triangles[0]);
        assert!(matches!(refused(&more), SurfaceDefect::NonManifold { count: 3, .. }));
        let mut twisted = triangles.clone();
        twisted[4].swap(0, 1);
        assert!(matches!(refused(&twisted), SurfaceDefect::Twisted { count: 3, .. }));
        let inside_out: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert_eq!(refused(&inside_out), SurfaceDefect::InsideOut);
        more[12] = [0, 1, 1];
        assert!(matches!(refused(&more), SurfaceDefect::Degenerate { count: 1, triangle: 12, .. }));
        assert!(matches!(refused(&[[0, 1, 9]]), SurfaceDefect::UnknownVertex { triangle: 0, vertices: 8 }));
        assert_eq!(refused(&[]), SurfaceDefect::Empty);
    }
}
