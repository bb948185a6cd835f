use carom_mesh::{Matrix, Tie, Vector};

use super::NodeGraph;
use super::cholesky::Cholesky;
use super::folding::Folding;
use super::memory;
use super::ordering::nested_dissection;
use super::row::ABREAST;
use super::triangular::{Precision, Triangular};
use crate::FemError;

/// Supernodal Cholesky factor of a symmetric matrix of D × D blocks over a node graph.
///
/// The ordering and the symbolic factorisation are made once; [`Factor::factorize`] renews the values in place.
///
/// Where nodes are tied, the inverse of a matrix A stands for T (Tᵀ A T)⁻¹ Tᵀ. T is the map from the motions of the free nodes
/// to those of all. Forces on an image act on its master, and the two move alike to the last bit.
pub struct Factor<const D: usize> {
    cholesky: Cholesky,
    /// For every stored value of the lower triangle: its entry in the graph and its place in the block.
    sources: Vec<(u32, u8, u8)>,
    triangular: Box<dyn Triangular>,
    precision: Precision,
    /// None without ties.
    folding: Option<Folding<D>>,
    factorized: bool,
}

impl<const D: usize> std::fmt::Debug for Factor<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Factor")
            .field("rows", &self.cholesky.ordering.len())
            .field("values", &self.value_count())
            .finish()
    }
}

impl<const D: usize> Factor<D> {
    /// Orders the unknowns (AMD; nested dissection where there are many) and finds the structure of the factor of matrices over `graph` whose nodes have these `ties`.
    /// Where they are dissected, the nodes in `last` come last: it costs least to [respond](Self::respond) there.
    ///
    /// # Errors
    /// If the symbolic factorisation fails, in practice for lack of memory.
    pub fn new(graph: &NodeGraph, ties: &[Tie], last: &[u32]) -> Result<Self, FemError> {
        if ties.is_empty() {
            return Self::over(graph, None, last);
        }
        let (folding, folded) = Folding::new(graph, ties);
        let mut last: Vec<u32> = last.iter().map(|&node| folding.masters[node as usize]).collect();
        last.sort_unstable();
        last.dedup();
        Self::over(&folded, Some(folding), &last)
    }

    fn over(graph: &NodeGraph, folding: Option<Folding<D>>, last: &[u32]) -> Result<Self, FemError> {
        let mut column_starts = vec![0];
        let mut rows = Vec::new();
        let mut sources = Vec::new();
        for node in 0..graph.node_count() {
            for column in 0..D {
                // Column (node, column) of the lower triangle; by symmetry its blocks are those of the node's row, transposed.
                for (entry, neighbour) in graph.row(node).filter(|&(_, m)| m >= node) {
                    for row in (if neighbour == node { column } else { 0 })..D {
                        rows.push(neighbour * D + row);
                        sources.push((entry as u32, column as u8, row as u8));
                    }
                }
                column_starts.push(rows.len());
            }
        }
        let order = nested_dissection(graph, last)
            .map(|nodes| nodes.iter().flat_map(|n| (0..D).map(move |i| n * D + i)).collect());
        Ok(Self {
            cholesky: Cholesky::new(column_starts, rows, order)?,
            sources,
            triangular: Precision::default().triangular(),
            precision: Precision::default(),
            folding,
            factorized: false,
        })
    }

    /// Factorises the matrix whose block at a graph entry is `block(entry)`, in double precision, and keeps the factor in
    /// `precision`. What else it takes is given back: a factor is made seldom, and in space it is most of the memory.
    ///
    /// # Errors
    /// If the matrix is not positive definite, or the memory does not suffice.
    pub fn factorize(
        &mut self,
        precision: Precision,
        block: impl Fn(usize) -> Matrix<D>,
    ) -> Result<(), FemError> {
        self.factorized = false;
        let kept = match precision {
            Precision::Single => size_of::<f32>(),
            Precision::Double => size_of::<f64>(),
        };
        memory::check(self.cholesky.ordering.len(), (self.value_count() * (size_of::<f64>() + kept)) as u64)?;
        self.precision = precision;
        self.triangular = precision.triangular();
        let lower_values = match &self.folding {
            None => lower_triangle(&self.sources, block),
            Some(folding) => {
                let blocks = folding.fold_matrix(block);
                lower_triangle(&self.sources, |entry| blocks[entry])
            }
        };
        self.cholesky.factorize(&lower_values, &mut *self.triangular)?;
        self.factorized = true;
        Ok(())
    }

