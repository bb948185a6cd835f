use std::sync::{Mutex, TryLockError};

use carom_mesh::Vector;
use carom_mesh::parallel::{CHUNK, MANY, NODES_PER_CELL, each_chunk, share};

use crate::material::LANES;

/// Nodal vectors of the cells of a pack.
pub(crate) type Local<const D: usize, const N: usize> = [[[f64; LANES]; D]; N];

/// Where threads lay down the nodal forces of their cells before these are added up, node by node. What one thread adds in the order of
/// the cells, many add in the same order.
#[derive(Debug)]
pub(super) struct Staging<const D: usize, const N: usize> {
    /// The cells at node n are `cells[starts[n]..starts[n + 1]]`, in their order.
    starts: Vec<u32>,
    /// Each as a pack, the node's number within the cell and the lane, in one number.
    cells: Vec<u32>,
    /// Number of packs.
    count: usize,
    /// Nodal forces of a pack, and a number: as many for every pack as there are forces. Taken once for all packs, never within them.
    packs: Mutex<Vec<(Local<D, N>, f64)>>,
}

impl<const D: usize, const N: usize> Staging<D, N> {
    /// For a body with so many nodes; `packs` has those of the cells, the first `cells` of which count. None for few packs.
    pub fn new(nodes: usize, cells: usize, packs: &[[[u32; LANES]; N]]) -> Option<Self> {
        if packs.len() * LANES < MANY / NODES_PER_CELL || packs.len() * N * LANES > u32::MAX as usize {
            return None;
        }
        let places = || {
            packs.iter().enumerate().flat_map(move |(pack, of_pack)| {
                let lanes = (cells - pack * LANES).min(LANES);
                (0..N * LANES).filter(move |place| place % LANES < lanes).map(move |place| {
                    (of_pack[place / LANES][place % LANES] as usize, pack * N * LANES + place)
                })
            })
        };
        let mut starts = vec![0_u32; nodes + 1];
        places().for_each(|(node, _)| starts[node + 1] += 1);
        (0..nodes).for_each(|n| starts[n + 1] += starts[n]);
        let (mut next, mut at_nodes) = (starts.clone(), vec![0; starts[nodes] as usize]);
        for (node, place) in places() {
            at_nodes[next[node] as usize] = place as u32;
            next[node] += 1;
        }
        Some(Self { starts, cells: at_nodes, count: packs.len(), packs: Mutex::default() })
    }

    /// Adds the nodal forces that `of_pack` writes to `forces` and returns the sum of the numbers that come with them. It returns None where it
    /// is in use by another step with the same body; this thread may even have to finish that step.
    pub fn assemble<W, const M: usize>(
        &self,
        forces: &mut [&mut [Vector<D>]; M],
        scratch: impl Fn() -> W + Sync,
        of_pack: impl Fn(usize, &mut W, [&mut Local<D, N>; M]) -> f64 + Sync,
    ) -> Option<f64> {
        let mut packs = match self.packs.try_lock() {
            Ok(packs) => packs,
            // A thread that panicked has left nothing behind that the next evaluation does not overwrite.
            Err(TryLockError::Poisoned(packs)) => packs.into_inner(),
            Err(TryLockError::WouldBlock) => return None,
        };
        if packs.len() < self.count * M {
            packs.resize(self.count * M, ([[[0.0; LANES]; D]; N], 0.0));
        }
        let packs = &mut packs[..self.count * M];
        share(packs, CHUNK / NODES_PER_CELL / LANES * M, &|first, packs| {
            let mut work = scratch();
            for (pack, forces) in (first / M..).zip(packs.chunks_exact_mut(M)) {
                let of_forces: &mut [_; M] = forces.try_into().expect("as many as there are forces");
                let sum = of_pack(pack, &mut work, of_forces.each_mut().map(|(local, _)| local));
                of_forces[0].1 = sum;
            }
        });
        for (number, force) in forces.iter_mut().enumerate() {
            each_chunk(force, |first, force| {
                for (node, force) in (first..).zip(force) {
                    let cells = self.starts[node] as usize..self.starts[node + 1] as usize;
                    for place in self.cells[cells].iter().map(|&place| place as usize) {
                        let local = &packs[place / (N * LANES) * M + number].0[place / LANES % N];
                        (0..D).for_each(|i| force[i] += local[i][place % LANES]);
                    }
                }
            });
        }
        Some(packs.iter().step_by(M).map(|(_, sum)| sum).sum())
    }
}
