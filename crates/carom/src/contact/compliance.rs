//! How the nodes of one body yield to forces on one another: blocks of K̄⁻¹.

use carom_mesh::Matrix;

use super::control::CONTROL;
use crate::archive::{Archive, CheckpointError};
use crate::body::Body;

/// The blocks of K̄⁻¹ of one body between the nodes that have been in contact, computed when a node first is and kept with the
/// factor.
#[derive(Debug)]
pub(crate) struct Compliance<const D: usize> {
    /// The nodes, in the order of their first contact.
    nodes: Vec<u32>,
    /// Place of every node of the body among them, or `u32::MAX`.
    places: Vec<u32>,
    table: Table<D>,
    generation: u64,
    /// The rotation of the body since its blocks were made.
    pub turn: Matrix<D>,
    /// How much of a reaction the body feels where nodes without mass press on its mass, of what contacts say: see [`OnMasses`](super::on_masses::OnMasses).
    felt: f64,
    version: u64,
}

#[derive(Debug)]
enum Table<const D: usize> {
    /// The blocks (K̄⁻¹)_ab in the frame of the factor, by the place of b and then that of a, which is no larger.
    All(Vec<Matrix<D>>),
    /// Columns, by place.
    Near(Near<D>),
}

/// The blocks of every column with the nodes near it, itself among them.
#[derive(Debug)]
struct Near<const D: usize> {
    starts: Vec<usize>,
    /// Ascending within a column.
    others: Vec<u32>,
    blocks: Vec<Matrix<D>>,
}

impl<const D: usize> Near<D> {
    fn new() -> Self {
        Self { starts: vec![0], others: Vec::new(), blocks: Vec::new() }
    }

    /// Appends the columns of `nodes`.
    fn extend(&mut self, body: &mut dyn Body<D>, nodes: &[u32]) {
        let known = self.starts.len() - 1;
        for &node in nodes {
            self.others.extend(body.near(node).unwrap_or_else(|| nodes.to_vec()));
            self.starts.push(self.others.len());
        }
        self.blocks.resize(self.others.len(), Matrix::zeros());
        let mut order: Vec<usize> = (0..nodes.len()).collect();
        order.sort_by_key(|&k| body.order(nodes[k]));
        for group in order.chunks(body.responses_at_once()) {
            let columns: Vec<u32> = group.iter().map(|&k| nodes[k]).collect();
            let others = group.iter().flat_map(|&k| &self.others[self.column(known + k)]);
            body.set_reach(&others.copied().collect::<Vec<u32>>());
            body.respond(&columns);
            for (number, &k) in group.iter().enumerate() {
                for entry in self.column(known + k) {
                    self.blocks[entry] = body.response(self.others[entry], nodes[k], number);
                }
            }
        }
    }

    fn column(&self, place: usize) -> std::ops::Range<usize> {
        self.starts[place]..self.starts[place + 1]
    }
}

impl<const D: usize> Compliance<D> {
    /// Of a body with so many nodes.
    pub fn new(nodes: usize) -> Self {
        Self {
            nodes: Vec::new(),
            places: vec![u32::MAX; nodes],
            table: Table::All(Vec::new()),
            generation: 0,
            turn: Matrix::identity(),
            felt: 1.0,
            version: 0,
        }
    }

    /// See the field.
    pub fn felt(&self) -> f64 {
        self.felt
    }

    /// Takes note of how much the body feels of a reaction.
    pub fn feel(&mut self, felt: f64) {
        if felt != self.felt {
            self.felt = felt;
            self.version += 1;
        }
    }