    /// The numbers that the factor is kept in.
    #[must_use]
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// Whether there is a factor to solve with.
    #[must_use]
    pub fn is_factorized(&self) -> bool {
        self.factorized
    }

    /// Overwrites the right-hand side `x`, one vector per node, with the solution.
    ///
    /// # Panics
    /// If the length does not fit or nothing was factorised.
    pub fn solve(&mut self, x: &mut [Vector<D>]) {
        self.begin(x);
        self.end(x);
    }

    /// Takes the right-hand side `x`, one vector per node, through the forward substitution. Before [`Self::end`] makes the
    /// solution of it, [`Self::look`] sees a part of that, and [`Self::add`] adds to the right-hand side. Both act at some nodes
    /// only, which costs a fraction of a solve.
    ///
    /// # Panics
    /// If the length does not fit or nothing was factorised.
    pub fn begin(&mut self, x: &mut [Vector<D>]) {
        assert!(self.factorized, "solve needs a factor");
        if let Some(folding) = &self.folding {
            folding.fold(x);
        }
        self.triangular.begin(bytemuck::cast_slice(x));
    }

    /// The backward substitution: writes the solution to `x`.
    pub fn end(&mut self, x: &mut [Vector<D>]) {
        self.triangular.end(bytemuck::cast_slice_mut(x));
        if let Some(folding) = &self.folding {
            folding.unfold(x);
        }
    }

    /// Names the nodes at which [`Self::look`] and [`Self::add`] are wanted.
    pub fn set_reach(&mut self, nodes: impl Iterator<Item = usize>) {
        let Self { triangular, cholesky: Cholesky { places, .. }, folding, .. } = self;
        let mut wanted = nodes.flat_map(|node| {
            let first = master(folding.as_ref(), node) * D;
            places[first..first + D].iter().map(|&place| place as usize)
        });
        triangular.set_reach(&mut wanted);
    }

    /// Solves for the right-hand side as it is at the nodes of the reach: see [`Self::seen`].
    pub fn look(&mut self) {
        self.triangular.look();
    }

    /// Values of the factor.
    #[must_use]
    pub fn value_count(&self) -> usize {
        self.cholesky.value_count()
    }

    /// Memory of the factor [bytes].
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.triangular.bytes()
    }

    /// What [`Self::look`] saw at a node of the reach.
    #[must_use]
    pub fn seen(&self, node: usize) -> Vector<D> {
        Vector::from_fn(|i, _| self.triangular.seen(self.place(node, i)))
    }

    /// Nodes that [`Self::respond`] takes at once.
    pub const AT_ONCE: usize = ABREAST / D;

    /// Solves for unit forces along every component at [`Self::AT_ONCE`] nodes of the reach at most, within the reach. Nodes that are near each
    /// other in the [`Self::order`] cost least.
    pub fn respond(&mut self, nodes: impl Iterator<Item = usize>) {
        let places: Vec<usize> = nodes
            .flat_map(|node| (0..D).map(move |i| (node, i)))
            .map(|(node, i)| self.place(node, i))
            .collect();
        self.triangular.respond(&places);
    }

    /// What a node of the reach does under unit forces at such a node, named by its number among them: a column for every component.
    #[must_use]
    pub fn response(&self, number: usize, node: usize) -> Matrix<D> {
        Matrix::from_fn(|i, j| self.triangular.response(number * D + j, self.place(node, i)))
    }

    /// When a node is eliminated.
    #[must_use]
    pub fn order(&self, node: usize) -> usize {
        self.place(node, 0)
    }

    fn place(&self, node: usize, component: usize) -> usize {
        self.cholesky.places[master(self.folding.as_ref(), node) * D + component] as usize
    }

    /// Adds `forces`, each at a node of the reach, to the right-hand side.
    pub fn add(&mut self, forces: impl Iterator<Item = (usize, Vector<D>)>) {
        let Self { triangular, cholesky: Cholesky { places, .. }, folding, .. } = self;
        let mut values = forces.flat_map(|(node, force)| {
            let first = master(folding.as_ref(), node) * D;
            std::array::from_fn::<_, D, _>(|i| (places[first + i] as usize, force[i]))
        });
        triangular.add(&mut values);
    }
}

