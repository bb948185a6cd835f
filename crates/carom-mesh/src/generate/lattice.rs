use std::array;

use crate::{CellBlock, CellKind, Mesh, MeshError, Vector};

/// Points in blocks of rows and columns: what every structured mesh is cut out of, whatever its cells.
///
/// A linear cell spans one interval of the points along each direction, a quadratic one two.
#[derive(Debug, Clone)]
pub(super) struct Lattice<const D: usize> {
    /// Positions of the points [m].
    pub points: Vec<Vector<D>>,
    /// The blocks, which meet where they share points.
    pub blocks: Vec<Block<D>>,
}

/// A block of points, of which the directions are right-handed.
#[derive(Debug, Clone)]
pub(super) struct Block<const D: usize> {
    /// Intervals along each direction.
    intervals: [usize; D],
    /// Numbers of the points, fastest along the first direction.
    points: Vec<u32>,
}

/// How many intervals of a lattice a cell spans: 1 if it is linear, 2 if it is quadratic.
pub(super) fn span(kind: CellKind) -> usize {
    kind.reference().degree
}

/// The place of number `index` among `counts` points or cells, fastest along the first direction.
pub(super) fn unravel<const D: usize>(mut index: usize, counts: [usize; D]) -> [usize; D] {
    counts.map(|count| {
        let i = index % count;
        index /= count;
        i
    })
}

impl<const D: usize> Block<D> {
    /// A block of `intervals` per direction whose points have the numbers `point(place)`.
    pub fn new(intervals: [usize; D], point: impl Fn([usize; D]) -> u32) -> Self {
        let counts = intervals.map(|n| n + 1);
        let points = (0..counts.iter().product()).map(|k| point(unravel(k, counts))).collect();
        Self { intervals, points }
    }

    fn point(&self, place: [usize; D]) -> u32 {
        self.points[(0..D).rev().fold(0, |n, k| n * (self.intervals[k] + 1) + place[k])]
    }
}

impl<const D: usize> Lattice<D> {
    /// The mesh of these cells. Boxes of points that are to be simplices or wedges are cut; points that no cell uses are dropped.
    ///
    /// # Errors
    /// If the cells are not of dimension `D`.
    pub fn mesh(self, kind: CellKind) -> Result<Mesh<D>, MeshError> {
        let (reference, span) = (kind.reference(), span(kind));
        if reference.dimension != D {
            return Err(MeshError::WrongDimension { kind: reference.name, dimension: D });
        }
        let boxes = if D == 2 { CellKind::Quad4 } else { CellKind::Hex8 }.reference();
        let half = |xi: f64| ((xi + 1.0) * 0.5 * span as f64).round() as usize;
        let corners: Vec<[usize; D]> = boxes.nodes.iter().map(|xi| array::from_fn(|k| half(xi[k]))).collect();
        let mut connectivity = Vec::new();
        for block in &self.blocks {
            let cells = block.intervals.map(|n| n / span);
            for cell in 0..cells.iter().product() {
                let first = unravel(cell, cells);
                let at = |offset: [usize; D]| block.point(array::from_fn(|k| first[k] * span + offset[k]));
                if kind.is_wedge() {
                    let ends: Vec<u32> = corners.iter().map(|&c| at(c)).collect();
                    for half_of in self.halves(&ends) {
                        let corner = |i: usize, k: usize| corners[half_of[i]][k] as f64;
                        connectivity.extend(reference.nodes.iter().map(|xi| {
                            at(array::from_fn(|k| {
                                let along = |i: usize| xi[i] * (corner(i + 1, k) - corner(0, k));
                                let across = (corner(0, k) + (0..2).map(along).sum::<f64>()).round() as usize;
                                if k == 2 { half(xi[2]) } else { across }
                            }))
                        }));
                    }
                } else if kind.is_simplex() {
                    let ends: Vec<u32> = corners.iter().map(|&c| at(c)).collect();
                    for simplex in self.cut(&ends) {
                        let corner = |i: usize, k: usize| corners[simplex[i]][k] as f64;
                        connectivity.extend(reference.nodes.iter().map(|xi| {
                            at(array::from_fn(|k| {
                                let along = |i: usize| xi[i] * (corner(i + 1, k) - corner(0, k));
                                (corner(0, k) + (0..D).map(along).sum::<f64>()).round() as usize
                            }))
                        }));
                    }
                } else {
                    connectivity.extend(reference.nodes.iter().map(|xi| at(array::from_fn(|k| half(xi[k])))));
                }
            }
        }
        let points = used_only(self.points, &mut connectivity);
        Mesh::new(points, vec![CellBlock { kind, connectivity }])
    }

