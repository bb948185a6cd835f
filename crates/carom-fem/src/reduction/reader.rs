//! Reads amplitudes from the displacements of few nodes: those that are kept, and some inside that tell the modes apart.

use carom_mesh::Vector;
use nalgebra::DMatrix;

use super::content::{Content, rigid_motions};
use crate::Body;

/// So many times as many displacements are read inside as there are modes: the round-off of some is then that of none.
const SPARE: usize = 2;

/// What reads the displacements of some nodes: of all that would, the one that takes least of their round-off.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reader<const D: usize> {
    nodes: Vec<u32>,
    /// Shifts, turns and amplitudes of unit displacements, a column for each.
    rows: DMatrix<f64>,
}

impl<const D: usize> Reader<D> {
    /// Of a body with these `kept` nodes, modes with these held, and the `shapes` of its vibrations, column by column.
    pub fn new(
        body: &Body<D>,
        kept: &[u32],
        modes: &[Vec<Vector<D>>],
        shapes: &DMatrix<f64>,
    ) -> Option<Self> {
        let reference = body.mesh().nodes();
        let centre = body.mean(reference);
        let mut nodes = [kept, &telling(modes), &corners(reference)].concat();
        nodes.sort_unstable();
        nodes.dedup();
        let rigid: Vec<_> = nodes.iter().map(|&n| rigid_motions(&(reference[n as usize] - centre))).collect();
        let count = rigid.first().map_or(0, Vec::len);
        let made =
            DMatrix::from_fn(nodes.len() * D, count + shapes.ncols(), |r, c| match c.checked_sub(count) {
                None => rigid[r / D][c][r % D],
                Some(k) => shapes[(nodes[r / D] as usize * D + r % D, k)],
            });
        let parts = made.qr();
        let rows = parts.r().solve_upper_triangular(&parts.q().transpose())?;
        Some(Self { nodes, rows })
    }

    /// The nodes that are read, ascending.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// See [`super::Reduction::read_turn`].
    pub fn read_turn(&self, displacements: &[Vector<D>]) -> [f64; 3] {
        let turns = if D == 2 { 1 } else { 3 };
        let mut turn = [0.0; 3];
        for (k, u) in displacements.iter().enumerate() {
            for i in 0..D {
                let column = self.rows.column(k * D + i);
                (0..turns).for_each(|j| turn[3 - turns + j] += column[D + j] * u[i]);
            }
        }
        turn
    }

    /// See [`super::Reduction::read`].
    pub fn read(&self, displacements: &[Vector<D>], content: &mut Content<D>) {
        let Content { shift, turn, amplitudes } = content;
        let turns = if D == 2 { 1 } else { 3 };
        *shift = Vector::zeros();
        *turn = [0.0; 3];
        amplitudes.fill(0.0);
        for (k, u) in displacements.iter().enumerate() {
            for i in 0..D {
                let column = self.rows.column(k * D + i);
                let column = column.as_slice();
                (0..D).for_each(|j| shift[j] += column[j] * u[i]);
                (0..turns).for_each(|j| turn[3 - turns + j] += column[D + j] * u[i]);
                let rest = &column[D + turns..];
                amplitudes.iter_mut().zip(rest).for_each(|(a, c)| *a += c * u[i]);
            }
        }
    }
}

/// Nodes that tell modes apart: one after the other the one at which most is left of them, less what the nodes before tell; twice as many as it takes.
fn telling<const D: usize>(modes: &[Vec<Vector<D>>]) -> Vec<u32> {
    let Some(first) = modes.first() else { return Vec::new() };
    let wanted = (SPARE * modes.len()).div_ceil(D).min(first.len());
    let mut chosen: Vec<u32> = Vec::new();
    while chosen.len() < wanted {
        let mut left: Vec<Vec<f64>> =
            (0..first.len() * D).map(|r| modes.iter().map(|m| m[r / D][r % D]).collect()).collect();
        let before = chosen.len();
        let mut directions = 0;
        while directions < modes.len() && chosen.len() < wanted {
            let size = |n: usize| {
                left[n * D..][..D].iter().flatten().map(|x| x * x).sum::<f64>()
                    * f64::from(u8::from(!chosen.contains(&(n as u32))))
            };
            let best = (0..first.len()).max_by(|&a, &b| size(a).total_cmp(&size(b)));
            let Some(best) = best.filter(|&n| size(n) > 0.0) else { break };
            chosen.push(best as u32);
            for i in 0..D {
                let row = left[best * D + i].clone();
                let norm = row.iter().map(|x| x * x).sum::<f64>();
                if norm == 0.0 {
                    continue;
                }
                directions += 1;
                for other in &mut left {
                    let along = other.iter().zip(&row).map(|(a, b)| a * b).sum::<f64>() / norm;
                    other.iter_mut().zip(&row).for_each(|(a, b)| *a -= along * b);
                }
            }
        }
        if chosen.len() == before {
            break;
        }
    }
    chosen
}

/// D + 1 nodes that span the body: one far from the middle, the farthest from that, from their line, and from their plane.
fn corners<const D: usize>(nodes: &[Vector<D>]) -> Vec<u32> {
    let middle = carom_mesh::nodal::total(nodes) / nodes.len() as f64;
    let farthest = |of: &dyn Fn(&Vector<D>) -> f64| {
        (0..nodes.len()).max_by(|&a, &b| of(&nodes[a]).total_cmp(&of(&nodes[b]))).unwrap_or_default()
    };
    let origin = farthest(&|x| (x - middle).norm_squared());
    let (mut chosen, mut axes) = (vec![origin as u32], Vec::<Vector<D>>::new());
    for _ in 0..D {
        let beside = |x: &Vector<D>| {
            axes.iter().fold(x - nodes[origin], |rest, axis: &Vector<D>| rest - axis * axis.dot(&rest))
        };
        let next = farthest(&|x| beside(x).norm_squared());
        chosen.push(next as u32);
        let axis = beside(&nodes[next]);
        axes.push(axis / axis.norm());
    }
    chosen
}