    /// Makes sure that the blocks between `nodes` are there and belong to the present K̄. If forces are not felt `everywhere` at
    /// once, as in a static analysis, many nodes have blocks only with those around them.
    pub fn prepare(&mut self, body: &mut dyn Body<D>, nodes: &[u32], everywhere: bool) {
        let turn = body.turn();
        self.version += u64::from(turn != self.turn);
        self.turn = turn;
        if self.generation != body.generation() {
            self.clear();
            self.generation = body.generation();
        }
        let new = nodes.iter().filter(|&&node| self.places[node as usize] == u32::MAX).count();
        if new == 0 {
            return;
        }
        let many = self.nodes.len() + new > CONTROL.few && !everywhere;
        if many && matches!(self.table, Table::All(_)) {
            // A body that feels everything everywhere keeps all blocks.
            let feels_nearby = nodes.first().is_some_and(|&node| body.near(node).is_some());
            if feels_nearby {
                self.clear();
                self.table = Table::Near(Near::new());
            }
        }
        self.extend(body, nodes);
    }

    /// Records the nodes whose blocks belong to the present K̄, in the order of their first contact, under names that begin with `name`; or
    /// makes these blocks again.
    pub fn exchange(
        &mut self,
        archive: &mut Archive<'_>,
        name: &str,
        body: &mut dyn Body<D>,
    ) -> Result<(), CheckpointError> {
        let list = format!("{name}/nodes");
        let is_fresh = self.generation == body.generation();
        let mut nodes = if is_fresh { self.nodes.clone() } else { Vec::new() };
        let mut near = !nodes.is_empty() && matches!(self.table, Table::Near(_));
        nodes.resize(archive.rows(&list, nodes.len())?, 0);
        archive.integers(&list, &mut nodes)?;
        archive.flags(&format!("{name}/near"), [&mut near])?;
        if !archive.replays() {
            return Ok(());
        }
        if nodes.iter().any(|&node| node as usize >= self.places.len()) {
            return Err(CheckpointError::new(&list, "names a node that is not there"));
        }
        self.clear();
        self.generation = body.generation();
        if near {
            self.table = Table::Near(Near::new());
        }
        self.extend(body, &nodes);
        Ok(())
    }

    /// Adds the blocks of those of `nodes` that have none.
    fn extend(&mut self, body: &mut dyn Body<D>, nodes: &[u32]) {
        let known = self.nodes.len();
        for &node in nodes {
            let place = &mut self.places[node as usize];
            if *place == u32::MAX {
                *place = self.nodes.len() as u32;
                self.nodes.push(node);
            }
        }
        match &mut self.table {
            Table::All(blocks) => {
                body.set_reach(&self.nodes);
                let mut place = known;
                for group in self.nodes[known..].chunks(body.responses_at_once()) {
                    body.respond(group);
                    for (number, &b) in group.iter().enumerate() {
                        let others = self.nodes[..=place].iter();
                        blocks.extend(others.map(|&a| body.response(a, b, number)));
                        place += 1;
                    }
                }
            }
            Table::Near(near) => near.extend(body, &self.nodes[known..]),
        }
    }

    /// Forgets all blocks.
    pub fn clear(&mut self) {
        self.nodes.drain(..).for_each(|node| self.places[node as usize] = u32::MAX);
        self.table = Table::All(Vec::new());
        self.version += 1;
    }

    /// Another number whenever blocks that there were, the rotation, or what is felt have become others.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// The nodes that have blocks with a node that was prepared; None if all have.
    #[inline]
    pub fn near(&self, node: usize) -> Option<&[u32]> {
        match &self.table {
            Table::All(_) => None,
            Table::Near(near) => Some(&near.others[near.column(self.places[node] as usize)]),
        }
    }

    /// The block (K̄⁻¹)_ab of two nodes that were prepared, in the frame of the factor, if they have one.
    #[inline]
    pub fn block(&self, a: usize, b: usize) -> Option<Matrix<D>> {
        let (a_place, b_place) = (self.places[a] as usize, self.places[b] as usize);
        match &self.table {
            Table::All(blocks) if a_place <= b_place => Some(blocks[b_place * (b_place + 1) / 2 + a_place]),
            Table::All(blocks) => Some(blocks[a_place * (a_place + 1) / 2 + b_place].transpose()),
            Table::Near(near) => {
                let column = near.column(b_place);
                let place = near.others[column.clone()].binary_search(&(a as u32)).ok()?;
                Some(near.blocks[column.start + place])
            }
        }
    }
}