/// The node that stands for `node` in the folded system.
fn master<const D: usize>(folding: Option<&Folding<D>>, node: usize) -> usize {
    folding.map_or(node, |folding| folding.masters[node] as usize)
}

/// The values of the lower triangle of a matrix of blocks.
fn lower_triangle<const D: usize>(sources: &[(u32, u8, u8)], block: impl Fn(usize) -> Matrix<D>) -> Vec<f64> {
    sources.iter().map(|&(entry, i, j)| block(entry as usize)[(i as usize, j as usize)]).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::NodalMatrix;
    use super::*;
    use carom_mesh::generate;

    #[test]
    fn solution_times_matrix_is_the_right_hand_side() {
        let mesh = generate::grid([0.0; 2], [1.0, 1.0], [5, 4]).expect("valid");
        let graph = Arc::new(NodeGraph::of(&mesh));
        let mut a = NodalMatrix::filled(&graph, Matrix::<2>::zeros());
        for node in 0..graph.node_count() {
            for (entry, neighbour) in graph.row(node) {
                let coupling = Matrix::<2>::new(-0.3, 0.1, 0.1, -0.2);
                a.values[entry] =
                    if node == neighbour { Matrix::<2>::new(5.0, 0.4, 0.4, 6.0) } else { coupling };
            }
        }
        let x: Vec<Vector<2>> = (0..graph.node_count())
            .map(|n| Vector::<2>::new((n as f64).sin(), (n as f64 * 0.7).cos()))
            .collect();
        let mut b = vec![Vector::zeros(); x.len()];
        a.multiply(&x, &mut b);
        let mut factor = Factor::new(&graph, &[], &[]).expect("symbolic");
        factor.factorize(Precision::Double, |entry| a.values[entry]).expect("positive definite");
        factor.solve(&mut b);
        for (b, x) in b.iter().zip(&x) {
            assert!((b - x).norm() < 1e-13);
        }
        assert!(factor.factorize(Precision::Double, |entry| -a.values[entry]).is_err());
        assert!(!factor.is_factorized());
    }

    /// In space the last separators are hundreds of columns wide: their panels are inverted in blocks.
    #[test]
    fn wide_panels_are_solved_with_as_well_as_narrow_ones() {
        let mesh = generate::grid([0.0; 3], [1.0; 3], [9, 9, 9]).expect("valid");
        let graph = Arc::new(NodeGraph::of(&mesh));
        let mut a = NodalMatrix::filled(&graph, Matrix::<3>::identity() * -0.15);
        for node in 0..graph.node_count() {
            let x = node as f64;
            a.values[graph.entry(node as u32, node as u32)] =
                Matrix::<3>::new(5.0, 0.4, 0.1, 0.4, 6.0, 0.2, 0.1, 0.2, 5.5 + 0.5 * x.sin());
        }
        let x: Vec<Vector<3>> =
            (0..graph.node_count()).map(|n| Vector::from_fn(|i, _| ((3 * n + i) as f64).cos())).collect();
        let mut b = vec![Vector::zeros(); x.len()];
        a.multiply(&x, &mut b);
        let mut factor = Factor::new(&graph, &[], &[]).expect("symbolic");
        factor.factorize(Precision::Double, |entry| a.values[entry]).expect("positive definite");
        factor.solve(&mut b);
        for (b, x) in b.iter().zip(&x) {
            assert!((b - x).norm() < 1e-12);
        }
    }

    /// With ties: x is the motion of the free nodes spread to all, and Tᵀ A x = Tᵀ b.
    #[test]
    fn tied_nodes_move_alike_and_share_their_forces() {
        for width in [1, 2, 5] {
            let mesh = generate::grid([0.0; 2], [1.0, 1.0], [width, 4]).expect("valid");
            let mesh = generate::tie_sides(mesh, 0).expect("alike");
            let graph = Arc::new(NodeGraph::of(&mesh));
            let mut a = NodalMatrix::filled(&graph, Matrix::<2>::new(-0.3, 0.1, 0.1, -0.2));
            for node in 0..graph.node_count() {
                a.values[graph.entry(node as u32, node as u32)] = Matrix::<2>::new(5.0, 0.4, 0.4, 6.0);
            }
            let fold = |b: &[Vector<2>]| {
                let mut sum = b.to_vec();
                for tie in mesh.ties() {
                    sum[tie.master as usize] += b[tie.image as usize];
                    sum[tie.image as usize] = Vector::zeros();
                }
                sum
            };
            let b: Vec<Vector<2>> = (0..graph.node_count())
                .map(|n| Vector::<2>::new((n as f64).sin(), (n as f64 * 0.7).cos()))
                .collect();
            let mut factor = Factor::new(&graph, mesh.ties(), &[]).expect("symbolic");
            factor.factorize(Precision::Double, |entry| a.values[entry]).expect("positive definite");
            let mut x = b.clone();
            factor.solve(&mut x);
            for tie in mesh.ties() {
                assert_eq!(x[tie.image as usize], x[tie.master as usize]);
            }
            let mut ax = b.clone();
            a.multiply(&x, &mut ax);
            for (ax, b) in fold(&ax).iter().zip(fold(&b)) {
                assert!((ax - b).norm() < 1e-13, "{width} cells wide");
            }
        }
    }

    /// What is seen before the end is the solution, and what is added on the way counts as if it had been there from the start.
    #[test]
    fn a_look_at_some_nodes_and_forces_added_there_are_those_of_whole_solves() {
        let mesh = generate::grid([0.0; 2], [1.0, 1.0], [12, 9]).expect("valid");
        // Large enough to be taken apart.
        let large = generate::grid([0.0; 2], [1.0, 1.0], [180, 150]).expect("valid");
        for mesh in [mesh.clone(), generate::tie_sides(mesh, 0).expect("alike"), large] {
            let graph = Arc::new(NodeGraph::of(&mesh));
            let n = graph.node_count();
            let mut a = NodalMatrix::filled(&graph, Matrix::<2>::new(-0.3, 0.1, 0.1, -0.2));
            for node in 0..n {
                a.values[graph.entry(node as u32, node as u32)] = Matrix::<2>::new(5.0, 0.4, 0.4, 6.0);
            }
            let mut factor = Factor::new(&graph, mesh.ties(), &[]).expect("symbolic");
            factor.factorize(Precision::Double, |entry| a.values[entry]).expect("positive definite");
            let b: Vec<_> = (0..n).map(|k| Vector::<2>::new((k as f64).sin(), (k as f64).cos())).collect();
            let (nodes, force) = ([0, 12, 40, n - 1], Vector::<2>::new(0.7, -0.2));
            let mut whole = b.clone();
            factor.solve(&mut whole);
            let mut more = b.clone();
            nodes.iter().for_each(|&k| more[k] += force);
            factor.solve(&mut more);

            let mut x = b.clone();
            factor.set_reach(nodes.into_iter());
            factor.begin(&mut x);
            factor.look();
            nodes.iter().for_each(|&k| assert!((factor.seen(k) - whole[k]).norm() < 1e-14));
            factor.add(nodes.iter().map(|&k| (k, force)));
            factor.end(&mut x);
            x.iter().zip(&more).for_each(|(x, more)| assert!((x - more).norm() < 1e-14));

            factor.respond(nodes.into_iter());
            let responses: Vec<Matrix<2>> = nodes.iter().map(|&k| factor.response(1, k)).collect();
            // Whoever asks again, after a restart, gets the same to the last bit, whatever else it asks for.
            factor.respond(std::iter::once(12));
            nodes.iter().zip(&responses).for_each(|(&k, before)| assert_eq!(factor.response(0, k), *before));
            for j in 0..2 {
                let mut unit = vec![Vector::<2>::zeros(); n];
                unit[12][j] = 1.0;
                factor.solve(&mut unit);
                for (&k, response) in nodes.iter().zip(&responses) {
                    assert!((response.column(j) - unit[k]).norm() < 1e-14);
                }
            }
        }
    }

    /// Nodes that come last answer one another out of the last panel, as they would by way of all.
    #[test]
    fn responses_do_not_depend_on_what_is_eliminated_last() {
        let mesh = generate::grid([0.0; 3], [1.0; 3], [16, 16, 15]).expect("valid");
        let graph = NodeGraph::of(&mesh);
        let mut is_diagonal = vec![false; graph.entry_count()];
        (0..graph.node_count() as u32).for_each(|n| is_diagonal[graph.entry(n, n)] = true);
        let coupling = Matrix::<3>::new(-0.2, 0.05, 0.01, 0.05, -0.1, 0.0, 0.01, 0.0, -0.15);
        let block = |entry: usize| if is_diagonal[entry] { Matrix::identity() * 6.0 } else { coupling };
        let last: Vec<u32> = (0..17 * 17).collect();
        let responses = [&[][..], &last].map(|last_of_factor| {
            let mut factor = Factor::<3>::new(&graph, &[], last_of_factor).expect("symbolic");
            factor.factorize(Precision::Double, block).expect("positive definite");
            factor.set_reach(last.iter().map(|&node| node as usize));
            factor.respond([3, 150, 200].into_iter());
            let of = |number: usize| last.iter().map(|&n| factor.response(number, n as usize)).collect();
            let found: [Vec<Matrix<3>>; 3] = std::array::from_fn(of);
            // Others take their way through the factor again.
            factor.set_reach([3, 2000].into_iter());
            factor.respond(std::iter::once(2000));
            (found, factor.response(0, 3))
        });
        let [(found, other), (of_last, other_of_last)] = responses;
        for (a, b) in found.iter().flatten().zip(of_last.iter().flatten()) {
            assert!((a - b).norm() < 1e-13);
        }
        assert!((other - other_of_last).norm() < 1e-13);
    }

    /// Every number is computed by one thread, by the same operations in the same order, however many there are.
    #[test]
    fn solutions_do_not_depend_on_the_number_of_threads() {
        let flat = generate::grid([0.0; 2], [1.0, 1.0], [180, 150]).expect("valid");
        assert_independent_of_threads(&NodeGraph::of(&flat), Matrix::<2>::new(-0.3, 0.1, 0.1, -0.2));
        let solid = generate::grid([0.0; 3], [1.0; 3], [16, 16, 15]).expect("valid");
        assert_independent_of_threads(&NodeGraph::of(&solid), Matrix::<3>::identity() * -0.15);
    }

    fn assert_independent_of_threads<const D: usize>(graph: &NodeGraph, coupling: Matrix<D>) {
        let mut factor = Factor::<D>::new(graph, &[], &[]).expect("symbolic");
        let diagonal: Vec<usize> =
            (0..graph.node_count()).map(|node| graph.entry(node as u32, node as u32)).collect();
        let mut is_diagonal = vec![false; graph.entry_count()];
        diagonal.into_iter().for_each(|entry| is_diagonal[entry] = true);
        let block = |entry: usize| if is_diagonal[entry] { Matrix::identity() * 6.0 } else { coupling };
        factor.factorize(Precision::Single, block).expect("positive definite");
        assert!(factor.triangular.is_apart());
        let b: Vec<Vector<D>> =
            (0..graph.node_count()).map(|n| Vector::from_fn(|i, _| ((3 * n + i) as f64).cos())).collect();
        let mut solve = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let mut x = b.clone();
            pool.install(|| factor.solve(&mut x));
            x
        };
        let one = solve(1);
        assert_eq!(solve(2), one);
        assert_eq!(solve(3), one);
    }
}