    /// The simplices, by local corners, that a quadrilateral or hexahedron with these corners is cut in.
    fn cut(&self, corners: &[u32]) -> Vec<[usize; 4]> {
        if D == 3 {
            return tetrahedra(corners);
        }
        self.halves(corners).map(|[a, b, c]| [a, b, c, 0]).to_vec()
    }

    /// The triangles, by local corners, that the first four corners are cut in, along the shorter diagonal. Layers of a swept
    /// lattice are alike, so that what is above is cut as what is below.
    fn halves(&self, corners: &[u32]) -> [[usize; 3]; 2] {
        let length = |a: usize, b: usize| {
            (self.points[corners[a] as usize] - self.points[corners[b] as usize]).norm_squared()
        };
        if length(0, 2) <= length(1, 3) { [[0, 1, 2], [0, 2, 3]] } else { [[0, 1, 3], [1, 2, 3]] }
    }
}

impl Lattice<2> {
    /// The lattice swept through `intervals` along z; point `k` of a line along z is at `height(k)` [m].
    pub fn swept(&self, intervals: usize, height: impl Fn(usize) -> f64) -> Lattice<3> {
        let layer = self.points.len();
        let points = (0..=intervals)
            .flat_map(|k| {
                let z = height(k);
                self.points.iter().map(move |x| Vector::from([x[0], x[1], z]))
            })
            .collect();
        let sweep = |block: &Block<2>| {
            let [m, n] = block.intervals;
            Block::new([m, n, intervals], |[i, j, k]| block.point([i, j]) + (k * layer) as u32)
        };
        Lattice { points, blocks: self.blocks.iter().map(sweep).collect() }
    }
}

/// Six tetrahedra around the corner of the smallest number, which also begins the diagonal of every facet it is on. As each
/// facet is cut from its own smallest corner, hexahedra that share it agree.
fn tetrahedra(corners: &[u32]) -> Vec<[usize; 4]> {
    let first = |among: &[usize]| (0..among.len()).min_by_key(|&k| corners[among[k]]).unwrap_or(0);
    let apex = first(&[0, 1, 2, 3, 4, 5, 6, 7]);
    let facets = CellKind::Hex8.reference().facets.iter().map(|(_, facet)| *facet);
    let far = facets.filter(|facet| !facet.contains(&apex));
    far.flat_map(|facet| {
        let [a, b, c, d] = array::from_fn(|k| facet[(first(facet) + k) % 4]);
        [[apex, a, b, c], [apex, a, c, d]]
    })
    .collect()
}

/// The points that cells use, in their order, and the cells renumbered.
fn used_only<const D: usize>(points: Vec<Vector<D>>, connectivity: &mut [u32]) -> Vec<Vector<D>> {
    let mut number = vec![u32::MAX; points.len()];
    connectivity.iter().for_each(|&n| number[n as usize] = 0);
    let mut used = Vec::with_capacity(points.len());
    for (point, number) in points.into_iter().zip(&mut number).filter(|(_, n)| **n == 0) {
        *number = used.len() as u32;
        used.push(point);
    }
    connectivity.iter_mut().for_each(|n| *n = number[*n as usize]);
    used
}
